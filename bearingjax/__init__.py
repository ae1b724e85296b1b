"""Rolling-bearing mechanics in JAX: one energy, differentiated.

SI units everywhere (m, N, rad, kg, s, Pa). float64 is the working precision; turn it on
before the first array is made:

    import jax
    jax.config.update("jax_enable_x64", True)

What each part does stands in its own docstring: `help(bearingjax.statics)` (load
solves, sweeps, what to do when one fails), `element` (choices of numerics, speed),
`optimise`, `rotor`, `rotor.vibration`, `dynamics`, `acoustics`, `contact.halfspace`.

Conventions
-----------

- z is the bearing axis; azimuth from +x towards +y. Ring freedoms (ux uy uz gx gy gz),
  outer ring first: `q` has 12. Loads (Fx Fy Fz Mx My Mz) act on the moving ring at the
  origin, the centre of the row; in a set the origin is where `position` is zero.
- `force` = dV/dq, the load that holds the rings there; `stiffness` = its derivative.
  With gyroscopic moments, or contact constants that follow the operating angle, not all
  forces have a potential: `stiffness` is then the exact Jacobian, not quite symmetric
  (`element.has_potential(speed)` tells).
- Raceway order: outer, inner. Rib order: `outer_minus`, `outer_plus`, `inner_minus`,
  `inner_plus` (-z, +z).
- A taper's large roller ends lie at -z: an inner-ring load along +z closes the bearing.
  So it is for a positive contact angle of balls. `position` along a roller runs from
  the large end to the small one, also in mirrored rows. In a set mirrored rows carry
  the other way.
- Osculation is groove radius over ball diameter (0.52). Contact angles are positive
  where a row carries along +z. A deep groove bearing's zero has the rings centred, an
  angular contact bearing's has the balls just touching at their contact angle.
- With `Finite()` kinematics a ring's gx, gy are its rotation vector; its moments are
  conjugate to them (for tilts of a degree: moments about x and y within a per cent). A
  self-aligning bearing's tilts are prescribed: nothing restrains them.
- A set's `inner_offset` is what was ground off: `preload(element, force)` finds it. A
  `PreloadSpring` presses its row with force less stiffness times travel, never pulls.
- `radial_internal_clearance` is diametral; a quarter of it stands at each raceway of a
  roller. Negative: preload.
- Oils and films: temperatures in K, pressures above atmosphere, contact modulus E*
  (films take E' = 2 E* of it), entrainment speed the mean of both surface speeds
  relative to the contact. Slip and traction are those of the ball or roller.
- Rolling elements of a row may differ: `ball_deviation`, `roller_deviation` (diameter
  less the common one; the raceways stay) and `azimuth_deviation` (azimuth less that of
  even spacing), one number each.
- gz turns the set of rollers (rolling without slip). It is operating data: no torque
  comes of it, unless `cage_torque=True`; then moments about z are the virtual work of
  the contact forces. Derivatives of an answer with respect to a prescribed gz count all
  the same.
- A groove has no far side: a ball lifted past the groove centre touches nothing there.
  A turning ball that has left a raceway goes round as if that contact lay opposite its
  other one. On the loaded side a groove goes on beyond its shoulder; give the
  shoulder's height to be told (`solution.shoulder_margin`).
- The mass of a rolling element is that of its volume: give the `Material` of hollow or
  coated ones a density to match.
"""

from importlib.metadata import version as _version

from . import acoustics as acoustics
from . import contact as contact
from . import design as design
from . import dynamics as dynamics
from . import element as element
from . import lubrication as lubrication
from . import numerics as numerics
from . import plot as plot
from . import rotor as rotor
from . import scene as scene
from . import statics as statics
from .acoustics import NoiseModel as NoiseModel
from .acoustics import natural_modes as natural_modes
from .acoustics import vibration as vibration
from .contact import ISO16281 as ISO16281
from .contact import CoupledSlices as CoupledSlices
from .contact import FreeAngle as FreeAngle
from .contact import LineConstant as LineConstant
from .contact import OperatingAngle as OperatingAngle
from .contact import Palmgren as Palmgren
from .contact import PointConstant as PointConstant
from .contact import ZeroAngle as ZeroAngle
from .design import AngularContactBallBearing as AngularContactBallBearing
from .design import BearingSet as BearingSet
from .design import CircularCrown as CircularCrown
from .design import CrownedEnds as CrownedEnds
from .design import CylindricalRollerBearing as CylindricalRollerBearing
from .design import DeepGrooveBallBearing as DeepGrooveBallBearing
from .design import FitConditions as FitConditions
from .design import FourPointBallBearing as FourPointBallBearing
from .design import FujiwaraKawase as FujiwaraKawase
from .design import JohnsGohar as JohnsGohar
from .design import Logarithmic as Logarithmic
from .design import Lundberg as Lundberg
from .design import Material as Material
from .design import Mounting as Mounting
from .design import NeedleRollerBearing as NeedleRollerBearing
from .design import PreloadSpring as PreloadSpring
from .design import Rib as Rib
from .design import Ribs as Ribs
from .design import SelfAligningBallRow as SelfAligningBallRow
from .design import SetRow as SetRow
from .design import Straight as Straight
from .design import Tabulated as Tabulated
from .design import TaperedRollerBearing as TaperedRollerBearing
from .design import ThrustBallBearing as ThrustBallBearing
from .design import WarmMaterial as WarmMaterial
from .design import mounted as mounted
from .design.form_error import FormErrors as FormErrors
from .design.form_error import Harmonics as Harmonics
from .element import FREEDOMS as FREEDOMS
from .element import BearingElement as BearingElement
from .element import CentrifugalOnly as CentrifugalOnly
from .element import ConstantAngle as ConstantAngle
from .element import EqualShare as EqualShare
from .element import Finite as Finite
from .element import FrictionLimited as FrictionLimited
from .element import InnerControl as InnerControl
from .element import Linearised as Linearised
from .element import LoadShare as LoadShare
from .element import OperatingCentrifugal as OperatingCentrifugal
from .element import OuterControl as OuterControl
from .element import Speed as Speed
from .lubrication import Lubricant as Lubricant
from .numerics import BFGS as BFGS
from .numerics import ContactMapped as ContactMapped
from .numerics import Midpoint as Midpoint
from .numerics import Result as Result
from .numerics import SolveError as SolveError
from .numerics import TrustRegionNewton as TrustRegionNewton
from .optimise import Constraint as Constraint
from .optimise import Displacement as Displacement
from .optimise import EdgeLoad as EdgeLoad
from .optimise import GeometryEstimate as GeometryEstimate
from .optimise import MeanPressure as MeanPressure
from .optimise import Optimised as Optimised
from .optimise import PeakPressure as PeakPressure
from .optimise import RatingLife as RatingLife
from .optimise import Stiffness as Stiffness
from .optimise import StiffnessTarget as StiffnessTarget
from .optimise import Variable as Variable
from .optimise import estimate_geometry as estimate_geometry
from .optimise import optimise as optimise
from .rotor import BearingSupport as BearingSupport
from .rotor import Disc as Disc
from .rotor import Housing as Housing
from .rotor import LinearSupport as LinearSupport
from .rotor import ModalDamping as ModalDamping
from .rotor import PointMass as PointMass
from .rotor import ProportionalDamping as ProportionalDamping
from .rotor import Rotor as Rotor
from .rotor import RotorLoads as RotorLoads
from .rotor import Shaft as Shaft
from .rotor import StationForce as StationForce
from .rotor import Unbalance as Unbalance
from .rotor import campbell as campbell
from .rotor import critical_speeds as critical_speeds
from .rotor import harmonic_response as harmonic_response
from .rotor import modes as modes
from .rotor import preload_offset as preload_offset
from .rotor import settle as settle
from .rotor import settle_over as settle_over
from .rotor import stiffness_table as stiffness_table
from .rotor import to_ross as to_ross
from .rotor import unbalance_response as unbalance_response
from .scene import CatalogueEntry as CatalogueEntry
from .scene import SceneError as SceneError
from .scene import catalogue as catalogue
from .scene import catalogue_entry as catalogue_entry
from .scene import load_bearing as load_bearing
from .scene import read_scene as read_scene
from .scene import run as run
from .scene import run_scene as run_scene
from .statics import BallSolution as BallSolution
from .statics import Cases as Cases
from .statics import Friction as Friction
from .statics import Installed as Installed
from .statics import Life as Life
from .statics import LifeConditions as LifeConditions
from .statics import OperatingPoint as OperatingPoint
from .statics import Ratings as Ratings
from .statics import RollerSolution as RollerSolution
from .statics import Solution as Solution
from .statics import SpectrumLife as SpectrumLife
from .statics import Sweep as Sweep
from .statics import dynamic_capacity as dynamic_capacity
from .statics import fatigue_load_limit as fatigue_load_limit
from .statics import films as films
from .statics import friction_torque as friction_torque
from .statics import linearise as linearise
from .statics import preload as preload
from .statics import rating_life as rating_life
from .statics import ratings as ratings
from .statics import refine as refine
from .statics import remaining_preload as remaining_preload
from .statics import restrained_freedoms as restrained_freedoms
from .statics import skf_friction_torque as skf_friction_torque
from .statics import solve_load as solve_load
from .statics import spectrum_life as spectrum_life
from .statics import stack_designs as stack_designs
from .statics import static_capacity as static_capacity
from .statics import sweep as sweep
from .statics import warnings as warnings

__version__ = _version("bearingjax")

"""Rolling-bearing mechanics in JAX: one energy, differentiated.

SI units everywhere (m, N, rad, kg, s, Pa). float64 is the working precision; turn it on
before the first array is made:

    import jax
    jax.config.update("jax_enable_x64", True)

What each part does stands in its own docstring: `help(bearingjax.statics)` (load
solves, sweeps, what to do when one fails), `element` (choices of numerics, speed),
`optimise`, `rotor`, `rotor.nonlinear`, `skid`, `noise`, `contact.halfspace`.

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
- Barrel rollers and their raceways are arcs; profiles are measured from the arcs. The
  origin of a spherical roller bearing is the centre of its sphere. Thrust bearings:
  the inner ring is the shaft washer, at -z; an inner-ring load along +z closes them.
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

import importlib as _importlib
from typing import TYPE_CHECKING as _TYPE_CHECKING

from . import cases as cases
from . import catalogue as catalogue
from . import contact as contact
from . import design as design
from . import element as element
from . import fits as fits
from . import friction as friction
from . import life as life
from . import lubrication as lubrication
from . import numerics as numerics
from . import statics as statics
from ._version import __version__ as __version__
from .cases import Cases as Cases
from .cases import spectrum_life as spectrum_life
from .cases import stack_designs as stack_designs
from .cases import sweep as sweep
from .catalogue import catalogue_entries as catalogue_entries
from .catalogue import catalogue_entry as catalogue_entry
from .design import AngularContactBallBearing as AngularContactBallBearing
from .design import BearingSet as BearingSet
from .design import CircularCrown as CircularCrown
from .design import CrossedRollerRow as CrossedRollerRow
from .design import CrownedEnds as CrownedEnds
from .design import CylindricalRollerBearing as CylindricalRollerBearing
from .design import CylindricalThrustRollerBearing as CylindricalThrustRollerBearing
from .design import DeepGrooveBallBearing as DeepGrooveBallBearing
from .design import FourPointBallBearing as FourPointBallBearing
from .design import FujiwaraKawase as FujiwaraKawase
from .design import JohnsGohar as JohnsGohar
from .design import Logarithmic as Logarithmic
from .design import Lundberg as Lundberg
from .design import Material as Material
from .design import NeedleRollerBearing as NeedleRollerBearing
from .design import PreloadSpring as PreloadSpring
from .design import Rib as Rib
from .design import Ribs as Ribs
from .design import SelfAligningBallRow as SelfAligningBallRow
from .design import SetRow as SetRow
from .design import SphericalRollerRow as SphericalRollerRow
from .design import SphericalThrustRollerBearing as SphericalThrustRollerBearing
from .design import Straight as Straight
from .design import Tabulated as Tabulated
from .design import TaperedRollerBearing as TaperedRollerBearing
from .design import TaperedThrustRollerBearing as TaperedThrustRollerBearing
from .design import ThrustBallBearing as ThrustBallBearing
from .design import ToroidalRollerBearing as ToroidalRollerBearing
from .element import FREEDOMS as FREEDOMS
from .element import BearingElement as BearingElement
from .element import Speed as Speed
from .fits import FitConditions as FitConditions
from .fits import Mounting as Mounting
from .friction import films as films
from .friction import friction_torque as friction_torque
from .life import LifeConditions as LifeConditions
from .life import dynamic_capacity as dynamic_capacity
from .life import rating_life as rating_life
from .life import ratings as ratings
from .life import static_capacity as static_capacity
from .lubrication import Lubricant as Lubricant
from .numerics import Result as Result
from .numerics import SolveError as SolveError
from .numerics import keep_programs as keep_programs
from .statics import Installed as Installed
from .statics import Solution as Solution
from .statics import linearise as linearise
from .statics import preload as preload
from .statics import refine as refine
from .statics import solve_load as solve_load
from .statics import warnings as warnings

if _TYPE_CHECKING:
    from . import files as files
    from . import noise as noise
    from . import optimise as optimise
    from . import plot as plot
    from . import report as report
    from . import rotor as rotor
    from . import shafts as shafts
    from . import skid as skid
    from . import studies as studies
    from .files import SceneError as SceneError
    from .studies.bearing.read_scene import load_bearing as load_bearing
    from .studies.bearing.read_scene import read_scene as read_scene
    from .studies.study import run as run


# Imported at first use: packages, and names of the top level with their package.
_LATE = dict.fromkeys(
    "files noise optimise plot report rotor shafts skid studies".split()
) | {
    "SceneError": "files",
    "load_bearing": "studies.bearing.read_scene",
    "read_scene": "studies.bearing.read_scene",
    "run": "studies.study",
}


def __getattr__(name: str):
    """Import a package, or a name of one, at its first use (PEP 562)."""
    if name not in _LATE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    package = _importlib.import_module(f"{__name__}.{_LATE[name] or name}")
    value = getattr(package, name) if _LATE[name] else package
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """All public names, imported or not."""
    return sorted({*globals(), *_LATE})

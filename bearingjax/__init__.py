"""Rolling-bearing mechanics in JAX: one energy, differentiated.

SI units everywhere (m, N, rad, kg, s, Pa). float64 is the working precision; turn it
on before the first array is made:

    import jax
    jax.config.update("jax_enable_x64", True)
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
from .design import Straight as Straight
from .design import Tabulated as Tabulated
from .design import TaperedRollerBearing as TaperedRollerBearing
from .design import ThrustBallBearing as ThrustBallBearing
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
from .optimise import MeanPressure as MeanPressure
from .optimise import Optimised as Optimised
from .optimise import PeakPressure as PeakPressure
from .optimise import Stiffness as Stiffness
from .optimise import StiffnessTarget as StiffnessTarget
from .optimise import Variable as Variable
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
from .scene import SceneError as SceneError
from .scene import load_bearing as load_bearing
from .scene import read_scene as read_scene
from .scene import run_scene as run_scene
from .statics import BallSolution as BallSolution
from .statics import Cases as Cases
from .statics import OperatingPoint as OperatingPoint
from .statics import RollerSolution as RollerSolution
from .statics import Solution as Solution
from .statics import Sweep as Sweep
from .statics import linearise as linearise
from .statics import preload as preload
from .statics import refine as refine
from .statics import restrained_freedoms as restrained_freedoms
from .statics import solve_load as solve_load
from .statics import stack_designs as stack_designs
from .statics import sweep as sweep
from .statics import warnings as warnings

__version__ = _version("bearingjax")

"""Nonlinear periodic vibration: orbits, their stability, branches over frequency."""

from .branch import Branch as Branch
from .branch import Event as Event
from .branch import follow as follow
from .continuation import Arclength as Arclength
from .continuation import ChangeOfParameter as ChangeOfParameter
from .continuation import Ending as Ending
from .continuation import Steps as Steps
from .continuation import trace as trace
from .harmonic_balance import HarmonicBalance as HarmonicBalance
from .harmonic_balance import hill_multipliers as hill_multipliers
from .method import AbstractMethod as AbstractMethod
from .orbit import PeriodicOrbit as PeriodicOrbit
from .orbit import solve_orbit as solve_orbit
from .rigid_rotor import OpposedPair as OpposedPair
from .rigid_rotor import RigidRotor as RigidRotor
from .rigid_rotor import natural_frequencies as natural_frequencies
from .rigid_rotor import rigid_rotor as rigid_rotor
from .shooting import Shooting as Shooting
from .support_law import AbstractSupportLaw as AbstractSupportLaw
from .support_law import CubicExpansion as CubicExpansion
from .support_law import FixedAngle as FixedAngle
from .support_law import Grooves as Grooves
from .support_law import MovingAngle as MovingAngle
from .system import AbstractVibration as AbstractVibration
from .system import Vibration as Vibration

"""Load solves and what they return."""

from .cases import Cases as Cases
from .cases import solve_case as solve_case
from .linearise import OperatingPoint as OperatingPoint
from .linearise import linearise as linearise
from .load import restrained_freedoms as restrained_freedoms
from .load import solve_load as solve_load
from .preload import preload as preload
from .solution import BallSolution as BallSolution
from .solution import RollerSolution as RollerSolution
from .solution import Solution as Solution
from .solution import Stats as Stats
from .solution import message as message
from .solution import warnings as warnings
from .sweep import Sweep as Sweep
from .sweep import stack_designs as stack_designs
from .sweep import sweep as sweep

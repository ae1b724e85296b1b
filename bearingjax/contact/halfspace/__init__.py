"""Elastic contact without Hertz's assumptions: bodies as half-spaces, cell by cell."""

from .ends import FreeEnds as FreeEnds
from .gradients import AbstractPressureSolver as AbstractPressureSolver
from .gradients import ConjugateGradients as ConjugateGradients
from .grid import Grid as Grid
from .grid import even_grid as even_grid
from .grid import graded_grid as graded_grid
from .influence import AbstractInfluence as AbstractInfluence
from .influence import influence as influence
from .love import love as love
from .pressure import ContactSolution as ContactSolution
from .pressure import solve_pressure as solve_pressure
from .problem import Pressed as Pressed
from .problem import Problem as Problem
from .roller import RollerContact as RollerContact
from .stress import Stress as Stress
from .stress import stress_below as stress_below
from .strips import Strips as Strips

"""Design optimisation: variables, measures, constraints and the searches.

`bearingjax.optimise` is the function of that name. Everything else is imported by
`from bearingjax.optimise import ...`.
"""

from .constraint import Constraint as Constraint
from .design_problem import Outcome as Outcome
from .measure import Displacement as Displacement
from .measure import EdgeLoad as EdgeLoad
from .measure import MeanPressure as MeanPressure
from .measure import PeakPressure as PeakPressure
from .measure import Stiffness as Stiffness
from .measure import StiffnessTarget as StiffnessTarget
from .optimise import History as History
from .optimise import Optimised as Optimised
from .optimise import optimise as optimise
from .variable import Variable as Variable
from .variable import design_numbers as design_numbers

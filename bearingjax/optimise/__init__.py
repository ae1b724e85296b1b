"""Design optimisation: variables, measures, constraints and the searches.

`optimise(element, cases, variables, objective, constraints)` takes a `BearingElement`,
a bearing on its seats (`Installed`), or a system such as a skidding bearing.

Any number on the drawing may be free between bounds (`Variable`). One compiled program
solves all operating cases and pulls the gradient back through them (reverse mode,
implicit function theorem), for little more than the solves; SciPy's L-BFGS-B (bounds)
and SLSQP (constraints) or any Optax descent do the rest.

Measures, as objective or in a `Constraint`: `PeakPressure`, `MeanPressure` (weighted by
hours), `EdgeLoad`, `Displacement`, `Stiffness`, `StiffnessTarget`, `RatingLife` (over a
load spectrum; as an objective made largest) and its inverse `Damage`, or any smooth
function `(element, cases, solution) -> scalar` of your own. Maxima are p-norms, never
below the true maximum (`best.after.exact`) and above it by at most (number of
samples)^(1/exponent). A line contact has no pressure peak at a roller end: keep load
off the ends with `EdgeLoad`. Designs that do not solve are rejected and listed in
`best.rejected`. `best.converged` says that the first-order conditions of a minimum
hold, with exact gradients (`best.optimality`, at most `tolerance`; of "nelder-mead" at
most its root), whatever the method says. Warnings about the best design are in
`best.after.warnings`. Balls and rollers that may skid: see `bearingjax.skid`; shafts on
several bearings: `bearingjax.shafts.ShaftDesign`. Worked: the notebook roller_bearing.

Names
-----

- The search: `optimise`, `SearchOptions`, `Variable`, `Constraint`, `design_numbers`.
- Measures of load and pressure: `PeakPressure`, `MeanPressure`, `EdgeLoad`.
- Measures of play: `OperatingClearance`, `OperatingPreload`.
- Measures of stiffness: `Displacement`, `Stiffness`, `StiffnessTarget`.
- Measures of life: `RatingLife`, `Damage`, `StaticSafety`.
- Results: `OptimisedDesign`, `Outcome`, `History`.
"""

from .constraint import Constraint
from .design_problem import Outcome
from .life import Damage, RatingLife, StaticSafety
from .measure import (
    Displacement,
    EdgeLoad,
    MeanPressure,
    OperatingClearance,
    OperatingPreload,
    PeakPressure,
    Stiffness,
    StiffnessTarget,
)
from .optimise import History, OptimisedDesign, SearchOptions, optimise
from .variable import Variable, design_numbers

__all__ = [
    "optimise", "SearchOptions", "Variable", "Constraint", "design_numbers",
    "PeakPressure", "MeanPressure", "EdgeLoad", "OperatingClearance",
    "OperatingPreload", "Displacement", "Stiffness", "StiffnessTarget", "RatingLife",
    "Damage", "StaticSafety", "OptimisedDesign", "Outcome", "History",
]  # fmt: skip

"""Decisions: numbers from measurements, the effect of tolerances, a choice of bearing.

`identify(model, cases, unknowns, readings, errors)` finds numbers of a design, or of
any differentiable function, from measurements, with their standard errors, what the
readings cannot tell, and which further reading would tell most.

Names
-----

- Numbers from measurements: `identify`, `Identified`, `Candidate`.
- Results as a function of numbers of the design: `CaseModel`, `stack`.
- A choice of bearing: `select`, `Requirements`, `Selection`.
"""

from .identify import Candidate, Identified, identify
from .predict import CaseModel, stack
from .select import Requirements, Selection, select

__all__ = [
    "identify", "Identified", "Candidate", "CaseModel", "stack", "select",
    "Requirements", "Selection",
]  # fmt: skip

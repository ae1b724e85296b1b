"""Decisions: numbers from measurements, the effect of tolerances, a choice of bearing.

`identify(model, cases, unknowns, readings, errors)` finds numbers of a design, or of
any differentiable function, from measurements, with their standard errors, what the
readings cannot tell, and which further reading would tell most.

Names
-----

- Numbers from measurements: `identify`, `Identified`, `Candidate`.
- Results as a function of numbers of the design: `CaseModel`, `stack`.
"""

from .identify import Candidate, Identified, identify
from .predict import CaseModel, stack

__all__ = ["identify", "Identified", "Candidate", "CaseModel", "stack"]

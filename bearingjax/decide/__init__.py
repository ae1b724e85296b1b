"""Decisions: numbers from measurements, the effect of tolerances, a choice of bearing.

`identify(model, cases, unknowns, readings, errors)` finds numbers of a design, or of
any differentiable function, from measurements, with their standard errors, what the
readings cannot tell, and which further reading would tell most.

Names
-----

- Numbers from measurements: `identify`, `Identified`, `Candidate`.
- Results as a function of numbers of the design: `CaseModel`.
- A bearing on its noise rig: `NoiseDesign`, `NoiseNumbers`, `NoiseLevel`.
- A choice of bearing: `select`, `Requirements`, `Selection`; of several positions of a
  system of shafts: `select_positions`, `PositionSelection`.
- What tolerances do: `tolerances`, `tighten`, `Scatter`, `within`,
  `class_scatters`.
- Their results: `Tolerances`, `Spread`, `Misses`, `Tightening`.
"""

from .identify import Candidate, Identified, identify
from .noise_design import NoiseDesign, NoiseLevel, NoiseNumbers
from .predict import CaseModel
from .scatter import Scatter, class_scatters, within
from .select import Requirements, Selection, select
from .select_positions import PositionSelection, select_positions
from .tolerance_effects import (
    Misses,
    Spread,
    Tightening,
    Tolerances,
    tighten,
    tolerances,
)

__all__ = [
    "identify", "Identified", "Candidate", "CaseModel", "NoiseDesign", "NoiseNumbers",
    "NoiseLevel", "select", "Requirements", "Selection", "select_positions",
    "PositionSelection", "tolerances", "tighten", "Scatter", "within",
    "class_scatters", "Tolerances", "Spread", "Misses", "Tightening",
]  # fmt: skip

"""Decisions under uncertainty: identification, tolerances, selection of bearings.

`identify(model, cases, unknowns, readings, errors)` estimates numbers of a design, or
of any differentiable function, from measurements, with their standard errors, the
combinations that the readings leave open, and the most useful further reading.

Names
-----

- Identification from measurements: `identify`, `Identified`, `Candidate`.
- Results as a function of numbers of the design: `CaseModel`.
- A bearing on its noise rig: `NoiseDesign`, `NoiseNumbers`, `NoiseLevel`.
- Selection of a bearing: `select`, `Requirements`, `Selection`; for several positions
  of a system of shafts: `select_positions`, `PositionSelection`.
- Tolerance analysis: `tolerances`, `tighten`, `Scatter`, `truncated_normal`,
  `class_scatters`.
- Its results: `Tolerances`, `Spread`, `Misses`, `Tightening`.
"""

from .identify import Candidate, Identified, identify
from .noise_design import NoiseDesign, NoiseLevel, NoiseNumbers
from .predict import CaseModel
from .scatter import Scatter, class_scatters, truncated_normal
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
    "PositionSelection", "tolerances", "tighten", "Scatter", "truncated_normal",
    "class_scatters", "Tolerances", "Spread", "Misses", "Tightening",
]  # fmt: skip

"""Ratings and rating life: ISO 281, ISO 76, ISO/TS 16281.

`dynamic_capacity`, `static_capacity` and `fatigue_load_limit` rate a bearing, or a set
of alike ones, by ISO 281 and ISO 76 from its geometry; `ratings`, and so every life,
takes what is given or what the catalogue prints for a bearing of it instead, and says
which is which. A catalogue's C may be higher: makers use factors of their own. Bearings
steeper than 45 degrees are rated by axial loads.

Names
-----

- Rating life: `rating_life`, `Life`, `LifeConditions`, `LIFE_OUTPUTS`, `life_warnings`.
- A required life: `judge_life`, `RequiredLife`.
- Load ratings: `ratings`, `Ratings`, `dynamic_capacity`, `static_capacity`,
  `fatigue_load_limit`, `given_rating_warnings`.
- Equivalent loads: `equivalent_load`, `EquivalentLoad`.
- Factors of life: `life_factor`, `reliability_factor`, `viscosity_ratio`,
  `Cleanliness`, `CLEANLINESS`.
"""

from .equivalent_load import EquivalentLoad, equivalent_load
from .life import LIFE_OUTPUTS, Life, LifeConditions, rating_life
from .life_factor import (
    CLEANLINESS,
    Cleanliness,
    life_factor,
    reliability_factor,
    viscosity_ratio,
)
from .life_warning import given_rating_warnings, life_warnings
from .rating import (
    Ratings,
    dynamic_capacity,
    fatigue_load_limit,
    ratings,
    static_capacity,
)
from .required_life import RequiredLife, judge_life

__all__ = [
    "rating_life", "Life", "LifeConditions", "LIFE_OUTPUTS", "life_warnings",
    "judge_life", "RequiredLife", "ratings", "Ratings", "dynamic_capacity",
    "static_capacity", "fatigue_load_limit", "given_rating_warnings", "equivalent_load",
    "EquivalentLoad", "life_factor", "reliability_factor", "viscosity_ratio",
    "Cleanliness", "CLEANLINESS",
]  # fmt: skip

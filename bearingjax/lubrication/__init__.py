"""Oil between rolling surfaces: viscosity, films, traction.

Names
-----

- Oils: `Lubricant`, `Density`, `OILS`, `iso_vg`, `mil_l_23699`, `free_volume_23699`.
- Viscosity over temperature: `Walther`, `Exponential`, `AbstractAmbient`,
  `viscosity_at_100`.
- Viscosity over pressure: `Barus`, `Roelands`, `FreeVolume`, `AbstractPressureLaw`.
- Pressure-viscosity coefficient: `ConstantCoefficient`, `DynamicCoefficient`,
  `KinematicCoefficient`, `AbstractCoefficient`.
- Films: `point_film`, `line_film`, `Film`, `Regime`, `lambda_ratio`.
- Factors of the film: `inlet_heating`, `WarmInlet`, `starvation`.
- Traction: `Newtonian`, `Eyring`, `LimitingStress`, `SlipCurve`, `DryFriction`,
  `AbstractTraction`, `Resultants`.
- Contact areas: `ellipse_patch`, `EllipsePatch`, `line_patch`, `LinePatch`,
  `AbstractPatch`.
"""

from .coefficient import (
    AbstractCoefficient,
    ConstantCoefficient,
    DynamicCoefficient,
    KinematicCoefficient,
)
from .film import Film, Regime, line_film, point_film
from .film_factors import WarmInlet, inlet_heating, lambda_ratio, starvation
from .lubricant import Density, Lubricant
from .oils import OILS, free_volume_23699, iso_vg, mil_l_23699
from .patch import AbstractPatch, EllipsePatch, LinePatch, ellipse_patch, line_patch
from .traction import (
    AbstractTraction,
    DryFriction,
    Eyring,
    LimitingStress,
    Newtonian,
    Resultants,
    SlipCurve,
)
from .viscosity import (
    AbstractAmbient,
    AbstractPressureLaw,
    Barus,
    Exponential,
    FreeVolume,
    Roelands,
    Walther,
)
from .viscosity_index import viscosity_at_100

__all__ = [
    "Lubricant", "Density", "OILS", "iso_vg", "mil_l_23699", "free_volume_23699",
    "Walther", "Exponential", "AbstractAmbient", "viscosity_at_100", "Barus",
    "Roelands", "FreeVolume", "AbstractPressureLaw", "ConstantCoefficient",
    "DynamicCoefficient", "KinematicCoefficient", "AbstractCoefficient", "point_film",
    "line_film", "Film", "Regime", "lambda_ratio", "inlet_heating", "WarmInlet",
    "starvation", "Newtonian", "Eyring", "LimitingStress", "SlipCurve", "DryFriction",
    "AbstractTraction", "Resultants", "ellipse_patch", "EllipsePatch", "line_patch",
    "LinePatch", "AbstractPatch",
]  # fmt: skip

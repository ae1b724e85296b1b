"""Friction torque, lubricant films of solved bearings, reference speed.

Names
-----

- Torque: `friction_torque`, `Friction`, `SUPPLIES`.
- SKF's model: `skf_friction_torque`, `SkfFriction`, `skf_series`, `skf_series_of`.
- Films: `films`, `Films`.
- Reference speed: `reference_speed`, `thermal_speed`, `reference_factors`, `heat_area`.
"""

from .contact_films import Films, films
from .friction import SUPPLIES, Friction, friction_torque
from .friction_skf import SkfFriction, skf_friction_torque, skf_series, skf_series_of
from .reference_speed import (
    heat_area,
    reference_factors,
    reference_speed,
    thermal_speed,
)

__all__ = [
    "friction_torque", "Friction", "SUPPLIES", "skf_friction_torque", "SkfFriction",
    "skf_series", "skf_series_of", "films", "Films", "reference_speed", "thermal_speed",
    "reference_factors", "heat_area",
]  # fmt: skip

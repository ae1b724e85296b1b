"""Thermal reference speed: where friction is the heat that a bearing gives off."""

import math
from typing import Any

from ..catalogue.entry import CatalogueEntry
from ..design.checks import positive
from ..numerics.constants import read_package_table, rows_by_name
from ..numerics.types import Number

_FACTORS: dict[str, dict[str, Any]] = {
    kind: rows_by_name(rows)
    for kind, rows in read_package_table(
        "bearingjax.friction", "reference_speed.toml"
    ).items()
}

_RADIAL = 12.0, 0.05, 0.016, 0.34
_THRUST = 24.0, 0.02, 0.020, 0.16
"""Viscosity [mm²/s], load over C0, heat flow [W/mm²] and how it falls above 50 000 mm²
[1]."""


def reference_factors(kind: str, series: str) -> tuple[float, float] | None:
    """Factors f0r and f1r of the friction at reference conditions [1].

    Args:
        kind: Type as in a scene, "spherical_roller".
        series: Dimension series of ISO 15 or ISO 104, "22" of a 22220, "94" of a 29412.

    Returns:
        The factors; `None` of types and series for which none are known here.

    Source: ISO 15312 (2003), table A.1, as far as transcriptions agree.
    """
    return _FACTORS.get(kind, {}).get(series)


def heat_area(
    bore: Any, outside_diameter: Any, width: Any, *, flat: bool = False
) -> Any:
    """Reference surface through which a bearing gives off heat [m²].

    π B (D + d) of radial bearings, π (D² - d²)/2 of cylindrical thrust bearings. That
    of spherical thrust bearings is π (D² + d1² - D1² - d²)/4, with the outside diameter
    of the shaft washer and the inside diameter of the housing washer.

    Args:
        bore: d [m].
        outside_diameter: D [m].
        width: B; T of tapered roller bearings [m].
        flat: Whether it is a cylindrical roller thrust bearing. Static.

    Source: ISO 15312 (2003), 5.2.
    """
    if flat:
        return 0.5 * math.pi * (outside_diameter**2 - bore**2)
    return math.pi * width * (outside_diameter + bore)


def reference_speed(
    mean_diameter: Number,
    area: Number,
    static_capacity: Number,
    factors: tuple[Number, Number],
    *,
    thrust: bool = False,
) -> Any:
    """Thermal reference speed of ISO 15312 [rad/s].

    At it a bearing of 70 °C in surroundings of 20 °C gives off what friction heats:
    under 5 % of C0 in oil of 12 mm²/s, thrust bearings under 2 % in 24 mm²/s. Makers
    who count with a friction of their own print other speeds.

    Args:
        mean_diameter: (d + D)/2 [m].
        area: Reference surface [m²] (`heat_area`).
        static_capacity: C0 [N].
        factors: f0r and f1r [1] (`reference_factors`).
        thrust: Whether it is a thrust bearing. Static.

    Returns:
        Speed, differentiable; of Python's or NumPy's numbers one of these.

    Raises:
        TypeError: If an argument is no number.
        ValueError: If one is not positive.

    Source: ISO 15312 (2003), equations 4 to 12.
    """
    names = ("mean_diameter", "m"), ("area", "m²"), ("static_capacity", "N")
    given = mean_diameter, area, static_capacity
    for (name, unit), value in zip(names, given, strict=True):
        positive("reference_speed", name, value, unit)
    for name, value in zip(("f0r", "f1r"), factors, strict=True):
        positive("reference_speed", name, value, "1")
    viscous, load = factors
    size, surface = 1e3 * mean_diameter, 1e6 * area
    thick, share, flow, fall = _THRUST if thrust else _RADIAL
    large = 0.5 * (surface / 5e4 + 1.0 + abs(surface / 5e4 - 1.0))  # at least 1
    heat = flow * surface * large**-fall
    # With x the cube root of the speed in rpm, a x^5 + b x^3 is the heat.
    turning = math.pi / 30e3
    a = turning * 1e-7 * viscous * thick ** (2 / 3) * size**3
    b = turning * load * share * static_capacity * size
    # From above, where Newton's steps of a convex function stay.
    most, other = (heat / a) ** 0.2, (heat / b) ** (1 / 3)
    x = 0.5 * (most + other - abs(most - other))  # the less of both
    for _ in range(8):
        x = x - (a * x**5 + b * x**3 - heat) / (5.0 * a * x**4 + 3.0 * b * x**2)
    return x**3 * math.pi / 30.0


def _factors_of(entry: CatalogueEntry) -> tuple[float, float] | None:
    """Factors f0r and f1r of a bearing of the catalogue, as `reference_factors`."""
    if entry.type == "angular_contact_ball" and entry.design["contact_angle"] < 0.38:
        return None  # those of the standard are from 22° to 45°
    # The digit of the type is not of the dimension series: 222, 62; 2 of NU 205.
    series, _ = entry.series
    if entry.type != "cylindrical_roller":
        series = series[1:]
    if not series:
        return None
    return reference_factors(entry.type, series.zfill(2))


def thermal_speed(entry: CatalogueEntry) -> float | None:
    """Thermal reference speed of a bearing of the catalogue by ISO 15312 [rad/s].

    Args:
        entry: The bearing.

    Returns:
        Speed (`reference_speed`); `None` without factors for its series or without C0.
    """
    factors = _factors_of(entry)
    if factors is None or entry.static_capacity is None:
        return None
    d, outside = entry.bore, entry.outside_diameter
    thrust = entry.type.endswith("thrust_roller")
    flat = entry.type == "cylindrical_thrust_roller"
    area = heat_area(d, outside, entry.width, flat=flat)
    if thrust and not flat:
        keys = "shaft_washer_diameter", "housing_washer_bore"
        shaft, housing = (entry.printed[key] for key in keys)
        area = 0.25 * math.pi * (outside**2 + shaft**2 - housing**2 - d**2)
    mean, load = 0.5 * (d + outside), entry.static_capacity
    return float(reference_speed(mean, area, load, factors, thrust=thrust))

"""Friction torque of a bearing by SKF's model: rolling and sliding parts.

The rolling part grows with viscosity and speed, less what the inlet warms and what the
track lacks of oil; the sliding part with the load, between friction in contact and in
the film. Drag of an oil bath and seals are not in it. Its constants are those of SKF's
bearings of a series; of other makers they are an estimate as Palmgren's are
(`friction_torque`).
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..catalogue.entry import CatalogueEntry
from ..design import (
    AbstractBearing,
    AngularContactBallBearing,
    CylindricalRollerBearing,
    CylindricalThrustRollerBearing,
    DeepGrooveBallBearing,
    FourPointBallBearing,
    SelfAligningBallRow,
    SphericalRollerRow,
    SphericalThrustRollerBearing,
    TaperedRollerBearing,
    ThrustBallBearing,
    ToroidalRollerBearing,
    rows_of,
)
from ..design.abstract import nearest_entry
from ..design.checks import check, one_of
from ..design.keywords import BALLS, ROLLERS
from ..life.rating import static_capacity as rated
from ..numerics.labels import to_xarray
from ..numerics.shown import Printable
from ..numerics.types import Number, Scalar, as_real
from ..numerics.units import unit
from ..statics.solution import Solution
from .friction import check_call, unit_loads, units_of

OILS = {"mineral": 0.05, "synthetic": 0.04, "transmission": 0.1}
"""Friction coefficient of sliding in a full film by the kind of oil [1]; rollers of
cylindrical bearings have 0.02 and tapers 0.002 in any."""

_BOUNDARY = 0.12
"""Friction coefficient of sliding without a film, once it turns [1]."""

_STARVED = {"grease": 6e-8, "oil_mist": 6e-8, "oil_bath": 3e-8, "oil_jet": 3e-8}
"""K_rs: how the track runs out of oil, by the supply [1]."""


class _Type(NamedTuple):
    """A type of bearing.

    Attributes:
        series: Constants by series; the first applies where the series is not known.
        kz: K_z of the type.
        span: D - d over the diameter of a rolling element, where d and D are unknown;
            `None`: they must be known.
        film: Its own coefficient in a film, or `None`.
        others: Row that the table has for all series without one of their own.
    """

    series: dict[str, tuple[float, ...]]
    kz: float
    span: float | None
    film: float | None = None
    others: str | None = None


def _by_name(**rows):
    """Rows by each of the names in a key, such as s62_622."""
    return {name: row for key, row in rows.items() for name in key[1:].split("_")}


# R1, R2, S1, S2.
_DEEP_GROOVE = _by_name(
    s62_622=(3.9e-7, 1.7, 3.23e-3, 36.5),
    s2_3=(4.4e-7, 1.7, 2.00e-3, 100.0),
    s42_43=(5.4e-7, 0.96, 3.00e-3, 40.0),
    s60_630=(4.1e-7, 1.7, 3.73e-3, 14.6),
    s63_623=(3.7e-7, 1.7, 2.84e-3, 92.8),
    s64=(3.6e-7, 1.7, 2.43e-3, 198.0),
    s160_161=(4.3e-7, 1.7, 4.63e-3, 4.25),
    s617_618_628_637_638=(4.7e-7, 1.7, 6.50e-3, 0.78),
    s619_639=(4.3e-7, 1.7, 4.75e-3, 3.6),
)
# R1, R2, R3, S1, S2, S3.
_ANGULAR = {
    "other": (5.03e-7, 1.97, 1.90e-12, 1.30e-2, 0.68, 1.91e-12),
    "72B": (4.33e-7, 2.02, 2.44e-12, 1.82e-2, 0.71, 2.44e-12),
    "73B": (4.54e-7, 2.02, 1.84e-12, 1.64e-2, 0.71, 1.84e-12),
    "72AC": (3.58e-7, 3.64, 3.55e-12, 1.14e-2, 1.55, 3.55e-12),
    "73AC": (3.48e-7, 3.64, 1.66e-12, 9.85e-3, 1.55, 1.66e-12),
}
_FOUR_POINT = {"QJ": (4.78e-7, 2.42, 1.40e-12, 1.20e-2, 0.90, 1.40e-12)}
_SELF_ALIGNING = {
    "12": (3.25e-7, 6.51, 2.43e-12, 4.36e-3, 9.33, 2.43e-12),
    "13": (3.11e-7, 5.76, 3.52e-12, 5.76e-3, 8.03, 3.52e-12),
    "22": (3.13e-7, 5.54, 3.12e-12, 5.84e-3, 6.60, 3.12e-12),
    "23": (3.11e-7, 3.87, 5.41e-12, 0.01, 4.35, 5.41e-12),
    "112": (3.25e-7, 6.16, 2.48e-12, 4.33e-3, 8.44, 2.48e-12),
    "130": (2.39e-7, 5.81, 1.10e-12, 7.25e-3, 7.98, 1.10e-12),
    "139": (2.44e-7, 7.96, 5.63e-13, 4.51e-3, 12.11, 5.63e-13),
}
# R1, S1; of all series.
_THRUST = {"51": (1.03e-6, 1.6e-2)}
# R1, S1, S2.
_CYLINDRICAL = _by_name(
    s2_3=(1.09e-6, 0.16, 0.0015),
    s4=(1.00e-6, 0.16, 0.0015),
    s10=(1.12e-6, 0.17, 0.0015),
    s12_20=(1.23e-6, 0.16, 0.0015),
    s22=(1.40e-6, 0.16, 0.0015),
    s23=(1.48e-6, 0.16, 0.0015),
)
# R1, R2, S1, S2.
_TAPERED = {
    "other": (2.31e-6, 10.9, 0.019, 2.0),
    "302": (1.76e-6, 10.9, 0.017, 2.0),
    "303": (1.69e-6, 10.9, 0.017, 2.0),
    "313": (1.84e-6, 10.9, 0.048, 2.0),
    "320": (2.38e-6, 10.9, 0.014, 2.0),
    "322": (2.27e-6, 10.9, 0.018, 2.0),
    "322B": (2.38e-6, 10.9, 0.026, 2.0),
    "323": (2.38e-6, 10.9, 0.019, 2.0),
    "323B": (2.79e-6, 10.9, 0.030, 2.0),
    "329": (2.31e-6, 10.9, 0.009, 2.0),
    "330": (2.71e-6, 11.3, 0.010, 2.0),
    "331": (2.71e-6, 10.9, 0.015, 2.0),
    "332": (2.71e-6, 10.9, 0.018, 2.0),
}
# R1 to R4, S1 to S4; E: with the rollers of the series E.
_SPHERICAL = _by_name(
    s213E_222E=(1.6e-6, 5.84, 2.81e-6, 5.8, 3.62e-3, 508.0, 8.8e-3, 117.0),
    s222=(2.0e-6, 5.54, 2.92e-6, 5.5, 5.10e-3, 414.0, 9.7e-3, 100.0),
    s223=(1.7e-6, 4.1, 3.13e-6, 4.05, 6.92e-3, 124.0, 1.7e-2, 41.0),
    s223E=(1.6e-6, 4.1, 3.14e-6, 4.05, 6.23e-3, 124.0, 1.7e-2, 41.0),
    s230=(2.4e-6, 6.44, 3.76e-6, 6.4, 4.13e-3, 755.0, 1.1e-2, 160.0),
    s231=(2.4e-6, 4.7, 4.04e-6, 4.72, 6.70e-3, 231.0, 1.7e-2, 65.0),
    s232=(2.3e-6, 4.1, 4.00e-6, 4.05, 8.66e-3, 126.0, 2.1e-2, 41.0),
    s238=(3.1e-6, 12.1, 3.82e-6, 12.0, 1.74e-3, 9495.0, 5.9e-3, 1057.0),
    s239=(2.7e-6, 8.53, 3.87e-6, 8.47, 2.77e-3, 2330.0, 8.5e-3, 371.0),
    s240=(2.9e-6, 4.87, 4.78e-6, 4.84, 6.95e-3, 240.0, 2.1e-2, 68.0),
    s241=(2.6e-6, 3.8, 4.79e-6, 3.7, 1.00e-2, 86.7, 2.9e-2, 31.0),
    s248=(3.8e-6, 9.4, 5.09e-6, 9.3, 2.80e-3, 3415.0, 1.2e-2, 486.0),
    s249=(3.0e-6, 6.67, 5.09e-6, 6.62, 3.90e-3, 887.0, 1.7e-2, 180.0),
)
# R1, R2, S1, S2; by the digits of C 30 and so on.
_TOROIDAL = {
    "22": (1.17e-6, 2.08e-6, 1.32e-3, 0.8e-2),
    "23": (1.20e-6, 2.28e-6, 1.24e-3, 0.9e-2),
    "30": (1.40e-6, 2.59e-6, 1.58e-3, 1.0e-2),
    "31": (1.37e-6, 2.77e-6, 1.30e-3, 1.1e-2),
    "32": (1.33e-6, 2.63e-6, 1.31e-3, 1.1e-2),
    "39": (1.45e-6, 2.55e-6, 1.84e-3, 1.0e-2),
    "40": (1.53e-6, 3.15e-6, 1.50e-3, 1.3e-2),
    "41": (1.49e-6, 3.11e-6, 1.32e-3, 1.3e-2),
    "49": (1.49e-6, 3.24e-6, 1.39e-3, 1.5e-2),
    "59": (1.77e-6, 3.81e-6, 1.80e-3, 1.8e-2),
    "60": (1.83e-6, 5.22e-6, 1.17e-3, 2.8e-2),
    "69": (1.85e-6, 4.53e-6, 1.61e-3, 2.3e-2),
}
# R1, S1; of all series.
_CYLINDRICAL_THRUST = {"81": (2.25e-6, 0.154)}
# R1 to R4, S1 to S5.
_SPHERICAL_THRUST = {
    "292": (1.32e-6, 1.57, 1.97e-6, 3.21, 4.53e-3, 0.26, 0.02, 0.10, 0.60),
    "292E": (1.32e-6, 1.65, 2.09e-6, 2.92, 5.98e-3, 0.23, 0.03, 0.17, 0.56),
    "293": (1.39e-6, 1.66, 1.96e-6, 3.23, 5.52e-3, 0.25, 0.02, 0.10, 0.60),
    "293E": (1.16e-6, 1.64, 2.00e-6, 3.04, 4.26e-3, 0.23, 0.025, 0.15, 0.58),
    "294E": (1.25e-6, 1.67, 2.15e-6, 2.86, 6.42e-3, 0.21, 0.04, 0.20, 0.54),
}
_TYPES: dict[type, _Type] = {
    DeepGrooveBallBearing: _Type(_DEEP_GROOVE, 3.1, 3.4),
    AngularContactBallBearing: _Type(_ANGULAR, 4.4, 3.4, others="other"),
    FourPointBallBearing: _Type(_FOUR_POINT, 3.1, 3.2, others="QJ"),
    SelfAligningBallRow: _Type(_SELF_ALIGNING, 4.8, 3.8),
    ThrustBallBearing: _Type(_THRUST, 3.8, 2.6, others="51"),
    CylindricalRollerBearing: _Type(_CYLINDRICAL, 5.1, 3.9, 0.02),
    TaperedRollerBearing: _Type(_TAPERED, 6.0, 4.8, 0.002, "other"),
    SphericalRollerRow: _Type(_SPHERICAL, 5.5, 3.8),
    ToroidalRollerBearing: _Type(_TOROIDAL, 5.3, None),
    CylindricalThrustRollerBearing: _Type(_CYLINDRICAL_THRUST, 4.4, 3.9, others="81"),
    SphericalThrustRollerBearing: _Type(_SPHERICAL_THRUST, 5.6, None),
}


class SkfFriction(Printable):
    """Friction torque against the rotation of one ring in the other.

    Attributes:
        rolling_torque: M_rr of each row, reduced by warm inlets and lack of oil
            (row,) [N m].
        sliding_torque: M_sl of each row (row,) [N m].
        speed: Speed of the inner ring less that of the outer [rad/s].
        series: The row of SKF's table whose constants these are. Static.
        assumed: Whether the row is an assumption, the first of several of the type, as
            the series was not given. Static.
    """

    rolling_torque: Float[Array, " row"] = eqx.field(metadata=unit("N m"))
    sliding_torque: Float[Array, " row"] = eqx.field(metadata=unit("N m"))
    speed: Scalar = eqx.field(metadata=unit("rad/s"))
    series: str = eqx.field(static=True)
    assumed: bool = eqx.field(static=True, default=False)

    to_xarray = to_xarray

    @property
    def torque(self) -> Any:
        """Total friction torque [N m]."""
        return (self.rolling_torque + self.sliding_torque).sum(axis=-1)

    @property
    def power(self) -> Any:
        """Heat that the torque makes [W]."""
        return self.torque * abs(self.speed)


def skf_series(bearing: Any) -> tuple[str, ...]:
    """Series with constants of their own, of the type of a bearing or set.

    The first applies to bearings of the type whose series is not known. Empty for types
    that the model does not have, such as needle roller bearings.

    Args:
        bearing: Any bearing or set.
    """
    kind = _TYPES.get(type(rows_of(bearing)[0].bearing))
    return () if kind is None else tuple(kind.series)


def skf_series_of(entry: CatalogueEntry) -> str | None:
    """Row of SKF's table for a bearing of the catalogue, for `skf_friction_torque`.

    Args:
        entry: The bearing.

    Returns:
        One of `skf_series`, such as "62" of 6205, "222E" of 22208 E, "other" of 7205 C;
        `None` of a type that the model does not have, or a series without a row.
    """
    kind = _TYPES.get({**BALLS, **ROLLERS}[entry.type])
    if kind is None:
        return None
    digits, letters = entry.series
    for design in ("AC", "B", "E"):
        if letters.startswith(design) and digits + design in kind.series:
            return digits + design
    return digits if digits in kind.series else kind.others


def skf_friction_torque(
    solution: Solution,
    viscosity: Number,
    supply: str = "oil_bath",
    static_capacity: Number | None = None,
    *,
    series: str | None = None,
    diameters: tuple[Number, Number] | None = None,
    oil: str = "mineral",
) -> SkfFriction:
    """Friction torque of a solved bearing by SKF's model, by the rows of a set.

    M_rr = φ_ish φ_rs G_rr (ν n)^0.6 and M_sl = µ_sl G_sl, in N mm with ν in mm²/s and n
    in 1/min. G_rr and G_sl depend on the mean diameter and the load as SKF's tables
    give it for the type; µ_sl is 0.12 without a film and that of `OILS` in a film.

    Args:
        solution: Solved at a speed.
        viscosity: Kinematic viscosity at the temperature of operation, of a grease that
            of its oil [m²/s].
        supply: One of `SUPPLIES`. A bath is a low one, a mist is oil and air; an
            upright bath has no drag in it.
        static_capacity: C0 of one row [N], for the load angle of deep groove bearings;
            `None`: ISO 76 from geometry.
        series: Whose constants, one of `skf_series`, of a bearing of the catalogue that
            of `skf_series_of`; `None`: the first of them, which is said (`assumed`).
        diameters: Bore and outside diameter [m]; `None`: the pitch diameter is taken as
            their mean, and their difference from the size of the rolling elements.
            Toroidal and spherical thrust roller bearings need them.
        oil: One of `OILS`.

    Raises:
        TypeError: If `solution` is none.
        ValueError: For a solution without speed, another supply, series or oil, a type
            without constants, or a viscosity or diameters that are not allowed.

    Source: SKF, The SKF model for calculating the frictional moment (catalogue 10000,
        2013 and later). Forms, φ_bl and µ as printed there. Constants of the series as
        two public programs have transcribed them, which agree with each other, those of
        series 62 with a third; K_z, K_rs and µ = 0.12 likewise (an earlier print has
        0.15). Spherical, toroidal and thrust rollers as one of them has them; another
        agrees with it in series 222 E.
    """
    check_call("skf_friction_torque", solution, viscosity, supply)
    bearing = solution.element.bearing
    first = rows_of(bearing)[0].bearing
    kind = _TYPES.get(type(first))
    if kind is None:
        raise ValueError(
            f"skf_friction_torque: SKF's model has no {type(first).__name__}; it must"
            f" be one of {', '.join(one.__name__ for one in _TYPES)}."
        )
    names = tuple(kind.series)
    assumed = series is None and len(kind.series) > 1
    series = names[0] if series is None else series
    one_of("skf_friction_torque", "series", series, names)
    one_of("skf_friction_torque", "oil", oil, OILS)
    d_mean, span = _diameters(first, kind, diameters)
    assert solution.speed is not None
    speed = solution.speed.inner - solution.speed.outer
    rpm, oiled = abs(speed) * (30.0 / jnp.pi), 1e6 * as_real(viscosity)
    flow = oiled * rpm
    warm = 1.84e-9 * _power(rpm * d_mean, 1.28) * _power(oiled, 0.64)
    starved = _STARVED[supply] * flow * 2.0 * d_mean * jnp.sqrt(kind.kz / (2.0 * span))
    rolling = jnp.exp(-starved) / (1.0 + warm) * _power(flow, 0.6)
    dry = jnp.exp(-2.6e-8 * _power(flow, 1.4) * d_mean)
    film = OILS[oil] if kind.film is None else kind.film
    sliding = dry * _BOUNDARY + (1.0 - dry) * film
    parts = []
    for row, (radial, axial, _) in zip(
        units_of(bearing), unit_loads(solution), strict=True
    ):
        capacity = rated(row) if static_capacity is None else as_real(static_capacity)
        given = kind.series[series], d_mean, radial, axial, rpm, capacity, flow
        parts.append(_variables(first, *given))
    of_rolling, of_sliding = (jnp.stack(v) for v in zip(*parts, strict=True))
    torques = 1e-3 * rolling * of_rolling, 1e-3 * sliding * of_sliding
    return SkfFriction(*torques, speed, series, assumed)


class _Unit(NamedTuple):
    """A unit of the formulas: mean diameter [mm], radial and axial load [N], speed
    [1/min], static capacity [N], viscosity times speed, contact angle [rad]."""

    d: Any
    radial: Any
    axial: Any
    rpm: Any
    capacity: Any
    flow: Any
    angle: Any


def _deep_groove(row, unit):
    """G_rr and G_sl of a deep groove ball bearing, in mm and N.

    SKF's forms with and without axial load do not join: G_sl grows by d^0.115, a half,
    with the first newton. An axial load at the level of round-off counts as zero.
    """
    (r1, r2, s1, s2), (d, radial, axial, _, capacity, *_) = row, unit
    loaded = axial > 1e-6 * radial
    share = jnp.where(loaded, axial, capacity) / capacity
    sine = jnp.sin(jnp.deg2rad(24.6 * share**0.24))
    rolling = r1 * d**1.96 * _power(radial + r2 / sine * axial, 0.54)
    both = radial**5 + s2 * d**1.5 / sine * axial**4
    thrust = s1 * d**-0.145 * _power(both, 1 / 3)
    alone = s1 * d**-0.26 * _power(radial, 5 / 3)
    return rolling, jnp.where(loaded, thrust, alone)


def _angular(row, unit, powers=(1.97, 0.26, 4.0)):
    (r1, r2, r3, s1, s2, s3), (d, radial, axial, rpm, *_) = row, unit
    turning = d ** powers[2] * rpm**2
    rolling = r1 * d ** powers[0] * _power(radial + r3 * turning + r2 * axial, 0.54)
    both = _power(radial + s3 * turning, 4 / 3) + s2 * _power(axial, 4 / 3)
    return rolling, s1 * d ** powers[1] * both


def _thrust_balls(row, unit):
    (r1, s1), (d, _, axial, *_) = row, unit
    return r1 * d**1.83 * _power(axial, 0.54), s1 * d**0.05 * _power(axial, 4 / 3)


def _cylindrical(row, unit):
    (r1, s1, s2), (d, radial, axial, *_) = row, unit
    rolling = r1 * d**2.41 * _power(radial, 0.31)
    return rolling, s1 * d**0.9 * axial + s2 * d * radial


def _tapered(row, unit):
    (r1, r2, s1, s2), (d, radial, axial, *_) = row, unit
    thrust = 0.4 / jnp.tan(unit.angle) * axial
    rolling = r1 * d**2.38 * _power(radial + r2 * thrust, 0.31)
    return rolling, s1 * d**0.82 * (radial + s2 * thrust)


def _thrust_rollers(row, unit):
    (r1, s1), (d, _, axial, *_) = row, unit
    return r1 * d**2.38 * _power(axial, 0.31), s1 * d**0.62 * axial


def _toroidal(row, unit):
    (r1, r2, s1, s2), (d, radial, *_) = row, unit
    # SKF passes between forms that differ by up to 9 % there; the lesser do not.
    light, heavy = _power(radial, 0.54), _power(radial, 0.31)
    rolling = jnp.minimum(r1 * d**1.97 * light, r2 * d**2.37 * heavy)
    slid = s1 * d**-0.19 * _power(radial, 5 / 3)
    return rolling, jnp.minimum(slid, s2 * d**1.05 * radial)


def _spherical(row, unit):
    (r1, r2, r3, r4, s1, s2, s3, s4), (d, radial, axial, *_) = row, unit
    point = r1 * d**1.85 * _power(radial + r2 * axial, 0.54)
    line = r3 * d**2.3 * _power(radial + r4 * axial, 0.31)
    slid = s1 * d**0.25 * _power(radial**4 + s2 * axial**4, 1 / 3)
    lined = s3 * d**0.94 * _power(radial**3 + s4 * axial**3, 1 / 3)
    return jnp.minimum(point, line), jnp.minimum(slid, lined)


def _spherical_thrust(row, unit):
    (r1, r2, r3, r4, s1, s2, s3, s4, s5), (d, radial, axial, _, _, flow, _) = row, unit
    point = r1 * d**1.96 * _power(radial + r2 * axial, 0.54)
    line = r3 * d**2.39 * _power(radial + r4 * axial, 0.31)
    slid = s1 * d**-0.35 * (_power(radial, 5 / 3) + s2 * _power(axial, 5 / 3))
    least = jnp.minimum(slid, s3 * d**0.89 * (radial + axial))
    # The rib slides as long as no film parts it from the rollers.
    rib = s4 * d**0.76 * (radial + s5 * axial) * jnp.exp(-1e-6 * flow**1.4 * d)
    return jnp.minimum(point, line), least + rib


_VARIABLES: dict[type, Callable[..., tuple[Any, Any]]] = {
    AbstractBearing: _angular,
    DeepGrooveBallBearing: _deep_groove,
    SelfAligningBallRow: partial(_angular, powers=(2.0, -0.12, 3.5)),
    ThrustBallBearing: _thrust_balls,
    CylindricalRollerBearing: _cylindrical,
    TaperedRollerBearing: _tapered,
    CylindricalThrustRollerBearing: _thrust_rollers,
    ToroidalRollerBearing: _toroidal,
    SphericalRollerRow: _spherical,
    SphericalThrustRollerBearing: _spherical_thrust,
}
"""G_rr and G_sl of a unit by class, of its constants and loads, in mm and N."""


def _variables(bearing, row, d, radial, axial, rpm, capacity, flow=0.0):
    """G_rr and G_sl of a unit of the bearing, in mm and N."""
    angle = bearing.nominal_contact_angle
    unit = _Unit(d, radial, axial, rpm, capacity, flow, angle)
    return nearest_entry(_VARIABLES, bearing)(row, unit)


def _diameters(bearing, kind, given):
    """Mean diameter and D - d [mm]."""
    if given is None:
        if kind.span is None:
            raise ValueError(
                "skf_friction_torque: `diameters` is None; it must be bore and outside"
                f" diameter in m for a {type(bearing).__name__}."
            )
        size = 1e3 * bearing.element_diameter
        return 1e3 * bearing.pitch_diameter, kind.span * size
    bore, outside = (as_real(x) for x in given)
    allowed = "two diameters above 0 m, the bore before the larger outside diameter"
    fits = (bore > 0.0) & (bore < outside)
    check("skf_friction_torque", "diameters", fits, allowed, outside, "m")
    return 0.5e3 * (bore + outside), 1e3 * (outside - bore)


def _power(x, exponent):
    """x^exponent, with zero derivative where x is 0."""
    some = x > 0.0
    return jnp.where(some, jnp.where(some, x, 1.0) ** exponent, 0.0)

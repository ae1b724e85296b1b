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

from .. import design
from ..catalogue.entry import CatalogueEntry
from ..design import AbstractBearing, ThrustBallBearing, rows_of
from ..design.abstract import nearest_entry
from ..design.checks import check, one_of
from ..design.keywords import BALLS, ROLLERS
from ..life.rating import static_capacity as rated
from ..numerics.constants import read_package_table, rows_by_name
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
    span: float | None = None
    film: float | None = None
    others: str | None = None


_TYPES: dict[type, _Type] = {
    getattr(design, name): _Type(
        **numbers | {"series": rows_by_name(numbers["series"])}
    )
    for name, numbers in read_package_table(
        "bearingjax.friction", "friction_skf.toml"
    ).items()
}
"""The constants of each type, by its class."""


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
    for inside in ("AC", "B", "E"):
        if letters.startswith(inside) and digits + inside in kind.series:
            return digits + inside
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
    design.DeepGrooveBallBearing: _deep_groove,
    design.SelfAligningBallRow: partial(_angular, powers=(2.0, -0.12, 3.5)),
    ThrustBallBearing: _thrust_balls,
    design.CylindricalRollerBearing: _cylindrical,
    design.TaperedRollerBearing: _tapered,
    design.CylindricalThrustRollerBearing: _thrust_rollers,
    design.ToroidalRollerBearing: _toroidal,
    design.SphericalRollerRow: _spherical,
    design.SphericalThrustRollerBearing: _spherical_thrust,
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

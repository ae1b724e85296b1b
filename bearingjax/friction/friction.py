"""Friction torque of a bearing by the catalogue: Palmgren's two parts.

One part grows with the load, the other with the speed and the oil. Measured torques
scatter about them by some tens of per cent; seals are not in them. What rolling
elements that slip really do is `bearingjax.skid`.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import (
    AbstractBallBearing,
    AbstractBearing,
    AbstractRollerBearing,
    AngularContactBallBearing,
    BearingSet,
    CylindricalRollerBearing,
    CylindricalThrustRollerBearing,
    DeepGrooveBallBearing,
    FourPointBallBearing,
    NeedleRollerBearing,
    SelfAligningBallRow,
    SphericalRollerRow,
    SphericalThrustRollerBearing,
    TaperedRollerBearing,
    TaperedThrustRollerBearing,
    ThrustBallBearing,
    rows_of,
)
from ..design.abstract import nearest_entry
from ..design.bearing_set import bearings_of, is_self_aligning
from ..design.checks import check, of_class, one_of, positive
from ..life.equivalent_load import equivalent_load
from ..life.rating import static_capacity as rated
from ..numerics.labels import to_xarray
from ..numerics.shown import Printable
from ..numerics.types import Number, Scalar, as_real
from ..numerics.units import unit
from ..statics.solution import Solution, check_single

SUPPLIES = ("grease", "oil_mist", "oil_bath", "oil_jet")
"""Types of lubricant supply; a jet counts as an oil bath with a vertical shaft."""


class _Kind(NamedTuple):
    """Constants of a type of bearing: f0 of `SUPPLIES`, f1 = z (P0/C0)^y.

    A `viscous` of `None` was not found in any source.
    """

    viscous: tuple[float, float | None, float, float]
    z: float
    y: float


_CYLINDERS = _Kind((0.8, 2.1, 3.0, 3.0), 0.0003, 0.0)
# Where the sources give a range, its middle.
_KINDS: dict[type, _Kind | None] = {
    CylindricalRollerBearing: _CYLINDERS,
    DeepGrooveBallBearing: _Kind((1.4, 1.0, 2.0, 4.0), 0.0006, 0.55),
    AngularContactBallBearing: _Kind((2.0, 1.7, 3.3, 6.6), 0.001, 1 / 3),
    FourPointBallBearing: _Kind((6.0, 2.0, 6.0, 9.0), 0.001, 1 / 3),
    SelfAligningBallRow: _Kind((1.75, 0.85, 1.75, 3.5), 0.0003, 0.4),
    ThrustBallBearing: _Kind((5.5, 0.8, 1.5, 3.0), 0.0008, 1 / 3),
    TaperedRollerBearing: _Kind((6.0, 3.0, 6.0, 9.0), 0.0004, 0.0),
    NeedleRollerBearing: _Kind((12.0, 6.0, 12.0, 24.0), 0.002, 0.0),
    SphericalRollerRow: _Kind((6.0, 3.0, 6.0, 12.0), 0.0006, 0.0),
    CylindricalThrustRollerBearing: _Kind((9.0, 1.75, 3.5, 7.0), 0.0015, 0.0),
    SphericalThrustRollerBearing: _Kind((3.5, None, 3.5, 7.0), 0.0004, 0.0),
    TaperedThrustRollerBearing: None,
}
_FLANGE = {"grease": 0.009, "oil_mist": 0.006, "oil_bath": 0.006, "oil_jet": 0.006}

_SLOW = 2000e-6 / 60.0
"""ν n below which the oil's part is constant: 2000 mm²/s per minute [m²/s²]."""


class Friction(Printable):
    """Friction torque against the rotation of one ring in the other.

    Attributes:
        load_torque: Part of each row that grows with its load (row,) [N m].
        viscous_torque: Part of each row that the oil makes (row,) [N m].
        flange_torque: Rib torque of cylindrical roller bearings under axial load
            (row,) [N m].
        speed: Speed of the inner ring less that of the outer [rad/s].
    """

    load_torque: Float[Array, " row"] = eqx.field(metadata=unit("N m"))
    viscous_torque: Float[Array, " row"] = eqx.field(metadata=unit("N m"))
    flange_torque: Float[Array, " row"] = eqx.field(metadata=unit("N m"))
    speed: Scalar = eqx.field(metadata=unit("rad/s"))

    to_xarray = to_xarray

    @property
    def torque(self) -> Any:
        """Total friction torque [N m]."""
        parts = self.load_torque + self.viscous_torque + self.flange_torque
        return parts.sum(axis=-1)

    @property
    def power(self) -> Any:
        """Heat that the torque makes [W]."""
        return self.torque * abs(self.speed)


def friction_torque(
    solution: Solution,
    viscosity: Number,
    supply: str = "oil_bath",
    static_capacity: Number | None = None,
) -> Friction:
    """Friction torque of a solved bearing, by the rows of a set.

    M0 = f0 (ν n)^(2/3) dm³ 1e-7 N mm, and below ν n = 2000 f0 dm³ 160e-7 N mm;
    M1 = f1 F dm, F the greatest of Fr and, with k = 0.9 for balls and 0.8 for rollers,
    k Fa cot α - 0.1 Fr (rollers: without the last part; deep groove balls:
    3 Fa - 0.1 Fr; thrust bearings: Fa; spherical rollers: 1.6 Fa/e above the e of
    ISO 281, (1 + 0.6 (Fa/(e Fr))³) Fr below). ν in mm²/s, n in 1/min, lengths in mm, dm
    the pitch diameter. f1 = z (P0/C0)^y. Axial load Fa on ribs of cylindrical rollers
    adds 0.006 Fa dm, 0.009 Fa dm in grease.

    Args:
        solution: Solved at a speed.
        viscosity: Kinematic viscosity at the temperature of operation, of a grease that
            of its oil [m²/s].
        supply: One of `SUPPLIES`.
        static_capacity: C0 of one row [N]; `None`: ISO 76 from geometry.

    Raises:
        TypeError: If `solution` is none.
        ValueError: For several solutions at once (map over them), a solution without
            speed, another supply, a viscosity that is not positive, or a type of
            bearing whose constants were found nowhere: toroidal, crossed and tapered
            thrust rollers, spherical thrust rollers in a mist.

    Valid: medium speeds and loads, two surfaces parted by the film or nearly so.
    Source: Palmgren, as Harris & Kotzalas, Rolling Bearing Analysis, print it in the
        chapter on friction; the constants of each type there and in catalogues of SKF
        of the time. Those of a bath and of grease agree with Jungnickel (2010), as a
        public thermal library (thermca) quotes him, but for deep groove balls in
        grease, 1.0 there; for a mist he has half, for a jet twice the value of a bath.
        Spherical and cylindrical thrust rollers by Jungnickel alone, the load of the
        former by Schaeffler (2013), both quoted by thermca. Spherical thrust rollers:
        f0 of SKF, series 293, f1 of ISO 15312 (0.0003 to 0.0005).
    """
    check_call("friction_torque", solution, viscosity, supply)
    assert solution.speed is not None
    bearing = solution.element.bearing
    speed = solution.speed.inner - solution.speed.outer
    parts = [
        _of_row(row, load, as_real(viscosity) * abs(speed), supply, static_capacity)
        for row, (_, _, load) in zip(
            units_of(bearing), unit_loads(solution), strict=True
        )
    ]
    load, viscous, flange = (jnp.stack(v) for v in zip(*parts, strict=True))
    return Friction(load, viscous, flange, speed)


def check_call(owner: str, solution: Any, viscosity: Any, supply: Any) -> None:
    """Raise unless the friction torque of a solution can be computed.

    Raises:
        TypeError, ValueError: As `friction_torque`.
    """
    allowed = "a Solution, as returned by solve_load"
    of_class(owner, "solution", solution, Solution, allowed)
    check_single(owner, solution)
    if solution.speed is None:
        raise ValueError(f"{owner}: `solution` is at rest; solve it with `speed`.")
    one_of(owner, "supply", supply, SUPPLIES)
    viscosity = as_real(viscosity)
    positive(owner, "viscosity", viscosity, "m²/s")
    # A viscosity in mm²/s would be a million times too large.
    allowed = "below 1 m²/s (1 mm²/s is 1e-6 m²/s)"
    check(owner, "viscosity", viscosity < 1.0, allowed, viscosity, "m²/s")


def units_of(bearing: AbstractBearing | BearingSet) -> list[Any]:
    """Units that count as one bearing: a row, or both rows of a self-aligning one."""
    if is_self_aligning(bearing):
        return [bearing]
    return list(bearings_of(bearing))


def unit_loads(solution: Solution) -> list[tuple[Scalar, Scalar, Any]]:
    """Radial and axial load of each of `units_of` [N], and its load (6,)."""
    bearing = solution.element.bearing
    first = 0 if solution.moving_ring == "outer" else 6
    alone = not isinstance(bearing, BearingSet) or is_self_aligning(bearing)
    loads = [solution.force[first : first + 6]] if alone else _row_loads(solution)
    return [(*_directions(load), load) for load in loads]


def _outer_of_balls(solution, mine, bearing):
    """Loads of the outer raceway contacts of a row [N], and their angles [rad]."""
    half = solution.contact_load.shape[1] // 2
    return solution.contact_load[mine, :half], solution.contact_angle[mine, :half]


def _outer_of_rollers(solution, mine, bearing):
    return solution.roller_load[mine, :1], bearing.nominal_contact_angle


_OUTER = {
    AbstractBallBearing: _outer_of_balls,
    AbstractRollerBearing: _outer_of_rollers,
}


def _row_loads(solution) -> list[Any]:
    """Resultant force of the outer raceway contacts of every row, without ribs."""
    found, begin = [], 0
    pairs = zip(solution.row_sizes, solution.element.bearing.rows, strict=True)
    for size, row in pairs:
        mine = slice(begin, begin + size)
        begin += size
        load, angle = nearest_entry(_OUTER, row.bearing)(solution, mine, row.bearing)
        across = jnp.sum(load * jnp.cos(angle), axis=1)
        azimuth = solution.azimuth[mine]
        found.append(
            jnp.stack(
                [
                    jnp.sum(across * jnp.cos(azimuth)),
                    jnp.sum(across * jnp.sin(azimuth)),
                    jnp.sum(load * jnp.sin(angle)),
                    *3 * [jnp.zeros_like(across[0])],
                ]
            )
        )
    return found


def _of_row(bearing: AbstractBearing | BearingSet, load, flow, supply, capacity):
    """Load, viscous and flange torque of one bearing; `flow` is ν ω [m²/s²]."""
    row: Any = rows_of(bearing)[0].bearing
    kind, viscous = _constants(row, supply)
    pitch = row.pitch_diameter
    radial, axial = _directions(load)
    # The numbers of the formula are per minute, in mm and N mm.
    fast = flow / (2.0 * jnp.pi)
    reached = jnp.maximum(fast, _SLOW)
    power = jnp.where(fast >= _SLOW, (60e6 * reached) ** (2.0 / 3.0), 160.0)
    viscous = 0.1 * viscous * power * pitch**3
    factor = kind.z
    if kind.y:
        limit = rated(bearing) if capacity is None else as_real(capacity)
        ratio = equivalent_load(bearing, load).static / limit
        loaded = ratio > 0
        factor = kind.z * jnp.where(
            loaded, jnp.where(loaded, ratio, 1.0) ** kind.y, 0.0
        )
    flange = jnp.zeros_like(viscous)
    if kind in (_CYLINDERS, _KINDS[NeedleRollerBearing]):
        flange = _FLANGE[supply] * axial * pitch
    return factor * _directed_load(row, radial, axial) * pitch, viscous, flange


def _constants(row, supply) -> tuple[_Kind, float]:
    """Constants of a type of bearing, and its f0.

    Raises:
        ValueError: If they are not known.
    """
    kind = nearest_entry(_KINDS, row)
    viscous = None if kind is None else kind.viscous[SUPPLIES.index(supply)]
    if kind is None or viscous is None:
        where = "" if kind is None else f" with `supply` {supply!r}"
        raise ValueError(
            f"friction_torque: no constants of a {type(row).__name__}{where} are known;"
            " it must be another type or supply, or see skf_friction_torque."
        )
    return kind, viscous


def _directed_load(row, radial, axial):
    """Load F of the formula for M1 [N]."""
    if row.is_thrust:
        return axial
    return nearest_entry(_DIRECTED, row)(row.nominal_contact_angle, radial, axial)


def _of_deep_groove(angle, radial, axial):
    return jnp.maximum(radial, 3.0 * axial - 0.1 * radial)


def _of_other_balls(angle, radial, axial):
    return jnp.maximum(radial, 0.9 * axial * (1.0 / jnp.tan(angle)) - 0.1 * radial)


def _of_tapers(angle, radial, axial):
    return jnp.maximum(radial, 0.8 * axial * (1.0 / jnp.tan(angle)))


def _of_spherical(angle, radial, axial):
    thrust = axial / (1.5 * jnp.tan(angle))
    flat = thrust <= radial
    share = jnp.where(flat, thrust / jnp.where(radial > 0, radial, 1.0), 0.0)
    return jnp.where(flat, (1.0 + 0.6 * share**3) * radial, 1.6 * thrust)


_DIRECTED: dict[type, Callable[..., Scalar]] = {
    AbstractBearing: lambda angle, radial, axial: radial,
    AbstractBallBearing: _of_other_balls,
    DeepGrooveBallBearing: _of_deep_groove,
    TaperedRollerBearing: _of_tapers,
    SphericalRollerRow: _of_spherical,
}
"""Loads F of the formula for M1 by class, of contact angle, radial and axial load."""


def _directions(load):
    """Radial and axial part of a load (6,); the moments do not count."""
    square = load[0] ** 2 + load[1] ** 2
    some = square > 0
    radial = jnp.where(some, jnp.sqrt(jnp.where(some, square, 1.0)), 0.0)
    return radial, jnp.abs(load[2])

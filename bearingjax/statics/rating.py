"""Load ratings of a bearing, the reference of fatigue life and static safety.

Radial bearings are rated by a radial load, thrust bearings and bearings with contact
angles above 45 degrees by an axial one, as in catalogues (`rated_axially`). A pair or
set of alike rows is rated as one bearing of several rows. The formulas are made for
steel; they take the numbers of a design and no catalogue.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..design import (
    AbstractBallBearing,
    AbstractBarrelBearing,
    AbstractBearing,
    AbstractRollerBearing,
    BearingSet,
    CylindricalThrustRollerBearing,
    DeepGrooveBallBearing,
    FourPointBallBearing,
    SelfAligningBallRow,
    rows_of,
)
from ..design.checks import is_traced, positive
from ..numerics.programs import program
from ..numerics.types import Flag, Scalar, as_real
from ..numerics.units import unit
from . import row_rating as by_row
from .row_rating import THRUST_ANGLE, BallRow, RollerRow, Rows

GIVEN = "given"
DYNAMIC_FROM_GEOMETRY = "ISO 281 from geometry"
STATIC_FROM_GEOMETRY = "ISO 76 from geometry"
LIMIT_FROM_STATIC = "ISO 281 from static capacity"


class Ratings(eqx.Module):
    """Load ratings and where each comes from.

    Attributes:
        dynamic_capacity: Basic dynamic load rating C: nine of ten bearings last a
            million revolutions under it [N].
        static_capacity: Basic static load rating C0 [N].
        fatigue_load_limit: C_u: no fatigue under it, in clean oil [N].
        axial: Whether these are axial loads, else radial ones.
        dynamic_source, static_source, limit_source: "given", or the standard and what
            it was worked out from.

    Traced: all fields but the sources.
    """

    dynamic_capacity: Scalar = eqx.field(converter=as_real, metadata=unit("N"))
    static_capacity: Scalar = eqx.field(converter=as_real, metadata=unit("N"))
    fatigue_load_limit: Scalar = eqx.field(converter=as_real, metadata=unit("N"))
    axial: Flag
    dynamic_source: str = eqx.field(static=True)
    static_source: str = eqx.field(static=True)
    limit_source: str = eqx.field(static=True)


def ratings(
    bearing: AbstractBearing | BearingSet,
    dynamic_capacity: Scalar | float | None = None,
    static_capacity: Scalar | float | None = None,
    fatigue_load_limit: Scalar | float | None = None,
) -> Ratings:
    """Load ratings of a bearing: as given, else by the standards.

    Args:
        bearing: Any bearing, or a set of alike ones.
        dynamic_capacity: C of a catalogue [N]; `None`: `dynamic_capacity`.
        static_capacity: C0 of a catalogue [N]; `None`: `static_capacity`.
        fatigue_load_limit: C_u of a catalogue [N]; `None`: `fatigue_load_limit`, from
            the static capacity given, if it is.

    Raises:
        TypeError: If a rating is no number, or it is no bearing.
        ValueError: If a rating is not positive, or the rows of a set are unlike.
    """
    parts = _parts(bearing)
    names = ("dynamic_capacity", "static_capacity", "fatigue_load_limit")
    given = (dynamic_capacity, static_capacity, fatigue_load_limit)
    for name, value in zip(names, given, strict=True):
        if value is not None:
            positive("ratings", name, as_real(value), "N")
    sources = [DYNAMIC_FROM_GEOMETRY, STATIC_FROM_GEOMETRY, LIMIT_FROM_STATIC]
    sources = [s if g is None else GIVEN for s, g in zip(sources, given, strict=True)]
    c, c0 = _combined(parts)
    c = c if dynamic_capacity is None else dynamic_capacity
    c0 = as_real(c0 if static_capacity is None else static_capacity)
    limit = fatigue_load_limit
    if limit is None:
        limit = _limit(_outermost(parts), c0)
    return Ratings(c, c0, limit, rated_axially(bearing), *sources)


def dynamic_capacity(bearing: AbstractBearing | BearingSet) -> Scalar:
    """Basic dynamic load rating C by ISO 281 from the geometry [N].

    Nine of ten bearings last a million revolutions under it. Balls count with b_m =
    1.3, rollers with 1.1, spherical rollers with 1.15, cylindrical thrust rollers with
    1.0 (`rating_factor`; drawn-cup needle bearings have 1.0 and are rated 10 % high
    here). Makers print more of their improved classes, by factors of their own: SKF 4
    to 7 % of balls, 12 to 14 % of cylindrical rollers. Grooves closer than 0.52 (outer
    ring 0.53, thrust bearings 0.54) do not raise it. Several rows: C_1 i^0.7 of balls,
    C_1 i^(7/9) of rollers, 5 % less for deep groove pairs; of an axial rating only rows
    that face the same way count, of two unequal sides the weaker. Rows of cylindrical
    thrust rollers on several circles, facing the same way, may be unlike: C = Σ Z L
    (Σ (Z L/C_k)^(9/2))^(-2/9). A four-point bearing is rated as two rows, like the
    factors of its equivalent load (`arc_rows`).

    Args:
        bearing: Any bearing, or a set of alike ones. The contact angle is zero for deep
            groove bearings, that of the outer raceway for tapers.

    Returns:
        C, radial or axial (`rated_axially`), differentiable.

    Raises:
        TypeError: If it is no bearing.
        ValueError: If the rows of a set are unlike.

    Valid:  steel, D cos α/D_pw up to 0.4 (rollers 0.3), no truncated contacts.
    Source: ISO 281:2007, clauses 5 to 10; f_c by its formulas, ISO/TR 1281-1.
    """
    return _combined(_parts(bearing))[0]


def static_capacity(bearing: AbstractBearing | BearingSet) -> Scalar:
    """Basic static load rating C0 by ISO 76 from the geometry [N].

    Under it the hardest contact has a peak pressure of 4200 MPa (balls), 4600 MPa
    (self-aligning ball bearings) or 4000 MPa (rollers), the most loaded element bearing
    five times its mean share of a radial load.

    Args:
        bearing: As in `dynamic_capacity`, also for grooves and rows.

    Returns:
        C0, radial or axial (`rated_axially`), differentiable; its slope jumps where the
        hardest contact goes from one raceway to the other.

    Raises:
        TypeError: If it is no bearing.
        ValueError: If the rows of a set are unlike.

    Valid:  steel of 207 GPa; balls of ceramics press harder.
    Source: ISO 76:2006; f_0 of balls from its definition by exact Hertz contact.
    """
    return _combined(_parts(bearing))[1]


def fatigue_load_limit(
    bearing: AbstractBearing | BearingSet,
    static_capacity: Scalar | float | None = None,
    *,
    method: str = "static",
) -> Scalar:
    """Fatigue load limit C_u of ISO 281 [N].

    "static": C0/22 of balls, C0/8.2 of rollers. "contact", of balls: the load under
    which the hardest ball has a peak pressure of 1500 MPa, 0.2288 i Z cos α Q_u of
    radial bearings (0.2288 = 1/4.37 by Sjövall, half of the balls loaded) and Z sin α
    Q_u of thrust bearings. Both are less above a pitch diameter of 100 mm, by
    (100 mm/D_pw)^0.5 and (100 mm/D_pw)^0.3.

    With usual grooves the contacts give C0/19.2, C0/25 of self-aligning bearings;
    SKF prints C0/23.6 of deep groove and angular contact bearings, C0/25.4 of
    four-point and C0/19 of self-aligning ones, C0/7.9 of cylindrical rollers. So it is
    an estimate by either method, to a quarter. Of rollers the contacts need the
    pressures along their profile: a line evenly loaded would give C0/5.8.

    Args:
        bearing: As in `dynamic_capacity`.
        static_capacity: C0 [N]; `None`: `static_capacity`. Of "static" alone.
        method: "static" or "contact".

    Raises:
        TypeError: If it is no bearing, or C0 no number.
        ValueError: If the rows of a set are unlike, C0 is not positive, the method
            unknown or "contact" of rollers.

    Source: ISO 281:2007, annex B: B.3.2.2 ("static"), B.3.2.1 ("contact"; here by
        exact Hertz contact).
    """
    parts = _parts(bearing)
    rows, is_thrust = parts[0]
    if method not in ("static", "contact"):
        raise ValueError(
            f"fatigue_load_limit: `method` is {method!r}; it must be 'static' or"
            " 'contact'."
        )
    if method == "contact":
        if static_capacity is not None or not isinstance(rows.row, BallRow):
            raise ValueError(
                "fatigue_load_limit: `method` 'contact' is of ball bearings, and takes"
                " no `static_capacity`; rollers need the pressures along their profile."
            )
        return _contact_limit(rows, is_thrust)
    if static_capacity is None:
        return _limit(_outermost(parts), _combined(parts)[1])
    value = as_real(static_capacity)
    positive("fatigue_load_limit", "static_capacity", value, "N")
    return _limit(_outermost(parts), value)


def rated_axially(bearing: AbstractBearing | BearingSet) -> Flag:
    """Whether the ratings are axial loads: contact angles above 45 degrees.

    A crossed roller bearing, at 45 degrees, is rated as a double-row radial bearing.

    Raises:
        TypeError: If it is no bearing.
        ValueError: If the rows of a set are unlike.

    Source: ISO 281:2007, definition of thrust bearings.
    """
    rows, is_thrust = _parts(bearing)[0]
    return is_axial(is_thrust, rows.row.contact_angle)


def is_axial(is_thrust: bool, angle: Scalar) -> Flag:
    """Whether a row is rated by an axial load: thrust bearings and steep ones.

    Args:
        is_thrust: Whether it is a row of a thrust bearing.
        angle: Its nominal contact angle [rad].
    """
    return (angle > THRUST_ANGLE) | is_thrust


_capacities = eqx.filter_jit(by_row.capacities)


def _combined(parts: list[tuple[Rows, bool]]) -> tuple[Scalar, Scalar]:
    """C and C0 of alike rows, or of unlike rows of thrust rollers."""
    if len(parts) == 1:
        return _capacities(*parts[0])
    c, c0 = (jnp.stack(x) for x in zip(*(_capacities(*p) for p in parts), strict=True))
    each: list[Any] = [rows.row for rows, _ in parts]
    weight = jnp.stack([row.count * row.length for row in each])
    tired = jnp.sum((weight / c) ** 4.5)
    return jnp.sum(weight) * tired ** (-2 / 9), jnp.sum(c0)


def _outermost(parts: list[tuple[Rows, bool]]) -> BallRow | RollerRow:
    """The row of the largest pitch diameter, as far as these are known."""
    if len(parts) == 1:
        return parts[0][0].row
    return max((rows.row for rows, _ in parts), key=lambda r: _known(r.pitch_diameter))


def _known(number) -> float:
    return 0.0 if is_traced(number) else float(number)


@program(quick=True)
def _limit(row, static):
    share, power = (22, 0.5) if isinstance(row, BallRow) else (8.2, 0.3)
    return static / share / _large(row) ** power


@program(quick=True)
def _contact_limit(rows, is_thrust):
    row, angle = rows.row, rows.row.contact_angle
    axial = is_axial(is_thrust, angle)
    radial = 0.2288 * rows.count * jnp.cos(angle)
    share = jnp.where(axial, rows.one_way * jnp.sin(angle), radial)
    return row.count * by_row.ball_fatigue(row) * share / _large(row) ** 0.5


def _large(row):
    """Pitch diameter over 100 mm, at least 1 [1]."""
    return jnp.maximum(row.pitch_diameter / 0.1, 1.0)


def _row(bearing) -> BallRow | RollerRow:
    """The numbers that a row is rated by."""
    angle, pitch = nominal_contact_angle(bearing), bearing.pitch_diameter
    count = as_real(bearing.n_elements)
    if isinstance(bearing, AbstractBallBearing):
        osculation = bearing.outer_osculation, bearing.inner_osculation
        return BallRow(count, bearing.ball_diameter, pitch, angle, osculation)
    diameter, length = bearing.roller_diameter, bearing.roller_length
    quality = as_real(rating_factor(bearing))
    return RollerRow(count, diameter, length, pitch, angle, quality)


def rating_factor(bearing: AbstractBearing) -> float:
    """b_m of a row of rollers, for today's material and manufacture [1].

    1.15 of spherical roller bearings, radial and thrust, 1.0 of cylindrical roller
    thrust bearings, 1.1 of all other rollers. ISO 281 does not name toroidal roller
    bearings: they count as the spherical ones, whose rollers they share.

    Args:
        bearing: A single row of rollers.

    Source: ISO 281:2007, tables 6 and 10.
    """
    if isinstance(bearing, AbstractBarrelBearing):
        return 1.15
    return 1.0 if isinstance(bearing, CylindricalThrustRollerBearing) else 1.1


def nominal_contact_angle(bearing: AbstractBearing) -> Scalar:
    """Nominal contact angle of the standards [rad].

    Zero for a deep groove ball bearing of any clearance; for a tapered roller bearing
    the angle of its outer raceway; for a mounted bearing the angle of the drawing.

    Args:
        bearing: A single row.
    """
    if isinstance(bearing, DeepGrooveBallBearing):
        return as_real(0.0)
    rated = getattr(bearing, "rated_contact_angle", None)
    if rated is not None:
        return rated
    if isinstance(bearing, AbstractRollerBearing):
        # The load of a taper leaves through its outer raceway, which has no rib.
        return bearing.axis_angle + bearing.half_angle
    assert isinstance(bearing, AbstractBallBearing)
    return bearing.free_contact_angle


def arc_rows(bearing: AbstractBearing) -> int:
    """Number of rows that the standards count in a row: 2 for four-point balls.

    Under radial load each of their balls bears on two pairs of arcs, which tire as the
    raceways of two rows do. The factors of their equivalent load are those of two rows
    as well, so that under axial load alone, which one pair of arcs bears, the life is
    that of a single row: C grows by 2^0.7 = 1.62, Y by 1.625. SKF and Schaeffler rate
    them so; ratings of makers who count one row (GOST) are to be multiplied by 2^0.7
    and 2 (C0).

    Args:
        bearing: A single row.

    Source: SKF, general catalogue: P = Fr + 0.66 Fa or 0.6 Fr + 1.07 Fa, P0 = Fr +
        0.58 Fa of bearings with 35 degrees, the factors of ISO 281, table 3, for two
        rows; their C as of two rows (`benchmarks/catalogue_capacity.py`).
    """
    return 2 if isinstance(bearing, FourPointBallBearing) else 1


def _kind(bearing, several) -> by_row.BallKind | None:
    if isinstance(bearing, AbstractRollerBearing):
        return None
    kind = by_row.ANGULAR_CONTACT
    if isinstance(bearing, SelfAligningBallRow):
        kind = by_row.SELF_ALIGNING
    elif bearing.is_thrust:
        kind = by_row.THRUST
    elif isinstance(bearing, DeepGrooveBallBearing) and several:
        kind = by_row.RADIAL_CONTACT_ROWS
    return jax.tree.map(as_real, kind)


def _parts(bearing) -> list[tuple[Rows, bool]]:
    """Alike rows and whether they are of a thrust bearing; of cylindrical thrust
    rollers on several circles each row."""
    if isinstance(bearing, BearingSet):
        rows = rows_of(bearing)
        flat = all(isinstance(r.bearing, CylindricalThrustRollerBearing) for r in rows)
        unlike = any(not _same(rows[0].bearing, row.bearing) for row in rows[1:])
        if flat and unlike and len({row.mirrored for row in rows}) == 1:
            return [_alike(row.bearing) for row in rows]
    return [_alike(bearing)]


def _alike(bearing) -> tuple[Rows, bool]:
    """The rows, and whether they are of a thrust bearing."""
    if not isinstance(bearing, AbstractBearing | BearingSet):
        raise TypeError(
            f"load rating: `bearing` is a {type(bearing).__name__}; it must be a"
            " bearing or a BearingSet."
        )
    rows = rows_of(bearing)
    first = rows[0].bearing
    for k, row in enumerate(rows[1:], 1):
        if not _same(first, row.bearing):
            raise ValueError(
                f"load rating: row {k} of the set is another bearing than row 0; the"
                " standards rate sets of alike rows only: rate each row alone."
            )
    sides = [sum(row.mirrored is side for row in rows) for side in (False, True)]
    one_way, kind = min(n for n in sides if n), _kind(first, len(rows) > 1)
    count, arcs = len(rows), arc_rows(first)
    # Of two pairs of arcs each bears one way.
    one_way = count if arcs == 2 else one_way
    numbers = Rows(_row(first), kind, as_real(arcs * count), as_real(one_way))
    return numbers, first.is_thrust


def _same(one, other) -> bool:
    """Whether two bearings are rated alike, as far as their numbers are known."""
    if one is other:
        return True
    if type(one) is not type(other):
        return False
    numbers = (jax.tree.leaves(_row(bearing)) for bearing in (one, other))
    pairs = [p for p in zip(*numbers, strict=True) if not any(map(is_traced, p))]
    return all(np.allclose(a, b, rtol=1e-9, atol=0.0) for a, b in pairs)

"""Load ratings of a bearing, the reference of fatigue life and static safety.

Radial bearings are rated by a radial load, thrust bearings and bearings with contact
angles above 45 degrees by an axial one, as in catalogues (`rated_axially`). A pair or
set of alike rows is rated as one bearing of several rows. The formulas are made for
steel; they take the numbers of a design. `ratings` alone takes what a catalogue prints
for it (`design.published`).
"""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..design import (
    AbstractBallBearing,
    AbstractBarrelBearing,
    AbstractBearing,
    AbstractRollerBearing,
    BearingSet,
    CylindricalThrustRollerBearing,
    DeepGrooveBallBearing,
    SelfAligningBallRow,
    SetRow,
    ThrustBallBearing,
    rows_of,
)
from ..design.abstract import nearest_entry
from ..design.bearing_set import shares_rings
from ..design.checks import is_traced, of_class, one_of, positive
from ..design.published import close, is_as_published
from ..numerics.compiled.programs import program
from ..numerics.shown import Printable
from ..numerics.types import Flag, Number, Real, Scalar, as_array, as_real, in_numpy
from ..numerics.units import real, unit
from . import row_rating as by_row
from .row_rating import THRUST_ANGLE, BallRow, RollerRow, Rows

GIVEN = "given"
PUBLISHED = "published"
FACTORS_FROM_GEOMETRY = "ISO 281 and ISO 76 from geometry"
DYNAMIC_FROM_GEOMETRY = "ISO 281 from geometry"
STATIC_FROM_GEOMETRY = "ISO 76 from geometry"
LIMIT_FROM_STATIC = "ISO 281 from static capacity"


class Ratings(Printable):
    """Load ratings, and where they and the axial factors come from.

    Attributes:
        dynamic_capacity: Basic dynamic load rating C: nine of ten bearings last a
            million revolutions under it [N].
        static_capacity: Basic static load rating C0 [N].
        fatigue_load_limit: C_u: no fatigue under it, in clean oil [N].
        axial: Whether these are axial loads, else radial ones.
        published: Whether C, C0 and C_u are those that a catalogue prints, for a set
            scaled by the standards; last, whether the factors of axial load are (4,).
        given: Whether C, C0 and C_u were given by the caller (3,).

    Traced: all fields but `given`.
    """

    dynamic_capacity: Real = eqx.field(**real("N"))
    static_capacity: Real = eqx.field(**real("N"))
    fatigue_load_limit: Real = eqx.field(**real("N"))
    axial: Flag
    published: Bool[Array | np.ndarray, "*case 4"]
    given: tuple[bool, ...] = eqx.field(static=True)

    @property
    def dynamic_source(self) -> str:
        """ "given", "published", or the standard and what C was worked out from."""
        return self._source(0, DYNAMIC_FROM_GEOMETRY)

    @property
    def static_source(self) -> str:
        """The same of C0."""
        return self._source(1, STATIC_FROM_GEOMETRY)

    @property
    def limit_source(self) -> str:
        """The same of C_u."""
        return self._source(2, LIMIT_FROM_STATIC)

    @property
    def factors_source(self) -> str:
        """ "published", or the standards, of the factors of equivalent loads."""
        return self._source(3, FACTORS_FROM_GEOMETRY)

    def _source(self, place, standard) -> str:
        if (*self.given, False)[place]:
            return GIVEN
        if is_traced(self.published):
            return f"{PUBLISHED}, else {standard}"
        return PUBLISHED if np.all(np.asarray(self.published)[..., place]) else standard


def ratings(
    bearing: AbstractBearing | BearingSet,
    dynamic_capacity: Number | None = None,
    static_capacity: Number | None = None,
    fatigue_load_limit: Number | None = None,
) -> Ratings:
    """Load ratings of a bearing: as given, else as published, else by the standards.

    A bearing of the catalogue carries its published ratings. They count while its
    dimensions are those of the catalogue; for a set they are scaled as ISO 281 and
    ISO 76 scale those of its rows, C_u in proportion to C0. At these dimensions C and
    C0 have the relative derivatives of the standards' formulas, so that a life is never
    without a derivative by a dimension; away from them the standards alone count, and C
    leaps, by up to 14 % of improved classes. `optimise` therefore leaves out published
    ratings once a variable is a dimension on which they depend.

    Args:
        bearing: Any bearing, or a set of alike ones.
        dynamic_capacity: C [N]; `None`: as published, or `dynamic_capacity`.
        static_capacity: C0 [N]; `None`: as published, or `static_capacity`.
        fatigue_load_limit: C_u [N]; `None`: as published, or `fatigue_load_limit` from
            the static capacity that counts.

    Returns:
        Ratings; NaN under `jit` if numbers of rows differ that must not.

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
    given = tuple(None if value is None else as_real(value) for value in given)
    printed = published_factors(bearing)
    factors = as_array(False if printed is None else printed[1], bool)
    found = _rate(parts, given, factors)
    return Ratings(*found, tuple(value is not None for value in given))


def published_factors(
    bearing: AbstractBearing | BearingSet,
) -> tuple[Float[Array, "3"], Flag] | None:
    """Return Y1, Y2 and Y0 that a catalogue prints for a bearing of two rows [1].

    Returns:
        The factors, and whether they are printed and hold for its dimensions; `None`
        of a bearing that carries none.
    """
    rows = rows_of(bearing)
    found = rows[0].bearing.published
    if found is None or len(rows) != 2 or not shares_rings(bearing):
        return None
    holds = is_as_published(rows[0].bearing) & is_as_published(rows[1].bearing)
    return found.axial_factors, holds & (found.axial_factors[1] > 0)


def check_alike(bearing: AbstractBearing | BearingSet) -> None:
    """Raise unless the standards rate a bearing, as far as its numbers are known.

    Inside a compiled program they are not: what is called from Python checks first.

    Args:
        bearing: Any bearing, or a set of alike ones.

    Raises:
        TypeError: If it is no bearing.
        ValueError: If the rows of a set are unlike.
    """
    for rows in _rated_together(bearing):
        _are_alike(rows)


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
    factors of its equivalent load (`rated_rows`).

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
    return _combine(_parts(bearing))[0]


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
    return _combine(_parts(bearing))[1]


def fatigue_load_limit(
    bearing: AbstractBearing | BearingSet,
    static_capacity: Number | None = None,
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
    rows, is_thrust = parts[0].rows, parts[0].is_thrust
    one_of("fatigue_load_limit", "method", method, ("static", "contact"))
    if method == "contact":
        if static_capacity is not None or not isinstance(rows.row, BallRow):
            raise ValueError(
                "fatigue_load_limit: `method` 'contact' is of ball bearings, and takes"
                " no `static_capacity`; rollers need the pressures along their profile."
            )
        return _contact_limit(rows, is_thrust)
    value = _combine(parts)[1] if static_capacity is None else as_real(static_capacity)
    positive("fatigue_load_limit", "static_capacity", value, "N")
    return _limit(parts, value)


def rated_axially(bearing: AbstractBearing | BearingSet) -> Flag:
    """Whether the ratings are axial loads: contact angles above 45 degrees.

    A crossed roller bearing, at 45 degrees, is rated as a double-row radial bearing.

    Raises:
        TypeError: If it is no bearing.
        ValueError: If the rows of a set are unlike.

    Source: ISO 281:2007, definition of thrust bearings.
    """
    first = _parts(in_numpy(bearing))[0]
    angle = in_numpy(first.rows.row.contact_angle)
    return as_array(is_axial(first.is_thrust, angle), bool)


def is_axial(is_thrust: bool, angle: Scalar) -> Any:
    """Whether a row is rated by an axial load: thrust bearings and steep ones.

    Args:
        is_thrust: Whether it is a row of a thrust bearing.
        angle: Its nominal contact angle [rad].
    """
    return (angle > THRUST_ANGLE) | is_thrust


class _Part(NamedTuple):
    """Numbers of rows that are rated together.

    Attributes:
        rows: The rows.
        is_thrust: Whether they are of a thrust bearing. Static.
        alike: Whether all are rated as the first.
        alone: Rows that the bearing of the catalogue counts as, and its λ over that of
            these rows (2,) [1]; `None`: nothing is published.
        published: C, C0 and Pu of that bearing (3,) [N], or `None`.
        holds: Whether these are of the dimensions of all rows, or `None`.
    """

    rows: Rows
    is_thrust: bool
    alike: Array
    alone: Annotated[Float[Array, "2"] | None, unit("1")]
    published: Annotated[Float[Array, "3"] | None, unit("N")]
    holds: Array | None


@eqx.filter_jit
def _combine(parts: tuple[_Part, ...]) -> tuple[Scalar, Scalar]:
    """C and C0 from the geometry; NaN of rows that prove to be unlike when traced."""
    return _combine_rows(parts, [by_row.capacities(p.rows, p.is_thrust) for p in parts])


@program(quick=True)
def _rate(parts, given, factors):
    """C, C0, C_u, whether they are axial, and whether all is published (4,)."""
    each = [_rate_part(part) for part in parts]
    c, c0 = _combine_rows(parts, [values[:2] for values, _ in each])
    published = jnp.all(jnp.stack([flags for _, flags in each]), axis=0)
    # What is given does not rate a set of unlike rows either.
    given_c, given_c0, limit = given
    alike = parts[0].alike
    c = c if given_c is None else jnp.where(alike, given_c, jnp.nan)
    c0 = c0 if given_c0 is None else jnp.where(alike, given_c0, jnp.nan)
    if limit is None:
        printed = sum(values[2] for values, _ in each)
        limit = jnp.where(published[2], printed, _limit_of(parts, c0))
    axial = is_axial(parts[0].is_thrust, parts[0].rows.row.contact_angle)
    return c, c0, limit, axial, jnp.append(published, factors)


def _combine_rows(parts, each) -> tuple[Scalar, Scalar]:
    """C and C0 of all rows, from those of alike rows, or of each of thrust rollers."""
    if len(parts) == 1:
        c, c0 = (jnp.where(parts[0].alike, value, jnp.nan) for value in each[0])
        return c, c0
    c, c0 = (jnp.stack(values) for values in zip(*each, strict=True))
    weight = jnp.stack(
        [part.rows.row.n_elements * part.rows.row.length for part in parts]
    )
    # Of alike rows this is C_1 i^(7/9).
    tired = jnp.sum((weight / c) ** 4.5)
    return jnp.sum(weight) * tired ** (-2 / 9), jnp.sum(c0)


def _rate_part(part: _Part) -> tuple[Float[Array, "3"], Bool[Array, "3"]]:
    """C, C0 and C_u of alike rows, and whether each is published; else C_u is 0."""
    now = jnp.stack(by_row.capacities(part.rows, part.is_thrust))
    plain = jnp.append(now, 0.0)
    if part.alone is None or part.published is None or part.holds is None:
        return plain, jnp.zeros(3, bool)
    # The dimensions have the relative derivatives of the formulas.
    grown = now / jax.lax.stop_gradient(now)
    rows, (alone, reduction) = part.rows, part.alone
    axial = is_axial(part.is_thrust, rows.row.contact_angle)
    many = jnp.where(axial, rows.one_way, rows.n_rows / alone)
    dynamic = grown[0] * many**rows.row.power / jnp.where(axial, 1.0, reduction)
    scaled = jnp.stack([dynamic, *2 * [grown[1] * many]])
    published = part.holds & (part.published > 0)
    return jnp.where(published, part.published * scaled, plain), published


def row_ratings(
    bearing: AbstractBearing | BearingSet, rated: Ratings
) -> list[tuple[Scalar, Scalar]]:
    """C and C_u of every row as a bearing of its own, of the ratings of all [N].

    Args:
        bearing: Any bearing, or a set.
        rated: Its ratings.

    Source: ISO 281: C = C_1 i^0.7 of i rows of balls, C_1 i^(7/9) of rollers; the
        arcs of a four-point bearing count as two rows (`rated_rows`). Unlike rows of
        thrust rollers have C in the ratio of their own, C_u in that of their C0.
    """
    parts = _parts(bearing)
    first = parts[0]
    if len(parts) > 1:
        each = [_rate_part(part)[0] for part in parts]
        c, c0 = _combine_rows(parts, [values[:2] for values in each])
        shares = [(one[0] / c, one[1] / c0) for one in each]
    else:
        rows = first.rows
        axial = is_axial(first.is_thrust, rows.row.contact_angle)
        count = jnp.where(axial, rows.one_way, rows.n_rows)
        shares = [(count**-rows.row.power, 1.0 / count)] * len(rows_of(bearing))
    return [
        (rated.dynamic_capacity * c, rated.fatigue_load_limit * limit)
        for c, limit in shares
    ]


@program(quick=True)
def _limit(parts, static):
    return _limit_of(parts, static)


def _limit_of(parts, static):
    share, power = parts[0].rows.row.limit
    pitch = jnp.max(jnp.stack([part.rows.row.pitch_diameter for part in parts]))
    return static / share / _large(pitch) ** power


@program(quick=True)
def _contact_limit(rows, is_thrust):
    row, angle = rows.row, rows.row.contact_angle
    axial = is_axial(is_thrust, angle)
    radial = 0.2288 * rows.n_rows * jnp.cos(angle)
    share = jnp.where(axial, rows.one_way * jnp.sin(angle), radial)
    large = _large(row.pitch_diameter)
    return row.n_elements * by_row.ball_fatigue(row) * share / large**0.5


def _large(pitch):
    """Pitch diameter over 100 mm, at least 1 [1]."""
    return jnp.maximum(pitch / 0.1, 1.0)


def _row(bearing) -> BallRow | RollerRow:
    """The numbers that a row is rated by."""
    return nearest_entry(_ROWS, bearing)(bearing, as_real(bearing.n_elements))


def _row_of_balls(bearing, count) -> BallRow:
    angle, pitch = bearing.nominal_contact_angle, bearing.pitch_diameter
    osculation = bearing.outer_osculation, bearing.inner_osculation
    return BallRow(count, bearing.ball_diameter, pitch, angle, osculation)


def _row_of_rollers(bearing, count) -> RollerRow:
    angle, pitch = bearing.nominal_contact_angle, bearing.pitch_diameter
    diameter, length = bearing.roller_diameter, bearing.roller_length
    quality = as_real(rating_factor(bearing))
    return RollerRow(count, diameter, length, pitch, angle, quality)


_ROWS = {AbstractBallBearing: _row_of_balls, AbstractRollerBearing: _row_of_rollers}


_FACTORS = {
    AbstractRollerBearing: 1.1,
    AbstractBarrelBearing: 1.15,
    CylindricalThrustRollerBearing: 1.0,
}


def rating_factor(bearing: AbstractBearing) -> float:
    """b_m of a row of rollers, for today's material and manufacture [1].

    1.15 of spherical roller bearings, radial and thrust, 1.0 of cylindrical roller
    thrust bearings, 1.1 of all other rollers. ISO 281 does not name toroidal roller
    bearings: they count as the spherical ones, whose rollers they share.

    Args:
        bearing: A single row of rollers.

    Source: ISO 281:2007, tables 6 and 10.
    """
    return nearest_entry(_FACTORS, bearing)


_KINDS = {
    AbstractBallBearing: (by_row.ANGULAR_CONTACT, by_row.ANGULAR_CONTACT),
    DeepGrooveBallBearing: (by_row.ANGULAR_CONTACT, by_row.RADIAL_CONTACT_ROWS),
    SelfAligningBallRow: (by_row.SELF_ALIGNING, by_row.SELF_ALIGNING),
    ThrustBallBearing: (by_row.THRUST, by_row.THRUST),
}
"""Constants of the standards for balls, of a single row and of several rows."""


def _kind(bearing, several) -> by_row.BallKind | None:
    """Constants of the standards for balls; `None` for rollers."""
    kinds = nearest_entry(_KINDS, bearing)
    return None if kinds is None else kinds[several]


def _parts(bearing) -> tuple[_Part, ...]:
    return tuple(map(_part, _rated_together(bearing)))


def _rated_together(bearing) -> list[tuple[SetRow, ...]]:
    """All rows; of cylindrical thrust rollers that face the same way each row."""
    kinds, allowed = AbstractBearing | BearingSet, "a bearing or a BearingSet"
    of_class("load rating", "bearing", bearing, kinds, allowed)
    rows = rows_of(bearing)
    radial = any(row.bearing.bears_radially for row in rows)
    if not radial and len({row.mirrored for row in rows}) == 1:
        return [rows_of(row.bearing) for row in rows]
    return [rows]


def _are_alike(rows) -> Any:
    """Whether rows are rated as the first, a traced flag if a number is traced.

    Raises:
        ValueError: If they are not.
    """
    first, alike = rows[0].bearing, True
    for k, row in enumerate(rows[1:], 1):
        same = _rated_alike(first, row.bearing)
        if not is_traced(same) and not same:
            raise ValueError(
                f"load rating: row {k} of the set is another bearing than row 0; the"
                " standards rate sets of alike rows only: rate each row alone."
            )
        alike = alike & same
    return alike


def _part(rows) -> _Part:
    """Numbers of rows that are rated together.

    Under radial load each ball of a four-point bearing bears on two pairs of arcs,
    which tire as the raceways of two rows do (`rated_rows`). The factors of their
    equivalent load are those of two rows as well, so that under axial load alone, which
    one pair of arcs bears, the life is that of a single row: C grows by 2^0.7 = 1.62, Y
    by 1.625. SKF and Schaeffler rate them so; ratings of makers who count one row
    (GOST) are to be multiplied by 2^0.7 and 2 (C0).

    Source: SKF, general catalogue: P = Fr + 0.66 Fa or 0.6 Fr + 1.07 Fa, P0 = Fr +
        0.58 Fa of bearings with 35 degrees, the factors of ISO 281, table 3, for two
        rows; their C as of two rows (`benchmarks/catalogue_capacity.py`).
    """
    first, alike = rows[0].bearing, _are_alike(rows)
    sides = [sum(row.mirrored is side for row in rows) for side in (False, True)]
    one_way, kind = min(n for n in sides if n), _kind(first, len(rows) > 1)
    count, arcs = len(rows), first.rated_rows
    # Of two pairs of arcs each bears one way.
    one_way = count if arcs == 2 else one_way
    counts = as_real(arcs * count), as_real(one_way)
    numbers = Rows(_row(first), jax.tree.map(as_real, kind), *counts)
    part = _Part(numbers, first.is_thrust, as_array(alike, bool), None, None, None)
    if any(row.bearing.published is None for row in rows):
        return part
    printed, holds = first.published.ratings, True
    for row in rows:
        agrees = close(row.bearing.published.ratings, printed)
        holds = holds & agrees & is_as_published(row.bearing)
    # The bearing of the catalogue: a row, or both that share its rings.
    pair = shares_rings(first)
    own = _kind(first, pair)
    less = 1.0 if kind is None or own is None else own.reduction / kind.reduction
    alone = as_real([2 if pair else arcs, less])
    return part._replace(alone=alone, published=printed, holds=as_array(holds, bool))


def _rated_alike(one, other) -> Any:
    """Whether two bearings are rated alike, a traced flag if a number is traced."""
    if one is other:
        return True
    if type(one) is not type(other) or one.n_places != other.n_places:
        return False
    numbers = (jax.tree.leaves(_row(bearing)) for bearing in (one, other))
    alike: Any = True
    for a, b in zip(*numbers, strict=True):
        alike = alike & close(a, b)
    return alike

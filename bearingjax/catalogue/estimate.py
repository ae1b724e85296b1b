"""Inner geometry of a catalogue bearing from its outer dimensions and load ratings.

Two ratings do not fix three or four inner dimensions. The remaining freedom is fixed by
the usual proportions of the type (`typical`): for each whole number of rolling elements
that fits, the sizes that agree best with ratings and proportions at once are found by
least squares, and the number with the best agreement is taken.
"""

from functools import partial
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from .. import design
from ..design.checks import check, in_range, is_traced, one_of, positive
from ..life import row_rating
from ..life.row_rating import BallKind, BallRow, RollerRow, Rows
from ..numerics.compiled.programs import program
from ..numerics.types import as_real
from ..numerics.units import unit
from .typical import PROPORTIONS, Proportions, Typical

_RATINGS = (0.015, 0.01)
"""Spread of makers' C and C0 about those of the standards [1]."""

_EDGE = 0.003
"""Spread of the hard limits in the least squares [section]."""

_WALL = 0.1
"""Least wall under a raceway [section]."""

_WEB = 0.985
"""Most that the rolling elements fill between each other's centres [1]."""

_APART = 1.01
"""Least distance of the two rows of a self-aligning bearing [ball diameter]."""

_BROADEST = 0.9
"""Largest roller length or ball diameter [width]."""

_WORST = 0.15
"""Largest misfit of a rating that is still an estimate [1]."""

_UNUSUAL = 20.0
"""Misfit above which a fit is unusual: the proportions have five degrees of freedom."""

_FEWEST = 3

_LARGEST = 10.0
"""Outside diameter or width beyond those of rolling bearings [m]."""

_FAR_BELOW = 1e-3
"""Rating over the least of this type and size that another unit explains [1]."""


_FLAT = 0.5 * np.pi


class _Rated(NamedTuple):
    """Rating of a type of bearing, a static part of its programs.

    Attributes:
        balls: Constants of the standards for its balls; `None` for rollers.
        is_thrust: Whether it is rated by an axial load.
        rows: Number of rows that the ratings refer to.
        raised: C that makers print of an improved class over that of ISO 281 [1].
        quality: b_m of its rollers [1].
        angle: Its contact angle, if all of this type have the same [rad].
        on_circle: Number of rows whose rolling elements stand on one pitch circle.
    """

    balls: BallKind | None
    is_thrust: bool = False
    rows: int = 1
    raised: Annotated[float, unit("1")] = 1.0
    quality: Annotated[float, unit("1")] = 1.1
    angle: Annotated[float | None, unit("rad")] = None
    on_circle: int = 1

    @property
    def flat(self) -> bool:
        """Whether its raceways are flat, at 90 degrees."""
        return self.angle == _FLAT


# Raised: SKF over other makers with the same C0, 1.03 to 1.065 and 1.146 to 1.155; of
# barrel rollers over what the edges of the raceways give, 1.08 to 1.165. That of
# angular contact bearings, 1.07, goes with C0; the ratings cannot tell it.
_KINDS = {
    "deep_groove_ball": _Rated(row_rating.ANGULAR_CONTACT, raised=1.05),
    "angular_contact_ball": _Rated(row_rating.ANGULAR_CONTACT),
    "four_point_ball": _Rated(row_rating.ANGULAR_CONTACT, rows=2),
    "self_aligning_ball": _Rated(row_rating.SELF_ALIGNING, rows=2),
    "thrust_ball": _Rated(row_rating.THRUST, is_thrust=True, angle=_FLAT),
    "cylindrical_roller": _Rated(None, raised=1.15),
    "needle_roller": _Rated(None),
    "tapered_roller": _Rated(None),
    "spherical_roller": _Rated(None, rows=2, raised=1.135, quality=1.15),
    "toroidal_roller": _Rated(None, raised=1.135, quality=1.15),
    "spherical_thrust_roller": _Rated(None, True, raised=1.135, quality=1.15),
    "cylindrical_thrust_roller": _Rated(None, True, quality=1.0, angle=_FLAT),
    "crossed_roller": _Rated(None, rows=2, angle=0.25 * np.pi, on_circle=2),
}

_ANGLES = {
    "angular_contact_ball": (0.0, 0.25 * np.pi),
    "four_point_ball": (0.0, 0.25 * np.pi),
    "tapered_roller": (0.0, 0.25 * np.pi),
    "spherical_roller": (0.0, 0.25 * np.pi),
    "spherical_thrust_roller": (0.25 * np.pi, 0.5 * np.pi),
}
"""Range of the contact angle of the types that have one to choose [rad]."""

_BARREL = 0.97
"""Profile radius of barrel rollers over that of their raceways [1]: the osculations
0.485 and 0.5 that the program of MESYS presumes; 0.98 of Harris's 22317."""

_TRAVEL = 0.105
"""Factor of the clearance that axial travel of toroidal bearings costs, k2 [1]."""


class GeometryEstimate(eqx.Module):
    """Estimated inner geometry: similar to the real one, not equal.

    Attributes:
        bearing: The design. Its clearance is zero, its grooves are those that the
            standards count with (0.52, outer rings 0.53), its rollers have the
            logarithmic profile, barrel rollers 97 % of the radius of their raceways:
            none of these shows in the ratings.
        dynamic_error: C of the design by ISO 281 over that taken, less one [1].
        static_error: Error of C0 by ISO 76, over that given [1].
        raised: C given over C taken: above 1 where it is that of an improved class,
            which a maker rates above ISO 281 [1].
        misfit: Sum of the squared differences from ratings and usual proportions, each
            over its spread; above 20 the bearing is an unusual one, or its ratings are
            not those of the standards.
        rivals: Other numbers of rolling elements and their misfits, the best first; one
            that is not much worse may be the true one.
        other_reading: Number of rolling elements and misfit with C read the other way,
            as given or as raised; `None` of types that are not known to be raised, or
            if no geometry has those ratings.
        assumed_contact_angle: Whether the contact angle is an estimate as well.

    Static: all numbers but those of the bearing.
    """

    bearing: design.AbstractBearing | design.BearingSet
    dynamic_error: float = eqx.field(static=True)
    static_error: float = eqx.field(static=True)
    raised: float = eqx.field(static=True)
    misfit: float = eqx.field(static=True)
    rivals: tuple[tuple[int, float], ...] = eqx.field(static=True)
    other_reading: tuple[int, float] | None = eqx.field(static=True)
    assumed_contact_angle: bool = eqx.field(static=True)

    def __repr__(self) -> str:
        return self.report()

    def report(self) -> str:
        """Description of the estimate and its misfit, also used for printing."""
        row = design.rows_of(self.bearing)[0].bearing
        name, size = row.noun, float(row.element_diameter)
        length = row.element_length
        angle = np.rad2deg(float(row.nominal_contact_angle))
        text = (
            f"Estimate: {row.n_elements} {name}s of {1e3 * size:.4g} mm"
            + (f" by {1e3 * float(length):.4g} mm" if length is not None else "")
            + f" a row, pitch diameter {1e3 * float(row.pitch_diameter):.5g} mm,"
            f" contact angle {angle:.4g}°."
            f" C {100 * self.dynamic_error:+.1f} %, C0 {100 * self.static_error:+.1f} %"
            f" off those given{self._capacity_note()}; misfit {self.misfit:.1f}"
        )
        if self.misfit > _UNUSUAL:
            text += " (unusual: check the ratings)"
        if self.rivals:
            others = (f"{count} ({misfit:.1f})" for count, misfit in self.rivals)
            text += f", with other numbers of {name}s {', '.join(others)}"
        if self.other_reading is not None:
            count, misfit = self.other_reading
            other = "as it is" if self.raised > 1.0 else "as raised by its maker"
            text += f"; with C {other} {count} {name}s ({misfit:.1f})"
        return text + (
            ". The contact angle is an estimate too."
            if self.assumed_contact_angle
            else "."
        )

    def _capacity_note(self):
        if self.raised == 1.0:
            return ""
        return f", C taken as raised by its maker to {self.raised:g} times ISO 281"


class _Envelope(NamedTuple):
    """Known data: lengths [m], ratings [N], proportions, hard limits."""

    section: Any
    mean: Any
    width: Any
    ratings: Any
    rating_spread: Any
    typical: Any
    spread: Any
    slenderness: Any
    by_arc: Any


def estimate_geometry(
    bore: float,
    outside_diameter: float,
    width: float,
    kind: str,
    dynamic_capacity: float,
    static_capacity: float,
    *,
    contact_angle: float | None = None,
) -> GeometryEstimate:
    """Inner geometry of a bearing that has the ratings of a catalogue.

    Args:
        bore: Bore diameter d [m].
        outside_diameter: Outside diameter D [m].
        width: Width B; height of thrust bearings, total width of tapers [m].
        kind: Type as in a scene: "deep_groove_ball", "angular_contact_ball",
            "four_point_ball", "self_aligning_ball" (of two rows), "thrust_ball",
            "cylindrical_roller", "needle_roller", "tapered_roller", "spherical_roller"
            (of two rows), "toroidal_roller", "spherical_thrust_roller",
            "cylindrical_thrust_roller" or "crossed_roller".
        dynamic_capacity: Basic dynamic load rating C [N]. Of deep groove and
            cylindrical roller bearings and of barrel rollers it is read as it is and as
            one that its maker has raised, to 1.05, 1.15 and 1.135 times ISO 281 as
            improved classes are; what agrees better is taken, and `raised` says which.
            Of other types a factor of the maker should be divided out. Four-point
            bearings: of two rows
            (`rated_rows`).
        static_capacity: Basic static load rating C0 [N].
        contact_angle: Angle of angular contact, four-point, tapered (outer raceway),
            spherical roller and spherical thrust roller bearings [rad]; `None`:
            estimated as well, which the ratings hardly support.

    Returns:
        Estimate, like the real inside, not it: it is only as good as the ratings are
        those of the standards. Number of rolling elements, and what their diameter is
        off, as `benchmarks/estimate_geometry.py` measures it:

        - deep groove: exact in 10 of 11, from a C that its maker has raised as from an
          ordinary one, else one off; -3 to +4 % (+14 % with the number missed).
        - cylindrical: exact or one off, with a raised C too; within 4 %.
        - angular contact: one too many of the one whose inside is published; 2 %.
        - four-point: four too few of the one, from ratings older than the standard's;
          +11 %, and its misfit says so.

        Of the others no inside is published here. Beside the catalogue of this library,
        which is an estimate too (from more that makers print): self-aligning exact or
        one more, tapered exact or one too few, thrust ball one to four too many, needle
        three to six too few; barrel rollers exact or one off and within 4 % (one
        bearing in 50 as if raised, or not, 7 to 20 % off), cylindrical thrust two off
        and 4 %, crossed rollers 14 too few to 8 too many of 26 to 106 and 3 %.

    Raises:
        TypeError: If a number is none.
        ValueError: If a number is not positive, the bore not below the outside
            diameter, the kind unknown, a contact angle given to a type that has none,
            or no geometry of this size has these ratings.

    Source: ratings by ISO 281 and ISO 76 (`life.row_rating`); proportions: see
        `typical`.
    """
    numbers = dict(
        bore=bore,
        outside_diameter=outside_diameter,
        width=width,
        dynamic_capacity=dynamic_capacity,
        static_capacity=static_capacity,
    )
    typical = _check_proportions(numbers, kind, contact_angle)
    readings, problems = [], []
    for raised in dict.fromkeys((1.0, _KINDS[kind].raised)):
        taken = numbers | {"dynamic_capacity": dynamic_capacity / raised}
        try:
            readings.append((raised, *_best_fits(kind, typical, taken)))
        except ValueError as problem:
            problems.append(problem)
    if not readings:
        raise problems[0]
    readings.sort(key=lambda reading: reading[2][0].misfit)
    raised, known, fits = readings[0]
    best = fits[0]
    others = [(fits[0].n_elements, fits[0].misfit) for _, _, fits in readings[1:]]
    return GeometryEstimate(
        bearing=_design(kind, known, best),
        dynamic_error=best.errors[0],
        static_error=best.errors[1],
        raised=raised,
        misfit=best.misfit,
        rivals=tuple((fit.n_elements, fit.misfit) for fit in fits[1:5]),
        other_reading=others[0] if others else None,
        assumed_contact_angle=contact_angle is None and typical.angle.spread > 1e-3,
    )


def _best_fits(kind, typical, numbers) -> tuple[_Envelope, list["_Fit"]]:
    """The envelope, and the best sizes with each number of elements, the best first."""
    rated, known = _KINDS[kind], _envelope(numbers, kind, typical)
    _check_reach(rated, known, numbers)
    fits = [_fit_sizes(rated, known, count) for count in _counts(rated, known)]
    fits.sort(key=lambda fit: fit.misfit)
    _check_pair(kind, numbers, fits[0].errors)
    return known, fits


class _Fit(NamedTuple):
    """The best sizes with a number of rolling elements.

    Attributes:
        n_elements: Number of rolling elements.
        sizes: As `_sizes`.
        misfit: Sum of squares.
        errors: Errors of C and C0 [1].
    """

    n_elements: int
    sizes: np.ndarray
    misfit: float
    errors: Annotated[tuple[float, float], unit("1")]


def _start(known):
    """Usual sizes (size,): see `_sizes`."""
    element, pitch, _, length, angle = known.typical
    return np.array([np.log(element), pitch, np.log(length), angle])


def _sizes(rated, known, sizes):
    """Diameter, pitch diameter, length [m] and angle [rad] of the sizes (size,).

    Sizes: log of the diameter over the section, pitch diameter over the mean diameter,
    log of the length over the width, contact angle.
    """
    across = known.width if _by_height(rated) else known.section
    diameter, pitch = across * jnp.exp(sizes[0]), known.mean * sizes[1]
    angle = jnp.asarray(sizes[3] if rated.angle is None else rated.angle)
    if rated.balls is not None and rated.balls.open[0] is None:
        # Rows on one sphere lean at least so far that they do not overlap.
        angle = jnp.maximum(angle, jnp.arctan(_APART * diameter / pitch))
    return diameter, pitch, known.width * jnp.exp(sizes[2]), angle


def _ratings(rated, known, sizes, count):
    diameter, pitch, length, angle = _sizes(rated, known, sizes)
    if rated.balls is None:
        row = RollerRow(count, diameter, length, pitch, angle, rated.quality)
    else:
        row = BallRow(count, diameter, pitch, angle, rated.balls.open)
    numbers = Rows(row, rated.balls, as_real(rated.rows), as_real(rated.rows))
    return jnp.stack(row_rating.capacities(numbers, rated.is_thrust))


def _residuals(rated, known, sizes, count):
    """Differences from ratings, proportions and hard limits, over their spreads."""
    diameter, pitch, length, angle = _sizes(rated, known, sizes)
    wrong = jnp.log(_ratings(rated, known, sizes, count) / known.ratings)
    step = jnp.arcsin(jnp.minimum(diameter / pitch, 0.999))
    count = rated.on_circle * count
    arc, share = 2.0 * (count - 1.0) * step, count * step / jnp.pi
    filling = jnp.where(known.by_arc, arc, share)
    usual = jnp.stack((jnp.exp(sizes[0]), sizes[1], filling, jnp.exp(sizes[2]), angle))
    deviation = (usual - known.typical) / known.spread
    rolls, wall = rated.balls is None, 0.0 if rated.flat else _WALL
    tall = diameter * (1.0 if rated.flat else jnp.cos(angle))
    if rated.flat and rolls:
        tall = length
    # Needles are slender, crossed rollers shorter than thick; two rows on a sphere
    # stand beside each other.
    shape = known.slenderness * diameter - length
    if rated.on_circle > 1:
        shape = length - 0.95 * diameter
    elif rolls and rated.rows == 2:
        shape = 0.5 * (length * jnp.cos(angle) + diameter * jnp.sin(angle))
        shape = shape - 0.5 * pitch * jnp.tan(angle)
    circle, thick = pitch, diameter
    if rated.is_thrust and rated.angle is None:
        # Barrel rollers that lean so much come nearest at their inner ends.
        circle = pitch - length * jnp.sin(angle)
        radius = 0.5 * _BARREL * (pitch / jnp.cos(angle) + diameter)
        thick = diameter - 0.25 * length**2 / radius
    over = jnp.stack(
        (
            0.5 * (pitch + tall - known.mean) / known.section - 0.5 + wall,
            0.5 * (known.mean - pitch + tall) / known.section - 0.5 + wall,
            (thick - _WEB * circle * jnp.sin(jnp.pi / count)) / known.section,
            (length if rolls and not rated.flat else diameter) / known.width
            - _BROADEST,
            shape / known.section,
        )
    )
    return jnp.concatenate(
        (wrong / known.rating_spread, deviation, jnp.maximum(over, 0.0) / _EDGE)
    )


@program
def _with_slopes(rated: _Rated, known, sizes, count):
    def residuals(sizes):
        values = _residuals(rated, known, sizes, count)
        return values, values

    return jax.jacfwd(residuals, has_aux=True)(sizes)


def _part(evaluate, k, sizes):
    return evaluate(sizes)[k]


def _fit_sizes(rated, known, count) -> _Fit:
    """The sizes that agree best, with a given number of rolling elements."""
    from scipy.optimize import least_squares  # half a second of import

    seen: dict[bytes, Any] = {}

    def evaluate(sizes):
        key = sizes.tobytes()
        if key not in seen:
            seen.clear()
            pair = _with_slopes(rated, known, jnp.asarray(sizes), as_real(count))
            seen[key] = [np.asarray(part) for part in pair]
        return seen[key]

    slopes: Any = partial(_part, evaluate, 0)
    found = least_squares(
        partial(_part, evaluate, 1),
        _start(known),
        jac=slopes,
        x_scale=np.array([0.1, 0.02, 0.1, 0.05]),
    )
    c, c0 = np.expm1(found.fun[:2] * known.rating_spread)
    return _Fit(count, found.x, float(2.0 * found.cost), (float(c), float(c0)))


def _counts(rated, known) -> range:
    """Numbers of rolling elements worth a trial: the usual ones and more."""
    least, most = (
        float(np.pi / np.arcsin(min(0.99, _extent(rated, known) * share / known.mean)))
        for share in np.exp(_start(known)[0]) * np.array([1.3, 0.7])
    )
    least, most = least / rated.on_circle, most / rated.on_circle
    return range(max(_FEWEST, int(0.5 * least)), int(most) + 2)


def _by_height(rated):
    """Whether proportions of the elements refer to the height of a thrust bearing."""
    return rated.flat and rated.balls is not None


def _extent(rated, known):
    """Reference length of the diameter of the rolling elements [m]."""
    return float(known.width if _by_height(rated) else known.section)


def _envelope(numbers, kind, typical: Proportions) -> _Envelope:
    d, big = numbers["bore"], numbers["outside_diameter"]
    length = typical.length or Typical(0.5, 1.0)
    parts = typical.element, typical.pitch, typical.filling, length, typical.angle
    values = _Envelope(
        0.5 * (big - d),
        0.5 * (big + d),
        numbers["width"],
        (numbers["dynamic_capacity"], numbers["static_capacity"]),
        _RATINGS,
        [part.middle for part in parts],
        [part.spread for part in parts],
        2.5 if kind == "needle_roller" else 0.0,
        typical.by_arc,
    )
    return _Envelope(*(np.asarray(value, float) for value in values))


@program
def _reach(rated: _Rated, known, shares, length):
    """Ratings [N] of rows of one element, and the most elements, over diameters.

    Args:
        rated: How the type is rated.
        known: The envelope.
        shares: Diameters over their reference length (size,) [1].
        length: Roller length over the width [1].
    """

    def reach_at(share):
        sizes = jnp.asarray(known.typical)[jnp.array([0, 1, 3, 4])]
        sizes = sizes.at[0].set(jnp.log(share)).at[2].set(jnp.log(length))
        diameter, pitch, _, _ = _sizes(rated, known, sizes)
        most = jnp.pi / jnp.arcsin(jnp.minimum(diameter / pitch / _WEB, 1.0))
        most = jnp.floor(most / rated.on_circle)
        return _ratings(rated, known, sizes, jnp.ones(())), most

    return jax.vmap(reach_at)(shares)


def _grid(rated, known):
    """Ratings of one element, most elements, over diameters and roller lengths."""
    limit = (1.0 - 2.0 * _WALL) * float(known.section)
    if rated.balls is not None:
        limit = min(limit, _BROADEST * float(known.width))
    shares = np.linspace(0.15, 1.0, 60) * limit / _extent(rated, known)
    lengths = (0.3, 0.5, 0.7, _BROADEST) if rated.balls is None else (0.5,)
    parts = [_reach(rated, known, shares, np.asarray(length)) for length in lengths]
    ratings, most = (np.concatenate(part) for part in zip(*parts, strict=True))
    usable = most >= _FEWEST
    return ratings[usable], most[usable]


def _check_reach(rated, known, numbers):
    ratings, most = _grid(rated, known)
    # C grows so with the number of elements, C0 in proportion.
    power = 0.75 if rated.balls is None else 2 / 3
    static = ratings[:, 1]
    for k, name in enumerate(("dynamic_capacity", "static_capacity")):
        exponent = (power, 1.0)[k]
        low = (ratings[:, k] * _FEWEST**exponent).min()
        high = (ratings[:, k] * most**exponent).max()
        value = numbers[name]
        allowed = (
            f"between {low:.4g} N and {high:.4g} N, which bearings of this type and"
            " size attain"
            + (" (sizes in metres meant?)" if value < _FAR_BELOW * low else "")
        )
        check("estimate_geometry", name, low <= value <= high, allowed, value, "N")
    # Elements that a row has with this C0, and its C.
    count = numbers["static_capacity"] / static
    fits = (count >= _FEWEST) & (count <= most)
    dynamic = ratings[fits, 0] * count[fits] ** power
    value = numbers["dynamic_capacity"]
    low, high = dynamic.min() / (1 + _WORST), dynamic.max() * (1 + _WORST)
    allowed = (
        f"between {low:.4g} N and {high:.4g} N, which bearings of this type and size"
        f" with a static capacity of {numbers['static_capacity']:.6g} N attain"
    )
    ok = low <= value <= high
    check("estimate_geometry", "dynamic_capacity", ok, allowed, value, "N")


def _check_pair(kind, numbers, errors):
    if max(abs(error) for error in errors) <= _WORST:
        return
    c, c0 = (numbers[f"{name}_capacity"] for name in ("dynamic", "static"))
    raise ValueError(
        f"estimate_geometry: no usual {kind.replace('_', ' ')} bearing of this size"
        f" has both a `dynamic_capacity` of {c:.6g} N and a `static_capacity` of"
        f" {c0:.6g} N; the nearest has {c * (1 + errors[0]):.4g} N and"
        f" {c0 * (1 + errors[1]):.4g} N."
    )


def _check_proportions(numbers, kind, contact_angle) -> Proportions:
    """Proportions of the type, with the contact angle if it is given."""
    owner = "estimate_geometry"
    for name, value in numbers.items():
        positive(owner, name, value, "N" if "capacity" in name else "m")
        if is_traced(value):
            problem = "is traced; numbers must be known, as whole elements are counted"
            raise TypeError(f"{owner}: `{name}` {problem}.")
    bore, outside = numbers["bore"], numbers["outside_diameter"]
    large = max(("outside_diameter", "width"), key=lambda name: numbers[name])
    allowed = f"at most {_LARGEST:g} m (metres meant?)"
    check(owner, large, numbers[large] <= _LARGEST, allowed, numbers[large], "m")
    allowed = f"below the outside diameter, {outside:.6g} m"
    check(owner, "bore", bore < outside, allowed, bore, "m")
    one_of(owner, "kind", kind, PROPORTIONS)
    typical = PROPORTIONS[kind]
    if contact_angle is None:
        return typical
    if kind not in _ANGLES:
        raise ValueError(
            f"{owner}: `contact_angle` is given; a {kind.replace('_', ' ')} bearing has"
            " none to choose."
        )
    in_range(owner, "contact_angle", *_ANGLES[kind], contact_angle, "rad")
    return typical._replace(angle=Typical(float(contact_angle), 1e-4))


def _design(kind, known, fit) -> design.AbstractBearing | design.BearingSet:
    sizes = _sizes(_KINDS[kind], known, fit.sizes)
    balls = _KINDS[kind].balls
    diameter, pitch, length, angle = (float(size) for size in sizes)
    if kind == "tapered_roller":
        return _taper(fit.n_elements, pitch, diameter, length, angle)
    if kind in ("spherical_roller", "toroidal_roller", "spherical_thrust_roller"):
        return _barrels(kind, fit.n_elements, pitch, diameter, length, angle, known)
    if balls is None:
        sizes, profile = (pitch, diameter, length), design.Logarithmic()
        if kind == "crossed_roller":
            row = design.CrossedRollerRow(
                2 * fit.n_elements, *sizes, roller_profile=profile
            )
            return design.BearingSet.crossed(row)
        return _CYLINDERS[kind](fit.n_elements, *sizes, roller_profile=profile)
    outer, inner = balls.open
    row = fit.n_elements, pitch, diameter
    if kind == "self_aligning_ball":
        offset = 0.5 * pitch * np.tan(angle)
        return design.BearingSet.self_aligning(
            design.SelfAligningBallRow(*row, inner_osculation=inner, row_offset=offset)
        )
    grooves: dict[str, Any] = dict(outer_osculation=outer, inner_osculation=inner)
    if kind == "angular_contact_ball":
        return design.AngularContactBallBearing(*row, **grooves, contact_angle=angle)
    if kind == "four_point_ball":
        return design.FourPointBallBearing(*row, **grooves, shim_angle=angle)
    types = design.DeepGrooveBallBearing, design.ThrustBallBearing
    return types[kind == "thrust_ball"](*row, **grooves)


_CYLINDERS: dict[str, Any] = {
    "cylindrical_roller": design.CylindricalRollerBearing,
    "needle_roller": design.NeedleRollerBearing,
    "cylindrical_thrust_roller": design.CylindricalThrustRollerBearing,
}


def _barrels(kind, count, pitch, diameter, length, angle, known):
    """Barrel rollers between arcs of one radius; if they lean, about the axis."""
    sizes = count, pitch, diameter, length
    if kind == "toroidal_roller":
        radius = 0.5 * (float(known.width) / _TRAVEL + diameter)
        arcs = dict(outer_raceway_radius=radius, inner_raceway_radius=radius)
        arcs["roller_profile_radius"] = _BARREL * radius
        return design.ToroidalRollerBearing(*sizes, **arcs)
    radius = 0.5 * (pitch / np.cos(angle) + diameter)
    arcs = dict(inner_raceway_radius=radius, roller_profile_radius=_BARREL * radius)
    if kind == "spherical_roller":
        row = design.SphericalRollerRow(*sizes, **arcs, contact_angle=angle)
        return design.BearingSet.self_aligning(row)
    return design.SphericalThrustRollerBearing(*sizes, **arcs, contact_angle=angle)


def _taper(count, pitch, diameter, length, angle):
    """A taper whose cones meet in one point, `angle` that of the outer raceway."""
    half = 0.0
    for _ in range(60):
        half = np.arctan(diameter * np.sin(angle - half) / pitch)
    axis = angle - half
    # Roller ends as spheres about nearly the common apex, touching the rib low down.
    apex = 0.5 * pitch / np.sin(axis) + 0.5 * length
    return design.TaperedRollerBearing(
        count,
        pitch,
        diameter,
        length,
        roller_axis_angle=axis,
        roller_half_angle=half,
        roller_profile=design.Logarithmic(),
        ribs=design.Ribs(inner_minus=design.Rib(0.95 * apex, 0.1 * diameter)),
    )

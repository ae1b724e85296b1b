"""Rating life of a solved bearing: ISO 281, ISO/TS 16281, ISO 76.

The basic life takes the equivalent load of the standard; the reference life the loads
of the contacts of the solution, with its clearance, tilt, profile and speed. Lives are
infinite without load, and their derivatives then zero; `damage`, the part of the life
that a revolution uses, is finite and smooth throughout.
"""

from collections.abc import Sequence
from typing import Any, ClassVar, NamedTuple, cast

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import rows_of
from ..design.abstract import nearest_entry
from ..design.bearing_set import bearings_of, pitch_radius
from ..design.checks import (
    are_known,
    check,
    flag,
    floats,
    in_range,
    of_class,
    one_of,
    positive,
)
from ..design.places import element_places, has_empty_places, with_places
from ..element import RINGS, BearingElement, Speed
from ..element.bearing_element import check_element
from ..numerics.compiled.programs import program
from ..numerics.implicit import unless_failed
from ..numerics.labels import to_xarray
from ..numerics.power import positive_power
from ..numerics.shown import Printable
from ..numerics.types import Real, RealOrNone, Scalar, in_numpy, with_fields
from ..numerics.units import meaning, real, unit
from ..statics.empty_places import solution_with_empty_places, spread_elements
from ..statics.service_warning import turns_against_load
from ..statics.solution import BallSolution, RollerSolution, Solution
from .equivalent_load import EquivalentLoad, equivalent_load, left_out
from .life_factor import (
    CLEANLINESS,
    LARGEST_FACTOR,
    Cleanliness,
    as_contamination,
    check_contamination,
    life_factor,
    load_ratio,
    reliability_factor,
    viscosity_ratio,
)
from .oscillation import critical_amplitudes
from .rating import (
    Ratings,
    check_alike,
    is_axial,
    ratings,
    row_ratings,
)
from .reference_life import (
    BALLS,
    LEAST_LAMINAE,
    RowFatigue,
    edge_stress,
    exponents_of,
    row_fatigue,
)

STANDARDS = {
    "basic_rating_life": "ISO 281:2007",
    "reference_rating_life": "ISO/TS 16281:2008",
    "modified_rating_life": "ISO/TS 16281:2008 with a_ISO of ISO 281:2007",
    "static_safety": "ISO 76:2006",
}
"""Standard that each result follows."""

FRAMES = ("space", "inner", "outer")
"""Frames to which the direction of the load may be fixed."""

LIFE_OUTPUTS = (
    "equivalent_load",
    "static_equivalent_load",
    "reference_load",
    "radial_left_out",
    "axial_left_out",
    "moment_left_out",
    "static_safety",
    "basic_rating_life",
    "reference_rating_life",
    "modified_rating_life",
    "damage",
    "life_hours",
    "viscosity_ratio",
    "contamination_factor",
    "a_iso",
    "damage_share",
)
"""Numbers of a `Life` that a sweep may keep."""

_MILLION = 1e6
_RATED = "published for the `designation`, else from the geometry"


class LifeConditions(Printable):
    """Conditions of a rating life in addition to the solution.

    Attributes:
        dynamic_capacity: C of the bearing, of a set that of all its rows [N]; `None`:
            ISO 281 from geometry.
        static_capacity: C0 [N]; `None`: ISO 76 from geometry.
        fatigue_load_limit: C_u [N]; `None`: from C0 as in ISO 281.
        viscosity: Kinematic viscosity of the oil, or of the base oil of a grease, at
            the temperature of operation [m²/s]; `None`: no modified life.
        contamination: e_C from 0 to 1 [1], a `Cleanliness`, or a name of `CLEANLINESS`
            such as "grease, normal"; needed with `viscosity`.
        reliability: Share of bearings that reach the modified life [1]; without a
            lubricant `damage` and `life_hours` count it all the same.
        required: Life that is required, in hours [h]; `None`: none. Together with
            `required_revolutions` it changes no life: `judge_life` compares.
        required_revolutions: The same in revolutions [1], in place of hours.
        load_fixed_to: "space"; or the ring, "inner" or "outer", that the direction of
            the load turns with, as that of an unbalance does. A ring that turns against
            the load wears more evenly.
        edge_stress: Whether laminae at the ends of rollers count with the
            concentration of stress of ISO/TS 16281.

    Traced: all numbers. Static: load_fixed_to, edge_stress.
    """

    about: ClassVar[str] = "conditions of the rating life, in addition to the bearing"
    dynamic_capacity: RealOrNone = eqx.field(
        **real("N", "basic dynamic load rating C", above=0, otherwise=_RATED),
        default=None,
    )
    static_capacity: RealOrNone = eqx.field(
        **real("N", "basic static load rating C0", above=0, otherwise=_RATED),
        default=None,
    )
    fatigue_load_limit: RealOrNone = eqx.field(
        **real("N", "fatigue load limit Cu", above=0, otherwise=_RATED), default=None
    )
    viscosity: RealOrNone = eqx.field(
        **real(
            "m²/s",
            "of the oil in operation",
            above=0,
            below=1,
            otherwise="that of [lubricant] at its temperature",
        ),
        default=None,
    )
    contamination: Any = eqx.field(
        converter=as_contamination,
        metadata=unit(
            "1",
            "contamination factor e_C, or a class of ISO 281, for the modified life",
            least=0,
            most=1,
            choices=tuple(CLEANLINESS),
            hint="e_C, or a class of ISO 281",
        ),
        default=None,
    )
    reliability: Real = eqx.field(
        **real(
            "1",
            "share of bearings that reach the life",
            least=0.9,
            most=0.9995,
            hint="a share, not %",
        ),
        default=0.9,
    )
    required: RealOrNone = eqx.field(
        **real("h", "life that is required, for a verdict", above=0, most=1e8),
        default=None,
    )
    required_revolutions: RealOrNone = eqx.field(
        **real(
            "1",
            "the same in revolutions",
            above=0,
            most=1e18,
            without={"required": "stands beside `required`, in hours; choose one"},
        ),
        default=None,
    )
    load_fixed_to: str = eqx.field(
        static=True,
        metadata=meaning(
            "`space`, or the ring that the load turns with", choices=FRAMES
        ),
        default="space",
    )
    edge_stress: bool = eqx.field(
        static=True,
        metadata=meaning(
            "whether the ends of rollers are stressed more, by ISO/TS 16281"
        ),
        default=True,
    )

    def __check_init__(self):
        for name in ("dynamic_capacity", "static_capacity", "fatigue_load_limit"):
            if getattr(self, name) is not None:
                positive(self, name)
        limits = self.fatigue_load_limit, self.static_capacity
        known = None if None in limits else floats(*limits)
        if known is not None:
            allowed = f"below `static_capacity`, {known[1]:.6g} N"
            check(self, "fatigue_load_limit", known[0] < known[1], allowed)
        # Single precision has 0.9 a little below it.
        in_range(self, "reliability", 0.9 - 1e-7, 1.0, include_low=True)
        one_of(self, "load_fixed_to", self.load_fixed_to, FRAMES)
        flag(self, "edge_stress", self.edge_stress)
        self._check_lubrication()
        for name in ("required", "required_revolutions"):
            if getattr(self, name) is not None:
                positive(self, name)
        if None not in (self.required, self.required_revolutions):
            raise ValueError(
                "LifeConditions: `required` is given in hours, and"
                " `required_revolutions` too; choose one."
            )

    @property
    def requires(self) -> bool:
        """Whether a life is required."""
        return (self.required, self.required_revolutions) != (None, None)

    @property
    def without_requirement(self) -> "LifeConditions":
        """The same without a required life, on which no life depends."""
        return with_fields(self, required=None, required_revolutions=None)

    def _check_lubrication(self):
        if self.viscosity is not None:
            positive(self, "viscosity")
            # A viscosity in mm²/s would be a million times too large.
            thin = in_numpy(self.viscosity) < 1.0
            check(self, "viscosity", thin, "below 1 m²/s (1 mm²/s is 1e-6 m²/s)")
        if self.contamination is not None:
            check_contamination(self, self.contamination)
        if (self.viscosity is None) != (self.contamination is None):
            pair = ("viscosity", "contamination")
            missing = pair[self.contamination is None]
            raise ValueError(
                f"LifeConditions: `{missing}` is missing; the modified life needs both"
                " `viscosity` and `contamination`."
            )


class Life(Printable):
    """Rating life of a bearing under one load.

    Numbers are NaN if the solution did not converge. Lives are in revolutions of one
    ring against the other.

    Attributes:
        ratings: Load ratings C, C0, C_u and where they come from.
        equivalent_load: P of ISO 281 [N].
        static_equivalent_load: P0 of ISO 76 [N].
        reference_load: Load with which C gives the reference life [N].
        radial_left_out: Radial load not included in P and P0, from
            `equivalent_load.left_out` [N].
        axial_left_out: Axial load not included [N].
        moment_left_out: Moment not included [N m].
        static_safety: C0/P0 [1].
        basic_rating_life: L10 = (C/P)^p of ISO 281 [rev].
        reference_rating_life: L10r of ISO/TS 16281 [rev].
        modified_rating_life: L_nmr [rev], or `None` without a lubricant.
        damage: Part of the modified life, or without a lubricant of the reference life
            times a1, that one revolution uses [1/rev].
        life_hours: Modified life, or without a lubricant the reference life, in hours
            [h]; `None` if no speed is known.
        viscosity_ratio: κ [1], or `None`.
        contamination_factor: e_C [1], or `None`.
        a_iso: Modified over reference life without a1 [1], or `None`.
        reliability_factor: a1 [1].
        damage_share: Shares of every row, raceway and track in the fatigue behind the
            reference life, by the survival of all (row, raceway, track) [1]. Raceways
            are (outer, inner); tracks are the arcs of a ball's raceway, or the laminae
            of a roller's from -L/2 to +L/2.
        limit_ratio: C_u over the load with which each track enters a_ISO
            (row, track) [1]; a large number without load.
        turns_against_load: 1 where a ring turns against the load (outer, inner) [1].
        raceway_damage: `damage` of every raceway by itself (row, raceway) [1/rev]. The
            standards rate no rolling elements apart from the raceways.
        critical_ratio: Critical amplitude on the outer raceway over that of the
            oscillation [1]; 0 where the rings turn, `None` without an amplitude.
    """

    ratings: Ratings
    equivalent_load: Scalar = eqx.field(metadata=unit("N"))
    static_equivalent_load: Scalar = eqx.field(metadata=unit("N"))
    reference_load: Scalar = eqx.field(metadata=unit("N"))
    radial_left_out: Scalar = eqx.field(metadata=unit("N"))
    axial_left_out: Scalar = eqx.field(metadata=unit("N"))
    moment_left_out: Scalar = eqx.field(metadata=unit("N m"))
    static_safety: Scalar = eqx.field(metadata=unit("1"))
    basic_rating_life: Scalar = eqx.field(metadata=unit("rev"))
    reference_rating_life: Scalar = eqx.field(metadata=unit("rev"))
    modified_rating_life: Scalar | None = eqx.field(metadata=unit("rev"))
    damage: Scalar = eqx.field(metadata=unit("1/rev"))
    life_hours: Scalar | None = eqx.field(metadata=unit("h"))
    viscosity_ratio: Scalar | None = eqx.field(metadata=unit("1"))
    contamination_factor: Scalar | None = eqx.field(metadata=unit("1"))
    a_iso: Scalar | None = eqx.field(metadata=unit("1"))
    reliability_factor: Scalar = eqx.field(metadata=unit("1"))
    damage_share: Float[Array, "row raceway=2 track"] = eqx.field(metadata=unit("1"))
    limit_ratio: Float[Array, "row track"] = eqx.field(metadata=unit("1"))
    turns_against_load: Float[Array, "raceway=2"] = eqx.field(metadata=unit("1"))
    raceway_damage: Float[Array, "row raceway=2"] = eqx.field(metadata=unit("1/rev"))
    critical_ratio: Scalar | None = eqx.field(metadata=unit("1"))

    to_xarray = to_xarray

    @property
    def dynamic_capacity(self) -> Float[Array, "*case"]:
        """C [N]."""
        return self.ratings.dynamic_capacity

    @property
    def static_capacity(self) -> Float[Array, "*case"]:
        """C0 [N]."""
        return self.ratings.static_capacity

    @property
    def standards(self) -> dict[str, str]:
        """Standard that each result follows, by the name of the result."""
        return STANDARDS

    @property
    def weakest(self) -> tuple[int, str, int]:
        """Row, raceway and track with the largest share of the fatigue.

        Of a single, concrete life.
        """
        share = np.asarray(self.damage_share)
        row, ring, track = np.unravel_index(int(np.argmax(share)), share.shape)
        return int(row), RINGS[int(ring)], int(track)


def rating_life(
    element: BearingElement | Solution,
    solution: Solution | None = None,
    conditions: LifeConditions | None = None,
    *,
    speed: Speed | None = None,
    lamina_load: Float[Array | np.ndarray, "element 2 lamina"] | None = None,
    oscillation: Scalar | float | None = None,
) -> Life:
    """Rating life of a solved bearing by ISO 281 and ISO/TS 16281.

    Args:
        element: The bearing that was solved; may be left out, as the solution holds it.
        solution: Its solution. Of rollers every second position is the middle of a
            lamina: 101 `points` are 50 laminae.
        conditions: Ratings, lubrication and reliability; `None`: `LifeConditions()`.
        speed: Ring speeds, if the solution has none; `None`: those of the solution.
            Without any the inner ring turns against a load fixed in space, and there is
            no life in hours.
        lamina_load: Load of every lamina on both raceways in place of the solution's
            [N], such as those of `refined_lamina_loads`. Concentrations of
            stress at the ends are then in it, whatever `edge_stress`.
        oscillation: Amplitude of rings that oscillate, half of the whole swing, at most
            π [rad]; 0, `None`: they turn. `speed` is then the mean one, 4 θ f of f
            cycles a second, and a revolution 2π of the way to and fro.

    Returns:
        Life, differentiable with respect to all that the solution is. Numbers are NaN
        if the solution did not converge.

    Raises:
        TypeError: For a bearing in place of an element, or text in place of numbers.
        ValueError: For numbers out of range, sets of unlike rows, several solutions at
            once (map over them), or fewer than 30 laminae of a roller.

    Source: ISO 281:2007; ISO/TS 16281:2008 (`reference_life`); ISO 76:2006;
        oscillations as in `life.oscillation`, with the film of their mean speed.
    """
    if solution is None:
        solution = cast(Solution, element)
        element = getattr(element, "element", element)
    check_element("rating_life", element)
    bearing = cast(BearingElement, element).bearing
    conditions = LifeConditions() if conditions is None else conditions
    of_class("rating_life", "conditions", conditions, LifeConditions, "LifeConditions")
    kinds = BallSolution | RollerSolution
    allowed = "what `solve_load` returns of a ball or roller bearing"
    of_class("rating_life", "solution", solution, kinds, allowed)
    if jnp.ndim(solution.result):
        raise ValueError(
            "rating_life: `solution` holds several cases; map over them with jax.vmap,"
            " or name lives in the `outputs` of `sweep`."
        )
    asked, solved = (_rows_in_words(b) for b in (bearing, solution.element.bearing))
    if asked != solved:
        raise ValueError(
            f"rating_life: `element` has {asked}, but the solution is of {solved}; it"
            " must be the bearing that was solved."
        )
    of_class("rating_life", "speed", speed, Speed | None, "a Speed")
    if speed is not None and (own := solution.speed) is not None:
        known = floats(speed.inner, speed.outer, own.inner, own.outer)
        if known is not None and not np.allclose(known[:2], known[2:], rtol=1e-6):
            raise ValueError(
                f"rating_life: `speed` is {known[0]:.6g} and {known[1]:.6g} rad/s"
                f" (inner, outer), but the solution has {known[2]:.6g} and"
                f" {known[3]:.6g} rad/s: leave `speed` out, or solve with it."
            )
    if lamina_load is not None:
        shape = np.shape(lamina_load)
        wanted = (*solution.roller_load.shape, *shape[2:3])
        if isinstance(solution, BallSolution) or shape != wanted or len(shape) != 3:
            raise ValueError(
                f"rating_life: `lamina_load` has shape {shape}; it must be (element, 2,"
                " lamina), of the rollers of the solution."
            )
    check_alike(bearing)
    if oscillation is not None:
        ends = "oscillation", 0.0, np.pi + 1e-9, oscillation, "rad"
        in_range("rating_life", *ends, include_low=True)
        oscillation = jnp.asarray(oscillation, solution.force.dtype)
    given = bearing, solution, lamina_load
    if are_known(given):
        # One program for all numbers of rolling elements.
        given = _with_empty_places(*given)
    return _life(*given, conditions, speed, oscillation)


def _with_empty_places(bearing, solution, lamina_load):
    if has_empty_places(bearing):
        return bearing, solution, lamina_load
    padded = solution_with_empty_places(solution)
    if lamina_load is not None:
        places, sizes = element_places(solution.row_sizes)
        lamina_load = spread_elements(lamina_load, places, sum(sizes))
    return with_places(bearing), padded, lamina_load


def _rows_in_words(bearing) -> str:
    """Type and number of elements of every row, in words: the static part."""
    rows = list(bearings_of(bearing))
    return " and ".join(f"{type(r).__name__} of {r.n_places}" for r in rows)


def life_outputs(life: Life, names: Sequence[str]) -> dict[str, Array]:
    """Numbers of a life, by name.

    Args:
        life: Life of one solution.
        names: Names of `LIFE_OUTPUTS`.

    Raises:
        ValueError: For one that the conditions or the solution do not give.
    """
    found = {name: getattr(life, name) for name in names}
    for name, value in found.items():
        if value is None:
            what = "ring speeds" if name == "life_hours" else "a lubricant"
            raise ValueError(f"rating_life: {name!r} needs {what}, which is not given.")
    return found


def solution_loads(
    solution: Solution, with_edges: bool = True
) -> Float[Array, "element 2 track"]:
    """Loads of the contacts of a solution that tire the raceways.

    Args:
        solution: Solution of balls or rollers.
        with_edges: Whether laminae count with `edge_stress`.

    Returns:
        Of balls on each arc, of rollers on each lamina (element, raceway, track) [N].

    Raises:
        ValueError: If a roller's positions are even in number, or make fewer than 30
            laminae.
    """
    return nearest_entry(_LOADS, solution)(solution, with_edges)


def _loads_of_balls(solution, with_edges):
    load = solution.contact_load
    return load.reshape(load.shape[0], 2, -1)


def _loads_of_rollers(solution, with_edges):
    points = solution.line_load.shape[-1]
    laminae = points // 2
    if points % 2 == 0 or laminae < LEAST_LAMINAE:
        raise ValueError(
            f"rating_life: the solution has {points} `points` along the rollers; they"
            f" must be odd and at least {2 * LEAST_LAMINAE + 1}: every second one is"
            " the middle of a lamina."
        )
    lengths = solution.position[..., -1] - solution.position[..., 0]
    width = jnp.broadcast_to(lengths, solution.line_load.shape[:1]) / laminae
    load = solution.line_load[..., 1::2] * width[:, None, None]
    if not with_edges:
        return load
    return load * jnp.asarray(edge_stress(laminae), load.dtype)[None, None]


_LOADS = {BallSolution: _loads_of_balls, RollerSolution: _loads_of_rollers}


@program(quick=True, what="rating life")
def _life(bearing, solution, *others) -> Life:
    return unless_failed(_life_of, (bearing, solution, *others), solution.converged)


def _life_of(bearing, solution, lamina_load, conditions, speed, swing=None) -> Life:
    speed = solution.speed if speed is None else speed
    loads = lamina_load
    if loads is None:
        loads = solution_loads(solution, conditions.edge_stress)
    first = 6 * RINGS.index(solution.moving_ring)
    force = solution.force[first : first + 6]
    loads, force = (
        jnp.where(solution.converged, value, jnp.nan) for value in (loads, force)
    )
    # What carries nothing does no damage: without load displacements have no
    # derivatives, and zero times infinity would be none of the life either.
    loads = jnp.where(loads <= 0, 0.0, loads)
    rated = ratings(
        bearing,
        conditions.dynamic_capacity,
        conditions.static_capacity,
        conditions.fatigue_load_limit,
    )
    kind = exponents_of(rows_of(bearing)[0].bearing)
    turning = turns_against_load(speed, conditions.load_fixed_to)
    parts = _rows(bearing, solution.row_sizes, loads, rated, turning, swing)
    share = jnp.stack([part.fatigue.share for part in parts])
    total = jnp.sum(share)
    n, d = kind.spread
    damage = positive_power(total, d, n) / _MILLION
    loaded = total > 0
    same = share / jnp.where(loaded, total, 1.0)
    life = _lifetime(damage)
    least = 1e-12 * rated.static_capacity
    equivalent = EquivalentLoad(
        *(_above_residual(p, least) for p in equivalent_load(bearing, force))
    )
    lost = left_out(bearing, force, solution.free)
    # ISO 281 rates rollers with 10/3, ISO/TS 16281 with 4 and a part of C.
    exponent = kind.basic
    ratio = equivalent.dynamic / rated.dynamic_capacity
    fields: dict[str, Any] = {
        "ratings": rated,
        "equivalent_load": equivalent.dynamic,
        "static_equivalent_load": equivalent.static,
        "reference_load": rated.dynamic_capacity
        * positive_power(_MILLION * damage, exponent[1], exponent[0]),
        "radial_left_out": _above_residual(lost.radial, least),
        "axial_left_out": _above_residual(lost.axial, least),
        "moment_left_out": _above_residual(lost.moment, least * pitch_radius(bearing)),
        "static_safety": _ratio(rated.static_capacity, equivalent.static),
        "basic_rating_life": _lifetime(positive_power(ratio, *exponent) / _MILLION),
        "reference_rating_life": life,
        "damage_share": same,
        "limit_ratio": jnp.stack(
            [load_ratio(jnp.ones_like(r.limit), r.limit, r.fatigue.load) for r in parts]
        ),
        "turns_against_load": turning,
        "critical_ratio": None if swing is None else _critical_ratio(bearing, swing),
    }
    a1 = reliability_factor(conditions.reliability)
    damage = damage / a1
    turns = None if speed is None else jnp.abs(speed.inner - speed.outer)
    modified: dict[str, Any] = {
        "viscosity_ratio": None,
        "contamination_factor": None,
        "a_iso": None,
        "modified_rating_life": None,
    }
    if conditions.viscosity is not None:
        kappa, clean = _lubrication(bearing, turns, conditions)
        worn = [_modified_damage(*row, kappa, clean, kind) for row in parts]
        share, tired = jnp.stack(worn), sum(jnp.sum(part) for part in worn)
        damage = positive_power(tired, d, n) / (_MILLION * a1)
        a_iso = (total / jnp.where(loaded, tired, 1.0)) ** (d / n)
        modified = {
            "viscosity_ratio": kappa,
            "contamination_factor": clean,
            "a_iso": jnp.where(total == 0, LARGEST_FACTOR, a_iso),
            "modified_rating_life": _lifetime(damage),
        }
    hours = None
    if turns is not None:
        hours = _lifetime(damage * turns * (3600.0 / (2.0 * jnp.pi)))
    alone = positive_power(jnp.sum(share, axis=2), d, n)
    fields["raceway_damage"] = alone / (_MILLION * a1)
    return Life(
        **fields, **modified, damage=damage, life_hours=hours, reliability_factor=a1
    )


def _critical_ratio(bearing, swing):
    row = rows_of(bearing)[0].bearing
    critical = critical_amplitudes(row, row.nominal_contact_angle)[0]
    return jnp.where(swing > 0, critical / jnp.where(swing > 0, swing, 1.0), 0.0)


class _RowPart(NamedTuple):
    """A row's fatigue, its share of C_u, and whether it is a thrust bearing."""

    fatigue: RowFatigue
    limit: Scalar
    thrust: Array


def _rows(bearing, row_sizes, loads, rated, turning, swing=None) -> list[_RowPart]:
    """Fatigue of every row, as bearings of their own."""
    ends, parts = np.cumsum(row_sizes), []
    alone = row_ratings(bearing, rated)
    sizes = zip(bearings_of(bearing), alone, row_sizes, ends, strict=True)
    for row, (capacity, limit), size, end in sizes:
        angle = row.nominal_contact_angle
        thrust = is_axial(row.is_thrust, angle)
        loaded = loads[int(end) - size : int(end)]
        fatigue = row_fatigue(row, capacity, angle, loaded, turning, swing)
        parts.append(_RowPart(fatigue, limit, thrust))
    return parts


def _lubrication(bearing, turns, conditions):
    """κ and e_C, of the largest row; without a speed they are those at standstill."""
    if turns is None:
        raise ValueError(
            "rating_life: `viscosity` is given, but no speed is known: solve with the"
            " `speed` of the rings, or pass it here."
        )
    pitch = 2.0 * pitch_radius(bearing)
    kappa = viscosity_ratio(conditions.viscosity, turns, pitch)
    clean = conditions.contamination
    if isinstance(clean, Cleanliness):
        clean = clean.factor(kappa, pitch)
    return kappa, clean


def _modified_damage(fatigue, limit, thrust, kappa, clean, kind):
    """Shares of a row, (raceway, track), each part with its own a_ISO."""
    ratio = load_ratio(clean, limit, fatigue.load)
    balls = kind is BALLS
    factor = life_factor(kappa, ratio, balls, thrust)
    n, d = kind.spread
    return fatigue.share * (factor ** -(n / d))[None]


def _above_residual(load, least):
    """A load, zero where it is no more than the solver's residual."""
    return jnp.where(load <= least, 0.0, load)


def _lifetime(damage):
    """1/damage; infinite, with zero derivative, without damage."""
    return _ratio(jnp.ones_like(damage), damage)


def _ratio(a, b):
    """a/b; infinite, with zero derivatives, where b is 0; NaN passes through."""
    nothing = b == 0
    return jnp.where(nothing, jnp.inf, a / jnp.where(nothing, 1.0, b))

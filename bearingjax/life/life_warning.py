"""Warnings about rating lives: their sizes and their texts."""

from collections.abc import Iterator, Mapping
from typing import Any

import jax
import numpy as np

from ..design import AbstractBearing, BearingSet, rows_of
from ..design.bearing_set import pitch_radius
from ..numerics.types import array_namespace
from ..numerics.warning import Kind, Warning
from ..statics.warning_kinds import SOLUTION_KINDS
from .life_factor import KAPPA
from .rating import Ratings
from .reference_life import LEAST_LAMINAE

MOST_AT_ENDS = 0.25
"""Share of the fatigue in the end laminae of rollers above which a warning is given.

With the standard's concentration of stress straight rollers have 0.74, 0.62 and 0.27
there with 30, 50 and 200 laminae, and with them lives of 0.75, 1 and 1.62; logarithmic
profiles have a twentieth, and lives that agree to 1 %.
"""


LARGEST_MOMENT = 0.1
"""Moment not included in P, over P times the pitch radius, that gives a warning [1]: it
takes a third of the reference life of a 6308."""

LEAST_LOAD = {"ball": 0.01, "roller": 0.02}
"""Least load over C at which rolling elements are sure to roll [1].

Source: rule of catalogues of rolling bearings (SKF), for want of a closer one.
"""


USUAL_RATINGS = {
    "dynamic_capacity": 1.0,
    "static_capacity": 1.0,
    "fatigue_load_limit": 0.07,
}
"""Usual ratings over the load of `_usual_load`, averaged over all types [1]."""


def given_rating_warnings(
    bearing: AbstractBearing | BearingSet, given: Mapping[str, Any]
) -> list[Warning]:
    """Warnings about ratings given twentyfold above or below usual ones.

    Args:
        bearing: The design, concrete.
        given: Ratings by name, such as `vars(conditions)` of `LifeConditions` [N];
            `None` of those that are not given.
    """
    usual = sum(_usual_load(row.bearing) for row in rows_of(bearing))
    found = []
    for name, share in USUAL_RATINGS.items():
        value = given.get(name)
        if value is not None and not 0.05 < float(value) / (share * usual) < 20.0:
            words = (
                f"life: `{name}` is {1e-3 * float(value):.4g} kN; bearings of this size"
                f" have some {1e-3 * share * usual:.2g} kN (another unit meant?)"
            )
            found.append(Warning("unusual_rating", words, float(value), where=name))
    return found


def _usual_load(row: Any) -> float:
    """Estimate C and C0 [N]: 18 N per mm² of all balls, 40 N per mm² of rollers."""
    if row.is_ball:
        return 18e6 * row.n_elements * float(row.ball_diameter) ** 2
    area = float(row.roller_diameter) * float(row.roller_length)
    return 40e6 * row.n_elements * area


def life_warnings(
    bearing: AbstractBearing | BearingSet, ratings: Ratings, numbers: Mapping[str, Any]
) -> list[Warning]:
    """Warnings about one rating life, a sentence each.

    Of many cases see `Sweep.warnings`.

    Args:
        bearing: The design, concrete.
        ratings: Load ratings, concrete.
        numbers: Numbers of a `Life` by name, such as `vars(life)`, concrete. Those are
            judged that there are.

    Source: ISO 281:2007, which doubts its lives of loads above C0 or C/2, and has no
        a_ISO below κ = 0.1; its diagrams of a_ISO and e_C end at κ = 4.
    """
    bearing, ratings, numbers = jax.device_get((bearing, ratings, dict(numbers)))
    return [
        LIFE_KINDS[name].warning(
            name, float(size), LIFE_KINDS[name].where(bearing, ratings, numbers)
        )
        for name, size in life_sizes(bearing, ratings, numbers).items()
        if size > LIFE_KINDS[name].limit
    ]


def life_sizes(
    bearing: AbstractBearing | BearingSet, ratings: Ratings, numbers: Mapping[str, Any]
) -> dict[str, Any]:
    """Size of every kind of warning about a life that can arise, NaN of a failed one.

    Args:
        bearing, ratings, numbers: As in `life_warnings`, traced or not.
    """
    known = {name: value for name, value in numbers.items() if value is not None}
    return dict(_sizes(bearing, ratings, known))


def _sizes(bearing, ratings, numbers) -> Iterator[tuple[str, Any]]:
    load = _load(numbers)
    if load is not None:
        yield "heavy_load", load / _limit(ratings)
    hours = numbers.get("life_hours")
    if load is not None and hours is not None:
        xp = array_namespace(load)
        # At a standstill nothing skids.
        turns = xp.isfinite(hours) | (load == 0)
        yield (
            "light_load",
            xp.where(turns, 1.0 - load / minimum_load(bearing, ratings), 0.0),
        )
    if "equivalent_load" in numbers:
        load, radius = numbers["equivalent_load"], pitch_radius(bearing)
        much = {"radial": 1e-6, "axial": 1e-6, "moment": LARGEST_MOMENT * radius}
        for name, share in much.items():
            lost = numbers.get(f"{name}_left_out", 0.0)
            over = lost - share * load
            yield (
                f"{name}_left_out",
                array_namespace(load).where(over > 0, lost, 0.0 * over),
            )
    if "viscosity_ratio" in numbers:
        kappa = numbers["viscosity_ratio"]
        xp = array_namespace(kappa)
        # At a standstill, where it is 0, nothing tires.
        yield "thin_film", KAPPA[0] / xp.where(kappa == 0, xp.inf, kappa)
        yield "thick_film", kappa
    if "critical_ratio" in numbers:
        yield "short_swing", numbers["critical_ratio"]
    share = numbers.get("damage_share")
    if share is not None and share.shape[-1] >= LEAST_LAMINAE:
        yield "loaded_ends", share[..., 0].sum() + share[..., -1].sum()
    if hours is not None and "damage" in numbers:
        xp = array_namespace(hours)
        # Without load there is none either, whatever the speed.
        still = xp.where(xp.isinf(hours), 1.0, 0.0)
        yield "no_hours", xp.where(numbers["damage"] > 0, still, xp.nan)


def _load(numbers) -> Any:
    """The larger one of P and of the load with the reference life, of those known."""
    names = ("equivalent_load", "reference_load")
    known = [numbers[name] for name in names if name in numbers]
    return array_namespace(known[0]).maximum(known[0], known[-1]) if known else None


def _limit(ratings):
    c, c0 = ratings.dynamic_capacity, ratings.static_capacity
    return array_namespace(c0).minimum(0.5 * c, c0)


def minimum_load(bearing: AbstractBearing | BearingSet, ratings: Ratings) -> Any:
    """Return the least equivalent load at which rolling elements are sure to roll [N].

    Args:
        bearing: The design.
        ratings: Its load ratings.

    Source: as `LEAST_LOAD`.
    """
    return LEAST_LOAD[bearing.noun] * ratings.dynamic_capacity


def _heavy_numbers(bearing, ratings, numbers):
    load, most = (1e-3 * float(x) for x in (_load(numbers), _limit(ratings)))
    return f"of {load:.4g} kN, above {most:.4g} kN,"


def _light_numbers(bearing, ratings, numbers):
    least = float(minimum_load(bearing, ratings))
    share = least / float(ratings.dynamic_capacity)
    kind = bearing.noun
    return (
        f"of {float(_load(numbers)):.4g} N, below {least:.4g} N, {share:g} C, which"
        f" makers of {kind} bearings ask for: the {kind}s"
    )


LIFE_KINDS: dict[str, Kind] = {
    "heavy_load": Kind(
        1.0,
        "equivalent load {where} the lesser of C0 and C/2: ISO 281 does not vouch for"
        " lives of such loads",
        _heavy_numbers,
        "{:.4g} times".format,
    ),
    "light_load": Kind(
        0.0,
        "equivalent load {where} may skid",
        _light_numbers,
        lambda size: (
            f"of {100.0 * (1.0 - size):.3g} % of the least one that makers ask for,"
            f" {LEAST_LOAD['ball']:g} C of ball and {LEAST_LOAD['roller']:g} C of"
            " roller bearings: the rolling elements"
        ),
    ),
    "radial_left_out": Kind(
        0.0,
        "radial load of {size:.4g} N, for which ISO 281 has no factor at 90°: P and P0"
        " have no part of it",
    ),
    "axial_left_out": Kind(
        0.0,
        "axial load of {size:.4g} N, for which ISO 281 has no factor at 0°: P and P0"
        " have no part of it",
    ),
    "moment_left_out": Kind(
        0.0,
        "moment of {size:.4g} N m about the pressure centre: P and P0, and with them"
        " the basic life and the static safety, have no part of it; the reference life"
        " of ISO/TS 16281 has",
    ),
    "thin_film": Kind(
        1.0,
        "viscosity ratio of {size:.3g}: ISO 281 has no a_ISO below"
        f" {KAPPA[0]:g}; the one at {KAPPA[0]:g} is taken",
        shown=lambda size: KAPPA[0] / size,
    ),
    "thick_film": Kind(
        KAPPA[1],
        "viscosity ratio of {size:.3g}: the diagrams of ISO 281 end at"
        f" {KAPPA[1]:g}; a_ISO and the e_C of a class of cleanliness are those at"
        f" {KAPPA[1]:g}",
    ),
    "loaded_ends": Kind(
        MOST_AT_ENDS,
        "{size:.3g} % of the fatigue is in the laminae at the ends of the rollers: at"
        " sharp ends the life depends on the number of laminae{where}; with a profile"
        " that runs out it does not",
        lambda b, r, numbers: f", {np.shape(numbers['damage_share'])[2]} here",
        shown=lambda size: 100 * size,
    ),
    "short_swing": Kind(
        1.0,
        "critical amplitude {size:.3g} times that of the oscillation: no rolling"
        " element reaches the track of the next one on the outer raceway, and wear"
        " (false brinelling), which no rating counts, decides rather than fatigue",
    ),
    "no_hours": Kind(
        0.0,
        "the rings do not turn against each other: there is no life in hours",
        of_all=True,
    ),
}
"""Every kind of warning about a life, by name, in the order of the reports; their
`where` takes bearing, ratings and numbers of one life."""


ALL: dict[str, Kind] = {**SOLUTION_KINDS, **LIFE_KINDS}
"""Every kind of warning about a case, by name."""

"""What is doubtful about rating lives, in words."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..design import Bearing, BearingSet, is_ball, pitch_radius
from .life_factor import KAPPA
from .rating import Ratings
from .reference_life import LEAST_LAMINAE

MOST_AT_ENDS = 0.25
"""Share of the fatigue in the laminae at the ends of rollers above which it is told.

With the standard's concentration of stress straight rollers have 0.74, 0.62 and 0.27
there with 30, 50 and 200 laminae, and with them lives of 0.75, 1 and 1.62; logarithmic
profiles have a twentieth, and lives that agree to 1 %.
"""


LARGEST_MOMENT = 0.1
"""Moment that P has no part of, over P times the pitch radius, above which it is told
[1]: it takes a third of the reference life of a 6308."""

LEAST_LOAD_OF_BALLS, LEAST_LOAD_OF_ROLLERS = 0.01, 0.02
"""Least load over C at which rolling elements are sure to roll [1].

Source: rule of catalogues of rolling bearings (SKF), for want of a closer one.
"""


def life_warnings(
    bearing: Bearing | BearingSet, ratings: Ratings, numbers: Mapping[str, Any]
) -> list[str]:
    """Warnings about a rating life, or about those of many cases, a sentence each.

    Args:
        bearing: The design, concrete.
        ratings: Load ratings, concrete.
        numbers: Of a `Life` by name, such as `vars(life)`, concrete; in many cases
            (case,). Those are judged that there are; `damage_share` of one load.

    Source: ISO 281:2007, which doubts its lives of loads above C0 or C/2, and has no
        a_ISO below κ = 0.1; its diagrams of a_ISO and e_C end at κ = 4.
    """
    return [
        *_heavy(ratings, numbers),
        *_light(bearing, ratings, numbers),
        *_left_out(bearing, numbers),
        *_off_the_diagrams(numbers),
        *_at_ends(numbers),
        *_still(numbers),
    ]


def _load(numbers):
    """The larger one of P and of the load with the reference life, of those known."""
    names = ("equivalent_load", "reference_load")
    known = [np.asarray(numbers[name]) for name in names if name in numbers]
    return np.max(known, axis=0) if known else None


def _heavy(ratings, numbers):
    most = min(0.5 * float(ratings.dynamic_capacity), float(ratings.static_capacity))
    load = _load(numbers)
    if load is None or not (load > most).any():
        return []
    return [
        f"equivalent load of {1e-3 * np.nanmax(load):.4g} kN, above"
        f" {1e-3 * most:.4g} kN, the lesser of C0 and C/2: ISO 281 does not vouch for"
        f" lives of such loads{in_how_many(load > most, load)}"
    ]


def _light(bearing, ratings, numbers):
    """Too little load to roll; at a standstill nothing skids."""
    hours, load = numbers.get("life_hours"), _load(numbers)
    if hours is None or load is None:
        return []
    balls = is_ball(bearing)
    share = LEAST_LOAD_OF_BALLS if balls else LEAST_LOAD_OF_ROLLERS
    least = share * float(ratings.dynamic_capacity)
    turns = np.isfinite(hours) | (load == 0)
    light = (load < least) & turns
    if not light.any():
        return []
    kind = "ball" if balls else "roller"
    return [
        f"equivalent load of {np.min(load[light]):.4g} N, below {least:.4g} N,"
        f" {share:g} C, which makers of {kind} bearings ask for: the {kind}s may skid"
        f"{in_how_many(light, np.where(light, -load, -np.inf))}"
    ]


def _left_out(bearing, numbers):
    """Warnings about parts of the load that P and P0 leave out."""
    if "equivalent_load" not in numbers:
        return []
    load = np.asarray(numbers["equivalent_load"])
    told = []
    for name, words in _LOST.items():
        lost = np.asarray(numbers.get(f"{name}_left_out", 0.0))
        share = 1e-6
        if name == "moment":
            share = LARGEST_MOMENT * float(pitch_radius(bearing))
        much = lost > share * load
        if much.any():
            size = f"{np.max(lost[much]):.4g}"
            told.append(f"{name} {words.format(size)}{in_how_many(much, lost)}")
    return told


_LOST = {
    "radial": "load of {} N, for which ISO 281 has no factor at 90°: P and P0 have no"
    " part of it",
    "axial": "load of {} N, which ribs bear: P and P0 have no part of it",
    "moment": "of {} N m about the pressure centre: P and P0, and with them the basic"
    " life and the static safety, have no part of it; the reference life of ISO/TS"
    " 16281 has",
}
"""Warnings by the part of the load that P and P0 leave out."""


def _off_the_diagrams(numbers):
    if numbers.get("viscosity_ratio") is None:
        return []
    kappa = np.asarray(numbers["viscosity_ratio"])
    # At a standstill, where it is 0, nothing tires.
    thin, thick = (kappa > 0) & (kappa < KAPPA[0]), kappa > KAPPA[1]
    found = []
    if thin.any():
        found.append(
            f"viscosity ratio of {kappa[thin].min():.3g}: ISO 281 has no a_ISO below"
            f" {KAPPA[0]:g}; the one at {KAPPA[0]:g} is taken"
            f"{in_how_many(thin, np.where(thin, -kappa, -np.inf))}"
        )
    if thick.any():
        found.append(
            f"viscosity ratio of {kappa[thick].max():.3g}: the diagrams of ISO 281 end"
            f" at {KAPPA[1]:g}; a_ISO and the e_C of a class of cleanliness are those"
            f" at {KAPPA[1]:g}{in_how_many(thick, kappa)}"
        )
    return found


def _at_ends(numbers):
    share = numbers.get("damage_share")
    if share is None or np.ndim(share) != 3 or np.shape(share)[2] < LEAST_LAMINAE:
        return []
    ends = float(np.sum(np.asarray(share)[:, :, [0, -1]]))
    if not ends > MOST_AT_ENDS:
        return []
    return [
        f"{100 * ends:.3g} % of the fatigue is in the laminae at the ends of the"
        " rollers: at sharp ends the life depends on the number of laminae,"
        f" {np.shape(share)[2]} here; with a profile that runs out it does not"
    ]


def _still(numbers):
    hours = numbers.get("life_hours")
    if hours is None or not np.isinf(hours).all():
        return []
    if not (np.asarray(numbers["damage"]) > 0).any():
        return []
    return ["the rings do not turn against each other: there is no life in hours"]


def in_how_many(flags: Any, size: Any) -> str:
    """In how many of many cases, and the worst of them; "" of one case.

    Args:
        flags: Which cases (case,).
        size: How bad they are (case,).
    """
    if not np.ndim(flags):
        return ""
    worst = int(np.nanargmax(size))
    return f", in {int(flags.sum())} of {len(flags)} cases, worst case {worst}"

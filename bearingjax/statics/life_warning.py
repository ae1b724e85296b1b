"""What is doubtful about rating lives, in words."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from .life_factor import KAPPA
from .rating import Ratings
from .reference_life import LEAST_LAMINAE

MOST_AT_ENDS = 0.25
"""Share of the fatigue in the laminae at the ends of rollers above which it is told.

With the standard's concentration of stress straight rollers have 0.74, 0.62 and 0.27
there with 30, 50 and 200 laminae, and with them lives of 0.75, 1 and 1.62; logarithmic
profiles have a twentieth, and lives that agree to 1 %.
"""


def life_warnings(ratings: Ratings, numbers: Mapping[str, Any]) -> list[str]:
    """Warnings about a rating life, or about those of many cases, a sentence each.

    Args:
        ratings: Load ratings, concrete.
        numbers: Of a `Life` by name, concrete, in many cases (case,): `equivalent_load`
            and `reference_load`; of those that are known `viscosity_ratio`, and
            `life_hours` with `damage`; of one load `damage_share`.

    Source: ISO 281:2007, which doubts its lives of loads above C0 or C/2, and has no
        a_ISO below κ = 0.1; its diagrams of a_ISO and e_C end at κ = 4.
    """
    return [
        *_heavy(ratings, numbers),
        *_off_the_diagrams(numbers),
        *_at_ends(numbers),
        *_still(numbers),
    ]


def _heavy(ratings, numbers):
    most = min(0.5 * float(ratings.dynamic_capacity), float(ratings.static_capacity))
    load = np.maximum(numbers["equivalent_load"], numbers["reference_load"])
    if not (load > most).any():
        return []
    return [
        f"equivalent load of {1e-3 * np.nanmax(load):.4g} kN, above"
        f" {1e-3 * most:.4g} kN, the lesser of C0 and C/2: ISO 281 does not vouch for"
        f" lives of such loads{_where(load > most, load)}"
    ]


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
            f"{_where(thin, np.where(thin, -kappa, -np.inf))}"
        )
    if thick.any():
        found.append(
            f"viscosity ratio of {kappa[thick].max():.3g}: the diagrams of ISO 281 end"
            f" at {KAPPA[1]:g}; a_ISO and the e_C of a class of cleanliness are those"
            f" at {KAPPA[1]:g}{_where(thick, kappa)}"
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


def _where(flags, size) -> str:
    """In how many of many cases, and the worst of them."""
    if not np.ndim(flags):
        return ""
    worst = int(np.nanargmax(size))
    return f", in {int(flags.sum())} of {len(flags)} cases, worst case {worst}"

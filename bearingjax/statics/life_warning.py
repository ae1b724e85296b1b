"""What is doubtful about rating lives, in words."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from .life_factor import KAPPA
from .rating import Ratings


def life_warnings(ratings: Ratings, numbers: Mapping[str, Any]) -> list[str]:
    """Warnings about a rating life, or about those of many cases, a sentence each.

    Args:
        ratings: Load ratings, concrete.
        numbers: Of a `Life` by name, concrete, in many cases (case,): `equivalent_load`
            and `reference_load`; of those that are known `viscosity_ratio`, and
            `life_hours` with `damage`.

    Source: ISO 281:2007, which doubts its lives of loads above C0 or C/2, and has no
        a_ISO below κ = 0.1.
    """
    return [*_heavy(ratings, numbers), *_thin(numbers), *_still(numbers)]


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


def _thin(numbers):
    if numbers.get("viscosity_ratio") is None:
        return []
    kappa = np.asarray(numbers["viscosity_ratio"])
    # At a standstill, where it is 0, nothing tires.
    thin = (kappa > 0) & (kappa < KAPPA[0])
    if not thin.any():
        return []
    return [
        f"viscosity ratio of {kappa[thin].min():.3g}: ISO 281 has no a_ISO below"
        f" {KAPPA[0]:g}; the one at {KAPPA[0]:g} is taken"
        f"{_where(thin, np.where(thin, -kappa, -np.inf))}"
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

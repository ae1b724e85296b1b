"""Validation cases nearest to a bearing and its load."""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from ..design import AbstractBearing
from ..design.checks import must_be
from ..design.keywords import BALLS, ROLLERS
from .case import SUBJECTS, Case, cases


class Near(NamedTuple):
    """A case beside a bearing.

    Attributes:
        case: The case, of the same type.
        size: Pitch diameter of the bearing over that of the case [1].
        load: Load over the square of the pitch diameter, over that of the case [1].
    """

    case: Case
    size: float
    load: float


def type_of(bearing: AbstractBearing) -> str:
    """Return the `type` of a row in scenes; empty if it has none."""
    kinds = {kind: name for name, kind in {**ROLLERS, **BALLS}.items()}
    return kinds.get(type(bearing), "")


def nearest_cases(
    bearing: AbstractBearing,
    load: float,
    count: int = 2,
    subjects: Collection[str] = tuple(SUBJECTS),
) -> tuple[Near, ...]:
    """Return the cases of the same type that are nearest in size and load.

    Near is what has like pitch diameter d_m and like load over its square, which is
    like pressure in bearings of like shape; the smaller the sum of the logarithms of
    both ratios, the nearer.

    Args:
        bearing: A row.
        load: Size of its load [N]; at 0 the loads of the cases do not count.
        count: How many cases at most.
        subjects: Keys of `SUBJECTS` that cases may be about.

    Raises:
        ValueError: For a subject that is none.
    """
    known, allowed = set(subjects) <= SUBJECTS.keys(), f"of {[*SUBJECTS]}"
    must_be("nearest_cases", "subjects", subjects, known, allowed, ValueError)
    pitch, kind = float(bearing.pitch_diameter), type_of(bearing)
    found = []
    for case in cases().values():
        like = kind and case.type == kind and case.subject in subjects
        if like and case.pitch_diameter and case.load:
            size = pitch / case.pitch_diameter
            found.append(Near(case, size, load / case.load / size**2))

    def distance(near: Near) -> float:
        of_load = abs(np.log(near.load)) if near.load else 0.0
        return float(abs(np.log(near.size)) + of_load)

    return tuple(sorted(found, key=distance)[:count])

"""Compile the programs of a kind of bearing ahead of time."""

from collections.abc import Sequence

import numpy as np

from ...catalogue import catalogue_entries, catalogue_entry
from ...catalogue.entry import bearing_of_entry
from ...element import BearingElement, Speed
from ...life.life import LifeConditions, rating_life
from ...numerics.compiled.programs import n_compiled
from ...numerics.compiled.structure import structure
from ...numerics.types import as_real
from ...statics import SolveOptions, solve_load
from ...statics.empty_places import with_empty_places
from ...statics.load_result import solution_at


def kinds_of_catalogue(
    designations: Sequence[str] | None = None,
) -> list[tuple[str, BearingElement]]:
    """Return a bearing of each kind, those of which the catalogue has most first.

    Args:
        designations: Bearings whose kinds are wanted; `None`: all.

    Raises:
        ValueError: For one that is not in the catalogue.
    """
    names = designations
    if names is None:
        names = [entry.designation for entry in catalogue_entries()]
    kinds: dict[str, list[tuple[str, BearingElement]]] = {}
    for name in names:
        element = BearingElement(bearing_of_entry(catalogue_entry(name)))
        kind = structure(with_empty_places(element))
        kinds.setdefault(kind, []).append((name, element))
    return [one[0] for one in sorted(kinds.values(), key=len, reverse=True)]


def warm(element: BearingElement) -> int:
    """Run what `solve`, `life` and `shaft` do of a bearing; return how many programs
    that compiled.

    Args:
        element: Any bearing of the kind.
    """
    before = n_compiled()
    at_speed = Speed(as_real(10.0), as_real(0.0))
    conditions = LifeConditions(viscosity=1e-5, contamination=0.5)
    for speed in (None, at_speed):
        found = solve_load(element, np.zeros(6), speed=speed, throw=False)
        rating_life(found, conditions=conditions if speed is not None else None)
    rings = as_real(np.zeros(12))
    points = SolveOptions().points
    for inertia in (False, True):
        solution_at(element, rings, at_speed, points, inertia)
    return n_compiled() - before

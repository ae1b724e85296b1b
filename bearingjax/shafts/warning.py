"""Warnings about the loads that the bearings of a system of shafts share."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..numerics.warning import Warning
from ..statics.support import axial_senses
from .system import ShaftSystem

_NOTHING = 1e-9
"""Load of a bearing over the largest of all that counts as none [1]."""
_LOST = 0.05
"""Axial load over the preload in the cold below which the preload is lost [1]."""


def load_doubts(system: ShaftSystem, loads: Any) -> Iterator[Warning]:
    """Yield warnings: bearings that bear nothing, lost preloads, shafts located twice.

    Args:
        system: The system, with its preloads.
        loads: On each inner ring in global axes (case, bearing, 6) [N, N m]; NaN in
            failed cases.
    """
    loads = np.asarray(loads)
    forces = np.abs(loads[..., :3])
    most = forces.max(axis=(1, 2))
    for k, seat in enumerate(system.seats):
        if seat.installed is None:
            continue
        idle = np.flatnonzero(forces[:, k].max(axis=1) <= _NOTHING * most)
        if idle.size:
            where = _where(idle, len(loads))
            words = f"it bears nothing{where}; it may skid"
            yield Warning("idle_bearing", words).about(seat.name)
        if seat.preload is not None:
            kept = np.array([axial_load(system, k, load) for load in loads[:, k]])
            lost = np.flatnonzero(kept < _LOST * float(seat.preload))
            if lost.size:
                least = max(float(np.nanmin(kept)), 0.0)
                words = (
                    f"adjusted with {float(seat.preload):.5g} N, it keeps an axial load"
                    f" of {least:.4g} N{_where(lost, len(loads))}: the preload is lost"
                    " to loads or heat"
                )
                yield Warning("lost_preload", words, least).about(seat.name)
    yield from _located_twice(system)


def axial_load(system: ShaftSystem, index: int, load: Any) -> float:
    """Return the axial part of a load on a bearing, along the bearing's own z [N].

    Args:
        system: The system.
        index: Number of the bearing.
        load: On its inner ring in global axes (6,) [N, N m].
    """
    seat = system.seats[index]
    along = np.asarray(system.shaft(seat.shaft).frame[2]) @ load[:3]
    return float(-along if seat.turned else along)


def _where(cases: np.ndarray, count: int) -> str:
    """Return in words the number of cases with a warning; empty for a single case."""
    if count == 1:
        return ""
    return f" in {len(cases)} of {count} cases (case {cases[0]})"


def _located_twice(system: ShaftSystem) -> Iterator[Warning]:
    """Yield a warning for each shaft that several bearings hold both ways."""
    for shaft in system.shafts:
        both = [
            seat.name
            for seat in system.seats
            if seat.shaft == shaft.name
            and seat.installed is not None
            and not seat.floating
            and len(axial_senses(seat.installed.drawing.bearing)) == 2
        ]
        if len(both) > 1:
            yield Warning(
                "located_twice",
                f"shaft {shaft.name} is located by {' and '.join(both)}: warmth and"
                " tolerances of the distance press them against each other; let all but"
                " one float (`floating`)",
                where=f"shaft {shaft.name}",
            )

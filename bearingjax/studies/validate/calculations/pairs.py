"""Pairs of angular contact ball bearings."""

from typing import Any

import numpy as np

from ....design.ball_types import AngularContactBallBearing
from ....element.bearing_element import BearingElement
from ....statics.load import solve_load
from ....statics.support import Support


def preloaded_pair(
    bore: float,
    outside_diameter: float,
    preload: np.ndarray,
    measuring_load: float,
    **more: Any,
) -> dict[str, np.ndarray]:
    """Return axial rigidity and axial clearance of a pair back to back.

    The rigidity of a pair is twice that of one bearing under the preload; its clearance
    is what the rings of one move between preload and measuring load, twice.

    Args:
        bore, outside_diameter: d and D; the pitch diameter is their mean [m].
        preload: Preloads (n,) [N].
        measuring_load: Axial load under which the maker measures clearance [N].
        more: Other fields of the bearing.
    """
    pitch = 0.5 * (bore + outside_diameter)
    bearing = AngularContactBallBearing(pitch_diameter=pitch, **more)
    element = BearingElement(bearing)
    axial = Support(free=["ux", "uy", "uz"])
    solved = [
        solve_load(element, [0.0, 0.0, force, 0.0, 0.0, 0.0], support=axial)
        for force in (*preload, measuring_load)
    ]
    moved = np.array([float(one.displacement[8]) for one in solved])
    rigidity = np.array([2.0 * float(one.stiffness[8, 8]) for one in solved[:-1]])
    return {"rigidity": rigidity, "clearance": -2.0 * (moved[:-1] - moved[-1])}


def fixed_sets(preload: float, count: int, **bearing: Any) -> dict[str, np.ndarray]:
    """Return preload and axial rigidity over those of the pair: of one bearing against
    two and of two against two, pressed together as much as the pair.

    Args:
        preload: That of the pair [N].
        count: How often the ratios are returned, which no size changes.
        bearing: Other arguments of `preloaded_pair`.
    """
    share, rigidity = 1.36, np.nan  # by Hertz contact at a constant angle
    for _ in range(2):  # Newton's steps
        loads = preload * np.array([1.0, share, 0.5 * share])
        found = preloaded_pair(preload=loads, **bearing)
        pair, one, half = found["rigidity"]
        moved = -0.5 * found["clearance"]
        missing = 2.0 * moved[0] - moved[1] - moved[2]
        share += missing / (2.0 / one + 1.0 / half) / preload
        rigidity = (0.5 * one + half) / pair
    ratios = {"preload": [share, 2.0], "rigidity": [rigidity, 2.0]}
    return {name: np.tile(both, (count, 1)) for name, both in ratios.items()}

"""Typical proportions of catalogue bearings, which makers are free to choose.

The section is half of the difference of outside diameter and bore. Most bearings of a
type share a few ratios to it, given here by a middle and a spread (one standard
deviation) over makers' catalogues and the literature.
"""

import math
from typing import NamedTuple

_DEG = math.pi / 180


class Typical(NamedTuple):
    """Usual value of a number and its spread."""

    middle: float
    spread: float


class Proportions(NamedTuple):
    """Typical proportions of one type of bearing.

    Attributes:
        element: Diameter of the rolling elements over the section [1]; of thrust
            bearings over the height.
        pitch: Pitch diameter over the mean of bore and outside diameter [1].
        filling: Filling of the row: arc of the pitch circle over which the elements
            of a deep groove bearing lie, from the first to the last [rad]; for other
            types the share of the circle that the elements occupy [1].
        length: Roller length over the width [1]; `None` for balls.
        angle: Contact angle [rad].
        by_arc: Whether `filling` is the arc.
    """

    element: Typical
    pitch: Typical
    filling: Typical
    length: Typical | None
    angle: Typical
    by_arc: bool = False


_NONE = Typical(0.0, 1e-4)
_CENTRED = Typical(1.0, 0.012)

PROPORTIONS = {
    # As many balls as go in between eccentric rings: half of the circle and a little.
    "deep_groove_ball": Proportions(
        Typical(0.58, 0.055),
        _CENTRED,
        Typical(187 * _DEG, 4 * _DEG),
        None,
        _NONE,
        by_arc=True,
    ),
    "angular_contact_ball": Proportions(
        Typical(0.59, 0.05),
        _CENTRED,
        Typical(0.84, 0.07),
        None,
        Typical(35 * _DEG, 8 * _DEG),
    ),
    "four_point_ball": Proportions(
        Typical(0.62, 0.04),
        _CENTRED,
        Typical(0.86, 0.05),
        None,
        Typical(35 * _DEG, 5 * _DEG),
    ),
    "self_aligning_ball": Proportions(
        Typical(0.52, 0.05),
        _CENTRED,
        Typical(0.80, 0.06),
        None,
        Typical(11 * _DEG, 3 * _DEG),
    ),
    "thrust_ball": Proportions(
        Typical(0.52, 0.04),
        Typical(1.0, 0.006),
        Typical(0.90, 0.02),
        None,
        Typical(90 * _DEG, 1e-4),
    ),
    "cylindrical_roller": Proportions(
        Typical(0.51, 0.04),
        Typical(1.0, 0.015),
        Typical(0.76, 0.06),
        Typical(0.57, 0.06),
        _NONE,
    ),
    "needle_roller": Proportions(
        Typical(0.35, 0.08),
        Typical(0.99, 0.03),
        Typical(0.82, 0.07),
        Typical(0.75, 0.08),
        _NONE,
    ),
    "tapered_roller": Proportions(
        Typical(0.42, 0.04),
        Typical(1.0, 0.015),
        Typical(0.88, 0.05),
        Typical(0.68, 0.07),
        Typical(14 * _DEG, 2.5 * _DEG),
    ),
}
"""By name of the type."""

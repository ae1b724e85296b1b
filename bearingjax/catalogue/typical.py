"""Typical proportions of catalogue bearings, which makers are free to choose.

The section is half of the difference of outside diameter and bore. Most bearings of a
type share a few ratios to it, given here by a middle and a spread (one standard
deviation) over makers' catalogues and the literature.
"""

import math
from typing import Annotated, NamedTuple

from ..numerics.units import unit

_DEG = math.pi / 180


class Typical(NamedTuple):
    """Usual value of a number and its spread."""

    middle: float
    spread: float


class Proportions(NamedTuple):
    """Typical proportions of one type of bearing.

    Attributes:
        element: Diameter of the rolling elements over the section [1]; of thrust
            ball bearings over the height.
        pitch: Pitch diameter over the mean of bore and outside diameter [1].
        filling: Filling of the row: arc of the pitch circle over which the elements
            of a deep groove bearing lie, from the first to the last [rad]; for other
            types the share of the circle that the elements occupy [1].
        length: Roller length over the width [1]; `None` for balls.
        angle: Contact angle [rad].
        by_arc: Whether `filling` is the arc.
    """

    element: Annotated[Typical, unit("1")]
    pitch: Annotated[Typical, unit("1")]
    filling: Annotated[Typical, unit("1")]
    length: Annotated[Typical | None, unit("1")]
    angle: Annotated[Typical, unit("rad")]
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
    "spherical_roller": Proportions(
        Typical(0.515, 0.018),
        Typical(1.013, 0.008),
        Typical(0.87, 0.02),
        Typical(0.355, 0.02),
        Typical(11.3 * _DEG, 1.8 * _DEG),
    ),
    "toroidal_roller": Proportions(
        Typical(0.525, 0.023),
        Typical(1.004, 0.016),
        Typical(0.87, 0.02),
        Typical(0.71, 0.065),
        _NONE,
    ),
    "spherical_thrust_roller": Proportions(
        Typical(0.55, 0.025),
        Typical(1.02, 0.006),
        Typical(0.82, 0.02),
        Typical(0.60, 0.025),
        Typical(50.5 * _DEG, 1.2 * _DEG),
    ),
    "cylindrical_thrust_roller": Proportions(
        Typical(0.60, 0.035),
        Typical(1.0, 0.006),
        Typical(0.73, 0.08),
        Typical(0.41, 0.03),
        Typical(90 * _DEG, 1e-4),
    ),
    "crossed_roller": Proportions(
        Typical(0.35, 0.045),
        Typical(0.992, 0.007),
        Typical(0.71, 0.09),
        Typical(0.32, 0.05),
        Typical(45 * _DEG, 1e-4),
    ),
}
"""By name of the type."""

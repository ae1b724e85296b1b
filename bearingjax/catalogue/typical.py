"""Typical proportions of catalogue bearings, which makers are free to choose.

The section is half of the difference of outside diameter and bore. Most bearings of a
type share a few ratios to it, given here by a middle and a spread (one standard
deviation) over makers' catalogues and the literature.
"""

from typing import Annotated, Any, NamedTuple

import numpy as np

from ..numerics.constants import read_package_table
from ..numerics.units import unit


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
        angle: Contact angle [rad].
        length: Roller length over the width [1]; `None` for balls.
        by_arc: Whether `filling` is the arc.
    """

    element: Annotated[Typical, unit("1")]
    pitch: Annotated[Typical, unit("1")]
    filling: Annotated[Typical, unit("1")]
    angle: Annotated[Typical, unit("rad")]
    length: Annotated[Typical | None, unit("1")] = None
    by_arc: bool = False


def _read(filling_arc=None, **numbers: Any) -> Proportions:
    """The proportions of a type, from its table with angles in degrees."""
    numbers["angle"] = np.radians(numbers["angle"])
    if filling_arc is not None:
        numbers["filling"] = np.radians(filling_arc)
    for key, pair in numbers.items():
        numbers[key] = Typical(*map(float, pair))
    return Proportions(by_arc=filling_arc is not None, **numbers)


PROPORTIONS: dict[str, Proportions] = {
    name: _read(**numbers)
    for name, numbers in read_package_table(
        "bearingjax.catalogue", "typical.toml"
    ).items()
}
"""By name of the type."""

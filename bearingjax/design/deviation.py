"""Deviations of the rolling elements and raceways of a row, element by element."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from ..numerics.types import Reals
from ..numerics.units import unit, unit_of
from .checks import check, finite, floats, is_real, is_traced, must_be, of_shape


class Deviation(NamedTuple):
    """Differences of every rolling element of a row from the design.

    Each is `None` where all are equal. All work on a row is mapped over the leading
    axis of this structure.

    Attributes:
        diameter: Its diameter less the common one (element,) [m].
        azimuth: Its azimuth less that of even spacing (element,) [rad].
        raceway: Deviations of the outer and the inner raceway there (element, 2, 3)
            [m]: displacement along z, displacement from the axis, and height of the
            contact along its normal, by material on the raceway or on the element.
    """

    diameter: Annotated[Reals | None, unit("m")] = None
    azimuth: Annotated[Reals | None, unit("rad")] = None
    raceway: Annotated[Reals | None, unit("m")] = None

    @property
    def makes_unlike(self) -> bool:
        """Whether the elements themselves differ. Static."""
        return self.diameter is not None or self.raceway is not None


def deviation_of(bearing: Any) -> Deviation:
    """The deviations of the rolling elements of a single row."""
    diameter = bearing.element_deviation
    return Deviation(diameter, bearing.azimuth_deviation, bearing.raceway_deviation)


def with_raceways(bearing: Any, deviation: Float[Array, "element 2 3"]) -> Any:
    """A single row with further deviations of its raceways, also under `jit`.

    Args:
        bearing: The design.
        deviation: `Deviation.raceway` [m].
    """
    return eqx.tree_at(
        lambda b: b.raceway_deviation, bearing, deviation, is_leaf=lambda x: x is None
    )


def largest_deviation(bearing: Any) -> float | None:
    """Upper bound of the size of raceway deviations [m]; `None`: not known.

    The distance of ball centre and groove centre, or half of a roller's diameter.
    """
    numbers = floats(*bearing.deviation_bounds)
    return None if numbers is None else min(numbers)


def check_deviation(owner: Any, name: str, count: int, what: str) -> np.ndarray | None:
    """Raise unless a deviation is one finite number for each rolling element.

    Args:
        owner: The bearing.
        name: Field.
        count: Number of rolling elements.
        what: Description with the unit, in words.

    Returns:
        The numbers, if there are any and they are known.

    Raises:
        TypeError: If they are no numbers.
        ValueError: If their number is not that of the elements, or one is not finite.
    """
    value = getattr(owner, name)
    if value is None or is_traced(value):
        return None
    allowed = f"numbers in {unit_of(owner, name)}"
    must_be(owner, name, value, is_real(value), allowed, TypeError)
    of_shape(owner, name, np.shape(value) == (count,), f"({count},), {what}")
    finite(owner, name)
    return np.asarray(value)


def check_raceways(owner: Any, count: int, most: float) -> None:
    """Raise unless `raceway_deviation` is as `Deviation.raceway` says.

    Args:
        owner: The bearing.
        count: Number of rolling elements.
        most: Upper bound of the size of each number [m].
    """
    name = "raceway_deviation"
    value = getattr(owner, name)
    if value is None:
        return
    must_be(owner, name, value, is_real(value), "numbers in m", TypeError)
    allowed = (
        f"({count}, 2, 3): of each rolling element, at the outer and the inner raceway,"
        " how far that stands along z and outwards, and how far the contact is raised,"
        " in m"
    )
    of_shape(owner, name, np.shape(value) == (count, 2, 3), allowed)
    finite(owner, name)
    if not is_traced(value):
        check(owner, name, np.abs(value) < most, f"below {most:.6g} m in size")


def check_spacing(owner: Any, count: int, diameter: float) -> None:
    """Raise if the azimuths let rolling elements overlap around the pitch circle.

    Args:
        owner: The bearing, with `azimuth_deviation`.
        count: Number of rolling elements.
        diameter: Diameter of one [m].
    """
    what = "the azimuth of each rolling element less that of even spacing in rad"
    value = check_deviation(owner, "azimuth_deviation", count, what)
    numbers = floats(owner.pitch_diameter)
    if value is None or numbers is None or is_traced(owner.n_elements):
        return
    count = int(owner.n_elements)
    value = value[:count]
    if count < 2:
        return
    least = 2.0 * np.arcsin(min(1.0, diameter / numbers[0]))
    between = 2.0 * np.pi / count + np.roll(value, -1) - value
    allowed = f"such that neighbours stand at least {least:.6g} rad apart"
    check(owner, "azimuth_deviation", between >= least, allowed)

"""Programs for all bearings of a kind: rows with empty places, and results without.

A program is compiled for the number of places of a row. Bearings that differ in their
number of rolling elements share it, if their rows get empty places first; results lose
what is in these.
"""

import dataclasses
import functools
from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ..design.bearing_set import bearings_of, with_bearings
from ..design.checks import is_traced
from ..design.places import (
    element_places,
    has_empty_places,
    with_places,
    without_places,
)
from ..element.bearing_element import BearingElement
from ..element.choices import BallChoices
from ..numerics.labels import axes_of
from ..numerics.types import with_fields
from .solution import Solution


def _counts(element):
    return tuple(row.n_places for row in bearings_of(element.bearing))


def with_empty_places(element: BearingElement) -> BearingElement:
    """Return a bearing with the empty places of its kind, or one that has some already.

    Args:
        element: The bearing; none of its numbers is traced.
    """
    if has_empty_places(element.bearing):
        return element
    return with_fields(element, bearing=with_places(element.bearing))


def of_kind(element: BearingElement) -> BearingElement:
    """Return what a solve takes of a bearing, of the structure of its kind.

    Args:
        element: The bearing; none of its numbers is traced.
    """
    padded = with_empty_places(element)
    # What a catalogue prints of it does not change how it is loaded.
    rows = (with_fields(b, published=None) for b in bearings_of(padded.bearing))
    return with_fields(padded, bearing=with_bearings(padded.bearing, rows))


def points_of_kind(element: BearingElement, points: int) -> int:
    """Return positions along its rolling elements, the same for all balls."""
    return 2 if isinstance(element.choices, BallChoices) else points


def without_empty_places(
    solution: Solution, element: BearingElement | None = None
) -> Any:
    """Return the solution of `with_empty_places(element)` as one of the element.

    Args:
        solution: Solution of one case, not traced.
        element: The bearing as it was given; `None`: that of the solution without its
            empty places.
    """
    if element is None:
        padded = solution.element
        element = with_fields(padded, bearing=without_places(padded.bearing))
    if has_empty_places(element.bearing):
        return with_fields(solution, element=element)
    kept = take_elements(solution, element)
    return with_fields(kept, element=element, row_sizes=_counts(element))


def take_elements(result: Any, element: BearingElement) -> Any:
    """Return a result of places with the arrays of the elements alone.

    Args:
        result: Module or named tuple of one case, not traced.
        element: The bearing, without empty places.
    """
    places, _ = element_places(_counts(element))
    return map_elements(lambda values: values[places], result)


def solution_with_empty_places(solution: Solution) -> Any:
    """Return a solution as that of `with_empty_places` of its element.

    Args:
        solution: Solution of one case, not traced.
    """
    element = solution.element
    if has_empty_places(element.bearing):
        return solution
    places, sizes = element_places(_counts(element))
    spread = partial(spread_elements, places=places, size=sum(sizes))
    found = map_elements(spread, solution)
    return with_fields(found, element=with_empty_places(element), row_sizes=sizes)


def blank_empty_places(solution: Solution, name: str, values: Any) -> Any:
    """Values of a field of a solution, NaN in empty places; traced or not."""
    rows: Any = bearings_of(solution.element.bearing)
    axes = axes_of(solution, name) or ("",)
    if rows[0].filled is None or axes[0] != "element":
        return values
    empty = jnp.concatenate([row.empty_places for row in rows])
    return jnp.where(empty.reshape(-1, *[1] * (values.ndim - 1)), jnp.nan, values)


def spread_elements(values: np.ndarray, places: np.ndarray, size: int) -> np.ndarray:
    """Put values of elements into their places (place, …), zero in empty ones.

    Args:
        values: Of the elements (element, …).
        places: Place of each.
        size: Number of places.
    """
    found = np.zeros((size, *np.shape(values)[1:]), values.dtype)
    found[places] = values
    return found


def map_elements(function: Callable, result: Any) -> Any:
    """Return a result whose arrays of elements are others.

    Args:
        function: Function of such an array in NumPy, whose first axis is the elements.
        result: Module or named tuple of one case, not traced.
    """
    parts, changes = {}, {}
    for name, has_elements in _of_elements(type(result)):
        value: Any = getattr(result, name)
        if has_elements and value is not None:
            parts[name] = map_elements(function, value)
        elif getattr(value, "ndim", 0) > (name == "position"):
            changes[name] = function(value if is_traced(value) else np.asarray(value))
    changes = {**parts, **jax.device_put(changes)}
    if isinstance(result, tuple):
        return result._replace(**changes)  # pyright: ignore
    return with_fields(result, **changes)


@functools.cache
def _of_elements(kind: type) -> list[tuple[str, bool]]:
    """Fields of a class that have an axis of elements, or parts that have one."""
    names = getattr(kind, "_fields", None)
    if names is None:
        names = [field.name for field in dataclasses.fields(kind)]
    found = []
    for name in names:
        axes = axes_of(kind, name) or ()
        if name == "kinematics" or (axes and axes[0] in ("element", "*element")):
            found.append((name, name == "kinematics"))
    return found

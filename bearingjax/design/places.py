"""Rows with more places than rolling elements, so that bearings of a kind are alike.

The number of rolling elements is the length of arrays, for which programs are compiled.
A row may therefore have places that are empty, behind its last element. What is in them
carries nothing, moves nothing and has no results; spacing, ratings and sums are those
of the elements that are there.
"""

import functools
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Int

from ..numerics.types import with_fields
from .abstract import AbstractBearing
from .bearing_set import BearingSet, bearings_of, with_bearings

PLACES = (16, 32, 64, 128)
"""Numbers of places of a row. Larger rows keep the number of their elements."""


def places_for(count: int) -> int:
    """Return the least number of `PLACES` with room for so many rolling elements."""
    return next((size for size in PLACES if size >= count), count)


def with_places(bearing: Any, places: int | None = None) -> Any:
    """Return a bearing whose rows have places for more rolling elements.

    Args:
        bearing: A row or a set, whose numbers may be traced.
        places: Number of places of every row; `None`: `places_for` of its elements.

    Raises:
        ValueError: If it is less than the number of elements of a row.
    """
    return with_bearings(bearing, (_pad_row(b, places) for b in bearings_of(bearing)))


def without_places(bearing: Any) -> Any:
    """Return a bearing without the places that are empty.

    Args:
        bearing: A row or a set; the numbers of elements are not traced.
    """
    return with_bearings(bearing, map(_trim_row, bearings_of(bearing)))


def has_empty_places(bearing: AbstractBearing | BearingSet) -> bool:
    """Whether a row has places that may be empty. Static."""
    return any(row.filled is not None for row in bearings_of(bearing))


@functools.lru_cache(maxsize=512)
def element_places(counts: tuple[int, ...]) -> tuple[np.ndarray, tuple[int, ...]]:
    """Return where the elements of rows are among their places.

    Args:
        counts: Number of elements of each row.

    Returns:
        Indices of the elements (element,); number of places of each row.
    """
    sizes = tuple(map(places_for, counts))
    begins = np.cumsum([0, *sizes[:-1]])
    rows = zip(begins, counts, strict=True)
    return np.concatenate([begin + np.arange(n) for begin, n in rows]), sizes


def _pad_row(row: AbstractBearing, places: int | None) -> AbstractBearing:
    count = row.n_places
    size = places_for(count) if places is None else places
    if size < count:
        raise ValueError(
            f"with_places: `places` is {places}; it must be at least the number of"
            f" rolling elements, {count}."
        )
    filled = _as_count(count) if row.filled is None else row.filled

    def pad(value):
        return jnp.pad(value, ((0, size - count),) + ((0, 0),) * (value.ndim - 1))

    return _resize(row, size, pad, filled)


def _trim_row(row: AbstractBearing) -> AbstractBearing:
    if row.filled is None:
        return row
    count = int(row.filled)
    return _resize(row, count, lambda value: value[:count], None)


def _resize(row, size, function, filled):
    """Return a row of so many places, its arrays of elements by a function."""
    number_of = f"n_{row.noun}s"
    # Of crossed rollers it is the number of both orientations.
    stated = getattr(row, number_of) // row.n_places
    changes: dict[str, Any] = {number_of: size * stated, "filled": filled}
    for name in (f"{row.noun}_deviation", "azimuth_deviation", "raceway_deviation"):
        if (value := getattr(row, name)) is not None:
            changes[name] = function(value)
    return with_fields(row, **changes)


@functools.lru_cache(maxsize=512)
def _as_count(count: int) -> Int[Array, ""]:
    return jax.device_put(np.int32(count))

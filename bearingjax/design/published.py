"""Ratings and axial factors that the publisher of a catalogue prints for a bearing.

A bearing of the catalogue carries them. They hold for its dimensions: once a dimension
on which load ratings depend (`rated_fields` of its class) is another one, the standards
rate the bearing from its geometry, which for improved classes is up to 14 % less.
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..numerics.types import as_real
from ..numerics.units import unit, units
from .checks import is_traced


class PublishedRatings(eqx.Module):
    """Printed ratings and factors of a bearing; 0 where one is not printed.

    Attributes:
        ratings: C, C0 and Pu of the whole bearing, of both rows if they share its rings
            (3,) [N].
        axial_factors: Y1, Y2 of the equivalent dynamic load and Y0 of the static one,
            of a bearing of two rows (3,) [1].
        dimensions: Numbers of its row to which all this belongs, from
            `rated_dimensions` (dimension,) [1, m, rad].

    Traced: all fields.
    """

    ratings: Float[Array, "3"] = eqx.field(converter=as_real, metadata=unit("N"))
    axial_factors: Float[Array, "3"] = eqx.field(converter=as_real, metadata=unit("1"))
    dimensions: Float[Array, " dimension"] = eqx.field(
        converter=as_real, metadata=units("1", "m", "rad")
    )

    def without_ratings(self) -> "PublishedRatings":
        """Return the same without ratings and factors, as if none were printed."""
        zeros = jnp.zeros_like(self.ratings), jnp.zeros_like(self.axial_factors)
        return PublishedRatings(*zeros, self.dimensions)


def rated_dimensions(row: Any) -> Any:
    """Return the numbers of a row on which its load ratings depend, in SI.

    The contact angle is the nominal one, whatever the fits have made of it.
    """
    values = []
    for name in row.rated_fields:
        value = getattr(row, name)
        if name == "contact_angle":
            nominal = getattr(row, "rated_contact_angle", None)
            value = value if nominal is None else nominal
        if name == f"n_{row.noun}s":
            value = row.n_stated
        if value is not None:
            values.append(value)
    xp = jnp if any(map(is_traced, values)) else np
    return xp.stack([xp.asarray(value, dtype=float) for value in values])


def is_as_published(row: Any) -> Any:
    """Whether a row has the dimensions to which its published ratings belong.

    Returns:
        A flag, traced if a number is; `False` if nothing is published.
    """
    if row.published is None:
        return False
    return close(rated_dimensions(row), row.published.dimensions)


def close(one: Any, other: Any) -> Any:
    """Whether two arrays agree to round-off; a traced flag if one is traced.

    Args:
        one, other: Arrays of one shape.
    """
    allowed = max(1e-9, 8.0 * float(jnp.finfo(jnp.result_type(other)).eps))
    if is_traced(one) or is_traced(other):
        return jnp.all(jnp.abs(one - other) <= allowed * jnp.abs(other))
    one, other = np.asarray(one), np.asarray(other)
    return bool(np.all(np.abs(one - other) <= allowed * np.abs(other)))


def with_published(bearing: Any, published: PublishedRatings | None) -> Any:
    """Return a bearing whose rows carry published ratings, or none.

    Args:
        bearing: A row, or a set of such rows.
        published: Ratings and factors, or `None`.
    """
    rows = getattr(bearing, "rows", None)
    several = rows is not None

    def ratings_of(b):
        return [row.bearing.published for row in b.rows] if several else b.published

    new = [published] * len(rows) if rows is not None else published
    return eqx.tree_at(ratings_of, bearing, new, is_leaf=lambda leaf: leaf is None)

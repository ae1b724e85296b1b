"""All rolling elements of a bearing as one row, each with its own freedoms.

Rows of a set differ in position and orientation, three numbers for each element. One
long row costs fewer operations than several.
"""

import dataclasses
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ...design import rows_of
from ...design.form_error import Surfaces
from ...element import BearingElement, Linearised, Row, Speed
from ...element.frame import orbit, rotation
from ...element.row import RowPlacement
from ...numerics.units import unit
from .dynamic_element import dynamic_element


class Untilted(Linearised):
    """Linearised kinematics of rings without tilt, also for self-aligning bearings."""

    @property
    def turns_far(self) -> bool:
        return True


def of_small_motions(element: BearingElement) -> BearingElement:
    """Return the bearing for small motions, of a self-aligning one without tilt.

    Args:
        element: With `Linearised()` or, of a self-aligning bearing, `Finite()`.
    """
    if not element.kinematics.turns_far:
        return element
    choices: Any = element.choices
    choices = dataclasses.replace(choices, kinematics=Untilted())
    return dataclasses.replace(element, choices=choices)


class DynamicRow(NamedTuple):
    """All rolling elements of a bearing.

    Attributes:
        row: Their `DynamicElement`s, the rows of a set one after the other; its ratio
            and pitch radius are those of the first.
        placements: Placement of its row for each element, numbers (element,); `None`:
            the row is the bearing.
        carried: Speed of the orbit; of a set for every element [rad/s].
        own: Speed of the elements about their own axes against the orbit; of a set for
            every element [rad/s].
        surfaces: Contact tracks of each row.
    """

    row: Row
    placements: RowPlacement | None
    carried: Annotated[Any, unit("rad/s")]
    own: Annotated[Any, unit("rad/s")]
    surfaces: tuple[Surfaces, ...]

    @classmethod
    def from_element(cls, element: BearingElement, speed: Speed) -> "DynamicRow":
        """Create the row of a bearing at given ring speeds.

        Args:
            element: The bearing, with linearised kinematics.
            speed: Speed of the rings.

        Raises:
            ValueError: If its rows are of unlike structure.
        """
        rows = element.model().rows
        found = [
            _dynamic_row(row, part.bearing, speed)
            for row, part in zip(rows, rows_of(element.bearing), strict=True)
        ]
        if len(found) == 1 and found[0].row.place is None:
            return found[0]
        counts = [one.row.azimuth.shape[0] for one in found]
        rows = [_per_element(one.row) for one in found]
        kinds = {_structure(row.element) for row in rows}
        if len(kinds) > 1:
            raise ValueError(
                "NoiseModel: `element` has rows of unlike structure (number of"
                " contacts, kind of profile, ribs); noise is of sets of like rows."
            )

        def all_of(numbers):
            return jnp.concatenate(
                [jnp.full((n,), k) for n, k in zip(counts, numbers, strict=True)]
            )

        # Its rows have places: that of a set is never `None`.
        placements = RowPlacement(
            *map(all_of, zip(*(row.place for row in rows), strict=True))
        )
        elements = [row.element for row in rows]
        joined = Row(
            element=jax.tree.map(lambda *parts: jnp.concatenate(parts), *elements),
            azimuth=jnp.concatenate([row.azimuth for row in rows]),
            shift=None,
            ratio=rows[0].ratio,
            pitch_radius=rows[0].pitch_radius,
            place=None,
            spring=None,
            absent=None,
            per_element=True,
        )
        carried, own = (
            all_of([getattr(f, k) for f in found]) for k in cls._fields[2:4]
        )
        surfaces = tuple(s for one in found for s in one.surfaces)
        return cls(joined, placements, carried, own, surfaces)


def of_rows(values: Any, bearing: Any, axis: int = 0) -> list[Any]:
    """Split the values of all elements by row.

    Args:
        values: With an axis element.
        bearing: A single row or a set.
        axis: Axis of the elements in `values`. Static.
    """
    counts = [row.bearing.n_elements for row in rows_of(bearing)]
    cut = jnp if isinstance(values, jax.Array) else np
    return cut.split(values, np.cumsum(counts)[:-1], axis=axis)


def _dynamic_row(row: Row, bearing: Any, speed: Speed) -> DynamicRow:
    """Return one row of elements with inertia."""
    surfaces = Surfaces.from_bearing(bearing)
    rings = speed.outer, speed.inner
    carried = orbit(row.ratio, *rings)
    diameters = 2.0 * surfaces.element.radius, 2.0 * row.pitch_radius
    own = rotation(row.ratio, *diameters, *rings)

    def with_inertia(element):
        return dynamic_element(
            element, bearing.material, row.pitch_radius, speed, carried
        )

    row = eqx.tree_at(lambda r: r.element, row, row.map(with_inertia))
    return DynamicRow(row, None, carried, own, (surfaces,))


def _per_element(row: Row) -> Row:
    """Return the row with a leading axis on its elements."""
    if row.per_element:
        return row
    count = row.azimuth.shape[0]
    element = jax.tree.map(
        lambda a: jnp.broadcast_to(a, (count, *jnp.shape(a))), row.element
    )
    return eqx.tree_at(lambda r: r.element, row, element)


def _structure(element):
    leaves, structure = jax.tree.flatten(element)
    return structure, tuple(jnp.shape(leaf)[1:] for leaf in leaves)

"""Rows whose rolling elements are in equilibrium, and their results."""

from collections.abc import Callable, Iterable
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.expansion import Expansion
from ..numerics.types import Scalar
from ..numerics.units import unit, units
from .azimuth import Azimuth
from .energy import ring_motions
from .equilibrium import ElementStart, LocalState, SolvedElement, element_start
from .frame import placement, section_matrix
from .rolling_element import RingMotion


class SolvedRow(NamedTuple):
    """All rolling elements of a row in equilibrium; leading axis element.

    Attributes:
        rings: Ring motions in the elements' axes (element, r).
        magnitude: Size of the displacements that they come from (element,) [m].
        state: Equilibria.
        energies: Their condensed energies, forces and stiffness.
        travel: Travel of the ring of a spring on its seat, closing the row [m].
        balance: `Result` code of the balance with the spring.
    """

    rings: Float[Array, "element r"]
    magnitude: Annotated[Float[Array, " element"], unit("m")]
    state: LocalState
    energies: Expansion
    travel: Annotated[Any, unit("m")] = ()
    balance: Any = ()

    def map(self, row: Any, function: Callable, rings: Array) -> Any:
        """Apply function(placed, rings, energies) to every rolling element.

        Args:
            row: The `Row`.
            function: Function of one `SolvedElement`, the motions of its rings, and
                its condensed energy.
            rings: `rings`, or the same with derivatives.
        """

        def call(element, rings, state, magnitude, energies):
            return function(SolvedElement(element, state, magnitude), rings, energies)

        return row.map(call, rings, self.state, self.magnitude, self.energies)

    def starts(self, row: Any) -> ElementStart:
        """Starting points for solves at ring freedoms near by, leading axis element."""

        def start(solved_element, rings, energies):
            return element_start(solved_element, rings, energies.aux)

        return self.map(row, start, self.rings)


class RowResults(NamedTuple):
    """A solved row as results see it; differentiable; leading axis element.

    Attributes:
        row: The `Row`.
        local: Ring freedoms in its own axes, its spring's travel included [m, rad].
        azimuth: Azimuths of its elements [rad].
        rings: Ring motions in the elements' axes (element, r) [m, rad].
        x: Own unknowns (element, n) [m].
        contact_load: Load of each contact (element, contact) [N].
        travel: Travel of its spring [m], or `None`.
    """

    row: Any
    local: Annotated[RingMotion, units("m", "rad")]
    azimuth: Annotated[Azimuth, unit("rad")]
    rings: Annotated[Float[Array, "element r"], units("m", "rad")]
    x: Annotated[Float[Array, "element n"], unit("m")]
    contact_load: Annotated[Float[Array, "element contact"], unit("N")]
    travel: Annotated[Scalar | None, unit("m")]

    @property
    def element(self) -> Any:
        """One rolling element; of unlike elements, with a leading axis."""
        return self.row.element

    def map(self, function: Callable, *arrays: Any) -> Any:
        """Apply function(element, rings, x, *arrays) to every rolling element.

        Args:
            function: Function of one element, its `RingMotion` and its own unknowns.
            *arrays: More arguments, with leading axis element.
        """

        def call(element, rings, x, *arrays):
            return function(element, ring_motions(element, rings), x, *arrays)

        return self.row.map(call, self.rings, self.x, *arrays)

    def as_rolling(self, row: Any) -> "RowResults":
        """Return these results with elements that roll at a speed they do not feel.

        Args:
            row: The `Row` at that speed, whose elements may see both rings in place of
                their difference.
        """
        rings = self.rings
        if self.element.sees_difference and not row.element.sees_difference:
            rings = jnp.concatenate([jnp.zeros_like(rings), rings], axis=-1)
        return self._replace(row=row, rings=rings)

    def motions(self) -> Float[Array, "element 3"]:
        """Section motion (u, v, θ) of every element at the node [m, rad]."""
        place = self.row.place

        def element_motion(element, x, azimuth):
            axes = element.axes(azimuth)
            rings = RingMotion(axes @ self.local.outer, axes @ self.local.inner)
            u, v, theta = element.motion(rings, x)
            if place is not None:
                u, theta = place.sign * u, place.sign * theta
                v = v - place.position * theta
            return jnp.stack([u, v, theta])

        return self.row.map(element_motion, self.x, self.azimuth)

    def inertia(self) -> Float[Array, "6"] | None:
        """Inertia load of its elements, at the node [N, N m], or `None`."""
        parts = self.map(lambda element, rings, x: element.inertia(rings, x))
        if parts is None:
            return None
        parts = self.row.where_present(parts)
        section = jax.vmap(section_matrix)(self.azimuth)
        total = jnp.einsum("lai,la->i", section, parts)
        place = self.row.place
        if place is None:
            return total
        return total @ placement(place.position, place.sign)


def inertia_load(rows: Iterable[RowResults]) -> Float[Array, "6"]:
    """Inertia load of all rolling elements, at the node [N, N m].

    The forces that hold both rings add up to minus this.

    Args:
        rows: Solved rows.
    """
    found = [row.inertia() for row in rows]
    parts = [part for part in found if part is not None]
    return sum(parts, start=jnp.zeros((6,)))

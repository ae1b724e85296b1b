"""Interface of a rolling element: its place between two rings, and its energy.

A rolling element gives the coordinates of its contacts, the contact response there,
and from both its energy (`energy.py`). Forces, stiffness, equilibrium and condensation
follow from that and are written once for all rolling elements (`equilibrium.py`).
The start of the search for its equilibrium, and the correction of the steps, are in
`hints.py`.
"""

import abc
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.expansion import Expansion, expand
from ..numerics.types import Reals, Scalar, Vector
from ..numerics.units import units
from .search_hints import SearchHints

Unknowns = Vector


class RingMotion(NamedTuple):
    """Motions of both rings, in the same axes each [m, rad].

    Attributes:
        outer: Motion of the outer ring (h,).
        inner: Motion of the inner ring (h,).
    """

    outer: Annotated[Float[Array, " h"], units("m", "rad")]
    inner: Annotated[Float[Array, " h"], units("m", "rad")]

    @property
    def mean(self) -> Float[Array, " h"]:
        """Mean of both (h,)."""
        return 0.5 * (self.outer + self.inner)

    @property
    def difference(self) -> Float[Array, " h"]:
        """Motion of the inner ring against the outer one (h,)."""
        return self.inner - self.outer


def split_rings(q: Float[Array, " r"]) -> RingMotion:
    """Both rings' halves of their motions, one after the other [m, rad]."""
    half = q.shape[0] // 2
    return RingMotion(q[:half], q[half:])


class AbstractRollingElement(eqx.Module):
    """One rolling element between its rings, a roller or a ball.

    Its own unknowns x (n,) are in metres; ring motions are seen in its own axes.
    """

    n_unknowns: eqx.AbstractClassVar[int]
    """Number of own unknowns, n; zero if its place follows from the rings."""

    @property
    @abc.abstractmethod
    def diameter(self) -> Scalar:
        """Diameter of the rolling element [m]."""

    @property
    def tether(self) -> Reals:
        """Stiffness of the spring that holds an element without contact [N/m].

        Too soft to affect any result; zero for an element without unknowns.
        """
        return jnp.zeros_like(self.diameter)

    @abc.abstractmethod
    def axes(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        """Motion of one ring in the element's axes, from its six freedoms.

        Args:
            azimuth: Azimuth of the rolling element [rad].
        """

    def with_heights(self, heights: Float[Array, "2"]) -> "AbstractRollingElement":
        """Return the element with material added in its contacts, along their normals.

        Args:
            heights: At the outer and the inner raceway [m].

        Raises:
            TypeError: If the class does not say how.
        """
        raise TypeError(
            f"{type(self).__name__} has no method `with_heights`, which"
            " `raceway_deviation` needs."
        )

    @abc.abstractmethod
    def coordinates(self, rings: RingMotion, x: Unknowns) -> Any:
        """Coordinates of the contacts [m], a pytree of arrays (contact, k).

        Args:
            rings: Motions of the rings in the element's axes [m, rad].
            x: Own unknowns (n,) [m].
        """

    @abc.abstractmethod
    def respond(self, coordinates: Any) -> Expansion:
        """Contact response: energies [J], forces [N] and stiffness [N/m].

        Args:
            coordinates: From `coordinates`.

        Returns:
            Expansion whose `aux` is the load of each contact (contact,) [N].
        """

    @abc.abstractmethod
    def energy(
        self, rings: RingMotion, x: Unknowns, contact_response: Expansion | None = None
    ) -> Scalar:
        """Strain energy less the potential of inertia, U - F·y [J].

        Args:
            rings: Motions of the rings in the element's axes [m, rad].
            x: Own unknowns (n,) [m].
            contact_response: `respond` at this place, if available.
        """

    @abc.abstractmethod
    def motion(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"]:
        """(u, v, θ) of the rolling element at the node on the axis [m, m, rad].

        Args:
            rings: Motions of the rings in the element's axes [m, rad].
            x: Own unknowns (n,) [m].
        """

    def inertia(self, rings: RingMotion, x: Unknowns) -> Float[Array, "3"] | None:
        """Inertia force on the rolling element, or `None`.

        Returns:
            Generalised force on (u, v, θ): axial and radial force [N] and moment
            about e_t, turning z towards r, at the node on the axis [N m].
        """
        return None

    def reaction(
        self, rings: RingMotion, x: Unknowns
    ) -> tuple[RingMotion, Unknowns] | None:
        """Generalised force in addition to the gradient of the energy, or `None`.

        For what has no potential, such as gyroscopic moments [N, N m].
        """
        return None

    @property
    def hints(self) -> SearchHints:
        """Hints for the search of its equilibrium."""
        return SearchHints(self)

    @property
    def has_potential(self) -> bool:
        """Whether all forces derive from the energy. Static."""
        return True

    @property
    def is_convex(self) -> bool:
        """Whether that energy is convex. Static."""
        return True

    @property
    def sees_difference(self) -> bool:
        """Whether only the motion between the rings counts. Static.

        The row then solves for that alone: half as many numbers.
        """
        return False

    @property
    def places_itself(self) -> bool:
        """Whether it accounts for the place of its row if rings turn far. Static."""
        return False

    @property
    def n_displacements(self) -> int:
        """Number of displacements, the first motions of a ring. Static."""
        return 2


def contact_energy(
    element: AbstractRollingElement,
    coordinates: Any,
    contact_response: Expansion | None,
) -> Scalar:
    """Energy of all contacts, with force and stiffness as its derivatives [J].

    Args:
        element: The rolling element.
        coordinates: Its `coordinates`.
        contact_response: Its `respond` there, if it is at hand.
    """
    energies = expand(_respond, coordinates, element, contact_response)
    parts = [jnp.sum(energy) for energy in jax.tree.leaves(energies)]
    return sum(parts[1:], start=parts[0])


def _respond(coordinates, element, _):
    return element.respond(coordinates)

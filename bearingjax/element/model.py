"""What the equilibrium asks of one rolling element, roller or ball.

`rings` are the motions of both rings in the element's own axes (r,), or that of the
inner one against the outer one where no more matters; `x` its own unknowns (n,) [m].
All derivatives are with respect to (rings, x), in this order.
"""

import abc
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from ..numerics.linear import dot
from ..numerics.types import Scalar

Rings = Float[Array, " r"]
Unknowns = Float[Array, " n"]


class Derivatives(NamedTuple):
    """Forces of one rolling element and their derivatives.

    Attributes:
        energy: U - F·y, strain energy less the potential of inertia [J]; without
            that part of the inertia that has none.
        gradient: Generalised forces (r + n,), or (n,) on x alone [N, N m]; the
            derivative of the energy, if all forces have a potential.
        hessian: Derivatives of `gradient`, (r + n, r + n) or (n, n) [N/m, N, N m].
        contact_load: Load of each contact (contact,) [N].
    """

    energy: Scalar
    gradient: Float[Array, " m"]
    hessian: Float[Array, "m m"]
    contact_load: Float[Array, " contact"]


class AbstractModel(eqx.Module):
    """One rolling element between its rings."""

    @property
    @abc.abstractmethod
    def guide(self) -> Scalar:
        """Guide spring constant [N/m]."""

    @property
    @abc.abstractmethod
    def diameter(self) -> Scalar:
        """Diameter of the rolling element [m]."""

    @property
    @abc.abstractmethod
    def gap(self) -> Scalar:
        """Size of the gaps, unloaded and centred [m]."""

    n_unknowns: eqx.AbstractClassVar[int]
    """Number of own unknowns, n."""

    @property
    def has_potential(self) -> bool:
        """Whether all forces derive from an energy. Static."""
        return True

    @property
    def is_convex(self) -> bool:
        """Whether that energy is convex. Static."""
        return True

    @property
    def places_itself(self) -> bool:
        """Whether it knows the place of its row, for rings that turn far. Static."""
        return False

    @abc.abstractmethod
    def section(self, azimuth: Scalar) -> Float[Array, "h 6"]:
        """Motion of one ring in the element's axes from its freedoms."""

    @property
    def relative(self) -> bool:
        """Whether `rings` is the motion of the inner ring against the outer one.

        Otherwise of the outer, then of the inner ring. Static.
        """
        return False

    def responses(self, rings: Rings, x: Unknowns) -> Any:
        """What is dear in `derivatives`, to be kept from the last step of a solve.

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
            x: Own unknowns (n,) [m].

        Returns:
            Pytree of arrays; empty if nothing is worth it.
        """
        return ()

    @abc.abstractmethod
    def derivatives(
        self, rings: Rings, x: Unknowns, of_own: bool = False, responses: Any = ()
    ) -> Derivatives:
        """Energy, forces and stiffness of the element.

        All are differentiable; what is not used of them is not computed under `jit`.

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
            x: Own unknowns (n,) [m].
            of_own: Derivatives with respect to x alone, (n,) and (n, n).
            responses: `responses` at this place, if they are known.
        """

    @abc.abstractmethod
    def reach(self, rings: Rings) -> Scalar:
        """How far the rings are from each other in the element's section [m]."""

    def amid(self, rings: Rings) -> Unknowns:
        """Where the rings take the element, and its guide spring holds it (n,) [m].

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
        """
        return jnp.zeros((self.n_unknowns,), rings.dtype)

    def is_open(self, rings: Rings) -> Bool[Array, ""] | None:
        """Whether nothing touches the element `amid` the rings, nor pulls it away.

        It then is at rest there. Cheap, and never true of one that carries load.

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].

        Returns:
            False for NaN; `None` if it cannot be told cheaply. Structure decides.
        """
        return None

    def first(self, rings: Rings) -> Unknowns:
        """Where a search for the equilibrium starts (n,) [m].

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
        """
        return self.amid(rings)

    def thrown_off(self, rings: Rings, x: Unknowns) -> Bool[Array, ""]:
        """Whether inertia has taken the element where nothing real holds it.

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
            x: Own unknowns (n,) [m].
        """
        off = x - self.amid(rings)
        return dot(off, off) > (10.0 * self.diameter) ** 2

    @property
    def may_leave(self) -> bool:
        """Whether `thrown_off` is to be asked. Static."""
        return self.inertia_size() is not None

    @property
    def n_forces(self) -> int:
        """How many of the first of `rings` are displacements. Static."""
        return 2

    @property
    def shapes_steps(self) -> bool:
        """Whether `shape` is worth its time. Static."""
        return False

    def shape(
        self, rings: Rings, x: Unknowns, step: Unknowns, size: Scalar
    ) -> Unknowns:
        """A better step of x, from what is known of the contacts.

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
            x: Own unknowns (n,) [m].
            step: Step of Newton's method (n,) [m].
            size: Of the force out of balance at x [N].
        """
        return step

    @abc.abstractmethod
    def pressed(self, approach: Scalar) -> Scalar:
        """Load of one raceway contact pressed by `approach` [N]."""

    @abc.abstractmethod
    def inertia_size(self) -> Scalar | None:
        """Size of the inertia forces [N], or `None` if there are none."""

    @abc.abstractmethod
    def motion(
        self, rings: Rings, x: Unknowns, outer: Float[Array, "3"]
    ) -> Float[Array, "3"]:
        """(u, v, θ) of the element at the node on the axis [m, m, rad].

        Args:
            rings: Motion of both rings in the element's axes (r,) [m, rad].
            x: Own unknowns (n,) [m].
            outer: (u, v, θ) of the outer ring at the node [m, m, rad].
        """

    @abc.abstractmethod
    def inertia(self, rings: Rings, x: Unknowns) -> Float[Array, "3"] | None:
        """What inertia does to the element, or `None`.

        Returns:
            Generalised force on (u, v, θ): axial and radial force [N] and moment
            about e_t, turning z towards r, at the node on the axis [N m].
        """

"""Hints for the search of a rolling element's equilibrium; they contain no physics.

The defaults give the correct equilibrium; an element's own hints find it in fewer
steps, or show without any step that it is open.
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from ..numerics.compiled import batched_loop
from ..numerics.linear import dot
from ..numerics.types import Number, Scalar, Vector


class SearchHints(eqx.Module):
    """Hints for the search of one rolling element's own unknowns.

    In all of them `rings` are the motions of both rings in the element's axes, and `x`
    its own unknowns (n,) [m].

    Attributes:
        element: The rolling element.
    """

    element: Any

    @property
    def gap(self) -> Scalar:
        """Size of the gaps, unloaded and centred [m]."""
        return jnp.zeros_like(self.element.diameter)

    def reach(self, rings: Any) -> Scalar:
        """Relative displacement of the rings in the element's section [m]."""
        return jnp.sum(jnp.abs(rings.difference[: self.element.n_displacements]))

    @property
    def spread(self) -> Number:
        """Displacements from which contact coordinates are differences, over those of
        the element [1]: contact coordinates round by as much more."""
        return 1.0

    def approximate_load(self, approach: Scalar) -> Scalar:
        """Approximate load of one raceway contact pressed by `approach` [N].

        From this size on, contacts are pressed by more than the play between the rings.
        Zero: not known, and a load solve then does without (`statics.load`).
        """
        return jnp.zeros_like(approach)

    def inertia_scale(self) -> Scalar | None:
        """Size of the inertia forces [N], or `None` if there are none."""
        return None

    def midpoint(self, rings: Any) -> Vector:
        """Position given by the rings, where the tether holds the element (n,) [m]."""
        return jnp.zeros((self.element.n_unknowns,), rings.outer.dtype)

    def is_open(self, rings: Any) -> Bool[Array, ""] | None:
        """Whether the element is free of contact and pull at its midpoint.

        It is then at rest there. Cheap, and never true of one that carries load.

        Returns:
            False for NaN; `None` if no cheap test exists, which the structure decides.
        """
        return None

    def start(self, rings: Any) -> Vector:
        """Start of the search for the equilibrium (n,) [m]."""
        return self.midpoint(rings)

    def at_rest(self, rings: Any) -> tuple[Vector, Bool[Array, ""]] | None:
        """Place where inertia lays the element in one ring, if the other one is apart.

        It is then the equilibrium but for round-off, and the search starts there,
        wherever the element was before.

        Returns:
            The place (n,) [m], and whether the other ring is apart from it; `None`
            without inertia.
        """
        return None

    @property
    def keeps_response(self) -> bool:
        """Whether the contact response is kept from the last step. Static.

        Useful where the response costs more to compute than to store.
        """
        return True

    @property
    def slots(self) -> tuple[int, int]:
        """Number of elements of a batch solved at a time, and number of them that may
        be finished before others follow (`batched_loop.run`). Static.

        Larger where a step costs little compared with its overhead.
        """
        return batched_loop.SLOTS, batched_loop.IDLE

    @property
    def corrects_steps(self) -> bool:
        """Whether `correct_step` saves time. Static."""
        return False

    def correct_step(self, rings: Any, x: Vector, step: Vector, size: Scalar) -> Vector:
        """Improve a step of x, from the known state of the contacts.

        Args:
            rings, x: Start of the step.
            step: Step of Newton's method (n,) [m].
            size: Size of the force out of balance at x [N].
        """
        return step

    def passed_load(self, load: Float[Array, "*element contact"]) -> Any:
        """Load that elements pass from ring to ring (…,) [N]; `None`: not known.

        Args:
            load: Load of their contacts [N].
        """
        return None

    @property
    def may_be_ejected(self) -> bool:
        """Whether `is_ejected` needs to be evaluated. Static."""
        return self.inertia_scale() is not None

    def is_ejected(self, rings: Any, x: Vector) -> Bool[Array, ""]:
        """Whether inertia has moved the element to where no contact can hold it."""
        off = x - self.midpoint(rings)
        return dot(off, off) > (10.0 * self.element.diameter) ** 2

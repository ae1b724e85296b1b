"""Equations of like bodies that are coupled only through shared unknowns.

The Jacobian of bodies and shared unknowns is an arrow: a small block for every body,
and a border. Its blocks are found and factorised side by side. Sums, such as work,
follow the motion and act on nothing; unknowns without mass are balanced at every time.
"""

import abc
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.lapack import solve_any
from ..numerics.linear import solve
from ..numerics.types import Scalar


class CoupledState(NamedTuple):
    """State of a system, or its time derivative.

    Attributes:
        own: Unknowns of the bodies (body, k).
        shared: Shared ones (m,).
        sums: Integrals along the motion (w,).
    """

    own: Float[Array, "body k"]
    shared: Float[Array, " m"]
    sums: Float[Array, " w"]


class Masses(NamedTuple):
    """Masses: 1, or 0 for an unknown in equilibrium at every time.

    Attributes:
        own: Masses of the unknowns of a body (k,).
        shared: Masses of the shared unknowns (m,).
    """

    own: Float[Array, " k"]
    shared: Float[Array, " m"]

    def times(self, change: CoupledState) -> CoupledState:
        """Return M x of a change x; sums have the mass 1."""
        own = self.own[None, :] * change.own
        return CoupledState(own, self.shared * change.shared, change.sums)


class AbstractSystem(eqx.Module):
    """Like bodies with shared unknowns, passed as Diffrax's `args`."""

    @abc.abstractmethod
    def body(
        self,
        which: Any,
        time: Scalar,
        own: Float[Array, " k"],
        shared: Float[Array, " m"],
    ) -> tuple[Float[Array, " k"], Float[Array, " m"], Float[Array, " w"]]:
        """Return rates of one body (k,) and its contributions to those of the shared
        unknowns (m,) and to the sums (w,).

        Args:
            which: The body: a slice of `bodies`.
            time: Time [s].
            own: Its unknowns.
            shared: The shared ones.
        """

    @abc.abstractmethod
    def shared_rates(
        self, time: Scalar, shared: Float[Array, " m"]
    ) -> tuple[Float[Array, " m"], Float[Array, " w"]]:
        """Return contributions to shared rates and sums that come from no body."""

    @property
    @abc.abstractmethod
    def bodies(self) -> Any:
        """Data that differ between bodies, leading axis body."""

    @property
    @abc.abstractmethod
    def masses(self) -> "Masses":
        """Masses of all unknowns."""

    def rates(self, time: Scalar, state: CoupledState) -> CoupledState:
        """Return all rates; for an unknown without mass, its residual."""
        rates, shared, sums = jax.vmap(self.body, (0, None, 0, None))(
            self.bodies, time, state.own, state.shared
        )
        of_shared, of_sums = self.shared_rates(time, state.shared)
        return CoupledState(
            rates, of_shared + jnp.sum(shared, axis=0), of_sums + jnp.sum(sums, axis=0)
        )

    def slopes(self, time: Scalar, state: CoupledState) -> "Slopes":
        """Return the Jacobian of `rates` in blocks."""
        k, m = state.own.shape[1], state.shared.shape[0]

        def of_body(unknowns, which):
            own, shared, time = jnp.split(unknowns, [k, k + m])
            return jnp.concatenate(self.body(which, time[0], own, shared))

        def of_rest(unknowns):
            return jnp.concatenate(self.shared_rates(unknowns[-1], unknowns[:-1]))

        common = jnp.append(state.shared, time)
        whole = jax.vmap(lambda own: jnp.concatenate([own, common]))(state.own)
        body = jax.vmap(jax.jacfwd(of_body))(whole, self.bodies)
        rest = jnp.sum(body[:, k:, k:], axis=0) + jax.jacfwd(of_rest)(common)
        return Slopes(
            body[:, :k, :k],
            body[:, :k, k:-1],
            body[:, k:, :k],
            rest[:, :m],
            CoupledState(body[:, :k, -1], rest[:m, m], rest[m:, m]),
        )


class Slopes(NamedTuple):
    """Derivatives of rates.

    Attributes:
        own: Derivative of the bodies' rates by their own unknowns (body, k, k).
        across: Derivative of the bodies' rates by the shared unknowns (body, k, m).
        down: Derivative of shared rates and sums by own unknowns (body, m + w, k).
        shared: Derivative of shared rates and sums by the shared unknowns (m + w, m).
        time: Derivative of all rates by time.
    """

    own: Float[Array, "body k k"]
    across: Float[Array, "body k m"]
    down: Float[Array, "body row k"]
    shared: Float[Array, "row m"]
    time: CoupledState

    def solver(
        self, masses: Masses, scale: Scalar
    ) -> Callable[[CoupledState], CoupledState]:
        """Function that solves (M scale - J) x = right for x.

        Args:
            masses: Masses of the unknowns.
            scale: Factor of the masses [1/s].
        """
        m = masses.shared.shape[0]
        own = jax.vmap(_inverse)(jnp.diag(masses.own * scale)[None] - self.own)
        follow = jax.vmap(_product)(own, self.across)
        border = jnp.sum(jax.vmap(_product)(self.down[:, :m], follow), axis=0)
        shared = _inverse(jnp.diag(masses.shared * scale) - self.shared[:m] - border)

        def solve(right):
            alone = jax.vmap(_times)(own, right.own)
            pulls = jax.vmap(_times)(self.down[:, :m], alone)
            of_shared = _times(shared, right.shared + jnp.sum(pulls, axis=0))
            of_own = alone + jax.vmap(_times, (0, None))(follow, of_shared)
            sums = jnp.sum(jax.vmap(_times)(self.down[:, m:], of_own), axis=0)
            sums = right.sums + sums + _times(self.shared[m:], of_shared)
            return CoupledState(of_own, of_shared, sums / scale)

        return solve


_WRITTEN_OUT = 5
"""Most unknowns for which explicit elimination is faster than LAPACK."""


def _inverse(matrix):
    """Invert without pivoting: friction makes the matrix diagonally dominant."""
    n = matrix.shape[0]
    if n > _WRITTEN_OUT:
        return solve_any(matrix, jnp.eye(n, dtype=matrix.dtype))
    return solve(matrix, jnp.eye(n, dtype=matrix.dtype), False)


def _times(matrix, vector):
    """Return the product as a sum, which XLA fuses."""
    return jnp.sum(matrix * vector[None, :], axis=1)


def _product(a, b):
    return jnp.sum(a[:, :, None] * b[None, :, :], axis=1)

"""Periodic orbits by shooting: the state after a period equals the initial one.

Source: Filipkovskii & Belomyttsev (2014), eqs. (6), (7), (10) to (12), (14).
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.types import Scalar, Vector, as_count
from .flow import flow_slopes, integrate
from .method import AbstractMethod, Jacobian, Motion, Unknowns
from .system import AbstractVibratingSystem


class Shooting(AbstractMethod):
    """Unknowns are the state at phase 0; the monodromy matrix is a by-product.

    A vibration that the steps do not resolve, as the fast modes of a shaft, follows
    the forces on it like a spring and counts as damped: its multipliers are near 0.

    Attributes:
        steps: Steps of the integration per period, and samples of the orbit. Three per
            period of a natural vibration leave 1e-6 of it, ten 1e-11 [1].
    """

    steps: int = eqx.field(static=True, converter=as_count, default=48)

    def unknowns(self, motion: Motion) -> Unknowns:
        return jnp.concatenate([motion[0][0], motion[1][0]])

    def state(self, z: Unknowns) -> tuple[Vector, Vector]:
        u, rate = jnp.split(z, 2)
        return u, rate

    def residual(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Unknowns:
        return integrate(system, z, ratio, self.steps)[0] - z

    def linearise(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> tuple[Unknowns, Jacobian, Any]:
        end, jacobian = flow_slopes(system, z, ratio, self.steps)
        return end - z, jacobian - jnp.eye(*jacobian.shape, dtype=z.dtype), ()

    def motion(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Motion:
        _, states = integrate(system, z, ratio, self.steps)
        u, rate = jnp.split(states, 2, axis=1)
        return u, rate

    def monodromy(
        self,
        system: AbstractVibratingSystem,
        ratio: Scalar,
        jacobian: Jacobian,
        slopes: Any,
    ) -> Float[Array, "state state"]:
        return jacobian[:, :-1] + jnp.eye(jacobian.shape[0], dtype=jacobian.dtype)

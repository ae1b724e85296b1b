"""Periodic orbits by shooting: the state after a period is that at its beginning.

Source: Filipkovskii & Belomyttsev (2014), eqs. (6), (7), (10) to (12), (14).
"""

import equinox as eqx
import jax
import jax.numpy as jnp

from ...numerics.types import as_count
from .flow import integrate
from .method import AbstractMethod
from .system import rates


class Shooting(AbstractMethod):
    """Unknowns are the state at phase 0; the monodromy matrix is a by-product.

    Derivatives of the flow are forward sensitivities, integrated with the state.

    Attributes:
        steps: Steps of the integration per period, and samples of the orbit. Ten per
            period of the fastest natural vibration leave 1e-8 [1].
    """

    steps: int = eqx.field(static=True, converter=as_count, default=48)

    def unknowns(self, motion):
        return jnp.concatenate([motion[0][0], motion[1][0]])

    def state(self, z):
        u, rate = jnp.split(z, 2)
        return u, rate

    def _flow(self, system, z, ratio):
        return integrate(rates(system, ratio), z, self.steps)

    def residual(self, system, z, ratio):
        return self._flow(system, z, ratio)[0] - z

    def linearised(self, system, z, ratio):
        def both(x):
            left = self.residual(system, x[:-1], x[-1])
            return left, left

        jacobian, left = jax.jacfwd(both, has_aux=True)(jnp.append(z, ratio))
        return left, jacobian

    def motion(self, system, z, ratio):
        _, states = self._flow(system, z, ratio)
        u, rate = jnp.split(states, 2, axis=1)
        return u, rate

    def monodromy(self, system, z, ratio, jacobian):
        return jacobian[:, :-1] + jnp.eye(z.shape[0], dtype=z.dtype)

    def flow_error(self, system, z, ratio):
        """Error of the state after a period, measured with twice the steps [1]."""
        fine = Shooting(2 * self.steps)
        change = fine.residual(system, z, ratio) - self.residual(system, z, ratio)
        return jnp.max(jnp.abs(change))

"""Support with stiffness as a polynomial of the rotor speed."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ..design.checks import of_shape, positive
from ..numerics.types import Number, Real, Scalar, as_count, as_real
from ..numerics.units import real, unit
from .parts import (
    DAMPING_UNITS,
    STIFFNESS_UNITS,
    AbstractSupport,
    Five,
    Housing,
    check_support,
    square_matrix,
)


class SpeedSupport(AbstractSupport):
    """Springs with speed-dependent stiffness, and dampers.

    Attributes:
        station: Number of the supported station.
        stiffness: Coefficients of Chebyshev's polynomials between rest and `top_speed`
            (order, 5, 5) [N/m, N, N m]. Above it stays what it is there; it is the same
            for both senses of turning.
        damping: As in `LinearSupport` [N s/m, N s, N m s].
        top_speed: Speed up to which it is known [rad/s].
        housing: Its housing; `None`: ground.

    Traced: all but `station`.
    """

    station: int = eqx.field(static=True, converter=as_count)
    stiffness: Float[Array, "order 5 5"] = eqx.field(
        converter=as_real, metadata=unit(STIFFNESS_UNITS)
    )
    damping: Float[Array, "5 5"] = eqx.field(
        converter=square_matrix, metadata=unit(DAMPING_UNITS)
    )
    top_speed: Real = eqx.field(**real("rad/s"))
    housing: Housing | None = eqx.field(default=None, kw_only=True)

    def __check_init__(self):
        check_support(self)
        positive(self, "top_speed")
        shape = np.shape(self.stiffness)
        fits = len(shape) == 3 and shape[1:] == (5, 5) and shape[0] > 0
        of_shape(self, "stiffness", fits, "(order, 5, 5)")

    def force(
        self, motion: Five, velocity: Five, speed: Scalar, angle: Number = 0.0
    ) -> Five:
        """Return `AbstractSupport.force` without the load at rest [N, N m]."""
        share = jnp.minimum(2.0 * jnp.abs(speed) / self.top_speed - 1.0, 1.0)

        # Clenshaw's rule. As a loop, for XLA's compiler for CPUs (jaxlib 0.10.1) makes
        # wrong slopes of the recurrence written out, when it is mapped over speeds.
        def add(sums, coefficients):
            last, before = sums
            return (coefficients + 2.0 * share * last - before, last), None

        nothing = jnp.zeros_like(self.stiffness[0])
        (last, before), _ = lax.scan(
            add, (nothing, nothing), self.stiffness[1:], reverse=True
        )
        stiffness = self.stiffness[0] + share * last - before
        return stiffness @ motion + self.damping @ velocity


def chebyshev_analysis(places: int) -> np.ndarray:
    """Return the matrix from values at roots to Chebyshev coefficients (order, place).

    The roots are those of the first polynomial left out, rising.

    Args:
        places: Number of roots.
    """
    angle = np.pi * (np.arange(places)[::-1] + 0.5) / places
    weight = np.full(places, 2.0 / places)
    weight[0] = 1.0 / places
    return weight[:, None] * np.cos(np.arange(places)[:, None] * angle)

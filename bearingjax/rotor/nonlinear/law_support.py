"""Support of a shaft station by the law of a preloaded ball bearing."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...design.checks import instance
from ...numerics.types import Number, Scalar, as_count, as_real
from ...numerics.units import unit
from ..parts import (
    DAMPING_UNITS,
    AbstractSupport,
    Five,
    Housing,
    check_support,
    square_matrix,
)
from .support_law import AbstractSupportLaw


class LawSupport(AbstractSupport):
    """A support with the force of a law; it does not resist tilting.

    Attributes:
        station: Number of the supported station.
        law: `FixedAngle`, `CubicExpansion` or `MovingAngle`.
        damping: Against ground or housing (5, 5), or its diagonal (5,) [N s/m, N s,
            N m s].
        housing: Its housing; `None`: ground.
        turned: Whether +z relieves it instead of adding to its preload, as for the
            other bearing of an opposed pair. The position of its balls is unchanged.

    Traced: law, damping, housing. Static: station, turned.
    """

    station: int = eqx.field(static=True, converter=as_count)
    law: AbstractSupportLaw
    damping: Float[Array, "5 5"] = eqx.field(
        converter=square_matrix, metadata=unit(DAMPING_UNITS), default=(0.0,) * 5
    )
    housing: Housing | None = eqx.field(default=None, kw_only=True)
    turned: bool = eqx.field(static=True, default=False, kw_only=True)

    def __check_init__(self):
        check_support(self)
        instance(self, "law", AbstractSupportLaw)
        instance(self, "turned", bool)

    def force(
        self, motion: Five, velocity: Five, speed: Scalar, angle: Number = 0.0
    ) -> Five:
        """Return `AbstractSupport.force` [N, N m]; the balls do not orbit."""
        side = as_real((1.0, 1.0, -1.0 if self.turned else 1.0)).astype(motion.dtype)
        held = side * self.law.force(side * motion[:3])
        return jnp.append(held, jnp.zeros_like(held[:2])) + self.damping @ velocity

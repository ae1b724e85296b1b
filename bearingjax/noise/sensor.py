"""Sensor that holds the moving ring of a noise rig in addition to the bearing."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check, is_traced, non_negative, of_shape
from ..numerics.types import Real, as_real
from ..numerics.units import real, unit


class Sensor(eqx.Module):
    """Spring and dashpot between the moving ring and ground along a line.

    The spring is set when the bearing is loaded: it carries no part of the load.

    Attributes:
        stiffness: [N/m].
        damping: [N s/m].
        direction: Direction of the line (x, y, z), of any length (3,) [1].

    Traced: all fields.
    """

    stiffness: Real = eqx.field(
        **real("N/m", "stiffness of the sensor that holds the moving ring")
    )
    damping: Real = eqx.field(**real("N s/m", "damping of the sensor"), default=0.0)
    direction: Float[Array, "3"] = eqx.field(
        converter=as_real, metadata=unit("1"), default=(0.0, 1.0, 0.0)
    )

    def __check_init__(self):
        non_negative(self, "stiffness")
        non_negative(self, "damping")
        fits = np.shape(self.direction) == (3,)
        of_shape(self, "direction", fits, "(3,): (x, y, z)")
        if not is_traced(self.direction):
            some = np.any(np.asarray(self.direction) != 0.0)
            check(self, "direction", some, "another than (0, 0, 0)")

    @property
    def projector(self) -> Float[Array, "3 3"]:
        """d dᵀ of the unit vector along the line."""
        d = self.direction
        return jnp.outer(d, d) / jnp.sum(d * d)

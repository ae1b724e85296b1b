"""Speeds of the rings over time."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design.checks import real_numbers
from ..element.inertia import Speed
from ..numerics.types import Number, Scalar, as_real
from ..numerics.units import unit
from .ring_load import rising_and_finite


class SpeedTable(eqx.Module):
    """Speeds of the rings, linear between given times and constant beyond them.

    Attributes:
        time: Times, rising (knot,) [s].
        inner: Speed of the inner ring (knot,) [rad/s].
        outer: Speed of the outer ring (knot,) [rad/s].

    Traced: all fields.
    """

    time: Float[Array, " knot"] = eqx.field(converter=as_real, metadata=unit("s"))
    inner: Float[Array, " knot"] = eqx.field(converter=as_real, metadata=unit("rad/s"))
    outer: Float[Array, " knot"] = eqx.field(converter=as_real, metadata=unit("rad/s"))

    def __init__(self, time, inner, outer=None):
        """Create from the attributes; without `outer` the outer ring is at rest."""
        self.time, self.inner = as_real(time), as_real(inner)
        self.outer = jnp.zeros_like(self.inner) if outer is None else as_real(outer)

    def __check_init__(self):
        for name in ("time", "inner", "outer"):
            real_numbers("SpeedTable", name, getattr(self, name), "a row of numbers")
            shape, wanted = getattr(self, name).shape, self.time.shape
            if shape != wanted or len(shape) != 1 or not wanted[0]:
                raise ValueError(
                    f"SpeedTable: `{name}` has the shape {shape}; all three must be"
                    " rows of the same length, at least 1."
                )
        rising_and_finite(self, self.time, ("time", "inner", "outer"))

    def at(self, time: Scalar) -> Speed:
        """Return the speeds at a time [s]."""
        return Speed(
            inner=jnp.interp(time, self.time, self.inner),
            outer=jnp.interp(time, self.time, self.outer),
        )


def ramp(duration: Number, end: Speed, start: Speed | None = None) -> SpeedTable:
    """Create a table with a linear ramp between two speeds, then constant.

    Args:
        duration: Duration of the change [s].
        end: Speeds after it.
        start: Speeds before; default: standstill.
    """
    start = Speed() if start is None else start
    return SpeedTable(
        jnp.stack([jnp.zeros_like(as_real(duration)), as_real(duration)]),
        jnp.stack([start.inner, end.inner]),
        jnp.stack([start.outer, end.outer]),
    )


def as_table(speed: Speed | SpeedTable) -> SpeedTable:
    """Return a speed table, also for a constant speed."""
    if isinstance(speed, SpeedTable):
        return speed
    return SpeedTable(jnp.zeros(1), speed.inner[None], speed.outer[None])

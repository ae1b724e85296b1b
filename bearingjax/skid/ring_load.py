"""Loads on the ring over time."""

from collections.abc import Iterable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check, is_traced, number, real_numbers
from ..numerics.types import Real, Scalar, as_real
from ..numerics.units import real, unit

_LOADS = unit(("N", "N", "N", "N m", "N m", "N m"))


class LoadHistory(eqx.Module):
    """Load on the moving ring, linear between given times and constant beyond them.

    Attributes:
        time: Times, rising (knot,) [s].
        load: (Fx, Fy, Fz, Mx, My, Mz) at these times (knot, 6) [N, N m].

    Traced: all fields.
    """

    time: Float[Array, " knot"] = eqx.field(converter=as_real, metadata=unit("s"))
    load: Float[Array, "knot 6"] = eqx.field(converter=as_real, metadata=_LOADS)

    def __check_init__(self):
        for name in ("time", "load"):
            real_numbers(
                "LoadHistory", name, getattr(self, name), "an array of numbers"
            )
        count = self.time.shape[0] if self.time.ndim == 1 else 0
        if not count or self.load.shape != (count, 6):
            raise ValueError(
                f"LoadHistory: `time` has the shape {self.time.shape} and `load`"
                f" {self.load.shape}; they must be (n,) and (n, 6), n at least 1."
            )
        rising_and_finite(self, self.time, ("time", "load"))

    def __call__(self, time: Scalar) -> Float[Array, "6"]:
        """Load at a time [s]."""
        return jnp.stack([jnp.interp(time, self.time, f) for f in self.load.T])


class SinusoidalLoad(eqx.Module):
    """Load on the moving ring: mean + amplitude sin(speed t + phase).

    Attributes:
        mean: (Fx, Fy, Fz, Mx, My, Mz) (6,) [N, N m].
        amplitude: Amplitude of each (6,) [N, N m].
        speed: Angular frequency [rad/s].
        phase: At time zero [rad].

    Traced: all fields.
    """

    mean: Float[Array, "6"] = eqx.field(converter=as_real, metadata=_LOADS)
    amplitude: Float[Array, "6"] = eqx.field(converter=as_real, metadata=_LOADS)
    speed: Real = eqx.field(**real("rad/s", "angular frequency of the sine"))
    phase: Real = eqx.field(**real("rad", "phase of the sine"), default=0.0)

    def __check_init__(self):
        for name in ("mean", "amplitude"):
            real_numbers("SinusoidalLoad", name, getattr(self, name), "six numbers")
            if getattr(self, name).shape != (6,):
                raise ValueError(
                    f"SinusoidalLoad: `{name}` has the shape"
                    f" {getattr(self, name).shape}; it must be (6,)."
                )
        number(self, "speed")
        number(self, "phase")

    def __call__(self, time: Scalar) -> Float[Array, "6"]:
        """Load at a time [s]."""
        return self.mean + self.amplitude * jnp.sin(self.speed * time + self.phase)


def rising_and_finite(
    self: Any, time: Float[Array, " knot"], names: Iterable[str]
) -> None:
    """Check a table over time.

    Args:
        self: The table.
        time: Its times [s].
        names: Names of its fields that must be finite.

    Raises:
        ValueError: For times that do not rise, or numbers that are not finite.
    """
    for name in names:
        if not is_traced(getattr(self, name)):
            finite = np.all(np.isfinite(getattr(self, name)))
            check(self, name, finite, "finite throughout")
    if not is_traced(time):
        rising = np.all(np.diff(np.asarray(time)) > 0)
        check(self, "time", rising, "rising from each to the next")

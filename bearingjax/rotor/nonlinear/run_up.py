"""Frequency and phase of an excitation over time."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...design.checks import check, is_traced, non_negative, real_numbers
from ...numerics.types import Number, Scalar, as_real
from ...numerics.units import unit
from ...skid.ring_load import rising_and_finite


class ExcitationState(NamedTuple):
    """State of an excitation.

    Attributes:
        phase: φ [rad].
        frequency: ω [rad/s].
        acceleration: α [rad/s²].
    """

    phase: Annotated[Scalar, unit("rad")]
    frequency: Annotated[Scalar, unit("rad/s")]
    acceleration: Annotated[Scalar, unit("rad/s²")]


class FrequencyTable(eqx.Module):
    """Frequency of an excitation, linear between given times and constant beyond them.

    Attributes:
        time: Times, rising (knot,) [s].
        frequency: At them, not below zero (knot,) [rad/s].

    Traced: all fields.
    """

    time: Float[Array, " knot"] = eqx.field(converter=as_real, metadata=unit("s"))
    frequency: Float[Array, " knot"] = eqx.field(
        converter=as_real, metadata=unit("rad/s")
    )

    def __check_init__(self):
        for name in ("time", "frequency"):
            value = getattr(self, name)
            real_numbers("FrequencyTable", name, value, "a row of numbers")
            if value.shape != self.time.shape or value.ndim != 1 or not value.size:
                raise ValueError(
                    f"FrequencyTable: `{name}` has the shape {value.shape}; both must"
                    " be rows of the same length, at least 1."
                )
        rising_and_finite(self, self.time, ("time", "frequency"))
        if not is_traced(self.frequency):
            check(self, "frequency", self.frequency >= 0, "zero or above throughout")

    def _pieces(self):
        """Return start, phase, frequency and acceleration of every piece (knot + 1,).

        Phases count from the first knot; the first piece lies before it.
        """
        time, frequency = self.time, self.frequency
        span, mean = jnp.diff(time), 0.5 * (frequency[1:] + frequency[:-1])
        none = jnp.zeros_like(time[:1])
        slope = jnp.concatenate([none, jnp.diff(frequency) / span, none])
        phase = jnp.concatenate([none, none, jnp.cumsum(mean * span)])
        begin = jnp.concatenate([time[:1], time])
        return begin, phase, jnp.concatenate([frequency[:1], frequency]), slope

    def _from_first(self, time):
        begin, phase, frequency, slope = self._pieces()
        k = jnp.searchsorted(self.time, time, side="right")
        t = time - begin[k]
        turned = phase[k] + (frequency[k] + 0.5 * slope[k] * t) * t
        return ExcitationState(turned, frequency[k] + slope[k] * t, slope[k])

    def at(self, time: Scalar) -> ExcitationState:
        """Return phase since time zero, frequency and acceleration.

        Args:
            time: [s].
        """
        here, first = self._from_first(time), self._from_first(jnp.zeros_like(time))
        return here._replace(phase=here.phase - first.phase)

    def time_at(self, phase: Scalar) -> Scalar:
        """Return the time at which a phase is reached [s]; infinite if never.

        Args:
            phase: Since time zero, not below zero [rad].
        """
        begin, start, frequency, slope = self._pieces()
        wanted = phase + self._from_first(jnp.zeros_like(phase)).phase
        k = jnp.searchsorted(start[1:], wanted, side="right")
        left = wanted - start[k]
        square = jnp.maximum(frequency[k] ** 2 + 2.0 * slope[k] * left, 0.0)
        # From rest the derivative at phase zero does not exist: none is taken there.
        still = square == 0
        root = jnp.where(still, 0.0, jnp.sqrt(jnp.where(still, 1.0, square)))
        below = frequency[k] + root
        stuck = below == 0
        later = 2.0 * left / jnp.where(stuck, 1.0, below)
        never = jnp.where(left == 0, 0.0, jnp.inf)
        return begin[k] + jnp.where(stuck, never, later)


def as_frequency_table(
    owner: str,
    frequency: Any,
    duration: Number | None = None,
    end_frequency: Number | None = None,
) -> FrequencyTable:
    """Return a table, also for a constant frequency or a linear change.

    Args:
        owner: Function that was called.
        frequency: Frequency of the excitation [rad/s], or a table.
        duration: [s].
        end_frequency: At its end [rad/s]; `None`: as at its beginning.
    """
    if isinstance(frequency, FrequencyTable):
        if end_frequency is not None:
            raise ValueError(
                f"{owner}: `end_frequency` is given; a FrequencyTable says how the"
                " frequency ends."
            )
        return frequency
    non_negative(owner, "frequency", frequency, "rad/s")
    begin = as_real(frequency)
    if end_frequency is None:
        return FrequencyTable(jnp.zeros_like(begin)[None], begin[None])
    non_negative(owner, "end_frequency", end_frequency, "rad/s")
    ends = jnp.stack([begin, as_real(end_frequency)])
    return FrequencyTable(jnp.stack([jnp.zeros_like(begin), as_real(duration)]), ends)

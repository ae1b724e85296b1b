"""Motion of masses in even steps of time.

Runge's and Kutta's classical method of order 4. A batch of systems takes the same
steps, and a record of even samples needs no interpolation.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from ..numerics.types import Scalar

_SHARES = 0.0, 0.5, 0.5, 1.0
_WEIGHTS = 1 / 6, 1 / 3, 1 / 3, 1 / 6

Vector = Float[Array, " n"]


class Stepped(NamedTuple):
    """A motion in even samples.

    Attributes:
        motion: (sample, n) [m, rad].
        acceleration: What was kept of it; leading axis sample.
        end: Motion and velocity after the last sample.
    """

    motion: Float[Array, "sample n"]
    acceleration: Any
    end: tuple[Vector, Vector]


def stepped(
    acceleration: Callable[[Vector, Vector, Scalar], Vector],
    start: tuple[Vector, Vector],
    step: Scalar,
    steps: int,
    samples: int,
    kept: Callable[[Vector], Any] = lambda acceleration: acceleration,
) -> Stepped:
    """A motion from time zero on.

    Args:
        acceleration: (motion, velocity, time) -> (n,).
        start: Motion and velocity at time zero (n,).
        step: Of the integration [s].
        steps: Per sample. Static.
        samples: Their number. Static.
        kept: What is kept of the acceleration of every sample.

    Returns:
        The motion; the first sample is the start.

    Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993),
        II.1.
    """
    zero = jnp.zeros_like(start[0])
    dtype = zero.dtype
    stages = jnp.asarray(_SHARES, dtype), jnp.asarray(_WEIGHTS, dtype)

    def stage(carry, given):
        """One of the four evaluations of a step."""
        begin, velocity, rate, sum_v, sum_a, time = carry
        share, weight = given
        motion = begin[0] + share * step * velocity
        velocity = begin[1] + share * step * rate
        rate = acceleration(motion, velocity, time + share * step)
        sum_v, sum_a = sum_v + weight * velocity, sum_a + weight * rate
        return (begin, velocity, rate, sum_v, sum_a, time), kept(rate)

    def one(state, number):
        begin = state, zero, zero, zero, zero, step * number
        (_, _, _, v, a, _), seen = lax.scan(stage, begin, stages)
        first = jax.tree.map(lambda x: x[0], seen)
        return (state[0] + step * v, state[1] + step * a), first

    @jax.checkpoint
    def sample(state, number):
        numbers = steps * number + jnp.arange(steps, dtype=dtype)
        after, seen = lax.scan(one, state, numbers)
        return after, (state[0], jax.tree.map(lambda x: x[0], seen))

    numbers = jnp.arange(samples, dtype=dtype)
    end, (motion, seen) = lax.scan(sample, start, numbers)
    return Stepped(motion, seen, end)

"""Motion of masses in even steps of time.

Runge's and Kutta's classical method of order 4. A batch of systems takes the same
steps, and a record of even samples needs no interpolation.

A step has four stages at three times, the last of which begins the next step. What
depends on time alone is worked out once for each of them, for all steps of a sample at
once: long arrays are filled faster than many short ones.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

from ..numerics.types import Scalar

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
    acceleration: Callable[[Vector, Vector, Any], Vector],
    start: tuple[Vector, Vector],
    step: Scalar,
    steps: int,
    samples: int,
    kept: Callable[[Vector], Any] = lambda acceleration: acceleration,
    given: Callable[[Scalar], Any] = lambda time: time,
) -> Stepped:
    """A motion from time zero on.

    Args:
        acceleration: (motion, velocity, given(time)) -> (n,).
        start: Motion and velocity at time zero (n,).
        step: Of the integration [s].
        steps: Per sample. Static.
        samples: Their number. Static.
        kept: What is kept of the acceleration of every sample.
        given: What the acceleration needs to know of a time [s].

    Returns:
        The motion; the first sample is the start.

    Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993),
        II.1.
    """
    dtype = start[0].dtype
    half = 0.5 * step
    shapes = jax.eval_shape(given, step)
    _, unflatten = ravel_pytree(jax.tree.map(jnp.zeros_like, shapes))

    def flat(time):
        return ravel_pytree(given(time))[0]

    def one(state, known):
        x, v1 = state
        begin, middle, end = (unflatten(k) for k in known)
        a1 = acceleration(x, v1, begin)
        v2 = v1 + half * a1
        a2 = acceleration(x + half * v1, v2, middle)
        v3 = v1 + half * a2
        a3 = acceleration(x + half * v2, v3, middle)
        v4 = v1 + step * a3
        a4 = acceleration(x + step * v3, v4, end)
        moved = x + step / 6.0 * (v1 + 2.0 * (v2 + v3) + v4)
        velocity = v1 + step / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)
        return (moved, velocity), kept(a1)

    @jax.checkpoint
    def sample(state, number):
        halves = 2 * steps * number + jnp.arange(2 * steps + 1, dtype=dtype)
        known = jax.vmap(flat)(half * halves)
        known = known[0:-1:2], known[1::2], known[2::2]
        after, seen = lax.scan(one, state, known)
        return after, (state[0], jax.tree.map(lambda x: x[0], seen))

    numbers = jnp.arange(samples, dtype=dtype)
    end, (motion, seen) = lax.scan(sample, start, numbers)
    return Stepped(motion, seen, end)

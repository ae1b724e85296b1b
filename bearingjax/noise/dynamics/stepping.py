"""Integration of motion with constant time steps.

Runge's and Kutta's classical method of order 4. A batch of systems takes the same
steps, and a record of even samples needs no interpolation.

A step has four stages at three times, the last of which begins the next step. What
depends on time alone is worked out once for each of them, for all steps of a sample at
once: long arrays are filled faster than many short ones.

Samples are fewer than steps. Every sample is a weighted mean over the steps around it:
without it frequencies above half of the sampling rate would be aliased.
"""

from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

from ...numerics.types import Scalar, Vector
from ...numerics.units import units

REACH = 32
"""Number of samples before and after that contribute to a sample."""
HELD = 0.7
"""Pass band over half of the sampling rate; frequencies above half of the sampling
rate are attenuated to 1e-7 (140 dB)."""
_KAISER = 14.5
"""Shape of Kaiser's window for 140 dB."""


def step_weights(steps: int) -> np.ndarray:
    """Return the weights of steps, by block of steps (2 REACH, step) [1].

    Source: Kaiser's window 0.1102 (A - 8.7) of A dB, whose transition is A/14.36 over
        the length wide; Oppenheim, Schafer, Discrete-Time Signal Processing, 7.4.
    """
    away = np.arange(-REACH * steps, REACH * steps) / steps
    edge = 0.25 * (1.0 + HELD)
    window = np.i0(_KAISER * np.sqrt(np.maximum(0.0, 1.0 - (away / REACH) ** 2)))
    window[0] = 0.0  # as many steps before as after
    found = np.sinc(2.0 * edge * away) * window
    return (found / found.sum()).reshape(2 * REACH, steps)


class SampledMotion(NamedTuple):
    """Motion at equidistant samples.

    Attributes:
        motion: (sample, n) [m, rad].
        acceleration: Kept part of it, without frequencies above half of the sampling
            rate; leading axis sample. Before the start it counts as zero.
        end: Motion and velocity some samples later.
    """

    motion: Annotated[Float[Array, "sample n"], units("m", "rad")]
    acceleration: Any
    end: tuple[Vector, Vector]


def step_motion(
    acceleration: Callable[[Vector, Vector, Any], Vector],
    start: tuple[Vector, Vector],
    step: Scalar,
    steps: int,
    samples: int,
    kept: Callable[[Vector], Any] = lambda acceleration: acceleration,
    given: Callable[[Scalar], Any] = lambda time: time,
) -> SampledMotion:
    """Integrate a motion from time zero on.

    Args:
        acceleration: (motion, velocity, given(time)) -> (n,).
        start: Motion and velocity at time zero (n,).
        step: Step of the integration [s].
        steps: Per sample. Static.
        samples: Their number. Static.
        kept: Function of the acceleration that is kept at every sample.
        given: Function of time [s] with data for the acceleration.

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

    weights = jnp.asarray(step_weights(steps), dtype)

    def advance(state, known):
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

    def average(seen):
        return jnp.tensordot(weights, seen, axes=1)

    @jax.checkpoint
    def sample(carried, number):
        state, begun = carried
        halves = 2 * steps * number + jnp.arange(2 * steps + 1, dtype=dtype)
        known = jax.vmap(flat)(half * halves)
        known = known[0:-1:2], known[1::2], known[2::2]
        after, seen = lax.scan(advance, state, known)
        # Sums of the samples that these steps count for: the last one is then whole.
        begun = jax.tree.map(lambda b, s: b + average(s), begun, seen)
        whole = jax.tree.map(lambda b: b[-1], begun)
        begun = jax.tree.map(lambda b: jnp.roll(b, 1, axis=0).at[0].set(0.0), begun)
        return (after, begun), (state[0], whole)

    later = REACH - 1
    numbers = jnp.arange(samples + later, dtype=dtype)
    nothing = jax.tree.map(
        lambda a: jnp.zeros((2 * REACH, *a.shape), a.dtype),
        jax.eval_shape(kept, start[0]),
    )
    (end, _), (motion, seen) = lax.scan(sample, (start, nothing), numbers)
    seen = jax.tree.map(lambda a: a[later:], seen)
    return SampledMotion(motion[:samples], seen, end)

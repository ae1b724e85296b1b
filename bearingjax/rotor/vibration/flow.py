"""The motion over one period, by an explicit Runge-Kutta scheme of order 8.

Steps are even in the phase, so that one program serves every frequency and the
derivatives of the flow are those of what is computed. While every contact stays closed
the error falls with the eighth power of the step. Where balls lift off, the force has a
kink in its second derivative (Hertz contact, (3/2) power): the order is then 2.5 from
those steps on, and more steps are needed for the same error; `flow_error` tells it.

Source: Prince & Dormand, High order embedded Runge-Kutta formulae (1981); Diffrax's
    table.
"""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ...numerics.types import Scalar


def _scheme() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes (stage,), weights (stage,) and matrix (stage, stage)."""
    # Late, so that the package is imported as fast without it.
    from diffrax import Dopri8

    table = Dopri8.tableau
    stages = int(np.max(np.nonzero(table.b_sol))) + 1
    matrix = np.zeros((stages, stages))
    for k, row in enumerate(table.a_lower[: stages - 1], 1):
        matrix[k, :k] = row
    nodes = np.concatenate([[0.0], table.c[: stages - 1]])
    return nodes, table.b_sol[:stages], matrix


def _stepper(rate, steps, dtype):
    """(state, phase) -> state a step later."""
    nodes, weights, matrix = (jnp.asarray(x, dtype) for x in _scheme())
    size = 2.0 * np.pi / steps

    def step(y, phase):
        def stage(slopes, given):
            node, row, index = given
            at = y + size * jnp.tensordot(row, slopes, 1)
            slope = rate(phase + size * node, at)
            return lax.dynamic_update_index_in_dim(slopes, slope, index, 0), None

        none = jnp.zeros((nodes.shape[0], *y.shape), y.dtype)
        slopes, _ = lax.scan(stage, none, (nodes, matrix, jnp.arange(nodes.shape[0])))
        return y + size * jnp.tensordot(weights, slopes, 1)

    return step


def _begins(steps, dtype):
    """Phases at which steps begin [rad]."""
    return jnp.asarray(2.0 * np.pi / steps * np.arange(steps), dtype)


def integrate(
    rate: Callable[[Scalar, Float[Array, "..."]], Float[Array, "..."]],
    start: Float[Array, "..."],
    steps: int,
) -> tuple[Float[Array, "..."], Float[Array, "step ..."]]:
    """A motion over one period of the phase.

    Args:
        rate: (phase [rad], state) -> derivative of the state with respect to the phase.
        start: State at phase 0.
        steps: Even steps. Static.

    Returns:
        The state at phase 2π, and the states at the beginning of every step.
    """
    step = _stepper(rate, steps, start.dtype)
    phases = _begins(steps, start.dtype)
    return lax.scan(lambda y, phase: (step(y, phase), y), start, phases)


def transition(
    matrix_at: Callable[[Scalar], Float[Array, "m m"]],
    unit: Float[Array, "m m"],
    steps: int,
) -> Float[Array, "m m"]:
    """Fundamental matrix over one period of y' = A(φ) y, by Magnus series of order 6.

    A step is the exponential of a mean of A: one that is constant is met exactly,
    however fast it vibrates, so the stiff modes of a shaft ask for no short steps. The
    steps are independent of each other: all are taken at once.

    Args:
        matrix_at: φ [rad] -> A.
        unit: Unit matrix.
        steps: Even steps. Static.

    Source: Blanes, Casas & Ros, BIT 40 (2000) 434, Gauss-Legendre points.
    """
    size = 2.0 * np.pi / steps
    points = jnp.asarray(0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0]), unit.dtype)

    def step(begin):
        first, middle, last = size * jax.vmap(matrix_at)(begin + size * points)
        slope = np.sqrt(15.0) / 3.0 * (last - first)
        bend = 10.0 / 3.0 * (last - 2.0 * middle + first)
        turned = _bracket(middle, slope)
        more = slope - _bracket(middle, 2.0 * bend + turned) / 60.0
        mean = _bracket(-20.0 * middle - bend + turned, more) / 240.0
        return jax.scipy.linalg.expm(middle + bend / 12.0 + mean)

    each = jax.vmap(step)(_begins(steps, unit.dtype))
    whole, _ = lax.scan(lambda y, one: (one @ y, None), unit, each)
    return whole


def _bracket(a, b):
    """Commutator of two matrices."""
    return a @ b - b @ a

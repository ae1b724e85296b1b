"""Bounded nonlinear least squares by the Levenberg-Marquardt method of Optimistix."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import optimistix as optx
from jaxtyping import Array, Float, Int

from ..numerics.linear import solve_symmetric

DAMPING = 1e-3
"""Share of the diagonal of the normal equations that the first step adds to it [1]."""

CLOSE = 1e-4
"""Remaining step at which the search ends, in standard errors of the readings [1]."""

_SCATTER = 100.0
"""Largest factor by which residuals above their errors relax that limit [1]."""

_SMALLEST = 1e-12
"""Trust-region size over the first one at which the search gives up [1]."""


class Fit(NamedTuple):
    """End of a search: unknowns in the unit box, numbers of the function, their slopes,
    remaining step in standard errors of the readings [1], number of evaluations."""

    at: Float[Array, " unknown"]
    numbers: Float[Array, " number"]
    slopes: Float[Array, "number unknown"]
    left: Float[Array, ""]
    steps: Int[Array, ""]


class _Descent(optx.AbstractDescent):
    """Marquardt's damped step, cut at the bounds of the unit box."""

    def init(self, y, f_info_struct):
        return y, jnp.zeros_like(y), jnp.eye(y.shape[0], dtype=y.dtype)

    def query(self, y, f_info, state):
        jacobian = f_info.jac.as_matrix()
        return y, jacobian.T @ f_info.residual, jacobian.T @ jacobian

    def step(self, step_size, state):
        return _bounded_step(state, DAMPING / step_size), optx.RESULTS.successful


def _bounded_step(state, damping):
    """Return the damped step; unknowns held by a bound from descending stay there."""
    at, gradient, matrix = state
    held = ((at <= 0.0) & (gradient > 0.0)) | ((at >= 1.0) & (gradient < 0.0))
    free = jnp.where(held, 0.0, 1.0)
    added = jnp.diag(damping * jnp.diagonal(matrix) + 1.0 - free)
    step = solve_symmetric(matrix * jnp.outer(free, free) + added, gradient * free)
    return jnp.clip(at - step, 0.0, 1.0) - at


def _remaining_step(state, residual):
    step = _bounded_step(state, 0.0)
    size = jnp.sqrt(jnp.maximum(step @ state[2] @ step, 0.0))
    return size / jnp.clip(jnp.sqrt(jnp.mean(residual**2)), 1.0, _SCATTER)


class _Bounded(optx.AbstractGaussNewton):
    """The Levenberg-Marquardt method in the unit box; `args` is the step limit."""

    rtol: float = 0.0
    atol: float = 0.0
    norm: Callable = optx.max_norm
    descent: optx.AbstractDescent = _Descent()
    search: optx.AbstractSearch = optx.ClassicalTrustRegion()
    verbose: Callable = eqx.field(static=True, default=lambda **_: None)

    def terminate(self, fn, y, args, options, state, tags):
        close = _remaining_step(state.descent_state, state.f_info.residual) <= CLOSE
        stuck = state.search_state.step_size < _SMALLEST
        ended = close | stuck | (state.num_steps >= args)
        return ended & ~state.first_step, optx.RESULTS.successful


def least_squares(
    function: Callable[[Any], tuple[Any, Any]], start: Any, limit: Any
) -> Fit:
    """Minimise a sum of squares in the unit box; can be traced, and mapped by `vmap`.

    The Jacobian is exact, in forward mode. A step to where a residual is not finite is
    rejected, and a shorter one is tried.

    Args:
        function: Unknowns (unknown,) -> residuals (row,) and other numbers (number,).
        start: First values, in the unit box (unknown,).
        limit: Largest number of evaluations; 1: only evaluate at `start`.

    Source: Levenberg, Q. Appl. Math. 2 (1944) 164; Marquardt, J. SIAM 11 (1963) 431.
    """

    @jax.custom_jvp
    def evaluate(at):  # Optimistix linearises it: the slopes are computed once
        found = jax.jacfwd(lambda at: (function(at),) * 2, has_aux=True)(at)
        return found[::-1]

    @evaluate.defjvp
    def _(primals, tangents):
        found, slopes = evaluate(*primals)
        moved = jax.tree.map(lambda s: s @ tangents[0], slopes)
        return (found, slopes), (moved, jax.tree.map(jnp.zeros_like, slopes))

    def residuals(at, _):
        (residual, numbers), (_, slopes) = evaluate(at)
        return residual, (numbers, slopes)

    found = optx.least_squares(
        residuals, _Bounded(), start, limit, has_aux=True, max_steps=None, throw=False
    )
    state, (numbers, slopes) = found.state, found.state.aux
    left = _remaining_step(state.descent_state, state.f_info.residual)
    return Fit(found.value, numbers, slopes, left, state.num_steps)

"""Quasi-Newton minimiser of the energy paper, to compare with."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from .compiled.batched_loop import Either
from .linear import norm
from .minimise import AbstractMinimiser, Problem, State, first_state
from .types import Square, Vector


class BFGS(AbstractMinimiser):
    """Quasi-Newton with the inverse update of the energy paper.

    Kept to compare with the paper; on rollers that are barely held it needs many
    steps or fails, and then says so.

    Attributes:
        tolerance: As in `TrustRegionNewton`; `None` picks 1e-9 (float32: 1e-4).
        max_steps: Limit of evaluations.

    Static: all fields.
    Source: Sorokin, Zhang, Ivannikov (2018), quasi-Newton formula, restored:
        B⁻¹ ← (E - s zᵀ/r) B⁻¹ (E - z sᵀ/r) + s sᵀ/r with r = s·z; skipped if r ≤ 0.
        Backtracking line search added.
    """

    tolerance: float | None = eqx.field(static=True, default=None)
    max_steps: int = eqx.field(static=True, default=400)

    def reachable(self, dtype: Any) -> float:
        return 1e-9 if dtype == jnp.float64 else 1e-4

    def init(self, problem: Problem) -> State:
        n, dtype = problem.start.shape[0], problem.start.dtype
        # Kept besides: inverse of the Hessian, and the share of the step to try.
        own = jnp.eye(n, dtype=dtype), jnp.ones((), dtype)
        return first_state(problem, jnp.zeros((0,), dtype), own)

    def step(self, problem: Problem, state: State) -> State | Either:
        eps, tiny = (getattr(jnp.finfo(state.x.dtype), k) for k in ("eps", "tiny"))
        inverse, fraction = state.own
        first = state.steps < 0
        now = problem.with_force(state.x, state.now)
        direction = -inverse @ now.gradient
        direction = direction * jnp.minimum(
            1.0, state.radius / jnp.maximum(norm(direction), tiny)
        )
        s = jnp.where(first, 0.0, fraction * direction)
        there = problem.evaluate(state.x + s, False, now.memory)
        # No Hessian is evaluated.
        there = there._replace(hessian=now.hessian)
        new = problem.with_force(state.x + s, there)
        accept = (new.value - now.value <= 1e-4 * (now.gradient @ s)) | (
            norm(new.gradient) <= 0.5 * norm(now.gradient)
        )
        accept = accept | first
        updated = inverse_update(inverse, s, new.gradient - now.gradient)
        # First metric: down the gradient, as long as the radius.
        steep = jnp.eye(s.shape[0], dtype=s.dtype) * problem.radius
        steep = steep / jnp.maximum(norm(new.gradient), tiny)
        updated = jnp.where(first, steep, updated)
        full = accept & (fraction == 1.0)
        longer = jnp.maximum(state.radius, 4.0 * norm(s))
        stayed = state._replace(
            radius=jnp.where(full, longer, state.radius),
            steps=state.steps + 1,
            stalled=~accept & (norm(s) <= 4 * eps * norm(state.x)),
            own=(inverse, 0.3 * fraction),
        )
        taken = stayed._replace(
            x=state.x + s, now=there, own=(updated, jnp.ones_like(fraction))
        )
        return Either(accept, taken, stayed)


def inverse_update(inverse: Square, s: Vector, z: Vector) -> Square:
    """Inverse BFGS update: maps z to s, symmetric, positive definite if s·z > 0.

    Args:
        inverse: Current approximation of the inverse Hessian (n, n).
        s: Step (n,).
        z: Change of the gradient over it (n,).

    Returns:
        Updated inverse (n, n); the old one where s·z is not positive.
    """
    r = s @ z
    usable = r > 0
    safe = jnp.where(usable, r, 1.0)
    left = jnp.eye(s.shape[0], dtype=s.dtype) - jnp.outer(s, z) / safe
    new = left @ inverse @ left.T + jnp.outer(s, s) / safe
    return jnp.where(usable, new, inverse)

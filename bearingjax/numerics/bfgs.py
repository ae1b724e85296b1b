"""Quasi-Newton minimiser of the energy paper, to compare with."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from .lanes import Loop
from .linear import norm
from .minimise import AbstractMinimiser, Evaluation, State, finish, pack, unpack


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

    def loop(self, function, start, radius, shape=None, memory=()):
        default = 1e-9 if start.dtype == jnp.float64 else 1e-4
        tolerance = default if self.tolerance is None else self.tolerance
        eps = jnp.finfo(start.dtype).eps
        tiny = jnp.finfo(start.dtype).tiny
        n = start.shape[0]
        identity = jnp.eye(n, dtype=start.dtype)
        radius = jnp.asarray(radius, dtype=start.dtype)

        def unfinished(carry):
            state = unpack(carry[0], n, False)
            size = norm(state.now.gradient)
            goal = tolerance * state.now.scale + state.now.noise
            going = (size > goal) & (state.steps < self.max_steps) & ~state.stalled
            return going | (state.steps < 0)

        def step(carry):
            packed, inverse, fraction = carry
            state = unpack(packed, n, False)
            first = state.steps < 0
            now = state.now
            direction = -inverse @ now.gradient
            direction = direction * jnp.minimum(
                1.0, state.radius / jnp.maximum(norm(direction), tiny)
            )
            s = jnp.where(first, 0.0, fraction * direction)
            past = (memory,) if jax.tree.leaves(memory) else ()
            new = function(state.x + s, False, *past)
            accept = (new.value - now.value <= 1e-4 * (now.gradient @ s)) | (
                norm(new.gradient) <= 0.5 * norm(now.gradient)
            )
            accept = accept | first
            updated = inverse_update(inverse, s, new.gradient - now.gradient)
            # First metric: down the gradient, as long as the radius.
            steep = identity * radius / jnp.maximum(norm(new.gradient), tiny)
            updated = jnp.where(first, steep, updated)
            full = accept & (fraction == 1.0)
            longer = jnp.maximum(state.radius, 4.0 * norm(s))
            radius_now = jnp.where(full, longer, state.radius)
            stalled = ~accept & (norm(s) <= 4 * eps * norm(state.x))
            rest = (radius_now, state.steps + 1.0, stalled, *state[-2:])
            new = new._replace(hessian=now.hessian)
            taken = pack(State(state.x + s, new, *rest))
            stayed = pack(State(state.x, now, *rest))
            packed = jnp.where(accept, taken, stayed)
            inverse = jnp.where(accept, updated, inverse)
            return packed, inverse, jnp.where(accept, 1.0, 0.3 * fraction)

        zero = jnp.zeros((), start.dtype)
        nothing = jnp.zeros((0,), start.dtype)
        begin = Evaluation(zero, 0.0 * start, nothing, zero, zero)
        packed = pack(State(start, begin, radius, zero - 1.0, zero, zero, zero))
        carry = (packed, identity, jnp.ones((), start.dtype))

        def end(carry):
            return finish(unpack(carry[0], n, False), tolerance, None)

        return Loop(carry, unfinished, step, end)


def inverse_update(
    inverse: Float[Array, "n n"], s: Float[Array, " n"], z: Float[Array, " n"]
) -> Float[Array, "n n"]:
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

"""Minimisers for a handful of unknowns, built to run inside `vmap`.

Equilibria are minimisations that must lower an energy, not bare root finds. Each
minimiser is one `while_loop` with one evaluation per pass and returns a status.
"""

import abc
from collections.abc import Callable
from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from .linear import solve_symmetric
from .result import Result


class Evaluation(NamedTuple):
    """One evaluation of the function to be minimised.

    Attributes:
        value: Function value [J].
        gradient: First derivative (n,) [J/unit of x].
        hessian: Second derivative (n, n), or `None` if it was not asked for.
        scale: What the gradient is measured against, for example the sum of the
            forces that cancel in it.
        noise: Absolute round-off floor of the gradient's norm.
    """

    value: Float[Array, ""]
    gradient: Float[Array, " n"]
    hessian: Float[Array, "n n"] | None
    scale: Float[Array, ""]
    noise: Float[Array, ""]


class Minimum(NamedTuple):
    """Where a minimiser stopped.

    Attributes:
        x: Minimiser (n,).
        residual: |gradient| / scale [1].
        steps: Evaluations after the first.
        result: `Result` code.
        radius: Last trust radius, unit of x.
    """

    x: Float[Array, " n"]
    residual: Float[Array, ""]
    steps: Int[Array, ""]
    result: Int[Array, ""]
    radius: Float[Array, ""]


Function = Callable[[Float[Array, " n"], bool], Evaluation]


class AbstractMinimiser(eqx.Module):
    """Minimises a smooth function of a few unknowns, scaled to one unit."""

    @abc.abstractmethod
    def minimise(
        self,
        function: Function,
        start: Float[Array, " n"],
        radius: Float[Array, ""],
    ) -> Minimum:
        """Minimise `function`.

        Args:
            function: (x, with_hessian) -> `Evaluation`.
            start: First point (n,).
            radius: First bound of the step, same unit as x.

        Fails: `STEP_LIMIT`, `NON_FINITE` as result codes.
        """


class _State(NamedTuple):
    x: Array
    now: Evaluation
    radius: Array
    steps: Array
    stalled: Array
    reach: Array


class TrustRegionNewton(AbstractMinimiser):
    """Newton's method on H + |g|/radius, with the radius adapted.

    The shift bounds the step by the radius and vanishes with the gradient, so the
    end is quadratic; singular Hessians (open contacts) do no harm. A step is taken
    if it lowers the energy, or at least halves the gradient where the energy is
    lost in round-off.

    Attributes:
        tolerance: |gradient| / scale at which the solve ends; `None` picks
            1e-13 in float64 and 1e-5 in float32.
        max_steps: Step limit.

    Static: all fields.
    Source: gradient-regularised Newton, e.g. Ueda and Yamashita (2010).
    """

    tolerance: float | None = eqx.field(static=True, default=None)
    max_steps: int = eqx.field(static=True, default=100)

    def minimise(self, function, start, radius):
        tolerance = _tolerance(self.tolerance, start.dtype)
        return self.search(function, start, radius, tolerance, None, None)

    def search(
        self,
        function: Function,
        start: Float[Array, " n"],
        radius: Float[Array, ""],
        tolerance: Float[Array, ""] | float,
        direction: Float[Array, " n"] | None,
        limit: Float[Array, ""] | None,
    ) -> Minimum:
        """As `minimise`, for functions that may be flat at the start.

        Args:
            function, start, radius: As in `minimise`.
            tolerance: |gradient| / scale at which the search ends; may be traced.
            direction: Unit vector (n,), or zero. If the function falls along it and
                too little curvature is felt within `radius` to end the fall, it is
                first followed in growing steps until the function rises: Newton's
                method then comes from the stiff side, where it is at its best.
            limit: |x| beyond which the function counts as unbounded below; the
                solve then ends with `NO_LOAD_PATH`.

        Fails: as `minimise`, and `NO_LOAD_PATH`.
        """
        eps = jnp.finfo(start.dtype).eps
        n = start.shape[0]
        identity = jnp.eye(n, dtype=start.dtype)
        radius = jnp.asarray(radius, dtype=start.dtype)

        def unfinished(state):
            size = _norm(state.now.gradient)
            goal = tolerance * state.now.scale + state.now.noise
            # NaN compares false: the loop ends at once and the code says why.
            going = (size > goal) & (state.steps < self.max_steps) & ~state.stalled
            if limit is not None:
                going = going & (_norm(state.x) < limit)
            return going | (state.steps < 0)

        def step(state):
            # The first pass (steps = -1) only evaluates the start: one copy of
            # `function` in the compiled loop instead of two.
            first = state.steps < 0
            now = state.now
            size = _norm(now.gradient)
            shift = size / state.radius + eps * jnp.trace(now.hessian) / n
            p = -solve_symmetric(now.hessian + shift * identity, now.gradient)
            # An indefinite Hessian (finite kinematics) may still give a long step.
            tiny = jnp.finfo(start.dtype).tiny
            p = p * jnp.minimum(1.0, state.radius / jnp.maximum(_norm(p), tiny))
            searching = state.reach > 0
            if direction is not None:
                p = jnp.where(searching, state.reach * direction, p)
            p = jnp.where(first, 0.0, p)
            length = _norm(p)
            new = function(state.x + p, True)
            slope = now.gradient @ p
            predicted = slope + 0.5 * (p @ now.hessian @ p)
            actual = new.value - now.value
            new_size = _norm(new.gradient)
            accept = first | searching | (actual <= 1e-4 * slope)
            accept = accept | (new_size <= 0.5 * size)
            good = (actual <= 0.7 * predicted) | (new_size <= 0.25 * size)
            grown = jnp.where(
                good, jnp.maximum(state.radius, 6.0 * length), state.radius
            )
            # A step too long has met a stiff contact: Newton along the step, from its
            # far end, says where.
            bend = jnp.maximum(p @ new.hessian @ p, tiny)
            shorter = jnp.clip(1.0 - (new.gradient @ p) / bend, 0.1, 0.9)
            radius = jnp.where(accept, grown, shorter * length)
            reach = state.reach
            if direction is not None:
                fall = -(new.gradient @ direction)
                bend = direction @ new.hessian @ direction
                begin = (fall > 0) & (bend * state.radius < fall)
                reach = jnp.where(
                    first,
                    jnp.where(begin, state.radius, 0.0),
                    jnp.where(searching & (fall > 0), 4.0 * reach, 0.0),
                )
            now = Evaluation(
                *(jnp.where(accept, a, b) for a, b in zip(new, now, strict=True))
            )
            return _State(
                x=jnp.where(accept, state.x + p, state.x),
                now=now,
                radius=jnp.where(first, state.radius, radius),
                steps=state.steps + 1,
                stalled=~accept & (length <= 4 * eps * _norm(state.x)),
                reach=reach,
            )

        zero = jnp.zeros((), start.dtype)
        state = _State(
            x=start,
            now=Evaluation(zero, 0.0 * start, identity, zero, zero),
            radius=radius,
            steps=jnp.asarray(-1, dtype=jnp.int32),
            stalled=jnp.asarray(False),
            reach=zero,
        )
        return _finish(lax.while_loop(unfinished, step, state), tolerance, limit)


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

    def minimise(self, function, start, radius):
        default = 1e-9 if start.dtype == jnp.float64 else 1e-4
        tolerance = default if self.tolerance is None else self.tolerance
        eps = jnp.finfo(start.dtype).eps
        tiny = jnp.finfo(start.dtype).tiny
        identity = jnp.eye(start.shape[0], dtype=start.dtype)
        radius = jnp.asarray(radius, dtype=start.dtype)

        def unfinished(carry):
            state = carry[0]
            size = _norm(state.now.gradient)
            goal = tolerance * state.now.scale + state.now.noise
            going = (size > goal) & (state.steps < self.max_steps) & ~state.stalled
            return going | (state.steps < 0)

        def step(carry):
            state, inverse, fraction = carry
            first = state.steps < 0
            now = state.now
            direction = -inverse @ now.gradient
            direction = direction * jnp.minimum(
                1.0, state.radius / jnp.maximum(_norm(direction), tiny)
            )
            s = jnp.where(first, 0.0, fraction * direction)
            new = function(state.x + s, False)
            accept = (new.value - now.value <= 1e-4 * (now.gradient @ s)) | (
                _norm(new.gradient) <= 0.5 * _norm(now.gradient)
            )
            accept = accept | first
            updated = inverse_update(inverse, s, new.gradient - now.gradient)
            # First metric: down the gradient, as long as the radius.
            steep = identity * radius / jnp.maximum(_norm(new.gradient), tiny)
            updated = jnp.where(first, steep, updated)
            full = accept & (fraction == 1.0)
            longer = jnp.maximum(state.radius, 4.0 * _norm(s))
            state = _State(
                x=jnp.where(accept, state.x + s, state.x),
                now=Evaluation(
                    jnp.where(accept, new.value, now.value),
                    jnp.where(accept, new.gradient, now.gradient),
                    None,
                    jnp.where(accept, new.scale, now.scale),
                    jnp.where(accept, new.noise, now.noise),
                ),
                radius=jnp.where(full, longer, state.radius),
                steps=state.steps + 1,
                stalled=~accept & (_norm(s) <= 4 * eps * _norm(state.x)),
                reach=state.reach,
            )
            inverse = jnp.where(accept, updated, inverse)
            return state, inverse, jnp.where(accept, 1.0, 0.3 * fraction)

        zero = jnp.zeros((), start.dtype)
        state = _State(
            x=start,
            now=Evaluation(zero, 0.0 * start, None, zero, zero),
            radius=radius,
            steps=jnp.asarray(-1, dtype=jnp.int32),
            stalled=jnp.asarray(False),
            reach=zero,
        )
        carry = (state, identity, jnp.ones((), start.dtype))
        return _finish(lax.while_loop(unfinished, step, carry)[0], tolerance, None)


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


def _tolerance(tolerance, dtype):
    if tolerance is not None:
        return tolerance
    return 1e-13 if dtype == jnp.float64 else 1e-5


def _norm(x):
    return jnp.sqrt(jnp.sum(x * x))


def _finish(state, tolerance, limit):
    now = state.now
    size = _norm(now.gradient)
    # A stall at round-off is as good as it gets; anything above is a failure.
    slack = jnp.where(state.stalled, 1e3, 1.0)
    done = size <= slack * (tolerance * now.scale + now.noise)
    result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
    if limit is not None:
        away = ~done & (_norm(state.x) >= limit)
        result = jnp.where(away, int(Result.NO_LOAD_PATH), result)
    finite = jnp.isfinite(size) & jnp.all(jnp.isfinite(state.x))
    result = jnp.where(finite, result, int(Result.NON_FINITE))
    floor = jnp.finfo(size.dtype).tiny
    return Minimum(
        x=state.x,
        residual=size / jnp.maximum(now.scale, floor),
        steps=state.steps,
        result=result.astype(jnp.int32),
        radius=state.radius,
    )

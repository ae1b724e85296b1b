"""Minimiser of a function of a handful of unknowns, built to run inside `vmap`.

Equilibria are minimisations that must lower an energy, not bare root finds. Each
minimiser is one `while_loop` with one evaluation per pass and returns a status.
"""

import abc
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from .lanes import Loop
from .linear import dot, norm, quadratic, solve, trace
from .result import Result


class Evaluation(NamedTuple):
    """One evaluation of the function to be minimised.

    Attributes:
        value: Function value [J]; NaN if there is none, because not all forces have
            a potential: steps are then judged by forces alone.
        gradient: First derivative, or the forces themselves (n,) [J/unit of x].
        hessian: Second derivative (n, n); empty if it was not asked for.
        scale: What the gradient is measured against, for example the sum of the
            forces that cancel in it.
        noise: Absolute round-off floor of the gradient's norm.
        memory: What the next evaluation may start from, any pytree.
    """

    value: Float[Array, ""]
    gradient: Float[Array, " n"]
    hessian: Float[Array, "..."]
    scale: Float[Array, ""]
    noise: Float[Array, ""]
    memory: Any = ()


class Minimum(NamedTuple):
    """Where a minimiser stopped.

    Attributes:
        x: Minimiser (n,).
        residual: |gradient| / scale, zero below the round-off floor [1].
        unbalanced: |gradient|.
        steps: Evaluations after the first.
        result: `Result` code.
        memory: Of the evaluation at x.
    """

    x: Float[Array, " n"]
    residual: Float[Array, ""]
    unbalanced: Float[Array, ""]
    steps: Int[Array, ""]
    result: Int[Array, ""]
    memory: Any = ()


Function = Callable[..., Evaluation]
Shape = Callable[
    [Float[Array, " n"], Float[Array, " n"], Float[Array, ""]], Float[Array, " n"]
]


class AbstractMinimiser(eqx.Module):
    """Minimises a smooth function of a few unknowns, scaled to one unit."""

    def minimise(self, *args, **choices) -> Minimum:
        """Minimise a function: `loop` from begin to end."""
        return self.loop(*args, **choices).run()

    @abc.abstractmethod
    def loop(
        self,
        function: Function,
        start: Float[Array, " n"],
        radius: Float[Array, ""],
        shape: Shape | None = None,
        memory: Any = (),
    ) -> Loop:
        """The iteration that minimises `function`, and ends with a `Minimum`.

        Args:
            function: (x, with_hessian) -> `Evaluation`; with a `memory`, that of
                where the step began is its third argument.
            start: First point (n,).
            radius: First bound of the step, same unit as x.
            shape: (x, step, size of the gradient) -> better step, by one who knows
                where the function bends or stiffens. Newton's method alone uses it.
            memory: Of the start. Newton's method alone keeps it.

        Fails: `STEP_LIMIT`, `NON_FINITE` as result codes.
        """


class Pull(NamedTuple):
    """A constant force on x, approached from a larger one.

    Attributes:
        force: The function to be minimised is value - force·x (n,) [J/unit of x].
        factor: How many times the force the search begins with, at least 1. Each time
            the gradient is down to a hundredth of the force, the factor falls to a
            tenth.
    """

    force: Float[Array, " n"]
    factor: Float[Array, ""]


class State(NamedTuple):
    """Where a minimiser is: point, its evaluation, and what steps are chosen by."""

    x: Array
    now: Evaluation
    radius: Array
    steps: Array
    stalled: Array
    reach: Array
    factor: Array


def pack(state: State) -> Array:
    """All of a state in one array, so that a pass ends in one kernel, not in ten."""
    now = state.now
    parts = [state.x, now.gradient, now.hessian.reshape(-1)]
    scalars = [now.value, now.scale, now.noise, *state[2:]]
    return jnp.concatenate(
        [*parts, jnp.stack([v.astype(now.value.dtype) for v in scalars])]
    )


def unpack(packed: Array, n: int, with_hessian: bool = True) -> State:
    """The state that `pack` made one array of."""
    x, g, rest = packed[:n], packed[n : 2 * n], packed[2 * n :]
    h = jnp.zeros((0,), packed.dtype)
    if with_hessian:
        h, rest = rest[: n * n].reshape(n, n), rest[n * n :]
    value, scale, noise, *others = (rest[i] for i in range(8))
    radius, steps, stalled, reach, factor = others
    now = Evaluation(value, g, h, scale, noise)
    return State(x, now, radius, steps, stalled > 0, reach, factor)


class TrustRegionNewton(AbstractMinimiser):
    """Newton's method on H + D |g|/radius, with the radius adapted.

    D is the identity, or takes less off directions that are soft in themselves. The
    shift bounds the step and vanishes with the gradient, so the end is quadratic;
    singular Hessians (open contacts) do no harm. A step is taken if it lowers the
    energy, or still falls at its far end or at least halves the gradient, where the
    energy is lost in round-off.

    Attributes:
        tolerance: |gradient| / scale at which the solve ends; `None` picks
            1e-13 in float64 and 1e-6 in float32.
        max_steps: Step limit.
        symmetric: Whether the Hessian is symmetric; false where part of the forces
            has no potential.
        softest: D is the diagonal of H relative to its largest element, but at least
            this. Saves steps where unknowns differ in nature, such as tilt and shift
            of a ring; rollers of a taper, whose rib alone holds one direction, need 1.

    Static: all fields.
    Source: gradient-regularised Newton, e.g. Ueda and Yamashita (2010); D after
        Marquardt (1963).
    """

    tolerance: float | None = eqx.field(static=True, default=None)
    max_steps: int = eqx.field(static=True, default=100)
    symmetric: bool = eqx.field(static=True, default=True)
    softest: float = eqx.field(static=True, default=1.0)

    def loop(self, function, start, radius, shape=None, memory=()):
        goal = _tolerance(self.tolerance, start.dtype)
        return self.search_loop(
            function, start, radius, goal, None, None, shape, memory=memory
        )

    def search(self, *args, **choices) -> Minimum:
        """As `minimise`, for functions that may be flat at the start: `search_loop`."""
        return self.search_loop(*args, **choices).run()

    def search_loop(
        self,
        function: Function,
        start: Float[Array, " n"],
        radius: Float[Array, ""],
        tolerance: Float[Array, ""] | float,
        direction: Float[Array, " n"] | None,
        limit: Float[Array, ""] | None,
        shape: Shape | None = None,
        pull: Pull | None = None,
        memory: Any = (),
        max_steps: Int[Array, ""] | int | None = None,
    ) -> Loop:
        """As `loop`, for functions that may be flat at the start.

        Args:
            function, start, radius, shape, memory: As in `loop`.
            tolerance: |gradient| / scale at which the search ends; may be traced.
            direction: Unit vector (n,), or zero. If the function falls along it and
                too little curvature is felt within `radius` to end the fall, it is
                first followed in growing steps until the function rises: Newton's
                method then comes from the stiff side, where it is at its best.
            limit: |x| beyond which the function counts as unbounded below; the
                solve then ends with `NO_LOAD_PATH`.
            pull: A force on x beside `function`, which the scale of the latter then
                is not: the force is, unless it is zero.
            max_steps: Instead of the attribute; may be traced.

        Fails: as `loop`, and `NO_LOAD_PATH`.
        """
        eps = jnp.finfo(start.dtype).eps
        tiny = jnp.finfo(start.dtype).tiny
        n = start.shape[0]
        identity = jnp.eye(n, dtype=start.dtype)
        radius = jnp.asarray(radius, dtype=start.dtype)

        def off_goal(state):
            now, goal = _pulled(state.now, state, pull), tolerance
            if pull is not None:
                early = jnp.maximum(tolerance, 1e-2)
                goal = jnp.where(state.factor > 1.0, early, tolerance)
            # NaN compares false: the loop ends at once and the code says why.
            return (norm(now.gradient) > goal * now.scale + now.noise) & ~state.stalled

        limit_of_steps = self.max_steps if max_steps is None else max_steps
        limit_of_steps = jnp.asarray(limit_of_steps, dtype=start.dtype)
        remembers = bool(jax.tree.leaves(memory))

        def unfinished(carry):
            state = unpack(carry[0], n)
            going = off_goal(state)
            if pull is not None:
                going = going | (state.factor > 1.0)
            going = going & (state.steps < limit_of_steps)
            if limit is not None:
                going = going & (norm(state.x) < limit)
            return going | (state.steps < 0)

        def step(carry):
            packed, memory = carry
            # The first pass (steps = -1) only evaluates the start: one copy of
            # `function` in the compiled loop instead of two.
            state = unpack(packed, n)
            first = state.steps < 0
            if pull is not None:
                near = (state.factor > 1.0) & ~off_goal(state) & ~first
                lower = jnp.maximum(0.1 * state.factor, 1.0)
                state = state._replace(
                    factor=jnp.where(near, lower, state.factor),
                    radius=jnp.where(near, radius, state.radius),
                    stalled=state.stalled & ~near,
                )
            now = _pulled(state.now, state, pull)
            size = norm(now.gradient)
            shift = size / state.radius + eps * trace(now.hessian) / n
            shifted = now.hessian + shift * self._metric(now.hessian)
            p = -solve(shifted, now.gradient, self.symmetric)
            # An indefinite Hessian (finite kinematics) may still give a long step.
            p = p * jnp.minimum(1.0, state.radius / jnp.maximum(norm(p), tiny))
            searching = state.reach > 0
            if direction is not None:
                p = jnp.where(searching, state.reach * direction, p)
            if shape is not None:
                p = shape(state.x, p, size)
            p = jnp.where(first, 0.0, p)
            length = norm(p)
            past = (memory,) if remembers else ()
            there = function(state.x + p, True, *past)
            new = _pulled(there, state._replace(x=state.x + p), pull)
            slope = dot(now.gradient, p)
            predicted = slope + 0.5 * quadratic(now.hessian, p)
            actual = new.value - now.value
            new_size = norm(new.gradient)
            # Of a convex function: actual ≤ slope at the far end, where no round-off
            # of the value can hide it.
            end = dot(new.gradient, p)
            change = jnp.where(jnp.isnan(actual), end, jnp.minimum(actual, end))
            accept = first | searching | (change <= 1e-4 * slope)
            accept = accept | (new_size <= 0.5 * size)
            good = (change <= 0.7 * predicted) | (new_size <= 0.25 * size)
            longer = jnp.maximum(state.radius, 6.0 * length)
            grown = jnp.where(good, longer, state.radius)
            # A step too long has met a stiff contact: Newton along the step, from its
            # far end, says where.
            stiff = jnp.maximum(quadratic(new.hessian, p), tiny)
            shorter = jnp.clip(1.0 - dot(new.gradient, p) / stiff, 0.1, 0.9)
            next_radius = jnp.where(accept, grown, shorter * length)
            reach = state.reach
            if direction is not None:
                fall = -dot(new.gradient, direction)
                stiff = quadratic(new.hessian, direction)
                begin = (fall > 0) & (stiff * state.radius < fall)
                reach = jnp.where(
                    first,
                    jnp.where(begin, state.radius, 0.0),
                    jnp.where(searching & (fall > 0), 4.0 * reach, 0.0),
                )
            next_radius = jnp.where(first, state.radius, next_radius)
            # Steps of round-off that no longer help.
            settled = (length <= 4 * eps * norm(state.x)) & (new_size > 0.5 * size)
            stalled = settled & ~first & ~searching
            rest = (next_radius, state.steps + 1.0, stalled, reach, state.factor)
            taken = pack(State(state.x + p, there, *rest))
            stayed = pack(State(state.x, state.now, *rest))
            return jnp.where(accept, taken, stayed), jax.tree.map(
                lambda new, old: jnp.where(accept, new, old), there.memory, memory
            )

        zero = jnp.zeros((), start.dtype)
        factor = zero + 1.0 if pull is None else pull.factor
        begin = Evaluation(zero, 0.0 * start, identity, zero, zero)
        packed = pack(State(start, begin, radius, zero - 1.0, zero, zero, factor))

        def end(carry):
            state = unpack(carry[0], n)
            now = _pulled(state.now, state, pull)._replace(memory=carry[1])
            return finish(state._replace(now=now), tolerance, limit)

        return Loop((packed, memory), unfinished, step, end)

    def _metric(self, hessian):
        if self.softest == 1.0:
            return jnp.eye(hessian.shape[0], dtype=hessian.dtype)
        own = jnp.diag(hessian)
        stiffest = jnp.maximum(jnp.max(own), jnp.finfo(own.dtype).tiny)
        return jnp.diag(jnp.clip(own / stiffest, self.softest, 1.0))


def _pulled(now: Evaluation, state: State, pull: Pull | None) -> Evaluation:
    """The evaluation of value - factor·force·x from that of value."""
    if pull is None:
        return now
    force = state.factor * pull.force
    size = norm(force)
    return now._replace(
        value=now.value - dot(force, state.x),
        gradient=now.gradient - force,
        scale=jnp.where(size > 0, size, now.scale),
    )


def _tolerance(tolerance, dtype):
    if tolerance is not None:
        return tolerance
    return 1e-13 if dtype == jnp.float64 else 1e-6


def finish(state: State, tolerance, limit) -> Minimum:
    """What came of it: `Minimum` with its result code."""
    now = state.now
    size = norm(now.gradient)
    # A stall at round-off is as good as it gets; anything above is a failure.
    slack = jnp.where(state.stalled, 1e3, 1.0)
    done = size <= slack * (tolerance * now.scale + now.noise)
    result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
    if limit is not None:
        away = ~done & (norm(state.x) >= limit)
        result = jnp.where(away, int(Result.NO_LOAD_PATH), result)
    finite = jnp.isfinite(size) & jnp.all(jnp.isfinite(state.x))
    result = jnp.where(finite, result, int(Result.NON_FINITE))
    floor = jnp.finfo(size.dtype).tiny
    relative = size / jnp.maximum(now.scale, floor)
    return Minimum(
        x=state.x,
        residual=jnp.where(size <= now.noise, 0.0, relative),
        unbalanced=size,
        steps=state.steps.astype(jnp.int32),
        result=result.astype(jnp.int32),
        memory=now.memory,
    )

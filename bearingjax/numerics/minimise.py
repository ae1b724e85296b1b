"""Minimiser of a function of a handful of unknowns, built to run inside `vmap`.

Equilibria are minimisations that must lower an energy, not bare root finds. A
minimiser is four pure functions of a `Problem`: `init`, then `step` until `terminate`,
then `finish`. So the same four run alone (`minimise`), many at a time
(`batched_loop.run`), or under a load that comes down to its size (`continuation`). Each
step takes one evaluation of the function.
"""

import abc
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from .compiled.batched_loop import Either, Loop
from .linear import dot, norm, quadratic, solve, trace
from .result import Result
from .types import Reals, Vector
from .units import unit


class Evaluation(NamedTuple):
    """One evaluation of the function to be minimised.

    Attributes:
        value: Function value [J]; NaN if there is none, because not all forces have
            a potential: steps are then judged by forces alone.
        gradient: First derivative, or the forces themselves (n,) [J/unit of x].
        hessian: Second derivative (n, n); empty if it was not requested.
        scale: Reference for the size of the gradient, for example the sum of the
            forces that cancel in it.
        noise: Absolute round-off floor of the gradient's norm.
        memory: State from which the next evaluation may start, any pytree.
    """

    value: Annotated[Float[Array, ""], unit("J")]
    gradient: Annotated[Vector, unit("J/unit of x")]
    hessian: Reals
    scale: Float[Array, ""]
    noise: Float[Array, ""]
    memory: Any = ()


Function = Callable[..., Evaluation]
Shape = Callable[[Vector, Vector, Float[Array, ""]], Vector]


class Problem(NamedTuple):
    """Minimisation problem: function, start and stopping criteria.

    Attributes:
        function: (x, with_hessian) -> `Evaluation`; with a `memory`, that of the start
            of the step is its third argument.
        start: First point (n,).
        radius: First bound of the step, same unit as x.
        shape: (x, step, size of the gradient) -> better step, from knowledge of where
            the function bends or stiffens. Only Newton's method uses it.
        memory: Memory of the start.
        direction: Unit vector (n,), or zero. If the function falls along it and too
            little curvature is felt within `radius` to end the fall, it is first
            followed in growing steps until the function rises: Newton's method, the
            only one to use it, then starts on the stiff side, where it converges best.
        limit: |x| beyond which the function counts as unbounded below; the search then
            ends with `NO_LOAD_PATH`.
        force: A constant force on x (n,) [J/unit of x]: value - force·x is minimised,
            and the scale is the force, unless it is zero.
        tolerance: |gradient| / scale at which to stop; may be traced. `None`: the
            minimiser's own.
        max_steps: Step limit; may be traced. `None`: the minimiser's own.
    """

    function: Function
    start: Vector
    radius: Float[Array, ""]
    shape: Shape | None = None
    memory: Any = ()
    direction: Vector | None = None
    limit: Float[Array, ""] | None = None
    force: Annotated[Vector | None, unit("J/unit of x")] = None
    tolerance: Float[Array, ""] | float | None = None
    max_steps: Int[Array, ""] | int | None = None

    def evaluate(self, x: Array, with_hessian: bool, memory: Any) -> Evaluation:
        """Evaluate the function, without `force`."""
        remembered = (memory,) if jax.tree.leaves(memory) else ()
        return self.function(x, with_hessian, *remembered)

    def with_force(self, x: Array, now: Evaluation) -> Evaluation:
        """The evaluation of value - force·x, from the one of the function at x."""
        if self.force is None:
            return now
        size = norm(self.force)
        return now._replace(
            value=now.value - dot(self.force, x),
            gradient=now.gradient - self.force,
            scale=jnp.where(size > 0, size, now.scale),
        )


class State(NamedTuple):
    """State of a minimiser.

    Attributes:
        x: Point (n,).
        now: The function there, without `Problem.force`.
        radius: Bound of the next step, same unit as x.
        steps: Evaluations after the first; -1 before the first [1].
        stalled: Whether steps are lost in round-off.
        own: Further state of the method, any pytree.
    """

    x: Vector
    now: Evaluation
    radius: Float[Array, ""]
    steps: Annotated[Int[Array, ""], unit("1")]
    stalled: Bool[Array, ""]
    own: Any


class Minimum(NamedTuple):
    """Result of a minimiser.

    Attributes:
        x: Minimiser (n,).
        residual: |gradient| / scale, zero below the round-off floor [1].
        unbalanced: |gradient|.
        steps: Evaluations after the first.
        result: `Result` code.
        memory: Memory of the evaluation at x.
    """

    x: Vector
    residual: Annotated[Float[Array, ""], unit("1")]
    unbalanced: Float[Array, ""]
    steps: Int[Array, ""]
    result: Int[Array, ""]
    memory: Any = ()


def trivial_result(problem: Problem) -> Minimum:
    """Return a `Minimum` of the right shapes, for an unsolved problem."""
    zero, none = jnp.zeros((), problem.start.dtype), jnp.zeros((), jnp.int32)
    return Minimum(problem.start, zero, zero, none, none, problem.memory)


class AbstractMinimiser(eqx.Module):
    """Minimises a smooth function of a few unknowns, scaled to one unit.

    A method gives `init`, `step` and its attributes; when it ends is the same for all.

    Attributes:
        tolerance: |gradient| / scale at which it stops; `None`: by precision.
        max_steps: Step limit.

    Static: all fields.
    """

    tolerance: eqx.AbstractVar[float | None]
    max_steps: eqx.AbstractVar[int]

    def minimise(
        self,
        function: Function,
        start: Vector,
        radius: Float[Array, ""],
        **choices: Any,
    ) -> Minimum:
        """Minimise one function, from `init` to `finish`.

        Args:
            function, start, radius, **choices: As in `Problem`.

        Fails: `STEP_LIMIT`, `NON_FINITE` as result codes; with a `limit`,
            `NO_LOAD_PATH`.
        """
        return self.loop().run(Problem(function, start, radius, **choices))

    def loop(self, problem_of: Callable[[Any], Problem] = lambda given: given) -> Loop:
        """Return the iteration, for data that `problem_of` converts to a problem."""
        return Loop(
            lambda given: self.init(problem_of(given)),
            lambda given, state: self.step(problem_of(given), state),
            lambda given, state: self.terminate(problem_of(given), state),
            lambda given, state: self.finish(problem_of(given), state),
            lambda given: trivial_result(problem_of(given)),
        )

    @abc.abstractmethod
    def init(self, problem: Problem) -> State:
        """First state. The function is not evaluated: the first step does only that.

        So a compiled loop holds one copy of the function instead of two.
        """

    @abc.abstractmethod
    def step(self, problem: Problem, state: State) -> State | Either:
        """Next state."""

    def terminate(self, problem: Problem, state: State) -> Bool[Array, ""]:
        """Whether to stop: at the goal, stalled, out of steps or beyond the limit."""
        ended = self.converged(problem, state) | self.at_limit(problem, state)
        return ended & (state.steps >= 0)

    def converged(self, problem: Problem, state: State) -> Bool[Array, ""]:
        """Whether further steps cannot improve the result."""
        now = problem.with_force(state.x, state.now)
        goal = self.goal(problem) * now.scale + now.noise
        # NaN compares false: the loop ends at once and the code says why.
        return ~((norm(now.gradient) > goal) & ~state.stalled)

    def at_limit(self, problem: Problem, state: State) -> Bool[Array, ""]:
        """Whether further steps are not allowed."""
        own = problem.max_steps
        ended = ~(state.steps < (self.max_steps if own is None else own))
        if problem.limit is not None:
            ended = ended | ~(norm(state.x) < problem.limit)
        return ended

    def finish(self, problem: Problem, state: State) -> Minimum:
        """Return the minimum of the last state, with its result code."""
        now = problem.with_force(state.x, state.now)
        size = norm(now.gradient)
        # A stall at round-off is as good as it gets; anything above is a failure.
        slack = jnp.where(state.stalled, 1e3, 1.0)
        done = size <= slack * (self.goal(problem) * now.scale + now.noise)
        result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
        if problem.limit is not None:
            away = ~done & (norm(state.x) >= problem.limit)
            result = jnp.where(away, int(Result.NO_LOAD_PATH), result)
        finite = jnp.isfinite(size) & jnp.all(jnp.isfinite(state.x))
        result = jnp.where(finite, result, int(Result.NON_FINITE))
        floor = jnp.finfo(size.dtype).tiny
        relative = size / jnp.maximum(now.scale, floor)
        return Minimum(
            x=state.x,
            residual=jnp.where(size <= now.noise, 0.0, relative),
            unbalanced=size,
            steps=state.steps,
            result=result.astype(jnp.int32),
            memory=now.memory,
        )

    def goal(self, problem: Problem) -> Any:
        """|gradient| / scale at which to stop [1]."""
        if problem.tolerance is not None:
            return problem.tolerance
        if self.tolerance is not None:
            return self.tolerance
        return self.reachable(problem.start.dtype)

    @abc.abstractmethod
    def reachable(self, dtype: Any) -> float:
        """The tolerance that the method reaches in this precision [1]."""


def first_state(problem: Problem, hessian: Array, own: Any) -> State:
    """State before the first evaluation.

    Args:
        problem: Problem to be minimised.
        hessian: Something of the right shape.
        own: As in `State`.
    """
    start = problem.start
    zero = jnp.zeros((), start.dtype)
    none = Evaluation(zero, 0.0 * start, hessian, zero, zero, problem.memory)
    radius = jnp.asarray(problem.radius, start.dtype)
    return State(start, none, radius, jnp.int32(-1), jnp.asarray(False), own)


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

    def reachable(self, dtype: Any) -> float:
        return 1e-13 if dtype == jnp.float64 else 1e-6

    def init(self, problem: Problem) -> State:
        n, dtype = problem.start.shape[0], problem.start.dtype
        # What is kept besides is the length of the next step along `direction`.
        reach = () if problem.direction is None else jnp.zeros((), dtype)
        return first_state(problem, jnp.eye(n, dtype=dtype), reach)

    def step(self, problem: Problem, state: State) -> State | Either:
        p = self.propose(problem, state)
        there = problem.evaluate(state.x + p, True, state.now.memory)
        return self.judge(problem, state, p, there)

    def propose(self, problem: Problem, state: State) -> Vector:
        """Return the step of x to the point that `judge` asks for (n,).

        Args:
            problem: Problem whose function is not called.
            state: State before the step.
        """
        eps, tiny = (getattr(jnp.finfo(state.x.dtype), k) for k in ("eps", "tiny"))
        n, first = state.x.shape[0], state.steps < 0
        now = problem.with_force(state.x, state.now)
        size = norm(now.gradient)
        shift = size / state.radius + eps * trace(now.hessian) / n
        shifted = now.hessian + shift * self._metric(now.hessian)
        p = -solve(shifted, now.gradient, self.symmetric)
        # An indefinite Hessian (finite kinematics) may still give a long step.
        p = p * jnp.minimum(1.0, state.radius / jnp.maximum(norm(p), tiny))
        if problem.direction is not None:
            p = jnp.where(state.own > 0, state.own * problem.direction, p)
        if problem.shape is not None:
            p = problem.shape(state.x, p, size)
        return jnp.where(first, 0.0, p)

    def judge(
        self, problem: Problem, state: State, p: Vector, there: Evaluation
    ) -> Either:
        """Return the state after a step that was proposed.

        Args:
            problem: Problem whose function is not called.
            state: State before the step.
            p: Step of `propose` (n,).
            there: The function at its end.
        """
        eps, tiny = (getattr(jnp.finfo(state.x.dtype), k) for k in ("eps", "tiny"))
        first = state.steps < 0
        now = problem.with_force(state.x, state.now)
        size = norm(now.gradient)
        searching, reach = jnp.asarray(False), state.own
        if problem.direction is not None:
            searching = reach > 0
        length, x = norm(p), state.x + p
        new = problem.with_force(x, there)
        slope = dot(now.gradient, p)
        predicted = slope + 0.5 * quadratic(now.hessian, p)
        actual = new.value - now.value
        new_size = norm(new.gradient)
        # Of a convex function: actual ≤ slope at the far end, where no round-off
        # of the value can hide it.
        end = dot(new.gradient, p)
        change = jnp.where(jnp.isnan(actual), end, jnp.minimum(actual, end))
        # What has no value there is too far away.
        known = jnp.isfinite(new_size)
        accept = first | (searching & known) | (change <= 1e-4 * slope)
        accept = accept | (new_size <= 0.5 * size)
        good = (change <= 0.7 * predicted) | (new_size <= 0.25 * size)
        longer = jnp.maximum(state.radius, 6.0 * length)
        grown = jnp.where(good, longer, state.radius)
        # A step too long has met a stiff contact: Newton along the step, from its
        # far end, says where.
        stiff = jnp.maximum(quadratic(new.hessian, p), tiny)
        shorter = jnp.where(known, jnp.clip(1.0 - end / stiff, 0.1, 0.9), 0.1)
        radius = jnp.where(accept, grown, shorter * length)
        if problem.direction is not None:
            fall = -dot(new.gradient, problem.direction)
            stiff = quadratic(new.hessian, problem.direction)
            begin = (fall > 0) & (stiff * state.radius < fall)
            reach = jnp.where(
                first,
                jnp.where(begin, state.radius, 0.0),
                jnp.where(searching & (fall > 0), 4.0 * reach, 0.0),
            )
        # Steps of round-off that no longer help.
        still = (length <= 4 * eps * norm(state.x)) & (new_size > 0.5 * size)
        stayed = state._replace(
            radius=jnp.where(first, state.radius, radius),
            steps=state.steps + 1,
            stalled=still & ~first & ~searching,
            own=reach,
        )
        return Either(accept, stayed._replace(x=x, now=there), stayed)

    def _metric(self, hessian):
        if self.softest == 1.0:
            return jnp.eye(hessian.shape[0], dtype=hessian.dtype)
        own = jnp.diag(hessian)
        stiffest = jnp.maximum(jnp.max(own), jnp.finfo(own.dtype).tiny)
        return jnp.diag(jnp.clip(own / stiffest, self.softest, 1.0))


def continuation(
    minimiser: AbstractMinimiser,
    problem_of: Callable[[Any], Problem],
    factor_of: Callable[[Any], Array],
) -> Loop:
    """Minimise value - force·x, approached from a larger force.

    As with a barrier method, what matters to the end is found early, and Newton's
    method stays on its side. Each time the gradient is down to a hundredth of the
    force, the factor falls to a tenth.

    Args:
        minimiser: Takes the steps.
        problem_of: Given -> problem with a `force`; its step limit counts all steps.
        factor_of: Given -> how many times the force the search begins with, at least 1.

    Returns:
        The iteration, given -> `Minimum`.
    """

    def scale_force(problem, factor):
        goal = minimiser.goal(problem)
        early = jnp.where(factor > 1.0, jnp.maximum(goal, 1e-2), goal)
        return problem._replace(force=factor * problem.force, tolerance=early)

    def init(given):
        return minimiser.init(problem_of(given)), factor_of(given)

    def step(given, carry):
        (state, factor), problem = carry, problem_of(given)
        near = (factor > 1.0) & minimiser.converged(scale_force(problem, factor), state)
        near = near & (state.steps >= 0)
        factor = jnp.where(near, jnp.maximum(0.1 * factor, 1.0), factor)
        state = state._replace(
            radius=jnp.where(near, problem.radius, state.radius),
            stalled=state.stalled & ~near,
        )
        return minimiser.step(scale_force(problem, factor), state), factor

    def terminate(given, carry):
        (state, factor), problem = carry, problem_of(given)
        converged = (factor <= 1.0) & minimiser.converged(
            scale_force(problem, factor), state
        )
        return (converged | minimiser.at_limit(problem, state)) & (state.steps >= 0)

    def finish(given, carry):
        (state, factor), problem = carry, problem_of(given)
        goal = minimiser.goal(problem)
        return minimiser.finish(
            scale_force(problem, factor)._replace(tolerance=goal), state
        )

    return Loop(
        init, step, terminate, finish, lambda given: trivial_result(problem_of(given))
    )

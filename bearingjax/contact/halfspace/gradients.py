"""Conjugate gradients for contact: load and moment in the loop, preconditioned."""

import abc
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from ...numerics.compiled.batched_loop import Loop
from ...numerics.linear import dot, solve_symmetric
from ...numerics.result import Result
from .problem import PressureSolution, Problem


def _rounding(dtype) -> float:
    """Share of the load that may be lacking: round-off, with something to spare."""
    return 1e-12 if dtype == jnp.float64 else 1e-6


_BOLD = 40
"""Steps in which the energy may rise: most problems are solved in fewer."""


class AbstractPressureSolver(eqx.Module):
    """Finds the pressure of a contact step by step; each step is a pure function.

    `init`, then `step` until `terminate`, then `finish`.
    """

    @abc.abstractmethod
    def init(self, problem: Problem) -> Any:
        """First state."""

    @abc.abstractmethod
    def step(self, problem: Problem, state: Any) -> Any:
        """Next state."""

    @abc.abstractmethod
    def terminate(self, problem: Problem, state: Any) -> Any:
        """Whether to stop: solved, out of steps or not finite."""

    @abc.abstractmethod
    def finish(self, problem: Problem, state: Any) -> PressureSolution:
        """Pressure and status.

        Fails: `STEP_LIMIT`, `NO_LOAD_PATH` (a load that is not positive, a moment that
            no pressure on the grid balances), `NON_FINITE`.
        """

    def loop(self) -> Loop:
        """Return the solver as an iteration."""
        return Loop(self.init, self.step, self.terminate, self.finish)


class _State(NamedTuple):
    pressure: Array
    displacement: Array
    energy: Array
    touching: Array
    distance: Array
    rigid: Array
    residual: Array
    direction: Array
    fall: Array
    follows: Array
    opens: Array
    steps: Array


class ConjugateGradients(AbstractPressureSolver):
    """Conjugate gradients over the cells in contact, an active set.

    Every direction keeps load and moment. Cells whose pressure would turn negative
    leave all at once, load and moment are then restored; should that not lower the
    energy, the step ends where the first cell leaves, which always does. Cells that
    overlap enter. Where cells come or go the directions start afresh.

    Attributes:
        tolerance: Residual at which to stop, see `PressureSolution`; `None` picks 1e-10
            in float64 and in float32 2e-5, beyond a thousand cells so many times more:
            below that products are round-off.
        max_steps: Step limit.
        preconditioned: Whether directions are estimated pressures, so that a score of
            steps do on any grid, or plain distances, as published.

    Static: all fields.
    Source: Polonsky & Keer, Wear 231 (1999), here with any rigid motions and without
        their first step for entering cells; preconditioner and restarts after
        Vollebregt, J. Comput. Phys. 257 (2014); the safeguard is our own.
    """

    tolerance: float | None = eqx.field(static=True, default=None)
    max_steps: int = eqx.field(static=True, default=500)
    preconditioned: bool = eqx.field(static=True, default=True)

    def init(self, problem: Problem) -> Any:
        pressure, touching = _start(problem)
        displacement = problem.influence(pressure)
        return _State(
            pressure,
            displacement,
            _energy(problem, pressure, displacement),
            touching,
            *_judge(problem, pressure, displacement, touching),
            direction=jnp.zeros_like(pressure),
            fall=jnp.ones((), pressure.dtype),
            follows=jnp.asarray(False),
            opens=jnp.asarray(True),
            steps=jnp.asarray(0, jnp.int32),
        )

    def step(self, problem: Problem, state: Any) -> Any:
        area = problem.grid.area
        enters = ~state.touching & (state.distance < 0) & state.opens
        touching = state.touching | enters
        rest = jnp.where(touching, state.distance, 0.0)
        steepest = rest
        if self.preconditioned:
            steepest = projected_pressure(problem, touching, rest)
        fall = jnp.sum(area * rest * steepest)
        # The published update; that of Polak and Ribière does not pay here.
        share = jnp.where(state.follows & ~jnp.any(enters), fall / state.fall, 0.0)
        direction = jnp.where(touching, steepest + share * state.direction, 0.0)
        pushed = problem.influence(direction)
        stiff = jnp.sum(area * direction * pushed)
        length = jnp.sum(area * rest * direction) / jnp.where(stiff > 0, stiff, 1.0)
        whole = length * direction
        leaves = touching & (whole > state.pressure)
        clipped = jnp.any(leaves)

        def move_by(share):
            pressure = jnp.maximum(state.pressure - share * whole, 0.0)
            return pressure, state.displacement - share * length * pushed

        def all_leave():
            least = 0.01 * jnp.max(state.pressure)
            weight = jnp.where(touching, jnp.maximum(state.pressure, least), 0.0)
            pressure = _balance(problem, state.pressure - whole, weight)
            displacement = problem.influence(pressure)
            energy = _energy(problem, pressure, displacement)
            lower = (energy < state.energy) | (state.steps < _BOLD)
            lower = lower & (
                _imbalance(problem, pressure) <= 10.0 * _rounding(pressure.dtype)
            )
            # As far as the first that leaves.
            ratio = state.pressure / jnp.where(leaves, whole, 1.0)
            share = jnp.min(jnp.where(leaves, ratio, 1.0))
            first = (*move_by(share), leaves & (ratio <= share), share > 0)
            every = (pressure, displacement, touching & (pressure <= 0), lower)
            return jax.tree.map(lambda a, b: jnp.where(lower, a, b), every, first)

        def none_leaves():
            return (*move_by(1.0), leaves, jnp.asarray(True))

        pressure, displacement, leaves, moved = lax.cond(
            clipped, all_leave, none_leaves
        )
        touching = touching & ~leaves
        return _State(
            jnp.where(leaves, 0.0, pressure),
            displacement,
            _energy(problem, pressure, displacement),
            touching,
            *_judge(problem, pressure, displacement, touching),
            direction=direction,
            fall=jnp.where(fall > 0, fall, 1.0),
            follows=~clipped,
            opens=moved,
            steps=state.steps + 1,
        )

    def terminate(self, problem: Problem, state: Any) -> Any:
        # NaN compares false, and ends it.
        going = state.residual > self._goal(state.pressure)
        return ~(going & (state.steps < self.max_steps))

    def finish(self, problem: Problem, state: Any) -> PressureSolution:
        done = state.residual <= self._goal(state.pressure)
        result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
        finite = jnp.isfinite(state.residual) & jnp.all(jnp.isfinite(state.rigid))
        result = jnp.where(finite, result, int(Result.NON_FINITE))
        result = jnp.where(_is_carried(problem), result, int(Result.NO_LOAD_PATH))
        return PressureSolution(
            state.pressure,
            state.touching & (state.pressure > 0),
            state.rigid,
            state.residual,
            state.steps,
            result.astype(jnp.int32),
        )

    def _goal(self, pressure):
        if self.tolerance is not None:
            return self.tolerance
        if pressure.dtype == jnp.float64:
            return 1e-10
        return 2e-5 * max(1.0, pressure.size / 1000)


def rigid_fit(
    problem: Problem, touching: Bool[Array, "m n"], distance: Float[Array, "m n"]
) -> Float[Array, " k"]:
    """Rigid motion nearest to a distance of the surfaces in contact (k,) [m]."""
    modes, area = problem.modes, problem.grid.area
    if not modes.shape[0]:
        return jnp.zeros((0,), distance.dtype)
    weighted = jnp.where(touching, area, 0.0)[None] * modes
    matrix = jnp.einsum("kmn,lmn->kl", weighted, modes)
    return solve_symmetric(matrix, jnp.einsum("kmn,mn->k", weighted, distance))


def projected_pressure(
    problem: Problem, touching: Bool[Array, "m n"], rest: Float[Array, "m n"]
) -> Float[Array, "m n"]:
    """Estimated pressure in contact, without load and moment [Pa]."""
    modes = problem.modes
    if not modes.shape[0]:
        return jnp.where(touching, problem.influence.estimate(rest), 0.0)
    fields = jnp.concatenate([rest[None], modes])
    inside = touching[None]
    estimates = problem.influence.estimate(jnp.where(inside, fields, 0.0))
    estimates = jnp.where(inside, estimates, 0.0)
    sums = jnp.einsum("kmn,lmn->kl", problem.weighted_modes, estimates)
    part = solve_symmetric(sums[:, 1:], sums[:, 0])
    return estimates[0] - jnp.einsum("k,kmn->mn", part, estimates[1:])


def _judge(problem, pressure, displacement, touching):
    """Distance of the surfaces, rigid motion, residual."""
    distance = displacement + problem.given_gap
    rigid = rigid_fit(problem, touching, distance)
    distance = distance - jnp.einsum("k,kmn->mn", rigid, problem.modes)
    overlap = jnp.maximum(-distance, 0.0)
    off = jnp.max(jnp.where(pressure > 0, jnp.abs(distance), overlap))
    area = problem.grid.area
    load = jnp.sum(area * pressure)
    loaded = load > 0
    mean = jnp.sum(area * pressure * displacement) / jnp.where(loaded, load, 1.0)
    # Before anything is loaded, what is to be displaced is the measure.
    scale = jnp.where(loaded, mean, jnp.max(overlap))
    residual = jnp.where(off == 0, 0.0, off / jnp.where(scale > 0, scale, 1.0))
    return distance, rigid, jnp.maximum(residual, _imbalance(problem, pressure))


def _energy(problem, pressure, displacement):
    """Energy that the pressure minimises, under its load and moment [J]."""
    density = pressure * (0.5 * displacement + problem.given_gap)
    return jnp.sum(problem.grid.area * density)


def _missing(problem, pressure):
    """Load, and moment over the lever, that the pressure lacks (k,) [N]."""
    sums = jnp.einsum("kmn,mn->k", problem.weighted_modes, pressure)
    return problem.goal.astype(pressure.dtype) - sums


def _imbalance(problem, pressure):
    """The largest of `_missing`, over the load [1]."""
    if problem.load is None:
        return jnp.zeros((), pressure.dtype)
    loaded = problem.load > 0
    lack = jnp.max(jnp.abs(_missing(problem, pressure)))
    return lack / jnp.where(loaded, problem.load, 1.0)


def _balance(problem, pressure, weight):
    """Nearest pressure, nowhere negative, with load and moment as given.

    Near by the sum of change²/weight: a projection, Newton's method in the two
    multipliers of load and moment. If `weight` has that load and moment, and it is
    nowhere negative, there is one.
    """
    modes, area = problem.modes, problem.grid.area
    if not modes.shape[0]:
        return jnp.maximum(pressure, 0.0)

    def shift_pressure(part):
        more = jnp.einsum("k,kmn->mn", part, modes)
        return jnp.maximum(pressure + weight * more, 0.0)

    def continues(carry):
        _, missing, _, count = carry
        worst = jnp.max(jnp.abs(missing)) > _rounding(pressure.dtype) * problem.load
        return worst & (count < 60)

    def newton(carry):
        part, missing, damping, count = carry
        moving = jnp.where(shift_pressure(part) > 0, area * weight, 0.0)[None] * modes
        matrix = jnp.einsum("kmn,lmn->kl", moving, modes)
        there = part + damping * solve_symmetric(matrix, missing)
        left = _missing(problem, shift_pressure(there))
        better = dot(left, left) < dot(missing, missing)
        return (
            jnp.where(better, there, part),
            jnp.where(better, left, missing),
            jnp.where(better, jnp.minimum(4.0 * damping, 1.0), 0.25 * damping),
            count + 1,
        )

    none = jnp.zeros(modes.shape[:1], pressure.dtype)
    one = jnp.ones((), pressure.dtype)
    begin = (none, _missing(problem, shift_pressure(none)), one, jnp.asarray(0))
    return shift_pressure(lax.while_loop(continues, newton, begin)[0])


def _start(problem):
    """First pressure, and the cells that count as touching."""
    given = problem.given_gap
    if problem.load is None:
        return jnp.zeros_like(given), given < 0
    pressure = jnp.ones_like(given) * (problem.load / jnp.sum(problem.grid.area))
    if problem.moment is not None:
        # An exponential has any centre: Langevin's function, inverted after Cohen.
        off = problem.moment / (problem.load * problem.lever)
        off = jnp.where(jnp.isfinite(off), jnp.clip(off, -0.98, 0.98), 0.0)
        slope = off * (3.0 - off * off) / (1.0 - off * off)
        y = problem.grid.y / problem.lever
        pressure = pressure * jnp.exp(slope * y - jnp.abs(slope))[None]
        pressure = _balance(problem, pressure, pressure)
    return pressure, jnp.ones_like(given, bool)


def _is_carried(problem):
    """Whether some pressure on the grid has this load and moment."""
    if problem.load is None:
        return jnp.asarray(True)
    # Not "< 0": a load that is not a number is no wrong load path.
    carried = ~(problem.load < 0)
    if problem.moment is not None:
        reach = jnp.max(jnp.abs(problem.grid.y))
        carried = carried & ~(jnp.abs(problem.moment) > problem.load * reach)
    return carried

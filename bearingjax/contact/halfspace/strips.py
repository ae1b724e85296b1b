"""The paper's iteration strip by strip, as printed and corrected, for comparison."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array

from ...numerics.lapack import solve_any
from ...numerics.result import Result
from .gradients import AbstractPressureSolver
from .influence import EvenInfluence, cosine_sums, padded_size
from .problem import PressureSolution, Problem

_INNER = 40
"""Limit of changes of the active set within a strip."""


class _State(NamedTuple):
    pressure: Array
    approach: Array
    change: Array
    steps: Array


class Strips(AbstractPressureSolver):
    """Block Gauss-Seidel over strips of cells, each solved with a band of its matrix.

    Kept to compare with the paper: `ConjugateGradients` is faster by orders of
    magnitude. Takes even grids with all cells kept, and no moment; a load is met by
    correcting the approach after every sweep.

    Attributes:
        band: Cells on either side whose influence within a strip is solved for; the
            rest is taken from the sweep before. `None`: all.
        clip: Solve, then set negative pressures to zero, as printed; else find which
            cells of the strip are in contact.
        along: Whether strips run along the generatrix, or across it.
        relaxation: Share of the new strip that is taken.
        tolerance: Largest change of pressure in a sweep, and load missing, over the
            largest pressure and the load.
        max_steps: Limit of sweeps.

    Static: all fields.
    Source: Mi & Xia (2011), eq. (8) and (9), restored; the active set is our own.
    """

    band: int | None = eqx.field(static=True, default=None)
    clip: bool = eqx.field(static=True, default=False)
    along: bool = eqx.field(static=True, default=True)
    relaxation: float = eqx.field(static=True, default=1.0)
    tolerance: float = eqx.field(static=True, default=1e-9)
    max_steps: int = eqx.field(static=True, default=2000)

    def init(self, problem: Problem) -> Any:
        grid = problem.grid
        if (
            not isinstance(problem.influence, EvenInfluence)
            or grid.symmetric
            or problem.moment is not None
        ):
            raise ValueError(
                "Strips: takes an even grid with `symmetric=False`, and no `moment`."
            )
        pressure = jnp.zeros_like(problem.gap)
        approach = jnp.zeros((), pressure.dtype)
        if problem.load is not None:
            # That of the mean pressure on all cells.
            pressure = pressure + problem.load / jnp.sum(grid.area)
            approach = jnp.mean(problem.influence(pressure) + problem.given_gap)
        one = jnp.ones((), pressure.dtype)
        return _State(pressure, approach, one, jnp.asarray(0, jnp.int32))

    def step(self, problem: Problem, state: Any) -> Any:
        table = _table(problem)
        given, pressure = problem.given_gap, state.pressure
        if problem.load is not None:
            given = given - state.approach
        if not self.along:
            table, given, pressure = table.T, given.T, pressure.T
        strips, n = pressure.shape
        place = np.arange(n)
        apart = np.abs(place[:, None] - place[None])
        own = table[0][apart]
        near = own if self.band is None else jnp.where(apart <= self.band, own, 0.0)
        solve = self._clipped_solver(near) if self.clip else self._complementary(near)

        def update_strip(j, pressure):
            blocks = table[jnp.abs(jnp.arange(strips) - j)]
            # What all strips but this one, and its own far cells, displace.
            others = jnp.einsum("skl,sl->k", blocks[:, apart], pressure)
            old = pressure[j]
            right = -given[j] - others + near @ old
            new = solve(right)
            return pressure.at[j].set(old + self.relaxation * (new - old))

        new = lax.fori_loop(0, strips, update_strip, pressure)
        change = jnp.max(jnp.abs(new - pressure))
        change = change / jnp.maximum(jnp.max(new), jnp.finfo(new.dtype).tiny)
        new = new if self.along else new.T
        approach = state.approach
        if problem.load is not None:
            load = jnp.sum(problem.grid.area * new)
            off = problem.load / jnp.maximum(load, 0.1 * problem.load)
            # The load grows about linearly with the mean displacement it makes.
            rise = jnp.sum(new * problem.influence(new)) / jnp.sum(new)
            approach = approach + (jnp.minimum(off, 2.0) - 1.0) * rise
            change = jnp.maximum(change, jnp.abs(load / problem.load - 1.0))
        return _State(new, approach, change, state.steps + 1)

    def _clipped_solver(self, matrix):
        inverse = solve_any(matrix, jnp.eye(matrix.shape[0], dtype=matrix.dtype))
        return lambda right: jnp.maximum(inverse @ right, 0.0)

    def _complementary(self, matrix):
        identity = jnp.eye(matrix.shape[0], dtype=matrix.dtype) * matrix[0, 0]

        def update(carry):
            inside, _, _, count, right = carry
            system = jnp.where(inside[:, None], matrix, identity)
            pressure = solve_any(system, jnp.where(inside, right, 0.0))
            new = jnp.where(inside, pressure > 0, matrix @ pressure < right)
            return new, pressure, jnp.any(new != inside), count + 1, right

        def continues(carry):
            _, _, changed, count, _ = carry
            return changed & (count < _INNER)

        def solve(right):
            begin = (right > 0, jnp.zeros_like(right), jnp.asarray(True), 0, right)
            return jnp.maximum(lax.while_loop(continues, update, begin)[1], 0.0)

        return solve

    def terminate(self, problem: Problem, state: Any) -> Any:
        going = (state.change > self.tolerance) & jnp.isfinite(state.change)
        # Where it diverges, it does so by powers.
        going = going & (jnp.max(state.pressure) < _far_too_large(problem))
        return ~(going & (state.steps < self.max_steps))

    def finish(self, problem: Problem, state: Any) -> PressureSolution:
        done = state.change <= self.tolerance
        finite = jnp.isfinite(state.change)
        result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
        result = jnp.where(finite, result, int(Result.NON_FINITE))
        distance = problem.influence(state.pressure) + problem.given_gap
        rigid = jnp.zeros((0,), state.pressure.dtype)
        if problem.load is not None:
            distance, rigid = distance - state.approach, state.approach[None]
        inside = state.pressure > 0
        off = jnp.max(jnp.where(inside, jnp.abs(distance), jnp.maximum(-distance, 0)))
        load = jnp.sum(state.pressure)
        mean = jnp.sum(state.pressure * problem.influence(state.pressure)) / load
        return PressureSolution(
            state.pressure,
            inside,
            rigid,
            off / mean,
            state.steps,
            result.astype(jnp.int32),
        )


def _far_too_large(problem):
    """A pressure that no contact of this problem comes near [Pa]."""
    return 1e3 * jnp.max(jnp.abs(problem.given_gap)) / _table(problem)[0, 0]


def _table(problem):
    """Influence by distance of cells across and along (m, n) [m/Pa]."""
    m, n = problem.grid.shape
    sides = padded_size(m), padded_size(n)
    across, along = (
        jnp.asarray(cosine_sums(size)[:count] / size, problem.gap.dtype)
        for size, count in zip(sides, (m, n), strict=True)
    )
    return across @ problem.influence.kernel @ along.T

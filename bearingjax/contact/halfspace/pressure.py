"""The solved contact of two half-spaces: pressure, rigid motion and their derivatives.

Where cells are in contact, and stay so, pressure and rigid motion solve a linear
system: its derivative is one more such system with the same matrix, solved by
preconditioned conjugate gradients, forward or reverse.
"""

import equinox as eqx
import jax
import jax.flatten_util
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from ...design.checks import check
from ...numerics.compiled import batched_loop
from ...numerics.compiled.programs import program
from ...numerics.implicit import attach_by, stop_gradient
from ...numerics.labels import to_xarray
from ...numerics.linear import solve_symmetric
from ...numerics.result import Result, raise_unless_converged
from ...numerics.shown import Printable
from ...numerics.types import Count, Flag, Number, Scalar, Vector, as_real
from ...numerics.units import unit
from .gradients import (
    AbstractPressureSolver,
    ConjugateGradients,
    projected_pressure,
    rigid_fit,
)
from .grid import Grid
from .influence import AbstractInfluence
from .problem import Problem

_ENOUGH = 1e-12
"""Share of the residual, in the norm of the energy, at which a derivative is solved."""

_STEPS = 200
"""Limit of steps for a derivative; a score of them is usual."""

LEAST_CELLS = 3
"""A contact is at least so many cells wide, and long: of fewer the peak is off by more
than a tenth, up to a half."""


AT_SIDES = 1e-3
"""Share of the load that the cells at the sides of a grid may carry: a contact may just
reach them, where it bulges at a sharp end. Of 35 cells the peak is then off by less."""


class ContactSolution(Printable):
    """A solved contact.

    Attributes:
        problem: Solved problem.
        pressure: At every cell kept (m, n) [Pa].
        approach: Rigid approach at y = 0 [m].
        tilt: Rigid tilt, positive where it closes the gap at y > 0 [rad].
        touching: Which cells are in contact (m, n).
        residual: Largest gap inside the contact, or overlap outside, over the mean
            displacement of the loaded surface [1].
        steps: Iterations.
        result: `Result` code.

    With the contact's extent held, differentiable with respect to gap, load, moment or
    motion, material and the size of the grid; a failed solution has NaN derivatives.
    """

    problem: Problem = eqx.field(repr=False)
    pressure: Float[Array, "across along"] = eqx.field(metadata=unit("Pa"))
    approach: Scalar = eqx.field(metadata=unit("m"))
    tilt: Scalar = eqx.field(metadata=unit("rad"))
    touching: Bool[Array, "across along"]
    residual: Scalar = eqx.field(metadata=unit("1"))
    steps: Int[Array, ""]
    result: Int[Array, ""]

    to_xarray = to_xarray

    @property
    def failure_message(self) -> str:
        """Cause and cure of a failed solve of one contact; empty if it converged."""
        return _describe_failure(self)

    @property
    def grid(self) -> Grid:
        """The cells."""
        return self.problem.grid

    @property
    def converged(self) -> Flag:
        """Whether the result code is `CONVERGED`."""
        return self.result == Result.CONVERGED

    @property
    def line_load(self) -> Vector:
        """Load per length along the roller [N/m]."""
        width = 2.0 * self.grid.half_x * self.grid.times
        return jnp.sum(width[:, None] * self.pressure, axis=0)

    @property
    def load(self) -> Scalar:
        """Load [N]."""
        return jnp.sum(self.grid.area * self.pressure)

    @property
    def moment(self) -> Scalar:
        """Moment of the pressure about the middle y = 0 [N m]."""
        return jnp.sum(self.grid.area * self.pressure * self.grid.y[None])

    @property
    def peak_pressure(self) -> Scalar:
        """Largest pressure of a cell [Pa]; at a sharp end it grows as cells shrink."""
        return jnp.max(self.pressure)

    @property
    def centre_pressure(self) -> Vector:
        """Pressure at x = 0 along the roller [Pa].

        Of an even number of cells across, by the parabola through the inner ones.
        """
        grid = self.grid
        if grid.n_across % 2:
            middle = 0 if grid.symmetric else grid.n_across // 2
            return self.pressure[middle]
        inner, outer = self.pressure[0], self.pressure[1]
        if not grid.symmetric:
            half = grid.n_across // 2
            inner = 0.5 * (self.pressure[half] + self.pressure[half - 1])
            outer = 0.5 * (self.pressure[half + 1] + self.pressure[half - 2])
        return (9.0 * inner - outer) / 8.0

    @property
    def distance(self) -> Float[Array, "m n"]:
        """Distance of the deformed surfaces, zero in contact (m, n) [m]."""
        rigid = self.approach + self.tilt * self.grid.y
        return self.problem.influence(self.pressure) + self.problem.gap - rigid[None]

    @property
    def truncated(self) -> Flag:
        """Whether the contact reaches the sides of the grid: it should be wider.

        Where it carries more than a thousandth of the load there, it is not solved.
        """
        return _is_truncated(self.grid, self.touching)

    @property
    def cells(self) -> tuple[Count, Count]:
        """Most cells in contact, side by side across the roller, and along it."""
        return _cells(self.grid, self.touching)


def solve_pressure(
    influence: AbstractInfluence,
    gap: Float[Array, "m n"],
    *,
    load: Number | None = None,
    approach: Number | None = None,
    moment: Number | None = None,
    tilt: Number | None = None,
    solver: AbstractPressureSolver | None = None,
    throw: bool = True,
) -> ContactSolution:
    """Contact of two elastic bodies, both of them half-spaces where they touch.

    Args:
        influence: Influence of pressure on a grid, `influence(grid, modulus)`.
        gap: Distance of the bodies as they touch, at each cell kept (m, n) [m].
        load: Load [N], or:
        approach: Rigid approach at y = 0 [m]; one of both.
        moment: Moment of the pressure about y = 0 [N m], the contact then being free
            to tilt; needs `load`.
        tilt: Tilt [rad]; zero if neither it nor `moment` is given.
        solver: Default `ConjugateGradients()`.
        throw: Whether to raise if the solver does not converge.

    Returns:
        ContactSolution.

    Raises:
        ValueError: If not one of load and approach, or both of moment and tilt are
            given, or a number is out of range.
        SolveError: If `throw` and it did not converge.

    Fails: `STEP_LIMIT`, `NO_LOAD_PATH` (a negative load; a moment that no pressure on
        the grid balances), `NON_FINITE`, `GRID_MISFIT` (a contact with more than a
        thousandth of its load at the sides of the grid, or with fewer than three cells
        across it or along).
    Valid: Contact small against the bodies, no friction; both bodies go on beyond the
        grid's sides (at the sides of a punch leave cells with a wide gap), and one of
        them ends at its ends. float32: of a roller on 35 by
        64 graded cells pressures are good to 3e-4 of the peak, the peak to 3e-5 and
        the approach to 3e-6; fine even grids to 1e-4 in the approach.
    """
    name = "solve_pressure"
    if (load is None) == (approach is None):
        raise ValueError(f"{name}: give one of `load` and `approach`.")
    if moment is not None and (tilt is not None or load is None):
        raise ValueError(f"{name}: `moment` goes with `load`, and without `tilt`.")
    if gap.shape != influence.grid.shape:
        raise ValueError(
            f"{name}: `gap` has shape {gap.shape}; the grid keeps"
            f" {influence.grid.shape} cells."
        )
    if load is not None:
        check(name, "load", load >= 0, "zero or more", load, "N")
    dtype = gap.dtype

    def real(value):
        return None if value is None else jnp.asarray(as_real(value), dtype)

    if moment is None and tilt is None:
        tilt = 0.0
    problem = Problem(
        influence, gap, real(load), real(approach), real(moment), real(tilt)
    )
    solution = _solve(problem, ConjugateGradients() if solver is None else solver)
    if not throw:
        return solution
    return raise_unless_converged(
        solution, solution.result, lambda: solution.failure_message, "solve_pressure"
    )


@program
def _solve(problem, solver):
    dtype = problem.gap.dtype
    pressed = batched_loop.run(solver.loop(), stop_gradient(problem))
    result = pressed.result
    solved = result == int(Result.CONVERGED)
    misfit = solved & ~_grid_fits(problem.grid, pressed)
    result = jnp.where(misfit, int(Result.GRID_MISFIT), result).astype(result.dtype)
    # What failed has no derivative: NaN.
    good = solved & ~misfit
    inside = jnp.where(good, pressed.touching.astype(dtype), jnp.nan)
    pressure, rigid = attach_by(
        _balance, (pressed.pressure, pressed.rigid), (problem, inside), _correction
    )
    moved, turned = problem.motion(rigid)
    return ContactSolution(
        problem,
        pressure,
        moved,
        turned,
        pressed.touching,
        pressed.residual,
        pressed.steps,
        result,
    )


def _is_truncated(grid, touching):
    sides = touching[-1:]
    if not grid.symmetric:
        sides = jnp.concatenate([sides, touching[:1]])
    return jnp.any(sides)


def _cells(grid, touching):
    count = touching.astype(jnp.int32)
    times = grid.times.astype(jnp.int32)[:, None]
    return jnp.max(jnp.sum(times * count, axis=0)), jnp.max(jnp.sum(count, axis=1))


def _grid_fits(grid, pressed):
    """Whether the grid holds the contact, and its cells are small enough for it."""
    across, along = _cells(grid, pressed.touching)
    resolved = across >= LEAST_CELLS
    resolved = resolved & (along >= min(LEAST_CELLS, grid.shape[1]))
    loads = jnp.sum(grid.area * pressed.pressure, axis=1)
    sides = loads[-1] if grid.symmetric else loads[0] + loads[-1]
    held = sides <= AT_SIDES * jnp.sum(loads)
    return (resolved & held) | ~jnp.any(pressed.touching)


def _describe_failure(solution: ContactSolution) -> str:
    result = Result(int(solution.result))
    if result is Result.CONVERGED:
        return ""
    if result is Result.NO_LOAD_PATH:
        return (
            "No pressure carries this: the load is negative, or the moment asks for a"
            " centre of pressure beyond the ends of the contact."
        )
    if result is Result.NON_FINITE:
        return (
            "The contact is not finite: look for NaN or infinity in gap and load, or a"
            " grid that is wider than the roller, or not of its length."
        )
    if result is Result.GRID_MISFIT:
        return _misfit_message(solution)
    return (
        f"The contact did not converge in {int(solution.steps)} steps (residual"
        f" {float(solution.residual):.1e}): allow more `max_steps`, or a larger"
        " `tolerance`."
    )


def _misfit_message(solution):
    across, along = (int(count) for count in solution.cells)
    if min(across, along) < min(LEAST_CELLS, solution.grid.shape[1]):
        return (
            f"The contact is {across} by {along} cells, too few for its pressure:"
            f" at least {LEAST_CELLS} across it and along. Take a narrower grid, or"
            " more cells; if it is short beside the roller, even ones (`grading` 1)."
        )
    return (
        "The contact reaches the sides of the grid, and what it carries beyond them is"
        " missing: take a wider grid; where that is wider than roller or raceway, the"
        " bodies are no half-spaces."
    )


def _balance(unknowns, args):
    """Residual: distance in contact, pressure outside of it, missing load."""
    pressure, rigid = unknowns
    problem, inside = args
    carried = inside * pressure
    distance = problem.influence(carried) + problem.given_gap
    distance = distance - jnp.einsum("k,kmn->mn", rigid, problem.modes)
    sums = jnp.einsum("kmn,mn->k", problem.weighted_modes, carried)
    # With these weights the derivative is symmetric.
    parts = problem.grid.area * (inside * distance + (1.0 - inside) * pressure)
    return parts, problem.goal.astype(sums.dtype) - sums


def _correction(of_unknowns, unknowns, change, args):
    problem, inside = stop_gradient(args)
    touching = inside > 0
    poison = 0.0 * jnp.sum(inside)

    # One vector: a part of the change may be zero by structure: it has no transpose.
    vector, tree = jax.flatten_util.ravel_pytree(change)

    def solve(_, right):
        wanted, missing = tree(right)
        wanted = wanted / problem.grid.area
        pressure, rigid = _linear(problem, touching, wanted, -missing)
        both = jnp.where(touching, pressure, wanted), rigid
        return jax.flatten_util.ravel_pytree(both)[0] + poison

    _, linear = jax.linearize(of_unknowns, unknowns)

    def matvec(flat):
        return jax.flatten_util.ravel_pytree(linear(tree(flat)))[0]

    return tree(-lax.custom_linear_solve(matvec, vector, solve, solve, symmetric=True))


def _linear(problem, touching, wanted, carried):
    """Pressure in contact, and rigid motion, for a displacement less that motion.

    Preconditioned conjugate gradients that keep load and moment.

    Args:
        problem: Whose contact.
        touching: Cells in contact.
        wanted: Displacement in contact [m].
        carried: Load, and moment over the lever, of the pressure (k,) [N].
    """
    area, modes = problem.grid.area, problem.modes
    wanted = jnp.where(touching, wanted, 0.0)
    start = jnp.zeros_like(wanted)
    if modes.shape[0]:
        fields = problem.influence.estimate(jnp.where(touching[None], modes, 0.0))
        fields = jnp.where(touching[None], fields, 0.0)
        matrix = jnp.einsum("kmn,lmn->kl", problem.weighted_modes, fields)
        share = solve_symmetric(matrix, carried)
        start = jnp.einsum("k,kmn->mn", share, fields)

    def subtract_rigid(rest):
        # What is rigid in it cancels in the projection, but for its round-off.
        rigid = rigid_fit(problem, touching, rest)
        rest = rest - jnp.einsum("k,kmn->mn", rigid, modes)
        return jnp.where(touching, rest, 0.0), rigid

    def rest_of(pressure):
        return subtract_rigid(problem.influence(pressure) - wanted)

    def continues(carry):
        *_, fall, first, steps = carry
        # Round-off may turn it negative, which ends it as well.
        return (fall > _ENOUGH**2 * first) & (steps < _STEPS)

    def step(carry):
        pressure, rest, direction, fall, first, steps = carry
        pushed = jnp.where(touching, problem.influence(direction), 0.0)
        stiff = jnp.sum(area * direction * pushed)
        length = fall / jnp.where(stiff > 0, stiff, 1.0)
        pressure = pressure - length * direction
        rest, _ = subtract_rigid(rest - length * pushed)
        steepest = projected_pressure(problem, touching, rest)
        new = jnp.sum(area * rest * steepest)
        direction = steepest + new / jnp.where(fall > 0, fall, 1.0) * direction
        return pressure, rest, direction, new, first, steps + 1

    rest, _ = rest_of(start)
    steepest = projected_pressure(problem, touching, rest)
    fall = jnp.sum(area * rest * steepest)
    # Round-off of what `start` displaces bounds what can be had.
    scale = jnp.sum(area * jnp.abs(start * problem.influence(start)))
    begin = (start, rest, steepest, fall, fall + scale, jnp.asarray(0))
    pressure, *_, fall, first, _ = lax.while_loop(continues, step, begin)
    # A part that is NaN ends the loop at once, as if there were nothing to do.
    settled = fall <= jnp.finfo(fall.dtype).eps * first
    pressure = jnp.where(settled, pressure, jnp.nan)
    return pressure, rest_of(pressure)[1]

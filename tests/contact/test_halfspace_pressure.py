"""Solved contacts of half-spaces: balance, convergence to Hertz, derivatives.

Published boundary-element runs are validation cases: `mi_xia_taper`, `half_space_*`.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.contact.halfspace import (
    ConjugateGradients,
    Grid,
    RollerContact,
    even_grid,
    influence,
    solve_pressure,
)
from bearingjax.numerics.result import SolveError

STEEL = bj.Material(elastic_modulus=210e9)
MODULUS = 210e9 / (2 * (1 - 0.3**2))
PAIR = {"material": STEEL, "raceway_material": STEEL}
HALF_WIDTH = 0.1764e-3  # 1.6 times Hertz's at 3000 N


@pytest.fixture(scope="module")
def taper():
    contact = RollerContact(0.015, 0.010, 0.012, half_angle=np.deg2rad(3.0), **PAIR)
    (told,) = contact.warnings
    assert "is 3°, but" in told and "make 3.814°" in told
    return contact


@pytest.fixture(scope="module")
def paper(taper):
    """The published case on its own grid of 35 x 35."""
    return taper.solve(3000.0, grid=taper.grid(HALF_WIDTH, 35, 35, grading=1.0))


def test_complementarity(paper):
    """No gap in contact, none negative, load exact."""
    inside, pressure = np.asarray(paper.touching), np.asarray(paper.pressure)
    distance = np.asarray(paper.distance)
    assert np.abs(distance[inside]).max() < 1e-15 and distance.min() > -1e-15
    assert pressure.min() >= 0 and np.all(pressure[~inside] == 0)
    assert float(paper.load) == pytest.approx(3000.0, rel=ROUNDING)
    assert not paper.truncated and paper.steps < 40


def test_moment_tilt_and_approach_agree(taper):
    """What moved the roller is what holds it there."""
    grid = taper.grid(HALF_WIDTH)
    tilted = taper.solve(3000.0, moment=0.0, grid=grid)
    assert float(tilted.moment) == pytest.approx(0.0, abs=1e-9)
    held = taper.solve(3000.0, tilt=tilted.tilt, grid=grid)
    assert float(held.moment) == pytest.approx(0.0, abs=1e-7)
    pushed = taper.solve(approach=held.approach, tilt=tilted.tilt, grid=grid)
    assert float(pushed.load) == pytest.approx(3000.0, rel=1e-7)


def test_a_batch_is_single_solves(taper):
    grid = taper.grid(HALF_WIDTH, 35, 35, grading=1.0)
    matrix, gap = influence(grid, taper.modulus), taper.gap(grid)

    def solve(load):
        return solve_pressure(matrix, gap, load=load, throw=False)

    loads = jnp.array([1000.0, 2000.0, 0.0])
    batch = jax.jit(jax.vmap(solve))(loads)
    single = taper.solve(2000.0, grid=grid)
    assert batch.steps[1] == single.steps and not batch.pressure[2].any()
    np.testing.assert_allclose(
        batch.pressure[1], single.pressure, rtol=SOLVER, atol=1e-3
    )


def sphere(n):
    """Errors of peak pressure and approach, n cells each way."""
    load, radius = 100.0, 0.010
    half = (0.75 * load * radius / MODULUS) ** (1.0 / 3.0)
    grid = even_grid(2.5 * half, 1.25 * half, n, n)
    gap = (grid.x[:, None] ** 2 + grid.y[None] ** 2) / (2.0 * radius)
    solution = solve_pressure(influence(grid, MODULUS), gap, load=load)
    peak = 1.5 * load / (np.pi * half**2)
    return (
        float(solution.peak_pressure) / peak - 1.0,
        float(solution.approach) / (half**2 / radius) - 1.0,
    )


def test_sphere_converges_to_hertz():
    coarse, fine = sphere(33), sphere(129)
    assert fine == pytest.approx((1.4e-5, -1.7e-5), abs=2e-6)
    # Second order, but for how the cells happen to lie at the rim.
    assert abs(coarse[1]) > 8 * abs(fine[1])


@pytest.mark.parametrize("preconditioned", [True, False])
def test_with_and_without_preconditioner(taper, paper, preconditioned):
    solver = ConjugateGradients(preconditioned=preconditioned)
    solution = taper.solve(3000.0, grid=paper.grid, solver=solver)
    np.testing.assert_allclose(solution.pressure, paper.pressure, rtol=1e-7)
    assert (solution.steps < 40) == preconditioned


@pytest.mark.parametrize(
    "given",
    [
        {"load": 2000.0, "tilt": 7e-5},
        {"load": 2000.0, "moment": 0.7},
        {"approach": 8e-6, "tilt": 7e-5},
    ],
)
@pytest.mark.slow
def test_derivatives(given):
    """By what is given, sizes, profile and modulus; graded cells; three raceways."""

    def outcome(v, radius):
        kept = {k: x * f for (k, x), f in zip(given.items(), v[:2], strict=True)}
        roller = RollerContact(
            0.012 * v[2],
            0.010 * v[3],
            0.011 * v[3],
            roller_profile=bj.CircularCrown(2.0 * v[4]),
            raceway_radius=radius + 1e-2 * v[5],
            raceway_half_angle=0.05 * v[6],
            material=bj.Material(elastic_modulus=210e9 * v[7]),
        )
        grid = roller.grid(0.3e-3 * v[8], 15, 20)
        solution = roller.solve(**kept, grid=grid, throw=False)
        p = solution.pressure
        return jnp.stack(
            [
                1e-9 * jnp.sum(p**8) ** 0.125,
                1e6 * solution.approach,
                1e-3 * solution.load,
                solution.moment,
                1e4 * solution.tilt,
            ]
        )

    function = jax.jit(outcome)
    backward, onward = jax.jit(jax.jacrev(outcome)), jax.jit(jax.jacfwd(outcome))
    point = jnp.ones((9,))
    # Plane, convex, hollow.
    for radius in jnp.array([jnp.inf, 0.03, -0.06]):
        reverse = np.asarray(backward(point, radius))
        size = np.abs(reverse).max(axis=1, keepdims=True)
        forward = np.asarray(onward(point, radius))
        np.testing.assert_allclose(forward / size, reverse / size, atol=SOLVER)
        # V-shaped: the least error over the steps, where no cell comes or goes.
        least = np.full(reverse.shape, np.inf)
        for step in (1e-3, 1e-4, 1e-5, 1e-6):
            rows = [
                (
                    function(point + step * e, radius)
                    - function(point - step * e, radius)
                )
                / (2 * step)
                for e in np.eye(9)
            ]
            error = np.abs(np.stack(rows, 1) - reverse) / size
            least = np.minimum(least, error)
        assert least.max() < DIFFERENCE
        # Nothing comes of another plane.
        assert (reverse[0, 5] == 0) == (radius == jnp.inf)


def test_solve_pressure_derivative_is_nan_for_nan_tangent(taper):
    """NaN among what a derivative is asked for is not taken for a solved one."""
    grid = taper.grid(HALF_WIDTH, 9, 12)
    matrix, gap = influence(grid, taper.modulus), taper.gap(grid)

    def peak(gap):
        return solve_pressure(matrix, gap, load=3e3, throw=False).peak_pressure

    _, change = jax.jvp(peak, (gap,), (gap.at[0, 3].set(jnp.nan),))
    assert np.isnan(change)


def test_roller_contact_solve_without_load_and_invalid_loads(taper):
    grid = taper.grid(HALF_WIDTH, 9, 12)
    zero = taper.solve(0.0, grid=grid)
    assert not zero.pressure.any() and float(zero.load) == 0.0
    assert np.isfinite(float(zero.approach)) and zero.converged
    apart = taper.solve(approach=-1e-6, grid=grid)
    assert float(apart.load) == 0.0 and apart.converged
    with pytest.raises(SolveError, match="centre of pressure beyond the ends"):
        taper.solve(100.0, moment=1.0, grid=grid)
    found = taper.solve(100.0, moment=1.0, grid=grid, throw=False)
    assert found.result == bj.Result.NO_LOAD_PATH
    with pytest.raises(ValueError, match="`load` is nan"):
        taper.solve(jnp.nan, grid=grid)
    traced = jax.jit(lambda load: taper.solve(load, grid=grid, throw=False))
    assert traced(jnp.nan).result == bj.Result.NON_FINITE
    short = ConjugateGradients(max_steps=3)
    with pytest.raises(SolveError, match="did not converge in 3 steps"):
        taper.solve(100.0, grid=grid, solver=short)


def test_roller_contact_reports_grid_misfit(taper):
    """Too narrow, the pressure piles up at its sides; too wide, it has no shape."""

    def peak(width, load):
        grid = taper.grid(width, 9, 12)
        solution = taper.solve(load, grid=grid, throw=False)
        return solution.peak_pressure, (solution.result, solution.truncated)

    solve = jax.jit(jax.vmap(jax.value_and_grad(peak, has_aux=True)))
    factors = jnp.array([0.3, 1.0, 8.0, 0.3])
    (_, (codes, truncated)), slopes = solve(
        HALF_WIDTH * factors, jnp.array([3000.0, 3000.0, 3000.0, 100.0])
    )
    labels = [bj.Result(int(code)).label for code in codes]
    assert labels == ["grid_misfit", "converged", "grid_misfit", "converged"]
    assert np.array_equal(np.isfinite(slopes), [False, True, False, True])
    # Wide enough, but for the bulge of a sharp end.
    assert np.array_equal(truncated, [True, True, False, False])
    with pytest.raises(SolveError, match="reaches the sides of the grid"):
        taper.solve(3000.0, grid=taper.grid(0.3 * HALF_WIDTH, 9, 12))
    with pytest.raises(SolveError, match="is 1 by 12 cells, too few"):
        taper.solve(3000.0, grid=taper.grid(8 * HALF_WIDTH, 9, 12))


def test_a_contact_short_beside_the_roller():
    """Of a strong crown: cells long in the middle halve its pressure, and say so."""
    crown = RollerContact(
        0.015, 0.010, 0.010, roller_profile=bj.CircularCrown(0.02), **PAIR
    )
    with pytest.raises(SolveError, match="by 2 cells, too few"):
        crown.solve(100.0)
    width = crown.grid_half_width({"load": 100.0})
    solution = crown.solve(100.0, grid=crown.grid(width, 35, 401, 1.0))
    hertz = bj.contact.ellipse(
        jnp.asarray(1 / 0.005), jnp.asarray(1 / 0.02), crown.modulus
    )
    peak = float(hertz.peak_pressure(jnp.asarray(100.0)))
    assert float(solution.peak_pressure) == pytest.approx(peak, rel=2e-3)


def test_a_grid_of_another_roller(taper):
    """Refused; traced, no pressure comes of it."""
    other = RollerContact(0.010, 0.010, 0.012, **PAIR).grid(HALF_WIDTH, 9, 12)
    with pytest.raises(ValueError, match=r"`grid` is 0\.01 m; it must be as long as"):
        taper.solve(3000.0, grid=other)
    with pytest.raises(ValueError, match="0.015 m, and centred"):
        taper.gap(Grid(HALF_WIDTH, other.edges + 0.0025, 9, True, False))
    own = taper.grid(HALF_WIDTH, 9, 12)

    @jax.jit
    def solve(length):
        cells = Grid(HALF_WIDTH, own.edges * length, 9, True, False)
        return taper.solve(3000.0, grid=cells, throw=False)

    assert solve(1.0).converged
    assert solve(0.9).result == bj.Result.NON_FINITE


def test_solve_pressure_batch_isolates_invalid_loads(taper):
    grid = taper.grid(HALF_WIDTH, 9, 12)
    matrix, gap = influence(grid, taper.modulus), taper.gap(grid)

    def approach(load):
        return solve_pressure(matrix, gap, load=load, throw=False).approach

    loads = jnp.array([500.0, jnp.nan, -5.0, 1000.0])
    values, slopes = jax.jit(jax.vmap(jax.value_and_grad(approach)))(loads)
    good = np.array([True, False, False, True])
    assert np.array_equal(np.isfinite(slopes), good)
    assert np.all(np.isfinite(np.asarray(values)[good]))


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({}, "one of `load` and `approach`"),
        ({"load": 1.0, "approach": 1e-6}, "one of `load` and `approach`"),
        ({"approach": 1e-6, "moment": 1.0}, "`moment` goes with `load`"),
        ({"load": 1.0, "moment": 1.0, "tilt": 0.0}, "without `tilt`"),
        ({"load": -1.0}, "`load` is -1"),
    ],
)
def test_wrong_calls(taper, given, text):
    with pytest.raises(ValueError, match=text):
        taper.solve(**given, grid=taper.grid(HALF_WIDTH, 9, 12))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"roller_length": 0.0}, "roller_length"),
        ({"large_diameter": 0.009}, "at least `small_diameter`"),
        ({"raceway_radius": -0.004}, "larger in size than the roller's own"),
        ({"raceway_radius": 0.0}, "raceway_radius"),
        ({"half_angle": 1.0}, "half_angle"),
    ],
)
def test_wrong_rollers(change, text):
    good = {"roller_length": 0.015, "small_diameter": 0.010, "large_diameter": 0.010}
    with pytest.raises(ValueError, match=text):
        RollerContact(**(good | change))
    with pytest.raises(ValueError, match="less than the roller's"):
        roller = RollerContact(**good)
        roller.solve(1.0, grid=roller.grid(0.006))
    with pytest.raises(ValueError, match="give a `grid` under jit"):
        jax.jit(lambda load: RollerContact(**good).solve(load).load)(1.0)
    with pytest.raises(ValueError, match="give a `grid` under jit"):
        wide = good | {"small_diameter": 0.009}
        jax.grad(
            lambda d: RollerContact(**wide | {"large_diameter": d}).solve(1.0).approach
        )(0.010)

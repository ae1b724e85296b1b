"""Half-space contact: orders of convergence, precision, profile derivatives, batches.

Sources: Hertz (sphere, ellipse, endless line); the same solver in float64 for float32,
one case at a time for batches, differences for derivatives. What cells lie inside the
rim of a contact changes irregularly with their size: errors are averaged over eight
sizes within ±10 %, on one shape of grid whose sides move.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.contact import half_width, peak_pressure
from bearingjax.contact.halfspace import (
    Grid,
    RollerContact,
    even_grid,
    influence,
    solve_pressure,
)

STEEL = bj.Material(elastic_modulus=210e9)
PAIR = {"material": STEEL, "raceway_material": STEEL}
MODULUS = 210e9 / (2 * (1 - 0.3**2))
NEAR = np.geomspace(0.9, 1.1, 8)
RADIUS, LINE_LOAD = 0.005, 2e5
HERTZ = jnp.asarray(LINE_LOAD), jnp.asarray(RADIUS), jnp.asarray(MODULUS)
WIDTH, PEAK = float(half_width(*HERTZ)), float(peak_pressure(*HERTZ))


def order(sizes, errors):
    """Slope of errors over sizes, both logarithmic."""
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def averaged(errors, sizes):
    """Root mean squares over sizes near to each given one (size, error)."""
    return np.array(
        [
            np.sqrt(np.mean([np.square(errors(size * near)) for near in NEAR], axis=0))
            for size in sizes
        ]
    )


@pytest.mark.parametrize(
    ("curvatures", "load", "last"),
    [
        ((100.0, 100.0), 100.0, (3.1e-5, 2.5e-5)),
        ((1 / 5.5e-3, 10.0), 1000.0, (3.4e-5, 2.3e-5)),
    ],
    ids=["sphere", "ellipse"],
)
@pytest.mark.slow
def test_point_contact_is_of_second_order(curvatures, load, last):
    """Peak pressure and approach against Hertz; 10 to 80 cells across the contact."""
    along_x, along_y = curvatures
    hertz = bj.contact.ellipse(*(jnp.asarray(v) for v in (*curvatures, MODULUS)))
    a, b = sorted(float(v) for v in hertz.semi_axes(jnp.asarray(load)))
    want = (
        float(hertz.peak_pressure(jnp.asarray(load))),
        float(hertz.approach(jnp.asarray(load))),
    )

    def errors(across):
        grid = even_grid(2 * b * 97 / across, a * 97 / across, 97, 97)
        gap = 0.5 * (along_x * grid.x[:, None] ** 2 + along_y * grid.y[None] ** 2)
        solution = solve_pressure(influence(grid, MODULUS), gap, load=load)
        found = float(solution.peak_pressure), float(solution.approach)
        return np.array(found) / want - 1.0

    sizes = (10, 20, 40, 80)
    found = averaged(errors, sizes)
    for error in found.T:
        # Measured: -2.09 and -2.11 of the sphere, -2.12 and -2.14 of the ellipse.
        assert -2.3 < order(sizes, error) < -1.9
    # As measured: an error that grows is noticed, though its order stays.
    np.testing.assert_allclose(found[-1], last, rtol=0.1)


def strip(length, across):
    """Errors for even pressure along a length, both over and in half widths.

    One cell as long as the roller: what is left of an endless line is that the mean
    displacement lacks some at the ends, a share that falls with 1/length.
    """
    half = 0.5 * length * WIDTH
    grid = Grid(WIDTH * 255 / across, jnp.array([-half, half]), 255, True, False)
    gap = grid.x[:, None] ** 2 / (2.0 * RADIUS)
    load = LINE_LOAD * length * WIDTH
    solution = solve_pressure(influence(grid, MODULUS), gap, load=load)
    # Mean over the length of a half-space's displacement at x = 0, without the ends.
    approach = 2.0 * LINE_LOAD / (np.pi * MODULUS) * (np.log(4.0 * length) - 0.5)
    found = float(solution.peak_pressure), float(solution.approach)
    return np.array(found) / (PEAK, approach) - 1.0


def test_endless_line():
    """Against Hertz's line: first order in 1/length, second in the cells across."""
    lengths = (10, 30, 100, 300)
    by_length = np.array([strip(length, 160.0) for length in lengths])
    assert order(lengths, by_length[:, 0]) == pytest.approx(-1.0, abs=0.02)
    assert by_length[:, 0] * lengths == pytest.approx(0.3, abs=0.01)
    # Its logarithm grows with the length, too.
    assert -1.3 < order(lengths, by_length[:, 1]) < -1.1
    sizes = (10, 20, 40, 80, 160)
    by_size = averaged(lambda across: strip(1e6, across), sizes)
    # Measured: -2.15 and -2.04.
    for error in by_size.T:
        assert -2.3 < order(sizes, error) < -1.9
    # Errors as measured.
    assert by_size[-1] == pytest.approx((5.0e-6, 8e-7), rel=0.1)


def test_long_straight_roller():
    """Mid-length pressure, square ends on a plane, lengths of 4 to 1024 half widths.

    It is Hertz's of the load per length that is there, but for 1/length^2 of what that
    load varies. The load itself nears its mean but slowly, about as 1/log(length): the
    ends of a slender body draw load from all of it.
    """
    lengths = np.array([4.0, 8.0, 16.0, 32.0, 128.0, 1024.0])
    local, share, nominal = np.zeros((3, lengths.size))
    for i, length in enumerate(lengths):
        roller = RollerContact(length * WIDTH, 2 * RADIUS, 2 * RADIUS, **PAIR)
        for wide in np.geomspace(1.5, 1.8, 4):
            grid = roller.grid(wide * WIDTH, 201, 31)
            solution = roller.solve(LINE_LOAD * length * WIDTH, grid=grid)
            pressure = float(solution.centre_pressure[15]) / PEAK
            carried = float(solution.line_load[15]) / LINE_LOAD
            local[i] += (pressure / np.sqrt(carried) - 1.0) / 4
            share[i] += (1.0 - carried) / 4
            nominal[i] += (1.0 - pressure) / 4
    # The leading stiffness of a slender contact; load varies as one over it.
    stiff = 2.0 * np.log(2.0 * lengths) + 1.0
    scaled = (local * lengths**2 * stiff)[:4]
    assert 0.44 < scaled.min() and scaled.max() < 0.52
    assert order(lengths[:4], local[:4]) == pytest.approx(-2.23, abs=0.05)
    assert np.abs(local[3:]).max() < 6e-5  # and what 120 cells across leave
    assert nominal == pytest.approx(
        (0.12286, 0.10262, 0.08284, 0.06663, 0.04467, 0.02802), abs=1e-4
    )
    np.testing.assert_allclose(1.0 - nominal, np.sqrt(1.0 - share), rtol=6e-3)
    assert 0.45 < (nominal * stiff).min() and (nominal * stiff).max() < 0.68


def single(tree):
    """All real numbers of it in float32."""
    return jax.tree.map(
        lambda x: x.astype(jnp.float32) if jnp.issubdtype(x.dtype, jnp.floating) else x,
        tree,
    )


@pytest.mark.parametrize(
    "profile",
    [bj.Straight(), bj.Logarithmic(), bj.CircularCrown(3.0)],
    ids=["straight", "logarithmic", "crown"],
)
@pytest.mark.parametrize("moment", [None, 1.0])
@pytest.mark.slow
def test_float32(profile, moment):
    """35 x 64 graded cells; errors against float64, over the peak where pressures.

    Measured, with and without the compiler's optimiser: no pressure off by more than
    3.0e-4, the peak by 3.3e-5, the approach by 3.0e-6, the tilt by 1.1e-9 rad, the
    moment of 3000 N by 1.2e-4 N m.
    """
    roller = RollerContact(0.015, 0.010, 0.010, roller_profile=profile, **PAIR)
    grid = roller.grid(0.2e-3)
    double = roller.solve(3000.0, moment=moment, grid=grid)
    found = single(roller).solve(3000.0, moment=moment, grid=single(grid))
    assert found.pressure.dtype == jnp.float32 and found.converged
    assert double.pressure.dtype == jnp.float64
    peak = float(double.peak_pressure)
    np.testing.assert_allclose(
        np.asarray(found.pressure, float) / peak, double.pressure / peak, atol=5e-4
    )
    assert float(found.peak_pressure) == pytest.approx(peak, rel=5e-5)
    assert float(found.approach) == pytest.approx(float(double.approach), rel=1e-5)
    # A sum of some thousand cells, in an order that depends on the processor.
    assert float(found.load) == pytest.approx(3000.0, rel=5e-6)
    assert float(found.tilt) == pytest.approx(float(double.tilt), abs=5e-9)
    assert float(found.moment) == pytest.approx(float(double.moment), abs=3e-4)


def test_float32_of_a_given_approach():
    """Nothing is sought then but pressure: no rigid motion, no load to be met."""
    roller = RollerContact(0.015, 0.010, 0.010, roller_profile=bj.CircularCrown(3.0))
    grid = roller.grid(0.2e-3, 9, 12)
    double = roller.solve(approach=8e-6, grid=grid)
    found = single(roller).solve(approach=8e-6, grid=single(grid))
    assert found.load.dtype == jnp.float32
    assert float(found.load) == pytest.approx(float(double.load), rel=1e-4)


def crowned(v):
    """Roller and raceway profiles by eight factors: arcs and a logarithm."""
    return {
        "roller_profile": bj.CrownedEnds(6e-3 * v[0], 0.8 * v[1], 1e-3, 0.3 * v[2]),
        "raceway_profile": bj.Logarithmic(1e-4 * v[3]),
    }


def logarithmic(v):
    """Of Fujiwara and Kawase, three parameters, on a crowned raceway."""
    return {
        "roller_profile": bj.FujiwaraKawase(3e3, 1.5 * v[0], 0.6 * v[1], 2e-5 * v[2]),
        "raceway_profile": bj.CircularCrown(8.0 * v[3]),
    }


@pytest.mark.parametrize("profiles", [crowned, logarithmic])
def test_profile_derivatives(profiles):
    """Peak, pressure at mid-length and moment by profile parameters, at a given tilt.

    Differences are V-shaped over their steps: truncation, or cells that come and go,
    above, round-off below; the least counts.
    """

    def outcome(v):
        roller = RollerContact(0.012, 0.010, 0.010, **profiles(v), **PAIR)
        grid = roller.grid(0.25e-3, 15, 21)
        solution = roller.solve(2500.0, tilt=1e-4, grid=grid, throw=False)
        middle = solution.centre_pressure[10]
        values = 1e-9 * solution.peak_pressure, 1e-9 * middle, solution.moment
        return jnp.stack(values), solution.touching

    point = jnp.ones((4,))
    function = jax.jit(outcome)
    reverse, touching = jax.jit(jax.jacrev(outcome, has_aux=True))(point)
    forward = jax.jit(jax.jacfwd(outcome, has_aux=True))(point)[0]
    size = np.abs(reverse).max(axis=1, keepdims=True)
    np.testing.assert_allclose(forward / size, reverse / size, atol=SOLVER)
    least = np.full(reverse.shape, np.inf)
    for step in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
        rows = []
        for e in np.eye(4):
            (more, same), (less, also) = (
                function(point + side * step * e) for side in (1.0, -1.0)
            )
            kept = np.array_equal(same, touching) and np.array_equal(also, touching)
            rows.append((more - less) / (2 * step) if kept else np.full(3, np.inf))
        least = np.minimum(least, np.abs(np.stack(rows, 1) - reverse) / size)
    assert least.max() < DIFFERENCE


def test_eight_cases_at_once():
    """Loads and moments together, one of them so light that an end is free."""
    roller = RollerContact(
        0.015, 0.010, 0.010, roller_profile=bj.CircularCrown(2.0), **PAIR
    )
    grid = roller.grid(0.3e-3)

    def solve(load, moment):
        return roller.solve(load, moment=moment, grid=grid, throw=False)

    loads = jnp.array([50.0, 200.0, 500.0, 1e3, 2e3, 3e3, 4e3, 5e3])
    moments = jnp.array([0.1, 0.0, 0.5, -2.0, 3.0, 0.0, -1.0, 9.0])
    same(jax.jit(jax.vmap(solve))(loads, moments), solve, loads, moments)


def test_eight_rollers_at_once():
    """Crown and diameter differ from roller to roller; the cells are the same."""
    grid = RollerContact(0.015, 0.010, 0.010, **PAIR).grid(0.3e-3)

    def solve(crown, diameter):
        roller = RollerContact(
            0.015, diameter, diameter, roller_profile=bj.CircularCrown(crown), **PAIR
        )
        return roller.solve(3e3, moment=2.0, grid=grid, throw=False)

    crowns, diameters = jnp.geomspace(0.5, 20.0, 8), jnp.linspace(8e-3, 12e-3, 8)
    same(jax.jit(jax.vmap(solve))(crowns, diameters), solve, crowns, diameters)


def same(batch, solve, *cases):
    """Whether a batch is what its members are alone, pressures over their peaks."""
    for i, case in enumerate(zip(*cases, strict=True)):
        one, alone = jax.tree.map(lambda x, i=i: x[i], batch), solve(*case)
        assert one.converged and not one.truncated and one.steps == alone.steps
        peak = alone.peak_pressure
        np.testing.assert_allclose(
            one.pressure / peak, alone.pressure / peak, atol=SOLVER
        )
        for name in ("approach", "tilt", "load", "moment"):
            np.testing.assert_allclose(
                getattr(one, name), getattr(alone, name), rtol=SOLVER, atol=1e-14
            )

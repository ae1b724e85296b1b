"""Free end faces: images against a longer grid, the factor against a quarter-space."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
import quarter_space
from scipy.integrate import quad
from scipy.optimize import root_scalar
from slopes import with_slopes
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact.halfspace import (
    FreeEnds,
    Grid,
    RollerContact,
    even_grid,
    graded_grid,
    influence,
)
from bearingjax.contact.halfspace.ends import WEDGE

STEEL = bj.Material(210e9, 0.3)


@pytest.mark.parametrize("make", [even_grid, graded_grid])
def test_free_end_influence_matches_mirrored_pressure(make):
    """Mirrored pressure on three lengths, by the plain influence."""
    grid = make(0.01, 2e-4, 6, 8)
    edges = np.asarray(grid.edges)
    three = np.concatenate([-0.01 - edges[::-1][:-1], edges[:-1], 0.01 - edges[::-1]])
    long = Grid(grid.half_width, three, 6, True, False)
    pressure = np.random.default_rng(1).uniform(0, 1e9, grid.shape)
    share = 0.7
    tripled = np.concatenate(
        [share * pressure[:, ::-1], pressure, share * pressure[:, ::-1]], axis=1
    )
    wanted = influence(long, 1e11)(jnp.asarray(tripled))[:, 8:16]
    got = influence(grid, 1e11, lambda *_: share)(jnp.asarray(pressure))
    assert np.allclose(got, wanted, rtol=1e-10)
    # Mutual: areas times influence is symmetric.
    other = np.random.default_rng(2).uniform(0, 1e9, grid.shape)
    there = jnp.sum(grid.area * other * got)
    back = influence(grid, 1e11, lambda *_: share)(jnp.asarray(other))
    assert float(there) == pytest.approx(
        float(jnp.sum(grid.area * pressure * back)), rel=ROUNDING
    )


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_stress_on_the_end_face_is_boussinesqs(poisson):
    """Wave along the edge: Boussinesq's formula by quadrature, its image as well."""

    def stress(x, y, z):
        """Johnson, Contact Mechanics (1985), eq. (3.20)."""
        r, rho = np.hypot(x, y), np.sqrt(x * x + y * y + z * z)
        part = (1 - z / rho) * (y * y - x * x) / r**2 + z * x * x / rho**3
        return ((1 - 2 * poisson) * part / r**2 - 3 * z * y * y / rho**5) / (2 * np.pi)

    edge = quarter_space.Edge(poisson, 0.5)
    for i, j in ((48, 50), (50, 48), (50, 50), (52, 45)):
        z, y = edge.distance[[i, j]]
        wave, _ = quad(
            lambda x, y=y, z=z: 2 * stress(x, y, z), 0, np.inf, weight="cos", wvar=1.0
        )
        assert edge.pressed[i, j] == pytest.approx(-2 * wave, rel=1e-6)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
@pytest.mark.slow
def test_free_end_factor_matches_quarter_space(poisson):
    # The fit leaves 0.002, its rounding less.
    for row in quarter_space.run((poisson,), across=(0.0, 0.5, 2.0, 10.0, 30.0)):
        np.testing.assert_allclose(row["used"], row["found"], atol=0.003)
    for row in quarter_space.run((poisson,), step=0.2):
        finer = quarter_space.Edge(poisson).factors(np.log(row["times"]), (0.0,))
        assert row["found"][0] == pytest.approx(finer[0], abs=1e-4)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_quarter_space_edge_approaches_wedge(poisson):
    """Not built into the table: waves as long as it has."""
    edge = quarter_space.Edge(poisson)
    i, j = 80, 110
    grown = (edge.added[j, j] - edge.added[i, i]) / (edge.step * (i - j))
    # Measured: 1.6e-3, the table's lower end; mutual to 6e-6.
    assert 0.5 * grown == pytest.approx(WEDGE - 1.0, rel=3e-3)
    assert edge.added[150, 120] == pytest.approx(edge.added[120, 150], rel=1e-5)


def order_at_the_edge():
    """Exponent of the pressure under the edge of a quarter-plane on a half-plane.

    Both of one material, no friction: Dundurs & Lee, J. Elasticity 2 (1972), here from
    Williams' wedges under loads as r^(n - 1): compliances cancel.
    """

    def together(n):
        quarter = 0.5 * np.sin(np.pi * n) / (n**2 - np.sin(0.5 * np.pi * n) ** 2)
        return quarter - 1.0 / np.tan(np.pi * n)

    return 1.0 - root_scalar(together, bracket=(0.6, 0.95)).root


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_order_of_the_pressure_at_the_edge(poisson):
    """Of the quarter-space that the factor comes from, on a half-space, for a wave."""
    found = quarter_space.orders(quarter_space.Edge(poisson))
    # The ends of the table are too near to the edge, and to the length of the wave.
    np.testing.assert_allclose(found[80:110], order_at_the_edge(), atol=1.5e-4)


def test_order_of_the_pressure_at_a_free_end():
    """Approached as slowly as the wave above does: 0.19 at a hundredth of the width."""
    slopes = []
    for ends in (None, FreeEnds()):
        roller = RollerContact(0.015, 0.01, 0.01, free_ends=ends)
        contact = roller.solve(3000.0, grid=roller.grid(1.8e-4, 35, 96, 3.0))
        y = np.asarray(contact.grid.y) + 0.0075
        near = (y > 1e-6) & (y < 5e-6)
        pressure = np.asarray(contact.centre_pressure)[near]
        slopes.append(-np.polyfit(np.log(y[near]), np.log(pressure), 1)[0])
    # Both still fall short of their limits there, as the cells across show.
    assert slopes[0] == pytest.approx(0.5, abs=0.04)
    assert slopes[1] == pytest.approx(0.19, abs=0.03)


def test_free_end_influence_is_symmetric_and_traceable():
    """Places change sides; tables under jit are those made by NumPy."""
    roller = RollerContact(0.015, 0.01, 0.012, free_ends=FreeEnds())
    grid = roller.grid(2e-4, 9, 12)
    matrix = roller.influence(grid)
    traced = eqx.filter_jit(lambda r: r.influence(grid))(roller)
    # Differences of the table lose some digits far from zero.
    size = float(jnp.max(matrix.kernel))
    np.testing.assert_allclose(
        traced.kernel, matrix.kernel, rtol=1e-9, atol=1e-10 * size
    )
    one, other = np.random.default_rng(3).uniform(-1.0, 1.0, (2, *grid.shape)) * 1e9
    area = np.asarray(grid.area)

    def product(first, second):
        return float(np.sum(area * first * np.asarray(matrix(jnp.asarray(second)))))

    size = np.sqrt(product(one, one) * product(other, other))
    assert abs(product(one, other) - product(other, one)) < 1e-12 * size


def test_derivatives_by_materials_and_factor():
    grid = RollerContact(0.015, 0.01, 0.012).grid(2e-4, 9, 12)

    def approach(values, by_place):
        modulus, poisson, factor = values
        roller = RollerContact(
            0.015,
            0.01,
            0.012,
            material=bj.Material(210e9 * modulus, poisson),
            free_ends=FreeEnds() if by_place else FreeEnds(factor),
        )
        return 1e6 * roller.solve(3000.0, grid=grid).approach

    at, step = np.array([1.0, 0.3, 1.5]), 1e-4
    for by_place in (True, False):
        run = with_slopes(lambda v, by=by_place: approach(v, by))
        slopes, _ = run(jnp.asarray(at))
        for slope, move in zip(slopes, step * np.eye(3), strict=True):
            above, below = (float(run(jnp.asarray(at + m))[1]) for m in (move, -move))
            difference = (above - below) / (2 * step)
            assert float(slope) == pytest.approx(difference, rel=1e-6, abs=1e-6)


def test_a_soft_roller_with_free_ends():
    """Its mirrored pressure weighs more than its own; the matrix stays definite."""
    soft = bj.Material(3e9, 0.4)
    roller = RollerContact(0.015, 0.01, 0.012, material=soft, free_ends=FreeEnds())
    assert float(FreeEnds(2.0).weight(soft, STEEL).share) > 0.98
    contact = roller.solve(300.0)
    assert contact.converged and not contact.truncated
    assert float(jnp.min(contact.distance)) > -1e-6 * float(contact.approach)


def test_free_ends_are_softer_and_bear_less():
    found = []
    for ends in (None, FreeEnds(1.0), FreeEnds()):
        roller = RollerContact(
            0.015, 0.01, 0.012, material=STEEL, raceway_material=STEEL, free_ends=ends
        )
        found.append(roller.solve(3000.0, grid=roller.grid(1.8e-4)))
    approach = [float(s.approach) for s in found]
    ends = [float(s.centre_pressure[0]) for s in found]
    middle = [float(s.centre_pressure[32]) for s in found]
    assert approach[0] < approach[1] < approach[2] < 1.3 * approach[0]
    assert ends[0] > 2 * ends[1] > 3 * ends[2] > 3 * middle[2]
    assert middle[0] < middle[1] < middle[2]
    assert all(float(s.load) == pytest.approx(3000.0, rel=1e-11) for s in found)


def test_free_ends_weight_by_compliance_of_roller():
    rigid = bj.Material(1e30, 0.3)

    def weight(factor, roller):
        place = jnp.ones((1,))
        return float(FreeEnds(factor).weight(roller, STEEL)(place, place, place))

    assert weight(1.2, STEEL) == pytest.approx(0.6, rel=ROUNDING)
    assert weight(1.2, rigid) < 1e-15
    ceramic = bj.Material(310e9, 0.26)
    part = (0.9324 / 310) / (0.9324 / 310 + 0.91 / 210)
    assert weight(1.0, ceramic) == pytest.approx(part, rel=1e-9)


def test_free_ends_reject_negative_factor():
    with pytest.raises(ValueError, match="`factor` is -1; it must be above 0"):
        FreeEnds(-1.0)

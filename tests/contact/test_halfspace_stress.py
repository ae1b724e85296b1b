"""Stress below a contact, against integrals, Hertz and equilibrium.

One rectangle against the point load's stresses integrated over it; solved rollers and a
sphere against Hertz; the sums over planes against the load.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact import axis_stress, shear_below
from bearingjax.contact.halfspace import (
    RollerContact,
    even_grid,
    influence,
    solve_pressure,
    stress_below,
)
from bearingjax.contact.halfspace.stress import corner_stress

STEEL = bj.Material(210e9, 0.3)
MODULUS = 210e9 / 1.82


def boussinesq(x, y, z, nu):
    """Stress by a unit force at the origin (xx, yy, zz, xy, yz, zx).

    Source: Johnson, Contact Mechanics (1985), section 3.2.
    """
    square, rho = x**2 + y**2, np.sqrt(x**2 + y**2 + z**2)
    rest = (1 - 2 * nu) / square
    low, fall = 1 - z / rho, z / rho**3
    xx = rest * (low * (x**2 - y**2) / square + fall * y**2) - 3 * z * x**2 / rho**5
    yy = rest * (low * (y**2 - x**2) / square + fall * x**2) - 3 * z * y**2 / rho**5
    xy = rest * (low * 2 * x * y / square - fall * x * y) - 3 * x * y * z / rho**5
    cubes = -3 * z**3 / rho**5, -3 * y * z**2 / rho**5, -3 * x * z**2 / rho**5
    return np.array([xx, yy, cubes[0], xy, cubes[1], cubes[2]]) / (2 * np.pi)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_a_rectangle_is_the_integral_of_point_loads(nu):
    a, b = 1.0, 0.7
    nodes, weights = np.polynomial.legendre.leggauss(60)
    for x, y, z in ((0.3, 0.2, 0.5), (2.0, 1.5, 0.3), (-1.7, 0.9, 1.2), (0, 0, 3.0)):
        got = 0.0
        for sx, sy in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            at = [jnp.asarray(v) for v in (x + sx * a, y + sy * b, z, nu)]
            parts = corner_stress(at[0], at[1], at[2], at[3])
            got = got + sx * sy * np.array(parts)
        far = boussinesq(x - a * nodes[:, None], y - b * nodes[None], z, nu)
        wanted = np.einsum("kij,i,j->k", far, a * weights, b * weights)
        assert np.abs(got - wanted).max() < 1e-12


def test_corner_stress_is_finite_at_surface_and_edges():
    values = jnp.asarray([-1.0, 0.0, 1e-9, 1.0])
    u, v = (w.ravel() for w in jnp.meshgrid(values, values))
    for z in (0.0, 1e-12, 1.0):
        parts = corner_stress(u, v, jnp.asarray(z), jnp.asarray(0.3))
        # Right in a corner, at the surface, the shear stress is infinite.
        away = (u**2 + v**2 + z**2) > 0
        assert all(np.all(np.isfinite(part[away])) for part in parts)


@pytest.fixture(scope="module")
def line():
    roller = RollerContact(0.02, 0.01, 0.01, material=STEEL, raceway_material=STEEL)
    return roller.solve(3000.0, grid=roller.grid(1.6 * 87e-6))


def test_stress_below_long_roller_matches_hertz_line(line):
    """Largest shear and von Mises stress, and where, of the closed form."""
    middle = line.grid.shape[1] // 2
    pressure = float(line.centre_pressure[middle])
    half_width = 2 * 0.005 * pressure / MODULUS
    z = jnp.linspace(0.0, 2.0, 101) * half_width
    below = stress_below(line, 0.0, 0.0, z)
    places = np.asarray(z) / half_width
    root = np.sqrt(1 + places**2)
    wanted = np.stack([(1 + 2 * places**2) / root - 2 * places, 1 / root]) * -pressure
    xx, zz = wanted
    yy = 0.3 * (xx + zz)
    mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2))
    for got, want in (
        (below.greatest_shear, 0.5 * (xx - zz)),
        (below.von_mises, mises),
    ):
        top, place = int(got.argmax()), places[want.argmax()]
        assert float(got[top]) == pytest.approx(want.max(), rel=3e-3)
        assert places[top] == pytest.approx(place, abs=0.02)
    # All the way down, beside the coarse cells' own error at the surface.
    assert np.abs(np.stack([below.xx, below.zz]) - wanted).max() < 0.01 * pressure
    assert float(below.zz[0]) == pytest.approx(-pressure, rel=1e-9)


def test_stress_below_sphere_matches_hertz_point():
    radius, load = 0.01, 100.0
    half = np.cbrt(0.75 * load * radius / MODULUS)
    grid = even_grid(2.5 * half, 1.25 * half, 65, 65)
    gap = (grid.x[:, None] ** 2 + grid.y[None] ** 2) / (2 * radius)
    solved = solve_pressure(influence(grid, MODULUS), gap, load=load)
    z = jnp.linspace(0.1, 2.0, 96) * half
    below = stress_below(solved, 0.0, 0.0, z)
    pressure = 1.5 * load / (np.pi * half**2)
    across, along, normal = (
        np.asarray(part) * pressure
        for part in axis_stress(jnp.asarray(1.0), z / half, jnp.asarray(0.3))
    )
    for got, wanted in ((below.xx, across), (below.yy, along), (below.zz, normal)):
        assert np.abs(np.asarray(got) - wanted).max() < 3e-3 * pressure
    shear = shear_below(jnp.asarray(1.0), jnp.asarray(0.3))
    top = float(below.greatest_shear.max())
    assert top == pytest.approx(float(shear.greatest) * pressure, rel=2e-3)


def test_stress_below_integrates_to_load(line):
    """The normal stress over a wide plane: the load, and no force along the roller."""
    depth = 2e-3
    nodes, weights = np.polynomial.legendre.leggauss(80)
    # x = depth tan(t), y likewise beyond the roller: all of the plane.
    t, w = 0.5 * np.pi * nodes, 0.5 * np.pi * weights
    x, dx = 2 * depth * np.tan(t), 2 * depth * w / np.cos(t) ** 2
    y, dy = 0.01 * np.tan(t), 0.01 * w / np.cos(t) ** 2
    below = stress_below(line, jnp.asarray(x)[:, None], jnp.asarray(y)[None], depth)
    total = np.einsum("ij,i,j", np.asarray(below.zz), dx, dy)
    assert total == pytest.approx(-float(line.load), rel=1e-4)
    pull = np.einsum("ij,i,j", np.asarray(below.yz), dx, dy)
    assert abs(pull) < 1e-6 * float(line.load)


def test_stress_below_satisfies_equilibrium(line):
    """The divergence of the stress vanishes, by automatic derivatives."""

    def tensor(place):
        return stress_below(line, place[0], place[1], place[2]).tensor

    for place in ((2e-5, 1e-3, 6e-5), (5e-5, 9.97e-3, 4e-5)):
        slopes = np.asarray(jax.jacfwd(tensor)(jnp.asarray(place)))
        divergence = np.einsum("ijj->i", slopes)
        assert np.abs(divergence).max() < 1e-9 * np.abs(slopes).max()


def test_stress_below_symmetric_grid_matches_full_grid():
    roller = RollerContact(0.01, 0.01, 0.012, material=STEEL, raceway_material=STEEL)
    found = []
    for symmetric in (True, False):
        for count in (9, 10):
            grid = even_grid(0.01, 1.5e-4, count, 12, symmetric=symmetric)
            solved = roller.solve(2000.0, grid=grid)
            found.append(stress_below(solved, 3e-5, 2e-3, 5e-5).tensor)
    assert np.allclose(found[0], found[2], rtol=1e-8)
    assert np.allclose(found[1], found[3], rtol=1e-8)


def test_derivatives_and_bad_input(line):
    """Linear in the pressure: its derivative is the stress itself."""
    places = jnp.asarray([[2e-5, 1e-3, 6e-5]]).T

    def von_mises(factor):
        from equinox import tree_at

        more = tree_at(lambda s: s.pressure, line, line.pressure * factor)
        return jnp.sum(stress_below(more, *places).von_mises)

    value, slope = jax.value_and_grad(von_mises)(jnp.asarray(1.0))
    assert float(slope) == pytest.approx(float(value), rel=ROUNDING)
    assert float(jax.grad(von_mises)(jnp.asarray(0.0))) == 0.0
    with pytest.raises(ValueError, match="`z` is -1e-05"):
        stress_below(line, 0.0, 0.0, -1e-5)
    with pytest.raises(
        ValueError, match="`poisson` is 3; it must be above -1, at most"
    ):
        stress_below(line, 0.0, 0.0, 1e-5, poisson=3.0)


def test_a_solution_in_single_precision(line):
    """Beside float64: places are numbers of Python, and the stress is float32."""
    half = jax.tree.map(
        lambda x: x.astype(jnp.float32) if jnp.issubdtype(x.dtype, jnp.floating) else x,
        line,
    )
    found = stress_below(half, 0, 0.0, 6e-5).von_mises
    assert found.dtype == jnp.float32
    wanted = stress_below(line, 0, 0.0, 6e-5).von_mises
    assert float(found) == pytest.approx(float(wanted), rel=1e-4)

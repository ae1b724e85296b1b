"""Influence of pressure on a half-space: kernels, grids, products.

Sources: Love (1929) by brute-force quadrature and by partition; the far field of a
point load (Boussinesq). Acceptance fact AF004-1.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import dblquad
from tolerances import ROUNDING

from bearingjax.contact.halfspace import even_grid, graded_grid, influence
from bearingjax.contact.halfspace.love import love as love_of_arrays

MODULUS = 115.384615e9


def love(*sizes):
    """Of any mix of numbers and NumPy arrays."""
    arrays = (jnp.asarray(v) for v in np.broadcast_arrays(*sizes))
    return np.asarray(love_of_arrays(*arrays))


def test_partition_adds_up_and_far_field_is_a_point():
    x, y, a, b = 0.7, -0.4, 1.0, 0.5
    edges_x, edges_y = np.linspace(-a, a, 5), np.linspace(-b, b, 8)
    parts = [
        love(x - 0.5 * (u + v), y - 0.5 * (s + t), 0.5 * (v - u), 0.5 * (t - s))
        for u, v in zip(edges_x[:-1], edges_x[1:], strict=True)
        for s, t in zip(edges_y[:-1], edges_y[1:], strict=True)
    ]
    assert float(sum(parts)) == pytest.approx(float(love(x, y, a, b)), rel=ROUNDING)
    far = love(40.0, 30.0, a, a)
    assert float(far) == pytest.approx(4.0 * a * a / 50.0, rel=1e-4)


def test_middle_of_a_rectangle():
    a, b = 2e-3, 3e-4
    want = 4.0 * (a * np.arcsinh(b / a) + b * np.arcsinh(a / b))
    assert float(love(0.0, 0.0, a, b)) == pytest.approx(want, rel=ROUNDING)


def test_against_quadrature_beside_the_rectangle():
    x, y, a, b = 1.3, 0.9, 1.0, 0.6
    found = dblquad(
        lambda v, u: 1.0 / np.hypot(x - u, y - v), -a, a, -b, b, epsabs=1e-12
    )
    assert float(love(x, y, a, b)) == pytest.approx(found[0], rel=1e-10)


@pytest.mark.parametrize("n_across", [6, 7])
@pytest.mark.parametrize("symmetric", [True, False])
def test_even_products_are_the_sums_over_all_cells(n_across, symmetric):
    grid = even_grid(0.015, 0.2e-3, n_across, 9, symmetric=symmetric)
    field = np.random.default_rng(1).uniform(0.0, 1e9, grid.shape)
    x, y = np.asarray(grid.x), np.asarray(grid.y)
    a, b = float(grid.half_x), np.asarray(grid.half_y)[0]
    want = _sum(x, y, a, b, field, MODULUS)
    if symmetric:
        mirrored = np.where(x[:, None] > 0, field, 0.0)
        want = want + _sum(x, y, a, b, mirrored, MODULUS, sign=-1.0)
    found = influence(grid, MODULUS)(jnp.asarray(field))
    np.testing.assert_allclose(found, want, rtol=1e-11)


def _sum(x, y, a, b, field, modulus, sign=1.0):
    """Influence of cells at (sign·x, y) on points (x, y), one by one."""
    away = x[:, None, None, None] - sign * x[None, None, :, None]
    along = y[None, :, None, None] - y[None, None, None, :]
    kernel = np.asarray(love(away, along, a, b)) / (np.pi * modulus)
    return np.einsum("ijkl,kl->ij", kernel, field)


@pytest.mark.parametrize("symmetric", [True, False])
def test_graded_products_are_means_of_the_displacement(symmetric):
    grid = graded_grid(0.012, 0.3e-3, 7, 8, grading=2.5, symmetric=symmetric)
    field = np.random.default_rng(2).uniform(0.0, 1e9, grid.shape)
    x, y, half = (np.asarray(v) for v in (grid.x, grid.y, grid.half_y))
    nodes, weights = np.polynomial.legendre.leggauss(40)
    a = float(grid.half_x)
    want = np.zeros(grid.shape)
    for node, weight in zip(nodes, 0.5 * weights, strict=True):
        at = y + node * half
        for sign in (1.0, -1.0) if symmetric else (1.0,):
            part = field if sign > 0 else np.where(x[:, None] > 0, field, 0.0)
            away = x[:, None, None, None] - sign * x[None, None, :, None]
            along = at[None, :, None, None] - y[None, None, None, :]
            kernel = np.asarray(love(away, along, a, half)) / (np.pi * MODULUS)
            want += weight * np.einsum("ijkl,kl->ij", kernel, part)
    found = influence(grid, MODULUS)(jnp.asarray(field))
    # The quadrature meets a logarithm at the ends of cells.
    np.testing.assert_allclose(found, want, rtol=1e-5)


@pytest.mark.parametrize("make", [even_grid, graded_grid])
def test_influence_is_symmetric_positive_definite(make):
    grid = make(0.015, 0.2e-3, 9, 12)
    matrix = influence(grid, MODULUS)
    one, other = np.random.default_rng(3).uniform(-1.0, 1.0, (2, *grid.shape)) * 1e9
    area = np.asarray(grid.area)

    def product(function, first, second):
        return float(np.sum(area * first * np.asarray(function(jnp.asarray(second)))))

    for function in (matrix, matrix.estimate):
        there, back = product(function, one, other), product(function, other, one)
        size = np.sqrt(product(function, one, one) * product(function, other, other))
        assert abs(there - back) < 1e-10 * size
        assert product(function, one, one) > 0


def test_stacks_of_fields_and_size_of_the_grid():
    grid = graded_grid(0.015, 0.2e-3, 7, 8)
    fields = jnp.asarray(np.random.default_rng(4).uniform(0.0, 1e9, (3, *grid.shape)))
    matrix = influence(grid, MODULUS)
    each = jnp.stack([matrix(field) for field in fields])
    np.testing.assert_allclose(matrix(fields), each, rtol=ROUNDING)

    def middle(scale):
        bigger = graded_grid(0.015 * scale, 0.2e-3 * scale, 7, 8)
        return influence(bigger, MODULUS)(fields[0])[0, 4]

    # Twice the size, twice the displacement.
    value, slope = jax.value_and_grad(middle)(1.0)
    assert float(slope) == pytest.approx(float(value), rel=1e-9)


@pytest.mark.slow
def test_grids():
    even, graded = even_grid(0.015, 0.2e-3, 8, 10), graded_grid(0.015, 0.2e-3, 9, 10)
    for grid in (even, graded):
        assert float(jnp.sum(grid.area)) == pytest.approx(0.4e-3 * 0.015, rel=ROUNDING)
        np.testing.assert_allclose(grid.y, -grid.y[::-1], atol=1e-18)
    assert even.shape == (4, 10) and graded.shape == (5, 10)
    assert float(even.x[0]) == pytest.approx(0.5 * 0.05e-3) and graded.x[0] == 0
    assert graded.half_y[0] < 0.2 * graded.half_y[5]
    full = even_grid(0.015, 0.2e-3, 8, 10, symmetric=False)
    np.testing.assert_allclose(full.x, np.arange(-3.5, 4) * 0.05e-3, rtol=1e-12)
    for wrong in ({"half_width": -1.0}, {"n_across": 2}, {"n_along": 1}):
        size = {"half_width": 1e-4, "n_across": 5, "n_along": 5} | wrong
        with pytest.raises(ValueError, match=next(iter(wrong))):
            even_grid(0.015, **size)
    with pytest.raises(ValueError, match="grading"):
        graded_grid(0.015, 1e-4, 5, 5, grading=0.5)

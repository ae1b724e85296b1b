"""Unrolled symmetric solves against LAPACK."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

from bearingjax.numerics.linear import (
    dot,
    lengths,
    norm,
    null_space,
    quadratic,
    smallest_pivot,
    solve_symmetric,
    trace,
)

solve_many = jax.jit(jax.vmap(solve_symmetric))
pivot_many = jax.jit(jax.vmap(smallest_pivot))


def positive_definite(rng, count, n, condition=1e3):
    """Random symmetric matrices with eigenvalues from 1 down to 1/condition."""
    basis, _ = np.linalg.qr(rng.normal(size=(count, n, n)))
    values = condition ** -rng.uniform(size=(count, 1, n))
    matrix = (basis * values) @ basis.swapaxes(1, 2)
    return 0.5 * (matrix + matrix.swapaxes(1, 2))


@pytest.mark.parametrize("n", [3, 6])
@pytest.mark.parametrize("spread", [0, 8])
def test_solve_against_lapack(n, spread):
    """Rows of units up to 10^±8 apart (N/m against N m) cost no accuracy."""
    rng = np.random.default_rng(n + spread)
    matrix = positive_definite(rng, 100, n)
    want = rng.normal(size=(100, n, 2))
    unit = 10.0 ** rng.uniform(-spread, spread, (100, n))
    rhs = np.linalg.solve(np.linalg.inv(matrix), want)
    got = solve_many(
        jnp.asarray(matrix * unit[:, :, None] * unit[:, None, :]),
        jnp.asarray(rhs * unit[:, :, None]),
    )
    scale = np.max(np.abs(want), axis=(1, 2), keepdims=True)
    error = np.abs(np.asarray(got) * unit[:, :, None] - want) / scale
    assert np.max(error) < SOLVER


def test_shape_of_the_right_hand_side():
    rng = np.random.default_rng(0)
    matrix = positive_definite(rng, 1, 3)[0]
    for shape in ((3,), (3, 1), (3, 4), (3, 2, 2)):
        rhs = rng.normal(size=shape)
        got = solve_symmetric(jnp.asarray(matrix), jnp.asarray(rhs))
        want = np.linalg.solve(matrix, rhs.reshape(3, -1)).reshape(shape)
        assert got.shape == shape
        np.testing.assert_allclose(got, want, rtol=SOLVER)


def test_only_the_lower_half_is_read():
    matrix = jnp.asarray([[4.0, 7.0, 7.0], [1.0, 3.0, 7.0], [0.5, 1.0, 2.0]])
    whole = jnp.tril(matrix) + jnp.tril(matrix, -1).T
    rhs = jnp.asarray([1.0, 2.0, 3.0])
    got = solve_symmetric(matrix, rhs)
    np.testing.assert_allclose(got, jnp.linalg.solve(whole, rhs), rtol=ROUNDING)


def test_singular_stays_finite():
    """Random directions missing, up to three of six: nothing infinite comes back."""
    rng = np.random.default_rng(1)
    matrix = positive_definite(rng, 100, 6)
    values, basis = np.linalg.eigh(matrix)
    values[np.arange(6) < rng.integers(1, 4, (100, 1))] = 0.0
    matrix = (basis * values[:, None, :]) @ basis.swapaxes(1, 2)
    got = solve_many(jnp.asarray(matrix), jnp.asarray(rng.normal(size=(100, 6, 2))))
    assert np.all(np.isfinite(got))


def test_solve_many_with_singular_directions():
    """Unknowns that the matrix does not know, and two that it holds as one."""
    zero = np.zeros((3, 3))
    unheld = np.array([[4.0, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 2.0]])
    together = np.array([[2.0, 2.0, 1.0], [2.0, 2.0, 1.0], [1.0, 1.0, 3.0]])
    matrix = np.stack([zero, unheld, together])
    rhs = matrix @ np.array([[3.0], [-1.0], [2.0]])
    got = np.asarray(solve_many(jnp.asarray(matrix), jnp.asarray(rhs)))
    np.testing.assert_allclose(matrix @ got, rhs, rtol=SOLVER)
    np.testing.assert_array_equal(got[0], 0.0)
    assert got[1, 1, 0] == 0.0


def test_solve_symmetric_keeps_nan_pivot():
    """A NaN pivot must not be taken for a small one."""
    matrix = jnp.eye(3).at[1, 1].set(jnp.nan)
    assert jnp.any(jnp.isnan(solve_symmetric(matrix, jnp.ones(3))))


def test_smallest_pivot():
    rng = np.random.default_rng(2)
    for n in (3, 6):
        good = positive_definite(rng, 50, n)
        assert np.all(np.asarray(pivot_many(jnp.asarray(good))) > 0)
        # One negative eigenvalue beyond round-off, by shifting the spectrum.
        values = np.linalg.eigvalsh(good)
        shift = 0.5 * (values[:, 0] + values[:, 1])
        bad = good - shift[:, None, None] * np.eye(n)
        assert np.all(np.asarray(pivot_many(jnp.asarray(bad))) < 0)


def test_smallest_pivot_by_hand():
    """Scaled to a unit diagonal [[1, c], [c, 1]]: the second pivot is 1 - c²."""
    units = np.array([1e-6, 1e5])
    for c in (0.0, 0.6, -0.8, 1.25):
        matrix = np.array([[1.0, c], [c, 1.0]]) * units[:, None] * units
        got = smallest_pivot(jnp.asarray(matrix))
        np.testing.assert_allclose(got, min(1.0, 1.0 - c * c), rtol=ROUNDING)
    negative = jnp.asarray([[1.0, 0.0], [0.0, -1e-3]])
    assert smallest_pivot(negative) < 0
    singular = smallest_pivot(jnp.ones((3, 3)))
    assert abs(singular) < ROUNDING


@pytest.mark.parametrize("rank", [0, 3, 5])
def test_null_space_matches_eigenvectors(rank):
    """Aslant of the axes; what is held softly is held."""
    turned, _ = np.linalg.qr(np.random.default_rng(rank).normal(size=(5, 5)))
    held = turned[:, :rank]
    matrix = held @ np.diag(np.logspace(0, -9, rank)) @ held.T
    free = turned[:, rank:]
    found = null_space(jnp.asarray(matrix))
    # Round-off over the softest that is held turns it a little.
    np.testing.assert_allclose(found, free @ free.T, rtol=0, atol=1e-6)


def test_written_out_products():
    rng = np.random.default_rng(3)
    matrix, a, b = rng.normal(size=(4, 4)), rng.normal(size=4), rng.normal(size=4)
    m, x, y = jnp.asarray(matrix), jnp.asarray(a), jnp.asarray(b)
    np.testing.assert_allclose(dot(x, y), a @ b, rtol=ROUNDING)
    np.testing.assert_allclose(norm(x), np.linalg.norm(a), rtol=ROUNDING)
    np.testing.assert_allclose(quadratic(m, x), a @ matrix @ a, rtol=ROUNDING)
    np.testing.assert_allclose(trace(m), np.trace(matrix), rtol=ROUNDING)


def test_lengths_have_derivatives_at_zero():
    vectors = np.array([[3.0, -4.0], [0.0, 0.0]])
    np.testing.assert_array_equal(lengths(vectors), [5.0, 0.0])
    slopes = jax.grad(lambda v: jnp.sum(lengths(v)))(jnp.asarray(vectors))
    np.testing.assert_allclose(slopes, [[0.6, -0.8], [0.0, 0.0]], rtol=ROUNDING)

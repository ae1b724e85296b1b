"""Eigenvalues of symmetric matrices: against NumPy, differences, and one at a time."""

import re

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

from bearingjax.numerics.eigen import eigh


def symmetric(rng, *shape, imaginary=0.0):
    matrix = rng.normal(size=shape) + imaginary * rng.normal(size=shape)
    return 0.5 * (matrix + matrix.conj().swapaxes(-1, -2))


@pytest.mark.parametrize("imaginary", [0.0, 1.0j])
def test_nested_maps_against_numpy(imaginary):
    matrix = symmetric(np.random.default_rng(1), 2, 3, 6, 6, imaginary=imaginary)
    found = jax.jit(jax.vmap(jax.vmap(eigh)))(jnp.asarray(matrix))
    values, vectors = map(np.asarray, found)
    np.testing.assert_allclose(values, np.linalg.eigh(matrix)[0], atol=10 * ROUNDING)
    back = (vectors * values[..., None, :]) @ vectors.conj().swapaxes(-1, -2)
    np.testing.assert_allclose(back, matrix, atol=100 * ROUNDING)


def cube(matrix):
    """A³ by the eigenvalues: it does not depend on the basis."""
    values, vectors = eigh(matrix)
    return (vectors * values[None, :] ** 3) @ vectors.T


def test_second_derivatives_in_both_modes():
    """Of A³, which needs no eigenvalues; mapped."""
    rng = np.random.default_rng(2)
    matrix = jnp.asarray(symmetric(rng, 3, 5, 5))
    a, b = jnp.asarray(symmetric(rng, 2, 5, 5))

    def second(function, mode, matrix):
        inner = lambda m: jax.jvp(function, (m,), (a,))[1]  # noqa: E731
        if mode == "forward":
            return jnp.sum(jax.jvp(inner, (matrix,), (b,))[1] * a)
        return jnp.sum(jax.grad(lambda m: jnp.sum(inner(m) * a))(matrix) * b)

    plain = jax.vmap(lambda m: second(lambda m: m @ m @ m, "forward", m))
    for mode in ("forward", "reverse"):
        found = jax.jit(jax.vmap(lambda m, mode=mode: second(cube, mode, m)))(matrix)
        np.testing.assert_allclose(found, plain(matrix), rtol=SOLVER)


def test_no_batch_of_matrices_reaches_lapack():
    """jaxlib would divide it among threads, which may wait for each other for ever."""
    matrix = jnp.asarray(symmetric(np.random.default_rng(3), 20, 30, 30))
    text = jax.jit(jax.vmap(jax.jacfwd(cube))).lower(matrix).as_text()
    calls = re.findall(r"@lapack_dsyevd_ffi\(.*\) -> \(tensor<([0-9x]+)xf64>", text)
    assert calls and set(calls) <= {"30x30", "1x30x30"}

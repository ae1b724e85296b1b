"""LAPACK one matrix at a time: against JAX's own, with derivatives, and its calls."""

import re
from functools import partial

import jax
import jax.numpy as jnp
import jax.scipy.linalg as dense
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

from bearingjax.numerics import lapack


def symmetric(rng, *shape, imaginary=0.0):
    matrix = rng.normal(size=shape) + imaginary * rng.normal(size=shape)
    return 0.5 * (matrix + matrix.conj().swapaxes(-1, -2))


def positive(m):
    """A positive definite matrix of any."""
    return m @ m.T + jnp.eye(m.shape[0])


def by_size(values):
    """In an order that does not depend on who found them."""
    return values[jnp.lexsort((values.imag, values.real))]


def solved(kind, m, solve=None):
    """For a matrix of a kind and a right-hand side that depends on it."""
    part = dict(positive=positive, lower=jnp.tril, upper=jnp.triu).get(kind, jnp.array)
    matrix = part(m) if kind in ("regular", "positive") else part(m) + 3 * jnp.eye(5)
    rhs = jnp.sin(m[:, :2])
    return solve(matrix, rhs) if solve else lapack.solve_any(matrix, rhs, kind)


def rank_three(m):
    return m[:, :3] @ m[:3] @ m


ONES = {
    **{
        kind: (partial(solved, kind), partial(solved, kind, solve=jnp.linalg.solve))
        for kind in ("regular", "positive", "lower", "upper")
    },
    "cholesky": (
        lambda m: lapack.cholesky(positive(m)),
        lambda m: jnp.linalg.cholesky(positive(m)),
    ),
    "congruent": (
        lambda m: lapack.congruent(lapack.cholesky(positive(m)), m),
        lambda m: (
            jnp.linalg.inv(jnp.linalg.cholesky(positive(m)))
            @ m
            @ jnp.linalg.inv(jnp.linalg.cholesky(positive(m))).T
        ),
    ),
    "sign": (lapack.determinant_sign, lambda m: jnp.linalg.slogdet(m)[0]),
    "pseudoinverse": (
        lambda m: lapack.pseudoinverse(rank_three(m), 1e-10),
        lambda m: jnp.linalg.pinv(rank_three(m), rtol=1e-10),
    ),
    "wide": (lambda m: lapack.pseudoinverse(m[:3]), lambda m: jnp.linalg.pinv(m[:3])),
    "eigh": (
        lambda m: lapack.eigh(0.5 * (m + m.T))[0],
        lambda m: jnp.linalg.eigvalsh(0.5 * (m + m.T)),
    ),
    "eigvals": (
        lambda m: by_size(lapack.eigvals(m)),
        lambda m: by_size(jnp.linalg.eigvals(m)),
    ),
    "expm": (
        lambda m: lapack.expm(jnp.stack([m, 30.0 * m])) * jnp.exp(-90.0),
        lambda m: jnp.stack([dense.expm(m), dense.expm(30.0 * m)]) * jnp.exp(-90.0),
    ),
}
NO_SECOND = "sign", "eigvals"


def matrices(*shape, seed=4):
    return jnp.asarray(np.random.default_rng(seed).normal(size=(*shape, 5, 5)))


@pytest.mark.parametrize("name", ONES)
@pytest.mark.slow
def test_mapped_values_and_derivatives_are_those_of_jax(name):
    """Twice mapped; in both modes, and of the second order."""
    ours, plain = ONES[name]
    given = matrices(2, 2)
    change, push = matrices(2, seed=5)

    def every(function):
        def slope(m):
            return jax.jvp(function, (m,), (change,))[1]

        def along(m):
            if name in NO_SECOND:
                return slope(m)
            return slope(m), jax.jvp(slope, (m,), (push,))[1]

        def pulled(m):
            found, back = jax.vjp(function, m)
            return back(jnp.ones_like(found))

        return jax.jit(
            jax.vmap(jax.vmap(lambda m: (function(m), along(m), pulled(m))))
        )(given)

    for one, other in zip(
        *map(jax.tree.leaves, map(every, (ours, plain))), strict=True
    ):
        size = np.abs(other).max()
        assert np.all(np.abs(one - other) <= 1e-9 * size), name


@pytest.mark.parametrize("name", ONES)
def test_no_batch_of_matrices_reaches_lapack(name):
    """jaxlib would divide it among threads, which may wait for each other for ever."""
    function, _ = ONES[name]
    with_slopes = jax.vmap(lambda m: (function(m), jax.jacrev(function)(m)))
    if name == "eigvals":
        with_slopes = jax.vmap(lambda m: (function(m), jax.jacfwd(function)(m)))
    text = jax.jit(with_slopes).lower(matrices(20)).as_text()
    shapes = re.findall(r"@lapack_\w+\(.*\) -> \(?tensor<([0-9x]+)x[fc]", text)
    assert shapes and not [shape for shape in shapes if shape.count("x") > 1], shapes


@pytest.mark.parametrize("imaginary", [0.0, 1.0j])
def test_eigenvectors_against_numpy(imaginary):
    matrix = symmetric(np.random.default_rng(1), 2, 3, 6, 6, imaginary=imaginary)
    found = jax.jit(jax.vmap(jax.vmap(lapack.eigh)))(jnp.asarray(matrix))
    values, vectors = map(np.asarray, found)
    np.testing.assert_allclose(values, np.linalg.eigh(matrix)[0], atol=10 * ROUNDING)
    back = (vectors * values[..., None, :]) @ vectors.conj().swapaxes(-1, -2)
    np.testing.assert_allclose(back, matrix, atol=100 * ROUNDING)


def cube(matrix):
    """A³ by the eigenvalues: it does not depend on the basis."""
    values, vectors = lapack.eigh(matrix)
    return (vectors * values[None, :] ** 3) @ vectors.T


def test_second_derivatives_of_eigenvectors_in_both_modes():
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


def test_exponential_of_a_stiff_vibration():
    """10 000 times as fast as the steps, where JAX's own has no answer."""
    fast = 1e4
    stiff = np.array([[0.0, 1.0, 0.0], [-(fast**2), 0.0, 0.0], [0.0, 0.0, -0.5]])
    (found,) = np.asarray(lapack.expm(jnp.asarray(stiff)[None]))
    units = np.array([1.0, fast, 1.0])
    c, s = np.cos(fast), np.sin(fast)
    want = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, np.exp(-0.5)]]
    np.testing.assert_allclose(found * units / units[:, None], want, atol=1e-10)
    assert np.isnan(lapack.expm(jnp.asarray(1e4 * stiff)[None])).all()

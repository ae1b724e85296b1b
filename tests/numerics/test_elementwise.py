"""Functions of scalars in long rows against the same functions one by one."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from bearingjax.numerics.compiled.elementwise import elementwise


def function(x, y, args):
    """Of two elements; `args` hold numbers, an array, and what is no array."""
    scale, weights, name = args
    assert x.shape == y.shape == () and weights.shape == (3,) and name == "sum"
    total = scale * x + jnp.sum(weights) * y
    return total, total > 0


def plain(x, y, scale, weights):
    total = scale * x + np.sum(weights) * y
    return total, total > 0


X, Y = np.linspace(-1.0, 1.0, 4)[:, None], np.linspace(-2.0, 3.0, 5)[None, :]
SCALES, WEIGHTS = np.array([0.5, -2.0]), np.arange(6.0).reshape(2, 3)


def test_rows_broadcast():
    got = elementwise(
        function,
        (jnp.asarray(X), jnp.asarray(Y)),
        (0.5, jnp.asarray(WEIGHTS[1]), "sum"),
    )
    assert got[0].shape == (4, 5) and got[1].dtype == bool
    for a, b in zip(got, plain(X, Y, 0.5, WEIGHTS[1]), strict=True):
        np.testing.assert_allclose(a, b)


@pytest.mark.parametrize("axes", [(None, 0, None), (None, None, 0), (0, 0, 0)])
def test_under_vmap(axes):
    """Rows, numbers and arrays may have lanes or be alike in all."""
    x = np.stack([X[:, 0], 2.0 * X[:, 0]])
    given = [
        jnp.asarray(value if axis == 0 else value[0])
        for value, axis in zip((x, SCALES, WEIGHTS), axes, strict=True)
    ]

    def one(x, scale, weights):
        return elementwise(function, (x, jnp.asarray(2.0)), (scale, weights, "sum"))

    def twice(x, scale, weights):
        return jax.vmap(lambda k: one(k * x, scale, weights))(jnp.asarray([1.0, 3.0]))

    got = jax.jit(jax.vmap(twice, axes))(*given)
    for k in range(2):
        for n, factor in enumerate((1.0, 3.0)):
            mine = [
                v[k] if a == 0 else v[0]
                for v, a in zip((x, SCALES, WEIGHTS), axes, strict=True)
            ]
            want = plain(factor * mine[0], 2.0, *mine[1:])
            for a, b in zip(got, want, strict=True):
                np.testing.assert_allclose(a[k, n], b)

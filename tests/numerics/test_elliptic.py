"""Elliptic integrals against SciPy's, which are Carlson's and Cephes'."""

import jax
import jax.numpy as jnp
import numpy as np
import scipy.special as special
from tolerances import ROUNDING

from bearingjax.numerics.elliptic import carlson_rd, complete

RATIOS = np.concatenate(
    [10.0 ** np.linspace(-7, 7, 57), [1.0, 1.0 - 1e-9, 1.0 + 1e-6, 0.5, 3.0]]
)


def test_complete():
    """K, B = R_D(0, 1, k'²) k'²/3 and D = R_D(0, k'², 1)/3 over 14 decades."""
    k, b, d = complete(jnp.asarray(RATIOS))
    square = RATIOS**2
    np.testing.assert_allclose(k, special.elliprf(0.0, square, 1.0), rtol=ROUNDING)
    np.testing.assert_allclose(
        b, square * special.elliprd(0.0, 1.0, square) / 3.0, rtol=ROUNDING
    )
    np.testing.assert_allclose(
        d, special.elliprd(0.0, square, 1.0) / 3.0, rtol=ROUNDING
    )


def test_legendre():
    """K and E = B + k'² D, and Legendre's relation between modulus and complement."""
    ratio = jnp.asarray(np.linspace(0.05, 0.95, 19))
    k, b, d = complete(ratio)
    e = b + ratio**2 * d
    parameter = 1.0 - np.asarray(ratio) ** 2
    np.testing.assert_allclose(k, special.ellipk(parameter), rtol=ROUNDING)
    np.testing.assert_allclose(e, special.ellipe(parameter), rtol=ROUNDING)
    other = jnp.sqrt(1.0 - ratio**2)
    k2, b2, d2 = complete(other)
    e2 = b2 + other**2 * d2
    np.testing.assert_allclose(e * k2 + e2 * k - k * k2, np.pi / 2, rtol=ROUNDING)


def test_circle():
    """K = π/2, B = D = π/4 there, with dK/dk' = -π/4 by the series, not 0/0."""
    k, b, d = complete(jnp.asarray(1.0))
    np.testing.assert_allclose([k, b, d], np.pi * np.array([0.5, 0.25, 0.25]), rtol=0)
    slope = jax.grad(lambda r: complete(r)[0])(jnp.asarray(1.0))
    np.testing.assert_allclose(slope, -np.pi / 4, rtol=ROUNDING)


def test_derivatives():
    """dK/dm and dE/dm of the textbook, m = 1 - k'²; second derivatives finite."""
    ratio = jnp.asarray(RATIOS)
    k, b, d = complete(ratio)
    slope_k = jax.vmap(jax.grad(lambda r: complete(r)[0]))(ratio)
    # dK/dm = (E - k'² K)/(2 m k'²) = B/(2 k'²), dm/dk' = -2 k'
    np.testing.assert_allclose(slope_k, -b / ratio, rtol=ROUNDING)

    def e(r):
        _, b, d = complete(r)
        return b + r * r * d

    # dE/dm = -D/2; the round-off is that of dK, whose largest part drops out.
    error = jax.vmap(jax.grad(e))(ratio) - d * ratio
    assert np.max(np.abs(error) / (np.abs(slope_k) + d * ratio)) < ROUNDING
    assert np.isfinite(jax.vmap(jax.hessian(e))(ratio)).all()


def test_carlson_rd():
    """Random arguments over nine decades, and with one of them zero."""
    rng = np.random.default_rng(1)
    x, y, z = 10.0 ** rng.uniform(-6, 3, (3, 2000))
    x[:200] = 0.0
    got = jax.jit(carlson_rd)(*map(jnp.asarray, (x, y, z)))
    np.testing.assert_allclose(got, special.elliprd(x, y, z), rtol=ROUNDING)


def test_float32():
    """Single precision in, single precision out."""
    ratio = jnp.asarray(np.geomspace(1e-3, 1e3, 25), jnp.float32)
    for got, want in zip(
        complete(ratio), complete(ratio.astype(jnp.float64)), strict=True
    ):
        assert got.dtype == jnp.float32
        # Eight steps of rounding to 6e-8, and B as a difference.
        np.testing.assert_allclose(got, want, rtol=5e-6)

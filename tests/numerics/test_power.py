"""Positive powers: value and every derivative against closed forms, and the corners."""

from functools import reduce

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

from bearingjax.numerics import positive_power, smooth_power
from bearingjax.numerics.power import ninth_root

EXPONENTS = ((19, 9), (10, 9), (1, 9), (5, 2), (3, 2), (4, 3), (2, 1))
# About 1e-15 and 1e-7 are stated; a few units in the last place more in the corners.
ROOT = {"float64": 4e-15, "float32": 2e-6}
ORDERS = 4


def nested(power, order):
    """The derivative of a given order, by nesting `jax.jacfwd`."""
    return reduce(lambda f, _: jax.jacfwd(f), range(order), power)


@jax.jit
def _derivatives(x):
    rows = []
    for k, d in EXPONENTS:
        orders = [
            nested(lambda y, k=k, d=d: positive_power(y, k, d), n)
            for n in range(ORDERS)
        ]
        rows.append(jnp.stack([jax.vmap(f)(x) for f in orders]))
    return jnp.stack(rows)


def derivatives(x):
    """All exponents, orders 0 to 3, at the points x: (exponent, order, point)."""
    filled = jnp.ones(512, x.dtype).at[: x.size].set(x)  # one shape: compiled once
    return _derivatives(filled)[..., : x.size]


def closed_form(x):
    """p(p-1)...(p-n+1) x^(p-n) for x > 0, in extended precision."""
    x = np.asarray(x, dtype=np.longdouble)
    table = []
    for k, d in EXPONENTS:
        p = np.longdouble(k) / d
        falling = [np.longdouble(1), *(p - n for n in range(ORDERS - 1))]
        factors = np.cumprod(np.array(falling))
        table.append([c * x ** (p - n) for n, c in enumerate(factors)])
    return np.array(table)


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_ninth_root(dtype):
    # The inverse root's ninth power must be a normal number too.
    ends = (-300.0, 300.0) if dtype == "float64" else (-37.0, 37.0)
    x = (10.0 ** np.random.default_rng(0).uniform(*ends, 200_000)).astype(dtype)
    corners = [np.finfo(dtype).tiny, 1.0, 512.0]
    x = np.concatenate([x, np.array(corners, dtype)])
    got = jax.jit(ninth_root)(jnp.asarray(x))
    assert got.dtype == dtype
    want = x.astype(np.longdouble) ** (np.longdouble(1) / 9)
    assert np.max(np.abs(np.asarray(got) / want - 1)) < ROOT[dtype]


def test_ninth_root_passes_nan():
    for dtype in ("float64", "float32"):
        assert jnp.isnan(ninth_root(jnp.asarray(jnp.nan, dtype)))


def test_derivatives_of_every_order():
    x = 10.0 ** np.random.default_rng(1).uniform(-15, 3, 500)
    got, want = np.asarray(derivatives(jnp.asarray(x))), closed_form(x)
    # The square has no third derivative; the others are compared relatively.
    error = np.abs(got - want) / np.where(want == 0, 1.0, np.abs(want))
    assert np.max(error) < ROUNDING


def test_single_precision():
    x = (10.0 ** np.random.default_rng(2).uniform(-5, 2, 300)).astype(np.float32)
    got, want = derivatives(jnp.asarray(x)), closed_form(x)
    assert got.dtype == jnp.float32
    error = np.abs(np.asarray(got) - want) / np.where(want == 0, 1.0, np.abs(want))
    # 2e-6 of the root, to its eighth power.
    assert np.max(error) < 8 * ROOT["float32"]


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_apart_is_exactly_zero(dtype):
    """Open contact: value and derivatives of every order vanish, none is NaN."""
    x = np.array([-np.inf, -1e30, -1.0, -1e-30, -0.0, 0.0], dtype)
    np.testing.assert_array_equal(derivatives(jnp.asarray(x)), 0.0)


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_finite_at_the_edge(dtype):
    """Closed by next to nothing, and very far: up to two derivatives are finite."""
    tiny = float(np.finfo(dtype).tiny)
    smallest = float(np.finfo(dtype).smallest_subnormal)
    huge = 1e100 if dtype == "float64" else 1e12
    x = jnp.asarray(np.array([smallest, tiny / 2, tiny, 2 * tiny, huge], dtype))
    got = np.asarray(derivatives(x))
    law = [EXPONENTS.index(e) for e in ((19, 9), (10, 9), (5, 2), (3, 2))]
    assert np.all(np.isfinite(got[law, :3]))
    assert np.all(got[law, :3] >= 0)


def test_energy_load_and_stiffness_just_closed():
    """No jump where a contact opens: the three densities go to zero with x."""
    x = jnp.asarray([1e-300, 1e-100])
    got = np.asarray(derivatives(x))
    for row, size in ((0, 2), (1, 1)):
        for order in range(size):
            assert got[row, order, 0] < got[row, order, 1] < 1e-10


def test_nan_passes_through():
    """NaN must not be counted as an open contact, in value nor in derivatives."""
    for dtype in ("float64", "float32"):
        got = np.asarray(derivatives(jnp.asarray([jnp.nan], dtype)))
        # A derivative that is zero as a rule (x² three times) may stay zero.
        smooth = np.array([d != 1 for _, d in EXPONENTS])
        assert np.all(np.isnan(got[smooth]))
        assert np.all(np.isnan(got[~smooth, :2]))


def test_power_of_exponent_zero():
    x = jnp.asarray([-1.0, 0.0, 2.0])
    step, slope = jax.jvp(lambda y: positive_power(y, 0, 9), (x,), (jnp.ones_like(x),))
    np.testing.assert_array_equal(step, [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(slope, 0.0)


def test_forward_and_reverse_agree_on_arrays():
    x = jnp.asarray(np.random.default_rng(3).uniform(-1.0, 1.0, (2, 3)))

    def total(y):
        return jnp.sum(positive_power(y, 19, 9))

    reverse = jax.grad(total)(x)
    forward = jax.jvp(lambda y: positive_power(y, 19, 9), (x,), (jnp.ones_like(x),))[1]
    want = 19 / 9 * np.maximum(x, 0.0) ** (10 / 9)
    np.testing.assert_allclose(reverse, want, rtol=ROUNDING)
    np.testing.assert_allclose(forward, want, rtol=ROUNDING)


def test_smooth_power():
    """The power itself far from zero, even, and finite with its derivatives at zero."""
    x = jnp.asarray([1e-9, -3e-5, 2.0])
    np.testing.assert_allclose(
        smooth_power(x, 0.67, 1e-16), np.abs(x) ** 0.67, rtol=ROUNDING
    )
    zero = jnp.asarray(0.0)
    for order, want in enumerate((0.0, 0.0, 2.0 * (1e-8) ** (0.67 - 2.0))):
        got = nested(lambda x: smooth_power(x, 0.67, 1e-8), order)(zero)
        np.testing.assert_allclose(got, want, rtol=ROUNDING)

"""Derivatives through solved systems, against closed forms, at first and second order.

The cubic y³ + y = p has y' = 1/(3y² + 1) and y'' = -6y y'³. The system is the gradient
of ½ yᵀS y + ¼ Σ y⁴ - pᵀy: y' = J⁻¹ with J = S + 3 diag(y²), and the second derivative
along v is -J⁻¹ (6 y (J⁻¹v)²).
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

from bearingjax.numerics.expansion import by_autodiff
from bearingjax.numerics.implicit import (
    attach,
    attach_roots,
    stop_gradient,
    through_jacobian,
    unless_failed,
)

STIFFNESS = jnp.asarray([[2.0, 0.5, -0.3], [0.5, 1.5, 0.2], [-0.3, 0.2, 1.0]])


def cubic(y, p):
    return y**3 + y - p


def real_root(p):
    """The real root of y³ + y = p (Cardano), polished by one Newton step."""
    half = 0.5 * p
    root = jnp.sqrt(half * half + 1.0 / 27.0)
    y = jnp.cbrt(half + root) + jnp.cbrt(half - root)
    return y - cubic(y, p) / (3.0 * y * y + 1.0)


def energy_gradient(y, args):
    stiffness, p = args
    return stiffness @ y + y**3 - p


def solved(p):
    """By plain Newton, in NumPy."""
    stiffness, p, y = np.asarray(STIFFNESS), np.asarray(p), np.zeros(3)
    for _ in range(30):
        jacobian = stiffness + 3.0 * np.diag(y * y)
        y = y - np.linalg.solve(jacobian, energy_gradient(y, (stiffness, p)))
    return y


def system(p, y):
    """The solution y with its derivative by p."""
    return attach(energy_gradient, y, (STIFFNESS, p))


def root_of(p):
    """Both ways to the cubic: as a root by itself, as a system of one unknown."""
    alone = attach_roots(cubic, real_root(p), p)
    as_system = attach(lambda y, q: cubic(y, q), real_root(p)[None], p)[0]
    return jnp.stack([alone, as_system])


P = np.linspace(-3.0, 3.0, 7)


@pytest.mark.parametrize("derivative", [jax.jacfwd, jax.jacrev])
def test_cubic_first_and_second(derivative):
    first = derivative(root_of)
    second = jax.jacfwd(first)
    value, first, second = jax.jit(
        jax.vmap(lambda p: (root_of(p), first(p), second(p)))
    )(jnp.asarray(P))
    y = np.asarray(value)
    slope = 1.0 / (3.0 * y * y + 1.0)
    np.testing.assert_allclose(y**3 + y, P[:, None] + 0 * y, atol=ROUNDING)
    np.testing.assert_allclose(first, slope, rtol=ROUNDING)
    np.testing.assert_allclose(second, -6.0 * y * slope**3, rtol=ROUNDING)


def test_cubic_third():
    """The rule calls itself, at any order."""

    def root(p):
        return attach_roots(cubic, real_root(p), p)

    third = jax.jit(jax.grad(jax.grad(jax.grad(root))))(jnp.asarray(1.3))
    y = float(real_root(jnp.asarray(1.3)))
    slope = 1.0 / (3.0 * y * y + 1.0)
    # d/dp of -6 y s³ with ds/dp = -6 y s³.
    want = -6.0 * slope**4 + 108.0 * y * y * slope**5
    np.testing.assert_allclose(third, want, rtol=ROUNDING)


@pytest.mark.parametrize("modes", ["forward", "reverse", "mixed"])
def test_system_first_and_second(modes):
    outer, inner = {
        "forward": (jax.jacfwd, jax.jacfwd),
        "reverse": (jax.jacrev, jax.jacrev),
        "mixed": (jax.jacfwd, jax.jacrev),
    }[modes]
    ps = np.random.default_rng(0).normal(size=(5, 3))
    ys = np.stack([solved(p) for p in ps])
    first, second = inner(system), outer(inner(system))
    call = jax.jit(jax.vmap(lambda p, y: (system(p, y), first(p, y), second(p, y))))
    got = call(jnp.asarray(ps), jnp.asarray(ys))
    np.testing.assert_array_equal(got[0], ys)
    for y, first, second in zip(*map(np.asarray, got), strict=True):
        inverse = np.linalg.inv(np.asarray(STIFFNESS) + 3.0 * np.diag(y * y))
        np.testing.assert_allclose(first, inverse, rtol=ROUNDING, atol=ROUNDING)
        want = -np.einsum("im,m,mj,mk->ijk", inverse, 6.0 * y, inverse, inverse)
        np.testing.assert_allclose(second, want, rtol=ROUNDING, atol=ROUNDING)


def test_every_argument_is_differentiated():
    """dy/dS through the pytree of arguments, next to what is not a number."""

    def last(stiffness, p):
        def residual(y, args):
            assert args["name"] == "static"
            return args["count"] * energy_gradient(y, args["numbers"])

        args = {"numbers": (stiffness, p), "name": "static", "count": 2}
        return attach(residual, solution, args)[2]

    p = jnp.asarray([0.4, -1.0, 2.0])
    solution = jnp.asarray(solved(p))
    got = jax.jit(jax.grad(last))(STIFFNESS, p)
    y = np.asarray(solution)
    inverse = np.linalg.inv(np.asarray(STIFFNESS) + 3.0 * np.diag(y * y))
    np.testing.assert_allclose(got, -np.outer(inverse[2], y), rtol=ROUNDING)


def test_attach_roots_ignores_derivative_of_given_solution():
    def off(p):
        return attach_roots(cubic, 7.0 * p, p)

    value, slope = jax.value_and_grad(off)(jnp.asarray(0.1))
    assert value == 7.0 * 0.1
    np.testing.assert_allclose(slope, 1.0 / (3.0 * 0.7**2 + 1.0), rtol=ROUNDING)


def test_roots_of_either_slope_and_none():
    """y² = p has roots of both signs of slope; at p = 0 the derivative is zero."""

    def roots(p):
        return attach_roots(lambda y, q: y * y - q, at, p)

    at = jnp.asarray([-2.0, 2.0, 0.0])
    first = jax.jacfwd(roots)(jnp.asarray(4.0))
    np.testing.assert_allclose(first, [-0.25, 0.25, 0.0], rtol=ROUNDING)
    back = jax.jacrev(roots)(jnp.asarray(4.0))
    np.testing.assert_array_equal(back, first)


def test_no_host_callback():
    def both(p):
        return jnp.sum(system(p, p)) + attach_roots(cubic, real_root(p[0]), p[0])

    text = str(jax.make_jaxpr(jax.hessian(both))(jnp.ones(3)))
    assert "callback" not in text
    # What the search would find: a callback does show up in a jaxpr.
    with_callback = jax.make_jaxpr(
        lambda x: jax.pure_callback(lambda y: y, jax.ShapeDtypeStruct((), x.dtype), x)
    )(jnp.asarray(1.0))
    assert "callback" in str(with_callback)


def test_stop_blocks_gradient_of_arrays():
    tree = {"x": jnp.asarray(2.0), "n": 3, "k": jnp.asarray(4)}
    kept = stop_gradient(tree)
    assert kept["n"] == 3 and kept["k"] == 4

    def through(x):
        return x * stop_gradient({"x": x, "n": 3})["x"]

    assert jax.grad(through)(jnp.asarray(2.0)) == 2.0


def test_unless_failed_gives_nan_derivative_on_failure():
    def doubled(x, solved):
        return jnp.sum(unless_failed(lambda x: 2.0 * x, (x,), solved))

    slope = jax.jit(jax.value_and_grad(doubled))
    x = jnp.asarray([1.0, -2.0])
    assert np.array_equal(slope(x, jnp.asarray(True))[1], [2.0, 2.0])
    value, lost = slope(x, jnp.asarray(False))
    assert float(value) == -2.0 and np.isnan(lost).all()


def test_unless_failed_keeps_derivatives_of_masked_cases():
    """√x beside 1/x, of a design p that all cases share and an x of their own."""

    def of(p, x):
        return unless_failed(lambda p, x: (p * jnp.sqrt(x), p / x), (p, x), x > 0)

    x, good = jnp.asarray([4.0, -1.0, 0.0, jnp.nan]), jnp.asarray([1.0, 0, 0, 0]) > 0

    def masked(p, x):
        roots, ratios = jax.vmap(of, (None, 0))(p, x)
        return jnp.sum(jnp.where(good, roots + ratios, 0.0))

    for way in (jax.jacrev, jax.jacfwd):
        slopes = jax.jit(way(masked, (0, 1)))(3.0, x)
        assert float(slopes[0]) == 2.25
        np.testing.assert_array_equal(slopes[1], [0.75 - 3.0 / 16.0, 0, 0, 0])
        bends = jax.jit(jax.jacfwd(way(masked, 1), 1))(3.0, x)
        expected = np.zeros((4, 4))
        expected[0, 0] = -3.0 / 32.0 + 6.0 / 64.0
        np.testing.assert_allclose(bends, expected, atol=1e-15)
        # Nothing cancels: what changes spoils all that follows from it.
        lost = way(lambda p, x: of(p, x)[0] - of(p, x)[0], (0, 1))(3.0, x[1])
        assert np.isnan(lost).all()
    _, (root, _) = jax.jvp(of, (3.0, x[1]), (0.0, 0.0))
    assert float(root) == 0.0


def test_expansion_with_an_argument_of_each_function():
    """a·x²y, with its own a at each of the places."""
    u = jnp.asarray(np.random.default_rng(5).normal(size=(2, 3, 2)))
    a = jnp.arange(1.0, 7.0).reshape(2, 3)
    found = by_autodiff(lambda u, a: a * u[0] ** 2 * u[1], u, a)
    x, y = u[..., 0], u[..., 1]
    zero = jnp.zeros_like(x)
    np.testing.assert_allclose(found.value, a * x * x * y, rtol=1e-12)
    slopes = jnp.stack([2 * a * x * y, a * x * x], axis=-1)
    np.testing.assert_allclose(found.gradient, slopes, rtol=1e-12)
    rows = [[2 * a * y, 2 * a * x], [2 * a * x, zero]]
    bends = jnp.stack([jnp.stack(row, axis=-1) for row in rows], axis=-2)
    np.testing.assert_allclose(found.hessian, bends, rtol=1e-12)


def _bent(given, x, angle):
    """Three values of three numbers, by a pytree with a part that is no array."""
    matrix, power = given
    return jnp.sin(matrix @ x) * jnp.cos(angle) ** power


def test_through_jacobian_has_the_derivatives_of_its_function():
    """First in reverse, second, by inputs and by what is given."""
    spread = jnp.asarray(np.random.default_rng(6).normal(size=(3, 8)))

    def of(function):
        def value(matrix, q, angle):
            return jnp.sum(function((matrix, 2), spread @ q, angle) ** 2)

        return value

    args = STIFFNESS, jnp.linspace(0.1, 0.8, 8), jnp.asarray(0.4)
    plain = of(_bent)
    ours = of(lambda given, *x: through_jacobian(given, *x, function=_bent))
    which = (0, 1, 2)
    for way in (
        lambda f: jax.hessian(f, which),
        lambda f: jax.value_and_grad(f, 1),
        lambda f: jax.grad(f, 0),
    ):
        found, wanted = (jax.tree.leaves(jax.jit(way(f))(*args)) for f in (ours, plain))
        for one, other in zip(found, wanted, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-12)

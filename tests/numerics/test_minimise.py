"""Minimisers on convex functions whose minimum is known, and how they report failure.

The family: ½ (x-m)ᵀA(x-m) + Σ c |rᵢ·(x-m)|^(19/9) has its minimum at m; the power is
that of a line contact, whose stiffness vanishes there.
"""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

from bearingjax.numerics import BFGS, Evaluation, Result, TrustRegionNewton
from bearingjax.numerics.bfgs import inverse_update
from bearingjax.numerics.minimise import Problem, continuation

N, COUNT = 3, 40
NEWTON, QUASI = TrustRegionNewton(), BFGS()
KINDS = ("quadratic", "power", "singular")


def convex(x, matrix, weight, rows, middle):
    """Value, gradient and Hessian, written out: they compile faster."""
    y = x - middle
    part = rows @ y
    size = jnp.abs(part)
    load = jnp.sign(part) * size ** (10 / 9)
    return (
        0.5 * y @ matrix @ y + weight * jnp.sum(size ** (19 / 9)),
        matrix @ y + 19 / 9 * weight * load @ rows,
        matrix + 190 / 81 * weight * (rows.T * (size ** (1 / 9))[None, :]) @ rows,
    )


def evaluated(function, scale=1.0):
    """An `Evaluation` of (value, gradient, Hessian), measured against `scale`."""

    def call(x, with_hessian):
        value, gradient, hessian = function(x)
        one = jnp.ones((), x.dtype)
        return Evaluation(
            value, gradient, hessian if with_hessian else None, scale * one, 0.0 * one
        )

    return call


def problems(kind):
    """Matrix, weight, rows, middle and start of many problems."""
    rng = np.random.default_rng(KINDS.index(kind))
    half = rng.normal(size=(COUNT, N, N))
    matrix = half @ half.swapaxes(1, 2) + 0.1 * np.eye(N)
    rows = rng.normal(size=(COUNT, 4, N))
    if kind != "quadratic":
        matrix = 0.0 * matrix
    if kind == "singular":  # one direction is held by nothing
        rows[:, :, 2] = 0.0
    weight = np.full(COUNT, 0.0 if kind == "quadratic" else 1.0)
    middle = rng.normal(size=(COUNT, N))
    start = 3.0 * rng.normal(size=(COUNT, N))
    return [jnp.asarray(x) for x in (matrix, weight, rows, middle, start)]


def solver(minimiser):
    def solve(matrix, weight, rows, middle, start):
        function = partial(
            convex, matrix=matrix, weight=weight, rows=rows, middle=middle
        )
        return minimiser.minimise(evaluated(function), start, jnp.asarray(0.5))

    return jax.jit(jax.vmap(solve))


gradients = jax.jit(jax.vmap(lambda *x: convex(*x)[1]))
solve_many = {name: solver(m) for name, m in (("newton", NEWTON), ("bfgs", QUASI))}
# |gradient| at the end; the gradient is of order one.
GOAL = {"newton": 1e-13, "bfgs": 1e-9}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", solve_many)
def test_convex_functions(name, kind):
    data = problems(kind)
    got = solve_many[name](*data)
    matrix, weight, rows, middle, start = data
    np.testing.assert_array_equal(got.result, Result.CONVERGED)
    gradient = gradients(got.x, matrix, weight, rows, middle)
    size = np.linalg.norm(gradient, axis=1)
    # A search stalled at round-off counts as converged within 1e3 goals.
    assert np.max(size) < (GOAL[name] if name == "bfgs" else 1e-12)
    np.testing.assert_allclose(got.residual, size, rtol=1e-3, atol=1e-15)
    assert np.all(got.steps > 0) and got.steps.dtype == jnp.int32
    off = np.abs(np.asarray(got.x - middle))
    if kind == "singular":
        off = off[:, :2]
    # The gradient of the power is flat: its ninth-tenths root is the distance.
    assert np.max(off) < (1e-7 if name == "bfgs" else 1e-10)


def test_newton_on_a_quadratic_is_fast():
    """The shift and the radius give way: no more than a few steps a problem."""
    got = solve_many["newton"](*problems("quadratic"))
    assert np.max(got.steps) <= 20


def test_start_at_the_minimum():
    matrix, weight, rows, middle, _ = problems("quadratic")
    for solve in solve_many.values():
        got = solve(matrix, weight, rows, middle, middle)
        np.testing.assert_array_equal(got.steps, 0)
        np.testing.assert_array_equal(got.result, Result.CONVERGED)


def test_non_finite():
    matrix, weight, rows, middle, start = problems("quadratic")
    bad = middle.at[7, 1].set(jnp.nan)
    for solve in solve_many.values():
        result = np.asarray(solve(matrix, weight, rows, bad, start).result)
        assert result[7] == Result.NON_FINITE
        assert np.all(np.delete(result, 7) == Result.CONVERGED)


@pytest.mark.parametrize("kind", [TrustRegionNewton, BFGS])
def test_step_limit(kind):
    data = [x[:2] for x in problems("power")]
    got = solver(kind(max_steps=2))(*data)
    np.testing.assert_array_equal(got.result, Result.STEP_LIMIT)
    np.testing.assert_array_equal(got.steps, 2)


@pytest.fixture(scope="module")
def fall():
    """Search along x₀: flat up to a wall at 5, or down for ever."""

    def function(x, wall):
        into = x[0] - 5.0
        closed = into > 0
        depth = jnp.where(closed, into, 1.0)
        stiff = [jnp.where(closed, wall * depth ** (k / 9), 0.0) for k in (19, 10, 1)]
        first, rest = jnp.eye(N)[0], x.at[0].set(0.0)
        return (
            stiff[0] - 1e-3 * x[0] + 0.5 * jnp.sum(rest**2),
            (19 / 9 * stiff[1] - 1e-3) * first + rest,
            jnp.diag(190 / 81 * stiff[2] * first + 1.0 - first),
        )

    @partial(jax.jit, static_argnums=2)
    def search(wall, start, guided):
        direction = jnp.eye(N)[0] if guided else None
        return NEWTON.minimise(
            evaluated(partial(function, wall=wall), 1e-3),
            start,
            jnp.asarray(1e-3),
            direction=direction,
            limit=jnp.asarray(1e6),
            tolerance=1e-10,
        )

    return search


def test_search_through_free_play(fall):
    """No curvature at the start: the wall is found at once along the direction."""
    start = jnp.asarray([0.0, 0.3, -0.2])
    want = 5.0 + (1e-3 / (19 / 9 * 1e3)) ** 0.9
    for guided in (True, False):
        got = fall(jnp.asarray(1e3), start, guided)
        assert got.result == Result.CONVERGED
        np.testing.assert_allclose(got.x, [want, 0.0, 0.0], atol=1e-9)


def test_no_load_path(fall):
    """Nothing in the way: beyond the limit the function counts as unbounded."""
    for guided in (True, False):
        got = fall(jnp.asarray(0.0), jnp.zeros(N), guided)
        assert got.result == Result.NO_LOAD_PATH
        assert jnp.linalg.norm(got.x) >= 1e6


def test_continuation():
    """To the same minimum as under the force alone, with every step counted."""
    matrix, weight, rows, middle, start = (x[0] for x in problems("power"))
    function = evaluated(
        partial(convex, matrix=matrix, weight=weight, rows=rows, middle=middle)
    )
    force = jnp.asarray([1e-3, 2e-3, -1e-3])

    @jax.jit
    def pulled(factor, max_steps):
        problem = Problem(
            function, start, jnp.asarray(0.5), force=force, max_steps=max_steps
        )
        return continuation(NEWTON, lambda _: problem, lambda _: factor).run(None)

    plain, larger = (pulled(jnp.asarray(f), 100) for f in (1.0, 1e4))
    assert plain.result == larger.result == Result.CONVERGED
    gradient = convex(larger.x, matrix, weight, rows, middle)[1]
    np.testing.assert_allclose(gradient, force, rtol=1e-9)
    np.testing.assert_allclose(larger.x, plain.x, rtol=1e-9)
    few = pulled(jnp.asarray(1e4), 3)
    assert few.result == Result.STEP_LIMIT and few.steps == 3


def test_single_precision():
    data = [x[:5].astype(jnp.float32) for x in problems("quadratic")]

    def solve(minimiser, matrix, middle, start):
        def function(x):
            gradient = matrix @ (x - middle)
            return 0.5 * (x - middle) @ gradient, gradient, matrix

        radius = jnp.asarray(0.5, jnp.float32)
        return minimiser.minimise(evaluated(function), start, radius)

    matrix, _, _, middle, start = data
    for minimiser in (NEWTON, QUASI):
        got = jax.jit(jax.vmap(partial(solve, minimiser)))(matrix, middle, start)
        assert got.x.dtype == jnp.float32
        np.testing.assert_array_equal(got.result, Result.CONVERGED)
        np.testing.assert_allclose(got.x, middle, atol=2e-3)


update = jax.jit(inverse_update)


def random_update(rng):
    half = rng.normal(size=(N, N))
    s, z = rng.normal(size=(2, N))
    z = z if s @ z > 0 else -z
    return half @ half.T + 0.1 * np.eye(N), s, z


def test_inverse_update():
    """It maps z to s, stays symmetric and positive definite: exact to round-off."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        inverse, s, z = random_update(rng)
        got = np.asarray(update(*map(jnp.asarray, (inverse, s, z))))
        size = np.max(np.abs(got))
        np.testing.assert_allclose(got @ z, s, atol=ROUNDING * size)
        np.testing.assert_allclose(got, got.T, atol=ROUNDING * size)
        assert np.linalg.eigvalsh(got)[0] > 0
        # The published product, multiplied out.
        r, a = s @ z, inverse @ z
        want = (
            inverse
            - (np.outer(a, s) + np.outer(s, a)) / r
            + (1 + z @ a / r) * np.outer(s, s) / r
        )
        np.testing.assert_allclose(got, want, atol=ROUNDING * size)


def test_inverse_update_is_skipped():
    """Where the curvature along the step is not positive the metric is kept."""
    rng = np.random.default_rng(6)
    inverse, s, z = map(jnp.asarray, random_update(rng))
    across = jnp.asarray([1.0, 0.0, 0.0]), jnp.asarray([0.0, 1.0, 0.0])
    for step, change in ((s, -z), across, (0.0 * s, z)):
        np.testing.assert_array_equal(update(inverse, step, change), inverse)


def test_inverse_update_ends_on_a_quadratic():
    """With exact line searches: the minimum and the inverse Hessian in n steps."""
    rng = np.random.default_rng(7)
    hessian, middle, x = random_update(rng)
    inverse = np.eye(N)
    for step in range(N):
        gradient = hessian @ (x - middle)
        assert np.linalg.norm(gradient) > 1e-6, step
        direction = -inverse @ gradient
        length = -(gradient @ direction) / (direction @ hessian @ direction)
        s = length * direction
        x = x + s
        inverse = np.asarray(update(*map(jnp.asarray, (inverse, s, hessian @ s))))
    # Round-off of three steps, times the condition of the matrix.
    np.testing.assert_allclose(x, middle, atol=1e-11)
    np.testing.assert_allclose(inverse @ hessian, np.eye(N), atol=1e-10)


def barrier(x):
    """A logarithmic barrier at 1, against a force of 2: the minimum is at ½."""
    room = jnp.where(jnp.max(x) < 1.0, 1.0 - x, jnp.nan)
    value = -jnp.sum(jnp.log(room)) - 2.0 * jnp.sum(x)
    return value, 1.0 / room - 2.0, jnp.diag(room**-2)


@pytest.mark.parametrize("direction", [None, jnp.ones(N) / np.sqrt(N)])
def test_retreats_from_where_there_is_no_value(direction):
    """A step beyond the edge of what is known is taken back, and is not the end."""
    found = NEWTON.minimise(
        evaluated(barrier),
        jnp.full(N, -20.0),
        jnp.asarray(100.0),
        direction=direction,
    )
    assert int(found.result) == Result.CONVERGED
    np.testing.assert_allclose(found.x, 0.5, rtol=1e-10)

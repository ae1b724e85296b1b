"""Loops in lanes against the same loops one by one, over one or two axes of `vmap`."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from bearingjax.numerics import lanes

ROWS, COLUMNS = 7, 100  # 700 problems: more than there are lanes


def loop_of(count, slope):
    """Twice the sum of slope·k over k < count, in `count` steps."""
    zero = jnp.zeros(())
    return lanes.Loop(
        begin=(zero, jnp.zeros((), int)),
        unfinished=lambda state: state[1] < count,
        step=lambda state: (state[0] + slope * state[1].astype(float), state[1] + 1),
        finish=lambda state: (2.0 * state[0], state[1]),
    )


def one(count, slope):
    return lanes.run(loop_of, count, slope)


@pytest.fixture(scope="module")
def problems():
    rng = np.random.default_rng(0)
    counts = rng.integers(1, 40, (ROWS, COLUMNS))
    return counts, rng.normal(size=(ROWS, COLUMNS))


# What the outer and the inner axis run over: (count, slope).
AXES = {
    "both": ((0, 0), (0, 0)),
    "count outside": ((0, None), (None, 0)),
    "slope outside": ((None, 0), (0, None)),
    "count of both, slope of none": ((0, None), (0, None)),
    "count inside, both outside": ((0, 0), (0, None)),
}


@pytest.mark.parametrize("axes", AXES)
def test_lanes_are_the_loops_one_by_one(problems, axes):
    outer, inner = AXES[axes]
    given, whole = [], []
    for k, values in enumerate(problems):
        missing = [i for i, axis in enumerate((outer, inner)) if axis[k] is None]
        part = values[tuple(0 if i in missing else slice(None) for i in range(2))]
        given.append(jnp.asarray(part))
        spread = np.expand_dims(part, tuple(missing))
        whole.append(np.broadcast_to(spread, (ROWS, COLUMNS)))
    total, steps = jax.jit(jax.vmap(jax.vmap(one, inner), outer))(*given)
    count, slope = whole
    np.testing.assert_array_equal(steps, count)
    np.testing.assert_allclose(total, slope * count * (count - 1), rtol=1e-13)


def test_few_problems_and_one():
    total, steps = jax.vmap(one)(jnp.array([1, 5, 3]), jnp.ones(3))
    np.testing.assert_array_equal(steps, [1, 5, 3])
    np.testing.assert_array_equal(total, [0.0, 20.0, 6.0])
    assert float(one(jnp.asarray(4), jnp.asarray(0.5))[0]) == 6.0

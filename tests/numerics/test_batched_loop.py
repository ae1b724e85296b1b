"""Loops in lanes against the same loops one by one, over one or two axes of `vmap`."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from bearingjax.numerics.compiled import batched_loop

ROWS, COLUMNS = 7, 100  # 700 problems: more than there are slots


# Twice the sum of slope·k over k < count, in `count` steps.
SUM = batched_loop.Loop(
    init=lambda given: (jnp.zeros(()), jnp.zeros((), int)),
    step=lambda given, s: (s[0] + given[1] * s[1].astype(float), s[1] + 1),
    terminate=lambda given, s: s[1] >= given[0],
    finish=lambda given, s: (2.0 * s[0], s[1]),
)


def one(count, slope):
    return batched_loop.run(SUM, (count, slope))


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


@pytest.mark.parametrize("count, slots, idle", [(50, 8, 2), (17, 8, 7), (9, 2, 16)])
def test_few_slots(count, slots, idle):
    """More problems than slots; at the end some slots are empty. No more of them can be
    idle than there are."""
    steps = np.arange(count) % 13
    slope = np.linspace(-1.0, 1.0, count)
    got = jax.vmap(lambda n, s: batched_loop.run(SUM, (n, s), slots, idle))(
        jnp.asarray(steps), jnp.asarray(slope)
    )
    np.testing.assert_allclose(got[0], slope * steps * (steps - 1), rtol=1e-13)
    np.testing.assert_array_equal(got[1], steps)


@pytest.mark.parametrize("count", [1, 5, 300])
@pytest.mark.parametrize("resting", ["none", "some", "all"])
def test_resting_problems_are_not_begun(count, resting):
    """They would run for ever; what they rest at is theirs."""
    number = jnp.arange(1.0, count + 1.0)
    odd = jnp.arange(count) % 2 == 1
    rests = {"none": odd & False, "some": odd, "all": odd | True}[resting]

    loop = batched_loop.Loop(
        init=lambda given: given[0],
        step=lambda given, s: jnp.where(given[1], s, s - 1.0),
        terminate=lambda given, s: s <= 0.5,
        finish=lambda given, s: (s, given[0]),
        trivial_result=lambda given: (-given[0], jnp.zeros(())),
        is_trivial=lambda given: given[1],
    )
    left, was = jax.vmap(lambda n, r: batched_loop.run(loop, (n, r)))(number, rests)
    np.testing.assert_array_equal(left, np.where(rests, -number, 0.0))
    np.testing.assert_array_equal(was, np.where(rests, 0.0, number))


def test_lanes_within_lanes():
    """A loop whose every step runs another; both in slots."""

    def inner(count):
        return batched_loop.run(SUM, (count, jnp.ones(())), 4, 1)[0]

    outer = batched_loop.Loop(
        init=lambda given: (given[1], jnp.zeros(())),
        step=lambda given, s: (s[0] - 1, s[1] + jnp.sum(jax.vmap(inner)(given[0]))),
        terminate=lambda given, s: s[0] <= 0,
        finish=lambda given, s: s[1],
    )
    counts = np.arange(60).reshape(20, 3) % 7
    times = np.arange(20) % 5
    got = jax.vmap(lambda c, t: batched_loop.run(outer, (c, t), 4, 1))(
        jnp.asarray(counts), jnp.asarray(times)
    )
    np.testing.assert_allclose(got, times * np.sum(counts * (counts - 1), axis=1))


def test_few_problems_and_one():
    total, steps = jax.vmap(one)(jnp.array([1, 5, 3]), jnp.ones(3))
    np.testing.assert_array_equal(steps, [1, 5, 3])
    np.testing.assert_array_equal(total, [0.0, 20.0, 6.0])
    assert float(one(jnp.asarray(4), jnp.asarray(0.5))[0]) == 6.0


def test_packing():
    """Small leaves of any kind become one array, large ones stay as they are."""
    state = {
        "flag": jnp.asarray(True),
        "count": jnp.int32(-1),
        "matrix": jnp.arange(6.0).reshape(2, 3),
        "large": jnp.arange(batched_loop.SMALL + 1.0),
        "none": jnp.zeros((0,)),
    }
    pack, unpack = batched_loop.packing(jax.eval_shape(lambda: state))
    packed = pack(state)
    assert [a.shape for a in packed] == [(batched_loop.SMALL + 1,), (8,)]
    back = unpack(packed)
    other = jax.tree.map(jnp.zeros_like, state)
    for flag, want in ((True, state), (False, other)):
        either = unpack(pack(batched_loop.Either(jnp.asarray(flag), state, other)))
        jax.tree.map(np.testing.assert_array_equal, either, want)
    assert jax.tree.structure(back) == jax.tree.structure(state)
    for name, value in state.items():
        assert back[name].dtype == value.dtype
        np.testing.assert_array_equal(back[name], value)


def test_precision_changed_within_jit_is_named():
    """It is compiled with the precision that holds outside."""
    ones = SUM._replace(
        init=lambda count: jnp.zeros((), jnp.int32),
        step=lambda count, k: k + 1,
        terminate=lambda count, k: k >= count,
        finish=lambda count, k: jnp.ones(()),
    )

    @jax.jit
    def call(count):
        with jax.enable_x64(False):
            return batched_loop.run(ones, count)

    with pytest.raises(TypeError, match="precision was changed inside a function"):
        call(jnp.asarray(3, jnp.int32))

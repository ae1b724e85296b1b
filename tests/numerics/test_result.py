"""Result codes, and the one place where they become exceptions."""

import equinox as eqx
import jax
import jax.numpy as jnp
import pytest

from bearingjax.numerics import Result, SolveError, as_real
from bearingjax.numerics.result import code, raise_unless_converged, worst


def test_codes_are_ordered_by_gravity():
    assert [r.label for r in sorted(Result)] == [
        "converged",
        "step_limit",
        "saddle",
        "no_load_path",
        "non_finite",
        "not_run",
        "grid_misfit",
    ]
    codes = jnp.stack([code(r) for r in (Result.SADDLE, Result.CONVERGED)])
    assert worst(codes) == Result.SADDLE
    assert codes.dtype == jnp.int32 and worst(codes).dtype == jnp.int32


def test_converged_passes_through():
    tree = {"x": jnp.asarray(1.5), "name": "anything"}

    def message():
        raise AssertionError("a message nobody needs")

    codes = jnp.zeros((2, 3), jnp.int32)
    assert raise_unless_converged(tree, codes, message) is tree


@pytest.mark.parametrize("bad", [r for r in Result if r != Result.CONVERGED])
def test_raises_outside_jit(bad):
    codes = jnp.asarray([int(Result.CONVERGED), int(bad)], jnp.int32)
    with pytest.raises(SolveError, match="roller 7: cause and cure"):
        raise_unless_converged(None, codes, lambda: "roller 7: cause and cure")


def test_raises_under_jit():
    @eqx.filter_jit
    def call(x, result):
        return raise_unless_converged(x, result, lambda: "not called")

    assert call(jnp.asarray(2.0), code(Result.CONVERGED)) == 2.0
    with pytest.raises(RuntimeError, match="did not converge"):
        jax.block_until_ready(call(jnp.asarray(2.0), code(Result.STEP_LIMIT)))


def test_as_real():
    assert as_real(1).dtype == jnp.float64 and as_real(1).shape == ()
    single = jnp.asarray(1.0, jnp.float32)
    assert as_real(single) is single
    assert as_real(jnp.asarray(3)).dtype == jnp.float64
    assert as_real([1, 2]).shape == (2,)

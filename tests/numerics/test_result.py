"""Result codes, and the one place where they become exceptions."""

import equinox as eqx
import jax
import jax.numpy as jnp
import pytest

from bearingjax.numerics import Result, SolveError, as_real
from bearingjax.numerics.result import code, raise_unless_converged, worst_code


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
    assert worst_code(codes) == Result.SADDLE
    assert codes.dtype == jnp.int32 and worst_code(codes).dtype == jnp.int32


def test_converged_passes_through():
    tree = {"x": jnp.asarray(1.5), "name": "anything"}

    def message():
        raise AssertionError("a message nobody needs")

    codes = jnp.zeros((2, 3), jnp.int32)
    assert raise_unless_converged(tree, codes, message, "call") is tree


@pytest.mark.parametrize("bad", [r for r in Result if r != Result.CONVERGED])
def test_raises_outside_jit(bad):
    codes = jnp.asarray([int(Result.CONVERGED), int(bad)], jnp.int32)
    with pytest.raises(SolveError, match="roller 7: cause and cure"):
        raise_unless_converged(None, codes, lambda: "roller 7: cause and cure", "call")


UNDER_JIT = {
    Result.STEP_LIMIT: "call: the solve did not converge within its step limit. Call",
    Result.SADDLE: "call: the solve ended at a saddle",
    Result.NO_LOAD_PATH: "call: no load path: a part is loaded",
    Result.NON_FINITE: "call: numbers that are not finite",
    Result.NOT_RUN: "call: cases were not run",
    Result.GRID_MISFIT: "call: too few grid points",
}


@eqx.filter_jit
def checked(x, result, which):
    def message():
        raise AssertionError("known outside jit alone")

    details = which, ["No path in ux.", "No path in uy."]
    return raise_unless_converged(x, result, message, "call", details)


def test_raises_under_jit():
    """The text is that of the code, of many cases that of the worst."""
    one, none = jnp.asarray(2.0), jnp.asarray(-1, jnp.int32)
    assert checked(one, code(Result.CONVERGED), none) == 2.0
    for bad, text in UNDER_JIT.items():
        with pytest.raises(RuntimeError, match=text):
            jax.block_until_ready(checked(one, code(bad), none))
    path = code(Result.NO_LOAD_PATH)
    with pytest.raises(RuntimeError, match="call: No path in uy. Call with throw=Fals"):
        jax.block_until_ready(checked(one, path, jnp.asarray(1, jnp.int32)))
    codes = jnp.asarray([0, 1, 3, 3, 4], jnp.int32)
    which = jnp.asarray([-1, -1, 0, 1, -1], jnp.int32)
    for worst_of, text in ((5, "not finite"), (4, "path in uy"), (3, "path in ux")):
        for call in (checked, jax.vmap(checked)):
            given = codes[:worst_of], which[:worst_of]
            with pytest.raises(RuntimeError, match=text):
                jax.block_until_ready(call(jnp.ones(worst_of), *given))


def test_as_real():
    assert as_real(1).dtype == jnp.float64 and as_real(1).shape == ()
    single = jnp.asarray(1.0, jnp.float32)
    assert as_real(single) is single
    assert as_real(jnp.asarray(3)).dtype == jnp.float64
    assert as_real([1, 2]).shape == (2,)

"""Result codes of solvers, and the one place where they become exceptions."""

import enum
from collections.abc import Callable, Sequence

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jaxtyping import Array, Int

from .types import T, in_numpy


class Result(enum.IntEnum):
    """Result code of a solve; ordered, so that the worst of many is their maximum."""

    CONVERGED = 0
    STEP_LIMIT = 1
    SADDLE = 2
    NO_LOAD_PATH = 3
    NON_FINITE = 4
    NOT_RUN = 5
    """A case of a sweep that was ended before its turn; no solver returns it."""
    GRID_MISFIT = 6
    """Grid too small or too coarse for a half-space contact, or too few places along
    an orbit."""

    @property
    def label(self) -> str:
        """Lower-case name, as files and messages write it."""
        return self.name.lower()


class SolveError(RuntimeError):
    """A solve did not converge; the message names cause and cure.

    Attributes:
        result: Its code, of many the worst; `None`: not of a single solve.
    """

    def __init__(self, message: str, result: Result | None = None):
        super().__init__(message)
        self.result = result


def code(result: Result) -> Int[Array, ""]:
    """Result code as a traced integer."""
    return jnp.asarray(int(result), dtype=jnp.int32)


def worst_code(codes: Int[Array, "..."]) -> Int[Array, ""]:
    """The worst code of many."""
    return jnp.max(codes).astype(jnp.int32)


_CAUSES = {
    Result.STEP_LIMIT: "the solve did not converge within its step limit",
    Result.SADDLE: "the solve ended at a saddle, not at a minimum of the energy",
    Result.NO_LOAD_PATH: "no load path: a part is loaded along a motion that nothing"
    " holds",
    Result.NON_FINITE: "numbers that are not finite or far outside the bearing: check"
    " loads, speeds and dimensions for NaN, infinity and units",
    Result.NOT_RUN: "cases were not run",
    Result.GRID_MISFIT: "too few grid points for the contact, or too few places along"
    " an orbit",
}
"""Cause of each result code, for errors under `jit`, which know no numbers."""


def raise_unless_converged(
    tree: T,
    result: Int[Array, "..."],
    message: Callable[[], str],
    owner: str,
    details: tuple[Int[Array, "..."], Sequence[str]] | None = None,
) -> T:
    """Return `tree`, or raise if `result` is not `CONVERGED`.

    Outside `jit` a `SolveError`; under `jit` Equinox's run-time error, through the
    one host callback that the package ever makes. It says what the worst code means.

    Args:
        tree: Anything with arrays, returned as it is.
        result: Result codes, any shape.
        message: Called without arguments outside `jit` for the text; it may read
            concrete values.
        owner: Function that was called, with which the text under `jit` begins.
        details: Under `jit`, more exact texts of `NO_LOAD_PATH`, and the index of that
            which holds, of the shape of `result`; the usual one at -1.

    Raises:
        SolveError: If a code is not `CONVERGED` (outside `jit`).
    """
    result = in_numpy(result)
    failed = result != Result.CONVERGED
    if not isinstance(result, Tracer):
        if np.any(failed):
            raise SolveError(message(), Result(int(np.max(result))))
        return tree
    which, texts = details if details is not None else (jnp.full_like(result, -1), [])
    # In the order of the codes, so that of many cases the worst is named.
    path, more = int(Result.NO_LOAD_PATH), len(texts)
    at = jnp.where(result == path, path + which + 1, result)
    at = jnp.where(result > path, result + more, at)
    causes = [_CAUSES.get(code, "") for code in Result]
    causes[path + 1 : path + 1] = texts
    end = "Call with throw=False and read `result`."
    texts = [f"{owner}: {cause.removesuffix('.')}. {end}" for cause in causes]
    return eqx.branched_error_if(tree, jnp.any(failed), jnp.max(at), texts)

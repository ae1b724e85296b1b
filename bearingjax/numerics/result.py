"""Result codes of solvers, and the one place where they become exceptions."""

import enum

import equinox as eqx
import jax.numpy as jnp
from jax.core import Tracer
from jaxtyping import Array, Int


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


def worst(codes: Int[Array, "..."]) -> Int[Array, ""]:
    """The worst code of many."""
    return jnp.max(codes).astype(jnp.int32)


def raise_unless_converged(tree, result: Int[Array, "..."], message):
    """Return `tree`, or raise if `result` is not `CONVERGED`.

    Outside `jit` a `SolveError`; under `jit` Equinox's run-time error, through the
    one host callback that the package ever makes.

    Args:
        tree: Anything with arrays, returned as it is.
        result: Result codes, any shape.
        message: Called without arguments outside `jit` for the text; it may read
            concrete values.

    Raises:
        SolveError: If a code is not `CONVERGED` (outside `jit`).
    """
    if isinstance(result, Tracer):
        return eqx.error_if(
            tree,
            jnp.any(result != Result.CONVERGED),
            "bearingjax: the solve did not converge; call with throw=False and read"
            " `result`.",
        )
    if bool(jnp.any(result != Result.CONVERGED)):
        raise SolveError(message(), Result(int(jnp.max(result))))
    return tree

"""Eigenvalues of symmetric matrices, one matrix after the other under `vmap`.

A batch may keep a program waiting for ever, see `linear`.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Inexact

from .linear import one_by_one


@jax.custom_jvp
def eigh(
    matrix: Inexact[Array, "n n"],
) -> tuple[Inexact[Array, " n"], Inexact[Array, "n n"]]:
    """Eigenvalues, rising, and unit eigenvectors of a symmetric or Hermitian matrix.

    Vectors of one and the same eigenvalue are any basis of the space that they span.
    They have no derivative: it comes out infinite, or NaN.

    Args:
        matrix: A, of which the Hermitian part counts [any unit].

    Returns:
        Eigenvalues (n,) [unit of A] and vectors, column by column (n, n) [1].
    """
    return _one_by_one(matrix)


@eigh.defjvp
def _eigh_rule(primals, tangents):
    values, vectors = eigh(*primals)
    (change,) = tangents
    inner = vectors.conj().T @ (0.5 * (change + change.conj().T)) @ vectors
    unit = jnp.eye(values.shape[0], dtype=values.dtype)
    turns = 1.0 / (values[None, :] - values[:, None] + unit) - unit
    turn = inner * turns.astype(inner.dtype)
    return (values, vectors), (jnp.diagonal(inner).real, vectors @ turn)


@one_by_one
def _one_by_one(matrix):
    return tuple(jnp.linalg.eigh(matrix))

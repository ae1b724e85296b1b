"""Eigenvalues of symmetric matrices, one matrix after the other under `vmap`.

jaxlib 0.10 divides a large batch of matrices among XLA's threads, by the thread that
ran into it, which then waits for its share to be done by others. As soon as every
thread waits so, for as many batches that do not depend on each other, the program
waits for ever: on two cores two batches are enough. One matrix is never divided.
"""

import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_batching import custom_vmap
from jaxtyping import Array, Inexact


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


@custom_vmap
def _one_by_one(matrix):
    return tuple(jnp.linalg.eigh(matrix))


@_one_by_one.def_vmap
def _rule(_, __, matrix):
    return lax.map(_one_by_one, matrix), (True, True)

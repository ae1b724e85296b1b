"""LAPACK, given one matrix after the other under `jax.vmap`.

jaxlib 0.10 divides a large batch of matrices among XLA's threads, by the thread that
ran into it, which then waits for its share to be done by others. As soon as every
thread waits so, for as many batches that do not depend on each other, the program
waits for ever: on two cores two batches are enough. One matrix is never divided. All
calls of LAPACK in the package are therefore here, through `one_by_one`.
"""

import functools
import math
from collections.abc import Callable

import jax
import jax.numpy as jnp
import jax.scipy.linalg as dense
import numpy as np
from jax import lax
from jax.custom_batching import custom_vmap
from jaxtyping import Array, Complex, Float, Inexact

from .types import Square

_PADE = [math.comb(13, k) / math.perm(26, k) for k in range(14)]
"""Coefficients of the Padé approximant of order 13 of the exponential [1]."""
_PADE_REACH = 5.37
"""Norm up to which it is exact in double precision [1]."""
_SQUARINGS, _BALANCED = 20, 8
"""Most squarings of an exponential, and rounds in which a matrix is balanced."""


def one_by_one(function: Callable) -> Callable:
    """A function of arrays that `jax.vmap` calls for one member after the other.

    It is not to be differentiated: give it what `lax.stop_gradient` returns.

    Args:
        function: Function of arrays; returns a pytree of arrays.
    """

    @custom_vmap
    def single(*arrays):
        return function(*arrays)

    @single.def_vmap
    def _rule(_, mapped, *arrays):
        def call(members):
            member = iter(members)
            return single(
                *(next(member) if m else a for a, m in zip(arrays, mapped, strict=True))
            )

        members = [a for a, m in zip(arrays, mapped, strict=True) if m]
        # Unrolled: small matrices take as long as a turn of the loop.
        _, found = lax.scan(lambda _, m: (None, call(m)), None, members, unroll=4)
        return found, jax.tree.map(lambda _: True, found)

    return single


def _solver(way: Callable) -> Callable:
    """`one_by_one` of a solver; one factorisation serves all right-hand sides.

    Args:
        way: Function of a matrix (n, n) and right-hand sides (n, k).
    """
    each = one_by_one(way)

    @custom_vmap
    def single(matrix, rhs):
        return each(matrix, rhs)

    @single.def_vmap
    def _rule(_, mapped, matrix, rhs):
        if mapped[0]:
            return jax.vmap(each, [0 if m else None for m in mapped])(matrix, rhs), True
        columns = jnp.moveaxis(rhs, 0, -1)
        found = single(matrix, columns.reshape(rhs.shape[1], -1))
        return jnp.moveaxis(found.reshape(columns.shape), -1, 0), True

    return single


_by_elimination = _solver(jnp.linalg.solve)
_by_cholesky = _solver(lambda a, b: dense.cho_solve(dense.cho_factor(a), b))
_forwards = _solver(lambda a, b: dense.solve_triangular(a, b, lower=True))
_backwards = _solver(lambda a, b: dense.solve_triangular(a, b, lower=False))
_WAYS = {
    "regular": (_by_elimination, _by_elimination),
    "positive": (_by_cholesky, _by_cholesky),
    "lower": (_forwards, _backwards),
    "upper": (_backwards, _forwards),
}
"""Solvers for each kind of matrix and for its transpose."""


def solve_any(
    matrix: Inexact[Array, "n n"],
    rhs: Inexact[Array, "n ..."],
    kind: str = "regular",
) -> Inexact[Array, "n ..."]:
    """Solve a system of any number of unknowns, differentiable to any order.

    Args:
        matrix: Regular [any unit].
        rhs: One or more right-hand sides.
        kind: "regular", "positive" (symmetric and positive definite), "lower" or
            "upper" (triangular, the other half being zero). Static.

    Returns:
        Solution, shape of `rhs`; NaN if a matrix that is said to be positive is not.
    """
    held = lax.stop_gradient(matrix)
    forth, back = _WAYS[kind]
    return lax.custom_linear_solve(
        lambda x: matrix @ x,
        rhs,
        lambda _, b: forth(held, b),
        lambda _, b: back(held.T, b),
        symmetric=kind == "positive",
    )


@jax.custom_jvp
def cholesky(matrix: Square) -> Square:
    """Lower triangular L of A = L Lᵀ [root of the unit]; NaN if there is none.

    Args:
        matrix: A, symmetric and positive definite [any unit].
    """
    return _factor(matrix)


@cholesky.defjvp
def _cholesky_rule(primals, tangents):
    lower = cholesky(*primals)
    inner = congruent(lower, tangents[0])
    half = jnp.tril(inner) - 0.5 * jnp.diag(jnp.diagonal(inner))
    return lower, lower @ half


_factor = one_by_one(jnp.linalg.cholesky)


def congruent(factor: Square, matrix: Square) -> Square:
    """L⁻¹ A L⁻ᵀ: a matrix in coordinates in which L Lᵀ is one.

    Args:
        factor: L, lower triangular.
        matrix: A.
    """
    half = solve_any(factor, matrix, "lower")
    return solve_any(factor, half.T, "lower").T


def determinant_sign(matrix: Square) -> Float[Array, ""]:
    """Sign of the determinant [1]; it has no derivative."""
    return _sign(lax.stop_gradient(matrix))


_sign = one_by_one(lambda matrix: jnp.linalg.slogdet(matrix)[0])


def pseudoinverse(
    matrix: Float[Array, "m n"], slack: float | None = None
) -> Float[Array, "n m"]:
    """Moore-Penrose pseudoinverse: inverse in all directions outside the null space.

    Args:
        matrix: Any, of a rank that does not change where it is differentiated.
        slack: Singular values, over the largest, that count as zero [1]; `None`: ten
            times the round-off of its size. Static.
    """

    @jax.custom_jvp
    def inverse(a):
        return one_by_one(lambda a: jnp.linalg.pinv(a, rtol=slack))(a)

    @inverse.defjvp
    def _rule(primals, tangents):
        (a,), (change,) = primals, tangents
        p = inverse(a)
        moved = p @ p.T @ change.T
        moved = moved - moved @ a @ p
        back = change.T @ p.T @ p
        return p, moved + back - p @ (a @ back + change @ p)

    return inverse(matrix)


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
    return _eigh(matrix)


@eigh.defjvp
def _eigh_rule(primals, tangents):
    values, vectors = eigh(*primals)
    (change,) = tangents
    inner = vectors.conj().T @ (0.5 * (change + change.conj().T)) @ vectors
    unit = jnp.eye(values.shape[0], dtype=values.dtype)
    turns = 1.0 / (values[None, :] - values[:, None] + unit) - unit
    turn = inner * turns.astype(inner.dtype)
    return (values, vectors), (jnp.diagonal(inner).real, vectors @ turn)


_eigh = one_by_one(lambda matrix: tuple(jnp.linalg.eigh(matrix)))


def eig(
    matrix: Square,
) -> tuple[Complex[Array, " n"], Complex[Array, "n n"], Complex[Array, "n n"]]:
    """Eigenvalues of any matrix, left and right unit vectors, column by column.

    On processors only, and without derivatives.

    Args:
        matrix: A [any unit].
    """
    return _eig(matrix)


_eig = one_by_one(lambda matrix: tuple(lax.linalg.eig(matrix)))


@jax.custom_jvp
def eigvals(matrix: Square) -> Complex[Array, " n"]:
    """Eigenvalues of any matrix, in no order; on processors only.

    They have first derivatives; where several are the same, those of a mixture.

    Args:
        matrix: A [any unit].
    """
    return _eigvals(matrix)


@eigvals.defjvp
def _eigvals_rule(primals, tangents):
    values, _, vectors = eig(*primals)
    moved = tangents[0].astype(vectors.dtype) @ vectors
    return values, jnp.diagonal(solve_any(vectors, moved))


_eigvals = one_by_one(jnp.linalg.eigvals)


def expm(matrices: Float[Array, "matrix n n"]) -> Float[Array, "matrix n n"]:
    """Exponentials of matrices that are alike in their units and sizes.

    Args:
        matrices: A, each component in whatever unit [1].

    Returns:
        Of the shape of A; NaN beyond a norm of 5e6 where all components are in the
        units that make it least.

    Source: Higham, SIAM J. Matrix Anal. Appl. 26 (2005) 1179, order 13 throughout.
    """
    units = _balance(lax.stop_gradient(matrices))
    turned = (units[:, None] / units[None, :])[None]
    matrices = matrices * turned
    size = jnp.max(jnp.sum(jnp.abs(lax.stop_gradient(matrices)), axis=-2))
    count = jnp.maximum(jnp.ceil(jnp.log2(size / _PADE_REACH)), 0.0)
    a = matrices * 2.0**-count
    unit = jnp.broadcast_to(jnp.eye(a.shape[-1], dtype=a.dtype), a.shape)
    two = a @ a
    four, b = two @ two, _PADE
    six = four @ two

    def series(k):
        """Sum of b[k + 2j] a^(2j)."""
        high = b[k + 12] * six + b[k + 10] * four + b[k + 8] * two
        low = b[k + 6] * six + b[k + 4] * four + b[k + 2] * two + b[k] * unit
        return six @ high + low

    even, odd = series(0), a @ series(1)
    found = jax.vmap(solve_any)(even - odd, even + odd)

    def square(found, k):
        return lax.cond(k < count, lambda x: x @ x, lambda x: x, found), None

    found, _ = lax.scan(square, found, jnp.arange(_SQUARINGS, dtype=a.dtype))
    return jnp.where(count <= _SQUARINGS, found / turned, jnp.nan)


def _balance(matrices):
    """Factors of components with which rows and columns are about the same (n,).

    A stiff vibration has its squared frequency in one of them and one in the other:
    squarings would lose as many digits as that has.
    """
    sizes = jnp.max(jnp.abs(matrices), axis=0)
    units = jnp.ones_like(sizes[0])
    for _ in range(_BALANCED):
        there = sizes * units[:, None] / units[None, :]
        rows, columns = jnp.sum(there, axis=1), jnp.sum(there, axis=0)
        some = (rows > 0) & (columns > 0)
        share = jnp.where(some, columns, 1.0) / jnp.where(some, rows, 1.0)
        units = units * share**0.25
    return units


@functools.cache
def prepare() -> None:
    """Have JAX find the addresses of LAPACK, as it does when it lowers a call of it.

    A program that was compiled in another process crashes without.
    """
    jax.jit(jnp.linalg.cholesky).lower(np.eye(1))

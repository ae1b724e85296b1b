"""Linear systems of a few unknowns, written out so that they batch.

LAPACK is called once per matrix; for 3 to 6 unknowns under `vmap` the unrolled
factorisation is many times faster and has no foreign call in it. More than eight go to
LAPACK: a program written out grows with their third power.
"""

from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, Float

from .lapack import solve_any
from .types import Reals, Square, Vector, array_namespace

_WRITTEN_OUT = 8
"""Most unknowns of a system that is written out."""


def dot(a: Vector, b: Vector) -> Float[Array, ""]:
    """a · b.

    Args:
        a, b: Vectors of a few components (n,) [any unit].
    """
    return _sum(a * b)


def norm(a: Vector) -> Float[Array, ""]:
    """|a| [unit of a]."""
    return jnp.sqrt(dot(a, a))


def lengths(vectors: Any) -> Any:
    """Lengths of vectors along the last axis; where one is 0 its derivative is 0.

    Args:
        vectors: Arrays of NumPy or of JAX (…, component) [any unit].
    """
    xp, squares = array_namespace(vectors), (vectors**2).sum(axis=-1)
    none = squares == 0
    return xp.where(none, 0.0, xp.sqrt(xp.where(none, 1.0, squares)))


def combine_rows(rows: Float[Array, "n m"], shares: Vector) -> Float[Array, " m"]:
    """Σ shares_i rows_i, for a few rows [any unit]."""
    return _sum(rows * shares[:, None])


def quadratic(matrix: Square, a: Vector) -> Float[Array, ""]:
    """aᵀ M a, for a symmetric M."""
    return dot(a, _sum(matrix * a[:, None]))


def trace(matrix: Square) -> Float[Array, ""]:
    """Sum of the diagonal."""
    return _sum(_diagonal(matrix))


def _sum(terms: Float[Array, "n ..."]) -> Reals:
    """Sum over the first axis; up to three terms written out, so that it fuses."""
    n = terms.shape[0]
    if n > 3:
        return jnp.sum(terms, axis=0)
    return sum((terms[i] for i in range(1, n)), start=terms[0])


def _diagonal(matrix: Square) -> Vector:
    return jnp.stack([matrix[i, i] for i in range(matrix.shape[0])])


def solve_symmetric(
    matrix: Square, rhs: Float[Array, "n ..."]
) -> Float[Array, "n ..."]:
    """Solve a symmetric positive (semi)definite system, L D Lᵀ with unit scaling.

    Rows are scaled to a unit diagonal. A pivot below round-off marks a direction
    that the matrix does not hold: it is lifted to round-off and its coupling, which
    is round-off too, dropped, so that the answer stays finite.

    Args:
        matrix: Symmetric, n ≤ 6 in this package [any unit].
        rhs: One or more right-hand sides.

    Returns:
        Solution, shape of `rhs`.
    """
    lower, pivots, scale = _factorise(matrix)
    return _substitute(lower, pivots, scale, rhs)


def solve(
    matrix: Square, rhs: Float[Array, "n ..."], symmetric: bool = True
) -> Float[Array, "n ..."]:
    """Solve by `solve_symmetric`, or by elimination without pivoting if unsymmetric.

    A tangent with a part that has no potential is a positive (semi)definite matrix
    but for a few per cent: its pivots need no search, and a pivot below round-off is
    treated as in `solve_symmetric`.

    Args:
        matrix: With a positive diagonal where it holds anything [any unit].
        rhs: One or more right-hand sides.
        symmetric: Whether the matrix is symmetric. Static.

    Returns:
        Solution, shape of `rhs`.
    """
    n = matrix.shape[-1]
    if n > _WRITTEN_OUT:
        return _solve_scaled(matrix, rhs)
    if symmetric:
        return solve_symmetric(matrix, rhs)
    floor = 8 * jnp.finfo(matrix.dtype).eps
    scale = _scale(_diagonal(matrix))
    scaled = matrix * (scale[:, None] * scale[None, :])
    a = [[scaled[i, j] for j in range(n)] for i in range(n)]
    b = [rhs[i] * scale[i] for i in range(n)]
    for k in range(n):
        # "not above" would swallow NaN: a NaN pivot stays NaN.
        lifted = a[k][k] < floor
        pivot = jnp.where(lifted, floor, a[k][k])
        a[k][k] = pivot
        for i in range(k + 1, n):
            factor = jnp.where(lifted, 0.0, a[i][k] / pivot)
            for j in range(k + 1, n):
                a[i][j] = a[i][j] - factor * a[k][j]
            b[i] = b[i] - factor * b[k]
        for j in range(k + 1, n):
            a[k][j] = jnp.where(lifted, 0.0, a[k][j])
    x: list[Any] = [None] * n
    for i in reversed(range(n)):
        value = b[i]
        for j in range(i + 1, n):
            value = value - a[i][j] * x[j]
        x[i] = value / a[i][i]
    return jnp.stack([x[i] * scale[i] for i in range(n)])


def _solve_scaled(matrix, rhs):
    """Solve with unit diagonal, shifted by round-off along unrestrained directions."""
    diagonal = jnp.diagonal(matrix)
    scale = _scale(diagonal)
    held = diagonal > jnp.finfo(matrix.dtype).tiny
    lift = jnp.where(held, 8 * jnp.finfo(matrix.dtype).eps, 1.0)
    scaled = matrix * (scale[:, None] * scale[None, :]) + jnp.diag(lift)
    sizes = scale.reshape(-1, *(1,) * (rhs.ndim - 1))
    return sizes * solve_any(scaled, sizes * rhs)


def null_space(matrix: Square) -> Square:
    """Projector on the directions that a matrix does not hold, (n, n) [1].

    Zero if it holds all. It is not to be differentiated.

    Args:
        matrix: Symmetric and positive semidefinite, of size 1 [1].

    Source: McWeeny, Rev. Mod. Phys. 32 (1960) 335: 3 P² - 2 P³ takes shares of an
        eigenvector to 0 or 1; nothing but products, so that it batches.
    """
    # Sums over many elements leave more round-off than one product.
    least = 32.0 * jnp.finfo(matrix.dtype).eps
    eye = jnp.eye(matrix.shape[-1], dtype=matrix.dtype)
    share = least * solve_symmetric(0.5 * (matrix + matrix.T) + least * eye, eye)
    for _ in range(8):
        square = jnp.matmul(share, share, precision="highest")
        share = 3.0 * square - 2.0 * jnp.matmul(square, share, precision="highest")
    return share


def smallest_pivot(matrix: Square) -> Float[Array, ""]:
    """Smallest pivot of the matrix scaled to a unit diagonal [1].

    Negative beyond round-off: the matrix is indefinite.
    """
    n = matrix.shape[-1]
    diagonal = _diagonal(matrix)
    negative = jnp.any(diagonal < 0)
    scale = _scale(diagonal)
    scaled = matrix * scale[:, None] * scale[None, :]
    pivots = []
    work = [[scaled[i, j] for j in range(n)] for i in range(n)]
    floor = 8 * jnp.finfo(matrix.dtype).eps
    for k in range(n):
        pivots.append(work[k][k])
        pivot = jnp.where(jnp.abs(work[k][k]) < floor, floor, work[k][k])
        for i in range(k + 1, n):
            factor = work[i][k] / pivot
            for j in range(k + 1, i + 1):
                work[i][j] = work[i][j] - factor * work[j][k]
    return jnp.where(negative, -1.0, jnp.min(jnp.stack(pivots)))


def _scale(diagonal):
    usable = diagonal > jnp.finfo(diagonal.dtype).tiny
    return jnp.where(usable, 1.0 / jnp.sqrt(jnp.where(usable, diagonal, 1.0)), 1.0)


def _factorise(matrix):
    n = matrix.shape[-1]
    floor = 8 * jnp.finfo(matrix.dtype).eps
    scale = _scale(_diagonal(matrix))
    scaled = matrix * (scale[:, None] * scale[None, :])
    a = [[scaled[i, j] for j in range(i + 1)] for i in range(n)]
    lower = [[None] * n for _ in range(n)]
    pivots = []
    for j in range(n):
        pivot = a[j][j]
        for k in range(j):
            pivot = pivot - lower[j][k] * lower[j][k] * pivots[k]
        # "not above" would swallow NaN: a NaN pivot stays NaN.
        lifted = pivot < floor
        pivots.append(jnp.where(lifted, floor, pivot))
        for i in range(j + 1, n):
            entry = a[i][j]
            for k in range(j):
                entry = entry - lower[i][k] * lower[j][k] * pivots[k]
            lower[i][j] = jnp.where(lifted, 0.0, entry / pivots[j])
    return lower, pivots, scale


def _substitute(lower, pivots, scale, rhs):
    n = len(pivots)
    y = []
    for i in range(n):
        value = rhs[i] * scale[i]
        for k in range(i):
            value = value - lower[i][k] * y[k]
        y.append(value)
    x = [None] * n
    for i in reversed(range(n)):
        value = y[i] / pivots[i]
        for k in range(i + 1, n):
            value = value - lower[k][i] * x[k]
        x[i] = value
    return jnp.stack([x[i] * scale[i] for i in range(n)])

"""Modal damping without modes: smooth where natural frequencies coincide."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.types import Scalar


@jax.custom_jvp
def matrix_root(matrix: Float[Array, "n n"]) -> Float[Array, "n n"]:
    """Square root of a symmetric positive definite matrix, differentiable at any order.

    Its derivative solves S dS + dS S = dA, which repeated eigenvalues do not disturb.

    Args:
        matrix: A [any unit].
    """
    values, vectors = jnp.linalg.eigh(matrix)
    return (vectors * jnp.sqrt(values)[None, :]) @ vectors.T


@matrix_root.defjvp
def _matrix_root_jvp(primals, tangents):
    root = matrix_root(*primals)
    unit = jnp.eye(root.shape[0], dtype=root.dtype)
    whole = jnp.kron(root, unit) + jnp.kron(unit, root)
    change = jnp.linalg.solve(whole, tangents[0].reshape(-1))
    return root, change.reshape(root.shape)


def modal_damping(
    mass: Float[Array, "n n"], stiffness: Float[Array, "n n"], ratio: Scalar
) -> Float[Array, "n n"]:
    """Damping matrix that gives every mode the same damping ratio [N s/m, N m s/rad].

    C = 2ζ L (L⁻¹ K L⁻ᵀ)^(1/2) Lᵀ with M = L Lᵀ, which is Σ 2ζ ω M φ φᵀ M.

    Args:
        mass: M [kg, kg m²].
        stiffness: K, symmetric and positive definite [N/m, N m/rad].
        ratio: ζ, of the critical damping [1].
    """
    lower = jnp.linalg.cholesky(mass)
    half = jax.scipy.linalg.solve_triangular(lower, stiffness, lower=True)
    reduced = jax.scipy.linalg.solve_triangular(lower, half.T, lower=True)
    root = matrix_root(0.5 * (reduced + reduced.T))
    return 2.0 * ratio * lower @ root @ lower.T

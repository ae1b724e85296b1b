"""Damping of a rotor other than that of its supports."""

from abc import abstractmethod
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design.checks import check_fields, non_negative
from ..numerics.lapack import cholesky, congruent, eigh
from ..numerics.types import Real
from ..numerics.units import real

Matrix = Float[Array, "freedom freedom"]


class AbstractDamping(eqx.Module):
    """Damping matrix from mass and stiffness matrices.

    It acts against the motion as seen from the ground. Damping inside a turning shaft
    acts otherwise: above the first critical speed it drives the whirl, and is not
    modelled.
    """

    @abstractmethod
    def matrix(
        self, shaft: tuple[Matrix, Matrix], rotor: tuple[Matrix, Matrix]
    ) -> Matrix:
        """Damping matrix [N s/m, N s, N m s].

        Args:
            shaft: Mass and stiffness matrix of the shaft alone.
            rotor: Matrices of the whole rotor on its supports.
        """


class ProportionalDamping(AbstractDamping):
    """Damping proportional to mass and stiffness of the shaft (Rayleigh's).

    A vibration of the shaft alone at ω has the damping ratio
    ½ (mass_factor/ω + stiffness_factor·ω).

    Attributes:
        mass_factor: Damping over mass [1/s].
        stiffness_factor: Damping over stiffness [s].

    Traced: all fields.
    """

    about: ClassVar[str] = "damping in proportion to mass and stiffness of the shaft"
    mass_factor: Real = eqx.field(
        **real("1/s", "damping over mass", least=0), default=0.0
    )
    stiffness_factor: Real = eqx.field(
        **real("s", "damping over stiffness", least=0), default=0.0
    )

    def __check_init__(self):
        check_fields(self)

    def matrix(
        self, shaft: tuple[Matrix, Matrix], rotor: tuple[Matrix, Matrix]
    ) -> Matrix:
        """Damping matrix [N s/m, N s, N m s]."""
        mass, stiffness = shaft
        return self.mass_factor * mass + self.stiffness_factor * stiffness


class ModalDamping(AbstractDamping):
    """Uniform damping ratio for all modes of the undamped rotor at rest.

    Supports count with the stiffness that they have at the speed of the analysis.

    Attributes:
        ratio: Damping ratio [1].

    Traced: ratio.
    """

    ratio: Real = eqx.field(**real("1", "damping ratio of all modes"))

    def __check_init__(self):
        non_negative(self, "ratio")

    def matrix(
        self, shaft: tuple[Matrix, Matrix], rotor: tuple[Matrix, Matrix]
    ) -> Matrix:
        """Return the damping matrix [N s/m, N s, N m s]: 2 ζ ω m for every mode."""
        mass, stiffness = rotor
        factor = cholesky(mass)
        modal = congruent(factor, 0.5 * (stiffness + stiffness.T))
        return 2.0 * self.ratio * factor @ square_root(modal) @ factor.T


@jax.custom_jvp
def square_root(matrix: Matrix) -> Matrix:
    """Return the square root of a symmetric positive semidefinite matrix.

    Its derivative exists where eigenvalues coincide too; in a space where the matrix
    is zero it is taken as zero.
    """
    roots, vectors = _roots(matrix)
    return (vectors * roots[None, :]) @ vectors.T


@square_root.defjvp
def _square_root_rule(primals, tangents):
    roots, vectors = _roots(primals[0])
    sums = roots[:, None] + roots[None, :]
    none = sums <= 0
    inner = vectors.T @ tangents[0] @ vectors
    change = jnp.where(none, 0.0, inner / jnp.where(none, 1.0, sums))
    return (vectors * roots[None, :]) @ vectors.T, vectors @ change @ vectors.T


def _roots(matrix):
    """Return roots of the eigenvalues, and eigenvectors; round-off counts as zero."""
    values, vectors = eigh(matrix)
    size = values.shape[0]
    floor = 10.0 * size * jnp.finfo(matrix.dtype).eps * values[-1]
    zero = values <= floor
    return jnp.where(zero, 0.0, jnp.sqrt(jnp.where(zero, 1.0, values))), vectors

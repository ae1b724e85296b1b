"""Contact constants of a ball on its raceways, and the angle used for them.

The curvature of a raceway in the rolling direction depends on the contact angle α: the
sum of curvatures is 2/(D (1 ∓ γ cos α)) with γ = D/d_m, minus at the inner ring. Which
angle is meant is a choice by class.
"""

import abc
from typing import Annotated, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBallBearing, Groove, contact_modulus
from ..design.checks import positive
from ..numerics.types import Real, Reals, Scalar
from ..numerics.units import real, unit
from .hertz import Ellipse, ellipse

# Degree of the interpolation of ln c over cos α: 1e-13 for balls up to 0.4 of the
# pitch diameter.
_DEGREE = 20


class Balls(NamedTuple):
    """Sizes that a contact constant depends on.

    Attributes:
        diameter: Ball diameter [m].
        pitch_diameter: Diameter of the circle of the ball centres [m].
        modulus: Contact modulus E* [Pa].
    """

    diameter: Annotated[Scalar, unit("m")]
    pitch_diameter: Annotated[Scalar, unit("m")]
    modulus: Annotated[Scalar, unit("Pa")]


def ball_ellipses(balls: Balls, grooves: tuple[Groove, ...], cosine: Reals) -> Ellipse:
    """Exact Hertz contacts of a ball in its grooves.

    Args:
        balls: Sizes.
        grooves: All raceway arcs.
        cosine: Cosine of the contact angles, leading axis contact or one [1].

    Returns:
        Ellipses (contact, *n), semi-axes in rolling direction and across.

    Source: curvatures of a torus; Harris, Rolling Bearing Analysis.
    """
    shape = (len(grooves),) + (1,) * (cosine.ndim - 1)
    sign = jnp.asarray([1.0 if g.on_outer else -1.0 for g in grooves], cosine.dtype)
    radius = jnp.stack([g.radius for g in grooves])
    turn = sign.reshape(shape) * balls.diameter / balls.pitch_diameter
    rolling = 2.0 / (balls.diameter * (1.0 + turn * cosine))
    across = 2.0 / balls.diameter - 1.0 / radius.reshape(shape)
    return ellipse(rolling, jnp.broadcast_to(across, rolling.shape), balls.modulus)


def balls_of(bearing: AbstractBallBearing) -> Balls:
    """Sizes of the balls of a bearing."""
    modulus = contact_modulus(bearing.material, bearing.rings)
    return Balls(bearing.ball_diameter, bearing.pitch_diameter, modulus)


class AbstractPointLaw(eqx.Module):
    """Law for the constant c of Q = c·approach^(3/2) of a ball contact."""

    @property
    def follows_angle(self) -> bool:
        """Whether c changes with the operating angle. Static."""
        return False

    @property
    def curvature_follows_angle(self) -> bool:
        """Whether `cosine` depends on the operating angle. Static."""
        return True

    def cosine(self, free: Scalar, operating: Reals) -> Reals:
        """Cosine of the angle at which the curvatures are taken.

        Args:
            free: Cosine of the free contact angle [1].
            operating: Cosines of the operating angles [1].
        """
        return operating

    @abc.abstractmethod
    def constants(
        self, balls: Balls, grooves: tuple[Groove, ...], free_cosine: Scalar
    ) -> Float[Array, "contact ..."]:
        """Constants c of every contact, for the energy [N/m^(3/2)].

        For a law that follows the angle: coefficients of its logarithm
        (contact, degree + 1), see `at_angle`.

        Args:
            balls: Sizes.
            grooves: All raceway arcs.
            free_cosine: Cosine of the free contact angle [1].
        """


class FreeAngle(AbstractPointLaw):
    """Hertz constants with the curvatures at the free contact angle. The default.

    Source: Hertz (1882) through `ball_ellipses`.
    """

    @property
    def curvature_follows_angle(self) -> bool:
        return False

    def cosine(self, free: Scalar, operating: Reals) -> Reals:
        return jnp.broadcast_to(free, operating.shape)

    def constants(
        self, balls: Balls, grooves: tuple[Groove, ...], free_cosine: Scalar
    ) -> Float[Array, "contact ..."]:
        return ball_ellipses(balls, grooves, free_cosine[None]).constant


class ZeroAngle(AbstractPointLaw):
    """Hertz constants with the curvatures at contact angle zero, as ISO/TS 16281."""

    @property
    def curvature_follows_angle(self) -> bool:
        return False

    def cosine(self, free: Scalar, operating: Reals) -> Reals:
        return jnp.ones_like(operating)

    def constants(
        self, balls: Balls, grooves: tuple[Groove, ...], free_cosine: Scalar
    ) -> Float[Array, "contact ..."]:
        return ball_ellipses(balls, grooves, jnp.ones_like(free_cosine)[None]).constant


class OperatingAngle(AbstractPointLaw):
    """Hertz constants with the curvatures at the operating angle of every contact.

    The forces then have no potential (c changes without work), and the stiffness is
    slightly unsymmetric.
    """

    @property
    def follows_angle(self) -> bool:
        return True

    def constants(
        self, balls: Balls, grooves: tuple[Groove, ...], free_cosine: Scalar
    ) -> Float[Array, "contact ..."]:
        nodes = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
        at = jnp.asarray(nodes, free_cosine.dtype)
        values = jnp.log(ball_ellipses(balls, grooves, at[None]).constant)
        basis = np.polynomial.chebyshev.chebvander(nodes, _DEGREE)
        # Discrete orthogonality of the polynomials over their nodes.
        weights = np.full(_DEGREE + 1, 2.0 / (_DEGREE + 1))
        weights[0] *= 0.5
        return values @ jnp.asarray(basis * weights, free_cosine.dtype)


class PointConstant(AbstractPointLaw):
    """Constants given for the contacts of the outer and of the inner ring.

    Ellipses and pressures are Hertz's at the operating angle all the same.

    Attributes:
        outer: c at the outer raceway [N/m^(3/2)].
        inner: c at the inner raceway [N/m^(3/2)].

    Traced: all fields.
    """

    outer: Real = eqx.field(
        **real("N/m^(3/2)", "constant of Q = K δ^(3/2) on the outer raceway")
    )
    inner: Real = eqx.field(**real("N/m^(3/2)", "constant on the inner raceway"))

    def __check_init__(self):
        for name in ("outer", "inner"):
            positive(self, name)

    def constants(
        self, balls: Balls, grooves: tuple[Groove, ...], free_cosine: Scalar
    ) -> Float[Array, "contact ..."]:
        return jnp.stack([self.outer if g.on_outer else self.inner for g in grooves])


def at_angle(
    coefficients: Float[Array, "contact n"], angle: Float[Array, " contact"]
) -> Float[Array, " contact"]:
    """Constants of `OperatingAngle` at given contact angles [N/m^(3/2)].

    Args:
        coefficients: From `OperatingAngle.constants`.
        angle: Contact angles [rad].

    Source: T_k(cos α) = cos kα. A recurrence would take fewer operations but, with its
        derivatives, ten times as long to compile.
    """
    order = jnp.arange(coefficients.shape[1], dtype=angle.dtype)
    terms = coefficients * jnp.cos(order[None, :] * angle[:, None])
    return jnp.exp(jnp.sum(terms, axis=1))

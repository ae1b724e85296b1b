"""Kinematics and inertia of an orbiting ball, and its raceway control.

In the section at a ball's azimuth a contact angle is counted from the radius towards
+z. The ball's spin axis lies in the section at the pitch angle β, such that its spin
relative to the orbiting frame is ω_R (-cos β along z, sin β along r): opposite in sense
to the inner ring. Speeds are positive from x towards y.

Source: T. A. Harris, Rolling Bearing Analysis, with signs proved from d'Alembert's
principle; Jones, J. Basic Eng. 82 (1960).
"""

import abc
from typing import Annotated, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.checks import positive
from ...numerics.types import Real, Scalar, array_namespace
from ...numerics.units import real, unit
from ..inertia import Speed

MOST_FRICTION = 0.3
"""Coefficient of friction that no raceway contact exceeds, whatever the control [1]."""

# A load [N] far below any that matters, for shares of no load at all.
_NO_LOAD = 1e-15
# Keep the kinematics finite for geometries in which no ball rolls.
_COSINE, _SQUARE = 0.1, 1e-30

Direction = Float[Array, "2"]
"""Unit vector (z, r) from the inner to the outer side, along a contact normal."""


class AbstractRacewayControl(eqx.Module):
    """Raceway control: contact without spin, and share of the gyroscopic moment.

    The moment M is held by tractions T at the contacts, (T_o + T_i) D/2 = M. The
    traction of a contact is at most `MOST_FRICTION` times its load: a raceway that a
    ball has left gives no traction, and the ball then slips about the tangent of its
    orbit.
    """

    @property
    def has_reaction(self) -> bool:
        """Whether orbit and gyroscopic moment follow the operating angles. Static."""
        return True

    @property
    def has_moment(self) -> bool:
        """Whether the gyroscopic moment acts on the ball. Static."""
        return True

    @abc.abstractmethod
    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        """Share of the outer raceway in the direction of the spin axis.

        1: the ball does not spin on the outer raceway; 0: nor on the inner one.

        Args:
            load: Contact loads on outer and inner raceway [N].
        """

    @abc.abstractmethod
    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        """Tractions at outer and inner raceway [N].

        Args:
            load: Contact loads on outer and inner raceway [N].
            demand: 2M/D, the sum that would hold the ball [N].
        """


class OuterControl(AbstractRacewayControl):
    """Outer raceway control: pure rolling there, which takes the whole moment."""

    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        return jnp.ones_like(load[0])

    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        return jnp.stack([demand, jnp.zeros_like(demand)])


class InnerControl(AbstractRacewayControl):
    """Inner raceway control: pure rolling there, which takes the whole moment."""

    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        return jnp.zeros_like(load[0])

    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        return jnp.stack([jnp.zeros_like(demand), demand])


class EqualShare(AbstractRacewayControl):
    """Both raceways take half of the moment; the spin axis is that of outer control.

    Source: Han & Chu, J. Sound Vib. 354 (2015), λ_i = λ_o = 1.
    """

    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        return jnp.ones_like(load[0])

    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        return jnp.stack([0.5 * demand, 0.5 * demand])


class LoadShare(AbstractRacewayControl):
    """Both raceways share the moment, and the spin axis, by their contact loads."""

    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        return _outer_share(load)

    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        share = _outer_share(load)
        return demand * jnp.stack([share, 1.0 - share])


class FrictionLimited(AbstractRacewayControl):
    """`LoadShare` with every traction limited to friction times the contact load.

    Beyond that the ball turns about the tangent of its orbit (gyroscopic slip).

    Attributes:
        friction: Coefficient of friction [1].

    Traced: all fields.
    """

    friction: Real = eqx.field(
        **real("1", "friction that holds the gyroscopic moment"), default=0.05
    )

    def __check_init__(self):
        positive(self, "friction")

    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        return _outer_share(load)

    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        total = load[0] + load[1] + _NO_LOAD
        needed = demand / total
        return jnp.clip(needed, -self.friction, self.friction) * load


class AbstractWithoutMoment(AbstractRacewayControl):
    """No gyroscopic moment; the spin axis is that of outer control."""

    @property
    def has_moment(self) -> bool:
        return False

    def rolling_share(self, load: Float[Array, "2"]) -> Scalar:
        return jnp.ones_like(load[0])

    def traction(self, load: Float[Array, "2"], demand: Scalar) -> Float[Array, "2"]:
        return jnp.zeros_like(load)


class OperatingCentrifugal(AbstractWithoutMoment):
    """The centrifugal force of the orbit at the operating contact angles, no more.

    Gyroscopic moments are left out; the spin axis is that of outer control. For codes
    that do so, such as the program of Harris and Mindel, Wear 23 (1973).
    """


class CentrifugalOnly(AbstractWithoutMoment):
    """Only the centrifugal force, of the orbit at the free contact angle.

    The one choice whose forces have a potential; gyroscopic moments are left out.
    Kinematics are reported as for outer control.
    """

    @property
    def has_reaction(self) -> bool:
        return False


class BallKinematics(NamedTuple):
    """Orbit, rotation, rolling and spin of a ball.

    Attributes:
        orbit: Orbital speed ω_c [rad/s].
        rotation: Speed ω_R relative to the orbiting frame [rad/s].
        axis: Axis of rotation (sin β, cos β) for its pitch angle β (2,).
        spin: Spin about the contact normal relative to outer and inner ring (2,)
            [rad/s].
        roll: Rolling about the contact tangent, outer and inner ring (2,) [rad/s].
    """

    orbit: Annotated[Float[Array, "*element"], unit("rad/s")]
    rotation: Annotated[Float[Array, "*element"], unit("rad/s")]
    axis: Float[Array, "*element sin_cos=2"]
    spin: Annotated[Float[Array, "*element raceway=2"], unit("rad/s")]
    roll: Annotated[Float[Array, "*element raceway=2"], unit("rad/s")]

    @property
    def pitch_angle(self) -> Float[Array | np.ndarray | np.floating, "..."]:
        """Pitch angle β of the axis of rotation [rad]."""
        return array_namespace(self.axis).arctan2(self.axis[..., 0], self.axis[..., 1])

    @property
    def spin_to_roll(self) -> Float[Array | np.ndarray, "... 2"]:
        """Size of spin over rolling at outer and inner raceway [1]; 0 where the ball
        does not roll, because the rings turn alike."""
        xp = array_namespace(self.orbit)
        size = abs(self.orbit) + abs(self.rotation)
        rolls = abs(self.roll) > 64 * xp.finfo(size.dtype).eps * size[..., None]
        return xp.where(rolls, abs(self.spin / xp.where(rolls, self.roll, 1.0)), 0.0)


def ball_kinematics(
    outer: Direction, inner: Direction, share: Scalar, ratio: Scalar, speed: Speed
) -> BallKinematics:
    """Kinematics of a ball that does not slip at the middle of either contact.

    Args:
        outer, inner: Contact normals (sin α, cos α) on both raceways.
        share: Share of the outer raceway in the direction of the spin axis [1].
        ratio: γ = D/d_m [1].
        speed: Ring speeds.

    Source: no slip at both contact centres; the spin axis of outer control is
        tan β = sin α_o/(cos α_o + γ), of inner control sin α_i/(cos α_i - γ).
    """
    turned = jnp.stack([jnp.zeros_like(ratio), ratio])
    axis = share * (outer + turned) + (1.0 - share) * (inner - turned)
    axis = axis / jnp.sqrt(axis @ axis + _SQUARE)
    # Cosines between axis and normals; beyond a right angle a ball does not roll.
    at_outer = jnp.maximum(axis @ outer, _COSINE)
    at_inner = jnp.maximum(axis @ inner, _COSINE)
    # Circumferential speeds of the rings at their contacts, over ω d_m/2.
    of_outer, of_inner = 1.0 + ratio * outer[1], 1.0 - ratio * inner[1]
    weights = of_outer * at_inner, of_inner * at_outer
    total = weights[0] + weights[1]
    orbit = (speed.outer * weights[0] + speed.inner * weights[1]) / total
    rotation = (speed.inner - speed.outer) * of_outer * of_inner / (ratio * total)
    # Rotation of the ball relative to each ring, in (z, r).
    of_rings = jnp.stack([speed.outer, speed.inner])
    along_z = orbit - of_rings - rotation * axis[1]
    along_r = rotation * axis[0]
    normals = jnp.stack([outer, inner])
    return BallKinematics(
        orbit=orbit,
        rotation=rotation,
        axis=axis,
        spin=along_z * normals[:, 0] + along_r * normals[:, 1],
        roll=along_z * normals[:, 1] - along_r * normals[:, 0],
    )


def ball_mass(diameter: Scalar, density: Scalar) -> tuple[Scalar, Scalar]:
    """Mass [kg] and moment of inertia [kg m²] of a ball.

    Args:
        diameter: Ball diameter [m].
        density: Its density [kg/m³].
    """
    mass = density * jnp.pi * diameter**3 / 6.0
    return mass, 0.1 * mass * diameter**2


def _outer_share(load):
    return (load[0] + _NO_LOAD) / (load[0] + load[1] + 2.0 * _NO_LOAD)

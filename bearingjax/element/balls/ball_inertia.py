"""Effects of speed on one ball: centrifugal force, gyroscopic moment, tractions.

At the operating contact angles these have no potential and are passed separately from
the energy. See `ball_speed` for kinematics and raceway control.
"""

from typing import Annotated, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from ...design.ball import AbstractBallBearing
from ...numerics.types import Reals, Scalar
from ...numerics.units import unit, units
from ..frame import orbit, roll_ratio
from ..inertia import Speed
from .ball_speed import (
    MOST_FRICTION,
    AbstractRacewayControl,
    BallKinematics,
    ball_kinematics,
    ball_mass,
)


class BallInertia(NamedTuple):
    """Speeds, raceway control and inertia of a turning ball.

    Attributes:
        speed: Ring speeds.
        control: Raceway control.
        ratio: γ = D/d_m [1].
        centrifugal: Centrifugal force at the free contact angle [N].
        mass: Mass of the ball [kg].
        moment: Its moment of inertia [kg m²].
        pitch_radius: Radius of the circle of ball centres [m].
        diameter: Ball diameter [m].
    """

    speed: Speed
    control: AbstractRacewayControl
    ratio: Annotated[Scalar, unit("1")]
    centrifugal: Annotated[Scalar, unit("N")]
    mass: Annotated[Scalar, unit("kg")]
    moment: Annotated[Scalar, unit("kg m²")]
    pitch_radius: Annotated[Scalar, unit("m")]
    diameter: Annotated[Scalar, unit("m")]


class CarriedLoads(NamedTuple):
    """Motion and inertia forces of an orbiting ball.

    Attributes:
        kinematics: Orbit, rotation and spin.
        centrifugal: Centrifugal force at that orbit [N].
        traction: Tractions at outer and inner raceway [N]; T acts on the ball along
            (-cos α, sin α) in (z, r) at the outer raceway, opposite at the inner one.
        on_ball: Resultant of both on the ball (z, r) [N].
        on_rings: Load of each on its ring at the ball's place: (z, r) and the
            moment turning z towards r (2, 3) [N, N m].
    """

    kinematics: BallKinematics
    centrifugal: Annotated[Scalar, unit("N")]
    traction: Annotated[Float[Array, "2"], unit("N")]
    on_ball: Annotated[Float[Array, "2"], unit("N")]
    on_rings: Annotated[Float[Array, "2 3"], units("N", "N m")]


def ball_inertia(
    bearing: AbstractBallBearing,
    diameter: Scalar,
    speed: Speed,
    control: AbstractRacewayControl,
) -> BallInertia:
    """Inertia of one ball at given ring speeds.

    Args:
        bearing: The design.
        diameter: Diameter of this ball [m].
        speed: Ring speeds.
        control: Raceway control.
    """
    mass, moment = ball_mass(diameter, bearing.material.density)
    ratio = roll_ratio(diameter, bearing.pitch_diameter, bearing.free_cosine)
    radius = 0.5 * bearing.pitch_diameter
    centrifugal = radius * mass * orbit(ratio, speed.outer, speed.inner) ** 2
    gamma = diameter / bearing.pitch_diameter
    return BallInertia(
        speed, control, gamma, centrifugal, mass, moment, radius, diameter
    )


def carried_loads(
    t: BallInertia, normals: Float[Array, "2 2"], loads: Float[Array, "2"]
) -> CarriedLoads:
    """Orbit, rotation and tractions of a ball at given contact angles.

    Args:
        t: Its inertia.
        normals: Unit vectors (sin α, cos α) at outer and inner raceway (2, 2).
        loads: Contact loads there (2,) [N].

    Returns:
        Carried.
    """
    # In balance the outer raceway carries the centrifugal force at least; on the
    # way there shares must not jump where a ball in flight first touches.
    least = jnp.maximum(loads[0], 0.1 * t.centrifugal)
    shared = jnp.stack([least, loads[1]])
    share = t.control.rolling_share(shared)
    kinematics = ball_kinematics(normals[0], normals[1], share, t.ratio, t.speed)
    demand = 2.0 / t.diameter * gyroscopic_moment(t.moment, kinematics)
    # Whatever the control says, no contact holds more than friction lets it.
    most = MOST_FRICTION * loads
    traction = jnp.clip(t.control.traction(shared, demand), -most, most)
    across = jnp.stack([-normals[:, 1], normals[:, 0]], axis=1)
    signed = jnp.stack([traction[0], -traction[1]])
    forces = signed[:, None] * across
    turn = -0.5 * t.diameter * traction[:, None]
    return CarriedLoads(
        kinematics,
        t.pitch_radius * t.mass * kinematics.orbit**2,
        traction,
        forces[0] + forces[1],
        jnp.concatenate([-forces, turn], axis=1),
    )


def gyroscopic_moment(moment_of_inertia: Reals, kinematics: BallKinematics) -> Reals:
    """Moment that turns the ball's axis with its orbit, I ω_c ω_R sin β [N m].

    Args:
        moment_of_inertia: Moment of inertia of the ball [kg m²].
        kinematics: Kinematics of the ball.
    """
    k = kinematics
    return moment_of_inertia * k.orbit * k.rotation * k.axis[..., 0]

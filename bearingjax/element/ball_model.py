"""From the drawing to the model of one ball."""

from typing import Any

import jax.numpy as jnp

from ..contact.point_law import AbstractPointLaw, balls_of
from ..design.ball_types import ThrustBallBearing
from ..design.bearing_set import SetRow
from ..numerics.types import Scalar
from .ball import AbstractBallModel
from .ball_contacts import GrooveGeometry
from .ball_finite import FiniteBall
from .ball_inertia import turning
from .ball_linearised import LinearisedBall
from .ball_speed import AbstractRacewayControl
from .constants import GUIDE
from .inertia import Speed
from .kinematics import AbstractKinematics, ConstantAngle, Finite


def ball_model(
    part: SetRow,
    law: AbstractPointLaw,
    kinematics: AbstractKinematics,
    speed: Speed | None,
    control: AbstractRacewayControl,
    deviation: Scalar | None = None,
) -> AbstractBallModel:
    """Everything that the energy of one ball needs.

    Args:
        part: The row, of balls, and its place.
        law: Law of the contact constants.
        kinematics: `Linearised()` or `Finite()`.
        speed: Ring speeds or `None`.
        control: Raceway control.
        deviation: Diameter of this ball less the common one [m].
    """
    bearing: Any = part.bearing
    diameter = bearing.ball_diameter
    balls, grooves = balls_of(bearing), bearing.grooves
    if deviation is not None:
        diameter = diameter + deviation
        balls = balls._replace(diameter=diameter)
    centres = jnp.stack([jnp.stack([g.axial, g.radial]) for g in grooves])
    inertia = None if speed is None else turning(bearing, diameter, speed, control)
    common: dict[str, Any] = dict(
        grooves=GrooveGeometry(
            start=-centres,
            free=-centres / jnp.sqrt(jnp.sum(centres**2, axis=1, keepdims=True)),
            reach=jnp.stack([g.radius - 0.5 * diameter for g in grooves]),
            on_outer=tuple(g.on_outer for g in grooves),
            open_side=tuple(g.open_side for g in grooves),
            washers=isinstance(bearing, ThrustBallBearing),
            straight=isinstance(kinematics, ConstantAngle),
        ),
        constant=law.constants(balls, grooves, bearing.free_cosine),
        pitch_radius=0.5 * bearing.pitch_diameter,
        ball_diameter=diameter,
        spring=_guide(balls, diameter),
        turning=inertia,
        follows_angle=law.follows_angle,
    )
    if isinstance(kinematics, Finite):
        sign = -1.0 if part.mirrored else 1.0
        along = bearing.axial_place + sign * part.position
        return FiniteBall(along=along, inner_offset=sign * part.inner_offset, **common)
    # Motion of an inner groove centre less that of the ball's place, per tilt.
    lever = jnp.stack([centres[:, 1], -centres[:, 0]], axis=1)
    inner = jnp.asarray([0.0 if g.on_outer else 1.0 for g in grooves], diameter.dtype)
    return LinearisedBall(lever=inner[:, None] * lever, **common)


def _guide(balls, diameter):
    # A raceway contact pressed by a ten-thousandth of the ball diameter, E* D^(1/2).
    return GUIDE * balls.modulus * diameter * 1e-2

"""A ball that slips in its raceways: its motion, the tractions on it, its inertia.

Frame of a ball, moving with it: x against the sense in which angles are counted, y
outwards, z along the bearing axis, right-handed. The spin is that of the ball relative
to this frame, the orbit that of the frame. A contact at the angle α lies at s D/2 n
from the centre, n = (0, cos α, sin α), s = 1 on the outer raceway and -1 on the inner
one; its own axes are x (rolling) and t = (0, -sin α, cos α) (across).

Contact loads and angles are given: the ball's place in its section is quasi-static, and
what it does along its orbit costs no elastic energy. So the power of the rings is the
heat of contacts and drag and the change of kinetic energy, to round-off.

Source: Han & Chu, J. Sound Vib. 354 (2015) 219-235, the formulas derived anew, for
    rings that both turn and any number of contacts.
"""

from typing import Annotated, ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..element import Speed, ball_kinematics
from ..lubrication import AbstractPatch, AbstractTraction, Film, Resultants, WarmInlet
from ..lubrication.film_factors import at_least
from ..numerics.types import Scalar
from ..numerics.units import unit

LEAST_LOAD = 1e-9
"""Negligible load, for means of directions without load [N]."""


class BallState(NamedTuple):
    """Motion of a ball.
    Attributes:
        spin: Angular velocity relative to the orbiting frame (3,) [rad/s].
        orbit: Angular velocity of the frame about the bearing axis [rad/s].
    """

    spin: Annotated[Float[Array, "3"], unit("rad/s")]
    orbit: Annotated[Scalar, unit("rad/s")]


class LoadedBall(eqx.Module):
    """A ball with the loads and the oil of its contacts. Leading axis contact.

    Attributes:
        mass: Mass [kg].
        moment: Moment of inertia [kg m²].
        diameter: Ball diameter [m].
        pitch_radius: Radius of its orbit [m].
        load: Contact loads (contact,) [N].
        angle: Contact angles (contact,) [rad].
        patch: Contact areas.
        film: Films.
        least_film: Film that remains at rest [m].
        inlet: Inlet heating that thins films at speed, or `None`.
        outwards: 1 for contacts of the outer ring, else -1.

    Static: outwards.
    """

    mass: Scalar
    moment: Scalar
    diameter: Scalar
    pitch_radius: Scalar
    load: Float[Array, " contact"]
    angle: Float[Array, " contact"]
    patch: AbstractPatch
    film: Film
    least_film: Scalar
    inlet: WarmInlet | None
    outwards: tuple[float, ...] = eqx.field(static=True)

    n_spins: ClassVar[int] = 3

    @property
    def side(self) -> Float[Array, " contact"]:
        """s of every contact: 1 on the outer ring, -1 on the inner one."""
        return jnp.asarray(self.outwards, self.angle.dtype)

    @property
    def lever(self) -> Float[Array, " contact"]:
        """Distance of every contact from the bearing axis [m]."""
        return self.pitch_radius + 0.5 * self.diameter * self.side * jnp.cos(self.angle)

    @property
    def frontal_area(self) -> Scalar:
        """Frontal area of a ball along its orbit [m²]."""
        return 0.25 * jnp.pi * self.diameter**2


class Sliding(NamedTuple):
    """Motion of a ball against its raceways, leading axis contact.

    Attributes:
        slip: Slip of the ball in the middle of the contact, along x and t (contact, 2)
            [m/s].
        spin: About the contact normal, (u_x + y w, u_y - x w) (contact,) [rad/s].
        entrainment: Mean of both surface speeds relative to the contact (contact,)
            [m/s].
    """

    slip: Annotated[Float[Array, "contact 2"], unit("m/s")]
    spin: Annotated[Float[Array, " contact"], unit("rad/s")]
    entrainment: Annotated[Float[Array, " contact"], unit("m/s")]


class Tractions(NamedTuple):
    """Traction of the raceways on a ball, leading axis contact.

    Attributes:
        film: Film in the middle (contact,) [m].
        resultants: Forces, spin moments, heat.
        moment: On the ball about its centre (contact, 3) [N m].
        ring_torque: On the ring about the bearing axis (contact,) [N m].
    """

    film: Annotated[Float[Array, " contact"], unit("m")]
    resultants: Resultants
    moment: Annotated[Float[Array, "contact 3"], unit("N m")]
    ring_torque: Annotated[Float[Array, " contact"], unit("N m")]

    @property
    def heat(self) -> Float[Array, "*n contact"]:
        """Power turned to heat (contact,) [W]."""
        return self.resultants.heat


def pure_rolling(ball: LoadedBall, speed: Speed) -> BallState:
    """Return the motion without slip, and without spin at the outer raceway."""
    direction = jnp.stack([jnp.sin(ball.angle), jnp.cos(ball.angle)], axis=1)
    half = len(ball.outwards) // 2
    weighted = (ball.load + LEAST_LOAD)[:, None] * direction
    sums = weighted[:half].sum(axis=0), weighted[half:].sum(axis=0)
    outer, inner = (v / jnp.sqrt(v @ v) for v in sums)
    ratio = 0.5 * ball.diameter / ball.pitch_radius
    found = ball_kinematics(outer, inner, jnp.ones_like(ratio), ratio, speed)
    across, along = found.rotation * found.axis
    return BallState(jnp.stack([jnp.zeros_like(across), across, -along]), found.orbit)


def sliding(ball: LoadedBall, state: BallState, speed: Speed) -> Sliding:
    """Return sliding, spin and entrainment of a ball on its raceways."""
    cos, sin, side = jnp.cos(ball.angle), jnp.sin(ball.angle), ball.side
    wx, wy, wz = state.spin
    radius = 0.5 * ball.diameter
    # Speeds along x in the orbiting frame: of the ball's surface, of the raceway's.
    surface = side * radius * (wy * sin - wz * cos)
    passing = state.orbit - jnp.where(ball.side > 0, speed.outer, speed.inner)
    raceway = passing * ball.lever
    across = jnp.broadcast_to(side * radius * wx, surface.shape)
    return Sliding(
        slip=jnp.stack([surface - raceway, across], axis=-1),
        spin=wy * cos + (wz + passing) * sin,
        entrainment=0.5 * (surface + raceway),
    )


def tractions(ball: LoadedBall, law: AbstractTraction, moving: Sliding) -> Tractions:
    """Return the tractions on a ball.

    Args:
        ball: The ball.
        law: Traction law.
        moving: From `sliding`.
    """

    def contact_traction(patch, film, slip, spin, speed):
        thickness = film.central(speed)
        if ball.inlet is not None:
            thickness *= ball.inlet.factor(patch, slip[0], speed)
        thickness = at_least(thickness, ball.least_film)
        return thickness, law.resultants(patch, thickness, slip, spin)

    film, found = jax.vmap(contact_traction)(ball.patch, ball.film, *moving)
    cos, sin = jnp.cos(ball.angle), jnp.sin(ball.angle)
    along, across = found.force[:, 0], found.force[:, 1]
    arm = 0.5 * ball.diameter * ball.side
    moment = jnp.stack(
        [
            arm * across,
            arm * along * sin - found.moment * cos,
            -arm * along * cos - found.moment * sin,
        ],
        axis=-1,
    )
    # The ring feels the opposite force, at its lever, and the opposite moment.
    ring_torque = along * ball.lever + found.moment * sin
    return Tractions(film, found, moment, ring_torque)


def rates(
    ball: LoadedBall, state: BallState, drag: Tractions, along_orbit: Scalar
) -> BallState:
    """Return the time derivatives of the motion of a ball.

    Args:
        ball: The ball.
        state: Its motion.
        drag: From `tractions`.
        along_orbit: Other forces on it in the sense in which angles are counted, such
            as those of cage and oil [N].
    """
    spinning, orbiting = residual_moments(ball, state, drag, along_orbit)
    turning = orbiting / (ball.mass * ball.pitch_radius)
    spin = spinning / ball.moment
    return BallState(spin.at[2].add(-turning), turning)


def residual_moments(
    ball: LoadedBall, state: BallState, drag: Tractions, along_orbit: Scalar
) -> tuple[Float[Array, "3"], Scalar]:
    """Return moments, the gyroscopic one included, and the force along the orbit.

    I (dw/dt + dω/dt e_z) are the moments (3,) [N m], m r dω/dt the force along the
    orbit [N]. Arguments as in `rates`.
    """
    wx, wy, _ = state.spin
    gyroscopic = ball.moment * state.orbit * jnp.stack([wy, -wx, jnp.zeros_like(wx)])
    force = along_orbit - jnp.sum(drag.resultants.force[:, 0])
    return jnp.sum(drag.moment, axis=0) + gyroscopic, force


def kinetic_energy(ball: LoadedBall, state: BallState) -> Scalar:
    """Return the kinetic energy of orbit and rotation of a ball [J]."""
    wx, wy, wz = state.spin
    turning = wx * wx + wy * wy + (wz + state.orbit) ** 2
    orbiting = ball.mass * (ball.pitch_radius * state.orbit) ** 2
    return 0.5 * (orbiting + ball.moment * turning)

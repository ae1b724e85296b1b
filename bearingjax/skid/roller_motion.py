"""A cylindrical roller that slips in its raceways: its motion, tractions and inertia.

In the plane: it turns about its own axis, which stays parallel to the bearing axis, and
orbits. Frame as in `ball_motion`, whose ball with all contact angles zero and no spin
but the axial one moves in the same way: x against the sense in which angles are
counted, y outwards, z along the bearing axis. The spin is that of the roller relative
to the orbiting frame, negative where the inner ring turns faster than the outer one.

Left out: friction on ribs and in cage pockets, the resistance of rolling itself, and
the misaligned roller's sliding along its axis.
"""

from typing import Annotated, ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..element.inertia import Speed
from ..lubrication import AbstractTraction, Film, LinePatch, WarmInlet
from ..lubrication.film_factors import at_least
from ..numerics.types import Scalar
from ..numerics.units import unit


class RollerState(NamedTuple):
    """Motion of a roller.
    Attributes:
        spin: About its own axis, relative to the orbiting frame [rad/s].
        orbit: Angular velocity of the frame about the bearing axis [rad/s].
    """

    spin: Annotated[Scalar, unit("rad/s")]
    orbit: Annotated[Scalar, unit("rad/s")]


class LoadedRoller(eqx.Module):
    """A roller with the loads and the oil of its contacts. Contacts (outer, inner).

    Attributes:
        mass: Mass [kg].
        moment: Moment of inertia about its own axis [kg m²].
        diameter: Roller diameter [m].
        length: Roller length [m].
        pitch_radius: Radius of its orbit [m].
        load: Contact loads (contact,) [N].
        patch: Contact areas.
        film: Films.
        least_film: Film that remains at rest [m].
        inlet: Inlet heating that thins films at speed, or `None`.
    """

    mass: Scalar
    moment: Scalar
    diameter: Scalar
    length: Scalar
    pitch_radius: Scalar
    load: Float[Array, "2"]
    patch: LinePatch
    film: Film
    least_film: Scalar
    inlet: WarmInlet | None

    n_spins: ClassVar[int] = 1

    @property
    def side(self) -> Float[Array, "2"]:
        """1 for the contact of the outer ring, -1 for that of the inner one."""
        return jnp.asarray([1.0, -1.0], self.diameter.dtype)

    @property
    def lever(self) -> Float[Array, "2"]:
        """Distance of both contacts from the bearing axis [m]."""
        return self.pitch_radius + 0.5 * self.diameter * self.side

    @property
    def frontal_area(self) -> Scalar:
        """Frontal area of a roller along its orbit [m²]."""
        return self.diameter * self.length


class RollerSliding(NamedTuple):
    """Motion of a roller against its raceways, contacts (outer, inner).

    Attributes:
        slip: Slip of the roller along x (contact,) [m/s].
        entrainment: Mean of both surface speeds relative to the contact (contact,)
            [m/s].
    """

    slip: Annotated[Float[Array, "2"], unit("m/s")]
    entrainment: Annotated[Float[Array, "2"], unit("m/s")]


class RollerTractions(NamedTuple):
    """Traction of the raceways on a roller, contacts (outer, inner).

    Attributes:
        film: Central film (contact,) [m].
        force: Along x (contact,) [N].
        heat: Power turned to heat (contact,) [W].
        moment: On the roller about its axis (contact,) [N m].
        ring_torque: On the ring about the bearing axis (contact,) [N m].
    """

    film: Annotated[Float[Array, "2"], unit("m")]
    force: Annotated[Float[Array, "2"], unit("N")]
    heat: Annotated[Float[Array, "2"], unit("W")]
    moment: Annotated[Float[Array, "2"], unit("N m")]
    ring_torque: Annotated[Float[Array, "2"], unit("N m")]


def pure_rolling(roller: LoadedRoller, speed: Speed) -> RollerState:
    """Return the motion without slip at both raceways."""
    # Both raceways pass the contacts at the same speed, in opposite senses.
    outer, inner = roller.lever
    orbit = (outer * speed.outer + inner * speed.inner) / (outer + inner)
    passing = (orbit - speed.outer) * outer
    return RollerState(-passing / (0.5 * roller.diameter), orbit)


def sliding(roller: LoadedRoller, state: RollerState, speed: Speed) -> RollerSliding:
    """Return sliding and entrainment of a roller on its raceways."""
    # Speeds along x in the orbiting frame: of the roller's surface, of the raceway's.
    surface = -roller.side * 0.5 * roller.diameter * state.spin
    passing = state.orbit - jnp.stack([speed.outer, speed.inner])
    raceway = passing * roller.lever
    return RollerSliding(surface - raceway, 0.5 * (surface + raceway))


def tractions(
    roller: LoadedRoller, law: AbstractTraction, moving: RollerSliding
) -> RollerTractions:
    """Return the tractions on a roller.

    Args:
        roller: The roller.
        law: Traction law.
        moving: From `sliding`.
    """

    def contact_traction(patch, film, slip, speed):
        thickness = film.central(speed)
        if roller.inlet is not None:
            thickness *= roller.inlet.factor(patch, slip, speed)
        thickness = at_least(thickness, roller.least_film)
        none = jnp.zeros_like(slip)
        found = law.resultants(patch, thickness, jnp.stack([slip, none]), none)
        return thickness, found.force[0], found.heat

    film, force, heat = jax.vmap(contact_traction)(roller.patch, roller.film, *moving)
    moment = -0.5 * roller.diameter * roller.side * force
    # The ring feels the opposite force, at its lever.
    return RollerTractions(film, force, heat, moment, force * roller.lever)


def rates(
    roller: LoadedRoller,
    state: RollerState,
    drag: RollerTractions,
    along_orbit: Scalar,
) -> RollerState:
    """Return the time derivatives of the motion of a roller.

    Args:
        roller: The roller.
        state: Its motion.
        drag: From `tractions`.
        along_orbit: Other forces on it in the sense in which angles are counted, such
            as those of cage and oil [N].
    """
    spinning, orbiting = residual_moments(roller, drag, along_orbit)
    turning = orbiting / (roller.mass * roller.pitch_radius)
    return RollerState(spinning / roller.moment - turning, turning)


def residual_moments(
    roller: LoadedRoller, drag: RollerTractions, along_orbit: Scalar
) -> tuple[Scalar, Scalar]:
    """Return the residual moment and force.

    I (dw/dt + dω/dt) is the moment [N m], m r dω/dt the force along the orbit [N].
    Arguments as in `rates`.
    """
    return jnp.sum(drag.moment), along_orbit - jnp.sum(drag.force)


def kinetic_energy(roller: LoadedRoller, state: RollerState) -> Scalar:
    """Return the kinetic energy of orbit and rotation of a roller [J]."""
    orbiting = roller.mass * (roller.pitch_radius * state.orbit) ** 2
    return 0.5 * (orbiting + roller.moment * (state.spin + state.orbit) ** 2)

"""What the contacts of balls and rollers bear, from a solved bearing, and their oil."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..contact.hertz import Ellipse
from ..contact.line import half_width
from ..contact.point_law import AbstractPointLaw, ball_ellipses, balls_of
from ..design.ball import AbstractBallBearing
from ..element.ball_speed import ball_mass
from ..element.bearing_model import BearingModel
from ..element.constants import ContactConstants, relative_radii
from ..element.inertia import Speed, mass_and_inertia
from ..lubrication import (
    ellipse_patch,
    line_film,
    line_patch,
    point_film,
)
from ..numerics.types import Ring
from ..statics import rollers
from ..statics.balls import ball_results
from .ball_motion import LoadedBall
from .model import Oil, SkidModel
from .roller_motion import LoadedRoller

_SLICES = 16
"""Slices of a roller, spaced as the nodes of Gauss and Legendre."""


def contact_loads(
    model: BearingModel,
    bearing: AbstractBallBearing,
    law: AbstractPointLaw,
    q: Ring,
    azimuth: Float[Array, " station"],
) -> tuple[Float[Array, "station contact"], Float[Array, "station contact"]]:
    """Loads [N] and contact angles [rad] of a ball at places along its orbit.

    Args:
        model: The bearing, of one row of like balls.
        bearing: Its design.
        law: Law of its contact constants.
        q: Ring freedoms of the equilibrium [m, rad].
        azimuth: The places [rad].
    """
    (row,) = model.rows
    solved = row.solve(q, azimuth, model.equilibrium, None)
    found = ball_results((row.at(q, azimuth, solved),), (bearing,), law)
    return found["contact_load"], found["contact_angle"]


def contact_ellipses(
    bearing: AbstractBallBearing,
    law: AbstractPointLaw,
    cosine: Float[Array, " contact"],
) -> Ellipse:
    """Contact ellipses of a ball, for any load.

    Args:
        bearing: The design.
        law: Law of its contact constants, which says where curvatures are taken.
        cosine: Cosines of the contact angles (contact,) [1].
    """
    at = law.cosine(bearing.free_cosine, cosine)
    return ball_ellipses(balls_of(bearing), bearing.grooves, at)


def loaded_ball(
    bearing: AbstractBallBearing,
    law: AbstractPointLaw,
    oil: Oil,
    load: Float[Array, " contact"],
    angle: Float[Array, " contact"],
    ellipses: Ellipse | None = None,
) -> LoadedBall:
    """A ball under given contact loads.

    Args:
        bearing: The design.
        law: Law of its contact constants, which says where curvatures are taken.
        oil: Oil in its contacts.
        load: Contact loads (contact,) [N].
        angle: Contact angles (contact,) [rad].
        ellipses: From `contact_ellipses`, if they are at hand.
    """
    balls, grooves = balls_of(bearing), bearing.grooves
    if ellipses is None:
        ellipses = contact_ellipses(bearing, law, jnp.cos(angle))
    axes = ellipses.semi_axes(load)
    outwards = tuple(1.0 if groove.on_outer else -1.0 for groove in grooves)
    turn = jnp.asarray(outwards) * balls.diameter / balls.pitch_diameter
    radius = 0.5 * balls.diameter * (1.0 + turn * jnp.cos(angle))
    lubricant, temperature = oil.lubricant, oil.temperature
    viscosity = lubricant.viscosity(0.0, temperature)
    coefficient = lubricant.pressure_coefficient(temperature)

    def patch(*of_contact):
        return ellipse_patch(lubricant, temperature, *of_contact)

    def film(load, ratio, radius):
        return point_film(load, ratio, radius, balls.modulus, viscosity, coefficient)

    mass, moment = ball_mass(balls.diameter, bearing.material.density)
    return LoadedBall(
        mass=mass,
        moment=moment,
        diameter=balls.diameter,
        pitch_radius=0.5 * balls.pitch_diameter,
        load=load,
        angle=angle,
        patch=jax.vmap(patch)(*axes, ellipses.peak_pressure(load)),
        film=jax.vmap(film)(load, 1.0 / ellipses.ratio, radius),
        least_film=oil.least_film,
        inlet=oil.inlet(balls.modulus),
        outwards=outwards,
    )


def roller_loads(
    model: BearingModel, q: Ring, azimuth: Float[Array, " station"]
) -> tuple[Float[Array, "station 2"], Float[Array, "station 2 slice"]]:
    """Loads of a roller on both raceways at places along its orbit.

    Args:
        model: The bearing, of one row of like rollers.
        q: Ring freedoms of the equilibrium [m, rad].
        azimuth: The places [rad].

    Returns:
        Contact loads [N], and loads per length of its slices [N/m].
    """
    (row,) = model.rows
    solved = row.at(q, azimuth, row.solve(q, azimuth, model.equilibrium, None))
    load, _ = rollers.contact_loads(solved)
    return load, rollers.line_loads(solved, jnp.asarray(_slices()[0], load.dtype))


def loaded_rollers(
    model: SkidModel, q: Ring, speed: Speed, azimuth: Float[Array, " station"]
) -> LoadedRoller:
    """A roller at places along its orbit, leading axis place.

    Args:
        model: The bearing and its oil.
        q: Ring freedoms of the equilibrium [m, rad].
        speed: Ring speeds of that equilibrium.
        azimuth: The places [rad].
    """
    bearing = model.element.model(speed)
    constants = bearing.rows[0].element.constants
    make = partial(loaded_roller, constants, model.oil)
    return jax.vmap(make)(*roller_loads(bearing, q, azimuth))


def loaded_roller(
    constants: ContactConstants,
    oil: Oil,
    load: Float[Array, "2"],
    line_load: Float[Array, "2 slice"],
) -> LoadedRoller:
    """A roller under given loads.

    The film of a contact is the same all along it, that of the line load q averaged
    over the load, ∫ q² ds/∫ q ds: it falls with the 0.17th power of the load alone.

    Args:
        constants: Contact constants of the roller.
        oil: Oil in its contacts.
        load: Contact loads (outer, inner) (2,) [N].
        line_load: Loads per length of its slices, from `roller_loads` [N/m].
    """
    c, dtype = constants, load.dtype
    node, weight = (jnp.asarray(v, dtype) for v in _slices())
    position, width = c.half_length * node, c.half_length * weight
    radius = relative_radii(c, position)
    lubricant, temperature = oil.lubricant, oil.temperature
    viscosity = lubricant.viscosity(0.0, temperature)
    coefficient = lubricant.pressure_coefficient(temperature)

    def contact(line_load, radius):
        half = half_width(line_load, radius, c.modulus)
        patch = line_patch(lubricant, temperature, position, width, line_load, half)
        total = jnp.dot(width, line_load)
        loaded = total > 0
        square = jnp.dot(width, line_load**2) / jnp.where(loaded, total, 1.0)
        middle = jnp.mean(radius)
        film = line_film(
            jnp.where(loaded, square, 0.0), middle, c.modulus, viscosity, coefficient
        )
        return patch, film

    patch, film = jax.vmap(contact)(line_load, radius)
    mass, moment, _ = mass_and_inertia(c)
    return LoadedRoller(
        mass=mass,
        moment=moment,
        diameter=c.diameter,
        length=2.0 * c.half_length,
        pitch_radius=c.pitch_radius,
        load=load,
        patch=patch,
        film=film,
        least_film=oil.least_film,
        inlet=oil.inlet(c.modulus),
    )


def _slices():
    """Positions from -1 to 1 along a roller, and their shares of that length."""
    return np.polynomial.legendre.leggauss(_SLICES)

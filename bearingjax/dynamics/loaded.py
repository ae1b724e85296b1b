"""What the contacts of the balls bear, from a solved bearing, and the oil in them."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..contact.hertz import Ellipse
from ..contact.point_law import AbstractPointLaw, ball_ellipses, balls_of
from ..design.ball import AbstractBallBearing
from ..element.ball_speed import ball_mass
from ..element.bearing_model import BearingModel
from ..lubrication import Lubricant, ellipse_patch, point_film
from ..numerics.types import Ring, Scalar
from ..statics.balls import ball_results
from .ball_motion import LoadedBall


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
    lubricant: Lubricant,
    temperature: Scalar,
    least_film: Scalar,
    load: Float[Array, " contact"],
    angle: Float[Array, " contact"],
    ellipses: Ellipse | None = None,
) -> LoadedBall:
    """A ball under given contact loads.

    Args:
        bearing: The design.
        law: Law of its contact constants, which says where curvatures are taken.
        lubricant: Oil.
        temperature: Of the oil [K].
        least_film: What remains of every film at rest [m].
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
        least_film=least_film,
        outwards=outwards,
    )

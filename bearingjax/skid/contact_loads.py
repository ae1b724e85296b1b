"""Contact loads of balls and rollers, from a solved bearing, and their oil."""

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..contact import AbstractPointLaw, Ellipse, half_width
from ..contact.point_law import ball_ellipses, balls_of
from ..design.ball import AbstractBallBearing
from ..element import BearingElement, BearingModel, Row, RowResults, Speed, ball_mass
from ..element.bearing_model import RowGroup
from ..element.constants import ContactConstants, relative_radii
from ..element.equilibrium import condense
from ..element.inertia import mass_and_inertia
from ..element.solved_row import SolvedRow
from ..lubrication import (
    ellipse_patch,
    line_film,
    line_patch,
    point_film,
)
from ..numerics.expansion import expand
from ..numerics.types import Reals, Ring
from ..statics import rollers
from ..statics.balls import ball_results
from .ball_motion import LoadedBall
from .model import Oil
from .roller_motion import LoadedRoller

_SLICES = 16
"""Slices of a roller, at Gauss-Legendre nodes."""


def orbiting_model(
    element: BearingElement, speed: Speed, excess: Reals
) -> BearingModel:
    """Return the bearing with orbits faster than in pure rolling.

    They are thrown outwards, and balls held against the turn of their axes, as under
    rings that both turn faster by as much: spins relative to the orbit are those of
    pure rolling.

    Args:
        element: The bearing, of one row of like balls or rollers.
        speed: Ring speeds.
        excess: Excess of their orbital speeds over pure rolling, each one's (body,) or
            that of all () [rad/s].
    """

    def model_at(excess):
        return element.model(Speed(speed.inner + excess, speed.outer + excess))

    if not excess.ndim:
        return model_at(excess)
    row, each = (
        model.rows[0] for model in (element.model(speed), jax.vmap(model_at)(excess))
    )
    rows = (dataclasses.replace(row, element=each.element, per_element=True),)
    return BearingModel(RowGroup.group(rows), element.equilibrium, element.cage_torque)


def ring_forces(
    row: Row, q: Ring, azimuth: Float[Array, " station"], solved: SolvedRow
) -> Float[Array, "station 12"]:
    """Return the reversed forces of each ball or roller on the rings: its part of
    the load that holds them.

    Args:
        row: The row, without a spring.
        q: Ring freedoms [m, rad].
        azimuth: Azimuths of the elements [rad].
        solved: The row solved there.

    Returns:
        Forces and moments [N, N m], with derivatives.
    """

    def in_axes(q):
        return row.in_element_axes(row.local(q), azimuth)

    def energy(rings):
        def condensed_energy(solved_element, rings, energies):
            return expand(condense, rings, solved_element, energies)

        return jnp.sum(solved.map(row, condensed_energy, rings))

    return jnp.einsum(
        "kr,krq->kq", jax.grad(energy)(in_axes(q)), jax.jacfwd(in_axes)(q)
    )


def contact_loads(
    row: RowResults, bearing: AbstractBallBearing, law: AbstractPointLaw
) -> tuple[Float[Array, "station contact"], Float[Array, "station contact"]]:
    """Return loads [N] and contact angles [rad] of balls."""
    found = ball_results((row,), (bearing,), law)
    return found["contact_load"], found["contact_angle"]


def at_places(
    model: BearingModel, q: Ring, azimuth: Float[Array, " station"]
) -> RowResults:
    """Return a ball or roller at places along its orbit.

    Args:
        model: The bearing, of one row of like balls or rollers.
        q: Ring freedoms of the equilibrium [m, rad].
        azimuth: The places [rad].
    """
    (row,) = model.rows
    return row.results(q, azimuth, row.solve(q, azimuth, model.equilibrium, None))


def contact_ellipses(
    bearing: AbstractBallBearing,
    law: AbstractPointLaw,
    cosine: Float[Array, " contact"],
) -> Ellipse:
    """Return the contact ellipses of a ball, for any load.

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
    """Create a ball under given contact loads.

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


def loaded_rollers(row: RowResults, oil: Oil) -> LoadedRoller:
    """Create the rollers of a solved row.

    Args:
        row: The row, of like rollers.
        oil: Oil in their contacts.
    """
    load, _ = rollers.contact_loads(row)
    line_load = rollers.line_loads(row, jnp.asarray(_slices()[0], load.dtype))
    make = partial(loaded_roller, row.row.element.constants, oil)
    return jax.vmap(make)(load, line_load)


def loaded_roller(
    constants: ContactConstants,
    oil: Oil,
    load: Float[Array, "2"],
    line_load: Float[Array, "2 slice"],
) -> LoadedRoller:
    """Create a roller under given loads.

    The film of a contact is the same all along it, that of the line load q averaged
    over the load, ∫ q² ds/∫ q ds: it falls with the 0.17th power of the load alone.

    Args:
        constants: Contact constants of the roller.
        oil: Oil in its contacts.
        load: Contact loads (outer, inner) (2,) [N].
        line_load: Loads per length of its slices (2, slice) [N/m].
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
    """Return positions from -1 to 1 along a roller, and their weights."""
    return np.polynomial.legendre.leggauss(_SLICES)

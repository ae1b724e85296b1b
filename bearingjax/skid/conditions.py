"""Conditions in the contacts of skidding balls and rollers, and warnings on them."""

from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int
from numpy.typing import ArrayLike

from ..contact.point_law import ball_ellipses, balls_of
from ..element.inertia import Speed
from ..numerics.compiled.programs import program
from ..numerics.labels import to_xarray
from ..numerics.types import Reals
from ..numerics.units import unit
from .ball_motion import BallState, sliding, tractions
from .contact_loads import loaded_ball
from .model import SkidModel
from .ring_speed import SpeedTable


class Conditions(NamedTuple):
    """Conditions in the contacts of balls or rollers; axes as for their loads, contact
    last.

    Attributes:
        peak_pressure: Hertz peak pressure [Pa].
        least_film: Least film, by the formula of elastohydrodynamic contacts, with the
            heating of the inlets if the model has it [m].
        regime: Codes of `Regime`.
        outside_fluid_range: Whether the oil is a glass at the peak pressure.
        shear: Size of the shear stress, summed up over the contact, over the load: no
            more than a traction coefficient can be; 0 without load [1].
        semi_axes: Semi-axes of the ellipse of a ball, in rolling direction and across
            (…, 2) [m]; of rollers `None`.
    """

    peak_pressure: Annotated[Reals, unit("Pa")]
    least_film: Annotated[Reals, unit("m")]
    regime: Int[Array, "..."]
    outside_fluid_range: Bool[Array, "..."]
    shear: Annotated[Reals, unit("1")]
    semi_axes: Annotated[Float[Array, "... half_axis=2"] | None, unit("m")] = None

    to_xarray = to_xarray


def conditions_of(
    model: SkidModel, body: Any, moving: Any, film: Float[Array, " contact"]
) -> Conditions:
    """Return the conditions in the contacts of one ball or roller.

    Args:
        model: The bearing and its oil.
        body: `LoadedBall` or `LoadedRoller`.
        moving: Its `Sliding` or `RollerSliding`.
        film: Central films (contact,) [m].
    """
    slip, spin = moving.slip, getattr(moving, "spin", jnp.zeros_like(film))
    if slip.ndim == 1:
        slip = jnp.stack([slip, jnp.zeros_like(slip)], axis=1)

    def contact_conditions(patch, film, load, thickness, slip, spin, speed):
        least = film.minimum(speed)
        if body.inlet is not None:
            least = least * body.inlet.factor(patch, slip[0], speed)
        at = patch.nodes(slip, spin)
        squared = (slip[0] + at.y * spin) ** 2 + (slip[1] - at.x * spin) ** 2
        resistance = model.traction.resistance(
            squared, thickness, at.pressure, at.viscosity
        )
        sheared = jnp.sum(at.area * resistance * jnp.sqrt(squared))
        shear = jnp.where(load > 0, sheared / jnp.where(load > 0, load, 1.0), 0.0)
        outside = model.lubricant.outside_fluid_range(patch.peak, model.temperature)
        return Conditions(patch.peak, least, film.regime(speed), outside, shear)

    given = body.patch, body.film, body.load, film, slip, spin, moving.entrainment
    return jax.vmap(contact_conditions)(*given)


def conditions(model: SkidModel, found: Any, speed: Speed | SpeedTable) -> Conditions:
    """Return the conditions in all contacts.

    Args:
        model: The bearing and its oil.
        found: Motion of its balls, from `skid.steady` or `skid.simulate`.
        speed: Ring speeds, those over time of a motion in time.

    Raises:
        TypeError: If it is a bearing of rollers.
    """
    model.check_balls("conditions")
    load = found.contact_load
    lead, n = load.shape[:-1], load.shape[-1]

    def flat(values, *shape):
        return jnp.broadcast_to(values, (*lead, *shape)).reshape(-1, *shape)

    if isinstance(speed, SpeedTable):
        speed = jax.vmap(speed.at)(found.time)

    def of_ring(ring):
        return flat(jnp.reshape(ring, (-1,) + (1,) * (len(lead) - 1)))

    rows = _conditions(
        model,
        flat(load, n),
        flat(found.contact_angle, n),
        flat(found.spin, 3),
        flat(found.orbit_speed),
        of_ring(speed.inner),
        of_ring(speed.outer),
    )
    return jax.tree.map(lambda v: v.reshape(*lead, *v.shape[1:]), rows)


def by_raceway(values: ArrayLike, load: ArrayLike) -> np.ndarray:
    """Values of contacts (…, contact) by raceway (…, 2), of the busier of two arcs.

    Args:
        values: Value at each contact, concrete.
        load: Loads of the contacts, of the same shape.
    """
    load, values = np.asarray(load), np.asarray(values)
    shape = (*load.shape[:-1], 2, load.shape[-1] // 2)
    busier = np.argmax(load.reshape(shape), axis=-1)[..., None]
    return np.take_along_axis(values.reshape(shape), busier, axis=-1)[..., 0]


@program(quick=True)
def _conditions(model, load, angle, spin, orbit, inner, outer):
    bearing, law = model.bearing, model.element.point_law

    def ball_conditions(load, angle, spin, orbit, inner, outer):
        ball = loaded_ball(bearing, law, model.oil, load, angle)
        turning = Speed(inner=inner, outer=outer)
        moving = sliding(ball, BallState(spin, orbit), turning)
        film = tractions(ball, model.traction, moving).film
        cosine = law.cosine(bearing.free_cosine, jnp.cos(angle))
        axes = ball_ellipses(balls_of(bearing), bearing.grooves, cosine).semi_axes(load)
        found = conditions_of(model, ball, moving, film)
        return found._replace(semi_axes=jnp.stack(axes, axis=-1))

    return jax.vmap(ball_conditions)(load, angle, spin, orbit, inner, outer)

"""In what state the contacts of skidding balls are, and what is doubtful about it."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int
from numpy.typing import ArrayLike

from ..contact.point_law import ball_ellipses, balls_of
from ..element.inertia import Speed
from .ball_motion import BallState, sliding
from .loaded import loaded_ball
from .model import SkidModel
from .ring_speed import SpeedTable


class Conditions(NamedTuple):
    """Conditions in the contacts of balls; axes as of their loads, contact last.

    Attributes:
        peak_pressure: Hertz peak pressure [Pa].
        semi_axes: Of the ellipse, in rolling direction and across (…, 2) [m].
        least_film: Least film, by the formula of elastohydrodynamic contacts, with the
            heating of the inlets if the model has it [m].
        regime: Codes of `Regime`.
        outside_fluid_range: Whether the oil is a glass at the peak pressure.
    """

    peak_pressure: Float[Array, "..."]
    semi_axes: Float[Array, "... 2"]
    least_film: Float[Array, "..."]
    regime: Int[Array, "..."]
    outside_fluid_range: Bool[Array, "..."]


def conditions(model: SkidModel, found: Any, speed: Speed | SpeedTable) -> Conditions:
    """Conditions in all contacts.

    Args:
        model: The bearing and its oil.
        found: How its balls move; from `steady_skid` or `skid`.
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
        values: Of each contact, concrete.
        load: Loads of the contacts, of the same shape.
    """
    load, values = np.asarray(load), np.asarray(values)
    shape = (*load.shape[:-1], 2, load.shape[-1] // 2)
    busier = np.argmax(load.reshape(shape), axis=-1)[..., None]
    return np.take_along_axis(values.reshape(shape), busier, axis=-1)[..., 0]


@eqx.filter_jit
def _conditions(model, load, angle, spin, orbit, inner, outer):
    bearing, law = model.bearing, model.element.point_law

    def one(load, angle, spin, orbit, inner, outer):
        ball = loaded_ball(bearing, law, model.oil, load, angle)
        turning = Speed(inner=inner, outer=outer)
        moving = sliding(ball, BallState(spin, orbit), turning)
        entrained = moving.entrainment

        def least(film, patch, slip, speed):
            cool = film.minimum(speed)
            if ball.inlet is None:
                return cool
            return cool * ball.inlet.factor(patch, slip, speed)

        cosine = law.cosine(bearing.free_cosine, jnp.cos(angle))
        ellipses = ball_ellipses(balls_of(bearing), bearing.grooves, cosine)
        pressure = ellipses.peak_pressure(load)
        return Conditions(
            pressure,
            jnp.stack(ellipses.semi_axes(load), axis=-1),
            jax.vmap(least)(ball.film, ball.patch, moving.slip[:, 0], entrained),
            jax.vmap(lambda film, u: film.regime(u))(ball.film, entrained),
            model.lubricant.outside_fluid_range(pressure, model.temperature),
        )

    return jax.vmap(one)(load, angle, spin, orbit, inner, outer)

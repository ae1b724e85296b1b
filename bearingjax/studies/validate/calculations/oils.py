"""Oils and the traction of their films."""

import jax
import jax.numpy as jnp

from ....contact.hertz import ellipse
from ....design import Material
from ....design.material import contact_modulus
from ....lubrication import OILS, Newtonian, ellipse_patch, mil_l_23699, point_film


def state(oil: str, temperature: float, pressure: float) -> dict[str, float]:
    """Return viscosities, density and coefficient of one of `OILS`."""
    own = OILS[oil]()
    return {
        "viscosity": float(own.viscosity(pressure, temperature)),
        "kinematic": float(own.kinematic_viscosity(temperature)),
        "coefficient": float(own.pressure_coefficient(temperature)),
        "density": float(own.density.at(temperature)),
    }


def traction_slope(
    ball_diameter: float,
    pitch_diameter: float,
    osculation: float,
    orbit: float,
    temperature: float,
    load: float,
    angle: float,
) -> dict[str, float]:
    """Return how traction of a film of MIL-L-23699 on an inner raceway grows with slip.

    Args:
        ball_diameter, pitch_diameter: [m].
        osculation: Of the inner groove [1].
        orbit: Speed of the inner ring against the cage [rad/s].
        temperature: Of the oil [K].
        load, angle: Load and contact angle [N], [rad].
    """
    oil, across = mil_l_23699(), ball_diameter * float(jnp.cos(angle))
    rolling = 0.5 * ball_diameter * (1.0 - across / pitch_diameter)
    groove = (2.0 - 1.0 / osculation) / ball_diameter
    steel = contact_modulus(Material(), Material())
    hertz = ellipse(jnp.asarray(1.0 / rolling), jnp.asarray(groove), steel)
    thin, alpha = oil.viscosity(0.0, temperature), oil.pressure_coefficient(temperature)
    film = point_film(load, 1.0 / hertz.ratio, rolling, steel, thin, alpha)
    sizes = *hertz.semi_axes(jnp.asarray(load)), hertz.peak_pressure(jnp.asarray(load))
    patch = ellipse_patch(oil, temperature, *sizes)
    thick = film.central(0.5 * orbit * (pitch_diameter - across))
    force = jax.jacfwd(lambda u: Newtonian().resultants(patch, thick, u, 0.0).force)
    return {"slope": -float(force(jnp.zeros(2))[0, 0])}

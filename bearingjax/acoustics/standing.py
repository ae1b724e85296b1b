"""Where a bearing stands on its rig before anything turns."""

import dataclasses

import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..element.ball_speed import CentrifugalOnly
from ..element.choices import BallChoices
from ..numerics.linear import combined
from ..statics.load import solve
from .model import NoiseModel
from .system import NoiseSystem


def standing(
    model: NoiseModel, system: NoiseSystem, orbits: bool = True
) -> tuple[Float[Array, " n"], Int[Array, ""]]:
    """Where ring and rolling elements stand under the load, without form errors.

    The inertia of the orbit acts as it does in the equations of motion.

    Args:
        model: The bearing.
        system: Its equations of motion.
        orbits: Whether the rolling elements orbit; without, those that carry nothing
            are in no contact at all. Static.

    Returns:
        Coordinates (n,) [m, rad] and the `Result` code; differentiable.

    Fails: as `solve_load`.
    """
    element = model.small
    if orbits and isinstance(element.choices, BallChoices):
        # As here, where balls roll at the free contact angle whatever the load.
        choices = dataclasses.replace(
            element.choices, raceway_control=CentrifugalOnly()
        )
        element = dataclasses.replace(element, choices=choices)
    speed = model.speed if orbits else None
    solution = solve(element, model.load, model.solve_options, speed=speed)
    q = solution.displacement
    rows = element.rows(q, speed)
    u, v, tilt = jnp.concatenate([found.motions() for found in rows]).T
    if (sites := system.sites) is not None:
        u, v, tilt = sites.sign * u, v + sites.position * tilt, sites.sign * tilt

    def place(free, *motion):
        return combined(free.own.T, jnp.stack(motion))[: free.mass.shape[0]]

    places = system.row.each(place, u, v, tilt)
    ring = (q[6:] if system.moving else q[:6])[: system.mass.shape[0]]
    return jnp.concatenate([ring, places.T.ravel()]), solution.result

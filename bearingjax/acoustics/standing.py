"""Where a bearing stands on its rig before anything turns."""

import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..element.rolling_element import RingMotion
from ..statics.load import solve
from .model import NoiseModel, NoiseSystem


def standing(
    model: NoiseModel, system: NoiseSystem
) -> tuple[Float[Array, " n"], Int[Array, ""]]:
    """Where ring and rolling elements stand under the load, without form errors.

    Args:
        model: The bearing.
        system: Its equations of motion.

    Returns:
        Coordinates (n,) [m, rad] and the `Result` code; differentiable.

    Fails: as `solve_load`.
    """
    solution = solve(model.element, model.load, model.solve_options)
    q = solution.displacement
    (found,) = model.element.rows(q)

    def place(free, azimuth, x):
        axes = free.element.axes(azimuth)
        return free.place(RingMotion(axes @ q[:6], axes @ q[6:]), x)

    places = system.row.each(place, system.row.azimuth, found.x)
    ring = (q[6:] if system.moving else q[:6])[: system.mass.shape[0]]
    return jnp.concatenate([ring, places.ravel()]), solution.result

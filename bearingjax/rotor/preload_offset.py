"""Axial preload of a bearing on a shaft, by force."""

import jax.numpy as jnp

from ..design.checks import positive
from ..element.bearing_element import BearingElement, check_element
from ..numerics.result import Result
from ..numerics.types import Scalar, as_real
from ..statics.load import solve_load
from ..statics.support import Support


def preload_offset(
    element: BearingElement, force: Scalar | float, *, throw: bool = True
) -> Scalar:
    """Return the axial displacement of the inner ring of one bearing under a force [m].

    It is the `offset` along z of a `BearingSupport`: the force is that of the bearing
    before the shaft deflects and before other bearings and loads share it.
    The bearing is at rest, and its rings are held coaxial.

    Args:
        element: The bearing, or a set.
        force: Along +z on the inner ring [N].
        throw: Raise if the bearing does not hold the force; otherwise the displacement
            is NaN. Static.

    Returns:
        Displacement along z, differentiable with respect to design and force.

    Raises:
        SolveError: If the bearing does not hold the force and `throw`.
    """
    check_element("preload_offset", element)
    pushing = as_real(force)
    positive("preload_offset", "force", pushing, "N")
    load = jnp.zeros(6, pushing.dtype).at[2].set(pushing)
    found = solve_load(element, load, support=Support(free=["uz"]), throw=throw)
    held = found.result == Result.CONVERGED
    return jnp.where(held, found.displacement[8], jnp.nan)

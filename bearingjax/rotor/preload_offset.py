"""Axial preload of a bearing on a shaft, by force."""

from functools import partial

import jax.numpy as jnp
import numpy as np

from ..design.bearing_set import bearings_of
from ..design.checks import are_known, positive
from ..element.bearing_element import BearingElement, check_element
from ..numerics.result import Result
from ..numerics.types import Number, Scalar, as_real
from ..statics import Support, solve_load
from .bearing_support import BearingSupport
from .condensation import CondensedRotor
from .rotor import N_STATION
from .statics import search_by_parts


def preload_offset(
    element: BearingElement,
    force: Number,
    *,
    throw: bool = True,
    inertia: bool | None = None,
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
        inertia: Whether the solves that follow feel a speed, whose program is then
            taken at rest; `None`: they have none. It changes no result. Static.

    Returns:
        Displacement along z, differentiable with respect to design and force.

    Raises:
        SolveError: If the bearing does not hold the force and `throw`.
    """
    check_element("preload_offset", element)
    pushing = as_real(force)
    positive("preload_offset", "force", pushing, "N")
    if are_known(element, pushing):
        moved = _search(element, pushing, inertia)
        if moved is not None:
            return moved
    load = jnp.zeros(6, pushing.dtype).at[2].set(pushing)
    found = solve_load(element, load, support=Support(free=["uz"]), throw=throw)
    held = found.result == Result.CONVERGED
    return jnp.where(held, found.displacement[8], jnp.nan)


def _search(element, pushing, inertia) -> Scalar | None:
    """Return the displacement by calls of the program of a kind of bearing, or `None`
    if that finds none."""
    support = BearingSupport(0, element, inertia=bool(inertia))
    still = None if inertia is None else 0.0
    rows = np.zeros((1, N_STATION, 1))
    rows[0, 2] = 1.0
    parts = CondensedRotor(
        stiffness=as_real(np.zeros((1, 1))),
        force=as_real(np.asarray(pushing).reshape(1)),
        rows=as_real(rows),
        back=as_real(np.eye(1)),
        there=as_real(np.zeros(1)),
        supports=(),
        speed=as_real(0.0),
    )
    radii = [0.5 * float(row.pitch_diameter) for row in bearings_of(element.bearing)]
    respond = partial(support.respond_alone, speed=still)
    found = search_by_parts(parts, as_real(8.0 * max(radii)), [respond])
    if int(found.result) != Result.CONVERGED:
        return None
    return as_real(np.asarray(found.x)[0])

"""Load case of one load solve, from the checked arguments."""

from collections.abc import Sequence
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBearing, BearingSet
from ..design.bearing_set import bearings_of
from ..element import FREEDOMS, Speed
from ..numerics.types import as_array
from .support import Support, check_held, restrained_freedoms, six_numbers

Vector = Float[Array | np.ndarray, "6"] | Sequence[float | int]
"""Six numbers."""


class LoadCase(eqx.Module):
    """One load on one bearing, and what holds the bearing.

    Attributes:
        load: On the moving ring (6,) [N, N m].
        given: Displacements of the moving ring that are prescribed, zero of the others
            (6,) [m, rad].
        fixed: Displacement of the fixed ring (6,) [m, rad].
        start: Displacement of the moving ring from which the solve starts (6,)
            [m, rad], or `None`.
        speed: Ring speeds, or `None`.
        loose: 1 for freedoms of the moving ring that may move, else 0 (6,) [1].
        free: Freedoms of the moving ring that may move.
        held: Freedoms that a support holds: prescribed, or left out of the free ones.
        moving_ring: The ring that the load acts on.

    Traced: all real numbers. Static: free, held, moving_ring.
    """

    load: Float[Array, "6"]
    given: Float[Array, "6"]
    fixed: Float[Array, "6"]
    start: Float[Array, "6"] | None
    speed: Speed | None
    loose: Float[Array, "6"]
    free: tuple[str, ...] = eqx.field(static=True)
    held: tuple[str, ...] = eqx.field(static=True)
    moving_ring: str = eqx.field(static=True)


def load_case(
    bearing: AbstractBearing | BearingSet,
    load: Any,
    support: Support,
    *,
    speed: Speed | None = None,
    start: Any = None,
) -> LoadCase:
    """The arguments of `solve_load` as arrays of the dtype of the design.

    Args:
        bearing: The design.
        load, start: As in `solve_load`, not checked.
        support: What holds the rings.
        speed: As in `solve_load`.

    Raises:
        TypeError: For text in place of numbers.
        ValueError: For a load on a freedom that is held, or shapes that do not fit.
    """
    dtype = bearings_of(bearing)[0].pitch_diameter.dtype
    nothing = np.zeros(6)
    load = nothing if load is None else load
    forces = six_numbers("solve_load", "load", load, dtype)
    fixed = support.fixed_displacement
    check_held("solve_load", forces, support)
    rows = bearing.rows if isinstance(bearing, BearingSet) else ()
    for k, row in enumerate(rows):
        if row.spring is not None and "uz" not in restrained_freedoms(row.bearing):
            raise ValueError(
                f"solve_load: row {k} has a spring, but holds no axial load."
            )
    free = support.freedoms(bearing)
    left_out = () if support.free is None else set(FREEDOMS[:5]) - set(free)
    return LoadCase(
        forces,
        support.given_values(dtype),
        as_array(nothing if fixed is None else fixed, dtype),
        None if start is None else six_numbers("solve_load", "start", start, dtype),
        speed,
        loose=as_array([name in free for name in FREEDOMS], dtype),
        free=free,
        held=tuple(f for f in FREEDOMS if f in support.prescribed or f in left_out),
        moving_ring=support.moving_ring,
    )

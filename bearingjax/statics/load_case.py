"""Load case of one load solve, from the checked arguments."""

from collections.abc import Mapping, Sequence
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBearing, BearingSet
from ..design.bearing_set import bearings_of
from ..design.checks import real_numbers
from ..element.frame import FREEDOMS, LOADS
from ..element.inertia import Speed
from ..numerics.types import as_array
from .options import SolveOptions, check_names
from .support import check_held, restrained_freedoms

Vector = Float[Array | np.ndarray, "6"] | Sequence[float | int]
"""Six numbers."""

Prescribed = Mapping[str, float | int | Array | np.ndarray]
"""Displacements by name of the freedom [m, rad]."""


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
        free: Freedoms of the moving ring that may move.
        held: Freedoms that a support holds: prescribed, or left out of the free ones.

    Traced: all real numbers. Static: free, held.
    """

    load: Float[Array, "6"]
    given: Float[Array, "6"]
    fixed: Float[Array, "6"]
    start: Float[Array, "6"] | None
    speed: Speed | None
    free: tuple[str, ...] = eqx.field(static=True)
    held: tuple[str, ...] = eqx.field(static=True)


def load_case(
    bearing: AbstractBearing | BearingSet,
    load: Any,
    options: SolveOptions,
    *,
    prescribed: Any = None,
    fixed_displacement: Any = None,
    speed: Speed | None = None,
    start: Any = None,
) -> LoadCase:
    """The arguments of `solve_load` as arrays of the dtype of the design.

    Args:
        bearing: The design.
        load, prescribed, fixed_displacement, start: As in `solve_load`, not checked.
        options: Settings, checked.
        speed: As in `solve_load`.

    Raises:
        TypeError: For text in place of numbers.
        ValueError: For unknown names, or contradictory choices.
    """
    dtype = bearings_of(bearing)[0].pitch_diameter.dtype
    forces = _six("load", load, dtype)
    fixed = _six("fixed_displacement", fixed_displacement, dtype)
    prescribed = _name_freedoms(prescribed)
    check_names("solve_load", "prescribed", tuple(prescribed))
    given = _six("prescribed", [prescribed.get(f, 0.0) for f in FREEDOMS], dtype)
    free = options.free
    if free is None:
        free = [f for f in restrained_freedoms(bearing) if f not in prescribed]
    both = sorted(set(free) & set(prescribed))
    if both:
        raise ValueError(
            f"solve_load: {', '.join(both)} is both free and prescribed; choose one."
        )
    check_held("solve_load", forces, prescribed, options.free)
    rows = bearing.rows if isinstance(bearing, BearingSet) else ()
    for k, row in enumerate(rows):
        if row.spring is not None and "uz" not in restrained_freedoms(row.bearing):
            raise ValueError(
                f"solve_load: row {k} has a spring, but holds no axial load."
            )
    left_out = () if options.free is None else set(FREEDOMS[:5]) - set(free)
    return LoadCase(
        forces,
        given,
        fixed,
        None if start is None else _six("start", start, dtype),
        speed,
        free=tuple(name for name in FREEDOMS if name in free),
        held=tuple(f for f in FREEDOMS if f in prescribed or f in left_out),
    )


def _name_freedoms(prescribed) -> dict:
    if prescribed is None:
        return {}
    if not isinstance(prescribed, Mapping):
        raise TypeError(
            f"solve_load: `prescribed` is {prescribed!r}; it must be a dict of freedoms"
            " with their values in m or rad, such as {'uz': 1e-5}."
        )
    return dict(prescribed)


def _six(name, value, dtype):
    value = np.zeros(6) if value is None else value
    order, unit = (LOADS, "N, N m") if name == "load" else (FREEDOMS, "m, rad")
    wanted = f"six numbers, {' '.join(order)} in {unit} (units belong in scene files)"
    real_numbers("solve_load", name, value, wanted)
    try:
        array = as_array(value, dtype)
    except ValueError as error:  # lists of unlike length
        raise ValueError(f"solve_load: `{name}` must be {wanted}.") from error
    if array.shape != (6,):
        raise ValueError(
            f"solve_load: `{name}` has shape {array.shape}; it must be (6,):"
            f" {' '.join(order)}."
        )
    return array

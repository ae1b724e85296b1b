"""Names of the numbers of a sweep that are zero in every case."""

from ..design.bearing_set import bearings_of
from ..design.rib import RIB_NAMES
from ..element import FREEDOMS, RINGS, BearingElement
from ..statics.support import Support
from .cases import Cases


def structural_zeros(
    element: BearingElement, cases: Cases, support: Support
) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Names along the last axis of outputs whose numbers are zero by construction.

    They are the displacements of a ring that stands and of freedoms that are held
    there, the moment and the stiffness about the axis, and the load of ribs that are
    not there.

    Returns:
        (output, names such as "outer_ux", as the columns of a table have them), each.
    """
    moving = {*support.freedoms(element.bearing), *cases.prescribed}
    fixed = FREEDOMS if cases.fixed_displacement is not None else ()
    moves = {support.moving_ring: moving, support.fixed_ring: fixed}
    still = tuple(
        f"{ring}_{f}" for ring in RINGS for f in FREEDOMS if f not in moves[ring]
    )
    about_axis = not element.cage_torque
    zeros = {
        "displacement": still,
        "force": tuple(f"{ring}_Mz" for ring in RINGS if about_axis),
        "stiffness": tuple(f"{ring}_gz" for ring in RINGS if about_axis),
        "rib_load": tuple(name for name in RIB_NAMES if name not in _ribs(element)),
    }
    return tuple(zeros.items())


def _ribs(element: BearingElement) -> set[str]:
    return {name for row in bearings_of(element.bearing) for name in row.rib_names}

"""Freedoms that the bearing restrains, and those that its surroundings hold."""

from collections.abc import Iterable, Sequence

import numpy as np
from jaxtyping import Array, Float

from ..design import (
    AbstractBallBearing,
    AbstractBearing,
    BearingSet,
    CylindricalRollerBearing,
    CylindricalThrustRollerBearing,
    SphericalThrustRollerBearing,
    ToroidalRollerBearing,
    rows_of,
)
from ..design.bearing_set import bearings_of, is_self_aligning
from ..design.checks import is_traced
from ..element.frame import FREEDOMS, LOADS


def restrained_freedoms(bearing: AbstractBearing | BearingSet) -> tuple[str, ...]:
    """Freedoms that the bearing can restrain, against a load in the right direction.

    Never gz. Not gx and gy of a self-aligning bearing or of a single spherical roller
    thrust bearing, not ux and uy of cylindrical roller thrust bearings; of a toroidal
    roller bearing ux and uy alone. uz with balls and tapered rollers, and where a pair
    of ribs passes axial load from ring to ring.

    Args:
        bearing: The design.
    """
    rows = list(bearings_of(bearing))
    axial = any(row.holds_axially for row in rows)
    flat = all(isinstance(row, CylindricalThrustRollerBearing) for row in rows)
    tilting = SphericalThrustRollerBearing | ToroidalRollerBearing
    sphere = len(rows) == 1 and isinstance(rows[0], tilting)
    tilts = () if sphere or is_self_aligning(bearing) else ("gx", "gy")
    return (*(() if flat else ("ux", "uy")), *(("uz",) if axial else ()), *tilts)


def axial_senses(bearing: AbstractBearing | BearingSet) -> set[int]:
    """Senses in which the bearing carries axial load on its inner ring: 1 along +z, -1.

    Args:
        bearing: The design.
    """
    found: set[int] = set()
    for row in rows_of(bearing):
        part, sense = row.bearing, -1 if row.mirrored else 1
        if not part.holds_axially:
            continue
        if isinstance(part, AbstractBallBearing):
            found |= {sense} if part.is_one_sided else {1, -1}
        elif isinstance(part, CylindricalRollerBearing):
            ribs = part.ribs
            paths = {
                sense: (ribs.inner_minus, ribs.outer_plus),
                -sense: (ribs.inner_plus, ribs.outer_minus),
            }
            found |= {s for s, pair in paths.items() if None not in pair}
        else:
            found.add(sense)
    return found


def check_held(
    owner: str,
    load: Float[Array | np.ndarray, "*case 6"],
    prescribed: Iterable[str],
    free: Sequence[str] | None,
) -> None:
    """Raise if known loads act on freedoms that are held.

    Args:
        owner: Function that was called, for the message.
        load: Loads of one or of many cases [N, N m]; traced ones are not checked.
        prescribed: Freedoms with given displacements.
        free: Freedoms that were chosen to be free, or `None`: the default.

    Raises:
        ValueError: Naming the load, the freedom, and why it is held.
    """
    if is_traced(load):
        return
    loads = np.nan_to_num(np.asarray(load).reshape(-1, 6))
    # Not gz: a moment about the axis has no load path, which the result code says.
    left_out = () if free is None else set(FREEDOMS[:5]) - set(free) - set(prescribed)
    for names, why in ((prescribed, "prescribed"), (left_out, "not among `free`")):
        for index in sorted(FREEDOMS.index(name) for name in names):
            cases = np.flatnonzero(loads[:, index])
            if cases.size == 0:
                continue
            which = "" if np.ndim(load) == 1 else f" in case {cases[0]}"
            unit = "N" if index < 3 else "N m"
            raise ValueError(
                f"{owner}: `load` has {LOADS[index]} ="
                f" {loads[cases[0], index]:.6g} {unit}{which}, but {FREEDOMS[index]} is"
                f" {why}: its support would take that load, and what it passes to the"
                " bearing is a result. Choose one."
            )

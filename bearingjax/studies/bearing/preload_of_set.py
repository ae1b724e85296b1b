"""Preload of a set on its seats: as ground, mounted, and in operation."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import numpy as np

from ...cases.sweep import stack_designs
from ...element import BearingElement, Speed
from ...fits import Limits, Mounting, mounting_at, with_bearing_dimensions
from ...numerics.compiled.programs import call_stored
from ...numerics.types import as_array
from ...report.json_output import to_json
from ...report.report_model import Column, Grid, Part
from ...statics.installed import Installed
from ...statics.preload import is_opposed, remaining_preload
from .fits import Fits

_LEAST = 1e-6
"""Force below which the preload counts as zero [N]."""

_MUCH = 2.0
"""Ratio to the preload as ground from which a change of preload is warned of."""


@dataclasses.dataclass(frozen=True)
class PreloadOfSet:
    """Axial preload force between the rows of a set, without external load [N].

    Attributes:
        ground: As ground, before mounting.
        mounted: When mounted, at rest, at the reference temperature and the sizes of
            the solve.
        operating: In operation, at the sizes of the solve.
        mounted_range: At the loosest and the tightest sizes of shaft, housing and
            rings; `None` where all sizes are exact. NaN: with that fit the balls have
            no contact angle, or no equilibrium was found.
        operating_range: Preload in operation at the loosest and the tightest sizes.
    """

    ground: float
    mounted: float
    operating: float
    mounted_range: tuple[float, float] | None
    operating_range: tuple[float, float] | None


def preload_of_set(
    fits: Fits,
    ground: BearingElement[Any],
    speed: Speed | None,
) -> PreloadOfSet | None:
    """Compute the preload of a set on its seats; `None` if its rows are not opposed.

    Args:
        fits: Its seats.
        ground: The bearing before mounting, ground to its preload.
        speed: Ring speeds in operation; `None`: at rest.
    """
    if not is_opposed(ground.bearing):
        return None
    # On seats without contact the set stays as ground, and has the same structure as
    # the others.
    loose = -1e-3 * fits.mounting.bore
    states = {
        "ground": (_on(_fitting(fits.mounting, loose, loose), None, ground), None),
        "mounted": (_on(fits.mounting, None, ground), None),
        "operating": (_on(fits.mounting, fits.conditions, ground), speed),
    }
    # The clearance is that as ground.
    seats = [ends for name, ends in fits.limits.items() if name != "clearance"]
    scatters = any(float(ends.lower) != float(ends.upper) for ends in seats)
    for place in ("tightest", "loosest") if scatters else ():
        seats = _seats(fits, ground, place)
        states[f"{place} mounted"] = _on(seats, None, ground), None
        states[f"{place} operating"] = _on(seats, fits.conditions, ground), speed
    possible = {k: state for k, state in states.items() if state[0] is not None}
    elements = stack_designs([element for element, _ in possible.values()])
    speeds = None
    if speed is not None:
        given = [Speed(0.0, 0.0) if s is None else s for _, s in possible.values()]
        speeds = jax.tree.map(lambda *x: as_array(np.stack(x), float), *given)
    found = np.asarray(call_stored(_preloads, elements, speeds))
    force = dict.fromkeys(states, np.nan)
    # Round-off is not a preload.
    found = np.where(np.abs(found) < _LEAST, 0.0, found)
    force |= {k: float(x) for k, x in zip(possible, found, strict=True)}

    def ends(state):
        pair = [force[f"{place} {state}"] for place in ("loosest", "tightest")]
        return (pair[0], pair[1])

    return PreloadOfSet(
        force["ground"],
        force["mounted"],
        force["operating"],
        ends("mounted") if scatters else None,
        ends("operating") if scatters else None,
    )


def _preloads(elements, speeds):
    def one(element, speed):
        return remaining_preload(element, speed, throw=False)

    return eqx.filter_vmap(one)(elements, speeds)


def _seats(fits, ground, place) -> Mounting:
    """Return the seats at a place within their tolerances."""
    whole = jax.device_get(with_bearing_dimensions(fits.mounting, ground.bearing))
    own = float(whole.radial_clearance)
    limits = {**fits.limits, "clearance": Limits(own, own)}
    there = mounting_at(whole, place, **limits)
    return _fitting(fits.mounting, there.shaft_interference, there.housing_interference)


def _fitting(mounting, shaft, housing) -> Mounting:
    """Return the seats with other interferences [m]."""
    return eqx.tree_at(
        lambda m: (m.shaft_interference, m.housing_interference),
        mounting,
        (as_array(shaft, float), as_array(housing, float)),
    )


def _on(mounting, conditions, ground) -> BearingElement | None:
    """Return the set on its seats; `None` if its balls have no contact angle left."""
    try:
        return Installed(ground, None, mounting, conditions).at()
    except ValueError:
        return None


def preload_warnings(found: PreloadOfSet) -> list[str]:
    """Return warnings about the preload of a set on its seats, one sentence each.

    Args:
        found: From `preload_of_set`.
    """
    ground, operating = found.ground, found.operating
    least, most = found.operating_range or (operating, operating)
    ends = ""
    if found.operating_range is not None:
        ends = f" ({_newtons(least)} to {_newtons(most)} over the tolerances)"
    if operating == 0.0 < ground:
        return [
            f"preload: the set, ground to {_newtons(ground)}, has none left in"
            f" operation{ends}: fits, warmth and speed take it"
        ]
    if ground > 0.0 and not 1.0 / _MUCH < operating / ground < _MUCH:
        return [
            f"preload: {_newtons(ground)} as ground are {_newtons(operating)} in"
            f" operation{ends}, by fits, warmth and speed"
        ]
    if least == 0.0 < ground:
        return [
            "preload: at the loosest sizes of the tolerances the set has none left in"
            " operation"
        ]
    return []


def range_warnings(ground: float, least: float, most: float) -> list[str]:
    """Return warnings about the preload of a set over cases, one sentence each.

    Args:
        ground: Preload as ground, before mounting [N].
        least, most: Preload in operation, over the cases [N].
    """
    if least == 0.0:
        words = "has none left in operation in some of the cases"
        return [f"preload: the set, ground to {_newtons(ground)}, {words}"]
    if ground / _MUCH < least and most < _MUCH * ground:
        return []
    ends = " to ".join(dict.fromkeys(map(_newtons, (least, most))))
    return [
        f"preload: {_newtons(ground)} as ground are {ends} in operation over the cases,"
        " by fits, warmth and speed"
    ]


def preload_as_dict(found: PreloadOfSet) -> dict[str, Any]:
    """Return the preload of a set as plain numbers [N]; impossible values are null.

    Args:
        found: From `preload_of_set`.

    Returns:
        ground, mounted, operating; with tolerances also worst: mounted, operating,
        each at the loosest and the tightest sizes.
    """
    numbers: dict[str, Any] = {
        name: getattr(found, name) for name in ("ground", "mounted", "operating")
    }
    ranges = {"mounted": found.mounted_range, "operating": found.operating_range}
    if worst := {k: ends for k, ends in ranges.items() if ends}:
        numbers["worst"] = worst
    return to_json(numbers)


def preload_report(found: PreloadOfSet) -> list[Part]:
    """Return the report of the preload of a set.

    Args:
        found: From `preload_of_set`.
    """
    states = {
        "ground": (found.ground, None),
        "mounted": (found.mounted, found.mounted_range),
        "operating": (found.operating, found.operating_range),
    }
    columns = [
        Column("", list(states)),
        Column("nominal", [_newtons(force) for force, _ in states.values()]),
    ]
    ends = [r for _, r in states.values()]
    if any(ends):
        texts = [" to ".join(map(_newtons, r)) if r else "-" for r in ends]
        columns.append(Column("over the tolerances", texts))
    return [Grid(columns, "preload of the set, unloaded")]


def _newtons(force: float) -> str:
    return f"{force:.4g} N" if np.isfinite(force) else "not possible"

"""Fits of a scene as text for people, and as numbers in SI for programs."""

from typing import Any

import numpy as np

from ..design import Bearing, BearingSet, TaperedRollerBearing, rows_of
from .fit_table import Fits, fit_facts

ACROSS_TAPERS = "normal to the outer raceway"
"""Along what the clearance of a taper is a number of its design."""


def outer_cosine(taper: TaperedRollerBearing) -> float:
    """Clearance normal to the outer raceway over the radial one [1].

    Args:
        taper: In NumPy's numbers too, of which `radial_clearance` would compile.
    """
    angle = float(taper.roller_axis_angle) + float(taper.roller_half_angle)
    return float(np.cos(angle))


def fit_report(fits: Fits, bearing: Bearing | BearingSet) -> str:
    """Readable report of fits: radial clearance from bearing to operation, and seats.

    Args:
        fits, bearing: As of `fit_facts`.
    """
    facts = fit_facts(fits, bearing)
    left = facts.operating.radial_clearance
    shaft, housing = (name or "as given" for name in fits.names)
    lines = [
        f"fits: shaft {shaft}, housing {housing}; sizes of the solve:"
        f" {fits.place.replace('_', ' ')}",
        f"radial clearance   free {_micron(facts.free)}, mounted"
        f" {_micron(facts.mounted.radial_clearance)}, operating {_micron(left)} µm",
    ]
    row = rows_of(bearing)[0].bearing
    if isinstance(row, TaperedRollerBearing):
        states = facts.free, facts.mounted.radial_clearance, left
        free, cold, warm = (_micron(float(c) * outer_cosine(row)) for c in states)
        lines.append(
            f"  {ACROSS_TAPERS}: free {free}, mounted {cold}, operating {warm} µm"
        )
    for words, found in (
        ("mounted", facts.mounted_range),
        ("operating", facts.operating_range),
    ):
        lines.append(
            f"  {words:<17}probable {_ends(found.probable)}, worst"
            f" {_ends(found.worst)} µm"
        )
    lines += [_seat(facts, seat) for seat in ("shaft", "housing")]
    stress = 1e-6 * float(facts.operating.ring_stress)
    lines.append(
        f"hoop stress of the inner ring at its bore, operating {stress:.4g} MPa"
    )
    return "\n".join(lines)


def _micron(value) -> str:
    return f"{round(1e6 * float(value), 2) + 0.0:.4g}"


def _ends(limits) -> str:
    return f"{_micron(limits.lower)} to {_micron(limits.upper)}"


def _seat(facts, seat) -> str:
    before, after = (
        getattr(state, f"{seat}_interference")
        for state in (facts.mounted, facts.operating)
    )
    pressure = 1e-6 * float(getattr(facts.operating, f"{seat}_pressure"))
    return (
        f"{seat:<9}interference mounted {_micron(before)}, operating"
        f" {_micron(after)} µm; pressure operating {pressure:.4g} MPa"
    )


def fit_as_dict(fits: Fits, bearing: Bearing | BearingSet) -> dict[str, Any]:
    """Fits of a scene as plain numbers, in SI.

    Args:
        fits, bearing: As of `fit_facts`.

    Returns:
        place; radial_clearance: free, mounted, operating; worst and probable: mounted,
        operating, each least and largest [m]; and mounted and operating:
        shaft_interference, housing_interference [m], shaft_pressure, housing_pressure,
        ring_stress [Pa].
    """
    facts = fit_facts(fits, bearing)
    states = {"mounted": facts.mounted, "operating": facts.operating}
    ranges = {"mounted": facts.mounted_range, "operating": facts.operating_range}
    kept = (
        "shaft_interference",
        "housing_interference",
        "shaft_pressure",
        "housing_pressure",
        "ring_stress",
    )
    return {
        "place": fits.place,
        "radial_clearance": {
            "free": facts.free,
            **{k: float(state.radial_clearance) for k, state in states.items()},
        },
        **{
            kind: {
                k: [float(end) for end in getattr(found, kind)]
                for k, found in ranges.items()
            }
            for kind in ("worst", "probable")
        },
        **{
            k: {name: float(getattr(state, name)) for name in kept}
            for k, state in states.items()
        },
    }

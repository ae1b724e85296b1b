"""Fits of a scene as text, and as numbers in SI."""

from typing import Any

import numpy as np

from ...design import TaperedRollerBearing, rows_of
from ...report.report_model import Column, Grid, Part
from .fits import Fits

ACROSS_TAPERS = "normal to the outer raceway"
"""Direction in which the clearance of a tapered roller bearing is specified."""


def outer_cosine(taper: TaperedRollerBearing) -> float:
    """Return the clearance normal to the outer raceway over the radial one [1].

    Args:
        taper: The bearing; NumPy leaves are allowed, and avoid compilation.
    """
    angle = float(taper.roller_axis_angle) + float(taper.roller_half_angle)
    return float(np.cos(angle))


def fit_report(fits: Fits) -> list[Part]:
    """Return the report of fits: radial clearance from free to operation, and seats.

    Args:
        fits: From `read_fits`.
    """
    facts = fits.facts
    shaft, housing = (name or "as given" for name in fits.names)
    if float(fits.mounting.bore_taper):
        shaft = "tapered"
    states = {
        "free": facts.free,
        "mounted": facts.mounted.radial_clearance,
        "operating": facts.operating.radial_clearance,
    }
    ranges = [None, facts.mounted_range, facts.operating_range]
    row = rows_of(fits.bearing)[0].bearing
    columns = [Column("", list(states)), _microns("nominal", list(states.values()))]
    if isinstance(row, TaperedRollerBearing):
        across = [float(c) * outer_cosine(row) for c in states.values()]
        columns.append(_microns(ACROSS_TAPERS, across))
    for kind in ("probable", "worst"):
        ends = ["-" if r is None else _ends(getattr(r, kind)) for r in ranges]
        columns.append(Column(kind, ends, "m"))
    return [
        f"fits: shaft {shaft}, housing {housing}; sizes of the solve:"
        f" {fits.place.replace('_', ' ')}",
        *_driven(fits),
        Grid(columns, "radial clearance"),
        _seats(facts),
        "hoop stress of the inner ring at its bore, operating"
        f" {1e-6 * float(facts.operating.ring_stress):.4g} MPa",
    ]


def _driven(fits: Fits) -> list[Part]:
    """Return what driving up a tapered seat does, if there is one."""
    taper, travel = float(fits.mounting.bore_taper), float(fits.mounting.drive_up)
    if not taper:
        return []
    return [
        f"tapered seat 1:{1.0 / taper:.4g}: driven up by {1e3 * travel:.4g} mm, an"
        f" interference of {_micron(taper * travel)} µm"
    ]


def _micron(value) -> str:
    return f"{round(1e6 * float(value), 2) + 0.0:.4g}"


def _ends(limits) -> str:
    return f"{_micron(limits.lower)} to {_micron(limits.upper)}"


def _microns(name, values):
    return Column(name, [round(float(v), 8) for v in values], "m", ".4g")


def _seats(facts) -> Grid:
    """Tabulate interference and pressure of both seats."""

    def both(state, what):
        return [getattr(state, f"{seat}_{what}") for seat in seats]

    seats = "shaft", "housing"
    pressure = both(facts.operating, "pressure")
    return Grid(
        [
            Column("", seats),
            _microns("interference mounted", both(facts.mounted, "interference")),
            _microns("operating", both(facts.operating, "interference")),
            Column("pressure operating", pressure, "Pa", ".4g"),
        ]
    )


def fit_as_dict(fits: Fits) -> dict[str, Any]:
    """Return the fits of a scene as plain numbers, in SI.

    Args:
        fits: From `read_fits`.

    Returns:
        place; bore_taper [1] and drive_up [m], 0 of cylindrical seats;
        radial_clearance: free, mounted, operating; worst and probable: mounted,
        operating, each least and largest [m]; and mounted and operating:
        shaft_interference, housing_interference [m], shaft_pressure, housing_pressure,
        ring_stress [Pa].
    """
    facts = fits.facts
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
        "bore_taper": float(fits.mounting.bore_taper),
        "drive_up": float(fits.mounting.drive_up),
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

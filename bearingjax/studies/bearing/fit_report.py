"""Fits of a scene, and the preload of its set on them, as text and numbers in SI."""

from typing import Any

import jax
import numpy as np

from ...design import TaperedRollerBearing, rows_of
from ...report.json_output import to_json
from ...report.report_model import Column, Grid, Part
from ...statics.preload import SetPreload
from ...statics.service_warning import shown_preload
from .read_scene import Scene

ACROSS_TAPERS = "normal to the outer raceway"
"""Direction in which the clearance of a tapered roller bearing is specified."""


def outer_cosine(taper: TaperedRollerBearing) -> float:
    """Return the clearance normal to the outer raceway over the radial one [1].

    Args:
        taper: The bearing; NumPy leaves are allowed, and avoid compilation.
    """
    angle = float(taper.roller_axis_angle) + float(taper.roller_half_angle)
    return float(np.cos(angle))


def fit_report(scene: Scene) -> list[Part]:
    """Return the report of fits: radial clearance from free to operation, and seats;
    empty for a scene without fits.
    """
    found, notes, seats = scene.fit_states, scene.fits, scene.installed.mounting
    if found is None or notes is None or seats is None:
        return []
    shaft, housing = (name or "as given" for name in notes.classes)
    taper, driven = float(seats.bore_taper), []
    if taper:
        shaft, travel = "tapered", float(seats.drive_up)
        driven = [
            f"tapered seat 1:{1.0 / taper:.4g}: driven up by {1e3 * travel:.4g} mm, an"
            f" interference of {_micron(taper * travel)} µm"
        ]
    states = {
        "free": found.free,
        "mounted": found.mounted.radial_clearance,
        "operating": found.operating.radial_clearance,
    }
    ranges = [found.mounted_range, found.operating_range]
    limits = jax.device_get(scene.installed.limits or ())
    scatters = any(ends.lower != ends.upper for ends in limits)
    row = rows_of(scene.element.bearing)[0].bearing
    columns = [Column("", list(states)), _microns("nominal", list(states.values()))]
    if isinstance(row, TaperedRollerBearing):
        across = [float(c) * outer_cosine(row) for c in states.values()]
        columns.append(_microns(ACROSS_TAPERS, across))
    # Of exact sizes there is nothing to tell but the nominal.
    for kind in ("probable", "worst") if scatters else ():
        ends = [_ends(getattr(r, kind)) for r in ranges if r is not None]
        columns.append(Column(kind, ["-", *ends], "m"))
    place = f"; sizes of the solve: {notes.place.replace('_', ' ')}" if scatters else ""
    return [
        f"fits: shaft {shaft}, housing {housing}{place}",
        *driven,
        Grid(columns, "radial clearance"),
        _seats(found),
        "hoop stress of the inner ring at its bore, operating"
        f" {1e-6 * float(found.operating.ring_stress):.4g} MPa",
    ]


def _micron(value) -> str:
    return f"{round(1e6 * float(value), 2) + 0.0:.4g}"


def _ends(limits) -> str:
    return " to ".join(map(_micron, limits))


def _microns(name, values):
    return Column(name, [round(float(v), 8) for v in values], "m", ".4g")


def _seats(found) -> Grid:
    """Tabulate interference and pressure of both seats."""

    def of_seats(state, what):
        return [getattr(state, f"{seat}_{what}") for seat in seats]

    seats = "shaft", "housing"
    pressure = of_seats(found.operating, "pressure")
    return Grid(
        [
            Column("", seats),
            _microns("interference mounted", of_seats(found.mounted, "interference")),
            _microns("operating", of_seats(found.operating, "interference")),
            Column("pressure operating", pressure, "Pa", ".4g"),
        ]
    )


def fit_as_dict(scene: Scene) -> dict[str, Any]:
    """Return the fits of a scene as plain numbers, in SI; empty without fits.

    Returns:
        place; bore_taper [1] and drive_up [m], 0 of cylindrical seats;
        radial_clearance: free, mounted, operating; worst and probable: mounted,
        operating, each least and largest [m]; and mounted and operating:
        shaft_interference, housing_interference [m], shaft_pressure, housing_pressure,
        ring_stress [Pa].
    """
    facts, notes, seats = scene.fit_states, scene.fits, scene.installed.mounting
    if facts is None or notes is None or seats is None:
        return {}
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
        "place": notes.place,
        "bore_taper": float(seats.bore_taper),
        "drive_up": float(seats.drive_up),
        "radial_clearance": {
            "free": float(facts.free),
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


def preload_as_dict(found: SetPreload) -> dict[str, Any]:
    """Return the preload of a set as plain numbers [N]; impossible values are null.

    Args:
        found: From `Installed.set_preload`.

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


def preload_report(found: SetPreload) -> list[Part]:
    """Return the report of the preload of a set.

    Args:
        found: From `Installed.set_preload`.
    """
    states = {
        "ground": (found.ground, None),
        "mounted": (found.mounted, found.mounted_range),
        "operating": (found.operating, found.operating_range),
    }
    columns = [
        Column("", list(states)),
        Column("nominal", [shown_preload(force) for force, _ in states.values()]),
    ]
    ends = [r for _, r in states.values()]
    if any(ends):
        texts = [" to ".join(map(shown_preload, r)) if r else "-" for r in ends]
        columns.append(Column("over the tolerances", texts))
    return [Grid(columns, "preload of the set, unloaded")]

"""Report of a solved contact as text, and its results as JSON in SI."""

from typing import Any

import numpy as np

from ...contact.slices import SliceComparison, compared_warnings
from ...numerics import Result, Warning
from ...numerics.units import shown_count
from ...report.json_output import run_json
from ...report.report_model import NEWTONS, Column, Grid, Report
from ..bearing.credibility import credibility_section
from .read import ContactScene

PLACES = (1 / 30, 1 / 15, 1 / 4, 1 / 2, 3 / 4, 14 / 15, 29 / 30)
"""Positions at which the report gives the pressure: from the small end, over length."""


def contact_warnings(
    scene: ContactScene, cases: list[SliceComparison]
) -> list[Warning]:
    """Return the warnings of a solved contact."""
    narrowed = None if scene.numerics.half_width is None else "numerics.half_width"
    return [*scene.warnings, *compared_warnings(scene.contact, cases, narrowed)]


def contact_as_dict(
    scene: ContactScene, cases: list[SliceComparison]
) -> dict[str, Any]:
    """Return a solved contact as plain numbers and lists, in SI.

    Returns:
        position and cell_length along the roller, end_cell_length, the results of
        `_numbers`, result, message, residual, iterations, warnings, inputs (the file
        can be read as a scene; for a roller of a bearing that of the bearing) and
        version. If the scene lists its loads, all but the first three and last three
        are lists over them, null where a load was not solved. If nothing was solved
        the numbers are left out.
    """
    rows = [_numbers(scene, case) if case.solution.converged else {} for case in cases]
    found: dict[str, Any] = {}
    if any(rows):
        grid = cases[0].solution.grid
        lengths = 2.0 * np.asarray(grid.half_y)
        found = {
            "position": grid.y,
            "cell_length": lengths,
            "end_cell_length": lengths[0],
        }
        names = next(row for row in rows if row)
        found |= {name: [row.get(name) for row in rows] for name in names}
    stats = [_status(case.solution) for case in cases]
    found |= {name: [row[name] for row in stats] for name in stats[0]}
    if not scene.operating.listed:
        shared = ("position", "cell_length", "end_cell_length")
        found = {k: v if k in shared else v[0] for k, v in found.items()}
    return run_json(found, contact_warnings(scene, cases), scene.inputs)


def _status(solution) -> dict[str, Any]:
    return {
        "result": Result(int(solution.result)).label,
        "message": solution.failure_message or "converged",
        "residual": solution.residual,
        "iterations": solution.steps,
    }


def _numbers(scene, case: SliceComparison) -> dict[str, Any]:
    solution, slices, peak = case.solution, case.slices, case.peak
    grid = solution.grid
    numbers = {
        "load": solution.load,
        "approach": solution.approach,
        "moment": solution.moment,
        "tilt": solution.tilt,
        "peak_pressure": solution.peak_pressure,
        "peak_position": grid.y[peak] if case.touches else None,
        "peak_cell_length": 2.0 * grid.half_y[peak] if case.touches else None,
        "centre_pressure": solution.centre_pressure,
        "line_load": solution.line_load,
        "half_width": case.half_width,
        "cell_width": 2.0 * grid.half_x,
        "grid_half_width": grid.half_width,
        "truncated": solution.truncated,
        "slices": {
            "approach": slices.approach if case.touches else None,
            "line_load": slices.line_load,
            "contact_pressure": slices.pressure,
            "peak_pressure": slices.peak_pressure,
        },
        "edge_factor": case.edge_factor if case.touches else None,
    }
    if scene.field:
        numbers["field"] = {
            "x": grid.x,
            "pressure": solution.pressure,
        }
    return numbers


def contact_report(scene: ContactScene, cases: list[SliceComparison]) -> Report:
    """Return the readable report of a solved contact.

    Args:
        scene: The scene of the contact.
        cases: Results of its cases; unsolved ones are left out.
    """
    solved = [case for case in cases if case.solution.converged]
    sections = {
        "Contact": [_contact(scene, solved)],
        "Loads and peaks": [_loads(solved)],
        "Pressures": [_places(scene, solved)],
        "Solution": [_convergence(solved)],
        "Credibility": credibility_section("contact"),
    }
    return Report(sections, contact_warnings(scene, cases))


def _contact(scene, cases):
    contact, grid = scene.contact, cases[0].solution.grid
    cells = scene.numerics
    small, large, length = (
        1e3 * float(v)
        for v in (contact.small_diameter, contact.large_diameter, contact.roller_length)
    )
    size = f"{small:.4g}" if small == large else f"{small:.4g} to {large:.4g}"
    radius = 1e3 * float(contact.raceway_radius)
    raceway = "a plane"
    if np.isfinite(radius):
        side = "an inner" if radius > 0 else "an outer"
        raceway = f"{side} raceway of radius {abs(radius):.4g} mm"
    profiles = [
        type(p).__name__ for p in (contact.roller_profile, contact.raceway_profile)
    ]
    kind = "even" if grid.even else f"graded ({cells.grading:g})"
    return "\n".join(
        [
            f"{scene.name}: roller {size} x {length:.4g} mm, half angle"
            f" {np.rad2deg(float(contact.angle)):.4g} deg, on {raceway}",
            f"profile of the roller: {profiles[0]}, of the raceway: {profiles[1]};"
            f" contact modulus {1e-9 * float(contact.modulus):.4g} GPa"
            + ("" if contact.free_ends is None else "; free end faces"),
            f"{cells.across} x {cells.along} {kind} cells: at the ends"
            f" {2e6 * float(grid.half_y[0]):.4g} µm long, in the middle"
            f" {2e6 * float(grid.half_y[cells.along // 2]):.4g} µm",
        ]
    )


def _loads(cases):
    def where_touching(number):
        return [number(case) if case.touches else None for case in cases]

    def of_cases(name):
        return [_clean(getattr(case.solution, name)) for case in cases]

    def grid(name, case):
        return float(getattr(case.solution.grid, name)[case.peak])

    at = where_touching(lambda case: grid("y", case))
    cell = where_touching(lambda case: 2.0 * grid("half_y", case))
    sliced = where_touching(lambda case: float(case.slices.peak_pressure))
    return Grid(
        [
            Column("load", of_cases("load"), "N", ".5g", NEWTONS),
            Column("approach", of_cases("approach"), "m"),
            Column("tilt", of_cases("tilt"), "rad", ".4g"),
            Column("moment", of_cases("moment"), "N m", ".4g"),
            Column("peak", of_cases("peak_pressure"), "Pa", ".0f"),
            Column("at", at, "m", ".4g", (1e3, "mm")),
            Column("in cell", cell, "m", ".4g"),
            Column("slices", sliced, "Pa", ".0f"),
            Column("edge factor", where_touching(lambda c: c.edge_factor), "", ".3f"),
        ]
    )


def _places(scene, cases):
    """Tabulate the pressure at x = 0 at fixed positions, independent of the cells."""
    length = float(scene.contact.roller_length)
    places = np.array(PLACES) * length
    solved = [case.solution for case in cases]
    pressure = np.array(
        [
            np.interp(0.5 * length - places, one.grid.y, one.centre_pressure)
            for one in solved
        ]
    )
    loads = [float(one.load) for one in solved]
    return Grid(
        [
            Column("load", loads, "N", ".5g", NEWTONS),
            *(
                Column(f"{1e3 * place:.4g} mm", pressure[:, k], "Pa", ".1f")
                for k, place in enumerate(places)
            ),
        ],
        "pressure at x = 0 at distances from the small end",
    )


def _convergence(cases):
    steps = max(int(case.solution.steps) for case in cases)
    residual = max(float(case.solution.residual) for case in cases)
    return (
        f"converged in {shown_count(steps, 'step')}, largest gap left"
        f" {residual:.1e} of the mean displacement"
    )


def _clean(value):
    """Set the round-off of cancelling terms to zero."""
    return 0.0 if abs(float(value)) < 1e-12 else float(value)

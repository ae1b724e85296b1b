"""Choose a bearing as a scene says, and report the choice."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...decide.select import NUMBERS, SIZES, Selection, select, unit_of_number
from ...files.scene_errors import scene_errors
from ...numerics.labels import column_header
from ...numerics.units import shown_number
from ...report.html_report import flat
from ...report.json_output import run_json
from ...report.report_model import Column, Grid, Part, Report, labelled_facts
from .read import Choice

_SHOWN = 10
"""Bearings that a report lists."""

_USUAL = (*SIZES, "mass", "life_hours", "static_safety", "peak_pressure")
"""Numbers that a report always has, beside those that are asked for."""

_UNITS = {"m": (1e3, "mm"), "N m": (1e3, "N mm")}
"""Factor from SI, and unit, of lengths and torques in a report."""


def run_select(
    choice: Choice, told: Callable[[str, float], Any] | None = None
) -> Selection:
    """Choose a bearing as a scene says.

    Args:
        choice: From `read_select`.
        told: As `progress` of `select`.

    Raises:
        SceneError: If the scene suits no bearing that is left.
    """
    more: Any = {"entries": choice.entries, "install": choice.install}
    with scene_errors(choice.name):
        return select(choice.requirements, **more, progress=told)


def select_as_dict(choice: Choice, found: Selection) -> dict[str, Any]:
    """Return `fits` and `excluded` in SI, counts and the smallest; infinite is null."""
    numbers = {name: getattr(found, name) for name in ("fits", "excluded", "counts")}
    return run_json(numbers | {"smallest": found.smallest}, [], choice.inputs)


def select_columns(found: Selection) -> dict[str, np.ndarray]:
    """Return all candidates as columns by header, in SI."""
    return {column_header(k, unit_of_number(k)): v for k, v in found.table.items()}


def nearest_misses(found: Selection, most: int = 5) -> list[str]:
    """Return the nearest misses in words: "6208: life_hours 8200 h of 20000 h".

    Args:
        found: The choice.
        most: How many.
    """
    lines = []
    for row in found.excluded[:most]:
        name, unit = row["requirement"], unit_of_number(row["requirement"])
        ends = [shown_number(row[k], unit, 5) for k in ("value", "limit")]
        lines.append(f"{row['designation']}: {name} {row['why'] or ' of '.join(ends)}")
    return lines


def select_report(choice: Choice, found: Selection) -> Report:
    """Return the readable report: what is asked, what fits, what excludes the rest."""
    asked, rows = choice.requirements, found.fits[:_SHOWN]
    written = {k: v for k, v in choice.written.items() if k != "cases"}
    facts = [("cases", str(asked.load.count))]
    facts += [(key, str(value)) for key, value in flat(written)]
    fits: list[Part] = [
        f"{choice.name}: of {found.table['type'].size} bearings {len(found.fits)} fit;"
        f" the smallest: {found.smallest or 'none'}"
    ]
    if rows:
        columns = [Column("bearing", [row["designation"] for row in rows])]
        wanted = {*_USUAL, *asked.all_bounds, *asked.rank_by}
        for name, (unit, *_) in NUMBERS.items():
            values = np.array([row[name] for row in rows])
            if name in wanted and not np.isnan(values).all():
                given = values, unit_of_number(name), ".4g", _UNITS.get(unit)
                columns.append(Column(name.replace("_", " "), *given))
        fits.append(Grid(columns))
        if not all(row["mass_printed"] for row in rows):
            fits.append("masses that are not printed are estimated from the envelope")
        bare = {one.designation for one in choice.entries if not one.has_inner_ring}
        if any(row["designation"] in bare for row in rows):
            fits.append("those without inner ring (HK, NK, RNA) roll on the shaft")
        fits.append(
            "`bearingjax life` of one tells its warnings, and what is estimated"
        )
    counts = [(name, str(count)) for name, count in found.counts.items()]
    out: list[Part] = [labelled_facts(counts)] if counts else []
    if counts:
        out += ["nearest:", *(f"  {line}" for line in nearest_misses(found))]
    sections = {"Asked": [labelled_facts(facts)], "Fits": fits, "Excluded by": out}
    return Report(sections)

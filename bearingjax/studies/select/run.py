"""Run the selection of a scene, and report it."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...decide import PositionSelection, select_positions
from ...decide.select import NUMBERS, SIZES, Miss, Selection, select, unit_of_number
from ...files.scene_errors import scene_errors
from ...numerics.labels import column_header
from ...report.html_report import flat
from ...report.json_output import run_json
from ...report.report_model import Column, Grid, Part, Report, labelled_facts
from .read import Choice

_SHOWN = 10
"""Largest number of bearings that a report lists."""

_USUAL = (*SIZES, "mass", "life_hours", "static_safety", "peak_pressure")
"""Numbers that a report always lists; it adds those that are bounded or ranked."""

_UNITS = {"m": (1e3, "mm"), "N m": (1e3, "N mm")}
"""Factor from SI, and unit, of lengths and torques in a report."""


def run_select(
    choice: Choice, progress: Callable[[str, float], Any] | None = None
) -> Any:
    """Select a bearing, or those of several positions, by the requirements of a scene.

    Args:
        choice: From `read_select`.
        progress: Function called with a text and the share done.

    Returns:
        `Selection`; of a system of shafts `PositionSelection`.

    Raises:
        SceneError: If the scene suits no remaining bearing, or for a ValueError of
            `select_positions`.
    """
    more: Any = {"entries": choice.entries, "install": choice.install}
    more["progress"] = progress
    with scene_errors(choice.name):
        if choice.designs:
            given = choice.designs, choice.requirements
            return select_positions(*given, **choice.options, **more)
        return select(choice.requirements, **more)


def select_as_dict(choice: Choice, found: Selection) -> dict[str, Any]:
    """Return fitting and excluded bearings in SI, counts and the smallest, for JSON."""
    numbers = {name: getattr(found, name) for name in ("fits", "excluded", "counts")}
    return run_json(numbers | {"smallest": found.smallest}, [], choice.inputs)


def select_columns(found: Selection) -> dict[str, np.ndarray]:
    """Return all candidates as columns by header, in SI."""
    return {column_header(k, unit_of_number(k)): v for k, v in found.table.items()}


def select_report(choice: Choice, found: Selection) -> Report:
    """Return the readable report: requirements, bearings that fit, and exclusions."""
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
            "`bearingjax life` of a designation has its warnings, and what is estimated"
        )
    counts = [(name, str(count)) for name, count in found.counts.items()]
    out: list[Part] = [labelled_facts(counts)] if counts else []
    if counts:
        out += ["nearest:", *(f"  {line}" for line in found.nearest_misses())]
    sections = {"Asked": [labelled_facts(facts)], "Fits": fits, "Excluded by": out}
    return Report(sections)


def positions_as_dict(choice: Choice, found: PositionSelection) -> dict[str, Any]:
    """Return the best combination, all combinations by column (combination, position),
    and the selection of each position alone, in SI."""
    alone = {
        name: {"fits": len(one.fits), "counts": one.counts, "smallest": one.smallest}
        for name, one in found.alone.items()
    }
    numbers = {"best": found.best, "holds": found.holds, "positions": alone}
    numbers |= {"kinds": found.kinds, "combinations": found.table}
    return run_json(numbers, [], choice.inputs)


def positions_columns(found: PositionSelection) -> dict[str, np.ndarray]:
    """Return columns by header in SI, a row for each combination and position."""
    count, names = found.holds.size, [*found.alone]
    columns = {"combination": np.repeat(np.arange(count), len(names))}
    columns["position"] = np.array(names * count)
    flat = {column_header(k, unit_of_number(k)): v for k, v in found.table.items()}
    return columns | {header: values.ravel() for header, values in flat.items()}


def positions_report(choice: Choice, found: PositionSelection) -> Report:
    """Return the readable report: bearings that fit each position under the loads with
    the present ones, and the combinations in the whole system."""
    alone = [
        f"{name}: of {one.table['type'].size} bearings {len(one.fits)} fit; the"
        f" smallest: {one.smallest}"
        for name, one in found.alone.items()
    ]
    best = ", ".join(f"{k} {v}" for k, v in (found.best or {}).items())
    count, names = min(found.holds.size, _SHOWN), [*found.alone]
    rows = {k: v[:count].ravel().tolist() for k, v in found.table.items()}
    columns = [
        Column("combination", np.repeat(np.arange(count), len(names))),
        Column("position", names * count),
        Column("bearing", rows["designation"]),
    ]
    forces = [name for name in rows if name.endswith("_force")]
    for name in ("mass", *forces, "life_hours", "static_safety", "load_ratio"):
        given = np.array(rows[name]), unit_of_number(name), ".4g"
        columns.append(Column(name.replace("_", " "), *given))
    misses = zip(*(rows[name] for name in Miss._fields[:4]), strict=True)
    columns.append(Column("lacks", [Miss(*one).words or "nothing" for one in misses]))
    whole: list[Part] = [
        f"{found.holds.sum()} of {found.holds.size} combinations hold; the best:"
        f" {best or 'none'}",
        Grid(columns),
        f"structures of bearings compiled: {found.kinds}; friction and stiffness, where"
        " they are asked for, are those of the loads with the present bearings",
    ]
    return Report(
        {
            f"{choice.name}: loads with the present bearings": alone,
            "Whole system, with the new bearings": whole,
        }
    )

"""Comparison of the bearings of several scenes, sorted by relative difference."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..._version import __version__
from ...cases.output_labels import OPERATING_CLEARANCE
from ...cases.sweep import SUMMARIES
from ...cases.sweep_table import flatten_columns, kind
from ...element.frame import FREEDOMS
from ...files.table_file import in_shown_units
from ...life.life import LIFE_OUTPUTS
from ...numerics.labels import summaries
from ...numerics.result import Result
from ...numerics.units import shown_count
from ...report.html_report import flat
from ...report.report_model import Column, Grid, Part, Report
from ..bearing.read_scene import Scene
from ..bearing.solved import SolvedScene
from .report import ring_force, without_round_off
from .run import solve_scene

_FIELDS = "displacement", "force", "stiffness"
"""Compared, with the largest numbers of rolling elements, how many are loaded, and the
lives; of the stiffness only the diagonal."""

_ROUND_OFF = 1e-9
"""Relative difference below which numbers count as equal."""


_HEADERS = "result", "difference [1]"
"""Columns of the table beside those of the scenes."""

_SMALL = 1e-5
"""Size over the largest of its kind in all scenes below which it is left out [1]."""


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Comparison of solved scenes.

    Attributes:
        names: Names of the scenes; numbered if some are alike, or are that of another
            column of the table.
        solved: From `solve_scene`, converged or not.
        quantities: By header, "name [unit]": the value for each scene in SI (scene,),
            NaN where a scene does not have it or was not solved; sorted by decreasing
            difference. Values small relative to others of their kind, such as a
            displacement across the load, are left out.
    """

    names: list[str]
    solved: list[SolvedScene]
    quantities: dict[str, np.ndarray]


def run_compare(scenes: Sequence[Scene]) -> Comparison:
    """Solve scenes and compare their results.

    Args:
        scenes: Two or more, from `read_scene`.
    """
    solved = [solve_scene(scene) for scene in scenes]
    names = [scene.name for scene in scenes]
    if len({*names, *_HEADERS}) < len(names) + len(_HEADERS):
        names = [f"{name} ({k + 1})" for k, name in enumerate(names)]
    return Comparison(names, solved, _side_by_side([_numbers(one) for one in solved]))


def _side_by_side(found: list[dict[str, float]]) -> dict[str, np.ndarray]:
    """Return the values of each scene by header, sorted by difference."""
    headers = dict.fromkeys(header for numbers in found for header in numbers)
    rows = {h: np.array([n.get(h, np.nan) for n in found], float) for h in headers}
    size = {h: np.nan_to_num(np.abs(values)).max() for h, values in rows.items()}
    largest: dict[tuple[str, str], float] = {}
    for header in rows:
        largest[kind(header)] = max(largest.get(kind(header), 0.0), size[header])
    large = [h for h in rows if size[h] > _SMALL * largest[kind(h)]]
    order = sorted(large, key=lambda h: -np.nan_to_num(difference(rows[h])))
    return {header: rows[header] for header in order}


def difference(values: np.ndarray) -> float:
    """Return the range of the values over the larger magnitude [1].

    Args:
        values: One value per scene (scene,).

    Returns:
        Zero for round-off and for values that are all infinite; NaN if some, but not
        all, are missing or infinite.
    """
    if np.all(values == values[0]):
        return 0.0
    if not np.isfinite(values).all():
        return np.nan
    found = float(np.ptp(values) / np.abs(values).max())
    return found if found > _ROUND_OFF else 0.0


def _numbers(one: SolvedScene) -> dict[str, float]:
    """Return the compared numbers of a scene by header; empty if not solved."""
    scene, solution, life = one.scene, one.numbers, one.life
    if not one.converged:
        return {}
    numbers: dict[str, Any] = {name: getattr(solution, name) for name in _FIELDS}
    numbers["force"] = ring_force(solution)
    names = (*summaries(type(solution)), "n_loaded")
    numbers |= {name: SUMMARIES[name](solution) for name in names}
    if life is not None:
        numbers |= {name: getattr(life, name) for name in LIFE_OUTPUTS}
        del numbers["damage_share"]
    if (fits := scene.fit_states) is not None:
        numbers[OPERATING_CLEARANCE] = fits.operating.radial_clearance
    fixed, moving = f"_{scene.fixed_ring}_", f"_{scene.moving_ring}_"
    diagonal = {f"stiffness{moving}{name}{moving}{name}" for name in FREEDOMS}
    found = {}
    for name, value in numbers.items():
        if value is None:
            continue
        values = without_round_off(np.asarray(value))
        for header, column in flatten_columns(name, values[None]):
            full, _, _ = header.partition(" ")
            own = name != "stiffness" or full in diagonal
            if column is None or fixed in header or not own:
                continue
            found[header] = float(column[0])
    return found


def compare_report(found: Comparison, settings: Sequence[str] = ()) -> Report:
    """Return the readable report of a comparison.

    Args:
        found: From `run_compare`.
        settings: Changes that all scenes have in common.
    """
    rows = {h: values for h, values in found.quantities.items() if difference(values)}
    parts: list[Part] = []
    if rows:
        headers = [header.partition(" [") for header in rows]
        units = [unit.rstrip("]") for _, _, unit in headers]
        values = np.array([*rows.values()]).T
        apart = [difference(row) for row in rows.values()]
        columns = [
            Column("result", [name for name, _, _ in headers]),
            *map(Column, found.names, values, [units] * len(values)),
            Column("difference", apart, "1", ".3g", (100.0, "%")),
        ]
        parts.append(Grid(columns))
    same = len(found.quantities) - len(rows)
    be = "is" if same == 1 else "are"
    parts += [f"{shown_count(same, 'result')} {be} the same"] if same else []
    warned = [
        warning.about(name)
        for name, one in zip(found.names, found.solved, strict=True)
        for warning in one.warnings
    ]
    alike = [f"all scenes have by --set: {', '.join(settings)}"] if settings else []
    return Report({"Scenes": [*alike, _inputs(found)], "Results": parts}, warned)


def _inputs(found: Comparison) -> Part:
    """List the keys that differ between the scenes."""
    read = [dict(flat(one.scene.inputs)) for one in found.solved]
    keys = dict.fromkeys(key for scene in read for key in scene)
    apart = [key for key in keys if len({scene.get(key) for scene in read}) > 1]
    if not apart:
        return "the scenes are the same"
    columns = [[scene.get(key, "-") for key in apart] for scene in read]
    return Grid([Column("key", apart), *map(Column, found.names, columns)])


def compare_as_dict(found: Comparison) -> dict[str, Any]:
    """Return a comparison as plain numbers and lists, in SI.

    Returns:
        `scenes`, `result` and `warnings` of each; `quantities` by header,
        "name [unit]": a number per scene, null where it has none; `difference` by
        header, from `difference`; `inputs` of each, and version.
    """
    return {
        "scenes": found.names,
        "result": [Result(int(s.solution.result)).label for s in found.solved],
        "warnings": [one.warnings for one in found.solved],
        "quantities": {h: v.tolist() for h, v in found.quantities.items()},
        "difference": {h: difference(v) for h, v in found.quantities.items()},
        "inputs": [one.scene.inputs for one in found.solved],
        "version": __version__,
    }


def compare_columns(found: Comparison, si: bool = True) -> dict[str, np.ndarray]:
    """Return a comparison as columns by header, a row for each result.

    Args:
        found: From `run_compare`.
        si: Whether numbers are in SI, else in the units of the reports.
    """
    shown = found.quantities if si else in_shown_units(found.quantities)
    values = np.array([*shown.values()]).reshape(-1, len(found.names))
    result, apart = _HEADERS
    return {
        result: np.array([*shown], dtype=str),
        **{name: values[:, k] for k, name in enumerate(found.names)},
        apart: np.array([*map(difference, values)]),
    }

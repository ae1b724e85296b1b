"""Bearings of several scenes side by side, the largest differences first."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import jax
import numpy as np

from ..element.frame import FREEDOMS
from ..numerics.result import Result
from ..statics.life import LIFE_OUTPUTS, Life
from ..statics.solution import Solution
from ..statics.sweep import SUMMARIES
from ..statics.sweep_table import OPERATING_CLEARANCE, spread
from .bearing_run import run_scene, with_set_preload
from .fit_table import fit_facts
from .html_report import flat
from .life_report import scene_life, solved_warnings
from .read import Scene
from .report import without_round_off
from .report_model import Column, Grid, Part, Report
from .sweep_run import kind

_FIELDS = "displacement", "force", "stiffness"
_SUMMARIES = "largest_load", "peak_pressure", "n_loaded"
"""Compared beside the lives, of the moving ring; of the stiffness its diagonal."""

_ROUND_OFF = 1e-9
"""Difference over the larger number below which there is none."""


_SMALL = 1e-5
"""Size over the largest of its kind, in all scenes, below which nobody compares [1]."""


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Solved scenes side by side.

    Attributes:
        names: Of the scenes; those of one name are numbered.
        scenes: From `read_scene`, with the preloads of sets on their seats.
        solutions: Of each, converged or not, in NumPy.
        warnings: Of each, as `solve` gives them.
        quantities: By header, "name [unit]": the number of each scene in SI (scene,),
            NaN of what a scene does not have or of one that was not solved; the
            largest differences first. What is small beside others of its kind, such
            as a displacement across the load, is left out.
    """

    names: list[str]
    scenes: list[Scene]
    solutions: list[Solution]
    warnings: list[list[str]]
    quantities: dict[str, np.ndarray]


def run_compare(scenes: Sequence[Scene]) -> Comparison:
    """Solve scenes and set their results side by side.

    Args:
        scenes: Two or more, from `read_scene`.
    """
    solutions = [jax.device_get(run_scene(scene)) for scene in scenes]
    ready = [
        with_set_preload(scene) if solution.converged else scene
        for scene, solution in zip(scenes, solutions, strict=True)
    ]
    pairs = list(zip(ready, solutions, strict=True))
    lives = [
        scene_life(scene, solution) if scene.life and solution.converged else None
        for scene, solution in pairs
    ]
    found = [_numbers(*pair, life) for pair, life in zip(pairs, lives, strict=True)]
    told = [solved_warnings(*p, life) for p, life in zip(pairs, lives, strict=True)]
    names = [scene.name for scene in scenes]
    if len(set(names)) < len(names):
        names = [f"{name} ({k + 1})" for k, name in enumerate(names)]
    return Comparison(names, ready, solutions, told, _side_by_side(found))


def _side_by_side(found: list[dict[str, float]]) -> dict[str, np.ndarray]:
    """The numbers of each scene by header, in the order of their differences."""
    headers = dict.fromkeys(header for numbers in found for header in numbers)
    rows = {h: np.array([n.get(h, np.nan) for n in found], float) for h in headers}
    size = {h: np.nan_to_num(np.abs(values)).max() for h, values in rows.items()}
    largest: dict[tuple[str, str], float] = {}
    for header in rows:
        largest[kind(header)] = max(largest.get(kind(header), 0.0), size[header])
    told = [h for h in rows if size[h] > _SMALL * largest[kind(h)]]
    order = sorted(told, key=lambda h: -np.nan_to_num(difference(rows[h])))
    return {header: rows[header] for header in order}


def difference(values: np.ndarray) -> float:
    """Difference of the largest and the smallest number over the larger magnitude [1].

    Args:
        values: One of each scene (scene,).

    Returns:
        Zero for round-off and for numbers that are all infinite; NaN where one is
        missing or infinite alone.
    """
    if np.all(values == values[0]):
        return 0.0
    if not np.isfinite(values).all():
        return np.nan
    found = float(np.ptp(values) / np.abs(values).max())
    return found if found > _ROUND_OFF else 0.0


def _numbers(scene: Scene, solution: Solution, life: Life | None) -> dict[str, float]:
    """Numbers of a scene that are compared, by header; none of an unsolved one."""
    if not solution.converged:
        return {}
    told: dict[str, Any] = {name: getattr(solution, name) for name in _FIELDS}
    told |= {name: SUMMARIES[name](solution) for name in _SUMMARIES}
    if life is not None:
        told |= {name: getattr(life, name) for name in LIFE_OUTPUTS}
        del told["damage_share"]
    if scene.fits is not None:
        left = fit_facts(scene.fits, scene.element.bearing).operating
        told[OPERATING_CLEARANCE] = left.radial_clearance
    fixed, moving = f"_{scene.fixed_ring}_", f"_{scene.moving_ring}_"
    diagonal = {f"stiffness{moving}{name}{moving}{name}" for name in FREEDOMS}
    found = {}
    for name, value in told.items():
        if value is None:
            continue
        values = without_round_off(np.asarray(value))
        for header, column in spread(name, values[None]):
            full, _, _ = header.partition(" ")
            own = name != "stiffness" or full in diagonal
            if column is None or fixed in header or not own:
                continue
            found[header] = float(column[0])
    return found


def compare_report(found: Comparison) -> Report:
    """Readable report of scenes side by side.

    Args:
        found: From `run_compare`.
    """
    rows = {h: values for h, values in found.quantities.items() if difference(values)}
    told: list[Part] = []
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
        told.append(Grid(columns))
    same = len(found.quantities) - len(rows)
    told += [f"{same} results are the same"] if same else []
    warned = [
        f"{name}: {text}"
        for name, texts in zip(found.names, found.warnings, strict=True)
        for text in texts
    ]
    return Report({"Scenes": [_inputs(found)], "Results": told}, warned)


def _inputs(found: Comparison) -> Part:
    """Keys of the scenes that differ."""
    read = [dict(flat(scene.inputs)) for scene in found.scenes]
    keys = dict.fromkeys(key for scene in read for key in scene)
    apart = [key for key in keys if len({scene.get(key) for scene in read}) > 1]
    if not apart:
        return "the scenes are the same"
    columns = [[scene.get(key, "-") for key in apart] for scene in read]
    return Grid([Column("key", apart), *map(Column, found.names, columns)])


def compare_as_dict(found: Comparison) -> dict[str, Any]:
    """Scenes side by side as plain numbers and lists, in SI.

    Args:
        found: From `run_compare`.

    Returns:
        `scenes`, `result` and `warnings` of each; `quantities` by header,
        "name [unit]": a number of each scene, null of what one does not have;
        `difference` by header, as of `difference`; `inputs` of each, and version.
    """
    from .. import __version__

    return {
        "scenes": found.names,
        "result": [Result(int(s.result)).label for s in found.solutions],
        "warnings": found.warnings,
        "quantities": {h: v.tolist() for h, v in found.quantities.items()},
        "difference": {h: difference(v) for h, v in found.quantities.items()},
        "inputs": [scene.inputs for scene in found.scenes],
        "version": __version__,
    }


def compare_columns(found: Comparison) -> dict[str, np.ndarray]:
    """Scenes side by side as columns by header, a row for each result, in SI.

    Args:
        found: From `run_compare`.
    """
    values = np.array([*found.quantities.values()])
    return {
        "result": np.array([*found.quantities]),
        **{name: values[:, k] for k, name in enumerate(found.names)},
        "difference [1]": np.array([*map(difference, found.quantities.values())]),
    }

"""Bearings of several scenes side by side, the largest differences first."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jax
import numpy as np

from ..element.frame import FREEDOMS
from ..numerics.result import Result
from ..statics.life import LIFE_OUTPUTS
from ..statics.solution import Solution
from ..statics.sweep import SUMMARIES
from ..statics.sweep_table import OPERATING_CLEARANCE, spread
from ..statics.warning import warnings
from .bearing_run import run_scene
from .fit_table import fit_facts
from .html_report import flat
from .life_report import scene_life
from .read import Scene
from .report import without_round_off
from .report_model import Column, Grid, Part, Report

_FIELDS = "displacement", "force", "stiffness"
_SUMMARIES = "largest_load", "peak_pressure", "n_loaded"
"""Compared beside the lives, of the moving ring; of the stiffness its diagonal."""

_ROUND_OFF = 1e-9
"""Difference over the larger number below which there is none."""


@dataclasses.dataclass(frozen=True)
class Compared:
    """Solved scenes side by side.

    Attributes:
        names: Of the scenes; those of one name are numbered.
        scenes: From `read_scene`.
        solutions: Of each, converged or not, in NumPy.
        quantities: By header, "name [unit]": the number of each scene in SI (scene,),
            NaN of what a scene does not have or of one that was not solved; the
            largest differences first.
    """

    names: list[str]
    scenes: list[Scene]
    solutions: list[Solution]
    quantities: dict[str, np.ndarray]


def run_compare(scenes: Sequence[Scene], programs: Path | None = None) -> Compared:
    """Solve scenes and set their results side by side.

    Args:
        scenes: Two or more, from `read_scene`.
        programs: As of `run_scene`.
    """
    solutions = [jax.device_get(run_scene(scene, programs)) for scene in scenes]
    found = [_numbers(*pair) for pair in zip(scenes, solutions, strict=True)]
    headers = dict.fromkeys(header for numbers in found for header in numbers)
    rows = {h: np.array([n.get(h, np.nan) for n in found], float) for h in headers}
    told = [h for h, values in rows.items() if np.nan_to_num(values).any()]
    order = sorted(told, key=lambda h: -np.nan_to_num(difference(rows[h])))
    names = [scene.name for scene in scenes]
    if len(set(names)) < len(names):
        names = [f"{name} ({k + 1})" for k, name in enumerate(names)]
    return Compared(names, list(scenes), solutions, {h: rows[h] for h in order})


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


def _numbers(scene: Scene, solution: Solution) -> dict[str, float]:
    """What is compared of a scene, by header; nothing of one that was not solved."""
    if not solution.converged:
        return {}
    told: dict[str, Any] = {name: getattr(solution, name) for name in _FIELDS}
    told |= {name: SUMMARIES[name](solution) for name in _SUMMARIES}
    if scene.life is not None:
        life = scene_life(scene, solution)
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


def compare_report(found: Compared) -> Report:
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
        for name, scene, solution in zip(
            found.names, found.scenes, found.solutions, strict=True
        )
        for text in (
            *scene.warnings,
            *(warnings(solution) if solution.converged else ()),
        )
    ]
    return Report({"Scenes": [_inputs(found)], "Results": told}, warned)


def _inputs(found: Compared) -> Part:
    """Keys of the scenes that differ."""
    read = [dict(flat(scene.inputs)) for scene in found.scenes]
    keys = dict.fromkeys(key for scene in read for key in scene)
    apart = [key for key in keys if len({scene.get(key) for scene in read}) > 1]
    if not apart:
        return "the scenes are the same"
    columns = [[scene.get(key, "-") for key in apart] for scene in read]
    return Grid([Column("key", apart), *map(Column, found.names, columns)])


def compare_as_dict(found: Compared) -> dict[str, Any]:
    """Scenes side by side as plain numbers and lists, in SI.

    Args:
        found: From `run_compare`.

    Returns:
        `scenes`, `result` of each, `quantities` by header, "name [unit]": a number of
        each scene, null of what one does not have; `difference` by header, as of
        `difference`; `inputs` of each, and version.
    """
    from .. import __version__

    return {
        "scenes": found.names,
        "result": [Result(int(s.result)).label for s in found.solutions],
        "quantities": {h: v.tolist() for h, v in found.quantities.items()},
        "difference": {h: difference(v) for h, v in found.quantities.items()},
        "inputs": [scene.inputs for scene in found.scenes],
        "version": __version__,
    }


def compare_columns(found: Compared) -> dict[str, np.ndarray]:
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

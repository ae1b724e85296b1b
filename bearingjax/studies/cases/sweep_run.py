"""Solve the cases of a scene, and report them."""

import dataclasses
from collections.abc import Callable
from typing import Any

import jax
import numpy as np

from ...cases import Batches, Cases, Sweep, sweep
from ...cases.cases import case_speed
from ...cases.output_labels import OPERATING_CLEARANCE, OPERATING_PRELOAD
from ...cases.spectrum import relative_speed, revolutions_per_hour
from ...cases.sweep_program import not_run
from ...cases.sweep_table import columns
from ...design import rows_of
from ...element import BearingElement
from ...files.scene_errors import scene_errors
from ...fits import radial_clearance
from ...life.life import LIFE_OUTPUTS, LifeConditions
from ...numerics.compiled.programs import program
from ...numerics.labels import summaries
from ...numerics.types import with_fields
from ...numerics.units import display_unit, shown_count
from ...numerics.warning import Warning
from ...report.json_output import run_json
from ...report.report_model import Grid, Part, Report
from ...statics.preload import is_opposed, remaining_preload
from ...statics.service_warning import preload_range_warnings, preload_warnings
from ...statics.solution import solution_kind
from ...statics.support import Support
from ..bearing.credibility import credibility_section
from ..bearing.life_ratings import life_conditions
from ..solve.run import with_set_preload
from .designs import DesignGroup
from .read_cases import CaseTable


def default_outputs(
    element: BearingElement, life: LifeConditions | None, turning: bool
) -> tuple[str, ...]:
    """Return the outputs that are kept of each case unless the scene names some.

    Args:
        element: The bearing.
        life: Conditions of lives, if they are kept too.
        turning: Whether the rings have a relative speed.
    """
    lives = list(_LIVES if life is not None else ())
    if life is not None and life.viscosity is not None:
        lives += ["modified_rating_life", "viscosity_ratio", "a_iso"]
    lives += ["life_hours"] if lives and turning else []
    largest = summaries(solution_kind(element.choices))
    return "displacement", *largest, *lives, "n_loaded", "iterations", "residual"


_LIVES = (
    "equivalent_load",
    "static_safety",
    "basic_rating_life",
    "reference_rating_life",
    "damage",
)
"""Numbers of every life that are kept of each case."""


def run_cases(
    table: CaseTable, progress: bool = False, stop: Callable[[], bool] | None = None
) -> Sweep:
    """Solve the cases of a scene.

    Args:
        table: From `read_cases`.
        progress: Show a progress bar.
        stop: As in `sweep`.

    Returns:
        Sweep with a result code for each case; for a scene with [fit] also with the
        outputs `OPERATING_CLEARANCE` and, for a set, `OPERATING_PRELOAD`.

    Raises:
        SceneError: For outputs that do not exist or exceed the memory.
    """
    done: list[tuple[np.ndarray, Sweep]] = []
    for part in table.design_groups:
        mine = part.cases_of(table.cases)
        # A sweep polls after its first block; once stopped, no other sweep is started.
        stopped = bool(done) and stop is not None and stop()
        if mine.size and not stopped:
            done.append((mine, _run(table, part, mine, progress, stop)))
    if len(table.design_groups) == 1:
        return done[0][1]
    return _merge(table, done)


def _run(table, part, mine, progress, stop) -> Sweep:
    scene, cases = table.scene, table.cases
    if part.designs is not None:
        cases = jax.tree.map(lambda a: np.asarray(a)[mine], cases)
        number = np.searchsorted(part.designs, np.asarray(cases.design))
        cases = dataclasses.replace(cases, design=number)
    life = _life(table, part)
    with scene_errors(f"{scene.name}: [cases]"):
        solved = sweep(
            part.element,
            cases,
            outputs=default_outputs(
                part.element, life, revolutions_per_hour(cases, np) is not None
            )
            if table.outputs is None
            else table.outputs,
            support=Support(scene.free, fixed_ring=scene.fixed_ring),
            options=scene.solve_options,
            life=life,
            batches=Batches(progress=progress, stop=stop),
        )
    return _on_seats(part, solved)


def _life(table: CaseTable, part: DesignGroup) -> LifeConditions | None:
    """Return the conditions of lives that are output, or checked; otherwise `None`.

    Without speeds a life is checked as by `solve`, which then has no film.
    """
    if set(LIFE_OUTPUTS) & set(table.outputs or ()):
        return life_conditions(part.scene)
    if part.scene.life is None:
        return None
    return life_conditions(part.scene, turning=bool(relative_speed(table.cases).any()))


def _on_seats(part: DesignGroup, solved: Sweep) -> Sweep:
    """Add to the sweep of a structure the radial clearance in operation [m] and, for a
    set, the preload [N] of each case."""
    if part.scene.fits is None:
        return solved
    cases = solved.cases
    design = np.zeros(cases.count, int)
    if part.designs is not None:
        design = np.asarray(cases.design)
    row = rows_of(part.element.bearing)[0].bearing
    find = radial_clearance if part.designs is None else jax.vmap(radial_clearance)
    left = {OPERATING_CLEARANCE: np.atleast_1d(find(row))}
    if is_opposed(part.element.bearing):
        left[OPERATING_PRELOAD] = _preloads(part, cases)
    return dataclasses.replace(
        solved,
        outputs=solved.outputs
        | {k: np.where(solved.converged, v[design], np.nan) for k, v in left.items()},
    )


def cases_with_set_preload(table: CaseTable) -> CaseTable:
    """Apply `with_set_preload` to the cases of one design, including the range over
    the seat tolerances; cases of several designs are returned unchanged.
    """
    if table.cases.design is not None:
        return table
    scene = with_set_preload(table.scene)
    part = dataclasses.replace(table.design_groups[0], scene=scene)
    return dataclasses.replace(table, scene=scene, design_groups=(part,))


def _preloads(part: DesignGroup, cases: Cases) -> np.ndarray:
    """Return the preload force between the rows of each design, without load, at the
    speeds of its first case (design,) [N]; NaN of designs that no case has."""
    if part.scene.preload_of_set is not None:
        return np.array([part.scene.preload_of_set.operating])
    many = part.designs is not None
    design = np.asarray(cases.design) if many else np.zeros(1, int)
    found = np.full(design.max() + 1, np.nan)
    for k, case in zip(*np.unique(design, return_index=True), strict=True):
        element = jax.tree.map(lambda a: a[k], part.element) if many else part.element  # noqa: B023
        one = jax.tree.map(lambda a: np.asarray(a)[case], cases)  # noqa: B023
        found[k] = _preload(element, with_fields(one, design=None))
    return found


@program(quick=True, what="preload of a set on its seats")
def _preload(element, case):
    return remaining_preload(element, case_speed(case), throw=False)


def _merge(table: CaseTable, done: list[tuple[np.ndarray, Sweep]]) -> Sweep:
    """Merge the sweeps of the structures; cases without a sweep were not run."""
    outputs: dict[str, np.ndarray] = {}
    for mine, solved in done:
        for name, values in solved.outputs.items():
            if name not in outputs:
                shape = (table.cases.count, *values.shape[1:])
                nothing = not_run(name, values.dtype)
                outputs[name] = np.full(shape, nothing, values.dtype)
            outputs[name][mine] = values
    first = done[0][1]
    common = {
        name: tuple(n for n in names if all(n in dict(s.zeros)[name] for _, s in done))
        for name, names in first.zeros
    }
    ring = first.moving_ring
    return Sweep(table.cases, outputs, ring, tuple(common.items()))


def sweep_report(table: CaseTable, solved: Sweep, seconds: float) -> Report:
    """Report the counts of result codes, and the range of every output.

    Args:
        table: The cases of the scene.
        solved: The solved sweep.
        seconds: Run time [s].
    """
    counts = ", ".join(f"{n} {label}" for label, n in solved.counts().items())
    count = solved.cases.count
    parts: list[Part] = [
        f"{table.scene.name}: {shown_count(count, 'case')} over"
        f" {', '.join(table.varied)}",
        f"{counts}; {seconds:.3g} s, compiling included",
    ]
    if len(table.settings) > 1:
        kinds = len(table.design_groups)
        of = f" of {kinds} structures, solved one after the other"
        parts.append(f"{len(table.settings)} designs{of if kinds > 1 else ''}")
    if OPERATING_PRELOAD in solved.outputs and table.scene.preload_of_set is None:
        words = "at `fit.at` alone, not over the tolerances of the seats"
        parts.append(f"preload of the set in operation: {words} (`solve` tells those)")
    rows = []
    for header, pair in _spans(solved).items():
        name, _, unit = header.partition(" [")
        factor, shown = display_unit(unit.rstrip("]"))
        rows.append((name, *(factor * x for x in pair), shown))
    if rows:
        parts += ["", Grid.of_rows(("result", "least", "largest", "unit"), rows)]
    bearing = "", table.scene.element, table.cases.load
    sections = {"Cases": parts, "Credibility": credibility_section("solve", [bearing])}
    return Report(sections, all_warnings(table, solved))


def _spans(solved: Sweep) -> dict[str, tuple[float, float]]:
    """Return the range of each result over the solved cases, without those of zero."""
    spans = {}
    for header, column in columns(solved).items():
        values = np.asarray(column)
        if values.dtype.kind not in "fi" or header == "design":
            continue
        values = values[solved.converged & np.isfinite(values)]
        if values.any():
            spans[header] = values.min(), values.max()
    return spans


def all_warnings(table: CaseTable, solved: Sweep) -> list[Warning]:
    """Return the warnings of the scene, of the preload of its set and of its cases."""
    return [*table.warnings, *set_warnings(table, solved), *solved.warnings]


def set_warnings(table: CaseTable, solved: Sweep) -> list[Warning]:
    """Return warnings about the preload of a set in the cases."""
    if table.scene.preload_of_set is not None:
        return preload_warnings(table.scene.preload_of_set)
    preload = solved.outputs.get(OPERATING_PRELOAD)
    if preload is None or not np.isfinite(preload).any():
        return []
    ground = table.scene.preload_force
    if ground is None:
        return []
    ends = float(np.nanmin(preload)), float(np.nanmax(preload))
    return preload_range_warnings(ground, *ends)


def design_columns(table: CaseTable) -> dict[str, np.ndarray]:
    """Return the design settings of each case, by "key [unit]": numbers in SI, texts as
    written in the scene; without numbers that are zero in all cases."""
    if table.cases.design is None:
        return {}
    design = np.asarray(table.cases.design)
    found = {
        key: np.array([made.get(key) for made in table.settings])[design]
        for key in table.settings[0]
    }
    return {k: v for k, v in found.items() if v.dtype.kind not in "fi" or v.any()}


def add_hours(
    found: dict[str, np.ndarray], cases: Cases, conditions: LifeConditions | None
) -> dict[str, np.ndarray]:
    """Add the columns of a table that follow from its lives: each in hours beside the
    revolutions, and the verdict on the life that is required of each case.

    Args:
        found: From `columns`.
        cases: The cases.
        conditions: Conditions of the lives, if any.
    """
    turns = revolutions_per_hour(cases, np)
    made = {}
    for header, column in found.items():
        made[header] = column
        name = header.removesuffix("_life [rev]")
        if turns is not None and name != header:
            with np.errstate(divide="ignore"):
                made[f"{name}_life [h]"] = column / turns
    used, asked = found.get("damage [1/rev]"), None
    if conditions is not None and used is not None:
        asked = conditions.required_revolutions
        if conditions.required is not None and turns is not None:
            asked = float(conditions.required) * turns
    if asked is None or used is None:
        return made
    with np.errstate(divide="ignore"):
        factor = 1.0 / (used * np.asarray(asked))
    return made | {"life_factor": factor, "life_kept": factor >= 1.0 - 1e-9}


def sweep_as_dict(table: CaseTable, solved: Sweep) -> dict[str, Any]:
    """Return a sweep as plain lists by column, in SI; null where a case failed."""
    numbers = {
        "columns": columns(solved, design_columns(table), exact=True),
        "counts": solved.counts(),
    }
    return run_json(numbers, all_warnings(table, solved), table.inputs)

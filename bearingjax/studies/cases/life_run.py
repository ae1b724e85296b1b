"""Rating life under the cases of a scene, a load spectrum: computation and report."""

import dataclasses
import functools
import re
from typing import Any

import jax
import numpy as np

from ...cases.output_labels import OPERATING_CLEARANCE, OPERATING_PRELOAD
from ...cases.series import SERIES_OUTPUTS, SeriesLife, series_life
from ...cases.spectrum import SpectrumLife, revolutions_per_hour, spectrum_life
from ...cases.sweep import Sweep
from ...cases.sweep_table import columns
from ...design import rows_of
from ...design.published import with_published
from ...element import RINGS
from ...files.quantity import SceneError
from ...files.scene_errors import scene_errors
from ...files.table import Table
from ...life.life import LIFE_OUTPUTS, turns_against_load
from ...life.life_warning import minimum_load
from ...life.rating import Ratings, ratings
from ...life.reference_life import exponents_of
from ...life.required_life import NEEDED, RequiredLife, judge_life
from ...numerics import Result, Warning
from ...numerics.shown import Shown
from ...numerics.units import shown_count
from ...report.json_output import run_json
from ...report.report_model import CASES_SHOWN, NEWTONS, Column, Grid, Part, Report
from ..bearing.credibility import credibility_section
from ..bearing.life_ratings import life_conditions, rating_origins, why_not_published
from ..bearing.life_report import (
    describe_turning,
    life_number,
    lives_grid,
    over_required,
    ratings_as_dict,
    ratings_in_words,
    verdict_as_dict,
    verdict_in_words,
)
from ..bearing.solved import SolvedScene
from ..solve.report import design_sections
from .case_words import case_words, varied_settings
from .read_cases import CaseTable, cases_of_columns
from .sweep_run import add_hours, all_warnings, design_columns, run_cases

_YEAR = 8766.0
"""Hours of a year [h]."""

_LARGEST = "peak_pressure", "largest_load"
"""Outputs of which a record tells the largest."""

_OILED = "modified_rating_life", "viscosity_ratio", "contamination_factor", "a_iso"
"""Outputs that need a lubricant."""

LIVES = ("basic_rating_life", "reference_rating_life", "modified_rating_life")


@dataclasses.dataclass(frozen=True)
class LifeRun(Shown):
    """Life under the cases of a scene.

    Attributes:
        table: The cases of the scene.
        solved: The solved cases and their lives.
        lives: Life under all cases, by its name in `LIVES`.
        asked: Life at the requested reliability: modified, or without a lubricant the
            reference life times a1.
        ratings: Ratings of the bearing; for several designs those of the scene.
        verdict: Verdict on the required life; `None` without one.
        record: Use of the life in a record in time; `None` of other cases.
    """

    table: CaseTable = dataclasses.field(repr=False)
    solved: Sweep
    lives: dict[str, SpectrumLife]
    asked: SpectrumLife
    ratings: Ratings
    verdict: RequiredLife | None = None
    record: SeriesLife | None = None

    @property
    def converged(self) -> bool:
        """Whether all cases were solved; otherwise there is no life."""
        return bool(self.solved.converged.all())

    @property
    def failure_message(self) -> str:
        """The cases that were not solved, in words; empty if all were."""
        codes = np.asarray(self.solved.result)
        lost = np.flatnonzero(codes != Result.CONVERGED)
        if not lost.size:
            return ""
        first = Result(int(codes[lost[0]])).label
        many = f"{len(lost)} of {len(codes)} cases not solved"
        return f"{many} ({self.name_of(int(lost[0]))}: {first})"

    @functools.cached_property
    def warnings(self) -> list[Warning]:
        """Warnings of the scene, of its cases and of their lives."""
        found = all_warnings(self.table, self.solved)
        if (series := self.table.series) is None:
            return found
        for k, one in enumerate(found):  # cases of a record are called by a row
            words = re.sub(r"case (\d+)$", lambda m: self.name_of(int(m[1])), one)
            found[k] = dataclasses.replace(one, words=words)
        words = f"the record has gaps: {'; '.join(series.gaps)}"
        return found + ([Warning("gaps", words)] if series.gaps else [])

    def name_of(self, case: int) -> str:
        """Return what reports call a case; of a record the first row that has it."""
        series = self.table.series
        row = case if series is None else int(np.argmax(series.case == case))
        return self.table.row_name(row)

    @property
    def origins(self) -> dict[str, str]:
        """Origins of the given ratings, from `rating_origins`."""
        return rating_origins(self.table.scene, self.ratings)

    @property
    def asked_name(self) -> str:
        """Name of the life whose damage is reported, "modified" or "reference"."""
        return "modified" if "modified_rating_life" in self.lives else "reference"

    @property
    def clearance(self) -> np.ndarray | None:
        """Radial clearance of each case in operation [m]; `None` without [fit]."""
        return self.solved.outputs.get(OPERATING_CLEARANCE)

    @property
    def preload(self) -> np.ndarray | None:
        """Preload of each case [N]; `None` except for sets with [fit]."""
        return self.solved.outputs.get(OPERATING_PRELOAD)

    def words(self, case: int) -> list[str]:
        """Describe the settings that distinguish a case, such as "Fy -2.5 kN"."""
        return case_words(varied_settings(self.table), case)

    def least_safety(self) -> str:
        """Describe the least static safety of all cases and the case that has it."""
        safety = np.asarray(self.solved.static_safety)
        case, hours = int(np.argmin(safety)), self.table.cases.hours
        spent = hours is not None and float(hours[case]) == 0.0
        which = f"{self.name_of(case)}{', of 0 h' if spent else ''}"
        if self.record is not None:
            which = self.table.row_name(self.record.rows["static_safety"])
        return f"{life_number(safety[case])} ({which})"

    def worst_cases(self, most: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the up to `most` cases with the largest damage; all must be solved.

        Returns:
            Their indices, the worst first, and their shares in the damage.
        """
        share = np.asarray(self.asked.damage_share)
        order = np.argsort(-share, kind="stable")[:most]
        return order, share[order]


def run_life(table: CaseTable, progress: bool = False) -> LifeRun:
    """Solve the cases of a scene for their lives, and sum their damage.

    Args:
        table: From `read_cases`.
        progress: Show a progress bar.

    Raises:
        SceneError: For cases whose life cannot be computed.
    """
    scene = table.scene
    conditions = life_conditions(scene)
    turning = revolutions_per_hour(table.cases, np) is not None
    oiled = conditions.viscosity is not None
    if oiled and not turning:
        raise SceneError(
            f"{scene.name}: `life.contamination`: needs a speed, in [operating] or in"
            " the cases, for the film"
        )
    known = {
        "damage_share": False,
        "life_hours": turning,
        **dict.fromkeys(_OILED, oiled),
    }
    outputs = [name for name in LIFE_OUTPUTS if known.get(name, True)]
    required = None if scene.life is None else scene.life.required
    if required is not None and not turning:
        raise SceneError(
            f"{scene.name}: `life.required`: is in hours and needs a speed, in"
            " [operating] or in the cases; or write `required_revolutions`"
        )
    judged = scene.life is not None and scene.life.requires
    parts, cases = ["damage_share", "limit_ratio"], table.cases
    if table.series is not None:
        outputs += [name for name in SERIES_OUTPUTS if name not in outputs]
    elif judged and cases.design is cases.viscosity is cases.oscillation is None:
        outputs += parts
    bearing = scene.element.bearing
    taken = scene.catalogue
    if taken is not None and taken.override(table.varied).rerated_keys:
        bearing = with_published(bearing, None)
    names = "dynamic_capacity", "static_capacity", "fatigue_load_limit"
    given = (getattr(conditions, name) for name in names)
    with scene_errors(scene.name):
        rated = jax.device_get(ratings(bearing, *given))
    wanted = dataclasses.replace(table, outputs=tuple(outputs))
    solved = run_cases(wanted, progress)
    lives = {
        name: spectrum_life(table.cases, 1.0 / np.asarray(getattr(solved, name)))
        for name in LIVES
        if name in outputs
    }
    asked_for = spectrum_life(table.cases, np.asarray(solved.damage))
    record = None if table.series is None else series_life(table.series, solved)
    numbers = {k: v for k, v in solved.outputs.items() if k in NEEDED}
    kept = {k: v for k, v in solved.outputs.items() if k not in parts}
    solved = dataclasses.replace(solved, outputs=kept)
    turns, verdict = float(asked_for.rating_life), None
    factor = over_required(scene.life, asked_for.life_hours, turns)
    if factor is not None and scene.life is not None:
        basic = factor * float(lives["basic_rating_life"].rating_life) / turns
        found = bearing, scene.life, factor, basic, float(rated.dynamic_capacity)
        verdict = judge_life(*found, numbers, asked_for.damage_share)
    return LifeRun(table, solved, lives, asked_for, rated, verdict, record)


def spectrum_as_dict(run: LifeRun) -> dict[str, Any]:
    """Return the life under the cases as plain numbers and lists, in SI.

    Returns:
        Ratings as in `ratings_as_dict`, lives under all cases and the damage shares of
        the cases; `equivalent_load` is the constant load with the same basic life,
        `static_safety` the least of all cases. Columns of the cases, of a record in
        time its `record` instead; counts, warnings, inputs, version. Infinite is null;
        no lives if a case was not solved.
    """
    found = ratings_as_dict(run.ratings, run.origins)
    found["minimum_load"] = minimum_load(run.table.scene.element.bearing, run.ratings)
    if run.converged:
        for name, life in run.lives.items():
            found[name] = life.rating_life
        found.setdefault("modified_rating_life", None)
        found["equivalent_load"] = equivalent_load(run)
        found["static_safety"] = np.min(run.solved.static_safety)
        found["life_hours"] = run.asked.life_hours
        found |= verdict_as_dict(run.table.scene.life, run.verdict)
        if run.record is None or run.table.series is None:
            found["damage_share"] = run.asked.damage_share
        else:
            record = {k: v for k, v in vars(run.record).items() if k != "row_damage"}
            record |= {k: np.max(run.solved.outputs[k]) for k in _LARGEST}
            hours = run.table.series.hours.sum()
            found["record"] = {**record, "hours": hours, "gaps": run.table.series.gaps}
    if run.record is None:
        found["columns"] = life_columns(run, exact=True)
    found["counts"] = run.solved.counts()
    return run_json(found, run.warnings, run.table.inputs)


def life_columns(run: LifeRun, exact: bool = False) -> dict[str, np.ndarray]:
    """Return the cases and their lives as columns by header, in SI.

    Args:
        run: From `run_life`.
        exact: Whether to keep round-off and leave out lives in hours (`add_hours`).
    """
    found = columns(run.solved, design_columns(run.table), exact=exact)
    return found if exact else add_hours(found, run.solved.cases, run.table.scene.life)


def life_row(found: SolvedScene) -> dict[str, np.ndarray]:
    """Return load, speeds, life and verdict of a solved scene as one row, in SI."""
    scene, life = found.scene, found.life
    cases = cases_of_columns(Table({}, scene.name), scene, (), None, 1)
    lives = {name: getattr(life, name) for name in LIFE_OUTPUTS}
    outputs = {k: np.asarray(v)[None] for k, v in lives.items() if v is not None}
    del outputs["damage_share"]
    outputs["result"] = np.asarray(found.numbers.result)[None]
    one = columns(Sweep(cases, outputs, scene.moving_ring))
    return add_hours(one, cases, scene.life)


def equivalent_load(run: LifeRun) -> float:
    """Return the constant equivalent load with the basic life of the cases [N].

    Args:
        run: Run with all cases solved.
    """
    row = rows_of(run.table.scene.element.bearing)[0].bearing
    over, under = exponents_of(row).basic
    power = over / under
    life = float(run.lives["basic_rating_life"].rating_life) / 1e6
    return float(run.ratings.dynamic_capacity) * life ** (-1.0 / power)


def spectrum_report(run: LifeRun) -> Report:
    """Return the readable report of the life under cases that are all solved."""
    return Report({"Rating life": _lives(run)}, run.warnings)


def spectrum_page(run: LifeRun) -> Report:
    """Return the report of the life under solved cases, the bearing and its fits."""
    report = spectrum_report(run)
    sections = {**report.sections, **design_sections(run.table.scene)}
    fits = "Fits and clearance"
    if run.clearance is not None:
        sections[fits] = [
            "These are the fits as [operating], [fit] and [temperature] of the scene"
            f" have them; over the cases {_on_seats(run)}.",
            *sections[fits],
        ]
    bearing = "", run.table.scene.element, run.table.cases.load
    sections["Credibility"] = credibility_section("life", [bearing])
    return Report(sections, report.warnings)


def _lives(run) -> list[Part]:
    table = run.table
    rated = ratings_in_words(run.ratings, run.origins)
    lives = {name.removesuffix("_rating_life"): x for name, x in run.lives.items()}
    a1 = float(run.asked.rating_life) / float(lives["reference"].rating_life)
    if "modified" not in lives and a1 < 0.999999:
        lives[f"reference, a1 {a1:.4g}"] = run.asked
    revolutions, hours = (
        {name: getattr(life, what) for name, life in lives.items()}
        for what in ("rating_life", "life_hours")
    )
    at_rest = run.asked.life_hours is None
    parts: list[Part] = [
        f"{table.scene.name}: life under {shown_count(table.cases.count, 'case')} over"
        f" {', '.join(table.varied)}",
        rated["C"],
        rated["C0"],
        rated["Y"],
        *why_not_published(table.scene, table.varied),
        "",
        lives_grid(revolutions, None if at_rest else hours),
        f"equivalent load of the spectrum {1e-3 * equivalent_load(run):.5g} kN; least"
        f" static safety {run.least_safety()}; minimum load"
        f" {minimum_load(table.scene.element.bearing, run.ratings):.4g} N",
        *verdict_in_words(table.scene.life, run.verdict),
    ]
    if at_rest:
        fixed_to = life_conditions(table.scene).load_fixed_to
        parts.append(describe_turning(turns_against_load(None, fixed_to), True))
    parts += [] if run.clearance is None else [f"over the cases {_on_seats(run)}"]
    parts += _record_in_words(run)
    return [*parts, *_by_case(run)]


def _record_in_words(run) -> list[Part]:
    """Tell the use of the life in a record, and its extremes; empty without one."""
    record, series = run.record, run.table.series
    if record is None:
        return []
    hours = series.hours.sum()
    rows = {name: run.table.row_name(k) for name, k in record.rows.items()}
    most = [np.max(run.solved.outputs[k]) for k in _LARGEST]
    used = f"; 1 after {record.life_hours / _YEAR:.4g} a of the same; most of it in an"
    used = (
        f"{used} hour in {rows['damage']}" if record.damage else ", as no row has any"
    )
    alone = zip(RINGS, record.raceway_damage.T, strict=True)
    parts = [f"{ring} {' and '.join(f'{x:.4g}' for x in of)}" for ring, of in alone]
    found: list[Part] = [
        "",
        f"record of {shown_count(series.case.size, 'row')}, {hours:.6g} h"
        f" ({hours / _YEAR:.4g} a) that count: damage {record.damage:.4g}{used}",
        f"damage of each raceway by itself: {', '.join(parts)}; the standard rates"
        " rolling elements with them",
        f"largest contact pressure {1e-6 * most[0]:.5g} MPa in {rows['peak_pressure']},"
        f" largest load of a rolling element {most[1]:.5g} N in {rows['largest_load']}",
    ]
    if np.any(run.table.cases.oscillation):
        words = "oscillations count by their way, 2π rad a revolution, with the film of"
        found.append(f"{words} their mean speed, of which ISO 281 says nothing")
    return found


def _on_seats(run) -> str:
    """Format the ranges of radial clearance and preload of the cases in operation."""
    text = f"the operating radial clearance is {_ends(1e6 * run.clearance)} µm"
    if run.preload is None:
        return text
    text += f", the preload of the set, unloaded, {_ends(run.preload)} N"
    ground = run.table.scene.preload_force
    return text if ground is None else f"{text} (ground to {ground:.4g} N)"


def _ends(values: np.ndarray) -> str:
    ends = (f"{end(values):.4g}" for end in (np.min, np.max))
    return " to ".join(dict.fromkeys(ends))


def _by_case(run) -> list[Part]:
    """Tabulate the worst cases, each as if it acted alone, and their distinguishing
    settings."""
    order, shares = run.worst_cases(CASES_SHOWN)
    solved, hours = run.solved, run.table.cases.hours
    spent = [None] * len(order) if hours is None else np.asarray(hours)[order]
    words = [run.name_of(int(k)).split() for k in order]
    heading, names = words[0][0], [int(number) for _, number in words]
    columns = [
        Column(heading, names),
        Column("hours", spent),
        Column("P", np.asarray(solved.equivalent_load)[order], "N", ".4g"),
    ]
    if run.clearance is not None:
        columns.append(Column("clearance", run.clearance[order], "m", ".4g"))
    if run.preload is not None:
        columns.append(Column("preload", run.preload[order], "N", ".4g", NEWTONS))
    for name in run.lives:
        word, values = name.removesuffix("_rating_life"), getattr(solved, name)
        columns.append(Column(word, np.asarray(values)[order], "rev"))
    name = f"damage ({run.asked_name})"
    columns.append(Column(name, shares, "1", ".4g", (100.0, "%")))
    parts: list[Part] = ["", Grid(columns, "each case alone")]
    more = run.table.cases.count - len(order)
    if more:
        parts.append(f"and {more} more, {100 * (1 - shares.sum()):.3g} %")
    found = varied_settings(run.table)
    if found:
        # Non-breaking spaces keep a setting in one line.
        apart = [
            ", ".join(w.replace(" ", "\xa0") for w in case_words(found, int(k)))
            for k in order
        ]
        parts += ["", Grid([Column(heading, names), Column("what differs", apart)])]
    return parts

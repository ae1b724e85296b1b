"""Run the identification of a scene, and report its estimates."""

from typing import Any

import numpy as np

from ...decide.identify import Identified, identify
from ...files.scene_errors import scene_errors
from ...numerics.labels import column_header
from ...numerics.units import shown_change, shown_count, shown_number
from ...report.json_output import run_json
from ...report.report_model import Column, Grid, Report
from ..bearing.credibility import credibility_section
from ..bearing.read_scene import Scene
from .read_identify import Identification

_MOST, _LONGEST = 5, 40
"""Largest numbers of residuals and further readings, and of predictions, shown."""


def run_identification(task: Identification) -> Identified:
    """Estimate the unknowns of a scene, as read by `read_identification`.

    Raises:
        SolveError: If a measured case does not solve at the start.
        SceneError: For readings too few for the unknowns, or that depend on none.
    """
    subject = task.subject
    with scene_errors(f"{subject.scene.name}: [identify]"):
        return identify(
            subject.model,
            subject.cases,
            task.unknowns,
            task.readings,
            task.errors,
            wanted=task.wanted,
            candidates=task.candidates,
            known_errors=task.errors_known,
        )


def identification_report(task: Identification, found: Identified) -> Report:
    """Return the readable report of a converged identification."""
    read, subject = found.residual.items(), task.subject
    rows = [(n, k) for n, v in read for k in np.flatnonzero(np.isfinite(v)).tolist()]
    head = (
        f"{subject.scene.name}: {shown_count(len(found.names), 'number')} from"
        f" {shown_count(len(rows), 'reading')} in"
        f" {shown_count(subject.cases.count, 'case')}; {found.message}"
    )
    told = list(found.untold) or ["the readings tell every unknown"]
    missed, error, value = found.residual, found.error, found.prediction
    rows.sort(key=lambda at: -abs(missed[at[0]] / error[at[0]])[at[1]])
    pairs = [(n, k, task.units[n]) for n, k in rows[:_MOST]]
    largest = [
        (n, k, shown_change(missed[n][k], unit), shown_change(error[n][k], unit))
        for n, k, unit in pairs
    ]
    heads = "largest residuals", "case", "measured less predicted", "error"
    names = [Column("", found.names), *map(Column, found.names, found.correlation.T)]
    sections: dict[str, Any] = {
        "Estimates": [head, "", _estimates(task, found)],
        "Correlations": [Grid(names)],
        "What the readings tell": told,
        "Fit": [_fit_words(found), "", Grid.of_rows(heads, largest)],
    }
    wanted = [name for name in task.wanted if name not in found.names]
    if wanted:
        off = found.prediction_error
        rows = [
            (n, k, shown_number(x, task.units[n]), shown_change(d, task.units[n]))
            for n in wanted
            for k, (x, d) in enumerate(zip(value[n], off[n], strict=True))
        ]
        heads = "prediction", "case", "value", "standard error"
        sections["Predictions"] = [Grid.of_rows(heads, rows[:_LONGEST])]
    of = ", ".join(task.wanted) or "all unknowns, on average"
    best = [(n, k, f"{100 * drop:.3g} %") for n, k, drop in found.candidates[:_MOST]]
    sections["Further readings"] = [
        f"share of the variance of {of} that one more reading would take away",
        Grid.of_rows(("reading", "case", "share"), best),
    ]
    alone = isinstance(subject.scene, Scene)
    bearings = [("", subject.scene.element, subject.cases.load)] if alone else []
    sections["Credibility"] = credibility_section(subject.study, bearings)
    return Report(sections, [*subject.scene.warnings, *found.warnings])


def _estimates(task: Identification, found: Identified) -> Grid:
    rows = []
    given = found.names, found.estimate, found.standard_error, found.interval
    for name, value, error, ends in zip(*given, strict=True):
        unit = task.units[name]
        shown, low, high = (shown_number(x, unit, 5) for x in (value, *ends))
        rows.append((name, shown, shown_change(error, unit), low, high))
    heads = "unknown", "estimate", "standard error", "95 % from", "to"
    return Grid.of_rows(heads, rows)


def _fit_words(found: Identified) -> str:
    words = f"chi-square {found.chi_square:.4g} with"
    words += f" {shown_count(found.degrees_of_freedom, 'degree')} of freedom"
    if np.isfinite(found.probability):
        return (
            f"{words}: so large by chance in {100 * found.probability:.3g} % of cases"
        )
    if found.error_scale != 1.0:
        words += f"; the errors are {found.error_scale:.3g} times the stated ones"
    return words


def identification_as_dict(task: Identification, found: Identified) -> dict[str, Any]:
    """Return the results as plain numbers and lists, in SI."""
    numbers = {name: getattr(found, name) for name in _IN_JSON.split()}
    for name in ("estimate", "standard_error", "interval"):
        numbers[name] = dict(zip(found.names, numbers[name].tolist(), strict=True))
    numbers["candidates"] = [one._asdict() for one in found.candidates]
    warned = [*task.subject.scene.warnings, *found.warnings]
    return run_json(numbers, warned, task.inputs)


_IN_JSON = """result message estimate standard_error interval correlation identifiable
untold singular_values residual error prediction prediction_error chi_square
degrees_of_freedom probability error_scale nonlinearity"""


def identification_columns(task: Identification, found: Identified) -> dict[str, Any]:
    """Return the table with a row for each case: conditions, measured and predicted
    values, residuals and errors, without priors."""
    columns: dict[str, Any] = dict(task.subject.columns)
    for name, values in found.prediction.items():
        parts = {".predicted": values, ".predicted_error": found.prediction_error[name]}
        if name in found.residual:
            parts = {"": task.readings[name], **parts}
            parts |= {".residual": found.residual[name], ".error": found.error[name]}
        if name not in found.names:
            unit = task.units[name]
            columns |= {column_header(name + k, unit): v for k, v in parts.items()}
    return columns

"""Resume an interrupted sweep: solve the cases missing from its table."""

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path

import jax
import numpy as np

from ...cases.sweep import Sweep
from ...cases.sweep_program import WARNED
from ...cases.sweep_table import NOTHING, case_columns, left_out, read, restore_outputs
from ...files.quantity import SceneError
from ...numerics.result import Result
from .read_cases import CaseTable
from .sweep_run import design_columns, run_cases

CHECKED = 64
"""Cases solved again to check that a table belongs to the scene."""

_CURE = "name the table of this scene, or begin anew without --resume"

_SAME = 1e-4
"""Change relative to the largest number of an output that counts as none."""


def resume_cases(
    table: CaseTable,
    path: str | Path,
    progress: bool = False,
    stop: Callable[[], bool] | None = None,
) -> Sweep:
    """Solve the cases of a scene that are missing from its table (`NOT_RUN`).

    Some cases of the table are solved again first, to detect changes that the table
    does not show, such as another bearing.

    Args:
        table: From `read_cases`.
        path: Table of an interrupted sweep of this scene.
        progress, stop: As in `run_cases`.

    Returns:
        Sweep of all cases.

    Raises:
        SceneError: If the table cannot be read or is of other cases, or if its cases
            now give other results.
    """
    designs = design_columns(table)
    try:
        known = read(path, [k for k, v in designs.items() if v.dtype.kind == "U"])
    except (OSError, ValueError) as error:
        first = str(error).partition("\n")[0]
        raise SceneError(f"{path}: cannot be read as a table: {first}") from error
    check_asked(
        path, known, {**designs, **case_columns(table.cases)}, table.cases.count
    )
    codes = np.asarray(known["result"])
    ran = np.flatnonzero(codes != Result.NOT_RUN.label)
    rest = np.flatnonzero(codes == Result.NOT_RUN.label)
    solved = np.flatnonzero(codes == Result.CONVERGED.label)
    if ran.size == 0:
        return run_cases(table, progress, stop)
    again = (solved if solved.size else ran)[-CHECKED:]
    checked = run_cases(_part(table, again))
    whole = Sweep(table.cases, {}, checked.moving_ring, checked.zeros)
    try:
        outputs = restore_outputs(known, checked.outputs, left_out(whole))
    except ValueError as error:
        raise SceneError(f"{path}: {error}; {_CURE}") from error
    _check_same(path, checked.outputs, {k: v[again] for k, v in outputs.items()})
    if rest.size:
        new = run_cases(_part(table, rest), progress, stop)
        for name, values in new.outputs.items():
            outputs[name][rest] = values
    return Sweep(table.cases, outputs, checked.moving_ring, checked.zeros)


def _part(table: CaseTable, rows: np.ndarray) -> CaseTable:
    cases = jax.tree.map(lambda a: np.asarray(a)[rows], table.cases)
    return dataclasses.replace(table, cases=cases)


def check_asked(
    path: str | Path,
    known: Mapping[str, np.ndarray],
    wanted: Mapping[str, np.ndarray],
    count: int,
) -> None:
    """Raise unless a table holds the cases of a scene.

    Args:
        path: Path of the table, for the message.
        known: Columns of the table.
        wanted: Columns of the inputs of the scene.
        count: Number of cases of the scene.

    Raises:
        SceneError: If a column is missing, or a case differs.
    """
    for header in ("result", *wanted):
        if header not in known:
            problem = f"has no column {header!r}, which this scene makes"
            raise SceneError(f"{path}: {problem}; {_CURE}")
    rows = len(known["result"])
    if rows != count:
        problem = f"has {rows} cases, this scene {count}"
        raise SceneError(f"{path}: {problem}; {_CURE}")
    for header, column in wanted.items():
        column, there = np.asarray(column), known[header]
        if column.dtype.kind in "fi":
            there = np.asarray(there, dtype=float)
            same = np.isclose(there, column, rtol=1e-12, atol=0.0, equal_nan=True)
        else:
            same = there == column
        if not same.all():
            k = int(np.argmin(same))
            problem = f"{header} of case {k} is {there[k]}, in this scene {column[k]}"
            raise SceneError(f"{path}: {problem}; {_CURE}")


def _check_same(path, new: Mapping[str, np.ndarray], old: Mapping[str, np.ndarray]):
    """Raise unless most of the cases solved again give the same results."""
    same = new["result"] == old["result"]
    for name, values in new.items():
        if values.dtype.kind != "f" or name == "residual" or name.startswith(WARNED):
            continue
        flat = (len(values), -1)
        a, b = (np.nan_to_num(v).reshape(flat) for v in (values, old[name]))
        largest = np.abs(a).max(axis=1, initial=0.0)
        miss = np.abs(a - b).max(axis=1, initial=0.0)
        same = same & (miss <= _SAME * largest + NOTHING)
    if same.mean() < 0.5:
        problem = (
            f"{len(same)} of its cases, solved again, end otherwise: of another bearing"
            " or other numerics"
        )
        raise SceneError(f"{path}: {problem}; {_CURE}")

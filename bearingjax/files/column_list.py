"""A list of cases: a CSV file with keys and units in its header."""

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .quantity import QUANTITIES, SceneError, to_si
from .table import Table, as_written
from .text_file import read_columns

MOST_CASES = 10**7
"""Most cases of a scene: 1 kB of memory each, with the default outputs."""


def read_list(
    table: Table, folder: Path, kinds: Mapping[str, str], what: str = "cases"
) -> dict[str, Any]:
    """Read the columns of a list of cases.

    Args:
        table: `[cases]`, or another table with the name of a `file`.
        folder: Folder of the scene.
        kinds: Quantity kinds of keys whose columns are converted to SI; other columns
            are settings as written in a scene.
        what: Name of the rows in error messages.

    Returns:
        Values by key, in order.

    Raises:
        SceneError: One line that names file, line, column and fault.
    """
    name, given = table.text("file"), table.raw("file")
    if name is None:
        raise table.error("file", f"{given!r} is not the name of a file")
    rows = _rows(table, name, folder / name, what)
    (_, header), *cells = rows
    lines = [line for line, _ in cells]
    columns = zip(*(row for _, row in cells), strict=True)
    found: dict[str, Any] = {}
    for title, values in zip(header, columns, strict=True):
        key, unit = split_title(table, name, title)
        if key in found:
            raise table.error("file", f"{name}: names a column twice, {key}")
        kind = kinds.get(key)
        found[key] = _cells(table, name, key, kind, unit, values, lines)
    return found


def split_title(table: Table, name: str, title: str) -> tuple[str, str | None]:
    """Split a column title into key and unit."""
    match = re.fullmatch(r"\s*([\w.]+)\s*(?:\[([^\[\]]*)\])?\s*", title)
    if match is not None:
        return match[1], match[2]
    problem = f'{name}: {title!r} is no header such as "operating.load.Fy [kN]"'
    raise table.error("file", problem)


def _rows(table, name, path, what) -> list[tuple[int, list[str]]]:
    """Read the non-empty lines of a list, each with its line number."""
    try:
        rows = read_columns(path)
    except ValueError as error:
        raise table.error("file", f"{name}: {error}") from error
    if len(rows) < 2:
        raise table.error(
            "file", f"{name}: has no {what}; a header and rows are wanted"
        )
    if len(rows) > MOST_CASES:
        raise table.error(
            "file", f"{name}: has {len(rows)} {what}; at most {MOST_CASES}"
        )
    wanted = len(rows[0][1])
    for line, row in rows:
        if len(row) != wanted:
            problem = f"{name}: line {line} has {len(row)} values, not {wanted}"
            raise table.error("file", problem)
    return rows


def _cells(table, name, key, kind, unit, values, lines):
    """Convert the cells of a column: SI numbers of a kind, or design settings."""
    if kind is not None:
        factor, zero = unit_of_column(table, name, key, kind, unit)
        return np.array(_numbers(table, name, key, values, lines)) * factor + zero
    empty = [line for line, value in zip(lines, values, strict=True) if not value]
    if empty:
        raise table.error("file", f"{name}: line {empty[0]}: {key} is empty")
    if unit is not None:
        return [f"{value.strip()} {unit}" for value in values]
    return [_parse_value(value.strip()) for value in values]


def unit_of_column(
    table: Table, name: str, key: str, kind: str, unit: str | None
) -> tuple[float, float]:
    """Return factor and zero by which the numbers of a column become SI.

    Args:
        table: Table that names the file.
        name: The file.
        key: Key of the column.
        kind: Kind of its quantity.
        unit: Unit in its header, if it has one.

    Raises:
        SceneError: For no unit, or one of another kind.
    """
    if unit is None:
        example = f"{key} [{QUANTITIES[kind][1]}]"
        problem = f'{name}: {key} has no unit; head the column "{example}"'
        raise table.error("file", problem)
    try:
        zero = to_si(f"0 {unit}", kind)
        return to_si(f"1 {unit}", kind) - zero, zero
    except SceneError as error:
        problem = f"{name}: the unit of {key}: {error}"
        raise table.error("file", problem) from error


def _numbers(table, name, key, values, lines) -> list[float]:
    numbers = []
    for line, value in zip(lines, values, strict=True):
        try:
            number = float(value.replace("−", "-"))
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            problem = f"{name}: line {line}: {key}: {value!r} is not a finite number"
            if "," in value:
                problem += "; write a decimal point"
            raise table.error("file", problem)
        numbers.append(number)
    return numbers


def _parse_value(text):
    for kind in (int, float):
        try:
            return as_written(kind(text), text)
        except ValueError:
            pass
    return text

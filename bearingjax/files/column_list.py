"""A list of cases: a table, CSV or Parquet, with keys and units in its header."""

import contextlib
import math
import re
import warnings
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .quantity import QUANTITIES, SceneError, to_si
from .table import Table, as_written
from .table_file import read_table
from .text_file import read_columns

MOST_CASES = 10**7
"""Most cases of a scene: 1 kB of memory each, with the default outputs."""


def read_list(
    table: Table,
    folder: Path,
    kinds: Mapping[str, str],
    what: str = "cases",
    record: bool = False,
    blank: Collection[str] = (),
) -> dict[str, Any]:
    """Read the columns of a list of cases.

    Args:
        table: `[cases]`, or another table with the name of a `file`.
        folder: Folder of the scene.
        kinds: Quantity kinds of keys whose columns are converted to SI; other columns
            are settings as written in a scene. An empty kind is that of pure numbers.
        what: Name of the rows in error messages.
        record: Whether a column `time`, in a unit or of instants (ISO 8601), makes it a
            record: cells that are no numbers are NaN then, instants seconds since the
            first, and `line` has the lines of the rows.
        blank: Keys whose empty cells are NaN.

    Returns:
        Values by key, in order.

    Raises:
        SceneError: One line that names file, line, column and fault.
    """
    name, given = table.text("file"), table.raw("file")
    if name is None:
        raise table.error("file", f"{given!r} is not the name of a file")
    found: dict[str, Any] = {}
    try:
        header, columns, lines = _columns(folder / name, what, record)
        heads = [_head(title) for title in header]
        timed = record and any(key == "time" for key, _ in heads)
        for (key, unit), values in zip(heads, columns, strict=True):
            if key in found:
                raise ValueError(f"names a column twice, {key}")
            kind = "time" if timed and key == "time" else kinds.get(key)
            if timed and key == "time" and unit is None:
                found[key] = _seconds(values, lines)
            elif kind is None:
                found[key] = _settings(key, unit, values, lines)
            else:
                numbers = _numbers(key, values, lines, timed, key in blank)
                found[key] = _in_si(key, kind, unit, numbers)
    except (ValueError, ImportError, OSError) as error:
        raise table.error("file", f"{name}: {error}") from error
    return found | ({"line": lines} if timed else {})


def _head(title) -> tuple[str, str | None]:
    """Split a column title into key and unit."""
    match = re.fullmatch(r"\s*([\w.]+)\s*(?:\[([^\[\]]*)\])?\s*", title)
    if match is None:
        problem = 'is no header such as "operating.load.Fy [kN]"'
        raise ValueError(f"{title!r} {problem}")
    return match[1], match[2]


def _columns(path, what, record) -> tuple[Any, Any, Any]:
    """Read titles, columns of cells, and the line of each row."""
    if record and path.suffix.lower() == ".parquet":
        found = read_table(path)
        count = len(next(iter(found.values()), ()))
        return list(found), list(found.values()), np.arange(1, count + 1)
    rows = read_columns(path)
    if len(rows) < 2:
        raise ValueError(f"has no {what}; a header and rows are wanted")
    if len(rows) > MOST_CASES:
        raise ValueError(f"has {len(rows)} {what}; at most {MOST_CASES}")
    wanted = len(rows[0][1])
    for line, row in rows:
        if len(row) != wanted:
            raise ValueError(f"line {line} has {len(row)} values, not {wanted}")
    (_, header), *cells = rows
    columns = zip(*(row for _, row in cells), strict=True)
    return header, list(columns), np.array([line for line, _ in cells])


def _seconds(values, lines) -> np.ndarray:
    """Seconds of instants since the first, NaN of cells that are none."""
    found = np.full(len(values), "nat", "datetime64[us]")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of offsets, which count
        for k, value in enumerate(values):
            text = str(value).strip()
            if math.isfinite(_number(text)):  # NumPy would take it for a year
                cure = 'without a unit; head the column "time [s]", or write instants'
                raise ValueError(f"line {lines[k]}: time is {text!r}, {cure}")
            with contextlib.suppress(ValueError):
                found[k] = np.datetime64(text, "us")
    known = found[~np.isnat(found)]
    return (found - (known[0] if known.size else found)) / np.timedelta64(1, "s")


def _in_si(key, kind, unit, numbers) -> np.ndarray:
    """Convert a column of numbers to SI."""
    if kind == "" and unit is not None:
        raise ValueError(f"{key} is a pure number; it has no unit, [{unit}]")
    if kind == "":
        return numbers
    if unit is None:
        example = f"{key} [{QUANTITIES[kind][1]}]"
        raise ValueError(f'{key} has no unit; head the column "{example}"')
    try:
        one, zero = (to_si(f"{k} {unit}", kind) for k in (1, 0))
    except SceneError as error:
        raise ValueError(f"the unit of {key}: {error}") from error
    return numbers * (one - zero) + zero


def _settings(key, unit, values, lines) -> list[Any]:
    """Return the cells of a column as they would stand in a scene."""
    values = [str(value).strip() for value in values]
    if "" in values:
        raise ValueError(f"line {lines[values.index('')]}: {key} is empty")
    if unit is not None:
        return [f"{value} {unit}" for value in values]
    return [_parse_value(value) for value in values]


def _numbers(key, values, lines, timed, blank) -> np.ndarray:
    """Return the cells of a column as numbers; NaN where they may be none."""
    if isinstance(values, np.ndarray) and values.dtype.kind in "fi":
        return values.astype(float)
    try:
        numbers = np.array(values).astype(float)
    except ValueError:
        numbers = np.array([_number(str(value)) for value in values])
    for k in [] if timed else np.flatnonzero(~np.isfinite(numbers)):
        if values[k].strip() or not blank:
            cure = "; write a decimal point" if "," in values[k] else ""
            problem = f"{key}: {values[k]!r} is not a finite number{cure}"
            raise ValueError(f"line {lines[k]}: {problem}")
    return numbers


def _number(text):
    try:
        return float(text.replace("−", "-"))
    except ValueError:
        return math.nan


def _parse_value(text):
    for kind in (int, float):
        try:
            return as_written(kind(text), text)
        except ValueError:
            pass
    return text

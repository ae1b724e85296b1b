"""A list of cases: a table, CSV or Parquet, with keys and units in its header."""

import io
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
from .text_file import read_columns, read_text

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
    header, columns, lines = _columns(table, name, folder / name, what, record)
    found: dict[str, Any] = {}
    heads = [_head(table, name, title) for title in header]
    timed = record and any(key == "time" for key, _ in heads)
    for (key, unit), values in zip(heads, columns, strict=True):
        if key in found:
            raise table.error("file", f"{name}: names a column twice, {key}")
        kind = "time" if timed and key == "time" else kinds.get(key)
        if timed and key == "time" and unit is None:
            found[key] = _seconds(values)
        else:
            given = key, kind, unit, values, lines, timed, key in blank
            found[key] = _cells(table, name, *given)
    return found | ({"line": lines} if timed else {})


def _head(table, name, title) -> tuple[str, str | None]:
    """Split a column title into key and unit."""
    match = re.fullmatch(r"\s*([\w.]+)\s*(?:\[([^\[\]]*)\])?\s*", title)
    if match is not None:
        return match[1], match[2]
    problem = f'{name}: {title!r} is no header such as "operating.load.Fy [kN]"'
    raise table.error("file", problem)


def _columns(table, name, path, what, record) -> tuple[Any, Any, Any]:
    """Read titles, columns of cells, and the line of each row."""
    try:
        if record and path.suffix.lower() == ".parquet":
            found = read_table(path)
            count = len(next(iter(found.values()), ()))
            return list(found), list(found.values()), np.arange(1, count + 1)
        plain = _plain_columns(path) if record else None
        rows = [] if plain else read_columns(path)
    except (ValueError, ImportError, OSError) as error:
        raise table.error("file", f"{name}: {error}") from error
    if plain:
        return plain
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
    (_, header), *cells = rows
    columns = zip(*(row for _, row in cells), strict=True)
    return header, list(columns), np.array([line for line, _ in cells])


def _plain_columns(path):
    """Read a record whose cells are numbers or instants, a million rows in a second or
    two; `None` if it is another file."""
    head, _, rest = read_text(path).partition("\n")
    mark = next((m for m in ";\t," if m in head), ",")
    titles = head.split(mark)
    if not head.startswith("time") or "\n\n" in rest.rstrip("\n"):
        return None
    kinds = [(str(k), "U40" if t == "time" else float) for k, t in enumerate(titles)]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # without rows
            given: Any = {"delimiter": mark, "comments": None, "ndmin": 1}
            rows = np.loadtxt(io.StringIO(rest), dtype=kinds, **given)
    except (ValueError, UserWarning):
        return None
    if rows.size > MOST_CASES:
        return None
    return titles, [rows[name] for name, _ in kinds], np.arange(2, 2 + rows.size)


def _seconds(values) -> np.ndarray:
    """Seconds of instants since the first, NaN of cells that are none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of offsets, which count
        found = np.array([_instant(str(value)) for value in values], "datetime64[us]")
    known = found[~np.isnat(found)]
    return (found - (known[0] if known.size else found)) / np.timedelta64(1, "s")


def _instant(text):
    try:
        return np.datetime64(text.strip(), "us")
    except ValueError:
        return np.datetime64("nat")


def _cells(table, name, key, kind, unit, values, lines, timed, blank):
    """Convert the cells of a column: SI numbers of a kind, or design settings."""
    if kind == "" and unit is None:
        return np.array(_numbers(table, name, key, values, lines, timed, blank))
    if kind == "":
        problem = f"{name}: {key} is a pure number; it has no unit, [{unit}]"
        raise table.error("file", problem)
    if kind is not None:
        if unit is None:
            example = f"{key} [{QUANTITIES[kind][1]}]"
            problem = f'{name}: {key} has no unit; head the column "{example}"'
            raise table.error("file", problem)
        try:
            one, zero = (to_si(f"{k} {unit}", kind) for k in (1, 0))
        except SceneError as error:
            problem = f"{name}: the unit of {key}: {error}"
            raise table.error("file", problem) from error
        numbers = np.array(_numbers(table, name, key, values, lines, timed, blank))
        return numbers * (one - zero) + zero
    values = [str(value) for value in values]
    empty = [line for line, value in zip(lines, values, strict=True) if not value]
    if empty:
        raise table.error("file", f"{name}: line {empty[0]}: {key} is empty")
    if unit is not None:
        return [f"{value.strip()} {unit}" for value in values]
    return [_parse_value(value.strip()) for value in values]


def _numbers(table, name, key, values, lines, timed, blank) -> Any:
    numbers = []
    if isinstance(values, np.ndarray) and values.dtype.kind in "fi":
        return values.astype(float)
    for line, value in zip(lines, values, strict=True):
        if blank and not value.strip():
            numbers.append(math.nan)
            continue
        try:
            number = float(str(value).replace("−", "-"))
        except ValueError:
            number = math.nan
        if not timed and not math.isfinite(number):
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

"""A record in time: a CSV file or a Parquet table with a column `time`."""

import io
import math
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..numerics.units import shown_count
from .column_list import MOST_CASES, split_title, unit_of_column
from .table import Table
from .table_file import read_table
from .text_file import read_columns, read_text

_INSTANT = "U40"
"""Type of an instant as it is read, ISO 8601."""


class Record(NamedTuple):
    """A record in time as it was read.

    Attributes:
        columns: Numbers by key, in SI; NaN where a cell is none. `time` is in seconds,
            of instants since the first.
        lines: Line of each row in its file; `None` in a table without lines.
    """

    columns: dict[str, np.ndarray]
    lines: np.ndarray | None

    def row_name(self, row: int) -> str:
        """Return what messages call a row."""
        return f"row {row + 1}" if self.lines is None else f"line {self.lines[row]}"


def read_record(table: Table, folder: Path, kinds: Mapping[str, str]) -> Record | None:
    """Read a record in time; `None` if the file has no column `time`.

    A million rows of numbers take a second or two; of a CSV file whose cells are not
    all numbers some ten.

    Args:
        table: Table with the name of a `file`.
        folder: Folder of the scene.
        kinds: Quantity kinds of the keys that its columns may have; `time` [s] or an
            instant such as 2024-05-01T12:10 comes besides.

    Raises:
        SceneError: For a file that cannot be read, a column of another key, without a
            unit or of a wrong one, and fewer than two rows.
    """
    name = table.text("file")
    if name is None:
        return None
    path, lines = folder / name, None
    try:
        if path.suffix.lower() == ".parquet":
            found: Any = read_table(path)
            count = len(next(iter(found.values()), ()))
        else:
            text = read_text(path)
            if not any("time" in line for line in text[:10_000].split("\n")[:2]):
                return None
            found, lines = _cells_at_once(text) or _cells_by_line(path)
            count = len(lines)
    except (ValueError, ImportError, OSError) as error:
        raise table.error("file", f"{name}: {error}") from error
    titles = {split_title(table, name, title): v for title, v in found.items()}
    keys = [key for key, _ in titles]
    if "time" not in keys:
        if lines is None:
            problem = f"{name}: has no column `time`; a list of cases is a CSV file"
            raise table.error("file", problem)
        return None
    if count < 2 or count > MOST_CASES:
        rows = shown_count(count, "row")
        problem = f"{name}: has {rows}; a record in time has two to {MOST_CASES}"
        raise table.error("file", problem)
    columns = {}
    for (key, unit), values in titles.items():
        if key in columns:
            raise table.error("file", f"{name}: names a column twice, {key}")
        if key == "time" and unit is None:
            columns[key] = _seconds(values)
            continue
        if key != "time" and key not in kinds:
            allowed = ", ".join(kinds)
            problem = f"{name}: {key} cannot vary in a record in time; what can: time,"
            raise table.error("file", f"{problem} {allowed}")
        kind = "time" if key == "time" else kinds[key]
        factor, zero = unit_of_column(table, name, key, kind, unit)
        columns[key] = _numbers(values) * factor + zero
    return Record(columns, lines)


def _cells_at_once(text):
    """Cells of a plain table by title, and their lines; `None` if it is not plain."""
    head, _, rest = text.partition("\n")
    mark = next((m for m in ";\t," if m in head), "")
    titles = [title.strip().strip('"') for title in head.split(mark)] if mark else []
    if not titles or len(set(titles)) < len(titles) or "\n\n" in rest.rstrip("\n"):
        return None
    kinds = [
        (f"f{k}", _INSTANT if t == "time" else float) for k, t in enumerate(titles)
    ]
    plain: dict[str, Any] = dict(delimiter=mark, comments=None, ndmin=1, quotechar='"')
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # of a table without rows
            rows = np.loadtxt(io.StringIO(rest), dtype=kinds, **plain)
    except (ValueError, UserWarning):
        return None
    columns = {title: rows[f"f{k}"] for k, title in enumerate(titles)}
    return columns, np.arange(2, 2 + rows.size)


def _cells_by_line(path):
    """Cells of a table as text by title, and their lines."""
    (first, head), *rows = read_columns(path) or [(1, [])]
    for line, row in rows:
        if len(row) != len(head):
            raise ValueError(f"line {line} has {len(row)} values, not {len(head)}")
    if len(set(head)) < len(head):
        raise ValueError(f"line {first} names a column twice")
    columns = zip(*(row for _, row in rows), strict=True) if rows else [()] * len(head)
    lines = np.array([line for line, _ in rows], int)
    return dict(zip(head, map(list, columns), strict=True)), lines


def _numbers(values):
    """Numbers of cells; NaN for what is none."""
    try:
        return np.asarray(values, float)
    except (ValueError, TypeError):
        return np.array([_number(value) for value in values])


def _number(value):
    try:
        return float(str(value).replace("−", "-"))
    except ValueError:
        return math.nan


def _seconds(values):
    """Seconds of instants since the first one; NaN for what is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of offsets, which count
        try:
            instants = np.asarray(values).astype("datetime64[us]")
        except (ValueError, TypeError):
            instants = np.array([_instant(value) for value in values])
    known = instants[~np.isnat(instants)]
    since = known[0] if known.size else np.datetime64("NaT")
    return (instants - since) / np.timedelta64(1, "s")


def _instant(value):
    try:
        return np.datetime64(str(value).strip(), "us")
    except ValueError:
        return np.datetime64("NaT", "us")

"""Tables as files, columns by header: CSV, and with pandas Parquet and Excel.

Columns are made in SI; here alone they change to the units of the reports, and back, as
their header tells, "name [unit]".
"""

import csv
import importlib.util
import itertools
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from ..numerics.labels import column_header
from ..numerics.units import CELSIUS, DISPLAYED, display_unit

ENDINGS = (".csv", ".parquet", ".xlsx")

MOST_ROWS = 2**20 - 1
"""Largest number of rows of an Excel sheet, without the header."""

_BLOCK = 8192
"""Rows of a CSV file that are in memory as text at a time."""

NEEDED = {".parquet": ("pandas", "pyarrow"), ".xlsx": ("pandas", "openpyxl")}
"""Optional packages by the ending of the file."""


def missing_packages(path: Path) -> str:
    """Say which optional packages a table needs, if one is missing; else empty."""
    ending = path.suffix.lower()
    needed = NEEDED.get(ending, ())
    if all(map(importlib.util.find_spec, needed)):
        return ""
    return f"{ending} tables need {' and '.join(needed)}, .csv nothing"


def in_shown_units(found: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return columns in the units of the reports: µm or mm, mrad or deg, kN, MPa, rpm.

    Args:
        found: Columns by header, in SI.
    """
    shown = {}
    for header, column in found.items():
        name, _, unit = header.removesuffix("]").partition(" [")
        column, zero = np.asarray(column), CELSIUS if unit == "K" else 0.0
        if column.dtype.kind == "f":
            most = np.abs(column[np.isfinite(column)]).max(initial=0.0)
            factor, other = (1.0, "°C") if zero else display_unit(unit, most)
            if other != unit:  # 15 digits: 2e-5 m are 20 µm, no 20.000000000000004
                made = ((column - zero) * factor).tolist()
                column = np.array([float(f"{x:.15g}") for x in made])
                header = column_header(name, other)
        shown[header] = column
    return shown


def in_si(found: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return columns in SI, from the units that their headers tell."""
    plain = {}
    for header, column in found.items():
        name, _, shown = header.removesuffix("]").partition(" [")
        if shown in DISPLAYED and np.asarray(column).dtype.kind in "fi":
            factor, zero, unit = DISPLAYED[shown]
            column = np.asarray(column, float) / factor + zero
            header = column_header(name, unit)
        plain[header] = column
    return plain


def check_writable(path: Path, rows: int = 0) -> None:
    """Raise unless `write_table` can write this format. Call it before a long sweep.

    Args:
        path: Path of the table.
        rows: Number of rows that it will have, if known.

    Raises:
        ValueError: For an ending other than .csv, .parquet and .xlsx; for more rows
            than a sheet of Excel has.
        ImportError: Without the packages that an ending other than .csv needs.
    """
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{path}: a table ends in {', '.join(ENDINGS)}")
    if missing := missing_packages(path):
        raise ImportError(f'{path}: {missing}: pip install "bearingjax[table]"')
    if ending == ".xlsx" and rows > MOST_ROWS:
        problem = f"{rows} rows, and a sheet has {MOST_ROWS} at most"
        raise ValueError(f"{path}: {problem}; write .csv or .parquet")


def write_table(found: Mapping[str, np.ndarray], path: str | Path) -> None:
    """Write columns to a file.

    In an Excel sheet non-finite values are empty cells, and numbers have 16 digits.

    Args:
        found: Columns by header, of the same length.
        path: Its ending, .csv, .parquet or .xlsx, sets the format.

    Raises:
        ValueError, ImportError: As `check_writable`.
        OSError: If the file cannot be written.
    """
    path = Path(path)
    arrays = {header: np.asarray(column) for header, column in found.items()}
    check_writable(path, max(map(len, arrays.values()), default=0))
    if path.suffix.lower() == ".csv":
        return _write_csv(arrays, path)
    import pandas

    frame = pandas.DataFrame(arrays)
    if path.suffix.lower() == ".parquet":
        return frame.to_parquet(path, index=False)
    frame = frame.replace([np.inf, -np.inf], np.nan)
    with pandas.ExcelWriter(path, engine="openpyxl") as book:
        frame.to_excel(book, sheet_name="cases", index=False, freeze_panes=(1, 0))
        sheet = book.sheets["cases"]
        cells_of = zip(sheet.iter_cols(), arrays.values(), strict=True)
        for (head, *cells), values in cells_of:
            width = max(12, len(str(head.value)) + 2)
            sheet.column_dimensions[head.column_letter].width = width
            shown = _number_format(values)
            for cell in cells:
                cell.number_format = shown


def _number_format(column: np.ndarray) -> str:
    """Return Excel's format of a column: five digits of its largest number."""
    if column.dtype.kind != "f":
        return "General"
    most = np.abs(column[np.isfinite(column)]).max(initial=0.0)
    if most and not 1e-3 <= most < 1e9:
        return "0.0000E+00"
    return f"{0:.{max(0, 4 - math.floor(math.log10(most)))}f}" if most else "0"


def _write_csv(arrays: Mapping[str, np.ndarray], path: Path) -> None:
    columns = [
        np.where(one, "true", "false") if one.dtype == bool else one
        for one in arrays.values()
    ]
    with open(path, "w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
        lines.writerow(arrays)
        for first in range(0, max(map(len, columns), default=0), _BLOCK):
            parts = (column[first : first + _BLOCK].tolist() for column in columns)
            lines.writerows(zip(*parts, strict=True))


def read_table(path: str | Path, texts: Iterable[str] = ()) -> dict[str, np.ndarray]:
    """Return the columns of a table that `write_table` wrote.

    Args:
        path: Its ending, .csv, .parquet or .xlsx, sets the format.
        texts: Headers of columns that are text even if they look like numbers.

    Raises:
        ValueError: If it is no such table.
        ImportError: As `check_writable`.
        OSError: If the file cannot be read.
    """
    path, ending = Path(path), Path(path).suffix.lower()
    check_writable(path)
    if ending == ".csv":
        return _read_csv(path, set(texts))
    import pandas

    if ending == ".parquet":
        frame = pandas.read_parquet(path)
    else:
        frame = pandas.read_excel(path, dtype=dict.fromkeys(texts, str))
        there = [header for header in texts if header in frame]
        frame[there] = frame[there].fillna("")
    return {str(header): frame[header].to_numpy() for header in frame}


def _read_csv(path: Path, texts: set[str]) -> dict[str, np.ndarray]:
    parts: dict[str, list[np.ndarray]] = {}
    with open(path, newline="", encoding="utf-8") as file:
        lines = csv.reader(file)
        try:
            headers = next(lines, [])
            while rows := list(itertools.islice(lines, _BLOCK)):
                for header, *cells in zip(headers, *rows, strict=True):
                    found = _parse(np.array(cells), header in texts)
                    parts.setdefault(header, []).append(found)
        except csv.Error as error:
            raise ValueError(f"is no CSV file: {error}") from error
    return {header: np.concatenate(parts.get(header, [[]])) for header in headers}


def _parse(cells: np.ndarray, text: bool) -> np.ndarray:
    """Return words as they are, other cells as truth values or numbers."""
    if text:
        return cells
    if np.isin(cells, ("true", "false")).all():
        return cells == "true"
    for kind in (int, float):
        try:
            return np.where(cells == "", "nan", cells).astype(kind)
        except ValueError:
            pass
    return cells

"""A sweep as a flat table: one row per case, units in the header.

Tables of all commands are written here: CSV, Parquet, and sheets of Excel.
"""

import importlib.util
import itertools
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..design.rib import RIB_NAMES
from ..element.frame import FREEDOMS, LOADS, RINGS
from ..fits.fits import Mounting
from ..life.life import Life
from ..life.life_warning import ALL
from ..numerics.result import Result
from ..numerics.units import unit_of
from ..statics.solution import BallSolution, RollerSolution
from ..statics.warning import exceeded_kinds
from .cases import Cases
from .sweep import SUMMARIES, Sweep
from .sweep_program import WARNED, not_run

ENDINGS = (".csv", ".parquet", ".xlsx")

MOST_ROWS = 2**20 - 1
"""Largest number of rows of an Excel sheet, without the header."""

NOTHING = 1e-12
"""Size of a result below which it counts as zero."""

ROUND_OFF = 1e-11
"""Size of a result below which it is round-off, relative to the largest of its kind."""

WARNINGS = "warnings"
"""Header of the column of warnings."""

_RING = [f"{ring}_{f}" for ring in RINGS for f in FREEDOMS]
_LAST_AXES = {
    "displacement": (_RING,),
    "force": ([f"{ring}_{c}" for ring in RINGS for c in LOADS],),
    "stiffness": (_RING, _RING),
    "roller_motion": (("u", "v", "theta"),),
    "roller_load": (RINGS,),
    "roller_pressure": (RINGS,),
    "rib_load": (RIB_NAMES,),
}
"""Names along the last axes of an output; other axes are counted."""

OPERATING_CLEARANCE = "operating_radial_clearance"
"""Output of sweeps of bearings on their seats: the clearance with which they run."""

OPERATING_PRELOAD = "operating_preload"
"""Output of sweeps of sets on their seats: the preload between the unloaded rows."""

_FIELD_OF = {
    "peak_pressure": "roller_pressure",
    "largest_load": "roller_load",
    "n_loaded": "",
    "iterations": "",
    "residual": "",
    OPERATING_CLEARANCE: "radial_clearance",
    OPERATING_PRELOAD: "roller_load",
}
"""Fields that have the units of outputs of other names, among them all of `SUMMARIES`;
empty: a pure number."""


def columns(
    sweep: Sweep,
    extra: Mapping[str, np.ndarray] | None = None,
    *,
    exact: bool = False,
) -> dict[str, np.ndarray]:
    """A sweep as columns by header, "name [unit]": first the cases, then the results.

    Arrays are spread over columns, `displacement_inner_uy [m]`. Values that are zero in
    every case, by construction (`left_out`) or load, have no column. Those that are
    zero by symmetry, in every case below `ROUND_OFF` of the largest number of their
    kind, are 0. The result is the code's label; where it is not "converged", numbers
    are NaN. `warnings` holds the kinds of warning of a case, each with its size.

    Args:
        sweep: From `sweep`.
        extra: Further columns, placed first (case,).
        exact: Whether to keep round-off as it was computed.

    Returns:
        Header -> array (case,), in SI.
    """
    found = {
        header: column
        for name, values in sweep.outputs.items()
        if name not in ("result", "unrestrained") and not name.startswith(WARNED)
        for header, column in flatten_columns(name, values, left_out(sweep))
        if column is not None and not _is_nothing(sweep, column)
    }
    if not exact:
        found = _without_round_off(sweep, found)
    labels = np.array([code.label for code in Result])
    return {
        **(extra or {}),
        **case_columns(sweep.cases),
        "result": labels[np.asarray(sweep.result)],
        **({WARNINGS: _warning_texts(sweep)} if sweep.warned else {}),
        **found,
    }


def _without_round_off(sweep, found):
    """The columns, zero where all numbers of one are round-off."""
    sizes, largest = {}, {}
    for header, column in found.items():
        if column.dtype.kind == "f":
            known = column[sweep.converged & np.isfinite(column)]
            sizes[header] = np.abs(known).max(initial=0.0)
            alike = kind(header)
            largest[alike] = max(largest.get(alike, 0.0), sizes[header])
    return {
        header: np.where(np.isfinite(column), 0.0, column)
        if header in sizes and sizes[header] < ROUND_OFF * largest[kind(header)]
        else column
        for header, column in found.items()
    }


def kind(header: str) -> tuple[str, str]:
    """First word and unit of a header, equal for comparable numbers.

    Args:
        header: "name_axis [unit]".
    """
    return header.partition("_")[0], header.partition(" [")[2]


def _is_nothing(sweep, column) -> bool:
    """Whether a result is exactly zero in all cases that were solved."""
    if column.dtype.kind == "f":  # of the others NaN
        column = column[sweep.converged]
    return column.dtype.kind in "fi" and column.size > 0 and not column.any()


def left_out(sweep: Sweep) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """`Sweep.zeros`, and the displacements that all its cases hold at zero."""
    held = tuple(
        f"{sweep.moving_ring}_{freedom}"
        for freedom, values in sweep.cases.prescribed.items()
        if not np.any(np.asarray(values))
    )
    zeros = dict(sweep.zeros)
    return tuple(
        {**zeros, "displacement": zeros.get("displacement", ()) + held}.items()
    )


def _warning_texts(sweep):
    """Warnings of each case, "kind=size" joined by "; ", sizes in SI."""
    texts = np.full(sweep.cases.count, "", dtype=object)
    for name, cases in exceeded_kinds(sweep.warned, ALL).items():
        new = [f"{name}={size:.6g}" for size in sweep.warned[name][cases]]
        old = texts[cases]
        texts[cases] = [f"{a}; {b}" if a else b for a, b in zip(old, new, strict=True)]
    return texts.astype(str)


def check_writable(path: Path, rows: int = 0) -> None:
    """Raise unless `write` can write this format. Call it before a long sweep.

    Args:
        path: Path of the table.
        rows: Number of rows that it will have, if known.

    Raises:
        ValueError: For an ending other than .csv, .parquet and .xlsx; for more rows
            than a sheet of Excel has.
        ImportError: Without pyarrow, or of a sheet without openpyxl.
    """
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{path}: a table ends in {', '.join(ENDINGS)}")
    needed = "openpyxl" if ending == ".xlsx" else "pyarrow"
    if importlib.util.find_spec(needed) is None:
        what = f"{ending} tables need {needed}"
        raise ImportError(f'{path}: {what}: pip install "bearingjax[table]"')
    if ending == ".xlsx" and rows > MOST_ROWS:
        problem = f"{rows} rows, and a sheet has {MOST_ROWS} at most"
        raise ValueError(f"{path}: {problem}; write .csv or .parquet")


def write(
    sweep: Sweep,
    path: str | Path,
    extra: Mapping[str, np.ndarray] | None = None,
) -> None:
    """Write `columns` to a file.

    Args:
        sweep: From `sweep`.
        path: Its ending, .csv, .parquet or .xlsx, sets the format.
        extra: As in `columns`.

    Raises:
        ValueError, ImportError: As `check_writable`.
        OSError: If the file cannot be written.
    """
    write_columns(columns(sweep, extra), path)


def write_columns(found: Mapping[str, np.ndarray], path: str | Path) -> None:
    """Write columns to a file: .csv and .parquet with pyarrow, .xlsx with openpyxl.

    In an Excel sheet non-finite values are empty cells, and numbers have 16 digits.

    Args:
        found: Columns by header, of the same length.
        path: Its ending, .csv, .parquet or .xlsx, sets the format.

    Raises:
        ValueError, ImportError: As `check_writable`.
        OSError: If the file cannot be written.
    """
    path = Path(path)
    check_writable(path, max(map(len, found.values()), default=0))
    if path.suffix.lower() == ".xlsx":
        return _write_sheet(found, path)
    import pyarrow
    import pyarrow.csv
    import pyarrow.parquet

    table = pyarrow.table(found)
    if path.suffix.lower() == ".csv":
        pyarrow.csv.write_csv(table, path)
    else:
        pyarrow.parquet.write_table(table, path)


def _write_sheet(found: Mapping[str, np.ndarray], path: Path) -> None:
    """A sheet whose header stays in sight and has a filter."""
    from openpyxl import Workbook
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.styles import Font
    from openpyxl.utils import get_column_letter

    book = Workbook(write_only=True)
    sheet = book.create_sheet("cases")
    sheet.freeze_panes = "A2"
    for k, header in enumerate(found, 1):
        width = max(12, len(header) + 2)
        sheet.column_dimensions[get_column_letter(k)].width = width
    heads = [WriteOnlyCell(sheet, header) for header in found]
    for head in heads:
        head.font = Font(bold=True)
    sheet.append(heads)
    for row in zip(*(_cells(column) for column in found.values()), strict=True):
        sheet.append(row)
    book.save(path)


def _cells(column: np.ndarray) -> list[Any]:
    values = np.asarray(column)
    if values.dtype.kind != "f":
        return values.tolist()
    return [x if np.isfinite(x) else None for x in values.tolist()]


def _read_sheet(path: Path, texts: Iterable[str]) -> dict[str, np.ndarray]:
    from zipfile import BadZipFile

    from openpyxl import load_workbook
    from openpyxl.utils.exceptions import InvalidFileException

    try:
        book = load_workbook(path, read_only=True)
    except (BadZipFile, InvalidFileException, KeyError) as error:
        raise ValueError(f"is no sheet of Excel: {error}") from error
    try:
        rows = list(book.worksheets[0].iter_rows(values_only=True))
    finally:
        book.close()
    heads = [str(head) for head in rows[0]] if rows else []
    words = {"result", WARNINGS, *texts}
    found = {}
    # Rows end with their last cell that is not empty.
    columns = itertools.zip_longest(*(row[: len(heads)] for row in [heads, *rows[1:]]))
    for head, *cells in columns:
        if head in words:
            found[head] = np.array(["" if c is None else str(c) for c in cells])
        else:
            found[head] = np.array([np.nan if c is None else c for c in cells])
    return found


def read(path: str | Path, texts: Iterable[str] = ()) -> dict[str, np.ndarray]:
    """Columns of a table that `write` wrote.

    Args:
        path: Its ending, .csv, .parquet or .xlsx, sets the format.
        texts: Headers of columns that are text even if they look like numbers.

    Raises:
        ValueError: If it is no such table.
        ImportError: As `check_writable`.
        OSError: If the file cannot be read.
    """
    path = Path(path)
    check_writable(path)
    if path.suffix.lower() == ".xlsx":
        return _read_sheet(path, texts)
    import pyarrow
    import pyarrow.csv
    import pyarrow.parquet

    if path.suffix.lower() == ".csv":
        types = dict.fromkeys(("result", WARNINGS, *texts), pyarrow.string())
        options = pyarrow.csv.ConvertOptions(column_types=types)
        table = pyarrow.csv.read_csv(path, convert_options=options)
    else:
        table = pyarrow.parquet.read_table(path)
    pairs = zip(table.column_names, table.columns, strict=True)
    return {name: np.asarray(column.to_numpy()) for name, column in pairs}


def restore_outputs(
    table: Mapping[str, np.ndarray],
    like: Mapping[str, np.ndarray],
    zeros: Iterable[tuple[str, tuple[str, ...]]] = (),
) -> dict[str, np.ndarray]:
    """Outputs of a sweep, from the columns of its table.

    Args:
        table: From `read`.
        like: Outputs of a sweep of the same kind, e.g. of some of its cases: their
            names, shapes and dtypes are taken; a column that they do not have, but for
            zeros, may be missing.
        zeros: As in `left_out`.

    Returns:
        Outputs by name; `unrestrained`, which no table holds, is -1, and a warning
        that was not given is of size -inf.

    Raises:
        ValueError: For a column that is missing, or that holds something else.
    """
    count = len(table["result"])
    codes = {code.label: int(code) for code in Result}
    found = {}
    for name, values in like.items():
        if name == "result":
            unknown = set(table["result"]) - set(codes)
            if unknown:
                raise ValueError(f"has the unknown result {unknown.pop()!r}")
            plain: Any = [codes[label] for label in table["result"]]
        elif name == "unrestrained":
            plain = np.full(count, -1)
        elif name.startswith(WARNED):
            plain = _sizes(table, name.removeprefix(WARNED), count)
        else:
            solved = np.asarray(table["result"]) == Result.CONVERGED.label
            nothing = np.where(solved, 0.0, not_run(name, values.dtype))
            parts = []
            for header, column in flatten_columns(name, values, zeros):
                there = table.get(header)
                if column is None:
                    there = nothing
                elif there is None:
                    if np.abs(np.nan_to_num(column)).max(initial=0.0) > NOTHING:
                        raise ValueError(f"has no column {header!r}")
                    there = nothing
                parts.append(np.asarray(there, dtype=values.dtype))
            plain = np.stack(parts, axis=-1) if parts else np.empty(0)
        shape = (count, *values.shape[1:])
        found[name] = np.asarray(plain, dtype=values.dtype).reshape(shape)
    return found


def _sizes(table, kind, count):
    """Sizes of one kind of warning, from the column of warnings; -inf: not given."""
    found = np.full(count, -np.inf)
    for k, text in enumerate(table.get(WARNINGS, [])):
        for part in str(text or "").split("; "):
            name, _, size = part.partition("=")
            if name == kind:
                found[k] = float(size)
    return found


def case_columns(cases: Cases) -> dict[str, np.ndarray]:
    """Columns of the cases (loads, displacements, speeds, hours), in SI, by header,
    without those that are zero in all of them.

    Args:
        cases: Cases of the sweep.
    """
    out: dict[str, np.ndarray] = {}
    for k, name in enumerate(LOADS):
        if np.any(np.nan_to_num(np.asarray(cases.load)[:, k]) != 0):
            head = column_header(name, unit_of(cases, "load", (k,)))
            out[head] = np.asarray(cases.load)[:, k]
    for name, values in cases.prescribed.items():
        if not np.any(np.asarray(values)):
            continue
        unit = unit_of(cases, "prescribed", (FREEDOMS.index(name),))
        out[column_header(f"prescribed_{name}", unit)] = np.asarray(values)
    if cases.fixed_displacement is not None:
        fixed = np.asarray(cases.fixed_displacement)
        for k, name in enumerate(FREEDOMS):
            if np.any(fixed[:, k]):
                unit = unit_of(cases, "fixed_displacement", (k,))
                out[column_header(f"fixed_{name}", unit)] = fixed[:, k]
    for name in ("inner_speed", "outer_speed", "hours"):
        values = getattr(cases, name)
        if values is not None and np.any(np.asarray(values)):
            out[column_header(name, unit_of(cases, name))] = np.asarray(values)
    if cases.design is not None and np.any(np.asarray(cases.design)):
        out["design"] = np.asarray(cases.design)
    return out


def flatten_columns(
    name: str, values: np.ndarray, zeros: Any = ()
) -> Iterator[tuple[str, np.ndarray | None]]:
    """Headers and columns of an output with any number of axes.

    Args:
        name: Name of the output.
        values: Its values (case, …).
        zeros: As in `left_out`.

    Yields:
        Header, "name_axis [unit]", and column (case,), or `None` where all is zero
        whatever the case.
    """
    values, none = np.asarray(values), dict(zeros).get(name, ())
    axes = _LAST_AXES.get(name, ())
    named = len(axes) > 0 and values.shape[-len(axes) :] == tuple(map(len, axes))
    for index in itertools.product(*(range(n) for n in values.shape[1:])):
        label = column_header(*_label(name, index, values.shape[1:]))
        last = zip(axes, index[-len(axes) :], strict=True) if named else ()
        left_out = any(axis[k] in none for axis, k in last)
        yield label, None if left_out else values[(slice(None), *index)]


def column_header(name: str, unit: str) -> str:
    """Header of a column, with the unit, if any, in brackets."""
    return f"{name} [{unit}]" if unit else name


def _label(name, index, shape):
    """Name and unit of one entry of an output."""
    axes = _LAST_AXES.get(name, ())
    first = len(shape) - len(axes)
    field = _FIELD_OF[name] if name in SUMMARIES else _FIELD_OF.get(name, name)
    entry = index
    if shape[max(first, 0) :] != tuple(map(len, axes)):
        # A user's own array under the name of a field: its axes are unknown.
        axes, first, entry = (), len(shape), ()
    last = [axis[k] for axis, k in zip(axes, index[first:], strict=True)]
    label = "_".join([name, *map(str, index[:first]), *last])
    for kind in (RollerSolution, BallSolution, Life, Mounting):
        if field in kind.__dataclass_fields__:
            return label, unit_of(kind, field, entry)
    return label, ""

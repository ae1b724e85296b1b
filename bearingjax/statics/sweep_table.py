"""A sweep as a flat table: one row per case, units in the header."""

import importlib.util
import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..design.rib import RIB_NAMES
from ..element.frame import FREEDOMS, LOADS, RINGS
from ..numerics.result import Result
from ..numerics.units import unit_of
from .cases import Cases
from .life import Life
from .solution import BallSolution, RollerSolution
from .sweep import Sweep
from .sweep_program import WARNED
from .warning import given

ENDINGS = (".csv", ".parquet")

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

_LARGEST_OF = {"peak_pressure": "roller_pressure", "largest_load": "roller_load"}


def columns(
    sweep: Sweep, beside: Mapping[str, np.ndarray] | None = None
) -> dict[str, np.ndarray]:
    """A sweep as columns by header, "name [unit]": first the cases, then the results.

    Arrays are spread over columns, `displacement_inner_uy [m]`. The result is the
    code's label; where it is not "converged", numbers are NaN. `warnings` holds the
    kinds of warning that are given for a case, each with its size.

    Args:
        sweep: From `sweep`.
        beside: Further columns, placed first (case,).

    Returns:
        Header -> array (case,), in SI.
    """
    found = {
        header: column
        for name, values in sweep.outputs.items()
        if name not in ("result", "unrestrained") and not name.startswith(WARNED)
        for header, column in _spread(name, values)
    }
    labels = np.array([code.label for code in Result])
    return {
        **(beside or {}),
        **asked(sweep.cases),
        "result": labels[np.asarray(sweep.result)],
        **({WARNINGS: _warned(sweep)} if sweep.warned else {}),
        **found,
    }


def _warned(sweep):
    """Warnings of each case, "kind=size" joined by "; ", sizes in SI."""
    texts = np.full(sweep.cases.count, "", dtype=object)
    for name, cases in given(sweep.warned).items():
        new = [f"{name}={size:.6g}" for size in sweep.warned[name][cases]]
        old = texts[cases]
        texts[cases] = [f"{a}; {b}" if a else b for a, b in zip(old, new, strict=True)]
    return texts.astype(str)


def check_writable(path: Path) -> None:
    """Raise unless `write` can write this format. Call it before a long sweep.

    Args:
        path: Of the table.

    Raises:
        ValueError: For an ending other than .csv and .parquet.
        ImportError: Without pyarrow.
    """
    if path.suffix.lower() not in ENDINGS:
        raise ValueError(f"{path}: a table ends in {' or '.join(ENDINGS)}")
    if importlib.util.find_spec("pyarrow") is None:
        raise ImportError('tables need pyarrow: pip install "bearingjax[table]"')


def write(
    sweep: Sweep,
    path: str | Path,
    beside: Mapping[str, np.ndarray] | None = None,
) -> None:
    """Write `columns` to a .csv or .parquet file (with pyarrow).

    Args:
        sweep: From `sweep`.
        path: Its ending, .csv or .parquet, sets the format.
        beside: As in `columns`.

    Raises:
        ValueError, ImportError: As `check_writable`.
        OSError: If the file cannot be written.
    """
    write_columns(columns(sweep, beside), path)


def write_columns(found: Mapping[str, np.ndarray], path: str | Path) -> None:
    """Write columns to a .csv or .parquet file (with pyarrow).

    Args:
        found: Columns by header, of the same length.
        path: Its ending, .csv or .parquet, sets the format.

    Raises:
        ValueError, ImportError: As `check_writable`.
        OSError: If the file cannot be written.
    """
    path = Path(path)
    check_writable(path)
    import pyarrow
    import pyarrow.csv
    import pyarrow.parquet

    table = pyarrow.table(found)
    if path.suffix.lower() == ".csv":
        pyarrow.csv.write_csv(table, path)
    else:
        pyarrow.parquet.write_table(table, path)


def read(path: str | Path, texts: Iterable[str] = ()) -> dict[str, np.ndarray]:
    """Columns of a table that `write` wrote.

    Args:
        path: Its ending, .csv or .parquet, sets the format.
        texts: Headers of columns that are text even if they look like numbers.

    Raises:
        ValueError: If it is no such table.
        ImportError: As `check_writable`.
        OSError: If the file cannot be read.
    """
    path = Path(path)
    check_writable(path)
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


def restored(
    table: Mapping[str, np.ndarray], like: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Outputs of a sweep, from the columns of its table.

    Args:
        table: From `read`.
        like: Outputs of a sweep of the same kind, with any number of cases: their
            names, shapes and dtypes are taken.

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
            headers = [header for header, _ in _spread(name, values)]
            for header in headers:
                if header not in table:
                    raise ValueError(f"has no column {header!r}")
            parts = [np.asarray(table[h], dtype=values.dtype) for h in headers]
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


def asked(cases: Cases) -> dict[str, np.ndarray]:
    """Columns of the cases (loads, displacements, speeds, hours), in SI, by header.

    Args:
        cases: Of the sweep.
    """
    out: dict[str, np.ndarray] = {}
    for k, name in enumerate(LOADS):
        if np.any(np.nan_to_num(np.asarray(cases.load)[:, k]) != 0):
            head = _header(name, unit_of(cases, "load", (k,)))
            out[head] = np.asarray(cases.load)[:, k]
    for name, values in cases.prescribed.items():
        unit = unit_of(cases, "prescribed", (FREEDOMS.index(name),))
        out[_header(f"prescribed_{name}", unit)] = np.asarray(values)
    if cases.fixed_displacement is not None:
        for k, name in enumerate(FREEDOMS):
            head = _header(f"fixed_{name}", unit_of(cases, "fixed_displacement", (k,)))
            out[head] = np.asarray(cases.fixed_displacement)[:, k]
    for name in ("inner_speed", "outer_speed", "hours"):
        if getattr(cases, name) is not None:
            head = _header(name, unit_of(cases, name))
            out[head] = np.asarray(getattr(cases, name))
    if cases.design is not None:
        out["design"] = np.asarray(cases.design)
    return out


def _spread(name, values):
    """(header, column) of an output with any number of axes."""
    values = np.asarray(values)
    for index in itertools.product(*(range(n) for n in values.shape[1:])):
        label = _header(*_label(name, index, values.shape[1:]))
        yield label, values[(slice(None), *index)]


def _header(name, unit):
    return f"{name} [{unit}]" if unit else name


def _label(name, index, shape):
    """Name and unit of one entry of an output."""
    axes = _LAST_AXES.get(name, ())
    first = len(shape) - len(axes)
    field, entry = _LARGEST_OF.get(name, name), index
    if shape[max(first, 0) :] != tuple(map(len, axes)):
        # A user's own array under the name of a field: its axes are unknown.
        axes, first, entry = (), len(shape), ()
    last = [axis[k] for axis, k in zip(axes, index[first:], strict=True)]
    label = "_".join([name, *map(str, index[:first]), *last])
    for kind in (RollerSolution, BallSolution, Life):
        if field in kind.__dataclass_fields__:
            return label, unit_of(kind, field, entry)
    return label, ""

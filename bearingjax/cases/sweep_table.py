"""A sweep as a flat table: one row per case, units in the header."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..files.table_file import in_si, read_table
from ..life.life_warning import ALL
from ..numerics.result import Result
from ..numerics.warning import exceeded_kinds
from .cases import Cases
from .output_labels import label_cases, label_output
from .sweep import Sweep
from .sweep_program import WARNED, not_run

NOTHING = 1e-12
"""Size of a result below which it counts as zero."""

ROUND_OFF = 1e-11
"""Size of a result below which it is round-off, relative to the largest of its kind."""

WARNINGS = "warnings"
"""Header of the column of warnings."""


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
        **({WARNINGS: _warning_texts(sweep)} if sweep.warning_sizes else {}),
        **found,
    }


def _without_round_off(sweep, found):
    """The columns, zero where all numbers of one are round-off."""
    sizes, largest = {}, {}
    # Forces count beside the loads of the rolling elements; pure numbers have kinds.
    units = {header: kind(header)[1] for header in found}
    alike = {h: kind(h)[0] if unit in ("", "1]") else unit for h, unit in units.items()}
    for header, column in found.items():
        if column.dtype.kind == "f":
            known = column[sweep.converged & np.isfinite(column)]
            sizes[header] = np.abs(known).max(initial=0.0)
            same = alike[header]
            largest[same] = max(largest.get(same, 0.0), sizes[header])
    return {
        header: np.where(np.isfinite(column), 0.0, column)
        if header in sizes and sizes[header] < ROUND_OFF * largest[alike[header]]
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
    for name, cases in exceeded_kinds(sweep.warning_sizes, ALL).items():
        new = [f"{name}={size:.6g}" for size in sweep.warning_sizes[name][cases]]
        old = texts[cases]
        texts[cases] = [f"{a}; {b}" if a else b for a, b in zip(old, new, strict=True)]
    return texts.astype(str)


def read(path: str | Path, texts: Iterable[str] = ()) -> dict[str, np.ndarray]:
    """Columns of a table, from `columns`, that `write_table` wrote, in SI.

    Args:
        path: Its ending, .csv, .parquet or .xlsx, sets the format.
        texts: Headers of columns that are text even if they look like numbers.

    Raises:
        ValueError: If it is no such table.
        ImportError: As `read_table`.
        OSError: If the file cannot be read.
    """
    return in_si(read_table(path, ("result", WARNINGS, *texts)))


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
    """
    found = label_cases(cases)
    names = {"load": "", **{k: k for k in found if k.startswith("prescribed_")}}
    names |= {"fixed_displacement": "fixed"}
    known = "inner_speed", "outer_speed", "oscillation", "viscosity", "hours", "design"
    names |= {name: name for name in known}
    return {
        header: column
        for name, shown in names.items()
        if name in found
        for header, _, column in found[name].columns(shown)
        if np.any(np.nan_to_num(column) if name == "load" else column)
    }


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
    none = {*dict(zeros).get(name, ())}
    for header, labels, column in label_output(name, np.asarray(values)).columns(name):
        yield header, None if none.intersection(labels) else column

"""Keys of `[cases]`: a grid, a list (CSV), a record in time or a load spectrum.

The varied keys are named as in the scene file, `operating.load.Fy` or
`bearing.radial_internal_clearance`.
"""

import dataclasses
import itertools
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...cases.cases import Cases
from ...cases.series import GAPS
from ...element import FREEDOMS, LOADS, RINGS, Speed
from ...element.frame import LOAD_UNITS, MOTION_UNITS
from ...files.column_list import MOST_CASES, read_list
from ...files.quantity import SceneError, kind_of, to_si
from ...files.schema import Keys, scene_key
from ...files.table import Table
from ...numerics.units import unit_of

OPERATING = {
    **{
        f"operating.load.{name}": kind_of(unit)
        for name, unit in zip(LOADS, LOAD_UNITS, strict=True)
    },
    **{
        f"operating.prescribed.{name}": kind_of(unit)
        for name, unit in zip(FREEDOMS, MOTION_UNITS, strict=True)
    },
    **{f"operating.{ring}_speed": kind_of(unit_of(Speed, ring)) for ring in RINGS},
    "oscillation.amplitude": "angle",
    "oscillation.frequency": "frequency",
    "lubricant.temperature": "temperature",
    "hours": kind_of(unit_of(Cases, "hours")),
}
"""Keys that may vary without changing the design, with their quantity kinds."""

OIL = "lubricant.temperature"
SWING = "oscillation.amplitude", "oscillation.frequency"


@dataclasses.dataclass(frozen=True)
class VariedKey:
    """Values of one key: case k takes `values[index[k]]`."""

    key: str
    values: Sequence[Any] | np.ndarray
    index: np.ndarray

    def numbers(self, table: Table) -> np.ndarray:
        """Return the number of each case in SI, of a key of `OPERATING`."""
        if isinstance(self.values, np.ndarray):
            return self.values[self.index]
        try:
            kind = OPERATING[self.key]
            return np.array([to_si(value, kind) for value in self.values])[self.index]
        except SceneError as error:
            raise table.error(self.key, error) from error


_VARIES: dict[str, Any] = {
    "type": "object",
    "additionalProperties": {"type": ["array", "object"]},
}
_ENTRIES: dict[str, Any] = {"type": "array", "items": {"type": "object"}}


def read_raw(table: Table, name: str) -> Any:
    """Read a value whose kind other keys tell; `None` if it is absent."""
    return table.raw(name, None)


class CasesKeys(Keys):
    about = "[cases]: what varies, named by the keys of the scene"

    grid: Any = scene_key(
        "values of each key, a list or `{ start, stop, count }`; every combination is a"
        " case, the last key running fastest",
        default=None,
        reader=read_raw,
        json=_VARIES,
    )
    file: str | None = scene_key(
        "path of a CSV table with a row for each case, headers such as"
        " `operating.load.Fy [kN]`; with a column `time` (CSV or Parquet) a record in"
        " time, each row of which holds until the next one"
    )
    gaps: str = scene_key(
        "treatment of gaps and bad rows in a record: an error, or they do not count",
        choices=GAPS,
        default="refuse",
        needs=("file",),
    )
    spectrum: Any = scene_key(
        "a table for each case, with its `hours`",
        default=None,
        reader=read_raw,
        json=_ENTRIES,
    )
    outputs: tuple[str, ...] | None = scene_key(
        "results that are kept", otherwise="the usual ones"
    )

    def check(self) -> None:
        given = [key for key in ("grid", "file", "spectrum") if key in self.table]
        if len(given) != 1:
            problem = "must have one of `grid`, `file` or `spectrum`"
            raise self.table.own_error(problem)

    def columns(
        self, path: Path, may_record: bool = True
    ) -> tuple[list["VariedKey"], dict[str, Any]]:
        """Return the values of each key that varies; time and lines of a record."""
        lists, record = {}, {}
        if self.grid is not None:
            found = _grid(self.table, self.grid)
        elif self.spectrum is not None:
            found = _spectrum(self.table, self.spectrum)
        else:
            known = {k: v for k, v in OPERATING.items() if may_record or k != OIL}
            lists = read_list(self.table, path.parent, known, record=may_record)
            if "line" in lists:
                record = {k: lists.pop(k) for k in ("time", "line")}
            found = [VariedKey(k, v, np.arange(len(v))) for k, v in lists.items()]
        if "gaps" in self.table and not record:
            problem = "is of a record in time, a `file` with a column `time`"
            raise self.table.error("gaps", problem)
        if record and (not lists or "hours" in lists or len(record["time"]) < 2):
            problem = "is a record in time: it has two rows at least, and no `hours`"
            raise self.table.error("file", problem)
        self.table.finish()
        return found, record


def _flat(table, where: str, data: dict) -> dict[str, Any]:
    """Flatten nested tables to dotted keys; a range {start, stop, count} is a value."""
    out: dict[str, Any] = {}
    for key, value in data.items():
        inner = {key: value}
        # A `count` alone is the number of bearings in a set.
        if isinstance(value, dict) and not {"start", "stop"} & set(value):
            flat = _flat(table, f"{where}.{key}", value)
            inner = {f"{key}.{name}": one for name, one in flat.items()}
        for name, one in inner.items():
            if name in out:  # a.b = 1 beside "a.b" = 2
                raise table.error(f"{where}.{name}", "stands there twice")
            out[name] = one
    return out


def _grid(table, data) -> list[VariedKey]:
    if not isinstance(data, dict) or not data:
        raise table.error("grid", f"{data!r} is not a table of keys with their values")
    axes = {}
    for key, value in _flat(table, "grid", data).items():
        if isinstance(value, dict):
            value = _range(table, key, value)
        elif not isinstance(value, list) or not value:
            problem = f"{value!r} is not a list of values, nor {{start, stop, count}}"
            raise table.error(f"grid.{key}", problem)
        axes[key] = value
    sizes = [len(values) for values in axes.values()]
    if math.prod(sizes) > MOST_CASES:
        problem = f"has {math.prod(sizes)} cases; at most {MOST_CASES}"
        raise table.error("grid", problem)
    grid = np.indices(sizes).reshape(len(sizes), -1)
    pairs = zip(axes.items(), grid, strict=True)
    return [VariedKey(key, values, index) for (key, values), index in pairs]


def _range(table, key, data) -> Any:
    path = f"grid.{key}"
    wanted = {"start", "stop", "count"}
    if set(data) != wanted:
        problem = f"has the keys {', '.join(data)}; a range has start, stop and count"
        raise table.error(path, problem)
    count = data["count"]
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= 10**6:
        raise table.error(path, f"`count` is {count!r}; a whole number from 2 to 10^6")
    ends = [data["start"], data["stop"]]
    if key in OPERATING and key != OIL:
        start, stop = VariedKey(key, ends, np.arange(2)).numbers(table)
        return np.linspace(start, stop, count)
    # The kind of design numbers is not known here: the unit is kept.
    parts = [_split_unit(end) for end in ends]
    if None in parts or parts[0][1] != parts[1][1]:
        problem = "`start` and `stop` must be numbers with one and the same unit"
        raise table.error(path, problem)
    unit = parts[0][1]
    numbers = np.linspace(parts[0][0], parts[1][0], count)
    if all(isinstance(end, int) for end in ends) and not (numbers % 1).any():
        return [int(x) for x in numbers]  # of counts
    return [float(x) if unit is None else f"{float(x)!r} {unit}" for x in numbers]


def _split_unit(value) -> Any:
    """Split into (number, unit), unit `None` for a bare number; `None` otherwise."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value), None
    match = re.fullmatch(r"\s*([-+\d.eE]+)\s*(\D.*?)\s*", str(value))
    try:
        return (float(match[1]), match[2]) if match else None
    except ValueError:
        return None


def _spectrum(table, data) -> list[VariedKey]:
    tables = isinstance(data, list) and all(isinstance(e, dict) for e in data)
    if not data or not tables:
        problem = "must be a list of tables, [[cases.spectrum]], one at least"
        raise table.error("spectrum", problem)
    entries = [_flat(table, f"spectrum[{k}]", e) for k, e in enumerate(data)]
    keys = list(dict.fromkeys(itertools.chain(*entries)))
    for k, entry in enumerate(entries):
        for key in keys:
            if key not in entry:
                problem = f"is missing; every entry must have {', '.join(keys)}"
                raise table.error(f"spectrum[{k}].{key}", problem)
    if "hours" not in keys:
        raise table.error("spectrum[0].hours", "is missing; a spectrum has hours")
    index = np.arange(len(entries))
    return [VariedKey(key, [entry[key] for entry in entries], index) for key in keys]

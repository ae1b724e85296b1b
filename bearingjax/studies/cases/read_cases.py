"""`[cases]` of a scene: many loads, displacements, speeds and designs.

A grid, a list (CSV) or a load spectrum. The varied keys are named as in the scene file,
`operating.load.Fy` or `bearing.radial_internal_clearance`.
"""

import copy
import dataclasses
import itertools
import math
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import jax
import numpy as np

from ...cases.cases import Cases
from ...cases.series import GAPS, Series, series_cases
from ...cases.spectrum import revolutions_per_hour
from ...cases.sweep import SUMMARIES, stack_designs
from ...design import rows_of
from ...element import FREEDOMS, LOADS, RINGS, BearingElement, Speed
from ...element.frame import LOAD_UNITS, MOTION_UNITS
from ...files.column_list import MOST_CASES, read_list
from ...files.quantity import QUANTITIES, SceneError, kind_of, to_si
from ...files.scene_errors import error_at
from ...files.scene_file import assign, find_scene, parse_bearing
from ...files.schema import Keys, read_keys, scene_key
from ...files.table import Table, text_of
from ...life.life import LIFE_OUTPUTS, Life
from ...numerics.labels import stated_axes
from ...numerics.units import CELSIUS, unit_of
from ...numerics.warning import Warning
from ...statics.solution import Solution
from ..bearing.read_scene import (
    Scene,
    check_equilibrium,
    control_warnings,
    scene_of,
)

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

_OIL = "lubricant.temperature"
_SWING = "oscillation.amplitude", "oscillation.frequency"

DESIGN = ("bearing", "set", "contact", "fit", "temperature")
"""Tables of the scene whose keys define the design."""

_SI_UNITS = {unit for unit, _ in QUANTITIES.values()}

MOST_DESIGNS = 10**5
"""Most designs of a scene: each is read and checked separately, in about 5 ms."""


@dataclasses.dataclass(frozen=True)
class DesignGroup:
    """Designs solved by one program: with the same classes, counts and parts, and the
    same catalogue bearing.

    Attributes:
        element: The bearing; of several designs, stacked by `stack_designs`.
        designs: Indices of these designs among all, ascending; `None` if the design
            does not vary.
        scene: Scene of the first design.
    """

    element: BearingElement[Any]
    designs: np.ndarray | None
    scene: Scene

    @property
    def designation(self) -> str | None:
        """Designation of the catalogue bearing, or `None`."""
        taken = self.scene.catalogue
        return None if taken is None else taken.entry.designation

    def cases_of(self, cases: Cases) -> np.ndarray:
        """Return the indices of the cases with one of these designs."""
        if self.designs is None:
            return np.arange(cases.count)
        return np.flatnonzero(np.isin(np.asarray(cases.design), self.designs))


@dataclasses.dataclass(frozen=True)
class CaseTable:
    """Contents of `[cases]`.

    Attributes:
        scene: The scene without its cases.
        design_groups: The bearing, preloaded and mounted; several designs are grouped
            by structure.
        cases: The cases.
        varied: Keys that vary, in order.
        settings: Settings of each design by "key [unit]": numbers in SI, or the text
            of the scene where it is not a number.
        outputs: Names of the outputs to keep, or `None` for the default.
        warnings: Warnings of suspicious but possible values, of all designs.
        series: The record in time whose cases these are, or `None`.
        row_name: What messages call its rows.
        inputs: The scene as it was read, in SI (`Scene.inputs`), with its cases as
            written.
    """

    scene: Scene
    design_groups: tuple[DesignGroup, ...]
    cases: Cases
    varied: tuple[str, ...]
    settings: tuple[dict[str, Any], ...]
    outputs: tuple[str, ...] | None
    warnings: tuple[Warning, ...]
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)
    series: Series | None = dataclasses.field(default=None, repr=False)
    row_name: Callable[[int], str] = "case {}".format


@dataclasses.dataclass(frozen=True)
class VariedKey:
    """Values of one key: case k takes `values[index[k]]`."""

    key: str
    values: Sequence[Any] | np.ndarray
    index: np.ndarray


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
        "path of a CSV with a row for each case, its header such as"
        " `operating.load.Fy [kN]`; with a column `time` (CSV or Parquet) of a record,"
        " each row of which holds until the next one"
    )
    gaps: str = scene_key(
        "gaps and rows without a number in a record: `refuse`; `leave_out`, not"
        " counted; `hold`, as the row before them",
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
            known = {k: v for k, v in OPERATING.items() if may_record or k != _OIL}
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


def read_cases(source: str | Path, settings: Iterable[str] = ()) -> CaseTable:
    """Read a scene with `[cases]`.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    return case_table(parse_bearing(path, settings), path)


def case_table(data: dict[str, Any], path: Path) -> CaseTable:
    """Read a scene with `[cases]` that is parsed.

    Raises: as `read_cases`.
    """
    if "cases" not in data:
        raise SceneError(
            f"{path.name}: `cases` is missing; it must be a table with one of `grid`,"
            " `file` or `spectrum`"
        )
    keys = read_keys(CasesKeys, Table(data, path).table("cases"))
    table, outputs = keys.table, keys.outputs
    columns, record = keys.columns(path)
    named = "case {}".format
    if record:
        lines, named = record["line"], lambda row: f"line {lines[row]}"
    data = _fill_first_values(data, columns, path.name)
    scene = scene_of(data, path)
    for column in columns:
        check_varied_key(table, column.key, scene)
    design_groups, design, made, warned = _designs(data, path, columns, scene)
    _check_outputs(table, outputs, design_groups)
    count = columns[0].index.size
    cases = cases_of_columns(table, scene, columns, design, count, named)
    series = None
    if record:
        how: Any = {"gaps": keys.gaps, "row_name": named}
        with table.building(time="file"):
            series = series_cases(record["time"], cases, **how)
        cases = series.cases
    if any(np.any(x) for x in (cases.inner_speed, cases.outer_speed) if x is not None):
        numerics = Table(data, path).table("numerics")
        check_equilibrium(numerics, scene.element, Speed(1.0, 1.0))
    else:
        warned += control_warnings(data)
    warned += speed_warnings(design_groups, cases)
    return CaseTable(
        scene=scene,
        design_groups=design_groups,
        cases=cases,
        varied=tuple(column.key for column in columns),
        settings=made,
        outputs=outputs,
        warnings=_merge_warnings(scene.warnings, warned),
        inputs=_inputs(scene, columns, _with_path(data["cases"], path)),
        series=series,
        row_name=named,
    )


def _fill_first_values(
    data: dict[str, Any], columns: list[VariedKey], file: str
) -> dict[str, Any]:
    """Fill in the first value of each varied key that the scene does not give: a
    varied interference need not be repeated in [fit]."""
    begun = copy.deepcopy(data)
    for column in columns:
        if makes_design(column.key) and not _has_key(data, column.key):
            assign(begun, column.key, column.values[column.index[0]], file)
    return begun


def _has_key(data: dict[str, Any], key: str) -> bool:
    """Whether a dotted key is present."""
    inner: Any = data
    for part in key.split("."):
        if isinstance(inner, list) and part.isdecimal() and int(part) < len(inner):
            inner = inner[int(part)]
        elif isinstance(inner, dict) and part in inner:
            inner = inner[part]
        else:
            return False
    return True


def makes_design(key: str) -> bool:
    """Whether a key belongs to a table that defines the design."""
    return "." in key and key.partition(".")[0] in DESIGN


def speed_warnings(
    design_groups: Sequence[DesignGroup], cases: Cases
) -> tuple[Warning, ...]:
    """Return warnings of case speeds above the catalogue speeds of each bearing."""
    turns, found = turns_of(cases), []
    for name in dict.fromkeys(part.designation for part in design_groups):
        mine = [
            part.cases_of(cases) for part in design_groups if part.designation == name
        ]
        own = np.zeros(cases.count)
        own[np.concatenate(mine)] = turns[np.concatenate(mine)]
        bearing = next(
            p.scene for p in design_groups if p.designation == name
        ).installed
        found += bearing.speed_warnings(own)
    return tuple(found)


def turns_of(cases: Cases) -> np.ndarray:
    """Return the relative speed of the rings (case,) [rad/s]."""
    turns = revolutions_per_hour(cases, np)
    return np.zeros(cases.count) if turns is None else turns * np.pi / 1800.0


def _merge_warnings(
    first: Iterable[Warning], warned: Sequence[Warning]
) -> tuple[Warning, ...]:
    """Merge the warnings of a scene and of its designs; of those that differ only in
    their numbers the first is kept."""
    found: dict[str, list[Warning]] = {}
    for one in dict.fromkeys((*first, *warned)):
        found.setdefault(re.sub(r"\d[\d.e+-]*", "#", one), []).append(one)
    return tuple(
        one.followed_by(f" ({1 + len(more)} designs alike)") if more else one
        for one, *more in found.values()
    )


def _inputs(scene, columns, cases) -> dict[str, Any]:
    """Return the echo of a scene with its cases; prescribed freedoms are not free."""
    keys = [column.key for column in columns]
    given = [f for f in FREEDOMS if f"operating.prescribed.{f}" in keys]
    operating = dict(scene.inputs["operating"])
    operating["free"] = [f for f in operating["free"] if f not in given]
    return {**scene.inputs, "operating": operating, "cases": cases}


def _with_path(cases, path) -> dict[str, Any]:
    """Return the cases as written, with an absolute path of their file."""
    name = text_of(cases.get("file"))
    return {**cases, "file": str((path.parent / name).resolve())} if name else cases


def _check_outputs(table, outputs, design_groups) -> None:
    """Reject outputs per rolling element if the number of elements varies."""
    sizes = {
        tuple(row.bearing.n_elements for row in rows_of(part.element.bearing))
        for part in design_groups
    }
    if len(sizes) == 1:
        return
    lives = [field for field in dataclasses.fields(Life) if field.name in LIFE_OUTPUTS]
    fields = filter(_is_whole, (*dataclasses.fields(Solution), *lives))
    whole = (*(field.name for field in fields), *SUMMARIES)
    for name in outputs or ():
        if name not in whole:
            problem = (
                f"{name!r} is of each rolling element or row, and their number varies"
                f" from case to case; those that can be kept then: {', '.join(whole)}"
            )
            raise table.error("outputs", problem)


def _is_whole(field) -> bool:
    """Whether an output has no axis whose length is that of a bearing."""
    sizes = [axis.rpartition("=")[2] for axis in stated_axes(field.type) or ()]
    return "unit" in field.metadata and all(size.isdecimal() for size in sizes)


def check_varied_key(table: Table, key: str, scene: Scene) -> None:
    """Raise SceneError unless a key of the scene can vary from case to case."""
    if key in OPERATING:
        name = key.rpartition(".")[2]
        if key.startswith("operating.prescribed.") and name in (scene.free or ()):
            raise table.error(key, f"{name} is free in this scene; choose one")
        if name in LOADS and FREEDOMS[LOADS.index(name)] in scene.prescribed:
            freedom = FREEDOMS[LOADS.index(name)]
            problem = f"{name} acts on {freedom}, which is prescribed; choose one"
            raise table.error(key, problem)
        return
    if makes_design(key):
        return
    allowed = ", ".join(
        ["operating.load.Fx", "operating.prescribed.ux", "operating.inner_speed"]
    )
    raise table.error(
        key,
        f"cannot vary; what can: {allowed} and the like, hours (file and spectrum),"
        f" and keys of {', '.join(DESIGN)}",
    )


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
    if key in OPERATING and key != _OIL:
        start, stop = _numbers(table, VariedKey(key, ends, np.arange(2)))
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


def _designs(data, path, columns, scene):
    """Return structures, design of each case, settings and warnings of all designs.

    Where the design does not vary, it is that of `scene`.
    """
    varied = [c for c in columns if c.key not in OPERATING or _changes_fit(data, c.key)]
    if not varied:
        return (DesignGroup(scene.running(), None, scene),), None, ({},), ()
    # Repeated values are merged, and so are repeated designs.
    codes = []
    for column in varied:
        distinct = {v: k for k, v in enumerate(dict.fromkeys(map(repr, column.values)))}
        code = np.array([distinct[repr(value)] for value in column.values])
        codes.append(code[column.index])
    _, first, design = np.unique(
        np.stack(codes), axis=1, return_index=True, return_inverse=True
    )
    if len(first) > MOST_DESIGNS:
        problem = f"make {len(first)} designs; at most {MOST_DESIGNS}"
        raise error_at(path, "cases", problem)
    made, elements, scenes, warned = [], [], [], []
    for case in first:
        settings = {c.key: c.values[c.index[case]] for c in varied}
        changed = copy.deepcopy(data)
        for key, value in settings.items():
            # The speeds of a range are already numbers.
            speed = key in OPERATING and not isinstance(value, str)
            assign(changed, key, f"{value} rad/s" if speed else value, path.name)
        scene = scene_of(changed, path, settings)
        pairs = [
            _resolve(scene.inputs, key, given)
            for key, given in settings.items()
            if key not in OPERATING
        ]
        made.append(dict(pairs))
        elements.append(scene.running())
        scenes.append(scene)
        warned += scene.warnings
    alike: dict[Any, list[int]] = {}
    for number, element in enumerate(elements):
        shapes = tuple(np.shape(leaf) for leaf in jax.tree.leaves(element))
        key = jax.tree.structure(element), shapes, _published_speeds(scenes[number])
        alike.setdefault(key, []).append(number)
    design_groups = tuple(
        DesignGroup(
            stack_designs([elements[k] for k in numbers]),
            np.array(numbers),
            scenes[numbers[0]],
        )
        for numbers in alike.values()
    )
    return design_groups, design.reshape(-1), tuple(made), tuple(warned)


def _published_speeds(scene: Scene) -> tuple[Any, ...]:
    """Return the published speeds of a design."""
    if scene.catalogue is None:
        return ()
    return scene.catalogue.entry.limiting_speed, scene.catalogue.entry.reference_speed


def _resolve(inputs: dict[str, Any], key: str, given: Any) -> tuple[str, Any]:
    """Return header and value of a setting: a number in SI, or text as given."""
    found: Any = inputs
    for part in key.split("."):
        if isinstance(found, list) and part.isdecimal():
            found = found[int(part)]
        else:
            found = found.get(part) if isinstance(found, dict) else None
    if isinstance(found, int | float) and not isinstance(found, bool):
        return key, found
    number, _, unit = found.partition(" ") if isinstance(found, str) else ("", "", "")
    # A designation, "7208 BE", is not a quantity.
    if unit not in _SI_UNITS:
        return key, str(given)
    return f"{key} [{unit}]", float(number)


def _changes_fit(data, key) -> bool:
    """Whether a key of [operating] changes the mounted bearing through its speed."""
    return "fit" in data and key.endswith("_speed")


def cases_of_columns(
    table: Table,
    scene: Scene,
    columns: Iterable[VariedKey],
    design: Any,
    count: int,
    named: Callable[[int], str] = "case {}".format,
) -> Cases:
    """Return so many cases: those of the scene, with what varies.

    Args:
        table: For errors.
        scene: The scene.
        columns: What varies.
        design: Which of several designs each case has, or `None`.
        count: Number of cases.
        named: Name of a case in errors.
    """
    load = np.tile(np.array(scene.load), (count, 1))
    prescribed: dict[str, Any] = {
        name: np.full(count, value) for name, value in scene.prescribed.items()
    }
    speeds: dict[str, Any] = {}
    if scene.speed is not None:
        for ring in RINGS:
            value = float(getattr(scene.speed, ring))
            speeds[f"{ring}_speed"] = np.full(count, value)
    hours, more = None, {}
    for column in columns:
        if column.key not in OPERATING:
            continue
        values = _numbers(table, column)[column.index]
        name = column.key.rpartition(".")[2]
        if column.key == "hours":
            hours = values
        elif column.key in (*_SWING, _OIL):
            more[column.key] = values
        elif name in LOADS:
            load[:, LOADS.index(name)] = values
        elif name in FREEDOMS:
            prescribed[name] = values
        else:
            speeds[name] = values
    if any(key in more for key in _SWING):
        speeds |= _oscillation(table, more, speeds, named, count)
    temperature = more.get(_OIL)
    if temperature is not None:
        speeds["viscosity"] = _viscosities(table, scene, temperature)
    with table.building():
        return Cases(load, prescribed=prescribed, hours=hours, design=design, **speeds)


def _oscillation(table, more, speeds, named, count) -> dict[str, Any]:
    """Return amplitudes and mean speeds of cases that oscillate; others have 0 deg."""
    for key in _SWING:
        if key not in more:
            raise table.error(key, f"is missing beside the other of {_SWING}")
    swing, frequency = (more[key] for key in _SWING)
    inner, outer = (speeds.get(f"{r}_speed", np.zeros(count)) for r in RINGS[::-1])
    wrong = (swing < 0) | (swing > np.pi + 1e-9)
    turns = (inner != 0) | (outer != 0) | (frequency <= 0)
    wrong |= (swing > 0) & turns & np.isfinite(inner + outer + frequency)
    if wrong.any():
        k = int(np.argmax(wrong))
        problem = f"is {np.degrees(swing[k]):.6g} deg in {named(k)}; it must be 0"
        allowed = "or, at rings of 0 rpm and a frequency above 0 Hz, up to 180 deg"
        raise table.error(_SWING[0], f"{problem} {allowed}, half of the whole swing")
    mean = np.where(swing > 0, 2.0 / np.pi * swing * frequency, 0.0)
    return {"inner_speed": inner + mean, "oscillation": swing}


def _viscosities(table, scene, temperature) -> np.ndarray:
    """Return the viscosity of the oil in each case [m²/s]."""
    key, oil = _OIL, scene.oil
    if oil is None or scene.life is None or scene.life.viscosity is None:
        problem = "changes the life alone, which needs [lubricant] and"
        raise table.error(key, f"{problem} `life.contamination`")
    values, where = np.unique(temperature, return_inverse=True)
    found = np.asarray(jax.vmap(oil.lubricant.kinematic_viscosity)(values))
    wrong = (abs(values - 368.15) > 155.0) | (found >= 1)
    if wrong.any():
        given = f"is {values[np.argmax(wrong)] - CELSIUS:.6g} °C in a case"
        raise table.error(key, f"{given}; it must be -60 to 250 °C, the oil no glass")
    if len(values) > 1 and np.ptp(found) == 0:
        raise table.error(key, "varies, but not the viscosity of [lubricant]")
    return found[where]


def _numbers(table, column):
    if isinstance(column.values, np.ndarray):
        return column.values
    try:
        kind = OPERATING[column.key]
        return np.array([to_si(value, kind) for value in column.values])
    except SceneError as error:
        raise table.error(column.key, error) from error

"""`[cases]` of a scene: many loads, displacements, speeds and designs."""

import dataclasses
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import jax
import numpy as np

from ...cases.cases import Cases
from ...cases.series import Series, series_cases
from ...cases.spectrum import relative_speed
from ...cases.sweep import SUMMARIES
from ...design import rows_of
from ...element import FREEDOMS, LOADS, RINGS, Speed
from ...files.quantity import SceneError
from ...files.scene_file import find_scene, parse_bearing
from ...files.schema import read_keys
from ...files.table import Table, text_of
from ...life.life import LIFE_OUTPUTS, Life
from ...numerics.labels import stated_axes
from ...numerics.units import CELSIUS
from ...numerics.warning import Warning
from ...statics.solution import Solution
from ..bearing.read_scene import Scene, check_equilibrium, control_warnings, scene_of
from .case_keys import OIL, OPERATING, SWING, CasesKeys, VariedKey
from .designs import (
    DESIGN,
    DesignGroup,
    fill_first_values,
    makes_design,
    read_designs,
)


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


def read_cases(source: str | Path, settings: Iterable[str] = ()) -> CaseTable:
    """Read a scene with `[cases]`.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    data = parse_bearing(path, settings)
    if "cases" not in data:
        raise SceneError(
            f"{path.name}: `cases` is missing; it must be a table with one of `grid`,"
            " `file` or `spectrum`"
        )
    return case_table(data, path)


def case_table(data: dict[str, Any], path: Path) -> CaseTable:
    """Read a scene that is parsed; without `[cases]` its operation is one case.

    Raises: as `read_cases`.
    """
    listed = data.get("cases")
    columns, record, table = [], {}, Table(data, path)
    outputs = gaps = None
    if listed is not None:
        keys = read_keys(CasesKeys, table.table("cases"))
        table, outputs, gaps = keys.table, keys.outputs, keys.gaps
        columns, record = keys.columns(path)
    named = "case {}".format
    if record:
        lines, named = record["line"], lambda row: f"line {lines[row]}"
    data = fill_first_values(data, columns, path.name)
    scene = scene_of(data, path)
    for column in columns:
        check_varied_key(table, column.key, scene)
    groups, design, made, warned = read_designs(data, path, columns, scene)
    _check_outputs(table, outputs, groups)
    count = columns[0].index.size if columns else 1
    cases, series = cases_of_columns(table, scene, columns, design, count, named), None
    if record:
        with table.building(time="file"):
            series = series_cases(record["time"], cases, gaps=str(gaps), row_name=named)
        cases = series.cases
    if np.any(cases.inner_speed) or np.any(cases.outer_speed):
        numerics = Table(data, path).table("numerics")
        check_equilibrium(numerics, scene.element, Speed(1.0, 1.0))
    else:
        warned += control_warnings(data)
    warned += speed_warnings(groups, cases)
    return CaseTable(
        scene=scene,
        design_groups=groups,
        cases=cases,
        varied=tuple(column.key for column in columns),
        settings=made,
        outputs=outputs,
        warnings=_merge_warnings(scene.warnings, warned),
        inputs=_inputs(scene, columns, listed, path),
        series=series,
        row_name=named,
    )


def speed_warnings(
    design_groups: Sequence[DesignGroup], cases: Cases
) -> tuple[Warning, ...]:
    """Return warnings of case speeds above the catalogue speeds of each bearing."""
    turns, found = relative_speed(cases), []
    for name in dict.fromkeys(part.designation for part in design_groups):
        alike = [part for part in design_groups if part.designation == name]
        mine = np.concatenate([part.cases_of(cases) for part in alike])
        own = np.zeros(cases.count)
        own[mine] = turns[mine]
        found += alike[0].scene.installed.speed_warnings(own)
    return tuple(found)


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


def _inputs(scene, columns, listed, path) -> dict[str, Any]:
    """Return the echo of a scene with its cases as written, with an absolute path of
    their file; prescribed freedoms are not free."""
    if listed is None:
        return scene.inputs
    keys = [column.key for column in columns]
    given = [f for f in FREEDOMS if f"operating.prescribed.{f}" in keys]
    operating = dict(scene.inputs["operating"])
    operating["free"] = [f for f in operating["free"] if f not in given]
    name = text_of(listed.get("file"))
    own = {"file": str((path.parent / name).resolve())} if name else {}
    return {**scene.inputs, "operating": operating, "cases": {**listed, **own}}


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
    given = {c.key: c.numbers(table) for c in columns if c.key in OPERATING}

    def under(head: str) -> dict[str, Any]:
        return {k.removeprefix(head): v for k, v in given.items() if k.startswith(head)}

    load = np.tile(np.array(scene.load), (count, 1))
    for name, values in under("operating.load.").items():
        load[:, LOADS.index(name)] = values
    held = {name: np.full(count, value) for name, value in scene.prescribed.items()}
    rings = {} if scene.speed is None else vars(scene.speed)
    more: dict[str, Any] = {"hours": given.get("hours"), "design": design}
    for ring in RINGS:
        usual = np.full(count, float(rings[ring])) if rings else None
        more[f"{ring}_speed"] = given.get(f"operating.{ring}_speed", usual)
    if given.keys() & {*SWING}:
        more |= _oscillation(table, given, more, named, count)
    if OIL in given:
        more["viscosity"] = _viscosities(table, scene, given[OIL])
    with table.building():
        return Cases(load, prescribed=held | under("operating.prescribed."), **more)


def _oscillation(table, given, speeds, named, count) -> dict[str, Any]:
    """Return amplitudes and mean speeds of cases that oscillate; others have 0 deg."""
    for key in SWING:
        if key not in given:
            raise table.error(key, f"is missing beside {' and '.join(SWING)}")
    swing, frequency = (given[key] for key in SWING)
    rings = (speeds[f"{ring}_speed"] for ring in RINGS[::-1])
    inner, outer = (np.zeros(count) if x is None else x for x in rings)
    wrong = (swing < 0) | (swing > np.pi + 1e-9)
    turns = (inner != 0) | (outer != 0) | (frequency <= 0)
    wrong |= (swing > 0) & turns & np.isfinite(inner + outer + frequency)
    if wrong.any():
        k = int(np.argmax(wrong))
        problem = f"is {np.degrees(swing[k]):.6g} deg in {named(k)}; it must be 0"
        allowed = "or, at rings of 0 rpm and a frequency above 0 Hz, up to 180 deg"
        raise table.error(SWING[0], f"{problem} {allowed}, half of the whole swing")
    mean = np.where(swing > 0, 2.0 / np.pi * swing * frequency, 0.0)
    return {"inner_speed": inner + mean, "oscillation": swing}


def _viscosities(table, scene, temperature) -> np.ndarray:
    """Return the viscosity of the oil in each case [m²/s]."""
    key, oil = OIL, scene.oil
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

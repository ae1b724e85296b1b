"""Reader of a scene with [select]: requirements, and bearings to choose from."""

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...cases.cases import Cases
from ...catalogue.entry import CatalogueEntry, catalogue_entries
from ...catalogue.estimated_entry import SIZES as ESTIMATED
from ...catalogue.estimated_entry import estimated_entry
from ...decide.select import NUMBERS, SIZES, Requirements, unit_of_number
from ...files.column_list import read_list
from ...files.quantity import SceneError, kind_of
from ...files.scene_file import find_scene, is_shafts, parse_bearing, parse_scene
from ...files.schema import Keys, names_key, read_keys, scene_key
from ...files.schema_text import number_schema
from ...files.table import Table, not_among, text_of
from ...fits.fit_limits import CLEARANCE_CLASSES
from ...life import LifeConditions
from ...numerics.types import with_fields
from ...numerics.warning import Warning
from ...shafts import ShaftDesign
from ...statics import Installed, SolveOptions, Support
from ..bearing.placed_bearing import COMMON, read_machine_bearing
from ..bearing.read_bearing import EXTRA_KEYS
from ..bearing.read_design import BALLS, ROLLERS
from ..bearing.read_scene import scene_of
from ..cases.case_keys import OPERATING
from ..cases.read_cases import CaseTable, case_table
from ..shaft.read import OF_SEAT, shafts_of

_COLUMNS = "designation", "type", *SIZES, "C", "C0"
"""Columns that a user's table of bearings must have."""

_OWN = {"mass": "mass", "limiting_speed": "speed"}
"""Optional columns of it with their kinds of quantities; `maker` is another one."""

_GIVEN = ("operating", "fit", "life", "contact", "numerics")
"""Tables whose defaults depend on the bearing."""

_SENSES = {"exact": "exact", "least": "the least allowed", "most": "the most allowed"}


def _bound_key(name: str) -> Any:
    """Return the key of a bound: one number, or a table of both ends."""
    (_, sense, about), unit = NUMBERS[name], unit_of_number(name)
    kind = kind_of(unit.replace("rev", ""))  # revolutions are bare numbers

    def read(table: Table, key: str) -> Any:
        if isinstance(table.raw(key, None), Mapping):
            held = table.table(key)
            return tuple(read(held, end) for end in ("at_least", "at_most"))
        return table.quantity(key, kind, None)

    json = {"anyOf": [number_schema(kind), {"type": "object"}]}
    text = f"{about}; a number is {_SENSES[sense]}; or `{{ at_least, at_most }}`"
    return scene_key(text, default=None, reader=read, json=json)


_BOUNDS: dict[str, Any] = {name: _bound_key(name) for name in NUMBERS}
_BOUNDS["about"] = "[select]: requirements on a bearing of the catalogue"
_BOUNDS["__annotations__"] = dict.fromkeys(NUMBERS, Any)
_BoundKeys: Any = type("BoundKeys", (Keys,), _BOUNDS)


class PositionKeys(_BoundKeys):
    types: tuple[str, ...] | None = scene_key(
        "types that may be chosen", choices=(*BALLS, *ROLLERS), otherwise="all"
    )
    rank_by: tuple[str, ...] | None = scene_key(
        "numbers by which those that fit are ranked, the later ones to break ties",
        choices=(*NUMBERS,),
        otherwise="the outside diameter, then the width",
    )
    clearance_class: str | None = scene_key(
        "class of radial clearance; excludes types without classes",
        choices=CLEARANCE_CLASSES,
    )


class SelectKeys(PositionKeys):
    file: str | None = scene_key(
        "path of a CSV table of your own bearings: `designation`, `type`, `bore [mm]`,"
        " `outside_diameter [mm]`, `width [mm]`, `C [kN]`, `C0 [kN]`, and optionally"
        " `mass [kg]`, `limiting_speed [rpm]`, `maker`"
    )


class ShaftSelectKeys(SelectKeys):
    about = "[select] of a system of shafts: requirements on bearings at its positions"

    positions: Any = names_key(
        "positions whose bearings are chosen, by name, each with the keys of [select]"
        " that differ there",
        name="positions",
        required=True,
    )
    short_list: int = scene_key(
        "number of bearings of each position that are combined with the others",
        default=3,
    )


_CHOICES = "types", "rank_by", "clearance_class"
"""Keys of a choice beside the bounds of numbers."""


class Choice(NamedTuple):
    """Arguments of `select` or `select_positions` by [select] of a scene.

    Attributes:
        name: Name of the scene.
        requirements: Requirements on a bearing; for shafts by position, as of
            `select_positions`.
        entries: Bearings to choose from.
        install: Function from an entry to the bearing on the seats of the scene; for
            shafts from a position and an entry.
        written: The scene as it stands in its file.
        inputs: The scene as it was read.
        designs: System of shafts in each case; empty for a bearing alone.
        options: Further arguments of `select_positions`.
        warnings: Warnings of the scene; there are none.
    """

    name: str
    requirements: Any
    entries: tuple[CatalogueEntry, ...]
    install: Callable[..., Installed]
    written: Mapping[str, Any]
    inputs: dict[str, Any]
    designs: tuple[ShaftDesign, ...] = ()
    options: Any = None
    warnings: tuple[Warning, ...] = ()


def read_select(source: str | Path, settings: Iterable[str] = ()) -> Choice:
    """Read a scene with [select], of a bearing or of a system of shafts.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    data = parse_scene(path, settings)
    if is_shafts(data):
        return _read_positions(data, path)
    data = parse_bearing(path, settings)
    top = Table(data, path)
    keys = read_keys(SelectKeys, top.table("select", required=True))
    table, given = keys.table, keys.given
    for name in ("bearing", "set", "output"):
        if name in top:
            raise top.error(name, "stands beside [select], which chooses the bearing")
    if "operating" not in data and "cases" not in data:
        raise top.error("operating", "is missing; a choice needs a load")
    shared = {name: value for name, value in data.items() if name != "select"}
    entries = (*catalogue_entries(), *_own_entries(table, keys.file, path))
    table.finish()

    def scene_for(entry: CatalogueEntry) -> dict[str, Any]:
        return shared | {"bearing": {"designation": entry}}

    def install(entry: CatalogueEntry) -> Installed:
        return scene_of(scene_for(entry), path).installed

    kinds = {entry.type: entry for entry in entries[::-1]}
    some = [kinds[name] for name in keys.types or kinds if name in kinds]
    common = _read_common(map(scene_for, some), path)
    scene = common.scene
    more = {} if scene.oil is None else {"supply": scene.oil.supply}
    more |= {k: given[k] for k in _CHOICES if k in given}
    with table.building(top):
        asked = Requirements(
            with_fields(common.cases, design=None),
            LifeConditions() if scene.life is None else scene.life,
            {name: given[name] for name in NUMBERS if name in given},
            support=Support(scene.free, fixed_ring=scene.fixed_ring),
            options=SolveOptions(tolerance=scene.tolerance),
            **more,
        )
    inputs = {k: v for k, v in common.inputs.items() if k not in ("bearing", "output")}
    for name in _GIVEN:
        kept = shared.get(name, {})
        inputs[name] = {k: v for k, v in inputs.get(name, {}).items() if k in kept}
    inputs = {k: v for k, v in inputs.items() if v} | {"select": table.echo()}
    return Choice(path.stem, asked, entries, install, data, inputs)


def _read_positions(data: dict[str, Any], path: Path) -> Choice:
    """Read a scene of shafts with [select]."""
    top, scene = Table(data, path), shafts_of(data, path)
    keys = read_keys(ShaftSelectKeys, top.table("select", required=True))
    if scene.heat is not None:
        problem = "stands beside [select], which takes temperatures as they are given"
        raise top.error("heat", f"{problem}; choose without it, then run `shaft`")
    own, seats, shared = dict[str, Any](), data["bearings"], keys.table.keys_given()
    each = scene.cases or (scene,)
    entries = (*catalogue_entries(), *_own_entries(keys.table, keys.file, path))
    alone = dict(zip(seats, scene.bearings, strict=True))
    for name in keys.positions.keys():
        bearing = alone.get(name)
        if bearing is None:
            problem = "has springs, which no catalogue lists"
            problem = problem if name in seats else not_among(name, [*seats])
            raise keys.positions.error(name, problem)
        table = keys.positions.table(name)
        both = {k: v for k, v in shared.items() if k in (*NUMBERS, *_CHOICES)}
        both = table.with_values(both | table.keys_given())
        given = read_keys(PositionKeys, both).given
        table.finish()
        given["bounds"] = {k: given.pop(k) for k in NUMBERS if k in given}
        life, speed = bearing.life, None if scene.system.inertia is None else 1.0
        wanted = (life.required, life.required_revolutions) if life else (None, None)
        life = each[0].lives[[*seats].index(name)] or LifeConditions()
        life = with_fields(life, required=wanted[0], required_revolutions=wanted[1])
        with table.building(top):  # checked with any load, as its own is not known yet
            asked = Requirements(Cases(np.eye(1, 6), inner_speed=speed), life, **given)
        own[name] = given | {"bounds": asked.all_bounds}
    keys.table.finish()
    hours = [one.hours for one in each]
    common = {k: data[k] for k in (*COMMON, "output") if k in data}
    of_seat = (*OF_SEAT, *EXTRA_KEYS, *COMMON)
    kept = {
        n: {k: v for k, v in one.items() if k in of_seat} for n, one in seats.items()
    }

    def install(name: str, entry: CatalogueEntry) -> Installed:
        changed = {**common, "bearings": {name: {**kept[name], "designation": entry}}}
        whole = Table(changed, path)
        place = whole.table("bearings").table(name)
        return read_machine_bearing(whole, place, name, path, OF_SEAT).installed

    options = {"hours": None if None in hours else hours, "short_list": keys.short_list}
    options |= {"rank_by": keys.rank_by} if keys.rank_by else {}
    designs = tuple(ShaftDesign(one.system, one.lives) for one in each)
    inputs = {**scene.inputs, "select": keys.table.echo()}
    return Choice(path.stem, own, entries, install, data, inputs, designs, options)


def _read_common(scenes: Iterable[dict[str, Any]], path: Path) -> CaseTable:
    """Read what all bearings have in common, from the first scene that can be read."""
    refused: list[SceneError] = []
    for data in scenes:
        try:
            found = case_table(data, path)
        except SceneError as error:
            refused.append(error)
            continue
        for key in found.varied:
            if key not in OPERATING:
                problem = "cannot vary in a choice; loads, displacements, speeds can"
                raise Table(data, path).table("cases").error(key, problem)
        return found
    raise refused[0]


def _own_entries(table: Table, name: str | None, path: Path) -> list[CatalogueEntry]:
    """Read the user's table of bearings, and estimate their internal geometry."""
    if name is None:
        return []
    found = read_list(table, path.parent, _OWN, "bearings")
    table.fill("file", str((path.parent / name).resolve()))
    for column in (*_COLUMNS, *found):
        if column not in found:
            raise table.error("file", f"{name}: has no column {column}")
        if column not in (*_COLUMNS, *_OWN, "maker"):
            raise table.error("file", f"{name}: column {column} is not known")
    entries = []
    for k in range(len(found["type"])):
        row = {column: text_of(values[k]) for column, values in found.items()}
        called, kind, *sizes = (str(row[column]) for column in _COLUMNS)
        own: dict[str, Any] = {n: row[n] for n in _OWN if n in row}
        try:
            entry = estimated_entry(kind, dict(zip(ESTIMATED, sizes, strict=True)))
        except SceneError as error:
            problem = f"{name}: bearing {k + 1}, {called}: {error}"
            for option, column in zip(("type", *ESTIMATED), _COLUMNS[1:], strict=True):
                problem = problem.replace(f"--{option.replace('_', '-')}", column)
            raise table.error("file", problem) from error
        own["sources"] = entry.sources | {"capacity": str(row.get("maker", name))}
        entries.append(dataclasses.replace(entry, designation=called, **own))
    return entries

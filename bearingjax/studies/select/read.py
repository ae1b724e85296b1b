"""A scene with [select]: what a bearing must do, and among which it is chosen."""

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ...cases import Cases
from ...catalogue.entry import CatalogueEntry, catalogue_entries
from ...catalogue.estimated_entry import SIZES as ESTIMATED
from ...catalogue.estimated_entry import estimated_entry
from ...decide.select import NUMBERS, SIZES, Requirements, unit_of_number
from ...design import rows_of
from ...design.published import with_published
from ...files.column_list import read_list
from ...files.quantity import QUANTITIES, SceneError, kind_of
from ...files.scene_file import find_scene, parse_bearing
from ...files.schema_text import number_schema, object_schema
from ...files.table import Table, text_of
from ...fits.fit_limits import CLEARANCE_CLASSES
from ...life import LifeConditions
from ...numerics.types import with_fields
from ...statics import Installed, SolveOptions, Support
from ..bearing.catalogue_keys import as_keys
from ..bearing.read_design import BALLS, ROLLERS
from ..bearing.read_scene import Scene, scene_of
from ..cases.read_cases import OPERATING, case_table

_KINDS = {
    name: kind_of(unit_of_number(name))
    for name in NUMBERS
    if unit_of_number(name) not in ("", "rev")  # bare numbers
}
"""Kinds of the numbers that are quantities."""

_OWN = {
    **{name: _KINDS[name] for name in (*SIZES, "mass")},
    **{"C": "force", "C0": "force", "limiting_speed": "speed"},
}
"""Columns of one's own bearings beside `designation`, `type` and `maker`, with their
kinds of quantities."""

_ENDS = ("at_least", "at_most")
_GIVEN = ("operating", "fit", "life", "contact", "numerics")
"""Tables whose defaults differ from bearing to bearing."""

_FILE = """path of a CSV of one's own bearings: `designation`, `type`, `bore [mm]`,
 `outside_diameter [mm]`, `width [mm]`, `C [kN]`, `C0 [kN]`, and where they are known
 `mass [kg]`, `limiting_speed [rpm]`, `maker`"""
_SENSES = {"exact": "exact", "least": "the least", "most": "the greatest"}
_MARK = "estimated, from its ratings"
"""Source of the inside of one's own bearings."""


class Choice(NamedTuple):
    """A scene with [select].

    Attributes:
        name: Name of the scene.
        requirements: What a bearing must do.
        entries: Bearings to choose from.
        install: Returns the bearing of an entry on the seats of the scene.
        written: [select] as it stands in the scene.
        inputs: The scene as it was read.
    """

    name: str
    requirements: Requirements
    entries: tuple[CatalogueEntry, ...]
    install: Callable[[CatalogueEntry], Installed]
    written: Mapping[str, Any]
    inputs: dict[str, Any]


def select_schema() -> dict[str, Any]:
    """Return the JSON Schema of [select]."""

    lists = {"types": ((*BALLS, *ROLLERS), "types that may be chosen")}
    lists["rank_by"] = (*NUMBERS,), "what comes first among those that fit"
    found: dict[str, Any] = {}
    for name, (_, sense, about) in NUMBERS.items():
        one = number_schema(_KINDS[name]) if name in _KINDS else {"type": "number"}
        text = f"{about}; {_SENSES[sense]}, or `{{ at_least, at_most }}`"
        found[name] = {"anyOf": [one, {"type": "object"}], "description": text}
    for name, (words, text) in lists.items():
        one = {"enum": [*words]}
        several = {"type": "array", "items": one}
        found[name] = {"anyOf": [one, several], "description": text}
    text = "class of radial clearance, of types that have classes"
    found["clearance_class"] = {"enum": [*CLEARANCE_CLASSES], "description": text}
    found["file"] = {"type": "string", "description": " ".join(_FILE.split())}
    return object_schema(found, [], "[select]: what a bearing must do to be chosen")


def read_select(source: str | Path, settings: Iterable[str] = ()) -> Choice:
    """Read a scene with [select].

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    data = parse_bearing(path, settings)
    top = Table(data, path)
    table = top.table("select", required=True)
    for name in ("bearing", "set", "output"):
        if name in top:
            raise top.error(name, "stands beside [select], which chooses the bearing")
    shared = {name: value for name, value in data.items() if name != "select"}
    entries = (*catalogue_entries(), *_own_entries(table, path))
    types = _words(table, "types", dict.fromkeys(entry.type for entry in entries))
    bounds = {name: _bounds(table, name) for name in NUMBERS if name in table}
    more: dict[str, Any] = {"types": types, "bounds": bounds}
    more["clearance_class"] = table.choice("clearance_class", CLEARANCE_CLASSES, None)
    if (ranks := _words(table, "rank_by", NUMBERS)) is not None:
        more["rank_by"] = ranks
    table.finish()

    def scene_for(entry: CatalogueEntry) -> dict[str, Any]:
        if entry.sources["geometry"] != _MARK:
            return shared | {"bearing": {"designation": entry.designation}}
        found = shared | {"bearing": as_keys(entry.design)}
        if "fit" in shared:
            sizes = {name: f"{getattr(entry, name)!r} m" for name in SIZES[:2]}
            found["fit"] = sizes | shared["fit"]
        return found

    def install(entry: CatalogueEntry) -> Installed:
        installed = scene_of(scene_for(entry), path).installed
        if entry.sources["geometry"] != _MARK:
            return installed
        drawn = installed.drawing
        ratings = entry.ratings_for(rows_of(drawn.bearing)[0].bearing)
        rated = with_fields(drawn, bearing=with_published(drawn.bearing, ratings))
        return dataclasses.replace(installed, drawing=rated)

    kinds = {entry.type: entry for entry in entries[::-1]}
    some = [kinds[name] for name in types or kinds]
    scene, cases = _read_common(map(scene_for, some), path)
    oil = {} if scene.oil is None else {"supply": scene.oil.supply}
    support = Support(scene.free, fixed_ring=scene.fixed_ring)
    options = SolveOptions(tolerance=scene.tolerance)
    life = LifeConditions() if scene.life is None else scene.life
    with table.building(top):
        if "operating" not in shared and "cases" not in shared:
            raise top.error("operating", "is missing; a choice needs a load")
        more |= {"support": support, "options": options, **oil}
        asked = Requirements(cases, life, **more)
    inputs = {k: v for k, v in scene.inputs.items() if k not in ("bearing", "output")}
    for name in _GIVEN:
        kept = shared.get(name, {})
        inputs[name] = {k: v for k, v in inputs.get(name, {}).items() if k in kept}
    inputs["select"] = table.echo()
    inputs = {name: part for name, part in inputs.items() if part != {}}
    return Choice(path.stem, asked, entries, install, data["select"], inputs)


def _read_common(scenes: Iterable[dict[str, Any]], path: Path) -> tuple[Scene, Cases]:
    """Read what all bearings have in common, of the first that it suits."""
    refused = []
    for data in scenes:
        try:
            if "cases" not in data:
                scene = scene_of(data, path)
                rings = {} if scene.speed is None else vars(scene.speed)
                speeds = {f"{name}_speed": float(x) for name, x in rings.items()}
                return scene, Cases([scene.load], prescribed=scene.prescribed, **speeds)
            table = case_table(data, path)
        except SceneError as error:
            refused.append(error)
            continue
        for key in table.varied:
            if key not in OPERATING:
                problem = "cannot vary in a choice; loads, displacements, speeds can"
                raise Table(data, path).table("cases").error(key, problem)
        scene = dataclasses.replace(table.scene, inputs=table.inputs)
        return scene, with_fields(table.cases, design=None)
    raise refused[0]


def _words(table: Table, name: str, known: Iterable[str]) -> tuple[str, ...] | None:
    """Read one of several words, or a list of them."""
    names = tuple(known)
    if table.word(name) is not None:
        return (table.choice(name, names),)
    return table.words(name, names)


def _bounds(table: Table, name: str) -> Any:
    """Read a number, or the pair of its bounds, in SI."""

    def read(held, key, *default):
        if name not in _KINDS:
            return held.number(key, *default)
        return held.quantity(key, _KINDS[name], *default)

    if not isinstance(table.raw(name), Mapping):
        return read(table, name)
    return tuple(read(table.table(name), end, None) for end in _ENDS)


def _own_entries(table: Table, path: Path) -> list[CatalogueEntry]:
    """Read one's own bearings, and estimate their insides."""
    if "file" not in table:
        return []
    found = read_list(table, path.parent, _OWN, "bearings")
    name = text_of(table.raw("file"))
    table.fill("file", str((path.parent / name).resolve()))
    columns = "designation", "type", *SIZES, "C", "C0"
    for column in (*columns, *found):
        if column not in found:
            raise table.error("file", f"{name}: has no column {column}")
        if column not in (*columns, *_OWN, "maker"):
            raise table.error("file", f"{name}: column {column} is not known")
    entries = []
    for k, kind in enumerate(found["type"]):
        row = {column: values[k] for column, values in found.items()}
        given = dict(zip(ESTIMATED, [row[c] for c in columns[2:]], strict=True))
        units = {n: QUANTITIES[unit][0] for n, unit in ESTIMATED.items()}
        texts = {n: f"{float(x)!r} {units[n]}" for n, x in given.items()}
        called = str(text_of(row["designation"]))
        try:
            entry = estimated_entry(str(kind), texts)
        except SceneError as error:
            problem = f"{name}: bearing {k + 1}, {called}: {error}"
            raise table.error("file", problem) from error
        own = {n: float(row[n]) for n in ("mass", "limiting_speed") if n in row}
        source = {"capacity": str(row.get("maker", name)), "geometry": _MARK}
        own |= {"designation": called, "sources": source}
        entries.append(dataclasses.replace(entry, **own))
    return entries

"""JSON Schema of whole scenes: of a bearing, of one contact, of a rotor."""

from typing import Any

from ..design import ARRANGEMENTS, MATERIALS, RIB_NAMES, Material, Rib
from ..element import RINGS
from .bearing_table import BALLS, PROFILES, ROLLERS, SetKeys, required_numbers
from .cases_table import CasesKeys
from .choices_table import (
    BallNumericsKeys,
    ControlKeys,
    LineContactKeys,
    PointContactKeys,
    RollerNumericsKeys,
)
from .fit_table import FitKeys, TemperatureKeys
from .life_table import LifeKeys
from .noise_table import VibrationKeys
from .operating_table import OperatingKeys, OutputKeys, SolveKeys
from .schema import Keys
from .schema_text import (
    DIALECT,
    class_schema,
    classes_schema,
    number_schema,
    object_schema,
    table_schema,
)


def scene_schema() -> dict[str, Any]:
    """JSON Schema of every scene."""
    kinds = _bearing_scene()
    return {"$schema": DIALECT, "title": "bearingjax scene", **kinds}


def _bearing_scene() -> dict[str, Any]:
    """Of a bearing: `solve`, `sweep`, `life`, `optimise`, `skid`, `noise`."""
    tables = {
        "bearing": _bearing(),
        "set": _set(),
        "contact": _merged(LineContactKeys, PointContactKeys),
        "operating": _merged(OperatingKeys, ControlKeys),
        "numerics": _merged(BallNumericsKeys, RollerNumericsKeys, SolveKeys),
        "fit": table_schema(FitKeys),
        "temperature": table_schema(TemperatureKeys),
        "life": table_schema(LifeKeys),
        "output": table_schema(OutputKeys),
        "cases": table_schema(CasesKeys),
        "vibration": table_schema(VibrationKeys),
    }
    return object_schema(tables, ["bearing"], "a bearing under load")


def _merged(*kinds: type[Keys]) -> dict[str, Any]:
    """One table whose keys several classes read."""
    first, *more = (table_schema(kind) for kind in kinds)
    properties = dict(first["properties"])
    for one in more:
        properties |= one["properties"]
    return object_schema(properties, [], first["description"])


def _set() -> dict[str, Any]:
    """Of a [set], whose rows may have bearings of their own."""
    found = table_schema(SetKeys)
    row = found["properties"]["rows"]["items"]
    row["properties"]["bearing"] = _bearing() | {"description": "keys as of [bearing]"}
    return found


def _bearing() -> dict[str, Any]:
    """Of a [bearing]: of each type, or of a designation."""
    variants = [_of_type(word, kind) for word, kind in {**BALLS, **ROLLERS}.items()]
    every: dict[str, Any] = {}
    for one in variants:
        every |= one["properties"]
    every["type"] = {"enum": [*BALLS, *ROLLERS]}
    name = {"type": "string", "description": "bearing of the catalogue"}
    about = "a bearing of the catalogue, of which single keys may be given otherwise"
    designated = object_schema({"designation": name, **every}, ["designation"], about)
    return {"anyOf": [*variants, designated]}


def _of_type(word: str, kind: type) -> dict[str, Any]:
    count = "n_balls" if word in BALLS else "n_rollers"
    more: dict[str, Any] = {
        count: {"type": "integer", "minimum": 1, "description": "rolling elements"}
    }
    if word in ROLLERS:
        profile = _said("profile of the rollers", {"anyOf": [*_profiles()]})
        raceway = _said("profile of the raceway", {"anyOf": [*_profiles()]})
        raceways = object_schema({ring: raceway for ring in RINGS}, [])
        rib, about = class_schema(Rib), "every rib of the `arrangement`"
        ribs = object_schema({name: rib for name in RIB_NAMES}, [], "ribs by name")
        more |= {"roller_profile": profile, "raceway_profile": raceways, "ribs": ribs}
        if word != "tapered_roller":
            letters = {"enum": [*ARRANGEMENTS]}
            more |= {
                "arrangement": _said("letters of the ribs: NU, NJ …", letters),
                "rib": _said(about, rib),
                "axial_internal_clearance": _said(
                    "axial play between the ribs", number_schema("length")
                ),
            }
    numbers = {"anyOf": [{"enum": [*MATERIALS]}, class_schema(Material)]}
    more["material"] = _said("material of the rolling elements", numbers)
    more["ring_material"] = _said("material of the rings, if another", numbers)
    found = class_schema(kind, word, **more)
    must = ("type", count, *required_numbers(word), *found["required"])
    return {**found, "required": [*dict.fromkeys(must)]}


def _profiles() -> list[dict[str, Any]]:
    """Profiles; without a `type` straight."""
    return [*classes_schema(PROFILES)["anyOf"][1:], object_schema({}, [])]


def _said(about: str, schema: dict[str, Any]) -> dict[str, Any]:
    return {**schema, "description": about}

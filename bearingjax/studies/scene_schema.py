"""JSON Schema of complete scenes: of a bearing, of one contact, of a rotor."""

from typing import Any

from ..design import MATERIALS, RIB_NAMES, Material, Rib
from ..design.rib import ARRANGEMENTS
from ..element import RINGS
from ..files.quantity import SceneError
from ..files.schema import Keys
from ..files.schema_text import (
    DIALECT,
    classes_schema,
    key_tables,
    number_schema,
    object_schema,
    table_schema,
)
from ..files.table import not_among
from ..life.life import LifeConditions
from ..shafts import Seat, ShaftLoad, ThermalPaths
from ..skid import Cage
from .bearing.read_bearing import SetKeys
from .bearing.read_choices import (
    BallNumericsKeys,
    ControlKeys,
    LineContactKeys,
    PointContactKeys,
    RollerNumericsKeys,
)
from .bearing.read_design import (
    BALLS,
    PROFILES,
    ROLLERS,
    SPHERES,
    WITH_LETTERS,
    required_numbers,
)
from .bearing.read_fit import FitKeys, TemperatureKeys
from .bearing.read_lubricant import LubricantKeys
from .bearing.read_operating import LoadKeys, OperatingKeys, OutputKeys, SolveKeys
from .cases.case_keys import CasesKeys
from .contact.read import (
    ContactNumericsKeys,
    ContactOperatingKeys,
    ContactOutputKeys,
    RacewayKeys,
    RollerKeys,
    SliceLawKeys,
)
from .identify.read_identify import IdentifyKeys
from .noise.read import VibrationKeys
from .noise.read_deviations import DeviationsKeys
from .optimise.read_optimise import OptimiseKeys
from .optimise.read_shaft_optimise import ShaftOptimiseKeys
from .rotor.mounts import SpringKeys
from .rotor.read import RotorKeys
from .select.read import SelectKeys, ShaftSelectKeys
from .shaft.read import (
    PART_CLASSES,
    DriveKeys,
    HousingKeys,
    SeatKeys,
    ShaftKeys,
    SystemKeys,
)
from .shaft.read_heat import HeatKeys
from .skid.read_dynamics import DynamicsKeys
from .tolerances.read import ShaftToleranceKeys, ToleranceKeys


def scene_schema() -> dict[str, Any]:
    """Return the JSON Schema of all scenes."""
    numbers = {"anyOf": [{"enum": [*MATERIALS]}, table_schema(Material)]}
    profiles = classes_schema(PROFILES)["anyOf"]
    defs = {
        "bearing": _bearing(),
        "set": _set(),
        "contact": _merge("laws of the contacts", LineContactKeys, PointContactKeys),
        "fit": table_schema(FitKeys),
        "temperature": table_schema(TemperatureKeys),
        "material": numbers,
        "profile": {"anyOf": [one for one in profiles if "properties" in one]},
        "rib": table_schema(Rib),
        "life": table_schema(LifeConditions),
        "lubricant": table_schema(LubricantKeys),
        "output": table_schema(OutputKeys),
        "cases": table_schema(CasesKeys),
        "identify": table_schema(IdentifyKeys),
        "operating": _merge("load, support and speeds", OperatingKeys, ControlKeys),
        "numerics": _merge("solvers", BallNumericsKeys, RollerNumericsKeys, SolveKeys),
    }
    head = {"$schema": DIALECT, "title": "Scene of bearingjax"}
    kinds = [_bearing_scene(), _contact_scene(), _rotor_scene(), _shaft_scene()]
    kinds.append(_select_scene())
    return {**head, "anyOf": kinds, "$defs": defs}


def key_guide(name: str = "") -> str:
    """Return the tables of scene keys, in Markdown.

    Args:
        name: Dotted name of one table, such as "operating.load", or of those that hold
            tables of any name, such as "bearings"; empty for all.

    Raises:
        SceneError: If there is no such table.
    """
    schema, found, pages = scene_schema(), [], []
    for kind in schema["anyOf"]:
        found.append((f"Scenes of {kind['description']}", [*key_tables(kind)]))
    parts = [t for word, one in schema["$defs"].items() for t in key_tables(one, word)]
    found.append(("Parts of several scenes", parts))
    for title, tables in found:
        named = name, f"{name}.NAME"
        chosen = [text for path, text in tables if not name or path in named]
        pages += chosen if name else [f"## {title}\n", *chosen]
    if not pages:
        names = dict.fromkeys(path for _, tables in found for path, _ in tables)
        raise SceneError(f"schema: {not_among(name, tuple(names))}")
    return "\n".join(pages)


def _bearing_scene() -> dict[str, Any]:
    """Schema of a bearing: `solve`, `sweep`, `life`, `optimise`, `skid`, `noise`."""
    tables = {
        **_refs("bearing set contact operating numerics fit temperature lubricant"),
        **_refs("life output cases identify"),
        "optimise": table_schema(OptimiseKeys),
        "tolerances": table_schema(ToleranceKeys),
        "cage": table_schema(Cage),
        "dynamics": table_schema(DynamicsKeys),
        "deviations": table_schema(DeviationsKeys),
        "vibration": table_schema(VibrationKeys),
    }
    return object_schema(tables, ["bearing"], "a bearing")


def _select_scene() -> dict[str, Any]:
    """Schema of a choice of bearing: `select`."""
    names = "contact operating numerics fit temperature lubricant life cases"
    tables = {"select": table_schema(SelectKeys)} | _refs(names)
    return object_schema(tables, ["select"], "a choice of bearing")


def _contact_scene() -> dict[str, Any]:
    """Schema of one roller on one raceway: `contact`."""
    tables = {
        "roller": table_schema(RollerKeys),
        "raceway": table_schema(RacewayKeys),
        "operating": table_schema(ContactOperatingKeys),
        "numerics": table_schema(ContactNumericsKeys),
        "contact": table_schema(SliceLawKeys),
        "output": table_schema(ContactOutputKeys),
    }
    return object_schema(tables, ["roller"], "one roller on one raceway")


def _rotor_scene() -> dict[str, Any]:
    """Schema of a shaft on its bearings: `rotor`."""
    within = {
        **_refs("set contact fit temperature", "as of a bearing alone"),
        "numerics": _merge("solvers", BallNumericsKeys, RollerNumericsKeys),
        **table_schema(ControlKeys)["properties"],
    }
    within |= _refs("life lubricant")
    tables = {
        "rotor": table_schema(RotorKeys),
        "bearings": _by_name({**_ref("bearing", _NAMED), "properties": within}),
        **_refs("life lubricant output identify"),
    }
    return object_schema(tables, ["rotor"], "a shaft on its bearings")


_NAMED = "a bearing by its name: the keys of a bearing, and beside them"


def _by_name(schema: dict[str, Any]) -> dict[str, Any]:
    """Schema of tables by name."""
    return {"type": "object", "additionalProperties": schema}


def _shaft_scene() -> dict[str, Any]:
    """Schema of a system of shafts: `shaft`, `optimise`."""
    place = {
        "shaft": {"type": "string", "description": "name of its shaft"},
        "position": {
            **number_schema("length"),
            "description": "place along the shaft, from its first segment",
        },
        "station": {
            "type": "integer",
            "minimum": 0,
            "description": "in place of it: 0 is the start, k the end of segment k",
        },
    }
    tables = {"shaft": _by_name(table_schema(ShaftKeys))}
    for key, kind in PART_CLASSES.items():
        here = dict(place) if key != "coupling" else {"shaft": place["shaft"]}
        if kind is ShaftLoad:
            here |= table_schema(LoadKeys)["properties"]
        tables[key] = _by_name(table_schema(kind, **here))
    heat = table_schema(ThermalPaths)
    del heat["required"]
    own = {
        **place,
        **table_schema(Seat)["properties"],
        **table_schema(SeatKeys)["properties"],
        "heat": heat,
    }
    within = _rotor_scene()["properties"]["bearings"]["additionalProperties"]
    bearing = {**within, "properties": own | within["properties"]}
    springs = {**place, "stiffness": table_schema(SpringKeys)}
    springs["housing"] = own["housing"]
    springs = object_schema(springs, ["stiffness"], "springs in place of a bearing")
    del own["stiffness"]
    tables |= {
        "bearings": _by_name({"anyOf": [bearing, springs]}),
        "drive": table_schema(DriveKeys),
        "housing": table_schema(HousingKeys),
        "system": table_schema(SystemKeys),
        "heat": table_schema(HeatKeys),
        "optimise": table_schema(ShaftOptimiseKeys),
        "tolerances": table_schema(ShaftToleranceKeys),
        "select": table_schema(ShaftSelectKeys),
        **_refs("life lubricant output cases identify"),
    }
    return object_schema(tables, ["shaft", "bearings"], "a system of shafts")


def _merge(about: str, *kinds: type[Keys]) -> dict[str, Any]:
    """Schema of a table whose keys are read by several classes."""
    first, *more = (table_schema(kind) for kind in kinds)
    properties = dict(first["properties"])
    for one in more:
        properties |= one["properties"]
    return object_schema(properties, [], about)


def _set() -> dict[str, Any]:
    """Schema of a [set], whose rows may define separate bearings."""
    found = table_schema(SetKeys)
    row = found["properties"]["rows"]["items"]
    row["properties"]["bearing"] = _ref("bearing", "bearing of this row alone")
    return found


def _bearing() -> dict[str, Any]:
    """Schema of a [bearing]: of each type, or by designation."""
    variants = [_of_type(word, kind) for word, kind in {**BALLS, **ROLLERS}.items()]
    every: dict[str, Any] = {}
    for one in variants:
        every |= one["properties"]
    every["type"] = {"enum": [*BALLS, *ROLLERS]}
    name = {"type": "string", "description": "bearing of the catalogue"}
    about = "a bearing of the catalogue, of which single keys may be given otherwise"
    designated = object_schema({"designation": name, **every}, ["designation"], about)
    # A table with a bearing may hold further keys (`_ref`).
    open_ones = [
        {key: part for key, part in one.items() if key != "additionalProperties"}
        for one in (*variants, designated)
    ]
    return {"anyOf": open_ones}


def _of_type(word: str, kind: type) -> dict[str, Any]:
    more: dict[str, Any] = {}
    if word in ROLLERS:
        raceway = _ref("profile", "profile of the raceway")
        ribs = {name: _ref("rib") for name in RIB_NAMES}
        more |= {
            "roller_profile": _ref("profile", "profile of the rollers"),
            "raceway_profile": object_schema(dict.fromkeys(RINGS, raceway), []),
        }
        if word != "crossed_roller":
            more["ribs"] = object_schema(ribs, [], "ribs by name")
        if word == "spherical_roller":
            about = "whether rollers of one row stand between those of the other"
            staggered = {"type": "boolean", "description": about, "default": True}
            more["staggered"] = staggered
        if word in WITH_LETTERS:
            letters, play = {"enum": [*ARRANGEMENTS]}, number_schema("length")
            more |= {
                "arrangement": {**letters, "description": "letters of the ribs"},
                "rib": _ref("rib", "every rib of the `arrangement`"),
                "axial_internal_clearance": {
                    **play,
                    "description": "axial play between the ribs",
                },
            }
    more["material"] = _ref("material", "material of the rolling elements")
    more["ring_material"] = _ref("material", "material of the rings, if another")
    found = table_schema(kind, word, **more)
    must = dict.fromkeys(("type", *required_numbers(word), *found["required"]))
    if word in SPHERES:
        either = ("pitch_diameter", "outer_raceway_radius")
        found["properties"][either[0]]["x-otherwise"] = f"that of `{either[1]}`"
        found["anyOf"] = [{"required": [one]} for one in either]
        del must[either[0]]
    return {**found, "required": [*must]}


def _refs(names: str, about: str = "") -> dict[str, Any]:
    return {name: _ref(name, about) for name in names.split()}


def _ref(name: str, about: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {"$ref": f"#/$defs/{name}"}
    if name == "bearing":
        found["unevaluatedProperties"] = False
    return {**found, "description": about} if about else found

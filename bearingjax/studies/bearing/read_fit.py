"""The [fit] and [temperature] tables of a scene: seats of a bearing, temperatures."""

from typing import Any, NamedTuple

import jax

from ...catalogue.entry import CLEARANCE, class_limits
from ...design import (
    AbstractBearing,
    BearingSet,
    Material,
    TaperedRollerBearing,
    rows_of,
)
from ...design.bearing_set import (
    bearings_of,
    has_separate_rings,
    shares_rings,
    with_bearings,
)
from ...element import Speed
from ...files.quantity import SceneError, scene_number
from ...files.schema import Keys, build, key_of, read_keys, scene_key
from ...files.schema_text import number_schema, table_schema
from ...files.table import Table
from ...fits import (
    CLEARANCE_CLASSES,
    LIMIT_CLASSES,
    PLACES,
    WARM_MATERIALS,
    FitConditions,
    Limits,
    Mounting,
    SizeLimits,
    WarmMaterial,
    bore_limits,
    limits,
    mount,
    mounting_at,
    needed_drive_up,
    outside_limits,
    radial_clearance,
    with_bearing_dimensions,
    with_radial_clearance,
)
from ...fits.fit_limits import CLEARANCE_PARTS, MOTOR_CLASS
from ...fits.fits import WARM_PARTS, smoothing
from ...fits.iso286 import limit_classes
from .catalogue_keys import CLEARED_ROLLERS, FromCatalogue

_ZERO = 273.15
_REFERENCE = _ZERO + 20.0
_COLDEST, _HOTTEST = -100.0, 400.0
_THICKEST = 100.0
"""Largest ratio of housing to bearing outside diameter; then effectively infinite."""

_CATALOGUE = "that of the `designation`"

EXPANSIONS = {
    "inner_ring": "ring_expansion",
    "elements": "element_expansion",
    "outer_ring": "ring_expansion",
}
"""Keys of the thermal expansions of the parts of a bearing."""


def _seat_material(table: Table, name: str) -> WarmMaterial:
    given = table.table_or_word(name, tuple(WARM_MATERIALS))
    if given is None:
        table.fill(name, "steel")
        return WarmMaterial.steel()
    if isinstance(given, str):
        return WARM_MATERIALS[given]()
    own = build(Material, given, ("elastic_modulus", "poisson_ratio", "density"))
    expansion = given.quantity("expansion", "temperature coefficient")
    with given.building():
        return WarmMaterial(own, expansion)


def _seat_key(of: str) -> Any:
    numbers = table_schema(Material, expansion=number_schema("temperature coefficient"))
    numbers["required"] = [*numbers["properties"]]
    return scene_key(
        f"material of the {of}",
        default=None,
        otherwise="steel",
        reader=_seat_material,
        json={"anyOf": [{"enum": [*WARM_MATERIALS]}, numbers]},
    )


def _roughness(what: str) -> Any:
    return scene_key(
        f"mean roughness depth Rz of the {what}",
        "length",
        default=None,
        shown="µm",
        least=0,
        most=100,
    )


def _expansion(of: str) -> Any:
    about, kind = f"thermal expansion of the {of}", "temperature coefficient"
    return scene_key(about, kind, default=None, otherwise="that of their material")


def _of_seat(small: bool) -> dict[str, Any]:
    names = [name for name in LIMIT_CLASSES if name[0].islower() is small]
    return {"choices": names, "words": limit_classes(small), "default": None}


def _interference(of: str) -> Any:
    return scene_key(
        f"interference {of}, as measured", "length", default=None, otherwise=_BY_CLASS
    )


_BY_CLASS = "by the tolerance class"

TAPERS = {"1:12": 1 / 12, "1:30": 1 / 30}
"""Tapers of bores."""

_OF_SUFFIX = {"K": "1:12", "K30": "1:30"}

_DRIVEN = ("drive_up", "clearance_reduction")
"""Keys that say how far a tapered bore is driven up its seat."""


class FitKeys(Keys):
    about = "[fit]: the seats of a bearing"

    bore: float | None = key_of(Mounting, "bore", otherwise=_CATALOGUE)
    outside_diameter: float | None = key_of(
        Mounting, "outside_diameter", otherwise=_CATALOGUE
    )
    housing_diameter: float = key_of(Mounting, "housing_diameter")
    shaft: str | None = scene_key("tolerance class of the shaft", **_of_seat(True))
    housing: str | None = scene_key("tolerance class of the housing", **_of_seat(False))
    shaft_interference: float | None = _interference("of shaft and bore")
    housing_interference: float | None = _interference("of bearing and housing")
    bore_taper: str | None = scene_key(
        "taper of bore and seat, of the diameter over the length",
        choices=tuple(TAPERS),
        otherwise="that of the `designation` (K, K30)",
    )
    drive_up: float | None = key_of(Mounting, "drive_up", least=0, default=None)
    clearance_reduction: float | None = scene_key(
        "radial clearance that driving up takes, in place of `drive_up`",
        "length",
        least=0,
        without={"drive_up": ""},
    )
    shaft_bore: float = key_of(Mounting, "shaft_bore")
    clearance: str | None = scene_key(
        "class of the clearance before mounting",
        choices=[
            *(c + part for part in CLEARANCE_PARTS for c in CLEARANCE_CLASSES),
            MOTOR_CLASS,
        ],
        otherwise="that of the `designation`, or the bearing's own number",
    )
    at: str = scene_key(
        "sizes of the solve, in their tolerances",
        choices=tuple(PLACES),
        default="middle",
    )
    shaft_material: WarmMaterial = _seat_key("shaft")
    housing_material: WarmMaterial = _seat_key("housing")
    ring_expansion: float | None = _expansion("rings")
    element_expansion: float | None = _expansion("rolling elements")
    shaft_roughness: float | None = _roughness("shaft")
    housing_roughness: float | None = _roughness("housing's bore")
    ring_roughness: float | None = _roughness("seats of the rings")
    inner_raceway: float | None = key_of(
        Mounting, "inner_raceway", otherwise="the smallest of the raceway"
    )
    outer_raceway: float | None = key_of(
        Mounting, "outer_raceway", otherwise="the largest of the raceway"
    )
    ring_width: float | None = key_of(Mounting, "ring_width", otherwise=_CATALOGUE)

    def check(self) -> None:
        for seat, example in (("shaft", '"k5"'), ("housing", '"H7"')):
            key = f"{seat}_interference"
            given = getattr(self, seat) is not None
            others = (key, *_DRIVEN) if seat == "shaft" else (key,)
            given_otherwise = [
                name for name in others if getattr(self, name) is not None
            ]
            if len(given_otherwise) + given != 1:
                seat, *rest = (
                    [seat, *given_otherwise] if given else given_otherwise or [seat]
                )
                problem = f"stands beside `{rest[0]}`" if rest else "is missing"
                cure = f"give a tolerance class, such as {example}, or `{key}`"
                raise self.table.error(seat, f"{problem}; {cure}")
        if self.ring_roughness and not {"shaft_roughness", "housing_roughness"} & set(
            self.table.keys()
        ):
            problem = "goes with `shaft_roughness` or `housing_roughness`"
            raise self.table.error("ring_roughness", problem)


def _temperature_key(part: str) -> Any:
    return scene_key(
        f"temperature of the {part}",
        "temperature",
        default=None,
        least=_COLDEST,
        most=_HOTTEST,
        otherwise="`reference`",
    )


class TemperatureKeys(Keys):
    about = "[temperature]: how warm a bearing on its seats is"

    reference: float = scene_key(
        "temperature of the measured sizes",
        "temperature",
        default=_REFERENCE,
        least=_COLDEST,
        most=_HOTTEST,
    )
    shaft: float | None = _temperature_key("shaft")
    inner_ring: float | None = _temperature_key("inner ring")
    elements: float | None = _temperature_key("rolling elements")
    outer_ring: float | None = _temperature_key("outer ring")
    housing: float | None = _temperature_key("housing")

    def conditions(self, speed: Speed | None) -> FitConditions:
        """Return the temperatures and speeds of the seats.

        Args:
            speed: Ring speeds; `None`: at rest.
        """
        warm = {
            "reference": self.reference,
            **dict.fromkeys(WARM_PARTS, self.reference),
        }
        warm |= self.given
        self.fill(**{part: warm[part] for part in WARM_PARTS})
        if speed is None:
            return FitConditions(**warm)
        speeds = {"speed": float(speed.inner), "outer_speed": float(speed.outer)}
        return FitConditions(**warm, **speeds)


class FitNotes(NamedTuple):
    """What a scene says of its seats, besides their numbers.

    Attributes:
        place: Position of the sizes of the solve within their tolerances, one of
            `PLACES`.
        classes: Tolerance classes of shaft and housing; empty for numbers.
        unknown: Parts of the bearing of unknown thermal expansion, at reference
            temperature, with the key of their material in [bearing].
    """

    place: str
    classes: tuple[str, str]
    unknown: dict[str, str]


def read_fits(
    parent: Table,
    own: Table,
    bearing: AbstractBearing | BearingSet,
    speed: Speed | None,
    catalogue: FromCatalogue | None = None,
) -> tuple[Any, dict[str, Any], FitNotes | None]:
    """Read the fits of a scene; return them and the bearing with unmounted clearance.

    Args:
        parent: The table that holds [fit] and [temperature]: the scene, or one bearing
            of a rotor.
        own: The table of the bearing, as it was read.
        bearing: The design, unmounted.
        speed: Ring speeds; `None`: at rest.
        catalogue: Catalogue entry of the designation: defaults for the boundary
            dimensions and the clearance class.

    Returns:
        The bearing, with the clearance of the clearance class if there is one; the
        `mounting`, `conditions` and `limits` of its `Installed`, and what else is said
        of them; nothing and `None` without [fit].

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    temperature = parent.table("temperature")
    fit, warm = (f"[{parent.path_of(key)}]" for key in ("fit", "temperature"))
    if "fit" not in parent:
        if temperature.keys():
            problem = f"goes with a {fit}; without one nothing depends on it"
            raise parent.error("temperature", problem)
        return bearing, {}, None
    row = rows_of(bearing)[0].bearing
    if row.is_thrust:
        problem = "is for radial bearings; a thrust bearing has no play to be changed:"
        raise parent.error("fit", f"{problem} leave {fit} and {warm} out")
    designs = {id(one.bearing) for one in rows_of(bearing)}
    if len(designs) > 1 and not shares_rings(bearing):
        problem = "is for rows of one bearing; those of this set differ"
        raise parent.error("fit", problem)
    keys = read_keys(FitKeys, parent.table("fit"))
    table, place = keys.table, keys.at
    sizes = _sizes(keys, catalogue)
    taper = _taper(keys, catalogue)
    given = _limits(keys, row, sizes)
    clearance = _clearance(keys, own, sizes["bore"], catalogue, taper)
    scatters = clearance is not None
    if place != "middle" and not (scatters or keys.shaft or keys.housing):
        problem = "goes with tolerance classes, or a class of clearance"
        raise table.error("at", f"{place!r} {problem}; here all sizes are given")
    conditions = read_keys(TemperatureKeys, temperature).conditions(speed)
    unknown = _unknown_expansions(table, own)
    for part, key in unknown.items():
        if float(getattr(conditions, part)) != float(conditions.reference):
            raise no_expansion(table, part, own.path_of(key))
    seats: dict[str, Any] = (
        sizes | _seats(keys, own, row) | _width(keys, bearing, catalogue, taper)
    )
    seats["bore_taper"], seats["drive_up"] = taper, keys.drive_up or 0.0
    # `Mounting` checks these by name; `mounting_at` sets them again.
    for seat in ("shaft_interference", "housing_interference"):
        seats[seat] = getattr(keys, seat) or 0.0
    with table.building():
        whole = with_bearing_dimensions(Mounting(**seats), row)
        if keys.clearance_reduction is not None:
            whole = jax.device_get(whole)
            seats["drive_up"] = needed_drive_up(whole, keys.clearance_reduction)
            whole = with_bearing_dimensions(Mounting(**seats), row)
        if clearance is None:
            free = float(radial_clearance(row))
            clearance = Limits(free, free)
        limits = SizeLimits(clearance, **given)
        # In NumPy: JAX would compile every small operation.
        there = mounting_at(
            jax.device_get(whole), place, *limits, jax.device_get(conditions)
        )
        seats["shaft_interference"] = there.shaft_interference
        seats["housing_interference"] = there.housing_interference
        if scatters:
            cleared = there.radial_clearance
            rows = [with_radial_clearance(one, cleared) for one in bearings_of(bearing)]
            bearing = with_bearings(bearing, rows)
        mounting = Mounting(**seats)
        mount(bearing, mounting, conditions)
    notes = FitNotes(place, (keys.shaft or "", keys.housing or ""), unknown)
    parts = {"mounting": mounting, "conditions": conditions, "limits": limits}
    return bearing, parts, notes


def _sizes(keys: FitKeys, catalogue: FromCatalogue | None) -> dict[str, float]:
    """Return the diameters of the seats and of the housing."""
    if catalogue is not None and not catalogue.entry.has_inner_ring:
        problem = f"{catalogue.entry.designation} has no inner ring to be seated;"
        cure = "leave it out, and give `radial_internal_clearance` as it runs"
        raise keys.table.own_error(f"{problem} {cure}")
    found = {"housing_diameter": keys.housing_diameter}
    for key in ("bore", "outside_diameter"):
        found[key] = _given_or_catalogue(keys, key, key, catalogue)
    size, most = found["housing_diameter"], _THICKEST * found["outside_diameter"]
    if size > most:
        given, allowed = (scene_number(x, "length") for x in (size, most))
        problem = f"{given} is not allowed; at most {allowed} (another unit meant?)"
        raise keys.table.error("housing_diameter", problem)
    return found


def _given_or_catalogue(keys: FitKeys, key: str, name: str, catalogue) -> float:
    """Return a length of [fit], or of the catalogue."""
    own = getattr(catalogue.entry, name, None) if catalogue else None
    return keys.table.quantity(key, "length", *([] if own is None else [own]))


def _taper(keys: FitKeys, catalogue: FromCatalogue | None) -> float:
    """Return the taper of the bore, 0 if it is cylindrical."""
    table, suffix = keys.table, catalogue.entry.taper if catalogue else ""
    name = keys.bore_taper or _OF_SUFFIX.get(suffix)
    if name is None:
        for key in _DRIVEN:
            if key in table:
                problem = "is of a tapered bore: give `bore_taper`, or a designation"
                raise table.error(key, f"{problem} with K or K30")
        return 0.0
    if suffix and name != _OF_SUFFIX[suffix]:
        problem = f"is {name!r}, but {suffix} of the designation means"
        raise table.error("bore_taper", f"{problem} {_OF_SUFFIX[suffix]!r}")
    if keys.shaft is not None:
        problem = "is a class of cylindrical seats, and this bore is tapered; give"
        cure = "`drive_up` or `clearance_reduction` (or `shaft_interference`)"
        raise table.error("shaft", f"{problem} {cure}")
    keys.fill(bore_taper=name)
    return TAPERS[name]


def _width(keys: FitKeys, bearing, catalogue, taper: float) -> dict[str, float]:
    """Return the ring width, required for a set whose rows have separate rings."""
    key, own = "ring_width", catalogue.entry.width if catalogue else None
    apart = has_separate_rings(bearing)
    mean = taper > 0.0 and own is not None
    if not (apart or mean) and keys.ring_width is None:
        return {}
    if keys.ring_width is None and own is None:
        problem = "is missing: the width of a ring, B; between the rows of a set rings"
        cure = "grow over this length, beyond it shaft and housing"
        raise keys.table.error(key, f"{problem} {cure}")
    return {key: _given_or_catalogue(keys, key, "width", catalogue)}


def _limits(keys: FitKeys, row, sizes) -> dict[str, Limits]:
    """Return the tolerance limits of the seats and rings."""
    exact = Limits(0.0, 0.0)
    found: dict[str, Limits] = {}
    for seat, ring, of_ring, sign in (
        ("shaft", "bore", bore_limits, 1.0),
        ("housing", "outside_diameter", outside_limits, -1.0),
    ):
        name = getattr(keys, seat)
        if name is None:
            # Sign as a deviation: a small housing is tight.
            own = sign * (getattr(keys, f"{seat}_interference") or 0.0)
            found[seat], found[ring] = Limits(own, own), exact
            continue
        if isinstance(row, TaperedRollerBearing):
            problem = "is for bearings of other types: the tolerances of tapered"
            cure = f"rollers differ; give `{seat}_interference`"
            raise keys.table.error(seat, f"{problem} {cure}")
        with keys.table.building():
            found[seat], found[ring] = limits(name, sizes[ring]), of_ring(sizes[ring])
    return found


def _clearance(keys: FitKeys, own: Table, bore, catalogue, taper) -> Limits | None:
    """Return the limits of a clearance class; `None`: clearance given as a number."""
    table, name, drawn = keys.table, keys.clearance, own.keys_given()
    # A line that only restates the catalogue is not a change.
    changed = drawn if catalogue is None else catalogue.overridden
    kind = catalogue.entry.type if catalogue else drawn["type"]
    linked = [CLEARANCE] if kind in CLEARED_ROLLERS else [CLEARANCE, "contact_angle"]
    stated = [key for key in linked if key in changed]
    if name is None and catalogue is not None and not stated:
        name = catalogue.entry.clearance_class
    if name is None:
        return None
    find = class_limits(kind, "K" if taper else "")
    if find is None:
        bore = "this type with a tapered bore" if taper else "this type"
        problem = f"is for bearings with classes of radial clearance, not of {bore};"
        raise table.error("clearance", f"{problem} give its own clearance or angle")
    for key in stated:
        problem = f"stands beside `{own.path_of(key)}`; one follows from the other"
        raise table.error("clearance", problem)
    table.fill("clearance", name)
    own.fill("radial_internal_clearance", None)  # it follows
    with table.building():
        return find(name, bore)


def _unknown_expansions(table: Table, own: Table) -> dict[str, str]:
    """Return the bearing parts whose material is given by numbers without a thermal
    expansion, with the key of the material."""
    drawn = own.keys_given()
    found = {}
    for part, wanted in EXPANSIONS.items():
        ring = part != "elements" and "ring_material" in drawn
        key = "ring_material" if ring else "material"
        named = isinstance(drawn.get(key, "steel"), str)
        if not named and wanted not in table:
            found[part] = key
    return found


def no_expansion(table: Table, part: str, key: str) -> SceneError:
    """Return the error for a warm part of unknown thermal expansion.

    Args:
        table: Table [fit].
        part: As in `FitNotes.unknown`.
        key: Dotted path of the key of its material.
    """
    problem = f"is missing: `{key}` has numbers, and no expansion"
    return table.error(EXPANSIONS[part], problem)


def _seats(keys: FitKeys, own: Table, row) -> dict[str, Any]:
    """Return sizes and materials of a `Mounting`; interferences are set later."""
    seats: dict[str, Any] = {
        key: value
        for key in ("shaft_bore", "inner_raceway", "outer_raceway")
        if (value := getattr(keys, key)) is not None
    }
    for seat in ("shaft", "housing"):
        rough = getattr(keys, f"{seat}_roughness")
        if rough is not None:
            smooth = smoothing(rough, keys.ring_roughness or 0.0)
            seats[f"{seat}_smoothing"] = smooth
        seats[seat] = getattr(keys, f"{seat}_material")
    drawn = own.keys_given()
    balls = drawn.get("material", "steel")
    rings = drawn.get("ring_material", balls)
    ring = _of_bearing(keys, rings, "ring_expansion", row.rings)
    ball = _of_bearing(keys, balls, "element_expansion", row.material)
    return {**seats, "inner_ring": ring, "outer_ring": ring, "elements": ball}


def _of_bearing(keys: FitKeys, given: Any, wanted: str, material) -> WarmMaterial:
    """Return a bearing material with its expansion; unnamed: that of steel."""
    value = getattr(keys, wanted)
    if value is None:
        name = given if isinstance(given, str) else "steel"
        value = float(WARM_MATERIALS[name]().expansion)
        keys.fill(**{wanted: value})
    with keys.table.building(expansion=wanted):
        return WarmMaterial(material, value)


def read_temperature(table: Table, key: str, *default: float | None) -> Any:
    """Read a temperature within the range of bearings [K].

    Args:
        table: Table that holds the key.
        key: Key in the table.
        default: Value if absent; without a default the key is required.
    """
    value = table.quantity(key, "temperature", *default)
    if value is None:
        return None
    celsius = value - _ZERO
    if not _COLDEST <= celsius <= _HOTTEST:
        allowed = f"from {_COLDEST:g} to {_HOTTEST:g} °C"
        raise table.error(key, f"{celsius:.5g} °C is not allowed; {allowed}")
    return value

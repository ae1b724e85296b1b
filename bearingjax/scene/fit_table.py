"""The [fit] and [temperature] tables of a scene: seats of a bearing, and their heat."""

import dataclasses
from typing import Any

import jax

from ..design import (
    CLEARANCE_CLASSES,
    CLEARANCE_PARTS,
    LIMIT_CLASSES,
    PLACES,
    WARM_MATERIALS,
    Bearing,
    BearingSet,
    FitConditions,
    Limits,
    Material,
    Mounting,
    TaperedRollerBearing,
    ThrustBallBearing,
    WarmMaterial,
    bore_limits,
    clearance_range,
    fit_state,
    is_self_aligning,
    limit_classes,
    limits,
    mounted,
    mounting_at,
    outside_limits,
    radial_clearance,
    rows_of,
    sized,
    smoothing,
    with_radial_clearance,
)
from ..design.fit_range import ClearanceRange
from ..design.fits import PARTS, FitState
from ..element import BearingElement, Speed
from ..statics.installed import Installed
from ..statics.service_warning import seat_warnings
from .catalogue_entry import CLEARANCE, FromCatalogue, class_limits
from .quantity import SceneError
from .table import Table, written

_ZERO = 273.15
_REFERENCE = _ZERO + 20.0
_COLDEST, _HOTTEST = -100.0, 400.0
_ROUGHEST = 100e-6
_THICKEST = 100.0
"""Outside diameters of the bearing: any larger housing gives way as an endless one."""

EXPANSIONS = {
    "inner_ring": "ring_expansion",
    "elements": "element_expansion",
    "outer_ring": "ring_expansion",
}
"""Keys of the expansions of the parts of a bearing."""


@dataclasses.dataclass(frozen=True)
class Fits:
    """What a scene says of the seats of its bearing.

    Attributes:
        mounting: The seats, with the interferences at `place`; raceways and clearance
            are those of the bearing.
        conditions: Temperatures and speeds.
        place: Where in the tolerances, one of `PLACES`.
        limits: `Limits` of clearance and seats, as of `clearance_range`.
        names: Of the tolerance classes of shaft and housing; empty for numbers.
        unknown: Parts of the bearing whose expansion is not known, which are as warm
            as the measured sizes, with the key of their material in [bearing].
    """

    mounting: Mounting
    conditions: FitConditions
    place: str
    limits: dict[str, Any]
    names: tuple[str, str]
    unknown: dict[str, str]


@dataclasses.dataclass(frozen=True)
class FitFacts:
    """What fits do, in plain numbers.

    Attributes:
        free: Radial clearance before mounting [m].
        mounted: Mounted, at rest, at the temperature of the measured sizes.
        operating: In operation.
        mounted_range: Radial clearance over all tolerances, mounted.
        operating_range: The same in operation.
        loosest: In operation, at the sizes that leave the largest clearance.
    """

    free: float
    mounted: FitState
    operating: FitState
    mounted_range: ClearanceRange
    operating_range: ClearanceRange
    loosest: FitState


def read_fits(
    beside: Table,
    own: Table,
    bearing: Bearing | BearingSet,
    speed: Speed | None,
    catalogue: FromCatalogue | None = None,
) -> tuple[Any, Fits | None]:
    """Fits of a scene, and its bearing with the clearance that it has unmounted.

    Args:
        beside: The table in which [fit] and [temperature] stand: the scene, or one
            bearing of a rotor.
        own: The table of the bearing, as it was read.
        bearing: The design, unmounted.
        speed: Of the rings; `None`: at rest.
        catalogue: What a designation stands for: boundary dimensions, and the class of
            clearance, where the scene has no others.

    Returns:
        The bearing, whose clearance is that of the class of clearance if there is one,
        and its fits; `None` without [fit].

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    temperature = beside.table("temperature")
    if "fit" not in beside:
        if temperature.keys():
            problem = "goes with a [fit]; without one nothing depends on it"
            raise beside.error("temperature", problem)
        return bearing, None
    table = beside.table("fit")
    row = rows_of(bearing)[0].bearing
    if isinstance(row, ThrustBallBearing):
        problem = "is for radial bearings; a thrust bearing has no play to be changed:"
        raise beside.error("fit", f"{problem} leave [fit] and [temperature] out")
    if len({id(one.bearing) for one in rows_of(bearing)}) > 1 and not is_self_aligning(
        bearing
    ):
        problem = "is for rows of one bearing; those of this set differ"
        raise beside.error("fit", problem)
    place = table.choice("at", tuple(PLACES), "middle")
    sizes = _sizes(table, catalogue)
    given, names = _limits(table, row, sizes)
    given["clearance"] = _clearance(table, own, sizes["bore"], catalogue)
    scatters = given["clearance"] is not None
    if place != "middle" and not (scatters or any(names)):
        problem = "goes with tolerance classes, or a class of clearance"
        raise table.error("at", f"{place!r} {problem}; here all sizes are given")
    conditions = _conditions(temperature, speed)
    unknown = _unknown_expansions(table, own)
    for part, key in unknown.items():
        if float(getattr(conditions, part)) != float(conditions.reference):
            raise no_expansion(table, part, key)
    seats = sizes | _seats(table, own, row) | _width(table, bearing, catalogue)
    # For `Mounting` to check by name; `mounting_at` sets them anew.
    if not names[0]:
        seats["shaft_interference"] = given["shaft"].lower
    if not names[1]:
        seats["housing_interference"] = -given["housing"].lower
    with table.building():
        whole = sized(Mounting(**seats), row)
        if not scatters:
            free = float(radial_clearance(row))
            given["clearance"] = Limits(free, free)
        # NumPy's numbers: JAX would compile every small operation on the way.
        there = mounting_at(
            jax.device_get(whole), place, **given, conditions=jax.device_get(conditions)
        )
        seats["shaft_interference"] = there.shaft_interference
        seats["housing_interference"] = there.housing_interference
        if scatters:
            bearing = _with_clearance(bearing, there.radial_clearance)
        mounting = Mounting(**seats)
        fits = Fits(mounting, conditions, place, given, names, unknown)
        mounted(bearing, fits.mounting, conditions)
    return bearing, fits


def fit_facts(fits: Fits, bearing: Bearing | BearingSet) -> FitFacts:
    """What the fits of a scene do.

    Args:
        fits: From `read_fits`.
        bearing: The bearing that came with them.
    """
    mounting = jax.device_get(sized(fits.mounting, bearing))
    warm, cold = jax.device_get((fits.conditions, FitConditions()))
    loosest = mounting_at(mounting, "loosest", **fits.limits)
    return FitFacts(
        float(mounting.radial_clearance),
        fit_state(mounting, cold),
        fit_state(mounting, warm),
        clearance_range(mounting, **fits.limits, conditions=cold),
        clearance_range(mounting, **fits.limits, conditions=warm),
        fit_state(loosest, warm),
    )


def fit_warnings(
    fits: Fits, bearing: Bearing | BearingSet, load_fixed_to: str = "space"
) -> list[str]:
    """What is odd about fits, a sentence each.

    Args:
        fits, bearing: As of `fit_facts`.
        load_fixed_to: As of `LifeConditions`.
    """
    facts, conditions = fit_facts(fits, bearing), fits.conditions
    speed = Speed(conditions.speed, conditions.outer_speed)
    seats = facts.mounted, facts.operating, facts.loosest
    return seat_warnings(*seats, speed=speed, load_fixed_to=load_fixed_to)


def turning(fits: Fits | None, speed: float) -> Fits | None:
    """Fits on a shaft that turns, in a housing that stands still.

    Args:
        fits: From `read_fits`.
        speed: Of shaft and inner ring [rad/s].
    """
    if fits is None:
        return None
    given = dataclasses.replace(fits.conditions, speed=speed, outer_speed=0.0)
    return dataclasses.replace(fits, conditions=given)


def installed(
    drawing: BearingElement[Any],
    preload: float | None,
    fits: Fits | None,
    catalogue: FromCatalogue | None = None,
) -> Installed:
    """A bearing with the preload and the seats of its scene.

    Args:
        drawing: The bearing with its laws and numerics.
        preload: Force to which its rows are ground [N], or `None`.
        fits: From `read_fits`.
        catalogue: What its designation stands for, or `None`.
    """
    names = "limiting_speed", "reference_speed"
    speeds = {k: getattr(catalogue.entry, k) for k in names} if catalogue else {}
    if fits is None:
        return Installed(drawing, preload, **speeds)
    return Installed(drawing, preload, fits.mounting, fits.conditions, **speeds)


def _with_clearance(bearing, clearance):
    if not isinstance(bearing, BearingSet):
        return with_radial_clearance(bearing, clearance)
    return BearingSet(
        tuple(
            dataclasses.replace(
                row, bearing=with_radial_clearance(row.bearing, clearance)
            )
            for row in bearing.rows
        )
    )


def _sizes(table: Table, catalogue: FromCatalogue | None) -> dict[str, Any]:
    """Diameters of the seats and of the housing."""
    found = {}
    for key in ("bore", "outside_diameter", "housing_diameter"):
        own = getattr(catalogue.entry, key, None) if catalogue else None
        if key == "housing_diameter" and key not in table:
            problem = "is missing: the outside diameter of the housing around the seat"
            raise table.error(key, f'{problem}, a length, such as "100 mm"')
        found[key] = table.quantity(key, "length", *([] if own is None else [own]))
    size, most = found["housing_diameter"], _THICKEST * found["outside_diameter"]
    if size > most:
        problem = f"{size:.5g} m is not allowed; at most {most:.4g} m (metres meant?)"
        raise table.error("housing_diameter", problem)
    return found


def _width(table: Table, bearing, catalogue) -> dict[str, Any]:
    """Width of a ring, which a set needs whose rows have rings of their own."""
    key, own = "ring_width", catalogue.entry.width if catalogue else None
    apart = isinstance(bearing, BearingSet) and not is_self_aligning(bearing)
    if not apart and key not in table:
        return {}
    if key not in table and own is None:
        problem = "is missing: the width of a ring, B; between the rows of a set rings"
        cure = "grow over this length, beyond it shaft and housing"
        raise table.error(key, f"{problem} {cure}")
    return {key: table.quantity(key, "length", *([] if own is None else [own]))}


def _limits(table: Table, row, sizes) -> tuple[dict[str, Any], tuple[str, str]]:
    """Limits of the seats and rings, and names of the classes of the seats."""
    exact = Limits(0.0, 0.0)
    found: dict[str, Any] = {}
    names = []
    for seat, ring, of_ring in (
        ("shaft", "bore", bore_limits),
        ("housing", "outside_diameter", outside_limits),
    ):
        name = _class(table, seat)
        names.append(name)
        if not name:
            value = table.quantity(f"{seat}_interference", "length")
            # As a deviation: a housing that is small is tight.
            own = value if seat == "shaft" else -value
            found[seat], found[ring] = Limits(own, own), exact
            continue
        if isinstance(row, TaperedRollerBearing):
            problem = "is for bearings of other types: the tolerances of tapered"
            cure = f"rollers differ; give `{seat}_interference`"
            raise table.error(seat, f"{problem} {cure}")
        with table.building():
            found[seat], found[ring] = limits(name, sizes[ring]), of_ring(sizes[ring])
    return found, (names[0], names[1])


def _class(table: Table, seat: str) -> str:
    """Name of the tolerance class of a seat; empty if its interference is given."""
    key = f"{seat}_interference"
    if (seat in table) == (key in table):
        problem = "is missing" if seat not in table else f"stands beside `{key}`"
        example = '"k5"' if seat == "shaft" else '"H7"'
        raise table.error(
            seat, f"{problem}; give a tolerance class, such as {example}, or `{key}`"
        )
    if key in table:
        return ""
    small = seat == "shaft"
    names = tuple(name for name in LIMIT_CLASSES if name[0].islower() is small)
    return table.choice(seat, names, words=limit_classes(small))


def _clearance(table: Table, own: Table, bore, catalogue) -> Limits | None:
    """Limits of a clearance class; `None`: the bearing's own number."""
    names = [c + part for part in CLEARANCE_PARTS for c in CLEARANCE_CLASSES]
    name = table.choice("clearance", tuple(names), None)
    drawn = own.keys_given()
    # A line that only restates the catalogue does not count.
    changed = drawn if catalogue is None else catalogue.overridden
    stated = [key for key in (CLEARANCE, "contact_angle") if key in changed]
    if name is None and catalogue is not None and not stated:
        name = catalogue.entry.clearance_class
    if name is None:
        return None
    find = catalogue.entry.class_limits if catalogue else class_limits(drawn["type"])
    if find is None:
        problem = "is for bearings with classes of radial clearance, not of this type;"
        raise table.error("clearance", f"{problem} give its own clearance or angle")
    for key in stated:
        problem = f"stands beside `bearing.{key}`; one follows from the other"
        raise table.error("clearance", problem)
    table.fill("clearance", name)
    own.fill("radial_internal_clearance", None)  # it follows
    with table.building():
        return find(name, bore)


def _unknown_expansions(table: Table, own: Table) -> dict[str, str]:
    """Parts of the bearing whose material has numbers, but no expansion; with the key
    of the material."""
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
    """Error of a part that gets warm and whose expansion is not known.

    Args:
        table: [fit].
        part, key: As of `Fits.unknown`.
    """
    problem = f"is missing: `bearing.{key}` has numbers, and no expansion"
    return table.error(EXPANSIONS[part], problem)


def _seats(table: Table, own: Table, row) -> dict[str, Any]:
    """Sizes and materials of a `Mounting`; interferences are put in later."""
    seats: dict[str, Any] = {"shaft_interference": 0.0, "housing_interference": 0.0}
    for key in ("shaft_bore", "inner_raceway", "outer_raceway"):
        if key in table:
            seats[key] = table.quantity(key, "length")
    ring = _roughness(table, "ring_roughness", 0.0)
    for seat in ("shaft", "housing"):
        rough = _roughness(table, f"{seat}_roughness", None)
        if rough is not None:
            seats[f"{seat}_smoothing"] = smoothing(rough, ring)
        seats[seat] = _seat_material(table, f"{seat}_material")
    if ring and not {"shaft_roughness", "housing_roughness"} & set(table.keys()):
        problem = "goes with `shaft_roughness` or `housing_roughness`"
        raise table.error("ring_roughness", problem)
    drawn = own.keys_given()
    balls = drawn.get("material", "steel")
    rings = drawn.get("ring_material", balls)
    ring = _of_bearing(table, rings, "ring_expansion", row.rings)
    ball = _of_bearing(table, balls, "element_expansion", row.material)
    return {**seats, "inner_ring": ring, "outer_ring": ring, "elements": ball}


def _roughness(table: Table, key: str, default: float | None) -> Any:
    """Mean roughness depth Rz of a seat or ring."""
    value = table.quantity(key, "length", default)
    if value is not None and not 0.0 <= value <= _ROUGHEST:
        problem = f"{1e6 * value:.5g} µm is not allowed; from 0 to"
        raise table.error(key, f"{problem} {1e6 * _ROUGHEST:g} µm")
    return value


def _of_bearing(table: Table, given: Any, wanted: str, material) -> WarmMaterial:
    """A material of the bearing with its expansion; without a name that of steel."""
    value = table.quantity(wanted, "temperature coefficient", None)
    if value is None:
        name = given if isinstance(given, str) else "steel"
        value = float(WARM_MATERIALS[name]().expansion)
        table.fill(wanted, written(value, "1/K"))
    with table.building():
        return WarmMaterial(material, value)


def _seat_material(table: Table, key: str) -> WarmMaterial:
    given = table.table_or_word(key, tuple(WARM_MATERIALS))
    if given is None:
        table.fill(key, "steel")
        return WarmMaterial.steel()
    if isinstance(given, str):
        return WARM_MATERIALS[given]()
    values = given.fields(Material, "elastic_modulus", "poisson_ratio", "density")
    own = given.quantity("expansion", "temperature coefficient")
    with given.building():
        return WarmMaterial(Material(**values), own)


def _conditions(table: Table, speed: Speed | None) -> FitConditions:
    """Temperatures and speeds."""
    reference = read_temperature(table, "reference", _REFERENCE)
    warm = {part: read_temperature(table, part, reference) for part in PARTS}
    warm["reference"] = reference
    if speed is None:
        return FitConditions(**warm)
    return FitConditions(
        **warm, speed=float(speed.inner), outer_speed=float(speed.outer)
    )


def read_temperature(table: Table, key: str, *default: float | None) -> Any:
    """A temperature that bearings have [K].

    Args:
        table: Where it stands.
        key: Key in it.
        default: If absent; without a default the key is required.
    """
    value = table.quantity(key, "temperature", *default)
    if value is None:
        return None
    celsius = value - _ZERO
    if not _COLDEST <= celsius <= _HOTTEST:
        allowed = f"from {_COLDEST:g} to {_HOTTEST:g} °C"
        raise table.error(key, f"{celsius:.5g} °C is not allowed; {allowed}")
    return value

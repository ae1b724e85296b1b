"""The catalogue: bearings by their designation, with the source of each value.

The folder `catalogue/` has one file per type: `type`, the `[sources]` with their short
names, and a table for each bearing under its designation. The `bearing` of such a table
holds keys of a scene's `[bearing]`.
"""

import dataclasses
import functools
import math
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

from ..design.fit_limits import (
    CLEARANCE_CLASSES,
    ball_clearance,
    roller_clearance,
    self_aligning_clearance,
    spherical_roller_clearance,
    toroidal_roller_clearance,
)
from ..design.iso286 import Limits
from ..statics import heat_area, reference_factors, reference_speed
from .design_keys import read_design
from .designation import Suffixes, compact, split_designation
from .quantity import SceneError, to_si
from .table import Table

CLEARANCES = {
    "deep_groove_ball": ball_clearance,
    "cylindrical_roller": roller_clearance,
    "needle_roller": roller_clearance,
    "self_aligning_ball": self_aligning_clearance,
    "spherical_roller": spherical_roller_clearance,
    "toroidal_roller": toroidal_roller_clearance,
}
"""Limits of radial internal clearance by type, where classes are defined."""

_TAPERED = {
    "self_aligning_ball": partial(self_aligning_clearance, tapered=True),
    "spherical_roller": partial(spherical_roller_clearance, tapered=True),
    "toroidal_roller": partial(toroidal_roller_clearance, tapered=True),
}
"""Limits of radial internal clearance by type for tapered bores."""

CLEARANCE = "radial_internal_clearance"

_SERIES = {
    "deep_groove_ball": r"^6([23])\d\d$",
    "angular_contact_ball": r"^7(2)\d\d ",
    "cylindrical_roller": r"^[A-Z]+ (2[23]|2)\d\d ",
    "spherical_roller": r"^2([2-4][0-3])\d\d ",
    "tapered_roller": r"^3([0-3][0-3]|[02])\d\d ",
    "cylindrical_thrust_roller": r"^8(1[12])\d\d ",
    "spherical_thrust_roller": r"^2(9[2-4])\d\d ",
}
"""Dimension series within a designation."""

_OTHER_BALLS = (
    "bearings of other contact angles often have other balls; C, C0 worked out from"
    " these may be some 20 % too high (so those of 7205 C and AC, from the balls of the"
    " 7205 BE, are 5 to 22 % above the printed ones)"
)
"""Note on a bearing with the balls of another contact angle."""

_QUANTITIES = {
    "bore": "length",
    "outside_diameter": "length",
    "width": "length",
    "inner_width": "length",
    "outer_width": "length",
    "dynamic_capacity": "force",
    "static_capacity": "force",
    "fatigue_load_limit": "force",
    "reference_speed": "speed",
    "limiting_speed": "speed",
    "mass": "mass",
}


_RATINGS = (
    "dynamic_capacity",
    "static_capacity",
    "fatigue_load_limit",
    "reference_speed",
    "limiting_speed",
)


class OtherRating(NamedTuple):
    """Other published ratings for these boundary dimensions and internal geometry.

    Attributes:
        dynamic_capacity: C [N].
        static_capacity: C0 [N], or `None` if for another internal geometry.
        source: Publisher.
    """

    dynamic_capacity: float
    static_capacity: float | None
    source: str


@dataclasses.dataclass(frozen=True)
class CatalogueEntry:
    """A bearing of the catalogue.

    Attributes:
        designation: As printed in catalogues, with the clearance class if one was
            named.
        type: As in a scene, "deep_groove_ball".
        bore: d [m].
        outside_diameter: D [m].
        width: B; T of tapered roller bearings, H of thrust bearings [m].
        inner_width: Width B of the inner ring of tapered roller bearings [m].
        outer_width: Width C of their outer ring [m].
        dynamic_capacity: C as published; axial for thrust bearings [N]. `None`: not
            known for this variant.
        static_capacity: C0 as published [N].
        fatigue_load_limit: Pu [N].
        reference_speed: Thermal reference speed [rad/s].
        limiting_speed: Limiting speed [rad/s].
        mass: Mass [kg].
        other: Ratings in another catalogue, or of the standard class for an improved
            one.
        geometry: "published" or "estimated": number and size of the rolling elements
            and their pitch diameter.
        assumed: Keys of `table` with typical values, neither published nor estimated.
        sources: Source of "capacity" and "geometry".
        notes: Interpretation of the designation, in words.
        table: Keys of [bearing] as written in a scene.
        taper: "K" or "K30" for a tapered bore, else "".
        printed: What else the publisher prints, as in the file: lengths as texts, pure
            numbers such as the limit e and factors Y1, Y2, Y0 of axial loads.
    """

    designation: str
    type: str
    bore: float
    outside_diameter: float
    width: float
    inner_width: float | None
    outer_width: float | None
    dynamic_capacity: float | None
    static_capacity: float | None
    fatigue_load_limit: float | None
    reference_speed: float | None
    limiting_speed: float | None
    mass: float | None
    other: OtherRating | None
    geometry: str
    assumed: tuple[str, ...]
    sources: dict[str, str]
    notes: tuple[str, ...]
    table: dict[str, Any]
    taper: str = ""
    printed: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def clearance_class(self) -> str | None:
        """Class of radial internal clearance; `None` for a type without classes."""
        if self.type not in CLEARANCES:
            return None
        after = self.designation.rpartition("/")[2]
        return after if after[:2] in CLEARANCE_CLASSES else "CN"

    @property
    def thermal_speed(self) -> float | None:
        """Thermal reference speed by ISO 15312 [rad/s]; `None` without factors."""
        found = re.search(_SERIES.get(self.type, "$^"), self.designation)
        factors = found and reference_factors(self.type, found[1].zfill(2))
        if not factors or self.static_capacity is None:
            return None
        d, outside = self.bore, self.outside_diameter
        thrust = self.type.endswith("thrust_roller")
        flat = self.type == "cylindrical_thrust_roller"
        area = heat_area(d, outside, self.width, flat=flat)
        if thrust and not flat:
            shaft, housing = (
                to_si(self.printed[key], "length")
                for key in ("shaft_washer_diameter", "housing_washer_bore")
            )
            area = 0.25 * math.pi * (outside**2 + shaft**2 - housing**2 - d**2)
        mean, load = 0.5 * (d + outside), self.static_capacity
        return float(reference_speed(mean, area, load, factors, thrust=thrust))

    @property
    def class_limits(self) -> Callable[..., Limits] | None:
        """Clearance limits by class and bore; `None` for a type without classes."""
        return class_limits(self.type, self.taper)

    @property
    def bearing(self) -> Any:
        """The design: a bearing, or the set of both rows of a self-aligning bearing."""
        return read_design(Table(self.table, self.designation))


def catalogue_entry(designation: str) -> CatalogueEntry:
    """Look up a bearing of the catalogue by its designation.

    Args:
        designation: Such as "6205", "SKF 6205-2RS1/C3", "NJ 205 ECP". Suffixes for
            seals, shields, cages and accuracy are accepted and listed in `notes` as
            having no effect; a clearance class (C2 to C5, with H, L, M or P for a
            part of it) sets the clearance to the middle of its range; self-aligning
            bearings with a tapered bore (K) have separate classes.

    Raises:
        SceneError: If there is no such bearing; the message names similar ones.
        TypeError: If it is not a string.
    """
    if not isinstance(designation, str):
        problem = 'it must be a text such as "6205"'
        raise TypeError(
            f"catalogue_entry: `designation` is {designation!r}; {problem}."
        )
    listed = _names()
    name, suffixes = split_designation(designation, listed)
    kind, key, changes, odd = listed[name]
    return _entry(kind, key, changes, odd, suffixes)


def catalogue() -> tuple[CatalogueEntry, ...]:
    """Return all bearings of the catalogue, by type and in the order of the files."""
    plain = Suffixes(None, ())
    seen: dict[str, CatalogueEntry] = {}
    for kind, key, changes, odd in _names().values():
        if not odd:
            entry = _entry(kind, key, changes, odd, plain)
            seen.setdefault(entry.designation, entry)
    return tuple(seen.values())


@functools.cache
def _files() -> dict[str, dict[str, Any]]:
    """Read the files of the catalogue, by type."""
    folder = Path(str(files("bearingjax.scene") / "catalogue"))
    read = (
        tomllib.loads(path.read_text(encoding="utf-8"))
        for path in sorted(folder.glob("*.toml"))
    )
    return {data["type"]: data for data in read}


@functools.cache
def _names() -> dict[str, tuple[str, str, dict[str, Any], tuple[str, ...]]]:
    """Return type, key, changed keys and notes of every compact name.

    A bearing with `arrangements` has a name for each; the names in `also` are aliases.
    Where letters denote contact angles, a size has all of them.
    """
    found: dict[str, tuple[str, str, dict[str, Any], tuple[str, ...]]] = {}
    for kind, data in _files().items():
        for key, values in data["bearings"].items():
            first, _, rest = key.partition(" ")
            for ribs in values.get("arrangements", (None,)):
                shown = key if ribs is None else f"{ribs} {rest}"
                changes = {} if ribs is None else {"arrangement": ribs}
                found[compact(shown)] = (kind, key, changes, ())
                for other in values.get("also", ()):
                    other = other if ribs is None else f"{ribs} {other}"
                    odd = (f"{other} is listed as {shown}",)
                    found.setdefault(compact(other), (kind, key, changes, odd))
    for kind, data in _files().items():
        for key, values in data["bearings"].items():
            for letter, angle in data.get("letters", {}).items():
                name = f"{key.split()[0]} {letter}"
                changes = {"contact_angle": angle}
                odd = (f"{name}: {_OTHER_BALLS}",)
                if values["letter"] == "B":
                    found.setdefault(compact(name), (kind, key, changes, odd))
    return found


def _entry(kind, key, changes, odd, suffixes) -> CatalogueEntry:
    data = _files()[kind]
    values = data["bearings"][key]
    si: dict[str, Any] = {
        name: to_si(values[name], unit) if name in values else None
        for name, unit in _QUANTITIES.items()
    }
    shown = key
    table = {"type": kind, **values["bearing"], **changes}
    sources = {
        part: data["sources"][values[f"{part}_source"]]
        for part in ("capacity", "geometry")
    }
    if "contact_angle" in changes:
        shown = odd[0].partition(":")[0]
        sources["capacity"] = "not known for this contact angle"
        sources["geometry"] = (
            f"balls and pitch circle of {key} (of that one: {sources['geometry']})"
        )
        for name in (*_RATINGS, "mass"):
            si[name] = None
        for name in ("outer_shoulder", "inner_shoulder"):
            table.pop(name)
    if "arrangement" in changes:
        shown = f"{changes['arrangement']} {key.partition(' ')[2]}"
    notes = [*odd, *(f"{word}: no effect" for word in suffixes.without_effect)]
    assumed = list(values.get("assumed", data.get("assumed", ())))
    taper = suffixes.taper
    if kind in CLEARANCES:
        apart = " " if taper and shown[-1].isdigit() else ""
        shown, name = f"{shown}{apart}{taper}", suffixes.clearance or "CN"
        if class_limits(kind, taper) is None:
            problem = (
                f"classes of clearance of tapered bores ({taper}) are known here of"
            )
            cure = f"{', '.join(_TAPERED)} alone; leave it out, and give `{CLEARANCE}`"
            raise SceneError(f"{shown}: {problem} {cure}")
        try:
            table[CLEARANCE], note = class_clearance(kind, name, si["bore"], taper)
        except ValueError as error:
            raise SceneError(f"{shown}/{name}: {error}") from error
        notes.append(note)
    elif taper:
        notes.append(f"{taper} (tapered bore): no effect")
        taper = ""
    elif suffixes.clearance is not None:
        problem = f"{kind} has no classes of clearance here; leave the class out"
        raise SceneError(f"{shown}/{suffixes.clearance}: {problem}")
    if suffixes.clearance not in (None, "CN"):
        shown = f"{shown}/{suffixes.clearance}"
    return CatalogueEntry(
        designation=shown,
        type=kind,
        **si,
        other=_other(values, data["sources"]) if si["dynamic_capacity"] else None,
        geometry=values["geometry"],
        assumed=tuple(name for name in assumed if name in table),
        sources=sources,
        notes=tuple(notes),
        table=table,
        taper=taper,
        printed={} if "contact_angle" in changes else dict(values.get("printed", {})),
    )


def _other(values, sources) -> OtherRating | None:
    given = values.get("other")
    if given is None:
        return None
    static = given.get("static_capacity")
    return OtherRating(
        to_si(given["dynamic_capacity"], "force"),
        None if static is None else to_si(static, "force"),
        sources[given["source"]],
    )


def class_limits(kind: str, taper: str = "") -> Callable[..., Limits] | None:
    """Return the clearance limits of a type by class and bore; `None` if not known.

    Args:
        kind: Type, as in a scene.
        taper: As in `CatalogueEntry`.
    """
    return (_TAPERED if taper else CLEARANCES).get(kind)


def class_clearance(
    kind: str, name: str, bore: float, taper: str = ""
) -> tuple[str, str]:
    """Return the middle clearance of a class, as in a scene, and its source.

    Args:
        kind: Type with clearance classes, one of `CLEARANCES`.
        name: Class, such as "C3".
        bore: Bore diameter d [m].
        taper: As in `CatalogueEntry`.

    Raises:
        ValueError: If the class has no limits for this bore.
    """
    find = class_limits(kind, taper)
    assert find is not None
    low, high = find(name, bore)
    middle = f"{0.5e6 * (low + high):.4g} um"
    words = f"middle of class {name}, ISO 5753-1: {1e6 * low:.3g} to"
    return middle, f"clearance: {words} {1e6 * high:.3g} µm, not mounted"


@dataclasses.dataclass(frozen=True)
class FromCatalogue:
    """Catalogue entry of a scene's `designation`.

    Attributes:
        entry: The bearing of the catalogue.
        overridden: Keys to which the scene gives other values.
    """

    entry: CatalogueEntry
    overridden: tuple[str, ...]

    def varied(self, keys: Iterable[str]) -> "FromCatalogue":
        """Mark further scene keys, such as "bearing.n_balls", as overridden."""
        given = [key.split(".")[1] for key in keys if key.startswith("bearing.")]
        names = dict.fromkeys((*self.overridden, *given))
        return dataclasses.replace(self, overridden=tuple(names))

    def __str__(self):
        words = [
            f"{self.entry.designation} (catalogue)",
            f"inner geometry {self.entry.geometry}",
        ]
        if self.overridden:
            words.append(f"overridden: {', '.join(self.overridden)}")
        return ", ".join(words)


CLEARED_ROLLERS = ("spherical_roller", "toroidal_roller")
"""Types with clearance classes whose clearance does not follow from an angle."""

_INSTEAD = {
    "contact_angle": (CLEARANCE,),
    "ribs": ("arrangement", "rib", "axial_internal_clearance"),
}
"""Keys replaced by a given key: one follows from the other."""


def taken_from(
    entry: CatalogueEntry, given: Mapping[str, Any]
) -> tuple[dict[str, Any], FromCatalogue]:
    """Complete the keys of [bearing] from the catalogue.

    Args:
        entry: Catalogue entry of the designation.
        given: Keys given in addition to the designation; nested tables are merged
            key by key, unless they name a `type`.

    Returns:
        All keys, and the record of the catalogue entry.
    """
    dropped = {name for key in given for name in _INSTEAD.get(key, ())}
    if entry.type in CLEARED_ROLLERS:
        dropped.discard(CLEARANCE)
    merged = {k: v for k, v in entry.table.items() if k not in dropped}
    changed = []
    for key, value in given.items():
        own = entry.table.get(key)
        if isinstance(own, Mapping) and isinstance(value, Mapping):
            value = value if "type" in value else {**own, **value}
        merged[key] = value
        if not same_key(entry, key, value):
            changed.append(key)
    return merged, FromCatalogue(entry, tuple(changed))


def same_key(entry: CatalogueEntry, key: str, value: Any) -> bool:
    """Whether a key of a scene's [bearing] equals its catalogue value.

    Args:
        entry: Catalogue entry.
        key: Key of [bearing].
        value: Value as written in the scene.
    """
    return _same(value, entry.table.get(key)) or _same(value, _filled(entry).get(key))


_FILLED: dict[str, dict[str, Any]] = {}


def _filled(entry: CatalogueEntry) -> dict[str, Any]:
    """Return the keys of a bearing with all defaults, as echoed in the JSON."""
    if entry.designation not in _FILLED:
        table = Table(entry.table, entry.designation)
        read_design(table)
        _FILLED[entry.designation] = table.echo()
    return _FILLED[entry.designation]


def _same(value: Any, own: Any) -> bool:
    """Whether two scene values are equal, such as "7.94 mm" and "0.00794 m"."""
    if isinstance(value, Mapping) and isinstance(own, Mapping):
        return set(value) == set(own) and all(_same(value[k], own[k]) for k in value)
    if value == own or not (isinstance(value, str) and isinstance(own, str)):
        return value == own
    for kind in ("length", "angle"):
        try:
            return math.isclose(to_si(value, kind), to_si(own, kind), rel_tol=1e-9)
        except SceneError:
            continue
    return False

"""The catalogue: bearings by their designation, with the source of each value.

The folder `data/` has one file per type: `type`, the `[sources]` with their short
names, and a table for each bearing under its designation, in the units of catalogues
(`ENTRY_UNITS`). The `bearing` of such a table holds the keywords of its design.
"""

import dataclasses
import functools
import math
import re
from collections.abc import Callable, Mapping
from decimal import Decimal
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import tomli  # as tomllib, but compiled: three times as fast

from ..design import rows_of
from ..design.keywords import bearing_of
from ..design.published import PublishedRatings, rated_dimensions, with_published
from ..fits.fit_limits import (
    CLEARANCE_CLASSES,
    MOTOR_CLASS,
    ball_clearance,
    roller_clearance,
    self_aligning_clearance,
    spherical_roller_clearance,
    toroidal_roller_clearance,
)
from ..fits.fits import Mounting
from ..fits.iso286 import Limits
from ..numerics.units import unit
from ..numerics.warning import Warning
from .designation import Suffixes, compact, split_designation

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

_OTHER_BALLS = (
    "bearings of other contact angles often have other balls; C, C0 worked out from"
    " these may be some 20 % too high (so those of 7205 C and AC, from the balls of the"
    " 7205 BE, are 5 to 22 % above the printed ones)"
)
"""Note on a bearing with the balls of another contact angle."""

_ON_SHAFT = "no inner ring: the bore is the raceway on the shaft, hardened and ground"
"""Note on a bearing whose rollers run on the shaft."""

_RATINGS = (
    "dynamic_capacity",
    "static_capacity",
    "fatigue_load_limit",
    "reference_speed",
    "limiting_speed",
)
_SIZES = ("bore", "outside_diameter", "width", "inner_width", "outer_width")

ENTRY_UNITS = {
    **dict.fromkeys(_RATINGS[:3], "kN"),
    **dict.fromkeys(_RATINGS[3:], "rpm"),
    "mass": "kg",
    CLEARANCE: "um",
    "axial_internal_clearance": "um",
    "contact_angle": "deg",
    "rated_contact_angle": "deg",
    "shim_angle": "deg",
    "roller_axis_angle": "deg",
    "roller_half_angle": "deg",
    "n_balls": "",
    "n_rollers": "",
    "outer_osculation": "",
    "inner_osculation": "",
    "axial_factor": "",
    "axial_factors": "",
    "axial_load_limit": "",
    "tilt_factor": "",
    "clearance_factor": "",
}
"""Units of numbers in the files of the catalogue; others are lengths in mm."""

_POWERS = {"mm": -3, "um": -6, "kN": 3, "kg": 0}
_FACTORS = {"deg": math.pi / 180.0, "rpm": math.pi / 30.0}


def from_catalogue_unit(key: str, number: Any) -> Any:
    """Return a value of the catalogue in SI; words stay as they are.

    Powers of ten shift the decimal point, so that 10 µm are exactly 1e-05 m.

    Args:
        key: Its key, which tells the unit (`ENTRY_UNITS`).
        number: As in the files: a number, a list or a table of such; a word.
    """
    if isinstance(number, Mapping):
        return {k: from_catalogue_unit(k, one) for k, one in number.items()}
    if isinstance(number, list):
        return [from_catalogue_unit(key, one) for one in number]
    if isinstance(number, str):
        return number
    unit = ENTRY_UNITS.get(key, "mm")
    if unit in _POWERS:
        return float(Decimal(number).scaleb(_POWERS[unit]))
    if unit in _FACTORS:
        return float(number) * _FACTORS[unit]
    return number if isinstance(number, int) else float(number)


def in_catalogue_unit(key: str, value: float) -> str:
    """Return a number of the catalogue with its unit, "7.94 mm".

    Args:
        key: Its key, which tells the unit; not that of a pure number.
        value: Number in SI.
    """
    unit = ENTRY_UNITS.get(key, "mm")
    if unit in _FACTORS:
        return f"{value / _FACTORS[unit]:.12g} {unit}"
    number = Decimal(repr(value)).scaleb(-_POWERS[unit]).normalize()
    return f"{number:f} {unit}"


class OtherRating(NamedTuple):
    """Other published ratings for these boundary dimensions.

    Attributes:
        dynamic_capacity: C [N].
        static_capacity: C0 [N], or `None` if for another internal geometry.
        source: Publisher, with the year if it is known.
    """

    dynamic_capacity: Annotated[float, unit("N")]
    static_capacity: Annotated[float | None, unit("N")]
    source: str


SAME_SIZE = 1e-3
"""Difference of diameters over the diameter above which they count as different [1]."""


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
        limiting_speed: Limiting speed [rad/s]; with grease where the publisher prints
            that, unless `sources` says with oil.
        mass: Mass [kg].
        other: Ratings in another catalogue for this internal geometry, or of the
            standard class for an improved one.
        geometry: "published" or "estimated": number and size of the rolling elements
            and their pitch diameter.
        assumed: Keywords of `design` with typical values, neither published nor
            estimated.
        sources: Source of "capacity" and "geometry".
        notes: Interpretation of the designation, in words.
        design: `type` and fields of the design in SI; `load_bearing` builds it.
        taper: "K" or "K30" for a tapered bore, else "".
        printed: What else the publisher prints, in SI: lengths, and pure numbers such
            as the limit e and factors Y1, Y2, Y0 of axial loads.
        makers: Ratings of other makers for this size; their insides may differ.
        own_clearance: Whether its clearance is that which the publisher prints, in
            place of the classes of its type.
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
    design: dict[str, Any]
    taper: str = ""
    printed: dict[str, Any] = dataclasses.field(default_factory=dict)
    makers: tuple[OtherRating, ...] = ()
    own_clearance: bool = False

    @property
    def clearance_class(self) -> str | None:
        """Class of radial internal clearance; `None` for a bearing without classes."""
        if self.type not in CLEARANCES or self.own_clearance:
            return None
        after = self.designation.rpartition("/")[2]
        return after if after[:2] in (*CLEARANCE_CLASSES, MOTOR_CLASS) else "CN"

    @property
    def series(self) -> tuple[str, str]:
        """Digits of the number before the bore code, and the letters after it.

        ("62", "") of 6205/C3, ("222", "EK") of 22220 EK, ("2", "EC") of NU 205 EC;
        of deep groove ball bearings up to 9 mm as of larger ones, ("618", "") of 688;
        ("320", "X") of 320/28 X, ("222", "E") of 22205/20 E. "" of bearings without
        series, such as MR 85, and of insert bearings.
        """
        found = re.match(r"([A-Z]*) ?(\d+)(/\d+)? ?([A-Z]*)", self.designation)
        assert found is not None
        first, number, bore, letters = found.groups()
        if self.own_clearance:
            return "", letters
        small = self.type == "deep_groove_ball" and len(number) == 3 and not first
        whole = bore and len(number) < 4
        digits = number if whole else number[:-1] if small else number[:-2]
        return {"67": "617", "68": "618", "69": "619"}.get(digits, digits), letters

    @property
    def class_limits(self) -> Callable[..., Limits] | None:
        """Clearance limits by class and bore; `None` for a bearing without classes."""
        return None if self.own_clearance else class_limits(self.type, self.taper)

    @property
    def has_inner_ring(self) -> bool:
        """Whether it has an inner ring; without it rollers run on the shaft."""
        return self.printed.get("inner_raceway_diameter") != self.bore

    def seat_warnings(self, mounting: Mounting) -> list[Warning]:
        """Warnings about seats of other diameters than its own.

        Args:
            mounting: Its seats, concrete.
        """
        found = []
        for name in ("bore", "outside_diameter"):
            given, own = float(getattr(mounting, name)), getattr(self, name)
            if abs(given - own) > SAME_SIZE * own:
                words = (
                    f"fit: `{name}` is {1e3 * given:.5g} mm, but that of"
                    f" {self.designation} is {1e3 * own:.5g} mm, which its friction and"
                    " heat have; leave it out if it is not meant"
                )
                found.append(Warning("other_seat_size", words, given, own))
        return found

    def ratings_for(self, row: Any) -> PublishedRatings | None:
        """Return its ratings and axial factors for a row; `None`: not published.

        Of the axial factors of a self-aligning ball bearing Y2 is printed; the others
        have fixed ratios to it (ISO 281, ISO 76).

        Args:
            row: A row with the dimensions of this entry.
        """
        if self.dynamic_capacity is None:
            return None
        given = self.dynamic_capacity, self.static_capacity, self.fatigue_load_limit
        y2 = self.printed.get("axial_factor", 0.0) / 0.65
        factors = self.printed.get("axial_factors", (0.42 * y2, 0.65 * y2, 0.44 * y2))
        return PublishedRatings(
            [x or 0.0 for x in given], factors, rated_dimensions(row)
        )


def catalogue_entry(designation: str) -> CatalogueEntry:
    """Look up what the catalogue knows of a bearing; `load_bearing` makes the design.

    Args:
        designation: Such as "6205", "SKF 6205-2RS1/C3", "NJ 205 ECP". Suffixes for
            seals, shields, cages and accuracy are accepted and listed in `notes` as
            having no effect; a clearance class (C2 to C5, with H, L, M or P for a
            part of it; CM of motors; P63 is P6 and C3) sets the clearance to the
            middle of its range; self-aligning bearings with a tapered bore (K) have
            separate classes. HC5 sets the material of the balls; of stainless steel
            (W 6205) no ratings are known.

    Raises:
        ValueError: If there is no such bearing; the message names similar ones.
        TypeError: If it is not a string.
    """
    if not isinstance(designation, str):
        problem = 'it must be a text such as "6205"'
        raise TypeError(
            f"catalogue_entry: `designation` is {designation!r}; {problem}."
        )
    listed = _names()
    name, suffixes = split_designation(designation, listed)
    kind, key, changes, remarks = listed[name]
    return _entry(kind, key, changes, remarks, suffixes)


def bearing_of_entry(entry: CatalogueEntry) -> Any:
    """Return the bearing of an entry, with its published ratings; see `load_bearing`.

    Args:
        entry: From `catalogue_entry`.
    """
    bearing = bearing_of(entry.design)
    return with_published(bearing, entry.ratings_for(rows_of(bearing)[0].bearing))


@functools.cache
def catalogue_entries() -> tuple[CatalogueEntry, ...]:
    """Return all bearings of the catalogue, by type and in the order of the files."""
    plain = Suffixes()
    seen: dict[str, CatalogueEntry] = {}
    for kind, key, changes, remarks in _names().values():
        if not remarks:
            entry = _entry(kind, key, changes, remarks, plain)
            seen.setdefault(entry.designation, entry)
    return tuple(seen.values())


@functools.cache
def _files() -> dict[str, dict[str, Any]]:
    """Read the files of the catalogue, by type."""
    folder = Path(str(files("bearingjax.catalogue") / "data"))
    read = (
        tomli.loads(path.read_text(encoding="utf-8"), parse_float=Decimal)
        for path in sorted(folder.glob("*.toml"))
    )
    return {data["type"]: data for data in read}


@functools.cache
def _names() -> dict[str, tuple[str, str, dict[str, Any], tuple[str, ...]]]:
    """Return type, key, changed keys and notes of every compact name.

    A bearing with `arrangements` has a name for each; the names in `also` are aliases,
    and those of JIS of the series 618 and 619, 6805. Where letters denote contact
    angles, a size has all of them.
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
                    remarks = (f"{other} is listed as {shown}",)
                    found.setdefault(compact(other), (kind, key, changes, remarks))
                jis = re.fullmatch(r"61([89]\d\d)", key)
                if jis and kind == "deep_groove_ball":
                    remarks = (f"6{jis[1]} (JIS) is listed as {key}",)
                    found.setdefault(f"6{jis[1]}", (kind, key, {}, remarks))
    for kind, data in _files().items():
        if "letters" in data:
            found = _angles(kind, data) | found
    return found


def _angles(kind, data) -> dict[str, tuple[str, str, dict[str, Any], tuple[str, ...]]]:
    """Return names with every letter of a contact angle, as `_names`."""
    found = {}
    letters, bearings = data["letters"], data["bearings"]
    listed = {(k.split()[0], letters[v["letter"]]): k for k, v in bearings.items()}
    for size, _ in listed:
        for letter, angle in letters.items():
            name = f"{size} {letter}"
            if letter.startswith("FAG "):
                name = f"B{size} {letter[4:]}"
            key, changes = listed.get((size, angle)), {}
            note = f"{name} is listed as {key}, of the same contact angle"
            if key is None:
                key, changes = listed.get((size, 40)), {"contact_angle": angle}
                note = f"{name}: {_OTHER_BALLS}"
            if key is not None:
                found[compact(name)] = kind, key, changes, (note,)
    return found


def _entry(kind, key, changes, remarks, suffixes: Suffixes) -> CatalogueEntry:
    data, roles = _files()[kind], suffixes.roles
    values = data["bearings"][key]
    si: dict[str, Any] = {
        name: from_catalogue_unit(name, values[name]) if name in values else None
        for name in (*_SIZES, *_RATINGS, "mass")
    }
    shown = key
    design = from_catalogue_unit("", {"type": kind, **values["bearing"], **changes})
    sources = {
        part: data["sources"][values[f"{part}_source"]]
        for part in ("capacity", "geometry")
    }
    if "contact_angle" in changes:
        shown = remarks[0].partition(":")[0]
        sources["capacity"] = "not known for this contact angle"
        sources["geometry"] = (
            f"balls and pitch circle of {key} (of that one: {sources['geometry']})"
        )
        for name in ("outer_shoulder", "inner_shoulder"):
            design.pop(name)
    if "arrangement" in changes:
        shown = f"{changes['arrangement']} {key.partition(' ')[2]}"
    notes = [*remarks, *(f"{word}: no effect" for word in suffixes.without_effect)]
    if "stainless" in roles:
        shown = f"{roles['stainless']} {shown}"
        sources["capacity"] = "not known for stainless steel; less than of other steel"
        notes.append(f"{roles['stainless']}: of stainless steel, the inside of {key}")
    if sources["capacity"].startswith("not known"):
        si |= dict.fromkeys((*_RATINGS, "mass"))
    if "ceramic" in roles:
        shown = f"{shown}/HC5"
        design |= {"material": "silicon_nitride", "ring_material": "steel"}
        notes.append(f"{roles['ceramic']}: balls of silicon nitride, C as of steel")
    assumed = list(values.get("assumed", data.get("assumed", ())))
    taper, sleeve = roles.get("taper", ""), roles.get("sleeve")
    if sleeve:
        number = re.search(r"\d+", key)
        if not taper or number is None or sleeve[-2:] != number[0][-2:]:
            problem = "is no sleeve of it; one has its bore code and goes with K"
            raise ValueError(f"{shown}: {sleeve} {problem}")
        notes.append(f"{sleeve} (sleeve): no effect; give the shaft in [fit]")
    own = kind in CLEARANCES and CLEARANCE in design
    if kind in CLEARANCES and (taper or not own):
        apart = " " if taper and shown[-1].isdigit() else ""
        shown, name = f"{shown}{apart}{taper}", suffixes.clearance or "CN"
        if class_limits(kind, taper) is None:
            problem = (
                f"classes of clearance of tapered bores ({taper}) are known here of"
            )
            cure = f"{', '.join(_TAPERED)} alone; leave it out, and give `{CLEARANCE}`"
            raise ValueError(f"{shown}: {problem} {cure}")
        try:
            design[CLEARANCE], note = class_clearance(kind, name, si["bore"], taper)
        except ValueError as error:
            raise ValueError(f"{shown}/{name}: {error}") from error
        notes.append(note)
    elif suffixes.clearance is not None:
        what = shown if own else kind
        problem = f"{what} has no classes of clearance here; leave the class out"
        raise ValueError(f"{shown}/{suffixes.clearance}: {problem}")
    elif own:
        notes.append("clearance: middle of what is printed as normal, not mounted")
    if suffixes.clearance not in (None, "CN"):
        shown = f"{shown}/{suffixes.clearance}"
    entry = CatalogueEntry(
        designation=shown,
        type=kind,
        **si,
        other=_other(values, data["sources"]) if si["dynamic_capacity"] else None,
        geometry=values["geometry"],
        assumed=tuple(name for name in assumed if name in design),
        sources=sources,
        notes=tuple(notes),
        design=design,
        taper=taper,
        printed={}
        if "contact_angle" in changes
        else from_catalogue_unit("", values.get("printed", {})),
        makers=tuple(
            OtherRating._make(
                (*from_catalogue_unit(_RATINGS[0], x), data["sources"][k])
            )
            for k, x in values.get("makers", {}).items()
            if si["dynamic_capacity"]
        ),
        own_clearance=own,
    )
    if entry.has_inner_ring:
        return entry
    return dataclasses.replace(entry, notes=(*notes, _ON_SHAFT))


def _other(values, sources) -> OtherRating | None:
    given = values.get("other")
    if given is None:
        return None
    given = from_catalogue_unit("", given)
    static = given.get("static_capacity")
    return OtherRating(given["dynamic_capacity"], static, sources[given["source"]])


def class_limits(kind: str, taper: str = "") -> Callable[..., Limits] | None:
    """Return the clearance limits of a type by class and bore; `None` if not known.

    Args:
        kind: Type, as in a scene.
        taper: As in `CatalogueEntry`.
    """
    return (_TAPERED if taper else CLEARANCES).get(kind)


def class_clearance(
    kind: str, name: str, bore: float, taper: str = ""
) -> tuple[float, str]:
    """Return the middle clearance of a class [m], to four digits, and its source.

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
    middle = from_catalogue_unit(CLEARANCE, Decimal(f"{0.5e6 * (low + high):.4g}"))
    source = "makers of motors" if name == MOTOR_CLASS else "ISO 5753-1"
    words = f"middle of class {name}, {source}: {1e6 * low:.3g} to"
    return middle, f"clearance: {words} {1e6 * high:.3g} µm, not mounted"

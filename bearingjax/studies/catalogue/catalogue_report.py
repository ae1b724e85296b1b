"""The catalogue as text, as numbers and as new scenes; the list of shipped scenes."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ...catalogue.entry import CLEARANCE, CatalogueEntry, bearing_of_entry
from ...design import rows_of
from ...design.keywords import BALLS, ROLLERS
from ...files.quantity import SceneError, to_si
from ...files.scene_file import shipped_scenes
from ...files.table import not_among
from ...friction import thermal_speed
from ...numerics.constants import read_package_table
from ..bearing.catalogue_keys import as_keys

_SHARE: dict[str, tuple[float, str]] = {
    "spherical_roller": (0.05, "a twentieth of C"),
    "toroidal_roller": (0.05, "a twentieth of C"),
}
"""Load of a new scene over the dynamic capacity, if not a tenth, in words too; under a
tenth the contacts of some barrels reach their ends."""

_SPEED = 1500.0
"""Speed of a new scene, or half of the reference or limiting speed if that is less
[rpm]."""

_TYPICAL = read_package_table("bearingjax.studies.catalogue", "new_scene.toml")

_DIRT = 'contamination = "grease, normal"  # of an oil "oil bath -/17/14" and the like'

_PAIRED = ("angular_contact_ball", "tapered_roller")
"""Types that are often mounted in pairs."""


def select(
    entries: Iterable[CatalogueEntry],
    kind: str | None = None,
    bore: str | None = None,
    outside: str | None = None,
    capacity: str | None = None,
) -> tuple[CatalogueEntry, ...]:
    """Select the entries that match all criteria.

    Args:
        entries: Catalogue entries.
        kind: Type, as in a scene.
        bore, outside: One size, "25 mm", or a range, "20 mm:40 mm", with either end
            optional.
        capacity: Dynamic capacity in the same form; a single number is the minimum.

    Raises:
        SceneError: Names the option, the value given and what is allowed.
    """
    kinds = (*BALLS, *ROLLERS)
    if kind is not None and kind not in kinds:
        raise SceneError(f"--type: {not_among(kind, kinds)}")
    ranges = {
        "bore": _range("--bore", bore, "length"),
        "outside_diameter": _range("--outside", outside, "length"),
        "dynamic_capacity": _range("--min-capacity", capacity, "force", least=True),
    }
    return tuple(
        entry
        for entry in entries
        if kind in (None, entry.type)
        and all(_is_within(getattr(entry, name), ends) for name, ends in ranges.items())
    )


def _is_within(value, ends) -> bool:
    """Whether a number lies within a range; an unknown number does not."""
    if ends is None:
        return True
    return value is not None and ends[0] <= value <= ends[1]


def _range(option, text, kind, least=False) -> tuple[float, float] | None:
    """Parse a range, widened by a millionth for round-off; `None` without text."""
    if text is None:
        return None
    first, colon, last = text.partition(":")
    try:
        low = to_si(first, kind) if first or not colon else -np.inf
        high = to_si(last, kind) if last else np.inf
    except SceneError as error:
        raise SceneError(f"{option}: {error}") from error
    if not colon and not least:
        high = low
    if high < low:
        problem = f"{text!r} ends below where it begins; write least:most"
        raise SceneError(f"{option}: {problem}")
    return low * (1 - 1e-6), high * (1 + 1e-6)


def catalogue_table(entries: Sequence[CatalogueEntry]) -> str:
    """Format a line for each bearing: sizes in mm, capacities in kN."""
    head = (
        f"{'designation':<13}{'type':<26}{'d':>6}{'D':>7}{'B, T, H':>9}{'C':>8}"
        f"{'C0':>8}{'Pu':>8}  geometry"
    )
    lines = [head]
    for e in entries:
        sizes = (e.bore, e.outside_diameter, e.width)
        d, outside, width = (f"{1e3 * size:.5g}" for size in sizes)
        loads = (e.dynamic_capacity, e.static_capacity, e.fatigue_load_limit)
        c, c0, pu = ("-" if x is None else f"{1e-3 * x:.4g}" for x in loads)
        lines.append(
            f"{e.designation:<13}{e.type:<26}{d:>6}{outside:>7}{width:>9}{c:>8}{c0:>8}"
            f"{pu:>8}  {e.geometry}"
        )
    lines.append(
        f"{len(entries)} bearings (mm, kN; C axial of thrust bearings, of both rows of"
        " double-row, self-aligning and spherical roller ones)"
    )
    return "\n".join(lines)


def catalogue_title(entry: CatalogueEntry) -> str:
    """Describe a bearing: type, sizes, and origin of its internal geometry."""
    return f"{_describe(entry)}, inner geometry {entry.geometry}"


def _describe(entry):
    sizes = (entry.bore, entry.outside_diameter, entry.width)
    what = f"{entry.type.replace('_', ' ')} bearing,"
    what = f"{what} {' x '.join(f'{1e3 * size:.5g}' for size in sizes)} mm"
    return f"{entry.designation}: {what}" if entry.designation else what.capitalize()


def catalogue_details(entry: CatalogueEntry) -> str:
    """Format all data of a bearing, with its sources."""
    lines = [_describe(entry)]
    lines.append(_loads(entry))
    for c, c0, source in (*filter(None, [entry.other]), *entry.makers):
        static = "" if c0 is None else f", C0 {1e-3 * c0:.4g} kN"
        lines.append(f"elsewhere C {1e-3 * c:.4g} kN{static} ({source})")
    speeds = {
        "reference speed": entry.reference_speed,
        "limiting speed": entry.limiting_speed,
    }
    known = [f"{k} {_rpm(v):.0f} rpm" for k, v in speeds.items() if v is not None]
    if (speed := thermal_speed(entry)) is not None:
        known.append(f"thermal reference speed {_rpm(speed):.0f} rpm (ISO 15312)")
    if entry.mass is not None:
        known.append(f"mass {entry.mass:.4g} kg")
    if known:
        lines.append(", ".join(known))
    if entry.printed:
        printed = as_keys(entry.printed).items()
        words = (f"{k.replace('_', ' ')} {_format(v)}" for k, v in printed)
        lines.append(f"printed: {', '.join(words)}")
    lines.append(f"inner geometry {entry.geometry}: {entry.sources['geometry']}")
    keys = as_keys(entry.design)
    lines += [f"  {key} = {_toml(value)}" for key, value in keys.items()]
    if entry.assumed:
        lines.append(f"assumed, as usual: {', '.join(entry.assumed)}")
    return "\n".join([*lines, *entry.notes])


def _format(value: Any) -> str:
    return " / ".join(map(str, value)) if isinstance(value, list) else f"{value}"


def catalogue_as_dict(entries: Iterable[CatalogueEntry]) -> dict[str, Any]:
    """Return the bearings as plain numbers in SI.

    Returns:
        `bearings`: the fields of `CatalogueEntry` of each, with its `design` as the
        `table` of a scene, and its `thermal_speed`.
    """
    return {
        "bearings": [
            {
                **{k: v for k, v in vars(entry).items() if k != "design"},
                "table": as_keys(entry.design),
                "printed": as_keys(entry.printed),
                "other": entry.other and entry.other._asdict(),
                "makers": [rating._asdict() for rating in entry.makers],
                "thermal_speed": thermal_speed(entry),
            }
            for entry in entries
        ]
    }


def new_scene(entry: CatalogueEntry) -> str:
    """Write a scene of a bearing under a part of its capacity, to be edited.

    Args:
        entry: The bearing, of the catalogue or from `estimated_entry`; every key of its
            design is written out, of a designation as a comment.
    """
    lines = [
        f"# {_describe(entry)}.",
        *_comment(f"{_loads(entry)}."),
        *_comment(f"Inner geometry {entry.geometry}: {entry.sources['geometry']}."),
    ]
    if entry.assumed:
        lines += _comment(f"Assumed, as usual: {', '.join(entry.assumed)}.")
    for note in entry.notes:
        lines += _comment(f"{note[0].upper()}{note[1:].rstrip('.')}.")
    between_ribs = entry.design.get("arrangement", "NU") not in ("NU", "N")
    middle = 'uz = "0 um", ' if between_ribs else ""
    lines += [
        "",
        "[bearing]",
        *_bearing_keys(entry),
        "",
        "[operating]",
        'fixed_ring = "outer"',
        *_load(entry),
        f'inner_speed = "{_speed(entry)}"',
        "# Shaft and housing hold the ring straight; without this line it tilts.",
        # Between ribs nothing else holds a ring that bears no axial load.
        f'prescribed = {{ {middle}gx = "0 mrad", gy = "0 mrad" }}',
        "",
        *_ratings(entry),
        "# What may be added; a # less at the beginning of its lines:",
        *(f"# {line}".rstrip() for line in _more_tables(entry)),
        "",
    ]
    return "\n".join(lines)


def _bearing_keys(entry: CatalogueEntry) -> list[str]:
    """Return the lines of [bearing]; those that a designation implies as comments, each
    with its origin, so that they follow when the designation is changed."""
    keys = as_keys(entry.design).items()
    if not entry.designation:
        return [f"{key} = {_toml(value)}" for key, value in keys]
    return [
        f'designation = "{entry.designation}"',
        "# What it stands for; a line without its # counts in place of the catalogue.",
        *(f"# {k} = {_toml(v)}{_origin(entry, k, v)}" for k, v in keys),
    ]


def _origin(entry: CatalogueEntry, key: str, value: Any) -> str:
    """Return the origin of a key that a designation implies, as a comment."""
    if key == "type" or (isinstance(value, str) and not value[0].isdigit()):
        return ""
    origin = entry.geometry
    if key in entry.assumed:
        origin = "assumed, as usual"
    elif key in entry.printed:
        origin = "published"
    elif key == CLEARANCE and entry.clearance_class is not None:
        origin = f"calculated, middle of class {entry.clearance_class}"
    return f"  # {origin}"


def _more_tables(entry: CatalogueEntry) -> list[str]:
    """Return the lines of the tables needed for a life in operation."""
    lines = []
    if entry.type in _PAIRED:
        lines += [
            "",
            "[set]  # two of them",
            'arrangement = "back_to_back"  # or "face_to_face"',
            f'spacing = "{1e3 * entry.width:.5g} mm"',
        ]
    if not _row(entry).is_thrust and entry.has_inner_ring:
        lines += [
            "",
            "[fit]  # seats, from which the clearance in operation follows",
            *_seats(entry),
            "",
            "[temperature]",
            *(
                f'{part} = "{degrees} °C"'
                for part, degrees in _TYPICAL["temperatures"].items()
            ),
        ]
    share = _load(entry)[-1].partition("{ ")[2].partition(" }")[0]
    return [
        *lines,
        "",
        "[lubricant]",
        'name = "ISO VG 68"',
        'temperature = "60 °C"',
        'supply = "grease"  # whose base oil is named; or "oil_bath", "oil_jet", …',
        "",
        *(
            ["[life]  # bearingjax life my.toml", _DIRT, ""]
            if entry.designation
            else []
        ),
        "[[cases.spectrum]]  # its loads, a table for each",
        'hours = "1000 h"',
        f'operating.inner_speed = "{_speed(entry)}"',
        *(f"operating.load.{part}" for part in share.split(", ")),
    ]


def _ratings(entry: CatalogueEntry) -> list[str]:
    """Return the lines of [life] for a bearing without a designation."""
    if entry.designation:
        return []
    ratings = {
        "dynamic_capacity": entry.dynamic_capacity,
        "static_capacity": entry.static_capacity,
    }
    known = {name: value for name, value in ratings.items() if value is not None}
    return [
        "[life]",
        *(f'{name} = "{1e-3 * value:.6g} kN"' for name, value in known.items()),
        f"# {_DIRT}",
        "",
    ]


def _seats(entry: CatalogueEntry) -> list[str]:
    """Return the lines of a typical [fit]; housing 1.5 times the outside diameter."""
    classes = ['shaft = "k5"', 'housing = "H7"']
    if entry.type == "tapered_roller":
        classes = ['shaft_interference = "10 um"', 'housing_interference = "-10 um"']
    if entry.taper:
        less = f'"{500.0 * entry.bore:.3g} um"  # taken as it is driven up its seat'
        classes = [f"clearance_reduction = {less}", 'housing = "H7"']
    outside = 5.0 * round(1.5e3 * entry.outside_diameter / 5.0)
    lines = [*classes, f'housing_diameter = "{outside:g} mm"']
    if entry.designation:
        return lines
    sizes = {"bore": entry.bore, "outside_diameter": entry.outside_diameter}
    lines += [f'{k} = "{1e3 * size:.5g} mm"' for k, size in sizes.items()]
    if entry.type in _PAIRED:
        lines.append(f'ring_width = "{1e3 * entry.width:.5g} mm"')
    return lines


def _load(entry: CatalogueEntry) -> list[str]:
    """Return the lines of a load within the capacity, known or estimated."""
    capacity = entry.dynamic_capacity
    part, share = _SHARE.get(entry.type, (0.1, "a tenth of C"))
    if capacity is None:
        capacity, share = _rough_capacity(_row(entry)), "moderate"
    load = f"{_round(part * capacity):g} N"
    half = f"{_round(0.5 * part * capacity):g} N"
    if _row(entry).is_thrust:
        comment = f"# axial, {share}, from the shaft washer at -z"
        return [f'load = {{ Fz = "{load}" }}  {comment}']
    if entry.type in ("angular_contact_ball", "four_point_ball"):
        comment = f"# axial {share}, radial half of it; +z closes the bearing"
        return [comment, f'load = {{ Fy = "-{half}", Fz = "{load}" }}']
    if entry.type == "tapered_roller":
        row = _row(entry)
        # More for steep contact angles, so that about half of the rollers are loaded.
        needed = 1.3 * np.tan(float(row.axis_angle + row.half_angle))
        axial = f"{_round(max(0.5, needed) * part * capacity):g} N"
        words = "half of it" if axial == half else "as its steep rollers need"
        comment = f"# radial {share}, axial {words}; +z closes the bearing"
        return [comment, f'load = {{ Fy = "-{load}", Fz = "{axial}" }}']
    return [f'load = {{ Fy = "-{load}" }}  # radial, {share}']


def _row(entry: CatalogueEntry) -> Any:
    """Return the first row of the bearing."""
    return rows_of(bearing_of_entry(entry))[0].bearing


def _speed(entry: CatalogueEntry) -> str:
    known = entry.reference_speed or entry.limiting_speed
    mean = 0.5e3 * (entry.bore + entry.outside_diameter)
    most = _TYPICAL["speed_factors"][entry.type] / mean
    most = 0.5 * _rpm(known) if known else most
    return f"{_round(min(_SPEED, most)):g} rpm"


def _rough_capacity(ball) -> float:
    """Estimate C [N] where it is not known: 18 N per mm² of all balls."""
    return 18e6 * ball.n_balls * float(ball.ball_diameter) ** 2


def _round(value: float) -> float:
    return float(f"{value:.2g}")


def _loads(entry: CatalogueEntry) -> str:
    if entry.dynamic_capacity is None:
        return f"C, C0 {entry.sources['capacity']}"
    loads = {
        "C": entry.dynamic_capacity,
        "C0": entry.static_capacity,
        "Pu": entry.fatigue_load_limit,
    }
    known = [f"{k} {1e-3 * v:.4g} kN" for k, v in loads.items() if v is not None]
    return f"{', '.join(known)} ({entry.sources['capacity']})"


def _rpm(speed: float) -> float:
    return speed * 30.0 / np.pi


def _comment(text: str) -> list[str]:
    """Wrap text to comment lines of at most 88 characters."""
    lines, line = [], "#"
    for word in text.split():
        if len(line) + len(word) > 87:
            lines.append(line)
            line = "#"
        line = f"{line} {word}"
    return [*lines, line]


def _toml(value: Any) -> str:
    if isinstance(value, Mapping):
        inner = ", ".join(f"{key} = {_toml(part)}" for key, part in value.items())
        return f"{{ {inner} }}"
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def scene_list() -> str:
    """Return a line for each shipped scene: name, command and title."""
    from ..study import study_of

    return "\n".join(
        f"{name:<20}{study_of(name):<9} {_title(path.read_text(encoding='utf-8'))}"
        for name, path in shipped_scenes().items()
    )


def _title(text: str) -> str:
    """Return the first sentence of the comment at the head of a scene."""
    head = re.match(r"(?:#.*\n)*", text)
    words = " ".join(line.lstrip("# ") for line in head[0].splitlines()) if head else ""
    return re.split(r"(?<=\w\w[).!?])(?<=[.!?])\s", words)[0].rstrip(".")

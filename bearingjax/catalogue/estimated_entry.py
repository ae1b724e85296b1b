"""Entry of an unlisted bearing, estimated from its boundary dimensions and ratings."""

from collections.abc import Mapping
from decimal import Decimal
from typing import Any

import numpy as np

from ..design import rows_of
from ..files.quantity import SceneError, to_si
from ..files.table import not_among
from .entry import (
    CLEARANCE,
    CLEARANCES,
    ENTRY_UNITS,
    CatalogueEntry,
    class_clearance,
    from_catalogue_unit,
)
from .estimate import estimate_geometry

SIZES = {
    "bore": "length",
    "outside": "length",
    "width": "length",
    "capacity": "force",
    "static_capacity": "force",
}
"""Required values in addition to the type, with their quantity kinds."""

_LENGTHS = ("pitch_diameter", "ball_diameter", "roller_diameter", "roller_length")
_INNER = "inner_raceway_radius"
_PARTS = {
    "deep_groove_ball": (),
    "angular_contact_ball": ("contact_angle",),
    "four_point_ball": ("shim_angle",),
    "self_aligning_ball": ("row_offset",),
    "thrust_ball": (),
    "cylindrical_roller": (),
    "needle_roller": (),
    "tapered_roller": ("roller_axis_angle", "roller_half_angle"),
    "spherical_roller": ("contact_angle", "roller_profile_radius", _INNER),
    "toroidal_roller": ("roller_profile_radius", "outer_raceway_radius", _INNER),
    "spherical_thrust_roller": ("contact_angle", "roller_profile_radius", _INNER),
    "cylindrical_thrust_roller": (),
    "crossed_roller": (),
}
"""Keys of each type besides the number and sizes of the rolling elements."""


def estimated_entry(
    kind: str, given: Mapping[str, str | None], contact_angle: str | None = None
) -> CatalogueEntry:
    """Return an entry with the internal geometry estimated by `estimate_geometry`.

    Args:
        kind: Type, as in a scene.
        given: Texts with units by the names in `SIZES`; `None` is missing.
        contact_angle: Text with unit; `None`: estimated.

    Returns:
        Entry without a designation.

    Raises:
        SceneError: For values that are missing, invalid, or have no such geometry.
    """
    if kind not in _PARTS:
        raise SceneError(f"--type: {not_among(kind, tuple(_PARTS))}")
    missing = [f"--{name.replace('_', '-')}" for name in SIZES if not given.get(name)]
    if missing:
        problem = "an unlisted bearing needs its sizes and ratings;"
        raise SceneError(f"--type {kind}: {problem} {', '.join(missing)} missing")
    numbers = {
        name: _read(name, str(given[name]), unit) for name, unit in SIZES.items()
    }
    angle = None
    if contact_angle is not None:
        angle = _read("contact_angle", contact_angle, "angle")
    try:
        found = estimate_geometry(
            numbers["bore"],
            numbers["outside"],
            numbers["width"],
            kind,
            numbers["capacity"],
            numbers["static_capacity"],
            contact_angle=angle,
        )
    except ValueError as error:
        raise SceneError(_by_options(str(error))) from error
    design, notes = _design(kind, rows_of(found.bearing)[0].bearing), [found.report()]
    if kind in CLEARANCES:
        try:
            design[CLEARANCE], note = class_clearance(kind, "CN", numbers["bore"])
        except ValueError:
            design[CLEARANCE], note = 0.0, "no class of clearance has limits here"
        notes.append(note)
    if kind == "cylindrical_roller":
        notes.append("no ribs: `arrangement` and `rib` of [bearing] give them")
    return CatalogueEntry(
        designation="",
        type=kind,
        bore=numbers["bore"],
        outside_diameter=numbers["outside"],
        width=numbers["width"],
        inner_width=None,
        outer_width=None,
        dynamic_capacity=numbers["capacity"],
        static_capacity=numbers["static_capacity"],
        fatigue_load_limit=None,
        reference_speed=None,
        limiting_speed=None,
        mass=None,
        other=None,
        geometry="estimated",
        assumed=tuple(k for k in _USUAL if k in design),
        sources={"capacity": "as given", "geometry": "estimate_geometry, from these"},
        notes=tuple(notes),
        design=design,
    )


_USUAL = (
    "outer_osculation",
    "inner_osculation",
    "roller_profile",
    "roller_profile_radius",
    "ribs",
)


def _read(name, text, unit) -> float:
    try:
        return to_si(text, unit)
    except SceneError as error:
        raise SceneError(f"--{name.replace('_', '-')}: {error}") from error


def _by_options(text: str) -> str:
    """Rephrase an error of `estimate_geometry` with the options of the command."""
    names = {
        "`outside_diameter`": "--outside",
        "`dynamic_capacity`": "--capacity",
        **{f"`{name}`": f"--{name.replace('_', '-')}" for name in (*SIZES, _ANGLE)},
    }
    text = text.removeprefix("estimate_geometry: ")
    for name, option in names.items():
        text = text.replace(name, option)
    return text


_ANGLE = "contact_angle"


def _design(kind: str, row: Any) -> dict[str, Any]:
    """Return the keywords of the design of an estimated row, to 4 to 6 digits."""
    element = "balls" if kind.endswith("ball") else "rollers"
    names = [f"n_{element}", *_LENGTHS, "outer_osculation", "inner_osculation"]
    design: dict[str, Any] = {"type": kind}
    for name in (*names, *_PARTS[kind]):
        # The outer raceway of a self-aligning bearing is a sphere.
        if hasattr(row, name) and (kind, name) != _SPHERE:
            design[name] = _round_as_printed(name, getattr(row, name))
    if element == "rollers" and _INNER not in design:
        design["roller_profile"] = {"type": "logarithmic"}
    if kind == "tapered_roller":
        rib, ends = row.ribs.inner_minus, ("end_radius", "contact_height")
        design["ribs"] = {
            "inner_minus": {k: _round_as_printed(k, getattr(rib, k), 4) for k in ends}
        }
        design[CLEARANCE] = 0.0
    return design


_SPHERE = ("self_aligning_ball", "outer_osculation")


def _round_as_printed(name: str, value: Any, digits: int = 5) -> Any:
    """Return a value as it would be printed."""
    if name.startswith("n_"):
        return int(value)
    if name.endswith("osculation"):
        return round(float(value), 6)
    if ENTRY_UNITS.get(name) == "deg":
        shown = f"{np.rad2deg(float(value)):.6g}"
    else:
        shown = f"{1e3 * float(value):.{digits}g}"
    return from_catalogue_unit(name, Decimal(shown))

"""The [[rotor.bearings]] and [bearings.NAME] tables of a scene: what holds a shaft."""

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..design import AbstractBallBearing
from ..element import Speed
from ..rotor import Housing, Shaft
from ..rotor.vibration import CubicExpansion, FixedAngle, MovingAngle
from ..statics import restrained_freedoms
from ..statics.installed import Installed
from .bearing_table import BESIDE, designated, read_bearing
from .catalogue_doubts import catalogue_doubts
from .catalogue_entry import FromCatalogue
from .fit_table import Fits, fit_warnings, installed, read_fits, turning
from .quantity import SceneError
from .read import read_element, scene_of
from .rotor_scene import Mount
from .scene_file import bearing_place, find_scene, parse_bearing, shipped_scenes
from .stations import read_station
from .table import Table, not_among

LAWS = {
    "fixed_angle": FixedAngle,
    "moving_angle": MovingAngle,
    "cubic": CubicExpansion,
}
_SAME = 1e-3
"""Difference of diameters, over the bore, from which a shaft is another one [1]."""


class _Bearing(NamedTuple):
    """A bearing by its name, its seats, and what its designation stands for."""

    name: str
    installed: Installed
    fits: Fits | None
    catalogue: FromCatalogue | None


def read_mounts(
    top: Table, rotor: Table, shaft: Shaft, speed: float, path: Path
) -> tuple[Mount, ...]:
    """What holds the shaft of a rotor.

    Args:
        top: The whole scene.
        rotor: Its [rotor].
        shaft: The shaft.
        speed: Of the rotor [rad/s], at which inner rings turn on their seats.
        path: Of the scene: others are named from there.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    for key in ("fit", "temperature"):
        if key in top:
            problem = "belongs to one of the bearings: write"
            raise top.error(key, f"{problem} [bearings.NAME.{key}]")
    tables = top.table("bearings")
    named = {name: _own(tables.table(name), name, speed) for name in tables.keys()}
    mounts, used = [], set()
    for table in rotor.tables("bearings"):
        station = read_station(table, shaft)
        if ("bearing" in table) == ("stiffness" in table):
            both = "bearing" in table
            problem = "give either `bearing` or this" if both else "is missing, and so"
            end = "" if both else " is `stiffness`; give one of them"
            raise table.error("stiffness" if both else "bearing", problem + end)
        if "stiffness" in table:
            mounts.append(_springs(table, station))
            continue
        bearing = _bearing(table, tables, named, speed, path)
        used.add(bearing.name)
        _check_seat(bearing, shaft, station)
        mounts.append(_mount(table, station, bearing))
    for name in named:
        if name not in used:
            raise tables.error(name, "is in no [[rotor.bearings]]; leave it out")
    return tuple(mounts)


def _own(table: Table, name: str, speed: float) -> _Bearing:
    """A bearing of [bearings.NAME]."""
    design, force = read_bearing(table, table)
    found = designated(table)
    catalogue = None if found is None else found[1]
    for text in () if found is None else catalogue_doubts(*found):
        warnings.warn(f"{name}: {text}", stacklevel=2)
    design, fits = read_fits(table, table, design, Speed(speed, 0.0), catalogue)
    contact, numerics = table.table("contact"), table.table("numerics")
    element = read_element(design, contact, table, numerics)
    return _told(name, element, force, fits, catalogue)


def _told(name, element, force, fits, catalogue) -> _Bearing:
    """A bearing; what is odd about its fits is warned of."""
    for text in () if fits is None else fit_warnings(fits, element.bearing):
        warnings.warn(f"{name}: {text}", stacklevel=2)
    return _Bearing(name, installed(element, force, fits, catalogue), fits, catalogue)


def _check_seat(bearing: _Bearing, shaft: Shaft, station: int) -> None:
    """Warn of a bearing, or of its fit, on another shaft than that of the station."""
    beside = [k for k in (station - 1, station) if 0 <= k < shaft.n_segments]
    diameters = np.stack([np.asarray(shaft.outer_diameter), np.asarray(shaft.bore)])
    there = diameters[:, beside].T
    if bearing.fits is not None:
        seat = bearing.fits.mounting
        wanted = np.array([float(seat.bore), float(seat.shaft_bore)])
        has = (
            f"its fit has a shaft of {1e3 * wanted[0]:.5g} mm with a bore of"
            f" {1e3 * wanted[1]:.5g} mm (`shaft_bore`)"
        )
        sizes = " or ".join(f"{1e3 * a:.5g} and {1e3 * b:.5g}" for a, b in there)
    elif bearing.catalogue is not None:
        entry = bearing.catalogue.entry
        wanted, there = np.array([entry.bore]), there[:, :1]
        has = f"{entry.designation} has a bore of {1e3 * entry.bore:.5g} mm"
        sizes = " or ".join(f"{1e3 * size:.5g}" for size in dict.fromkeys(there[:, 0]))
    else:
        return
    if (np.abs(there - wanted) < _SAME * wanted[0]).all(axis=1).any():
        return
    warnings.warn(
        f"{bearing.name}: {has}; at station {station} the shaft has {sizes} mm",
        stacklevel=2,
    )


def _bearing(
    table: Table, tables: Table, named: dict[str, _Bearing], speed: float, path: Path
) -> _Bearing:
    name = table.word("bearing")
    if table.raw("bearing") != name or name is None:
        raise table.error("bearing", f"{table.raw('bearing')!r} is not a name")
    if name in named:
        return named[name]
    place = bearing_place(name, path)
    if place.suffix != ".toml":
        here = (*named, *shipped_scenes())
        problem = not_among(name, here)
        raise table.error("bearing", f"{problem}, or the path of a .toml scene")
    try:
        found = find_scene(place)
        scene = scene_of(parse_bearing(found, ()), found)
    except SceneError as error:
        raise table.error("bearing", error) from error
    # In the echo it is one of [bearings.NAME].
    own = name if scene.name in named else scene.name
    table.fill("bearing", own)
    tables.fill(own, _echoed(scene.inputs))
    fits = turning(scene.fits, speed)
    force = scene.preload_force
    return _told(scene.name, scene.element, force, fits, scene.catalogue)


def _echoed(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The inputs of a scene as those of one bearing of a rotor."""
    beside = {key: dict(inputs[key]) for key in BESIDE if key in inputs}
    beside.get("numerics", {}).pop("tolerance", None)  # of its own load solve
    operating = inputs.get("operating", {})
    chosen = {key: operating[key] for key in BESIDE if key in operating}
    return {**inputs["bearing"], **beside, **chosen}


def _mount(table: Table, station: int, bearing: _Bearing) -> Mount:
    design = bearing.installed.drawing.bearing
    preload = table.quantity("preload", "force", None)
    offset = table.quantity("offset", "length", None)
    if preload is not None and offset is not None:
        raise table.error("preload", "give either `offset` or this, not both")
    if preload is not None:
        if not preload > 0.0:
            raise table.error("preload", f"{preload:g} N is not allowed; above 0 N")
        if "uz" not in restrained_freedoms(design):
            problem = "is axial, and this bearing holds no axial load; leave it out"
            raise table.error("preload", f"{problem}, or give it a negative clearance")
    law = table.choice("law", tuple(LAWS), None)
    inertia = table.flag("inertia", False)
    if law is not None:
        if not isinstance(design, AbstractBallBearing) or len(design.grooves) != 2:
            problem = "is for one row of balls with one groove in each ring"
            raise table.error("law", problem)
        if preload is None and offset is None:
            problem = "is missing; the law is that of a preloaded bearing"
            raise table.error("preload", problem)
        if inertia:
            raise table.error("inertia", "is for the true bearing, not for a `law`")
    return Mount(
        station=station,
        name=bearing.name,
        installed=bearing.installed,
        fits=bearing.fits,
        preload=preload,
        offset=0.0 if offset is None else offset,
        law=law,
        turned=table.flag("turned", False),
        inertia=inertia,
        stiffness=(),
        damping=_dampers(table),
        housing=_housing(table),
    )


def _springs(table: Table, station: int) -> Mount:
    stiffness = table.table("stiffness")
    values = _isotropic(stiffness, "stiffness", "tilting stiffness")
    if not any(values):
        stiffness.finish()
        raise stiffness.error("radial", "is missing, and so are `axial` and `tilt`")
    for key in ("preload", "offset", "law", "turned", "inertia"):
        if key in table:
            raise table.error(key, "goes with a `bearing`, not with `stiffness`")
    return Mount(
        station=station,
        name="springs",
        installed=None,
        fits=None,
        preload=None,
        offset=0.0,
        law=None,
        turned=False,
        inertia=False,
        stiffness=values,
        damping=_dampers(table),
        housing=_housing(table),
    )


def _dampers(table: Table) -> tuple[float, ...]:
    return _isotropic(table.table("damping"), "damping", "tilting damping")


def _isotropic(table: Table, kind: str, tilting: str) -> tuple[float, ...]:
    """One number for each of ux uy uz gx gy; x and y may differ."""
    sides = [side for side in ("x", "y") if side in table]
    if sides and "radial" in table:
        raise table.error(sides[0], "give either `radial` or `x` and `y`")
    if sides:
        across = [_at_least_zero(table, side, kind, None) for side in ("x", "y")]
    else:
        across = 2 * [_at_least_zero(table, "radial", kind, 0.0)]
    axial = _at_least_zero(table, "axial", kind, 0.0)
    tilt = _at_least_zero(table, "tilt", tilting, 0.0)
    return (*across, axial, tilt, tilt)


def _at_least_zero(table: Table, key: str, kind: str, default: float | None) -> float:
    given = () if default is None else (default,)
    value = table.quantity(key, kind, *given)
    if value < 0.0:
        raise table.error(key, f"{value:g} is not allowed; at least 0")
    return value


def _housing(table: Table) -> Housing | None:
    if "housing" not in table:
        return None
    housing = table.table("housing")
    mass = housing.quantity("mass", "mass")
    stiffness = _of_axes(housing, "stiffness", ())
    damping = _of_axes(housing, "damping", (0.0,))
    with housing.building():
        return Housing(mass, stiffness, damping)


def _of_axes(table: Table, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """One number for all of x, y and z, or a table with one for each."""
    if isinstance(table.raw(key, None), Mapping):
        axes = table.table(key)
        return tuple(_at_least_zero(axes, axis, key, None) for axis in "xyz")
    return 3 * (_at_least_zero(table, key, key, *(default or (None,))),)

"""The [[rotor.bearings]] and [bearings.NAME] tables of a scene: shaft supports."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...design import AbstractBallBearing
from ...element import BearingElement, Speed
from ...files.quantity import SceneError
from ...files.scene_file import bearing_place, find_scene, parse_bearing, shipped_scenes
from ...files.schema import Keys, key_of, scene_key
from ...files.schema_text import number_schema, object_schema
from ...files.table import Table, not_among
from ...numerics.warning import Warning, warnings_of
from ...rotor import BearingSupport, Housing, Shaft, Unbalance
from ...rotor.nonlinear import CubicExpansion, FixedAngle, MovingAngle
from ...statics import Installed, restrained_freedoms
from ..bearing.placed_bearing import bearing_inputs, read_machine_bearing, seat_misfits
from ..bearing.read_scene import Scene, scene_of

FORCE_LAWS = {
    "fixed_angle": FixedAngle,
    "moving_angle": MovingAngle,
    "cubic": CubicExpansion,
}

_OF_BEARING: Any = {
    "needs": ("bearing",),
    "without": {"stiffness": "goes with a `bearing`, not with `stiffness`"},
}


def _direction(about: str, kind: str) -> Any:
    return scene_key(about, kind, default=0.0, least=0)


def _side(about: str, kind: str, other: str) -> Any:
    without = {"radial": "give either `radial` or `x` and `y`"}
    return scene_key(about, kind, least=0, needs=(other,), without=without)


class SpringKeys(Keys):
    about = "[rotor.bearings.stiffness]: springs in place of a bearing"

    radial: float = _direction("across the shaft", "stiffness")
    x: float | None = _side("along x, where y differs", "stiffness", "y")
    y: float | None = _side("along y", "stiffness", "x")
    axial: float = _direction("along the shaft", "stiffness")
    tilt: float = _direction("against tilting about x and y", "tilting stiffness")

    def check(self) -> None:
        if self.x is not None:
            self.table.fill("radial", None)

    @property
    def diagonal(self) -> tuple[float, ...]:
        """Diagonal for ux, uy, uz, gx, gy (5,) [N/m, N m]; dampers [N s/m, N m s]."""
        across = (self.radial if one is None else one for one in (self.x, self.y))
        return (*across, self.axial, self.tilt, self.tilt)


class DamperKeys(SpringKeys):
    about = "[rotor.bearings.damping]: dampers beside the bearing or the springs"

    radial: float = _direction("across the shaft", "damping")
    x: float | None = _side("along x, where y differs", "damping", "y")
    y: float | None = _side("along y", "damping", "x")
    axial: float = _direction("along the shaft", "damping")
    tilt: float = _direction("against tilting about x and y", "tilting damping")


def _of_axes(about: str, kind: str, **default: float) -> Any:
    """Return a field of one number for x, y and z, or a table with one for each."""
    usual = tuple(default.values())

    def read_axes(table: Table, key: str) -> list[float]:
        apart = isinstance(table.raw(key, None), Mapping)
        place, names = (table.table(key), "xyz") if apart else (table, 3 * [key])
        found = []
        for name in names:
            found.append(place.quantity(name, kind, *(() if apart else usual)))
            if found[-1] < 0.0:
                raise place.error(name, f"{found[-1]:g} is not allowed; at least 0")
        return found

    axes = object_schema({axis: number_schema(kind) for axis in "xyz"}, list("xyz"))
    json = {"anyOf": [number_schema(kind), axes]}
    return scene_key(about, kind, **default, least=0, reader=read_axes, json=json)


class HousingKeys(Keys):
    about = (
        "[rotor.bearings.housing]: a mass on springs, between the bearing and ground"
    )

    mass: float = key_of(Housing, "mass", above=0)
    stiffness: list[float] = _of_axes(
        "springs against ground, along each axis", "stiffness"
    )
    damping: list[float] = _of_axes(
        "dampers against ground, along each axis", "damping", default=0.0
    )

    def check(self) -> None:
        _ = self.housing  # which it may refuse

    @property
    def housing(self) -> Housing:
        """Housing between the bearing and ground."""
        with self.table.building():
            return Housing(**self.given)


class MountKeys(Keys):
    about = "[[rotor.bearings]]: supports of the shaft, each a bearing or springs"

    station: int = key_of(Unbalance, "station")
    bearing: str | None = scene_key(
        "NAME of [bearings.NAME], or name or path of the scene of a bearing"
    )
    stiffness: SpringKeys | None = scene_key(
        "springs in place of a bearing", without={"bearing": ""}
    )
    preload: float | None = scene_key(
        "axial force that the bearing bears before the shaft gives way",
        "force",
        above=0,
        hint="without preload leave it out",
        needs=("bearing",),
        without={**_OF_BEARING["without"], "offset": ""},
    )
    offset: float | None = scene_key(
        "axial displacement of the inner ring", "length", otherwise="0 m", **_OF_BEARING
    )
    law: str | None = scene_key(
        "published law of a preloaded bearing in its place",
        choices=tuple(FORCE_LAWS),
        otherwise="the bearing itself",
        **_OF_BEARING,
    )
    turned: bool = key_of(BearingSupport, "turned", **_OF_BEARING)
    inertia: bool = key_of(BearingSupport, "inertia", **_OF_BEARING)
    damping: DamperKeys = scene_key("dampers beside it", default=DamperKeys)
    housing: HousingKeys | None = scene_key(
        "mass on springs on which it stands", otherwise="ground"
    )

    def check(self) -> None:
        if self.stiffness is not None and not any(self.stiffness.diagonal):
            springs = self.stiffness.table
            springs.finish()
            raise springs.error("radial", "is missing, and so are `axial` and `tilt`")
        if self.bearing is None and self.stiffness is None:
            problem = "is missing, and so is `stiffness`; give one of them"
            raise self.table.error("bearing", problem)


@dataclasses.dataclass(frozen=True)
class Mount:
    """Support of a station of the shaft, in SI.

    Attributes:
        keys: Its [[rotor.bearings]].
        scene: The bearing as a scene of its own, with its [life], its seats at the
            speed of the rotor; `None`: springs.
    """

    keys: MountKeys
    scene: Scene | None = None

    @property
    def station(self) -> int:
        """Number of its station."""
        return self.keys.station

    @property
    def name(self) -> str:
        """Name of the bearing; "springs" without one."""
        return "springs" if self.scene is None else self.scene.name

    @property
    def installed(self) -> Installed | None:
        """The bearing with its preload and seats, or `None`: springs."""
        return None if self.scene is None else self.scene.installed

    @property
    def element(self) -> BearingElement[Any] | None:
        """The bearing before preloading and mounting."""
        return None if self.installed is None else self.installed.drawing


def read_mounts(
    top: Table, holds: tuple[MountKeys, ...], shaft: Shaft, speed: float, path: Path
) -> tuple[tuple[Mount, ...], list[Warning]]:
    """Read the supports of the shaft of a rotor, and return warnings about them.

    Args:
        top: The whole scene.
        holds: Its [[rotor.bearings]].
        shaft: The shaft.
        speed: Speed of the rotor and of the inner rings on their seats [rad/s].
        path: Path of the scene, to which names of other scenes are relative.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    for key in ("fit", "temperature"):
        if key in top:
            problem = "belongs to one of the bearings: write"
            raise top.error(key, f"{problem} [bearings.NAME.{key}]")
    tables = top.table("bearings")
    named: dict[str, Scene] = {}
    mounts, warned = [], []
    for name in tables.keys():
        scene = read_machine_bearing(top, tables.table(name), name, path, speed=speed)
        named[name] = _in_rotor(scene, speed)
        warned += warnings_of(name, scene.warnings)
    for keys in holds:
        bearing = _bearing(keys, top, named, speed, path)
        if bearing is not None:
            found = seat_misfits(bearing, shaft, keys.station)
            if keys.bearing not in named:
                found = [*bearing.installed.seat_warnings(), *found]
            warned += warnings_of(bearing.name, found)
            _check_bearing(keys, bearing.element.bearing)
        mounts.append(Mount(keys, bearing))
    for name in named:
        if name not in [keys.bearing for keys in holds]:
            raise tables.error(name, "is in no [[rotor.bearings]]; leave it out")
    return tuple(mounts), warned


def _in_rotor(scene: Scene, speed: float) -> Scene:
    """Return the scene of a bearing with its fits at the speed of the rotor."""
    turning = scene.installed.with_speed(Speed(speed, 0.0))
    return dataclasses.replace(scene, installed=turning)


def _bearing(
    keys: MountKeys, top: Table, named: dict[str, Scene], speed: float, path: Path
) -> Scene | None:
    """Return the scene of the bearing of a mount; `None` of springs."""
    table, tables, name = keys.table, top.table("bearings"), keys.bearing
    if name is None:
        return None
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
    # In the echo it becomes one of [bearings.NAME].
    own = name if scene.name in named else scene.name
    table.fill("bearing", own)
    inputs = bearing_inputs(scene.inputs)
    tables.fill(own, inputs)
    inside = Table(inputs, path.name, f"bearings.{own}")
    placed = read_machine_bearing(top, inside, scene.name, path, speed=speed)
    return _in_rotor(placed, speed)


def _check_bearing(keys: MountKeys, design: Any) -> None:
    """Raise SceneError for keys that do not suit the bearing."""
    table = keys.table
    if keys.preload is not None and "uz" not in restrained_freedoms(design):
        problem = "is axial, and this bearing holds no axial load; leave it out"
        raise table.error("preload", f"{problem}, or give it a negative clearance")
    if keys.law is None:
        return
    if not isinstance(design, AbstractBallBearing) or len(design.grooves) != 2:
        problem = "is for one row of balls with one groove in each ring"
        raise table.error("law", problem)
    if keys.preload is None and keys.offset is None:
        problem = "is missing; the law is that of a preloaded bearing"
        raise table.error("preload", problem)
    if keys.inertia:
        raise table.error("inertia", "is for the true bearing, not for a `law`")

"""Read the scene of a system of shafts: shafts, wheels, bearings, housing, drive."""

import copy
import dataclasses
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...cases.cases import check_hours
from ...element.frame import LOADS
from ...files.output_files import read_matrix
from ...files.quantity import SceneError, to_si
from ...files.scene_errors import error_at, problem_of
from ...files.scene_file import assign, find_scene, is_shafts, parse_scene
from ...files.schema import (
    Keys,
    build,
    direction_key,
    fields_of,
    key_of,
    read_keys,
    scene_key,
)
from ...files.table import Table
from ...life.life import LifeConditions
from ...numerics.constants import GRAVITY
from ...numerics.warning import Warning, warnings_of
from ...shafts import (
    Coupling,
    Drive,
    Gear,
    HeatNetwork,
    HousingStiffness,
    Pulley,
    Seat,
    ShaftLine,
    ShaftLoad,
    ShaftSystem,
)
from ...shafts.duty import align_systems
from ..bearing.life_ratings import life_conditions
from ..bearing.placed_bearing import read_machine_bearing, seat_misfits
from ..bearing.read_scene import Scene
from ..cases.case_keys import CasesKeys, VariedKey
from ..rotor.mounts import SpringKeys
from ..rotor.read import SegmentKeys as RotorSegmentKeys
from .read_heat import heat_warnings, read_heat

VECTORS = {
    sign + name: tuple(factor * np.eye(3)[k])
    for sign, factor in (("", 1.0), ("-", -1.0))
    for k, name in enumerate("xyz")
}
"""Directions along the global axes, by name."""
_MOST_CASES = 20_000
_NAMES = {"bearing": "bearings"} | {
    f"{name}s": name for name in ("shaft", "gear", "belt", "coupling", "load")
}
"""Names of tables as they may be mistaken, and the right ones."""


class SegmentKeys(RotorSegmentKeys):
    about = "[[shaft.NAME.segments]]: segments of the shaft, one after the other"


class ShaftKeys(Keys):
    about = "[shaft.NAME]: a shaft; positions on it count from its first segment"

    segments: tuple[SegmentKeys, ...] = scene_key("segments of the shaft")
    axis: tuple[float, ...] = direction_key(
        "direction of the shaft in global axes", VECTORS, "z"
    )
    position: tuple[float, ...] | None = scene_key(
        "start of the first segment in global axes, [x, y, z]",
        "length",
        otherwise="not known: meshes are placed by `mesh_angle`",
    )
    rigid: bool = key_of(ShaftLine, "rigid")
    speed: float | None = scene_key(
        "speed, from local x towards local y, in place of `drive.speed`", "speed"
    )

    def check(self) -> None:
        if self.position is not None and len(self.position) != 3:
            problem = f"has {len(self.position)} numbers; it must have three, x, y, z"
            raise self.table.error("position", problem)

    def line(self, name: str) -> ShaftLine:
        """Build the shaft."""
        rows = [(s.length, s.outer_diameter, s.bore, s.material) for s in self.segments]
        columns = zip(*rows, strict=True)
        with self.table.building():
            ends = dict(axis=self.axis, origin=self.position)
            return ShaftLine(name, *columns, **ends, rigid=self.rigid)


PART_CLASSES: dict[str, type[Any]] = {
    "gear": Gear,
    "belt": Pulley,
    "coupling": Coupling,
    "load": ShaftLoad,
}
"""Classes of the parts, by their tables [KIND.NAME]."""


def _part(
    table: Table, kind: type[Any], name: str, shafts: Mapping[str, ShaftKeys]
) -> Any:
    """Build a part from its table."""
    given: dict[str, Any] = {"name": name, "shaft": _shaft_of(table, shafts)}
    if kind is not Coupling:
        given["position"] = _position(table, given["shaft"], shafts)
    if kind is ShaftLoad:
        kinds = ["force"] * 3 + ["moment"] * 3
        six = [table.quantity(n, k, 0.0) for n, k in zip(LOADS, kinds, strict=True)]
        given |= {"force": six[:3], "moment": six[3:]}
    return build(kind, table, **given)


def _shaft_of(table: Table, shafts: Mapping[str, ShaftKeys]) -> str:
    """Return the name of the shaft of a part, by default of the only one."""
    if "shaft" not in table and len(shafts) == 1:
        table.fill("shaft", next(iter(shafts)))
        return next(iter(shafts))
    return table.choice("shaft", tuple(shafts))


def _position(table: Table, shaft: str, shafts: Mapping[str, ShaftKeys]) -> float:
    """Return the position of a part on its shaft, given or that of a station [m]."""
    lengths = [segment.length for segment in shafts[shaft].segments]
    if "station" in table:
        if "position" in table:
            raise table.error("station", "give either `position` or this, not both")
        station = table.integer("station", least=0)
        if station > len(lengths):
            problem = f"{station} is not a station; from 0 to {len(lengths)}"
            raise table.error("station", problem)
        return sum(lengths[:station])
    position = table.quantity("position", "length")
    if not -1e-12 <= position <= sum(lengths) * (1 + 1e-9):
        ends = f"from 0 to {1e3 * sum(lengths):.6g} mm"
        problem = f"{1e3 * position:.6g} mm is beyond the ends of {shaft}, {ends}"
        raise table.error("position", problem)
    return position


def _source(about: str, kind: str, other: str) -> Any:
    return scene_key(about, kind, without={other: ""})


class DriveKeys(Keys):
    about = "[drive]: where power enters the system, and how fast it turns"

    into: str | None = scene_key(
        "shaft, driven through a coupling, or wheel without a mate",
        otherwise="the first shaft",
    )
    speed: float | None = key_of(Drive, "speed", default=None)
    torque: float | None = _source("on that shaft, about its z", "moment", "power")
    power: float | None = _source("into that shaft", "power", "torque")


class SeatKeys(Keys):
    about = (
        "[bearings.NAME]: a bearing on a shaft, and beside these the keys of a bearing"
    )

    housing: tuple[float, ...] | None = scene_key(
        "stiffness of the housing at this seat along global x, y and z",
        "stiffness",
        otherwise="rigid",
    )
    stiffness: SpringKeys | None = scene_key("springs in place of the bearing")

    def check(self) -> None:
        if self.housing is not None and len(self.housing) != 3:
            problem = f"has {len(self.housing)} numbers; it must have three, x, y, z"
            raise self.table.error("housing", problem)
        if self.housing is not None and min(self.housing) < 0:
            problem = f"{min(self.housing):g} N/m is negative; a housing resists"
            raise self.table.error("housing", problem)

    def seat(
        self, name: str, shafts: Mapping[str, ShaftKeys], scene: Scene | None
    ) -> Seat:
        """Build the bearing in its place.

        Args:
            name: Name of the bearing.
            shafts: All shafts by their names.
            scene: The bearing alone; `None` of springs.
        """
        springs, shaft = self.stiffness, _shaft_of(self.table, shafts)
        return build(
            Seat,
            self.table,
            name=name,
            shaft=shaft,
            position=_position(self.table, shaft, shafts),
            installed=None if scene is None else scene.installed,
            stiffness=None if springs is None else springs.diagonal,
        )


class HousingKeys(Keys):
    about = "[housing]: one stiffness matrix over several seats"

    file: str = scene_key(
        "matrix in SI, in global axes, seat by seat (ux uy uz), or with (gx gy gz):"
        " .csv, .npy, or MatrixMarket .mtx"
    )
    seats: tuple[str, ...] = scene_key("bearings, in the order of the matrix")


class SystemKeys(Keys):
    about = "[system]: numbers and settings common to all shafts"

    gravity: str = scene_key(
        "direction of the weight of the shafts in global axes",
        choices=("none", *VECTORS),
        default="none",
    )


@dataclasses.dataclass(frozen=True)
class ShaftScene:
    """Scene of a system of shafts, in SI.

    Attributes:
        name: Name of the file without its ending.
        system: The system.
        bearings: Scene of each bearing alone, turning as in the system; `None` of
            springs.
        lives: Conditions of the life of each bearing; `None` of springs.
        heat: Paths of the friction heat, or `None`: temperatures are as given.
        times: Times at which the warming up is reported (time,) [s], or `None`.
        pauses: Temperatures of cases at rest, "ambient" or "mean".
        hours: Time in this case [h]; `None` without cases.
        cases: Each load case as a scene of its own; empty without [cases].
        varied: Keys that vary from case to case.
        settings: Their values as written, of each case.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, in SI (`Scene.inputs`).
    """

    name: str
    system: ShaftSystem
    bearings: tuple[Scene | None, ...]
    heat: HeatNetwork | None
    times: np.ndarray | None
    pauses: str
    warnings: tuple[Warning, ...]
    lives: tuple[LifeConditions | None, ...] = ()
    hours: float | None = None
    cases: tuple["ShaftScene", ...] = ()
    varied: tuple[str, ...] = ()
    settings: tuple[dict[str, Any], ...] = ()
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)


def read_shafts(source: str | Path, settings: Iterable[str] = ()) -> ShaftScene:
    """Read the scene of a system of shafts.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    return shafts_of(parse_scene(path, settings), path)


def shafts_of(data: dict[str, Any], path: Path) -> ShaftScene:
    """Read the scene of a system of shafts that is parsed.

    Raises: as `read_scene`.
    """
    for key in data:
        name = _NAMES.get(key)
        if name is not None and ("shaft" in data or name == "shaft"):
            problem = f"in a system of shafts write [{name}.NAME] for [{key}.NAME]"
            raise error_at(path, key, problem)
    if not is_shafts(data):
        problem = "the scene of a system of shafts has [shaft.NAME] and [bearings.NAME]"
        raise error_at(path, "shaft", problem)
    known: dict[str, Any] = {}
    columns: list[VariedKey] = []
    if "cases" in data:
        keys = read_keys(CasesKeys, Table(data, path).table("cases"))
        columns, _ = keys.columns(path, may_record=False)
    elsewhere = ("cases", "optimise", "tolerances", "identify", "select")
    alone = {key: value for key, value in data.items() if key not in elsewhere}
    if not columns:
        return _with_lives(_read(alone, path, known), path)
    count = columns[0].index.size
    if count > _MOST_CASES:
        problem = f"{count} cases are too many; at most {_MOST_CASES}"
        raise error_at(path, "cases", problem)
    cases, every = [], []
    for case in range(count):
        changed = copy.deepcopy(alone)
        values = {c.key: c.values[c.index[case]] for c in columns}
        hours = values.pop("hours", None)
        for key, value in values.items():
            if key.partition(".")[0] not in _VARYING:
                problem = "cannot vary; what can: `hours`, and whole keys such as"
                problem = f'{problem} "drive.power", in quotes, of {_ALLOWED}'
                raise error_at(path, f"cases.{key}", problem)
            assign(changed, key, value, path.name)
        try:
            one = _read(changed, path, known)
        except SceneError as error:
            raise SceneError(f"{error} (case {case})") from error
        if hours is not None:  # of which a CSV has numbers already
            hours = float(to_si(hours, "duration") if isinstance(hours, str) else hours)
        cases.append(dataclasses.replace(one, hours=hours))
        every.append(values)
    try:
        given = [one.hours for one in cases]
        check_hours(None if None in given else given)
        systems = align_systems([one.system for one in cases])
    except ValueError as error:
        problem = problem_of(error)
        if problem.startswith("`hours` "):
            raise error_at(path, "cases.hours", problem[8:]) from error
        raise SceneError(f"{path.name}: {problem}") from error
    cases = [
        _with_lives(dataclasses.replace(one, system=system), path)
        for one, system in zip(cases, systems, strict=True)
    ]
    first = cases[0]
    warned = dict.fromkeys(text for one in cases for text in one.warnings)
    return dataclasses.replace(
        first,
        hours=None,
        cases=tuple(cases),
        varied=tuple(c.key for c in columns if c.key != "hours"),
        settings=tuple(every),
        warnings=tuple(warned),
        inputs={**first.inputs, "cases": data["cases"]},
    )


_VARYING = (
    "drive load bearings gear belt coupling shaft life lubricant system heat".split()
)
_ALLOWED = ", ".join(_VARYING)


def _with_lives(scene: ShaftScene, path: Path) -> ShaftScene:
    """Return a scene with the conditions of the lives of its bearings."""
    turning = scene.system.inertia is not None
    if scene.heat is not None and not turning:
        problem = "needs a `speed` of the drive; at rest nothing warms"
        raise error_at(path, "heat", problem)
    lives = (
        None if one is None else life_conditions(one, turning) for one in scene.bearings
    )
    return dataclasses.replace(scene, lives=tuple(lives))


def _read(data: dict[str, Any], path: Path, known: dict[str, Any]) -> ShaftScene:
    top = Table(data, path)
    scene = _scene(top, path, known)
    top.finish()
    return dataclasses.replace(scene, inputs=top.echo())


def _scene(top: Table, path: Path, known: dict[str, Any]) -> ShaftScene:
    tables = top.table("shaft")
    shafts = {name: read_keys(ShaftKeys, tables.table(name)) for name in tables.keys()}
    parts: dict[str, list[Any]] = {}
    for key, kind in PART_CLASSES.items():
        tables = top.table(key)
        parts[key] = [
            _part(tables.table(name), kind, name, shafts) for name in tables.keys()
        ]
    if "bearings" not in top:
        raise top.error("bearings", "is missing; [bearings.NAME] hold the shafts")
    wheels = *parts["gear"], *parts["belt"]
    drive = _drive(top, shafts, tuple(wheel.name for wheel in wheels))
    tables = top.table("bearings")
    own = {name: tables.table(name) for name in tables.keys()}
    seats = {name: read_keys(SeatKeys, table) for name, table in own.items()}
    alone = {
        name: _bearing(top, own[name], keys, name, path, known)
        for name, keys in seats.items()
    }
    system = read_keys(SystemKeys, top.table("system"))
    pull = (0.0, 0.0, 0.0)
    if system.gravity != "none":
        pull = tuple(GRAVITY * x for x in VECTORS[system.gravity])
    housing = _housing(top, seats, path)
    made = [keys.seat(name, shafts, alone[name]) for name, keys in seats.items()]
    with top.building():
        whole = ShaftSystem(
            [keys.line(name) for name, keys in shafts.items()],
            made,
            drive,
            wheels,
            parts["coupling"],
            parts["load"],
            housing,
            pull,
        )
    warned: list[Warning] = []
    for seat, scene in zip(made, alone.values(), strict=True):
        if scene is not None:
            index, station = whole.station(seat)
            misfits = seat_misfits(scene, whole.beam(index), station)
            warned += warnings_of(seat.name, misfits)
    heat, keys = read_heat(top, own, alone)
    if heat is not None:
        warned += heat_warnings(alone)
    for name, scene in alone.items():
        if scene is not None:
            warned += warnings_of(name, scene.warnings)
    return ShaftScene(
        name=path.stem,
        system=whole,
        bearings=tuple(alone.values()),
        heat=heat,
        times=None if keys is None else keys.instants,
        pauses="ambient" if keys is None else keys.pauses,
        warnings=tuple(dict.fromkeys(warned)),
    )


def _drive(top: Table, shafts: Mapping[str, ShaftKeys], wheels: Any) -> Drive | None:
    """Read the drive; the speed of any shaft may stand in place of its own."""
    given = {
        name: keys.speed for name, keys in shafts.items() if keys.speed is not None
    }
    if "drive" not in top and not given:
        return None
    keys = read_keys(DriveKeys, top.table("drive"))
    into = keys.into
    if into is None:
        into = next(iter(given), next(iter(shafts)))
        keys.fill(into=into)
    if into not in (*shafts, *wheels):
        problem = f"{into!r} is neither a shaft nor a wheel; one of"
        raise keys.table.error("into", f"{problem} {', '.join((*shafts, *wheels))}")
    speed = keys.speed
    for name, value in given.items():
        if speed is not None or name != into or len(given) > 1:
            problem = "is given beside `drive.speed` or of a shaft that is not driven;"
            cure = "give one speed, that of the driven shaft; the teeth give the others"
            raise shafts[name].table.error("speed", f"{problem} {cure}")
        speed = value
    with keys.table.building():
        return Drive(into, 0.0 if speed is None else speed, keys.torque, keys.power)


def _housing(
    top: Table, seats: Mapping[str, SeatKeys], path: Path
) -> HousingStiffness | None:
    springs = {
        name: keys.housing for name, keys in seats.items() if keys.housing is not None
    }
    if "housing" not in top:
        return HousingStiffness.of_seats(springs) if springs else None
    keys = read_keys(HousingKeys, top.table("housing"))
    if springs:
        problem = f"stands beside `housing` of bearing {next(iter(springs))}; give one"
        raise keys.table.error("file", problem)
    try:
        matrix = read_matrix(path.parent / keys.file)
    except ValueError as error:
        raise keys.table.error("file", problem_of(error)) from error
    with keys.table.building():
        return HousingStiffness(keys.seats, matrix)


OF_SEAT = ("shaft", "position", "station", "heat") + tuple(
    one.name for kind in (Seat, SeatKeys) for one in fields_of(kind)
)


def _bearing(
    top: Table,
    table: Table,
    keys: SeatKeys,
    name: str,
    path: Path,
    known: dict[str, Any],
) -> Scene | None:
    """Read a bearing as a scene of its own; `None` of springs."""
    if keys.stiffness is None:
        return read_machine_bearing(top, table, name, path, OF_SEAT, known=known)
    own = [key for key in table.keys_given() if key not in OF_SEAT]
    if own:
        problem = "goes with a bearing, not with springs (`stiffness`)"
        raise table.error(own[0], problem)
    return None

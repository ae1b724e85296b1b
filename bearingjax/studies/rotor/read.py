"""Read the scene of a rotor: shaft, discs, loads, bearings and analyses."""

import dataclasses
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...design import Material
from ...element.frame import LOADS
from ...files.quantity import scene_number
from ...files.scene_file import find_scene, is_rotor, parse_scene
from ...files.schema import Keys, key_of, read_keys, scene_key
from ...files.table import Table, written_numbers
from ...numerics.constants import GRAVITY
from ...numerics.warning import Warning
from ...rotor import (
    AbstractDamping,
    AbstractPart,
    Disc,
    ModalDamping,
    PointMass,
    ProportionalDamping,
    Rotor,
    RotorLoads,
    Shaft,
    StationForce,
    Unbalance,
)
from ..bearing.read_design import read_material
from ..bearing.read_operating import LoadKeys
from .mounts import Mount, MountKeys, read_mounts
from .tasks import CampbellKeys, ResponseKeys, TransientKeys

GRAVITY_BY_AXIS = {
    "horizontal": (0.0, -GRAVITY, 0.0),
    "vertical": (0.0, 0.0, -GRAVITY),
    "none": (0.0, 0.0, 0.0),
}
"""Gravity by shaft axis [m/s²]."""
MOST_ELEMENTS = 200
"""Most elements of a shaft: eigenvalues of 2000 states take minutes."""


def _material(table: Table, key: str) -> Material:
    """Read a material, by default steel; the echo gets its numbers."""
    material = read_material(table, key) or Material()
    table.fill(key, written_numbers(material))
    return material


MATERIAL: Any = {
    "default": None,
    "otherwise": "steel",
    "reader": _material,
    "json": {"$ref": "#/$defs/material"},
}


class SegmentKeys(Keys):
    about = "segments of a shaft"

    length: float = scene_key("length", "length", above=0)
    outer_diameter: float = scene_key("outer diameter", "length", above=0)
    bore: float = scene_key("bore", "length", default=0.0, least=0)
    material: Material = scene_key("material, or its numbers", **MATERIAL)

    def check(self) -> None:
        if not self.bore < self.outer_diameter:
            bore, most = (
                scene_number(x, "length") for x in (self.bore, self.outer_diameter)
            )
            allowed = f"from 0 to below the outer diameter, {most}"
            raise self.table.error("bore", f"{bore} is not allowed; {allowed}")


class DividedSegmentKeys(SegmentKeys):
    about = "[[rotor.shaft]]: segments from z = 0 on; stations, from 0, are their ends"

    divisions: int = scene_key(
        f"elements of the segment; at most {MOST_ELEMENTS} of all", default=1
    )


_OF_DISC: Any = {"without": {"mass": "give either `mass` or the sizes of a disc"}}
_OF_MASS: Any = {"least": 0, "needs": ("mass",)}


class DiscKeys(Keys):
    about = "[[rotor.discs]]: discs, by their sizes or inertia, and point masses"

    station: int = key_of(Unbalance, "station")
    mass: float | None = key_of(
        Disc, "mass", about="mass, in place of sizes; alone that of a point", least=0
    )
    polar_inertia: float | None = key_of(Disc, "polar_inertia", **_OF_MASS)
    diametral_inertia: float | None = key_of(Disc, "diametral_inertia", **_OF_MASS)
    outer_diameter: float | None = scene_key(
        "outer diameter", "length", above=0, **_OF_DISC
    )
    width: float | None = scene_key("width", "length", above=0, **_OF_DISC)
    bore: float = scene_key(
        "bore", "length", default=0.0, least=0, needs=("outer_diameter",), **_OF_DISC
    )
    material: Material = key_of(
        SegmentKeys, "material", needs=("outer_diameter",), **_OF_DISC
    )

    @property
    def part(self) -> AbstractPart:
        """Disc or point mass."""
        table, sizes = self.table, ("outer_diameter", "width")
        inertias = "polar_inertia", "diametral_inertia"
        with table.building():
            if self.mass is None:
                outer, width = (table.quantity(name, "length") for name in sizes)
                return Disc.of_size(
                    self.station, outer, width, self.bore, self.material
                )
            if self.polar_inertia is None and self.diametral_inertia is None:
                return PointMass(self.station, self.mass)
            both = (table.quantity(name, "moment of inertia") for name in inertias)
            return Disc(self.station, self.mass, *both)


class ForceKeys(Keys):
    about = "[[rotor.excitation.forces]]: constant forces and moments"

    station: int = key_of(Unbalance, "station")
    Fx: float = key_of(LoadKeys, "Fx", default=0.0)
    Fy: float = key_of(LoadKeys, "Fy", default=0.0)
    Fz: float = key_of(LoadKeys, "Fz", default=0.0, about="force along z")
    Mx: float = key_of(LoadKeys, "Mx", default=0.0)
    My: float = key_of(LoadKeys, "My", default=0.0)

    def check(self) -> None:
        if not any(self.force):
            self.table.finish()
            problem = f"is missing; give one at least of {', '.join(LOADS[:5])}"
            raise self.table.error("Fy", problem)

    @property
    def force(self) -> tuple[float, ...]:
        """Force and moment (5,) [N, N m]."""
        return self.Fx, self.Fy, self.Fz, self.Mx, self.My


class BaseKeys(Keys):
    about = "[rotor.excitation.base_acceleration]: amplitude along each axis"

    x: float = scene_key("along x", "acceleration", default=0.0)
    y: float = scene_key("along y", "acceleration", default=0.0)
    z: float = scene_key("along z", "acceleration", default=0.0)


class ExcitationKeys(Keys):
    about = "[rotor.excitation]: loads on the rotor in addition to its weight"

    unbalance: tuple[Unbalance, ...] = scene_key("masses off the axis", default=())
    forces: tuple[ForceKeys, ...] = scene_key("constant forces and moments", default=())
    base_acceleration: BaseKeys = scene_key(
        "amplitude of the base that shakes at the frequency of the excitation",
        default=BaseKeys,
    )

    def loads(self, gravity: tuple[float, ...]) -> RotorLoads:
        """Build the loads.

        Args:
            gravity: Gravity along x, y and z [m/s²].
        """
        forces = tuple(StationForce(one.station, one.force) for one in self.forces)
        base = [*self.base_acceleration.given.values()]
        with self.table.building():
            return RotorLoads(self.unbalance, forces, gravity, base)


class RotorKeys(Keys):
    about = "[rotor]: a shaft on its bearings"

    speed: float = scene_key("speed of the rotor, from x to y", "speed", default=0.0)
    rigid: bool = key_of(Rotor, "rigid")
    axis: str = scene_key(
        "where weight pulls: `horizontal` along -y, `vertical` along -z",
        choices=tuple(GRAVITY_BY_AXIS),
        default="horizontal",
    )
    damping_ratio: float | None = key_of(ModalDamping, "ratio", least=0, below=1)
    damping: ProportionalDamping | None = scene_key(
        "damping in proportion to mass and stiffness of the shaft",
        without={"damping_ratio": ""},
    )
    modes: int = scene_key("number of modes that are reported", default=10)
    shaft: tuple[DividedSegmentKeys, ...] = scene_key("segments of the shaft")
    discs: tuple[DiscKeys, ...] = scene_key("discs and point masses", default=())
    bearings: tuple[MountKeys, ...] = scene_key("what holds the shaft")
    excitation: ExcitationKeys = scene_key(
        "what acts on the rotor beside its weight", default=ExcitationKeys
    )
    campbell: CampbellKeys | None = scene_key("Campbell diagram")
    response: ResponseKeys | None = scene_key("periodic vibration")
    transient: TransientKeys | None = scene_key("motion in time")

    def check(self) -> None:
        total, last, loads = 0, len(self.shaft), self.excitation
        for segment in self.shaft:
            total += segment.divisions
            if total > MOST_ELEMENTS:
                problem = f"{total} elements are too many; at most {MOST_ELEMENTS}"
                raise segment.table.error("divisions", problem)
        tasks = [one for one in (self.response, self.transient) if one is not None]
        placed: list[Any] = [*self.discs, *self.bearings, *loads.forces, *tasks]
        stations = [(one.table, "station", one.station) for one in placed]
        for k, one in enumerate(loads.unbalance):
            stations.append((loads.table, f"unbalance[{k}].station", one.station))
        for table, key, station in stations:
            if station is not None and station > last:
                problem = f"{station} is not a station of the shaft; from 0 to {last}"
                raise table.error(key, problem)
        shaken = any(loads.base_acceleration.given.values())
        if self.response is not None and not loads.unbalance and not shaken:
            problem = "is missing, and so is `base_acceleration`; nothing excites"
            raise loads.table.error("unbalance", f"{problem} the rotor")
        for task in tasks:
            if self.rigid and task.reduction is not None:
                problem = "is for a shaft that bends, not a `rigid` one"
                raise task.table.error("reduction", problem)
        if self.transient is not None:
            run_up = self.transient.table, "speed_to", self.transient.speed_to
            for place, key, value in ((self.table, "speed", self.speed), run_up):
                if value is not None and value < 0.0:
                    problem = "is not allowed with a motion in time; 0 or more"
                    raise place.error(key, f"{scene_number(value, 'speed')} {problem}")

    @property
    def own_damping(self) -> AbstractDamping | None:
        """Damping in addition to that of the bearings."""
        if self.damping is not None:
            return self.damping
        return ModalDamping(self.damping_ratio) if self.damping_ratio else None

    @property
    def shown_station(self) -> int:
        """Station shown by default in report and plot."""
        for part in (*self.excitation.unbalance, *self.discs):
            return part.station
        return len(self.shaft) // 2


@dataclasses.dataclass(frozen=True)
class RotorScene:
    """Scene of a rotor, in SI.

    Attributes:
        name: Name of the file without its ending.
        keys: Its [rotor].
        shaft: The shaft.
        discs: Discs and point masses.
        mounts: Supports of the shaft.
        loads: `RotorLoads` on it.
        campbell: Speeds of the Campbell diagram (speed,) [rad/s], or `None`.
        response, transient: Settings of these analyses, or `None`.
        warnings: Warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`);
            bearings of other scenes are included.
    """

    name: str
    keys: RotorKeys
    shaft: Shaft
    discs: tuple[AbstractPart, ...]
    mounts: tuple[Mount, ...]
    loads: RotorLoads
    campbell: np.ndarray | None
    response: ResponseKeys | None
    transient: TransientKeys | None
    warnings: tuple[Warning, ...] = ()
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def speed(self) -> float:
        """Rotor speed [rad/s]."""
        return self.keys.speed

    @property
    def nodes(self) -> list[int]:
        """Node of the shaft at every station."""
        return [self.shaft.node(k) for k in range(self.shaft.n_segments + 1)]

    @property
    def seats(self) -> tuple[tuple[Mount, tuple[int, ...]], ...]:
        """Each bearing with fits, by its first mount, and its stations."""
        found: dict[int, tuple[Mount, tuple[int, ...]]] = {}
        for mount in self.mounts:
            if mount.scene is not None and mount.scene.fits is not None:
                first, stations = found.get(id(mount.element), (mount, ()))
                found[id(mount.element)] = first, (*stations, mount.station)
        return tuple(found.values())

    @property
    def station_names(self) -> tuple[str, ...]:
        """Number and parts of each station, such as "1 disc"."""
        here: list[list[str]] = [[] for _ in range(self.shaft.n_segments + 1)]
        for disc in self.discs:
            kind = type(disc).__name__
            here[disc.station].append("disc" if kind == "Disc" else "mass")
        for mount in self.mounts:
            here[mount.station].append(mount.name)
        return tuple(" ".join([str(k), *what]) for k, what in enumerate(here))


def read_rotor(source: str | Path, settings: Iterable[str] = ()) -> RotorScene:
    """Read the scene of a rotor.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    return rotor_of(parse_scene(path, settings), path)


def rotor_of(data: dict[str, Any], path: Path) -> RotorScene:
    """Read the scene of a rotor that is parsed.

    Raises: as `read_scene`.
    """
    top = Table(data, path)
    if not is_rotor(data):
        key = "bearing" if "bearing" in data else "rotor"
        problem = "the scene of a rotor has a [rotor], and its bearings as [bearings.…]"
        raise top.error(key, problem)
    scene = _scene(top, path)
    top.finish()
    return dataclasses.replace(scene, inputs=top.echo())


def _scene(top: Table, path: Path) -> RotorScene:
    keys = read_keys(RotorKeys, top.table("rotor"))
    shaft = _shaft(keys)
    discs = tuple(disc.part for disc in keys.discs)
    mounts, warned = read_mounts(top, keys.bearings, shaft, keys.speed, path)
    loads = keys.excitation.loads(GRAVITY_BY_AXIS[keys.axis])
    response, transient = keys.response, keys.transient
    if response is not None:
        response = response.with_defaults(station=keys.shown_station)
        warned += _speed_warnings(keys.speed, response.speed, bool(loads.unbalances))
    if transient is not None:
        transient = transient.with_defaults(station=keys.shown_station)
    keys = dataclasses.replace(keys, response=response, transient=transient)
    return RotorScene(
        name=path.stem,
        keys=keys,
        shaft=shaft,
        discs=discs,
        mounts=mounts,
        loads=loads,
        campbell=None if keys.campbell is None else keys.campbell.speeds,
        response=response,
        transient=transient,
        warnings=tuple(
            dict.fromkeys([*(one for d in discs for one in d.warnings), *warned])
        ),
    )


def _shaft(keys: RotorKeys) -> Shaft:
    rows = [(s.outer_diameter, s.bore, s.material, s.divisions) for s in keys.shaft]
    stations = np.cumsum([0.0, *(segment.length for segment in keys.shaft)])
    with keys.table.building():
        return Shaft(stations, *zip(*rows, strict=True))


def _speed_warnings(
    rotor: float, response: float | None, unbalanced: bool
) -> Iterator[Warning]:
    """Yield warnings of speeds of the response that may not be those meant."""
    if response is not None and unbalanced:
        words = (
            "`rotor.response.speed` is fixed, so that its unbalance turns at another"
            " speed, that of the excitation"
        )
        yield Warning("response_speed", words, response)
    if response is None and rotor < 0.0:
        words = (
            "`rotor.speed` is negative, but in the response the rotor turns with its"
            " excitation, from x towards y; give `rotor.response.speed` for the other"
            " sense"
        )
        yield Warning("negative_speed", words, rotor, 0.0)

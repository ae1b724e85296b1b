"""The [heat] table of a system of shafts: where friction heat goes."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..shafts import HeatNetwork, ThermalPaths
from ..statics.friction_skf import skf_series
from .oil_table import series_of
from .read import Scene
from .schema import Keys, read_keys, scene_key
from .table import Table

_FLOW = 16e3 / 50.0
"""Heat flow that ISO 15312 takes from the seats of a radial bearing, over the area of
the seats and the rise of temperature [W/(m² K)]."""
_BY_SEATS = "half of 320 W/(m² K) over the area of the seats, as in ISO 15312"


def _share(about: str) -> Any:
    return scene_key(about, default=1.0, least=0, most=1)


def _capacity(about: str, default: float) -> Any:
    return scene_key(about, "heat capacity", default=default, above=0)


@dataclasses.dataclass(frozen=True, kw_only=True)
class PathKeys(Keys):
    """[bearings.NAME.heat]: where the friction heat of a bearing goes."""

    inner: float | None = scene_key(
        "conductance from the inner ring along the shaft to the ambience",
        "thermal conductance",
        above=0,
        otherwise=_BY_SEATS,
    )
    outer: float | None = scene_key(
        "conductance from the outer ring to the housing, or without it to ambience",
        "thermal conductance",
        above=0,
        otherwise=_BY_SEATS,
    )
    through: float = scene_key(
        "conductance from ring to ring", "thermal conductance", default=0.0, least=0
    )
    shaft_share: float = _share(
        "rise of the shaft below the bearing over that of the inner ring"
    )
    housing_share: float = _share("rise of the seat over that of the outer ring")
    inner_capacity: float = _capacity("heat capacity of the inner ring and shaft", 1e3)
    outer_capacity: float = _capacity("heat capacity of the outer ring and seat", 1e3)


@dataclasses.dataclass(frozen=True, kw_only=True)
class HeatKeys(Keys):
    """[heat]: temperatures from friction, in equilibrium and in time."""

    ambient: float = scene_key(
        "temperature of the ambience",
        "temperature",
        default=293.15,
        least=-60,
        most=200,
        shown="°C",
    )
    housing: float | None = scene_key(
        "conductance from housing and oil sump to the ambience",
        "thermal conductance",
        above=0,
        otherwise="the housing is as cold as the ambience",
    )
    housing_capacity: float = _capacity("heat capacity of housing and oil", 20e3)
    duration: float | None = scene_key(
        "time over which the warming up is followed", "time", above=0, most=1e7
    )
    times: int = scene_key(
        "times that are reported", default=61, least=2, most=2000, needs=("duration",)
    )

    @property
    def instants(self) -> np.ndarray | None:
        """Times from the start (time,) [s], closer at first; `None`: none."""
        if self.duration is None:
            return None
        return self.duration * np.linspace(0.0, 1.0, self.times) ** 2


def read_heat(
    top: Table, own: Mapping[str, Table], bearings: Mapping[str, Scene | None]
) -> tuple[HeatNetwork | None, np.ndarray | None]:
    """Read the paths of the heat and the times; `None` without [heat].

    Args:
        top: The scene.
        own: Tables of its bearings by name.
        bearings: The bearings as scenes; `None` of springs.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    if "heat" not in top:
        for name, table in own.items():
            if "heat" in table:
                problem = "is missing; the `heat` of a bearing goes with it"
                raise top.error("heat", f"{problem} (bearings.{name})")
        return None, None
    keys = read_keys(HeatKeys, top.table("heat"))
    paths = [_path(own[name], scene) for name, scene in bearings.items()]
    with keys.table.building():
        network = HeatNetwork(keys.ambient, paths, keys.housing, keys.housing_capacity)
    return network, keys.instants


def _path(table: Table, scene: Scene | None) -> ThermalPaths | None:
    if scene is None:
        return None
    keys = read_keys(PathKeys, table.table("heat"))
    if scene.oil is None:
        problem = "is missing; [heat] needs the oil that makes the friction"
        raise table.error("lubricant", problem)
    usual = None
    series, diameters = None, None
    if scene.catalogue is not None:
        entry = scene.catalogue.entry
        area = np.pi * entry.width * (entry.outside_diameter + entry.bore)
        usual = 0.5 * _FLOW * area
        bearing = scene.element.bearing
        series = series_of(entry.designation, skf_series(bearing))
        diameters = entry.bore, entry.outside_diameter
    given = {}
    for name in ("inner", "outer"):
        given[name] = getattr(keys, name)
        if given[name] is None and usual is None:
            problem = "is missing; without a `designation` the area of its seats is not"
            raise keys.table.error(name, f"{problem} known")
        if given[name] is None:
            given[name] = usual
            keys.fill(**{name: usual})
    rest = "through shaft_share housing_share inner_capacity outer_capacity".split()
    given |= {name: getattr(keys, name) for name in rest}
    with keys.table.building():
        return ThermalPaths(
            **given,
            lubricant=scene.oil.lubricant,
            supply=scene.oil.supply,
            series=series,
            diameters=diameters if series is not None else None,
        )

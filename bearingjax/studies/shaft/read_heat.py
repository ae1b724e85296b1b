"""The [heat] table of a system of shafts: where friction heat goes."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ...files.schema import Keys, build, key_of, read_keys, scene_key
from ...files.table import Table
from ...fits.fits import WARM_PARTS
from ...friction.friction_skf import skf_series, skf_series_of
from ...numerics.warning import Warning
from ...shafts import BearingOil, HeatNetwork, ThermalPaths, usual_conductance
from ..bearing.oil import Oil
from ..bearing.read_scene import Scene

_CONDUCTANCES = "inner", "outer"
"""By default `usual_conductance` each."""


class HeatKeys(Keys):
    about = "[heat]: temperatures from friction, in equilibrium and in time"

    numbers = {"": HeatNetwork}

    ambient: float = key_of(
        HeatNetwork,
        "ambient",
        default=None,
        least=-60,
        most=200,
        shown="°C",
        otherwise="20 °C",
        follows=lambda values: 293.15,
    )
    duration: float | None = scene_key(
        "time over which the warming up is followed", "time", above=0, most=1e7
    )
    times: int = scene_key(
        "times that are reported", default=61, least=2, most=2000, needs=("duration",)
    )

    pauses: str = scene_key(
        "temperature of bearings in cases at rest: that of the surroundings, or the"
        " mean of all cases over their hours",
        choices=("ambient", "mean"),
        default="ambient",
    )

    @property
    def instants(self) -> np.ndarray | None:
        """Times from the start (time,) [s], closer at first; `None`: none."""
        if self.duration is None:
            return None
        return self.duration * np.linspace(0.0, 1.0, self.times) ** 2


def read_heat(
    top: Table, own: Mapping[str, Table], bearings: Mapping[str, Scene | None]
) -> tuple[HeatNetwork | None, HeatKeys | None]:
    """Read the paths of the heat, and [heat]; `None` without it.

    Args:
        top: The scene.
        own: Tables of its bearings by name.
        bearings: The bearings as scenes; `None` of springs.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    if "heat" not in top:
        for name, table in own.items():
            if "heat" in table:
                problem = "is missing; the `heat` of a bearing goes with it"
                raise top.error("heat", f"{problem} (bearings.{name})")
        return None, None
    keys = read_keys(HeatKeys, top.table("heat"))
    paths = [_path(own[name], scene) for name, scene in bearings.items()]
    network = build(HeatNetwork, keys.table, ambient=keys.ambient, paths=paths)
    return network, keys


def heat_warnings(bearings: Mapping[str, Scene | None]) -> Iterator[Warning]:
    """Yield warnings about bearings of which [heat] finds the temperatures.

    Args: as `read_heat`.
    """
    scenes = {name: one for name, one in bearings.items() if one is not None}
    loose = [name for name, one in scenes.items() if one.fits is None]
    if loose:
        words = (
            "temperatures change the viscosity of the oil alone, neither clearance nor"
            " preload, without the seats of a `fit`"
        )
        yield Warning("no_seats", words).about(", ".join(loose))
    for name, one in scenes.items():
        given = one.installed.conditions
        if given is not None and any(
            float(getattr(given, part)) != float(given.reference) for part in WARM_PARTS
        ):
            words = "its `temperature` is not used: [heat] finds temperatures"
            yield Warning("unused_temperature", words).about(name)


def _path(table: Table, scene: Scene | None) -> ThermalPaths | None:
    if scene is None:
        return None
    heat = table.table("heat")
    if scene.oil is None:
        problem = "is missing; [heat] needs the oil that makes the friction"
        raise table.error("lubricant", problem)
    usual, given = None, {}
    if scene.catalogue is not None:
        entry = scene.catalogue.entry
        sizes = entry.bore, entry.outside_diameter, entry.width
        usual = float(usual_conductance(*sizes))
    for name in _CONDUCTANCES:
        if name not in heat and usual is None:
            problem = "is missing; without a `designation` the area of its seats is not"
            raise heat.error(name, f"{problem} known")
        given[name] = heat.quantity(name, "thermal conductance", usual)
    return build(ThermalPaths, heat, **given, oil=bearing_oil(scene, scene.oil))


def bearing_oil(scene: Scene, oil: Oil, temperature: Any = None) -> BearingOil:
    """Return the oil of a bearing, with what its friction needs.

    Args:
        scene: The bearing.
        oil: Its oil.
        temperature: Temperature of the oil [K]; `None`: it follows from the heat.
    """
    known, series, diameters = skf_series(scene.element.bearing), None, None
    if scene.catalogue is not None:
        entry = scene.catalogue.entry
        series = skf_series_of(entry)
        diameters = entry.bore, entry.outside_diameter
    return BearingOil(
        oil.lubricant, temperature, oil.supply, bool(known), series, diameters
    )

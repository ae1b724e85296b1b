"""The [cage] and [dynamics] tables of a scene: cage, drag and time integration of
skidding balls or rollers."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...element import LOADS, Speed
from ...files.schema import Keys, key_of, scene_key
from ...skid import (
    Drag,
    LoadHistory,
    SinusoidalLoad,
    SkidModel,
    SkidOptions,
    SpeedTable,
    ramp,
)
from ..bearing.read_operating import LoadKeys

SHAFT_AXES = ("vertical", "horizontal")
STARTS = ("rolling", "rest")
MOST_TIMES = 20_000
"""Most times of a run: about 8 kB each as JSON."""
MOST_PLACES = 2000
"""Most positions along an orbit: a matrix of 0.5 GB."""


class SeriesKeys(Keys):
    about = "Values over time"

    def _series(self, time: Sequence[float], names: Sequence[str]) -> list[Any]:
        """Read the values at the times, `None` for absent keys."""
        if not time or not (np.diff(time) > 0).all() or time[0] < 0:
            raise self.table.error("time", "must be rising times from 0 s on")
        found = [getattr(self, name) for name in names]
        for name, values in zip(names, found, strict=True):
            if values is not None and len(values) != len(time):
                problem = f"has {len(values)} values for {len(time)} times"
                raise self.table.error(name, problem)
        return found


class SpeedSeriesKeys(SeriesKeys):
    about = "Speeds of the rings over time, linear between the times"

    time: tuple[float, ...] = scene_key("rising times", "time")
    inner: tuple[float, ...] | None = scene_key(
        "speed of the inner ring", "speed", otherwise="it stands"
    )
    outer: tuple[float, ...] | None = scene_key(
        "speed of the outer ring", "speed", otherwise="it stands"
    )

    @property
    def speeds(self) -> SpeedTable:
        """Table of ring speeds over time."""
        inner, outer = self._series(self.time, ("inner", "outer"))
        if inner is None and outer is None:
            problem = "is missing, and so is `outer`; give one of them"
            raise self.table.error("inner", problem)
        still = np.zeros(len(self.time))
        return SpeedTable(self.time, still if inner is None else inner, outer)


def _component(about: str, kind: str) -> Any:
    return scene_key(about, kind, needs=("time",), otherwise=_CONSTANT)


_CONSTANT = "that of [operating]"


class LoadSeriesKeys(SeriesKeys):
    about = "Load over time, linear between times, or a sine about that of [operating]"

    time: tuple[float, ...] | None = scene_key(
        "rising times", "time", without={"amplitude": ""}
    )
    Fx: tuple[float, ...] | None = _component("force along x", "force")
    Fy: tuple[float, ...] | None = _component("force along y", "force")
    Fz: tuple[float, ...] | None = _component("axial force", "force")
    Mx: tuple[float, ...] | None = _component("moment about x", "moment")
    My: tuple[float, ...] | None = _component("moment about y", "moment")
    Mz: tuple[float, ...] | None = _component("moment about the axis", "moment")
    amplitude: LoadKeys | None = scene_key("amplitudes of a sine")
    speed: float | None = key_of(SinusoidalLoad, "speed", needs=("amplitude",))
    phase: float = key_of(SinusoidalLoad, "phase", needs=("amplitude",))

    def loads(self, constant: Sequence[float]) -> LoadHistory | SinusoidalLoad:
        """Build the load over time.

        Args:
            constant: Load of [operating] [N, N m].
        """
        if self.amplitude is not None:
            given = self.amplitude.given
            amplitude = {name: given.get(name, 0.0) for name in LOADS}
            self.amplitude.fill(**amplitude)
            if not any(amplitude.values()):
                problem = 'names no load, such as { Fy = "80 N" }'
                raise self.table.error("amplitude", problem)
            speed = self.table.quantity("speed", "speed")  # raises that it is missing
            return SinusoidalLoad(constant, [*amplitude.values()], speed, self.phase)
        time = self.time
        if time is None:
            time = tuple(self.table.quantities("time", "time"))  # the same
        series = self._series(time, LOADS)
        if all(values is None for values in series):
            problem = f"is missing; give one at least of {', '.join(LOADS)}"
            raise self.table.error("Fz", problem)
        still = zip(series, constant, strict=True)
        whole = [
            np.full(len(time), v) if given is None else given for given, v in still
        ]
        return LoadHistory(np.array(time), np.stack(whole, axis=1))


class DynamicsKeys(Keys):
    about = "[dynamics]: what surrounds balls or rollers that skid, and their motion"

    drag_coefficient: float = key_of(Drag, "coefficient")
    oil_share: float = key_of(Drag, "fill", name="fill")
    least_film: float = key_of(SkidModel, "least_film")
    inlet_heating: bool = key_of(SkidModel, "inlet_heating")
    places: int | None = key_of(
        SkidOptions,
        "places",
        most=MOST_PLACES,
        otherwise="as many as the bearing needs",
    )
    duration: float | None = scene_key(
        "duration of the motion; needed without `--steady`", "time", above=0, most=1e5
    )
    n_times: int = scene_key(
        "number of output times", default=501, least=2, most=MOST_TIMES
    )
    axis: str = scene_key("axis of the bearing", choices=SHAFT_AXES, default="vertical")
    start: str = scene_key(
        "how balls or rollers begin", choices=STARTS, default="rolling"
    )
    tolerance: float = key_of(SkidOptions, "tolerance", least=1e-12, most=0.01)
    max_steps: int = key_of(SkidOptions, "max_steps", default=200_000)
    ramp: float | None = scene_key(
        "time in which rings come to their speeds, evenly from rest",
        "time",
        above=0,
        refusal="must be above 0",
        without={"speed": "give either `speed` over time or this, not both"},
    )
    speed: SpeedSeriesKeys | None = scene_key(
        "speeds over time", otherwise="those of [operating]"
    )
    load: LoadSeriesKeys | None = scene_key(
        "load over time, of balls", otherwise=_CONSTANT
    )
    balanced: bool | None = key_of(
        SkidOptions, "balanced", otherwise="true with a `load` over time"
    )

    def check(self) -> None:
        if self.load is not None and self.balanced is False:
            problem = "a `load` over time is balanced at every time"
            raise self.table.error("balanced", problem)

    def speeds(self, speed: Speed) -> SpeedTable | None:
        """Return the ring speeds over time; `None`: constant.

        Args:
            speed: Ring speeds of [operating].
        """
        if self.speed is not None:
            return self.speed.speeds
        return None if self.ramp is None else ramp(self.ramp, speed)

    def check_places(self, steady: bool, count: int) -> None:
        """Raise SceneError for a number of positions invalid for the bearing."""
        places = self.places or 1
        problem = f"{places} is not allowed; 1 or"
        if steady and places != 1 and places % count:
            number = f"a multiple of the number of balls or rollers, {count}"
            raise self.table.error("places", f"{problem} {number}")
        if not steady and 1 < places < 6:
            raise self.table.error("places", f"{problem} at least 6")

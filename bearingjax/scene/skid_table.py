"""The [lubricant], [cage] and [dynamics] tables of a scene: what skids."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..design import (
    AbstractBallBearing,
    BearingSet,
    CylindricalRollerBearing,
    NeedleRollerBearing,
    is_ball,
    n_elements,
)
from ..dynamics import (
    Cage,
    Drag,
    LoadHistory,
    SinusoidalLoad,
    SkidModel,
    SpeedTable,
    ramp,
)
from ..element import Speed
from ..element.frame import LOAD_UNITS, LOADS
from .lubricant_table import read_lubricant, read_traction
from .oil_table import OWN
from .quantity import kind_of
from .read import Scene, scene_of, with_speed_told
from .scene_file import find_scene, parse_bearing
from .table import Table, written

AXES = ("vertical", "horizontal")
STARTS = ("rolling", "rest")
MOST_TIMES = 20_000
"""Most times of a run: some 8 kB each as JSON."""
MOST_PLACES = 2000
"""Most places along an orbit: a matrix of 0.5 GB."""


@dataclasses.dataclass(frozen=True)
class SkidScene:
    """What a scene asks for of balls or rollers that skid, in SI.

    Attributes:
        scene: The scene without it; its speeds are those of the load solve.
        model: The bearing with its oil and what surrounds the balls.
        oil: Name of the oil, or of the law of its viscosity.
        speeds: Ring speeds over time, or `None` for the constant ones of the scene.
        loads: Load over time, or `None` for the constant one of the scene.
        balanced: As of `skid`.
        duration: Of the motion [s]; `None` if the end state is asked for.
        start: "rolling" or "rest": how the balls begin.
        axis: "vertical" or "horizontal".
        n_times: Number of times that are reported.
        places: Places along the orbit, or `None` for the default.
        tolerance: Of the integration in time.
        max_steps: Step limit of it.
        warnings: What was assumed, or is odd but possible.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    scene: Scene
    model: SkidModel
    oil: str
    speeds: SpeedTable | None
    loads: LoadHistory | SinusoidalLoad | None
    balanced: bool | None
    duration: float | None
    start: str
    axis: str
    n_times: int
    places: int | None
    tolerance: float
    max_steps: int
    warnings: tuple[str, ...]
    inputs: dict[str, Any]

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.scene.name

    @property
    def steady(self) -> bool:
        """Whether the end state is asked for."""
        return self.duration is None

    @property
    def speed(self) -> Speed:
        """Ring speeds of the load solve."""
        assert self.scene.speed is not None  # checked when it was read
        return self.scene.speed


def read_skid(
    source: str | Path, settings: Iterable[str] = (), *, steady: bool = False
) -> SkidScene:
    """Read a scene of balls or rollers that skid.

    Args:
        source, settings: As in `read_scene`.
        steady: Whether the end state is asked for; what is of time is checked all the
            same, but may be missing.

    Raises:
        SceneError: One line that names file, key, fault and what is allowed.
    """
    path = find_scene(source)
    data = parse_bearing(path, settings)
    top = Table(data, path.name)
    scene = scene_of(data, path)
    _check_bearing(top, scene)
    lubricant = top.table("lubricant", required=True)
    cage, dynamics = top.table("cage"), top.table("dynamics")
    supply = lubricant.word("supply") if "supply" in lubricant else None
    supply = None if supply == "oil_bath" else supply  # the default, as echoed
    lubricant.skip(*OWN)
    oil, temperature, odd = read_lubricant(lubricant)
    if supply is not None:
        odd = (
            *odd,
            f"`lubricant.supply` {supply!r} counts for the friction torque of"
            " `solve` alone; what skids has films of plenty of oil, and the drag of"
            " `dynamics.fill`",
        )
    traction = read_traction(lubricant)
    values: dict[str, Any] = {
        "cage": _built(cage, Cage, cage.fields(Cage)),
        "drag": _built(dynamics, Drag, _drag(dynamics)),
    }
    film = dynamics.quantity("least_film", "length", None)
    if film is not None:
        values["least_film"] = film
    values["inlet_heating"] = dynamics.flag("inlet_heating", False)
    with dynamics.building():
        model = SkidModel(scene.running(), oil, temperature, traction, **values)
    speeds = _speeds(dynamics, scene.speed)
    time = _time(dynamics, steady)
    scene = with_speed_told(scene, _fastest(speeds, time["duration"]))
    found = SkidScene(
        scene=scene,
        model=model,
        oil=str(lubricant.raw("name", None) or lubricant.raw("law", None)),
        speeds=speeds,
        **_loads(dynamics, scene),
        **time,
        places=_places(dynamics, steady, n_elements(model.bearing)),
        warnings=tuple(dict.fromkeys((*scene.warnings, *odd))),
        inputs={},
    )
    for table in (lubricant, cage, dynamics):
        table.finish()
    dynamics.fill("drag_coefficient", float(model.drag.coefficient))
    dynamics.fill("fill", float(model.drag.fill))
    dynamics.fill("least_film", written(float(model.least_film), "m"))
    own = {"cage": cage.echo(), "dynamics": dynamics.echo()}
    return dataclasses.replace(found, inputs={**scene.inputs, **own})


def _built(table, kind, values):
    with table.building():
        return kind(**values)


def _check_bearing(top: Table, scene: Scene) -> None:
    """One row of balls or cylindrical rollers under rings that turn."""
    design, bearing = scene.element.bearing, top.table("bearing")
    if isinstance(design, BearingSet):
        key = "set" if "set" in top else "bearing"
        raise top.error(key, "is of several rows; balls or rollers skid in one")
    rollers = isinstance(design, CylindricalRollerBearing | NeedleRollerBearing)
    if not rollers and not isinstance(design, AbstractBallBearing):
        kind = bearing.word("type") or bearing.word("designation")
        problem = f"{kind!r} does not skid; balls, cylindrical and needle rollers do"
        raise bearing.error("type", problem)
    if scene.speed is None:
        operating = top.table("operating")
        given = [key for key in ("inner_speed", "outer_speed") if key in operating]
        problem = "is missing, and so is `outer_speed`; nothing skids at rest"
        if given:
            problem = "is 0, and the other ring stands still too; nothing skids at rest"
        raise operating.error(given[0] if given else "inner_speed", problem)


def _drag(dynamics: Table) -> dict[str, float]:
    keys = {"coefficient": "drag_coefficient", "fill": "fill"}
    given = {name: dynamics.number(key, None) for name, key in keys.items()}
    return {name: value for name, value in given.items() if value is not None}


def _time(dynamics: Table, steady: bool) -> dict:
    """What the integration in time is given."""
    duration = dynamics.quantity("duration", "time", None)
    if duration is None and not steady:
        problem = "is missing; give a time, or ask for the end state with --steady"
        raise dynamics.error("duration", problem)
    if duration is not None and not 0.0 < duration <= 1e5:
        problem = f"{duration:g} s is not allowed; above 0 and at most 100000 s"
        raise dynamics.error("duration", problem)
    n_times = dynamics.integer("n_times", 501, least=2)
    if n_times > MOST_TIMES:
        raise dynamics.error("n_times", f"{n_times} is too many; at most {MOST_TIMES}")
    tolerance = dynamics.number("tolerance", 1e-6)
    if not 1e-12 <= tolerance <= 1e-2:
        problem = f"{tolerance:g} is not allowed; from 1e-12 to 0.01"
        raise dynamics.error("tolerance", problem)
    return {
        "duration": None if steady else duration,
        "start": dynamics.choice("start", STARTS, "rolling"),
        "axis": dynamics.choice("axis", AXES, "vertical"),
        "n_times": n_times,
        "tolerance": tolerance,
        "max_steps": dynamics.integer("max_steps", 200_000),
    }


def _places(dynamics: Table, steady: bool, count: int) -> int | None:
    places = dynamics.integer("places", None)
    if places is None:
        return None
    if places > MOST_PLACES:
        problem = f"{places} is too many; at most {MOST_PLACES}"
        raise dynamics.error("places", problem)
    if steady and places != 1 and places % count:
        number = f"a multiple of the number of balls or rollers, {count}"
        problem = f"{places} is not allowed; 1 or {number}"
        raise dynamics.error("places", problem)
    if not steady and 1 < places < 6:
        raise dynamics.error("places", f"{places} is not allowed; 1 or at least 6")
    return places


def _speeds(dynamics: Table, speed: Speed | None) -> SpeedTable | None:
    """Ring speeds over time, or `None` for constant ones."""
    assert speed is not None  # checked before
    duration = dynamics.quantity("ramp", "time", None)
    if "speed" not in dynamics:
        if duration is None:
            return None
        if not duration > 0:
            raise dynamics.error("ramp", f"{duration:g} s must be above 0")
        return ramp(duration, speed)
    if duration is not None:
        raise dynamics.error("ramp", "give either `speed` over time or this, not both")
    table = dynamics.table("speed")
    time = _times(table)
    inner, outer = (_series(table, ring, "speed", time) for ring in ("inner", "outer"))
    if inner is None and outer is None:
        raise table.error("inner", "is missing, and so is `outer`; give one of them")
    return SpeedTable(time, np.zeros_like(time) if inner is None else inner, outer)


def _fastest(speeds: SpeedTable | None, duration: float | None) -> float | None:
    """Fastest speed of one ring against the other until a time [rad/s]; `None`: that
    of the scene, which alone counts for an end state."""
    if speeds is None or duration is None:
        return None
    time = np.append(np.asarray(speeds.time), duration)
    turns = np.asarray(speeds.inner - speeds.outer)
    return float(np.abs(np.interp(np.minimum(time, duration), time[:-1], turns)).max())


def _loads(dynamics: Table, scene: Scene) -> dict:
    """Load over time, and whether the ring is balanced at every time."""
    load, balls = scene.load, is_ball(scene.element.bearing)
    balanced = dynamics.flag("balanced", None) if "balanced" in dynamics else None
    for key, given in (("balanced", balanced), ("load", "load" in dynamics)):
        if given and not balls:
            problem = "is for balls; rollers have the constant load of [operating]"
            raise dynamics.error(key, problem)
    if "load" not in dynamics:
        return {"loads": None, "balanced": balanced}
    if balanced is False:
        raise dynamics.error("balanced", "a `load` over time is balanced at every time")
    table = dynamics.table("load")
    kinds = {name: kind_of(unit) for name, unit in zip(LOADS, LOAD_UNITS, strict=True)}
    if "amplitude" in table:
        parts = table.table("amplitude")
        amplitude = [parts.quantity(name, kind, 0.0) for name, kind in kinds.items()]
        if not any(amplitude):
            raise table.error("amplitude", 'names no load, such as { Fy = "80 N" }')
        speed = table.quantity("speed", "speed")
        phase = table.quantity("phase", "angle", 0.0)
        return {
            "loads": SinusoidalLoad(load, amplitude, speed, phase),
            "balanced": balanced,
        }
    time = _times(table)
    series = [_series(table, name, kind, time) for name, kind in kinds.items()]
    if all(values is None for values in series):
        names = ", ".join(LOADS)
        raise table.error("Fz", f"is missing; give one at least of {names}")
    still = zip(series, load, strict=True)
    whole = [np.full(len(time), v) if given is None else given for given, v in still]
    loads = LoadHistory(time, np.stack(whole, axis=1))
    return {"loads": loads, "balanced": balanced}


def _times(table: Table) -> np.ndarray:
    time = np.array(table.quantities("time", "time"))
    if not len(time) or not (np.diff(time) > 0).all() or time[0] < 0:
        raise table.error("time", "must be rising times from 0 s on")
    return time


def _series(table: Table, key: str, kind: str, time: np.ndarray):
    """Values at the times, or `None` if there are none."""
    if key not in table:
        return None
    values = np.array(table.quantities(key, kind))
    if values.shape != time.shape:
        problem = f"has {len(values)} values for {len(time)} times"
        raise table.error(key, problem)
    return values

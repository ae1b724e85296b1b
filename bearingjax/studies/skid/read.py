"""The [lubricant], [cage] and [dynamics] tables of a scene with skidding."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ...design import (
    AbstractBallBearing,
    BearingSet,
    CylindricalRollerBearing,
    NeedleRollerBearing,
    rows_of,
)
from ...element import Speed
from ...files.scene_file import find_scene, parse_bearing
from ...files.schema import build, read_keys
from ...files.table import Table
from ...numerics.warning import Warning
from ...skid import Cage, Drag, LoadHistory, SinusoidalLoad, SkidModel, SpeedTable
from ..bearing.read_lubricant import LubricantKeys
from ..bearing.read_scene import Scene, scene_of, with_speed_warnings
from .read_dynamics import DynamicsKeys


@dataclasses.dataclass(frozen=True)
class SkidScene:
    """Scene of skidding balls or rollers, in SI.

    Attributes:
        scene: The scene of the load solve, with its speeds.
        model: The bearing with its oil, cage and surroundings.
        oil: Name of the oil, or of the law of its viscosity.
        speeds: Ring speeds over time, or `None` for the constant ones of the scene.
        loads: Load over time, or `None` for the constant one of the scene.
        dynamics: Other settings of the motion, as the table says them.
        steady: Whether the steady state is requested.
        warnings: Assumptions, and warnings of suspicious but possible values.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    scene: Scene
    model: SkidModel
    oil: str
    speeds: SpeedTable | None
    loads: LoadHistory | SinusoidalLoad | None
    dynamics: DynamicsKeys
    steady: bool
    warnings: tuple[Warning, ...]
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the file without its ending."""
        return self.scene.name

    @property
    def speed(self) -> Speed:
        """Ring speeds of the load solve."""
        assert self.scene.speed is not None  # checked when it was read
        return self.scene.speed


def read_skid(
    source: str | Path, settings: Iterable[str] = (), *, steady: bool = False
) -> SkidScene:
    """Read a scene of skidding balls or rollers.

    Args:
        source, settings: As in `read_scene`.
        steady: Whether the steady state is requested; keys of the motion in time are
            then optional, but checked.

    Raises:
        SceneError: One line with file, line, key, fault and the allowed values.
    """
    path = find_scene(source)
    data = parse_bearing(path, settings)
    top = Table(data, path)
    scene = scene_of(data, path)
    _check_bearing(top, scene)
    lubricant = read_keys(LubricantKeys, top.table("lubricant", required=True))
    cage = top.table("cage")
    surrounding = build(Cage, cage)
    dynamics = read_keys(DynamicsKeys, top.table("dynamics"))
    _check_dynamics(dynamics, scene, steady)
    warned = lubricant.assumed
    if lubricant.supply != "oil_bath":
        words = (
            f"`lubricant.supply` {lubricant.supply!r} counts for the friction torque of"
            " `solve` alone; what skids has films of plenty of oil, and the drag of"
            " `dynamics.fill`"
        )
        warned = (*warned, Warning("unused_supply", words))
    oil = lubricant.oil()
    with dynamics.table.building():
        model = SkidModel(
            scene.running(),
            oil,
            lubricant.temperature,
            lubricant.traction,
            cage=surrounding,
            drag=Drag(dynamics.drag_coefficient, dynamics.oil_share),
            least_film=dynamics.least_film,
            inlet_heating=dynamics.inlet_heating,
        )
    dynamics.check_places(steady, model.bearing.n_elements)
    loads = None if dynamics.load is None else dynamics.load.loads(scene.load)
    assert scene.speed is not None  # checked before
    speeds = dynamics.speeds(scene.speed)
    duration = None if steady else dynamics.duration
    scene = with_speed_warnings(scene, _highest_speed(speeds, duration))
    found = SkidScene(
        scene=scene,
        model=model,
        oil=lubricant.oil_name,
        speeds=speeds,
        loads=loads,
        dynamics=dataclasses.replace(dynamics, speed=None, load=None),
        steady=steady,
        warnings=tuple(dict.fromkeys((*scene.warnings, *warned))),
    )
    for table in (lubricant.table, cage, dynamics.table):
        table.finish()
    own = {"cage": cage.echo(), "dynamics": dynamics.table.echo()}
    return dataclasses.replace(found, inputs={**scene.inputs, **own})


def _check_bearing(top: Table, scene: Scene) -> None:
    """Require one row of balls or cylindrical rollers between rotating rings."""
    design, bearing = scene.element.bearing, top.table("bearing")
    kinds = AbstractBallBearing | CylindricalRollerBearing | NeedleRollerBearing
    if not all(isinstance(row.bearing, kinds) for row in rows_of(design)):
        kind = bearing.word("type") or bearing.word("designation")
        problem = f"{kind!r} does not skid; balls, cylindrical and needle rollers do"
        raise bearing.error("type", problem)
    if isinstance(design, BearingSet):
        key = "set" if "set" in top else "bearing"
        raise top.error(key, "is of several rows; balls or rollers skid in one")
    if scene.speed is None:
        operating = top.table("operating")
        given = [key for key in ("inner_speed", "outer_speed") if key in operating]
        problem = "is missing, and so is `outer_speed`; nothing skids at rest"
        if given:
            problem = "is 0, and the other ring stands still too; nothing skids at rest"
        raise operating.error(given[0] if given else "inner_speed", problem)


def _check_dynamics(dynamics: DynamicsKeys, scene: Scene, steady: bool) -> None:
    """Require a duration unless steady; allow loads over time only for balls."""
    if dynamics.duration is None and not steady:
        problem = "is missing; give a time, or ask for the end state with --steady"
        raise dynamics.table.error("duration", problem)
    for key, given in (("balanced", dynamics.balanced), ("load", dynamics.load)):
        if given and not scene.element.bearing.is_ball:
            problem = "is for balls; rollers have the constant load of [operating]"
            raise dynamics.table.error(key, problem)


def _highest_speed(speeds: SpeedTable | None, duration: float | None) -> float | None:
    """Return the largest relative speed of the rings until a time [rad/s]; `None`:
    that of the scene, used for a steady state."""
    if speeds is None or duration is None:
        return None
    time = np.append(np.asarray(speeds.time), duration)
    turns = np.asarray(speeds.inner - speeds.outer)
    return float(np.abs(np.interp(np.minimum(time, duration), time[:-1], turns)).max())

"""Simulate the skidding balls or rollers of a scene."""

import dataclasses
from typing import Any

import jax
import numpy as np

from ... import skid
from ...files.scene_errors import scene_errors
from ...numerics import Result, Warning
from ...numerics.labels import (
    LabelledArray,
    array_fields,
    labelled_fields,
    make_dataset,
)
from ...numerics.shown import Shown
from ...skid import conditions, rest_state, skid_warnings
from ...statics.warning import solution_warnings
from .read import SkidScene


@dataclasses.dataclass(frozen=True)
class SkidRun(Shown):
    """Result of a skid run, in NumPy.

    Attributes:
        task: The skid scene.
        found: The motion, `SteadySkid`, `SkidHistory` or those of rollers; read
            its `result`.
        state: `Conditions` in the contacts; `None` for rollers.
        warnings: Warnings of doubtful results; none if not solved to the end.
    """

    task: SkidScene = dataclasses.field(repr=False)
    found: Any
    state: Any
    warnings: tuple[Warning, ...]

    @property
    def result(self) -> Result:
        """The result code."""
        return Result(int(self.found.result))

    @property
    def converged(self) -> bool:
        """Whether it was solved to the end."""
        return self.result is Result.CONVERGED

    @property
    def has_numbers(self) -> bool:
        """Whether there are results: a motion in time may end early."""
        return self.converged or (not self.task.steady and self.n_reached > 0)

    @property
    def n_reached(self) -> int:
        """Number of times reached by a motion in time."""
        return int(np.isfinite(self.found.cage_speed).sum())

    @property
    def loads_solved(self) -> bool:
        """Whether the load solve of the bearing converged."""
        return bool(self.found.solution.converged)

    def to_xarray(self) -> Any:
        """Return the motion, and of balls the state of their contacts, as an
        `xarray.Dataset`.

        Raises:
            ImportError: Without xarray.
        """
        arrays = labelled_fields(self.found)
        contacts = arrays["contact_load"].axes
        state = {} if self.state is None else array_fields(self.state)
        for name, values in state.items():
            arrays[name] = LabelledArray.field(self.state, name, values, contacts)
        return make_dataset(arrays)


def run_skid(task: SkidScene, shown: bool = False) -> SkidRun:
    """Simulate the skidding of the balls or rollers of a scene.

    Args:
        task: From `read_skid`.
        shown: Show a progress bar on standard error for a motion in time.

    Returns:
        The run with its result code; a failed solve does not raise.

    Raises:
        SceneError: For settings that do not suit the load.

    Fails: as `skid.steady` and `skid.simulate`.
    """
    with scene_errors(task.name):
        found, speed = _end(task) if task.steady else _motion(task, shown)
    balls = task.model.bearing.is_ball
    state = conditions(task.model, found, speed) if balls else None
    held, state = jax.device_get((found, state))
    warned = (*task.warnings, *(_left_out(task) if task.steady else ()))
    if Result(int(held.result)) is Result.CONVERGED:
        doubtful = skid_warnings(task.model, held, state)
        warned = (*warned, *solution_warnings(found.solution), *doubtful)
    return SkidRun(task, held, state, warned)


def _left_out(task):
    """Yield warnings of scene contents that the steady state neglects."""
    if task.dynamics.axis == "horizontal":
        words = "the end state leaves out gravity along the orbits; solve in time"
        yield Warning("left_out_gravity", words)
    if task.loads is not None:
        words = "the end state is that of [operating], not of a load over time"
        yield Warning("left_out_loads", words)


def _end(task) -> tuple[Any, Any]:
    found = skid.steady(
        task.model,
        task.scene.load,
        speed=task.speed,
        places=task.dynamics.places,
        support=task.scene.support,
        throw=False,
    )
    return found, task.speed


def _motion(task, shown) -> tuple[Any, Any]:
    speed = task.speed if task.speeds is None else task.speeds
    asked = task.dynamics
    found = skid.simulate(
        task.model,
        task.scene.load if task.loads is None else task.loads,
        speed=speed,
        times=asked.duration * np.linspace(0.0, 1.0, asked.n_times),
        start=rest_state(task.model.bearing) if asked.start == "rest" else None,
        support=task.scene.support,
        options=skid.SkidOptions(
            asked.tolerance,
            asked.max_steps,
            derivatives="forward",
            progress=shown,
            axis=asked.axis,
            balanced=asked.balanced,
            places=asked.places,
            load_speed=task.speed,
        ),
        throw=False,
    )
    return found, speed

"""Run the analyses of a rotor scene."""

import contextlib
import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ...element import Speed
from ...files.scene_errors import scene_errors
from ...life import Life, life_warnings, rating_life
from ...numerics.labels import to_xarray
from ...numerics.result import Result, SolveError
from ...numerics.shown import Shown
from ...numerics.types import as_array
from ...numerics.warning import Warning, warnings_of
from ...rotor import (
    BearingSupport,
    CriticalSpeeds,
    Modes,
    Onset,
    Rotor,
    StaticEquilibrium,
    campbell,
    critical_speeds,
    instability_onsets,
    modes,
    static_equilibrium,
    static_equilibrium_over,
)
from ...statics.load_result import solution_at
from ..bearing.life_ratings import life_conditions
from .motion import RotorResponse, RotorTransient, respond, run_in_time
from .mounts import Mount
from .read import RotorScene
from .supports import support_of


@dataclasses.dataclass(frozen=True)
class Failure:
    """A part of a run that was not solved.

    Attributes:
        part: "preload", "static", "modes", "campbell", "response" or "transient".
        result: Result code.
        message: Cause and remedy in words.
    """

    part: str
    result: Result
    message: str


@dataclasses.dataclass(frozen=True)
class RotorRun(Shown):
    """Result of a rotor run.

    Parts not requested or not solved are `None`.

    Attributes:
        task: The rotor scene.
        rotor: The rotor on its bearings, preloaded, before static equilibrium.
        settled: Static equilibrium at the speed of the scene; read its `result`.
        lives: Rating life there of each mount with [life], in NumPy.
        modes: Modes at that speed.
        critical: Critical speeds.
        campbell: Modes over `task.campbell`, the speeds [rad/s].
        onsets: Onsets of instability of its modes.
        response: Periodic vibration over the frequency.
        transient: Motion in time.
        failures: Parts that were not solved.
        warnings: Warnings of doubtful results.
    """

    task: RotorScene = dataclasses.field(repr=False)
    rotor: Rotor | None = dataclasses.field(repr=False)
    settled: StaticEquilibrium | None = None
    lives: tuple[tuple[Mount, Life], ...] = ()
    modes: Modes | None = None
    critical: CriticalSpeeds | None = None
    campbell: Modes | None = None
    onsets: tuple[Onset, ...] = ()
    response: RotorResponse | None = None
    transient: RotorTransient | None = None
    failures: tuple[Failure, ...] = ()
    warnings: tuple[Warning, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether all parts were solved."""
        return not self.failures

    def to_xarray(self) -> Any:
        """Return the arrays of all parts that were run as an `xarray.Dataset`; names
        taken twice have the part before them.

        Raises:
            ImportError: Without xarray.
        """
        parts = "settled", "modes", "critical", "campbell", "response", "transient"
        return to_xarray(self, *parts)


_STAGES = {
    "preload": "bearings",
    "static": "static equilibrium",
    "modes": "modes",
    "critical speeds": "critical speeds",
    "campbell": "Campbell diagram",
    "response": "response",
    "transient": "motion in time",
}


class _Parts:
    """Collected results, failures and warnings of the parts of a run."""

    def __init__(self, on_stage: Callable[[str], None] | None):
        self.found: dict[str, Any] = {}
        self.failures: list[Failure] = []
        self.warnings: list[Warning] = []
        self._on_stage = on_stage

    @contextlib.contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Context that records a SolveError as the failure of this part."""
        if self._on_stage is not None:
            self._on_stage(_STAGES[name])
        try:
            yield
        except SolveError as error:
            self.record_failure(name, error.result or Result.STEP_LIMIT, str(error))

    def record_failure(self, part: str, result: Result, message: str) -> None:
        """Record a failure."""
        self.failures.append(Failure(part, result, message))


def run_rotor(
    task: RotorScene, on_stage: Callable[[str], None] | None = None
) -> RotorRun:
    """Run the analyses of a rotor scene.

    Args:
        task: From `read_rotor`.
        on_stage: Called with the name of each stage as it begins.

    Returns:
        The run; a part that fails does not raise.

    Raises:
        SceneError: For errors found only when the rotor is assembled.
    """
    parts = _Parts(on_stage)
    with scene_errors(task.name):
        rotor = _rotor(task, parts)
        if rotor is not None:
            _static(task, rotor, parts)
            if "settled" in parts.found:
                _lives(task, rotor, parts)
                linear = _linear(task, rotor, parts)
                _nonlinear(task, rotor, linear, parts)
    return RotorRun(
        task=task,
        rotor=rotor,
        failures=tuple(parts.failures),
        warnings=(*task.warnings, *parts.warnings, *task_warnings(task)),
        **parts.found,
    )


def _rotor(task: RotorScene, parts: _Parts) -> Rotor | None:
    with parts.part("preload"):
        supports = [support_of(mount) for mount in task.mounts]
        damping, rigid = task.keys.own_damping, task.keys.rigid
        return Rotor(task.shaft, task.discs, supports, damping, rigid)
    return None


def _static(task: RotorScene, rotor: Rotor, parts: _Parts) -> None:
    with parts.part("static"):
        settled = static_equilibrium(rotor, task.loads, as_array(task.speed, float))
        parts.found["settled"] = settled
        parts.warnings += settled.warnings


def _lives(task: RotorScene, rotor: Rotor, parts: _Parts) -> None:
    """Compute the lives of the bearings under the loads of the equilibrium."""
    settled, found = parts.found["settled"], []
    moved = np.asarray(rotor.at_supports()) @ np.asarray(settled.motion)
    for mount, support, motion in zip(task.mounts, rotor.supports, moved, strict=True):
        scene = mount.scene
        if scene is None or scene.life is None:
            continue
        if not isinstance(support, BearingSupport):
            words = "a `law` has no life; leave it out"
            parts.warnings.append(Warning("no_life", words).about(mount.name))
            continue
        turns = -task.speed if mount.keys.turned else task.speed
        speed = Speed(as_array(turns, float)) if task.speed else None
        solution = solution_at(
            support.element,
            support.rings(jnp.asarray(motion)),
            speed if mount.keys.inertia else None,
            scene.points,
        )
        conditions = life_conditions(scene, speed is not None)
        life = rating_life(support.element, solution, conditions, speed=speed)
        found.append((mount, jax.device_get(life)))
        bearing = support.element.bearing
        doubts = life_warnings(bearing, found[-1][1].ratings, vars(found[-1][1]))
        parts.warnings += warnings_of(mount.name, doubts)
    parts.found["lives"] = tuple(found)


def _linear(task: RotorScene, rotor: Rotor, parts: _Parts) -> Rotor | None:
    """Compute modes, critical speeds, Campbell diagram; return the linear rotor."""
    found, count = parts.found, task.keys.modes
    settled = found["settled"]
    with parts.part("modes"):
        found["modes"] = jax.device_get(modes(settled.rotor, task.speed, count=count))
        parts.warnings += found["modes"].warnings
    follows, over = settled.rotor, None
    if any(mount.keys.inertia for mount in task.mounts):
        with parts.part("static"):
            top = as_array(top_speed(task), float)
            over = static_equilibrium_over(rotor, task.loads, top)
            parts.warnings += over.warnings
        if over is None:
            return None
        follows = over.rotor
    with parts.part("critical speeds"):
        found["critical"] = jax.device_get(
            critical_speeds(follows, count=count, operating_speed=task.speed)
        )
        parts.warnings += found["critical"].warnings
    if over is not None:
        known = "[rotor.campbell] and [rotor.response], or to twice the speed"
        for one in over.critical_speed_warnings(found["critical"].speed):
            more = one.followed_by(f"; it is known to the highest speed of {known}")
            parts.warnings.append(more)
    if task.campbell is not None:
        with parts.part("campbell"):
            lines = campbell(follows, task.campbell, count=count)
            found["campbell"] = jax.device_get(lines)
            parts.warnings += found["campbell"].warnings
            found["onsets"] = instability_onsets(
                follows, task.campbell, found["campbell"]
            )
    return follows


def top_speed(task: RotorScene) -> float:
    """Return the highest speed for speed-dependent bearings [rad/s]."""
    speeds = [2.0 * abs(task.speed)]
    if task.campbell is not None:
        speeds.append(float(np.abs(task.campbell).max()))
    asked = task.response
    if asked is not None:
        ends = asked.begin, asked.end
        speeds += ends if asked.speed is None else [abs(asked.speed)]
    return max(*speeds, 1.0)


def task_warnings(task: RotorScene) -> Iterator[Warning]:
    """Yield warnings about the bearings at the speeds of the scene."""
    top = max(map(abs, (task.speed, *_run_to(task))))
    for mount in {mount.name: mount for mount in task.mounts}.values():
        if mount.installed is not None:
            yield from warnings_of(mount.name, mount.installed.speed_warnings(top))
    for mount, _ in task.seats:
        if mount.installed is not None:
            held = mount.installed.held_clearance_warnings(task.speed, _ends(task))
            yield from warnings_of(mount.name, held)


def _ends(task: RotorScene) -> list[float]:
    """Return the end speeds of all analyses of a scene [rad/s]."""
    lines = task.campbell
    return [*(() if lines is None else map(float, lines[[0, -1]])), *_run_to(task)]


def _run_to(task: RotorScene) -> list[float]:
    """Return the end speeds of response and motion, besides the scene's [rad/s]."""
    ends: list[float] = []
    asked, motion = task.response, task.transient
    if asked is not None:
        ends += (asked.begin, asked.end) if asked.speed is None else (asked.speed,)
    if motion is not None and motion.speed_to is not None:
        ends.append(motion.speed_to)
    return ends


def _nonlinear(task: RotorScene, rotor: Rotor, linear: Any, parts: _Parts) -> None:
    """Compute response and motion in time."""
    found = parts.found
    there = linear is not None or getattr(task.response, "method", "") != "linear"
    if task.response is not None and there:
        with parts.part("response"):
            response = respond(task, rotor, linear, found["settled"], found["modes"])
            if len(response.frequency):
                found["response"] = response
            parts.warnings += response.warnings
            if response.stopped is not None:
                parts.record_failure("response", *response.stopped)
    if task.transient is not None:
        with parts.part("transient"):
            motion = run_in_time(task, rotor, found["settled"], found["modes"])
            if motion.n_reached:
                found["transient"] = motion
            if motion.stopped is not None:
                parts.record_failure("transient", *motion.stopped)

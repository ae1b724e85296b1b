"""Run the scene of a system of shafts."""

import dataclasses
import functools
import textwrap
from collections.abc import Callable, Iterator
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ... import shafts
from ...design import rows_of
from ...element import Speed
from ...files.scene_errors import scene_errors
from ...fits import radial_clearance
from ...life.life import Life, rating_life
from ...life.life_warning import ALL
from ...life.required_life import RequiredLife, judge_life
from ...numerics.labels import LabelledArray, labelled_fields, make_dataset
from ...numerics.result import Result
from ...numerics.shown import Shown
from ...numerics.types import in_numpy
from ...numerics.warning import Warning, warnings_of, warnings_of_cases
from ...shafts.duty import case_damage
from ...shafts.equilibrium import searched_system, system_state
from ...shafts.heat import with_temperatures
from ...shafts.seats import speed_of, with_preload_offsets
from ...shafts.state import moving_part
from ...shafts.warning import load_doubts
from ...statics.solution import Solution
from ..bearing.life_report import life_verdict
from ..bearing.oil import OilFacts, oil_facts
from ..bearing.read_scene import Scene, with_speed_warnings
from ..bearing.solved import solved_warnings
from ..solve.run import with_set_preload
from .read import ShaftScene

_OF_LIFE = {"bearings", "life", "lubricant"}
"""Tables whose keys, if cases vary them, leave no one bearing to be judged."""


@dataclasses.dataclass(frozen=True)
class InPlace:
    """A bearing in the solved system.

    Attributes:
        name: Its name.
        scene: Scene of it alone, at its speed; `None` of springs.
        solution: Its solution, in NumPy; `None` of springs.
        life: Its life, likewise.
        oil: Friction and films; `None` without lubricant, or at rest.
    """

    name: str
    scene: Scene | None = dataclasses.field(repr=False)
    solution: Solution | None
    life: Life | None
    oil: OilFacts | None

    @property
    def friction_torque(self) -> float | None:
        """Friction torque by the model of SKF, else of Palmgren [N m], or `None`."""
        found = None if self.oil is None else self.oil.skf or self.oil.friction
        return None if found is None else float(found.torque)

    @property
    def clearance(self) -> float | None:
        """Radial clearance in operation [m], of the drawing without fits; `None` of
        springs and thrust bearings."""
        if self.scene is None:
            return None
        if (fits := self.scene.fit_states) is not None:
            return float(fits.operating.radial_clearance)
        row = rows_of(self.scene.element.bearing)[0].bearing
        return None if row.is_thrust else float(radial_clearance(in_numpy(row)))


@dataclasses.dataclass(frozen=True)
class ShaftRun(Shown):
    """Result of the scene of a system of shafts.

    Attributes:
        task: The scene.
        solution: Equilibrium, in NumPy; of several cases that of the first.
        bearings: Each bearing in it; empty if it was not solved.
        thermal: Temperatures, in NumPy, of several cases those of the first; `None`
            without [heat].
        warming: Temperatures over `task.times`, as of `warm_up` (time, node) [K], of
            several cases in the first.
        duty: All cases, in NumPy; `None` without [cases].
        rings: Temperatures of inner and outer rings in all cases (case, bearing, 2)
            [K]; `None` without [heat] or [cases].
        problem: Why it was not solved, in words; empty if it was.
        warnings: Warnings of doubtful results.
    """

    task: ShaftScene = dataclasses.field(repr=False)
    solution: shafts.SystemSolution
    bearings: tuple[InPlace, ...]
    thermal: shafts.ThermalState | None
    warming: np.ndarray | None
    duty: shafts.DutyResult | None
    rings: np.ndarray | None
    problem: str
    warnings: tuple[Warning, ...]

    @property
    def converged(self) -> bool:
        """Whether all cases were solved."""
        return not self.problem

    def to_xarray(self) -> Any:
        """Return the solution, of several cases all of them, as an `xarray.Dataset`.

        Bearings and shafts have their names, and bearings their lives and temperatures.

        Raises:
            ImportError: Without xarray.
        """
        if self.duty is None:
            found = labelled_fields(self.solution, "power")
        else:
            found = labelled_fields(self.duty)
            for name, values in self.duty.lives.items():
                found[name] = LabelledArray.field(
                    Life, name, values, ("case", "bearing")
                )
        found["hours"] = LabelledArray(self.hours, ("bearing",), "h")
        if self.thermal is not None:
            warm = labelled_fields(self.thermal)
            found |= {name: warm[name] for name in ("inner_ring", "outer_ring")}
        system = self.task.system
        names = {"bearing": system.seats, "shaft": system.shafts}
        labels = {axis: [part.name for part in parts] for axis, parts in names.items()}
        return make_dataset(found, labels)

    @functools.cached_property
    def hours(self) -> np.ndarray:
        """Life of each bearing, under all cases (bearing,) [h]; NaN of springs."""
        if self.duty is not None:
            return np.asarray(shafts.bearing_hours(*self.spectrum(self.duty)))
        found = []
        for bearing in self.bearings:
            life = None if bearing.life is None else bearing.life.life_hours
            found.append(np.nan if life is None else float(life))
        return np.array(found)

    @functools.cached_property
    def verdicts(self) -> list[RequiredLife | None]:
        """Verdict on the life required of each bearing, under all cases; `None` without
        one, and of revolutions under cases, whose bearings turn at several speeds.
        Where cases vary bearings or their lives, nothing tells what it would take."""
        return [self._verdict(k, b.scene, b.life) for k, b in enumerate(self.bearings)]

    def _verdict(
        self, k: int, scene: Scene | None, life: Life | None
    ) -> RequiredLife | None:
        if scene is None or life is None or scene.life is None:
            return None
        if self.duty is None:
            return life_verdict(scene, life)
        conditions, required = self.task.lives[k], scene.life.required
        if conditions is None or required is None:
            return None
        damage, speed, spent = self.spectrum(self.duty)
        basic = 1.0 / np.asarray(self.duty.lives["basic_rating_life"])
        hours = self.hours[k], shafts.bearing_hours(basic, speed, spent)[k]
        factor, of_basic = (float(one) / float(required) for one in hours)
        capacity = float(life.ratings.dynamic_capacity)
        varied = {key.split(".")[0] for key in self.task.varied}
        parts = {} if varied & _OF_LIFE else self.duty.fatigue[k]
        share = self.hours[k] * np.asarray(case_damage(damage, speed, spent))[:, k]
        given = scene.element.bearing, conditions, factor, of_basic, capacity
        return judge_life(*given, parts, share)

    @functools.cached_property
    def worst_cases(self) -> list[int | None]:
        """Case with the most damage to each bearing over its hours; `None` of springs,
        of bearings without damage, and without cases."""
        if self.duty is None:
            return [None] * len(self.task.system.seats)
        damage = np.nan_to_num(case_damage(*self.spectrum(self.duty)))
        return [int(np.argmax(of)) if of.any() else None for of in damage.T]

    def spectrum(self, duty: shafts.DutyResult) -> tuple[Any, Any, Any]:
        """Return damage, speeds of the bearings and hours of the cases."""
        of = [self.task.system.station(seat)[0] for seat in self.task.system.seats]
        given = [case.hours for case in self.task.cases]
        hours = None if None in given else np.array(given, float)
        return duty.lives["damage"], duty.speed[:, of], hours

    @property
    def warm_nodes(self) -> dict[str, np.ndarray]:
        """Temperatures over `task.times` by the name of ring or housing (time,) [K]."""
        if self.warming is None:
            return {}
        found, seats = {}, self.task.system.seats
        for k, seat in enumerate(seats):
            if seat.installed is not None:
                found[f"{seat.name} inner"] = self.warming[:, 2 * k]
                found[f"{seat.name} outer"] = self.warming[:, 2 * k + 1]
        if self.warming.shape[1] > 2 * len(seats):
            found["housing"] = self.warming[:, -1]
        return found

    @property
    def shown_case(self) -> str:
        """Case of which a picture or a table is, in words; empty without cases."""
        count = len(self.task.cases)
        return f"case 0 of {count}" if self.duty is not None else ""

    def case_words(self, case: int) -> str:
        """Return the settings of a case in words, "hub.Fy -95 kN, drive.speed 26 rpm".

        Args:
            case: Number of the case.
        """
        given = self.task.settings[case].items()
        ends = (".".join(key.split(".")[-2:]) for key, _ in given)
        words = ", ".join(f"{k} {v}" for k, (_, v) in zip(ends, given, strict=True))
        return textwrap.shorten(words, 90, placeholder=" …")

    @property
    def result(self) -> Result:
        """Most severe result of all cases, or of the one."""
        codes = [int(self.solution.result)]
        codes += [] if self.thermal is None else [int(self.thermal.result)]
        codes += [] if self.duty is None else [int(np.max(self.duty.result))]
        return Result(max(codes))

    @functools.cached_property
    def system_hours(self) -> float | None:
        """Life that all bearings reach together [h]; `None` at rest or unsolved."""
        hours = self.hours
        sprung = np.array([seat.installed is None for seat in self.task.system.seats])
        if self.problem or np.isnan(hours[~sprung]).any() or sprung.all():
            return None
        known = np.where(sprung, np.inf, hours)
        return float(shafts.system_life(self.task.system, known))


def run_shafts(
    task: ShaftScene, on_stage: Callable[[str], None] | None = None
) -> ShaftRun:
    """Run the scene of a system of shafts.

    Args:
        task: From `read_shafts`.
        on_stage: Called with the name of each stage as it begins.

    Returns:
        The run; a system without equilibrium does not raise.

    Raises:
        SceneError: For torques that do not balance.
    """
    say = on_stage or (lambda name: None)
    system, cases = task.system, task.cases
    states, problem = [], ""
    with scene_errors(task.name):
        if task.heat is None:
            say("static equilibrium")
            found, place = searched_system(system)
            if not found.converged:
                problem = shafts.equilibrium.describe_failure(
                    system, jax.device_get(found), np.asarray(place)
                )
        else:
            say("thermal equilibrium")
            states = _thermal(task)
            found = states[0].solution
            if int(states[0].result) != Result.CONVERGED:
                problem = states[0].failure_message
            else:
                task = _with_temperatures(task, states[0])
    found, bearings = jax.device_get(found), ()
    duty, rings, warming, solved = None, None, None, not problem
    if cases and solved:
        say("load cases")
        duty, rings, problem = _duty(task, states)
    if solved:
        say("bearings")
        speeds = found.power.speed[None] if duty is None else duty.speed
        bearings = tuple(_in_place(task, found, np.asarray(speeds)))
    if solved and task.heat is not None and task.times is not None:
        say("warming up")
        warming = np.asarray(shafts.warm_up(system, task.heat, task.times))
    state = jax.device_get(states[0]) if states else None
    run = ShaftRun(task, found, bearings, state, warming, duty, rings, problem, ())
    warned = dict.fromkeys((*task.warnings, *_warnings(run)))
    return dataclasses.replace(run, warnings=tuple(warned))


def _thermal(task: ShaftScene) -> list[shafts.ThermalState]:
    """Find the temperatures of all cases, of those at rest as `pauses` has them."""
    cases, states = task.cases or (task,), []
    offsets: dict[Any, Any] = {}
    for case in cases:
        assert case.heat is not None
        # The first keeps its preload, for the warnings.
        system = with_preload_offsets(case.system, offsets) if states else case.system
        states.append(shafts.solve_heat(system, case.heat, throw=False))
    hot = any(int(state.result) != Result.CONVERGED for state in states)
    if task.pauses == "ambient" or hot:
        return states
    # Rises are as linear in the heat as the network: their mean is of its mean.
    hours = [case.hours for case in cases]
    weights = None if None in hours else np.array(hours, float)
    warm = {
        name: jnp.asarray(
            np.average([getattr(s, name) for s in states], axis=0, weights=weights)
        )
        for name in ("inner_ring", "outer_ring", "housing")
    }
    rings = jnp.stack([warm["inner_ring"], warm["outer_ring"]], axis=1).ravel()
    for k, case in enumerate(cases):
        if not case.system.turns and case.heat is not None:
            rises = rings - case.heat.ambient
            system = with_temperatures(states[k].system, case.heat, rises)
            found, _ = system_state(with_preload_offsets(system))
            more = {"system": system, "solution": found, "result": found.result}
            states[k] = dataclasses.replace(states[k], **warm, **more)
    return states


def _duty(
    task: ShaftScene, states: list[shafts.ThermalState]
) -> tuple[shafts.DutyResult, np.ndarray | None, str]:
    """Solve the load cases, each warm if there is heat.

    Args:
        task: The scene.
        states: Temperatures in each case; empty without heat.

    Returns:
        The cases, temperatures of the rings, and what was not solved, in words.
    """
    cases = task.cases
    with scene_errors(task.name):
        if states:
            cases = [
                _with_temperatures(case, state)
                if state.result == Result.CONVERGED
                else case
                for case, state in zip(cases, states, strict=True)
            ]
        systems, lives = zip(*((c.system, c.lives) for c in cases), strict=True)
        duty = shafts.solve_duty(systems, lives)
    rings = lost = None
    if states:
        rings = np.array([[s.inner_ring, s.outer_ring] for s in states])
        rings = rings.transpose(0, 2, 1)
        hot = np.array([int(s.result) for s in states])
        lost = hot != Result.CONVERGED
        duty = jax.tree.map(
            lambda x: (
                np.where(lost.reshape(-1, *[1] * (x.ndim - 1)), np.nan, x)
                if x.dtype.kind == "f"
                else x
            ),
            duty,
        )
        duty = dataclasses.replace(duty, result=np.where(lost, hot, duty.result))
    failed = np.flatnonzero(duty.result != Result.CONVERGED)
    if not failed.size:
        return duty, rings, ""
    label = Result(int(duty.result[failed[0]])).label
    if lost is not None and lost[failed[0]]:
        label = states[failed[0]].failure_message
    many = f"{failed.size} of {len(cases)} cases not solved"
    return duty, rings, f"{many} (case {failed[0]}: {label})"


def _with_temperatures(task: ShaftScene, state: shafts.ThermalState) -> ShaftScene:
    """Return a scene whose bearings and oil have the temperatures that were found."""
    scenes, lives = [], []
    rings = np.asarray([state.inner_ring, state.outer_ring]).mean(axis=0)
    for k, (seat, scene) in enumerate(
        zip(state.system.seats, task.bearings, strict=True)
    ):
        life, oil = task.lives[k], None if scene is None else scene.oil
        if scene is None or seat.installed is None or life is None or oil is None:
            scenes.append(scene)
            lives.append(life)
            continue
        known = scene.inputs.get("life", {})
        if life.viscosity is not None and "viscosity" not in known:
            viscosity = oil.lubricant.kinematic_viscosity(rings[k])
            life = dataclasses.replace(life, viscosity=viscosity)
        warm = dataclasses.replace(
            scene.installed, conditions=jax.device_get(seat.installed.conditions)
        )
        oil = dataclasses.replace(oil, temperature=float(rings[k]))
        asked = scene.life and dataclasses.replace(scene.life, viscosity=life.viscosity)
        parts = {"oil": oil, "installed": warm, "life": asked}
        scenes.append(dataclasses.replace(scene, **parts))
        lives.append(life)
    return dataclasses.replace(
        task, system=state.system, bearings=tuple(scenes), lives=tuple(lives)
    )


def _in_place(
    task: ShaftScene, found: shafts.SystemSolution, speeds: np.ndarray
) -> Iterator[InPlace]:
    """Yield each bearing in the equilibrium, with life, friction and films.

    Args:
        task: The scene, warm.
        found: Its equilibrium.
        speeds: Speeds of the shafts in all cases (case, shaft) [rad/s].
    """
    system = task.system
    solutions = shafts.bearing_solutions(system, found)
    for k, (seat, scene) in enumerate(zip(system.seats, task.bearings, strict=True)):
        solution, conditions = jax.device_get(solutions[k]), task.lives[k]
        if scene is None or solution is None or conditions is None:
            yield InPlace(seat.name, None, None, None, None)
            continue
        speed = jax.device_get(speed_of(system, k, found.power.speed)[0])
        scene = dataclasses.replace(
            scene,
            speed=None if system.inertia is None else speed,
            installed=scene.installed.with_speed(Speed(speed.inner, 0.0)),
        )
        with scene_errors(f"{task.name}: {seat.name}"):
            life = jax.device_get(rating_life(solution.element, solution, conditions))
        oil = None
        if scene.oil is not None:
            oil = oil_facts(scene.oil, solution, scene.catalogue)
        scene = with_speed_warnings(scene, speeds[:, system.station(seat)[0]])
        yield InPlace(seat.name, with_set_preload(scene), solution, life, oil)


def _warnings(run: ShaftRun) -> Iterator[Warning]:
    """Yield warnings about the equilibrium and each bearing."""
    system, found = run.task.system, run.solution
    if run.problem and run.duty is None:
        return
    if np.any(found.free):
        where = moving_part(system, found.free)
        yield Warning(
            "free_motion",
            f"nothing holds {where}: it stays where it is; locate the shaft by a"
            " bearing",
            where=where,
        )
    loads = found.load[None] if run.duty is None else run.duty.load
    for k, bearing in enumerate(run.bearings):
        if bearing.scene is None or bearing.solution is None:
            continue
        # With cases each kind once, with the worst case.
        yield from warnings_of(
            bearing.name,
            solved_warnings(bearing.scene, bearing.solution, bearing.life)
            if run.duty is None
            else [*bearing.scene.warnings, *warnings_of_cases(run.duty.warned[k], ALL)],
        )
    yield from load_doubts(system, loads)


def bearing_loss(run: ShaftRun) -> float | None:
    """Return the power lost in all bearings [W]; `None` where a model is missing."""
    total = 0.0
    for bearing in run.bearings:
        if bearing.scene is None:
            continue
        torque = bearing.friction_torque
        if torque is None or bearing.scene.speed is None:
            return None
        total += torque * abs(float(bearing.scene.speed.inner))
    return total

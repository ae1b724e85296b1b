"""Output of a system of shafts: JSON and tables, in SI."""

import dataclasses
import itertools
from typing import Any

import numpy as np

from ...cases.output_labels import label_output
from ...element.frame import LOAD_UNITS
from ...life.required_life import RequiredLife
from ...numerics.labels import LabelledArray, summaries
from ...numerics.result import Result
from ...report.json_output import run_json
from ...shafts import DutyResult
from ...shafts.duty import LIVES
from ...shafts.warning import axial_load
from ...statics.solution import BallSolution, Solution
from ..bearing.fit_report import fit_as_dict
from ..bearing.life_report import life_as_dict, over_required, verdict_as_dict
from ..bearing.oil import oil_as_dict
from .run import ShaftRun, bearing_loss


def shafts_as_dict(run: ShaftRun) -> dict[str, Any]:
    """Return the numbers of a run as plain numbers and lists, in SI.

    Returns:
        `bearings`, `gear`, `belt`, `shaft` by name, `system_life_hours`, `power`, of
        several cases `cases`; `result`, `message`, `warnings`, `inputs`, `version`.
    """
    found = run.solution
    numbers: dict[str, Any] = {}
    if run.bearings:
        numbers = {
            "bearings": {
                bearing.name: _bearing(run, k) for k, bearing in enumerate(run.bearings)
            },
            **_wheels(run),
            "shaft": {
                line.name: _shaft(state)
                for line, state in zip(
                    run.task.system.shafts, found.shafts, strict=True
                )
            },
            "power": {
                "drive": found.power.drive,
                "output": found.power.output,
                "output_shaft": found.power.output_shaft,
                "mesh_loss": found.power.loss,
                "bearing_loss": bearing_loss(run),
            },
            "system_life_hours": run.system_hours,
            **_thermal(run),
        }
        if run.duty is not None:
            numbers["cases"] = _cases(run, run.duty)
    numbers |= {
        "result": run.result.label,
        "message": run.problem,
        "residual": found.residual,
        "iterations": found.steps,
    }
    return run_json(numbers, run.warnings, run.task.inputs)


def _thermal(run: ShaftRun) -> dict[str, Any]:
    state, warming = run.thermal, run.warming
    if state is None:
        return {}
    names = [seat.name for seat in run.task.system.seats]
    found: dict[str, Any] = {
        "inner_ring": dict(zip(names, state.inner_ring, strict=True)),
        "outer_ring": dict(zip(names, state.outer_ring, strict=True)),
        "housing": state.housing,
        "friction": dict(zip(names, state.friction, strict=True)),
        "slowest_rate": state.slowest,
    }
    if warming is not None and run.task.times is not None:
        found["time"] = run.task.times
        rings = warming[:, : 2 * len(names)].T
        found["inner_ring_over_time"] = dict(zip(names, rings[::2], strict=True))
        found["outer_ring_over_time"] = dict(zip(names, rings[1::2], strict=True))
        if warming.shape[1] > 2 * len(names):
            found["housing_over_time"] = warming[:, -1]
    return {"heat": found}


def _bearing(run: ShaftRun, k: int) -> dict[str, Any]:
    found, bearing = run.solution, run.bearings[k]
    seat = run.task.system.seats[k]
    frame = np.asarray(run.task.system.shaft(seat.shaft).frame)
    moved = found.displacement[k]
    numbers: dict[str, Any] = {
        "load": found.load[k],
        "displacement": moved,
        "tilt": frame[:2] @ moved[3:],
        "axial_load": axial_load(run.task.system, k, np.asarray(found.load[k])),
        "stiffness": found.stiffness[k],
    }
    scene, solution, life = bearing.scene, bearing.solution, bearing.life
    if scene is None or solution is None or life is None:
        return numbers
    stated = [f.name for f in dataclasses.fields(solution) if "column" in f.metadata]
    of_balls = ("contact_load", "contact_angle")
    names = [
        "azimuth",
        *stated,
        *(of_balls if isinstance(solution, BallSolution) else ()),
    ]
    numbers |= {name: getattr(solution, name) for name in names}
    numbers |= _largest_numbers(solution)
    numbers |= life_as_dict(life, scene)
    numbers |= verdict_as_dict(scene.life, run.verdicts[k])
    numbers["life_hours"] = run.hours[k]
    if scene.oil is not None:
        numbers |= oil_as_dict(bearing.oil)
        numbers["temperature"] = scene.oil.temperature
    numbers["friction_torque"] = bearing.friction_torque
    numbers["clearance"] = bearing.clearance
    if scene.fits is not None:
        numbers["fit"] = fit_as_dict(scene)
    return numbers


def _largest_numbers(solution: Solution) -> dict[str, np.floating]:
    """Return the largest numbers of the rolling elements, by name, but for the load."""
    largest = summaries(type(solution)).items()
    return {k: np.max(getattr(solution, v)) for k, v in largest if k != "largest_load"}


def _wheels(run: ShaftRun) -> dict[str, Any]:
    found: dict[str, dict[str, Any]] = {"gear": {}, "belt": {}}
    task = run.task
    for mesh, apart in zip(
        run.solution.power.meshes, run.solution.misalignment, strict=True
    ):
        wheel = task.system.wheel(mesh.wheel)
        numbers = {
            "force": mesh.force,
            "torque": mesh.torque,
            "mate": mesh.mate,
        }
        kind = "gear" if hasattr(wheel, "teeth") else "belt"
        if kind == "gear":
            numbers["misalignment"] = apart
            frame = np.asarray(task.system.shaft(wheel.shaft).frame)
            numbers["radius"] = np.linalg.norm(frame[:2] @ mesh.place)
        same = found[kind].get(mesh.wheel)
        if same is None:
            found[kind][mesh.wheel] = numbers
        else:
            # An idler: the sum, and each mesh.
            meshes = same.pop("meshes", [dict(same)])
            total = np.asarray(same["force"]) + mesh.force
            same |= {"force": total, "meshes": [*meshes, numbers]}
    return found


def _shaft(state: Any) -> dict[str, Any]:
    moved = state.displacement
    return {
        "position": state.position,
        "deflection": moved[:, :3],
        "tilt": moved[:, 3:],
        "shear": state.shear,
        "moment": state.moment,
        "speed": state.speed,
    }


def _cases(run: ShaftRun, duty: DutyResult) -> dict[str, Any]:
    hours = [case.hours for case in run.task.cases]
    names = [seat.name for seat in run.task.system.seats]
    return {
        "hours": None if None in hours else hours,
        "settings": run.task.settings,
        "result": [Result(int(code)).label for code in duty.result],
        "misalignment": duty.misalignment,
        "speed": duty.speed,
        "bearings": {
            name: {
                "load": duty.load[:, k],
                "peak_pressure": duty.peak_pressure[:, k],
                **{key: of[:, k] for key, of in duty.lives.items()},
                **{key: of[:, k] for key, of in _ring_temperatures(run).items()},
            }
            for k, name in enumerate(names)
        },
    }


def _ring_temperatures(run: ShaftRun) -> dict[str, np.ndarray]:
    """Return temperatures of the rings in all cases by name (case, bearing) [K]."""
    if run.rings is None:
        return {}
    return {"inner_ring": run.rings[..., 0], "outer_ring": run.rings[..., 1]}


def shaft_columns(run: ShaftRun) -> dict[str, np.ndarray]:
    """Return a row for each bearing, of several cases one for each bearing and case."""
    names = [seat.name for seat in run.task.system.seats]
    if run.duty is None:
        found: dict[str, Any] = {"bearing": names}
        load = run.solution.load
        largest = [
            {} if b.solution is None else _largest_numbers(b.solution)
            for b in run.bearings
        ]
        most = {
            name: [numbers.get(name, np.nan) for numbers in largest]
            for name in dict.fromkeys(["peak_pressure", *itertools.chain(*largest)])
        }
        lives = {
            key: [
                np.nan if getattr(b.life, key, None) is None else getattr(b.life, key)
                for b in run.bearings
            ]
            for key in (*LIVES[:-1], "life_hours")
        }
    else:
        count = len(run.task.cases)
        found = {
            "case": np.repeat(np.arange(count), len(names)),
            "bearing": names * count,
        }
        for key in run.task.varied:
            values = [one[key] for one in run.task.settings]
            found[key] = np.repeat(np.array(values), len(names))
        load = run.duty.load.reshape(-1, 6)
        most = {"peak_pressure": run.duty.peak_pressure.ravel()}
        lives = {key: of.ravel() for key, of in run.duty.lives.items()}
    columns = [
        *LabelledArray(np.asarray(load), ("row", "component"), LOAD_UNITS).columns("")
    ]
    for key, values in (most | lives).items():
        columns += label_output(key, np.asarray(values, float)).columns(key)
    found |= {header: column for header, _, column in columns}
    if run.duty is not None:
        found |= {
            f"{key} [K]": of.ravel() for key, of in _ring_temperatures(run).items()
        }
    over = _over_required(run)
    if not np.isnan(over).all():
        kept = np.array([RequiredLife(factor).kept for factor in over.tolist()])
        if np.isnan(over).any():  # springs, and bearings without a required life
            kept = np.where(np.isnan(over), "", np.where(kept, "true", "false"))
        found |= {"life_factor": over, "life_kept": kept}
    return {name: np.asarray(values) for name, values in found.items()}


def _over_required(run: ShaftRun) -> np.ndarray:
    """Return the life over the required one of each row of the table, of a case as if
    it acted alone (row,) [1]; NaN without one."""
    if run.duty is None:
        factors = [None if v is None else v.factor for v in run.verdicts]
        return np.array(factors, float)
    damage, speed, _ = run.spectrum(run.duty)
    asked = [b.scene and b.scene.life for b in run.bearings] * len(damage)
    with np.errstate(divide="ignore"):
        turns = 1.0 / damage.ravel()
        hours = turns / (np.abs(speed).ravel() * (3600.0 / (2.0 * np.pi)))
    rows = zip(asked, hours, turns, strict=True)
    return np.array([over_required(*row) for row in rows], float)

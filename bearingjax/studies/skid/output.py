"""Output of skidding balls or rollers: JSON and tables, in SI."""

from typing import Any

import numpy as np

from ...numerics.labels import LabelledArray
from ...numerics.result import Result
from ...report.json_output import run_json
from ...skid.conditions import by_raceway
from ...skid.transients.transient import CAUSES
from .run import SkidRun

BALL_UNITS = {
    "azimuth": "rad",
    "orbit_speed": "rad/s",
    "rolling_orbit_speed": "rad/s",
    "slip": "",
    "spin": "rad/s",
    "contact_angle": "rad",
    "contact_load": "N",
    "film": "m",
    "least_film": "m",
    "sliding_speed": "m/s",
    "contact_spin": "rad/s",
    "heat": "W",
    "rolling_spin": "rad/s",
    "cage_force": "N",
}
"""Quantities of each ball or roller, with their units; the cage force is for rollers
and for balls in time, the rolling spin for rollers."""

OF_TIME = {
    "time": "s",
    "cage_speed": "rad/s",
    "rolling_cage_speed": "rad/s",
    "friction_torque": "N m",
    "ring_torque": "N m",
    "kinetic_energy": "J",
    "potential_energy": "J",
    "imbalance": "J",
}
"""Quantities at each time, with their units."""


def skid_as_dict(run: SkidRun) -> dict[str, Any]:
    """Return a run as plain numbers and lists, in SI.

    Returns:
        cage_speed, rolling_cage_speed, friction_torque (on the faster ring),
        ring_torque (outer, inner), power, and the quantities of `BALL_UNITS` for each
        ball or roller, those of contacts per raceway (outer, inner), of two arcs for
        the more loaded one. For a steady state they are at the positions in the solved
        bearing, `orbit` has them at all positions, and balls have `wander`. For a
        motion in time all have a leading axis `time`, with in addition the quantities
        of `OF_TIME`, `work`, and `mean_friction_torque` over the last complete cage
        revolutions, null without any; null at times that were not reached. Also
        result, message, residual, iterations, warnings, inputs (the file can be read
        as a scene) and version. Without a solution numbers are left out.
    """
    of_run = _end if run.task.steady else _motion
    status = {
        "result": run.result.label,
        "message": skid_message(run),
        "residual": _residual(run),
        "iterations": run.found.steps,
    }
    numbers = of_run(run) if run.has_numbers else {}
    return run_json({**numbers, **status}, run.warnings, run.task.inputs)


def skid_columns(run: SkidRun) -> dict[str, np.ndarray]:
    """Return a run as columns by header, "name [unit]": a row per orbit position.

    For a motion in time a row per time reached, with columns for each ball, such as
    "slip_3".

    Args:
        run: From `run_skid`, with numbers.
    """
    steady = run.task.steady
    lead = ["place"] if steady else ["time", "ball"]
    arrays = {}
    if not steady:
        powers = {f"power_{n}": np.asarray(v) for n, v in _powers(run).items()}
        units = OF_TIME | dict.fromkeys(powers, "W")
        whole = _of_time(run) | powers
        whole["ring_torque"] = whole.pop("ring_torque")  # after the powers
        for name, values in whole.items():
            axes = ("time", "raceway")[: values.ndim]
            arrays[name] = LabelledArray(values, axes, units[name])
    for name, values in each_ball(run).items():
        last = "spin_axis" if name == "spin" else "raceway"
        axes = (*lead, last)[: values.ndim]
        arrays[name] = LabelledArray(values, axes, BALL_UNITS[name])
    reached = slice(None) if steady else np.isfinite(run.found.cage_speed)
    return {
        header: column[reached]
        for name, array in arrays.items()
        for header, _, column in array.columns(name)
    }


def each_ball(run: SkidRun) -> dict[str, np.ndarray]:
    """Return the quantities of `BALL_UNITS` at all positions or times.

    Those of contacts are by raceway.
    """
    found, results = run.found, {}
    for name in BALL_UNITS:
        values = getattr(found, name, None)
        if name == "least_film" and run.state is not None:
            values = run.state.least_film
        if values is None:
            continue
        values = np.asarray(values)
        if name == "spin" and run.state is None:  # of rollers, about their axes
            values = values[..., None] * np.array([0.0, 0.0, 1.0])
        of_contacts = values.shape == found.contact_load.shape
        results[name] = (
            by_raceway(values, found.contact_load) if of_contacts else values
        )
    return results


def at_balls(run: SkidRun) -> np.ndarray:
    """Return the orbit positions of the elements in the solved bearing (ball,)."""
    places, balls = len(run.found.azimuth), len(run.found.solution.azimuth)
    return np.arange(balls) * places // balls


def rolling_cage_speed(run: SkidRun) -> np.ndarray:
    """Return the cage speed for pure rolling of all balls at their positions [rad/s].

    For a steady state one number, for a motion in time the mean of the balls (time,).
    """
    rolling = np.asarray(run.found.rolling_orbit_speed)
    if not run.task.steady:
        return rolling.mean(axis=1)
    return np.asarray(1.0 / np.mean(1.0 / rolling) if rolling.all() else 0.0)


def skid_message(run: SkidRun) -> str:
    """Return cause and remedy of a result, in words."""
    if not run.loads_solved:
        return run.found.solution.failure_message
    if run.converged:
        return "converged"
    steps = int(run.found.steps)
    if run.task.steady:
        return (
            f"No even motion was found in {steps} steps; force out of"
            f" balance {_residual(run):.1e} of the tractions. Take other"
            " `dynamics.places`, or integrate in time, without --steady."
        )
    time = run.found.time
    last = f"{time[run.n_reached - 1]:.4g} s" if run.n_reached else "the first time"
    where = f"The motion was followed to {last} of {time[-1]:.4g} s in {steps} steps"
    if run.result is Result.STEP_LIMIT:
        return f"{where}. Raise `dynamics.max_steps`, or take a larger tolerance."
    return f"{where}. {CAUSES[run.result]}"


def _residual(run) -> float:
    """Return the residual: relative force (steady), or energy over drive work."""
    found = run.found
    if run.task.steady:
        return float(found.residual)
    missing, done = np.abs(found.imbalance), np.abs(found.work.drive)
    reached = np.isfinite(missing)
    if not reached.any() or not done[reached].any():
        return np.nan
    return float(missing[reached].max() / done[reached].max())


def _powers(run) -> dict[str, Any]:
    found = run.found
    powers = found.power._asdict()
    # Cage pockets return the energy that they store.
    return powers if "cage" in powers else powers | {"cage": 0.0 * powers["drag"]}


def _end(run):
    found = run.found
    orbit = each_ball(run)
    own = {name: values[at_balls(run)] for name, values in orbit.items()}
    own["azimuth"] = found.solution.azimuth
    return {
        "cage_speed": found.cage_speed,
        "rolling_cage_speed": rolling_cage_speed(run),
        **own,
        "friction_torque": found.friction_torque,
        "ring_torque": found.ring_torque,
        "power": _powers(run),
        **({"wander": found.wander} if hasattr(found, "wander") else {}),
        "orbit": orbit,
    }


def _of_time(run):
    given = {"rolling_cage_speed": rolling_cage_speed(run)}
    return {n: np.asarray(given.get(n, getattr(run.found, n, 0))) for n in OF_TIME}


def _motion(run):
    mean, orbits = run.found.mean_friction_torque
    return {
        "mean_friction_torque": mean if orbits else None,
        **_of_time(run),
        **each_ball(run),
        "power": _powers(run),
        "work": run.found.work._asdict(),
    }

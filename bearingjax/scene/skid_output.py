"""What other programs read of balls that skid: JSON and tables, in SI."""

from pathlib import Path
from typing import Any

import numpy as np

from ..dynamics import by_raceway
from ..element import RINGS
from ..numerics.result import Result
from ..statics.solution import message
from .files import write_numbers
from .skid_run import SkidRun

UNITS = {
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
}
"""What is told of each ball, with its unit."""

OF_BALL = ("orbit_speed", "rolling_orbit_speed", "slip", "spin")
"""Of these a ball has one; of the others one for each raceway."""

AXES = ("x", "y", "z")


def skid_as_dict(run: SkidRun) -> dict[str, Any]:
    """A run as plain numbers and lists, in SI.

    Args:
        run: From `run_skid`.

    Returns:
        cage_speed, rolling_cage_speed, wander, friction_torque, power; `azimuth` and
        what `UNITS` lists for each ball where it stands in the solved bearing, those of
        contacts for each raceway (outer, inner), of two arcs that of the more loaded
        one; the same at all places along the `orbit`; result, message, residual,
        iterations, warnings and version. Without a solution numbers are left out.
    """
    from .. import __version__

    found = run.found
    residual = float(found.residual)
    return {
        **(_steady(run) if run.result is Result.CONVERGED else {}),
        "result": run.result.label,
        "message": skid_message(run),
        "residual": residual if np.isfinite(residual) else None,
        "iterations": int(found.steps),
        "warnings": list(run.warnings),
        "version": __version__,
    }


def write_skid_json(path: str | Path, run: SkidRun) -> None:
    """Write `skid_as_dict` to a file.

    Raises:
        OSError: If the file cannot be written.
    """
    write_numbers(path, skid_as_dict(run))


def skid_columns(run: SkidRun) -> dict[str, np.ndarray]:
    """A run as columns by header, "name [unit]": a row for each place along the orbit.

    Args:
        run: From `run_skid`, converged.
    """
    balls = each_ball(run)
    columns = {"azimuth [rad]": run.found.azimuth}
    for name, values in balls.items():
        ends = [""]
        if values.ndim > 1:
            ends = [f"_{end}" for end in (AXES if name == "spin" else RINGS)]
        unit = f" [{UNITS[name]}]" if UNITS[name] else ""
        parts = values.reshape(len(values), -1).T
        columns |= {f"{name}{e}{unit}": p for e, p in zip(ends, parts, strict=True)}
    return columns


def each_ball(run: SkidRun) -> dict[str, np.ndarray]:
    """What `UNITS` lists, at all places along the orbit; contacts by raceway.

    Args:
        run: From `run_skid`.
    """
    found = run.found
    values = {name: np.asarray(getattr(found, name, None)) for name in UNITS}
    values["least_film"] = run.state.least_film
    load = found.contact_load
    return {
        name: v if name in OF_BALL else by_raceway(v, load)
        for name, v in values.items()
    }


def at_balls(run: SkidRun) -> np.ndarray:
    """Places at which the balls stand in the solved bearing (ball,)."""
    places, balls = len(run.found.azimuth), len(run.found.solution.azimuth)
    return np.arange(balls) * places // balls


def rolling_cage_speed(run: SkidRun) -> float:
    """Speed of the cage if all balls rolled, each where it is [rad/s]."""
    rolling = run.found.rolling_orbit_speed
    return float(len(rolling) / (1.0 / rolling).sum()) if rolling.all() else 0.0


def skid_message(run: SkidRun) -> str:
    """Cause and cure of a result, in words.

    Args:
        run: From `run_skid`.
    """
    if not run.loads_solved:
        return message(run.found.solution, run.task.scene.moving_ring)
    if run.result is Result.CONVERGED:
        return "converged"
    return (
        f"No even motion of the balls was found in {int(run.found.steps)} steps; force"
        f" out of balance {float(run.found.residual):.1e} of the tractions. Take other"
        " `dynamics.places`, or integrate in time, without --steady."
    )


def _steady(run):
    found = run.found
    orbit = {"azimuth": found.azimuth, **each_ball(run)}
    places = at_balls(run)
    own = {name: values[places].tolist() for name, values in orbit.items()}
    own["azimuth"] = found.solution.azimuth.tolist()
    return {
        "cage_speed": float(found.cage_speed),
        "rolling_cage_speed": rolling_cage_speed(run),
        **own,
        "friction_torque": float(found.friction_torque),
        "power": {k: float(v) for k, v in found.power._asdict().items()},
        "wander": float(found.wander),
        "orbit": {name: values.tolist() for name, values in orbit.items()},
    }

"""Output of a rotor: JSON and tables, in SI."""

from typing import Any

import numpy as np

from ...files.quantity import SceneError
from ...numerics.result import Result
from ...report.json_output import run_json
from ...rotor import STATION_FREEDOMS, Modes
from ...rotor.shaft import STATION_UNITS
from ..bearing.fit_report import fit_as_dict
from ..bearing.life_report import life_as_dict, life_verdict, verdict_as_dict
from .motion import RotorResponse, RotorTransient
from .read import RotorScene
from .run import RotorRun

SERIES = "response", "transient"
"""Results with a row per point, and per time."""
_TURN = 2.0 * np.pi


def rotor_as_dict(run: RotorRun) -> dict[str, Any]:
    """Return a run as plain numbers and lists, in SI, with frequencies in Hz.

    Returns:
        `frequency` [Hz], `damping_ratio` and `whirl` of the oscillating modes;
        `critical_speed` [rad/s] with `critical_whirl` and `critical_damping_ratio`;
        `static`: `station` [m], `displacement` (station, 5), `bearing`,
        `bearing_station`, `load` (bearing, 5), `stiffness` (bearing, 5, 5);
        `campbell`: `speed`, and `frequency`, `damping_ratio`, `whirl` (speed, mode),
        and for modes that become unstable `onset_speed` [rad/s] with `onset_frequency`
        [Hz] and `onset_mode`, from 0;
        `response`: `method`, `frequency` [Hz], `coordinate` ("uy_1": uy of station 1),
        `amplitude` (point, coordinate), and unless it is linear `stable`,
        `multipliers` (point, multiplier, real and imaginary part), `events` (`kind`,
        `frequency` [Hz], `amplitude` (coordinate,)), `ending`;
        `transient`: `time`, `speed`, `coordinate`, `displacement` and `velocity`
        (time, coordinate). Parts not requested or not solved are left out.
        With [life] `life`, a list: `bearing`, `station`, and the output of
        `life_as_dict`, under the loads of `static`. With fits `fit`, a list: `bearing`,
        its `stations`, the `speed` [rad/s] of its inner ring, and the output of
        `fit_as_dict`.
        Also result, message, warnings, inputs (readable as a scene) and version.
    """
    parts: dict[str, Any] = {}
    if run.modes is not None:
        there = np.imag(run.modes.eigenvalue) > 0
        parts |= {name: values[there] for name, values in mode_numbers(run.modes)}
    if (found := run.critical) is not None:
        there, names = np.isfinite(found.speed), ("speed", "whirl", "damping_ratio")
        parts |= {f"critical_{name}": getattr(found, name)[there] for name in names}
    if run.task.seats:
        parts["fit"] = [
            {
                "bearing": mount.name,
                "stations": stations,
                "speed": run.task.speed,
                **fit_as_dict(mount.scene),
            }
            for mount, stations in run.task.seats
            if mount.scene is not None
        ]
    if run.settled is not None:
        parts["static"] = _static(run)
    if run.lives:
        parts["life"] = [
            {
                "bearing": mount.name,
                "station": mount.station,
                **life_as_dict(life, mount.scene),
                **verdict_as_dict(mount.scene.life, life_verdict(mount.scene, life)),
            }
            for mount, life in run.lives
            if mount.scene is not None
        ]
    if run.campbell is not None and run.task.campbell is not None:
        parts["campbell"] = {
            "speed": run.task.campbell,
            **dict(mode_numbers(run.campbell)),
            **{
                f"onset_{name}": [getattr(onset, name) for onset in run.onsets]
                for name in ("speed", "frequency", "mode")
            },
        }
    if run.response is not None:
        parts["response"] = _response(run.response)
    if run.transient is not None:
        parts["transient"] = _transient(run.transient)
    worst = max((one.result for one in run.failures), default=Result.CONVERGED)
    parts |= {"result": worst.label, "message": rotor_message(run)}
    return run_json(parts, run.warnings, run.task.inputs)


def rotor_message(run: RotorRun) -> str:
    """Return the message of a run: the parts that were not solved."""
    if run.converged:
        return "converged"
    return "; ".join(f"{one.part}: {one.message}" for one in run.failures)


def mode_numbers(found: Modes) -> list[tuple[str, np.ndarray]]:
    """Return frequency [Hz], damping ratio and whirl of modes, also over speeds.

    Args:
        found: Modes, in NumPy.
    """
    value = np.asarray(found.eigenvalue)
    size = np.abs(value)
    ratio = -np.real(value) / np.where(size == 0, 1.0, size)
    return [
        ("frequency", np.imag(value) / _TURN),
        ("damping_ratio", np.where(size == 0, 0.0, ratio)),
        ("whirl", np.asarray(found.whirl)),
    ]


def rotor_series(task: RotorScene, wanted: str | None) -> str:
    """Return which series of a scene is tabulated, "response" or "transient".

    Args:
        task: From `read_rotor`.
        wanted: One of them, or `None`: the only one in the scene.

    Raises:
        SceneError: If the scene does not have it, or has both and `wanted` is
            `None`.
    """
    asked = [name for name in SERIES if getattr(task, name) is not None]
    if wanted is None and len(asked) == 1:
        return asked[0]
    if wanted in asked:
        return wanted
    if wanted is None and asked:
        raise SceneError(
            f"{task.name}: has a [rotor.response] and a [rotor.transient]; say which of"
            " them the table is to have, by --series response or --series transient"
        )
    tables = [wanted] if wanted is not None else SERIES
    missing = " nor ".join(f"[rotor.{name}]" for name in tables)
    raise SceneError(f"{task.name}: has no {missing}; a table has nothing to hold")


def rotor_columns(run: RotorRun, series: str) -> dict[str, np.ndarray]:
    """Return a run as columns by header, "name [unit]".

    Args:
        run: From `run_rotor`.
        series: "response" or "transient".

    Returns:
        For the response a row per point: frequency, stability, half the peak-to-peak
        value of every motion ("uy_1 [m]": uy of station 1). For the motion in time a
        row for each time reached: time, speed, motions. Empty if it was not
        solved.
    """
    if series == "response" and run.response is not None:
        first = {"frequency [Hz]": run.response.frequency / _TURN}
        if run.response.branch is not None:
            first["stable"] = run.response.branch.stable
        return first | _of_motions(run.response.amplitude)
    if series == "transient" and run.transient is not None:
        motion, seen = run.transient, slice(run.transient.n_reached)
        first = {"time [s]": motion.time[seen], "speed [rad/s]": motion.speed[seen]}
        return first | _of_motions(motion.displacement[seen])
    return {}


def coordinates(count: int) -> list[str]:
    """Return the names of the motions of `count` stations, such as "uy_1"."""
    return [f"{name}_{k}" for k in range(count) for name in STATION_FREEDOMS]


def _of_motions(values):
    """Return the columns of (row, station, 5)."""
    names = coordinates(values.shape[1])
    units = zip(names, STATION_UNITS * values.shape[1], strict=True)
    headers = [f"{name} [{unit}]" for name, unit in units]
    flat = values.reshape(len(values), -1).T
    return dict(zip(headers, flat, strict=True))


def _static(run: RotorRun) -> dict[str, Any]:
    task, settled = run.task, run.settled
    assert settled is not None  # checked by the caller
    return {
        "station": task.shaft.stations,
        "displacement": np.asarray(settled.displacement)[task.nodes],
        "bearing": [mount.name for mount in task.mounts],
        "bearing_station": [mount.station for mount in task.mounts],
        "load": settled.support_load,
        "stiffness": settled.stiffness,
    }


def _response(found: RotorResponse) -> dict[str, Any]:
    points, branch = len(found.frequency), found.branch
    whole = {
        "method": found.method,
        "frequency": found.frequency / _TURN,
        "coordinate": coordinates(found.amplitude.shape[1]),
        "amplitude": found.amplitude.reshape(points, -1),
    }
    if branch is None:
        return whole
    both = np.stack([np.real(branch.multipliers), np.imag(branch.multipliers)], -1)
    events = [
        {
            "kind": event.kind,
            "frequency": event.frequency / _TURN,
            "amplitude": amplitude.ravel(),
        }
        for event, amplitude in zip(branch.events, found.event_amplitude, strict=True)
    ]
    return whole | {
        "stable": branch.stable,
        "multipliers": both,
        "events": events,
        "ending": branch.ending.label,
    }


def _transient(found: RotorTransient) -> dict[str, Any]:
    times = len(found.time)
    return {
        "time": found.time,
        "speed": found.speed,
        "coordinate": coordinates(found.displacement.shape[1]),
        "displacement": found.displacement.reshape(times, -1),
        "velocity": found.velocity.reshape(times, -1),
    }

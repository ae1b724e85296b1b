"""A rotor as text: µm, mrad, N, N/µm, Hz, rpm."""

import numpy as np

from ...numerics.types import in_numpy
from ...numerics.units import rpm, shown_count
from ...report.report_model import (
    NEWTONS,
    Column,
    Grid,
    Part,
    Report,
    Section,
    with_values,
)
from ...rotor import STATION_FREEDOMS, BearingSupport
from ...rotor.nonlinear import BranchEnd
from ...rotor.shaft import STATION_UNITS
from ..bearing.credibility import credibility_section
from ..bearing.fit_report import fit_report
from ..solve.report import without_round_off
from .motion import RotorResponse, RotorTransient
from .output import mode_numbers
from .run import RotorRun

_HZ = 0.5 / np.pi
_ENDS = {
    BranchEnd.LIMIT: "is complete",
    BranchEnd.POINTS: "ends at the largest number of points",
    BranchEnd.SMALL_STEP: "ends, as no step leads on",
    BranchEnd.NO_START: "has no orbit at the first frequency",
    BranchEnd.REST: "ends at frequency zero",
}
_STIFFNESS = 1e-6, "N/µm"
_AXES = tuple(enumerate("xyz"))
_WHIRL = {1: "forward", -1: "backward", 0: "-"}
_AXIAL = 0.9
"""Axial share of the largest motion above which a mode counts as axial [1]."""


def rotor_report(run: RotorRun) -> Report:
    """Return the readable report of a rotor; unsolved parts are left out."""
    placed = []
    if run.rotor is not None and run.settled is not None:
        found = run.rotor.supports, np.asarray(run.settled.support_load)
        placed = [
            (f"{mount.station} {mount.name}", support.element, load)
            for mount, support, load in zip(run.task.mounts, *found, strict=True)
            if isinstance(support, BearingSupport)
        ]
    sections: dict[str, Section] = {
        "Rotor": [_head(run)],
        **_fit_sections(run.task),
        "At rest": [] if run.settled is None else [_stations(run), _bearings(run)],
        "Rating life": _lives(run),
        "Modes": [] if run.modes is None else _modes(run),
        "Critical speeds": [] if run.critical is None else [_critical(run)],
        "Campbell diagram": [] if run.campbell is None else _campbell(run),
        "Response": [] if run.response is None else _response(run, run.response),
        "Motion in time": []
        if run.transient is None
        else _transient(run, run.transient),
        "Credibility": credibility_section("rotor", placed),
    }
    return Report(sections, run.warnings)


def _length(run):
    """Return the length of the shaft [m]."""
    return float(np.ptp(np.asarray(run.task.shaft.stations)))


def _head(run):
    task = run.task
    z = np.asarray(task.shaft.stations)
    mass = float(in_numpy(task.shaft).mass) + sum(
        float(part.mass) for part in task.discs
    )
    kind = "rigid shaft" if task.keys.rigid else "shaft"
    gravity = {"none": "no gravity"}.get(task.keys.axis, task.keys.axis)
    return (
        f"{task.name}: {kind} of {1e3 * (z[-1] - z[0]):.5g} mm, {task.shaft.n_segments}"
        f" segments, {task.shaft.n_nodes - 1} elements; {mass:.4g} kg; {gravity};"
        f" {rpm(task.speed)}"
    )


def _lives(run) -> Section:
    """Tabulate the lives of the bearings in the equilibrium."""
    if not run.lives:
        return []
    lives = [life for _, life in run.lives]
    columns = [
        Column("bearing", [f"{m.station} {m.name}" for m, _ in run.lives]),
        Column("C0/P0", [float(x.static_safety) for x in lives], "1", ".3g", (1.0, "")),
        Column("basic", [float(x.basic_rating_life) for x in lives], "rev"),
        Column("reference", [float(x.reference_rating_life) for x in lives], "rev"),
        *with_values(
            Column("modified", [x.modified_rating_life for x in lives], "rev"),
            Column("life", [x.life_hours for x in lives], "h"),
        ),
    ]
    return [Grid(columns, "rating lives under the loads of the static equilibrium")]


def _fit_sections(task):
    """Report the fits of each bearing, by section title."""
    found = {}
    for mount, stations in task.seats:
        where = "station" + "s" * (len(stations) > 1)
        head = (
            f"{mount.name} at {where} {', '.join(map(str, stations))}, its inner ring"
            f" turning at {rpm(task.speed)}"
        )
        lines = fit_report(mount.scene)
        found[f"Fits of {mount.name}"] = [head, *lines]
    return found


def _stations(run):
    """Tabulate the static displacement of every station."""
    task = run.task
    moved = np.round(np.asarray(run.settled.displacement)[task.nodes], 9)
    z = np.asarray(task.shaft.stations)
    columns = [
        Column("station", list(task.station_names)),
        Column("z", z, "m", ".1f", (1e3, "mm")),
        *(
            Column(name, values, unit, ".3f")
            for name, values, unit in zip(
                STATION_FREEDOMS, moved.T, STATION_UNITS, strict=True
            )
        ),
    ]
    return Grid(columns, "at rest under weight, constant forces and preload")


def _bearings(run):
    """Tabulate load and stiffness of every bearing."""
    loads, stiffness = (
        np.asarray(part) for part in (run.settled.support_load, run.settled.stiffness)
    )
    # A bearing without ribs has no axial stiffness.
    stiff = [np.diagonal(without_round_off(k[:3, :3])) for k in stiffness]
    names = [
        f"{mount.station} {mount.name}{', turned' if mount.keys.turned else ''}"
        for mount in run.task.mounts
    ]
    forces = np.round(loads[:, :3], 1)
    columns = [
        Column("bearing", names),
        *(Column(f"F{x}", forces[:, k], "N", ".1f", NEWTONS) for k, x in _AXES),
        *(
            Column(f"k{x}", np.array(stiff)[:, k], "N/m", ".4g", _STIFFNESS)
            for k, x in _AXES
        ),
    ]
    return Grid(columns)


def _whirl(whirl, shape, length):
    """Describe the whirl direction of a mode in a word.

    Args:
        whirl: Whirl of the mode.
        shape: Mode shape of the nodes (node, 5).
        length: Length of the shaft [m].
    """
    size = np.abs(shape) * np.array([1.0, 1.0, 1.0, length, length])
    if size[:, 2].max() > _AXIAL * size.max():
        return "axial"
    return _WHIRL[int(whirl)]


def _modes(run):
    (_, frequency), (_, ratio), (_, whirl) = mode_numbers(run.modes)
    length = _length(run)
    there = frequency > 0
    hertz, shape = frequency[there], np.asarray(run.modes.shape)[there]
    senses = zip(whirl[there], shape, strict=True)
    columns = [
        Column("mode", range(1, len(hertz) + 1)),
        Column("frequency", hertz, "Hz"),
        Column("", 2.0 * np.pi * hertz, "rad/s"),
        Column("damping ratio", np.round(ratio[there], 12), "", ".4g"),
        Column("whirl", [_whirl(sense, moved, length) for sense, moved in senses]),
    ]
    rest = int((~there).sum())
    title = f"modes at {rpm(run.task.speed)}"
    return [
        *([Grid(columns, title)] if there.any() else []),
        *([f"not oscillating: {shown_count(rest, 'mode')}"] if rest else []),
    ]


def _critical(run):
    found = run.critical
    there = np.isfinite(found.speed)
    if not there.any():
        return "critical speeds: none"
    speed, ratio, whirl, shape = (
        np.asarray(part)[there]
        for part in (found.speed, found.damping_ratio, found.whirl, found.shape)
    )
    senses = zip(whirl, shape, strict=True)
    columns = [
        Column("critical speed", range(1, len(speed) + 1)),
        Column("", speed, "rad/s"),
        Column("", speed, "rad/s", ".5g", (1.0, "rad/s")),
        Column("damping ratio", np.round(ratio, 12), "", ".4g"),
        Column("whirl", [_whirl(sense, s, _length(run)) for sense, s in senses]),
    ]
    return Grid(columns)


def _campbell(run):
    (_, frequency), _, (_, whirl) = mode_numbers(run.campbell)
    shape = np.asarray(run.campbell.shape)[-1]
    speeds = run.task.campbell
    followed = np.flatnonzero(frequency.max(axis=0) > 0)
    senses = [_whirl(whirl[-1, k], shape[k], _length(run)) for k in followed]
    columns = [
        Column("mode", followed + 1),
        Column(f"at {rpm(speeds[0])}", frequency[0, followed], "Hz"),
        Column(f"at {rpm(speeds[-1])}", frequency[-1, followed], "Hz"),
        Column("whirl", senses),
    ]
    onsets = [
        f"mode {onset.mode + 1} is unstable from {rpm(onset.speed)}"
        f" ({onset.speed:.5g} rad/s) on, at {onset.frequency:.5g} Hz"
        for onset in run.onsets
    ]
    title = f"Campbell diagram at {len(speeds)} speeds, natural frequencies"
    return [Grid(columns, title), *onsets]


def _response(run, found: RotorResponse):
    asked = run.task.response
    span = _HZ * found.frequency
    method = found.method.replace("_", " ")
    head = "linear response" if method == "linear" else f"response by {method}"
    across = np.hypot(*np.moveaxis(found.amplitude[:, :, :2], -1, 0))
    points = across.argmax(axis=0)
    ends = found.amplitude[points, np.arange(len(points)), :2]
    names = [
        f"{name}{' *' if k == asked.station else ''}"
        for k, name in enumerate(run.task.station_names)
    ]
    columns = [
        Column("half of peak to peak", names),
        Column("largest at", span[points], "Hz"),
        Column("ux", ends[:, 0], "m", ".4g"),
        Column("uy", ends[:, 1], "m", ".4g"),
    ]
    title = f"{head}: {len(span)} points, {span.min():.5g} to {span.max():.5g} Hz"
    title += "; * is the `station` asked for"
    parts: list[Part] = [Grid(columns, title)]
    branch = found.branch
    if branch is None:
        return parts
    coordinate = STATION_FREEDOMS.index(asked.coordinate)
    factor, unit = (1e6, "µm") if coordinate < 3 else (1e3, "mrad")
    for event, moved in zip(branch.events, found.event_amplitude, strict=True):
        kind = event.kind.replace("_", "-")
        parts.append(
            f"{kind} at {_HZ * event.frequency:.6g} Hz ({asked.coordinate} of station"
            f" {asked.station}: {factor * moved[asked.station, coordinate]:.4g} {unit})"
        )
    stable = int(branch.stable.sum())
    parts.append(
        f"{stable} of {len(span)} points are stable; the branch {_ENDS[branch.ending]}"
    )
    return parts


def _transient(run, found: RotorTransient):
    n, time = found.n_reached, found.time
    if not n:
        return ["motion in time: none"]
    moved = found.displacement[:n, :, :2]
    half = 0.5 * (moved.max(axis=0) - moved.min(axis=0))
    radius = np.hypot(*np.moveaxis(moved - moved[0], -1, 0))
    when = radius.argmax(axis=0)
    columns = [
        Column("half of peak to peak", list(run.task.station_names)),
        Column("ux", half[:, 0], "m", ".4g"),
        Column("uy", half[:, 1], "m", ".4g"),
        Column("farthest", radius.max(axis=0), "m", ".4g"),
        Column("at", time[when], "s", ".4g"),
        Column("at", found.speed[when], "rad/s"),
    ]
    title = (
        f"motion in time to {time[n - 1]:.4g} s, {found.steps} steps;"
        f" {rpm(found.speed[0])} to {rpm(found.speed[n - 1])}"
    )
    return [Grid(columns, title)]

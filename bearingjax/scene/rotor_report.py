"""A rotor as text for people: µm, mrad, N, N/µm, Hz, rpm."""

import numpy as np

from ..rotor import STATION_FREEDOMS
from .fit_report import fit_report
from .report import without_round_off
from .rotor_motion import RotorResponse, RotorTransient
from .rotor_output import mode_numbers
from .rotor_run import RotorRun

_RULE = "-" * 78
_HZ, _RPM = 0.5 / np.pi, 30.0 / np.pi
_WHIRL = {1: "forward", -1: "backward", 0: "-"}
_AXIAL = 0.9
"""Share of the largest motion above which a motion along the shaft is the mode [1]."""


def rotor_report(run: RotorRun) -> str:
    """Readable report of a rotor; parts that were not solved are left out.

    Args:
        run: From `run_rotor`.
    """
    parts = [_head(run), *_fits(run.task)]
    if run.settled is not None:
        parts += [_stations(run), _bearings(run)]
    if run.modes is not None:
        parts.append(_modes(run))
    if run.critical is not None:
        parts.append(_critical(run))
    if run.campbell is not None:
        parts.append(_campbell(run))
    if run.response is not None:
        parts.append(_response(run, run.response))
    if run.transient is not None:
        parts.append(_transient(run, run.transient))
    notes = [f"warning: {text}" for text in run.warnings]
    return f"\n{_RULE}\n".join(parts) + "".join(f"\n{note}" for note in notes)


def _length(run):
    """Of the shaft [m]."""
    return float(np.ptp(np.asarray(run.task.shaft.stations)))


def _head(run):
    task = run.task
    z = np.asarray(task.shaft.stations)
    mass = float(task.shaft.mass) + sum(float(part.mass) for part in task.discs)
    kind = "rigid shaft" if task.rigid else "shaft"
    gravity = {"none": "no gravity"}.get(task.axis, task.axis)
    return (
        f"{task.name}: {kind} of {1e3 * (z[-1] - z[0]):.5g} mm, {task.shaft.n_segments}"
        f" segments, {task.shaft.n_nodes - 1} elements; {mass:.4g} kg; {gravity};"
        f" {rpm(task.speed)}"
    )


def _fits(task):
    """What the fits of each bearing leave."""
    for mount, stations in task.seats:
        where = "station" + "s" * (len(stations) > 1)
        yield (
            f"{mount.name} at {where} {', '.join(map(str, stations))}, its inner ring"
            f" turning at {rpm(task.speed)}\n"
            + fit_report(mount.fits, mount.element.bearing)
        )


def _stations(run):
    """Where every station goes."""
    task = run.task
    nodes = [task.shaft.node(k) for k in range(task.shaft.n_segments + 1)]
    moved = np.asarray(run.settled.displacement)[nodes]
    z = 1e3 * np.asarray(task.shaft.stations)
    lines = [
        "at rest under weight, constant forces and preload:",
        f"{'station':<26}{'z, mm':>8}{'ux, µm':>9}{'uy, µm':>9}{'uz, µm':>9}"
        f"{'gx, mrad':>9}{'gy, mrad':>9}",
    ]
    for name, place, motion in zip(task.station_names, z, moved, strict=True):
        values = [*(1e6 * motion[:3]), *(1e3 * motion[3:])]
        numbers = "".join(f"{_clean(value, 3):9.3f}" for value in values)
        lines.append(f"{name[:25]:<26}{place:8.1f}{numbers}")
    return "\n".join(lines)


def _bearings(run):
    """Load and stiffness of every bearing."""
    loads, stiffness = (
        np.asarray(part) for part in (run.settled.support_load, run.settled.stiffness)
    )
    lines = [
        f"{'bearing':<26}{'load, N':>9}{'':>18}{'stiffness, N/µm':>25}",
        f"{'':<26}{'Fx':>9}{'Fy':>9}{'Fz':>9}{'x':>9}{'y':>9}{'z':>8}",
    ]
    for mount, load, k in zip(run.task.mounts, loads, stiffness, strict=True):
        name = f"{mount.station} {mount.name}{', turned' if mount.turned else ''}"
        forces = "".join(f"{_clean(f, 1):9.1f}" for f in load[:3])
        # A bearing without ribs has none along z.
        x, y, z = np.diagonal(1e-6 * without_round_off(k[:3, :3]))
        lines.append(f"{name[:25]:<26}{forces}{x:9.4g}{y:9.4g}{z:8.4g}")
    return "\n".join(lines)


def _whirl(whirl, shape, length):
    """In which sense a mode whirls, in a word.

    Args:
        whirl: Of the mode.
        shape: Of its nodes (node, 5).
        length: Of the shaft [m].
    """
    size = np.abs(shape) * np.array([1.0, 1.0, 1.0, length, length])
    if size[:, 2].max() > _AXIAL * size.max():
        return "axial"
    return _WHIRL[int(whirl)]


def _modes(run):
    (_, frequency), (_, ratio), (_, whirl) = mode_numbers(run.modes)
    length = _length(run)
    lines = [
        f"modes at {rpm(run.task.speed)}:",
        f"{'':>4}{'Hz':>12}{'rpm':>12}{'damping':>12}  whirl",
    ]
    there = frequency > 0
    shape = np.asarray(run.modes.shape)[there]
    rows = zip(frequency[there], ratio[there], whirl[there], shape, strict=True)
    for k, (hertz, damped, sense, moved) in enumerate(rows):
        lines.append(
            f"{k + 1:4d}{hertz:12.5g}{60.0 * hertz:12.5g}{_clean(damped):12.4g}"
            f"  {_whirl(sense, moved, length)}"
        )
    if not there.all():
        lines.append(f"and {int((~there).sum())} that do not oscillate")
    return "\n".join(lines)


def _critical(run):
    found = run.critical
    there = np.isfinite(found.speed)
    if not there.any():
        return "critical speeds: none"
    lines = [
        "critical speeds:",
        f"{'':>4}{'rpm':>12}{'rad/s':>12}{'damping':>12}  whirl",
    ]
    parts = (found.speed, found.damping_ratio, found.whirl, found.shape)
    rows = zip(*(np.asarray(part)[there] for part in parts), strict=True)
    for k, (speed, ratio, whirl, shape) in enumerate(rows):
        lines.append(
            f"{k + 1:4d}{speed * _RPM:12.5g}{speed:12.5g}{_clean(ratio):12.4g}"
            f"  {_whirl(whirl, shape, _length(run))}"
        )
    return "\n".join(lines)


def _campbell(run):
    (_, frequency), _, (_, whirl) = mode_numbers(run.campbell)
    shape = np.asarray(run.campbell.shape)[-1]
    first, last = run.task.campbell[0], run.task.campbell[-1]
    lines = [
        f"Campbell diagram at {len(run.task.campbell)} speeds, natural frequencies:",
        f"{'':>4}{rpm(first):>14}{rpm(last):>14}",
    ]
    for k in np.flatnonzero(frequency.max(axis=0) > 0):
        lines.append(
            f"{k + 1:4d}{frequency[0, k]:11.5g} Hz{frequency[-1, k]:11.5g} Hz"
            f"  {_whirl(whirl[-1, k], shape[k], _length(run))}"
        )
    for onset in run.onsets:
        lines.append(
            f"{onset.mode + 1:4d} is unstable from {rpm(onset.speed)}"
            f" ({onset.speed:.5g} rad/s) on, at {onset.frequency:.5g} Hz"
        )
    return "\n".join(lines)


def _response(run, found: RotorResponse):
    asked = run.task.response
    span = _HZ * found.frequency
    method = found.method.replace("_", " ")
    head = "linear response" if method == "linear" else f"response by {method}"
    lines = [
        f"{head}: {len(span)} points, {span.min():.5g} to"
        f" {span.max():.5g} Hz; half of peak to peak:",
    ]
    for k, name in enumerate(run.task.station_names):
        across = np.hypot(*found.amplitude[:, k, :2].T)
        point = int(np.argmax(across))
        x, y = 1e6 * found.amplitude[point, k, :2]
        mark = " *" if k == asked.station else ""
        lines.append(
            f"{name[:25]:<26}largest at {span[point]:.5g} Hz: ux {x:.4g} µm,"
            f" uy {y:.4g} µm{mark}"
        )
    branch = found.branch
    if branch is None:
        return "\n".join(lines)
    coordinate = STATION_FREEDOMS.index(asked.coordinate)
    factor, unit = (1e6, "µm") if coordinate < 3 else (1e3, "mrad")
    for event, moved in zip(branch.events, found.event_amplitude, strict=True):
        kind = event.kind.replace("_", "-")
        lines.append(
            f"{kind} at {_HZ * event.frequency:.6g} Hz ({asked.coordinate} of station"
            f" {asked.station}: {factor * moved[asked.station, coordinate]:.4g} {unit})"
        )
    stable = int(branch.stable.sum())
    lines.append(
        f"{stable} of {len(span)} points are stable; the branch ends:"
        f" {branch.ending.label.replace('_', ' ')}"
    )
    return "\n".join(lines)


def _transient(run, found: RotorTransient):
    n, time = found.reached, found.time
    if not n:
        return "motion in time: none"
    lines = [
        f"motion in time to {time[n - 1]:.4g} s, {found.steps} steps;"
        f" {rpm(found.speed[0])} to {rpm(found.speed[n - 1])}:"
    ]
    for k, name in enumerate(run.task.station_names):
        moved = 1e6 * found.displacement[:n, k, :2]
        half = 0.5 * (moved.max(axis=0) - moved.min(axis=0))
        radius = np.hypot(*(moved - moved[0]).T)
        when = int(np.argmax(radius))
        lines.append(
            f"{name[:25]:<26}half of peak to peak ux {half[0]:.4g} µm, uy"
            f" {half[1]:.4g} µm; farthest {radius[when]:.4g} µm at {time[when]:.4g} s"
            f" ({rpm(found.speed[when])})"
        )
    return "\n".join(lines)


def _clean(value, digits=12):
    """Rounded, without a minus before a zero."""
    return round(float(value), digits) + 0.0


def rpm(speed: float) -> str:
    """A speed for people.

    Args:
        speed: [rad/s].
    """
    return f"{float(speed) * _RPM:.5g} rpm"

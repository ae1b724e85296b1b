"""The noise of a bearing, as text for people."""

import numpy as np

from ..acoustics.level import LOWEST_LEVEL
from ..design import is_ball
from ..element.frame import LOADS
from .noise_output import PERCENTILES, parts_of
from .noise_run import NoiseRun, ring_modes
from .noise_scene import DIRECTIONS
from .report import bearing_text

_RULE = "-" * 78
_RPM = 30.0 / np.pi
_LINES = 12
"""Lines that are told, the largest ones."""


def noise_report(run: NoiseRun) -> str:
    """Readable report of the noise of a bearing.

    Args:
        run: From `run_noise`, converged.
    """
    parts = [_bearing(run), _modes(run), _levels(run), _lines(run), _states(run)]
    if run.many is not None:
        parts.append(_many(run))
    notes = "".join(f"\nwarning: {text}" for text in run.warnings)
    return f"\n{_RULE}\n".join(parts) + notes


def _bearing(run):
    model = run.task.model
    bearing = model.element.bearing
    load = ", ".join(
        f"{name} {value:.5g} {'N' if name[0] == 'F' else 'N m'}"
        for name, value in zip(LOADS, np.asarray(model.load), strict=True)
        if value
    )
    inner, outer = (float(s) * _RPM for s in (model.speed.inner, model.speed.outer))
    task, record = run.task, run.heard.record
    return "\n".join(
        [
            bearing_text(task.scene, bearing),
            f"the {model.moving_ring} ring moves, {float(model.mass):.4g} kg, loaded by"
            f" {load or 'nothing'}; inner ring {inner:.5g} rpm, outer ring"
            f" {outer:.5g} rpm",
            f"record of {task.turns} turns, {float(record.duration):.4g} s, after"
            f" {task.settle} to settle; {len(record.time)} samples, {run.steps} steps"
            " each",
        ]
    )


def _modes(run):
    found = [
        f"{frequency:.5g} Hz, {name}"
        for name, frequency in ring_modes(run.modes, run.task.model)
    ]
    return "natural modes of the ring: " + ("; ".join(found) or "none")


def _levels(run):
    """Level of every band and direction, beside the norm if there is one."""
    heard, task = run.heard, run.task
    norm = task.norm
    head = f"level, dB over {task.reference:.3g} m/s²"
    lines = [
        head
        + "".join(f"{name:>9}" for name in DIRECTIONS)
        + ("     norm" if norm is not None else ""),
    ]
    width = len(head)
    lines.append(f"{'all':>{width}}" + "".join(map(_level, heard.level)))
    for k, centre in enumerate(task.bands.centre):
        told = "".join(map(_level, heard.band_level[k]))
        limit = f"{norm[k]:9.1f}" if norm is not None else ""
        name = f"{centre:g} Hz"
        lines.append(f"{name:>{width}}{told}{limit}")
    return "\n".join(lines)


def _level(value):
    """A level; nothing of a band that is not held, or where nothing moves."""
    return f"{value:9.1f}" if value > LOWEST_LEVEL else f"{'-':>9}"


def _lines(run):
    """The largest lines, what they are and what makes them."""
    pairs = list(zip(run.heard.lines, run.heard.causes, strict=True))
    if not pairs:
        return "no line stands out of the spectrum"
    largest = sorted(pairs, key=lambda pair: -pair[0].amplitude)[:_LINES]
    lines = [
        f"largest {len(largest)} of {len(pairs)} lines",
        f"{'Hz':>10}{'order':>9}{'m/s²':>11}  {'line':<24}made by, to first order",
    ]
    for line, causes in largest:
        made = "; ".join(causes[:2]) + ("; …" if len(causes) > 2 else "")
        lines.append(
            f"{line.frequency:10.5g}{line.order:9.4g}{line.amplitude:11.4g}"
            f"  {line.name:<24}{made or '-'}"
        )
    return "\n".join(lines)


def _states(run):
    states = run.heard.states
    told = ", ".join(
        f"{k}: {100.0 * share:.3g} %" for k, share in enumerate(states.shares) if share
    )
    kind = "balls" if is_ball(run.task.model.element.bearing) else "rollers"
    return (
        f"contacts of the {kind}, share of the time: {told};"
        f" {states.switches_per_turn:.4g} open or close per turn of the shaft"
    )


def _many(run):
    """Levels of random bearings, and what makes them."""
    many, task = run.many, run.task
    levels = np.asarray(many.levels.percentile(PERCENTILES))
    head = f"{task.bearings} random bearings, dB"
    lines = [head + "".join(f"{name:>9}" for name in DIRECTIONS)]
    for share, row in zip(PERCENTILES, levels, strict=True):
        name = f"{share:g} % are below"
        lines.append(f"{name:>{len(head)}}" + "".join(map(_level, row)))
    if many.shares is None:
        return "\n".join(lines)
    found = many.shares
    parts = sorted(zip(-parts_of(found), found.sources, strict=True))
    gains = dict(zip(found.sources, np.asarray(found.gain()), strict=True))
    for part, name in parts:
        words = name.replace("_", " ")
        number = f"{-100.0 * part:.3g} %"
        lines.append(
            f"  {words:<19}{number:>8} of the mean square; tightened to a half"
            f" {-gains[name]:.2g} dB"
        )
    lines.append("  the rest is of what all bearings have in common")
    return "\n".join(lines)

"""The noise of a bearing, as text."""

import numpy as np

from ...element.frame import DIRECTIONS
from ...noise import ring_modes
from ...noise.level import LOWEST_LEVEL
from ...noise.scatter import SOURCES
from ...numerics.units import rpm, shown_count
from ...report.report_model import Column, Grid, Part, Report, load_text
from ..bearing.credibility import credibility_section
from ..solve.report import bearing_text
from .output import PERCENTILES, parts_of
from .run import LARGEST_LINES, NoiseRun

_WORTH = 0.1
"""Part of a band above which its largest source is named [1]."""


def noise_report(run: NoiseRun) -> Report:
    """Return the readable report of the noise of a bearing.

    Args:
        run: From `run_noise`, converged.
    """
    model = run.task.model
    sections = {
        "Bearing and rig": [_bearing(run)],
        "Natural modes": [_modes(run)],
        "Levels": [_levels(run)],
        "Lines": _lines(run),
        "Envelope": [_own_envelope(run)],
        "Measured": [] if run.task.measured is None else _measured(run),
        "Contacts": [_states(run)],
        "Random bearings": [] if run.many is None else _random_bearings(run),
        "Credibility": credibility_section("noise", [("", model.element, model.load)]),
    }
    return Report(sections, run.warnings)


def _bearing(run):
    model = run.task.model
    bearing = model.element.bearing
    inner, outer = rpm(model.speed.inner), rpm(model.speed.outer)
    task, record = run.task, run.analysis.record
    turns, settle = task.vibration.turns, task.vibration.settle
    inertia = model.inertia
    tilts = "does not tilt"
    if inertia is not None:
        tilts = f"tilts, {float(inertia):.4g} kg m²"
        if model.tilting_inertia is None:
            tilts += " as of a ring of its mass"
    bridging = ""
    if model.half_width is not None:
        widths = ", ".join(f"{2e3 * float(b):.2g}" for b in model.half_width)
        bridging = f"; contacts average waves over {widths} mm"
    return "\n".join(
        [
            bearing_text(task.scene, bearing),
            f"the {model.moving_ring} ring moves, {float(model.mass):.4g} kg, and"
            f" {tilts}",
            f"loaded by {load_text(model.load) or 'nothing'}; inner ring {inner}, outer"
            f" ring {outer}",
            f"record of {shown_count(turns, 'turn')}, {float(record.duration):.4g}"
            f" s, after {settle} to settle; {len(record.time)} samples,"
            f" {shown_count(run.steps, 'step')} each{bridging}",
        ]
    )


def _modes(run):
    found = [
        f"{frequency:.5g} Hz {name.removeprefix('natural mode ')}"
        for name, frequency in ring_modes(run.modes, run.task.model)
    ]
    return "natural modes of the ring: " + ("; ".join(found) or "none")


def _levels(run):
    """Tabulate the level of every band and direction, with the limit if given."""
    analysis, task = run.analysis, run.task
    bands = [f"{centre:g} Hz" for centre in task.bands.centre]
    levels = np.vstack([analysis.level, analysis.band_level])
    columns = [Column("band", ["all", *bands]), *_by_direction(levels)]
    if analysis.measured_level is not None:
        columns.append(Column("measured", analysis.measured_level, "dB", ".1f"))
    if task.norm is not None:
        columns.append(Column("norm", [None, *task.norm], "dB", ".1f"))
    return Grid(columns, f"level over {task.reference:.3g} m/s²")


def _by_direction(levels):
    """Return a column of levels for each direction; blank for bands outside the record
    or without motion."""
    held = np.where(levels > LOWEST_LEVEL, levels, np.nan)
    return [
        Column(name, values, "dB", ".1f")
        for name, values in zip(DIRECTIONS, held.T, strict=True)
    ]


def _lines(run):
    """Tabulate the largest spectral lines with their names and causes."""
    pairs = list(zip(run.analysis.lines, run.analysis.causes, strict=True))
    if not pairs:
        return ["no line stands out of the spectrum"]
    largest = sorted(pairs, key=lambda pair: -pair[0].amplitude)[:LARGEST_LINES]
    total = np.sum(np.asarray(run.analysis.spectrum.power)[1:])
    part = sum(0.5 * line.amplitude**2 for line, _ in largest) / total
    lines = [line for line, _ in largest]
    made = ["; ".join(c[:2]) + ("; …" if len(c) > 2 else "") for _, c in largest]
    columns = [
        *_columns_of(lines),
        Column("made by, to first order", [words or "-" for words in made]),
    ]
    title = (
        f"largest {len(largest)} of {len(pairs)} lines, together {100.0 * part:.2g} %"
        " of the mean square in all directions"
    )
    return [Grid(columns, title)]


def _columns_of(lines, unit="m/s²"):
    return [
        Column("frequency", [line.frequency for line in lines], "Hz"),
        Column("order", [line.order for line in lines], "", ".4g"),
        Column("amplitude", [line.amplitude for line in lines], unit, ".4g"),
        Column("line", [line.name for line in lines]),
    ]


def _own_envelope(run):
    """Tabulate the calculated envelope, beside a measured record that along an axis."""
    measured, along = run.task.measured, ""
    if measured is not None and measured.samples is not None:
        known = run.task.model.sensor is not None
        along = f"along the {'sensor' if known else 'loudest axis'}, "
    return _envelope(run.analysis.envelope, along)


def _envelope(found, whose="", unit="m/s²"):
    """Tabulate the largest lines of an envelope."""
    words = "{}envelope of {:.5g} to {:.5g} Hz".format(whose, *found.band)
    lines = sorted(found.lines, key=lambda line: -line.amplitude)
    if not lines:
        return f"{words}: no line stands out"
    mean = f"{np.linalg.norm(found.spectrum.amplitude[0]):.4g} {unit}".strip()
    title = f"{words}, mean {mean}: largest lines"
    return Grid(_columns_of(lines[: LARGEST_LINES // 2], unit), title)


def _measured(run):
    """Say what the measured spectrum is of."""
    measured, found = run.task.measured, run.analysis.spectrum
    words = f"a spectrum of {len(measured.spectrum.frequency)} lines"
    if measured.rate:
        wide, own = (float(x.noise_bandwidth) for x in (measured.spectrum, found))
        words = f"a record at {measured.rate:.5g} Hz, of the same window and reference;"
        words += f" its lines are {wide:.3g} Hz wide, the calculated ones {own:.3g} Hz"
    if not measured.has_unit:
        words += "; without `full_scale` it has no unit: its largest line is drawn at"
        words += " the level of the largest calculated one"
    told: list[Part] = [f"{measured.name}: {words}"]
    if (there := run.analysis.measured_envelope) is not None:
        told.append(_envelope(there, "its ", "m/s²" if measured.has_unit else ""))
    elif measured.samples is not None:
        told.append("its rate is too low for the band of the envelope")
    return told


def _states(run):
    states = run.analysis.states
    text = ", ".join(
        f"{k} for {100.0 * share:.3g} %"
        for k, share in enumerate(states.shares)
        if share
    )
    kind = f"{run.task.model.element.bearing.noun}s"
    return (
        f"contacts of the {kind}: {text} of the time;"
        f" {states.switches_per_turn:.4g} open or close per turn of the shaft"
    )


def _random_bearings(run):
    """Report the levels of random bearings and their sources."""
    many, task = run.many, run.task
    levels = np.asarray(many.levels.percentile(PERCENTILES))
    names = [f"{share:g} % are below" for share in PERCENTILES]
    columns = [Column("level", names), *_by_direction(levels)]
    grid = Grid(columns, f"{task.bearings} random bearings")
    return [
        grid,
        *([] if many.contributions is None else _sources(task, many.contributions)),
    ]


def _sources(task, found):
    """Report the sources of noise of random bearings, and the gain of tightening."""
    sensor = task.line.sensor
    where = "in all directions"
    if sensor is not None:
        along = np.asarray(sensor.direction) / np.linalg.norm(sensor.direction)
        named = [
            k for k, d in enumerate(np.eye(len(DIRECTIONS))) if np.allclose(d, along)
        ]
        text = DIRECTIONS[named[0]] if named else ", ".join(f"{a:.3g}" for a in along)
        where = f"along the sensor ({text})"
    total = float(found.mean_square)
    parts, errors = parts_of(found), np.asarray(found.error) / total
    gains, factors = np.asarray(found.gain()), dict(task.tighter)
    order = np.argsort(-parts)
    # Within twice its standard error, or of a single bearing, it may be zero.
    doubt = ~(parts > 2.0 * errors)
    spread = [f" ± {100.0 * e:.2g}" if np.isfinite(e) else "" for e in errors]
    columns = [
        Column("source", [SOURCES[found.sources[k]] for k in order]),
        Column("part", [f"{100.0 * parts[k]:.3g}{spread[k]} %" for k in order]),
        Column("halved", np.where(doubt, np.nan, -gains)[order], "dB", ".2g"),
    ]
    yield Grid(columns, f"what makes the noise {where}, of {found.used} bearings")
    yield "the rest is what all bearings of the scene have: load, `waves`, `spalls`"
    if doubt.any():
        yield "no gain is given (-) where the part may be chance: take more bearings"
    for name, ratio in factors.items():
        much = ", ".join(f"{SOURCES[k]} x {v:.2g}" for k, v in ratio.items())
        yield f"{name}: {-float(found.gain_together(ratio)):.2g} dB ({much})"
    yield from _in_bands(task, found)


def _in_bands(task, found):
    """Tabulate the largest source of each band."""
    parts = np.asarray(found.by_band)
    largest = []
    for centre, column in zip(task.bands.centre, parts.T, strict=True):
        if np.isfinite(column).all() and column.max() > _WORTH:
            k = int(np.argmax(column))
            largest.append((f"{centre:g}", SOURCES[found.sources[k]], column[k]))
    by_source: dict[str, list[str]] = {}
    for centre, name, part in largest:
        by_source.setdefault(name, []).append(f"{centre} ({100.0 * part:.0f} %)")
    for name, bands in by_source.items():
        yield f"{name}, the largest part of the bands, Hz: {', '.join(bands)}"

"""Output of the noise of a bearing: JSON, tables and sound, in SI."""

from pathlib import Path
from typing import Any

import numpy as np

from ...element.frame import DIRECTIONS
from ...noise import SourceContributions, write_sound
from ...noise.natural import LOOSE
from ...report.json_output import run_json
from .read_tolerance import Tighter
from .run import Envelope, NoiseRun, RandomBearings


def noise_as_dict(run: NoiseRun) -> dict[str, Any]:
    """Return a run as plain numbers and lists, in SI; frequencies in Hz, levels in dB.

    Returns:
        `natural_frequency` (mode,) of the modes restrained by contacts or sensor, with
        the `ring_share` of their kinetic energy; `direction`, the names along that
        axis; `time`, `acceleration` (time, direction) and `displacement` of the
        moving ring; `level` (direction,); `bands`: `centre` [Hz], `level` (band,
        direction), null where the record does not cover the band; `lines`: each with
        `order`, `frequency`, `amplitude`, `name`, and `causes`, the form errors that
        excite it to first order; `contact_states`: `contacts` (0, 1, 2, …), `samples`
        with that many, of all elements together, `switches_per_turn`; `reference`;
        `envelope`: `band` [Hz], `mean` of the envelope and its `lines`, without causes.
        Of a measured record `measured`: `envelope` likewise, in its unit, and
        in m/s² `level` and `band_level` [dB]; beside it `envelope` is along the sensor.
        Of random bearings `monte_carlo`: `level` (bearing, direction), `band_level`
        (bearing, band, direction), null of unsolved ones; `percentile`: `share` [%]
        and `level` (share, direction); `sources` of the scatter with the `part` of the
        mean square of the acceleration along the sensor (without one in all
        directions) that vanishes without each, its standard `part_error`, and
        `part_by_band` (source, band) [1]; `tighter`: the next better grade and class
        with their `gain` [dB].
        Also result, message, warnings, inputs (the file can be read as a scene) and
        version. Unsolved parts are left out.
    """
    parts: dict[str, Any] = {}
    if run.modes is not None and run.converged:
        there = run.modes.frequency > LOOSE
        parts["natural_frequency"] = run.modes.frequency[there]
        parts["ring_share"] = run.modes.ring_share[there]
    if run.analysis is not None:
        parts |= _analysis(run)
    if run.many is not None:
        parts["monte_carlo"] = _random_bearings(run.many, run.task.tighter)
    parts |= {"result": run.result.label, "message": run.message}
    return run_json(parts, run.warnings, run.task.inputs)


def _analysis(run: NoiseRun) -> dict[str, Any]:
    analysis = run.analysis
    assert analysis is not None  # checked by the caller
    states, levels = analysis.states, analysis.measured_level
    measured: dict[str, Any] = {}
    if analysis.measured_envelope is not None:
        measured["envelope"] = _envelope(analysis.measured_envelope)
    if levels is not None:
        measured |= {"level": levels[0], "band_level": levels[1:]}
    return {
        "direction": DIRECTIONS,
        "time": analysis.record.time,
        "acceleration": analysis.acceleration,
        "displacement": np.asarray(analysis.record.displacement)[:, : len(DIRECTIONS)],
        "level": analysis.level,
        "bands": {"centre": run.task.bands.centre, "level": analysis.band_level},
        "lines": [
            {**line._asdict(), "causes": causes}
            for line, causes in zip(analysis.lines, analysis.causes, strict=True)
        ],
        "contact_states": {
            "contacts": list(range(len(states.samples))),
            "samples": states.samples,
            "switches_per_turn": states.switches_per_turn,
        },
        "reference": run.task.reference,
        "envelope": _envelope(analysis.envelope),
        **({"measured": measured} if measured else {}),
    }


def _envelope(found: Envelope) -> dict[str, Any]:
    return {
        "band": found.band,
        "mean": np.linalg.norm(found.spectrum.amplitude[0]),
        "lines": [line._asdict() for line in found.lines],
    }


PERCENTILES = (5.0, 50.0, 95.0)
"""Percentiles of the levels of random bearings that are reported [%]."""


def _random_bearings(many: RandomBearings, tighter: Tighter) -> dict[str, Any]:
    levels = many.levels
    numbers: dict[str, Any] = {
        "level": levels.level,
        "band_level": levels.bands,
        "percentile": {
            "share": PERCENTILES,
            "level": levels.percentile(PERCENTILES),
        },
    }
    if (found := many.contributions) is not None:
        numbers |= {
            "sources": found.sources,
            "part": parts_of(found),
            "part_error": np.asarray(found.error) / float(found.mean_square),
            "part_by_band": found.by_band,
            "tighter": [
                {"name": name, "gain": found.gain_together(ratio)}
                for name, ratio in tighter
            ],
        }
    return numbers


def parts_of(found: SourceContributions) -> np.ndarray:
    """Return the part of the mean square lost without each source (source,) [1]."""
    return np.asarray(found.share) / float(found.mean_square)


def noise_columns(run: NoiseRun) -> dict[str, np.ndarray]:
    """Return a record as columns by header, "name [unit]": a row for each time.

    Args:
        run: From `run_noise`, converged.
    """
    analysis = run.analysis
    assert analysis is not None  # callers have solved it
    columns = {"time [s]": np.asarray(analysis.record.time)}
    for name, unit, values in (
        ("acceleration", "m/s²", analysis.acceleration),
        ("displacement", "m", np.asarray(analysis.record.displacement)),
    ):
        for k, direction in enumerate(DIRECTIONS):
            columns[f"{name}_{direction} [{unit}]"] = values[:, k]
    return columns


def write_noise_sound(path: str | Path, run: NoiseRun) -> float:
    """Write the acceleration along `NoiseRun.direction` as sound.

    Args:
        path: Path of the WAV file.
        run: From `run_noise`, converged.

    Returns:
        The acceleration at full scale [m/s²].

    Raises:
        OSError: If the file cannot be written.
    """
    assert run.analysis is not None
    along = run.analysis.acceleration @ run.direction
    return write_sound(path, along, float(run.analysis.record.duration))

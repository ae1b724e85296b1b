"""Compute the noise of the bearing of a scene."""

import contextlib
import dataclasses
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float

from ...design import rows_of
from ...element.frame import DIRECTIONS
from ...noise import (
    ContactStates,
    ContributionOptions,
    LevelOptions,
    Line,
    MonteCarlo,
    NameRule,
    NaturalModes,
    PeakRule,
    RecordOptions,
    SourceContributions,
    Spectrum,
    Vibration,
    band_levels,
    contact_states,
    contribution_warnings,
    envelope_spectrum,
    level,
    line_causes,
    model_warnings,
    monte_carlo,
    name_lines,
    natural_modes,
    record_warnings,
    ring_modes,
    source_contributions,
    spectrum,
    total_root_mean_square,
    vibration,
    with_bridged_waves,
)
from ...noise.static_start import describe_failure
from ...noise.vibration import rounding
from ...numerics import Result, Warning
from ...numerics.labels import labelled_fields, make_dataset
from ...numerics.shown import Shown
from ...numerics.types import in_numpy
from .read import NoiseScene

LARGEST_LINES = 12
"""Number of largest spectral lines reported regardless of their neighbours."""
_KEPT = 64
"""Most random bearings whose records are kept for the sources of noise, not made anew:
50 MB of 16 turns with 2048 samples."""
_TOO_LONG = "its steps are too long for the contacts under their largest load"


class Envelope(NamedTuple):
    """Spectrum of the envelope of an acceleration in a band.

    Attributes:
        band: Lower and upper frequency of the band [Hz].
        spectrum: Amplitudes (line, ...) [m/s²].
        lines: Its prominent lines, up to the order of names.
    """

    band: tuple[float, float]
    spectrum: Spectrum
    lines: tuple[Line, ...]


@dataclasses.dataclass(frozen=True)
class NoiseAnalysis:
    """Evaluation of a record.

    Attributes:
        record: The vibration.
        spectrum: Spectrum of the acceleration, amplitudes (line, direction) [m/s²].
        level: Level of the acceleration about its mean, from the spectrum like the
            bands (direction,) [dB].
        band_level: (band, direction) [dB]; NaN for bands outside the record.
        lines: Prominent spectral lines.
        causes: Possible causes of each line.
        states: Contact states of the rolling elements.
        envelope: Envelope of the acceleration (line, direction); beside a measured
            record that along the sensor, as `NoiseRun.direction` (line,).
        measured_level: Level of a measured record in m/s², then of each band of it
            (1 + band,) [dB]; `None` without one.
        measured_envelope: Envelope of a measured record, in the record's unit and in
            what its rate leaves of the band; `None` without a record.
    """

    record: Vibration
    spectrum: Spectrum
    level: Float[np.ndarray, " direction"]
    band_level: Float[np.ndarray, "band direction"]
    lines: tuple[Line, ...]
    causes: tuple[tuple[str, ...], ...]
    states: ContactStates
    envelope: Envelope
    measured_level: Float[np.ndarray, " level"] | None
    measured_envelope: Envelope | None = None

    @property
    def acceleration(self) -> np.ndarray:
        """Acceleration of the moving ring (time, direction) [m/s²]."""
        return np.asarray(self.record.acceleration)[:, : len(DIRECTIONS)]


@dataclasses.dataclass(frozen=True)
class RandomBearings:
    """Evaluation of many random bearings.

    Attributes:
        levels: Levels of each bearing.
        contributions: Share of each source of scatter in the mean square, from a subset
            of the bearings; `None` if none of these was solved.
    """

    levels: MonteCarlo
    contributions: SourceContributions | None


@dataclasses.dataclass(frozen=True)
class NoiseRun(Shown):
    """Result of a noise run.

    Attributes:
        task: The noise scene.
        result: The worst result code.
        message: Cause and remedy in words.
        modes: Natural modes, in NumPy; `None` without an equilibrium.
        steps: Integration steps per sample.
        analysis: Evaluation of the record; `None` if it was not solved.
        many: Evaluation of random bearings; `None` if none were requested.
        warnings: Warnings of doubtful results.
    """

    task: NoiseScene = dataclasses.field(repr=False)
    result: Result
    message: str
    modes: NaturalModes | None = None
    steps: int = 0
    analysis: NoiseAnalysis | None = None
    many: RandomBearings | None = None
    warnings: tuple[Warning, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether all parts were solved."""
        return self.result is Result.CONVERGED

    @property
    def direction(self) -> np.ndarray:
        """Unit vector of the measurement: of the sensor, or the loudest axis."""
        assert self.analysis is not None
        return _direction(self.task, self.analysis.level)

    @property
    def heard(self) -> Spectrum:
        """Spectrum of the acceleration along `direction` (line,) [m/s²]."""
        assert self.analysis is not None
        found = self.analysis.spectrum
        along = found.amplitude @ self.direction
        return eqx.tree_at(lambda one: one.amplitude, found, along)

    def to_xarray(self) -> Any:
        """Return spectrum and levels of the record and the natural modes, with "mode"
        before their names, as an `xarray.Dataset`.

        Raises:
            ImportError: Without xarray.
        """
        arrays = {} if self.modes is None else labelled_fields(self.modes)
        arrays = {f"mode_{name}": array for name, array in arrays.items()}
        if self.analysis is not None:
            arrays |= labelled_fields(self.analysis, "spectrum")
        return make_dataset(arrays)


def run_noise(
    task: NoiseScene, on_stage: Callable[..., None] | None = None
) -> NoiseRun:
    """Simulate and evaluate the vibration of the bearing of a scene.

    Args:
        task: From `read_noise`.
        on_stage: Called with the name of each stage as it begins, and for random
            bearings after each batch, with the share done [1].

    Returns:
        The run with its result code; a failed solve does not raise.
    """
    model, line = task.model, task.line
    _announce(on_stage, "natural modes")
    modes = jax.device_get(natural_modes(model))
    result = Result(int(modes.result))
    if result is not Result.CONVERGED:
        words = f"standing under the load: {describe_failure(model)}"
        return NoiseRun(task, result, words, warnings=task.warnings)
    if task.vibration.bridging:
        width = with_bridged_waves(model).half_width
        model, line = (
            dataclasses.replace(one, half_width=width) for one in (model, line)
        )
    # JAX would compile every operation on what it holds, in each process anew.
    model, line = in_numpy((model, line))
    task = dataclasses.replace(task, model=model, line=line)
    tolerances = task.tolerances if task.bearings else None
    _announce(on_stage, "vibration")
    motion = vibration(model, **task.counts, steps=task.vibration.steps, throw=False)
    record = in_numpy(motion)
    result, steps = Result(int(record.result)), record.steps
    asked = model_warnings(model, task.vibration.samples, steps, tolerances)
    warned = (*task.warnings, *asked)
    if result is not Result.CONVERGED:
        grew = result is Result.NON_FINITE
        words = (
            f"vibration: {'the motion grew beyond all numbers' if grew else _TOO_LONG};"
            " leave out `vibration.steps`, or give more of them, or another"
            " `vibration.retardation`"
        )
        return NoiseRun(task, result, words, modes, steps, warnings=warned)
    analysis = analyse(task, record, modes)
    doubtful = record_warnings(model, record, analysis.spectrum, task.bands, tolerances)
    warned += tuple(doubtful)
    many = _run_random(task, steps, on_stage) if task.bearings else None
    if many is not None and many.levels.n_failed:
        failed = many.levels.n_failed
        words = f"{failed} of {task.bearings} random bearings were not solved"
        warned += (Warning("unsolved_bearings", words, failed, 0),)
    if many is not None and many.contributions is not None:
        warned += tuple(contribution_warnings(many.contributions))
    return NoiseRun(task, result, "converged", modes, steps, analysis, many, warned)


def band_within(band: tuple[float, float], rate: float) -> tuple[float, float]:
    """Return what a record holds of a band [Hz].

    Args:
        band: Lower and upper frequency of the band [Hz].
        rate: Samples of the record per second, of which half can be told [Hz].
    """
    return band[0], min(band[1], 0.5 * rate)


def _direction(task: NoiseScene, levels: np.ndarray) -> np.ndarray:
    sensor = task.model.sensor
    if sensor is None:
        return np.eye(len(DIRECTIONS))[int(np.argmax(levels))]
    direction = np.asarray(sensor.direction)
    return direction / np.linalg.norm(direction)


def _announce(on_stage, stage, *share):
    if on_stage is not None:
        on_stage(stage, *share)


def _run_random(task: NoiseScene, steps: int, on_stage) -> RandomBearings:
    """Evaluate random bearings, and on a subset the share of each scatter source."""
    tolerances = task.tolerances
    assert tolerances is not None  # checked when it was read
    given = task.line, tolerances
    key = jax.random.key(task.seed)
    batch = min(16, task.bearings)
    records = RecordOptions(**task.counts, steps=steps, batch=batch)
    # Each source is switched off once: this takes about as long as the levels.
    fewer = max(-(-task.bearings // len(tolerances.sources)), batch)
    unchanged = [] if fewer <= _KEPT else None
    runs = len(tolerances.sources) + (unchanged is None)
    whole = task.bearings + fewer * runs

    def keep(acceleration, result):
        if unchanged is not None and batch * len(unchanged) < fewer:
            unchanged.append((acceleration, result))

    def progress(before):
        def tell(done, _):
            _announce(on_stage, "random bearings", (before + done) / whole)

        return tell

    _announce(on_stage, "random bearings", 0.0)
    levels = monte_carlo(
        *given,
        task.bearings,
        key,
        records=records,
        levels=LevelOptions(task.bands, task.window, task.reference),
        on_records=keep,
        progress=progress(0),
    )
    sensor = task.line.sensor
    along = None if sensor is None else np.asarray(sensor.direction)
    with contextlib.suppress(FloatingPointError):
        made = source_contributions(
            *given,
            fewer,
            levels.keys[:fewer],
            records=records,
            options=ContributionOptions(along, task.bands, gradient=False),
            unchanged=unchanged,
            progress=progress(task.bearings),
        )
        return RandomBearings(levels, made)
    return RandomBearings(levels, None)


def analyse(task: NoiseScene, record: Vibration, modes: NaturalModes) -> NoiseAnalysis:
    """Evaluation of a record.

    Args:
        task: The noise scene.
        record: The vibration.
        modes: Natural modes, in NumPy.
    """
    acceleration = np.asarray(record.acceleration)[:, : len(DIRECTIONS)]
    shaft = float(record.shaft_frequency)
    given = acceleration, float(record.duration), shaft
    found = in_numpy(spectrum(*given, window=task.window))
    bearing = task.model.element.bearing
    speed = task.model.speed
    # Unequal rolling elements excite many harmonics of the cage rotation.
    largest = max(row.bearing.n_elements for row in rows_of(bearing))
    harmonics = max(10, 6 * largest)
    names = NameRule(harmonics)
    peaks = PeakRule(floor=rounding(task.model, record), largest=LARGEST_LINES)
    rules: Any = {"names": names, "peaks": peaks}
    natural = dict(ring_modes(modes, task.model))
    lines = name_lines(found, bearing, speed, natural=natural, **rules)
    causes = line_causes(lines, task.model, 0.5 * float(found.resolution))
    highest = float(record.bandwidth)
    of_bands = band_levels(found, task.bands, task.reference, highest)
    loud = np.asarray(level(total_root_mean_square(found), task.reference))

    def envelope_of(signal, duration, band):
        band = band_within(band, len(signal) / duration)
        made = envelope_spectrum(signal, duration, shaft, band, window=task.window)
        named = name_lines(in_numpy(made), bearing, speed, **rules)
        near = tuple(line for line in named if line.order <= harmonics)
        return Envelope(band, in_numpy(made), near)

    band, known, levels, there = task.envelope_band(highest), task.measured, None, None
    if known is not None and known.samples is not None:
        acceleration = acceleration @ _direction(task, loud)
        if band[0] < 0.5 * known.rate:
            there = envelope_of(known.samples, len(known.samples) / known.rate, band)
    if known is not None and known.rate and known.has_unit:
        total = level(total_root_mean_square(known.spectrum), task.reference)
        bands = band_levels(known.spectrum, task.bands, task.reference)
        levels = np.append(total, bands)
    return NoiseAnalysis(
        record=record,
        spectrum=found,
        level=loud,
        band_level=np.asarray(of_bands),
        lines=lines,
        causes=causes,
        states=contact_states(record),
        envelope=envelope_of(acceleration, given[1], band),
        measured_level=levels,
        measured_envelope=there,
    )

"""Running what a scene asks for of the noise of a bearing."""

import contextlib
import dataclasses
from collections.abc import Callable

import jax
import numpy as np

from ..design import rows_of
from ..noise import (
    ContactStates,
    Line,
    MonteCarlo,
    NaturalModes,
    Shares,
    Spectrum,
    Vibration,
    band_levels,
    bridged,
    contact_states,
    level,
    line_causes,
    model_warnings,
    monte_carlo,
    name_lines,
    natural_modes,
    record_warnings,
    ring_modes,
    rounding,
    share_warnings,
    shares,
    spectrum,
    total_root_mean_square,
    vibration,
)
from ..noise.standing import why
from ..numerics.result import Result
from .noise_scene import DIRECTIONS, NoiseScene

LARGEST_LINES = 12
"""Lines that are told for their size, whatever is beside them."""
_TOO_LONG = "its steps are too long for the contacts under their largest load"


@dataclasses.dataclass(frozen=True)
class Heard:
    """What a record tells.

    Attributes:
        record: The vibration.
        spectrum: Of the acceleration, amplitudes (line, direction) [m/s²].
        level: Of the acceleration about its mean, by the spectrum as the bands
            (direction,) [dB].
        band_level: (band, direction) [dB]; NaN for bands that the record does not hold.
        lines: Those that stand out.
        causes: What may make each of them.
        states: Contacts of the elements.
    """

    record: Vibration
    spectrum: Spectrum
    level: np.ndarray
    band_level: np.ndarray
    lines: tuple[Line, ...]
    causes: tuple[tuple[str, ...], ...]
    states: ContactStates

    @property
    def acceleration(self) -> np.ndarray:
        """Of the moving ring (time, direction) [m/s²]."""
        return np.asarray(self.record.acceleration)[:, : len(DIRECTIONS)]


@dataclasses.dataclass(frozen=True)
class Many:
    """What many random bearings tell.

    Attributes:
        levels: Of each.
        shares: Which source of scatter makes how much of the mean square, of a part
            of them; `None` if none of these was solved.
    """

    levels: MonteCarlo
    shares: Shares | None


@dataclasses.dataclass(frozen=True)
class NoiseRun:
    """What came of a scene of the noise of a bearing.

    Attributes:
        task: What was asked.
        result: The worst result code.
        message: Cause and cure in words.
        modes: Natural modes, as NumPy holds them; `None` without a place to stand.
        steps: Steps of the integration per sample.
        heard: What the record tells; `None` if it was not solved.
        many: Random bearings beside it; `None` if none were wanted.
        warnings: What is doubtful.
    """

    task: NoiseScene
    result: Result
    message: str
    modes: NaturalModes | None = None
    steps: int = 0
    heard: Heard | None = None
    many: Many | None = None
    warnings: tuple[str, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether all was solved."""
        return self.result is Result.CONVERGED


def run_noise(task: NoiseScene, told: Callable[[str], None] | None = None) -> NoiseRun:
    """The vibration of the bearing of a scene, and what it tells.

    Args:
        task: From `read_noise`.
        told: Called with the name of each stage as it begins.

    Returns:
        The run with its result code; nothing is raised for what was not solved.
    """
    model = task.model
    _tell(told, "natural modes")
    modes = jax.device_get(natural_modes(model))
    result = Result(int(modes.result))
    if result is not Result.CONVERGED:
        words = f"standing under the load: {why(model)}"
        return NoiseRun(task, result, words, warnings=task.warnings)
    if task.bridging:
        width = bridged(model).half_width
        models = (
            dataclasses.replace(one, half_width=width) for one in (model, task.line)
        )
        model, line = models
        task = dataclasses.replace(task, model=model, line=line)
    tolerances = task.tolerances if task.bearings else None
    _tell(told, "vibration")
    record = vibration(
        model,
        turns=task.turns,
        settle=task.settle,
        samples=task.samples,
        steps=task.steps,
        throw=False,
    )
    result, steps = Result(int(record.result)), record.steps
    asked = model_warnings(model, task.samples, steps, tolerances)
    told_so_far = (*task.warnings, *asked)
    if result is not Result.CONVERGED:
        grew = result is Result.NON_FINITE
        words = (
            f"vibration: {'the motion grew beyond all numbers' if grew else _TOO_LONG};"
            " leave out `vibration.steps`, or give more of them, or another"
            " `vibration.retardation`"
        )
        return NoiseRun(task, result, words, modes, steps, warnings=told_so_far)
    heard = listen(task, record, modes)
    doubtful = record_warnings(model, record, heard.spectrum, task.bands, tolerances)
    told_so_far += tuple(doubtful)
    many = _many(task, steps, told) if task.bearings else None
    if many is not None and many.levels.failed:
        told_so_far += (
            f"{many.levels.failed} of {task.bearings} random bearings were not solved",
        )
    if many is not None and many.shares is not None:
        told_so_far += tuple(share_warnings(many.shares))
    return NoiseRun(task, result, "converged", modes, steps, heard, many, told_so_far)


def _tell(told, stage):
    if told is not None:
        told(stage)


def _many(task: NoiseScene, steps: int, told) -> Many:
    """Random bearings, and on fewer of them what each source of scatter makes."""
    tolerances = task.tolerances
    assert tolerances is not None  # checked when it was read
    counts = {
        "turns": task.turns,
        "settle": task.settle,
        "samples": task.samples,
        "steps": steps,
    }
    given = task.line, tolerances
    key = jax.random.key(task.seed)

    def progress(words):
        return lambda done, whole: _tell(told, f"{words}: {done} of {whole}")

    levels = monte_carlo(
        *given,
        task.bearings,
        key,
        **counts,
        bands=task.bands,
        window=task.window,
        reference=task.reference,
        progress=progress("random bearings"),
    )
    # Each source is switched off once: about as long as the levels took.
    fewer = -(-task.bearings // len(tolerances.sources))
    batch = min(16, task.bearings)
    sensor = task.line.sensor
    along = None if sensor is None else np.asarray(sensor.direction)
    with contextlib.suppress(FloatingPointError):
        made = shares(
            *given,
            max(fewer, batch),
            key,
            **counts,
            direction=along,
            bands=task.bands,
            gradient=False,
            batch=batch,
            progress=progress("sources of noise"),
        )
        return Many(levels, made)
    return Many(levels, None)


def listen(task: NoiseScene, record: Vibration, modes: NaturalModes) -> Heard:
    """What a record tells.

    Args:
        task: What was asked.
        record: The vibration.
        modes: As NumPy holds them.
    """
    acceleration = np.asarray(record.acceleration)[:, : len(DIRECTIONS)]
    shaft = float(record.shaft_frequency)
    found = spectrum(acceleration, float(record.duration), shaft, window=task.window)
    bearing = task.model.element.bearing
    speed = task.model.speed
    # Elements that differ make many multiples of the cage's turning.
    largest = max(row.bearing.n_elements for row in rows_of(bearing))
    harmonics = max(10, 6 * largest)
    natural = dict(ring_modes(modes, task.model))
    lines = name_lines(
        found,
        bearing,
        speed,
        natural=natural,
        harmonics=harmonics,
        floor=rounding(task.model, record),
        largest=LARGEST_LINES,
    )
    causes = line_causes(lines, task.model, 0.5 * float(found.resolution))
    highest = float(record.bandwidth)
    of_bands = band_levels(found, task.bands, task.reference, highest)
    return Heard(
        record=record,
        spectrum=found,
        level=np.asarray(level(total_root_mean_square(found), task.reference)),
        band_level=np.asarray(of_bands),
        lines=lines,
        causes=causes,
        states=contact_states(record),
    )

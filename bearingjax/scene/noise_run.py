"""Running what a scene asks for of the noise of a bearing."""

import contextlib
import dataclasses
from collections.abc import Callable

import jax
import numpy as np

from ..acoustics import (
    ContactStates,
    Line,
    MonteCarlo,
    NaturalModes,
    NoiseModel,
    Shares,
    Spectrum,
    Vibration,
    band_levels,
    bandwidth,
    contact_half_width,
    contact_states,
    is_held,
    kinematic_frequencies,
    level,
    line_causes,
    monte_carlo,
    name_lines,
    natural_modes,
    needed_steps,
    shares,
    spectrum,
    total_root_mean_square,
    vibration,
)
from ..acoustics.free_row import of_rows
from ..design import n_elements, rows_of
from ..design.form_error import Harmonics, Surfaces
from ..numerics.result import Result
from ..statics import solve_load
from ..statics.solution import message
from .noise_scene import DIRECTIONS, NoiseScene

LARGEST_LINES = 12
"""Lines that are told for their size, whatever is beside them."""
LOOSE = 1.0
"""Frequency below which a mode is that of an element that nothing holds [Hz]."""
_RING = 0.5
"""Share of the ring in the motion from which a mode is called its own [1]."""
_TOO_LONG = "its steps are too long for the contacts under their largest load"
_UNEVEN = 3.0
"""Difference of both halves of a record that is worth a word [dB]."""


@dataclasses.dataclass(frozen=True)
class Heard:
    """What a record tells.

    Attributes:
        record: The vibration.
        spectrum: Of the acceleration, amplitudes (line, direction) [m/s²].
        level: Of the acceleration about its mean, by the spectrum as the bands
            (direction,) [dB].
        band_level: (band, direction) [dB]; NaN for bands that the record does not hold.
        held: Bands that it holds (band,).
        lines: Those that stand out.
        causes: What may make each of them.
        states: Contacts of the elements.
    """

    record: Vibration
    spectrum: Spectrum
    level: np.ndarray
    band_level: np.ndarray
    held: np.ndarray
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
        words = f"standing under the load: {_why(model)}"
        return NoiseRun(task, result, words, warnings=task.warnings)
    least = needed_steps(model, task.samples)
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
    told_so_far = (*task.warnings, *_before(task, modes, steps, least))
    if result is not Result.CONVERGED:
        grew = result is Result.NON_FINITE
        words = (
            f"vibration: {'the motion grew beyond all numbers' if grew else _TOO_LONG};"
            " leave out `vibration.steps`, or give more of them, or another"
            " `vibration.retardation`"
        )
        return NoiseRun(task, result, words, modes, steps, warnings=told_so_far)
    heard = listen(task, record, modes)
    told_so_far += tuple(_after(task, heard))
    many = _many(task, steps, told) if task.bearings else None
    if many is not None and many.levels.failed:
        told_so_far += (
            f"{many.levels.failed} of {task.bearings} random bearings were not solved",
        )
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


def _why(model: NoiseModel) -> str:
    """Why a bearing finds no place under its load."""
    options = model.solve_options
    solution = solve_load(
        model.small,
        model.load,
        free=options.free,
        fixed_ring=options.fixed_ring,
        throw=False,
    )
    return message(solution, model.moving_ring)


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
    largest = max(n_elements(row.bearing) for row in rows_of(bearing))
    harmonics = max(10, 6 * largest)
    natural = dict(ring_modes(modes, task.model))
    lines = name_lines(
        found,
        bearing,
        speed,
        natural=natural,
        harmonics=harmonics,
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
        held=is_held(found, task.bands, highest),
        lines=lines,
        causes=causes,
        states=contact_states(record),
    )


def ring_modes(modes: NaturalModes, model: NoiseModel) -> list[tuple[str, float]]:
    """Name and frequency [Hz] of the modes in which the moving ring moves most.

    Args:
        modes: As NumPy holds them.
        model: The bearing.
    """
    masses = np.repeat(float(model.mass), len(DIRECTIONS))
    names = [f"along {name}" for name in DIRECTIONS]
    if model.tilting_inertia is not None:
        tilting = np.repeat(float(model.tilting_inertia), 2)
        masses = np.concatenate([masses, tilting])
        names += ["tilting about x", "tilting about y"]
    found: list[tuple[str, float]] = []
    for frequency, ring, share in zip(
        modes.frequency, modes.ring, modes.ring_share, strict=True
    ):
        if share < _RING or frequency < LOOSE:
            continue
        name = f"natural mode {names[int(np.argmax(masses * ring**2))]}"
        same = sum(one.startswith(name) for one, _ in found)
        found.append((f"{name} ({same + 1})" if same else name, float(frequency)))
    return found


def _before(task: NoiseScene, modes: NaturalModes, steps: int, least: int):
    """What is doubtful in what is asked."""
    if steps < least:
        yield (
            f"{steps} steps per sample are less than the {least} that the fastest"
            " natural mode needs"
        )
    model = task.model
    shaft = float(model.shaft_speed) / (2.0 * np.pi)
    told = bandwidth(task.samples, shaft)
    cut = (
        f"above {told:.5g} Hz, up to which {task.samples} samples per turn tell the"
        " vibration; raise `vibration.samples` to hear what they make there"
    )
    for name, frequency in ring_modes(modes, model):
        if frequency > told:
            yield f"the {name} at {frequency:.5g} Hz lies {cut}"
    for where, bearing, errors in _of_rows(model):
        turning = kinematic_frequencies(bearing, model.speed)
        drawn = _highest_drawn(task)
        passing = {
            "outer raceway": (errors.outer, abs(float(turning.cage - turning.outer))),
            "inner raceway": (errors.inner, abs(float(turning.inner - turning.cage))),
            "elements": (errors.elements, float(turning.rotation)),
        }
        for part, (given, passes) in passing.items():
            highest = max(_highest(given), drawn[part])
            if highest * passes > told:
                yield (
                    f"waves of order {highest} of the {part}{where} are met at"
                    f" {highest * passes:.5g} Hz, {cut}"
                )


def _highest_drawn(task: NoiseScene) -> dict[str, int]:
    """Highest order of waves that random bearings have, by part."""
    found: dict[str, int] = {
        k: 0 for k in ("outer raceway", "inner raceway", "elements")
    }
    if task.tolerances is None or not task.bearings:
        return found
    for name, part in (
        ("outer_axial", "outer raceway"),
        ("outer_outwards", "outer raceway"),
        ("inner_axial", "inner raceway"),
        ("inner_outwards", "inner raceway"),
        ("elements", "elements"),
    ):
        waves = getattr(task.tolerances, name)
        if waves is not None:
            found[part] = max(found[part], waves.high)
    return found


def _of_rows(model: NoiseModel):
    """Words for each row, its design and its form errors."""
    parts = rows_of(model.element.bearing)
    for k, (row, errors) in enumerate(zip(parts, model.errors_of_rows, strict=True)):
        yield "" if len(parts) == 1 else f" of row {k}", row.bearing, errors


def _short_waves(task: NoiseScene, load: np.ndarray):
    """Waves that contacts bridge, but that elements of the model follow."""
    model, drawn = task.model, _highest_drawn(task)
    loads = of_rows(load, model.element.bearing, axis=1)
    for own, (where, bearing, errors) in zip(loads, _of_rows(model), strict=True):
        half = contact_half_width(bearing, own)
        surfaces = Surfaces.of(bearing)
        parts = {
            "outer raceway": (errors.outer, surfaces.outer),
            "inner raceway": (errors.inner, surfaces.inner),
            "elements": (errors.elements, surfaces.element),
        }
        for part, (given, surface) in parts.items():
            highest = max(_highest(given), drawn[part])
            most = int(float(surface.radius) / half) if half > 0.0 else highest
            if highest > most:
                yield (
                    f"waves of the {part}{where} of order {most} and more are shorter"
                    f" than some three contacts of {2e3 * half:.2g} mm, which would"
                    " bridge them: their noise is overstated, by 10 % at that order and"
                    " ever more above"
                )


def _highest(errors) -> int:
    """Highest order of waves."""
    shapes = jax.tree.leaves(errors, is_leaf=lambda x: isinstance(x, Harmonics))
    orders = [max(one.order) for one in shapes if isinstance(one, Harmonics)]
    return max(orders, default=0)


def _after(task: NoiseScene, heard: Heard):
    """What is doubtful in the results."""
    centre, held = task.bands.centre, heard.held
    duration = f"the record of {float(heard.record.duration):.4g} s"
    low, high = (~held).cumprod().sum(), (~held)[::-1].cumprod().sum()
    if low:
        yield (
            f"{duration} is too short for the bands up to {centre[low - 1]:g} Hz;"
            " raise `vibration.turns`"
        )
    if high and high < len(held):
        yield (
            f"{duration} has too few samples for the bands from {centre[-high]:g} Hz"
            " on; raise `vibration.samples`"
        )
    yield from _short_waves(task, np.asarray(heard.record.contact_load))
    half = len(heard.acceleration) // 2
    first, second = (
        np.sqrt(np.sum(part.var(axis=0)))
        for part in (heard.acceleration[:half], heard.acceleration[half:])
    )
    away = 20.0 * np.log10(first / second) if first > 0 and second > 0 else 0.0
    if abs(away) > _UNEVEN:
        yield (
            f"the first half of the record is {abs(away):.3g} dB"
            f" {'louder' if away > 0 else 'quieter'} than the second: raise"
            " `vibration.settle`, or `vibration.turns` until all beats are in it"
        )
    lost = heard.states.shares[0]
    if lost > 0:
        yield (
            f"rolling elements are out of contact for {100.0 * lost:.3g} % of the time:"
            " those that are hit again make noise that depends on the damping of"
            " contacts, `vibration.retardation`"
        )

"""Warnings about noise: one list for the library and the command line."""

import math
from collections.abc import Iterator
from typing import Any

import jax
import numpy as np

from ..design import rows_of
from ..design.form_error import FormErrors, Harmonics, Surfaces
from ..element.balls.ball_inertia import ball_inertia, carried_loads
from ..element.balls.ball_speed import CentrifugalOnly, OuterControl
from ..numerics import Result, Warning
from ..numerics.compiled.programs import program
from ..numerics.types import as_real
from .bands import LEAST_SHIFT, Bands, band_shift, covers, total_root_mean_square
from .contact_width import contact_half_width
from .dynamics.contact_states import contact_states
from .dynamics.dynamic_row import of_rows
from .model import NoiseModel
from .natural import after_orbit, natural_modes, ring_modes
from .orders import kinematic_frequencies
from .scatter import Tolerances
from .source_contributions import SourceContributions
from .spectrum import Spectrum
from .vibration import Vibration, bandwidth, needed_steps, rounding

UNEVEN = 3.0
"""Difference of both halves of a record above which to warn [dB]."""
_PLACES = 8
"""Number of orbit positions at which modes are compared."""
_WANDERING = 0.02
"""Change of a natural frequency along the orbit above which to warn [1]."""
_OVERLAP = 0.1
"""Excess of the sum of shares above which to warn [1]."""
_GYROSCOPIC = 0.05
"""Traction over load from the gyroscopic moment of balls above which to warn [1]: it
changes contact angles by as much in radians."""
_LOBE = 2.0
"""Half width of a line with Hann's window [bins]."""


def model_warnings(
    model: NoiseModel,
    samples: int = 2048,
    steps: int | None = None,
    tolerances: Tolerances | None = None,
) -> list[Warning]:
    """Return warnings about a bearing and its requested record.

    Args:
        model: The bearing; concrete.
        samples: Per turn of the shaft.
        steps: Steps of the integration, per sample; `None`: as many as are needed.
        tolerances: Scatter of random bearings, if they are asked for.

    Returns:
        Warnings; empty if there are none.
    """
    band_limit = bandwidth(samples, float(model.shaft_speed) / (2.0 * np.pi))
    return [
        *_few_steps(model, samples, steps),
        *_wandering_modes(model),
        *_bandwidth_warnings(model, band_limit, tolerances),
    ]


def record_warnings(
    model: NoiseModel,
    record: Vibration,
    found: Spectrum,
    bands: Bands,
    tolerances: Tolerances | None = None,
) -> list[Warning]:
    """Return warnings about a record and its levels.

    Args:
        model: The bearing; concrete.
        record: From `vibration`, converged.
        found: Spectrum of its acceleration, amplitudes (line, direction) [m/s²].
        bands: Bands of the levels.
        tolerances: Scatter of random bearings, if they are asked for.

    Returns:
        Warnings; empty if there are none.
    """
    return [
        *_silence_warning(model, record, found),
        *_bands(record, found, bands),
        *_total(model, record, found),
        *_short_waves(model, np.asarray(record.contact_load), tolerances),
        *_gyroscopic(model, np.asarray(record.contact_load)),
        *_halves(record),
        *_lost_contacts(record),
    ]


def contribution_warnings(found: SourceContributions) -> list[Warning]:
    """Return warnings about shares of sources.

    Args:
        found: From `source_contributions`.

    Returns:
        A warning, or none.
    """
    together = float(found.total_share)
    error = float(np.linalg.norm(found.error) / found.mean_square)
    # A single bearing has no standard error.
    limit = 1.0 + max(_OVERLAP, 2.0 * error if error > 0.0 else 0.0)
    if together <= limit:
        return []
    words = (
        f"parts of the sources sum to {100.0 * together:.3g} % of the mean square:"
        " they act through each other, and what goes without one of them is counted"
        " for each"
    )
    return [Warning("overlapping_sources", words, together, limit)]


def _few_steps(model, samples, steps) -> Iterator[Warning]:
    least = needed_steps(model, samples)
    if steps is not None and steps < least:
        yield Warning(
            "few_steps",
            f"{steps} steps per sample are less than the {least} that the fastest"
            " natural mode needs",
            float(steps),
            float(least),
        )


def _wandering_modes(model: NoiseModel) -> Iterator[Warning]:
    """Warn of natural modes that change as the rolling elements orbit."""
    share = np.arange(_PLACES) / _PLACES
    count = rows_of(model.element.bearing)[0].bearing.n_elements
    # Of the way round and of the way to the next element, after which equal ones stand
    # as before.
    angles = 2.0 * np.pi / count * (np.floor(count * share) + share)
    every: dict[str, list[float]] = {}
    for angle in angles if model.orbits else ():
        modes = jax.device_get(natural_modes(after_orbit(model, angle)))
        if int(modes.result) == Result.CONVERGED:
            for name, frequency in ring_modes(modes, model):
                every.setdefault(name, []).append(frequency)
    changes = [
        f"{name} between {min(known):.5g} and {max(known):.5g} Hz"
        for name, known in every.items()
        if max(known) > (1.0 + _WANDERING) * min(known)
    ]
    if changes:
        yield Warning(
            "wandering_modes",
            "natural modes are those of the element positions at time zero;"
            f" as these orbit, they change: {'; '.join(changes)}",
        )


def _bandwidth_warnings(model, band_limit, tolerances) -> Iterator[Warning]:
    """Warn of modes and waves above the bandwidth of the samples."""
    cut = (
        f"above {band_limit:.5g} Hz, up to which the samples tell the vibration; raise"
        " `vibration.samples` to hear what they make there"
    )
    for name, frequency in ring_modes(jax.device_get(natural_modes(model)), model):
        if frequency > band_limit:
            words = f"the {name} at {frequency:.5g} Hz lies {cut}"
            about = float(frequency), band_limit, name
            yield Warning("mode_beyond_bandwidth", words, *about)
    drawn = _highest_drawn(tolerances)
    for where, bearing, errors in _rows(model):
        rolling = kinematic_frequencies(bearing, model.speed)
        passing = {
            "outer raceway": abs(float(rolling.cage - rolling.outer)),
            "inner raceway": abs(float(rolling.inner - rolling.cage)),
            "elements": float(rolling.rotation),
        }
        for part, given in _parts(errors).items():
            highest = max(_highest_order(given), drawn[part])
            rate = highest * passing[part]
            if rate > band_limit:
                yield Warning(
                    "waves_beyond_bandwidth",
                    f"waves of order {highest} of the {part}{where} are met at"
                    f" {rate:.5g} Hz, {cut}",
                    rate,
                    band_limit,
                    f"{part}{where}",
                )


def _silence_warning(model, record, found) -> Iterator[Warning]:
    """Warn of a record of round-off only."""
    size = np.sqrt(np.sum(np.asarray(found.power)[1:]))
    if not size > rounding(model, record):
        yield Warning(
            "silent_record",
            f"nothing shakes the bearing: its acceleration of {size:.2g} m/s² is"
            " round-off of the forces; give it form errors, or rolling elements that"
            " differ",
            float(size),
        )


def _bands(record, found, bands) -> Iterator[Warning]:
    """Warn of bands that the record does not cover, with remedies."""
    duration = f"the record of {float(record.duration):.4g} s"
    centre = bands.centre
    wide, within = (np.asarray(a) for a in covers(found, bands, record.bandwidth))
    if not wide.all():
        yield Warning(
            "short_record",
            f"{duration} is too short for the bands up to {centre[~wide][-1]:g} Hz;"
            " raise `vibration.turns`",
            where=f"up to {centre[~wide][-1]:g} Hz",
        )
    if within.any() and not within.all():
        yield Warning(
            "few_samples",
            f"{duration} has too few samples for the bands from"
            f" {centre[~within][0]:g} Hz on; raise `vibration.samples`",
            where=f"from {centre[~within][0]:g} Hz",
        )
    changed, need = (np.asarray(a) for a in band_shift(found, bands))
    over = (wide & within)[:, None] & (np.abs(changed) >= LEAST_SHIFT)
    if over.any():
        near = float(np.median(need[over]))
        turns = math.ceil(_LOBE * float(record.shaft_frequency) / max(near, 1e-9))
        # Beyond the lobe of a line its skirt falls by 18 dB for twice the turns.
        turns = max(turns, 2 * record.turns)
        named = ", ".join(f"{c:g}" for c in centre[over.any(axis=1)])
        yield Warning(
            "spread_lines",
            "the window spreads strong lines over the edges of bands, which are left"
            f" out for that: {named} Hz; raise `vibration.turns`, to {turns} for most"
            " of them",
            where=f"{named} Hz",
        )


def _total(model, record, found) -> Iterator[Warning]:
    """Warn of a total level that the window changes."""
    own = np.asarray(record.acceleration)[:, :3].std(axis=0)
    heard = own > rounding(model, record)
    if not heard.any():
        return
    windowed = np.asarray(total_root_mean_square(found))[heard]
    away = 20.0 * np.log10(windowed / own[heard])
    most = float(away[np.argmax(np.abs(away))])
    if abs(most) >= LEAST_SHIFT:
        yield Warning(
            "windowed_level",
            f"with its window the total level is {abs(most):.2g} dB"
            f" {'below' if most < 0 else 'above'} that of the record itself: the window"
            " leans on the middle, and takes a part of lines of few periods; raise"
            " `vibration.turns`",
            abs(most),
            LEAST_SHIFT,
        )


def _short_waves(model, load, tolerances) -> Iterator[Warning]:
    """Warn of waves shorter than the contacts that the model does not average."""
    if model.half_width is not None:
        return
    drawn = _highest_drawn(tolerances)
    loads = of_rows(load, model.element.bearing, axis=1)
    for own, (where, bearing, errors) in zip(loads, _rows(model), strict=True):
        half = contact_half_width(bearing, own)
        surfaces = Surfaces.from_bearing(bearing)
        around = {
            "outer raceway": surfaces.outer,
            "inner raceway": surfaces.inner,
            "elements": surfaces.element,
        }
        for part, given in _parts(errors).items():
            highest = max(_highest_order(given), drawn[part])
            most = int(float(around[part].radius) / half) if half > 0.0 else highest
            if highest > most:
                yield Warning(
                    "short_waves",
                    f"waves of the {part}{where} of order {most} and more are shorter"
                    f" than some three contacts of {2e3 * half:.2g} mm, which would"
                    " bridge them: their noise is overstated, by 10 % at that order and"
                    " ever more above; average them with `vibration.bridging`",
                    float(highest),
                    float(most),
                    f"{part}{where}",
                )


def _gyroscopic(model, load) -> Iterator[Warning]:
    """Warn of balls on which the omitted gyroscopic moment matters.

    At the free contact angle, or at that of the axial load if it is larger.
    """
    control = model.element.raceway_control
    if control is None or isinstance(control, CentrifugalOnly):
        return
    loads = of_rows(load, model.element.bearing, axis=1)
    for own, (where, bearing, _) in zip(loads, _rows(model), strict=True):
        each = 0.5 * float(np.mean(np.sum(own, axis=2)))  # of a ball, on one raceway
        if not each > 0.0:
            continue
        sine = abs(float(model.load[2])) / (each * own.shape[1])
        cosine = min(float(bearing.free_cosine), math.sqrt(max(0.0, 1.0 - sine**2)))
        normal = as_real([[math.sqrt(1.0 - cosine**2), cosine]] * 2)
        traction = _traction(bearing, model.speed, normal, as_real([each] * 2))
        share = float(np.max(np.abs(traction))) / each
        if share > _GYROSCOPIC:
            words = (
                f"the gyroscopic moment of the balls{where} asks for tractions of"
                f" {100.0 * share:.2g} % of their loads; noise leaves it out, whatever"
                " the raceway control, and contact angles are not those of a load solve"
            )
            about = share, _GYROSCOPIC, where.removeprefix(" of ")
            yield Warning("gyroscopic_moment", words, *about)


@program(quick=True)
def _traction(bearing, speed, normal, load):
    ball = ball_inertia(bearing, bearing.ball_diameter, speed, OuterControl())
    return carried_loads(ball, normal, load).traction


def _halves(record) -> Iterator[Warning]:
    acceleration = np.asarray(record.acceleration)[:, :3]
    half = len(acceleration) // 2
    first, second = (
        np.sqrt(np.sum(part.var(axis=0)))
        for part in (acceleration[:half], acceleration[half:])
    )
    away = 20.0 * np.log10(first / second) if first > 0 and second > 0 else 0.0
    if abs(away) > UNEVEN:
        yield Warning(
            "uneven_record",
            f"the first half of the record is {abs(away):.3g} dB"
            f" {'louder' if away > 0 else 'quieter'} than the second: raise"
            " `vibration.settle`, or `vibration.turns` until all beats are in it",
            abs(away),
            UNEVEN,
        )


def _lost_contacts(record) -> Iterator[Warning]:
    lost = contact_states(record).shares[0]
    if lost > 0:
        yield Warning(
            "lost_contacts",
            f"rolling elements are out of contact for {100.0 * lost:.3g} % of the time:"
            " those that are hit again make noise that depends on the damping of"
            " contacts, `vibration.retardation`",
            float(lost),
            0.0,
        )


def _rows(model: NoiseModel) -> Iterator[tuple[str, Any, FormErrors]]:
    """Yield the label of each row, its design and its form errors."""
    parts = rows_of(model.element.bearing)
    for k, (row, errors) in enumerate(zip(parts, model.errors_of_rows, strict=True)):
        yield "" if len(parts) == 1 else f" of row {k}", row.bearing, errors


def _parts(errors: FormErrors) -> dict[str, Any]:
    return {
        "outer raceway": errors.outer,
        "inner raceway": errors.inner,
        "elements": errors.elements,
    }


def _highest_drawn(tolerances: Tolerances | None) -> dict[str, int]:
    """Return the highest order of random waves, by part."""
    found = {"outer raceway": 0, "inner raceway": 0, "elements": 0}
    for name, part in (
        ("outer_axial", "outer raceway"),
        ("outer_outwards", "outer raceway"),
        ("inner_axial", "inner raceway"),
        ("inner_outwards", "inner raceway"),
        ("elements", "elements"),
    ):
        waves = getattr(tolerances, name, None)
        if waves is not None:
            found[part] = max(found[part], waves.high)
    return found


def _highest_order(errors: Any) -> int:
    """Return the highest order of waves."""
    shapes = jax.tree.leaves(errors, is_leaf=lambda x: isinstance(x, Harmonics))
    orders = [max(one.order) for one in shapes if isinstance(one, Harmonics)]
    return max(orders, default=0)

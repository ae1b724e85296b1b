"""Spectra of steady vibration over the frequency of the excitation."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ...design.checks import check, count, integration, real_numbers
from ...numerics.compiled.programs import program
from ...numerics.in_time import IntegrationOptions
from ...numerics.spectrum import LEAST, even_step, hann_lines
from ...numerics.types import as_real
from ...numerics.units import unit, units
from .run_up import as_frequency_table
from .system import AbstractVibratingSystem
from .transient import Start, beginning, simulate_traced


class Waterfall(eqx.Module):
    """Amplitudes of the lines of a spectrum, at every frequency of the excitation.

    Attributes:
        frequency: Frequency of the excitation (frequency,) [rad/s].
        order: Frequency of each line over that of the excitation (line,) [1].
        amplitude: Half of peak to peak of each line; at order zero the mean
            (frequency, line, n) [m, rad].
        result: `Result` codes (frequency,).
    """

    frequency: Float[Array, " frequency"]
    order: Float[Array, " line"]
    amplitude: Float[Array, "frequency line n"]
    result: Int[Array, " frequency"]


def waterfall(
    system: AbstractVibratingSystem,
    frequencies: Any,
    *,
    settle: int = 100,
    periods: int = 8,
    samples: int = 32,
    start: Start | None = None,
    options: IntegrationOptions | None = None,
) -> Waterfall:
    """Return spectra of the vibration that remains after some periods.

    Every frequency starts from the same motion; all are integrated at once. Lines are
    at whole multiples of 1/`periods` of the excitation: subharmonics of up to that many
    periods have lines of their own; almost periodic motion spreads over its neighbours.

    Args:
        system: The system.
        frequencies: Frequencies of the excitation, above zero (frequency,) [rad/s].
        settle: Periods until the vibration is taken for steady. Static.
        periods: Periods that a spectrum is of. Static.
        samples: A period; lines reach half of it in order. Static.
        start: As in `simulate`, at every frequency.
        options: As in `simulate`.

    Returns:
        `Waterfall`; where the end is not reached amplitudes are NaN and `result` says
        why.

    Fails: as `simulate`.
    """
    numbers = {"settle": settle, "periods": periods, "samples": samples}
    for name, number in numbers.items():
        count("waterfall", name, number)
    real_numbers("waterfall", "frequencies", frequencies, "a row of numbers")
    each = as_real(frequencies)
    check("waterfall", "frequencies", each > 0, "above zero throughout", each, "rad/s")
    options = IntegrationOptions() if options is None else options
    integration("waterfall", options)
    begin = beginning("waterfall", system, start)
    return _spectra(system, each, begin, options, tuple(numbers.values()))


@program
def _spectra(system, frequencies, start, options, numbers):
    settle, periods, samples = numbers
    total = periods * samples
    phases = as_real(2.0 * np.pi * (settle + np.arange(total) / samples))
    end = 2.0 * np.pi * (settle + periods)
    weight = np.full(total // 2 + 1, 2.0 / total)
    weight[0] = 1.0 / total
    if total % 2 == 0:
        weight[-1] = 1.0 / total
    weight = as_real(weight)[:, None]

    def spectrum_at(frequency):
        table = as_frequency_table("waterfall", frequency)
        times = phases / frequency
        found = simulate_traced(
            system, table, start, None, times, end / frequency, options
        )
        lines = jnp.fft.rfft(found.displacement, axis=0)
        return weight * jnp.abs(lines), found.result

    amplitude, result = jax.vmap(spectrum_at)(frequencies)
    order = as_real(np.arange(total // 2 + 1) / periods)
    return Waterfall(frequencies, order, amplitude, result)


class Spectra(NamedTuple):
    """Spectra of a motion, one for each speed.

    Attributes:
        speed: (line,) [rad/s].
        frequency: Frequency of the bins, of all spectra (bin,) or of each (line, bin)
            [Hz].
        amplitude: (line, bin) [m, rad].
    """

    speed: Annotated[np.ndarray, unit("rad/s")]
    frequency: Annotated[np.ndarray, unit("Hz")]
    amplitude: Annotated[np.ndarray, units("m", "rad")]


def spectra_over_time(time: Any, speed: Any, motion: Any, count: int = 24) -> Spectra:
    """Return spectra of a run-up, in time windows that overlap by a half.

    Args:
        time: Even (time,) [s].
        speed: Speed of the rotor (time,) [rad/s].
        motion: (time,) [m, rad].
        count: Windows.

    Returns:
        Amplitudes as returned by `hann_lines`.

    Raises:
        ValueError: For times that are not even, or too few of them.
    """
    speed, motion = np.asarray(speed, dtype=float), np.asarray(motion, dtype=float)
    step = even_step("spectra_over_time", time)
    size = 2 * len(motion) // (count + 1)
    if size < LEAST:
        raise ValueError(
            f"spectra_over_time: {len(motion)} times are too few for {count} windows;"
            f" at least {LEAST // 2 * (count + 1)}."
        )
    first = np.arange(count) * (len(motion) - size) // max(count - 1, 1)
    part = first[:, None] + np.arange(size)
    return Spectra(speed[part].mean(axis=1), *hann_lines(motion[part], step))


def steady_spectra(found: Waterfall, freedom: int) -> Spectra:
    """Return spectra of steady vibration of a rotor with synchronous excitation.

    Args:
        found: From `waterfall`.
        freedom: Index of the freedom; its mean is left out.
    """
    speed = np.asarray(found.frequency)
    hertz = speed[:, None] * np.asarray(found.order)[1:] / (2.0 * np.pi)
    return Spectra(speed, hertz, np.asarray(found.amplitude)[:, 1:, freedom])

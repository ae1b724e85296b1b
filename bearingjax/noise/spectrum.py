"""Spectrum of a record in time: lines, their amplitudes and their share of the power.

Of n samples y_k, evenly spaced over the record, the first at its begin and none at its
end, the lines are

    a_m = (2/n) Σ y_k cos(2π k m/n),   b_m = (2/n) Σ y_k sin(2π k m/n)

with k from 0 to n - 1 and m up to n/2; a_0 and a_{n/2} count half. As a_m - i b_m they
are what a fast Fourier transform gives. The source lets k begin with 1, which leaves
out a sample, and m go on to n - 1, which counts every line twice, as a_{n-m} = a_m.

Source: Bessel's formulas, as Kurushin, Kurushin, Zhilnikov, Murashkin, Vestnik SGAU
(2011) print them; windows: Harris, Proc. IEEE 66 (1978).
"""

import abc
from collections.abc import Sequence
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from ..design.checks import check, floats, must_be, positive
from ..numerics.compiled.programs import program
from ..numerics.labels import to_xarray
from ..numerics.shown import Printable
from ..numerics.types import Scalar, array_namespace, as_real
from ..numerics.units import unit

WHOLE_TURNS = 1e-3
"""Largest deviation of a record from a whole number of turns, without a window [1].

A line next to that of the shaft then has this share of its amplitude, or less.
"""

HIGH_BAND = 1800.0, 10_000.0
"""High band of bearing vibration, lower and upper edge [Hz]. Source: ISO 15242-1."""
_LEAST = 4  # samples


class AbstractWindow(eqx.Module):
    """Window: weights of the samples of a record, of mean 1.

    With this mean a line on a bin has its own amplitude. Of the power of all bins it
    has `noise_bandwidth` times its share, because the window spreads it.
    """

    @property
    @abc.abstractmethod
    def noise_bandwidth(self) -> float:
        """Mean square of the weights: width in bins of the noise in one line [1]."""

    @abc.abstractmethod
    def weights(self, count: int) -> np.ndarray:
        """The weights (count,) [1]."""

    @abc.abstractmethod
    def power_beyond(self, distance: Any) -> Any:
        """Return the share of the power of a single line beyond a distance in bins [1].

        Args:
            distance: From the line to the first of these bins, above 0 (...) [bins].
        """

    @abc.abstractmethod
    def peak(self, left: Any, middle: Any, right: Any) -> tuple[Any, Any]:
        """Return the position of a single line, largest in the middle of three bins.

        Args:
            left, middle, right: Amplitudes of the bins [any unit].

        Returns:
            Its distance from the middle bin, from -1/2 to 1/2 [bins], and its
            amplitude over that of the middle bin [1].
        """


class Rectangular(AbstractWindow):
    """Rectangular window, for periodic records, whose lines all lie on bins.

    A line between two bins leaks into all others.
    """

    @property
    def noise_bandwidth(self) -> float:
        return 1.0

    def weights(self, count: int) -> np.ndarray:
        return np.ones(count)

    def power_beyond(self, distance: Any) -> Any:
        return jnp.zeros_like(distance)

    def peak(self, left: Any, middle: Any, right: Any) -> tuple[Any, Any]:
        xp = array_namespace(middle)
        return xp.zeros_like(middle), xp.ones_like(middle)


class Hann(AbstractWindow):
    """Hann's window 1 - cos(2π k/n): for records whose lines do not fall on bins.

    Lines of the cage and of whatever turns with it are no whole multiples of the bins
    of a record of a few turns. A line fills three bins or four; half-way between two,
    the larger has 85 % of its amplitude.
    """

    @property
    def noise_bandwidth(self) -> float:
        return 1.5

    def weights(self, count: int) -> np.ndarray:
        return 1.0 - np.cos(2.0 * np.pi * np.arange(count) / count)

    def power_beyond(self, distance: Any) -> Any:
        # The first bins one by one, the others by an integral over their middles.
        near = jnp.stack([distance + k for k in range(4)])
        size = jnp.sinc(near) + 0.5 * (jnp.sinc(near - 1.0) + jnp.sinc(near + 1.0))
        far = (jnp.sin(jnp.pi * distance) / jnp.pi) ** 2 / (5.0 * (distance + 3.5) ** 5)
        return (jnp.sum(size**2, axis=0) + far) / self.noise_bandwidth

    def peak(self, left: Any, middle: Any, right: Any) -> tuple[Any, Any]:
        # A line at the distance s has sinc(s)/(1 - s²) of its amplitude in the bin:
        # the next one has (1 + s)/(2 - s) of that.
        xp = array_namespace(middle)
        above = right > left
        some = xp.where(middle > 0, middle, 1.0)
        ratio = xp.where(above, right, left) / some
        away = xp.clip((2.0 * ratio - 1.0) / (1.0 + ratio), 0.0, 0.5)
        return xp.where(above, away, -away), (1.0 - away**2) / xp.sinc(away)


class Spectrum(Printable):
    """Lines of a record: it is Re Σ amplitude · exp(2πi · frequency · time).

    Amplitudes are peak values: a sine of amplitude 1 on a bin has the size 1, a cosine
    the amplitude 1, a sine -i. Line 0 is the mean, the last one that of half of the
    sampling rate; both are real.

    Attributes:
        frequency: (line,) [Hz].
        order: Frequency over that of the shaft (line,) [1].
        amplitude: Complex amplitudes (line, ...) [unit of the record].
        window: The window that the record was weighted with. Static.

    Traced: all fields but the window.
    """

    frequency: Float[Array, " line"] = eqx.field(metadata=unit("Hz"))
    order: Float[Array, " line"] = eqx.field(metadata=unit("1"))
    amplitude: Complex[Array, "line ..."]
    window: AbstractWindow

    to_xarray = to_xarray

    @property
    def resolution(self) -> Scalar:
        """Distance of two lines, the reciprocal of the duration [Hz]."""
        return self.frequency[1]

    @property
    def noise_bandwidth(self) -> Scalar:
        """Equivalent noise bandwidth of a line [Hz]."""
        return self.window.noise_bandwidth * self.resolution

    @property
    def power(self) -> Float[Array | np.ndarray, "line ..."]:
        """Share of every line in the mean square of the record [its unit, squared].

        Line 0 is the mean squared. The others sum to the mean square of the record
        about its mean; with a window, to an estimate of it that leans on the middle of
        the record.
        """
        square = self.amplitude.real**2 + self.amplitude.imag**2
        share = np.full(len(square), 0.5)
        share[-1] = 1.0  # a cosine at its peaks in every sample
        share /= self.window.noise_bandwidth
        share[0] = 1.0
        axes = [1] * (square.ndim - 1)
        return square * share.reshape(-1, *axes).astype(square.dtype)


def spectrum(
    signal: Any,
    duration: Any,
    shaft_frequency: Any,
    *,
    window: AbstractWindow | None = None,
) -> Spectrum:
    """Return the spectrum of a record in time.

    It is a small program of its own, compiled once per shape of the record. Call it
    outside of other compiled programs.

    Args:
        signal: Samples, evenly spaced, an even number of them: the first at the begin
            of the record, the last one step before its end (time, ...) [any unit].
        duration: Duration of the record, the end included: samples times step [s].
        shaft_frequency: Speed of the shaft, above zero [Hz].
        window: `None` or `Rectangular()`: none, for a record that repeats itself; it
            must then cover a whole number of turns of the shaft. `Hann()` for others.

    Returns:
        Spectrum, differentiable with respect to signal, duration and shaft frequency.

    Raises:
        TypeError: If the window is none, such as a text.
        ValueError: For an odd number of samples, or fewer than four; a duration or
            shaft frequency not above zero; a record without a window that does not
            cover a whole number of turns (to `WHOLE_TURNS`).
    """
    window = Rectangular() if window is None else window
    known = isinstance(window, AbstractWindow)
    allowed = "Rectangular() or Hann()"
    must_be("spectrum", "window", window, known, allowed, TypeError)
    signal = as_real(signal)
    shape = np.shape(signal)
    if not shape or shape[0] < _LEAST or shape[0] % 2:
        raise ValueError(
            f"spectrum: `signal` has the shape {shape}; its first axis, time, must have"
            f" an even number of samples, {_LEAST} or more, without the end point."
        )
    positive("spectrum", "duration", duration, "s")
    positive("spectrum", "shaft_frequency", shaft_frequency, "Hz")
    numbers = floats(duration, shaft_frequency)
    if numbers is not None and isinstance(window, Rectangular):
        turns = numbers[0] * numbers[1]
        whole = turns > 0.5 and abs(turns - round(turns)) <= WHOLE_TURNS
        allowed = (
            f"a whole number of turns of the shaft (it is {turns:.6g} turns), or give"
            " window=Hann()"
        )
        check("spectrum", "duration", whole, allowed, numbers[0], "s")
    duration, shaft_frequency = (
        as_real(value).astype(signal.dtype) for value in (duration, shaft_frequency)
    )
    return _spectrum(signal, duration, shaft_frequency, window)


@program(quick=True)
def _spectrum(signal, duration, shaft_frequency, window) -> Spectrum:
    count = signal.shape[0]
    axes = [1] * (signal.ndim - 1)
    weights = jnp.asarray(window.weights(count).reshape(-1, *axes), signal.dtype)
    # About the weighted mean the window leaves nothing in line 0, and the mean does not
    # leak into line 1.
    mean = jnp.mean(weights * signal, axis=0)
    lines = jnp.fft.rfft(weights * (signal - mean[None]), axis=0)
    share = np.full(count // 2 + 1, 2.0 / count)
    share[[0, -1]] = 1.0 / count
    amplitude = lines * jnp.asarray(share.reshape(-1, *axes), lines.dtype)
    amplitude = amplitude.at[0].set(mean.astype(amplitude.dtype))
    frequency = jnp.arange(count // 2 + 1, dtype=signal.dtype) / duration
    return Spectrum(frequency, frequency / shaft_frequency, amplitude, window)


def envelope_spectrum(
    signal: Any,
    duration: Any,
    shaft_frequency: Any,
    band: Sequence[float] = HIGH_BAND,
    *,
    window: AbstractWindow | None = None,
) -> Spectrum:
    """Return the spectrum of the envelope of a record within a band, in NumPy.

    Whatever a defect strikes rings at natural frequencies; how strongly, over time, is
    the envelope, and its lines are those at which it is struck: the passage
    frequencies. The band is cut out of the Fourier transform of the record, without
    a shift of phase; the envelope is the magnitude of the analytic signal. Where a
    record does not repeat itself, it is wrong near both ends, which Hann's window
    weighs least.

    Args:
        signal: Record (sample,) or (sample, direction), as in `spectrum`, concrete.
        duration: Duration of the record [s].
        shaft_frequency: Turns of the shaft per second [Hz].
        window: Window of the envelope.
        band: Lower and upper frequency, both in the band (2,) [Hz].

    Returns:
        Spectrum, its line 0 the mean of the envelope. A carrier of amplitude a times
        1 + m cos(2π f · time), with m at most 1, has the mean a and the line m a at f.

    Raises:
        TypeError, ValueError: As `spectrum`; for a band that does not rise from above
            zero to half of the sampling rate at most.

    Source: Randall, Antoni, Mech. Syst. Signal Process. 25 (2011), section 4.
    """
    positive("envelope_spectrum", "duration", duration, "s")
    lines = np.fft.fft(np.asarray(signal, dtype=float), axis=0)
    low, high = (float(edge) for edge in band)
    most = 0.5 * len(lines) / float(duration)
    allowed = f"two rising frequencies above 0 and up to {most:.5g} Hz"
    risen = 0.0 < low < high <= most
    check("envelope_spectrum", "band", risen, allowed, [low, high], "Hz")
    frequency = np.arange(len(lines)) / float(duration)
    lines[(frequency < low) | (frequency > high)] = 0.0
    envelope = 2.0 * np.abs(np.fft.ifft(lines, axis=0))
    return spectrum(envelope, duration, shaft_frequency, window=window)

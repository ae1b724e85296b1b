"""Spectrum of the envelope of a record: how often what rings is struck."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..design.checks import check, positive
from .spectrum import AbstractWindow, Spectrum, spectrum

HIGH_BAND = 1800.0, 10_000.0
"""High band of bearing vibration, lower and upper edge [Hz]. Source: ISO 15242-1."""


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
        signal, duration, shaft_frequency, window: As in `spectrum`, concrete.
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

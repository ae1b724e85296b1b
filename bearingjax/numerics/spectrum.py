"""Spectrum of a record at even times, of the results of a run that has ended."""

import numpy as np
from numpy.typing import ArrayLike

LEAST = 8
"""Least number of times that have a spectrum."""


def even_step(owner: str, time: ArrayLike) -> float:
    """Return the step between even times [s].

    Args:
        owner: Function that was called.
        time: (time,) [s].

    Raises:
        ValueError: For times that are not even.
    """
    step = np.diff(np.asarray(time, dtype=float))
    if np.ptp(step) > 1e-6 * step.mean():
        raise ValueError(f"{owner}: the times are not even.")
    return float(step.mean())


def hann_lines(record: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the lines of records with Hann's window, the mean left out.

    Args:
        record: (..., time) [any unit].
        step: Between the times [s].

    Returns:
        Frequencies (line,) [Hz] and amplitudes (..., line): a sine of amplitude 1 on
        one of the frequencies has a line of 1.
    """
    count = record.shape[-1]
    window = np.hanning(count + 1)[:-1]
    about = record - record.mean(axis=-1, keepdims=True)
    lines = np.abs(np.fft.rfft(about * window, axis=-1))
    return np.fft.rfftfreq(count, step), 2.0 * lines / window.sum()

"""A record of acceleration as sound."""

import wave
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from ..design.checks import positive

RATE = 48_000
"""Sampling rate of a file [Hz]."""
LEAST = 3.0
"""Shortest file [s]."""
_FADE = 0.01
"""Time of the cross-fade between repetitions [s]."""
_FULL = 32_767


def sound(record: Any, duration: Any) -> np.ndarray:
    """Resample a record to `RATE`, repeated to last `LEAST` or more.

    Its mean is taken off. Where it begins anew, end and begin are blended over 10 ms
    (of a short record over a quarter of it), so that no click is heard there.

    Args:
        record: Even samples without the end point (time,) [any unit].
        duration: Duration of the record [s].

    Returns:
        Samples [unit of the record].

    Raises:
        ValueError: For fewer than four samples, samples that are not finite, or a
            duration not above zero.
    """
    positive("sound", "duration", duration, "s")
    record = np.asarray(record, dtype=float)
    if record.ndim != 1 or len(record) < 4 or not np.isfinite(record).all():
        raise ValueError(
            f"sound: `record` has the shape {record.shape}; it must be four finite"
            " samples or more (time,)."
        )
    sampled = len(record) / float(duration)
    ratio = Fraction(RATE / sampled).limit_denominator(2000)
    record = record - record.mean()
    from scipy.signal import resample_poly  # a second of import

    # Without a step to zero at the ends, at which the filter would ring.
    one = resample_poly(record, ratio.numerator, ratio.denominator, padtype="line")
    fade = min(round(_FADE * RATE), len(one) // 4)
    times = max(1, int(np.ceil((LEAST * RATE - fade) / (len(one) - fade))))
    # The end fades out while the next begin fades in.
    rising = (np.arange(fade) + 0.5) / max(fade, 1)
    seam = one[len(one) - fade :] * rising[::-1] + one[:fade] * rising
    inner = one[fade : len(one) - fade]
    parts = [one[:fade], *[inner, seam] * (times - 1), inner, one[len(one) - fade :]]
    return np.concatenate(parts)


def write_sound(path: str | Path, record: Any, duration: Any) -> float:
    """Write a record as a WAV file: 16 bit, one channel, full amplitude.

    Args:
        path: Path of the file.
        record, duration: As in `sound`.

    Returns:
        What full scale is [unit of the record]; 0 of silence.

    Raises:
        ValueError: As `sound`.
        OSError: If the file cannot be written.
    """
    samples = sound(record, duration)
    full = float(np.abs(samples).max())
    scaled = np.round(_FULL * samples / (full or 1.0)).astype("<i2")
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(scaled.tobytes())
    return full

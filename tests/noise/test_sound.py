"""Records as sound: rate, length, pitch and full scale of the file; no clicks."""

import wave

import numpy as np
import pytest

from bearingjax.noise import sound, write_sound
from bearingjax.noise.sound import LEAST, RATE


@pytest.mark.parametrize("samples", [5120, 2000, 25000])
def test_pitch_and_size_stay(samples):
    duration = 0.1
    time = np.arange(samples) * duration / samples
    heard = sound(3.0 + 2.0 * np.sin(2.0 * np.pi * 1000.0 * time), duration)
    assert len(heard) >= LEAST * RATE
    # A whole number of waves in the record: the seams do not shift them much.
    lines = np.abs(np.fft.rfft(heard * np.hanning(len(heard))))
    assert np.argmax(lines) * RATE / len(heard) == pytest.approx(1000.0, rel=0.01)
    middle = heard[1000 : RATE // 20]
    assert np.abs(middle).max() == pytest.approx(2.0, rel=0.01)


def test_sound_loops_without_click():
    """A slow wave that ends far from where it began."""
    time = np.arange(4096) / 4096
    heard = sound(np.cos(np.pi * time), 0.2)
    # Over the seam, of 10 ms, it goes from -1 back to 1; images of the filter, 60 dB
    # below, come on top. A click would be a step of 2.
    steepest = np.pi / 0.2 / RATE + 2.0 / (0.01 * RATE)
    assert np.abs(np.diff(heard[100:-100])).max() < steepest + 2e-3


def test_write_sound_returns_full_scale(tmp_path):
    path = tmp_path / "a.wav"
    record = np.random.default_rng(0).normal(size=4096)
    full = write_sound(path, record, 0.08)
    with wave.open(str(path)) as file:
        assert file.getparams()[:3] == (1, 2, RATE)
        raw = np.frombuffer(file.readframes(file.getnframes()), "<i2")
    assert np.abs(raw).max() == 32767
    half_a_step = 0.51 * full / 32767
    assert np.allclose(raw * full / 32767, sound(record, 0.08), atol=half_a_step)
    assert write_sound(path, np.zeros(64), 1.0) == 0.0


def test_no_record_is_no_sound():
    with pytest.raises(ValueError, match=r"`record` has the shape \(2,\)"):
        sound([1.0, 2.0], 1.0)
    with pytest.raises(ValueError, match="four finite"):
        sound([1.0, 2.0, np.nan, 1.0], 1.0)
    with pytest.raises(ValueError, match="`duration` is 0 s"):
        sound(np.ones(8), 0.0)

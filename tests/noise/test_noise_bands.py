"""Octaves and third-octaves: where their edges are, and what a record has in them."""

from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import theirs
from tolerances import DIFFERENCE, ROUNDING

from bearingjax import noise
from bearingjax.noise import (
    Hann,
    band_levels,
    band_root_mean_square,
    band_shift,
    octave_bands,
    spectrum,
    third_octave_bands,
    total_root_mean_square,
)
from bearingjax.noise.bands import LEAST_SHIFT, _root, is_held, leakage
from bearingjax.noise.warning import _total

OCTAVES = theirs("iec61260_octaves", "nominal centres [Hz]")

SHAFT = 25.0


def test_bands_of_the_standard():
    """The standard's own are validation cases, `iec61260_octaves` and `_thirds`."""
    octaves, thirds = octave_bands(), third_octave_bands(25.0, 20e3)
    # Nominal centres are the exact ones to the rounding of the series.
    np.testing.assert_allclose(thirds.centre, thirds.middle, rtol=0.013)
    for bands in (octaves, thirds, third_octave_bands(0.1, 1.0)):
        np.testing.assert_allclose(bands.upper[:-1], bands.lower[1:], rtol=ROUNDING)
        np.testing.assert_allclose(bands.middle**2, bands.lower * bands.upper)
    # Three thirds are an octave.
    np.testing.assert_allclose(thirds.lower[0], octaves.lower[3], rtol=ROUNDING)
    np.testing.assert_allclose(thirds.upper[2], octaves.upper[3], rtol=ROUNDING)


def test_octave_bands_reject_invalid_limits():
    with pytest.raises(ValueError, match="`lowest` is 5 Hz.*2, 4 or 8 Hz"):
        octave_bands(5.0)
    with pytest.raises(ValueError, match="`highest` is 9000 Hz.*8000 or"):
        octave_bands(highest=9000.0)
    with pytest.raises(ValueError, match="`highest` is 31.5 Hz.*63 Hz, the lowest"):
        third_octave_bands(63.0, 31.5)
    with pytest.raises(ValueError, match="`lowest` is -4 Hz"):
        octave_bands(-4.0)


def tones(duration, count, frequencies, sizes):
    time = duration * np.arange(count) / count
    return np.cos(2 * np.pi * np.outer(time, frequencies)) @ np.array(sizes)


def test_tones_in_their_bands():
    """8 turns at 25 Hz: the cage near 10.4 Hz, the balls, the ring's resonance."""
    place = [9.375, 12.5, 25.0, 2700.0]
    y = tones(8 / SHAFT, 8192, place, [1.0, 0.5, 0.2, 3.0])
    found = spectrum(y, 8 / SHAFT, SHAFT)
    rms = np.asarray(band_root_mean_square(found, octave_bands()))
    want = np.zeros(12)
    want[[1, 2, 3, 9]] = np.array([1.0, 0.5, 0.2, 3.0]) / np.sqrt(2)
    want[0] = np.nan  # 2.8 Hz wide, lines of 3.1 Hz
    np.testing.assert_allclose(rms, want, atol=1e-10)
    np.testing.assert_array_equal(is_held(found, octave_bands()), ~np.isnan(want))
    np.testing.assert_allclose(
        total_root_mean_square(found), np.sqrt(np.nansum(rms**2))
    )
    levels = np.asarray(band_levels(found, octave_bands()))
    np.testing.assert_allclose(levels[9], noise.level(3.0 / np.sqrt(2)))
    total = noise.level(total_root_mean_square(found))
    np.testing.assert_allclose(noise.combine_levels(levels[1:]), total)


@pytest.mark.parametrize("window", [None, Hann()], ids=["none", "Hann"])
def test_parseval_over_bands(window):
    """Bands that cover all lines have the mean square of the record between them."""
    y = np.random.default_rng(4).normal(size=(4096, 2)) + [5.0, 0.0]
    found = spectrum(y, 1.0, SHAFT, window=window)
    bands = third_octave_bands(1.0, 1600.0)
    held, other = np.asarray(is_held(found, bands)).T
    np.testing.assert_array_equal(held, other)
    sums = np.asarray(band_root_mean_square(found, bands))[held] ** 2
    rest = np.asarray(found.power)[1:]
    first = bands.lower[held][0]
    outside = (found.frequency[1:] < first) | (found.frequency[1:] >= bands.upper[-1])
    total = total_root_mean_square(found)
    whole = sums.sum(axis=0) + rest[np.asarray(outside)].sum(axis=0)
    np.testing.assert_allclose(whole, total**2)
    if window is None:
        np.testing.assert_allclose(total, y.std(axis=0))


def test_band_rms_of_white_noise():
    """With a window too: lines count by the power of noise, not by their size."""
    y = np.random.default_rng(5).normal(size=(65536,))
    bands = octave_bands(250.0, 8000.0)
    share = (bands.upper - bands.lower) / 32768.0
    for window in (None, Hann()):
        rms = band_root_mean_square(spectrum(y, 1.0, SHAFT, window=window), bands)
        # A band of n lines is known to sqrt(1/n), windowed to about 1.4 of that.
        spread = 1.4 / np.sqrt(bands.upper - bands.lower)
        assert (abs(np.asarray(rms) ** 2 / share - 1) < 4 * spread).all()


def test_bands_beyond_the_record_are_named():
    found = spectrum(tones(1.0, 4096, [100.0], [1.0]), 1.0, SHAFT)
    held = is_held(found, octave_bands())
    # Half of the sampling rate is 2048 Hz, within the octave of 2 kHz.
    np.testing.assert_array_equal(held, np.array(OCTAVES) < 1500)
    rms = np.asarray(band_root_mean_square(found, octave_bands()))
    np.testing.assert_array_equal(np.isnan(rms), ~held)
    # Hann's lines are half as wide again: third-octaves of 8 Hz (1.8 Hz) are held, of
    # 6.3 Hz (1.4 Hz) no longer.
    y = tones(1.0, 4096, [100.0], [1.0])
    thirds = third_octave_bands(4.0, 10.0)
    narrow = spectrum(y, 1.0, SHAFT), spectrum(y, 1.0, SHAFT, window=Hann())
    assert list(is_held(narrow[0], thirds)) == [False, True, True, True, True]
    assert list(is_held(narrow[1], thirds)) == [False, False, False, True, True]


@pytest.mark.parametrize("place", [25.0, 24.1, 20.3, 22.5])
def test_leakage_over_band_edge(place):
    """That of a lone line is what the lines beyond the edge have, by their sum."""
    time = 8 / SHAFT * np.arange(8192) / 8192
    y = np.cos(2 * np.pi * place * time + 0.4)
    found = spectrum(y, 8 / SHAFT, SHAFT, window=Hann())
    bands = octave_bands(16.0, 31.5)
    edge = bands.upper[:1]
    spread = leakage(found, edge)
    beyond = (np.asarray(found.frequency) < edge) == (place >= edge)
    out, other = (spread.down, spread.up)[:: 1 if place >= edge else -1]
    whole = np.asarray(found.power)[1:][beyond[1:]].sum()
    # What is left leaks from the line's image at negative frequencies.
    assert abs(out[0] - whole) < 1e-3 * 0.5 and other[0] == 0.0
    np.testing.assert_allclose(spread.need, abs(place - edge), rtol=5e-3)


def test_band_levels_beside_strong_line_need_resolution():
    """6205 at 1500 rpm: the shaft at 25 Hz stands 2.6 Hz beside the octave of 16 Hz."""
    bands = octave_bands(16.0, 63.0)
    line = noise.level(np.sqrt(0.5))
    held = {}
    for turns in (8, 16, 24):
        time = turns / SHAFT * np.arange(turns * 256) / (turns * 256)
        y = np.cos(2 * np.pi * 25.0 * time) + 1e-3 * np.cos(2 * np.pi * 14.3 * time)
        found = spectrum(y, turns / SHAFT, SHAFT, window=Hann())
        levels = np.asarray(band_levels(found, bands))
        held[turns] = ~np.isnan(levels[:2])
        # Bands that are given are right; others are left out.
        told = np.array([line - 60.0, line])[held[turns]]
        np.testing.assert_allclose(levels[:2][held[turns]], told, atol=LEAST_SHIFT)
    assert not held[8].any() and held[24].all()
    changed, need = band_shift(
        spectrum(y[: 8 * 256], 8 / SHAFT, SHAFT, window=Hann()), bands
    )
    # On a bin: a sixth of the line's power lies in the bin below, within 16 Hz.
    np.testing.assert_allclose(changed[1], 10 * np.log10(5 / 6), atol=1e-3)
    assert changed[0] > 30.0
    np.testing.assert_allclose(need[:2], 25.0 - bands.upper[0], rtol=1e-3)


@pytest.mark.parametrize("turns, told", [(1, "0.79 dB below"), (8, None)])
def test_warning_of_total_level_changed_by_window(turns, told, untyped):
    """One period of a sine keeps 5/6 of its power under Hann's window, more of them
    keep all."""
    time = turns / SHAFT * np.arange(turns * 64) / (turns * 64)
    y = np.sin(2 * np.pi * SHAFT * time)[:, None] * np.ones(3)
    found = spectrum(y, turns / SHAFT, SHAFT, window=Hann())
    record = SimpleNamespace(acceleration=y, contact_load=np.ones((1, 1, 2)))
    texts = list(_total(SimpleNamespace(mass=1.0), record, found))
    assert len(texts) == (told is not None)
    assert all(f"the total level is {told} that of the record" in t for t in texts)


def test_root_of_a_silent_band():
    """Nothing, with the derivative 0, not of infinity."""
    value = jax.value_and_grad(_root)
    assert tuple(map(float, value(jnp.asarray(0.0)))) == (0.0, 0.0)
    assert tuple(map(float, value(jnp.asarray(4.0)))) == (2.0, 0.25)


def test_derivatives_of_bands():
    """Of levels, with bands in which nothing is."""
    bands = octave_bands(31.5, 500.0)
    y = tones(0.16, 512, [50.0, 100.0, 225.0], [1.0, 0.3, 2.0])
    way = np.random.default_rng(6).normal(size=y.shape)

    def loudest(y):
        levels = band_levels(spectrum(y, 0.16, SHAFT), bands)
        return noise.combine_levels(levels)

    slope = jax.grad(loudest)(y) @ way
    step = 1e-5
    difference = (loudest(y + step * way) - loudest(y - step * way)) / (2 * step)
    np.testing.assert_allclose(slope, difference, rtol=DIFFERENCE)
    # Silence: no derivative is NaN.
    still = jax.grad(lambda y: band_levels(spectrum(y, 0.16, SHAFT), bands).sum())
    np.testing.assert_array_equal(still(np.zeros(512)), 0.0)

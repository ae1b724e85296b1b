"""Spectra of records: Bessel's sums, windows, power, derivatives.

The source prints sums over samples 1 … n - 1 and a series up to m = n - 1; here is
shown what they give instead.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING

from bearingjax.noise import Hann, Rectangular, envelope_spectrum, spectrum

N, TURNS, SHAFT = 64, 4, 25.0
DURATION = TURNS / SHAFT


def record(seed=0, axes=2):
    return np.random.default_rng(seed).normal(size=(N, axes)) + [1.0, -3.0]


def times():
    return DURATION * np.arange(N) / N


def sums(y, first=0):
    """a_m and b_m of the formulas, m = 0 … n - 1, over samples from the first on."""
    k = np.arange(first, len(y))
    angle = 2 * np.pi * np.outer(np.arange(len(y)), k) / len(y)
    return 2 / len(y) * np.cos(angle) @ y[first:], 2 / len(y) * np.sin(angle) @ y[
        first:
    ]


def series(a, b, last):
    """Bessel's series up to m = last, at all samples."""
    m = np.arange(1, last + 1)
    angle = 2 * np.pi * np.outer(np.arange(len(a)), m) / len(a)
    return a[0] / 2 + np.cos(angle) @ a[m] + np.sin(angle) @ b[m]


def test_bessels_sums():
    y = record()
    found = spectrum(y, DURATION, SHAFT)
    a, b = sums(y)
    a[[0, N // 2]] /= 2  # the mean, and half of the sampling rate
    b[[0, N // 2]] = 0
    want = (a - 1j * b)[: N // 2 + 1]
    np.testing.assert_allclose(found.amplitude, want, atol=ROUNDING)
    np.testing.assert_allclose(found.frequency, np.arange(N // 2 + 1) / DURATION)
    np.testing.assert_allclose(found.order, np.arange(N // 2 + 1) / TURNS)
    # It is the record again, as the docstring says.
    turned = np.exp(2j * np.pi * np.outer(times(), found.frequency))
    again = np.real(turned @ np.asarray(found.amplitude))
    np.testing.assert_allclose(again, y, atol=100 * ROUNDING)


def test_bessels_sums_as_printed_double_every_line():
    y = record()[:, 0]
    a, b = sums(y)
    right = series(np.where(np.arange(N) == N // 2, a / 2, a), b, N // 2)
    np.testing.assert_allclose(right, y, atol=100 * ROUNDING)
    # Up to n - 1 every line is there twice.
    twice = series(a, b, N - 1)
    np.testing.assert_allclose(twice, 2 * y - a[0] / 2, atol=100 * ROUNDING)
    # Without the sample k = 0 every cosine is wrong by 2 y_0/n.
    np.testing.assert_allclose(a - sums(y, 1)[0], 2 * y[0] / N, atol=ROUNDING)


def test_amplitudes_are_peak_values():
    phase = 2 * np.pi * SHAFT * times()
    y = np.stack([3.0 * np.cos(phase), 2.0 * np.sin(5 * phase) - 7.0], axis=1)
    found = np.asarray(spectrum(y, DURATION, SHAFT).amplitude)
    np.testing.assert_allclose(found[TURNS], [3.0, 0.0], atol=ROUNDING)
    np.testing.assert_allclose(found[5 * TURNS], [0.0, -2j], atol=ROUNDING)
    np.testing.assert_allclose(found[0], [0.0, -7.0], atol=ROUNDING)
    # With Hann's window too: it is of mean 1; its lines have neighbours of half.
    found = np.asarray(spectrum(y, DURATION, SHAFT, window=Hann()).amplitude)
    np.testing.assert_allclose(found[TURNS - 1 : TURNS + 2, 0], [-1.5, 3, -1.5])
    np.testing.assert_allclose(found[0], [0.0, -7.0], atol=ROUNDING)
    assert abs(found[1]).max() < ROUNDING  # the mean does not leak


def test_parseval():
    y = record()
    found = spectrum(y, DURATION, SHAFT)
    power = np.asarray(found.power)
    np.testing.assert_allclose(power[0], y.mean(axis=0) ** 2)
    np.testing.assert_allclose(power[1:].sum(axis=0), y.var(axis=0))
    np.testing.assert_allclose(found.noise_bandwidth, 1 / DURATION)
    # Windowed: exactly the mean square of the weighted record, over its bandwidth.
    found = spectrum(y, DURATION, SHAFT, window=Hann())
    weights = Hann().weights(N)[:, None]
    about = weights * (y - (weights * y).mean(axis=0))
    power = np.asarray(found.power)
    np.testing.assert_allclose(power[1:].sum(axis=0), (about**2).mean(axis=0) / 1.5)
    np.testing.assert_allclose(found.noise_bandwidth, 1.5 / DURATION)
    np.testing.assert_allclose(power[0], (weights * y).mean(axis=0) ** 2)


@pytest.mark.parametrize("window", [Rectangular(), Hann()], ids=lambda w: str(w))
def test_windows_say_their_bandwidth(window):
    weights = window.weights(N)
    np.testing.assert_allclose(weights.mean(), 1.0)
    np.testing.assert_allclose((weights**2).mean(), window.noise_bandwidth)


@pytest.mark.parametrize("place", [10.0, 10.31, 10.5, 10.77])
def test_a_line_between_bins(place):
    """Hann's window finds frequency, amplitude and power of a line between bins."""
    y = 2.0 * np.cos(2 * np.pi * place * times() / DURATION + 0.4) + 5.0
    found = spectrum(y, DURATION, SHAFT, window=Hann())
    size = np.abs(found.amplitude)
    k = 8 + size[8:].argmax()
    away, gain = Hann().peak(size[k - 1], size[k], size[k + 1])
    # What is left leaks from the line's image at negative frequencies.
    assert abs(k + away - place) < 2e-3
    assert abs(size[k] * gain / 2.0 - 1) < 1e-3
    assert abs(found.power[4:].sum() / 2.0 - 1) < 1e-3
    # Without a window a tenth of the power of a line between bins is elsewhere.
    bare = spectrum(y, DURATION, SHAFT)
    if place != 10.0:
        assert bare.power[9:13].sum() < 0.98 * 2.0


def test_spectrum_keeps_power_of_white_noise():
    """Broad-band power within a few per cent, with and without a window."""
    count = 4096
    y = np.random.default_rng(1).normal(size=(count,))
    for window in (None, Hann()):
        found = spectrum(y, 1.0, 4.0, window=window)
        # Standard deviation of the estimate: sqrt(2/n), and about 1.4 of it windowed.
        assert abs(found.power[1:].sum() - 1.0) < 5 * 1.4 * np.sqrt(2 / count)


def test_derivatives_of_a_spectrum():
    def weighted(y, duration, shaft):
        found = spectrum(y, duration, shaft, window=Hann())
        near = jnp.exp(-((found.order - 2.0) ** 2)) * found.frequency
        return jnp.sum(near[:, None] * found.power)

    y, way = record(2), record(3)
    at, along = (y, DURATION, SHAFT), (way, 0.01, -0.7)
    slope = jax.jvp(weighted, at, along)[1]
    back = jax.grad(weighted, argnums=(0, 1, 2))(*at)
    whole = sum(np.sum(np.asarray(g) * w) for g, w in zip(back, along, strict=True))
    np.testing.assert_allclose(whole, slope, rtol=1e-10)
    step = 1e-5
    ends = [
        weighted(*(p + sign * step * w for p, w in zip(at, along, strict=True)))
        for sign in (1, -1)
    ]
    np.testing.assert_allclose((ends[0] - ends[1]) / 2 / step, slope, rtol=DIFFERENCE)


def test_under_jit_and_vmap():
    y = record()
    want = spectrum(y, DURATION, SHAFT)
    inner = jax.jit(lambda y: spectrum(y, DURATION, SHAFT).amplitude)(y)
    np.testing.assert_allclose(inner, want.amplitude, atol=ROUNDING)
    both = jax.vmap(lambda y: spectrum(y, DURATION, SHAFT).power, 1, 1)(y)
    np.testing.assert_allclose(both, want.power, atol=ROUNDING)
    single = spectrum(jnp.asarray(y, jnp.float32), DURATION, SHAFT)
    assert single.amplitude.dtype == jnp.complex64
    assert single.power.dtype == single.order.dtype == jnp.float32


def test_spectrum_rejects_invalid_records():
    y = record()
    for wrong in (y[:-1], y[:2], 3.0):
        with pytest.raises(ValueError, match="`signal` has the shape.*even number"):
            spectrum(wrong, DURATION, SHAFT)
    with pytest.raises(ValueError, match="`duration` is 0 s"):
        spectrum(y, 0.0, SHAFT)
    with pytest.raises(ValueError, match="`shaft_frequency` is -25 Hz"):
        spectrum(y, DURATION, -SHAFT)
    for turns in (3.75, 0.5, 4.01):
        with pytest.raises(ValueError, match=f"it is {turns:g} turns.*Hann"):
            spectrum(y, turns / SHAFT, SHAFT)
        assert np.isfinite(spectrum(y, turns / SHAFT, SHAFT, window=Hann()).power).all()


def test_spectrum_rejects_unknown_window(untyped):
    with pytest.raises(TypeError, match="`window` is 'hann'"):
        spectrum(record(), DURATION, SHAFT, window="hann")  # type: ignore


def test_envelope_of_a_modulated_carrier_has_the_line_of_its_modulation():
    """Of a (1 + m cos) times a carrier, beside a strong line outside of the band."""
    count, duration, carrier, strikes = 512, 2.0, 60.0, 7.0
    time = duration * np.arange(count) / count
    swell = np.stack([1 + 0.4 * np.cos(2 * np.pi * strikes * time), 1 + 0 * time], 1)
    ringing = np.array([3.0, 0.5]) * swell * np.cos(2 * np.pi * carrier * time)[:, None]
    signal = ringing + 9.0 * np.cos(2 * np.pi * 20.0 * time)[:, None] + 5.0
    found = envelope_spectrum(signal, duration, SHAFT, (50.0, 70.0))
    size = np.abs(np.asarray(found.amplitude))
    expected = np.zeros_like(size)
    expected[0], expected[round(strikes * duration), 0] = [3.0, 0.5], 1.2
    np.testing.assert_allclose(size, expected, atol=1e-12)
    # Between the lines of the record, with Hann's window away from the ends.
    duration = 2.03
    time = duration * np.arange(count) / count
    signal = (1 + 0.4 * np.cos(2 * np.pi * strikes * time)) * np.cos(377.0 * time)
    given = signal, duration, SHAFT, (45.0, 75.0)
    size = np.abs(np.asarray(envelope_spectrum(*given, window=Hann()).amplitude))
    near = round(strikes * duration)
    _, gain = Hann().peak(*size[near - 1 : near + 2])
    assert gain * size[near] == pytest.approx(0.4, rel=0.01)


@pytest.mark.parametrize("band", [(70.0, 50.0), (0.0, 50.0), (50.0, 129.0)])
def test_envelope_spectrum_rejects_bands_outside_of_the_record(band):
    with pytest.raises(ValueError, match="`band` is .* rising .* up to 128 Hz"):
        envelope_spectrum(np.ones(512), 2.0, SHAFT, band)

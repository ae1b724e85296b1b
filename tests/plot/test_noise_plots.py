"""What plots of noise draw: curves, names and units, not pixels."""

import jax.numpy as jnp
import numpy as np
import pytest
from matplotlib.patches import Rectangle
from matplotlib.text import Text

from bearingjax import plot
from bearingjax.noise import (
    Hann,
    Line,
    Vibration,
    contact_states,
    envelope_spectrum,
    octave_bands,
    spectrum,
)
from bearingjax.noise.level import NORM


def record(turns=2, samples=256, balls=7):
    time = np.arange(turns * samples) / (25.0 * samples)
    waves = [a * np.sin(2.0 * np.pi * 400.0 * time) for a in (1.0, 3.0, 2.0)]
    load = np.ones((len(time), balls, 4))
    load[:, 0, 3] = 0.0
    load[:, 1] = 0.0
    return Vibration(
        time=jnp.asarray(time),
        displacement=jnp.zeros((len(time), 3)),
        acceleration=jnp.asarray(np.stack(waves, axis=1)),
        contact_load=jnp.asarray(load),
        azimuth=jnp.zeros((len(time), balls)),
        shaft_frequency=jnp.asarray(25.0),
        result=jnp.asarray(0, jnp.int32),
        turns=turns,
    )


def test_acceleration_over_turns():
    ax = plot.acceleration_over_time(record())
    curves = {line.get_label(): line for line in ax.lines}
    assert set(curves) == {"x", "y", "z"}
    assert np.abs(np.asarray(curves["y"].get_ydata())).max() == pytest.approx(
        3.0, rel=0.01
    )
    # The largest lies below the others.
    order = sorted(curves, key=lambda name: curves[name].get_zorder())
    assert order == ["y", "z", "x"]
    assert ax.get_xlim() == (0.0, 2.0) and ax.get_xlabel() == "turns of the shaft"
    assert ax.get_ylabel() == "acceleration [m/s²]"


def test_noise_spectrum_shows_levels_and_line_names():
    found = record()
    lines = spectrum(found.acceleration, found.duration, 25.0, window=Hann())
    size = np.sqrt(1.0 + 9.0 + 4.0)
    named = [
        Line(16.0, 400.0, float(size), "2 BPFO"),
        Line(8.0, 200.0, 0.1, "unnamed"),
        Line(8.1, 202.0, 0.1, "cage"),
    ]
    ax = plot.noise_spectrum(lines, named, reference=1e-6)
    (curve,) = (line for line in ax.lines if line.get_label() == "_spectrum")
    assert np.asarray(curve.get_ydata()).max() == pytest.approx(
        20.0 * np.log10(size / np.sqrt(2.0) / 1e-6), abs=1e-6
    )
    assert [text.get_text() for text in ax.texts] == ["cage", "2 BPFO"]
    assert ax.get_ylabel() == "level of lines [dB over 1e-06 m/s²]"
    assert ax.get_xscale() == "log" and ax.get_xlabel() == "frequency [Hz]"


@pytest.mark.parametrize("has_unit", [True, False])
def test_noise_spectrum_shows_a_measured_one_on_its_own_lines(has_unit):
    """At its level, or without unit at that of the largest calculated line."""
    found = record()
    own = np.asarray(found.acceleration)
    lines = spectrum(own, found.duration, 25.0, window=Hann())
    there = spectrum(0.1 * own[:250], 0.05, 25.0, window=Hann())
    ax = plot.noise_spectrum(lines, measured=there, has_unit=has_unit)
    curves = {line.get_label(): line for line in ax.lines}
    word = "measured" if has_unit else "measured, without unit"
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == ["calculated", word]
    above = (np.asarray(curves[w].get_ydata()).max() for w in ("calculated", word))
    (apart,) = np.diff([*above])
    assert apart == pytest.approx(-20.0 if has_unit else 0.0, abs=1.5 * has_unit)
    assert np.asarray(curves[word].get_xdata())[0] == pytest.approx(20.0)


def test_noise_envelope_names_its_lines():
    count = 512
    time = np.arange(count) / count
    signal = (1 + 0.5 * np.cos(2 * np.pi * 9 * time)) * np.cos(2 * np.pi * 99 * time)
    found = envelope_spectrum(signal, 1.0, 4.0, (80.0, 120.0))
    ax = plot.noise_envelope(found, [Line(2.25, 9.0, 0.5, "BPFO")], band=(80.0, 120.0))
    assert [text.get_text() for text in ax.texts] == ["BPFO"]
    assert ax.get_title() == "Spectrum of the envelope of 80 to 120 Hz"
    assert ax.get_xlim() == pytest.approx((0.0, 9.9))
    (curve,) = (line for line in ax.lines if line.get_label() == "_envelope")
    assert np.asarray(curve.get_ydata())[8] == pytest.approx(0.5)
    silent = envelope_spectrum(0.0 * signal, 1.0, 4.0, (80.0, 120.0))
    assert not plot.noise_envelope(silent).texts


@pytest.mark.parametrize("has_unit", [True, False])
def test_noise_envelope_shows_a_measured_one(has_unit):
    """At its size, or without unit at that of the largest calculated line."""
    time = np.arange(512) / 512

    def struck(size, rate):
        beat = 1 + 0.5 * np.cos(2 * np.pi * rate * time)
        signal = size * beat * np.cos(2 * np.pi * 99 * time)
        return envelope_spectrum(signal, 1.0, 4.0, (80.0, 120.0))

    lines, there = [Line(2.25, 9.0, 0.5, "BPFO")], struck(4.0, 8)
    ax = plot.noise_envelope(struck(1.0, 9), lines, measured=there, has_unit=has_unit)
    curves = {line.get_label(): line for line in ax.lines}
    curve = curves["measured" if has_unit else "measured, without unit"]
    assert np.asarray(curve.get_ydata())[7] == pytest.approx(2.0 if has_unit else 0.5)
    assert ax.get_ylim()[1] == pytest.approx(3.2 if has_unit else 0.8)
    assert "calculated" in curves and curve.get_zorder() < 2


def test_names_of_near_lines_do_not_lie_on_each_other():
    found = record()
    lines = spectrum(found.acceleration, found.duration, 25.0, window=Hann())
    near = [Line(1.0, 3000.0 + k, 1.0, f"{k} cage") for k in range(8)]
    ax = plot.noise_spectrum(lines, near)
    ax.figure.canvas.draw()
    boxes = [Text.get_window_extent(text) for text in ax.texts]  # without leaders
    for one, other in zip(boxes[:-1], boxes[1:], strict=True):
        assert one.x1 <= other.x0 + 1.0
    right = ax.get_window_extent().x1
    assert boxes[-1].x1 <= right + 2.0


def test_bands_stand_beside_the_norm():
    level = np.full((12, 3), 50.0)
    level[0] = np.nan
    level[:, 2] = -300.0  # nothing moves along z
    ax = plot.band_bars(octave_bands(), level, norm=NORM)
    heights = [bar.get_height() for bar in ax.patches if isinstance(bar, Rectangle)]
    assert np.isfinite(heights).sum() == 22
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert set(labels) == {"x", "y", "z", "norm"}
    assert ax.get_ylim()[0] == 0.0 and ax.get_ylim()[1] > max(NORM)
    assert ax.get_ylabel() == "level [dB over 3.1e-05 m/s²]"
    assert plot.band_bars(octave_bands(), np.full((12, 3), np.nan)) is not None


def test_contact_states_have_a_row_for_each_element():
    found = record()
    states = contact_states(found)
    ax = plot.contact_state_map(found, states)
    (image,) = ax.get_images()
    numbers = np.asarray(image.get_array())
    assert numbers.shape == (7, 512)
    assert set(numbers[0]) == {3} and set(numbers[1]) == {0} and set(numbers[2]) == {4}
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["0: 14.3 %", "1: 0 %", "2: 0 %", "3: 14.3 %", "4: 71.4 %"]
    assert image.get_extent()[:2] == [0.0, 2.0] or image.get_extent()[:2] == (0.0, 2.0)

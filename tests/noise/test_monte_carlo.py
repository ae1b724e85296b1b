"""Random bearings: sampled errors, the levels of many, and contributions of sources."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.design import Harmonics
from bearingjax.design.form_error import Surface
from bearingjax.design.tolerance import running_accuracy
from bearingjax.noise import (
    ContributionOptions,
    Hann,
    NoiseModel,
    RandomWaves,
    RecordOptions,
    SourceContributions,
    Tolerances,
    contribution_warnings,
    level,
    monte_carlo,
    octave_bands,
    sample_errors,
    sampled_model,
    source_contributions,
    spectrum,
    total_root_mean_square,
    vibration,
)

KEY = jax.random.key(3)
BEARING = bj.AngularContactBallBearing(
    7,
    0.04,
    0.008,
    contact_angle=0.3,
    outer_osculation=0.52,
    inner_osculation=0.52,
    material=bj.Material(density=7850.0),
)
MODEL = NoiseModel(
    bj.BearingElement(BEARING),
    0.2,
    [0.0, 0.0, -100.0, 0.0, 0.0, 0.0],
    bj.Speed(inner=1000.0),
    retardation=5e-6,
    tilts=False,
)
# Far below the approach of a few µm; a sixth of the levels for the larger ones.
SMALL = Tolerances(
    diameter=40e-9,
    spacing=1e-3,
    outer_axial=RandomWaves(2e-9, 5, 9),
    inner_outwards=RandomWaves(5e-9, 2, 9, 0.5),
)
HOW = RecordOptions(turns=1, settle=3, samples=128, steps=6, batch=3)


def test_waves_have_the_root_mean_square_asked_for():
    """Over 4000 surfaces: 1/√(2·4000) is 1 %; four times that."""
    waves = RandomWaves.of_root_mean_square(3e-6, 2, 6, 1.5)
    angle = jnp.asarray(0.7)
    surface = Surface(jnp.asarray(0.02), jnp.asarray(0.004))

    def height(key):
        return waves.sample(key).height(angle, surface)

    heights = jax.vmap(height)(jax.random.split(KEY, 4000))
    assert jnp.sqrt(jnp.mean(heights**2)) == pytest.approx(3e-6, rel=0.045)
    even = RandomWaves.of_root_mean_square(3e-6, 2, 6, 1.5, varies=False)
    square = 0.5 * jnp.sum(even.sample(KEY).amplitude ** 2)
    assert jnp.sqrt(square) == pytest.approx(3e-6, rel=ROUNDING)


def test_form_of_a_grade_is_seldom_exceeded():
    """Random waves of a sixth of the deviation in root mean square: peak to valley of
    most elements is within it, and of the typical one not far below."""
    found = Tolerances.of_grade("G10", BEARING)
    assert found.sources == ("diameter", "elements")
    assert found.diameter == pytest.approx(0.5e-6)
    angle = jnp.linspace(0.0, 2.0 * jnp.pi, 400)
    surface = Surface(jnp.asarray(0.004), jnp.asarray(0.004))

    def reading(key):
        height = found.elements.sample(key).height(angle, surface)
        return jnp.max(height) - jnp.min(height)

    readings = np.asarray(jax.lax.map(reading, jax.random.split(KEY, 300)))
    assert np.mean(readings > 0.25e-6) < 0.1
    assert 0.5 * 0.25e-6 < np.median(readings) < 0.25e-6


def test_runout_of_a_class():
    accuracy = running_accuracy("P5", 0.03, 0.062)
    found = Tolerances.of_grade("G10", BEARING, runout=accuracy)
    assert "inner_eccentricity" in found.sources
    draws = jax.vmap(lambda key: sample_errors(found, BEARING, key))(
        jax.random.split(KEY, 1000)
    )
    (wave,) = draws.errors.inner.outwards
    assert isinstance(wave, Harmonics)
    # Rayleigh: exp(-9/2) = 1.1 % of all are beyond three standard deviations.
    beyond = float(jnp.mean(wave.amplitude > 0.5 * accuracy.inner))
    assert 0.003 < beyond < 0.03


def test_sample_errors_scales_each_source_alone():
    one = sample_errors(SMALL, BEARING, KEY)
    other = sample_errors(
        SMALL.scale({"diameter": 0.0, "outer_axial": 3.0}), BEARING, KEY
    )
    assert np.all(other.diameter == 0.0)
    diameter = np.asarray(one.diameter)
    assert np.max(np.abs(diameter)) <= 20e-9
    assert np.ptp(diameter) > 5e-9
    np.testing.assert_array_equal(one.azimuth, other.azimuth)
    (wave,), (larger,) = one.errors.outer.axial, other.errors.outer.axial
    assert isinstance(wave, Harmonics) and isinstance(larger, Harmonics)
    np.testing.assert_allclose(larger.amplitude, 3.0 * wave.amplitude, rtol=ROUNDING)
    np.testing.assert_array_equal(larger.phase, wave.phase)


@pytest.mark.slow
def test_levels_are_those_of_each_bearing_alone():
    """Four bearings in batches of three: the last batch is filled up."""
    seen = []
    found = monte_carlo(
        MODEL, SMALL, 4, KEY, progress=lambda *a: seen.append(a), records=HOW
    )
    assert seen == [(3, 4), (4, 4)]
    assert found.level.shape == (4, 3) and found.n_failed == 0
    assert found.bands.shape == (4, len(octave_bands().centre), 3)
    alone = vibration(
        sampled_model(MODEL, SMALL, found.keys[3]),
        turns=1,
        settle=3,
        samples=128,
        steps=6,
    )
    lines = spectrum(
        alone.acceleration,
        alone.duration,
        alone.shaft_frequency,
        window=Hann(),
    )
    expected = level(total_root_mean_square(lines))
    # dB of a small difference of large forces.
    np.testing.assert_allclose(found.level[3], expected, atol=1e-5)
    middle = found.percentile(50.0)
    assert np.all(middle < jnp.max(found.level, axis=0))


@pytest.mark.slow
def test_source_contributions_by_switching_off_and_by_gradient_agree_for_small_errors():
    found = source_contributions(MODEL, SMALL, 6, KEY, records=HOW)
    assert found.used == 6 and found.sources == SMALL.sources
    assert found.ranking == found.ranking_by_gradient
    # Of six bearings the sources' motions are not quite independent of each other.
    share, slope = np.asarray(found.share), np.asarray(found.by_gradient)
    np.testing.assert_allclose(share, slope, atol=0.03 * np.max(share))
    assert np.argmax(found.gain(0.5)) == SMALL.sources.index(found.ranking[0])
    np.testing.assert_allclose(found.gain_together({}), 0.0, atol=1e-12)
    first = found.ranking[0]
    np.testing.assert_allclose(
        found.gain_together({first: 0.5}), np.max(found.gain(0.5)), rtol=ROUNDING
    )
    options = ContributionOptions(factor=0.5, gradient=False)
    half = source_contributions(MODEL, SMALL, 6, KEY, records=HOW, options=options)
    assert half.ranking == found.ranking
    assert half.by_gradient is None


@pytest.mark.slow
def test_source_contributions_along_a_line_and_by_band():
    bands, how = octave_bands(), dataclasses.replace(HOW, turns=4)
    options = ContributionOptions((0, 0, 2.0), bands, gradient=False)
    found = source_contributions(MODEL, SMALL, 3, KEY, records=how, options=options)
    # From the first of five bearings whose records without any change are at hand.
    records, shares = [], []
    counts = {k: getattr(how, k) for k in ("turns", "settle", "samples", "steps")}
    levels = monte_carlo(
        MODEL, SMALL, 5, KEY, records=how, on_records=lambda *r: records.append(r)
    )
    alone = {"records": how, "options": ContributionOptions(2, gradient=False)}
    axial = source_contributions(
        MODEL, SMALL, 3, levels.keys[:3], **alone,
        unchanged=records, progress=lambda *done: shares.append(done),
    )  # fmt: skip
    assert [len(r) for _, r in records] == [3, 2]
    n_runs = len(SMALL.sources)
    assert shares == [(3 * k, 3 * n_runs) for k in range(1, n_runs + 1)]
    np.testing.assert_allclose(found.share, axial.share, rtol=ROUNDING)
    assert axial.by_band is None
    with pytest.raises(ValueError, match="has 2 records; it needs 3"):
        source_contributions(MODEL, SMALL, 3, KEY, **alone, unchanged=records[1:])
    with pytest.raises(ValueError, match="has 2 keys; it must have 3"):
        source_contributions(MODEL, SMALL, 3, levels.keys[:2], **alone)
    every = [sampled_model(MODEL, SMALL, k) for k in jax.random.split(KEY, 3)]
    heard = np.array([vibration(m, **counts).acceleration[:, 2] for m in every])
    square = heard.var(axis=1)
    np.testing.assert_allclose(found.mean_square, square.mean(), rtol=1e-9)
    parts = np.asarray(found.by_band)
    assert parts.shape == (len(found.sources), len(bands.centre))
    held = np.isfinite(parts[0])
    assert held.any() and not held.all() and np.all(parts[:, held] <= 1.0)
    with pytest.raises(ValueError, match="a vector or None"):
        ContributionOptions(direction=3)


def test_contribution_warnings_for_products_of_sources():
    """Mean square 1 of a product of two sources: nothing goes without either."""
    parts = {"outer_axial": 0.0, "inner_axial": 0.0, "diameter": 1.0}
    found = SourceContributions(
        jnp.asarray(1.0), jnp.array([*parts.values()]), jnp.full(3, 0.01), None, None,
        jnp.asarray(0.0), 6, tuple(parts),
    )  # fmt: skip
    assert found.total_share == 2.0
    (told,) = contribution_warnings(found)
    assert told.startswith("parts of the sources sum to 200 % of the mean square")
    alone = dataclasses.replace(found, smaller=jnp.array([0.0, 1.0, 1.0]))
    assert contribution_warnings(alone) == []


def test_monte_carlo_rejects_invalid_tolerances():
    with pytest.raises(ValueError, match="room between two neighbours"):
        monte_carlo(MODEL, Tolerances(spacing=1.0), 2, KEY, records=HOW)
    with pytest.raises(ValueError, match="no source 'elements'"):
        SMALL.scale({"elements": 0.0})
    with pytest.raises(ValueError, match="first order, or more"):
        RandomWaves(1e-6, 5, 4)
    with pytest.raises(ValueError, match="without a source"):
        source_contributions(MODEL, Tolerances(), 2, KEY, records=HOW)
    for keys in (jax.random.split(KEY, 3), jax.random.split(jax.random.PRNGKey(3), 3)):
        with pytest.raises(ValueError, match="has 3 keys; it must have 2"):
            source_contributions(MODEL, SMALL, 2, keys, records=HOW)

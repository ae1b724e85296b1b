"""Levels of accelerations and their sums.

Source: Kurushin, Kurushin, Zhilnikov, Murashkin, Vestnik SGAU (2011), tables 1 and 2
and the accelerations that follow from its printed levels.
"""

import jax
import numpy as np
import pytest
from measured_levels import MEASURED, TOTAL
from tolerances import DIFFERENCE, ROUNDING

from bearingjax import noise
from bearingjax.noise.level import LOWEST_LEVEL, NORM, REFERENCE_ACCELERATION


def test_accelerations_of_the_printed_levels():
    levels = np.array([73.3, 75.0, 78.0, 80.0, 90.8])
    found = noise.acceleration_of(levels)
    np.testing.assert_allclose(found, [0.1433, 0.1743, 0.2462, 0.31, 1.0749], atol=5e-5)
    np.testing.assert_allclose(noise.level(found), levels, rtol=ROUNDING)
    assert REFERENCE_ACCELERATION == 0.31e-4
    # The cage over the ring: 15.8 dB are a factor of 6.2, not of ten as printed.
    np.testing.assert_allclose(found[4] / found[1], 6.17, atol=5e-3)


def test_combined_octave_levels_match_paper_totals():
    bands = np.array(list(MEASURED.values()), dtype=float)
    assert bands.shape == (7, len(NORM))
    sums = noise.combine_levels(np.array([NORM, *bands], dtype=float))
    want = [79.59, 77.26, 77.75, 77.74, 78.02, 77.16, 76.89, 76.91]
    np.testing.assert_allclose(sums, want, atol=5e-3)  # printed digits
    printed = [TOTAL["serial"], *(TOTAL[name] for name in MEASURED)]
    assert abs(sums - np.array(printed)).max() < 0.8


def test_sums_of_levels():
    np.testing.assert_allclose(
        noise.combine_levels(np.array([70.0, 70.0])), 70 + 10 * np.log10(2.0)
    )
    np.testing.assert_allclose(noise.combine_levels(np.array([61.0])), 61.0)
    # Sizes whose powers overflow, and silence beside sound.
    np.testing.assert_allclose(
        noise.combine_levels(np.array([[5000.0, 5000.0], [LOWEST_LEVEL, 40.0]])),
        [5000 + 10 * np.log10(2.0), 40.0],
    )
    assert np.isnan(noise.combine_levels(np.array([np.nan, 40.0])))


def test_level_at_and_near_zero():
    sizes = np.array([0.0, 1e-21, 1e-19, 0.31e-4])
    found, slope = jax.vmap(jax.value_and_grad(noise.level))(sizes)
    want = 20 * np.log10(1e-19 / 0.31e-4)
    np.testing.assert_allclose(found, [LOWEST_LEVEL, LOWEST_LEVEL, want, 0], atol=1e-9)
    np.testing.assert_allclose(
        slope, [0, 0, *(20 / np.log(10) / sizes[2:])], rtol=ROUNDING
    )
    assert np.isnan(noise.level(-1.0)) and np.isnan(noise.level(np.nan))
    # In float32 the least number that has a level is no subnormal one.
    assert noise.level(np.float32(1e-19)) > LOWEST_LEVEL


def test_another_reference():
    by_iso = noise.level(1.0, 1e-6)
    assert by_iso == 120.0
    np.testing.assert_allclose(noise.acceleration_of(by_iso, 1e-6), 1.0)
    for reference in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="`reference`.*m/s²"):
            noise.level(1.0, reference)
        with pytest.raises(ValueError, match="`reference`.*m/s²"):
            noise.acceleration_of(1.0, reference)


def test_derivatives_of_levels():
    def loudness(parts):
        return noise.combine_levels(noise.level(noise.acceleration_of(parts)))

    parts = np.array([60.0, 71.0, 68.0])
    way, step = np.array([0.3, -1.0, 0.7]), 1e-4
    slope = jax.grad(loudness)(parts) @ way
    difference = (
        (loudness(parts + step * way) - loudness(parts - step * way)) / 2 / step
    )
    np.testing.assert_allclose(slope, difference, rtol=DIFFERENCE)

"""Levels of accelerations and their sums.

Published ones are the validation cases `kurushin_levels` and `kurushin_accelerations`.
"""

import jax
import numpy as np
import pytest
from tolerances import DIFFERENCE, ROUNDING

from bearingjax import noise
from bearingjax.noise.level import LOWEST_LEVEL, REFERENCE_ACCELERATION


def test_accelerations_of_levels():
    levels = np.array([73.3, 90.8])
    np.testing.assert_allclose(
        noise.level(noise.acceleration_of(levels)), levels, rtol=ROUNDING
    )
    assert REFERENCE_ACCELERATION == 0.31e-4


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

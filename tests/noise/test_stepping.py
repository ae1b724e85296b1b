"""Samples of a motion: what is too fast for them is cut, the rest passes."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE

from bearingjax.noise.dynamics.stepping import HELD, REACH, step_motion

STEPS, SAMPLES = 64, 3 * REACH


@pytest.fixture(scope="module")
def swinging():
    """Acceleration of an oscillator of a frequency per sample, sampled."""

    @jax.jit
    def run(frequency):
        omega2 = (2.0 * jnp.pi * frequency) ** 2
        start = jnp.array([1.0]), jnp.array([0.0])
        step = jnp.asarray(1.0 / STEPS)
        moved = step_motion(lambda x, v, t: -omega2 * x, start, step, STEPS, SAMPLES)
        # From when on the start, before which all is zero, counts no more.
        return moved.acceleration[REACH:, 0] / omega2, moved.motion[REACH:, 0]

    return run


@pytest.mark.parametrize("frequency", [0.01, 0.2, 0.5 * HELD])
def test_stepped_acceleration_passes_low_frequencies(swinging, frequency):
    acceleration, motion = swinging(frequency)
    np.testing.assert_allclose(acceleration, -motion, rtol=0, atol=DIFFERENCE)


@pytest.mark.parametrize("frequency", [0.5, 0.7, 1.0, 1.3, 3.7])
def test_stepped_acceleration_cuts_aliased_frequencies(swinging, frequency):
    acceleration, motion = swinging(frequency)
    assert np.max(np.abs(motion)) > 0.5
    assert np.max(np.abs(acceleration)) < DIFFERENCE

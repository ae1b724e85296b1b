"""Levels in dB of accelerations, and sums of levels."""

import math
from typing import Any

import jax
import jax.numpy as jnp

from ..design.checks import positive
from ..numerics.compiled.programs import program
from ..numerics.types import Reals, as_real

REFERENCE_ACCELERATION = 0.31e-4
"""Acceleration of 0 dB on the rigs for bearing noise of the source [m/s²].

Source: Kurushin, Kurushin, Zhilnikov, Murashkin, Vestnik SGAU (2011), which prints it
    in m/s. The reference of ISO 1683 is 1e-6 m/s², 29.8 dB lower.
"""

NORM = (23.0, 24.0, 25.0, 46.0, 36.0, 44.0, 49.0, 54.0, 64.0, 68.0, 77.0, 75.0)
"""Largest allowed level in each octave band from 4 Hz to 8 kHz of the four-point ball
bearing 85-176211D1 at 1500 rev/min, over `REFERENCE_ACCELERATION` [dB].

Source: Kurushin et al. (2011), table 1.
"""

LOWEST_LEVEL = -300.0
"""Level of accelerations below 1e-15 of the reference, zero included [dB]."""


def level(acceleration: Any, reference: Any = REFERENCE_ACCELERATION) -> Reals:
    """Return the level L = 20 lg(a/a₀) of an acceleration [dB].

    Args:
        acceleration: Root mean square of an acceleration, or its amplitude; the level
            is of the same kind (...) [m/s²].
        reference: Acceleration a₀ of 0 dB, above zero [m/s²].

    Returns:
        Levels (...). At and near zero, where the logarithm has no bound, the level
        stays at `LOWEST_LEVEL` and its derivative is zero. A negative acceleration has
        the level NaN.

    Raises:
        ValueError: If the reference is not above zero.

    Source: Kurushin et al. (2011); ISO 1683.
    """
    positive("level", "reference", reference, "m/s²")
    return _level(as_real(acceleration), as_real(reference))


@program(quick=True)
def _level(acceleration, reference):
    ratio = acceleration / reference
    ratio = jnp.where(ratio < 0, jnp.nan, ratio)
    lowest = 10.0 ** (LOWEST_LEVEL / 20.0)
    # In two steps: the branch that is not taken must not divide by zero.
    held = ratio < lowest
    return jnp.where(held, LOWEST_LEVEL, 20.0 * jnp.log10(jnp.where(held, 1.0, ratio)))


def acceleration_of(level: Any, reference: Any = REFERENCE_ACCELERATION) -> Reals:
    """Return the acceleration a = a₀ 10^(L/20) of a level [m/s²].

    Args:
        level: Level (...) [dB].
        reference: Acceleration a₀ of 0 dB, above zero [m/s²].

    Raises:
        ValueError: If the reference is not above zero.
    """
    positive("acceleration_of", "reference", reference, "m/s²")
    return reference * 10.0 ** (as_real(level) / 20.0)


def combine_levels(levels: Any) -> Reals:
    """Return the sum of incoherent levels, 10 lg Σ 10^(L/10) [dB].

    The parts are of different frequencies, or without relation to each other: their
    mean squares add.

    Args:
        levels: Level of each part (..., part) [dB]; one that is NaN makes NaN.

    Returns:
        Level of the sum (...).
    """
    scale = 10.0 / math.log(10.0)
    return scale * jax.nn.logsumexp(as_real(levels) / scale, axis=-1)

"""Smooth maxima and minima of many samples.

They are p-norms, differentiable wherever the peak lies. A smooth maximum is never below
the true maximum of the samples, and above it by a factor of at most
(number of samples)^(1/exponent). A smooth minimum is never above the true minimum, and
below it by at most the same factor.
"""

import jax
import jax.numpy as jnp

from ..numerics.types import Reals, Scalar

SMOOTHING_EXPONENT = 64.0
"""Default exponent: with 100 samples near a peak the maximum comes out 7 % above it."""


def smooth_maximum(values: Reals, exponent: float = SMOOTHING_EXPONENT) -> Scalar:
    """p-norm of numbers ≥ 0: max ≤ result ≤ count^(1/exponent) max.

    Args:
        values: Numbers of at least 0 [any unit].
        exponent: p, above 1. Static.

    Returns:
        The norm, in the unit of `values`; 0 with derivative 0 if all are 0.
    """
    top = jax.lax.stop_gradient(jnp.max(values))
    none = top <= 0
    share = values / jnp.where(none, 1.0, top)
    total = jnp.where(none, 1.0, jnp.sum(share**exponent))
    return top * total ** (1.0 / exponent)


def smooth_minimum(values: Reals, exponent: float = SMOOTHING_EXPONENT) -> Scalar:
    """Norm of order -p of numbers > 0: min/count^(1/exponent) ≤ result ≤ min.

    Args:
        values: Numbers [any unit]; if one is not above 0, or all are infinite, the
            result is the minimum.
        exponent: p, above 1. Static.
    """
    low = jax.lax.stop_gradient(jnp.min(values))
    none = (low <= 0) | jnp.isinf(low)
    share = low / jnp.where(none, 1.0, values)
    total = jnp.where(none, 1.0, jnp.sum(share**exponent))
    return jnp.where(none, jnp.min(values), low * total ** (-1.0 / exponent))


def largest(values: Reals) -> Scalar:
    """The largest number, with the derivative of the first such entry alone.

    The derivative of `jnp.max` is shared by all entries that equal the maximum; where a
    compiled program rounds the entries and the maximum unlike, there are none, and it
    is 0/0.

    Args:
        values: Numbers [any unit].
    """
    flat = jnp.ravel(values)
    return flat[jnp.argmax(jax.lax.stop_gradient(flat))]


def smallest(values: Reals) -> Scalar:
    """The smallest number, as `largest`.

    Args:
        values: Numbers [any unit].
    """
    return -largest(-values)

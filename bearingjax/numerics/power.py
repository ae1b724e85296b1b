"""Positive-part powers x₊^(k/d) that stay finite under differentiation.

The contact laws are powers 10/9 (line) and 3/2 (point) of the approach. `pow` is
the hot spot of a bearing evaluation, so the ninth root is written out: a seed from
the bits of the number, then a series step on the inverse root.
"""

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array

from .types import Reals

# The bits of a float, read as an integer, are a piecewise linear log2. The seed of
# x^(-1/9) is therefore `magic - bits/9`; `magic` balances the seed's relative error.
_EXPONENT_BITS = {jnp.dtype("float32"): 23, jnp.dtype("float64"): 20}
_BIAS = {jnp.dtype("float32"): 127, jnp.dtype("float64"): 1023}
_BALANCE = 0.0450466


def _inverse_root_seed(x: Array) -> Array:
    """x^(-1/9) to three per cent, from the bits of x > 0."""
    bits = _EXPONENT_BITS[x.dtype]
    if x.dtype == jnp.float64:
        # The upper half holds sign, exponent and 20 bits of mantissa: enough.
        high = lax.shift_right_logical(
            lax.bitcast_convert_type(x, jnp.uint64), jnp.uint64(32)
        ).astype(jnp.int32)
    else:
        high = lax.bitcast_convert_type(x, jnp.int32)
    magic = (_BIAS[x.dtype] - _BALANCE) * (10.0 / 9.0) * 2.0**bits
    # Conversion through floating point: an integer division does not vectorise.
    real = x.dtype
    seed = (jnp.asarray(magic, real) - high.astype(real) * (1.0 / 9.0)).astype(
        jnp.int32
    )
    if x.dtype == jnp.float64:
        wide = lax.shift_left(seed.astype(jnp.uint64), jnp.uint64(32))
        return lax.bitcast_convert_type(wide, jnp.float64)
    return lax.bitcast_convert_type(seed, jnp.float32)


def ninth_root(x: Reals) -> Reals:
    """Ninth root of positive normal numbers, to 3e-15 (float32: 1.5e-6) relative.

    Two steps of the series (1 - e)^(-1/9) on y ≈ x^(-1/9) with e = 1 - x y⁹.

    Args:
        x: Positive, normal numbers [1]. Zero, negative and subnormal numbers give
            meaningless finite values or NaN: mask the argument.

    Returns:
        x^(1/9), same dtype. NaN in, NaN out.
    """
    y = _inverse_root_seed(x)

    def residual(y):
        y3 = y * y * y
        return 1.0 - x * (y3 * y3 * y3)

    e = residual(y)
    # (1 - e)^(-1/9) = 1 + e/9 + 5 e²/81 + 95 e³/2187 + 665 e⁴/19683 + ...
    y = y * (
        1.0
        + e
        * (
            1 / 9
            + e * (5 / 81 + e * (95 / 2187 + e * (665 / 19683 + e * (4921 / 177147))))
        )
    )
    e = residual(y)
    y = y * (1.0 + e * (1 / 9 + e * (5 / 81 + e * (95 / 2187))))
    # The division ends a kernel: products alone XLA would repeat for every use of the
    # root, which doubled the time of a contact.
    return 1.0 / y


@partial(jax.custom_jvp, nondiff_argnums=(1, 2))
def positive_power(x: Reals, numerator: int, denominator: int) -> Reals:
    """max(x, 0)^(numerator/denominator), safe to differentiate.

    Where x ≤ 0 value and all derivatives are zero: the argument is masked as well
    as the result, so that nothing infinite is multiplied by zero. Just above zero a
    derivative of negative exponent is large, as it truly is. The mask is "not
    x ≤ 0", so that NaN passes through instead of counting as open.

    Args:
        x: Base, of any unit.
        numerator: Integer k of the exponent k/d.
        denominator: Integer d of the exponent; 9 and 2 have fast roots.

    Returns:
        Power, same shape and dtype as `x`.
    """
    open_ = x <= 0
    tiny = jnp.finfo(x.dtype).tiny
    base = jnp.where(open_, 1.0, jnp.where(x < tiny, tiny, x))
    whole, part = divmod(numerator, denominator)
    if part == 0:
        power = _integer_power(base, whole)
    elif denominator == 9:
        power = _integer_power(base, whole) * _integer_power(ninth_root(base), part)
    elif denominator == 2:
        power = _integer_power(base, whole) * jnp.sqrt(base)
    else:
        power = base ** (numerator / denominator)
    return jnp.where(open_, 0.0, power)


@positive_power.defjvp
def _positive_power_jvp(numerator, denominator, primals, tangents):
    (x,), (dx,) = primals, tangents
    value = positive_power(x, numerator, denominator)
    if numerator == 0:
        return value, jnp.zeros_like(dx)
    slope = positive_power(x, numerator - denominator, denominator)
    return value, (numerator / denominator) * slope * dx


def smooth_power(x: Reals, exponent: float, scale: float) -> Reals:
    """|x|^exponent, made smooth at x = 0 where the true power has no derivative.

    scale^exponent·y²·(1 + y²)^(exponent/2 - 1) with y = x/scale: the power itself to
    1e-8 above 1e4 scales, a parabola near zero.

    Args:
        x: Base, of any unit.
        exponent: At most 2. Static.
        scale: End of the parabola, unit of `x`.
    """
    square = (x / scale) ** 2
    return scale**exponent * square * (1.0 + square) ** (0.5 * exponent - 1.0)


def _integer_power(x: Array, n: int) -> Array:
    if n < 0:
        return 1.0 / _integer_power(x, -n)
    if n == 0:
        return jnp.ones_like(x)
    if n == 1:
        return x
    half = _integer_power(x, n // 2)
    return half * half * x if n % 2 else half * half

"""Elliptic integrals, smooth through the circular limit, to round-off.

Complete integrals by the arithmetic-geometric mean, Carlson's R_D by duplication. All
take the ratio of the axes instead of a modulus, so that no difference of nearly equal
numbers is taken and either axis may be the longer one.
"""

import jax.numpy as jnp

from .types import Reals

# Enough for ratios from 1e-8 to 1e8 (mean) and for a zero argument (duplication).
_MEANS = 8
_DUPLICATIONS = 7


def complete(ratio: Reals) -> tuple[Reals, Reals, Reals]:
    """Complete elliptic integrals K, B and D for the complementary modulus `ratio`.

    With Δ² = 1 - (1 - ratio²) sin²θ, over a quarter turn: K = ∫ dθ/Δ,
    B = ∫ cos²θ dθ/Δ, D = ∫ sin²θ dθ/Δ. Then K = B + D and E = B + ratio² D.

    Args:
        ratio: k' > 0, above one as well [1]. Within a factor 1e8 of one.

    Returns:
        K, B, D [1], each of the shape of `ratio`, to 1e-14 relative.

    Source: Gauss's arithmetic-geometric mean; Abramowitz & Stegun 17.6, with the
        differences c_n² divided by the parameter m = 1 - ratio² from the start.
    """
    mean, other = 0.5 * (1.0 + ratio), jnp.sqrt(ratio)
    difference = 0.5 * (1.0 - ratio)
    # share = c_n²/m
    share = (1.0 - ratio) / (4.0 * (1.0 + ratio))
    total, weight = 0.5 + share, 1.0
    for _ in range(_MEANS):
        mean, other = 0.5 * (mean + other), jnp.sqrt(mean * other)
        weight *= 2.0
        share = share * (difference / (4.0 * mean)) ** 2
        difference = difference * (difference / (4.0 * mean))
        total = total + weight * share
    k = 0.5 * jnp.pi / mean
    d = k * total
    return k, k - d, d


def carlson_rd(x: Reals, y: Reals, z: Reals) -> Reals:
    """Carlson's R_D(x, y, z) = 3/2 ∫₀^∞ dt / ((t + z) sqrt((t+x)(t+y)(t+z))).

    Args:
        x, y: Not negative, at most one of them zero.
        z: Positive.

    Returns:
        R_D, unit of the arguments to the power -3/2.

    Source: B. C. Carlson, Numerical computation of real or complex elliptic
        integrals, Numerical Algorithms 10 (1995), algorithm for R_D.
    """
    start = (x + y + 3.0 * z) / 5.0
    dx, dy = start - x, start - y
    mean, total, weight = start, jnp.zeros_like(start), 1.0
    for _ in range(_DUPLICATIONS):
        sx, sy, sz = jnp.sqrt(x), jnp.sqrt(y), jnp.sqrt(z)
        step = sx * sy + sy * sz + sz * sx
        total = total + weight / (sz * (z + step))
        weight *= 0.25
        x, y, z = (0.25 * (v + step) for v in (x, y, z))
        mean = 0.25 * (mean + step)
    dx, dy = weight * dx / mean, weight * dy / mean
    dz = -(dx + dy) / 3.0
    xy, zz = dx * dy, dz * dz
    e2, e3, e4, e5 = (
        xy - 6 * zz,
        (3 * xy - 8 * zz) * dz,
        3 * (xy - zz) * zz,
        xy * zz * dz,
    )
    series = (
        1.0
        - 3 * e2 / 14
        + e3 / 6
        + 9 * e2 * e2 / 88
        - 3 * e4 / 22
        - 9 * e2 * e3 / 52
        + 3 * e5 / 26
    )
    return weight * series / (mean * jnp.sqrt(mean)) + 3.0 * total

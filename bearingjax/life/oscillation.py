"""Fatigue of the raceways of an oscillating bearing, relative to full rotation.

The amplitude θ is half of the swing, which goes from -θ to θ and back: 4θ in a cycle.
Lives count this path in revolutions, 2θ/π for each cycle. Where the raceways fatigue as
in rotation the oscillation factor is thus Harris's 90°/θ.

A raceway survives with ln 1/S ∝ ∫ D^e dφ (Lundberg and Palmgren), where D is the sum of
x^p over the rolling elements that pass a point, and x their load over that of a million
revolutions. In rotation D is the mean of x^p over the circumference on the ring that
turns relative to the load, and x^p at the point on the other. In an oscillation

- D on the ring that turns relative to the load is the mean from φ - θ to φ + θ
  (Houpert), with the load of each element over its part of the circumference, as in the
  sums of ISO/TS 16281: θ = π is rotation, a small θ a ring at rest, and no load zone
  parameter is needed;
- only arcs of θ (1 ∓ γ)/2 to both sides of each element's place are overrolled. Of the
  c = θ/θ_c arcs that cover a point on average, θ_c = 2π/(Z (1 ∓ γ)), k = ⌊c⌋ or k + 1
  lie there if the places never change. The mean of D^e is then
  ((1 - c + k) k^e + (c - k) (k + 1)^e)/c^e of that of evenly spread passes, c^(1 - e)
  below the critical amplitude θ_c (Rumbarger).

The product of both agrees with rolling elements followed one by one over the swing
within 4 % for 7 elements and 1 % for 20; it is exact on the ring that keeps the load.

Sources: Lundberg and Palmgren (1947); Harris, Rumbarger and Butterfield (2009, NREL
    DG03); Houpert (1999); Houpert and Menck (2022), J. Tribol. 144, 071601.
"""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design import AbstractBearing
from ..numerics.power import positive_power
from ..numerics.types import Scalar

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def critical_amplitudes(bearing: AbstractBearing, angle: Scalar) -> Float[Array, "2"]:
    """Return the critical amplitudes θ_c of outer and inner raceway [rad], below which
    no rolling element reaches the track of the next one.

    Args:
        bearing: A bearing of one row.
        angle: Nominal contact angle [rad].
    """
    gamma = bearing.element_diameter * jnp.cos(angle) / bearing.pitch_diameter
    parts = jnp.stack([1.0 - gamma, 1.0 + gamma])
    return 2.0 * jnp.pi / (bearing.n_elements * parts)


def arc_factor(covering: Float[Array, "2"], power: float) -> Float[Array, "2"]:
    """Return the mean of D^e over that of evenly spread passes (2,) [1].

    Args:
        covering: Average number c of arcs over a point (2,) [1].
        power: Exponent e.
    """
    whole = jnp.floor(covering)
    part = covering - whole
    mean = (1.0 - part) * whole**power + part * (whole + 1.0) ** power
    return mean / covering**power


def mean_of_swing(
    wear: Float[Array, "element 2 track"],
    count: Scalar | int,
    amplitude: Scalar,
    spread: tuple[int, int],
) -> Float[Array, "2 track"]:
    """Return the mean of D^e over a ring that swings relative to the load [1].

    Args:
        wear: x^p of each rolling element [1]; zero in empty places.
        count: Number of rolling elements.
        amplitude: Amplitude θ, above zero [rad].
        spread: Exponent e as a fraction, numerator and denominator.
    """
    turn, count = 2.0 * jnp.pi, jnp.asarray(count, wear.dtype)
    step = turn / count
    place = jnp.arange(wear.shape[0], dtype=wear.dtype)
    first = jnp.mod(amplitude, step)
    first = jnp.minimum(first, step - first)

    def upto(t):
        """Return the length up to t of the first element's part, one in each turn."""
        return step * jnp.floor(t / turn) + jnp.minimum(jnp.mod(t, turn), step)

    def swept(offset):
        apart = step * (place[:, None] - place[None]) + offset
        weight = (upto(apart + amplitude) - upto(apart - amplitude)) / (2 * amplitude)
        return jnp.einsum("kj,jrt->krt", weight, wear)

    def mean(a, b):  # D is linear from edge to edge
        parts = zip(0.5 + 0.5 * _NODES, 0.5 * _WEIGHTS, strict=True)
        return sum(w * positive_power(a + t * (b - a), *spread) for t, w in parts)

    one, other, last = swept(first), swept(step - first), swept(step + first)
    parts = (step - 2 * first) * mean(one, other) + 2 * first * mean(other, last)
    there = (place < count)[:, None, None]
    return jnp.sum(jnp.where(there, parts, 0.0), axis=0) / turn

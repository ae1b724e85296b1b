"""Fatigue of a bearing that oscillates: what its raceways bear in place of a turn.

The amplitude θ is half of the whole swing, -θ to θ and back, a way of 4θ in a cycle.
Lives count that way in revolutions, 2θ/π a cycle: where the raceways tire as in a turn
the oscillation factor is Harris's 90°/θ.

A raceway survives with ln 1/S ∝ ∫ D^e dφ (Lundberg and Palmgren), D the sum of x^p over
the rolling elements that pass a point, x their load over that of a million revolutions.
In a turn D is the mean of x^p over the circumference on the ring that turns against the
load, and x^p at the point on the other. In an oscillation

- D on the ring that turns against the load is the mean from φ - θ to φ + θ (Houpert),
  each load for its element's part of the circumference, as in the sums of ISO/TS 16281:
  θ = π is a turn, a small θ a ring at rest, and no load zone parameter is needed;
- arcs of θ (1 ∓ γ)/2 to both sides of the elements' places bear the passes. Of the
  c = θ/θ_c arcs over a point in the mean, θ_c = 2π/(Z (1 ∓ γ)), k = ⌊c⌋ or k + 1 lie
  there if the places stay for life: the mean of D^e is
  ((1 - c + k) k^e + (c - k) (k + 1)^e)/c^e of the even one, c^(1 - e) below the
  critical amplitude θ_c (Rumbarger).

Against 7 rolling elements followed one by one over the swing the product is within 4 %
of the share, against 20 within 1 %; exact on the ring that keeps the load.

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
    """θ_c below which no rolling element reaches the next one's track [rad].

    Args:
        bearing: A single row.
        angle: Nominal contact angle [rad].
    """
    gamma = bearing.element_diameter * jnp.cos(angle) / bearing.pitch_diameter
    parts = jnp.stack([1.0 - gamma, 1.0 + gamma])
    return 2.0 * jnp.pi / (bearing.n_elements * parts)


def arc_factor(covering: Float[Array, "2"], power: float) -> Float[Array, "2"]:
    """Mean of D^e under `covering` arcs c over that of even passes, e = `power` [1]."""
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
    """Mean of D^e over a ring that swings against the load.

    Args:
        wear: x^p of every rolling element; zero in empty places.
        count: Number of rolling elements.
        amplitude: θ, above zero [rad].
        spread: e as a fraction.
    """
    turn, count = 2.0 * jnp.pi, jnp.asarray(count, wear.dtype)
    step = turn / count
    place = jnp.arange(wear.shape[0], dtype=wear.dtype)
    first = jnp.mod(amplitude, step)
    first = jnp.minimum(first, step - first)

    def upto(t):
        """Length of the first element's part, repeated every turn, up to t."""
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

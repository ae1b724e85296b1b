"""Fatigue of a bearing that oscillates: what its raceways bear in place of a turn.

The amplitude θ is half of the whole swing: one ring goes from -θ to +θ against the
other and back, a way of 4θ in a cycle. Lives and damage count that way in revolutions,
2θ/π a cycle, so that the oscillation factor of the literature, cycles of oscillation
over revolutions that a raceway bears, is a_osc = (π/2θ) (share/share of a turn)^(-1/e):
Harris's 90°/θ where the shares are alike.

After Lundberg and Palmgren a raceway survives with ln 1/S ∝ ∫ D^e dφ, where D is the
sum of x^p over the rolling elements that pass a point of it, x the load over that of a
million revolutions. Of a turn D is, on a ring that turns against the load, the mean of
x^p over the circumference, and on the other one x^p at the point. Two things change in
an oscillation:

- A point of the ring that turns against the load meets no more than 2θ of the load
  zone: D is the mean of x^p from φ - θ to φ + θ (Houpert). The loads are those of the
  rolling elements where they stand, each for its part of the circumference, as in the
  sums of ISO/TS 16281; so half a turn either way is a turn, and a small θ is as a ring
  that does not turn against the load. No load zone parameter is needed.
- A rolling element rolls over an arc of θ (1 ∓ γ)/2 to both sides of its place on the
  outer or inner ring. c = θ/θ_c of these arcs lie over a point in the mean, with the
  critical amplitude θ_c = 2π/(Z (1 ∓ γ)). The places are taken as the same for life:
  k or k + 1 arcs lie over a point, k = ⌊c⌋. The mean of D^e is then
  ((1 - c + k) k^e + (c - k) (k + 1)^e)/c^e of the even one: c^(1 - e) below the
  critical amplitude, where part of the raceway bears nothing (Rumbarger), and at most
  1 % more than 1 above.

The product of both is within 4 % of the share of 7 rolling elements followed one by
one over the swing, 1 % of 20; on a ring that does not turn against the load it is exact
(`tests/life/test_oscillation.py`). Below the critical amplitude life goes with θ^-0.9
of balls and θ^(-8/9) of rollers: load factors θ^(3/10) and θ^(2/9), as NREL DG03 has.

Sources: Lundberg and Palmgren (1947); Harris, Rumbarger and Butterfield (2009, NREL
    DG03); Houpert (1999); Houpert and Menck (2022), J. Tribol. 144, 071601.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from ..design import AbstractBearing
from ..numerics.power import positive_power
from ..numerics.types import Scalar


def critical_amplitudes(bearing: AbstractBearing, angle: Scalar) -> Float[Array, "2"]:
    """Amplitudes below which rolling elements do not reach each other's tracks.

    Args:
        bearing: A single row.
        angle: Nominal contact angle α [rad].

    Returns:
        θ_c on the outer and the inner raceway, 2π/(Z (1 ∓ D cos α/D_pw)) [rad].
    """
    gamma = bearing.element_diameter * jnp.cos(angle) / bearing.pitch_diameter
    parts = jnp.stack([1.0 - gamma, 1.0 + gamma])
    return 2.0 * jnp.pi / (bearing.n_elements * parts)


def arc_factor(covering: Float[Array, "2"], power: float) -> Float[Array, "2"]:
    """Mean of D^e over a raceway that the arcs of rolling elements cover unevenly.

    Args:
        covering: c, number of arcs over a point in the mean [1].
        power: e, Weibull's exponent.

    Returns:
        It over that of the same passes spread evenly [1].
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
    """Mean of D^e over a ring that swings against the load.

    Exact for loads that are constant over each element's part of the circumference: D
    is then linear from edge to edge.

    Args:
        wear: x^p of every rolling element; zero in empty places.
        count: Number of rolling elements, Z.
        amplitude: θ, above zero [rad].
        spread: e as a fraction.
    """
    turn, n, d = 2.0 * jnp.pi, *spread
    count = jnp.asarray(count, wear.dtype)
    step = turn / count
    place = jnp.arange(wear.shape[0], dtype=wear.dtype)
    first = jnp.mod(amplitude, step)
    first = jnp.minimum(first, step - first)

    def upto(t):
        """Part of the sector from 0 to `step`, and its repetitions, up to t."""
        return step * jnp.floor(t / turn) + jnp.minimum(jnp.mod(t, turn), step)

    def swept(offset):
        apart = step * (place[:, None] - place[None]) + offset
        weight = (upto(apart + amplitude) - upto(apart - amplitude)) / (2 * amplitude)
        return jnp.einsum("kj,jrt->krt", weight, wear)

    def mean(a, b):
        """Of the power of what is linear from a to b."""
        middle, apart = 0.5 * (a + b), b - a
        near = jnp.abs(apart) <= 2e-3 * middle
        whole = jnp.where(near, 1.0, apart)
        ends = positive_power(b, n + d, d) - positive_power(a, n + d, d)
        ratio = apart / jnp.where(middle > 0, middle, 1.0)
        series = 1.0 + n * (n - d) / (24.0 * d * d) * ratio**2
        even = positive_power(middle, n, d) * series
        return jnp.where(near, even, ends * d / ((n + d) * whole))

    one, other, last = swept(first), swept(step - first), swept(step + first)
    parts = (step - 2 * first) * mean(one, other) + 2 * first * mean(other, last)
    there = (place < count)[:, None, None]
    return jnp.sum(jnp.where(there, parts, 0.0), axis=0) / turn

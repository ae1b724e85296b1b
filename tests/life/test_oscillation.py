"""Fatigue of raceways in oscillation: rolling elements followed one by one, limits."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.life.oscillation import (
    arc_factor,
    critical_amplitudes,
    mean_of_swing,
)
from bearingjax.life.reference_life import row_fatigue

BALLS, ROLLERS = (3, (10, 9), 1.5), (4, (9, 8), 10 / 9)


def zone(angle, exponent, epsilon=0.5):
    """Load of a rolling element over the largest one (Sjövall)."""
    depth = 1.0 - (1.0 - np.cos(angle)) / (2.0 * epsilon)
    return np.maximum(depth, 0.0) ** exponent


def follow(kind, count, gamma, swing, ring, points=40_000):
    """Mean of D^e over a ring, every rolling element followed over the swing."""
    p, (n, d), exponent = kind
    inner = ring == 1
    share = 0.5 * (1.0 + gamma if inner else 1.0 - gamma)
    point = (np.arange(points) + 0.5) * 2 * np.pi / points
    wear = np.zeros(points)
    for place in 2 * np.pi * (np.arange(count) + 0.5) / count:
        for turn in (-2, -1, 0, 1, 2):
            # Where the inner ring is as the element passes the point.
            at = (place - point + 2 * np.pi * turn) / (share if inner else -share)
            there = np.abs(at) <= swing
            orbit = place + 0.5 * (1.0 - gamma) * at[there]
            wear[there] += 2.0 * zone(orbit, exponent) ** p
    return np.mean((wear / (count * share * 2.0 * swing / np.pi)) ** (n / d))


@pytest.mark.parametrize("kind", [BALLS, ROLLERS], ids=["balls", "rollers"])
@pytest.mark.parametrize(("count", "within"), [(7, 0.045), (20, 0.012)])
def test_oscillation_as_elements_followed_one_by_one(kind, count, within):
    p, spread, exponent = kind
    gamma, (n, d) = 1.8 / count, spread
    places = 2 * np.pi * (np.arange(count) + 0.5) / count
    wear = zone(places, exponent) ** p
    both = jnp.asarray(wear)[:, None, None] * jnp.ones((1, 2, 1))
    critical = 2 * np.pi / (count * np.array([1 - gamma, 1 + gamma]))
    for swing in 2 * np.pi / count * np.array([0.3, 0.9, 1.5, 3.0]):
        arcs = np.asarray(arc_factor(jnp.asarray(swing / critical), n / d))
        turning = mean_of_swing(both, count, jnp.asarray(swing), spread)[1, 0]
        found = float(turning) * arcs[1]
        expected = follow(kind, count, gamma, swing, 1)
        assert -within < found / expected - 1 < 1e-3
        standing = np.mean(wear ** (n / d)) * arcs[0]
        expected = follow(kind, count, gamma, swing, 0)
        np.testing.assert_allclose(standing, expected, rtol=2e-3)


def test_swing_of_half_a_turn_is_a_turn_and_a_small_one_stands_still():
    rng = np.random.default_rng(0)
    loads = np.zeros((16, 2, 1))  # seven elements, nine empty places
    loads[:7] = rng.uniform(0.0, 1.0, (7, 1, 1)) * (rng.uniform(size=(7, 1, 1)) < 0.7)
    wear, turn = jnp.asarray(loads), jnp.asarray(np.pi)

    def share(swing):
        return np.asarray(mean_of_swing(wear, 7, jnp.asarray(swing), (10, 9)))[:, 0]

    np.testing.assert_allclose(share(turn), loads[:7].mean() ** (10 / 9), rtol=ROUNDING)
    still = np.mean(loads[:7, 0, 0] ** (10 / 9))
    np.testing.assert_allclose(share(1e-4), still, rtol=1e-4)
    falling = [share(x)[0] for x in np.linspace(1e-3, np.pi, 40)]
    assert np.all(np.diff(falling) < 1e-9)
    even = jnp.ones((7, 2, 1))
    np.testing.assert_allclose(
        mean_of_swing(even, 7, jnp.asarray(0.3), (9, 8)), 1.0, rtol=ROUNDING
    )


def test_swing_averages_loads_as_a_sum_over_its_way():
    wear = np.array([0.0, 0.1, 0.7, 1.0, 0.4, 0.0, 0.0])
    swing, step = 0.8, 2 * np.pi / 7
    point = (np.arange(7000) + 0.5) * 2 * np.pi / 7000
    way = ((np.arange(2001) + 0.5) / 2001 * 2 - 1) * swing
    place = np.floor((point[:, None] + way) % (2 * np.pi) / step).astype(int) % 7
    expected = np.mean(wear[place].mean(axis=1) ** (10 / 9))
    given = jnp.asarray(wear)[:, None, None] * jnp.ones((1, 2, 1))
    found = mean_of_swing(given, 7, jnp.asarray(swing), (10, 9))
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_arcs_below_the_critical_amplitude_and_above():
    power = 10 / 9
    covering = jnp.asarray([0.25, 1.0])
    expected = [0.25 ** (1 - power), 1.0]
    np.testing.assert_allclose(arc_factor(covering, power), expected, rtol=ROUNDING)
    above = arc_factor(jnp.asarray([1.5, 7.3]), power)
    assert np.all((np.asarray(above) > 1.0) & (np.asarray(above) < 1.007))
    # Life in cycles goes with θ^-0.9 of balls, θ^(-8/9) of rollers: loads of NREL DG03.
    for e, load, p in ((10 / 9, 3 / 10, 3), (9 / 8, 2 / 9, 4)):
        one, other = np.asarray(arc_factor(jnp.asarray([0.2, 0.4]), e))
        lives = 2.0 * (other / one) ** (1 / e)  # of the smaller over the larger swing
        np.testing.assert_allclose(lives, 2.0 ** (load * p), rtol=ROUNDING)


def test_row_in_oscillation_between_its_limits():
    bearing = bj.AngularContactBallBearing(
        7, 43.5e-3, 11.5e-3, contact_angle=0.7, outer_osculation=0.53,
        inner_osculation=0.52,
    )  # fmt: skip
    angle, rating = bearing.contact_angle, jnp.asarray(2e4)
    critical = np.asarray(critical_amplitudes(bearing, angle))
    gamma = 11.5 / 43.5 * np.cos(0.7)
    np.testing.assert_allclose(
        critical * 7 / (2 * np.pi), 1 / (1 - gamma * np.array([1, -1]))
    )
    loads = jnp.asarray(np.abs(np.random.default_rng(2).normal(size=(7, 2, 1))) * 1e3)
    inner = jnp.asarray([0.0, 1.0])

    @jax.jit
    def share(amplitude):
        return row_fatigue(bearing, rating, angle, loads, inner, amplitude).share

    plain = row_fatigue(bearing, rating, angle, loads, inner).share
    np.testing.assert_allclose(share(0.0), plain, rtol=ROUNDING)
    # Half a turn either way passes places of the other ring once more than others.
    np.testing.assert_allclose(share(np.pi), plain, rtol=5e-3)
    # The ring without the wander of the load tires as if it stood.
    both = row_fatigue(bearing, rating, angle, loads, jnp.zeros(2)).share
    arcs = np.asarray(arc_factor(jnp.asarray(1e-3 / critical), 10 / 9))[:, None]
    np.testing.assert_allclose(share(1e-3), arcs * both, rtol=1e-3)
    slope = jax.grad(lambda x: share(x).sum())(0.3)
    step = (share(0.3 + 1e-6).sum() - share(0.3 - 1e-6).sum()) / 2e-6
    np.testing.assert_allclose(slope, step, rtol=1e-5)


def test_amplitude_out_of_range_is_refused():
    with pytest.raises(ValueError, match=r"`oscillation` is .*4.*half of the whole"):
        bj.Cases(np.zeros((2, 6)), oscillation=[0.0, 4.0])

"""Free vibration: frequency over amplitude, published and in closed form."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import theirs
from scipy.integrate import quad
from scipy.optimize import brentq
from tolerances import DIFFERENCE, PUBLISHED
from vibrations import Contact, Spring, duffing, oscillator, rotor

import bearingjax as bj
from bearingjax.rotor.nonlinear import HarmonicBalance, Shooting, backbone


def test_harmonic_balance_of_the_hertz_oscillator_before_its_contact_opens():
    """Against shooting, which the validation case `hertz_oscillator` holds."""
    largest, system = np.array([0.1, 0.5, 0.8]), oscillator(Contact())
    exact = backbone(system, largest, 0, Shooting(400))
    assert np.abs(exact.damping_ratio).max() < DIFFERENCE
    found = backbone(system, largest, 0, HarmonicBalance(7, 64))
    assert np.allclose(found.frequency, exact.frequency, rtol=1e-3)


class Weight(eqx.Module):
    """A constant load of one freedom."""

    force: jax.Array

    def __call__(self, phase, frequency, acceleration):
        return self.force[None]


def test_peaks_count_from_where_a_constant_load_is_carried():
    """Against quadrature of the energy u²/2 + c u⁴/4 - F u."""
    cubic, force = 0.3, 0.8

    @jax.jit
    def run(force):
        system = oscillator(Spring(jnp.asarray(cubic), jnp.asarray(0.0)))
        system = dataclasses.replace(system, load=Weight(force))
        found = backbone(system, HEIGHTS, 0, HarmonicBalance(9, 64), throw=False)
        return found.frequency, found.amplitude[:, 0]

    def exact(force, height):
        rest = brentq(lambda u: u + cubic * u**3 - force, 0.0, 2.0)

        def energy(u):
            return 0.5 * u**2 + 0.25 * cubic * u**4 - force * u

        top = energy(rest + height)
        low = brentq(lambda u: energy(u) - top, -3.0, rest)
        middle, half = 0.5 * (rest + height + low), 0.5 * (rest + height - low)

        def time(angle):
            u = middle + half * np.sin(angle)
            return half * np.cos(angle) / np.sqrt(2.0 * (top - energy(u)))

        spans = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 9)
        parts = zip(spans[:-1], spans[1:], strict=True)
        return np.pi / sum(quad(time, a, b, epsabs=1e-10)[0] for a, b in parts), half

    frequency, half = run(jnp.asarray(force))
    each = np.array([exact(force, float(height)) for height in HEIGHTS])
    np.testing.assert_allclose(frequency, each[:, 0], rtol=DIFFERENCE)
    np.testing.assert_allclose(half, each[:, 1], rtol=DIFFERENCE)
    slope = jax.jacfwd(lambda force: run(force)[0])(jnp.asarray(force))
    ends = [exact(force + step, float(HEIGHTS[1]))[0] for step in (-1e-4, 1e-4)]
    np.testing.assert_allclose(slope[1], (ends[1] - ends[0]) / 2e-4, rtol=1e-4)


HEIGHTS = jnp.array([0.1, 0.5])


def test_duffing_with_one_harmonic():
    """ω² = 1 + 3/4 c a², and a damping c = 2 ζ ω; derivatives too."""
    a, cubic, ratio = np.array([0.5, 1.5]), 0.05, 0.02

    @eqx.filter_jit
    def run(numbers, peaks):
        system = duffing(numbers[0], 0.2, numbers[1])
        found = backbone(system, peaks, 0, HarmonicBalance(1, 8), throw=False)
        return jnp.stack([found.frequency, found.damping_ratio])

    numbers, peaks = jnp.array([cubic, ratio]), jnp.asarray(a)
    frequency = np.sqrt(1.0 + 0.75 * cubic * a**2)
    found = run(numbers, peaks)
    assert np.allclose(found, [frequency, ratio / frequency], rtol=1e-9)
    slopes, by_peaks = jax.jacfwd(run, (0, 1))(numbers, peaks)
    slope = 0.375 * a**2 / frequency
    assert np.allclose(slopes[0, :, 0], slope, rtol=1e-9)
    assert np.allclose(slopes[1, :, 1], 1.0 / frequency, rtol=1e-9)
    slope = 0.75 * cubic * a / frequency
    assert np.allclose(np.diagonal(by_peaks[0]), slope, rtol=1e-9)


def test_a_critical_speed_falls_with_the_amplitude():
    """Forward whirl of the paper's rotor, published when small; it softens."""
    z0 = float(rotor(36).scale[0])
    peaks = z0 * np.array([0.01, 0.15, 0.25])
    # Of the ten modes at the reference speed the backward one lies below.
    found = backbone(rotor(36), peaks, 3, HarmonicBalance(3, 16), mode=1)
    speed = np.asarray(found.frequency)
    name = "critical speeds: axial, backward, forward"
    linear = theirs("filipkovskii_rotor", name)[3, 1]  # of 36 degrees
    assert np.isclose(speed[0], linear, rtol=PUBLISHED)
    assert speed[2] < 0.99 * speed[1] < 0.99 * 0.995 * speed[0]
    # A circle.
    assert np.allclose(found.amplitude[:, 0], found.amplitude[:, 1], rtol=1e-5)
    assert np.isclose(found.damping_ratio[0], 0.01, rtol=0.05)


def test_backbone_reports_failed_points_and_invalid_freedom():
    system = duffing(jnp.nan)
    with pytest.raises(bj.SolveError, match="point 0, peak 0.5 .non_finite.*smaller"):
        backbone(system, [0.5, 1.5], 0, HarmonicBalance(1, 8))
    with pytest.raises(ValueError, match="`freedom` is 1; the system has 1 freedoms"):
        backbone(system, [0.1], 1, HarmonicBalance(1, 8))

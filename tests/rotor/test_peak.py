"""The peak of a response, and its derivatives."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar
from vibrations import duffing

from bearingjax.numerics import SolveError
from bearingjax.rotor.nonlinear import (
    HarmonicBalance,
    Shooting,
    Steps,
    VibratingSystem,
    follow,
    peak,
)

METHODS = {
    "balance": (HarmonicBalance(5, 24, steps=16), 1e-6),
    "shooting": (Shooting(24), 1e-5),
}
STEPS = Steps(first=0.05, largest=0.3)


@pytest.mark.parametrize(
    "name", ["balance", pytest.param("shooting", marks=pytest.mark.slow)]
)
def test_peak_of_a_hardening_oscillator(name):
    method, goal = METHODS[name]
    point = jnp.array([0.05, 0.1, 0.05])

    def measures(numbers):
        orbit = peak(duffing(*numbers), branch, 0, method)
        return jnp.stack([orbit.amplitude[0], orbit.frequency])

    branch = follow(duffing(*point), 0.8, 1.3, method, steps=STEPS, locate=False)
    found = np.asarray(measures(point))
    # Nothing on a finer branch is larger, and little is missing.
    fine = follow(
        duffing(*point), 0.8, 1.3, method, steps=Steps(largest=0.02), locate=False
    )
    top = fine.amplitude[:, 0].max()
    assert branch.amplitude[:, 0].max() < top <= found[0] < 1.0001 * top
    slopes = np.asarray(jax.jacfwd(measures)(point))
    best = np.full((2, 3), np.inf)
    for size in (1e-2, 1e-3):
        for k, step in enumerate(size * np.diag(np.asarray(point))):
            a, b, c, d = (
                np.asarray(measures(point + j * step)) for j in (-2, -1, 1, 2)
            )
            apart = (a - 8 * b + 8 * c - d) / (12 * step[k]) - slopes[:, k]
            best[:, k] = np.minimum(best[:, k], np.abs(apart))
    assert (best < goal * np.abs(slopes).max(axis=1, keepdims=True)).all()


def test_peak_of_a_linear_oscillator():
    """At ω² = 1 - 2 ζ², 1/(2 ζ sqrt(1 - ζ²)) of the static displacement."""
    method, z = METHODS["balance"][0], 0.1
    system = duffing(*jnp.array([0.0, 0.3, z]))
    branch = follow(system, 0.8, 1.3, method, steps=STEPS, locate=False)
    orbit = peak(system, branch, 0, method)
    assert np.isclose(orbit.frequency, np.sqrt(1.0 - 2.0 * z**2), rtol=1e-9)
    assert np.isclose(orbit.amplitude[0], 0.15 / (z * np.sqrt(1.0 - z**2)), rtol=1e-9)
    with pytest.raises(ValueError, match="follow the branch further"):
        peak(system, branch, 0, method, between=(1.05, 1.2))
    # Points that end short of it, by 1e-7 of the way, have next to no slope there, and
    # no peak between them.
    k = int(np.flatnonzero(branch.frequency < float(orbit.frequency))[-1])
    here, top = (
        np.append(x, float(w))
        for x, w in (
            (branch.unknowns[k], branch.frequency[k]),
            (np.asarray(orbit.unknowns), orbit.frequency),
        )
    )
    short = top + 1e-7 * (here - top)
    ended = branch._replace(
        frequency=np.array([branch.frequency[k - 1], here[-1], short[-1]]),
        unknowns=np.stack([branch.unknowns[k - 1], here[:-1], short[:-1]]),
        amplitude=np.array([[0.5], [1.0], [0.5]]),
    )
    with pytest.raises(SolveError, match="peak: not found near .*step_limit"):
        peak(system, ended, 0, method)
    # A branch that has stepped over the peak says so, one of small steps finds it.
    z = 1e-4
    system = duffing(*jnp.array([0.0, 2.0 * z, z]))
    branch = follow(system, 0.9, 1.1, method, steps=STEPS, locate=False)
    assert branch.amplitude.max() < 0.01
    with pytest.raises(SolveError, match="points of the branch are too far apart"):
        peak(system, branch, 0, method)
    fine = Steps(first=1e-4, largest=0.1)
    branch = follow(system, 0.999, 1.001, method, steps=fine, locate=False)
    orbit = peak(system, branch, 0, method)
    assert np.isclose(orbit.frequency, np.sqrt(1.0 - 2.0 * z**2), rtol=1e-9)
    assert np.isclose(orbit.amplitude[0], 1.0 / np.sqrt(1.0 - z**2), rtol=1e-9)


MASS, DAMPING = np.diag([1.0, 1.5]), np.diag([0.08, 0.1])
SKEW, BED = np.array([[0.0, 0.3], [-0.3, 0.0]]), np.diag([1.0, 1.6])
CUBIC, MOMENT = 0.3, 0.06


class Bed(eqx.Module):
    """An orthotropic spring that hardens with the square of the deflection."""

    def __call__(self, q, velocity, phase, frequency):
        return jnp.asarray(BED) @ q + CUBIC * (q @ q) * q


class Unbalance(eqx.Module):
    def __call__(self, phase, frequency, acceleration):
        turned = jnp.stack([jnp.cos(phase), jnp.sin(phase)])
        return MOMENT * frequency**2 * turned


def whirled(frequency, start):
    """Half of peak to peak of the first freedom, by shooting with SciPy."""
    inverse, period = np.linalg.inv(MASS), 2.0 * np.pi / frequency
    damping = DAMPING + frequency * SKEW

    def rates(time, y):
        q, velocity, state = y[:2], y[2:4], y[4:].reshape(4, 4)
        angle = frequency * time
        load = MOMENT * frequency**2 * np.array([np.cos(angle), np.sin(angle)])
        pull = damping @ velocity + BED @ q + CUBIC * (q @ q) * q
        slope = BED + CUBIC * ((q @ q) * np.eye(2) + 2.0 * np.outer(q, q))
        whole = np.block([[np.zeros((2, 2)), np.eye(2)], [-slope, -damping]])
        whole[2:] = inverse @ whole[2:]
        return np.concatenate([velocity, inverse @ (load - pull), (whole @ state).flat])

    for _ in range(6):
        begin = np.concatenate([start, np.eye(4).ravel()])
        way = solve_ivp(
            rates, (0, period), begin, "DOP853", rtol=1e-12, atol=1e-13,
            dense_output=True,
        )  # fmt: skip
        turned = way.y[4:, -1].reshape(4, 4)
        start = start + np.linalg.solve(np.eye(4) - turned, way.y[:4, -1] - start)
    ends = []
    for sign in (1.0, -1.0):
        times = np.linspace(0.0, period, 200)
        time = times[np.argmax(sign * way.sol(times)[0])]
        near = (time - period / 200, time + period / 200)
        least = minimize_scalar(
            lambda t, sign=sign: -sign * way.sol(t % period)[0],
            bounds=near, method="bounded", options={"xatol": 1e-9},
        )  # fmt: skip
        ends.append(least.fun)
    return -0.5 * sum(ends)


@pytest.mark.slow
def test_peak_of_two_whirling_freedoms():
    """An unbalance, gyroscopic moments, unlike springs: on a bent resonance, beside
    a fold, where an independent orbit is as large, and less large on either side."""
    system = VibratingSystem(
        mass=MASS, damping=DAMPING, gyroscopic=SKEW, restoring=Bed(),
        load=Unbalance(), scale=np.ones(2), reference_frequency=1.0,
    )  # fmt: skip
    method, steps = HarmonicBalance(9, 40, steps=16), Steps(first=0.05, largest=0.2)
    branch = follow(system, 0.7, 1.9, method, steps=steps, locate=False)
    orbit = peak(system, branch, 0, method)
    frequency, top = float(orbit.frequency), float(orbit.amplitude[0])
    moved = np.asarray(orbit.displacement)
    order = 1j * np.fft.fftfreq(len(moved), 1.0 / len(moved))[:, None]
    rate = frequency * np.fft.ifft(order * np.fft.fft(moved, axis=0), axis=0).real
    start, step = np.concatenate([moved[0], rate[0]]), 1e-4
    low, own, high = (whirled(frequency + k * step, start) for k in (-1, 0, 1))
    np.testing.assert_allclose(top, own, rtol=1e-10)
    assert max(low, high) < own and branch.amplitude[:, 0].max() <= top
    # The vertex of the parabola through them.
    away = 0.5 * step * (high - low) / (2.0 * own - low - high)
    assert abs(away) < 1e-2 * step

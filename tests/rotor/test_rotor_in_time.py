"""Vibration in time: closed forms, orbits, an integration of momenta by SciPy."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tolerances import DIFFERENCE, ROUNDING, SOLVER
from vibrations import Spring, duffing, oscillator

import bearingjax as bj
from bearingjax.rotor.nonlinear import (
    FrequencyTable,
    HarmonicLoad,
    IntegrationOptions,
    Shooting,
    VibratingSystem,
    poincare,
    simulate,
    solve_orbit,
    waterfall,
)

# One program for all of one freedom. Errors at this tolerance: 1e-9.
FINE = IntegrationOptions(1e-10, 4000)
COUNT = 12


def times(end, count=COUNT):
    return end * np.linspace(0.0, 1.0, count)


def test_simulate_linear_oscillator_matches_closed_form():
    z, w, force = 0.1, 0.8, 0.3
    start = [0.5], [-0.2]
    history = simulate(
        duffing(0.0, force, z), times(20.0), w, start=start, options=FINE
    )
    t, inner = np.asarray(history.time), np.sqrt(1.0 - z**2)
    steady = force / (1.0 - w**2 + 2j * z * w)
    a = 0.5 - steady.real
    b = (-0.2 - (1j * w * steady).real + z * a) / inner
    free = np.exp(-z * t) * (a * np.cos(inner * t) + b * np.sin(inner * t))
    wanted = free + (steady * np.exp(1j * w * t)).real
    assert np.abs(history.displacement[:, 0] - wanted).max() < SOLVER
    assert np.allclose(history.phase, w * t, rtol=ROUNDING)


def test_without_damping_energy_is_kept():
    start = [1.5], [0.3]
    system = duffing(0.05, 0.0, 0.0)
    h = simulate(system, times(60.0), 0.9, start=start, options=FINE)
    q, v = h.displacement[:, 0], h.velocity[:, 0]
    energy = 0.5 * v**2 + 0.5 * q**2 + 0.05 / 4 * q**4
    assert np.abs(energy / energy[0] - 1.0).max() < SOLVER


def test_points_once_a_period():
    """The orbit of shooting; two points in turn where a flip made the period double."""
    system = duffing()
    points = poincare(system, 0.9, COUNT, settle=80, options=FINE)
    orbit = solve_orbit(system, 0.9, Shooting(96))
    assert np.allclose(points.displacement, orbit.displacement[:1], atol=1e-6)
    assert np.allclose(points.velocity, orbit.velocity[:1], atol=1e-6)
    shaken = oscillator(Spring(jnp.asarray(0.1), jnp.asarray(0.4)), 0.0, 0.05)
    start = [0.1], [0.0]
    points = poincare(shaken, 2.0, COUNT, settle=100, start=start, options=FINE)
    q = np.asarray(points.displacement[:, 0])
    assert np.allclose(q[::2], -q[1::2], atol=1e-4) and np.abs(q).min() > 0.1


def test_a_waterfall_has_lines():
    """Subharmonic at half the frequency inside the flip's range, none outside."""
    shaken = oscillator(Spring(jnp.asarray(0.1), jnp.asarray(0.4)), 0.02, 0.05)
    found = waterfall(
        shaken, [1.2, 2.0], start=([0.1], [0.0]), periods=2, samples=16, settle=100
    )
    assert (found.result == bj.Result.CONVERGED).all()
    assert np.allclose(found.order[:3], [0.0, 0.5, 1.0])
    orbit = solve_orbit(shaken, 1.2, Shooting(96))
    line = 2.0 * np.abs(np.fft.rfft(np.asarray(orbit.displacement[:, 0]))[1]) / 96
    assert np.isclose(found.amplitude[0, 2, 0], line, rtol=1e-4)
    assert found.amplitude[0, 1, 0] < 1e-4 < 0.1 < found.amplitude[1, 1, 0]


class Linear(eqx.Module):
    stiffness: jax.Array

    def __call__(self, q, velocity, phase, frequency):
        return self.stiffness * q


MASS, POLAR, DIAMETRAL, UNBALANCE, OFF = 2.0, 0.4, 0.3, 2e-2, 3e-2
STIFFNESS, DAMPING = np.array([8.0, 10.0, 1.2, 1.2]), np.array([0.1, 0.1, 0.03, 0.03])


def turning(stiffness, unbalance):
    """A disc (x, y, gx, gy) out of balance, its principal axis off too."""
    skew = np.zeros((4, 4))
    skew[2, 3], skew[3, 2] = POLAR, -POLAR
    load = eqx.tree_at(
        lambda load: (load.unbalance_cosine, load.unbalance_sine),
        HarmonicLoad.zero(4),
        (
            unbalance * jnp.array([1.0, 0.0, 0.0, 1.5]),
            unbalance * jnp.array([0.0, 1.0, -1.5, 0.0]),
        ),
    )
    return VibratingSystem(
        mass=np.diag([MASS, MASS, DIAMETRAL, DIAMETRAL]),
        damping=np.diag(DAMPING),
        gyroscopic=skew,
        restoring=Linear(stiffness),
        load=load,
        scale=np.full(4, 0.1),
        reference_frequency=2.0,
    )


def run_up(numbers):
    """From rest through the critical speeds; numbers: stiffnesses, unbalance, end."""
    system = turning(numbers[:4], numbers[4])
    options = IntegrationOptions(1e-9, 10_000)
    return simulate(
        system, times(60.0, 241), 0.0, end_frequency=numbers[5], options=options
    )


NUMBERS = np.array([*STIFFNESS, UNBALANCE, 6.0])


@pytest.fixture(scope="module")
def history():
    return run_up(jnp.asarray(NUMBERS))


def test_run_up_through_critical_speeds(history):
    """Against momenta, in which the angular acceleration does not occur."""
    slope = 0.1

    def rates(t, y):
        w, phase = slope * t, 0.5 * slope * t**2
        gx, gy, p = y[2], y[3], y[4:]
        turned = w * UNBALANCE * np.array([-np.sin(phase), np.cos(phase)])
        off = 1.5 * w * UNBALANCE * np.array([-np.cos(phase), -np.sin(phase)])
        velocity = np.array(
            [
                *((p[:2] - turned) / MASS),
                (p[2] - POLAR * w * gy - off[0]) / DIAMETRAL,
                (p[3] + POLAR * w * gx - off[1]) / DIAMETRAL,
            ]
        )
        return np.concatenate([velocity, -STIFFNESS * y[:4] - DAMPING * velocity])

    times = np.asarray(history.time)
    tight = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13}
    theirs = solve_ivp(rates, (0.0, 60.0), np.zeros(8), t_eval=times, **tight)
    wanted = theirs.y[:4].T
    peaks = np.abs(wanted).max(axis=0)
    found = np.asarray(history.displacement)
    assert (np.abs(found - wanted) / peaks).max() < DIFFERENCE
    top = np.abs(wanted).argmax(axis=0)
    assert (np.abs(found).argmax(axis=0) == top).all()
    # The critical speed of the two planes lies before what is passed at speed.
    assert (history.frequency[top[:2]] > np.sqrt(STIFFNESS[:2] / MASS)).all()
    assert np.isclose(history.phase[-1], 180.0, rtol=ROUNDING)


@pytest.mark.slow
def test_gradients_of_a_run_up(history):
    """Backward through the integration, against the differences."""
    at = int(np.abs(history.displacement[:, 0]).argmax())
    weights = jnp.array([1.0, 0.5, 0.2, 0.3])

    def measure(numbers):
        return run_up(numbers).displacement[at] @ weights

    slopes = np.asarray(eqx.filter_jit(jax.grad(measure))(jnp.asarray(NUMBERS)))
    for k, size in enumerate(1e-4 * NUMBERS):
        step = size * np.eye(6)[k]
        a, b, c, d = (float(measure(NUMBERS + j * step)) for j in (-2, -1, 1, 2))
        assert np.isclose(slopes[k], (a - 8 * b + 8 * c - d) / (12 * size), rtol=1e-5)


def test_phase_of_a_frequency_table():
    table = FrequencyTable([0.0, 1.0, 3.0, 4.0], [0.0, 2.0, 2.0, 1.0])
    times = np.array([0.0, 0.5, 1.0, 2.0, 3.5, 6.0])
    turned = jax.vmap(table.at)(jnp.asarray(times))
    # Areas under the broken line.
    areas = [0.0, 0.25, 1.0, 3.0, 5.0 + 0.5 * (2.0 + 1.5) / 2, 5.0 + 1.5 + 2.0]
    assert np.allclose(turned.phase, areas, rtol=ROUNDING)
    assert np.allclose(turned.frequency, [0.0, 1.0, 2.0, 2.0, 1.5, 1.0])
    assert np.allclose(turned.acceleration, [2.0, 2.0, 0.0, 0.0, -1.0, 0.0])
    back = jax.vmap(table.time_at)(turned.phase)
    assert np.allclose(back, times, atol=ROUNDING)
    stopped = FrequencyTable([0.0, 1.0], [2.0, 0.0])
    assert np.isinf(stopped.time_at(jnp.asarray(1.5)))


def test_simulate_reports_failure_and_invalid_arguments():
    given = {"options": FINE}
    with pytest.raises(bj.SolveError, match="non_finite after .* of 20 s"):
        simulate(duffing(force=jnp.nan), times(20.0), 0.9, **given)
    history = simulate(duffing(), times(1e5), 0.9, throw=False, **given)
    assert history.result == bj.Result.STEP_LIMIT and history.steps == 4000
    assert np.isfinite(history.displacement[0]).all()
    assert np.isnan(history.displacement[1:]).all()
    bad = (
        ({"frequency": -0.9}, "`frequency` is -0.9 rad/s"),
        ({"start": ([0.0, 0.0], [0.0])}, r"displacement of `start` has the shape \(2,"),
        (
            {"options": IntegrationOptions(1e-6, 9, "both")},
            "must be reverse or forward",
        ),
        ({"options": IntegrationOptions(0.0)}, "`tolerance` is 0"),
        ({"times": np.array([0.0, 2.0, 2.0])}, "`times` is .* s; it must be rising"),
        ({"times": np.array([-1.0, 2.0])}, "`times` is .* s; it must be rising from 0"),
    )
    for change, message in bad:
        with pytest.raises(ValueError, match=message):
            simulate(duffing(), **({"times": times(20.0), "frequency": 0.9} | change))
    stopping = FrequencyTable([0.0, 10.0], [2.0, 0.0])  # 10 rad, 1.6 periods
    assert len(poincare(duffing(), stopping, 2).time) == 2
    with pytest.raises(ValueError, match="point 3 is never reached: `frequency` ends"):
        poincare(duffing(), stopping, 3)
    with pytest.raises(ValueError, match="rising from each to the next"):
        FrequencyTable([0.0, 0.0], [1.0, 2.0])

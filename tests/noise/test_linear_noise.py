"""Small vibration over frequency, against the same equations stepped in time."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.design.form_error import FormErrors, Harmonics, RacewayErrors
from bearingjax.element.azimuth import azimuths, orbit_ratio
from bearingjax.noise import (
    NoiseModel,
    Sensor,
    linear_model,
    natural_modes,
    transfer,
    vibration,
)
from bearingjax.noise.dynamics.stepping import step_motion

BEARING = balls(7)
INNER = 1200.0  # rad/s
ORDER, PHASE = 8, 0.3
G = float(orbit_ratio(BEARING))


def model(height=1e-8):
    """The balls stay where they are: the rings turn against each other."""
    wave = Harmonics(ORDER, height, PHASE)
    return NoiseModel(
        bj.BearingElement(BEARING),
        0.3,
        [0.0, 20.0, -200.0, 0.0, 0.0, 0.0],
        bj.Speed(inner=INNER, outer=-(1 - G) / (1 + G) * INNER),
        FormErrors(inner=RacewayErrors(outwards=wave)),
        sensor=Sensor(1e6, 30.0, (1.0, 2.0, 0.0)),
        retardation=1e-5,
        tilts=False,
    )


def met(time, height=1.0):
    """What the balls find on the inner raceway, and its rate."""
    angle = ORDER * (azimuths(BEARING) - INNER * time) + PHASE
    none = jnp.zeros((7, 2, 3))
    found = none.at[:, 1, 1].set(height * jnp.cos(angle))
    return found, none.at[:, 1, 1].set(height * ORDER * INNER * jnp.sin(angle))


@pytest.fixture(scope="module")
def answer():
    frequency = ORDER * INNER / (2 * np.pi)
    return transfer(model(), np.array([frequency, 100.0]))


def expected(answer, time):
    """Acceleration of the ring for a wave of height 1, from the transfer function."""
    amplitude = np.exp(-1j * (ORDER * np.asarray(azimuths(BEARING)) + PHASE))
    line = np.asarray(answer.acceleration_by_errors)[0, :, :, 1, 1] @ amplitude
    turning = np.exp(1j * ORDER * INNER * np.asarray(time))
    return np.real(turning[:, None] * line)


@pytest.mark.slow
def test_the_linear_equations_stepped_in_time(answer):
    linear = linear_model(model())

    def acceleration(motion, velocity, time):
        height, rate = met(time)
        both = height + linear.retardation * rate
        force = jnp.tensordot(linear.push, both, 3)
        force = force - linear.stiffness @ motion - linear.damping @ velocity
        return force / linear.mass

    zero = jnp.zeros(linear.mass.shape)
    turn, samples, settle, steps = 2 * np.pi / INNER, 64, 8, 60
    step = jnp.asarray(turn / samples / steps)
    moved = jax.jit(
        lambda: step_motion(
            acceleration, (zero, zero), step, steps, (settle + 1) * samples
        )
    )()
    found = moved.acceleration[settle * samples :, :3]
    want = expected(answer, np.arange(samples) * turn / samples)
    size = np.abs(want).max()
    np.testing.assert_allclose(found, want, rtol=0, atol=1e-6 * size)
    assert size > 1e5  # of a motion that is there


@pytest.mark.slow
def test_the_true_bearing_comes_near_as_the_waves_get_small(answer):
    left = []
    for height in (4e-8, 2e-8):
        record = vibration(model(height), turns=1, settle=6, samples=64, steps=60)
        want = expected(answer, record.time)
        error = np.abs(record.acceleration / height - want).max() / np.abs(want).max()
        left.append(error)
    assert left[0] < 0.05
    assert left[0] / left[1] == pytest.approx(2.0, rel=0.05)


@pytest.mark.slow
def test_transfer_at_low_frequency_matches_static_compliance():
    """Without sensor, far below the modes: receptance = condensed stiffness⁻¹."""
    alone = dataclasses.replace(model(), sensor=None, retardation=0.0)
    found = transfer(alone, np.array([1e-3]))
    solution = bj.solve_load(
        alone.element,
        alone.load,
        support=bj.Support(fixed_ring="inner", free=("ux", "uy", "uz")),
    )
    flexible = np.linalg.inv(np.asarray(solution.stiffness)[:3, :3])
    size = np.abs(flexible).max()
    np.testing.assert_allclose(
        np.real(found.by_force[0]), flexible, rtol=0, atol=1e-9 * size
    )
    # The sum of all raceway shifts along z moves the ring along z alone.
    moved = found.by_errors[0, :, :, 1, 0].sum(axis=1)
    np.testing.assert_allclose(moved, [0.0, 0.0, 1.0], atol=1e-9)


@pytest.mark.slow
def test_a_peak_stands_at_a_natural_frequency():
    lightly = dataclasses.replace(model(), sensor=None, retardation=1e-8)
    modes = natural_modes(lightly)
    ring = modes.frequency[np.argsort(-modes.ring_share)[0]]
    near = np.asarray(ring) * np.array([0.99, 1.0, 1.01])
    size = np.linalg.norm(transfer(lightly, near).accelerance, axis=(1, 2))
    assert size[1] > 50 * max(size[0], size[2])


@pytest.mark.slow
def test_derivatives():
    @jax.jit
    @jax.value_and_grad
    def size(values):
        changed = dataclasses.replace(model(), retardation=1e-5 * values[0])
        changed = dataclasses.replace(changed, load=changed.load * values[1])
        found = transfer(changed, jnp.array([3000.0]))
        return 1e-9 * jnp.sum(jnp.abs(found.acceleration_by_errors[0, :, :, 1]))

    at = jnp.ones(2)
    _, slope = size(at)
    for k in range(2):
        away = jnp.zeros(2).at[k].set(1e-4)
        difference = (size(at + away)[0] - size(at - away)[0]) / 2e-4
        assert float(slope[k]) == pytest.approx(float(difference), rel=DIFFERENCE)


def test_wrong_frequencies():
    with pytest.raises(ValueError, match="`frequencies` is .* a list of them"):
        transfer(model(), 100.0)
    with pytest.raises(TypeError, match="numbers in Hz"):
        transfer(model(), ["100 Hz"])

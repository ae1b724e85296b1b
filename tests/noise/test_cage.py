"""A cage with its contacts: balances that hold for any law, and rolling by hand."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, taper
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.noise import (
    CageContact,
    GuidedCage,
    NoiseModel,
    needed_steps,
    vibration,
)
from bearingjax.noise.dynamics.cage import cage_forces, cage_loads, fastest_of_cage
from bearingjax.noise.dynamics.stepping import step_motion
from bearingjax.noise.static_start import static_start

RADIUS = 0.026
CAGE = GuidedCage(0.02, 1.3e-5, CageContact(5e-6), 0.2e-3, 0.1e-3)
UNLIKE = balls(7, ball_deviation=1e-6 * np.array([0, 3, 0, -2, 0, 0, 1.0]))


def model(cage=CAGE, speed=0.0, bearing=UNLIKE):
    element = bj.BearingElement(bearing)
    load = [0.0, -20.0, -200.0, 0.0, 0.0, 0.0]
    return NoiseModel(element, 0.3, load, bj.Speed(speed), cage=cage, tilts=False)


def test_cage_forces_are_balanced_and_symmetric():
    rng = np.random.default_rng(1)
    azimuth = 2 * np.pi / 7 * np.arange(7)
    scale = np.array([*[1.5e-4] * 9, 1.5e-4 / RADIUS, 1e-5, 1e-5])
    at = jnp.asarray(scale * rng.normal(size=12))

    def forces(at):
        places = at[7:10], at[:7], at[10:], jnp.asarray(RADIUS), jnp.asarray(azimuth)
        found = cage_forces(*cage_loads(CAGE, *places), *places)
        return jnp.concatenate(found)

    found = np.asarray(forces(at))
    arcs, cage, ring = found[:7], found[7:10], found[10:]
    size = np.abs(arcs).max()
    assert size > 1.0 and np.abs(ring).max() > 1.0
    along = np.stack([-np.sin(azimuth), np.cos(azimuth)])
    atol = ROUNDING * np.abs(found).max()
    np.testing.assert_allclose(along @ arcs + cage[:2] + ring, 0.0, atol=atol)
    assert RADIUS * arcs.sum() + cage[2] == pytest.approx(0.0, abs=atol)
    # With an energy.
    slope = np.asarray(jax.jacfwd(forces)(at))
    np.testing.assert_allclose(slope, slope.T, atol=SOLVER * np.abs(slope).max())
    # How fast the parts move on these contacts, against a bound for all of them.
    mass = np.array([*[0.003] * 7, 0.02, 0.02, 1.3e-5, 0.3, 0.3])
    fastest = np.sqrt(np.linalg.eigvalsh(slope / np.sqrt(np.outer(mass, mass)))[-1])
    numbers = (jnp.asarray(x) for x in (0.003, 0.3, RADIUS))
    bound = float(fastest_of_cage(CAGE, jnp.asarray(size), 7, *numbers))
    assert 0.3 * bound < fastest <= bound


def test_cage_forces_vanish_for_centred_cage():
    still = jnp.zeros(3)
    places = still, jnp.zeros(7), still[:2], jnp.asarray(RADIUS), jnp.arange(7.0)
    found = cage_forces(*cage_loads(CAGE, *places), *places)
    assert not any(np.any(part) for part in found)


@pytest.fixture(scope="module")
def moved():
    """Function (model, speed of the cage's turn [rad/s]) -> how all moves from rest."""

    @jax.jit
    def run(model, rate):
        system = model.system(8)
        start, _ = static_start(model, system)
        masses = system.masses
        start = jnp.pad(start, (0, masses.shape[0] - start.shape[0]))
        velocity = jnp.zeros_like(start).at[-1].set(rate)

        def acceleration(motion, velocity, time):
            return system.forces(motion, velocity, time, start) / masses

        step = jnp.asarray(2e-6)
        found = step_motion(acceleration, (start, velocity), step, 40, 25)
        return found, system.masses

    return run


@pytest.mark.slow
def test_balls_settle_at_individual_orbit_speeds(moved):
    """From its own diameter and contact angle, as the load solve has it."""
    turning = model(speed=20.0)
    found, _ = moved(turning, 0.0)
    solution = bj.solve_load(
        turning.element,
        turning.load,
        support=bj.Support(fixed_ring="inner", free=("ux", "uy", "uz")),
    )
    assert isinstance(solution, bj.statics.BallSolution)
    cosine = np.cos(np.asarray(solution.contact_angle)).mean(axis=1)
    diameter = 0.0095 + np.asarray(UNLIKE.ball_deviation)
    own = 0.5 * (1.0 - diameter * cosine / 0.052) * 20.0
    even = 0.5 * (1.0 - 0.0095 * np.cos(np.radians(25)) / 0.052) * 20.0
    expected = RADIUS * (own - even)
    size = np.abs(expected).max()
    assert np.ptp(expected) > 0.1 * size
    # The balls' centrifugal force, here 7 mN, is not in the load solve.
    np.testing.assert_allclose(found.end[1][-10:-3], expected, atol=1e-2 * size)


def test_cage_impact_conserves_momentum(moved):
    """Without friction; the contacts' damping takes energy, never momentum."""
    sliding = model(dataclasses.replace(CAGE, friction=0.0))
    found, masses = moved(sliding, 30.0)
    arcs, cage = np.asarray(found.end[1][-10:-3]), np.asarray(found.end[1][-3:])
    masses = np.asarray(masses)
    before = masses[-1] * 30.0
    after = masses[-1] * cage[2] + RADIUS * np.sum(masses[-10:-3] * arcs)
    assert after == pytest.approx(before, rel=SOLVER)
    assert np.all(arcs > 0.0) and np.max(arcs) > 0.1
    energy = masses[-1] * cage[2] ** 2 + np.sum(masses[-10:-3] * arcs**2)
    assert energy < masses[-1] * 30.0**2
    # Linear momentum too: the land is not reached, all bars push alike or not.
    azimuth = 2 * np.pi / 7 * np.arange(7)
    along = np.stack([-np.sin(azimuth), np.cos(azimuth)])
    total = masses[-2] * cage[:2] + along @ (masses[-10:-3] * arcs)
    scale = np.sum(masses[-10:-3] * arcs)
    np.testing.assert_allclose(total, 0.0, atol=1e-2 * scale)


@pytest.mark.slow
def test_a_stiff_cage_needs_shorter_steps():
    with_film = [
        dataclasses.replace(CAGE, contact=CageContact(film, 1e-10))
        for film in (5e-6, 1e-9)
    ]
    turning = model(None, 1200.0)
    soft, stiff = (
        needed_steps(dataclasses.replace(turning, cage=cage), 64) for cage in with_film
    )
    assert soft < 0.5 * stiff


@pytest.mark.slow
def test_a_record_of_a_cage():
    heavy = dataclasses.replace(CAGE, load=jnp.array([0.0, -5.0]))
    record = vibration(model(heavy, 1200.0), turns=1, settle=0, samples=64, steps=60)
    assert record.cage is not None
    place = np.asarray(record.cage.displacement)
    assert np.all(np.isfinite(record.cage.acceleration))
    off = np.hypot(place[:, 0], place[:, 1])
    # It falls on the land, and no deeper than the contact gives way.
    assert 0.045e-3 < off.max() < 0.09e-3
    # In free fall at first.
    fallen = -0.5 * 250.0 * float(record.time[1]) ** 2
    np.testing.assert_allclose(place[1], [0.0, fallen, 0.0], rtol=1e-9, atol=1e-15)
    even = np.asarray(record.azimuth) - np.asarray(record.azimuth)[:1]
    assert np.ptp(even[-1]) > 0.0


@pytest.mark.slow
def test_derivatives_of_forces():
    turning = model(speed=500.0)
    rng = np.random.default_rng(5)
    n = 3 + 14 + 7 + 3
    away = np.array([*[0.0] * 17, *1.5e-4 * rng.normal(size=7), 6e-5, -4e-5, 3e-3])
    way = rng.normal(size=n)

    @jax.jit
    @jax.value_and_grad
    def work(values):
        contact = CageContact(5e-6 * values[0], 2.81e-8 * values[1])
        cage = dataclasses.replace(
            CAGE,
            contact=contact,
            pocket_clearance=0.2e-3 * values[2],
            land_clearance=0.1e-3 * values[3],
            friction=0.05 * values[4],
            sliding_speed=0.05 * values[5],
        )
        changed = dataclasses.replace(turning, cage=cage)
        system = changed.system(8)
        start, _ = static_start(turning, system)
        start = jnp.pad(start, (0, n - start.shape[0]))
        velocity = 1e-2 * jnp.asarray(rng.normal(size=n))
        time = jnp.asarray(1e-3)
        found = system.forces(start + jnp.asarray(away), velocity, time, start)
        return found @ jnp.asarray(way)

    at = jnp.ones(6)
    _, slope = work(at)
    assert np.all(np.asarray(slope) != 0.0)
    for k in range(6):
        step = jnp.zeros(6).at[k].set(1e-6)
        difference = (work(at + step)[0] - work(at - step)[0]) / 2e-6
        size = np.abs(slope).max()
        assert float(slope[k]) == pytest.approx(
            float(difference), abs=1e-8 * size, rel=DIFFERENCE
        )


def test_wrong_cages():
    with pytest.raises(ValueError, match="`guiding_ring` is 'shaft'"):
        dataclasses.replace(CAGE, guiding_ring="shaft")
    with pytest.raises(ValueError, match=r"`load` has shape \(3,\)"):
        dataclasses.replace(CAGE, load=jnp.zeros(3))
    with pytest.raises(TypeError, match="`cage` is given for a TaperedRoller"):
        model(bearing=taper(5))

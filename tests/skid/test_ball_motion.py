"""One ball: kinematics, tractions and rates against vectors written out."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from han_chu import BEARING, DIAMETER, OIL_TEMPERATURE, PITCH_DIAMETER
from tolerances import ROUNDING

from bearingjax.contact.point_law import FreeAngle
from bearingjax.element.balls.ball_speed import ball_kinematics
from bearingjax.element.inertia import Speed
from bearingjax.lubrication import (
    Eyring,
    Newtonian,
    WarmInlet,
    inlet_heating,
    mil_l_23699,
)
from bearingjax.lubrication.film_factors import at_least
from bearingjax.skid.ball_motion import (
    BallState,
    kinetic_energy,
    rates,
    residual_moments,
    sliding,
    tractions,
)
from bearingjax.skid.contact_loads import loaded_ball
from bearingjax.skid.model import Oil

GAMMA, ALPHA = 0.238339, np.radians(25.0)
UP = np.array([0.0, 0.0, 1.0])
ALONG = np.array([1.0, 0.0, 0.0])
CENTRE = np.array([0.0, 0.5 * PITCH_DIAMETER, 0.0])


def under(load, angle):
    oil = Oil(mil_l_23699(), jnp.asarray(OIL_TEMPERATURE), jnp.asarray(1e-8))
    return loaded_ball(BEARING, FreeAngle(), oil, load, angle)


@pytest.fixture(scope="module")
def ball():
    """Unlike loads and angles at its contacts."""
    return jax.jit(under)(jnp.array([110.0, 95.0]), jnp.array([0.41, 0.47]))


def motions():
    rng = np.random.default_rng(3)
    for _ in range(4):
        spin = jnp.asarray(rng.normal(0.0, 200.0, 3))
        orbit = jnp.asarray(rng.normal(80.0, 20.0))
        outer, inner = rng.normal(0.0, 150.0, 2)
        yield BallState(spin, orbit), Speed(inner=inner, outer=outer)


def test_pure_rolling_of_the_paper():
    """Its numbers are the validation case `han_chu_rolling`."""
    normal = jnp.array([np.sin(ALPHA), np.cos(ALPHA)])
    one, gamma = jnp.ones(()), jnp.asarray(GAMMA)
    k = ball_kinematics(normal, normal, one, gamma, Speed(inner=209.4395))
    wanted = 209.4395 * 0.5 * (1.0 - GAMMA * np.cos(ALPHA))
    np.testing.assert_allclose(k.orbit, wanted, rtol=ROUNDING)
    wanted = k.orbit * (1.0 / GAMMA + np.cos(ALPHA))
    np.testing.assert_allclose(k.rotation * (k.axis @ normal), wanted, rtol=ROUNDING)


def test_no_slip_for_any_spin_axis(ball):
    """AF001-9: whatever the share of the raceways, all four centre slips vanish."""
    for share in (0.0, 0.3, 1.0):
        for speed in (Speed(inner=209.0), Speed(inner=-50.0, outer=130.0)):
            normals = jnp.stack([jnp.sin(ball.angle), jnp.cos(ball.angle)], axis=1)
            gamma = jnp.asarray(DIAMETER / PITCH_DIAMETER)
            k = ball_kinematics(
                normals[0], normals[1], jnp.asarray(share), gamma, speed
            )
            across, along = k.rotation * k.axis
            spin = jnp.stack([jnp.zeros_like(along), across, -along])
            moving = sliding(ball, BallState(spin, k.orbit), speed)
            assert np.max(np.abs(moving.slip)) < 1e-12
            np.testing.assert_allclose(moving.spin, k.spin, rtol=1e-10, atol=1e-10)


def section(ball):
    """Contact points, normals and tangents across, in (x, y, z) from the centre."""
    cos, sin, none = np.cos(ball.angle), np.sin(ball.angle), np.zeros(2)
    n = np.stack([none, cos, sin], axis=1)
    t = np.stack([none, -sin, cos], axis=1)
    arm = 0.5 * DIAMETER * np.array([1.0, -1.0])[:, None]
    return arm * n, n, t


def test_slip_is_the_difference_of_surface_velocities(ball):
    """Also off the middle of a contact, and with both rings turning."""
    points, _, tangents = section(ball)
    for state, speed in motions():
        moving = sliding(ball, state, speed)
        orbiting = float(state.orbit) * UP
        whole = np.asarray(state.spin) + orbiting
        for c, ring in enumerate((float(speed.outer), float(speed.inner))):
            for x, y in ((0.0, 0.0), (2e-4, -7e-4)):
                at = points[c] + x * ALONG + y * tangents[c]
                of_ball = np.cross(orbiting, CENTRE) + np.cross(whole, at)
                slip = of_ball - np.cross(ring * UP, CENTRE + at)
                spun = np.asarray(moving.spin[c]) * np.array([y, -x])
                got = np.asarray(moving.slip[c]) + spun
                want = [slip[0], slip @ tangents[c]]
                np.testing.assert_allclose(got, want, rtol=1e-11, atol=1e-12)


def test_tractions_film_with_inlet_heating(ball):
    """Films of the formula, and at rest as thick as cool ones."""
    oil, warm = mil_l_23699(), jnp.asarray(OIL_TEMPERATURE)
    loading = oil.thermal_loading(warm, 1.0)
    heated = dataclasses.replace(ball, inlet=WarmInlet(loading, jnp.asarray(1.13e11)))
    draw = jax.jit(tractions)
    for state, speed in motions():
        moving = sliding(ball, state, speed)
        cool = jax.vmap(lambda film, u: film.central(u))(ball.film, moving.entrainment)
        for c, film in enumerate(draw(heated, Newtonian(), moving).film):
            slip, entrained = moving.slip[c, 0], moving.entrainment[c]
            heat = oil.thermal_loading(warm, entrained)
            pressure = ball.patch.peak_pressure[c]
            factor = inlet_heating(heat, pressure, 1.13e11, slip / entrained)
            assert factor < 0.99
            want = at_least(factor * cool[c], ball.least_film)
            np.testing.assert_allclose(film, want, rtol=ROUNDING)
    still = sliding(ball, BallState(jnp.zeros(3), jnp.zeros(())), Speed())
    np.testing.assert_array_equal(
        draw(heated, Newtonian(), still).film, draw(ball, Newtonian(), still).film
    )


@pytest.mark.parametrize("law", [Newtonian(), Eyring(5e6)], ids=["newton", "eyring"])
def test_power(ball, law):
    """Of the rings and of other forces, less the change of kinetic energy: that is the
    heat, which is never negative (AF001-10)."""
    pull = jnp.asarray(3.0)

    @jax.jit
    def balance(state, speed):
        pulls = tractions(ball, law, sliding(ball, state, speed))
        change = rates(ball, state, pulls, pull)
        _, stored = jax.jvp(lambda s: kinetic_energy(ball, s), (state,), (change,))
        torque = pulls.ring_torque
        rings = -(torque[0] * speed.outer + torque[1] * speed.inner)
        other = pull * ball.pitch_radius * state.orbit
        return rings + other, stored, pulls.resultants.heat

    for state, speed in motions():
        given, stored, heat = balance(state, speed)
        assert np.all(heat > 0.0)
        size = abs(float(given)) + abs(float(stored))
        np.testing.assert_allclose(given - stored, np.sum(heat), atol=1e-11 * size)


def test_moments_are_those_of_the_forces(ball):
    points, normals, tangents = section(ball)
    for state, speed in motions():
        pulls = tractions(ball, Newtonian(), sliding(ball, state, speed))
        forces = np.asarray(pulls.resultants.force)
        for c in range(2):
            force = forces[c, 0] * ALONG + forces[c, 1] * tangents[c]
            spun = -float(pulls.resultants.moment[c]) * normals[c]
            want = np.cross(points[c], force) + spun
            np.testing.assert_allclose(pulls.moment[c], want, rtol=1e-11, atol=1e-12)
            on_ring = -np.cross(CENTRE + points[c], force)[2] - spun[2]
            np.testing.assert_allclose(pulls.ring_torque[c], on_ring, rtol=1e-11)


def test_rates_of_free_ball_keep_angular_momentum(ball):
    """Seen from outside: dΩ/dt + ω x Ω = 0, and its orbit stays."""
    for state, speed in motions():
        pulls = tractions(ball, Newtonian(), sliding(ball, state, speed))
        nothing = jax.tree.map(jnp.zeros_like, pulls)
        change = rates(ball, state, nothing, jnp.zeros(()))
        orbiting = float(state.orbit) * UP
        moved = np.asarray(change.spin) + float(change.orbit) * UP
        turned = np.cross(orbiting, np.asarray(state.spin) + orbiting)
        np.testing.assert_allclose(moved, -turned, atol=1e-9)
        assert float(change.orbit) == 0.0


def test_rates_and_forces_agree(ball):
    for state, speed in motions():
        pulls = tractions(ball, Newtonian(), sliding(ball, state, speed))
        moment, force = residual_moments(ball, state, pulls, jnp.asarray(1.0))
        change = rates(ball, state, pulls, jnp.asarray(1.0))
        mass = float(ball.mass * ball.pitch_radius)
        np.testing.assert_allclose(mass * change.orbit, force, rtol=1e-12)
        spinning = np.asarray(change.spin) + float(change.orbit) * UP
        np.testing.assert_allclose(float(ball.moment) * spinning, moment, rtol=1e-9)


def test_tractions_of_unloaded_ball_vanish():
    """Values and gradients are finite, at rest too."""

    @jax.jit
    def pulled(load, spin):
        one = under(load, jnp.array([0.41, 0.47]))
        moving = sliding(one, BallState(spin, jnp.zeros(())), Speed())
        return tractions(one, Newtonian(), moving).moment

    slopes = jax.jacfwd(pulled, argnums=(0, 1))
    for spin in (jnp.zeros(3), jnp.array([1.0, 2.0, 3.0])):
        np.testing.assert_array_equal(pulled(jnp.zeros(2), spin), 0.0)
        assert all(np.all(np.isfinite(s)) for s in slopes(jnp.zeros(2), spin))

"""Rollers that skid: one roller against balls and against itself, and where it ends."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import bearings
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax import skid
from bearingjax.element.constants import contact_constants
from bearingjax.element.inertia import Speed, roller_speeds
from bearingjax.lubrication import Eyring, Newtonian, mil_l_23699
from bearingjax.numerics.result import Result
from bearingjax.skid import Cage, Drag, SkidModel, ball_motion
from bearingjax.skid.contact_loads import loaded_roller
from bearingjax.skid.model import Oil
from bearingjax.skid.roller_motion import (
    RollerState,
    kinetic_energy,
    pure_rolling,
    rates,
    residual_moments,
    sliding,
    tractions,
)

ROLLERS, PLACES = 7, 56
BEARING = bearings()["cylindrical, crowned ends"]
OIL, WARM = mil_l_23699(), 363.15
FAST = 1500.0
CONSTANTS = contact_constants(
    BEARING, bj.contact.Palmgren(), bj.numerics.ContactMapped(24)
)


def loaded(line_load):
    line_load = jnp.asarray(line_load)
    load = 0.01372 * jnp.mean(line_load, axis=1)
    oil = Oil(OIL, jnp.asarray(WARM), jnp.asarray(1e-8))
    return loaded_roller(CONSTANTS, oil, load, line_load)


@pytest.fixture(scope="module")
def roller():
    """Unlike loads, that of the inner raceway on a part of the length alone."""
    along = np.linspace(-1.0, 1.0, 16)
    return jax.jit(loaded)([3e4 + 1e4 * along, np.maximum(2e4 * along, 0.0)])


def motions():
    rng = np.random.default_rng(5)
    for _ in range(4):
        spin, orbit = (jnp.asarray(v) for v in rng.normal([-900.0, 300.0], 100.0))
        outer, inner = rng.normal(0.0, 500.0, 2)
        yield RollerState(spin, orbit), Speed(inner=inner, outer=outer)


def test_moves_as_a_ball_without_contact_angle(roller):
    """Slip, entrainment, moments, torques and rates under the same tractions."""
    ball = ball_motion.LoadedBall(
        roller.mass,
        roller.moment,
        roller.diameter,
        roller.pitch_radius,
        roller.load,
        jnp.zeros(2),
        roller.patch,
        roller.film,
        roller.least_film,
        roller.inlet,
        (1.0, -1.0),
    )
    push = jnp.asarray(2.0)
    for state, speed in motions():
        other = ball_motion.BallState(jnp.array([0.0, 0.0, state.spin]), state.orbit)
        moving = sliding(roller, state, speed)
        of_ball = ball_motion.sliding(ball, other, speed)
        np.testing.assert_allclose(moving.slip, of_ball.slip[:, 0], rtol=ROUNDING)
        np.testing.assert_allclose(
            moving.entrainment, of_ball.entrainment, rtol=ROUNDING
        )
        pulls = tractions(roller, Eyring(), moving)
        pulls_of_ball = ball_motion.tractions(
            ball, Eyring(), of_ball._replace(spin=jnp.zeros(2))
        )
        np.testing.assert_allclose(
            pulls.moment, pulls_of_ball.moment[:, 2], rtol=ROUNDING
        )
        np.testing.assert_allclose(
            pulls.ring_torque, pulls_of_ball.ring_torque, rtol=ROUNDING
        )
        change = rates(roller, state, pulls, push)
        change_of_ball = ball_motion.rates(ball, other, pulls_of_ball, push)
        np.testing.assert_allclose(change.spin, change_of_ball.spin[2], rtol=ROUNDING)
        np.testing.assert_allclose(change.orbit, change_of_ball.orbit, rtol=ROUNDING)


def test_pure_rolling(roller):
    """As of the bearing at speed; there is no slip."""
    for _, speed in motions():
        free = pure_rolling(roller, speed)
        orbit, spin = roller_speeds(CONSTANTS, speed)
        np.testing.assert_allclose(free.orbit, orbit, rtol=ROUNDING)
        np.testing.assert_allclose(free.spin, spin, rtol=ROUNDING)
        slip = sliding(roller, free, speed).slip
        np.testing.assert_allclose(slip, 0.0, atol=1e-12 * 30.0)


@pytest.mark.parametrize("law", [Newtonian(), Eyring(5e6)], ids=["newton", "eyring"])
def test_power(roller, law):
    """Of the rings and of other forces, less the change of kinetic energy: the heat."""
    pull = jnp.asarray(3.0)

    @jax.jit
    def balance(state, speed):
        pulls = tractions(roller, law, sliding(roller, state, speed))
        change = rates(roller, state, pulls, pull)
        _, stored = jax.jvp(lambda s: kinetic_energy(roller, s), (state,), (change,))
        torque = pulls.ring_torque
        rings = -(torque[0] * speed.outer + torque[1] * speed.inner)
        other = pull * roller.pitch_radius * state.orbit
        spinning, orbiting = residual_moments(roller, pulls, pull)
        held = spinning - roller.moment * (change.spin + change.orbit)
        pushed = orbiting - roller.mass * roller.pitch_radius * change.orbit
        return rings + other, stored, pulls.heat, held, pushed

    for state, speed in motions():
        given, stored, heat, held, pushed = balance(state, speed)
        assert np.all(heat > 0.0)
        size = abs(float(given)) + abs(float(stored))
        np.testing.assert_allclose(given - stored, np.sum(heat), atol=1e-11 * size)
        np.testing.assert_allclose([held, pushed], 0.0, atol=1e-9)


def test_tractions_of_unloaded_roller_vanish():
    """Values and gradients are finite, at rest too."""

    @jax.jit
    def pulled(line_load, spin):
        one = loaded(line_load)
        moving = sliding(one, RollerState(spin, jnp.zeros(())), Speed())
        found = tractions(one, Newtonian(), moving)
        return jnp.concatenate([found.moment, found.film])

    slopes = jax.jacfwd(pulled, argnums=(0, 1))
    nothing = jnp.zeros((2, 16))
    for spin in jnp.array([0.0, 30.0]):
        np.testing.assert_array_equal(pulled(nothing, spin)[:2], 0.0)
        assert all(np.all(np.isfinite(s)) for s in slopes(nothing, spin))


def bearing_model(at, cage=None):
    _, _, _, fill, clearance, warmer, diameter = at
    bearing = bj.CylindricalRollerBearing(
        ROLLERS,
        0.0725,
        diameter,
        0.01372,
        roller_profile=BEARING.roller_profile,
        radial_internal_clearance=clearance,
    )
    drag, cage = Drag(fill=fill), Cage() if cage is None else cage
    element = bj.BearingElement(bearing)
    return SkidModel(element, OIL, WARM + warmer, drag=drag, cage=cage)


def steady(at):
    """Of load [N], inner and outer speed [rad/s], fill [1], clearance [m], warmth [K]
    and diameter [m]."""
    load, inner, outer, *_ = at
    model = bearing_model(at)
    loads = jnp.zeros(6).at[0].set(load)
    speed = Speed(inner=inner, outer=outer)
    return skid.steady(
        model,
        loads,
        speed=speed,
        places=PLACES,
        support=bj.Support(free=["ux", "uy"]),
        throw=False,
    )


BASE = np.array([300.0, FAST, 0.0, 0.03, 1e-6, 0.0, 0.014])
"""Little clearance: a single loaded roller would not hold its ring sideways."""
STEPS = np.array([1.0, 1.0, 1.0, 1e-4, 1e-8, 1e-2, 1e-7])
LOADS = 60.0, 150.0, 300.0, 1000.0, 10_000.0


@pytest.fixture(scope="module")
def found():
    """All motions of this module in one call."""
    loads = [BASE.copy() for _ in LOADS]
    for at, load in zip(loads, LOADS, strict=True):
        at[0] = load
    slow, back, none, rest, both, stiff, lost = (BASE.copy() for _ in range(7))
    slow[1], back[1], none[3], rest[1] = 0.5 * FAST, -FAST, 0.0, 0.0
    both[2], lost[0] = -200.0, np.nan
    stiff[0], stiff[5] = 20_000.0, -110.0  # oil that is a glass: no slip to speak of
    eye = np.diag(STEPS)
    moved = [BASE + n * step for step in eye for n in (-2.0, -1.0, 1.0, 2.0)]
    cases = jnp.asarray([*loads, slow, back, none, rest, both, stiff, lost, *moved])
    all_of = jax.tree.map(np.asarray, jax.jit(jax.vmap(steady))(cases))
    names = [*LOADS, "slow", "back", "none", "rest", "both", "stiff", "lost"]
    ends = {n: jax.tree.map(lambda a, k=k: a[k], all_of) for k, n in enumerate(names)}
    return ends, jax.tree.map(lambda a: a[len(names) :], all_of)


@pytest.mark.slow
def test_slip_falls_with_load_and_rises_with_speed(found):
    ends, _ = found
    for name, end in ends.items():
        failed = name == "lost"
        assert (int(end.result) != Result.CONVERGED) == failed, name
    slip = [ends[load].slip[0] for load in LOADS]
    assert np.all(np.diff(slip) < 0)
    assert slip[0] > 0.3 and 0.0 < slip[-1] < 3e-3
    assert ends["slow"].slip[0] < ends[300.0].slip[0]
    # At high load the orbit is that of pure rolling, ω (1 - γ)/2.
    want = 0.5 * FAST * (1.0 - 14.0 / 72.5)
    np.testing.assert_allclose(ends[10_000.0].rolling_orbit_speed, want, rtol=1e-12)


@pytest.mark.parametrize("name", [60.0, 1000.0, "both"])
@pytest.mark.slow
def test_steady_roller_loads_match_orbit_speed(found, name):
    """Rollers are thrown outwards as they orbit, however far they slip, and those that
    stand in the bearing carry its load."""
    end = found[0][name]
    centrifugal = end.contact_load[:, 0] - end.contact_load[:, 1]
    mass = 7800.0 * np.pi / 4.0 * 0.014**2 * 0.01372
    density = float(BEARING.material.density) / 7800.0
    want = density * mass * 0.03625 * end.cage_speed**2
    # Along the roller the loads of both raceways are parallel where it is not tilted.
    np.testing.assert_allclose(centrifugal, want, rtol=1e-6)
    at, angle = (v[:: PLACES // ROLLERS] for v in (end.contact_load, end.azimuth))
    load = name if isinstance(name, float) else BASE[0]
    np.testing.assert_allclose(at[:, 1] @ np.cos(angle), load, rtol=1e-9)
    np.testing.assert_allclose(at[:, 1] @ np.sin(angle), 0.0, atol=1e-8 * load)


@pytest.mark.slow
def test_steady_rollers_power_and_force_balance(found):
    """Power of the drive is heat; forces of the cage add up to nothing; tractions on
    a roller add up to those of cage and oil."""
    for name in (*LOADS, "slow", "back", "both", "stiff"):
        end = found[0][name]
        p = end.power
        lost = p.contacts + p.drag + p.cage
        np.testing.assert_allclose(lost, p.drive, rtol=1e-7, err_msg=str(name))
        size = np.sum(np.abs(end.cage_force))
        np.testing.assert_allclose(np.sum(end.cage_force), 0.0, atol=1e-7 * size)
        # Heat is force times slip, in every contact.
        traction = -end.heat / end.sliding
        drag = p.drag / (-ROLLERS * 0.03625 * end.cage_speed)
        balance = traction.sum(axis=1) - drag
        np.testing.assert_allclose(balance, end.cage_force, atol=SOLVER * size)


@pytest.mark.slow
def test_loaded_rollers_drive_the_cage(found):
    """And the cage the others, against the drag of the oil."""
    end = found[0][300.0]
    loaded = end.contact_load[:, 1] > 1.0
    assert np.sum(loaded) > 2
    assert np.sum(end.cage_force[loaded]) < 0.0
    assert np.all(end.cage_force[~loaded] > 0.0)
    # They slow down on the way round, and are spun up where they are loaded.
    end = found[0][1000.0]
    ratio = end.spin / end.rolling_spin
    assert 0 < np.argmax(ratio) < PLACES // 2 < np.argmin(ratio)
    assert ratio.min() < 0.995 * ratio.max()


@pytest.mark.slow
def test_steady_rollers_roll_without_drag(found):
    end = found[0]["none"]
    np.testing.assert_allclose(end.slip, 0.0, atol=SOLVER)
    np.testing.assert_allclose(end.spin, end.rolling_spin, rtol=SOLVER)


@pytest.mark.slow
def test_standstill_and_sense_of_rotation(found):
    ends, _ = found
    rest, back, forward = ends["rest"], ends["back"], ends[300.0]
    np.testing.assert_array_equal(rest.spin, 0.0)
    np.testing.assert_array_equal(rest.orbit_speed, 0.0)
    np.testing.assert_allclose(back.cage_speed, -forward.cage_speed, rtol=SOLVER)
    # The load is along x, the azimuth of the first place.
    mirrored = np.roll(forward.spin[::-1], 1)
    np.testing.assert_allclose(back.spin, -mirrored, rtol=1e-7)
    np.testing.assert_allclose(back.friction_torque, -forward.friction_torque)


def measured(end):
    """Slip, torque and a force of the cage, in one number."""
    return 10.0 * end.slip[0] + end.friction_torque + 0.1 * end.cage_force[1]


@pytest.mark.slow
def test_gradients(found):
    """By load, speeds, oil, clearance and diameter."""
    slopes = jax.jit(jax.grad(lambda at: measured(steady(at))))(jnp.asarray(BASE))
    values = np.asarray(jax.vmap(measured)(found[1])).reshape(len(STEPS), 4)
    wide, narrow = (values[:, 4 - k] - values[:, k - 1] for k in (1, 2))
    want = (8.0 * narrow - wide) / (12.0 * STEPS)
    np.testing.assert_allclose(slopes, want, rtol=DIFFERENCE)


@pytest.mark.slow
def test_simulated_rollers_reach_steady_state(found):
    """With pockets so tight and stiff that all orbit with the cage; from rolling on,
    the last orbits."""
    end = found[0][1000.0]
    model = bearing_model(BASE, Cage(pocket_clearance=0.0, stiffness=1e7))
    turn, duration = 2.0 * np.pi / float(end.cage_speed), 0.3
    moved = skid.simulate(
        model,
        [1000.0, 0, 0, 0, 0, 0],
        speed=Speed(inner=FAST),
        times=np.append(0.0, duration - turn * np.linspace(2.0, 0.0, 201)),
        support=bj.Support(free=["ux", "uy"]),
        options=skid.SkidOptions(
            1e-5, load_speed=Speed(end.cage_speed, end.cage_speed)
        ),
    )
    assert moved.slip[0] == pytest.approx(0.0, abs=1e-9)
    last = np.asarray(moved.slip)[2:]
    np.testing.assert_allclose(np.mean(last), end.slip[0], rtol=1e-4)
    torque = np.mean(moved.friction_torque[2:])
    np.testing.assert_allclose(torque, end.friction_torque, rtol=1e-4)
    assert np.max(np.abs(moved.imbalance)) < 1e-6 * moved.work.drive[-1]
    # Spins, and what the pockets do: rear and front, at the places of the steady state.
    azimuth = np.mod(np.asarray(moved.azimuth)[2:], 2.0 * np.pi).ravel()
    for k in (0, 14, 28, 42):
        apart = np.mod(azimuth - end.azimuth[k] + np.pi, 2.0 * np.pi) - np.pi
        near = np.abs(apart) < 0.05
        spin = np.mean(np.asarray(moved.spin)[2:].ravel()[near])
        np.testing.assert_allclose(spin, end.spin[k], rtol=2e-3)
        force = np.mean(np.asarray(moved.cage_force)[2:].ravel()[near])
        np.testing.assert_allclose(force, end.cage_force[k], atol=0.5)


def test_bad_input():
    model = SkidModel(bj.BearingElement(BEARING), OIL, WARM)
    load, free = [300.0, 0, 0, 0, 0, 0], ["ux", "uy"]
    with pytest.raises(ValueError, match="multiple of the 7 rollers"):
        skid.steady(
            model,
            load,
            speed=Speed(inner=FAST),
            support=bj.Support(free=free),
            places=10,
        )
    with pytest.raises(TypeError, match="ball bearing"):
        options = skid.SkidOptions(balanced=True)
        times = np.array([0.0, 0.1])
        skid.simulate(
            model, load, speed=Speed(inner=FAST), times=times, options=options
        )

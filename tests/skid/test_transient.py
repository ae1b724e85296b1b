"""Balls and cage in time: power, momentum, the state in which it ends, odd cases.

Nearly all by one program: a table of loads around the bearing, speeds with a knot.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from han_chu import BEARING, FREE, MODEL, SPEED

import bearingjax as bj
from bearingjax import skid
from bearingjax.numerics.result import Result, SolveError
from bearingjax.skid import LoadHistory, SinusoidalLoad, SkidOptions, SpeedTable
from bearingjax.skid.motion import SkidSystem, each_ball
from bearingjax.skid.transients.beginning import surroundings

BALLS, PLACES, STEADY_PLACES = 5, 96, 100
KNOT = 0.004
LIGHT = np.array([0.0, 0.0, 16.0, 0.0, 0.0, 0.0])
BOTH = np.array([160.0, 0.0, 250.0, 0.0, 0.0, 0.0])
FIVE = bj.AngularContactBallBearing(
    BALLS,
    BEARING.pitch_diameter,
    BEARING.ball_diameter,
    outer_osculation=0.52,
    inner_osculation=0.52,
    contact_angle=BEARING.contact_angle,
    material=BEARING.material,
)
CONTROL = MODEL.element.raceway_control
FEW = eqx.tree_at(
    lambda m: m.element, MODEL, bj.BearingElement(FIVE, raceway_control=CONTROL)
)
EVEN = SpeedTable([0.0, KNOT], jnp.full(2, SPEED.inner))
FROM_REST = SpeedTable([0.0, KNOT], jnp.stack([jnp.zeros(()), SPEED.inner]))


def with_cage(**fields):
    model = FEW
    for name, value in fields.items():
        one = jnp.asarray(np.float64(value))
        model = eqx.tree_at(lambda m, n=name: getattr(m.cage, n), model, one)
    return model


def run(
    load=LIGHT, *, model=FEW, speed=EVEN, duration=0.02, start=None, throw=True, **given
):
    options = {"tolerance": 1e-7, "max_steps": 3000, "places": PLACES, **given}
    return skid.simulate(
        model,
        load,
        speed=speed,
        times=duration * np.linspace(0.0, 1.0, 21),
        start=start,
        support=bj.Support(free=FREE),
        options=SkidOptions(**options),
        throw=throw,
    )


def steady(load):
    """With the loads of pure rolling, as they are tabulated in time."""
    given = dict(speed=SPEED, load_speed=SPEED, support=bj.Support(FREE))
    return skid.steady(FEW, load, **given, places=STEADY_PLACES)


@pytest.fixture(scope="module")
def prepared():
    """What the balls of the bearing under both loads move in, and their start."""
    solution = bj.solve_load(
        FEW.element, BOTH, speed=SPEED, support=bj.Support(free=FREE)
    )
    return surroundings(FEW, solution, SPEED, EVEN, jnp.zeros(()), PLACES)


@pytest.mark.parametrize(
    "given",
    [
        dict(),
        dict(load=BOTH),
        dict(speed=FROM_REST),
        dict(load=BOTH, axis="horizontal"),
        dict(load=BOTH, model=with_cage(pocket_clearance=0.0)),
    ],
    ids=["axial", "both loads", "from rest", "horizontal axis", "no clearance"],
)
@pytest.mark.slow
def test_power_balance(given):
    """Work of the drive: heat, drag, and what is stored."""
    found = run(**given)
    work = found.work
    assert int(found.result) == 0 and np.all(np.isfinite(found.cage_force))
    assert np.max(np.abs(found.imbalance)) < 1e-6 * float(work.drive[-1])
    assert np.all(np.diff(work.contacts) > 0) and np.all(np.diff(work.drag) > 0)
    if "load" in given:
        assert np.max(np.abs(found.cage_force)) > 10.0
    if found.power.drive[0] > 0:
        # The integral of the powers as they are reported, as far as times tell.
        mean = np.trapezoid(found.power.drag, found.time)
        np.testing.assert_allclose(work.drag[-1], mean, rtol=1e-2)


@pytest.mark.slow
def test_mean_friction_torque_over_whole_orbits():
    """Of a torque that swings twice an orbit of the cage, over two of four orbits."""
    found = run()
    turn = 2.0 * np.pi * np.linspace(0.0, 4.3, found.time.size)
    found = eqx.tree_at(
        lambda f: (f.state.cage_turn, f.friction_torque),
        found,
        (turn, 5.0 + np.sin(turn) ** 2),
    )
    mean, orbits = found.mean_friction_torque
    assert orbits == 2
    np.testing.assert_allclose(mean, 5.5, rtol=1e-2)
    short = eqx.tree_at(lambda f: f.state.cage_turn, found, 0.2 * turn)
    assert short.mean_friction_torque[1] == 0


@pytest.mark.slow
def test_simulate_from_rest():
    found = run(speed=FROM_REST)
    np.testing.assert_array_equal(found.orbit_speed[0], 0.0)
    np.testing.assert_array_equal(found.spin[0], 0.0)
    assert found.friction_torque[2] > 0.0
    # The drive spins up balls and cage: far from rolling, but not faster.
    at_end = found.slip[-1]
    assert np.all(at_end > 0.1) and np.all(at_end < 1.0)


def test_simulate_error_is_within_tolerance():
    """As long as the balls do not strike the cage."""
    coarse, fine, exact = (
        run(tolerance=t, duration=0.015).slip for t in (1e-6, 5e-7, 1e-9)
    )
    assert np.max(np.abs(coarse - fine)) < 1e-6
    assert np.max(np.abs(fine - exact)) < 5e-7


@pytest.mark.slow
def test_simulate_reaches_steady_state():
    """Balls free in wide pockets; the cage starts with their final speed."""
    end = steady(LIGHT)
    model = with_cage(pocket_clearance=8e-3)
    solution = bj.solve_load(
        model.element, LIGHT, speed=SPEED, support=bj.Support(free=FREE)
    )
    given = solution, SPEED, EVEN, jnp.zeros(()), PLACES
    _, start = surroundings(model, *given)
    start = start._replace(cage_speed=end.cage_speed)
    found = run(model=model, duration=0.8, start=start)
    for got, want in (
        (found.orbit_speed[-1], np.full(BALLS, end.orbit_speed[0])),
        (found.spin[-1], np.tile(end.spin[0], (BALLS, 1))),
        (found.sliding[-1], np.tile(end.sliding[0], (BALLS, 1, 1))),
        (found.film[-1], np.tile(end.film[0], (BALLS, 1))),
        (found.friction_torque[-1], end.friction_torque),
        (found.power.drag[-1], end.power.drag),
        (found.rolling_orbit_speed[-1, 0], end.rolling_orbit_speed[0]),
    ):
        np.testing.assert_allclose(got, want, rtol=1e-6, atol=1e-6 * np.max(want))


@pytest.mark.slow
def test_simulate_follows_periodic_motion_under_radial_load():
    """As long as the balls do not touch the cage."""
    orbit = steady(BOTH)
    wide = with_cage(pocket_clearance=8e-3)
    found = run(BOTH, model=wide, duration=0.1, tolerance=1e-6)
    assert np.max(np.abs(found.cage_force)) == 0.0
    wave = np.fft.rfft(orbit.orbit_speed) / STEADY_PLACES
    wave[1 : STEADY_PLACES // 2] *= 2.0
    along = found.azimuth[12:].ravel() - orbit.azimuth[0]
    turns = np.exp(1j * np.outer(along, np.arange(len(wave))))
    want = (turns @ wave).real
    ripple = np.ptp(np.asarray(orbit.orbit_speed)) / orbit.cage_speed
    got = found.orbit_speed[12:].ravel()
    assert ripple > 0.03 and np.max(np.abs(got / want - 1.0)) < 1e-5


class Varying(eqx.Module):
    """Both kinds of loads that vary, added: one program for either of them."""

    history: LoadHistory
    swing: SinusoidalLoad

    def __call__(self, time):
        return self.history(time) + self.swing(time)


TIMES = [0.0, 0.002, 0.004, 0.012, 0.014]
NOTHING = LoadHistory(TIMES, np.zeros((5, 6)))


@pytest.fixture(scope="module")
def varying():
    """A radial load that turns over with the shaft."""
    swing = SinusoidalLoad(BOTH, [100.0, 0.0, 0.0, 0.0, 0.0, 0.0], SPEED.inner)
    return swing, run(Varying(NOTHING, swing), tolerance=1e-6)


@pytest.mark.slow
def test_simulate_varying_load_matches_static_solutions(varying):
    """Solved alone, with the balls where they are at that time."""
    swing, found = varying
    assert np.ptp(found.displacement[:, 6]) > 5e-7
    # The ring follows the load within 1e-8 s, which is 1e-5 of the 300 N; between steps
    # there are cubics.
    for k, near in ((0, 8e-5), (7, 3e-2), (20, 4e-3)):
        azimuth = np.asarray(found.azimuth[k])
        even = azimuth[0] + 2.0 * np.pi * np.arange(BALLS) / BALLS
        aside = (azimuth - even + np.pi) % (2.0 * np.pi) - np.pi
        bearing = eqx.tree_at(
            lambda b: (b.first_azimuth, b.azimuth_deviation),
            FIVE,
            (jnp.asarray(azimuth[0]), jnp.asarray(aside)),
            is_leaf=lambda leaf: leaf is None,
        )
        element = bj.BearingElement(bearing, raceway_control=CONTROL)
        want: Any = bj.solve_load(
            element, swing(found.time[k]), speed=SPEED, support=bj.Support(free=FREE)
        )
        got = found.contact_load[k]
        np.testing.assert_allclose(got, want.contact_load, atol=near)
        got = found.contact_angle[k]
        np.testing.assert_allclose(got, want.contact_angle, atol=1e-2 * near)
        got = found.displacement[k]
        np.testing.assert_allclose(got, want.displacement, atol=2e-5 * near)


@pytest.mark.slow
def test_simulate_power_balance_under_varying_load(varying):
    _, found = varying
    assert int(found.result) == 0
    assert np.max(np.abs(found.imbalance)) < 1e-6 * float(found.work.drive[-1])


@pytest.mark.slow
def test_simulate_reaches_steady_state_after_load_change():
    """Behind one across the axis; balls free in wide pockets, in no even spacing."""
    axial = np.array([0.0, 0.0, 120.0, 0.0, 0.0, 0.0])
    share = np.array([1.0, 1.0, 0.0, 0.0, 0.0])[:, None]
    history = LoadHistory(TIMES, share * BOTH + (1.0 - share) * axial)
    still = SinusoidalLoad(np.zeros(6), np.zeros(6), SPEED.inner)
    wide = with_cage(pocket_clearance=8e-3)
    found = run(Varying(history, still), model=wide, duration=0.8, tolerance=1e-6)
    end = steady(axial)
    assert np.max(np.abs(found.imbalance)) < 1e-6 * float(found.work.drive[-1])
    for name in ("orbit_speed", "spin", "contact_load", "contact_angle", "sliding"):
        # Balls at other distances from each other share the load otherwise.
        got = np.mean(getattr(found, name)[-1], axis=0)
        want = np.asarray(getattr(end, name))[0]
        size = np.max(np.abs(want))
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-4 * size)
    np.testing.assert_allclose(
        found.friction_torque[-1], end.friction_torque, rtol=1e-4
    )


def test_simulate_interrupted_load():
    """Without load nothing holds the ring; balls lie in the outer raceway."""
    share = np.array([1.0, 1.0, 0.0, 0.0, 1.0])
    history = LoadHistory(TIMES, np.outer(share, BOTH))
    still = SinusoidalLoad(np.zeros(6), np.zeros(6), SPEED.inner)
    found = run(Varying(history, still), tolerance=1e-5)
    assert int(found.result) == 0 and np.all(np.isfinite(found.slip))
    inner = found.contact_load[:, :, 1]
    at = np.asarray(found.time)
    assert np.max(inner[(at > 0.0045) & (at < 0.0115)]) < 1e-3
    assert np.max(inner[-1]) > 100.0
    assert np.max(np.abs(found.imbalance)) < 1e-5 * float(found.work.drive[-1])


def test_simulate_reports_no_load_path_for_reversed_load():
    """An angular contact bearing bears axial loads of one sense only."""
    share = np.array([1.0, 1.0, -1.0, -1.0, 1.0])
    history = LoadHistory(TIMES, np.outer(share, BOTH))
    still = SinusoidalLoad(np.zeros(6), np.zeros(6), SPEED.inner)
    with pytest.raises(SolveError, match="no_load_path .* pulls the ring out"):
        run(Varying(history, still), tolerance=1e-5)


def test_simulate_constant_load_matches_table():
    """At the beginning, with the balls where the ring was balanced for the table."""
    still = SinusoidalLoad(BOTH, np.zeros(6), SPEED.inner)
    given = dict(duration=1e-6, tolerance=1e-7)
    table, balanced = run(BOTH, **given), run(Varying(NOTHING, still), **given)
    np.testing.assert_allclose(balanced.contact_load, table.contact_load, rtol=1e-4)
    np.testing.assert_allclose(balanced.orbit_speed, table.orbit_speed, rtol=1e-6)


def test_momentum(prepared):
    """Balls and cage push each other; free balls hold the cage, and no more."""
    around, start = prepared
    lead = jnp.asarray([-8e-3, 6e-3, 0.0, 1e-3, 9e-3])
    state = start._replace(lead=lead)

    @jax.jit
    def both(state):
        one, time = jnp.ones(()), jnp.zeros(())
        system = SkidSystem(around, one, one)
        change, _ = system.unpack(system.rates(time, system.pack(state)))
        return change, each_ball(around, time, state)

    change, balls = both(state)
    radius = 0.5 * BEARING.pitch_diameter
    play = 0.5 * float(FEW.cage.pocket_clearance)
    deep = np.abs(lead) * radius - play
    want = -np.sign(lead) * np.maximum(deep, 0.0) * float(FEW.cage.stiffness)
    np.testing.assert_allclose(balls.push, want, rtol=1e-12)
    torque = float(FEW.cage.inertia * change.cage_speed)
    np.testing.assert_allclose(torque, -radius * np.sum(want), rtol=1e-12)
    alone = each_ball(around, jnp.zeros(()), start)
    mass = np.asarray(alone.ball.mass)
    free, _ = both(start)
    pushed = mass * radius * (change.orbit - free.orbit)
    # A ball that leads is somewhere else, where its tractions are other ones.
    slow = np.asarray(balls.pulls.resultants.force - alone.pulls.resultants.force)
    moved = balls.drag - alone.drag - np.sum(slow[:, :, 0], axis=1)
    np.testing.assert_allclose(pushed - moved, want, rtol=1e-6, atol=1e-6)


def test_gravity_adds_no_energy_over_a_turn():
    """On a horizontal axis a ball is pulled down; the potential says so."""
    flat, tilted = run(), run(axis="horizontal")
    mass = 0.00842
    high = mass * 9.80665 * 0.5 * BEARING.pitch_diameter
    height = np.sum(np.sin(np.asarray(tilted.azimuth)), axis=1)
    gained = tilted.potential_energy - flat.potential_energy
    assert np.max(np.abs(gained - high * height)) < 1e-3 * high
    assert np.max(np.abs(tilted.slip - flat.slip)) > 1e-4


def test_simulate_without_load():
    found = run(np.zeros(6))
    assert int(found.result) == 0
    motion = eqx.tree_at(lambda f: f.solution, found, None)
    for leaf in jax.tree.leaves(eqx.filter(motion, eqx.is_inexact_array)):
        assert np.all(np.isfinite(leaf))


def test_simulate_step_limit_keeps_computed_part():
    given = dict(load=BOTH, tolerance=1e-13, duration=0.05)
    found = run(**given, throw=False)
    assert int(found.result) == Result.STEP_LIMIT
    reached = np.isfinite(found.cage_speed)
    assert reached[0] and not reached[-1]
    assert np.all(np.isfinite(found.slip[reached]))
    assert np.all(np.isnan(found.slip[~reached]))
    with pytest.raises(SolveError, match="step_limit after 3000 steps"):
        run(**given)


def test_simulate_non_finite_start(prepared):
    _, start = prepared
    found = run(start=start._replace(orbit=start.orbit * jnp.nan), throw=False)
    assert int(found.result) == Result.NON_FINITE
    assert np.all(np.isnan(found.slip[1:]))


@pytest.mark.slow
def test_simulate_reports_non_finite_for_newtonian_glass():
    """At 0 °C and above 1 GPa spins settle within 1e-15 s: no step is small enough."""
    heavy = np.array([400.0, 0.0, 600.0, 0.0, 0.0, 0.0])
    cold = eqx.tree_at(lambda m: m.temperature, FEW, jnp.asarray(273.15))
    with pytest.raises(SolveError, match="non_finite .*behind the first.* Newtonian"):
        run(heavy, model=cold)


def test_names_of_settings():
    with pytest.raises(ValueError, match="`axis` is 'flat'; it must be vertical or"):
        run(axis="flat")
    with pytest.raises(ValueError, match="`derivatives`"):
        run(derivatives="both")
    with pytest.raises(ValueError, match="`time` .* rising"):
        SpeedTable([0.0, 0.0], jnp.ones(2))
    with pytest.raises(ValueError, match="same length"):
        SpeedTable([0.0, 1.0], jnp.ones(3))
    with pytest.raises(ValueError, match="LoadHistory: `time` has the shape"):
        LoadHistory([0.0, 1.0], np.zeros((3, 6)))
    with pytest.raises(ValueError, match="`mean` has the shape"):
        SinusoidalLoad(np.zeros(5), np.zeros(6), 1.0)
    with pytest.raises(ValueError, match="`balanced` must not be false"):
        run(SinusoidalLoad(LIGHT, np.zeros(6), 1.0), balanced=False)


@pytest.mark.slow
def test_derivatives():
    """Of the cage's speed, forward and reverse, against differences: viscosity, and
    oil between the rings. (Others: `benchmarks/skid_gradients.py`.)"""
    model = with_cage(pocket_clearance=0.0)

    def numbers(m):
        return m.lubricant.ambient.reference_viscosity, m.drag.fill

    start = jnp.stack(numbers(model))

    def end(factors, derivatives):
        other = eqx.tree_at(numbers, model, tuple(start * factors))
        found = run(model=other, duration=0.003, derivatives=derivatives)
        return found.cage_speed[-1]

    one, way = jnp.ones(2), jnp.asarray([1.0, -0.5])
    reverse = jax.grad(end)(one, "reverse")
    _, forward = jax.jvp(lambda f: end(f, "forward"), (one,), (way,))
    np.testing.assert_allclose(forward, reverse @ way, rtol=1e-6)
    step = 1e-4
    for k in range(2):
        ends = [float(end(one.at[k].add(s), "reverse")) for s in (step, -step)]
        slope = (ends[0] - ends[1]) / (2.0 * step)
        np.testing.assert_allclose(reverse[k], slope, rtol=1e-4)
    assert np.all(np.abs(reverse) > 1e-4)

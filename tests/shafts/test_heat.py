"""Temperatures in equilibrium with friction, and their way there."""

from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from systems import ELEMENT, ball, stage

import bearingjax as bj
from bearingjax.shafts import (
    BearingOil,
    Drive,
    HeatNetwork,
    Seat,
    ShaftLine,
    ShaftLoad,
    ShaftSystem,
    ThermalPaths,
    bearing_solutions,
    heat,
    power_flow,
    solve_heat,
    warm_up,
)
from bearingjax.shafts.heat import runaway_speed
from bearingjax.shafts.heat_balance import rises_over_time, steady_rises

CONDUCTANCE = jnp.diag(jnp.array([2.0, 1.0]))
CAPACITY = jnp.array([1000.0, 500.0])


def preloaded(rises, growth):
    """Heat of a bearing whose preload grows with the warmth of its shaft: a linear
    case, half of it to each ring."""
    made = 10.0 + growth * rises[0]
    return jnp.stack([0.5 * made, 0.5 * made])


@jax.jit
def steady(growth):
    return steady_rises(preloaded, growth, CONDUCTANCE, CAPACITY)


@pytest.mark.parametrize("growth", [-5.0, 0.0, 1.0, 3.0, 3.9])
def test_linear_case(growth):
    """AF006-5: rise = P0/2 / (G - growth/2), which decays at (G - growth/2)/C."""
    rises, slowest, _, _, solved = steady(jnp.asarray(growth))
    assert bool(solved)
    wanted = 5.0 / (2.0 - 0.5 * growth)
    np.testing.assert_allclose(rises, [wanted, 2.0 * wanted], rtol=1e-9)
    np.testing.assert_allclose(
        slowest, min((2.0 - 0.5 * growth) / 1000.0, 0.002), rtol=1e-12
    )


def test_steady_rises_with_fast_settling_node():
    """Steps in time grow even if one node settles a thousand times faster."""

    def made(rises, _):
        return jnp.stack([5.0 + 0.1 * rises[0], 5.0 + 0.0 * rises[1], 0.0 * rises[0]])

    conductance = jnp.diag(jnp.array([2.0, 1.0, 1.0]))
    capacity = jnp.array([1000.0, 500.0, 0.1])
    rises, slowest, *_, solved = steady_rises(made, 0.0, conductance, capacity)
    assert bool(solved)
    np.testing.assert_allclose(rises, [5.0 / 1.9, 5.0, 0.0], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(slowest, 1.9e-3, rtol=1e-9)


def test_derivative_of_the_linear_case():
    slope = jax.grad(lambda g: steady(g)[0][0])(jnp.asarray(3.0))
    np.testing.assert_allclose(slope, 0.5 * 5.0 / 0.5**2, rtol=1e-9)


@pytest.mark.parametrize("growth", [4.0001, 4.5, 10.0])
def test_runaway(growth):
    """Beyond the turning point, growth = 2 G, there is no equilibrium, and in time the
    temperature rises past every bound."""
    *_, solved = steady(jnp.asarray(growth))
    assert not bool(solved)
    slope = 0.5 * growth - 2.0
    # It passes 300 K at some time, by the closed form.
    late = np.log1p(300.0 * slope / 5.0) / slope * 1000.0
    times = jnp.linspace(0.0, 1.2 * late, 25)
    rises = rises_over_time(preloaded, growth, CONDUCTANCE, CAPACITY, times, 8)
    assert np.isnan(rises[-1]).all()
    before = np.asarray(times) < 0.45 * late
    wanted = 5.0 / slope * np.expm1(slope / 1000.0 * np.asarray(times)[before])
    np.testing.assert_allclose(rises[before, 0], wanted, rtol=2e-3, atol=1e-9)


def test_integration_is_of_second_order():
    """Half the steps have a quarter of the error."""
    times = jnp.linspace(0.0, 3000.0, 7)
    decay = 0.5 / 1000.0
    wanted = 10.0 * -np.expm1(-decay * np.asarray(times))
    errors = [
        np.abs(
            rises_over_time(preloaded, 3.0, CONDUCTANCE, CAPACITY, times, n)[:, 0]
            - wanted
        ).max()
        for n in (4, 8)
    ]
    assert errors[1] < 0.3 * errors[0] < 1e-2


def test_rises_over_time_with_fast_settling_node():
    """Long steps do not upset a node that settles ten thousand times faster."""

    def made(rises, _):
        return 5.0 + 0.0 * rises

    conductance = jnp.diag(jnp.array([2.0, 1.0, 1.0]))
    capacity = jnp.array([1000.0, 500.0, 0.1])
    times = jnp.linspace(0.0, 3000.0, 7)
    rises = rises_over_time(made, 0.0, conductance, capacity, times, 8)
    rate = np.diagonal(conductance) / np.asarray(capacity)
    wanted = 5.0 / np.diagonal(conductance) * -np.expm1(-rate * 3000.0)
    np.testing.assert_allclose(rises[-1], wanted, rtol=1e-3)


OIL = BearingOil(bj.lubrication.iso_vg(68.0))
SEAT = bj.Mounting(0.04, 0.09, 0.13, 10e-6, 0.0)


def spindle(offset=0.0, speed=400.0, mounting=SEAT):
    """Two ball bearings, each pressed inward by the other where shaft grows."""
    bearing = bj.Installed(ELEMENT, None, mounting)
    line = ShaftLine("s", [0.3], [0.04])
    seats = [
        Seat("A", "s", 0.05, bearing, axial_offset=offset),
        Seat("B", "s", 0.25, bearing, axial_offset=offset, turned=True),
    ]
    load = ShaftLoad("p", "s", 0.12, (0.0, -1500.0, 100.0))
    return ShaftSystem(line, seats, Drive("s", speed, torque=0.0), loads=load)


def network(**more):
    path = ThermalPaths(1.2, 1.6, OIL, through=0.2, **more)
    return HeatNetwork(293.15, [path, path], housing=6.0)


def test_heat_made_by_bearings_and_meshes(monkeypatch, untyped):
    """Half of a bearing's loss at each ring, with the oil as warm as the mean of both;
    the losses of the meshes in the housing."""

    class Oil(BearingOil):
        def power(self, solution, temperature=None):
            return temperature

    system = stage(ball, efficiency=0.99)
    flow = SimpleNamespace(motion=jnp.zeros((4, 5)), power=power_flow(system))
    monkeypatch.setattr(heat, "system_state", lambda system: (flow, None))
    monkeypatch.setattr(heat, "in_place", lambda *given: None)
    path = ThermalPaths(1.2, 1.6, Oil(OIL.lubricant))
    rises = jnp.asarray([10.0, 30.0, 20.0, 80.0, 0.0, 0.0, -5.0, 15.0, 7.0])
    given = system, HeatNetwork(293.15, [path] * 4, housing=6.0)
    made = heat.heat_made(rises, given)
    oil = 293.15 + np.array([20.0, 50.0, 0.0, 5.0])
    np.testing.assert_allclose(made[:-1], np.repeat(0.5 * oil, 2), rtol=1e-12)
    loss = 22e3 * (1.0 - 0.99**2)
    np.testing.assert_allclose(made[-1], loss, rtol=1e-12)


def test_heat_network_matrices_by_hand():
    """Two bearings and springs, with a housing and without."""
    one = ThermalPaths(1.0, 2.0, OIL, through=0.5, inner_capacity=10, outer_capacity=20)
    two = ThermalPaths(3.0, 4.0, OIL, inner_capacity=30, outer_capacity=40)
    part = np.zeros((6, 6))
    part[:2, :2] = [[1.5, -0.5], [-0.5, 2.5]]
    part[range(2, 6), range(2, 6)] = [1.0, 1.0, 3.0, 4.0]
    alone = HeatNetwork(293.15, [one, None, two])
    np.testing.assert_allclose(alone.conductance(), part)
    capacity = [10.0, 20.0, 1.0, 1.0, 30.0, 40.0]
    np.testing.assert_allclose(alone.capacity(), capacity)
    housed = HeatNetwork(293.15, [one, None, two], housing=6.0, housing_capacity=50.0)
    aside = np.array([0.0, -2.0, 0.0, 0.0, 0.0, -4.0])
    whole = np.block([[part, aside[:, None]], [aside[None], np.array([[12.0]])]])
    np.testing.assert_allclose(housed.conductance(), whole)
    np.testing.assert_allclose(housed.capacity(), [*capacity, 50.0])


def test_solve_heat_of_constant_losses(monkeypatch, untyped):
    """What does not depend on temperature leaves by the network alone."""
    made = jnp.asarray([5.0, 6.0, 7.0, 8.0, 3.0])
    state = SimpleNamespace(result=jnp.asarray(0))

    def evaluated(system, network, rise):
        return made, jnp.zeros((5, 5)), state

    monkeypatch.setattr(heat, "_evaluate", evaluated)
    found = solve_heat(spindle(mounting=None), network())
    rises = np.linalg.solve(np.asarray(network().conductance()), made)
    for got, wanted in (
        (found.inner_ring, 293.15 + rises[[0, 2]]),
        (found.outer_ring, 293.15 + rises[[1, 3]]),
        (found.housing, 293.15 + rises[4]),
        (found.friction, [11.0, 15.0]),
    ):
        assert np.shape(got) == np.shape(wanted)
        np.testing.assert_allclose(got, wanted, rtol=1e-8)
    assert int(found.result) == 0 and found.solution is state


@pytest.mark.slow
def test_balance_of_heat():
    """The heat that friction makes at the warm bearings flows off by the network."""
    found = solve_heat(spindle(), network())
    solutions = bearing_solutions(found.system, found.solution)
    rises = np.asarray([found.inner_ring, found.outer_ring]) - 293.15
    house = float(found.housing) - 293.15
    for k, solution in enumerate(solutions):
        oil = OIL.lubricant.kinematic_viscosity(293.15 + rises[:, k].mean())
        made = float(bj.friction_torque(solution, oil).power)
        np.testing.assert_allclose(found.friction[k], made, rtol=1e-8)
        inner = 1.2 * rises[0, k] + 0.2 * (rises[0, k] - rises[1, k])
        outer = 1.6 * (rises[1, k] - house) + 0.2 * (rises[1, k] - rises[0, k])
        np.testing.assert_allclose([inner, outer], 0.5 * made, rtol=1e-8)
    flow = 1.6 * (rises[1] - house).sum()
    np.testing.assert_allclose(6.0 * house, flow, rtol=1e-8)
    warm = found.system.seats[0].installed.conditions
    np.testing.assert_allclose(warm.inner_ring, found.inner_ring[0])
    assert float(found.slowest) > 0
    assert found.system.seats[0].axial_offset == spindle().seats[0].axial_offset


@pytest.mark.slow
def test_solve_heat_at_rest():
    """Nothing warms a system at rest: it is as cold as the surroundings."""
    found = solve_heat(spindle(speed=0.0), network())
    rings = [found.inner_ring, found.outer_ring]
    np.testing.assert_array_equal(rings, np.full((2, 2), 293.15))
    np.testing.assert_array_equal(found.friction, 0.0)
    assert int(found.result) == 0 and float(found.slowest) > 0


@pytest.mark.slow
def test_warming_up_ends_in_the_equilibrium():
    system, paths = spindle(), network()
    steady_state = solve_heat(system, paths)
    times = jnp.concatenate([jnp.zeros(1), jnp.geomspace(60.0, 12 * 3600.0, 24)])
    over = warm_up(system, paths, times)
    assert over.shape == (25, 5)
    np.testing.assert_allclose(over[0], 293.15)
    last = np.concatenate(
        [
            np.stack([steady_state.inner_ring, steady_state.outer_ring], 1).ravel(),
            [steady_state.housing],
        ]
    )
    np.testing.assert_allclose(over[-1], last, atol=0.02)


@pytest.mark.slow
def test_solve_heat_with_and_without_seats():
    """Without seats temperature acts through the oil alone."""
    with_seats = solve_heat(spindle(), network())
    without = solve_heat(spindle(mounting=None), network())
    assert without.system.seats[0].installed.conditions is None
    one, other = (np.abs(f.solution.load).max() for f in (with_seats, without))
    assert abs(one - other) > 0.1


@pytest.mark.slow
def test_solve_heat_thermal_runaway_of_preloaded_pair():
    """A stiffly preloaded pair without a way for its heat does not settle; the speed
    from which it does not lies between one that settles and one that does not."""
    hot = HeatNetwork(293.15, [ThermalPaths(0.05, 0.6, OIL, housing_share=0.0)] * 2)
    tight = spindle(offset=25e-6, speed=600.0)
    with pytest.raises(bj.SolveError, match="no thermal equilibrium"):
        solve_heat(tight, hot)
    limit = runaway_speed(tight, hot, 600.0, 0.02)
    assert 0.0 < limit < 600.0
    slow = spindle(offset=25e-6, speed=0.95 * limit)
    assert int(solve_heat(slow, hot, throw=False).result) == 0


@pytest.mark.slow
def test_derivatives_of_temperatures():
    """By conductance and by preload, against differences."""
    system, paths = spindle(), network()

    @jax.jit
    def hottest(conductance, offset):
        net = eqx.tree_at(lambda n: n.paths[0].inner, paths, conductance)
        moved = eqx.tree_at(lambda s: s.seats[0].axial_offset, system, offset)
        found = solve_heat(moved, net, throw=False)
        return jnp.stack([found.inner_ring[0], found.outer_ring[1]])

    at = jnp.asarray(1.2), jnp.asarray(5e-6)
    slopes = jax.jit(jax.jacfwd(hottest, (0, 1)))(*at)
    for k, step in enumerate((1e-3, 2e-8)):
        ends = []
        for sign in (1.0, -1.0, 2.0, -2.0):
            moved = list(at)
            moved[k] = moved[k] + sign * step
            ends.append(np.asarray(hottest(*moved)))
        near, far = (ends[0] - ends[1]) / 2, (ends[2] - ends[3]) / 4
        wanted = (4 * near - far) / 3 / step
        np.testing.assert_allclose(slopes[k], wanted, atol=2e-6 * np.abs(wanted).max())


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda: ThermalPaths(0.0, 1.0, OIL), "`inner` is 0 W/K"),
        (lambda: ThermalPaths(1.0, 1.0, OIL, shaft_share=1.5), "`shaft_share` is 1.5"),
        (lambda: HeatNetwork(20.0, []), "from 150 to 600 K"),
        (
            lambda: solve_heat(spindle(), HeatNetwork(293.15, network().paths[:1])),
            "1 paths and the system 2 bearings",
        ),
    ],
)
def test_wrong_networks(change, told):
    with pytest.raises(ValueError, match=told):
        change()

"""The bearing as a function of time: its orbit, its derivatives, its damping."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj

SPEED = bj.Speed(inner=400.0, outer=-30.0)
ROLLERS = bj.CylindricalRollerBearing(
    7, 0.065, 0.010, 0.010, radial_internal_clearance=4e-6, first_azimuth=0.3
)
FEW = bj.CylindricalRollerBearing(5, 0.065, 0.012, 0.010)
ELEMENTS = {
    "rollers": bj.BearingElement(ROLLERS, quadrature=bj.numerics.Midpoint(8)),
    "balls": bj.BearingElement(balls(5), raceway_control=bj.element.CentrifugalOnly()),
    "unlike rows": bj.BearingElement(
        bj.BearingSet((bj.SetRow(ROLLERS, -0.01), bj.SetRow(FEW, 0.01))),
        quadrature=bj.numerics.Midpoint(8),
    ),
}
VELOCITY = np.linspace(-0.02, 0.03, 12)

every_time = jax.jit(jax.vmap(bj.element.orbiting_force, (None, None, 0, None)))
orbiting = jax.jit(bj.element.orbiting_force)


TIME = 0.0123


def pressed(x=3e-6, y=-14e-6):
    q = np.zeros(12)
    q[[0, 1, 6, 7]] = -0.5 * x, -0.5 * y, 0.5 * x, 0.5 * y
    q[3], q[9] = 1e-4, -2e-4
    return q


def turned():
    """As pressed, the rings turned by hand as far as in TIME."""
    q = pressed()
    q[[5, 11]] = -30.0 * TIME, 400.0 * TIME
    return q


@pytest.mark.parametrize("name", ["rollers", "unlike rows"])
@pytest.mark.slow
def test_orbiting_force_matches_rotated_element(name):
    element = ELEMENTS[name]
    function, parameters = element.as_function(SPEED)
    assert function is bj.element.orbiting_force
    now = {
        t: orbiting(pressed(), VELOCITY, t, parameters) for t in (0.0, TIME, 2 * TIME)
    }
    by_gz = element.model(SPEED).force(jnp.asarray(turned()))
    size = abs(by_gz).max()
    np.testing.assert_allclose(now[TIME], by_gz, atol=SOLVER * size)
    assert abs(now[0.0] - by_gz).max() > 1e-3 * size
    # A gz in the motion comes on top; without orbit it is all there is.
    twice = orbiting(turned(), VELOCITY, TIME, parameters)
    np.testing.assert_allclose(twice, now[2 * TIME], atol=SOLVER * size)
    still, same = element.as_function(SPEED, orbit=False)
    by_motion = jax.jit(still)(turned(), VELOCITY, 7.0, same)
    np.testing.assert_allclose(by_motion, by_gz, atol=SOLVER * size)


def test_force_repeats_with_the_pass_of_the_elements():
    element = ELEMENTS["rollers"]
    _, parameters = element.as_function(SPEED)
    q = pressed(x=0.0)
    q[[3, 9]] = 0.0
    share = 0.010 / 0.065
    orbit = 0.5 * (400.0 * (1 - share) - 30.0 * (1 + share))
    period = 2 * np.pi / (7 * orbit)
    times = period * np.arange(20) / 20
    force = np.asarray(every_time(q, np.zeros(12), times, parameters))
    size = abs(force).max()
    assert np.ptp(force[:, 7]) > 0.01 * size
    again = every_time(q, np.zeros(12), times + 3 * period, parameters)
    np.testing.assert_allclose(again, force, atol=SOLVER * size)
    # Seven rollers, and again half a pitch on, stand where fourteen do.
    dense = bj.CylindricalRollerBearing(
        14, 0.065, 0.010, 0.010, radial_internal_clearance=4e-6, first_azimuth=0.3
    )
    mean = 0.5 * bj.BearingElement(dense, quadrature=bj.numerics.Midpoint(8)).model(
        SPEED
    ).force(jnp.asarray(q))
    np.testing.assert_allclose(0.5 * (force[0] + force[10]), mean, atol=SOLVER * size)
    assert mean[7] < -0.1 * size
    # vmap = loop.
    one = orbiting(q, np.zeros(12), times[3], parameters)
    np.testing.assert_allclose(force[3], one, atol=ROUNDING * size)


@pytest.mark.parametrize("name", ["rollers", "balls"])
@pytest.mark.slow
def test_derivatives_with_respect_to_all_arguments(name):
    rng = np.random.default_rng(3)
    element = ELEMENTS[name]
    damping = rng.uniform(-1, 1, (12, 12)) + 4 * np.eye(12)
    _, parameters = element.as_function(SPEED, damping)
    point = [pressed(), VELOCITY, TIME, parameters]
    point = jax.tree.map(jnp.asarray, point)
    size = jax.tree.map(lambda x: jnp.abs(x) + 1e-9, point)
    tangent = jax.tree.map(lambda s: s * rng.uniform(-1, 1, s.shape), size)

    weight = rng.uniform(-1, 1, 12)

    @jax.jit
    def both(point, tangent):
        slope = jax.jvp(lambda *p: bj.element.orbiting_force(*p), point, tangent)[1]
        pull = jax.vjp(lambda p: bj.element.orbiting_force(*p), point)[1]
        return slope, pull(weight)[0]

    slope, pull = both(point, tangent)
    errors = []
    for step in (1e-5, 1e-6):
        up = jax.tree.map(lambda x, d, h=step: x + h * d, point, tangent)
        down = jax.tree.map(lambda x, d, h=step: x - h * d, point, tangent)
        change = orbiting(*up) - orbiting(*down)
        errors.append(abs(change / (2 * step) - slope).max())
    assert min(errors) < DIFFERENCE * abs(slope).max()

    # Reverse mode is the transpose.
    products = jax.tree.map(lambda a, b: jnp.sum(a * b), pull, tangent)
    total = sum(jax.tree.leaves(products))
    np.testing.assert_allclose(total, weight @ slope, rtol=SOLVER)

    # Alone, velocity gives C and motion gives the tangent stiffness.
    zero = jax.tree.map(jnp.zeros_like, tangent)
    by_velocity = both(point, [zero[0], tangent[1], *zero[2:]])[0]
    np.testing.assert_allclose(by_velocity, damping @ tangent[1], rtol=SOLVER)
    # A stiffness holds gz; the derivative by it is that of the whole force.
    way = tangent[0].at[jnp.array([5, 11])].set(0.0)
    by_motion = both(point, [way, *zero[1:]])[0]
    stiffness = element.model(SPEED).stiffness(jnp.asarray(turned()))
    expected = stiffness @ way
    np.testing.assert_allclose(by_motion, expected, atol=SOLVER * abs(expected).max())


def test_a_number_of_damping_stands_between_the_rings():
    element = ELEMENTS["rollers"]
    functions = [element.as_function(SPEED, c)[1] for c in (None, 50.0)]
    still, damped = (orbiting(pressed(), VELOCITY, 0.0, p) for p in functions)
    rate = 50.0 * (VELOCITY[6:9] - VELOCITY[:3])
    expected = np.concatenate([-rate, np.zeros(3), rate, np.zeros(3)])
    np.testing.assert_allclose(damped - still, expected, atol=1e-9)


def test_orbiting_force_is_constant_for_rings_at_rest():
    function, parameters = ELEMENTS["rollers"].as_function()
    then, now = (function(pressed(), VELOCITY, t, parameters) for t in (0.0, 3.0))
    np.testing.assert_array_equal(then, now)


def test_one_trace_for_many_bearings():
    traced = eqx.debug.assert_max_traces(bj.element.orbiting_force, max_traces=1)
    compiled = jax.jit(traced)
    for clearance in (1e-6, 2e-6):
        changed = eqx.tree_at(
            lambda b: b.radial_internal_clearance, ROLLERS, jnp.asarray(clearance)
        )
        function, parameters = bj.BearingElement(changed).as_function(SPEED, 1.0)
        assert hash(function) == hash(bj.element.orbiting_force)
        compiled(pressed(), VELOCITY, 0.1, parameters)


def test_failure_is_not_silent():
    _, parameters = ELEMENTS["rollers"].as_function(SPEED)
    q = pressed()
    q[7] = np.nan
    assert np.isnan(orbiting(q, VELOCITY, 0.0, parameters)).any()
    hurried = bj.numerics.TrustRegionNewton(max_steps=1)
    element = bj.BearingElement(ROLLERS, None, None, bj.numerics.Midpoint(8), hurried)
    function, parameters = element.as_function(SPEED)
    assert (
        element.evaluate(jnp.asarray(pressed()), SPEED).result == bj.Result.STEP_LIMIT
    )
    assert np.isnan(function(pressed(), VELOCITY, 0.0, parameters)).all()


def test_bad_input_is_named():
    element = ELEMENTS["rollers"]
    for bad, shown in (
        (-1.0, "-1 N s/m"),
        (np.nan, "nan N s/m"),
        (np.diag([-1.0] * 12), r"shape \(12, 12\)"),
        (np.eye(3), r"\(3, 3\)"),
    ):
        with pytest.raises(ValueError, match=f"`damping`.*{shown}"):
            element.as_function(SPEED, bad)
    with pytest.raises(TypeError, match="`damping`"):
        element.as_function(SPEED, "1 N s/m")
    with pytest.raises(TypeError, match="speed"):
        element.as_function(400.0)
    function, parameters = element.as_function(SPEED)
    with pytest.raises((TypeError, ValueError), match="velocity"):
        function(pressed(), VELOCITY[:6], 0.0, parameters)

"""Solutions of ball bearings and sets: closed forms, states, warnings, derivatives."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import robust_balls
from registry import ball_elements, balls, grooves
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.element import inertia_load
from bearingjax.friction import films
from bearingjax.statics import BallSolution, warnings
from bearingjax.statics.load_result import solution_at
from bearingjax.statics.warning_sizes import load_beyond_groove

DEGREE = np.pi / 180
SPEED = bj.Speed(inner=2000.0)


@pytest.fixture(scope="module")
def angular():
    return bj.BearingElement(balls(12))


@pytest.fixture(scope="module")
def deep():
    bearing = balls(7, bj.DeepGrooveBallBearing, radial_internal_clearance=10e-6)
    return bj.BearingElement(bearing)


def test_thrust_solution_in_closed_form(angular):
    """F = Z K A^1.5 sin α (cos α0/cos α - 1)^1.5, displacement A sin(α-α0)/cos α."""
    b, model = angular.bearing, angular.model().rows[0].element
    outer, inner = map(float, model.constant)
    series = (outer ** (-2 / 3) + inner ** (-2 / 3)) ** (-3 / 2)
    distance, free = float(b.centre_distance), float(b.contact_angle)
    angle = 28 * DEGREE
    stretch = np.cos(free) / np.cos(angle) - 1
    load = 12 * series * (distance * stretch) ** 1.5
    s = bj.solve_load(angular, [0, 0, load * np.sin(angle), 0, 0, 0])
    assert np.allclose(s.contact_angle, angle, rtol=1e-10)
    assert np.allclose(s.roller_load, load / 12, rtol=1e-10)
    moved = distance * np.sin(angle - free) / np.cos(angle)
    assert float(s.displacement[8]) == pytest.approx(moved, rel=1e-10)
    assert np.all(np.asarray(s.n_contacts) == 2)


@pytest.mark.slow
def test_balance_of_a_turning_bearing(angular):
    s = bj.solve_load(angular, [300.0, 0, 800.0, 0, 0, 0], speed=SPEED)
    force = np.asarray(s.force)
    inertia = inertia_load(angular.rows(s.displacement, SPEED))
    total = force[:6] + force[6:] + np.asarray(inertia)
    assert np.abs(total).max() < 1e-9 * 800.0
    # The stiffness is the Jacobian, and says that it is not symmetric.
    assert not angular.has_potential(SPEED)
    k = np.asarray(s.stiffness)
    step = 1e-9
    far = [
        np.asarray(angular.force(s.displacement.at[8].add(sign * step), SPEED))
        for sign in (1, -1)
    ]
    assert np.allclose((far[0] - far[1]) / (2 * step), k[:, 8], rtol=1e-5, atol=1e3)
    assert np.abs(k - k.T).max() > 1e-4 * np.abs(k).max()


def test_ball_out_of_the_groove_of_a_washer():
    """Inertia takes it there, if there is next to no axial load."""
    element = bj.BearingElement(balls(9, bj.ThrustBallBearing))
    speed = bj.Speed(1500.0)
    s = bj.solve_load(element, [1.7, 0.8, 5.0, 0, 0, 0], speed=speed, throw=False)
    assert int(s.result) == bj.Result.NO_LOAD_PATH and int(s.unrestrained) == -1
    assert "leaves its raceway" in s.failure_message
    held = bj.solve_load(element, [50.0, 0, 5000.0, 0, 0, 0], speed=speed, throw=False)
    assert bool(held.converged)
    # A ball that the other washer has left is at rest just where its groove ends.
    for thrust in (0.6, 0.9, 1.2, 2.0, 4.0):
        load = np.asarray([-0.06, -0.27, thrust, 5.5e-4, 6.2e-4, 0.0])
        s = bj.solve_load(element, load, speed=bj.Speed(514.0), throw=False)
        force = element.force(s.displacement, bj.Speed(514.0))[6:]
        off = np.abs(np.asarray(force) - load).max()
        assert int(s.result) == bj.Result.NO_LOAD_PATH or off < 1e-9 * thrust


def test_one_sided_bearing_pulled_the_other_way(angular):
    s = bj.solve_load(angular, [0, 0, -800.0, 0, 0, 0], throw=False)
    assert int(s.result) == bj.Result.NO_LOAD_PATH
    assert bj.FREEDOMS[int(s.unrestrained)] == "uz"
    with pytest.raises(bj.SolveError, match="No load path in uz"):
        bj.solve_load(angular, [0, 0, -800.0, 0, 0, 0])


def test_deep_groove_carries_both_ways(deep):
    plus = bj.solve_load(deep, [0, 0, 800.0, 0, 0, 0])
    minus = bj.solve_load(deep, [0, 0, -800.0, 0, 0, 0])
    assert np.allclose(plus.displacement[8], -minus.displacement[8], rtol=1e-9)
    assert np.allclose(plus.contact_angle, -minus.contact_angle, rtol=1e-9)


def test_balls_lift_off_at_high_speed(deep):
    s = bj.solve_load(deep, [0, -50.0, 0, 0, 0, 0], speed=SPEED)
    lifted = np.asarray(s.lifted)
    assert lifted.any() and not lifted.all()
    assert np.all(np.asarray(s.contact_load)[lifted, 1] == 0)
    # A lifted ball presses with its centrifugal force, at the bottom of the groove.
    assert np.allclose(
        np.asarray(s.contact_load)[lifted, 0],
        np.asarray(s.centrifugal_force)[lifted],
        rtol=1e-9,
    )
    assert any("lifted off the inner raceway" in line for line in warnings(s))


LITTLE_THRUST = (
    # Fx, Fy, Fz [N] and speed [rad/s].
    (38.3, 344.3, 21.85, 319.1),
    (95.7, -49.9, 3.296, 554.0),
    (-428.2, 4210.2, 340.7, 244.6),
    (-1529.5, 575.2, 165.1, 791.9),
    (2611.3, -1208.5, 470.0, 124.5),
    (1183.1, 307.8, 75.2, 727.3),
    (-3223.6, -2819.5, 397.5, 332.0),
    (-996.7, -5089.0, 188.4, 420.2),
    (116.1, 11.7, 14.53, 818.5),
    (143.8, -2875.9, 212.4, 654.5),
    (-223.8, -18.0, 31.65, 273.2),
    (4805.8, -2294.6, 297.8, 241.4),
)


@pytest.mark.slow
def test_balls_that_the_load_zone_has_left_lie_in_the_outer_groove():
    """Little axial load moves the ring aside; a ball pressed over the bottom of the
    groove on the land beside it would creep there, held by its tether alone."""
    element = bj.BearingElement(bj.load_bearing("7208 BE"))

    @jax.jit
    @jax.vmap
    def solved(load, speed):
        free, given = ["ux", "uy", "uz"], jnp.concatenate([load, jnp.zeros(3)])
        speed = bj.Speed(inner=speed)
        return bj.solve_load(
            element, given, support=bj.Support(free=free), speed=speed, throw=False
        )

    load, speed = np.split(np.asarray(LITTLE_THRUST), [3], axis=1)
    s = jax.tree.map(np.asarray, solved(jnp.asarray(load), jnp.asarray(speed[:, 0])))
    assert np.all(s.result == bj.Result.CONVERGED)
    off = np.abs(s.force[:, 6:9] - load).max(axis=1)
    assert np.all(off < SOLVER * np.abs(load).max(axis=1))
    lifted = s.lifted
    assert np.all(lifted.sum(axis=1) >= 4)
    assert np.abs(s.contact_angle[..., 0][lifted]).max() < SOLVER
    # Where they press with less than 5 % of the largest load it is nothing to warn of.
    heavy = jax.tree.map(lambda leaf: leaf[7], s)
    beyond = load_beyond_groove(heavy).any(axis=1)
    assert beyond.any() and not (beyond & heavy.lifted).any()


@pytest.mark.slow
def test_states_of_a_four_point_bearing():
    """Pure thrust: two points. A large ball under a radial load: more."""
    element = ball_elements()["four-point, unlike balls, load share"][0]
    bearing = eqx.tree_at(
        lambda b: b.radial_internal_clearance,
        element.bearing,
        jnp.asarray(20e-6, float),
    )
    element = eqx.tree_at(lambda e: e.bearing, element, bearing)
    thrust = bj.solve_load(element, [0, 0, 2000.0, 0, 0, 0])
    assert np.all(np.asarray(thrust.n_contacts) == 2)
    assert np.all(np.asarray(thrust.contact_load)[:, [1, 3]] == 0)
    radial = bj.solve_load(element, [0, -2000.0, 0, 0, 0, 0])
    assert set(np.asarray(radial.n_contacts)) == {0, 4}
    mixed = bj.solve_load(element, [0, -2000.0, 500.0, 0, 0, 0], speed=SPEED)
    assert {2, 3} & set(np.asarray(mixed.n_contacts).tolist())


def test_truncated_ellipse_is_warned_of(angular):
    shallow = balls(12, inner_shoulder=1.1e-3, outer_shoulder=3e-3)
    light = bj.solve_load(bj.BearingElement(shallow), [0, 0, 100.0, 0, 0, 0])
    heavy = bj.solve_load(bj.BearingElement(shallow), [0, 0, 9000.0, 0, 0, 0])
    assert not warnings(light)
    (line,) = warnings(heavy)
    assert line.startswith("truncated contact ellipse: it reaches over the shoulder")
    assert "inner raceway: balls 0 to 11" in line and "outer" not in line
    load = float(heavy.contact_load[0, 1])
    assert f"contact load of up to {load:.5g} N" in line
    # Height of the end of the ellipse on its arc.
    angle, radius = float(heavy.contact_angle[0, 1]), 0.52 * 0.0095
    end = angle + float(heavy.semi_axes[0, 1, 1]) / radius
    margin = 1.1e-3 - radius * (1 - np.cos(end))
    assert float(heavy.shoulder_margin[0, 1]) == pytest.approx(margin, rel=1e-9)
    none = bj.solve_load(angular, [0, 0, 9000.0, 0, 0, 0])
    assert np.all(np.isinf(np.asarray(none.shoulder_margin)))


@pytest.mark.slow
def test_preloaded_pair(angular):
    """Under no load each row presses the other; in the linear part both are felt."""
    pair = bj.BearingElement(bj.BearingSet.back_to_back(angular.bearing, 0.02, 16e-6))
    free = bj.solve_load(pair, [0, 0, 1e-3, 0, 0, 0])
    assert isinstance(free, bj.statics.BallSolution)
    alone = np.asarray(angular.force(jnp.zeros(12).at[8].set(8e-6)))[8]
    rows = np.split(np.asarray(free.contact_load)[:, 0], 2)
    for row in rows:
        thrust = row.sum() * np.sin(float(free.contact_angle[0, 0]))
        assert thrust == pytest.approx(alone, rel=1e-4)
    single = np.asarray(angular.stiffness(jnp.zeros(12).at[8].set(8e-6)))
    both = np.asarray(free.stiffness)
    # AF002-8: k_z = 2 c_a; radially too, but each row tilts with the other's lever.
    assert both[8, 8] == pytest.approx(2 * single[8, 8], rel=1e-4)
    assert both[6, 6] == pytest.approx(2 * single[6, 6], rel=1e-4)
    assert free.row_sizes == (12, 12)


@pytest.mark.parametrize("make", ["back_to_back", "face_to_face", "four rows"])
def test_bearing_set_stiffness_equals_sum_of_rows(angular, make):
    """Each row's own stiffness, carried to the middle of the set as a rigid body."""
    single = np.asarray(angular.stiffness(jnp.zeros(12).at[8].set(8e-6)))[6:, 6:]
    expected = np.zeros((6, 6))
    if make == "four rows":
        places, mirrored = (-0.03, -0.01, 0.01, 0.05), (False, True, True, False)
        rows = [
            bj.SetRow(angular.bearing, place, turned, -8e-6 if turned else 8e-6)
            for place, turned in zip(places, mirrored, strict=True)
        ]
        bearing = bj.BearingSet(rows)
    else:
        places = (-0.01, 0.01)
        mirrored = (False, True) if make == "back_to_back" else (True, False)
        bearing = getattr(bj.BearingSet, make)(angular.bearing, 0.02, 16e-6)
    for place, turned in zip(places, mirrored, strict=True):
        shift = np.eye(6)
        shift[0, 4], shift[1, 3] = place, -place
        turn = np.diag([1, 1, -1, -1, -1, 1.0]) if turned else np.eye(6)
        expected += shift.T @ turn @ single @ turn @ shift
    k = np.asarray(bj.BearingElement(bearing).stiffness(jnp.zeros(12)))[6:, 6:]
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))[:5, :5]
    assert np.abs((k - expected)[:5, :5] / scale).max() < ROUNDING
    if make != "four rows":
        # O is stiff against tilting where X is not.
        assert (expected[3, 3] > 3 * single[3, 3]) == (make == "back_to_back")


def test_work_on_a_closed_path_is_zero():
    """Round a circle in uy, uz of a pair; the mean of a period converges fast."""
    element, _ = ball_elements()["ball pair, O"]
    turns = np.linspace(0, 2 * np.pi, 257)
    q = np.zeros((257, 12))
    q[:, 7], q[:, 8] = 6e-6 * np.cos(turns), 6e-6 * np.sin(turns)
    force = np.asarray(jax.jit(jax.vmap(element.force))(jnp.asarray(q)))
    rate = 6e-6 * (-force[:, 7] * np.sin(turns) + force[:, 8] * np.cos(turns))
    work, size = (np.mean(v[:-1]) * 2 * np.pi for v in (rate, np.abs(rate)))
    assert abs(work) < SOLVER * size


@pytest.mark.slow
def test_tandem_shares_the_thrust(angular):
    element = bj.BearingElement(bj.BearingSet.tandem(angular.bearing, 0.02, 3))
    s = bj.solve_load(element, [0, 0, 3000.0, 0, 0, 0])
    one = bj.solve_load(angular, [0, 0, 1000.0, 0, 0, 0])
    assert isinstance(s, bj.statics.BallSolution)
    assert np.allclose(s.contact_load, one.contact_load[0], rtol=1e-9)


@pytest.mark.slow
def test_derivatives_with_respect_to_the_design():
    """Of the stiffness, with everything that has no potential."""
    q = jnp.zeros(12).at[jnp.array([6, 8])].set(jnp.asarray([4e-6, 12e-6]))

    def stiffness(angle, osculation):
        bearing = balls(8, contact_angle=angle, inner_osculation=osculation)
        element = bj.BearingElement(bearing, point_law=bj.contact.OperatingAngle())
        value = element.stiffness(q, bj.Speed(1500.0))[8, 8] * 1e-6
        return value, value

    at = (jnp.asarray(0.4), jnp.asarray(0.52))
    slopes = jax.jit(jax.jacfwd(stiffness, argnums=(0, 1), has_aux=True))
    exact, _ = slopes(*at)
    for k, step in enumerate((1e-5, 1e-6)):
        ends = []
        for sign in (1, -1):
            moved = list(at)
            moved[k] = moved[k] + sign * step
            ends.append(float(slopes(*moved)[1]))
        difference = (ends[0] - ends[1]) / (2 * step)
        assert float(exact[k]) == pytest.approx(difference, rel=1e-5)


def test_individual_balls_share_unequally():
    """AF003 needs balls of their own size: a large one takes more, a small one none."""
    deviation = np.zeros(9)
    deviation[[2, 6]] = [4e-6, -30e-6]
    bearing = balls(9, bj.DeepGrooveBallBearing, ball_deviation=deviation)
    s = bj.solve_load(bj.BearingElement(bearing), [0, 0, 50.0, 0, 0, 0])
    load = np.asarray(s.contact_load)[:, 0]
    assert load.argmax() == 2 and load[6] == 0.0


@pytest.mark.slow
def test_small_robustness_run():
    """Seeded, small version of benchmarks/robust_balls.py."""
    for row in robust_balls.run(2, seed=1, only=["four-point, clearance 20 um"]):
        assert row["failed"] == 0 and row["silently_wrong"] == 0, row


def test_lifted_balls_orbit_with_the_others():
    """Lifted beyond the inner groove centre, where the line of centres turns round."""
    bearing = bj.DeepGrooveBallBearing(
        7,
        0.0435,
        0.0115,
        outer_osculation=0.53,
        inner_osculation=0.507,
        radial_internal_clearance=40e-6,
    )
    s = bj.solve_load(bj.BearingElement(bearing), [0, -6e3, 0, 0, 0, 0], speed=SPEED)
    lifted = np.asarray(s.lifted)
    assert lifted.sum() == 4
    # One is beyond the centre, 80.5 um from the raceway: there is no more to be apart.
    gap = np.asarray(s.approach)[lifted, 1].min()
    assert gap == pytest.approx(-0.007 * 0.0115, rel=SOLVER)
    # At contact angle zero, as the balls that are loaded.
    orbit = 0.5 * (1 - 0.0115 / 0.0435) * 2000.0
    assert np.allclose(s.kinematics.orbit, orbit, rtol=1e-12)
    mass = 7850 * np.pi * 0.0115**3 / 6
    expected = 0.5 * 0.0435 * mass * orbit**2
    assert np.allclose(np.asarray(s.roller_load)[lifted, 0], expected, rtol=1e-9)


def test_a_groove_has_no_far_side():
    """Balls lifted by more than the inner groove is deep touch nothing there."""
    bearing = bj.DeepGrooveBallBearing(
        7,
        0.03904,
        0.007938,
        outer_osculation=0.53,
        inner_osculation=0.515,
        first_azimuth=-np.pi / 2,
        radial_internal_clearance=0.3e-3,
    )
    element = bj.BearingElement(bearing)
    s = bj.solve_load(element, [0, -3e3, 0, 0, 0, 0], speed=SPEED)
    gap = 7.938e-3 * 0.015  # from the inner groove centre to the raceway
    assert np.asarray(s.approach)[:, 1].min() == pytest.approx(-gap, rel=1e-9)
    outer, inner = np.asarray(s.contact_load).T
    opened = np.sin(np.asarray(s.azimuth)) > 0
    assert opened.sum() == 4 and inner[opened].max() == 0.0
    assert outer[opened].min() > 0.999 * float(s.centrifugal_force[3])
    assert np.abs(np.asarray(s.contact_angle)).max() <= np.pi / 2


def test_beyond_the_end_of_a_groove_the_raceway_goes_straight_on(deep):
    """Where the part of the motion along the radius stops to count: no jump."""
    grooves = deep.model().rows[0].element.grooves
    reach = float(grooves.reach[1])

    def at(z, r):
        """The ball at (z, r) from the inner groove centre, seen from inside."""
        way = np.zeros((2, 2))
        way[1] = np.array([z, -r]) - np.asarray(grooves.start)[1]
        contacts = grooves.touch(jnp.asarray(way))
        return float(contacts.approach[1]), np.asarray(contacts.normal)[1]

    for z in (1.2 * reach, -1.2 * reach, 0.5 * reach):
        near, far = at(z, 1e-12 * reach), at(z, -1e-12 * reach)
        assert near[0] == pytest.approx(far[0], rel=ROUNDING)
        assert np.allclose(near[1], far[1], atol=1e-11)
        wall, normal = at(z, -2.0 * reach)
        assert wall == pytest.approx(abs(z) - reach, rel=SOLVER)
        assert np.allclose(normal, [np.sign(z), 0.0])
    lost, normal = at(0.0, -5.0 * reach)
    assert lost == pytest.approx(-reach, rel=SOLVER) and not normal.any()


@pytest.mark.slow
def test_a_lifting_ball_has_one_state_only():
    """Solved anew at the same ring motion it is found again, touching or hanging free,
    at large contact angles too."""
    name = "angular contact, 40 deg, friction"
    element, one_sided = robust_balls.designs()[name]
    rng = np.random.default_rng(1)
    loads = robust_balls.random_loads(rng, one_sided, 0, 50)
    speeds = jnp.asarray(rng.uniform(0, 1, 50) ** 2 * 6283.0)
    code, _, residual, _, lifted, _ = map(
        np.asarray, robust_balls.solve(element, jnp.asarray(loads), speeds)
    )
    assert lifted.sum() > 20
    assert np.all(code == bj.Result.CONVERGED)
    assert residual.max() < 1e-8


def test_balls_that_do_not_feel_the_speed_roll_at_it(deep):
    """Without inertia a solution at a speed has the kinematics of its contact angles,
    of a radial load ω/2 (1 ∓ γ), and no force of inertia."""
    rings = jnp.zeros(12).at[6].set(20e-6)
    speed = bj.Speed(inner=2.0)
    found = solution_at(deep, rings, speed, 3, False)
    assert isinstance(found, BallSolution) and found.kinematics is not None
    loaded = np.asarray(found.load_zone)
    assert 1 < loaded.sum() < 7
    ratio = float(deep.bearing.ball_diameter / deep.bearing.pitch_diameter)
    np.testing.assert_allclose(found.kinematics.orbit[loaded], 1.0 - ratio, rtol=1e-12)
    np.testing.assert_array_equal(found.centrifugal_force, 0.0)
    np.testing.assert_array_equal(found.gyroscopic_moment, 0.0)
    load = np.asarray(found.contact_load)
    np.testing.assert_allclose(load[:, 0], load[:, 1], rtol=1e-9)
    assert not any("lifted" in text for text in warnings(found))
    oil = bj.lubrication.iso_vg(68.0)
    assert (np.asarray(films(found, oil, 330.0).minimum)[loaded] > 0).all()


def test_constant_contact_angle_in_closed_form():
    """F = Z K (u sin α)^1.5 sin α, whatever the load; radially the cosine."""
    bearing = bj.AngularContactBallBearing(
        7, 0.0435, 0.0115, contact_angle=40 * DEGREE, **grooves(0.53, 0.52)
    )
    element = bj.BearingElement(bearing, kinematics=bj.element.ConstantAngle())
    outer, inner = map(float, element.model().rows[0].element.constant)
    series = (outer ** (-2 / 3) + inner ** (-2 / 3)) ** (-3 / 2)
    sine = np.sin(40 * DEGREE)
    solve = jax.jit(lambda f: bj.solve_load(element, f * jnp.eye(6)[2]))
    for force in (10.0, 1e4):
        s = solve(force)
        load = force / (7 * sine)
        assert np.allclose(s.contact_angle, 40 * DEGREE, rtol=1e-12)
        assert np.allclose(s.roller_load, load, rtol=1e-9)
        moved = (load / series) ** (2 / 3) / sine
        assert float(s.displacement[8]) == pytest.approx(moved, rel=1e-9)
        assert float(s.stiffness[8, 8]) == pytest.approx(1.5 * force / moved, rel=1e-8)
    with pytest.raises(ValueError, match="constant contact angle.*leave out the speed"):
        element.force(jnp.zeros(12), bj.Speed(100.0))
    deep = bj.DeepGrooveBallBearing(7, 0.0435, 0.0115, **grooves(0.53, 0.52))
    with pytest.raises(
        ValueError, match="constant contact angle.*angular contact and thrust"
    ):
        bj.BearingElement(deep, kinematics=bj.element.ConstantAngle())

"""Whole ball bearings against published and independently computed numbers.

* 6305-type (attributed to MASTA; M. Zhun's ISO/TS 16281 test data): curvatures at
  contact angle zero, displacement 1e-4. Its static stiffness has the lever d_m/2 for
  the tilt, where this library has the groove centre's radius: the pitch diameter is
  lowered so that both are equal, with the constants of the true pitch diameter.
* 218 angular contact and 209 deep groove (examples of Harris), exact Hertz.
* High-speed angular contact bearings of Jones's theory (HS-1 to HS-3), with the
  gyroscopic moment at the outer raceway, without it and with its sign reversed, so
  that a failure names its cause.
* SKF program output in Harris and Mindel (1973): the two contacts, and the
  equilibrium. Its free contact angle is not printed, and the printed speed contradicts
  the centrifugal force: the speed is chosen so that this force is the printed one, the
  free angle so that the inner contact angle is. Both loads and the outer angle are then
  met, without a gyroscopic moment in the balance of the ball.
* Sjovall's integrals and Stribeck's number.

The cases with a tilt have their origin in the plane of the inner groove centres, ours
is in that of the balls: loads and displacements are carried over as of a rigid body.
Tolerances are those of the sources.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import grooves

import bearingjax as bj
from bearingjax.contact import ellipse
from bearingjax.design import Material

DEGREE = np.pi / 180
GPA = 1e9


def shift(bearing):
    """Motion of the middle of the inner groove circle from that of the node (6, 6)."""
    z = float(bearing.grooves[1].axial)
    matrix = np.eye(6)
    matrix[0, 4], matrix[1, 3] = z, -z
    return matrix


def masta(clearance, **change):
    values = dict(
        pitch_diameter=0.0435, ball_diameter=0.0115, material=Material(210 * GPA, 0.3)
    )
    return bj.DeepGrooveBallBearing(
        7, radial_internal_clearance=clearance, **values | change, **grooves(0.53, 0.52)
    )


@pytest.mark.parametrize(
    "clearance, axis, displacement",
    [
        (0.0, 0, 15.1101e-6),
        (0.0, 2, 133.5381e-6),
        (10e-6, 0, 21.223e-6),
        (10e-6, 2, 149.1717e-6),
    ],
)
def test_6305_displacement(clearance, axis, displacement):
    element = bj.BearingElement(masta(clearance), point_law=bj.contact.ZeroAngle())
    solution = bj.solve_load(element, 1000.0 * np.eye(6)[axis])
    assert float(solution.displacement[6 + axis]) == pytest.approx(
        displacement, rel=1e-4
    )


def test_6305_stiffness():
    true = masta(10e-6)
    law = bj.contact.ZeroAngle()
    outer, inner = map(
        float, bj.BearingElement(true, point_law=law).model().rows[0].element.constant
    )
    # The groove centre on the circle of half the pitch diameter.
    lever = 0.02 * 0.0115 * float(true.free_cosine)
    bearing = masta(10e-6, pitch_diameter=0.0435 - 2.0 * lever)
    element = bj.BearingElement(
        bearing, point_law=bj.contact.PointConstant(outer, inner)
    )
    solution = bj.solve_load(element, [1000.0, 0, 1000.0, 0, 0, 0])
    # Theirs counts from the free contact angle, ours from the centred ring.
    free = float(bearing.centre_distance * jnp.sin(bearing.free_contact_angle))
    u = np.asarray(solution.displacement)[6:]
    expected = [0.070796235e-3, 0.0195917697e-3, 0.00268710933]
    assert np.allclose([u[2] - free, u[0], u[4]], expected, rtol=1e-5)
    k = np.array(
        [
            [34186.085, -12576.99, 0, 0, 155188.69],
            [-12576.99, 205475.57, 0, 0, -1069700.5],
            [0, 0, 196013.33, 1056935.7, 0],
            [0, 0, 1056935.7, 7706906.9, 0],
            [155188.69, -1069700.5, 0, 0, 8465247.7],
        ]
    )
    compare_stiffness(solution.stiffness, k, np.eye(6))


def compare_stiffness(stiffness, expected, at):
    """Their order axial, radial, radial, tilts; N, mm, rad."""
    back = np.linalg.inv(at)
    mine = back.T @ np.asarray(stiffness)[6:, 6:] @ back
    mine = mine[np.ix_([2, 0, 1, 3, 4], [2, 0, 1, 3, 4])]
    to_metres = np.array([1e3, 1e3, 1e3, 1.0, 1.0])
    expected = expected * np.outer(to_metres, to_metres) * 1e-3
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((mine - expected) / scale).max() < 1e-5


def test_218_under_thrust():
    solution = bj.solve_load(bj.BearingElement(angular_218()), [0, 0, 17800.0, 0, 0, 0])
    angle = np.asarray(solution.contact_angle)[0] / DEGREE
    assert np.allclose(angle, 41.4984, rtol=1e-5)
    assert np.allclose(solution.roller_load, 1678.99, rtol=1e-5)
    # Printed as 0.036 mm; it is 0.0360045.
    assert float(solution.displacement[8]) == pytest.approx(0.036e-3, rel=2e-4)


def angular_218():
    return bj.AngularContactBallBearing(
        16,
        0.12526,
        0.022225,
        contact_angle=40 * DEGREE,
        material=Material(206.843 * GPA, 0.3),
        **grooves(0.5232, 0.5232),
    )


def test_218_constants_and_curvatures():
    bearing = angular_218()
    outer, inner = bj.BearingElement(bearing).model().rows[0].element.constant
    to_si = 1e3**1.5  # N/mm^1.5
    assert float(inner) == pytest.approx(1292363.2 * to_si, rel=1e-4)
    assert float(outer) == pytest.approx(1344293.5 * to_si, rel=1e-4)
    series = (inner ** (-2 / 3) + outer ** (-2 / 3)) ** (-3 / 2)
    assert float(series) == pytest.approx(465948.8 * to_si, rel=1e-4)
    assert float(bearing.centre_distance) == pytest.approx(1.0312e-3, rel=1e-4)


def test_218_stiffness_under_combined_load():
    bearing = angular_218()
    at = shift(bearing)
    load = at.T @ np.array([5000.0, 0, 17800.0, 0, 0, 0])
    solution = bj.solve_load(bj.BearingElement(bearing), load)
    u = at @ np.asarray(solution.displacement)[6:]
    expected = [0.130043179e-3, 0.0229584342e-3, 0.00227654069]
    assert np.allclose(u[[0, 2, 4]], expected, rtol=1e-5)
    # Their loads are printed for balls counted from a place between two of ours.
    k = np.array(
        [
            [742179.01, 7728.7164, 0, 0, 8319637.6],
            [7728.7164, 544945.29, 0, 0, -27097533.0],
            [0, 0, 446789.43, 23325708.0, 0],
            [0, 0, 23325708.0, 1332438100.0, 0],
            [8319637.6, -27097533.0, 0, 0, 1615607600.0],
        ]
    )
    compare_stiffness(solution.stiffness, k, at)


@pytest.mark.parametrize(
    "clearance, displacement, largest",
    [(0.0, 0.0514e-3, 4336.5), (15e-6, 0.06039e-3, 4527.2)],
)
def test_209_radial(clearance, displacement, largest):
    bearing = bj.DeepGrooveBallBearing(
        9,
        0.065,
        0.0127,
        radial_internal_clearance=clearance,
        material=Material(206.843 * GPA, 0.3),
        **grooves(6.6 / 12.7, 6.6 / 12.7),
    )
    solution = bj.solve_load(bj.BearingElement(bearing), [8900.0, 0, 0, 0, 0, 0])
    assert float(solution.displacement[6]) == pytest.approx(displacement, rel=2e-4)
    assert float(solution.roller_load.max()) == pytest.approx(largest, rel=2e-4)


# u [um], alpha_i, alpha_o [deg], Q_i, Q_o [N], omega_m, omega_R [rad/s], F_c [N], M_g.
HIGH_SPEED = {
    "Zenker": (
        (18, 0.09, 0.0127, 0.00666, 0.0068, 25.0, 4150.0, 11111.111),
        (Material(210.08 * GPA, 0.3, 7750.37),) * 2,
        {
            "right": "27.6658242 29.5565826 22.9725818 467.390178 554.607861"
            " 512.052957 4105.03229 98.078653 0.0972291046",
            "none": "29.2986417 28.9360749 24.1321052 476.518377 563.923508"
            " 510.827298 4091.55327 97.609689",
            "wrong": "30.6048566 28.2577636 25.321272 486.980465 574.218075"
            " 509.799551 4079.40375 97.2173172 0.105611203",
        },
    ),
    "Nosaka, steel": (
        (10, 0.0385, 0.007938, 0.00412776, 0.00444528, 20.0, 2670.0, 50000.0),
        (Material(199.948 * GPA, 0.25, 7750.37),) * 2,
        {
            "right": "51.9250223 26.2325622 18.6054032 604.050931 768.818261"
            " 2143.28592 12445.2005 179.492084 0.0909166344",
            "none": "53.4644524 25.8771874 20.1158789 611.762908 776.343467"
            " 2137.73342 12397.3446 178.563286",
            "wrong": "54.8447807 25.4458879 21.7931684 621.423799 785.189262"
            " 2132.74097 12349.7049 177.730228 0.104755585",
        },
    ),
    "Nosaka, hybrid": (
        (10, 0.0385, 0.007938, 0.00412776, 0.00444528, 20.0, 2700.0, 50000.0),
        (Material(320.0 * GPA, 0.26, 3160.0), Material(199.948 * GPA, 0.25, 3160.0)),
        {
            "right": "47.5096864 24.7622312 21.469727 644.616649 710.79047"
            " 2129.59975 12335.2269 72.2513049 0.0419835573",
            "none": "47.9559058 24.5709041 22.1681435 649.320962 715.561716"
            " 2128.02535 12318.032 72.1445145",
            "wrong": "48.3500118 24.3649079 22.8925235 654.471546 720.63091"
            " 2126.63716 12301.3614 72.0504202 0.0444970671",
        },
    ),
}


class Share(bj.element.OuterControl):
    """Outer control with a share of its moment: traced, so compiled once."""

    share: jax.Array

    def traction(self, load, demand):
        return self.share * super().traction(load, demand)


CONTROLS = {"right": 1.0, "none": 0.0, "wrong": -1.0}


@pytest.mark.parametrize("variant", CONTROLS)
@pytest.mark.parametrize("name", HIGH_SPEED)
@pytest.mark.slow
def test_high_speed(name, variant):
    (n, pitch, ball, outer, inner, angle, axial, rpm), materials, numbers = HIGH_SPEED[
        name
    ]
    bearing = bj.AngularContactBallBearing(
        n,
        pitch,
        ball,
        contact_angle=angle * DEGREE,
        material=materials[0],
        ring_material=materials[1],
        **grooves(outer / ball, inner / ball),
    )
    control = Share(jnp.asarray(CONTROLS[variant]))
    element = bj.BearingElement(
        bearing, point_law=bj.contact.OperatingAngle(), raceway_control=control
    )
    s = bj.solve_load(
        element,
        [0, 0, axial, 0, 0, 0],
        support=bj.Support(free=["ux", "uy", "uz"]),
        speed=bj.Speed(rpm * 2 * np.pi / 60),
    )
    angles = np.asarray(s.contact_angle) / DEGREE
    columns = [
        np.full(n, 1e6 * float(s.displacement[8])),
        angles[:, 1],
        angles[:, 0],
        s.roller_load[:, 1],
        s.roller_load[:, 0],
        s.kinematics.orbit,
        s.kinematics.rotation,
        s.centrifugal_force,
        s.gyroscopic_moment,
    ]
    # Without its moment (variant "none") the source prints none.
    expected = np.array(numbers[variant].split(), float)
    mine = np.stack([np.asarray(c) for c in columns], axis=1)[:, : len(expected)]
    assert np.allclose(mine, expected[None, :], rtol=1e-7)  # the source allows 1e-5


def test_harris_mindel_contacts():
    inch, pound = 0.0254, 4.4482216152605
    psi = pound / inch**2
    ball, pitch, modulus = 0.8125, 6.2008, 2.9e7 / (1 - 0.25**2) / 2
    expected = {
        -1.0: (29.762, 287.76, 0.0785038528, 0.00896511091, 195220.389, 0.000403349846),
        1.0: (14.475, 571.07, 0.0968237041, 0.0128009845, 219991.382, 0.000622752423),
    }
    for sign, (angle, load, across, along, pressure, approach) in expected.items():
        turn = sign * ball / pitch * np.cos(angle * DEGREE)
        contact = ellipse(
            jnp.asarray(2.0 / (ball * inch * (1.0 + turn))),
            jnp.asarray((2.0 - 1.0 / 0.52) / (ball * inch)),
            jnp.asarray(modulus * psi),
        )
        q = jnp.asarray(load * pound)
        axes = contact.semi_axes(q)
        # Loads and angles have five printed digits.
        assert float(axes[0]) == pytest.approx(along * inch, rel=1e-4)
        assert float(axes[1]) == pytest.approx(across * inch, rel=1e-4)
        assert float(contact.peak_pressure(q)) == pytest.approx(
            pressure * psi, rel=1e-4
        )
        assert float(contact.approach(q)) == pytest.approx(approach * inch, rel=1e-4)


def test_harris_mindel_equilibrium():
    inch, pound = 0.0254, 4.4482216152605
    bearing = bj.AngularContactBallBearing(
        21,
        6.2008 * inch,
        0.8125 * inch,
        contact_angle=18.647 * DEGREE,
        material=Material(2.9e7 * pound / inch**2, 0.25),
        **grooves(0.52, 0.52),
    )
    element = bj.BearingElement(
        bearing,
        point_law=bj.contact.OperatingAngle(),
        raceway_control=bj.element.OperatingCentrifugal(),
    )
    solve = jax.jit(
        lambda speed: bj.solve_load(
            element,
            [0, 0, 3000.0 * pound, 0, 0, 0],
            support=bj.Support(free=["uz"]),
            speed=bj.Speed(speed),
        )
    )
    # The orbit is proportional to the speed, all but for the contact angles.
    speed = np.float64(1500.0)
    for _ in range(8):
        s = solve(speed)
        speed = speed * np.sqrt(303.45 * pound / float(s.centrifugal_force[0]))
    assert float(s.centrifugal_force[0]) == pytest.approx(303.45 * pound, rel=1e-5)
    angles = np.asarray(s.contact_angle)[0] / DEGREE
    assert np.allclose(angles, [14.475, 29.762], atol=5e-3)  # digits printed: 5e-4
    # Printed loads balance the thrust to 1e-4 and the radius to 6e-4.
    assert np.allclose(s.roller_load[0] / pound, [571.07, 287.76], rtol=1e-3)
    assert np.all(np.asarray(s.gyroscopic_moment) == 0.0)


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
    with pytest.raises(
        ValueError, match="constant contact angle.*angular contact and thrust"
    ):
        bj.BearingElement(masta(0.0), kinematics=bj.element.ConstantAngle())


# eps, J_r, J_a of point contact, exact integrals.
SJOVALL = np.array(
    """
    0.2 0.159037526 0.170672024   0.3 0.189180524 0.211028346
    0.4 0.211713583 0.246153837   0.5 0.228827929 0.278208947
    0.6 0.241590181 0.308355928   0.7 0.250544198 0.337362445
    0.8 0.255902442 0.365849353   0.9 0.257551337 0.394474928
    1.0 0.254647909 0.424413182   1.25 0.228886102 0.504401220
    1.67 0.186847816 0.606674256  2.5 0.133899426 0.723951956
    5.0 0.071123744 0.855792539
    """.split(),
    float,
).reshape(-1, 3)


def many_balls():
    """720 small balls: an integral, all but. Wide grooves hold the contact angle."""
    return bj.AngularContactBallBearing(
        720, 1.0, 0.004, contact_angle=40 * DEGREE, **grooves(0.7, 0.7)
    )


def test_sjovall_integrals():
    """Displacements so small that the contact angle stays as it is: 1e-9 m."""
    element = bj.BearingElement(many_balls())
    eps = SJOVALL[:, 0]
    radial = 1e-9 / (2 * eps)
    q = np.zeros((len(eps), 12))
    q[:, 6] = radial / np.cos(40 * DEGREE)
    q[:, 8] = (2 * eps - 1) * radial / np.sin(40 * DEGREE)
    rows = jax.vmap(lambda q: element.rows(q)[0].contact_load[:, 1])(jnp.array(q))
    force = np.asarray(jax.vmap(element.force)(jnp.array(q)))
    largest = np.asarray(rows).max(axis=1)
    j_r = force[:, 6] / (720 * largest * np.cos(40 * DEGREE))
    j_a = force[:, 8] / (720 * largest * np.sin(40 * DEGREE))
    assert np.allclose(j_r, SJOVALL[:, 1], rtol=1e-5)
    assert np.allclose(j_a, SJOVALL[:, 2], rtol=1e-5)


def test_sjovall_double_row():
    """Two rows back to back: the second carries with 1 - eps."""
    pair = bj.BearingSet.back_to_back(many_balls(), 0.01)
    # Rows at a distance: a radial motion with no tilt loads both alike.
    element = bj.BearingElement(pair)
    for eps, j_r, j_a, ratio in (
        (0.6, 0.3568325, 0.1743668, 0.5443311),
        (0.8, 0.2757821, 0.3445153, 0.125),
        (1.0, 0.2546479, 0.4244132, 0.0),
    ):
        q = np.zeros(12)
        q[6] = 1e-9 / (2 * eps) / np.cos(40 * DEGREE)
        q[8] = (2 * eps - 1) * 1e-9 / (2 * eps) / np.sin(40 * DEGREE)
        rows = element.rows(jnp.asarray(q))
        first, second = (np.asarray(r.contact_load[:, 1]).max() for r in rows)
        force = np.asarray(element.force(jnp.asarray(q)))
        assert second / first == pytest.approx(ratio, abs=1e-5)
        mine = force[[6, 8]] / (720 * first * np.array([np.cos(0.698131700797732), 1]))
        mine[1] /= np.sin(40 * DEGREE)
        assert np.allclose(mine, [j_r, j_a], rtol=1e-5)


@pytest.mark.slow
def test_stribeck_number():
    """4.37 W/z: exactly 1/J_r(0.5) for many balls, 4.373 for fourteen (AF003-6)."""
    many = bj.DeepGrooveBallBearing(720, 1.0, 0.004, **grooves(0.52, 0.52))
    s = bj.solve_load(
        bj.BearingElement(many), [1e-3, 0, 0, 0, 0, 0], support=bj.Support(free=["ux"])
    )
    stribeck = 720 * float(s.roller_load[:, 1].max()) / 1e-3
    assert stribeck == pytest.approx(1 / 0.228827929, rel=1e-5)
    fourteen = bj.DeepGrooveBallBearing(14, 0.0775, 0.014288, **grooves(0.52, 0.52))
    s = bj.solve_load(bj.BearingElement(fourteen), [250.0, 0, 0, 0, 0, 0])
    assert float(s.roller_load[:, 1].max()) == pytest.approx(78.09, rel=1e-4)

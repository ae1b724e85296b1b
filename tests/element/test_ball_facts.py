"""Acceptance facts of methods 001 to 003 that a quasi-static ball bearing can meet.

AF001 (Han & Chu 2015): the paper's bearing is lost; what is tested is the assumed one
of the specification (7207-class: 12 balls of 12.7 mm on 53.285 mm, osculation 0.52, 25
degrees, 206 GPa, 0.3, 7850 kg/m³) with the friction split λ = 1 and the spin axis of
outer control, and the numbers that an independent program found for it. Loads and
displacements are those of the plane of the inner groove centres. The least loads of
fact 17 are those of a periodic cubic spline through the twelve balls, which overshoots:
with the orbit filled with balls they are 41.6, 20.9 and 8.7 N at 300, 400 and 500 N,
not 41.3, 20.1 and 6.3 N; both are tested.

AF002 (Filipkovskii & Belomyttsev 2014): GOST 831-75 bearing, 7 balls of 11.510 mm, both
groove radii 5.930 mm, inner groove bottom 16 mm; each printed outer groove bottom
implies its own free contact angle and preload.

AF003 (Kurushin 2011): stiffness of a contact (Stribeck's number: test_published_balls).
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import PUBLISHED, ROUNDING

import bearingjax as bj
from bearingjax.contact import Ellipse
from bearingjax.element import ball_kinematics, ball_mass

DEGREE = np.pi / 180
SPEED = bj.Speed(209.4395)
AXIAL = 112.82


def assumed(n=12, **change):
    values = dict(
        outer_osculation=0.52,
        inner_osculation=0.52,
        contact_angle=25 * DEGREE,
        material=bj.Material(206e9, 0.3, 7850.0),
    )
    bearing = bj.AngularContactBallBearing(n, 0.053285, 0.0127, **(values | change))
    return bj.BearingElement(bearing, raceway_control=bj.element.EqualShare())


def shift(element):
    z = float(element.bearing.grooves[1].axial)
    matrix = np.eye(6)
    matrix[0, 4], matrix[1, 3] = z, -z
    return matrix


@pytest.fixture(scope="module")
def element():
    return assumed()


def combined(element, radial, **how):
    load = shift(element).T @ np.array([radial, 0, 600.0, 0, 0, 0])
    if "support" in how:
        # The locked tilts take the moment of the shifted load.
        load[3:] = 0.0
    return bj.solve_load(element, load, speed=SPEED, **how)


@eqx.filter_jit
def along_the_orbit(displacement, count=720):
    """Inner contact load at every place of the orbit, rings held."""

    def one(place):
        bearing = eqx.tree_at(lambda b: b.first_azimuth, assumed(1).bearing, place)
        single = eqx.tree_at(lambda e: e.bearing, assumed(1), bearing)
        row = single.rows(displacement, SPEED)[0]
        return row.contact_load[0, 1]

    return jax.vmap(one)(jnp.linspace(0, 2 * jnp.pi, count, endpoint=False))


def periodic_spline(values, count):
    """Cubic spline through values at equal steps of a period, at `count` places."""
    n = len(values)
    circulant = np.eye(n) * 4 + np.roll(np.eye(n), 1, 0) + np.roll(np.eye(n), -1, 0)
    second = np.linalg.solve(
        circulant, 6 * (np.roll(values, -1) - 2 * values + np.roll(values, 1))
    )
    t, k = np.modf(np.arange(count) * n / count)
    a, b = k.astype(int) % n, (k.astype(int) + 1) % n
    bend = ((1 - t) ** 3 - (1 - t)) * second[a] + (t**3 - t) * second[b]
    return (1 - t) * values[a] + t * values[b] + bend / 6


def test_constants_and_masses(element):
    outer, inner = element.model().rows[0].element.constant
    assert float(inner) == pytest.approx(3.196e10, rel=PUBLISHED)
    assert float(outer) == pytest.approx(3.399e10, rel=PUBLISHED)
    mass, moment = map(float, ball_mass(jnp.asarray(0.0127), jnp.asarray(7850.0)))
    assert mass == pytest.approx(8.419e-3, rel=PUBLISHED)
    assert moment == pytest.approx(1.358e-7, rel=PUBLISHED)


def test_fact_1_orbit_in_pure_rolling():
    normal = jnp.asarray([np.sin(25 * DEGREE), np.cos(25 * DEGREE)])
    k = ball_kinematics(normal, normal, jnp.asarray(1.0), jnp.asarray(0.238339), SPEED)
    assert float(k.orbit) / 209.4395 == pytest.approx(0.39200, abs=5e-6)
    assert float(k.orbit) == pytest.approx(82.0994, rel=1e-6)


def test_spin_to_roll_is_zero_at_equal_ring_speeds():
    """Then spin over rolling was 0/0, or round-off over round-off."""
    outer, inner = (jnp.asarray([np.sin(a), np.cos(a)]) for a in (0.38, 0.47))
    one, ratio = jnp.asarray(1.0), jnp.asarray(0.238339)
    for speed in (bj.Speed(300.0, 300.0), bj.Speed(0.0, 0.0)):
        k = ball_kinematics(outer, inner, one, ratio, speed)
        assert np.array_equal(k.spin_to_roll, [0.0, 0.0])
    slow = ball_kinematics(outer, inner, one, ratio, bj.Speed(300.0 + 1e-6, 300.0))
    fast = ball_kinematics(outer, inner, one, ratio, bj.Speed(1.0, 0.0))
    assert np.allclose(slow.spin_to_roll, fast.spin_to_roll, rtol=1e-3)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_fact_9_no_slip_at_either_centre(share):
    """Slip (16), (19) of the specification, for any direction of the spin axis."""
    outer, inner = (jnp.asarray([np.sin(a), np.cos(a)]) for a in (0.38, 0.47))
    ratio, ball = 0.238339, 0.0127
    k = ball_kinematics(outer, inner, jnp.asarray(share), jnp.asarray(ratio), SPEED)
    y, z = (
        float(k.rotation) * float(k.axis[0]),
        -float(k.rotation) * float(k.axis[1]),
    )
    (so, co), (si, ci) = map(np.asarray, (outer, inner))
    pitch, orbit, inner_speed = ball / ratio, float(k.orbit), 209.4395
    at_outer = 0.5 * ball * (y * so - z * co) - orbit * 0.5 * (pitch + ball * co)
    at_inner = -0.5 * ball * (y * si - z * ci) + (inner_speed - orbit) * 0.5 * (
        pitch - ball * ci
    )
    assert abs(at_outer) < ROUNDING * 5 and abs(at_inner) < ROUNDING * 5
    # Spin (18), (21); none on the raceway that controls.
    spin = [y * co + (z + orbit) * so, y * ci + (z + orbit - inner_speed) * si]
    assert np.allclose(k.spin, spin, rtol=0, atol=1e-10)
    if share in (0.0, 1.0):
        assert abs(float(k.spin[0 if share == 1.0 else 1])) < 1e-10


@pytest.mark.parametrize(
    "axial, angles, load, pressure",
    [
        (40.0, (27.49, 22.66), None, None),
        (120.0, (26.17, 24.56), 22.41, 532e6),
        (520.0, (26.17, 25.78), 97.98, 869e6),
        (600.0, None, 112.82, 911e6),
    ],
)
def test_facts_6_to_8_axial(element, axial, angles, load, pressure):
    s = bj.solve_load(element, [0, 0, axial, 0, 0, 0], speed=SPEED)
    alpha = np.asarray(s.contact_angle)
    if angles is not None:
        # Printed to 0.01 degrees; 40 N differs by that, and all balls are equal.
        assert np.allclose(alpha[:, 1] / DEGREE, angles[0], atol=0.016)
        assert np.allclose(alpha[:, 0] / DEGREE, angles[1], atol=0.016)
    if load is not None:
        assert np.allclose(s.roller_load[:, 1], load, rtol=PUBLISHED)
        assert np.allclose(s.contact_pressure[:, 1], pressure, rtol=PUBLISHED)
    # Fact 6: axial balance up to the traction, F_c = 1.52 N and M_g = 1.6 N mm.
    traction = 0.5 * np.asarray(s.gyroscopic_moment) * 2 / 0.0127
    thrust = np.asarray(s.roller_load[:, 1]) * np.sin(alpha[:, 1])
    thrust = thrust + traction * np.cos(alpha[:, 1])
    assert np.sum(thrust) == pytest.approx(axial, rel=1e-9)
    # Printed once for all loads, while both follow the contact angles: by 1 and 6 %.
    assert np.allclose(s.centrifugal_force, 1.52, rtol=0.011)
    assert np.allclose(s.gyroscopic_moment, 1.6e-3, rtol=0.07)


@pytest.mark.parametrize(
    "radial, first, second, least, true_least",
    [
        (100.0, 146.6, 116.0, 96.1, 96.1),
        (200.0, None, None, 67.8, 67.8),
        (300.0, None, None, 41.3, 41.6),
        (400.0, 319.2, 182.3, 20.1, 20.9),
        (500.0, 377.8, 201.4, 6.3, 8.7),
    ],
)
def test_facts_15_to_17_two_loaded_zones(
    element, radial, first, second, least, true_least
):
    s = combined(element, radial, options=bj.statics.SolveOptions(tolerance=1e-12))
    # Fact 5: nothing out of balance.
    load = np.hypot(600.0, radial)
    assert float(s.stats.residual) * load < 1e-9
    load = np.asarray(along_the_orbit(s.displacement))
    # Printed to 0.1 N.
    spline = periodic_spline(np.asarray(s.roller_load)[:, 1], 720)
    assert spline.min() == pytest.approx(least, abs=0.06)
    assert load.min() == pytest.approx(true_least, abs=0.06)
    assert load.min() > 0  # "balls still carry load"
    if first is not None:
        assert load[0] == pytest.approx(first, rel=PUBLISHED)
        assert load[360] == pytest.approx(second, rel=PUBLISHED)
        assert load.argmax() == 0  # B under the load
    if radial == 400.0:
        # Fact 15, in fractions of an orbit; printed to 0.001 and seen to 1/720.
        above = load > AXIAL
        half = np.argmin(above)  # end of the zone around the load
        assert half / 720 == pytest.approx(0.149, abs=0.002)
        zone = np.flatnonzero(above[half:-half]) + half
        assert zone[0] / 720 == pytest.approx(0.404, abs=0.002)
        assert zone[-1] / 720 == pytest.approx(0.596, abs=0.002)
        # Fact 20: the zones' middles are under the load and opposite, to one place.
        assert 0.5 * (zone[0] + zone[-1]) == pytest.approx(360, abs=1)


def test_facts_18_and_19(element):
    s = combined(element, 400.0)
    u = shift(element) @ np.asarray(s.displacement)[6:]
    assert u[0] == pytest.approx(35.337e-6, rel=PUBLISHED)
    assert u[2] == pytest.approx(3.586e-6, rel=PUBLISHED)
    assert u[4] == pytest.approx(2.649e-3, rel=PUBLISHED)
    locked = combined(element, 400.0, support=bj.Support(["ux", "uy", "uz"]))
    load = np.asarray(along_the_orbit(locked.displacement))
    # One maximum only: falling from 191 N under the load to 44 N opposite (printed
    # to 1 N).
    assert load[0] == pytest.approx(191, abs=1) and load[360] == pytest.approx(
        44, abs=1
    )
    assert np.all(np.diff(load[:361]) < 0)


GOST = """
12 27.5125  6.852 5.263 1.2428 218.4  25.32 1.4322 1.2941 1.22
15 27.5167 11.229 5.410 1.2429 283.4  20.90 1.4161 2.0335 1.14
26 27.5399 23.855 6.144 1.2437 581.2  14.02 1.3074 6.2201 1.048
36 27.5709 34.310 7.347 1.2445 1019.8 12.50 1.1592 12.238 1.026
40 27.5858 38.424 7.943 1.2449 1253.9 12.36 1.0809 15.221 1.021
"""


@pytest.mark.parametrize("line", GOST.strip().splitlines())
def test_af002_2_and_7_preloaded_bearing(line):
    """Given the preload, our bearing closes to the contact angle of the paper.

    Its fixed-angle stiffness c_a is too low at small angles: by 22 % at 12 degrees,
    as exact groove-centre kinematics shows.
    """
    angle, outer, free, w, k, preload, z0, c_r, c_a, ratio = map(float, line.split())
    ball, groove, bottom = 11.510e-3, 5.930e-3, 16e-3
    outer *= 1e-3
    # The ball circle lies on the loaded contact line, amid the groove centres.
    pitch = bottom + outer
    near = bottom + 2 * groove - outer
    free_angle = np.arccos(near / (2 * groove - ball))
    assert free_angle / DEGREE == pytest.approx(free, rel=PUBLISHED)
    bearing = bj.AngularContactBallBearing(
        7,
        pitch,
        ball,
        outer_osculation=groove / ball,
        inner_osculation=groove / ball,
        contact_angle=free_angle,
        material=bj.Material(210e9, 0.3, 7850.0),
    )
    element = bj.BearingElement(bearing, point_law=bj.contact.OperatingAngle())
    s = bj.solve_load(element, [0, 0, preload, 0, 0, 0])
    # The preload hangs on the fourth digit of R2: 1.5 % for 0.05 um.
    loaded = np.asarray(s.contact_angle)[0]
    assert np.allclose(loaded / DEGREE, angle, atol=5e-3)
    approach = float(s.approach[0].sum())
    assert approach == pytest.approx(w * 1e-6, rel=PUBLISHED)
    force = float(s.roller_load[0, 0])
    series = force / approach**1.5
    assert series == pytest.approx(k * 1e10, rel=PUBLISHED)
    assert 7 * force * np.sin(angle * DEGREE) == pytest.approx(preload, rel=PUBLISHED)
    # The paper's closed forms with these.
    start = approach / np.sin(angle * DEGREE)
    assert start == pytest.approx(z0 * 1e-6, rel=PUBLISHED)
    radial = 0.75 * 7 * series * np.sqrt(start * np.sin(angle * DEGREE))
    radial *= np.cos(angle * DEGREE) ** 2
    axial = 2 * radial * np.tan(angle * DEGREE) ** 2
    assert radial == pytest.approx(c_r * 1e8, rel=PUBLISHED)
    assert axial == pytest.approx(c_a * 1e7, rel=PUBLISHED)
    exact = np.asarray(s.stiffness)[6:, 6:]
    # Printed to a per cent (12 and 15 degrees) or a thousandth.
    assert exact[2, 2] / axial == pytest.approx(ratio, abs=6e-3)
    # "+0.04 to +1.0 %".
    assert 1.0003 < exact[0, 0] / radial < 1.0105


def test_af003_1_stiffness_of_a_contact():
    one = jnp.asarray(1.0)
    contact = Ellipse(one, jnp.asarray(1e10), one, one)
    approach = contact.approach(jnp.asarray(100.0))
    rate = jax.grad(contact.load)(approach)
    assert float(rate) == pytest.approx(3.23165e7, rel=1e-6)


@pytest.mark.parametrize(
    "n, ball, pitch, angle, orders",
    [
        (9, 0.3126, 1.537, 0, (3.584776, 5.415224, 0.398308, 2.356722)),
        (8, 0.2656, 1.122, 0, (3.053119, 4.946881, 0.381640, 1.993839)),
        (8, 11.9062, 52.0, 0, (3.084138, 4.915862, 0.385517, 2.069254)),
        (16, 0.331, 2.815, 15.17, (7.092104, 8.907896, 0.443257, 4.197500)),
        (14, 14.288, 77.5, 0, (5.709471, 8.290529, 0.407819, 2.619885)),
        (7, 11.51, 43.5, 0, (2.573908, 4.426092, 0.367701, 1.757362)),
    ],
)
def test_bearing_frequencies(n, ball, pitch, angle, orders):
    """Orders of the shaft (KIN-1): outer and inner defect, cage, ball spin."""
    normal = jnp.asarray([np.sin(angle * DEGREE), np.cos(angle * DEGREE)])
    ratio = jnp.asarray(ball / pitch)
    k = ball_kinematics(normal, normal, jnp.asarray(0.5), ratio, bj.Speed(1.0))
    cage = float(k.orbit)
    mine = (n * cage, n * (1 - cage), cage, _ball_spin(k, normal))
    assert np.allclose(mine, orders, rtol=0, atol=1e-6)  # printed digits


def _ball_spin(k, normal):
    """Rotation in the frame of the cage, about the tangent of the contact."""
    return float(k.rotation) * float(k.axis @ normal)

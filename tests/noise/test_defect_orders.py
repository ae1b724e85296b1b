"""Kinematic frequencies and orders of waviness.

Published orders: CWRU bearing data centre (6205, 6203), NASA/IMS data set (Rexnord
ZA-2115), to the digits they print; all rows to 1e-6 from the formulas of rolling.
Waviness: relations of Wardle (1988) for a bearing of 8 balls of 6.747 mm on 28.5 mm at
25 Hz, and a sum over rolling elements in time for any speeds of both rings.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import bearings as rollers
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj
from bearingjax.element import roller_speeds
from bearingjax.element.constants import contact_constants
from bearingjax.noise import kinematic_frequencies, waviness_force

TURN = 2 * np.pi


def balls(z, diameter, pitch, degrees=0.0):
    kind = dict(outer_osculation=0.52, inner_osculation=0.52)
    if degrees:
        angle = np.radians(degrees)
        return bj.AngularContactBallBearing(
            z, pitch, diameter, contact_angle=angle, **kind
        )
    return bj.DeepGrooveBallBearing(z, pitch, diameter, **kind)


# BPFO, BPFI, FTF, 2 BSF, BSF per turn of the shaft, and what is published of the first
# four; dimensions in the unit of the source, as only their ratio counts.
ROWS = {
    "CWRU 6205": (
        balls(9, 0.3126, 1.537),
        (3.584776, 5.415224, 0.398308, 4.713443, 2.356722),
        (3.5848, 5.4152, 0.39828, 4.7135),
    ),
    "CWRU 6203": (
        balls(8, 0.2656, 1.122),
        (3.053119, 4.946881, 0.381640, 3.987677, 1.993839),
        (3.0530, 4.9469, 0.3817, 3.9874),
    ),
    "JIS 6306": (
        balls(8, 11.9062, 52.0),
        (3.084138, 4.915862, 0.385517, 4.138507, 2.069254),
        (),
    ),
    "Rexnord ZA-2115": (
        balls(16, 0.331, 2.815, 15.17),
        (7.092104, 8.907896, 0.443257, 8.394999, 4.197500),
        (7.092, 8.908, 0.4433),
    ),
    "176211": (
        balls(14, 14.288, 77.5),
        (5.709471, 8.290529, 0.407819, 5.239771, 2.619885),
        (),
    ),
    "305": (
        balls(7, 11.51, 43.5),
        (2.573908, 4.426092, 0.367701, 3.514725, 1.757362),
        (),
    ),
}


def listed(found):
    return np.array(
        [
            found.outer_passage,
            found.inner_passage,
            found.cage,
            found.twice_rotation,
            found.rotation,
        ]
    )


@pytest.mark.parametrize("name", ROWS)
def test_published_orders(name):
    bearing, exact, published = ROWS[name]
    speed = bj.Speed(inner=25 * TURN)
    found = kinematic_frequencies(bearing, speed)
    np.testing.assert_allclose(listed(found.orders), exact, atol=1e-6)
    printed = listed(found.orders)[: len(published)]
    np.testing.assert_allclose(printed, published, atol=5e-4)
    np.testing.assert_allclose(listed(found), 25 * listed(found.orders))
    assert found.inner == 25 and found.outer == 0 and found.shaft == found.inner
    # Every rolling element passes both raceways once per turn of the cage against them.
    z = bearing.n_balls
    np.testing.assert_allclose(found.outer_passage + found.inner_passage, 25.0 * z)


def test_orders_of_a_spherical_roller_bearing():
    """22220, printed by Schaeffler: 18 rollers in each row, γ = 0.1539."""
    row = bj.SphericalRollerRow(
        18,
        0.1376,
        0.1539 * 0.1376 / np.cos(np.radians(9.5)),
        0.0185,
        contact_angle=np.radians(9.5),
        roller_profile_radius=0.078,
        inner_raceway_radius=0.0805,
    )
    found = kinematic_frequencies(row, bj.Speed(inner=TURN))
    printed = [7.6149, 10.385]
    orders = [found.outer_passage, found.inner_passage]
    np.testing.assert_allclose(orders, printed, rtol=0.0, atol=2e-4)


def test_both_rings_turn():
    bearing = ROWS["176211"][0]
    of_inner = kinematic_frequencies(bearing, bj.Speed(inner=25 * TURN))
    of_outer = kinematic_frequencies(bearing, bj.Speed(outer=25 * TURN))
    assert of_outer.shaft == 25 and of_outer.inner == 0
    # Passages depend on the rings' difference alone; the cage has the rest.
    for name in ("outer_passage", "inner_passage", "rotation"):
        np.testing.assert_allclose(getattr(of_outer, name), getattr(of_inner, name))
    np.testing.assert_allclose(of_outer.cage + of_inner.cage, 25.0)
    backwards = kinematic_frequencies(bearing, bj.Speed(inner=-25 * TURN))
    np.testing.assert_allclose(np.array(backwards), np.array(of_inner))
    together = kinematic_frequencies(bearing, bj.Speed(25 * TURN, 25 * TURN))
    np.testing.assert_allclose(np.array(together), [25, 25, 25, 0, 0, 0], atol=1e-12)


@pytest.mark.parametrize("name", rollers())
def test_rollers(name):
    """Cylinders, needles and tapers: as their inertia has them roll."""
    bearing = rollers()[name]
    speed = bj.Speed(120.0, -35.0)
    found = kinematic_frequencies(bearing, speed)
    constants = contact_constants(
        bearing, bj.contact.Palmgren(), bj.numerics.Midpoint(3)
    )
    orbit, spin = roller_speeds(constants, speed)
    np.testing.assert_allclose(TURN * found.cage, abs(orbit))
    np.testing.assert_allclose(TURN * found.rotation, abs(spin))
    passed = bearing.n_rollers * abs(orbit + 35.0) / TURN
    np.testing.assert_allclose(found.outer_passage, passed)


def test_operating_contact_angles():
    bearing = ROWS["Rexnord ZA-2115"][0]
    speed = bj.Speed(inner=100.0)
    free = np.radians(15.17)
    at_free = kinematic_frequencies(bearing, speed, free)
    want = np.array(kinematic_frequencies(bearing, speed))
    np.testing.assert_allclose(np.array(at_free), want, rtol=ROUNDING)
    # A ball that runs steeper has its contacts nearer to the pitch circle.
    steep = kinematic_frequencies(bearing, speed, np.radians(25.0))
    want = 0.5 * (1 - 0.331 / 2.815 * np.cos(np.radians(25.0))) * 100 / TURN
    np.testing.assert_allclose(steep.cage, want)
    four = bj.FourPointBallBearing(
        14,
        77.5,
        14.288,
        outer_osculation=0.52,
        inner_osculation=0.52,
        shim_angle=np.radians(20.0),
    )
    found = kinematic_frequencies(four, speed)
    want = 0.5 * (1 - 14.288 / 77.5 * np.cos(np.radians(20.0))) * 100 / TURN
    np.testing.assert_allclose(found.cage, want)


def test_kinematics_and_waviness_reject_invalid_numbers():
    bearing, speed = ROWS["305"][0], bj.Speed(1.0)
    with pytest.raises(ValueError, match="`contact_angle` is given for rollers"):
        kinematic_frequencies(next(iter(rollers().values())), speed, 0.1)
    with pytest.raises(ValueError, match="`contact_angle` is nan rad"):
        kinematic_frequencies(bearing, speed, np.nan)
    with pytest.raises(ValueError, match="`part` is 'ball'; it must be outer, inner"):
        waviness_force(bearing, speed, "ball", 2)
    with pytest.raises(ValueError, match="`order` is 0"):
        waviness_force(bearing, speed, "inner", 0)


def test_kinematic_frequencies_reject_invalid_arguments(untyped):
    pair = bj.BearingSet.back_to_back(ROWS["Rexnord ZA-2115"][0], 1.0, 0.0)
    with pytest.raises(TypeError, match="BearingSet.*rows"):
        kinematic_frequencies(pair, bj.Speed(25.0))  # type: ignore
    with pytest.raises(TypeError, match="`speed` is a float"):
        kinematic_frequencies(ROWS["305"][0], 25.0)  # type: ignore
    with pytest.raises(TypeError, match="`bearing` is a str"):
        kinematic_frequencies("6205", bj.Speed(25.0))  # type: ignore


EIGHT = balls(8, 6.747, 28.5)
WAVES = {
    (1, "inner"): ([8, 123.673684], [7, 98.6736842], [9, 148.673684]),
    (2, "inner"): ([16, 247.347368], [15, 222.347368], [17, 272.347368]),
    (1, "outer"): ([8, 76.3263158], [7, 76.3263158], [9, 76.3263158]),
    (2, "outer"): ([16, 152.652632], [15, 152.652632], [17, 152.652632]),
}


def force(part, order, bearing=EIGHT, speed=None):
    found = waviness_force(bearing, speed or bj.Speed(inner=25 * TURN), part, order)
    return np.array(found.axial), np.array(found.radial)


@pytest.mark.parametrize("k, part", WAVES)
def test_waves_on_raceways(k, part):
    (n, axial), *both = WAVES[k, part]
    found = force(part, n)
    np.testing.assert_allclose(found[0], [axial], rtol=1e-8)
    assert found[1].size == 0
    for n, radial in both:
        found = force(part, n)
        assert found[0].size == 0
        np.testing.assert_allclose(abs(found[1]), [radial], rtol=1e-8)


def test_waves_on_a_ball():
    values = {2: (99.6840689, (90.1432795, 109.224858))}
    values[4] = (199.368138, (189.827348, 208.908927))
    for n, (axial, radial) in values.items():
        found = force("element", n)
        np.testing.assert_allclose(found[0], [axial], rtol=1e-8)
        np.testing.assert_allclose(np.sort(abs(found[1])), radial, rtol=1e-8)
    for n in (1, 3, 5):
        assert all(lines.size == 0 for lines in force("element", n))


def test_all_other_orders_balance():
    for part in ("inner", "outer"):
        making = [n for n in range(1, 18) if sum(a.size for a in force(part, n))]
        assert making == [1, 7, 8, 9, 15, 16, 17]
    # An eccentric inner ring shakes at its own speed; the outer one is only offset.
    np.testing.assert_allclose(force("inner", 1)[1], [25.0])
    np.testing.assert_allclose(force("outer", 1)[1], [0.0], atol=1e-12)


def test_orders_of_the_four_point_bearing():
    bearing = ROWS["176211"][0]
    orders = range(1, 45)
    radial = [n for n in orders if force("inner", n, bearing)[1].size]
    axial = [n for n in orders if force("inner", n, bearing)[0].size]
    assert radial == [1, 13, 15, 27, 29, 41, 43]
    assert axial == [14, 28, 42]


@pytest.mark.parametrize("part", ["inner", "outer"])
@pytest.mark.parametrize("z, n", [(5, 4), (5, 6), (5, 10), (5, 7), (2, 3), (1, 2)])
def test_waves_summed_over_the_elements(part, z, n):
    """Both rings turn: the sum over rolling elements has these lines, and no others."""
    bearing = balls(z, 6.747, 28.5)
    speed = bj.Speed(inner=3.0 * TURN, outer=-1.3 * TURN)
    cage = 0.5 * ((1 - 6.747 / 28.5) * 3.0 + (1 + 6.747 / 28.5) * -1.3)
    ring = 3.0 if part == "inner" else -1.3
    time = np.linspace(0.0, 2.0, 400)
    place = TURN * (cage * time[:, None] + np.arange(z) / z)
    wave = np.cos(n * (place - TURN * ring * time[:, None]))
    axial, radial = force(part, n, bearing, speed)
    want = np.zeros(len(time))
    for one in axial:
        want = want + z * np.cos(TURN * one * time)
    np.testing.assert_allclose(wave.sum(axis=1), want, atol=1e-10)
    turned = np.zeros(len(time), complex)
    for one in radial:
        turned = turned + 0.5 * z * np.exp(1j * TURN * one * time)
    found = (wave * np.exp(1j * place)).sum(axis=1)
    np.testing.assert_allclose(found, turned, atol=1e-10)


def test_ball_waviness_orders_match_squeeze_of_both_contacts():
    """Height of a wave at both contacts, pressed together: the lines of even orders."""
    speed = bj.Speed(inner=3.0 * TURN, outer=-1.3 * TURN)
    kinematic = kinematic_frequencies(EIGHT, speed)
    cage = 0.5 * ((1 - 6.747 / 28.5) * 3.0 + (1 + 6.747 / 28.5) * -1.3)
    time = np.linspace(0.0, 2.0, 400)
    angle = TURN * float(kinematic.rotation) * time
    for n in (2, 3, 4):
        squeeze = np.cos(n * angle) + np.cos(n * (angle + np.pi))
        axial, radial = force("element", n, EIGHT, speed)
        want = sum((2 * np.cos(TURN * one * time) for one in axial), 0 * time)
        np.testing.assert_allclose(squeeze, want, atol=1e-10)
        found = squeeze * np.exp(1j * TURN * cage * time)
        want = sum((np.exp(1j * TURN * one * time) for one in radial), 0 * time)
        np.testing.assert_allclose(found, want, atol=1e-10)


@pytest.mark.slow
def test_derivatives_of_frequencies():
    def weighted(numbers):
        pitch, diameter, inner, outer, angle = numbers
        bearing = balls(8, diameter, pitch, 20.0)
        found = kinematic_frequencies(bearing, bj.Speed(inner, outer), angle)
        wave = waviness_force(bearing, bj.Speed(inner, outer), "inner", 9, angle)
        return jnp.stack(found) @ jnp.arange(1.0, 7.0) + wave.radial[0]

    at = jnp.array([0.05, 0.009, 160.0, -30.0, 0.5])
    slope = jax.grad(weighted)(at)
    assert (slope != 0).all()
    for i in range(5):
        step = 1e-5 * at[i] * jnp.eye(5)[i]
        difference = (weighted(at + step) - weighted(at - step)) / (2e-5 * at[i])
        np.testing.assert_allclose(slope[i], difference, rtol=DIFFERENCE)

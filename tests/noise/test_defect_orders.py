"""Kinematic frequencies and orders of waviness.

Published orders and relations of waviness are validation cases (`defect_orders`,
`waviness_lines`); here are identities, and a sum over rolling elements in time for any
speeds of both rings.
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


ROWS = {
    "CWRU 6205": balls(9, 0.3126, 1.537),
    "Rexnord ZA-2115": balls(16, 0.331, 2.815, 15.17),
    "176211": balls(14, 14.288, 77.5),
    "305": balls(7, 11.51, 43.5),
}
"""Dimensions in the unit of the source, as only their ratio counts."""


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
def test_orders_and_frequencies(name):
    bearing = ROWS[name]
    speed = bj.Speed(inner=25 * TURN)
    found = kinematic_frequencies(bearing, speed)
    np.testing.assert_allclose(listed(found), 25 * listed(found.orders))
    assert found.inner == 25 and found.outer == 0 and found.shaft == found.inner
    # Every rolling element passes both raceways once per turn of the cage against them.
    z = bearing.n_balls
    np.testing.assert_allclose(found.outer_passage + found.inner_passage, 25.0 * z)


def test_both_rings_turn():
    bearing = ROWS["176211"]
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
    bearing = ROWS["Rexnord ZA-2115"]
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
    bearing, speed = ROWS["305"], bj.Speed(1.0)
    with pytest.raises(ValueError, match="`contact_angle` is given for rollers"):
        kinematic_frequencies(next(iter(rollers().values())), speed, 0.1)
    with pytest.raises(ValueError, match="`contact_angle` is nan rad"):
        kinematic_frequencies(bearing, speed, np.nan)
    with pytest.raises(ValueError, match="`part` is 'ball'; it must be outer, inner"):
        waviness_force(bearing, speed, "ball", 2)
    with pytest.raises(ValueError, match="`order` is 0"):
        waviness_force(bearing, speed, "inner", 0)


def test_kinematic_frequencies_reject_invalid_arguments(untyped):
    pair = bj.BearingSet.back_to_back(ROWS["Rexnord ZA-2115"], 1.0, 0.0)
    with pytest.raises(TypeError, match="BearingSet.*rows"):
        kinematic_frequencies(pair, bj.Speed(25.0))  # type: ignore
    with pytest.raises(TypeError, match="`speed` is a float"):
        kinematic_frequencies(ROWS["305"], 25.0)  # type: ignore
    with pytest.raises(TypeError, match="`bearing` is a str"):
        kinematic_frequencies("6205", bj.Speed(25.0))  # type: ignore


EIGHT = balls(8, 6.747, 28.5)


def force(part, order, bearing=EIGHT, speed=None):
    found = waviness_force(bearing, speed or bj.Speed(inner=25 * TURN), part, order)
    return np.array(found.axial), np.array(found.radial)


def test_odd_waves_on_a_ball_balance():
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
    bearing = ROWS["176211"]
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

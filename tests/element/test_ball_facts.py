"""Kinematics and mass of an orbiting ball, and the slope of its contact's law.

Numbers of whole bearings are validation cases (`han_chu_*`, `filipkovskii_*`).
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.contact import Ellipse
from bearingjax.element import ball_kinematics, ball_mass

SPEED = bj.Speed(209.4395)


def test_ball_mass_is_that_of_a_sphere():
    mass, moment = map(float, ball_mass(jnp.asarray(0.0127), jnp.asarray(7850.0)))
    assert mass == pytest.approx(7850.0 * np.pi / 6 * 0.0127**3, rel=ROUNDING)
    assert moment == pytest.approx(0.1 * mass * 0.0127**2, rel=ROUNDING)


def test_orbit_in_pure_rolling():
    """Half of 1 - γ cos α, where both contact angles are alike."""
    normal = jnp.asarray([np.sin(0.4), np.cos(0.4)])
    k = ball_kinematics(normal, normal, jnp.asarray(1.0), jnp.asarray(0.238339), SPEED)
    wanted = 0.5 * 209.4395 * (1.0 - 0.238339 * np.cos(0.4))
    assert float(k.orbit) == pytest.approx(wanted, rel=ROUNDING)


def test_stiffness_of_a_contact():
    """Slope of c δ^(3/2): 3/2 c^(2/3) Q^(1/3)."""
    one = jnp.asarray(1.0)
    contact = Ellipse(one, jnp.asarray(1e10), one, one)
    approach = contact.approach(jnp.asarray(100.0))
    rate = float(jax.grad(contact.load)(approach))
    assert rate == pytest.approx(1.5 * 1e10 ** (2 / 3) * 100.0 ** (1 / 3), rel=ROUNDING)


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
def test_no_slip_at_either_centre(share):
    """For any direction of the spin axis."""
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
    # None on the raceway that controls.
    spin = [y * co + (z + orbit) * so, y * ci + (z + orbit - inner_speed) * si]
    assert np.allclose(k.spin, spin, rtol=0, atol=1e-10)
    if share in (0.0, 1.0):
        assert abs(float(k.spin[0 if share == 1.0 else 1])) < 1e-10

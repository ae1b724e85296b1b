"""Half width of contacts against formulas of others, and what it leads to."""

import numpy as np
import pytest
from registry import balls

import bearingjax as bj
from bearingjax.acoustics import contact_half_width

YOUNG = 206e9 / (1.0 - 0.3**2)
"""E' of two bodies of steel, 2/((1-ν²)/E + (1-ν²)/E) [Pa]."""


def test_balls():
    """Brewe and Hamrock (1977): within their 5 % of Hertz."""
    bearing = balls(7)
    angle = float(bearing.free_cosine)
    radius, pitch = 0.5 * float(bearing.ball_diameter), float(bearing.pitch_diameter)
    groove = 2.0 * radius * float(bearing.outer_osculation)
    along = radius * (1.0 + 2.0 * radius * angle / pitch)
    across = 1.0 / (1.0 / radius - 1.0 / groove)
    ratio = 1.0339 * (across / along) ** 0.636
    integral = 1.0003 + 0.5968 * along / across
    mean = 1.0 / (1.0 / along + 1.0 / across)
    loads = np.array([[0.0, 30.0], [0.0, 50.0]])
    of_loads = (6.0 * integral * 40.0 * mean / (np.pi * ratio * YOUNG)) ** (1 / 3)
    assert contact_half_width(bearing, loads) == pytest.approx(of_loads, rel=0.05)


def test_rollers():
    """Johnson (1985), 4.43: a² = 4 P R/(π E*), on the outer raceway."""
    bearing = bj.CylindricalRollerBearing(9, 0.052, 0.0082, 0.0115)
    radius = 0.0041 * (1.0 + 0.0082 / 0.052)
    wanted = np.sqrt(4.0 * (500.0 / 0.0115) * radius / (np.pi * 0.5 * YOUNG))
    found = contact_half_width(bearing, np.full((9, 2), 500.0))
    assert found == pytest.approx(wanted, rel=1e-9)


def test_nothing_carries():
    assert contact_half_width(balls(7), np.zeros((7, 2))) == 0.0

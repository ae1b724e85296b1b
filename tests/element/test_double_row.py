"""Double-row angular contact ball bearings are pairs of their rows, back to back."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj

GROOVES = dict(outer_osculation=0.52, inner_osculation=0.53, contact_angle=0.5)
ROW = bj.design.DoubleRowBallRow(5, 0.0775, 0.014288, row_offset=0.008, **GROOVES)


def test_it_is_a_pair_of_angular_contact_balls_back_to_back():
    double = bj.BearingSet.double_row(ROW)
    single = bj.AngularContactBallBearing(5, 0.0775, 0.014288, **GROOVES)
    pair = bj.BearingSet.back_to_back(single, 0.016)
    turned = double.rows[1].bearing.first_azimuth
    assert turned == pytest.approx(np.pi / 5)
    pair = eqx.tree_at(lambda s: s.rows[1].bearing.first_azimuth, pair, turned)
    q = jnp.array([0, 0, 0, 0, 0, 0, 2e-5, -1e-5, 6e-6, 4e-4, -3e-4, 0])
    one, other = (np.asarray(bj.BearingElement(b).force(q)) for b in (double, pair))
    assert one == pytest.approx(other, rel=1e-9, abs=1e-9)
    assert np.abs(one[9:11]).min() > 1.0
    for of_double, of_pair in zip(double.rows, pair.rows, strict=True):
        finite: Any = (bj.element.Finite().ball(x) for x in (of_double, of_pair))
        assert len({float(ball.along) for ball in finite}) == 1


def test_it_is_rated_as_of_two_rows():
    """ISO 281, table 3, and ISO 76, table 2, at 30°."""
    bearing = bj.load_bearing("3208 A")
    for radial, axial, p, p0 in ((1e3, 2e3, 3110, 2320), (3e3, 1e3, 3780, 3660)):
        found = bj.life.equivalent_load(bearing, np.array([0, -radial, axial, 0, 0, 0]))
        assert found == pytest.approx((p, p0))

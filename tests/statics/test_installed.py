"""A bearing on its seats: its states, its speeds and its warnings."""

import equinox as eqx
import jax
import numpy as np
import pytest
from registry import balls

import bearingjax as bj
from bearingjax.fits import Limits, SizeLimits, fit_state, with_bearing_dimensions
from bearingjax.statics.service_warning import MOST_DRIFT

BEARING = bj.BearingElement(balls(7, bj.DeepGrooveBallBearing))
PITCH = float(BEARING.bearing.pitch_diameter)
BALL = float(BEARING.bearing.ball_diameter)
BORE, OUTSIDE = PITCH - 2 * BALL, PITCH + 2 * BALL
SEATS = bj.Mounting(BORE, OUTSIDE, 2 * OUTSIDE, 10e-6, 0.0)
WARM = bj.FitConditions(shaft=30.0, inner_ring=40.0, elements=40.0, outer_ring=30.0)
LIMITS = SizeLimits(
    Limits(-5e-6, 20e-6),
    Limits(2e-6, 11e-6),
    Limits(-10e-6, 0.0),
    Limits(0.0, 15e-6),
    Limits(-9e-6, 0.0),
)


def test_states_without_mounting():
    alone = bj.Installed(BEARING)
    assert alone.fit_states() is None and alone.set_preload() is None
    assert alone.with_speed(bj.Speed(100.0, 0.0)) is alone
    assert alone.warnings(bj.Speed(100.0)) == []
    assert alone.held_clearance_warnings(1.0, [1e4]) == []


def test_states_are_those_of_the_seats():
    whole = with_bearing_dimensions(SEATS, BEARING.bearing)
    states = bj.Installed(BEARING, None, SEATS, WARM).fit_states()
    assert states is not None and states.mounted_range is states.loosest is None
    assert states.free == float(bj.fits.radial_clearance(BEARING.bearing))
    for found, conditions in ((states.mounted, None), (states.operating, WARM)):
        leaves = jax.tree.leaves((found, fit_state(whole, conditions)))
        half = len(leaves) // 2
        np.testing.assert_allclose(leaves[:half], leaves[half:], rtol=1e-12, atol=1e-20)
    # What is solved has the clearance in operation.
    left = float(
        bj.Installed(BEARING, None, SEATS, WARM).element_at().bearing.clearance
    )
    assert float(states.operating.radial_clearance) == pytest.approx(left, rel=1e-12)


def test_ranges_end_at_extreme_sizes():
    states = bj.Installed(BEARING, None, SEATS, WARM, LIMITS).fit_states()
    assert states is not None and states.operating_range is not None
    ends = []
    for clearance, shaft, housing in ((-5e-6, 21e-6, 0.0), (20e-6, 2e-6, -24e-6)):
        sizes = dict(shaft_interference=shaft, housing_interference=housing)
        seats = bj.Mounting(
            BORE, OUTSIDE, 2 * OUTSIDE, **sizes, radial_clearance=clearance
        )
        one = bj.Installed(BEARING, None, seats, WARM).fit_states()
        assert one is not None
        ends.append(float(one.operating.radial_clearance))
    np.testing.assert_allclose(states.operating_range.worst, ends, rtol=1e-9)
    loosest = states.loosest
    assert loosest is not None
    assert float(loosest.radial_clearance) == pytest.approx(ends[1], rel=1e-9)


def test_warnings_of_seats_and_speed():
    loose = eqx.tree_at(lambda m: m.shaft_interference, SEATS, -4e-6)
    own = bj.Installed(BEARING, None, loose, limiting_speed=1000.0)
    assert own.warnings() == []
    slow, fast = own.warnings(bj.Speed(100.0)), own.warnings(bj.Speed(1500.0))
    assert len(slow) == 1 and "creeps and wears" in slow[0]
    assert len(fast) == 2 and "above the limiting speed" in fast[1]
    assert own.warnings(bj.Speed(100.0), load_fixed_to="inner")[0].startswith(
        "fit: the outer ring turns"
    )
    # Of sizes with limits, at the loosest: 2 µm of interference, less the warmth.
    cool = bj.FitConditions(inner_ring=20.0)
    (text,) = bj.Installed(BEARING, None, SEATS, cool, LIMITS).seat_warnings()
    slack = 2e-6 - BORE * 20.0 * float(SEATS.inner_ring.expansion)
    assert f"by {-1e6 * slack:.3g} µm, at the loosest sizes" in text
    assert bj.Installed(BEARING, None, SEATS, cool).seat_warnings() == []


def test_held_clearance_warnings_beyond_half_a_micron():
    own = bj.Installed(BEARING, None, SEATS)

    def left(speed):
        states = own.with_speed(bj.Speed(speed, 0.0)).fit_states()
        assert states is not None
        return float(states.operating.radial_clearance)

    # The growth is that of the square of the speed.
    slope = (left(1000.0) - left(0.0)) / 1000.0**2
    edge = (MOST_DRIFT / abs(slope)) ** 0.5
    assert own.held_clearance_warnings(0.0, [0.5 * edge, 0.99 * edge]) == []
    (text,) = own.held_clearance_warnings(0.0, [1.01 * edge, 0.5 * edge])
    assert f"at {1.01 * edge * 30 / np.pi:.5g} rpm its fits leave" in text
    assert f"at 0 rpm, {1e6 * left(0.0):.4g} µm" in text


def test_sizes_outside_their_limits_are_warned_of():
    tight = eqx.tree_at(lambda m: m.shaft_interference, SEATS, 25e-6)
    own = bj.Installed(BEARING, None, tight, None, LIMITS)
    (text,) = own.seat_warnings()
    assert "interference of the shaft is 25 µm, outside its limits, 2 to 21 µm" in text
    loose = eqx.tree_at(lambda m: m.housing_interference, SEATS, -25e-6)
    (text,) = bj.Installed(BEARING, None, loose, None, LIMITS).seat_warnings()
    assert "of the housing is -25 µm, outside its limits, -24 to 0 µm" in text
    narrow = LIMITS._replace(clearance=Limits(40e-6, 50e-6))
    (text,) = bj.Installed(BEARING, None, SEATS, None, narrow).seat_warnings()
    assert "clearance before mounting" in text and "40 to 50 µm" in text


def test_limits_without_mounting_refused():
    with pytest.raises(ValueError, match="`limits` are given and `mounting` is None"):
        bj.Installed(BEARING, limits=LIMITS)

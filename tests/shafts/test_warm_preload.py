"""Preload of two bearings on a shaft as fits, warmth and speed change it."""

from dataclasses import replace

import jax
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.design import Rib, Ribs
from bearingjax.fits import with_bearing_dimensions
from bearingjax.shafts import Seat, ShaftLine, ShaftSystem, solve_system
from bearingjax.shafts.equilibrium import without_bearings
from bearingjax.shafts.seats import axial_growth
from bearingjax.statics.preload import remaining_preload

BALLS = {
    "n_balls": 12,
    "pitch_diameter": 0.09,
    "ball_diameter": 0.0119,
    "outer_osculation": 0.53,
    "inner_osculation": 0.52,
}
ANGULAR = bj.AngularContactBallBearing(**BALLS, contact_angle=0.26)
DEEP = bj.DeepGrooveBallBearing(**BALLS, radial_internal_clearance=2e-5)
TAPER = bj.TaperedRollerBearing(
    14,
    0.09,
    0.012,
    0.015,
    roller_axis_angle=0.2,
    roller_half_angle=0.03,
    ribs=Ribs(inner_minus=Rib(0.3, 2e-3, 0.0)),
)
GAP, FORCE = 0.2, 250.0
# Rings of next to no width: between the rows of the set only shaft and housing grow.
LOOSE = bj.Mounting(0.07, 0.11, 0.18, -1e-4, -1e-4, ring_width=1e-12)
TIGHT = replace(LOOSE, shaft_interference=8e-6, housing_interference=2e-6)
COLD = bj.FitConditions()
WARM = {
    "cold": COLD,
    "balls": bj.FitConditions(elements=6.0),
    "rings": bj.FitConditions(inner_ring=15.0, elements=15.0),
    "all": bj.FitConditions(303.0, 306.0, 304.0, 297.0, 294.0, reference=293.0),
}


def pair(bearing, seats, conditions, *, facing=False, **more):
    """Two bearings in O arrangement, or `facing` each other, on a rigid shaft."""
    line = ShaftLine("s", [0.4], [0.07], rigid=True)
    inside = bj.Installed(bj.BearingElement(bearing), None, seats, conditions)
    placed = [
        Seat(name, "s", place, inside, turned=turned, **more)
        for name, place, turned in (("A", 0.1, facing), ("B", 0.1 + GAP, not facing))
    ]
    return ShaftSystem(line, placed)


def kept(system):
    """Axial force with which the bearings of a pair press each other."""
    first, second = np.asarray(solve_system(system).load)[:, 2]
    np.testing.assert_allclose(second, -first, rtol=SOLVER)
    return -first if system.seats[0].turned else first


def kept_by_set(bearing, seats, conditions, facing):
    """Preload in operation of the same rows as a set, ground so that it has `FORCE` as
    mounted in the cold."""
    arrange = bj.BearingSet.face_to_face if facing else bj.BearingSet.back_to_back
    drawn = bj.BearingElement(arrange(bearing, GAP))
    mounted = bj.Installed(drawn, None, seats).element_at()
    pressed = bj.preload(mounted, FORCE)
    ground = [
        replace(row, inner_offset=after.inner_offset - before.inner_offset)
        for row, after, before in zip(
            drawn.bearing.rows, pressed.bearing.rows, mounted.bearing.rows, strict=True
        )
    ]
    drawn = replace(drawn, bearing=bj.BearingSet(tuple(ground)))
    warm = bj.Installed(drawn, None, seats, conditions).element_at()
    return float(remaining_preload(warm))


@pytest.mark.slow
@pytest.mark.parametrize(
    "bearing, facing",
    [(ANGULAR, False), (ANGULAR, True), (TAPER, True)],
    ids=["balls in O", "balls in X", "tapers in X"],
)
def test_warm_pair_presses_as_a_set(bearing, facing):
    """On a rigid, weightless shaft, adjusted in the cold on tight seats; more where
    rings and elements are warmer on a shaft that is not."""
    found = {}
    for name, warm in WARM.items():
        found[name] = kept(pair(bearing, TIGHT, warm, facing=facing, preload=FORCE))
        wanted = kept_by_set(bearing, TIGHT, warm, facing)
        np.testing.assert_allclose(found[name], wanted, rtol=SOLVER, err_msg=name)
    np.testing.assert_allclose(found["cold"], FORCE, rtol=SOLVER)
    assert found["rings"] > found["balls"] > 1.2 * FORCE
    # Rings of a width grow between the rows themselves, on loose seats by warmth alone.
    wide, warm = replace(LOOSE, ring_width=0.02), WARM["rings"]
    wanted = kept_by_set(bearing, wide, warm, facing)
    found = kept(pair(bearing, wide, warm, facing=facing, preload=FORCE))
    np.testing.assert_allclose(found, wanted, rtol=SOLVER)


def touching(bearing, seats, conditions):
    """Axial distance of the groove centres where balls, as large as they are, touch,
    by plane geometry [m]."""
    own = with_bearing_dimensions(seats, bearing)
    state = bj.fits.fit_state(own, conditions)
    apart = (0.53 + 0.52 - 1.0) * 0.0119
    grown = float(state.element_strain) * 0.0119
    lost = 2 * apart * (1 - np.cos(0.26)) - float(state.radial_clearance)
    radial = apart * np.cos(0.26) + 0.5 * lost
    angle = np.arccos(radial / apart)
    return np.sqrt(apart**2 - radial**2) - grown * np.sin(angle)


@pytest.mark.parametrize("seats", [LOOSE, TIGHT], ids=["loose", "tight"])
def test_axial_growth_counts_from_where_balls_touch(seats):
    """What touches sooner is as a ring that has moved, in the sense of its bearing; it
    counts from the mounted bearing, and the speed takes part."""
    warm, speed = replace(WARM["balls"], inner_ring=5.0), 1200.0
    turning = replace(warm, speed=speed)
    nearer = touching(ANGULAR, seats, COLD) - touching(ANGULAR, seats, turning)
    assert nearer > 5e-6

    def growth(*given):
        bare = without_bearings(pair(*given))
        return jax.jit(axial_growth)(bare, np.full(2, speed))

    found = growth(ANGULAR, seats, warm)
    np.testing.assert_allclose(found, [nearer, -nearer], rtol=1e-9)
    thin = replace(seats, ring_width=None)
    assert np.abs(growth(DEEP, thin, warm)).max() == 0.0
    bare = without_bearings(pair(ANGULAR, seats, COLD))
    still = np.abs(axial_growth(bare, np.zeros(2))).max()
    assert still < ROUNDING * nearer


def test_sizes_of_bearings_in_a_bare_system():
    """Bearings that differ in their number of balls share the program of a machine."""
    some, more = (
        jax.tree.structure(without_bearings(pair(replace(ANGULAR, **own), LOOSE, COLD)))
        for own in ({}, {"n_balls": 14, "ball_deviation": np.zeros(14)})
    )
    assert some == more
    unseated = pair(ANGULAR, None, None)
    for system in (unseated, pair(DEEP, LOOSE, COLD)):
        for seat in without_bearings(system).seats:
            assert seat.installed.drawing is None

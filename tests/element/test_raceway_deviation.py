"""What each rolling element meets on its raceways, against what that amounts to."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, taper
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.design import with_raceways
from bearingjax.element.azimuth import azimuths

AXIAL, OUTWARDS, RAISED = range(3)
OUTER, INNER = range(2)

BALLS = balls(7, bj.DeepGrooveBallBearing, radial_internal_clearance=10e-6)
TAPER = taper(5)
# Neither lever nor profile of these sees the diameter.
ROLLERS = bj.CylindricalRollerBearing(6, 0.065, 0.010, 0.010)
ARCS = dict(roller_profile_radius=0.0745, inner_raceway_radius=0.0767)
BARRELS = bj.SphericalRollerRow(5, 0.13, 0.0215, 0.0185, contact_angle=0.17, **ARCS)
Q = jnp.array([1e-6, 2e-6, 0, 1e-5, 0, 0, 22e-6, -5e-6, 18e-6, 0, 2e-5, 0])


def deviating(bearing, of_element):
    return dataclasses.replace(bearing, raceway_deviation=of_element)


def none_of(bearing):
    return np.zeros((azimuths(bearing).shape[0], 2, 3))


@pytest.mark.parametrize(
    "element",
    [
        bj.BearingElement(BALLS),
        bj.BearingElement(BALLS, kinematics=bj.element.Finite()),
        bj.BearingElement(TAPER, quadrature=bj.numerics.Midpoint(20)),
        bj.BearingElement(BARRELS),
    ],
    ids=["balls", "balls, finite", "rollers", "barrels, finite"],
)
@pytest.mark.slow
def test_raceway_waviness_of_order_one_equals_ring_shift(element):
    bearing = element.bearing
    at = np.asarray(azimuths(bearing))
    x, y, z = 4e-6, -2e-6, 3e-6
    if element.kinematics.turns_far:
        # Such rings notice that in most sections they have moved sideways as well.
        x = y = 0.0
    deviation = none_of(bearing)
    deviation[:, INNER, OUTWARDS] = x * np.cos(at)
    deviation[:, OUTER, OUTWARDS] = -y * np.sin(at)
    deviation[:, INNER, AXIAL] = z
    wavy = dataclasses.replace(element, bearing=deviating(bearing, deviation))
    moved = Q.at[jnp.array([6, 1, 8])].add(jnp.array([x, -y, z]))
    expected = element.force(moved)
    size = np.max(np.abs(expected))
    assert size > 10.0
    np.testing.assert_allclose(wavy.force(Q), expected, rtol=0, atol=SOLVER * size)


@pytest.mark.parametrize("bearing", [BALLS, ROLLERS], ids=["balls", "rollers"])
def test_raised_on_both_raceways_is_a_larger_element(bearing):
    """With constants that do not see the diameter."""
    larger = np.linspace(-1e-6, 2e-6, len(none_of(bearing)))
    deviation, of_balls = none_of(bearing), bearing is BALLS
    deviation[:, :, RAISED] = 0.5 * larger[:, None]
    choice = (
        {"point_law": bj.contact.PointConstant(9e9, 8e9)}
        if of_balls
        else {"quadrature": bj.numerics.Midpoint(20)}
    )
    name = "ball_deviation" if of_balls else "roller_deviation"
    by_size = dataclasses.replace(bearing, **{name: larger})
    forces = [
        bj.BearingElement(b, **choice).force(Q)
        for b in (by_size, deviating(bearing, deviation))
    ]
    size = np.max(np.abs(forces[0]))
    np.testing.assert_allclose(*forces, rtol=0, atol=ROUNDING * size)
    plain = bj.BearingElement(bearing, **choice).force(Q)
    assert np.max(np.abs(forces[0] - plain)) > 1e-3 * size


@pytest.mark.parametrize("exact", [False, True])
@pytest.mark.slow
def test_raised_raceways_of_barrels_leave_less_clearance(exact):
    kinematics = bj.element.Finite() if exact else bj.element.Linearised()
    bearing = bj.ToroidalRollerBearing(
        *(7, 0.140, 0.0195, 0.030),
        roller_profile_radius=0.4074,
        outer_raceway_radius=0.42,
        inner_raceway_radius=0.42,
        radial_internal_clearance=10e-6,
    )
    deviation = none_of(bearing)
    deviation[:, :, RAISED] = 1.5e-6
    tighter = dataclasses.replace(bearing, radial_internal_clearance=4e-6)
    forces = [
        np.asarray(bj.BearingElement(b, kinematics=kinematics).force(Q))
        for b in (tighter, deviating(bearing, deviation), bearing)
    ]
    size = np.max(np.abs(forces[0]))
    np.testing.assert_allclose(*forces[:2], rtol=0, atol=SOLVER * size)
    assert np.max(np.abs(forces[0] - forces[2])) > 1e-2 * size


BY_EACH = {"balls": BALLS, "rollers": TAPER, "barrels": BARRELS}


@pytest.mark.parametrize("bearing", BY_EACH.values(), ids=BY_EACH)
@pytest.mark.slow
def test_derivative_by_each_deviation(bearing):
    choice = {} if bearing is BALLS else {"quadrature": bj.numerics.Midpoint(20)}
    rng = np.random.default_rng(3)
    start = 1e-6 * rng.normal(size=none_of(bearing).shape)
    way = rng.normal(size=start.shape)

    @jax.jit
    def force(deviation):
        of_these = with_raceways(bearing, deviation)
        return bj.BearingElement(of_these, **choice).force(Q)

    slope = jax.jvp(force, (jnp.asarray(start),), (jnp.asarray(way),))[1]
    h = 1e-10
    difference = (force(start + h * way) - force(start - h * way)) / (2 * h)
    np.testing.assert_allclose(
        slope, difference, rtol=0, atol=DIFFERENCE * np.max(np.abs(slope))
    )


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        (np.zeros((7, 2)), ValueError, r"shape \(7, 2\); it must be \(7, 2, 3\)"),
        (np.full((7, 2, 3), np.nan), ValueError, "finite"),
        (np.full((7, 2, 3), 1e-3), ValueError, "below 0.00019 m in size"),
        ("5 um", TypeError, "numbers in m"),
    ],
)
def test_wrong_deviations(given, error, words):
    with pytest.raises(error, match=words):
        deviating(BALLS, given)

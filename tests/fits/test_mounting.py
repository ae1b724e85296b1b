"""Mounted bearings against plane geometry, and against raceways that are moved."""

from dataclasses import replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from slopes import with_slopes
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.design import Material, Rib, Ribs
from bearingjax.fits import (
    Limits,
    WarmMaterial,
    clearance_range,
    fit_state,
    mounting_at,
    radial_clearance,
    with_bearing_dimensions,
    with_radial_clearance,
)
from bearingjax.fits.mounting import raceway_diameters, row_shifts

MICRON = 1e-6
BALLS = {
    "n_balls": 7,
    "pitch_diameter": 0.0385,
    "ball_diameter": 0.00794,
    "outer_osculation": 0.53,
    "inner_osculation": 0.52,
}
DEEP = bj.DeepGrooveBallBearing(**BALLS, radial_internal_clearance=12.5 * MICRON)
ANGULAR = bj.AngularContactBallBearing(**BALLS, contact_angle=0.4)
FOUR = bj.FourPointBallBearing(
    **BALLS, shim_angle=0.35, radial_internal_clearance=10 * MICRON
)
RIB = Rib(0.3, 1.5e-3, 0.0)
TAPER = bj.TaperedRollerBearing(
    7,
    0.0385,
    0.007,
    0.009,
    roller_axis_angle=0.2,
    roller_half_angle=0.0361,
    radial_internal_clearance=20 * MICRON,
    ribs=Ribs(inner_minus=RIB),
)
CYLINDER = bj.CylindricalRollerBearing(
    7, 0.0385, 0.007, 0.009, radial_internal_clearance=20 * MICRON
)
A = (0.53 + 0.52 - 1) * 0.00794  # distance of the groove centres
SEATS = bj.Mounting(
    bore=0.025,
    outside_diameter=0.052,
    housing_diameter=0.080,
    shaft_interference=10 * MICRON,
    housing_interference=-10 * MICRON,
    ring_width=0.015,
)
WARM = bj.FitConditions(40.0, 38.0, 35.0, 25.0, 20.0, 800.0)


def near(value):
    return pytest.approx(value, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(
    "bearing, inner, outer",
    [
        (DEEP, 0.03056, 0.04644),
        (ANGULAR, 0.0385 - 0.00794 * np.cos(0.4), 0.0385 + 0.00794 * np.cos(0.4)),
        (CYLINDER, 0.0315, 0.0455),
        (TAPER, 0.0385 - 0.007 * np.cos(0.1639), 0.0385 + 0.007 * np.cos(0.2361)),
    ],
    ids=["deep groove", "angular contact", "cylinders", "tapers"],
)
def test_raceways(bearing, inner, outer):
    found = [float(x) for x in raceway_diameters(bearing)]
    assert found == near([inner, outer])


@pytest.mark.parametrize("bearing", [DEEP, FOUR, CYLINDER, TAPER])
def test_mounted_clearance_matches_fit_state(bearing):
    state = fit_state(with_bearing_dimensions(SEATS, bearing), WARM)
    found = bj.fits.mount(bearing, SEATS, WARM)
    assert type(found) is type(bearing)
    assert float(radial_clearance(found)) == near(float(state.radial_clearance))
    assert float(state.radial_clearance) < 0.3 * float(radial_clearance(bearing))
    tilt = np.cos(0.2361) if bearing is TAPER else 1.0
    own = float(found.radial_internal_clearance)
    assert own == near(float(state.radial_clearance) * tilt)


def test_mounted_deep_groove_bearing_given_by_contact_angle():
    angle = np.arccos(1 - 12.5 * MICRON / (2 * A))
    by_angle = bj.DeepGrooveBallBearing(**BALLS, contact_angle=angle)
    found = bj.fits.mount(by_angle, SEATS).radial_internal_clearance
    wanted = bj.fits.mount(DEEP, SEATS).radial_internal_clearance
    assert float(found) == pytest.approx(float(wanted), rel=1e-7)


def groove_centres(loss):
    """Contact angle and axial distance of groove centres nearer by half a loss."""
    radial = A * np.cos(0.4) + 0.5 * loss
    axial = np.sqrt(A**2 - radial**2)
    return np.arctan2(axial, radial), axial


def test_angular_contact_meets_at_a_smaller_angle():
    free = float(radial_clearance(ANGULAR))
    assert free == near(2 * A * (1 - np.cos(0.4)))
    found = bj.fits.mount(ANGULAR, SEATS, WARM)
    left = float(
        fit_state(with_bearing_dimensions(SEATS, ANGULAR), WARM).radial_clearance
    )
    angle, axial = groove_centres(free - left)
    assert float(found.contact_angle) == near(angle)
    pair = bj.BearingSet.back_to_back(ANGULAR, 0.02, 4 * MICRON)
    rows = bj.fits.mount(pair, SEATS, WARM).rows
    assert [float(r.bearing.contact_angle) for r in rows] == near(2 * [angle])
    # What the groove centres come nearer along the axis presses both rows, and how much
    # longer warm balls are; what grows between them moves the row at +z along +z.
    lower, upper = (float(x) for x in row_shifts(pair, SEATS, WARM))
    assert upper == near(-lower)
    longer = 0.00794 * 12e-6 * (35.0 - 0.5 * (38.0 + 25.0)) * np.sin(angle)
    pressed = 2 * MICRON + A * np.sin(0.4) - axial + longer + lower
    assert [float(r.inner_offset) for r in rows] == pytest.approx(
        [pressed, -pressed], rel=1e-7
    )


ALUMINIUM = WarmMaterial(Material(70e9, 0.33, 2700.0), 23e-6)


def test_row_shifts_of_spaced_rows():
    """Middles 0.1 m apart: rings on 15 mm of it, on the rest shaft and housing."""
    pair = bj.BearingSet.back_to_back(ANGULAR, 0.1)
    seats = replace(SEATS, shaft_interference=-1 * MICRON, housing=ALUMINIUM)
    warm = bj.FitConditions(shaft=40.0, inner_ring=30.0, outer_ring=20.0, housing=10.0)
    loose = float(
        fit_state(with_bearing_dimensions(seats, ANGULAR), warm).shaft_interference
    )
    seats = replace(seats, shaft_interference=-1 * MICRON - loose)
    inner = 12e-6 * (30.0 * 0.015 + 40.0 * 0.085)
    outer = 12e-6 * 20.0 * 0.015 + 23e-6 * 10.0 * 0.085
    shifts = [float(x) for x in row_shifts(pair, seats, warm)]
    assert shifts == near([-0.5 * (inner - outer), 0.5 * (inner - outer)])
    # Rows that touch have only rings between them, in any order of the rows.
    near_by = bj.BearingSet.tandem(ANGULAR, 0.015, 3)
    turned = bj.BearingSet(near_by.rows[::-1])
    step = 12e-6 * (30.0 - 20.0) * 0.015
    assert [float(x) for x in row_shifts(near_by, seats, warm)] == pytest.approx(
        [-step, 0.0, step], rel=1e-9, abs=1e-18
    )
    assert [float(x) for x in row_shifts(turned, seats, warm)] == pytest.approx(
        [step, 0.0, -step], rel=1e-9, abs=1e-18
    )


def test_a_tight_ring_is_shorter():
    """Poisson's contraction: ν/E (σr + σθ), at the bore p (k - 1), k of thick rings."""
    state = fit_state(with_bearing_dimensions(SEATS, DEEP))
    d, f = 0.025, 0.03056
    hoop, radial = float(state.ring_stress), -float(state.shaft_pressure)
    shorter = 0.3 / 206e9 * (hoop + radial)
    assert float(state.strains.inner_ring) == near(-shorter)
    assert hoop / -radial == near((f**2 + d**2) / (f**2 - d**2))
    assert float(state.strains.outer_ring) == 0.0  # loose
    tight = fit_state(
        with_bearing_dimensions(replace(SEATS, housing_interference=10 * MICRON), DEEP)
    )
    assert float(tight.strains.outer_ring) > 0.0


def test_a_turning_ring_is_shorter():
    """The stresses of a rotating ring (Timoshenko & Goodier), integrated over it."""
    speed, a, b, nu = 3000.0, 0.0125, 0.01528, 0.3
    still = replace(SEATS, shaft_interference=-100 * MICRON)
    found = fit_state(
        with_bearing_dimensions(still, DEEP), bj.FitConditions(speed=speed)
    ).strains
    x, weight = np.polynomial.legendre.leggauss(20)
    r = 0.5 * (a + b) + 0.5 * (b - a) * x
    k = 7850.0 * speed**2 * (3 + nu) / 8
    radial = k * (a**2 + b**2 - (a * b / r) ** 2 - r**2)
    hoop = k * (a**2 + b**2 + (a * b / r) ** 2 - (1 + 3 * nu) / (3 + nu) * r**2)
    total = 0.5 * (b - a) * np.sum(weight * (radial + hoop) * 2 * np.pi * r)
    mean = total / (np.pi * (b**2 - a**2))
    assert float(found.inner_ring) == near(-nu / 206e9 * mean)


def test_row_shifts_vanish_at_uniform_temperature():
    pair = bj.BearingSet.face_to_face(ANGULAR, 0.1)
    warm = bj.FitConditions(*5 * [60.0])
    alike = replace(SEATS, shaft_interference=0.0)
    assert [float(x) for x in row_shifts(pair, alike, warm)] == pytest.approx(
        [0.0, 0.0], abs=1e-15
    )


def test_ratings_keep_the_angle_of_the_drawing():
    """A fit is no other bearing: it has the published C, and X and Y of its angle."""
    for bearing in (ANGULAR, FOUR):
        drawn = float(bearing.free_contact_angle)
        once = bj.fits.mount(bearing, SEATS, WARM)
        again = bj.fits.mount(once, replace(SEATS, shaft_interference=2 * MICRON))
        for found in (once, again):
            assert float(found.free_contact_angle) < drawn - 0.01
            assert float(found.nominal_contact_angle) == near(drawn)
    with pytest.raises(ValueError, match="`rated_contact_angle` is 2 rad; it must"):
        replace(ANGULAR, rated_contact_angle=2.0)


def force(element, bearing, q):
    return eqx.tree_at(lambda e: e.bearing, element, bearing).force(q)[8]


axial_force = eqx.filter_jit(force)


def pushed(z):
    return np.eye(12)[8] * z


def test_angular_contact_clearance_matches_raceway_deviation():
    # The inner groove is farther from the axis by 3 µm, the load 60 µm.
    growth, z = 6 * MICRON, 60 * MICRON
    deviation = np.zeros((7, 2, 3))
    deviation[:, 1, 1] = 0.5 * growth
    flat = replace(ANGULAR, raceway_deviation=np.zeros((7, 2, 3)))
    grown = replace(ANGULAR, raceway_deviation=deviation)
    element = bj.BearingElement(flat)
    moved = axial_force(element, grown, pushed(z))
    free = radial_clearance(flat)
    narrow = with_radial_clearance(flat, free - growth)
    nearer = A * (np.sin(0.4) - np.sin(float(narrow.contact_angle)))
    found = axial_force(element, narrow, pushed(z + nearer))
    # The constants of the contacts are those of the free angles, 0.400 and 0.384.
    np.testing.assert_allclose(found, moved, rtol=2e-3)
    without = axial_force(element, flat, pushed(z))
    assert moved > 1.05 * without


def test_warm_balls_press_along_the_contacts():
    """Against balls that are really larger, between the same grooves."""
    loose = replace(SEATS, shaft_interference=-1e-4)
    warm = bj.FitConditions(elements=10.0)
    size, z = 0.00794 * (1 + 120e-6), 30 * MICRON
    outer, inner = (x * 0.00794 / size for x in (0.53, 0.52))
    apart = (outer + inner - 1) * size
    angle = np.arccos(A * np.cos(0.4) / apart)
    grown = replace(
        ANGULAR,
        ball_diameter=size,
        outer_osculation=outer,
        inner_osculation=inner,
        contact_angle=angle,
    )
    nearer = A * np.sin(0.4) - apart * np.sin(angle)
    flat = replace(ANGULAR, raceway_deviation=np.zeros((7, 2, 3)))
    element = bj.BearingElement(flat)
    row = bj.fits.mount(bj.BearingSet.back_to_back(flat, 0.02), loose, warm).rows[0]
    cold = axial_force(element, flat, pushed(z))
    grown = replace(grown, raceway_deviation=np.zeros((7, 2, 3)))
    wanted = axial_force(element, grown, pushed(z + nearer))
    found = axial_force(element, row.bearing, pushed(z + row.inner_offset))
    assert wanted > 1.05 * cold
    # The nearer grooves are stiffer, which is not counted: some 0.1 % of the force.
    assert float(found - cold) == pytest.approx(float(wanted - cold), rel=0.03)


@pytest.mark.parametrize(
    "bearing, angle", [(FOUR, float(FOUR.free_contact_angle)), (TAPER, 0.2361)]
)
def test_warm_elements_take_clearance_along_the_contacts(bearing, angle):
    """Two of them, each D ε along the normal: 2 D ε/cos of the radial clearance."""
    loose = replace(SEATS, shaft_interference=-1e-4)
    cold, warm = (
        fit_state(
            with_bearing_dimensions(loose, bearing), bj.FitConditions(elements=rise)
        )
        for rise in (0.0, 10.0)
    )
    size = getattr(bearing, "ball_diameter", getattr(bearing, "roller_diameter", 0.0))
    loss = float(cold.radial_clearance - warm.radial_clearance)
    assert loss == pytest.approx(2 * float(size) * 120e-6 / np.cos(angle), rel=0.01)


def test_tapered_clearance_matches_raceway_deviation():
    growth, z = 12 * MICRON, 120 * MICRON
    deviation = np.zeros((7, 2, 3))
    deviation[:, 0, 1] = -0.5 * growth
    flat = replace(TAPER, raceway_deviation=np.zeros((7, 2, 3)))
    narrowed = replace(TAPER, raceway_deviation=deviation)
    element = bj.BearingElement(flat, quadrature=bj.numerics.Midpoint(4))
    moved = axial_force(element, narrowed, pushed(z))
    narrow = with_radial_clearance(flat, radial_clearance(flat) - growth)
    found = axial_force(element, narrow, pushed(z))
    np.testing.assert_allclose(found, moved, rtol=1e-3)
    assert moved > 1.2 * axial_force(element, flat, pushed(z))


def test_slopes_by_interference_and_temperature():
    def angle(x):
        seats = replace(SEATS, shaft_interference=x[0])
        conditions = replace(WARM, inner_ring=x[1], elements=x[2], speed=x[3])
        return bj.fits.mount(ANGULAR, seats, conditions).contact_angle

    check_slopes(angle, sign=-1)  # all of them take clearance


def test_row_shifts_gradients():
    pair = bj.BearingSet.back_to_back(ANGULAR, 0.02)

    def shift(x):
        seats = replace(SEATS, shaft_interference=x[0])
        conditions = replace(WARM, inner_ring=x[1], shaft=x[2], speed=x[3])
        return 1e6 * row_shifts(pair, seats, conditions)[1]

    check_slopes(shift)


def check_slopes(function, sign=0):
    one = with_slopes(function)
    x = np.array([10 * MICRON, 38.0, 35.0, 800.0])
    slopes = np.array(one(jnp.array(x))[0])
    assert not sign or (sign * slopes > 0).all()
    for i, step in enumerate(1e-3 * x):
        shift = step * np.eye(4)[i]
        ends = [float(one(jnp.array(x + s * shift))[1]) for s in (1, -1)]
        difference = (ends[0] - ends[1]) / (2 * step)
        np.testing.assert_allclose(slopes[i], difference, rtol=DIFFERENCE)


def sizes(shaft=20):
    return {
        "clearance": Limits(5 * MICRON, 20 * MICRON),
        "shaft": Limits(shaft * MICRON, (shaft + 10) * MICRON),
        "bore": Limits(-10 * MICRON, 0.0),
        "housing": Limits(-60 * MICRON, -30 * MICRON),
        "outside_diameter": Limits(-13 * MICRON, 0.0),
    }


def test_places_in_the_tolerances():
    base, warm = jax.device_get((with_bearing_dimensions(SEATS, DEEP), WARM))
    found = clearance_range(base, **sizes(), conditions=warm)
    wanted = {
        "middle": found.middle,
        "tightest": found.worst.lower,
        "loosest": found.worst.upper,
        "probable_tightest": found.probable.lower,
        "probable_loosest": found.probable.upper,
    }
    for place, clearance in wanted.items():
        there = mounting_at(base, place, **sizes(), conditions=warm)
        # Both fits stay tight: the clearance is linear in all sizes.
        left = fit_state(there, warm).radial_clearance
        np.testing.assert_allclose(left, clearance, rtol=1e-9)
    exact = dict.fromkeys(sizes(), Limits(0.0, 0.0))
    there = mounting_at(base, "probable_loosest", **exact)
    assert there.shaft_interference == 0 and there.radial_clearance == 0


def test_stress_of_the_inner_ring():
    base = jax.device_get(with_bearing_dimensions(SEATS, DEEP))
    found = fit_state(base, jax.device_get(bj.FitConditions()))
    d, f = 0.025, 0.03056
    # With a shaft of the ring's steel: E I/d (1 + (d/F)²)/2
    stress = 206e9 * 10e-6 / d * (1 + (d / f) ** 2) / 2
    np.testing.assert_allclose(found.ring_stress, stress, rtol=1e-9)


def test_fit_state_growth_of_rotating_outer_ring():
    loose = jax.device_get(
        replace(with_bearing_dimensions(SEATS, DEEP), housing_interference=-1e-4)
    )
    still, fast = (
        fit_state(loose, jax.device_get(bj.FitConditions(outer_speed=speed)))
        for speed in (0.0, 3000.0)
    )
    # Thin rings of the radii of raceway and seat: ρ ω² r³/E, of the diameter twice.
    ends = [2 * 7850 * 3000**2 * r**3 / 206e9 for r in (0.02322, 0.026)]
    assert ends[0] < fast.outer_raceway_growth < ends[1]
    # A housing without pressure, thicker and larger, grows more than the ring.
    assert fast.housing_interference < still.housing_interference
    grown = fast.radial_clearance - still.radial_clearance
    np.testing.assert_allclose(grown, fast.outer_raceway_growth, rtol=1e-9)


def test_mounted_rejects_invalid_arguments():
    thrust = bj.ThrustBallBearing(**BALLS)
    with pytest.raises(TypeError, match="`bearing` is a ThrustBallBearing"):
        bj.fits.mount(thrust, SEATS)
    tight = replace(SEATS, shaft_interference=100 * MICRON)
    with pytest.raises(ValueError, match="`clearance` is -.*above 0.*contact angle"):
        bj.fits.mount(ANGULAR, tight)
    assert float(bj.fits.mount(DEEP, tight).radial_internal_clearance) < -50 * MICRON
    with pytest.raises(ValueError, match="`inner_raceway` is None; give it, or"):
        fit_state(SEATS)
    with pytest.raises(ValueError, match="`inner_raceway` is 0.03056 m.*above `bore`"):
        bj.fits.mount(DEEP, replace(SEATS, bore=0.031))
    with pytest.raises(ValueError, match="`shaft_interference`.*1 % of `bore`"):
        replace(SEATS, shaft_interference=0.01)
    pair = bj.BearingSet.back_to_back(ANGULAR, 0.02)
    with pytest.raises(ValueError, match="`ring_width` is None; a set needs it"):
        bj.fits.mount(pair, replace(SEATS, ring_width=None))
    with pytest.raises(ValueError, match="`ring_width` is 15 m; it must be above 0"):
        replace(SEATS, ring_width=15.0)
    with pytest.raises(ValueError, match="`place` is 'middel'; it must be one of mid"):
        mounting_at(SEATS, "middel", **sizes())

"""Rating life: plain NumPy, limits of the standards, derivatives.

Published lives and factors are validation cases.
"""

from types import SimpleNamespace
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import grooves
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.life import (
    CLEANLINESS,
    Cleanliness,
    life_factor,
)
from bearingjax.life.equivalent_load import (
    _ANGLES,
    _FLAT,
    _STEEP,
    _X,
    _X2,
    _Y0,
    _Y0_DOUBLE,
    equivalent_load,
    left_out,
    load_factors,
)
from bearingjax.life.life import (
    FRAMES,
    LIFE_OUTPUTS,
    _modified_damage,
    _rows,
    life_outputs,
    turns_against_load,
)
from bearingjax.life.life_warning import ALL, LIFE_KINDS, life_sizes, life_warnings
from bearingjax.life.reference_life import (
    BALLS,
    edge_stress,
    row_fatigue,
)
from bearingjax.life.refined_life import (
    _of_laminae,
    _peaks_at_an_end,
    refined_lamina_loads,
)
from bearingjax.life.required_life import NEEDED, judge_life
from bearingjax.numerics.warning import warnings_of_cases
from bearingjax.optimise.design_problem import Problem

LAMINAE = 30
SPEED = bj.Speed(inner=150.0)


def ball_element(x):
    """6305 with the clearance x[0]."""
    bearing = bj.DeepGrooveBallBearing(
        7,
        43.5e-3,
        11.5e-3,
        radial_internal_clearance=x[0],
        material=bj.Material(210e9, 0.3),
        **grooves(0.53, 0.52),
    )
    return bj.BearingElement(bearing, point_law=bj.contact.ZeroAngle())


def ball_life(x):
    """Of clearance [m], Fr, Fa [N] and tilt [rad]."""
    element, zero = ball_element(x), jnp.zeros(())
    load = jnp.stack([x[1], zero, x[2], zero, zero, zero])
    solution = bj.solve_load(
        element,
        load,
        support=bj.Support(prescribed={"gx": zero, "gy": x[3]}),
        throw=False,
    )
    return solution, bj.rating_life(
        element,
        solution,
        conditions=bj.LifeConditions(
            dynamic_capacity=23400.0, viscosity=12e-6, contamination="grease, normal"
        ),
        speed=SPEED,
    )


def roller_element(x):
    """NU 215 of clearance x[0] and coefficient of the profile x[4]."""
    bearing = bj.CylindricalRollerBearing(
        18,
        0.103535,
        0.015,
        0.017,
        radial_internal_clearance=x[0],
        roller_profile=bj.Logarithmic(x[4]),
    )
    quadrature = bj.numerics.Midpoint(LAMINAE)
    return bj.BearingElement(bearing, bj.contact.ISO16281(), quadrature=quadrature)


def roller_life(x):
    """Of clearance [m], Fr [N], not used, tilt [rad] and profile [1]; both stresses."""
    element, zero = roller_element(x), jnp.zeros(())
    solution = bj.solve_load(
        element,
        jnp.stack([x[1], zero, zero, zero, zero, zero]),
        support=bj.Support(prescribed={"gx": zero, "gy": x[3]}),
        options=bj.statics.SolveOptions(points=2 * LAMINAE + 1),
        throw=False,
    )

    def life(**conditions):
        given = bj.LifeConditions(125e3, **conditions)
        return bj.rating_life(element, solution, given, speed=SPEED)

    oiled = life(viscosity=20e-6, contamination=0.5, reliability=0.95)
    return solution, oiled, life(edge_stress=False)


def slopes_of(life):
    """Values and slopes of everything smooth, by one program."""

    def numbers(x):
        everything = life(x)
        found = everything[1]
        lives = (
            found.basic_rating_life,
            found.reference_rating_life,
            found.modified_rating_life,
            found.life_hours,
        )
        smooth = {"log": jnp.log(jnp.stack(lives)), "damage": found.damage}
        return smooth, smooth | {"of": everything}

    return jax.jit(jax.jacfwd(numbers, has_aux=True))


@jax.jit
def ball_numbers(x):
    solution, life = ball_life(x)
    return None, {"of": (solution, life)}


@pytest.fixture(scope="module")
def balls():
    return ball_numbers


@pytest.fixture(scope="module")
def rollers():
    return slopes_of(roller_life)


def plain_balls(loads, capacity, angle, bearing, turning="inner"):
    """L10r in NumPy, loads (ball, outer and inner raceway), as the standard has it."""
    z, d, dm = loads.shape[0], float(bearing.ball_diameter), bearing.pitch_diameter
    re, ri = (
        float(f) * d for f in (bearing.outer_osculation, bearing.inner_osculation)
    )
    g = d * np.cos(angle) / float(dm)
    inside = ((1 - g) / (1 + g)) ** 1.72
    inside *= (ri / re * (2 * re - d) / (2 * ri - d)) ** 0.41
    q = capacity / (z * np.cos(angle))
    qi = q / 0.407 * (1 + (1.044 * inside) ** (10 / 3)) ** 0.3
    qe = q / 0.389 * (1 + (1.044 * inside) ** (-10 / 3)) ** 0.3
    inner, outer = (3, 10 / 3) if turning == "inner" else (10 / 3, 3)
    pi = np.mean(loads[:, 1] ** inner) ** (1 / inner)
    pe = np.mean(loads[:, 0] ** outer) ** (1 / outer)
    return ((qi / pi) ** (-10 / 3) + (qe / pe) ** (-10 / 3)) ** (-9 / 10)


def plain_rollers(lines, capacity, bearing, concentrated=True):
    """L10r in NumPy, lines (roller, raceway, lamina) [N]; inner ring turning."""
    z, _, n = lines.shape
    g = float(bearing.roller_diameter / bearing.pitch_diameter)
    inside = 1.038 * ((1 - g) / (1 + g)) ** (143 / 108)
    qi = capacity / (0.83 * 0.378 * z) * (1 + inside**4.5) ** (2 / 9)
    qe = capacity / (0.83 * 0.364 * z) * (1 + inside**-4.5) ** (2 / 9)
    f = np.ones(n)
    if concentrated:
        for k in range(1, n + 1):
            place = abs((2 * k - n - 1) / (2 * n - 2))
            f[k - 1] = 1 - 0.01 / np.log(1.985 * place)
    q = f * lines
    total = 0.0
    for k in range(n):
        ei = np.mean(q[:, 1, k] ** 4) ** 0.25
        ee = np.mean(q[:, 0, k] ** 4.5) ** (1 / 4.5)
        total += (ei / (qi / n ** (7 / 9))) ** 4.5 + (ee / (qe / n ** (7 / 9))) ** 4.5
    return total ** (-8 / 9)


def test_ball_lives_are_those_of_plain_numpy(balls):
    x = jnp.asarray([5e-6, 800.0, 600.0, 2e-3])
    _, found = balls(x)
    solution, life = found["of"]
    loads, bearing = np.asarray(solution.contact_load), ball_element(x).bearing
    expected = plain_balls(loads, 23400.0, 0.0, bearing)
    np.testing.assert_allclose(life.reference_rating_life, 1e6 * expected, rtol=1e-10)
    # The other ring turning, and a steep bearing whose cosine counts.
    steep = bj.AngularContactBallBearing(
        7, 43.5e-3, 11.5e-3, contact_angle=0.7, **grooves(0.515, 0.52)
    )
    for ring, turning in (("outer", [1.0, 0.0]), ("inner", [0.0, 1.0])):
        mine = row_fatigue(
            steep,
            jnp.asarray(2e4),
            steep.contact_angle,
            solution.contact_load[:, :, None],
            jnp.asarray(turning),
        )
        expected = plain_balls(loads, 2e4, 0.7, steep, ring)
        np.testing.assert_allclose(
            float(mine.share.sum()) ** -0.9, expected, rtol=1e-10
        )


@pytest.mark.slow
def test_roller_lives_are_those_of_plain_numpy(rollers):
    x = jnp.asarray([20e-6, 15e3, 0.0, 0.7e-3, 0.0004])
    _, found = rollers(x)
    solution, life, plain = found["of"]
    lines = np.asarray(solution.line_load)[:, :, 1::2] * 0.017 / LAMINAE
    bearing = roller_element(x).bearing
    for result, concentrated in ((life, True), (plain, False)):
        expected = plain_rollers(lines, 125e3, bearing, concentrated)
        np.testing.assert_allclose(
            result.reference_rating_life, 1e6 * expected, rtol=1e-10
        )
    share = np.asarray(life.damage_share)
    np.testing.assert_allclose(share.sum(), 1.0, rtol=1e-12)
    row, ring, lamina = life.weakest
    assert share[row, ("outer", "inner").index(ring), lamina] == share.max()


def test_modified_lives_are_those_of_plain_numpy(balls):
    x = jnp.asarray([5e-6, 800.0, 600.0, 2e-3])
    _, found = balls(x)
    _, life = found["of"]
    n, pitch = 150.0 * 30 / np.pi, 43.5
    kappa = 12.0 / (4500 * n**-0.5 * pitch**-0.5)
    np.testing.assert_allclose(life.viscosity_ratio, kappa, rtol=1e-10)
    clean = min(0.0432 * kappa**0.68 * pitch**0.55, 1.0) * (
        1 - 1.141 / pitch ** (1 / 3)
    )
    np.testing.assert_allclose(life.contamination_factor, clean, rtol=1e-10)
    load = 23400.0 / (float(life.reference_rating_life) / 1e6) ** (1 / 3)
    np.testing.assert_allclose(life.reference_load, load, rtol=1e-10)
    ratio = clean * float(life.ratings.fatigue_load_limit) / load
    assert kappa < 1.0
    rest = 1 - (2.5671 - 1.9987 / kappa**0.19087) ** 0.83 * ratio ** (1 / 3)
    np.testing.assert_allclose(life.a_iso, 0.1 * rest**-9.3, rtol=1e-9)
    np.testing.assert_allclose(
        life.modified_rating_life / life.reference_rating_life, life.a_iso, rtol=1e-9
    )
    hours = float(life.modified_rating_life) / n / 60
    np.testing.assert_allclose(life.life_hours, hours, rtol=1e-10)


def plain_a_iso(kappa, ratio):
    """Of radial roller bearings, ISO 281."""
    factor, power = (1.2348, 0.19087) if kappa < 1 else (1.2348, 0.071739)
    rest = 1 - (1.5859 - factor / kappa**power) * ratio**0.4
    return 50.0 if rest <= 0 else min(50.0, 0.1 * rest**-9.185)


@pytest.mark.slow
def test_modified_lives_of_rollers_are_those_of_plain_numpy(rollers):
    """Each lamina has the factor of its own load; constants agree as rounded."""
    x = jnp.asarray([70e-6, 15e3, 0.0, 0.5e-3, 0.00035])
    solution, life, _ = rollers(x)[1]["of"]
    lines = np.asarray(solution.line_load)[:, :, 1::2] * 0.017 / LAMINAE
    q = lines * edge_stress(LAMINAE)
    ei, ee = np.mean(q[:, 1] ** 4, 0) ** 0.25, np.mean(q[:, 0] ** 4.5, 0) ** (2 / 9)
    g = 0.015 / 0.103535
    inside = ((1 - g) / (1 + g)) ** (143 / 108)
    qi = 125e3 / (0.83 * 0.378 * 18) * (1 + (1.038 * inside) ** 4.5) ** (2 / 9)
    qe = 125e3 / (0.83 * 0.364 * 18) * (1 + (1.038 * inside) ** -4.5) ** (2 / 9)
    ratio = (qi / qe) ** 4.5
    load = (ei**4.5 + 1.038**4.5 * ratio * ee**4.5) / (1 + 1.038**4.5 * ratio)
    load = 0.323 * 18 * LAMINAE * load ** (2 / 9)
    kappa, limit = float(life.viscosity_ratio), float(life.ratings.fatigue_load_limit)
    assert 0.4 < kappa
    factor = np.array(
        [plain_a_iso(kappa, 0.5 * limit / p) for p in np.maximum(load, 1e-9)]
    )
    assert 1.5 * factor.min() < factor.max()
    tired = (ei / qi) ** 4.5 + (ee / qe) ** 4.5
    tired = LAMINAE**3.5 * np.sum(factor ** (-9 / 8) * tired)
    a1 = 0.05 + 0.95 * (np.log(0.95) / np.log(0.9)) ** (2 / 3)
    np.testing.assert_allclose(
        life.modified_rating_life, 1e6 * a1 * tired ** (-8 / 9), rtol=2e-3
    )
    np.testing.assert_allclose(
        life.modified_rating_life,
        life.reference_rating_life * life.a_iso * life.reliability_factor,
        rtol=1e-10,
    )


def test_row_fatigue_of_evenly_loaded_rollers_matches_iso_16281():
    """Of ISO 16281: 0.323 where statics has 0.378, the outer ring's part as 1.038."""
    bearing = roller_element(jnp.asarray([0.0, 0.0, 0.0, 0.0, 0.00035])).bearing
    # Sjövall's distribution without clearance, by the same integrals as C.
    angle = np.linspace(0.0, 2 * np.pi, 18, endpoint=False)
    shape = np.maximum(np.cos(angle), 0.0) ** (10 / 9)
    load = shape * 9e3 / (shape @ np.cos(angle))
    lines = np.broadcast_to(load[:, None, None] / 40, (18, 2, 40))
    c, zero = jnp.asarray(125e3), jnp.zeros(())
    found = row_fatigue(bearing, c, zero, jnp.asarray(lines), jnp.asarray([0.0, 1.0]))
    assert np.ptp(found.load) < 1e-9 * 9e3
    g = 0.015 / 0.103535
    outer = (1.038 * ((1 - g) / (1 + g)) ** (143 / 108)) ** 4.5
    more = ((1 + 1.038**4.5 * outer) / (1 + outer)) ** (2 / 9)
    # As far as the constants 0.378, 0.364 and 1.038 are rounded.
    np.testing.assert_allclose(found.load, 9e3 * more * 0.323 / 0.378, rtol=5e-3)


def test_a_radial_load_without_clearance_has_the_life_of_iso_281(balls, rollers):
    """As far as the standards' rounded constants agree: 3 % of balls; rollers have C
    without its reduction and the exponent 4."""
    _, life = balls(jnp.asarray([0.0, 1000.0, 0.0, 0.0]))[1]["of"]
    np.testing.assert_allclose(
        life.reference_rating_life, life.basic_rating_life, rtol=0.03
    )
    np.testing.assert_allclose(life.equivalent_load, 1000.0, rtol=SOLVER)
    *_, life = rollers(jnp.asarray([0.0, 20e3, 0.0, 0.0, 1e-9]))[1]["of"]
    expected = (125e3 / 0.83 / 20e3) ** 4
    np.testing.assert_allclose(life.reference_rating_life, 1e6 * expected, rtol=0.02)
    np.testing.assert_allclose(
        life.basic_rating_life, 1e6 * (125 / 20) ** (10 / 3), rtol=1e-9
    )


def test_thrust_bearings_have_the_life_of_iso_281_exactly():
    """All contacts bear alike, so that the ratings of contacts and bearing are one."""
    load, even = 5e3, jnp.asarray([0.0, 1.0])
    for angle in (0.5 * np.pi, 1.0):
        if angle > 1.5:
            bearing = bj.ThrustBallBearing(12, 0.05, 0.008, **grooves(0.54, 0.54))
        else:
            bearing = bj.AngularContactBallBearing(
                12, 0.05, 0.008, contact_angle=angle, **grooves(0.53, 0.54)
            )
        loads = jnp.full((12, 2, 1), load / (12 * np.sin(angle)))
        c = jnp.asarray(31e3)
        found = row_fatigue(bearing, c, jnp.asarray(angle), loads, even)
        millions = float(found.share.sum()) ** -0.9
        np.testing.assert_allclose(millions, (31e3 / load) ** 3, rtol=1e-12)
        np.testing.assert_allclose(found.load, load, rtol=1e-12)


def test_clearance_and_tilt_beyond_their_best_shorten_the_life(balls, rollers):
    def lives(program, at, values, base):
        x = np.tile(np.asarray(base), (len(values), 1))
        x[:, at] = values
        return [float(program(jnp.asarray(v))[1]["of"][1].damage) for v in x]

    clearances = [0.0, 10e-6, 20e-6, 40e-6, 80e-6]
    for program, base in (
        (balls, [0.0, 1000.0, 0.0, 0.0]),
        (rollers, [0.0, 20e3, 0.0, 0.0, 0.00035]),
    ):
        assert (np.diff(lives(program, 0, clearances, base)) > 0).all()
        # A little preload is best.
        tight = lives(program, 0, [-5e-6, 0.0], base)
        assert tight[0] < tight[1]
    tilts = [0.0, 0.5e-3, 1e-3, 2e-3]
    base = [70e-6, 20e3, 0.0, 0.0, 0.00035]
    assert (np.diff(lives(rollers, 3, tilts, base)) > 0).all()


@pytest.mark.parametrize(
    "k, step", [(0, 1e-7), (1, 5.0), (3, 1e-7), (4, 1e-7)], ids="c F tilt crown".split()
)
def test_slopes_are_those_of_differences(rollers, k, step):
    """Of fourth order: over smaller steps the error falls, as fewer slices open or
    close on the way, until the round-off of the solver grows."""
    x = np.array([20e-6, 15e3, 0.0, 0.7e-3, 0.0004])
    slopes, _ = rollers(jnp.asarray(x))
    exact = np.asarray(slopes["log"])[:, k]
    errors = []
    for factor in (100.0, 1.0, 0.3, 1e-5):
        h = np.zeros_like(x)
        h[k] = factor * step
        f = {m: rollers(jnp.asarray(x + m * h))[1]["log"] for m in (-2, -1, 1, 2)}
        near, far = (np.asarray(f[m]) - np.asarray(f[-m]) for m in (1, 2))
        found = (8 * near - far) / (12 * h[k])
        errors.append(abs(found - exact).max() / abs(exact).max())
    least = min(errors)
    assert least < DIFFERENCE / 10
    assert errors[0] > 10 * least and errors[-1] > 10 * least


def test_without_load_damage_and_slopes_are_zero(balls, rollers):
    for program, x in (
        (balls, [10e-6, 0.0, 0.0, 0.0]),
        (rollers, [20e-6, 0.0, 0.0, 0.0, 0.00035]),
    ):
        slopes, found = program(jnp.asarray(x))
        life = found["of"][1]
        assert float(life.damage) == 0.0
        assert np.isinf(life.basic_rating_life) and np.isinf(life.life_hours)
        assert np.isinf(life.static_safety) and float(life.a_iso) == 50.0
        assert float(life.equivalent_load) == 0.0
    np.testing.assert_array_equal(slopes["damage"], 0.0)


def test_which_ring_turns_against_the_load():
    """Rows: outer and inner speed, what the load is fixed to, what turns."""
    rows = [
        (0.0, 9.0, "space", [0, 1]),
        (9.0, 0.0, "space", [1, 0]),
        (9.0, -9.0, "space", [1, 1]),
        (0.0, 9.0, "inner", [1, 0]),  # an unbalance of the shaft
        (0.0, 9.0, "outer", [0, 1]),
        (9.0, 9.0, "outer", [0, 1]),  # nothing turns: by convention
        (0.0, 0.0, "inner", [1, 0]),
    ]
    for outer, inner, fixed, expected in rows:
        found = turns_against_load(bj.Speed(inner=inner, outer=outer), fixed)
        np.testing.assert_array_equal(found, expected)
    for fixed in FRAMES:
        expected = [1, 0] if fixed == "inner" else [0, 1]
        np.testing.assert_array_equal(turns_against_load(None, fixed), expected)


@pytest.mark.parametrize("kappa", [1.2, 1.9])
def test_a_iso_between_kappa_one_and_two(kappa):
    """Formulas (33) and (39) of ISO 281 by hand: their exponents differ from those
    below κ = 1, where the films are the same."""
    balls, rollers = (
        float(life_factor(kappa, jnp.asarray(0.3), kind, False))
        for kind in (True, False)
    )
    film = kappa**-0.071739
    rest = 1 - (2.5671 - 1.9987 * film) ** 0.83 * 0.3 ** (1 / 3)
    assert balls == pytest.approx(0.1 * rest**-9.3, rel=1e-9)
    rest = 1 - (1.5859 - 1.2348 * film) * 0.3**0.4
    assert rollers == pytest.approx(0.1 * rest**-9.185, rel=1e-9)


def angular(degrees, n=14):
    return bj.AngularContactBallBearing(
        n, 77.5e-3, 14.288e-3, contact_angle=np.deg2rad(degrees), **grooves(0.53, 0.52)
    )


def four_points(degrees, n=14):
    return bj.FourPointBallBearing(
        n, 77.5e-3, 14.288e-3, shim_angle=np.deg2rad(degrees), **grooves(0.53, 0.52)
    )


def test_four_points_live_as_one_row_by_axial_and_as_two_by_radial_load():
    """Under axial load balls touch one pair of arcs, under radial load both."""
    one, four = angular(35), four_points(35)
    pair = bj.BearingSet.back_to_back(one, 0.03)
    axial = jnp.asarray([0.0, 0.0, 5e3, 0.0, 0.0, 0.0])
    radial = jnp.asarray([5e3, 0.0, 0.0, 0.0, 0.0, 0.0])
    c, p = (
        {
            kind: np.array([float(f(bearing, load)) for load in (axial, radial)])
            for kind, bearing in (("one", one), ("four", four), ("pair", pair))
        }
        for f in (
            lambda bearing, load: bj.dynamic_capacity(bearing),
            lambda bearing, load: equivalent_load(bearing, load).dynamic,
        )
    )
    # As far as 1.07 and 0.66 are rounded: 2^0.7 is 1.6245.
    np.testing.assert_allclose(p["four"][0] / c["four"], (p["one"] / c["one"])[0], 0.01)
    np.testing.assert_allclose(p["four"] / c["four"], p["pair"] / c["pair"], 1e-9)

    rng, turning = np.random.default_rng(3), jnp.asarray([0.0, 1.0])
    right, left = rng.uniform(50.0, 400.0, (2, 14, 2, 1))

    @eqx.filter_jit
    def numbers(bearing, sizes, loads, c):
        rated = bj.ratings(bearing, dynamic_capacity=c, fatigue_load_limit=900.0)
        oil = jnp.asarray(1.5), jnp.asarray(0.5)  # κ and e_C
        rows = _rows(bearing, sizes, loads, rated, turning)
        tired = sum(_modified_damage(*row, *oil, BALLS).sum() for row in rows)
        return jnp.stack([sum(row.fatigue.share.sum() for row in rows), tired])

    of_four = numbers(four, (14,), jnp.asarray(np.concatenate([right, left], 2)), 7e4)
    of_pair = numbers(pair, (14, 14), jnp.asarray(np.concatenate([right, left])), 7e4)
    np.testing.assert_allclose(of_four, of_pair, rtol=1e-12)
    alone = jnp.asarray(np.concatenate([right, 0 * right], 2))
    of_four = numbers(four, (14,), alone, 7e4)[0]
    of_one = numbers(one, (14,), jnp.asarray(right), 7e4 / 2**0.7)[0]
    np.testing.assert_allclose(of_four, of_one, rtol=1e-12)


def test_equivalent_loads_by_formula():
    """At lines of the tables and between them: a validation case."""
    taper = bj.TaperedRollerBearing(
        14, 0.06, 0.008, 0.011, roller_axis_angle=0.25, roller_half_angle=0.0
    )
    cot = 1.0 / np.tan(0.25)
    rows = [
        # bearing, Fr, Fa, P, P0
        (taper, 1e3, 1e3, 400 + 400 * cot, 500 + 220 * cot),
        (taper, 1e3, 0.2e3, 1e3, 1e3),
        (roller_element([0.0, 0, 0, 0, 1e-4]).bearing, 1e3, 5e2, 1e3, 1e3),
    ]
    for bearing, radial, axial, dynamic, static in rows:
        load = jnp.asarray([0.6 * radial, -0.8 * radial, -axial, 5.0, 5.0, 0.0])
        found = equivalent_load(bearing, load)
        np.testing.assert_allclose(found.dynamic, dynamic, rtol=1e-3)
        np.testing.assert_allclose(found.static, static, rtol=1e-3)


@pytest.mark.parametrize("degrees", [50, 80])
def test_factors_of_thrust_ball_bearings(degrees):
    """Of one direction those of the second pair hold for any load."""
    single, axial = angular(degrees), jnp.asarray(1e3)
    both = load_factors(bj.BearingSet.back_to_back(single, 0.03), axial)
    static = [2.3 * np.tan(np.deg2rad(degrees)), 1.0]
    np.testing.assert_allclose(both.static, 2 * [static], rtol=1e-12)
    one = load_factors(single, axial)
    np.testing.assert_allclose(one.dynamic, 2 * [both.dynamic[1]], rtol=1e-12)


def test_x_y_factors_match_iso_tr_1281():
    """X = 1 - 0.4 ξ/η, Y e = 1 - X; two rows have 1.625 X, 1.625 Y and 0.625/e. Printed
    limits e are a validation case."""
    angle = np.deg2rad(_ANGLES)
    k = np.where(angle < 0.3, 1 / 2.5, 1 / 2.75)
    x = 1 - 0.4 * 1.25 / (1 - k * np.sin(angle))
    radial = 1 - 0.4 * 1.05 / (1 - np.sin(angle[0]) / 2.5)
    np.testing.assert_allclose(_X, np.append(radial, x[1:]), atol=0.006)
    np.testing.assert_allclose(_X2, 1.625 * x, atol=0.01)
    flat, steep = _FLAT, _STEEP
    rows = {
        0: (radial, flat["y"][0], flat["y2"][0], None),
        10: (x[1], flat["y"][1], flat["y2"][1], flat["y1"][1]),
        15: (x[2], flat["y"][2], flat["y2"][2], flat["y1"][2]),
        20: (x[3:], steep["y"], steep["y2"], steep["y1"]),
    }
    for share, y, double, one in rows.values():
        y = np.array(y)
        np.testing.assert_allclose(double, 1.625 * y, atol=0.014)
        if one is not None:
            np.testing.assert_allclose(one, 0.625 * y / (1 - share), rtol=0.03)
    np.testing.assert_allclose(_Y0_DOUBLE, 2 * np.array(_Y0))


def test_contamination_factors_grow_with_cleanliness():
    """Each class of oil halves the life or so."""
    names = list(CLEANLINESS)
    factor = [
        float(
            Cleanliness(*CLEANLINESS[name]).factor(jnp.asarray(1.0), jnp.asarray(0.1))
        )
        for name in names
    ]
    for kind in ("circulating", "oil bath", "grease"):
        mine = [f for f, name in zip(factor, names, strict=True) if kind in name]
        assert (np.diff(mine) < 0).all() and 0.5 < mine[0] < 0.9 and mine[-1] < 0.3


def test_a_thicker_oil_than_the_diagrams_have_gives_no_more(untyped):
    """They end at κ = 4, for e_C as for a_ISO: 6205, "oil bath -/17/14". Plain numbers
    do as arguments, and the slope beyond is zero."""
    clean = Cleanliness(*CLEANLINESS["oil bath -/17/14"])
    at_4 = 0.0133 * 4**0.68 * 39.04**0.55 * (1 - 1.67 / 39.04 ** (1 / 3))
    for kappa in (4, 4.0, 35, jnp.asarray(1e3)):
        assert float(clean.factor(kappa, 39.04e-3)) == pytest.approx(at_4, rel=1e-12)
    assert float(clean.factor(1, 1)) == pytest.approx(0.0133 * 1e3**0.55 * 0.833)
    assert float(jax.grad(lambda k: clean.factor(k, 39.04e-3))(35.0)) == 0.0
    assert float(life_factor(35, 1, True, False)) == pytest.approx(50.0)


def held(bearing, axial):
    """Moment about the centre over the radial force [m], its rings kept parallel."""
    load = [2e3, 0.0, axial, 0.0, 0.0, 0.0]
    kept = {"gx": 0.0, "gy": 0.0}
    return np.asarray(
        bj.solve_load(
            bj.BearingElement(bearing), load, support=bj.Support(prescribed=kept)
        ).force[6:]
    )


def test_left_out_moment_about_pressure_centre():
    """A load through the pressure centre leaves no moment, whichever way it faces."""
    single = angular(40)
    reach = 0.5 * 77.5e-3 * np.tan(np.deg2rad(40))
    turned = bj.BearingSet((bj.design.SetRow(single, 0.01, mirrored=True),))
    for bearing, centre in ((single, -reach), (turned, 0.01 + reach)):
        through = np.array([2e3, 1e3, 3e3, -1e3 * centre, 2e3 * centre, 0.0])
        lost = left_out(bearing, jnp.asarray(through))
        np.testing.assert_allclose(lost.moment, 0.0, atol=1e-9)
        more = through + np.array([0.0, 0.0, 0.0, 3.0, 4.0, 0.0])
        moment = left_out(bearing, jnp.asarray(more)).moment
        np.testing.assert_allclose(moment, 5.0, rtol=1e-9)


@pytest.mark.slow
def test_moments_are_counted_about_the_pressure_centre():
    """There the forces of the contacts meet: of an angular contact bearing whose rings
    are parallel hardly a moment is left, whichever way it faces; of a deep groove
    bearing, a pair or straight rollers it is about the middle."""
    single = angular(40)
    reach = 0.5 * 77.5e-3 * np.tan(np.deg2rad(40))
    turned = bj.BearingSet((bj.design.SetRow(single, 0.01, mirrored=True),))
    for bearing, axial, centre in ((single, 3e3, -reach), (turned, -3e3, 0.01 + reach)):
        force = held(bearing, axial)
        np.testing.assert_allclose(force[4] / force[0], centre, rtol=0.03)
        lost = left_out(bearing, jnp.asarray(force))
        expected = force[4] - centre * force[0]
        np.testing.assert_allclose(lost.moment, abs(expected), rtol=1e-9)
        assert lost.moment < 0.05 * 2e3 * 0.5 * 77.5e-3
        assert lost.radial == 0.0 == lost.axial
    load = jnp.asarray([3e3, 4e3, -500.0, 30.0, 40.0, 0.0])
    straight = roller_element([0.0, 0, 0, 0, 1e-4]).bearing
    washers = bj.ThrustBallBearing(14, 0.041, 0.0079, **grooves(0.54, 0.54))
    pair = bj.BearingSet.back_to_back(single, 0.03)
    for bearing, radial, axial in (
        (ball_element([0.0]).bearing, 0.0, 0.0),
        (pair, 0.0, 0.0),
        (straight, 0.0, 500.0),
        (washers, 5e3, 0.0),
    ):
        found = [float(x) for x in left_out(bearing, load)]
        np.testing.assert_allclose(found, [radial, axial, 50.0], rtol=1e-12)
    # A tilt that is held bears what its support does.
    for free, moment in ((("ux", "gx"), 30.0), (("gy",), 40.0), ((), 0.0)):
        assert float(left_out(pair, load, free).moment) == pytest.approx(moment)
    slope = jax.jacfwd(lambda f: jnp.stack(left_out(straight, f)))(jnp.zeros(6))
    assert np.isfinite(slope).all()


@pytest.mark.slow
def test_a_moment_alone_is_told_of_a_life():
    """20 N m on a 6305: L10 has no end, the reference life has."""
    element = ball_element([0.0])
    solution = bj.solve_load(element, [0.0, 0, 0, 0, 20.0, 0], speed=SPEED)
    life = bj.rating_life(element, solution)
    assert np.isinf(life.basic_rating_life) and np.isinf(life.static_safety)
    assert np.isfinite(life.reference_rating_life)
    np.testing.assert_allclose(life.moment_left_out, 20.0, rtol=1e-6)
    told = life_warnings(element.bearing, life.ratings, vars(life))
    (only,) = [text for text in told if "moment" in text]
    assert "moment of 20 N m" in only and "reference life of ISO/TS 16281" in only


@pytest.mark.slow
def test_optimise_life_warnings_match_rating_life():
    """Of all cases at once, in its outcomes if a life is among its measures."""
    element = ball_element([0.0])
    loads = jnp.zeros((3, 6)).at[:, 1].set(jnp.asarray([-2e3, -20e3, -50.0]))
    loads = loads.at[0, 4].set(20.0)
    solutions = jax.vmap(lambda f: bj.solve_load(element, f, speed=SPEED, throw=False))(
        loads
    )
    for measure in (
        bj.optimise.RatingLife(hours=True),
        bj.optimise.RatingLife().as_objective,
    ):
        task: Any = SimpleNamespace(measures=(bj.optimise.PeakPressure(), measure))
        told = Problem._doubts(task, element, solutions)()
        heavy, light, moment = told
        assert "in 1 of 3 cases, worst case 1" in heavy and "not vouch" not in light
        assert (
            "% of the least one that makers ask for, 0.01 C of ball" in light
            and "worst case 2" in light
        )
        assert "moment of 20 N m" in moment and "worst case 0" in moment
    none: Any = SimpleNamespace(measures=(bj.optimise.PeakPressure(),))
    assert Problem._doubts(none, element, solutions)() == []
    for k, text in ((1, heavy), (2, light), (0, moment)):
        one = jax.tree.map(lambda leaf, k=k: leaf[k], solutions)
        life = bj.rating_life(element, one)
        found = life_sizes(element.bearing, life.ratings, vars(life))
        (alone,) = warnings_of_cases(
            {name: np.atleast_1d(x) for name, x in found.items()}, ALL
        )
        assert text == f"{alone}, in 1 of 3 cases, worst case {k}"


def test_rows_in_tandem_share_the_axial_load_on_which_factors_depend():
    """ISO 281: of a set in tandem Fa/(Z D²) is that of one of its bearings."""
    load = 0.689e6 * 14 * 14.288e-3**2  # a line of the table
    tandem = bj.BearingSet.tandem(angular(10), 0.03, 3)
    single = load_factors(angular(10), jnp.asarray(load)).dynamic
    found = load_factors(tandem, jnp.asarray(3 * load)).dynamic
    np.testing.assert_allclose(found, single, rtol=1e-12)
    # Of two that face each other either may have to bear it all: 1.625 X and Y.
    pair = bj.BearingSet.back_to_back(angular(10), 0.03)
    found = np.asarray(load_factors(pair, jnp.asarray(load)).dynamic)
    np.testing.assert_allclose(found[1], 1.625 * np.asarray(single)[1], rtol=5e-3)


def test_edge_stress_matches_iso_16281():
    stress = edge_stress(41)
    np.testing.assert_allclose(stress[[0, -1]], 1 - 0.01 / np.log(0.9925), rtol=1e-12)
    assert stress[20] == 1.0 and (stress[1:-1] < 1.25).all()


def test_pressures_of_half_spaces_become_loads_of_laminae(untyped):
    """Of unlike cells: what tires, the sum of q^4.5 over the length, is kept."""
    cells = np.sort(np.random.default_rng(0).uniform(-5e-3, 5e-3, 40))
    edges = np.concatenate([[-5e-3], 0.5 * (cells[1:] + cells[:-1]), [5e-3]])
    line = 3e5 * (1.0 + 0.5 * np.sin(900.0 * cells))
    pressure = np.sqrt(line * 1.1e11 / (np.pi * 4e-3))
    found = SimpleNamespace(
        solution=SimpleNamespace(
            grid=SimpleNamespace(y=cells),
            pressure=pressure * np.array([0.5, 1.0, 0.7])[:, None],
        ),
        contact=SimpleNamespace(
            relative_radius=lambda y: np.full_like(y, 4e-3),
            modulus=1.1e11,
            roller_length=1e-2,
        ),
    )
    loads = _of_laminae(found, 32) / (1e-2 / 32)  # pyright: ignore[reportArgumentType]
    tired = np.sum(line**4.5 * np.diff(edges))
    np.testing.assert_allclose(np.sum(loads**4.5) * 1e-2 / 32, tired, rtol=1e-10)
    assert line.min() < loads.min() and loads.max() < line.max()


def test_half_spaces_with_few_laminae_are_refused(rollers):
    x = jnp.asarray([0.0, 1e3, 0.0, 0.0, 1e-4])
    solution, *_ = rollers(x)[1]["of"]
    with pytest.raises(ValueError, match="`n_laminae` is 20; it must be at least 30"):
        refined_lamina_loads(roller_element(x), solution, 20)


def test_a_peak_at_the_end_of_a_roller_is_seen(untyped):
    """There the pressure of half-spaces, and with it the life, follows the cells."""
    for pressure, expected in (([1, 2, 3, 2, 0], False), ([4, 2, 2, 2, 3], True)):
        field = np.array([np.zeros(5), pressure])
        found = SimpleNamespace(solution=SimpleNamespace(pressure=field))
        assert _peaks_at_an_end(found) == expected  # pyright: ignore[reportArgumentType]


def test_life_warnings_of_each_kind(untyped):
    ratings = SimpleNamespace(dynamic_capacity=20e3, static_capacity=12e3)
    bearing = ball_element([0.0]).bearing
    sound = {
        "equivalent_load": np.array(3e3),
        "reference_load": np.array(4e3),
        "viscosity_ratio": np.array(0.1),
        "life_hours": np.array(9e3),
        "damage": np.array(1e-9),
    }
    doubtful = {
        "equivalent_load": np.array(11e3),
        "viscosity_ratio": np.array(0.05),
        "life_hours": np.array(np.inf),
    }

    def told(**others):
        numbers = sound | others
        return life_warnings(bearing, ratings, numbers)  # pyright: ignore[reportArgumentType]

    assert told() == []
    words = ["of 11 kN, above 10 kN", "viscosity ratio of 0.05", "do not turn against"]
    words, pairs = [*words, "of 35: the diagrams"], [*doubtful.items()]
    pairs.append(("viscosity_ratio", np.array(35.0)))
    for (name, value), text in zip(pairs, words, strict=True):
        (only,) = told(**{name: value})
        assert text in only and "case" not in only
    assert told(viscosity_ratio=None, life_hours=None) == []
    assert told(life_hours=np.array(np.inf), damage=np.array(0.0)) == []
    assert life_warnings(bearing, ratings, {}) == []  # pyright: ignore[reportArgumentType]
    # Too little load to roll, but for preload, or at a standstill.
    few = dict(equivalent_load=np.array(150.0), reference_load=np.array(160.0))
    (only,) = told(**few)
    assert "of 160 N, below 200 N, 0.01 C, which makers of ball" in only
    assert told(**few | dict(reference_load=np.array(300.0))) == []
    assert told(**few, life_hours=None) == []
    still = told(**few, life_hours=np.array(np.inf))
    assert len(still) == 1 and "skid" not in still[0]
    nothing = dict.fromkeys(
        ("equivalent_load", "reference_load", "damage"), np.array(0.0)
    )
    assert "of 0 N, below 200 N" in told(**nothing, life_hours=np.array(np.inf))[0]
    # What P has no part of; of the moment a tenth of P times the pitch radius may be.
    for name, size, words in (
        ("moment", 10.0, "10 N m about the pressure centre"),
        ("axial", 20.0, "20 N, for which ISO 281 has no factor at 0°"),
        ("radial", 20.0, "20 N, for which ISO 281 has no factor"),
    ):
        (only,) = told(**{f"{name}_left_out": np.array(size)})
        assert only.startswith(name) and words in only and "P and P0" in only
    assert told(moment_left_out=np.array(0.09 * 3e3 * 21.75e-3)) == []
    # Of rollers, of two rows and 50 laminae.
    share = np.full((2, 2, 50), 0.7 / 192)
    share[:, :, [0, -1]] = 0.3 / 8
    (only,) = told(damage_share=share)
    assert only.startswith("30 % of the fatigue") and ", 50 here" in only
    assert told(damage_share=np.full((2, 2, 50), 0.005)) == []
    assert told(viscosity_ratio=np.array(0.0)) == []  # at a standstill
    # Of many cases, one of which was not solved.
    cases = {name: np.array([x, x, x, np.nan]) for name, x in sound.items()}
    cases["reference_load"][1] = 15e3
    cases["viscosity_ratio"][:] = [0.08, 4.5, 0.02, np.nan]
    heavy, thin, thick = warnings_of_cases(life_sizes(bearing, ratings, cases), ALL)  # pyright: ignore[reportArgumentType]
    assert "1.5 times the lesser" in heavy and "in 1 of 4 cases, worst" in heavy
    assert heavy.endswith("case 1")
    assert "of 0.02:" in thin and "in 2 of 4 cases, worst case 2" in thin
    assert "of 4.5:" in thick and "in 1 of 4 cases, worst case 1" in thick
    # A standstill among other cases has no life in hours, and needs none.
    cases["life_hours"][2] = np.inf
    assert len(warnings_of_cases(life_sizes(bearing, ratings, cases), ALL)) == 3  # pyright: ignore[reportArgumentType]
    cases["life_hours"][:] = np.inf
    assert (
        "no life in hours"
        in warnings_of_cases(life_sizes(bearing, ratings, cases), ALL)[-1]
    )  # pyright: ignore[reportArgumentType]


def nj_element():
    """Straight rollers between ribs."""
    ribs = bj.Ribs(*(bj.Rib(1.0, 0.5e-3) for _ in range(4)))
    bearing = bj.CylindricalRollerBearing(
        9, 48e-3, 9e-3, 9e-3, radial_internal_clearance=0.0, ribs=ribs
    )
    return bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(LAMINAE))


def thrust_element():
    return bj.BearingElement(
        bj.ThrustBallBearing(12, 50e-3, 9e-3, **grooves(0.53, 0.53))
    )


DOUBTED = (
    (
        lambda: ball_element([0.0]),
        {
            "heavy_load": ([15e3, 0, 0, 0, 0], 150.0),
            "light_load": ([50.0, 0, 0, 0, 0], 150.0),
            "moment_left_out": ([2e3, 0, 0, 0, 30.0], 150.0),
            "thin_film": ([2e3, 0, 0, 0, 0], 0.05),
            "thick_film": ([2e3, 0, 0, 0, 0], 150.0),
        },
    ),
    (lambda: ball_element([0.0]), {"no_hours": ([2e3, 0, 0, 0, 0], 0.0)}),
    (lambda: ball_element([0.0]), {"short_swing": ([2e3, 0, 0, 0, 0], 150.0, 0.1)}),
    (
        nj_element,
        {
            "axial_left_out": ([3e3, 0, 300.0, 0, 0], 150.0),
            "loaded_ends": ([3e3, 0, 0, 0, 0], 150.0),
        },
    ),
    (thrust_element, {"radial_left_out": ([50.0, 0, 3e3, 0, 0], 150.0)}),
)


@pytest.fixture(scope="module")
def doubted():
    """Sweeps that keep one output, with the number of the doubtful case, by kind."""
    swept = {}
    for make, kinds in DOUBTED:
        # As many cases of all, for which one program of the balls does.
        cases = [list(kinds.values())[k % len(kinds)] for k in range(5)]
        found = bj.sweep(
            make(),
            bj.Cases(
                np.array([[*case[0], 0.0] for case in cases]),
                inner_speed=np.array([case[1] for case in cases]),
                oscillation=np.array([sum(case[2:]) for case in cases]),
            ),
            outputs=["n_loaded"],
            options=bj.statics.SolveOptions(points=2 * LAMINAE + 1),
            life=bj.LifeConditions(viscosity=2e-4, contamination="grease, normal"),
        )
        assert found.converged.all()
        swept |= {kind: (k, found) for k, kind in enumerate(kinds)}
    return swept


@pytest.mark.parametrize("kind", LIFE_KINDS)
@pytest.mark.slow
def test_sweep_warns_of_lives_without_life_outputs(kind, doubted):
    k, swept = doubted[kind]
    assert not set(LIFE_OUTPUTS) & set(swept.outputs)
    assert swept.warning_sizes[kind][k] > LIFE_KINDS[kind].limit
    told = dict(zip(swept.warning_counts(), swept.warnings, strict=True))[kind]
    assert f", in {swept.warning_counts()[kind]} of 5 cases, worst case" in told


def test_required_life_that_is_just_kept_needs_what_there_is(balls):
    """The a_ISO of the verdict is that of the life, of all its parts."""
    life = balls(jnp.asarray([10e-6, 2000.0, 500.0, 0.0]))[1]["of"][1]
    numbers = {name: np.asarray(getattr(life, name))[None] for name in NEEDED}
    bearing = ball_element(jnp.asarray([10e-6])).bearing
    given = bj.LifeConditions(23400.0, viscosity=12e-6, contamination="grease, normal")
    found = judge_life(bearing, given, 1.0, 1.0, 23400.0, numbers)
    assert found.dynamic_capacity == pytest.approx(23400.0, rel=1e-9)
    assert found.viscosity == pytest.approx(12e-6, rel=1e-9)
    clean = float(life.contamination_factor)
    assert found.contamination_factor == pytest.approx(clean, rel=1e-9)
    assert "grease, normal" in found.cleanliness and found.kept


def test_rating_life_of_unconverged_solution_is_nan(balls):
    solution, life = balls(jnp.asarray([0.0, 1e40, 0.0, 0.0]))[1]["of"]
    assert not bool(solution.converged)
    for name in (*LIFE_OUTPUTS, "a_iso"):
        if name not in ("viscosity_ratio", "contamination_factor"):
            assert np.isnan(getattr(life, name)).all(), name


def test_straight_roller_life_depends_on_lamina_count():
    """What `MOST_AT_ENDS` says of evenly loaded straight rollers."""
    shares, lives = [], []
    for n in (30, 50, 200):
        tired = edge_stress(n) ** 4.5
        shares.append(2 * tired[0] / tired.sum())
        lives.append(np.mean(tired) ** (-8 / 9))
    np.testing.assert_allclose(shares, [0.74, 0.62, 0.27], atol=0.005)
    np.testing.assert_allclose(np.array(lives) / lives[1], [0.75, 1, 1.62], atol=0.005)


def test_single_precision_has_the_usual_reliability():
    assert bj.LifeConditions(reliability=np.float32(0.9)).viscosity is None


@pytest.mark.parametrize(
    "conditions, what",
    [
        ({"dynamic_capacity": -1.0}, "`dynamic_capacity` is -1 N; .*above 0"),
        ({"static_capacity": "40 kN"}, "`static_capacity` is '40 kN'.*number in N"),
        ({"reliability": 90.0}, "`reliability` is 90.*at least 0.9 and below 1"),
        ({"viscosity": 12.0, "contamination": 0.5}, "`viscosity` is 12 m²/s.*below 1"),
        ({"viscosity": 12e-6}, "`contamination` is missing"),
        ({"contamination": 0.5}, "`viscosity` is missing"),
        ({"viscosity": 1e-5, "contamination": 1.5}, "`contamination` is 1.5"),
        ({"viscosity": 1e-5, "contamination": "clean"}, "'clean'.*grease, normal"),
        ({"load_fixed_to": "shaft"}, "'shaft'.*one of space, inner, outer"),
        ({"edge_stress": "no"}, "`edge_stress` is 'no'.*True or False"),
        ({"fatigue_load_limit": np.nan}, "`fatigue_load_limit` is nan N"),
        (
            {"fatigue_load_limit": 30e3, "static_capacity": 8e3},
            "`fatigue_load_limit` is 30000 N.*below `static_capacity`, 8000 N",
        ),
    ],
)
def test_life_conditions_reject_invalid_arguments(conditions, what, untyped):
    with pytest.raises((TypeError, ValueError), match=what):
        bj.LifeConditions(**conditions)


def test_rating_life_rejects_invalid_arguments(balls, rollers, untyped):
    x = jnp.asarray([0.0, 1e3, 0.0, 0.0])
    solution, _ = balls(x)[1]["of"]
    element = ball_element(x)
    with pytest.raises(TypeError, match="BearingElement"):
        bj.rating_life(element.bearing, solution)
    several = jax.tree.map(lambda a: a[None], solution)
    with pytest.raises(ValueError, match="several cases"):
        bj.rating_life(element, several)
    with pytest.raises(TypeError, match="`speed` is a float; it must be a Speed"):
        bj.rating_life(element, solution, speed=150.0)
    turning = eqx.tree_at(
        lambda s: s.speed, solution, bj.Speed(100.0), is_leaf=lambda leaf: leaf is None
    )
    with pytest.raises(ValueError, match="`speed` is 150 .*the solution has 100 and 0"):
        bj.rating_life(element, turning, speed=bj.Speed(150.0))
    other = roller_element(jnp.asarray([0.0, 1e3, 0.0, 0.0, 1e-4]))
    with pytest.raises(ValueError, match="`element` has .*Roller.* solution is of .*B"):
        bj.rating_life(other, solution)
    with pytest.raises(ValueError, match="no speed is known"):
        bj.rating_life(
            element,
            solution,
            conditions=bj.LifeConditions(viscosity=1e-5, contamination=0.5),
        )
    x = jnp.asarray([0.0, 1e3, 0.0, 0.0, 1e-4])
    solution, *_ = rollers(x)[1]["of"]
    short = eqx.tree_at(lambda s: s.line_load, solution, solution.line_load[..., :60])
    with pytest.raises(ValueError, match="60 `points`.*odd and at least 61"):
        bj.rating_life(roller_element(x), short)
    with pytest.raises(ValueError, match=r"`lamina_load` has shape \(2, 2\)"):
        bj.rating_life(roller_element(x), solution, lamina_load=np.zeros((2, 2)))


def test_the_damage_of_cases_adds_up():
    """Palmgren and Miner: each case uses its revolutions over its life. That a sweep
    has these lives is tested with the command `life`."""
    hours, speeds = np.array([60.0, 25.0, 15.0]), np.array([150.0, -150.0, 90.0])
    lives = np.array([1e9, 3e7, np.inf])
    cases = bj.Cases(np.zeros((3, 6)), inner_speed=speeds, outer_speed=0.0, hours=hours)
    turns = hours * abs(speeds) * 3600 / (2 * np.pi)
    used = turns / lives
    life = bj.spectrum_life(cases, 1 / lives)
    expected = hours.sum() / used.sum()
    np.testing.assert_allclose(np.asarray(life.life_hours), expected, rtol=1e-12)
    expected = turns.sum() / used.sum()
    np.testing.assert_allclose(np.asarray(life.rating_life), expected, rtol=1e-12)
    np.testing.assert_allclose(life.damage_share, used / used.sum(), rtol=1e-12)
    # Without speeds all turn alike; without load life is infinite.
    still = bj.Cases(np.zeros((3, 6)), hours=hours)
    life = bj.spectrum_life(still, 1 / lives)
    assert life.life_hours is None
    expected = hours.sum() / (hours / lives).sum()
    np.testing.assert_allclose(np.asarray(life.rating_life), expected, rtol=1e-12)
    assert np.isinf(bj.spectrum_life(still, np.zeros(3)).rating_life)
    with pytest.raises(ValueError, match=r"`damage` has shape \(2,\).*\(3,\)"):
        bj.spectrum_life(still, np.zeros(2))


def test_sweep_life_outputs_reject_missing_conditions(balls, untyped):
    solution, _ = balls(jnp.asarray([0.0, 1e3, 0.0, 0.0]))[1]["of"]
    life = bj.rating_life(solution)
    for name, needed in (("a_iso", "a lubricant"), ("life_hours", "ring speeds")):
        with pytest.raises(ValueError, match=f"'{name}' needs {needed}"):
            life_outputs(life, [name])
    element = ball_element(jnp.asarray([0.0]))
    with pytest.raises(TypeError, match="`life` is a dict; it must be LifeConditions"):
        bj.sweep(element, np.ones((2, 6)), outputs=["damage"], life={})  # pyright: ignore[reportArgumentType]


def test_rating_life_measure_combines_cases(balls, untyped):
    """One number of cases, its inverse as an objective, both in hours if asked."""
    loads = (1500.0, 800.0)
    found = [balls(jnp.asarray([5e-6, f, 100.0, 0.0]))[1]["of"] for f in loads]
    stacked = jax.tree.map(lambda *a: np.stack(a), *(pair[0] for pair in found))
    hours, speed = np.array([3.0, 9.0]), np.array([150.0, 300.0])
    load = np.zeros((2, 6))
    cases = bj.Cases(load, inner_speed=speed, hours=hours)
    element = ball_element(jnp.asarray([5e-6]))
    conditions = bj.LifeConditions(23400.0, reliability=0.95)
    measure = bj.optimise.RatingLife(conditions, hours=True)

    @eqx.filter_jit
    def both(element, cases, solution):
        of = element, cases, solution
        return measure(*of), measure.as_objective(*of)

    life, damage = both(element, cases, stacked)
    turns = hours * speed * 3600 / (2 * np.pi)
    alone = np.array([float(pair[1].reference_rating_life) for pair in found])
    # 95 of 100 reach less than the reference life, without a lubricant too.
    a1 = 0.05 + 0.95 * (np.log(0.95) / np.log(0.9)) ** (2 / 3)
    expected = a1 * hours.sum() / (turns / alone).sum()
    np.testing.assert_allclose(life, expected, rtol=1e-10)
    np.testing.assert_allclose(damage, 1 / expected, rtol=1e-10)
    with pytest.raises(ValueError, match="`hours` is True, but the cases have no"):
        measure(element, bj.Cases(load), stacked)
    with pytest.raises(TypeError, match="`conditions` is a float"):
        bj.optimise.RatingLife(23400.0)  # pyright: ignore[reportArgumentType]

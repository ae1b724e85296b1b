"""Ratings, equivalent loads, lives and friction of barrel, thrust and crossed rollers.

By hand: the formulas of ISO 281, ISO 76, ISO/TS 16281 and of SKF's friction model as
they are printed, in NumPy. Published results are validation cases.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from slopes import with_slopes
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj
from bearingjax.element.constants import relative_radii
from bearingjax.fits.mounting import radial_clearance, row_shifts, with_radial_clearance
from bearingjax.friction.friction import _of_row
from bearingjax.friction.friction_skf import _TYPES, _variables
from bearingjax.life.equivalent_load import equivalent_load, left_out, load_factors
from bearingjax.life.life_warning import life_warnings
from bearingjax.life.rating import row_ratings
from bearingjax.life.reference_life import contact_capacities

_DEG = np.pi / 180
SPEED = bj.Speed(inner=50.0)
NINETY = 0.5 * np.pi


def spherical(n=18, angle=9.5 * _DEG, **change):
    """A row of a bearing like a 22220."""
    values = dict(
        roller_profile_radius=0.078085, inner_raceway_radius=0.0805, contact_angle=angle
    )
    pitch = 2 * (0.0805 - 0.01075) * np.cos(angle)
    return bj.SphericalRollerRow(n, pitch, 0.0215, 0.0185, **(values | change))


def toroidal(**change):
    radii = dict(
        roller_profile_radius=0.4074,
        outer_raceway_radius=0.42,
        inner_raceway_radius=0.42,
    )
    return bj.ToroidalRollerBearing(20, 0.14, 0.0195, 0.03, **(radii | change))


def spherical_thrust(n=14, angle=50 * _DEG, **change):
    values = dict(
        roller_profile_radius=0.10185, inner_raceway_radius=0.105, contact_angle=angle
    )
    pitch = 2 * (0.105 - 0.011) * np.cos(angle)
    return bj.SphericalThrustRollerBearing(n, pitch, 0.022, 0.026, **(values | change))


def flat(n=21):
    """Like an 81212."""
    return bj.CylindricalThrustRollerBearing(n, 77.5e-3, 9e-3, 9e-3)


def tapered_thrust(outer=80 * _DEG):
    half = 3 * _DEG
    pitch = 0.012 * np.sin(outer - half) / np.tan(half)
    return bj.TaperedThrustRollerBearing(
        16,
        pitch,
        0.012,
        0.014,
        roller_axis_angle=outer - half,
        roller_half_angle=half,
        ribs=bj.Ribs(inner_minus=bj.Rib(0.3, 2e-3)),
    )


def crossed(n=40, **change):
    return bj.CrossedRollerRow(n, 277.5e-3, 14e-3, 10e-3, **change)


EXAMPLES: dict[str, tuple[Any, float, float]] = {
    # With b_m and the contact angle.
    "spherical": (bj.BearingSet.self_aligning(spherical()), 1.15, 9.5 * _DEG),
    "toroidal": (toroidal(), 1.15, 0.0),
    "spherical thrust": (spherical_thrust(), 1.15, 50 * _DEG),
    "spherical thrust, flat": (spherical_thrust(angle=41 * _DEG), 1.15, 41 * _DEG),
    "cylindrical thrust": (flat(), 1.0, NINETY),
    "tapered thrust": (tapered_thrust(), 1.1, 80 * _DEG),
    "tapered thrust, flat washer": (tapered_thrust(NINETY), 1.1, NINETY),
    "crossed": (bj.BearingSet.crossed(crossed()), 1.1, 45 * _DEG),
}


def by_hand(name):
    """C and C0 by the formulas of the standards, and whether they are axial."""
    bearing, b, a = EXAMPLES[name]
    rows: list[Any] = [row.bearing for row in bj.design.rows_of(bearing)]
    row, i = rows[0], len(rows)
    axial = "thrust" in name
    z, size = row.n_elements, 1e3 * float(row.roller_diameter)
    length, d = 1e3 * float(row.roller_length), 1e3 * float(row.pitch_diameter)
    g = size * np.cos(a) / d
    inner = ((1 - g) / (1 + g)) ** (143 / 108)
    if a == NINETY:
        f = 551.13373 * 0.73 * 0.85 * 2 ** (-2 / 9) * (size / d) ** (2 / 9)
        c = b * f * length ** (7 / 9) * z**0.75 * size ** (29 / 27)
        return c, 220 * z * length * size, axial
    f = 551.13373 * g ** (2 / 9) * (1 - g) ** (29 / 27) / (1 + g) ** 0.25
    if axial:
        f *= 0.73 * (1 - 0.15 * np.sin(a)) * (1 + inner**4.5) ** (-2 / 9) * np.tan(a)
    else:
        f *= 0.377 * 0.83 * (1 + (1.04 * inner) ** 4.5) ** (-2 / 9)
    c = b * f * (i * length * np.cos(a)) ** (7 / 9) * z**0.75 * size ** (29 / 27)
    c0 = 220 * np.sin(a) if axial else 44 * i * np.cos(a)
    return c, c0 * (1 - g) * z * length * size, axial


@pytest.mark.parametrize("name", EXAMPLES)
def test_ratings_are_those_by_hand(name):
    dynamic, static, axial = by_hand(name)
    found = bj.ratings(EXAMPLES[name][0])
    assert float(found.dynamic_capacity) == pytest.approx(dynamic, rel=1e-11)
    assert float(found.static_capacity) == pytest.approx(static, rel=1e-11)
    assert bool(found.axial) is axial


@pytest.mark.parametrize("name", EXAMPLES)
def test_ratings_have_the_derivatives_of_differences(name):
    """By every real number of the row; radii along the rollers do not count."""
    bearing = EXAMPLES[name][0]
    row = bj.design.rows_of(bearing)[0].bearing
    names = [
        f
        for f in ("pitch_diameter", "roller_diameter", "roller_length", "contact_angle")
        if hasattr(row, f)
    ]
    names += [f for f in ("roller_axis_angle", "roller_half_angle") if hasattr(row, f)]
    radii = [f for f in vars(row) if f.endswith("_radius")]
    radii = [f for f in radii if getattr(row, f) is not None]
    start = np.array([float(getattr(row, f)) for f in (*names, *radii)])
    if np.isclose(EXAMPLES[name][2], NINETY) and "tapered" in name:
        # At 90 degrees both sides count as steep; the slope is that from below.
        start[names.index("roller_axis_angle")] -= 1e-3

    def both(sizes):
        def new(one):
            places = [getattr(one, f) for f in (*names, *radii)]
            assert len(places) == len(sizes)
            return eqx.tree_at(
                lambda b: [getattr(b, f) for f in (*names, *radii)], one, list(sizes)
            )

        made = new(row)
        if isinstance(bearing, bj.BearingSet):
            made = eqx.tree_at(
                lambda s: [r.bearing for r in s.rows],
                bearing,
                [new(r.bearing) for r in bearing.rows],
            )
        return jnp.stack((bj.dynamic_capacity(made), bj.static_capacity(made)))

    evaluate = with_slopes(both)
    slopes = np.asarray(evaluate(start)[0])
    assert np.isfinite(slopes).all()
    assert (slopes[:, len(names) :] == 0.0).all()
    for k, size in enumerate(start[: len(names)]):
        h = 1e-5 * size * np.eye(start.size)[k]
        high, low = evaluate(start + h)[1], evaluate(start - h)[1]
        difference = (np.asarray(high) - np.asarray(low)) / (2e-5 * size)
        scale = np.abs(np.asarray(high)) / size
        assert (np.abs(slopes[:, k] - difference) <= DIFFERENCE * scale).all()


def p_of(bearing, *load):
    found = equivalent_load(bearing, jnp.asarray([*load, 0.0], float))
    return float(found.dynamic), float(found.static)


def test_equivalent_loads_by_hand():
    cot = 1 / np.tan(9.5 * _DEG)
    bearing = EXAMPLES["spherical"][0]
    # Below and above e = 1.5 tan α = 0.251.
    assert p_of(bearing, 2e4, 0, 2e3, 0, 0) == pytest.approx(
        (2e4 + 0.45 * cot * 2e3, 2e4 + 0.44 * cot * 2e3)
    )
    assert p_of(bearing, 2e4, 0, 9e3, 0, 0)[0] == pytest.approx(
        0.67 * 2e4 + 0.67 * cot * 9e3
    )
    # Neither axial loads of toroidal nor radial ones of flat rollers have a factor.
    assert p_of(toroidal(), 3e4, 4e4, 7e3, 0, 0) == pytest.approx((5e4, 5e4))
    assert p_of(flat(), 3e3, 0, -2e4, 0, 0) == pytest.approx((2e4, 2e4))
    washers = EXAMPLES["tapered thrust, flat washer"][0]
    assert p_of(washers, 3e3, 0, 2e4, 0, 0) == pytest.approx((2e4, 2e4))
    tangent = np.tan(80 * _DEG)
    assert p_of(tapered_thrust(), 1e3, 0, 2e4, 0, 0) == pytest.approx(
        (2e4 + tangent * 1e3, 2e4 + 2.3 * tangent * 1e3)
    )
    tangent = np.tan(50 * _DEG)
    load = 2e4 + tangent * 1e4, 2e4 + 2.3 * tangent * 1e4
    assert p_of(spherical_thrust(), 1e4, 0, 2e4, 0, 0) == pytest.approx(load)
    # Two that face each other: X = 1.5 tan α, Y = 0.67 for more radial load.
    pair = bj.BearingSet.back_to_back(tapered_thrust(), 0.1)
    tangent = np.tan(80 * _DEG)
    assert p_of(pair, 9e3, 0, 2e4, 0, 0)[0] == pytest.approx(
        1.5 * tangent * 9e3 + 0.67 * 2e4
    )


def test_crossed_rollers_carry_moments_too():
    bearing = EXAMPLES["crossed"][0]
    factors = load_factors(bearing, jnp.asarray(1.0))
    np.testing.assert_allclose(factors.dynamic, [[1, 0.45], [0.67, 0.67]], rtol=1e-12)
    # P includes a moment, but not with one orientation; `left_out` reports it then.
    load = jnp.asarray([0.0, 0, 0, 300.0, 400.0, 0])
    assert [float(x) for x in left_out(bearing, load)] == [0.0, 0.0, 0.0]
    assert p_of(bearing, 0, 0, 0, 300, 400) == pytest.approx(2 * (1e3 / 0.2775,))
    alone = bj.BearingSet((bj.SetRow(crossed()),))
    assert float(left_out(alone, load).moment) == pytest.approx(500.0)
    slope = jax.jacfwd(lambda f: equivalent_load(bearing, f).dynamic)(load)
    np.testing.assert_allclose(slope[3:5], np.array([0.6, 0.8]) * 2 / 0.2775)


def test_equivalent_load_left_out_components():
    load = jnp.asarray([3e3, 4e3, -500.0, 0.0, 0.0, 0.0])
    # The pressure centre of a spherical row is its origin, in a set as alone.
    for bearing in (spherical(), EXAMPLES["spherical"][0]):
        assert [float(x) for x in left_out(bearing, load)] == pytest.approx([0, 0, 0])
    assert [float(x) for x in left_out(toroidal(), load)] == [0.0, 500.0, 0.0]
    for bearing in (flat(), EXAMPLES["tapered thrust, flat washer"][0]):
        assert [float(x) for x in left_out(bearing, load)] == [5e3, 0.0, 0.0]
    # That of a spherical thrust bearing is the centre of its sphere.
    reach = 0.5 * float(spherical_thrust().pitch_diameter) * np.tan(50 * _DEG)
    moment = jnp.asarray([1e3, 0, 5e3, 0, -1e3 * reach, 0])
    found = [float(x) for x in left_out(spherical_thrust(), moment)]
    assert found == pytest.approx([0, 0, 0], abs=1e-9)


def test_contact_capacities_are_those_of_iso_16281():
    c = jnp.asarray(1e5)
    # Thrust rollers: C/(0.73 Z sin α) (1 + 1)^(2/9), alike at 90 degrees.
    found = contact_capacities(flat(), c, jnp.asarray(NINETY))
    np.testing.assert_allclose(
        found, 2 * [1e5 / (0.73 * 21) * 2 ** (2 / 9)], rtol=1e-12
    )
    # A spherical thrust bearing below 45 degrees is one all the same.
    row, a = spherical_thrust(angle=41 * _DEG), 41 * _DEG
    g = 0.022 * np.cos(a) / float(row.pitch_diameter)
    weak = ((1 - g) / (1 + g)) ** (143 / 108 * 4.5)
    by_hand = (
        1e5 / (0.73 * 14 * np.sin(a)) * np.array([1 + 1 / weak, 1 + weak]) ** (2 / 9)
    )
    found = contact_capacities(row, c, jnp.asarray(a))
    np.testing.assert_allclose(found, by_hand, rtol=1e-12)
    # Crossed and spherical radial rollers: C/(0.83 J Z cos α).
    for row, z, size, a in (
        (crossed(), 20, 14e-3, 45 * _DEG),
        (spherical(), 18, 21.5e-3, 9.5 * _DEG),
    ):
        g = size * np.cos(a) / float(row.pitch_diameter)
        weak = (1.038 * ((1 - g) / (1 + g)) ** (143 / 108)) ** 4.5
        both = np.array([1 + 1 / weak, 1 + weak]) ** (2 / 9) / [0.364, 0.378]
        found = contact_capacities(row, c, jnp.asarray(a))
        np.testing.assert_allclose(
            found, 1e5 / (0.83 * z * np.cos(a)) * both, rtol=1e-9
        )


CASES = {
    "spherical": ([2e4, 0, 5e3, 0, 0, 0], {}),
    "toroidal": ([5e4, 0, 0, 0, 0, 0], dict(uz=0.0, gx=0.0, gy=0.0)),
    "spherical thrust": ([2e4, 0, 5e4, 0, 0, 0], {}),
    "cylindrical thrust": ([0, 0, 2e4, 0, 0, 0], {}),
    "tapered thrust": ([1e3, 0, 4e4, 0, 0, 0], dict(gx=0.0, gy=0.0)),
    "crossed": ([5e3, 0, 6e3, 0, 366.0, 0], {}),
}


@pytest.fixture(scope="module")
def solved():
    found = {}
    for name, (load, held) in CASES.items():
        element = bj.BearingElement(EXAMPLES[name][0])
        # Without ribs nothing holds turning cylinders that do not lie along the axis.
        speed = None if name in ("cylindrical thrust", "crossed") else SPEED
        found[name] = bj.solve_load(
            element, load, support=bj.Support(prescribed=held), speed=speed
        )
    return found


@pytest.mark.parametrize("name", CASES)
@pytest.mark.slow
def test_lives_of_every_type(solved, name):
    """P and its life by hand; the reference life is near that of P."""
    solution, (load, _) = solved[name], CASES[name]
    bearing = EXAMPLES[name][0]
    life = bj.rating_life(
        solution,
        speed=SPEED,
        conditions=bj.LifeConditions(viscosity=2e-5, contamination="grease, normal"),
    )
    p = float(equivalent_load(bearing, jnp.asarray(load, float)).dynamic)
    c = by_hand(name)[0]
    assert float(life.equivalent_load) == pytest.approx(p, rel=1e-6)
    assert float(life.basic_rating_life) == pytest.approx(
        1e6 * (c / p) ** (10 / 3), rel=1e-5
    )
    # It knows how the load is spread, and takes the fourth power in place of 10/3.
    assert 0.5 < float(life.reference_load) / p < 1.0
    assert life.a_iso is not None and float(life.a_iso) > 0.1
    told = life_warnings(bearing, life.ratings, vars(life))
    assert all("laminae at the ends" in text for text in told), told
    assert not any("radial clearance" in text for text in bj.warnings(solution))


@pytest.mark.slow
def test_life_of_evenly_loaded_thrust_rollers(solved):
    """(C/(0.73 F))^4: by the definition of C with λν = 0.73, edges apart."""
    life = bj.rating_life(
        solved["cylindrical thrust"], conditions=bj.LifeConditions(edge_stress=False)
    )
    c = by_hand("cylindrical thrust")[0]
    expected = 1e6 * (c / (0.73 * 2e4)) ** 4
    assert float(life.reference_rating_life) == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow
def test_refined_contact_has_the_bearings_geometry(solved):
    """Radius and drop along barrel rollers, with their arcs, and the plane of a
    washer."""
    for name, near in (("spherical", 2e-4), ("toroidal", 2e-4), ("crossed", 1e-9)):
        solution = solved[name]
        got = bj.refine(solution.element, solution)
        constants = solution.element.model().rows[0].element.constants
        y = jnp.linspace(-0.9, 0.9, 5) * constants.half_length
        wanted = relative_radii(constants, y)[1]
        np.testing.assert_allclose(got.contact.relative_radius(y), wanted, rtol=near)
        drop = constants.lines[1].drop(y / constants.half_length)
        np.testing.assert_allclose(got.contact.drop(y), drop, rtol=1e-9, atol=1e-15)
        assert float(got.solution.load) == pytest.approx(
            float(solution.roller_load[got.roller, 1]), rel=1e-6
        )
        if name == "spherical":
            # The ellipse ends short of the roller's ends: slices are near.
            assert got.edge_factor == pytest.approx(1.0, abs=0.05)
    solution = solved["cylindrical thrust"]
    got = bj.refine(solution.element, solution)
    assert float(got.contact.relative_radius(jnp.asarray(1e-3))) == pytest.approx(
        4.5e-3
    )


@pytest.mark.slow
def test_films_of_flat_thrust_rollers_roll_at_the_pitch_circle(solved):
    from bearingjax.lubrication import OILS

    still = solved["cylindrical thrust"]
    turning = eqx.tree_at(lambda s: s.speed, still, SPEED, is_leaf=is_none)
    found = bj.films(turning, OILS["ISO VG 46"](), 323.15)
    np.testing.assert_allclose(found.entrainment, 0.5 * 50.0 * 0.5 * 77.5e-3, rtol=1e-9)


def is_none(leaf):
    return leaf is None


def palmgren(name, radial, axial, supply="oil_bath"):
    """Load and viscous torque over the pitch diameter and its cube."""
    bearing = EXAMPLES[name][0]
    row = bj.design.rows_of(bearing)[0].bearing
    load = jnp.asarray([radial, 0.0, axial, 0.0, 0.0, 0.0])
    flow = 90e3 * 2 * np.pi / 60e6
    load, viscous, ribs = _of_row(bearing, load, flow, supply, None)
    pitch = float(row.pitch_diameter)
    assert float(ribs) == 0.0
    return float(load) / pitch, float(viscous) / (0.1 * 90e3 ** (2 / 3) * pitch**3)


def test_friction_by_palmgren():
    e = 1.5 * np.tan(9.5 * _DEG)
    share = (2e3 / (e * 2e4)) ** 3
    for axial, load in ((2e3, (1 + 0.6 * share) * 2e4), (9e3, 1.6 * 9e3 / e)):
        assert palmgren("spherical", 2e4, axial) == pytest.approx((6e-4 * load, 6.0))
    assert palmgren("cylindrical thrust", 0.0, 2e4, "grease") == pytest.approx((30, 9))
    found = palmgren("spherical thrust", 1e4, 3e4, "oil_jet")
    assert found == pytest.approx((12.0, 7.0))
    for name, words in (
        ("toroidal", "no constants of a ToroidalRollerBearing are known"),
        ("crossed", "no constants of a CrossedRollerRow are known"),
        ("tapered thrust", "no constants of a TaperedThrustRollerBearing are known"),
        ("spherical thrust", "SphericalThrustRollerBearing with `supply` 'oil_mist'"),
    ):
        with pytest.raises(ValueError, match=words):
            palmgren(name, 1e3, 1e3, "oil_mist")


def test_friction_by_skf():
    """G_rr and G_sl of SKF's tables at light and heavy loads, by hand."""

    def found(name, series, *load):
        row = bj.design.rows_of(EXAMPLES[name][0])[0].bearing
        given: Any = _TYPES[type(row)].series[series], 140.0, *load, 1e3, 1.0, 2e4
        return [float(x) for x in _variables(row, *given)]

    r, s = found("spherical", "222E", 1e3, 100.0)
    assert r == pytest.approx(1.6e-6 * 140**1.85 * (1e3 + 584) ** 0.54)
    both = 3.62e-3 * 140**0.25 * (1e12 + 508e8) ** (1 / 3)
    assert s == pytest.approx(both)
    r, s = found("spherical", "222E", 8e5, 1e5)
    assert r == pytest.approx(2.81e-6 * 140**2.3 * (8e5 + 58e4) ** 0.31)
    assert s == pytest.approx(8.8e-3 * 140**0.94 * (8e5**3 + 117 * 1e5**3) ** (1 / 3))
    for load in (1e2, 1e5):
        forms = 1.17e-6 * 140**1.97 * load**0.54, 2.08e-6 * 140**2.37 * load**0.31
        slides = 1.32e-3 * 140**-0.19 * load ** (5 / 3), 0.8e-2 * 140**1.05 * load
        assert found("toroidal", "22", load, 0.0) == pytest.approx(
            [min(forms), min(slides)]
        )
    assert found("cylindrical thrust", "81", 0.0, 1e4) == pytest.approx(
        [2.25e-6 * 140**2.38 * 1e4**0.31, 0.154 * 140**0.62 * 1e4]
    )
    r, s = found("spherical thrust", "294E", 4e5, 12e5)
    assert r == pytest.approx(2.15e-6 * 140**2.39 * (4e5 + 2.86 * 12e5) ** 0.31)
    rib = 0.2 * 140**0.76 * (4e5 + 0.54 * 12e5) * np.exp(-1e-6 * 2e4**1.4 * 140)
    assert s == pytest.approx(0.04 * 140**0.89 * 16e5 + rib)
    r, s = found("spherical thrust", "294E", 40.0, 120.0)
    assert r == pytest.approx(1.25e-6 * 140**1.96 * (40 + 1.67 * 120) ** 0.54)
    rib = 0.2 * 140**0.76 * (40 + 0.54 * 120) * np.exp(-1e-6 * 2e4**1.4 * 140)
    both = 40 ** (5 / 3) + 0.21 * 120 ** (5 / 3)
    assert s == pytest.approx(6.42e-3 * 140**-0.35 * both + rib)


@pytest.mark.slow
def test_friction_of_a_solution(solved):
    skf = bj.friction.skf_friction_torque
    found = skf(solved["spherical"], 2e-5, series="222E", diameters=(0.1, 0.18))
    assert found.rolling_torque.shape == (1,) and float(found.torque) > 0
    with pytest.raises(ValueError, match="`diameters` is None; it must be bore and"):
        skf(solved["toroidal"], 2e-5)
    turning = eqx.tree_at(lambda s: s.speed, solved["crossed"], SPEED, is_leaf=is_none)
    with pytest.raises(ValueError, match="no CrossedRollerRow; it must be one of"):
        skf(turning, 2e-5)
    assert bj.friction.skf_series(EXAMPLES["crossed"][0]) == ()


@pytest.mark.slow
def test_warnings_of_the_types(solved):
    """Spherical thrust bearings need axial load; spheres tilt as they like."""
    solution = solved["spherical thrust"]
    assert bj.warnings(solution) == [] == bj.warnings(solved["spherical"])
    (ends,) = bj.warnings(solved["cylindrical thrust"])
    assert ends.startswith("edge-loaded")
    much = eqx.tree_at(lambda s: s.force, solution, solution.force.at[6].set(4e4))
    (only,) = bj.warnings(much)
    assert only.startswith("radial load of 0.8 times the axial one: beyond 0.55")
    tilted = bj.solve_load(
        solved["spherical"].element,
        [2e4, 0, 5e3, 0, 0, 0],
        support=bj.Support(prescribed=dict(gx=0.03, gy=0.0)),
        speed=SPEED,
    )
    assert bj.warnings(tilted) == []


def test_mounted_clearance_of_rows_whose_clearance_is_radial():
    for row in (
        spherical(radial_internal_clearance=60e-6),
        toroidal(radial_internal_clearance=60e-6),
        crossed(radial_internal_clearance=60e-6),
    ):
        assert float(radial_clearance(row)) == pytest.approx(60e-6, rel=ROUNDING)
        new = with_radial_clearance(row, 20e-6)
        assert float(new.radial_internal_clearance) == pytest.approx(20e-6)
    for row in (flat(), spherical_thrust(), tapered_thrust()):
        with pytest.raises(TypeError, match="it must be a radial ball or roller"):
            radial_clearance(row)


def test_two_crossed_bearings_move_apart_as_their_shaft_grows():
    """By 40 K over half their distance; the rows of either stay together."""
    row = crossed()
    other = eqx.tree_at(lambda r: r.first_azimuth, row, row.first_azimuth + np.pi / 20)
    rows = [
        bj.SetRow(b, position=z, mirrored=mirrored)
        for z in (-0.1, 0.1)
        for b, mirrored in ((row, False), (other, True))
    ]
    pair = bj.BearingSet(tuple(rows))
    seats = bj.Mounting(0.25, 0.33, 0.5, 0.0, 0.0, ring_width=0.025)
    warm = bj.FitConditions(shaft=40.0, inner_ring=40.0)
    half = 0.1 * 40 * 12e-6
    shifts = np.asarray(row_shifts(pair, seats, warm))
    np.testing.assert_allclose(shifts, [-half, -half, half, half], rtol=ROUNDING)
    assert row_shifts(bj.BearingSet.crossed(row), seats, warm) == [0.0, 0.0]


SLOPES = {
    "spherical": ("contact_angle", "roller_profile_radius", "inner_raceway_radius"),
    "spherical thrust": ("contact_angle", "roller_profile_radius", "profile_offset"),
    "toroidal": ("roller_profile_radius", "outer_raceway_radius", "roller_length"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOPES)
def test_damage_has_the_derivatives_of_differences(name):
    """By numbers that the older types do not have, through the load solve."""
    made = {
        "spherical": lambda: spherical(7, 20 * _DEG, radial_internal_clearance=10e-6),
        "spherical thrust": lambda: spherical_thrust(7, profile_offset=1e-3, ribs=RIBS),
        "toroidal": lambda: toroidal(radial_internal_clearance=10e-6),
    }[name]()
    fields, (load, held) = SLOPES[name], CASES[name]
    start = np.array([float(getattr(made, f)) for f in fields])

    def damage(sizes):
        row = eqx.tree_at(lambda b: [getattr(b, f) for f in fields], made, list(sizes))
        bearing = bj.BearingSet.self_aligning(row) if name == "spherical" else row
        element = bj.BearingElement(bearing)
        solution = bj.solve_load(
            element,
            jnp.asarray(load, float),
            support=bj.Support(prescribed=held),
            throw=False,
        )
        life = bj.rating_life(solution)
        return jnp.stack([jnp.log(life.damage), jnp.log(life.basic_rating_life)])

    evaluate = with_slopes(damage)
    slopes = np.asarray(evaluate(start)[0])
    for k, size in enumerate(start):
        h = 1e-5 * size * np.eye(start.size)[k]
        high, low = (np.asarray(evaluate(start + s * h)[1]) for s in (1, -1))
        difference = (high - low) / (2e-5 * size)
        np.testing.assert_allclose(
            slopes[:, k] * size, difference * size, rtol=1e-5, atol=DIFFERENCE
        )


RIBS = bj.Ribs(inner_minus=bj.Rib(0.3, 2e-3))


def test_thrust_rollers_on_two_circles():
    """The rating of the set by hand; alike rows on one circle as ever (i^(7/9))."""
    inner = bj.CylindricalThrustRollerBearing(20, 0.078, 0.009, 0.008)
    outer = bj.CylindricalThrustRollerBearing(26, 0.098, 0.009, 0.008)
    both = bj.BearingSet((bj.design.SetRow(inner), bj.design.SetRow(outer)))
    c = [float(bj.dynamic_capacity(row)) for row in (inner, outer)]
    weights = np.array([20 * 8.0, 26 * 8.0])
    wanted = weights.sum() * np.sum((weights / np.array(c)) ** 4.5) ** (-2 / 9)
    assert float(bj.dynamic_capacity(both)) == pytest.approx(wanted, rel=ROUNDING)
    assert max(c) < wanted < sum(c)
    c0 = [float(bj.static_capacity(row)) for row in (inner, outer)]
    assert float(bj.static_capacity(both)) == pytest.approx(sum(c0), rel=ROUNDING)
    rated = bj.life.ratings(both)
    assert bool(rated.axial)
    assert float(rated.fatigue_load_limit) == pytest.approx(sum(c0) / 8.2, rel=ROUNDING)
    # The formula for unlike rows is that for alike ones where they are alike.
    nearly = eqx.tree_at(lambda row: row.roller_length, inner, 0.008 * (1 + 1e-7))
    pair = bj.BearingSet((bj.design.SetRow(inner), bj.design.SetRow(nearly, 0.02)))
    two = float(bj.dynamic_capacity(pair))
    assert two == pytest.approx(2 ** (7 / 9) * c[0], rel=1e-6)
    # Inside a compiled program too, in either order, and row by row.
    other = bj.BearingSet(both.rows[::-1])

    @jax.jit
    def found(bearing):
        rated = bj.life.ratings(bearing)
        rows = jnp.asarray(row_ratings(bearing, rated))
        return rated.dynamic_capacity, rated.fatigue_load_limit, rows

    for bearing, alone, static in ((both, c, c0), (other, c[::-1], c0[::-1])):
        dynamic, limit, rows = found(bearing)
        assert float(dynamic) == pytest.approx(wanted, rel=ROUNDING)
        assert float(limit) == pytest.approx(sum(c0) / 8.2, rel=ROUNDING)
        np.testing.assert_allclose(rows[:, 0], alone, rtol=ROUNDING)
        np.testing.assert_allclose(rows[:, 1], np.array(static) / 8.2, rtol=ROUNDING)
    turned = bj.design.SetRow(outer, 0.05, mirrored=True)
    with pytest.raises(ValueError, match="row 1 of the set is another bearing"):
        bj.dynamic_capacity(bj.BearingSet((bj.design.SetRow(inner), turned)))


def test_ratings_of_unlike_rows_are_nan_when_traced():
    """Where the numbers are not known, a set of alike rows is still rated."""
    row = bj.CylindricalThrustRollerBearing(20, 0.078, 0.009, 0.008)
    other = eqx.tree_at(lambda b: b.roller_length, row, jnp.asarray(0.007))
    capacity = jax.jit(lambda bearing: bj.life.ratings(bearing).dynamic_capacity)

    def pair(second):
        turned = bj.design.SetRow(second, 0.05, mirrored=True)
        return bj.BearingSet((bj.design.SetRow(row), turned))

    alone = float(bj.dynamic_capacity(row))
    assert float(capacity(pair(row))) == pytest.approx(alone, rel=ROUNDING)
    assert np.isnan(capacity(pair(other)))


@pytest.mark.slow
@pytest.mark.parametrize("order", (1, -1))
def test_rating_life_of_thrust_rollers_on_two_circles(order):
    inner = bj.CylindricalThrustRollerBearing(20, 0.078, 0.009, 0.008)
    outer = bj.CylindricalThrustRollerBearing(26, 0.098, 0.009, 0.008)
    rows = [bj.design.SetRow(row) for row in (inner, outer)][::order]
    element = bj.BearingElement(bj.BearingSet(tuple(rows)))
    load = np.array([0.0, 0.0, 30e3, 0.0, 0.0, 0.0])
    life = bj.rating_life(
        bj.solve_load(element, load, support=bj.Support(free=("uz",)))
    )
    capacity = float(bj.dynamic_capacity(element.bearing))
    assert float(life.dynamic_capacity) == pytest.approx(capacity, rel=ROUNDING)
    basic = 1e6 * (capacity / 30e3) ** (10 / 3)
    assert float(life.basic_rating_life) == pytest.approx(basic, rel=1e-9)


def test_unlike_rows_are_refused_before_they_are_solved():
    """By all that computes lives in compiled programs, where numbers are not known."""
    row = spherical_thrust()
    other = eqx.tree_at(lambda b: b.roller_length, row, row.roller_length * 0.9)
    rows = bj.design.SetRow(row), bj.design.SetRow(other, 0.1)
    element = bj.BearingElement(bj.BearingSet(rows))
    cases = bj.Cases(np.tile([0.0, 0.0, 1e4, 0.0, 0.0, 0.0], (2, 1)))
    words = "row 1 of the set is another bearing than row 0"
    with pytest.raises(ValueError, match=words):
        bj.sweep(element, cases, outputs=["damage"])
    path = "bearing.rows.0.bearing.roller_profile_radius"
    variable = bj.optimise.Variable(path, 0.1, 0.1019)
    measure = bj.optimise.RatingLife()
    with pytest.raises(ValueError, match=words):
        bj.optimise.optimise(element, cases, [variable], measure)
    seat = bj.shafts.Seat("A", "main", 0.0, bj.statics.Installed(element))
    ends = bj.shafts.Seat("B", "main", 0.1, stiffness=np.full(5, 1e8))
    shaft = bj.shafts.ShaftLine("main", [0.2], [0.05])
    system = bj.shafts.ShaftSystem([shaft], [seat, ends])
    with pytest.raises(ValueError, match=words):
        bj.shafts.ShaftDesign(system, (bj.LifeConditions(), None))
    with pytest.raises(ValueError, match=words):
        bj.shafts.solve_duty([system], [[bj.LifeConditions(), None]])

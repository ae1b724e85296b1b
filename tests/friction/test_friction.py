"""Friction torques and films by hand, of single rows and of a solved pair."""

import re
from types import SimpleNamespace

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.design.keywords import BALLS as BALL_TYPES
from bearingjax.design.keywords import ROLLERS as ROLLERS_BY_TYPE
from bearingjax.friction import SUPPLIES, friction_skf, skf_series_of
from bearingjax.friction.friction import _of_row, _row_loads, unit_loads
from bearingjax.lubrication import OILS

BALLS = {
    "n_balls": 9,
    "pitch_diameter": 0.0385,
    "ball_diameter": 0.00794,
    "outer_osculation": 0.53,
    "inner_osculation": 0.52,
}
DEEP = bj.DeepGrooveBallBearing(**BALLS)
ANGULAR = bj.AngularContactBallBearing(**BALLS, contact_angle=np.deg2rad(25))
ROLLERS = (13, 0.0385, 0.0075, 0.009)
CYLINDER = bj.CylindricalRollerBearing(*ROLLERS)
NEEDLE = bj.NeedleRollerBearing(13, 0.0385, 0.003, 0.009)
TAPER = bj.TaperedRollerBearing(*ROLLERS, roller_axis_angle=0.22, roller_half_angle=0.0)
PITCH = 38.5  # mm
VISCOSITY, SPEED = 30e-6, 3000 * np.pi / 30
FLOW = 30 * 3000.0  # mm²/s per minute
COT25, COT_TAPER = 1 / np.tan(np.deg2rad(25)), 1 / np.tan(0.22)

row = eqx.filter_jit(_of_row)


@pytest.mark.parametrize(
    "bearing, radial, axial, supply, load, viscous, flange",
    [
        # f1 F dm with C0 = 8 kN; f0 (ν n)^(2/3) dm³ 1e-7: all in N mm.
        (DEEP, 2000, 0, "oil_bath", 0.0006 * 0.25**0.55 * 2000, 2.0, 0),
        (DEEP, 1000, 800, "oil_mist", 0.0006 * 0.125**0.55 * 2300, 1.0, 0),
        (ANGULAR, 0, 800, "oil_jet", 0.001 * 0.038 ** (1 / 3) * 720 * COT25, 6.6, 0),
        (TAPER, 500, 900, "grease", 0.0004 * 720 * COT_TAPER, 6.0, 0),
        (CYLINDER, 2000, 300, "oil_bath", 0.0003 * 2000, 3.0, 0.006 * 300),
        (CYLINDER, 2000, 300, "grease", 0.0003 * 2000, 0.8, 0.009 * 300),
        (NEEDLE, 2000, 300, "oil_jet", 0.002 * 2000, 24.0, 0.006 * 300),
    ],
)
def test_a_row_by_hand(bearing, radial, axial, supply, load, viscous, flange):
    force = np.array([0.0, -radial, axial, 0.0, 0.0, 0.0], float)
    found = row(bearing, force, VISCOSITY * SPEED, supply, 8000.0)
    wanted = np.array(
        [load * PITCH, viscous * FLOW ** (2 / 3) * PITCH**3 * 1e-7, flange * PITCH]
    )
    # P0 of the angular contact bearing is 0.38 Fa at 25° (ISO 76).
    np.testing.assert_allclose(1e3 * np.array(found), wanted, rtol=1e-9)


def test_friction_torque_is_constant_below_viscosity_speed_2000():
    force = np.zeros(6)
    slow, edge = (
        float(row(DEEP, force, flow * 2 * np.pi / 60e6, "oil_bath", 8000.0)[1])
        for flow in (10.0, 2000.1)
    )
    assert 1e3 * slow == pytest.approx(160e-7 * 2.0 * PITCH**3, rel=1e-9)
    assert edge == pytest.approx(slow, rel=0.01)  # 2000^(2/3) is 158.7


@pytest.mark.parametrize("kind", friction_skf._TYPES)
def test_skf_constants_of_a_type_are_alike(kind):
    """No sign or power of ten of a series is off: each constant is within a few times
    the median of its type, but for the strong effect of thin rings on S2."""
    rows = np.array(list(friction_skf._TYPES[kind].series.values()))
    assert (rows > 0).all()
    apart = np.abs(np.log(rows / np.median(rows, axis=0)))
    assert (apart[:, [0]] < np.log(2.0)).all() and (apart < np.log(40.0)).all()


def test_skf_rolling_and_sliding_variables_by_hand():
    """G_rr and G_sl of SKF's tables for the constants 2, 3, 5 ..., in mm and N."""
    d, fr, fa, rpm, c0 = 40.0, 300.0, 200.0, 1500.0, 9e3
    turning = rpm**2 * d**4
    sine = np.sin(np.deg2rad(24.6 * (fa / c0) ** 0.24))
    whole = np.sin(np.deg2rad(24.6))
    cot = 0.4 * COT_TAPER * fa
    aligning = bj.design.SelfAligningBallRow(
        9, 0.0385, 0.00794, inner_osculation=0.53, row_offset=0.0045
    )
    thrust, third = bj.ThrustBallBearing(**BALLS), 1 / 3
    tiny = (5.0, 3.0, 2e-12, 7.0, 11.0, 3e-12)
    for bearing, row, axial, rolling, sliding in (
        (
            DEEP,
            (2.0, 3.0, 5.0, 7.0),
            fa,
            2 * d**1.96 * (fr + 3 / sine * fa) ** 0.54,
            5 * d**-0.145 * (fr**5 + 7 * d**1.5 / sine * fa**4) ** third,
        ),
        (
            DEEP,
            (2.0, 3.0, 5.0, 7.0),
            0.0,
            2 * d**1.96 * (fr + 3 / whole * 0.0) ** 0.54,
            5 * d**-0.26 * fr ** (5 / 3),
        ),
        (
            ANGULAR,
            tiny,
            fa,
            5 * d**1.97 * (fr + 2e-12 * turning + 3 * fa) ** 0.54,
            7 * d**0.26 * ((fr + 3e-12 * turning) ** (4 / 3) + 11 * fa ** (4 / 3)),
        ),
        (
            aligning,
            tiny,
            fa,
            5 * d**2 * (fr + 2e-12 * turning / d**0.5 + 3 * fa) ** 0.54,
            7
            * d**-0.12
            * ((fr + 3e-12 * turning / d**0.5) ** (4 / 3) + 11 * fa ** (4 / 3)),
        ),
        (
            thrust,
            (2.0, 3.0),
            fa,
            2 * d**1.83 * fa**0.54,
            3 * d**0.05 * fa ** (4 / 3),
        ),
        (
            CYLINDER,
            (2.0, 3.0, 5.0),
            fa,
            2 * d**2.41 * fr**0.31,
            3 * d**0.9 * fa + 5 * d * fr,
        ),
        (
            TAPER,
            (2.0, 3.0, 5.0, 7.0),
            fa,
            2 * d**2.38 * (fr + 3 * cot) ** 0.31,
            5 * d**0.82 * (fr + 7 * cot),
        ),
    ):
        found = friction_skf._variables(bearing, row, d, fr, axial, rpm, c0)
        np.testing.assert_allclose(found, [rolling, sliding], rtol=1e-9)


def test_skf_series_of_a_bearing():
    assert bj.friction.skf_series(ANGULAR) == ("other", "72B", "73B", "72AC", "73AC")
    assert bj.friction.skf_series(bj.BearingSet.tandem(TAPER, 0.02))[:2] == (
        "other",
        "302",
    )
    assert bj.friction.skf_series(NEEDLE) == ()


def test_skf_diameters_from_the_rolling_elements():
    """Mean diameter and D - d [mm]: those given, else of the pitch circle and of the
    size of an element."""
    kind = friction_skf._TYPES[type(DEEP)]
    assert kind.span is not None
    mean, apart = friction_skf._diameters(DEEP, kind, None)
    assert (mean, apart) == pytest.approx((38.5, kind.span * 7.94))
    # Of a 6205, whose balls these are: 25 by 52 mm.
    assert (mean, apart) == pytest.approx((38.5, 27.0), rel=0.1)
    given = friction_skf._diameters(DEEP, kind, (0.025, 0.052))
    assert tuple(map(float, given)) == pytest.approx((38.5, 27.0))


SERIES = {
    **{"6205-2RS1/C3": "62", "608": "60", "625/C3": "62", "688": "618", "693": "619"},
    **{"16005": "160", "6805": "618", "6905": "619", "6405": "64", "W 6205": "62"},
    **{"7208 BE": "72B", "7308 AC": "73AC", "7208 C": "other", "7308 A": "other"},
    **{"B7310-C-T-P4S": "other", "7005 CD": "other", "QJ 211": "QJ", "176211": "QJ"},
    **{"NU 205 ECP": "2", "NJ 2205 EC": "22", "N 310": "3", "1205 EK": "12"},
    **{"30205 J2": "302", "32010 X": "320", "32205 BJ2": "322B", "33213": "332"},
    **{"22208 E": "222E", "22220 EK/C3": "222E", "22228 CC": "222", "22316": "223E"},
    **{"22330 CC": "223", "24128 CCK30": "241", "C 3052": "30", "C 2205 K": "22"},
    **{"51108": "51", "51308": "51", "81107 TN": "81", "81216": "81"},
    **{"29412": "294E", "29317 E": "293E", "29230 E": "292E", "RB 25025": None},
    **{"22205/20 E": "222E", "21308 E": "213E", "320/28 X": "320"},
    **{"LM11949/LM11910": "other", "NA 4905": None, "3208 A": None},
}


@pytest.mark.parametrize("name", SERIES)
def test_skf_series_of_designations(name):
    assert skf_series_of(bj.catalogue_entry(name)) == SERIES[name]


UNLISTED = {
    "deep_groove_ball": "2 3 42 43 628 630 637 638 639",
    "self_aligning_ball": "112 130 139",
    "cylindrical_roller": "12 20",
    "spherical_roller": "238 248 249",
    "toroidal_roller": "32 39 40 41 49 59 60 69",
    "spherical_thrust_roller": "292 293",
}
"""Rows of SKF's table whose bearings are not of the catalogue."""


def test_every_row_of_skfs_table_is_reached_by_an_entry_or_its_series_is_not_listed():
    reached: dict[str, set] = {}
    for entry in bj.catalogue_entries():
        if not re.match(r"MR|S[AB]|U[CE]|1\d\d$|213\d\d CC", entry.designation):
            reached.setdefault(entry.type, set()).add(skf_series_of(entry))
        else:  # neither miniatures, inserts nor these are in the table
            assert skf_series_of(entry) is None
    for kind, found in reached.items():
        model = friction_skf._TYPES.get({**BALL_TYPES, **ROLLERS_BY_TYPE}[kind])
        rows = {None} if model is None else set(model.series)
        assert found <= rows, kind  # no entry without a row
        assert rows - found == set(UNLISTED.get(kind, "").split()), kind


def test_skf_friction_of_a_22208_e_has_the_constants_of_the_series_222_e():
    """At 3500 rpm, 13.2 mm²/s, Fr 5 kN, Fa 1 kN: by hand 319.7 N mm, of 222 400.9."""
    entry = bj.catalogue_entry("22208 E")
    model = friction_skf._TYPES[bj.design.SphericalRollerRow]
    row = bj.design.rows_of(bj.load_bearing(entry.designation))[0].bearing
    found = []
    for series in (skf_series_of(entry), "222"):
        assert series is not None
        given = model.series[series], 60.0, 5e3, 1e3, 3500.0, 1.0
        rolling, sliding = (float(x) for x in friction_skf._variables(row, *given))
        flow = 13.2 * 3500
        warm = 1.84e-9 * (3500 * 60) ** 1.28 * 13.2**0.64
        dry = np.exp(-2.6e-8 * flow**1.4 * 60)
        starved = np.exp(-3e-8 * flow * 120 * np.sqrt(5.5 / 80))
        torque = rolling * flow**0.6 * starved / (1 + warm)
        found.append(torque + (0.12 * dry + 0.05 * (1 - dry)) * sliding)
    assert found == pytest.approx([319.7, 400.9], abs=0.05)


@pytest.fixture(scope="module")
def pair():
    """A preloaded pair under an axial load, with its friction and films."""
    element = bj.BearingElement(bj.BearingSet.back_to_back(ANGULAR, 0.015, 20e-6))
    oil = OILS["ISO VG 46"]()

    @eqx.filter_jit
    def solve(element, load, speed):
        solution = bj.solve_load(
            element,
            load,
            support=bj.Support(free=["uz"]),
            speed=bj.Speed(speed),
            throw=False,
        )
        viscosity = oil.kinematic_viscosity(323.15)
        return (
            solution,
            bj.friction_torque(solution, viscosity),
            bj.films(solution, oil, 323.15, 0.2e-6),
            bj.friction.skf_friction_torque(
                solution, viscosity, diameters=(0.025, 0.052)
            ),
        )

    load = np.array([0.0, 0.0, 300.0, 0.0, 0.0, 0.0])
    return oil, *solve(element, load, SPEED)


@pytest.mark.slow
def test_rows_of_a_pair(pair):
    oil, solution, friction, *_ = pair
    assert bool(solution.converged)
    load, angle = np.asarray(solution.contact_load), np.asarray(solution.contact_angle)
    axial = (load * np.sin(angle))[:, 0].reshape(2, 9).sum(axis=1)
    # But for what balls that want to turn gyroscopically pass on by friction.
    assert axial[0] - axial[1] == pytest.approx(300.0, rel=1e-3)
    limit = float(bj.static_capacity(ANGULAR))
    factor = 0.001 * (0.38 * axial / limit) ** (1 / 3)
    torque = factor * 0.9 * axial * COT25 * 0.0385
    np.testing.assert_allclose(friction.load_torque, torque, rtol=1e-6)
    nu = 1e6 * float(oil.kinematic_viscosity(323.15))
    viscous = 3.3 * (nu * 3000) ** (2 / 3) * PITCH**3 * 1e-10
    np.testing.assert_allclose(friction.viscous_torque, 2 * [viscous], rtol=1e-9)
    total = torque.sum() + 2 * viscous
    assert float(friction.torque) == pytest.approx(total, rel=1e-6)
    assert float(friction.power) == pytest.approx(total * SPEED, rel=1e-6)


def test_row_loads_of_a_pair(pair):
    """Radial and axial resultant of each row, of loads that differ in every ball."""
    _, solution, *_ = pair
    load = 10.0 + np.arange(36.0).reshape(18, 2) ** 1.5
    angle = np.asarray(solution.contact_angle)[:, 0]
    azimuth = np.asarray(solution.azimuth)
    uneven = eqx.tree_at(lambda s: s.contact_load, solution, jnp.asarray(load))
    across = load[:, 0] * np.cos(angle)
    parts = [across * np.cos(azimuth), across * np.sin(azimuth)]
    parts.append(load[:, 0] * np.sin(angle))
    wanted = np.reshape(parts, (3, 2, 9)).sum(axis=2).T
    for (radial, axial, found), want in zip(unit_loads(uneven), wanted, strict=True):
        np.testing.assert_allclose(found, [*want, 0.0, 0.0, 0.0], rtol=1e-12)
        np.testing.assert_allclose(radial, np.hypot(*want[:2]), rtol=1e-12)
        np.testing.assert_allclose(axial, abs(want[2]), rtol=1e-12)


def test_row_loads_of_tapers():
    """At the angle of the outer raceway, half a cone above the axis of the roller."""
    half = np.arctan(0.0075 / 0.0385 * np.sin(0.22))
    cone = bj.TaperedRollerBearing(
        *ROLLERS, roller_axis_angle=0.22, roller_half_angle=half
    )
    pair = bj.BearingSet.back_to_back(cone, 0.015)
    load = np.linspace(1.0, 2.0, 52).reshape(26, 2)
    azimuth = np.arange(26) * 2 * np.pi / 13
    solution = SimpleNamespace(
        row_sizes=(13, 13),
        element=SimpleNamespace(bearing=pair),
        roller_load=jnp.asarray(load),
        azimuth=jnp.asarray(azimuth),
    )
    outer = load[:, 0].reshape(2, 13)
    across, azimuth = outer * np.cos(0.22 + half), azimuth.reshape(2, 13)
    x, y = across * np.cos(azimuth), across * np.sin(azimuth)
    wanted = np.stack([x, y, outer * np.sin(0.22 + half)]).sum(axis=2).T
    found = np.asarray(_row_loads(solution))
    np.testing.assert_allclose(found[:, :3], wanted, rtol=1e-12)


def test_rows_of_a_pair_by_skf(pair):
    """Single-row angular contact bearings: G_rr and G_sl as catalogue 10000 has them,
    the constants of those whose series is not listed."""
    oil, solution, *_, found = pair
    assert found.series == "other" and found.assumed  # no series was given
    load, angle = np.asarray(solution.contact_load), np.asarray(solution.contact_angle)
    axial = (load * np.sin(angle))[:, 0].reshape(2, 9).sum(axis=1)
    nu = 1e6 * float(oil.kinematic_viscosity(323.15))
    turning = 38.5**4 * 3000**2
    rolling = 5.03e-7 * 38.5**1.97 * (1.90e-12 * turning + 1.97 * axial) ** 0.54
    rolling *= (nu * 3000) ** 0.6 / (1 + 1.84e-9 * (3000 * 38.5) ** 1.28 * nu**0.64)
    rolling *= np.exp(-3e-8 * nu * 3000 * 77 * np.sqrt(4.4 / 54))
    both = (1.91e-12 * turning) ** (4 / 3) + 0.68 * axial ** (4 / 3)
    dry = np.exp(-2.6e-8 * (nu * 3000) ** 1.4 * 38.5)
    sliding = (0.12 * dry + 0.05 * (1 - dry)) * 1.3e-2 * 38.5**0.26 * both
    np.testing.assert_allclose(found.rolling_torque, 1e-3 * rolling, rtol=1e-6)
    np.testing.assert_allclose(found.sliding_torque, 1e-3 * sliding, rtol=1e-6)
    torque = 1e-3 * (rolling + sliding).sum()
    assert float(found.power) == pytest.approx(torque * SPEED, rel=1e-6)


def test_films_by_hand(pair):
    oil, solution, _, films, _ = pair
    load, angle = (
        np.asarray(x)[0] for x in (solution.contact_load, solution.contact_angle)
    )
    axes = np.asarray(solution.semi_axes)[0]
    ratio = axes[:, 1] / axes[:, 0]
    gamma = np.array([1.0, -1.0]) * 0.00794 / 0.0385 * np.cos(angle)
    radius = 0.5 * 0.00794 * (1 + gamma)
    orbit = float(solution.kinematics.orbit[0])
    speed = np.array([orbit, SPEED - orbit]) * 0.5 * 0.0385 * (1 + gamma)
    np.testing.assert_allclose(np.asarray(films.entrainment)[0], speed, rtol=1e-9)
    # Both surfaces roll alike, to the change of the contact angles with speed.
    assert speed[0] == pytest.approx(speed[1], rel=0.02)
    modulus = 206e9 / (1 - 0.3**2)  # E'
    mu = float(oil.viscosity(0.0, 323.15))
    g = modulus * float(oil.pressure_coefficient(323.15))
    u, w = mu * speed / (modulus * radius), load / (modulus * radius**2)
    least = 3.63 * u**0.68 * g**0.49 * w**-0.073 * (1 - np.exp(-0.68 * ratio)) * radius
    middle = 2.69 * u**0.67 * g**0.53 * w**-0.067 * (1 - 0.61 * np.exp(-0.73 * ratio))
    np.testing.assert_allclose(np.asarray(films.minimum)[0], least, rtol=1e-6)
    np.testing.assert_allclose(np.asarray(films.central)[0], middle * radius, rtol=1e-6)
    np.testing.assert_allclose(films.ratio, np.asarray(films.minimum) / 0.2e-6)


def test_friction_and_films_reject_invalid_arguments(pair):
    oil, solution, *_ = pair
    still = eqx.tree_at(lambda s: s.speed, solution, None)
    with pytest.raises(ValueError, match="friction_torque: `solution` is at rest"):
        bj.friction_torque(still, 30e-6)
    with pytest.raises(ValueError, match="films: `solution` is at rest; solve it"):
        bj.films(still, oil, 323.15)
    with pytest.raises(ValueError, match="`supply` is 'bath'.*grease, oil_mist"):
        bj.friction_torque(solution, 30e-6, "bath")
    with pytest.raises(ValueError, match="`viscosity` is 30 m²/s.*1 mm²/s is 1e-6"):
        bj.friction_torque(solution, 30.0)
    with pytest.raises(ValueError, match="`viscosity` is 0 m²/s"):
        bj.friction_torque(solution, 0.0)
    skf = bj.friction.skf_friction_torque
    with pytest.raises(ValueError, match="skf_friction_torque: `supply` is 'bath'"):
        skf(solution, 30e-6, "bath")
    with pytest.raises(ValueError, match="`series` is '62'; .* other, 72B, 73B"):
        skf(solution, 30e-6, series="62")
    with pytest.raises(ValueError, match="`oil` is 'olive'; .* mineral, synthetic"):
        skf(solution, 30e-6, oil="olive")
    with pytest.raises(ValueError, match="`diameters` is 0.02 m; .* the bore before"):
        skf(solution, 30e-6, diameters=(0.03, 0.02))
    with pytest.raises(ValueError, match="films: `roughness` is -1e-07 m"):
        bj.films(solution, oil, 323.15, -1e-7)
    assert len(SUPPLIES) == 4

"""What is doubtful: one list in Python, in sweeps and in optimisations."""

import dataclasses
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import balls, bearings
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.cases import sweep_table
from bearingjax.numerics.warning import Kind, exceeded_kinds
from bearingjax.statics import seat_warnings, speed_warnings
from bearingjax.statics.rollers import distribution
from bearingjax.statics.warning import sizes
from bearingjax.statics.warning_kinds import SOLUTION_KINDS
from bearingjax.statics.warning_sizes import (
    idle_numbers,
    number_ranges,
    travel_error,
    unloaded_rows,
)

STILL = bj.Speed(inner=0.0)


@pytest.fixture(scope="module")
def deep():
    bearing = balls(7, bj.DeepGrooveBallBearing, radial_internal_clearance=10e-6)
    return bj.BearingElement(bearing)


@pytest.fixture(scope="module")
def rollers():
    return bj.BearingElement(bearings()["cylindrical NUP, logarithmic"])


def changed(element, **numbers):
    """The element with other numbers of its design, by attribute."""
    for name, value in numbers.items():
        *path, last = name.split("__")

        def get(e, path=path, last=last):
            owner = e.bearing
            for part in path:
                owner = getattr(owner, part)
            return getattr(owner, last)

        # Of the same type, so that the same program serves.
        element = eqx.tree_at(get, element, jnp.asarray(value, float))
    return element


def solved(element, load, speed=STILL, **choices):
    return bj.solve_load(element, load, speed=speed, **choices)


def test_warnings_are_empty_for_usual_load(deep):
    assert bj.warnings(solved(deep, [0, -2000.0, 0, 0, 0, 0])) == []


def test_pressure_beyond_the_static_limit(deep):
    s = solved(deep, [0, -40e3, 300, 0, 0, 0])
    pressure = float(s.roller_pressure.max())
    assert pressure > 4.2e9
    elastic, static = (t for t in bj.warnings(s) if t.startswith("contact pressure"))
    assert elastic.startswith(f"contact pressure of {1e-6 * pressure:.5g} MPa")
    assert "inner raceway: balls " in elastic
    assert f"{pressure / 4.2e9:.4g} times that of the static load rating" in static
    assert static.endswith("ISO 76 (4200 MPa)")


def test_balls_out_of_the_load_zone_are_not_lifted(deep):
    """They lie on the outer raceway at any speed; it matters where they press there."""
    slow = solved(deep, [0, -2000.0, 0, 0, 0, 0], bj.Speed(inner=157.0))
    assert np.asarray(slow.lifted).sum() > 2 and bj.warnings(slow) == []
    fast = solved(deep, [0, -50.0, 0, 0, 0, 0], bj.Speed(inner=2000.0))
    (told,) = (t for t in bj.warnings(fast) if t.startswith("lifted off"))
    lifted = np.flatnonzero(np.asarray(fast.lifted))
    assert told.endswith(f"largest load: balls {number_ranges(lifted)}")
    # On both sides of the share that counts.
    top = float(slow.contact_load.max())
    for share, count in ((0.049, 0), (0.051, np.asarray(slow.lifted).sum())):
        force = jnp.full_like(slow.centrifugal_force, share * top)
        pressed = eqx.tree_at(lambda s: s.centrifugal_force, slow, force)
        assert float(sizes(pressed)["lifted_ball"]) == count


@pytest.mark.parametrize("speed", [0.0, 300.0, 2000.0])
def test_no_stiffness_whatever_the_speed(deep, speed):
    """Against its own largest stiffness, that of nothing, nothing is soft."""
    s = solved(deep, np.zeros(6), bj.Speed(inner=speed))
    (text,) = (t for t in bj.warnings(s) if t.startswith("no stiffness"))
    assert "ux, uy" in text and "of the inner ring" in text


def test_warnings_no_stiffness_from_unloaded_touching_rollers():
    """Loaded through one roller aslant of the axes the ring comes to rest against the
    next one, which is stiff from the first newton, but not loaded."""
    at = -1.17019755
    size = dict(radial_internal_clearance=10e-6, first_azimuth=at)
    bearing = bj.CylindricalRollerBearing(7, 0.0725, 0.014, 0.01372, **size)
    load = [np.cos(at), np.sin(at), 0, 0, 0, 0]
    s = bj.solve_load(bj.BearingElement(bearing), load)
    assert np.count_nonzero(s.load_zone) == 1
    (text,) = (t for t in bj.warnings(s) if t.startswith("no stiffness"))
    assert "in ux" in text


def test_warnings_are_empty_for_tenth_of_a_newton(deep):
    assert bj.warnings(solved(deep, [0, -0.1, 0.1, 0, 0, 0])) == []


@pytest.mark.parametrize(
    "numbers, named",
    [
        ({"material__elastic_modulus": 206e6}, "elastic_modulus 2.06e+08 Pa"),
        (
            {"pitch_diameter": 52.0, "ball_diameter": 9.5},
            "pitch_diameter 52 m, ball_diameter 9.5 m",
        ),
    ],
)
def test_warnings_dimensions_in_wrong_units(deep, numbers, named):
    s = solved(changed(deep, **numbers), [0, -2000.0, 300, 0, 0, 0], throw=False)
    assert s.converged
    (text,) = (t for t in bj.warnings(s) if t.startswith("far outside"))
    assert named in text


def test_warnings_contact_angle_beyond_groove(deep):
    """A moment that leans the ring on balls out of the load zone: they climb far."""
    loose = changed(deep, radial_internal_clearance=150e-6)
    s = solved(loose, [200.0, -2000.0, 0, 6.0, 0, 0], bj.Speed(inner=2000.0))
    loaded = np.asarray(s.contact_load) > 0
    angle = np.rad2deg(np.abs(np.asarray(s.contact_angle))[loaded].max())
    told = [t for t in bj.warnings(s) if t.startswith("contact angle")]
    assert (angle > 75.0) == bool(told)
    assert told and f"contact angle {angle:.3g} deg from" in told[0]


def test_tilts_beyond_small_rotations(deep):
    """Said is about the error that finite rotations show."""
    q = jnp.zeros(12).at[9].set(5e-3)
    finite = bj.BearingElement(deep.bearing, kinematics=bj.element.Finite())
    ours, true = (np.asarray(e.force(q))[9] for e in (deep, finite))
    s = solved(deep, [0, -2000.0, 300, 0, 0, 0])
    rows = deep.rows(q)
    approach = rows[0].map(lambda m, r, x: m.contacts(r, x)).approach
    s = eqx.tree_at(lambda s: (s.displacement, s.approach), s, (q, approach))
    (free,) = bj.warnings(s)  # tilts that are free follow the load
    assert free.startswith("the ring tilts freely, 5 mrad where makers of ball bearin")
    assert float(sizes(s)["free_tilt"]) == pytest.approx(5e-3 / np.deg2rad(10 / 60))
    s = dataclasses.replace(s, free=("ux", "uy", "uz"))
    text, held = bj.warnings(s)
    assert held == "tilt of 5 mrad where makers of ball bearings allow for about 2.9"
    assert text.startswith("tilt beyond small rotations")
    said = float(sizes(s)["tilt"])
    assert 0.5 < (ours / true - 1.0) / said < 2.0
    assert f"{100 * said:.2g} % of the approach" in text
    loose = eqx.tree_at(lambda s: s.element, s, finite)
    assert bj.warnings(loose) == [held]


def test_tilts_are_those_of_ring_against_ring(deep):
    """What is prescribed of one freedom and follows from the load in the other."""
    s = solved(deep, [0, -2000.0, 300, 0, 0, 0])
    q = jnp.zeros(12).at[jnp.array([3, 4, 9, 10])].set(jnp.array([1.0, 2, 4, 6]) * 1e-3)
    s = eqx.tree_at(lambda s: s.displacement, s, q)
    usual = np.deg2rad(10 / 60)
    for free, held in ((("gx", "gy"), 0.0), (("gx",), 4e-3), ((), 5e-3)):
        found = sizes(dataclasses.replace(s, free=("ux", "uy", "uz", *free)))
        assert float(found["prescribed_tilt"]) == pytest.approx(held / usual)


def test_unloaded_rows_are_counted_and_named(untyped):
    """Those in which no ball bears on both raceways, if any row bears."""
    single = balls(7, bj.AngularContactBallBearing, contact_angle=0.4)
    rows = bj.BearingSet.tandem(single, 0.03, 3)

    def state(load):
        element = SimpleNamespace(bearing=rows)
        given = dict(row_sizes=(7, 7, 7), element=element, result=jnp.asarray(0))
        return SimpleNamespace(roller_load=jnp.asarray(load), **given)

    load = np.zeros((21, 2))
    load[2], load[[7, 15], 0], load[20] = (5.0, 4.0), 3.0, (2.0, 1.0)
    assert float(unloaded_rows(state(load))) == 1
    assert idle_numbers(state(load)) == "row 1"
    load[20, 1] = 1e-10
    assert float(unloaded_rows(state(load))) == 2
    assert idle_numbers(state(load)) == "row 1, 2"
    assert float(unloaded_rows(state(0.0 * load))) == 0


@pytest.mark.parametrize("ring, side", [(0, -1.0), (1, 1.0)])
def test_travel_across_toroidal_rollers_by_hand(ring, side, untyped):
    """A ring that turns about the middle of the bearing moves its arcs sideways: by
    w²/2A over the approach 2.5 b²/ρ, A the distance of the centres of the arcs, and by
    w/A over no contact angle, so that 1 is taken for its tangent."""
    row = bj.ToroidalRollerBearing(
        4, 0.1, 0.02, 0.03, roller_profile_radius=0.09,
        outer_raceway_radius=0.1, inner_raceway_radius=0.1,
        radial_internal_clearance=0.0,
    )  # fmt: skip
    q = np.zeros(12)
    q[6 * ring : 6 * ring + 6] = [1e-5, 2e-5, 30e-5, 4e-4, 5e-4, 0.0]
    solution = SimpleNamespace(
        displacement=jnp.asarray(q),
        roller_pressure=jnp.full((4, 2), 1e9),
        row_sizes=(4,),
        element=SimpleNamespace(bearing=row),
        result=jnp.asarray(0),
        force=jnp.zeros(12),
    )
    lever = abs(0.05 + side * (0.1 - 0.01))
    across = 30e-5 + lever * np.hypot(4e-4, 5e-4)
    modulus = 206e9 / 2 / (1 - 0.3**2)
    turned = across / (0.1 + 0.1 - 0.02)
    approach = 2 * 5.0 * 0.02 * (1e9 / modulus) ** 2
    wanted = 0.5 * across * turned / approach + turned
    found = float(travel_error(solution))
    assert found == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("kind", ["deep", "rollers"])
def test_negative_clearance_by_its_size(kind, request):
    """Of a bearing that turns; what the solution has besides is kept."""
    usual = solved(request.getfixturevalue(kind), [0, -2000.0, 0, 0, 0, 0])

    def changed_solution(clearance, speed):
        return eqx.tree_at(
            lambda s: (s.element.bearing.radial_internal_clearance, s.speed.inner),
            usual,
            (jnp.asarray(clearance), jnp.asarray(speed)),
        )

    for clearance, speed, size in ((-5e-6, 100.0, 5e-6), (-5e-6, 0.0, 0.0)):
        pressed = changed_solution(clearance, speed)
        assert float(sizes(pressed)["negative_clearance"]) == pytest.approx(size)
        told = [t for t in bj.warnings(pressed) if "clearance" in t]
        words = "runs with a radial clearance of -5 µm"
        assert len(told) == (size > 0) and all(words in text for text in told)
    assert float(sizes(changed_solution(5e-6, 100.0))["negative_clearance"]) < 0


@pytest.mark.slow
def test_warnings_negative_clearance_of_single_bearing(deep, rollers):
    """Not one at rest, nor a set, whose rows press each other on purpose."""
    load, running = [0, -2000.0, 300, 0, 0, 0], bj.Speed(inner=100.0)
    for element in (deep, rollers):
        name = "radial_internal_clearance"
        kept = dict(support=bj.Support(prescribed={"gx": 0.0, "gy": 0.0}))
        pressed = changed(element, **{name: -5e-6})
        (text,) = bj.warnings(solved(pressed, load, running, **kept))
        assert text.startswith("runs with a radial clearance of -5 µm")
        assert bj.warnings(solved(pressed, load, STILL, **kept)) == []
        usual = changed(element, **{name: 5e-6})
        assert bj.warnings(solved(usual, load, running, **kept)) == []
    applies = SOLUTION_KINDS["negative_clearance"].applies
    single = balls(7, bj.AngularContactBallBearing, contact_angle=0.4)
    pair = bj.BearingSet.back_to_back(single, 0.03)
    for bearing in (single, pair, bearings()["taper, large rib"]):
        assert not applies(bj.BearingElement(bearing), running)


def seats(shaft, housing, stress=50e6):
    return SimpleNamespace(
        shaft_interference=1e-6 * shaft,
        housing_interference=1e-6 * housing,
        ring_stress=stress,
    )


@pytest.mark.parametrize(
    "fixed_to, inner, outer, creeping",
    [
        ("space", 100.0, 0.0, "inner"),
        ("space", 0.0, 100.0, "outer"),
        ("space", -50.0, 100.0, "both"),
        ("inner", 100.0, 0.0, "outer"),
        ("outer", 0.0, 100.0, "inner"),
        ("space", 0.0, 0.0, ""),
        ("space", 100.0, 100.0, ""),
    ],
)
def test_seat_warnings_of_creeping_rings(fixed_to, inner, outer, creeping, untyped):
    asked = dict(speed=bj.Speed(inner, outer), load_fixed_to=fixed_to)
    told = seat_warnings(seats(-2, -3), seats(-4, -5), seats(-8, -9), **asked)
    expected = [
        f"fit: the {ring} ring{seat} turns against the load and is loose by"
        f" {size} µm in operation: it creeps and wears its seat"
        for ring, seat, size in (("outer", "", 5), ("inner", " on its shaft", 4))
        if creeping in (ring, "both")
    ]
    assert told == expected
    (tight, *rest) = seat_warnings(seats(4, 4), seats(2, 2), seats(-1, -1), **asked)
    assert "loose in operation, by 1 µm, at the loosest" in tight
    assert len(rest) == (creeping in ("outer", "both"))
    assert seat_warnings(seats(4, 4), seats(2, 2), **asked) == []
    # Round-off is neither tight nor loose.
    about = dict(speed=bj.Speed(0.0, 0.0))
    assert seat_warnings(seats(3e-6, 3e-6), seats(-3e-6, -3e-6), **about) == []


def test_speeds_beyond_those_of_a_catalogue():
    rpm = np.pi / 30
    limits = dict(limiting_speed=18e3 * rpm, reference_speed=28e3 * rpm)
    assert speed_warnings(-18e3 * rpm * 0.999, **limits) == []
    (only,) = speed_warnings(-20e3 * rpm, **limits)
    assert only.startswith("speed of 20000 rpm, above the limiting speed") and (
        "18000 rpm" in only and "case" not in only
    )
    both = speed_warnings(np.array([1e3, 3e4, 2e4]) * rpm, **limits)
    assert [text.partition(" of the cat")[0] for text in both] == [
        "speed of 30000 rpm, above the limiting speed",
        "speed of 30000 rpm, above the reference speed",
    ]
    assert both[0].endswith("in 2 of 3 cases, worst case 1")
    assert speed_warnings(1e9) == []


def test_warnings_speed_factor_above_grease_limit(deep):
    fast = bj.Speed(inner=2500.0)  # 24 000 rpm of 52 mm
    (text,) = (
        t
        for t in bj.warnings(solved(deep, [0, -2000.0, 900, 0, 0, 0], fast))
        if t.startswith("n·dm")
    )
    assert text.startswith(f"n·dm of {52 * 2500 * 30 / np.pi:.3g} mm/min")


def test_warnings_rib_interference(rollers):
    ribs = {f"ribs__{name}__axial_gap": -5e-6 for name in rollers.bearing.ribs.present}
    load = [0, -4000.0, 300, 0, 0, 0]
    assert bj.warnings(bj.solve_load(rollers, load)) == []
    (text,) = bj.warnings(bj.solve_load(changed(rollers, **ribs), load))
    assert text.startswith("ribs press on the roller ends: 5 µm of interference")


def test_warnings_edge_loading_ignores_light_pressure(rollers):
    """So too that of rollers which pass no load: thrown on one raceway by their weight
    they may lie there as they like."""
    s = bj.solve_load(rollers, [0, -4000.0, 300, 0, 0, 0])
    load = np.array(s.roller_load)
    top, idle = int(load.min(axis=1).argmax()), int(load.min(axis=1).argmin())
    load[idle] = 0.3, 0.0

    def at_end(roller, pressure):
        ends = jnp.zeros_like(s.edge_pressure).at[roller, 0, 1].set(pressure)
        return eqx.tree_at(
            lambda s: (s.roller_load, s.edge_pressure), s, (jnp.asarray(load), ends)
        )

    light, heavy, thrown = at_end(top, 8e6), at_end(top, 8e8), at_end(idle, 343.6e6)
    assert not light.edge_loaded.any() and bj.warnings(light) == []
    assert thrown.edge_loaded.any() and bj.warnings(thrown) == []
    (text,) = bj.warnings(heavy)
    assert text.startswith("edge-loaded roller: 800 MPa")
    assert f"(outer raceway: roller {top})" in text


def test_warnings_are_empty_for_failed_solution(rollers):
    s = bj.solve_load(rollers, [0, np.nan, 0, 0, 0, 0], throw=False)
    assert bj.warnings(s) == []


def test_traced_solutions_are_refused(rollers):
    s = bj.solve_load(rollers, [0, -4000.0, 0, 0, 0, 0])
    with pytest.raises(TypeError, match="traced"):
        jax.jit(lambda x: jnp.asarray(len(bj.warnings(x))))(s)


LOADS = np.array(
    [
        [0, -2000.0, 300, 0, 0, 0],
        [0, -40e3, 300, 0, 0, 0],
        [0, np.nan, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, 0],
        [0, -60e3, 300, 0, 0, 0],
    ]
)


def test_sweep_warnings_match_single_solutions(deep):
    cases = bj.Cases(LOADS, inner_speed=0.0)
    swept = bj.sweep(deep, cases, outputs=["largest_load"])
    for k, load in enumerate(LOADS):
        single = sizes(solved(deep, load, throw=False))
        assert set(single) == set(swept.warning_sizes)
        for name, size in single.items():
            assert swept.warning_sizes[name][k] == pytest.approx(
                float(size), rel=1e-6, nan_ok=True
            )
    counts = swept.warning_counts()
    assert counts["contact_pressure"] == 2 and counts["no_stiffness"] == 1
    texts = swept.warnings
    assert len(texts) == len(counts)
    (text,) = (t for t in texts if t.startswith("contact pressure of "))
    assert text.endswith(", in 2 of 5 cases, worst case 4")
    assert f"{1e-6 * swept.warning_contact_pressure[4]:.5g} MPa" in text
    column = sweep_table.columns(swept)["warnings"]
    assert column[0].startswith("free_tilt=") and column[2] == ""
    assert column[3].startswith("no_stiffness=")
    said = f"contact_pressure={swept.warning_contact_pressure[1]:.6g}"
    assert said in column[1].split("; ")
    # Solutions with a case axis, as an optimisation has them, say the same.
    both = jax.tree.map(
        lambda *leaves: jnp.stack(leaves),
        *(solved(deep, load, throw=False) for load in LOADS),
    )
    assert len(bj.warnings(both)) == len(counts)
    assert set(swept.warning_sizes) <= set(SOLUTION_KINDS)


def test_message_for_displacement_far_outside_the_bearing(deep):
    """Not "no load path": nothing is to be turned round."""
    load = [0, -2000.0, 300, 0, 0, 0]
    for given, speed in ((1e9, STILL), (1.0, bj.Speed(inner=1e11))):
        s = solved(deep, given * np.array(load), speed, throw=False)
        assert bj.Result(int(s.result)) is bj.Result.NON_FINITE
        text = s.failure_message
        assert "far outside the bearing" in text and "turn the load" not in text
    # Where nothing holds the load that is still the word.
    off = bj.solve_load(deep, [0, 0, 0, 0, 0, 5.0], speed=STILL, throw=False)
    assert bj.Result(int(off.result)) is bj.Result.NO_LOAD_PATH


def test_solve_load_ignores_distant_start(deep):
    load = [0, -2000.0, 300, 0, 0, 0]
    near = solved(deep, load)
    far = solved(deep, load, start=[1.0, 0, 0, 0, 0, 0])
    assert far.converged
    assert np.allclose(far.displacement, near.displacement, rtol=1e-9, atol=1e-15)


def test_step_limit_message_suggests_other_method_only(rollers):
    wide = changed(rollers, radial_internal_clearance=-1e-3)
    s = bj.solve_load(wide, [0, -4000.0, 0, 0, 0, 0], throw=False)
    if not s.converged:
        assert "Newton" not in s.failure_message
    limit = eqx.tree_at(lambda s: s.result, s, jnp.asarray(1, jnp.int32))
    assert "Newton" not in limit.failure_message
    other = eqx.tree_at(lambda s: s.element.equilibrium, limit, bj.numerics.BFGS())
    assert "Newton's method" in other.failure_message


@pytest.mark.parametrize("name", ["cylindrical, crowned ends", "taper, large rib"])
@pytest.mark.slow
def test_peak_pressure_is_independent_of_positions(name):
    """Rollers that tilt: the peak stands off the middle, at a kink or beyond one."""
    element = bj.BearingElement(bearings()[name])
    q = jnp.zeros(12).at[7].set(-25e-6).at[8].set(20e-6).at[9].set(6e-4)
    (row,) = element.rows(q)
    along = eqx.filter_jit(distribution)
    peaks = [np.asarray(along(row, n).roller_pressure) for n in (1, 2, 3, 101)]
    for peak in peaks[1:]:
        assert np.allclose(peak, peaks[0], rtol=ROUNDING, atol=0.0)
    fine = np.asarray(along(row, 20001).contact_pressure).max(axis=2)
    assert fine.max() > 1e9
    assert np.allclose(peaks[0], fine, rtol=1e-4, atol=1.0)  # as `rollers._SCAN` says
    # Both ends, also of a single position.
    ends = np.asarray(along(row, 3).line_load)[..., [0, 2]]
    assert np.allclose(along(row, 1).edge_load, ends, rtol=ROUNDING, atol=0.0)


@pytest.mark.slow
def test_balls_beyond_the_bottom_of_their_groove():
    """Pushed past it against its contact angle, the ball runs on the land; before,
    its contact ellipse reaches over the bottom."""
    element = bj.BearingElement(balls(12))
    b = element.bearing
    bottom = float(b.centre_distance) * np.sin(float(b.contact_angle))
    held = {"gx": 0.0, "gy": 0.0}
    for share, told in ((0.3, False), (0.8, True), (1.2, True)):
        uz = {"uz": -share * bottom}
        s = bj.solve_load(
            element, [0, -1500, 0, 0, 0, 0], support=bj.Support(prescribed=held | uz)
        )
        texts = [t for t in bj.warnings(s) if t.startswith("balls beyond the bottom")]
        assert bool(texts) is told
    load = np.asarray(s.contact_load)
    loaded = np.flatnonzero(load[:, 1] > 0.05 * load.max())
    assert f"inner raceway: balls {number_ranges(loaded)};" in texts[0]


def test_numbers_in_a_row_are_listed_by_their_ends():
    assert number_ranges(np.array([0, 1, 2, 10, 11, 13])) == "0 to 2, 10, 11, 13"
    assert number_ranges(np.array([4])) == "4"


def test_kinds_that_cases_exceed():
    """One `of_all` is left out where a case is below; failed cases do not count."""
    kinds = {
        "every": Kind(1.0, "", of_all=True),
        "some": Kind(4.0, ""),
    }
    sizes = {"some": np.array([4.0, 5.0, np.nan]), "every": np.array([2.0, 0.0, 3.0])}
    (told,) = exceeded_kinds(sizes, kinds).items()
    assert told[0] == "some" and told[1].tolist() == [False, True, False]
    sizes["every"] = np.array([2.0, np.nan, 3.0])
    assert [*exceeded_kinds(sizes, kinds)] == ["every", "some"]
    with pytest.raises(KeyError, match="no kind of warning is called life"):
        exceeded_kinds({"life": np.zeros(3)}, kinds)

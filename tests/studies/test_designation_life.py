"""What a designation brings to [life], and to [fit] if `new` has restated it."""

import json
from typing import Any

import equinox as eqx
import jax
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.life import ratings
from bearingjax.studies.bearing.life_ratings import (
    life_conditions,
    rating_origins,
    why_not_published,
)
from bearingjax.studies.bearing.life_report import ratings_as_dict
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.noise.read import read_noise
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.rotor.read import read_rotor
from bearingjax.studies.rotor.run import task_warnings
from bearingjax.studies.skid.read import read_skid

LOAD = '[operating]\nload = { Fy = "-1 kN" }\n'


@pytest.fixture
def read(tmp_path):
    def made(bearing, more="", settings=()):
        path = tmp_path / "scene.toml"
        path.write_text(f"[bearing]\n{bearing}\n{LOAD}{more}", encoding="utf-8")
        return bj.read_scene(path, settings)

    return made


NAMES = ("dynamic_capacity", "static_capacity", "fatigue_load_limit")


def rate(scene) -> Any:
    given = (getattr(scene.life, name, None) for name in NAMES)
    return ratings(scene.element.bearing, *given)


def rated(scene) -> tuple[Any, ...]:
    """C, C0 and Pu that are given or published; `None` of those from the geometry."""
    found = rate(scene)
    counts = found.given | np.asarray(found.published)[:3]
    pairs = zip(NAMES, counts, strict=True)
    return tuple(float(getattr(found, name)) if yes else None for name, yes in pairs)


def told(scene, rated) -> dict[str, Any]:
    """Ratings as the JSON of `solve` and `life` has them."""
    return ratings_as_dict(jax.device_get(rated), rating_origins(scene, rated))


COMPILED = ("deep_groove_ball", "spherical_roller", "thrust_ball")


def test_python_and_commands_rate_the_same(read):
    """Both rate the same bearing, of 39 designations of all 13 types and one without
    printed ratings; some are rated, the others would only compile more."""
    entries = bj.catalogue_entries()
    of_type = {entry.type: [] for entry in entries}
    for entry in entries:
        of_type[entry.type].append(entry)
    chosen = [of[k] for of in of_type.values() for k in (0, len(of) // 2, -1)]
    assert len(chosen) >= 39
    for entry in (*chosen, bj.catalogue_entry("7308 C")):
        scene = read(f'designation = "{entry.designation}"', "[life]\n")
        own: Any = bj.load_bearing(entry.designation)
        assert eqx.tree_equal(own, scene.running().bearing), entry.designation
        given = [getattr(life_conditions(scene), name) for name in NAMES]
        assert given == 3 * [None]
        printed = [getattr(entry, name) or 0.0 for name in NAMES]
        carried = bj.design.rows_of(own)[0].bearing.published
        held = 3 * [0.0] if carried is None else np.asarray(carried.ratings).tolist()
        assert held == printed
        if entry.type in COMPILED:
            by_python, by_command = (
                told(scene, ratings(one))
                for one in (bj.BearingElement(own).bearing, scene.element.bearing)
            )
            assert by_python == by_command
            for name, number in zip(NAMES, printed, strict=True):
                assert (by_python[f"{name}_source"] == "published") == (number > 0.0)
                assert number in (0.0, pytest.approx(by_python[name], rel=1e-12))


@pytest.mark.slow
def test_life_of_22220_E_from_python_and_from_the_command(read, run, tmp_path):
    """One life, that of the published C, not that of the formulas (374 kN)."""
    scene = read('designation = "22220 E"', "[life]\n")
    out = tmp_path / "out.json"
    assert run("solve", tmp_path / "scene.toml", "--json", out).status == 0
    found = json.loads(out.read_text(encoding="utf-8"))
    element = bj.BearingElement(bj.load_bearing("22220 E"))
    options = bj.statics.SolveOptions(points=scene.points)
    solution = bj.solve_load(element, list(scene.load), options=options)
    life = bj.rating_life(element, solution)
    own = bj.catalogue_entry("22220 E").dynamic_capacity
    assert found["dynamic_capacity"] == pytest.approx(own, rel=1e-12)
    for name, number in told(scene, life.ratings).items():
        assert found[name] == number
    for name in ("basic_rating_life", "reference_rating_life"):
        assert found[name] == pytest.approx(float(getattr(life, name)), rel=1e-6)


def test_published_ratings_count_unless_given(read):
    entry = bj.catalogue_entry("6205")
    scene = read('designation = "6205"', "[life]\n")
    own = (entry.dynamic_capacity, entry.static_capacity, entry.fatigue_load_limit)
    assert rated(scene) == own
    # What says nothing of the ratings leaves them, what is said in [life] counts.
    scene = read(
        'designation = "6205"\nradial_internal_clearance = "3 um"\n',
        '[life]\ndynamic_capacity = "15 kN"\n',
    )
    assert rated(scene) == (15e3, *own[1:])


@pytest.mark.slow
def test_another_geometry_is_rated_by_the_standards(read):
    scene = read('designation = "6205"\nn_balls = 8', "[life]\n")
    assert rated(scene) == (None, None, None)
    assert why_not_published(scene) == [
        "  (not the published ones of 6205: n_balls differs)"
    ]
    scene = read('designation = "6205"', "[life]\n")
    (line,) = why_not_published(scene, ["bearing.ball_diameter"])
    assert "6205: ball_diameter differs" in line
    harmless = ["bearing.radial_internal_clearance", "operating.load.Fy"]
    assert rated(scene)[0] == bj.catalogue_entry("6205").dynamic_capacity
    assert why_not_published(scene, harmless) == []


def test_not_published_lists_unprinted_ratings(read):
    scene = read('designation = "7308 C"', "[life]\n")
    assert rated(scene) == (None, None, None)
    (line,) = why_not_published(scene)
    assert "those of 7308 C are not known for this contact angle; from the" in line
    given = read('designation = "7308 C"', '[life]\ndynamic_capacity = "32 kN"\n')
    assert why_not_published(given) == []


def test_a_pair_is_rated_as_two_rows(read):
    entry = bj.catalogue_entry("7208B")
    own = entry.dynamic_capacity, entry.static_capacity, entry.fatigue_load_limit
    pair = '[set]\narrangement = "back_to_back"\nspacing = "18 mm"\n'
    scene = read('designation = "7208B"', pair)
    # ISO 281, 5.1.2.2: two rows bear 2^0.7 of what one bears.
    wanted = [f * v for f, v in zip((2**0.7, 2, 2), own, strict=True) if v is not None]
    assert rated(scene) == pytest.approx(wanted, rel=1e-12)
    words = "published for 7208 BE, of one row; for 2 rows "
    listed = "7208B is listed as 7208 BE"
    assert rating_origins(scene, rate(scene)) == {
        "dynamic_capacity": f"{words}by ISO 281; {listed}",
        "static_capacity": f"{words}by ISO 76; {listed}",
        "fatigue_load_limit": f"{words}in proportion to C0; {listed}",
    }


def test_who_gave_a_rating_is_told(read):
    given = '[life]\ndynamic_capacity = "15 kN"\n'
    scene = read('designation = "6205/C3"', given)
    assert rating_origins(scene, rate(scene)) == {
        "dynamic_capacity": "given in [life]",
        "static_capacity": "published for 6205/C3",
        "fatigue_load_limit": "published for 6205/C3",
    }
    # Worked out from the geometry, what is not given in [life].
    other = read('designation = "6205"\nn_balls = 8', given)
    assert list(rating_origins(other, rate(other))) == ["dynamic_capacity"]


def test_rated_capacity_of_self_aligning_bearing_covers_both_rows(read):
    entry = bj.catalogue_entry("1205")
    assert rated(read('designation = "1205"'))[0] == entry.dynamic_capacity


def test_clearance_restating_catalogue_keeps_class(read):
    fit = '[fit]\nshaft = "k5"\nhousing = "H7"\nhousing_diameter = "80 mm"\n'
    restated = 'designation = "6205"\nradial_internal_clearance = "12.5 um"'
    limits = read(restated, fit).installed.limits.clearance
    assert tuple(limits) == pytest.approx((5e-6, 20e-6))
    limits = read(restated, fit, ["fit.clearance=C3"]).installed.limits.clearance
    assert tuple(limits) == pytest.approx((13e-6, 28e-6))
    with pytest.raises(bj.SceneError, match=r"`fit.clearance`: stands beside"):
        read(restated.replace("12.5", "3"), fit, ["fit.clearance=C3"])


CATALOGUED = """
[bearing]
designation = "7208 B"
[fit]
shaft_interference = "0 um"
housing_interference = "0 um"
housing_diameter = "120 mm"
[cases.grid]
"""


def cases(tmp_path, text):
    path = tmp_path / "cases.toml"
    path.write_text(text, encoding="utf-8")
    return read_cases(path)


LIMIT = round((bj.catalogue_entry("6205").limiting_speed or 0.0) * 30.0 / np.pi)
"""Limiting speed of a 6205 [rpm]; printed ones are the case `skf_catalogue`."""


def test_speeds_are_held_against_those_of_the_catalogue(read, tmp_path):
    """Of a 6205, in one load, cases and searches."""
    bearing = 'designation = "6205"'
    slow, fast = (
        read(bearing, "", [f"operating.inner_speed={LIMIT + n} rpm"]) for n in (-10, 10)
    )
    assert slow.warnings == ()
    (told,) = fast.warnings
    words = f"speed of {LIMIT + 10} rpm, above the limiting speed of the catal"
    assert told.startswith(words)
    both = ["operating.inner_speed=17000 rpm", "operating.outer_speed=-2000 rpm"]
    (told,) = read(bearing, "", both).warnings
    assert told.startswith("speed of 19000 rpm")
    text = f"[bearing]\n{bearing}\n{LOAD}[cases.grid]\n"
    text += 'operating.inner_speed = ["1000 rpm", "20000 rpm", "19000 rpm"]\n'
    told = cases(tmp_path, text).warnings
    assert len(told) == 1 and told[0].endswith("in 2 of 3 cases, worst case 1")
    text += '[optimise]\nobjective = "peak_pressure"\n[optimise.variables]\n'
    text += '"bearing.inner_osculation" = { from = 0.51, to = 0.54 }\n'
    path = tmp_path / "found.toml"
    path.write_text(text, encoding="utf-8")
    assert read_optimisation(path).scene.warnings == told


FAST = {
    "skid": (
        '[lubricant]\nname = "MIL-L-23699"\ntemperature = "70 °C"\n'
        '[dynamics]\nduration = "1 s"\nramp = "10 s"\n[cage]\n',
        lambda path: read_skid(path, steady=True).warnings,
        lambda path: read_skid(path).warnings,
    ),
    "noise": (
        '[vibration]\nmass = "0.1 kg"\n',
        lambda path: read_noise(path).warnings,
        lambda path: read_noise(path, ["operating.inner_speed=2000 rpm"]).warnings,
    ),
    "rotor": (
        '[rotor]\nspeed = "20000 rpm"\n[[rotor.shaft]]\nlength = "100 mm"\n'
        'outer_diameter = "25 mm"\ndivisions = 2\n'
        '[[rotor.bearings]]\nstation = 1\nbearing = "own"\n'
        '[bearings.own]\ndesignation = "6205"\n',
        lambda path: task_warnings(read_rotor(path)),
        lambda path: task_warnings(read_rotor(path, ["rotor.speed=2000 rpm"])),
    ),
}


@pytest.mark.parametrize("command", FAST)
def test_every_command_tells_the_speeds_of_the_catalogue(command, tmp_path):
    """Of a motion in time, the speed that it reaches."""
    table, fast, slow = FAST[command]
    bearing = f'[bearing]\ndesignation = "6205"\n{LOAD}inner_speed = "20000 rpm"\n'
    path = tmp_path / f"{command}.toml"
    text = table if command == "rotor" else bearing + table
    path.write_text(text, encoding="utf-8")
    words = "speed of 20000 rpm, above the limiting speed of the catalogue,"
    (told,) = (line for line in fast(path) if "catalogue" in line)
    assert told.removeprefix("own: ").startswith(f"{words} {LIMIT} rpm")
    assert not any("catalogue" in line for line in slow(path))


def test_cases_at_rest_say_that_raceway_control_does_nothing(tmp_path):
    text = '[bearing]\ndesignation = "6205"\n[operating]\nraceway_control = "inner"\n'
    text += 'load.Fx = "1 kN"\n[cases.grid]\noperating.inner_speed = '
    for speeds, count in ('["0 rpm"]', 1), ('["0 rpm", "9 rpm"]', 0):
        kinds = [one.kind for one in cases(tmp_path, text + speeds).warnings]
        assert kinds.count("unused_control") == count


def test_sweep_over_designations_limiting_speed_warnings(tmp_path):
    text = f'[bearing]\ndesignation = "6205"\n{LOAD}inner_speed = "12000 rpm"\n'
    text += '[cases.grid]\nbearing.designation = ["6205", "6210", "6206"]\n'
    told = [line for line in cases(tmp_path, text).warnings if "limiting" in line]
    assert len(told) == 1 and told[0].endswith("in 1 of 3 cases, worst case 1")


def test_sweep_over_designations_ratings(tmp_path):
    names = ["7208 BE", "7210 BE", "7308 C"]
    table = cases(tmp_path, f"{CATALOGUED}bearing.designation = {names}")
    assert [made["bearing.designation"] for made in table.settings] == names
    found = {
        names[number]: rated(part.scene)[0]
        for part in table.design_groups
        for number in np.asarray(part.designs)
    }
    assert found == {n: bj.catalogue_entry(n).dynamic_capacity for n in names}
    assert found["7308 C"] is None  # from the geometry


def test_sweep_over_row_count_ratings(tmp_path):
    tandem = '[set]\narrangement = "tandem"\nspacing = "18 mm"\n'
    text = CATALOGUED.replace("[cases", tandem + "[cases")
    counts = "{ start = 1, stop = 2, count = 2 }"
    table = cases(tmp_path, f"{text}set.count = {counts}")
    one, two = (rated(part.scene)[0] for part in table.design_groups)
    assert two == pytest.approx(2**0.7 * one, rel=1e-12)  # ISO 281, 5.1.2.2


def test_rows_with_bearings_of_their_own_have_their_published_ratings(read):
    own = '[[set.rows]]\nbearing = { designation = "7210 B" }\n'
    rows = "".join(f'{own}position = "{z} mm"\n' for z in (0, 20))
    scene = read('designation = "7208 B"', f'[set]\narrangement = "rows"\n{rows}')
    entry = bj.catalogue_entry("7210 B")
    alone: Any = [getattr(entry, name) for name in NAMES]
    wanted = np.array([2**0.7, 2.0, 2.0]) * alone
    np.testing.assert_allclose(rated(scene), wanted, rtol=1e-12)
    origin = rating_origins(scene, rate(scene))["dynamic_capacity"]
    assert origin.startswith("published for the bearing of its rows, of one row; for 2")
    # [bearing] is in none of the rows, unless one of them leaves its own out.
    (text,) = scene.warnings
    assert text.startswith(
        "set: every row has a `bearing` of its own, so that [bearing]"
    )
    assert scene.installed.limiting_speed == entry.limiting_speed
    unlike = rows.replace("7210 B", "7209 B", 1)
    scene = read('designation = "7208 B"', f'[set]\narrangement = "rows"\n{unlike}')
    assert scene.catalogue is None and scene.installed.limiting_speed is None
    mixed = rows.replace(f'{own}position = "20', '[[set.rows]]\nposition = "20')
    scene = read('designation = "7208 B"', f'[set]\narrangement = "rows"\n{mixed}')
    assert scene.warnings == ()


def test_sweep_over_rated_dimension_leaves_out_published_ratings(tmp_path):
    """Also in the case that has the dimension of the catalogue."""
    text = CATALOGUED.replace("7208 B", "6205")
    own = bj.load_bearing("6205").ball_diameter
    sizes = f'bearing.ball_diameter = ["{1e3 * float(own)} mm", "7.9 mm"]'
    (part,) = cases(tmp_path, text + sizes).design_groups
    assert part.element.bearing.published is None


def test_rating_origins_name_the_listed_design(read):
    for name, listed in (("22220", "22220 E"), ("NU 205 W", "NU 205 EC")):
        scene = read(f'designation = "{name}"')
        origin = rating_origins(scene, rate(scene))["dynamic_capacity"]
        plain = name.removesuffix(" W")
        assert origin == f"published for {listed}; {plain} is listed as {listed}"


def test_sweep_over_clearance_of_catalogue_bearing(tmp_path):
    key = "bearing.radial_internal_clearance"
    text = CATALOGUED.replace("7208 B", "6205") + f'{key} = ["10 um", "12.5 um"]'
    (part,) = (table := cases(tmp_path, text)).design_groups
    clearances = [10e-6, 12.5e-6]
    assert [made[f"{key} [m]"] for made in table.settings] == clearances
    left = part.element.bearing.radial_internal_clearance
    assert left == pytest.approx(clearances, rel=1e-9)


def test_ratings_come_back_from_the_json(read, tmp_path):
    pair = '[set]\narrangement = "back_to_back"\nspacing = "18 mm"\n[life]\n'
    scene = read('designation = "7208B"', pair)
    path = tmp_path / "again.json"
    path.write_text(json.dumps({"inputs": scene.inputs}), encoding="utf-8")
    again = bj.read_scene(path)
    assert rated(again) == rated(scene)
    # Defaults that the JSON has filled in override nothing.
    assert again.catalogue.overridden == ()


@pytest.mark.parametrize("name", ["NJ 206 EC", "30205 J2", "1205 E/C3", "51108"])
@pytest.mark.slow
def test_echo_of_designation_overrides_no_keys(read, tmp_path, name):
    scene = read(f'designation = "{name}"', settings=["operating.load.Fz=1 N"])
    path = tmp_path / "again.json"
    path.write_text(json.dumps({"inputs": scene.inputs}), encoding="utf-8")
    assert bj.read_scene(path).catalogue.overridden == ()
    changed = bj.read_scene(path, ["bearing.first_azimuth=5 deg"])
    assert changed.catalogue.overridden == ("first_azimuth",)

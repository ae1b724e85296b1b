"""Bearings by their designation: the catalogue, its commands, scenes that use it."""

import dataclasses
import json
import re
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import numpy as np
import pytest
from tolerances import SOLVER

import bearingjax as bj
from bearingjax.catalogue.entry import ENTRY_UNITS
from bearingjax.design import rows_of
from bearingjax.design.keywords import BALLS, ROLLERS
from bearingjax.files import SceneError, shipped_scenes
from bearingjax.numerics.units import unit_of
from bearingjax.studies.bearing.read_scene import read_scene, scene_of
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.catalogue import catalogue_report
from bearingjax.studies.catalogue.catalogue_report import new_scene

ENTRIES = bj.catalogue_entries()
NAMES = [entry.designation for entry in ENTRIES]
NEWER = {
    "double_row_ball": 1.05,
    "spherical_roller": 1.135,
    "toroidal_roller": 1.135,
    "spherical_thrust_roller": 1.135,
    "cylindrical_thrust_roller": 1.0,
    "crossed_roller": 1.0,
}
"""Types whose ratings all close, and C of an improved class over that of ISO 281."""
BALL_TYPES = {e.type for e in ENTRIES if "n_balls" in e.design}


def test_all_types_and_sixty_bearings_of_their_own():
    assert len({(e.type, *sorted(map(str, e.design.items()))) for e in ENTRIES}) >= 60
    assert {e.type for e in ENTRIES} == {
        "deep_groove_ball",
        "angular_contact_ball",
        "four_point_ball",
        "self_aligning_ball",
        "thrust_ball",
        "cylindrical_roller",
        "needle_roller",
        "tapered_roller",
        *NEWER,
    }
    assert len(NAMES) == len(set(NAMES))
    published = {e.type for e in ENTRIES if e.geometry == "published"}
    assert len(published) == 4
    assert {e.geometry for e in ENTRIES} == {"published", "estimated"}


def test_catalogue_files_hold_known_keys_only():
    known = {"also", "arrangements", "assumed", "bearing", "capacity_source"}
    known |= {"geometry", "geometry_source", "letter", "makers", "other", "printed"}
    sizes = {"bore", "outside_diameter", "width", "inner_width", "outer_width"}
    ratings = {"dynamic_capacity", "static_capacity", "fatigue_load_limit"}
    known |= sizes | ratings | {"reference_speed", "limiting_speed", "mass"}
    for path in (files("bearingjax.catalogue") / "data").iterdir():
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        used = set()
        for key, values in data["bearings"].items():
            assert set(values) <= known, key
            used |= {values["capacity_source"], values["geometry_source"]}
            used |= {values["other"]["source"]} if "other" in values else set()
            used |= set(values.get("makers", {}))
        assert used == set(data["sources"]), path.name


def test_ratings_of_makers_stand_side_by_side():
    entry = bj.catalogue_entry("SKF 6205")
    assert "2006" in entry.sources["capacity"] and entry.dynamic_capacity == 14.8e3
    assert ("NSK, rolling bearings E1102", 14e3, 7.85e3) in {
        (rating.source, *rating[:2]) for rating in entry.makers
    }
    told = catalogue_report.catalogue_details(entry)
    assert all(f"({rating.source})" in told for rating in entry.makers)
    (shown,) = catalogue_report.catalogue_as_dict([entry])["bearings"]
    assert shown["makers"] == [rating._asdict() for rating in entry.makers]
    assert bj.catalogue_entry("W 6205").makers == ()  # not of stainless steel
    for entry in (e for e in ENTRIES if e.makers):
        assert entry.dynamic_capacity and entry.static_capacity
        for c, c0, _ in entry.makers:
            assert 0.8 < c / entry.dynamic_capacity < 1.16, entry.designation
            assert c0 is not None and 0.8 < c0 / entry.static_capacity < 1.16


def test_bearings_without_inner_ring_run_on_the_shaft():
    bare = [entry for entry in ENTRIES if not entry.has_inner_ring]
    assert {re.split(r"[ \d]", e.designation)[0] for e in bare} == {
        *("HK", "NK", "NKS", "RNA")
    }
    for entry in bare:
        inner = entry.design["pitch_diameter"] - entry.design["roller_diameter"]
        assert inner == pytest.approx(entry.bore, rel=1e-9)
    entry = bj.catalogue_entry("BK 1010")
    assert "no inner ring" in entry.notes[-1] and "[fit]" not in new_scene(entry)
    data = tomllib.loads(new_scene(entry))
    data["fit"] = {"shaft": "k5", "housing": "H7", "housing_diameter": "40 mm"}
    with pytest.raises(SceneError, match="HK 1010 has no inner ring to be seated"):
        read_scene(scene_of(data, Path("my.toml")))


def test_insert_bearings_have_the_clearance_that_is_printed():
    entry = bj.catalogue_entry("YAR 205-2F")
    assert entry.designation == "UC 205" and entry.clearance_class is None
    assert (entry.width, entry.inner_width, entry.outer_width) == (0.034, 0.034, 0.017)
    assert entry.design["radial_internal_clearance"] == 20e-6
    for text in ("UC 205/C3", "UC 205 K"):
        with pytest.raises(ValueError, match="classes of clearance"):
            bj.catalogue_entry(text)
    asked = bj.decide.Requirements([0.0, 100.0, 0, 0, 0, 0], clearance_class="C3")
    (row,) = bj.select(asked, entries=[entry]).excluded
    assert row["why"] == "UC 205 has no classes"


def test_catalogue_units_are_those_of_the_fields():
    """Keys without a unit of their own are lengths in mm."""
    alike = {"mm": "m", "um": "m", "deg": "rad", "": ""}
    shown = ("_diameter", "_bore", "_height", "_centre", "_travel")
    for entry in {e.type: e for e in ENTRIES}.values():
        kind = {**BALLS, **ROLLERS}[entry.type]
        for key, value in entry.design.items():
            if isinstance(value, float) and key != "axial_internal_clearance":
                assert alike[ENTRY_UNITS.get(key, "mm")] == unit_of(kind, key), key
    for key in {key for entry in ENTRIES for key in entry.printed}:
        assert key in ENTRY_UNITS or key.endswith(shown), key


@pytest.mark.parametrize("entry", ENTRIES, ids=NAMES)
def test_rolling_elements_fit_between_the_rings_and_beside_each_other(entry):
    balls = entry.type in BALL_TYPES
    kind = "ball" if balls else "roller"
    count, size = entry.design[f"n_{kind}s"], entry.design[f"{kind}_diameter"]
    pitch = entry.design["pitch_diameter"]
    section = 0.5 * (entry.outside_diameter - entry.bore)
    if entry.type == "thrust_ball":
        # Two washers, with at least a tenth of the height under each groove.
        washers = entry.width - size
        assert washers > 0.2 * entry.width
        assert entry.bore + size < pitch < entry.outside_diameter - size
    else:
        # Of a taper at its middle; a contact angle brings the raceways nearer.
        across = size
        if entry.type == "cylindrical_thrust_roller":
            across = entry.design["roller_length"]
        inner = 0.5 * (pitch - across - entry.bore)
        outer = 0.5 * (entry.outside_diameter - pitch - across)
        least = 0.09 if entry.type in ("tapered_roller", "four_point_ball") else 0.1
        if not entry.has_inner_ring:  # rollers on the shaft
            assert inner == pytest.approx(0.0, abs=1e-9)
            inner = outer
        assert min(inner, outer) > least * section
        assert size < entry.width
    assert count * np.arcsin(size / pitch) < np.pi  # apart
    if entry.type == "deep_groove_ball":
        # Put in with the rings eccentric, they fill little more than half.
        assert 2 * (count - 1) * np.arcsin(size / pitch) < np.deg2rad(200.0)
    if not balls:
        along = entry.design["roller_length"] * np.cos(
            entry.design.get("roller_axis_angle", 0.0)
        )
        assert along < 0.85 * (entry.outer_width or entry.width)
    if entry.type == "needle_roller":
        assert entry.design["roller_length"] > 2.5 * size
    if entry.type == "tapered_roller":
        # The rollers stand above the cone as far as the cup is open: e = 1.5 tan α.
        names = "roller_axis_angle", "roller_half_angle"
        axis, half = (entry.design[name] for name in names)
        assert 0.0 < half < axis
        assert np.tan(half) == pytest.approx(size / pitch * np.sin(axis), rel=1e-4)


@pytest.mark.parametrize("kind", NEWER)
@pytest.mark.slow
def test_ratings_of_the_estimated_inside_are_those_printed(kind):
    for entry in (e for e in ENTRIES if e.type == kind):
        raised = NEWER[kind] if "improved" in entry.sources["capacity"] else 1.0
        c, c0 = (
            float(rate(bj.load_bearing(entry.designation)))
            for rate in (bj.dynamic_capacity, bj.static_capacity)
        )
        assert entry.dynamic_capacity and entry.static_capacity
        assert raised * c == pytest.approx(entry.dynamic_capacity, rel=0.026)
        near = 0.016 if kind == "double_row_ball" else 0.006
        assert c0 == pytest.approx(entry.static_capacity, rel=near)
        assert entry.mass is None or 0.62 < entry.mass / _solid(entry) < 1.0


def _solid(entry):
    """Mass of a steel ring of the whole cross section [kg]."""
    ring = 0.25 * np.pi * (entry.outside_diameter**2 - entry.bore**2)
    return 7850.0 * ring * entry.width


def test_axial_factors_are_those_of_the_contact_angle():
    """Y1 = 0.67/e and Y2 = 1/e as rounded; e = 1.5 tan α (ISO 281)."""
    for entry in (e for e in ENTRIES if e.type == "spherical_roller"):
        limit = entry.printed["axial_load_limit"]
        first, second, _ = entry.printed["axial_factors"]
        assert first == pytest.approx(0.67 / limit, rel=0.031)
        assert second == pytest.approx(1.0 / limit, rel=0.024)
        alpha = entry.design["contact_angle"]
        assert np.tan(alpha) == pytest.approx(limit / 1.5, abs=1e-4)


def test_tilt_factors_of_toroidal_bearings():
    """Radii fitted to k2 give k1, the shift of the inner arc as the ring tilts."""

    def arm_of(entry):
        arc = entry.design["inner_raceway_radius"]
        sizes = entry.design["pitch_diameter"], entry.design["roller_diameter"]
        return 0.5 * (sizes[0] - sizes[1]) + arc

    for entry in (e for e in ENTRIES if e.type == "toroidal_roller"):
        printed = entry.printed["tilt_factor"] * entry.width * 180.0 / np.pi
        assert arm_of(entry) == pytest.approx(printed, rel=0.04)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["22220 E/C3", "C 3052", "29412 E", "81102 TN", "RB 25025"]
)
def test_new_scenes_of_barrel_thrust_and_crossed_rollers_solve(run, tmp_path, name):
    path, out = tmp_path / "my.toml", tmp_path / "out.json"
    path.write_text(run("new", name).out, encoding="utf-8")
    done = run("solve", path, "--json", out)
    assert done.status == 0, done.err
    assert "warning: " not in done.out
    force = json.loads(out.read_text(encoding="utf-8"))["force"]
    entry = bj.catalogue_entry(name)
    assert entry.dynamic_capacity is not None
    share = 0.05 if name[:2] in ("22", "C ") else 0.1
    assert max(map(abs, force[6:9])) == pytest.approx(
        share * entry.dynamic_capacity, rel=0.06
    )


@pytest.mark.parametrize("kind", sorted({e.type for e in ENTRIES}))
@pytest.mark.slow
def test_new_scenes_of_all_kinds_of_bearings_read(kind, tmp_path):
    """One in so many of each kind, some thirty."""
    # The arrangements of ribs differ in one word.
    ours = [e for e in ENTRIES if e.type == kind]
    ours = [e for e in ours if e.design.get("arrangement", "NU") == "NU"]
    for entry in ours[:: len(ours) // 40 + 1]:
        path = tmp_path / "new.toml"
        path.write_text(new_scene(entry), encoding="utf-8")
        scene = bj.read_scene(path)
        assert scene.warnings == (), entry.designation
        assert scene.catalogue.entry == entry
        assert scene.catalogue.overridden == ()
        assert any(scene.load)
        if kind == "tapered_roller":
            # Less pulls a single row apart: its rollers push the rings along the axis.
            row = scene.element.bearing
            steep = np.tan(float(row.axis_angle + row.half_angle))
            assert scene.load[2] > 1.2 * steep * abs(scene.load[1])
        if entry.dynamic_capacity is not None:
            barrels = "spherical_roller", "toroidal_roller"
            share = 0.05 if kind in barrels else 0.1
            assert np.abs(scene.load).max() == pytest.approx(
                share * entry.dynamic_capacity,
                rel=0.06,  # two digits
            )


@pytest.mark.parametrize(
    "name", ["6205", "30205", "7208B", "51108", "NU 208", "22220", "29412", "C2218K"]
)
@pytest.mark.slow
def test_new_scene_with_optional_tables_reads(name, tmp_path):
    """All that may be added to it, with its # taken off, is a scene with a life."""
    scene, _, further = new_scene(bj.catalogue_entry(name)).partition("# What may")
    lines = [line[2:] for line in further.splitlines()[1:]]
    path = tmp_path / "new.toml"
    path.write_text("\n".join([scene, *lines]), encoding="utf-8")
    table = read_cases(path)
    np.testing.assert_allclose(table.cases.load[0], table.scene.load)
    assert table.scene.life is not None and table.scene.oil is not None
    assert (table.scene.fits is None) == (name in ("51108", "29412"))
    assert {"gx", "gy"} <= set(table.scene.prescribed)
    assert table.scene.warnings == ()


@pytest.mark.parametrize(
    "name, origins",
    {
        "22220/C3": {
            "n_rollers": "estimated",
            "roller_profile_radius": "assumed, as usual",
            "radial_internal_clearance": "calculated, middle of class C3",
        },
        "NU 215 EC": {"n_rollers": "published", "arrangement": None},
    }.items(),
)
def test_new_scene_tells_origins_of_what_a_designation_implies(name, origins):
    entry = bj.catalogue_entry(name)
    lines = new_scene(entry).partition("[operating]")[0].splitlines()
    for key, origin in origins.items():
        (line,) = [line for line in lines if line.startswith(f"# {key} = ")]
        assert line.partition("  # ")[2] == (origin or "")
    assert entry.geometry == origins["n_rollers"]
    table = tomllib.loads(_spelt_out("\n".join(lines)))["bearing"]
    assert set(table) == {"designation", "type", *entry.design}


@pytest.mark.slow
def test_a_new_scene_solves(run, tmp_path):
    made = run("new", "NA", "4905")
    assert made.status == 0
    path, out = tmp_path / "my.toml", tmp_path / "out.json"
    path.write_text(made.out, encoding="utf-8")
    # At rest, as the program without speeds is the cheapest to compile.
    settings = ("bearing.roller_length=10 mm", "operating.inner_speed=0 rpm")
    given = [word for setting in settings for word in ("--set", setting)]
    done = run("solve", path, *given, "--json", out)
    assert done.status == 0, done.err
    words = "NA 4905 (catalogue), inner geometry estimated, overridden: roller_length"
    assert f"\n{words}\n" in done.out
    numbers = json.loads(out.read_text(encoding="utf-8"))
    assert numbers["catalogue"] == {
        "designation": "NA 4905",
        "geometry": "estimated",
        "overridden": ["roller_length"],
    }
    assert numbers["force"][7] == pytest.approx(-2400.0, rel=SOLVER)


def test_bearing_by_designation_and_by_scene():
    bearing = bj.load_bearing("6205-2RS1/C3")
    assert type(bearing) is bj.DeepGrooveBallBearing
    assert bearing.n_balls == 9
    middle = np.mean(bj.fits.ball_clearance("C3", 0.025))
    assert float(bearing.radial_internal_clearance) == pytest.approx(middle)
    entry = bj.catalogue_entry("6205-2RS1/C3")
    assert eqx.tree_equal(bj.load_bearing(entry.designation), bearing)
    assert "2RS1 (seals or shields): no effect" in entry.notes
    assert isinstance(bj.load_bearing("1205 EKTN9"), bj.BearingSet)
    with jax.enable_x64(False):
        assert bj.load_bearing("6205").pitch_diameter.dtype == np.float32
    assert type(bj.load_bearing("tapered")) is bj.TaperedRollerBearing


@pytest.mark.parametrize(
    "written, designation",
    [
        ("SKF 6205", "6205"),
        ("6205 2rs c3", "6205/C3"),
        ("62052RS", "6205"),
        ("6205LLUC3", "6205/C3"),
        ("6205/CN", "6205"),
        ("nj209ecp", "NJ 209 EC"),
        ("NU209-E-TVP2-C3", "NU 209 EC/C3"),
        ("N 209", "N 209 EC"),
        ("7205 BECBP", "7205 BE"),
        ("7205B", "7205 BE"),
        ("7208 AC", "7208 AC"),
        ("QJ 211 N2MA", "QJ 211"),
        ("FAG 30206-A", "30206 J2"),
        ("32010 X/Q", "32010 X"),
        ("NA4905/C2", "NA 4905/C2"),
        ("6205-2RSH/C3LHT23", "6205/C3"),
        ("6205-2RSH/C3HVT162", "6205/C3H"),
        ("6205/C3MT33", "6205/C3"),
        ("6205 CNM", "6205/CNM"),
        ("6205C3P5", "6205/C3"),
        ("6205/C3P", "6205/C3P"),
        ("1205 EKTN9/C3", "1205 EK/C3"),
        ("1205EK30", "1205 EK30"),
        ("22220-E1-XL-K", "22220 EK"),
        ("SKF 24132 CCK30/W33/C3", "24132 CCK30/C3"),
        ("C2205KTN9", "C 2205 K"),
        ("29412", "29412 E"),
        ("THK RB25025UU", "RB 25025"),
    ],
)
def test_ways_to_write_a_designation(written, designation):
    assert bj.catalogue_entry(written).designation == designation


PARTS = "C3H", "C3L", "C3M", "C3P"
"""Upper, lower and middle half of a class, and into the next."""


@pytest.mark.parametrize(
    "written, find, name, tapered",
    [
        ("1205 EK/C3", bj.fits.self_aligning_clearance, "C3", True),
        ("1205 E/C3", bj.fits.self_aligning_clearance, "C3", False),
        ("1205 EK", bj.fits.self_aligning_clearance, "CN", True),
        ("1204 EK/C2", bj.fits.self_aligning_clearance, "C2", True),
        ("22220 E", bj.fits.spherical_roller_clearance, "CN", False),
        ("22220 EK/C3", bj.fits.spherical_roller_clearance, "C3", True),
        ("C 3052/C4", bj.fits.toroidal_roller_clearance, "C4", False),
        ("C 3052 K/C2", bj.fits.toroidal_roller_clearance, "C2", True),
        *((f"6205/{part}", bj.fits.ball_clearance, part, False) for part in PARTS),
    ],
)
@pytest.mark.slow
def test_clearances_of_tapered_bores_and_parts_of_a_class(written, find, name, tapered):
    """In the catalogue and, with tolerances, in a [fit]; the limits themselves are
    validation cases."""
    entry = bj.catalogue_entry(written)
    taper = dict(tapered=True) if tapered else {}
    low, high = 1e6 * np.array(find(name, entry.bore, **taper))
    clearance = 0.5e-6 * (low + high)
    row = rows_of(bj.load_bearing(entry.designation))[0].bearing
    found = float(bj.fits.radial_clearance(row))
    assert found == pytest.approx(clearance, rel=1e-3)
    assert entry.class_limits is not None
    limits = entry.class_limits(entry.clearance_class, entry.bore)
    np.testing.assert_allclose(np.array(limits) * 1e6, [low, high])
    assert bj.catalogue_entry(entry.designation).design == entry.design
    seat = 'drive_up = "0 mm"' if entry.taper else 'shaft = "k5"'
    text = f'[bearing]\ndesignation = "{written}"\n[fit]\n{seat}\n'
    text += f'housing = "H7"\nhousing_diameter = "{1.5 * entry.outside_diameter} m"\n'
    scene = scene_of(tomllib.loads(text), Path("fitted.toml"))
    np.testing.assert_allclose(
        np.array(scene.installed.limits.clearance) * 1e6, [low, high]
    )
    echoed = scene_of(scene.inputs, Path("echoed.toml"))
    assert tuple(echoed.installed.limits.clearance) == tuple(
        scene.installed.limits.clearance
    )


def test_designation_letters_change_geometry():
    b, ac = (bj.catalogue_entry(f"7218 {letter}") for letter in ("B", "AC"))
    assert b.design["contact_angle"] == np.deg2rad(40)
    assert ac.design["contact_angle"] == np.deg2rad(25)
    assert b.design["n_balls"] == ac.design["n_balls"]
    assert ac.dynamic_capacity is None
    assert ac.sources["geometry"].startswith("balls and pitch circle of 7218 BE (of")
    listed = bj.catalogue_entry("7205 C")
    assert listed.dynamic_capacity is not None
    ribs = [bj.load_bearing(f"{kind} 206 EC").ribs.present for kind in ("NU", "N")]
    assert ribs == [("outer_minus", "outer_plus"), ("inner_minus", "inner_plus")]


def test_capacities_from_the_balls_of_another_angle_are_as_far_off_as_told():
    """Of the 7205 both angles are listed: their C, C0 over what its BE would give."""
    ball = rows_of(bj.load_bearing("7205 BE"))[0].bearing
    over = []
    for name in ("7205 C", "7205 AC"):
        entry = bj.catalogue_entry(name)
        other = dataclasses.replace(ball, contact_angle=entry.design["contact_angle"])
        assert entry.dynamic_capacity and entry.static_capacity
        over.append(float(bj.dynamic_capacity(other)) / entry.dynamic_capacity - 1)
        over.append(float(bj.static_capacity(other)) / entry.static_capacity - 1)
    assert (round(100 * min(over)), round(100 * max(over))) == (5, 22)
    assert (
        "are 5 to 22 % above the printed ones" in bj.catalogue_entry("7308C").notes[0]
    )


WRONG = {
    "6299": "'6299' is not a bearing of the catalogue; near it: 6209",
    "62055": "'62055' is not a bearing of the catalogue; near it: 6205",
    "": "'' is not a designation, such as",
    "6205-XQ": "has letters after 6205 that are not known: 'XQ'",
    "6205/C9": "has letters after 6205 that are not known: 'C9' (known are C2, CN, C3,",
    "6205 C2/C3": "names two classes of clearance, C2 and C3",
    "7205": "near it: 7205A, 7205B, 7205C, 7205A5, 7205AC, 7205AD",
    "7205 B/C3": "7205 BE/C3: angular_contact_ball has no classes of clearance here",
    "6205 C5P": "`name` is 'C5P'; it must be one of C2, CN, C3, C4, C5 for a bore",
    "NU 209 ECK": "NU 209 ECK: classes of clearance of tapered bores (K) are known",
    "1205 C5": "`name` is 'C5'; it must be one of C2, CN, C3, C4",
    "N 2205": "; near it: C2205, 2205, 22205, 62205, N220E, NJ205;",
    "deep_grove": "nor is it a .toml file or a shipped scene (angular_contact,",
}


@pytest.mark.parametrize("written", WRONG)
def test_load_bearing_suggests_similar_designations(written):
    with pytest.raises(bj.SceneError) as caught:
        bj.load_bearing(written)
    assert WRONG[written] in str(caught.value)


@pytest.mark.parametrize("given", [6205, None, ["6205"], b"6205"])
def test_catalogue_entry_rejects_non_text_designation(given, untyped):
    names = {bj.load_bearing: "source", bj.catalogue_entry: "designation"}
    for read, name in names.items():
        with pytest.raises(TypeError, match=f"`{name}` is .*; it must be a text such"):
            read(given)


def scene(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(f"[bearing]\n{text}\n[operating]\nload = {{ Fy = '1 kN' }}\n")
    return path


@pytest.mark.slow
def test_single_dimensions_override(tmp_path):
    text = 'designation = "6205/C3"\ncontact_angle = "10 deg"\nn_balls = 9\n'
    read = bj.read_scene(scene(tmp_path, text))
    # The clearance of the class gives way to the angle it would follow from.
    assert read.element.bearing.radial_internal_clearance is None
    assert read.catalogue.overridden == ("contact_angle",)
    # Of a spherical roller bearing it does not follow.
    text = 'designation = "22220 E"\ncontact_angle = "9.3 deg"\n'
    read = bj.read_scene(scene(tmp_path, text), ["operating.prescribed.gx=0 deg"])
    row: Any = rows_of(read.element.bearing)[0].bearing
    assert float(row.radial_internal_clearance) == pytest.approx(80e-6)
    assert read.catalogue.overridden == ("contact_angle",)
    # The same in other units is no other dimension.
    text = 'designation = "6205"\nball_diameter = "0.00794 m"\ninner_osculation = 0.52'
    assert bj.read_scene(scene(tmp_path, text)).catalogue.overridden == ()
    text = 'designation = "NU 215"\n[bearing.rib]\ncontact_height = "0.4 mm"\n'
    read = bj.read_scene(scene(tmp_path, text))
    rib = read.element.bearing.ribs.outer_plus
    assert float(rib.contact_height) == pytest.approx(0.4e-3)
    assert float(rib.end_radius) == pytest.approx(0.54)
    assert read.catalogue.overridden == ("rib",)


OLD = "the lines beside `designation` are those of {}, not of {}; leave out the lines"
# Scene of `new`, its designation afterwards, lines changed, and what is told.
EDITED = {
    "another bearing": ("6205", "6206", {}, OLD.format("6205", "6206")),
    "another kind of ribs": (
        "NU 206",
        "NJ 206",
        {},
        OLD.format("NU 206 EC", "NJ 206 EC"),
    ),
    "another angle": ("7208 B", "7208 C", {}, OLD.format("7208 BE", "7208 C")),
    "another bearing, one line its own": (
        "6205",
        "6206",
        {"n_balls": 8},
        "`pitch_diameter` and `ball_diameter` are not those of 6206, but those of 6205",
    ),
    "another bearing, its balls changed": (
        "6205",
        "6206",
        {"ball_diameter": '"8 mm"'},
        "`pitch_diameter` and `ball_diameter` are far from those of 6206; leave out",
    ),
    "another class": (
        "6205",
        "6205/C3",
        {},
        "`radial_internal_clearance` (12.5 um), the middle of class CN, counts in place"
        " of class C3 of 6205/C3 (13 to 28 µm); a [fit] takes it as exact",
    ),
    "no class": ("6205/C3", "6205", {}, "(20.5 um), the middle of class C3, counts"),
    "a class beside a clearance": (
        "6205/C3",
        "6205/C3",
        {"radial_internal_clearance": '"9 um"'},
        "`radial_internal_clearance` (9 um) counts in place of class C3 of 6205/C3",
    ),
    "nothing changed": ("6205/C3", "6205/C3", {}, None),
    "a measured clearance": (
        "6205",
        "6205",
        {"radial_internal_clearance": '"9 um"'},
        None,
    ),
    "a measured inside": (
        "6205",
        "6205",
        {"pitch_diameter": '"38.5 mm"', "ball_diameter": '"7.938 mm"', "n_balls": 8},
        None,
    ),
    "one line far off": ("6205", "6205", {"pitch_diameter": '"42 mm"'}, None),
}


def _spelt_out(text):
    """A new scene whose lines of the bearing count: without their #."""
    head, operating, rest = text.partition("[operating]")
    return re.sub(r"(?m)^# (\w+ = )", r"\1", head) + operating + rest


@pytest.mark.parametrize("name", EDITED)
@pytest.mark.slow
def test_lines_left_over_from_another_designation_are_told(name, tmp_path):
    first, then, changed, told = EDITED[name]
    entry = bj.catalogue_entry(first)
    text = new_scene(entry).replace(
        f'designation = "{entry.designation}"', f'designation = "{then}"'
    )
    path = tmp_path / "new.toml"
    path.write_text(text, encoding="utf-8")
    # The lines of `new` follow the designation until they lose their #.
    scene = bj.read_scene(path)
    assert scene.warnings == () and scene.catalogue.overridden == ()
    path.write_text(_spelt_out(text), encoding="utf-8")
    settings = [f"bearing.{key}={value}" for key, value in changed.items()]
    found = bj.read_scene(path, settings).warnings
    assert len(found) == (told is not None)
    assert told is None or found[0].startswith("bearing: ") and told in found[0]


def test_sweep_merges_catalogue_warnings_of_designs(tmp_path):
    path = tmp_path / "new.toml"

    def told(grid):
        text = _spelt_out(new_scene(ENTRIES[NAMES.index("6205")]))
        path.write_text(f"{text}[cases.grid]\n{grid}", encoding="utf-8")
        return read_cases(path).warnings

    (one,) = told('bearing.designation = ["6205", "6206", "6207"]')
    assert OLD.format("6205", "6206") in one and one.endswith("(2 designs alike)")
    sizes = {"pitch": '["39 mm", "45 mm"]', "ball": '["8 mm", "9.5 mm"]'}
    grid = "".join(f"bearing.{k}_diameter = {v}\n" for k, v in sizes.items())
    assert told(grid) == ()


def test_a_bearing_whose_capacity_is_not_known(run, tmp_path):
    out = tmp_path / "out.json"
    done = run("catalogue", "7308 C", "--json", out)
    assert done.status == 0 and "\nC, C0 not known for this" in done.out
    assert "estimated: balls and pitch circle of 7308 BE (of that" in done.out
    (entry,) = json.loads(out.read_text(encoding="utf-8"))["bearings"]
    assert entry["dynamic_capacity"] is None
    done = run("catalogue", "7308 C", "--min-capacity", "1 N")
    assert done.status == 0 and done.out.splitlines()[1].startswith("0 bearings")


def test_wrong_capacity_of_the_catalogue(run):
    done = run("catalogue", "--min-capacity", "10")
    assert done.status == 2
    assert done.err.startswith("bearingjax: --min-capacity: '10' has no unit")


def test_solve_command_rejects_designation_as_scene(run):
    done = run("solve", "6205/C3")
    assert done.status == 2
    assert done.err.endswith(
        "; if it is a designation, `bearingjax new 6205/C3 > my.toml` writes the scene"
        " of this bearing\n"
    )


@pytest.mark.slow
def test_catalogue_command(run, tmp_path):
    out = tmp_path / "out.json"
    given = ("--bore", "35 mm:40 mm", "--min-capacity", "19 kN:37 kN", "--json", out)
    done = run("catalogue", "--type", "thrust_ball", *given)
    assert done.status == 0
    assert [line.split()[0] for line in done.out.splitlines()[1:-1]] == [
        "51107",
        "51108",
        "51207",
    ]
    listed = json.loads(out.read_text(encoding="utf-8"))["bearings"]
    assert listed[0]["designation"] == "51107"
    assert listed[0]["dynamic_capacity"] == bj.catalogue_entry("51107").dynamic_capacity
    done = run("catalogue", "--bore", "25 mm", "--min-capacity", "20 kN:30 kN")
    names = {line[:13].strip() for line in done.out.splitlines()[1:-1]}
    assert {"6305", "7305 AC", "NU 205 EC", "NA 4905"} <= names
    assert "6205" not in names and "NU 305 EC" not in names
    done = run("catalogue", "QJ 211", "30206", "--plot", tmp_path / "out.png")
    assert (
        "QJ 211: four point ball bearing, 55 x 100 x 21 mm\nC 85 kN, C0 83" in done.out
    )
    assert (tmp_path / "out.png").stat().st_size > 20_000
    done = run("catalogue", "QJ 211", "--drawing", tmp_path / "out.svg")
    assert done.status == 0
    drawn = (tmp_path / "out.svg").read_text(encoding="utf-8")
    # Of an SVG file words are kept in its comments.
    assert "55 x 100 x 21 mm, inner geometry estimated" in drawn
    assert "shim_angle = " in drawn


UNLISTED = {
    "deep_groove_ball": (85, 150, 28, 87.1, 64),
    "angular_contact_ball": (60, 130, 31, 96, 71),
    "four_point_ball": (55, 100, 21, 85, 83),
    "self_aligning_ball": (50, 90, 20, 26.5, 9.15),
    "thrust_ball": (90, 120, 22, 59.2, 190),
    "cylindrical_roller": (45, 85, 19, 46.0, 47.0),
    "needle_roller": (40, 62, 22, 42.9, 71),
    "tapered_roller": (55, 100, 26.75, 107, 134),
    "spherical_roller": (50, 110, 27, 156, 166),
    "toroidal_roller": (320, 540, 176, 4150, 6300),
    "spherical_thrust_roller": (260, 480, 132, 4050, 12900),
    "cylindrical_thrust_roller": (110, 160, 38, 260, 1000),
    "crossed_roller": (220, 280, 25, 92.3, 171),
}
"""d, D, B [mm], C, C0 [kN]."""


def asked(kind, numbers):
    options = ("--bore", "--outside", "--width", "--capacity", "--static-capacity")
    units = 3 * ["mm"] + 2 * ["kN"]
    given = zip(options, numbers, units, strict=True)
    words = [text for key, x, unit in given for text in (key, f"{x} {unit}")]
    return ("new", "--type", kind, *words)


@pytest.mark.parametrize("kind", UNLISTED)
@pytest.mark.slow
def test_a_scene_of_an_unlisted_bearing(run, tmp_path, kind):
    """It is that of `estimate_geometry`, with the ratings given."""
    numbers = UNLISTED[kind]
    done = run(*asked(kind, numbers))
    assert done.status == 0 and done.err == "" and ".." not in done.out
    path = tmp_path / "unlisted.toml"
    path.write_text(done.out, encoding="utf-8")
    read = bj.read_scene(path)
    *sizes, c, c0 = numbers
    d, outside, width = (1e-3 * size for size in sizes)
    found = bj.catalogue.estimate_geometry(d, outside, width, kind, 1e3 * c, 1e3 * c0)
    made, wanted = (
        rows_of(bearing)[0].bearing for bearing in (read.element.bearing, found.bearing)
    )
    assert type(made) is type(wanted)
    for rate in (bj.dynamic_capacity, bj.static_capacity):
        rated = (float(rate(b)) for b in (read.element.bearing, found.bearing))
        assert next(rated) == pytest.approx(next(rated), rel=1e-3)
    assert float(made.pitch_diameter) == pytest.approx(
        float(wanted.pitch_diameter), rel=1e-4
    )
    assert float(read.life.dynamic_capacity) == pytest.approx(1e3 * c)
    assert float(read.life.static_capacity) == pytest.approx(1e3 * c0)
    assert found.report()[:20] in done.out


SPEEDS = {
    "RB 3010": 870,
    "RB 25025": 130,
    "RB 40040": 81,
    "NA 4822": 1500,
    "7308 C": 1500,
    "6205": 1500,
    "29448 E": 420,
}


@pytest.mark.parametrize("name", SPEEDS)
def test_speed_of_a_new_scene_is_within_that_of_its_type_and_size(name):
    speed = catalogue_report._speed(bj.catalogue_entry(name))
    assert speed == f"{SPEEDS[name]} rpm"


def test_speeds_of_new_scenes_are_half_of_what_makers_allow():
    for entry in ENTRIES:
        speed = float(catalogue_report._speed(entry).removesuffix(" rpm"))
        mean = 0.5e3 * (entry.bore + entry.outside_diameter)
        known = entry.reference_speed or entry.limiting_speed
        limit = 0.52 * known * 30 / np.pi if known else 485e3 / mean
        assert 0 < speed <= min(1500, limit), entry.designation
        assert speed * mean < 305e3  # mm/min, with grease


def test_an_unlisted_bearing_beyond_the_classes_of_clearance(run):
    done = run(*asked("deep_groove_ball", (600, 870, 118, 728, 1500)))
    assert done.status == 0
    assert 'radial_internal_clearance = "0 um"' in done.out
    assert "# No class of clearance has limits here." in done.out
    assert 'inner_speed = "650 rpm"' in done.out


@pytest.mark.parametrize(
    "given, message",
    [
        (("new",), "new: give a designation, or --type and sizes"),
        (("new", "6205", "--bore", "25 mm"), "new 6205: sizes and ratings go with"),
        (("new", "6205", "--type", "thrust_ball"), "a designation or --type, not both"),
        (("new", "--type", "ball"), "--type: 'ball' is not known"),
        (
            ("new", "--type", "thrust_ball", "--bore", "9 mm"),
            "needs its sizes and ratings; --outside, --width, --capacity, --static-",
        ),
        (
            (*asked("thrust_ball", UNLISTED["thrust_ball"]), "--bore", "90"),
            "--bore: '90' has no unit",
        ),
        (
            asked("deep_groove_ball", (85, 150, 28, 871, 64)),
            "--capacity is 871000 N; it must be between",
        ),
        (
            (
                *asked("thrust_ball", UNLISTED["thrust_ball"]),
                "--contact-angle",
                "9 deg",
            ),
            "--contact-angle is given; a thrust ball bearing has none to choose",
        ),
        (("catalogue", "--type", "ball"), "--type: 'ball' is not known"),
        (("catalogue", "--bore", "25"), "--bore: '25' has no unit"),
        (("catalogue", "--bore", "9 mm:2 mm"), "--bore: '9 mm:2 mm' ends below"),
        (("catalogue", "--plot", "a.png"), "--plot draws the bearings that are named"),
        (("catalogue", "--drawing", "a.png"), "--drawing draws one bearing; name one"),
        (("catalogue", "6205", "6206", "--drawing", "a.png"), "name one"),
        (("catalogue", "6205", "--drawing", "a.jpg"), "ends in .png, .pdf or .svg"),
        (("catalogue", "6205", "--drawing", "no/a.png"), "its folder does not exist"),
        (
            ("catalogue", "6205", "--drawing", "a.png", "--plot", "a.png"),
            "is named by --plot and by --drawing; name two files",
        ),
        (("catalogue", "9999"), "'9999' is not a bearing of the catalogue"),
        (("new", "62O5"), "'62O5' is not a bearing of the catalogue; near it: 6205"),
        (("examples", "deep_grove"), "(did you mean `deep_groove`?)"),
    ],
)
@pytest.mark.slow
def test_wrong_words_of_the_commands(run, given, message):
    done = run(*given)
    assert done.status == 2 and message in done.err and done.out == ""


def test_examples_command(run):
    lines = run("examples").out.splitlines()
    assert [line.split()[0] for line in lines] == list(shipped_scenes())
    kinds = {line.split()[0]: line.split()[1] for line in lines}
    assert kinds["deep_groove"] == "solve" and kinds["load_map"] == "sweep"
    shafts = [name for name in kinds if name.startswith("shaft_")]
    assert len(shafts) == 4 and {kinds[name] for name in shafts} == {"shaft"}
    assert kinds["skid_axial"] == "skid" and kinds["taper_contact"] == "contact"
    assert run("examples", "needle").out.startswith("# Drawn-cup needle roller bearing")


@pytest.mark.parametrize("name", ["6205", "608", "6205 # a comment", "NU 205 EC"])
def test_designation_given_by_a_setting(tmp_path, name):
    """The shell takes the quotes: a number for a key of text is the text."""
    path = tmp_path / "one.toml"
    path.write_text('[bearing]\ndesignation = "6206"\n[operating]\n', "utf-8")
    scene = read_scene(path, [f"bearing.designation={name}"])
    assert scene.catalogue.entry.designation == name.partition(" #")[0]


@pytest.mark.parametrize("name", ["0608", "6e3", "1_000", "nan", "2024-01-01"])
def test_designation_is_the_text_of_a_setting(tmp_path, name):
    path = tmp_path / "one.toml"
    path.write_text('[bearing]\ndesignation = "6206"\n[operating]\n', "utf-8")
    with pytest.raises(SceneError, match=f"`bearing.designation`: '{name}' is not a b"):
        read_scene(path, [f"bearing.designation={name}"])


def test_designations_in_a_list_of_cases(tmp_path):
    path = tmp_path / "one.toml"
    path.write_text('[bearing]\ndesignation = "6206"\n[operating]\n', "utf-8")
    key = "bearing.designation"
    rows = f"{key},operating.load.Fy [kN]\n6205,-1\n608,-1\n"
    (tmp_path / "7").write_text(rows, "utf-8")
    table = read_cases(path, ["cases.file=7"])
    assert table.settings == ({key: "6205"}, {key: "608"})
    (tmp_path / "7").write_text(rows.replace("608", "0608"), "utf-8")
    with pytest.raises(SceneError, match="'0608' is not a bearing of the catalogue"):
        read_cases(path, ["cases.file=7"])

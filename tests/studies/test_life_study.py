"""`bearingjax life`, and the rating life in reports, files and sweeps."""

import dataclasses
import json
import re
from html import unescape
from types import SimpleNamespace

import numpy as np
import pytest
from runs import SEARCH, WORDS, Runs, Study
from tolerances import SOLVER

import bearingjax as bj
from bearingjax.cases.sweep import Sweep
from bearingjax.files import shipped_scenes
from bearingjax.files.table_file import read_table
from bearingjax.lubrication import OILS
from bearingjax.studies.cases.life_run import (
    LifeRun,
    spectrum_as_dict,
    spectrum_page,
    spectrum_report,
)
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.solve.run import run_scene

GROOVES = {"inner_osculation": 0.52, "outer_osculation": 0.53}
SCENE = "life_spectrum"
# What is static in the echo, said: so that one program serves.
SAID = ("operating.free=['ux', 'uy', 'uz']", "numerics.tolerance=1e-11")
SETTINGS = tuple(word for text in SAID for word in ("--set", text))
pytestmark = pytest.mark.usefixtures("untyped")
NAMES = ("basic_rating_life", "reference_rating_life", "modified_rating_life")
TEXT = shipped_scenes()[SCENE].read_text(encoding="utf-8")
ONE = TEXT.partition("[[cases")[0]
PICTURE = {"--json": "a.json", "--plot": "a.png"}
STUDIES = {
    "one load": Study(
        ("life", ONE, *SETTINGS),
        WORDS | SEARCH,
        files=PICTURE,
        pictures=2,
        unsolved={
            "huge load": (
                ("--set", "operating.load.Fx=4e300 N"),
                "non_finite",
                "non_finite: ",
            )
        },
        slow=(True, True),
    ),
    "spectrum": Study(
        ("life", SCENE, *SETTINGS, "--quiet"),
        files={**PICTURE, "--table": "a.csv", "--report": "a.html"},
        result=None,
        again=("--quiet",),
        pictures=2,
    ),
}


class TestRuns(Runs):
    """Runs of the command."""


@pytest.fixture(scope="module")
def solution():
    return run_scene(bj.read_scene(SCENE, SAID))


def test_read_scene_life_conditions():
    life = bj.read_scene(SCENE).life
    assert isinstance(life, bj.LifeConditions)
    oil = OILS["ISO VG 68"]().kinematic_viscosity(343.15)
    np.testing.assert_allclose(np.asarray(life.viscosity), oil, rtol=SOLVER)
    assert float(life.dynamic_capacity) == 23400.0 and life.static_capacity is None
    assert bj.read_scene("deep_groove").life is None
    still = bj.read_scene("deep_groove", ["life={}"]).life
    assert isinstance(still, bj.LifeConditions) and still.viscosity is None


@pytest.mark.parametrize(
    "supply, dirt, told",
    [
        ("grease", "grease, high", None),
        ("oil_jet", "oil bath -/17/14", None),
        ("oil_bath", "0.5", None),
        ("oil_bath", "grease, high", 'supply` is "oil_bath": write `supply'),
        ("grease", "oil bath -/17/14", 'supply` is "grease": choose a class of grease'),
    ],
)
def test_dirt_of_a_grease_goes_with_a_supply_of_grease(supply, dirt, told):
    settings = [f"lubricant.supply={supply}", f"life.contamination={dirt}"]
    found = bj.read_scene(SCENE, settings).warnings
    assert len(found) == (told is not None)
    assert told is None or found[0].startswith(
        f'life: `contamination` is "{dirt}", but'
    )
    assert told is None or told in found[0]


@pytest.mark.slow
def test_life_of_one_load_matches_rating_life(run, written, tmp_path, solution):
    """By the command for lives alone, and by `solve`, which leaves the cases out."""
    done, alone, paths = written("one load")
    out = tmp_path / "out.json"
    told = run("solve", SCENE, *SETTINGS, "--json", out)
    assert told.status == 0 and "[cases] are for sweep" in told.err
    found = json.loads(out.read_text(encoding="utf-8"))
    scene = bj.read_scene(SCENE)
    life = bj.rating_life(
        scene.element,
        solution,
        conditions=bj.LifeConditions(
            dynamic_capacity=23400.0,
            viscosity=scene.life.viscosity,
            contamination="grease, normal",
        ),
    )
    for name in (*NAMES, "life_hours", "static_safety", "equivalent_load", "a_iso"):
        np.testing.assert_allclose(found[name], float(getattr(life, name)), rtol=SOLVER)
    assert found["dynamic_capacity"] == 23400.0
    assert found["dynamic_capacity_source"] == "given"
    assert found["dynamic_capacity_origin"] == "given in [life]"
    assert found["static_capacity_source"] == "ISO 76 from geometry"
    assert found["static_capacity_origin"] is None
    assert found["weakest"] == {"row": 0, "ring": "inner", "track": 0}
    assert "limited by the inner raceway" in told.out
    assert f"{1e-6 * float(life.reference_rating_life):.5g}" in told.out
    assert "turning against the load: inner ring" in done.out
    assert "\n  C 23.4 kN (given in [life])\n" in done.out
    assert all(alone[name] == found[name] for name in NAMES)
    assert "displacement" not in alone
    path = paths["--json"].with_name("mine.toml")
    still = ("operating.inner_speed=0 rpm", "life={reliability=0.95}")
    told = run("life", path, *SETTINGS, *(w for s in still for w in ("--set", s)))
    assert told.status == 0 and "hours  " not in told.out
    assert "\nat rest: no life in hours; the inner ring is taken as the" in told.out
    required = ("--set", "life.required=9000 h")
    told = run("life", path, *SETTINGS, *required, "--table", tmp_path / "t.csv")
    row = {k: v[0] for k, v in read_table(tmp_path / "t.csv").items()}
    assert told.status == 0 and row["result"] == "converged" and row["Fx [kN]"] == 2.0
    hours = row["modified_rating_life [h]"]
    assert hours == pytest.approx(found["life_hours"], rel=1e-12)
    assert row["life_factor"] == pytest.approx(hours / 9000.0, rel=1e-12)
    assert row["life_kept"] == (hours >= 9000.0)
    assert "required 9000 h: " in told.out


@pytest.mark.slow
def test_life_command_spectrum_sums_damage(written, undrawn):
    done, found, paths = written("spectrum")
    text = unescape(paths["--report"].read_text(encoding="utf-8"))
    assert "7 balls of 11.5 mm" in text and text.count("<td>converged</td>") == 3
    again = read_cases(paths["--json"])  # the file is a scene again
    np.testing.assert_array_equal(again.cases.hours, [700.0, 250.0, 50.0])
    np.testing.assert_allclose(again.cases.load[:, 0], [1e3, 2e3, 4e3])
    columns = found["columns"]
    hours = np.array([700.0, 250.0, 50.0])
    turns = hours * 60 * np.array([3000.0, 1500.0, 800.0])
    for name in NAMES:
        used = turns / np.array(columns[f"{name} [rev]"])
        np.testing.assert_allclose(found[name], turns.sum() / used.sum(), rtol=1e-10)
    np.testing.assert_allclose(found["damage_share"], used / used.sum(), rtol=1e-10)
    np.testing.assert_allclose(
        found["life_hours"], hours.sum() / used.sum(), rtol=1e-10
    )
    assert found["static_safety"] == min(columns["static_safety"])
    rows = written("spectrum").rows
    assert len(rows) == 4 and "modified_rating_life [rev]" in rows[0]
    assert "each case alone" in done.out
    assert "\nC 23.4 kN (given in [life])\n" in done.out and "at rest" not in done.out
    assert found["dynamic_capacity_source"] == "given"
    assert found["dynamic_capacity_origin"] == "given in [life]"
    # The mean load of ISO 281: powers of the loads by their revolutions.
    loads = np.array(columns["equivalent_load [N]"])
    mean = np.cbrt((turns * loads**3).sum() / turns.sum())
    np.testing.assert_allclose(found["equivalent_load"], mean, rtol=1e-9)
    table = paths["--table"]
    again = (*STUDIES["spectrum"].command, "--si", "--table", table)
    undrawn("life_overview", paths["--json"], *again, others=[table])


@pytest.mark.slow
def test_life_command_with_unsolved_case_has_no_life(run, tmp_path):
    out, lost = tmp_path / "out.json", "cases.spectrum.2.operating.load.Fx=4e30 N"
    told = run("life", SCENE, *SETTINGS, "--set", lost, "--json", out, "--quiet")
    assert told.status == 3 and "1 of 3 cases not solved (case 2: " in told.err
    assert told.out == ""
    found = json.loads(out.read_text(encoding="utf-8"))
    assert "reference_rating_life" not in found
    assert found["columns"]["reference_rating_life [rev]"][2] is None
    assert found["dynamic_capacity"] == 23400.0


def two_cases():
    """A spectrum of two cases whose lives are known, the second one warmer and on a
    tighter shaft; its a1, and lives by name."""
    a1, hours, speed = 0.64, np.array([3.0, 0.0]), np.array([100.0, 50.0])
    cases = bj.Cases(
        np.zeros((2, 6)), inner_speed=speed, hours=hours, design=np.arange(2)
    )
    lives = np.array([1e9, 1e8])
    outputs = {
        "result": np.zeros(2, int),
        "reference_rating_life": lives,
        "basic_rating_life": lives,
        "damage": 1 / (a1 * lives),
        "static_safety": np.array([9.0, 3.0]),
        "equivalent_load": np.array([1e3, 2e3]),
        "reference_load": np.array([1e3, 2e3]),
        "operating_radial_clearance": np.array([8e-6, -3.5e-6]),
    }
    element = SimpleNamespace(
        bearing=bj.DeepGrooveBallBearing(7, 0.04, 0.008, **GROOVES)
    )
    scene = SimpleNamespace(name="two", element=element, catalogue=None, life=None)
    scene.preload_of_set = None
    settings = (
        {"temperature.inner_ring [K]": 333.15, "fit.shaft": "k5", "fit.housing": "H7"},
        {"temperature.inner_ring [K]": 363.15, "fit.shaft": "m5", "fit.housing": "H7"},
    )
    table = SimpleNamespace(
        scene=scene,
        cases=cases,
        varied=["hours"],
        warnings=[],
        inputs={},
        settings=settings,
        series=None,
        row_name="case {}".format,
    )
    known = {
        name: bj.spectrum_life(cases, 1 / lives)
        for name in ("basic_rating_life", "reference_rating_life")
    }
    asked = bj.spectrum_life(cases, outputs["damage"])
    ratings = SimpleNamespace(
        dynamic_capacity=2e4,
        static_capacity=1e4,
        fatigue_load_limit=500.0,
        dynamic_source="given",
        static_source="given",
        limit_source="given",
        factors_source="ISO 281 and ISO 76 from geometry",
    )
    solved = Sweep(cases, outputs, "inner", ())
    run = LifeRun(table, solved, known, asked, ratings)  # pyright: ignore[reportArgumentType]
    return run, a1, lives


def test_reliability_counts_without_a_lubricant_too():
    run, a1, lives = two_cases()
    found = spectrum_as_dict(run)
    hours, speed = np.array([3.0, 0.0]), np.array([100.0, 50.0])
    used = hours * speed * 3600 / (2 * np.pi) / lives
    np.testing.assert_allclose(found["life_hours"], a1 * 3 / used.sum(), rtol=1e-12)
    np.testing.assert_allclose(found["damage_share"], used / used.sum(), rtol=1e-12)
    assert found["modified_rating_life"] is None
    lines = str(spectrum_report(run)).splitlines()
    (line,) = [line for line in lines if line.startswith("reference, a1 0.64")]
    assert f"{a1 * 3 / used.sum():.5g}" in line
    # Without a speed there are no hours, and it is said.
    still = bj.Cases(np.zeros((2, 6)), hours=hours)
    used = {name: bj.spectrum_life(still, 1 / lives) for name in run.lives}
    gone = bj.spectrum_life(still, run.solved.outputs["damage"])
    told = spectrum_report(dataclasses.replace(run, lives=used, asked=gone))
    lines = str(told).splitlines()
    assert any(
        line.startswith("at rest: no life in hours; the inner") for line in lines
    )
    assert not any(re.search(" h$", line) for line in lines)


def test_spectrum_report_labels_cases_by_differing_keys():
    """Whatever the key; and how each runs, the least safe one by its number."""
    run = two_cases()[0]
    text = str(spectrum_report(run))
    assert "least static safety 3 (case 1, of 0 h)" in text
    assert "over the cases the operating radial clearance is -3.5 to 8 µm" in text
    lines = text.splitlines()
    (k,) = [k for k, line in enumerate(lines) if line.startswith("each case alone")]
    first, second, warm = (lines[k + i].split() for i in (1, 2, 4))
    assert first[-2:] == ["damage", "(reference)"] and second[-1] == "%"
    assert warm[:4] == ["1", "0", "2", "-3.5"]  # case, hours, kN, µm
    told = "inner speed 477.5 rpm, inner ring 90 °C, shaft m5"
    assert f"   1  {told}" in lines and max(map(len, lines)) <= 100
    columns = spectrum_as_dict(run)["columns"]
    assert columns["operating_radial_clearance [m]"][1] == -3.5e-6
    below = bj.plot.life_overview(run).subfigs[0].axes
    for ax in below:
        label = ax.get_xticklabels()[1].get_text()
        assert label == "\n".join(["1", *told.split(", ")])


def test_spectrum_page_fits_of_scene():
    """Those of the scene, beside the clearances of its cases."""
    fit = "bore=25 mm", "outside_diameter=62 mm", "housing_diameter=90 mm"
    seats = [f"fit.{one}" for one in (*fit, "shaft=k5", "housing=H7")]
    table = read_cases(SCENE, seats)
    run = two_cases()[0]
    outputs = {name: np.resize(x, 3) for name, x in run.solved.outputs.items()}
    solved = Sweep(table.cases, outputs, "inner", ())
    asked = bj.spectrum_life(table.cases, outputs["damage"])
    run = LifeRun(table, solved, run.lives, asked, run.ratings)
    sections = spectrum_page(run).sections
    first = spectrum_report(run).sections["Rating life"]
    assert list(map(str, sections["Rating life"])) == list(map(str, first))
    told = " ".join(map(str, sections["Fits and clearance"]))
    assert "[fit] and [temperature] of the scene have them" in told
    assert "over the cases the operating radial clearance is -3.5 to 8 µm." in told
    assert "fits: shaft k5, housing H7" in told


def test_labels_of_many_settings_say_how_many_are_left_out():
    from bearingjax.plot.life import _name_case

    words = [f"number {k} of many 12 mm" for k in range(9)]
    lines = _name_case(3, words, 13).splitlines()
    assert max(map(len, lines)) <= 13 and len(lines) <= 8
    assert lines[:3] == ["3", "number 0 of", "many 12 mm"] and lines[-1] == "and 6 more"
    assert _name_case(3, words[:3], 30).splitlines() == ["3", *words[:3]]

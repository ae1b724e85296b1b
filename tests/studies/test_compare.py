"""`bearingjax compare`: scenes side by side."""

import json

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.cases import sweep_table
from bearingjax.studies.solve.compare import _side_by_side, difference
from bearingjax.studies.solve.output import solution_json
from bearingjax.studies.solve.run import solve_scene

SCENE = "cylindrical_rig"
PAIR = """
[bearing]
designation = "7208 BE"
[operating]
load = { Fy = "-1 kN" }
inner_speed = "12000 rpm"
[set]
arrangement = "back_to_back"
spacing = "18 mm"
preload_force = "300 N"
[fit]
shaft = "k5"
housing = "H7"
housing_diameter = "120 mm"
[temperature]
inner_ring = "60 °C"
outer_ring = "50 °C"
[life]
"""


@pytest.fixture
def other(tmp_path):
    """The shipped rig under twice its load."""
    text = bj.files.shipped_scenes()[SCENE].read_text(encoding="utf-8")
    path = tmp_path / "heavy.toml"
    path.write_text(text.replace("-10.6 kN", "-21.2 kN"), encoding="utf-8")
    assert path.read_text(encoding="utf-8") != text
    return path


def test_compare_two_loads(run, other, tmp_path):
    out, table, page = (tmp_path / f"out.{end}" for end in ("json", "csv", "html"))
    done = run(
        "compare", SCENE, other, "--json", out, "--table", table, "--report", page
    )
    assert done.status == 0, done.err
    found = json.loads(out.read_text(encoding="utf-8"))
    assert found["scenes"] == [SCENE, "heavy"]
    assert found["result"] == ["converged", "converged"]
    told = found["quantities"]
    for k, source in enumerate((SCENE, other)):
        scene = bj.read_scene(source)
        numbers = solution_json(solve_scene(scene))
        moved, ring = numbers["displacement"], scene.moving_ring
        uy = moved[bj.FREEDOMS.index("uy") + 6 * (ring == "inner")]
        assert told[f"displacement_{ring}_uy [m]"][k] == pytest.approx(uy, rel=1e-12)
        largest = np.max(numbers["roller_load"])
        assert told["largest_load [N]"][k] == pytest.approx(largest, rel=1e-12)
    # The largest differences come first; round-off is none.
    sizes = list(found["difference"].values())
    assert sizes == sorted(sizes, reverse=True) and 0.4 < sizes[0] <= 1.0
    assert "operating.load.Fy  -10600 N         -21200 N" in done.out
    assert "results are the same" in done.out
    rows = table.read_text(encoding="utf-8").splitlines()
    assert len(rows) == 1 + len(told) and "<h2>Results</h2>" in page.read_text("utf-8")


def test_compare_identical_scenes(run):
    done = run("compare", SCENE, SCENE, "--set", "operating.load.Fy=-9 kN")
    assert done.status == 0
    alike, same, *_ = done.out.splitlines()
    assert alike == "all scenes have by --set: operating.load.Fy=-9 kN"
    assert same == "the scenes are the same"


def test_compare_tells_which_scene_is_not_solved(run, other, tmp_path):
    pulled = tmp_path / "pulled.toml"
    text = other.read_text(encoding="utf-8")
    pulled.write_text(text.replace("-21.2 kN", "1e300 N"), encoding="utf-8")
    done = run("compare", SCENE, pulled)
    assert done.status == 3
    assert done.err.startswith("bearingjax: pulled: non_finite: ")
    assert "peak_pressure" in done.out


def test_compare_table_of_scenes_named_as_its_columns(run, other, tmp_path):
    text, paths = other.read_text(encoding="utf-8"), []
    for name, load in (("result", "-10.6 kN"), ("difference [1]", "-21.2 kN")):
        paths.append(tmp_path / f"{name}.toml")
        paths[-1].write_text(text.replace("-21.2 kN", load), encoding="utf-8")
    table = tmp_path / "t.csv"
    done = run("compare", *paths, "--table", table)
    assert done.status == 0, done.err
    found = sweep_table.read(table)
    headers = ["result", "result (1)", "difference [1] (2)", "difference [1]"]
    assert list(found) == headers
    assert "largest_load [kN]" in list(found["result"])
    first, second = found["result (1)"], found["difference [1] (2)"]
    assert not np.array_equal(first, second) and np.isfinite([first, second]).all()


def test_compare_of_unsolved_scenes(run, other, tmp_path):
    text = other.read_text(encoding="utf-8").replace("-21.2 kN", "1e300 N")
    other.write_text(text, encoding="utf-8")
    table, page = tmp_path / "t.csv", tmp_path / "t.html"
    done = run("compare", other, other, "--table", table, "--report", page)
    assert (done.status, done.out) == (3, "")
    assert done.err.count("non_finite") == 2
    assert not table.exists() and not page.exists()


def test_compare_needs_two_scenes(run):
    done = run("compare", SCENE)
    assert done == (2, "", "bearingjax: compare: give two scenes or more\n")


@pytest.mark.parametrize(
    "values, expected",
    [
        ([1.0, 4.0], 0.75),
        ([-1.0, 1.0], 2.0),
        ([0.0, 0.0], 0.0),
        ([1.0, 1.0 + 1e-12], 0.0),
        ([np.inf, np.inf], 0.0),
        ([1.0, np.inf], np.nan),
        ([1.0, np.nan], np.nan),
    ],
)
def test_difference(values, expected):
    np.testing.assert_equal(difference(np.array(values)), expected)


def test_compare_omits_negligible_numbers():
    first = {"displacement_uy [m]": 1e-5, "displacement_ux [m]": 1e-13, "load [N]": 1.0}
    other = {"displacement_uy [m]": 2e-5, "displacement_ux [m]": -3e-11}
    found = _side_by_side([first, other])
    assert list(found) == ["displacement_uy [m]", "load [N]"]


@pytest.mark.slow
def test_compare_warns_of_each_scene_as_solve_does(run, tmp_path, untyped):
    """The preload of a set on its seats and the life included."""
    path = tmp_path / "pair.toml"
    path.write_text(PAIR, encoding="utf-8")
    out = tmp_path / "out.json"
    assert run("solve", path, "--json", out).status == 0
    told = json.loads(out.read_text(encoding="utf-8"))["warnings"]
    assert any(text.startswith("preload: 300 N as ground are") for text in told)
    done = run("compare", path, path, "--json", out)
    assert done.status == 0, done.err
    assert json.loads(out.read_text(encoding="utf-8"))["warnings"] == [told, told]
    assert all(f"(1): {text}\n" in done.out for text in told)

"""`bearingjax select`: a scene that says what a bearing must do."""

import re
from pathlib import Path

import numpy as np
import pytest
from runs import Runs, Study

from bearingjax import SceneError, SolveError
from bearingjax.files import shipped_scenes
from bearingjax.shafts.warning import axial_load
from bearingjax.studies.select.read import read_select
from bearingjax.studies.select.run import (
    positions_as_dict,
    positions_columns,
    positions_report,
    run_select,
    select_report,
)
from bearingjax.studies.shaft.read import read_shafts
from bearingjax.studies.shaft.run import run_shafts

TEXT = shipped_scenes()["select_gearbox"].read_text(encoding="utf-8")
FILES = {
    "--json": "a.json",
    "--table": "a.csv",
    "--plot": "a.png",
    "--report": "a.html",
}
STUDIES = {"gearbox": Study(("select", TEXT), files=FILES, result=None)}
OWN = """designation,type,bore [mm],outside_diameter [mm],width [mm],C [kN],C0 [kN],\
mass [kg]
X 1,deep_groove_ball,40,90,23,50,26,0.6
"""


class TestRuns(Runs):
    pass


@pytest.mark.slow
def test_select_json_and_table(written):
    found = written("gearbox")
    fits, excluded = found.numbers["fits"], found.numbers["excluded"]
    assert len(fits) + len(excluded) == len(found.rows) - 1
    assert found.numbers["smallest"] == fits[0]["designation"]
    assert all(row["life_hours"] >= 12000.0 for row in fits)
    assert all(row["bore"] == 0.04 for row in fits)
    short = [row for row in excluded if row["requirement"] == "life_hours"]
    assert short and all(row["value"] < row["limit"] == 12000.0 for row in short)
    assert sum(found.numbers["counts"].values()) == len(excluded)
    assert f"the smallest: {fits[0]['designation']}" in found.done.out


def placed(folder, text=TEXT):
    (folder / "own.csv").write_text(OWN, encoding="utf-8")
    path = folder / "mine.toml"
    path.write_text(text.replace("types =", 'file = "own.csv"\ntypes ='), "utf-8")
    return path


@pytest.mark.slow
def test_select_joins_own_bearings(tmp_path):
    choice = read_select(placed(tmp_path))
    own = choice.entries[-1]
    assert own.designation == "X 1" and own.mass == 0.6
    row = choice.install(own).drawing.bearing
    np.testing.assert_allclose(row.published.ratings[:2], [50e3, 26e3])
    assert choice.inputs["select"]["file"] == str(tmp_path / "own.csv")


@pytest.mark.parametrize(
    "old, new, told",
    [
        ("C0 [kN]", "C1 [kN]", "has no column C0"),
        ("mass [kg]", "price", "column price is not known"),
        (",50,", ",x,", "bearing 1, X 1: C: 'x kN' does not begin"),
        (",50,", ",50000,", "bearing 1, X 1"),
        ("deep_groove_ball", "sleeve", "bearing 1, X 1: type: 'sleeve' is not known"),
    ],
)
def test_select_names_bad_rows_of_own_bearings(tmp_path, old, new, told):
    path = placed(tmp_path)
    own = path.with_name("own.csv")
    own.write_text(OWN.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(SceneError, match=f"own.csv: .*{told}"):
        read_select(path)


def test_select_without_a_fit_tells_the_nearest():
    settings = ["select.outside_diameter={at_most='5 mm'}", "select.bore=unset"]
    choice = read_select("select_gearbox", settings)
    found = run_select(choice)
    assert found.fits == [] and found.smallest is None
    (first,) = found.nearest_misses(1)
    assert first.endswith("of 5 mm")
    assert "0 fit; the smallest: none" in str(select_report(choice, found))


GEARS = Path(__file__).with_name("refused") / "gears.toml"
POSITIONS = """
[select]
types = ["deep_groove_ball"]
short_list = 2
load_ratio = 1.0
outside_diameter = { at_least = "65 mm" }

[select.positions.C]
life_hours = "20000 h"

[select.positions.D]
bore = "40 mm"
"""


@pytest.fixture
def shafts(tmp_path):
    path = tmp_path / "pair.toml"
    path.write_text(GEARS.read_text("utf-8") + POSITIONS, "utf-8")
    return path


@pytest.mark.slow
def test_select_positions_finds_the_lives_of_the_scene_with_these_bearings(shafts, run):
    """Lives of the best pair are those of `shaft` with its designations, and those
    under the present loads those of the present bearings, one of them turned."""
    turned = ["bearings.D.turned=true", "select.short_list=1"]
    choice = read_select(shafts, turned)
    found = run_select(choice)
    assert found.holds.tolist() == [True] and found.best is not None
    settings = [f"bearings.{k}.designation={v}" for k, v in found.best.items()]
    by_hand = run_shafts(read_shafts(shafts, [*turned, *settings]))
    by_number = {
        "life_hours": by_hand.hours[2:],
        "static_safety": [one.life.static_safety for one in by_hand.bearings[2:]],
        "axial_force": [
            axial_load(by_hand.task.system, k, by_hand.solution.load[k]) for k in (2, 3)
        ],
    }
    for name, values in by_number.items():
        np.testing.assert_allclose(found.table[name][0], values, rtol=1e-7, atol=1e-6)
    now = run_shafts(read_shafts(shafts, turned)).hours[2:]
    for hours, one in zip(now, found.alone.values(), strict=True):
        row = one.table["designation"].tolist().index("6308")
        assert one.table["life_hours"][row] == pytest.approx(hours, rel=1e-6)
    numbers = positions_as_dict(choice, found)
    assert numbers["best"] == found.best and numbers["kinds"] == found.kinds
    assert len(positions_columns(found)["position"]) == 2
    assert "1 of 1 combinations hold" in str(positions_report(choice, found))
    assert found.to_xarray()["radial_force"].attrs["units"] == "N"
    for setting, told in (
        ("bearings.C.floating=true", "no_load_path with the present bearings (case 0)"),
        ("bearings.C.position='60 mm'", "the shaft has 0.04 and 0.05 m at C"),
        (
            "select.positions.C.mass='1 g'",
            "no bearing fits C under the loads with the present ones",
        ),
    ):
        with pytest.raises((SceneError, SolveError), match=re.escape(told)):
            run_select(read_select(shafts, [setting]))
    done = run("select", shafts, "--set", "select.positions.C.mass=1 g")
    assert done.status == 3 and "no bearing fits C under" in done.err


@pytest.mark.parametrize(
    "setting, told",
    [
        ("select.positions.X={}", "`select.positions.X`: 'X' is not known"),
        (
            "bearings.C={shaft='out', position='30 mm', stiffness={radial='1 N/um'}}",
            "`select.positions.C`: has springs",
        ),
        ("select.positions.C.short_list=2", "`select.positions.C.short_list`: unknown"),
        ("select.positions.C.boer=2", "unknown key (did you mean `bore`?)"),
        ("select.positions.C.types=['sleeve']", "'sleeve' is not known"),
        ("select.positions={}", "`requirements` is"),
        (
            "life.required='9000 h'",
            "`select.positions.C.life_hours`: is 'given'; it must",
        ),
        ("select.position={B={mass='1 kg'}}", "`select.position`: unknown key"),
        (
            "select.positions.C.width={at_least='9 mm',at_most='8 mm'}",
            "`select.positions.C.width`: is [0.009 0.008] m; it must be finite",
        ),
        ("select.short_list=0", "short_list"),
        ("select.short_list=11", "it combines 121"),
        ("heat.ambient=20 °C", "`heat`: stands beside [select]"),
        ("select=unset", "select"),
    ],
)
def test_select_of_positions_refuses(shafts, setting, told):
    with pytest.raises(SceneError, match=re.escape(told)):
        run_select(read_select(shafts, [setting]))

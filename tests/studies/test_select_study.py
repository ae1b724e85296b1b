"""`bearingjax select`: a scene that says what a bearing must do."""

import numpy as np
import pytest
from runs import Runs, Study

from bearingjax import SceneError
from bearingjax.files import shipped_scenes
from bearingjax.studies.select.read import read_select
from bearingjax.studies.select.run import nearest_misses, run_select, select_report

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
        (",50,", ",x,", "bearing 1, X 1: --capacity: 'x kN' does not begin"),
        (",50,", ",50000,", "bearing 1, X 1"),
        ("deep_groove_ball", "sleeve", "bearing 1, X 1: --type: 'sleeve' is not known"),
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
    (first,) = nearest_misses(found, 1)
    assert first.endswith("of 5 mm")
    assert "0 fit; the smallest: none" in str(select_report(choice, found))

"""[tolerances] of scenes: what scatters, and what it adds to."""

import jax
import numpy as np
import pytest
from tolerances import ROUNDING

from bearingjax.decide import Tolerances
from bearingjax.files import SceneError, shipped_scenes
from bearingjax.fits import mounting_at, with_bearing_dimensions
from bearingjax.optimise.variable import rated_paths
from bearingjax.studies.tolerances.read import read_tolerances
from bearingjax.studies.tolerances.report import tolerance_warnings
from bearingjax.studies.tolerances.run import ToleranceRun, run_tolerances


@pytest.mark.parametrize("place, side", [("tightest", 1), ("loosest", -1)])
def test_sizes_of_classes_add_to_the_fits_of_their_limits(place, side):
    """With every size at its end the fits are those of `mounting_at`."""
    task = read_tolerances("tolerances_seats")
    design, _, scatters, _ = task.given
    large = {"fit.shaft", "fit.outside_diameter"}  # tight where they are large
    price = {one.name: one.cost for one in scatters}  # of one metre less
    assert price.pop("fit.shaft") == pytest.approx(0.8 / 4e-6)
    assert price.pop("fit.clearance") == pytest.approx(0.5 / 5e-6)
    assert set(price.values()) == {None}
    found = {}
    for one in scatters[:5]:
        low, high = one.ends
        value = high if (one.name in large) == (side > 0) else low
        for path, factor in one.path.items():
            found[path] = found.get(path, 0.0) + factor * value
    given = jax.device_get((design.mounting, design.drawing.bearing, design.limits))
    there = mounting_at(with_bearing_dimensions(*given[:2]), place, *given[2])
    assert found.keys() == {
        f"mounting.{name}"
        for name in ("radial_clearance", "shaft_interference", "housing_interference")
    }
    for path, value in found.items():
        kept = float(getattr(there, path.removeprefix("mounting.")))
        assert value == pytest.approx(kept, rel=ROUNDING, abs=1e-18)


def test_a_life_of_the_scene_counts_for_warnings_whatever_is_measured():
    oil = ["life.viscosity=20 mm^2/s", "life.contamination=0.5"]
    asked = "tolerances.measures=[{measure='clearance'}]"
    assert "life" not in read_tolerances("tolerances_seats").options
    task = read_tolerances("tolerances_seats", [*oil, asked])
    assert task.options["life"].viscosity == pytest.approx(20e-6)
    task = read_tolerances("tolerances_seats", ["life.reliability=0.95", asked])
    assert task.options["life"].reliability == pytest.approx(0.95)


def test_numbers_that_take_published_ratings_away_are_told(tmp_path):
    task = read_tolerances("tolerances_seats")
    design = task.given[0]
    paths = [path for one in task.given[2] for path in one.path]
    assert rated_paths(design, paths) == []
    rated = "drawing.bearing.ball_diameter"
    assert rated_paths(design, [*paths, rated]) == [rated]
    text = shipped_scenes()["tolerances_seats"].read_text("utf-8")
    text += '"bearing.ball_diameter" = { mean = "11.9 mm", deviation = "1 um" }\n'
    (tmp_path / "s.toml").write_text(text, "utf-8")
    task = read_tolerances(tmp_path / "s.toml")
    none, codes = np.zeros((4, 0)), np.zeros(4, int)
    found = Tolerances(task.given[2], (), None, none, none, codes)
    found = ToleranceRun(found, None)
    assert [one.kind for one in tolerance_warnings(task, found)][-1] == (
        "ratings_dropped"
    )


SHAFTS = """
[drive]
speed = "1500 rpm"
power = "1 kW"

[shaft.s]
segments = [{ length = "200 mm", outer_diameter = "40 mm" }]

[load.pull]
shaft = "s"
position = "60 mm"
Fy = "-3 kN"

[gear.a]
shaft = "s"
position = "100 mm"
teeth = 40
normal_module = "2 mm"

[shaft.t]
segments = [{ length = "200 mm", outer_diameter = "40 mm" }]

[gear.b]
shaft = "t"
position = "100 mm"
teeth = 40
normal_module = "2 mm"
mates_with = "a"
mesh_angle = "-90 deg"

[coupling.out]
shaft = "t"

[bearings.A]
designation = "6208/C3"
shaft = "s"
position = "10 mm"
fit = { shaft = "k5", housing = "H7", housing_diameter = "110 mm" }

[bearings.B]
designation = "6208"
shaft = "s"
position = "190 mm"
floating = true

[bearings.C]
designation = "6208"
shaft = "t"
position = "10 mm"

[bearings.D]
designation = "6208"
shaft = "t"
position = "190 mm"
floating = true

[cases]
spectrum = [{ hours = "1 h", KEY = FIRST }, { hours = "2 h", KEY = LAST }]

[tolerances]
measures = [{ measure = "peak_pressure" }]

[tolerances.numbers]
"bearings.B.radial_internal_clearance" = { from = "5 um", to = "15 um" }
"""


def shafts(tmp_path, key, first, last, more=""):
    text = SHAFTS.replace("KEY", key).replace("FIRST", first).replace("LAST", last)
    (tmp_path / "s.toml").write_text(text + more, "utf-8")
    return read_tolerances(tmp_path / "s.toml")


def test_load_cases_stay_where_a_clearance_class_scatters(tmp_path):
    """Its clearance becomes a number of the design, before the loads of the cases."""
    design, cases, scatters, _ = shafts(
        tmp_path, '"load.pull.Fy"', '"-1 kN"', '"-6 kN"'
    ).given
    names = [one.name for one in scatters]
    assert names[0] == "bearings.A.fit.clearance" and len(names) == 6
    assert names[-1] == "bearings.B.radial_internal_clearance"
    last = jax.tree.map(lambda x: x[-1], cases)
    loaded = design._in_case(last).system.loads[0]
    np.testing.assert_allclose(loaded.force, [0.0, -6e3, 0.0])
    assert float(loaded.position) == 0.06


def test_narrowing_of_a_temperature_is_a_difference(tmp_path):
    text = shipped_scenes()["tolerances_seats"].read_text("utf-8")
    line = 'deviation = "2 K"'
    assert line in text
    more = f'{line}, narrowing = {{ by = "1 degC", costs = 1 }}'
    (tmp_path / "s.toml").write_text(text.replace(line, more), "utf-8")
    with pytest.raises(SceneError, match="narrowing.by.*difference; write it in K"):
        read_tolerances(tmp_path / "s.toml")


def test_numbers_that_may_not_scatter_beside_others(tmp_path):
    fits = '"bearings.A.fit.shaft"', '"k5"', '"m5"'
    task = shafts(tmp_path, *fits)
    with pytest.raises(SceneError, match="A.fit.shaft differs from case to case"):
        run_tolerances(task)
    loads = '"load.pull.Fy"', '"-1 kN"', '"-6 kN"'
    line = '"gear.{}.normal_module" = {{ from = "1.9 mm", to = "2 mm" }}\n'.format
    with pytest.raises(SceneError, match="the same number as gear.a.normal_module"):
        shafts(tmp_path, *loads, line("a") + line("b"))
    same = '"bearings.A.radial_internal_clearance" = { from = "5 um", to = "9 um" }'
    with pytest.raises(SceneError, match="the class of bearings.A.fit.clearance"):
        shafts(tmp_path, *loads, same)

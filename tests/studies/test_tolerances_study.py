"""[tolerances] of scenes: what scatters, and what it adds to."""

import jax
import numpy as np
import pytest
from tolerances import ROUNDING

from bearingjax.decide import Tolerances
from bearingjax.files import shipped_scenes
from bearingjax.fits import mounting_at, with_bearing_dimensions
from bearingjax.optimise.variable import rated_paths
from bearingjax.studies.tolerances.read import read_tolerances
from bearingjax.studies.tolerances.report import tolerance_warnings
from bearingjax.studies.tolerances.run import ToleranceRun


@pytest.mark.parametrize("place, side", [("tightest", 1), ("loosest", -1)])
def test_sizes_of_classes_add_to_the_fits_of_their_limits(place, side):
    """With every size at its end the fits are those of `mounting_at`."""
    task = read_tolerances("tolerances_seats")
    design, _, scatters, _ = task.given
    large = {"fit.shaft", "fit.outside_diameter"}  # tight where they are large
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

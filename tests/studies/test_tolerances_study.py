"""[tolerances] of scenes: what scatters, and what it adds to."""

import jax
import pytest
from tolerances import ROUNDING

from bearingjax.fits import mounting_at, with_bearing_dimensions
from bearingjax.studies.tolerances.read import read_tolerances


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

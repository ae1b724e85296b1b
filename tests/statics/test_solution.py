"""Arrays of a solution with their names, units and axes."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from plot.made import solution

import bearingjax as bj

ROLLERS = bj.CylindricalRollerBearing(14, 0.065, 0.010, 0.010)
BALLS = bj.DeepGrooveBallBearing(
    9, 0.046, 0.0095, outer_osculation=0.52, inner_osculation=0.52
)
SOLVED = {"rollers": solution(ROLLERS), "balls": solution(BALLS, angles=(0.1, -0.1))}


@pytest.mark.parametrize("name", SOLVED)
def test_every_axis_of_a_solution_has_a_name(name):
    found = SOLVED[name].to_xarray()
    known = {"element", "raceway", "contact", "half_axis", "rib", "point", "end"}
    known |= {"ring_freedom", "moved_ring_freedom", "ring_component", "section_freedom"}
    assert {*found.sizes} <= known
    assert found.roller_load.sel(raceway="inner").units == "N"
    assert found.force.sel(ring_component="outer_Mx") == 0.0
    assert found.residual == 0.0 and str(found.result.values) == "converged"


@pytest.mark.parametrize("name", SOLVED)
def test_axes_under_vmap_are_led_by_cases(name):
    one = SOLVED[name]
    several = jax.tree.map(lambda a: jnp.stack([a, a, a]), one)
    found, single = several.to_xarray(), one.to_xarray()
    assert {*found} == {*single}
    for key, values in single.items():
        assert found[key].dims == ("case", *values.dims), key
        assert found[key].attrs == values.attrs
        np.testing.assert_array_equal(found[key][1], values)
    assert one.failure_message == ""
    with pytest.raises(ValueError, match="several cases; map over them"):
        str(several.failure_message)

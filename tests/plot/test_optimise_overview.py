"""The picture of an optimised design says what was found."""

import numpy as np
import pytest
from matplotlib.patches import Rectangle

import bearingjax as bj
from bearingjax import plot


@pytest.fixture(scope="module")
def found():
    bearing = bj.CylindricalRollerBearing(
        6, 0.05, 0.010, 0.012, roller_profile=bj.CircularCrown(2.0)
    )
    element = bj.BearingElement(bearing, quadrature=bj.numerics.Midpoint(5))
    load = np.zeros((2, 6))
    load[:, 0] = [1e3, 4e3]
    radius = bj.optimise.Variable("bearing.roller_profile.crown_radius", 1.0, 10.0)
    objective, cases = bj.optimise.PeakPressure(), bj.Cases(load)
    return bj.optimise.optimise(
        element,
        cases,
        [radius],
        objective,
        search=bj.optimise.SearchOptions(
            method="nelder-mead", max_steps=4, solve=bj.statics.SolveOptions(points=21)
        ),
        support=bj.Support(free=["ux"]),
    )


@pytest.mark.slow
def test_before_and_after(found):
    figure = plot.optimise_overview(found, title="a name")
    assert figure.get_suptitle() == "a name"
    profile, pressure, cases, history = figure.axes
    before, after = (np.asarray(line.get_ydata()) for line in profile.get_lines())
    # Less crown, less drop; at the end s²/(2R) and a little.
    assert np.all(after <= before)
    assert before.max() == pytest.approx(1e6 * 0.006**2 / (2 * 2.0), rel=1e-4)
    tops = [np.max(line.get_ydata()) for line in pressure.get_lines()]
    exact = [1e-6 * found.before.exact, 1e-6 * found.after.exact]
    assert np.allclose(tops, exact) and tops[1] < tops[0]
    assert "case 1" in pressure.get_title()
    heights = [bar.get_height() for bar in cases.patches if isinstance(bar, Rectangle)]
    assert len(heights) == 4 and max(heights) == pytest.approx(exact[0])
    (line,) = history.get_lines()
    steps, objective = line.get_xdata(), np.asarray(line.get_ydata())
    assert list(steps) == list(range(len(found.history.objective)))
    assert objective[0] == 1.0 and objective[-1] < 1.0
    assert "peak pressure" in history.get_ylabel()


def test_miss_of_constraints_is_shown(found):
    miss = np.linspace(1.0, 0.0, len(found.history.objective))
    history = found.history._replace(violation=miss)
    missed = type(found)(**{**vars(found), "history": history})
    figure = plot.optimise_overview(missed)
    assert figure.get_suptitle() == "Optimised design"
    (line,) = figure.axes[-1].get_lines()
    assert np.array_equal(line.get_ydata(), miss)

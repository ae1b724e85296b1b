"""Pictures of many cases, of sweeps written by hand."""

import dataclasses

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.cases.cases import Cases
from bearingjax.cases.sweep import Sweep
from bearingjax.numerics import Result
from bearingjax.plot.style import power_of_ten

plt = pytest.importorskip("matplotlib.pyplot")
FY = np.tile(-1e3 * np.arange(1.0, 9.0), 2)
PLAY = np.repeat([0.0, 20e-6], 8)
LARGEST = 0.3 * np.abs(FY) + 1e7 * PLAY


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def swept(fy=FY, lost=()):
    load = np.zeros((len(fy), 6))
    load[:, 1] = fy
    result = np.full(len(fy), int(Result.CONVERGED))
    result[list(lost)] = int(Result.STEP_LIMIT)
    displacement = np.zeros((len(fy), 12))
    displacement[:, 6] = 1e-20 * np.arange(len(fy))  # round-off
    displacement[:, 7] = 1e-9 * fy - PLAY / 2
    outputs = {
        "result": result,
        "largest_load": LARGEST,
        "displacement": displacement,
        "iterations": np.arange(len(fy)),
    }
    nothing = dict.fromkeys(field.name for field in dataclasses.fields(Cases))
    cases = Cases(**{**nothing, "load": load, "prescribed": {}})
    return Sweep(cases, outputs, "inner", ())


def test_a_grid_is_drawn_over_the_input_with_most_values():
    """A curve for each clearance, without the case that failed; no round-off."""
    beside = {"bearing.radial_internal_clearance [m]": PLAY}
    figure = bj.plot.sweep_overview(swept(lost=(3,)), beside, "map")
    titles = [ax.get_title() for ax in figure.axes]
    assert titles == ["largest_load [kN]", "displacement_inner_uy [µm]"]
    first, second = figure.axes
    assert first.get_xlabel() == "Fy [kN]"
    loads = np.delete(np.arange(8), 3)
    for line, mine in zip(first.get_lines(), (loads, np.arange(8, 16)), strict=True):
        order = mine[::-1]
        np.testing.assert_allclose(np.asarray(line.get_xdata()), 1e-3 * FY[order])
        np.testing.assert_allclose(np.asarray(line.get_ydata()), 1e-3 * LARGEST[order])
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts()]
    assert [name.partition("[µm]: ")[2] for name in names] == ["0", "20"]


def test_inputs_that_neither_axis_nor_colour_tells_are_named():
    play = np.repeat([0.0, 20e-6], 8)
    tilt = np.tile(np.repeat([0.0, 2e-3], 4), 2)
    fy = np.tile(FY[:4], 4)
    beside = {"play [m]": play, "gx [rad]": tilt}
    (legend,) = bj.plot.sweep_overview(swept(fy), beside).figure.legends
    assert legend.get_title().get_text() == "curves of one colour: gx from 0 to 2 mrad"
    # Without colours, as of seven clearances, the axis names them all.
    many = {"play [m]": np.repeat(1e-6 * np.arange(8), 2)}
    figure = bj.plot.sweep_overview(swept(np.tile(FY[:2], 8)), many)
    assert figure.axes[0].get_xlabel() == "play [µm]"


def test_other_cases_are_drawn_over_their_number():
    fy = np.where(np.arange(16) == 5, FY[4], FY)  # one load twice
    figure = bj.plot.sweep_overview(swept(fy), {"play [m]": PLAY})
    ax = figure.axes[0]
    assert ax.get_xlabel() == "case" and not figure.legends
    np.testing.assert_array_equal(ax.get_lines()[0].get_xdata(), np.arange(16))


def few_settings(results):
    """Two curves, and as many results."""
    fine = swept()
    more = {f"force_{k}": LARGEST + k for k in range(results - 2)}
    return dataclasses.replace(fine, outputs={**fine.outputs, **more})


@pytest.mark.parametrize("results", [2, 3, 4])
def test_few_settings_beside_many_results(results):
    beside = {"bearing.radial_internal_clearance [m]": PLAY}
    figure = bj.plot.sweep_overview(few_settings(results), beside)
    assert len(figure.axes) == results


def test_one_input_alone_is_one_curve():
    whole = swept()
    one = dataclasses.replace(
        whole,
        cases=dataclasses.replace(whole.cases, load=whole.cases.load[:8]),
        outputs={name: values[:8] for name, values in whole.outputs.items()},
    )
    figure = bj.plot.sweep_overview(one)
    assert not figure.legends
    for ax in figure.axes:
        (line,) = ax.get_lines()
        assert ax.get_xlabel() == "Fy [kN]"
        np.testing.assert_allclose(np.asarray(line.get_xdata()), 1e-3 * FY[7::-1])


def test_large_and_small_numbers_are_counted_in_powers_of_ten():
    """No power of ten stands in a corner: it is part of the unit, and lives are in
    millions of revolutions."""
    fine = swept()
    lives = np.linspace(1e8, 3e11, len(FY))
    more = {"reference_rating_life": lives, "damage": 1 / lives, "life_hours": lives}
    figure = bj.plot.sweep_overview(
        dataclasses.replace(fine, outputs={"result": fine.result, **more})
    )
    figure.draw_without_rendering()
    titles = [ax.get_title() for ax in figure.axes]
    assert titles == [
        "reference_rating_life [10³ million rev]",
        "damage [1/million rev]",
        "life_hours [10⁹ h]",
    ]
    drawn = (1e-9 * lives, 1e6 / lives, 1e-9 * lives)
    for ax, values in zip(figure.axes, drawn, strict=True):
        (line,) = ax.get_lines()
        np.testing.assert_allclose(np.asarray(line.get_ydata()), values)
        assert ax.yaxis.get_offset_text().get_text() == ""
    assert power_of_ten(2e-8) == (1e9, "10⁻⁹")
    assert power_of_ten(0.0) == power_of_ten(np.inf) == (1.0, "")


def ticks(ax):
    return [label.get_text() for label in ax.get_xticklabels()]


def test_axes_over_names_show_the_names():
    """A grid of eight bearings and two loads: along the axis, or the colours."""
    bearings = np.tile([f"62{k:02d}" for k in range(4, 12)], 2)
    oils = np.repeat(["VG 32", "VG 100"], 8)
    figure = bj.plot.sweep_overview(
        swept(np.repeat([-1e3, -2e3], 8)), {"bearing": bearings}
    )
    ax = figure.axes[0]
    assert ax.get_xlabel() == "bearing" and ticks(ax) == list(bearings[:8])
    figure.draw_without_rendering()
    figure = bj.plot.sweep_overview(swept(), {"oil": oils})
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["oil: VG 32", "oil: VG 100"]
    assert figure.axes[0].get_xlabel() == "Fy [kN]"


def test_cases_with_names_of_their_own_are_drawn_over_them():
    """Each with its own load too, and one of them not solved."""
    names = np.array([f"case {k} of a long list" for k in range(16)], dtype=object)
    figure = bj.plot.sweep_overview(swept(lost=(3,)), {"case": names})
    ax = figure.axes[0]
    assert ticks(ax) == list(names) and ax.get_xticklabels()[0].get_rotation() == 90
    (line,) = ax.get_lines()
    drawn = np.asarray(line.get_xdata())
    np.testing.assert_array_equal(drawn, np.delete(np.arange(16), 3))

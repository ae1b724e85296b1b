"""Pictures of a contact draw what its solution and the slices say, with units."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np
import pytest

import bearingjax as bj
from bearingjax import plot
from bearingjax.contact.halfspace import (
    RollerContact,
    even_grid,
    graded_grid,
    stress_below,
)
from bearingjax.contact.slices import slices

LOADS = (1000.0, 3000.0)


@pytest.fixture(scope="module")
def contact():
    return RollerContact(0.015, 0.010, 0.012)


@pytest.fixture(scope="module")
def solutions(contact):
    grid = graded_grid(0.015, 0.25e-3, 9, 12, grading=3.0)
    return [contact.solve(load, grid=grid) for load in LOADS]


@pytest.fixture(scope="module")
def sliced(contact, solutions):
    return [slices(contact, s.load, s.tilt, s.grid.y) for s in solutions]


def data(line):
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def drawn(ax, style="-"):
    """Lines of a style that have points."""
    lines = [data(line) for line in ax.get_lines() if line.get_linestyle() == style]
    return [(x, y) for x, y in lines if x.size]


def test_map_is_the_pressure_on_both_sides(solutions):
    ax = plot.contact_map(solutions[1])
    mesh: Any = ax.collections[0]
    shown = np.ma.getdata(mesh.get_array()).reshape(9, 12)
    pressure = 1e-6 * np.asarray(solutions[1].pressure)
    assert np.array_equal(shown[4:], pressure)
    assert np.array_equal(shown[:5], pressure[::-1])
    mask = np.ma.getmaskarray(mesh.get_array()).reshape(9, 12)
    assert np.array_equal(mask, shown == 0)
    corners = mesh.get_coordinates()
    assert np.allclose(corners[0, 0], [-7.5, -250.0])
    assert np.allclose(corners[-1, -1], [7.5, 250.0])
    assert "[mm]" in ax.get_xlabel() and "[µm]" in ax.get_ylabel()
    # The ends are off the scale, and the head gives them with their cell.
    assert mesh.get_clim()[1] < 0.7 * pressure.max()
    bar = ax.figure.axes[1]
    assert "[MPa]" in bar.get_ylabel()
    large, small = pressure[0, 0], pressure[0, -1]
    cell = 2e6 * float(solutions[1].grid.half_y[0])
    told = f"end cells of {cell:.3g} µm: {large:.0f}, {small:.0f} MPa"
    assert ax.get_title() == f"Contact pressure under 3 kN; {told}"


def test_map_of_a_profiled_roller_has_all_on_the_scale():
    roller = RollerContact(0.015, 0.010, 0.010, roller_profile=bj.Logarithmic())
    grid = even_grid(0.015, 0.2e-3, 8, 9, symmetric=False)
    solution = roller.solve(1000.0, grid=grid)
    ax = plot.contact_map(solution)
    mesh: Any = ax.collections[0]
    assert mesh.get_clim()[1] == pytest.approx(1e-6 * float(solution.peak_pressure))
    shown = np.ma.getdata(mesh.get_array()).reshape(8, 9)
    assert np.array_equal(shown, 1e-6 * np.asarray(solution.pressure))


def test_surface(solutions):
    ax = plot.contact_surface(solutions[1])
    assert ax.name == "3d"
    assert ax.get_title().endswith("MPa, cut off")
    assert "[MPa]" in ax.get_zlabel()
    again = plot.contact_surface(
        solutions[1], plt.figure().add_subplot(projection="3d")
    )
    assert again.get_zlim() == ax.get_zlim()
    with pytest.raises(ValueError, match="needs axes of subplot"):
        plot.contact_surface(solutions[1], plt.figure().add_subplot())


def test_centre_lines_beside_slices(solutions, sliced):
    ax = plot.centre_pressure(solutions, slices=sliced)
    solid, dashed = drawn(ax), drawn(ax, "--")
    assert len(solid) == len(dashed) == 2
    for (y, found), (_, other), solution, one in zip(
        solid, dashed, solutions, sliced, strict=True
    ):
        assert np.array_equal(y, 1e3 * np.asarray(solution.grid.y))
        assert np.array_equal(found, 1e-6 * np.asarray(solution.centre_pressure))
        assert np.array_equal(other, 1e-6 * np.asarray(one.pressure))
    # End values with the length of their cells; triangles for what is off the scale.
    legend = ax.get_legend()
    cell = 2e6 * float(solutions[0].grid.half_y[0])
    head = legend.get_title().get_text()
    assert head == f"load: pressure in the end cells, {cell:.3g} µm long [MPa]"
    texts = [text.get_text() for text in legend.get_texts()]
    ends = 1e-6 * np.asarray(solutions[0].centre_pressure)[[0, -1]]
    assert texts[0] == f"1 kN: {ends[0]:.0f}, {ends[1]:.0f}"
    assert texts[1].startswith("3 kN: ") and texts[2] == "slices"
    marks = [line for line in ax.get_lines() if line.get_marker() == "^"]
    top = ax.get_ylim()[1]
    for mark, (_, found) in zip(marks, solid, strict=True):
        assert len(data(mark)[0]) == np.count_nonzero(found[[0, -1]] > top)
    assert "[MPa]" in ax.get_ylabel() and "[mm]" in ax.get_xlabel()


def test_line_load(solutions, sliced):
    given = plt.figure().add_subplot()
    ax = plot.contact_line_load(solutions, given, slices=sliced)
    assert ax is given
    for (_, found), solution in zip(drawn(ax), solutions, strict=True):
        assert np.array_equal(found, 1e-3 * np.asarray(solution.line_load))
    for _, other in drawn(ax, "--"):
        assert np.allclose(other, other[0])  # a straight roller, upright
    assert [text.get_text() for text in ax.texts] == ["1 kN", "3 kN"]
    assert "[N/mm]" in ax.get_ylabel()


def test_page(solutions, sliced):
    figure = plot.contact_overview(solutions, sliced, title="a name")
    assert figure.get_suptitle() == "a name"
    text = next(ax for ax in figure.axes if not ax.axison).texts[0].get_text()
    peak = 1e-6 * float(solutions[1].peak_pressure)
    assert text.startswith("under 3 kN:  approach ")
    assert f"peak {peak:.0f} MPa at 7.4" in text and "in a cell " in text
    factor = peak / (1e-6 * float(sliced[1].peak_pressure))
    assert f"{factor:.3g} times that of the slices" in text
    assert "under 3 kN" in figure.axes[0].get_title()


def test_no_contact(solutions, sliced):
    zero = eqx.tree_at(
        lambda s: (s.pressure, s.touching), solutions[0], replace_fn=jnp.zeros_like
    )
    none = eqx.tree_at(
        lambda s: (s.line_load, s.pressure), sliced[0], replace_fn=jnp.zeros_like
    )
    plot.contact_overview([zero], [none])
    plot.contact_surface(zero)


@pytest.mark.parametrize("section", ["across", "along"])
@pytest.mark.parametrize("kind", ["von_mises", "greatest_shear"])
def test_contact_stress_marks_largest_value(solutions, section, kind):
    """The cross stands where the stress is what the head says."""
    solution = solutions[1]
    ax = plot.contact_stress(solution, section=section, y=1e-3, kind=kind)
    place, depth = (float(v[0]) for v in data(ax.get_lines()[0]))
    x, y = (1e-6 * place, 1e-3) if section == "across" else (0.0, 1e-3 * place)
    there = stress_below(solution, x, y, 1e-6 * depth)
    largest = 1e-6 * float(getattr(there, kind))
    assert f"largest {largest:.0f} MPa" in ax.get_title()
    assert ax.get_ylabel() == "depth [µm]" and ax.yaxis_inverted()


def test_stress_refuses(solutions, contact):
    with pytest.raises(ValueError, match="`section` is 'up'; it must be"):
        plot.contact_stress(solutions[0], section="up")
    with pytest.raises(ValueError, match="`kind` is 'tresca'; it must be one of"):
        plot.contact_stress(solutions[0], kind="tresca")
    apart = contact.solve(approach=-1e-6, grid=solutions[0].grid)
    with pytest.raises(ValueError, match="there is no contact"):
        plot.contact_stress(apart)

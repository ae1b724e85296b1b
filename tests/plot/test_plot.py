"""Every plot draws what the solution says, with units, on its own or given axes."""

import subprocess
import sys

import equinox as eqx
import jax
import jax.numpy as jnp
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Ellipse

import bearingjax as bj
from bearingjax import plot
from bearingjax.plot.section import section

matplotlib.use("Agg")

MM = 1e3


def data(line):
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


@pytest.fixture(autouse=True)
def close_figures():
    yield
    for number in plt.get_fignums():
        plt.figure(number).canvas.draw()  # nothing may fail or warn while drawing
    plt.close("all")


@pytest.fixture(scope="module")
def bearing():
    return bj.CylindricalRollerBearing(
        8,
        0.065,
        0.010,
        0.010,
        radial_internal_clearance=25e-6,
        roller_profile=bj.Logarithmic(),
        ribs=bj.Ribs.arrangement("NJ", bj.Rib(0.3, 1.5e-3), 60e-6),
    )


@pytest.fixture(scope="module")
def solution(bearing):
    element = bj.BearingElement(bearing, quadrature=bj.Midpoint())
    return bj.solve_load(element, [0.0, -4000.0, 0.0, 0.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def unloaded(solution):
    zero = jax.tree.map(jnp.zeros_like, solution)
    return eqx.tree_at(
        lambda s: (s.azimuth, s.position), zero, (solution.azimuth, solution.position)
    )


@pytest.fixture(scope="module")
def non_finite(solution):
    return eqx.tree_at(
        lambda s: (
            s.roller_load,
            s.contact_pressure,
            s.roller_pressure,
            s.displacement,
        ),
        solution,
        replace_fn=lambda x: jnp.full_like(x, jnp.nan),
    )


@pytest.fixture(scope="module")
def one_roller(solution):
    return jax.tree.map(lambda x: x[6:7] if x.ndim and x.shape[0] == 8 else x, solution)


@pytest.fixture(scope="module")
def taper():
    return bj.TaperedRollerBearing(
        17,
        0.052,
        0.0082,
        0.0115,
        roller_axis_angle=np.deg2rad(11),
        roller_half_angle=np.deg2rad(1.7235),
        ribs=bj.Ribs(inner_minus=bj.Rib(0.09, 1.2e-3)),
    )


def test_load_zone_bars_are_the_roller_loads_in_kilonewton(solution):
    ax = plot.load_zone(solution)
    heights = np.array([[bar.get_height() for bar in c] for c in ax.containers])
    np.testing.assert_allclose(heights.T, 1e-3 * solution.roller_load, rtol=1e-12)
    middle = [bar.get_x() + 0.5 * bar.get_width() for bar in ax.containers[0]]
    inner = [bar.get_x() + 0.5 * bar.get_width() for bar in ax.containers[1]]
    np.testing.assert_allclose(
        0.5 * np.add(middle, inner), solution.azimuth, atol=1e-12
    )
    hollow = data(ax.lines[0])[0]
    np.testing.assert_allclose(hollow, solution.azimuth[~solution.load_zone])
    assert "kN" in ax.get_title()
    words = legend(ax)
    assert words == ["outer raceway", "inner raceway", "outside the load zone"]


def test_load_zone_refuses_axes_that_are_not_polar(solution):
    with pytest.raises(ValueError, match="polar"):
        plot.load_zone(solution, plt.figure().add_subplot())


@pytest.mark.parametrize("raceway", ["inner", "outer"])
def test_pressure_profiles_show_the_most_loaded_rollers(solution, raceway):
    ring = ["outer", "inner"].index(raceway)
    ax = plot.pressure_profiles(solution, count=2, raceway=raceway)
    lines = [li for li in ax.lines if not str(li.get_label()).startswith("_")]
    assert len(lines) == 2
    worst = int(jnp.argmax(solution.roller_load[:, ring]))
    np.testing.assert_allclose(data(lines[0])[0], MM * solution.position)
    np.testing.assert_allclose(
        data(lines[0])[1], 1e-6 * solution.contact_pressure[worst, ring]
    )
    degrees = float(jnp.rad2deg(solution.azimuth[worst]))
    assert str(lines[0].get_label()).startswith(f"{degrees:.4g}°: ")
    assert "[mm]" in ax.get_xlabel() and "[MPa]" in ax.get_ylabel()


def test_pressure_profiles_of_both_raceways_and_few_rollers(one_roller):
    ax = plot.pressure_profiles(one_roller, raceway="both")
    assert len(legend(ax)) == 2


def test_pressure_profiles_mark_loaded_ends(solution):
    pressed = jnp.full_like(solution.edge_pressure, 1e9)
    edge = eqx.tree_at(lambda s: s.edge_pressure, solution, pressed)
    ax = plot.pressure_profiles(edge, count=1)
    marks = [line for line in ax.lines if line.get_marker() == "^"]
    np.testing.assert_allclose(data(marks[0])[0], MM * solution.position[::100])


def test_pressure_map_runs_once_around_and_leaves_zero_white(solution):
    ax = plot.pressure_map(solution)
    cells = np.ma.masked_array(ax.collections[0].get_array())
    pressure = 1e-6 * np.asarray(solution.contact_pressure[:, 1])
    # Azimuth 0 on: rollers in order, the seam drawn from both sides.
    around = np.take(pressure, range(-1, 9), axis=0, mode="wrap").T
    np.testing.assert_allclose(cells.data, around)
    np.testing.assert_array_equal(cells.mask, around <= 1e-3 * around.max())
    assert cells.mask.any() and not cells.mask.all()
    assert ax.get_xlim() == (0.0, 360.0)
    bar = ax.figure.axes[1]
    assert "[MPa]" in bar.get_ylabel() and "[mm]" in ax.get_ylabel()


@pytest.mark.parametrize(
    "call",
    [
        lambda s: plot.pressure_map(s, raceway="both"),
        lambda s: plot.pressure_profiles(s, raceway="left"),
        lambda s: plot.pressure_profiles(s, count=0),
    ],
)
def test_pressure_plots_refuse_unknown_choices(solution, call):
    with pytest.raises(ValueError, match="must be"):
        call(solution)


@pytest.mark.parametrize(
    "load_name, freedom, x_unit, y_unit, x_scale, y_scale",
    [("Fy", "uy", "kN", "µm", 1e-3, 1e6), ("Mx", "gx", "N m", "mrad", 1.0, 1e3)],
)
def test_load_displacement_scales_by_name(
    load_name, freedom, x_unit, y_unit, x_scale, y_scale
):
    load, shift = np.array([1e3, 2e3, 3e3]), np.array([1e-6, 2e-6, 3e-6])
    ax = plot.load_displacement(load, shift, load_name=load_name, freedom=freedom)
    np.testing.assert_allclose(data(ax.lines[0])[0], x_scale * load)
    np.testing.assert_allclose(data(ax.lines[0])[1], y_scale * shift)
    assert f"{load_name} [{x_unit}]" in ax.get_xlabel()
    assert f"{freedom} [{y_unit}]" in ax.get_ylabel()


def test_load_displacement_leaves_gaps_where_nothing_converged():
    ax = plot.load_displacement(
        [1.0, 2.0, 3.0], jnp.ones(3), converged=jnp.array([True, False, True])
    )
    np.testing.assert_array_equal(np.isnan(data(ax.lines[0])[1]), [False, True, False])


@pytest.mark.parametrize(
    "arguments",
    [{"load_name": "Q"}, {"freedom": "y"}, {"converged": [True]}],
)
def test_load_displacement_refuses_what_does_not_fit(arguments):
    with pytest.raises(ValueError):
        plot.load_displacement([1.0, 2.0], [1.0, 2.0], **arguments)


def test_profile_is_the_drop_in_micrometres(bearing):
    ax = plot.profile(bearing)
    assert [line.get_label() for line in ax.lines] == [
        "roller",
        "outer raceway",
        "inner raceway",
    ]
    position = jnp.asarray(data(ax.lines[0])[0]) / MM
    drop = bearing.roller_profile.drop(position, jnp.asarray(0.01), jnp.asarray(0.01))
    np.testing.assert_allclose(data(ax.lines[0])[1][1:-1], 1e6 * drop[1:-1])
    assert ax.get_ylim()[0] < 100.0  # the steep end is cut
    assert "[µm]" in ax.get_ylabel()


def test_section_of_a_cylinder_has_the_drawing_dimensions(bearing):
    parts = section(bearing)
    roller = parts.roller
    np.testing.assert_allclose(np.ptp(roller, axis=0), [10.0, 10.0], atol=1e-2)
    np.testing.assert_allclose(0.5 * (roller.max(0) + roller.min(0)), [0.0, 32.5])
    assert len(parts.rib_points) == 3
    outer, inner = parts.rings
    assert outer[:, 1].max() > 37.5 and inner[:, 1].min() < 27.5
    # Ribs stand up to their contact: inner one at -z only.
    left = inner[inner[:, 0] < 0, 1].max()
    assert left > 27.5 + 1.5
    assert inner[inner[:, 0] > 0, 1].max() == pytest.approx(27.5, abs=0.1)


def test_section_of_a_taper_is_inclined_with_the_large_end_at_minus_z(taper):
    parts = section(taper)
    outer, inner = parts.raceways
    slopes = [(r[1, 1] - r[0, 1]) / (r[1, 0] - r[0, 0]) for r in (outer, inner)]
    expected = -np.tan(np.deg2rad([11 + 1.7235, 11 - 1.7235]))
    np.testing.assert_allclose(slopes, expected)
    ends = np.linalg.norm(outer - inner, axis=1)
    np.testing.assert_allclose(
        ends, 8.2 + np.array([1, -1]) * 11.5 * np.sin(np.deg2rad(1.7235))
    )
    # The rib meets the sphere of the large end, 90 mm around its centre.
    along = (parts.axis[1] - parts.axis[0]) / np.linalg.norm(
        parts.axis[1] - parts.axis[0]
    )
    centre = parts.axis[0] + 90.0 * along
    np.testing.assert_allclose(np.linalg.norm(parts.rib_points - centre, axis=1), 90.0)


def test_cross_section_draws_to_scale_and_names_dimensions(bearing, taper):
    ax = plot.cross_section(bearing)
    assert ax.get_aspect() == 1.0
    words = " ".join(text.get_text() for text in ax.texts)
    for word in ("65 mm", "10 mm", "ring bodies schematic"):
        assert word in words
    assert "contact angle" not in words
    words = " ".join(text.get_text() for text in plot.cross_section(taper).texts)
    assert "contact angle $α$ = 12.72°" in words


def test_cross_section_survives_needles_without_ribs():
    needle = bj.NeedleRollerBearing(60, 0.060, 0.0025, 0.020)
    ax = plot.cross_section(needle)
    assert ax.get_legend() is None


def test_given_axes_are_used(bearing, solution):
    figure = plt.figure()
    flat = figure.add_subplot(1, 2, 1)
    round_ = figure.add_subplot(1, 2, 2, projection="polar")
    assert plot.load_zone(solution, round_) is round_
    for draw, subject in (
        (plot.pressure_profiles, solution),
        (plot.pressure_map, solution),
        (plot.cross_section, bearing),
        (plot.profile, bearing),
    ):
        assert draw(subject, ax=flat) is flat
        flat.clear()
    assert plot.load_displacement([1.0], [1.0], ax=flat) is flat
    assert len(plt.get_fignums()) == 1


def test_overview_shows_four_plots_and_the_results(bearing, solution):
    figure = plot.overview(bearing, solution, title="NJ")
    titles = [ax.get_title() for ax in figure.axes]
    assert sum(bool(title) for title in titles) == 4
    assert figure.get_suptitle() == "NJ"
    words = " ".join(text.get_text() for ax in figure.axes for text in ax.texts)
    peak = f"{1e-6 * float(solution.roller_pressure.max()):.4g} MPa"
    assert peak in words and "converged" in words


@pytest.mark.parametrize("which", ["unloaded", "one_roller", "non_finite"])
def test_overview_survives(which, bearing, request):
    figure = plot.overview(bearing, request.getfixturevalue(which))
    assert figure.get_suptitle() == "CylindricalRollerBearing"


def test_import_leaves_matplotlib_alone_and_its_absence_is_explained():
    program = (
        "import sys, bearingjax.plot as p\n"
        "assert 'matplotlib' not in sys.modules\n"
        "sys.modules['matplotlib'] = None\n"
        "try: p.load_displacement([1.0], [1.0])\n"
        "except ImportError as error: print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert 'pip install "bearingjax[plot]"' in done.stdout


def test_pages_of_balls_and_sets():
    """A page for each kind; what is drawn of the ellipses is to scale."""
    from registry import ball_elements

    for name in (
        "four-point, unlike balls, load share",
        "ball pair, O",
        "taper pair, X",
    ):
        element, _ = ball_elements()[name]
        solution = bj.solve_load(element, [100.0, 0, 800.0, 0, 0, 0])
        page = bj.plot.overview(element.bearing, solution, name)
        titles = [ax.get_title() for ax in page.axes]
        assert titles[0] == "Axial section, to scale"
        if len(solution.row_sizes) > 1:
            # The page shows the row with the largest load.
            tops = np.asarray(solution.roller_load).reshape(2, -1).max(axis=1)
            assert titles[3].endswith(f", row {tops.argmax()}")
        if isinstance(solution, bj.BallSolution):
            ellipse = page.axes[3].patches[0]
            assert isinstance(ellipse, Ellipse)
            ax = page.axes[3]
            box, size = ax.get_position(), page.get_size_inches()
            wide = np.ptp(ax.get_xlim()) / (box.width * size[0])
            high = np.ptp(ax.get_ylim()) / (box.height * size[1])
            drawn = (ellipse.width / wide) / (ellipse.height / high)
            axes = np.asarray(solution.semi_axes).reshape(-1, 2)
            axes = axes[axes[:, 1] > 0]
            # The page is laid out once more when it is drawn: a few per cent.
            assert np.isclose(drawn, axes[:, 0] / axes[:, 1], rtol=0.05).any()


def test_stiffness_over_speed():
    ax = bj.plot.stiffness_over_speed(
        [0.0, 100.0], np.tile(np.eye(12) * 1e6, (2, 1, 1))
    )
    assert len(ax.lines) == 3 and np.allclose(ax.lines[2].get_ydata(), 1.0)
    assert np.allclose(ax.lines[0].get_xdata(), [0.0, 100.0 * 30 / np.pi])
    with pytest.raises(ValueError, match="one matrix for each speed"):
        bj.plot.stiffness_over_speed([0.0], np.eye(12))

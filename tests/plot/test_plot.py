"""Every plot draws what the solution says, with units, on its own or given axes."""

import sys
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import made
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Ellipse
from registry import balls, taper

import bearingjax as bj
from bearingjax import plot
from bearingjax.plot.drawings.section import section
from bearingjax.plot.panel import Axis, Bars, Curve, Panel, curves
from bearingjax.plot.style import ROLLER

MM = 1e3


def data(line):
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


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
    return made.solution(bearing)


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


@pytest.mark.parametrize(("count", "told"), [(9, True), (17, False)])
def test_load_zone_labels_fit_or_move_to_title(count, told):
    """Of balls that are all loaded; of both rows of a pair at one azimuth."""
    pair = bj.BearingSet.back_to_back(balls(count, contact_angle=0.4), spacing=0.02)
    made_up = made.solution(pair, (0.25, 0.25))
    even = eqx.tree_at(
        lambda s: s.roller_load, made_up, jnp.full_like(made_up.roller_load, 130.0)
    )
    ax = plot.load_zone(even)
    assert ("; circles every 40 N" in ax.get_title()) is not told
    assert bool(ax.texts) is told
    plt.gcf().draw_without_rendering()
    for text in ax.texts:
        box = text.get_window_extent()
        bars = [bar for bars in ax.containers for bar in bars]
        for bar in bars:
            corners = bar.get_path().interpolated(20).vertices
            edge = bar.get_transform().transform(corners)
            assert not any(box.contains(*point) for point in edge)


def test_load_zone_rejects_non_polar_axes(solution):
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


def test_a_short_contact_leaves_room_for_the_legend(solution):
    position = jnp.abs(solution.position)
    short = jnp.where(position < 0.4 * position.max(), 1e9, 0.0)
    pressure = jnp.broadcast_to(short, solution.contact_pressure.shape)
    least = eqx.tree_at(lambda s: s.contact_pressure, solution, pressure)
    assert plot.pressure_profiles(least).get_ylim()[1] > 1.5e3
    long = eqx.tree_at(lambda s: s.contact_pressure, solution, 0.0 * pressure + 1e9)
    assert plot.pressure_profiles(long).get_ylim()[1] < 1.2e3


def test_pressure_profiles_mark_loaded_ends(solution):
    pressed = jnp.full_like(solution.edge_pressure, 1e9)
    edge = eqx.tree_at(lambda s: s.edge_pressure, solution, pressed)
    ax = plot.pressure_profiles(edge, count=1)
    marks = [line for line in ax.lines if line.get_marker() == "^"]
    np.testing.assert_allclose(data(marks[0])[0], MM * solution.position[::20])
    # A roller that lies on one raceway passes no load and lies there as it likes.
    load = edge.roller_load.at[:, 1].set(0.0)
    thrown = plot.pressure_profiles(eqx.tree_at(lambda s: s.roller_load, edge, load))
    marks = [line for line in thrown.lines if line.get_marker() == "^"]
    assert all(data(mark)[0].size == 0 for mark in marks)


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


def test_load_displacement_leaves_gaps_at_unconverged_points():
    ax = plot.load_displacement(
        [1.0, 2.0, 3.0], jnp.ones(3), converged=jnp.array([True, False, True])
    )
    np.testing.assert_array_equal(np.isnan(data(ax.lines[0])[1]), [False, True, False])


@pytest.mark.parametrize(
    "arguments",
    [{"load_name": "Q"}, {"freedom": "y"}, {"converged": [True]}],
)
def test_load_displacement_rejects_invalid_arguments(arguments):
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


def test_section_of_a_taper_is_inclined_with_the_large_end_at_minus_z():
    parts = section(taper())
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


SPHERICAL = bj.SphericalRollerRow(
    18,
    0.1376,
    0.0215,
    0.0185,
    contact_angle=0.1658,
    roller_profile_radius=0.0781,
    inner_raceway_radius=0.0805,
    radial_internal_clearance=40e-6,
)


def arc_through(points):
    """Centre and radius of the circle through both ends and the middle."""
    first, middle, last = points[0], points[len(points) // 2], points[-1]
    sides = 2.0 * np.stack([middle - first, last - first])
    squares = [end @ end - first @ first for end in (middle, last)]
    centre = np.linalg.solve(sides, squares)
    return centre, np.linalg.norm(middle - centre)


def test_section_of_spherical_row_profile_arcs():
    """The outer raceway is about the origin; gaps along the normal, 10 µm cos α."""
    parts = section(SPHERICAL)
    outer, inner = parts.raceways
    normal = np.array([np.sin(0.1658), np.cos(0.1658)])
    r = 0.5 * (137.6 + 21.5 * np.cos(0.1658)) / np.cos(0.1658)
    gap = 10e-3 * np.cos(0.1658)
    np.testing.assert_allclose(np.linalg.norm(outer, axis=1), r + gap, rtol=1e-12)
    centre, radius = arc_through(inner)
    np.testing.assert_allclose(radius, 80.5, rtol=1e-9)
    wanted = parts.centre + (80.5 - 10.75 - gap) * normal
    np.testing.assert_allclose(centre, wanted, rtol=1e-9)
    np.testing.assert_allclose(parts.centre, r * normal - 10.75 * normal, rtol=1e-12)
    # The generator of the roller, away from its ends.
    away = np.linalg.norm(parts.roller - (parts.centre - 67.35 * normal), axis=1)
    assert np.sum(np.abs(away - 78.1) < 1e-6) > 300
    # Rings of both rows meet in the middle of the bearing.
    assert all(ring[:, 0].min() == pytest.approx(0.0, abs=1e-9) for ring in parts.rings)


def test_section_of_washers_and_crossed_rollers():
    parts = section(bj.CylindricalThrustRollerBearing(21, 0.0775, 0.009, 0.008))
    outer, inner = parts.rings
    np.testing.assert_allclose(np.ptp(parts.roller, axis=0), [9.0, 8.0], atol=1e-9)
    faces = [outer[:, 0].min(), inner[:, 0].max()]
    np.testing.assert_allclose(faces, [4.5, -4.5], rtol=1e-12)
    assert inner[:, 1].min() < 34.75 and inner[:, 1].max() > 42.75
    # Of crossed rollers the ends stay clear of the groove.
    parts = section(bj.CrossedRollerRow(40, 0.2775, 0.014, 0.010))
    z, r = (parts.roller - parts.centre).T
    np.testing.assert_allclose(
        [(z + r).max(), (z - r).max()], np.sqrt(2.0) * np.array([7, 5])
    )
    apex = parts.rings[0][0] - parts.centre
    np.testing.assert_allclose(apex, [0.0, 7.0 * np.sqrt(2.0)], atol=1e-9)


def test_a_crossed_set_has_one_solid_roller_and_one_behind():
    bearing = bj.BearingSet.crossed(bj.CrossedRollerRow(40, 0.2775, 0.014, 0.010))
    ax = plot.cross_section(bearing)
    assert len(ax.patches) == 3  # both rings and a roller
    (behind,) = [line for line in ax.lines if line.get_color() == ROLLER]
    assert behind.get_linestyle() == "--"
    words = " ".join(text.get_text() for text in ax.texts)
    assert "contact angle α = 45°" in words
    thrust = bj.CylindricalThrustRollerBearing(21, 0.0775, 0.009, 0.009)
    assert "contact angle 90°" in plot.cross_section(thrust).get_xlabel()


def test_profiles_of_barrels_are_counted_from_the_roller():
    """Sagitta of the roller's arc less that of the raceway."""
    lines = plot.profile(SPHERICAL).lines
    x = data(lines[2])[0]
    back = [r - np.sqrt(r**2 - x**2) for r in (78.1, 80.5)]
    np.testing.assert_allclose(data(lines[0])[1], 0.0, atol=1e-9)
    np.testing.assert_allclose(data(lines[2])[1], 1e3 * (back[0] - back[1]), atol=1e-6)


def test_cross_section_draws_to_scale_and_names_dimensions(bearing):
    ax = plot.cross_section(bearing)
    assert ax.get_aspect() == 1.0
    words = " ".join([ax.get_title(), *(text.get_text() for text in ax.texts)])
    for word in ("65 mm", "10 mm", "ring bodies schematic"):
        assert word in words
    assert "contact angle" not in words
    pair = bj.BearingSet.face_to_face(taper(5), 0.03)
    for design in (taper(5), pair):
        words = " ".join(text.get_text() for text in plot.cross_section(design).texts)
        assert "contact angle α = 12.72°" in words


def test_sections_of_balls_name_dimensions():
    for design in (balls(5), bj.BearingSet.back_to_back(balls(5), 0.02)):
        ax = plot.cross_section(design)
        words = [text.get_text() for text in ax.texts]
        for word in (
            "$D_\\mathrm{w}$ = 9.5 mm",
            "pitch Ø 52 mm",
            "free contact angle α = 25°",
        ):
            assert words.count(word) == 1


def test_cross_section_of_set_draws_all_rollers():
    pair = bj.BearingSet.face_to_face(taper(5), 0.03)
    ax = plot.cross_section(pair)
    drawn: Any = ax.patches
    middles = [patch.get_xy()[:, 0].mean() for patch in drawn]
    assert len(middles) == 6 and min(middles) < -10.0 and max(middles) > 10.0


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


def test_overview_shows_five_plots_and_the_results(bearing, solution):
    figure = plot.overview(bearing, solution, title="NJ")
    assert sum(bool(title) for title in titles(figure)) == 5
    assert figure.get_suptitle() == "NJ"
    words = " ".join(text.get_text() for part in figure.subfigs for text in part.texts)
    peak = f"{1e-6 * float(solution.roller_pressure.max()):.4g} MPa"
    assert peak in words and "converged" in words


@pytest.mark.parametrize("which", ["unloaded", "one_roller", "non_finite"])
def test_overview_of_unloaded_and_failed_solutions(which, bearing, request):
    figure = plot.overview(bearing, request.getfixturevalue(which))
    assert figure.get_suptitle() == "CylindricalRollerBearing"


def test_plot_without_matplotlib_installed(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match=r'pip install "bearingjax\[plot\]"'):
        plot.load_displacement([1.0], [1.0])


def titles(figure):
    return [ax.get_title() for ax in figure.axes]


def test_a_page_has_both_raceways_of_each_row(bearing, solution):
    single = titles(plot.overview(bearing, solution))
    for name in ("outer", "inner"):
        assert f"Contact pressure, {name} raceway" in single
    pair = bj.BearingSet.back_to_back(taper(5), 0.03)
    page = plot.overview(pair, made.solution(pair))
    for row in range(2):
        for name in ("outer", "inner"):
            title = f"Contact pressure, {name} raceway, row {row}"
            assert titles(page).count(title) == 1
    maps = [ax for ax in page.axes if "pressure, " in ax.get_title()]
    # One scale of colours, so that raceways are compared by colour.
    assert len({ax.collections[0].get_clim() for ax in maps}) == 1


ANGLES = {
    "pair": (0.45, 0.44),
    "four-point": (0.4, -0.3, 0.42, -0.32),
    "thrust": (0.5 * np.pi, 0.5 * np.pi),
}


@pytest.fixture(scope="module")
def of_balls():
    """Name to bearing and solution."""
    found = {
        "pair": bj.BearingSet.back_to_back(balls(7), 0.02),
        "four-point": balls(6, bj.FourPointBallBearing, shim_angle=0.35),
        "thrust": balls(7, bj.ThrustBallBearing),
    }
    return {
        name: (bearing, made.solution(bearing, ANGLES[name]))
        for name, bearing in found.items()
    }


def scale_of(ax):
    """Inch over inch of what an ellipse shows: (across the axis, up) per data."""
    box = 0.62  # height over width
    return np.ptp(ax.get_xlim()) * box / np.ptp(ax.get_ylim())


@pytest.mark.parametrize("name", ANGLES)
def test_ellipses_have_their_true_shape(of_balls, name):
    bearing, found = of_balls[name]
    ax = plot.ellipses(bearing, found, raceway="outer")
    drawn = [patch for patch in ax.patches if isinstance(patch, Ellipse)]
    # The least loaded one first, at 180 degrees or beyond.
    shapes = {round(p.width / p.height / scale_of(ax), 9) for p in drawn}
    assert shapes == {0.1}  # as made
    assert max(p.height for p in drawn) == pytest.approx(2.0, rel=0.05)
    # The stated scale: mm of the drawing for a mm on the raceway.
    turn = np.pi * (52.0 + 9.5 * (name != "thrust"))
    told = scale_of(ax) * turn / 360.0
    assert f"{told:.2g} times" in ax.get_xlabel() and "true shape" in ax.get_xlabel()


def test_ellipses_are_narrowed_where_overlapping(of_balls):
    bearing, found = of_balls["thrust"]
    round_ = eqx.tree_at(
        lambda s: s.semi_axes, found, found.semi_axes.at[..., 0].set(1.5e-3)
    )
    ax = plot.ellipses(bearing, round_)
    wide = [p.width for p in ax.patches if isinstance(p, Ellipse)]
    assert max(wide) < 360.0 / 7 and "narrower" in ax.get_xlabel()


def test_ellipses_refuse_rollers(bearing, of_balls):
    with pytest.raises(TypeError, match="must be of balls"):
        plot.ellipses(bearing, of_balls["thrust"][1])


def test_contact_angles_hide_no_raceway_and_no_round_off(of_balls):
    ax = plot.contact_angles(of_balls["thrust"][1])
    markers: Any = ax.collections
    outer, inner = markers
    assert not len(outer.get_facecolor()) and len(inner.get_facecolor())
    assert (outer.get_sizes() > inner.get_sizes()).all()
    low, high = ax.get_ylim()
    assert high - low == pytest.approx(2.0) and low + high == pytest.approx(180.0)
    ax.figure.canvas.draw()
    assert ax.yaxis.get_offset_text().get_text() == ""


def test_a_page_of_balls_shows_all_rows(of_balls):
    page = plot.overview(*of_balls["pair"])
    for row in range(2):
        for name in ("outer", "inner"):
            title = f"Contact ellipses, {name} raceway, row {row}"
            assert titles(page).count(title) == 1
    assert titles(page)[0].startswith("Axial section, to scale")


def test_bars_of_staggered_rows_stand_apart():
    row = balls(7, bj.SelfAligningBallRow, outer_osculation=None, row_offset=0.006)
    bearing = bj.BearingSet.self_aligning(row)
    ax = plot.load_zone(made.solution(bearing, (0.25, 0.25)))
    spans = sorted(
        (bar.get_x() % (2 * np.pi), bar.get_width())
        for bars in ax.containers
        for bar in bars
    )
    begin, width = np.array(spans).T
    assert (np.diff(begin) > 0.999 * width[:-1]).all()


def test_stiffness_over_speed():
    ax = bj.plot.stiffness_over_speed(
        [0.0, 100.0], np.tile(np.eye(12) * 1e6, (2, 1, 1))
    )
    assert len(ax.lines) == 3 and np.allclose(ax.lines[2].get_ydata(), 1.0)
    assert np.allclose(ax.lines[0].get_xdata(), [0.0, 100.0 * 30 / np.pi])
    with pytest.raises(ValueError, match="one matrix for each speed"):
        bj.plot.stiffness_over_speed([0.0], np.eye(12))


def test_chart_axes_have_units_of_fields(solution):
    """The numbers of a panel are in SI; its axes know the units of the result."""
    load = Axis.from_field(solution, "roller_load")
    assert (load.label, load.scale) == ("roller load [kN]", 1e-3)
    assert Axis.from_field(solution, "azimuth", (1.0, "rad")).label == "azimuth [rad]"
    assert Axis("count").label == "count"
    shown: Any = plot.load_displacement
    panel = shown.panel([1e3, 2e3], [1e-6, 2e-6])
    assert (panel.over.unit, panel.of.unit) == ("N", "m")
    assert np.array_equal(panel.marks[0].y, [1e-6, 2e-6])


def test_a_panel_draws_curves_bars_bands_and_a_second_axis():
    x = np.arange(3.0)
    beside = Panel("", Axis("x"), Axis("z", "Pa"), [Curve(x, 1e6 * x, "z", "red")])
    marks = [
        Curve(x, x, look={"alpha": 0.5}, to=2.0 * x),
        *curves(x, [[1, 2]] * 3, "a"),
    ]
    time, force = Axis("time", "s"), Axis("force", "N")
    ax = Panel("title", time, force, marks, (0, 2), room=0.5, twin=beside).draw()
    other = ax.figure.axes[1]
    assert [line.get_label() for line in ax.lines] == ["a", "_curve 1"]
    assert np.allclose(ax.lines[1].get_ydata(), 2e-3) and len(ax.collections) == 1
    assert other.get_ylabel() == "z [MPa]" and other.yaxis.label.get_color() == "red"
    assert np.allclose(other.lines[0].get_ydata(), x)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["a", "z"]
    assert ax.get_ylim()[1] > 4e-3 * 1.4 and ax.get_xlim() == (0.0, 2.0)
    bars = [Bars([1e3, 3e3], "b", labels="%.0f")]
    ax = Panel("", time, force, bars, names="pq", legend=None).draw()
    drawn: Any = ax.patches
    assert [bar.get_height() for bar in drawn] == [1.0, 3.0]
    assert [text.get_text() for text in ax.texts] == ["1", "3"]
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["p", "q"]
    assert ax.get_legend() is None

"""A drawing has a label for every field of its design, once, where it is measured."""

import dataclasses
import functools
import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.text import Annotation, Text
from registry import balls, taper
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax import plot
from bearingjax.plot.drawings.dimension import magnification, quantity, spread_labels
from bearingjax.plot.drawings.drawing import IN_WORDS
from bearingjax.plot.drawings.face_drawing import DEVIATIONS
from bearingjax.plot.drawings.set_drawing import arrangement_view

RIB = bj.Rib(0.3, 1.5e-3, 15e-6)
SAME_FOR_ALL = dict(azimuth_deviation=[1e-3, 0, 0, 0, -1e-3])


def cylinder(**change):
    return bj.CylindricalRollerBearing(5, 0.065, 0.010, 0.010, **change)


def arcs(roller, inner):
    return dict(roller_profile_radius=roller, inner_raceway_radius=inner)


DESIGNS = {
    "deep groove": balls(
        5, bj.DeepGrooveBallBearing, radial_internal_clearance=10e-6, **SAME_FOR_ALL
    ),
    "deep groove, neither clearance nor angle": balls(5, bj.DeepGrooveBallBearing),
    "angular contact": balls(
        5,
        outer_shoulder=0.003,
        inner_shoulder=0.002,
        ball_deviation=np.arange(5) * 1e-7,
        material=bj.Material.silicon_nitride(),
        ring_material=bj.Material.steel(),
    ),
    "four-point": balls(
        5, bj.FourPointBallBearing, shim_angle=0.35, radial_internal_clearance=-3e-6
    ),
    "thrust": balls(
        5,
        bj.ThrustBallBearing,
        inner_shoulder=0.002,
        raceway_deviation=1e-6 * np.ones((5, 2, 3)),
    ),
    "double row": balls(
        5, bj.design.DoubleRowBallRow, contact_angle=0.5, row_offset=0.005
    ),
    "self-aligning row": balls(
        5, bj.SelfAligningBallRow, outer_osculation=None, row_offset=0.006
    ),
    "cylindrical, unlike ribs": cylinder(
        radial_internal_clearance=25e-6,
        roller_profile=bj.CrownedEnds(0.006, 1.0, 0.8e-3, 0.05),
        outer_raceway_profile=bj.CircularCrown(3.0),
        inner_raceway_profile=bj.FujiwaraKawase(10e3, 2.0, 0.6, 15e-6),
        roller_deviation=np.arange(5) * 1e-7,
        ribs=bj.Ribs(RIB, RIB, inner_minus=bj.Rib(0.2, 1e-3)),
    ),
    "cylindrical, other profiles": cylinder(
        roller_profile=bj.JohnsGohar(5e3, 60e-6),
        outer_raceway_profile=bj.Lundberg(5e3),
        inner_raceway_profile=bj.Tabulated([-5e-3, 0.0, 5e-3], [2e-6, 0.0, 2e-6]),
    ),
    "needle": bj.NeedleRollerBearing(5, 0.03, 0.003, 0.012),
    "taper": taper(5),
    "spherical": bj.SphericalRollerRow(
        5, 0.1376, 0.0215, 0.0185, contact_angle=0.1658, **arcs(0.0781, 0.0805)
    ),
    "toroidal": bj.ToroidalRollerBearing(
        5, 0.14, 0.0195, 0.03, outer_raceway_radius=0.42, **arcs(0.4074, 0.42)
    ),
    "cylindrical thrust": bj.CylindricalThrustRollerBearing(5, 0.0775, 0.009, 0.009),
    "tapered thrust": bj.TaperedThrustRollerBearing(
        5,
        0.12,
        0.01,
        0.014,
        roller_axis_angle=1.488,
        roller_half_angle=0.08276,
        ribs=bj.Ribs(inner_minus=RIB),
    ),
    "spherical thrust": bj.SphericalThrustRollerBearing(
        5,
        0.1204,
        0.022,
        0.026,
        contact_angle=0.87,
        profile_offset=2e-3,
        ribs=bj.Ribs(inner_minus=RIB),
        **arcs(0.1018, 0.105),
    ),
    "crossed": bj.CrossedRollerRow(6, 0.06, 0.014, 0.010),
}


THREE = bj.BearingSet(
    [
        bj.SetRow(balls(5), -0.02, inner_offset=4e-6),
        bj.SetRow(balls(7, contact_angle=0.3), 0.0),
        bj.SetRow(
            balls(5, first_azimuth=0.2), 0.02, True, spring=bj.PreloadSpring(400.0, 1e6)
        ),
    ]
)


PAIR = bj.BearingSet(
    [
        bj.SetRow(balls(5), -0.009, inner_offset=-23.269e-6),
        bj.SetRow(balls(5), 0.009, True, inner_offset=-13.269e-6),
    ]
)


@functools.cache
def page(name):
    return plot.drawing(DESIGNS[name])


def texts(figure):
    """All that is written on a page, part by part of it."""
    for ax in figure.axes:
        yield ax, [ax.get_title(), *(text.get_text() for text in ax.texts)]


def count(lines, name):
    """How many lines begin with the name and then have its value or say it has none."""
    pattern = re.compile(rf"^{re.escape(name)}(?= = |: )", re.MULTILINE)
    return sum(len(pattern.findall(line)) for line in lines)


@pytest.mark.parametrize("name", DESIGNS)
def test_every_field_of_a_bearing_is_drawn_once(name):
    bearing = DESIGNS[name]
    drawn = [line for _, lines in texts(page(name)) for line in lines]
    words = ", ".join(t.get_text() for t in page(name).texts)
    words = re.split(r",\s+|\n", words)
    for field in dataclasses.fields(bearing):
        missing = field.name in DEVIATIONS and getattr(bearing, field.name) is None
        if field.name in IN_WORDS or missing:
            pattern = rf"{field.name}(: | = )"
            assert sum(bool(re.match(pattern, word)) for word in words) == 1
        elif field.name not in ("ribs", "published", "filled"):  # not of a drawing
            assert count(drawn, field.name) == 1, field.name
    materials = [m for m in (bearing.material, bearing.ring_material) if m is not None]
    for field in dataclasses.fields(bj.Material):
        assert sum(f"{field.name} = " in word for word in words) == len(materials)
    if isinstance(bearing, bj.design.AbstractRollerBearing):
        _ribs_and_profiles(page(name), bearing, drawn)


def _ribs_and_profiles(figure, bearing, drawn):
    assert count(drawn, "ribs") == (not bearing.ribs.present)
    for rib in bearing.ribs.present:
        (lines,) = [ls for ax, ls in texts(figure) if f"ribs.{rib}" in ax.get_title()]
        for field in dataclasses.fields(bj.Rib):
            assert count(lines, field.name) == 1, field.name
    for name in ("roller_profile", "outer_raceway_profile", "inner_raceway_profile"):
        profile = getattr(bearing, name)
        for field in dataclasses.fields(profile):
            title = f"{name}: {type(profile).__name__}"
            (lines,) = [ls for ax, ls in texts(figure) if ax.get_title() == title]
            assert count(lines, field.name) == 1, field.name


def test_every_kind_of_bearing_and_profile_is_tried():
    def leaves(kind):
        below = kind.__subclasses__()
        own = {kind} if kind.__module__.startswith("bearingjax.design") else set()
        return set().union(*map(leaves, below)) if below else own

    tried = {type(bearing) for bearing in DESIGNS.values()}
    for kind in (bj.design.AbstractBallBearing, bj.design.AbstractRollerBearing):
        assert leaves(kind) <= tried
    parts = [
        getattr(bearing, name)
        for bearing in DESIGNS.values()
        for name in ("roller_profile", "outer_raceway_profile", "inner_raceway_profile")
        if hasattr(bearing, name)
    ]
    of_a_table = {kind for kind in leaves(bj.design.AbstractProfile)}
    profiles = {kind for kind in of_a_table if not kind.__name__.startswith("_")}
    assert profiles <= {type(part) for part in parts} | {bj.Logarithmic}


def test_drawing_of_set_lists_rows_and_distinct_bearings():
    rows = THREE.rows
    figure = plot.drawing(THREE, "three")
    assert figure.get_suptitle() == "three"
    drawn = [line for _, lines in texts(figure) for line in lines]
    for k, row in enumerate(rows):
        for field in dataclasses.fields(row):
            assert count(drawn, f"rows.{k}.{field.name}") == 1, field.name
    lines = "\n".join(drawn).splitlines()
    (told,) = [line for line in lines if line.startswith("rows.2.spring")]
    for field in dataclasses.fields(bj.PreloadSpring):
        assert told.count(f"{field.name} = ") == 1
    heads = [t.get_text() for t in figure.texts if t.get_text().startswith("rows.")]
    kind = "AngularContactBallBearing"
    assert heads == [
        f"rows.0.bearing, rows.2.bearing: {kind}",
        f"rows.1.bearing: {kind}",
    ]
    # Rows that differ only in azimuth are drawn once, with the azimuth of each.
    assert count(drawn, "rows.2.bearing.first_azimuth") == 1
    assert count(drawn, "contact_angle") == 2


@pytest.mark.parametrize(
    "make, word",
    [
        (bj.BearingSet.back_to_back, "Back-to-back (O), spacing 30 mm"),
        (bj.BearingSet.face_to_face, "Face-to-face (X), spacing 30 mm"),
        (bj.BearingSet.tandem, "Tandem, spacing 30 mm"),
    ],
)
def test_the_arrangement_is_named(make, word):
    ax = plt.figure().add_subplot()
    arrangement_view(ax, make(taper(5), 0.03), [], (14.0, 5.0))
    assert ax.get_title().startswith(word)


@pytest.mark.parametrize("name", ["deep groove", "thrust", "needle", "taper"])
def test_sections_are_to_scale(name):
    """What is drawn along and across has the same scale, and the size of the design."""
    section, face = page(name).axes[:2]
    for ax in (section, face):
        wide, high = np.ptp(ax.get_xlim()), np.ptp(ax.get_ylim())
        assert high / wide == pytest.approx(ax.get_box_aspect(), rel=ROUNDING)
    bearing = DESIGNS[name]
    arrows = [t for t in face.texts if isinstance(t, Annotation) and not t.get_text()]
    ends = np.array([[arrow.xy, arrow.xyann] for arrow in arrows])
    across = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    assert np.isclose(across, 1e3 * float(bearing.pitch_diameter)).any()


@pytest.mark.parametrize("name", [*DESIGNS, "set", "pair"])
def test_words_stand_on_the_page_and_not_on_each_other(name):
    """Those of all views: a label that is cut or covered cannot be read."""
    sets = {"set": THREE, "pair": PAIR}
    figure = plot.drawing(sets[name]) if name in sets else page(name)
    words = list(figure.texts)
    for ax in figure.axes:
        words += [ax.title, *ax.texts]
    boxes = []
    for word in (word for word in words if word.get_text()):
        word.get_window_extent()  # finds the place of an annotation
        # Of the words alone, without the line to what they name.
        box = Text.get_window_extent(word)
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1, word
        assert figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1, word
        for one, other in boxes:
            assert not box.overlaps(one), (word, other)
        boxes.append((box, word))


def test_quantities_are_told_as_on_drawings():
    assert quantity(0.046, "m") == "46 mm"
    assert quantity(25e-6, "m") == "25 µm" and quantity(-3e-6, "m") == "-3 µm"
    assert quantity(0.0, "m") == "0 mm"
    assert quantity(np.pi / 7.2, "rad") == "25°"
    assert quantity(0.52, "") == "0.52"
    assert quantity(206e9, "Pa") == "206 GPa"


def test_magnification_is_a_round_number():
    assert magnification(2.5e-3, 0.7) == 200.0
    assert magnification(-1e-3, 0.7) == 500.0
    assert magnification(1.0, 0.5) == 1.0 and magnification(0.0, 1.0) == 1.0


def test_labels_spread_to_where_there_is_room():
    at = spread_labels([0.5, 0.5, 0.5], [0.1, 0.2, 0.1])
    np.testing.assert_allclose(at, [0.35, 0.5, 0.65], rtol=ROUNDING)
    at = spread_labels([0.0, 0.9, 1.0], [0.2, 0.2, 0.2])
    np.testing.assert_allclose(at, [0.1, 0.7, 0.9], rtol=ROUNDING)
    assert np.diff(spread_labels([0.1] * 9, [0.2] * 9)).min() > 0.1  # reduced


@pytest.mark.parametrize("name, letter", [("6208", "B"), ("22220", "B"), ("7208B", "")])
def test_boundary_dimensions_of_the_catalogue_are_drawn(name, letter):
    """Lines at d, D and, where the catalogue places them, at the side faces."""
    entry = bj.catalogue_entry(name)
    d, big, wide = 1e3 * np.array([entry.bore, entry.outside_diameter, entry.width])
    for ax in (
        plot.cross_section(bj.load_bearing(entry.designation), catalogue=entry),
        plot.drawing(bj.load_bearing(entry.designation), catalogue=entry).axes[0],
    ):
        drawn = [line for line in ax.lines if line.get_label() == "_boundary"]
        lines = [np.transpose(np.asarray(line.get_data(), float)) for line in drawn]
        low, high = (line[:, 1] for line in lines[:2])
        np.testing.assert_allclose(high - low, 0.5 * (big - d))
        assert len(lines) == (4 if letter else 2)
        if letter:
            np.testing.assert_allclose(lines[0][:, 0], [-0.5 * wide, 0.5 * wide])
        words = " ".join(text.get_text() for text in ax.texts)
        assert f"D = {big:g} mm" in words
        assert f"d = {d:g} mm, B = {wide:g} mm" in words
        top = ax.get_ylim()[1]
        assert all(line[:, 1].max() < top for line in lines)
    smaller = bj.catalogue_entry("6205")  # into which its elements do not fit
    for other in (None, smaller):
        bare = plot.cross_section(bj.load_bearing(entry.designation), catalogue=other)
        assert not any(line.get_label() == "_boundary" for line in bare.lines)

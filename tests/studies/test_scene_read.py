"""Scene files say what they say: every value in its place, in SI."""

import dataclasses
import json
import tomllib
from typing import Any

import equinox as eqx
import jax
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.design import rows_of
from bearingjax.files import shipped_scenes
from bearingjax.studies.bearing.read_operating import relative_speed
from bearingjax.studies.shaft.read import read_shafts
from bearingjax.studies.solve.report import design_sections

DEG = np.pi / 180.0
RPM = 2.0 * np.pi / 60.0

SHIPPED = (
    "angular_contact",
    "ball_pair",
    "crossed_roller",
    "cylindrical_ribs",
    "cylindrical_rig",
    "deep_groove",
    "four_point",
    "fujiwara_kawase",
    "hybrid_spindle",
    "life_spectrum",
    "load_map",
    "needle",
    "nj_axial",
    "self_aligning",
    "skid_axial",
    "skid_combined",
    "skid_roller",
    "spherical_roller",
    "sprung_pair",
    "tapered",
    "thrust_ball",
    "thrust_roller",
)
CONTACT = "taper_contact"  # of one roller, for `read_contact`
ROTORS = {  # for `read_rotor`
    "rotor_flexible",
    "rotor_paper_12",
    "rotor_paper_26",
    "rotor_paper_36",
    "rotor_spindle",
}

SHAFTS = {  # for `read_shafts`
    "shaft_fan",
    "shaft_gearbox",
    "shaft_spindle",
    "shaft_wind_turbine",
}

SELECT = "select_gearbox"  # without a bearing, for `read_select`
DECIDED = "identify_clearance", "tolerances_seats"  # in the tests of their commands

NOISE = {  # for `read_noise`, in the tests of the command
    "noise_cylindrical",
    "noise_deep_groove",
    "noise_four_point",
    "noise_pair",
}


def near(value):
    return pytest.approx(value, rel=ROUNDING, abs=0.0)


def fields(module):
    """Names of the numbers of a module and their values."""
    return {k: float(v) for k, v in vars(module).items() if v is not None}


def steel():
    return near({"elastic_modulus": 206e9, "poisson_ratio": 0.3, "density": 7850.0})


def read_text(folder, text, settings=()):
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return bj.read_scene(path, settings)


def test_shipped_scenes_list_is_complete():
    assert set(shipped_scenes()) == {
        *(*SHIPPED, CONTACT, SELECT, *DECIDED),
        *(*ROTORS, *SHAFTS, *NOISE),
    }


@pytest.mark.parametrize("name", sorted(SHAFTS))
@pytest.mark.slow
def test_shipped_shafts_read(name):
    task = read_shafts(name)
    assert task.name == name and task.warnings == ()
    assert (task.heat is not None) == (name == "shaft_spindle")
    assert all(scene is not None for scene in task.bearings)


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_scene_reads(name):
    scene = bj.read_scene(name)
    raw = tomllib.loads(shipped_scenes()[name].read_text(encoding="utf-8"))
    assert scene.name == name
    assert scene.warnings == ()
    rows = [row.bearing for row in rows_of(scene.element.bearing)]
    counts = [getattr(row, f"n_{row.noun}s") for row in rows]
    written = {raw["bearing"].get(key) for key in ("n_rollers", "n_balls")}
    assert set(counts) == written - {None}
    assert scene.points == (101 if "n_rollers" in raw["bearing"] else 2)
    assert scene.tolerance is None
    assert any(scene.load)


ARCS = dict(roller_profile_radius=0.078, inner_raceway_radius=0.08)
SHAPES = {
    "spherical_roller": bj.BearingSet.self_aligning(
        bj.SphericalRollerRow(18, 0.138, 0.0215, 0.0185, contact_angle=0.2, **ARCS),
        staggered=False,
    ),
    "toroidal_roller": bj.ToroidalRollerBearing(
        20, 0.14, 0.0195, 0.03, outer_raceway_radius=0.11, **ARCS
    ),
    "cylindrical_thrust_roller": bj.CylindricalThrustRollerBearing(
        21, 0.0775, 0.009, 0.009
    ),
    "tapered_thrust_roller": bj.TaperedThrustRollerBearing(
        20, 0.12, 0.01, 0.014, roller_axis_angle=1.488, roller_half_angle=0.08276
    ),
    "spherical_thrust_roller": bj.SphericalThrustRollerBearing(
        14, 0.12, 0.022, 0.026, contact_angle=0.9, profile_offset=1e-3, **ARCS
    ),
    "crossed_roller": bj.BearingSet.crossed(
        bj.CrossedRollerRow(40, 0.2775, 0.014, 0.01, radial_internal_clearance=-4e-6)
    ),
}


@pytest.mark.parametrize("kind", SHAPES)
def test_barrel_thrust_and_crossed_rollers_are_those_of_python(kind, tmp_path):
    meant = SHAPES[kind]
    row: Any = rows_of(meant)[0].bearing
    lines = [f"[bearing]\ntype = '{kind}'\nn_rollers = {row.n_rollers}"]
    for field in dataclasses.fields(row):
        value = getattr(row, field.name)
        if "unit" in field.metadata and value is not None and np.ndim(value) == 0:
            lines.append(f"{field.name} = '{float(value)!r} {field.metadata['unit']}'")
    if kind == "spherical_roller":
        lines.append("staggered = false")
    found = read_text(tmp_path, "\n".join(lines))
    assert eqx.tree_equal(found.element.bearing, meant)
    again = tmp_path / "again.json"
    again.write_text(json.dumps({"inputs": found.inputs}), encoding="utf-8")
    assert eqx.tree_equal(bj.read_scene(again).element.bearing, meant)


@pytest.mark.parametrize("offset", [0.0, 3e-3])
def test_pitch_diameter_follows_from_the_sphere(offset, tmp_path):
    """The sphere is about the axis: D_pw = 2 (r - gap - D/2) cos(angle)."""
    scene = bj.read_scene("spherical_roller")
    row = scene.element.bearing.rows[0].bearing
    gap = 5e-6 * np.cos(9.5 * DEG)
    pitch = 2.0 * (80.5e-3 - gap - 10.75e-3) * np.cos(9.5 * DEG)
    assert float(row.pitch_diameter) == near(pitch)
    assert scene.inputs["bearing"]["pitch_diameter"] == f"{float(pitch)!r} m"
    assert float(row.sphere_radius) == near(80.5e-3)
    text = "[bearing]\ntype = 'spherical_thrust_roller'\nn_rollers = 14\n"
    sizes = dict(roller_diameter=22, roller_length=26, outer_raceway_radius=105)
    sizes |= dict(inner_raceway_radius=105, roller_profile_radius=101.85)
    sizes |= dict(profile_offset=1e3 * offset)
    text += "\n".join(f"{key} = '{value} mm'" for key, value in sizes.items())
    found = read_text(tmp_path, f"{text}\ncontact_angle = '50 deg'")
    # Contact in the middle of the roller, on the normal through the centre.
    half = np.arcsin(offset / 101.85e-3)
    pitch = 2 * 105e-3 * np.cos(50 * DEG) - 22e-3 * np.cos(50 * DEG - half)
    assert float(found.element.bearing.pitch_diameter) == near(pitch)


def test_design_sections_of_shipped_roller_scenes():
    """No solution is needed for its sizes."""

    def told(name):
        return str(design_sections(bj.read_scene(name))["Bearing"][0])

    assert told("spherical_roller").splitlines() == [
        "spherical_roller: set of 2 rows at z = 11.51 mm, -11.51 mm (mirrored)",
        "each row: spherical roller bearing, 18 rollers 21.5 x 18.5 mm on a pitch"
        " circle of 137.6 mm",
        "radial internal clearance 20 µm; ribs: none; roller profile: Straight",
        "contact angle: 9.5 deg",
        "profile radii: roller 78.085 mm, raceways outer 80.5 mm (a sphere), inner"
        " 80.5 mm",
    ]
    assert told("crossed_roller").splitlines() == [
        "crossed_roller: crossed roller bearing, 40 rollers 14 x 10 mm on a pitch"
        " circle of 277.5 mm",
        "radial internal clearance 0 µm; ribs: none; roller profile: Logarithmic",
        "contact angle: 45 deg, of every other roller -45",
    ]
    text = told("thrust_roller")
    assert "clearance" not in text and "contact angle: 90 deg" in text


def test_fits_of_a_crossed_roller_bearing_need_no_ring_width():
    """Both rows are in the same rings: no rings of their own grow between them."""
    seats = 'bore = "230 mm", outside_diameter = "330 mm", housing_diameter = "500 mm"'
    tight = 'shaft_interference = "40 um", housing_interference = "0 um"'
    fit = f"fit={{ {seats}, {tight} }}"
    scene = bj.read_scene("crossed_roller", [fit])
    rows = scene.running().bearing.rows
    clearance = float(rows[0].bearing.radial_internal_clearance)
    # Radially, as specified: a solid shaft passes on the ratio of the diameters.
    passed = 230.0 / (277.5 - 14.0 * np.sqrt(0.5))
    assert clearance == near(-40e-6 * passed)
    assert float(rows[1].bearing.radial_internal_clearance) == clearance
    assert [float(row.inner_offset) for row in rows] == [0.0, 0.0]


ROWS = """
[set]
arrangement = "rows"
[[set.rows]]
position = "-20 mm"
[[set.rows]]
position = "20 mm"
mirrored = true
bearing = { type = "angular_contact_ball", n_balls = 15, pitch_diameter = "70 mm",\
 ball_diameter = "11 mm", outer_osculation = 0.53,\
 inner_osculation = 0.53, contact_angle = "25 deg" }
"""


def with_rows(folder, text=ROWS, settings=()):
    shipped = shipped_scenes()["angular_contact"].read_text(encoding="utf-8")
    return read_text(folder, shipped + text.replace("\\\n", ""), settings)


def test_rows_of_a_set_have_their_own_bearings(tmp_path):
    first, second = with_rows(tmp_path).element.bearing.rows
    assert first.bearing.n_balls == 19 and second.bearing.n_balls == 15
    assert float(second.bearing.pitch_diameter) == near(70e-3)
    assert fields(second.bearing.material) == steel()
    scene = with_rows(tmp_path, settings=["set.rows.1.bearing.ball_diameter=12 mm"])
    assert float(scene.element.bearing.rows[1].bearing.ball_diameter) == near(12e-3)
    assert scene.inputs["set"]["rows"][1]["bearing"]["n_balls"] == 15
    assert "bearing" not in scene.inputs["set"]["rows"][0]


@pytest.mark.parametrize(
    "setting, message",
    [
        (
            "set.rows.1.bearing.n_balls=0",
            "`set.rows[1].bearing.n_balls`: 0 is not a wh",
        ),
        ("set.rows.1.bearing.type=ball", "`set.rows[1].bearing.type`: 'ball' is not k"),
        (
            'set.rows.1.bearing={ designation = "1205" }',
            "`set.rows[1].bearing`: a self-aligning bearing is no row of a set",
        ),
        ("set.rows.1.bearing=3", "`set.rows[1].bearing`: 3 is not a table"),
        ("set.rows.1.bearing.bore=3", "`set.rows[1].bearing.bore`: unknown key"),
        (
            'fit={ bore = "70 mm", outside_diameter = "110 mm", shaft = "k5" }',
            "`fit`: is for rows of one bearing; those of this set differ",
        ),
    ],
)
def test_wrong_rows(tmp_path, setting, message):
    with pytest.raises(bj.files.SceneError) as caught:
        with_rows(tmp_path, settings=[setting])
    assert str(caught.value).startswith("mine.toml:") and message in str(caught.value)


@pytest.mark.parametrize("name", ["needle", "tapered"])
def test_bearing_alone_and_by_path(name):
    scene = bj.read_scene(shipped_scenes()[name])
    expected = jax.tree.flatten(scene.element.bearing)
    alone = jax.tree.flatten(bj.load_bearing(name))
    assert alone == expected


def test_cylindrical_rig():
    scene = bj.read_scene("cylindrical_rig")
    bearing = scene.element.bearing
    assert type(bearing) is bj.CylindricalRollerBearing
    assert bearing.n_rollers == 12
    assert float(bearing.pitch_diameter) == near(0.0725)
    assert float(bearing.roller_diameter) == near(0.014)
    assert float(bearing.roller_length) == near(0.01372)
    assert float(bearing.radial_internal_clearance) == 0.0
    assert float(bearing.first_azimuth) == near(90.0 * DEG)
    assert type(bearing.roller_profile) is bj.CrownedEnds
    profile = {"straight_length": 9e-3, "crown_radius": 1.0}
    assert fields(bearing.roller_profile) == near(profile)
    assert type(bearing.outer_raceway_profile) is bj.Straight
    assert type(bearing.inner_raceway_profile) is bj.Straight
    assert bearing.ribs.present == ()
    assert fields(bearing.material) == steel()
    assert bearing.ring_material is None
    assert type(scene.element.line_law) is bj.contact.Palmgren
    assert type(scene.element.kinematics) is bj.element.Linearised
    assert scene.element.quadrature == bj.numerics.Midpoint(20)
    assert type(scene.element.equilibrium) is bj.numerics.TrustRegionNewton
    assert scene.load == near((0.0, -10600.0, 0.0, -2.0, 0.0, 0.0))
    assert scene.free == ("ux", "uy", "gx", "gy")
    assert scene.prescribed == {}
    assert (scene.fixed_ring, scene.moving_ring) == ("inner", "outer")
    assert scene.speed is None


def test_cylindrical_ribs():
    scene = bj.read_scene("cylindrical_ribs")
    bearing = scene.element.bearing
    assert type(bearing) is bj.CylindricalRollerBearing
    assert bearing.n_rollers == 14
    assert float(bearing.radial_internal_clearance) == near(25e-6)
    assert float(bearing.first_azimuth) == 0.0
    assert type(bearing.roller_profile) is bj.Logarithmic
    assert fields(bearing.roller_profile) == near({"coefficient": 0.00035})
    names = ("outer_minus", "outer_plus", "inner_minus", "inner_plus")
    assert bearing.ribs.present == names
    # A quarter of the axial play at each rib.
    rib = {"end_radius": 0.3, "contact_height": 1.5e-3, "axial_gap": 15e-6}
    for name in names:
        assert fields(getattr(bearing.ribs, name)) == near(rib)
    assert fields(bearing.material) == steel()
    assert scene.element.quadrature == bj.numerics.ContactMapped(32)
    assert type(scene.element.equilibrium) is bj.numerics.TrustRegionNewton
    assert scene.load == near((0.0, -4000.0, 300.0, 0.0, 0.0, 0.0))
    assert scene.free is None
    assert (scene.fixed_ring, scene.moving_ring) == ("outer", "inner")
    assert float(scene.speed.inner) == near(1500.0 * RPM)
    assert float(scene.speed.outer) == 0.0


def test_a_quarter_of_the_radial_play_stands_at_each_raceway():
    constants = (
        bj.read_scene("cylindrical_ribs").element.model().rows[0].element.constants
    )
    assert float(constants.gap[1]) == near(25e-6 / 4.0)


def test_tapered():
    scene = bj.read_scene("tapered")
    bearing = scene.element.bearing
    assert type(bearing) is bj.TaperedRollerBearing
    assert bearing.n_rollers == 17
    assert float(bearing.pitch_diameter) == near(0.052)
    assert float(bearing.roller_diameter) == near(0.0082)
    assert float(bearing.roller_length) == near(0.0115)
    assert float(bearing.roller_axis_angle) == near(11.0 * DEG)
    assert float(bearing.roller_half_angle) == near(1.7235 * DEG)
    assert float(bearing.radial_internal_clearance) == 0.0
    assert type(bearing.roller_profile) is bj.Logarithmic
    assert bearing.ribs.present == ("inner_minus",)
    rib = {"end_radius": 0.09, "contact_height": 1.2e-3, "axial_gap": 0.0}
    assert fields(bearing.ribs.inner_minus) == near(rib)
    assert scene.load == near((5000.0, 0.0, 6000.0, 0.0, 0.0, 0.0))
    assert scene.fixed_ring == "outer"
    assert float(scene.speed.inner) == near(3000.0 * RPM)


def test_hybrid_spindle():
    bearing = bj.load_bearing("hybrid_spindle")
    ceramic = {"elastic_modulus": 310e9, "poisson_ratio": 0.26, "density": 3200.0}
    assert fields(bearing.material) == near(ceramic)
    assert fields(bearing.ring_material) == steel()
    assert float(bearing.radial_internal_clearance) == near(-3e-6)
    assert bearing.ribs.present == ("inner_minus", "inner_plus")
    assert type(bearing.roller_profile) is bj.JohnsGohar
    assert float(bearing.roller_profile.design_load) == near(1500.0)
    assert float(bearing.roller_profile.half_width) == near(60e-6)


def test_needle():
    scene = bj.read_scene("needle")
    assert type(scene.element.bearing) is bj.NeedleRollerBearing
    assert fields(scene.element.bearing.roller_profile) == near(
        {
            "straight_length": 8e-3,
            "crown_radius": 0.6,
            "dub_off_length": 0.4e-3,
            "dub_off_radius": 0.02,
        }
    )
    assert scene.load == near((0.0, -8000.0, 0.0, 3.0, 0.0, 0.0))
    assert scene.speed is None


def test_nj_axial():
    bearing = bj.load_bearing("nj_axial")
    assert bearing.ribs.present == ("outer_minus", "outer_plus", "inner_minus")
    assert float(bearing.ribs.outer_plus.axial_gap) == near(20e-6)
    profile = bearing.roller_profile
    assert type(profile) is bj.FujiwaraKawase
    assert float(profile.design_load) == near(8000.0)
    assert float(profile.load_factor) == near(1.5)
    assert float(profile.crowned_fraction) == near(0.6)
    assert float(profile.end_drop) == near(15e-6)


EVERYTHING = """
[bearing]
type = "tapered_roller"
n_rollers = 9
pitch_diameter = "2 in"
roller_diameter = "0.8 cm"
roller_length = "11500 µm"
radial_internal_clearance = "-1.5e-3 mm"
roller_axis_angle = "0.2 rad"
roller_half_angle = "0.02 rad"
first_azimuth = "-30 deg"
material = "zirconia"
ring_material = { elastic_modulus = "200 kN/mm^2", density = "7.7 g/cm^3" }

[bearing.roller_profile]
type = "lundberg"
design_load = "2 kN"
contact_modulus = "1e5 MPa"

[bearing.raceway_profile]
outer = { type = "circular_crown", crown_radius = "4 m" }

[bearing.raceway_profile.inner]
type = "tabulated"
positions = ["-6 mm", "0 mm", "6 mm"]
drops = ["4 um", "0 um", "5 um"]

[bearing.ribs]
inner_minus = { end_radius = "90 mm", contact_height = "1.2 mm", axial_gap = "-2 um" }
outer_plus = { end_radius = "80 mm", contact_height = "1 mm" }

[contact]
line_law = "iso16281"

[operating]
fixed_ring = "inner"
prescribed = { gz = "0.5 deg", gx = "-2 mrad", uy = "7 um" }
free = ["uz", "ux", "gy"]
inner_speed = "180 deg/s"
outer_speed = "-60 rpm"

[operating.load]
Fx = "2 kN"
Fz = "-3e3 N"
My = "5 N mm"

[numerics]
quadrature = "contact_mapped"
points = 12
kinematics = "finite"
equilibrium = "bfgs"
tolerance = 1e-8

[output]
points = 33
"""


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    return read_text(tmp_path_factory.mktemp("scene"), EVERYTHING)


def test_units_of_every_kind(everything):
    bearing = everything.element.bearing
    assert float(bearing.pitch_diameter) == near(0.0508)
    assert float(bearing.roller_diameter) == near(0.008)
    assert float(bearing.roller_length) == near(0.0115)
    assert float(bearing.radial_internal_clearance) == near(-1.5e-6)
    assert float(bearing.roller_axis_angle) == near(0.2)
    assert float(bearing.roller_half_angle) == near(0.02)
    assert float(bearing.first_azimuth) == near(-30.0 * DEG)
    ceramic = {"elastic_modulus": 205e9, "poisson_ratio": 0.3, "density": 6050.0}
    assert fields(bearing.material) == near(ceramic)
    # What is not said of a material is that of steel.
    rings = {"elastic_modulus": 200e9, "poisson_ratio": 0.3, "density": 7700.0}
    assert fields(bearing.ring_material) == near(rings)
    assert float(everything.speed.inner) == near(np.pi)
    assert float(everything.speed.outer) == near(-2.0 * np.pi)


def test_profiles_of_roller_and_raceways(everything):
    bearing = everything.element.bearing
    assert type(bearing.roller_profile) is bj.Lundberg
    lundberg = {"design_load": 2000.0, "contact_modulus": 1e11}
    assert fields(bearing.roller_profile) == near(lundberg)
    assert type(bearing.outer_raceway_profile) is bj.CircularCrown
    assert fields(bearing.outer_raceway_profile) == near({"crown_radius": 4.0})
    table = bearing.inner_raceway_profile
    assert type(table) is bj.Tabulated
    assert np.asarray(table.positions) == near(np.array([-6e-3, 0.0, 6e-3]))
    assert np.asarray(table.drops) == near(np.array([4e-6, 0.0, 5e-6]))


def test_ribs_one_by_one(everything):
    ribs = everything.element.bearing.ribs
    assert ribs.present == ("outer_plus", "inner_minus")
    inner = {"end_radius": 0.09, "contact_height": 1.2e-3, "axial_gap": -2e-6}
    outer = {"end_radius": 0.08, "contact_height": 1e-3, "axial_gap": 0.0}
    assert fields(ribs.inner_minus) == near(inner)
    assert fields(ribs.outer_plus) == near(outer)


def test_operation_and_numerics(everything):
    assert everything.name == "mine"
    assert everything.load == near((2000.0, 0.0, -3000.0, 0.0, 5e-3, 0.0))
    prescribed = {"uy": 7e-6, "gx": -2e-3, "gz": 0.5 * DEG}
    assert everything.prescribed == near(prescribed)
    assert everything.free == ("uz", "ux", "gy")
    assert (everything.fixed_ring, everything.moving_ring) == ("inner", "outer")
    assert everything.tolerance == 1e-8
    assert everything.points == 33
    element = everything.element
    assert type(element.line_law) is bj.contact.ISO16281
    assert type(element.kinematics) is bj.element.Finite
    assert element.quadrature == bj.numerics.ContactMapped(12)
    assert type(element.equilibrium) is bj.numerics.BFGS


def test_apexes_apart_are_a_warning_of_the_scene(everything):
    assert len(everything.warnings) == 1
    assert "apexes" in everything.warnings[0]


def test_line_constant_overrides_the_law():
    setting = "contact.line_constant=35948 N/mm^(19/9)"
    law = bj.read_scene("cylindrical_rig", [setting]).element.line_law
    assert type(law) is bj.contact.LineConstant
    assert float(law.value) == near(35948.0 * 1e3 ** (19.0 / 9.0))


@pytest.mark.parametrize(
    "arrangement, present",
    [
        ("N", ("inner_minus", "inner_plus")),
        ("NU", ("outer_minus", "outer_plus")),
        ("NJ", ("outer_minus", "outer_plus", "inner_minus")),
    ],
)
def test_arrangements(arrangement, present):
    settings = [f"bearing.arrangement={arrangement}"]
    ribs = bj.read_scene("cylindrical_ribs", settings).element.bearing.ribs
    assert ribs.present == present


def test_settings_are_toml_or_bare_text():
    settings = [
        "operating.load.Fy=-6 kN",
        'operating.load.Mx = "3 N m"',
        "operating.load.Fy=-7 kN",
        "operating.prescribed={uz='2 um'}",
        'operating.free=["ux", "uy", "gx"]',
        "numerics.points=40",
        "numerics.tolerance=1e-6",
        "bearing.first_azimuth=0 deg",
    ]
    scene = bj.read_scene("cylindrical_rig", settings)
    # The last word counts, the other components stay.
    assert scene.load == near((0.0, -7000.0, 0.0, 3.0, 0.0, 0.0))
    assert scene.prescribed == near({"uz": 2e-6})
    assert scene.free == ("ux", "uy", "gx")
    assert scene.element.quadrature == bj.numerics.Midpoint(40)
    assert scene.tolerance == 1e-6
    assert float(scene.element.bearing.first_azimuth) == 0.0
    # The shipped scene is as it was.
    assert bj.read_scene("cylindrical_rig").load[1] == -10600.0


def test_read_scene_zero_speed_is_none():
    assert bj.read_scene("tapered", ["operating.inner_speed=0 rpm"]).speed is None


def test_comments_and_least_scene(tmp_path):
    text = """
    [bearing] # all the rest by default
    type = "cylindrical_roller"
    n_rollers = 1
    pitch_diameter = "40 mm"
    roller_diameter = "5 mm"
    roller_length = "5 mm"
    """
    scene = read_text(tmp_path, text)
    assert scene.load == (0.0,) * 6
    assert type(scene.element.bearing.roller_profile) is bj.Straight
    assert scene.free is None and scene.prescribed == {}


def test_reading_needs_float64():
    with jax.enable_x64(False), pytest.raises(bj.SceneError, match="float64"):
        bj.read_scene("cylindrical_rig")


def test_ball_scene():
    scene = bj.read_scene("angular_contact")
    bearing, element = scene.element.bearing, scene.element
    assert type(bearing) is bj.AngularContactBallBearing
    assert fields(bearing.material) == near(fields(bj.Material.silicon_nitride()))
    assert float(bearing.contact_angle) == pytest.approx(np.deg2rad(25))
    assert type(element.point_law) is bj.contact.OperatingAngle
    assert type(element.raceway_control) is bj.element.FrictionLimited
    assert float(element.raceway_control.friction) == pytest.approx(0.06)
    plain = bj.read_scene("deep_groove").element
    assert type(plain.point_law) is bj.contact.FreeAngle
    assert type(plain.raceway_control) is bj.element.OuterControl


@pytest.mark.parametrize("table, count", [("", 1), ("[cases.grid]", 0)])
def test_raceway_control_without_speed_is_said_to_do_nothing(tmp_path, table, count):
    path = tmp_path / "scene.toml"
    control = 'inner_speed = "9 rpm"\nraceway_control = "inner"'
    text = f'[bearing]\ndesignation = "6205"\n[operating]\n{control}'
    path.write_text(f"{text}\n{table}")
    for settings, wanted in ((), 0), (["operating.inner_speed=0 rpm"], count):
        kinds = [w.kind for w in bj.read_scene(path, settings).warnings]
        assert kinds.count("unused_control") == wanted


@pytest.mark.parametrize(
    "arrangement, mirrored",
    [
        ("back_to_back", (False, True)),
        ("face_to_face", (True, False)),
        ("tandem", (False, False)),
    ],
)
def test_sets(arrangement, mirrored):
    settings = [f"set.arrangement={arrangement}"]
    if arrangement == "tandem":
        settings = [
            'set={arrangement = "tandem", spacing = "17 mm", count = 2}',
        ]
    rows = bj.read_scene("ball_pair", settings).element.bearing.rows
    assert tuple(row.mirrored for row in rows) == mirrored
    assert [float(row.position) for row in rows] == pytest.approx([-8.5e-3, 8.5e-3])


def test_rows_of_a_set_one_by_one():
    setting = (
        'set={arrangement = "rows", rows = [{position = "-9 mm"}, {position = "9 mm",'
        ' mirrored = true, inner_offset = "-4 um"}]}'
    )
    rows = bj.read_scene("ball_pair", [setting]).element.bearing.rows
    assert [row.mirrored for row in rows] == [False, True]
    assert float(rows[1].inner_offset) == pytest.approx(-4e-6)


def test_point_constants():
    settings = [
        "contact.outer_constant=3e10 N/m^1.5",
        "contact.inner_constant=2 N/m^1.5",
    ]
    law = bj.read_scene("deep_groove", settings).element.point_law
    assert type(law) is bj.contact.PointConstant
    assert [float(law.outer), float(law.inner)] == pytest.approx([3e10, 2.0])


def test_read_scene_coupled_slices():
    setting = ("contact.line_law=coupled_slices", "contact.slices=12")
    element = bj.read_scene("tapered", setting).element
    assert element.line_law == bj.contact.CoupledSlices(12)


def test_relative_speed_of_rings():
    assert relative_speed(None) == 0.0
    assert relative_speed(bj.element.Speed(3.0, 5.0)) == -2.0

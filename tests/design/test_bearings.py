# ruff: noqa: E501 - the tables of bad calls read best as one line a call
"""What a constructor refuses, and in which words; what it lets through."""

import dataclasses
from math import atan, pi, sin

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.design import (
    CircularCrown,
    CrownedEnds,
    CylindricalRollerBearing,
    FujiwaraKawase,
    JohnsGohar,
    Logarithmic,
    Lundberg,
    Material,
    NeedleRollerBearing,
    Rib,
    Ribs,
    Tabulated,
    TaperedRollerBearing,
)

PITCH, DIAMETER, LENGTH, AXIS = 0.0725, 0.014, 0.01372, 0.25
HALF = atan(0.5 * DIAMETER * sin(AXIS) / (0.5 * PITCH))  # all apexes in one point


def cylindrical(n=12, pitch=PITCH, diameter=DIAMETER, length=LENGTH, **rest):
    return CylindricalRollerBearing(n, pitch, diameter, length, **rest)


def profiled(profile, length=LENGTH):
    return cylindrical(length=length, roller_profile=profile)


def ribbed(*rib):
    return cylindrical(ribs=Ribs.arrangement("NU", Rib(*rib)))


def needle(length, diameter=0.003):
    return NeedleRollerBearing(20, 0.033, diameter, length)


def tapered(axis=AXIS, half=HALF, **rest):
    angles = dict(roller_axis_angle=axis, roller_half_angle=half)
    return TaperedRollerBearing(12, PITCH, DIAMETER, LENGTH, **angles, **rest)


def table(positions, drops):
    return profiled(Tabulated(np.array(positions), np.array(drops)))


BAD_NUMBERS = {
    "negative pitch": (lambda: cylindrical(pitch=-PITCH), r"`pitch_diameter` is -0.0725 m.*above 0 m"),
    "no roller": (lambda: cylindrical(0), r"`n_rollers` is 0;.*whole number of at least 1"),
    "-3 rollers": (lambda: cylindrical(-3), r"`n_rollers` is -3;.*at least 1"),
    "zero diameter": (lambda: cylindrical(diameter=0.0), r"`roller_diameter` is 0 m.*above 0 m"),
    "NaN length": (lambda: cylindrical(length=np.nan), r"`roller_length` is nan m.*finite"),
    "infinite pitch": (lambda: cylindrical(pitch=np.inf), r"`pitch_diameter` is inf m.*finite"),
    "list": (lambda: cylindrical(diameter=[0.014, 0.014]), r"`roller_diameter` has shape \(2,\).*one number in m"),
    "NaN clearance": (lambda: cylindrical(radial_internal_clearance=np.nan), r"`radial_internal_clearance` is nan m.*finite"),
    "clearance in um": (lambda: cylindrical(radial_internal_clearance=20.0), r"`radial_internal_clearance` is 20 m.*roller diameter \(metres meant\?\)"),
    "infinite azimuth": (lambda: cylindrical(first_azimuth=-np.inf), r"`first_azimuth` is -inf rad.*finite"),
    "overlap": (lambda: cylindrical(17), r"`n_rollers` is 17 rollers.*overlap.*at most 16"),
    "big roller": (lambda: cylindrical(1, diameter=PITCH), r"`roller_diameter` is 0.0725 m.*inner raceway inside the pitch circle of 0.0725 m"),
    "short needle": (lambda: needle(0.0074), r"`roller_length` is 0.0074 m.*at least 2.5 roller diameters, 0.0075 m"),
    "crown of half the length": (lambda: profiled(CircularCrown(0.5 * LENGTH)), r"`crown_radius` is 0.00686 m.*above 0.00686 m"),
    "deep crown": (lambda: cylindrical(diameter=0.003, roller_profile=CircularCrown(0.007)), r"`crown_drop` is .* m.*below half the roller diameter, 0.0015 m"),
    "negative crown": (lambda: CircularCrown(-1.0), r"`crown_radius` is -1 m.*above 0 m"),
    "long straight part": (lambda: profiled(CrownedEnds(0.014, 1.0)), r"`straight_length` is 0.014 m.*above 0 and below 0.01372 m"),
    "zero straight part": (lambda: CrownedEnds(0.0, 1.0), r"`straight_length` is 0 m.*above 0 m"),
    "half a dub-off": (lambda: CrownedEnds(0.009, 1.0, 0.001), r"`dub_off_length` and `dub_off_radius` go together"),
    "dub-off radius alone": (lambda: CrownedEnds(0.009, 1.0, dub_off_radius=0.3), r"`dub_off_length` and `dub_off_radius` go together"),
    "blunt dub-off": (lambda: profiled(CrownedEnds(0.009, 1.0, 0.001, 1.1)), r"`dub_off_radius` is 1.1 m.*at most the crown radius, 1 m"),
    "long dub-off": (lambda: profiled(CrownedEnds(0.009, 1.0, 0.003, 0.3)), r"`dub_off_length` is 0.003 m.*below 0.00236 m"),
    "steep dub-off": (lambda: profiled(CrownedEnds(0.009, 1.0, 0.001, 0.0009)), r"`dub_off_radius` is 0.0009 m.*above 0.00100"),
    "no logarithm": (lambda: Logarithmic(0.0), r"`coefficient` is 0;.*above 0"),
    "negative load": (lambda: Lundberg(-1.0), r"`design_load` is -1 N.*above 0 N"),
    "soft pair": (lambda: Lundberg(1e3, 0.0), r"`contact_modulus` is 0 Pa.*above 0 Pa"),
    "no half width": (lambda: JohnsGohar(1e3, 0.0), r"`half_width` is 0 m.*above 0 m"),
    "wide contact": (lambda: profiled(JohnsGohar(1e3, 0.007)), r"`half_width` is 0.007 m.*below 0.00686 m"),
    "crowned beyond": (lambda: FujiwaraKawase(1e3, 1.0, 1.01, 1e-5), r"`crowned_fraction` is \[?1.01\]?;.*above 0 and at most 1"),
    "no end drop": (lambda: FujiwaraKawase(1e3, 1.0, 0.5, 0.0), r"`end_drop` is 0 m.*above 0 m"),
    "short table": (lambda: Tabulated([0.0, 1.0], [0.0, 1.0]), r"`positions` and `drops` have shapes \(2,\) and \(2,\).*at least 3"),
    "unequal table": (lambda: Tabulated([-1.0, 0.0, 1.0], [0.0, 0.1]), r"`positions` and `drops` have shapes \(3,\) and \(2,\)"),
    "descending table": (lambda: table([0.01, 0.0, -0.01], [0.0] * 3), r"`positions` is \[.*\] m.*ascending"),
    "negative table": (lambda: table([-0.01, 0.0, 0.01], [0.0, -1e-9, 0.0]), r"`drops` is \[.*\] m.*at least 0 m"),
    "NaN table": (lambda: table([-0.01, np.nan, 0.01], [0.0] * 3), r"`positions` is \[.*\] m.*finite numbers"),
    "narrow table": (lambda: table([-0.0068, 0.0, 0.007], [0.0] * 3), r"`positions` is \[.*\] m.*covers the roller, from -0.00686 to 0.00686 m"),
    "high rib": (lambda: ribbed(0.1, 0.0141), r"`ribs.outer_minus.contact_height` is 0.0141 m.*below the diameter of the roller end, 0.014 m"),
    "small sphere": (lambda: ribbed(0.0069, 0.002), r"`ribs.outer_minus.end_radius` is 0.0069 m.*above the radius of the roller end, 0.007 m"),
    "no axis angle": (lambda: TaperedRollerBearing(12, PITCH, DIAMETER, LENGTH), r"`roller_axis_angle` is nan rad.*finite"),
    "axis angle 0": (lambda: tapered(0.0, 0.0), r"`roller_axis_angle` is 0 rad.*above 0 and below 1.5708 rad"),
    "axis angle 90": (lambda: tapered(0.5 * pi), r"`roller_axis_angle` is 1.5708 rad.*below 1.5708 rad"),
    "axis angle in degrees": (lambda: tapered(14.0), r"`roller_axis_angle` is 14 rad.*below 1.5708 rad"),
    "half angle of the axis": (lambda: tapered(AXIS, AXIS), r"`roller_half_angle` is 0.25 rad.*at least 0 and below 0.25 rad"),
    "negative half angle": (lambda: tapered(AXIS, -0.01), r"`roller_half_angle` is -0.01 rad.*at least 0"),
}  # fmt: skip


@pytest.mark.parametrize("make, message", BAD_NUMBERS.values(), ids=BAD_NUMBERS)
def test_bad_numbers(make, message):
    with pytest.raises(ValueError, match=r"^\w+: " + message):
        make()


BAD_TYPES = {
    "text": (lambda: cylindrical(pitch="72.5 mm"), r"`pitch_diameter` is '72.5 mm'.*number in m \(units belong in scene files\)"),
    "complex": (lambda: cylindrical(pitch=0.07 + 0j), r"`pitch_diameter` is \(0.07\+0j\).*number in m"),
    "NumPy's bool": (lambda: cylindrical(pitch=np.True_), r"`pitch_diameter` is np.True_.*number in m"),
    "a list of texts": (lambda: cylindrical(pitch=["a"]), r"`pitch_diameter` is \['a'\].*number in m"),
    "None": (lambda: cylindrical(length=None), r"`roller_length` is None.*number in m"),
    "text coefficient": (lambda: Logarithmic("3.5e-4"), r"`coefficient` is '3.5e-4'.*number"),
    "text angle": (lambda: tapered("15 deg"), r"`roller_axis_angle` is '15 deg'.*rad"),
    "text modulus": (lambda: Material("206 GPa"), r"`elastic_modulus` is '206 GPa'.*Pa"),
    "text gap": (lambda: Rib(0.1, 0.002, "1 um"), r"`axial_gap` is '1 um'.*in m"),
    "bool count": (lambda: cylindrical(True), r"`n_rollers` is True.*whole number"),
    "float count": (lambda: cylindrical(12.0), r"`n_rollers` is 12.0.*whole number"),
    "text count": (lambda: cylindrical("12"), r"`n_rollers` is '12'.*whole number"),
    "no count": (lambda: cylindrical(None), r"`n_rollers` is None.*whole number"),
    "profile": (lambda: profiled("crown"), r"`roller_profile` is a str.*a Profile"),
    "raceway": (lambda: cylindrical(inner_raceway_profile=1.0), r"`inner_raceway_profile` is a float.*a Profile"),
    "a rib for ribs": (lambda: cylindrical(ribs=Rib(0.1, 0.002)), r"`ribs` is a Rib;.*a Ribs"),
    "a number for a rib": (lambda: Ribs(inner_plus=0.1), r"`inner_plus` is a float.*a Rib or None"),
    "material": (lambda: cylindrical(material=206e9), r"`material` is a float.*a Material"),
    "rings": (lambda: cylindrical(ring_material="steel"), r"`ring_material` is a str.*a Material or None"),
}  # fmt: skip


@pytest.mark.parametrize("make, message", BAD_TYPES.values(), ids=BAD_TYPES)
def test_bad_types(untyped, make, message):
    with pytest.raises(TypeError, match=r"^\w+: " + message):
        make()


def test_numbers_of_any_kind_pass():
    whole = CylindricalRollerBearing(3, 10, np.float32(2), jnp.asarray(1))
    assert whole.pitch_diameter.dtype == jnp.float64
    assert float(whole.roller_diameter) == 2.0
    preload = cylindrical(radial_internal_clearance=-1e-5)
    assert float(preload.radial_internal_clearance) == -1e-5


def test_as_many_rollers_as_fit():
    """sin(π/z) = D/pitch is the limit: 16 fit, as the message above says."""
    assert int(pi / np.arcsin(DIAMETER / PITCH)) == 16
    cylindrical(16)
    cylindrical(1, diameter=0.9 * PITCH)


def test_materials_of_rings():
    ceramic = Material.silicon_nitride()
    assert cylindrical(material=ceramic).rings is not None
    assert float(cylindrical(material=ceramic).rings.density) == 3200.0
    hybrid = cylindrical(material=ceramic, ring_material=Material.steel())
    assert float(hybrid.rings.density) == 7850.0


def test_angles():
    bearing = cylindrical()
    assert float(bearing.axis_angle) == float(bearing.half_angle) == 0.0
    bearing = tapered()
    assert float(bearing.axis_angle) == AXIS and float(bearing.half_angle) == HALF


def test_apexes_meet():
    """tan(half angle) = (D/2) sin(axis angle)/(pitch radius): one point, no warning."""
    bearing = tapered()
    assert bearing.warnings == ()
    roller = 0.5 * PITCH / np.tan(AXIS)
    np.testing.assert_allclose(bearing.apexes(), roller, rtol=ROUNDING)


def test_apexes_apart():
    bearing = tapered(half=1.1 * HALF)
    (told,) = bearing.warnings
    assert told.startswith("TaperedRollerBearing: the apexes of outer raceway")
    assert told.kind == "apexes_apart" and told.size > 2.0 * told.limit
    # Sets, elements and solutions have the warnings of the design, each once.
    pair = bj.BearingSet.back_to_back(bearing, 0.02)
    element = bj.BearingElement(pair)
    assert pair.warnings == element.warnings == (told,)
    assert bj.warnings(bearing) == bj.warnings(element) == [told]
    assert jax.jit(lambda b: jnp.asarray(len(b.warnings)))(bearing) == 0
    # The raceways by hand: tangent lines of the roller's mid circle.
    z, r = 0.5 * DIAMETER * np.array([np.sin(AXIS), np.cos(AXIS)])
    outer = z + (0.5 * PITCH + r) / np.tan(AXIS + 1.1 * HALF)
    inner = -z + (0.5 * PITCH - r) / np.tan(AXIS - 1.1 * HALF)
    want = outer, 0.5 * PITCH / np.tan(AXIS), inner
    np.testing.assert_allclose(bearing.apexes(), want, rtol=ROUNDING)


def test_cylinders_between_cones_do_not_warn():
    """Rollers without a cone angle cannot roll on apexes at all."""
    assert tapered(half=0.0).warnings == ()


def test_traced_construction():
    """Under `jit` and `grad` nothing is checked, and every number has a gradient."""
    knots = jnp.linspace(-0.5, 0.5, 5)

    def volume(x):
        pitch, diameter, length, axis, half = x
        profiles = [
            CrownedEnds(0.5 * length, 80.0 * length, 0.05 * length, 30.0 * length),
            Tabulated(knots * length, 1e-4 * length * knots**2),
            FujiwaraKawase(1e6 * length, 1.0, 0.5, 1e-3 * length),
        ]
        bearing = TaperedRollerBearing(
            12,
            pitch,
            diameter,
            length,
            roller_axis_angle=axis,
            roller_half_angle=half,
            radial_internal_clearance=1e-3 * length,
            roller_profile=profiles[0],
            outer_raceway_profile=profiles[1],
            inner_raceway_profile=profiles[2],
            ribs=Ribs(inner_minus=Rib(pitch, 0.1 * diameter, 1e-3 * length)),
            material=Material(1e12 * length, 20.0 * length, 1e5 * length),
        )
        leaves = [jnp.sum(leaf) for leaf in jax.tree.leaves(bearing)]
        drop = sum(
            p.drop(0.4 * length, length, diameter)
            for p in (
                bearing.roller_profile,
                bearing.outer_raceway_profile,
                bearing.inner_raceway_profile,
            )
        )
        return sum(leaves) + drop + sum(bearing.apexes())

    x = [jnp.asarray(v) for v in (PITCH, DIAMETER, LENGTH, AXIS, HALF)]
    value, slope = jax.jit(jax.value_and_grad(volume))(x)
    assert np.isfinite(value)
    assert np.all(np.isfinite(slope)) and np.all(np.asarray(slope) != 0)


def test_traced_invalid_diameter_is_accepted():
    """A bad traced number ends in a result code later, not here."""
    got = jax.jit(lambda d: cylindrical(diameter=d).roller_diameter)(jnp.asarray(-1.0))
    assert got == -1.0


def test_a_needle_of_just_the_length():
    assert float(needle(0.0076).roller_length) == 0.0076


@pytest.mark.parametrize("name", ["radial_internal_clearance", "roller_length"])
def test_bearing_changes_under_jit(name):
    """Checks of what is known take no traced numbers, whatever else is traced."""
    bearing = profiled(CrownedEnds(0.009, 1.0))
    change = jax.jit(lambda x: dataclasses.replace(bearing, **{name: x}))
    assert float(getattr(change(0.0136), name)) == 0.0136

"""Ball bearings and sets as drawings: geometry, and what is not allowed."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.design import rows_of

GROOVES = dict(outer_osculation=0.53, inner_osculation=0.52)


def deep(**change):
    return bj.DeepGrooveBallBearing(7, 0.0435, 0.0115, **(GROOVES | change))


def angular(**change):
    values = GROOVES | dict(contact_angle=0.44)
    return bj.AngularContactBallBearing(12, 0.0535, 0.0127, **(values | change))


def four_point(**change):
    values = GROOVES | dict(shim_angle=0.4)
    return bj.FourPointBallBearing(14, 0.0775, 0.014288, **(values | change))


def test_clearance_and_contact_angle_are_equivalent():
    for angle in (0.0, 1e-3, 0.13, 1.2):
        one = deep(contact_angle=angle)
        two = deep(radial_internal_clearance=one.clearance)
        assert float(two.free_contact_angle) == pytest.approx(angle, rel=1e-7)
        for a, b in zip(one.grooves, two.grooves, strict=True):
            assert float(a.radial) == pytest.approx(float(b.radial), rel=1e-14)
    # arccos(1 - s/(2A)) and its inverse, with A = (f_o + f_i - 1) D.
    bearing = deep(radial_internal_clearance=10e-6)
    assert float(bearing.centre_distance) == pytest.approx(0.05 * 0.0115)
    assert float(bearing.free_contact_angle) == pytest.approx(
        np.arccos(1 - 10e-6 / (2 * 0.05 * 0.0115)), rel=1e-9
    )
    assert float(angular().clearance) == pytest.approx(
        2 * 0.05 * 0.0127 * (1 - np.cos(0.44))
    )
    assert float(deep(radial_internal_clearance=-5e-6).free_contact_angle) == 0.0


def test_derivative_of_the_free_angle():
    def angle(clearance):
        return deep(radial_internal_clearance=clearance).free_contact_angle

    def cosine(clearance):
        return deep(radial_internal_clearance=clearance).free_cosine

    difference = (float(angle(10.01e-6)) - float(angle(9.99e-6))) / 0.02e-6
    assert float(jax.grad(angle)(10e-6)) == pytest.approx(difference, rel=1e-5)
    assert np.isfinite(float(jax.grad(angle)(-1e-6)))
    slope = -1.0 / (2 * 0.05 * 0.0115)
    assert float(jax.grad(cosine)(10e-6)) == pytest.approx(slope)


@pytest.mark.parametrize(
    "bearing, gap",
    [
        (deep(), 0.0),
        (deep(radial_internal_clearance=12e-6), None),
        (angular(), 0.0),
        (four_point(), 0.0),
        (bj.ThrustBallBearing(12, 0.06, 0.0127, **GROOVES), 0.0),
    ],
    ids=["deep", "clearance", "angular", "four-point", "thrust"],
)
def test_grooves_touch_balls_at_given_clearance(bearing, gap):
    """Unloaded and without play every groove is one ball radius from its ball."""
    gaps = [
        float(g.radius) - 0.5 * float(bearing.ball_diameter)
        - np.hypot(float(g.axial), float(g.radial))
        for g in bearing.grooves
    ]  # fmt: skip
    if gap is not None:
        assert np.allclose(gaps, gap, atol=1e-15)
    else:
        # Half of the diametral play, over both raceways.
        assert sum(gaps) == pytest.approx(6e-6)


def test_four_point_geometry():
    """Without play a ball rests at the shim angle; with it, further out."""
    assert float(four_point().free_contact_angle) == pytest.approx(0.4)
    assert float(four_point(radial_internal_clearance=40e-6).free_contact_angle) > 0.4
    axial = [float(g.axial) for g in four_point().grooves]
    outer, inner = (0.03 * 0.014288 * np.sin(0.4), 0.02 * 0.014288 * np.sin(0.4))
    assert np.allclose(axial, [-outer, outer, inner, -inner])


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: deep(outer_osculation=0.5), "`outer_osculation` is 0.5; .* above 0.5"),
        (lambda: deep(inner_osculation=0.96, outer_osculation=1.9), "below 1"),
        (lambda: deep(inner_osculation=float("nan")), "`inner_osculation` is nan"),
        (lambda: deep(ball_deviation=[1e-6]), r"shape \(1,\); it must be \(7,\)"),
        (lambda: deep(ball_deviation=[1e-3] * 7), "as large as its groove"),
        (lambda: deep(ball_deviation=[np.nan] * 7), "`ball_deviation`"),
        (lambda: deep(outer_shoulder=0.0), "`outer_shoulder` is 0 m"),
        (lambda: deep(radial_internal_clearance=1e-6, contact_angle=0.1), "both given"),
        (lambda: deep(contact_angle=1.6), "`contact_angle` is 1.6 rad"),
        (lambda: deep(radial_internal_clearance="10 um"), "must be a number in m"),
        (lambda: angular(contact_angle=0.0), "`contact_angle` is 0 rad"),
        (lambda: angular(contact_angle=-0.4), "above 0 and below"),
        (lambda: four_point(shim_angle=0.0), "`shim_angle` is 0 rad"),
        (lambda: four_point(radial_internal_clearance=0.1), "groove centres meet"),
        (lambda: bj.DeepGrooveBallBearing(0, 1, 0.1, **GROOVES), "at least 1"),
        (lambda: bj.DeepGrooveBallBearing(2.5, 1, 0.1, **GROOVES), "whole number"),
        (lambda: bj.DeepGrooveBallBearing(3, 0.1, 0.1, **GROOVES), "`ball_diameter`"),
        (lambda: bj.DeepGrooveBallBearing(40, 1, 0.1, **GROOVES), "overlap"),
        (lambda: bj.BearingSet(()), "`rows` is empty"),
        (lambda: bj.BearingSet((angular(),)), "it must hold SetRows"),
        (lambda: bj.SetRow(angular(), np.inf), "`position` is inf m"),
        (lambda: bj.BearingSet.tandem(angular(), -1.0), "`spacing` is -1 m"),
        (
            lambda: bj.BearingSet(
                (
                    bj.SetRow(angular()),
                    bj.SetRow(bj.CylindricalRollerBearing(9, 0.1, 0.01, 0.01)),
                )
            ),
            "mix balls and rollers",
        ),
        (
            lambda: bj.BearingSet.tandem(angular(), 0.005),
            "`position` of row 1 is 0.0025 m and of row 0 -0.0025 m; .* overlap",
        ),
        (lambda: bj.element.FrictionLimited(-0.1), "`friction` is -0.1"),
        (lambda: bj.contact.PointConstant(0.0, 1.0), "`outer` is 0"),
        (
            lambda: bj.BearingElement(deep(), line_law=bj.contact.Palmgren()),
            "`line_law` is for rollers",
        ),
    ],
)
def test_ball_bearings_reject_invalid_arguments(make, message):
    with pytest.raises((ValueError, TypeError), match=message):
        make()


BAD_CHOICES = {
    "text": ({"kinematics": "finite"}, r"`kinematics` is 'finite'.* Finite\(\)"),
    "class": ({"kinematics": bj.element.Finite}, r"`kinematics` is the class Finite; "),
    "law of rollers": ({"point_law": bj.contact.Palmgren()}, "`point_law` is Palmgren"),
    "control": (
        {"raceway_control": bj.element.InnerControl},
        "`raceway_control` is the class",
    ),
    "solver": ({"equilibrium": "bfgs"}, r"`equilibrium` is 'bfgs'.* or BFGS\(\)"),
    "yes": ({"cage_torque": "no"}, "`cage_torque` is 'no'; .*True or False"),
}


@pytest.mark.parametrize("choice, message", BAD_CHOICES.values(), ids=BAD_CHOICES)
def test_bearing_element_rejects_choices_of_wrong_type(untyped, choice, message):
    """Finite, or its name, for Finite() was taken for linearised kinematics."""
    with pytest.raises(TypeError, match="^BearingElement: " + message):
        bj.BearingElement(deep(), **choice)


BAD_SETS = {
    "spacing": (lambda s: s.back_to_back(angular(), "20 mm"), "`spacing` is '20 mm'"),
    "offset": (lambda s: s.face_to_face(angular(), 0.02, "1"), "`preload_offset` is"),
    "count": (lambda s: s.tandem(angular(), 0.02, 2.0), "`count` is 2.0"),
    "one row": (lambda s: s(bj.SetRow(angular())), "`rows` is a SetRow"),
}


@pytest.mark.parametrize("make, message", BAD_SETS.values(), ids=BAD_SETS)
def test_sets_of_wrong_types(untyped, make, message):
    with pytest.raises(TypeError, match="^BearingSet: " + message):
        make(bj.BearingSet)


@pytest.mark.parametrize("dtype", [jnp.float32, jnp.float16])
def test_numbers_of_less_precision_are_made_float64(dtype):
    """Among float64 they stopped the load solve with an error of its loop."""
    with jax.numpy_dtype_promotion("standard"):
        bearing = deep(first_azimuth=jnp.asarray(0.3, dtype))
        leaves = jax.tree.leaves(bj.BearingElement(bearing))
    assert {leaf.dtype for leaf in leaves} == {jnp.dtype("float64")}


def test_sets():
    pair = bj.BearingSet.back_to_back(angular(), 0.02, 8e-6)
    assert [r.mirrored for r in pair.rows] == [False, True]
    # Both rows are pressed: the inner ring moves along +z, and mirrored along -z.
    assert [float(r.inner_offset) for r in pair.rows] == pytest.approx([4e-6, -4e-6])
    assert len(bj.BearingSet.tandem(angular(), 0.02, 3).rows) == 3
    assert [r.bearing.n_elements for r in rows_of(pair)] == [12, 12]
    assert rows_of(angular())[0].bearing.n_balls == 12  # type: ignore[union-attr]


def test_ball_bearing_leaves_are_float64_arrays():
    leaves = jax.tree.leaves(four_point(outer_shoulder=2e-3))
    assert all(isinstance(leaf, jax.Array) for leaf in leaves)
    assert all(leaf.dtype == jnp.float64 for leaf in leaves)


def test_a_number_of_weak_type_does_not_compile_anew():
    """jnp.array(0.43) is one; under `jit` it would be another program."""
    bearing = bj.AngularContactBallBearing(
        7,
        0.05,
        0.009,
        contact_angle=jnp.array(0.43),
        outer_osculation=0.52,
        inner_osculation=0.52,
    )
    assert not bearing.contact_angle.weak_type


def test_rows_overlap_where_their_sections_do():
    """Balls as circles, rollers as the corners of their section, tapers slanted."""
    ball = float(angular().ball_diameter)
    for spacing, fits in ((0.999 * ball, False), (1.001 * ball, True)):
        assert (
            _makes(lambda s=spacing: bj.BearingSet.back_to_back(angular(), s)) is fits
        )
    roller = bj.CylindricalRollerBearing(9, 0.1, 0.01, 0.02)
    inside = bj.CylindricalRollerBearing(9, 0.07, 0.01, 0.02)
    for rows, fits in (
        ((bj.SetRow(roller), bj.SetRow(roller, 0.0199)), False),
        ((bj.SetRow(roller), bj.SetRow(roller, 0.0201)), True),
        ((bj.SetRow(roller), bj.SetRow(inside)), True),
    ):
        assert _makes(lambda rows=rows: bj.BearingSet(rows)) is fits
    # Slender cones in tandem pass where their axial lengths do not.
    steep = bj.TaperedRollerBearing(9, 0.2, 0.01, 0.03, roller_axis_angle=1.2)
    length = 0.03 * np.cos(1.2) + 0.01 * np.sin(1.2)
    for spacing, fits in ((0.55 * length, True), (0.5 * length, False)):
        assert _makes(lambda s=spacing: bj.BearingSet.tandem(steep, s)) is fits


def _makes(make):
    try:
        make()
    except ValueError as error:
        assert "overlap" in str(error)
        return False
    return True

"""Inner geometry from outer dimensions and ratings; bearings whose inside is known are
validation cases."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import DIFFERENCE

import bearingjax as bj
from bearingjax.catalogue import estimate
from bearingjax.numerics import as_real

_DEG = np.pi / 180


def inside(bearing):
    """Number, diameter and pitch diameter of the rolling elements."""
    row = bj.design.rows_of(bearing)[0].bearing
    kind = "ball" if bearing.is_ball else "roller"
    size = float(getattr(row, f"{kind}_diameter"))
    return row.n_elements, size, float(row.pitch_diameter)


@pytest.mark.parametrize("name, raised", [("6309", 1.05), ("NU 215", 1.15)])
def test_estimate_tells_raised_capacity(name, raised):
    """Of bearings of SKF's, and at the C of ISO 281 that theirs is raised from."""
    entry = bj.catalogue_entry(name)
    c, c0 = entry.dynamic_capacity, entry.static_capacity
    assert c is not None and c0 is not None
    for factor in (raised, 1.0):
        found = bj.catalogue.estimate_geometry(
            entry.bore,
            entry.outside_diameter,
            entry.width,
            entry.type,
            c * factor / raised,
            c0,
        )
        assert found.raised == factor
        rated = float(bj.dynamic_capacity(found.bearing)) * raised / c - 1
        assert rated == pytest.approx(found.dynamic_error, abs=1e-9)
        assert found.other_reading is not None
        assert found.other_reading[1] > found.misfit
        words = found.report()
        assert (f"raised by its maker to {raised:g} times" in words) == (factor > 1)
        other = "as it is" if factor > 1 else "as raised by its maker"
        assert f"with C {other}" in words


def designs():
    """Kind to d, D, B [m], its contact angle and a usual bearing of that size."""
    grooves = dict(outer_osculation=0.53, inner_osculation=0.52)
    row = bj.design.SelfAligningBallRow(
        12, 0.0385, 0.0072, inner_osculation=0.53, row_offset=0.0037
    )
    arcs = dict(roller_profile_radius=0.08, inner_raceway_radius=0.083)
    pitch, diameter, half = 0.060, 0.0099, 2.0 * _DEG
    axis = float(np.arcsin(np.tan(half) * pitch / diameter))
    return {
        "angular_contact_ball": (
            (0.04, 0.08, 0.018),
            40 * _DEG,
            bj.AngularContactBallBearing(
                14, 0.060, 0.0119, **grooves, contact_angle=40 * _DEG
            ),
        ),
        "four_point_ball": (
            (0.055, 0.1, 0.021),
            35 * _DEG,
            bj.FourPointBallBearing(
                15, 0.0775, 0.0142, **grooves, shim_angle=35 * _DEG
            ),
        ),
        "self_aligning_ball": (
            (0.025, 0.052, 0.015),
            None,
            bj.BearingSet.self_aligning(row),
        ),
        "thrust_ball": (
            (0.03, 0.052, 0.016),
            None,
            bj.ThrustBallBearing(
                14, 0.041, 0.0079, outer_osculation=0.54, inner_osculation=0.54
            ),
        ),
        "needle_roller": (
            (0.025, 0.042, 0.017),
            None,
            bj.NeedleRollerBearing(26, 0.0335, 0.0032, 0.0128),
        ),
        "tapered_roller": (
            (0.04, 0.08, 0.01975),
            axis + half,
            bj.TaperedRollerBearing(
                16, pitch, diameter, 0.0122, roller_axis_angle=axis,
                roller_half_angle=half,
                ribs=bj.Ribs(inner_minus=bj.Rib(0.1, 1e-3)),
            ),
        ),
        "spherical_roller": (
            (0.1, 0.18, 0.046),
            9.1 * _DEG,
            bj.BearingSet.self_aligning(
                bj.SphericalRollerRow(
                    18, 0.1412, 0.0216, 0.0168, **arcs, contact_angle=9.1 * _DEG
                )
            ),
        ),
        "toroidal_roller": (
            (0.26, 0.4, 0.104),
            None,
            bj.ToroidalRollerBearing(
                26, 0.335, 0.0357, 0.0781, roller_profile_radius=0.54,
                outer_raceway_radius=0.56, inner_raceway_radius=0.56,
            ),
        ),
        "spherical_thrust_roller": (
            (0.06, 0.13, 0.042),
            51.5 * _DEG,
            bj.SphericalThrustRollerBearing(
                14, 0.0975, 0.0190, 0.0235, **arcs, contact_angle=51.5 * _DEG
            ),
        ),
        "cylindrical_thrust_roller": (
            (0.06, 0.095, 0.026),
            None,
            bj.CylindricalThrustRollerBearing(18, 0.0775, 0.011, 0.0107),
        ),
        "crossed_roller": (
            (0.25, 0.31, 0.025),
            None,
            bj.BearingSet.crossed(bj.CrossedRollerRow(72, 0.2775, 0.0093, 0.0074)),
        ),
    }  # fmt: skip


@pytest.mark.parametrize("kind", list(designs()))
@pytest.mark.slow
def test_designs_are_found_from_their_own_ratings(kind):
    (d, big, b), angle, bearing = designs()[kind]
    c, c0 = float(bj.dynamic_capacity(bearing)), float(bj.static_capacity(bearing))
    found = bj.catalogue.estimate_geometry(d, big, b, kind, c, c0, contact_angle=angle)
    assert type(found.bearing) is type(bearing)
    assert not found.assumed_contact_angle or angle is None
    # What the estimate says of its ratings is what its bearing has.
    rated = float(bj.dynamic_capacity(found.bearing)) / c - 1
    assert rated == pytest.approx(found.dynamic_error, abs=1e-9)
    rated = float(bj.static_capacity(found.bearing)) / c0 - 1
    assert rated == pytest.approx(found.static_error, abs=1e-9)
    number, diameter, pitch = inside(found.bearing)
    wanted, size, circle = inside(bearing)
    assert abs(number - wanted) <= (1 if bearing.is_ball else 3)
    assert diameter == pytest.approx(size, rel=0.05)
    assert pitch == pytest.approx(circle, rel=0.03)
    assert "Estimate" in found.report()


def test_slopes_of_the_least_squares_are_those_of_differences():
    d, big, b, kind, c, c0 = GOOD
    numbers = dict(bore=d, outside_diameter=big, width=b)
    numbers |= dict(dynamic_capacity=c, static_capacity=c0)
    known = estimate._envelope(numbers, kind, estimate.PROPORTIONS[kind])
    rated = estimate._KINDS[kind]

    def evaluate(sizes):
        pair = estimate._with_slopes(rated, known, jnp.asarray(sizes), as_real(9))
        return jax.device_get(pair)

    start = estimate._start(known) + np.array([0.03, 0.01, 0.02, 0.0])
    slopes, _ = evaluate(start)
    for k in range(3):
        h = 1e-5 * np.eye(4)[k]
        difference = (evaluate(start + h)[1] - evaluate(start - h)[1]) / 2e-5
        assert np.allclose(slopes[:, k], difference, rtol=DIFFERENCE, atol=1e-5)


GOOD = (0.025, 0.052, 0.015, "deep_groove_ball", 14.0e3, 7.85e3)


@pytest.mark.parametrize(
    "changed, words",
    (
        ({0: 25.0, 1: 52.0, 2: 15.0}, r"`outside_diameter` is 52 m.*metres meant"),
        ({2: 15.0}, r"`width` is 15 m; it must be at most 10 m \(metres meant"),
        ({0: 3.0, 1: 10.0, 2: 4.0, 4: 633.0, 5: 217.0}, "size attain .*metres meant"),
        ({3: "magneto"}, "`kind` is 'magneto'; it must be one of deep_groove"),
        ({0: 0.06}, "`bore` is 0.06 m; it must be below the outside diameter, 0.052 m"),
        ({2: -0.01}, "`width` is -0.01 m"),
        ({4: 14.0}, "`dynamic_capacity` is 14 N; it must be between .* N and .* N"),
        ({5: 1e6}, "`static_capacity` is 1e.06 N; it must be between .* N and .* N"),
        ({4: 26e3}, "with a static capacity of 7850 N attain"),
    ),
)
def test_estimate_rejects_unattainable_arguments(changed, words):
    given = [changed.get(k, value) for k, value in enumerate(GOOD)]
    with pytest.raises(ValueError, match=words):
        bj.catalogue.estimate_geometry(*given)


def test_estimate_report_states_numbers():
    found = bj.catalogue.estimate_geometry(*GOOD)
    words = str(found)
    assert words == repr(found) == found.report()
    size, pitch = inside(found.bearing)[1:]
    assert words.startswith(
        f"Estimate: 9 balls of {1e3 * size:.4g} mm a row, pitch diameter"
        f" {1e3 * pitch:.5g} mm, contact angle 0°. C {100 * found.dynamic_error:+.1f} %"
    )


def test_estimate_rejects_traced_numbers(untyped):
    with pytest.raises(TypeError, match="`bore` is traced; numbers must be known"):
        jax.jit(lambda bore: bj.catalogue.estimate_geometry(bore, *GOOD[1:]).misfit)(
            GOOD[0]
        )


def test_only_some_types_have_a_contact_angle_to_choose():
    with pytest.raises(ValueError, match="`contact_angle` is given; a deep groove"):
        bj.catalogue.estimate_geometry(*GOOD, contact_angle=0.3)

"""Every registered design runs every identity: add a line, and it is tested."""

from typing import Any

import numpy as np

import bearingjax as bj

_RIB = bj.Rib(0.3, 1.5e-3)
_DEG = np.pi / 180
_SPEED = bj.Speed(inner=3000 * 2 * np.pi / 60)


def taper(n=6, **change):
    values = dict(
        roller_axis_angle=11 * _DEG,
        roller_half_angle=1.7235 * _DEG,
        roller_profile=bj.Logarithmic(),
        ribs=bj.Ribs(inner_minus=bj.Rib(0.09, 1.2e-3)),
    )
    return bj.TaperedRollerBearing(n, 0.052, 0.0082, 0.0115, **(values | change))


def bearings():
    """Name to bearing, small ones: 5 to 7 rollers."""
    cylinder = bj.CylindricalRollerBearing
    return {
        "cylindrical, crowned ends": cylinder(
            7, 0.0725, 0.014, 0.01372, roller_profile=bj.CrownedEnds(0.009, 1.0)
        ),
        "cylindrical NUP, logarithmic": cylinder(
            6,
            0.065,
            0.010,
            0.010,
            roller_profile=bj.Logarithmic(),
            ribs=bj.Ribs.arrangement("NUP", _RIB, 2e-6),
            radial_internal_clearance=10e-6,
        ),
        "needle, crowned, preloaded": bj.NeedleRollerBearing(
            7,
            0.03,
            0.003,
            0.012,
            roller_profile=bj.CircularCrown(4.0),
            inner_raceway_profile=bj.CircularCrown(8.0),
            radial_internal_clearance=-4e-6,
        ),
        "taper, large rib": taper(),
        "taper, half angle zero": taper(roller_half_angle=0.0, ribs=bj.Ribs()),
    }


def grooves(outer, inner) -> dict[str, Any]:
    """Osculations of both raceways of a ball bearing, as keywords."""
    return {"outer_osculation": outer, "inner_osculation": inner}


def balls(n=6, kind=bj.AngularContactBallBearing, **change):
    values = grooves(0.53, 0.52)
    if kind is bj.AngularContactBallBearing:
        values["contact_angle"] = 25 * _DEG
    return kind(n, 0.052, 0.0095, **(values | change))


def ball_elements():
    """Name to element of balls, a set, or coupled slices, and its speed."""
    element = bj.BearingElement
    angular = balls()
    deep = balls(7, bj.DeepGrooveBallBearing, radial_internal_clearance=10e-6)
    four = balls(
        6,
        bj.FourPointBallBearing,
        shim_angle=20 * _DEG,
        radial_internal_clearance=-3e-6,
        ball_deviation=[0.0, 2e-6, -1e-6, 0.0, 1e-6, 0.0],
        raceway_deviation=1e-6 * np.sin(np.arange(36.0)).reshape(6, 2, 3),
    )
    unlike = bj.BearingSet(
        (
            bj.SetRow(balls(7, contact_angle=15 * _DEG), -0.02, inner_offset=4e-6),
            bj.SetRow(angular, 0.02, mirrored=True, inner_offset=-30e-6),
        )
    )
    operating = bj.contact.OperatingAngle()
    tapers = bj.BearingSet.face_to_face(taper(5), 0.03, 30e-6)
    centrifugal, friction = (
        bj.element.CentrifugalOnly(),
        bj.element.FrictionLimited(0.06),
    )
    return {
        "deep groove, clearance": (element(deep), "still"),
        "angular contact, outer control": (element(angular), "turning"),
        "angular contact, operating angle": (
            element(angular, point_law=operating),
            "still",
        ),
        "four-point, unlike balls, load share": (
            element(four, raceway_control=bj.element.LoadShare()),
            "turning",
        ),
        "thrust": (element(balls(7, bj.ThrustBallBearing)), "still"),
        "ball pair, O": (
            element(
                bj.BearingSet.back_to_back(angular, 0.02, 20e-6),
                raceway_control=centrifugal,
            ),
            "turning",
        ),
        "set of unlike rows": (element(unlike, raceway_control=friction), "turning"),
        "taper pair, X": (
            element(tapers, quadrature=bj.numerics.ContactMapped(24)),
            "still",
        ),
        "taper, coupled slices": (
            element(taper(5), bj.contact.CoupledSlices(12)),
            "turning",
        ),
    }


def quadratures():
    return {
        "midpoint": bj.numerics.Midpoint(20),
        "contact_mapped": bj.numerics.ContactMapped(24),
    }


def speeds():
    return {"still": None, "turning": _SPEED}


def motion(seed=0, size=1.0):
    """Ring freedoms that load some rollers and leave others loose (12,)."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1, 1, 12) * np.tile(np.repeat([4e-6, 2e-4], 3), 2) * size
    q[7] -= 18e-6 * size
    # Axially outer against inner: closes tapers, and the ribs of an NUP.
    q[8] += 25e-6 * size
    q[[5, 11]] = 0.0
    return q


def holds(name, speed):
    """Whether the bearing can run so: without its rib a turning taper cannot."""
    return not (name == "taper, half angle zero" and speed == "turning")

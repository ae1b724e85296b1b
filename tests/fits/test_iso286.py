"""Limits of ISO 286, ISO 492 and ISO 5753-1 against second prints of them.

Shafts, housings and bearings: tables of fits of SKF and of Longxi Bearing. Clearances:
of deep groove ball bearings Yongchang, of cylindrical roller bearings AHR, of spherical
roller bearings NSK.
"""

from functools import partial
from itertools import zip_longest
from string import ascii_letters

import numpy as np
import pytest

from bearingjax.fits import (
    CLEARANCE_CLASSES,
    LIMIT_CLASSES,
    ball_clearance,
    bore_limits,
    fit_limits,
    limits,
    outside_limits,
    roller_clearance,
    spherical_roller_clearance,
    standard_tolerance,
    toroidal_roller_clearance,
)

MICRON = 1e-6
# First range of the bore [mm], and its ends between 10 and 24 mm.
CLEARANCES = {
    "_BALLS": (6, (18,)),
    "_CYLINDERS": (24, ()),
    "_SELF_ALIGNING": (6, (14, 18)),
    "_SELF_ALIGNING_TAPERED": (24, ()),
    "_SPHERICAL": (24, ()),
    "_SPHERICAL_TAPERED": (30, ()),
    "_TOROIDAL": (24, ()),
    "_TOROIDAL_TAPERED": (24, ()),
}
_SPHERICAL_K = partial(spherical_roller_clearance, tapered=True)

# Diameter in mm, lower and upper deviation in µm.
PUBLISHED = {
    "k5": [(3, 0, 4), (6, 1, 6), (18, 1, 9), (25, 2, 11), (50, 2, 13), (120, 3, 18)],
    "k6": [(18, 1, 12), (30, 2, 15), (180, 3, 28), (250, 4, 33), (500, 5, 45)],
    "m5": [(10, 6, 12), (30, 8, 17), (50, 9, 20), (80, 11, 24)],
    "m6": [(30, 8, 21), (50, 9, 25), (315, 20, 52), (400, 21, 57), (500, 23, 63)],
    "n5": [(6, 8, 13), (50, 17, 28), (120, 23, 38)],
    "n6": [(80, 20, 39), (120, 23, 45), (250, 31, 60), (280, 34, 66)],
    "p6": [(80, 32, 51), (100, 37, 59), (180, 43, 68), (250, 50, 79), (280, 56, 88)],
    "p7": [(80, 32, 62), (120, 37, 72), (250, 50, 96)],
    "r6": [(100, 51, 73), (120, 54, 76), (140, 63, 88), (225, 80, 109), (280, 94, 126)],
    "r7": [(160, 65, 105), (200, 77, 123), (280, 94, 146)],
    "j5": [(3, -2, 2), (10, -2, 4), (30, -4, 5), (80, -7, 6), (250, -13, 7)],
    "j6": [(3, -2, 4), (6, -2, 6), (30, -4, 9), (180, -11, 14), (250, -13, 16)],
    "h6": [(18, -11, 0), (120, -22, 0), (500, -40, 0)],
    "h9": [(6, -30, 0), (180, -100, 0)],
    "g5": [(3, -6, -2), (120, -27, -12), (180, -32, -14)],
    "g6": [(30, -20, -7), (500, -60, -20)],
    "f6": [(3, -12, -6), (180, -68, -43), (250, -79, -50)],
    "H7": [(10, 0, 15), (52, 0, 30), (150, 0, 40), (500, 0, 63)],
    "H8": [(18, 0, 27), (80, 0, 46), (250, 0, 72)],
    "J6": [(10, -4, 5), (30, -5, 8), (120, -6, 16), (250, -7, 22)],
    "J7": [(10, -7, 8), (80, -12, 18), (180, -14, 26), (250, -16, 30)],
    "JS7": [(30, -10.5, 10.5), (120, -17.5, 17.5)],
    "K5": [(10, -5, 1), (30, -8, 1), (120, -13, 2), (250, -18, 2)],
    "K6": [(18, -9, 2), (50, -13, 3), (250, -24, 5)],
    "K7": [(18, -12, 6), (50, -18, 7), (315, -36, 16), (400, -40, 17), (500, -45, 18)],
    "M5": [(10, -10, -4), (80, -19, -6), (180, -27, -9)],
    "M6": [(10, -12, -3), (120, -28, -6), (250, -37, -8)],
    "M7": [(18, -18, 0), (52, -30, 0), (500, -63, 0)],
    "N6": [(10, -16, -7), (50, -28, -12), (250, -51, -22), (315, -57, -25)],
    "N7": [(18, -23, -5), (80, -39, -9), (315, -66, -14), (500, -80, -17)],
    "P6": [(18, -26, -15), (120, -52, -30), (315, -79, -47)],
    "P7": [(10, -24, -9), (80, -51, -21), (315, -88, -36), (400, -98, -41)],
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_limits(name):
    for diameter, *published in PUBLISHED[name]:
        found = np.array(limits(name, 1e-3 * diameter)) / MICRON
        np.testing.assert_allclose(found, published, atol=1e-9)


def test_limits_exception_m6_above_250_mm():
    # The rule of the neighbouring ranges gives -11 to -43.
    np.testing.assert_allclose(limits("M6", 0.3), np.array([-41, -9]) * MICRON)


def test_limits_width_equals_standard_tolerance():
    for name in LIMIT_CLASSES:
        grade = int(name.lstrip(ascii_letters))
        for diameter in (0.003, 0.01, 0.07, 0.5):
            found = limits(name, diameter)
            width = standard_tolerance(grade, diameter)
            assert np.isclose(found.upper - found.lower, width, rtol=1e-12)


def test_limits_follow_the_diameter():
    """Both limits of a class go one way; steps back are of rounding and of the smallest
    diameters."""
    ends = np.array([1, 3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500])
    middles = 0.5e-3 * (ends[1:] + ends[:-1])
    for name in LIMIT_CLASSES:
        found = np.array([limits(name, d) for d in middles]) / MICRON
        steps = np.diff(found, axis=0)
        steps *= np.where(found[-1] < found[0], -1.0, 1.0)
        assert (steps > -2.1).all(), name


def test_limits_diameter_range_includes_upper_end():
    found = [limits("h5", diameter).lower / MICRON for diameter in (0.03, 0.0301)]
    np.testing.assert_allclose(found, [-9, -11])


def test_limits_reject_unknown_classes_and_grades():
    with pytest.raises(ValueError, match="`name` is 'q6'.*k4 to k7.*JS1 to JS11"):
        limits("q6", 0.05)
    for name in ("k9", "k", "K12", "5k", "h6 "):
        with pytest.raises(ValueError, match="it must be one of d1 to d11"):
            limits(name, 0.05)
    with pytest.raises(ValueError, match="`diameter` is 0.6 m.*0.5 m or less"):
        limits("H7", 0.6)
    with pytest.raises(ValueError, match="`diameter` is 0 m"):
        limits("H7", 0.0)
    for grade in (12, True):
        with pytest.raises(ValueError, match=f"`grade` is {grade!r}.*1 to 11"):
            standard_tolerance(grade, 0.05)


@pytest.mark.parametrize(
    "find, diameters, lower",
    [
        (
            bore_limits,
            (3, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500),
            (-8, -8, -8, -10, -12, -15, -20, -25, -30, -35, -40, -45),
        ),
        (
            outside_limits,
            (10, 18, 30, 50, 80, 120, 150, 180, 250, 315, 400, 500),
            (-8, -8, -9, -11, -13, -15, -18, -25, -30, -35, -40, -45),
        ),
    ],
)
def test_limits_of_bearings(find, diameters, lower):
    for diameter, published in zip(diameters, lower, strict=True):
        found = find(1e-3 * diameter)
        assert np.isclose(found.lower, published * MICRON, atol=0) and found.upper == 0


def test_bearing_limits_reject_sizes_out_of_range():
    with pytest.raises(ValueError, match="`outside_diameter` is 0.005 m.*above 0.006"):
        outside_limits(0.005)
    with pytest.raises(ValueError, match="`bore` is 0.51 m"):
        bore_limits(0.51)


@pytest.mark.parametrize(
    "find, bore, published",
    [
        (ball_clearance, 18, (0, 9, 3, 18, 11, 25, 18, 33, 25, 45)),
        (ball_clearance, 6, (0, 7, 2, 13, 8, 23)),
        (ball_clearance, 10, (0, 7, 2, 13, 8, 23, 14, 29, 20, 37)),
        (ball_clearance, 24, (0, 10, 5, 20, 13, 28, 20, 36, 28, 48)),
        (ball_clearance, 100, (1, 18, 12, 36, 30, 58, 53, 84, 75, 120)),
        (ball_clearance, 120, (2, 20, 15, 41, 36, 66, 61, 97, 90, 140)),
        (ball_clearance, 140, (2, 23, 18, 48, 41, 81, 71, 114, 105, 160)),
        (ball_clearance, 160, (2, 23, 18, 53, 46, 91, 81, 130, 120, 180)),
        (ball_clearance, 180, (2, 25, 20, 61, 53, 102, 91, 147, 135, 200)),
        (ball_clearance, 200, (2, 30, 25, 71, 63, 117, 107, 163, 150, 230)),
        (ball_clearance, 25, (1, 11, 5, 20, 13, 28, 23, 41, 30, 53)),
        (ball_clearance, 40, (1, 11, 6, 20, 15, 33, 28, 46, 40, 64)),
        (ball_clearance, 50, (1, 11, 6, 23, 18, 36, 30, 51, 45, 73)),
        (ball_clearance, 65, (1, 15, 8, 28, 23, 43, 38, 61, 55, 90)),
        (ball_clearance, 80, (1, 15, 10, 30, 25, 51, 46, 71, 65, 105)),
        (roller_clearance, 24, (0, 25, 20, 45, 35, 60, 50, 75)),
        (roller_clearance, 40, (5, 30, 25, 50, 45, 70, 60, 85)),
        (roller_clearance, 65, (10, 40, 40, 70, 60, 90, 80, 110)),
        (roller_clearance, 120, (15, 55, 50, 90, 85, 125, 125, 165)),
        (roller_clearance, 315, (55, 130, 130, 205, 200, 275, 275, 350)),
        (roller_clearance, 500, (110, 220, 220, 330, 330, 440, 440, 550)),
        (spherical_roller_clearance, 30, (15, 25, 25, 40, 40, 55, 55, 75, 75, 95)),
        (spherical_roller_clearance, 50, (20, 35, 35, 55, 55, 75, 75, 100, 100, 125)),
        (spherical_roller_clearance, 100, (35, 60, 60, 100, 100, 135, 135, 180)),
        (spherical_roller_clearance, 200, (70, 130, 130, 200, 200, 260, 260, 340)),
        (spherical_roller_clearance, 400, (130, 220, 220, 340, 340, 450, 450, 600)),
        (_SPHERICAL_K, 40, (25, 35, 35, 50, 50, 65, 65, 85, 85, 105)),
        (_SPHERICAL_K, 100, (55, 80, 80, 110, 110, 140, 140, 180, 180, 230)),
        (_SPHERICAL_K, 225, (120, 180, 180, 250, 250, 320, 320, 410, 410, 520)),
        (_SPHERICAL_K, 500, (260, 370, 370, 490, 490, 630, 630, 790, 790, 1000)),
    ],
)
def test_clearances(find, bore, published):
    names = CLEARANCE_CLASSES[: len(published) // 2]
    found = np.ravel([find(name, 1e-3 * bore) for name in names])
    np.testing.assert_allclose(found, np.array(published) * MICRON)


def test_diameters_at_an_end_in_single_precision():
    """50 mm is 0.0500000007 m there, and not above 50 mm."""
    for bore in (10, 18, 30, 50, 65, 80, 120):
        single, double = np.float32(1e-3 * bore), 1e-3 * bore
        assert limits("k5", single) == limits("k5", double)
        assert bore_limits(single) == bore_limits(double)
        assert ball_clearance("CN", single) == ball_clearance("CN", double)


@pytest.mark.parametrize(
    "find, least",
    [
        (ball_clearance, 0.007),
        (roller_clearance, 0.007),
        (spherical_roller_clearance, 0.019),
        (_SPHERICAL_K, 0.025),
        (toroidal_roller_clearance, 0.019),
        (partial(toroidal_roller_clearance, tapered=True), 0.019),
    ],
)
def test_classes_follow_each_other(find, least):
    for bore in np.linspace(least, 0.5, 90):
        rows = np.array([find(name, bore) for name in CLEARANCE_CLASSES])
        assert (np.diff(rows, axis=0) > 0).all() and (np.diff(rows) > 0).all()


@pytest.mark.parametrize("name", CLEARANCES)
def test_clearances_stand_at_the_bores_of_iso_5753_1(name):
    """Ranges of the bore [mm]; the limits of each class grow with it."""
    first, more = CLEARANCES[name]
    ends = (24, 30, 40, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315)
    ends = (6, 10, *more, *ends, 355, 400, 450, 500)
    table = vars(fit_limits)[name]
    assert tuple(table) == ends[ends.index(first) :][: len(table)]
    for limit in zip_longest(*table.values()):
        known = [x for x in limit if x is not None]
        assert known == sorted(known)
    if "SPHERICAL" in name or "TOROIDAL" in name:
        # Where a class ends the next one begins.
        for limits in table.values():
            assert limits[1:-1:2] == limits[2::2]


def test_clearance_classes_reject_unknown_names_and_bores():
    with pytest.raises(ValueError, match="`name` is 'C6'.*C2, CN, C3, C4, C5"):
        ball_clearance("C6", 0.025)
    with pytest.raises(ValueError, match="`name` is 'C4'.*C2, CN, C3 for a bore of"):
        ball_clearance("C4", 0.005)
    with pytest.raises(ValueError, match="`bore` is 0.002 m.*above 0.0025 m"):
        ball_clearance("CN", 0.002)
    with pytest.raises(ValueError, match="`bore` is 0.6 m"):
        roller_clearance("CN", 0.6)
    with pytest.raises(ValueError, match="`bore` is 0.02 m.*above 0.024 m"):
        _SPHERICAL_K("CN", 0.02)


def test_classes_of_a_cylindrical_roller_bearing_are_equally_wide():
    for bore, ends in fit_limits._CYLINDERS.items():
        assert len(set(np.subtract(ends[1::2], ends[::2]))) == 1, bore

"""Limits of ISO 286, ISO 492 and ISO 5753-1: classes, ranges, order.

Second prints of their tables are validation cases.
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
    "ball": (6, (18,)),
    "cylindrical_roller": (24, ()),
    "self_aligning_ball": (6, (14, 18)),
    "self_aligning_ball_tapered": (24, ()),
    "spherical_roller": (24, ()),
    "spherical_roller_tapered": (30, ()),
    "toroidal_roller": (24, ()),
    "toroidal_roller_tapered": (24, ()),
}
_SPHERICAL_K = partial(spherical_roller_clearance, tapered=True)


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


def test_bearing_limits_reject_sizes_out_of_range():
    with pytest.raises(ValueError, match="`outside_diameter` is 0.005 m.*above 0.006"):
        outside_limits(0.005)
    with pytest.raises(ValueError, match="`bore` is 0.51 m"):
        bore_limits(0.51)


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
    table = fit_limits.CLEARANCES[name]["up_to"]
    assert tuple(map(int, table)) == ends[ends.index(first) :][: len(table)]
    for limit in zip_longest(*table.values()):
        known = [x for x in limit if x is not None]
        assert known == sorted(known)
    if name.startswith(("spherical", "toroidal")):
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
    for bore, ends in fit_limits.CLEARANCES["cylindrical_roller"]["up_to"].items():
        assert len(set(np.subtract(ends[1::2], ends[::2]))) == 1, bore

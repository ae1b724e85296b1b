"""Grades of balls and rollers, classes of rings: numbers of the standards.

Checked against a second print where there is one: grades of balls by the rules that
all of them follow, runouts of class P5 in catalogues of NODES, of P2 in those of Loyal,
of class normal in those of WD.
"""

import numpy as np
import pytest

from bearingjax.design import (
    BALL_GRADES,
    ROLLER_GRADES,
    TOLERANCE_CLASSES,
    ball_grade,
    roller_grade,
    running_accuracy,
)

MICRON = 1e-6


def test_grades_of_balls():
    assert BALL_GRADES[:3] == ("G3", "G5", "G10") and len(BALL_GRADES) == 11
    rows = np.array([ball_grade(name) for name in BALL_GRADES]) / MICRON
    assert (np.diff(rows, axis=0) > 0).all()
    # A grade is called after its form in millionths of an inch, and a lot has twice
    # that, both rounded.
    number = np.array([float(name[1:]) for name in BALL_GRADES])
    np.testing.assert_allclose(rows[:, 1], 0.0254 * number, rtol=0.06)
    np.testing.assert_array_equal(rows[:, 0], rows[:, 1])
    np.testing.assert_allclose(rows[:, 3], 2 * rows[:, 1], rtol=0.19)


def test_grades_of_rollers():
    found = roller_grade("II", 0.010)
    assert np.isclose(found.form, 0.8 * MICRON) and np.isclose(found.taper, 0.5e-6)
    rows = np.array([roller_grade(name, 0.018) for name in ROLLER_GRADES])
    assert (np.diff(rows, axis=0) >= 0).all()
    with pytest.raises(ValueError, match="`diameter` is 0.02 m.*0.018 m or less"):
        roller_grade("II", 0.02)
    with pytest.raises(ValueError, match="`diameter` is -1 m"):
        roller_grade("II", -1.0)


@pytest.mark.parametrize(
    "name, bores, runouts",
    [
        (
            "P0",
            (2.5, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630),
            (10, 10, 10, 13, 15, 20, 25, 30, 40, 50, 60, 65, 70),
        ),
        (
            "P5",
            (2.5, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400),
            (4, 4, 4, 4, 5, 5, 6, 8, 10, 13, 15),
        ),
        (
            "P2",
            (10, 18, 30, 50, 80, 120, 150, 180),
            (1.5, 1.5, 2.5, 2.5, 2.5, 2.5, 2.5, 5),
        ),
    ],
)
def test_runout_of_inner_rings(name, bores, runouts):
    for bore, runout in zip(bores, runouts, strict=True):
        found = running_accuracy(name, 1e-3 * bore, 0.1)
        assert np.isclose(found.inner, runout * MICRON)


@pytest.mark.parametrize(
    "name, outsides, runouts",
    [
        (
            "P5",
            (18, 30, 50, 80, 120, 150, 180, 250, 315, 400, 500, 630),
            (5, 6, 7, 8, 10, 11, 13, 15, 18, 20, 23, 25),
        ),
        ("P2", (30, 50, 80, 120, 150, 180, 250), (2.5, 2.5, 4, 5, 5, 5, 7)),
    ],
)
def test_runout_of_outer_rings(name, outsides, runouts):
    for outside, runout in zip(outsides, runouts, strict=True):
        found = running_accuracy(name, 0.01, 1e-3 * outside)
        assert np.isclose(found.outer, runout * MICRON)


def test_better_classes_run_truer():
    for bore, outside in ((0.008, 0.022), (0.055, 0.1), (0.12, 0.15), (0.25, 0.4)):
        rows = [running_accuracy(name, bore, outside) for name in TOLERANCE_CLASSES]
        assert (np.diff(np.array(rows), axis=0) < 0).all()


def test_running_accuracy_bore_range_includes_upper_end():
    inner = [running_accuracy("P6", bore, 0.1).inner for bore in (0.03, 0.0301)]
    np.testing.assert_allclose(inner, [8e-6, 10e-6])


def test_tolerances_reject_unknown_grades_and_classes():
    with pytest.raises(ValueError, match="`name` is 'G7'.*G3, G5, G10"):
        ball_grade("G7")
    with pytest.raises(ValueError, match="`name` is 'V'.*I, II, IIA"):
        roller_grade("V", 0.01)
    with pytest.raises(ValueError, match="`name` is 'P7'.*P0, P6"):
        running_accuracy("P7", 0.05, 0.1)
    with pytest.raises(ValueError, match="`bore` is 0.3 m.*0.25 m or less.*P4"):
        running_accuracy("P4", 0.3, 0.4)
    with pytest.raises(ValueError, match="`outside_diameter` is 0 m"):
        running_accuracy("P4", 0.2, 0.0)

"""Published tolerances of form: grades of balls and rollers, classes of rings.

They bound what a maker may deliver; parts are often much better. Limits of waviness, by
order, are not in these standards: makers agree them with their customers.
"""

from typing import Annotated, Any, NamedTuple

from ..numerics.units import unit
from .abstract import AbstractBearing
from .checks import one_of, positive

_MICRON = 1e-6


class BallGrade(NamedTuple):
    """Largest deviations of balls of a grade.

    Attributes:
        diameter_variation: Largest less smallest diameter of a ball, V_Dws [m].
        form: Deviation from spherical form: between the least sphere around a ball and
            the largest one within, as distance of their surfaces, t_Dw [m].
        roughness: Arithmetical mean deviation, Ra [m].
        lot_variation: Largest less smallest mean diameter of the balls of a lot,
            V_DwL [m].
    """

    diameter_variation: Annotated[float, unit("m")]
    form: Annotated[float, unit("m")]
    roughness: Annotated[float, unit("m")]
    lot_variation: Annotated[float, unit("m")]


# V_Dws, t_Dw, Ra, V_DwL in µm.
_BALLS = {
    "G3": (0.08, 0.08, 0.010, 0.13),
    "G5": (0.13, 0.13, 0.014, 0.25),
    "G10": (0.25, 0.25, 0.020, 0.5),
    "G16": (0.4, 0.4, 0.025, 0.8),
    "G20": (0.5, 0.5, 0.032, 1.0),
    "G24": (0.6, 0.6, 0.040, 1.2),
    "G28": (0.7, 0.7, 0.050, 1.4),
    "G40": (1.0, 1.0, 0.060, 2.0),
    "G60": (1.5, 1.5, 0.080, 3.0),
    "G100": (2.5, 2.5, 0.100, 5.0),
    "G200": (5.0, 5.0, 0.150, 10.0),
}

BALL_GRADES = tuple(_BALLS)
"""Names of the grades of balls, the best one first."""


def ball_grade(name: str) -> BallGrade:
    """Tolerances of a grade of steel balls.

    Args:
        name: One of `BALL_GRADES`, such as "G10".

    Raises:
        ValueError: If there is no such grade.

    Source: ISO 3290-1 (2014), as makers of balls print it (RGP; Marteau & Lemarié print
        the same of ISO 3290 (2001)). GOST 3722 (2014) and ANSI/ABMA 10 allow coarser
        surfaces.
    """
    return BallGrade(*_scale(_named_row("ball_grade", "name", name, _BALLS)))


class RollerGrade(NamedTuple):
    """Largest deviations of cylindrical rollers of a grade.

    Attributes:
        diameter_variation: Largest less smallest diameter in the middle plane of a
            roller, V_Dwsp [m].
        form: Deviation from circular form there, as distance from the circle around it,
            Δ_Rw [m]. Lobes of odd number have it without a variation of diameter.
        roughness: Arithmetical mean deviation of the cylinder, Ra [m].
        lot_variation: Largest less smallest mean diameter of the rollers of a lot,
            V_DwL [m].
        taper: Difference of the mean diameters at both ends of a roller, V_Dwmp [m].
    """

    diameter_variation: Annotated[float, unit("m")]
    form: Annotated[float, unit("m")]
    roughness: Annotated[float, unit("m")]
    lot_variation: Annotated[float, unit("m")]
    taper: Annotated[float, unit("m")]


# V_Dwsp, Δ_Rw, Ra, V_DwL, V_Dwmp in µm, of rollers up to 18 mm.
_ROLLERS = {
    "I": (0.25, 0.5, 0.08, 0.5, 0.3),
    "II": (0.5, 0.8, 0.16, 1.0, 0.5),
    "IIA": (0.5, 1.0, 0.16, 1.0, 0.5),
    "III": (1.0, 1.3, 0.20, 2.0, 1.0),
    "IIIA": (1.0, 1.5, 0.32, 2.0, 1.0),
    "IV": (2.0, 2.5, 0.32, 3.0, 2.0),
}

ROLLER_GRADES = tuple(_ROLLERS)
ELEMENT_GRADES = {"ball": BALL_GRADES, "roller": ROLLER_GRADES}
"""Grades of the rolling elements by their noun."""
"""Names of the grades of cylindrical rollers, the best one first."""

LARGEST_ROLLER = 0.018
"""Largest diameter of rollers that `roller_grade` knows [m]."""


def roller_grade(name: str, diameter: Any) -> RollerGrade:
    """Tolerances of a grade of steel cylindrical rollers.

    Args:
        name: One of `ROLLER_GRADES`, such as "II".
        diameter: Roller diameter, up to `LARGEST_ROLLER` [m]: the standard goes on, but
            the copy used for these numbers cannot be read there with certainty.

    Raises:
        ValueError: If there is no such grade, or for larger rollers.

    Source: GOST 22696 (2013), tables 2 and 4, which follows ISO 12297 (2012) but has
        grades of its own. The grades of ISO 12297 itself were not found in print.
        Roughness is that in bearings; of grade IV, which is not for bearings, that of
        loose rollers.
    """
    found = _named_row("roller_grade", "name", name, _ROLLERS)
    positive("roller_grade", "diameter", diameter, "m")
    if float(diameter) > LARGEST_ROLLER * (1.0 + _SAME):
        raise ValueError(
            f"roller_grade: `diameter` is {float(diameter):g} m; it must be"
            f" {LARGEST_ROLLER:g} m or less, for which tolerances are known."
        )
    return RollerGrade(*_scale(found))


def element_grade(name: str, bearing: AbstractBearing) -> BallGrade | RollerGrade:
    """Deviations allowed of the rolling elements of a bearing.

    Args:
        name: One of `ELEMENT_GRADES` of its rolling elements.
        bearing: A single row.

    Raises:
        ValueError: As `ball_grade` and `roller_grade`.
    """
    if bearing.is_ball:
        return ball_grade(name)
    return roller_grade(name, bearing.element_diameter)


class RunningAccuracy(NamedTuple):
    """Largest radial runout of the rings of an assembled bearing.

    It is the whole reading over a turn, of the ring's seat against its raceway: twice
    the eccentricity, with what waves of low order add.

    Attributes:
        inner: Radial runout of the inner ring, K_ia [m].
        outer: Radial runout of the outer ring, K_ea [m].
    """

    inner: Annotated[float, unit("m")]
    outer: Annotated[float, unit("m")]


# Largest diameter of each range in mm, itself included, and runout in µm up to there.
_BORES = (2.5, 10, 18, 30, 50, 80, 120, 150, 180, 250, 315, 400, 500, 630)
_OUTSIDES = (18, 30, 50, 80, 120, 150, 180, 250, 315, 400, 500, 630, 800, 1000)
_RUNOUTS = {
    "P0": (
        (10, 10, 10, 13, 15, 20, 25, 30, 30, 40, 50, 60, 65, 70),
        (15, 15, 20, 25, 35, 40, 45, 50, 60, 70, 80, 100, 120, 140),
    ),
    "P6": (
        (5, 6, 7, 8, 10, 10, 13, 18, 18, 20, 25, 30, 35, 40),
        (8, 9, 10, 13, 18, 20, 23, 25, 30, 35, 40, 50, 60, 75),
    ),
    "P5": (
        (4, 4, 4, 4, 5, 5, 6, 8, 8, 10, 13, 15),
        (5, 6, 7, 8, 10, 11, 13, 15, 18, 20, 23, 25, 30),
    ),
    "P4": (
        (2.5, 2.5, 2.5, 3, 4, 4, 5, 6, 6, 8),
        (3, 4, 5, 5, 6, 7, 8, 10, 11, 13),
    ),
    "P2": (
        (1.5, 1.5, 1.5, 2.5, 2.5, 2.5, 2.5, 2.5, 5, 5),
        (1.5, 2.5, 2.5, 4, 5, 5, 5, 7, 7, 8),
    ),
}

TOLERANCE_CLASSES = tuple(_RUNOUTS)
"""Names of the tolerance classes of rings, the widest first: P0 is the normal class."""


def running_accuracy(name: str, bore: Any, outside_diameter: Any) -> RunningAccuracy:
    """Largest radial runout of radial bearings, other than tapered roller bearings.

    Args:
        name: One of `TOLERANCE_CLASSES`, such as "P5".
        bore: Bore diameter of the inner ring, d [m].
        outside_diameter: Outside diameter of the outer ring, D [m].

    Raises:
        ValueError: If there is no such class, or it has no tolerance for so large a
            bearing.

    Source: ISO 492 (2014), tables of normal class and classes 6, 5, 4 and 2, as GOST
        520 (2011), tables 1 to 8, 11 and 12, and catalogues print them.
    """
    inner, outer = _named_row("running_accuracy", "name", name, _RUNOUTS)
    return RunningAccuracy(
        _of_range(name, "bore", bore, _BORES, inner),
        _of_range(name, "outside_diameter", outside_diameter, _OUTSIDES, outer),
    )


_SAME = 1e-9
"""Share by which a diameter may exceed a range: 0.03 m is 30 mm."""


def _of_range(name, what, diameter, ends, values):
    positive("running_accuracy", what, diameter, "m")
    for end, value in zip(ends, values, strict=False):
        if float(diameter) <= 1e-3 * end * (1.0 + _SAME):
            return value * _MICRON
    raise ValueError(
        f"running_accuracy: `{what}` is {float(diameter):g} m; it must be"
        f" {1e-3 * ends[len(values) - 1]:g} m or less, up to which class {name} is"
        " known."
    )


def _named_row(owner, what, name, table):
    """Row of a table, or an error that names all rows."""
    one_of(owner, what, name, table)
    return table[name]


def _scale(values):
    return [value * _MICRON for value in values]

"""Limits of shaft and housing diameters: tolerance classes of ISO 286 by name."""

import re
from typing import Annotated, Any, NamedTuple

from ..design.checks import must_be, positive
from ..numerics.units import unit

_MICRON = 1e-6
_SAME = 1e-6
"""Share by which a diameter may exceed a range: 0.03 m is 30 mm, in single precision
too."""


class Limits(NamedTuple):
    """Limits of a length, or of its deviation from the nominal one.

    Attributes:
        lower: Smallest value [m].
        upper: Largest value [m].
    """

    lower: Annotated[Any, unit("m")]
    upper: Annotated[Any, unit("m")]


# Largest nominal size of each range in mm, itself included.
_SIZES = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
_FINE_SIZES = (3, 6, 10, 18, 30, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250)
_FINE_SIZES += (280, 315, 355, 400, 450, 500)

# Standard tolerance of grades 1 to 11 in µm, one row a grade.
_GRADES = (
    (0.8, 1, 1, 1.2, 1.5, 1.5, 2, 2.5, 3.5, 4.5, 6, 7, 8),
    (1.2, 1.5, 1.5, 2, 2.5, 2.5, 3, 4, 5, 7, 8, 9, 10),
    (2, 2.5, 2.5, 3, 4, 4, 5, 6, 8, 10, 12, 13, 15),
    (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
)

# Distance of the zone from the nominal size in µm: of d to h below it, of k to s above.
_BELOW = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * len(_SIZES),
}
_ABOVE = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
_FINE_ABOVE = {
    "r": (10, 15, 19, 23, 28, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98)
    + (108, 114, 126, 132),
    "s": (14, 19, 23, 28, 35, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158)
    + (170, 190, 208, 232, 252),
}

# Lower deviation of shafts j, upper deviation of housings J, by grade, in µm.
_SHAFT_J = {
    5: (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    6: (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    7: (-4, -4, -5, -6, -8, -10, -12, -15, -18, -21, -26, -28, -32),
}
_HOUSING_J = {
    6: (2, 5, 5, 6, 8, 10, 13, 16, 18, 22, 25, 29, 33),
    7: (4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43),
    8: (6, 10, 12, 15, 20, 24, 28, 34, 41, 47, 55, 60, 66),
}

# First and last grade that is known of each letter.
_LETTERS = {
    **{letter: (1, 11) for letter in (*_BELOW, "js")},
    "j": (5, 7),
    "k": (4, 7),
    **{letter: (3, 11) for letter in ("m", "n", "p", "r", "s")},
    **{letter.upper(): (1, 11) for letter in (*_BELOW, "js")},
    "J": (6, 8),
    "K": (3, 8),
    "M": (3, 8),
    "N": (3, 8),
    **{letter: (3, 11) for letter in ("P", "R", "S")},
}

LIMIT_CLASSES = tuple(
    f"{letter}{grade}"
    for letter, (first, last) in _LETTERS.items()
    for grade in range(first, last + 1)
)
"""Names of the tolerance classes: small letters are shafts, capital ones housings."""


def limit_classes(small: bool) -> str:
    """Tolerance classes in words, "k4 to k7": of shafts (small letters) or housings."""
    return ", ".join(
        f"{letter}{first} to {letter}{last}"
        for letter, (first, last) in _LETTERS.items()
        if letter.islower() is small
    )


def standard_tolerance(grade: int, diameter: Any) -> float:
    """Width of a tolerance zone [m].

    Args:
        grade: Standard tolerance grade, 5 of IT5; 1 to 11.
        diameter: Nominal diameter, up to 0.5 m [m].

    Raises:
        ValueError: If there is no such grade, or for other diameters.

    Source: as in `limits`.
    """
    allowed = f"a whole number from 1 to {len(_GRADES)}"
    whole = isinstance(grade, int) and not isinstance(grade, bool)
    known = whole and grade in range(1, len(_GRADES) + 1)
    must_be("standard_tolerance", "grade", grade, known, allowed)
    size = size_range("standard_tolerance", "diameter", diameter, _SIZES)
    return _GRADES[grade - 1][size] * _MICRON


def limits(name: str, diameter: Any) -> Limits:
    """Limits of the deviation of a shaft or housing from its nominal diameter.

    Args:
        name: Tolerance class, one of `LIMIT_CLASSES`: "k5" of a shaft, "H7" of a
            housing.
        diameter: Nominal diameter, up to 0.5 m [m].

    Raises:
        ValueError: If there is no such class, or for other diameters.

    Source: ISO 286-1 (2010), tables 1 to 5, from a published program of them (Waldek,
        isoFits); 1380 limits between 3 and 400 mm of a second program (isofits of the
        Python Package Index) are the same, but for six misprints there.
    """
    letter, grade = _split_class(name)
    size = size_range("limits", "diameter", diameter, _SIZES)
    fine = size_range("limits", "diameter", diameter, _FINE_SIZES)
    width = _GRADES[grade - 1][size]
    if letter.islower():
        lower = _shaft(letter, grade, size, fine, width)
        ends = lower, lower + width
    else:
        upper = _housing(letter, grade, size, fine, width)
        ends = upper - width, upper
    return Limits(*(end * _MICRON for end in ends))


def _shaft(letter, grade, size, fine, width):
    """Lower deviation of a shaft [µm]."""
    if letter in _BELOW:
        return -_BELOW[letter][size] - width
    if letter == "js":
        return -width / 2
    if letter == "j":
        return _SHAFT_J[grade][size]
    return _deviation_above(letter, size, fine)


def _housing(letter, grade, size, fine, width):
    """Upper deviation of a housing [µm]."""
    shaft = letter.lower()
    if shaft in _BELOW:
        return _BELOW[shaft][size] + width
    if shaft == "js":
        return width / 2
    if shaft == "j":
        return _HOUSING_J[grade][size]
    if letter == "M" and grade == 6 and 250 < _SIZES[size] <= 315:
        return -9  # not -11, which the rule below gives: an exception of the standard
    # Fits of fine housings are as tight as those of shafts that are one grade finer:
    # they gain the difference of both tolerances.
    last = 8 if shaft in ("k", "m", "n") else 7
    gains = _SIZES[size] > 3 and grade <= last
    gain = width - _GRADES[grade - 2][size] if gains else 0
    return -_deviation_above(shaft, size, fine) + gain


def _deviation_above(letter, size, fine):
    if letter in _FINE_ABOVE:
        return _FINE_ABOVE[letter][fine]
    return _ABOVE[letter][size]


def _split_class(name):
    """Letter and grade of a class, or an error that names all classes."""
    found = re.fullmatch(r"([A-Za-z]+)(\d+)", str(name))
    if name not in LIMIT_CLASSES or found is None:
        known = f"{limit_classes(True)}, {limit_classes(False)}"
        raise ValueError(f"limits: `name` is {name!r}; it must be one of {known}.")
    return found[1], int(found[2])


def size_range(
    owner: str, what: str, diameter: Any, ends: tuple, least: float = 0.0
) -> int:
    """Number of the range that a nominal diameter falls into.

    Args:
        owner: Function that was called.
        what: Its parameter.
        diameter: Nominal diameter [m].
        ends: Largest diameter of each range, itself included [mm].
        least: Diameter above which the first range begins [mm].

    Raises:
        ValueError: If it falls into none.
    """
    positive(owner, what, diameter, "m")
    value = float(diameter)
    if 1e-3 * least * (1.0 + _SAME) < value:
        for number, end in enumerate(ends):
            if value <= 1e-3 * end * (1.0 + _SAME):
                return number
    raise ValueError(
        f"{owner}: `{what}` is {value:g} m; it must be above {1e-3 * least:g} m and"
        f" {1e-3 * ends[-1]:g} m or less."
    )

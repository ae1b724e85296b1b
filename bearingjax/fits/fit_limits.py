"""Limits of the bore, outside diameter and internal clearance of bearings."""

from typing import Any

from .iso286 import Limits, size_range

_MICRON = 1e-6

# Largest diameter of each range in mm, itself included, and lower deviation in µm.
_BORES = (18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
_BORE_LOWER = (-8, -10, -12, -15, -20, -25, -30, -35, -40, -45)
_OUTSIDES = (18, 30, 50, 80, 120, 150, 180, 250, 315, 400, 500)
_OUTSIDE_LOWER = (-8, -9, -11, -13, -15, -18, -25, -30, -35, -40, -45)


def bore_limits(bore: Any) -> Limits:
    """Deviation of the mean bore of radial bearings of normal class, Δ_dmp [m].

    Not of tapered roller bearings.

    Args:
        bore: Nominal bore diameter, up to 0.5 m [m].

    Raises:
        ValueError: For other bores.

    Source: ISO 492 (2014), normal class, as catalogues print it (SKF, WD).
    """
    return _below("bore_limits", "bore", bore, _BORES, _BORE_LOWER)


def outside_limits(outside_diameter: Any) -> Limits:
    """Deviation of the mean outside diameter, bearings of `bore_limits`, Δ_Dmp [m].

    Args:
        outside_diameter: Nominal outside diameter, above 6 mm up to 0.5 m [m].

    Raises:
        ValueError: For other diameters.

    Source: as in `bore_limits`.
    """
    return _below(
        "outside_limits",
        "outside_diameter",
        outside_diameter,
        _OUTSIDES,
        _OUTSIDE_LOWER,
        6,
    )


def _below(owner, what, diameter, ends, lower, least=0):
    return Limits(lower[size_range(owner, what, diameter, ends, least)] * _MICRON, 0.0)


CLEARANCE_CLASSES = ("C2", "CN", "C3", "C4", "C5")
"""Names of the classes of radial internal clearance, the smallest first."""

MOTOR_CLASS = "CM"
"""Class of deep groove ball bearings of motors, narrower than CN."""

CLEARANCE_PARTS = ("", "H", "L", "M", "P")
"""Letters after a class: upper half of its range, lower half, middle half, and upper
half with the lower half of the next class.

Source: designations of SKF.
"""

# Of each bore up to (mm), least and largest clearance of the classes in µm.
_BALLS = {
    6: (0, 7, 2, 13, 8, 23),
    10: (0, 7, 2, 13, 8, 23, 14, 29, 20, 37),
    18: (0, 9, 3, 18, 11, 25, 18, 33, 25, 45),
    24: (0, 10, 5, 20, 13, 28, 20, 36, 28, 48),
    30: (1, 11, 5, 20, 13, 28, 23, 41, 30, 53),
    40: (1, 11, 6, 20, 15, 33, 28, 46, 40, 64),
    50: (1, 11, 6, 23, 18, 36, 30, 51, 45, 73),
    65: (1, 15, 8, 28, 23, 43, 38, 61, 55, 90),
    80: (1, 15, 10, 30, 25, 51, 46, 71, 65, 105),
    100: (1, 18, 12, 36, 30, 58, 53, 84, 75, 120),
    120: (2, 20, 15, 41, 36, 66, 61, 97, 90, 140),
    140: (2, 23, 18, 48, 41, 81, 71, 114, 105, 160),
    160: (2, 23, 18, 53, 46, 91, 81, 130, 120, 180),
    180: (2, 25, 20, 61, 53, 102, 91, 147, 135, 200),
    200: (2, 30, 25, 71, 63, 117, 107, 163, 150, 230),
    225: (2, 35, 25, 85, 75, 140, 125, 195, 175, 265),
    250: (2, 40, 30, 95, 85, 160, 145, 225, 205, 300),
    280: (2, 45, 35, 105, 90, 170, 155, 245, 225, 340),
    315: (2, 55, 40, 115, 100, 190, 175, 270, 245, 370),
    355: (3, 60, 45, 125, 110, 210, 195, 300, 275, 410),
    400: (3, 70, 55, 145, 130, 240, 225, 340, 315, 460),
    450: (3, 80, 60, 170, 150, 270, 250, 380, 350, 510),
    500: (3, 90, 70, 190, 170, 300, 280, 420, 390, 570),
}
_MOTOR_BALLS = {18: (4, 11), 30: (5, 12), 50: (9, 17), 80: (12, 22)}
_CYLINDERS = {
    24: (0, 25, 20, 45, 35, 60, 50, 75, 65, 90),
    30: (0, 25, 20, 45, 35, 60, 50, 75, 70, 95),
    40: (5, 30, 25, 50, 45, 70, 60, 85, 80, 105),
    50: (5, 35, 30, 60, 50, 80, 70, 100, 95, 125),
    65: (10, 40, 40, 70, 60, 90, 80, 110, 110, 140),
    80: (10, 45, 40, 75, 65, 100, 90, 125, 130, 165),
    100: (15, 50, 50, 85, 75, 110, 105, 140, 155, 190),
    120: (15, 55, 50, 90, 85, 125, 125, 165, 180, 220),
    140: (15, 60, 60, 105, 100, 145, 145, 190, 200, 245),
    160: (20, 70, 70, 120, 115, 165, 165, 215, 225, 275),
    180: (25, 75, 75, 125, 120, 170, 170, 220, 250, 300),
    200: (35, 90, 90, 145, 140, 195, 195, 250, 275, 330),
    225: (45, 105, 105, 165, 160, 220, 220, 280, 305, 365),
    250: (45, 110, 110, 175, 170, 235, 235, 300, 330, 395),
    280: (55, 125, 125, 195, 190, 260, 260, 330, 370, 440),
    315: (55, 130, 130, 205, 200, 275, 275, 350, 410, 485),
    355: (65, 145, 145, 225, 225, 305, 305, 385, 455, 535),
    400: (100, 190, 190, 280, 280, 370, 370, 460, 510, 600),
    450: (110, 210, 210, 310, 310, 410, 410, 510, 565, 665),
    500: (110, 220, 220, 330, 330, 440, 440, 550, 625, 735),
}

_SELF_ALIGNING = {
    6: (1, 8, 5, 15, 10, 20, 15, 25),
    10: (2, 9, 6, 17, 12, 25, 19, 33),
    14: (2, 10, 6, 19, 13, 26, 21, 35),
    18: (3, 12, 8, 21, 15, 28, 23, 37),
    24: (4, 14, 10, 23, 17, 30, 25, 39),
    30: (5, 16, 11, 24, 19, 35, 29, 46),
    40: (6, 18, 13, 29, 23, 40, 34, 53),
    50: (6, 19, 14, 31, 25, 44, 37, 57),
    65: (7, 21, 16, 36, 30, 50, 45, 69),
    80: (8, 24, 18, 40, 35, 60, 54, 83),
    100: (9, 27, 22, 48, 42, 70, 64, 96),
    120: (10, 31, 25, 56, 50, 83, 75, 114),
    140: (10, 38, 30, 68, 60, 100, 90, 135),
}
_SELF_ALIGNING_TAPERED = {
    24: (7, 17, 13, 26, 20, 33, 28, 42),
    30: (9, 20, 15, 28, 23, 39, 33, 50),
    40: (12, 24, 19, 35, 29, 46, 40, 59),
    50: (14, 27, 22, 39, 33, 52, 45, 65),
    65: (18, 32, 27, 47, 41, 61, 56, 80),
    80: (23, 39, 35, 57, 50, 75, 69, 98),
    100: (29, 47, 42, 68, 62, 90, 84, 116),
    120: (35, 56, 50, 81, 75, 108, 100, 139),
    140: (40, 68, 60, 98, 90, 130, 120, 165),
}

_SPHERICAL = {
    24: (10, 20, 20, 35, 35, 45, 45, 60, 60, 75),
    30: (15, 25, 25, 40, 40, 55, 55, 75, 75, 95),
    40: (15, 30, 30, 45, 45, 60, 60, 80, 80, 100),
    50: (20, 35, 35, 55, 55, 75, 75, 100, 100, 125),
    65: (20, 40, 40, 65, 65, 90, 90, 120, 120, 150),
    80: (30, 50, 50, 80, 80, 110, 110, 145, 145, 185),
    100: (35, 60, 60, 100, 100, 135, 135, 180, 180, 225),
    120: (40, 75, 75, 120, 120, 160, 160, 210, 210, 260),
    140: (50, 95, 95, 145, 145, 190, 190, 240, 240, 300),
    160: (60, 110, 110, 170, 170, 220, 220, 280, 280, 350),
    180: (65, 120, 120, 180, 180, 240, 240, 310, 310, 390),
    200: (70, 130, 130, 200, 200, 260, 260, 340, 340, 430),
    225: (80, 140, 140, 220, 220, 290, 290, 380, 380, 470),
    250: (90, 150, 150, 240, 240, 320, 320, 420, 420, 520),
    280: (100, 170, 170, 260, 260, 350, 350, 460, 460, 570),
    315: (110, 190, 190, 280, 280, 370, 370, 500, 500, 630),
    355: (120, 200, 200, 310, 310, 410, 410, 550, 550, 690),
    400: (130, 220, 220, 340, 340, 450, 450, 600, 600, 750),
    450: (140, 240, 240, 370, 370, 500, 500, 660, 660, 820),
    500: (140, 260, 260, 410, 410, 550, 550, 720, 720, 900),
}
_SPHERICAL_TAPERED = {
    30: (20, 30, 30, 40, 40, 55, 55, 75, 75, 95),
    40: (25, 35, 35, 50, 50, 65, 65, 85, 85, 105),
    50: (30, 45, 45, 60, 60, 80, 80, 100, 100, 130),
    65: (40, 55, 55, 75, 75, 95, 95, 120, 120, 160),
    80: (50, 70, 70, 95, 95, 120, 120, 150, 150, 200),
    100: (55, 80, 80, 110, 110, 140, 140, 180, 180, 230),
    120: (65, 100, 100, 135, 135, 170, 170, 220, 220, 280),
    140: (80, 120, 120, 160, 160, 200, 200, 260, 260, 330),
    160: (90, 130, 130, 180, 180, 230, 230, 300, 300, 380),
    180: (100, 140, 140, 200, 200, 260, 260, 340, 340, 430),
    200: (110, 160, 160, 220, 220, 290, 290, 370, 370, 470),
    225: (120, 180, 180, 250, 250, 320, 320, 410, 410, 520),
    250: (140, 200, 200, 270, 270, 350, 350, 450, 450, 570),
    280: (150, 220, 220, 300, 300, 390, 390, 490, 490, 620),
    315: (170, 240, 240, 330, 330, 430, 430, 540, 540, 680),
    355: (190, 270, 270, 360, 360, 470, 470, 590, 590, 740),
    400: (210, 300, 300, 400, 400, 520, 520, 650, 650, 820),
    450: (230, 330, 330, 440, 440, 570, 570, 720, 720, 910),
    500: (260, 370, 370, 490, 490, 630, 630, 790, 790, 1000),
}
_TOROIDAL = {
    24: (15, 27, 27, 39, 39, 51, 51, 65, 65, 81),
    30: (18, 32, 32, 46, 46, 60, 60, 76, 76, 94),
    40: (21, 39, 39, 55, 55, 73, 73, 93, 93, 117),
    50: (25, 45, 45, 65, 65, 85, 85, 109, 109, 137),
    65: (33, 54, 54, 79, 79, 104, 104, 139, 139, 174),
    80: (40, 66, 66, 96, 96, 124, 124, 164, 164, 208),
    100: (52, 82, 82, 120, 120, 158, 158, 206, 206, 258),
    120: (64, 100, 100, 144, 144, 186, 186, 244, 244, 306),
    140: (76, 119, 119, 166, 166, 215, 215, 280, 280, 349),
    160: (87, 138, 138, 195, 195, 252, 252, 321, 321, 398),
    180: (97, 152, 152, 217, 217, 280, 280, 361, 361, 448),
    200: (108, 171, 171, 238, 238, 307, 307, 394, 394, 495),
    225: (118, 187, 187, 262, 262, 337, 337, 434, 434, 545),
    250: (128, 202, 202, 282, 282, 368, 368, 478, 478, 602),
    280: (137, 221, 221, 307, 307, 407, 407, 519, 519, 655),
    315: (152, 236, 236, 330, 330, 434, 434, 570, 570, 714),
    355: (164, 259, 259, 360, 360, 483, 483, 620, 620, 789),
    400: (175, 280, 280, 395, 395, 528, 528, 675, 675, 850),
    450: (191, 307, 307, 435, 435, 577, 577, 745, 745, 929),
    500: (205, 335, 335, 475, 475, 633, 633, 811, 811, 1015),
}
_TOROIDAL_TAPERED = {
    24: (19, 31, 31, 43, 43, 55, 55, 69, 69, 85),
    30: (23, 37, 37, 51, 51, 65, 65, 81, 81, 99),
    40: (28, 46, 46, 62, 62, 80, 80, 100, 100, 124),
    50: (33, 53, 53, 73, 73, 93, 93, 117, 117, 145),
    65: (42, 63, 63, 88, 88, 113, 113, 148, 148, 183),
    80: (52, 78, 78, 108, 108, 136, 136, 176, 176, 220),
    100: (64, 96, 96, 132, 132, 172, 172, 218, 218, 272),
    120: (75, 115, 115, 155, 155, 201, 201, 255, 255, 321),
    140: (90, 135, 135, 180, 180, 231, 231, 294, 294, 365),
    160: (104, 155, 155, 212, 212, 269, 269, 338, 338, 415),
    180: (118, 173, 173, 238, 238, 301, 301, 382, 382, 469),
    200: (130, 193, 193, 260, 260, 329, 329, 416, 416, 517),
    225: (144, 213, 213, 288, 288, 363, 363, 460, 460, 571),
    250: (161, 235, 235, 315, 315, 401, 401, 511, 511, 635),
    280: (174, 258, 258, 344, 344, 444, 444, 556, 556, 692),
    315: (199, 283, 283, 377, 377, 481, 481, 617, 617, 761),
    355: (223, 318, 318, 419, 419, 542, 542, 679, 679, 848),
    400: (251, 350, 350, 471, 471, 598, 598, 751, 751, 920),
    450: (281, 383, 383, 525, 525, 653, 653, 835, 835, 1005),
    500: (305, 435, 435, 575, 575, 733, 733, 911, 911, 1115),
}


def ball_clearance(name: str, bore: Any) -> Limits:
    """Radial internal clearance of deep groove ball bearings before mounting [m].

    Args:
        name: One of `CLEARANCE_CLASSES`, here and below also with `CLEARANCE_PARTS`
            after it; C4 and C5 only above a bore of 6 mm. `MOTOR_CLASS` from 10 mm to
            80 mm.
        bore: Nominal bore diameter, above 2.5 mm up to 0.5 m [m].

    Raises:
        ValueError: If there is no such class, or not of that bore.

    Source: ISO 5753-1 (2009), as the catalogue of NTN prints it. CM: as Mitsubishi
        prints it for the bearings of its motors; of 10 mm NSK.
    """
    if name == MOTOR_CLASS:
        number = size_range("ball_clearance", "bore", bore, tuple(_MOTOR_BALLS), 9.9)
        return Limits(*(_MICRON * x for x in list(_MOTOR_BALLS.values())[number]))
    return _clearance("ball_clearance", name, bore, _BALLS, 2.5)


def roller_clearance(name: str, bore: Any) -> Limits:
    """Radial internal clearance of cylindrical roller bearings before mounting [m].

    With cylindrical bores, and parts that may be interchanged.

    Args:
        name: One of `CLEARANCE_CLASSES`.
        bore: Nominal bore diameter, up to 0.5 m [m].

    Raises:
        ValueError: If there is no such class, or for other bores.

    Source: ISO 5753-1 (2009), as the catalogue of SKF prints it.
    """
    return _clearance("roller_clearance", name, bore, _CYLINDERS, 0.0)


def self_aligning_clearance(name: str, bore: Any, tapered: bool = False) -> Limits:
    """Radial internal clearance of self-aligning ball bearings before mounting [m].

    Args:
        name: One of `CLEARANCE_CLASSES` but C5.
        bore: Nominal bore diameter, above 2.5 mm up to 0.14 m [m].
        tapered: Whether the bore is tapered (K), above 18 mm: such bearings have more
            clearance, of which driving them up their seats takes a part.

    Raises:
        ValueError: If there is no such class, or for other bores.

    Source: ISO 5753 (1991), as the catalogues of SKF and, of tapered bores, FBJ print
        it.
    """
    table, least = (_SELF_ALIGNING_TAPERED, 18.0) if tapered else (_SELF_ALIGNING, 2.5)
    return _clearance("self_aligning_clearance", name, bore, table, least)


def spherical_roller_clearance(name: str, bore: Any, tapered: bool = False) -> Limits:
    """Radial internal clearance of spherical roller bearings before mounting [m].

    Args:
        name: One of `CLEARANCE_CLASSES`.
        bore: Nominal bore diameter, above 18 mm up to 0.5 m [m].
        tapered: Whether the bore is tapered (K, K30).

    Raises:
        ValueError: If there is no such class, or for other bores.

    Source: ISO 5753-1 (2009), as the catalogues of SKF and NSK print it (of bores from
        65 to 80 mm C5 ends at 185 µm, NSK's at 180); that of tapered bores up to 24 mm
        is not printed there, and left out.
    """
    table, least = (_SPHERICAL_TAPERED, 24.0) if tapered else (_SPHERICAL, 18.0)
    return _clearance("spherical_roller_clearance", name, bore, table, least)


def toroidal_roller_clearance(name: str, bore: Any, tapered: bool = False) -> Limits:
    """Radial internal clearance of toroidal roller bearings before mounting [m].

    With rings that are not shifted along the axis.

    Args: as in `spherical_roller_clearance`.

    Raises:
        ValueError: If there is no such class, or for other bores.

    Source: ISO 5753-1 (2009), as the catalogue of SKF prints it.
    """
    table = _TOROIDAL_TAPERED if tapered else _TOROIDAL
    return _clearance("toroidal_roller_clearance", name, bore, table, 18.0)


def _clearance(owner, name, bore, table, least):
    number = size_range(owner, "bore", bore, tuple(table), least)
    values = list(table.values())[number]
    known = CLEARANCE_CLASSES[: len(values) // 2]
    main, part = name[:2], name[2:]
    follows = known[known.index(main) + 1 :] if main in known else ()
    if (
        main not in known
        or part not in CLEARANCE_PARTS
        or (part == "P" and not follows)
    ):
        raise ValueError(
            f"{owner}: `name` is {name!r}; it must be one of {', '.join(known)} for a"
            f" bore of {float(bore):g} m, or with H, L, M or P (which the last has not)"
            " after it."
        )
    first = 2 * known.index(main)
    low, high = values[first : first + 2]
    half = 0.25 * (high - low)
    if part == "P":
        low, high = low + 2 * half, 0.5 * sum(values[first + 2 : first + 4])
    else:
        lift, fall = {"": (0, 0), "H": (2, 0), "L": (0, 2), "M": (1, 1)}[part]
        low, high = low + lift * half, high - fall * half
    return Limits(low * _MICRON, high * _MICRON)

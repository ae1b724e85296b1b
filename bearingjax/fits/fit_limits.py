"""Limits of the bore, outside diameter and internal clearance of bearings."""

from typing import Any

from ..numerics.constants import read_package_table
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

CLEARANCES: dict[str, Any] = read_package_table(
    "bearingjax.fits", "clearance_classes.toml"
)
"""Of each kind of bearing the printed clearances, and the bores that they are of."""


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
    owner = "ball_clearance"
    if name == MOTOR_CLASS:
        return Limits(*(_MICRON * x for x in _sizes(owner, "ball_of_motors", bore)))
    return _clearance(owner, "ball", name, bore)


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
    return _clearance("roller_clearance", "cylindrical_roller", name, bore)


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
    owner = "self_aligning_clearance"
    return _clearance(owner, "self_aligning_ball", name, bore, tapered)


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
    owner = "spherical_roller_clearance"
    return _clearance(owner, "spherical_roller", name, bore, tapered)


def toroidal_roller_clearance(name: str, bore: Any, tapered: bool = False) -> Limits:
    """Radial internal clearance of toroidal roller bearings before mounting [m].

    With rings that are not shifted along the axis.

    Args: as in `spherical_roller_clearance`.

    Raises:
        ValueError: If there is no such class, or for other bores.

    Source: ISO 5753-1 (2009), as the catalogue of SKF prints it.
    """
    owner = "toroidal_roller_clearance"
    return _clearance(owner, "toroidal_roller", name, bore, tapered)


def _sizes(owner, kind, bore) -> list[float]:
    """Least and largest clearance of each class, of a bore [µm]."""
    ends, rows = zip(*CLEARANCES[kind]["up_to"].items(), strict=True)
    ends = tuple(map(int, ends))
    return rows[size_range(owner, "bore", bore, ends, CLEARANCES[kind]["above"])]


def _clearance(owner, kind, name, bore, tapered=False):
    values = _sizes(owner, f"{kind}_tapered" if tapered else kind, bore)
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

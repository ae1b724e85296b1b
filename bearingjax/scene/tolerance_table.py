"""The [vibration.tolerance] table of a scene: how bearings off the line scatter."""

import dataclasses
from typing import Any

from ..acoustics import RandomWaves, Tolerances
from ..design import is_ball
from ..design.tolerance import (
    BALL_GRADES,
    ROLLER_GRADES,
    TOLERANCE_CLASSES,
    running_accuracy,
)
from .deviations_table import MOST_ORDER
from .table import Table

_KINDS = {
    "diameter": "length",
    "spacing": "angle",
    "outer_eccentricity": "length",
    "inner_eccentricity": "length",
}
_WAVES = {
    "waviness": ("outer_outwards", "inner_outwards"),
    "axial_waviness": ("outer_axial", "inner_axial"),
    "element_waviness": ("elements",),
}
"""Keys of the root mean square of waves, and what has it."""


def read_tolerance(table: Table, bearing: Any) -> tuple[Tolerances, int]:
    """How bearings scatter, and the seed of the random numbers.

    Args:
        table: `[vibration.tolerance]`.
        bearing: The design.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    grades = BALL_GRADES if is_ball(bearing) else ROLLER_GRADES
    grade = table.choice("grade", grades, None)
    slope = table.number("slope", 1.0)
    highest = {
        "raceway": _highest(table, "highest", 100, "raceway"),
        "element": _highest(table, "highest_of_elements", 40, "element"),
    }
    runout = _runout(table)
    if grade is None and runout is not None:
        raise table.error("class", "goes with a `grade`; or give the eccentricities")
    given: dict[str, Any] = {
        name: table.quantity(name, kind)
        for name, kind in _KINDS.items()
        if name in table
    }
    with table.building():
        for key, names in _WAVES.items():
            if key in table:
                height = table.quantity(key, "length")
                last = highest["element" if names == ("elements",) else "raceway"]
                waves = RandomWaves.of_root_mean_square(height, 2, last, slope)
                given |= dict.fromkeys(names, waves)
        found = Tolerances()
        if grade is not None:
            found = Tolerances.of_grade(
                grade,
                bearing,
                runout=runout,
                highest_of_elements=highest["element"],
                slope=slope,
            )
        found = dataclasses.replace(found, **given)
    if not found.sources:
        raise table.error("grade", "is missing, and so is everything that scatters")
    return found, table.integer("seed", 0, least=0)


def _highest(table: Table, key: str, default: int, part: str) -> int:
    most = MOST_ORDER[part]
    value = table.integer(key, default, least=2)
    if value > most:
        raise table.error(key, f"{value} is too many; at most {most}")
    return value


def _runout(table: Table) -> Any:
    """Radial runout of the rings of a tolerance class, or `None`."""
    name = table.choice("class", TOLERANCE_CLASSES, None)
    sizes = ("bore", "outside_diameter")
    if name is None:
        for key in sizes:
            if key in table:
                raise table.error(key, "goes with a `class` of tolerances")
        return None
    lengths = [table.quantity(key, "length") for key in sizes]
    with table.building():
        return running_accuracy(name, *lengths)

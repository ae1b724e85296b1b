"""The [vibration.tolerance] table of a scene: how bearings off the line scatter."""

import contextlib
import dataclasses
from typing import Any

from ..acoustics import RandomWaves, Tolerances
from ..design import is_ball, rows_of
from ..design.tolerance import (
    BALL_GRADES,
    ROLLER_GRADES,
    TOLERANCE_CLASSES,
    ball_grade,
    roller_grade,
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


Tighter = tuple[tuple[str, dict[str, float]], ...]
"""Names of tighter tolerances, and how much smaller they make each source [1]."""


def read_tolerance(table: Table, bearing: Any) -> tuple[Tolerances, Tighter, int]:
    """How bearings scatter, what the next tighter grade and class make of it, and the
    seed of the random numbers.

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
    runouts = _runouts(table)
    runout = runouts[0] if runouts else None
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
    tighter = (*_next_grade(grade, bearing), *_next_class(table, runouts))
    # What is given by its number does not follow from the grade or class.
    own = {*given, *(("elements",) if "element_waviness" in table else ())}
    kept = [
        (name, {k: v for k, v in factors.items() if k not in own})
        for name, factors in tighter
    ]
    told = tuple((name, factors) for name, factors in kept if factors)
    return found, told, table.integer("seed", 0, least=0)


def _next_grade(grade: str | None, bearing: Any) -> Tighter:
    """The grade of rolling elements that is one better, if there is one."""
    ball = is_ball(bearing)
    grades = BALL_GRADES if ball else ROLLER_GRADES
    if grade is None or grade == grades[0]:
        return ()
    name = grades[grades.index(grade) - 1]
    if ball:
        better, worse = ball_grade(name), ball_grade(grade)
    else:
        row: Any = rows_of(bearing)[0].bearing
        diameter = row.roller_diameter
        better, worse = (roller_grade(one, diameter) for one in (name, grade))
    factors = {
        "diameter": better.lot_variation / worse.lot_variation,
        "elements": better.form / worse.form,
    }
    return ((f"grade {name} in place of {grade}", factors),)


def _next_class(table: Table, runouts: list) -> Tighter:
    """The class of rings that is one better, if there is one."""
    if len(runouts) < 2:
        return ()
    worse, better = runouts
    mine = table.word("class")
    name = TOLERANCE_CLASSES[TOLERANCE_CLASSES.index(mine) + 1]
    factors = {
        "outer_eccentricity": better.outer / worse.outer,
        "inner_eccentricity": better.inner / worse.inner,
    }
    return ((f"class {name} in place of {mine}", factors),)


def _highest(table: Table, key: str, default: int, part: str) -> int:
    most = MOST_ORDER[part]
    value = table.integer(key, default, least=2)
    if value > most:
        raise table.error(key, f"{value} is too many; at most {most}")
    return value


def _runouts(table: Table) -> list:
    """Radial runout of the rings of a tolerance class, and of the next better one."""
    name = table.choice("class", TOLERANCE_CLASSES, None)
    sizes = ("bore", "outside_diameter")
    if name is None:
        for key in sizes:
            if key in table:
                raise table.error(key, "goes with a `class` of tolerances")
        return []
    lengths = [table.quantity(key, "length") for key in sizes]
    with table.building():
        found = [running_accuracy(name, *lengths)]
    with contextlib.suppress(IndexError, ValueError):
        # The standard has no runout of every class for every size.
        next_one = TOLERANCE_CLASSES[TOLERANCE_CLASSES.index(name) + 1]
        found.append(running_accuracy(next_one, *lengths))
    return found

"""The [vibration.tolerance] table of a scene: scatter of production bearings."""

import contextlib
import dataclasses
from typing import Any

from ...design import (
    BALL_GRADES,
    ROLLER_GRADES,
    TOLERANCE_CLASSES,
    rows_of,
    running_accuracy,
)
from ...design.tolerance import ELEMENT_GRADES, element_grade
from ...files.schema import Keys, key_of, scene_key
from ...fits import Mounting
from ...noise import RandomWaves, Tolerances
from .read_deviations import MOST_ORDER, SpectrumKeys

_WAVES = {
    "waviness": ("outer_outwards", "inner_outwards"),
    "axial_waviness": ("outer_axial", "inner_axial"),
    "element_waviness": ("elements",),
}
"""Keys of the root mean square of waves, with the parts concerned."""

_OWN = ("diameter", "spacing", "outer_eccentricity", "inner_eccentricity")
"""Keys that override values of the grade and class."""


Tighter = tuple[tuple[str, dict[str, float]], ...]
"""Names of tighter tolerances, with their factor on each source [1]."""


class ToleranceKeys(Keys):
    about = "[vibration.tolerance]: how bearings off the line scatter"

    grade: str | None = scene_key(
        "grade of the rolling elements", choices=(*BALL_GRADES, *ROLLER_GRADES)
    )
    tolerance_class: str | None = scene_key(
        "class of the rings, for their eccentricity",
        name="class",
        choices=TOLERANCE_CLASSES,
    )
    bore: float | None = key_of(Mounting, "bore", needs=("class",))
    outside_diameter: float | None = key_of(
        Mounting, "outside_diameter", needs=("class",)
    )
    waviness: float | None = scene_key(
        "root mean square of the waves of both raceways", "length"
    )
    axial_waviness: float | None = scene_key(
        "root mean square of their axial waves", "length"
    )
    element_waviness: float | None = scene_key(
        "root mean square of the waves of the rolling elements",
        "length",
        otherwise="that of the grade",
    )
    highest: int = scene_key(
        "highest order of waves of raceways; the lowest is 2",
        default=100,
        least=2,
        most=MOST_ORDER["raceway"],
    )
    highest_of_elements: int = scene_key(
        "highest order of waves of rolling elements",
        default=40,
        least=2,
        most=MOST_ORDER["element"],
    )
    slope: float = key_of(SpectrumKeys, "slope", default=1.0)
    diameter: float | None = scene_key(
        "standard deviation of the elements' diameters",
        "length",
        otherwise="that of the grade",
    )
    spacing: float | None = scene_key(
        "standard deviation of the elements' azimuths", "angle"
    )
    outer_eccentricity: float | None = key_of(
        Tolerances, "outer_eccentricity", otherwise="that of the class"
    )
    inner_eccentricity: float | None = key_of(
        Tolerances, "inner_eccentricity", otherwise="that of the class"
    )
    seed: int = scene_key("seed of the random numbers", default=0, least=0)

    def check(self) -> None:
        if self.tolerance_class is not None and self.grade is None:
            problem = "goes with a `grade`; or give the eccentricities"
            raise self.table.error("class", problem)


def read_tolerance(keys: ToleranceKeys, bearing: Any) -> tuple[Tolerances, Tighter]:
    """Read the scatter of bearings, and that of the next tighter grade and class.

    Args:
        keys: `[vibration.tolerance]`.
        bearing: The design.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    table, grade = keys.table, keys.grade
    if grade is not None:
        table.choice("grade", ELEMENT_GRADES[bearing.noun])
    runouts = _runouts(keys)
    given: dict[str, Any] = {
        name: value for name in _OWN if (value := getattr(keys, name)) is not None
    }
    with table.building():
        for name, of in _WAVES.items():
            height = getattr(keys, name)
            if height is not None:
                elements = of == ("elements",)
                last = keys.highest_of_elements if elements else keys.highest
                waves = RandomWaves.of_root_mean_square(height, 2, last, keys.slope)
                given |= dict.fromkeys(of, waves)
        found = Tolerances()
        if grade is not None:
            found = Tolerances.of_grade(
                grade,
                bearing,
                runout=runouts[0] if runouts else None,
                highest=(keys.highest, keys.highest_of_elements),
                slope=keys.slope,
            )
        found = dataclasses.replace(found, **given)
    if not found.sources:
        raise table.error("grade", "is missing, and so is everything that scatters")
    tighter = (*_next_grade(grade, bearing), *_next_class(keys, runouts))
    # Values given as numbers do not follow from the grade or class.
    kept = [
        (name, {k: v for k, v in factors.items() if k not in given})
        for name, factors in tighter
    ]
    return found, tuple((name, factors) for name, factors in kept if factors)


def _next_grade(grade: str | None, bearing: Any) -> Tighter:
    """Return the next better grade of rolling elements, if there is one."""
    grades = ELEMENT_GRADES[bearing.noun]
    if grade is None or grade == grades[0]:
        return ()
    name = grades[grades.index(grade) - 1]
    row = rows_of(bearing)[0].bearing
    better, worse = (element_grade(one, row) for one in (name, grade))
    factors = {
        "diameter": better.lot_variation / worse.lot_variation,
        "elements": better.form / worse.form,
    }
    return ((f"grade {name} in place of {grade}", factors),)


def _next_class(keys: ToleranceKeys, runouts: list) -> Tighter:
    """Return the next better class of rings, if there is one."""
    if len(runouts) < 2:
        return ()
    worse, better = runouts
    mine = keys.tolerance_class or ""
    name = TOLERANCE_CLASSES[TOLERANCE_CLASSES.index(mine) + 1]
    factors = {
        "outer_eccentricity": better.outer / worse.outer,
        "inner_eccentricity": better.inner / worse.inner,
    }
    return ((f"class {name} in place of {mine}", factors),)


def _runouts(keys: ToleranceKeys) -> list:
    """Return the radial runout of the rings of a class, and of the next better one."""
    name, table = keys.tolerance_class, keys.table
    if name is None:
        return []
    lengths = [table.quantity(key, "length") for key in ("bore", "outside_diameter")]
    with table.building():
        found = [running_accuracy(name, *lengths)]
    with contextlib.suppress(IndexError, ValueError):
        # The standard does not give the runout of every class for every size.
        next_one = TOLERANCE_CLASSES[TOLERANCE_CLASSES.index(name) + 1]
        found.append(running_accuracy(next_one, *lengths))
    return found

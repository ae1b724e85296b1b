"""A case with known answers, as its file states it."""

import dataclasses
import functools
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import tomli

from ..files.quantity import read_quantity, size_of_unit

SUBJECTS = {
    "contact": "Contacts",
    "statics": "Loads and displacements",
    "preload": "Preload and stiffness",
    "speed": "Bearings at speed",
    "life": "Ratings and life",
    "friction": "Friction torque and speeds",
    "lubrication": "Oils and films",
    "fits": "Fits and clearance",
    "catalogue": "Catalogue and inner geometry",
    "skidding": "Skidding",
    "rotors": "Rotors",
    "noise": "Noise and vibration",
    "shafts": "Shafts and gears",
}
"""Subjects of the cases, with their headings, in the order of reports."""

TRUST = {
    "measured": "measured on a machine",
    "printed": "printed by a manufacturer, in a standard, a textbook or a paper",
    "independent program": "computed by a program written apart from this one",
    "closed form": "known as a formula",
}
"""How far the numbers of a case are to be trusted."""

_WRITTEN = 0.02
"""Relative tolerance above which a reason must stand beside a number [1]."""


@dataclasses.dataclass(frozen=True)
class Number:
    """One answer of a case.

    Attributes:
        name: What it is.
        theirs: Their values in `unit`, one per row of the case (row, ...); NaN where
            they give none.
        unit: Unit as written; empty for a pure number.
        tolerance: Largest difference, relative to each of their values [1].
        within: Largest difference in `unit`, where this allows more.
        reason: Why ours differs; required if it is not asked to come near.
        of: Where the calculation gives it: its key, or a path into the JSON of a
            command, as "stiffness.8.8"; the last part may be "largest" or "least".
    """

    name: str
    theirs: np.ndarray
    unit: str = ""
    tolerance: float = 0.0
    within: float = 0.0
    reason: str = ""
    of: str = ""

    @property
    def is_test(self) -> bool:
        """Whether ours must come near; the others are shown for information."""
        return self.tolerance > 0.0 or self.within > 0.0

    @property
    def size(self) -> float:
        """SI units in one `unit`."""
        return size_of_unit(self.unit)


@dataclasses.dataclass(frozen=True)
class Case:
    """A case with known answers.

    Attributes:
        name: Name of its file.
        title, source: What it is, and where its numbers come from.
        trust: Key of `TRUST`.
        subject: Key of `SUBJECTS`.
        calculation: "bearingjax COMMAND", whose scene `inputs` then is, or
            "module.function" of `bearingjax.studies.validate.calculations`.
        numbers: The answers.
        inputs: Inputs of all rows.
        rows: Inputs that vary: a list each, one value per row.
        type: Type of the bearing, as in scenes; empty if it is about none.
        pitch_diameter: That of the bearing [m]; 0 if not stated.
        load: Largest load on the bearing [N]; 0 if not stated.
        notes: What else a reader should know.
        slow: Whether the calculation takes more than some seconds.
    """

    name: str
    title: str
    source: str
    trust: str
    subject: str
    calculation: str
    numbers: tuple[Number, ...]
    inputs: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    rows: Mapping[str, list[Any]] = dataclasses.field(default_factory=dict)
    type: str = ""
    pitch_diameter: float = 0.0
    load: float = 0.0
    notes: str = ""
    slow: bool = False

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(next(iter(self.rows.values()), [0]))


@functools.cache
def cases() -> dict[str, Case]:
    """Return all cases by name, in the order of their subjects.

    Raises:
        ValueError: If a file is no case; the message names it.
    """
    folder = Path(str(files("bearingjax.validation") / "cases"))
    found = [read_case(path) for path in sorted(folder.glob("*.toml"))]
    order = list(SUBJECTS)
    found.sort(key=lambda case: order.index(case.subject))
    return {case.name: case for case in found}


def read_case(path: Path) -> Case:
    """Read a case from its file.

    Raises:
        ValueError: If it is none; the message names the file and the key.
    """
    try:
        given = tomli.loads(path.read_text("utf-8"))
        rows = {k: _row_values(v) for k, v in given.pop("rows", {}).items()}
        numbers = tuple(
            Number(name, np.asarray(values.pop("theirs"), float), **values)
            for name, values in given.pop("numbers").items()
        )
        bearing = given.pop("bearing", {})
        for name in "pitch_diameter", "load":
            bearing[name] = as_number(bearing.get(name, 0.0))
        case = Case(path.stem, rows=rows, numbers=numbers, **given, **bearing)
        _check(case)
    except (TypeError, KeyError, ValueError) as error:
        raise ValueError(f"{path.name}: {error}") from error
    return case


def _check(case: Case) -> None:
    """Raise ValueError if a case contradicts itself."""
    for name, known in (("subject", SUBJECTS), ("trust", TRUST)):
        if getattr(case, name) not in known:
            raise ValueError(f"`{name}` must be one of {', '.join(known)}")
    if len({len(values) for values in case.rows.values()}) > 1:
        raise ValueError("the lists of `rows` differ in length")
    for number in case.numbers:
        if case.rows and len(np.atleast_1d(number.theirs)) != case.count:
            raise ValueError(f"{number.name}: `theirs` needs {case.count} values")
        loose = not number.is_test or number.tolerance > _WRITTEN
        if loose and not number.reason:
            raise ValueError(f"{number.name}: `reason` is missing: why may it differ?")
        size_of_unit(number.unit)


def as_number(value: Any) -> Any:
    """Return a text with a unit as a number in SI, lists and tables of them likewise.

    Args:
        value: As written; `{values = [...], unit = "N"}` is a list in one unit. Lists
            of numbers become arrays; other texts stay as they are.
    """
    if isinstance(value, str):
        number = read_quantity(value)
        return value if number is None else number
    if isinstance(value, Mapping):
        if value.keys() == {"values", "unit"}:
            return size_of_unit(value["unit"]) * np.asarray(value["values"], float)
        return {name: as_number(inner) for name, inner in value.items()}
    if not isinstance(value, list):
        return value
    numbers = all(isinstance(one, int | float) for one in value)
    return np.asarray(value) if numbers else [as_number(one) for one in value]


def _row_values(values: Any) -> list[Any]:
    """Return a column of `rows` as a list, each with its unit."""
    if isinstance(values, Mapping):
        unit = values["unit"]
        return [f"{value!r} {unit}" for value in values["values"]]
    return values

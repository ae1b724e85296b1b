"""Reader of [identify] of a scene, and of its table of measurements."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...decide import CaseModel
from ...files.column_list import read_list
from ...files.quantity import SceneError, kind_of
from ...files.scene_file import find_scene, parse_scene
from ...files.schema import Keys, names_key, read_keys, scene_key
from ...files.table import Table
from ...files.text_file import read_columns
from ...numerics.units import unit_of
from ...optimise import Variable
from ..cases.case_keys import VariedKey
from ..optimise.read_optimise import (
    check_numbers,
    read_number,
    read_spread,
    read_variables,
)
from .subjects import Setup, Subject, read_setup

ERROR = ".error"
"""Ending of the header of a column of standard deviations."""


class IdentifyKeys(Keys):
    about = "[identify]: numbers of a bearing, shafts or a rotor from measurements"

    data: str | None = scene_key(
        "path of a CSV table with a row for each case: columns of conditions by their"
        " keys and of measured results by name (of a bearing as in the table of a"
        " sweep), each with its unit",
        otherwise="that of `--data`",
    )
    unknowns: Any = names_key(
        "unknown numbers by their key in the scene, in quotes: `{ from, to, start,"
        " prior, prior_error }`, bounds, start value, prior and its standard deviation"
    )
    errors: Any = names_key(
        "standard deviation of the readings of each column, unless the table has it",
        default=None,
        tables=False,
    )
    errors_known: bool = scene_key(
        "whether `errors` are absolute; if not, the residuals scale them", default=True
    )
    wanted: tuple[str, ...] | None = scene_key(
        "results that are predicted with standard errors, or unknowns, whose variance"
        " further readings are to lower",
        otherwise="all unknowns",
    )
    candidates: Any = names_key(
        "further readings that could be taken, each with its standard deviation",
        default=None,
        tables=False,
    )


class Identification(NamedTuple):
    """Arguments of `decide.identify` by [identify] of a scene.

    Attributes:
        subject: The scene, its model and the cases of the measured table.
        unknowns: Unknown numbers of the design, named as in the scene.
        readings: Measured values by name (case,) [SI].
        errors: Standard deviations of the readings by name [SI]; `None`: not known.
        wanted: Names of results or unknowns whose variance is to be lowered.
        candidates: Standard deviations of further readings by name [SI].
        errors_known: Whether the errors are absolute, or known up to a factor.
        units: SI units of all numbers, by name.
        inputs: The scene as it was read, in SI, with [identify].
    """

    subject: Subject
    unknowns: tuple[Variable, ...]
    readings: dict[str, Any]
    errors: dict[str, Any] | None
    wanted: tuple[str, ...]
    candidates: dict[str, float] | None
    errors_known: bool
    units: dict[str, str]
    inputs: dict[str, Any]


def read_identification(
    source: str | Path, settings: Iterable[str] = ()
) -> Identification:
    """Read a scene with [identify], of a bearing, of shafts or of a rotor, and its
    measured table.

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    data = parse_scene(path, settings)
    if "identify" not in data:
        raise SceneError(f"{path.name}: `identify` is missing; it names `unknowns`")
    top = Table(data, path)
    if "cases" in data:
        problem = "stands beside [identify], whose cases are the rows of its data"
        raise top.error("cases", problem)
    keys = read_keys(IdentifyKeys, top.table("identify"))
    table, wanted = keys.table, tuple(dict.fromkeys(keys.wanted or ()))
    if keys.data is None:
        raise table.error("data", "is missing; name the measured table, or give --data")
    held = Table({"file": keys.data}, path, "identify", {"file": "identify.data"})
    setup = read_setup(data, path)
    columns, readings, units = _measured(held, setup)
    table.fill("data", str((path.parent / keys.data).resolve()))
    for column in columns:
        if column.key in keys.unknowns:
            problem = "is a column of the measured table too"
            raise keys.unknowns.error(column.key, problem)
    design = setup.model.design
    check_numbers(keys.unknowns, top, setup.scene)
    if "life.viscosity" in keys.unknowns and "lubricant" in top:
        problem = "is that of the oil of [lubricant]; give [life] `viscosity` in its"
        raise keys.unknowns.error("life.viscosity", f"{problem} place")
    unknowns, priors = _unknowns(keys.unknowns, design, setup.numbers)
    units |= {one.name: unit_of(design, one.path[0]) for one in unknowns}
    asked = [(table, "wanted", name) for name in wanted]
    asked += [(keys.candidates, name, name) for name in keys.candidates.keys()]
    for place, key, name in asked:
        if name not in units:
            units[name] = _unit(place, key, setup.model, name)
    subject = setup.subject(held, columns, len(next(iter(readings.values()))))
    errors = _errors(table, keys.errors, readings, units)
    if errors is None and priors:
        raise table.error("errors", "are missing; beside a prior they must be known")
    candidates = _positive_numbers(keys.candidates, units)
    table.finish()
    return Identification(
        subject,
        unknowns,
        readings | {name: value for name, (value, _) in priors.items()},
        errors and errors | {name: error for name, (_, error) in priors.items()},
        wanted,
        candidates or None,
        keys.errors_known,
        units,
        {**setup.scene.inputs, "identify": table.echo()},
    )


def _measured(held: Table, setup: Setup) -> Any:
    """Return conditions, measured columns with those of their errors, and units."""
    name, kinds, units = str(held.text("file")), setup.kinds, {}
    folder, blank = setup.path.parent, []
    try:
        header = read_columns(folder / name)[0][1]
    except (ValueError, IndexError):
        header = []  # `read_list` raises the error
    for title in header:
        key = title.partition("[")[0].strip()
        own = key.removesuffix(ERROR)
        if setup.measures(own):
            units[own] = _unit(held, "file", setup.model, own, f"{name}: ")
            kinds[key] = kind_of(units[own])
            blank.append(key)
    found = read_list(held, folder, kinds, "readings", blank=blank)
    read = {key: values for key, values in found.items() if key in blank}
    alone = [key for key in read if key.removesuffix(ERROR) not in read]
    if alone or not read:
        lacks = "has no column of readings"
        problem = f"{alone[0]} {lacks}" if alone else "measures nothing"
        raise held.error("file", f"{name}: {problem}")
    index = np.arange(len(next(iter(read.values()))))
    columns = [VariedKey(key, v, index) for key, v in found.items() if key not in read]
    return columns, read, units


def _unit(table: Any, key: str, model: CaseModel, name: str, head: str = "") -> str:
    try:
        unit = model.place(name).unit
        kind_of(unit)
        return unit
    except ValueError as error:
        raise table.error(key, f"{head}{error}") from error
    except KeyError:
        raise table.error(key, f"{head}{name} cannot be measured") from None


def _unknowns(table: Table, design: Any, numbers) -> Any:
    """Return the unknowns, and their priors with errors by name."""
    if not table.keys():
        raise table.own_error("is empty; name one unknown at least")
    unknowns, priors = read_variables(table, design, numbers), {}
    for one in unknowns:
        part, unit = table.table(one.name), unit_of(design, one.path[0])
        error = read_spread(part, "prior_error", unit, None)
        prior = read_number(part, "prior", unit, None)
        if (prior is None) != (error is None):
            given, other = ("prior", "prior_error")[:: 1 if error is None else -1]
            raise part.error(given, f"is given without `{other}`")
        if prior is not None:
            priors[one.name] = prior, error
    return unknowns, priors


def _errors(table: Table, given: Table, read: dict, units: dict) -> Any:
    """Remove the columns of errors from those that were read; return all errors."""
    found = {k.removesuffix(ERROR): read.pop(k) for k in [*read] if k.endswith(ERROR)}
    for name in given.keys():
        if name not in read or name in found:
            twice = "has a column of its own" if name in found else "is not measured"
            raise given.error(name, twice)
    found |= _positive_numbers(given, units)
    if found and (lacking := [name for name in read if name not in found]):
        raise table.error("errors", f"has no standard deviation of {lacking[0]}")
    return found or None


def _positive_numbers(table: Table, units: dict[str, str]) -> dict[str, float]:
    return {name: read_spread(table, name, units[name]) for name in table.keys()}

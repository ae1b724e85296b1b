"""Our numbers of validation cases, beside theirs."""

import argparse
import contextlib
import dataclasses
import importlib
import json
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...files.quantity import SceneError
from ...files.table import not_among
from ...validation.case import SUBJECTS, Case, Number, as_number, cases
from ..commands import SOLVING
from ..outcome import Tools


@dataclasses.dataclass(frozen=True)
class Comparison:
    """A number of a case beside ours.

    Attributes:
        case: The case.
        number: What it states.
        ours: Our values in the unit of `number`, in the shape of theirs.
    """

    case: Case
    number: Number
    ours: np.ndarray

    @property
    def theirs(self) -> np.ndarray:
        """Their values (value,), those that they give."""
        return self.number.theirs[np.isfinite(self.number.theirs)]

    @property
    def flat_ours(self) -> np.ndarray:
        """Our values (value,), where they give one."""
        return self.ours[np.isfinite(self.number.theirs)]

    @property
    def count(self) -> int:
        """Number of values that they give."""
        return len(self.theirs)

    @property
    def shares(self) -> np.ndarray:
        """Differences over their value, or over their largest where it is zero
        (value,) [1]."""
        theirs = np.abs(self.theirs)
        size = np.where(theirs > 0.0, theirs, theirs.max() or 1.0)
        return np.abs(self.flat_ours - self.theirs) / size

    @property
    def worst(self) -> int:
        """Place of the value that differs most."""
        return int(np.argmax(self.shares))

    @property
    def largest(self) -> float:
        """Largest of `shares` [1]."""
        return float(self.shares.max())

    @property
    def kept(self) -> bool:
        """Whether ours are as near as the case asks for; what is not finite is not."""
        near = self.number.tolerance * np.abs(self.theirs) + self.number.within
        return bool(np.all(np.abs(self.flat_ours - self.theirs) <= near))


def select_cases(names: Sequence[str]) -> list[Case]:
    """Return the cases named, by themselves or by their subject; all if none is.

    Raises:
        SceneError: If a name is neither a case nor a subject.
    """
    known = cases()
    for name in names:
        if name not in known and name not in SUBJECTS:
            words = "the cases and subjects that `bearingjax validate --list` tells"
            raise SceneError(f"validate: {not_among(name, [*SUBJECTS, *known], words)}")
    chosen = [c for c in known.values() if {c.name, c.subject} & {*names}]
    return chosen if names else [*known.values()]


def compare_case(case: Case) -> list[Comparison]:
    """Calculate the numbers of a case.

    Raises:
        ValueError: If the calculation lacks a number of the case, or gives another
            shape.
        SceneError: If the inputs are no scene of the command.
    """
    rows = [{k: v[i] for k, v in case.rows.items()} for i in range(case.count)]
    program, _, name = case.calculation.partition(" ")
    if name:
        found = [command_numbers(name, case.inputs, row) for row in rows]
    else:
        module, _, function = program.partition(".")
        home = importlib.import_module(f".calculations.{module}", __package__)
        calculate, inputs = getattr(home, function), as_number(case.inputs)
        found = [calculate(**inputs, **as_number(row)) for row in rows]
    comparisons = []
    for number in case.numbers:
        values = [_look_up(one, number.of or number.name) for one in found]
        ours = np.asarray(values if case.rows else values[0], float)
        if ours.shape != number.theirs.shape:
            raise ValueError(
                f"{case.name}: {number.name}: ours has shape {ours.shape}, theirs"
                f" {number.theirs.shape}"
            )
        comparisons.append(Comparison(case, number, np.asarray(ours / number.size)))
    return comparisons


def command_numbers(
    command: str, scene: Mapping[str, Any], settings: Mapping[str, Any]
) -> Mapping[str, Any]:
    """Return the JSON of a command.

    Args:
        command: Its name.
        scene: Tables of the scene; `options`, if there, are of the command line.
        settings: Changes to the scene, by dotted key.

    Raises:
        SceneError: If it is no scene of the command.
        ValueError: If the scene is not solved.
    """
    called = next(one for one in SOLVING if one.name == command)
    parser = argparse.ArgumentParser()
    called.add(parser.add_subparsers())
    tables = {name: table for name, table in scene.items() if name != "options"}
    changes = [f"--set={key}={value}" for key, value in settings.items()]
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        path = Path(folder) / "case.json"
        path.write_text(json.dumps({"inputs": tables}), encoding="utf-8")
        given = [command, str(path), *changes, *scene.get("options", ())]
        options = parser.parse_args(given)
        outcome = called.run(options, Tools(False, None, stack.enter_context))
        if outcome.problems:
            raise ValueError("; ".join(outcome.problems))
        return outcome.numbers()


def _look_up(found: Any, path: str) -> Any:
    """Return the value under a key, or under a path of keys and places."""
    if isinstance(found, Mapping) and path in found:
        return found[path]
    for part in path.split("."):
        if part in ("largest", "least") and isinstance(found, list):
            values = np.asarray(found, float)
            found = np.nanmax(values) if part == "largest" else np.nanmin(values)
        elif isinstance(found, list) and part.isdecimal():
            found = found[int(part)]
        elif isinstance(found, Mapping) and part in found:
            found = found[part]
        else:
            raise ValueError(f"{path!r}: the results have no {part!r}")
    return found

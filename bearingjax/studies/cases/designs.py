"""Designs of the cases of a scene: those that its varied keys make."""

import copy
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...cases.cases import Cases
from ...cases.sweep import stack_designs, structure_of
from ...element import BearingElement
from ...files.quantity import QUANTITIES
from ...files.scene_errors import error_at
from ...files.scene_file import assign
from ...numerics.warning import Warning
from ..bearing.read_scene import Scene, scene_of
from .case_keys import OPERATING, VariedKey

_SI_UNITS = {unit for unit, _ in QUANTITIES.values()}

DESIGN = ("bearing", "set", "contact", "fit", "temperature")
"""Tables of the scene whose keys define the design."""

MOST_DESIGNS = 10**5
"""Most designs of a scene: each is read and checked separately, in about 5 ms."""


@dataclasses.dataclass(frozen=True)
class DesignGroup:
    """Designs solved by one program: with the same classes, counts and parts, and the
    same catalogue bearing.

    Attributes:
        element: The bearing; of several designs, stacked by `stack_designs`.
        designs: Indices of these designs among all, ascending; `None` if the design
            does not vary.
        scene: Scene of the first design.
    """

    element: BearingElement[Any]
    designs: np.ndarray | None
    scene: Scene

    @property
    def designation(self) -> str | None:
        """Designation of the catalogue bearing, or `None`."""
        taken = self.scene.catalogue
        return None if taken is None else taken.entry.designation

    def cases_of(self, cases: Cases) -> np.ndarray:
        """Return the indices of the cases with one of these designs."""
        if self.designs is None:
            return np.arange(cases.count)
        return np.flatnonzero(np.isin(np.asarray(cases.design), self.designs))


def makes_design(key: str) -> bool:
    """Whether a key belongs to a table that defines the design."""
    return "." in key and key.partition(".")[0] in DESIGN


def fill_first_values(
    data: dict[str, Any], columns: Sequence[VariedKey], file: str
) -> dict[str, Any]:
    """Fill in the first value of each varied key that the scene does not give: a
    varied interference need not be repeated in [fit]."""
    begun = copy.deepcopy(data)
    for column in columns:
        if makes_design(column.key) and _look_up(data, column.key) is None:
            assign(begun, column.key, column.values[column.index[0]], file)
    return begun


def _look_up(data: Any, key: str) -> Any:
    """Return what stands at a dotted key; `None`: nothing."""
    for part in key.split("."):
        if isinstance(data, list):
            there = part.isdecimal() and int(part) < len(data)
            data = data[int(part)] if there else None
        else:
            data = data.get(part) if isinstance(data, dict) else None
    return data


def read_designs(
    data: dict[str, Any], path: Path, columns: Sequence[VariedKey], scene: Scene
) -> tuple[Any, Any, tuple[dict[str, Any], ...], tuple[Warning, ...]]:
    """Return structures, design of each case, settings and warnings of all designs.

    Where the design does not vary, it is that of `scene`; repeated ones are merged.

    Raises:
        SceneError: If there are more than `MOST_DESIGNS`.
    """
    varied = [
        c
        for c in columns
        # On its seats the bearing changes with its speed.
        if c.key not in OPERATING or ("fit" in data and c.key.endswith("_speed"))
    ]
    if not varied:
        return (DesignGroup(scene.running(), None, scene),), None, ({},), ()
    codes = []
    for column in varied:
        distinct = {v: k for k, v in enumerate(dict.fromkeys(map(repr, column.values)))}
        code = np.array([distinct[repr(value)] for value in column.values])
        codes.append(code[column.index])
    _, first, design = np.unique(
        np.stack(codes), axis=1, return_index=True, return_inverse=True
    )
    if len(first) > MOST_DESIGNS:
        problem = f"make {len(first)} designs; at most {MOST_DESIGNS}"
        raise error_at(path, "cases", problem)
    scenes, made = [], []
    for case in map(int, first):
        made.append({c.key: c.values[c.index[case]] for c in varied})
        changed = copy.deepcopy(data)
        for key, value in made[-1].items():
            # The speeds of a range are already numbers.
            speed = key in OPERATING and not isinstance(value, str)
            assign(changed, key, f"{value} rad/s" if speed else value, path.name)
        scenes.append(scene_of(changed, path, made[-1]))
    settings = tuple(
        dict(_resolve(one.inputs, k, v) for k, v in given.items() if k not in OPERATING)
        for one, given in zip(scenes, made, strict=True)
    )
    elements = [one.running() for one in scenes]
    alike: dict[Any, list[int]] = {}
    for number, (element, one) in enumerate(zip(elements, scenes, strict=True)):
        speeds = one.entry and (one.entry.limiting_speed, one.entry.reference_speed)
        alike.setdefault((structure_of(element), speeds), []).append(number)
    groups = tuple(
        DesignGroup(
            stack_designs([elements[k] for k in numbers]),
            np.array(numbers),
            scenes[numbers[0]],
        )
        for numbers in alike.values()
    )
    return (
        groups,
        design.reshape(-1),
        settings,
        sum((one.warnings for one in scenes), ()),
    )


def _resolve(inputs: dict[str, Any], key: str, given: Any) -> tuple[str, Any]:
    """Return header and value of a setting: a number in SI, or text as given."""
    found = _look_up(inputs, key)
    if isinstance(found, int | float) and not isinstance(found, bool):
        return key, found
    number, _, unit = found.partition(" ") if isinstance(found, str) else ("", "", "")
    # A designation, "7208 BE", is not a quantity.
    if unit not in _SI_UNITS:
        return key, str(given)
    return f"{key} [{unit}]", float(number)

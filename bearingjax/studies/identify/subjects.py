"""Designs whose numbers are identified: a bearing, shafts on bearings, or a rotor."""

import dataclasses
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...cases.spectrum import relative_speed
from ...cases.sweep_table import case_columns
from ...decide import CaseModel
from ...decide.predict import Oiled
from ...files.quantity import kind_of
from ...files.scene_file import is_rotor, is_shafts
from ...files.table import Table, not_among
from ...numerics.labels import column_header
from ...numerics.units import unit_of
from ...optimise.system import AbstractSystem
from ...optimise.variable import with_numbers
from ...rotor.rotor_design import RotorCases
from ..bearing.life_ratings import life_conditions
from ..bearing.read_scene import scene_of, with_speed_warnings
from ..cases.case_keys import OPERATING, VariedKey
from ..cases.read_cases import cases_of_columns, check_varied_key
from ..optimise.noise_numbers import noise_design
from ..optimise.read_optimise import installed_numbers
from ..optimise.read_shaft_optimise import design_in_cases, shaft_numbers
from ..optimise.rotor_numbers import rotor_design, rotor_numbers
from ..rotor.read import RotorScene, rotor_of
from ..shaft.read import ShaftScene, shafts_of


class Subject(NamedTuple):
    """The design of a scene in the cases of a measured table.

    Attributes:
        scene: The scene.
        model: Results as a function of numbers of the design, in the cases.
        cases: The cases.
        columns: Conditions of the cases in SI, by header of a table.
    """

    scene: Any
    model: CaseModel
    cases: Any
    columns: dict[str, np.ndarray]

    @property
    def study(self) -> str:
        """Command that solves the scene."""
        kinds = {ShaftScene: "shaft", RotorScene: "rotor"}
        return kinds.get(type(self.scene), "solve")


class Setup(NamedTuple):
    """A scene before the cases of a measured table are known.

    Attributes:
        scene: The scene.
        model: Results as a function of numbers of the design.
        numbers: Paths in the design of each number, by its key in the scene.
        data: The scene as parsed.
        path: Path of the scene.
    """

    scene: Any
    model: CaseModel
    numbers: dict[str, tuple[str, ...]]
    data: dict[str, Any]
    path: Path

    @property
    def kinds(self) -> dict[str, str]:
        """Kinds of quantities by key, of columns that are conditions; other conditions
        are read as settings of the scene."""
        if isinstance(self.scene, RotorScene):
            return {"rotor.speed": "speed"}
        if is_shafts(self.data):
            return {}
        design, numbers = self.model.design, self.numbers.items()
        return OPERATING | {k: kind_of(unit_of(design, p[0])) for k, p in numbers}

    def measures(self, key: str) -> bool:
        """Return whether a column has readings: its key is no condition of a scene."""
        design, head = self.model.design, key.partition(".")[0]
        known = design.readings() if isinstance(design, AbstractSystem) else None
        named = known is not None and (key in known or head not in self.data)
        return key not in OPERATING and ("." not in key or named)

    def subject(self, table: Table, columns: list[VariedKey], count: int) -> Subject:
        """Return the design in the cases of a measured table.

        Args:
            table: Table that names the file, for errors.
            columns: Columns of conditions.
            count: Number of rows.

        Raises:
            SceneError: For conditions that cannot vary.
        """
        own = self._shafts if is_shafts(self.data) else self._bearing
        own = self._rotor if isinstance(self.scene, RotorScene) else own
        return own(table, columns, count)

    def _bearing(self, table, columns, count) -> Subject:
        varied: dict[str, Any] = {}
        kept: dict[str, Any] = {}
        for column in columns:
            if column.key in OPERATING:
                check_varied_key(table, column.key, self.scene)
            elif column.key not in self.numbers:
                raise table.error("file", not_among(column.key, [*self.kinds]))
            else:
                values, paths = np.asarray(column.values), self.numbers[column.key]
                unit = unit_of(self.model.design, paths[0])
                varied |= dict.fromkeys(paths, values.astype(float))
                kept[column_header(column.key, unit)] = values
        for case in range(count if varied else 0):
            with table.building():
                own = {path: values[case] for path, values in varied.items()}
                with_numbers(self.model.design, own)
        cases = cases_of_columns(table, self.scene, columns, None, count)
        if isinstance(self.model.design, AbstractSystem):
            with table.building():
                self.model.design.check(cases)
        model = dataclasses.replace(self.model, varied=varied)
        scene = with_speed_warnings(self.scene, relative_speed(cases))
        return Subject(scene, model, cases, dict(case_columns(cases)) | kept)

    def _shafts(self, table, columns, count) -> Subject:
        if any(column.key == "hours" for column in columns):
            raise table.error("file", "hours of a case change no reading of shafts")
        rows = [{c.key: c.values[k] for c in columns} for k in range(count)]
        listed = {"spectrum": [row | {"hours": "1 h"} for row in rows]}
        scene = shafts_of(self.data | {"cases": listed}, self.path)
        oily = self.model.design.oils is not None
        design, cases = design_in_cases(scene, oily, table)
        model = dataclasses.replace(self.model, design=design)
        kept = {c.key: np.asarray(list(map(str, c.values))) for c in columns}
        return Subject(scene, model, cases, kept)

    def _rotor(self, table, columns, count) -> Subject:
        speed = np.full(count, self.scene.speed)
        for column in columns:
            if column.key != "rotor.speed":
                raise table.error("file", not_among(column.key, ["rotor.speed"]))
            speed = np.asarray(column.values, float)
        for mount in self.scene.mounts if np.any(speed != self.scene.speed) else ():
            if mount.keys.law is not None and mount.scene.fits is not None:
                problem = f"varies `rotor.speed`; the `law` of {mount.name} stays that"
                raise table.error("file", f"{problem} of its fits at one speed")
        kept = {"rotor.speed [rad/s]": speed}
        return Subject(self.scene, self.model, RotorCases(speed), kept)


def read_setup(data: dict[str, Any], path: Path) -> Setup:
    """Read a scene before the cases of a measured table are known.

    Args:
        data: The scene as parsed.
        path: Path of the scene.

    Raises:
        SceneError: If the scene cannot be read, or is of another kind.
    """
    if is_shafts(data):
        scene: Any = shafts_of(data, path)
        table = Table(data, path).table("identify")
        alone = [one for one in scene.bearings if one is not None]
        oily = all(one.oil is not None for one in alone)
        design = design_in_cases(scene, oily, table)[0]
        return Setup(scene, CaseModel(design), shaft_numbers(scene), data, path)
    if is_rotor(data):
        alone = {key: value for key, value in data.items() if key != "identify"}
        scene = rotor_of(alone, path)
        model = CaseModel(rotor_design(scene))
        return Setup(scene, model, rotor_numbers(scene), data, path)
    if "vibration" in data:
        scene, rig, numbers = noise_design(data, path)
        own = scene.support, scene.solve_options
        return Setup(scene, CaseModel(rig, *own), numbers, data, path)
    scene = scene_of(data | {"cases": {}}, path)  # they are rows of the measured table
    oil = {} if scene.oil is None else {"supply": scene.oil.supply}
    given = scene.support, scene.solve_options, life_conditions(scene)
    placed, numbers = scene.installed, installed_numbers(scene)
    if scene.life is not None and scene.life.viscosity is not None and not oil:
        placed = Oiled(**vars(placed), viscosity=scene.life.viscosity)
        numbers["life.viscosity"] = ("viscosity",)
    return Setup(scene, CaseModel(placed, *given, **oil), numbers, data, path)

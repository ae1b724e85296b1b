"""The [optimise] table of a system of shafts."""

import dataclasses
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...files.quantity import kind_of
from ...files.scene_file import find_scene, is_shafts, parse_scene
from ...files.schema import key_of, read_keys, scene_key
from ...files.table import Table, not_among
from ...optimise.variable import design_numbers
from ...shafts import (
    Gear,
    PowerLoss,
    ShaftCases,
    ShaftDesign,
    ShaftMass,
    ShaftSystem,
    SystemLife,
    Worst,
    load_cases,
)
from ..bearing.life_ratings import life_conditions
from ..shaft.read import ShaftScene, read_shafts
from ..shaft.read_heat import bearing_oil
from .read_optimise import (
    BoundKeys,
    ConstraintKeys,
    SearchKeys,
    SearchTask,
    check_numbers,
    check_present,
    installed_numbers,
    read_bearing_optimisation,
    read_variables,
)

_OF_BEARINGS = ("rating_life", "static_safety", "peak_pressure", "tilt")
_OF_SYSTEM = {"power_loss": PowerLoss, "mass": ShaftMass, "system_life": SystemLife}
SHAFT_OBJECTIVES = (*_OF_SYSTEM, *_OF_BEARINGS, "misalignment")
_SHARED = ("normal_module", "helix_angle", "pressure_angle")
"""Numbers that gears which mesh have in common."""
_GIVEN = ("torque", "power")
"""Numbers of a wheel that are loads, not the design."""


def _part_key() -> Any:
    return scene_key(
        "bearing or gear that the measure is of", otherwise="the worst of all"
    )


class ShaftConstraintKeys(BoundKeys):
    measure: str = key_of(ConstraintKeys, "measure", choices=SHAFT_OBJECTIVES)
    of: str | None = _part_key()


class ShaftOptimiseKeys(SearchKeys):
    about = "[optimise]: variables, objective and constraints"

    objective: str = scene_key(
        "what is made least; lives and `static_safety` are made largest",
        choices=SHAFT_OBJECTIVES,
    )
    of: str | None = _part_key()
    constraints: tuple[ShaftConstraintKeys, ...] = scene_key(
        "bounds on measures", default=()
    )


@dataclasses.dataclass(frozen=True, kw_only=True)
class ShaftOptimisation(SearchTask):
    """Optimisation task of the scene of a system of shafts.

    Attributes:
        scene: The scene without [optimise].
        design: The system with the lives of its bearings, in the first case.
        cases: Its load cases; without [cases] one.
    """

    scene: ShaftScene
    design: ShaftDesign
    cases: ShaftCases


def read_optimisation(source: str | Path, settings: Iterable[str] = ()) -> Any:
    """Read a scene with [optimise], of a bearing or of a system of shafts.

    Args: as `read_scene`.

    Returns:
        `Optimisation`, or `ShaftOptimisation`.

    Raises:
        SceneError: One line with file, line, key, fault and the allowed values.
    """
    settings = tuple(settings)
    path = find_scene(source)
    data = parse_scene(path, settings)
    if not is_shafts(data):
        return read_bearing_optimisation(source, settings)
    check_present(data, path)
    scene = read_shafts(source, settings)
    top = Table({"optimise": data["optimise"]}, path)
    table = top.table("optimise")
    keys = read_keys(ShaftOptimiseKeys, table)
    free = table.table("variables", required=True)
    known = scene, keys.exponent
    measures = [shaft_measure(keys, "objective", *known)]
    measures += [shaft_measure(one, "measure", *known) for one in keys.constraints]
    design, cases = design_in_cases(scene, has_power(measures), table)
    numbers = shaft_numbers(scene)
    varying = set(cases.paths)
    heads = tuple(dict.fromkeys(".".join(key.split(".")[:2]) for key in numbers))
    check_numbers(free, Table(data, path), scene)
    for key in free.keys():
        if "." in key and ".".join(key.split(".")[:2]) not in heads:
            problem = f"{key!r} may not be free; what may are numbers of"
            raise free.error(key, f"{problem} {', '.join(heads)}")
        own = {path.rpartition(".")[0] for path in numbers.get(key, ())}
        if varying & {*own, *numbers.get(key, ())}:
            raise free.error(key, "differs from case to case in [cases]")
    variables = read_variables(free, design, numbers)
    bounds = zip(keys.constraints, measures[1:], strict=True)
    constraints = tuple(
        one.constraint(measure, kind_of(measure.unit)) for one, measure in bounds
    )
    top.finish()
    return ShaftOptimisation(
        scene=scene,
        design=design,
        cases=cases,
        variables=variables,
        objective=measures[0],
        constraints=constraints,
        method=keys.method,
        max_steps=keys.max_steps,
        tolerance=keys.tolerance,
        inputs={**scene.inputs, "optimise": table.echo()},
    )


def has_power(measures: Iterable[Any]) -> bool:
    """Whether the friction of bearings is among measures."""
    return any(isinstance(measure, PowerLoss) for measure in measures)


def design_in_cases(
    scene: ShaftScene, oily: bool, table: Table
) -> tuple[ShaftDesign, ShaftCases]:
    """Return the design of a system of shafts in its first load case, and all cases.

    Args:
        scene: The scene.
        oily: Whether the friction of bearings is wanted, which needs their oils.
        table: Table that asks, for errors.

    Raises:
        SceneError: For a system with [heat], and without the oils that are needed.
    """
    if scene.heat is not None:
        problem = "does not go with [heat]; give the temperatures that it finds"
        raise table.own_error(problem)
    each = scene.cases or (scene,)
    hours = [one.hours for one in each]
    with table.building():
        return load_cases(
            [_design(one, oily, table) for one in each],
            None if None in hours else hours,
        )


def _design(scene: ShaftScene, oily: bool, table: Table) -> ShaftDesign:
    """Return the design of one case, with oils if the friction is wanted."""
    lives, oils = [], []
    turning = scene.system.inertia is not None
    for seat, alone in zip(scene.system.seats, scene.bearings, strict=True):
        oil = None if alone is None else alone.oil
        if alone is None:
            lives.append(None)
        else:
            lives.append(life_conditions(alone, turning))
        if alone is None or oil is None:
            if oily and alone is not None:
                problem = "power_loss needs a [lubricant], or one of each bearing;"
                raise table.own_error(f"{problem} {seat.name} has none")
            oils.append(None)
        else:
            oils.append(bearing_oil(alone, oil, oil.temperature))
    return ShaftDesign(scene.system, tuple(lives), tuple(oils) if oily else None)


def shaft_measure(
    keys: ShaftOptimiseKeys | ShaftConstraintKeys,
    key: str,
    scene: ShaftScene,
    exponent: float,
) -> Any:
    """Return the measure that a table names.

    Args:
        keys: Keys of the table.
        key: Key that names it.
        scene: The scene.
        exponent: Exponent of smooth maxima.
    """
    table, kind, of, system = keys.table, getattr(keys, key), keys.of, scene.system
    if kind in ("system_life", "rating_life", "power_loss") and system.inertia is None:
        raise table.error(key, f"{kind} needs a `speed` of the drive")
    bearings = [seat.name for seat in system.seats if seat.installed is not None]
    gears = [wheel.name for wheel in system.wheels if isinstance(wheel, Gear)]
    names = {"misalignment": gears}.get(kind, bearings)
    if kind in _OF_SYSTEM and of is not None:
        problem = f"goes with {', '.join((*_OF_BEARINGS, 'misalignment'))}"
        raise table.error("of", f"{problem}; {kind} is of the whole system")
    if of is not None and of not in names:
        raise table.error("of", not_among(of, names))
    if not names and kind not in ("power_loss", "mass"):
        problem = "needs a gear" if kind == "misalignment" else "needs a bearing"
        raise table.error(key, f"{kind} {problem}; the system has none")
    if kind in _OF_SYSTEM:
        return _OF_SYSTEM[kind]()
    with table.building():
        return Worst(kind, of, exponent=exponent)


def shaft_numbers(scene: ShaftScene) -> dict[str, tuple[str, ...]]:
    """Return the design numbers by scene key, with their paths in `ShaftDesign`."""
    return dict(_numbers(scene))


def _numbers(scene: ShaftScene) -> Iterator[tuple[str, tuple[str, ...]]]:
    system = scene.system
    for k, (seat, alone) in enumerate(zip(system.seats, scene.bearings, strict=True)):
        head, own = f"bearings.{seat.name}", f"system.seats.{k}"
        for name in ("position", "preload", "axial_offset"):
            if getattr(seat, name) is not None:
                yield f"{head}.{name}", (f"{own}.{name}",)
        if alone is not None:
            for key, paths in installed_numbers(alone).items():
                within = tuple(f"{own}.installed.{path}" for path in paths)
                yield f"{head}.{key.removeprefix('bearing.')}", within
    for k, line in enumerate(system.shafts):
        for segment in range(np.size(line.length)):
            for name in ("length", "outer_diameter", "bore"):
                key = f"shaft.{line.name}.segments.{segment}.{name}"
                yield key, (f"system.shafts.{k}.{name}.{segment}",)
    for k, wheel in enumerate(system.wheels):
        head = f"{'gear' if isinstance(wheel, Gear) else 'belt'}.{wheel.name}"
        for name in design_numbers(wheel):
            if name not in _GIVEN:
                several = _meshing(system, k) if name in _SHARED else [k]
                paths = tuple(f"system.wheels.{one}.{name}" for one in several)
                yield f"{head}.{name}", paths


def _meshing(system: ShaftSystem, index: int) -> list[int]:
    """Return the numbers of all wheels that mesh with one, or with its mates."""
    names, found = [wheel.name for wheel in system.wheels], {index}
    while True:
        more = set(found)
        for k, wheel in enumerate(system.wheels):
            mate = wheel.mates_with
            pair = {k, names.index(mate)} if mate is not None else {k}
            more |= pair if pair & found else set()
        if more == found:
            return sorted(found)
        found = more

"""The [optimise] table of a scene: variables, objective and constraints."""

import dataclasses
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ...cases.cases import Cases
from ...cases.spectrum import relative_speed
from ...design import BearingSet, rows_of
from ...element import FREEDOMS, BearingElement
from ...files.quantity import SceneError, kind_of, scene_number
from ...files.scene_file import assign, find_scene, parse_bearing
from ...files.schema import Keys, key_of, names_key, read_keys, scene_key
from ...files.table import Table, not_among
from ...fits.fits import WARM_PARTS
from ...numerics.units import unit_of
from ...optimise import SearchOptions
from ...optimise.constraint import Constraint
from ...optimise.life import RatingLife, StaticSafety
from ...optimise.measure import (
    Displacement,
    EdgeLoad,
    MeanPressure,
    OperatingClearance,
    OperatingPreload,
    PeakPressure,
    Stiffness,
    StiffnessTarget,
)
from ...optimise.search import METHODS
from ...optimise.smooth import SMOOTHING_EXPONENT
from ...optimise.variable import Variable, check_variables, design_numbers
from ...statics.preload import is_opposed
from ..bearing.life_ratings import life_conditions
from ..bearing.read_design import PITCH_FOLLOWS, pitch_follows
from ..bearing.read_fit import no_expansion, read_temperature
from ..bearing.read_scene import Scene, with_speed_warnings
from ..cases.case_keys import read_raw
from ..cases.designs import makes_design
from ..cases.read_cases import case_table

OBJECTIVES = (
    "peak_pressure",
    "mean_pressure",
    "edge_load",
    "displacement",
    "stiffness",
    "rating_life",
)

MEASURES = (*OBJECTIVES, "clearance", "preload", "static_safety")
"""What may be bounded."""

OF_FITS = (
    "shaft_interference",
    "housing_interference",
    "shaft_bore",
    "housing_diameter",
    "drive_up",
)
"""Numbers of a [fit] that may be variables."""

WARMTH = {f"temperature.{part}": part for part in WARM_PARTS}
"""Temperatures that may be variables in addition to a [fit]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SearchTask:
    """Search that [optimise] asks for, of a bearing or of shafts, as in `optimise`.

    Attributes:
        variables: The variables, named as in the scene.
        objective: Measure to be minimised.
        constraints: Bounds on measures.
        method: Search method, or `None` for the default.
        max_steps: Step limit.
        tolerance: Gradient at which the search ends.
        inputs: The scene as it was read, all quantities in SI (`Scene.inputs`).
    """

    variables: tuple[Variable, ...]
    objective: Any
    constraints: tuple[Constraint, ...]
    method: str | None
    max_steps: int
    tolerance: float
    inputs: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Optimisation(SearchTask):
    """Optimisation task of the scene of a bearing.

    Attributes:
        scene: The scene without [optimise].
        cases: Its operating cases; without [cases] the one of [operating].
    """

    scene: Scene
    cases: Cases


_WARMER = 100.0
"""A larger difference of temperatures was written as one, in °C [K]."""
OF_FREEDOM = ("displacement", "stiffness")
"""Objectives that refer to one freedom."""
_QUANTITY: dict[str, Any] = {"type": "string"}


def _freedom(of: str) -> Any:
    return scene_key(
        "freedom of the displacement or stiffness",
        choices=FREEDOMS[:5],
        only={of: OF_FREEDOM},
    )


def _bound(end: str) -> Any:
    about = f"{end} bound, in the unit of the measure; of `static_safety` a bare number"
    both = {"anyOf": [_QUANTITY, {"type": "number"}]}
    return scene_key(about, default=None, reader=read_raw, json=both)


class BoundKeys(Keys):
    about = "[[optimise.constraints]]: a bound on a measure"

    measure: str
    at_least: Any = _bound("lower")
    at_most: Any = _bound("upper")

    def check(self) -> None:
        if self.at_least is None and self.at_most is None:
            problem = "give `at_least`, `at_most` or both"
            raise self.table.error("measure", problem)

    def constraint(self, measure: Any, kind: str) -> Constraint:
        """Build the constraint.

        Args:
            measure: What is bounded.
            kind: Kind of its quantity; empty for a pure number.
        """
        table = self.table
        ends = [table.quantity(key, kind, None) for key in ("at_least", "at_most")]
        if None not in ends and not ends[0] < ends[1]:
            low, high = (scene_number(x, kind) for x in ends)
            raise table.error("at_least", f"{low} must lie below `at_most`, {high}")
        with table.building():
            return Constraint(measure, *ends)


class ConstraintKeys(BoundKeys):
    measure: str = scene_key("what is bounded", choices=MEASURES)
    freedom: str | None = _freedom("measure")


class SearchKeys(Keys):
    about = "[optimise]: variables and the search for the best design"

    objective: str
    exponent: float = scene_key(
        "of the norm that stands for a maximum over rolling elements and cases",
        default=SMOOTHING_EXPONENT,
    )
    variables: Any = names_key(
        "free numbers by their key in the scene, in quotes: `{ from, to, start }`"
    )
    constraints: tuple[Any, ...]
    method: str | None = scene_key(
        "search", choices=METHODS, otherwise="by the constraints and variables"
    )
    max_steps: int = key_of(SearchOptions, "max_steps")
    tolerance: float = key_of(SearchOptions, "tolerance", above=0, below=0.1)

    def check(self) -> None:
        if self.constraints and self.method not in (None, "slsqp"):
            problem = f'{self.method!r} keeps no constraints; take "slsqp" or leave it'
            raise self.table.error("method", f"{problem} out")


class OptimiseKeys(SearchKeys):
    about = "[optimise]: variables, objective and constraints"

    objective: str = scene_key(
        "what is made least; a life in hours is made largest", choices=OBJECTIVES
    )
    freedom: str | None = _freedom("objective")
    target: Any = scene_key(
        "stiffness that is wanted, with its unit",
        default=None,
        only={"objective": ("stiffness",)},
        reader=read_raw,
        json=_QUANTITY,
    )
    constraints: tuple[ConstraintKeys, ...] = scene_key(
        "bounds on measures", default=()
    )


def read_bearing_optimisation(
    source: str | Path, settings: Iterable[str] = ()
) -> Optimisation:
    """Read the scene of a bearing with [optimise].

    Args, raises: as `read_scene`.
    """
    path = find_scene(source)
    data = parse_bearing(path, settings)
    check_present(data, path)
    begun = _start_values(data)
    for key, value in begun.items():
        assign(data, key, value, path.name)
    top, scene, cases, inputs = read_operated(data, path, "[optimise] finds one")
    table = top.table("optimise")
    task = _optimisation(top, table, scene, cases, set(begun))
    table.finish()
    inputs = {**inputs, "optimise": table.echo()}
    return dataclasses.replace(task, inputs=inputs)


def read_operated(
    data: dict[str, Any], path: Path, problem: str
) -> tuple[Table, Scene, Cases, dict[str, Any]]:
    """Read a bearing and its operating cases; without [cases] the one of [operating].

    Args:
        data: The scene, parsed.
        path: Its path.
        problem: What is wrong about cases that vary the design.

    Returns:
        The scene's table, the scene, its cases of this one design, and its inputs.
    """
    top, listed = Table(data, path), case_table(data, path)
    scene, cases = listed.scene, listed.cases
    if makers := [key for key in listed.varied if makes_design(key)]:
        words = f"{', '.join(makers)} vary the design; {problem}"
        raise top.error("cases", words)
    if not (cases.viscosity is None is cases.oscillation):
        words = "vary the oil or oscillate, which `life` and `sweep` alone know"
        raise top.error("cases", words)
    # On its seats a bearing has the clearance at the speeds of each case.
    cases = dataclasses.replace(cases, design=None)
    scene = with_speed_warnings(scene, relative_speed(cases))
    return top, scene, cases, listed.inputs


def check_present(data: dict[str, Any], path: Path) -> None:
    """Raise SceneError unless a scene has [optimise]."""
    if "optimise" not in data:
        raise SceneError(
            f"{path.name}: `optimise` is missing; it must be a table that names"
            " `objective` and `variables`"
        )


def _start_values(data: dict[str, Any]) -> dict[str, Any]:
    """Return start values of the variables of [fit] that the table does not give: an
    optimised interference needs neither a value nor a tolerance class there."""
    fit, table = data.get("fit"), data["optimise"]
    free = table.get("variables") if isinstance(table, dict) else None
    found: dict[str, Any] = {}
    if not (isinstance(fit, dict) and isinstance(free, dict)):
        return found
    for name in OF_FITS:
        ends = free.get(f"fit.{name}")
        stands = {name, name.removesuffix("_interference")} & set(fit)
        if isinstance(ends, dict) and "from" in ends and not stands:
            found[f"fit.{name}"] = ends.get("start", ends["from"])
    return found


def _optimisation(
    top: Table, table: Table, scene: Scene, cases: Cases, begun: set[str]
) -> Optimisation:
    keys = read_keys(OptimiseKeys, table)
    with table.building():
        PeakPressure(exponent=keys.exponent)
    measured = Measured(scene, cases, keys.exponent)
    objective = measured.objective(keys)
    table.table("variables", required=True)
    check_numbers(keys.variables, top, scene)
    numbers = installed_numbers(scene)
    return Optimisation(
        scene=scene,
        cases=cases,
        variables=read_variables(keys.variables, scene.installed, numbers, begun),
        objective=objective,
        constraints=tuple(measured.constraint(one) for one in keys.constraints),
        method=keys.method,
        max_steps=keys.max_steps,
        tolerance=keys.tolerance,
    )


def scene_numbers(element: BearingElement[Any]) -> dict[str, tuple[str, ...]]:
    """Return the design numbers by their scene key, with their paths in the element.

    Args:
        element: The bearing; a key applies to all rows of a set.
    """
    row = rows_of(element.bearing)[0].bearing
    in_set = isinstance(element.bearing, BearingSet)
    rows = range(len(element.bearing.rows)) if in_set else ()
    heads = [f"bearing.rows.{k}.bearing" for k in rows] or ["bearing"]
    found: dict[str, tuple[str, ...]] = {}
    for name in design_numbers(row):
        # The rows of a self-aligning bearing are staggered.
        if name == "first_azimuth" and in_set:
            continue
        paths = tuple(f"{head}.{name}" for head in heads)
        head, _, rest = name.partition(".")
        if head.endswith("_raceway_profile"):
            head = f"raceway_profile.{head.removesuffix('_raceway_profile')}"
        key = f"bearing.{head}.{rest}" if rest else f"bearing.{head}"
        found[key] = paths
        if head == "ribs":
            common = f"bearing.rib.{rest.partition('.')[2]}"
            found[common] = (*found.get(common, ()), *paths)
    return found


def installed_numbers(scene: Scene) -> dict[str, tuple[str, ...]]:
    """Return the numbers of a bearing in its place by their scene key, with their paths
    in `Scene.installed`.
    """
    numbers = {
        key: tuple(f"drawing.{path}" for path in paths)
        for key, paths in scene_numbers(scene.element).items()
    }
    if scene.preload_force is not None:
        numbers["set.preload_force"] = ("preload",)
    if scene.fits is not None:
        numbers |= {f"fit.{name}": (f"mounting.{name}",) for name in OF_FITS}
        numbers |= {key: (f"conditions.{part}",) for key, part in WARMTH.items()}
    return numbers


def check_numbers(table: Table, top: Table, scene: Any) -> None:
    """Raise SceneError for numbers that may not be changed alone: a search would hold
    a left-out pitch diameter that follows from them, and a part of unknown expansion
    has no temperature.

    Args:
        table: The numbers, by their key in the scene.
        top: The scene.
        scene: The same as it was read, of a bearing or a machine.
    """
    places = [("", top, top.table("bearing"), scene)]
    if not isinstance(scene, Scene):
        tables = top.table("bearings")
        named = {name: tables.table(name) for name in tables.keys()}
        places = [
            (f"bearings.{name}.", own, own, bearings_of_machine(scene).get(name))
            for name, own in named.items()
        ]
    for key in table.keys():
        for head, fitted, bearing, one in places:
            name = key.removeprefix(head)
            own = name.removeprefix("bearing.")
            if not key.startswith(head) or one is None:
                continue
            if own in PITCH_FOLLOWS and pitch_follows(bearing):
                where = head.rstrip(".") or "bearing"
                problem = (
                    "the pitch diameter follows from it and `outer_raceway_radius` in"
                    f" this scene, and would be held; give [{where}]"
                    " `pitch_diameter` in place of `outer_raceway_radius`, which then"
                    " follows"
                )
                raise table.error(key, problem)
            unknown = {} if one.fits is None else one.fits.unknown
            warm = WARMTH.get(name)
            if warm is not None and warm in unknown:
                place = fitted.table("fit")
                raise no_expansion(place, warm, f"{head}bearing.{unknown[warm]}")


def bearings_of_machine(scene: Any) -> dict[str, Scene]:
    """Return the bearings of a system of shafts, or of a rotor, by name."""
    if hasattr(scene, "mounts"):
        pairs = [(mount.name, mount.scene) for mount in scene.mounts]
    else:
        names = [seat.name for seat in scene.system.seats]
        pairs = [*zip(names, scene.bearings, strict=True)]
    return {name: one for name, one in pairs if one is not None}


def read_number(table: Table, key: str, unit: str, *default: float | None) -> Any:
    """Read a number of a design in SI; of a temperature within the range of bearings.

    Args:
        table: Table that holds the key.
        key: Key in the table.
        unit: Its SI unit.
        default: Value if absent; without a default the key is required.
    """
    if unit == "K":
        return read_temperature(table, key, *default)
    return table.quantity(key, kind_of(unit), *default)


def read_spread(table: Table, key: str, unit: str, *default: float | None) -> Any:
    """Read a deviation or width of a number, above 0; of a temperature a difference.

    Args: as `read_number`.
    """
    value = table.quantity(key, kind_of(unit), *default)
    if value is not None and not value > 0.0:
        raise table.error(key, f"{table.raw(key)} is not above 0")
    if unit == "K" and value is not None and value > _WARMER:
        raise table.error(key, "is a difference; write it in K")
    return value


def check_inside(
    table: Table, unit: str, key: str, value: float | None, low: float, high: float
) -> None:
    """Raise SceneError unless `from` lies below `to`, and a number between them.

    Args:
        table: Table that holds `from`, `to` and the key.
        unit: SI unit of the numbers.
        key: Key of the number that must lie between them.
        value: Its value [SI]; `None` if it is absent.
        low, high: Values of `from` and `to` [SI].
    """
    first, last = (scene_number(x, kind_of(unit)) for x in (low, high))
    if not low < high:
        raise table.error("from", f"{first} must lie below `to`, {last}")
    if value is not None and not low <= value <= high:
        ends = f"must lie between `from`, {first}, and `to`, {last}"
        raise table.error(key, f"{scene_number(value, kind_of(unit))} {ends}")


def check_shared(table: Table, key: str, design: Any, paths: Iterable[str]) -> None:
    """Raise SceneError if a number has several values, which one would make alike.

    Args:
        table: Table that names it.
        key: Its key.
        design: The design.
        paths: Its paths in the design.
    """
    there = design_numbers(design, entries=True)
    values = sorted({float(there[path]) for path in paths})
    if len(values) > 1:
        unit = unit_of(design, next(iter(paths)))
        words = [scene_number(x, kind_of(unit)) for x in values]
        problem = f"has several values in this scene, {', '.join(words)}; one number"
        raise table.error(key, f"{problem} would make them alike")


def read_variables(
    table: Table,
    design: Any,
    numbers: dict[str, tuple[str, ...]],
    begun: Collection[str] = (),
) -> tuple[Variable, ...]:
    """Read the free numbers of a design.

    Args:
        table: `[optimise.variables]`.
        design: The design.
        numbers: Its numbers by their scene key, with their paths in it.
        begun: Keys that start in the middle of their range unless a start is given.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    variables, ends = [], {"lower": "from", "upper": "to"}
    for key in table.keys():
        if key not in numbers:
            raise table.error(key, _no_number(key, table, numbers))
        check_shared(table, key, design, numbers[key])
        part = table.table(key)
        unit = unit_of(design, numbers[key][0])
        low, high = (read_number(part, word, unit) for word in ("from", "to"))
        start = read_number(part, "start", unit, None)
        if start is None and key in begun and unit != "K":
            start = 0.5 * (low + high)
        check_inside(part, unit, "start", start, low, high)
        with part.building(**ends):
            variables.append(Variable(numbers[key], low, high, start, key))
    with table.building(**ends):
        check_variables(design, variables)
    return tuple(variables)


def _no_number(key, table, numbers):
    if isinstance(table.raw(key), Mapping) and "from" not in table.raw(key):
        example = next(iter(numbers))
        return f'write the dotted key in quotes, such as "{example}" = {{from, to}}'
    near, head = tuple(numbers), key
    while "." in head:
        head = head.rpartition(".")[0]
        if inner := [name for name in numbers if name.startswith(f"{head}.")]:
            near = tuple(inner)
            break
    return not_among(key, near)


_OPERATING = {"clearance": OperatingClearance, "preload": OperatingPreload}
_LARGEST = {
    "peak_pressure": PeakPressure,
    "mean_pressure": MeanPressure,
    "edge_load": EdgeLoad,
}


class Measured(NamedTuple):
    """What can be measured of the bearing of a scene.

    Attributes:
        scene: The scene.
        cases: Its operating cases.
        exponent: Exponent of smooth maxima.
    """

    scene: Scene
    cases: Cases
    exponent: float

    def objective(self, keys: OptimiseKeys) -> Any:
        """Build the objective."""
        if keys.objective != "stiffness":
            return self.measure(keys, "objective")
        kind = kind_of_measure(self.measure(keys, "objective"))
        wanted = keys.table.quantity("target", kind)
        with keys.table.building():
            return StiffnessTarget(wanted, keys.freedom or "")

    def constraint(self, keys: ConstraintKeys) -> Constraint:
        """Build a bound on a measure."""
        measure = self.measure(keys, "measure")
        return keys.constraint(measure, kind_of_measure(measure))

    def measure(self, keys: OptimiseKeys | ConstraintKeys, key: str) -> Any:
        """Build the measure that a key of a table names."""
        kind, bearing = getattr(keys, key), self.scene.element.bearing
        still = self.cases.inner_speed is None and self.cases.outer_speed is None
        problem = ""
        if kind == "rating_life" and still:
            problem = "rating_life is in hours: it needs a speed in [operating]"
        if kind == "edge_load" and bearing.is_ball:
            problem = "balls have no ends; `edge_load` is for rollers"
        if kind == "preload" and not is_opposed(bearing):
            problem = "preload is between rows that press each other; there are no such"
            problem += " rows"
        if problem:
            raise keys.table.error(key, problem)
        if kind == "rating_life":
            return RatingLife(life_conditions(self.scene), True)
        if kind == "static_safety":
            return StaticSafety(life_conditions(self.scene, False))
        if kind in _OPERATING:
            return _OPERATING[kind]()
        if kind in _LARGEST:
            return _LARGEST[kind](exponent=self.exponent)
        freedom = keys.freedom or keys.table.choice("freedom", FREEDOMS[:5])
        of = Displacement if kind == "displacement" else Stiffness
        return of(freedom, exponent=self.exponent)


def kind_of_measure(measure: Any) -> str:
    """Return the kind of quantity of a measure; empty for a pure number.

    Args:
        measure: From `Measured`.
    """
    if not measure.unit:
        return ""
    if isinstance(measure, EdgeLoad):
        return "line load"
    if isinstance(measure, RatingLife):
        return "duration"
    tilting = isinstance(measure, Stiffness) and measure.unit == "N m"
    return "tilting stiffness" if tilting else kind_of(measure.unit)

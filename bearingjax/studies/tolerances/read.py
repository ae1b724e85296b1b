"""Reader of [tolerances] of a scene: numbers that scatter, measures, requirements."""

import dataclasses
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from ...cases.spectrum import relative_speed
from ...decide import NoiseLevel, Scatter, class_scatters, truncated_normal
from ...decide.noise_design import TOTAL
from ...decide.scatter import SIZES
from ...files.quantity import SceneError
from ...files.scene_file import find_scene, is_shafts, parse_scene
from ...files.schema import Keys, names_key, read_keys, scene_key
from ...files.table import Table, not_among
from ...numerics.units import unit_of
from ...optimise import Constraint
from ...optimise.measure import label_of
from ...optimise.smooth import SMOOTHING_EXPONENT
from ...optimise.variable import with_numbers
from ...statics.support import Support
from ..bearing.life_ratings import life_conditions
from ..bearing.read_scene import Scene
from ..optimise.noise_numbers import noise_design
from ..optimise.read_optimise import (
    MEASURES,
    ConstraintKeys,
    Measured,
    check_inside,
    check_numbers,
    check_shared,
    installed_numbers,
    kind_of_measure,
    read_number,
    read_operated,
    read_spread,
)
from ..optimise.read_shaft_optimise import (
    ShaftConstraintKeys,
    design_in_cases,
    has_power,
    shaft_measure,
    shaft_numbers,
)
from ..shaft.read import ShaftScene, read_shafts

NOISE = "noise_level"
SHAPES = ("normal", "uniform")
"""Shapes of the distribution of a number."""


class Unbound:
    """Keys of a measure that may stand without a bound."""

    about = "[[tolerances.measures]]: a measure, with a bound if it is a requirement"

    def check(self) -> None:
        """Accept a measure without a bound."""


class MeasureKeys(Unbound, ConstraintKeys):
    measure: str = scene_key("what is evaluated", choices=(*MEASURES, NOISE))
    reading: str | None = scene_key(
        "level on the noise rig of [vibration], of first order in the form errors:"
        " `total_level`, a band such as `band_1000`, or a line such as `line_2_BPFO`",
        only={"measure": (NOISE,)},
        otherwise="`total_level`",
    )


class ShaftMeasureKeys(Unbound, ShaftConstraintKeys):
    """Keys of a measure of a system of shafts."""


class CorrelationKeys(Keys):
    about = "[[tolerances.correlations]]: correlation of two numbers that scatter"

    between: tuple[str, ...] = scene_key("the two numbers, by their keys in `numbers`")
    value: float = scene_key("correlation coefficient", above=-1, below=1)


class TightenKeys(Keys):
    about = "[tolerances.tighten]: search for the cheapest narrower tolerances"

    most_misses: float = scene_key(
        "largest share that may fail a requirement", above=0, most=0.99
    )
    narrowest: float = scene_key(
        "smallest width over the given one", default=0.2, above=0, below=1
    )


class SharedKeys(Keys):
    about = "[tolerances]: distributions of numbers, and measures of the results"

    samples: int = scene_key("smallest number of samples", default=10_000, most=10**6)
    seed: int = scene_key("seed of the samples", default=0, least=0)
    scattered: Any = names_key(
        "numbers that scatter, by their key in the scene, in quotes: `{ from, to }`,"
        " `{ mean, deviation }` (standard deviation) or both, `shape` (normal or"
        " uniform), `narrowing = { by, costs }`; sizes with a tolerance or clearance"
        f" class scatter without it: {', '.join(f'`fit.{name}`' for name in SIZES)}",
        default=None,
        name="numbers",
    )
    correlations: tuple[CorrelationKeys, ...] = scene_key(
        "correlations of numbers that scatter", default=()
    )
    tighten: TightenKeys | None = scene_key("search for narrower tolerances")


class ToleranceKeys(SharedKeys):
    measures: tuple[MeasureKeys, ...] = scene_key("measures and requirements")


class ShaftToleranceKeys(SharedKeys):
    measures: tuple[ShaftMeasureKeys, ...] = scene_key("measures and requirements")


@dataclasses.dataclass(frozen=True)
class ToleranceTask:
    """Arguments of `decide.tolerances` by [tolerances] of a scene.

    Attributes:
        scene: The scene, of a bearing or of shafts.
        given: Design, cases, scatters and measures.
        units: SI unit of each number that scatters.
        options: Samples, seed, correlation, support and numerics, by keyword.
        tighten: Keys of the search for narrower tolerances; `None`: not asked for.
        inputs: The scene as it was read, all quantities in SI.
    """

    scene: Scene | ShaftScene
    given: tuple[Any, Any, tuple[Scatter, ...], tuple[Any, ...]]
    units: tuple[str, ...]
    options: dict[str, Any]
    tighten: TightenKeys | None
    inputs: dict[str, Any] = dataclasses.field(repr=False)


def read_tolerances(source: str | Path, settings: Iterable[str] = ()) -> ToleranceTask:
    """Read a scene with [tolerances], of a bearing or of a system of shafts.

    Args, raises: as `read_scene`.
    """
    settings = tuple(settings)
    path = find_scene(source)
    data = parse_scene(path, settings)
    if "tolerances" not in data:
        problem = "`tolerances` is missing; it must be a table that names `measures`"
        raise SceneError(f"{path.name}: {problem}")
    if is_shafts(data):
        scene: Any = read_shafts(source, settings)
        top, inputs = Table({"tolerances": data["tolerances"]}, path), scene.inputs
        table = top.table("tolerances")
        keys = read_keys(ShaftToleranceKeys, table)
        measures = [
            shaft_measure(one, "measure", scene, SMOOTHING_EXPONENT)
            for one in keys.measures
        ]
        whole: Any = design_in_cases(scene, has_power(measures), table)
        design, cases = whole
        numbers = shaft_numbers(scene)
        places = [
            (f"bearings.{seat.name}.", f"system.seats.{k}.installed.", seat.installed)
            for k, seat in enumerate(scene.system.seats)
            if seat.installed is not None
        ]
    else:
        problem = "[tolerances] are those of one"
        top, scene, cases, inputs = read_operated(data, path, problem)
        table = top.table("tolerances")
        keys = read_keys(ToleranceKeys, table)
        measured = Measured(scene, cases, SMOOTHING_EXPONENT)
        design, numbers = scene.installed, installed_numbers(scene)
        places = [("", "", scene.installed)]
        if any(one.measure == NOISE for one in keys.measures):
            top.table("vibration", required=True)
            rig, design, numbers = noise_design(data, path)
            with table.building():
                design.check(cases)
            places = [("", "installed.", scene.installed)]
            inputs = {**rig.inputs, **inputs}
        measures = [
            _level(one, design)
            if one.measure == NOISE
            else measured.measure(one, "measure")
            for one in keys.measures
        ]
    labels = [label_of(one) for one in measures]
    for k, one in enumerate(keys.measures):
        if labels[k] in labels[:k]:
            problem = "is asked twice; give `at_least` and `at_most` of it together"
            raise one.table.error("measure", f"{labels[k]} {problem}")
    sizes = {}
    for head, own, bearing in places:
        fit = Table(data, path)
        for name in (*head.split(".")[:-1], "fit"):
            fit = fit.table(name)
        if fit.raw("at", "middle") != "middle":
            problem = "stands beside [tolerances], in which these sizes scatter"
            raise fit.error("at", f"{problem}; leave it out")
        bearing, scatters = class_scatters(bearing)
        design = with_numbers(design, {own.removesuffix("."): bearing})
        sizes |= {
            f"{head}fit.{s.name}": ({f"{own}{p}": f for p, f in s.path.items()}, s.ends)
            for s in scatters
        }
    check_numbers(table.table("numbers"), Table(data, path), scene)
    scatters = _scatters(table.table("numbers"), design, numbers, sizes)
    if not scatters:
        problem = "name one at least: no size of this scene has a tolerance class"
        raise table.error("numbers", problem)
    asked = tuple(
        measure
        if (one.at_least, one.at_most) == (None, None)
        else one.constraint(measure, kind_of_measure(measure))
        for one, measure in zip(keys.measures, measures, strict=True)
    )
    if keys.tighten is not None:
        if not any(isinstance(one, Constraint) for one in asked):
            problem = "needs `at_least` or `at_most` of a measure"
            raise table.error("tighten", problem)
        if all(one.cost is None for one in scatters):
            problem = "needs `narrowing = { by, costs }` of one number at least"
            raise table.error("tighten", problem)
    options: dict[str, Any] = {"samples": keys.samples, "seed": keys.seed}
    options["correlation"] = _correlation(keys.correlations, [s.name for s in scatters])
    if isinstance(scene, Scene):
        options["support"] = Support(scene.free, fixed_ring=scene.fixed_ring)
        options["solve"] = scene.solve_options
        if scene.life is not None:
            options["life"] = life_conditions(scene, bool(relative_speed(cases).any()))
    table.finish()
    return ToleranceTask(
        scene,
        (design, cases, scatters, asked),
        tuple(unit_of(design, next(iter(one.path))) for one in scatters),
        options,
        keys.tighten,
        {**inputs, "tolerances": table.echo()},
    )


def _level(keys: MeasureKeys, design: Any) -> NoiseLevel:
    known, asked = design.readings(), keys.reading or TOTAL
    if asked not in known:
        raise keys.table.error("reading", not_among(asked, [*known]))
    return NoiseLevel(asked)


def _correlation(pairs: Iterable[CorrelationKeys], names: list[str]) -> np.ndarray:
    found, told = np.eye(len(names)), list[set[str]]()
    for one in pairs:
        for name in one.between:
            if name not in names:
                raise one.table.error("between", not_among(name, names))
        told.append(set(one.between))
        if len(told[-1]) != 2 or told[-1] in told[:-1]:
            raise one.table.error("between", "must name two numbers, a pair once")
        i, j = map(names.index, one.between)
        found[i, j] = found[j, i] = one.value
        if np.linalg.eigvalsh(found)[0] <= 0.0:
            problem = "contradicts the correlations before it: no numbers have them all"
            raise one.table.error("value", problem)
    return found


def _scatters(
    table: Table,
    design: Any,
    numbers: Mapping[str, tuple[str, ...]],
    sizes: Mapping[str, Any],
) -> tuple[Scatter, ...]:
    """Read the numbers that scatter; sizes with a class do so without being named."""
    found = []
    for key in dict.fromkeys((*sizes, *table.keys())):
        if key in sizes:
            paths, limits = sizes[key]
        elif key in numbers:
            check_shared(table, key, design, numbers[key])
            paths, limits = dict.fromkeys(numbers[key], 1.0), None
            for one in found:
                if one.name in numbers and set(one.path) & set(paths):
                    raise table.error(key, f"is the same number as {one.name}")
            for size, (others, _) in sizes.items():
                own = size.removesuffix("fit.clearance")
                same = own != size and key.startswith(own)
                same &= key.endswith("internal_clearance")
                if set(others) & set(paths) or same:
                    problem = f"stands beside the class of {size}, which scatters; name"
                    raise table.error(key, f"{problem} that, or give no class")
        else:
            raise table.error(key, not_among(key, (*sizes, *numbers)))
        found.append(_scatter(table.table(key), key, paths, limits, design))
    return tuple(found)


def _scatter(part: Table, key: str, paths, limits, design) -> Scatter:
    unit = unit_of(design, next(iter(paths)))
    low, high, mean = (
        read_number(part, word, unit, None) for word in ("from", "to", "mean")
    )
    deviation = read_spread(part, "deviation", unit, None)
    own: Any = (None, None) if limits is None else limits
    low, high = (o if x is None else x for x, o in zip((low, high), own, strict=True))
    if (low is None) != (high is None):
        raise part.error("from" if low is None else "to", "is missing beside the other")
    if low is None and None in (mean, deviation):
        raise part.own_error("give `from` and `to`, or `mean` and `deviation`")
    if low is not None:
        check_inside(part, unit, "mean", mean, low, high)
    cost, narrowing = None, part.table("narrowing")
    if narrowing.keys():
        by, costs = read_spread(narrowing, "by", unit), narrowing.number("costs")
        if not costs > 0.0:
            raise narrowing.error("costs", "must be above 0")
        cost = costs / by
    if part.choice("shape", SHAPES, "normal") == "uniform":
        if low is None or (mean, deviation) != (None, None):
            problem = "has `from` and `to` alone, without `mean` and `deviation`"
            raise part.error("shape", f"a uniform one {problem}")
        distribution = stats.uniform(low, high - low)
    elif low is None:
        distribution = stats.norm(mean, deviation)
    else:
        distribution = truncated_normal(low, high, mean, deviation)
    return Scatter(paths, distribution, key, cost)

"""An optimised design as text, and as numbers in SI."""

from typing import Any

import numpy as np

from ...numerics.units import CELSIUS, display_unit, shown_count, unit_of
from ...numerics.warning import Warning, warnings_of
from ...optimise import EdgeLoad, OptimisedDesign, Outcome
from ...optimise.measure import AbstractMeasure, label_of
from ...report.json_output import run_json
from ...report.report_model import Column, Grid, Report
from ..bearing.read_scene import Scene
from ..solve.output import fits_json
from ..solve.report import fits_section
from .read_optimise import Optimisation
from .read_shaft_optimise import ShaftOptimisation
from .scene_of_design import scene_of_design

Task = Optimisation | ShaftOptimisation
_STIFFNESSES = {"N/m": (1e-6, "kN/mm"), "N m": (1e-3, "N m/mrad")}


def optimisation_report(task: Task, found: OptimisedDesign, best: Any = None) -> Report:
    """Return the readable report of the design before and after.

    Args:
        task: The optimisation task.
        found: Its result, converged.
        best: Scene of the best design; `None`: from `scene_of_design`.
    """
    best = scene_of_design(task, found.element) if best is None else best
    cases = found.cases.count
    head = (
        f"{task.scene.name}: optimised over {shown_count(cases, 'operating case')} in"
        f" {shown_count(len(found.history.objective) - 1, 'step')},\n"
        f"{shown_count(found.n_evaluations, 'design')} evaluated,"
        f" {found.n_gradients} with gradient, {len(found.rejected)} rejected"
    )
    every = dict.fromkeys(found.rejected)
    warned = [Warning("rejected_step", f"rejected: {why}") for why in every]
    warned += [*best.warnings, *found.after.warnings]
    warned += warnings_of("before", _warned_before(task, found))
    left = f"gradient left {found.optimality:.1e}, tolerance {task.tolerance:.1e}"
    sections = {
        "Search": [head],
        "Variables": [_variables(found)],
        "Measures": [_measures(found)],
        **_details(found, best),
        "Solution": [f"converged: {found.message}; {left}"],
    }
    return Report(sections, warned)


def _details(found, best) -> dict[str, Any]:
    """Return the sections of the bearings."""
    if isinstance(best, Scene):
        return {
            "Peak pressures": [_pressures(found)],
            "Fits of the best design": fits_section(best),
        }
    facts = bearing_facts(found)
    names = [seat.name for seat in best.system.seats]
    columns = [Column("bearing", names)]
    for key, (word, unit, form) in _SHOWN_FACTS.items():
        for side in ("before", "after"):
            head = f"{word} before" if side == "before" else "after"
            columns.append(Column(head, facts[key][side], unit, form))
    return {"Bearings": [Grid(columns)]}


_SHOWN_FACTS = {
    "rating_life": ("life", "h", ".5g"),
    "peak_pressure": ("peak pressure", "Pa", ".1f"),
    "static_safety": ("least C0/P0", "", ".3g"),
}
"""Facts of `bearing_facts` in reports: word, SI unit and format."""


def bearing_facts(found: OptimisedDesign) -> dict[str, dict[str, np.ndarray]]:
    """Return the worst numbers of each bearing of a system of shafts, before and after.

    Args:
        found: The result, of a `ShaftDesign`.

    Returns:
        rating_life [h], peak_pressure [Pa], static_safety [1] by name, each before and
        after (bearing,); NaN of springs.
    """
    facts: dict[str, dict[str, np.ndarray]] = {}
    for side in ("before", "after"):
        design: Any = found.initial if side == "before" else found.element
        solved = getattr(found, side).solution
        sprung = np.full(len(design.system.seats), np.nan)
        sprung[design.bearings] = 0.0
        for key, values in (
            ("rating_life", design.hours(found.cases, solved)),
            ("peak_pressure", np.max(solved.peak_pressure, axis=0)),
            ("static_safety", np.min(solved.lives["static_safety"], axis=0)),
        ):
            facts.setdefault(key, {})[side] = np.asarray(values) + sprung
    return facts


def _warned_before(task, found) -> list[Warning]:
    """Return the warnings of the start that the best design does not have."""
    first = scene_of_design(task, found.initial)
    kept = set(scene_of_design(task, found.element).warnings)
    return [*(w for w in first.warnings if w not in kept), *found.before.warnings]


def optimisation_as_dict(
    task: Task, found: OptimisedDesign, best: Any = None
) -> dict[str, Any]:
    """Return an optimised scene as plain numbers and lists, in SI.

    Args:
        task: The optimisation task.
        found: Its result.
        best: As in `optimisation_report`.

    Returns:
        result, message, optimality, history, evaluations, gradients, rejected,
        warnings (of the best design), warnings_before (of the start), inputs (as in
        `Optimisation`: the file can be read as a scene), version; with fits `fit`, as
        in `fits_json`, of the best design; if converged also variables, objective,
        constraints and peak_pressure, and rating_life (before, after) if it is
        maximised; of a system of shafts bearings in place of peak_pressure: the numbers
        of `bearing_facts` by the names of the bearings.
    """
    best = scene_of_design(task, found.element) if best is None else best
    history = found.history._asdict().items()
    numbers = {
        **(_numbers(found, best) if found.converged else {}),
        "result": found.result,
        "message": found.message,
        "optimality": found.optimality,
        "history": {k: values for k, values in history if np.isfinite(values).all()},
        "evaluations": found.n_evaluations,
        "gradients": found.n_gradients,
        "rejected": found.rejected,
        **(fits_json(best) if isinstance(best, Scene) else {}),
        "warnings_before": _warned_before(task, found),
    }
    return run_json(numbers, [*best.warnings, *found.after.warnings], task.inputs)


def _numbers(found, best):
    before, after = found.before, found.after
    variables = [
        {
            "name": v.name,
            "lower": v.lower,
            "upper": v.upper,
            "before": x,
            "after": y,
        }
        for v, x, y in zip(found.variables, before.values, after.values, strict=True)
    ]

    def sides(k):
        pairs = {"before": _measure(before)[k], "after": _measure(after)[k]}
        return {side: {"smooth": x, "exact": y} for side, (x, y) in pairs.items()}

    constraints = [
        {
            "measure": label_of(c.measure),
            "lower": c.lower,
            "upper": c.upper,
            **sides(k),
        }
        for k, c in enumerate(found.constraints, start=1)
    ]
    return {
        "variables": variables,
        "objective": {"measure": label_of(found.objective), **sides(0)},
        **_displayed_objective(found),
        "constraints": constraints,
        **_bearings(found, best),
    }


def _bearings(found, best):
    if isinstance(best, Scene):
        sides = {"before": found.before, "after": found.after}
        return {"peak_pressure": {k: _peaks(side) for k, side in sides.items()}}
    facts = bearing_facts(found)
    return {
        "bearings": {
            seat.name: {
                key: {side: values[k] for side, values in pair.items()}
                for key, pair in facts.items()
            }
            for k, seat in enumerate(best.system.seats)
        }
    }


def _displayed_objective(found):
    """Return the displayed form of the objective by its name, if it differs."""
    pair = [_measure(side)[0] for side in (found.before, found.after)]
    measure, ((_, before), (_, after)) = _as_reported(found.objective, pair)
    if measure is found.objective:
        return {}
    name = label_of(measure).replace(" ", "_")
    return {name: {"before": before, "after": after}}


def _measure(outcome: Outcome):
    """Return (smooth, exact) of the objective and of every constrained measure."""
    return [
        (outcome.objective, outcome.exact),
        *zip(
            outcome.constraints.tolist(),
            outcome.exact_constraints.tolist(),
            strict=True,
        ),
    ]


def _variables(found):
    rows = []
    for v, first, last in zip(
        found.variables, found.before.values, found.after.values, strict=True
    ):
        own = unit_of(found.element, v.path[0])
        scale, unit = display_unit(own, v.upper)
        zero = 0.0
        if own == "K":
            zero, unit = CELSIUS, "°C"
        low, high, before, after = (
            scale * (x - zero) for x in (v.lower, v.upper, first, last)
        )
        bound = {v.lower: ", at the lower one", v.upper: ", at the upper one"}.get(
            last, ""
        )
        name, bounds = (
            v.name.removeprefix("bearing."),
            f"{low:.5g} to {high:.5g}{bound}",
        )
        rows.append((name, before, after, unit, bounds))
    names = "variable", "before", "after", "", "bounds"
    return Grid.of_rows(names, rows)


def _measures(found):
    measures = [found.objective, *(c.measure for c in found.constraints)]
    rows = []
    pairs = zip(_measure(found.before), _measure(found.after), strict=True)
    for k, (measure, values) in enumerate(zip(measures, pairs, strict=True)):
        shown, (first, last) = _as_reported(measure, values)
        scale, unit = _unit(shown)
        largest = isinstance(measure, AbstractMeasure) and measure.maximised
        made = "maximised" if largest else "minimised"
        kept = made if k == 0 else _bounds(found.constraints[k - 1], scale)
        exact, smooth = ([scale * side[i] for side in (first, last)] for i in (1, 0))
        rows.append((label_of(shown), *exact, unit, kept))
        if first[0] != first[1]:
            rows.append(("  smooth", *smooth, "", ""))
    return Grid.of_rows(("measure", "before", "after", "", "asked"), rows)


def _as_reported(measure, values):
    """Return the displayed form of a measure, and its (smooth, exact) pairs."""
    if not isinstance(measure, AbstractMeasure) or measure.reported_as is measure:
        return measure, values
    shown = [tuple(measure.reported_value(x) for x in pair) for pair in values]
    return measure.reported_as, shown


def _bounds(constraint, scale):
    return constraint.bounds_text(lambda bound: f"{scale * bound:.5g}")


def _unit(measure):
    if isinstance(measure, EdgeLoad):
        return 1e-3, "N/mm"
    unit = measure.unit if isinstance(measure, AbstractMeasure) else ""
    return _STIFFNESSES.get(unit) or display_unit(unit)


def _peaks(outcome):
    return np.asarray(outcome.solution.roller_pressure).max(axis=(1, 2))


def _pressures(found):
    before, after = _peaks(found.before), _peaks(found.after)
    columns = [
        Column("case", range(len(before))),
        Column("peak pressure before", before, "Pa", ".1f"),
        Column("after", after, "Pa", ".1f"),
    ]
    return Grid(columns)

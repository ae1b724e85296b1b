"""An optimised design as text, and as numbers in SI."""

from typing import Any

import numpy as np

from ..numerics.units import CELSIUS, display_unit, unit_of
from ..optimise.design_problem import Outcome
from ..optimise.measure import AbstractMeasure, EdgeLoad, label_of
from ..optimise.optimise import Optimised
from .optimise_design import scene_of_design
from .optimise_table import WARMTH, Optimisation
from .output import fits_as_dict
from .read import Scene
from .report import fits_section
from .report_model import Column, Grid, Report

_STIFFNESSES = {"N/m": (1e-6, "kN/mm"), "N m": (1e-3, "N m/mrad")}


def optimisation_report(
    task: Optimisation, found: Optimised, best: Scene | None = None
) -> Report:
    """Return the readable report of the design before and after.

    Args:
        task: The optimisation task.
        found: Its result, converged.
        best: Scene of the best design; `None`: from `scene_of_design`.
    """
    best = scene_of_design(task, found.element) if best is None else best
    cases = len(found.after.solution.result)
    plural = "s" * (cases != 1)
    head = (
        f"{task.scene.name}: optimised over {cases} operating case{plural} in"
        f" {len(found.history.objective) - 1} steps,\n{found.n_evaluations} designs"
        f" evaluated, {found.n_gradients} with gradient, {len(found.rejected)} rejected"
    )
    warned = [f"rejected: {why}" for why in dict.fromkeys(found.rejected)]
    warned += [*best.warnings, *found.after.warnings]
    warned += [f"before: {text}" for text in _warned_before(task, found)]
    left = f"gradient left {found.optimality:.1e}, tolerance {task.tolerance:.1e}"
    sections = {
        "Search": [head],
        "Variables": [_variables(found)],
        "Measures": [_measures(found)],
        "Peak pressures": [_pressures(found)],
        "Fits of the best design": fits_section(best),
        "Solution": [f"converged: {found.message}; {left}"],
    }
    return Report(sections, warned)


def _warned_before(task, found) -> list[str]:
    """Return the warnings of the start that the best design does not have."""
    first = scene_of_design(task, found.initial)
    kept = set(scene_of_design(task, found.element).warnings)
    return [*(w for w in first.warnings if w not in kept), *found.before.warnings]


def optimisation_as_dict(
    task: Optimisation, found: Optimised, best: Scene | None = None
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
        in `fits_as_dict`, of the best design; if converged also variables, objective,
        constraints and peak_pressure, and rating_life (before, after) if it is
        maximised.
    """
    from .. import __version__

    best = scene_of_design(task, found.element) if best is None else best
    history = {
        name: np.asarray(values).tolist()
        for name, values in found.history._asdict().items()
        if np.isfinite(values).all()
    }
    return {
        **(_numbers(found) if found.converged else {}),
        "result": found.result,
        "message": found.message,
        "optimality": found.optimality if np.isfinite(found.optimality) else None,
        "history": history,
        "evaluations": found.n_evaluations,
        "gradients": found.n_gradients,
        "rejected": list(found.rejected),
        **fits_as_dict(best),
        "warnings": [*best.warnings, *found.after.warnings],
        "warnings_before": _warned_before(task, found),
        "inputs": task.inputs,
        "version": __version__,
    }


def unsolved_start_as_dict(task: Optimisation, error: Exception) -> dict[str, Any]:
    """Return the output of a task whose first design does not solve.

    Args:
        task: The optimisation task.
        error: Cause of the failure.

    Returns:
        result ("start_not_solved"), message, warnings, inputs and version.
    """
    from .. import __version__

    return {
        "result": "start_not_solved",
        "message": str(error),
        "warnings": list(task.scene.warnings),
        "inputs": task.inputs,
        "version": __version__,
    }


def _numbers(found):
    before, after = found.before, found.after
    variables = [
        {
            "name": v.name,
            "lower": v.lower,
            "upper": v.upper,
            "before": float(x),
            "after": float(y),
        }
        for v, x, y in zip(found.variables, before.values, after.values, strict=True)
    ]

    def sides(k):
        pairs = {"before": _measured(before)[k], "after": _measured(after)[k]}
        return {side: {"smooth": x, "exact": y} for side, (x, y) in pairs.items()}

    constraints = [
        {
            "measure": label_of(c.measure),
            "lower": None if c.lower is None else float(c.lower),
            "upper": None if c.upper is None else float(c.upper),
            **sides(k),
        }
        for k, c in enumerate(found.constraints, start=1)
    ]
    return {
        "variables": variables,
        "objective": {"measure": label_of(found.objective), **sides(0)},
        **_shown(found),
        "constraints": constraints,
        "peak_pressure": {
            "before": _peaks(before).tolist(),
            "after": _peaks(after).tolist(),
        },
    }


def _shown(found):
    """Return the displayed form of the objective by its name, if it differs."""
    pair = [_measured(side)[0] for side in (found.before, found.after)]
    measure, ((_, before), (_, after)) = _told(found.objective, pair)
    if measure is found.objective:
        return {}
    ends = {"before": before, "after": after}
    finite = {k: float(x) if np.isfinite(x) else None for k, x in ends.items()}
    return {label_of(measure).replace(" ", "_"): finite}


def _measured(outcome: Outcome):
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
        scale, unit = display_unit(unit_of(found.element, v.path[0]), v.upper)
        zero = 0.0
        if v.name in WARMTH:
            zero, unit = CELSIUS, "°C"
        low, high, before, after = (
            scale * (x - zero) for x in (v.lower, v.upper, first, last)
        )
        bound = {v.lower: ", at the lower", v.upper: ", at the upper"}.get(last, "")
        name, bounds = (
            v.name.removeprefix("bearing."),
            f"{low:.5g} to {high:.5g}{bound}",
        )
        rows.append((name, before, after, unit, bounds))
    names = "variable", "before", "after", "", "bounds"
    return _grid(names, rows)


def _measures(found):
    measures = [found.objective, *(c.measure for c in found.constraints)]
    rows = []
    pairs = zip(_measured(found.before), _measured(found.after), strict=True)
    for k, (measure, values) in enumerate(zip(measures, pairs, strict=True)):
        shown, (first, last) = _told(measure, values)
        scale, unit = _unit(shown)
        made = "made least" if shown is measure else "made largest"
        kept = made if k == 0 else _kept(found, k - 1, scale)
        exact, smooth = ([scale * side[i] for side in (first, last)] for i in (1, 0))
        rows.append((label_of(shown), *exact, unit, kept))
        if first[0] != first[1]:
            rows.append(("  smooth", *smooth, "", ""))
    return _grid(("measure", "before", "after", "", "asked"), rows)


def _grid(names, rows):
    values = zip(*rows, strict=True)
    return Grid([Column(n, v) for n, v in zip(names, values, strict=True)])


def _told(measure, values):
    """Return the displayed form of a measure, and its (smooth, exact) pairs."""
    if not isinstance(measure, AbstractMeasure) or measure.as_told is measure:
        return measure, values
    shown = [tuple(measure.told(x) for x in pair) for pair in values]
    return measure.as_told, shown


def _kept(found, k, scale):
    constraint = found.constraints[k]
    words = []
    for word, bound in (("at least", constraint.lower), ("at most", constraint.upper)):
        if bound is not None:
            words.append(f"{word} {scale * float(bound):.5g}")
    return ", ".join(words)


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

"""An optimised design as text for people, and as numbers in SI for programs."""

from typing import Any

import numpy as np

from ..numerics.units import CELSIUS, display_unit, unit_of
from ..optimise.design_problem import Outcome
from ..optimise.measure import AbstractMeasure, EdgeLoad, label_of
from ..optimise.optimise import Optimised
from .optimise_table import WARMTH, Optimisation

_RULE = "-" * 78
_STIFFNESSES = {"N/m": (1e-6, "kN/mm"), "N m": (1e-3, "N m/mrad")}


def optimisation_report(task: Optimisation, found: Optimised) -> str:
    """Readable report, before and after.

    Args:
        task: What was asked.
        found: What came of it, converged.
    """
    cases = len(found.after.solution.result)
    plural = "s" * (cases != 1)
    head = (
        f"{task.scene.name}: optimised over {cases} operating case{plural} in"
        f" {len(found.history.objective) - 1} steps,\n{found.n_evaluations} designs"
        f" evaluated, {found.n_gradients} with gradient, {len(found.rejected)} rejected"
    )
    parts = [head, _variables(found), _measures(found), _pressures(found)]
    warned = [f"warning: rejected: {why}" for why in dict.fromkeys(found.rejected)]
    told = (*task.scene.warnings, *found.after.warnings)
    warned += [f"warning: {text}" for text in told]
    warned += [f"warning: before: {text}" for text in found.before.warnings]
    left = f"gradient left {found.optimality:.1e}, tolerance {task.tolerance:.1e}"
    ending = f"converged: {found.message}; {left}"
    return f"\n{_RULE}\n".join([*parts, "\n".join([ending, *warned])])


def optimisation_as_dict(task: Optimisation, found: Optimised) -> dict[str, Any]:
    """An optimised scene as plain numbers and lists, in SI.

    Args:
        task: What was asked.
        found: What came of it.

    Returns:
        result, message, optimality, history, evaluations, gradients, rejected,
        warnings (of the best design), warnings_before (of the start), inputs (as of
        `Optimisation`: the file is a scene again), version; if it
        converged also variables, objective, constraints and peak_pressure.
    """
    from .. import __version__

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
        "warnings": [*task.scene.warnings, *found.after.warnings],
        "warnings_before": found.before.warnings,
        "inputs": task.inputs,
        "version": __version__,
    }


def unsolved_start_as_dict(task: Optimisation, error: Exception) -> dict[str, Any]:
    """What is told of a task whose first design does not solve.

    Args:
        task: What was asked.
        error: Why not.

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
        "constraints": constraints,
        "peak_pressure": {
            "before": _peaks(before).tolist(),
            "after": _peaks(after).tolist(),
        },
    }


def _measured(outcome: Outcome):
    """(smooth, exact) of the objective and of every constrained measure."""
    return [
        (outcome.objective, outcome.exact),
        *zip(
            outcome.constraints.tolist(),
            outcome.exact_constraints.tolist(),
            strict=True,
        ),
    ]


def _variables(found):
    names = [v.name.removeprefix("bearing.") for v in found.variables]
    width = max(map(len, names))
    lines = [f"{'':{width}}       before        after   bounds"]
    rows = zip(
        names, found.variables, found.before.values, found.after.values, strict=True
    )
    for name, v, first, last in rows:
        scale, unit = display_unit(unit_of(found.element, v.path[0]), v.upper)
        zero = 0.0
        if v.name in WARMTH:
            zero, unit = CELSIUS, "°C"
        low, high, before, after = (
            scale * (x - zero) for x in (v.lower, v.upper, first, last)
        )
        bound = {v.lower: ", at the lower", v.upper: ", at the upper"}.get(last, "")
        lines.append(
            f"{name:{width}} {before:12.5g} {after:12.5g}   {low:.5g} to"
            f" {high:.5g} {unit}".rstrip()
            + bound
        )
    return "\n".join(lines)


def _measures(found):
    measures = [found.objective, *(c.measure for c in found.constraints)]
    lines = [f"{'':29}       before        after"]
    pairs = zip(_measured(found.before), _measured(found.after), strict=True)
    for k, (measure, (first, last)) in enumerate(zip(measures, pairs, strict=True)):
        scale, unit = _unit(measure)
        what = f"{label_of(measure)} {f'[{unit}]' if unit else ''}"
        line = f"{what:29} {scale * first[1]:12.5g} {scale * last[1]:12.5g}"
        lines.append(line + ("   made least" if k == 0 else _kept(found, k - 1, scale)))
        if first[0] != first[1]:
            smooth = f"{'  smooth':29} {scale * first[0]:12.5g} {scale * last[0]:12.5g}"
            lines.append(smooth)
    return "\n".join(lines)


def _kept(found, k, scale):
    constraint = found.constraints[k]
    words = []
    for word, bound in (("at least", constraint.lower), ("at most", constraint.upper)):
        if bound is not None:
            words.append(f"{word} {scale * float(bound):.5g}")
    return "   " + ", ".join(words)


def _unit(measure):
    if isinstance(measure, EdgeLoad):
        return 1e-3, "N/mm"
    unit = measure.unit if isinstance(measure, AbstractMeasure) else ""
    return _STIFFNESSES.get(unit) or display_unit(unit)


def _peaks(outcome):
    return np.asarray(outcome.solution.roller_pressure).max(axis=(1, 2))


def _pressures(found):
    lines = ["case   peak pressure before    after [MPa]"]
    pairs = zip(_peaks(found.before), _peaks(found.after), strict=True)
    for k, (first, last) in enumerate(pairs):
        lines.append(f"{k:4d}   {1e-6 * first:20.1f} {1e-6 * last:8.1f}")
    return "\n".join(lines)

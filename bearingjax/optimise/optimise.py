"""Design optimisation: the free numbers of a drawing that make a measure least.

One compiled program solves all operating cases of a design and pulls the gradient of
objective and constraints back through the equilibria (implicit function theorem,
reverse mode): it costs little more than the solves.
"""

import dataclasses
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..element.bearing_element import BearingElement, check_element
from ..statics.cases import Cases
from ..statics.options import SolveOptions
from ..statics.support import check_held
from .constraint import Constraint
from .design_problem import Build, Measure, Outcome, Problem
from .search import METHODS, Ending, search, takes_gradients
from .trials import Trial, Trials, optimality
from .variable import Variable, check_variables

NEAR = 0.05
"""Share of the range of a variable within which a rejected design is called near."""


class History(NamedTuple):
    """The accepted steps of a search; step 0 is the start.

    Attributes:
        values: Of the variables (step, variable) [SI].
        objective: The smooth objective (step,).
        violation: Miss of the worst constraint over the size of its bound (step,).
        gradient: As `Optimised.optimality` (step,) [1]; NaN with a method without
            gradients.
        evaluations: Designs evaluated so far (step,).
    """

    values: np.ndarray
    objective: np.ndarray
    violation: np.ndarray
    gradient: np.ndarray
    evaluations: np.ndarray


@dataclasses.dataclass(frozen=True)
class Optimised:
    """What an optimisation found.

    Attributes:
        element: The best design, its checks passed.
        initial: The starting design.
        variables: What was free.
        objective: What was made least.
        constraints: What was kept.
        values: Its numbers (variable,) [SI].
        before: The starting design and how it fared.
        after: The best design, likewise.
        history: The way from one to the other.
        n_evaluations: Designs that were evaluated, every case of each solved once.
        n_gradients: Those of which the gradient was asked for.
        rejected: Why designs were rejected, in order; empty if none was.
        optimality: Largest part of the gradient of the best design that neither a
            bound nor an active constraint holds back: of the objective over its size
            at the start, by variables over their range [1]. Zero at a minimum. NaN
            where it was not asked for: without gradients, at the step limit.
        result: "converged" (`optimality` is within the tolerance and the constraints
            are kept), "step_limit", "stalled" (the method could not go on), or
            "infeasible" (no design was found that keeps the constraints).
        message: The same in words.
    """

    element: BearingElement[Any]
    initial: BearingElement[Any]
    variables: tuple[Variable, ...]
    objective: Measure
    constraints: tuple[Constraint, ...]
    values: np.ndarray
    before: Outcome
    after: Outcome
    history: History
    n_evaluations: int
    n_gradients: int
    rejected: tuple[str, ...]
    optimality: float
    result: str
    message: str

    @property
    def converged(self) -> bool:
        """Whether `result` is "converged"."""
        return self.result == "converged"


def optimise(
    element: BearingElement[Any],
    cases: Cases,
    variables: Sequence[Variable],
    objective: Measure,
    constraints: Sequence[Constraint] = (),
    method: Any = None,
    *,
    max_steps: int = 200,
    tolerance: float = 1e-5,
    points: int = 101,
    free: Sequence[str] | None = None,
    fixed_ring: str = "outer",
    solve_tolerance: float | None = None,
    build: Build | None = None,
    progress: bool = False,
) -> Optimised:
    """The design within bounds that makes an objective least over operating cases.

    A design with a case that does not solve, with a number that is not finite, or
    that the drawing does not allow is rejected: the search is told of a slope that
    rises away from its last step, and turns back. `rejected` lists the reasons. A
    search with gradients that gives up at rejected designs is begun anew from a better
    design beside them; if there is none, it has stalled, and the message names one.

    No search is called converged by its own word: the first-order conditions of Karush,
    Kuhn and Tucker are checked at the best design, with exact gradients. They hold at a
    saddle too, and at a minimum that is not the lowest: begin from several starts.

    Args:
        element: The design to start from.
        cases: Operating cases, all of this design.
        variables: Its free numbers.
        objective: What is made least: a measure such as `PeakPressure()`, or any
            smooth function (element, cases, solution) -> scalar.
        constraints: Bounds on measures.
        method: "l-bfgs-b" (the default without constraints), "slsqp" (with them),
            "adam" or any Optax gradient transformation, projected onto the bounds;
            "nelder-mead", which asks for no gradients and is there to compare, or a
            function like it (see `search` in `bearingjax/optimise/search.py`). Only
            "slsqp" keeps constraints.
        max_steps: Step limit of the search.
        tolerance: `optimality` at which the search ends; constraints are kept to this
            share of their bound, and within it count as active. 1e-5 moves the
            objective by 1e-5 of its size at the most, over the whole range of a
            variable; it stands well above the round-off of gradients (1e-9), though
            p-norms near a minimax bend the more, the larger their exponent. In
            float32: 1e-3. Of "nelder-mead": size of the simplex; it sees the objective
            alone, which is flat to the square of the gradient, so that it counts as
            converged with an `optimality` of up to the root of this.
        points: Positions along the rollers that smooth maxima of the pressure sample
            beside the peaks, which do not depend on them.
        free, fixed_ring: As of `solve_load`.
        solve_tolerance: `tolerance` of `solve_load`.
        build: What is done to a changed design before it is solved, for example
            `lambda e: bj.preload(e, 400.0, throw=False)`.
        progress: Show a progress bar on standard error.

    Returns:
        The best design and the way to it; read `result`.

    Raises:
        TypeError, ValueError: For wrong variables, measures, methods or numbers.
        SolveError: If the starting design does not solve.
    """
    check_element("optimise", element)
    variables, constraints = tuple(variables), tuple(constraints)
    method = _check_method(method, constraints)
    _check_call(cases, objective, constraints, max_steps, tolerance)
    options = SolveOptions(free, fixed_ring, points, solve_tolerance)
    options.check("optimise", "solve_tolerance")
    check_held("optimise", cases.load, cases.prescribed, options.free)
    start = check_variables(element, variables)
    problem = Problem(element, cases, variables, objective, constraints, options, build)
    slopes = takes_gradients(method)
    first = problem.begin(problem.scaled(start), slopes)
    trials = Trials(problem.evaluate, first)

    from tqdm import tqdm

    bar = tqdm(total=max_steps, disable=not progress, desc="optimise", unit="step")
    with bar:

        def told():
            bar.set_postfix_str(f"{trials.steps[-1].objective:.6g} of the start")
            bar.update()

        n_bounds = len(problem.bounds)
        ending = search(method, trials, n_bounds, max_steps, tolerance, told)
    return _conclude(problem, trials, ending, slopes, max_steps, tolerance)


def _conclude(problem, trials, ending, slopes, max_steps, tolerance) -> Optimised:
    best = trials.attempt(ending.unit, slopes or ending.settled)
    if best.fault:
        # A failed gradient at the end leaves the design as it was.
        best = trials.steps[-1]
    result, text = verdict(trials, ending, best, slopes, max_steps, tolerance)
    if result != "converged":
        text += _near_by(problem, trials, best)
    text += _idle(problem, trials)
    steps = trials.steps
    history = History(
        values=np.stack([problem.values(s.unit) for s in steps]),
        objective=problem.size * np.array([s.objective for s in steps]),
        violation=np.array([s.violation for s in steps]),
        gradient=np.array([optimality(s, tolerance) for s in steps]),
        evaluations=np.array(trials.evaluations),
    )
    initial, before = problem.outcome(steps[0])
    element, after = problem.outcome(best)
    return Optimised(
        element,
        initial,
        problem.variables,
        problem.measures[0],
        problem.constraints,
        after.values,
        before,
        after,
        history,
        trials.n_evaluations,
        trials.n_gradients,
        tuple(trial.fault for trial in trials.rejected),
        optimality(best, tolerance),
        result,
        text,
    )


def verdict(
    trials: Trials,
    ending: Ending,
    best: Trial,
    slopes: bool,
    max_steps: int,
    tolerance: float,
) -> tuple[str, str]:
    """Result of a search, and the same in words.

    Args:
        trials: What was tried.
        ending: What the search says.
        best: The best design, with gradients if the search calls it so.
        slopes: Whether the search asks for gradients.
        max_steps, tolerance: As of `optimise`.
    """
    left, n = optimality(best, tolerance), len(trials.steps) - 1
    allowed = tolerance if slopes else tolerance**0.5
    stood = np.array_equal(best.unit, trials.steps[0].unit)
    said = ending.text.strip(" .:")
    if best.violation > tolerance:
        text = f"constraints are missed by {best.violation:.1e} of their bounds"
        return "infeasible", text
    if stood and best.slope is not None and best.objective and not best.slope.any():
        return "stalled", "nothing changed: no variable moves the objective"
    if left <= allowed:
        return "converged", said + "; nothing changed" * stood
    if ending.limited or n >= max_steps:
        return "step_limit", f"step limit reached after {n} steps: raise `max_steps`"
    text = f"the search could not go on: {said}"
    if np.isfinite(left):
        text += f"; gradient left {left:.1e}, above {allowed:.1e}"
    return "stalled", text


def _near_by(problem: Problem, trials: Trials, best: Trial) -> str:
    """The rejected design nearest to the best one, in words; empty if none is near."""
    if not trials.rejected:
        return ""
    away = [np.abs(trial.unit - best.unit).max() for trial in trials.rejected]
    if min(away) > NEAR:
        return ""
    trial = trials.rejected[int(np.argmin(away))]
    values = problem.values(trial.unit)
    names = [variable.name for variable in problem.variables]
    pairs = zip(names, values, strict=True)
    where = ", ".join(f"{name} = {value:.6g}" for name, value in pairs)
    return f"; rejected near by, at {where}: {trial.fault}"


def _idle(problem: Problem, trials: Trials) -> str:
    """Variables that nothing depended on at any step, in words; empty if none."""
    slopes = [
        np.vstack([step.slope, step.margin_slopes])
        for step in trials.steps
        if step.slope is not None and step.margin_slopes is not None
    ]
    if len(slopes) < 2:
        return ""
    moving = np.any(np.vstack(slopes) != 0, axis=0)
    pairs = zip(problem.variables, moving, strict=True)
    idle = [variable.name for variable, moves in pairs if not moves]
    return f"; without influence: {', '.join(idle)}" if idle else ""


def _check_method(method, constraints):
    if method is None:
        return "slsqp" if constraints else "l-bfgs-b"
    descent = hasattr(method, "init") and hasattr(method, "update")
    if not (descent or callable(method) or method in METHODS):
        raise ValueError(
            f"optimise: `method` is {method!r}; it must be one of"
            f" {', '.join(METHODS)}, or an Optax gradient transformation."
        )
    if constraints and method != "slsqp":
        raise ValueError(
            f"optimise: `method` is {method!r}, which keeps no constraints; take"
            " 'slsqp'."
        )
    return method


def _check_call(cases, objective, constraints, max_steps, tolerance):
    if not isinstance(cases, Cases):
        raise TypeError(
            f"optimise: `cases` is a {type(cases).__name__}; it must be a Cases."
        )
    if cases.design is not None:
        raise ValueError("optimise: `cases` have several designs; give one element.")
    if not callable(objective):
        raise TypeError(
            f"optimise: `objective` is a {type(objective).__name__}; it must be a"
            " function (element, cases, solution) -> scalar, such as PeakPressure()."
        )
    for constraint in constraints:
        if not isinstance(constraint, Constraint):
            raise TypeError(
                f"optimise: `constraints` holds a {type(constraint).__name__}; it must"
                " hold Constraints."
            )
    if isinstance(max_steps, bool) or not isinstance(max_steps, int) or max_steps < 1:
        raise ValueError(
            f"optimise: `max_steps` is {max_steps!r}; it must be a whole number of at"
            " least 1."
        )
    if not 0.0 < tolerance < 0.1:
        raise ValueError(
            f"optimise: `tolerance` is {tolerance!r}; it must be above 0 and below 0.1."
        )

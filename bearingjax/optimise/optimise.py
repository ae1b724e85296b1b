"""Design optimisation: values of design variables that minimise a measure.

One compiled program solves all operating cases of a design and differentiates objective
and constraints through the equilibria (implicit function theorem, reverse mode). The
gradient costs little more than the solves.
"""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np

from ..cases.cases import Cases
from ..design.checks import all_of_class, count, must_be, of_class
from ..life.rating import check_alike
from ..numerics.units import meaning, shown_number, unit
from ..statics import Installed, SolveOptions, Support
from ..statics.support import RESTRAINED, check_held
from .constraint import Constraint
from .design_problem import Build, Measure, Outcome, Problem
from .life import OfLife
from .measure import AbstractMeasure, label_of
from .search import METHODS, SearchOutcome, search_least, takes_gradients
from .system import AbstractSystem, Design, check_design
from .trials import Trial, Trials, optimality
from .variable import Variable, check_same_in_cases, check_variables

NEAR = 0.05
"""Largest distance of a rejected design that is named, over a variable's range [1]."""


class History(NamedTuple):
    """The accepted steps of a search; step 0 is the start.

    Attributes:
        values: Values of the variables (step, variable) [SI].
        objective: The smooth objective (step,).
        violation: Largest violation of a constraint over the size of its bound (step,).
        gradient: `OptimisedDesign.optimality` (step,) [1]; NaN with a method without
            gradients.
        evaluations: Designs evaluated so far (step,).
    """

    values: Annotated[np.ndarray, unit("SI")]
    objective: np.ndarray
    violation: np.ndarray
    gradient: Annotated[np.ndarray, unit("1")]
    evaluations: np.ndarray


@dataclasses.dataclass(frozen=True)
class OptimisedDesign:
    """Result of an optimisation.

    Attributes:
        element: The best design, its checks passed.
        initial: The starting design.
        variables: The design variables.
        objective: The measure that was minimised.
        constraints: Bounds on measures.
        values: Variables of the best design (variable,) [SI].
        before: Results of the starting design.
        after: Results of the best design.
        history: The steps from one to the other.
        n_evaluations: Designs that were evaluated, every case of each solved once.
        n_gradients: Designs that were evaluated with gradients.
        rejected: Why designs were rejected, in order; empty if none was.
        optimality: Largest component of the gradient of the best design that neither a
            bound nor an active constraint cancels: of the objective over its size at
            the start, by variables over their range [1]. Zero at a minimum. NaN if a
            method without gradients did not report convergence.
        result: "converged" (`optimality` is within the tolerance and the constraints
            are kept), "step_limit", "stalled" (the method could not go on), or
            "infeasible" (no design was found that keeps the constraints);
            "interrupted", by the user: the design is the best of the steps until then.
        message: Result in words.
        cases: The operating cases.
    """

    element: Any
    initial: Any
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
    cases: Any

    @property
    def converged(self) -> bool:
        """Whether `result` is "converged"."""
        return self.result == "converged"


@dataclasses.dataclass(frozen=True)
class SearchOptions:
    """Numerics of an optimisation.

    Attributes:
        method: "l-bfgs-b" (the default without constraints), "slsqp" (with them),
            "adam" or any Optax gradient transformation, projected onto the bounds;
            "nelder-mead", without gradients, for comparison; or a search function of
            your own (see `search_least` in `bearingjax/optimise/search.py`). Only
            "slsqp" keeps constraints.
        max_steps: Step limit of the search.
        tolerance: `optimality` at which the search ends. Constraints are kept to this
            share of their bound, and count as active within it. With 1e-5 the gradient
            left changes the objective by at most 1e-5 of its size over the whole range
            of a variable. Gradients are exact to 1e-9, but p-norms with a large
            exponent curve sharply near a minimax. In float32 use 1e-3. For
            "nelder-mead" it is the size of the simplex; as that method sees only the
            objective, it counts as converged with an `optimality` of up to the square
            root of this.
        solve: Numerics of the load solves; at its `points` along the rollers smooth
            maxima sample the pressure, in addition to the peaks, which do not depend on
            them. `None`: `SolveOptions()`.
        progress: Whether a progress bar is shown on standard error.
        told: Called at each step with where the search is, in words; `None`: nothing.
    """

    method: Any = None
    max_steps: int = dataclasses.field(default=200, metadata=meaning("step limit"))
    tolerance: float = dataclasses.field(
        default=1e-5, metadata=meaning("gradient at which the search ends")
    )
    solve: SolveOptions | None = None
    progress: bool = False
    told: Callable[[str], Any] | None = None


def optimise(
    element: Design,
    cases: Any,
    variables: Sequence[Variable],
    objective: Measure,
    constraints: Sequence[Constraint] = (),
    *,
    search: SearchOptions | None = None,
    support: Support = RESTRAINED,
    build: Build | None = None,
) -> OptimisedDesign:
    """Find the design within bounds that minimises an objective over operating cases.

    A design is rejected if a case does not solve, a number is not finite, or its
    dimensions are not allowed. The search then sees an objective that rises away from
    its last step, and turns back. `rejected` lists the reasons. A search with gradients
    that gives up at rejected designs is restarted from a better design nearby. If there
    is none it has stalled, and the message names the nearest rejected design.

    Convergence is not taken from the method: the first-order conditions of Karush,
    Kuhn and Tucker are checked at the best design, with exact gradients. They also hold
    at a saddle and at a local minimum: run it from several starts.

    Args:
        element: The design to start from: an element, or a system, such as
            `bearingjax.skid.SkiddingBearing`, whose balls may slip, or
            `bearingjax.shafts.ShaftDesign`.
        cases: Operating cases, all of this design; of a `ShaftDesign` `ShaftCases`.
        variables: The design variables.
        objective: The measure to be minimised, such as `PeakPressure()`, or any
            smooth function (element, cases, solution) -> scalar. Of a `RatingLife` its
            inverse is minimised.
        constraints: Bounds on measures.
        search: Method, step limit and tolerance of the search, and numerics of the
            load solves; `None`: `SearchOptions()`.
        support: As in `solve_load`; displacements are those of the cases.
        build: Function applied to each changed design before it is solved, for example
            `lambda e: bj.preload(e, 400.0, throw=False)`.

    Returns:
        The best design and the steps to it; check `result`.

    Raises:
        TypeError, ValueError: For wrong variables, measures, methods or numbers.
        SolveError: If the starting design does not solve.
    """
    variables, constraints = tuple(variables), tuple(constraints)
    if isinstance(objective, AbstractMeasure):
        objective = objective.as_objective
    given = SearchOptions() if search is None else search
    method = _check_method(given.method, constraints)
    max_steps, tolerance = given.max_steps, given.tolerance
    options = SolveOptions() if given.solve is None else given.solve
    kind = element.of_cases if isinstance(element, AbstractSystem) else Cases
    _check_cases(cases, kind)
    _check_call(objective, constraints, max_steps, tolerance)
    check_design("optimise", element, cases)
    measures = objective, *(constraint.measure for constraint in constraints)
    if any(isinstance(measure, OfLife) for measure in measures):
        if not isinstance(element, AbstractSystem):
            drawing = element.drawing if isinstance(element, Installed) else element
            check_alike(drawing.bearing)
    support.check_for_cases("optimise")
    if isinstance(cases, Cases):
        check_held("optimise", cases.load, support, cases.prescribed)
    start = check_variables(element, variables)
    check_same_in_cases("optimise", variables, cases)
    asked = variables, objective, constraints
    problem = Problem(element, cases, *asked, options, support, build)
    slopes = takes_gradients(method)
    first = problem.begin(problem.to_unit_box(start), slopes)
    trials = Trials(problem.evaluate, first)

    from tqdm import tqdm

    bar = tqdm(
        total=max_steps, disable=not given.progress, desc="optimise", unit="step"
    )
    with bar:

        def advance():
            step = trials.steps[-1]
            bar.set_postfix_str(f"{step.objective:.6g} of the start")
            bar.update()
            if given.told is not None:
                given.told(_step_in_words(trials, max_steps, tolerance))

        n_bounds = len(problem.bounds)
        try:
            ending = search_least(
                method, trials, n_bounds, max_steps, tolerance, advance
            )
        except KeyboardInterrupt:
            best = _best_step(trials, tolerance)
            ending = SearchOutcome(best.unit, False, INTERRUPTED)
    return _conclude(problem, trials, ending, slopes, max_steps, tolerance)


INTERRUPTED = "interrupted"
"""Result of a search that was interrupted; it has the best design so far."""


def _step_in_words(trials: Trials, max_steps: int, tolerance: float) -> str:
    step = trials.steps[-1]
    words = f"step {len(trials.steps) - 1} of at most {max_steps}: objective"
    words += f" {step.objective:.6g} of the start"
    if step.violation > tolerance:
        return f"{words}, constraints missed by {step.violation:.2g} of their bounds"
    return words + ", constraints kept" * bool(len(step.margins))


def _best_step(trials: Trials, tolerance: float) -> Trial:
    """Return the step of least objective that keeps the constraints; if none does, the
    one that misses them least."""
    kept = [step for step in trials.steps if step.violation <= tolerance]
    if kept:
        return min(kept, key=lambda step: step.objective)
    return min(trials.steps, key=lambda step: step.violation)


def _conclude(problem, trials, ending, slopes, max_steps, tolerance) -> OptimisedDesign:
    best = trials.attempt(ending.unit, slopes or ending.converged)
    if best.fault:
        # Its gradient may have failed: take the last step.
        best = trials.steps[-1]
    result, text = verdict(trials, ending, best, slopes, max_steps, tolerance)
    if result == "infeasible":
        text += _most_violated(problem, best)
    if result == INTERRUPTED:
        where = _values_in_words(problem, best)
        text += f"; the best design so far, from which to go on, has {where}"
    elif result != "converged":
        text += _near_by(problem, trials, best)
    text += _idle_variables(problem, trials)
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
    return OptimisedDesign(
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
        problem.cases,
    )


def verdict(
    trials: Trials,
    ending: SearchOutcome,
    best: Trial,
    slopes: bool,
    max_steps: int,
    tolerance: float,
) -> tuple[str, str]:
    """Result of a search, and the same in words.

    Args:
        trials: Designs that were tried.
        ending: Outcome of the search.
        best: The best design; with gradients if the search uses them or has settled.
        slopes: Whether the search uses gradients.
        max_steps, tolerance: As in `optimise`.
    """
    left, n = optimality(best, tolerance), len(trials.steps) - 1
    allowed = tolerance if slopes else tolerance**0.5
    stood = np.array_equal(best.unit, trials.steps[0].unit)
    said = ending.text.strip(" .:")
    if ending.text == INTERRUPTED:
        return INTERRUPTED, f"interrupted after {n} steps"
    if best.violation > tolerance:
        text = f"constraints are missed by {best.violation:.1e} of their bounds"
        return "infeasible", text
    if stood and best.slope is not None and best.objective and not best.slope.any():
        return "stalled", "nothing changed: no variable moves the objective"
    if left <= allowed:
        return "converged", said + "; nothing changed" * stood
    if ending.limited or n >= max_steps:
        # Steps that are rejected, or end where they began at a bound, count too.
        moved = f", {n} of which changed the design" if n < max_steps else ""
        text = f"step limit reached after {max(n, max_steps)} steps{moved}"
        return "step_limit", f"{text}: raise `max_steps`"
    text = f"the search could not go on: {said}"
    if np.isfinite(left):
        text += f"; gradient left {left:.1e}, above {allowed:.1e}"
    return "stalled", text


def _most_violated(problem: Problem, best: Trial) -> str:
    """Name the measure that violates its bound most, in words."""
    bound = problem.bounds[int(np.argmin(best.margins))]
    measure = problem.measures[bound.measure]
    value = bound.limit + bound.sign * bound.size * best.margins.min()
    side = "below" if bound.sign > 0 else "above"
    name = label_of(measure)
    unit = measure.unit if isinstance(measure, AbstractMeasure) else ""
    value, limit = (shown_number(x, unit) for x in (value, bound.limit))
    return f"; {name} is {value}, {side} its bound {limit}"


def _near_by(problem: Problem, trials: Trials, best: Trial) -> str:
    """The rejected design nearest to the best one, in words; empty if none is near."""
    if not trials.rejected:
        return ""
    away = [np.abs(trial.unit - best.unit).max() for trial in trials.rejected]
    if min(away) > NEAR:
        return ""
    trial = trials.rejected[int(np.argmin(away))]
    where = _values_in_words(problem, trial)
    return f"; rejected near by, at {where}: {trial.fault}"


def _values_in_words(problem: Problem, trial: Trial) -> str:
    values = problem.values(trial.unit)
    names = [variable.name for variable in problem.variables]
    pairs = zip(names, values, strict=True)
    return ", ".join(f"{name} = {value:.6g}" for name, value in pairs)


def _idle_variables(problem: Problem, trials: Trials) -> str:
    """Variables on which nothing depended at any step, in words; empty if none."""
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
    known = descent or callable(method) or method in METHODS
    allowed = f"one of {', '.join(METHODS)}, or an Optax gradient transformation"
    must_be("optimise", "method", method, known, allowed)
    if constraints and method != "slsqp":
        raise ValueError(
            f"optimise: `method` is {method!r}, which keeps no constraints; take"
            " 'slsqp'."
        )
    return method


def _check_cases(cases, kind):
    of_class("optimise", "cases", cases, kind, f"a {kind.__name__}")
    if isinstance(cases, Cases) and cases.design is not None:
        raise ValueError("optimise: `cases` have several designs; give one element.")


def _check_call(objective, constraints, max_steps, tolerance):
    allowed = "a function (element, cases, solution) -> scalar, such as PeakPressure()"
    of_class("optimise", "objective", objective, Callable, allowed)
    all_of_class("optimise", "constraints", constraints, Constraint, "Constraints")
    count("optimise", "max_steps", max_steps)
    small = 0.0 < tolerance < 0.1
    must_be("optimise", "tolerance", tolerance, small, "above 0 and below 0.1")

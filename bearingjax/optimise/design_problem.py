"""A design with variables: objective, constraints, gradients over its cases."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..cases.cases import Cases
from ..numerics.compiled.programs import program
from ..numerics.result import Result, SolveError
from ..numerics.units import unit
from ..numerics.warning import Warning
from ..statics.options import SolveOptions
from ..statics.support import RESTRAINED, Support
from ..statics.warning import solution_warnings
from .constraint import Constraint
from .life import OfLife
from .measure import exact_of, least_size_of
from .system import (
    AbstractSystem,
    Design,
    describe_failure,
    has_loads,
    loads_of,
    prepare,
    solved_case,
)
from .trials import Trial
from .variable import Variable, with_values

CHUNK = 64
"""Most cases that are solved as one batch."""

Measure = Callable[[Any, Cases, Any], Any]
Build = Callable[[Any], Any]


class Outcome(NamedTuple):
    """A design and its results.

    Attributes:
        values: Values of the variables (variable,) [SI].
        objective: The objective, smooth.
        exact: The objective with the true maximum in place of the smooth one.
        constraints: The measures that are bounded, smooth (constraint,).
        exact_constraints: Constraints with true maxima and minima (constraint,).
        solution: Solution of all cases, leading axis case.
        doubts: Gives the warnings of the rating life among the measures, if one is,
            and of a system.
    """

    values: Annotated[np.ndarray, unit("SI")]
    objective: float
    exact: float
    constraints: np.ndarray
    exact_constraints: np.ndarray
    solution: Any
    doubts: Callable[[], list[Warning]] = list

    @property
    def warnings(self) -> list[Warning]:
        """A warning of each kind: in how many cases, and the worst."""
        found = self.solution
        texts = solution_warnings(loads_of(found)) if has_loads(found) else []
        return [*texts, *self.doubts()]


class Bound(NamedTuple):
    """One bound of a constraint: sign * (measure - limit)/size ≥ 0."""

    measure: int
    sign: float
    limit: float
    size: float


class Problem:
    """An optimisation, its variables scaled by their bounds to the unit box (0 to 1).

    Args:
        element, cases, variables, objective, constraints: As in `optimise`, checked.
        options: Numerics of the solves.
        support: What holds the rings.
        build: As in `optimise`.
    """

    def __init__(
        self,
        element: Design,
        cases: Any,
        variables: Sequence[Variable],
        objective: Measure,
        constraints: Sequence[Constraint],
        options: SolveOptions,
        support: Support = RESTRAINED,
        build: Build | None = None,
    ):
        self.element, self.variables = element, variables
        self.constraints = constraints
        self.cases = jax.tree.map(jnp.asarray, cases)
        self.measures = (objective, *(c.measure for c in constraints))
        self.solves, self.build = (support, options), build
        self.paths = tuple(variable.path for variable in variables)
        self.lower = np.array([v.lower for v in variables])
        self.upper = np.array([v.upper for v in variables])
        self.width = self.upper - self.lower
        self.bounds = tuple(_bounds(constraints))
        self.size = 1.0

    def to_unit_box(self, values: Any) -> np.ndarray:
        """Values of the variables in the unit box."""
        return (np.asarray(values) - self.lower) / self.width

    def values(self, unit: np.ndarray) -> np.ndarray:
        """Values of the variables [SI], exact at the bounds."""
        inside = np.clip(self.lower + self.width * unit, self.lower, self.upper)
        return np.where(unit >= 1.0, self.upper, inside)

    def begin(self, unit: np.ndarray, slopes: bool) -> Trial:
        """Evaluate the start, and take the size of its objective as the scale.

        Raises:
            SolveError: If it does not solve.
        """
        trial = self.evaluate(unit, slopes)
        if trial.fault:
            raise SolveError(f"optimise: the starting design fails: {trial.fault}")
        size = max(abs(trial.objective), least_size_of(self.measures[0]))
        self.size = size or 1.0
        slope = None if trial.slope is None else trial.slope / self.size
        return trial._replace(objective=trial.objective / self.size, slope=slope)

    def outcome(self, trial: Trial) -> tuple[Any, Outcome]:
        """The design of a trial and its results, by the program already compiled."""
        values = self.values(trial.unit)
        element = prepare(with_values(self.element, self.paths, values), self.build)
        found = self.run(trial.unit, trial.slope is not None)
        smooth, exact = np.asarray(found.measures), np.asarray(found.exact)
        return element, Outcome(
            values,
            float(smooth[0]),
            float(exact[0]),
            smooth[1:],
            exact[1:],
            found.solution,
            self._doubts(element, found.solution),
        )

    def _doubts(self, element, solution) -> Callable[[], list[Warning]]:
        lives = (m.warnings for m in self.measures if isinstance(m, OfLife))
        asked = [partial(warn, element, solution) for warn in lives][:1]
        if isinstance(element, AbstractSystem):
            asked.append(partial(element.warnings, self.cases, lambda: solution))
        return lambda: [text for warn in asked for text in warn()]

    def run(self, unit: np.ndarray | jax.Array, slopes: bool) -> "Run":
        """Solve the cases of a design, with gradients or without."""
        whole = self.element
        if isinstance(whole, AbstractSystem) and whole.is_solved_by_parts(self.cases):
            return self._run_by_parts(unit, slopes)
        return _program(
            self.element,
            self.cases,
            self.measures,
            (self.paths, jnp.asarray(self.lower), jnp.asarray(self.width)),
            self.solves,
            self.build,
            jnp.asarray(unit),
            slopes,
        )

    def _run_by_parts(self, unit, slopes) -> "Run":
        def design_at(unit):
            values = self.lower + self.width * unit
            return prepare(with_values(self.element, self.paths, values), self.build)

        def change_along(way):
            return eqx.filter_jvp(design_at, (unit,), (way,))[1]

        changes = None
        if slopes:
            changes = jax.device_get(eqx.filter_vmap(change_along)(np.eye(unit.size)))
        whole: Any = design_at(unit)
        solution, moved = whole.solve_by_parts(self.cases, changes)
        given = self.measures, self.cases, whole, solution
        measures, exact = judge(*given)
        jacobian = None if moved is None else _judge_changes(*given, changes, moved).T
        return Run(measures, exact, solution, jacobian)

    def evaluate(self, unit: np.ndarray | jax.Array, slopes: bool) -> Trial:
        """The trial of a design.

        Args:
            unit: Variables in the unit box (variable,).
            slopes: Whether gradients are wanted.
        """
        unit, nothing = np.asarray(unit), np.zeros(0)
        failed = Trial(unit, np.nan, None, nothing, None)
        try:
            with_values(self.element, self.paths, self.values(unit))
        except ValueError as error:
            return failed._replace(fault=f"not a design: {error}", solved=False)
        found = self.run(unit, slopes)
        fault = _fault(self.element, found)
        if fault:
            return failed._replace(fault=fault)
        # Searches are done in float64, also where the bearing is solved in float32.
        values = np.asarray(found.measures, dtype=float)
        margins = [b.sign * (values[b.measure] - b.limit) / b.size for b in self.bounds]
        slope = margin_slopes = None
        if slopes:
            jacobian = np.asarray(found.jacobian, dtype=float)
            slope = jacobian[0] / self.size
            rows = [b.sign * jacobian[b.measure] / b.size for b in self.bounds]
            margin_slopes = np.array(rows).reshape(len(rows), unit.size)
        objective = float(values[0]) / self.size
        return Trial(unit, objective, slope, np.array(margins), margin_slopes)


class Run(NamedTuple):
    """Results of the compiled program.

    Attributes:
        measures: Objective and constrained measures, smooth (measure,).
        exact: Measures with true maxima and minima (measure,).
        solution: Solution of all cases, leading axis case.
        jacobian: d(measures)/d(unit) (measure, variable), if asked for.
    """

    measures: Any
    exact: Any
    solution: Any
    jacobian: Any


@program
def _program(element, cases, measures, box, solves, build, unit, slopes) -> Run:
    paths, lower, width = box

    def outputs(unit):
        design = prepare(with_values(element, paths, lower + width * unit), build)

        def solve_one(case):
            return solved_case(design, case, *solves)

        if cases.count <= CHUNK:
            solution = jax.vmap(solve_one)(cases)
        else:
            solution = jax.lax.map(solve_one, cases, batch_size=CHUNK)
        values, exact = judge(measures, cases, design, solution)
        return values, (values, exact, solution)

    if slopes:
        jacobian, found = jax.jacrev(outputs, has_aux=True)(unit)
    else:
        jacobian, found = None, outputs(unit)[1]
    measured, exact, solution = found
    return Run(measured, exact, solution, jacobian)


@program(quick=True)
def judge(
    measures: tuple[Measure, ...], cases: Any, design: Design, solution: Any
) -> tuple[Any, Any]:
    """Return the measures (measure,), smooth and exact.

    Args:
        measures: As in `optimise`.
        cases, design: Operating cases, and the design.
        solution: Solution of the cases, leading axis case.
    """
    values = [_scalar(m, m(design, cases, solution)) for m in measures]
    exact = [exact_of(m, design, cases, solution) for m in measures]
    return jnp.stack(values), jnp.stack(exact)


@program(quick=True)
def _judge_changes(measures, cases, design, solution, *changes):
    """Return changes of the measures, smooth (change, measure)."""

    def smooth(design, solution):
        return judge(measures, cases, design, solution)[0]

    def push(*change):
        return eqx.filter_jvp(smooth, (design, solution), change)[1]

    return jax.vmap(push)(*changes)


def _scalar(measure, value):
    if jnp.shape(value) != ():
        raise ValueError(
            f"optimise: the measure {measure} returns shape {jnp.shape(value)}; it must"
            " return one number."
        )
    return jnp.asarray(value)


def _bounds(constraints):
    for k, constraint in enumerate(constraints):
        for sign, limit in ((1.0, constraint.lower), (-1.0, constraint.upper)):
            if limit is not None:
                yield Bound(k + 1, sign, float(limit), abs(float(limit)) or 1.0)


def _fault(design: Design, found: Run) -> str:
    """Reason for rejecting an evaluated design, in words; empty if accepted."""
    results = np.asarray(found.solution.result)
    if results.any():
        k = int(np.argmax(results))
        one = jax.tree.map(lambda leaf: leaf[k], found.solution)
        label = Result(int(results[k])).label
        return f"case {k}: {label}: {describe_failure(design, one)}"
    if not np.isfinite(found.measures).all():
        return f"a measure is not finite: {np.asarray(found.measures).tolist()}"
    if found.jacobian is not None and not np.isfinite(found.jacobian).all():
        return f"a gradient is not finite: {np.asarray(found.jacobian).tolist()}"
    return ""

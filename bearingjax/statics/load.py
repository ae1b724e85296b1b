"""Displacement of the rings under load: `solve_load`, and `solve` with settings in one.

A load solve has three parts: the balance (what is free, what is held, in which unit),
the search for the equilibrium, and the solution with its result code.
"""

from collections.abc import Sequence
from typing import Any, TypedDict, Unpack, overload

import jax
from jaxtyping import Array, Int

from ..design import AbstractBallBearing, AbstractRollerBearing, rows_of
from ..design.bearing_set import pitch_radius
from ..design.checks import is_traced
from ..element.bearing_element import BearingElement, check_element
from ..element.bearing_model import BearingModel
from ..element.inertia import Speed
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient, unless_failed
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar
from .balance import balance_of
from .load_case import LoadCase, Prescribed, Vector, load_case
from .load_result import solution_of
from .load_search import search, search_start
from .options import SolveOptions
from .solution import (
    BallSolution,
    RollerSolution,
    Solution,
    failure_message,
    no_load_path,
)


class _Choices(TypedDict, total=False):
    """Keyword arguments of `solve_load`."""

    prescribed: Prescribed | None
    free: Sequence[str] | None
    fixed_ring: str
    fixed_displacement: Vector | None
    speed: Speed | None
    points: int
    tolerance: float | Scalar | None
    max_steps: int | Int[Array, ""]
    start: Vector | None
    throw: bool


@overload
def solve_load(
    element: BearingElement[AbstractRollerBearing],
    load: Vector | None = None,
    **choices: Unpack[_Choices],
) -> RollerSolution: ...
@overload
def solve_load(
    element: BearingElement[AbstractBallBearing],
    load: Vector | None = None,
    **choices: Unpack[_Choices],
) -> BallSolution: ...
@overload
def solve_load(
    element: BearingElement,
    load: Vector | None = None,
    **choices: Unpack[_Choices],
) -> Solution: ...
def solve_load(
    element: BearingElement,
    load: Vector | None = None,
    *,
    prescribed: Prescribed | None = None,
    free: Sequence[str] | None = None,
    fixed_ring: str = "outer",
    fixed_displacement: Vector | None = None,
    speed: Speed | None = None,
    points: int = 101,
    tolerance: float | Scalar | None = None,
    max_steps: int | Int[Array, ""] = 200,
    start: Vector | None = None,
    throw: bool = True,
) -> Solution:
    """Equilibrium of a bearing under any mix of loads and displacements.

    Args:
        element: The bearing.
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring at the origin [N, N m];
            `None` is no load. A load on a freedom that is held, prescribed or left out
            of `free`, is an error: the support would take it, unseen by the bearing.
        prescribed: Displacements given instead of loads, by freedom name [m, rad];
            their loads are results; gz turns the set of rollers.
        free: Freedoms of the moving ring that may move. Default: all that the
            bearing can restrain and that are not prescribed; a load on any other is
            then "no load path". The others are held at zero; what holds them there
            is a result.
        fixed_ring: "outer" or "inner".
        fixed_displacement: Displacement of the fixed ring (6,) [m, rad]; default 0.
        speed: Ring speeds; `None`: no inertia.
        points: Positions along the rollers at which loads are reported.
        tolerance: Relative residual at which the solve ends; default 1e-11 in
            float64, 1e-4 in float32.
        max_steps: Step limit of the load solve.
        start: Displacement of the moving ring (6,) from which the solve starts, such
            as that under a load near by; NaN, farther than the pitch radius, or
            `None`: from first contact [m, rad].
        throw: Raise if the solve fails, outside or under `jit`; otherwise read
            `solution.result`.

    Returns:
        Solution, differentiable with respect to design, load, prescribed values and
        speeds (implicit function theorem). With respect to a load along which the ring
        floats they are infinite, or NaN; `warnings` reports such directions.
        Derivatives of a failed solve are NaN, and zero where it is masked.

    Raises:
        TypeError: For a bearing in place of an element, or text in place of numbers.
        ValueError: For unknown names, contradictory choices or non-finite input.
        SolveError: If the solve did not converge and `throw` is set.

    Fails: `STEP_LIMIT`, `NO_LOAD_PATH` (freedom in `solution.unrestrained`; so too a
        traced load on a held freedom), `NON_FINITE`, `SADDLE` (finite kinematics).
    """
    check_element("solve_load", element)
    options = SolveOptions(free, fixed_ring, points, tolerance, max_steps)
    solution = solve(
        element,
        load,
        options,
        prescribed=prescribed,
        fixed_displacement=fixed_displacement,
        speed=speed,
        start=start,
    )
    return raise_if_failed(solution, "solve_load") if throw else solution


def solve(
    element: BearingElement,
    load: Any,
    options: SolveOptions,
    *,
    prescribed: Any = None,
    fixed_displacement: Any = None,
    speed: Speed | None = None,
    start: Any = None,
) -> Solution:
    """Solve as `solve_load`, with settings in one object; no error if the solve fails.

    Args:
        element: The bearing.
        load, prescribed, fixed_displacement, start: As in `solve_load`, which are
            checked here.
        options: Settings.
        speed: As in `solve_load`.
    """
    options.check("solve_load")
    case = load_case(
        element.bearing,
        load,
        options,
        prescribed=prescribed,
        fixed_displacement=fixed_displacement,
        speed=speed,
        start=start,
    )
    options = options.for_dtype(case.load.dtype)
    # Called as it is, the model is worked out in the one program that is called: to
    # start another takes half the time of a solve. Within a loop over cases, once.
    known = any(is_traced(leaf) for leaf in jax.tree.leaves(case))
    return _solve(element, element.model(speed) if known else None, case, options)


@program(quick=True, level=1)
def _solve(
    element: BearingElement,
    model: BearingModel | None,
    case: LoadCase,
    options: SolveOptions,
) -> Solution:
    model = element.model(case.speed) if model is None else model
    balance = balance_of(
        case, pitch_radius(element.bearing), options.moving_ring == "outer"
    )
    # The search is not differentiated: derivatives are those of its end.
    frozen, still = stop_gradient(model), stop_gradient(balance)
    rows = rows_of(stop_gradient(element.bearing))
    begin = search_start(rows, frozen, still, stop_gradient(case.start))
    minimum = search(frozen, still, begin, options)

    def solution(element, model, balance, case):
        return solution_of(element, model, balance, case, options, begin, minimum)

    given, solved = (element, model, balance, case), minimum.result == Result.CONVERGED
    return unless_failed(solution, given, solved)


def raise_if_failed(solution: Solution, owner: str) -> Solution:
    """The solution, or an exception that says why it failed, also under `jit`.

    Args:
        solution: Solution of one case.
        owner: Function that was called.

    Raises:
        SolveError: If it did not converge.
    """
    return raise_unless_converged(
        solution,
        solution.result,
        lambda: failure_message(solution, solution.moving_ring),
        owner,
        (solution.unrestrained, [no_load_path(solution, k) for k in range(6)]),
    )

"""Displacement of the rings under load: `solve_load`.

A load solve has three parts: the balance (what is free, what is held, in which unit),
the search for the equilibrium, and the solution with its result code.
"""

from typing import Any, TypedDict, Unpack, overload

import jax
import numpy as np

from ..design import AbstractBallBearing, AbstractRollerBearing, rows_of
from ..design.bearing_set import pitch_radius
from ..design.checks import is_traced
from ..element import BearingElement, BearingModel, Speed
from ..element.bearing_element import check_element
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient, unless_failed
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import as_array, with_fields
from .balance import balance_of
from .empty_places import of_kind, points_of_kind, without_empty_places
from .load_case import LoadCase, Vector, load_case
from .load_result import solution_of
from .load_search import search, search_start
from .options import SolveOptions
from .solution import (
    BallSolution,
    RollerSolution,
    Solution,
    no_load_path,
)
from .support import RESTRAINED, Support


class _Choices(TypedDict, total=False):
    """Keyword arguments of `solve_load`."""

    speed: Speed | None
    support: Support
    options: SolveOptions | None
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
    speed: Speed | None = None,
    support: Support = RESTRAINED,
    options: SolveOptions | None = None,
    start: Vector | None = None,
    throw: bool = True,
) -> Solution:
    """Equilibrium of a bearing under any mix of loads and displacements.

    Args:
        element: The bearing.
        load: (Fx, Fy, Fz, Mx, My, Mz) on the moving ring at the origin [N, N m];
            `None` is no load. A load on a freedom that is held, prescribed or left out
            of `free`, is an error: its support would take it, unseen by the bearing.
        speed: Ring speeds; `None`: no inertia.
        support: What holds the rings: freedoms that are free or prescribed, the fixed
            ring. Default: the outer ring is fixed, and the inner one moves in all that
            the bearing can restrain.
        options: Numerics: positions along the rollers, tolerance, step limit.
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
    solution = solve(element, load, support, options, speed=speed, start=start)
    return raise_if_failed(solution, "solve_load") if throw else solution


def solve(
    element: BearingElement,
    load: Any,
    support: Support = RESTRAINED,
    options: SolveOptions | None = None,
    *,
    speed: Speed | None = None,
    start: Any = None,
) -> Solution:
    """Solve as `solve_load`, of an element that is one; no error if the solve fails.

    Args: as `solve_load`.
    """
    case = load_case(element.bearing, load, support, speed=speed, start=start)
    options = SolveOptions() if options is None else options
    options = options.for_dtype(case.load.dtype)
    if any(is_traced(leaf) for leaf in jax.tree.leaves(case)):
        # Within a loop over cases the model is worked out once.
        return _solve(element, element.model(speed), case, options)
    if any(is_traced(leaf) for leaf in jax.tree.leaves(element)):
        return _solve(element, None, case, options)
    # Called as it is, the model is worked out in the one program that is called: to
    # start another takes half the time of a solve. It serves all bearings of a kind,
    # all supports, and solves that start anywhere (NaN: from first contact).
    begin = case.start
    if begin is None:
        begin = as_array(np.full(6, np.nan), case.load.dtype)
    alike = with_fields(case, free=(), held=(), start=begin)
    points = points_of_kind(element, options.points)
    options = with_fields(options, points=points)
    found = _solve(of_kind(element), None, alike, options)
    found = with_fields(found, free=case.free, held=case.held)
    return without_empty_places(found, element)


@program(quick=True, often=True, what="solving a bearing under load")
def _solve(
    element: BearingElement,
    model: BearingModel | None,
    case: LoadCase,
    options: SolveOptions,
) -> Solution:
    model = element.model(case.speed) if model is None else model
    balance = balance_of(case, pitch_radius(element.bearing))
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

    Raises:
        SolveError: If it did not converge.
    """
    return raise_unless_converged(
        solution,
        solution.result,
        lambda: solution.failure_message,
        owner,
        (solution.unrestrained, [no_load_path(solution, k) for k in range(6)]),
    )

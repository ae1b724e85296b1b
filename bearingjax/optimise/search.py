"""Searches for the least objective in the unit box: by SciPy, and descent by Optax."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from .trials import Trial, Trials, optimality, projected_gradient

METHODS = ("l-bfgs-b", "slsqp", "adam", "nelder-mead")
"""Searches by name; any Optax gradient transformation is another."""

FIRST_STEP = 0.1
"""Size of the first simplex, and about that of Adam's first steps [size of the box]."""

_LENGTHS = (0.1, 0.03, 0.01, 0.003)
"""Lengths of the steps that are tried where a search gave up [size of the box]."""

_TURNS = tuple(np.deg2rad([45.0, 75.0, 87.0]))
"""Angles of these steps to the steepest descent, to pass along the edge of the rejected
designs [rad]."""

_RUNS = 10
"""Most starts of a search."""

_PATIENCE = 20
"""Rejected designs after which a search is restarted."""

_ROUND_OFF = 1e-13
"""Change of the objective, over its size at the start, at which SciPy's searches end:
it is round-off. Whether they converged is judged by the gradient (`is_minimum`)."""


def takes_gradients(method: Any) -> bool:
    """Whether a search uses gradients; a user's own search does not.

    Args: as `search`.
    """
    return not (method == "nelder-mead" or callable(method))


class SearchOutcome(NamedTuple):
    """Outcome of a search.

    Attributes:
        unit: Variables in the unit box (variable,).
        converged: Whether the method reports that it has converged.
        text: Message of the method.
        limited: Whether the step limit was reached.
    """

    unit: np.ndarray
    converged: bool
    text: str
    limited: bool = False


class _Flat(Exception):
    """The last step fulfils the first-order conditions."""


class _Stuck(Exception):
    """A method has tried too many designs that were rejected."""


def search_least(
    method: Any,
    trials: Trials,
    n_bounds: int,
    max_steps: int,
    tolerance: float,
    on_step: Callable[[], None] = lambda: None,
) -> SearchOutcome:
    """Look for the least objective with all margins at least 0.

    A method with gradients ends where the first-order conditions hold. If it gives up
    before, usually at rejected designs, it is restarted from a better design near the
    best one, if there is any.

    Args:
        method: One of `METHODS`, an Optax gradient transformation, or a user's own
            search: (attempt, start, max_steps, tolerance, step) -> `SearchOutcome`.
        trials: Evaluates and records; its first step is the start.
        n_bounds: Number of margins.
        max_steps: Step limit.
        tolerance: See `optimise`.
        on_step: Called after every step.
    """
    slopes, run = takes_gradients(method), _method(method, n_bounds, max_steps)

    def attempt(unit):
        trial = trials.attempt(unit, slopes)
        if slopes and len(trials.rejected) > patience:
            raise _Stuck
        return trial

    def step(unit):
        trial = attempt(unit)
        trials.accept(trial)
        on_step()
        if slopes and not trial.fault and is_minimum(trial, tolerance):
            raise _Flat

    best, patience, begun = trials.steps[0], np.inf, 0
    if slopes and is_minimum(best, tolerance):
        return SearchOutcome(
            best.unit, True, "the start fulfils the first-order conditions"
        )
    try:
        while True:
            begun += 1
            left = max(1, max_steps + 1 - len(trials.steps))
            patience = len(trials.rejected) + _PATIENCE
            try:
                ending = run(attempt, best.unit, left, tolerance, step)
            except _Stuck:
                ending = SearchOutcome(best.unit, False, "rejected designs bar the way")
            patience = np.inf
            last = attempt(ending.unit)
            ends = trials.steps if last.fault else [*trials.steps, last]
            best = min(ends, key=lambda trial: _merit(trial, tolerance))
            ending = ending._replace(unit=best.unit)
            if not slopes or ending.limited or len(trials.steps) > max_steps:
                return ending
            better = _improve_nearby(attempt, best, bool(trials.rejected), tolerance)
            if better is None or begun == _RUNS:
                return ending._replace(converged=False)
            best = better
            step(best.unit)
    except _Flat:
        unit = trials.steps[-1].unit
        return SearchOutcome(unit, True, "the first-order conditions hold")


def is_minimum(trial: Trial, tolerance: float) -> bool:
    """Whether the first-order conditions of a minimum hold.

    Args:
        trial: With gradients.
        tolerance: Tolerance of `optimality`, and of the bounds.
    """
    flat = optimality(trial, tolerance) <= tolerance
    return flat and trial.violation <= tolerance


def _merit(trial, tolerance):
    """Key that compares designs: first the violation, if any, then the objective."""
    missed = trial.violation if trial.violation > tolerance else 0.0
    return missed, trial.objective


def _improve_nearby(attempt, here, rejected, tolerance) -> Trial | None:
    """A design nearby that is better by a tenth or more of what the slope predicts.

    Tried are steps along the steepest descent and, if designs were rejected, steps
    turned to all sides, to pass along the edge of the rejected designs.
    """
    from scipy.linalg import null_space

    if here.violation > tolerance:
        way = here.margin_slopes[np.argmin(here.margins)]
    else:
        way = -projected_gradient(here, tolerance)
    slope = float(np.linalg.norm(way))
    if slope == 0.0:
        return None
    down = way / slope
    ways = [(1.0, down)]
    if rejected:
        aside = null_space(down[None]).T
        ways += [
            (np.cos(turn), np.cos(turn) * down + sign * np.sin(turn) * side)
            for turn in _TURNS
            for side in aside
            for sign in (1.0, -1.0)
        ]
    for length in _LENGTHS:
        for share, along in ways:
            unit = np.clip(here.unit + length * along, 0.0, 1.0)
            promised = length * share * slope
            new = attempt(unit)
            if new.fault or np.array_equal(unit, here.unit):
                continue
            if here.violation > tolerance:
                gain = here.violation - new.violation
            elif new.violation > tolerance:
                continue
            else:
                gain = here.objective - new.objective
            if gain > 0.1 * promised:
                return new
    return None


def _method(method, n_bounds, max_steps) -> Callable[..., SearchOutcome]:
    """The search as a function of attempt, start, max_steps, tolerance, step."""
    if method in ("l-bfgs-b", "slsqp"):
        return lambda *given: _quasi_newton(method, n_bounds, *given)
    if method == "nelder-mead":
        return _simplex
    if not takes_gradients(method):
        return method
    if method == "adam":
        import optax

        rate = optax.cosine_decay_schedule(0.5 * FIRST_STEP, max_steps)
        method = optax.adam(rate)
    return lambda *given: _descent(method, *given)


def _quasi_newton(method, n_bounds, attempt, start, max_steps, tolerance, step):
    from scipy.optimize import minimize

    # `step` ends the search, by the gradient.
    options: dict[str, Any] = {"ftol": _ROUND_OFF, "maxiter": max_steps}
    if method == "l-bfgs-b":
        options |= {"gtol": 0.0, "maxfun": 20 * max_steps}
    kept = {
        "type": "ineq",
        "fun": lambda x: attempt(x).margins,
        "jac": lambda x: attempt(x).margin_slopes,
    }

    def slope(x):
        # SLSQP asks for gradients only at points that it has accepted; its callback is
        # called for every full step, accepted or not.
        if method == "slsqp":
            if attempt(x).fault:
                raise _Stuck
            step(x)
        return attempt(x).slope

    found = minimize(
        lambda x: attempt(x).objective,
        start,
        jac=slope,
        method=method,
        bounds=[(0.0, 1.0)] * start.size,
        constraints=[kept] if n_bounds else (),
        options=options,
        callback=step if method == "l-bfgs-b" else None,
    )
    return SearchOutcome(
        np.clip(found.x, 0.0, 1.0),
        bool(found.success),
        str(found.message),
        found.status == (1 if method == "l-bfgs-b" else 9),
    )


def _simplex(attempt, start, max_steps, tolerance, step):
    from scipy.optimize import minimize

    inward = np.where(start > 0.5, -FIRST_STEP, FIRST_STEP)
    corners = np.concatenate([start[None], start + np.diag(inward)])
    options = {
        "initial_simplex": corners,
        "xatol": tolerance,
        "fatol": tolerance,
        "maxiter": max_steps,
        "maxfev": 100 * max_steps,
    }
    found = minimize(
        lambda x: attempt(x).objective,
        start,
        method="nelder-mead",
        bounds=[(0.0, 1.0)] * start.size,
        options=options,
        callback=step,
    )
    converged = bool(found.success)
    return SearchOutcome(found.x, converged, str(found.message), not converged)


def _descent(transformation, attempt, start, max_steps, tolerance, step):
    """Steps of an Optax transformation, projected onto the box; the best point counts.

    A rejected step is taken back, and all that follow are half as long.
    """
    from optax.projections import projection_box

    point = jnp.asarray(start)
    # Optax relies on JAX's standard promotion of dtypes.
    with jax.numpy_dtype_promotion("standard"):
        state = transformation.init(point)
    here = attempt(start)
    share = 1.0
    for _ in range(max_steps):
        slope = jnp.asarray(here.slope)
        with jax.numpy_dtype_promotion("standard"):
            updates, state = transformation.update(slope, state, point)
        target = projection_box(point + share * updates, 0.0, 1.0)
        new = attempt(np.asarray(target))
        if new.fault:
            share = 0.5 * share
            continue
        point, here = target, new
        step(here.unit)
    text = f"step limit reached after {max_steps} steps"
    return SearchOutcome(here.unit, False, text, True)

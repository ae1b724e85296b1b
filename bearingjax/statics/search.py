"""Searches for the least objective in the unit box: SciPy's, and Optax's descents."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

METHODS = ("l-bfgs-b", "slsqp", "adam", "nelder-mead")
"""Searches by name; any Optax gradient transformation is another."""

FIRST_STEP = 0.1
"""Size of the first simplex, and about that of Adam's first steps, of the box."""


def takes_gradients(method: Any) -> bool:
    """Whether a search asks for gradients; one's own does not.

    Args:
        method: As of `search`.
    """
    return not (method == "nelder-mead" or callable(method))


class Trial(NamedTuple):
    """One design that was tried, in scaled numbers.

    Attributes:
        unit: Variables, 0 at the lower and 1 at the upper bound (variable,).
        objective: Objective over its size at the start.
        slope: Its gradient (variable,), or `None`: not asked for.
        margins: What is left to each bound of the constraints over the size of that
            bound, ≥ 0 where it is kept (bound,).
        margin_slopes: Their gradients (bound, variable), or `None`.
        fault: Why the design was rejected; empty if it was not.
    """

    unit: np.ndarray
    objective: float
    slope: np.ndarray | None
    margins: np.ndarray
    margin_slopes: np.ndarray | None
    fault: str = ""

    @property
    def violation(self) -> float:
        """By how much the worst constraint is missed; 0 if all are kept."""
        return float(max(0.0, -self.margins.min(initial=0.0)))


class Ending(NamedTuple):
    """How a search ended.

    Attributes:
        unit: Where (variable,).
        settled: Whether the method says that it has converged.
        text: What the method says.
    """

    unit: np.ndarray
    settled: bool
    text: str


Try = Callable[[np.ndarray], Trial]
Step = Callable[[np.ndarray], None]


def search(
    method: Any,
    attempt: Try,
    start: np.ndarray,
    n_bounds: int,
    max_steps: int,
    tolerance: float,
    step: Step,
) -> Ending:
    """Look for the least objective with all margins at least 0.

    Args:
        method: One of `METHODS`, an Optax gradient transformation, or a search of
            one's own: attempt, start, max_steps, tolerance, step -> `Ending`.
        attempt: From a point in the box to its trial; a rejected one has the numbers
            of a cone that rises away from the last step, so that searches turn back.
        start: First point (variable,).
        n_bounds: Number of margins.
        max_steps: Step limit.
        tolerance: See `optimise`.
        step: Told every point that the search moves to.
    """
    if method in ("l-bfgs-b", "slsqp"):
        return _quasi_newton(
            method, attempt, start, n_bounds, max_steps, tolerance, step
        )
    if method == "nelder-mead":
        method = _simplex
    if not takes_gradients(method):
        return method(attempt, start, max_steps, tolerance, step)
    if method == "adam":
        import optax

        rate = optax.cosine_decay_schedule(0.5 * FIRST_STEP, max_steps)
        method = optax.adam(rate)
    return _descent(method, attempt, start, max_steps, tolerance, step)


def stationarity(trial: Trial, near: float = 1e-6) -> float:
    """Largest part of the gradient that no bound and no active constraint holds back.

    Zero at a minimum (Karush, Kuhn and Tucker). Without active constraints it is the
    projected gradient.

    Args:
        trial: With gradients.
        near: How near a bound counts as on it.
    """
    from scipy.optimize import nnls

    if trial.slope is None or trial.margin_slopes is None:
        return np.nan
    axes = np.eye(trial.unit.size)
    holds = [
        *axes[trial.unit <= near],
        *-axes[trial.unit >= 1.0 - near],
        *trial.margin_slopes[trial.margins <= near],
    ]
    if not holds:
        return float(np.abs(trial.slope).max())
    matrix = np.stack(holds, axis=1)
    weights, _ = nnls(matrix, trial.slope)
    return float(np.abs(trial.slope - matrix @ weights).max())


def _quasi_newton(method, attempt, start, n_bounds, max_steps, tolerance, step):
    from scipy.optimize import minimize

    # Near a minimum the objective is off by the square of the gradient.
    if method == "l-bfgs-b":
        options: dict[str, Any] = {"gtol": tolerance, "ftol": tolerance**2}
        options["maxfun"] = 20 * max_steps
    else:
        options = {"ftol": tolerance**2}
    kept = {
        "type": "ineq",
        "fun": lambda x: attempt(x).margins,
        "jac": lambda x: attempt(x).margin_slopes,
    }

    def slope(x):
        # SLSQP asks for gradients where it has arrived; its callback tells of every
        # full step, taken or not.
        if method == "slsqp":
            step(x)
        return attempt(x).slope

    found = minimize(
        lambda x: attempt(x).objective,
        start,
        jac=slope,
        method=method,
        bounds=[(0.0, 1.0)] * start.size,
        constraints=[kept] if n_bounds else (),
        options={**options, "maxiter": max_steps},
        callback=step if method == "l-bfgs-b" else None,
    )
    return Ending(np.clip(found.x, 0.0, 1.0), bool(found.success), str(found.message))


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
    return Ending(found.x, bool(found.success), str(found.message))


def _descent(transformation, attempt, start, max_steps, tolerance, step):
    """Steps of an Optax transformation, projected onto the box; the best point counts.

    A rejected step is taken back, and all that follow are half as long.
    """
    from optax.projections import projection_box

    point = jnp.asarray(start)
    # Optax counts on JAX's standard promotion of dtypes.
    with jax.numpy_dtype_promotion("standard"):
        state = transformation.init(point)
    here = best = attempt(start)
    share = 1.0
    for _ in range(max_steps):
        assert here.slope is not None
        if stationarity(here) <= tolerance:
            text = f"gradient below {tolerance:g}"
            return Ending(here.unit, True, text)
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
        best = min(best, here, key=lambda trial: trial.objective)
    return Ending(best.unit, False, f"gradient above {tolerance:g}")

"""Designs that a search has tried, and how far each is from a minimum."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np


class Trial(NamedTuple):
    """One design that was tried, in scaled numbers.

    Attributes:
        unit: Variables, 0 at the lower and 1 at the upper bound (variable,).
        objective: Objective over its size at the start.
        slope: Its gradient (variable,), or `None`: not worked out.
        margins: Distance to each bound of the constraints over the size of that bound,
            ≥ 0 where it is kept (bound,).
        margin_slopes: Their gradients (bound, variable), or `None`.
        fault: Why the design was rejected; empty if it was not.
        solved: Whether its cases were solved at all.
    """

    unit: np.ndarray
    objective: float
    slope: np.ndarray | None
    margins: np.ndarray
    margin_slopes: np.ndarray | None
    fault: str = ""
    solved: bool = True

    @property
    def violation(self) -> float:
        """Largest violation of a constraint; 0 if all are kept."""
        return float(max(0.0, -self.margins.min(initial=0.0)))


def projected_gradient(trial: Trial, near: float) -> np.ndarray:
    """Part of the gradient that no bound and no active constraint cancels (variable,).

    A step against it lowers the objective and, to first order, keeps all bounds. It is
    zero at a minimum: these are the conditions of Karush, Kuhn and Tucker, with
    multipliers of the right sign.

    Args:
        trial: With gradients.
        near: Distance within which a bound of a variable or a constraint is active.
    """
    from scipy.optimize import nnls

    if trial.slope is None or trial.margin_slopes is None:
        return np.full(trial.unit.size, np.nan)
    axes = np.eye(trial.unit.size)
    holds = [
        *axes[trial.unit <= near],
        *-axes[trial.unit >= 1.0 - near],
        *trial.margin_slopes[trial.margins <= near],
    ]
    if not holds:
        return trial.slope
    matrix = np.stack(holds, axis=1)
    weights, _ = nnls(matrix, trial.slope)
    return trial.slope - matrix @ weights


def optimality(trial: Trial, near: float) -> float:
    """Largest component of `projected_gradient` in size; NaN without gradients.

    Args: as `projected_gradient`.
    """
    return float(np.abs(projected_gradient(trial, near)).max())


class Trials:
    """Designs that a search has tried.

    Args:
        evaluate: (point of the unit box, whether gradients are needed) -> trial.
        start: The first trial, not rejected.

    Attributes:
        steps: Designs that the search has moved to, the start first.
        evaluations: Number of designs solved up to each step.
        rejected: Designs that failed, in order.
        n_evaluations: Number of designs that were solved.
        n_gradients: Number of designs that were solved with gradients.
    """

    def __init__(self, evaluate: Callable[[np.ndarray, bool], Trial], start: Trial):
        self._evaluate = evaluate
        self._last = start
        self.steps = [start]
        self.evaluations = [1]
        self.rejected: list[Trial] = []
        self.n_evaluations = 1
        self.n_gradients = int(start.slope is not None)

    def attempt(self, unit: np.ndarray, slopes: bool) -> Trial:
        """The trial of a design; the same design twice in a row is evaluated once.

        A rejected design is given an objective that rises linearly away from the last
        step (a cone), so that searches turn back.
        """
        last = self._last
        known = last.slope is not None or not slopes
        if not (known and np.array_equal(last.unit, unit)):
            trial = self._evaluate(np.array(unit), slopes)
            self.n_evaluations += trial.solved
            self.n_gradients += trial.solved and slopes
            if trial.fault:
                self.rejected.append(trial)
                trial = self._cone(trial, slopes)
            self._last = trial
        return self._last

    def accept(self, trial: Trial) -> None:
        """Record a step of the search, if it moved and the design is not rejected."""
        moved = np.any(trial.unit != self.steps[-1].unit)
        if moved and not trial.fault:
            self.steps.append(trial)
            self.evaluations.append(self.n_evaluations)

    def _cone(self, failed: Trial, slopes: bool) -> Trial:
        """Trial of a rejected design: objective of the last step, rising from there."""
        last = self.steps[-1]
        away = failed.unit - last.unit
        distance = float(np.linalg.norm(away)) or 1.0
        steep = 1.0 if last.slope is None else max(1.0, np.abs(last.slope).max())
        return last._replace(
            unit=failed.unit,
            objective=last.objective + steep * distance,
            slope=steep * away / distance if slopes else None,
            fault=failed.fault,
        )

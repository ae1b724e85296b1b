"""Designs that a search has tried, and how far each is from a minimum."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np


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
        """By how much the worst constraint is missed; 0 if all are kept."""
        return float(max(0.0, -self.margins.min(initial=0.0)))


def remainder(trial: Trial, near: float) -> np.ndarray:
    """What of the gradient no bound and no active constraint holds back (variable,).

    Against it the objective falls, and to first order all bounds are kept. Zero at a
    minimum: the conditions of Karush, Kuhn and Tucker, multipliers of the right sign.

    Args:
        trial: With gradients.
        near: How near a bound of a variable or a constraint counts as on it.
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
    """Largest part of `remainder`; NaN without gradients.

    Args:
        trial, near: As of `remainder`.
    """
    return float(np.abs(remainder(trial, near)).max())


class Trials:
    """Designs that a search has tried.

    Args:
        evaluate: From a point of the unit box, and whether gradients are wanted, to a
            trial.
        start: The first, not rejected.

    Attributes:
        steps: Designs that the search has moved to, the start first.
        evaluations: How many designs were solved until each of them.
        rejected: Designs that failed, in order.
        n_evaluations: Designs that were solved.
        n_gradients: Those of which the gradient was asked for.
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
        """The trial of a design, evaluated once though a search asks repeatedly.

        A rejected one has the numbers of a cone that rises away from the last step, so
        that searches turn back.
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
        """Note that the search has moved here, unless it stands still."""
        moved = np.any(trial.unit != self.steps[-1].unit)
        if moved and not trial.fault:
            self.steps.append(trial)
            self.evaluations.append(self.n_evaluations)

    def _cone(self, failed: Trial, slopes: bool) -> Trial:
        """Numbers for a rejected design: those of the last step, rising from there."""
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

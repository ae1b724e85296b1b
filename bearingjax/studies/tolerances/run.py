"""Run the tolerances of a scene."""

from collections.abc import Callable
from typing import Any, NamedTuple

from ...decide import Tightening, Tolerances, tighten, tolerances
from ...files.scene_errors import scene_errors
from .read import ToleranceTask


class ToleranceRun(NamedTuple):
    """Results of the tolerances of a scene.

    Attributes:
        found: Quantiles, misses and causes.
        narrower: The tolerances to tighten; `None`: not asked for.
    """

    found: Tolerances
    narrower: Tightening | None


def run_tolerances(
    task: ToleranceTask, told: Callable[[float], Any] | None = None
) -> ToleranceRun:
    """Solve many bearings, or systems of shafts, of a scene within its tolerances.

    Args:
        task: From `read_tolerances`.
        told: As in `Sampled`.

    Raises:
        SolveError: If the design at the mean of all numbers does not solve.
        SceneError: For choices that contradict each other.
    """
    narrower, keys = None, task.tighten
    with scene_errors(task.scene.name):
        found = tolerances(*task.given, **task.options, told=told)
        if keys is not None:
            narrower = tighten(
                *task.given,
                keys.most_misses,
                narrowest=keys.narrowest,
                **task.options,
                told=told,
            )
    return ToleranceRun(found, narrower)

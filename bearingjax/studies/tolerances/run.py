"""Run the tolerance analysis of a scene."""

from collections.abc import Callable
from typing import Any, NamedTuple

from ...decide import Tightening, Tolerances, tighten, tolerances
from ...files.scene_errors import scene_errors
from .read import ToleranceTask


class ToleranceRun(NamedTuple):
    """Results of the tolerance analysis of a scene.

    Attributes:
        found: Distributions of the measures, and the probability of failing.
        narrower: Cheapest narrower tolerances; `None`: not asked for.
    """

    found: Tolerances
    narrower: Tightening | None


def run_tolerances(
    task: ToleranceTask, progress: Callable[[float], Any] | None = None
) -> ToleranceRun:
    """Solve samples of a scene whose numbers scatter, and tighten them if asked for.

    Args:
        task: From `read_tolerances`.
        progress: Function called between batches with the share done.

    Raises:
        SolveError: If the design at the mean of all numbers does not solve.
        SceneError: For choices that contradict each other.
    """
    narrower, keys = None, task.tighten
    with scene_errors(task.scene.name):
        found = tolerances(*task.given, **task.options, progress=progress)
        if keys is not None:
            narrower = tighten(
                *task.given,
                keys.most_misses,
                narrowest=keys.narrowest,
                **task.options,
                progress=progress,
            )
    return ToleranceRun(found, narrower)

"""Running what a scene asks for of balls that skid."""

import dataclasses
from typing import Any

import jax
import numpy as np

from ..dynamics import conditions, skid_warnings, steady_skid
from ..numerics.result import Result
from ..statics.warning import warnings
from .quantity import SceneError
from .skid_table import SkidScene


@dataclasses.dataclass(frozen=True)
class SkidRun:
    """What came of a scene of balls that skid, as NumPy holds it.

    Attributes:
        task: What was asked.
        found: How the balls move, `SteadySkid`; read its `result`.
        state: `Conditions` in the contacts.
        warnings: What is doubtful; none where there is no solution.
    """

    task: SkidScene
    found: Any
    state: Any
    warnings: tuple[str, ...]

    @property
    def result(self) -> Result:
        """The result code."""
        return Result(int(self.found.result))

    @property
    def converged(self) -> bool:
        """Whether it was solved to the end."""
        return self.result is Result.CONVERGED

    @property
    def has_numbers(self) -> bool:
        """Whether there is anything to be told."""
        return self.converged

    @property
    def loads_solved(self) -> bool:
        """Whether the bearing was solved, in which the balls move."""
        return bool(self.found.solution.converged)


def run_skid(task: SkidScene, shown: bool = False) -> SkidRun:
    """How the balls of a scene skid.

    Args:
        task: From `read_skid`.
        shown: Show a progress bar on standard error, of a motion in time.

    Returns:
        The run with its result code; nothing is raised for a failed solve.

    Raises:
        SceneError: For settings that do not suit the load.

    Fails: as `steady_skid`.
    """
    scene = task.scene
    if not task.steady:
        problem = "a motion in time is not provided for; ask for the end: --steady"
        raise SceneError(f"{task.name}: {problem}")
    try:
        found: Any = steady_skid(
            task.model,
            scene.load,
            speed=task.speed,
            places=task.places,
            prescribed=scene.prescribed,
            free=scene.free,
            fixed_ring=scene.fixed_ring,
            throw=False,
        )
    except ValueError as error:
        raise SceneError(f"{task.name}: {error}") from error
    state = conditions(task.model, found, task.speed)
    held, state = jax.tree.map(_held, (found, state))
    told = task.warnings
    if Result(int(held.result)) is Result.CONVERGED:
        told = (
            *told,
            *warnings(found.solution),
            *skid_warnings(task.model, held, state),
        )
    return SkidRun(task, held, state, told)


def _held(leaf):
    """As NumPy holds it: JAX would compile every small operation on the way."""
    return np.asarray(leaf) if isinstance(leaf, jax.Array) else leaf

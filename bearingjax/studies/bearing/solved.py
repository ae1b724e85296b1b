"""A solved scene; what follows from its solution is computed once."""

import dataclasses
import functools

import jax

from ...files.scene_errors import scene_errors
from ...life import Life, life_warnings, rating_life
from ...numerics.warning import Warning
from ...statics.solution import Solution
from ...statics.warning import solution_warnings
from .life_ratings import life_conditions
from .oil import OilFacts, oil_facts
from .read_operating import relative_speed
from .read_scene import Scene


@dataclasses.dataclass(frozen=True)
class SolvedScene:
    """A scene and its solution, from which its report and its numbers are made.

    Attributes:
        scene: Solved scene, with the preload of its set where it has fits.
        solution: Its solution, converged or not.
    """

    scene: Scene
    solution: Solution

    @functools.cached_property
    def numbers(self) -> Solution:
        """The solution in NumPy: JAX would compile every small operation."""
        return jax.device_get(self.solution)

    @property
    def converged(self) -> bool:
        """Whether it was solved."""
        return bool(self.numbers.converged)

    @functools.cached_property
    def life(self) -> Life | None:
        """Rating life, if [life] asks for it; `None` if it was not solved.

        Raises:
            SceneError: If the values of [life] do not suit the bearing.
        """
        if self.scene.life is None or not self.converged:
            return None
        return scene_life(self.scene, self.numbers)

    @functools.cached_property
    def oil(self) -> OilFacts | None:
        """Friction and films; `None` without oil, at rest, and if it was not solved."""
        scene = self.scene
        if scene.oil is None or not self.converged:
            return None
        return oil_facts(scene.oil, self.numbers, scene.catalogue)

    @functools.cached_property
    def warnings(self) -> list[Warning]:
        """Warnings about the scene, its solution and its life."""
        return solved_warnings(self.scene, self.numbers, self.life)


def scene_life(scene: Scene, solution: Solution) -> Life:
    """Compute the rating life of a solved scene by its [life] or defaults, in NumPy.

    Without a relative speed of the rings there is no modified life.

    Args:
        scene: Solved scene.
        solution: Its solution, converged.

    Raises:
        SceneError: If the values of [life] do not suit the bearing.
    """
    turning = relative_speed(scene.speed) != 0.0
    conditions = life_conditions(scene, turning=turning)
    with scene_errors(scene.name):
        life = rating_life(solution.element, solution, conditions)
    return jax.device_get(life)


def solved_warnings(
    scene: Scene, solution: Solution, life: Life | None = None
) -> list[Warning]:
    """Return the warnings of a solved scene, its solution and its life.

    Args:
        scene: Solved scene, with the preload of its set where it has fits.
        solution: In NumPy; without warnings if it did not converge.
        life: Its rating life, in NumPy; `None`: no warnings about the life.
    """
    found = list(scene.warnings)
    if solution.converged:
        found += solution_warnings(solution)
    if life is not None:
        bearing = scene.element.bearing
        found += life_warnings(bearing, life.ratings, vars(life))
    return found

"""Solve the bearing of a scene."""

import dataclasses

from ...design.checks import of_class
from ...numerics.types import as_array
from ...statics.load import solve
from ...statics.service_warning import preload_warnings
from ...statics.solution import Solution
from ..bearing.read_scene import Scene
from ..bearing.solved import SolvedScene


def run_scene(scene: Scene) -> Solution:
    """Solve the bearing of a scene.

    Returns:
        Solution with its result code; nothing is raised for a failed solve.

    Raises:
        TypeError: If `scene` is not a `Scene`, such as a file name.

    Fails: as `solve_load`.
    """
    of_class("run_scene", "scene", scene, Scene, "a Scene, as of read_scene")
    return solve(
        scene.running(),
        as_array(scene.load, float),
        scene.support,
        scene.solve_options,
        speed=scene.speed,
    )


def solve_scene(scene: Scene) -> SolvedScene:
    """Solve the bearing of a scene, and find the preload of its set on its seats.

    Fails: as `solve_load`.
    """
    solution = run_scene(scene)
    solved = bool(solution.converged)
    return SolvedScene(with_set_preload(scene) if solved else scene, solution)


def with_set_preload(scene: Scene) -> Scene:
    """Add the preload of a set on its seats, and warnings about it, to a scene.

    A scene without fits, or whose rows do not preload each other, is returned
    unchanged: nothing is compiled.
    """
    if scene.fits is None:
        return scene
    found = scene.grind_rows().set_preload(scene.speed)
    if found is None:
        return scene
    warned = (*scene.warnings, *preload_warnings(found))
    return dataclasses.replace(scene, preload_of_set=found, warnings=warned)

"""Running what a scene asks for."""

import functools

from ..element import BearingElement
from ..optimise.optimise import Optimised, optimise
from ..statics.load import solve_load
from ..statics.preload import preload
from ..statics.solution import Solution
from .optimise_table import Optimisation
from .quantity import SceneError
from .read import Scene


def run_scene(scene: Scene) -> Solution:
    """Solve the bearing of a scene.

    Args:
        scene: From `read_scene`.

    Returns:
        Solution with its result code; nothing is raised for a failed solve.

    Raises:
        TypeError: If `scene` is none, such as the name of one.

    Fails: as `solve_load`.
    """
    if not isinstance(scene, Scene):
        raise TypeError(
            f"run_scene: `scene` is a {type(scene).__name__}; it must be a Scene, as of"
            " read_scene."
        )
    return solve_load(
        scene_element(scene),
        scene.load,
        prescribed=scene.prescribed,
        free=scene.free,
        fixed_ring=scene.fixed_ring,
        speed=scene.speed,
        points=scene.points,
        tolerance=scene.tolerance,
        throw=False,
    )


def scene_element(scene: Scene) -> BearingElement:
    """The bearing of a scene, with its preload set."""
    if scene.preload_force is None:
        return scene.element
    return preload(scene.element, scene.preload_force, throw=False)


def run_optimisation(task: Optimisation, progress: bool = False) -> Optimised:
    """Optimise the bearing of a scene.

    Args:
        task: From `read_optimisation`.
        progress: Show a progress bar on standard error.

    Returns:
        The best design; read its `result`.

    Raises:
        SolveError: If the design of the scene does not solve.
        SceneError: For choices that contradict each other.
    """
    scene = task.scene
    build = None
    if scene.preload_force is not None:
        build = functools.partial(preload, force=scene.preload_force, throw=False)
    try:
        return _optimised(task, build, progress)
    except ValueError as error:
        raise SceneError(f"{scene.name}: {error}") from error


def _optimised(task, build, progress) -> Optimised:
    scene = task.scene
    return optimise(
        scene.element,
        task.cases,
        task.variables,
        task.objective,
        task.constraints,
        task.method,
        max_steps=task.max_steps,
        tolerance=task.tolerance,
        points=scene.points,
        free=scene.free,
        fixed_ring=scene.fixed_ring,
        solve_tolerance=scene.tolerance,
        build=build,
        progress=progress,
    )

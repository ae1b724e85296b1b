"""Solve or optimise the bearing of a scene."""

import dataclasses
from functools import partial

from ..design.checks import of_class
from ..files.quantity import SceneError
from ..numerics.compiled.programs import called
from ..numerics.types import as_array
from ..optimise.life import OfLife, RatingLife
from ..optimise.optimise import Optimised, optimise
from ..statics.load import solve_load
from ..statics.solution import Solution
from .cases_table import turns_of
from .life_ratings import life_conditions
from .optimise_table import Optimisation
from .preload_of_set import preload_of_set, preload_warnings
from .read import Scene
from .shaft_optimise import ShaftOptimisation
from .solved import SolvedScene


def run_scene(scene: Scene) -> Solution:
    """Solve the bearing of a scene.

    Args:
        scene: From `read_scene`.

    Returns:
        Solution with its result code; nothing is raised for a failed solve.

    Raises:
        TypeError: If `scene` is not a `Scene`, such as a file name.

    Fails: as `solve_load`.
    """
    of_class("run_scene", "scene", scene, Scene, "a Scene, as of read_scene")
    return called(
        _solved,
        scene.running(),
        as_array(scene.load, float),
        {name: as_array(value, float) for name, value in scene.prescribed.items()},
        scene.free,
        scene.fixed_ring,
        scene.speed,
        scene.points,
        None if scene.tolerance is None else as_array(scene.tolerance, float),
    )


def solve_scene(scene: Scene) -> SolvedScene:
    """Solve the bearing of a scene, and find the preload of its set on its seats.

    Args:
        scene: From `read_scene`.

    Fails: as `solve_load`.
    """
    solution = run_scene(scene)
    solved = bool(solution.converged)
    return SolvedScene(with_set_preload(scene) if solved else scene, solution)


def with_set_preload(scene: Scene) -> Scene:
    """Add the preload of a set on its seats, and warnings about it, to a scene.

    A scene without fits, or whose rows do not preload each other, is returned
    unchanged: nothing is compiled.

    Args:
        scene: From `read_scene`.
    """
    if scene.fits is None:
        return scene
    ground = scene.ground().drawing
    found = preload_of_set(scene.fits, ground, scene.speed)
    if found is None:
        return scene
    warned = (*scene.warnings, *preload_warnings(found))
    return dataclasses.replace(scene, preload_of_set=found, warnings=warned)


def _solved(element, load, prescribed, free, fixed_ring, speed, points, tolerance):
    return solve_load(
        element,
        load,
        prescribed=prescribed,
        free=free,
        fixed_ring=fixed_ring,
        speed=speed,
        points=points,
        tolerance=tolerance,
        throw=False,
    )


def run_optimisation(
    task: Optimisation | ShaftOptimisation, progress: bool = False
) -> Optimised:
    """Optimise the bearing, or the system of shafts, of a scene.

    Args:
        task: From `read_optimisation`.
        progress: Show a progress bar on standard error.

    Returns:
        The best design; read its `result`.

    Raises:
        SolveError: If the design of the scene does not solve.
        SceneError: For choices that contradict each other.
    """
    name, more = task.scene.name, {}
    if isinstance(task, ShaftOptimisation):
        design = task.design
    else:
        scene, design = task.scene, task.scene.installed
        more = {
            "points": scene.points,
            "free": scene.free,
            "fixed_ring": scene.fixed_ring,
            "solve_tolerance": scene.tolerance,
        }
    try:
        found = optimise(
            design,
            task.cases,
            task.variables,
            task.objective,
            task.constraints,
            task.method,
            max_steps=task.max_steps,
            tolerance=task.tolerance,
            progress=progress,
            **more,
        )
    except ValueError as error:
        raise SceneError(f"{name}: {error}") from error
    return found if isinstance(task, ShaftOptimisation) else _judged(task, found)


def _judged(task: Optimisation, found: Optimised) -> Optimised:
    """Add the warnings about rating lives that `solve` gives for the same designs,
    with [life], whatever the measures."""
    scene = task.scene
    measures = task.objective, *(c.measure for c in task.constraints)
    if scene.life is None or any(isinstance(m, OfLife) for m in measures):
        return found
    turning = bool(turns_of(task.cases).any())
    life = RatingLife(life_conditions(scene, turning))
    sides = {"before": found.initial, "after": found.element}
    judged = {}
    for side, design in sides.items():
        outcome = getattr(found, side)
        doubts = partial(life.warnings, design, outcome.solution)
        judged[side] = outcome._replace(doubts=doubts)
    return dataclasses.replace(found, **judged)

"""Running what a scene asks for."""

from ..statics.load import solve_load
from ..statics.preload import preload
from ..statics.solution import Solution
from .read import Scene


def run_scene(scene: Scene) -> Solution:
    """Solve the bearing of a scene.

    Args:
        scene: From `read_scene`.

    Returns:
        Solution with its result code; nothing is raised for a failed solve.

    Fails: as `solve_load`.
    """
    element = scene.element
    if scene.preload_force is not None:
        element = preload(element, scene.preload_force, throw=False)
    return solve_load(
        element,
        scene.load,
        prescribed=scene.prescribed,
        free=scene.free,
        fixed_ring=scene.fixed_ring,
        speed=scene.speed,
        points=scene.points,
        tolerance=scene.tolerance,
        throw=False,
    )

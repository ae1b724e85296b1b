"""Optimise the bearing, or the system of shafts, of a scene."""

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any

from ...cases.spectrum import relative_speed
from ...files.scene_errors import scene_errors
from ...optimise.life import OfLife, RatingLife
from ...optimise.optimise import OptimisedDesign, SearchOptions, optimise
from ...statics.support import RESTRAINED, Support
from ..bearing.life_ratings import life_conditions
from .read_optimise import Optimisation
from .read_shaft_optimise import ShaftOptimisation


def run_optimisation(
    task: Optimisation | ShaftOptimisation,
    told: Callable[[str], Any] | None = None,
) -> OptimisedDesign:
    """Optimise the bearing, or the system of shafts, of a scene.

    Args:
        task: From `read_optimisation`.
        told: As in `SearchOptions`.

    Returns:
        The best design; read its `result`.

    Raises:
        SolveError: If the design of the scene does not solve.
        SceneError: For choices that contradict each other.
    """
    name, support, solve = task.scene.name, RESTRAINED, None
    if isinstance(task, ShaftOptimisation):
        design = task.design
    else:
        scene, design = task.scene, task.scene.installed
        support = Support(scene.free, fixed_ring=scene.fixed_ring)
        solve = scene.solve_options
    limits = task.max_steps, task.tolerance
    with scene_errors(name):
        found = optimise(
            design,
            task.cases,
            task.variables,
            task.objective,
            task.constraints,
            search=SearchOptions(task.method, *limits, solve, told=told),
            support=support,
        )
    if isinstance(task, ShaftOptimisation):
        return found
    return _with_life_warnings(task, found)


def _with_life_warnings(task: Optimisation, found: OptimisedDesign) -> OptimisedDesign:
    """Add the warnings about rating lives that `solve` gives for the same designs,
    with [life], whatever the measures."""
    scene = task.scene
    measures = task.objective, *(c.measure for c in task.constraints)
    if scene.life is None or any(isinstance(m, OfLife) for m in measures):
        return found
    turning = bool(relative_speed(task.cases).any())
    life = RatingLife(life_conditions(scene, turning))
    sides = {"before": found.initial, "after": found.element}
    judged = {}
    for side, design in sides.items():
        outcome = getattr(found, side)
        doubts = partial(life.warnings, design, outcome.solution)
        judged[side] = outcome._replace(doubts=doubts)
    return dataclasses.replace(found, **judged)

"""`bearingjax optimise`."""

from argparse import Namespace
from functools import partial

from ..outcome import Outcome, Tools, outcome_of, picture, unsolved_start


def run(options: Namespace, tools: Tools) -> Outcome:
    """Optimise the bearing, or the shafts on their bearings, of a scene file, as its
    [optimise] says, over its [cases]."""
    from ...numerics import SolveError
    from ...optimise.system import element_of
    from ..bearing.read_scene import Scene
    from ..solve.run import with_set_preload
    from .read_shaft_optimise import read_optimisation
    from .report import optimisation_as_dict, optimisation_report
    from .run import run_optimisation
    from .scene_of_design import scene_of_design

    task = read_optimisation(options.scene, options.set)
    try:
        told = None if tools.stage is None else partial(tools.stage, counts=True)
        found = run_optimisation(task, told)
    except SolveError as error:
        return unsolved_start(task.scene, task.inputs, error, "start_not_solved")

    solved, name, drawing = found.converged, task.scene.name, None
    best = scene_of_design(task, found.element)
    if isinstance(best, Scene):
        best = with_set_preload(best) if solved else best
        bearing = element_of(found.element).bearing
        drawing = picture("drawing", bearing, f"{name}, optimised", best.entry)
    return outcome_of(
        name,
        task.inputs,
        (task, found, best),
        optimisation_as_dict,
        optimisation_report,
        None,
        {"Before and after": picture("optimise_overview", found, title=name)},
        solved=solved,
        drawing=drawing,
        problems=[] if solved else [f"{found.result}: {found.message}"],
    )

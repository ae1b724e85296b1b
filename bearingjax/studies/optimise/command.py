"""`bearingjax optimise`."""

from argparse import ArgumentParser, Namespace
from functools import partial

from ..options import Commands, add_plot, add_report, add_scene
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "optimise",
        help="the free numbers of a design that make a measure least",
        description="Optimise the bearing, or the shafts on their bearings, of a scene"
        " file, as its [optimise] says, over its [cases].",
        epilog="Exit status: 0 optimised, 2 bad input, 3 not solved or not converged.",
    )
    add_scene(command)
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Optimise the bearing, or the system of shafts, of a scene."""
    from ...numerics import SolveError
    from ...optimise.system import element_of
    from ..bearing.read_scene import Scene
    from ..solve.run import with_set_preload
    from .read_shaft_optimise import read_optimisation
    from .report import (
        optimisation_as_dict,
        optimisation_report,
        unsolved_start_as_dict,
    )
    from .run import run_optimisation
    from .scene_of_design import scene_of_design

    task = read_optimisation(options.scene, options.set)
    name, inputs = task.scene.name, task.inputs
    try:
        told = None if tools.stage is None else partial(tools.stage, counts=True)
        found = run_optimisation(task, told)
    except SolveError as error:
        numbers = unsolved_start_as_dict(task, error)
        return Outcome(name, inputs, lambda: numbers, problems=[str(error)])

    solved = found.converged
    best = scene_of_design(task, found.element)
    alone = isinstance(best, Scene)
    if solved and alone:
        best = with_set_preload(best)

    pictures = {"Before and after": picture("optimise_overview", found, title=name)}
    bearing = element_of(found.element).bearing if alone else None
    return Outcome(
        name,
        inputs,
        lambda: optimisation_as_dict(task, found, best),
        optimisation_report(task, found, best) if solved else None,
        pictures=pictures if solved else {},
        drawing=picture("drawing", bearing, f"{name}, optimised", best.entry)
        if alone
        else None,
        problems=[] if solved else [f"{found.result}: {found.message}"],
    )

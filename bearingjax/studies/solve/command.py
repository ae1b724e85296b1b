"""`bearingjax solve`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_drawing, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools
from ..status import complain
from .solution_outcome import solution_outcome


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "solve",
        help="where the rings go under load",
        description="Solve the bearing of a scene file and print a report.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    add_scene(command)
    add_table(command, "rolling element")
    add_plot(command)
    add_drawing(command, "of the bearing, as it is solved")
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Solve the bearing of a scene."""
    from ...files.scene_file import has_cases
    from ..bearing.read_scene import read_scene

    scene = read_scene(options.scene, options.set)
    if has_cases(options.scene, options.set):
        complain("one load, that of [operating]; [cases] are for sweep, life, optimise")
    return solution_outcome(scene)

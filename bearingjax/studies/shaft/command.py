"""`bearingjax shaft`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "shaft",
        help="shafts with gears on bearings: loads, tilts and lives of all bearings",
        description="Equilibrium of the shafts of a scene on their bearings and in"
        " their housing, under gears, belts, forces and weight: load, tilt, pressure,"
        " static safety, rating life, friction and clearance of each bearing,"
        " deflection of the shafts, misalignment of the meshes; with [cases] the lives"
        " under a load spectrum.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved, or only in part.",
    )
    add_scene(command)
    add_table(command, "bearing, with [cases] per bearing and case")
    add_plot(command, "write a picture of shafts, lines and load zones")
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Analyse a system of shafts."""
    from .output import shaft_columns, shafts_as_dict
    from .read import read_shafts
    from .report import shaft_page, shaft_report
    from .run import run_shafts

    task = read_shafts(options.scene, options.set)
    done = run_shafts(task, tools.stage)
    solved = bool(done.bearings)

    return Outcome(
        task.name,
        task.inputs,
        lambda: shafts_as_dict(done),
        shaft_report(done) if solved else None,
        (lambda: shaft_columns(done)) if done.converged else None,
        {"Overview": picture("shaft_overview", done, title=task.name)}
        if solved
        else {},
        page=lambda: shaft_page(done),
        problems=[done.problem] if done.problem else [],
    )

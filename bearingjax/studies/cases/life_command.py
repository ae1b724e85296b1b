"""`bearingjax life`."""

import dataclasses
from argparse import ArgumentParser, Namespace

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture
from ..solve.solution_outcome import solution_outcome


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "life",
        help="rating life, of one load or of a load spectrum",
        description="Rating life of the bearing of a scene file by ISO 281 and ISO/TS"
        " 16281, as its [life] says, under its load or, if it has [cases], under all of"
        " them, whose damage adds up over their hours.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    add_scene(command)
    add_table(command, "case, of one load one row")
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Compute the rating life of the bearing of a scene."""
    from ...files.scene_file import has_cases

    if has_cases(options.scene, options.set):
        return _life_of_cases(options, tools)
    return _life_of_load(options)


def _life_of_load(options) -> Outcome:
    from ...life import LifeConditions
    from ..bearing.read_scene import read_scene
    from ..solve.output import solved_life_as_dict
    from .life_run import life_row

    scene = read_scene(options.scene, options.set)
    if scene.life is None:
        scene = dataclasses.replace(scene, life=LifeConditions())
    brief = "Bearing", "Rating life", "Fits and clearance"
    return solution_outcome(scene, solved_life_as_dict, brief, life_row)


def _life_of_cases(options, tools: Tools) -> Outcome:
    from .life_run import (
        life_columns,
        run_life,
        spectrum_as_dict,
        spectrum_page,
        spectrum_report,
    )
    from .read_cases import read_cases
    from .sweep_run import cases_with_set_preload

    table = read_cases(options.scene, options.set)
    table = cases_with_set_preload(table)
    done, scene = run_life(table, tools.shown), table.scene
    solved = done.converged

    pictures = {
        "Lives and damage of the cases": picture(
            "life_overview", done, title=scene.name
        )
    }
    return Outcome(
        scene.name,
        table.inputs,
        lambda: spectrum_as_dict(done),
        spectrum_report(done) if solved else None,
        lambda: life_columns(done),
        pictures if solved else {},
        lambda: picture("drawing", scene.running().bearing, scene.name, scene.entry)(),
        page=lambda: spectrum_page(done),
        table_on_page=True,
        problems=[] if solved else [done.failure_message],
    )

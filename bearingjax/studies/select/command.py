"""`bearingjax select`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "select",
        help="which bearings of the catalogue do what is required",
        description="Compare the requirements of a scene file, its [select], loads and"
        " life, with all bearings of the catalogue: what fits, the best first, and what"
        " excludes the others.",
        epilog="Exit status: 0 chosen, 2 bad input, 3 none fits.",
    )
    add_scene(command)
    add_table(command, "bearing")
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Choose a bearing as a scene says."""
    from .read import read_select
    from .run import (
        nearest_misses,
        run_select,
        select_as_dict,
        select_columns,
        select_report,
    )

    choice = read_select(options.scene, options.set)
    found = run_select(choice, tools.stage)
    drawn = {"Bearings": picture("selection_overview", found, title=choice.name)}
    nearest = "; ".join(nearest_misses(found, 3))
    return Outcome(
        choice.name,
        choice.inputs,
        lambda: select_as_dict(choice, found),
        select_report(choice, found),
        lambda: select_columns(found),
        drawn,
        problems=[] if found.fits else [f"none fits; the nearest: {nearest}"],
    )

"""`bearingjax select`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture


def run(options: Namespace, tools: Tools) -> Outcome:
    """Compare the requirements of a scene file, its [select], loads and life, with all
    bearings of the catalogue: what fits, the best first, and what excludes the others.
    """
    from . import run as selection
    from .read import read_select

    choice = read_select(options.scene, options.set)
    found = selection.run_select(choice, tools.stage)
    nearest = "; ".join(selection.nearest_misses(found, 3))
    return outcome_of(
        choice.name,
        choice.inputs,
        (choice, found),
        selection.select_as_dict,
        selection.select_report,
        lambda _, found: selection.select_columns(found),
        {"Bearings": picture("selection_overview", found, title=choice.name)},
        problems=[] if found.fits else [f"none fits; the nearest: {nearest}"],
    )

"""`bearingjax select`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture, unsolved_start


def run(options: Namespace, tools: Tools) -> Outcome:
    """Compare all bearings of the catalogue with the requirements of a scene file, its
    [select], loads and life, and list those that fit, the best first, and what excludes
    the others; for a system of shafts at several positions together.
    """
    from ...decide import PositionSelection
    from ...numerics import SolveError
    from . import run as selection
    from .read import read_select

    choice = read_select(options.scene, options.set)
    try:
        found = selection.run_select(choice, tools.stage)
    except SolveError as error:
        return unsolved_start(choice, choice.inputs, error, "none_fits")
    if isinstance(found, PositionSelection):
        alone, problem = found.alone, "no combination holds"
        writers = selection.positions_as_dict, selection.positions_report
        columns, holds = selection.positions_columns, found.best
    else:
        nearest = "; ".join(found.nearest_misses(3))
        alone, problem = {"": found}, f"none fits; the nearest: {nearest}"
        writers = selection.select_as_dict, selection.select_report
        columns, holds = selection.select_columns, found.fits
    return outcome_of(
        choice.name,
        choice.inputs,
        (choice, found),
        *writers,
        lambda _, found: columns(found),
        {
            f"Bearings {name}".strip(): picture(
                "selection_overview", one, title=f"{choice.name} {name}".strip()
            )
            for name, one in alone.items()
        },
        problems=[] if holds else [problem],
    )

"""`bearingjax identify`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture, unsolved_start


def run(options: Namespace, tools: Tools) -> Outcome:
    """Estimate the unknown numbers that [identify] of a scene names from a table of
    measurements with a row for each case, and report their standard errors."""
    from ...numerics import SolveError
    from . import run as identification
    from .read_identify import read_identification

    task = read_identification(options.scene, options.set)
    scene = task.subject.scene
    try:
        found = identification.run_identification(task)
    except SolveError as error:
        return unsolved_start(scene, task.inputs, error, "start_not_solved")
    solved, name = found.converged, scene.name
    draw = picture("identify_overview", found, task.units, title=name)
    return outcome_of(
        name,
        task.inputs,
        (task, found),
        identification.identification_as_dict,
        identification.identification_report,
        identification.identification_columns if solved else None,
        {"Measured and predicted": draw},
        solved=solved,
        table_on_page=True,
        problems=[] if solved else [found.message],
    )

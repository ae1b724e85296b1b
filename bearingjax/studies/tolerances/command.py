"""`bearingjax tolerances`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture, unsolved_start


def run(options: Namespace, tools: Tools) -> Outcome:
    """Solve samples of the bearing, or of the system of shafts, of a scene file, whose
    numbers scatter as its [tolerances] says, over its [cases]."""
    from ...numerics import SolveError
    from . import report
    from .read import read_tolerances
    from .run import run_tolerances

    task, stage = read_tolerances(options.scene, options.set), tools.stage
    try:
        progress = None if stage is None else lambda share: stage("samples", share)
        found = run_tolerances(task, progress)
    except SolveError as error:
        return unsolved_start(task.scene, task.inputs, error, "not_solved")
    narrower, title = found.narrower, task.scene.name
    missed = narrower is not None and not narrower.converged
    return outcome_of(
        title,
        task.inputs,
        (task, found),
        report.tolerances_as_dict,
        report.tolerance_report,
        report.tolerance_columns,
        {"Tolerances": picture("tolerance_overview", found.found, title=title)},
        problems=[f"tightening: {narrower.message}"] if narrower and missed else [],
    )

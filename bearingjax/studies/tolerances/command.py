"""`bearingjax tolerances`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "tolerances",
        help="what tolerances do to results, and which to tighten",
        description="Solve many bearings, or systems of shafts, of a scene file within"
        " the tolerances of its [tolerances], over its [cases].",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved or not converged.",
    )
    add_scene(command)
    add_table(command, "sample")
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Work out what the tolerances of a scene do."""
    from ...numerics import SolveError
    from ...report.json_output import run_json
    from .read import read_tolerances
    from .report import tolerance_columns, tolerance_report, tolerances_as_dict
    from .run import run_tolerances

    task = read_tolerances(options.scene, options.set)
    name, stage = task.scene.name, tools.stage
    try:
        told = None if stage is None else lambda share: stage("samples", share)
        found = run_tolerances(task, told)
    except SolveError as error:
        status = {"result": "not_solved", "message": str(error)}
        numbers = run_json(status, task.scene.warnings, task.inputs)
        return Outcome(name, task.inputs, lambda: numbers, problems=[str(error)])
    narrower = found.narrower
    missed = narrower is not None and not narrower.converged
    return Outcome(
        name,
        task.inputs,
        lambda: tolerances_as_dict(task, found),
        tolerance_report(task, found),
        lambda: tolerance_columns(task, found),
        {"Tolerances": picture("tolerance_overview", found.found, title=name)},
        problems=[f"tightening: {narrower.message}"] if narrower and missed else [],
    )

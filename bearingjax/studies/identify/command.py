"""`bearingjax identify`."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "identify",
        help="numbers of a bearing from measurements, with standard errors",
        description="Identify the unknowns that [identify] of a scene names from a"
        " table of measurements, a row for each case.",
        epilog="Exit status: 0 identified, 2 bad input, 3 not solved or not converged.",
    )
    add_scene(command)
    text = "measured table, in place of that of the scene (.csv)"
    more = {"dest": "set", "action": "append", "type": _as_setting}
    command.add_argument("--data", metavar="CSV", help=text, **more)
    add_table(command, "case")
    add_plot(command)
    add_report(command, "pictures")
    return command


def _as_setting(path: str) -> str:
    return f"identify.data={json.dumps(str(Path(path).resolve()))}"


def run(options: Namespace, tools: Tools) -> Outcome:
    """Identify numbers of the bearing of a scene."""
    from ...numerics import SolveError
    from ...report.json_output import run_json
    from .read_identify import read_identification
    from .run import (
        identification_as_dict,
        identification_columns,
        identification_report,
        run_identification,
    )

    task = read_identification(options.scene, options.set)
    name, inputs = task.subject.scene.name, task.inputs
    try:
        found = run_identification(task)
    except SolveError as error:
        words = {"result": "start_not_solved", "message": str(error)}
        numbers = run_json(words, task.subject.scene.warnings, inputs)
        return Outcome(name, inputs, lambda: numbers, problems=[str(error)])
    solved = found.converged
    draw = picture("identify_overview", found, task.units, title=name)
    return Outcome(
        name,
        inputs,
        lambda: identification_as_dict(task, found),
        identification_report(task, found) if solved else None,
        (lambda: identification_columns(task, found)) if solved else None,
        pictures={"Measured and predicted": draw} if solved else {},
        table_on_page=True,
        problems=[] if solved else [found.message],
    )

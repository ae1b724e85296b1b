"""`bearingjax sweep`."""

import shlex
import signal
import time
from argparse import Namespace

import numpy as np

from .. import jax_settings
from ..outcome import Outcome, Tools, picture
from ..outputs import check_table
from ..status import NOT_SOLVED, SOLVED


def run(options: Namespace, tools: Tools) -> Outcome:
    """Solve the [cases] of a scene file."""
    from ...cases import sweep_table
    from ...files import SceneError
    from ...numerics import Result
    from .interrupt import Interrupt
    from .read_cases import read_cases
    from .resume import resume_cases
    from .sweep_run import (
        add_hours,
        cases_with_set_preload,
        design_columns,
        run_cases,
        sweep_as_dict,
        sweep_report,
    )

    jax_settings.devices(options)
    if options.resume and options.table is None:
        raise SceneError("--resume takes up a table; name it with --table")
    begin = time.perf_counter()
    table = read_cases(options.scene, options.set)
    check_table(options, table.cases.count)
    table = cases_with_set_preload(table)
    interrupt = tools.until_written(Interrupt())
    if options.resume and options.table.exists():
        solved = resume_cases(table, options.table, tools.shown, interrupt)
    else:
        solved = run_cases(table, tools.shown, interrupt)
    seconds = time.perf_counter() - begin

    drawn = solved, design_columns(table), table.scene.name
    pictures = {"Results over the cases": picture("sweep_overview", *drawn)}
    left = int((np.asarray(solved.result) == Result.NOT_RUN).sum())
    lost = int((~solved.converged).sum())

    words = f"{lost} of {solved.cases.count} cases not solved"

    def conclude():
        if not left and interrupt.number is None:
            return None
        if not left:  # struck during the last cases, or while files were written
            told = f"; {words}" if lost else ""
            told = f"interrupted, but all cases were run{told}"
            return told, NOT_SOLVED if lost else SOLVED
        status = 128 + (interrupt.number or signal.SIGINT)
        return _how_to_go_on(options, left, solved.cases.count), status

    return Outcome(
        table.scene.name,
        table.inputs,
        lambda: sweep_as_dict(table, solved),
        sweep_report(table, solved, seconds),
        lambda: add_hours(
            sweep_table.columns(*drawn[:2]), solved.cases, table.scene.life
        ),
        pictures if solved.converged.any() else {},
        table_on_page=True,
        problems=[words] if lost else [],
        interrupted=conclude,
    )


def _how_to_go_on(options, left: int, count: int) -> str:
    """Return the message on how to resume an interrupted sweep."""
    words = f"interrupted: {left} of {count} cases not run"
    if options.table is not None:
        given = [word for word in options.given if word != "--resume"]
        again = shlex.join(["bearingjax", *given, "--resume"])
        words += f"; go on with: {again}"
    else:
        words += "; with --table what is solved is kept, and --resume goes on from it"
    return words

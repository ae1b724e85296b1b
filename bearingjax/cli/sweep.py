"""`bearingjax sweep`."""

import shlex
import signal
import time
from pathlib import Path

import numpy as np

from . import jax_settings
from .options import add_plot, add_quiet, add_report, add_scene, add_table
from .outputs import Reporter, check_outputs, check_table, save, write
from .progress import is_shown
from .status import NOT_SOLVED, complain


def add(commands):
    """What may be written after it."""
    command = commands.add_parser(
        "sweep",
        help="many cases: loads, displacements, speeds, designs",
        description="Solve the [cases] of a scene file.",
        epilog="Exit status: 0 all solved, 2 bad input, 3 some not solved (the table"
        " holds a result for each case), 130 interrupted (what is solved is kept).",
    )
    add_scene(command)
    add_table(command, "case")
    command.add_argument(
        "--resume",
        action="store_true",
        help="solve only the cases that the table lacks, after an interruption",
    )
    add_plot(command)
    add_report(command, "cases")
    add_quiet(command)
    command.add_argument(
        "--devices",
        metavar="N",
        type=int,
        default=None,
        help="parts of the processor to spread the cases over; default: all its cores",
    )
    return command


def run(options) -> int:
    """Solve the cases of a scene."""
    from ..numerics import Result
    from ..scene import (
        Interrupt,
        SceneError,
        cases_with_set_preload,
        design_columns,
        read_cases,
        resume_cases,
        run_cases,
        sweep_report,
        write_sweep_json,
    )
    from ..statics import sweep_table

    check_table(options)
    check_outputs(options)
    jax_settings.devices(options)
    if options.resume and options.table is None:
        raise SceneError("--resume takes up a table; name it with --table")
    begin = time.perf_counter()
    table = read_cases(options.scene, options.set)
    check_table(options, table.cases.count)
    page = Reporter(options)
    table = cases_with_set_preload(table, jax_settings.programs())
    shown = is_shown(options)
    with Interrupt() as interrupt:
        done = options.table if options.resume else None
        if done is not None and done.exists():
            solved = resume_cases(table, done, shown, interrupt)
        else:
            solved = run_cases(table, shown, interrupt)
        summary = sweep_report(table, solved, time.perf_counter() - begin)

        def tabulate(path: Path):
            sweep_table.write(solved, path, design_columns(table))

        def draw(path, **format):
            from ..plot import sweep_overview

            figure = sweep_overview(solved, design_columns(table), table.scene.name)
            save(figure, path, **format)

        any_solved = bool(solved.converged.any())

        def tell(path: Path):
            draws = {"Results over the cases": draw} if any_solved else {}
            found = sweep_table.columns(solved, design_columns(table))
            name, texts = table.scene.name, {"Cases": summary}
            page(path, name, texts, table.inputs, draws, found)

        drawn = write(
            (options.table, tabulate),
            (options.json, lambda path: write_sweep_json(path, table, solved)),
            (options.plot, draw if any_solved else None),
            (options.report, tell),
        )
    print(summary, flush=True)
    left = int((np.asarray(solved.result) == Result.NOT_RUN).sum())
    if left or interrupt.number is not None:
        _tell_interrupted(options, left, solved.cases.count)
        return 128 + (interrupt.number or signal.SIGINT)
    if solved.converged.all():
        return drawn
    lost = int((~solved.converged).sum())
    complain(f"{lost} of {solved.cases.count} cases not solved")
    return NOT_SOLVED


def _tell_interrupted(options, left: int, count: int) -> None:
    """Say how an interrupted sweep goes on."""
    words = f"interrupted: {left} of {count} cases not run"
    if left and options.table is not None:
        given = [word for word in options.given if word != "--resume"]
        again = shlex.join(["bearingjax", *given, "--resume"])
        words += f"; go on with: {again}"
    elif left:
        words += "; with --table what is solved is kept, and --resume goes on from it"
    complain(words)

"""`bearingjax skid`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "skid",
        help="balls and rollers that skid: over time, or in the end",
        description="How the balls or rollers of a bearing move with its cage in its"
        " [lubricant], over the time of its [dynamics], or in the end.",
        epilog="A `law` of viscosity without `film_coefficient` takes for films its"
        " reciprocal asymptotic isoviscous pressure α*. Exit status: 0 solved, 2 bad"
        " input, 3 not solved.",
    )
    add_scene(command)
    command.add_argument(
        "--steady", action="store_true", help="the end state, without the way there"
    )
    add_table(command, "time, or per place along the orbit")
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Simulate the motion of balls or rollers and their cage."""
    from .output import skid_as_dict, skid_columns, skid_message
    from .read import read_skid
    from .report import skid_report
    from .run import run_skid

    task = read_skid(options.scene, options.set, steady=options.steady)
    done = run_skid(task, shown=tools.shown)

    shown = task.model, done.found, done.state
    solved = done.converged
    return Outcome(
        task.name,
        task.inputs,
        lambda: skid_as_dict(done),
        skid_report(done) if solved else None,
        (lambda: skid_columns(done)) if done.has_numbers else None,
        {"Overview": picture("skid_overview", *shown, title=task.name)}
        if solved
        else {},
        problems=[] if solved else [f"{done.result.label}: {skid_message(done)}"],
    )

"""`bearingjax skid`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture


def run(options: Namespace, tools: Tools) -> Outcome:
    """How the balls or rollers of a bearing move with its cage in its [lubricant], over
    the time of its [dynamics], or in the end."""
    from . import output, read
    from .report import skid_report
    from .run import run_skid

    task = read.read_skid(options.scene, options.set, steady=options.steady)
    done = run_skid(task, shown=tools.shown)
    drawn = task.model, done.found, done.state
    why = [] if done.converged else [output.skid_message(done)]
    return outcome_of(
        task.name,
        task.inputs,
        (done,),
        output.skid_as_dict,
        skid_report,
        output.skid_columns if done.has_numbers else None,
        {"Overview": picture("skid_overview", *drawn, title=task.name)},
        solved=done.converged,
        problems=[f"{done.result.label}: {one}" for one in why],
    )

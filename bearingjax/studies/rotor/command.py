"""`bearingjax rotor`."""

from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture


def run(options: Namespace, tools: Tools) -> Outcome:
    """Static equilibrium of the [rotor] of a scene on its bearings, modes at its speed,
    critical speeds; and if the scene has these tables, the [rotor.campbell] diagram,
    the [rotor.response] to unbalance or a shaking base, and the motion in time of
    [rotor.transient]."""
    from ...files import SceneError
    from . import output, read
    from .report import rotor_report
    from .run import run_rotor

    task = read.read_rotor(options.scene, options.set)
    if options.table is None and options.series is not None:
        raise SceneError("--series is for a table; name it with --table")
    series = (
        None if options.table is None else output.rotor_series(task, options.series)
    )
    done = run_rotor(task, tools.stage)
    columns = {} if series is None else output.rotor_columns(done, series)
    return outcome_of(
        task.name,
        task.inputs,
        (done,),
        output.rotor_as_dict,
        rotor_report,
        (lambda _: columns) if columns else None,
        {"Overview": picture("rotor_overview", done, title=task.name)},
        solved=done.settled is not None,
        problems=[f"{f.result.label}: {f.part}: {f.message}" for f in done.failures],
    )

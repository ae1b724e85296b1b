"""`bearingjax rotor`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_plot, add_report, add_scene, add_table
from ..outcome import Outcome, Tools, picture


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "rotor",
        help="a shaft on its bearings: modes, critical speeds, vibration",
        description="Static equilibrium of the [rotor] of a scene on its bearings,"
        " modes at its speed, critical speeds; and if the scene has these tables, the"
        " [rotor.campbell] diagram, the [rotor.response] to unbalance or a shaking"
        " base, and the motion in time of [rotor.transient].",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved, or only in part.",
    )
    add_scene(command)
    add_table(command, "point of the response, or per time of the motion in time")
    command.add_argument(
        "--series",
        choices=("response", "transient"),
        help="which of them --table has, if the scene has both",
    )
    add_plot(command)
    add_report(command, "pictures")
    return command


def run(options: Namespace, tools: Tools) -> Outcome:
    """Analyse a shaft on its bearings."""
    from ...files import SceneError
    from .output import rotor_as_dict, rotor_columns, rotor_series
    from .read import read_rotor
    from .report import rotor_report
    from .run import run_rotor

    task = read_rotor(options.scene, options.set)
    if options.table is None and options.series is not None:
        raise SceneError("--series is for a table; name it with --table")
    series = None if options.table is None else rotor_series(task, options.series)
    done = run_rotor(task, tools.stage)

    settled = done.settled is not None
    columns = {} if series is None else rotor_columns(done, series)
    return Outcome(
        task.name,
        task.inputs,
        lambda: rotor_as_dict(done),
        rotor_report(done) if settled else None,
        (lambda: columns) if columns else None,
        {"Overview": picture("rotor_overview", done, title=task.name)}
        if settled
        else {},
        problems=[
            f"{failure.result.label}: {failure.part}: {failure.message}"
            for failure in done.failures
        ],
    )

"""`bearingjax rotor`."""

from .options import add_plot, add_quiet, add_report, add_scene, add_table
from .outputs import Reporter, check_outputs, check_table, save, write
from .progress import stages
from .status import NOT_SOLVED, complain


def add(commands):
    """What may be written after it."""
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
    add_quiet(command, "progress")
    return command


def run(options) -> int:
    """A shaft on its bearings."""
    from ..scene import (
        SceneError,
        read_rotor,
        rotor_columns,
        rotor_report,
        rotor_series,
        run_rotor,
        write_rotor_json,
    )
    from ..statics.sweep_table import write_columns

    check_table(options)
    check_outputs(options)
    task = read_rotor(options.scene, options.set)
    page = Reporter(options)
    if options.table is None and options.series is not None:
        raise SceneError("--series is for a table; name it with --table")
    series = None if options.table is None else rotor_series(task, options.series)
    with stages(options) as show:
        done = run_rotor(task, show)

    def draw(path, **format):
        from ..plot import rotor_overview

        save(rotor_overview(done, title=task.name), path, **format)

    lost = [
        f"{failure.result.label}: {failure.part}: {failure.message}"
        for failure in done.failures
    ]
    text = "" if done.settled is None else rotor_report(done)

    def tell(path):
        texts, draws = {"Rotor": text}, {"Overview": draw}
        page(path, task.name, texts, task.inputs, draws, warnings=lost)

    columns = {} if series is None else rotor_columns(done, series)

    def tabulate(path):
        write_columns(columns, path)

    drawn = write(
        (options.json, lambda path: write_rotor_json(path, done)),
        (options.table, tabulate if columns else None),
        (options.plot, None if done.settled is None else draw),
        (options.report, None if done.settled is None else tell),
    )
    if text:
        print(text, flush=True)
    for one in lost:
        complain(one)
    return drawn if done.converged else NOT_SOLVED

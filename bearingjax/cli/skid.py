"""`bearingjax skid`."""

from .options import add_plot, add_quiet, add_report, add_scene, add_table
from .outputs import Reporter, check_outputs, check_table, save, write
from .progress import is_shown
from .status import NOT_SOLVED, complain


def add(commands):
    """What may be written after it."""
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
    add_quiet(command)
    return command


def run(options) -> int:
    """Motion of balls or rollers and their cage."""
    from ..scene import (
        read_skid,
        run_skid,
        skid_columns,
        skid_message,
        skid_report,
        write_skid_json,
    )
    from ..statics.sweep_table import write_columns

    check_table(options)
    check_outputs(options)
    task = read_skid(options.scene, options.set, steady=options.steady)
    page = Reporter(options)
    done = run_skid(task, shown=is_shown(options))

    def draw(path, **format):
        from ..plot import skid_overview

        save(
            skid_overview(task.model, done.found, done.state, title=task.name),
            path,
            **format,
        )

    text = skid_report(done) if done.converged else ""

    def tell(path):
        texts, draws = {"Motion of the rolling elements": text}, {"Overview": draw}
        page(path, task.name, texts, task.inputs, draws)

    def tabulate(path):
        write_columns(skid_columns(done), path)

    drawn = write(
        (options.json, lambda path: write_skid_json(path, done)),
        (options.table, tabulate if done.has_numbers else None),
        (options.plot, draw if done.converged else None),
        (options.report, tell if done.converged else None),
    )
    if not done.converged:
        complain(f"{done.result.label}: {skid_message(done)}")
        return NOT_SOLVED
    print(text, flush=True)
    return drawn

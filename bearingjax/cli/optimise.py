"""`bearingjax optimise`."""

from .options import add_plot, add_report, add_scene
from .outputs import Reporter, check_outputs, save, write
from .status import NOT_SOLVED, complain


def add(commands):
    """What may be written after it."""
    command = commands.add_parser(
        "optimise",
        help="the free numbers of a design that make a measure least",
        description="Optimise the bearing of a scene file, as its [optimise] says, over"
        " its [cases].",
        epilog="Exit status: 0 optimised, 2 bad input, 3 not solved or not converged.",
    )
    add_scene(command)
    add_plot(command)
    add_report(command, "pictures")
    command.add_argument("--progress", action="store_true", help="show progress")
    return command


def run(options) -> int:
    """Optimise the bearing of a scene."""
    from ..numerics import SolveError
    from ..scene import (
        optimisation_as_dict,
        optimisation_report,
        read_optimisation,
        run_optimisation,
        unsolved_start_as_dict,
        write_numbers,
    )

    check_outputs(options)
    task = read_optimisation(options.scene, options.set)
    page = Reporter(options)
    try:
        found = run_optimisation(task, progress=options.progress)
    except SolveError as error:
        numbers = unsolved_start_as_dict(task, error)
        write(
            (options.json, lambda path: write_numbers(path, numbers)),
            (options.plot, None),
            (options.report, None),
        )
        complain(error)
        return NOT_SOLVED

    text = optimisation_report(task, found) if found.converged else ""

    def draw(path, **format):
        from ..plot import optimised

        save(optimised(found, title=task.scene.name), path, **format)

    def tell(path):
        texts, draws = {"Optimised design": text}, {"Before and after": draw}
        page(path, task.scene.name, texts, task.inputs, draws)

    drawn = write(
        (
            options.json,
            lambda path: write_numbers(path, optimisation_as_dict(task, found)),
        ),
        (options.plot, draw if found.converged else None),
        (options.report, tell if found.converged else None),
    )
    if not found.converged:
        complain(f"{found.result}: {found.message}")
        return NOT_SOLVED
    print(text, flush=True)
    return drawn

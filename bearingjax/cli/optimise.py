"""`bearingjax optimise`."""

from . import jax_settings
from .options import add_plot, add_quiet, add_report, add_scene
from .outputs import Reporter, check_outputs, draws_bearing, save, write
from .progress import is_shown
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
    add_quiet(command)
    return command


def run(options) -> int:
    """Optimise the bearing of a scene."""
    from ..numerics import SolveError
    from ..optimise.system import element_of
    from ..scene import (
        optimisation_as_dict,
        optimisation_report,
        read_optimisation,
        run_optimisation,
        scene_of_design,
        unsolved_start_as_dict,
        with_set_preload,
        write_numbers,
    )

    check_outputs(options)
    task = read_optimisation(options.scene, options.set)
    page = Reporter(options)
    try:
        found = run_optimisation(task, progress=is_shown(options))
    except SolveError as error:
        numbers = unsolved_start_as_dict(task, error)
        write(
            (options.json, lambda path: write_numbers(path, numbers)),
            (options.plot, None),
            (options.report, None),
        )
        complain(error)
        return NOT_SOLVED

    best = scene_of_design(task, found.element)
    if found.converged:
        best = with_set_preload(best, jax_settings.programs())
    text = optimisation_report(task, found, best) if found.converged else ""

    def draw(path, **format):
        from ..plot import optimised

        save(optimised(found, title=task.scene.name), path, **format)

    def tell(path):
        texts, draws = {"Optimised design": text}, {"Before and after": draw}
        drawing = draws_bearing(task.scene, element_of(found.element))
        page(path, task.scene.name, texts, task.inputs, draws, drawing=drawing)

    drawn = write(
        (
            options.json,
            lambda path: write_numbers(path, optimisation_as_dict(task, found, best)),
        ),
        (options.plot, draw if found.converged else None),
        (options.report, tell if found.converged else None),
    )
    if not found.converged:
        complain(f"{found.result}: {found.message}")
        return NOT_SOLVED
    print(text, flush=True)
    return drawn

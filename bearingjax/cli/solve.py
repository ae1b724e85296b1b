"""`bearingjax solve`."""

from . import jax_settings
from .options import add_drawing, add_plot, add_report, add_scene
from .outputs import (
    Reporter,
    check_outputs,
    draws_bearing,
    draws_solution,
    tells_solution,
    write,
)
from .status import complain, tell_unsolved


def add(commands):
    """What may be written after it."""
    command = commands.add_parser(
        "solve",
        help="where the rings go under load",
        description="Solve the bearing of a scene file and print a report.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    add_scene(command)
    add_plot(command)
    add_drawing(command, "of the bearing, as it is solved")
    add_report(command, "pictures")
    return command


def run(options) -> int:
    """Solve the bearing of a scene."""
    from ..numerics import Result
    from ..scene import (
        has_cases,
        read_scene,
        report,
        run_scene,
        with_set_preload,
        write_json,
    )

    check_outputs(options)
    scene = read_scene(options.scene, options.set)
    page = Reporter(options)
    if has_cases(options.scene, options.set):
        complain("one load, that of [operating]; [cases] are for sweep, life, optimise")
    solution = run_scene(scene, jax_settings.programs())
    solved = Result(int(solution.result)) is Result.CONVERGED
    if solved:
        scene = with_set_preload(scene, jax_settings.programs())
    # Mounted and preloaded where the scene says so.
    element = solution.element if solved else scene.element
    drawn = write(
        (options.json, lambda path: write_json(path, scene, solution)),
        (options.plot, draws_solution(scene, solution) if solved else None),
        (options.drawing, draws_bearing(scene, element)),
        (options.report, tells_solution(scene, solution, page) if solved else None),
    )
    if not solved:
        return tell_unsolved(scene, solution)
    print(report(scene, solution), flush=True)
    return drawn

"""`bearingjax solve`."""

import io

from . import jax_settings
from .options import add_drawing, add_plot, add_report, add_scene
from .outputs import (
    check_matplotlib,
    check_outputs,
    check_report,
    origin,
    save,
    save_drawing,
    write,
)
from .status import SOLVED, tell_unsolved


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
    from ..scene import read_scene, report, run_scene, solve_page, write_json

    if options.report is not None:
        check_report(options.report)
        check_matplotlib()
    check_outputs(options)
    scene = read_scene(options.scene, options.set)
    begun = origin(options)
    solution = run_scene(scene, jax_settings.programs())

    def draw(path, **format):
        from ..plot import overview

        figure = overview(solution.element.bearing, solution, title=scene.name)
        save(figure, path, **format)

    solved = Result(int(solution.result)) is Result.CONVERGED

    def draw_bearing(path, **format):
        # Mounted and preloaded where the scene says so.
        element = solution.element if solved else scene.element
        save_drawing(element.bearing, scene.name, path, **format)

    def tell(path):
        pictures = {"Section, load zone, contacts": _png(draw)}
        page = solve_page(scene, solution, pictures, _png(draw_bearing), begun)
        path.write_text(page, encoding="utf-8")

    write(
        (options.json, lambda path: write_json(path, scene, solution)),
        (options.plot, draw if solved else None),
        (options.drawing, draw_bearing),
        (options.report, tell if solved else None),
    )
    if not solved:
        return tell_unsolved(scene, solution)
    print(report(scene, solution), flush=True)
    return SOLVED


def _png(draw):
    """A picture as the content of a file."""
    picture = io.BytesIO()
    draw(picture, format="png")
    return picture.getvalue()

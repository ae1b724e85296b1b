"""`bearingjax life`."""

import dataclasses
import sys
from pathlib import Path

from . import jax_settings
from .options import add_plot, add_quiet, add_report, add_scene, add_table
from .outputs import (
    Reporter,
    check_outputs,
    check_table,
    draws_bearing,
    draws_solution,
    save,
    tells_solution,
    write,
)
from .progress import is_shown
from .status import NOT_SOLVED, complain, tell_unsolved


def add(commands):
    """What may be written after it."""
    command = commands.add_parser(
        "life",
        help="rating life, of one load or of a load spectrum",
        description="Rating life of the bearing of a scene file by ISO 281 and ISO/TS"
        " 16281, as its [life] says, under its load or, if it has [cases], under all of"
        " them, whose damage adds up over their hours.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    add_scene(command)
    add_table(command, "case")
    add_plot(command)
    add_report(command, "pictures")
    add_quiet(command)
    return command


def run(options) -> int:
    """Rating life of the bearing of a scene."""
    from ..scene import has_cases

    check_table(options)
    check_outputs(options)
    if has_cases(options.scene, options.set):
        return _life_of_cases(options)
    return _life_of_load(options)


def _life_of_load(options) -> int:
    from ..numerics import Result
    from ..scene import (
        SceneError,
        fits_as_dict,
        fits_text,
        life_as_dict,
        life_report,
        rating_origins,
        read_scene,
        run_scene,
        scene_life,
        solved_as_dict,
        with_set_preload,
        write_numbers,
    )
    from ..statics import LifeConditions

    if options.table is not None:
        raise SceneError("--table is for a scene with [cases]; this one has one load")
    scene = read_scene(options.scene, options.set)
    if scene.life is None:
        scene = dataclasses.replace(scene, life=LifeConditions())
    page = Reporter(options)
    solution = run_scene(scene, jax_settings.programs())
    solved = Result(int(solution.result)) is Result.CONVERGED
    if solved:
        scene = with_set_preload(scene, jax_settings.programs())
    life = scene_life(scene, solution) if solved else None
    numbers = solved_as_dict(scene, solution, life)
    if life is not None:
        told = life_as_dict(life, rating_origins(scene))
        numbers = {**told, **fits_as_dict(scene), **numbers}
    drawn = write(
        (options.json, lambda path: write_numbers(path, numbers)),
        (options.plot, draws_solution(scene, solution) if solved else None),
        (options.report, tells_solution(scene, solution, page) if solved else None),
    )
    if life is None:
        return tell_unsolved(scene, solution)
    print(f"{scene.name}\n{life_report(scene, solution, life)}")
    if scene.fits is not None:
        print(fits_text(scene))
    for text in numbers["warnings"]:
        print(f"warning: {text}")
    sys.stdout.flush()
    return drawn


def _life_of_cases(options) -> int:
    from ..scene import (
        cases_with_set_preload,
        life_columns,
        read_cases,
        run_life,
        spectrum_as_dict,
        spectrum_report,
        spectrum_sections,
        unsolved,
        write_numbers,
    )
    from ..statics.sweep_table import write_columns

    table = read_cases(options.scene, options.set)
    page = Reporter(options)
    table = cases_with_set_preload(table, jax_settings.programs())
    done = run_life(table, is_shown(options))

    def draw(path, **format):
        from ..plot import life_overview

        save(life_overview(done, title=table.scene.name), path, **format)

    text = spectrum_report(done) if done.converged else ""

    def tell(path: Path):
        scene, draws = table.scene, {"Lives and damage of the cases": draw}
        page(
            path,
            scene.name,
            spectrum_sections(done),
            table.inputs,
            draws,
            life_columns(done),
            drawing=draws_bearing(scene, scene.running()),
        )

    drawn = write(
        (options.table, lambda path: write_columns(life_columns(done), path)),
        (options.json, lambda path: write_numbers(path, spectrum_as_dict(done))),
        (options.plot, draw if done.converged else None),
        (options.report, tell if done.converged else None),
    )
    if not done.converged:
        complain(unsolved(done))
        return NOT_SOLVED
    print(text, flush=True)
    return drawn

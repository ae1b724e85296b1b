"""`bearingjax life`."""

import dataclasses
from argparse import Namespace

from ..outcome import Outcome, Tools, outcome_of, picture
from ..solve.command import solution_outcome


def run(options: Namespace, tools: Tools) -> Outcome:
    """Rating life of the bearing of a scene file by ISO 281 and ISO/TS 16281, as its
    [life] says, under its load or, if it has [cases], under all of them, whose damage
    adds up over their hours."""
    from ...files.scene_file import has_cases

    if has_cases(options.scene, options.set):
        return _life_of_cases(options, tools)
    return _life_of_load(options)


def _life_of_load(options) -> Outcome:
    from ...life import LifeConditions
    from ..bearing.read_scene import read_scene
    from ..solve.output import solved_life_as_dict
    from .life_run import life_row

    scene = read_scene(options.scene, options.set)
    if scene.life is None:
        scene = dataclasses.replace(scene, life=LifeConditions())
    brief = "Bearing", "Rating life", "Fits and clearance"
    return solution_outcome(scene, solved_life_as_dict, brief, life_row)


def _life_of_cases(options, tools: Tools) -> Outcome:
    from . import life_run
    from .read_cases import read_cases
    from .sweep_run import cases_with_set_preload

    table = cases_with_set_preload(read_cases(options.scene, options.set))
    done, scene = life_run.run_life(table, tools.shown), table.scene
    draw = picture("life_overview", done, title=scene.name)
    return outcome_of(
        scene.name,
        table.inputs,
        (done,),
        life_run.spectrum_as_dict,
        life_run.spectrum_report,
        life_run.life_columns,
        {"Lives and damage of the cases": draw},
        solved=done.converged,
        drawing=lambda: picture(
            "drawing", scene.running().bearing, scene.name, scene.entry
        )(),
        page=lambda: life_run.spectrum_page(done),
        table_on_page=True,
        problems=[] if done.converged else [done.failure_message],
    )

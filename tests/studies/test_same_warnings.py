"""`sweep` and `optimise` warn of all that `solve` warns of, whatever they keep or seek:
the same sentences, word by word, with the same sizes."""

import re

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.life.life_warning import ALL, LIFE_KINDS, life_sizes
from bearingjax.numerics.warning import warnings_of_cases
from bearingjax.statics.warning import sizes
from bearingjax.studies.bearing.solved import SolvedScene, scene_life
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.cases.sweep_run import all_warnings, run_cases
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.optimise.report import optimisation_as_dict
from bearingjax.studies.optimise.run import run_optimisation
from bearingjax.studies.solve.output import solution_json
from bearingjax.studies.solve.run import run_scene

LIGHT = """
[bearing]
designation = "6205"
[fit]
shaft = "g6"
housing = "H7"
housing_diameter = "80 mm"
[temperature]
inner_ring = "80 °C"
[operating]
load = { Fy = "-100 N", My = "4 N m" }
inner_speed = "30000 rpm"
[life]
viscosity = "200 mm^2/s"
contamination = "grease, normal"
"""
HEAVY = """
[bearing]
designation = "NJ 205 ECP"
roller_profile = { type = "straight" }
[operating]
load = { Fy = "-25 kN", Fz = "500 N" }
free = ["ux", "uy", "uz"]
inner_speed = "20 rpm"
[life]
viscosity = "2 mm^2/s"
contamination = 0.5
"""
pytestmark = pytest.mark.slow
SCENES = {"light": LIGHT, "heavy": HEAVY}
POINT = '[cases]\noutputs = ["n_loaded"]\n[cases.grid]\n"operating.load.Fy" = ["{}"]\n'
SEARCH = """[optimise]
objective = "mean_pressure"
max_steps = 1
[optimise.variables]
"bearing.radial_internal_clearance" = { from = "10 um", to = "40 um" }
"""


def solved(path, settings=()):
    """What is told of one case, and kinds of warning about its solution and life."""
    scene = bj.read_scene(path, settings)
    solution = run_scene(scene)
    life = scene_life(scene, solution)
    bearing = solution.element.bearing
    found = {**sizes(solution), **life_sizes(bearing, life.ratings, vars(life))}
    kinds = {name for name, size in found.items() if size > ALL[name].limit}
    told = solution_json(SolvedScene(scene, solution))["warnings"]
    assert len(told) == len(scene.warnings) + len(kinds)
    of_one = warnings_of_cases(
        {name: np.atleast_1d(size) for name, size in found.items()}, ALL
    )
    return alone((*scene.warnings, *of_one)), kinds


def alone(told):
    """Sentences without what is said of a case that is the only one."""
    return {text.removesuffix(", in 1 of 1 cases, worst case 0") for text in told}


@pytest.fixture(scope="module", params=SCENES)
def best(request, tmp_path_factory):
    """The scene of a best design, what is told of it, and what `solve` tells."""
    path = tmp_path_factory.mktemp("scenes") / "scene.toml"
    text = SCENES[request.param]
    force = re.search(r'Fy = "([^"]*)"', text)
    assert force is not None
    path.write_text(text + SEARCH + POINT.format(force[1]), encoding="utf-8")
    task = read_optimisation(path)
    found = run_optimisation(task)
    told = optimisation_as_dict(task, found)["warnings"]
    settings = [
        f"{v.name}={float(x)!r} m"
        for v, x in zip(found.variables, np.asarray(found.values), strict=True)
    ]
    return path, settings, told, solved(path, settings)


def test_a_best_design_is_warned_of_as_solve_does(best):
    *_, told, (wanted, kinds) = best
    assert kinds & set(LIFE_KINDS)
    assert alone(told) == wanted


def test_a_sweep_of_one_case_warns_as_solve_does(best):
    path, settings, _, (wanted, _) = best
    table = read_cases(path, settings)
    swept = run_cases(table)
    assert not any("life" in output for output in swept.outputs if output[:4] != "warn")
    assert alone(all_warnings(table, swept)) == wanted

"""`sweep` and `optimise` warn of all that `solve` warns of, whatever they keep or seek.

The scene's own sentences are compared word by word, those about a solution and its life
by their kinds.
"""

import re

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.scene import (
    read_cases,
    read_optimisation,
    run_cases,
    run_optimisation,
)
from bearingjax.scene.life_report import scene_life
from bearingjax.scene.optimise_report import optimisation_as_dict
from bearingjax.scene.output import as_dict
from bearingjax.scene.sweep_run import all_warnings
from bearingjax.statics.life_warning import LIFE_KINDS, life_sizes
from bearingjax.statics.warning import ALL, sizes

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
    """Sentences of the scene, and kinds of warning about its solution and life."""
    scene = bj.read_scene(path, settings)
    solution = bj.run_scene(scene)
    told = scene.warnings
    life = scene_life(scene, solution)
    bearing = solution.element.bearing
    found = {**sizes(solution), **life_sizes(bearing, life.ratings, vars(life))}
    kinds = {name for name, size in found.items() if size > ALL[name].limit}
    assert len(as_dict(scene, solution)["warnings"]) == len(scene.warnings) + len(kinds)
    return told, kinds


def parted(told):
    """Sentences without a kind, as of one case, and the kinds of the others."""
    kinds = {text.partition(": ")[0] for text in told} & set(ALL)
    own = [t for t in told if t.partition(": ")[0] not in kinds]
    return {re.sub(", in 1 of 1 cases, worst case 0", "", t) for t in own}, kinds


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
    *_, told, (own, kinds) = best
    assert kinds & set(LIFE_KINDS)
    assert parted(told) == (set(own), kinds)


def test_a_sweep_of_one_case_warns_as_solve_does(best):
    path, settings, _, (own, kinds) = best
    table = read_cases(path, settings)
    swept = run_cases(table)
    assert not any("life" in output for output in swept.outputs if output[:4] != "warn")
    assert parted(all_warnings(table, swept)) == (set(own), kinds)

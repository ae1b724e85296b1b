"""`sweep`, `optimise`, `identify` and `tolerances` warn of all that `solve` warns of,
whatever they keep or seek: the same sentences, word by word, with the same sizes."""

import re

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.files.scene_file import parse_scene
from bearingjax.files.table import Table
from bearingjax.life.life_warning import ALL, LIFE_KINDS, life_sizes
from bearingjax.numerics.warning import warnings_of_cases
from bearingjax.statics.warning import sizes
from bearingjax.studies.bearing.solved import SolvedScene, scene_life
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.cases.sweep_run import all_warnings, run_cases
from bearingjax.studies.identify.subjects import read_setup
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.optimise.report import optimisation_as_dict
from bearingjax.studies.optimise.run import run_optimisation
from bearingjax.studies.solve.output import solution_json
from bearingjax.studies.solve.run import run_scene
from bearingjax.studies.tolerances.read import read_tolerances
from bearingjax.studies.tolerances.report import tolerance_warnings
from bearingjax.studies.tolerances.run import run_tolerances

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
SCATTERED = """[tolerances]
samples = 8
measures = [{ measure = "mean_pressure" }]
"""
NUMBERS = """[tolerances.numbers]
"bearing.radial_internal_clearance" = {{ mean = "{}", deviation = "1 nm" }}
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
    return {*scene.warnings, *of_one}, kinds


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
    assert set(told) == wanted


def test_a_sweep_of_one_case_warns_as_solve_does(best):
    path, settings, _, (wanted, _) = best
    table = read_cases(path, settings)
    swept = run_cases(table)
    assert not any("life" in output for output in swept.outputs if output[:4] != "warn")
    assert set(all_warnings(table, swept)) == wanted


def test_numbers_that_are_identified_are_warned_of_as_solve_does(best):
    """At the values of the best design, in rows with empty places."""
    path, settings, _, (wanted, _) = best
    data = parse_scene(path, settings)
    data = {k: data[k] for k in data.keys() - {"cases", "optimise"}}
    subject = read_setup(data, path).subject(Table(data, path), [], 1)
    told = subject.model.for_numbers([], []).warnings((), subject.cases)
    assert set([*subject.scene.warnings, *told]) == wanted


def test_the_mean_within_tolerances_is_warned_of_as_solve_does(best, tmp_path):
    path, settings, _, (wanted, _) = best
    scene, text = tmp_path / "scene.toml", path.read_text(encoding="utf-8")
    (clearance,) = (one.partition("=")[2] for one in settings)
    scattered = text.partition("[optimise]")[0] + SCATTERED
    if "[fit]" not in text:  # whose sizes scatter by themselves
        scattered += NUMBERS.format(clearance)
    scene.write_text(scattered, encoding="utf-8")
    task = read_tolerances(scene, settings)
    found = tolerance_warnings(task, run_tolerances(task))
    assert set([one.removeprefix("at the mean: ") for one in found]) == wanted

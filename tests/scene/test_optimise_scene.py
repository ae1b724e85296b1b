"""[optimise] in a scene, its command, and what is wrong with wrong ones."""

import io
import json
import re
from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax import SceneError, read_scene
from bearingjax.numerics.units import unit_of
from bearingjax.optimise import design_numbers
from bearingjax.optimise.variable import changed
from bearingjax.scene import (
    optimisation_report,
    read_optimisation,
    shipped_scenes,
)
from bearingjax.scene.optimise_table import scene_numbers
from bearingjax.scene.quantity import kind_of

BEARING = """
[bearing]
type = "cylindrical_roller"
n_rollers = 6
pitch_diameter = "50 mm"
roller_diameter = "10 mm"
roller_length = "12 mm"
first_azimuth = "-90 deg"
radial_internal_clearance = "10 um"

[operating]
load = { Fy = "-3 kN" }
free = ["uy"]

[numerics]
quadrature = "midpoint"
points = 5
tolerance = 1e-11

[output]
points = 2

"""
PLAY = '"bearing.radial_internal_clearance" = { from = "0 um", to = "40 um" }'
STIFF = 'objective = "stiffness"\nfreedom = "uy"\ntarget = "%s"\n'
GOOD = STIFF % "150 kN/mm" + "[optimise.variables]\n" + PLAY


@pytest.fixture
def scene(tmp_path):
    """Write the [optimise] table of a scene, and get the path of the whole."""

    def write(table):
        path = tmp_path / "free.toml"
        path.write_text(f"{BEARING}[optimise]\n{table}\n", encoding="utf-8")
        return path

    return write


@pytest.mark.slow
def test_command_finds_the_clearance_of_a_stiffness(
    run, rerun, undrawn, scene, tmp_path
):
    element = read_scene(scene(GOOD)).element
    wanted = bj.solve_load(
        changed(element, {"bearing.radial_internal_clearance": 15e-6}),
        [0, -3e3, 0, 0, 0, 0],
        free=["uy"],
    ).stiffness[7, 7]
    table = GOOD.replace("150 kN/mm", f"{1e-6 * float(wanted)!r} kN/mm")
    out = tmp_path / "out.json"
    done = run("optimise", scene(table + "\n"), "--json", out)
    assert done.status == 0 and done.err == ""
    numbers = json.loads(out.read_text())
    assert numbers["result"] == "converged" and numbers["version"] == bj.__version__
    (play,) = numbers["variables"]
    assert play["name"] == "bearing.radial_internal_clearance"
    assert np.isclose(play["before"], 10e-6) and np.isclose(play["after"], 15e-6)
    assert np.isclose(play["lower"], 0.0) and np.isclose(play["upper"], 40e-6)
    assert numbers["objective"]["measure"] == "miss of stiffness uy"
    assert numbers["objective"]["after"]["smooth"] < 1e-9
    assert 0 <= numbers["optimality"] <= 1e-5
    assert "; gradient left " in done.out
    assert numbers["history"]["values"][0] == [play["before"]]
    assert numbers["evaluations"] == numbers["gradients"] > 2
    # The report says the same, in its units.
    row = r"radial_internal_clearance +10 +15 +µm +0 to 40\n"
    assert re.search(row, done.out), done.out
    assert "optimised over 1 operating case in" in done.out
    rerun("optimise", out, pictures=2)
    undrawn("optimised", out, "optimise", tmp_path / "again.json")
    # Not converged: no numbers that could be taken for results.
    hasty = table.replace("[optimise.v", 'method="adam"\nmax_steps=1\n[optimise.v')
    done = run("optimise", scene(hasty), "--json", out)
    assert done.status == 3 and done.out == ""
    assert done.err.startswith("bearingjax: step_limit: step limit reached after 1")
    numbers = json.loads(out.read_text())
    assert numbers["result"] == "step_limit" and "variables" not in numbers


@pytest.mark.slow
def test_start_without_a_solution(run, scene, tmp_path):
    pulled = '"operating.load.Fz=1 kN"'
    setting = ("--set", pulled.strip('"'), "--set", 'operating.free=["uy", "uz"]')
    out, picture = tmp_path / "out.json", tmp_path / "out.png"
    picture.write_text("of an earlier run", encoding="utf-8")
    done = run("optimise", scene(GOOD), *setting, "--json", out, "--plot", picture)
    assert done.status == 3 and done.out == "" and not picture.exists()
    numbers = json.loads(out.read_text())
    assert numbers["result"] == "start_not_solved" and "case 0" in numbers["message"]
    assert "starting design fails: case 0: no_load_path: No load path in uz" in done.err


def test_optimise_command_invalid_measure_is_scene_error(run, scene, monkeypatch):
    def refuse(*_, **__):
        raise ValueError("Displacement: `freedom` is 'ux', which is not free")

    monkeypatch.setattr("bearingjax.scene.bearing_run.optimise", refuse)
    done = run("optimise", scene(GOOD))
    assert done.status == 2 and done.out == ""
    assert "free: Displacement: `freedom` is 'ux'" in done.err


def test_optimise_command_progress_on_terminal_only(run, scene, monkeypatch):
    asked = []

    def note(*_, progress, **__):
        asked.append(progress)
        raise ValueError("enough")

    monkeypatch.setattr("bearingjax.scene.bearing_run.optimise", note)
    run("optimise", scene(GOOD))
    told = io.StringIO()
    told.isatty = lambda: True  # pyright: ignore[reportAttributeAccessIssue]
    watched = SimpleNamespace(stderr=told)
    monkeypatch.setattr("bearingjax.cli.execute.sys", watched)
    run("optimise", scene(GOOD))
    run("optimise", scene(GOOD), "--quiet")
    assert asked == [False, True, False]


def test_read_optimisation_of_shipped_scene():
    task = read_optimisation("fujiwara_kawase")
    assert [v.name.rpartition(".")[2] for v in task.variables] == [
        "load_factor",
        "crowned_fraction",
        "end_drop",
    ]
    assert np.isclose(task.variables[2].upper, 60e-6)
    assert isinstance(task.objective, bj.optimise.PeakPressure)
    assert task.cases.count == 4
    assert np.allclose(task.cases.load[:, 1], [-18e3, -12e3, -8e3, -4e3])
    assert np.allclose(task.cases.prescribed["gx"], [2e-3, 1.5e-3, 1e-3, 5e-4])
    assert task.cases.hours is not None and task.cases.hours[2] == 4000.0
    (constraint,) = task.constraints
    assert isinstance(constraint.measure, bj.optimise.EdgeLoad)
    assert constraint.lower is None and float(constraint.upper) == 10e3


BEARINGS = sorted(
    name
    for name in {*shipped_scenes()} - {"taper_contact"}
    if not name.startswith(("rotor_", "shaft_"))
)


@pytest.mark.parametrize("name", BEARINGS)
def test_every_number_of_every_scene_may_be_free(name):
    """Each has a kind of quantity, and its paths lead to it."""
    element = read_scene(name).element
    there = design_numbers(element)
    numbers = scene_numbers(element)
    assert len(numbers) >= 6
    for key, paths in numbers.items():
        assert set(paths) <= set(there), key
        assert not (unit := unit_of(element, paths[0])) or kind_of(unit), key


def test_all_ribs_and_all_rows_share_a_number():
    ribs = scene_numbers(read_scene("cylindrical_ribs").element)
    assert len(ribs["bearing.rib.axial_gap"]) == 4
    assert ribs["bearing.ribs.outer_plus.axial_gap"] == (
        "bearing.ribs.outer_plus.axial_gap",
    )
    rows = scene_numbers(read_scene("ball_pair").element)
    assert rows["bearing.contact_angle"] == (
        "bearing.rows.0.bearing.contact_angle",
        "bearing.rows.1.bearing.contact_angle",
    )


@pytest.mark.slow
def test_report_needs_no_unit_of_a_plain_measure(scene):
    """A function of one's own has a name, and no unit."""
    path = scene(GOOD)
    task = read_optimisation(path)
    asked = task.scene

    def own(element, cases, solution):
        return jnp.sum(solution.displacement[:, 7] ** 2)

    found = bj.optimise.optimise(
        asked.installed,
        task.cases,
        task.variables,
        own,
        method="nelder-mead",
        free=["uy"],
        points=2,
        max_steps=3,
    )
    assert "\nown " in str(optimisation_report(task, found))


FILES = {
    "no objective": ("[optimise.variables]\n" + PLAY, "`optimise.objective`: is miss"),
    "objective": (
        GOOD.replace("stiffness", "stifness"),
        "`optimise.objective`: 'stifness' is not known (did you mean `stiffness`?)",
    ),
    "no variables": (STIFF % "1 N/m", "`optimise.variables`: is missing"),
    "empty variables": (
        STIFF % "1 N/m" + "[optimise.variables]",
        "[optimise.variables]: optimise: `variables` is empty",
    ),
    "unquoted": (
        GOOD.replace('"bearing.radial_internal_clearance"', "bearing.play"),
        "`optimise.variables.bearing`: write the dotted key in quotes, such as",
    ),
    "unknown number": (
        GOOD.replace("bearing.radial_internal", "bearing.radial"),
        "'bearing.radial_clearance' is not known (did you mean"
        " `bearing.radial_internal_clearance`?)",
    ),
    "a count": (
        GOOD.replace("bearing.radial_internal_clearance", "bearing.n_rollers"),
        "'bearing.n_rollers' is not known",
    ),
    "no unit": (
        GOOD.replace('"40 um"', "40"),
        "clearance.to`: 40 has no unit; a length with its unit is wanted",
    ),
    "wrong unit": (GOOD.replace("40 um", "40 N"), "'40 N' is not a length"),
    "no upper bound": (
        GOOD.replace(', to = "40 um"', ""),
        "clearance.to`: is missing",
    ),
    "unknown bound": (
        GOOD.replace('to = "40 um"', 'to = "40 um", step = "1 um"'),
        "clearance.step`: unknown key",
    ),
    "bounds upside down": (
        GOOD.replace('"0 um"', '"50 um"'),
        "`lower` of bearing.radial_internal_clearance is 5e-05; it must be below",
    ),
    "start outside": (
        GOOD.replace('"0 um"', '"12 um"'),
        "the start of bearing.radial_internal_clearance is 1e-05; it must lie between",
    ),
    "bound not allowed": (
        GOOD.replace('"40 um"', '"40 mm"'),
        "`upper` of bearing.radial_internal_clearance is 0.04, which the design does"
        " not allow: CylindricalRollerBearing: `radial_internal_clearance`",
    ),
    "freedom": (
        GOOD.replace('"uy"', '"gz"'),
        "`optimise.freedom`: 'gz' is not known; it must be one of ux, uy, uz, gx, gy",
    ),
    "target without unit": (
        GOOD.replace('"150 kN/mm"', "150"),
        "`optimise.target`: 150 has no unit; a stiffness with its unit",
    ),
    "target of a tilt": (
        GOOD.replace('"uy"', '"gx"'),
        "'150 kN/mm' is not a tilting stiffness; a tilting stiffness with its unit is"
        ' wanted, such as "5 kN m/rad"',
    ),
    "target of a pressure": (
        GOOD.replace('"stiffness"', '"peak_pressure"').replace('freedom = "uy"', ""),
        "`optimise.target`: goes with `objective` = stiffness",
    ),
    "exponent": (
        "exponent = 1\n" + GOOD,
        "PeakPressure: `exponent` is 1; it must be ab",
    ),
    "method": (
        'method = "newton"\n' + GOOD,
        "'newton' is not known; it must be one of",
    ),
    "tolerance": ("tolerance = 0.5\n" + GOOD, "0.5 is not allowed; above 0 and below"),
    "steps": (
        "max_steps = 0\n" + GOOD,
        "`optimise.max_steps`: 0 is not a whole number",
    ),
    "constraint without bound": (
        GOOD + '\n[[optimise.constraints]]\nmeasure = "edge_load"',
        "`optimise.constraints[0].measure`: give `at_least`, `at_most` or both",
    ),
    "constraint with a wrong unit": (
        GOOD + '\n[[optimise.constraints]]\nmeasure = "edge_load"\nat_most = "1 kN"',
        "`optimise.constraints[0].at_most`: '1 kN' is not a line load",
    ),
    "unknown key of a constraint": (
        GOOD + '\n[[optimise.constraints]]\nmeasure = "edge_load"\nmost = "1 N/mm"'
        '\nat_least = "0 N/mm"',
        "`optimise.constraints[0].most`: unknown key (did you mean `at_most`?)",
    ),
    "bounds of a constraint upside down": (
        GOOD + '\n[[optimise.constraints]]\nmeasure = "displacement"\nfreedom = "uy"'
        '\nat_least = "2 um"\nat_most = "1 um"',
        "[optimise.constraints[0]]: Constraint: `upper` is 1e-06; it must be above",
    ),
    "method without constraints": (
        'method = "adam"\n' + GOOD + '\n[[optimise.constraints]]\nmeasure = "stiffness"'
        '\nfreedom = "uy"\nat_least = "1 kN/mm"',
        "`optimise.method`: 'adam' keeps no constraints; take \"slsqp\"",
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_wrong_tables(scene, name):
    table, text = FILES[name]
    with pytest.raises(SceneError) as caught:
        read_optimisation(scene(table))
    message = str(caught.value)
    assert message.startswith("free.toml: ") and "\n" not in message
    assert text in message, message


def test_edge_load_of_balls():
    with pytest.raises(SceneError, match="balls have no ends"):
        read_optimisation("deep_groove", ["optimise.objective=edge_load"])


def test_cases_of_several_designs(scene):
    grid = 'bearing.radial_internal_clearance = ["0 um", "5 um"]'
    with pytest.raises(SceneError, match="`cases`: bearing.*vary the design"):
        read_optimisation(scene(f"{GOOD}\n[cases.grid]\n{grid}"))


def test_scene_without_the_table(run):
    done = run("optimise", "cylindrical_rig")
    assert done.status == 2
    assert "cylindrical_rig.toml: `optimise` is missing" in done.err


def test_read_optimisation_variable_units():
    ask = "optimise.objective=peak_pressure", "optimise.exponent=32"
    shoulder = "bearing.outer_shoulder"
    table = '{"%s" = {from = "1 mm", to = "%s"}, "bearing.outer_osculation"'
    table = f"optimise.variables={table} = {{from = 0.51, to = 0.53}}}}"
    task = read_optimisation("deep_groove", [*ask, table % (shoulder, "5 mm")])
    first, second = task.variables
    assert (first.lower, first.upper) == (1e-3, 5e-3)
    assert (second.lower, second.upper) == (0.51, 0.53)
    with pytest.raises(SceneError, match=f"{shoulder}.*is not a length"):
        read_optimisation("deep_groove", [*ask, table % (shoulder, "5 deg")])

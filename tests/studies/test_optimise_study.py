"""[optimise] in scenes of bearings and of shafts, and what its command makes of it."""

import io
import json
import re
from pathlib import Path
from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest
from runs import Runs, Study
from tolerances import SOLVER

import bearingjax as bj
from bearingjax import SceneError, read_scene
from bearingjax.files import shipped_scenes
from bearingjax.files.quantity import kind_of
from bearingjax.numerics.units import unit_of
from bearingjax.optimise import design_numbers
from bearingjax.optimise.variable import with_numbers
from bearingjax.studies.optimise.read_optimise import scene_numbers
from bearingjax.studies.optimise.read_shaft_optimise import (
    read_optimisation,
    shaft_numbers,
)
from bearingjax.studies.optimise.report import optimisation_report
from bearingjax.studies.shaft.read import read_shafts
from bearingjax.studies.shaft.run import run_shafts
from bearingjax.studies.study import study_of

REFUSED = Path(__file__).with_name("refused")
CLEARANCE, SEATS = REFUSED / "clearance.toml", REFUSED / "seats.toml"
GEARS = """
[gear.z1]
shaft = "s"
position = "130 mm"
teeth = 20
normal_module = "3 mm"
mesh_angle = "0 deg"
mates_with = "z2"

[gear.z2]
shaft = "t"
position = "60 mm"
teeth = 40
normal_module = "3 mm"

[shaft.t]
segments = [{ length = "120 mm", outer_diameter = "40 mm" }]

[bearings.C]
shaft = "t"
position = "20 mm"
stiffness = { radial = "1e9 N/m", axial = "1e9 N/m", tilt = "1e6 N m/rad" }
"""
PLAY = "radial_internal_clearance"
PULLED = "operating.free=['uy', 'uz']"
STUDIES = {
    "clearance": Study(
        ("optimise", CLEARANCE.read_text(encoding="utf-8")),
        files={"--json": "a.json", "--plot": "a.png"},
        pictures=2,
        unsolved={
            "pulled": (
                ("--set", "operating.load.Fz=1 kN", "--set", PULLED),
                "start_not_solved",
                "optimise: the starting design fails: case 0: no_load_path: No load"
                " path in uz",
            )
        },
        slow=(True, True),
    ),
    "seats": Study(
        ("optimise", SEATS.read_text(encoding="utf-8")),
        files={"--json": "a.json", "--plot": "a.png", "--report": "a.html"},
        again=None,
    ),
}


class TestRuns(Runs):
    """Runs of the command."""


@pytest.mark.slow
def test_command_finds_the_clearance_of_a_stiffness(run, written, undrawn, tmp_path):
    done, numbers, paths = written("clearance")
    found = bj.solve_load(
        with_numbers(read_scene(CLEARANCE).element, {f"bearing.{PLAY}": 15e-6}),
        [0, -3e3, 0, 0, 0, 0],
        support=bj.Support(free=["uy"]),
    ).stiffness[7, 7]
    target = float(read_optimisation(CLEARANCE).objective.target)
    assert np.isclose(target, float(found), rtol=SOLVER, atol=0.0)
    (play,) = numbers["variables"]
    assert play["name"] == f"bearing.{PLAY}"
    assert np.isclose(play["before"], 10e-6) and np.isclose(play["after"], 15e-6)
    assert np.isclose(play["lower"], 0.0) and np.isclose(play["upper"], 40e-6)
    assert numbers["objective"]["measure"] == "miss of stiffness uy"
    assert numbers["objective"]["after"]["smooth"] < 1e-9
    assert 0 <= numbers["optimality"] <= 1e-5
    assert "; gradient left " in done.out
    assert numbers["history"]["values"][0] == [play["before"]]
    assert numbers["evaluations"] == numbers["gradients"] > 2
    # The report says the same, in its units.
    row = rf"{PLAY} +10 +15 +µm +0 to 40\n"
    assert re.search(row, done.out), done.out
    assert "optimised over 1 operating case in" in done.out
    scene = paths["--json"].with_name("mine.toml")
    undrawn("optimise_overview", paths["--json"], "optimise", scene)
    # Not converged: no numbers that could be taken for results.
    out, hasty = tmp_path / "out.json", ("method=adam", "max_steps=1")
    words = (word for one in hasty for word in ("--set", f"optimise.{one}"))
    done = run("optimise", CLEARANCE, *words, "--json", out)
    assert done.status == 3 and done.out == ""
    assert done.err.startswith("bearingjax: step_limit: step limit reached after 1")
    numbers = json.loads(out.read_text())
    assert numbers["result"] == "step_limit" and "variables" not in numbers


@pytest.mark.slow
def test_seats_of_a_shaft(written):
    """The lives are those of `bearingjax shaft`."""
    done, found, paths = written("seats")
    assert "rating life" in done.out and "maximised" in done.out
    before, after = (found["rating_life"][side] for side in ("before", "after"))
    assert after > 1.2 * before
    assert min(of["rating_life"]["after"] for of in found["bearings"].values()) == after
    assert "Bearings" in paths["--report"].read_text(encoding="utf-8")
    best = {one["name"]: one["after"] for one in found["variables"]}
    names = "bearings.B.position", f"bearings.B.{PLAY}"
    alone = run_shafts(read_shafts(SEATS, [f"{n}={best[n]!r} m" for n in names]))
    assert alone.hours.min() == pytest.approx(after, rel=1e-6)


def test_study_of_optimise_scene():
    """The scene is one of `optimise`; `shaft` takes its numbers as they stand."""
    assert study_of(SEATS) == "optimise"
    assert read_shafts(SEATS).system.seats[1].position == pytest.approx(0.18)
    assert "optimise" in read_optimisation(SEATS).inputs


def test_optimise_command_invalid_measure_is_scene_error(run, monkeypatch):
    def refuse(*_, **__):
        raise ValueError("Displacement: `freedom` is 'ux', which is not free")

    monkeypatch.setattr("bearingjax.studies.optimise.run.optimise", refuse)
    done = run("optimise", CLEARANCE)
    assert done.status == 2 and done.out == ""
    assert "clearance: `freedom` is 'ux'" in done.err


def test_optimise_command_tells_progress_unless_quiet(run, monkeypatch):
    asked = []

    def note(*_, search, **__):
        asked.append(search.told is not None)
        raise ValueError("enough")

    monkeypatch.setattr("bearingjax.studies.optimise.run.optimise", note)
    run("optimise", CLEARANCE)
    told = io.StringIO()
    told.isatty = lambda: True  # pyright: ignore[reportAttributeAccessIssue]
    watched = SimpleNamespace(stderr=told)
    monkeypatch.setattr("bearingjax.cli.execute.sys", watched)
    run("optimise", CLEARANCE)
    run("optimise", CLEARANCE, "--quiet")
    assert asked == [True, True, False]


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
    for name in {*shipped_scenes()} - {"taper_contact", "select_gearbox"}
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
def test_report_needs_no_unit_of_a_plain_measure():
    """A function of one's own has a name, and no unit."""
    task = read_optimisation(CLEARANCE)
    asked = task.scene

    def own(element, cases, solution):
        return jnp.sum(solution.displacement[:, 7] ** 2)

    found = bj.optimise.optimise(
        asked.installed,
        task.cases,
        task.variables,
        own,
        search=bj.optimise.SearchOptions(
            "nelder-mead", max_steps=3, solve=bj.statics.SolveOptions(points=2)
        ),
        support=bj.Support(free=["uy"]),
    )
    assert "\nown " in str(optimisation_report(task, found))


def test_shaft_numbers_list_variables(tmp_path):
    """Numbers of bearings, segments and wheels, those of a mesh with all its gears."""
    path = tmp_path / "gears.toml"
    path.write_text(SEATS.read_text("utf-8") + GEARS, encoding="utf-8")
    found = shaft_numbers(read_shafts(path))
    assert found["shaft.s.segments.1.outer_diameter"] == (
        "system.shafts.0.outer_diameter.1",
    )
    module = ("system.wheels.0.normal_module", "system.wheels.1.normal_module")
    assert found["gear.z2.normal_module"] == module
    assert found["gear.z2.position"] == ("system.wheels.1.position",)
    assert "bearings.A.preload" in found and "bearings.B.preload" not in found
    assert "bearings.C.position" in found and "bearings.C.type" not in found


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

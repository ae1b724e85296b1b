"""The preload of a set on its seats, as solve and life tell it."""

import json
import re
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.cases.sweep_table import columns
from bearingjax.statics.preload import SetPreload
from bearingjax.statics.service_warning import preload_range_warnings, preload_warnings
from bearingjax.studies.bearing.fit_report import preload_report
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.cases.sweep_run import run_cases, set_warnings, sweep_report
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.optimise.scene_of_design import scene_of_design

PAIR = """
[bearing]
type = "angular_contact_ball"
n_balls = 9
pitch_diameter = "38.5 mm"
ball_diameter = "7.94 mm"
contact_angle = "25 deg"
outer_osculation = 0.53
inner_osculation = 0.52

[set]
arrangement = "back_to_back"
spacing = "40 mm"
preload_force = "200 N"

[operating]
load = { Fz = "500 N" }
free = ["uz"]

[fit]
bore = "25 mm"
outside_diameter = "52 mm"
housing_diameter = "80 mm"
ring_width = "15 mm"
shaft = "j5"
housing = "H7"

[temperature]
inner_ring = "45 °C"
shaft = "45 °C"
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "pair.toml"
    path.write_text(PAIR, encoding="utf-8")
    return path


def left(read, at):
    """What `remaining_preload` says of the set ground by hand and put on its seats."""
    ground = bj.preload(read.element, 200.0)
    seats = at.installed.mounting, at.installed.conditions
    return float(
        bj.statics.remaining_preload(bj.Installed(ground, None, *seats).element_at())
    )


@pytest.mark.slow
def test_solve_command_reports_preload(run, scene, tmp_path):
    out = tmp_path / "out.json"
    done = run("solve", scene, "--json", out)
    assert done.status == 0 and done.err == ""
    numbers = json.loads(out.read_text())
    found = numbers["fit"]["preload"]
    assert found["ground"] == pytest.approx(200.0, rel=1e-8)
    read = bj.read_scene(scene)
    assert found["operating"] == pytest.approx(left(read, read), rel=1e-8)
    ends = [
        left(read, bj.read_scene(scene, [f"fit.at={place}"]))
        for place in ("loosest", "tightest")
    ]
    np.testing.assert_allclose(found["worst"]["operating"], ends, rtol=1e-8)
    assert ends[0] < found["operating"] < ends[1]
    told = rf"(?m)^operating  +{found['operating']:.4g} N  "
    assert re.search(told, done.out)
    # So does Python, of the bearing as drawn and its limits.
    own: Any = read.installed.set_preload(read.speed)
    assert own.operating == pytest.approx(found["operating"], rel=1e-8)
    np.testing.assert_allclose(own.mounted_range, found["worst"]["mounted"], rtol=1e-8)
    # A sweep and a life of one design tell it as well, and warn of the same.
    cases = tmp_path / "cases.toml"
    one = (
        '[cases]\noutputs = ["n_loaded"]\ngrid = { "operating.load.Fz" = ["500 N"] }\n'
    )
    cases.write_text(f"{PAIR}{one}", encoding="utf-8")
    assert f"warning: {numbers['warnings'][-1]}" in done.out
    assert numbers["warnings"][-1].startswith("preload: ")
    for command in ("sweep", "life"):
        assert run(command, cases, "--json", out).status == 0
        swept = json.loads(out.read_text())
        assert swept["warnings"] == numbers["warnings"]
        (left_over,) = swept["columns"]["operating_preload [N]"]
        assert left_over == pytest.approx(found["operating"], rel=1e-8)
    # With a smaller angle the tightest fit leaves none: that end is not possible.
    shallow = ["bearing.contact_angle=14 deg", "fit.shaft=k5"]
    steep = bj.read_scene(scene, shallow)
    ends = steep.installed.set_preload().operating_range
    assert ends[0] > 0.0 and np.isnan(ends[1])
    # (Its first warning is of the loosest fit on the shaft.)
    # A shaft of 45 °C in a cold housing: O arrangement, its rows come loose axially,
    # while the inner rings grow into them.
    shorter = bj.read_scene(scene, ["set.spacing=16 mm"])
    assert left(shorter, shorter) > 1.05 * found["operating"]
    assert numbers["warnings"][1:] == preload_warnings(
        SetPreload(
            found["ground"],
            found["mounted"],
            found["operating"],
            tuple(found["worst"]["mounted"]),
            tuple(found["worst"]["operating"]),
        )
    )


@pytest.mark.slow
def test_sweep_reports_preload_of_each_case(scene):
    """Of cases of two designs at three loads, each as by hand."""
    warmth = '"temperature.inner_ring" = ["45 °C", "30 °C"]'
    loads = '"operating.load.Fz" = ["500 N", "0 N", "-200 N"]'
    with scene.open("a", encoding="utf-8") as file:
        file.write(f'[cases]\noutputs = ["n_loaded"]\ngrid = {{ {warmth}, {loads} }}\n')
    read = bj.read_scene(scene)
    cases = read_cases(scene)
    solved = run_cases(cases)
    table = columns(solved)
    wanted = [
        left(read, bj.read_scene(scene, [f"temperature.inner_ring={x} °C"]))
        for x in (45, 30)
    ]
    assert wanted[0] > 1.01 * wanted[1]
    np.testing.assert_allclose(
        table["operating_preload [N]"], np.repeat(wanted, 3), rtol=1e-8
    )
    (text,) = set_warnings(cases, solved)
    assert f"200 N as ground are {wanted[1]:.4g} N to {wanted[0]:.4g} N in op" in text
    report = str(sweep_report(cases, solved, 1.0))
    assert "\nnearest cases " in report
    assert f"warning: {text}" in report
    assert "operation: at `fit.at` alone, not over the tolerances" in report


def test_read_optimisation_preload_force_variable(scene):
    free = '"set.preload_force" = { from = "50 N", to = "0.5 kN" }\n'
    with scene.open("a", encoding="utf-8") as file:
        file.write(
            f'[optimise]\nobjective = "peak_pressure"\n[optimise.variables]\n{free}'
        )
    task = read_optimisation(scene)
    (force,) = task.variables
    assert (force.path, force.lower, force.upper) == (("preload",), 50.0, 500.0)
    found = eqx.tree_at(lambda d: d.preload, task.scene.installed, jnp.asarray(350.0))
    best = scene_of_design(task, found)
    assert best.preload_force == best.installed.preload == 350.0


def test_preload_and_range_warnings():
    def told(*numbers):
        return preload_warnings(SetPreload(*numbers))

    assert told(200.0, 250.0, 300.0, None, None) == []
    assert told(200.0, 250.0, 300.0, (50.0, 400.0), (40.0, 500.0)) == []
    assert (
        "200 N as ground are 500 N in operation, by"
        in told(200.0, 300.0, 500.0, None, None)[0]
    )
    (text,) = told(200.0, 150.0, 0.0, (100.0, 200.0), (0.0, 60.0))
    assert "none left in operation (0 N to 60 N over the tolerances)" in text
    (text,) = told(200.0, 250.0, 300.0, (50.0, 400.0), (0.0, 500.0))
    assert "at the loosest sizes" in text
    assert preload_range_warnings(200.0, 101.0, 399.0) == []
    (text,) = preload_range_warnings(200.0, 150.0, 401.0)
    assert "200 N as ground are 150 N to 401 N" in text
    assert "has none left" in preload_range_warnings(200.0, 0.0, 300.0)[0]
    # Pressed together by nothing, or not to be had.
    assert told(0.0, 0.0, 0.0, None, None) == []
    nan = float("nan")
    assert (
        "1000 N in operation (100 N to not possible over"
        in told(200.0, 250.0, 1000.0, (50.0, nan), (100.0, nan))[0]
    )
    ends = (50.0, nan), (40.0, nan)
    grid: Any
    (grid,) = preload_report(SetPreload(200.0, 250.0, 300.0, *ends))
    assert grid.rows()[-1] == ("operating", "300 N", "40 N to not possible")

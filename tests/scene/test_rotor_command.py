"""`bearingjax rotor`: exit status, files, and that they hold what the library says."""

import csv
import dataclasses
import json
import warnings

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import PUBLISHED, SOLVER

import bearingjax as bj
from bearingjax.rotor import harmonic_response
from bearingjax.rotor.nonlinear import BranchEnd
from bearingjax.scene import (
    SceneError,
    read_rotor,
    rotor_as_dict,
    rotor_report,
    rotor_run,
    rotor_series,
    run_rotor,
    shipped_scenes,
)

TURN = 2.0 * np.pi
RPM = np.pi / 30.0
BASE = 1e-3  # acceleration of the base [m/s²]: linear, within a millionth
FEW = {  # of the published rotor: little to solve, away from its resonance
    "rotor.modes": "5",
    "rotor.campbell.count": "3",
    "rotor.excitation.base_acceleration.y": f"{BASE} m/s^2",
    "rotor.response.from": "500 Hz",
    "rotor.response.to": "505 Hz",
    "rotor.response.harmonics": "1",
    "rotor.response.samples": "8",
    "rotor.response.steps": "12",
}
FEW_MODES = {key: FEW[key] for key in ("rotor.modes", "rotor.campbell.count")}
ON_SPRINGS = {  # as stiff as its bearings
    "bearings": "{}",
    "rotor.bearings.0": "{station=0, stiffness={radial='143.22 N/um',"
    " axial='12.941 N/um'}}",
    "rotor.bearings.1": "{station=2, stiffness={radial='143.22 N/um',"
    " axial='12.941 N/um'}}",
}
LINEAR = {
    "rotor.response": "{from='500 Hz', to='505 Hz', method='linear', points=4,"
    " speed='6000 rpm'}"
}
PARTS = {
    "frequency",
    "damping_ratio",
    "whirl",
    "critical_speed",
    "critical_whirl",
    "critical_damping_ratio",
    "static",
    "campbell",
    "response",
}
WORDS = {"result", "message", "warnings", "inputs", "version"}


def settings(*given):
    """The last of several settings of a key counts."""
    whole = {}
    for one in given:
        whole |= one
    return [f"{key}={value}" for key, value in whole.items()]


def command(*given, scene="rotor_paper_12"):
    words = (word for one in settings(*given) for word in ("--set", one))
    return ("rotor", scene, *words)


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.slow
def test_spherical_rollers_locate_a_rotor(run, tmp_path):
    """By their exact kinematics: at rest what the bearing alone bears there."""
    out, path = tmp_path / "a.json", tmp_path / "fan.toml"
    text = shipped_scenes()["rotor_flexible"].read_text("utf-8")
    text = text[: text.index("[rotor.campbell]")]
    before, after = text.index("[bearings.locating]"), text.index("[bearings.free]")
    own = '[bearings.locating]\ndesignation = "22208 E"\n\n'
    path.write_text(text[:before] + own + text[after:], encoding="utf-8")
    done = run("rotor", path, "--set", "rotor.modes=5", "--json", out)
    assert done.status == 0, done.err
    found = read(out)
    static, station = found["static"], 0
    element = bj.BearingElement(bj.catalogue_entry("22208 E").bearing)
    assert isinstance(element.kinematics, bj.element.Finite)
    q = np.zeros(12)
    q[6:11] = static["displacement"][station]
    alone = jax.jit(lambda q: element.model().evaluate(q))(q)
    force = np.asarray(alone.force)[6:11]
    load = np.array(static["load"])[station]
    assert np.abs(load[:3]).max() > 50.0
    assert np.abs(force[:3] - load[:3]).max() < 1e-6 * np.abs(load).max()
    stiffness = np.asarray(alone.stiffness)[6:9, 6:9]
    got = np.array(static["stiffness"])[station][:3, :3]
    assert np.abs(got - stiffness).max() < 1e-5 * np.abs(stiffness).max()
    # Nothing but round-off resists the slope of the shaft.
    assert np.abs(load[3:]).max() < 1e-6 * 0.03 * np.abs(load[:3]).max()


@pytest.mark.slow
def test_the_published_rotor_by_command(run, tmp_path):
    """Report, JSON and table of the rotor of method 002, against its table."""
    out, table, picture = (tmp_path / name for name in ("a.json", "a.csv", "a.png"))
    files = ("--json", out, "--table", table, "--plot", picture)
    done = run(*command(FEW), *files)
    assert done.status == 0, done.err
    assert done.err == ""
    found = read(out)
    assert set(found) == PARTS | WORDS
    assert (found["result"], found["warnings"]) == ("converged", [])
    # At rest: 234.5, 707.6, 1824.8 Hz.
    line = found["campbell"]
    assert np.allclose(line["speed"], [0.0, 30000.0 * RPM, 60000.0 * RPM])
    rest = [234.5, 707.6, 707.6, 1824.8, 1824.8]
    assert np.allclose(line["frequency"][0], rest, rtol=PUBLISHED)
    # Axial; backward 688 Hz, forward 721.4 Hz, backward 1262 Hz.
    critical = np.array(found["critical_speed"]) / TURN
    assert np.allclose(critical, [234.5, 688.0, 721.4, 1262.0], rtol=PUBLISHED)
    assert found["critical_whirl"] == [0, -1, 1, -1]
    static = found["static"]
    assert static["bearing"] == ["gost_831", "gost_831"]
    assert np.allclose(np.array(static["load"])[:, 2], [218.4, -218.4], rtol=SOLVER)
    assert np.allclose(static["displacement"], 0.0, atol=1e-15)
    k = np.diagonal(static["stiffness"], axis1=1, axis2=2)
    assert np.allclose(k[:, :3], [143.22e6, 143.22e6, 12.941e6], rtol=PUBLISHED)
    _same_as_the_library(found)
    response = found["response"]
    assert (response["method"], response["ending"]) == ("harmonic_balance", "limit")
    assert all(response["stable"]) and response["events"] == []
    assert response["coordinate"][:7] == [
        "ux_0", "uy_0", "uz_0", "gx_0", "gy_0", "ux_1", "uy_1",
    ]  # fmt: skip
    assert np.shape(response["multipliers"])[1:] == (10, 2)
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    column = rows[0].index("uy_2 [m]")
    assert rows[0][:2] == ["frequency [Hz]", "stable"]
    written = np.array([float(row[column]) for row in rows[1:]])
    amplitude = np.array(response["amplitude"])
    assert np.array_equal(written, amplitude[:, column - 2])
    assert picture.stat().st_size > 10_000
    assert "\ncritical speed " in done.out and "gost_831, turned" in done.out
    assert done.out.count("axial") == 3 and done.out.count("forward") > 3
    assert "response by harmonic balance" in done.out


def _same_as_the_library(found):
    """The rotor on springs of that stiffness, put together by hand."""
    k = np.array(found["static"]["stiffness"])
    rotor = bj.rotor.Rotor(
        bj.rotor.Shaft(
            [0.0, 0.125, 0.5], 0.025, material=bj.Material(210e9, 0.3, 7850.0)
        ),
        [bj.rotor.Disc(1, 10.0, 0.2, 0.1)],
        [bj.rotor.LinearSupport(0, k[0]), bj.rotor.LinearSupport(2, k[1])],
        damping=bj.rotor.ModalDamping(0.01),
        rigid=True,
    )
    speed = 6000.0 * RPM
    modes = bj.rotor.modes(rotor, speed, count=5)
    assert np.allclose(found["frequency"], modes.frequency, rtol=SOLVER)
    assert np.allclose(found["damping_ratio"], modes.damping_ratio, rtol=SOLVER)
    assert found["whirl"] == modes.whirl.tolist()
    response = found["response"]
    frequency = TURN * jnp.asarray(response["frequency"])
    loads = bj.rotor.RotorLoads(base_acceleration=(0.0, BASE, 0.0))
    linear = harmonic_response(rotor, loads, frequency, speed)
    amplitude = np.reshape(response["amplitude"], (len(frequency), 3, 5))
    assert np.allclose(
        amplitude[:, :, :2], linear.amplitude[:, :, :2], rtol=PUBLISHED, atol=1e-13
    )


@pytest.mark.parametrize(
    "response",
    (
        "from='500 Hz', to='505 Hz', harmonics=3, samples=8",
        "from='640 Hz', to='740 Hz', method='shooting', steps=8, points=200",
    ),
)
@pytest.mark.slow
def test_run_rotor_fast_modes_match_linear_response(response):
    """Modes of up to 80 times the excitation, peaks between the samples, and
    resonances of some hundred times the preload of a bearing."""
    unbalance = "[{station=1, moment='1 kg mm', phase='20 deg'}]"
    shaft = {
        **FEW_MODES,
        **ON_SPRINGS,
        "rotor.rigid": "false",
        "rotor.excitation": f"{{unbalance={unbalance}}}",
        "rotor.response": f"{{{response}}}",
    }
    task = read_rotor("rotor_paper_12", settings(shaft))
    done = run_rotor(task)
    assert done.converged and not done.warnings, done.failures
    found = done.response
    linear = harmonic_response(done.settled.rotor, task.loads, found.frequency)
    nodes = [task.shaft.node(k) for k in range(3)]
    apart = np.abs(found.amplitude - np.abs(np.asarray(linear.motion)[:, nodes]))
    assert apart.max() < 1e-6 * found.amplitude.max()


@pytest.mark.slow
def test_run_rotor_warns_of_coarse_reduction():
    task = read_rotor(
        "rotor_paper_12",
        settings(
            FEW, ON_SPRINGS, {"rotor.rigid": "false", "rotor.response.reduction": "0"}
        ),
    )
    (told,) = run_rotor(task).warnings
    assert (
        "`rotor.response.reduction` = 0 changes the linear response at 500 Hz" in told
    )


@pytest.mark.slow
def test_rotor_command_without_campbell_and_response(run, rerun, tmp_path):
    out = tmp_path / "a.json"
    text = _without("campbell", "response")
    path = tmp_path / "plain.toml"
    path.write_text(text, encoding="utf-8")
    done = run(*command(ON_SPRINGS, scene=str(path)), "--json", out)
    assert done.status == 0
    assert set(read(out)) == (PARTS | WORDS) - {"campbell", "response"}
    assert "Campbell" not in done.out and "response" not in done.out
    rerun("rotor", out)
    for more, words in (
        (["--table", tmp_path / "a.csv"], "no [rotor.response] nor [rotor.transient]"),
        (["--series", "response"], "name it with --table"),
    ):
        done = run(*command(ON_SPRINGS, scene=str(path)), *more)
        assert done.status == 2 and words in done.err


IN_TIME = {"rotor.transient": "{duration='1 ms', n_times=3}"}


@pytest.mark.slow
def test_rotor_command_table_series(run, tmp_path):
    table = tmp_path / "a.csv"
    given = command(FEW, ON_SPRINGS, LINEAR, IN_TIME)
    done = run(*given, "--table", table)
    assert done.status == 2 and "say which" in done.err and not table.exists()
    done = run(*given, "--table", table, "--series", "transient")
    assert done.status == 0, done.err
    lines = table.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith('"time [s]"') and len(lines) == 4
    task = read_rotor("rotor_paper_12", settings(FEW, ON_SPRINGS, LINEAR, IN_TIME))
    assert rotor_series(task, "response") == "response"
    only = dataclasses.replace(task, response=None)
    assert rotor_series(only, None) == "transient"
    with pytest.raises(SceneError, match=r"has no \[rotor.response\]; a table"):
        rotor_series(only, "response")


def test_rotor_top_speed_covers_requested_speeds():
    """Beyond the last speed a bearing's stiffness would silently stay what it is."""
    for more, top in (
        ({}, 16000.0),
        ({"rotor.speed": "-9000 rpm"}, 18000.0),
        ({"rotor.campbell.from": "-20000 rpm"}, 20000.0),
        ({"rotor.response.speed": "30000 rpm"}, 30000.0),
    ):
        task = read_rotor("rotor_spindle", settings(more))
        assert np.isclose(rotor_run.top_speed(task), top * RPM)


def test_a_motion_in_time_settles_into_the_linear_response(run, tmp_path):
    out, table = tmp_path / "a.json", tmp_path / "a.csv"
    path = tmp_path / "plain.toml"
    path.write_text(_without("campbell", "response"), encoding="utf-8")
    # 20 turns of 2 ms, 20 times in each; 1 e-folding takes 1.1 turns.
    turning = {
        "rotor.speed": "30000 rpm",
        "rotor.damping_ratio": "0.1",
        "rotor.excitation": "{unbalance=[{station=1, moment='9 g mm'}]}",
        "rotor.transient": "{duration='40 ms', n_times=401}",
    }
    given = command(ON_SPRINGS, turning, scene=str(path))
    done = run(*given, "--json", out, "--table", table)
    assert done.status == 0, done.err
    assert "motion in time to 0.04 s" in done.out
    found = read(out)["transient"]
    assert np.allclose(found["speed"], 30000.0 * RPM)
    time = np.array(found["time"])
    assert (len(time), time[-1]) == (401, pytest.approx(0.04))
    moved = np.array(found["displacement"])
    assert np.abs(moved[0]).max() < 1e-15
    y = found["coordinate"].index("uy_2")
    turns = np.exp(-1j * 30000.0 * RPM * time[-200:])
    amplitude = 2.0 * np.mean(moved[-200:, y] * turns)
    task = read_rotor(path, settings(ON_SPRINGS, turning))
    linear = harmonic_response(run_rotor(task).settled.rotor, task.loads, [task.speed])
    assert abs(amplitude / linear.motion[0, 2, 1] - 1.0) < 1e-4  # of the tolerance
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0][:3] == ["time [s]", "speed [rad/s]", "ux_0 [m]"]
    assert np.array_equal([float(row[2 + y]) for row in rows[1:]], moved[:, y])


def _without(*names):
    text = shipped_scenes()["rotor_paper_12"].read_text(encoding="utf-8")
    for name in names:
        before, _, after = text.partition(f"[rotor.{name}]")
        text = before + ("[" + after.partition("\n[")[2] if "\n[" in after else "")
    return text


def test_run_rotor_linear_response_and_warnings(monkeypatch):
    def idle(*given):
        warnings.warn(
            "static_equilibrium: the bearing on station 0 bears nothing", stacklevel=2
        )
        return bj.rotor.static_equilibrium(*given)

    monkeypatch.setattr(rotor_run, "static_equilibrium", idle)
    task = read_rotor(
        "rotor_paper_12",
        settings(FEW, ON_SPRINGS, LINEAR, {"rotor.speed": "43000 rpm"}),
    )
    told = []
    found = run_rotor(task, told.append)
    assert found.converged and found.response is not None
    assert told[0] == "bearings" and told[-1] == "response"
    assert found.response.branch is None
    assert np.allclose(found.response.frequency[[0, -1]] / TURN, [500.0, 505.0])
    # Half of peak to peak, of a circle of phases.
    moved = found.response.displacement
    half = 0.5 * (moved.max(axis=1) - moved.min(axis=1))
    largest = found.response.amplitude[:, 2, 1]
    assert np.allclose(half[:, 2, 1], largest, rtol=0.01)
    text = str(rotor_report(found))
    assert "warning: static_equilibrium: the bearing on station 0 bears nothing" in text
    assert "43000 rpm lies within 10 % of the forward critical speed of 432" in text
    assert all(words in text for words in rotor_as_dict(found)["warnings"])
    assert len(rotor_as_dict(found)["warnings"]) == 2


@pytest.mark.parametrize("part", ["static", "response"])
@pytest.mark.slow
def test_rotor_command_unsolved_part(run, tmp_path, part):
    out, table = tmp_path / "a.json", tmp_path / "a.csv"
    if part == "static":
        # Nothing holds it across the shaft, and its weight pulls.
        loose = {
            "rotor.bearings.0.stiffness": "{axial='1 N/um'}",
            "rotor.axis": "horizontal",
        }
        given = (FEW, ON_SPRINGS, loose, LINEAR)
    else:
        given = (FEW, {"rotor.response.points": "2"})
    done = run(*command(*given), "--json", out, "--table", table)
    assert done.status == 3
    found = read(out)
    if part == "static":
        assert found["result"] == "no_load_path"
        assert "no_load_path: static: static_equilibrium: " in done.err
        assert done.out == "" and set(found) == WORDS and not table.exists()
    else:
        assert found["result"] == "step_limit"
        assert "step_limit: response: at 50" in done.err
        assert "raise `rotor.response.points`" in done.err
        assert found["response"]["ending"] == BranchEnd.POINTS.label
        assert len(found["response"]["frequency"]) == 2
        assert "the branch ends: points" in done.out


def test_a_wrong_scene_is_exit_status_two(run):
    done = run(*command({"rotor.speed": "fast"}))
    assert done.status == 2 and done.out == ""
    assert done.err.startswith("bearingjax: rotor_paper_12.toml: `rotor.speed`: 'fast'")

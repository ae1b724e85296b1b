"""Scenes of rotors, and what `bearingjax rotor` makes of them."""

import csv
import dataclasses
import json
from functools import partial
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import inputs, theirs
from runs import Runs, Study
from tolerances import PUBLISHED, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.files import SceneError, shipped_scenes
from bearingjax.files.output_files import scene_files
from bearingjax.numerics.warning import Warning
from bearingjax.rotor import harmonic_response
from bearingjax.rotor.nonlinear import BranchEnd
from bearingjax.studies.rotor import run as rotor_run
from bearingjax.studies.rotor.output import rotor_as_dict, rotor_series
from bearingjax.studies.rotor.read import read_rotor
from bearingjax.studies.rotor.report import _bearings, rotor_report
from bearingjax.studies.rotor.run import run_rotor
from bearingjax.studies.rotor.supports import with_passage

RPM = np.pi / 30.0
TURN = 2.0 * np.pi
SHIPPED = (
    "rotor_flexible",
    "rotor_paper_12",
    "rotor_paper_26",
    "rotor_paper_36",
    "rotor_spindle",
)


def test_other_commands_name_the_one_for_rotors():
    with pytest.raises(SceneError, match="`bearingjax rotor rotor_paper_12` solves it"):
        bj.read_scene("rotor_paper_12")
    with pytest.raises(SceneError, match="`bearing`: the scene of a rotor has"):
        read_rotor("deep_groove")


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_rotors_read(name):
    task = read_rotor(name)
    assert task.name == name and task.warnings == ()
    assert task.campbell is not None and task.response is not None
    assert len(task.mounts) == 2


def test_read_rotor_paper_rotor_matches_table():
    task = read_rotor("rotor_paper_26")
    assert np.allclose(task.shaft.stations, [0.0, 0.125, 0.5], rtol=ROUNDING)
    assert task.keys.rigid and task.keys.axis == "none"
    assert task.station_names == ("0 gost_831", "1 disc", "2 gost_831")
    (disc,) = task.discs
    assert isinstance(disc, bj.rotor.Disc)
    own = [float(disc.mass), float(disc.polar_inertia), float(disc.diametral_inertia)]
    assert own == [10.0, 0.2, 0.1]
    a, b = task.mounts
    first, second = a.keys, b.keys
    assert (a.station, b.station) == (0, 2)
    assert (first.turned, second.turned) == (False, True)
    pressed = inputs("filipkovskii_preload", "operating.load.Fz")[2]
    assert first.preload == second.preload == pressed and first.law == "fixed_angle"
    bearing = a.element.bearing
    assert float(bearing.pitch_diameter) == pytest.approx(16e-3 + 27.5399e-3)
    free = inputs("filipkovskii_preload", "bearing.contact_angle")[2]
    assert float(bearing.free_contact_angle) == pytest.approx(free, abs=1e-6)
    assert np.allclose(task.loads.base_acceleration, [0, 3, 0])
    assert isinstance(task.keys.own_damping, bj.rotor.ModalDamping)
    assert task.speed == pytest.approx(6000.0 * RPM)
    assert task.campbell[-1] == pytest.approx(60000.0 * RPM)
    asked = task.response
    assert (asked.begin, asked.end) == pytest.approx((710.0 * TURN, 590.0 * TURN))
    assert asked.speed == pytest.approx(6000.0 * RPM)
    assert (asked.method, asked.harmonics, asked.samples) == ("harmonic_balance", 5, 64)
    assert (asked.station, asked.coordinate) == (2, "uy")


def test_all_keys_of_a_mount_a_disc_and_loads():
    task = read_rotor(
        "rotor_flexible",
        [
            "rotor.axis=vertical",
            "rotor.discs.0={station=2, mass='3 kg'}",
            "rotor.bearings.0={station=1, bearing='locating', offset='4 um',"
            " turned=true, inertia=true, damping={x='1 N s/m', y='2 N s/m',"
            " axial='3 N s/m', tilt='4 N m s/rad'}, housing={mass='2 kg',"
            " stiffness={x='1 N/um', y='2 N/um', z='3 N/um'}, damping='5 N s/m'}}",
            "rotor.bearings.1.bearing=needle",
            "bearings={locating={type='deep_groove_ball', n_balls=7,"
            " pitch_diameter='43.5 mm', ball_diameter='11.5 mm', outer_osculation=0.53,"
            " inner_osculation=0.52, raceway_control='inner',"
            " contact={point_law='zero_angle'}}}",
            "rotor.excitation={"
            "unbalance=[{station=0, moment='5 g mm', phase='90 deg'}],"
            " forces=[{station=3, Fx='2 N', My='3 N m'}]}",
            "rotor.damping_ratio=0",
            "rotor.transient={duration='2 s', speed_to='6000 rpm', passage=true}",
        ],
    )
    assert np.allclose(task.loads.gravity, [0.0, 0.0, -9.80665])
    assert isinstance(task.discs[0], bj.rotor.PointMass) and task.discs[0].station == 2
    one, other = task.mounts
    keys = one.keys
    assert (one.station, keys.offset, keys.turned, keys.inertia) == (
        1,
        4e-6,
        True,
        True,
    )
    assert keys.damping.diagonal == (1.0, 2.0, 3.0, 4.0, 4.0)
    assert isinstance(one.element.raceway_control, bj.element.InnerControl)
    assert isinstance(one.element.point_law, bj.contact.ZeroAngle)
    housing = keys.housing.housing
    assert np.allclose(np.diag(housing.stiffness), [1e6, 2e6, 3e6])
    assert np.allclose(np.diag(housing.damping), 5.0)
    needle = bj.read_scene("needle")
    assert other.name == "needle"
    assert type(other.element.bearing) is type(needle.element.bearing)
    (unbalance,), (force,) = task.loads.unbalances, task.loads.forces
    assert float(unbalance.moment) == pytest.approx(5e-6)
    assert float(unbalance.phase) == pytest.approx(np.pi / 2)
    assert force.station == 3 and np.allclose(force.force, [2, 0, 0, 0, 3])
    assert task.keys.own_damping is None
    asked = task.transient
    assert (asked.duration, asked.passage, asked.n_times) == (2.0, True, 1001)
    assert asked.speed_to == pytest.approx(6000.0 * RPM)


def test_frequencies_count_vibrations_or_turns():
    given = {"100 Hz": 100.0 * TURN, "6000 rpm": 200.0 * np.pi, "9 rad/s": 9.0}
    for text, value in given.items():
        task = read_rotor("rotor_flexible", [f"rotor.response.to={text}"])
        assert task.response.end == pytest.approx(value)


def test_read_rotor_warns_of_response_at_other_speed():
    task = read_rotor("rotor_flexible", ["rotor.response.speed=3000 rpm"])
    (warning,) = task.warnings
    assert "unbalance turns at another speed" in warning


@pytest.mark.parametrize(
    "settings, words",
    (
        (["rotor.speed=-60 rpm"], "`rotor.speed` is negative, but in the response"),
        (
            ["bearings.locating={designation='6207'}"],
            "locating: 6207 has a bore of 35 mm; at station 0 the shaft has 40 mm",
        ),
        (
            [
                "rotor.discs.0={station=1, mass='6 kg', polar_inertia='0.03 kg m^2',"
                " diametral_inertia='0.01 kg m^2'}"
            ],
            "`polar_inertia` (0.03 kg m²) is above twice `diametral_inertia`",
        ),
    ),
)
def test_read_rotor_warns_of_inconsistent_keys(settings, words):
    (warning,) = read_rotor("rotor_flexible", settings).warnings
    assert words in warning


def test_read_rotor_warns_of_clearance_beside_class():
    task = read_rotor("rotor_flexible", ["bearings.locating.designation=6208/C3"])
    (warning,) = task.warnings
    assert warning.startswith("locating: bearing: `radial_internal_clearance` (6 um)")


def test_rolling_elements_pass_where_there_are_some():
    element = bj.BearingElement(bj.load_bearing("deep_groove"))
    rotor = bj.rotor.Rotor(
        bj.rotor.Shaft([0.0, 1.0], 0.05),
        (),
        [
            bj.rotor.BearingSupport(0, element, turned=True),
            bj.rotor.LinearSupport(1, [1.0] * 5),
        ],
    )
    passing = dataclasses.replace(
        rotor, supports=tuple(map(with_passage, rotor.supports))
    )
    one, other = passing.supports
    assert isinstance(one, bj.rotor.BearingSupport) and one.passage and bool(one.turned)
    assert other is rotor.supports[1]


def test_a_bearing_from_another_file(tmp_path):
    other = tmp_path / "mine.toml"
    text = shipped_scenes()["deep_groove"].read_text(encoding="utf-8")
    other.write_text(text, encoding="utf-8")
    path = tmp_path / "rotor.toml"
    springs = "{ radial = '20 N/um', axial = '5 N/um', tilt = '1 kN m/rad' }"
    path.write_text(
        f"""
[rotor]
[[rotor.shaft]]
length = "300 mm"
outer_diameter = "25 mm"
[[rotor.bearings]]
station = 0
bearing = "mine.toml"
[[rotor.bearings]]
station = 1
stiffness = {springs}
"""
    )
    task = read_rotor(path)
    assert task.mounts[0].element.bearing.n_balls == 7
    assert task.mounts[1].keys.stiffness.diagonal == (20e6, 20e6, 5e6, 1e3, 1e3)
    assert task.station_names == ("0 mine", "1 springs")
    # What would be overwritten is known.
    assert scene_files(path) == [path, other]


def test_round_off_of_a_bearing_without_ribs_is_no_axial_stiffness(untyped):
    k = np.diag([4e8, 3e8, -5.7e-6, 2e3, 2e3])
    k[2, 3] = 1e-5
    mount = SimpleNamespace(
        station="left", name="nu206", keys=SimpleNamespace(turned=False)
    )
    run = SimpleNamespace(
        settled=SimpleNamespace(support_load=np.zeros((1, 5)), stiffness=k[None]),
        task=SimpleNamespace(mounts=[mount]),
    )
    assert _bearings(run).rows()[0][-3:] == ("400", "300", "0")


@pytest.mark.slow
def test_lives_of_the_bearings():
    """With [life] each bearing has the life under its load in the equilibrium."""
    settings = ["life.contamination=0.5", "lubricant.name=ISO VG 68"]
    task = read_rotor("rotor_flexible", [*settings, "lubricant.temperature=60 °C"])
    assert task.mounts[0].scene.life.contamination == 0.5
    parts = rotor_run._Parts(None)
    rotor = rotor_run._rotor(task, parts)
    rotor_run._static(task, rotor, parts)
    rotor_run._lives(task, rotor, parts)
    (ball, life), (roller, _) = parts.found["lives"]
    assert [ball.name, roller.name] == ["locating", "free"]
    load = np.append(parts.found["settled"].support_load[0], 0.0)
    element: Any = getattr(rotor.supports[0], "element")  # noqa: B009
    alone = bj.solve_load(element, load)
    scene = task.mounts[0].scene
    viscosity = scene.oil.lubricant.kinematic_viscosity(jnp.asarray(333.15))
    wanted = bj.rating_life(
        element,
        alone,
        conditions=bj.LifeConditions(viscosity=viscosity, contamination=0.5),
        speed=bj.Speed(jnp.asarray(task.speed)),
    )
    hours: Any = wanted.life_hours
    np.testing.assert_allclose(life.life_hours, hours, rtol=1e-6)
    echo = task.inputs
    assert echo["life"]["contamination"] == 0.5 and "lubricant" in echo


# Of the command.

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


def _without(*names):
    text = shipped_scenes()["rotor_paper_12"].read_text(encoding="utf-8")
    for name in names:
        before, _, after = text.partition(f"[rotor.{name}]")
        text = before + ("[" + after.partition("\n[")[2] if "\n[" in after else "")
    return text


def settings(*given):
    """The last of several settings of a key counts."""
    whole = {}
    for one in given:
        whole |= one
    return [f"{key}={value}" for key, value in whole.items()]


def command(*given, scene="rotor_paper_12"):
    words = (word for one in settings(*given) for word in ("--set", one))
    return ("rotor", scene, *words)


# Nothing holds it across the shaft, and its weight pulls.
LOOSE = {
    "rotor.bearings.0.stiffness": "{axial='1 N/um'}",
    "rotor.axis": "horizontal",
}
STUDIES = {
    "published": Study(
        command(FEW),
        again=None,
        unsolved={
            "loose": (
                command(FEW, ON_SPRINGS, LOOSE, LINEAR)[2:],
                "no_load_path",
                "no_load_path: static: static_equilibrium: ",
            ),
        },
        slow=(True, True),
    ),
    "without campbell and response": Study(
        command(ON_SPRINGS, scene=_without("campbell", "response")),
        files={"--json": "a.json", "--plot": "a.png"},
    ),
}


class TestRuns(Runs):
    """Runs of the command."""


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
    element = bj.BearingElement(bj.load_bearing("22208 E"))
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
def test_the_published_rotor_by_command(written):
    """Report, JSON and table of the rotor of method 002, against its table."""
    done, found, _ = written("published")
    assert found["warnings"] == []
    line = found["campbell"]
    assert np.allclose(line["speed"], [0.0, 30000.0 * RPM, 60000.0 * RPM])
    of_rotor, of_bearing = (
        partial(theirs, f"filipkovskii_{of}") for of in ("rotor", "bearing")
    )
    rest = of_rotor("natural frequencies at rest [Hz]")[0]
    assert np.allclose(line["frequency"][0], rest, rtol=PUBLISHED)
    critical = of_rotor("critical speeds: axial, backward, forward")[0]
    assert np.allclose(found["critical_speed"], critical, rtol=PUBLISHED)
    assert found["critical_whirl"] == [0, -1, 1, -1]
    static = found["static"]
    assert static["bearing"] == ["gost_831", "gost_831"]
    preload = of_bearing("preload")[0] * np.array([1.0, -1.0])
    assert np.allclose(np.array(static["load"])[:, 2], preload, rtol=SOLVER)
    assert np.allclose(static["displacement"], 0.0, atol=1e-15)
    k = np.diagonal(static["stiffness"], axis1=1, axis2=2)
    wanted = [of_bearing(f"{way} stiffness")[0] for way in ("radial", "axial")]
    assert np.allclose(k[:, 1:3], wanted, rtol=PUBLISHED)
    assert np.allclose(k[:, 0], k[:, 1], rtol=SOLVER)
    _same_as_the_library(found)
    response = found["response"]
    assert (response["method"], response["ending"]) == ("harmonic_balance", "limit")
    assert all(response["stable"]) and response["events"] == []
    assert response["coordinate"][:7] == [
        "ux_0", "uy_0", "uz_0", "gx_0", "gy_0", "ux_1", "uy_1",
    ]  # fmt: skip
    assert np.shape(response["multipliers"])[1:] == (10, 2)
    rows = written("published").rows
    column = rows[0].index("uy_2 [m]")
    assert rows[0][:2] == ["frequency [Hz]", "stable"]
    written = np.array([float(row[column]) for row in rows[1:]])
    amplitude = np.array(response["amplitude"])
    assert np.array_equal(written, amplitude[:, column - 2])
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
        "`rotor.response.reduction`: a reduction to 0 modes changes the linear response"
        " at 500 Hz" in told
    )


@pytest.mark.slow
def test_rotor_command_without_campbell_and_response(run, written, tmp_path):
    done, _, paths = written("without campbell and response")
    told = done.out.partition("\nmodel ")[0]
    assert told and "Campbell" not in told and "response" not in told
    path = paths["--json"].with_name("mine.toml")
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
    done = run(*given, "--json", out, "--table", table, "--si")
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


def test_run_rotor_linear_response_and_warnings(monkeypatch):
    words = "static_equilibrium: the bearing on station 0 bears nothing"
    told = (Warning("idle_bearing", words, where="station 0"),)
    monkeypatch.setattr(bj.rotor.StaticEquilibrium, "warnings", told)
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
    labelled = found.to_xarray()
    amplitude = labelled["amplitude"].sel(station_freedom="uy").isel(node=2)
    assert np.array_equal(amplitude, largest)
    assert labelled["speed"] == found.settled.speed
    assert np.allclose(half[:, 2, 1], largest, rtol=0.01)
    text = str(rotor_report(found))
    assert "warning: static_equilibrium: the bearing on station 0 bears nothing" in text
    assert "43000 rpm lies within 10 % of the forward critical speed of 432" in text
    assert all(words in text for words in rotor_as_dict(found)["warnings"])
    assert len(rotor_as_dict(found)["warnings"]) == 2


@pytest.mark.slow
def test_rotor_command_unfinished_branch(run, tmp_path):
    out, table = tmp_path / "a.json", tmp_path / "a.csv"
    given = command(FEW, {"rotor.response.points": "2"})
    done = run(*given, "--json", out, "--table", table)
    assert done.status == 3
    found = read(out)
    assert found["result"] == "step_limit"
    assert "step_limit: response: at 50" in done.err
    assert "raise `rotor.response.points`" in done.err
    assert found["response"]["ending"] == BranchEnd.POINTS.label
    assert len(found["response"]["frequency"]) == 2
    assert "the branch ends at the largest number of points" in done.out


def test_a_wrong_scene_is_exit_status_two(run):
    done = run(*command({"rotor.speed": "fast"}))
    assert done.status == 2 and done.out == ""
    assert done.err.startswith("bearingjax: rotor_paper_12.toml: `rotor.speed`: 'fast'")

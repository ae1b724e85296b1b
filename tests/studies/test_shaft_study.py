"""Scenes of shaft systems, and what `bearingjax shaft` makes of them."""

import dataclasses
import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Rectangle
from runs import SEARCH, WORDS, Runs, Study

import bearingjax as bj
from bearingjax.files import SceneError
from bearingjax.life import Life, judge_life
from bearingjax.numerics.result import Result
from bearingjax.plot.shafts import _draw_nodes, _draw_warm_up, system_views
from bearingjax.report.report_model import Grid
from bearingjax.shafts import DutyResult, ThermalState, power_flow
from bearingjax.studies.shaft.output import shaft_columns
from bearingjax.studies.shaft.read import read_shafts
from bearingjax.studies.shaft.report import _temperatures
from bearingjax.studies.shaft.run import ShaftRun, _with_temperatures, run_shafts

GEARS = Path(__file__).with_name("refused") / "gears.toml"
SCENE = GEARS.read_text(encoding="utf-8")


CASES = """
[[cases.spectrum]]
drive.power = "12 kW"
hours = "100 h"

[[cases.spectrum]]
drive.power = "-20 kW"
hours = "10 h"

[[cases.spectrum]]
drive.power = "1 kW"
hours = "0 h"
"""
STUDIES = {
    "gears": Study(
        ("shaft", SCENE),
        WORDS | SEARCH,
        unsolved={
            "loose": (
                ("--set", "bearings.C.floating=true"),
                "no_load_path",
                "solve_system: no_load_path: nothing takes up the load along uz of"
                " shaft out",
            )
        },
        slow=(True, True),
    ),
    "cases": Study(("shaft", SCENE + CASES), WORDS | SEARCH, again=None),
}


class TestRuns(Runs):
    """Runs of the command."""


def of_seats(numbers, name):
    """One number of each bearing."""
    return np.array([one[name] for one in numbers["bearings"].values()])


@pytest.mark.slow
def test_gears(written):
    done, found, _ = written("gears")
    assert "2 shafts on 4 bearings" in done.out and "12 kW" in done.out
    assert found["message"] == ""
    assert [*found["bearings"]] == ["A", "B", "C", "D"]
    gears = found["gear"]
    np.testing.assert_allclose(
        gears["wheel"]["force"], -np.array(gears["pinion"]["force"]), rtol=1e-9
    )
    hours = of_seats(found, "life_hours")
    assert found["system_life_hours"] < hours.min()
    # By the survival of all, of balls alone: (Σ L^-e)^(-1/e).
    e = 10.0 / 9.0
    wanted = (hours**-e).sum() ** (-1.0 / e)
    np.testing.assert_allclose(found["system_life_hours"], wanted, rtol=1e-12)
    c, d = of_seats(found, "load")[2:, :3]
    force = np.array(gears["wheel"]["force"]) + [0, -500, 0]
    np.testing.assert_allclose(c + d, force, rtol=1e-9, atol=1e-6)
    assert abs(d[2]) < 1e-6 < abs(c[2])
    assert [row[0] for row in written("gears").rows] == ["bearing", *"ABCD"]
    np.testing.assert_allclose(written("gears").column("Fx [N]")[2], c[0], rtol=1e-9)


@pytest.mark.slow
def test_lives_are_those_of_the_bearings_alone():
    """Each bearing under its load alone, with its tilt held, has the same life."""
    for bearing in run_shafts(read_shafts(GEARS)).bearings:
        solution = bearing.solution
        held: Any = dict(
            zip("ux uy uz gx gy".split(), solution.displacement[6:11], strict=True)
        )
        again = bj.solve_load(
            solution.element,
            support=bj.Support(prescribed=held, free=[]),
            speed=solution.speed,
        )
        entry = bearing.scene.catalogue.entry
        life = bj.rating_life(
            solution.element,
            again,
            conditions=bj.LifeConditions(dynamic_capacity=entry.dynamic_capacity),
        )
        np.testing.assert_allclose(
            bearing.life.reference_rating_life, life.reference_rating_life, rtol=1e-7
        )


@pytest.mark.slow
def test_cases(written):
    """Load cases side by side are those of one after the other; the spectrum adds up
    their damage."""
    done, found, _ = written("cases")
    alone = written("gears").numbers
    loads = of_seats(found["cases"], "load")
    np.testing.assert_allclose(loads[:, 0], of_seats(alone, "load"), atol=1e-6)
    name = "reference_rating_life"
    lives = of_seats(found["cases"], name)[:, 0]
    np.testing.assert_allclose(lives, of_seats(alone, name), rtol=1e-7)
    back = run_shafts(read_shafts(GEARS, ["drive.power=-20 kW"]))
    np.testing.assert_allclose(loads[:, 1], back.solution.load, atol=1e-6)
    damage = np.array([1 / of_seats(alone, "life_hours"), 1 / back.hours])
    wanted = 1.0 / (np.array([100.0, 10.0]) / 110.0 @ damage)
    np.testing.assert_allclose(of_seats(found, "life_hours"), wanted, rtol=1e-6)
    assert "under all 3 cases" in done.out
    # What is odd in one case is told, with the case, as a sweep tells it.
    light = [text for text in found["warnings"] if "may skid" in text]
    assert len(light) == 4
    assert all(re.search(r"in \d of 3 cases, worst case \d", text) for text in light)
    assert found["cases"]["hours"] == [100.0, 10.0, 0.0]
    head, *rows = written("cases").rows
    assert len(rows) == 12 and rows[4][head.index("drive.power")] == "-20 kW"


@pytest.mark.slow
def test_cases_over_positions(tmp_path):
    """Positions may vary as long as the order of the parts stays."""
    scene = tmp_path / "p.toml"
    values = '["30 mm", "55 mm"]'
    scene.write_text(
        f"{SCENE}[cases.grid]\n" + f'"bearings.A.position" = {values}\n', "utf-8"
    )
    found = run_shafts(read_shafts(scene))
    assert found.converged and found.duty is not None
    alone = run_shafts(
        read_shafts(scene, ["cases.grid={'bearings.A.position'=['55 mm']}"])
    )
    np.testing.assert_allclose(found.duty.load[1], alone.solution.load, atol=1e-4)
    with pytest.raises(SceneError, match="in case 1 parts stand in another order"):
        beyond = "cases.grid={'bearings.A.position'=['30 mm', '150 mm']}"
        run_shafts(read_shafts(scene, [beyond]))


WARM = """
[drive]
speed = "6000 rpm"

[shaft.s]
segments = [{ length = "260 mm", outer_diameter = "40 mm" }]

[load.pull]
shaft = "s"
position = "150 mm"
Fy = "-900 N"
Fz = "300 N"

[bearings.A]
shaft = "s"
position = "40 mm"
designation = "7208 B"
preload = "400 N"
fit = { shaft_interference = "8 um", housing_interference = "-5 um", housing_diameter = "120 mm" }

[bearings.B]
shaft = "s"
position = "240 mm"
designation = "7208 B"
turned = true
preload = "400 N"

[lubricant]
name = "ISO VG 32"
temperature = "40 °C"

[life]
contamination = "oil bath -/17/14"

[heat]
ambient = "22 °C"
"""  # noqa: E501


@pytest.mark.slow
def test_cases_with_heat(tmp_path):
    """Each case has its own temperatures, and its life the viscosity there; one that
    runs away has no numbers."""
    scene, name = tmp_path / "warm.toml", "bearings.A.heat.outer"
    scene.write_text(f'{WARM}[cases]\nfile = "cases.csv"\n', "utf-8")
    rows = (
        f"drive.speed,heat.ambient,{name},bearings.A.heat.inner,hours [h]",
        "3000 rpm,22 °C,2 W/K,2 W/K,10",
        "4000 rpm,30 °C,4 W/K,2 W/K,20",
        "6000 rpm,22 °C,1e-3 W/K,1e-3 W/K,20",
    )
    scene.with_name("cases.csv").write_text("\n".join(rows), "utf-8")
    found = run_shafts(read_shafts(scene))
    assert found.duty is not None and found.rings is not None
    assert re.match(r"1 of 3 cases not solved \(case 2: .* no thermal", found.problem)
    assert np.isnan(found.rings[2]).all() and np.isnan(found.duty.load[2]).all()
    alone = tmp_path / "alone.toml"
    alone.write_text(WARM, "utf-8")
    inner = "bearings.A.heat.inner=2 W/K"
    for k, settings in enumerate(
        (
            ["drive.speed=3000 rpm", f"{name}=2 W/K"],
            ["drive.speed=4000 rpm", "heat.ambient=30 °C", f"{name}=4 W/K"],
        )
    ):
        own = run_shafts(read_shafts(alone, [*settings, inner]))
        assert own.thermal is not None
        rings = np.stack([own.thermal.inner_ring, own.thermal.outer_ring], axis=1)
        np.testing.assert_allclose(found.rings[k], rings, rtol=1e-10)
        load = own.solution.load
        np.testing.assert_allclose(found.duty.load[k], load, rtol=1e-6, atol=1e-5)
        lives = np.array([b.life.modified_rating_life for b in own.bearings], float)
        given = found.duty.lives["modified_rating_life"][k]
        np.testing.assert_allclose(given, lives, rtol=1e-6)
    columns = shaft_columns(found)
    np.testing.assert_array_equal(
        columns["inner_ring [K]"], found.rings[..., 0].ravel()
    )


def solved(scene, **more):
    """A run of a scene with numbers made up."""
    known: dict[str, Any] = dict.fromkeys(("thermal", "warming", "duty", "rings"))
    known |= {"task": scene, "solution": SimpleNamespace(result=0), "problem": ""}
    run = object.__new__(ShaftRun)
    for name, value in (known | more).items():
        object.__setattr__(run, name, value)
    return run


def test_worst_case_of_a_spectrum(tmp_path):
    """By the damage of its hours: not a case of no time, nor one at rest."""
    (tmp_path / "x.toml").write_text(SCENE + CASES, "utf-8")
    scene = read_shafts(tmp_path / "x.toml")
    damage = np.array([[1.0, 1.0, 1.0, 0.0], [5.0, 20.0, 1.0, 0.0], [99.0] * 4])
    speed = np.array([[10.0, 1.0], [10.0, 1.0], [10.0, 1.0]])
    none, six = np.zeros((3, 4)), np.zeros((3, 4, 6))
    codes = np.zeros(3, int)
    duty = DutyResult(
        six, six, none, speed, none[:, 0], codes, none, {"damage": damage}, ()
    )
    run = solved(scene, duty=duty)
    assert run.worst_cases == [0, 1, 0, None]
    assert run.shown_case == "case 0 of 3"
    assert run.case_words(1) == "drive.power -20 kW"
    np.testing.assert_allclose(
        run.hours[:2], 110 / (100 + 10 * np.array([5, 20])) / 10 / 3600 * 2 * np.pi
    )
    assert np.isinf(run.hours[3])
    found = run.to_xarray()
    assert found.damage.sel(bearing="B").values.tolist() == [1.0, 20.0, 99.0]
    assert found["load"].dims == ("case", "bearing", "component")
    assert found.speed.dims == ("case", "shaft") and found.damage.units == "1/rev"
    np.testing.assert_array_equal(found.hours, run.hours)


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    """A run with cases whose lives were made up: A has a required life, C is on
    springs, D has none."""
    path = tmp_path_factory.mktemp("judged") / "x.toml"
    path.write_text(SCENE + CASES, "utf-8")
    scene = read_shafts(path, ["bearings.A.life.required=8000 h"])
    rng, cases = np.random.default_rng(3), 3
    damage = 1e-9 * rng.uniform(1.0, 2.0, (cases, 4))
    damage[:, 2] = np.nan
    basic = rng.uniform(0.5, 1.0, (cases, 4)) / damage
    parts = {
        "viscosity_ratio": np.array([0.7, 0.9, 0.5]),
        "damage_share": np.tile([[[0.3], [0.7]]], (cases, 1, 1, 1)),
        "limit_ratio": rng.uniform(0.3, 0.6, (cases, 1, 1)),
    }
    zero, six = np.zeros((cases, 4)), np.zeros((cases, 4, 6))
    speed = np.array([[150.0, 50.0], [300.0, 100.0], [150.0, 50.0]])
    lives = {"basic_rating_life": basic, "damage": damage}
    duty = DutyResult(
        six, six, zero, speed, zero[:, 0], zero[:, 0].astype(int), zero, lives,
        ({},) * 4, fatigue=(parts, {}, {}, {}),
    )  # fmt: skip
    life = object.__new__(Life)
    object.__setattr__(life, "ratings", SimpleNamespace(dynamic_capacity=4e4))
    bearings = [
        SimpleNamespace(name=name, scene=scene.bearings[k], life=life)
        for k, name in enumerate("ABCD")
    ]
    bearings[2].scene = bearings[2].life = None
    return solved(scene, duty=duty, bearings=bearings)


def test_verdict_of_cases_tells_what_it_would_take(judged):
    """As that of a spectrum of one bearing, of the cases by their hours."""
    first, *others = judged.verdicts
    assert others == [None] * 3
    spent = np.array([100.0, 10.0, 0.0])
    turns = spent * judged.duty.speed[:, 0] * 3600 / (2 * np.pi)
    damage = judged.duty.lives["damage"][:, 0]
    hours = spent.sum() / (turns @ damage)
    assert first.factor == pytest.approx(hours / 8000.0)
    used = turns @ (1.0 / judged.duty.lives["basic_rating_life"][:, 0])
    basic = spent.sum() / used / 8000.0
    bearing, given = judged.bearings[0].scene.element.bearing, judged.task.lives[0]
    share = turns * damage / (turns @ damage)
    factors = first.factor, basic, 4e4
    wanted = judge_life(bearing, given, *factors, judged.duty.fatigue[0], share)
    assert wanted.viscosity is not None and wanted.cleanliness
    assert first.cleanliness == wanted.cleanliness
    for name in ("dynamic_capacity", "basic_capacity", "viscosity"):
        assert getattr(first, name) == pytest.approx(getattr(wanted, name))
    # Where cases vary the bearings or the oil there is no one that it would take.
    for key in ("lubricant.temperature", "bearings.A.position"):
        varied = dataclasses.replace(judged.task, varied=(key,))
        run = solved(varied, duty=judged.duty, bearings=judged.bearings)
        (other, *_) = run.verdicts
        assert other.factor == first.factor and other.dynamic_capacity is None


def test_table_of_cases_judges_each_case_alone(judged):
    found = shaft_columns(judged)
    turns = judged.duty.speed[:, 0] * 3600 / (2 * np.pi)
    factor = 1.0 / (judged.duty.lives["damage"][:, 0] * turns) / 8000.0
    np.testing.assert_allclose(found["life_factor"][::4], factor)
    assert np.isnan(np.delete(found["life_factor"], [0, 4, 8])).all()
    words = np.where(factor >= 1, "true", "false")
    assert found["life_kept"].tolist() == [x for w in words for x in (w, "", "", "")]
    assert 0 < (factor >= 1).sum() < 3
    # Truth values where all have a verdict; no column where none has one.
    for scene, told in ((judged.bearings[0].scene, True), (None, False)):
        every = [SimpleNamespace(scene=scene)] * 4
        lives = {"damage": np.full((3, 4), 1e-12)}
        duty = dataclasses.replace(judged.duty, lives=lives)
        found = shaft_columns(solved(judged.task, duty=duty, bearings=every))
        assert ("life_kept" in found) is told
        assert not told or found["life_kept"].dtype == bool


def test_result_of_what_runs_away(tmp_path):
    """It is that of the temperatures too, not of the shafts alone."""
    hot: Any = SimpleNamespace(result=int(Result.STEP_LIMIT))
    (tmp_path / "x.toml").write_text(WARM, "utf-8")
    scene = read_shafts(tmp_path / "x.toml")
    assert solved(scene, thermal=hot).result is Result.STEP_LIMIT
    told = "B: temperatures change the viscosity of the oil alone, neither"
    assert [text for text in scene.warnings if "viscosity" in text][0].startswith(told)
    given = "bearings.A.temperature={shaft='50 °C'}"
    warned = read_shafts(tmp_path / "x.toml", [given]).warnings
    assert "A: its `temperature` is not used: [heat] finds temperatures" in warned


def test_verdict_of_warm_bearings_counts_from_the_warm_oil(tmp_path):
    (tmp_path / "x.toml").write_text(WARM, "utf-8")
    scene = read_shafts(tmp_path / "x.toml", ["life.required=9000 h"])
    state = object.__new__(ThermalState)
    rings = {"inner_ring": jnp.full(2, 350.0), "outer_ring": jnp.full(2, 340.0)}
    for name, value in {"system": scene.system, **rings}.items():
        object.__setattr__(state, name, value)
    warm = _with_temperatures(scene, state)
    given: Any = zip(warm.bearings, scene.bearings, warm.lives, strict=True)
    for one, cold, conditions in given:
        oil = float(one.oil.lubricant.kinematic_viscosity(345.0))
        assert one.life.viscosity == conditions.viscosity == pytest.approx(oil)
        assert one.life.viscosity < 0.6 * cold.life.viscosity
        assert one.life.required == 9000.0


@pytest.mark.slow
def test_thermal_runaway(run, tmp_path):
    (tmp_path / "x.toml").write_text(WARM, "utf-8")
    ways = [f"bearings.A.heat.{ring}=1e-3 W/K" for ring in ("inner", "outer")]
    given = [part for way in ways for part in ("--set", way)]
    done = run("shaft", tmp_path / "x.toml", *given, "--json", tmp_path / "x.json")
    assert done.status == 3 and "no thermal equilibrium" in done.err
    found = json.loads((tmp_path / "x.json").read_text("utf-8"))
    assert found["result"] == "step_limit"


PAUSE = """
[cases]
spectrum = [
    { "drive.speed" = "0 rpm", hours = "10 h" },
    { "drive.speed" = "3000 rpm", hours = "30 h" },
]
"""


@pytest.mark.slow
def test_pauses_of_a_duty_cycle(tmp_path):
    """At rest nothing makes heat or damage; a bearing that cools slowly keeps the mean
    of the cycle."""
    (tmp_path / "x.toml").write_text(WARM + PAUSE, "utf-8")
    rises = []
    for pauses in ("ambient", "mean"):
        scene = read_shafts(tmp_path / "x.toml", [f"heat.pauses={pauses}"])
        found = run_shafts(scene)
        assert found.converged and found.duty is not None and found.rings is not None
        rises.append(found.rings - 295.15)
        assert found.worst_cases == [1, 1]
        assert all(np.isfinite(found.hours))
    np.testing.assert_allclose(rises[0][0], 0.0, atol=1e-9)
    np.testing.assert_allclose(rises[1][0], 0.75 * rises[1][1], rtol=1e-9)
    np.testing.assert_allclose(rises[0][1], rises[1][1], rtol=1e-9)


def test_scene_at_rest_has_no_heat(tmp_path):
    (tmp_path / "x.toml").write_text(WARM + PAUSE, "utf-8")
    read_shafts(tmp_path / "x.toml")
    never = 'cases={spectrum=[{"drive.speed"="0 rpm", hours="1 h"}]}'
    with pytest.raises(SceneError, match="`heat`: needs a `speed` of the drive"):
        read_shafts(tmp_path / "x.toml", [never])


def test_warming_up_is_shown(tmp_path):
    """As a table and a panel, ring by ring."""
    (tmp_path / "x.toml").write_text(WARM, "utf-8")
    scene = read_shafts(tmp_path / "x.toml", ["heat.duration=1 h", "heat.times=31"])
    assert scene.times is not None
    warming = 295.15 + np.outer(1.0 - np.exp(-scene.times / 900.0), [30, 20, 25, 15])
    state: Any = SimpleNamespace(
        inner_ring=warming[-1, ::2], outer_ring=warming[-1, 1::2], friction=[9.0, 8.0],
        slowest=1e-3, result=0,
    )  # fmt: skip
    run = solved(scene, thermal=state, warming=warming)
    *_, grid = _temperatures(run)
    assert isinstance(grid, Grid) and grid.title.startswith("warming up")
    assert [column.name for column in grid.columns][1:] == [*run.warm_nodes]
    _, ax = plt.subplots()
    _draw_warm_up(ax, run)
    names = ["A inner", "A outer", "B inner", "B outer"]
    assert [line.get_label() for line in ax.lines] == names
    drawn = np.asarray(ax.lines[1].get_xydata())
    np.testing.assert_allclose(drawn[:, 1], warming[:, 1] - 273.15)
    np.testing.assert_allclose(drawn[-1, 0], 60.0)
    state.housing = 300.15
    _, ax = plt.subplots()
    _draw_nodes(ax, run)
    bars = [bar.get_height() for bar in ax.patches if isinstance(bar, Rectangle)]
    np.testing.assert_allclose(bars, warming[-1, [1, 3, 0, 2]] - 273.15)
    assert [t.get_text() for t in ax.get_xticklabels()] == ["A", "B"]
    assert ax.lines[0].get_label() == "housing or surroundings, 27"
    plt.close("all")


def test_all_shafts_are_drawn_in_one_frame_with_meshes_and_hands():
    """The output shaft lies below the input, its wheel meets the pinion between."""
    scene = read_shafts("shaft_gearbox")
    power = power_flow(scene.system)
    run = solved(scene, solution=SimpleNamespace(power=power))
    _, (end, side) = plt.subplots(1, 2)
    system_views(run, end, side)
    assert end.get_title() == "All shafts, seen against z, to scale"
    for ax, across in ((end, "x [mm]"), (side, "z [mm]")):
        assert (ax.get_xlabel(), ax.get_ylabel()) == (across, "y [mm]")
        words = [text.get_text() for text in ax.texts]
        assert {"pinion, right 15°", "wheel, left 15°"} <= {*words}
        assert ("A" in words) is (ax is side)
        dots = [line for line in ax.lines if line.get_label() == "_mesh"]
        places = np.array([np.ravel(dot.get_data()) for dot in dots], float)
        # Where the centre distance of 190 mm is shared by 23 and 68 teeth.
        np.testing.assert_allclose(places[:, 1], -190.0 * 23.0 / 91.0)
    # The pinion to scale: 23 teeth of 4 mm at 15 degrees, 45 mm wide.
    radius = 2.0 * 23 / np.cos(np.deg2rad(15.0))
    sizes = [np.ptp(np.asarray(p.get_path().vertices), axis=0) for p in side.patches]
    assert any(np.allclose(size, [45.0, 2.0 * radius]) for size in sizes)
    plt.close("all")


def test_housing_file(tmp_path):
    """A matrix of all seats in a file: as the stiffness of one seat alone."""
    matrix = np.diag([3e8, 2e8, 1e8])
    bare = SCENE.replace('housing = ["3e8 N/m", "2e8 N/m", "1e8 N/m"]\n', "")
    for name in ("k.csv", "k.npy", "k.mtx"):
        place = tmp_path / name
        if name.endswith("npy"):
            np.save(place, matrix)
        elif name.endswith("mtx"):
            lines = ["%%MatrixMarket matrix array real general", "3 3"]
            place.write_text("\n".join([*lines, *map(str, matrix.T.ravel())]))
        else:
            np.savetxt(place, matrix, delimiter=",")
        scene = tmp_path / "h.toml"
        scene.write_text(
            f'{bare}\n[housing]\nfile = "{name}"\nseats = ["B"]\n', "utf-8"
        )
        read = read_shafts(scene).system.housing
        np.testing.assert_allclose(read.matrix, matrix)
        np.testing.assert_allclose(
            read.matrix, read_shafts(GEARS).system.housing.matrix
        )


@pytest.mark.slow
def test_warnings(run):
    """Arrangements that seldom are meant are named."""
    done = run("shaft", GEARS, "--set", "bearings.D.floating=false")
    assert done.status == 0
    assert "shaft out is located by C and D" in done.out
    spur = [
        f"gear.{g}.{k}"
        for g in ("pinion", "wheel")
        for k in ("hand=none", "helix_angle=0 deg")
    ]
    place = "shaft.out.position=['182 mm','0 mm','0 mm']"
    settings = ["bearings.C.floating=true", *spur, place]
    done = run("shaft", GEARS, *(word for s in settings for word in ("--set", s)))
    assert done.status == 0, done.err
    assert "nothing holds uz of shaft out" in done.out


@pytest.mark.slow
@pytest.mark.parametrize(
    "setting, told",
    [
        ("drive.into=pinion", "has a mate or a torque"),
        ("coupling.c={shaft='out', torque='5 N m'}", "do not balance"),
    ],
)
def test_torques_that_cannot_be(setting, told):
    """Known when the flow of power is worked out."""
    with pytest.raises(SceneError, match=told):
        run_shafts(read_shafts(GEARS, [setting]))


def test_no_bearings(tmp_path):
    scene = tmp_path / "x.toml"
    scene.write_text(SCENE[: SCENE.index("[bearings.A]")], "utf-8")
    with pytest.raises(SceneError, match="`bearings`: is missing"):
        read_shafts(scene)


def test_solve_command_rejects_shaft_scene(run):
    done = run("solve", GEARS)
    assert done.status == 2
    assert "`bearingjax shaft gears` solves it" in done.err


def test_new_scene(run, tmp_path):
    """`new shaft` prints a commented scene that reads."""
    done = run("new", "shaft")
    assert done.status == 0 and done.out.count("#") > 8
    (tmp_path / "mine.toml").write_text(done.out, "utf-8")
    assert len(read_shafts(tmp_path / "mine.toml").system.seats) == 4


def test_seat_on_a_shaft_of_another_size():
    """A bearing whose bore is not the diameter of its shaft is named."""
    settings = ["shaft.in.segments.0.outer_diameter=47 mm"]
    warnings = read_shafts(GEARS, settings).warnings
    assert any("6308 has a bore of 40 mm; at station" in text for text in warnings)


def test_gravity_of_a_shaft_scene():
    for setting, wanted in (
        ("none", [0.0, 0.0, 0.0]),
        ("y", [0.0, 9.80665, 0.0]),
        ("-z", [0.0, 0.0, -9.80665]),
    ):
        system = read_shafts(GEARS, [f"system.gravity={setting}"]).system
        np.testing.assert_allclose(system.gravity, wanted)

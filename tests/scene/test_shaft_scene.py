"""`bearingjax shaft`: scenes of shaft systems, their errors, files and load cases."""

import csv
import json
import re
from typing import Any

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.scene import SceneError, read_shafts, run_shafts, shaft_report
from bearingjax.scene.shaft_output import shaft_columns

SCENE = """
[drive]
speed = "1480 rpm"
power = "12 kW"

[shaft.in]
position = ["0 mm", "0 mm", "0 mm"]
segments = [{ length = "260 mm", outer_diameter = "40 mm" }]

[shaft.out]
position = ["189.472 mm", "0 mm", "0 mm"]
segments = [
    { length = "60 mm", outer_diameter = "40 mm" },
    { length = "140 mm", outer_diameter = "50 mm" },
    { length = "100 mm", outer_diameter = "40 mm" },
]

[gear.pinion]
shaft = "in"
position = "100 mm"
teeth = 23
normal_module = "4 mm"
helix_angle = "15 deg"
hand = "right"
mates_with = "wheel"
face_width = "40 mm"

[gear.wheel]
shaft = "out"
position = "100 mm"
teeth = 68
normal_module = "4 mm"
helix_angle = "15 deg"
hand = "left"

[load.pull]
shaft = "out"
station = 3
Fy = "-500 N"

[bearings.A]
shaft = "in"
position = "40 mm"
designation = "6308"

[bearings.B]
shaft = "in"
position = "240 mm"
designation = "6308"
floating = true
housing = ["3e8 N/m", "2e8 N/m", "1e8 N/m"]

[bearings.C]
shaft = "out"
position = "30 mm"
designation = "6308"

[bearings.D]
shaft = "out"
position = "220 mm"
designation = "6308"
floating = true

[life]
contamination = "oil bath -/17/14"

[lubricant]
name = "ISO VG 220"
temperature = "70 °C"
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    found = tmp_path_factory.mktemp("shafts") / "gears.toml"
    found.write_text(SCENE, "utf-8")
    return found


@pytest.fixture(scope="module")
def solved(path):
    return run_shafts(read_shafts(path))


@pytest.mark.slow
def test_command(run, path, tmp_path, rerun):
    """Text, JSON, table, picture and page; the JSON read again gives the same."""
    out, table = tmp_path / "out.json", tmp_path / "out.csv"
    done = run(
        "shaft", path, "--json", out, "--table", table, "--plot", tmp_path / "p.png"
    )
    assert done.status == 0, done.err
    assert "2 shafts on 4 bearings" in done.out and "12 kW" in done.out
    found = json.loads(out.read_text("utf-8"))
    assert found["result"] == "converged" and found["message"] == ""
    assert [*found["bearings"]] == ["A", "B", "C", "D"]
    for name in ("A", "C"):
        one = found["bearings"][name]
        wanted = (
            "load displacement tilt contact_load roller_load peak_pressure"
            " static_safety basic_rating_life reference_rating_life"
            " modified_rating_life life_hours friction_torque temperature clearance"
        )
        assert not {*wanted.split()} - {*one}
        assert len(one["load"]) == len(one["displacement"]) == 6
        assert len(one["tilt"]) == 2
    gears = found["gear"]
    np.testing.assert_allclose(
        gears["wheel"]["force"], -np.array(gears["pinion"]["force"]), rtol=1e-9
    )
    assert {"force", "misalignment"} <= {*gears["wheel"]}
    lines = found["shaft"]["in"]
    assert {"position", "deflection", "shear", "moment"} <= {*lines}
    assert found["system_life_hours"] < min(
        b["life_hours"] for b in found["bearings"].values()
    )
    loads = {n: np.array(b["load"][:3]) for n, b in found["bearings"].items()}
    np.testing.assert_allclose(
        loads["C"] + loads["D"], np.array(gears["wheel"]["force"]) + [0, -500, 0],
        rtol=1e-9, atol=1e-6,
    )  # fmt: skip
    assert abs(loads["D"][2]) < 1e-6 < abs(loads["C"][2])
    rows = list(csv.DictReader(table.read_text("utf-8").splitlines()))
    assert [row["bearing"] for row in rows] == ["A", "B", "C", "D"]
    np.testing.assert_allclose(float(rows[2]["Fx [N]"]), loads["C"][0], rtol=1e-9)
    rerun("shaft", out)


@pytest.mark.slow
def test_lives_are_those_of_the_bearings_alone(solved):
    """Each bearing under its load alone, with its tilt held, has the same life."""
    for bearing in solved.bearings:
        solution = bearing.solution
        held: Any = dict(
            zip("ux uy uz gx gy".split(), solution.displacement[6:11], strict=True)
        )
        again = bj.solve_load(
            solution.element, prescribed=held, free=[], speed=solution.speed
        )
        entry = bearing.scene.catalogue.entry
        life = bj.rating_life(
            solution.element, again, dynamic_capacity=entry.dynamic_capacity
        )
        np.testing.assert_allclose(
            bearing.life.reference_rating_life, life.reference_rating_life, rtol=1e-7
        )


@pytest.mark.slow
def test_system_life(solved):
    """By the survival of all, of balls alone: (Σ L^-e)^(-1/e)."""
    e = 10.0 / 9.0
    wanted = (solved.hours**-e).sum() ** (-1.0 / e)
    np.testing.assert_allclose(solved.system_hours, wanted, rtol=1e-12)


@pytest.mark.slow
def test_cases(path, solved, run, tmp_path):
    """Load cases side by side are those of one after the other; the spectrum adds up
    their damage."""
    scene = tmp_path / "cases.toml"
    scene.write_text(
        SCENE
        + """
[[cases.spectrum]]
drive.power = "12 kW"
hours = "100 h"

[[cases.spectrum]]
drive.power = "-20 kW"
hours = "10 h"

[[cases.spectrum]]
drive.power = "1 kW"
hours = "0 h"
""",
        "utf-8",
    )
    found = run_shafts(read_shafts(scene))
    assert found.converged and found.duty is not None
    np.testing.assert_allclose(found.duty.load[0], solved.solution.load, atol=1e-6)
    lives = [b.life.reference_rating_life for b in solved.bearings]
    np.testing.assert_allclose(
        found.duty.lives["reference_rating_life"][0], lives, rtol=1e-7
    )
    back = run_shafts(read_shafts(path, ["drive.power=-20 kW"]))
    np.testing.assert_allclose(found.duty.load[1], back.solution.load, atol=1e-6)
    damage = np.array([1 / solved.hours, 1 / back.hours])
    wanted = 1.0 / (np.array([100.0, 10.0]) / 110.0 @ damage)
    np.testing.assert_allclose(found.hours, wanted, rtol=1e-6)
    assert "under all 3 cases" in str(shaft_report(found))
    # What is odd in one case is told, with the case, as a sweep tells it.
    light = [text for text in found.warnings if "light_load" in text]
    assert len(light) == 4
    assert all(re.search(r"in \d of 3 cases, worst case \d", text) for text in light)
    out, table = tmp_path / "c.json", tmp_path / "c.csv"
    done = run("shaft", scene, "--json", out, "--table", table)
    assert done.status == 0, done.err
    told = json.loads(out.read_text("utf-8"))
    assert told["cases"]["hours"] == [100.0, 10.0, 0.0]
    rows = list(csv.DictReader(table.read_text("utf-8").splitlines()))
    assert len(rows) == 12 and rows[4]["drive.power"] == "-20 kW"


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


def test_housing_file(path, solved, tmp_path):
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
        np.testing.assert_allclose(read.matrix, solved.task.system.housing.matrix)


@pytest.mark.slow
def test_warnings(path, run):
    """Arrangements that seldom are meant are named."""
    done = run("shaft", path, "--set", "bearings.D.floating=false")
    assert done.status == 0
    assert "shaft out is located by C and D" in done.out
    spur = [
        f"gear.{g}.{k}"
        for g in ("pinion", "wheel")
        for k in ("hand=none", "helix_angle=0 deg")
    ]
    place = "shaft.out.position=['182 mm','0 mm','0 mm']"
    settings = ["bearings.C.floating=true", *spur, place]
    done = run("shaft", path, *(word for s in settings for word in ("--set", s)))
    assert done.status == 0, done.err
    assert "nothing holds uz of shaft out" in done.out
    done = run("shaft", path, "--set", "bearings.C.floating=true")
    assert done.status == 3 and "takes up the load along uz of shaft out" in done.err


WRONG = {
    "bearings.A.designation=6999": "`bearings.A.designation`",
    "bearings.A.position=300 mm": "300 mm is beyond the ends of in, from 0 to 260 mm",
    "bearings.A.shaft=inn": "`bearings.A.shaft`: 'inn' is not known",
    "bearings.A.station=4": "`bearings.A.station`: give either `position` or this",
    "bearings.A.preload=5": "`bearings.A.preload`: 5 has no unit",
    "bearings.A.preload=-5 N": "`preload` is -5 N",
    "bearings.A.turned=yes": "`bearings.A.turned`",
    "bearings.A.housing=['1 N/m']": "has 1 numbers; it must have three",
    "bearings.A.n_balls=0": "`bearings.A.n_balls`",
    "bearings.A.stiffness.radial=1e8 N/m": "goes with a bearing, not with springs",
    "bearings.A.fit.bore=1 mm": "`bearings.A.fit",
    "bearings.A.lubricant.name=butter": "`bearings.A.lubricant.name`",
    "bearings.A.heat.inner=2 W/K": "`heat`: is missing",
    "bearings.A.wheel=2": "`bearings.A.wheel`: unknown key",
    "gear.pinion.teeth=0": "`gear.pinion.teeth`: 0 is not a whole number",
    "gear.pinion.normal_module=5 mm": "`normal_module` is 0.005 of pinion and 0.004",
    "gear.pinion.helix_angle=70 deg": "`helix_angle` is 1.22173 rad",
    "gear.pinion.hand=up": "`gear.pinion.hand`: 'up' is not known",
    "gear.pinion.hand=left": "one must be left, one right",
    "gear.pinion.hand=none": "a helix is 'right' or 'left'",
    "gear.pinion.mates_with=whel": "`mates_with` of pinion is 'whel'",
    "gear.pinion.power=3 kW": "pinion has a mate, from which its torque follows",
    "gear.pinion.pitch_angle=45 deg": "`pitch_angle` and `apex` of pinion",
    "gear.pinion.efficiency=1.2": "is 1.2; it must be above 0 and at most 1",
    "gear.pinion.shaft=out": "sit on one shaft",
    "shaft.out.position=['150 mm','0 mm','0 mm']": "150 mm apart, their pitch circles",
    "gear.wheel.position=150 mm": "50 mm apart along their shafts",
    "shaft.out.axis=x": "the shafts of pinion and wheel are not parallel",
    "shaft.out.axis=[0, 0, 0]": "`shaft.out.axis`: has no direction",
    "shaft.out.position=['1 mm']": "has 1 numbers; it must have three",
    "shaft.out.speed=3 rpm": "is given beside `drive.speed`",
    "shaft.in.segments.0.bore=60 mm": "`shaft.in.segments[0].bore`",
    "drive.power=12 kg": "`drive.power`",
    "drive.torque=12 N m": "`drive.torque`: give either `power` or this",
    "drive.speed=0 rpm": "`power` needs a `speed`",
    "drive.into=motor": "'motor' is neither a shaft nor a wheel",
    "drive.into=pinion": "has a mate or a torque",
    "coupling.c.shaft=in": "",
    "coupling.c={shaft='out', torque='5 N m'}": "do not balance",
    "load.pull.Fq=1 N": "`load.pull.Fq`: unknown key",
    "system.gravity=down": "`system.gravity`: 'down' is not known",
    "housing={file='no.csv', seats=['A']}": "stands beside `housing` of bearing B",
    "life.reliability=95": "`life.reliability`",
    "cases={file='no.csv'}": "no.csv: cannot be read",
    "cases={grid={'rotor.speed'=[1]}}": "`cases.rotor.speed`: cannot vary",
    "heat.ambient=20": "`heat.ambient`: 20 has no unit",
    "heat={ambient='20 °C', duration='-1 s'}": "`heat.duration`",
}


@pytest.mark.parametrize("setting", [key for key, told in WRONG.items() if told])
@pytest.mark.slow
def test_wrong_scenes(path, setting):
    """Each error names the key, the fault, and what is allowed."""
    with pytest.raises(SceneError) as caught:
        run_shafts(read_shafts(path, [setting]))
    assert WRONG[setting] in str(caught.value)
    assert "gears" in str(caught.value)


def test_no_bearings(tmp_path):
    scene = tmp_path / "x.toml"
    scene.write_text(SCENE[: SCENE.index("[bearings.A]")], "utf-8")
    with pytest.raises(SceneError, match="`bearings`: is missing"):
        read_shafts(scene)


def test_solve_command_rejects_shaft_scene(run, path):
    done = run("solve", path)
    assert done.status == 2
    assert "`bearingjax shaft gears` solves it" in done.err


def test_new_scene(run, tmp_path):
    """`new shaft` prints a commented scene that reads."""
    done = run("new", "shaft")
    assert done.status == 0 and done.out.count("#") > 8
    (tmp_path / "mine.toml").write_text(done.out, "utf-8")
    assert len(read_shafts(tmp_path / "mine.toml").system.seats) == 4


def test_seat_on_a_shaft_of_another_size(path):
    """A bearing whose bore is not the diameter of its shaft is named."""
    settings = ["shaft.in.segments.0.outer_diameter=47 mm"]
    warnings = read_shafts(path, settings).warnings
    assert any("6308 has a bore of 40 mm; at station" in text for text in warnings)

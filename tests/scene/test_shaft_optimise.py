"""[optimise] in the scene of a system of shafts, and what is wrong with wrong ones."""

import json

import pytest

import bearingjax as bj
from bearingjax.scene import (
    SceneError,
    read_optimisation,
    read_shafts,
    run_shafts,
)

SCENE = """
[drive]
speed = "1480 rpm"
power = "2 kW"

[shaft.s]
segments = [
    { length = "200 mm", outer_diameter = "40 mm" },
    { length = "80 mm", outer_diameter = "35 mm" },
]

[coupling.out]
shaft = "s"

[load.pull]
shaft = "s"
position = "120 mm"
Fy = "-4 kN"

[bearings.A]
shaft = "s"
position = "20 mm"
designation = "6208"
preload = "80 N"

[bearings.B]
shaft = "s"
position = "180 mm"
designation = "6208"
floating = true

[optimise]
objective = "rating_life"

[optimise.variables]
"bearings.B.position" = { from = "150 mm", to = "195 mm" }
"bearings.B.radial_internal_clearance" = { from = "1 um", to = "25 um" }

[[optimise.constraints]]
measure = "tilt"
of = "A"
at_most = "1 mrad"
"""
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


@pytest.fixture
def scene(tmp_path):
    """Write the scene with some words replaced, and more at its end."""

    def write(*pairs, more=""):
        text = SCENE
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "free.toml"
        path.write_text(text + more, encoding="utf-8")
        return path

    return write


@pytest.mark.slow
def test_optimise_command_of_shaft_scene(run, scene, tmp_path):
    """Text, JSON, page and picture; the lives are those of `bearingjax shaft`."""
    out, page, picture = (tmp_path / name for name in ("o.json", "o.html", "o.png"))
    written = {"--json": out, "--report": page, "--plot": picture}
    path = scene()
    code, text, error = run("optimise", path, *(x for p in written.items() for x in p))
    assert (code, error) == (0, "")
    assert "rating life" in text and "maximised" in text
    found = json.loads(out.read_text())
    assert found["result"] == "converged"
    before, after = (found["rating_life"][side] for side in ("before", "after"))
    assert after > 1.2 * before
    assert min(of["rating_life"]["after"] for of in found["bearings"].values()) == after
    assert picture.stat().st_size > 10_000 and "Bearings" in page.read_text()
    best = {one["name"]: one["after"] for one in found["variables"]}
    settings = [
        f"bearings.B.position={best['bearings.B.position']!r} m",
        "bearings.B.radial_internal_clearance="
        f"{best['bearings.B.radial_internal_clearance']!r} m",
    ]
    alone = run_shafts(read_shafts(path, settings))
    assert alone.hours.min() == pytest.approx(after, rel=1e-6)


def test_study_of_optimise_scene(scene):
    """The scene is one of `optimise`; `shaft` takes its numbers as they stand."""
    path = scene()
    assert bj.scene.study_of(path) == "optimise"
    assert read_shafts(path).system.seats[1].position == pytest.approx(0.18)
    assert "optimise" in read_optimisation(path).inputs


def test_shaft_numbers_list_variables(scene):
    """Numbers of bearings, segments and wheels, those of a mesh with all its gears."""
    from bearingjax.scene.shaft_optimise import shaft_numbers

    found = shaft_numbers(read_shafts(scene(more=GEARS)))
    assert found["shaft.s.segments.1.outer_diameter"] == (
        "system.shafts.0.outer_diameter.1",
    )
    module = ("system.wheels.0.normal_module", "system.wheels.1.normal_module")
    assert found["gear.z2.normal_module"] == module
    assert found["gear.z2.position"] == ("system.wheels.1.position",)
    assert "bearings.A.preload" in found and "bearings.B.preload" not in found
    assert "bearings.C.position" in found and "bearings.C.type" not in found


TURNING = 'speed = "1480 rpm"\npower = "2 kW"'
FREE = '"bearings.B.position"'
ASKED = 'objective = "rating_life"'
WRONG = {
    "objective": ((ASKED, 'objective = "life"'), "'life' is not known"),
    "of": ((ASKED, f'{ASKED}\nof = "D"'), "`optimise.of`: 'D' is not known"),
    "of a system": ((ASKED, 'objective = "mass"\nof = "A"'), "is of the whole system"),
    "gear": ((ASKED, 'objective = "misalignment"'), "misalignment needs a gear"),
    "rest": ((TURNING, 'torque = "1 N m"'), "needs a `speed`"),
    "oil": ((ASKED, 'objective = "power_loss"'), "power_loss needs a [lubricant]"),
    "unit": (('"1 mrad"', '"1 mm"'), "'1 mm' is not an angle"),
    "no bound": (('at_most = "1 mrad"', ""), "give `at_least`, `at_most` or both"),
    "key": ((FREE, '"bearings.B.at"'), "'bearings.B.at' is not known"),
    "load": ((FREE, '"load.pull.position"'), "'load.pull.position' may not be free"),
    "segment": ((FREE, '"shaft.s.segments.2.bore"'), "is not known"),
    "quotes": ((FREE, "bearings.B.position"), "write the dotted key in quotes"),
    "step": (('to = "195 mm"', 'to = "210 mm"'), "a step of the shaft"),
    "order": (('from = "150 mm"', 'from = "100 mm"'), "no part may pass another one"),
    "start": (('from = "150 mm"', 'from = "190 mm"'), "must lie between its bounds"),
    "exponent": ((ASKED, f"{ASKED}\nexponent = 0.5"), "above 1 and at most 10000"),
    "unknown": ((ASKED, f'{ASKED}\nfreedom = "ux"'), "unknown key"),
    "method": ((ASKED, f'{ASKED}\nmethod = "adam"'), "keeps no constraints"),
    "cases": (
        ("[optimise]\n", '[cases]\ngrid = { "bearings.B.position" = ["150 mm",'
         ' "160 mm"] }\n[optimise]\n'),
        "differs from case to case",
    ),
    "order of cases": (
        ("[optimise]\n", '[cases]\ngrid = { "bearings.A.position" = ["20 mm",'
         ' "190 mm"] }\n[optimise]\n'),
        "stand in another order",
    ),
    "table": (("[optimise.variables]", "[variables]"), "`variables`"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_wrong_tables(scene, name):
    pair, wanted = WRONG[name]
    with pytest.raises(SceneError) as error:
        read_optimisation(scene(pair))
    assert wanted in str(error.value)
    assert "\n" not in str(error.value)


def test_read_optimisation_rejects_heat_table(scene):
    with pytest.raises(SceneError, match="does not go with"):
        read_optimisation(
            scene(
                more='[lubricant]\nname = "ISO VG 100"\ntemperature = "60 °C"\n[heat]\n'
            )
        )


def test_read_optimisation_rejects_life_of_springs(scene):
    pair = (ASKED, f'{ASKED}\nof = "C"')
    with pytest.raises(SceneError, match="'C' is not known"):
        read_optimisation(scene(pair, more=GEARS))

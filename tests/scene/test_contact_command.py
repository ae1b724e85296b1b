"""`bearingjax contact`: exit status, files, what is said where.

A failed solve leaves no numbers that could be taken for results; a wrong scene gives
one line that names file, key, fault and what is allowed.
"""

import json

import pytest

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.scene import read_contact

SMALL = ("--set", "numerics.across=9", "--set", "numerics.along=12")
TAPER = ("contact", "taper_contact", *SMALL)
ONE = (*TAPER, "--set", "operating.load=3 kN")
WORDS = {
    *("result", "message", "residual", "iterations", "warnings", "inputs", "version"),
}

# Settings of the shipped scene, and the message after "taper_contact.toml: ".
WRONG = {
    "bearing": (
        ["bearing.type=tapered_roller"],
        "`bearing`: a contact is one [roller] on one [raceway], or a roller of a"
        " bearing",
    ),
    "unknown table": (
        ["rollers.length=3 mm"],
        "`rollers`: unknown key (did you mean `roller`?); known at the top level:"
        " contact, numerics, operating, output, raceway, roller",
    ),
    "unknown key of the roller": (
        ["roller.lenght=3 mm"],
        "`roller.lenght`: unknown key (did you mean `length`?); known in [roller]:",
    ),
    "unknown key of the numerics": (
        ["numerics.points=32"],
        "`numerics.points`: unknown key; known in [numerics]: across, along, grading,"
        " half_width, max_steps, tolerance",
    ),
    "no unit": (
        ["roller.length=15"],
        "`roller.length`: 15 has no unit; a length with its unit is wanted,",
    ),
    "wrong kind": (
        ["operating.tilt=1 mm"],
        "`operating.tilt`: '1 mm' is not an angle;",
    ),
    "no length": (
        ["roller.length=0 mm"],
        "`roller.length`: 0 m must be above 0",
    ),
    "two sorts of diameter": (
        ["roller.diameter=10 mm"],
        "`roller.diameter`: give either this or `small_diameter` and `large_diameter`",
    ),
    "ends swapped": (
        ["roller.large_diameter=9 mm"],
        "`roller.large_diameter`: is below `small_diameter`, 10 mm",
    ),
    "half angle of a disc": (
        ["roller.half_angle=60 deg"],
        "[roller]: RollerContact: `half_angle` is 1.0472 rad; it must be above -0.7",
    ),
    "profile that is not known": (
        ["roller.profile.type=logarithm"],
        "`roller.profile.type`: 'logarithm' is not known (did you mean `logarithmic`?)",
    ),
    "material that is not known": (
        ["raceway.material=brass"],
        "`raceway.material`: 'brass' is not known; it must be one of steel,",
    ),
    "side of a plane": (
        ["raceway.side=inner"],
        "`raceway.side`: goes with `diameter`; without it the raceway is a plane",
    ),
    "diameter without side": (
        ["raceway.diameter=80 mm"],
        "`raceway.side`: is missing; it must be one of inner, outer",
    ),
    "side that is not known": (
        ["raceway.diameter=80 mm", "raceway.side=convex"],
        "`raceway.side`: 'convex' is not known; it must be one of inner, outer",
    ),
    "outer raceway smaller than the roller": (
        ["raceway.diameter=12 mm", "raceway.side=outer"],
        "`raceway.diameter`: an outer raceway is wider than the roller, 12 mm",
    ),
    "half angle of the raceway": (
        ["raceway={diameter='80 mm', side='inner', half_angle='80 deg'}"],
        "`raceway.half_angle`: 80 deg is not allowed; below 40.1 in size",
    ),
    "load and approach": (
        ["operating.approach=5 um"],
        "`operating.approach`: give either `load` or this, not both",
    ),
    "neither load nor approach": (
        ["operating={tilt='0 rad'}"],
        "`operating.load`: is missing; give it, a list of loads, or `approach`",
    ),
    "negative load": (
        ["operating.load=-3 kN"],
        "`operating.load`: -3000 N must be above 0",
    ),
    "negative load in a list": (
        ["operating.load=['3 kN', '0 N']"],
        "`operating.load`: 0 N must be above 0",
    ),
    "empty list": (
        ["operating.load=[]"],
        "`operating.load`: is an empty list; give one load at least",
    ),
    "moment and tilt": (
        ["operating.moment=1 N m"],
        "`operating.tilt`: give either `moment` or this, not both",
    ),
    "moment of an approach": (
        ["operating={approach='5 um', moment='1 N m'}"],
        "`operating.moment`: goes with `load`; an approach has a `tilt`",
    ),
    "tilt of a fall": (
        ["operating.tilt=10 deg"],
        "`operating.tilt`: 0.174533 rad is not allowed; below 0.1 rad in size",
    ),
    "too few cells": (
        ["numerics.across=2"],
        "`numerics.across`: 2 is not a whole number of at least 3",
    ),
    "too many cells": (
        ["numerics.across=2001"],
        "`numerics.across`: 2001 is too many cells; at most 1001",
    ),
    "too many graded cells": (
        ["numerics.along=4000"],
        "`numerics.along`: 4000 cells take too much memory, graded or with free ends;"
        " fewer graded ones do as well, or take `grading` = 1 without free ends",
    ),
    "too many cells with free ends": (
        ["numerics.along=4000", "numerics.grading=1", "roller.free_ends=true"],
        "`numerics.along`: 4000 cells take too much memory, graded or with free ends;",
    ),
    "free ends": (
        ["roller.free_ends=2"],
        "`roller.free_ends`: ",
    ),
    "grading": (
        ["numerics.grading=0.5"],
        "`numerics.grading`: 0.5 is not allowed; from 1 (even cells) to 4",
    ),
    "wider than the roller": (
        ["numerics.half_width=6 mm"],
        "`numerics.half_width`: 6 mm is wider than the roller or its raceway",
    ),
    "law that is not of independent slices": (
        ["contact.line_law=lundberg"],
        "`contact.line_law`: 'lundberg' is not known; it must be one of palmgren,",
    ),
    "no tolerance": (
        ["numerics.tolerance=0"],
        "`numerics.tolerance`: 0 is not allowed; from 1e-14 to below 0.01",
    ),
    "field that is a word": (
        ["output.field='yes'"],
        "`output.field`: 'yes' is not true or false",
    ),
}


@pytest.fixture
def no_solve(monkeypatch):
    """Whatever is refused is refused before anything is solved."""

    def refuse(scene):
        raise AssertionError("solved a contact")

    monkeypatch.setattr(bj.scene, "run_contact", refuse)


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.usefixtures("no_solve")
@pytest.mark.parametrize("settings, message", WRONG.values(), ids=WRONG)
def test_wrong_scenes(run, tmp_path, settings, message):
    out = tmp_path / "out.json"
    changes = [word for text in settings for word in ("--set", text)]
    done = run("contact", "taper_contact", *changes, "--json", out)
    assert done.status == 2 and done.out == "" and done.err.count("\n") == 1
    assert done.err.startswith(f"bearingjax: taper_contact.toml: {message}")
    assert not out.exists()


def test_read_contact_without_roller_or_file(tmp_path):
    path = tmp_path / "empty.toml"
    path.write_text("[operating]\nload = '1 kN'\n", encoding="utf-8")
    with pytest.raises(SceneError, match=r"^empty\.toml: `roller`: is missing"):
        read_contact(path)
    with pytest.raises(SceneError, match=r"^none\.toml: no such file"):
        read_contact("none.toml")


@pytest.mark.slow
def test_contact_command_writes_json_and_plot(run, rerun, tmp_path):
    out, picture = tmp_path / "out.json", tmp_path / "out.png"
    done = run(*TAPER, "--json", out, "--plot", picture)
    assert done.status == 0
    numbers = read(out)
    assert numbers["result"] == ["converged"] * 5
    assert len(numbers["approach"]) == 5
    assert done.out.startswith("taper_contact: roller 10 to 12 x 15 mm")
    assert "\nconverged in " in done.out and done.err == ""
    # Warnings stand below the report, and in the file.
    said = [line for line in done.out.splitlines() if line.startswith("warning: ")]
    assert said == [f"warning: {text}" for text in numbers["warnings"]]
    assert len(said) == 2 and "make 3.814 deg" in said[0] and "end cell" in said[1]
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert picture.stat().st_size > 50_000
    rerun("contact", out)


@pytest.mark.parametrize(
    "settings, label",
    [
        (["numerics.max_steps=1"], "step_limit"),
        (["operating={load='3 kN', moment='30 N m'}"], "no_load_path"),
        (["numerics.half_width=0.03 mm"], "grid_misfit"),
    ],
)
@pytest.mark.slow
def test_contact_command_unsolved_case(run, tmp_path, settings, label):
    out, picture = tmp_path / "out.json", tmp_path / "out.png"
    picture.write_text("of an earlier run", encoding="utf-8")
    changes = [word for text in settings for word in ("--set", text)]
    done = run(*ONE, *changes, "--json", out, "--plot", picture)
    assert done.status == 3 and done.out == ""
    numbers = read(out)
    assert set(numbers) == WORDS and numbers["result"] == label
    said = done.err.splitlines()
    assert said[-1] == f"bearingjax: {label}: {numbers['message']}"
    assert not picture.exists()


def test_one_load_of_two_not_solved(run, tmp_path):
    """A moment that 3 kN balance, and 100 N do not."""
    out = tmp_path / "out.json"
    both = "operating={load=['100 N', '3 kN'], moment='3 N m'}"
    done = run(*TAPER, "--set", both, "--json", out)
    assert done.status == 3
    numbers = read(out)
    assert numbers["result"] == ["no_load_path", "converged"]
    assert numbers["peak_pressure"][0] is None and numbers["peak_pressure"][1] > 1e9
    assert numbers["line_load"][0] is None
    assert "\n3000 " in done.out and "\n100 " not in done.out
    assert "bearingjax: no_load_path: 100 N: No pressure carries this" in done.err


@pytest.mark.usefixtures("no_solve")
def test_contact_command_rejects_unwritable_output(run, tmp_path):
    path = tmp_path / "none" / "out.png"
    for option in ("--json", "--plot"):
        done = run(*ONE, option, path)
        assert done == (2, "", f"bearingjax: {path}: its folder does not exist\n")
    done = run(*ONE, "--plot", tmp_path / "out.gif")
    assert done.status == 2 and "ends in .png, .pdf or .svg" in done.err


@pytest.mark.slow
def test_contact_command_of_bearing_scene(run, tmp_path):
    """The scene of a bearing: solved, and one of its rollers looked at."""
    out, picture = tmp_path / "out.json", tmp_path / "out.png"
    done = run(
        "contact",
        "cylindrical_rig",
        "--raceway",
        "outer",
        "--free-ends",
        "--json",
        out,
        "--plot",
        picture,
    )
    assert done.status == 0
    assert done.out.startswith("cylindrical_rig, roller 0, outer raceway: roller")
    assert "; free end faces" in done.out
    numbers = read(out)
    solved = bj.scene.run_scene(bj.read_scene("cylindrical_rig"))
    assert numbers["load"] == pytest.approx(float(solved.roller_load[0, 0]), rel=1e-9)
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    done = run("contact", "cylindrical_rig", "--roller", "5")
    assert done.status == 2
    assert "roller 5 bears no load on the inner raceway" in done.err
    done = run("contact", "deep_groove")
    assert done.status == 2 and "the bearing has balls" in done.err
    done = run(*ONE, "--roller", "2")
    assert done.status == 2 and "are for the scene of a bearing" in done.err
    done = run(*ONE, "--free-ends")
    assert done.status == 2 and "has `free_ends` in its [roller]" in done.err

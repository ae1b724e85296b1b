"""Scenes of one contact: what is read, solved, written and said.

Compared with the published case of method 004 (Mi & Xia 2011, 35 x 35 cells, two
independent solvers agree to 1e-5), with Hertz's line contact, with slices computed here
in NumPy, and one load alone with the same load among others.
"""

import json
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import theirs
from runs import SEARCH, WORDS, Runs, Study
from tolerances import PUBLISHED, QUADRATURE_FORCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.contact.halfspace import RollerContact
from bearingjax.contact.slices import slices
from bearingjax.studies.contact.read import read_contact
from bearingjax.studies.contact.report import (
    contact_as_dict,
    contact_report,
    contact_warnings,
)
from bearingjax.studies.contact.run import run_contact
from bearingjax.studies.solve.run import run_scene

SMALL = ("numerics.across=9", "numerics.along=12")
PAPER = (
    "numerics.along=35",
    "numerics.grading=1",
    "numerics.half_width=0.1764 mm",
    "operating.load=3 kN",
)
CYLINDER = """
[roller]
length = "15 mm"
diameter = "10 mm"
profile = { type = "circular_crown", crown_radius = "3 m" }

[operating]
load = "2 kN"

[numerics]
across = 9
along = 12
"""


def near(value):
    return pytest.approx(value, rel=ROUNDING, abs=0.0)


def solve(name, *settings):
    """Scene, its cases, and what is written of them."""
    scene = read_contact(name, settings)
    cases = run_contact(scene)
    return scene, cases, contact_as_dict(scene, cases)


@pytest.fixture(scope="module")
def cylinder(tmp_path_factory):
    path = tmp_path_factory.mktemp("scenes") / "cylinder.toml"
    path.write_text(CYLINDER, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def paper():
    return solve("taper_contact", *PAPER)


@pytest.fixture(scope="module")
def three():
    loads = 'operating.load=["500 N", "1 kN", "2 kN"]'
    return solve("taper_contact", *SMALL, loads)


def test_shipped_scene_is_the_published_case():
    scene = read_contact("taper_contact")
    contact = scene.contact
    pressed, cells = scene.operating, scene.numerics
    assert pressed.loads == (1e3, 2e3, 3e3, 4e3, 5e3) and pressed.listed
    assert (cells.across, cells.along, cells.grading) == (35, 64, 2.0)
    assert float(contact.roller_length) == near(0.015)
    assert float(contact.small_diameter) == near(0.010)
    assert float(contact.large_diameter) == near(0.012)
    assert float(contact.half_angle) == near(np.deg2rad(3.0))
    assert float(contact.modulus) == near(210e9 / (2 * (1 - 0.3**2)))
    assert np.isinf(contact.raceway_radius)
    (warning,) = scene.warnings
    assert "half angle is 3°" in warning and "make 3.814°" in warning


def test_read_contact_cylinder_defaults(cylinder):
    scene = read_contact(cylinder)
    contact = scene.contact
    assert scene.warnings == () and not scene.operating.listed
    assert float(contact.small_diameter) == float(contact.large_diameter) == 0.010
    assert contact.half_angle is None and float(contact.angle) == 0.0
    assert isinstance(contact.roller_profile, bj.CircularCrown)
    assert isinstance(contact.raceway_profile, bj.Straight)
    assert isinstance(scene.law, bj.contact.Palmgren)
    assert scene.operating.tilt is None and not scene.field
    assert scene.numerics.half_width is None and scene.numerics.max_steps == 500


@pytest.mark.parametrize("side, sign", [("inner", 1.0), ("outer", -1.0)])
def test_raceway(cylinder, side, sign):
    """The radius normal to the generatrix of a cone is d/(2 cos t)."""
    settings = (
        f"raceway.side={side}",
        "raceway.diameter=80 mm",
        "raceway.half_angle=11 deg",
        "raceway.material=silicon_nitride",
    )
    scene = read_contact(cylinder, settings)
    radius = sign * 0.040 / np.cos(np.deg2rad(11.0))
    assert float(scene.contact.raceway_radius) == near(radius)
    assert float(scene.contact.raceway_half_angle) == near(np.deg2rad(11.0))
    assert float(scene.contact.raceway_material.elastic_modulus) == 310e9


def test_raceway_of_the_rollers_material(cylinder):
    scene = read_contact(cylinder, ["roller.material=zirconia"])
    assert float(scene.contact.raceway_material.elastic_modulus) == 205e9


def test_published_numbers(paper):
    """The numbers are the validation cases `mi_xia_taper`, `mi_xia_taper_middle`."""
    _, _, numbers = paper
    assert numbers["result"] == "converged" and numbers["version"] == bj.__version__
    of_paper = partial(theirs, "mi_xia_taper")
    assert numbers["approach"] == pytest.approx(of_paper("approach")[2], rel=1e-5)
    pressure = np.array(numbers["centre_pressure"])
    # From the small end, which is at positive positions.
    ends = [of_paper(f"pressure of the {end} end")[2] for end in ("small", "large")]
    assert pressure[[-1, 0]] == pytest.approx(ends, rel=1e-5)
    assert numbers["cell_width"] == near(2 * 0.1764e-3 / 35)
    assert numbers["end_cell_length"] == near(0.015 / 35)
    lever = np.array(numbers["cell_length"]) * np.array(numbers["position"])
    moment = np.sum(lever * numbers["line_load"])
    assert numbers["moment"] == pytest.approx(moment, abs=3000 * 0.0075 * ROUNDING)
    # The peak with its place and cell; Hertz's at the small end, R = d/(2 cos t).
    assert numbers["peak_pressure"] == pressure[-1]
    assert numbers["peak_position"] == near(0.0075 - 0.5 * 0.015 / 35)
    assert numbers["peak_cell_length"] == near(0.015 / 35)
    assert numbers["load"] == near(3000.0) and numbers["tilt"] == 0.0
    assert any("make 3.814°" in text for text in numbers["warnings"])
    assert any("an end cell, 428.6 µm long" in text for text in numbers["warnings"])
    json.dumps(numbers, allow_nan=False)


def test_slices_of_a_straight_roller(paper):
    """Even line load; Palmgren's approach; Hertz's pressure at each place."""
    _, _, numbers = paper
    sliced = numbers["slices"]
    assert np.allclose(sliced["line_load"], 200e3, rtol=QUADRATURE_FORCE)
    y = np.array(numbers["position"])
    radius = (0.011 - 0.002 / 0.015 * y) / (2 * np.cos(np.deg2rad(3.0)))
    modulus = 210e9 / (2 * (1 - 0.3**2))
    approach = 3.81 * (3000.0 / (np.pi * modulus)) ** 0.9 / 0.015**0.8
    assert sliced["approach"] == pytest.approx(approach, rel=QUADRATURE_FORCE)
    hertz = np.sqrt(200e3 * modulus / (np.pi * radius))
    assert np.allclose(sliced["contact_pressure"], hertz, rtol=QUADRATURE_FORCE)
    assert sliced["peak_pressure"] == sliced["contact_pressure"][-1]
    factor = numbers["peak_pressure"] / sliced["peak_pressure"]
    assert numbers["edge_factor"] == near(factor)


@pytest.mark.slow
def test_free_ends(three):
    """Softer, and with less at the ends, which the report says."""
    loads = 'operating.load=["500 N", "1 kN", "2 kN"]'
    scene, cases, freed = solve("taper_contact", *SMALL, loads, "roller.free_ends=true")
    held = three[2]
    assert np.all(np.array(freed["approach"]) > 1.02 * np.array(held["approach"]))
    ends, before = (np.array(v["centre_pressure"])[:, [0, -1]] for v in (freed, held))
    assert np.all(ends < 0.8 * before)
    np.testing.assert_allclose(freed["load"], held["load"], rtol=SOLVER)
    assert "; free end faces" in str(contact_report(scene, cases))
    assert "free end" not in str(contact_report(*three[:2]))


@pytest.mark.parametrize("tilt", [0.0, 2e-4, -5e-3])
def test_slices_of_a_tilted_crown(tilt):
    """Load and law again in NumPy, over 40 000 slices; also where part is open."""
    contact = RollerContact(0.015, 0.010, 0.010, roller_profile=bj.CircularCrown(30.0))
    y = (np.arange(40_000) + 0.5) * 0.015 / 40_000 - 0.0075
    found = slices(contact, 2000.0, tilt, jnp.asarray(y))
    line = np.asarray(found.line_load)
    assert line.mean() * 0.015 == pytest.approx(2000.0, rel=QUADRATURE_FORCE)
    compliance = 2 * (1 - 0.3**2) / (np.pi * 206e9)
    constant = (3.81 * compliance**0.9) ** (-10 / 9) * 0.015 ** (-1 / 9)
    drop = 30.0 - np.sqrt(900.0 - y**2)
    approach = np.maximum(float(found.approach) + tilt * y - drop, 0.0)
    assert np.allclose(line, constant * approach ** (10 / 9), rtol=1e-8, atol=1.0)
    assert (line == 0).any() == (tilt == -5e-3)


def test_slices_are_differentiable_both_ways():
    """Drops all deeper by δ: the approach is larger by δ."""
    s = np.linspace(-0.0075, 0.0075, 21)
    y = jnp.asarray(s)

    def approach(drops):
        profile = bj.Tabulated(s, drops)
        contact = RollerContact(0.015, 0.010, 0.010, roller_profile=profile)
        return slices(contact, 2000.0, 1e-4, y).approach

    drops = jnp.asarray(0.1 * s**2)
    value, slopes = jax.jit(jax.value_and_grad(approach))(drops)
    # Load and stiffness are integrals of their own.
    assert float(jnp.sum(slopes)) == pytest.approx(1.0, rel=QUADRATURE_FORCE)
    _, along = jax.jvp(approach, (drops,), (drops,))
    assert float(along) == pytest.approx(float(slopes @ drops), rel=SOLVER)
    assert float(value) > 0.0


def test_slices_by_another_law(cylinder):
    change = ("contact.line_law=iso16281",)
    _, (plain,), _ = solve(cylinder)
    scene, (iso,), _ = solve(cylinder, *change)
    assert isinstance(scene.law, bj.contact.ISO16281)
    # 3.8 % apart in stiffness.
    ratio = float(iso.slices.approach / plain.slices.approach)
    assert 0.9 < ratio < 1.0 or 1.0 < ratio < 1.1
    assert np.array_equal(iso.solution.pressure, plain.solution.pressure)


def test_half_width_is_hertz_in_the_middle(cylinder):
    """Of a long crown: each section as an endless roller under its line load."""
    settings = ("numerics.across=35", "roller.profile.crown_radius=30 m")
    scene, (case,), numbers = solve(cylinder, *settings)
    line, modulus = np.array(numbers["line_load"])[5], float(scene.contact.modulus)
    want = np.sqrt(4 * line * 0.005 / (np.pi * modulus))
    assert numbers["half_width"][5] == pytest.approx(want, rel=0.02)


def test_loads_of_a_list(three):
    """Each as if it were alone; position stands once."""
    scene, cases, numbers = three
    assert np.shape(numbers["position"]) == (12,)
    assert np.shape(numbers["centre_pressure"]) == (3, 12)
    assert numbers["load"] == pytest.approx([500.0, 1000.0, 2000.0], rel=ROUNDING)
    assert numbers["result"] == ["converged"] * 3
    assert [s["peak_pressure"] for s in numbers["slices"]] == [
        float(case.slices.peak_pressure) for case in cases
    ]
    _, _, alone = solve("taper_contact", *SMALL, "operating.load=1 kN")
    assert alone["line_load"] == pytest.approx(numbers["line_load"][1], rel=SOLVER)
    assert alone["approach"] == pytest.approx(numbers["approach"][1], rel=SOLVER)
    assert alone["iterations"] == numbers["iterations"][1]


def test_given_motion_gives_the_load_back(cylinder):
    width = "numerics.half_width=0.2 mm"
    _, _, loaded = solve(cylinder, width, "operating.moment=0.5 N m")
    assert loaded["moment"] == pytest.approx(0.5, rel=1e-8) and loaded["tilt"] > 0
    approach, tilt = loaded["approach"], loaded["tilt"]
    motion = f"operating={{approach='{approach!r} m', tilt='{tilt!r} rad'}}"
    _, _, moved = solve(cylinder, width, motion)
    assert moved["load"] == pytest.approx(2000.0, rel=1e-7)
    assert moved["moment"] == pytest.approx(0.5, rel=1e-6)


def test_whole_field(cylinder):
    _, (case,), numbers = solve(cylinder, "output.field=true")
    assert set(numbers["field"]) == {"x", "pressure"}
    pressure = np.array(numbers["field"]["pressure"])
    assert pressure.shape == (5, 12) and numbers["field"]["x"][0] == 0.0
    # Cells beside the middle stand for two.
    times = np.array([1.0, 2.0, 2.0, 2.0, 2.0])
    line = numbers["cell_width"] * times @ pressure
    assert np.allclose(line, numbers["line_load"], rtol=ROUNDING)


def test_grid_too_narrow_is_said(cylinder):
    scene, cases, numbers = solve(cylinder, "numerics.half_width=0.03 mm")
    assert numbers["result"] == "grid_misfit" and "peak_pressure" not in numbers
    assert "reaches the sides" in numbers["message"]
    (warning,) = contact_warnings(scene, cases)
    assert "2000 N: the contact reaches the sides of the grid" in warning
    assert "larger `numerics.half_width`" in warning
    assert numbers["warnings"] == [warning]


def test_few_cells_are_said(cylinder):
    """Three across: an answer, but a rough one."""
    scene, cases, numbers = solve(cylinder, "numerics.half_width=0.5 mm")
    assert numbers["result"] == "converged"
    (warning,) = contact_warnings(scene, cases)
    assert warning.startswith("2000 N: the contact is less than 5 cells wide or long")


def test_contact_too_wide_for_half_spaces_is_said(cylinder):
    """Not of 2 kN, whose contact is a fiftieth of the radius wide."""
    scene, cases, _ = solve(cylinder, "operating.load=500 kN")
    assert cases[0].half_width.max() > 0.2 * 0.005
    said = contact_warnings(scene, cases)
    assert said[0].startswith("5e+05 N: the contact is too wide beside the roller")
    scene, cases, _ = solve(cylinder)
    assert contact_warnings(scene, cases) == []


def test_no_contact_is_said(cylinder):
    scene, cases, numbers = solve(cylinder, 'operating={approach="-5 um"}')
    assert numbers["load"] == 0.0 and numbers["peak_position"] is None
    assert numbers["edge_factor"] is None
    assert numbers["warnings"] == ["approach -5 um: the bodies do not touch"]
    assert " - " in str(contact_report(scene, cases))


def test_report_says_the_same(three):
    scene, cases, numbers = three
    text = str(contact_report(scene, cases))
    lines = text.partition("warning: ")[0].splitlines()
    assert lines[0].startswith("taper_contact: roller 10 to 12 x 15 mm, half angle 3")
    rows = [line.split() for line in lines if line.startswith((" 500 ", "1000 "))]
    assert float(rows[0][0]) == 500 and len(rows[0]) == 9
    assert float(rows[1][1]) == pytest.approx(1e6 * numbers["approach"][1], rel=1e-4)
    assert float(rows[1][4]) == pytest.approx(
        1e-6 * numbers["peak_pressure"][1], rel=PUBLISHED
    )
    assert float(rows[1][6]) == pytest.approx(1e6 * numbers["end_cell_length"], 1e-3)
    assert float(rows[1][8]) == pytest.approx(numbers["edge_factor"][1], rel=PUBLISHED)
    assert max(map(len, lines[3:])) <= 100


# Of the command.

TAPER = ("contact", "taper_contact", *(w for s in SMALL for w in ("--set", s)))
ONE = (*TAPER, "--set", "operating.load=3 kN")
STUDIES = {
    "five loads": Study(
        TAPER,
        WORDS | SEARCH,
        {"--json": "a.json", "--plot": "a.png"},
        ["converged"] * 5,
        unsolved={
            label: (
                ("--set", "operating.load=3 kN", "--set", setting),
                label,
                f"{label}: ",
            )
            for label, setting in (
                ("step_limit", "numerics.max_steps=1"),
                ("no_load_path", "operating={load='3 kN', moment='30 N m'}"),
                ("grid_misfit", "numerics.half_width=0.03 mm"),
            )
        },
        slow=(True, True),
    )
}


class TestRuns(Runs):
    """Runs of the command."""


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def test_read_contact_without_roller_or_file(tmp_path):
    path = tmp_path / "empty.toml"
    path.write_text("[operating]\nload = '1 kN'\n", encoding="utf-8")
    with pytest.raises(SceneError, match=r"^empty\.toml: `roller`: is missing"):
        read_contact(path)
    with pytest.raises(SceneError, match=r"^none\.toml: no such file"):
        read_contact("none.toml")


@pytest.mark.slow
def test_contact_command_of_five_loads(written):
    done, numbers, paths = written("five loads")
    assert len(numbers["approach"]) == 5
    assert done.out.startswith("taper_contact: roller 10 to 12 x 15 mm")
    assert "\nconverged in " in done.out
    numeric, ends = numbers["warnings"]
    assert "make 3.814°" in numeric and "end cell" in ends
    assert paths["--plot"].stat().st_size > 50_000


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
    solved = run_scene(bj.read_scene("cylindrical_rig"))
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

"""All commands and the Python API solve the same bearing for the same scene.

A pair on its seats, ground to a preload, warm and turning; and a single bearing on its
seats for skidding, which is of single rows. What every entry point solves is compared
with `preload` and `mount` called one after the other.
"""

import re
from typing import Any

import jax
import numpy as np
import pytest

import bearingjax as bj
from bearingjax import Support
from bearingjax.cli.entry import parser
from bearingjax.cli.execute import Tools
from bearingjax.design import rows_of
from bearingjax.fits import Mounting, radial_clearance
from bearingjax.fits.fits import FitConditions
from bearingjax.optimise.system import element_of, prepare, solved_case
from bearingjax.statics.options import SolveOptions
from bearingjax.studies.cases.life_command import run
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.noise.read import read_noise
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.rotor.read import read_rotor
from bearingjax.studies.rotor.supports import support_of
from bearingjax.studies.skid.read import read_skid
from bearingjax.studies.solve.report import design_sections
from bearingjax.studies.solve.run import run_scene

SPEED = 6000.0 * np.pi / 30.0
BEARING = """
[bearing]
type = "angular_contact_ball"
n_balls = 9
pitch_diameter = "38.5 mm"
ball_diameter = "7.94 mm"
contact_angle = "25 deg"
outer_osculation = 0.53
inner_osculation = 0.52
"""
PAIR = """
[set]
arrangement = "back_to_back"
spacing = "40 mm"
preload_force = "200 N"
"""
SEATS = """
[fit]
bore = "25 mm"
outside_diameter = "52 mm"
housing_diameter = "80 mm"
shaft_interference = "6 um"
housing_interference = "1 um"
ring_width = "15 mm"
[temperature]
inner_ring = "45 °C"
shaft = "45 °C"
"""
OPERATING = """
[operating]
load = { Fy = "-200 N", Fz = "500 N" }
free = ["ux", "uy", "uz"]
inner_speed = "6000 rpm"
"""
TABLES = {
    "rotor": '[rotor]\nspeed = "6000 rpm"\n[[rotor.shaft]]\nlength = "100 mm"\n'
    'outer_diameter = "25 mm"\ndivisions = 2\n[[rotor.bearings]]\nstation = 1\n'
    'bearing = "{path}"\n',
    "cases": '[cases]\ngrid = {{ "operating.load.Fz" = ["400 N", "500 N"] }}\n',
    "designs": '[cases]\ngrid = {{ "temperature.inner_ring" = ["45 °C"] }}\n',
    "optimise": '[optimise]\nobjective = "peak_pressure"\n[optimise.variables]\n'
    '"bearing.ball_diameter" = {{ from = "7 mm", to = "8 mm" }}\n',
    "noise": '[vibration]\nmass = "0.1 kg"\n',
    "skid": '[lubricant]\nname = "MIL-L-23699"\ntemperature = "70 °C"\n[cage]\n'
    "[dynamics]\n",
}


@pytest.fixture
def written(tmp_path):
    """Writes a scene: of a pair, or of a single bearing."""

    def write(table="", pair=True):
        base = BEARING + (PAIR if pair else "") + SEATS
        (tmp_path / "base.toml").write_text(base + OPERATING, encoding="utf-8")
        operating = OPERATING
        if table == "noise":
            operating = re.sub("free = .*\n", "", operating)
        own = TABLES.get(table, "").format(path="base.toml")
        text = own if table == "rotor" else base + operating + own
        path = tmp_path / f"{table or 'plain'}.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def by_hand(pair=True):
    """The bearing by the Python API, one step after the other."""
    row = bj.AngularContactBallBearing(
        9,
        0.0385,
        0.00794,
        contact_angle=np.deg2rad(25.0),
        outer_osculation=0.53,
        inner_osculation=0.52,
    )
    bearing = bj.BearingSet.back_to_back(row, spacing=0.040) if pair else row
    element = bj.BearingElement(bearing)
    if pair:
        element = bj.preload(element, 200.0)
    mounting = Mounting(
        bore=0.025,
        outside_diameter=0.052,
        housing_diameter=0.080,
        shaft_interference=6e-6,
        housing_interference=1e-6,
        **({"ring_width": 0.015} if pair else {}),
    )
    warm = FitConditions(inner_ring=25.0, shaft=25.0, speed=SPEED)
    return bj.fits.mount(element.bearing, mounting, warm)


def facts(bearing):
    """Offsets [m], radial clearances [m] and contact angles [rad] of the rows."""
    rows: Any = rows_of(bearing)
    return np.array(
        [
            [row.inner_offset, radial_clearance(row.bearing), row.bearing.contact_angle]
            for row in rows
        ],
        dtype=float,
    )


def of_optimise(path):
    task = read_optimisation(path)
    case = jax.tree.map(lambda leaf: leaf[0], task.cases)
    design = prepare(task.scene.installed, None)
    solved = solved_case(design, case, Support(task.scene.free), SolveOptions(points=2))
    np.testing.assert_allclose(
        facts(element_of(design).bearing), facts(solved.element.bearing), rtol=1e-12
    )
    return solved.element.bearing


def of_rotor(path):
    (mount,) = read_rotor(path).mounts
    support: Any = support_of(mount)
    return support.element.bearing


def of_drawing(path, monkeypatch):
    """What the report of `life` under [cases] draws."""
    monkeypatch.setattr("bearingjax.plot.drawing", lambda bearing, *_: bearing)
    found = run(
        parser().parse_args(["life", str(path)]),
        Tools(False, None, lambda context: None),
    )
    assert found.drawing is not None
    return found.drawing()


ENTRIES = {
    "solve": (
        "",
        lambda path: run_scene(bj.read_scene(path)).element.bearing,
    ),
    "sweep of loads": (
        "cases",
        lambda p: read_cases(p).design_groups[0].element.bearing,
    ),
    "sweep of designs": (
        "designs",
        lambda p: jax.tree.map(
            lambda leaf: leaf[0], read_cases(p).design_groups[0].element.bearing
        ),
    ),
    "optimise": ("optimise", of_optimise),
    "rotor": ("rotor", of_rotor),
    "noise": ("noise", lambda path: read_noise(path).model.element.bearing),
    "random bearings": ("noise", lambda path: read_noise(path).line.element.bearing),
}


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.slow
def test_every_entry_point_solves_the_same_pair(entry, written):
    table, bearing = ENTRIES[entry]
    np.testing.assert_allclose(
        facts(bearing(written(table))), facts(by_hand()), rtol=1e-9, atol=1e-15
    )


def test_skidding_solves_the_mounted_bearing(written):
    found = read_skid(written("skid", pair=False), steady=True).model.element.bearing
    np.testing.assert_allclose(facts(found), facts(by_hand(False)), rtol=1e-12)


@pytest.mark.slow
def test_reports_show_solved_bearing(written, monkeypatch):
    """Drawing and text under [cases]: offsets of the preload included."""
    path, solved = written("cases"), by_hand()
    np.testing.assert_allclose(
        facts(of_drawing(path, monkeypatch)), facts(solved), rtol=1e-9, atol=1e-15
    )
    angle = np.rad2deg(facts(solved)[0, 2])
    text: Any
    (text,) = design_sections(read_cases(path).scene)["Bearing"]
    assert f"free contact angle {angle:.4g} deg" in text


def test_the_preload_shifts_the_rows(written):
    """A scene that lost its preload would solve another bearing."""
    unloaded = read_noise(written("noise"), ["set.preload_force=1 N"])
    away = facts(unloaded.model.element.bearing) - facts(by_hand())
    assert (np.abs(away[:, 0]) > 1e-6).all()


def test_conditions_act_on_seats():
    with pytest.raises(ValueError, match="`conditions` are given and `mounting` is"):
        bj.Installed(bj.BearingElement(by_hand()), conditions=FitConditions())

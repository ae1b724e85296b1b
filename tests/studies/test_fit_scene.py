"""[fit] and [temperature] in a scene: what they read, and what is wrong with wrong
ones."""

import dataclasses
import json
import re
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import numpy as np
import pytest

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.cases.sweep import Sweep
from bearingjax.cases.sweep_table import columns
from bearingjax.design import rows_of
from bearingjax.fits import (
    radial_clearance,
    with_bearing_dimensions,
)
from bearingjax.fits.mounting import raceway_diameters
from bearingjax.optimise.design_problem import Problem
from bearingjax.statics.options import SolveOptions
from bearingjax.studies.bearing.catalogue_keys import as_keys
from bearingjax.studies.bearing.fit_report import fit_as_dict, fit_report
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.cases.sweep_run import _on_seats
from bearingjax.studies.noise.read import read_noise
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.optimise.report import _variables
from bearingjax.studies.optimise.scene_of_design import scene_of_design
from bearingjax.studies.rotor.output import rotor_as_dict
from bearingjax.studies.rotor.read import read_rotor
from bearingjax.studies.rotor.report import rotor_report
from bearingjax.studies.rotor.run import RotorRun, task_warnings
from bearingjax.studies.rotor.supports import support_of
from bearingjax.studies.skid.read import read_skid
from bearingjax.studies.solve.report import design_sections

MICRON = 1e-6
REFUSED = Path(__file__).with_name("refused")
BEARING, _, FIT = (REFUSED / "fits.toml").read_text("utf-8").partition("[fit]\n")
FIT = f"[fit]\n{FIT}"
PAIR = BEARING.replace("deep_groove_ball", "angular_contact_ball").replace(
    "\n[operating]",
    'contact_angle = "25 deg"\n\n[set]\narrangement = "back_to_back"\n'
    'spacing = "15 mm"\npreload_offset = "4 um"\n\n[operating]',
)
ROLLERS = """
[bearing]
type = "cylindrical_roller"
n_rollers = 6
pitch_diameter = "38.5 mm"
roller_diameter = "7.5 mm"
roller_length = "9 mm"

[operating]
load = { Fy = "-2 kN" }
free = ["uy"]

[numerics]
quadrature = "midpoint"
points = 5

[output]
points = 2
"""


@pytest.fixture
def scene(tmp_path):
    """Write a scene, and get its path."""

    def write(text):
        path = tmp_path / "fits.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def clearance(element):
    row: Any = rows_of(element.bearing)[0].bearing
    return float(row.radial_internal_clearance)


def test_the_usual_fits_of_a_6205(scene):
    read = bj.read_scene(scene(BEARING + FIT))
    assert read.warnings == ()
    assert clearance(read.element) == pytest.approx(12.5 * MICRON)
    found = read.fit_states
    # Of 2 to 21 µm of interference 25/30.56 reach the raceway; H7 takes nothing.
    share = 25 / 30.56
    worst = np.array([5 - 21 * share, 20 - 2 * share]) * MICRON
    np.testing.assert_allclose(found.mounted_range.worst, worst, rtol=1e-9)
    np.testing.assert_allclose(found.operating_range.worst, worst, rtol=1e-9)
    left = (12.5 - 11.5 * share) * MICRON
    assert clearance(read.running()) == pytest.approx(left, rel=1e-9)


def test_states_and_warnings_of_a_bearing_installed_by_hand(scene):
    """Those of the scene: its JSON, and what it warns of."""
    fit = 'shaft = "k5"\nhousing = "H7"\nhousing_diameter = "80 mm"\n'
    warm = 'inner_ring = "90 °C"\nshaft = "70 °C"\nhousing = "60 °C"'
    text = f'[bearing]\ndesignation = "6205/C3"\n[fit]\n{fit}[temperature]\n{warm}\n'
    running = '[operating]\nload = { Fy = "-1 kN" }\ninner_speed = "30000 rpm"\n'
    read = bj.read_scene(scene(text + running))
    entry = bj.catalogue.catalogue_entry("6205/C3")
    bore, outside = entry.bore, entry.outside_diameter
    limits = bj.fits.SizeLimits(
        bj.fits.ball_clearance("C3", bore),
        bj.fits.limits("k5", bore),
        bj.fits.bore_limits(bore),
        bj.fits.limits("H7", outside),
        bj.fits.outside_limits(outside),
    )
    bearing = bj.load_bearing("6205/C3")
    given = bj.Mounting(bore, outside, 0.08, 0.0, 0.0)
    seats = bj.fits.mounting_at(
        with_bearing_dimensions(given, bearing), "middle", *limits
    )
    bearing = bj.fits.with_radial_clearance(bearing, seats.radial_clearance)
    kelvin = dict(reference=293.15, elements=293.15, outer_ring=293.15)
    kelvin |= dict(inner_ring=363.15, shaft=343.15, housing=333.15)
    speed = bj.Speed(30000 * np.pi / 30)
    own = bj.Installed(
        bj.BearingElement(bearing),
        None,
        seats,
        bj.FitConditions(**kelvin, speed=speed.inner),
        limits,
        entry.limiting_speed,
        entry.reference_speed,
    )
    assert len(read.warnings) > 2
    assert own.warnings(speed) == list(read.warnings)
    told, mine = (
        fit_as_dict(one) for one in (read, dataclasses.replace(read, installed=own))
    )
    assert told.pop("place") == mine.pop("place") == "middle"
    flat: Any = [jax.tree.leaves(one) for one in (told, mine)]
    assert len(flat[0]) == 23
    np.testing.assert_allclose(*flat, rtol=1e-9)


def test_seats_of_another_size_than_the_designation_are_warned_of(scene):
    sizes = 'bore = "27 mm"\noutside_diameter = "52 mm"\n'
    fit = f'{sizes}housing_diameter = "80 mm"\nshaft = "k5"\nhousing = "H7"\n'
    text = f'[bearing]\ndesignation = "6205"\n[operating]\nload = {{}}\n[fit]\n{fit}'
    (told,) = bj.read_scene(scene(text)).warnings
    assert told.startswith("fit: `bore` is 27 mm, but that of 6205 is 25 mm, which its")
    assert bj.read_scene(scene(text), ["fit.bore=25 mm"]).warnings == ()


def test_fit_of_catalogue_bearing(scene):
    text = FIT.replace('bore = "25 mm"\noutside_diameter = "52 mm"\n', "").replace(
        'clearance = "CN"\n', ""
    )
    path = scene('[bearing]\ndesignation = "6205/C3"\n' + text)
    read = bj.read_scene(path, ["fit.at=tightest"])
    assert float(read.installed.mounting.bore) == 0.025
    assert float(read.installed.mounting.outside_diameter) == pytest.approx(0.052)
    wanted = bj.fits.ball_clearance("C3", 0.025)
    assert read.installed.limits.clearance == pytest.approx(wanted)
    assert clearance(read.element) == pytest.approx(wanted.lower)
    assert read.inputs["fit"]["clearance"] == "C3"
    other = bj.read_scene(path, ["bearing.radial_internal_clearance=9 um"])
    assert other.installed.limits.clearance == pytest.approx((9e-6, 9e-6))
    wide = bj.read_scene(path, ["fit.clearance=C4"]).installed
    wanted = bj.fits.ball_clearance("C4", 0.025)
    assert wide.limits.clearance == pytest.approx(wanted)
    motor = scene(path.read_text().replace("6205/C3", "6205/CM"))
    read = bj.read_scene(motor)
    assert read.installed.limits.clearance == bj.fits.ball_clearance("CM", 0.025)
    # What is echoed can be read again.
    assert bj.read_scene(motor, [f"fit.clearance={read.inputs['fit']['clearance']}"])
    with pytest.raises(SceneError, match="`fit.housing_diameter`: is missing"):
        bj.read_scene(scene(path.read_text().replace('housing_diameter = "80 mm"', "")))


@pytest.mark.parametrize("place, left", [("tightest", 0), ("loosest", 1)])
def test_ends_of_the_tolerances(scene, place, left):
    read = bj.read_scene(scene(BEARING + FIT), [f"fit.at={place}"])
    found = read.fit_states
    mounted = clearance(read.running())
    assert mounted == pytest.approx(found.mounted_range.worst[left], rel=1e-9)


def test_given_numbers(scene):
    text = BEARING + FIT.replace('clearance = "CN"', "").replace(
        'shaft = "k5"\nhousing = "H7"',
        'shaft_interference = "12 um"\nhousing_interference = "20 um"\n'
        'shaft_bore = "10 mm"\nshaft_material = "aluminium"\n'
        'housing_material = { elastic_modulus = "45 GPa", poisson_ratio = 0.35,'
        ' density = "1800 kg/m^3", expansion = "26e-6 1/K" }\n'
        'shaft_roughness = "4 um"\nring_roughness = "2 um"\n'
        'inner_raceway = "31 mm"\nelement_expansion = "3.2e-6 1/K"\n',
    ).replace(
        "[fit]", '[temperature]\nreference = "25 degC"\nshaft = "333.15 K"\n[fit]'
    )
    read = bj.read_scene(
        scene(text),
        [
            "bearing.radial_internal_clearance=15 um",
            "operating.inner_speed=100 rad/s",
            "operating.outer_speed=20 rad/s",
        ],
    )
    seats, warm = read.installed.mounting, read.installed.conditions
    assert float(seats.shaft_interference) == pytest.approx(12 * MICRON)
    assert float(seats.housing_interference) == pytest.approx(20 * MICRON)
    assert float(seats.shaft_bore) == 0.010
    assert float(seats.shaft_smoothing) == pytest.approx(2.4 * MICRON)
    assert float(seats.housing_smoothing) == 0.0
    assert float(seats.inner_raceway) == 0.031 and seats.outer_raceway is None
    assert float(seats.shaft.expansion) == 23e-6
    assert float(seats.housing.material.elastic_modulus) == 45e9
    assert float(seats.housing.expansion) == 26e-6
    assert float(seats.elements.expansion) == 3.2e-6
    assert float(warm.shaft) == 333.15 and float(warm.reference) == 298.15
    assert float(warm.inner_ring) == float(warm.housing) == 298.15
    assert float(warm.speed) == 100.0 and float(warm.outer_speed) == 20.0
    assert read.fit_states.free == 15e-6


TAPERED = """
[bearing]
designation = "{}"

[operating]
load = {{ Fy = "-42 kN" }}
prescribed = {{ gx = "0 deg", gy = "0 deg" }}

[fit]
{}
housing_interference = "-20 um"
housing_diameter = "270 mm"
"""


def test_fit_rejects_housing_in_another_unit(scene):
    text = TAPERED.format("22220 EK", 'drive_up = "0.6 mm"')
    with pytest.raises(bj.files.SceneError, match="housing_diameter.*unit meant"):
        bj.read_scene(scene(text.replace('"270 mm"', '"270 m"')))


def test_fit_drive_up_of_tapered_bore(scene):
    text = TAPERED.format("22220 EK", 'drive_up = "0.6 mm"')
    read = bj.read_scene(scene(text))
    facts = read.fit_states
    assert read.inputs["fit"]["bore_taper"] == "1:12"
    interference = float(facts.mounted.shaft_interference)
    assert interference == pytest.approx(0.6e-3 / 12, rel=1e-12)
    # Steel on steel: d/F of it, with the bore in the middle of the width of 46 mm.
    raceway = float(raceway_diameters(rows_of(read.element.bearing)[0].bearing)[0])
    share = (0.1 + 0.046 / 24) / raceway
    taken = facts.free - float(facts.mounted.radial_clearance)
    assert taken == pytest.approx(share * interference, rel=1e-9)
    told = fit_as_dict(read)
    assert told["drive_up"] == pytest.approx(0.6e-3)
    assert told["bore_taper"] == pytest.approx(1 / 12)
    words = "\n".join(str(part) for part in fit_report(read))
    assert "1:12: driven up by 0.6 mm, an interference of 50 µm" in words
    # And what takes 45 µm.
    wanted = TAPERED.format("24120 CCK30", 'clearance_reduction = "45 um"')
    other = bj.read_scene(scene(wanted))
    facts = other.fit_states
    taken = facts.free - float(facts.mounted.radial_clearance)
    assert taken == pytest.approx(45e-6, rel=1e-9)
    assert float(other.installed.mounting.bore_taper) == pytest.approx(1 / 30)


def test_classes_of_a_tapered_bore_without_a_designation(scene):
    entry = bj.catalogue_entry("22220 E")
    keys = "\n".join(
        f'{k} = "{v}"' if isinstance(v, str) else f"{k} = {v}"
        for k, v in as_keys(entry.design).items()
        if k != "radial_internal_clearance"
    )
    sizes = 'bore = "100 mm"\noutside_diameter = "180 mm"\nclearance = "C3"\n'
    seat = f'{sizes}bore_taper = "1:12"\ndrive_up = "0.6 mm"'
    text = TAPERED.format("22220", seat).replace('designation = "22220"', keys)
    limits = bj.read_scene(scene(text)).installed.limits.clearance
    wanted = bj.fits.spherical_roller_clearance("C3", 0.1, tapered=True)
    np.testing.assert_allclose(limits, wanted)
    for line in ('bore_taper = "1:12"', 'drive_up = "0.6 mm"'):
        text = text.replace(line, "" if "taper" in line else 'shaft = "m5"')
    limits = bj.read_scene(scene(text)).installed.limits.clearance
    wanted = bj.fits.spherical_roller_clearance("C3", 0.1)
    np.testing.assert_allclose(limits, wanted)


def test_the_drive_up_varies_and_is_sought(scene):
    text = TAPERED.format("1205 EK", 'drive_up = "0.1 mm"').replace("-42 kN", "-1 kN")
    text = text.replace('"270 mm"', '"80 mm"')
    grid = '[cases.grid]\nfit.drive_up = ["0.1 mm", "0.2 mm"]\n'
    table = read_cases(scene(text + grid))
    row: Any = rows_of(table.design_groups[0].element.bearing)[0].bearing
    left = row.radial_internal_clearance
    seats = table.scene.installed.mounting
    inner = float(raceway_diameters(rows_of(bj.load_bearing("1205 EK"))[0].bearing)[0])
    share = (float(seats.bore) + 0.5 * 0.015 / 12) / inner
    assert left[0] - left[1] == pytest.approx(0.1e-3 / 12 * share, rel=1e-6)
    task = text + '[optimise]\nobjective = "peak_pressure"\n[optimise.variables]\n'
    task += '"fit.drive_up" = { from = "0 mm", to = "0.2 mm" }\n'
    (variable,) = read_optimisation(scene(task)).variables
    assert variable.path == ("mounting.drive_up",)


def test_hybrid_balls_expand_less(scene):
    text = BEARING.replace("n_balls", 'material = "silicon_nitride"\nn_balls')
    text = text.replace("n_balls", 'ring_material = "steel"\nn_balls', 1) + FIT
    seats = bj.read_scene(scene(text)).installed.mounting
    assert float(seats.elements.expansion) == 3.2e-6
    assert float(seats.inner_ring.expansion) == 12e-6
    assert float(seats.elements.material.elastic_modulus) == 310e9


def test_fit_of_pair_changes_inner_offsets(scene):
    settings = ["fit.at=tightest", "fit.shaft=j5"]
    fit = FIT.replace('clearance = "CN"', 'ring_width = "15 mm"')
    read = bj.read_scene(scene(PAIR + fit), settings)
    before, after = read.element.bearing.rows, read.running().bearing
    assert float(before[0].inner_offset) == pytest.approx(2 * MICRON)
    first, second = (float(row.inner_offset) for row in after.rows)
    assert first == -second and first > 8 * MICRON
    assert float(after.rows[0].bearing.contact_angle) < np.deg2rad(25)


@pytest.mark.slow
def test_command_solves_the_mounted_bearing(run, scene, tmp_path):
    out = tmp_path / "out.json"
    warm = "temperature.inner_ring=45 degC", "temperature.shaft=45 degC"
    settings = [word for text in warm for word in ("--set", text)]
    done = run("solve", scene(ROLLERS + FIT), *settings, "--json", out)
    assert done.status == 0 and done.err == ""
    numbers = json.loads(out.read_text())
    found = numbers["fit"]
    share = 25 / 31
    left = found["radial_clearance"]
    assert left["free"] == pytest.approx(32.5 * MICRON)
    assert left["mounted"] == pytest.approx((32.5 - 11.5 * share) * MICRON, rel=1e-9)
    loss = 12e-6 * 25 * 0.031
    assert left["mounted"] - left["operating"] == pytest.approx(loss, rel=1e-9)
    assert found["place"] == "middle" and found["mounted"]["housing_pressure"] == 0.0
    assert found["operating"]["ring_stress"] > 70e6
    assert found["worst"]["mounted"] == pytest.approx(
        [(20 - 21 * share) * MICRON, (45 - 2 * share) * MICRON], rel=1e-9
    )
    for state, left, ends in (
        ("free", "32.5", "-"),
        ("mounted", "23.23", "3.06 to 43.39"),
        ("operating", "13.93", ""),
    ):
        assert re.search(rf"(?m)^{state} +{left} .*{ends}$", done.out), state
    assert "fits: shaft k5, housing H7; sizes of the solve: middle" in done.out
    # The bearing of the solve is the one that is left.
    assert "radial internal clearance 13.93 µm" in done.out


def test_both_clearances_of_a_taper_are_told(scene):
    """As its rollers have it, and as the rings move."""
    seats = """
[bearing]
designation = "30205"
[operating]
load = { Fy = "-2 kN" }
[fit]
shaft_interference = "10 um"
housing_interference = "-10 um"
housing_diameter = "80 mm"
"""
    read = bj.read_scene(scene(seats))
    texts: Any = design_sections(read)
    row = read.running().bearing
    own, radial = float(row.radial_internal_clearance), float(radial_clearance(row))
    assert own < -5 * MICRON and radial / own > 1.02
    words = "internal clearance {:.4g} µm normal to the outer raceway, radially {:.4g}"
    assert words.format(own / MICRON, radial / MICRON) in texts["Bearing"][0]
    own, radial = round(own / MICRON, 2), round(radial / MICRON, 2)
    fits = texts["Fits and clearance"]
    free, mounted, _ = fits[1].rows()
    assert free[:3] == ("free", "0", "0")
    assert mounted[:3] == ("mounted", str(radial), str(own))
    assert fits[1].columns[2].name == "normal to the outer raceway"


def test_cases_vary_fits_temperatures_and_speed(scene):
    grid = (
        '[cases]\ngrid = { fit.shaft = ["j5", "k5"], temperature.inner_ring = ["20'
        ' degC", "40 degC"], operating.inner_speed = { start = "0 rpm", stop ='
        ' "20000 rpm", count = 2 } }\n'
    )
    table = read_cases(scene(BEARING + FIT + grid))
    (structure,) = table.design_groups
    left = np.asarray(structure.element.bearing.radial_internal_clearance)
    assert left.shape == (8,) and np.unique(left.round(12)).size == 8
    assert set(table.settings[0]) == {"fit.shaft", "temperature.inner_ring [K]"}
    design, speed = np.asarray(table.cases.design), np.asarray(table.cases.inner_speed)
    # Fast rings grow: of cases that are else alike the faster has less clearance.
    by_speed = left[design].reshape(4, 2)
    assert (by_speed[:, 1] < by_speed[:, 0]).all()
    assert (speed.reshape(4, 2)[:, 1] > 2000).all()
    # What each case runs with is told, as its own scene tells it.
    count = table.cases.count
    result = {"result": np.where(np.arange(count) == 2, 1, 0)}
    solved = _on_seats(structure, Sweep(table.cases, result, "inner", ()))
    told = columns(solved)["operating_radial_clearance [m]"]
    assert np.isnan(told[2]) and np.isfinite(np.delete(told, 2)).all()
    settings = ["fit.shaft=k5", "temperature.inner_ring=40 degC"]
    fast = bj.read_scene(
        scene(BEARING + FIT), [*settings, "operating.inner_speed=20000 rpm"]
    )
    facts = fast.fit_states
    assert told[7] == pytest.approx(float(facts.operating.radial_clearance), rel=1e-12)
    # Without fits speeds make no designs, and there is no other clearance.
    plain = BEARING + grid.replace(
        'fit.shaft = ["j5", "k5"], temperature.inner_ring = ["20 degC", "40 degC"], ',
        "",
    )
    table = read_cases(scene(plain))
    assert table.cases.design is None
    solved = Sweep(table.cases, {"result": np.zeros(2, int)}, "inner", ())
    assert _on_seats(table.design_groups[0], solved) is solved


def test_fit_key_varied_by_cases_may_be_absent(scene):
    """The first value is the scene's own then; each case has its own all the same."""
    fit = FIT.replace('shaft = "k5"\n', "")
    grid = '[cases.grid]\nfit.shaft_interference = ["4 um", "9 um"]\n'
    table = read_cases(scene(BEARING + fit + grid))
    assert table.scene.inputs["fit"]["shaft_interference"] == "4e-06 m"
    of_scene = table.scene.running().bearing
    left = table.design_groups[0].element.bearing.radial_internal_clearance
    assert float(of_scene.radial_internal_clearance) == float(left[0])
    assert left[0] - left[1] == pytest.approx(5 * MICRON * 25 / 31, rel=0.1)
    given = read_cases(scene(BEARING + fit + grid), ["fit.shaft_interference=7 um"])
    assert given.scene.inputs["fit"]["shaft_interference"] == "7e-06 m"
    np.testing.assert_array_equal(
        given.design_groups[0].element.bearing.radial_internal_clearance, left
    )


def test_interferences_are_variables(scene):
    text = BEARING + FIT + '[optimise]\nobjective = "peak_pressure"\n'
    text += (
        '[optimise.variables]\n"fit.shaft_interference" = { from = "0 um", to ='
        ' "30 um" }\n"bearing.ball_diameter" = { from = "7.8 mm", to = "8 mm" }\n'
    )
    task = read_optimisation(scene(text))
    assert [v.path for v in task.variables] == [
        ("mounting.shaft_interference",),
        ("drawing.bearing.ball_diameter",),
    ]
    left = (12.5 - 11.5 * 25 / 30.56) * MICRON
    assert clearance(task.scene.running()) == pytest.approx(left, rel=1e-9)


def test_a_design_on_seats_at_several_speeds(scene):
    """Each case has the clearance of its speed; warnings are those of the highest."""
    speeds = '"operating.inner_speed" = ["1000 rpm", "30000 rpm", "-40000 rpm"]'
    text = f"{BEARING}{FIT}[cases]\ngrid = {{ {speeds} }}\n"
    text += '[optimise]\nobjective = "peak_pressure"\n[optimise.variables]\n'
    text += '"fit.shaft_interference" = { from = "2 um", to = "20 um" }\n'
    task = read_optimisation(scene(text))
    assert task.cases.count == 3 and task.cases.design is None
    best: Any = scene_of_design(task, task.scene.installed)
    speed = best.installed.conditions.speed
    assert float(speed) == pytest.approx(-40000 * np.pi / 30)
    with pytest.raises(SceneError, match="temperature.shaft vary the design"):
        warm = text.replace(speeds, f'{speeds}, "temperature.shaft" = ["40 °C"]')
        read_optimisation(scene(warm))


def free(scene, settings=(), **bounds):
    """The optimisation of a mounted roller bearing over numbers of its fits."""
    lines = [
        f'"{key}" = {{ from = "{low}", to = "{high}" }}'
        for key, (low, high) in bounds.items()
    ]
    table = '[optimise]\nobjective = "displacement"\nfreedom = "uy"\n'
    table += "\n".join(["[optimise.variables]", *lines])
    text = f"{ROLLERS}{FIT}[temperature]\ninner_ring = '50 °C'\n{table}\n"
    return read_optimisation(scene(text), settings)


@pytest.mark.slow
def test_slopes_by_temperature_interference_and_clearance(scene):
    """Beside differences; and beside what each does to the clearance, by hand."""
    bounds: Any = {
        "temperature.inner_ring": ("20 °C", "80 °C"),
        "temperature.elements": ("20 °C", "80 °C"),
        "fit.shaft_interference": ("2 um", "30 um"),
        "bearing.radial_internal_clearance": ("10 um", "50 um"),
    }
    task = free(scene, **bounds)
    problem = Problem(
        task.scene.installed,
        task.cases,
        task.variables,
        task.objective,
        (),
        SolveOptions(points=2),
        bj.Support(("uy",)),
    )
    start = np.array([v.start_in(problem.element) for v in task.variables])
    np.testing.assert_allclose(start, [323.15, 293.15, 11.5e-6, 32.5e-6])
    middle = problem.to_unit_box(start)

    def tried(unit):
        return problem.evaluate(unit, True)

    slope = tried(middle).slope
    assert slope is not None
    # Fourth order: error step⁴; round-off of 1e-13 over a step of 1e-2.
    step = 1e-2
    for k, along in enumerate(np.eye(len(middle))):
        one, two, three, four = (
            tried(middle + x * step * along).objective for x in (-2, -1, 1, 2)
        )
        difference = (one - 8 * two + 8 * three - four) / (12 * step)
        assert slope[k] == pytest.approx(difference, rel=1e-7)
    # Of rings of one material on a shaft of the same, d/F of an interference is left.
    row: Any = task.scene.element.bearing
    f = float(row.pitch_diameter - row.roller_diameter)
    size = 2 * float(row.roller_diameter) - 32.5e-6
    d, alpha = 0.025, 12e-6
    by_hand = [alpha * (d * d / f - f), -alpha * size, -d / f, 1.0]
    each = slope / problem.width
    np.testing.assert_allclose(each / each[-1], by_hand, rtol=1e-9)


def test_fit_key_optimised_may_be_absent(scene):
    """It begins in the middle of its bounds, or where it is told to; cases have it."""
    text = BEARING + FIT.replace('shaft = "k5"\n', "").replace('housing = "H7"\n', "")
    text += (
        '[cases.grid]\noperating.load.Fy = ["-1 kN", "-2 kN"]\n[optimise]\nobjective ='
    )
    text += ' "peak_pressure"\n[optimise.variables]\n'
    shaft = '"fit.shaft_interference" = { from = "4 um", to = "20 um" }\n'
    housing = '"fit.housing_interference" = { from = "-9 um", to = "3 um", start ='
    task = read_optimisation(scene(f'{text}{shaft}{housing} "-2 um" }}\n'))
    assert [v.start for v in task.variables] == pytest.approx([12e-6, -2e-6])
    assert task.cases.count == 2
    mounting = task.scene.installed.mounting
    assert float(mounting.housing_interference) == -2e-6
    # One of a tolerance class begins where the class has it.
    task = read_optimisation(
        scene(f'{text}{shaft}{housing} "0 um" }}'), ["fit.shaft=k5"]
    )
    assert task.variables[0].start is None
    with pytest.raises(SceneError, match="`fit.shaft`: is missing"):
        read_optimisation(scene(f'{text}{housing} "0 um" }}'))


def test_a_temperature_is_found(scene):
    """How it is read, reported, and what is wrong with wrong ones."""
    bounds: Any = {"temperature.inner_ring": ("20 °C", "80 °C")}
    task = free(scene, **bounds)
    (variable,) = task.variables
    assert variable.path == ("conditions.inner_ring",)
    assert variable.lower == 293.15 and variable.upper == 353.15
    before = SimpleNamespace(values=np.array([323.15]))
    after = SimpleNamespace(values=np.array([293.15]))
    found: Any = SimpleNamespace(
        variables=task.variables,
        element=task.scene.installed,
        before=before,
        after=after,
    )
    (row,) = _variables(found).rows()
    assert row == (
        "temperature.inner_ring",
        "50",
        "20",
        "°C",
        "20 to 80, at the lower one",
    )
    own = "{elastic_modulus='206 GPa', poisson_ratio=0.3, density='7850 kg/m^3'}"
    for settings, key, ends, message in (
        ((), "temperature.inner_ring", ("20 °C", "500 °C"), "500 °C is not allowed"),
        ((), "temperature.inner_ring", ("20 mm", "80 °C"), "'20 mm' is not a temp"),
        ((), "temperature.inner_ring", ("60 °C", "80 °C"), "must lie between its b"),
        ((), "temperature.cage", ("20 °C", "80 °C"), "is not known"),
        (
            (f"bearing.material={own}", "bearing.ring_material=steel"),
            "temperature.elements",
            ("20 °C", "80 °C"),
            "`fit.element_expansion`: is missing: `bearing.material` has numbers",
        ),
    ):
        with pytest.raises(SceneError) as caught:
            free(scene, settings, **{key: ends})
        assert message in str(caught.value)


def test_warnings(scene):
    path = scene(BEARING + FIT)
    (told,) = bj.read_scene(path, ["fit.shaft=p6"]).warnings
    assert told.startswith("fit: the hoop stress of the inner ring is 2")
    assert "MPa mounted, above 127 MPa" in told
    fast = ["operating.inner_speed=100000 rpm"]
    told = bj.read_scene(path, fast).warnings
    assert any("above 127 MPa" in text for text in told)
    creeps = "fit: the inner ring on its shaft turns against the load and is loose by"
    assert any(t.startswith(creeps) and "though tight when mounted" in t for t in told)
    loose = ["fit.shaft=g6", "operating.inner_speed=1000 rpm"]
    (told,) = bj.read_scene(path, loose).warnings
    assert told.startswith(creeps) and "mounted" not in told
    # Under an unbalance the load turns with the shaft: the outer ring creeps.
    assert not [
        t
        for t in bj.read_scene(path, [*loose, "life.load_fixed_to=inner"]).warnings
        if t.startswith(creeps)
    ]
    cold = ["temperature.inner_ring=80 degC"]
    (told,) = bj.read_scene(path, cold).warnings
    assert told.startswith("fit: the inner ring on its shaft is tight when mounted, bu")


def test_exact_sizes_are_told_once_and_round_off_does_not_loosen(scene):
    """Two nominals side by side said nothing; nor did "loose by 2.9e-06 µm"."""
    exact = (
        "bearing.radial_internal_clearance=10 um",
        "fit.clearance=unset",
        "fit.shaft=unset",
        "fit.housing=unset",
        "fit.shaft_interference=0 um",
        "fit.housing_interference=0 um",
        "operating.inner_speed=37 rpm",
    )
    path = scene(BEARING + FIT)
    told = "\n".join(map(str, fit_report(bj.read_scene(path, exact))))
    assert "nominal" in told and "worst" not in told and "middle" not in told
    (word,) = bj.read_scene(path, exact).warnings
    assert "against the load and has no interference in operation: it" in word
    assert "worst" in "\n".join(map(str, fit_report(bj.read_scene(path))))


def test_classes_are_told_by_their_letters(scene):
    with pytest.raises(SceneError) as caught:
        bj.read_scene(scene(BEARING + FIT), ["fit.shaft=K5"])
    message = str(caught.value)
    assert "(did you mean `k5`?); it must be one of d1 to d11, e1 to e11," in message
    assert "k4 to k7" in message and "K3" not in message


def test_read_rotor_with_fits(scene):
    """Each bearing has the clearance of its own fits, at the speed of the rotor."""
    other = scene(BEARING + FIT)
    path = other.with_name("rotor.toml")
    shutil.copy(REFUSED / "fitted_rotor.toml", path)
    # What its own file says of the speed does not count.
    other.write_text(other.read_text().replace("free =", 'inner_speed="1 rpm"\nfree ='))
    task = read_rotor(path)
    speed = 1000.0 * np.pi
    alone = bj.read_scene(other, ["operating.inner_speed=30000 rpm"])
    supports: list[Any] = [support_of(mount) for mount in task.mounts]
    one, two = supports
    assert clearance(one.element) == clearance(alone.running())
    # By hand: of 11.5 µm of interference, less what the speed takes, d/F is left.
    row: Any = task.mounts[1].element.bearing
    d, square = 0.025, 7850.0 * speed**2 / 16.0
    f = float(row.pitch_diameter - row.ball_diameter)
    rise, grown = 25.0 * 12e-6, square / 206e9
    bore = d * grown * (3.3 * f**2 + 0.7 * d**2)
    seat = d * grown * 0.7 * d**2
    raceway = f * grown * (3.3 * d**2 + 0.7 * f**2)
    fit = (11.5e-6 + seat - bore) * d / f
    left = 12.5e-6 - fit - raceway - f * rise
    assert clearance(two.element) == pytest.approx(left, rel=1e-9)
    assert type(two.element.point_law) is bj.contact.ZeroAngle
    # The echo has the bearing of the other scene, with its fits.
    out = path.with_name("away") / "rotor.json"
    out.parent.mkdir()
    out.write_text(json.dumps({"inputs": task.inputs}), encoding="utf-8")
    again: list[Any] = [support_of(mount) for mount in read_rotor(out).mounts]
    for support, other in zip(supports, again, strict=True):
        assert clearance(support.element) == clearance(other.element)


def test_rotor_report_and_warnings_of_fits(scene):
    path = scene(BEARING + FIT).with_name("rotor.toml")
    shutil.copy(REFUSED / "fitted_rotor.toml", path)
    task = read_rotor(path, ["rotor.bearings.0.bearing=own"])
    assert [stations for _, stations in task.seats] == [(0, 1)]
    run = RotorRun(task, None)
    (found,) = rotor_as_dict(run)["fit"]
    assert found["bearing"] == "own" and found["stations"] == [0, 1]
    assert found["speed"] == pytest.approx(1000.0 * np.pi)
    (mount, _), *_ = task.seats
    expected = fit_as_dict(mount.scene)
    assert found | expected == found
    text = str(rotor_report(run))
    assert "own at stations 0, 1, its inner ring turning at 30000 rpm" in text
    assert "fits: shaft k5, housing H7; sizes of the solve: middle" in text
    left = expected["radial_clearance"]
    fast, *_, told = task_warnings(task)
    assert fast.startswith("own: speed of 30000 rpm, above the limiting speed")
    words = f"with the radial clearance at 30000 rpm, {1e6 * left['operating']:.4g} µm"
    assert words in told and "; at 60000 rpm its fits leave " in told
    # Speeds that are not asked for are no matter.
    slow = read_rotor(path, ["rotor.bearings.0.bearing=own", "rotor.campbell.to=1 rpm"])
    still = dataclasses.replace(slow.keys, speed=0.0)
    slow = dataclasses.replace(slow, keys=still)
    assert not list(task_warnings(slow))
    odd = read_rotor(
        path,
        [
            "bearings.own.fit.shaft_bore=10 mm",
            "bearings.own.fit.shaft=p6",
            "rotor.bearings.0.bearing=own",
        ],
    ).warnings
    assert any(text.startswith("own: fit: the hoop stress") for text in odd)
    wanted = (
        "own: its fit has a shaft of 25 mm with a bore of 10 mm (`shaft_bore`); at"
        " station 1 the shaft has 25 and 0 mm"
    )
    assert wanted in odd


@pytest.mark.parametrize("name", ["skid_combined", "noise_deep_groove"])
def test_skidding_and_noise_are_of_the_mounted_bearing(name):
    row: Any = rows_of(bj.load_bearing(name))[0].bearing
    inner, outer = (1e3 * float(x) for x in raceway_diameters(row))
    settings = [
        f"fit.bore={inner - 5} mm",
        f"fit.outside_diameter={outer + 5} mm",
        f"fit.housing_diameter={outer + 40} mm",
        "fit.shaft_interference=4 um",
        "fit.housing_interference=-4 um",
    ]
    read = read_skid if name.startswith("skid") else read_noise
    task: Any = read(name, settings)
    left = float(radial_clearance(task.model.element.bearing))
    taken = float(radial_clearance(row)) - left
    assert 3 * MICRON < taken < 4 * MICRON


LONGEST = """
[life]
[optimise]
objective = "rating_life"
[optimise.variables]
"fit.shaft_interference" = { from = "0 um", to = "30 um", start = "5 um" }
"""


@pytest.mark.slow
def test_optimise_command_life_by_interference(run, scene, tmp_path, untyped):
    """It tells hours, and warns of the seats of the best design, not of the start."""
    turning = BEARING.replace("[operating]", '[operating]\ninner_speed = "1500 rpm"')
    seats = FIT.replace('shaft = "k5"', 'shaft_interference = "20 um"')
    path = scene(turning + seats + LONGEST)
    out, picture = tmp_path / "out.json", tmp_path / "out.png"
    done = run("optimise", path, "--json", out, "--plot", picture)
    assert done.status == 0 and done.err == "" and picture.exists()
    found = json.loads(out.read_text())
    hours, (best,) = found["rating_life"], found["variables"]
    assert hours["after"] > 1.02 * hours["before"] and "maximised" in done.out
    damage = found["objective"]["after"]["exact"]
    assert hours["after"] == pytest.approx(1.0 / damage, rel=1e-12)
    # As the life of a scene with this interference.
    own = f"fit.shaft_interference={best['after']} m"
    alone = run("life", path, "--set", own, "--json", out)
    assert alone.status == 0
    told = json.loads(out.read_text())
    assert told["life_hours"] == pytest.approx(hours["after"], rel=1e-8)
    assert found["fit"] == told["fit"]
    stressed = [text for text in found["warnings"] if "hoop stress" in text]
    assert (found["fit"]["mounted"]["ring_stress"] > 127e6) == bool(stressed)
    assert stressed == [text for text in told["warnings"] if "hoop stress" in text]

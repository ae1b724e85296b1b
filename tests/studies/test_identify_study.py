"""[identify] in scenes, its measured table, and what its command makes of it."""

import dataclasses
import tomllib

import jax
import numpy as np
import pytest
from runs import Runs, Study
from tolerances import SOLVER

import bearingjax as bj
from bearingjax.files import SceneError, shipped_scenes
from bearingjax.optimise import Variable
from bearingjax.optimise.variable import design_numbers, with_values
from bearingjax.studies.identify.read_identify import read_identification
from bearingjax.studies.identify.run import identification_report, run_identification
from bearingjax.studies.identify.subjects import read_setup

FREE = "operating.free=['ux', 'uy']"
SCENE, OUT = "identify_clearance", "displacement_inner_uy"
STUDIES = {
    "clearance": Study(
        ("identify", SCENE),
        files={
            "--json": "a.json",
            "--table": "a.csv",
            "--plot": "a.png",
            "--report": "a.html",
        },
        unsolved={
            "crushed": (
                ("--set", "operating.load.Fx=1e12 N", "--set", FREE),
                "start_not_solved",
                "identify: the start fails: case 0: non_finite: Numbers that are not",
            )
        },
        slow=(True, True),
    )
}


class TestRuns(Runs):
    """Exit status, files, warnings, the run from its JSON, unsolved runs."""


@pytest.mark.slow
def test_numbers_of_the_run(written):
    """The readings were made with 12 um and 0.525, and errors of 0.2 um."""
    numbers = written("clearance").numbers
    names = "bearing.radial_internal_clearance", "bearing.inner_osculation"
    for name, true in zip(names, (12e-6, 0.525), strict=True):
        low, high = numbers["interval"][name]
        assert low < true < high
        half = 0.5 * (high - low) / numbers["standard_error"][name]
        np.testing.assert_allclose(half, 1.959964, rtol=1e-6)
    assert numbers["identifiable"] is True and numbers["untold"] == []
    read = np.array(written("clearance").column(f"{OUT} [m]"))
    predicted = np.array(written("clearance").column(f"{OUT}.predicted [m]"))
    missed = np.array(numbers["residual"][OUT], float)
    np.testing.assert_allclose(missed[:5], (read - predicted)[:5], rtol=1e-6)
    assert np.isnan(missed[5])
    # The load that was not tried tells most of the stiffness.
    assert numbers["candidates"][0]["case"] == 5
    out = written("clearance").done.out
    assert "the readings tell every unknown" in out and "chi-square 5.5" in out
    # A solve with the numbers found, one by one.
    bearing = bj.DeepGrooveBallBearing(
        9,
        39e-3,
        7.938e-3,
        outer_osculation=0.525,
        inner_osculation=numbers["estimate"][names[1]],
        radial_internal_clearance=numbers["estimate"][names[0]],
    )
    for k, load in enumerate((-100.0, -3000.0)):
        solved = bj.solve_load(
            bj.BearingElement(bearing),
            [0.0, load, 0.0, 0.0, 0.0, 0.0],
            support=bj.Support(free=["uy"]),
        )
        own = numbers["prediction"][OUT][(0, 4)[k]]
        np.testing.assert_allclose(solved.displacement[7], own, rtol=SOLVER)


def measured(tmp_path, text, *settings):
    path = tmp_path / "m.csv"
    path.write_text(text, encoding="utf-8")
    return read_identification(SCENE, [f"identify.data={path}", *settings])


def test_measured_table_has_errors_blanks_and_conditions(tmp_path):
    text = f"operating.load.Fy [kN];{OUT} [mm];{OUT}.error [um];stiffness_uy [N/um];"
    text += "stiffness_uy.error [N/um]\n-1;0,02;0,3;;\n-2;;;80;4\n"
    task = measured(tmp_path, text, "identify.errors=unset")
    np.testing.assert_allclose(task.subject.cases.load[:, 1], [-1e3, -2e3])
    np.testing.assert_allclose(task.readings[OUT], [2e-5, np.nan])
    np.testing.assert_allclose(task.errors[OUT], [3e-7, np.nan])
    np.testing.assert_allclose(task.readings["stiffness_uy"], [np.nan, 8e7])
    assert task.units[OUT] == "m" and task.units["stiffness_uy"] == "N/m"
    assert [one.start for one in task.unknowns] == [None, None]


def test_numbers_of_the_design_differ_from_case_to_case(tmp_path):
    text = f"bearing.outer_osculation,operating.load.Fy [N],{OUT} [um]\n"
    text += "0.52,-100,-9\n0.53,-100,-10\n0.52,-200,-12\n"
    subject = measured(tmp_path, text).subject
    varied = subject.model.varied["drawing.bearing.outer_osculation"]
    np.testing.assert_allclose(varied, [0.52, 0.53, 0.52])
    np.testing.assert_allclose(subject.columns["bearing.outer_osculation"], varied)
    np.testing.assert_allclose(subject.columns["Fy [N]"], [-100.0, -100.0, -200.0])


HEAD = "operating.load.Fy [N]"
TABLES = {
    "unknown column": (
        f"{HEAD},displacement_iner_uy [um]\n-1,1\n",
        "'displacement_iner_uy' is not known (did you mean `displacement_inner_uy`?)",
    ),
    "another unit": (f"{HEAD},{OUT} [N]\n-1,1\n", "'1 N' is not a length"),
    "no unit": (f"{HEAD},{OUT}\n-1,1\n", f"{OUT} has no unit; head the column"),
    "blank condition": (f"{HEAD},{OUT} [um]\n,1\n", "'' is not a finite number"),
    "NaN": (f"{HEAD},{OUT} [um]\n-1,nan\n", "line 2: displacement_inner_uy: 'nan'"),
    "nothing measured": (f"{HEAD}\n-1\n", "measures nothing"),
    "error alone": (f"{HEAD},{OUT}.error [um]\n-1,1\n", "has no column of readings"),
    "unit of a count": (
        f"{HEAD},n_loaded [m],{OUT} [um]\n-1,1,1\n",
        "n_loaded is a pure number",
    ),
    "unit of a life": (
        f"{HEAD},basic_rating_life [rev]\n-1,1\n",
        "basic_rating_life cannot be measured",
    ),
    "unknown as condition": (
        f"bearing.inner_osculation,{OUT} [um]\n0.52,1\n",
        "is a column of the measured table too",
    ),
    "number that the design does not allow": (
        f"bearing.outer_osculation,{OUT} [um]\n0.4,1\n",
        "where the groove centres meet",
    ),
    "what cannot vary": (
        f"bearing.type,{OUT} [um]\nneedle_roller,1\n",
        "'bearing.type' is not known",
    ),
    "friction without oil": (
        f"{HEAD},friction_torque [N m]\n-1,1\n",
        "needs an oil",
    ),
    "errors twice": (
        f"{HEAD},{OUT} [um],{OUT}.error [um]\n-1,1,1\n",
        "has a column of its own",
    ),
    "errors of one alone": (
        f"{HEAD},{OUT} [um],stiffness_uy [N/m]\n-1,1,1\n",
        "has no standard deviation of stiffness_uy",
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_measured_table_that_is_refused(tmp_path, name):
    text, words = TABLES[name]
    with pytest.raises(SceneError) as stop:
        measured(tmp_path, text)
    assert words in str(stop.value) and "identify_clearance.toml" in str(stop.value)


def test_too_few_readings_are_told_with_the_scene(tmp_path):
    task = measured(tmp_path, f"{HEAD},{OUT} [um]\n-100,-10\n")
    words = "identify_clearance.*1 readings for 2 unknowns"
    with pytest.raises(SceneError, match=words):
        run_identification(task)


def test_data_option_is_taken_from_where_one_stands(run, tmp_path, monkeypatch):
    """And not from the folder of the scene."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.csv").write_text(f"{HEAD},wobble [um]\n-1,1\n", "utf-8")
    done = run("identify", SCENE, "--data", "m.csv")
    assert done.status == 2 and "wobble" in done.err
    done = run("identify", SCENE, "--data", "m.csv", "--table", "m.csv")
    assert done.status == 2 and "--table would overwrite it" in done.err
    scene = shipped_scenes()[SCENE].read_text("utf-8")
    (tmp_path / "mine.toml").write_text(scene, "utf-8")
    done = run("identify", "mine.toml")
    assert done.status == 2 and "identify_clearance.csv: cannot be read" in done.err


def test_conditions_of_temperature(tmp_path):
    scene = tmp_path / "warm.toml"
    scene.write_text(WARM, "utf-8")
    (tmp_path / "m.csv").write_text(f"{HEAD},{OUT} [um]\n-100,1\n", "utf-8")
    task, key = read_identification(scene), "temperature.inner_ring"
    assert task.unknowns[0].path == ("conditions.inner_ring",)
    np.testing.assert_allclose([task.readings[key], task.errors[key]], [333.15, 2.0])
    scene.write_text(WARM.replace("2 K", "2 degC"), "utf-8")
    with pytest.raises(SceneError, match="is a difference; write it in K"):
        read_identification(scene)
    more = 'candidates = { "temperature.inner_ring" = "2 degC" }\nerrors ='
    scene.write_text(WARM.replace("errors =", more), "utf-8")
    with pytest.raises(SceneError, match="candidates.*a difference; write it in K"):
        read_identification(scene)
    scene.write_text(WARM.replace("errors =", "wanted = []\n#"), "utf-8")
    with pytest.raises(SceneError, match="beside a prior they must be known"):
        read_identification(scene)


def viscosity_of_friction(tmp_path):
    text = f"{HEAD},operating.inner_speed [rpm],friction_torque [N mm]\n"
    text += "-500,1500,9\n-500,6000,20\n"
    unknown = '{"life.viscosity"={from="5 mm^2/s",to="90 mm^2/s"}}'
    settings = (
        'life={viscosity="20 mm^2/s", contamination="grease, normal"}',
        f"identify.unknowns={unknown}",
    )
    more = (
        'identify.errors={friction_torque="0.1 N mm"}',
        'identify.wanted=["life_hours"]',
    )
    return measured(tmp_path, text, *settings, *more)


def test_viscosity_is_an_unknown(tmp_path):
    task = viscosity_of_friction(tmp_path)
    (one,) = task.unknowns
    assert one.path == ("viscosity",) and task.units["life.viscosity"] == "m²/s"
    assert one.start_in(task.subject.model.design) == pytest.approx(20e-6)
    with pytest.raises(ValueError, match="above 0"):
        with_values(task.subject.model.design, [one.path], [-1e-6])


def test_report_begins_with_the_largest_residual(tmp_path):
    task = measured(tmp_path, f"{HEAD},{OUT} [um]\n-1,1\n")
    task = task._replace(units={OUT: "m", "slope": ""}, wanted=())
    unknowns = [Variable("slope", 0.0, 9.0)]
    readings = {OUT: [1.1, 2.0, 2.5, 4.0]}
    given = np.arange(1.0, 5.0), unknowns, readings, {OUT: 0.1}
    found = bj.identify(lambda x, t: {OUT: x[0] * t}, *given)
    lines = str(identification_report(task, found)).splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("largest res"))
    cases = [line.split()[1] for line in lines[first + 1 : first + 5]]
    off = np.abs(found.residual[OUT])
    assert cases == [str(k) for k in np.argsort(-off)] and cases[0] == "2"


def test_other_commands_do_not_take_speeds_of_the_measured_table(run):
    """And do not ignore the oil without a word."""
    oil = 'life={viscosity="20 mm^2/s", contamination="grease, normal"}'
    done = run("life", SCENE, "--set", oil)
    assert done.status == 2 and "needs a speed of one ring" in done.err


@pytest.mark.slow
def test_friction_and_life_follow_the_viscosity(tmp_path):
    """As with the life's own viscosity, and as by differences."""
    task = viscosity_of_friction(tmp_path)
    given, cases = task.subject.model, task.subject.cases
    names = "friction_torque", "life_hours"
    model = given.for_numbers([["viscosity"]], names)

    def twice(x):
        found = model(x, cases)
        both = jax.numpy.stack([found[name] for name in names])
        return both, both

    solve = jax.jit(jax.jacfwd(twice, has_aux=True))
    slope, there = solve(jax.numpy.array([40e-6]))
    step = 40e-9
    high, low = (solve(jax.numpy.array([40e-6 + d]))[1] for d in (step, -step))
    np.testing.assert_allclose(slope[..., 0], (high - low) / (2 * step), rtol=1e-5)
    design = given.design
    plain = bj.statics.Installed(
        **{k: v for k, v in vars(design).items() if k != "viscosity"}
    )
    life = dataclasses.replace(given.life, viscosity=40e-6)
    own = dataclasses.replace(given, design=plain, life=life).for_numbers([], names)
    direct = own(jax.numpy.zeros(0), cases)
    for name, values in zip(names, there, strict=True):
        np.testing.assert_allclose(values, direct[name], rtol=SOLVER, err_msg=name)
    assert np.all(slope[0] > 0.0) and slope[1, 0] > 0.0  # the other life is capped


SHAFTS = """
[drive]
speed = "1500 rpm"
power = "1 kW"

[shaft.s]
segments = [{ length = "200 mm", outer_diameter = "40 mm" }]

[load.pull]
position = "60 mm"
Fy = "-3 kN"

[coupling.out]

[bearings.A]
designation = "6208"
position = "10 mm"

[bearings.B]
designation = "6208"
position = "190 mm"
floating = true

[identify]
data = "m.csv"
errors = { "A.displacement_gx" = "0.005 mrad" }

[identify.unknowns]
"shaft.s.segments.0.outer_diameter" = { from = "30 mm", to = "45 mm" }
"""
ROTOR = """
[rotor]
rigid = true
modes = 4
shaft = [
    { length = "125 mm", outer_diameter = "35 mm" },
    { length = "375 mm", outer_diameter = "35 mm" },
]

[[rotor.discs]]
station = 1
mass = "10 kg"
polar_inertia = "0.2 kg m^2"
diametral_inertia = "0.1 kg m^2"

[bearings.front]
type = "angular_contact_ball"
n_balls = 12
pitch_diameter = "53.5 mm"
ball_diameter = "12.7 mm"
outer_osculation = 0.52
inner_osculation = 0.52
contact_angle = "15 deg"

[[rotor.bearings]]
station = 0
bearing = "front"
preload = "300 N"
housing = { mass = "3 kg", stiffness = "300 N/um" }

[[rotor.bearings]]
station = 2
stiffness = { radial = "100 N/um", tilt = "100 kN m/rad" }

[rotor.excitation]
unbalance = [{ station = 1, moment = "60 g mm" }]

[identify]
data = "m.csv"
errors = { frequency_1 = "0.2 Hz" }

[identify.unknowns]
"rotor.bearings.0.preload" = { from = "50 N", to = "1000 N" }
"""


def machine(tmp_path, scene, text):
    (tmp_path / "mine.toml").write_text(scene, "utf-8")
    (tmp_path / "m.csv").write_text(text, "utf-8")
    return read_identification(tmp_path / "mine.toml")


def test_readings_and_conditions_of_shafts(tmp_path):
    text = "load.pull.Fy [kN],A.displacement_gx [mrad]\n-1,0.15\n-6,0.8\n"
    task = machine(tmp_path, SHAFTS, text)
    model, cases = task.subject.model, task.subject.cases
    assert task.unknowns[0].path == ("system.shafts.0.outer_diameter.0",)
    assert cases.paths == ("system.loads.0.force",)
    np.testing.assert_allclose(cases.values[0][:, 1], [-1e3, -6e3])
    place = model.place("A.displacement_gx")
    assert place == ("displacement", 3, "rad")
    assert model.place("B.load_Fy") == ("load", 7, "N")
    assert model.place("B.peak_pressure") == ("peak_pressure", 1, "Pa")
    oiled = dataclasses.replace(model.design, oils=(None, None)).readings()
    assert oiled["B.friction"] == ("friction", 1, "W")
    for wrong, words in {
        "A.displacement_wx [mrad]": "A.displacement_wx",
        "speed [rpm]": "'speed' is not known",
        "bearings.A.wobble [mm]": "wobble",
        "hours [h]": "hours of a case change no reading",
    }.items():
        with pytest.raises(SceneError, match=words):
            machine(tmp_path, SHAFTS, f"{wrong},A.displacement_gx [mrad]\n1,1\n")


def test_readings_and_numbers_of_a_rotor(tmp_path):
    text = "rotor.speed [rpm],frequency_1 [Hz]\n0,120\n6000,100\n"
    subject = machine(tmp_path, ROTOR, text).subject
    np.testing.assert_allclose(subject.cases.speed, [0.0, 200.0 * np.pi])
    assert subject.model.place("uy_1") == ("amplitude", 6, "m")
    assert subject.model.place("frequency_4") == ("frequency", 3, "Hz")
    setup = read_setup(tomllib.loads(ROTOR.partition("[identify]")[0]), tmp_path)
    there = design_numbers(setup.model.design, entries=True)
    for key, paths in setup.numbers.items():
        assert set(paths) <= set(there), key
    stiffness = setup.numbers["rotor.bearings.0.housing.stiffness"]
    assert [float(there[path]) for path in stiffness] == [3e8] * 3
    assert "rotor.bearings.1.stiffness.radial" in setup.numbers
    with pytest.raises(SceneError, match=r"frequency_5.*is not known"):
        machine(tmp_path, ROTOR, "rotor.speed [rpm],frequency_5 [Hz]\n0,120\n")
    with pytest.raises(SceneError, match="'rotor.sped' is not known"):
        machine(tmp_path, ROTOR, "rotor.sped [rpm],frequency_1 [Hz]\n0,120\n")


LAW_OF_FRONT = """
[[rotor.bearings]]
station = 2
bearing = "front"
offset = "5 um"
law = "moving_angle"
"""


def test_what_a_law_of_a_rotor_would_not_follow(tmp_path):
    """Numbers of its bearing, and fits at other speeds."""
    first, *_, last = ROTOR.partition("\n[rotor.excitation]")
    scene = first + LAW_OF_FRONT + "\n[rotor.excitation]" + last
    scene = scene.replace('preload = "300 N"', 'offset = "5 um"')  # solves nothing
    known = '"rotor.discs.0.mass" = { from = "9 kg", to = "11 kg" }'
    scene = scene.partition('"rotor.bearings.0.preload"')[0] + known + "\n"
    readings = "rotor.speed [rpm],frequency_1 [Hz]\n0,120\n{},119\n".format
    angle = '"bearings.front.contact_angle" = { from = "10 deg", to = "20 deg" }\n'
    with pytest.raises(SceneError, match="'bearings.front.contact_angle' is not known"):
        machine(tmp_path, scene + angle, readings(100))
    fits = """contact_angle = "15 deg"
[bearings.front.fit]
shaft = "k5"
housing = "H6"
bore = "35 mm"
outside_diameter = "72 mm"
ring_width = "17 mm"
housing_diameter = "110 mm"
"""
    scene = scene.replace('contact_angle = "15 deg"', fits)
    with pytest.raises(SceneError, match="the `law` of front stays that of its fits"):
        machine(tmp_path, scene, readings(100))


def test_unknown_of_an_array_that_differs_in_the_cases(tmp_path):
    """A condition in another entry of it would hold them all."""
    two = '{ length = "100 mm", outer_diameter = "40 mm" }'
    scene = SHAFTS.replace(
        '{ length = "200 mm", outer_diameter = "40 mm" }', f"{two},{two}"
    )
    head = "shaft.s.segments.1.outer_diameter [mm],A.displacement_gx [mrad]"
    task = machine(tmp_path, scene, f"{head}\n40,0.15\n50,0.1\n")
    with pytest.raises(SceneError, match="segments.0.outer_diameter differs from case"):
        run_identification(task)


def test_springs_that_differ_by_direction_are_numbers_of_their_own(tmp_path):
    """One number for all directions would make them alike without a word."""
    text = ROTOR.partition("[identify]")[0]
    text = text.replace('radial = "100 N/um"', 'x = "100 N/um", y = "50 N/um"')
    axes = '{ x = "300 N/um", y = "200 N/um", z = "300 N/um" }'
    text = text.replace('stiffness = "300 N/um"', f"stiffness = {axes}")
    setup = read_setup(tomllib.loads(text), tmp_path)
    there = design_numbers(setup.model.design, entries=True)
    for key, value in {
        "rotor.bearings.1.stiffness.x": 1e8,
        "rotor.bearings.1.stiffness.y": 5e7,
        "rotor.bearings.0.housing.stiffness.y": 2e8,
        "rotor.bearings.0.housing.stiffness.z": 3e8,
    }.items():
        (path,) = setup.numbers[key]
        assert float(there[path]) == value
    whole = "rotor.bearings.1.stiffness.radial", "rotor.bearings.0.housing.stiffness"
    assert not set(whole) & set(setup.numbers)


@pytest.mark.slow
def test_diameter_of_a_shaft_from_its_slope(tmp_path):
    """Readings of the system itself, at another diameter."""
    text = "load.pull.Fy [kN],A.displacement_gx [mrad]\n-1,1\n-6,1\n"
    subject = machine(tmp_path, SHAFTS, text).subject
    model, design = subject.model, subject.model.design
    path = ["system.shafts.0.outer_diameter.0"]
    thin = with_values(design, [path], [0.036])
    cases = [jax.tree.map(lambda x, k=k: x[k], subject.cases) for k in range(2)]
    own = [float(thin.solve_case(c, None, None).displacement[0, 3]) for c in cases]
    unknowns = [Variable(path[0], 0.03, 0.045)]
    readings = {"A.displacement_gx": own}
    found = bj.identify(model, subject.cases, unknowns, readings, 1e-8)
    assert found.converged
    np.testing.assert_allclose(found.estimate, 0.036, rtol=1e-6)


WARM = """
[bearing]
designation = "6205"

[fit]
shaft = "k5"
housing = "H6"
shaft_bore = "0 mm"
housing_diameter = "80 mm"
shaft_material = "steel"
housing_material = "steel"

[temperature]
inner_ring = "60 degC"

[operating]
free = ["uy"]

[identify]
data = "m.csv"
errors = { displacement_inner_uy = "0.5 um" }

[identify.unknowns."temperature.inner_ring"]
from = "20 degC"
to = "90 degC"
prior = "60 degC"
prior_error = "2 K"
"""


def test_speeds_of_the_rows_are_warned_of(tmp_path):
    """Of 6205 the catalogue has 18 000 rpm; the scene itself is slow."""
    text = (
        '[bearing]\ndesignation = "6205"\n'
        '[operating]\nload = { Fy = "-1 kN" }\nfree = ["ux", "uy", "uz"]\n'
        'inner_speed = "100 rpm"\n[identify]\ndata = "read.csv"\n[identify.unknowns]\n'
        '"bearing.radial_internal_clearance" = { from = "1 um", to = "50 um" }\n'
    )
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    table = "operating.inner_speed [rpm],displacement_uy [um]\n100,-5\n30000,-5\n"
    (tmp_path / "read.csv").write_text(table, encoding="utf-8")
    told = read_identification(tmp_path / "scene.toml").subject.scene.warnings
    assert any("speed of 30000 rpm, above the limiting" in text for text in told)

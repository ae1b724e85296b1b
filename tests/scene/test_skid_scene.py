"""Scenes of balls that skid: what they say, and one line for what is wrong."""

import dataclasses

import jax
import numpy as np
import pytest
from han_chu import MODEL, SPEED
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.lubrication import (
    Barus,
    Density,
    DryFriction,
    Exponential,
    Eyring,
    LimitingStress,
    Lubricant,
    Newtonian,
    Roelands,
    SlipCurve,
    Walther,
    free_volume_23699,
    iso_vg,
)
from bearingjax.scene import read_skid
from bearingjax.skid import (
    Cage,
    Drag,
    LoadHistory,
    SinusoidalLoad,
    SkidModel,
    SpeedTable,
    ramp,
)

FREE_VOLUME = (
    'lubricant={law="free_volume", temperature="30 °C", B=2.30134, R0=0.728634,'
    ' reference_viscosity="37.639 mPas", epsilon="-1.02448e-3 1/K", K0_prime=11.0,'
    ' a_V="7.1e-4 1/°C", K00="9 GPa", beta_K="6.5e-3 1/K",'
    ' reference_temperature="303.15 K", density="964 kg/m^3"}'
)
ROELANDS = 'lubricant={law="roelands", temperature="50 °C", coefficient="20 1/GPa"'
WALTHER = ', cold="40 °C", cold_viscosity="46 cSt", hot="100 °C", hot_viscosity="7 cSt"'
THIN = ', reference_viscosity="40 mPa s"'
OIL = "`lubricant.name`: 'ISO VG 45' is not known (did you mean `ISO VG 46`?); it must"

# Settings of skid_axial, and the message after "skid_axial.toml: ".
WRONG = {
    "no lubricant": (["lubricant=3"], "`lubricant`: 3 is not a table"),
    "unknown oil": (["lubricant.name=ISO VG 45"], OIL),
    "neither oil nor law": (
        ["lubricant={temperature='30 °C'}"],
        "`lubricant.name`: is missing; give one of MIL-L-23699, ISO VG 10, ISO VG 15,",
    ),
    "oil and law": (
        ["lubricant.law=barus"],
        "`lubricant.law`: give either `name` or this, not both",
    ),
    "unknown law": (
        ["lubricant={law='roeland', temperature='30 °C'}"],
        "`lubricant.law`: 'roeland' is not known (did you mean `roelands`?); it must be"
        " one of free_volume, barus, roelands",
    ),
    "index of an oil that has its own": (
        ["lubricant.viscosity_index=95"],
        "`lubricant.viscosity_index`: goes with a `grade`, or with the `name` of",
    ),
    "density of an oil that has its own": (
        ["lubricant.density=900 kg/m^3"],
        "`lubricant.density`: goes with `law`, which is missing",
    ),
    "temperature of no viscosity": (
        [ROELANDS + ", grade=46, reference_temperature='40 °C'}"],
        "`lubricant.reference_temperature`: goes with `reference_viscosity`, which is",
    ),
    "thin oil of a low index": (
        ["lubricant.name=ISO VG 10", "lubricant.viscosity_index=500"],
        "[lubricant]: viscosity_at_100: `index` is 500",
    ),
    "bare temperature": (
        ["lubricant.temperature=30"],
        "`lubricant.temperature`: 30 has no unit; a temperature with its unit is"
        ' wanted, such as "5 °C"',
    ),
    "coulombs": (
        ["lubricant.temperature=30 C"],
        "`lubricant.temperature`: '30 C' is not a temperature; a temperature with",
    ),
    "kelvin for celsius": (
        ["lubricant.temperature=30 K"],
        "`lubricant.temperature`: -243.15 °C is not allowed; from -60 to 250 °C",
    ),
    "unknown traction": (
        ["lubricant.traction=newton"],
        "`lubricant.traction`: 'newton' is not known (did you mean `newtonian`?); it",
    ),
    "traction without its numbers": (
        ["lubricant.traction=slip_curve"],
        "`lubricant.traction.far`: is missing; it must be a bare number",
    ),
    "number of another traction": (
        ["lubricant.traction={type='eyring', slope=0.05}"],
        "`lubricant.traction.slope`: unknown key; known in [lubricant.traction]:",
    ),
    "number that a traction does not allow": (
        ["lubricant.traction={type='eyring', stress_scale='0 MPa'}"],
        "[lubricant.traction]: Eyring: `stress_scale` is 0 Pa; it must be above 0",
    ),
    "law without viscosity": (
        [ROELANDS + "}"],
        "`lubricant.reference_viscosity`: is missing; give one of `grade`,"
        " `cold_viscosity`, `reference_viscosity`",
    ),
    "two viscosities": (
        [ROELANDS + THIN + ", grade=46}"],
        "`lubricant.reference_viscosity`: stands beside `grade`; give one of",
    ),
    "hotter is thicker": (
        [ROELANDS + WALTHER.replace("7 cSt", "70 cSt") + "}"],
        "[lubricant]: Walther: `hot_viscosity` is 7e-05 m²/s; it must be below",
    ),
    "slope of no density": (
        [ROELANDS + THIN + ", density_slope='0.6 kg/(m^3 K)'}"],
        "`lubricant.density`: is missing; the other numbers of the density go with it",
    ),
    "pressure as its coefficient": (
        ["lubricant={law='barus', temperature='30 °C', coefficient='2 GPa', grade=46}"],
        "`lubricant.coefficient`: '2 GPa' is not a pressure coefficient; a pressure"
        ' coefficient with its unit is wanted, such as "5 1/GPa"',
    ),
    "key of the cage": (
        ["cage.pocket_clearence=1 mm"],
        "`cage.pocket_clearence`: unknown key (did you mean `pocket_clearance`?);"
        " known in [cage]: inertia, pocket_clearance, stiffness",
    ),
    "soft cage": (
        ["cage.stiffness=0 N/m"],
        "[cage]: Cage: `stiffness` is 0 N/m; it must be above 0",
    ),
    "inertia as mass": (
        ["cage.inertia=25 g"],
        "`cage.inertia`: '25 g' is not a moment of inertia;",
    ),
    "more oil than room": (
        ["dynamics.fill=1.1"],
        "[dynamics]: Drag: `fill` is 1.1; it must be",
    ),
    "no duration": (
        ["dynamics={fill=0.1}"],
        "`dynamics.duration`: is missing; give a time, or ask for the end state with"
        " --steady",
    ),
    "no time at all": (
        ["dynamics.duration=0 s"],
        "`dynamics.duration`: 0 s is not allowed; above 0 and at most 100000 s",
    ),
    "duration as angle": (
        ["dynamics.duration=3 deg"],
        "`dynamics.duration`: '3 deg' is not a time; a time with its unit is wanted,",
    ),
    "one time": (
        ["dynamics.n_times=1"],
        "`dynamics.n_times`: 1 is not a whole number of at least 2",
    ),
    "a million times": (
        ["dynamics.n_times=1000000"],
        "`dynamics.n_times`: 1000000 is too many; at most 20000",
    ),
    "tolerance": (
        ["dynamics.tolerance=0"],
        "`dynamics.tolerance`: 0 is not allowed; from 1e-12 to 0.01",
    ),
    "axis": (
        ["dynamics.axis=z"],
        "`dynamics.axis`: 'z' is not known; it must be one of vertical, horizontal",
    ),
    "start": (
        ["dynamics.start=still"],
        "`dynamics.start`: 'still' is not known; it must be one of rolling, rest",
    ),
    "few places": (
        ["dynamics.places=4"],
        "`dynamics.places`: 4 is not allowed; 1 or at least 6",
    ),
    "ramp": (["dynamics.ramp=-1 s"], "`dynamics.ramp`: -1 s must be above 0"),
    "ramp and table": (
        ["dynamics.speed={time=['0 s'], inner=['1 rpm']}"],
        "`dynamics.ramp`: give either `speed` over time or this, not both",
    ),
    "key of dynamics": (
        ["dynamics.least_flim=1 um"],
        "`dynamics.least_flim`: unknown key (did you mean `least_film`?); known in"
        " [dynamics]: axis, balanced, drag_coefficient, duration, fill, ",
    ),
    "nothing turns": (
        ["operating={load={Fz='80 N'}}"],
        "`operating.inner_speed`: is missing, and so is `outer_speed`; nothing skids",
    ),
    "set": (
        ["set={arrangement='tandem', spacing='20 mm'}"],
        "`set`: is of several rows; balls or rollers skid in one",
    ),
}
# The same beside a table of speeds in place of the ramp.
SPEEDS = {
    "times that fall": (
        "time=['1 s', '0 s'], inner=['0 rpm', '1 rpm']",
        "`dynamics.speed.time`: must be rising times from 0 s on",
    ),
    "a speed too few": (
        "time=['0 s', '1 s'], inner=['0 rpm']",
        "`dynamics.speed.inner`: has 1 values for 2 times",
    ),
    "no speeds": (
        "time=['0 s', '1 s']",
        "`dynamics.speed.inner`: is missing, and so is `outer`; give one of them",
    ),
    "bare times": ("time=[0, 1]", "`dynamics.speed.time`: 0 has no unit; a time with"),
    "frequency": (
        "time=['0 s'], inner=['50 Hz']",
        "`dynamics.speed.inner`: '50 Hz' is a frequency; give rpm, deg/s or rad/s",
    ),
}


LOADS = {
    "balanced": (
        "balanced=false, load={time=['0 s'], Fy=['1 N']}",
        "`dynamics.balanced`: a `load` over time is balanced at every time",
    ),
    "no component": (
        "load={time=['0 s']}",
        "`dynamics.load.Fz`: is missing; give one at least of Fx, Fy, Fz, Mx, My, Mz",
    ),
    "no amplitude": (
        "load={amplitude={}, speed='1 rpm'}",
        "`dynamics.load.amplitude`: names no load, such as",
    ),
    "a load too many": (
        "load={time=['0 s'], Fy=['1 N', '2 N']}",
        "`dynamics.load.Fy`: has 2 values for 1 times",
    ),
    "no frequency": (
        "load={amplitude={Fy='80 N'}}",
        "`dynamics.load.speed`: is missing; it must be a speed",
    ),
    "unknown component": (
        "load={time=['0 s'], Fy=['1 N'], Fw=['1 N']}",
        "`dynamics.load.Fw`: unknown key; known in [dynamics.load]: Fx, Fy, Fz, Mx, My",
    ),
}


def same(found, wanted):
    """Two modules of one structure, and their numbers."""
    leaves, structure = jax.tree.flatten(found)
    others, other = jax.tree.flatten(wanted)
    assert structure == other
    for leaf, value in zip(leaves, others, strict=True):
        np.testing.assert_allclose(leaf, value, rtol=ROUNDING, atol=0)
    return True


def oil(*settings):
    model = read_skid("skid_axial", settings, steady=True).model
    return model.lubricant


@pytest.mark.parametrize("settings, message", WRONG.values(), ids=WRONG.keys())
def test_wrong_scenes(settings, message):
    with pytest.raises(SceneError) as error:
        read_skid("skid_axial", settings)
    assert str(error.value).startswith(f"skid_axial.toml: {message}")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("table, message", SPEEDS.values(), ids=SPEEDS.keys())
def test_wrong_speeds(table, message):
    given = f"dynamics={{duration='1 s', speed={{ {table} }} }}"
    with pytest.raises(SceneError) as error:
        read_skid("skid_axial", [given])
    assert str(error.value).startswith(f"skid_axial.toml: {message}")


@pytest.mark.parametrize("given, message", LOADS.values(), ids=LOADS.keys())
def test_wrong_loads(given, message):
    with pytest.raises(SceneError) as error:
        read_skid("skid_combined", [f"dynamics={{duration='1 s', {given} }}"])
    assert str(error.value).startswith(f"skid_combined.toml: {message}")


def test_loads_over_time():
    """What is not named stays as it is."""
    times = "load={time=['0 s', '20 ms'], Fy=['0 N', '0.3 kN'], Mx=['0 Nm', '1 Nm']}"
    task = read_skid("skid_combined", [f"dynamics={{duration='1 s', {times} }}"])
    rows = [[0.0, 0.0, 600.0, 0.0, 0.0, 0.0], [0.0, 300.0, 600.0, 1.0, 0.0, 0.0]]
    assert same(task.loads, LoadHistory([0.0, 0.02], rows))
    assert task.balanced is None
    wave = "load={amplitude={Fy='80 N'}, speed='30 rpm', phase='90 deg'}"
    task = read_skid("skid_combined", [f"dynamics={{duration='1 s', {wave} }}"])
    wanted = SinusoidalLoad(task.scene.load, [0, 80.0, 0, 0, 0, 0], np.pi, 0.5 * np.pi)
    assert same(task.loads, wanted)
    task = read_skid("skid_combined", ["dynamics={duration='1 s', balanced=true}"])
    assert task.loads is None and task.balanced is True


def test_rollers_and_places_of_the_end_state():
    with pytest.raises(SceneError, match="`lubricant`: is missing; it must be a table"):
        read_skid("deep_groove", ["operating.inner_speed=1 rpm"])
    with pytest.raises(SceneError, match="is for balls; rollers have the constant loa"):
        read_skid("skid_roller", ["dynamics.load={time=['0 s'], Fx=['1 N']}"])
    with pytest.raises(SceneError, match="`dynamics.balanced`: is for balls; rollers"):
        read_skid("skid_roller", ["dynamics.balanced=true"])
    with pytest.raises(SceneError, match="'tapered_roller' does not skid; balls, cyl"):
        read_skid("tapered", steady=True)
    for kind in ("spherical", "crossed"):
        with pytest.raises(SceneError, match=f"'{kind}_roller' does not skid; balls,"):
            read_skid(f"{kind}_roller", steady=True)
    with pytest.raises(SceneError, match="`bearing`: is of several rows; balls or rol"):
        read_skid("self_aligning", steady=True)
    with pytest.raises(
        SceneError, match="1 or a multiple of the number .* rollers, 12"
    ):
        read_skid("skid_axial", ["dynamics.places=100"], steady=True)
    assert read_skid("skid_axial", ["dynamics.places=100"]).places == 100


def test_shipped_scenes_are_those_of_the_paper():
    task = read_skid("skid_axial")
    assert same(task.model, MODEL)
    np.testing.assert_allclose(task.speed.inner, SPEED.inner, rtol=1e-7)
    assert task.scene.load == (0.0, 0.0, 80.0, 0.0, 0.0, 0.0)
    assert (task.oil, task.duration, task.axis) == ("MIL-L-23699", 0.4, "vertical")
    assert (task.start, task.n_times, task.places) == ("rolling", 501, None)
    assert same(task.speeds, ramp(0.1, task.speed))
    combined = read_skid("skid_combined")
    assert isinstance(combined.model.traction, LimitingStress)
    film = dataclasses.replace(MODEL, traction=combined.model.traction)
    assert same(combined.model, film)
    assert combined.speeds is None
    assert combined.scene.load == (0.0, 400.0, 600.0, 0.0, 0.0, 0.0)
    end = read_skid("skid_axial", ["dynamics={}"], steady=True)
    assert end.steady and end.duration is None
    assert same(end.model, MODEL)  # the defaults are the same numbers


def test_shipped_roller_scene():
    task = read_skid("skid_roller", steady=True)
    assert task.model.bearing.n_rollers == 36 and task.places == 108
    assert same(task.model.traction, LimitingStress())
    assert same(task.model.drag, Drag(2.0, 0.02))
    assert task.scene.free == ("ux", "uy")


def test_read_skid_cage_and_dynamics_tables():
    task = read_skid(
        "skid_axial",
        [
            "cage={pocket_clearance='0.1 mm', stiffness='2 N/um', inertia='3 kg mm^2'}",
            "dynamics={duration='250 ms', fill=0.05, drag_coefficient=1.5,"
            " least_film='20 nm', axis='horizontal', start='rest', n_times=11,"
            " inlet_heating=true,"
            " tolerance=1e-5, max_steps=99, places=24,"
            " speed={time=['0 s', '1 s', '2 s'], outer=['0 rpm', '60 rpm', '30 rpm']}}",
        ],
    )
    assert same(task.model.cage, Cage(1e-4, 2e6, 3e-6))
    assert same(task.model.drag, Drag(1.5, 0.05))
    assert float(task.model.least_film) == 20e-9 and task.model.inlet_heating
    assert (task.duration, task.axis, task.start) == (0.25, "horizontal", "rest")
    assert (task.n_times, task.tolerance, task.max_steps) == (11, 1e-5, 99)
    assert task.places == 24
    assert same(
        task.speeds, SpeedTable([0.0, 1.0, 2.0], [0.0] * 3, [0.0, 2 * np.pi, np.pi])
    )


def test_oils():
    law = free_volume_23699()
    constant = Density(964.0)
    assert same(oil(FREE_VOLUME), Lubricant(law, law, constant))
    assert same(oil("lubricant.name=ISO VG 46"), iso_vg(46.0))
    assert same(
        oil("lubricant.name=ISO VG 46", "lubricant.viscosity_index=120"),
        iso_vg(46.0, 120.0),
    )
    two_points = Walther(313.15, 46e-6, 373.15, 7e-6)
    assert same(
        oil(ROELANDS + WALTHER + ", film_coefficient='18 1/GPa'}"),
        Lubricant(two_points, Roelands(20e-9), Density(900.0), 18e-9),
    )
    dense = (
        ", grade=32, density='0.87 g/cm^3', density_slope='0.6 kg/(m^3 K)',"
        " density_temperature='20 °C'}"
    )
    assert same(
        oil(ROELANDS.replace("roelands", "barus") + dense),
        Lubricant(Walther.from_grade(32.0), Barus(20e-9), Density(870.0, 0.6, 293.15)),
    )
    factors = ", first='3600 K', second='7e5 K^2', reference_temperature='40 °C'}"
    assert same(
        oil(ROELANDS + THIN + factors).ambient, Exponential(0.04, 313.15, 3600.0, 7e5)
    )
    alone = oil(ROELANDS + THIN + "}")
    np.testing.assert_allclose(alone.viscosity(0.0, 323.15), 0.04, rtol=ROUNDING)


def test_read_skid_warns_of_assumed_oil_density():
    task = read_skid("skid_axial", [ROELANDS + THIN + "}"])
    assert task.oil == "roelands"
    assert task.warnings == (
        "the oil's density is not given: 900 kg/m³ is taken at 15 °C",
    )


def test_read_skid_warns_of_supply_without_effect():
    (told,) = read_skid("skid_axial", ["lubricant.supply=grease"]).warnings
    assert told.startswith("`lubricant.supply` 'grease' counts for the friction torque")


@pytest.mark.parametrize(
    "written, law",
    [
        ("newtonian", Newtonian()),
        ("eyring", Eyring()),
        ("{type='eyring', stress_scale='3 MPa'}", Eyring(3e6)),
        (
            "{type='limiting', slope=0.07, ambient='1 bar'}",
            LimitingStress(0.07, 1e5),
        ),
        (
            "{type='slip_curve', far=0.03, rise='50 s/m', decay='20 s/m'}",
            SlipCurve(0.03, 50.0, 20.0),
        ),
        ("{type='dry', friction=0.2, creep='2 mm/s'}", DryFriction(0.2, 2e-3)),
    ],
)
def test_tractions(written, law):
    task = read_skid("skid_axial", [f"lubricant.traction={written}"])
    assert same(task.model.traction, law)


def test_temperatures():
    for text in ("303.15 K", "30 degC", "86 degF"):
        model = read_skid("skid_axial", [f"lubricant.temperature={text}"]).model
        assert isinstance(model, SkidModel)
        np.testing.assert_allclose(model.temperature, 303.15, rtol=ROUNDING)


def test_other_commands_pass_the_tables_over():
    settings = ["cage.stiffness=soft", "dynamics.duration=long"]
    scene = bj.read_scene("skid_axial", settings)
    assert scene.load[2] == 80.0

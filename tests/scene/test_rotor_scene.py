"""Scenes of rotors: what they say, and one line for what is wrong."""

import dataclasses
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.scene import read_rotor, rotor_run, scene_files, shipped_scenes
from bearingjax.scene.rotor_report import _bearings
from bearingjax.scene.rotor_supports import with_passage

RPM = np.pi / 30.0
TURN = 2.0 * np.pi
SHIPPED = (
    "rotor_flexible",
    "rotor_paper_12",
    "rotor_paper_26",
    "rotor_paper_36",
    "rotor_spindle",
)
KNOWN = "known in [rotor"

# Settings of rotor_flexible, and the message after "rotor_flexible.toml: ".
WRONG = {
    "moment about the shaft": (
        "rotor.excitation.forces=[{station=1, Mz='1 N m'}]",
        "`rotor.excitation.forces[0].Mz`: unknown key; known in [rotor.excitation",
    ),
    "table of one bearing": (
        "bearing={type='needle_roller'}",
        "`bearing`: the scene of a rotor has a [rotor], and its bearings as",
    ),
    "unknown table": (
        "rotor.cambell={to='1 rpm'}",
        "`rotor.cambell`: unknown key (did you mean `campbell`?); known in [rotor]: "
        "axis, bearings, campbell, damping, damping_ratio, discs, excitation, modes,"
        " response, rigid, shaft, speed, transient",
    ),
    "speed as a frequency": (
        "rotor.speed=50 Hz",
        "`rotor.speed`: '50 Hz' is a frequency; give rpm, deg/s or rad/s",
    ),
    "axis": (
        "rotor.axis=upright",
        "`rotor.axis`: 'upright' is not known; it must be one of horizontal, vertical,"
        " none",
    ),
    "no modes": (
        "rotor.modes=0",
        "`rotor.modes`: 0 is not a whole number of at least 1",
    ),
    "damping above all": (
        "rotor.damping_ratio=1.5",
        "`rotor.damping_ratio`: 1.5 is not allowed; from 0 to below 1",
    ),
    "two dampings": (
        "rotor.damping={mass_factor='1 1/s'}",
        "`rotor.damping`: give either `damping_ratio` or this",
    ),
    "no shaft": ("rotor.shaft=[]", "`rotor.shaft`: [] is not a list of tables"),
    "segment without length": (
        "rotor.shaft.1.length=0 mm",
        "`rotor.shaft[1].length`: 0 m is not allowed; above 0 m",
    ),
    "bore as large as the shaft": (
        "rotor.shaft.0.bore=40 mm",
        "`rotor.shaft[0].bore`: 0.04 m is not allowed; from 0 to below the outer"
        " diameter, 0.04 m",
    ),
    "elements": (
        "rotor.shaft.2.divisions=500",
        "`rotor.shaft[2].divisions`: 506 elements are too many; at most 200",
    ),
    "key of a segment": (
        "rotor.shaft.0.diameter=40 mm",
        "`rotor.shaft[0].diameter`: unknown key (did you mean `outer_diameter`?);",
    ),
    "entry that is not there": (
        "rotor.shaft.3.length=1 m",
        "`rotor.shaft` is a list; a number from 0 to 2 names one of its entries, '3'",
    ),
    "station behind the shaft": (
        "rotor.discs.1.station=4",
        "`rotor.discs[1].station`: 4 is not a station of the shaft; from 0 to 3",
    ),
    "mass and sizes": (
        "rotor.discs.0.mass=3 kg",
        "`rotor.discs[0].outer_diameter`: give either `mass` or the sizes of a disc",
    ),
    "disc with one inertia": (
        "rotor.discs.0={station=1, mass='3 kg', polar_inertia='1 kg m^2'}",
        "`rotor.discs[0].diametral_inertia`: is missing; it must be a moment of",
    ),
    "inertia as mass": (
        "rotor.discs.0={station=1, mass='3 mm'}",
        "`rotor.discs[0].mass`: '3 mm' is not a mass; a mass with its unit is wanted,"
        ' such as "5 kg"',
    ),
    "disc with a wide bore": (
        "rotor.discs.0.bore=300 mm",
        "[rotor.discs[0]]: Disc: `bore` is 0.3 m; it must be below the outer diameter",
    ),
    "unknown bearing": (
        "rotor.bearings.0.bearing=locatin",
        "`rotor.bearings[0].bearing`: 'locatin' is not known (did you mean `locating`",
    ),
    "scene that is not there": (
        "rotor.bearings.0.bearing=other/rig.toml",
        "`rotor.bearings[0].bearing`: ",
    ),
    "bearing of a rotor": (
        "rotor.bearings.0.bearing=rotor_spindle",
        "`rotor.bearings[0].bearing`: rotor_spindle.toml: is the scene of a [rotor],"
        " not of a [bearing]; `bearingjax rotor rotor_spindle` solves it",
    ),
    "neither bearing nor springs": (
        "rotor.bearings.0={station=0}",
        "`rotor.bearings[0].bearing`: is missing, and so is `stiffness`; give one",
    ),
    "bearing and springs": (
        "rotor.bearings.0.stiffness={radial='1 N/um'}",
        "`rotor.bearings[0].stiffness`: give either `bearing` or this",
    ),
    "springs of nothing": (
        "rotor.bearings.1={station=3, stiffness={}}",
        "`rotor.bearings[1].stiffness.radial`: is missing, and so are `axial`",
    ),
    "negative spring": (
        "rotor.bearings.1={station=3, stiffness={x='-1 N/um', y='1 N/um'}}",
        "`rotor.bearings[1].stiffness.x`: -1e+06 N/m is not allowed; at least 0 N/m",
    ),
    "preload of springs": (
        "rotor.bearings.1={station=3, stiffness={radial='1 N/um'}, preload='1 N'}",
        "`rotor.bearings[1].preload`: goes with a `bearing`, not with `stiffness`",
    ),
    "bearing that is nowhere": (
        "rotor.bearings.1={station=3, bearing='locating'}",
        "`bearings.free`: is in no [[rotor.bearings]]; leave it out",
    ),
    "number of a bearing": (
        "bearings.locating.n_balls=40",
        "[bearings.locating]: DeepGrooveBallBearing: `n_balls` is 40 balls; it must be",
    ),
    "key of a bearing": (
        "bearings.locating.fixed_ring=inner",
        "`bearings.locating.fixed_ring`: unknown key; known in [bearings.locating]:",
    ),
    "law of a bearing": (
        "bearings.free.contact.line_law=hertz",
        "`bearings.free.contact.line_law`: 'hertz' is not known; it must be one of",
    ),
    "preload and offset": (
        "rotor.bearings.0={station=0, bearing='free', preload='1 N', offset='1 um'}",
        "`rotor.bearings[0].preload`: give either `offset` or this, not both",
    ),
    "no preload": (
        "rotor.bearings.0.preload=0 N",
        "`rotor.bearings[0].preload`: 0 N is not allowed; above 0 N",
    ),
    "preload of a free bearing": (
        "rotor.bearings.1.preload=100 N",
        "`rotor.bearings[1].preload`: is axial, and this bearing holds no axial load",
    ),
    "law of rollers": (
        "rotor.bearings.1.law=cubic",
        "`rotor.bearings[1].law`: is for one row of balls with one groove in each ring",
    ),
    "law without preload": (
        "rotor.bearings.0.law=fixed_angle",
        "`rotor.bearings[0].preload`: is missing; the law is that of a preloaded",
    ),
    "housing without mass": (
        "rotor.bearings.0.housing={stiffness='100 N/um'}",
        "`rotor.bearings[0].housing.mass`: is missing; it must be a mass",
    ),
    "housing without a direction": (
        "rotor.bearings.0.housing={mass='2 kg', stiffness={x='1 N/um', y='1 N/um'}}",
        "`rotor.bearings[0].housing.stiffness.z`: is missing; it must be a stiffness",
    ),
    "unbalance as a mass": (
        "rotor.excitation.unbalance.0.moment=60 g",
        "`rotor.excitation.unbalance[0].moment`: '60 g' is not an unbalance; an"
        ' unbalance with its unit is wanted, such as "5 g mm"',
    ),
    "force of nothing": (
        "rotor.excitation.forces=[{station=1}]",
        "`rotor.excitation.forces[0].Fy`: is missing; give one at least of Fx, Fy,",
    ),
    "base shaken in a turn": (
        "rotor.excitation.base_acceleration={gx='1 rad/s^2'}",
        "`rotor.excitation.base_acceleration.gx`: unknown key (did you mean `x`?);",
    ),
    "diagram of one speed": (
        "rotor.campbell.to=0 rpm",
        "`rotor.campbell.to`: 0 rad/s is not above `from`, 0 rad/s",
    ),
    "response to nothing": (
        "rotor.excitation={}",
        "`rotor.excitation.unbalance`: is missing, and so is `base_acceleration`;",
    ),
    "response at rest": (
        "rotor.response.from=0 Hz",
        "`rotor.response.from`: 0 rad/s is not allowed; above 0",
    ),
    "method": (
        "rotor.response.method=harmonic",
        "`rotor.response.method`: 'harmonic' is not known (did you mean",
    ),
    "key of another method": (
        "rotor.response.method=shooting",
        "`rotor.response.harmonics`: goes with `method` = harmonic_balance",
    ),
    "few samples": (
        "rotor.response.samples=10",
        "`rotor.response.samples`: 10 is not allowed; above twice `harmonics`, 10",
    ),
    "reduction of what is rigid": (
        "rotor.rigid=true",
        "`rotor.response.reduction`: is for a shaft that bends, not a `rigid` one",
    ),
    "coordinate": (
        "rotor.response.coordinate=uw",
        "`rotor.response.coordinate`: 'uw' is not known; it must be one of ux, uy, uz,",
    ),
    "no time": (
        "rotor.transient={n_times=5}",
        "`rotor.transient.duration`: is missing; it must be a time",
    ),
    "tolerance": (
        "rotor.transient={duration='1 s', tolerance=1}",
        "`rotor.transient.tolerance`: 1 is not allowed; from 1e-12 to 0.01",
    ),
    "motion in time that turns back": (
        "rotor.transient={duration='1 s', speed_to='-60 rpm'}",
        "`rotor.transient.speed_to`: -6.28319 rad/s is not allowed with a motion in",
    ),
    "times": (
        "rotor.transient={duration='1 s', n_times=100000}",
        "`rotor.transient.n_times`: 100000 is too many; at most 20000",
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_scene_is_told_in_one_line(what):
    setting, message = WRONG[what]
    with pytest.raises(SceneError) as caught:
        read_rotor("rotor_flexible", [setting])
    assert str(caught.value).startswith(f"rotor_flexible.toml: {message}")
    assert "\n" not in str(caught.value)


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
    assert task.rigid and task.axis == "none"
    assert task.station_names == ("0 gost_831", "1 disc", "2 gost_831")
    (disc,) = task.discs
    assert isinstance(disc, bj.rotor.Disc)
    own = [float(disc.mass), float(disc.polar_inertia), float(disc.diametral_inertia)]
    assert own == [10.0, 0.2, 0.1]
    a, b = task.mounts
    assert (a.station, b.station, a.turned, b.turned) == (0, 2, False, True)
    assert a.preload == b.preload == 581.2 and a.law == "fixed_angle"
    bearing = a.element.bearing
    assert float(bearing.pitch_diameter) == pytest.approx(16e-3 + 27.5399e-3)
    assert np.degrees(float(bearing.free_contact_angle)) == pytest.approx(
        23.855, abs=5e-4
    )
    assert np.allclose(task.loads.base_acceleration, [0, 3, 0])
    assert isinstance(task.damping, bj.rotor.ModalDamping)
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
    assert (one.station, one.offset, one.turned, one.inertia) == (1, 4e-6, True, True)
    assert one.damping == (1.0, 2.0, 3.0, 4.0, 4.0)
    assert isinstance(one.element.raceway_control, bj.element.InnerControl)
    assert isinstance(one.element.point_law, bj.contact.ZeroAngle)
    assert np.allclose(np.diag(one.housing.stiffness), [1e6, 2e6, 3e6])
    assert np.allclose(np.diag(one.housing.damping), 5.0)
    needle = bj.read_scene("needle")
    assert other.name == "needle"
    assert type(other.element.bearing) is type(needle.element.bearing)
    (unbalance,), (force,) = task.loads.unbalances, task.loads.forces
    assert float(unbalance.moment) == pytest.approx(5e-6)
    assert float(unbalance.phase) == pytest.approx(np.pi / 2)
    assert force.station == 3 and np.allclose(force.force, [2, 0, 0, 0, 3])
    assert task.damping is None
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
    assert task.mounts[1].stiffness == (20e6, 20e6, 5e6, 1e3, 1e3)
    assert task.station_names == ("0 mine", "1 springs")
    # What would be overwritten is known.
    assert scene_files(path) == [path, other]


def test_round_off_of_a_bearing_without_ribs_is_no_axial_stiffness(untyped):
    k = np.diag([4e8, 3e8, -5.7e-6, 2e3, 2e3])
    k[2, 3] = 1e-5
    mount = SimpleNamespace(station="left", name="nu206", turned=False)
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
        viscosity=viscosity,
        contamination=0.5,
        speed=bj.Speed(jnp.asarray(task.speed)),
    )
    hours: Any = wanted.life_hours
    np.testing.assert_allclose(life.life_hours, hours, rtol=1e-6)
    echo = task.inputs
    assert echo["life"]["contamination"] == 0.5 and "lubricant" in echo

"""Scenes of balls and rollers that skid, and what `bearingjax skid` makes of them."""

import dataclasses
import json
import re
from typing import Any

import equinox as eqx
import jax
import matplotlib.pyplot as plt
import numpy as np
import pytest
from han_chu import MODEL, SPEED
from runs import SEARCH, WORDS, Runs, Study
from scipy.integrate import simpson
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax import SceneError, plot
from bearingjax.lubrication import (
    Barus,
    Density,
    DryFriction,
    Exponential,
    Eyring,
    LimitingStress,
    Lubricant,
    Newtonian,
    Regime,
    Roelands,
    SlipCurve,
    Walther,
    free_volume_23699,
    iso_vg,
)
from bearingjax.numerics import Result
from bearingjax.skid import (
    Cage,
    Drag,
    LoadHistory,
    SinusoidalLoad,
    SkidModel,
    SpeedTable,
    ramp,
    skid_warnings,
    sliding_ellipse,
    sliding_spectrum,
    zones,
)
from bearingjax.studies.skid.output import skid_as_dict, skid_columns, skid_message
from bearingjax.studies.skid.read import read_skid
from bearingjax.studies.skid.report import skid_report
from bearingjax.studies.skid.run import run_skid

FREE_VOLUME = (
    'lubricant={law="free_volume", temperature="30 °C", B=2.30134, R0=0.728634,'
    ' reference_viscosity="37.639 mPas", epsilon="-1.02448e-3 1/K", K0_prime=11.0,'
    ' a_V="7.1e-4 1/°C", K00="9 GPa", beta_K="6.5e-3 1/K",'
    ' reference_temperature="303.15 K", density="964 kg/m^3"}'
)
ROELANDS = 'lubricant={law="roelands", temperature="50 °C", coefficient="20 1/GPa"'
WALTHER = ', cold="40 °C", cold_viscosity="46 cSt", hot="100 °C", hot_viscosity="7 cSt"'
THIN = ', reference_viscosity="40 mPa s"'


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


def test_loads_over_time():
    """What is not named stays as it is."""
    times = "load={time=['0 s', '20 ms'], Fy=['0 N', '0.3 kN'], Mx=['0 Nm', '1 Nm']}"
    task = read_skid("skid_combined", [f"dynamics={{duration='1 s', {times} }}"])
    rows = [[0.0, 0.0, 600.0, 0.0, 0.0, 0.0], [0.0, 300.0, 600.0, 1.0, 0.0, 0.0]]
    assert same(task.loads, LoadHistory([0.0, 0.02], rows))
    assert task.dynamics.balanced is None
    wave = "load={amplitude={Fy='80 N'}, speed='30 rpm', phase='90 deg'}"
    task = read_skid("skid_combined", [f"dynamics={{duration='1 s', {wave} }}"])
    wanted = SinusoidalLoad(task.scene.load, [0, 80.0, 0, 0, 0, 0], np.pi, 0.5 * np.pi)
    assert same(task.loads, wanted)
    task = read_skid("skid_combined", ["dynamics={duration='1 s', balanced=true}"])
    assert task.loads is None and task.dynamics.balanced is True


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
    assert read_skid("skid_axial", ["dynamics.places=100"]).dynamics.places == 100


def test_shipped_scenes_are_those_of_the_paper():
    task = read_skid("skid_axial")
    assert same(task.model, MODEL)
    np.testing.assert_allclose(task.speed.inner, SPEED.inner, rtol=1e-7)
    assert task.scene.load == (0.0, 0.0, 80.0, 0.0, 0.0, 0.0)
    asked = task.dynamics
    assert (task.oil, asked.duration, asked.axis) == ("MIL-L-23699", 0.4, "vertical")
    assert (asked.start, asked.n_times, asked.places) == ("rolling", 501, None)
    assert same(task.speeds, ramp(0.1, task.speed))
    combined = read_skid("skid_combined")
    assert isinstance(combined.model.traction, LimitingStress)
    film = dataclasses.replace(MODEL, traction=combined.model.traction)
    assert same(combined.model, film)
    assert combined.speeds is None
    assert combined.scene.load == (0.0, 400.0, 600.0, 0.0, 0.0, 0.0)
    end = read_skid("skid_axial", ["dynamics={}"], steady=True)
    assert end.steady
    assert same(end.model, MODEL)  # the defaults are the same numbers


def test_shipped_roller_scene():
    task = read_skid("skid_roller", steady=True)
    assert task.model.bearing.n_rollers == 36 and task.dynamics.places == 108
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
    asked = task.dynamics
    assert (asked.duration, asked.axis, asked.start) == (0.25, "horizontal", "rest")
    assert (asked.n_times, asked.tolerance, asked.max_steps) == (11, 1e-5, 99)
    assert asked.places == 24
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


# Of the command.

# Six balls under axial and radial load, at twelve places.
GIVEN = (
    "bearing.n_balls=6",
    "operating.load.Fy=40 N",
    "operating.load.Fz=150 N",
    "dynamics.places=12",
    "operating.free=['ux', 'uy', 'uz', 'gx', 'gy']",
    "numerics.tolerance=1e-11",
)
SMALL = ("skid", "skid_combined", *(w for s in GIVEN for w in ("--set", s)))
# Seven rollers at twice as many places.
ROLLERS = (
    "bearing.n_rollers=7",
    "operating.load.Fx=200 N",
    "dynamics.places=14",
)
FEW = ("skid", "skid_roller", *(w for s in ROLLERS for w in ("--set", s)))
# The same bearing under an axial load, from rest to full speed in a millisecond.
START = (
    "bearing.n_balls=6",
    "dynamics={duration='2 ms', ramp='1 ms', n_times=9, axis='horizontal'}",
)
RUN_UP = ("skid", "skid_axial", *(w for s in START for w in ("--set", s)))
PICTURE = 1e-3  # 25 rings of points, the outermost where the pressure ends as a root
STUDIES = {
    "end state": Study(
        (*SMALL, "--steady"),
        WORDS | SEARCH,
        again=("--steady",),
        unsolved={
            "pulled": (
                ("--set", "operating.load.Fz=-150 N"),
                "no_load_path",
                "no_load_path: No load path in uz of the inner",
            )
        },
        slow=(True, True),
    ),
    "motion": Study(RUN_UP, again=None),
    "rollers": Study((*FEW, "--steady"), again=None),
}


class TestRuns(Runs):
    """Runs of the command."""


@pytest.fixture(autouse=True)
def draw_figures(close_figures):
    """Nothing may fail or warn while a figure is drawn."""
    yield
    for number in plt.get_fignums():
        plt.figure(number).draw_without_rendering()


@pytest.fixture(scope="module")
def end():
    """The end state; slow is what looks at it, or at the motion: their programs take
    half a minute to compile."""
    return run_skid(read_skid("skid_combined", GIVEN, steady=True))


@pytest.fixture(scope="module")
def history():
    """The motion in time."""
    return run_skid(read_skid("skid_axial", START))


@pytest.mark.slow
def test_end_state(written, end):
    done, numbers, _ = written("end state")
    assert done.out == f"{skid_report(end)}\n"
    found = end.found
    assert numbers == skid_as_dict(end)
    drive, *rest = numbers["power"].values()
    np.testing.assert_allclose(sum(rest), drive, rtol=1e-8)
    for header, value in (
        ("azimuth [rad]", found.azimuth),
        ("slip", found.slip),
        ("spin_z [rad/s]", found.spin[:, 2]),
        ("sliding_speed_inner [m/s]", found.sliding_speed[:, 1]),
    ):
        column = written("end state").column(header)
        np.testing.assert_allclose(column, value, rtol=ROUNDING)


@pytest.mark.slow
def test_motion_in_time(written, history):
    done, numbers, _ = written("motion")
    assert done.out == f"{skid_report(history)}\n"
    assert "ring at the end, within the first orbit of the cage" in done.out
    labelled = history.to_xarray()
    assert labelled["peak_pressure"].dims == ("time", "ball", "contact")
    assert labelled["contact_load"].attrs["units"] == "N"
    found = history.found
    assert numbers == skid_as_dict(history)
    assert numbers["cage_speed"][0] == 0.0 < numbers["cage_speed"][-1]
    # Of what the drive does all but round-off is found again.
    assert numbers["residual"] < 1e-6
    for header, value in (
        ("time [s]", found.time),
        ("cage_speed [rad/s]", found.cage_speed),
        ("power_contacts [W]", found.power.contacts),
        ("slip_5", found.slip[:, 5]),
        ("spin_2_y [rad/s]", found.spin[:, 2, 1]),
        ("film_3_inner [m]", found.film[:, 3, 1]),
        ("cage_force_1 [N]", found.cage_force[:, 1]),
    ):
        column = written("motion").column(header)
        np.testing.assert_allclose(column, value, rtol=ROUNDING)


@pytest.mark.slow
def test_rollers(written):
    done, numbers, _ = written("rollers")
    end = run_skid(read_skid("skid_roller", ROLLERS, steady=True))
    assert done.out == f"{skid_report(end)}\n"
    found = end.found
    assert numbers == skid_as_dict(end)
    spin = np.array(numbers["spin"])  # about the roller axis alone, as that of a ball
    assert spin.shape == (7, 3) and not spin[:, :2].any()
    np.testing.assert_array_equal(spin[:, 2], found.spin[::2])
    assert "\ncage on a roller  pushes with up to" in done.out
    column = written("rollers").column("cage_force [N]")
    np.testing.assert_allclose(column, found.cage_force, rtol=ROUNDING)
    shown = {
        plot.cage_force_over_orbit: (0, found.cage_force),
        plot.heat_over_orbit: (1, found.heat[:, 1]),
        plot.spin_over_orbit: (1, found.rolling_spin),
    }
    for draw, (k, values) in shown.items():
        np.testing.assert_array_equal(lines(draw(found))[k][:-1], values)
    # The conditions of balls, one by one.
    state = found.conditions
    full = np.full_like(state.least_film, 1e-6)
    fine = state._replace(least_film=full, regime=np.full_like(state.regime, 3))
    model = end.task.model
    (slip,) = skid_warnings(model, found, fine)
    assert slip.startswith("gross skidding, slip up to")
    for changes, begins in (
        (dict(shear=full + 3.5), "shear stresses of 3.5 times the pressure by its law"),
        (dict(outside_fluid_range=full > 0), "the oil is a glass from"),
        (dict(regime=0 * state.regime), "films of all of the contacts are isoviscous"),
        (dict(least_film=0.02 * full), "films down to 0.02 µm, less than 3 times"),
    ):
        bad = eqx.tree_at(lambda f: f.conditions, found, fine._replace(**changes))
        assert skid_warnings(model, bad)[1].startswith(begins)


@pytest.mark.slow
def test_rollers_in_time(run, tmp_path):
    """From rest under turning rings: as balls, but for the spin about one axis."""
    given = (*ROLLERS[:2], "dynamics={duration='1 ms', n_times=9, start='rest'}")
    words = [word for setting in given for word in ("--set", setting)]
    picture = tmp_path / "run.png"
    done = run("skid", "skid_roller", *words, "--plot", picture)
    assert done.status == 0 and picture.stat().st_size > 20_000
    history = run_skid(read_skid("skid_roller", given))
    assert done.out == f"{skid_report(history)}\n"
    numbers, found = skid_as_dict(history), history.found
    spin = np.array(numbers["spin"])
    assert spin.shape == (9, 7, 3) and not spin[..., :2].any()
    np.testing.assert_array_equal(spin[..., 2], found.spin)
    assert numbers["slip"][0] == [1.0] * 7
    assert numbers["cage_force"] == found.cage_force.tolist()
    drawn = lines(plot.spin_over_time(found, ball=3))
    np.testing.assert_array_equal(drawn[0], found.spin[:, 3])
    assert plot.load_over_time(found).get_title() == "Load on roller 0"


@pytest.mark.slow
def test_start_at_rest_under_turning_rings():
    """A table of speeds, and of what scenes say beside it."""
    turning = "speed={time=['0 s', '1 ms'], inner=['2000 rpm', '2000 rpm']}"
    text = f"dynamics={{duration='2 ms', n_times=9, start='rest', {turning} }}"
    done = run_skid(read_skid("skid_axial", [START[0], text]))
    assert done.converged
    assert (done.found.slip[0] == 1.0).all()
    assert done.found.cage_speed[0] == 0.0 < done.found.cage_speed[-1]
    assert not done.found.potential_energy[0].any()
    assert any("gross skidding, slip up to 100 %" in text for text in done.warnings)


@pytest.mark.slow
def test_skid_output_of_incomplete_motion(run, history, tmp_path):
    """Five of nine times, as if the step limit had been met."""
    found = history.found

    def lost(values):
        values = np.array(values)
        if values.ndim and len(values) == 9 and values.dtype == float:
            values[5:] = np.nan
        return values

    half = jax.tree.map(lost, found)
    half = eqx.tree_at(
        lambda f: (f.solution, f.time, f.result),
        half,
        (found.solution, found.time, np.asarray(int(Result.STEP_LIMIT))),
    )
    ended = dataclasses.replace(history, found=half, warnings=())
    numbers = skid_as_dict(ended)
    assert numbers["result"] == "step_limit"
    assert numbers["cage_speed"][:5] == found.cage_speed[:5].tolist()
    assert numbers["cage_speed"][5:] == [None] * 4
    assert skid_message(ended).startswith("The motion was followed to 0.001 s of 0.002")
    for result, cause in (
        (Result.NON_FINITE, "take a law of traction that yields"),
        (Result.NO_LOAD_PATH, "pulls the ring out of the bearing"),
    ):
        other = eqx.tree_at(lambda f: f.result, half, np.asarray(int(result)))
        assert cause in skid_message(dataclasses.replace(ended, found=other))
    assert {len(column) for column in skid_columns(ended).values()} == {5}
    out, picture = tmp_path / "half.json", tmp_path / "half.png"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("bearingjax.studies.skid.run.run_skid", lambda *_, **__: ended)
        done = run(*RUN_UP, "--json", out, "--plot", picture)
    assert done.status == 3 and done.out == ""
    assert "bearingjax: step_limit: The motion was followed to 0.001 s" in done.err
    assert json.loads(out.read_text())["orbit_speed"][5] == [None] * 6
    assert not picture.exists()


@pytest.mark.slow
def test_report(end):
    text = str(skid_report(end))
    rolling = 12.0 / (1.0 / end.found.rolling_orbit_speed).sum()
    slip = 100.0 * (1.0 - float(end.found.cage_speed) / rolling)
    assert f"pure rolling {rolling:.6g} rad/s, slip {slip:.3g} %" in text
    assert "MIL-L-23699 at 30 °C: 37.64 mPa s, 15.11 1/GPa" in text
    assert "films: piezoviscous and elastic" in text
    drive = float(end.found.power.drive)
    assert re.search(rf"(?m)^power +drive {drive:.5g} W = contacts", text)
    assert text.count("warning: ") == 1
    assert f"warning: balls wander {1e6 * float(end.found.wander):.4g} µm" in text


@pytest.mark.slow
def test_bad_input(run):
    done = run(*SMALL, "--steady", "--set", "dynamics.places=1")
    assert done.status == 2 and "`places` is 1, but the balls bear unlike" in done.err
    done = run("skid", "deep_groove", "--steady")
    assert done.status == 2 and "`operating.inner_speed`: is missing" in done.err


def changed(state, **values):
    full = {name: np.full_like(getattr(state, name), v) for name, v in values.items()}
    return state._replace(**full)


@pytest.mark.slow
def test_skid_warnings_of_each_kind(end):
    """Each kind of warning, of conditions as they might be."""
    model, found, state = end.task.model, end.found, end.state

    def told(**values):
        wander, text = skid_warnings(model, found, changed(state, **values))
        assert "pocket clearance is 200 µm: the cage takes part" in wander
        return text

    yields = dataclasses.replace(model, traction=Newtonian())
    sheared = changed(state, shear=3.5)
    texts = skid_warnings(yields, found, sheared)
    assert texts[1].startswith(
        "shear stresses of 3.5 times the pressure by a Newtonian"
    )
    assert len(skid_warnings(model, found, changed(state, shear=0.1))) == 1
    wide = eqx.tree_at(lambda m: m.cage.pocket_clearance, model, np.array(0.02))
    (text,) = skid_warnings(wide, found, state)
    assert text.startswith("a pocket clearance of 20 mm is more than the 15.2 mm betw")
    loose = eqx.tree_at(
        lambda f: (f.contact_load, f.orbit_speed),
        found,
        (found.contact_load * np.array([1.0, 0.0]), 0.0 * found.orbit_speed),
    )
    assert "slip up to 100 %: nothing is pressed between" in " ".join(
        skid_warnings(model, loose, state)
    )
    # What carries slips less than what has lost its load.
    share = np.full_like(found.orbit_speed, 0.7)
    share[0] = 0.4
    unlike = eqx.tree_at(
        lambda f: (f.contact_load, f.orbit_speed),
        found,
        (
            found.contact_load * np.where(share > 0.5, 1.0, 0.0)[:, None] ** [0, 1],
            share * found.rolling_orbit_speed,
        ),
    )
    texts = " ".join(skid_warnings(model, unlike, state))
    assert "slip up to 60 %, of what both raceways press 30 %" in texts
    assert "range of its law in all of the contacts" in told(outside_fluid_range=True)
    rigid = told(regime=int(Regime.ISOVISCOUS_RIGID))
    assert "films of all of the contacts are isoviscous and rigid" in rigid
    assert "films down to 0.02 µm, less than 3 times" in told(least_film=2e-8)


@pytest.mark.slow
def test_skid_end_state_warns_of_ignored_keys():
    given = ("dynamics.axis=horizontal", "dynamics.load={time=['0 s'], Fy=['1 N']}")
    asked = read_skid("skid_combined", [*GIVEN, *given], steady=True)
    told = run_skid(asked).warnings
    assert told[0].startswith("the end state leaves out gravity along the orbits")
    assert told[1].startswith("the end state is that of [operating], not of a load")


def lines(ax):
    return [np.asarray(line.get_ydata()) for line in ax.get_lines()]


@pytest.mark.slow
def test_means_of_the_end_state(end):
    """The heat is that of the power balance, the speed that of `cage_slip`."""
    found = end.found
    heat, rolling = found.raceway_heat, found.rolling_cage_speed
    assert heat.shape == (2,) and (heat > 0).all()
    np.testing.assert_allclose(heat.sum(), found.power.contacts, rtol=1e-8)
    np.testing.assert_allclose(1.0 - found.cage_speed / rolling, found.cage_slip)


@pytest.mark.slow
def test_pictures_along_the_orbit(end):
    found = end.found
    outer, inner = lines(plot.load_over_orbit(found))
    np.testing.assert_array_equal(outer[:-1], found.contact_load[:, 0])
    assert inner[-1] == inner[0] == found.contact_load[0, 1]
    ax = plot.sliding_over_orbit(found)
    np.testing.assert_array_equal(lines(ax)[1][:-1], 1e3 * found.sliding_speed[:, 1])
    assert "[mm/s]" in ax.get_ylabel() and "[deg]" in ax.get_xlabel()
    for k, spin in enumerate(lines(plot.spin_over_orbit(found))):
        np.testing.assert_array_equal(spin[:-1], found.spin[:, k])


@pytest.mark.slow
def test_pictures_over_time(history):
    found = history.found
    shown = {
        plot.speed_over_time: (1, found.cage_speed),
        plot.slip_over_time: (0, 100.0 * found.slip.mean(axis=1)),
        plot.spin_over_time: (2, found.spin[:, 0, 2]),
        plot.load_over_time: (1, found.contact_load[:, 0, 1]),
        plot.sliding_over_time: (0, 1e3 * found.sliding_speed[:, 0, 0]),
        plot.cage_force_over_time: (1, found.cage_force.min(axis=1)),
        plot.power_over_time: (3, found.power.drive),
    }
    page = plot.skid_overview(history.task.model, found, history.state)
    assert "6 times are too few; at least 8" in page.axes[6].texts[0].get_text()
    for draw, (k, values) in shown.items():
        ax = draw(found)
        np.testing.assert_allclose(lines(ax)[k], values, rtol=ROUNDING)
        assert ax.get_xlabel() == "time [s]" and "[" in ax.get_ylabel()


@pytest.mark.slow
def test_spectrum_of_a_sine(history):
    """Of amplitude 3 mm/s about 5 mm/s on the fourth line; the cage is marked."""
    time = np.linspace(0.0, 1.0, 64, endpoint=False)
    slide = np.zeros((64, 6, 2, 2))
    slide[:, 0, 1, 0] = 5e-3 + 3e-3 * np.sin(2.0 * np.pi * 4.0 * time)
    found = history.found
    turning = eqx.tree_at(
        lambda f: (f.time, f.sliding, f.contact_load, f.state.cage_speed),
        found,
        (time, slide, np.ones((64, 6, 2)), np.full(64, 2.0 * np.pi * 3.0)),
    )
    got = sliding_spectrum(turning, begin=0.0)
    assert got.frequency[4] == pytest.approx(4.0)
    assert got.amplitude[4] == pytest.approx(3e-3)
    assert got.amplitude[6:].max() < 1e-12
    assert got.cage == pytest.approx(3.0)
    ax = plot.sliding_spectrum(turning, begin=0.0)
    marks = [np.asarray(line.get_xdata())[0] for line in ax.get_lines()[1:]]
    np.testing.assert_allclose(marks, 3.0 * np.arange(1, 11))
    slow = eqx.tree_at(lambda f: f.state.cage_speed, turning, np.full(64, 6.0))
    told = plot.sliding_spectrum(slow, begin=0.0).texts[0].get_text()
    assert told == "lines 1 Hz apart: too few for the cage's 0.955 Hz"
    with pytest.raises(ValueError, match="3 times are too few; at least 8"):
        sliding_spectrum(found, begin=1.5e-3)
    uneven = eqx.tree_at(lambda f: f.time, found, found.time**2)
    with pytest.raises(ValueError, match="the times are not even"):
        sliding_spectrum(uneven)


@pytest.mark.slow
def test_cage_speed_over_load(end):
    """Two cases, one of them lost."""
    two = jax.tree.map(lambda leaf: np.stack([leaf, leaf]), end.found)
    two = eqx.tree_at(lambda f: f.result, two, np.array([0, int(Result.STEP_LIMIT)]))
    speed, rolling = lines(plot.cage_speed([100.0, 200.0], two))
    assert speed[0] == float(end.found.cage_speed) and np.isnan(speed[1])
    assert (rolling > speed[0]).all()
    with pytest.raises(ValueError, match=r"`load` has the shape \(3,\)"):
        plot.cage_speed([1.0, 2.0, 3.0], two)


@pytest.mark.parametrize("sense, before, behind", [(1.0, 0, 180), (-1.0, 180, 0)])
@pytest.mark.slow
def test_zones_of_a_load_with_two_waves(end, sense, before, behind):
    """Above the mean about 90 and 270 deg, at 90 deg higher; no zones of even loads."""
    azimuth = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    wave = -60.0 * np.cos(2.0 * azimuth)
    higher = np.where(wave < 0, 1.5, np.where(azimuth < np.pi, 2.0, 1.0))
    load = np.repeat((100.0 + higher * wave)[:, None], 2, axis=1)
    flat = np.full_like(load, 0.4)
    found = eqx.tree_at(
        lambda f: (f.azimuth, f.contact_load, f.contact_angle, f.cage_speed),
        end.found,
        (azimuth, load, flat, np.asarray(80.0 * sense)),
    )
    a, b, c, d = zones(found)
    assert [zone.name for zone in (a, b, c, d)] == list("ABCD")
    middle = [np.rad2deg(0.5 * (z.begin + z.end)) % 360.0 for z in (a, b, c, d)]
    near = np.array([before, 90.0, behind, 270.0])
    apart = (np.array(middle) - near + 180.0) % 360.0 - 180.0
    np.testing.assert_allclose(apart, 0.0, atol=1e-9)
    assert b.loaded and d.loaded and not a.loaded and not c.loaded
    widths = [zone.end - zone.begin for zone in (a, b, c, d)]
    np.testing.assert_allclose(sum(widths), 2.0 * np.pi, rtol=ROUNDING)
    single = eqx.tree_at(lambda f: f.contact_load, found, np.full_like(load, 100.0))
    assert zones(single) == []


@pytest.mark.slow
def test_sliding_ellipse_heat_matches_contact_heat(end):
    """The integral over the points of the picture, by Simpson's rule."""
    found, model = end.found, end.task.model
    at = 3, 0
    ellipse = sliding_ellipse(model, found, end.state, at)
    radius = np.linspace(0.0, 1.0, len(ellipse.heat))
    around = ellipse.heat[:, :-1].mean(axis=1)
    whole = 2.0 * np.pi * np.prod(end.state.semi_axes[at])
    total = whole * simpson(around * radius, x=radius)
    np.testing.assert_allclose(total, found.heat[at], rtol=PICTURE)
    mesh: Any = plot.sliding_map(ellipse).collections[0]
    speed = 1e3 * np.linalg.norm(ellipse.slip, axis=-1)
    np.testing.assert_allclose(mesh.get_array().ravel(), speed.ravel(), rtol=ROUNDING)
    # In the middle the slip is that of the ball.
    np.testing.assert_allclose(ellipse.slip[0, 0], found.sliding[at], rtol=ROUNDING)

"""Scenes of noise: what they say, and one line for what is wrong."""

import dataclasses

import jax
import numpy as np
import pytest
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.design.form_error import FormErrors, Harmonics, RacewayErrors, Spall
from bearingjax.design.tolerance import running_accuracy
from bearingjax.noise import NoiseModel, Rectangular, Sensor, Tolerances
from bearingjax.noise.reference_levels import NORM
from bearingjax.scene import read_noise, scene_files, shipped_scenes

SHIPPED = ("noise_cylindrical", "noise_deep_groove", "noise_four_point", "noise_pair")
WAVE = "part='outer raceway', order=3, amplitude='1 um'"
SPECTRUM = "part='elements', lowest=2, amplitude='1 um', slope=1"

# Settings of noise_four_point, and the message after "noise_four_point.toml: ".
WRONG = {
    "no table": (
        "vibration=1",
        "`vibration`: 1 is not a table",
    ),
    "unknown key": (
        "vibration.sensor_stifness=1 N/mm",
        "`vibration.sensor_stifness`: unknown key (did you mean `sensor_stiffness`?);"
        " known in [vibration]: bands, bridging, mass, moving_ring, norm, reference,"
        " retardation, samples, sensor_damping, sensor_direction, sensor_stiffness,"
        " settle, steps, tilting_inertia, tolerance, turns, window",
    ),
    "mass as a length": (
        "vibration.mass=3 mm",
        "`vibration.mass`: '3 mm' is not a mass; a mass with its unit is wanted,",
    ),
    "no mass": (
        "vibration.mass=0 kg",
        "[vibration]: NoiseModel: `mass` is 0 kg; it must be above 0 kg",
    ),
    "the ring that is fixed": (
        "vibration.moving_ring=inner",
        "`vibration.moving_ring`: 'inner' is the `fixed_ring` of [operating]; it must",
    ),
    "ring": (
        "vibration.moving_ring=both",
        "`vibration.moving_ring`: 'both' is not known; it must be one of outer, inner",
    ),
    "freedoms": (
        "operating.free=['ux', 'uy', 'uz', 'gx']",
        "`operating.free`: is not that of a vibration: the ring shifts in ux, uy and",
    ),
    "at rest": (
        "operating.inner_speed=0 rpm",
        "`operating.inner_speed`: is zero, and so is `outer_speed`; nothing",
    ),
    "prescribed turn": (
        "operating.prescribed.gz=1 mrad",
        "`operating.prescribed`: is not that of a vibration: the ring shifts in ux, uy",
    ),
    "one tilt": (
        "operating.prescribed.gx=0 mrad",
        "`operating.prescribed`: is not that of a vibration: the ring shifts in ux, uy",
    ),
    "inertia of another kind": (
        "vibration.tilting_inertia=free",
        "`vibration.tilting_inertia`: 'free' does not begin with a finite",
    ),
    "row of a bearing": (
        f"deviations.waves=[{{{WAVE}, row=0}}]",
        "`deviations.waves[0].row`: is of sets; the bearing has one row",
    ),
    "direction of the sensor": (
        "vibration.sensor_direction=up",
        "`vibration.sensor_direction`: 'up' is not known; it must be x, y, z or three",
    ),
    "two numbers": (
        "vibration.sensor_direction=[1, 0]",
        "`vibration.sensor_direction`: [1, 0] is not known; it must be x, y, z or",
    ),
    "odd samples": (
        "vibration.samples=2047",
        "`vibration.samples`: 2047 is odd; it must be even",
    ),
    "too long": (
        "vibration.turns=1000",
        "`vibration.samples`: 1002 turns of 2048 are too many; at most 200000 samples",
    ),
    "half a turn": (
        "vibration.turns=0.5",
        "`vibration.turns`: 0.5 is not a whole number of at least 1",
    ),
    "reference": (
        "vibration.reference=0 m/s^2",
        "`vibration.reference`: 0 m/s² is not allowed; above 0",
    ),
    "norm of another reference": (
        "vibration.reference=1e-6 m/s^2",
        "`vibration.norm`: counts from 3.1e-05 m/s²; leave out `reference`",
    ),
    "norm of thirds": (
        "vibration.bands=third_octave",
        "`vibration.norm`: is of octaves; take `bands` = octave",
    ),
    "bands": (
        "vibration.bands=thirds",
        "`vibration.bands`: 'thirds' is not known; it must be one of octave,",
    ),
    "damping as a number": (
        "vibration.retardation=2",
        "`vibration.retardation`: 2 has no unit; a time with its unit is wanted",
    ),
    "unknown errors": (
        "deviations.wave=[]",
        "`deviations.wave`: unknown key (did you mean `waves`?); known in [deviations]",
    ),
    "part": (
        "deviations.spectrum.0.part=outer race",
        "`deviations.spectrum[0].part`: 'outer race' is not known (did you mean `outer",
    ),
    "direction of a wave": (
        "deviations.spectrum.1.direction=radial",
        "`deviations.spectrum[1].direction`: 'radial' is not known",
    ),
    "direction of balls": (
        "deviations.spectrum.2.direction=raised",
        "`deviations.spectrum[2].direction`: is of raceways; an element has a height",
    ),
    "element of a raceway": (
        f"deviations.waves=[{{{WAVE}, element=1}}]",
        "`deviations.waves[0].element`: goes with `part` = elements",
    ),
    "ball that is not there": (
        f"deviations.spectrum=[{{{SPECTRUM}, highest=9, element=14}}]",
        "`deviations.spectrum[0].element`: 14 is not there; the elements are 0 to 13",
    ),
    "order of an element": (
        f"deviations.spectrum=[{{{SPECTRUM}, highest=500}}]",
        "`deviations.spectrum[0].highest`: 500 is not a whole number from 1 to 110",
    ),
    "orders that fall": (
        f"deviations.spectrum=[{{{SPECTRUM}, highest=1}}]",
        "`deviations.spectrum[0].highest`: 1 is below `lowest`, 2",
    ),
    "order zero": (
        "deviations.waves=[{part='outer raceway', order=0, amplitude='1 um'}]",
        "`deviations.waves[0].order`: 0 is not a whole number from 1 to 900",
    ),
    "an order twice": (
        "deviations.waves=[{part='outer raceway', order=[3, 3], amplitude='1 um'}]",
        "`deviations.waves[0].order`: [3, 3] names an order twice",
    ),
    "amplitudes": (
        "deviations.waves=[{part='outer raceway', order=[2, 3], amplitude=['1 um']}]",
        "`deviations.waves[0].amplitude`: has 1 values for 2 orders",
    ),
    "negative amplitude": (
        "deviations.waves=[{part='outer raceway', order=2, amplitude='-1 um'}]",
        "`deviations.waves[0].amplitude`: is negative; turn the `phase` by 180 deg",
    ),
    "waves as high as the groove is open": (
        "deviations.waves=[{part='outer raceway', order=2, amplitude='1 mm'}]",
        "[vibration]: Harmonics: `amplitude` is 0.001 m; it must be below",
    ),
    "spall all around": (
        "deviations.spalls=[{part='inner raceway', length='1 m', depth='9 um'}]",
        "[vibration]: Spall: `length` is 1 m; it must be below",
    ),
    "amplitude as an angle": (
        "deviations.waves=[{part='inner raceway', order=2, amplitude='1 deg'}]",
        "`deviations.waves[0].amplitude`: '1 deg' is not a length; a length with its",
    ),
    "profile of nothing": (
        "deviations.profile=[{part='inner raceway'}]",
        "`deviations.profile[0].points`: give either heights here or a `file` of them",
    ),
    "few points": (
        "deviations.profile=[{part='inner raceway', points=['1 um', '2 um']}]",
        "[deviations.profile[0]]: Harmonics: `points` is",
    ),
    "file that is not there": (
        "deviations.profile=[{part='inner raceway', file='none.csv'}]",
        "`deviations.profile[0].file`: none.csv: cannot be read: No such file",
    ),
    "grade of balls": (
        "vibration.tolerance={grade='G11'}",
        "`vibration.tolerance.grade`: 'G11' is not known",
    ),
    "class without sizes": (
        "vibration.tolerance={grade='G10', class='P5'}",
        "`vibration.tolerance.bore`: is missing; it must be a length",
    ),
    "nothing scatters": (
        "vibration.tolerance={slope=2}",
        "`vibration.tolerance.grade`: is missing, and so is everything that scatters",
    ),
    "class without a grade": (
        "vibration.tolerance={class='P5', bore='55 mm', outside_diameter='100 mm'}",
        "`vibration.tolerance.class`: goes with a `grade`; or give the eccentricities",
    ),
    "flat spall": (
        "deviations.spalls=[{part='inner raceway', length='1 mm', depth='0 mm'}]",
        "`deviations.spalls[0].depth`: 0 m is not allowed; above 0 m",
    ),
    "spall on a ball": (
        "deviations.spalls=[{part='elements', length='1 mm', depth='9 um'}]",
        "`deviations.spalls[0].element`: is missing; number of the element with the",
    ),
    "direction of a spall": (
        "deviations.spalls=[{part='inner raceway', length='1 mm', depth='9 um',"
        " direction='raised'}]",
        "`deviations.spalls[0].direction`: is not of spalls, which lower the surface",
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_scene_is_told_in_one_line(what):
    setting, message = WRONG[what]
    with pytest.raises(SceneError) as caught:
        read_noise("noise_four_point", [setting])
    assert str(caught.value).startswith(f"noise_four_point.toml: {message}")
    assert "\n" not in str(caught.value)


PAIR = {
    "row": (
        f"deviations.waves=[{{{WAVE}, row=2}}]",
        "`deviations.waves[0].row`: 2 is not there; the rows are 0 to 1",
    ),
    "spall of no row": (
        "deviations.spalls=[{part='inner raceway', length='1 mm', depth='9 um'}]",
        "`deviations.spalls[0].row`: is missing; number of the row with the spall",
    ),
    "spring": (
        "set={arrangement='back_to_back', spacing='40 mm', spring_force='200 N'}",
        "[vibration]: NoiseModel: `element` has a row that a spring presses",
    ),
}


@pytest.mark.parametrize("what", PAIR)
@pytest.mark.slow
def test_a_wrong_scene_of_a_set_is_told_in_one_line(what):
    setting, message = PAIR[what]
    with pytest.raises(SceneError) as caught:
        read_noise("noise_pair", [setting])
    assert str(caught.value).startswith(f"noise_pair.toml: {message}")
    assert "\n" not in str(caught.value)


def test_rows_of_a_set_have_errors_of_their_own():
    one, other = read_noise("noise_pair").model.errors_of_rows
    assert len(one.inner.outwards) == 1 and len(other.inner.outwards) == 2
    waves = [row.outer.outwards[0] for row in (one, other)]
    phases = [np.asarray(w.phase) for w in waves if isinstance(w, Harmonics)]
    assert not np.array_equal(*phases)


def test_rings_of_spherical_rollers_shift_and_washers_of_cylinders_do_not():
    settings = ["vibration.mass=4 kg", "operating.inner_speed=1500 rpm"]
    model = read_noise("spherical_roller", settings).model
    assert model.freedoms == ("ux", "uy", "uz")
    with pytest.raises(SceneError, match="'cylindrical_thrust_roller' has no noise he"):
        read_noise("thrust_roller", settings)


def test_a_bearing_without_a_rig_has_no_noise():
    with pytest.raises(SceneError, match="deep_groove.toml: `vibration`: is missing"):
        read_noise("deep_groove", ["operating.inner_speed=1500 rpm"])


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scenes_read(name):
    task = read_noise(name)
    assert task.name == name and task.warnings == ()
    assert task.turns >= 6 and task.samples == 2048
    assert jax.tree.leaves(task.model.errors)
    # The other commands find what they know in them.
    assert bj.read_scene(name).load == tuple(map(float, task.model.load))


def test_read_noise_four_point_matches_paper_tables():
    task = read_noise("noise_four_point")
    model = task.model
    bearing = model.element.bearing
    assert isinstance(bearing, bj.FourPointBallBearing) and bearing.n_balls == 14
    sizes = bearing.ball_diameter, bearing.radial_internal_clearance
    assert np.allclose(sizes, [14.288e-3, 40e-6], rtol=ROUNDING)
    large = np.flatnonzero(bearing.ball_deviation)
    assert large.tolist() == [0, 7]  # opposite each other
    assert np.allclose(bearing.ball_deviation[large], 24e-6)
    assert np.allclose(model.load, [0.0, -25.0, 85.0, 0.0, 0.0, 0.0])
    assert float(model.speed.inner) == pytest.approx(50.0 * np.pi)
    assert float(model.sensor.stiffness) == pytest.approx(1e4)
    assert model.moving_ring == "outer" and task.scene.moving_ring == "outer"
    assert np.array_equal(task.norm, NORM) and len(task.bands.centre) == len(NORM)
    waves = model.errors_of_rows[0].outer.outwards[0]
    assert isinstance(waves, Harmonics)
    # Tens of nanometres at most at order 10.
    assert 5e-9 < float(waves.amplitude[waves.order.index(10)]) < 50e-9


def test_all_keys():
    task = read_noise(
        "noise_deep_groove",
        [
            "operating.load={Fz='90 N', Mx='0.2 N m'}",
            "vibration={mass='0.2 kg', turns=3, settle=0, samples=32, steps=5,"
            " retardation='4 us', tilting_inertia='3e-4 kg m^2', moving_ring='outer',"
            " reference='1e-6 m/s^2', bands='octave', window='rectangular',"
            " sensor_stiffness='3 N/mm', sensor_damping='7 N s/m',"
            " sensor_direction=[1, 0, 2]}",
            "deviations={"
            "waves=[{part='inner raceway', direction='axial', order=[2, 5],"
            " amplitude=['2 um', '1 um'], phase='90 deg'},"
            " {part='elements', element=3, order=4, amplitude='1 um'}],"
            "profile=[{part='outer raceway', direction='raised',"
            " points=['1 um', '0 um', '-1 um', '0 um'], highest=1}],"
            "spalls=[{part='outer raceway', angle='45 deg', length='2 mm',"
            " depth='10 um'},"
            " {part='elements', element=0, length='1 mm', depth='5 um'}]}",
        ],
    )
    errors = FormErrors(
        RacewayErrors(
            raised=(
                Harmonics(1, 1e-6, 0.0),
                Spall(np.pi / 4, 2e-3, 1e-5),
            )
        ),
        RacewayErrors(axial=Harmonics([2, 5], [2e-6, 1e-6], [np.pi / 2] * 2)),
        (
            Harmonics(4, 1e-6 * np.eye(9)[3][:, None], np.zeros((9, 1))),
            Spall(np.zeros(9), np.full(9, 1e-3), 5e-6 * np.eye(9)[0]),
        ),
    )
    wanted = NoiseModel(
        task.scene.element, 0.2, [0, 0, 90, 0.2, 0, 0], bj.Speed(inner=60 * np.pi),
        errors, 3e-4, Sensor(3e3, 7.0, [1.0, 0.0, 2.0]), 4e-6, "outer",
    )  # fmt: skip
    assert jax.tree.structure(task.model) == jax.tree.structure(wanted)
    pairs = zip(jax.tree.leaves(task.model), jax.tree.leaves(wanted), strict=True)
    for a, b in pairs:
        assert np.allclose(a, b, rtol=ROUNDING, atol=1e-15), (a, b)
    assert (task.turns, task.settle, task.samples, task.steps) == (3, 0, 32, 5)
    assert task.reference == 1e-6 and isinstance(task.window, Rectangular)
    assert task.norm is None


def test_tolerances_by_grade_and_by_number():
    table = (
        "vibration.tolerance={grade='G10', class='P5', bore='25 mm', seed=4,"
        " outside_diameter='52 mm', waviness='50 nm', slope=1.5, highest=60,"
        " inner_eccentricity='3 um'}"
    )
    task = read_noise("noise_deep_groove", [table], bearings=5)
    bearing = task.model.element.bearing
    wanted = Tolerances.of_grade(
        "G10", bearing, runout=running_accuracy("P5", 0.025, 0.052), waviness=50e-9,
        slope=1.5, highest=60,
    )  # fmt: skip
    wanted = dataclasses.replace(wanted, inner_eccentricity=3e-6)
    assert jax.tree.structure(task.tolerances) == jax.tree.structure(wanted)
    pairs = zip(jax.tree.leaves(task.tolerances), jax.tree.leaves(wanted), strict=True)
    assert all(np.allclose(a, b, rtol=ROUNDING) for a, b in pairs)
    assert (task.seed, task.bearings) == (4, 5)


def test_read_noise_random_bearings_keep_common_errors():
    """Waves and spalls; spectra, profiles and unlike balls are of one bearing alone."""
    task = read_noise("noise_deep_groove", bearings=2)
    one, line = (model.errors_of_rows[0] for model in (task.model, task.line))
    assert len(one.outer.outwards) == 2 and len(one.elements) == 1
    assert line.outer.outwards == one.outer.outwards[:1]
    assert line.elements == ()
    assert task.model.element.bearing.ball_deviation is not None
    assert task.line.element.bearing.ball_deviation is None


def test_tighter_grades_and_classes_make_less_of_their_sources():
    table = (
        "vibration.tolerance={grade='G10', class='P6', bore='25 mm',"
        " outside_diameter='52 mm', outer_eccentricity='3 um'}"
    )
    task = read_noise("noise_deep_groove", [table], bearings=2)
    (grade, balls), (rings, runout) = task.tighter
    assert grade == "grade G5 in place of G10" and rings == "class P5 in place of P6"
    # ISO 3290-1: lots of 0.25 and 0.13 um, form 0.25 and 0.13 um.
    assert balls.keys() == {"diameter", "elements"}
    assert all(0.4 < ratio < 0.6 for ratio in balls.values())
    # What is given by its number follows from no class.
    assert (
        runout.keys() == {"inner_eccentricity"}
        and 0.3 < runout["inner_eccentricity"] < 1
    )
    best = "vibration.tolerance={grade='G3'}"
    assert read_noise("noise_deep_groove", [best], bearings=2).tighter == ()


def test_read_noise_moving_ring():
    for settings, moving in (
        (["operating.fixed_ring=outer"], "inner"),
        (["operating.fixed_ring=outer", "vibration.moving_ring=inner"], "inner"),
        (["operating.fixed_ring=inner", "vibration.moving_ring=outer"], "outer"),
    ):
        assert read_noise("noise_deep_groove", settings).model.moving_ring == moving


HELD = (
    ["vibration.tilting_inertia=held"],
    ["operating.free=['ux', 'uy', 'uz']"],
    # As `bearingjax new` writes it.
    ["operating.prescribed={gx='0 mrad', gy='0 mrad'}"],
)


@pytest.mark.parametrize("settings", HELD, ids=lambda s: s[0].partition("=")[0])
def test_read_noise_held_tilt(settings):
    free, held = (
        read_noise("noise_four_point"),
        read_noise("noise_four_point", settings),
    )
    assert free.model.freedoms[3:] == ("gx", "gy") and held.model.inertia is None
    echo = free.inputs["vibration"]["tilting_inertia"]
    assert echo.endswith(" kg m²") and "prescribed" not in held.inputs["operating"]
    assert held.inputs["vibration"]["tilting_inertia"] == "held"
    given = read_noise("noise_four_point", [f"vibration.tilting_inertia={echo}"])
    assert float(given.model.inertia) == pytest.approx(float(free.model.inertia))


def test_read_noise_rejects_moment_with_held_tilt():
    moment = "operating.load={Fz='85 N', Mx='1 N m'}"
    assert read_noise("noise_four_point", [moment]).model.load[3] == 1.0
    with pytest.raises(SceneError, match="NoiseModel: `load` is .*it does not tilt"):
        read_noise("noise_four_point", [moment, "vibration.tilting_inertia=held"])
    both = ["vibration.tilting_inertia=1e-4 kg m^2", *HELD[2]]
    with pytest.raises(SceneError, match=r"\[operating\] holds gx and gy; choose one"):
        read_noise("noise_four_point", both)


def test_a_seed_draws_the_same_phases_again():
    def phases(*settings):
        errors = read_noise("noise_four_point", settings).model.errors_of_rows[0]
        waves = errors.outer.outwards[0]
        assert isinstance(waves, Harmonics)
        return np.asarray(waves.phase)

    assert np.array_equal(phases(), phases())
    assert not np.array_equal(phases(), phases("deviations.spectrum.0.seed=9"))


def test_a_profile_from_a_file(tmp_path):
    text = shipped_scenes()["noise_deep_groove"].read_text(encoding="utf-8")
    profile = '\n[[deviations.profile]]\npart = "inner raceway"\nfile = "round.csv"\n'
    path = tmp_path / "mine.toml"
    path.write_text(text + profile, encoding="utf-8")
    angle = 2.0 * np.pi * np.arange(12) / 12
    heights = 3.0 + 0.5 * np.cos(2 * angle) + 0.2 * np.sin(5 * angle)
    rows = "\n".join(f"{h:.17g}" for h in heights)
    (tmp_path / "round.csv").write_text(f"height [um]\n{rows}\n", encoding="utf-8")
    waves = read_noise(path).model.errors_of_rows[0].inner.outwards[-1]
    assert isinstance(waves, Harmonics)
    assert waves.order == (1, 2, 3, 4, 5)
    assert np.allclose(waves.amplitude, [0, 0.5e-6, 0, 0, 0.2e-6], atol=1e-15)
    assert float(waves.phase[4]) == pytest.approx(-np.pi / 2)
    assert scene_files(path) == [path, tmp_path / "round.csv"]
    (tmp_path / "round.csv").write_text("size [um]\n1\n2\n3\n4\n", encoding="utf-8")
    with pytest.raises(SceneError, match=r"profile\[0\].file`: must have one column"):
        read_noise(path)
    (tmp_path / "round.csv").write_text("height [um]\n", encoding="utf-8")
    with pytest.raises(SceneError, match=r"round.csv: has no heights; a header and"):
        read_noise(path)

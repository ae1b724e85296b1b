"""Scenes of noise, and what `bearingjax noise` makes of them."""

import dataclasses
import json
import re
import wave
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from runs import WORDS, Runs, Study
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax import SceneError
from bearingjax.design.form_error import FormErrors, Harmonics, RacewayErrors, Spall
from bearingjax.design.tolerance import running_accuracy
from bearingjax.files import shipped_scenes
from bearingjax.files.output_files import scene_files
from bearingjax.noise import (
    Line,
    NoiseModel,
    Rectangular,
    Sensor,
    Spectrum,
    Tolerances,
    Vibration,
    model_warnings,
    natural_modes,
    needed_steps,
    record_warnings,
    ring_modes,
)
from bearingjax.noise.level import NORM
from bearingjax.noise.warning import _short_waves
from bearingjax.numerics import Result
from bearingjax.studies.noise import run as noise_run
from bearingjax.studies.noise.output import noise_as_dict
from bearingjax.studies.noise.read import read_noise
from bearingjax.studies.noise.report import _measured, _own_envelope
from bearingjax.studies.noise.run import Envelope, band_within, run_noise

SHIPPED = ("noise_cylindrical", "noise_deep_groove", "noise_four_point", "noise_pair")
WAVE = "part='outer raceway', order=3, amplitude='1 um'"
SPECTRUM = "part='elements', lowest=2, amplitude='1 um', slope=1"


def test_rows_of_a_set_have_errors_of_their_own():
    one, other = read_noise("noise_pair").model.errors_of_rows
    assert len(one.inner.outwards) == 1 and len(other.inner.outwards) == 2
    waves = [row.outer.outwards[0] for row in (one, other)]
    phases = [np.asarray(w.phase) for w in waves if isinstance(w, Harmonics)]
    assert not np.array_equal(*phases)


def test_rings_of_spherical_rollers_shift():
    settings = ["vibration.mass=4 kg", "operating.inner_speed=1500 rpm"]
    model = read_noise("spherical_roller", settings).model
    assert model.freedoms == ("ux", "uy", "uz")


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scenes_read(name):
    task = read_noise(name)
    assert task.name == name and task.warnings == ()
    assert task.vibration.turns >= 6 and task.vibration.samples == 2048
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
    assert [*task.counts.values(), task.vibration.steps] == [3, 0, 32, 5]
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
        slope=1.5, highest=(60, 40),
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


def write_wav(path, samples, rate=6400):
    from scipy.io import wavfile

    wavfile.write(path, rate, samples)


SAMPLES = 2.0 * np.cos(2 * np.pi * 50.0 * np.arange(640) / 6400)
"""Of 5 periods of 50 Hz [m/s²]."""


def columns(head, *values):
    rows = "\n".join(
        ",".join(f"{x:.10g}" for x in row) for row in zip(*values, strict=True)
    )
    return f"{head}\n{rows}\n"


@pytest.mark.parametrize(
    "kind", ["csv", "spectrum", "16 bit", "8 bit", "float", "bare"]
)
def test_measured_line_has_its_frequency_and_amplitude(kind, tmp_path):
    path, told = tmp_path / "run.wav", {"full_scale": "'4 m/s^2'"}
    if kind == "csv":
        path, told = tmp_path / "run.csv", {}
        time = 0.3 + np.arange(641) / 6400  # one more than an even number
        values = np.append(SAMPLES, 2.0)
        path.write_text(columns("time [ms],acceleration [m/s^2]", 1e3 * time, values))
    elif kind == "spectrum":
        path, told = tmp_path / "run.csv", {}
        lines = [0.0, 40.0, 50.0, 60.0], [0.0, 0.0, 200.0, 0.0]
        path.write_text(columns("frequency [Hz],amplitude [cm/s^2]", *lines))
    elif kind == "float":
        write_wav(path, np.stack([0 * SAMPLES, SAMPLES / 4.0], 1).astype(np.float32))
        told["channel"] = "1"
    elif kind == "8 bit":
        write_wav(path, np.round(128 + 32 * SAMPLES).astype(np.uint8))
    else:
        write_wav(path, np.round(8192 * SAMPLES).astype(np.int16))
        told = {} if kind == "bare" else told
    settings = [f"vibration.measured.{key}={value}" for key, value in told.items()]
    given = [f"vibration.measured.file='{path}'", "vibration.window=hann", *settings]
    scene = read_noise("noise_deep_groove", given)
    found = scene.measured
    assert found is not None and found.name == path.name
    size = np.abs(np.asarray(found.spectrum.amplitude))
    k = int(np.argmax(size))
    assert found.spectrum.frequency[k] == pytest.approx(50.0)
    assert found.has_unit is (kind != "bare")
    assert size[k] == pytest.approx(2.0 if found.has_unit else 0.5, rel=2e-3)
    samples = found.samples
    assert (samples is None) is (kind == "spectrum")
    if samples is not None:
        unit = 1.0 if found.has_unit else 0.25
        np.testing.assert_allclose(samples, unit * SAMPLES, atol=0.04)
    assert scene.inputs["vibration"]["measured"]["file"] == str(path)
    assert path in scene_files("noise_deep_groove", given)


def test_envelope_has_what_the_record_holds_of_its_band():
    assert band_within((900.0, 4000.0), 6000.0) == (900.0, 3000.0)
    assert band_within((900.0, 4000.0), 1e4) == (900.0, 4000.0)


def test_report_tells_the_measured_envelope_in_its_unit_or_why_there_is_none():
    lines = Line(0.4, 20.0, 0.05, "unnamed"), Line(0.8, 40.0, 0.06, "cage")
    waves = jnp.arange(3.0), jnp.arange(3.0), jnp.full(3, 0.1 + 0j)
    found = Spectrum(*waves, Rectangular())
    known = SimpleNamespace(
        name="a.wav", spectrum=found, has_unit=False, rate=64.0, samples=SAMPLES
    )
    task = SimpleNamespace(measured=known, model=SimpleNamespace(sensor=None))
    envelope = Envelope((9.0, 32.0), found, lines)
    analysis = SimpleNamespace(
        spectrum=found, envelope=envelope, measured_envelope=envelope
    )
    run = SimpleNamespace(task=task, analysis=analysis)
    _, told = _measured(run)
    assert str(told).startswith("its envelope of 9 to 32 Hz, mean 0.1: largest lines")
    assert "m/s²" not in str(told) and str(told).index("cage") < str(told).index("20 ")
    own = "along the loudest axis, envelope of 9 to 32 Hz, mean 0.1 m/s²: largest"
    assert str(_own_envelope(run)).startswith(own)
    analysis.measured_envelope = None
    assert _measured(run)[1:] == ["its rate is too low for the band of the envelope"]
    known.samples = None  # of a spectrum there is none
    assert len(_measured(run)) == 1 and str(_own_envelope(run)).startswith("envelope")


BAD_RECORDS = {
    "few": (columns("time [s],acceleration [m/s^2]", [0, 1], [1, 2]), "has 2 samples"),
    "uneven": (
        columns("time [s],acceleration [m/s^2]", np.arange(99) ** 1.1, np.arange(99)),
        "time steps are uneven, as at row",
    ),
    "no number": ("time [s],acceleration [m/s^2]\n0,nan\n", "is not a finite number"),
    "unknown unit": ("time [s],acceleration [V]\n0,1\n", "the unit of acceleration"),
    "no unit": ("time,acceleration [m/s^2]\n0,1\n", "time has no unit"),
    "other columns": ("time [s],level [dB]\n0,1\n", "must have the columns"),
    "falling": ("frequency [Hz],amplitude [m/s^2]\n9,1\n5,1\n", "frequencies must"),
}


@pytest.mark.parametrize("name", [*BAD_RECORDS, "no WAV", "stereo", "nan", "none"])
def test_read_noise_rejects_measured_file(name, tmp_path):
    path = tmp_path / "run.csv"
    if name in BAD_RECORDS:
        text, told = BAD_RECORDS[name]
        path.write_text(text, encoding="utf-8")
    else:
        path = tmp_path / "run.wav"
        told = "is no WAV file that can be read"
        if name == "stereo":
            write_wav(path, np.zeros((99, 2), np.int16))
            told = "`vibration.measured.channel`: must be one of 0 to 1, the channels"
        elif name == "nan":
            write_wav(path, np.full(99, np.nan, np.float32))
            told = "has samples that are no numbers"
        elif name == "no WAV":
            path.write_text("no sound")
    with pytest.raises(SceneError, match=re.escape(told)):
        read_noise("noise_deep_groove", [f"vibration.measured.file='{path}'"])


# Of the command.

# Seven balls, one turn: what all tests here share is compiled once.
SCENE = """
[bearing]
type = "deep_groove_ball"
n_balls = 7
pitch_diameter = "40 mm"
ball_diameter = "9 mm"
outer_osculation = 0.52
inner_osculation = 0.52
radial_internal_clearance = "10 um"

[operating]
fixed_ring = "inner"
load = { Fz = "100 N" }
inner_speed = "3000 rpm"

[vibration]
mass = "0.1 kg"
tilting_inertia = "held"
turns = 1
settle = 0
samples = 64
retardation = "2 us"
sensor_stiffness = "5 N/mm"
sensor_direction = [0, 3, 4]
norm = "85-176211"

[vibration.tolerance]
diameter = "0.2 um"
inner_eccentricity = "1 um"
seed = 3

[[deviations.waves]]
part = "inner raceway"
order = 8
amplitude = "0.2 um"
"""
STANDING = "standing under the load: "
STUDIES = {
    "one turn": Study(
        ("noise", SCENE),
        files={f"--{n}": f"a.{n}" for n in ("json", "table", "wav", "plot")}
        | {"--table": "a.csv", "--plot": "a.png"},
        unsolved={
            "huge load": (
                ("--set", "operating.load.Fz=1e12 N"),
                "non_finite",
                f"non_finite: {STANDING}",
            ),
            "no load": (
                ("--set", "operating.load.Fz=0 N"),
                "no_load_path",
                f"no_load_path: {STANDING}nothing presses the",
            ),
        },
    )
}


class TestRuns(Runs):
    """Runs of the command."""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.slow
def test_every_file_holds_the_same_record(written):
    done, found, paths = written("one turn")
    acceleration = np.array(found["acceleration"])
    assert acceleration.shape == (64, 3) and found["direction"] == ["x", "y", "z"]
    assert np.allclose(found["time"], np.arange(64) / 64 / 50.0, rtol=ROUNDING)
    # Level of the root mean square about the mean, weighted by Hann, over 0.31e-4 m/s².
    hann = 1.0 - np.cos(2.0 * np.pi * np.arange(64) / 64)[:, None]
    about = acceleration - (hann * acceleration).mean(axis=0)
    size = np.sqrt(((hann * about) ** 2).mean(axis=0) / 1.5)
    assert found["reference"] == 0.31e-4
    level = 20.0 * np.log10(size / 0.31e-4)
    assert np.allclose(found["level"], level, rtol=SOLVER)
    # A line of some five periods: the window leans on those in the middle.
    (total,) = (one for one in found["warnings"] if "window the total" in one)
    away = level - 20.0 * np.log10(acceleration.std(axis=0) / 0.31e-4)
    most = away[np.argmax(np.abs(away))]
    assert total.startswith(f"with its window the total level is {abs(most):.2g} dB")
    assert ("below" if most < 0 else "above") in total
    bands = found["bands"]
    assert bands["centre"] == [4, 8, 16, 31.5, 63, 125, 250, 500, 1e3, 2e3, 4e3, 8e3]
    assert np.shape(bands["level"]) == (12, 3)
    # One turn of 20 ms in 64 samples: lines 50 Hz apart, up to 1120 Hz; the one line,
    # at 264 Hz, spreads over the octaves beside its own.
    held = [row[1] is not None for row in bands["level"]]
    assert held == [False] * 6 + [True] + [False] * 5
    states = found["contact_states"]
    assert states["contacts"] == [0, 1, 2] and states["samples"] == [0, 0, 7 * 64]
    assert states["switches_per_turn"] == 0.0
    for line in found["lines"]:
        assert line["frequency"] == pytest.approx(50.0 * line["order"])
    rows = written("one turn").rows
    assert rows[0][:3] == ["time [s]", "acceleration_x [m/s²]", "acceleration_y [m/s²]"]
    written = np.array([[float(v) for v in row] for row in rows[1:]])
    assert np.array_equal(written[:, 1:4], acceleration)
    assert np.array_equal(written[:, 4:], found["displacement"])
    _same_sound(paths["--wav"], acceleration, done.out)
    for words in (
        "the outer ring moves, 0.1 kg, and does not tilt\nloaded by Fz 100 N; inner",
        "record of 1 turn, 0.02 s, after 0 to settle; 64 samples",
        "natural modes of the ring: ",
        "2 for 100 % of the time; 0 open or close per turn of the shaft",
        "warning: the record of 0.02 s is too short for the bands up to 63 Hz; raise",
        "warning: the record of 0.02 s has too few samples for the bands from 1000 Hz",
        "are left out for that: 125, 500 Hz; raise `vibration.turns`, to 2 ",
    ):
        assert words in done.out, words


def _same_sound(path, acceleration, told):
    """What full scale stands for is the largest acceleration along the sensor."""
    with wave.open(str(path)) as file:
        assert file.getnframes() >= 3 * file.getframerate()
    along = acceleration @ [0.0, 0.6, 0.8]
    full = float(told.partition("full scale is ")[2].split()[0])
    assert full == pytest.approx(np.abs(along - along.mean()).max(), rel=0.15)


@pytest.mark.slow
def test_a_model_by_hand_vibrates_alike(scene):
    task = read_noise(scene)
    found = run_noise(task)
    record, lines = found.analysis.record, found.analysis.spectrum
    labelled = found.to_xarray()
    assert labelled["band_level"].dims == ("band", "direction")
    assert np.array_equal(labelled["frequency"], lines.frequency)
    assert np.array_equal(labelled["mode_frequency"], found.modes.frequency)
    assert list(found.warnings) == [
        *model_warnings(task.model, task.vibration.samples, found.steps),
        *record_warnings(task.model, record, lines, task.bands),
    ]
    modes = natural_modes(task.model)
    assert np.array_equal(found.modes.frequency, modes.frequency)
    assert found.analysis is not None and found.steps > 1
    # Twice the wave, twice the vibration, as long as all balls bear.
    (waves,) = task.model.errors_of_rows[0].inner.outwards
    assert isinstance(waves, bj.design.Harmonics)
    amplitude = waves.amplitude
    twice = dataclasses.replace(
        task,
        model=jax.tree.map(
            lambda leaf: 2.0 * leaf if leaf is amplitude else leaf, task.model
        ),
    )
    doubled = run_noise(twice).analysis.acceleration
    size = np.abs(doubled).max()
    assert np.allclose(doubled, 2.0 * found.analysis.acceleration, atol=0.05 * size)


def test_noise_lines_name_causing_wave(scene):
    """Order 8 of 7 balls shakes the rings radially, at BPFI + the shaft."""
    task = read_noise(scene)
    modes = jax.device_get(natural_modes(task.model))
    # A record of sixteen turns by hand: the line of the wave alone.
    kinematic = bj.noise.kinematic_frequencies(
        task.model.element.bearing, task.model.speed
    )
    hertz = float(kinematic.inner_passage + kinematic.inner)
    time = np.arange(16 * 64) / (64 * 50.0)
    alone = np.cos(2.0 * np.pi * hertz * time)
    record = Vibration(
        time=jnp.asarray(time),
        displacement=jnp.zeros((len(time), 3)),
        acceleration=jnp.asarray(np.stack([alone, 0 * time, 0 * time], axis=1)),
        contact_load=jnp.ones((len(time), 7, 2)),
        azimuth=jnp.zeros((len(time), 7)),
        shaft_frequency=jnp.asarray(50.0),
        result=jnp.asarray(0, jnp.int32),
        turns=16,
    )
    heard = noise_run.analyse(task, record, modes)
    # Beside it are maxima of round-off, told for their size alone.
    line, causes = max(
        zip(heard.lines, heard.causes, strict=True), key=lambda pair: pair[0].amplitude
    )
    assert all(one is line or one.amplitude < 1e-3 for one in heard.lines)
    assert line.name == "BPFI + shaft"
    assert line.amplitude == pytest.approx(1.0, rel=0.02)
    assert causes == ("waves of the inner raceway, order 8",)


def test_round_off_is_no_noise(scene):
    """Equal balls under an axial load, without errors: nothing shakes the ring.

    The lighter the load, the more of it is out of balance where the motion begins.
    """
    still = "deviations.waves.0.amplitude=0 um"
    steps = f"vibration.steps={needed_steps(read_noise(scene).model, 64)}"
    for load in ("100 N", "0.01 N"):
        given = [still, steps, f"operating.load.Fz={load}"]
        found = run_noise(read_noise(scene, given))
        assert found.converged and found.analysis.lines == ()
        assert any(text.startswith("nothing shakes") for text in found.warnings)


def test_run_noise_diverging_motion_is_non_finite(scene):
    # As many steps as the scene itself needs: far too few for so much damping.
    steps = needed_steps(read_noise(scene).model, 64)
    given = ["vibration.retardation=1 ms", f"vibration.steps={steps}"]
    found = run_noise(read_noise(scene, given))
    assert found.warnings[0].startswith(f"{steps} steps per sample are less than")
    assert found.result is Result.NON_FINITE and found.analysis is None
    assert "another `vibration.retardation`" in found.message
    assert set(noise_as_dict(found)) == WORDS


@pytest.mark.slow
def test_noise_model_warnings(scene):
    task = read_noise(scene, ["deviations.waves.0.order=60"])
    few, *high, fast = model_warnings(task.model, 64, 1)
    least = needed_steps(task.model, 64)
    assert few.startswith(f"1 steps per sample are less than the {least} that the")
    # 64 samples per turn of 50 Hz tell 1120 Hz.
    names = ring_modes(jax.device_get(natural_modes(task.model)), task.model)
    above = [name for name, frequency in names if frequency > 1120.0]
    assert [text.split(" at ")[0] for text in high] == [f"the {name}" for name in above]
    assert above and "lies above 1120 Hz, up to which the samples tell" in high[0]
    assert "waves of order 60 of the inner raceway are met at 18" in fast
    assert "raise `vibration.samples`" in fast
    task = read_noise(scene, ["deviations.waves.0.order=900"])
    load = np.full((1, 7, 2), 30.0)
    (short,) = _short_waves(task.model, load, None)
    assert short.startswith("waves of the inner raceway of order ")
    assert "three contacts of 0.1" in short
    # Random bearings have waves of their own.
    drawn = ["vibration.tolerance={waviness='50 nm', highest=900}"]
    task = read_noise(scene, drawn, bearings=2)
    assert len(list(_short_waves(task.model, load, task.tolerances))) == 2
    *_, outer, inner = model_warnings(task.model, 64, 99, task.tolerances)
    assert "order 900 of the outer raceway" in outer and "inner raceway" in inner


@pytest.mark.slow
def test_measured_record_beside_the_calculated_one(run, scene, tmp_path):
    # Beside what is loud a carrier that swings by half, 20 times a second.
    phase = 2 * np.pi * np.arange(640) / 6400
    rings = 2e-3 * (1 + 0.5 * np.cos(20 * phase)) * np.cos(950 * phase)
    record = phase / (2 * np.pi), SAMPLES + rings
    (tmp_path / "run.csv").write_text(columns("time [s],acceleration [m/s^2]", *record))
    out, page, plot = (tmp_path / name for name in ("a.json", "a.html", "a.png"))
    given = (
        "vibration.measured.file='run.csv'",
        "vibration.envelope_band=['9e2 Hz','1 kHz']",
    )
    files = "--json", out, "--report", page, "--plot", plot
    done = run("noise", scene, *(x for one in given for x in ("--set", one)), *files)
    assert done.status == 0, done.err
    found = read(out)
    assert found["envelope"]["band"] == pytest.approx([900.0, 1000.0])
    level = 20.0 * np.log10(np.sqrt(2.0) / 0.31e-4)  # of a sine of 2 m/s²
    assert found["measured"]["level"] == pytest.approx(level)
    assert len(found["measured"]["band_level"]) == 12
    envelope = found["measured"]["envelope"]
    assert envelope["band"] == pytest.approx([900.0, 1000.0])
    assert envelope["mean"] == pytest.approx(2e-3, rel=1e-3)
    line = max(envelope["lines"], key=lambda line: line["amplitude"])
    assert line["frequency"] == pytest.approx(20.0, rel=1e-2)
    assert line["amplitude"] == pytest.approx(1e-3, rel=1e-2)
    words = "\nits envelope of 900 to 1000 Hz, mean 0.002 m/s²: largest lines\n"
    assert words in done.out and "\nalong the sensor, envelope of 900" in done.out
    words = "run.csv: a record at 6400 Hz, of the same window and reference; its lines"
    assert words in done.out and words in page.read_text(encoding="utf-8")
    assert plot.stat().st_size > 0


def test_noise_of_a_mass_in_words(run, scene):
    done = run("noise", scene, "--set", "vibration.mass=heavy")
    assert done.status == 2 and done.out == ""
    assert done.err.startswith("bearingjax: mine.toml: `vibration.mass`: 'heavy'")


@pytest.mark.slow
def test_random_bearings(run, scene, tmp_path):
    out, picture = tmp_path / "a.json", tmp_path / "a.png"
    files = ("--json", out, "--plot", picture)
    done = run("noise", scene, "--monte-carlo", 3, *files)
    assert done.status == 0, done.err
    found = read(out)["monte_carlo"]
    level = np.array(found["level"])
    assert level.shape == (3, 3) and np.shape(found["band_level"]) == (3, 12, 3)
    assert found["percentile"]["share"] == [5.0, 50.0, 95.0]
    median = found["percentile"]["level"][1]
    assert np.allclose(median, np.median(level, axis=0), rtol=ROUNDING)
    assert found["sources"] == ["diameter", "inner_eccentricity"]
    task = read_noise(scene, bearings=3)
    again = run_noise(task).many
    assert np.array_equal(again.levels.level, level)
    assert np.allclose(
        found["part"],
        again.contributions.share / again.contributions.mean_square,
        rtol=ROUNDING,
    )
    assert "3 random bearings\n" in done.out and "50 % are below" in done.out
    assert "what makes the noise along the sensor (0, 0.6, 0.8), of 3" in done.out
    assert "\ndiameters of the rolling elements  " in done.out
    assert "\neccentricity of the inner raceway  " in done.out
    assert np.shape(found["part_by_band"]) == (2, 12)
    assert len(found["part_error"]) == 2 and found["tighter"] == []
    assert picture.stat().st_size > 10_000


def test_noise_monte_carlo_requires_tolerance(run, scene):
    done = run("noise", "noise_four_point", "--monte-carlo", 2)
    assert done.status == 2 and "`vibration.tolerance`: is missing" in done.err
    done = run("noise", scene, "--monte-carlo", 0)
    assert done.status == 2 and "--monte-carlo is 0; it must be at least 1" in done.err

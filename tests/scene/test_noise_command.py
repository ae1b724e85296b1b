"""`bearingjax noise`: exit status, files, and that they hold what the record says."""

import csv
import dataclasses
import json
import wave

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.noise import (
    Vibration,
    model_warnings,
    natural_modes,
    needed_steps,
    record_warnings,
    ring_modes,
)
from bearingjax.noise.warning import _short_waves
from bearingjax.numerics import Result
from bearingjax.scene import noise_as_dict, noise_run, read_noise, run_noise

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
PARTS = {
    *("natural_frequency", "ring_share", "direction", "time", "acceleration"),
    *("displacement", "level", "bands", "lines", "contact_states", "reference"),
}
WORDS = {"result", "message", "warnings", "inputs", "version"}


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.slow
def test_every_file_holds_the_same_record(run, rerun, scene, tmp_path):
    names = ("a.json", "a.csv", "a.wav", "a.png")
    out, table, sound, picture = (tmp_path / name for name in names)
    files = ("--json", out, "--table", table, "--wav", sound, "--plot", picture)
    done = run("noise", scene, *files)
    assert done.status == 0, done.err
    found = read(out)
    assert set(found) == PARTS | WORDS and found["result"] == "converged"
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
        assert set(line) == {"order", "frequency", "amplitude", "name", "causes"}
        assert line["frequency"] == pytest.approx(50.0 * line["order"])
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0][:3] == ["time [s]", "acceleration_x [m/s²]", "acceleration_y [m/s²]"]
    written = np.array([[float(v) for v in row] for row in rows[1:]])
    assert np.array_equal(written[:, 1:4], acceleration)
    assert np.array_equal(written[:, 4:], found["displacement"])
    assert picture.stat().st_size > 10_000
    _same_sound(sound, acceleration, done.out)
    for words in (
        "the outer ring moves, 0.1 kg, and does not tilt\nloaded by Fz 100 N; inner",
        "record of 1 turns, 0.02 s, after 0 to settle; 64 samples",
        "natural modes of the ring: ",
        "2: 100 %; 0 open or close per turn of the shaft",
        "warning: the record of 0.02 s is too short for the bands up to 63 Hz; raise",
        "warning: the record of 0.02 s has too few samples for the bands from 1000 Hz",
        "are left out for that: 125, 500 Hz; raise `vibration.turns`, to 2 ",
    ):
        assert words in done.out, words
    assert len(found["warnings"]) == done.out.count("\nwarning: ")
    rerun("noise", out)


def _same_sound(path, acceleration, told):
    """What full scale stands for is the largest acceleration along the sensor."""
    with wave.open(str(path)) as file:
        assert file.getnframes() >= 3 * file.getframerate()
    along = acceleration @ [0.0, 0.6, 0.8]
    full = float(told.partition("full scale is ")[2].split()[0])
    assert full == pytest.approx(np.abs(along - along.mean()).max(), rel=0.15)


def test_a_model_by_hand_vibrates_alike(scene):
    task = read_noise(scene)
    found = run_noise(task)
    record, lines = found.analysis.record, found.analysis.spectrum
    assert list(found.warnings) == [
        *model_warnings(task.model, task.samples, found.steps),
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


def test_noise_command_unsolved_static_equilibrium(run, scene, tmp_path):
    out, table = tmp_path / "a.json", tmp_path / "a.csv"
    table.write_text("of an earlier run", encoding="utf-8")
    files = ("--json", out, "--table", table)
    done = run("noise", scene, *files, "--set", "operating.load.Fz=1e9 N")
    assert done.status == 3 and done.out == ""
    assert "bearingjax: non_finite: standing under the load: " in done.err
    found = read(out)
    assert set(found) == WORDS and found["result"] == "non_finite"
    assert not table.exists()


def test_a_bearing_without_load_has_no_noise(run, scene, tmp_path):
    out = tmp_path / "a.json"
    done = run("noise", scene, "--json", out, "--set", "operating.load.Fz=0 N")
    assert done.status == 3 and done.out == ""
    assert "no_load_path: standing under the load: nothing presses the" in done.err
    assert read(out)["result"] == "no_load_path"


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


def test_bad_input_is_told_before_anything_is_solved(run, scene, tmp_path):
    done = run("noise", scene, "--wav", tmp_path / "a.mp3")
    assert done.status == 2 and "a.mp3: a sound ends in .wav" in done.err
    done = run("noise", scene, "--wav", tmp_path / "none" / "a.wav")
    assert done.status == 2 and "its folder does not exist" in done.err
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

"""[identify] and [tolerances] of a bearing on its noise rig."""

import jax
import numpy as np
import pytest

from bearingjax import noise
from bearingjax.decide import NoiseDesign, NoiseLevel
from bearingjax.files import SceneError
from bearingjax.optimise.variable import design_numbers
from bearingjax.studies.identify.read_identify import read_identification
from bearingjax.studies.tolerances.read import read_tolerances

RIG = """
[bearing]
type = "deep_groove_ball"
n_balls = 9
pitch_diameter = "39.04 mm"
ball_diameter = "7.938 mm"
outer_osculation = 0.525
inner_osculation = 0.515
radial_internal_clearance = "12 um"

[operating]
fixed_ring = "inner"
load = { Fz = "150 N" }
inner_speed = "1800 rpm"

[vibration]
mass = "0.06 kg"
sensor_stiffness = "2 N/mm"
turns = 16
samples = 512
bridging = true
reference = "1e-5 m/s^2"

[[deviations.waves]]
part = "outer raceway"
order = [8, 17]
amplitude = ["30 nm", "10 nm"]

[[deviations.waves]]
part = "inner raceway"
order = 10
amplitude = "22 nm"
"""
IDENTIFY = """
[identify]
data = "m.csv"
errors = { line_2_BPFO = "0.3 dB", total_level = "0.2 dB" }
wanted = ["band_1000"]

[identify.unknowns]
"deviations.waves.0.amplitude.1" = { from = "1 nm", to = "100 nm" }

[identify.unknowns."vibration.mass"]
from = "0.05 kg"
to = "0.08 kg"
prior = "0.06 kg"
prior_error = "1 g"
"""
HEAD = "operating.inner_speed [rpm],line_2_BPFO [dB],total_level [dB]"
TOLERANCES = """
[[tolerances.measures]]
measure = "noise_level"
reading = "band_1000"
at_most = "40 dB"

[[tolerances.measures]]
measure = "noise_level"

[tolerances.numbers]
"deviations.waves.0.amplitude.0" = { from = "20 nm", to = "40 nm" }
"bearing.radial_internal_clearance" = { mean = "12 um", deviation = "1 um" }
"""


def identification(tmp_path, text, table):
    (tmp_path / "rig.toml").write_text(text, "utf-8")
    (tmp_path / "m.csv").write_text(table, "utf-8")
    return read_identification(tmp_path / "rig.toml")


def tolerances(tmp_path, text):
    (tmp_path / "rig.toml").write_text(text, "utf-8")
    return read_tolerances(tmp_path / "rig.toml")


def test_levels_are_readings(tmp_path):
    table = f"{HEAD}\n1800,40,50\n3600,46,\n"
    task = identification(tmp_path, RIG + IDENTIFY, table)
    model, cases = task.subject.model, task.subject.cases
    assert isinstance(model.design, NoiseDesign)
    np.testing.assert_allclose(cases.inner_speed, [60 * np.pi, 120 * np.pi])
    np.testing.assert_allclose(task.readings["total_level"], [50.0, np.nan])
    assert task.units["band_1000"] == task.units["line_2_BPFO"] == "dB"
    assert float(model.design.reference) == 1e-5
    there = design_numbers(model.design, entries=True)
    values = [float(there[one.path[0]]) for one in task.unknowns]
    np.testing.assert_allclose(values, [10e-9, 0.06])
    assert task.readings["vibration.mass"] == 0.06


IDENTIFY_REFUSES = {
    "line that no wave makes": (
        ("", ""),
        "operating.inner_speed [rpm],line_3_BPFO [dB]\n1800,40\n",
        "'line_3_BPFO' is not known",
    ),
    "level in another unit": (
        ("", ""),
        "operating.inner_speed [rpm],total_level [m/s^2]\n1800,40\n",
        "total_level",
    ),
    "standing ring": (("", ""), f"{HEAD}\n0,40,50\n", "must be other than 0"),
    "both rings": (
        ("1800 rpm", '1800 rpm"\nouter_speed = "100 rpm'),
        f"{HEAD}\n1800,40,50\n",
        "one ring turns",
    ),
    "no waves": (
        (RIG[RIG.index("[[dev") :], "[[deviations.balls]]\n"),
        f"{HEAD}\n1800,40,50\n",
        "deviations",
    ),
    "amplitude of no wave": (
        ("waves.0.amplitude.1", "waves.2.amplitude"),
        f"{HEAD}\n1800,40,50\n",
        "'deviations.waves.2.amplitude' is not known",
    ),
    "order of a wave": (
        ("waves.0.amplitude.1", "waves.0.order"),
        f"{HEAD}\n1800,40,50\n",
        "'deviations.waves.0.order' is not known",
    ),
    "displacement beside levels": (
        ("", ""),
        f"{HEAD},displacement_inner_uy [um]\n1800,40,50,1\n",
        "displacement_inner_uy",
    ),
    "viscosity": (
        ('"vibration.mass"]', '"life.viscosity"]'),
        f"{HEAD}\n1800,40,50\n",
        "'life.viscosity' is not known",
    ),
}


@pytest.mark.parametrize("name", IDENTIFY_REFUSES)
def test_identification_by_levels_that_is_refused(tmp_path, name):
    change, table, words = IDENTIFY_REFUSES[name]
    text = (RIG + IDENTIFY).replace(*change)
    with pytest.raises(SceneError) as stop:
        identification(tmp_path, text, table)
    assert words in str(stop.value)


def test_levels_are_measures_of_tolerances(tmp_path):
    task = tolerances(tmp_path, RIG + TOLERANCES)
    design, cases, scatters, asked = task.given
    assert isinstance(design, NoiseDesign) and cases.count == 1
    assert asked[0].measure == NoiseLevel("band_1000") and asked[0].upper == 40.0
    assert asked[1] == NoiseLevel("total_level")
    paths = [path for one in scatters for path in one.path]
    assert paths == [
        "rig.errors.outer.outwards.0.amplitude.0",
        "installed.drawing.bearing.radial_internal_clearance",
    ]
    assert task.units == ("m", "m")


TOLERANCES_REFUSE = {
    "line that no wave makes": ("band_1000", "line_BSF", "'line_BSF' is not known"),
    "reading of another measure": (
        'measure = "noise_level"\nreading',
        'measure = "clearance"\nreading',
        "reading",
    ),
    "no rig": (
        RIG[RIG.index("[vibration]") : RIG.index("[[dev")],
        "",
        "vibration",
    ),
    "limit in another unit": ("40 dB", "40 m", "'40 m' is not a"),
}


@pytest.mark.parametrize("name", TOLERANCES_REFUSE)
def test_tolerances_of_levels_that_are_refused(tmp_path, name):
    old, new, words = TOLERANCES_REFUSE[name]
    with pytest.raises(SceneError) as stop:
        tolerances(tmp_path, (RIG + TOLERANCES).replace(old, new))
    assert words in str(stop.value)


@pytest.mark.slow
def test_levels_of_a_scene_as_its_vibration_in_time(tmp_path):
    """Sensor, reference and bridging are those of the scene; the record of 16 turns
    leaks 0.03 dB (`test_noise_design`)."""
    task = tolerances(tmp_path, RIG + TOLERANCES)
    design, cases, *_ = task.given
    case = jax.tree.map(lambda leaf: leaf[0], cases)
    solve = jax.jit(
        lambda c: design.solve_case(c, task.options["support"], task.options["solve"])
    )
    found = solve(case)
    motion = noise.vibration(design.rig, turns=16, settle=8, samples=512)
    given = motion.acceleration[:, :3], float(motion.duration)
    lines = noise.spectrum(*given, float(motion.shaft_frequency), window=noise.Hann())
    exact = noise.level(noise.total_root_mean_square(lines), design.reference)[1]
    np.testing.assert_allclose(found.total, exact, atol=0.05)

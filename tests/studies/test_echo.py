"""The inputs in a JSON file: in SI, complete, and a scene again."""

import dataclasses
import json

import equinox as eqx
import jax
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.files import SceneError
from bearingjax.files.quantity import QUANTITIES, to_si
from bearingjax.studies.bearing.read_scene import read_scene
from bearingjax.studies.cases.read_cases import read_cases
from bearingjax.studies.contact.read import read_contact
from bearingjax.studies.noise.read import read_noise
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation
from bearingjax.studies.rotor.read import read_rotor
from bearingjax.studies.skid.read import read_skid
from bearingjax.studies.solve.output import solution_json
from bearingjax.studies.solve.run import solve_scene

SCENES = (
    "ball_pair",
    "cylindrical_ribs",
    "hybrid_spindle",
    "life_spectrum",
    "load_map",
    "self_aligning",
    "skid_roller",
    "spherical_roller",
    "sprung_pair",
    "tapered",
)


def echoed(path, scene):
    path.write_text(json.dumps({"inputs": scene.inputs}), encoding="utf-8")
    return read_scene(path)


@pytest.mark.parametrize("kind", QUANTITIES)
def test_echo_units_are_si(kind):
    assert to_si(f"0.1 {QUANTITIES[kind][0]}", kind) == 0.1


@pytest.mark.parametrize("number", ["10", "25", "1.7e1", "-0.3", ".5", "+12.", "7e-3"])
@pytest.mark.parametrize(
    "unit, kind, tens",
    [
        ("um", "length", -6),
        ("mm", "length", -3),
        ("µs", "time", -6),
        ("kN", "force", 3),
        ("1/GPa", "pressure coefficient", -9),
        ("mm^2/s", "kinematic viscosity", -6),
    ],
)
def test_powers_of_ten_shift_the_digits(number, unit, kind, tens):
    """As Python reads the number in SI: 10 µs are 1e-05 s, not the float below it."""
    digits, _, exponent = number.partition("e")
    wanted = float(f"{digits}e{int(exponent or 0) + tens}")
    assert to_si(f"{number} {unit}", kind) == wanted


@pytest.mark.parametrize("name", SCENES)
def test_the_echo_is_the_scene(tmp_path, name):
    """To the last bit; what was left to defaults is said."""
    scene = read_scene(name)
    again = echoed(tmp_path / f"{name}.json", scene)
    assert again.inputs == scene.inputs and again.name == name
    trees = [(one.element, one.speed) for one in (scene, again)]
    assert jax.tree.structure(trees[0]) == jax.tree.structure(trees[1])
    for one, other in zip(*map(jax.tree.leaves, trees), strict=True):
        np.testing.assert_array_equal(one, other)
    chosen = {"element", "speed", "free", "tolerance", "inputs"}
    for field in dataclasses.fields(scene):
        if field.name not in chosen:
            assert getattr(again, field.name) == getattr(scene, field.name)
    assert again.tolerance == (scene.tolerance or 1e-11)


# Readers of other commands, scenes, settings.
OTHERS = {
    "optimise": (read_optimisation, "fujiwara_kawase", ()),
    "spectrum": (read_cases, "life_spectrum", ()),
    "grid": (read_cases, "load_map", ()),
    "contact": (read_contact, "taper_contact", ()),
    "contact by approach": (
        read_contact,
        "taper_contact",
        ("operating={approach='5 um', tilt='1 mrad'}", "roller.material=steel"),
    ),
    "balls that skid": (read_skid, "skid_combined", ()),
    "rollers that skid": (read_skid, "skid_roller", ("dynamics.duration=1 ms",)),
    "load over time": (
        read_skid,
        "skid_axial",
        (
            "dynamics={duration='1 s', load={amplitude={Fy='80 N'}, speed='20 rpm'},"
            " speed={time=['0 s', '1 s'], inner=['0 rpm', '9 rpm']}}",
            "lubricant={law='roelands', coefficient='20 1/GPa', grade=68,"
            " temperature='60 °C', traction={type='eyring', stress_scale='5 MPa'}}",
        ),
    ),
    "noise": (read_noise, "noise_cylindrical", ()),
    "noise of a moving outer ring": (read_noise, "noise_four_point", ()),
    "rotor": (read_rotor, "rotor_flexible", ()),
    "rotor in time": (
        read_rotor,
        "rotor_spindle",
        (
            "rotor.transient={duration='1 s', speed_to='9000 rpm'}",
            "rotor.response={from='1 Hz', to='9 Hz', method='linear'}",
        ),
    ),
    "bearing of another scene": (
        read_rotor,
        "rotor_flexible",
        (
            "rotor.bearings.1.bearing=needle",
            "bearings={locating={designation='6208', contact={point_law='zero_angle'},"
            " fit={shaft='k5', housing='H7', housing_diameter='99 mm'}}}",
        ),
    ),
}


def leaves(task):
    """Numbers and choices of what was read; not what is static in a load solve."""
    plain = dataclasses.is_dataclass(task) and not isinstance(task, eqx.Module)
    if plain and not isinstance(task, type):
        names = {field.name for field in dataclasses.fields(task) if field.compare}
        parts = [getattr(task, name) for name in sorted(names - {"tolerance", "free"})]
        return [leaf for part in parts for leaf in leaves(part)]
    if isinstance(task, tuple | list):
        return [leaf for part in task for leaf in leaves(part)]
    found, shape = jax.tree.flatten(task)
    return [str(shape), *found]


def check_same(one, other):
    for first, second in zip(leaves(one), leaves(other), strict=True):
        np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize("what", OTHERS)
def test_echo_of_every_command_reads_as_scene(tmp_path, what):
    reader, name, settings = OTHERS[what]
    task = reader(name, settings)
    path = tmp_path / f"{name}.json"
    path.write_text(json.dumps({"inputs": task.inputs}), encoding="utf-8")
    again = reader(path)
    assert again.inputs == task.inputs
    check_same(task, again)


def test_echo_includes_contents_of_files(tmp_path):
    """Or where the file is, so that the echo is read from anywhere."""
    folder, away = tmp_path / "here", tmp_path / "away"
    folder.mkdir()
    away.mkdir()
    heights = "\n".join(["height [um]", *(f"{0.1 * k}" for k in (0, 1, 0, -1))])
    (folder / "ring.csv").write_text(f"{heights}\n", encoding="utf-8")
    (folder / "list.csv").write_text("operating.load.Fy [kN]\n1\n2\n")
    shipped = bj.files.shipped_scenes()
    for reader, name, more in (
        (
            read_noise,
            "noise_deep_groove",
            '[[deviations.profile]]\npart = "inner raceway"\nfile = "ring.csv"\n',
        ),
        (read_cases, "cylindrical_ribs", '[cases]\nfile = "list.csv"\n'),
    ):
        path = folder / f"{name}.toml"
        path.write_text(f"{shipped[name].read_text(encoding='utf-8')}\n{more}")
        task = reader(path)
        out = away / f"{name}.json"
        out.write_text(json.dumps({"inputs": task.inputs}), encoding="utf-8")
        check_same(task, reader(out))


def test_defaults_are_filled_in():
    inputs = read_scene("tapered").inputs
    assert to_si(inputs["bearing"]["pitch_diameter"], "length") == 0.052
    assert inputs["bearing"]["material"] == {
        "elastic_modulus": "206000000000.0 Pa",
        "poisson_ratio": 0.3,
        "density": "7850.0 kg/m³",
    }
    assert inputs["contact"] == {"line_law": "palmgren"}
    assert inputs["operating"]["free"] == ["ux", "uy", "uz", "gx", "gy"]
    assert inputs["operating"]["outer_speed"] == "0.0 rad/s"
    assert inputs["numerics"]["quadrature"] == "contact_mapped"
    assert inputs["numerics"]["points"] == 32


def test_echo_of_designation_keeps_numbers(tmp_path):
    path = tmp_path / "listed.toml"
    path.write_text('[bearing]\ndesignation = "6205/C3"\n', encoding="utf-8")
    scene = read_scene(path)
    again = echoed(tmp_path / "listed.json", scene)
    assert scene.inputs["bearing"]["designation"] == "6205/C3"
    assert scene.inputs["bearing"]["n_balls"] == 9
    assert again.inputs == scene.inputs
    leaves = [jax.tree.leaves(one.element) for one in (scene, again)]
    for one, other in zip(*leaves, strict=True):
        np.testing.assert_array_equal(one, other)


FIT = """
at = "tightest"
bore = "30 mm"
outside_diameter = "62 mm"
housing_diameter = "80 mm"
shaft = "k5"
housing = "H7"
clearance = "C3"
shaft_roughness = "0.8 um"
"""


def test_echo_includes_fits(tmp_path):
    """A class of clearance stands for the number that the bearing has not."""
    text = bj.files.shipped_scenes()["deep_groove"].read_text(encoding="utf-8")
    lines = [x for x in text.splitlines() if "radial_internal_clearance" not in x]
    path = tmp_path / "fits.toml"
    warm = '[temperature]\nshaft = "60 °C"\ninner_ring = "55 °C"\n'
    path.write_text("\n".join(lines) + f"\n[fit]{FIT}\n{warm}", encoding="utf-8")
    scene = read_scene(path)
    again = echoed(tmp_path / "fits.json", scene)
    assert again.inputs == scene.inputs
    leaves = [jax.tree.leaves((one.installed, one.fits)) for one in (scene, again)]
    for one, other in zip(*leaves, strict=True):
        np.testing.assert_array_equal(one, other)


def test_echo_includes_settings():
    inputs = read_scene("tapered", ["operating.load.Fz=-6 kN"]).inputs
    assert inputs["operating"]["load"]["Fz"] == "-6000.0 N"


def test_an_output_file_is_solved_again(run, tmp_path):
    """Also that of a run without a solution."""
    first, second = tmp_path / "first.json", tmp_path / "second.json"
    # What is static in the echo, said: so that one program serves.
    free = "operating.free=['ux', 'uy', 'uz', 'gx', 'gy']"
    settings = ["output.points=2", "numerics.tolerance=1e-11", free]
    scene = read_scene("tapered", settings)
    settings.append("operating.load.Fz=-6 kN")
    pull = [word for text in settings for word in ("--set", text)]
    assert run("solve", "tapered", *pull, "--json", first).status == 3
    push = ("--set", "operating.load.Fz=6 kN")
    assert run("solve", first, *push, "--json", second).status == 0
    expected = solution_json(solve_scene(scene))
    found = json.loads(second.read_text(encoding="utf-8"))
    assert found["inputs"] == expected["inputs"]
    np.testing.assert_array_equal(found["displacement"], expected["displacement"])
    refused = run("solve", second, "--json", second)
    assert refused.status == 2 and "--json would overwrite it" in refused.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "cannot be read as JSON: "),
        ("[1]", "`inputs` is missing; it must be a table, as `--json` writes it"),
        ("{}", "`inputs` is missing"),
        ('{"inputs": 3}', "`inputs` is missing"),
        ('{"inputs": {}}', "`bearing`: is missing"),
        ('{"inputs": {"bearing": {"type": "ball"}}}', "`bearing.type`: 'ball' is not"),
    ],
)
def test_wrong_files(tmp_path, text, message):
    path = tmp_path / "out.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value).startswith("out.json: ") and message in str(caught.value)

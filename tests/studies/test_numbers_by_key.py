"""A number that is set by its place in the design, and by its key in the scene."""

import jax
import numpy as np
import pytest

from bearingjax.files.quantity import SceneError
from bearingjax.files.scene_file import parse_scene, shipped_scenes
from bearingjax.numerics.units import unit_of
from bearingjax.optimise.variable import design_numbers, with_values
from bearingjax.studies.bearing.read_design import PITCH_FOLLOWS
from bearingjax.studies.bearing.read_scene import read_scene
from bearingjax.studies.optimise.read_optimise import (
    installed_numbers,
    read_bearing_optimisation,
)
from bearingjax.studies.optimise.read_shaft_optimise import read_optimisation


def one_of_each_type():
    """Name of the first shipped scene of every type of bearing."""
    found = {}
    for name, path in sorted(shipped_scenes().items()):
        bearing = parse_scene(path, ()).get("bearing", {})
        found.setdefault(bearing.get("type"), name)
    found.pop(None)
    return sorted(found.values())


DESIGNED = '[bearing]\ndesignation = "{}"\n[operating]\nload = {{ Fy = "-1 kN" }}\n'
SEATED = (
    '[fit]\nshaft_interference = "5 um"\nhousing_interference = "1 um"\n'
    'shaft_bore = "5 mm"\nhousing_diameter = "90 mm"\n'
    '[temperature]\ninner_ring = "60 degC"\nouter_ring = "50 degC"\n'
)


def leaves(scene_or_installed):
    """Numbers of a bearing in its place by their path, but those that a changed
    dimension voids and the tolerances that a given number has not."""
    found = jax.tree_util.tree_leaves_with_path(scene_or_installed)
    named = {jax.tree_util.keystr(path): np.asarray(x, float) for path, x in found}
    return {
        k: v for k, v in named.items() if "published" not in k and "limits" not in k
    }


def changes(source):
    """Key of every number of a scene, the design with it changed by its path, and the
    setting that changes it by its key."""
    scene = read_scene(source)
    numbers = design_numbers(scene.installed)
    for key, paths in installed_numbers(scene).items():
        value = numbers.get(paths[0])
        if value is None or np.ndim(value) or not np.isfinite(value):
            continue
        changed = 1.001 * float(value) if value else 1e-6
        unit = unit_of(scene.installed, paths[0])
        try:
            design = with_values(scene.installed, [paths], [changed])
        except ValueError:
            continue  # A thrust bearing takes no clearance.
        yield key, design, f"{key}={changed!r} {unit}".strip()


def compare(source):
    """Keys whose change by key makes another bearing than that by path, the number of
    those compared, and those that the scene does not take as they stand."""
    unlike, count, refused = [], 0, []
    for key, design, setting in changes(source):
        try:
            scene = read_scene(source, [setting])
        except SceneError:
            refused.append(key)
            continue
        count += 1
        ours, read = leaves(design), leaves(scene.installed)
        alike = ours.keys() == read.keys() and all(
            np.allclose(ours[k], read[k], rtol=1e-12, atol=0.0) for k in ours
        )
        if not alike:
            unlike.append(key.removeprefix("bearing."))
    return unlike, count, refused


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[] if name == "spherical_roller" else pytest.mark.slow)
        for name in one_of_each_type()
    ],
)
def test_numbers_by_path_are_those_of_the_scene(name):
    unlike, count, refused = compare(name)
    assert count >= 4
    # A number of a part that the scene describes in another way, by a word.
    assert all("rib" in key or "material" in key or "clear" in key for key in refused)
    if name == "spherical_roller":
        assert unlike and set(unlike) <= set(PITCH_FOLLOWS)
    else:
        assert not unlike


@pytest.mark.parametrize(
    "designation",
    ["6205", *(pytest.param(n, marks=pytest.mark.slow) for n in ("NU 208", "22210 E"))],
)
def test_numbers_of_a_mounted_catalogue_bearing(tmp_path, designation):
    path = tmp_path / "scene.toml"
    path.write_text(DESIGNED.format(designation) + SEATED.replace("90 mm", "150 mm"))
    unlike, count, _ = compare(path)
    assert count >= 10
    assert not unlike


@pytest.mark.parametrize("key", sorted(set(PITCH_FOLLOWS) - {"profile_offset"}))
def test_a_search_refuses_a_number_that_moves_the_pitch_diameter(key):
    whole = read_scene("spherical_roller")
    (path, *_) = installed_numbers(whole)[f"bearing.{key}"]
    value = float(design_numbers(whole.installed)[path])
    unit = unit_of(whole.installed, path)
    ends = f"from = '{0.99 * value} {unit}', to = '{1.01 * value + 1e-9} {unit}'"
    free = f"{{ 'bearing.{key}' = {{ {ends} }} }}"
    search = f"optimise={{ objective = 'peak_pressure', variables = {free} }}"
    with pytest.raises(SceneError, match=f"{key}.*the pitch diameter follows from it"):
        read_bearing_optimisation("spherical_roller", [search])


def test_a_search_of_shafts_refuses_it_too():
    bearing = parse_scene(shipped_scenes()["spherical_roller"], ())["bearing"]
    row = ", ".join(f"{k} = {v!r}" for k, v in bearing.items())
    place = "position = '1150 mm', floating = true"
    free = "{ 'bearings.floating.contact_angle' = { from = '9 deg', to = '10 deg' } }"
    settings = [
        f"bearings.floating={{ {place}, {row} }}",
        f"optimise={{ objective = 'system_life', variables = {free} }}",
    ]
    with pytest.raises(
        SceneError, match=r"give \[bearings.floating\] `pitch_diameter`"
    ):
        read_optimisation("shaft_fan", settings)


def test_one_number_does_not_make_unlike_rows_alike(tmp_path):
    other = '{ type = "angular_contact_ball", n_balls = 15, pitch_diameter = "70 mm",'
    other += ' ball_diameter = "11 mm", outer_osculation = 0.53,'
    other += ' inner_osculation = 0.53, contact_angle = "25 deg" }'
    rows = '[[set.rows]]\nposition = "-9 mm"\n[[set.rows]]\nposition = "9 mm"\n'
    rows += f"mirrored = true\nbearing = {other}\n"
    text = other.strip("{ }").replace(", ", "\n").replace("25 deg", "15 deg")
    ends = '{ from = "10 deg", to = "30 deg" }'
    search = f'objective = "peak_pressure"\nvariables = {{ "bearing.NAME" = {ends} }}'
    text = f'[bearing]\n{text}\n[set]\narrangement = "rows"\n{rows}'
    text += f'[operating]\nload = {{ Fz = "1 kN" }}\n[optimise]\n{search}\n'
    path = tmp_path / "unlike.toml"
    path.write_text(text.replace("NAME", "contact_angle"))
    with pytest.raises(SceneError, match="several values in this scene, 15 deg, 25"):
        read_bearing_optimisation(path)

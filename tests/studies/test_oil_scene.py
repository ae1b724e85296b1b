"""[lubricant] in a scene that is solved: friction and films, and what is wrong."""

import json
from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.studies.bearing.oil import oil_facts

ROLLERS = """
[bearing]
type = "cylindrical_roller"
n_rollers = 6
pitch_diameter = "38.5 mm"
roller_diameter = "7.5 mm"
roller_length = "9 mm"

[operating]
load = { Fy = "-2 kN" }
free = ["uy"]
inner_speed = "3000 rpm"

[numerics]
quadrature = "midpoint"
points = 5

[output]
points = 2

[lubricant]
law = "barus"
reference_viscosity = "20 mPa s"
coefficient = "18 1/GPa"
density = "880 kg/m^3"
density_temperature = "50 degC"
temperature = "50 degC"
roughness = "0.3 um"
"""


@pytest.fixture
def scene(tmp_path):
    """Write the scene, and get its path."""
    path = tmp_path / "oil.toml"
    path.write_text(ROLLERS, encoding="utf-8")
    return path


@pytest.mark.slow
def test_command_tells_friction_and_films(run, scene, tmp_path):
    out = tmp_path / "out.json"
    done = run("solve", scene, "--json", out, "--set", "lubricant.supply=grease")
    assert done.status == 0
    numbers = json.loads(out.read_text())
    load = np.array(numbers["roller_load"])
    nu, pitch = 20e-3 / 880 * 1e6, 38.5
    viscous = 0.8 * (nu * 3000) ** (2 / 3) * pitch**3 * 1e-10
    torque = 0.0003 * 2000 * 0.0385 + viscous
    assert numbers["friction_torque"] == pytest.approx(torque, rel=1e-6)
    found = numbers["friction"]
    assert found["viscous"] == pytest.approx([viscous]) and found["flange"] == [0.0]
    assert found["power"] == pytest.approx(torque * 100 * np.pi, rel=1e-6)
    assert f"friction torque (Palmgren) {1e3 * torque:.4g} N mm" in done.out
    # SKF's model of cylindrical rollers; D - d from the size of the rollers.
    skf = numbers["friction_skf"]
    warm = 1.84e-9 * (3000 * pitch) ** 1.28 * nu**0.64
    starved = 6e-8 * nu * 3000 * 2 * pitch * np.sqrt(5.1 / (2 * 3.9 * 7.5))
    rolling = 1.09e-6 * pitch**2.41 * 2000**0.31 * (nu * 3000) ** 0.6
    rolling *= np.exp(-starved) / (1 + warm)
    dry = np.exp(-2.6e-8 * (nu * 3000) ** 1.4 * pitch)
    sliding = (0.12 * dry + 0.02 * (1 - dry)) * 0.0015 * pitch * 2000
    assert skf["rolling"] == pytest.approx([1e-3 * rolling], rel=1e-6)
    assert skf["sliding"] == pytest.approx([1e-3 * sliding], rel=1e-6)
    # No designation tells the series: the first row, and that is said.
    assert skf["series"] == "2" and skf["assumed"] is True
    words = "series 2, assumed, as no designation tells it"
    assert f"(SKF, {words}) {rolling + sliding:.4g} N mm (rolling" in done.out
    assert "barus, grease, at 50 °C: 20 mPa s, 18 1/GPa, 880 kg/m³" in done.out
    # The film of the roller that bears most, on the inner raceway.
    film = numbers["film"]
    k = int(np.argmax(load[:, 1]))
    gamma = 7.5 / 38.5
    radius = 0.5 * 7.5e-3 * (1 - gamma)
    # Rolling on both raceways: half of the speed of the raceway.
    speed = 0.25 * 38.5e-3 * (1 - gamma) * 100 * np.pi * (1 + gamma)
    assert film["entrainment"][k] == pytest.approx([speed, speed], rel=1e-9)
    modulus = 206e9 / (1 - 0.3**2)
    u, g = 20e-3 * speed / (modulus * radius), modulus * 18e-9
    w = load[k, 1] / 9e-3 / (modulus * radius)
    least = 1.714 * u**0.694 * g**0.568 * w**-0.128 * radius
    assert film["minimum"][k][1] == pytest.approx(least, rel=1e-6)
    assert film["ratio"][k][1] == pytest.approx(least / 0.3e-6, rel=1e-6)
    assert f"of element {k} on the inner raceway; over the roughness" in done.out
    # Without load there is no contact to have a film.
    free = int(np.argmin(load[:, 1]))
    assert load[free, 1] == 0 and film["minimum"][free][1] is None


def test_series_words_tell_an_assumed_series():
    from bearingjax.friction import SkfFriction
    from bearingjax.studies.bearing.oil import series_words

    one = jnp.ones(1)
    made = [SkfFriction(one, one, one[0], "62", known) for known in (False, True)]
    words = [series_words(friction) for friction in made]
    assert words == ["series 62", "series 62, assumed, as no designation tells it"]


def test_read_skid_with_supply_and_roughness():
    settings = ["lubricant.supply=oil_jet", "lubricant.roughness=0.2 um"]
    from bearingjax.studies.skid.read import read_skid

    assert read_skid("skid_axial", settings).scene.oil.supply == "oil_jet"


def test_viscosity_without_coefficients_does_not_depend_on_temperature(scene):
    oil = bj.read_scene(scene).oil
    for temperature in (283.15, 323.15, 363.15):
        viscosity = oil.lubricant.viscosity(0.0, temperature)
        assert float(viscosity) == pytest.approx(20e-3, rel=1e-12)


@pytest.mark.parametrize("speed", [None, bj.Speed(inner=3.0, outer=3.0)])
def test_oil_facts_are_none_at_rest(speed, untyped):
    assert oil_facts(None, SimpleNamespace(speed=speed)) is None  # pyright: ignore

"""What a designation brings to [life], and to [fit] if `new` has restated it."""

import json

import pytest

import bearingjax as bj
from bearingjax.scene.life_table import life_conditions, not_published

LOAD = '[operating]\nload = { Fy = "-1 kN" }\n'


@pytest.fixture
def read(tmp_path):
    def made(bearing, more="", settings=()):
        path = tmp_path / "scene.toml"
        path.write_text(f"[bearing]\n{bearing}\n{LOAD}{more}", encoding="utf-8")
        return bj.read_scene(path, settings)

    return made


def rated(conditions):
    names = ("dynamic_capacity", "static_capacity", "fatigue_load_limit")
    values = (getattr(conditions, name) for name in names)
    return tuple(None if value is None else float(value) for value in values)


def test_published_ratings_count_unless_given(read):
    entry = bj.catalogue_entry("6205")
    scene = read('designation = "6205"', "[life]\n")
    own = (entry.dynamic_capacity, entry.static_capacity, entry.fatigue_load_limit)
    assert rated(life_conditions(scene)) == own
    # What says nothing of the ratings leaves them, what is said in [life] counts.
    scene = read(
        'designation = "6205"\nradial_internal_clearance = "3 um"\n',
        '[life]\ndynamic_capacity = "15 kN"\n',
    )
    assert rated(life_conditions(scene)) == (15e3, *own[1:])


def test_another_geometry_is_rated_by_the_standards(read):
    scene = read('designation = "6205"\nn_balls = 8', "[life]\n")
    assert rated(life_conditions(scene)) == (None, None, None)
    assert not_published(scene) == [
        "  (not the published ones of 6205: n_balls differs)"
    ]
    scene = read('designation = "6205"', "[life]\n")
    assert rated(life_conditions(scene, ["bearing.ball_diameter"])) == (None,) * 3
    harmless = ["bearing.radial_internal_clearance", "operating.load.Fy"]
    assert rated(life_conditions(scene, harmless))[0] == 14.8e3
    assert not_published(scene, harmless) == []


def test_a_pair_is_rated_as_two_rows(read):
    entry = bj.catalogue_entry("7208B")
    own = entry.dynamic_capacity, entry.static_capacity, entry.fatigue_load_limit
    pair = '[set]\narrangement = "back_to_back"\nspacing = "18 mm"\n'
    scene = read('designation = "7208B"', pair)
    # ISO 281, 5.1.2.2: two rows bear 2^0.7 of what one bears.
    wanted = [f * v for f, v in zip((2**0.7, 2, 2), own, strict=True) if v is not None]
    assert rated(life_conditions(scene)) == pytest.approx(wanted, rel=1e-12)


def test_both_rows_of_a_self_aligning_bearing_are_in_its_ratings(read):
    entry = bj.catalogue_entry("1205")
    assert rated(life_conditions(read('designation = "1205"')))[0] == (
        entry.dynamic_capacity
    )


def test_a_clearance_that_only_restates_the_catalogue_is_its_class(read):
    fit = '[fit]\nshaft = "k5"\nhousing = "H7"\nhousing_diameter = "80 mm"\n'
    restated = 'designation = "6205"\nradial_internal_clearance = "12.5 um"'
    limits = read(restated, fit).fits.limits["clearance"]
    assert tuple(limits) == pytest.approx((5e-6, 20e-6))
    limits = read(restated, fit, ["fit.clearance=C3"]).fits.limits["clearance"]
    assert tuple(limits) == pytest.approx((13e-6, 28e-6))
    with pytest.raises(bj.SceneError, match=r"`fit.clearance`: stands beside"):
        read(restated.replace("12.5", "3"), fit, ["fit.clearance=C3"])


def test_ratings_come_back_from_the_json(read, tmp_path):
    pair = '[set]\narrangement = "back_to_back"\nspacing = "18 mm"\n[life]\n'
    scene = read('designation = "7208B"', pair)
    path = tmp_path / "again.json"
    path.write_text(json.dumps({"inputs": scene.inputs}), encoding="utf-8")
    again = bj.read_scene(path)
    assert rated(life_conditions(again)) == rated(life_conditions(scene))

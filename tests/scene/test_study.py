"""`bj.run`: the study that a scene describes."""

import pytest

import bearingjax as bj
from bearingjax.scene import STUDIES, SceneError, shipped_scenes, study_of

TOLD = {
    "rotor_flexible": "rotor",
    "taper_contact": "contact",
    "noise_pair": "noise",
    "skid_roller": "skid",
    "fujiwara_kawase": "optimise",
    "life_spectrum": "life",
    "load_map": "sweep",
    "ball_pair": "solve",
}


@pytest.mark.parametrize("name", TOLD)
def test_study_of_a_shipped_scene(name):
    assert study_of(name) == TOLD[name]


@pytest.mark.parametrize("name", shipped_scenes())
@pytest.mark.slow
def test_study_reads_every_shipped_scene(name):
    STUDIES[study_of(name)].read(name, [])


def test_run_solves_scene_with_settings(untyped):
    found = bj.run("cylindrical_rig", ["operating.load.Fy=-2 kN"])
    assert isinstance(found, bj.Solution) and found.converged
    assert float(found.force[1]) == pytest.approx(-2000.0, rel=1e-9)


@pytest.mark.slow
def test_run_solves_the_cases():
    some = '{ grid = { "operating.load.Fy" = ["-1 kN", "-2 kN"] } }'
    found = bj.run("cylindrical_rig", [f"cases={some}"])
    assert isinstance(found, bj.statics.Sweep) and found.converged.all()
    assert found.cases.count == 2


def test_run_of_no_scene():
    with pytest.raises(SceneError, match="no such file"):
        bj.run("none.toml")

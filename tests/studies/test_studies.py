"""`bj.run`, the study that a scene describes; options that all commands have alike."""

import argparse
import sys
from functools import partial

import pytest

import bearingjax as bj
from bearingjax import cli
from bearingjax.cli.entry import parser
from bearingjax.cli.execute import OUTPUTS
from bearingjax.files import SceneError, shipped_scenes
from bearingjax.studies.commands import SOLVING
from bearingjax.studies.solve.compare import run_compare
from bearingjax.studies.solve.run import solve_scene
from bearingjax.studies.study import STUDIES, study_of

TOLD = {
    "rotor_flexible": "rotor",
    "taper_contact": "contact",
    "noise_pair": "noise",
    "skid_roller": "skid",
    "fujiwara_kawase": "optimise",
    "life_spectrum": "life",
    "select_gearbox": "select",
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
    assert isinstance(found, bj.statics.Solution) and found.converged
    assert float(found.force[1]) == pytest.approx(-2000.0, rel=1e-9)


@pytest.mark.slow
def test_run_solves_the_cases():
    some = '{ grid = { "operating.load.Fy" = ["-1 kN", "-2 kN"] } }'
    found = bj.run("cylindrical_rig", [f"cases={some}"])
    assert isinstance(found, bj.cases.Sweep) and found.converged.all()
    assert found.cases.count == 2


def test_run_of_no_scene():
    with pytest.raises(SceneError, match="no such file"):
        bj.run("none.toml")


SCENES = {
    "solve": "tapered",
    "sweep": "load_map",
    "compare": "tapered",
    "optimise": "fujiwara_kawase",
    "identify": "identify_clearance",
    "life": "life_spectrum",
    "contact": "taper_contact",
    "skid": "skid_axial",
    "rotor": "rotor_flexible",
    "shaft": "shaft_fan",
    "noise": "noise_four_point",
    "select": "select_gearbox",
    "tolerances": "tolerances_seats",
}
STATUS = {
    "sweep": "0 all solved, 2 bad input, 3 some not solved (the table holds"
    " a result for each case), 130 interrupted (what is solved is kept).",
    "compare": "0 all solved, 2 bad input, 3 some not solved.",
    "optimise": "0 optimised, 2 bad input, 3 not solved or not converged.",
    "identify": "0 identified, 2 bad input, 3 not solved or not converged.",
    "rotor": "0 solved, 2 bad input, 3 not solved, or only in part.",
    "shaft": "0 solved, 2 bad input, 3 not solved, or only in part.",
    "select": "0 chosen, 2 bad input, 3 none fits.",
    "tolerances": "0 solved, 2 bad input, 3 not solved or not converged.",
}
ENDINGS = {
    "--plot": "a picture ends in .png, .pdf or .svg",
    "--drawing": "a picture ends in .png, .pdf or .svg",
    "--report": "a report ends in .html",
    "--wav": "a sound ends in .wav",
    "--table": "a table ends in .csv, .parquet, .xlsx",
}
SUFFIX = {"--json": "json", "--table": "csv", "--wav": "wav", "--report": "html"}


def outputs():
    """Every command with each of its options that name a file."""
    (commands,) = parser()._subparsers._group_actions  # pyright: ignore
    for name in SCENES:
        known = commands.choices[name]._option_string_actions  # pyright: ignore
        yield from ((name, f"--{out}") for out in OUTPUTS if f"--{out}" in known)


OPTIONS = [*outputs()]
OTHERS = [pair for pair in OPTIONS if pair[1] != "--json"]
commands = pytest.mark.parametrize("command", SCENES)
options = partial(pytest.mark.parametrize, "command, option")


@pytest.fixture
def no_solve(monkeypatch):
    """Whatever is refused is refused before anything is solved."""

    def refuse(*_, **__):
        raise AssertionError("solved a scene")

    for function in (solve_scene, run_compare, *(s.run for s in STUDIES.values())):
        module = sys.modules[function.__module__]
        monkeypatch.setattr(module, function.__name__, refuse)


def test_every_command_is_tested():
    commands = argparse.ArgumentParser().add_subparsers()
    names = [one.add(commands).prog.split()[-1] for one in SOLVING]
    assert [*SCENES, "validate"] == names  # which has cases, no scene
    assert set(SCENES) == {*STUDIES, "compare"}


@options(OPTIONS)
@pytest.mark.usefixtures("no_solve")
def test_output_in_missing_folder(run, tmp_path, command, option):
    path = tmp_path / "none" / f"out.{SUFFIX.get(option, 'png')}"
    done = run(command, SCENES[command], option, path)
    assert done == (2, "", f"bearingjax: {path}: its folder does not exist\n")
    assert not path.parent.exists()


@options(OPTIONS)
@pytest.mark.usefixtures("no_solve")
def test_folder_as_output(run, tmp_path, command, option):
    path = tmp_path / f"out.{SUFFIX.get(option, 'png')}"
    path.mkdir()
    done = run(command, SCENES[command], option, path)
    assert done.status == 2 and done.out == ""
    assert str(path) in done.err and done.err.count("\n") == 1


@options(OTHERS)
@pytest.mark.parametrize("name", ["out.gif", "out", "out.png.txt"])
@pytest.mark.usefixtures("no_solve")
def test_output_of_unknown_ending(run, tmp_path, command, option, name):
    path = tmp_path / name
    done = run(command, SCENES[command], option, path)
    assert done == (2, "", f"bearingjax: {path}: {ENDINGS[option]}\n")


@options([pair for pair in OTHERS if pair[1] not in ("--table", "--wav")])
@pytest.mark.usefixtures("no_solve")
def test_picture_without_matplotlib(run, tmp_path, monkeypatch, command, option):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    path = tmp_path / f"out.{SUFFIX.get(option, 'png')}"
    done = run(command, SCENES[command], option, path)
    problem = 'pictures need matplotlib: pip install "bearingjax[plot]"'
    assert done == (2, "", f"bearingjax: {problem}\n")


@commands
@pytest.mark.usefixtures("no_solve")
def test_output_rejects_path_of_read_scene(run, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    own = tmp_path / "self.toml"
    before = shipped_scenes()[SCENES[command]].read_bytes()
    own.write_bytes(before)
    done = run(command, "self.toml", "--json", own)
    problem = "is read as self.toml here; --json would overwrite it; name another file"
    assert done == (2, "", f"bearingjax: {own}: {problem}\n")
    assert own.read_bytes() == before


@commands
def test_command_interrupted_exit_status(run, monkeypatch, command):
    def stop(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("bearingjax.files.output_files.scene_files", stop)
    done = run(command, SCENES[command])
    assert done == (130, "", "bearingjax: interrupted\n")


@commands
def test_help_tells_the_exit_status(capsys, command):
    with pytest.raises(SystemExit) as stop:
        cli.main([command, "--help"])
    assert stop.value.code == 0
    told = STATUS.get(command, "0 solved, 2 bad input, 3 not solved.")
    assert f"Exit status: {told}" in " ".join(capsys.readouterr().out.split())


@commands
def test_unknown_option_prints_usage_of_command(capsys, command):
    with pytest.raises(SystemExit) as stop:
        cli.main([command, SCENES[command], "--plto", "out.png"])
    assert stop.value.code == 2
    err = capsys.readouterr().err
    assert "[--report OUT]" in err
    wrong = "error: unrecognized arguments: --plto out.png"
    assert f"bearingjax {command}: {wrong}" in err


@commands
def test_command_without_its_scene(run, command):
    done = run(command, "none.toml")
    assert done == (2, "", "bearingjax: none.toml: no such file\n")

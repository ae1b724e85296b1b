"""What the README, the scene guide and the package docstrings show is true."""

import argparse
import importlib
import re
from pathlib import Path

import pytest

import bearingjax as bj
from bearingjax.studies.commands import LOOKING_UP, SOLVING

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text()
GUIDE = (ROOT / "bearingjax" / "studies" / "README.md").read_text()
DOCUMENTED = (
    "bearingjax",
    "bearingjax.noise",
    "bearingjax.contact.halfspace",
    "bearingjax.skid",
    "bearingjax.element",
    "bearingjax.optimise",
    "bearingjax.rotor",
    "bearingjax.rotor.nonlinear",
    "bearingjax.statics",
    "bearingjax.cases",
    "bearingjax.catalogue",
    "bearingjax.life",
)


@pytest.mark.usefixtures("untyped")
@pytest.mark.slow
def test_python_example(capsys):
    (block,) = re.findall(r"```python\n(.*?)```", README, re.S)
    names: dict = {}
    exec(block, names)
    assert bool(names["solution"].converged)
    slope = float(capsys.readouterr().out.splitlines()[-1])
    assert -0.7 < slope < -0.5  # d(displacement)/d(clearance)


def test_two_commands_and_their_scene():
    quick_start = README.split("## Quick start")[1].split("\n## ")[0]
    blocks = re.findall(r"```bash\n(.*?)```", quick_start, re.S)
    assert len(blocks) == 2
    scene = re.search(r"bearingjax solve (\S+\.toml)", blocks[0])
    assert scene and (ROOT / scene[1]).is_file()
    assert "pytest" in blocks[1]
    # Continuous integration runs the others after it.
    assert '-m "not slow"' in blocks[1]
    (command,) = re.findall(r"bin/(pytest .*)", blocks[1])
    assert f"run: {command}\n" in (ROOT / ".github/workflows/tests.yml").read_text()


@pytest.mark.parametrize("place", ["", "bearingjax/studies", "benchmarks"])
def test_links_lead_somewhere(place):
    folder = ROOT / place
    for target in re.findall(
        r"\]\((?!http)([^)]+)\)", (folder / "README.md").read_text()
    ):
        assert (folder / target).exists(), target


def test_folders_exist():
    for folder in re.findall(
        r"^(bearingjax/\w+/|tests/|notebooks/|benchmarks/) ", README, re.M
    ):
        assert (ROOT / folder).is_dir(), folder


def test_all_notebooks_are_named():
    listed = (ROOT / "notebooks" / "notebooks.md").read_text()
    for notebook in (ROOT / "notebooks").glob("*.ipynb"):
        assert f"({notebook.name})" in listed


def test_commands_and_scenes_of_the_guide_exist():
    commands = set(re.findall(r"`bearingjax ([a-z]+)", GUIDE + README))
    assert "solve" in commands
    names = {
        action.add(argparse.ArgumentParser().add_subparsers()).prog.split()[-1]
        for action in (*SOLVING, *LOOKING_UP)
    }
    assert commands <= names
    shipped = bj.files.shipped_scenes()
    for scene in re.findall(r"`bearingjax (?!new)[a-z]+ ([a-z_]+)\b(?!\.)", GUIDE):
        assert scene in shipped, scene


@pytest.mark.parametrize("name", DOCUMENTED)
def test_names_in_docstrings_exist(name):
    """Every class that a package's docstring names can be found."""
    module = importlib.import_module(name)
    homes = [importlib.import_module(other) for other in DOCUMENTED]
    homes += [bj.design, bj.lubrication, bj.contact, bj.numerics, bj.plot]
    words = re.findall(
        r"`(?:design\.)?([A-Z]\w+)(?:\([^`]*\))?s?`", module.__doc__ or ""
    )
    foreign = {"LAPACK", "ROSS", "OPENBLAS_NUM_THREADS", "PJRT_NPROC", "XLA_FLAGS"}
    for word in set(words) - foreign:
        assert any(hasattr(home, word) for home in homes), word

"""What the README shows is true."""

import re
from pathlib import Path

import pytest

import bearingjax as bj

README = (Path(__file__).parent.parent / "README.md").read_text()


@pytest.mark.usefixtures("untyped")
def test_python_examples(capsys):
    blocks = re.findall(r"```python\n(.*?)```", README, re.S)
    assert len(blocks) == 11
    names: dict = {}
    for block in blocks[:2]:
        exec(block, names)
        assert bool(names["solution"].converged)
    lines = capsys.readouterr().out.splitlines()
    assert -0.7 < float(lines[-1]) < -0.5  # d(displacement)/d(clearance)
    exec(blocks[2], names)
    assert type(names["solution"]) is bj.BallSolution
    assert bool(names["solution"].converged)
    for block in blocks[3:5]:
        exec(block, names)
    contact = names["contact"]
    assert contact.converged and 1.2e9 < float(contact.peak_pressure) < 1.6e9
    # A flatter crown spreads the load.
    assert float(capsys.readouterr().out.splitlines()[-1]) < 0
    exec(blocks[5], names)
    assert type(names["coupled"].line_law) is bj.CoupledSlices
    refined = names["refined"]
    assert refined.solution.converged and 0.7 < refined.edge_factor < 1.3
    assert 0.4 < float(names["below"].von_mises.max() / refined.solution.peak_pressure)
    exec(blocks[6], names)
    assert names["swept"].counts() == {"converged": 60}
    for block in blocks[7:9]:
        exec(block, names)
    assert names["f"][7] < -100.0  # the inner ring is held down
    whole, pair = names["k6"], names["k2"]
    assert 0 < pair[1, 1] < whole[1, 1]
    exec(blocks[9], names)
    assert (names["critical"].speed > 0).all() and (names["shaken"].amplitude > 0).any()
    exec(blocks[10], names)
    best = names["best"]
    assert best.converged and best.after.exact < best.before.exact
    assert best.before.exact_constraints[0] > 10e3 >= best.after.exact_constraints[0]


def test_two_commands_and_their_scene():
    quick_start = README.split("## Quick start")[1].split("\n## ")[0]
    blocks = re.findall(r"```bash\n(.*?)```", quick_start, re.S)
    assert len(blocks) == 2
    scene = re.search(r"bearingjax solve (\S+\.toml)", blocks[0])
    assert scene and (Path(__file__).parent.parent / scene[1]).is_file()
    assert "pytest" in blocks[1]


def test_picture_and_folders_exist():
    root = Path(__file__).parent.parent
    for target in re.findall(r"\]\((?!http)([^)]+)\)", README):
        assert (root / target).exists(), target
    for folder in re.findall(
        r"^(bearingjax/\w+/|tests/|notebooks/|benchmarks/) ", README, re.M
    ):
        assert (root / folder).is_dir(), folder
    assert len(bj.scene.shipped_scenes()) == 25

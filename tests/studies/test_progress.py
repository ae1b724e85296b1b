"""What a run says of itself while it lasts, on a terminal and elsewhere."""

import contextlib
import re
import time

import numpy as np
import pytest

import bearingjax as bj
from bearingjax.numerics.compiled import programs
from bearingjax.studies import outcome
from bearingjax.studies.outcome import Stage


@pytest.fixture
def hasty(monkeypatch):
    """Told at once, and as often as asked."""
    monkeypatch.setattr(outcome, "PATIENCE", 0.02)
    monkeypatch.setattr(outcome, "INTERVAL", 0.05)


def test_stage_rewrites_one_line_of_a_terminal(capsys):
    stage = Stage(True)
    stage("first")
    with stage.during("compiling: life"):
        pass
    stage("second", 0.5)
    stage.end()
    shown = capsys.readouterr().err
    assert "\n" not in shown
    words = [part for part in re.split(r"\r\x1b\[K", shown) if part]
    assert words[:3] == ["first…", "compiling: life…", "first…"]
    assert words[3].startswith("second ██████████··········") and "50 %" in words[3]
    assert shown.endswith("\r\x1b[K")


def test_stage_tells_what_lasts_where_there_is_no_terminal(hasty, monkeypatch, capsys):
    monkeypatch.setattr(outcome, "INTERVAL", 10.0)
    stage = Stage(False)
    stage("short")
    stage("long")
    time.sleep(0.2)
    stage("never told")
    stage.end()
    time.sleep(0.1)
    assert capsys.readouterr().err == "long…\n"


def test_stage_tells_steps_seldom(hasty, capsys):
    stage = Stage(False)
    for step in range(30):
        stage(f"step {step}", counts=True)
        time.sleep(0.005)
    stage.end()
    lines = capsys.readouterr().err.splitlines()
    assert 1 <= len(lines) <= 5 and all(line.startswith("step ") for line in lines)


def test_short_stages_are_no_silence(hasty, capsys):
    stage = Stage(False)
    for step in range(20):
        stage(f"part {step}")
        time.sleep(0.01)
    stage.end()
    assert 1 <= len(capsys.readouterr().err.splitlines()) <= 5


def test_programs_say_what_is_compiled(tmp_path):
    """Once for a kind of bearing, and nothing of programs that are kept."""
    said = []
    stage = Stage(True)

    def telling(words):
        said.append(words)
        return stage.during(words)

    programs.keep_programs(tmp_path / "programs")
    programs.tell_compiling(telling)
    try:
        for count in (7, 9):
            bearing = bj.CylindricalRollerBearing(count, 0.0725, 0.010, 0.010)
            bj.solve_load(bj.BearingElement(bearing), np.eye(6)[0] * 1e3)
    finally:
        programs.tell_compiling(None)
        programs.keep_programs(keep=False)
    words = "compiling: solving a bearing under load, program "
    assert sum(one.startswith(words) for one in said) == 1


def test_no_two_lines_about_compiling_are_alike():
    said = []
    programs.tell_compiling(lambda words: contextlib.nullcontext(said.append(words)))
    try:
        for _ in range(2):
            with programs._compiling(bj.solve_load):
                pass
    finally:
        programs.tell_compiling(None)
    assert len(set(said)) == 2 and all(", program " in words for words in said)

"""Benchmarks keep running, and what they claim of robustness holds in small."""

import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import robust_rollers

FOLDER = Path(__file__).parent.parent.parent / "benchmarks"
HELPERS = {"timing.py", "peers.py"}
SCRIPTS = sorted({p.name for p in FOLDER.glob("*.py")} - HELPERS)


def test_rollers_always_find_their_equilibrium():
    """A seeded, small version of the run over a million rollers."""
    for row in robust_rollers.run(4000, "newton", seed=3):
        assert row["unconverged"] == 0 and row["silently_wrong"] == 0, row
        assert row["loaded"] > 0.3 * row["rollers"], row


@pytest.mark.parametrize("solver", ["bfgs", "plain"])
def test_other_methods_never_fail_silently(solver):
    """The paper's method, and Newton's without safeguards."""
    for row in robust_rollers.run(2000, solver, seed=3):
        assert row["silently_wrong"] == 0, row


@pytest.mark.parametrize("script", SCRIPTS)
def test_script_asks_a_question_and_explains_itself(script, monkeypatch, capsys):
    first = (FOLDER / script).read_text().splitlines()[0]
    assert first.startswith('"""') and "?" in first
    monkeypatch.setattr(sys, "argv", [script, "--help"])
    # Some set variables of their own process before they import JAX.
    monkeypatch.setattr(os, "environ", os.environ.copy())
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(FOLDER / script), run_name="__main__")
    assert ended.value.code == 0 and "usage" in capsys.readouterr().out


NEED_C = {
    "single_call.py",
    "ball_speed.py",
    "batch_throughput.py",
    "load_solve_throughput.py",
}


PLAIN = (
    "power.py",
    "error_vs_time.py",
    "gradient_cost.py",
    "robust_sweep.py",
    "robust_halfspace.py",
    "paper_mi_xia.py",
    "peers_halfspace.py",
    "error_vs_time_halfspace.py",
    "strips_halfspace.py",
    "crown_on_halfspace.py",
    "quarter_space.py",
    "coupled_slices.py",
)


@pytest.mark.parametrize("script", [*PLAIN, *sorted(NEED_C)])
def test_smoke(script):
    if script in NEED_C and not any(map(shutil.which, ("cc", "gcc", "clang"))):
        pytest.skip("no C compiler")
    command = [sys.executable, str(FOLDER / script), "--smoke", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stdout.strip().startswith("{")

"""Benchmarks keep running, and what they claim of robustness holds in small."""

import contextlib
import io
import json
import os
import runpy
import shutil
import sys
from pathlib import Path

import bench
import jax
import pytest
import robust_rollers

FOLDER = Path(__file__).parent.parent.parent / "benchmarks"
HELPERS = {"bench.py", "peers.py"}
SCRIPTS = sorted({p.name for p in FOLDER.glob("*.py")} - HELPERS)


@pytest.mark.slow
def test_rollers_always_find_their_equilibrium():
    """A seeded, small version of the run over a million rollers."""
    for row in robust_rollers.run(4000, "newton", seed=3):
        assert row["unconverged"] == 0 and row["silently_wrong"] == 0, row
        assert row["loaded"] > 0.3 * row["rollers"], row


RIBS = ("logarithmic, NUP", "taper, large rib")


@pytest.mark.parametrize("solver", ["bfgs", "plain"])
@pytest.mark.slow
def test_other_methods_never_fail_silently(solver):
    """The paper's method, and Newton's without safeguards: where there are ribs."""
    for row in robust_rollers.run(2000, solver, seed=3, names=RIBS):
        assert row["silently_wrong"] == 0, row


def run(script, *given):
    """What a script prints.

    Run here: a process of its own would import and compile again what is there.
    """
    with (
        pytest.MonkeyPatch.context() as patch,
        contextlib.redirect_stdout(io.StringIO()) as out,
        # As users run it.
        jax.numpy_rank_promotion("allow"),
        jax.numpy_dtype_promotion("standard"),
    ):
        patch.setattr(sys, "argv", [script, *given])
        # What some set for a process of their own.
        patch.setattr(os, "environ", os.environ.copy())
        patch.setattr(os, "sched_setaffinity", lambda *_: None, raising=False)
        try:
            runpy.run_path(str(FOLDER / script), run_name="__main__")
        except SystemExit as end:
            assert not end.code
    return out.getvalue()


@pytest.mark.parametrize("script", SCRIPTS)
def test_benchmark_script_docstring_and_help(script):
    first = (FOLDER / script).read_text().splitlines()[0]
    assert first.startswith('"""') and "?" in first
    assert "usage" in run(script, "--help")


def test_readme_has_the_rows_of_all_scripts():
    """`python benchmarks/bench.py` writes them."""
    text = (FOLDER / "README.md").read_text()
    assert bench.readme(text) == text
    assert all(f"({script})" in text for script in SCRIPTS)


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
    "robust_shafts.py",
    "shaft_system.py",
    "paper_mi_xia.py",
    "peers_halfspace.py",
    "error_vs_time_halfspace.py",
    "strips_halfspace.py",
    "crown_on_halfspace.py",
    "quarter_space.py",
    "coupled_slices.py",
    "catalogue_capacity.py",
)


@pytest.mark.usefixtures("untyped")
@pytest.mark.parametrize("script", [*PLAIN, *sorted(NEED_C)])
@pytest.mark.slow
def test_smoke(script):
    if script in NEED_C and not any(map(shutil.which, ("cc", "gcc", "clang"))):
        pytest.skip("no C compiler")
    for line in run(script, "--smoke", "--json").splitlines():
        assert json.loads(line)

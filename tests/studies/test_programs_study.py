"""The commands about compiled programs: `cache` and `warm`."""

import os
import subprocess
import sys

import pytest

from bearingjax.numerics.compiled import programs
from bearingjax.studies.programs.warm import kinds_of_catalogue


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """The user's cache, empty."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    yield tmp_path / "bearingjax"
    programs.keep_programs(keep=False)


def test_cache_tells_size_and_place_and_is_emptied(run, cache):
    assert "0 files of 0.0 MB" in run("cache").out
    for part in ("programs", "jax"):
        (cache / part).mkdir(parents=True)
        (cache / part / "one").write_bytes(bytes(600_000))
    other = cache / "other"
    other.write_text("not a program")
    told = run("cache").out
    assert f"2 files of 1.2 MB in {cache}" in told and "1074 MB at most" in told
    told = run("cache", "--clean").out
    assert told == f"removed 2 files of 1.2 MB in {cache}\n"
    assert "0 files" in run("cache").out and other.exists()


def test_commands_compile_for_few_calls(tmp_path):
    """In a process of its own, since the command sets JAX's settings."""
    program = (
        "from argparse import Namespace; from bearingjax.studies import jax_settings;"
        "from bearingjax.numerics.compiled import programs;"
        "jax_settings.configure(Namespace(command='solve'));"
        "print(programs._STORE.few_calls, programs._STORE.folder)"
    )
    told = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"XDG_CACHE_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert told == f"True {tmp_path / 'bearingjax' / 'programs'}\n"


def test_kinds_of_designations_are_named_once():
    kinds = kinds_of_catalogue(["6205", "6308", "NU 210", "6206", "NU 214"])
    assert [name for name, _ in kinds] == ["6205", "NU 210", "NU 214"]


@pytest.mark.slow
def test_kinds_of_the_catalogue_are_few():
    """2230 bearings, of which hundreds had a structure of their own."""
    kinds = kinds_of_catalogue()
    assert len(kinds) <= 44


def test_warm_of_an_unknown_designation(run):
    done = run("warm", "62O5")
    assert done.status == 2 and "is not a bearing of the catalogue" in done.err


@pytest.mark.slow
def test_warm_compiles_a_kind_once(run, cache):
    programs.keep_programs()
    first = run("warm", "51100", "--quiet").out
    assert first.startswith("1 kinds; ") and " 0 programs compiled" not in first
    assert len(list((cache / "programs").iterdir())) >= 4
    assert run("warm", "51101", "--quiet").out.startswith("1 kinds; 0 programs")


COUNTING = """
import sys, traceback
import jax
from bearingjax.cli import main

def tell(event, seconds, **_):
    if event.endswith("backend_compile_duration"):
        frames = [f for f in traceback.extract_stack() if "bearingjax/" in f.filename]
        print("compiled:", *frames[-1:], file=sys.stderr)

jax.monitoring.register_event_duration_secs_listener(tell)
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("solve", "deep_groove"),
        ("life", "life_spectrum"),
        ("rotor", "rotor_flexible"),
        ("noise", "noise_deep_groove"),
        ("shaft", "shaft_gearbox"),
    ],
    ids=" ".join,
)
def test_stored_run_compiles_nothing(tmp_path, words):
    """Facts of designs, oils and reports are NumPy's: an operation of JAX outside of a
    program would be compiled anew by every process."""
    first, second = (
        subprocess.run(
            [sys.executable, "-c", COUNTING, *words, "--quiet"],
            env=os.environ | {"XDG_CACHE_HOME": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        )
        for _ in range(2)
    )
    assert "compiled:" in first.stderr and "compiled:" not in second.stderr
    assert first.stdout == second.stdout

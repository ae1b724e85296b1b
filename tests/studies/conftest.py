"""The command line in this process, without touching JAX's settings."""

import contextlib
import functools
import io
import json
import sys
from collections.abc import Callable
from html import unescape
from typing import NamedTuple

import pytest
from golden import MACHINE, differences, digest, machine, read, write
from pages import missing_on_page
from runs import Study, Written, place, words

from bearingjax import cli
from bearingjax.studies import jax_settings


class Run(NamedTuple):
    """What one call of the command line did."""

    status: int
    out: str
    err: str


class Named(NamedTuple):
    """A run of a study by its name in `STUDIES`."""

    name: str
    run: Study


def pytest_generate_tests(metafunc):
    """Each shared test of `runs` runs for the `STUDIES` of the file."""
    studies = getattr(metafunc.module, "STUDIES", {})
    slow = pytest.mark.slow
    if "study" in metafunc.fixturenames:
        again = "rerun" in metafunc.fixturenames
        some = [
            pytest.param(
                Named(name, study), id=name, marks=slow if study.slow[0] else ()
            )
            for name, study in studies.items()
            if study.again is not None or not again
        ]
        metafunc.parametrize("study", some)
    if "unsolved" in metafunc.fixturenames:
        some = [
            pytest.param((study, case), id=why, marks=slow if study.slow[1] else ())
            for study in studies.values()
            for why, case in study.unsolved.items()
        ]
        metafunc.parametrize("unsolved", some)


@pytest.fixture(scope="module")
def written(request, tmp_path_factory) -> Callable[[str], Written]:
    """What the run of `STUDIES` of this name wrote; it is solved once."""

    @functools.cache
    def call(name):
        study = request.module.STUDIES[name]
        paths = place(study, tmp_path_factory.mktemp("study"))
        out, err = io.StringIO(), io.StringIO()
        given = [str(word) for word in words(study, paths)]
        with (
            pytest.MonkeyPatch.context() as patch,
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            patch.setattr(jax_settings, "configure", lambda options: None)
            status = cli.main(given)
        done = Run(status, out.getvalue(), err.getvalue())
        assert status == 0, done.err
        return Written(done, json.loads(paths["--json"].read_text("utf-8")), paths)

    return call


@pytest.fixture
def golden(request) -> Callable[[str, dict], None]:
    """Compare the JSON of a run with its golden file, or write that anew."""

    def call(name, numbers):
        name, entries = name.replace(" ", "_"), digest(numbers)
        if request.config.getoption("--write-golden"):
            write(name, entries)
        elif MACHINE.read_text("utf-8") != machine():
            pytest.skip("the golden files were written on another kind of machine")
        told = differences(entries, read(name))
        assert not told, "\n".join(told)

    return call


@pytest.fixture(autouse=True)
def close_figures():
    """Figures that are written to files have been drawn."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def rerun(run, tmp_path) -> Callable:
    """Run a command on the JSON that it wrote: the same numbers, and its report.

    What is static and filled in by the echo (free freedoms, the tolerance) the scene
    had better say itself, so that the programs are compiled already.
    """

    def call(command, out, *options, pictures=1):
        again, page = tmp_path / "again.json", tmp_path / "again.html"
        files = ("--json", again, "--report", page)
        done = run(command, out, *options, *files)
        assert done.status == 0, done.err
        first, second = (json.loads(path.read_text("utf-8")) for path in (out, again))
        assert second["inputs"] == first["inputs"] and second == first
        text = unescape(page.read_text(encoding="utf-8"))
        # But for the name, which is that of the file.
        assert not missing_on_page(text, done.out)
        assert text.count("data:image/png;base64,") == pictures
        for title in ("Inputs", "How to run it again"):
            assert f"<h2>{title}</h2>" in text
        assert all(f"[{table}]" in text for table in first["inputs"])
        assert all(f"<li>{one}</li>" in text for one in second["warnings"])
        return text

    return call


@pytest.fixture
def run(monkeypatch, capsys):
    """Call `bearingjax` with arguments; programs are those of this process."""
    monkeypatch.setattr(jax_settings, "configure", lambda options: None)

    def call(*arguments):
        status = cli.main([str(a) for a in arguments])
        return Run(status, *capsys.readouterr())

    return call


@pytest.fixture
def undrawn(run, monkeypatch, tmp_path) -> Callable:
    """Run a solved command again, whose picture now fails: nothing else is lost."""

    def call(figure, out, *arguments, others=()):
        def refuse(*_, **__):
            raise ZeroDivisionError("no scale")

        first = out.read_bytes()
        picture, page = tmp_path / "lost.png", tmp_path / "lost.html"
        picture.write_text("of an earlier run", encoding="utf-8")
        told = [one.read_bytes() for one in others]
        monkeypatch.setattr(f"bearingjax.plot.{figure}", refuse)
        files = ("--json", out, "--plot", picture, "--report", page)
        done = run(*arguments, *files)
        monkeypatch.undo()
        assert done.status == 2 and not picture.exists()
        lines = done.err.splitlines()
        why = "could not be made: ZeroDivisionError: no scale"
        assert f"bearingjax: {picture}: {why}" in lines
        assert f"bearingjax: {picture}: of an earlier run, removed" in lines
        assert lines[-1].startswith(f"bearingjax: {page}: ")
        assert lines[-1].endswith(why)
        assert out.read_bytes() == first
        assert [one.read_bytes() for one in others] == told
        text = unescape(page.read_text(encoding="utf-8"))
        assert f"<p>This picture {why}</p>" in text
        assert "<h2>Inputs</h2>" in text and done.out.splitlines()[0] in text

    return call

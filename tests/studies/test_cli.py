"""The command line: report, JSON, picture, exit status."""

import base64
import json
import os
import re
import runpy
import subprocess
import sys
from html.parser import HTMLParser

import numpy as np
import pytest
from pages import missing_on_page
from runs import SEARCH, WORDS
from tolerances import SOLVER

import bearingjax as bj
from bearingjax import cli
from bearingjax.studies import jax_settings

TAPER = ("solve", "tapered", "--set", "output.points=21")
PULLED = (*TAPER, "--set", "operating.load.Fz=-6 kN")


@pytest.fixture
def no_solve(monkeypatch):
    """Whatever is refused is refused before anything is solved."""

    def refuse(scene):
        raise AssertionError("solved a scene")

    monkeypatch.setattr("bearingjax.studies.solve.run.run_scene", refuse)


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


class Page(HTMLParser):
    """What stands on a page; every element must end where it began."""

    def __init__(self, text):
        super().__init__()
        self.inside, self.titles, self.images, self.words = [], [], [], []
        self.feed(text)
        self.close()
        assert self.inside == []

    def handle_starttag(self, tag, attrs):
        if tag == "img":
            self.images.append(dict(attrs)["src"])
        if tag not in ("img", "meta", "wbr"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        assert self.inside.pop() == tag

    def handle_data(self, data):
        if self.inside and self.inside[-1] == "h2":
            self.titles.append(data)
        if "style" not in self.inside:
            self.words.append(data)


def test_solve_report_is_self_contained_html(run, tmp_path):
    path, pictures = tmp_path / "out.html", [tmp_path / "a.png", tmp_path / "b.png"]
    change = "operating.load.Fy=-9 kN"
    arguments = ("solve", "cylindrical_rig", "--set", change, "--report", path)
    done = run(*arguments, "--plot", pictures[0], "--drawing", pictures[1])
    assert done.status == 0 and done.err == ""
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    assert page.titles == [
        "Warnings",
        "Section, load zone, contacts",
        "Bearing",
        "Operation, materials and laws",
        "Displacement and load",
        "Stiffness",
        "Rolling elements",
        "Solution",
        "Credibility",
        "Drawing",
        "Inputs",
        "How to run it again",
    ]
    words = "\n".join(page.words)
    # All of the report on the terminal stands there, but for the rules between parts.
    assert not missing_on_page(words, done.out)
    # The pictures are those of --plot and --drawing, and nothing is fetched.
    for image, picture in zip(page.images, pictures, strict=True):
        data = base64.b64decode(image.removeprefix("data:image/png;base64,"))
        assert data == picture.read_bytes()
    assert not re.search(r"(?:src|href)=\"(?!data:)|url\(|@import|<script", text)
    assert "@media print" in text
    # It tells how to make it again: command, changes, scene.
    shipped = bj.files.shipped_scenes()["cylindrical_rig"].read_text(encoding="utf-8")
    assert shipped in words and f"--set '{change}'" in words
    assert bj.__version__ in words and "-9 kN" in words


def test_a_report_of_strange_names_is_still_a_page(run, tmp_path):
    scene = tmp_path / "<b>&amp;.toml"
    shipped = bj.files.shipped_scenes()["cylindrical_rig"].read_text(encoding="utf-8")
    scene.write_text(f"# </pre><script>x</script>\n{shipped}", encoding="utf-8")
    path = tmp_path / "out.HTM"
    assert run("solve", scene, "--report", path).status == 0
    text = path.read_text(encoding="utf-8")
    assert "<script" not in text and "<h1>&lt;b&gt;&amp;amp;</h1>" in text
    assert "# </pre><script>x</script>" in "\n".join(Page(text).words)


def test_solve_without_solution_removes_old_report(run, tmp_path):
    path = tmp_path / "out.html"
    path.write_text("of an earlier run", encoding="utf-8")
    assert run(*PULLED, "--report", path).status == 3
    assert not path.exists()


@pytest.mark.usefixtures("no_solve")
def test_solve_rejects_file_named_twice(run, tmp_path):
    same = tmp_path / "out.html"
    done = run("solve", "tapered", "--report", same, "--json", same)
    assert done.status == 2 and "by --json and by --report; name two" in done.err


def test_setting_changes_the_load(run, tmp_path):
    change = ("--set", "operating.load.Fx=-2 kN", "--set", "operating.load.My=3 N m")
    assert run(*TAPER, *change, "--json", tmp_path / "out.json").status == 0
    force = np.array(read(tmp_path / "out.json")["force"])[6:11]
    assert np.allclose(force, [-2e3, 0, 6e3, 0, 3], rtol=0.0, atol=6e3 * SOLVER)


def test_solve_command_without_solution_draws_the_bearing(run, tmp_path):
    drawing = tmp_path / "drawing.svg"
    assert run(*PULLED, "--drawing", drawing).status == 3
    assert "roller_axis_angle = 11" in drawing.read_text(encoding="utf-8")


def test_a_roller_of_a_bearing_without_a_solution(run, tmp_path):
    out, picture = tmp_path / "out.json", tmp_path / "out.png"
    picture.write_text("of an earlier run", encoding="utf-8")
    done = run("contact", *PULLED[1:], "--json", out, "--plot", picture)
    assert done.status == 3 and done.out == "" and not picture.exists()
    assert set(read(out)) == WORDS | SEARCH and read(out)["result"] == "no_load_path"


def test_scene_of_ones_own(run, tmp_path):
    """A file is named as it is given; its name heads the report."""
    path = tmp_path / "my $taper_{.toml"
    shipped = bj.files.shipped_scenes()["tapered"].read_text(encoding="utf-8")
    path.write_text(f"{shipped}\n[output]\npoints = 21\n", encoding="utf-8")
    done = run("solve", path, "--plot", tmp_path / "x.png")
    assert done.status == 0
    assert done.out.startswith("my $taper_{: tapered roller bearing, 17 rollers")


@pytest.mark.parametrize("ending", ["PDF", "svg"])
@pytest.mark.slow
def test_pictures_of_lines(run, tmp_path, ending):
    path = tmp_path / f"out.{ending}"
    assert run(*TAPER, "--plot", path).status == 0
    head = {"PDF": b"%PDF", "svg": b"<?xml"}[ending]
    assert path.read_bytes().startswith(head)


def test_as_a_module(capsys, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["bearingjax", "--version"])
    # Another test may have imported it, and runpy warns of that.
    monkeypatch.delitem(sys.modules, "bearingjax.__main__", raising=False)
    with pytest.raises(SystemExit) as stop:
        runpy.run_module("bearingjax", run_name="__main__")
    assert stop.value.code == 0
    assert f"bearingjax {bj.__version__}\n" in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [[], ["solve"], ["dissolve", "tapered"]])
def test_wrong_usage(capsys, arguments):
    with pytest.raises(SystemExit) as stop:
        cli.main(arguments)
    assert stop.value.code == 2
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err.startswith("usage: bearingjax")


def test_main_with_closed_pipe(monkeypatch):
    """As in `bearingjax solve tapered | true`."""
    monkeypatch.setattr(jax_settings, "configure", lambda options: None)
    back, front = os.pipe()
    os.close(back)
    out = os.fdopen(front, "w")
    try:
        with monkeypatch.context() as patch:
            patch.setattr(sys, "stdout", out)
            assert cli.main(TAPER) == 0
        out.flush()
    finally:
        # What is left in the buffer goes nowhere.
        os.dup2(os.open(os.devnull, os.O_WRONLY), out.fileno())
        out.close()


@pytest.mark.parametrize("what", ["the report", "the numbers"])
def test_full_disk(run, monkeypatch, capsys, what):
    """A full disk behind standard output, and behind a file."""
    if not os.path.exists("/dev/full"):
        pytest.skip("no device that is always full")
    if what == "the numbers":
        done = run(*TAPER, "--json", "/dev/full")
        problem = "/dev/full: cannot be written: No space left on device"
        assert done == (2, "", f"bearingjax: {problem}\n")
        return
    monkeypatch.setattr(jax_settings, "configure", lambda options: None)
    with open("/dev/full", "w", encoding="utf-8") as out:
        with monkeypatch.context() as patch:
            patch.setattr(sys, "stdout", out)
            assert cli.main(TAPER) == 2
    problem = "standard output: No space left on device"
    assert capsys.readouterr().err == f"bearingjax: {problem}\n"


def test_drawing_of_catalogue_without_matplotlib(run, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    done = run("catalogue", "6205", "--drawing", tmp_path / "out.png")
    assert done.status == 2 and done.out == ""
    assert 'pip install "bearingjax[plot]"' in done.err and done.err.count("\n") == 1


@pytest.mark.slow
def test_solve_in_new_process_reuses_stored_programs(tmp_path):
    """Float64, nothing on standard error, and the program kept for another load."""
    program = "import sys; from bearingjax.cli import main; sys.exit(main())"
    hidden = ("JAX_", "XLA_", "PYTHONWARNINGS")
    clean = {k: v for k, v in os.environ.items() if not k.startswith(hidden)}
    out = tmp_path / "out.json"
    ending = "--json", out, "--quiet"

    def solve(*settings):
        done = subprocess.run(
            [sys.executable, "-c", program, "solve", *settings, *ending],
            env={**clean, "XDG_CACHE_HOME": str(tmp_path / "cache")},
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.startswith("cylindrical_rig: cylindrical roller bearing")
        assert read(out)["residual"] < SOLVER
        return done.stdout, set((tmp_path / "cache/bearingjax/programs").iterdir())

    scene = ("cylindrical_rig", "--set", "output.points=3")
    first, kept = solve(*scene)
    assert kept
    other, still = solve(*scene, "--set", "operating.load.Fy=-9 kN")
    assert still == kept
    assert "-10.6 kN" in first and "-9 kN" in other and "-10.6 kN" not in other

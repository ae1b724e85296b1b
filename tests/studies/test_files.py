"""Output files: nothing that is read is lost, nothing old is taken for new."""

import errno
import json
import os

import pytest

import bearingjax as bj
from bearingjax.files import SceneError
from bearingjax.files.output_files import Incomplete, check_outputs, write_outputs
from bearingjax.report.json_output import write_numbers

LIST = "operating.load.Fy [kN]\n-1\n"


@pytest.fixture
def own(tmp_path, monkeypatch):
    """A scene with a list of cases in the working folder, and nothing is solved."""

    def refuse(*_, **__):
        raise AssertionError("solved")

    for name in (
        "solve.run.run_scene",
        "cases.sweep_run.run_cases",
        "contact.run.run_contact",
        "optimise.run.run_optimisation",
    ):
        monkeypatch.setattr(f"bearingjax.studies.{name}", refuse)
    shipped = bj.files.shipped_scenes()["cylindrical_rig"].read_text(encoding="utf-8")
    path = tmp_path / "self.toml"
    path.write_text(f'{shipped}\n[cases]\nfile = "list.csv"\n', encoding="utf-8")
    (tmp_path / "list.csv").write_text(LIST, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return path


def text(content):
    return lambda path: path.write_text(content, encoding="utf-8")


def fails(code):
    def write(path):
        path.write_text("half", encoding="utf-8")
        raise OSError(code, os.strerror(code))

    return write


def test_output_rejects_link_to_read_scene(run, own, tmp_path):
    (tmp_path / "deep").mkdir()
    os.link(own, tmp_path / "hard.toml")
    (tmp_path / "soft.json").symlink_to(own)
    for name in ("hard.toml", "soft.json", "deep/../self.toml"):
        done = run("solve", "self.toml", "--json", name)
        assert done.status == 2 and "is read as self.toml here" in done.err
    assert own.read_text(encoding="utf-8").endswith('file = "list.csv"\n')


def test_output_rejects_path_of_shipped_scene(run, own):
    path = bj.files.shipped_scenes()["tapered"]
    done = run("solve", "tapered", "--json", path)
    assert done.status == 2 and "is read as tapered.toml here" in done.err


def test_output_rejects_path_of_cases_list(run, own, tmp_path):
    done = run("sweep", "self.toml", "--table", "list.csv")
    assert done.status == 2 and done.err.count("\n") == 1
    assert "list.csv: is read as list.csv here; --table would overwrite" in done.err
    assert (tmp_path / "list.csv").read_text(encoding="utf-8") == LIST


@pytest.mark.parametrize("place", ["x.png", "./x.png", "link.png"])
def test_outputs_reject_equal_json_and_plot_path(run, own, tmp_path, place):
    (tmp_path / "link.png").symlink_to("x.png")
    done = run("solve", "self.toml", "--json", "x.png", "--plot", place)
    problem = "is named by --json and by --plot; name two files"
    assert done.status == 2 and done.err.count("\n") == 1
    assert done.err.endswith(f"{place[-5:]}: {problem}\n")


def test_outputs_reject_equal_json_and_table_path(run, own):
    done = run("sweep", "self.toml", "--json", "x.csv", "--table", "x.csv")
    assert done.status == 2 and "x.csv: is named by" in done.err


def test_check_outputs_rejects_write_protected_paths(own, tmp_path, monkeypatch):
    """As for somebody who is not the superuser, who may write anywhere."""
    path = tmp_path / "x.json"
    path.write_text("old", encoding="utf-8")
    monkeypatch.setattr(os, "access", lambda place, mode: not place.is_file())
    with pytest.raises(SceneError, match=r"x\.json: is write-protected"):
        check_outputs({"--json": path})
    monkeypatch.setattr(os, "access", lambda place, mode: not place.is_dir())
    with pytest.raises(SceneError, match=r"x\.json: its folder is write-protected"):
        check_outputs({"--json": path})


def test_files_come_together_or_not_at_all(tmp_path):
    one, two = tmp_path / "one.json", tmp_path / "two.png"
    one.write_text("old", encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        write_outputs([(one, text("new")), (two, fails(errno.ENOSPC))])
    assert str(caught.value) == f"{two}: cannot be written: No space left on device"
    assert one.read_text(encoding="utf-8") == "old"
    assert os.listdir(tmp_path) == ["one.json"]
    assert write_outputs([(one, text("new")), (two, text("2")), (None, None)]) == (
        [],
        [],
    )
    assert one.read_text(encoding="utf-8") == "new"
    assert sorted(os.listdir(tmp_path)) == ["one.json", "two.png"]


def test_write_outputs_with_failing_writers(tmp_path):
    error, part = ValueError("no scale"), Incomplete("without its drawing")

    def wrong(path):
        path.write_text("half", encoding="utf-8")
        raise error

    def partly(path):
        path.write_text("whole", encoding="utf-8")
        raise part

    names = ("old.png", "a.json", "new.png", "page.html")
    old, numbers, new, page = (tmp_path / name for name in names)
    old.write_text("old", encoding="utf-8")
    outputs = ((old, wrong), (numbers, text("1")), (new, wrong), (page, partly))
    removed, failed = write_outputs(outputs)
    assert removed == [old]
    assert failed == [(old, error), (new, error), (page, part)]
    assert sorted(os.listdir(tmp_path)) == ["a.json", "page.html"]
    assert page.read_text(encoding="utf-8") == "whole"


def test_write_outputs_interrupted_leaves_no_files(tmp_path):
    def stopped(path):
        path.write_text("half", encoding="utf-8")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_outputs([(tmp_path / "x.json", stopped)])
    assert os.listdir(tmp_path) == []


def test_write_outputs_removes_stale_files(tmp_path):
    stale = tmp_path / "old.png"
    stale.write_text("old", encoding="utf-8")
    assert write_outputs([(stale, None), (tmp_path / "none.png", None)])[0] == [stale]
    assert os.listdir(tmp_path) == []


def test_write_outputs_keeps_link_and_permissions(tmp_path):
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / "x.json", tmp_path / "x.json"
    target.write_text("old", encoding="utf-8")
    target.chmod(0o640)
    link.symlink_to(target)
    write_outputs([(link, text("new"))])
    assert link.is_symlink() and target.read_text(encoding="utf-8") == "new"
    assert target.stat().st_mode & 0o777 == 0o640


def test_write_outputs_to_device(tmp_path):
    null = type(tmp_path)(os.devnull)
    check_outputs({"--json": null, "--plot": null})
    write_outputs([(null, text("x"))])
    assert not null.is_file()


def test_write_numbers_non_finite_as_null(tmp_path):
    path = tmp_path / "x.json"
    write_numbers(path, {"a": [1.0, float("nan")], "b": {"c": float("inf"), "d": "x"}})
    numbers = json.loads(path.read_text(encoding="utf-8"))
    assert numbers == {"a": [1.0, None], "b": {"c": None, "d": "x"}}


def test_output_rejects_dash(run, own, tmp_path):
    done = run("solve", "self.toml", "--json", "-")
    problem = "--json -: name a file; /dev/stdout is the screen"
    assert done == (2, "", f"bearingjax: {problem}\n")

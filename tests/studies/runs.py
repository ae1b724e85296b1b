"""Tests of what every command that runs a study does alike.

A file of a study names its runs, `STUDIES = {"name": Study(...)}`, and has these tests
as `class TestRuns(Runs)`. `written(name)` is what such a run wrote; the file's own
tests look at it too, so each is solved once.
"""

import csv
import html
import json
from pathlib import Path
from typing import Any, NamedTuple

import bearingjax as bj
from bearingjax.studies.bearing.credibility import _MODELS

WORDS = frozenset({"result", "message", "warnings", "inputs", "version"})
SEARCH = frozenset({"residual", "iterations"})


class Study(NamedTuple):
    """One run of a command.

    Attributes:
        command: Its words: command, scene (its text or its name), settings, options.
        words: Keys of the JSON of a run without a solution.
        files: Names of its output files, by option.
        result: In the JSON, `None` for those of several cases.
        again: Words after the JSON when it is run from that, `None` if not tried.
        pictures: On the page of that run.
        unsolved: Words that leave it without a solution, the label of its result and
            the begin of the reason on standard error, by name.
        slow: Whether the run, and those without a solution, are marked so.
    """

    command: tuple
    words: frozenset = WORDS
    files: dict = {"--json": "a.json", "--table": "a.csv", "--plot": "a.png"}
    result: Any = "converged"
    again: tuple | None = ()
    pictures: int = 1
    unsolved: dict = {}
    slow: tuple[bool, bool] = (True, False)


class Written(NamedTuple):
    """What a run printed and wrote."""

    done: Any
    numbers: dict
    paths: dict

    @property
    def rows(self) -> list[list[str]]:
        """Header and rows of the table."""
        with open(self.paths["--table"], newline="", encoding="utf-8") as file:
            return list(csv.reader(file))

    def column(self, header) -> list[float]:
        """Numbers of one column of the table."""
        head, *rows = self.rows
        return [float(row[head.index(header)]) for row in rows]


def place(study: Study, folder) -> dict[str, Path]:
    """Path of each output in a folder, by option."""
    return {option: folder / name for option, name in study.files.items()}


def words(study: Study, paths: dict[str, Path], more=()) -> list:
    """The command line; the text of a scene is written beside the outputs. Tables are
    in SI, as the numbers of Python, with which they are compared to the last digit."""
    command, scene, *settings = study.command
    if "\n" in scene:
        path = paths["--json"].with_name("mine.toml")
        path.write_text(scene, encoding="utf-8")
        scene = path
    outputs = [word for pair in paths.items() for word in pair]
    plain = ["--si"] if "--table" in paths else []
    return [command, scene, *settings, *more, *plain, *outputs]


class Runs:
    """Tests of the `STUDIES` of a file."""

    def test_files_and_terminal_hold_the_same_run(self, written, study):
        """Exit status and warnings; a whole picture."""
        done, numbers, paths = written(study.name)
        assert done.status == 0 and done.err == "", done.err
        assert numbers.get("result") == study.run.result
        assert numbers["version"] == bj.__version__
        told = [line for line in done.out.splitlines() if line.startswith("warning: ")]
        before = [f"before: {text}" for text in numbers.get("warnings_before", ())]
        assert told == [f"warning: {text}" for text in numbers["warnings"] + before]
        if "--plot" in paths:
            picture = paths["--plot"].read_bytes()
            assert picture[:8] == b"\x89PNG\r\n\x1a\n" and len(picture) > 20_000
        assert "--table" not in paths or len(written(study.name).rows) > 1
        # How far the numbers are to be trusted; of `life` on the page alone.
        command, page = study.run.command[0], paths.get("--report")
        text = page.read_text("utf-8") if command == "life" and page else done.out
        if command in _MODELS and (page or command != "life"):
            model = " ".join(_MODELS[command][0].split())
            assert model in " ".join(html.unescape(text).split())

    def test_numbers_are_those_of_the_golden_file(self, written, study, golden):
        golden(f"{study.run.command[0]} {study.name}", written(study.name).numbers)

    def test_run_of_its_json_is_the_same(self, written, study, rerun):
        command, again, pictures = (
            study.run.command[0],
            study.run.again,
            study.run.pictures,
        )
        rerun(command, written(study.name).paths["--json"], *again, pictures=pictures)

    def test_unsolved_run_leaves_no_numbers(self, run, tmp_path, unsolved):
        """Exit status 3, the reason on standard error, no file of an earlier run."""
        study, (more, label, why) = unsolved
        paths = place(study, tmp_path)
        for path in paths.values():
            path.write_text("of an earlier run", encoding="utf-8")
        done = run(*words(study, paths, more))
        assert done.status == 3 and done.out == ""
        numbers = json.loads(paths["--json"].read_text(encoding="utf-8"))
        assert set(numbers) == study.words and numbers["result"] == label
        removed = [path for option, path in paths.items() if option != "--json"]
        lines = done.err.splitlines()
        for path in removed:
            assert f"bearingjax: {path}: of an earlier run, removed" in lines
            assert not path.exists()
        reason = lines[-1]
        assert reason.startswith(f"bearingjax: {why}")
        assert reason.endswith(numbers["message"])

"""Common path from options to outputs, for every command that writes files.

A command reads and solves, and returns an `Outcome`; `execute` checks the options
before, and writes, prints and reports problems after.
"""

import contextlib
import dataclasses
import functools
import io
import json
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .status import BAD_INPUT, NOT_SOLVED, SOLVED, complain

if TYPE_CHECKING:
    from ..report import Report

Draw = Callable[[], Any]
"""Function that draws a Matplotlib figure."""

OUTPUTS = "json", "table", "wav", "plot", "drawing", "report"
"""Options that name a file, in the order in which the files are written."""

_BAR = 20
"""Width of a progress bar."""
_PICTURE = (".png", ".pdf", ".svg"), "a picture ends in .png, .pdf or .svg"
_ENDINGS = {
    "plot": _PICTURE,
    "drawing": _PICTURE,
    "report": ((".html", ".htm"), "a report ends in .html"),
    "wav": ((".wav",), "a sound ends in .wav"),
}


@dataclasses.dataclass(frozen=True)
class Outcome:
    """Results of a command, ready for each of its outputs.

    Outputs that are `None`, such as those of an unsolved run, are not written; a file
    of an earlier run at their path is removed.

    Attributes:
        name: Name of the scene, the title of the page.
        inputs: All inputs, as written in a scene.
        numbers: Returns the JSON.
        report: Report shown on the terminal.
        columns: Returns the table, columns by header.
        pictures: Plots for `--plot` (the first) and the page, by title.
        drawing: Drawing of the bearing, for `--drawing` and the page.
        sound: Writes `--wav`; returns a line to be shown after the report.
        page: Returns the report of the page if it differs; default: `report`.
        table_on_page: Whether the page also shows the first rows of the table.
        problems: Reasons why it was not, or only partly, solved, a line each.
        interrupted: Called after writing; if the run was interrupted, returns the
            message in place of the problems, and the exit status.
    """

    name: str
    inputs: Mapping[str, Any]
    numbers: Callable[[], Mapping[str, Any]]
    report: "Report | None" = None
    columns: Callable[[], Mapping[str, Any]] | None = None
    pictures: Mapping[str, Draw] = dataclasses.field(default_factory=dict)
    drawing: Draw | None = None
    sound: Callable[[Path], str] | None = None
    page: "Callable[[], Report] | None" = None
    table_on_page: bool = False
    problems: Sequence[str] = ()
    interrupted: Callable[[], tuple[str, int] | None] = lambda: None

    def __post_init__(self):
        # A file and the page show the same: what both need is made once.
        drawn = {name: functools.cache(draw) for name, draw in self.pictures.items()}
        object.__setattr__(self, "pictures", drawn)
        for name in ("columns", "drawing"):
            made = getattr(self, name)
            if made is not None:
                object.__setattr__(self, name, functools.cache(made))


@dataclasses.dataclass(frozen=True)
class Tools:
    """Progress display and contexts for a command while it runs.

    Attributes:
        shown: Whether to show a progress bar.
        stage: Shows the current stage of a run; `None` if not shown.
        until_written: Enters a context that ends when all outputs are written.
    """

    shown: bool
    stage: "Stage | None"
    until_written: Callable[[Any], Any]


def execute(command: Any, options: Any) -> int:
    """Run a command: check the options, solve, write, print.

    Args:
        command: Its module; its `run(options, tools)` returns an `Outcome`.
        options: Command line options.

    Returns:
        Exit status.

    Raises:
        SceneError: For bad input, or outputs that cannot be written.
    """
    check_table(options)
    check_outputs(options)
    origin = _origin(options)
    shown = not getattr(options, "quiet", False) and sys.stderr.isatty()
    stage = Stage() if shown else None
    with contextlib.ExitStack() as stack:
        try:
            found = command.run(options, Tools(shown, stage, stack.enter_context))
        finally:
            if stage is not None:
                stage.end()
        messages: list[str] = []
        failed = _write(found, options, origin, messages)
        ended = found.interrupted()
    if found.report is not None:
        print("\n".join([str(found.report), *messages]), flush=True)
    if ended is not None:
        complain(ended[0])
        return ended[1]
    for problem in found.problems:
        complain(problem)
    return NOT_SOLVED if found.problems else BAD_INPUT if failed else SOLVED


def _write(found: Outcome, options, origin, messages: list[str]) -> bool:
    """Write the outputs of a run; return whether one of them failed."""
    from ..cases.sweep_table import write_columns
    from ..report import write_numbers

    def tabulate(path):
        assert found.columns is not None
        write_columns(found.columns(), path)

    def sound(path):
        assert found.sound is not None
        messages.append(found.sound(path))

    def picture(draw):
        return None if draw is None else lambda path: save(draw(), path)

    writers = {
        "json": lambda path: write_numbers(path, found.numbers()),
        "table": None if found.columns is None else tabulate,
        "wav": None if found.sound is None else sound,
        "plot": picture(next(iter(found.pictures.values()), None)),
        "drawing": picture(found.drawing),
        "report": None
        if found.report is None
        else lambda path: _write_page(path, found, origin),
    }
    return write_outputs([(getattr(options, k, None), writers[k]) for k in OUTPUTS])


def write_outputs(outputs) -> bool:
    """Write files, pairs of a path (`None`: not requested) and its writer.

    Reports which files of an earlier run were removed, and which failed: a failed
    picture does not affect tables and numbers.

    Returns:
        Whether one of them failed.
    """
    from ..files import write_outputs

    written = write_outputs(outputs)
    for path in written.removed:
        complain(f"{path}: of an earlier run, removed")
    for path, error in written.failed:
        complain(f"{path}: {_in_words(error)}")
    return bool(written.failed)


def _write_page(path: Path, found: Outcome, origin) -> None:
    """Write the HTML page of a run.

    Raises:
        Incomplete: If a picture failed; a line is shown in its place.
    """
    from ..files import Incomplete
    from ..report import report_page

    missing: list[str] = []

    def shown(name: str, draw: Draw) -> bytes | str:
        try:
            picture = io.BytesIO()
            save(draw(), picture, format="png")
            return picture.getvalue()
        except OSError:
            raise
        except Exception as error:
            missing.append(f"{name}: {_in_words(error)}")
            return f"This picture {_in_words(error)}"

    assert found.report is not None
    page = report_page(
        found.name,
        found.report if found.page is None else found.page(),
        found.inputs,
        origin,
        {name: shown(name, draw) for name, draw in found.pictures.items()},
        found.columns() if found.table_on_page and found.columns else None,
        found.problems,
        None if found.drawing is None else shown("Drawing", found.drawing),
    )
    path.write_text(page, encoding="utf-8")
    if missing:
        raise Incomplete("; ".join(missing))


def save(figure, path, **format) -> None:
    """Write a picture, to a file or a stream."""
    figure.savefig(path, dpi=150, **format)
    # Laid out once: a layout of what has its place already would shift it.
    figure.set_layout_engine("none")


def _in_words(error: Exception) -> str:
    """Describe why an output, or a part of one, is missing."""
    from ..files import Incomplete

    if isinstance(error, Incomplete):
        return str(error)
    return f"could not be made: {type(error).__name__}: {error}"


def check_outputs(options, inputs: Sequence[Path] | None = None) -> None:
    """Fail before solving if outputs cannot be written or overwrite an input.

    Args:
        options: Command line options.
        inputs: Files that are read; default: those of the scene.
    """
    from ..files import SceneError, check_outputs, scene_files

    outputs = {name: getattr(options, name, None) for name in OUTPUTS}
    for name, (endings, words) in _ENDINGS.items():
        path = outputs[name]
        if path is not None:
            if name != "wav":
                check_matplotlib()
            if path.suffix.lower() not in endings:
                raise SceneError(f"{path}: {words}")
    if inputs is None:
        inputs = [
            path
            for source in _sources(options)
            for path in scene_files(source, options.set)
        ]
    check_outputs({f"--{name}": path for name, path in outputs.items()}, inputs)


def check_table(options, rows: int = 0) -> None:
    """Fail before solving if a table with this number of rows cannot be written."""
    from ..cases.sweep_table import check_writable
    from ..files import SceneError

    table = getattr(options, "table", None)
    if table is None:
        return
    try:
        check_writable(table, rows)
    except (ValueError, ImportError) as error:
        raise SceneError(str(error)) from error


def check_matplotlib() -> None:
    """Fail if pictures cannot be drawn."""
    from ..files import SceneError

    try:
        import matplotlib
    except ImportError as error:
        problem = 'pictures need matplotlib: pip install "bearingjax[plot]"'
        raise SceneError(problem) from error
    matplotlib.use("Agg")


def _origin(options):
    """Return the origin of a report; called before solving, so that it has the scene as
    read."""
    import datetime

    from ..files.scene_file import find_scene
    from ..files.text_file import read_text
    from ..report import Origin

    now = datetime.datetime.now().astimezone()
    texts = []
    for source in _sources(options):
        path = find_scene(source)
        text = read_text(path)
        if path.suffix.lower() == ".json":  # of an earlier run: without its results
            inputs = json.loads(text).get("inputs")
            text = json.dumps({"inputs": inputs}, indent=1, ensure_ascii=False)
        texts.append(text)
    return Origin(
        shlex.join(["bearingjax", *options.given]),
        "\n".join(texts),
        tuple(options.set),
        now.strftime("%Y-%m-%d %H:%M %z"),
    )


def _sources(options) -> list[str]:
    """Return the scenes of a command."""
    return options.scenes if hasattr(options, "scenes") else [options.scene]


class Stage:
    """Display of the current stage of a run, on one line of standard error."""

    def __init__(self):
        self._used = False

    def __call__(self, name: str, share: float | None = None) -> None:
        """Show a stage in place of the previous one, with a bar if a share is done."""
        self._used = True
        if share is None:
            self._show(f"{name}…")
        else:
            full = round(_BAR * share)
            bar = "█" * full + "·" * (_BAR - full)
            self._show(f"{name} {bar} {100.0 * share:.0f} %")

    def end(self) -> None:
        """Clear the line."""
        if self._used:
            self._show("")

    def _show(self, words: str) -> None:
        print(f"\r\x1b[K{words}", end="", file=sys.stderr, flush=True)

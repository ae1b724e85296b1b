"""What a command returns, and the tools that it is given."""

import dataclasses
import functools
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..report.report_model import Report

Draw = Callable[[], Any]
"""Function that draws a Matplotlib figure."""

_BAR = 20
"""Width of a progress bar."""


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
    report: Report | None = None
    columns: Callable[[], Mapping[str, Any]] | None = None
    pictures: Mapping[str, Draw] = dataclasses.field(default_factory=dict)
    drawing: Draw | None = None
    sound: Callable[[Path], str] | None = None
    page: Callable[[], Report] | None = None
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

"""What a command returns, and the tools that it is given."""

import contextlib
import dataclasses
import functools
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..report.report_model import Report

Draw = Callable[[], Any]
"""Function that draws a Matplotlib figure."""

_BAR = 20
"""Width of a progress bar."""

PATIENCE = 2.0
"""Time after which a stage is told where there is no terminal [s]."""

INTERVAL = 5.0
"""Least time between two lines about a stage that goes on [s]."""


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


def picture(name: str, *given: Any, **more: Any) -> Draw:
    """Return a function that draws a plot, which is imported only then: for seconds.

    Args:
        name: Name of the function in `bearingjax.plot`.
        given, more: Its arguments.
    """

    def draw():
        from .. import plot

        return getattr(plot, name)(*given, **more)

    return draw


def outcome_of(
    name: str,
    inputs: Mapping[str, Any],
    found: Sequence[Any],
    numbers: Callable[..., Mapping[str, Any]],
    report: Callable[..., Report],
    columns: Callable[..., Mapping[str, Any]] | None,
    pictures: Mapping[str, Draw],
    *,
    solved: bool = True,
    **more: Any,
) -> Outcome:
    """Return the outcome of a run whose outputs are made of the same results.

    Args:
        name: Name of the scene, the title of the page.
        inputs: All inputs, as written in a scene.
        found: Arguments of the functions that follow.
        numbers, report, columns: Return JSON, report and table; `None`: no table.
        pictures: Plots by title.
        solved: Whether there is anything to report and to draw.
        more: The other fields of `Outcome`.
    """
    return Outcome(
        name,
        inputs,
        lambda: numbers(*found),
        report(*found) if solved else None,
        None if columns is None else lambda: columns(*found),
        pictures if solved else {},
        **more,
    )


def unsolved_start(
    scene: Any, inputs: dict[str, Any], error: Exception, result: str
) -> Outcome:
    """Return the outcome of a search whose first design does not solve.

    Args:
        scene: Its scene, with a `name` and `warnings`.
        inputs: All inputs, as written in a scene.
        error: Why it does not solve.
        result: Its result in the JSON.
    """
    from ..report.json_output import run_json

    status = {"result": result, "message": str(error)}
    numbers = run_json(status, scene.warnings, inputs)
    return Outcome(scene.name, inputs, lambda: numbers, problems=[str(error)])


class Stage:
    """Display of the current stage of a run on standard error.

    On a terminal it is one line that is rewritten. Elsewhere a stage that lasts for
    `PATIENCE` is told in a line of its own, and one that changes, or of several short
    ones the last, every `INTERVAL`.

    Args:
        terminal: Whether standard error is a terminal.
    """

    def __init__(self, terminal: bool):
        self._terminal, self._shown = terminal, False
        self._words, self._told = "", time.monotonic()
        self._timer: threading.Timer | None = None

    def __call__(
        self, name: str, share: float | None = None, *, counts: bool = False
    ) -> None:
        """Show a stage in place of the previous one.

        Args:
            name: What is done.
            share: Share that is done, shown as a bar; `None`: not known.
            counts: Whether the name has numbers that change all the time.
        """
        words = f"{name}…"
        if share is not None:
            full = round(_BAR * share)
            bar = "█" * full + "·" * (_BAR - full)
            words = f"{name} {bar} {100.0 * share:.0f} %"
        self._words = words
        if self._terminal:
            self._shown = True
            self._rewrite(words)
        elif share is not None or counts:
            self._tell_at_most(words)
        else:
            self._tell_later(words)

    @contextlib.contextmanager
    def during(self, name: str) -> Iterator[None]:
        """Show a stage within another one, which is shown again when it ends."""
        before = self._words
        self(name)
        try:
            yield
        finally:
            self._cancel()
            self._words = before
            if self._terminal:
                self._rewrite(before)

    def end(self) -> None:
        """Clear the line, and tell nothing more."""
        self._cancel()
        if self._shown:
            self._rewrite("")

    def _rewrite(self, words: str) -> None:
        print(f"\r\x1b[K{words}", end="", file=sys.stderr, flush=True)

    def _tell(self, words: str) -> None:
        self._told = time.monotonic()
        print(words, file=sys.stderr, flush=True)

    def _tell_at_most(self, words: str) -> None:
        self._cancel()
        if time.monotonic() - self._told >= max(INTERVAL, PATIENCE):
            self._tell(words)

    def _tell_later(self, words: str) -> None:
        self._cancel()
        if PATIENCE < threading.TIMEOUT_MAX:
            # Short stages one after the other are no silence.
            left = max(0.1 * PATIENCE, self._told + INTERVAL - time.monotonic())
            self._timer = threading.Timer(min(PATIENCE, left), self._tell, [words])
            self._timer.daemon = True
            self._timer.start()

    def _cancel(self) -> None:
        if self._timer is not None:
            self._timer.cancel()

"""Options shared by several commands."""

import argparse
from argparse import ArgumentParser
from pathlib import Path

Commands = argparse._SubParsersAction


def add_scene(command: ArgumentParser) -> None:
    """Add the scene argument, and options for settings and JSON."""
    command.add_argument("scene", metavar="SCENE", help=".toml file or a shipped scene")
    add_json(command)
    add_set(command)


def add_set(command: ArgumentParser, what: str = "change the scene") -> None:
    """Add `--set`, changes to the input."""
    command.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help=f'{what}, such as "operating.load.Fz=-6 kN"; KEY=unset takes a key'
        " away; may be repeated",
    )


def add_json(command: ArgumentParser) -> None:
    """Add `--json`, numbers in a file."""
    _add_output(command, "--json", "write numbers in SI")


def add_plot(command: ArgumentParser, what: str = "write a picture") -> None:
    """Add `--plot`, a picture."""
    _add_output(command, "--plot", f"{what} (.png, .pdf, .svg)")


def add_drawing(
    command: ArgumentParser, what: str = "of the one bearing that is named"
) -> None:
    """Add `--drawing`, a drawing of a bearing."""
    text = f"write a drawing {what}, with all its dimensions (.png, .pdf, .svg)"
    _add_output(command, "--drawing", text)


def add_table(command: ArgumentParser, row: str) -> None:
    """Add `--table`, a table with one row per `row`."""
    _add_output(command, "--table", f"write a row per {row} (.csv, .parquet, .xlsx)")


def add_report(command: ArgumentParser, what: str) -> None:
    """Add `--report`, a self-contained report with inputs and `what`."""
    text = f"write a report that stands alone (.html), with inputs and {what}"
    _add_output(command, "--report", text)


def add_quiet(command: ArgumentParser) -> None:
    """Add `--quiet`, no progress on standard error."""
    command.add_argument(
        "--quiet", action="store_true", help="no progress on standard error"
    )


def _add_output(command, name: str, text: str) -> None:
    command.add_argument(name, metavar="OUT", type=Path, help=text)

"""What may be written after several commands."""

from pathlib import Path


def add_scene(command) -> None:
    """The scene, changes to it, and numbers out of it."""
    command.add_argument("scene", metavar="SCENE", help=".toml file or a shipped scene")
    add_json(command)
    add_set(command)


def add_set(command, what: str = "change the scene") -> None:
    """Changes to what is read."""
    command.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help=f'{what}, such as "operating.load.Fz=-6 kN"; may be repeated',
    )


def add_json(command) -> None:
    """Numbers in a file."""
    _add_output(command, "--json", "write numbers in SI")


def add_plot(command, what: str = "write a picture") -> None:
    """A picture."""
    _add_output(command, "--plot", f"{what} (.png, .pdf, .svg)")


def add_drawing(command, what: str = "of the one bearing that is named") -> None:
    """A drawing of a bearing."""
    text = f"write a drawing {what}, with all its dimensions (.png, .pdf, .svg)"
    _add_output(command, "--drawing", text)


def add_table(command, row: str) -> None:
    """A table with one row per `row`."""
    _add_output(command, "--table", f"write a row per {row} (.csv, .parquet, .xlsx)")


def add_report(command, what: str) -> None:
    """A report with inputs and `what` in a file of its own."""
    text = f"write a report that stands alone (.html), with inputs and {what}"
    _add_output(command, "--report", text)


def add_quiet(command, without: str = "progress bar") -> None:
    """No progress on standard error."""
    command.add_argument("--quiet", action="store_true", help=f"no {without}")


def _add_output(command, name: str, text: str) -> None:
    command.add_argument(name, metavar="OUT", type=Path, help=text)

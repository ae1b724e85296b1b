"""`bearingjax warm`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_quiet
from ..status import SOLVED


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "warm",
        help="compile the programs of common kinds of bearings ahead of time",
        description="Compile what `solve`, `life` and `shaft` need of bearings, so that"
        " their first runs take no longer than others. Bearings of a kind share it,"
        " whatever their sizes and numbers of rolling elements (up to 16, 32, 64, 128"
        " in a row). It may be interrupted, and goes on where it was.",
        epilog="Exit status: 0, 2 for bad input, 130 interrupted.",
    )
    command.add_argument(
        "designation",
        metavar="DESIGNATION",
        nargs="*",
        help="bearings whose kinds are wanted; without any all kinds of the catalogue",
    )
    add_quiet(command)
    return command


def run(options: Namespace) -> int:
    """Compile the programs of kinds of bearings."""
    import sys
    import time

    from ...files.scene_errors import scene_errors
    from ..outcome import Stage
    from .warm import kinds_of_catalogue, warm

    stage = None if options.quiet else Stage(sys.stderr.isatty())
    with scene_errors("warm"):
        kinds = kinds_of_catalogue(options.designation or None)
    begin, compiled = time.monotonic(), 0
    for k, (name, element) in enumerate(kinds):
        if stage is not None:
            stage(f"kind {k + 1} of {len(kinds)}, such as {name}", counts=True)
        compiled += warm(element)
    if stage is not None:
        stage.end()
    took = time.monotonic() - begin
    print(f"{len(kinds)} kinds; {compiled} programs compiled in {took:.0f} s")
    return SOLVED

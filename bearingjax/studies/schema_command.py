"""`bearingjax schema`."""

import json
from argparse import ArgumentParser, Namespace

from .options import Commands
from .status import SOLVED


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "schema",
        help="the keys of scene files",
        description="Print the JSON Schema of scene files, with which editors complete"
        " and check them, or the keys of their tables with units, ranges and defaults.",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    command.add_argument(
        "--keys",
        metavar="TABLE",
        nargs="?",
        const="",
        help='print the keys of one table, such as "operating.load", or of all',
    )
    return command


def run(options: Namespace) -> int:
    """Print the JSON Schema, or tables of keys."""
    from .scene_schema import key_guide, scene_schema

    if options.keys is None:
        print(json.dumps(scene_schema(), indent=1, ensure_ascii=False), flush=True)
    else:
        print(key_guide(options.keys), end="", flush=True)
    return SOLVED

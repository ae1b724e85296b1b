"""`bearingjax examples`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands
from ..status import SOLVED


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "examples",
        help="the scenes that come with the package",
        description="List the shipped scenes, or print one.",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    command.add_argument("name", metavar="NAME", nargs="?")
    return command


def run(options: Namespace) -> int:
    """List the shipped scenes, or print one."""
    from ...files import SceneError, shipped_scenes
    from ...files.table import not_among
    from .catalogue_report import scene_list

    if options.name is None:
        print(scene_list(), flush=True)
        return SOLVED
    scenes = shipped_scenes()
    if options.name not in scenes:
        raise SceneError(f"examples: {not_among(options.name, tuple(scenes))}")
    print(scenes[options.name].read_text(encoding="utf-8"), end="", flush=True)
    return SOLVED

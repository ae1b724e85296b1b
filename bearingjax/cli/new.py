"""`bearingjax new`."""

from .status import SOLVED


def add(commands):
    """What may be written after it."""
    command = commands.add_parser(
        "new",
        help="a scene of a bearing of the catalogue",
        description="Print a scene of a bearing under a tenth of its capacity:"
        " bearingjax new 6205 > my.toml",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    command.add_argument("designation", metavar="DESIGNATION", nargs="+")
    return command


def run(options) -> int:
    """Print a scene of a bearing of the catalogue."""
    from ..scene import catalogue_entry, new_scene

    print(new_scene(catalogue_entry(" ".join(options.designation))), end="", flush=True)
    return SOLVED

"""`bearingjax cache`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands
from ..status import SOLVED


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "cache",
        help="where compiled programs are kept, and how large they are",
        description="Say where compiled programs are kept from run to run, how many"
        " there are and how large they are. All can be removed at any time: what is"
        " needed is compiled again.",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    command.add_argument("--clean", action="store_true", help="remove them")
    return command


def run(options: Namespace) -> int:
    """Show the kept programs, or remove them."""
    from ...numerics.compiled.programs import LARGEST_STORE, user_cache

    folder, total, files = user_cache(), 0, []
    for part in ("programs", "jax"):
        place = folder / part
        if place.is_dir():
            files += [one for one in place.iterdir() if one.is_file()]
    total = sum(file.stat().st_size for file in files)
    size = f"{len(files)} files of {total / 1e6:.1f} MB in {folder}"
    if options.clean:
        for file in files:
            file.unlink(missing_ok=True)
        print(f"removed {size}")
    else:
        print(
            f"{size}; programs take {LARGEST_STORE / 1e6:.0f} MB at most, the least"
            " recently used go first; `bearingjax cache --clean` removes all"
        )
    return SOLVED

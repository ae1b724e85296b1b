"""`bearingjax cache` and `warm`."""

import sys
import time
from argparse import Namespace


def show_cache(options: Namespace) -> None:
    """Say where compiled programs are kept from run to run, how many there are and how
    large they are. All can be removed at any time: what is needed is compiled again."""
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


def warm_up(options: Namespace) -> None:
    """Compile what `solve`, `life` and `shaft` need of bearings, so that their first
    runs take no longer than others. Bearings of a kind share it, whatever their sizes
    and numbers of rolling elements (up to 16, 32, 64, 128 in a row). It may be
    interrupted, and goes on where it was."""
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

"""How far a long run is, on one line of standard error."""

import contextlib
import sys
from collections.abc import Callable, Iterator


def is_shown(options) -> bool:
    """Whether somebody watches and wants to."""
    return not options.quiet and sys.stderr.isatty()


@contextlib.contextmanager
def stages(options) -> Iterator[Callable[[str], None] | None]:
    """What shows the stage that a run is in, if that is shown; its line ends empty."""
    if not is_shown(options):
        yield None
        return
    yield _show_stage
    _show_stage("")


def _show_stage(name: str) -> None:
    print(f"\r\x1b[K{name}{'…' if name else ''}", end="", file=sys.stderr, flush=True)

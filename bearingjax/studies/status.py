"""Exit status, and messages on standard error."""

import sys

SOLVED, BAD_INPUT, NOT_SOLVED, INTERRUPTED = 0, 2, 3, 130
"""Exit status."""


def complain(what: object) -> None:
    """Print a line on standard error."""
    print(f"bearingjax: {what}", file=sys.stderr)

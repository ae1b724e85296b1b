"""Exit status, and what is said on standard error."""

import sys

SOLVED, BAD_INPUT, NOT_SOLVED, INTERRUPTED = 0, 2, 3, 130
"""Exit status."""


def complain(what: object) -> None:
    """A line on standard error."""
    print(f"bearingjax: {what}", file=sys.stderr)


def tell_unsolved(scene, solution) -> int:
    """Say why a bearing was not solved; exit status."""
    from ..numerics import Result
    from ..statics.solution import message

    label = Result(int(solution.result)).label
    complain(f"{label}: {message(solution, scene.moving_ring)}")
    return NOT_SOLVED

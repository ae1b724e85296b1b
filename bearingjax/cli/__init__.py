"""The command line: runs the commands of `studies`, and writes their outcome.

Names
-----

- The program: `main`.
"""

from .entry import main

__all__ = [
    "main",
]  # fmt: skip

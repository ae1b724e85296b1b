"""The command line: a module per command, and shared modules.

A command's module has `add`, which adds its parser and options, and `run`, which runs
it and returns the exit status or an `Outcome`. They import the rest of the package
inside functions, so that `bearingjax --help` is fast.

Names
-----

- The program: `main`.
"""

from .entry import main

__all__ = [
    "main",
]  # fmt: skip

"""The command line: a module per command, and what they share.

A command's module has `add`, what may be written after its name, and `run`, what it
does; `run` returns the exit status. They import the rest of the package where they need
it, so that `bearingjax --help` waits for nothing of theirs.
"""

from .entry import main as main

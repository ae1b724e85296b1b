"""`main`: parse the command line, run a command, report its errors."""

import argparse
import functools
import gc
import io
import os
import sys
from collections.abc import Callable, Sequence

from ..studies import jax_settings
from ..studies.commands import LOOKING_UP, QUIET, SI, SOLVING, add_options
from ..studies.status import BAD_INPUT, INTERRUPTED, SOLVED, complain
from .about import citations, describe_version
from .completion import SHELLS, completion_script
from .execute import execute


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        arguments: Arguments without the program name; default: those of the process.

    Returns:
        Exit status: 0 solved, 2 bad input (or an output that cannot be written), 3 not
        solved, 130 interrupted.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # which may not know "µ"
            stream.reconfigure(errors="backslashreplace")
    from ..files import SceneError

    # Tracing makes many small objects; searching them for cycles takes a seventh of the
    # time of a command that ends before memory matters.
    collecting = gc.isenabled()
    gc.disable()
    try:
        options, unknown = parser().parse_known_args(arguments)
        if unknown:  # told with the usage of the command, not with that of all
            options.refuse(f"unrecognized arguments: {' '.join(unknown)}")
        options.given = list(sys.argv[1:] if arguments is None else arguments)
        jax_settings.configure(options)
        return options.execute(options) or SOLVED
    except SceneError as error:
        complain(error)
        return BAD_INPUT
    except KeyboardInterrupt:
        complain("interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of standard output has closed the pipe.
        _forget_output()
        return SOLVED
    except OSError as error:
        place = error.filename or "standard output"
        complain(f"{place}: {error.strerror or error}")
        if error.filename is None:
            _forget_output()
        return BAD_INPUT
    finally:
        if collecting:
            gc.enable()


def parser() -> argparse.ArgumentParser:
    """Build the parser; `execute` of the parsed options runs the command."""
    top = argparse.ArgumentParser(
        prog="bearingjax", description="Rolling-bearing mechanics."
    )
    _tell(top, "--version", describe_version, "versions, devices, precision", nargs=0)
    text = "BibTeX of this program, and of the methods that a scene uses"
    _tell(top, "--cite", citations, text, nargs="?", const="", metavar="SCENE")
    _tell(
        top,
        "--completion",
        lambda shell: completion_script(parser(), shell),
        "the script with which a shell completes commands",
        choices=SHELLS,
    )
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in (*SOLVING, *LOOKING_UP):
        added, call = command.add(commands), command.run
        if command in SOLVING:
            call = functools.partial(execute, command)
            add_options(added, SI, QUIET)
        added.set_defaults(execute=call, refuse=added.error)
    return top


def _tell(top, name: str, tell: Callable[..., str], text: str, **settings) -> None:
    """Add an option that prints what `tell` makes of its value, and ends."""

    class Tell(argparse.Action):
        def __call__(self, parser, namespace, values, option_string=None):
            print(tell(values), flush=True)
            parser.exit()

    top.add_argument(name, action=Tell, help=f"print {text}", **settings)


def _forget_output() -> None:
    """Redirect buffered standard output to the null device."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

"""`main`: parse the command line, run a command, report its errors."""

import argparse
import functools
import gc
import io
import os
import sys
from collections.abc import Callable, Sequence

from ..studies import jax_settings
from ..studies import schema_command as schema
from ..studies.cases import life_command as life
from ..studies.cases import sweep_command as sweep
from ..studies.catalogue import command as catalogue
from ..studies.catalogue import examples_command as examples
from ..studies.catalogue import new_command as new
from ..studies.contact import command as contact
from ..studies.identify import command as identify
from ..studies.noise import command as noise
from ..studies.optimise import command as optimise
from ..studies.options import add_quiet
from ..studies.programs import cache_command as cache
from ..studies.programs import warm_command as warm
from ..studies.rotor import command as rotor
from ..studies.select import command as select
from ..studies.shaft import command as shaft
from ..studies.skid import command as skid
from ..studies.solve import command as solve
from ..studies.solve import compare_command as compare
from ..studies.status import BAD_INPUT, INTERRUPTED, SOLVED, complain
from ..studies.tolerances import command as tolerances
from ..studies.validate import command as validate
from .about import citations, describe_version
from .completion import SHELLS, completion_script
from .execute import execute

_SOLVING = (
    solve,
    sweep,
    compare,
    optimise,
    identify,
    life,
    contact,
    skid,
    rotor,
    shaft,
    noise,
    select,
    tolerances,
    validate,
)
"""Commands that solve scenes; `execute` writes their outcome."""

_LOOKING_UP = (catalogue, new, examples, schema, cache, warm)
"""Commands that print, and return an exit status directly."""


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
        return options.execute(options)
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
    for command in (*_SOLVING, *_LOOKING_UP):
        added = command.add(commands)
        call = command.run
        if command in _SOLVING:
            call = functools.partial(execute, command)
            units = "tables, and inputs of a report, in SI"
            added.add_argument("--si", action="store_true", help=units)
            add_quiet(added)
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

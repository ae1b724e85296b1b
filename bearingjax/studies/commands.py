"""All commands of the program, which `commands.toml` declares."""

import dataclasses
import functools
import importlib
import json
from argparse import ArgumentParser, _SubParsersAction
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from ..numerics.constants import read_package_table
from .outputs import OUTPUTS

Option = tuple[str, Mapping[str, Any]]
"""Name of an argument, and what else `ArgumentParser.add_argument` takes."""


@dataclasses.dataclass(frozen=True)
class Command:
    """A command of the program.

    Attributes:
        name: Its word.
        help: What it is for, in the list of commands.
        options: Its options, in the order of its help.
        status: Meanings of its exit status.
        hint: Sentences of its help before those.
        place: Module below `studies`, and the function in it, that run it; empty: `run`
            of the `command` in the folder of its name.
    """

    name: str
    help: str
    options: tuple[Option, ...]
    status: str = "0 solved, 2 bad input, 3 not solved"
    hint: str = ""
    place: str = ""

    @functools.cached_property
    def run(self) -> Callable[..., Any]:
        """Function that runs it, with the parsed options, and what `execute` gives
        beside them; its docstring is what the command says of itself."""
        place = self.place or f"{self.name}.command.run"
        module, _, function = place.rpartition(".")
        return getattr(importlib.import_module(f".{module}", __package__), function)

    def add(self, commands: _SubParsersAction) -> ArgumentParser:
        """Add the command and its options; return its parser."""
        added = commands.add_parser(
            self.name,
            help=self.help,
            description=" ".join((self.run.__doc__ or "").split()),
            epilog=f"{self.hint} Exit status: {self.status}.".lstrip(),
        )
        add_options(added, *self.options)
        return added


def add_options(command: ArgumentParser, *options: Option) -> None:
    """Add options to a command."""
    for name, settings in options:
        command.add_argument(name, **settings)


def _as_setting(path: str) -> str:
    return f"identify.data={json.dumps(str(Path(path).resolve()))}"


_SCENE = "scene", {"metavar": "SCENE", "help": ".toml file or a shipped scene"}
_SET = (
    'change {}, such as "operating.load.Fz=-6 kN"; KEY=unset takes a key away; may be'
    " repeated"
)
_TYPES = {"int": int, "measured": _as_setting}
SI = "--si", {"action": "store_true", "help": "tables, and inputs of a report, in SI"}
QUIET = "--quiet", {"action": "store_true", "help": "no progress on standard error"}


def _options(declared: str | Mapping[str, Any]) -> Iterator[Option]:
    """Yield the options that an entry of `options` declares."""
    if not isinstance(declared, str):
        more = {k: _TYPES[v] if k == "type" else v for k, v in declared.items()}
        yield more.pop("name"), more
        return
    name, _, what = declared.partition(": ")
    if name == "scene":
        yield _SCENE
        yield from _options("json")
        yield from _options("set: the scene")
    elif name == "set":
        more = {"metavar": "KEY=VALUE", "action": "append", "default": []}
        yield "--set", {**more, "help": _SET.format(what)}
    elif name == "quiet":
        yield QUIET
    else:
        text = OUTPUTS[name].format(what)
        yield f"--{name}", {"metavar": "OUT", "type": Path, "help": text}


def _commands(declared: Mapping[str, Any]) -> Iterator[Command]:
    for name, one in declared.items():
        options = tuple(each for entry in one["options"] for each in _options(entry))
        yield Command(name, **{**one, "options": options})


_DECLARED = read_package_table("bearingjax.studies", "commands.toml")
SOLVING = tuple(_commands(_DECLARED["solving"]))
"""Commands that solve scenes; `execute` writes their outcome."""
LOOKING_UP = tuple(_commands(_DECLARED["looking_up"]))
"""Commands that print by themselves, and may return an exit status."""

"""Errors of scenes: the line of a key, which `tomllib` does not give, and the words of
constructors without Python's names."""

import bisect
import contextlib
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from .quantity import SceneError
from .text_file import read_text

_BARE = re.compile(r"[A-Za-z0-9_.\[\]-]+")
_CLOSINGS = "", "]", "]]", "]]]", "]}", "]}]"
"""Ends of a value of several lines that was cut off: TOML breaks lines in lists and
texts only. Texts cannot be closed here, because keys of a later line are none."""
_UNKNOWN: Any = object()
ABSENT: Any = object()
"""Value of a key that the scene lacks, also where `--set` took it away."""


def join_key(path: str, key: str) -> str:
    """Return the dotted path of a key, as messages show it.

    Args:
        path: Dotted path of its table; empty at the top.
        key: Name in the table.
    """
    shown = key if _BARE.fullmatch(key) else repr(key)
    return f"{path}.{shown}" if path else shown


def error_at(
    file: str | Path, key: str, problem: object, value: Any = _UNKNOWN
) -> SceneError:
    """Return an error that names file, line and key of a scene.

    Args:
        file: Path of the scene; the name alone of what is no file.
        key: Dotted path of the key.
        problem: Fault and remedy.
        value: Value that was read, by default that in the file.
    """
    return SceneError(f"{place_of(file, key, value)}: `{key}`: {problem}")


def problem_of(error: Exception) -> str:
    """Return the message of an error without the class or function at its head.

    Args:
        error: Error of a check, such as "Disc: `mass` is -1 kg; it must be above 0 kg."
    """
    head, colon, problem = str(error).partition(": ")
    named = colon and head.replace(".", "_").isidentifier()
    return (problem if named else str(error)).removesuffix(".")


@contextlib.contextmanager
def scene_errors(name: str) -> Iterator[None]:
    """Context that turns errors of arguments into those of a scene.

    Args:
        name: Name of the scene, or what else the message begins with.
    """
    try:
        yield
    except SceneError:
        raise
    except ValueError as error:
        raise SceneError(f"{name}: {problem_of(error)}") from error


def place_of(file: str | Path, key: str, value: Any = _UNKNOWN) -> str:
    """Return file name and line of a key, such as "spindle.toml:14".

    The line of a key that is missing is that of its table. There is none for a value
    that is not in the file, from `--set` or a list of cases.

    Args:
        file: Path of the scene; the name alone of what is no file.
        key: Dotted path of the key.
        value: Value that was read, by default that in the file.
    """
    if not isinstance(file, Path):
        return file
    try:
        text = read_text(file)
        there = dict(_keys(tomllib.loads(text)))
    except (OSError, ValueError, RecursionError):  # no file, or not of TOML
        return file.name
    if key not in there:
        above = [table for table in there if key.startswith((f"{table}.", f"{table}["))]
        missing = value is _UNKNOWN or value is ABSENT
        key = max(above, key=len, default="") if missing else ""
    elif not (value is _UNKNOWN or value == there[key]):
        key = ""
    return f"{file.name}:{line_of_key(text, key)}" if key else file.name


def line_of_key(text: str, key: str) -> int:
    """Return the line in which a key first appears, from 1.

    It is the last line of the shortest beginning of the text that has the key.

    Args:
        text: Text of a TOML file.
        key: Dotted path of a key that it has; entries of lists as "discs[0].mass".
    """
    lines = text.split("\n")

    def has_key(count: int) -> bool:
        found = None
        while found is None:  # within a text of several lines: what stands above it
            found, count = _parse(lines[:count]), count - 1
        return key in dict(_keys(found))

    line = bisect.bisect_left(range(len(lines)), True, key=has_key)
    while _parse(lines[: line - 1]) is None:  # a text of several lines ends here
        line -= 1
    return line


def _parse(lines: list[str]) -> dict[str, Any] | None:
    """Return the data of the first lines of a file; `None` if they end in a text."""
    for closing in _CLOSINGS:
        try:
            return tomllib.loads("\n".join([*lines, closing]))
        except ValueError:
            continue
    return None


def _keys(data: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the dotted paths of all keys with their values."""
    if isinstance(data, list):
        for k, entry in enumerate(data):
            if isinstance(entry, Mapping):
                yield f"{path}[{k}]", entry
                yield from _keys(entry, f"{path}[{k}]")
    elif isinstance(data, Mapping):
        for key, value in data.items():
            inner = join_key(path, key)
            yield inner, value
            yield from _keys(value, inner)

"""Scene files: search paths, TOML parsing, and settings that change them."""

import copy
import functools
import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from datetime import date, time
from importlib.resources import files
from pathlib import Path
from typing import Any

import jax

from .quantity import SceneError
from .scene_errors import ABSENT
from .table import as_written
from .text_file import read_text


def shipped_scenes() -> dict[str, Path]:
    """Return the scenes shipped with the package, by name."""
    folder = Path(str(files("bearingjax.files") / "examples"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def need_float64() -> None:
    """Raise SceneError if float64 is off."""
    if not jax.config.jax_enable_x64:  # type: ignore[attr-defined]
        raise SceneError(
            "scenes are solved in float64, which is off: call"
            ' jax.config.update("jax_enable_x64", True) before anything else'
        )


def is_scene(source: str | Path) -> bool:
    """Whether a name denotes a scene: a file, or a shipped scene."""
    path = Path(source)
    return path.suffix == ".toml" or path.is_file() or str(source) in shipped_scenes()


def find_scene(source: str | Path) -> Path:
    """Return the path of a scene file or of a shipped scene.

    Raises:
        SceneError: If there is none, or float64 is off.
    """
    need_float64()
    path = Path(source)
    if path.suffix != ".toml" and not path.is_file():
        shipped = shipped_scenes()
        if str(source) in shipped:
            return shipped[str(source)]
        problem = f"neither a .toml file nor a shipped scene ({', '.join(shipped)})"
        if any(letter.isdigit() for letter in str(source)):
            problem += (
                f"; if it is a designation, `bearingjax new {source} > my.toml` writes"
                " the scene of this bearing"
            )
        raise SceneError(f"{source}: {problem}")
    if not path.is_file():
        problem = "is a pipe or a device; name a file"
        if path.is_dir() or not path.exists():
            problem = "is a folder; name a file" if path.is_dir() else "no such file"
        raise SceneError(f"{source}: {problem}")
    return path


def is_rotor(data: dict[str, Any]) -> bool:
    """Whether parsed data describe a rotor, not a bearing."""
    return "bearing" not in data and "rotor" in data


def is_shafts(data: dict[str, Any]) -> bool:
    """Whether parsed data describe a system of shafts, not a bearing."""
    return "bearing" not in data and "shaft" in data


def parse_bearing(path: Path, settings: Iterable[str]) -> dict[str, Any]:
    """Parse the scene of a bearing; see `parse_scene`.

    Raises:
        SceneError: As `parse_scene`; if it is the scene of one contact or of a rotor.
    """
    data = parse_scene(path, settings)
    contact = "bearing" not in data and not {"roller", "raceway"}.isdisjoint(data)
    for is_it, command, what in (
        (contact, "contact", "one contact, a [roller] on a [raceway]"),
        (is_rotor(data), "rotor", "a [rotor]"),
        (is_shafts(data), "shaft", "a system of shafts"),
    ):
        if is_it:
            problem = f"is the scene of {what}, not of a [bearing]"
            cure = f"`bearingjax {command} {path.stem}` solves it"
            raise SceneError(f"{path.name}: {problem}; {cure}")
    return data


def has_cases(source: str | Path, settings: Iterable[str] = ()) -> bool:
    """Whether the scene of a bearing has [cases].

    Args: as `read_scene`.

    Raises:
        SceneError: If it cannot be read.
    """
    return "cases" in parse_bearing(find_scene(source), settings)


def bearing_files(data: Mapping[str, Any], path: Path) -> list[Path]:
    """Return the other scenes from which a rotor takes its bearings.

    Args:
        data: The scene as parsed; errors in it are ignored.
        path: Path of the scene.
    """
    own, rotor = data.get("bearings"), data.get("rotor")
    listed = rotor.get("bearings") if isinstance(rotor, Mapping) else None
    mounts = listed if isinstance(listed, list) else []
    given = [one.get("bearing") for one in mounts if isinstance(one, Mapping)]
    names = {name for name in given if isinstance(name, str)}
    here = own if isinstance(own, Mapping) else {}
    return [bearing_place(name, path) for name in sorted(names - set(here))]


def profile_files(data: Mapping[str, Any], path: Path) -> list[Path]:
    """Return the files of form errors, and of a measurement, that a scene names; see
    `bearing_files`."""
    tables = (data.get("deviations"), "profile"), (data.get("vibration"), "measured")
    found = [one.get(key) for one, key in tables if isinstance(one, Mapping)]
    entries = [x for one in found for x in (one if isinstance(one, list) else [one])]
    names = [one.get("file") for one in entries if isinstance(one, Mapping)]
    return [path.parent / name for name in names if isinstance(name, str)]


def bearing_place(name: str, path: Path) -> Path:
    """Return the path of a scene named in another: a shipped one, or in its folder."""
    return shipped_scenes().get(name, path.parent / name)


def parse_scene(path: Path, settings: Iterable[str]) -> dict[str, Any]:
    """Parse a scene file and apply settings to it.

    Args:
        path: Path of the file.
        settings: As in `read_scene`.

    Raises:
        SceneError: If it is not TOML, or a setting cannot be applied.
    """
    data = _parse(path)
    for setting in settings:
        _set(data, setting, path.name)
    return data


def _parse(path):
    kind = "JSON" if path.suffix.lower() == ".json" else "TOML"
    try:
        text = read_text(path)
    except ValueError as error:
        raise SceneError(f"{path.name}: {error}") from error
    try:
        return _echo_of(path, text) if kind == "JSON" else copy.deepcopy(_toml(text))
    except SceneError:
        raise
    except (ValueError, RecursionError) as error:
        # Syntax errors, and numbers too long to convert, are ValueErrors.
        raise SceneError(f"{path.name}: cannot be read as {kind}: {error}") from error


_toml = functools.lru_cache(maxsize=8)(tomllib.loads)
"""A command reads its scene again for each question; parsed once, given as copies."""


def _echo_of(path: Path, text: str) -> dict[str, Any]:
    """Return the scene of an output file of `--json`."""
    data = json.loads(text)
    inputs = data.get("inputs") if isinstance(data, dict) else None
    if not isinstance(inputs, dict):
        problem = "`inputs` is missing; it must be a table, as `--json` writes it"
        raise SceneError(f"{path.name}: {problem}")
    return inputs


def _set(data: dict, setting: str, file: str) -> None:
    key, equals, text = setting.partition("=")
    parts = [part.strip() for part in key.split(".")]
    if not equals or not all(re.fullmatch(r"[A-Za-z0-9_-]+", p) for p in parts):
        raise SceneError(
            f"{file}: {setting!r} is not a setting; write key=value, such as"
            ' "operating.load.Fy=-4 kN"; a key in quotes stands in its table,'
            """ "cases={ grid = { 'bearing.n_balls' = [7, 8] } }\""""
        )
    try:
        parsed = tomllib.loads(f"value = {text}")
    except ValueError:
        parsed = {}
    # Further lines would be lost: the value is text then, and so are dates.
    value = parsed["value"] if len(parsed) == 1 else text.strip()
    value = text.strip() if isinstance(value, date | time) else value
    value = as_written(value, text.partition("#")[0].strip())
    value = ABSENT if text.strip() == "unset" else value
    assign(data, ".".join(parts), value, file)


def assign(data: dict[str, Any], key: str, value: Any, file: str) -> None:
    """Set a dotted key in parsed data.

    Args:
        data: Parsed data, changed in place.
        key: Dotted key; numbers from 0 denote list entries.
        value: Value as parsed; `ABSENT` takes the key away.
        file: File name, for the message.

    Raises:
        SceneError: If the key passes through a value that is not a table, or one that
            is taken away is not there.
    """
    parts: list[Any] = key.split(".")
    inner: Any = data
    for depth, part in enumerate(parts[:-1]):
        if isinstance(inner, list):
            inner = _list_entry(inner, part, ".".join(parts[:depth]), file)
        else:
            inner = inner.setdefault(part, {})
        if not isinstance(inner, dict | list):
            place = ".".join(parts[: depth + 1])
            raise SceneError(f"{file}: `{place}` is not a table, so {key!r} fails")
    if isinstance(inner, list):
        _list_entry(inner, parts[-1], ".".join(parts[:-1]), file)
        parts[-1] = int(parts[-1])
    elif value is ABSENT and parts[-1] not in inner:
        raise SceneError(
            f"{file}: `{key}` is not there, so `{key}=unset` takes nothing away"
        )
    inner[parts[-1]] = value
    if value is ABSENT:
        del inner[parts[-1]]


def _list_entry(values: list[Any], part: str, key: str, file: str) -> Any:
    """Return the list entry with the given index."""
    if not part.isdecimal() or int(part) >= len(values):
        allowed = f"a number from 0 to {len(values) - 1} names one of its entries"
        raise SceneError(f"{file}: `{key}` is a list; {allowed}, {part!r} does not")
    return values[int(part)]

"""Strict reading of nested tables: an unread key is an error."""

import contextlib
import dataclasses
import difflib
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..numerics.units import unit_of
from .quantity import QUANTITIES, SceneError, article_of, to_si
from .scene_errors import ABSENT, error_at, join_key, place_of, problem_of

_MISSING: Any = object()
_ABOUT = re.compile(
    r"`(?P<name>[^`]+)` (?:of (?P<part>\S+) )?(?P<fault>(?:is|has) .*)", re.DOTALL
)
"""Message of a check: "`bore` of A is 1 m; it must be ..."."""
LARGEST_NUMBER = 1e9
"""Largest bare number allowed in a scene."""


class _Typed:
    """A number given by a setting or in a CSV, which keys of text take as text.

    Attributes:
        text: The number as written.
        plain: Class of the number.
    """

    text = ""
    plain: type

    def __repr__(self):
        return self.text


class _TypedInt(_Typed, int):
    plain = int


class _TypedFloat(_Typed, float):
    plain = float


def as_written(value: Any, text: str) -> Any:
    """Return a number that remembers how it was written, and other values unchanged.

    Args:
        value: Value as parsed.
        text: What it was parsed from.
    """
    kind = {int: _TypedInt, float: _TypedFloat}.get(type(value))
    if kind is None:
        return value
    number = kind(value)
    number.text = text
    return number


def text_of(value: Any) -> Any:
    """Return the text of a typed number, and other values unchanged."""
    return value.text if isinstance(value, _Typed) else value


class Table:
    """One table of a scene file that records which of its keys were read.

    Args:
        data: The table as parsed.
        file: Path of the file, for messages; the name alone of what is no file.
        path: Dotted path of the table in the file; empty at the top.
        places: Dotted paths of keys that stand elsewhere in the file, by their name
            here: the `bearing` of a machine is its `bearings.NAME`.
    """

    def __init__(
        self,
        data: Mapping[str, Any],
        file: str | Path,
        path: str = "",
        places: Mapping[str, str] | None = None,
    ):
        self._data = data
        self._file = file
        self._path = path
        self._places = dict(places or {})
        self._asked: list[str] = []
        # Known keys, read or only looked for.
        self._known: list[str] = []
        self._children: list[Table] = []
        # Values read, defaults included, for `echo`.
        self._read: dict[str, Any] = {}
        self._stand_in: Table | None = None

    def __contains__(self, key: str) -> bool:
        self._known.append(key)
        return key in self._data

    def keys(self) -> tuple[str, ...]:
        """Return all keys of the table, for tables whose keys are names; each must
        still be read."""
        return tuple(self._data)

    def know(self, *keys: str) -> None:
        """Name keys in messages that are read elsewhere."""
        self._known.extend(keys)

    def path_of(self, key: str) -> str:
        """Return the dotted path of a key in the file, for messages."""
        if key in self._places:
            return self._places[key]
        return join_key(self._path, key)

    def error(self, key: str, problem: object) -> SceneError:
        """Return an error that names file, line and key."""
        value = self._data.get(key, ABSENT)
        return error_at(self._file, self.path_of(key), problem, value)

    def own_error(self, problem: object) -> SceneError:
        """Return an error that names file, line and table."""
        return error_at(self._file, self._path, problem)

    def quantity(self, key: str, kind: str, default: Any = _MISSING) -> Any:
        """Read a quantity with a unit as a number in SI.

        Args:
            key: Key in this table.
            kind: Kind of quantity, see `quantity.QUANTITIES`; empty: a bare number.
            default: Value if absent; without a default the key is required.
        """
        if not kind:
            return self.number(key, default)
        value: Any = self._get(
            key, default, f"{article_of(kind)} {kind}, a text with its unit"
        )
        if key in self._data:
            try:
                value = to_si(value, kind)
            except SceneError as error:
                raise self.error(key, error) from error
        if value is not None:
            self.fill(key, format_number(value, QUANTITIES[kind][0]))
        return value

    def quantities(self, key: str, kind: str) -> list[float]:
        """Read a list of quantities, each with a unit, as numbers in SI."""
        values = self._get(key, _MISSING, f"a list of quantities ({kind})")
        if not isinstance(values, list):
            raise self.error(key, f"{values!r} is not a list of quantities ({kind})")
        try:
            found = [to_si(value, kind) for value in values]
        except SceneError as error:
            raise self.error(key, error) from error
        self.fill(key, [format_number(value, QUANTITIES[kind][0]) for value in found])
        return found

    def number(self, key: str, default: Any = _MISSING) -> Any:
        """Read a bare dimensionless number."""
        value = self._get(key, default, "a bare number")
        if key not in self._data:
            return value
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(key, f"{value!r} is not a bare number (no unit, no text)")
        if value != value:
            raise self.error(key, "nan is not a finite number")
        if abs(value) > LARGEST_NUMBER:
            raise self.error(
                key, f"is out of range; at most {LARGEST_NUMBER:g} in size"
            )
        self.fill(key, float(value))
        return float(value)

    def integer(self, key: str, default: Any = _MISSING, least: int = 1) -> Any:
        """Read a whole number of at least `least`."""
        value = self._get(key, default, "a whole number")
        if key not in self._data:
            return value
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            allowed = f"a whole number of at least {least}"
            raise self.error(key, f"{value!r} is not {allowed}")
        if value > LARGEST_NUMBER:
            raise self.error(key, f"is out of range; at most {LARGEST_NUMBER:g}")
        return value

    def choice(
        self,
        key: str,
        choices: Sequence[str],
        default: Any = _MISSING,
        words: str = "",
    ) -> Any:
        """Read one of several words.

        Args:
            key: Key in this table.
            choices: Allowed words.
            default: Value if absent; without a default the key is required.
            words: The choices as described in errors, where they are too many to list.
        """
        value = self._get(key, default, f"one of {words or join_names(choices)}")
        if self.text(key) in choices:
            self.fill(key, value := self.text(key))
        if key in self._data and value not in choices:
            raise self.error(key, not_among(value, choices, words))
        return value

    def word(self, key: str) -> str | None:
        """Return the text at a key, or `None` if it is not text."""
        self._known.append(key)
        value = self._data.get(key)
        return value if isinstance(value, str) else None

    def text(self, key: str) -> str | None:
        """Return the text at a key, or that of a typed number; else `None`."""
        value = text_of(self._data.get(key))
        return value if isinstance(value, str) else None

    def raw(self, key: str, default: Any = _MISSING) -> Any:
        """Read the value of a key, as parsed."""
        return self._get(key, default, "given")

    def skip(self, *keys: str) -> None:
        """Ignore keys that are read elsewhere."""
        self._asked += keys
        self._known += keys

    def words(self, key: str, choices: Sequence[str]) -> tuple[str, ...] | None:
        """Read a list of distinct words; `None` if absent."""
        value = self._get(key, None, "")
        if value is None:
            return None
        if not isinstance(value, list):
            problem = f"{value!r} is not a list of words out of {join_names(choices)}"
            raise self.error(key, problem)
        for word in value:
            if word not in choices:
                raise self.error(key, not_among(word, choices))
        if len(set(value)) < len(value):
            raise self.error(key, f"{value!r} names something twice")
        return tuple(value)

    def table(self, key: str, required: bool = False, hint: str = "") -> "Table":
        """Read a sub-table; empty if absent and not required.

        Args:
            key: Key in this table.
            required: Whether the key is required.
            hint: Addition to the error about another type of value.
        """
        value = self._get(key, _MISSING if required else {}, "a table")
        if not isinstance(value, Mapping):
            problem = f"{value!r} is not a table"
            raise self.error(key, f"{problem}; {hint}" if hint else problem)
        known = self._read.get(key)
        if isinstance(known, Table):  # asked for before
            return known
        child = Table(value, self._file, self.path_of(key))
        self._children.append(child)
        self._read[key] = child
        return child

    def keys_given(self) -> dict[str, Any]:
        """Return the table as parsed; no key is marked as read."""
        return dict(self._data)

    def with_values(self, values: Mapping[str, Any]) -> "Table":
        """Return a table with other values that replaces this one for their keys."""
        self._asked += values
        child = Table(values, self._file, self._path)
        child._known = self._known
        self._children.append(child)
        self._stand_in = child
        return child

    def empty(self, key: str) -> "Table":
        """Return an empty sub-table, for a key given by a word."""
        return Table({}, self._file, self.path_of(key))

    def tables(self, key: str) -> "list[Table]":
        """Read a list of sub-tables, at least one."""
        values = self._get(key, _MISSING, "a list of tables")
        if not isinstance(values, list) or not values:
            raise self.error(key, f"{values!r} is not a list of tables")
        children = []
        for k, value in enumerate(values):
            if not isinstance(value, Mapping):
                raise self.error(key, f"{value!r} is not a table")
            children.append(Table(value, self._file, f"{self.path_of(key)}[{k}]"))
        self._children += children
        self._read[key] = children
        return children

    def flag(self, key: str, default: Any = _MISSING) -> Any:
        """Read true or false."""
        value = self._get(key, default, "true or false")
        if not isinstance(value, bool):
            raise self.error(key, f"{value!r} is not true or false")
        return value

    def table_or_word(self, key: str, choices: Sequence[str]) -> "Table | str | None":
        """Read a sub-table or one of several words; `None` if absent."""
        if self.word(key) is not None:
            return self.choice(key, choices)
        if key in self and not isinstance(self._data[key], Mapping):
            names = join_names(choices)
            problem = f"{self._data[key]!r} is not a table, nor one of {names}"
            raise self.error(key, problem)
        return self.table(key) if key in self else None

    def fill(self, key: str, value: Any) -> None:
        """Set the value of a key in `echo`, such as a computed default.

        Args:
            key: Key in this table.
            value: In the form of a scene file; `None`: no entry.
        """
        (self._stand_in or self)._read[key] = value

    def echo(self) -> dict[str, Any]:
        """Return all values read here and below, as written in a scene: quantities in
        SI with their unit, defaults filled in, without skipped keys."""

        def to_plain(value):
            if isinstance(value, Table):
                return value.echo()
            if isinstance(value, Mapping):
                return {key: to_plain(inner) for key, inner in value.items()}
            return (
                [to_plain(one) for one in value] if isinstance(value, list) else value
            )

        found = {key: to_plain(value) for key, value in self._read.items()}
        if self._stand_in is not None:
            found |= self._stand_in.echo()
        return {k: value for k, value in found.items() if value not in (None, {})}

    @contextlib.contextmanager
    def building(self, *beside: "Table", **keys: str) -> Iterator[None]:
        """Context that turns the error of a constructor into one of the key that it is
        about, or of this table.

        Args:
            *beside: Other tables whose keys may be at fault.
            **keys: Keys by the name of the argument, where they differ.
        """
        try:
            yield
        except SceneError:
            raise
        except (ValueError, TypeError) as error:
            problem, table = problem_of(error), self
            about = _ABOUT.fullmatch(problem)
            if about is not None:
                key = keys.get(about["name"], about["name"])
                for table in (*beside, self):
                    owners = table._owners(key, about["part"] or "")
                    if len(owners) == 1:
                        raise owners[0].error(key, about["fault"]) from error
                    if owners:
                        break
            where = f"[{table._path}]: " if table._path else ""
            place = place_of(self._file, table._path or self._part_in(problem))
            raise SceneError(f"{place}: {where}{problem}") from error

    def _part_in(self, problem: str) -> str:
        """Return the path of the table [KIND.NAME] that an error names first, or ""."""
        parts = [part for kind in self._children for part in kind._children]
        names = {part._path.rpartition(".")[2]: part._path for part in parts}
        words = re.findall(r"[^\s`'\",;:.]+", problem.replace("'s ", " "))
        return next((names[word] for word in words if word in names), "")

    def _owners(self, key: str, part: str) -> "list[Table]":
        """Return this table if it has a key, or else those below that have it.

        Args:
            key: The key.
            part: End of the path of the table; empty: any.
        """
        if key in self._data and f".{self._path}".endswith(f".{part}" if part else ""):
            return [self]
        below = (child._owners(key, part) for child in self._children)
        return [table for tables in below for table in tables]

    def finish(self) -> None:
        """Raise SceneError for unread keys, here and below."""
        for key in self._data:
            if key not in self._asked:
                known = ", ".join(sorted(set(self._known)))
                hint = _suggest(key, self._known)
                where = f"in [{self._path}]" if self._path else "at the top level"
                raise self.error(key, f"unknown key{hint}; known {where}: {known}")
        for child in self._children:
            child.finish()

    def _get(self, key, default, wanted):
        self._asked.append(key)
        self._known.append(key)
        if key in self._data:
            value = self._data[key]
            value = value.plain(value) if isinstance(value, _Typed) else value
            self._read.setdefault(key, value)
            return value
        if default is not _MISSING and isinstance(default, bool | int | float | str):
            self._read.setdefault(key, default)
        if default is _MISSING:
            # A misspelt key is more likely than a missing one.
            strange = [k for k in self._data if k not in self._asked]
            close = difflib.get_close_matches(key, strange, 1, 0.7)
            close = close or [k for k in strange if k in key]
            hint = f" (`{close[0]}` is there instead)" if close else ""
            raise self.error(key, f"is missing{hint}; it must be {wanted}")
        return default


def format_number(value: float, unit: str) -> str | float:
    """Format a number in SI as in a scene file, to the last digit.

    Args:
        value: Number in SI.
        unit: SI unit, empty for a bare number.
    """
    return f"{float(value)!r} {unit}" if unit else float(value)


def written_numbers(owner: Any) -> dict[str, str | float]:
    """Return the numbers of a module by field name, as written in a scene.

    Args:
        owner: Concrete module whose fields with units are numbers.
    """
    return {
        field.name: format_number(
            float(getattr(owner, field.name)), unit_of(owner, field.name)
        )
        for field in dataclasses.fields(owner)
        if "unit" in field.metadata
    }


def not_among(value: object, choices: Sequence[str], words: str = "") -> str:
    """Return the error text for a word that is not one of several.

    Args:
        value: Value given.
        choices: Allowed words.
        words: Description of the choices, if not listed one by one.
    """
    hint = _suggest(value, choices) if isinstance(value, str) else ""
    allowed = words or join_names(choices)
    return f"{value!r} is not known{hint}; it must be one of {allowed}"


def join_names(names: Sequence[str]) -> str:
    """Join names with commas, in quotes if one of them contains a comma."""
    apart = any("," in name for name in names)
    return ", ".join(f'"{name}"' if apart else name for name in names)


def _suggest(word, known):
    by_lower = {name.lower(): name for name in known}
    close = difflib.get_close_matches(word.lower(), by_lower, 1, 0.6)
    return f" (did you mean `{by_lower[close[0]]}`?)" if close else ""

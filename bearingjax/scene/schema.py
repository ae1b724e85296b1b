"""Schema of scene files: a class describes a table, each of its fields one key.

The fields of a `Keys` class read the table, make its JSON Schema and its part of the
scene guide (`schema_text`). Rules that concern several keys are the `check` of the
class.
"""

import dataclasses
import functools
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple, TypeVar, get_args, get_origin

from ..numerics.units import CELSIUS
from .quantity import KINDS, to_si
from .table import Table, written

_REQUIRED: Any = dataclasses.MISSING


@dataclasses.dataclass(frozen=True)
class Key:
    """What a key of a scene may hold, beside the type of its field.

    Attributes:
        about: One line for the scene guide, without a full stop.
        kind: Kind of quantity (`quantity.KINDS`); empty for a pure number.
        above, least, below, most: Range, in `unit`.
        shown: Unit of the range, in which an error tells the number; empty: SI, of
            temperatures °C.
        choices: Words that may stand there.
        words: The choices as an error tells them, where they are too many to list.
        of: Classes that may stand there, by the word or the `type` that names them.
        hint: What an error about the range, missing `needs`, or what is no table, adds.
        refusal: What an error about the range says, in place of "is not allowed; ...".
        needs: Keys of which one must stand beside this one.
        without: Keys that must not stand beside this one, with what an error says;
            empty for "give either ... or this, not both".
        only: Words of other keys for which this one is of use.
        name: Key in the file, if a field cannot be called so.
        otherwise: What is taken where the default depends on something else.
        follows: Works that out from the values of the other keys of the table.
        reader: Reads what fits no type, from the table and the name of the key.
        json: JSON Schema of what `reader` reads.
    """

    about: str
    kind: str = ""
    _: dataclasses.KW_ONLY
    above: int | float | None = None
    least: int | float | None = None
    below: int | float | None = None
    most: int | float | None = None
    shown: str = ""
    choices: Sequence[str] = ()
    words: str = ""
    of: Mapping[str, type] = dataclasses.field(default_factory=dict)
    hint: str = ""
    refusal: str = ""
    needs: Sequence[str] = ()
    without: Mapping[str, str] = dataclasses.field(default_factory=dict)
    only: Mapping[str, Sequence[str]] = dataclasses.field(default_factory=dict)
    name: str = ""
    otherwise: str = ""
    follows: Callable[[Mapping[str, Any]], Any] | None = None
    reader: Callable[[Table, str], Any] | None = None
    json: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def unit(self) -> str:
        """Unit of the range; empty of a pure number."""
        unit = KINDS[self.kind][0] if self.kind else ""
        return self.shown or ("°C" if unit == "K" else unit)

    def told(self, value: float) -> float:
        """A number in the unit of the range.

        Args:
            value: In SI.
        """
        if self.unit == "°C":
            return value - CELSIUS
        return value / to_si(f"1 {self.shown}", self.kind) if self.shown else value

    @property
    def allowed(self) -> str:
        """Range in words, as "above 0 N"; empty without one."""
        low, high = ("least", self.least), ("most", self.most)
        if self.above is not None:
            low = ("above", self.above)
        if self.below is not None:
            high = ("below", self.below)
        unit = f" {self.unit}" if self.unit else ""
        ends = {name: f"{value:g}" for name, value in (low, high) if value is not None}
        first, last = ends.get("least"), ends.get("most")
        if first and last:
            return f"from {first} to {last}{unit}"
        if first and "below" in ends:
            return f"from {first} to below {ends['below']}{unit}"
        words = {"least": "at least", "most": "at most"}
        told = [f"{words.get(name, name)} {value}" for name, value in ends.items()]
        return " and ".join(told) + (unit if told else "")

    @property
    def goes_with(self) -> str:
        """What must stand beside it, in words; empty if nothing."""
        needs = " or ".join(f"`{other}`" for other in self.needs)
        words = (f"`{other}` = {' or '.join(ws)}" for other, ws in self.only.items())
        return " and ".join(filter(None, (needs, *words)))

    def holds(self, value: float) -> bool:
        """Whether a number is in the range.

        Args:
            value: In `unit`.
        """
        return not (
            (self.above is not None and not value > self.above)
            or (self.least is not None and not value >= self.least)
            or (self.below is not None and not value < self.below)
            or (self.most is not None and not value <= self.most)
        )


def scene_key(
    about: str, kind: str = "", *, default: Any = _REQUIRED, **rest: Any
) -> Any:
    """Field of a `Keys` class.

    Args:
        about, kind: As in `Key`.
        default: If the key is absent; without a default it is required, unless the
            field may be `None`. The class of a table: what it reads without keys.
        **rest: Other attributes of `Key`.
    """
    metadata = {"key": Key(about, kind, **rest)}
    return dataclasses.field(default=default, metadata=metadata)


class Field(NamedTuple):
    """One key of a table.

    Attributes:
        name: In the file.
        attribute: In the class.
        key: What it may hold.
        kinds: Types that it may have, without `None`.
        default: If absent, or `dataclasses.MISSING`.
    """

    name: str
    attribute: str
    key: Key
    kinds: tuple[Any, ...]
    default: Any

    @property
    def required(self) -> bool:
        """Whether it must be given."""
        return self.default is _REQUIRED


@dataclasses.dataclass(frozen=True, kw_only=True)
class Keys:
    """Base of the classes that describe tables.

    Attributes:
        table: The table that was read, for errors and the echo.
    """

    numbers: ClassVar[Mapping[str, type]] = {}
    """Classes whose numbers may stand in the table under their own names, by the key
    with which they do; read by `built`."""

    table: Table = dataclasses.field(repr=False, compare=False)

    @property
    def given(self) -> dict[str, Any]:
        """Values of the keys that have one, by the name of the field."""
        values = {
            f.attribute: getattr(self, f.attribute) for f in fields_of(type(self))
        }
        return {name: value for name, value in values.items() if value is not None}

    def built(self, kind: type[Any]) -> Any:
        """An instance of a class whose numbers stand in the table.

        Args:
            kind: One of `numbers`.
        """
        values = self.table.fields(kind)
        with self.table.building():
            return kind(**values)

    def check(self) -> None:
        """Raise SceneError where keys do not go together; nothing by default."""

    def fill(self, **values: int | float | str | None) -> None:
        """Say what stands for keys in the echo, such as defaults that follow from
        something else.

        Args:
            **values: By the name of the field; numbers in SI.
        """
        for one in fields_of(type(self)):
            if one.attribute in values:
                value = values[one.attribute]
                unit = KINDS[one.key.kind][0] if one.key.kind else ""
                if isinstance(value, float):
                    value = written(value, unit)
                self.table.fill(one.name, value)

    def with_defaults(self, **values: int | float | str) -> Any:
        """These keys with defaults that follow from something else, in the echo too.

        Args:
            **values: By the name of the field, for those that are `None`; in SI.
        """
        absent = {k: v for k, v in values.items() if getattr(self, k) is None}
        self.fill(**absent)
        return dataclasses.replace(self, **absent)


K = TypeVar("K", bound=Keys)


def read_keys(kind: type[K], table: Table) -> K:
    """The keys of a table.

    Args:
        kind: Class that describes the table.
        table: The table.

    Raises:
        SceneError: For what is missing, of another kind, out of its range, or does not
            go together.
    """
    known = fields_of(kind)
    values = {one.attribute: _value(table, one) for one in known}
    for one in known:
        _check_neighbours(table, one)
    later = {
        one.attribute: one.key.follows(values)
        for one in known
        if one.key.follows is not None and values[one.attribute] is None
    }
    found = kind(table=table, **values | later)
    found.fill(**later)
    for one in known:
        _check_use(found, one)
    found.check()
    return found


@functools.cache
def fields_of(kind: type[Keys]) -> tuple[Field, ...]:
    """The keys of a table, in order.

    Args:
        kind: Class of the table.
    """
    hints = typing.get_type_hints(kind)
    found = []
    for field in dataclasses.fields(kind):
        if "key" not in field.metadata:
            continue
        one: Key = field.metadata["key"]
        united, default = _united(hints[field.name]), field.default
        kinds = tuple(kind for kind in united if kind is not types.NoneType)
        if default is _REQUIRED and len(kinds) < len(united):
            default = None
        found.append(Field(one.name or field.name, field.name, one, kinds, default))
    return tuple(found)


def _united(hint: Any) -> tuple[Any, ...]:
    """Types of a union, or the one type."""
    union = get_origin(hint) in (types.UnionType, typing.Union)
    return get_args(hint) if union else (hint,)


def element_of(kind: Any) -> Any:
    """Type of the entries of `tuple[X, ...]`; `None` of any other type."""
    return next(iter(get_args(kind)), None) if get_origin(kind) is tuple else None


def is_keys(kind: Any) -> bool:
    """Whether a type describes a table."""
    return isinstance(kind, type) and issubclass(kind, Keys)


def _value(table: Table, field: Field) -> Any:
    """What stands at a key, in SI, within its range."""
    name, one, kind = field.name, field.key, field.kinds[0]
    default = () if field.required else (field.default,)
    absent = name not in table and not field.required
    if one.reader is not None:
        return one.reader(table, name)
    if one.of:
        return instance(table, name, one.of, *default)
    inner = element_of(kind)
    if is_keys(kind):
        if absent and field.default is not kind:
            return field.default
        inside = table.table(name, required=field.required, hint=one.hint)
        return read_keys(kind, inside)
    if is_keys(inner):
        if absent:
            return field.default
        return tuple(read_keys(inner, part) for part in table.tables(name))
    if inner is str:
        return _texts(table, name, one)
    if kind is str and not one.choices:
        return _text(table, name, *default)
    word = table.word(name) if str in field.kinds else None
    # Text where a pure number may stand is a word, and maybe misspelt.
    if kind is str or (word is not None and (word in one.choices or not one.kind)):
        return table.choice(name, tuple(one.choices), *default, words=one.words)
    if kind is bool:
        return None if absent and default == (None,) else table.flag(name, *default)
    if kind is int:
        return _count(table, name, one, *default)
    lists = inner is float, any(element_of(k) is float for k in field.kinds[1:])
    if lists[0] or (lists[1] and isinstance(table.raw(name, None), list)):
        if absent:
            return field.default
        return _in_range(table, name, tuple(table.quantities(name, one.kind)), one)
    if one.kind:
        return _in_range(table, name, table.quantity(name, one.kind, *default), one)
    return _in_range(table, name, table.number(name, *default), one)


def _text(table: Table, name: str, *default: Any) -> Any:
    """Any text."""
    value = table.raw(name, *default)
    if name in table and not isinstance(value, str):
        raise table.error(name, f"{value!r} is not a text")
    return value


def _texts(table: Table, name: str, one: Key) -> tuple[str, ...] | None:
    """Distinct words out of several, or any texts where none are listed."""
    if one.choices:
        return table.words(name, one.choices)
    value = table.raw(name, None)
    if value is None:
        return None
    if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
        raise table.error(name, f"{value!r} is not a list of names")
    return tuple(value)


def _count(table: Table, name: str, one: Key, *default: Any) -> Any:
    """A whole number in the range of a key."""
    least = 1 if one.least is None else int(one.least)
    value = table.integer(name, *default, least=least)
    if name in table and one.most is not None and value > one.most:
        problem = one.refusal or f"is too many; at most {one.most:g}"
        raise table.error(name, f"{value} {problem}")
    return value


def _in_range(table: Table, name: str, value: Any, one: Key) -> Any:
    """The number, or numbers, if they are in the range of a key that stands there."""
    if name not in table or value is None:
        return value
    for number in map(one.told, value if isinstance(value, tuple) else (value,)):
        if not one.holds(number):
            unit = f" {one.unit}" if one.unit else ""
            hint = f" ({one.hint})" if one.hint else ""
            problem = one.refusal or f"is not allowed; {one.allowed}{hint}"
            raise table.error(name, f"{number:.6g}{unit} {problem}")
    return value


def instance(table: Table, name: str, kinds: Mapping[str, type], *default: Any) -> Any:
    """An instance of one of several classes: named by a word, or with its numbers.

    Args:
        table: In which it stands.
        name: Its key.
        kinds: The classes, by their word; a table names one by its `type`, which may be
            left out where there is only one.
        default: If absent, an instance or its word; without a default the key is
            required.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    given = table.table_or_word(name, tuple(kinds))
    if given is None and default and isinstance(default[0], str):
        given = default[0]
        table.fill(name, given)
    if given is None:
        if not default:
            raise table.error(name, f"is missing; it must be one of {', '.join(kinds)}")
        return default[0]
    if isinstance(given, str):
        kind, own = kinds[given], table.empty(name)
    else:
        word = (
            given.choice("type", tuple(kinds)) if len(kinds) > 1 else next(iter(kinds))
        )
        kind, own = kinds[word], given
    values = own.fields(kind)
    with own.building():
        return kind(**values)


def _check_neighbours(table: Table, field: Field) -> None:
    """Raise SceneError for keys that must, or must not, stand beside one that does;
    the default of one that needs others is not echoed without them."""
    needs = field.key.needs
    alone = bool(needs) and not any(other in table for other in needs)
    if field.name not in table:
        if alone:
            table.fill(field.name, None)
        return
    for other, problem in field.key.without.items():
        if other in table:
            text = problem or f"give either `{other}` or this, not both"
            raise table.error(field.name, text)
    if alone:
        missing = ", which is missing" if len(needs) == 1 else ""
        missing = f"; {field.key.hint}" if field.key.hint else missing
        raise table.error(field.name, f"goes with {field.key.goes_with}{missing}")


def _check_use(found: Keys, field: Field) -> None:
    """Raise SceneError for a key that the words of others leave without a use; its
    default is not echoed."""
    for other, words in field.key.only.items():
        if getattr(found, other) in words:
            continue
        if field.name in found.table:
            raise found.table.error(field.name, f"goes with {field.key.goes_with}")
        found.table.fill(field.name, None)

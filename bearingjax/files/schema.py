"""Schema of scene files: a class describes a table, each of its fields one key.

Its fields define how the table is read, its JSON Schema and its part of the scene guide
(`schema_text`). The class is that of the thing itself, whose fields state unit, range
and meaning (`numerics.units.real`); `build` reads the table into it. A `Keys` class
describes a table that differs from the thing, with the rules for several keys in its
`check`.
"""

import dataclasses
import functools
import math
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import (
    Any,
    ClassVar,
    NamedTuple,
    TypeVar,
    dataclass_transform,
    get_args,
    get_origin,
)

from ..numerics.labels import stated_axes
from ..numerics.units import CELSIUS, unit_of
from .quantity import QUANTITIES, kind_of, scene_number, to_si
from .table import Table, format_number

_REQUIRED: Any = dataclasses.MISSING


@dataclasses.dataclass(frozen=True)
class Key:
    """Allowed values of a scene key, in addition to the type of its field.

    Attributes:
        about: One line for the scene guide, without a full stop.
        kind: Kind of quantity (`quantity.QUANTITIES`); empty for a pure number.
        above, least, below, most: Range, in `unit`.
        shown: Unit of the range and of numbers in errors; empty: SI, for
            temperatures °C.
        choices: Allowed words.
        words: The choices as described in errors, where they are too many to list.
        of: Allowed classes, by the word or the `type` that names them.
        hint: Addition to errors about the range, missing `needs`, or a non-table.
        refusal: Error text about the range, in place of "is not allowed; ...".
        needs: Keys of which one must be given with this one.
        without: Keys that must not be given with this one, with the error text;
            empty for "give either ... or this, not both".
        only: Words of other keys with which this one is used.
        name: Key in the file, if it is not a valid field name.
        otherwise: Description of a default that depends on other values.
        follows: Computes that default from the other keys of the table.
        reader: Reads a value of another type, from the table and the key name.
        json: JSON Schema of the values of `reader`.
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
        """Unit of the range; empty for a pure number."""
        unit = QUANTITIES[self.kind][0] if self.kind else ""
        return self.shown or ("°C" if unit == "K" else unit)

    def in_shown_unit(self, value: float) -> float:
        """Convert a number in SI to the unit of the range."""
        if self.unit == "°C":
            return value - CELSIUS
        return value / to_si(f"1 {self.shown}", self.kind) if self.shown else value

    def shown_value(self, value: float, largest: float | None = None) -> str:
        """Return a number with its unit, as it is shown in errors.

        Args:
            value: In `unit`.
            largest: Number whose unit it takes, in `unit`; by default its own.
        """
        if self.kind and self.unit == QUANTITIES[self.kind][0]:
            return scene_number(value, self.kind, largest)
        return f"{value:.6g} {self.unit}".rstrip()

    @property
    def range_words(self) -> str:
        """Range in words, such as "above 0 N"; empty without one."""
        low, high = ("least", self.least), ("most", self.most)
        if self.above is not None:
            low = ("above", self.above)
        if self.below is not None:
            high = ("below", self.below)
        given = {name: float(x) for name, x in (low, high) if x is not None}
        largest = max(map(abs, given.values()), default=0.0)
        texts = {name: self.shown_value(x, largest) for name, x in given.items()}
        ends = {name: text.partition(" ")[0] for name, text in texts.items()}
        unit = "".join(next(iter(texts.values()), "").partition(" ")[1:])
        first, last = ends.get("least"), ends.get("most")
        if first and last:
            return f"from {first} to {last}{unit}"
        if first and "below" in ends:
            return f"from {first} to below {ends['below']}{unit}"
        words = {"least": "at least", "most": "at most"}
        bounds = [f"{words.get(name, name)} {value}" for name, value in ends.items()]
        return " and ".join(bounds) + (unit if bounds else "")

    @property
    def goes_with(self) -> str:
        """Keys required with this one, in words; empty if none."""
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
    """Return a field of a `Keys` class.

    Args:
        about, kind: As in `Key`.
        default: Value if absent; without a default the key is required, unless the
            field may be `None`. The class of a table: the table read without keys.
        **rest: Other attributes of `Key`.
    """
    metadata = {"key": Key(about, kind, **rest)}
    return dataclasses.field(default=default, metadata=metadata)


def names_key(
    about: str, *, tables: bool = True, required: bool = False, **rest: Any
) -> Any:
    """Return a field of a `Keys` class for a table whose keys are names, read as a
    `Table`.

    Args:
        about: What the table holds, in one line without a full stop.
        tables: Whether its values are tables, not single values.
        required: Whether it must be there.
        **rest: Further arguments of `scene_key`.
    """
    json: dict[str, Any] = {"type": "object"}
    if tables:
        json["additionalProperties"] = {"type": "object"}

    def read(table, name):
        return table.table(name, required=required)

    return scene_key(about, reader=read, json=json, **rest)


def key_of(kind: type, name: str, /, **changes: Any) -> Any:
    """Return a field of a `Keys` class for a number that another class declares.

    Args:
        kind: Class of the thing, whose field states unit, range and meaning.
        name: Its field.
        **changes: What differs in the file: `default` and attributes of `Key`.
    """
    one = {one.attribute: one for one in fields_of(kind)}[name]
    default = changes.pop("default", one.default)
    metadata = {"key": dataclasses.replace(one.key, **changes)}
    return dataclasses.field(default=default, metadata=metadata)


def direction_key(
    about: str, names: Mapping[str, tuple[float, ...]], usual: str, **rest: Any
) -> Any:
    """Return a field of a `Keys` class for a direction: a name, or three bare numbers.

    Args:
        about: What the direction is of.
        names: Directions by name.
        usual: Name of the direction if the key is absent.
        **rest: Further arguments of `scene_key`.
    """

    def read(table: Table, key: str) -> tuple[float, ...]:
        value = table.raw(key, usual)
        if isinstance(value, str) and value in names:
            return names[value]
        real = isinstance(value, list) and [
            type(x) in (int, float) and math.isfinite(x) for x in value
        ]
        if real != [True] * 3:
            allowed = f"it must be {', '.join(names)} or three bare numbers"
            raise table.error(key, f"{value!r} is not known; {allowed}")
        if not any(value):
            raise table.error(key, "has no direction: all three numbers are 0")
        return tuple(map(float, value))

    three = {"minItems": 3, "maxItems": 3}
    numbers = {"type": "array", "items": {"type": "number"}, **three}
    json = {"anyOf": [{"enum": [*names]}, numbers]}
    known: Any = {"default": None, "otherwise": usual, "reader": read, "json": json}
    return scene_key(about, **known, **rest)


class Field(NamedTuple):
    """One key of a table.

    Attributes:
        name: Name in the file.
        attribute: Name in the class.
        key: Allowed values.
        kinds: Allowed types, without `None`.
        default: Value if absent, or `dataclasses.MISSING`.
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


@dataclass_transform(
    kw_only_default=True,
    frozen_default=True,
    field_specifiers=(scene_key, key_of, direction_key),
)
@dataclasses.dataclass(frozen=True, kw_only=True)
class Keys:
    """Base of the classes that describe tables, which are frozen dataclasses too.

    Attributes:
        table: The table that was read, for errors and the echo.
    """

    about: ClassVar[str] = ""
    """Line of the scene guide about the table, which is the docstring too."""

    numbers: ClassVar[Mapping[str, type]] = {}
    """Classes whose numbers may be given in the table under their field names, by the
    key that requires them; read by `build_law`."""

    table: Table = dataclasses.field(repr=False, compare=False)

    def __init_subclass__(cls) -> None:
        cls.__doc__ = cls.__doc__ or f"{cls.about}."
        dataclasses.dataclass(frozen=True, kw_only=True)(cls)

    @property
    def given(self) -> dict[str, Any]:
        """Values of the keys that have one, by field name."""
        values = {
            f.attribute: getattr(self, f.attribute) for f in fields_of(type(self))
        }
        return {name: value for name, value in values.items() if value is not None}

    def build_law(self, kind: type[Any]) -> Any:
        """Build an instance of a class from the numbers in the table.

        Args:
            kind: One of `numbers`.
        """
        return build(kind, self.table)

    def check(self) -> None:
        """Raise SceneError if keys are inconsistent; does nothing by default."""

    def fill(self, **values: int | float | str | None) -> None:
        """Set values of keys in the echo, such as defaults that depend on other
        values.

        Args:
            **values: Values by field name; numbers in SI.
        """
        for one in fields_of(type(self)):
            if one.attribute in values:
                value = values[one.attribute]
                unit = QUANTITIES[one.key.kind][0] if one.key.kind else ""
                if isinstance(value, float):
                    value = format_number(value, unit)
                self.table.fill(one.name, value)

    def with_defaults(self, **values: int | float | str) -> Any:
        """Return these keys with dependent defaults filled in, also in the echo.

        Args:
            **values: Defaults by field name, for fields that are `None`; in SI.
        """
        absent = {k: v for k, v in values.items() if getattr(self, k) is None}
        self.fill(**absent)
        return dataclasses.replace(self, **absent)


K = TypeVar("K", bound=Keys)


def read_keys(kind: type[K], table: Table) -> K:
    """Read the keys of a table.

    Raises:
        SceneError: For values that are missing, of the wrong kind, out of range, or
            inconsistent.
    """
    known = fields_of(kind)
    values = _values(table, known)
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


T = TypeVar("T")


def build(
    kind: Callable[..., T], table: Table, required: Iterable[str] = (), **given: Any
) -> T:
    """Build an object from the keys of a table.

    Args:
        kind: Its class, whose fields say what they are.
        table: The table.
        required: Fields that the table must have although the class has a default.
        **given: Fields that are known; the table does not have them.

    Raises:
        SceneError: For values that are missing, of the wrong kind, out of range, or
            refused by the class.
    """
    values = read_values(kind, table, required, given)
    with table.building():
        return kind(**values, **given)


def read_values(
    kind: Any, table: Table, required: Iterable[str] = (), left_out: Iterable[str] = ()
) -> dict[str, Any]:
    """Read the fields of an object from the keys of a table, in SI.

    Args:
        kind, table, required: As in `build`.
        left_out: Fields that are not read.
    """
    known = [
        one._replace(default=_REQUIRED) if one.name in required else one
        for one in fields_of(kind)
        if one.attribute not in left_out
    ]
    return _values(table, known)


def _values(table: Table, known: Iterable[Field]) -> dict[str, Any]:
    """Read the keys of a table, by the names of the fields."""
    values = {one.attribute: _value(table, one) for one in known}
    for one in known:
        _check_neighbours(table, one)
    return values


@functools.cache
def fields_of(kind: Any) -> tuple[Field, ...]:
    """Return the keys of a table, in order.

    Args:
        kind: Class of the table: of keys, or of the thing itself.
    """
    if not is_keys(kind):
        return tuple(_fields_of_thing(kind))
    hints = typing.get_type_hints(kind)
    found = []
    for field in dataclasses.fields(kind):
        if "key" not in field.metadata:
            continue
        one: Key = field.metadata["key"]
        united, default = _union_types(hints[field.name]), field.default
        kinds = tuple(kind for kind in united if kind is not types.NoneType)
        if default is _REQUIRED and len(kinds) < len(united):
            default = None
        found.append(Field(one.name or field.name, field.name, one, kinds, default))
    return tuple(found)


_OF_KEY = {field.name for field in dataclasses.fields(Key)} - {"kind"}


def _fields_of_thing(kind: type) -> Iterator[Field]:
    """Yield the fields of a class that a scene may give: those with a meaning."""
    for field in dataclasses.fields(kind):
        stated = {k: v for k, v in field.metadata.items() if k in _OF_KEY}
        if "about" not in stated:
            continue
        kinds = tuple(k for k in _union_types(field.type) if k is not types.NoneType)
        if "unit" in field.metadata:
            unit = unit_of(kind, field.name)
            stated["kind"] = kind_of(unit)
            kinds = (tuple[float, ...] if stated_axes(field.type) else float,)
            kinds += (str,) if "choices" in stated else ()
        yield Field(field.name, field.name, Key(**stated), kinds, field.default)


def _union_types(hint: Any) -> tuple[Any, ...]:
    """Return the types of a union, or the single type."""
    union = get_origin(hint) in (types.UnionType, typing.Union)
    return get_args(hint) if union else (hint,)


def element_of(kind: Any) -> Any:
    """Return the entry type of `tuple[X, ...]`; `None` for any other type."""
    return next(iter(get_args(kind)), None) if get_origin(kind) is tuple else None


def is_keys(kind: Any) -> bool:
    """Whether a type describes a table that differs from the thing."""
    return isinstance(kind, type) and issubclass(kind, Keys)


def is_table(kind: Any) -> bool:
    """Whether a type describes a table."""
    thing = isinstance(kind, type) and dataclasses.is_dataclass(kind)
    return is_keys(kind) or (thing and bool(fields_of(kind)))


def _value(table: Table, field: Field) -> Any:
    """Read the value of a key, in SI, within its range."""
    name, one, kind = field.name, field.key, field.kinds[0]
    default = () if field.required else (field.default,)
    absent = name not in table and not field.required
    if one.reader is not None:
        return one.reader(table, name)
    if one.of:
        return instance(table, name, one.of, *default)
    inner = element_of(kind)
    if is_table(kind):
        if absent and field.default is not kind:
            return field.default
        inside = table.table(name, required=field.required, hint=one.hint)
        return _read(kind, inside)
    if is_table(inner):
        if absent:
            return field.default
        return tuple(_read(inner, part) for part in table.tables(name))
    if inner is str:
        return _texts(table, name, one)
    if kind is str and not one.choices:
        return _text(table, name, *default)
    word = table.word(name) if str in field.kinds else None
    # Text in place of a pure number is taken as a word, possibly misspelt.
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
    return _in_range(table, name, table.quantity(name, one.kind, *default), one)


def _read(kind: Any, table: Table) -> Any:
    return read_keys(kind, table) if is_keys(kind) else build(kind, table)


def _text(table: Table, name: str, *default: Any) -> Any:
    """Read any text."""
    value = table.raw(name, *default)
    if name in table:
        text = table.text(name)
        if text is None:
            raise table.error(name, f"{value!r} is not a text")
        table.fill(name, value := text)
    return value


def _texts(table: Table, name: str, one: Key) -> tuple[str, ...] | None:
    """Read distinct words of the choices, or any texts without choices."""
    if one.choices:
        return table.words(name, one.choices)
    value = table.raw(name, None)
    if value is None:
        return None
    if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
        raise table.error(name, f"{value!r} is not a list of names")
    return tuple(value)


def _count(table: Table, name: str, one: Key, *default: Any) -> Any:
    """Read a whole number in the range of a key."""
    least = 1 if one.least is None else int(one.least)
    value = table.integer(name, *default, least=least)
    if name in table and one.most is not None and value > one.most:
        problem = one.refusal or f"is too many; at most {one.most:g}"
        raise table.error(name, f"{value} {problem}")
    return value


def _in_range(table: Table, name: str, value: Any, one: Key) -> Any:
    """Return the number or numbers of a key after checking its range, if given."""
    if name not in table or value is None:
        return value
    for number in map(
        one.in_shown_unit, value if isinstance(value, tuple) else (value,)
    ):
        if not one.holds(number):
            hint = f" ({one.hint})" if one.hint else ""
            problem = one.refusal or f"is not allowed; {one.range_words}{hint}"
            raise table.error(name, f"{one.shown_value(number)} {problem}")
    return value


def instance(table: Table, name: str, kinds: Mapping[str, type], *default: Any) -> Any:
    """Read an instance of one of several classes, given by a word or a table.

    Args:
        table: Table that holds the key.
        name: Its key.
        kinds: The classes, by their word; a table names one by its `type`, which may be
            left out where there is only one.
        default: Instance or word if absent; without a default the key is
            required.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
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
    return build(kind, own)


def _check_neighbours(table: Table, field: Field) -> None:
    """Raise SceneError for missing required keys, or excluded keys, of a given key;
    the default of a key that needs others is not echoed without them."""
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
    """Raise SceneError for a key that is unused given the words of other keys; its
    default is not echoed."""
    for other, words in field.key.only.items():
        if getattr(found, other) in words:
            continue
        if field.name in found.table:
            path = found.table.path_of(field.name).replace("[", ".").replace("]", "")
            cure = f"`--set {path}=unset` takes it away"
            problem = f"goes with {field.key.goes_with}; {cure}"
            raise found.table.error(field.name, problem)
        found.table.fill(field.name, None)

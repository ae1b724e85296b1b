"""What `print` and notebooks show of a module: its numbers, with units and meanings."""

import dataclasses
import html
import inspect
import re
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import equinox as eqx
import numpy as np
from jax.core import Tracer

from .labels import LabelledArray
from .result import Result
from .units import display_unit, field_metadata

_LISTED, _NAMED, _STEEP = 6, 12, 0.02
"""Most numbers that are shown each, without names and with names; angle [rad] from
which angles are shown in degrees."""
_WIDTH, _WIDEST = 100, 50
"""Characters of a line, and most of a value that others are aligned with."""


Fact = tuple[int, str, str, str]
"""A line that is shown: depth, name and value, with unit, of a field; its meaning."""


class Shown:
    """Parent of dataclasses that users print: `str` has the numbers of their parts."""

    deepest = 2  # parts of parts are too many to be read

    def shown_facts(self) -> Iterator[Fact]:
        """Yield what is shown, line by line: all fields that are not `None`."""
        return facts_of(self)

    def _read_facts(self) -> Iterator[Fact]:
        return (fact for fact in self.shown_facts() if fact[0] <= self.deepest)

    def __str__(self) -> str:
        facts = [(0, type(self).__name__, "", ""), *self._read_facts()]
        rows = [("  " * depth + name, *texts) for depth, name, *texts in facts]
        wide = max(len(name) for name, *_ in rows) + 2
        far = wide + max(len(text) for _, text, _ in rows if len(text) <= _WIDEST)
        lines, room = [], max(_WIDTH, far + _WIDTH // 3)
        for name, text, about in rows:
            line = f"{name:{wide}}{text}"
            if len(line) > far:  # the meaning begins below
                lines, line = [*lines, line], ""
            line = f"{line:{far}}  {about}"
            lines += textwrap.wrap(line, room, subsequent_indent=" " * (far + 2))
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        cell = '<td style="text-align:left;padding-left:{}em">{}</td>'
        page = f"<table><caption>{type(self).__name__}</caption>"
        for depth, *texts in self._read_facts():
            cells = map(cell.format, (depth, 1, 1), map(html.escape, texts))
            page += f"<tr>{''.join(cells)}</tr>"
        return f"{page}</table>"


class Printable(Shown, eqx.Module):
    """Parent of modules that users print: `repr` has types and shapes."""

    deepest = 99


def facts_of(owner: Any, fields: Sequence[str] = ()) -> Iterator[Fact]:
    """Yield the fields of a module, dataclass or named tuple at depth 1: those that are
    not `None`, and are part of its `repr`.

    Args:
        owner: Module or named tuple.
        fields: Names of some of its fields; empty: all.
    """
    for field in fields or _fields(owner) or ():
        value = getattr(owner, field)
        parts = {field: value}
        few = type(value) is tuple and len(value) <= _NAMED
        if few and any(_fields(part) is not None for part in value):
            parts = {f"{field}.{k}": part for k, part in enumerate(value)}
        if type(value) is dict:
            parts = {f"{field}.{k}": part for k, part in value.items()}
        for name, part in parts.items():
            if _fields(part) is not None:
                yield 1, name, type(part).__name__, _meaning(owner, field)
                own = isinstance(part, Shown)
                facts = part.shown_facts() if own else facts_of(part)
                yield from ((1 + fact[0], *fact[1:]) for fact in facts)
            elif part is not None:
                text = _value_text(owner, field, part, name.removeprefix(f"{field}."))
                yield 1, name, text, _meaning(owner, field) if name == field else ""


def _value_text(owner: Any, field: str, value: Any, entry: str) -> str:
    """Value of a field, or entry of it, with its unit; without known numbers its type,
    or words."""
    if not has_numbers(value):
        is_array = hasattr(value, "shape")
        text = (
            f"{value.dtype}{list(value.shape)}"
            if is_array
            else str(getattr(value, "label", value))
        )
        return textwrap.shorten(text, _WIDEST, placeholder=" …")
    label = getattr(owner, "label_entry", None) if entry != field else None
    array = label(entry, value) if label else LabelledArray.field(owner, field, value)
    values, units = array.values, np.asarray(array.units)
    if entry == "result" and values.dtype.kind == "i":
        codes = [(Result(code).label, np.sum(values == code)) for code in Result]
        return ", ".join(f"{n} {x}" if values.ndim else x for x, n in codes if n)
    if values.dtype.kind == "b":
        return f"{values.sum()} of {values.size}" if values.ndim else str(values)
    sizes = zip(values.shape[values.ndim - units.ndim :], units.shape, strict=True)
    units = units[np.ix_(*(np.arange(n) % size for n, size in sizes))]
    units = np.where(units == "1", "", units)
    names = array.labels(0) if values.ndim == 1 else None
    head, tail = "", f" [{', '.join(array.mixed)}]" if array.mixed else ""
    if values.dtype.kind == "c":
        head, values = "magnitude ", np.abs(values)
    return f"{head}{numbers_text(values, units, names)}{tail}"


def numbers_text(values: Any, units: Any, names: Sequence[str] | None = None) -> str:
    """Numbers in the units in which people read them, or the range of many.

    Args:
        values: Numbers of any shape [SI].
        units: SI unit of each, or of those along the last axes.
        names: Names of the numbers; those that are zero to round-off are left out.
    """
    numbers, heads, parts = np.ravel(values), np.array([""]), []
    units = np.ravel(np.broadcast_to(units, np.shape(values)))
    many = numbers.size > (_NAMED if names else _LISTED)
    kept = np.full(numbers.shape, True)
    if names and not many:
        heads = np.array([f"{name} " for name in names])
        kept = ~(np.abs(numbers) <= 1e-7 * np.abs(numbers).max())
    for unit in dict.fromkeys(units[kept].tolist()):
        mine = kept & (units == unit)
        part, head = numbers[mine], np.broadcast_to(heads, mine.shape)[mine]
        largest = float(np.fmax.reduce(np.abs(part)))
        factor, word = display_unit(unit, largest)
        if unit == "rad" and largest >= _STEEP:
            factor, word = 180.0 / np.pi, "°"
        ends = [np.fmin.reduce(part), np.fmax.reduce(part)] if many else part
        ends = [f"{h}{factor * x + 0.0:.5g}" for h, x in zip(head, ends, strict=False)]
        space = "" if word in ("", "°") else " "
        joined = " to ".join(dict.fromkeys(ends)) if many else ", ".join(ends)
        parts.append(joined + space + word)
    size = f" ({' x '.join(map(str, np.shape(values)))})" if many else ""
    return (", ".join(parts) or "0") + size


def has_numbers(value: Any) -> bool:
    """Whether it is a number, or an array of numbers, that is known: not traced."""
    kind = getattr(getattr(value, "dtype", None), "kind", "")
    array = kind in tuple("biufc") and hasattr(value, "__array__")
    return (array or type(value) in (int, float)) and not isinstance(value, Tracer)


def _fields(owner: Any) -> Sequence[str] | None:
    """Names of the fields of a module or named tuple; `None` of anything else."""
    if isinstance(owner, type | str) or not dataclasses.is_dataclass(owner):
        return getattr(owner, "_fields", None) if isinstance(owner, tuple) else None
    fields = dataclasses.fields(owner)
    return [f.name for f in fields if f.repr and not f.name.startswith("_")]


def _meaning(owner: Any, field: str) -> str:
    """What a field is, as it states, else by the first clause in the docstrings."""
    found = field_metadata(owner, field).get("about", "")
    entry = rf"^ +(?:\w+, )*{field}(?:, \w+)*: (.*?)(?: \[| \(\w+,|[.:;]\s|[.;:]?\Z)"
    for base in () if found else type(owner).__mro__:
        doc = inspect.cleandoc(base.__dict__.get("__doc__") or "")
        if clause := re.search(entry, doc, re.M | re.S):
            words = " ".join(clause[1].split())
            return words[:1].lower() + words[1:] if words[1:2].islower() else words
    return found

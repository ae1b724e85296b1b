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


class Printable(eqx.Module):
    """Parent of what users print: `str` has its numbers, `repr` types and shapes."""

    def shown_facts(self) -> Iterator[Fact]:
        """Yield what is shown, line by line: all fields that are not `None`."""
        return facts_of(self)

    def __str__(self) -> str:
        facts = [(0, type(self).__name__, "", ""), *self.shown_facts()]
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
        for depth, *texts in self.shown_facts():
            cells = map(cell.format, (depth, 1, 1), map(html.escape, texts))
            page += f"<tr>{''.join(cells)}</tr>"
        return f"{page}</table>"


def facts_of(owner: Any, fields: Sequence[str] = ()) -> Iterator[Fact]:
    """Yield the fields of a module or named tuple that are not `None`, at depth 1.

    Args:
        owner: Module or named tuple.
        fields: Names of some of its fields; empty: all.
    """
    for field in fields or _fields(owner) or ():
        value = getattr(owner, field)
        parts = {field: value}
        if type(value) is tuple and any(_fields(part) is not None for part in value):
            parts = {f"{field}.{k}": part for k, part in enumerate(value)}
        for name, part in parts.items():
            if _fields(part) is not None:
                yield 1, name, type(part).__name__, _meaning(owner, field)
                own = isinstance(part, Printable)
                facts = part.shown_facts() if own else facts_of(part)
                yield from ((1 + fact[0], *fact[1:]) for fact in facts)
            elif part is not None:
                yield 1, name, _value_text(owner, field, part), _meaning(owner, field)


def _value_text(owner: Any, field: str, value: Any) -> str:
    """Value of a field with its unit; without known numbers its type, or words."""
    if not has_numbers(value):
        is_array = hasattr(value, "shape")
        text = f"{value.dtype}{list(value.shape)}" if is_array else str(value)
        return textwrap.shorten(text, _WIDEST, placeholder=" …")
    array = LabelledArray.field(owner, field, value)
    values, units = array.values, np.asarray(array.units)
    if field == "result" and values.dtype.kind == "i":
        codes = [(Result(code).label, np.sum(values == code)) for code in Result]
        return ", ".join(f"{n} {x}" if values.ndim else x for x, n in codes if n)
    if values.dtype.kind == "b":
        return f"{values.sum()} of {values.size}" if values.ndim else str(values)
    sizes = zip(values.shape[values.ndim - units.ndim :], units.shape, strict=True)
    units = units[np.ix_(*(np.arange(n) % size for n, size in sizes))]
    units = np.where(units == "1", "", units)
    return numbers_text(values, units, array.labels(0) if values.ndim == 1 else None)


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
    array = kind in tuple("biuf") and hasattr(value, "__array__")
    return (array or type(value) in (int, float)) and not isinstance(value, Tracer)


def _fields(owner: Any) -> Sequence[str] | None:
    """Names of the fields of a module or named tuple; `None` of anything else."""
    if isinstance(owner, type) or not dataclasses.is_dataclass(owner):
        return getattr(owner, "_fields", None) if isinstance(owner, tuple) else None
    return [f.name for f in dataclasses.fields(owner) if not f.name.startswith("_")]


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

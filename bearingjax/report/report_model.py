"""Reports of runs as data: sections of sentences and grids of columns.

The terminal shows a `Report` as text, `html_report` as a page with tables. Its numbers
are in SI, with their unit; the units for display are chosen here, by `display_unit`.
"""

import dataclasses
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..element.frame import LOAD_UNITS, LOADS
from ..numerics.units import display_unit

RULE = "-" * 78
"""Rule between the sections of a text."""
_WHOLE = 1e6
"""Number below which digits before the point are written without an exponent."""
_WIDTH = 100
"""Characters of a line that ends in words."""
CASES_SHOWN = 12
"""Most cases that a text lists."""
DEGREES = 180.0 / np.pi, "deg"
NEWTONS = 1.0, "N"
"""Factor from SI and unit, for angles that are not tilts and for small forces."""


@dataclasses.dataclass(frozen=True)
class Column:
    """Values of one quantity, one per row.

    Attributes:
        name: Its heading; empty: none.
        values: Numbers in SI, or words; `None` and NaN are shown as "-".
        unit: SI unit of the numbers, empty for pure ones; or one for each, then shown
            next to the number.
        format: Format of a number, after the conversion.
        shown: Factor from SI and the displayed unit; default: `display_unit`.
    """

    name: str
    values: Sequence[Any] | np.ndarray
    unit: str | Sequence[str] = ""
    format: str = ".5g"
    shown: tuple[float, str] | None = None

    @property
    def heading(self) -> tuple[str, str]:
        """Name, and the displayed unit if common to all values."""
        return self.name, self._scales()[0][1] if isinstance(self.unit, str) else ""

    @property
    def is_text(self) -> bool:
        """Whether it holds words, which are left-aligned."""
        return any(isinstance(v, str) for v in self.values)

    def cells(self) -> list[str]:
        """Format the values as text."""
        several = not isinstance(self.unit, str)
        return [
            self._cell(value, factor) + (f" {unit}" if several else "")
            for value, (factor, unit) in zip(self.values, self._scales(), strict=False)
        ]

    def _scales(self):
        """Return factor and displayed unit of each value, at least one."""
        if not isinstance(self.unit, str):
            return [display_unit(unit) for unit in self.unit]
        one = display_unit(self.unit) if self.shown is None else self.shown
        return [one] * max(1, len(self.values))

    def _cell(self, value, factor):
        if isinstance(value, str):
            return value
        if value is None or np.isnan(value):
            return "-"
        if isinstance(value, int | np.integer):
            return str(value)
        if np.isinf(value):
            return "infinite"
        number = factor * float(value)
        text = f"{number:{self.format}}"
        if float(text) == 0.0:
            text = text.replace("-0", "0", 1)  # no minus before what rounds to zero
        return f"{number:.0f}" if "e+0" in text and abs(number) < _WHOLE else text


@dataclasses.dataclass(frozen=True)
class Grid:
    """A table: columns side by side.

    Attributes:
        columns: Columns of equal length.
        title: Line above the table.
    """

    columns: Sequence[Column]
    title: str = ""

    @classmethod
    def of_rows(
        cls, names: Sequence[str], rows: Iterable[Sequence[Any]], title: str = ""
    ) -> "Grid":
        """Return a table by rows.

        Args:
            names: Headings of its columns.
            rows: Words, or pure numbers, of each row.
            title: Line above the table.
        """
        return cls([*map(Column, names, zip(*rows, strict=True))], title)

    def heading(self) -> list[list[str]]:
        """Return the row of names and the row of units, each if there are any."""
        rows = zip(*(column.heading for column in self.columns), strict=True)
        return [list(row) for row in rows if any(row)]

    def rows(self) -> list[tuple[str, ...]]:
        """Return the cells of each row."""
        return list(zip(*(c.cells() for c in self.columns), strict=True))

    def __str__(self) -> str:
        rows = [*self.heading(), *self.rows()]
        width = [max(map(len, column)) for column in zip(*rows, strict=True)]
        left = [column.is_text for column in self.columns]
        lines = [
            "  ".join(
                f"{cell:{'<' if text else '>'}{size}}"
                for cell, size, text in zip(row, width, left, strict=True)
            ).rstrip()
            for row in rows
        ]
        if left[-1]:
            indent = " " * (sum(width[:-1]) + 2 * (len(width) - 1))
            lines = [part for line in lines for part in _wrap_row(line, indent)]
        return "\n".join([*([self.title] if self.title else []), *lines])


def _wrap_row(line: str, indent: str) -> list[str]:
    """Wrap a row that is too long, with its last words indented below themselves."""
    head, words = line[: len(indent)], line[len(indent) :]
    room = max(_WIDTH - len(indent), _WIDTH // 3)
    parts = textwrap.wrap(words, room, break_on_hyphens=False) or [""]
    lines = [f"{indent if k else head}{part}".rstrip() for k, part in enumerate(parts)]
    return [part.replace("\xa0", " ") for part in lines]


Part = str | Grid
"""Part of a section: one or several lines of sentences, or a table."""
Section = Sequence[Part]


def with_values(*columns: Column) -> list[Column]:
    """Return the columns that have a value."""
    return [one for one in columns if any(value is not None for value in one.values)]


def load_text(load: Iterable[Any]) -> str:
    """Format the parts of a load that are not zero; "" without any.

    Args:
        load: (Fx, Fy, Fz, Mx, My, Mz) [N, N m].
    """
    parts = zip(LOADS, LOAD_UNITS, np.asarray(load), strict=True)
    return ", ".join(f"{name} {x:.5g} {unit}" for name, unit, x in parts if x)


def labelled_facts(rows: Iterable[tuple[str, str]]) -> Grid:
    """Return a table of facts, each preceded by a label."""
    labels, facts = zip(*rows, strict=True)
    return Grid([Column("", labels), Column("", facts)])


@dataclasses.dataclass(frozen=True)
class Report:
    """Readable report of a run; `str` of it is the terminal text.

    Attributes:
        sections: Sections by title, in order; empty ones are left out.
        warnings: Warnings to be read before the numbers are used.
    """

    sections: Mapping[str, Section]
    warnings: Sequence[str] = ()

    def __post_init__(self):
        filled = {title: parts for title, parts in self.sections.items() if parts}
        object.__setattr__(self, "sections", filled)

    def __str__(self) -> str:
        texts = ["\n".join(map(str, parts)) for parts in self.sections.values()]
        warned = "".join(f"\nwarning: {text}" for text in self.warnings)
        return f"\n{RULE}\n".join(texts) + warned

    def with_sections(self, titles: Sequence[str]) -> "Report":
        """Return the report with some of its sections.

        Args:
            titles: Titles of the sections to keep; missing ones are ignored.
        """
        kept = {title: self.sections.get(title, ()) for title in titles}
        return dataclasses.replace(self, sections=kept)

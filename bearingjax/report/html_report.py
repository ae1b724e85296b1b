"""Reports as self-contained HTML files.

Pictures and style are embedded; nothing is fetched. The page shows the sections of a
`Report`, sentences as paragraphs and grids as tables, so that it contains everything
shown on the terminal.
"""

import base64
import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.resources import files
from types import MappingProxyType
from typing import Any

import numpy as np

from .._version import __version__
from ..numerics.units import shown_number
from .report_model import Part, Report

MOST_ROWS = 200
"""Most rows of a table shown on a page; `--table` writes all rows."""


@dataclasses.dataclass(frozen=True)
class Origin:
    """Origin of a report, with which it can be reproduced.

    Attributes:
        command: Command line.
        text: Text of the scene file.
        settings: Changes to it, "key=value".
        date: Date and time, as text.
        written: Inputs by dotted key as the scene has them, whose units the page
            takes over; others have those of the reports. `None`: all in SI.
    """

    command: str
    text: str
    settings: tuple[str, ...]
    date: str
    written: Mapping[str, str] | None = None


def report_page(
    title: str,
    report: Report,
    inputs: Mapping[str, Any],
    origin: Origin,
    pictures: Mapping[str, bytes | str] = MappingProxyType({}),
    table: Mapping[str, np.ndarray] | None = None,
    warnings: Sequence[str] = (),
    drawing: bytes | str | None = None,
) -> str:
    """Return the HTML page of a run, of any command.

    Args:
        title: Title of the page.
        report: Its sections, and warnings, shown at the top of the page.
        inputs: All inputs, as written in a scene.
        origin: Origin of the report.
        pictures: PNG files by their titles, or the reason why one is missing.
        table: Columns by header, "name [unit]"; its first rows are shown.
        warnings: Warnings that are not in the report.
        drawing: PNG drawing of the bearing, shown with the inputs, or why missing.

    Returns:
        A complete HTML document.
    """
    parts = [
        _warnings([*report.warnings, *warnings]),
        *(_picture(name, png) for name, png in pictures.items()),
        *(
            _section(name, "\n".join(map(_part, parts)))
            for name, parts in report.sections.items()
        ),
        "" if table is None else _table(table),
        "" if drawing is None else _picture("Drawing", drawing),
        _inputs(inputs, origin.written) if inputs else "",
        _rerun(origin),
    ]
    return _page(title, parts, origin)


def _page(title: str, parts: Iterable[str], origin: Origin) -> str:
    made = f"bearingjax {__version__}, {origin.date}"
    body = "\n".join(part for part in parts if part)
    style = (files("bearingjax.report") / "page.css").read_text(encoding="utf-8")
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="bearingjax {escape(__version__)}">
<title>{escape(title)}</title>
<style>
{style}</style>
</head>
<body>
<header>
<h1>{escape(title)}</h1>
<p>{escape(made)}</p>
</header>
{body}
</body>
</html>
"""


def _section(title: str, content: str, kind: str = "") -> str:
    extra = f' class="{kind}"' if kind else ""
    return f"<section{extra}>\n<h2>{escape(title)}</h2>\n{content}\n</section>"


def _part(part: Part) -> str:
    """Format a paragraph of sentences, or a table."""
    if isinstance(part, str):
        return f"<p>{escape(part.strip())}</p>" if part.strip() else ""
    kinds = ["" if column.is_text else ' class="value"' for column in part.columns]
    title = f"<caption>{escape(part.title)}</caption>\n" if part.title else ""
    heads = [column.heading for column in part.columns]
    head = "".join(
        f'<th scope="col"{kind}>{escape(name)}{_unit(unit)}</th>'
        for (name, unit), kind in zip(heads, kinds, strict=True)
    )
    named = any(map(any, heads))
    rows = "\n".join(
        "<tr>"
        + "".join(
            f"<td{kind}>{escape(cell)}</td>"
            for cell, kind in zip(row, kinds, strict=True)
        )
        + "</tr>"
        for row in part.rows()
    )
    top = f"<thead>\n<tr>{head}</tr>\n</thead>\n" if named else ""
    body = f"{title}{top}<tbody>\n{rows}\n</tbody>"
    return f'<div class="scroll"><table class="grid">\n{body}\n</table></div>'


def _unit(unit: str) -> str:
    return f' <span class="unit">{escape(unit)}</span>' if unit else ""


def _warnings(warnings: Sequence[str]) -> str:
    """Format the warnings as a box, without duplicates."""
    if not warnings:
        return ""
    items = "\n".join(f"<li>{escape(one)}</li>" for one in dict.fromkeys(warnings))
    return _section("Warnings", f"<ul>\n{items}\n</ul>", "warnings")


def _picture(title: str, png: bytes | str) -> str:
    if isinstance(png, str):
        return _section(title, f"<p>{escape(png)}</p>")
    data = base64.b64encode(png).decode("ascii")
    image = f'<img alt="{escape(title)}" src="data:image/png;base64,{data}">'
    return _section(title, f"<figure>{image}</figure>")


def _inputs(inputs: Mapping[str, Any], written: Mapping[str, str] | None) -> str:
    """Format a table of all inputs, defaults included."""
    rows = []
    for table, held in inputs.items():
        head = f'<th scope="colgroup" colspan="2">[{escape(table)}]</th>'
        rows.append(f"<tr>{head}</tr>")
        for key, value in flat(held):
            if written is not None:
                value = written.get(f"{table}.{key}") or _display(value)
            row = f'<td>{escape(key)}</td><td class="number">{escape(value)}</td>'
            rows.append(f"<tr>{row}</tr>")
    body = "\n".join(rows)
    units = "in SI, [cases] as written" if "cases" in inputs else "in SI"
    units = units if written is None else "in the units of the scene"
    note = f"All that was read, {units}; what the scene leaves out has its default."
    return _section("Inputs", f"<p>{note}</p>\n<table>\n{body}\n</table>")


def _display(text: str) -> str:
    """Return quantities in SI as text in the units of the reports, other text as is."""
    number, _, unit = text.partition(" ")
    if ", " in text:
        return ", ".join(map(_display, text.split(", ")))
    try:
        return shown_number(float(number), unit, 8) if unit else text
    except ValueError:
        return text


def flat(held: Any, key: str = "") -> list[tuple[str, str]]:
    """Flatten nested tables to pairs (dotted key, value as text).

    Args:
        held: Tables, lists and values, as written in a scene.
        key: Dotted key of `held`.
    """
    if isinstance(held, Mapping):
        pairs = held.items()
    elif isinstance(held, Sequence) and any(isinstance(x, Mapping) for x in held):
        pairs = ((str(k), one) for k, one in enumerate(held))
    else:
        return [(key, _format_value(held))]
    return [
        pair
        for name, one in pairs
        for pair in flat(one, f"{key}.{name}" if key else name)
    ]


def _format_value(value: Any) -> str:
    """Format a value as text: numbers with at most eight digits, integers with all."""
    if isinstance(value, Sequence) and not isinstance(value, str):
        return ", ".join(map(_format_value, value))
    if isinstance(value, bool):
        return str(value).lower()  # as in TOML
    if isinstance(value, int):
        return str(value)
    number, space, unit = str(value).partition(" ")
    try:
        return f"{float(number):.8g}{space}{unit}"
    except ValueError:
        return str(value)


def _table(found: Mapping[str, np.ndarray]) -> str:
    """Format the first rows of a table."""
    count = max(map(len, found.values()), default=0)
    head = "".join(f'<th scope="col">{_break_words(header)}</th>' for header in found)
    rows = [
        "<tr>" + "".join(f"<td>{escape(_cell(x))}</td>" for x in row) + "</tr>"
        for row in zip(*(v[:MOST_ROWS] for v in found.values()), strict=True)
    ]
    left = count - len(rows)
    note = f"<p>The first {len(rows)} of {count} rows.</p>\n" if left > 0 else ""
    body = "\n".join(rows)
    head = f"<thead>\n<tr>{head}</tr>\n</thead>"
    table = f'<table class="cases">\n{head}\n<tbody>\n{body}\n</tbody>\n</table>'
    return _section("Table", f'{note}<div class="scroll">{table}</div>', "wide")


def _break_words(name: str) -> str:
    """Allow line breaks between the words of a name."""
    return escape(name).replace("_", "_<wbr>").replace(".", ".<wbr>")


def _cell(value: Any) -> str:
    if isinstance(value, float | np.floating):
        return f"{value:.6g}" if np.isfinite(value) else ""
    return str(value)


def _rerun(origin: Origin) -> str:
    """Format the command and scene that reproduce the report."""
    changes = "".join(f"\n  {one}" for one in origin.settings)
    changed = f"\nwith these changes to the scene below:{changes}" if changes else ""
    again = f"{origin.command}{changed}"
    scene = f"\n<p>The scene:</p>\n<pre>{escape(origin.text)}</pre>"
    return _section(
        "How to run it again",
        f"<pre>{escape(again)}</pre>" + (scene if origin.text else ""),
    )

"""Reports as self-contained HTML files.

Pictures and style are embedded; nothing is fetched. The page shows the sections of a
`Report`, sentences as paragraphs and grids as tables, so that it contains everything
shown on the terminal.
"""

import base64
import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from types import MappingProxyType
from typing import Any

import numpy as np

from .._version import __version__
from ..numerics.units import shown_number
from .report_model import Part, Report

MOST_ROWS = 200
"""Most rows of a table shown on a page; `--table` writes all rows."""

_STYLE = """
:root { color-scheme: light }
body { margin: 0 auto; max-width: 62rem; padding: 1.5rem; color: #1b1f24;
  background: #fff; font: 15px/1.5 system-ui, "Segoe UI", Helvetica, Arial, sans-serif }
h1 { font-size: 1.7rem; margin: 0 0 .2rem }
h2 { font-size: 1.15rem; margin: 2rem 0 .6rem; padding-bottom: .2rem;
  border-bottom: 2px solid #2f6f9f }
header p { margin: 0; color: #57606a }
pre { font: 12.5px/1.45 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace;
  margin: 0; white-space: pre-wrap; overflow-wrap: break-word }
section > p { margin: .3rem 0; white-space: pre-line }
figure { margin: 0 } figure img { width: 100%; height: auto }
.warnings { border-left: 5px solid #c77700; background: #fff6e5; padding: .6rem 1rem;
  margin: 1rem 0 }
.warnings h2 { margin: 0; padding: 0; border: none }
.warnings ul { margin: .2rem 0; padding-left: 1.2rem }
.scroll { overflow: auto; max-height: 85vh }
.scroll thead th { position: sticky; top: 0; background: #fff }
.grid td:first-child { white-space: nowrap }
.grid td:last-child:not(.value):not(:first-child) { min-width: 10rem }
table { border-collapse: collapse; font-size: 13px; width: 100% }
th, td { text-align: left; padding: .15rem .6rem .15rem 0; vertical-align: top;
  border-bottom: 1px solid #e3e6ea }
th[scope=colgroup] { padding-top: .8rem; border-bottom: 1px solid #9aa4ae }
td.number { font-variant-numeric: tabular-nums; overflow-wrap: anywhere }
table.grid { width: auto; margin: .5rem 0 }
.grid caption { text-align: left; padding: .3rem 0; position: sticky; left: 0 }
.grid th, .grid td { padding-right: 1.1rem }
.grid .value { text-align: right; font-variant-numeric: tabular-nums }
.grid td.value { white-space: nowrap } .grid th { vertical-align: bottom }
.grid th .unit { font-weight: normal; color: #57606a }
.cases th, .cases td { font-size: 11px; white-space: nowrap }
.cases th { white-space: normal; vertical-align: bottom }
@media screen {
  figure { width: min(96vw, 80rem); margin-left: 50%; transform: translateX(-50%) }
}
@media screen and (max-width: 40rem) {
  body { padding: .8rem } figure { overflow-x: auto } figure img { width: 60rem }
}
@page { size: A4; margin: 14mm 12mm;
  @bottom-right { content: counter(page) " / " counter(pages); font: 8pt sans-serif } }
@page wide { size: A4 landscape }
@media print {
  body { max-width: none; padding: 0; font-size: 9pt; line-height: 1.35 }
  h1 { font-size: 16pt } h2 { font-size: 11pt; margin: 5mm 0 2mm; break-after: avoid }
  pre { font-size: 7.2pt; line-height: 1.3; orphans: 6; widows: 6 }
  table { font-size: 8pt } th, td { padding: .3mm 3mm .3mm 0 }
  figure, .warnings, tr { break-inside: avoid } p { break-after: avoid }
  tr:has(th[scope=colgroup]) { break-after: avoid }
  .wide { page: wide; break-after: page }
  .scroll { overflow: visible; max-height: none }
  .cases th, .cases td { font-size: 6pt; padding-right: 1.5mm; white-space: normal }
}
"""


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
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="bearingjax {escape(__version__)}">
<title>{escape(title)}</title>
<style>{_STYLE}</style>
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

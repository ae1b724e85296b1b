"""The validation page: cases, theirs beside ours, and where they differ.

Ours are those of `validation.json`, which `bearingjax validate --json` writes and the
tests compare with what is calculated.
"""

import functools
import json
from pathlib import Path

import numpy as np

from bearingjax.plot import validation_overview
from bearingjax.report.report_model import Column, Grid
from bearingjax.studies.validate.report import pairs_and_trust, validation_report
from bearingjax.studies.validate.run import Comparison
from bearingjax.validation import cases

HERE = Path(__file__).parent
_LARGE = 0.02
"""Relative difference from which a number is listed among those that differ [1]."""


@functools.cache
def comparisons():
    """All numbers of all cases beside the stored ones of ours."""
    stored = json.loads((HERE / "validation.json").read_text("utf-8"))["cases"]
    found = []
    for case in cases().values():
        for number in case.numbers:
            ours = np.array(stored[case.name][number.name]["ours"], float)
            found.append(Comparison(case, number, ours))
    return found


def validation_page():
    """The page, in Markdown."""
    head = (HERE / "validation_head.md").read_text("utf-8")
    report = validation_report(comparisons(), single=True)
    text = f"{head}\n{_table(report.sections['Trust'][0])}\n\n## Where they differ\n\n"
    text += f"{_table(_differing())}\n"
    text += "\n![Ours over theirs, and the difference of each value](validation.svg)\n"
    for title, parts in report.sections.items():
        text += "" if title == "Trust" else f"\n## {title}\n"
        for part in parts if title != "Trust" else ():
            if isinstance(part, Grid):
                name, _, case = part.title.rpartition(" (")
                text += f"\n({_anchor(case[:-1])})=\n### {name}\n\n`{case[:-1]}`\n\n"
                text += f"{_table(part)}\n"
            else:
                text += f"\n{' '.join(part.split())}\n"
    return text


def draw_overview():
    """Draw all numbers."""
    overview = validation_overview(*pairs_and_trust(comparisons()))
    overview.savefig(HERE / "_generated" / "validation.svg")


def cases_of_type(kind):
    """The cases of a type of bearing, in Markdown."""
    lines = []
    for name, case in cases().items():
        own = [o.largest for o in comparisons() if o.case is case and o.number.is_test]
        if case.type == kind:
            far = f": differs by up to {100.0 * max(own):.2g} %" if own else ""
            lines.append(f"- [{case.title}](#{_anchor(name)}), {case.trust}{far}")
    return (
        "\n".join(lines) or "None of this type yet; the contacts are those of others."
    )


def _differing():
    """Numbers that differ most, with their reasons."""
    own = [one for one in comparisons() if one.largest > _LARGE]
    own.sort(key=lambda one: -one.largest)
    return Grid(
        [
            Column("case", [f"[{o.case.name}](#{_anchor(o.case.name)})" for o in own]),
            Column("number", [one.number.name for one in own]),
            Column("by", [one.largest for one in own], "1", ".2g", (100.0, "%")),
            Column("why", [one.number.reason for one in own]),
        ]
    )


def _anchor(case):
    return f"case-{case.replace('_', '-')}"


def _table(grid):
    """A grid in Markdown."""
    heads = [
        f"{name} [{unit}]" if unit else name
        for name, unit in (c.heading for c in grid.columns)
    ]
    rows = [heads, ["---"] * len(heads), *grid.rows()]
    cells = (" | ".join(str(c).replace("|", "\\|") for c in row) for row in rows)
    return "\n".join(f"| {row} |" for row in cells)

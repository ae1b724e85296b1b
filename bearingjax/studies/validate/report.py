"""What `bearingjax validate` tells, writes and draws."""

import textwrap
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from ..._version import __version__
from ...numerics.units import shown_count
from ...report.report_model import Column, Grid, Part, Report
from ...validation.case import SUBJECTS, TRUST, Case
from .run import Comparison

_PERCENT = 100.0, "%"
_WIDTH = 100
"""Characters of a line of words."""


def case_list(cases: Iterable[Case]) -> Report:
    """Return the cases by their subjects, in whose order they must be."""
    sections: dict[str, Sequence[Part]] = {}
    for subject, group in groupby(cases, key=lambda case: case.subject):
        rows = [(case.name, case.trust, case.title) for case in group]
        names = "case", "trust", "title"
        sections[SUBJECTS[subject]] = [Grid.of_rows(names, rows)]
    return Report(sections)


def validation_report(found: Sequence[Comparison], single: bool) -> Report:
    """Return the comparisons by subject, in whose order they must be.

    Args:
        found: Comparisons of any cases.
        single: Whether to list every number; else each case has one line, that of its
            number that differs most from what is asked.
    """
    sections: dict[str, Sequence[Part]] = {}
    for subject, group in groupby(found, key=lambda one: one.case.subject):
        by_case = [[*own] for _, own in groupby(group, key=lambda one: one.case.name)]
        parts = [part for own in by_case for part in _case_parts(own)]
        sections[SUBJECTS[subject]] = parts if single else [_summary(by_case)]
    sections["Trust"] = [_by_trust(found)]
    return Report(sections)


def _summary(by_case: list[list[Comparison]]) -> Grid:
    tested = [[one for one in own if one.number.is_test] for own in by_case]
    largest = [max((one.largest for one in own), default=np.nan) for own in tested]
    kept = ["yes" if all(one.kept for one in own) else "no" for own in tested]
    return Grid(
        [
            Column("case", [own[0].case.name for own in by_case]),
            Column("trust", [own[0].case.trust for own in by_case]),
            Column("numbers", [sum(one.count for one in own) for own in by_case]),
            Column("differ by up to", largest, "1", ".2g", _PERCENT),
            Column("as asked", kept),
        ]
    )


def _case_parts(own: list[Comparison]) -> list[Part]:
    """Return title, source and numbers of one case; of each list of values the one that
    differs most."""
    case = own[0].case
    reasons = dict.fromkeys(
        f"{one.number.name}: {one.number.reason}" for one in own if one.number.reason
    )
    grid = Grid(
        [
            Column("number", [one.number.name for one in own]),
            Column("values", [one.count for one in own]),
            Column("theirs", [one.theirs[one.worst] for one in own]),
            Column("ours", [one.flat_ours[one.worst] for one in own]),
            Column("unit", [one.number.unit for one in own]),
            Column("differs by", [one.largest for one in own], "1", ".2g", _PERCENT),
            Column("asked for", [_tolerance_in_words(one) for one in own]),
        ],
        f"{case.title} ({case.name})",
    )
    notes = [case.notes] if case.notes else []
    words = [f"{TRUST[case.trust].capitalize()}: {case.source}", *notes, *reasons]
    return [grid, *(textwrap.fill(text, _WIDTH) for text in words)]


def _tolerance_in_words(one: Comparison) -> str:
    """Return the tolerance in words, and whether it is kept."""
    number = one.number
    if not number.is_test:
        return "for information"
    parts = [f"{100.0 * number.tolerance:.3g} %"] if number.tolerance else []
    parts += [f"{number.within:.3g} {number.unit}".strip()] if number.within else []
    return " and ".join(parts) + ("" if one.kept else ": missed")


def _by_trust(found: Sequence[Comparison]) -> Grid:
    """Return how many cases and numbers there are of each kind of trust."""
    cases = Counter({one.case.name: one.case.trust for one in found}.values())
    count = Counter(one.case.trust for one in found for _ in one.theirs)
    kinds = [kind for kind in TRUST if cases[kind]]
    return Grid(
        [
            Column("trust", kinds),
            Column("cases", [cases[kind] for kind in kinds]),
            Column("numbers", [count[kind] for kind in kinds]),
        ],
        shown_count(cases.total(), "case"),
    )


def numbers(found: Sequence[Comparison]) -> dict[str, Any]:
    """Return the JSON: by case and number ours, in the unit of the case."""
    cases: dict[str, dict[str, Any]] = {}
    for one in found:
        cases.setdefault(one.case.name, {})[one.number.name] = {
            "ours": one.ours,
            "theirs": one.number.theirs,
            "unit": one.number.unit,
            "kept": one.kept if one.number.is_test else None,
        }
    return {"cases": cases, "version": __version__}


def columns(found: Sequence[Comparison]) -> Mapping[str, np.ndarray]:
    """Return the table: a row for each value."""
    names = "case", "number", "trust", "unit", "theirs", "ours"
    rows = [
        (one.case.name, one.number.name, one.case.trust, one.number.unit, *values)
        for one in found
        for values in zip(one.theirs, one.flat_ours, strict=True)
    ]
    return dict(zip(names, map(np.array, zip(*rows, strict=True)), strict=True))


def pairs_and_trust(
    found: Sequence[Comparison],
) -> tuple[dict[str, tuple[np.ndarray, np.ndarray]], dict[str, str]]:
    """Return theirs and ours by case, and the trust of each, for the picture."""
    pairs: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for one in found:
        old = pairs.get(one.case.name, (np.empty(0), np.empty(0)))
        new = one.theirs, one.flat_ours
        pairs[one.case.name] = tuple(map(np.append, old, new))  # type: ignore
    return pairs, {one.case.name: one.case.trust for one in found}

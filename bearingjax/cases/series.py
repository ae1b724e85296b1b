"""A record in time as cases: rows that are alike are one, their hours summed.

Nothing is binned or interpolated: rows are one case if all their numbers are equal.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float, Int

from ..design.checks import must_be, of_shape
from ..element.frame import LOADS
from ..numerics.shown import Printable
from ..numerics.types import with_fields
from ..numerics.units import unit
from .cases import Cases
from .spectrum import revolutions_per_hour
from .sweep import Sweep

GAPS = "refuse", "leave_out", "hold"
"""What a gap of a record may count as."""

LONG = 10.0
"""Steps this much longer than the median are gaps [1]."""

_NAMED = 3
"""Gaps that are named each; of others the number is told."""

_SAME = 1e-9
"""Difference below which extremes are alike, relative to the largest [1]."""

SERIES_OUTPUTS = (
    "damage",
    "raceway_damage",
    "static_safety",
    "peak_pressure",
    "largest_load",
)
"""Outputs of a sweep that `series_life` takes."""


class Series(Printable):
    """A record in time as cases.

    Attributes:
        cases: Its different cases with their hours, shuffled: the first ones of a sweep
            are those that others start from.
        case: Case of each row of the record (row,); -1: the row is not counted.
        hours: Time that each row counts (row,) [h].
        gaps: What is missing from the record, in words.
    """

    cases: Cases
    case: Int[np.ndarray, " time"]
    hours: Float[np.ndarray, " time"] = eqx.field(metadata=unit("h"))
    gaps: tuple[str, ...] = eqx.field(static=True)


class SeriesLife(Printable):
    """Use of a bearing's life in a record.

    Attributes:
        hours: Time that counts [h].
        damage: Part of the life that is used [1]: `Life.damage` over the revolutions.
        raceway_damage: The same of every raceway by itself (row, raceway) [1].
        life_hours: Time until the damage is 1 if the record repeats [h].
        row_damage: Part of `damage` that each row of the record uses (row,) [1].
        static_safety: The least one of all rows [1].
        peak_pressure: The largest one of all rows [Pa].
        largest_load: Largest load of a rolling element in all rows [N].
        row: First row with each of these three, by name; and as "damage" that which
            does most damage in an hour.
    """

    hours: float = eqx.field(metadata=unit("h"))
    damage: float = eqx.field(metadata=unit("1"))
    raceway_damage: Float[np.ndarray, "row raceway=2"] = eqx.field(metadata=unit("1"))
    life_hours: float = eqx.field(metadata=unit("h"))
    row_damage: Float[np.ndarray, " time"] = eqx.field(metadata=unit("1"))
    static_safety: float = eqx.field(metadata=unit("1"))
    peak_pressure: float = eqx.field(metadata=unit("Pa"))
    largest_load: float = eqx.field(metadata=unit("N"))
    row: dict[str, int] = eqx.field(static=True)


def series_cases(
    time: Any,
    cases: Cases,
    *,
    gaps: str = "refuse",
    row_name: Callable[[int], str] = "row {}".format,
) -> Series:
    """Cases of a record in time, each row of which holds until the next one.

    The last row holds for the median step. Gaps are steps above `LONG` medians, and
    rows with a number or time that is not finite.

    Args:
        time: Time of each row, ascending (row,) [s].
        cases: Loads, speeds and the like of each row, without hours.
        gaps: "refuse"; "leave_out": rows that are not finite do not count, and the row
            before a long step counts a median step; "hold": the row before a gap holds
            until the next one after it.
        row_name: What errors call a row, by its number from 0.

    Raises:
        ValueError: For fewer than two rows, times that do not ascend or are not of each
            row, cases with hours, an unknown word, and gaps if they are refused.
    """
    allowed = "one of " + ", ".join(map(repr, GAPS))
    must_be("series_cases", "gaps", gaps, gaps in GAPS, allowed)
    none = cases.hours is None
    must_be("series_cases", "cases", "with hours", none, "without: they follow")
    time = np.asarray(time, float)
    fits = time.shape == (cases.count,) and cases.count > 1
    allowed = f"({cases.count},), a time for each row, of two at least"
    of_shape("series_cases", "time", fits, allowed, time)
    columns = _columns(cases)
    hours, told = _held(time, columns, gaps, row_name)
    if told and gaps == "refuse":
        raise ValueError(
            f"series_cases: `time` has gaps: {'; '.join(told)}. Leave them out,"
            " or let the rows before them hold (`gaps`)."
        )
    if not hours.any():
        raise ValueError(
            "series_cases: `cases` has no row without a gap; one at least."
        )
    case, first, spent = _alike(list(columns.values()), hours)
    taken = {name: _taken(getattr(cases, name), first) for name in vars(cases)}
    merged = with_fields(cases, **{**taken, "hours": spent})
    return Series(merged, case, hours, told)


def _columns(cases: Cases) -> dict[str, np.ndarray]:
    """Numbers of each row by name; of rows at rest that of the oil is none."""
    load = np.asarray(cases.load)
    found = {name: load[:, k] for k, name in enumerate(LOADS)} | cases.prescribed
    if cases.fixed_displacement is not None:
        found |= {f"fixed_{k}": cases.fixed_displacement[:, k] for k in range(6)}
    names = "inner_speed", "outer_speed", "oscillation", "design", "viscosity"
    known = {name: getattr(cases, name) for name in names}
    found |= {name: v for name, v in known.items() if v is not None}
    turns = revolutions_per_hour(cases, np)
    if turns is not None and cases.viscosity is not None:
        found["viscosity"] = np.where(turns == 0, 1.0, np.asarray(cases.viscosity))
    return {name: np.asarray(values) for name, values in found.items()}


def _held(time, columns, gaps, row_name):
    """Hours that each row counts, and the gaps, (row, words) each."""
    bad = np.zeros(time.shape, bool)
    found = []
    for name, values in {"time": time, **columns}.items():
        lost = np.flatnonzero(~np.isfinite(values) & ~bad)
        bad[lost] = True
        found += [(k, f"{name} is no finite number") for k in lost]
    rows = np.flatnonzero(np.isfinite(time))
    steps = np.diff(time[rows])
    back = np.flatnonzero(steps <= 0)
    if back.size or not steps.size:
        pair = rows[back[0] : back[0] + 2] if back.size else rows
        which = " and ".join(f"{time[k]:.10g} s in {row_name(int(k))}" for k in pair)
        raise ValueError(f"series_cases: `time` is {which}; it must ascend.")
    usual = np.median(steps)
    long = steps > LONG * usual
    for k in np.flatnonzero(long):
        words = f"{shown_time(steps[k])} until the next row; {shown_time(usual)} are"
        found.append((rows[k], f"{words} usual"))
    steps = np.append(steps, usual)
    if gaps == "leave_out":
        lost = np.append(long | (np.diff(rows) > 1), False)
        steps = np.where(lost, np.minimum(steps, usual), steps)
    held = np.zeros(time.shape)
    held[rows] = steps
    if gaps == "hold" and not bad.all():
        before = np.maximum.accumulate(np.where(bad, -1, np.arange(time.size)))
        kept = before >= 0
        held = np.bincount(before[kept], held[kept], time.size)
    found = [(int(k), words) for k, words in sorted(found)]
    named = tuple(f"{row_name(k)}: {words}" for k, words in found[:_NAMED])
    more = len(found) - len(named)
    told = (*named, f"and {more} more") if more else named
    return np.where(bad, 0.0, held) / 3600.0, told


def shown_time(seconds: float) -> str:
    """Return a time in words, in the largest unit of which it has one.

    Args:
        seconds: The time [s].
    """
    units = (31557600.0, "a"), (86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s")
    size, name = next((u for u in units if seconds >= u[0]), units[-1])
    return f"{seconds / size:.4g} {name}"


def _alike(columns, hours):
    """Case of each row, first row of each case, and the hours of the cases."""
    counted = np.flatnonzero(hours > 0)
    keys = [c[counted] for c in columns]
    keys = [c for c in keys if c.size and np.any(c != c[0])]
    order = np.lexsort(keys) if keys else np.arange(counted.size)
    new = np.zeros(counted.size, bool)
    new[:1] = True
    for column in keys:
        new[1:] |= np.diff(column[order]) != 0
    shuffled = np.random.default_rng(0).permutation(int(new.sum()))
    case = np.full(hours.shape, -1)
    case[counted[order]] = shuffled[np.cumsum(new) - 1]
    first = np.empty(shuffled.size, int)
    first[shuffled] = counted[order[new]]  # lexsort keeps the order of equal rows
    spent = np.bincount(case[counted], hours[counted], shuffled.size)
    return case, first, spent


def _taken(values, rows):
    if isinstance(values, dict):
        return {name: np.asarray(v)[rows] for name, v in values.items()}
    return None if values is None else np.asarray(values)[rows]


def series_life(series: Series, solved: Sweep) -> SeriesLife:
    """Use of a life in a record in time (Palmgren, Miner).

    ISO/TS 16281 rates raceways, and rolling elements with them: of these the largest
    load is told. Rings that turn change the places of all rolling elements alike.

    Args:
        series: The record, from `series_cases`.
        solved: `series.cases`, swept with `SERIES_OUTPUTS` among the outputs.

    Returns:
        NaN where a case was not solved; no damage without speeds.
    """
    hours = np.asarray(series.cases.hours)
    turns = revolutions_per_hour(series.cases, np)
    turns = np.zeros(hours.size) if turns is None else turns
    rate = np.where(turns > 0, turns * solved.damage, 0.0 * solved.damage)
    alone = turns[:, None, None] * solved.raceway_damage
    damage = float(hours @ rate)
    counted = series.case >= 0
    case = series.case[counted]
    used = np.zeros(series.case.shape)
    used[counted] = series.hours[counted] * rate[case]
    row = {}
    extremes = {"damage": rate, "static_safety": -solved.static_safety}
    extremes |= {name: getattr(solved, name) for name in SERIES_OUTPUTS[3:]}
    rows = np.flatnonzero(counted)
    for name, values in extremes.items():
        most = np.max(values)
        # Residuals of the solver choose no row.
        alike = values[case] >= most - _SAME * np.abs(most)
        row[name] = int(rows[np.argmax(alike)])
    total = float(hours.sum())
    return SeriesLife(
        hours=total,
        damage=damage,
        raceway_damage=np.tensordot(hours, alone, 1),
        life_hours=total / damage if damage else np.inf * (1.0 + damage),
        row_damage=used,
        static_safety=float(np.min(solved.static_safety)),
        peak_pressure=float(np.max(solved.peak_pressure)),
        largest_load=float(np.max(solved.largest_load)),
        row=row,
    )

"""A record in time as cases: rows with equal numbers are one case, and solved once."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float, Int

from ..design.checks import must_be, of_shape
from ..element.frame import LOADS
from ..numerics.shown import Printable
from ..numerics.types import with_fields
from ..numerics.units import unit
from .cases import Cases
from .spectrum import relative_speed
from .sweep import Sweep

GAPS = "refuse", "leave_out"
"""Treatments of gaps in a record."""

LONG, _NAMED, _SAME = 10.0, 3, 1e-9
"""Length of a step over the median step from which it is a gap [1]; largest number of
gaps that are listed; relative difference below which extremes are equal [1]."""

_EXTREMES = "static_safety", "peak_pressure", "largest_load"
SERIES_OUTPUTS = ("damage", "raceway_damage", *_EXTREMES)
"""Outputs of a sweep that `series_life` needs."""


class Series(Printable):
    """A record in time as cases.

    Attributes:
        cases: Distinct cases with their hours, in random order: a sweep starts its
            solves from the first ones, which should be typical.
        case: Number of the case of each row (time,); -1 where the row does not count.
        hours: Time for which each row holds (time,) [h].
        gaps: Gaps of the record, in words.
    """

    cases: Cases
    case: Int[np.ndarray, " time"]
    hours: Float[np.ndarray, " time"] = eqx.field(metadata=unit("h"))
    gaps: tuple[str, ...] = eqx.field(static=True)


class SeriesLife(Printable):
    """Fatigue damage of a bearing in a record.

    Attributes:
        damage: Damage of the record, the share of the rating life that it uses [1].
        raceway_damage: Damage of each raceway by itself (row, raceway) [1].
        life_hours: Time until the damage is 1 if the record repeats [h].
        row_damage: Damage by each row of the record (time,) [1].
        rows: Number of the first row with the largest damage in an hour, the smallest
            static safety, the largest pressure and rolling-element load, by output.
    """

    damage: float = eqx.field(metadata=unit("1"))
    raceway_damage: Float[np.ndarray, "row raceway=2"] = eqx.field(metadata=unit("1"))
    life_hours: float = eqx.field(metadata=unit("h"))
    row_damage: Float[np.ndarray, " time"] = eqx.field(metadata=unit("1"))
    rows: dict[str, int] = eqx.field(static=True)


def series_cases(
    time: Any,
    cases: Cases,
    *,
    gaps: str = "refuse",
    row_name: Callable[[int], str] = "row {}".format,
) -> Series:
    """Return the distinct cases of a record, each row of which holds until the next.

    The last row holds for the median step. Gaps are steps longer than ten median steps,
    and rows with a number that is not finite.

    Args:
        time: Time of each row, ascending (time,) [s].
        cases: Loads, speeds and other conditions of each row, without hours.
        gaps: "refuse" raises an error for gaps; with "leave_out" a row before a long
            step holds for a median step, and rows that are not finite do not count.
        row_name: Function from the number of a row, from 0, to its name in errors.

    Raises:
        ValueError: For fewer than two rows, times that do not ascend or are not one for
            each row, cases with hours, an unknown `gaps`, and gaps if they are refused.
    """
    allowed = "one of " + ", ".join(map(repr, GAPS))
    must_be("series_cases", "gaps", gaps, gaps in GAPS, allowed)
    none = cases.hours is None
    must_be("series_cases", "cases", "with hours", none, "without: they follow")
    time = np.asarray(time, float)
    allowed = f"({cases.count},), a time for each row, of two at least"
    fits = time.shape == (cases.count,) and cases.count > 1
    of_shape("series_cases", "time", fits, allowed, time)
    columns = _columns(cases)
    hours, told = _hold_rows(time, columns, row_name)
    if told and gaps == "refuse":
        raise ValueError(
            f"series_cases: `time` has gaps: {'; '.join(told)}. Leave them out"
            " (`gaps`)."
        )
    if not hours.any():
        raise ValueError(
            "series_cases: `cases` has no row without a gap; one at least."
        )
    counted = np.flatnonzero(hours > 0)
    keys = [c[counted] for c in columns.values()]
    order = np.lexsort([key for key in keys if np.any(key != key[0])] or keys[:1])
    new = np.ones(counted.size, bool)
    new[1:] = np.any([np.diff(key[order]) != 0 for key in keys], axis=0)
    shuffled = np.random.default_rng(0).permutation(int(new.sum()))
    case = np.full(hours.shape, -1)
    case[counted[order]] = shuffled[np.cumsum(new) - 1]
    first = np.empty(shuffled.size, int)
    first[shuffled] = counted[order[new]]  # lexsort keeps the order of equal rows
    spent = np.bincount(case[counted], hours[counted], shuffled.size)
    taken = jax.tree.map(lambda a: np.asarray(a)[first], cases)
    merged = with_fields(taken, hours=spent)
    return Series(merged, case, hours, told)


def _columns(cases: Cases) -> dict[str, np.ndarray]:
    """Return the numbers of all rows by name; rows at rest share one viscosity."""
    found = {}
    for path, leaf in jax.tree_util.tree_leaves_with_path(cases):
        name = jax.tree_util.keystr(path).strip(".")
        for k, column in enumerate(np.atleast_2d(np.asarray(leaf).T)):
            found[LOADS[k] if name == "load" else f"{name} {k}".rstrip(" 0")] = column
    if "viscosity" in found:
        still = relative_speed(cases) == 0
        oil = np.where(still, 1.0, found.pop("viscosity"))
        found["viscosity, or temperature, of the oil"] = oil
    return found


def _hold_rows(time, columns, row_name):
    """Return the time for which each row holds [h], and the gaps in words."""
    bad, found = np.zeros(time.shape, bool), []
    for name, values in {"time": time, **columns}.items():
        lost = np.flatnonzero(~np.isfinite(values) & ~bad)
        bad[lost] = True
        found += [(k, f"{name} is no finite number") for k in lost]
    rows = np.flatnonzero(np.isfinite(time))
    allowed = "numbers, or instants such as 2024-05-01T12:10, in two rows at least"
    must_be("series_cases", "time", time, rows.size > 1, allowed)
    steps = np.diff(time[rows])
    back = np.flatnonzero(steps <= 0)
    if back.size:
        pair = rows[back[0] : back[0] + 2]
        which = " and ".join(f"{time[k]:.10g} s in {row_name(int(k))}" for k in pair)
        raise ValueError(f"series_cases: `time` is {which}; it must ascend.")
    usual = np.median(steps)
    long = steps > LONG * usual
    for k in np.flatnonzero(long):
        words = f"{steps[k] / 3600.0:.4g} h until the next row, {usual / 3600.0:.4g} h"
        found.append((rows[k], f"{words} are usual"))
    lost = long | (np.diff(rows) > 1)
    held = np.zeros(time.shape)
    held[rows] = np.append(np.where(lost, np.minimum(steps, usual), steps), usual)
    found.sort()
    told = [f"{row_name(int(k))}: {words}" for k, words in found[:_NAMED]]
    more = len(found) - len(told)
    told += [f"and {more} more"] if more else []
    return np.where(bad, 0.0, held) / 3600.0, tuple(told)


def series_life(series: Series, solved: Sweep) -> SeriesLife:
    """Return the fatigue damage of a record, by linear accumulation.

    Args:
        series: The record, from `series_cases`.
        solved: `series.cases`, swept with `SERIES_OUTPUTS` among the outputs.

    Returns:
        SeriesLife, NaN where a case was not solved; rows at rest do no damage.

    Source: Palmgren (1924); Miner (1945). Lives by ISO/TS 16281, which rates raceways,
        the rolling elements included.
    """
    hours = np.asarray(series.cases.hours)
    turns = relative_speed(series.cases) * 1800.0 / np.pi
    rate = turns * solved.damage
    raceways = np.tensordot(hours * turns, solved.raceway_damage, 1)
    damage = float(hours @ rate)
    counted = np.flatnonzero(series.case >= 0)
    case, used, rows = series.case[counted], np.zeros(series.case.shape), {}
    used[counted] = series.hours[counted] * rate[case]
    extremes = {name: getattr(solved, name) for name in _EXTREMES}
    extremes |= {"damage": rate, "static_safety": -solved.static_safety}
    for name, values in extremes.items():
        most = np.max(values)  # solver residuals must not choose the row
        alike = values[case] >= most - _SAME * np.abs(most)
        rows[name] = int(counted[np.argmax(alike)])
    life = hours.sum() / damage if damage else np.inf
    return SeriesLife(damage, raceways, float(life), used, rows)

"""Plots of a design before and after optimisation."""

import dataclasses
from typing import Any

import jax
import numpy as np

from ..design import rows_of
from ..numerics.units import shown_count
from ..optimise import Damage, OptimisedDesign
from ..optimise.measure import AbstractMeasure, AbstractSmooth, label_of
from ..optimise.system import element_of, loads_of
from ..shafts import ShaftDesign
from .panel import ALONG, PRESSURE, Axis, Bars, Curve, Panel
from .profiles import arc_gaps, drop_along
from .style import (
    COLOURS,
    GREY,
    RACEWAYS,
    ROLLER,
    Figure,
    degrees,
    head,
    new_page,
    row_slices,
    without_offset,
)

_FAR = 50.0
"""Longest over shortest life above which the axis is logarithmic."""

_SIDES = {"before": (GREY, "--"), "after": (ROLLER, "-")}


def optimise_overview(found: OptimisedDesign, title: str = "") -> Figure:
    """Plot profile, pressure and history of the search, before and after.

    Top left the profile, roller and the busier raceway together; top right the
    pressure along the roller with the highest pressure, of the case where that was
    before; bottom left the peak pressure of every case, or its life where lives are
    made largest; bottom right the objective over the steps of the search. Balls have no
    profile and no pressure along it. Of a system of shafts bottom left the life, or the
    peak pressure, of each bearing.

    Args:
        found: From `optimise`.
        title: Head of the page.

    Returns:
        The figure, 12 by 8.4 inches; of balls 12 by 4.6.
    """
    shafts = isinstance(found.element, ShaftDesign)
    rollers = False
    if not shafts:
        found = _of_bearings(found)
        first = rows_of(found.element.bearing)[0].bearing
        rollers = first.element_length is not None
    names = "pa;ch" if rollers else "ch"
    figure = new_page(12.0, 8.4 if rollers else 4.6)
    axes = figure.subplot_mosaic(names)
    panels = {"h": _history(found)}
    panels["c"] = _each_bearing(found) if shafts else _cases(found)
    if rollers:
        case, roller, raceway = _worst_contact(found.before.solution)
        panels |= {"p": _profiles(found, roller, raceway), "a": _pressures(found, case)}
    for name, panel in panels.items():
        panel.draw(axes[name])
    head(figure, title or "Optimised design")
    return figure


def _of_bearings(found):
    """Return a copy with bearings and their loads in place of systems."""
    before, after = (
        outcome._replace(solution=loads_of(outcome.solution))
        for outcome in (found.before, found.after)
    )
    pair = element_of(found.initial), element_of(found.element)
    return dataclasses.replace(
        found, initial=pair[0], element=pair[1], before=before, after=after
    )


def _worst_contact(solution):
    """Return case, rolling element and raceway of the highest pressure of rollers."""
    pressure = np.asarray(solution.roller_pressure)
    place = np.unravel_index(np.argmax(pressure), pressure.shape)
    case, roller, raceway = (int(k) for k in place)
    return case, roller, raceway


def _profiles(found, roller, raceway) -> Panel:
    """Return the drop of the pair in the row of a roller, downwards."""
    ring = RACEWAYS[raceway]
    row = next(
        k
        for k, mine in enumerate(row_slices(found.after.solution))
        if mine.start <= roller < mine.stop
    )
    limit, marks = 0.0, []
    for side, element in (("before", found.initial), ("after", found.element)):
        bearing: Any = rows_of(element.bearing)[row].bearing
        along, own = drop_along(bearing, "roller_profile", 801)
        _, drop = drop_along(bearing, f"{ring}_raceway_profile", 801)
        drop = own + drop + arc_gaps(bearing, along)[raceway]
        marks.append(Curve(along, drop, side, *_SIDES[side], {"lw": 2}))
        near = np.abs(along) <= 0.97 * along[-1]
        limit = max(limit, min(float(drop.max()), 3.0 * float(drop[near].max())))
    limit = 1e6 * limit or 1.0

    def flip(ax):
        ax.set_ylim(1.1 * limit, -0.1 * limit)
        ax.margins(x=0)

    title = f"Profile of roller and {ring} raceway"
    return Panel(title, ALONG, Axis("drop", "m"), marks, also=flip)


def _pressures(found, case) -> Panel:
    """Return the pressure along the most loaded roller, in one case."""
    marks = []
    for side, outcome in (("before", found.before), ("after", found.after)):
        one = _case(outcome.solution, case)
        pressure = np.asarray(one.contact_pressure)
        peaks = np.asarray(one.roller_pressure)
        roller, raceway = np.unravel_index(np.argmax(peaks), peaks.shape)
        position = np.asarray(one.position)
        position = position if position.ndim == 1 else position[roller]
        angle = degrees(one.azimuth)[roller]
        label = f"{side}: roller at {angle:.4g}°, {RACEWAYS[raceway]} raceway"
        values, look = pressure[roller, raceway], {"lw": 2}
        marks.append(Curve(position, values, label, *_SIDES[side], look))
    title = f"Pressure along the roller of highest pressure, case {case}"
    wide = lambda ax: ax.margins(x=0)  # noqa: E731
    legend = {"loc": "lower center"}  # curves rise at the ends
    return Panel(title, ALONG, PRESSURE, marks, floor=True, legend=legend, also=wide)


def _cases(found) -> Panel:
    """Return the peak pressure of every case, or its life if it is the objective."""
    wanted = found.objective
    lives = isinstance(wanted, Damage)
    sides = []
    for side, element in (("before", found.initial), ("after", found.element)):
        solution = getattr(found, side).solution
        if lives:
            sides.append(np.asarray(wanted.of_each_case(element, solution)))
        else:
            sides.append(np.asarray(solution.roller_pressure).max(axis=(1, 2)))

    def limits(ax):
        if len(sides[0]) <= 12:
            ax.set_xticks(np.arange(len(sides[0])))
        ax.margins(y=0.25)  # room for the legend
        known = sides[1][np.isfinite(sides[1])]
        if lives and known.size and known.max() > _FAR * known.min():
            ax.set_yscale("log")
            ax.set_ylim(top=20.0 * known.max())  # room for the legend
            without_offset(ax)

    title = "Life under each case alone" if lives else "Peak pressure of the cases"
    unit = "h" if lives and wanted.hours else "revolutions"
    of = Axis("life", unit) if lives else Axis("peak pressure", "Pa")
    labels = _life_label if lives else "%.0f"
    return _pairs(title, Axis("operating case"), of, sides, labels, also=limits)


def _each_bearing(found) -> Panel:
    """Return the life of each bearing of a system of shafts under all cases."""
    names = [seat.name for seat in found.element.system.seats]
    sides = [
        np.asarray(design.hours(found.cases, outcome.solution))
        for design, outcome in (
            (found.initial, found.before),
            (found.element, found.after),
        )
    ]

    def limits(ax):
        ax.set_yscale("log")
        ax.margins(y=0.25)

    title, of = "Life of each bearing under all cases", Axis("rating life", "h")
    more: Any = {"names": names, "also": limits}
    return _pairs(title, Axis(""), of, sides, _life_label, **more)


def _pairs(title, over, of, sides, labels, **more: Any) -> Panel:
    """Return bars before and after, side by side."""
    marks = [
        Bars(
            np.where(np.isfinite(values), values, np.nan), side, _SIDES[side][0], away,
            0.38, labels if len(values) <= 8 else None,
        )
        for side, away, values in zip(_SIDES, (-0.2, 0.2), sides, strict=True)
    ]  # fmt: skip
    legend = {"ncols": 2, "loc": "upper right"}
    return Panel(title, over, of, marks, legend=legend, **more)


def _life_label(value):
    if not np.isfinite(value):
        return "no end"
    if value >= 1e5:
        return f"{1e-3 * value:,.0f}k"
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def _history(found) -> Panel:
    """Return the objective over its start and, if any, the violation of constraints."""
    history, measure = found.history, found.objective
    steps, values = np.arange(len(history.objective)), history.objective
    if isinstance(measure, AbstractMeasure):
        measure, values = measure.reported_as, measure.reported_value(values)
    size = abs(values[0]) or 1.0
    name, look = label_of(measure), {"markersize": 4}
    smooth = "smooth " if isinstance(measure, AbstractSmooth) else ""
    over, of = (
        Axis("step of the search"),
        Axis(f"{smooth}{name}, relative to the start"),
    )
    marks = [Curve(steps, values / size, name, ROLLER, "o-", look)]
    twin = None
    if history.violation.any():
        label, colour = "violation of the worst constraint", COLOURS["inner"]
        missed = [Curve(steps, history.violation, label, colour, "s:", look)]
        twin = Panel(
            "", over, Axis("violation, relative to the bound"), missed, floor=True
        )

    title = f"The search: {shown_count(found.n_evaluations, 'design')} evaluated"
    return Panel(
        title, over, of, marks, twin=twin, legend=None if twin is None else {},
        also=lambda ax: ax.xaxis.get_major_locator().set_params(integer=True),
    )  # fmt: skip


def _case(solution, case):
    return jax.tree.map(lambda leaf: leaf[case], solution)

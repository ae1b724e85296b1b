"""Plots of a design before and after optimisation."""

import dataclasses
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np

from ..design import AbstractRollerBearing, rows_of
from ..optimise.life import Damage
from ..optimise.measure import AbstractMeasure, AbstractSmooth, label_of
from ..optimise.optimise import Optimised
from ..optimise.system import element_of, loads_of
from ..shafts import ShaftDesign
from .profiles import arc_gaps
from .style import (
    COLOURS,
    GREY,
    RACEWAYS,
    ROLLER,
    SMALL,
    degrees,
    head,
    pyplot,
    row_slices,
    without_offset,
)

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

_FAR = 50.0
"""Longest over shortest life above which the axis is logarithmic."""

_SIDES = {"before": (GREY, "--"), "after": (ROLLER, "-")}


def optimised(found: Optimised, title: str = "") -> "matplotlib.figure.Figure":
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
        rollers = isinstance(first, AbstractRollerBearing)
    names = "pa;ch" if rollers else "ch"
    height = 8.4 if rollers else 4.6
    figure = pyplot().figure(figsize=(12.0, height))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    axes = figure.subplot_mosaic(names)
    if rollers:
        case, roller, raceway = worst(found.before.solution)
        _profiles(found, roller, raceway, axes["p"])
        _pressures(found, case, axes["a"])
    if shafts:
        _each_bearing(found, axes["c"])
    else:
        _cases(found, axes["c"])
    _history(found, axes["h"])
    for ax in axes.values():
        ax.grid(color="0.9")
        ax.set_axisbelow(True)
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


def worst(solution: Any) -> tuple[int, int, int]:
    """Return case, rolling element and raceway of the highest pressure of rollers.

    Args:
        solution: With a leading case axis.
    """
    pressure = np.asarray(solution.roller_pressure)
    place = np.unravel_index(np.argmax(pressure), pressure.shape)
    case, roller, raceway = (int(k) for k in place)
    return case, roller, raceway


def _profiles(found, roller, raceway, ax):
    """Plot the drop of the pair [µm] in the row of a roller, downwards."""
    ring = RACEWAYS[raceway]
    row = next(
        k
        for k, mine in enumerate(row_slices(found.after.solution))
        if mine.start <= roller < mine.stop
    )
    limit = 0.0
    for side, element in (("before", found.initial), ("after", found.element)):
        bearing: Any = rows_of(element.bearing)[row].bearing
        length, diameter = bearing.roller_length, bearing.roller_diameter
        # Points gather at the ends, where profiles are steep.
        position = -0.5 * length * jnp.cos(jnp.linspace(0.0, jnp.pi, 801))
        profiles = (bearing.roller_profile, getattr(bearing, f"{ring}_raceway_profile"))
        drops = [p.drop(position, length, diameter) for p in profiles]
        drop = np.sum(drops, axis=0) + arc_gaps(bearing, position)[raceway]
        along = np.asarray(position)
        colour, style = _SIDES[side]
        ax.plot(1e3 * along, 1e6 * drop, style, color=colour, linewidth=2, label=side)
        near = np.abs(along) <= 0.97 * along[-1]
        limit = max(limit, min(float(drop.max()), 3.0 * float(drop[near].max())))
    limit = 1e6 * limit or 1.0
    ax.set_ylim(1.1 * limit, -0.1 * limit)
    ax.margins(x=0)
    ax.set_xlabel("position along the roller [mm]")
    ax.set_ylabel("drop [µm]")
    ax.set_title(f"Profile of roller and {ring} raceway")
    ax.legend(fontsize=SMALL)


def _pressures(found, case, ax):
    """Plot the pressure [MPa] along the most loaded roller, in one case."""
    for side, outcome in (("before", found.before), ("after", found.after)):
        one = _one(outcome.solution, case)
        pressure = np.asarray(one.contact_pressure)
        peaks = np.asarray(one.roller_pressure)
        roller, raceway = np.unravel_index(np.argmax(peaks), peaks.shape)
        position = np.asarray(one.position)
        position = position if position.ndim == 1 else position[roller]
        colour, style = _SIDES[side]
        angle = degrees(one.azimuth)[roller]
        ax.plot(
            1e3 * position,
            1e-6 * pressure[roller, raceway],
            style,
            color=colour,
            linewidth=2,
            label=f"{side}: roller at {angle:.4g}°, {RACEWAYS[raceway]} raceway",
        )
    ax.set_ylim(bottom=0.0)
    ax.margins(x=0)
    ax.set_xlabel("position along the roller [mm]")
    ax.set_ylabel("contact pressure [MPa]")
    ax.set_title(f"Pressure along the most pressed roller, case {case}")
    ax.legend(fontsize=SMALL)


def _cases(found, ax):
    """Plot peak pressure [MPa] of every case, or its life if it is the objective."""
    wanted = found.objective
    lives = isinstance(wanted, Damage)
    sides = {"before": (-0.2, found.initial), "after": (0.2, found.element)}
    for side, (shift, element) in sides.items():
        solution = getattr(found, side).solution
        if lives:
            values = np.asarray(wanted.of_each_case(element, solution))
            values = np.where(np.isfinite(values), values, np.nan)
        else:
            pressure = np.asarray(solution.roller_pressure)
            values = 1e-6 * pressure.max(axis=(1, 2))
        colour, _ = _SIDES[side]
        places = np.arange(len(values)) + shift
        bars = ax.bar(places, values, 0.38, color=colour, label=side)
        if len(values) <= 8:
            fmt = _life_label if lives else "%.0f"
            ax.bar_label(bars, fmt=fmt, fontsize=SMALL, padding=2)
    if len(values) <= 12:
        ax.set_xticks(np.arange(len(values)))
    ax.set_xlabel("operating case")
    ax.margins(y=0.16)
    if lives:
        known = values[np.isfinite(values)]
        if known.size and known.max() > _FAR * known.min():
            ax.set_yscale("log")
            ax.set_ylim(top=20.0 * known.max())  # room for the legend
        without_offset(ax)
        ax.set_ylabel(f"life [{'h' if wanted.hours else 'revolutions'}]")
        ax.set_title("Life under each case alone")
    else:
        ax.set_ylabel("peak pressure [MPa]")
        ax.set_title("Peak pressure of the cases")
    ax.legend(fontsize=SMALL, ncols=2, loc="upper right")


def _each_bearing(found, ax):
    """Plot the life [h] of each bearing of a system of shafts under all cases."""
    names = [seat.name for seat in found.element.system.seats]
    for side, shift in (("before", -0.2), ("after", 0.2)):
        design = found.initial if side == "before" else found.element
        hours = np.asarray(design.hours(found.cases, getattr(found, side).solution))
        values = np.where(np.isfinite(hours), hours, np.nan)
        places = np.arange(len(names)) + shift
        bars = ax.bar(places, values, 0.38, color=_SIDES[side][0], label=side)
        if len(names) <= 8:
            ax.bar_label(bars, fmt=_life_label, fontsize=SMALL, padding=2)
    ax.set_xticks(np.arange(len(names)), names)
    ax.set_yscale("log")
    ax.margins(y=0.25)
    ax.set_ylabel("rating life [h]")
    ax.set_title("Life of each bearing under all cases")
    ax.legend(fontsize=SMALL, ncols=2, loc="upper right")


def _life_label(value):
    if not np.isfinite(value):
        return "no end"
    if value >= 1e5:
        return f"{1e-3 * value:,.0f}k"
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def _history(found, ax):
    """Plot the objective over its start and, if any, the violation of constraints."""
    without_offset(ax)
    history, measure = found.history, found.objective
    steps, values = np.arange(len(history.objective)), history.objective
    if isinstance(measure, AbstractMeasure):
        measure, values = measure.as_told, measure.told(values)
    size = abs(values[0]) or 1.0
    name = label_of(measure)
    ax.plot(steps, values / size, "o-", color=ROLLER, markersize=4, label=name)
    ax.set_xlabel("step of the search")
    smooth = "smooth " if isinstance(measure, AbstractSmooth) else ""
    ax.set_ylabel(f"{smooth}{name} over its start")
    title = f"{found.n_evaluations} designs evaluated"
    ax.set_title(f"The search: {title}")
    ax.xaxis.get_major_locator().set_params(integer=True)
    if history.violation.any():
        other = without_offset(ax.twinx())
        other.plot(
            steps,
            history.violation,
            "s:",
            color=COLOURS["inner"],
            markersize=4,
            label="miss of the worst constraint",
        )
        other.set_ylabel("miss over the bound", color=COLOURS["inner"])
        other.set_ylim(bottom=0.0)
        lines = [*ax.get_lines(), *other.get_lines()]
        ax.legend(lines, [str(line.get_label()) for line in lines], fontsize=SMALL)


def _one(solution, case):
    return jax.tree.map(lambda leaf: leaf[case], solution)

"""Contact pressure along the rollers."""

import numpy as np

from ..statics.solution import RollerSolution
from ..statics.warning_sizes import ends_over
from .panel import ALONG, PRESSURE, finish
from .style import (
    COLOURS,
    SMALL,
    Ax,
    Axes,
    axes_or_new,
    degrees,
    force_text,
    mark_peaks,
    pyplot,
    raceway_index,
    row_slice,
    towards_white,
)

_LINES = {"outer": "--", "inner": "-"}
_MAPS = {"outer": "Blues", "inner": "Oranges"}
_LONG = 0.7
"""Share of the roller from which a contact is long."""


def pressure_profiles(
    solution: RollerSolution,
    ax: Ax = None,
    count: int = 3,
    raceway: str = "inner",
    row: int = 0,
) -> Axes:
    """Plot contact pressure [MPa] along the most loaded rollers.

    A triangle marks a roller end that carries load: the line contact has no end
    pressure peak there.

    Args:
        solution: A single solution of a roller bearing.
        count: Number of rollers, most loaded first.
        raceway: "inner", "outer" or "both".
        row: Index of the row in a set.

    Raises:
        ValueError: If `count` is below 1, or `raceway` or `row` is unknown.
    """
    if count < 1:
        raise ValueError(f"`count` is {count}; it must be at least 1.")
    names = ("inner", "outer") if raceway == "both" else (raceway,)
    rings = np.array([raceway_index(name) for name in names])
    ax = axes_or_new(ax)
    mine = row_slice(solution, row)
    position = _position(solution, mine)
    pressure = PRESSURE.scale * np.asarray(solution.contact_pressure)[mine]
    load = np.asarray(solution.roller_load)[mine]
    angle = degrees(solution.azimuth)[mine]
    edges = np.asarray(ends_over(solution))[mine]
    # Equal loads (to 1 ppm) by azimuth.
    total = load[:, rings].sum(axis=1)
    scale = np.max(total, initial=0.0) or 1.0
    rollers = np.lexsort((angle, -np.round(total / scale, 6)))[:count]
    for name, ring in zip(names, rings, strict=True):
        for rank, roller in enumerate(rollers):
            fade = 0.6 * rank / max(len(rollers) - 1, 1)
            colour = towards_white(COLOURS[name], fade)
            label = f"{angle[roller]:.4g}°: {force_text(float(load[roller, ring]))}"
            ax.plot(
                position,
                pressure[roller, ring],
                color=colour,
                linestyle=_LINES[name],
                # The most loaded roller on top of wider, paler lines.
                linewidth=1.6 + 2.4 * fade,
                zorder=3 - 0.01 * rank,
                label=label if len(names) == 1 else f"{name}, {label}",
            )
            ends = np.flatnonzero(edges[roller, ring])
            x, y = position[[0, -1]][ends], pressure[roller, ring][[0, -1]][ends]
            rim = {"markeredgecolor": "black", "markeredgewidth": 0.6, "zorder": 4}
            mark_peaks(ax, x, y, colour, "edge", **rim)
    ax.set_xlim(position[0], position[-1])
    shown = pressure[np.ix_(rollers, rings)]
    top = np.nanmax(shown, initial=0.0)
    # Under a long contact there is room for the legend, else above.
    short = np.mean(np.any(shown > 0.0, axis=(0, 1))) < _LONG
    ax.set_ylim(0.0, (1.8 if short else 1.08) * top if top > 0 else 1.0)
    which = "" if raceway == "both" else f", {raceway} raceway"
    title = f"Most loaded rollers{which}{_of_row(solution, row)}"
    finish(ax, title, ALONG.label, PRESSURE.label)
    title = "azimuth: load"
    if np.any(edges[np.ix_(rollers, rings)]):
        title += "\n▲ loaded roller end"
    loc = "upper center" if short else "best"
    ax.legend(title=title, fontsize=SMALL, title_fontsize=SMALL, loc=loc)
    return ax


def _of_row(solution, row):
    return f", row {row}" if len(solution.row_sizes) > 1 else ""


def _position(solution, mine):
    """Return positions along the rollers of a row [mm]."""
    position = ALONG.scale * np.asarray(solution.position)
    return position if position.ndim == 1 else position[mine.start]


def pressure_map(
    solution: RollerSolution,
    ax: Ax = None,
    raceway: str = "inner",
    row: int = 0,
    top: float | None = None,
) -> Axes:
    """Map contact pressure [MPa] of all rollers over azimuth and roller position.

    White is no contact, or less than a thousandth of the highest pressure.

    Args:
        solution: A single solution of a roller bearing.
        raceway: "inner" or "outer".
        row: Index of the row in a set.
        top: Pressure at the end of the colour scale [Pa]; the highest one of the row
            on this raceway if `None`. Give one to compare raceways.

    Returns:
        The axes; the colour bar is next to it.

    Raises:
        ValueError: If `raceway` or `row` is unknown.
    """
    ring = raceway_index(raceway)
    ax = axes_or_new(ax, (8.0, 4.5))
    mine = row_slice(solution, row)
    angle = degrees(solution.azimuth)[mine]
    order = np.argsort(angle, kind="stable")
    pressure = PRESSURE.scale * np.asarray(solution.contact_pressure)[mine, ring]
    position = _position(solution, mine)
    top = np.nanmax(pressure, initial=0.0) if top is None else PRESSURE.scale * top
    # Last and first roller stand on both sides of the seam at 0°.
    around = np.concatenate([order[-1:], order, order[:1]])
    turns = np.concatenate([[-360.0], np.zeros(len(order)), [360.0]])
    across, along = _edges(angle[around] + turns), _edges(position)
    shown = pressure[around].T
    image = ax.pcolormesh(
        across,
        along,
        np.ma.masked_where(~(shown > 1e-3 * top), shown),
        cmap=pyplot().get_cmap(_MAPS[raceway]),
        vmin=0.0,
        vmax=top if top > 0 else 1.0,
        rasterized=True,
    )
    if len(angle) <= 40:
        ax.vlines(across, position[0], position[-1], color="0.85", linewidth=0.6)
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02)
    bar.set_label(PRESSURE.label)
    ax.set_xticks(np.arange(0.0, 361.0, 45.0))
    ax.set_xlim(0.0, 360.0)
    ax.set_ylim(position[0], position[-1])
    ax.set_xlabel("azimuth of the roller [deg]")
    ax.set_ylabel(ALONG.label)
    ax.set_title(f"Contact pressure, {raceway} raceway{_of_row(solution, row)}")
    return ax


def _edges(centres):
    """Return edges of the cells around ascending centres."""
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate(
        [[2.0 * centres[0] - middle[0]], middle, [2.0 * centres[-1] - middle[-1]]]
    )

"""Pressure and load per length along a roller, compared with slices."""

from collections.abc import Sequence

import numpy as np

from ..contact.halfspace import ContactSolution
from ..contact.slices import Slices
from .panel import ALONG, finish
from .style import (
    BOX,
    GREY,
    OUTER,
    SMALL,
    Ax,
    Axes,
    axes_or_new,
    force_text,
    mark_peaks,
    towards_white,
    write,
)

_NEAR = 0.02
"""Share of the length at each end that is ignored for the scale."""

_SHARP = 1.5
"""End values so many times above the scale are left out of it."""

_SLICES = "slices"


def centre_pressure(
    solutions: Sequence[ContactSolution],
    ax: Ax = None,
    slices: Sequence[Slices] = (),
) -> Axes:
    """Plot the pressure [MPa] at x = 0 along the roller, for several loads.

    The legend gives the values of the end cells, and their length. A triangle marks
    those off the scale.

    Args:
        solutions: Solutions of one roller.
        slices: Results of slices under each load, dashed.
    """
    ax = axes_or_new(ax, (8.0, 5.0))
    values = [1e-6 * np.asarray(s.centre_pressure) for s in solutions]
    others = [1e-6 * np.asarray(s.pressure) for s in slices]
    _lines(solutions, values, others, ax, ends)
    label = "contact pressure at x = 0 [MPa]"
    finish(ax, "Pressure along the roller", ALONG.label, label)
    ax.legend(
        title=f"load: pressure in the end cells, {end_length(solutions[0])} long [MPa]",
        ncols=1 if len(solutions) < 3 else 2,
        fontsize=SMALL,
        title_fontsize=SMALL,
        loc="lower center",
    )
    return ax


def contact_line_load(
    solutions: Sequence[ContactSolution],
    ax: Ax = None,
    slices: Sequence[Slices] = (),
) -> Axes:
    """Plot the load per length [N/mm] along the roller, for several loads.

    Each line is labelled with its load.

    Args: as `centre_pressure`.
    """
    ax = axes_or_new(ax, (8.0, 5.0))
    values = [1e-3 * np.asarray(s.line_load) for s in solutions]
    others = [1e-3 * np.asarray(s.line_load) for s in slices]
    _lines(solutions, values, others, ax, None)
    title = "Load per length along the roller"
    finish(ax, title, ALONG.label, "load per length [N/mm]")
    dashed = [line for line in ax.get_lines() if line.get_label() == _SLICES]
    if dashed:
        ax.legend(handles=dashed, fontsize=SMALL, loc="lower center")
    return ax


def _lines(solutions, values, others, ax, labelled):
    """A line for each load, and that of the slices; off the scale: a triangle."""
    edges = 1e3 * np.asarray(solutions[0].grid.edges)
    top, _ = scale(solutions[0], np.max([*values, *others], axis=0))
    loads = [float(s.load) for s in solutions]
    shades = np.linspace(0.6, 0.0, len(loads)) if len(loads) > 1 else [0.0]
    fade = dict(zip(np.argsort(loads).tolist(), shades, strict=True))
    for k, (solution, line) in enumerate(zip(solutions, values, strict=True)):
        y = 1e3 * np.asarray(solution.grid.y)
        colour = towards_white(OUTER, fade[k])
        if others:
            ax.plot(y, others[k], "--", color=GREY, linewidth=1.0, label="_slices")
        label = load_text(solution)
        if labelled is None:
            ground = BOX | {"pad": 1.5, "alpha": 0.8}
            write(ax, (0.0, np.interp(0.0, y, line)), label, bbox=ground)
        else:
            label += f": {labelled(solution)}"
        ax.plot(y, line, color=colour, linewidth=1.8, label=label)
        high = y[[0, -1]][line[[0, -1]] > 1.1 * top]
        mark_peaks(ax, high, np.full(high.size, 1.1 * top), colour, "off the scale")
    if others:
        ax.plot([], [], "--", color=GREY, linewidth=1.0, label=_SLICES)
    ax.set_xlim(edges[0], edges[-1])
    ax.set_ylim(0.0, 1.1 * top)


def scale(
    solution: ContactSolution, largest: np.ndarray, floor: float = 1.0
) -> tuple[float, bool]:
    """Return the top of a scale, and whether values near the ends exceed it.

    Args:
        solution: For its cells.
        largest: Largest value at each place along the roller (n,).
        floor: Top where all is zero.
    """
    y = np.asarray(solution.grid.y)
    edges = np.asarray(solution.grid.edges)
    length = edges[-1] - edges[0]
    inner = (y > edges[0] + _NEAR * length) & (y < edges[-1] - _NEAR * length)
    top = np.max(largest[inner], initial=0.0)
    if top <= 0 or largest.max() <= _SHARP * top:
        return max(float(largest.max()), floor), False
    return float(top), True


def ends(solution: ContactSolution) -> str:
    """Return the pressure at x = 0 of both end cells [MPa], as text."""
    first, last = 1e-6 * np.asarray(solution.centre_pressure)[[0, -1]]
    return f"{first:.0f}, {last:.0f}"


def load_text(solution: ContactSolution) -> str:
    """Return the load as text."""
    return force_text(float(solution.load))


def end_length(solution: ContactSolution) -> str:
    """Return the length of an end cell as text."""
    return f"{2e6 * float(solution.grid.half_y[0]):.3g} µm"

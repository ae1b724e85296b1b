"""Pressure between a roller and a raceway, cell by cell, and the stress below it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.halfspace import ContactSolution, stress_below
from ..contact.slices import Slices
from .panel import ALONG, finish
from .style import (
    BOX,
    GREY,
    OUTER,
    SMALL,
    Ax,
    Axes,
    Figure,
    axes_or_new,
    force_text,
    head,
    mark_peaks,
    new_page,
    pyplot,
    towards_white,
    write,
    write_foot,
)

if TYPE_CHECKING:
    import mpl_toolkits.mplot3d.axes3d

_MAP = "viridis"


def contact_overview(
    solutions: Sequence[ContactSolution],
    slices: Sequence[Slices],
    title: str = "",
) -> Figure:
    """Plot pressure over the contact, and along the roller compared with slices.

    Args:
        solutions: Solutions of one roller under one load or several.
        slices: Results of slices under each.
        title: Head of the page.

    Returns:
        The figure, 12 by 9 inches; the map is of the largest load.
    """
    figure = new_page(12.0, 9.0)
    axes = figure.subplot_mosaic(
        [["map", "map"], ["pressure", "load"], ["text", "text"]],
        height_ratios=[0.8, 1.0, 0.12],
    )
    most = int(np.argmax([float(s.load) for s in solutions]))
    contact_map(solutions[most], axes["map"])
    centre_pressure(solutions, axes["pressure"], slices=slices)
    contact_line_load(solutions, axes["load"], slices=slices)
    axes["text"].set_axis_off()
    where = {"transform": axes["text"].transAxes, "in_layout": False}
    write_foot(axes["text"], _results(solutions[most], slices[most]), **where)
    head(figure, title or "Roller on raceway")
    return figure


def contact_map(solution: ContactSolution, ax: Ax = None) -> Axes:
    """Map the pressure [MPa] over the contact, stretched across the roller.

    White is no contact. End cells that are pressed far more than the rest are off the
    _scale of colours; the head gives their value and length.

    Args:
        solution: A single solution.

    Returns:
        The axes; the colour bar is next to it.
    """
    ax = axes_or_new(ax, (9.0, 4.0))
    x, pressure = _unfold(solution)
    grid = solution.grid
    edges = 1e3 * np.asarray(grid.edges)
    cell = 1e6 * float(grid.half_x)
    across = np.append(1e6 * x - cell, 1e6 * x[-1] + cell)
    top, cut = _scale(solution, pressure.max(axis=0))
    image = ax.pcolormesh(
        edges,
        across,
        np.ma.masked_where(~(pressure > 0), pressure),
        cmap=pyplot().get_cmap(_MAP),
        vmin=0.0,
        vmax=top,
        rasterized=True,
    )
    bar = ax.figure.colorbar(
        image, ax=ax, pad=0.02, extend="max" if cut else "neither", extendfrac=0.03
    )
    bar.set_label("contact pressure [MPa]")
    touched = np.abs(1e6 * x[pressure.max(axis=1) > 0])
    reach = min(1.15 * (touched.max(initial=cell) + cell), across[-1])
    ax.set_ylim(-reach, reach)
    ax.set_xlim(edges[0], edges[-1])
    ax.set_xlabel("position along the roller [mm]")
    ax.set_ylabel("across the roller [µm]")
    ax.set_title(
        f"Contact pressure under {_load_text(solution)};"
        f" end cells of {_end_length(solution)}: {_ends(solution)} MPa"
    )
    return ax


def contact_surface(
    solution: ContactSolution, ax: Any = None
) -> "mpl_toolkits.mplot3d.axes3d.Axes3D":
    """Plot the pressure [MPa] as a surface above the contact.

    Drawn up to the _scale of `contact_map`, where the _ends may be cut off.

    Args:
        solution: A single solution.
        ax: Axes with three dimensions; a new figure if `None`.

    Raises:
        ValueError: If `ax` has two dimensions.
    """
    if ax is None:
        figure = pyplot().figure(figsize=(9.0, 5.5))
        ax = figure.add_axes((0.0, 0.05, 0.95, 0.92), projection="3d")
    if ax.name != "3d":
        raise ValueError('contact_surface needs axes of subplot(projection="3d").')
    x, pressure = _unfold(solution)
    top, cut = _scale(solution, pressure.max(axis=0))
    y = 1e3 * np.asarray(solution.grid.y)
    touched = np.flatnonzero(pressure.max(axis=1) > 0)
    # One cell of no contact on either side.
    first, last = (touched[0] - 1, touched[-1] + 2) if touched.size else (0, x.size)
    rows = slice(max(first, 0), last)
    along, across = np.meshgrid(y, 1e6 * x[rows])
    ax.plot_surface(
        along,
        across,
        np.minimum(pressure[rows], top),
        cmap=pyplot().get_cmap(_MAP),
        vmin=0.0,
        vmax=top,
        rcount=200,
        ccount=200,
        linewidth=0.2,
        edgecolor=(0.0, 0.0, 0.0, 0.35),
        antialiased=True,
    )
    ax.set_xlabel("position along the roller [mm]", labelpad=18)
    ax.set_ylabel("across the roller [µm]", labelpad=8)
    ax.set_zlabel("contact pressure [MPa]", labelpad=8)
    ax.set_zlim(0.0, top)
    ax.set_box_aspect((2.2, 1.0, 1.0), zoom=1.1)
    ax.yaxis.get_major_locator().set_params(nbins=4)
    ax.view_init(elev=28, azim=-62)
    ax.set_title(
        f"Contact pressure under {_load_text(solution)}; end cells of"
        f" {_end_length(solution)}: {_ends(solution)} MPa{', cut off' if cut else ''}",
        y=0.98,
    )
    return ax


def _unfold(solution):
    """Return cell centres across (m,) [m], and pressure on both sides (m, n) [MPa]."""
    grid = solution.grid
    x = (
        2.0
        * float(grid.half_x)
        * (np.arange(grid.n_across) - 0.5 * grid.n_across + 0.5)
    )
    return x, 1e-6 * np.asarray(grid.unfold(solution.pressure))


def _results(solution, slices):
    """Return two lines of text on the largest load."""
    peak = 1e-6 * float(solution.peak_pressure)
    sliced = 1e-6 * float(slices.peak_pressure)
    place = int(np.argmax(np.asarray(solution.pressure).max(axis=0)))
    grid = solution.grid
    factor = f"{peak / sliced:.3g} times" if sliced > 0 else "no contact:"
    return (
        f"under {_load_text(solution)}:  approach"
        f" {1e6 * float(solution.approach):.4g} µm,  tilt"
        f" {1e3 * float(solution.tilt):.4g} mrad,  moment"
        f" {float(solution.moment):.4g} N m\n"
        f"peak {peak:.0f} MPa at {1e3 * float(grid.y[place]):.4g} mm, in a cell"
        f" {2e6 * float(grid.half_y[place]):.3g} µm long:  {factor} that of the"
        f" slices, {sliced:.0f} MPa"
    )


_NEAR = 0.02
"""Share of the length at each end that is ignored for the _scale."""

_SHARP = 1.5
"""End values so many times above the _scale are left out of it."""

_SLICES = "slices"


def centre_pressure(
    solutions: Sequence[ContactSolution],
    ax: Ax = None,
    slices: Sequence[Slices] = (),
) -> Axes:
    """Plot the pressure [MPa] at x = 0 along the roller, for several loads.

    The legend gives the values of the end cells, and their length. A triangle marks
    those off the _scale.

    Args:
        solutions: Solutions of one roller.
        slices: Results of slices under each load, dashed.
    """
    ax = axes_or_new(ax, (8.0, 5.0))
    values = [1e-6 * np.asarray(s.centre_pressure) for s in solutions]
    others = [1e-6 * np.asarray(s.pressure) for s in slices]
    _lines(solutions, values, others, ax, _ends)
    cell, label = _end_length(solutions[0]), "contact pressure at x = 0 [MPa]"
    finish(ax, "Pressure along the roller", ALONG.label, label)
    ax.legend(
        title=f"load: pressure in the end cells, {cell} long [MPa]",
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
    """A line for each load, and that of the slices; off the _scale: a triangle."""
    edges = 1e3 * np.asarray(solutions[0].grid.edges)
    top, _ = _scale(solutions[0], np.max([*values, *others], axis=0))
    loads = [float(s.load) for s in solutions]
    shades = np.linspace(0.6, 0.0, len(loads)) if len(loads) > 1 else [0.0]
    fade = dict(zip(np.argsort(loads).tolist(), shades, strict=True))
    for k, (solution, line) in enumerate(zip(solutions, values, strict=True)):
        y = 1e3 * np.asarray(solution.grid.y)
        colour = towards_white(OUTER, fade[k])
        if others:
            ax.plot(y, others[k], "--", color=GREY, linewidth=1.0, label="_slices")
        label = _load_text(solution)
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


def _scale(solution, largest, floor=1.0):
    """Return the top of a _scale, and whether values near the _ends exceed it."""
    y = np.asarray(solution.grid.y)
    edges = np.asarray(solution.grid.edges)
    length = edges[-1] - edges[0]
    inner = (y > edges[0] + _NEAR * length) & (y < edges[-1] - _NEAR * length)
    top = np.max(largest[inner], initial=0.0)
    if top <= 0 or largest.max() <= _SHARP * top:
        return max(float(largest.max()), floor), False
    return float(top), True


def _ends(solution):
    """Return the pressure at x = 0 of both end cells [MPa], as text."""
    first, last = 1e-6 * np.asarray(solution.centre_pressure)[[0, -1]]
    return f"{first:.0f}, {last:.0f}"


def _load_text(solution):
    """Return the load as text."""
    return force_text(float(solution.load))


def _end_length(solution):
    """Return the length of an end cell as text."""
    return f"{2e6 * float(solution.grid.half_y[0]):.3g} µm"


_POINTS = 61, 41
STRESSES = {"von_mises": "von Mises stress", "greatest_shear": "largest shear stress"}
SECTIONS = ("across", "along")


def contact_stress(
    solution: ContactSolution,
    ax: Ax = None,
    *,
    section: str = "across",
    y: float | None = None,
    kind: str = "von_mises",
    poisson: float = 0.3,
) -> Axes:
    """Plot von Mises or largest shear stress [MPa] in a section below the contact.

    The depth is three half widths of the contact. A cross marks the largest value
    drawn; the first tenth of a half width below the surface, where the steps of the
    pressure are visible, is left out.

    Args:
        solution: A single solution with a contact.
        section: "across" the roller, or "along" it at x = 0.
        y: Position of the "across" section [m]; `None`: at the centre of the load.
        kind: "von_mises" or "greatest_shear".
        poisson: Poisson's ratio of the body [1].

    Returns:
        The axes; the colour bar is next to it.

    Raises:
        ValueError: For another section or kind, or without a contact.
    """
    if section not in SECTIONS:
        raise ValueError(f"`section` is {section!r}; it must be 'across' or 'along'.")
    if kind not in STRESSES:
        raise ValueError(
            f"`kind` is {kind!r}; it must be one of {', '.join(STRESSES)}."
        )
    grid, pressure = solution.grid, np.asarray(solution.pressure)
    if not pressure.any():
        raise ValueError("contact_stress: there is no contact, and no stress.")
    y = float(solution.moment / solution.load) if y is None else y
    cells = np.abs(np.asarray(grid.x))[(pressure > 0).any(axis=1)]
    half_width = float(cells.max() + grid.half_x)
    z = np.linspace(0.1, 3.0, _POINTS[1]) * half_width
    if section == "across":
        places = np.linspace(-2.0, 2.0, _POINTS[0]) * half_width
        x, along, unit = places, np.full_like(places, y), 1e6
    else:
        places = along = np.asarray(grid.y)
        x, unit = np.zeros_like(along), 1e3
    found = stress_below(solution, x[:, None], along[:, None], z[None], poisson)
    values = 1e-6 * np.asarray(getattr(found, kind))
    ax = axes_or_new(ax, (8.0, 4.5))
    image = ax.contourf(unit * places, 1e6 * z, values.T, 20, cmap="viridis")
    ax.figure.colorbar(image, ax=ax, pad=0.02).set_label(f"{STRESSES[kind]} [MPa]")
    i, k = np.unravel_index(values.argmax(), values.shape)
    ax.plot(unit * places[i], 1e6 * z[k], "+", color="white", markersize=10)
    ax.invert_yaxis()
    ax.set_ylabel("depth [µm]")
    where = f"x = 0, largest {values.max():.0f} MPa"
    if section == "across":
        ax.set_aspect("equal")
        ax.set_xlabel("across the roller [µm]")
        where = f"at {1e3 * y:.4g} mm, largest {values.max():.0f} MPa"
    else:
        ax.set_xlabel("position along the roller [mm]")
    ax.set_title(
        f"{STRESSES[kind][0].upper()}{STRESSES[kind][1:]} under {_load_text(solution)}:"
        f" {where} in {1e6 * z[k]:.3g} µm"
    )
    return ax

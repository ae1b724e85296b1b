"""Pressure between a roller and a raceway, cell by cell, ends included."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.halfspace import ContactSolution
from ..contact.slices import Slices
from .contact_lines import (
    centre_pressure,
    contact_line_load,
    end_length,
    ends,
    load_text,
    scale,
)
from .style import Ax, Axes, Figure, axes_or_new, head, new_page, pyplot, write_foot

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
    scale of colours; the head gives their value and length.

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
    top, cut = scale(solution, pressure.max(axis=0))
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
        f"Contact pressure under {load_text(solution)};"
        f" end cells of {end_length(solution)}: {ends(solution)} MPa"
    )
    return ax


def contact_surface(
    solution: ContactSolution, ax: Any = None
) -> "mpl_toolkits.mplot3d.axes3d.Axes3D":
    """Plot the pressure [MPa] as a surface above the contact.

    Drawn up to the scale of `contact_map`, where the ends may be cut off.

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
    top, cut = scale(solution, pressure.max(axis=0))
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
        f"Contact pressure under {load_text(solution)}; end cells of"
        f" {end_length(solution)}: {ends(solution)} MPa{', cut off' if cut else ''}",
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
        f"under {load_text(solution)}:  approach"
        f" {1e6 * float(solution.approach):.4g} µm,  tilt"
        f" {1e3 * float(solution.tilt):.4g} mrad,  moment"
        f" {float(solution.moment):.4g} N m\n"
        f"peak {peak:.0f} MPa at {1e3 * float(grid.y[place]):.4g} mm, in a cell"
        f" {2e6 * float(grid.half_y[place]):.3g} µm long:  {factor} that of the"
        f" slices, {sliced:.0f} MPa"
    )

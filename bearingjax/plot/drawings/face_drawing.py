"""View of a row of rolling elements along the axis, and their deviations."""

from typing import Any

import numpy as np

from ...design import AbstractBearing
from ..style import (
    CURVES,
    ELEMENT,
    GREY,
    RACEWAYS,
    SMALL,
    Axes,
    Size,
    axes_or_new,
    write,
)
from .dimension import AXIS, angle, between, fit_view, label, write_aside

DEVIATIONS = {
    "azimuth_deviation": (180.0 / np.pi, "deg"),
    "ball_deviation": (1e6, "µm"),
    "roller_deviation": (1e6, "µm"),
    "raceway_deviation": (1e6, "µm"),
}
"""Factor and unit of fields that differ between rolling elements."""


def face_view(ax: Axes, bearing: AbstractBearing, size: Size) -> None:
    """Draw the pitch circle and its rolling elements along the axis, to scale.

    Args:
        ax: Axes.
        bearing: A single row.
        size: Width and height of the axes [inch].
    """
    from matplotlib.patches import Circle

    pitch = 0.5e3 * float(bearing.pitch_diameter)
    word = bearing.noun
    count, first = bearing.n_elements, float(bearing.first_azimuth)
    azimuth = first + 2.0 * np.pi * np.arange(count) / count
    if bearing.azimuth_deviation is not None:
        azimuth = azimuth + np.asarray(bearing.azimuth_deviation)
    centres = pitch * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
    shape = _axial_outline(bearing)
    for turn in azimuth:
        way = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        place = way[0] * pitch + shape @ way
        ax.fill(*place.T, zorder=3, **ELEMENT)
    own = shape[:, 0].max()
    ax.add_patch(Circle((0.0, 0.0), pitch, fill=False, **AXIS))
    reach = pitch + own
    # Towards the upper left, between two rolling elements.
    gaps = azimuth + np.pi / count
    turn = gaps[np.argmax(np.cos(gaps - 0.75 * np.pi))]
    way = np.array([np.cos(turn), np.sin(turn)])
    across = between(ax, -pitch * way, pitch * way) + 0.75 * pitch * way
    half = "" if count == getattr(bearing, f"n_{word}s") else "\nhere every other one"
    start = angle(ax, (0.0, 0.0), 0.55 * pitch, (0.0, first))
    ground = ELEMENT | {"edgecolor": "none", "pad": 1.0}
    write(ax, centres[0], "0", bbox=ground, zorder=6)
    corners = {
        "lower right": (f"{label(bearing, 'first_azimuth')}, of {word} 0", start),
        "upper left": (label(bearing, "pitch_diameter"), across),
        "upper right": (
            label(bearing, f"n_{word}s") + half,
            centres[np.argmax(centres.sum(axis=1))],
        ),
    }
    fit_view(ax, np.array([[-1.0, -1.0], [1.0, 1.0]]) * reach, size, (0.78, 0.84))
    for corner, (text, at) in corners.items():
        _in_corner(ax, corner, text, at)
    for end, name in (((1.12 * reach, 0.0), "x"), ((0.0, 1.12 * reach), "y")):
        ax.annotate("", end, (0.0, 0.0), arrowprops={"arrowstyle": "->", "color": GREY})
        offset = (5, -3) if name == "y" else (4, 4)
        ax.annotate(name, end, offset, textcoords="offset points", color=GREY)
    ax.set_title(f"{word.capitalize()}s, seen against z, to scale")


def _axial_outline(bearing):
    """Outline of a rolling element along the axis (point, 2), radial coordinate first,
    from its centre [mm]."""
    turn = np.linspace(0.0, 2.0 * np.pi, 60)
    circle = 0.5e3 * float(bearing.element_diameter)
    circle = circle * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    if bearing.is_ball or not float(bearing.axis_angle):
        return circle
    from scipy.spatial import ConvexHull

    lean, half = float(bearing.axis_angle), float(bearing.half_angle)
    discs, flat = [], np.array([np.cos(lean), 1.0])
    for side in (-1.0, 0.0, 1.0):
        along = 0.5e3 * side * float(bearing.roller_length)
        size = 1.0 - along * np.sin(half) / circle[0, 0]
        size -= abs(side) * 1e3 * bearing.end_drop() / circle[0, 0]
        middle = np.array([-along * np.sin(lean), 0.0])
        discs.append(middle + size * circle * flat)
    points = np.concatenate(discs)
    return points[ConvexHull(points).vertices]


def _in_corner(ax, corner, text, at):
    """Write text in a corner of the axes, with a line to a point."""
    low, left = corner.startswith("lower"), corner.endswith("left")
    corner = 0.01 if left else 0.99, 0.01 if low else 0.97
    side: Any = {"ha": "left" if left else "right", "va": "bottom" if low else "top"}
    write_aside(ax, at, corner, text, (0.5, 1.0 if low else 0.0), **side)


def deviation_view(ax: Axes, bearing: AbstractBearing, name: str) -> None:
    """Plot the deviations of each rolling element from the design.

    Args:
        ax: Axes.
        bearing: A single row.
        name: One of `DEVIATIONS`, which the bearing has.
    """
    ax = axes_or_new(ax)
    factor, unit = DEVIATIONS[name]
    values = factor * np.asarray(getattr(bearing, name))
    number = np.arange(len(values))
    if values.ndim == 1:
        ax.stem(number, values, basefmt=" ")
        ax.axhline(0.0, color=GREY, linewidth=0.8)
    else:
        places = ("along z", "outwards", "raised")
        for k, ring in enumerate(RACEWAYS):
            for m, place in enumerate(places):
                ax.plot(
                    number,
                    values[:, k, m],
                    ("-o", "--s")[k],
                    color=CURVES[m],
                    markersize=3,
                    label=f"{ring}, {place}",
                )
        ax.legend(fontsize=SMALL, ncols=2)
    ax.locator_params(axis="x", integer=True)
    ax.grid(color="0.9")
    ax.set_xlabel("number of the rolling element")
    ax.set_ylabel(f"deviation [{unit}]")
    ax.set_title(f"{name}: of each rolling element", fontsize=11)

"""The arrangement of the rows of a set."""

from typing import TYPE_CHECKING

import numpy as np

from ..design import AbstractBallBearing, BearingSet, is_self_aligning
from .ball_section import ball_row, row_position
from .dimension import AXIS, Label, between, fit, label, put_labels, quantity
from .outline import section
from .roller_section import roller_row
from .style import INNER

if TYPE_CHECKING:
    import matplotlib.axes


def arrangement_view(
    ax: "matplotlib.axes.Axes", bearing: BearingSet, turned: list[int], size
) -> None:
    """Axial section of all rows, to scale, with the numbers of each row of the set.

    Args:
        ax: Axes.
        bearing: The set.
        turned: Rows whose first azimuth is to be told here.
        size: Width and height of the axes [inch].
    """
    outlines = [_draw(ax, row, bearing) for row in bearing.rows]
    points = np.concatenate(outlines)
    (left, low), (right, high) = points.min(axis=0), points.max(axis=0)
    tall = high - low
    labels = []
    for k, (row, outline) in enumerate(zip(bearing.rows, outlines, strict=True)):
        place = 1e3 * float(row.position)
        below = np.array([0.0, -tall * (0.12 + 0.14 * k)])
        middle = between(ax, (0.0, low), (place, low), below)
        name = f"rows.{k}."
        centre = outline.mean(axis=0)
        sign = -1.0 if float(row.inner_offset) < 0.0 else 1.0
        push = centre + np.array([0.0, -0.42 * tall])
        told = ""
        if float(row.inner_offset) != 0.0:
            told = ", arrow not to scale"
            way = np.array([0.5 * sign * 0.2 * tall, 0.0])
            arrow = {"arrowstyle": "-|>", "color": INNER, "linewidth": 2.0}
            ax.annotate("", push + way, push - way, arrowprops=arrow, zorder=6)
        labels += [
            Label(f"{name}bearing: {type(row.bearing).__name__}, below", centre),
            Label(label(row, "position", name), middle),
            Label(label(row, "mirrored", name), centre + (0.0, 0.3 * tall)),
            Label(label(row, "inner_offset", name) + told, push),
            Label(_spring(row, name), centre + (0.0, 0.1 * tall)),
        ]
        if k in turned:
            text = label(row.bearing, "first_azimuth", f"{name}bearing.")
            labels.append(Label(text, centre + (0.0, 0.2 * tall)))
    depth = low - tall * (0.2 + 0.14 * len(bearing.rows))
    ax.plot([0.0, 0.0], [depth, high + 0.1 * tall], **AXIS)
    fit(ax, [(left, depth), (right, high + 0.1 * tall)], size, (0.42, 0.92))
    put_labels(ax, labels, size)
    ax.set_title(f"{_arrangement(bearing)}; section to scale, ring bodies schematic")


def _draw(ax, row, bearing):
    """Draw a row; corners of what it takes (point, 2)."""
    sign = -1.0 if row.mirrored else 1.0
    part = row.bearing
    if isinstance(part, AbstractBallBearing):
        radius = 0.5e3 * float(part.pitch_diameter)
        centre = np.array([row_position(row), radius])
        places = np.sort([row_position(one) for one in bearing.rows])
        reach = 0.49 * np.diff(places).min() if len(places) > 1 else np.inf

        def place(points):
            return centre + np.asarray(points) * np.array([sign, 1.0])

        return ball_row(ax, part, place, reach)

    def turned(points):
        return np.asarray(points) * np.array([sign, 1.0]) + np.array(
            [1e3 * float(row.position), 0.0]
        )

    return roller_row(ax, section(part), turned)


def _spring(row, name):
    if row.spring is None:
        return f"{name}spring: not given"
    force, stiffness = (
        label(row.spring, field, "") for field in ("force", "stiffness")
    )
    return f"{name}spring: {force}, {stiffness}"


def _arrangement(bearing):
    """What the arrangement is called, and the spacing of its rows."""
    rows = sorted(bearing.rows, key=_place)
    spacing = np.diff([_place(row) for row in rows])
    turned = tuple(row.mirrored for row in rows)
    if len(rows) == 1:
        return "One row"
    names = {(False, True): "Back-to-back (O)", (True, False): "Face-to-face (X)"}
    word = names.get(turned, f"{len(rows)} rows")
    if len(set(turned)) == 1:
        word = "Tandem"
    if is_self_aligning(bearing):
        word = "Self-aligning"
    text = ", ".join(quantity(1e-3 * gap, "m") for gap in spacing)
    return f"{word}, spacing {text}"


def _place(row):
    """z of the middle of the rolling elements of a row [mm]."""
    if isinstance(row.bearing, AbstractBallBearing):
        return row_position(row)
    return 1e3 * float(row.position)

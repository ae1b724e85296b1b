"""Drawing of the arrangement of the rows of a set."""

import numpy as np

from ...design import BearingSet
from ...design.bearing_set import is_self_aligning
from ..style import BOX, INNER, Axes, Size, write, write_beside
from .dimension import (
    AXIS,
    LINE,
    between,
    fit_view,
    label,
    quantity,
    spread_labels,
    width,
)
from .row_section import draw_rows, row_position

_APART = 0.25
"""Gap between the labels of adjacent rows [inch]."""


def arrangement_view(
    ax: Axes, bearing: BearingSet, turned: list[int], size: Size
) -> None:
    """Draw the axial section of all rows, to scale, with their dimensions in the set.

    Args:
        ax: Axes.
        bearing: The set.
        turned: Rows whose first azimuth is to be told here.
        size: Width and height of the axes [inch].
    """
    outlines = draw_rows(ax, bearing.rows)
    points = np.concatenate(outlines)
    (left, low), (right, high) = points.min(axis=0), points.max(axis=0)
    tall = high - low
    names = [f"rows.{k}" for k in range(len(outlines))]
    if _is_crossed(bearing):
        names = ["rows.0, dashed rows.1", ""]
    for k, (row, outline) in enumerate(zip(bearing.rows, outlines, strict=True)):
        middle = outline.mean(axis=0)[0]
        look = {"va": "baseline", "bbox": BOX, "zorder": 7}
        write(ax, (middle, high + 0.05 * tall), names[k], **look)
        _draw_push(ax, row, (middle, low + 0.08 * tall), 0.1 * tall)
    depth = _positions(ax, bearing, low, 0.13 * tall)
    ax.plot([0.0, 0.0], [depth, high + 0.1 * tall], **AXIS)
    # The words stand below the view.
    texts = [_row_labels(row, k, k in turned) for k, row in enumerate(bearing.rows)]
    block = _APART + max(width(text) for text in texts)
    across = max(1, int(size[0] // block))
    lines = 1 + max(text.count("\n") for text in texts)
    deep = LINE * (lines + 1)
    below = deep * -(-len(texts) // across)
    corners = [(left, depth), (right, high + 0.15 * tall)]
    fit_view(ax, corners, (size[0], size[1] - below), (0.76, 0.98))
    bottom, top = ax.get_ylim()
    ax.set_ylim(bottom - (top - bottom) * below / (size[1] - below), top)
    ax.set_box_aspect(size[1] / size[0])
    order = np.argsort([outline.mean(axis=0)[0] for outline in outlines])
    start, stop = ax.get_xlim()
    for m in range(0, len(order), across):
        part = order[m : m + across]
        wanted = [(outlines[k].mean(axis=0)[0] - start) / (stop - start) for k in part]
        places = spread_labels(wanted, np.full(len(part), block / size[0]))
        up = (below - deep * (m // across) - 0.5 * LINE) / size[1]
        for k, place in zip(part, places, strict=True):
            look = {"va": "top", "multialignment": "left"}
            write(ax, (place, up), texts[k], transform=ax.transAxes, **look)
    ax.set_title(f"{_arrangement(bearing)}; section to scale, ring bodies schematic")


def _positions(ax, bearing, low, step):
    """Draw positions of rows from the origin, the nearest first; return their depth."""
    depth = low - step
    for side in (-1.0, 1.0):
        places = [
            (side * 1e3 * float(r.position), k) for k, r in enumerate(bearing.rows)
        ]
        down = low
        for far, k in sorted(one for one in places if one[0] > 0.0):
            down -= step
            place, below = side * far, np.array([0.0, down - low])
            between(ax, (0.0, low), (place, low), below)
            _write_position(ax, bearing, k, (place, down), side)
        depth = min(depth, down)
    for k, row in enumerate(bearing.rows):
        if float(row.position) == 0.0:
            depth -= step
            _write_position(ax, bearing, k, (0.0, depth), 1.0)
    return depth - 0.5 * step


def _write_position(ax, bearing, k, at, side):
    """Write the position of a row at the end of its dimension line."""
    text = label(bearing.rows[k], "position", f"rows.{k}.")
    look = {"ha": "left" if side > 0.0 else "right", "va": "center", "zorder": 7}
    write_beside(ax, at, (6.0 * side, 0.0), text, bbox=BOX, **look)


def _draw_push(ax, row, at, half):
    """Draw an arrow on an inner ring with an offset."""
    if float(row.inner_offset) == 0.0:
        return
    way = np.array([np.sign(float(row.inner_offset)) * half, 0.0])
    arrow = {"arrowstyle": "-|>", "color": INNER, "linewidth": 2.0}
    ax.annotate("", at + way, at - way, arrowprops=arrow, zorder=6)


def _row_labels(row, k, turned):
    """Return the labels of a row other than its position."""
    name = f"rows.{k}."
    note = "" if float(row.inner_offset) == 0.0 else ", arrow not to scale"
    lines = [
        f"{name}bearing: {type(row.bearing).__name__}, below",
        label(row, "mirrored", name),
        label(row, "inner_offset", name) + note,
        _spring(row, name),
    ]
    if turned:
        lines.append(label(row.bearing, "first_azimuth", f"{name}bearing."))
    return "\n".join(lines)


def _is_crossed(bearing):
    return bearing.rows[0].bearing.is_crossed


def _spring(row, name):
    if row.spring is None:
        return f"{name}spring: not given"
    force, stiffness = (
        label(row.spring, field, "") for field in ("force", "stiffness")
    )
    return f"{name}spring: {force}, {stiffness}"


def _arrangement(bearing):
    """Return the name of the arrangement, and the spacing of its rows."""
    rows = sorted(bearing.rows, key=row_position)
    spacing = np.diff([row_position(row) for row in rows])
    turned = tuple(row.mirrored for row in rows)
    if len(rows) == 1:
        return "One row"
    names = {(False, True): "Back-to-back (O)", (True, False): "Face-to-face (X)"}
    word = names.get(turned, f"{len(rows)} rows")
    if len(set(turned)) == 1:
        word = "Tandem"
    if is_self_aligning(bearing):
        word = "Self-aligning"
    elif _is_crossed(bearing):
        return "Crossed rollers, every other one turned"
    gaps = [quantity(1e-3 * gap, "m") for gap in spacing]
    return f"{word}, spacing {', '.join(gaps[:1] if len(set(gaps)) == 1 else gaps)}"

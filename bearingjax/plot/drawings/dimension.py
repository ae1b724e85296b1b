"""Dimension lines of drawings, and labels at the sides of the view."""

from typing import Any, NamedTuple

import numpy as np

from ...numerics.units import unit_of
from ..style import ELEMENT, GREY, SMALL, Axes, Points, Size, write, write_beside

ARROW: dict[str, Any] = {
    "arrowstyle": "<|-|>",
    "color": "black",
    "linewidth": 0.9,
    "shrinkA": 0,
    "shrinkB": 0,
    "mutation_scale": 9,
}
THIN: dict[str, Any] = {"color": GREY, "linewidth": 0.8, "zorder": 5}
AXIS: dict[str, Any] = THIN | {"linestyle": (0, (9, 3, 2, 3))}
LINE = 0.16
"""Height of a line of a label [inch]."""
_FREE = 0.1  # between labels below one another [inch]
_LEANING = 0.4  # contact angle beyond which its label stands at its other side [rad]
_DRAWN_UNITS = {
    "m": (1e3, " mm"),
    "rad": (180.0 / np.pi, "°"),
    "N/m": (1e-6, " N/µm"),
    "Pa": (1e-9, " GPa"),
}


class Label(NamedTuple):
    """Label at the side of a view, and the point of the view that it belongs to.

    Attributes:
        text: The label.
        at: Point (2,), in the units of the view.
    """

    text: str
    at: Any


def quantity(value: Any, unit: str) -> str:
    """Return a number as text of a drawing: lengths in mm, or µm below 0.1 mm.

    Args:
        value: The number, in SI units.
        unit: Its SI unit; empty for a pure number.
    """
    value = float(value)
    if unit == "m" and 0.0 < abs(value) < 1e-4:
        return f"{1e6 * value:.4g} µm"
    factor, name = _DRAWN_UNITS.get(unit, (1.0, f" {unit}" if unit else ""))
    return f"{factor * value + 0.0:.5g}{name}"


def label(owner: Any, name: str, prefix: str = "") -> str:
    """Return name and value of a field: "pitch_diameter = 46 mm".

    Args:
        owner: Instance with the field.
        name: The field.
        prefix: Before the name, such as "rows.0.".
    """
    value = getattr(owner, name)
    if value is None:
        return f"{prefix}{name}: not given"
    if isinstance(value, bool | int):
        return f"{prefix}{name} = {value}"
    return f"{prefix}{name} = {quantity(value, unit_of(owner, name))}"


def width(text: str) -> float:
    """Return the width of the longest line of a label [inch]."""
    from matplotlib.textpath import TextPath

    lines = (TextPath((0.0, 0.0), line, size=SMALL) for line in text.splitlines())
    return max(line.get_extents().width for line in lines) / 72.0


def fit_view(
    ax: Axes, points: Points, size: Size, middle: tuple[float, float] = (0.48, 0.86)
) -> None:
    """Set the limits of a view, to scale, with its parts in the middle.

    Args:
        ax: Axes; they lose their frame, and their sides get the ratio of `size`.
        points: Points within the view (point, 2).
        size: Width and height of the axes [inch].
        middle: Share of width and height that the parts take.
    """
    points = np.asarray(points, dtype=float)
    low, high = points.min(axis=0), points.max(axis=0)
    inch = np.max((high - low) / (np.asarray(size) * np.asarray(middle)))
    centre, half = 0.5 * (low + high), 0.5 * inch * np.asarray(size)
    ax.set_xlim(centre[0] - half[0], centre[0] + half[0])
    ax.set_ylim(centre[1] - half[1], centre[1] + half[1])
    ax.set_box_aspect(size[1] / size[0])
    ax.set_axis_off()


def put_labels(ax: Axes, labels: list[Label], size: Size, column: float = 0.25) -> None:
    """Write labels in columns at both sides of a view, each with a line to its point.

    Args:
        ax: Axes after `fit_view`.
        labels: The labels; those of points further left are on the left.
        size: Width and height of the axes [inch].
        column: Width of a column, share of the axes.
    """
    low, high = ax.get_ylim()
    order = sorted(labels, key=lambda one: float(one.at[0]))
    cut = len(order) // 2
    for side, part in (("right", order[:cut]), ("left", order[cut:])):
        part = sorted(part, key=lambda one: float(one.at[1]))
        edge = column if side == "right" else 1.0 - column
        part, places = _uncross_labels(part, (low, high), ax.get_xlim(), edge, size[1])
        for one, place in zip(part, places, strict=True):
            look: Any = {"ha": side, "va": "center"}
            tail = 1.0 if side == "right" else 0.0, 0.5
            write_aside(ax, one.at, (edge, place), one.text, tail, (1, 0), **look)


def write_aside(
    ax: Axes,
    at: Points,
    place: tuple[float, float],
    text: str,
    tail: tuple[float, float],
    shrink: tuple[float, float] = (2, 2),
    **look: Any,
) -> None:
    """Write small words away from a point, with a thin line to it.

    Args:
        ax: Axes.
        at: The point (2,).
        place: Place of the words, share of the axes (2,).
        text: The words.
        tail: Where the line begins, share of the words (2,).
        shrink: Distance of the line from words and point [pt].
        look: Further keywords of Matplotlib's `annotate`.
    """
    line = {"arrowstyle": "-", "color": GREY, "linewidth": 0.6, "relpos": tail}
    line |= {"shrinkA": shrink[0], "shrinkB": shrink[1]}
    usual: Any = {"textcoords": "axes fraction", "zorder": 8, "arrowprops": line}
    write_beside(ax, np.asarray(at, dtype=float), place, text, **{**usual, **look})


def _uncross_labels(labels, low_high, left_right, edge, height):
    """Labels from below, and their places, so that no two lines to points cross."""
    corner = np.array([left_right[0], low_high[0]])
    whole = np.array([np.ptp(left_right), np.ptp(low_high)])
    labels, places = list(labels), np.zeros(len(labels))
    for _ in range(len(labels) + 1):
        ats = [(np.asarray(one.at, dtype=float) - corner) / whole for one in labels]
        lines = np.array([1 + one.text.count("\n") for one in labels])
        places = spread_labels([at[1] for at in ats], (LINE * lines + _FREE) / height)
        starts = [np.array([edge, place]) for place in places]
        crossing = [
            k
            for k in range(len(labels) - 1)
            if _cross((starts[k], ats[k]), (starts[k + 1], ats[k + 1]))
        ]
        if not crossing:
            break
        k = crossing[0]
        labels[k], labels[k + 1] = labels[k + 1], labels[k]
    return labels, places


def _cross(one, other):
    """Return whether two lines from labels to points cross, or nearly so."""
    one, other = ((start, end + 0.2 * (end - start)) for start, end in (one, other))

    def side(line, point):
        (ax, ay), (bx, by) = line
        return (bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)

    return all(
        side(line, two[0]) * side(line, two[1]) < 0.0
        for line, two in ((one, other), (other, one))
    )


def middle_only(ax: Axes, column: float) -> None:
    """Clip a view to its middle, leaving the columns of labels free.

    Args:
        ax: Axes, before labels are written.
        column: Width of a column of labels, share of the axes.
    """
    from matplotlib.patches import Rectangle

    room = Rectangle(
        (column + 0.01, 0.0), 0.98 - 2.0 * column, 1.0, transform=ax.transAxes
    )
    for artist in (*ax.patches, *ax.lines):
        artist.set_clip_path(room)


def spread_labels(wanted: Points, heights: Points) -> np.ndarray:
    """Return centres of labels in a column from 0 to 1, near given ones.

    Args:
        wanted: Ascending places (n,).
        heights: Heights of the labels (n,); all are reduced if they do not find room.
    """
    if not len(wanted):
        return np.zeros(0)
    heights = np.asarray(heights) / max(1.0, float(np.sum(heights)))
    steps = np.cumsum(heights) - 0.5 * heights - 0.5 * heights[0]
    # Least squares under the distances: pool neighbours that press on each other.
    blocks: list[tuple[float, int]] = []
    for value in np.asarray(wanted, dtype=float) - steps:
        mean, count = float(value), 1
        while blocks and blocks[-1][0] >= mean:
            before, others = blocks.pop()
            mean = (mean * count + before * others) / (count + others)
            count += others
        blocks.append((mean, count))
    pooled = np.concatenate([np.full(count, mean) for mean, count in blocks])
    low, high = 0.5 * heights[0], 1.0 - 0.5 * heights[-1] - steps[-1]
    return np.clip(pooled, low, max(low, high)) + steps


def arrow(ax: Axes, start: Points, stop: Points, style: str = "-|>") -> None:
    """Draw an arrow between two points (2,); `style` as in Matplotlib."""
    look = ARROW | {"arrowstyle": style}
    ax.annotate("", tuple(stop), tuple(start), arrowprops=look, zorder=6)


def between(
    ax: Axes, start: Points, stop: Points, shift: Points = (0.0, 0.0)
) -> np.ndarray:
    """Draw a dimension line between two points, offset by extension lines.

    Args:
        ax: Axes.
        start, stop: The points (2,).
        shift: Offset of the line (2,).

    Returns:
        Its middle, for the label.
    """
    start, stop = np.asarray(start, dtype=float), np.asarray(stop, dtype=float)
    shift = np.asarray(shift, dtype=float)
    for point in (start, stop):
        if shift.any():
            ax.plot(*np.stack([point, point + 1.06 * shift]).T, **THIN)
    ends = start + shift, stop + shift
    arrow(ax, *ends, "<|-|>")
    return 0.5 * (ends[0] + ends[1])


def squeeze(ax: Axes, start: Points, stop: Points, tail: float) -> None:
    """Draw the dimension of a short distance by arrows from outside.

    Args:
        ax: Axes.
        start, stop: The ends (2,).
        tail: Length of the arrows.
    """
    start, stop = np.asarray(start, dtype=float), np.asarray(stop, dtype=float)
    way = (stop - start) / np.linalg.norm(stop - start)
    for end, sign in ((start, -1.0), (stop, 1.0)):
        arrow(ax, end + sign * tail * way, end)


def radius(ax: Axes, centre: Points, point: Points) -> np.ndarray:
    """Draw an arrow from the centre of an arc to the arc.

    Returns:
        A point on it, for the label.
    """
    centre, point = np.asarray(centre, dtype=float), np.asarray(point, dtype=float)
    arrow(ax, centre, point)
    ax.plot(*centre, marker="+", color="black", markersize=5, zorder=6)
    return centre + 0.8 * (point - centre)


def angle(ax: Axes, centre: Points, size: float, ends: Points) -> np.ndarray:
    """Draw the angle between two lines through a point.

    Args:
        ax: Axes.
        centre: The point (2,).
        size: Radius of the arc; the lines are a little longer.
        ends: Directions of both lines, from the first axis on [rad].

    Returns:
        The middle of the arc, for the label.
    """
    centre = np.asarray(centre, dtype=float)
    for end in ends:
        line = np.stack([np.zeros(2), 1.12 * size * _way(end)])
        ax.plot(*(centre + line).T, **THIN)
    turn = np.linspace(ends[0], ends[1], 30)
    ax.plot(*(centre + size * _way(turn)).T, color="black", linewidth=0.9, zorder=6)
    return centre + size * _way(0.5 * (ends[0] + ends[1]))


def pitch_arrow(ax: Axes, at: Points, diameter: Any) -> None:
    """Draw an arrow from the axis, which is out of view, to the pitch circle.

    Args:
        ax: Axes.
        at: Its head (2,).
        diameter: Diameter of the pitch circle [m].
    """
    look = ARROW | {"arrowstyle": "-|>"}
    write_beside(ax, at, (0, -70), "", arrowprops=look, zorder=6)
    text, upright = f"pitch Ø {quantity(diameter, 'm')}", {"rotation": 90, "zorder": 6}
    write_beside(ax, at, (3, -10), text, ha="left", va="top", **upright)


def contact_angle(
    ax: Axes,
    centre: Points,
    contact: float,
    top: tuple[float, float],
    sense: float = 1.0,
    name: str = "contact angle",
    alone: bool = True,
) -> None:
    """Draw the angle of a contact normal to the radial direction, above a section.

    Args:
        ax: Axes.
        centre: Centre of the rolling element (2,).
        contact: The angle, below 90 degrees [rad].
        top: Radial place of the arc, and of the end of the lines.
        sense: -1 if the row is mirrored.
        name: Name of the angle.
        alone: Whether the row has no neighbour.
    """
    centre = np.asarray(centre, dtype=float)
    arc, end = (place - centre[1] for place in top)
    tip = centre + end * np.array([sense * np.tan(contact), 1.0])
    ax.plot(*np.stack([centre, tip]).T, **THIN)
    ax.plot([centre[0]] * 2, [centre[1], centre[1] + end], **THIN)
    turn = 0.5 * np.pi - sense * np.linspace(0.0, contact, 30)
    ax.plot(*(centre + arc * _way(turn)).T, **THIN)
    # A steep line leans far out: there is more room on the other side of the angle.
    left = alone and contact > _LEANING
    at = centre[0] if left else max(tip[0], centre[0]), tip[1]
    away, side = ((-6, 0), "right") if left else ((6, 0), "left")
    text = f"{name} α = {np.rad2deg(contact):.4g}°"
    write_beside(ax, at, away, text, ha=side, va="center")


def on_line(
    ax: Axes, at: Points, text: str, turn: float = 0.0, ha: str = "center"
) -> None:
    """Write a label on or next to its dimension line within a rolling element.

    Args:
        ax: Axes.
        at: Its middle or end (2,).
        text: The label.
        turn: Turn of the text [rad].
        ha: Horizontal alignment of the text, as in matplotlib.
    """
    turned = {"rotation": np.rad2deg(turn), "rotation_mode": "anchor"}
    ground = ELEMENT | {"edgecolor": "none", "pad": 0.6}
    write(ax, at, text, ha=ha, zorder=7, bbox=ground, **turned)


def _way(turn):
    return np.stack([np.cos(turn), np.sin(turn)], axis=-1)


def magnification(true: float, wanted: float) -> float:
    """Return a round factor, at least 1, that scales a length to about a given one.

    Args:
        true: The length.
        wanted: Its length on the drawing.
    """
    if true == 0.0:
        return 1.0
    factor = max(abs(wanted / true), 1.0)
    power = 10.0 ** np.floor(np.log10(factor))
    return float(max(step for step in (1, 2, 5) if step * power <= factor) * power)

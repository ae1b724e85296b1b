"""Dimensions of one row of rollers: section, clearance, ribs and profiles."""

from typing import Any

import numpy as np

from ...design import (
    AbstractBarrelBearing,
    AbstractRollerBearing,
    Straight,
    TaperedRollerBearing,
)
from ...design.abstract import nearest_entry
from ..style import COLOURS, ELEMENT, RACEWAYS, SMALL, Axes, Size, towards_white
from .ball_drawing import clearance_title
from .dimension import (
    AXIS,
    Label,
    angle,
    arrow,
    between,
    fit_view,
    label,
    magnification,
    middle_only,
    put_labels,
    quantity,
    squeeze,
)
from .outline import Section
from .roller_section import roller_row

_GAP = 0.05
"""Drawn gap of a clearance, roller diameters."""
_RIB_COLUMN = 0.36
"""Width of the column of labels of a rib, share of its view."""
PROFILES = "roller_profile", "outer_raceway_profile", "inner_raceway_profile"


def dimensioned_rollers(
    ax: Axes, bearing: AbstractRollerBearing, parts: Section, size: Size
) -> None:
    """Draw the axial section of a row, to scale, with all its dimensions."""
    seen = [roller_row(ax, parts)]
    labels = [*_sizes(ax, bearing, parts), *_straight(bearing, parts)]
    more, beyond, column = nearest_entry(_SHAPES, bearing)
    labels += more(ax, bearing, parts)
    if beyond:
        seen.append(parts.axis + np.array([beyond * parts.length, 0.0]))
    if len(parts.rib_points):
        ax.plot(*parts.rib_points.T, "o", color="black", markersize=5, zorder=7)
    else:
        labels.append(Label("ribs: none", parts.axis[0]))
    fit_view(ax, np.concatenate(seen), size, (0.98 - 2.0 * column, 0.86))
    put_labels(ax, labels, size, column)
    ax.set_title("Axial section, to scale; ring bodies schematic")


def _sizes(ax, bearing, parts):
    along = parts.axis[1] - parts.axis[0]
    along = along / np.linalg.norm(along)
    across = np.array([-along[1], along[0]])
    centre = parts.axis.mean(axis=0)
    half = 0.5 * parts.diameter * across
    at = between(ax, centre - half, centre + half)
    yield Label(label(bearing, "roller_diameter"), at - 0.5 * half)
    ax.plot(*np.stack([parts.axis[0], parts.axis[1]]).T, **AXIS)
    # Along the outer generator, inside of the roller.
    low, high = parts.raceways[0, [0, -1]] - 0.55 * half
    at = between(ax, low, high)
    yield Label(label(bearing, "roller_length"), at + 0.25 * (low - high))


def _straight(bearing, parts):
    """Yield labels of surfaces without a profile; the others have views."""
    at = parts.roller[0], parts.raceways[0, -1], parts.raceways[1, -1]
    for name, point in zip(PROFILES, at, strict=True):
        if isinstance(getattr(bearing, name), Straight):
            yield Label(f"{name}: Straight", point)


def _barrel(ax, bearing, parts):
    """Draw the radii of all arcs, and the numbers of a spherical outer raceway."""
    names = "roller_profile_radius", "outer_raceway_radius", "inner_raceway_radius"
    for name, k, share in zip(names, (1, 0, 1), (0.8, 0.8, 0.2), strict=True):
        wall = parts.raceways[k, round(share * (parts.raceways.shape[1] - 1))]
        start = wall - 0.3 * parts.diameter * _normal(parts, k)
        arrow(ax, start, wall)
        text = label(bearing, name)
        if getattr(bearing, name) is None:
            text += f"\nsphere of radius {quantity(bearing.arc_radii[1], 'm')}"
        yield Label(text, 0.3 * wall + 0.7 * start)
    if hasattr(bearing, "contact_angle"):
        turn = float(bearing.contact_angle)
        ends = 0.5 * np.pi, 0.5 * np.pi - turn
        at = angle(ax, parts.centre, 0.4 * parts.diameter, ends)
        yield Label(label(bearing, "contact_angle"), at)
    if hasattr(bearing, "profile_offset"):
        back = parts.axis.mean(axis=0) - parts.axis[0]
        back *= -1e3 * float(bearing.profile_offset) / np.linalg.norm(back)
        at, aside = parts.centre, -0.25 * parts.diameter * _normal(parts, 0)
        if back.any():
            at = between(ax, parts.centre, parts.centre + back, aside)
        yield Label(label(bearing, "profile_offset"), at)


def _normal(parts, k):
    """Return the normal of a raceway in the middle, from the roller to the ring."""
    g = parts.generators[k]
    return (1.0, -1.0)[k] * np.array([-g[1], g[0]])


def _angles(ax, bearing, parts):
    turn, half = float(bearing.roller_axis_angle), float(bearing.roller_half_angle)
    centre, length = parts.axis.mean(axis=0), parts.length
    at = angle(ax, centre, 0.7 * length, (0.0, -turn))
    yield Label(label(bearing, "roller_axis_angle"), at)
    # The generator, moved to the axis of the roller.
    at = angle(ax, centre, 0.6 * length, (-turn, -turn - half))
    yield Label(label(bearing, "roller_half_angle"), at)
    ends = (np.pi, np.pi - turn - half), (np.pi, np.pi - turn + half)
    words = "outer raceway (cup) at", "inner raceway (cone) at"
    if bearing.is_thrust:
        words = "outer washer at", "inner washer at"
    for k in range(2):
        foot = parts.raceways[k, -1]
        at = angle(ax, foot, 0.45 * length, ends[k])
        yield Label(f"{words[k]} {quantity(np.pi - ends[k][1], 'rad')}", at)


def roller_clearance_view(
    ax: Axes, bearing: AbstractRollerBearing, parts: Section, size: Size
) -> None:
    """Draw the clearance of a row of rollers, magnified."""
    gap = 1e3 * float(bearing.gap)
    times = magnification(gap, _GAP * parts.diameter)
    apart = (times - 1.0) * gap
    corners = roller_row(ax, parts, apart=apart)
    for k in range(2):
        way = _normal(parts, k)
        wall = parts.centre + (0.5 * parts.diameter + gap) * way
        near, far = wall - gap * way, wall + apart * way
        if gap != 0.0:
            ends = (near, far) if gap > 0.0 else (far, near)
            squeeze(ax, ends[0], ends[1], 0.25 * parts.diameter)
    fit_view(ax, corners, size, (0.8, 0.9))
    text = label(bearing, "radial_internal_clearance")
    quarter = 0.25e3 * float(bearing.radial_internal_clearance)
    share = "" if np.isclose(gap, quarter) else f", times {gap / quarter:.4g},"
    ax.set_title(clearance_title(text, gap, times, share), fontsize=SMALL)


def rib_view(
    ax: Axes,
    bearing: AbstractRollerBearing,
    parts: Section,
    names: list[str],
    size: Size,
) -> None:
    """Draw a rib and the end of a roller, with the gap magnified.

    Args:
        ax: Axes.
        bearing: The row.
        parts: Its outlines.
        names: Ribs of the same dimensions; the first one is drawn.
        size: Width and height of the axes [inch].
    """
    name = names[0]
    rib = getattr(bearing.ribs, name)
    k = bearing.ribs.present.index(name)
    point, away = parts.rib_points[k], parts.rib_normals[k]
    ring = 0 if name.startswith("outer") else 1
    height = 1e3 * float(rib.contact_height)
    reach = max(height, 0.12 * parts.diameter)
    gap = 1e3 * float(rib.axial_gap)
    times = magnification(gap, 0.15 * reach)
    ax.fill(*parts.roller.T, linewidth=1.4, **ELEMENT)
    # Along the face of the rib, from the raceway on.
    rise = np.array([-away[1], away[0]])
    rise *= -np.sign(rise @ _normal(parts, ring))
    point = point - gap * away  # of the roller
    face = point + times * gap * away
    foot, top = face - height * rise, face + 0.7 * reach * rise
    body = np.stack([foot - 0.4 * reach * rise, top])
    back = body[::-1] + 1.2 * reach * away
    colour = COLOURS[RACEWAYS[ring]]
    outline, fill = np.concatenate([body, back]), towards_white(colour, 0.88)
    ax.fill(*outline.T, facecolor=fill, edgecolor=colour, linewidth=1.2)
    ax.plot(*parts.raceways[ring].T, color=colour, linewidth=2.0)
    ax.plot(*point, "o", color="black", markersize=5, zorder=7)
    inside = point - 1.5 * reach * away
    arrow(ax, inside, point)
    at = point
    if height > 0.0:
        at = between(ax, point - height * rise, point, 0.6 * reach * away)
    note = f"\ndrawn {times:g} times as large" if gap else ""
    labels = [
        Label(f"{label(rib, 'end_radius')}\ncentre on the axis\nof the roller", inside),
        Label(label(rib, "contact_height"), at),
        Label(f"{label(rib, 'axial_gap')}{note}", 0.5 * (point + face)),
    ]
    around = np.array([[-1.0, -1.0], [1.0, 1.0]]) * 2.0 * reach + point
    fit_view(ax, around, size, (0.98 - 2.0 * _RIB_COLUMN, 0.9))
    middle_only(ax, _RIB_COLUMN)
    put_labels(ax, labels, size, _RIB_COLUMN)
    words = [f"ribs.{one}" for one in names]
    ax.set_title("\n".join(map(", ".join, (words[:2], words[2:]))), fontsize=11)


_SHAPES: dict[type, tuple[Any, float, float]] = {
    AbstractRollerBearing: (lambda *_: (), 0.0, 0.25),
    AbstractBarrelBearing: (_barrel, 0.0, 0.29),
    TaperedRollerBearing: (_angles, 0.3, 0.25),
}
"""Labels of a shape of rollers, room along its axis over the length of a roller, and
width of the columns of labels, by class: names of radii are long."""

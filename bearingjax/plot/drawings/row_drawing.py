"""Dimensions of one row of balls or rollers: section, clearance and ribs."""

from typing import Any

import numpy as np

from ...design import (
    AbstractBallBearing,
    AbstractBarrelBearing,
    AbstractRollerBearing,
    Straight,
    TaperedRollerBearing,
)
from ...design.abstract import nearest_entry
from ..style import COLOURS, ELEMENT, RACEWAYS, SMALL, Axes, Size, towards_white
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
    radius,
    squeeze,
)
from .outline import Section
from .row_section import SHOULDER, ball_row, contour, roller_row

_BALL_GAP = 0.07
"""Drawn gap of the clearance, ball diameters."""


def dimensioned_balls(ax: Axes, bearing: AbstractBallBearing, size: Size) -> None:
    """Draw the axial section of a row, to scale, with all its dimensions."""
    diameter = 1e3 * float(bearing.ball_diameter)
    rings = ball_row(ax, bearing, np.asarray)
    lines = {name: contour(bearing, name) for name in RACEWAYS}
    corners = np.array([rings.min(axis=0), rings.max(axis=0)])
    corners += 0.2 * diameter * np.array([[-1.0], [1.0]])
    labels = [
        _diameter(ax, bearing, corners[0, 0]),
        *_grooves(ax, bearing),
        *_shoulders(ax, bearing, lines),
        *_ball_angles(ax, bearing),
    ]
    if bearing.aligns or bearing.is_paired:
        labels.append(_offset(ax, bearing, -corners[0, 1]))
    fit_view(ax, np.concatenate([corners, [one.at for one in labels]]), size)
    put_labels(ax, labels, size)
    ax.set_title("Axial section, to scale; ring bodies schematic")


def _diameter(ax, bearing, left):
    half = np.array([0.0, 0.5e3 * float(bearing.ball_diameter)])
    at = between(ax, -half, half, (left, 0.0))
    return Label(label(bearing, "ball_diameter"), at)


def _grooves(ax, bearing):
    """Draw the radius of a groove of each ring, from its centre."""
    for name, sign in (("outer", 1.0), ("inner", -1.0)):
        field = f"{name}_osculation"
        groove = next(g for g in bearing.grooves if g.on_outer is (name == "outer"))
        centre = 1e3 * np.array([float(groove.axial), float(groove.radial)])
        size = float(groove.radius)
        if bearing.aligns and name == "outer":
            turn = float(bearing.groove_axis) + 0.05
            at = centre + 1e3 * size * np.array([np.sin(turn), np.cos(turn)])
            text = f"{field}: none\nsphere of radius {quantity(size, 'm')}"
            yield Label(f"{text}\nabout the middle of the bearing", at)
            continue
        turn = float(bearing.groove_axis) + _arc_angle(bearing, groove, name)
        way = sign * np.array([np.sin(turn), np.cos(turn)])
        at = radius(ax, centre, centre + 1e3 * size * way)
        text = f"{label(bearing, field)}\ngroove radius {quantity(size, 'm')}"
        yield Label(text, at)


def _arc_angle(bearing, groove, name):
    """Return the angle of a radius line on its arc, clear of contact lines [rad]."""
    turn = float(bearing.free_contact_angle) - float(bearing.groove_axis)
    lines = turn, float(getattr(bearing, "shim_angle", turn))
    height = getattr(bearing, f"{name}_shoulder")
    height = SHOULDER * bearing.ball_diameter if height is None else height
    deepest = float(groove.deepest)
    start = np.arccos(deepest)
    edge = np.arccos(max(deepest - float(height) / float(groove.radius), -1.0))
    # Not opposite each other: they would look like one line.
    shares = (0.5, 0.3, 0.8) if name == "outer" else (0.8, 0.5, 0.3)
    turns = [start + share * (edge - start) for share in shares]
    # At least 8 degrees away from them, or as far as possible.
    distance = [min(abs(turn - line) for line in lines) for turn in turns]
    clear = [turn for turn, far in zip(turns, distance, strict=True) if far > 0.14]
    return clear[0] if clear else turns[int(np.argmax(distance))]


def _shoulders(ax, bearing, lines):
    """Draw the height of the shoulders above the bottom of the groove."""
    thrust = bearing.is_thrust
    aside, across = (1, 0) if thrust else (0, 1)
    diameter = 1e3 * float(bearing.ball_diameter)
    for name, sign in (("outer", 1.0), ("inner", -1.0)):
        if name == "outer" and bearing.aligns:
            text = "outer_shoulder: none\nthe raceway is a sphere"
            yield Label(text, lines[name][0])
            continue
        value, line = getattr(bearing, f"{name}_shoulder"), lines[name]
        # An angular contact bearing has its outer shoulder at +z, the inner one at -z.
        place = np.argmax(sign * line[:, aside])
        corner = line[place]
        if value is None:
            text = f"{name}_shoulder: not given\ndrawn schematically"
            yield Label(text, corner)
            continue
        bottom = corner.copy()
        bottom[across] = sign * np.max(sign * line[:, across])
        start, stop = bottom.copy(), bottom.copy()
        stop[across] -= sign * 1e3 * float(value)
        shift = np.zeros(2)
        shift[aside] = sign * 0.12 * diameter
        at = between(ax, start, stop, shift)
        yield Label(label(bearing, f"{name}_shoulder"), at)


def _ball_angles(ax, bearing):
    """Contact angle, or that at which a ball rests in two arcs."""
    ball = 1e3 * float(bearing.ball_diameter)
    if hasattr(bearing, "shim_angle"):
        turn = float(bearing.shim_angle)
        ends = 0.5 * np.pi, 0.5 * np.pi - turn
        yield Label(label(bearing, "shim_angle"), angle(ax, (0, 0), 0.33 * ball, ends))
    if hasattr(bearing, "contact_angle"):
        turn = float(bearing.free_contact_angle)
        ends = 0.5 * np.pi, 0.5 * np.pi - turn
        at = angle(ax, (0.0, 0.0), 0.28 * ball, ends)
        text = label(bearing, "contact_angle")
        if bearing.contact_angle is None:
            text = f"contact_angle = {quantity(turn, 'rad')}\nfrom the clearance"
        yield Label(text, at)


def _offset(ax, bearing, high):
    middle = -1e3 * float(bearing.axial_place)
    ax.plot([middle, middle], [-high, high], **AXIS)
    at = between(ax, (middle, 0.0), (0.0, 0.0), (0.0, -high))
    return Label(label(bearing, "row_offset"), at)


def ball_clearance_view(ax: Axes, bearing: Any, size: Size) -> None:
    """Draw the clearance of a row of balls, magnified.

    Args:
        ax: Axes.
        bearing: With a field `radial_internal_clearance`.
        size: Width and height of the axes [inch].
    """
    diameter = 1e3 * float(bearing.ball_diameter)
    # Half of the diametral play is radial, half of that stands at each raceway.
    gap = 0.25e3 * float(bearing.clearance)
    times = magnification(gap, _BALL_GAP * diameter)
    rings = ball_row(ax, bearing, np.asarray, apart=(times - 1.0) * gap)
    half = 0.5 * diameter
    for sign in (1.0, -1.0):
        wall = sign * (half + times * gap)
        near, far = sorted((half, abs(wall)))
        if gap != 0.0:
            squeeze(ax, (0.0, sign * near), (0.0, sign * far), 0.25 * diameter)
    if gap < 0.0:
        # The rings are hidden where the ball overlaps them.
        for name, outwards in (("outer", 1.0), ("inner", -1.0)):
            line = contour(bearing, name) + [0.0, outwards * (times - 1.0) * gap]
            ax.plot(*line.T, color=COLOURS[name], linewidth=1.2, zorder=4)
    fit_view(ax, rings, size, (0.9, 0.96))
    text = label(bearing, "radial_internal_clearance")
    if bearing.radial_internal_clearance is None:
        given = bearing.contact_angle is not None
        why = "from the contact angle" if given else "no clearance"
        value = quantity(bearing.clearance, "m")
        text = f"radial_internal_clearance = {value}, {why}"
    ax.set_title(_clearance_title(text, gap, times), fontsize=SMALL)


def _clearance_title(text, gap, times, share=""):
    """Return the title of a clearance: `gap` [mm] at each raceway, drawn enlarged."""
    if gap == 0.0:
        return f"{text}\nno gap at the raceways"
    word = "gap" if gap > 0.0 else "overlap"
    drawn = f"drawn {times:g} times" if times != 1.0 else "drawn to scale"
    return f"{text}\na quarter of it{share} is the {word} at each raceway\n{drawn}"


_ROLLER_GAP = 0.05
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


def _cone_angles(ax, bearing, parts):
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
    times = magnification(gap, _ROLLER_GAP * parts.diameter)
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
    ax.set_title(_clearance_title(text, gap, times, share), fontsize=SMALL)


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
    TaperedRollerBearing: (_cone_angles, 0.3, 0.25),
}
"""Labels of a shape of rollers, room along its axis over the length of a roller, and
width of the columns of labels, by class: names of radii are long."""

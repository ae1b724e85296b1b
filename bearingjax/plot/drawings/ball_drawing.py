"""Dimensions of one row of balls, on its axial section."""

from typing import Any

import numpy as np

from ...design import AbstractBallBearing
from ..style import COLOURS, RACEWAYS, SMALL, Axes, Size
from .ball_section import SHOULDER, ball_row, contour
from .dimension import (
    AXIS,
    Label,
    angle,
    between,
    fit_view,
    label,
    magnification,
    put_labels,
    quantity,
    radius,
    squeeze,
)

_GAP = 0.07
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
        *_angles(ax, bearing),
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


def _angles(ax, bearing):
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
    times = magnification(gap, _GAP * diameter)
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
    ax.set_title(clearance_title(text, gap, times), fontsize=SMALL)


def clearance_title(text: str, gap: float, times: float, share: str = "") -> str:
    """Return the title of the view of a clearance.

    Args:
        text: Name and value.
        gap: At each raceway [mm].
        times: Magnification of the drawing.
        share: Words inserted after "a quarter of it".
    """
    if gap == 0.0:
        return f"{text}\nno gap at the raceways"
    word = "gap" if gap > 0.0 else "overlap"
    drawn = f"drawn {times:g} times" if times != 1.0 else "drawn to scale"
    return f"{text}\na quarter of it{share} is the {word} at each raceway\n{drawn}"

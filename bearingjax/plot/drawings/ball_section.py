"""Axial section of a ball bearing or a set of them, to scale."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...design import AbstractBallBearing, AbstractBearing, BearingSet, SetRow, rows_of
from ..style import (
    COLOURS,
    ELEMENT,
    GREY,
    Ax,
    Axes,
    axes_or_new,
    faded,
    write_beside,
)
from .dimension import AXIS, between, contact_angle, pitch_arrow, quantity

_BODY = 0.30  # thickness of the schematic rings under the groove, ball diameters
_WIDTH = 0.75  # half width of the schematic rings, ball diameters
STEEP = np.deg2rad(75.0)
"""Contact angle above which there is no room for it above a section [rad]."""
D_W = "$D_\\mathrm{w}$"
"""Symbol of the diameter of rolling elements; D is the outside diameter."""
SHOULDER = 0.2
"""Schematic height of an unspecified shoulder, ball diameters."""


def ball_section(bearing: AbstractBearing | BearingSet, ax: Ax = None) -> Axes:
    """Draw the axial section through one ball of every row.

    Balls and raceways are to scale, unloaded; the ring bodies are schematic.

    Returns:
        The axes: z to the right, radius upwards.
    """
    ax = axes_or_new(ax, (7.0, 6.0))
    places = np.sort([row_position(row) for row in rows_of(bearing)])
    # Rings of neighbouring rows meet halfway.
    reach = 0.49 * np.diff(places).min() if len(places) > 1 else np.inf
    outlines = []
    for row in rows_of(bearing):
        part = row.bearing
        assert isinstance(part, AbstractBallBearing)
        sign = -1.0 if row.mirrored else 1.0
        centre = np.array([row_position(row), 0.5e3 * float(part.pitch_diameter)])

        def place(points, sign=sign, centre=centre):
            return centre + np.asarray(points) * np.array([sign, 1.0])

        outlines.append(ball_row(ax, part, place, reach))
    corners = np.concatenate(outlines)
    first = min(rows_of(bearing), key=row_position)
    _dimensions(ax, first, corners.min(axis=0), corners.max(axis=0), len(places) == 1)
    ax.set_title("Axial section, to scale; ring bodies schematic")
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.05)
    note = ""
    assert isinstance(first.bearing, AbstractBallBearing)
    if (angle := float(first.bearing.free_contact_angle)) >= STEEP:
        note = f"    (free contact angle {quantity(angle, 'rad')})"
    ax.set_xlabel(f"z [mm]{note}")
    ax.set_ylabel("radius [mm]")
    return ax


def _dimensions(ax, row, low, high, alone):
    """Draw ball, pitch circle and free contact angle of the left row."""
    part = row.bearing
    sign = -1.0 if row.mirrored else 1.0
    angle = float(part.free_contact_angle)
    diameter, tall = 1e3 * float(part.ball_diameter), high[1] - low[1]
    centre = np.array([row_position(row), 0.5e3 * float(part.pitch_diameter)])
    half = np.array([0.0, 0.5 * diameter])
    aside = np.array([low[0] - 0.18 * diameter - centre[0], 0.0])
    at = between(ax, centre - half, centre + half, aside)
    text, upright = f"{D_W} = {quantity(part.ball_diameter, 'm')}", {"rotation": 90}
    write_beside(ax, at, (-3, 0), text, ha="right", va="center", **upright)
    beyond = np.array([high[0] + 0.2 * diameter, centre[1]])
    ax.plot([low[0], beyond[0] + 0.1 * diameter], [centre[1]] * 2, **AXIS)
    pitch_arrow(ax, beyond, part.pitch_diameter)
    if 0.0 < angle < STEEP:
        top = high[1] + 0.07 * tall, high[1] + 0.14 * tall
        contact_angle(ax, centre, angle, top, sign, "free contact angle", alone)
    left = low - np.array([0.35 * diameter, 0.0])
    ax.update_datalim([left, high + np.array([0.5 * diameter, 0.18 * tall])])


def ball_row(
    ax: Axes,
    bearing: AbstractBallBearing,
    place: Callable[[np.ndarray], np.ndarray],
    reach: float = np.inf,
    apart: float = 0.0,
) -> np.ndarray:
    """Draw one ball, its lines of contact without load, and both rings.

    Args:
        ax: Axes.
        bearing: A row of balls.
        place: Map of points (point, 2) about the ball's centre, z and r in mm.
        reach: Most half width of the rings [mm].
        apart: Additional distance of each ring from the ball [mm].

    Returns:
        Outlines of both rings (point, 2) [mm].
    """
    outlines = _rings(ax, bearing, place, reach, apart)
    _ball(ax, bearing, place)
    return outlines


def row_position(row: SetRow) -> float:
    """Return z of the circle of the centres of its rolling elements [mm].

    Args:
        row: A `SetRow`.
    """
    bearing: Any = row.bearing
    within = 1e3 * float(bearing.axial_place)
    return 1e3 * float(row.position) + (-within if row.mirrored else within)


def _ball(ax, bearing, place):
    radius = 0.5e3 * float(bearing.ball_diameter)
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    circle = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    ax.fill(*place(circle).T, linewidth=1.4, zorder=2, **ELEMENT)
    # Lines of contact of the unloaded bearing, through the ball's centre.
    for groove in bearing.grooves:
        outwards = 1.0 if groove.on_outer else -1.0
        way = -outwards * np.array([float(groove.axial), float(groove.radial)])
        size = np.hypot(*way)
        angle = float(bearing.free_contact_angle)
        way = way / size if size > 0 else np.array([np.sin(angle), np.cos(angle)])
        line = np.stack([np.zeros(2), outwards * radius * way])
        name = "outer" if groove.on_outer else "inner"
        ax.plot(*place(line).T, color=COLOURS[name], linewidth=1.0, zorder=4)
        ax.plot(*place(line[1:]).T, marker="o", color=COLOURS[name], ms=4, zorder=5)
    ax.plot(*place(np.zeros((1, 2))).T, marker="+", color=GREY, zorder=5)


def contour(
    bearing: AbstractBallBearing, name: str, reach: float = np.inf
) -> np.ndarray:
    """Return the outline of a ring on the side of the ball (point, 2) [mm].

    Args:
        bearing: A row of balls.
        name: "outer" or "inner".
        reach: Most half width of the ring [mm].

    Returns:
        z and r about the ball's centre.
    """
    if bearing.aligns:
        return _aligning(bearing, name)
    line = _raceway(bearing, name, 1.0 if name == "outer" else -1.0, reach)
    return line[:, ::-1] if bearing.is_thrust else line


def _rings(ax, bearing, place, reach, apart):
    across = 0 if bearing.is_thrust else 1
    thickness = _BODY * 1e3 * float(bearing.ball_diameter)
    outlines = []
    for name, outwards in (("outer", 1.0), ("inner", -1.0)):
        line = contour(bearing, name, reach).copy()
        line[:, across] += outwards * apart
        back = line[[-1, 0]]
        back[:, across] = outwards * (np.max(outwards * line[:, across]) + thickness)
        outline = place(np.concatenate([line, back]))
        outlines.append(outline)
        colour = COLOURS[name]
        fill = faded(colour, 0.12)
        ax.fill(*outline.T, facecolor=fill, edgecolor=colour, linewidth=1.2, zorder=1)
    return np.concatenate(outlines)


def _aligning(bearing, name):
    """Return the contour of a ring of a self-aligning bearing, from its middle [mm]."""
    diameter = 1e3 * float(bearing.ball_diameter)
    middle, reach = -1e3 * float(bearing.row_offset), _WIDTH * diameter
    groove = bearing.grooves[0 if name == "outer" else 1]
    centre = 1e3 * np.array([float(groove.axial), float(groove.radial)])
    radius = 1e3 * float(groove.radius)
    if name == "outer":
        angles = np.arcsin((np.linspace(middle, reach, 60) - centre[0]) / radius)
        return centre + radius * np.stack([np.sin(angles), np.cos(angles)], axis=1)
    given = bearing.inner_shoulder
    height = SHOULDER * diameter if given is None else 1e3 * float(given)
    edge = np.arccos(1.0 - height / radius)
    angles = np.linspace(-edge, edge, 121) - bearing.groove_axis
    points = centre + radius * np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    ends = [middle, points[0, 1]], [max(reach, points[-1, 0]), points[-1, 1]]
    return np.concatenate([[ends[0]], points, [ends[1]]])


def _raceway(bearing, name, outwards, reach):
    """Return the contour of a ring, along and across the raceway [mm].

    Across points from the inner to the outer ring: along r, for washers along z.
    """
    diameter = 1e3 * float(bearing.ball_diameter)
    given = getattr(bearing, f"{name}_shoulder")
    height = SHOULDER * diameter if given is None else 1e3 * float(given)
    grooves = [g for g in bearing.grooves if g.on_outer is (name == "outer")]
    pieces = []
    for groove in grooves:
        radius, deepest = 1e3 * float(groove.radius), float(groove.deepest)
        centre = 1e3 * np.array([float(groove.axial), float(groove.radial)])
        if bearing.is_thrust:
            centre = centre[::-1]
        start, edge = np.arccos(np.clip([deepest, deepest - height / radius], -1, 1))
        if len(grooves) == 2:
            # An arc carries beyond the middle of the ring from its centre.
            angles = -np.sign(centre[0]) * np.linspace(start, edge, 60)
        else:
            angles = np.linspace(-edge, edge, 121)
            if groove.open_side and bearing.groove_axis == 0.0:
                angles = angles[outwards * angles >= 0]
        arc = np.stack([np.sin(angles), outwards * np.cos(angles)], axis=1)
        pieces.append(centre + radius * arc)
    points = np.concatenate(pieces)
    points = points[np.argsort(points[:, 0], kind="stable")]
    low, high = points[0].copy(), points[-1].copy()
    reach = min(_WIDTH * diameter, reach)
    low[0], high[0] = min(low[0], -reach), max(high[0], reach)
    return np.concatenate([[low], points, [high]])

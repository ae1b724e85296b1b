"""Rows of balls or rollers in their axial section, to scale."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...design import AbstractBallBearing, AbstractRollerBearing, SetRow
from ..style import (
    COLOURS,
    ELEMENT,
    GREY,
    RACEWAYS,
    ROLLER,
    Axes,
    faded,
    towards_white,
)
from .outline import Section, section

_BODY = 0.30  # thickness of the schematic rings under the groove, ball diameters
_WIDTH = 0.75  # half width of the schematic rings, ball diameters
STEEP = np.deg2rad(75.0)
"""Contact angle above which there is no room for it above a section [rad]."""
D_W = "$D_\\mathrm{w}$"
"""Symbol of the diameter of rolling elements; D is the outside diameter."""
SHOULDER = 0.2
"""Schematic height of an unspecified shoulder, ball diameters."""


def placer(
    centre: np.ndarray, sense: float, side: float = 1.0
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the map of points (point, 2) of a row to where it stands, z and r in mm.

    Args:
        centre: Where its origin stands (2,) [mm].
        sense: -1 if z is reversed, else 1.
        side: -1 for the side below the axis, else 1.
    """

    def place(points):
        there = centre + np.asarray(points) * np.array([sense, 1.0])
        return there * np.array([1.0, side])

    return place


def draw_rows(ax: Axes, rows: Sequence[SetRow]) -> list[np.ndarray]:
    """Draw one ball or roller of every row, and its rings.

    Returns:
        Corners of the rings of each row (point, 2) [mm].
    """
    places = np.sort([row_position(row) for row in rows])
    # Rings of neighbouring rows of balls meet halfway.
    reach = 0.49 * np.diff(places).min() if len(places) > 1 else np.inf
    outlines = []
    for k, row in enumerate(rows):
        part, sense = row.bearing, -1.0 if row.mirrored else 1.0
        if isinstance(part, AbstractBallBearing):
            centre = np.array([row_position(row), 0.5e3 * float(part.pitch_diameter)])
            outlines.append(ball_row(ax, part, placer(centre, sense), reach))
        else:
            assert isinstance(part, AbstractRollerBearing)
            place = placer(np.array([1e3 * float(row.position), 0.0]), sense)
            behind = part.is_crossed and k > 0
            outlines.append(roller_row(ax, section(part), place, behind=behind))
    return outlines


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


def roller_row(
    ax: Axes,
    parts: Section,
    place: Callable[[np.ndarray], np.ndarray] = np.asarray,
    apart: float = 0.0,
    behind: bool = False,
) -> np.ndarray:
    """Draw one roller and both rings.

    Args:
        ax: Axes.
        parts: Parts of a row of rollers.
        place: Map of points (point, 2), z and r in mm.
        apart: Additional distance of each ring from the roller [mm].
        behind: Whether the roller is one behind another in the same rings, of which
            only the outline is drawn.

    Returns:
        Corners of both rings (point, 2) [mm].
    """
    corners = []
    for k, name in enumerate(RACEWAYS):
        away = (1.0, -1.0)[k] * np.array([-1.0, 1.0]) * parts.generators[k, ::-1]
        ring = place(parts.rings[k] + apart * away)
        corners.append(ring)
        if behind:
            continue
        fill = towards_white(COLOURS[name], 0.88)
        ax.fill(*ring.T, facecolor=fill, edgecolor=COLOURS[name], linewidth=1.2)
    if behind:
        ax.plot(*place(parts.roller).T, "--", color=ROLLER, linewidth=1.0)
        return np.concatenate(corners)
    ax.fill(*place(parts.roller).T, linewidth=1.4, **ELEMENT)
    return np.concatenate(corners)

"""Axial sections of bearings to scale, with boundary dimensions of the catalogue."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...catalogue.entry import CatalogueEntry, bearing_of_entry
from ...design import AbstractBearing, AbstractRollerBearing, BearingSet, rows_of
from ..style import (
    BOX,
    COLOURS,
    ELEMENT,
    GREY,
    RACEWAYS,
    SMALL,
    Ax,
    Axes,
    Figure,
    axes_or_new,
    faded,
    pyplot,
    write,
    write_beside,
)
from .dimension import AXIS, between, contact_angle, on_line, pitch_arrow, quantity
from .outline import section
from .row_section import D_W, STEEP, draw_rows, row_position


def cross_section(
    bearing: AbstractBearing | BearingSet,
    ax: Ax = None,
    catalogue: CatalogueEntry | None = None,
) -> Axes:
    """Draw the axial section of the bearing above its axis, to scale [mm].

    Dimensions of the rings beyond raceways and ribs are not part of the design: they
    are schematic.

    Args:
        bearing: The design; of a set all rows, with the dimensions of the first one.
        catalogue: Its catalogue entry, whose boundary dimensions are drawn too.

    Returns:
        The axes: z to the right, radius upwards.
    """
    rows = rows_of(bearing)
    ax = axes_or_new(ax, (7.0, 6.0))
    ax.set_aspect("equal", adjustable="datalim")
    one = len(rows) == 1 and not bearing.is_ball
    note = (_roller_section if one else _rows_section)(ax, rows)
    ax.set_xlabel(f"z [mm]{note}")
    ax.set_ylabel("radius [mm]")
    ax.set_title("Axial section, to scale; ring bodies schematic")
    draw_boundary(ax, bearing, catalogue)
    return ax


def _roller_section(ax, rows):
    """Draw a row of rollers with its dimensions; return a note for the axis."""
    bearing = rows[0].bearing
    assert isinstance(bearing, AbstractRollerBearing)
    parts = section(bearing)
    low = min(ring[:, 1].min() for ring in parts.rings)
    high = max(ring[:, 1].max() for ring in parts.rings)
    left, right = parts.rings[0][:, 0].min(), parts.rings[0][:, 0].max()
    height, width = high - low, right - left
    hatches = {"outer": "////", "inner": "\\\\\\\\"}
    for name, ring in zip(RACEWAYS, parts.rings, strict=True):
        colour = COLOURS[name]
        ax.fill(*ring.T, facecolor="white", edgecolor=colour, zorder=1, linewidth=1.4)
        pale, lines = faded(colour, 0.10), faded(colour, 0.45)
        look = {"facecolor": pale, "edgecolor": lines, "hatch": hatches[name]}
        ax.fill(*ring.T, linewidth=0.0, zorder=1, **look)
    ax.fill(*parts.roller.T, linewidth=1.4, zorder=2, label="roller", **ELEMENT)
    for i, name in enumerate(RACEWAYS):
        look = {"color": COLOURS[name], "linewidth": 2.2, "zorder": 3, "label": name}
        ax.plot(*parts.raceways[i].T, **look)
    if len(parts.rib_points):
        ax.plot(
            *parts.rib_points.T,
            linestyle="none",
            marker="o",
            markersize=5.5,
            markerfacecolor="black",
            markeredgecolor="white",
            zorder=5,
            label="contact with a rib",
        )
        ax.legend(
            handles=[ax.lines[-1]],
            fontsize=SMALL,
            loc="lower left" if bearing.is_thrust else "upper left",
            frameon=False,
            handletextpad=0.2,
            borderpad=0.1,
        )
    _name_rings(ax, bearing, parts)
    _dimensions(ax, bearing, parts, left, right, high, height)
    # Limits that stay automatic may widen to keep the aspect.
    ax.update_datalim(
        [
            (left - 0.06 * width, low - 0.16 * height),
            (right + 0.06 * width + 0.35 * parts.diameter, high + 0.24 * height),
        ]
    )
    ax.margins(0.0)
    angle = float(bearing.axis_angle) + float(bearing.half_angle)
    return f"    (contact angle {quantity(angle, 'rad')})" if angle >= STEEP else ""


def _rows_section(ax, rows):
    """Draw all rows of balls, or of a set of rollers, with pitch circle and contact
    angle of one of them; return a note for the axis."""
    points, balls = np.concatenate(draw_rows(ax, rows)), rows[0].bearing.is_ball
    low, high = points.min(axis=0), points.max(axis=0)
    row = min(rows, key=row_position) if balls else rows[0]
    part: Any = row.bearing
    centre = np.array([row_position(row), 0.5e3 * float(part.pitch_diameter)])
    diameter, tall = 1e3 * float(part.element_diameter), high[1] - low[1]
    if balls:
        half, aside = np.array([0.0, 0.5 * diameter]), low[0] - 0.18 * diameter
        at = between(ax, centre - half, centre + half, (aside - centre[0], 0.0))
        text, upright = f"{D_W} = {quantity(part.ball_diameter, 'm')}", {"rotation": 90}
        write_beside(ax, at, (-3, 0), text, ha="right", va="center", **upright)
        angle, name = float(part.free_contact_angle), "free contact angle"
    else:
        angle, name = float(part.axis_angle) + float(part.half_angle), "contact angle"
    beyond = high[0] + 0.2 * diameter
    ax.plot([low[0], beyond + 0.1 * diameter], [centre[1]] * 2, **AXIS)
    pitch_arrow(ax, (beyond, centre[1]), part.pitch_diameter)
    if 0.0 < angle < STEEP:
        top = high[1] + 0.07 * tall, high[1] + 0.14 * tall
        alone = len(rows) == 1 if balls else part.is_crossed
        sense = -1.0 if row.mirrored else 1.0
        contact_angle(ax, centre, angle, top, sense, name, alone)
    room = (0.35 * diameter, 0.0, 0.18) if balls else (0.0, 0.16 * tall, 0.2)
    ax.update_datalim([low - room[:2], high + [0.5 * diameter, room[2] * tall]])
    ax.margins(0.05)
    if not balls or angle < STEEP:
        return ""
    return f"    ({name} {quantity(angle, 'rad')})"


def _name_rings(ax, bearing, parts):
    middle = parts.raceways.mean(axis=1)
    for i, name in enumerate(RACEWAYS):
        back = parts.rings[i][-1]
        at = parts.raceways[i, 0, 0] + 0.22 * parts.length, 0.5 * (middle[i] + back)[1]
        if bearing.is_thrust:  # where the washer is thick
            end = parts.raceways[i, -i]
            at = 0.5 * (end + back)[0], 0.75 * end[1] + 0.25 * parts.centre[1]
        word = "washer" if bearing.is_thrust else "ring"
        look = {"color": COLOURS[name], "rotation": 90 * bearing.is_thrust}
        write(ax, at, f"{name} {word}", zorder=6, bbox=BOX, **look)


def _dimensions(ax, bearing, parts, left, right, high, height):
    """Draw centre lines and dimensions with their labels."""
    centre = parts.centre
    angle = float(bearing.axis_angle)
    along = (parts.axis[1] - parts.axis[0]) / np.linalg.norm(
        parts.axis[1] - parts.axis[0]
    )
    across = np.array([-along[1], along[0]])
    beyond = right + 0.22 * parts.diameter
    ax.plot([left, beyond + 0.1 * parts.diameter], [centre[1]] * 2, **AXIS)
    if angle > 0:
        over = 0.12 * parts.length * along
        ax.plot(*np.stack([parts.axis[0] - over, parts.axis[1] + over]).T, **AXIS)
    turn = np.arctan2(along[1], along[0])
    half = float(bearing.half_angle)
    # Roller diameter, across the roller towards its -z end.
    at = -0.36 * parts.length
    radius = 0.5 * parts.diameter
    spot = centre + at * along
    wide = radius - at * np.sin(half)
    between(ax, spot - wide * across, spot + wide * across)
    text = f"{D_W} = {quantity(bearing.roller_diameter, 'm')}"
    place = spot + 0.5 * radius * across + 0.06 * parts.length * along
    on_line(ax, place, text, turn, "left")
    below = -0.5 * radius * across
    between(ax, parts.axis[0] + below, parts.axis[1] + below)
    text = f"$L_\\mathrm{{we}}$ = {quantity(bearing.roller_length, 'm')}"
    on_line(ax, centre + below + 0.05 * parts.length * along, text, turn)
    pitch_arrow(ax, (beyond, centre[1]), bearing.pitch_diameter)
    if 0.0 < angle + half < STEEP:
        top = high + 0.07 * height, high + 0.14 * height
        contact_angle(ax, centre, angle + half, top)


def cross_sections(
    bearings: Sequence[AbstractBearing | BearingSet],
    titles: Sequence[str],
    catalogue: Sequence[CatalogueEntry] = (),
) -> Figure:
    """Draw axial sections of bearings, each to its own scale [mm].

    Args:
        bearings: At least one.
        titles: Head of each.
        catalogue: Catalogue entry of each, whose boundary dimensions are drawn too.

    Returns:
        The figure, 7 by 6 inches a bearing, at most three in a row.

    Raises:
        ValueError: If there is no bearing, or not a title for each.
    """
    if not bearings or len(titles) != len(bearings):
        raise ValueError(
            f"cross_sections: {len(bearings)} bearings and {len(titles)} titles; there"
            " must be at least one bearing, and a title for each."
        )
    across = min(3, len(bearings))
    down = -(-len(bearings) // across)
    figure = pyplot().figure(figsize=(7.0 * across, 6.0 * down), layout="constrained")
    for k, (bearing, title) in enumerate(zip(bearings, titles, strict=True)):
        entry = catalogue[k] if catalogue else None
        ax = cross_section(bearing, figure.add_subplot(down, across, k + 1), entry)
        ax.set_title(title)
    return figure


_UNPLACED = "angular_contact_ball", "tapered_roller", "spherical_thrust_roller"
"""Types that are not symmetric: the catalogue does not place their side faces."""


def draw_boundary(
    ax: Axes,
    bearing: AbstractBearing | BearingSet,
    entry: CatalogueEntry | None,
    centre: float = 0.0,
) -> None:
    """Draw bore, outside diameter and side faces of the catalogue, dashed, to scale.

    The side faces are left out where the catalogue does not tell their place: of types
    that are not symmetric, and of sets of several bearings. Schematic ring bodies end
    at the lines. Where the elements of the design do not lie between d and D, as the
    design is another, nothing is drawn.

    Args:
        ax: Axes with the rings drawn, z to the right, radius upwards [mm].
        bearing: The design.
        entry: Its catalogue entry, or `None`.
        centre: Radius at which the vertical axis is 0 [mm].
    """
    row: Any = rows_of(bearing)[0].bearing
    pitch, element = float(row.pitch_diameter), float(row.element_diameter)
    if entry is None or not (
        entry.bore < pitch - element and pitch + element < entry.outside_diameter
    ):
        return
    from matplotlib.patches import Rectangle

    sizes = entry.bore, entry.outside_diameter, entry.width
    low, high = 500.0 * np.array(sizes[:2]) - centre
    rows = len(rows_of(bearing))
    placed = (
        rows == len(rows_of(bearing_of_entry(entry))) and entry.type not in _UNPLACED
    )
    z = np.concatenate([patch.get_path().vertices for patch in ax.patches])[:, 0]
    left, right = np.array([-500.0, 500.0]) * sizes[2] if placed else (z.min(), z.max())
    for patch in ax.patches:
        room = Rectangle((left, low), right - left, high - low, transform=ax.transData)
        patch.set_clip_path(room)
    lines = [((left, right), (r, r)) for r in (low, high)]
    lines += [((end, end), (low, high)) for end in (left, right)] if placed else []
    for line in lines:
        ax.plot(*line, "--", color=GREY, lw=1.0, zorder=6, label="_boundary")
    ax.update_datalim([(left, low - 0.07 * (high - low))])
    if not ax.get_autoscaley_on():  # all of it in a view of given limits
        x, y = np.array(ax.get_xlim()), np.array(ax.get_ylim())
        grow = np.abs(np.array([low, high]) - y.mean()).max() / (0.45 * np.ptp(y))
        for set_limits, ends in ((ax.set_xlim, x), (ax.set_ylim, y)):
            set_limits(ends.mean() + max(1.0, grow) * (ends - ends.mean()))
    letter = "H" if "thrust" in entry.type else "T" if "taper" in entry.type else "B"
    bore, outside, width = (quantity(size, "m") for size in sizes)
    words = f"d = {bore}, {letter} = {width}"
    look = {"ha": "left", "zorder": 7, "bbox": BOX}
    # The names of rows stand above.
    away, side = ((2, 4), "bottom") if rows == 1 else ((3, -4), "top")
    write_beside(ax, (left, high), away, f"D = {outside}", va=side, **look)
    write_beside(ax, (left, low), (2, -4), words, va="top", **look)

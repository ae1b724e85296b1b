"""Axial section of a bearing, to scale."""

import numpy as np

from ...catalogue.entry import CatalogueEntry
from ...design import (
    AbstractBearing,
    AbstractRollerBearing,
    BearingSet,
    rows_of,
)
from ..style import (
    BOX,
    COLOURS,
    ELEMENT,
    RACEWAYS,
    SMALL,
    Ax,
    Axes,
    axes_or_new,
    faded,
    write,
)
from .ball_section import D_W, STEEP, ball_section, row_position
from .boundary import draw_boundary
from .dimension import AXIS, between, contact_angle, on_line, pitch_arrow, quantity
from .outline import section
from .roller_section import roller_row


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
    if bearing.is_ball:
        ax = ball_section(bearing, ax)
    else:
        ax = axes_or_new(ax, (7.0, 6.0))
        (_set_section if len(rows) > 1 else _roller_section)(ax, rows)
    draw_boundary(ax, bearing, catalogue)
    return ax


def _roller_section(ax, rows):
    """Draw a row of rollers with its dimensions."""
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
    ax.set_aspect("equal", adjustable="datalim")
    # Limits that stay automatic may widen to keep the aspect.
    ax.update_datalim(
        [
            (left - 0.06 * width, low - 0.16 * height),
            (right + 0.06 * width + 0.35 * parts.diameter, high + 0.24 * height),
        ]
    )
    ax.margins(0.0)
    angle = float(bearing.axis_angle) + float(bearing.half_angle)
    note = f"    (contact angle {quantity(angle, 'rad')})" if angle >= STEEP else ""
    ax.set_xlabel(f"z [mm]{note}")
    ax.set_ylabel("radius [mm]")
    ax.set_title("Axial section, to scale; ring bodies schematic")


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


def _set_section(ax, rows):
    """Draw all rows of a set; pitch circle and contact angle of the first one."""
    corners = []
    crossed = rows[0].bearing.is_crossed
    for k, row in enumerate(rows):
        at = np.array([1e3 * float(row.position), 0.0])
        sense = np.array([-1.0 if row.mirrored else 1.0, 1.0])

        def place(points, at=at, sense=sense):
            return at + np.asarray(points) * sense

        parts = section(row.bearing)
        corners.append(roller_row(ax, parts, place, behind=crossed and k > 0))
    points = np.concatenate(corners)
    low, high = points.min(axis=0), points.max(axis=0)
    row, part = rows[0], rows[0].bearing
    centre = np.array([row_position(row), 0.5e3 * float(part.pitch_diameter)])
    diameter, tall = 1e3 * float(part.roller_diameter), high[1] - low[1]
    beyond = high[0] + 0.2 * diameter
    ax.plot([low[0], beyond + 0.1 * diameter], [centre[1]] * 2, **AXIS)
    pitch_arrow(ax, (beyond, centre[1]), part.pitch_diameter)
    angle = float(part.axis_angle) + float(part.half_angle)
    if 0.0 < angle < STEEP:
        top = high[1] + 0.07 * tall, high[1] + 0.14 * tall
        sense = -1.0 if row.mirrored else 1.0
        contact_angle(ax, centre, angle, top, sense, alone=crossed)
    ax.set_aspect("equal", adjustable="datalim")
    room = np.array([0.5 * diameter, 0.2 * tall])
    ax.update_datalim([low - [0.0, 0.16 * tall], high + room])
    ax.margins(0.05)
    ax.set_xlabel("z [mm]")
    ax.set_ylabel("radius [mm]")
    ax.set_title("Axial section, to scale; ring bodies schematic")

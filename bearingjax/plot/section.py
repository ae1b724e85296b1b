"""Axial section of a bearing, to scale."""

from typing import TYPE_CHECKING

import numpy as np

from ..design import AbstractRollerBearing, Bearing, BearingSet, is_ball, rows_of
from .ball_section import ball_section
from .outline import section
from .style import COLOURS, GREY, RACEWAYS, ROLLER, SMALL, axes_or_new

if TYPE_CHECKING:
    import matplotlib.axes


def cross_section(
    bearing: Bearing | BearingSet, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Axial section of the bearing above its axis, to scale [mm].

    Dimensions of the rings beyond raceways and ribs are not part of the design: they
    are schematic.

    Args:
        bearing: The design; of a set of roller bearings the first row is drawn.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes: z to the right, radius upwards.
    """
    if is_ball(bearing):
        return ball_section(bearing, ax)
    bearing = rows_of(bearing)[0].bearing
    assert isinstance(bearing, AbstractRollerBearing)
    ax = axes_or_new(ax, (7.0, 6.0))
    parts = section(bearing)
    low = min(ring[:, 1].min() for ring in parts.rings)
    high = max(ring[:, 1].max() for ring in parts.rings)
    left, right = parts.rings[0][:, 0].min(), parts.rings[0][:, 0].max()
    height, width = high - low, right - left
    hatches = {"outer": "////", "inner": "\\\\\\\\"}
    for name, ring in zip(RACEWAYS, parts.rings, strict=True):
        colour = COLOURS[name]
        ax.fill(*ring.T, facecolor="white", edgecolor=colour, zorder=1, linewidth=1.4)
        ax.fill(
            *ring.T,
            facecolor=(*_rgb(colour), 0.10),
            edgecolor=(*_rgb(colour), 0.45),
            hatch=hatches[name],
            linewidth=0.0,
            zorder=1,
        )
    ax.fill(
        *parts.roller.T,
        facecolor="#DDF1EA",
        edgecolor=ROLLER,
        linewidth=1.4,
        zorder=2,
        label="roller",
    )
    for i, name in enumerate(RACEWAYS):
        ax.plot(
            *parts.raceways[i].T,
            color=COLOURS[name],
            linewidth=2.2,
            zorder=3,
            label=name,
        )
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
            loc="upper left",
            frameon=False,
            handletextpad=0.2,
            borderpad=0.1,
        )
    _name_rings(ax, parts)
    _dimensions(ax, bearing, parts, left, right, high, height)
    ax.text(
        0.01,
        0.01,
        "ring bodies schematic",
        transform=ax.transAxes,
        fontsize=SMALL,
        color=GREY,
        va="bottom",
    )
    ax.set_aspect("equal", adjustable="datalim")
    # Limits that stay automatic may widen to keep the aspect.
    ax.update_datalim(
        [
            (left - 0.06 * width, low - 0.16 * height),
            (right + 0.06 * width + 0.35 * parts.diameter, high + 0.24 * height),
        ]
    )
    ax.margins(0.0)
    ax.set_xlabel("z [mm]")
    ax.set_ylabel("radius [mm]")
    ax.set_title("Axial section, to scale")
    return ax


def _rgb(colour):
    from matplotlib.colors import to_rgb

    return to_rgb(colour)


def _name_rings(ax, parts):
    middle = parts.raceways.mean(axis=1)
    for i, name in enumerate(RACEWAYS):
        back = parts.rings[i][-1, 1]
        ax.text(
            parts.raceways[i, 0, 0] + 0.22 * parts.length,
            0.5 * (middle[i, 1] + back),
            f"{name} ring",
            fontsize=SMALL,
            color=COLOURS[name],
            ha="center",
            va="center",
            zorder=6,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
        )


def _dimensions(ax, bearing, parts, left, right, high, height):
    """Centre lines and dimensions with their labels."""
    dash = {"color": GREY, "linestyle": (0, (9, 3, 2, 3)), "linewidth": 0.9}
    centre = np.array([0.0, parts.pitch_radius])
    angle = float(bearing.axis_angle)
    along = (parts.axis[1] - parts.axis[0]) / np.linalg.norm(
        parts.axis[1] - parts.axis[0]
    )
    across = np.array([-along[1], along[0]])
    beyond = right + 0.22 * parts.diameter
    ax.plot([left, beyond + 0.1 * parts.diameter], [parts.pitch_radius] * 2, **dash)
    if angle > 0:
        over = 0.12 * parts.length * along
        ax.plot(*np.stack([parts.axis[0] - over, parts.axis[1] + over]).T, **dash)
    turn = np.rad2deg(np.arctan2(along[1], along[0]))
    half = float(bearing.half_angle)
    # Roller diameter, across the roller towards its -z end.
    at = -0.36 * parts.length
    radius = 0.5 * parts.diameter
    spot = centre + at * along
    wide = radius - at * np.sin(half)
    _arrow(ax, spot - wide * across, spot + wide * across)
    _label(
        ax,
        spot + 0.5 * radius * across + 0.06 * parts.length * along,
        f"$D$ = {_mm(bearing.roller_diameter)}",
        turn,
        "left",
    )
    below = -0.5 * radius * across
    _arrow(ax, parts.axis[0] + below, parts.axis[1] + below)
    _label(
        ax,
        centre + below + 0.05 * parts.length * along,
        f"$L$ = {_mm(bearing.roller_length)}",
        turn,
        "center",
    )
    ax.annotate(
        "",
        (beyond, parts.pitch_radius),
        (0, -70),
        textcoords="offset points",
        arrowprops=_ARROW | {"arrowstyle": "-|>"},
        zorder=6,
    )
    ax.annotate(
        f"pitch Ø {_mm(bearing.pitch_diameter)}",
        (beyond, parts.pitch_radius),
        (3, -10),
        textcoords="offset points",
        rotation=90,
        fontsize=SMALL,
        ha="left",
        va="top",
        zorder=6,
    )
    if angle > 0:
        _contact_angle(ax, parts, centre, angle + half, high, height)


def _contact_angle(ax, parts, centre, contact, high, height):
    """The angle of the outer contact normal to the radial direction."""
    normal = np.array([np.sin(contact), np.cos(contact)])
    reach = high + 0.14 * height - centre[1]
    thin = {"color": GREY, "linewidth": 0.9, "zorder": 4}
    ends = np.stack([centre, centre + normal * reach / normal[1]])
    ax.plot(*ends.T, **thin)
    ax.plot([0.0, 0.0], [centre[1], centre[1] + reach], **thin)
    radius = high + 0.07 * height - centre[1]
    turn = np.linspace(0.0, contact, 30)
    arc = centre + radius * np.stack([np.sin(turn), np.cos(turn)], axis=1)
    ax.plot(*arc.T, **thin)
    ax.annotate(
        f"contact angle $α$ = {np.rad2deg(contact):.4g}°",
        ends[1],
        (6, 0),
        textcoords="offset points",
        fontsize=SMALL,
        va="center",
    )


_ARROW = {
    "arrowstyle": "<|-|>",
    "color": "black",
    "linewidth": 0.9,
    "shrinkA": 0,
    "shrinkB": 0,
    "mutation_scale": 9,
}


def _arrow(ax, start, stop):
    ax.annotate("", tuple(stop), tuple(start), arrowprops=_ARROW, zorder=6)


def _label(ax, at, text, turn, ha):
    ax.text(
        *at,
        text,
        rotation=turn,
        rotation_mode="anchor",
        fontsize=SMALL,
        ha=ha,
        va="center",
        zorder=7,
        bbox={"facecolor": "#DDF1EA", "edgecolor": "none", "pad": 0.6},
    )


def _mm(value):
    return f"{1e3 * float(value):.5g} mm"

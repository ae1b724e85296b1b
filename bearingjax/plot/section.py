"""Axial section of a bearing, to scale."""

from typing import TYPE_CHECKING, NamedTuple

import jax.numpy as jnp
import numpy as np

from ..contact import Palmgren
from ..design.bearing import AbstractRollerBearing
from ..element.constants import contact_constants
from ..numerics import Midpoint
from .style import COLOURS, GREY, RACEWAYS, ROLLER, SMALL, axes_or_new

if TYPE_CHECKING:
    import matplotlib.axes

_BODY = 0.35  # thickness of the schematic rings, roller diameters
_BESIDE = 0.28  # width of the schematic rings beside roller and ribs, roller diameters


class Section(NamedTuple):
    """Section of a bearing through the axis of one roller; points are (z, r) [mm].

    Attributes:
        roller: Outline of the roller (point, 2).
        rings: Outlines of outer and inner ring, each (point, 2).
        raceways: Ends of both raceway generators (2, 2, 2): ring, end, point.
        axis: Ends of the roller axis (2, 2).
        generators: Unit vectors along both generators, towards +z (2, 2).
        rib_points: Contact point on every rib (rib, 2).
        pitch_radius: Radius of the pitch circle [mm].
        diameter: Roller diameter [mm].
        length: Roller length [mm].
    """

    roller: np.ndarray
    rings: tuple[np.ndarray, np.ndarray]
    raceways: np.ndarray
    axis: np.ndarray
    generators: np.ndarray
    rib_points: np.ndarray
    pitch_radius: float
    diameter: float
    length: float


def section(bearing: AbstractRollerBearing) -> Section:
    """Outlines of roller and rings in the section plane.

    Args:
        bearing: The design.
    """
    length = 1e3 * float(bearing.roller_length)
    diameter = 1e3 * float(bearing.roller_diameter)
    pitch_radius = 0.5e3 * float(bearing.pitch_diameter)
    half, tilt = float(bearing.half_angle), -float(bearing.axis_angle)
    along = np.array([np.cos(tilt), np.sin(tilt)])
    across = np.array([-np.sin(tilt), np.cos(tilt)])

    def to_plane(points):
        """(z, r) of points in the roller's axes (t, m)."""
        points = np.asarray(points)
        return (
            np.array([0.0, pitch_radius])
            + points[..., :1] * along
            + points[..., 1:] * across
        )

    reach = 0.5 * length * np.cos(half)
    ends = np.array([-1.0, 1.0])
    radii = 0.5 * diameter - ends * 0.5 * length * np.sin(half)
    clearance = 0.25e3 * float(bearing.radial_internal_clearance)
    raceways, generators = [], []
    for sign in (1.0, -1.0):
        away = np.array([np.sin(half), sign * np.cos(half)])
        edge = np.stack([ends * reach, sign * radii], axis=1)
        raceways.append(to_plane(edge + clearance * away))
        generators.append(np.cos(half) * along - sign * np.sin(half) * across)
    raceways, generators = np.stack(raceways), np.stack(generators)

    ribs = _ribs(bearing)
    roller = to_plane(_roller_outline(bearing, ribs))
    lines = {
        name: _rib_line(name, rib, to_plane, along, across, diameter)
        for name, rib in ribs.items()
    }
    # Side faces of the rings: clear of the roller and of all ribs.
    corners = np.concatenate([roller, raceways.reshape(-1, 2), *lines.values()])
    faces = (
        corners[:, 0].min() - _BESIDE * diameter,
        corners[:, 0].max() + _BESIDE * diameter,
    )
    outer, inner = (
        _ring_outline(name, raceways[i], lines, faces, _BODY * diameter)
        for i, name in enumerate(RACEWAYS)
    )
    return Section(
        roller=roller,
        rings=(outer, inner),
        raceways=raceways,
        axis=to_plane(np.stack([ends * reach, np.zeros(2)], axis=1)),
        generators=generators,
        rib_points=to_plane(
            np.array([rib["point"] for rib in ribs.values()]).reshape(-1, 2)
        ),
        pitch_radius=pitch_radius,
        diameter=diameter,
        length=length,
    )


def _ribs(bearing):
    """Contact point, normal, height and sphere radius of every rib, in mm."""
    contacts = contact_constants(bearing, Palmgren(), Midpoint()).ribs
    if contacts is None:
        return {}
    return {
        name: {
            "point": 1e3 * np.asarray(contacts.point[i]),
            "normal": np.asarray(contacts.normal[i]),
            "height": 1e3 * float(getattr(bearing.ribs, name).contact_height),
            "end_radius": 1e3 * float(getattr(bearing.ribs, name).end_radius),
        }
        for i, name in enumerate(contacts.names)
    }


def _rib_line(name, rib, to_plane, along, across, diameter):
    """Foot and top of a rib's face (2, 2), in (z, r)."""
    sign = 1.0 if name.startswith("outer") else -1.0
    normal = rib["normal"]
    # Square to the normal, from the raceway towards the roller axis.
    rise = np.array([-normal[1], normal[0]])
    rise *= -sign * np.sign(rise[1])
    height = max(rib["height"] + 0.08 * diameter, 0.18 * diameter)
    foot = rib["point"] - rib["height"] * rise
    return to_plane(np.stack([foot, foot + height * rise]))


def _roller_outline(bearing, ribs):
    """Closed outline of the roller in (t, m), with profile and end spheres, in mm."""
    length, half = 1e3 * float(bearing.roller_length), float(bearing.half_angle)
    diameter = 1e3 * float(bearing.roller_diameter)
    turn = jnp.linspace(0.0, jnp.pi, 401, dtype=bearing.roller_length.dtype)
    position = -0.5 * bearing.roller_length * jnp.cos(turn)
    drop = 1e3 * np.asarray(
        bearing.roller_profile.drop(
            position, bearing.roller_length, bearing.roller_diameter
        )
    )
    s = 1e3 * np.asarray(position)
    x, y = s * np.cos(half), 0.5 * diameter - s * np.sin(half) - drop
    # Some profiles grow without limit at the very end.
    keep = np.isfinite(drop) & (drop < 0.01 * diameter)
    spheres = {}
    for side, word in ((-1.0, "minus"), (1.0, "plus")):
        radius = [r["end_radius"] for n, r in ribs.items() if n.endswith(word)]
        spheres[side] = radius[0] if radius else np.inf

    def end(side, height):
        radius = spheres[side]
        back = 0.0
        if np.isfinite(radius):
            back = radius - np.sqrt(np.maximum(radius**2 - height**2, 0.0))
        return side * (0.5 * length * np.cos(half) - back)

    keep &= (x >= end(-1.0, y)) & (x <= end(1.0, y))
    x, y = x[keep], y[keep]
    left, right = np.linspace(0.0, y[0], 40), np.linspace(y[-1], 0.0, 40)
    upper = np.concatenate(
        [
            np.stack([end(-1.0, left) + 0.0 * left, left], axis=1),
            np.stack([x, y], axis=1),
            np.stack([end(1.0, right) + 0.0 * right, right], axis=1),
        ]
    )
    return np.concatenate([upper, upper[::-1] * np.array([1.0, -1.0])])


def _ring_outline(name, raceway, lines, faces, body):
    """Outline of a ring: back, side faces, ribs that exist, raceway."""
    slope = (raceway[1] - raceway[0]) / (raceway[1, 0] - raceway[0, 0])
    inside = []
    for word, face in zip(("minus", "plus"), faces, strict=True):
        line = lines.get(f"{name}_{word}")
        if line is None:
            part = [raceway[0] + slope * (face - raceway[0, 0])]
        else:
            # Rib face and raceway meet in a corner.
            foot, top = line
            matrix = np.stack([slope, foot - top], axis=1)
            corner = raceway[0] + slope * np.linalg.solve(matrix, foot - raceway[0])[0]
            part = [np.array([face, top[1]]), top, corner]
        inside.append(part if word == "minus" else part[::-1])
    inside = np.array(inside[0] + inside[1])
    if name == "outer":
        back = inside[:, 1].max() + body
    else:
        back = inside[:, 1].min() - min(body, 0.7 * inside[:, 1].min())
    return np.concatenate([inside, [[faces[1], back], [faces[0], back]]])


def cross_section(
    bearing: AbstractRollerBearing, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Axial section of the bearing above its axis, to scale [mm].

    Dimensions of the rings beyond raceways and ribs are not part of the design: they
    are schematic.

    Args:
        bearing: The design.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes: z to the right, radius upwards.
    """
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

"""Drawing of a rotor to scale: shaft, discs, bearings, housings, stations."""

from typing import Annotated, NamedTuple

import numpy as np

from ...design import AbstractBallBearing, Material, rows_of
from ...numerics.units import unit
from ...rotor import BearingSupport, Disc, Rotor
from ..drawings.outline import section
from ..drawings.row_section import STEEP, ball_row, placer, row_position
from ..style import (
    COLOURS,
    ELEMENT,
    GREY,
    OUTER,
    RACEWAYS,
    ROLLER,
    SMALL,
    Ax,
    Axes,
    axes_or_new,
    towards_white,
)

_STEEL = "#B0B0B0"
_LEAST = 0.022
"""Least distance of numbered stations, over the length of the shaft."""


def rotor_section(rotor: Rotor, ax: Ax = None) -> Axes:
    """Draw the axial section of a rotor, to scale [mm].

    A disc is the cylinder on the shaft with its mass and moments of inertia, a point
    mass a ball of the shaft's material. Bearings have their true rolling elements, and
    dashed lines of action; a support given by a matrix or a law is a symbol. Stations
    are numbered above.

    Returns:
        The axes: z to the right, x or y upwards.
    """
    ax = axes_or_new(ax, (10.0, 5.0))
    stations = 1e3 * np.asarray(rotor.shaft.stations, dtype=float)
    outer = 500.0 * np.asarray(rotor.shaft.outer_diameter, dtype=float)
    bore = 500.0 * np.asarray(rotor.shaft.bore, dtype=float)
    length = stations[-1] - stations[0]
    _shaft(ax, stations, outer, bore)
    reach = float(outer.max())
    for part in rotor.discs:
        reach = max(reach, _part(ax, rotor, part, stations, outer))
    size = max(0.35 * float(outer.max()), 0.022 * length)
    low = reach
    for support in rotor.supports:
        low = max(low, _support(ax, support, stations, outer, size))
    ax.axhline(0.0, color=GREY, ls=(0, (9, 3, 2, 3)), lw=0.9, zorder=7)
    _numbers(ax, stations, length)
    ax.set_aspect("equal", adjustable="datalim")
    margin = 0.03 * length + size
    ax.update_datalim(
        [
            (stations[0] - margin, -1.08 * low),
            (stations[-1] + margin, 1.1 * reach),
        ]
    )
    ax.margins(0.02)
    ax.set_xlabel("z [mm]")
    ax.set_ylabel("radius [mm]")
    ax.set_title("Rotor, to scale")
    return ax


def _shaft(ax, stations, outer, bore):
    """Draw segments in section: solid, or two walls about a bore."""
    for k, (left, right) in enumerate(zip(stations[:-1], stations[1:], strict=True)):
        pieces = [(bore[k], outer[k]), (-outer[k], -bore[k])]
        for low, high in pieces if bore[k] > 0 else [(-outer[k], outer[k])]:
            ax.fill(
                [left, right, right, left],
                [low, low, high, high],
                facecolor=towards_white(_STEEL, 0.35),
                edgecolor="black",
                linewidth=0.9,
                zorder=2,
                label="_segment",
            )


def _radius_at(outer, station):
    """Return the larger radius of the segments adjacent to a station [mm]."""
    return float(outer[max(station - 1, 0) : station + 1].max())


def _part(ax, rotor, part, stations, outer):
    """Draw a disc or a point mass; return its largest radius."""
    from matplotlib.patches import Circle

    z, radius = stations[part.station], _radius_at(outer, part.station)
    given = rotor.shaft.material
    material = (
        given[min(part.station, len(given) - 1)] if isinstance(given, tuple) else given
    )
    size = disc_size(part, 2e-3 * radius, material) if isinstance(part, Disc) else None
    colour = {"facecolor": towards_white(OUTER, 0.6), "edgecolor": OUTER}
    if size is None:
        ball = _ball_radius(float(part.mass), material)
        ax.add_patch(Circle((z, 0.0), ball, zorder=5, label="_mass", **colour))
        return max(radius, ball)
    left, right = z - 0.5 * size.width, z + 0.5 * size.width
    for side in (1.0, -1.0):
        ax.fill(
            [left, right, right, left],
            side * np.array([size.bore, size.bore, size.outer, size.outer]),
            zorder=3,
            label="_disc",
            **colour,
        )
    return size.outer


def _support(ax, support, stations, outer, size):
    """Draw a bearing and its housing or ground; return the largest radius below."""
    z, radius = stations[support.station], _radius_at(outer, support.station)
    if isinstance(support, BearingSupport):
        outside = _draw_bearing(ax, support, z)
    elif hasattr(support, "law"):
        outside = _draw_law(ax, support, z, radius, size)
    else:
        outside = radius + 1.6 * size
        _draw_spring(ax, z, (-radius, -outside), 0.8 * size)
    return _draw_below(ax, support, z, outside, size)


def _numbers(ax, stations, length):
    """Number stations on the upper axis, as space allows."""
    shown, last = [], -np.inf
    for k, z in enumerate(stations):
        if z - last >= _LEAST * length:
            shown.append(k)
            last = z
    above = ax.secondary_xaxis("top")
    above.set_xticks(stations[shown], [str(k) for k in shown], fontsize=SMALL)
    above.set_xlabel("station", fontsize=SMALL)
    for z in stations:
        ax.axvline(z, color=GREY, ls=":", lw=0.6, zorder=0, label="_station")


_LIGHT = 0.85


class Cylinder(NamedTuple):
    """Drawn shape of a disc.

    Attributes:
        outer, bore: Radii [mm].
        width: Along the shaft [mm].
    """

    outer: Annotated[float, unit("mm")]
    bore: Annotated[float, unit("mm")]
    width: Annotated[float, unit("mm")]


def disc_size(disc: Disc, shaft_diameter: float, material: Material) -> Cylinder | None:
    """Return the cylinder on the shaft with the disc's mass and moments of inertia.

    Its outer diameter follows from the polar moment of inertia, its width from the
    diametral one; where that is one of a thin disc, from the mass.

    Args:
        disc: The disc.
        shaft_diameter: Diameter of its bore [m].
        material: Material of the cylinder, where the width follows from the mass.

    Returns:
        The cylinder; `None` if the moment of inertia is less than that of a ring on
        the shaft: a point mass.
    """
    mass, polar = float(disc.mass), float(disc.polar_inertia)
    outer2 = 8.0 * polar / mass - shaft_diameter**2 if mass > 0 else 0.0
    if outer2 <= shaft_diameter**2:
        return None
    width2 = 12.0 * (float(disc.diametral_inertia) - 0.5 * polar) / mass
    area = 0.25 * np.pi * (outer2 - shaft_diameter**2)
    thin = width2 <= 1e-6 * outer2
    width = mass / (float(material.density) * area) if thin else np.sqrt(width2)
    return Cylinder(500.0 * np.sqrt(outer2), 500.0 * shaft_diameter, 1e3 * width)


def _ball_radius(mass, material):
    """Return the radius of a ball of a mass and a material [mm]."""
    return 1e3 * (0.75 * mass / (np.pi * float(material.density))) ** (1.0 / 3.0)


def _draw_bearing(ax, support, z):
    """Draw both sides of a bearing, whose station is at z [mm]; return its radius."""
    bearing = support.element.bearing
    turned = -1.0 if support.turned else 1.0
    outside = 0.0
    for row in rows_of(bearing):
        sense = turned * (-1.0 if row.mirrored else 1.0)
        if bearing.is_ball:
            part = row.bearing
            assert isinstance(part, AbstractBallBearing)
            radius = 0.5e3 * float(part.pitch_diameter)
            centre = np.array([z + turned * row_position(row), radius])
            for side in (1.0, -1.0):
                ball_row(ax, part, placer(centre, sense, side))
            outside = max(outside, centre[1] + 0.9e3 * float(part.ball_diameter))
            if part.is_one_sided:
                _line_of_action(ax, float(part.free_contact_angle), sense, centre)
        else:
            at = np.array([z + turned * 1e3 * float(row.position), 0.0])
            outside = max(outside, _draw_rollers(ax, row.bearing, sense, at))
    return outside


def _draw_rollers(ax, bearing, sense, at):
    parts = section(bearing)
    for side in (1.0, -1.0):
        place = placer(at, sense, side)
        for name, ring in zip(RACEWAYS, parts.rings, strict=True):
            fill = towards_white(COLOURS[name], _LIGHT)
            ax.fill(*place(ring).T, facecolor=fill, edgecolor=COLOURS[name], zorder=3)
        ax.fill(*place(parts.roller).T, zorder=4, **ELEMENT)
    angle = float(bearing.axis_angle) + float(bearing.half_angle)
    if 0.0 < angle < STEEP:
        centre = at + parts.centre * np.array([sense, 1.0])
        _line_of_action(ax, angle, sense, centre)
    return max(ring[:, 1].max() for ring in parts.rings)


def _line_of_action(ax, angle, sense, centre):
    """Draw the line of action from the rolling element to the axis."""
    foot = centre[0] - sense * centre[1] * np.tan(angle)
    for side in (1.0, -1.0):
        ax.plot(
            [centre[0], foot], [side * centre[1], 0.0], "--", color=GREY, lw=0.8,
            zorder=6, label="_line of action",
        )  # fmt: skip


def _draw_law(ax, support, z, shaft_radius, size):
    """Draw the balls of a support given by its law; return its radius [mm]."""
    from matplotlib.patches import Circle

    sense = -1.0 if getattr(support, "turned", False) else 1.0
    centre = np.array([z, shaft_radius + 0.75 * size])
    for side in (1.0, -1.0):
        spot = (z, side * centre[1])
        ax.add_patch(Circle(spot, 0.5 * size, zorder=4, **ELEMENT))
    _line_of_action(ax, float(support.law.contact_angle), sense, centre)
    return shaft_radius + 1.25 * size


def _draw_spring(ax, z, ends, width):
    """Draw a spring across the shaft, of the radial ends and the width given [mm]."""
    share = np.concatenate([[0.0], np.linspace(0.2, 0.8, 9), [1.0]])
    side = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], 4)[:7], [0.0, 0.0]])
    r = ends[0] + share * (ends[1] - ends[0])
    ax.plot(z + 0.5 * width * side, r, color=ROLLER, lw=1.3, zorder=4, label="_spring")


def _draw_ground(ax, z, r, size):
    """Draw ground: a line about (z, r), hatched below."""
    from matplotlib.patches import Rectangle

    ax.add_patch(
        Rectangle(
            (z - size, r - 0.35 * size), 2.0 * size, 0.35 * size,
            facecolor="white", edgecolor=GREY, hatch="/////", lw=0.0, zorder=1,
        )
    )  # fmt: skip
    ax.plot([z - size, z + size], [r, r], color=GREY, lw=1.4, zorder=2, label="_ground")


def _draw_below(ax, support, z, outside, size):
    """Draw housing, springs and ground; return the radius of the lowest point [mm]."""
    from matplotlib.patches import Rectangle

    low = outside
    if support.housing is not None:
        ax.add_patch(
            Rectangle(
                (z - 0.9 * size, -low - 0.7 * size), 1.8 * size, 0.7 * size,
                facecolor=towards_white(GREY, _LIGHT), edgecolor=GREY, zorder=3,
                label="_housing",
            )
        )  # fmt: skip
        _draw_spring(ax, z, (-low - 0.7 * size, -low - 1.9 * size), 0.6 * size)
        low += 1.9 * size
    _draw_ground(ax, z, -low, size)
    return low + 0.35 * size

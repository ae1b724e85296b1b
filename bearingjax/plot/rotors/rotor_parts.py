"""Drawn parts of a rotor: discs, bearings, springs, housings."""

from typing import Annotated, Any, NamedTuple

import numpy as np

from ...design import AbstractBallBearing, Material, rows_of
from ...numerics.units import unit
from ...rotor import AbstractSupport, BearingSupport, Disc
from ..drawings.ball_section import STEEP, ball_row, row_position
from ..drawings.outline import section
from ..style import COLOURS, ELEMENT, GREY, RACEWAYS, ROLLER, towards_white

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


def ball_radius(mass: float, material: Material) -> float:
    """Return the radius of a ball of given mass [mm].

    Args:
        mass: [kg].
        material: Material of the ball.
    """
    return 1e3 * (0.75 * mass / (np.pi * float(material.density))) ** (1.0 / 3.0)


def draw_bearing(ax: Any, support: BearingSupport, z: float) -> float:
    """Draw rolling elements, rings and contact lines at both sides of the shaft.

    Args:
        ax: Axes.
        support: The bearing on the shaft.
        z: Axial position of its station [mm].

    Returns:
        Radius of its outside [mm].
    """
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
                ball_row(ax, part, _place(sense, centre, side))
            outside = max(outside, centre[1] + 0.9e3 * float(part.ball_diameter))
            if part.is_one_sided:
                _line_of_action(ax, float(part.free_contact_angle), sense, centre)
        else:
            at = np.array([z + turned * 1e3 * float(row.position), 0.0])
            outside = max(outside, _draw_rollers(ax, row.bearing, sense, at))
    return outside


def _place(sense, centre, side):
    def place(points):
        there = centre + np.asarray(points) * np.array([sense, 1.0])
        return there * np.array([1.0, side])

    return place


def _draw_rollers(ax, bearing, sense, at):
    parts = section(bearing)
    for side in (1.0, -1.0):
        place = _place(sense, at, side)
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


def draw_law(
    ax: Any, support: Any, z: float, shaft_radius: float, size: float
) -> float:
    """Draw a bearing given by its law: balls and their line of contact.

    Args:
        ax: Axes.
        support: With a `law` and `turned`.
        z: Axial position of its station [mm].
        shaft_radius: There [mm].
        size: Size of the symbol [mm].

    Returns:
        Radius of its outside [mm].
    """
    from matplotlib.patches import Circle

    sense = -1.0 if getattr(support, "turned", False) else 1.0
    centre = np.array([z, shaft_radius + 0.75 * size])
    for side in (1.0, -1.0):
        spot = (z, side * centre[1])
        ax.add_patch(Circle(spot, 0.5 * size, zorder=4, **ELEMENT))
    _line_of_action(ax, float(support.law.contact_angle), sense, centre)
    return shaft_radius + 1.25 * size


def draw_spring(ax: Any, z: float, ends: tuple[float, float], width: float) -> None:
    """Draw a spring across the shaft.

    Args:
        ax: Axes.
        z: Axial position [mm].
        ends: Radial coordinates of its ends [mm].
        width: Width of its turns [mm].
    """
    share = np.concatenate([[0.0], np.linspace(0.2, 0.8, 9), [1.0]])
    side = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], 4)[:7], [0.0, 0.0]])
    r = ends[0] + share * (ends[1] - ends[0])
    ax.plot(z + 0.5 * width * side, r, color=ROLLER, lw=1.3, zorder=4, label="_spring")


def draw_ground(ax: Any, z: float, r: float, size: float) -> None:
    """Draw ground: a line, hatched below.

    Args:
        ax: Axes.
        z, r: Middle of the line [mm].
        size: Size of the symbol [mm].
    """
    from matplotlib.patches import Rectangle

    ax.add_patch(
        Rectangle(
            (z - size, r - 0.35 * size), 2.0 * size, 0.35 * size,
            facecolor="white", edgecolor=GREY, hatch="/////", lw=0.0, zorder=1,
        )
    )  # fmt: skip
    ax.plot([z - size, z + size], [r, r], color=GREY, lw=1.4, zorder=2, label="_ground")


def draw_below(
    ax: Any, support: AbstractSupport, z: float, outside: float, size: float
) -> float:
    """Draw housing, springs and ground below a support.

    Args:
        ax: Axes.
        support: The support.
        z: Axial position of its station [mm].
        outside: Radius at which it ends [mm].
        size: Size of the symbols [mm].

    Returns:
        Radius of the lowest point [mm].
    """
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
        draw_spring(ax, z, (-low - 0.7 * size, -low - 1.9 * size), 0.6 * size)
        low += 1.9 * size
    draw_ground(ax, z, -low, size)
    return low + 0.35 * size

"""Drawing of a rotor to scale: shaft, discs, bearings, housings, stations."""

import numpy as np

from ...rotor import BearingSupport, Disc, Rotor
from ..style import GREY, OUTER, SMALL, Ax, Axes, axes_or_new, towards_white
from .rotor_parts import (
    ball_radius,
    disc_size,
    draw_bearing,
    draw_below,
    draw_law,
    draw_spring,
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
        ball = ball_radius(float(part.mass), material)
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
        outside = draw_bearing(ax, support, z)
    elif hasattr(support, "law"):
        outside = draw_law(ax, support, z, radius, size)
    else:
        outside = radius + 1.6 * size
        draw_spring(ax, z, (-radius, -outside), 0.8 * size)
    return draw_below(ax, support, z, outside, size)


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

"""Balls: contact angles around the bearing, ellipses on the raceways."""

from typing import TYPE_CHECKING

import numpy as np

from ..design import AbstractBallBearing
from ..statics.solution import BallSolution
from .style import (
    COLOURS,
    GREY,
    RACEWAYS,
    SMALL,
    axes_or_new,
    raceway_index,
    row_slice,
    row_slices,
)

if TYPE_CHECKING:
    import matplotlib.axes

_MARKERS = ("o", "s", "^", "D")


def contact_angles(
    solution: BallSolution, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Contact angle of every loaded contact [deg] against azimuth [deg].

    The area of a marker grows with the load of the contact; each row of a set has its
    own shape.

    Args:
        solution: A single solution of a ball bearing.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    azimuth = np.rad2deg(np.asarray(solution.azimuth)) % 360.0
    angle = np.rad2deg(np.asarray(solution.contact_angle))
    load = np.asarray(solution.contact_load)
    top = max(float(load.max()), 1e-300)
    loaded = load > 1e-9 * top
    half = load.shape[1] // 2
    rows = row_slices(solution)
    for number, row in enumerate(rows):
        for ring, name in enumerate(RACEWAYS):
            for arc in range(half):
                k = ring * half + arc
                shown = loaded[row, k]
                label = f"{name} raceway"
                if len(rows) > 1:
                    label += f", row {number}"
                ax.scatter(
                    azimuth[row][shown],
                    angle[row][shown, k],
                    s=12.0 + 60.0 * load[row][shown, k] / top,
                    marker=_MARKERS[number % len(_MARKERS)],
                    facecolor=COLOURS[name],
                    edgecolor="white",
                    linewidth=0.6,
                    label=label if arc == 0 else None,
                    zorder=3,
                )
    ax.set_xlim(-8.0, 368.0)
    ax.set_xticks(np.arange(0, 361, 60))
    ax.grid(color="0.9")
    ax.set_axisbelow(True)
    ax.set_xlabel("azimuth [deg]")
    ax.set_ylabel("contact angle [deg]")
    ax.set_title("Contact angles (area of a marker: load)")
    ax.legend(fontsize=SMALL, frameon=False, loc="best")
    return ax


def ellipses(
    bearing: AbstractBallBearing,
    solution: BallSolution,
    *,
    raceway: str = "inner",
    row: int = 0,
    ax: "matplotlib.axes.Axes | None" = None,
) -> "matplotlib.axes.Axes":
    """Contact ellipses on a raceway that is rolled out, with its shoulders.

    Upwards runs the arc of the groove from its bottom [mm]; to the right the azimuth,
    where each ellipse is drawn to the scale of the upward axis.

    Args:
        bearing: The design; of a set, that of the row.
        solution: Its single solution.
        raceway: "outer" or "inner".
        row: Which row of a set.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.

    Raises:
        ValueError: If `raceway` is unknown or the set has no such row.
    """
    ring = raceway_index(raceway)
    ax = axes_or_new(ax)
    mine = row_slice(solution, row)
    azimuth = np.rad2deg(np.asarray(solution.azimuth)[mine]) % 360.0
    half = solution.contact_load.shape[1] // 2
    grooves = [g for g in bearing.grooves if g.on_outer is (ring == 0)]
    pressure = 1e-6 * np.asarray(solution.contact_pressure)[mine]
    top = max(float(pressure.max()), 1e-300)
    drawn = []
    for arc, groove in enumerate(grooves):
        k = ring * half + arc
        radius = 1e3 * float(groove.radius)
        angle = np.asarray(solution.contact_angle)[mine, k] - bearing.groove_axis
        along, across = 1e3 * np.asarray(solution.semi_axes)[mine, k].T
        parts = (azimuth, radius * angle, along, across, pressure[:, k] / top)
        loaded = np.asarray(solution.contact_load)[mine, k] > 0
        drawn.append(np.stack(parts)[:, loaded])
        _shoulders(ax, bearing, raceway, groove, radius)
    _, place, _, across, _ = patches = np.concatenate(drawn, axis=1)
    ends = np.concatenate([place - across, place + across, [0.0]])
    for line in ax.lines:
        ends = np.append(ends, np.asarray(line.get_ydata(), dtype=float))
    room = 0.08 * (np.ptp(ends) or 1.0)
    ax.set_ylim(ends.min() - room, ends.max() + room)
    ax.set_xlim(-15.0, 375.0)
    _ellipse_patches(ax, patches, COLOURS[raceway])
    ax.set_xticks(np.arange(0, 361, 60))
    ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle=":")
    ax.set_xlabel("azimuth [deg]")
    ax.set_ylabel("along the groove, from its bottom [mm]")
    which = f", row {row}" if len(solution.row_sizes) > 1 else ""
    ax.set_title(f"Contact ellipses on the {raceway} raceway{which}")
    return ax


def _ellipse_patches(ax, patches, colour):
    """Ellipses (azimuth, place, semi-axes, shade) in equal scale, both axes set."""
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Ellipse

    box, figure = ax.get_position(), ax.figure.get_size_inches()
    degrees = np.ptp(ax.get_xlim()) / (box.width * figure[0])
    millimetres = np.ptp(ax.get_ylim()) / (box.height * figure[1])
    for azimuth, place, along, across, share in patches.T:
        for at in (azimuth - 360.0, azimuth, azimuth + 360.0):
            if not ax.get_xlim()[0] < at < ax.get_xlim()[1]:
                continue
            ax.add_patch(
                Ellipse(
                    (at, place),
                    2.0 * along * degrees / millimetres,
                    2.0 * across,
                    facecolor=(*to_rgb(colour), 0.15 + 0.6 * float(share)),
                    edgecolor=colour,
                    linewidth=1.0,
                    zorder=3,
                )
            )


def _shoulders(ax, bearing, raceway, groove, radius):
    height = getattr(bearing, f"{raceway}_shoulder")
    if height is None:
        return
    cosine = float(groove.deepest) - 1e3 * float(height) / radius
    if abs(cosine) >= 1.0:
        return
    edge = radius * np.arccos(cosine)
    for side in (edge, -edge):
        if groove.open_side and side < 0.0 and bearing.groove_axis == 0.0:
            continue  # cut away
        ax.axhline(side, color="black", linewidth=1.6)
        ax.text(
            0.995,
            side,
            "shoulder ",
            transform=ax.get_yaxis_transform(),
            ha="right",
            va="bottom" if side > 0 else "top",
            fontsize=SMALL,
        )

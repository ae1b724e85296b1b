"""Balls: contact angles around the bearing, ellipses on the raceways."""

import numpy as np

from ..design import AbstractBallBearing, AbstractBearing, BearingSet
from ..statics.solution import BallSolution
from .panel import finish
from .style import (
    COLOURS,
    GREY,
    RACEWAYS,
    SMALL,
    Ax,
    Axes,
    axes_or_new,
    degrees,
    faded,
    raceway_index,
    row_slice,
    row_slices,
    widen_limits,
    write,
)

_MARKERS = ("o", "s", "^", "D")
_LEAST_SPAN = 2.0
"""Least span of the axis of contact angles [deg]."""
_BOX = 0.62
"""Height over width of a developed raceway."""
_ARC = 0.48
"""Half of the least arc of the groove shown, ball diameters."""
_AZIMUTHS = (-15.0, 375.0)


def contact_angles(solution: BallSolution, ax: Ax = None) -> Axes:
    """Plot the contact angle of every loaded contact [deg] against azimuth [deg].

    The area of a marker grows with the load of the contact. Markers of the outer
    raceway are hollow, those of the inner one full and smaller, so that neither hides
    the other; each row of a set has its own shape.

    Args:
        solution: A single solution of a ball bearing.

    Returns:
        The axes; theirs is a span of two degrees at least.
    """
    ax = axes_or_new(ax)
    azimuth = degrees(solution.azimuth)
    angle = np.rad2deg(np.asarray(solution.contact_angle))
    load = np.asarray(solution.contact_load)
    top = max(float(load.max()), 1e-300)
    loaded = load > 1e-9 * top
    half = load.shape[1] // 2
    rows = row_slices(solution)
    for number, row in enumerate(rows):
        for ring, name in enumerate(RACEWAYS):
            hollow = name == "outer"
            for arc in range(half):
                k = ring * half + arc
                shown = loaded[row, k]
                label = f"{name} raceway"
                if len(rows) > 1:
                    label += f", row {number}"
                size = 10.0 + 40.0 * load[row][shown, k] / top
                ax.scatter(
                    azimuth[row][shown],
                    angle[row][shown, k],
                    s=3.0 * size if hollow else size,
                    marker=_MARKERS[number % len(_MARKERS)],
                    facecolor="none" if hollow else COLOURS[name],
                    edgecolor=COLOURS[name],
                    linewidth=1.3 if hollow else 0.0,
                    label=label if arc == 0 else None,
                    zorder=3,
                )
    ax.set_xlim(*_AZIMUTHS)
    ax.set_ylim(*widen_limits(angle[loaded], _LEAST_SPAN))
    ax.set_xticks(np.arange(0, 361, 60))
    title = "Contact angles (area of a marker: load)"
    finish(ax, title, "azimuth [deg]", "contact angle [deg]")
    ax.legend(
        fontsize=SMALL,
        frameon=False,
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        borderaxespad=3.8,  # below ticks and name of the axis
        ncols=2,
    )
    return ax


def ellipses(
    bearing: AbstractBearing | BearingSet,
    solution: BallSolution,
    *,
    raceway: str = "inner",
    row: int = 0,
    ax: Ax = None,
) -> Axes:
    """Draw contact ellipses on a developed raceway, with its shoulders.

    The vertical axis is the arc of the groove from its bottom [mm], the other azimuth.
    The ellipses have their true shape, to the scale of the vertical axis; a note gives
    its ratio to that of the azimuth. Where neighbours would overlap they are drawn
    narrower, and the note says so.

    Args:
        bearing: The design; of a set, the set or the bearing of the row.
        solution: Its single solution.
        raceway: "outer" or "inner".
        row: Index of the row in a set.
        ax: Axes; a new figure if `None`. Their height becomes 0.62 of their width.

    Raises:
        TypeError: If the bearing has no balls.
        ValueError: If `raceway` is unknown or the set has no such row.
    """
    ring = raceway_index(raceway)
    mine = row_slice(solution, row)
    if isinstance(bearing, BearingSet):
        bearing = bearing.rows[row].bearing
    if not isinstance(bearing, AbstractBallBearing):
        raise TypeError(
            f"`bearing` is a {type(bearing).__name__}; it must be of balls to have"
            " contact ellipses."
        )
    ax = axes_or_new(ax)
    half = solution.contact_load.shape[1] // 2
    top = max(float(np.max(solution.contact_pressure)), 1e-300)
    drawn = []
    grooves = [g for g in bearing.grooves if g.on_outer is (ring == 0)]
    for arc, groove in enumerate(grooves):
        k = ring * half + arc
        radius = 1e3 * float(groove.radius)
        angle = np.asarray(solution.contact_angle)[mine, k]
        place = radius * (angle - float(bearing.groove_axis))
        along, across = 1e3 * np.asarray(solution.semi_axes)[mine, k].T
        share = np.asarray(solution.contact_pressure)[mine, k] / top
        parts = (degrees(solution.azimuth)[mine], place, along, across, share)
        loaded = np.asarray(solution.contact_load)[mine, k] > 0
        drawn.append(np.stack(parts)[:, loaded])
    _shoulders(ax, bearing, raceway, grooves[0])
    _, place, _, across, _ = patches = np.concatenate(drawn, axis=1)
    arc = _ARC * 1e3 * float(bearing.ball_diameter)
    # A raceway that goes on as a cylinder has a groove on one side only.
    cut = grooves[0].open_side and bearing.groove_axis == 0.0
    ends = [-0.2 * arc if cut else -arc, arc, *(place - across), *(place + across)]
    ends += [float(np.asarray(line.get_ydata())[0]) for line in ax.lines]
    ax.set_ylim(*widen_limits(ends, 0.0))
    ax.set_xlim(*_AZIMUTHS)
    ax.set_box_aspect(_BOX)
    scale = _ellipse_patches(ax, patches, COLOURS[raceway], mine.stop - mine.start)
    ax.set_xticks(np.arange(0, 361, 60))
    ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle=":")
    turn = 2.0 * np.pi * _raceway_radius(bearing, ring)
    ax.set_xlabel(f"azimuth [deg]\n{_scale_text(scale, turn)}")
    ax.set_ylabel("along the groove [mm]")
    which = f", row {row}" if len(solution.row_sizes) > 1 else ""
    ax.set_title(f"Contact ellipses, {raceway} raceway{which}")
    return ax


def _raceway_radius(bearing, ring):
    """Return the distance of the middle of a raceway from the axis [mm]."""
    side = np.cos(float(bearing.groove_axis)) * (1.0 if ring == 0 else -1.0)
    ball = 0.5e3 * float(bearing.ball_diameter)
    return 0.5e3 * float(bearing.pitch_diameter) + side * ball


def _scale_text(scale, turn):
    """Return a note on the scale of the ellipses.

    Args:
        scale: Degrees of the azimuth per mm of width, true to shape and drawn.
        turn: Once around the raceway [mm].
    """
    true, drawn = scale
    times = f"{drawn * turn / 360.0:.2g} times"
    if drawn < true:
        return f"ellipses: width {times} that of the azimuth, narrower than true"
    return f"ellipses in true shape, enlarged {times}"


def _ellipse_patches(ax, patches, colour, count):
    """Ellipses (azimuth, place, semi-axes, shade) on axes with limits and box aspect.

    Returns:
        Degrees of the azimuth per mm of width, true to shape and as drawn: no wider
        than `count` ellipses find room.
    """
    from matplotlib.patches import Ellipse

    true = np.ptp(_AZIMUTHS) * _BOX / np.ptp(ax.get_ylim())
    widest = 2.0 * patches[2].max(initial=0.0)
    drawn = min(true, 0.92 * 360.0 / (count * widest)) if widest > 0.0 else true
    for azimuth, place, along, across, share in patches.T:
        for at in (azimuth - 360.0, azimuth, azimuth + 360.0):
            if not _AZIMUTHS[0] < at < _AZIMUTHS[1]:
                continue
            ax.add_patch(
                Ellipse(
                    (at, place),
                    2.0 * along * drawn,
                    2.0 * across,
                    facecolor=faded(colour, 0.15 + 0.6 * float(share)),
                    edgecolor=colour,
                    linewidth=1.0,
                    zorder=3,
                )
            )
    return true, drawn


def _shoulders(ax, bearing, raceway, groove):
    radius = 1e3 * float(groove.radius)
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
        level = {"va": "bottom" if side > 0 else "top", "ha": "right"}
        across = ax.get_yaxis_transform()
        write(ax, (0.995, side), "shoulder ", transform=across, **level)

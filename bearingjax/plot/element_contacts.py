"""Contacts of rolling elements: pressure along rollers, angles and ellipses of bal."""

import numpy as np

from ..design import AbstractBallBearing, AbstractBearing, BearingSet
from ..statics.solution import BallSolution, RollerSolution
from ..statics.warning_sizes import ends_over
from .panel import ALONG, PRESSURE, finish
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
    force_text,
    mark_peaks,
    pyplot,
    raceway_index,
    row_slice,
    row_slices,
    towards_white,
    widen_limits,
    write,
)

_LINES = {"outer": "--", "inner": "-"}
_MAPS = {"outer": "Blues", "inner": "Oranges"}
_LONG = 0.7
"""Share of the roller from which a contact is long."""


def pressure_profiles(
    solution: RollerSolution,
    ax: Ax = None,
    count: int = 3,
    raceway: str = "inner",
    row: int = 0,
) -> Axes:
    """Plot contact pressure [MPa] along the most loaded rollers.

    A triangle marks a roller end that carries load: the line contact has no end
    pressure peak there.

    Args:
        solution: A single solution of a roller bearing.
        count: Number of rollers, most loaded first.
        raceway: "inner", "outer" or "both".
        row: Index of the row in a set.

    Raises:
        ValueError: If `count` is below 1, or `raceway` or `row` is unknown.
    """
    if count < 1:
        raise ValueError(f"`count` is {count}; it must be at least 1.")
    names = ("inner", "outer") if raceway == "both" else (raceway,)
    rings = np.array([raceway_index(name) for name in names])
    ax = axes_or_new(ax)
    mine = row_slice(solution, row)
    position = _position(solution, mine)
    pressure = PRESSURE.scale * np.asarray(solution.contact_pressure)[mine]
    load = np.asarray(solution.roller_load)[mine]
    angle = degrees(solution.azimuth)[mine]
    edges = np.asarray(ends_over(solution))[mine]
    # Equal loads (to 1 ppm) by azimuth.
    total = load[:, rings].sum(axis=1)
    scale = np.max(total, initial=0.0) or 1.0
    rollers = np.lexsort((angle, -np.round(total / scale, 6)))[:count]
    for name, ring in zip(names, rings, strict=True):
        for rank, roller in enumerate(rollers):
            fade = 0.6 * rank / max(len(rollers) - 1, 1)
            colour = towards_white(COLOURS[name], fade)
            label = f"{angle[roller]:.4g}°: {force_text(float(load[roller, ring]))}"
            ax.plot(
                position,
                pressure[roller, ring],
                color=colour,
                linestyle=_LINES[name],
                # The most loaded roller on top of wider, paler lines.
                linewidth=1.6 + 2.4 * fade,
                zorder=3 - 0.01 * rank,
                label=label if len(names) == 1 else f"{name}, {label}",
            )
            ends = np.flatnonzero(edges[roller, ring])
            x, y = position[[0, -1]][ends], pressure[roller, ring][[0, -1]][ends]
            rim = {"markeredgecolor": "black", "markeredgewidth": 0.6, "zorder": 4}
            mark_peaks(ax, x, y, colour, "edge", **rim)
    ax.set_xlim(position[0], position[-1])
    shown = pressure[np.ix_(rollers, rings)]
    top = np.nanmax(shown, initial=0.0)
    # Under a long contact there is room for the legend, else above.
    short = np.mean(np.any(shown > 0.0, axis=(0, 1))) < _LONG
    ax.set_ylim(0.0, (1.8 if short else 1.08) * top if top > 0 else 1.0)
    which = "" if raceway == "both" else f", {raceway} raceway"
    title = f"Most loaded rollers{which}{_of_row(solution, row)}"
    finish(ax, title, ALONG.label, PRESSURE.label)
    title = "azimuth: load"
    if np.any(edges[np.ix_(rollers, rings)]):
        title += "\n▲ loaded roller end"
    loc = "upper center" if short else "best"
    ax.legend(title=title, fontsize=SMALL, title_fontsize=SMALL, loc=loc)
    return ax


def _of_row(solution, row):
    return f", row {row}" if len(solution.row_sizes) > 1 else ""


def _position(solution, mine):
    """Return positions along the rollers of a row [mm]."""
    position = ALONG.scale * np.asarray(solution.position)
    return position if position.ndim == 1 else position[mine.start]


def pressure_map(
    solution: RollerSolution,
    ax: Ax = None,
    raceway: str = "inner",
    row: int = 0,
    top: float | None = None,
) -> Axes:
    """Map contact pressure [MPa] of all rollers over azimuth and roller position.

    White is no contact, or less than a thousandth of the highest pressure.

    Args:
        solution: A single solution of a roller bearing.
        raceway: "inner" or "outer".
        row: Index of the row in a set.
        top: Pressure at the end of the colour scale [Pa]; the highest one of the row
            on this raceway if `None`. Give one to compare raceways.

    Returns:
        The axes; the colour bar is next to it.

    Raises:
        ValueError: If `raceway` or `row` is unknown.
    """
    ring = raceway_index(raceway)
    ax = axes_or_new(ax, (8.0, 4.5))
    mine = row_slice(solution, row)
    angle = degrees(solution.azimuth)[mine]
    order = np.argsort(angle, kind="stable")
    pressure = PRESSURE.scale * np.asarray(solution.contact_pressure)[mine, ring]
    position = _position(solution, mine)
    top = np.nanmax(pressure, initial=0.0) if top is None else PRESSURE.scale * top
    # Last and first roller stand on both sides of the seam at 0°.
    around = np.concatenate([order[-1:], order, order[:1]])
    turns = np.concatenate([[-360.0], np.zeros(len(order)), [360.0]])
    across, along = _edges(angle[around] + turns), _edges(position)
    shown = pressure[around].T
    image = ax.pcolormesh(
        across,
        along,
        np.ma.masked_where(~(shown > 1e-3 * top), shown),
        cmap=pyplot().get_cmap(_MAPS[raceway]),
        vmin=0.0,
        vmax=top if top > 0 else 1.0,
        rasterized=True,
    )
    if len(angle) <= 40:
        ax.vlines(across, position[0], position[-1], color="0.85", linewidth=0.6)
    bar = ax.figure.colorbar(image, ax=ax, pad=0.02)
    bar.set_label(PRESSURE.label)
    ax.set_xticks(np.arange(0.0, 361.0, 45.0))
    ax.set_xlim(0.0, 360.0)
    ax.set_ylim(position[0], position[-1])
    ax.set_xlabel("azimuth of the roller [deg]")
    ax.set_ylabel(ALONG.label)
    ax.set_title(f"Contact pressure, {raceway} raceway{_of_row(solution, row)}")
    return ax


def _edges(centres):
    """Return edges of the cells around ascending centres."""
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate(
        [[2.0 * centres[0] - middle[0]], middle, [2.0 * centres[-1] - middle[-1]]]
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

"""Loads of the rolling elements, displacement against load, stiffness over speed."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..element.frame import FREEDOMS, LOAD_UNITS, LOADS, MOTION_UNITS
from ..statics.solution import Solution
from .panel import Ax, Axis, Curve, Panel, chart
from .style import (
    BOX,
    COLOURS,
    GREY,
    RACEWAYS,
    SMALL,
    Axes,
    axes_or_new,
    raceway_index,
    row_slices,
    write,
)

_RADIUS, _TICK_LABEL = 1.6, (0.3, 0.15)
"""Radius of a load zone on a page; width and height of a tick label [inch]."""


def load_zone(solution: Solution, ax: Ax = None) -> Axes:
    """Plot the load of every roller or ball on both raceways at its azimuth, N or kN.

    Azimuth 0 is +x, to the right; it grows counter-clockwise, towards +y.

    Args:
        solution: A single solution.
        ax: Polar axes; a new figure if `None`.
    """
    ax = axes_or_new(ax, (7.0, 5.2), polar=True)
    azimuth = np.asarray(solution.azimuth, dtype=float)
    load = np.asarray(solution.roller_load, dtype=float)
    zone = np.asarray(solution.load_zone)
    load = np.where(np.isfinite(load), load, 0.0)
    top = float(np.max(load, initial=0.0))
    unit = "N" if top < 1e3 else "kN"
    if unit == "kN":
        load, top = 1e-3 * load, 1e-3 * top
    rows = row_slices(solution)
    step = _step(azimuth, max(solution.row_sizes))
    width = min(0.36 * step, 0.12) / (1.0 if len(rows) == 1 else 0.75 * len(rows))
    handles = []
    for k, row in enumerate(rows):
        for ring, name in enumerate(RACEWAYS):
            # Bars of all rows and both raceways side by side.
            side = len(rows) - 0.5 - (2 * k + ring)
            bars = ax.bar(
                azimuth[row] + side * width,
                load[row, ring],
                width=width,
                color=COLOURS[name],
                alpha=1.0 - 0.5 * k / len(rows),
                label=f"{name} raceway" + (f", row {k}" if len(rows) > 1 else ""),
                zorder=2,
            )
            handles.append(bars)
    (unloaded,) = ax.plot(
        azimuth[~zone],
        np.zeros(np.count_nonzero(~zone)),
        linestyle="none",
        marker="o",
        markersize=5,
        markerfacecolor="white",
        markeredgecolor=GREY,
        label="outside the load zone",
        zorder=3,
        clip_on=False,
        in_layout=False,
    )
    limit = 1.08 * top if top > 0 else 1.0
    polar: Any = ax
    polar.set_rlim(0.0, limit)
    polar.set_rorigin(-0.3 * limit)
    ax.tick_params(labelsize=SMALL)
    ax.grid(color="0.85")
    ax.set_axisbelow(True)
    every = _radial_labels(polar, azimuth, load, limit, 2 * len(rows) * width)
    noun = solution.element.bearing.noun
    note = f"; circles every {every:g} {unit}" if every else ""
    ax.set_title(f"{noun.capitalize()} loads [{unit}]{note}")
    handles = handles if zone.all() else [*handles, unloaded]
    zone_legend(ax, handles, [str(handle.get_label()) for handle in handles])
    return ax


def zone_legend(ax: Axes, handles: list[Any], labels: list[str]) -> None:
    """Draw a legend to the right of a load zone."""
    ax.legend(
        handles,
        labels,
        loc="center left",
        bbox_to_anchor=(1.1, 0.5),
        fontsize=SMALL,
        frameon=False,
        handlelength=1.2,
    )


def _step(azimuth, count):
    """Return the angle available to the bars at one azimuth [rad]."""
    even = 2.0 * np.pi / count
    gaps = np.diff(np.sort(azimuth % (2.0 * np.pi)), append=np.inf)
    return min([even, *gaps[gaps > 0.3 * even]])


def _radial_labels(ax, azimuth, loads, limit, bars) -> float:
    """Tick labels between two rollers, where the least load stands in the way.

    Args:
        ax: Polar axes.
        azimuth: Azimuth of the rollers [rad].
        loads: Loads of each roller on both raceways (roller, 2), in the unit of the
            axes.
        limit: End of the radial axis.
        bars: Angle that the bars of a roller take [rad].

    Returns:
        Distance of the ticks if their labels find no room, as between many rollers
        that are all loaded; else 0.
    """
    from matplotlib.ticker import MaxNLocator

    ticks = np.asarray(MaxNLocator(4).tick_values(0.0, limit))
    ticks = ticks[(ticks > 0.0) & (ticks <= limit)]
    ax.set_rticks(ticks, [""] * len(ticks))
    # Rows whose rollers stand at one azimuth share it.
    angle, place = np.unique(np.round(azimuth, 9) % (2.0 * np.pi), return_inverse=True)
    load, most = np.zeros(len(angle)), np.zeros(len(angle))
    np.add.at(load, place, loads.sum(axis=1))
    np.maximum.at(most, place, loads.max(axis=1))
    gaps = np.diff(angle, append=angle[0] + 2.0 * np.pi)
    between = angle + 0.5 * gaps
    # Text is wide and low: it fits best between rollers to the right or to the left.
    neighbours = (load + np.roll(load, -1)) / (loads.max() or 1.0)
    k = int(np.argmin(neighbours + 0.3 * np.abs(np.sin(between))))
    where, reach = between[k], max(most[k], most[(k + 1) % len(angle)])
    # The outermost would meet the labels of the azimuth.
    labelled = ticks[ticks <= 0.88 * limit]
    room = (gaps[k] - bars) * _RADIUS * (labelled + 0.3 * limit) / (1.3 * limit)
    wide, low = _TICK_LABEL
    needed = low * abs(np.cos(where)) + wide * abs(np.sin(where))
    if np.any((room < needed) & (labelled < reach)):
        return float(ticks[0])
    for tick in labelled:
        ground = BOX | {"pad": 0.8, "alpha": 0.8}
        write(ax, (where, tick), f"{tick:g}", zorder=4, bbox=ground)
    return 0.0


@chart
def load_displacement(
    load: ArrayLike,
    displacement: ArrayLike,
    *,
    load_name: str = "Fy",
    freedom: str = "uy",
    converged: ArrayLike | None = None,
    ax: Ax = None,
) -> Panel:
    """Plot the displacement of a ring against its load.

    Args:
        load: Load of every case (case,) [N or N m].
        displacement: Displacement of every case (case,) [m or rad].
        load_name: One of `LOADS`; forces are drawn in kN, moments in N m.
        freedom: One of `FREEDOMS`; shifts are drawn in µm, tilts in mrad.
        converged: Whether each case has a result (case,); the others are gaps.

    Raises:
        ValueError: If a name is unknown or the lengths differ.
    """
    for value, name, names in (
        (load_name, "load_name", LOADS),
        (freedom, "freedom", FREEDOMS),
    ):
        if value not in names:
            raise ValueError(
                f"`{name}` is {value!r}; it must be one of {', '.join(names)}."
            )
    x = np.atleast_1d(np.asarray(load, dtype=float))
    y = np.atleast_1d(np.asarray(displacement, dtype=float))
    good = np.ones(x.shape, bool) if converged is None else np.asarray(converged, bool)
    if x.ndim != 1 or x.shape != y.shape or x.shape != np.atleast_1d(good).shape:
        raise ValueError(
            "`load`, `displacement` and `converged` must be one-dimensional and of the"
            f" same length; they are {x.shape}, {y.shape} and {good.shape}."
        )
    over = Axis(f"load {load_name}", LOAD_UNITS[LOADS.index(load_name)])
    of = Axis(f"displacement {freedom}", MOTION_UNITS[FREEDOMS.index(freedom)])
    inner, look = COLOURS["inner"], {"marker": "o", "markersize": 4}

    def mark_failed(ax):
        if not np.all(good):
            ax.plot(
                over.scale * x[~good], np.full(np.count_nonzero(~good), 0.02), "x",
                color=GREY, label="not converged", transform=ax.get_xaxis_transform(),
            )  # fmt: skip
            ax.legend(fontsize=SMALL)

    known = Curve(x, np.where(good, y, np.nan), "", inner, look=look)
    return Panel("Displacement against load", over, of, [known], also=mark_failed)


@chart
def stiffness_over_speed(
    speed: ArrayLike,
    stiffness: ArrayLike,
    *,
    moving_ring: str = "inner",
    ax: Ax = None,
) -> Panel:
    """Plot axial and radial stiffness of a ring against speed.

    Args:
        speed: Speed of the turning ring, for every case (case,) [rad/s]; drawn in rpm.
        stiffness: Stiffness of both rings (case, 12, 12) [N/m, N, N m].
        moving_ring: Ring whose stiffness is shown, "outer" or "inner".

    Raises:
        ValueError: If the shapes do not fit or the ring is unknown.
    """
    first = 6 * raceway_index(moving_ring)
    speed = np.atleast_1d(np.asarray(speed, dtype=float))
    k = np.asarray(stiffness, dtype=float)
    if k.shape != (len(speed), 12, 12):
        raise ValueError(
            f"`stiffness` has shape {k.shape}; it must be ({len(speed)}, 12, 12), one"
            " matrix for each speed."
        )
    marks = []
    for i, style in ((0, "-"), (1, "--"), (2, "-.")):
        colour = COLOURS["inner"] if i == 2 else COLOURS["outer"]
        own = k[:, first + i, first + i]
        marks.append(Curve(speed, own, FREEDOMS[i], colour, style))
    return Panel(
        f"Stiffness of the {moving_ring} ring over speed",
        Axis("speed", "rad/s"),
        Axis("stiffness", "N/m", (1e-6, "N/µm")),
        marks,
        floor=True,
        legend={"frameon": False},
    )

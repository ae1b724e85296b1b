"""Loads of the rollers, and displacement against load."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..element.frame import FREEDOMS, LOADS
from ..statics.solution import Solution
from .style import COLOURS, GREY, RACEWAYS, SMALL, axes_or_new

if TYPE_CHECKING:
    import matplotlib.axes


def load_zone(
    solution: Solution, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Load of every roller on both raceways [kN] at its azimuth.

    Azimuth 0 is +x, to the right; it grows counter-clockwise, towards +y.

    Args:
        solution: A single solution.
        ax: Polar axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax, (6.0, 6.0), polar=True)
    azimuth = np.asarray(solution.azimuth, dtype=float)
    load = 1e-3 * np.asarray(solution.roller_load, dtype=float)
    zone = np.asarray(solution.load_zone)
    load = np.where(np.isfinite(load), load, 0.0)
    top = float(np.max(load, initial=0.0))
    step = 2.0 * np.pi / len(azimuth)
    width = min(0.36 * step, 0.08)
    handles = []
    for ring, name in enumerate(RACEWAYS):
        side = 0.5 if name == "outer" else -0.5
        bars = ax.bar(
            azimuth + side * width,
            load[:, ring],
            width=width,
            color=COLOURS[name],
            label=f"{name} raceway",
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
    _radial_labels(polar, azimuth, load.sum(axis=1), top, limit)
    ax.set_title("Roller loads [kN]")
    ax.legend(
        handles=handles if zone.all() else [*handles, unloaded],
        loc="upper center",
        bbox_to_anchor=(0.5, -0.06),
        ncols=3,
        fontsize=SMALL,
        frameon=False,
        columnspacing=1.2,
        handlelength=1.2,
    )
    return ax


def _radial_labels(ax, azimuth, load, top, limit):
    """Tick labels between two rollers, where the least load stands in the way."""
    from matplotlib.ticker import MaxNLocator

    ticks = np.asarray(MaxNLocator(4).tick_values(0.0, limit))
    ticks = ticks[(ticks > 0.0) & (ticks <= limit)]
    ax.set_rticks(ticks, [""] * len(ticks))
    order = np.argsort(azimuth % (2.0 * np.pi))
    angle = azimuth[order] % (2.0 * np.pi)
    between = angle + 0.5 * np.diff(angle, append=angle[0] + 2.0 * np.pi)
    beside = load[order] + np.roll(load[order], -1)
    # Text is wide and low: it fits best between rollers to the right or to the left.
    score = beside / (top or 1.0) + 0.3 * np.abs(np.sin(between))
    where = between[np.argmin(score)]
    # The outermost would meet the labels of the azimuth.
    for tick in ticks[ticks <= 0.88 * limit]:
        ax.text(
            where,
            tick,
            f"{tick:g}",
            fontsize=SMALL,
            ha="center",
            va="center",
            zorder=4,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.8},
        )


def load_displacement(
    load: ArrayLike,
    displacement: ArrayLike,
    *,
    load_name: str = "Fy",
    freedom: str = "uy",
    converged: ArrayLike | None = None,
    ax: "matplotlib.axes.Axes | None" = None,
) -> "matplotlib.axes.Axes":
    """Displacement of a ring against its load.

    Args:
        load: Load of every case (case,) [N or N m].
        displacement: Displacement of every case (case,) [m or rad].
        load_name: One of `LOADS`; forces are drawn in kN, moments in N m.
        freedom: One of `FREEDOMS`; shifts are drawn in µm, tilts in mrad.
        converged: Which cases have an answer (case,); the others are gaps.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.

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
    x_scale, x_unit = (1e-3, "kN") if load_name[0] == "F" else (1.0, "N m")
    y_scale, y_unit = (1e6, "µm") if freedom[0] == "u" else (1e3, "mrad")
    x = x_scale * np.atleast_1d(np.asarray(load, dtype=float))
    y = y_scale * np.atleast_1d(np.asarray(displacement, dtype=float))
    good = np.ones(x.shape, bool) if converged is None else np.asarray(converged, bool)
    if x.ndim != 1 or x.shape != y.shape or x.shape != np.atleast_1d(good).shape:
        raise ValueError(
            "`load`, `displacement` and `converged` must be one-dimensional and of the"
            f" same length; they are {x.shape}, {y.shape} and {good.shape}."
        )
    ax = axes_or_new(ax)
    ax.plot(
        x,
        np.where(good, y, np.nan),
        color=COLOURS["inner"],
        marker="o",
        markersize=4,
    )
    if not np.all(good):
        ax.plot(
            x[~good],
            np.full(np.count_nonzero(~good), 0.02),
            transform=ax.get_xaxis_transform(),
            linestyle="none",
            marker="x",
            color=GREY,
            label="not converged",
        )
        ax.legend(fontsize=SMALL)
    ax.grid(color="0.9")
    ax.set_xlabel(f"load {load_name} [{x_unit}]")
    ax.set_ylabel(f"displacement {freedom} [{y_unit}]")
    ax.set_title("Displacement against load")
    return ax

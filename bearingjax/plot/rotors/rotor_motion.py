"""Plots of rotor motion: orbits, waveforms, spectra over the speed."""

from typing import Any

import numpy as np

from ...rotor.nonlinear import Spectra
from ..panel import Ax, Axis, Panel, chart, curves, finish
from ..style import CURVES, GREY, OUTER, SMALL, Axes, axes_or_new, write_beside
from .rotor_modes import SPEED
from .rotor_response import motion_axis

_PHASE = Axis("phase of the excitation", "deg")


def orbits(
    motion: Any,
    ax: Ax = None,
    *,
    names: tuple[str, ...] = (),
    points: Any = None,
    closed: bool = True,
) -> Axes:
    """Plot orbits of stations in the plane across the axis, x over y [µm].

    Args:
        motion: x and y over the time (time, station, 2) [m].
        names: Names of the stations.
        points: Poincaré points, once a period of the excitation (point, station, 2)
            [m].
        closed: Whether the last place leads back to the first: periodic orbits.
    """
    ax = axes_or_new(ax, (6.0, 6.0))
    plane = Axis("x", "m")
    motion = plane.scale * np.asarray(motion, dtype=float)
    for k in range(motion.shape[1]):
        path = motion[:, k]
        path = np.concatenate([path, path[:1]]) if closed else path
        colour = CURVES[k % len(CURVES)]
        name = names[k] if k < len(names) else f"_station {k}"
        ax.plot(*path.T, color=colour, lw=1.3 if closed else 0.6, label=name)
        # Where the excitation has phase 0.
        start = path[:1] if points is None else plane.scale * np.asarray(points)[:, k]
        ax.plot(
            *start.T, "o", ms=4, color=colour, mec="black", mew=0.5, ls="none",
            label="_phase 0", zorder=4,
        )  # fmt: skip
    ax.set_aspect("equal", adjustable="datalim")
    title = "Orbits" if points is None else "Orbits and Poincaré points"
    finish(ax, title, plane.label, Axis("y", "m").label)
    if names:
        ax.legend(fontsize=SMALL)
    return ax


@chart
def waveforms(
    motion: Any,
    ax: Ax = None,
    *,
    time: Any = None,
    names: tuple[str, ...] = (),
    unit: str = "um",
) -> Panel:
    """Plot displacements over time [s], or over a period of the excitation [deg].

    Args:
        motion: (sample, curve) [m, rad].
        time: Time of the samples (sample,) [s]; `None`: they are at even phases of a
            period from 0 on.
        names: Names of the curves.
        unit: Unit of the displacements: "um", or "mrad" for tilts.
    """
    motion, over = np.asarray(motion, dtype=float), Axis("time", "s")
    if time is None:
        motion = np.concatenate([motion, motion[:1]])
        over, time = _PHASE, np.linspace(0.0, 360.0, len(motion))
    wide = 1.4 if over is _PHASE else 0.7

    def ticks(ax):
        if over is _PHASE:
            ax.set_xticks(np.arange(0, 361, 60))

    return Panel(
        "Waveforms",
        over,
        motion_axis("displacement" if unit == "um" else "tilt", unit),
        curves(time, motion, names, lw=wide),
        (time[0], time[-1]),
        room=0.14 if names else 0.0,
        legend={"loc": "upper center", "ncols": min(len(names), 4)},
        also=ticks,
    )


def waterfall(
    spectra: Spectra,
    ax: Ax = None,
    *,
    highest: float | None = None,
    unit: str = "um",
) -> Axes:
    """Plot spectra over the frequency [Hz], each offset to its speed [rpm].

    The largest line of all is as high as four steps between spectra; its amplitude is
    said. Dashed lines are the speed and twice the speed.

    Args:
        spectra: From `rotor.nonlinear.spectra_over_time` or `steady_spectra`.
        highest: Frequency up to which it is drawn [Hz]; default: three times the
            highest speed.
        unit: Unit of the amplitude: "um", or "mrad" for a tilt.
    """
    ax = axes_or_new(ax, (8.0, 6.0))
    rpm, of = SPEED.scale * spectra.speed, motion_axis("largest line", unit)
    amplitude = of.scale * spectra.amplitude
    hertz = np.broadcast_to(spectra.frequency, amplitude.shape)
    highest = highest or 3.0 * float(np.abs(rpm).max()) / 60.0 or float(hertz.max())
    largest = float(np.nanmax(amplitude, initial=0.0)) or 1.0
    step = np.ptp(rpm) / max(len(rpm) - 1, 1) or 1.0
    order = np.argsort(rpm)[::-1]
    for depth, k in enumerate(order):
        line = rpm[k] + 4.0 * step * amplitude[k] / largest
        shown = hertz[k] <= highest
        at, line = hertz[k, shown], line[shown]
        ax.fill_between(at, rpm[k], line, color="white", zorder=depth + 2, lw=0)
        ax.plot(at, line, color=OUTER, lw=0.9, zorder=depth + 2, label="_spectrum")
    ends = np.array([rpm.min() - 0.5 * step, rpm.max() + 4.6 * step])
    for times in (1, 2):
        ax.plot(
            times * ends / 60.0, ends, "--", color=GREY, lw=0.8, zorder=len(rpm) + 3,
            label=f"_{times}x",
        )  # fmt: skip
        at, side = (times * ends[1] / 60.0, ends[1]), {"ha": "right", "va": "top"}
        look: Any = {"color": GREY, "zorder": len(rpm) + 4, **side}
        write_beside(ax, at, (-4, -3), f"{times}x", **look)
    ax.set_xlim(0.0, highest)
    ax.set_ylim(*ends)
    ax.set_xlabel("frequency [Hz]")
    ax.set_ylabel(SPEED.label)
    said = f"{largest:.3g} {of.shown_unit}"
    ax.set_title(f"Spectra over the speed, largest line {said}")
    return ax

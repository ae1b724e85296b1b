"""Plots of rotor motion: orbits, waveforms, spectra over the speed."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..rotor.nonlinear import Waterfall
from .rotor_modes import RPM, unit_name, unit_scale
from .style import CURVES, GREY, OUTER, SMALL, axes_or_new

if TYPE_CHECKING:
    import matplotlib.axes

_MICRO = 1e6


def orbits(
    motion: Any,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    names: tuple[str, ...] = (),
    points: Any = None,
    closed: bool = True,
) -> "matplotlib.axes.Axes":
    """Plot orbits of stations in the plane across the axis, x over y [µm].

    Args:
        motion: x and y over the time (time, station, 2) [m].
        ax: Axes; a new figure if `None`.
        names: Of the stations.
        points: Poincaré points, once a period of the excitation (point, station, 2)
            [m].
        closed: Whether the last place leads back to the first: periodic orbits.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax, (6.0, 6.0))
    motion = _MICRO * np.asarray(motion, dtype=float)
    for k in range(motion.shape[1]):
        path = motion[:, k]
        path = np.concatenate([path, path[:1]]) if closed else path
        colour = CURVES[k % len(CURVES)]
        name = names[k] if k < len(names) else f"_station {k}"
        ax.plot(*path.T, color=colour, lw=1.3 if closed else 0.6, label=name)
        # Where the excitation has phase 0.
        start = path[:1] if points is None else _MICRO * np.asarray(points)[:, k]
        ax.plot(
            *start.T, "o", ms=4, color=colour, mec="black", mew=0.5, ls="none",
            label="_phase 0", zorder=4,
        )  # fmt: skip
    ax.set_aspect("equal", adjustable="datalim")
    ax.grid(color="0.93")
    ax.set_axisbelow(True)
    ax.set_xlabel("x [µm]")
    ax.set_ylabel("y [µm]")
    ax.set_title("Orbits" if points is None else "Orbits and Poincaré points")
    if names:
        ax.legend(fontsize=SMALL)
    return ax


def waveforms(
    motion: Any,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    time: Any = None,
    names: tuple[str, ...] = (),
    unit: str = "um",
) -> "matplotlib.axes.Axes":
    """Plot displacements over time [s], or over a period of the excitation [deg].

    Args:
        motion: (sample, curve) [m, rad].
        ax: Axes; a new figure if `None`.
        time: Of the samples (sample,) [s]; `None`: they are at even phases of a period
            from 0 on.
        names: Of the curves.
        unit: Of the displacements: "um", or "mrad" for tilts.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    motion = unit_scale(unit) * np.asarray(motion, dtype=float)
    if time is None:
        motion = np.concatenate([motion, motion[:1]])
        across = np.linspace(0.0, 360.0, len(motion))
        ax.set_xticks(np.arange(0, 361, 60))
    else:
        across = np.asarray(time, dtype=float)
    for k, curve in enumerate(motion.T):
        name = names[k] if k < len(names) else f"_curve {k}"
        ax.plot(
            across, curve, color=CURVES[k % len(CURVES)], label=name,
            lw=1.4 if time is None else 0.7,
        )  # fmt: skip
    ax.set_xlim(across[0], across[-1])
    ax.grid(color="0.93")
    ax.set_axisbelow(True)
    ax.set_xlabel("phase of the excitation [deg]" if time is None else "time [s]")
    ax.set_ylabel(f"{'displacement' if unit == 'um' else 'tilt'} [{unit_name(unit)}]")
    ax.set_title("Waveforms")
    if names:
        low, high = ax.get_ylim()
        ax.set_ylim(low, high + 0.14 * (high - low))
        ax.legend(fontsize=SMALL, loc="upper center", ncols=min(len(names), 4))
    return ax


class Spectra(NamedTuple):
    """Spectra of a motion, one for each speed.

    Attributes:
        speed: (line,) [rad/s].
        frequency: Of the bins, of all spectra (bin,) or of each (line, bin) [Hz].
        amplitude: (line, bin) [m, rad].
    """

    speed: np.ndarray
    frequency: np.ndarray
    amplitude: np.ndarray


def spectra_over_time(time: Any, speed: Any, motion: Any, count: int = 24) -> Spectra:
    """Return spectra of a run-up, in time windows that overlap by a half.

    Args:
        time: Even (time,) [s].
        speed: Of the rotor (time,) [rad/s].
        motion: (time,) [m, rad].
        count: Windows.

    Returns:
        Amplitudes with Hann's window, the mean left out: a sine of amplitude 1 on one
        of the frequencies has a line of 1.

    Raises:
        ValueError: For times that are not even, or too few of them.
    """
    time, speed = np.asarray(time, dtype=float), np.asarray(speed, dtype=float)
    motion, step = np.asarray(motion, dtype=float), np.diff(time)
    if np.ptp(step) > 1e-6 * step.mean():
        raise ValueError("spectra_over_time: the times are not even.")
    size = 2 * len(time) // (count + 1)
    if size < 8:
        raise ValueError(
            f"spectra_over_time: {len(time)} times are too few for {count} windows;"
            f" at least {4 * (count + 1)}."
        )
    first = np.arange(count) * (len(time) - size) // max(count - 1, 1)
    part = first[:, None] + np.arange(size)
    window = np.hanning(size + 1)[:-1]
    values = motion[part] - motion[part].mean(axis=1, keepdims=True)
    amplitude = 2.0 * np.abs(np.fft.rfft(values * window, axis=1)) / window.sum()
    return Spectra(
        speed[part].mean(axis=1), np.fft.rfftfreq(size, step.mean()), amplitude
    )


def steady_spectra(found: Waterfall, freedom: int) -> Spectra:
    """Return spectra of steady vibration of a rotor with synchronous excitation.

    Args:
        found: From `rotor.nonlinear.waterfall`.
        freedom: Index of the freedom; its mean is left out.
    """
    speed = np.asarray(found.frequency)
    hertz = speed[:, None] * np.asarray(found.order)[1:] / (2.0 * np.pi)
    return Spectra(speed, hertz, np.asarray(found.amplitude)[:, 1:, freedom])


def waterfall(
    spectra: Spectra,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    highest: float | None = None,
    unit: str = "um",
) -> "matplotlib.axes.Axes":
    """Plot spectra over the frequency [Hz], each offset to its speed [rpm].

    The largest line of all is as high as four steps between spectra; its amplitude is
    said. Dashed lines are the speed and twice the speed.

    Args:
        spectra: From `spectra_over_time` or `steady_spectra`.
        ax: Axes; a new figure if `None`.
        highest: Frequency up to which it is drawn [Hz]; default: three times the
            highest speed.
        unit: Of the amplitude: "um", or "mrad" for a tilt.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax, (8.0, 6.0))
    rpm = RPM * spectra.speed
    amplitude = unit_scale(unit) * spectra.amplitude
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
        ax.annotate(
            f"{times}x", (times * ends[1] / 60.0, ends[1]), (-4, -3), fontsize=SMALL,
            color=GREY, textcoords="offset points", zorder=len(rpm) + 4, ha="right",
            va="top",
        )  # fmt: skip
    ax.set_xlim(0.0, highest)
    ax.set_ylim(*ends)
    ax.set_xlabel("frequency [Hz]")
    ax.set_ylabel("speed [rpm]")
    said = f"{largest:.3g} {unit_name(unit)}"
    ax.set_title(f"Spectra over the speed, largest line {said}")
    return ax

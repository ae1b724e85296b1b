"""Plots of rotor amplitudes over the frequency of excitation, and over speed."""

from typing import TYPE_CHECKING, Any

import numpy as np

from ..rotor.nonlinear import Branch
from .rotor_modes import RPM, unit_name, unit_scale
from .style import CURVES, GREY, INNER, OUTER, SMALL, axes_or_new

if TYPE_CHECKING:
    import matplotlib.axes

EVENTS = {
    "fold": ("fold", "s"),
    "flip": ("flip", "v"),
    "neimark_sacker": ("Neimark-Sacker", "D"),
    "branch_point": ("branch point", "*"),
}
"""Names and markers of events along a branch."""


def response_curve(
    branch: Branch,
    amplitude: Any,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    unit: str = "um",
    linear: tuple[Any, Any] | None = None,
) -> "matplotlib.axes.Axes":
    """Plot the amplitude of a branch of periodic orbits over the frequency [Hz].

    Stable parts are full lines, unstable ones dashed; folds, flips, Neimark-Sacker and
    branch points are marked where they were located.

    Args:
        branch: From `follow`.
        amplitude: Of its points, such as a column of `branch.amplitude` (point,) [m,
            rad].
        ax: Axes; a new figure if `None`.
        unit: Of the amplitude: "um", or "mrad" for a tilt.
        linear: Frequencies [rad/s] and amplitudes [m, rad] of the linear response.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    scale = unit_scale(unit)
    hertz = np.asarray(branch.frequency) / (2.0 * np.pi)
    amplitude = scale * np.asarray(amplitude, dtype=float)
    if linear is not None:
        ax.plot(
            np.asarray(linear[0]) / (2.0 * np.pi), scale * np.asarray(linear[1]),
            color=GREY, lw=1.0, label="linear", zorder=1,
        )  # fmt: skip
    stable = np.asarray(branch.stable)
    # A part between a stable point and one that is not counts as the latter.
    for value, name, colour, style in (
        (True, "stable", OUTER, "-"),
        (False, "unstable", INNER, "--"),
    ):
        chosen = stable[1:] & stable[:-1]
        _parts(ax, hertz, amplitude, chosen == value, (colour, style, name))
    told = set()
    for event in branch.events:
        name, mark = EVENTS[event.kind]
        label = f"_{name}" if name in told else name
        ax.plot(
            [event.frequency / (2.0 * np.pi)],
            [_at_event(branch, event, amplitude)],
            mark, color="white", mec="black", ms=6, ls="none", label=label, zorder=5,
        )  # fmt: skip
        told.add(name)
    _span(ax, hertz)
    return _finish(ax, "frequency of the excitation [Hz]", unit, "Response")


def linear_curve(
    frequency: Any,
    amplitude: Any,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    unit: str = "um",
) -> "matplotlib.axes.Axes":
    """Plot the amplitude of a linear response over the frequency [Hz].

    Args:
        frequency: Of the excitation (point,) [rad/s].
        amplitude: (point,) [m, rad].
        ax: Axes; a new figure if `None`.
        unit: Of the amplitude: "um", or "mrad" for a tilt.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    hertz = np.asarray(frequency, dtype=float) / (2.0 * np.pi)
    values = unit_scale(unit) * np.asarray(amplitude, dtype=float)
    ax.plot(hertz, values, color=OUTER, label="_linear")
    _span(ax, hertz)
    return _finish(ax, "frequency of the excitation [Hz]", unit, "Response")


def _at_event(branch, event, amplitude):
    """Return the amplitude at an event, interpolated between points of the branch."""
    before, after = event.after, min(event.after + 1, len(amplitude) - 1)
    first = np.asarray(branch.amplitude)[before]
    way = np.asarray(branch.amplitude)[after] - first
    size = float(way @ way) or 1.0
    share = float(np.clip((event.amplitude - first) @ way / size, 0.0, 1.0))
    return (1.0 - share) * amplitude[before] + share * amplitude[after]


def envelope(
    time: Any, speed: Any, motion: Any, count: int = 80
) -> tuple[np.ndarray, np.ndarray]:
    """Return half of peak to peak over the speed of a run-up, by windows.

    All parts have the same number of revolutions, at least one.

    Args:
        time: (time,) [s].
        speed: (time,) [rad/s].
        motion: (time,) or (time, curve) [m, rad].
        count: Most parts.

    Returns:
        Mean speed (part,) [rad/s] and amplitude (part,) or (part, curve) [m, rad].
    """
    time, speed = np.asarray(time, dtype=float), np.asarray(speed, dtype=float)
    motion = np.asarray(motion, dtype=float)
    steps = 0.5 * np.abs(speed[1:] + speed[:-1]) * np.diff(time)
    turned = np.concatenate([[0.0], np.cumsum(steps)]) / (2.0 * np.pi)
    count = max(min(count, int(turned[-1])), 1)
    place = np.minimum(count * turned / (turned[-1] or 1.0), count - 1).astype(int)
    parts = [np.flatnonzero(place == k) for k in np.unique(place)]
    size = [0.5 * np.ptp(motion[part], axis=0) for part in parts]
    return np.array([speed[part].mean() for part in parts]), np.array(size)


def speed_curve(
    speed: Any,
    amplitude: Any,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    unit: str = "um",
    names: tuple[str, ...] = (),
    title: str = "Unbalance response",
) -> "matplotlib.axes.Axes":
    """Plot amplitudes over the speed [rpm], of a linear response or a run-up.

    Args:
        speed: (point,) [rad/s].
        amplitude: (point,) or (point, curve) [m, rad].
        ax: Axes; a new figure if `None`.
        unit: Of the amplitude: "um", or "mrad" for tilts.
        names: Of the curves.
        title: Of the axes.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    rpm = RPM * np.asarray(speed, dtype=float)
    values = unit_scale(unit) * np.asarray(amplitude, dtype=float)
    values = values[:, None] if values.ndim == 1 else values
    for k, column in enumerate(values.T):
        label = names[k] if k < len(names) else f"_curve {k}"
        ax.plot(rpm, column, label=label, color=CURVES[k % len(CURVES)])
    _span(ax, rpm)
    return _finish(ax, "speed [rpm]", unit, title)


def _parts(ax, x, y, chosen, look):
    """Runs of segments that are chosen; one of them has the name."""
    colour, style, name = look
    edges = np.diff(np.concatenate([[0], chosen.astype(int), [0]]))
    for first, last in zip(
        np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True
    ):
        part = slice(first, last + 1)
        ax.plot(x[part], y[part], style, color=colour, lw=1.6, label=name, zorder=3)
        name = f"_{name}" if not name.startswith("_") else name


def _span(ax, x):
    if len(x) and x.max() > x.min():
        ax.set_xlim(x.min(), x.max())


def _finish(ax, label, unit, title):
    ax.set_ylim(0.0, 1.12 * max(ax.get_ylim()[1], 0.0) or 1.0)
    ax.grid(color="0.93")
    ax.set_axisbelow(True)
    ax.set_xlabel(label)
    ax.set_ylabel(f"amplitude [{unit_name(unit)}]")
    ax.set_title(title)
    if any(not str(line.get_label()).startswith("_") for line in ax.get_lines()):
        ax.legend(fontsize=SMALL)
    return ax

"""Skidding balls and rollers over time: speeds, slip, forces, powers, spectrum."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..skid import SkidHistory, SkidRollerHistory, by_raceway
from .style import (
    COLOURS,
    GREY,
    INNER,
    OUTER,
    RACEWAYS,
    ROLLER,
    SMALL,
    SPIN_COLOURS,
    SPIN_NAMES,
    axes_or_new,
)

if TYPE_CHECKING:
    import matplotlib.axes

History = SkidHistory | SkidRollerHistory

_BAND = 0.25
_BEYOND = 1.5
"""Extent of an axis over all but the shortest peaks, as a factor."""
_FLOOR = 1e-3
"""Amplitude over the largest one below which a spectrum is not drawn."""


def speed_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot cage speed and orbital speeds of the balls, with pure rolling [rad/s].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    rolling = np.asarray(found.rolling_orbit_speed)
    _spread(ax, found, found.orbit_speed, ROLLER, f"{_kind(found)}s")
    ax.plot(found.time, found.cage_speed, color=INNER, label="cage")
    ax.plot(
        found.time, rolling.mean(axis=1), "--", color=GREY, label="rolling", linewidth=1
    )
    return _finish(
        ax, found, "speed [rad/s]", f"Cage and orbits of the {_kind(found)}s"
    )


def slip_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot slip of the orbits against pure rolling [%].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    _spread(ax, found, 100.0 * np.asarray(found.slip), ROLLER, f"{_kind(found)}s")
    return _finish(ax, found, "slip of the orbit [%]", "Slip")


def spin_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None, *, ball: int = 0
) -> "matplotlib.axes.Axes":
    """Plot spin of a ball in its orbiting frame [rad/s].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.
        ball: Index of the ball.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    spin = np.asarray(found.spin)[:, ball]
    if isinstance(found, SkidHistory):
        for k, name in enumerate(SPIN_NAMES):
            ax.plot(found.time, spin[:, k], color=SPIN_COLOURS[k], label=name)
    else:
        ax.plot(found.time, spin, color=SPIN_COLOURS[2], label="about its axis")
    return _finish(ax, found, "spin [rad/s]", f"Spin of {_kind(found)} {ball}")


def load_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None, *, ball: int = 0
) -> "matplotlib.axes.Axes":
    """Plot contact loads of a ball [N].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.
        ball: Index of the ball.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    _raceways(ax, found, found.contact_load, ball)
    ax.set_ylim(bottom=0.0)
    return _finish(ax, found, "contact load [N]", f"Load on {_kind(found)} {ball}")


def sliding_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None, *, ball: int = 0
) -> "matplotlib.axes.Axes":
    """Plot sliding speed of a ball at the centres of its contacts [mm/s].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.
        ball: Index of the ball.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    _raceways(ax, found, 1e3 * np.asarray(found.sliding_speed), ball)
    ax.set_ylim(bottom=0.0)
    return _finish(
        ax, found, "sliding speed [mm/s]", f"Sliding of {_kind(found)} {ball}"
    )


def cage_force_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Forces of the cage on the balls, in the sense in which angles are counted [N].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    force = np.asarray(found.cage_force)
    ax.plot(found.time, force.max(axis=1), color=OUTER, label="pushed most")
    ax.plot(found.time, force.min(axis=1), color=INNER, label="held back most")
    return _finish(
        ax, found, "cage force [N]", f"Force of the cage on a {_kind(found)}"
    )


def power_over_time(
    found: History, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot the power of the drive and of all losses [W].

    Args:
        found: From `skid.simulate`.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    power = found.power
    stored = power.drive - power.contacts - power.drag
    curves = (
        (power.contacts, "contacts", INNER, "-"),
        (power.drag, "drag", ROLLER, "-"),
        (stored, "motion", OUTER, ":"),
        (power.drive, "drive", "black", "-"),
    )
    for values, name, colour, style in curves:
        ax.plot(found.time, values, style, color=colour, label=name, linewidth=1.2)
    # A start that does not suit costs, for a moment, a hundred times the rest.
    sizes = [np.nanquantile(np.abs(values), 0.98) for values, *_ in curves]
    most = _BEYOND * float(max(sizes))
    low, high = ax.get_ylim()
    ax.set_ylim(max(low, -most), min(high, most))
    return _finish(ax, found, "power [W]", "Power of the drive, and where it goes")


def _kind(found):
    return "ball" if isinstance(found, SkidHistory) else "roller"


class Spectrum(NamedTuple):
    """Spectrum of the sliding speed of a ball.

    Attributes:
        frequency: Frequencies (line,) [Hz].
        amplitude: Of the sliding speed (line,) [m/s].
        cage: Mean frequency of the cage over the time that was transformed [Hz].
    """

    frequency: np.ndarray
    amplitude: np.ndarray
    cage: float


def spectrum(
    found: History,
    *,
    ball: int = 0,
    raceway: str = "inner",
    begin: float | None = None,
) -> Spectrum:
    """Spectrum of the sliding speed in the middle of a contact.

    Args:
        found: From `skid.simulate`, at even times.
        ball: Index of the ball.
        raceway: "outer" or "inner".
        begin: Time from which on [s]; default: a third of all.

    Returns:
        Amplitudes with Hann's window, the mean left out: a sine of amplitude 1 on one
        of the frequencies has a line of 1.

    Raises:
        ValueError: For times that are not even, or too few of them.
    """
    time = np.asarray(found.time)
    step = np.diff(time)
    if np.ptp(step) > 1e-6 * step.mean():
        raise ValueError("spectrum: the times are not even.")
    kept = time >= (time[-1] / 3.0 if begin is None else begin)
    kept &= np.isfinite(np.asarray(found.cage_speed))
    count = np.count_nonzero(kept)
    if count < 8:
        raise ValueError(f"spectrum: {count} times are too few; at least 8.")
    sliding = by_raceway(found.sliding_speed, found.contact_load)
    values = sliding[kept, ball, RACEWAYS.index(raceway)]
    window = np.hanning(count + 1)[:-1]
    amplitude = np.abs(np.fft.rfft((values - values.mean()) * window))
    cage = np.abs(np.mean(np.asarray(found.cage_speed)[kept])) / (2.0 * np.pi)
    return Spectrum(
        np.fft.rfftfreq(count, step.mean()),
        2.0 * amplitude / window.sum(),
        float(cage),
    )


def sliding_spectrum(
    found: History,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    ball: int = 0,
    raceway: str = "inner",
    begin: float | None = None,
) -> "matplotlib.axes.Axes":
    """Spectrum of the sliding speed of a ball [mm/s], multiples of the cage's marked.

    Args:
        found: From `skid.simulate`, at even times.
        ax: Axes; a new figure if `None`.
        ball, raceway, begin: As in `spectrum`.

    Returns:
        The axes.

    Raises:
        ValueError: As `spectrum`.
    """
    lines = spectrum(found, ball=ball, raceway=raceway, begin=begin)
    ax = axes_or_new(ax)
    amplitude = 1e3 * lines.amplitude
    ax.semilogy(lines.frequency, amplitude, color=COLOURS[raceway], linewidth=1.2)
    highest, apart = lines.frequency[-1], lines.frequency[1]
    if 2.0 * apart < lines.cage <= highest:
        highest = min(highest, 12.0 * lines.cage)
        for k in range(1, int(highest / lines.cage) + 1):
            mark = ax.axvline(k * lines.cage, color=GREY, linestyle=":", linewidth=0.8)
        mark.set_label(f"multiples of the cage's {lines.cage:.4g} Hz")
        ax.legend(fontsize=SMALL, loc="upper right")
    else:
        told = f"lines {apart:.3g} Hz apart: too few for the cage's {lines.cage:.3g} Hz"
        ax.text(0.5, 0.95, told, ha="center", fontsize=SMALL, transform=ax.transAxes)
    shown = amplitude[lines.frequency <= highest]
    top = float(shown.max(initial=0.0))
    if top > 0:
        ax.set_ylim(_FLOOR * top, 6.0 * top)
    ax.set_xlim(0.0, highest)
    ax.set_xlabel("frequency [Hz]")
    ax.set_ylabel("amplitude [mm/s]")
    ax.set_title(f"Spectrum of the sliding, {raceway} raceway")
    return ax


def _spread(ax, found, values, colour, label):
    """Plot the mean over the balls, and a band from the least to the largest."""
    values = np.asarray(values)
    low, high = values.min(axis=1), values.max(axis=1)
    ax.fill_between(found.time, low, high, color=colour, alpha=_BAND, linewidth=0)
    ax.plot(found.time, values.mean(axis=1), color=colour, label=label)


def _raceways(ax, found, values, ball):
    values = by_raceway(values, found.contact_load)
    for k, name in enumerate(RACEWAYS):
        style = "-" if name == "inner" else "--"
        ax.plot(found.time, values[:, ball, k], style, color=COLOURS[name], label=name)


def _finish(ax, found, label, title):
    ax.set_xlim(float(found.time[0]), float(found.time[-1]))
    low, high = ax.get_ylim()
    names = [str(line.get_label()) for line in ax.get_lines()]
    rows = 1 if len(names) < 4 else 2
    ax.set_ylim(low, high + (0.06 + 0.08 * rows) * (high - low))
    ax.legend(fontsize=SMALL, loc="upper center", ncols=-(-len(names) // rows))
    ax.locator_params(axis="x", nbins=6)
    ax.grid(color="0.93")
    ax.set_axisbelow(True)
    ax.set_xlabel("time [s]")
    ax.set_ylabel(label)
    ax.set_title(title)
    return ax

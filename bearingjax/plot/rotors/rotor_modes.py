"""Mode shapes of a rotor, and its natural frequencies over the speed."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...rotor import CriticalSpeeds, Modes, Rotor, major_axis
from ...rotor.linear.modes import is_axial
from ..panel import Axis, finish
from ..style import (
    BOX,
    GREY,
    INNER,
    OUTER,
    ROLLER,
    SMALL,
    Ax,
    Axes,
    axes_or_new,
    write_beside,
)

WHIRLS = {1: ("forward", INNER), -1: ("backward", OUTER), 0: ("planar, axial", ROLLER)}
"""Names and colours of whirl directions; 0 is planar, axial or mixed."""
SPEED = Axis("speed", "rad/s")
_HALF = 0.42
"""Half height of a mode in its lane [1]."""


def mode_shapes(
    rotor: Rotor,
    found: Modes,
    ax: Ax = None,
    *,
    count: int = 6,
) -> Axes:
    """Plot shapes of the lowest modes over the axis [mm], one above the other.

    A line is the shaft at the moment of its largest displacement, seen across the
    direction of that; the band behind it is what the orbits of all sections sweep.
    Every mode is drawn to the same height. Colours mark the direction of whirl.

    Args:
        rotor: The rotor.
        found: From `modes`, at one speed.
        count: Most modes; those that do not oscillate are left out.
    """
    ax = axes_or_new(ax, (8.0, 6.0))
    z = 1e3 * np.asarray(rotor.shaft.nodes, dtype=float)
    names = []
    chosen = np.flatnonzero(np.asarray(found.oscillates))[:count]
    axial = is_axial(found.shape)
    for lane, k in enumerate(chosen):
        whirl, colour = WHIRLS[0 if axial[k] else int(found.whirl[k])]
        line, band = _mode_lines(np.asarray(found.shape[k]), axial[k])
        base = len(chosen) - 1.0 - lane
        ax.axhline(base, color=GREY, lw=0.7, zorder=1, label="_rest")
        ax.fill_between(
            z, base - _HALF * band, base + _HALF * band, color=colour, alpha=0.15, lw=0
        )
        ax.plot(z, base + _HALF * line, color=colour, lw=1.8, label=f"_mode {k}")
        kind = "axial" if axial[k] else whirl.split(",")[0]
        names.append(
            f"{float(found.frequency[k]):.4g} Hz, {kind}\n"
            f"damping {_percent(found.damping_ratio[k])} %"
        )
    for support in rotor.supports:
        at = 1e3 * float(rotor.shaft.stations[support.station])
        ax.plot(
            np.full(len(chosen), at), np.arange(len(chosen)), "^", color=GREY, ms=7,
            zorder=4, label="_support",
        )  # fmt: skip
    ax.set_yticks(np.arange(len(chosen))[::-1], names, fontsize=SMALL)
    ax.set_ylim(-0.6, max(len(chosen), 1) - 0.4)
    ax.margins(x=0.02)
    ax.set_xlabel("z [mm]")
    ax.set_title("Mode shapes")
    if not len(chosen):
        ax.text(0.5, 0.5, "no mode oscillates", ha="center", transform=ax.transAxes)
    return ax


def _percent(ratio):
    """Format a ratio in percent, zero below round-off."""
    return f"{100.0 * float(np.where(np.abs(ratio) < 1e-9, 0.0, ratio)):.3g}"


def _mode_lines(shape, axial):
    """Return line and half width of the band of a mode, at most one."""
    x, y, z = shape[:, 0], shape[:, 1], shape[:, 2]
    if axial:
        line, band = _at_most(z), np.abs(z)
    else:
        band = major_axis(x, y)
        largest = int(np.argmax(band))
        direction = _direction(x[largest], y[largest])
        moved = x * np.cos(direction) + y * np.sin(direction)
        line = np.real(moved * np.exp(-1j * np.angle(moved[largest])))
    size = float(band.max()) or 1.0
    return line / size, band / size


def _at_most(motion):
    """Return the real part at the phase at which the largest motion is real."""
    return np.real(motion * np.exp(-1j * np.angle(motion[np.argmax(np.abs(motion))])))


def _direction(x, y):
    """Return the angle of the major axis of Re (x, y) exp(iωt) from +x [rad]."""
    forward, backward = x + 1j * y, np.conj(x - 1j * y)
    return 0.5 * (np.angle(forward) + np.angle(backward))


def campbell_diagram(
    speeds: Any,
    found: Modes,
    critical: CriticalSpeeds | None = None,
    ax: Ax = None,
) -> Axes:
    """Plot natural frequencies [Hz] over the speed [rpm], with the synchronous line.

    Args:
        speeds: At which `found` is (speed,) [rad/s].
        found: From `campbell`.
        critical: Critical speeds to be marked; those of forward whirl, which unbalance
            excites, with their number.
    """
    ax = axes_or_new(ax)
    rpm = SPEED.scale * np.asarray(speeds, dtype=float)
    frequency = np.where(found.oscillates, found.frequency, np.nan)
    whirl = np.where(is_axial(found.shape), 0, found.whirl)
    # Where modes coincide, as at rest, they have no direction: that of the next speed.
    sense = np.where(whirl[1:] != 0, whirl[1:], whirl[:-1])
    for value, (name, colour) in WHIRLS.items():
        label = name
        for mode in range(frequency.shape[1]):
            for first, last in runs(sense[:, mode] == value):
                part = slice(first, last + 1)
                ax.plot(rpm[part], frequency[part, mode], color=colour, label=label)
                label = f"_{name}"
    ax.plot(rpm, rpm / 60.0, "--", color="black", lw=1.0, label="speed (1x)")
    top = float(np.nanmax(frequency, initial=0.0)) or float(rpm.max()) / 60.0
    if critical is not None:
        _critical(ax, critical, rpm, top)
    ax.set_xlim(rpm.min(), rpm.max())
    ax.set_ylim(0.0, 1.25 * top)  # room for the legend
    finish(ax, "Campbell diagram", SPEED.label, "natural frequency [Hz]")
    ax.legend(fontsize=SMALL, loc="upper left", ncols=2)
    return ax


def runs(chosen: np.ndarray) -> Iterator[tuple[int, int]]:
    """Return first and last point of every run of chosen segments."""
    edges = np.diff(np.concatenate([[0], chosen.astype(int), [0]]))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return zip(starts.tolist(), ends.tolist(), strict=True)


def _critical(ax, critical, rpm, top):
    """Mark critical speeds on the synchronous line, with numbers for forward whirl."""
    look: Any = {"ls": "none", "marker": "o", "mec": "black", "ms": 7, "zorder": 5}
    label = "critical speed"
    sense = np.where(is_axial(critical.shape), 0, critical.whirl)
    for speed, whirl in zip(np.asarray(critical.speed), sense, strict=True):
        at = SPEED.scale * speed
        if not np.isfinite(speed) or not rpm.min() <= at <= rpm.max():
            continue
        if at / 60.0 > top:
            continue
        colour = WHIRLS[int(whirl)][1]
        # White in the legend: points have the colour of their whirl.
        ax.plot([], [], color="white", label=label, **look)
        label = "_critical speed"
        ax.plot([at], [at / 60.0], color=colour, label=label, **look)
        if whirl == 1:
            ground = BOX | {"pad": 0.8}
            text = f"{at:.0f} rpm"
            write_beside(ax, (at, at / 60.0), (6, -12), text, zorder=4, bbox=ground)

"""Skidding balls and rollers along their orbit: load, sliding, spin, cage force."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..skid import SteadyRollerSkid, SteadySkid, by_raceway
from .style import (
    COLOURS,
    GREY,
    RACEWAYS,
    ROLLER,
    SMALL,
    SPIN_COLOURS,
    SPIN_NAMES,
    axes_or_new,
    without_offset,
)

if TYPE_CHECKING:
    import matplotlib.axes

_LOADED = "0.88"
"""Colour of zones B and D."""
_HEADROOM = 0.14
"""Height of the legend over that of the curves."""
_PAD = 20
"""Height of the names of the zones below a title [pt]."""


Steady = SteadySkid | SteadyRollerSkid


class Zone(NamedTuple):
    """Zone of the orbit.

    Attributes:
        name: "A" to "D".
        begin, end: Azimuths, the end above the beginning [rad].
        loaded: Whether balls carry more than their share of the axial load there.
    """

    name: str
    begin: float
    end: float
    loaded: bool


def zones(found: Steady) -> list[Zone]:
    """Return parts of the orbit with loads above those of the axial load alone.

    Under axial and radial load on a ring that may tilt there are two, B and D, of
    which B has the larger load; A comes before B, in the sense of the orbit.

    Args:
        found: From `skid.steady`.

    Returns:
        A, B, C, D in this order; empty where the parts are not these four.

    Source: Han & Chu, J. Sound Vib. 354 (2015) 219-235, figures 11 and 12.
    """
    if not isinstance(found, SteadySkid):
        return []  # of rollers
    azimuth, load = (
        np.asarray(found.azimuth),
        by_raceway(found.contact_load, found.contact_load),
    )
    inner = load[:, 1]
    if len(azimuth) < 8 or not np.isfinite(inner).all():
        return []
    # Of the axial load each ball bears the same on the mean.
    angle = by_raceway(found.contact_angle, found.contact_load)[:, 1]
    axial = np.mean(inner * np.sin(angle))
    if abs(np.mean(angle)) < 1e-6:
        return []
    over = inner - axial / np.sin(np.mean(angle))
    after = np.roll(over, -1)
    up, down = (
        np.flatnonzero((over <= 0) & (after > 0)),
        np.flatnonzero((over > 0) & (after <= 0)),
    )
    if len(up) != 2:
        return []
    step = 2.0 * np.pi / len(azimuth)

    def crossing(k):
        return azimuth[k] + step * over[k] / (over[k] - after[k])

    forward = np.asarray(found.cage_speed) >= 0
    spans = []
    for k in up:
        begin = crossing(k)
        apart = [(crossing(d) - begin) % (2.0 * np.pi) for d in down]
        within = (azimuth - begin) % (2.0 * np.pi) < min(apart)
        spans.append((begin, begin + min(apart), inner[within].max()))
    spans.sort(key=lambda span: -span[2])
    (b0, b1, _), (d0, d1, _) = spans
    d0, d1 = (d0 - b0) % (2.0 * np.pi) + b0, (d1 - b0) % (2.0 * np.pi) + b0
    between, beyond = (b1, d0), (d1, b0 + 2.0 * np.pi)
    before, behind = (beyond, between) if forward else (between, beyond)
    return [
        Zone("A", *before, False),
        Zone("B", b0, b1, True),
        Zone("C", *behind, False),
        Zone("D", d0, d1, True),
    ]


def load_over_orbit(
    found: Steady, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot contact loads [N] against azimuth [deg], zones B and D shaded.

    Args:
        found: From `skid.steady`, with places.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    _raceways(ax, found, by_raceway(found.contact_load, found.contact_load))
    _finish(ax, found, "Load")
    if zones(found):
        told = "B, D: more load than by the axial load alone"
        ax.set_xlabel(f"{ax.get_xlabel()}\n{told}")
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel("contact load [N]")
    return ax


def sliding_over_orbit(
    found: Steady, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot sliding speed at contact centres [mm/s] against azimuth [deg].

    And, on an axis of its own, the slip of the orbit against pure rolling [%].

    Args:
        found: From `skid.steady`, with places.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    _raceways(ax, found, 1e3 * by_raceway(found.sliding_speed, found.contact_load))
    other = without_offset(ax.twinx())
    azimuth, slip = _closed(found, 100.0 * np.asarray(found.slip))
    other.plot(azimuth, slip, ":", color=GREY, label="orbit slip")
    other.set_ylabel("slip of the orbit [%]", color=GREY)
    _finish(ax, found, "Sliding in the middle of the contacts", other)
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel("sliding speed [mm/s]")
    return ax


def spin_over_orbit(
    found: Steady, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot spin in the orbiting frame [rad/s] against azimuth [deg]; of rollers about
    their axes, with that of pure rolling.

    Args:
        found: From `skid.steady`, with places.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    azimuth, spin = _closed(found, np.asarray(found.spin))
    if isinstance(found, SteadySkid):
        for k, name in enumerate(SPIN_NAMES):
            ax.plot(azimuth, spin[:, k], color=SPIN_COLOURS[k], label=name)
    else:
        rolling = _closed(found, np.asarray(found.rolling_spin))[1]
        ax.plot(azimuth, spin, color=SPIN_COLOURS[2], label="spin")
        ax.plot(azimuth, rolling, "--", color=GREY, label="rolling", linewidth=1)
    _finish(ax, found, "Spin")
    ax.set_ylabel("spin [rad/s]")
    return ax


def heat_over_orbit(
    found: Steady, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot heat of the contacts [W] against azimuth [deg].

    Args:
        found: From `skid.steady`, with places.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    _raceways(ax, found, by_raceway(found.heat, found.contact_load))
    _finish(ax, found, "Heat of the contacts")
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel("heat [W]")
    return ax


def cage_force_over_orbit(
    found: SteadyRollerSkid, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot the force of the cage on a roller [N] against azimuth [deg].

    Args:
        found: From `skid.steady`, of rollers.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    azimuth, force = _closed(found, np.asarray(found.cage_force))
    ax.plot(azimuth, force, color=ROLLER, label="above zero: pushed forwards")
    _finish(ax, found, "Force of the cage on a roller")
    ax.set_ylabel("cage force [N]")
    return ax


def _raceways(ax, found, values):
    azimuth, values = _closed(found, values)
    for k, name in enumerate(RACEWAYS):
        style = "-" if name == "inner" else "--"
        ax.plot(azimuth, values[:, k], style, color=COLOURS[name], label=name)


def _closed(found, values):
    """Return azimuth [deg] from 0 to 360 and values, the first repeated at the end."""
    azimuth = np.rad2deg(np.asarray(found.azimuth)) % 360.0
    azimuth = np.where(azimuth > 360.0 - 1e-9, 0.0, azimuth)
    order = np.argsort(azimuth)
    around = np.append(azimuth[order], azimuth[order[0]] + 360.0)
    return around, values[np.append(order, order[0])]


def _finish(ax, found, title, *others):
    """Shade and name the zones; title, axis of azimuth, grid, legend."""
    parts = zones(found)
    ax.set_title(title, pad=_PAD if parts else None)
    for zone in parts:
        begin, end = np.rad2deg(zone.begin), np.rad2deg(zone.end)
        for turn in np.arange(np.floor(begin / 360.0), np.ceil(end / 360.0)) * 360.0:
            low, high = max(begin - turn, 0.0), min(end - turn, 360.0)
            if zone.loaded:
                ax.axvspan(low, high, color=_LOADED, linewidth=0, zorder=0)
            if high - low > 12.0:
                ax.text(
                    0.5 * (low + high),
                    1.01,
                    zone.name,
                    transform=ax.get_xaxis_transform(),
                    ha="center",
                    va="bottom",
                    fontweight="bold",
                    color=GREY,
                )
    ax.set_xlim(0.0, 360.0)
    ax.set_xticks(np.arange(0, 361, 60))
    ax.grid(color="0.93")
    ax.set_axisbelow(True)
    ax.set_xlabel("azimuth [deg]")
    lines = [line for a in (ax, *others) for line in a.get_lines()]
    for a in (ax, *others):
        low, high = a.get_ylim()
        a.set_ylim(top=high + _HEADROOM * (high - low))
    names = [str(line.get_label()) for line in lines]
    ax.legend(lines, names, fontsize=SMALL, loc="upper center", ncols=len(names))

"""Skidding balls and rollers over time and along their orbit.

Of all plots `found` is a result, of `skid.simulate` over time, of `skid.steady` (with
places) over the orbit; `ax` are axes, `None` for a new figure; `ball` is the index of a
ball or roller.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...skid import SkidHistory, SkidRollerHistory, SteadyRollerSkid, SteadySkid, zones
from ...skid import sliding_spectrum as spectrum
from ...skid.conditions import by_raceway
from ..panel import NEWTONS, Ax, Axis, Curve, Panel, chart, finish
from ..style import (
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

History = SkidHistory | SkidRollerHistory
Steady = SteadySkid | SteadyRollerSkid

_TIME = Axis("time", "s")
_AZIMUTH = Axis("azimuth", "deg")
_SPEED = Axis("speed", "rad/s", (1.0, "rad/s"))
_SPIN = Axis("spin", "rad/s", (1.0, "rad/s"))
_SLIP = Axis("slip of the orbit", "", (100.0, "%"))
_SLIDING = Axis("sliding speed", "m/s", (1e3, "mm/s"))

_BEYOND = 1.5
"""Extent of an axis over all but the shortest peaks, as a factor."""
_FLOOR = 1e-3
"""Amplitude over the largest one below which a spectrum is not drawn."""
_LOADED = "0.88"
"""Colour of zones B and D."""
_PAD = 20
"""Height of the names of the zones below a title [pt]."""


@chart
def speed_over_time(found: History, ax: Ax = None) -> Panel:
    """Plot cage speed and orbital speeds of the balls, with pure rolling [rad/s]."""
    rolling = np.asarray(found.rolling_orbit_speed).mean(axis=1)
    marks = [
        *_mean_and_band(found, found.orbit_speed),
        Curve(found.time, found.cage_speed, "cage", INNER),
        Curve(found.time, rolling, "rolling", GREY, "--", {"linewidth": 1}),
    ]
    return _over_time(found, f"Cage and orbits of the {_kind(found)}s", _SPEED, marks)


@chart
def slip_over_time(found: History, ax: Ax = None) -> Panel:
    """Plot slip of the orbits against pure rolling [%]."""
    return _over_time(found, "Slip", _SLIP, _mean_and_band(found, found.slip))


@chart
def spin_over_time(found: History, ax: Ax = None, *, ball: int = 0) -> Panel:
    """Plot spin of a ball in its orbiting frame [rad/s]."""
    spin = np.asarray(found.spin)[:, ball]
    title = f"Spin of {_kind(found)} {ball}"
    if isinstance(found, SkidHistory):
        return _over_time(found, title, _SPIN, _spins(found.time, spin))
    about = Curve(found.time, spin, "about its axis", SPIN_COLOURS[2])
    return _over_time(found, title, _SPIN, [about])


@chart
def load_over_time(found: History, ax: Ax = None, *, ball: int = 0) -> Panel:
    """Plot contact loads of a ball [N]."""
    load = by_raceway(found.contact_load, found.contact_load)[:, ball]
    of = Axis.from_field(found, "contact_load", NEWTONS)
    title = f"Load on {_kind(found)} {ball}"
    return _over_time(found, title, of, _raceways(found.time, load), floor=True)


@chart
def sliding_over_time(found: History, ax: Ax = None, *, ball: int = 0) -> Panel:
    """Plot sliding speed of a ball at the centres of its contacts [mm/s]."""
    speed = by_raceway(found.sliding_speed, found.contact_load)[:, ball]
    title, marks = f"Sliding of {_kind(found)} {ball}", _raceways(found.time, speed)
    return _over_time(found, title, _SLIDING, marks, floor=True)


@chart
def cage_force_over_time(found: History, ax: Ax = None) -> Panel:
    """Forces of the cage on the balls, in the sense in which angles are counted [N]."""
    force = np.asarray(found.cage_force)
    marks = [
        Curve(found.time, force.max(axis=1), "pushed most", OUTER),
        Curve(found.time, force.min(axis=1), "held back most", INNER),
    ]
    of = Axis.from_field(found, "cage_force", NEWTONS)
    return _over_time(found, f"Force of the cage on a {_kind(found)}", of, marks)


@chart
def power_over_time(found: History, ax: Ax = None) -> Panel:
    """Plot the power of the drive and of all losses [W]."""
    power = found.power
    stored = power.drive - power.contacts - power.drag
    marks = [
        Curve(found.time, values, name, colour, style, {"linewidth": 1.2})
        for values, name, colour, style in (
            (power.contacts, "contacts", INNER, "-"),
            (power.drag, "drag", ROLLER, "-"),
            (stored, "motion", OUTER, ":"),
            (power.drive, "drive", "black", "-"),
        )
    ]
    # A start that does not suit costs, for a moment, a hundred times the rest.
    most = _BEYOND * max(float(np.nanquantile(np.abs(m.y), 0.98)) for m in marks)
    title, of = "Power of the drive, and where it goes", Axis("power", "W")
    return _over_time(found, title, of, marks, most=most)


def _kind(found):
    return "ball" if isinstance(found, SkidHistory) else "roller"


def _mean_and_band(found, values) -> list[Curve]:
    """Return the mean over the balls, and a band from the least to the largest."""
    values, time = np.asarray(values), found.time
    low, high = values.min(axis=1), values.max(axis=1)
    return [
        Curve(time, low, "", ROLLER, look={"alpha": 0.25}, to=high),
        Curve(time, values.mean(axis=1), f"{_kind(found)}s", ROLLER),
    ]


def _raceways(across, values) -> list[Curve]:
    return [
        Curve(across, values[:, k], name, COLOURS[name], "-" if k else "--")
        for k, name in enumerate(RACEWAYS)
    ]


def _spins(across, spin) -> list[Curve]:
    return [
        Curve(across, spin[:, k], name, SPIN_COLOURS[k])
        for k, name in enumerate(SPIN_NAMES)
    ]


def _over_time(found, title, of, marks: Sequence[Curve], **more: Any) -> Panel:
    count = sum(bool(mark.label) for mark in marks)
    rows = 1 if count < 4 else 2
    return Panel(
        title, _TIME, of, marks, found.time[[0, -1]], room=0.06 + 0.08 * rows,
        legend={"loc": "upper center", "ncols": -(-count // rows)},
        also=lambda ax: ax.locator_params(axis="x", nbins=6), **more,
    )  # fmt: skip


def sliding_spectrum(
    found: History,
    ax: Ax = None,
    *,
    ball: int = 0,
    raceway: str = "inner",
    begin: float | None = None,
) -> Any:
    """Spectrum of the sliding speed of a ball [mm/s], multiples of the cage's marked.

    Args:
        found: From `skid.simulate`, at even times.
        ball, raceway, begin: As in `skid.sliding_spectrum`.

    Raises: as `skid.sliding_spectrum`.
    """
    lines = spectrum(found, ball=ball, raceway=raceway, begin=begin)
    ax = axes_or_new(ax)
    amplitude = _SLIDING.scale * lines.amplitude
    ax.semilogy(lines.frequency, amplitude, color=COLOURS[raceway], linewidth=1.2)
    highest, apart = lines.frequency[-1], lines.frequency[1]
    if 2.0 * apart < lines.cage <= highest:
        highest = min(highest, 12.0 * lines.cage)
        n_marks, name = int(highest / lines.cage), f"the cage's {lines.cage:.4g} Hz"
        for k in range(1, n_marks + 1):
            label = f"multiples of {name}" if k == n_marks else None
            at = k * lines.cage
            ax.axvline(at, color=GREY, linestyle=":", linewidth=0.8, label=label)
        ax.legend(fontsize=SMALL, loc="upper right")
    else:
        note = f"lines {apart:.3g} Hz apart: too few for the cage's {lines.cage:.3g} Hz"
        ax.text(0.5, 0.95, note, ha="center", fontsize=SMALL, transform=ax.transAxes)
    shown = amplitude[lines.frequency <= highest]
    top = float(shown.max(initial=0.0))
    if top > 0:
        ax.set_ylim(_FLOOR * top, 6.0 * top)
    ax.set_xlim(0.0, highest)
    title = f"Spectrum of the sliding, {raceway} raceway"
    finish(ax, title, "frequency [Hz]", "amplitude [mm/s]")
    return ax


@chart
def load_over_orbit(found: Steady, ax: Ax = None) -> Panel:
    """Plot contact loads [N] against azimuth [deg], zones B and D shaded."""
    of = Axis.from_field(found, "contact_load", NEWTONS)
    marks = _raceway_curves(found, found.contact_load)
    note = "\nB, D: more load than by the axial load alone" if zones(found) else ""
    return _over_orbit(found, "Load", of, marks, note=note, floor=True)


@chart
def sliding_over_orbit(found: Steady, ax: Ax = None) -> Panel:
    """Plot sliding speed at contact centres [mm/s] against azimuth [deg].

    And, on an axis of its own, the slip of the orbit against pure rolling [%].
    """
    slip = Curve(*_close_circle(found, found.slip), "orbit slip", GREY, ":")
    title = "Sliding in the middle of the contacts"
    marks = _raceway_curves(found, found.sliding_speed)
    twin = _over_orbit(found, "", _SLIP, [slip])
    return _over_orbit(found, title, _SLIDING, marks, twin=twin, floor=True)


@chart
def spin_over_orbit(found: Steady, ax: Ax = None) -> Panel:
    """Plot spin in the orbiting frame [rad/s] against azimuth [deg]; of rollers about
    their axes, with that of pure rolling."""
    azimuth, spin = _close_circle(found, found.spin)
    if isinstance(found, SteadySkid):
        return _over_orbit(found, "Spin", _SPIN, _spins(azimuth, spin))
    rolling = _close_circle(found, found.rolling_spin)
    marks = [
        Curve(azimuth, spin, "spin", SPIN_COLOURS[2]),
        Curve(*rolling, "rolling", GREY, "--", {"linewidth": 1}),
    ]
    return _over_orbit(found, "Spin", _SPIN, marks)


@chart
def heat_over_orbit(found: Steady, ax: Ax = None) -> Panel:
    """Plot heat of the contacts [W] against azimuth [deg]."""
    marks, of = _raceway_curves(found, found.heat), Axis.from_field(found, "heat")
    return _over_orbit(found, "Heat of the contacts", of, marks, floor=True)


@chart
def cage_force_over_orbit(found: SteadyRollerSkid, ax: Ax = None) -> Panel:
    """Plot the force of the cage on a roller [N] against azimuth [deg]."""
    label = "above zero: pushed forwards"
    marks = [Curve(*_close_circle(found, found.cage_force), label, ROLLER)]
    of = Axis.from_field(found, "cage_force", NEWTONS)
    return _over_orbit(found, "Force of the cage on a roller", of, marks)


def _raceway_curves(found, values) -> list[Curve]:
    return _raceways(*_close_circle(found, by_raceway(values, found.contact_load)))


def _close_circle(found, values):
    """Return azimuth [deg] from 0 to 360 and values, the first repeated at the end."""
    azimuth = np.rad2deg(np.asarray(found.azimuth)) % 360.0
    azimuth = np.where(azimuth > 360.0 - 1e-9, 0.0, azimuth)
    order = np.argsort(azimuth)
    around = np.append(azimuth[order], azimuth[order[0]] + 360.0)
    return around, np.asarray(values)[np.append(order, order[0])]


def _over_orbit(found, title, of, marks, *, note="", **more: Any) -> Panel:
    """Return a panel whose zones are shaded and named."""
    twin = more.get("twin")
    count = len(marks) + (0 if twin is None else len(twin.marks))

    def shade(ax):
        parts = zones(found)
        ax.set_title(title, pad=_PAD if parts else None)
        ax.set_xlabel(f"{_AZIMUTH.label}{note}")
        ax.set_xticks(np.arange(0, 361, 60))
        for zone in parts:
            _shade(ax, zone)

    return Panel(
        title, _AZIMUTH, of, marks, (0.0, 360.0), room=0.14,
        legend={"loc": "upper center", "ncols": count}, also=shade, **more,
    )  # fmt: skip


def _shade(ax, zone):
    begin, end = np.rad2deg(zone.begin), np.rad2deg(zone.end)
    for turn in np.arange(np.floor(begin / 360.0), np.ceil(end / 360.0)) * 360.0:
        low, high = max(begin - turn, 0.0), min(end - turn, 360.0)
        if zone.loaded:
            ax.axvspan(low, high, color=_LOADED, linewidth=0, zorder=0)
        if high - low > 12.0:
            ax.text(
                0.5 * (low + high), 1.01, zone.name, fontweight="bold", color=GREY,
                transform=ax.get_xaxis_transform(), ha="center", va="bottom",
            )  # fmt: skip


OVER_TIME = (
    speed_over_time,
    slip_over_time,
    spin_over_time,
    power_over_time,
    load_over_time,
    sliding_over_time,
)
OVER_ORBIT = (
    load_over_orbit,
    sliding_over_orbit,
    spin_over_orbit,
    heat_over_orbit,
    cage_force_over_orbit,
)

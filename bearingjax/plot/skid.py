"""Pages on skidding balls and rollers, and cage speed over the load."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..skid import (
    Conditions,
    SkidHistory,
    SkidModel,
    SkidRollerHistory,
    SteadyRollerSkid,
    SteadySkid,
    by_raceway,
)
from .skid_contact import heat_map, sliding_ellipse, sliding_map
from .skid_orbit import (
    cage_force_over_orbit,
    heat_over_orbit,
    load_over_orbit,
    sliding_over_orbit,
    spin_over_orbit,
)
from .skid_time import (
    cage_force_over_time,
    load_over_time,
    power_over_time,
    sliding_over_time,
    sliding_spectrum,
    slip_over_time,
    speed_over_time,
    spin_over_time,
)
from .style import (
    COLOURS,
    GREY,
    RACEWAYS,
    ROLLER,
    SMALL,
    axes_or_new,
    degrees,
    head,
    pyplot,
)

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure


def skid_overview(
    model: SkidModel,
    found: SteadySkid | SteadyRollerSkid | SkidHistory | SkidRollerHistory,
    state: Conditions | None,
    title: str = "",
) -> "matplotlib.figure.Figure":
    """Plot one page on skidding balls or rollers.

    Of an end state: load, sliding and spin along the orbit, sliding and heat over the
    hottest contact, powers; where all balls move alike, both contacts of a ball; of
    rollers heat and cage force along the orbit. Of a motion in time: what
    `plot.skid_time` has, over time.

    Args:
        model: The bearing and its oil.
        found: From `skid.steady` or `skid.simulate`.
        state: From `conditions`; of rollers `None`.
        title: Head of the page; the kind of bearing if empty.

    Returns:
        The figure, 15 by 9 inches; of a motion in time 18 by 9.
    """
    if isinstance(found, SkidHistory | SkidRollerHistory):
        figure = _over_time(found)
    elif isinstance(found, SteadyRollerSkid):
        figure = _rollers(found)
    else:
        figure = _end(model, found, state)
    head(figure, title or type(model.bearing).__name__)
    return figure


def _over_time(found):
    figure = pyplot().figure(figsize=(18.0, 9.0))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    axes = figure.subplots(2, 4).ravel()
    drawn = (
        speed_over_time,
        slip_over_time,
        spin_over_time,
        power_over_time,
        load_over_time,
        sliding_over_time,
        _spectrum,
        cage_force_over_time,
    )
    for draw, ax in zip(drawn, axes, strict=True):
        draw(found, ax)
    return figure


def _rollers(found):
    figure = pyplot().figure(figsize=(15.0, 9.0))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    drawn = (
        load_over_orbit,
        sliding_over_orbit,
        spin_over_orbit,
        heat_over_orbit,
        cage_force_over_orbit,
        power_bars,
    )
    for draw, ax in zip(drawn, figure.subplots(2, 3).ravel(), strict=True):
        draw(found, ax)
    return figure


def _spectrum(found, ax):
    """Plot the sliding spectrum, or the reason why there is none."""
    try:
        sliding_spectrum(found, ax)
    except ValueError as error:
        ax.set_axis_off()
        ax.text(0.5, 0.5, str(error), ha="center", transform=ax.transAxes)


def _end(model, found, state):
    figure = pyplot().figure(figsize=(15.0, 9.0))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    alike = len(found.azimuth) == 1
    first = ["slip 0", "heat 0", "text"] if alike else ["load", "sliding", "spin"]
    panels: list[Any] = [first, ["slip", "heat", "power"]]
    axes = figure.subplot_mosaic(panels)
    heat = np.asarray(found.heat)
    half = heat.shape[-1] // 2
    if alike:
        load = np.asarray(found.contact_load)[0]
        outer, inner = np.argmax(load[:half]), half + np.argmax(load[half:])
        _contact(model, found, state, (0, int(outer)), axes["slip 0"], axes["heat 0"])
        at = (0, int(inner))
        _text(axes["text"], found)
    else:
        load_over_orbit(found, axes["load"])
        sliding_over_orbit(found, axes["sliding"])
        spin_over_orbit(found, axes["spin"])
        place, contact = np.unravel_index(np.argmax(heat), heat.shape)
        at = (int(place), int(contact))
    _contact(model, found, state, at, axes["slip"], axes["heat"])
    power_bars(found, axes["power"])
    return figure


def power_bars(
    found: SteadySkid | SteadyRollerSkid, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Plot the mean power of the drive and of all losses [W].

    Args:
        found: From `skid.steady`.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes.
    """
    ax = axes_or_new(ax)
    power = found.power
    heat = np.asarray(found.heat)
    half = heat.shape[-1] // 2
    # At even places a ball is for longer where it is slow.
    orbit = np.abs(np.asarray(found.orbit_speed))
    time = 1.0 / orbit if orbit.all() else np.ones_like(orbit)
    share = time / time.sum() * _balls(found)
    outer, inner = ((share @ part).sum() for part in (heat[:, :half], heat[:, half:]))
    bars = {
        "drive": (float(power.drive), GREY),
        "outer\ncontacts": (outer, COLOURS["outer"]),
        "inner\ncontacts": (inner, COLOURS["inner"]),
        "drag": (float(power.drag), ROLLER),
        "cage": (float(power.cage), "0.75"),
    }
    drawn = ax.bar(
        list(bars), [v for v, _ in bars.values()], color=[c for _, c in bars.values()]
    )
    ax.tick_params(axis="x", labelsize=SMALL)
    ax.bar_label(drawn, fmt="%.3g", fontsize=SMALL, padding=2)
    ax.margins(y=0.12)
    ax.grid(axis="y", color="0.9")
    ax.set_axisbelow(True)
    ax.set_ylabel("power [W]")
    ax.set_title("Power of the drive, and where it goes")
    return ax


def cage_speed(
    load: ArrayLike,
    found: SteadySkid,
    ax: "matplotlib.axes.Axes | None" = None,
    *,
    label: str = "",
) -> "matplotlib.axes.Axes":
    """Plot the cage speed over the load, with that of pure rolling [rad/s].

    Args:
        load: Of each case (case,) [N].
        found: From `skid.steady` under `jax.vmap` over loads, leading axis case; cases
            that did not converge are left out.
        ax: Axes; a new figure if `None`. Curves may be drawn over one another.
        label: Of the curve.

    Returns:
        The axes.

    Raises:
        ValueError: If there are not as many loads as cases.

    Source: Han & Chu, J. Sound Vib. 354 (2015) 219-235, figure 8.
    """
    load = np.asarray(load, dtype=float)
    speed = np.asarray(found.cage_speed, dtype=float)
    if load.ndim != 1 or load.shape != speed.shape:
        raise ValueError(
            f"`load` has the shape {load.shape} and the cage speed {speed.shape}; both"
            " must be rows of the same length."
        )
    speed = np.where(np.asarray(found.result) == 0, speed, np.nan)
    rolling = 1.0 / np.mean(1.0 / np.asarray(found.rolling_orbit_speed), axis=-1)
    ax = axes_or_new(ax)
    (line,) = ax.plot(load, speed, "o-", markersize=4, label=label or "with slip")
    ax.plot(
        load, rolling, "--", color=line.get_color(), linewidth=1, label="pure rolling"
    )
    ax.grid(color="0.9")
    ax.set_axisbelow(True)
    ax.set_xlabel("load [N]")
    ax.set_ylabel("cage speed [rad/s]")
    ax.set_title("Cage speed over the load")
    ax.legend(fontsize=SMALL)
    return ax


def _balls(found: Any) -> int:
    """Number of balls."""
    return len(found.solution.azimuth)


def _contact(model, found, state, at, slip, heat):
    """Draw both maps of one contact, named in their titles."""
    place, contact = at
    half = np.asarray(found.heat).shape[-1] // 2
    where = f"{RACEWAYS[contact // half]} raceway"
    if len(found.azimuth) > 1:
        where += f" at {degrees(found.azimuth)[place]:.4g}°"
    ellipse = sliding_ellipse(model, found, state, at)
    sliding_map(ellipse, slip).set_title(f"Sliding, {where}")
    total = float(np.asarray(found.heat)[at])
    heat_map(ellipse, heat).set_title(f"Heat, {where}: {_watt(total)}")


def _watt(power):
    return f"{power:.3g} W" if power >= 0.1 else f"{1e3 * power:.3g} mW"


def _text(ax, found):
    """Write the main results of balls in equal motion."""
    load, film, slide = (
        by_raceway(v, found.contact_load)[0]
        for v in (found.contact_load, found.film, found.sliding_speed)
    )
    spin = np.asarray(found.spin)[0]
    rows = {
        "cage": f"{float(found.cage_speed):.5g} rad/s",
        "pure rolling": f"{float(found.rolling_orbit_speed[0]):.5g} rad/s",
        "slip of the orbit": f"{100.0 * float(found.slip[0]):.3g} %",
        "spin: tangential, radial, axial": _listed(spin, "rad/s"),
        "pitch angle of the spin": f"{np.rad2deg(float(found.pitch_angle[0])):.3g}°",
        "contact load: outer, inner": _listed(load, "N"),
        "film: outer, inner": _listed(1e6 * film, "µm"),
        "sliding: outer, inner": _listed(1e3 * slide, "mm/s"),
        "friction torque": f"{1e3 * float(found.friction_torque):.4g} N mm",
    }
    ax.set_axis_off()
    for k, (name, value) in enumerate(rows.items()):
        height = 0.95 - 0.105 * k
        ax.text(0.0, height, name, color=GREY, fontsize=SMALL, transform=ax.transAxes)
        ax.text(1.0, height, value, ha="right", fontsize=SMALL, transform=ax.transAxes)
    ax.set_title("All balls alike")


def _listed(values: Any, unit: str) -> str:
    return ", ".join(f"{v + 0.0:.3g}" for v in values) + f" {unit}"

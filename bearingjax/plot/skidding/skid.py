"""Pages on skidding balls and rollers, maps of a contact, cage speed over load."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...skid import (
    Conditions,
    Ellipse,
    SkidHistory,
    SkidModel,
    SkidRollerHistory,
    SteadyRollerSkid,
    SteadySkid,
    sliding_ellipse,
)
from ...skid.conditions import by_raceway
from ..panel import NEWTONS, Ax, Axis, Bars, Curve, Panel, chart
from ..style import (
    COLOURS,
    GREY,
    RACEWAYS,
    ROLLER,
    SMALL,
    Axes,
    Figure,
    axes_or_new,
    degrees,
    head,
    new_page,
    pyplot,
)
from .skid_curves import OVER_ORBIT, OVER_TIME, cage_force_over_time, sliding_spectrum


def skid_overview(
    model: SkidModel,
    found: SteadySkid | SteadyRollerSkid | SkidHistory | SkidRollerHistory,
    state: Conditions | None,
    title: str = "",
) -> Figure:
    """Plot one page on skidding balls or rollers.

    Of an end state: load, sliding and spin along the orbit, sliding and heat over the
    hottest contact, powers; where all balls move alike, both contacts of a ball; of
    rollers heat and cage force along the orbit. Of a motion in time: what
    the plots over time show.

    Args:
        model: The bearing and its oil.
        found: From `skid.steady` or `skid.simulate`.
        state: From `conditions`; of rollers `None`.
        title: Head of the page; the kind of bearing if empty.

    Returns:
        The figure, 15 by 9 inches; of a motion in time 18 by 9.
    """
    if isinstance(found, SkidHistory | SkidRollerHistory):
        figure = _page(found, (*OVER_TIME, _spectrum, cage_force_over_time), 18.0)
    elif isinstance(found, SteadyRollerSkid):
        figure = _page(found, (*OVER_ORBIT, power_bars), 15.0)
    else:
        figure = _end(model, found, state)
    head(figure, title or type(model.bearing).__name__)
    return figure


def _page(found, drawn, width):
    """Draw plots on a page in two lines."""
    figure = new_page(width, 9.0)
    axes = figure.subplots(2, len(drawn) // 2).ravel()
    for draw, ax in zip(drawn, axes, strict=True):
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
    figure = new_page(15.0, 9.0)
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
        for name, draw in zip(first, OVER_ORBIT, strict=False):
            draw(found, axes[name])
        place, contact = np.unravel_index(np.argmax(heat), heat.shape)
        at = (int(place), int(contact))
    _contact(model, found, state, at, axes["slip"], axes["heat"])
    power_bars(found, axes["power"])
    return figure


@chart
def power_bars(found: SteadySkid | SteadyRollerSkid, ax: Ax = None) -> Panel:
    """Plot the mean power of the drive and of all losses [W].

    Args:
        found: From `skid.steady`.
    """
    power, (outer, inner) = found.power, found.raceway_heat
    bars = {
        "drive": (float(power.drive), GREY),
        "outer\ncontacts": (outer, COLOURS["outer"]),
        "inner\ncontacts": (inner, COLOURS["inner"]),
        "drag": (float(power.drag), ROLLER),
        "cage": (float(power.cage), "0.75"),
    }
    heights, colours = zip(*bars.values(), strict=True)

    def shrink(ax):
        ax.tick_params(axis="x", labelsize=SMALL)
        ax.margins(y=0.12)

    return Panel(
        "Power of the drive, and where it goes", Axis(""), Axis("power", "W"),
        [Bars(heights, "", colours, labels="%.3g")], names=list(bars), also=shrink,
    )  # fmt: skip


@chart
def cage_speed(
    load: ArrayLike, found: SteadySkid, ax: Ax = None, *, label: str = ""
) -> Panel:
    """Plot the cage speed over the load, with that of pure rolling [rad/s].

    Args:
        load: Load of each case (case,) [N].
        found: From `skid.steady` under `jax.vmap` over loads, leading axis case; cases
            that did not converge are left out.
        ax: Axes; a new figure if `None`. Curves may be drawn over one another.
        label: Label of the curve.

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
    colour = "C0" if ax is None else f"C{len(ax.get_lines()) // 2 % 10}"
    rolling = found.rolling_cage_speed
    marks = [
        Curve(load, speed, label or "with slip", colour, "o-", {"markersize": 4}),
        Curve(load, rolling, "pure rolling", colour, "--", {"linewidth": 1}),
    ]
    of = Axis.from_field(found, "cage_speed", (1.0, "rad/s"))
    return Panel("Cage speed over the load", Axis("load", "N", NEWTONS), of, marks)


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
        "spin: tangential, radial, axial": _list_cases(spin, "rad/s"),
        "pitch angle of the spin": f"{np.rad2deg(float(found.pitch_angle[0])):.3g}°",
        "contact load: outer, inner": _list_cases(load, "N"),
        "film: outer, inner": _list_cases(1e6 * film, "µm"),
        "sliding: outer, inner": _list_cases(1e3 * slide, "mm/s"),
        "friction torque": f"{1e3 * float(found.friction_torque):.4g} N mm",
    }
    ax.set_axis_off()
    for k, (name, value) in enumerate(rows.items()):
        height = 0.95 - 0.105 * k
        ax.text(0.0, height, name, color=GREY, fontsize=SMALL, transform=ax.transAxes)
        ax.text(1.0, height, value, ha="right", fontsize=SMALL, transform=ax.transAxes)
    ax.set_title("All balls alike")


def _list_cases(values: Any, unit: str) -> str:
    return ", ".join(f"{v + 0.0:.3g}" for v in values) + f" {unit}"


_MAP = "viridis"


def sliding_map(ellipse: Ellipse, ax: Ax = None) -> Axes:
    """Map the sliding speed over a contact [mm/s], with its direction as arrows.

    Args:
        ellipse: From `skid.sliding_ellipse`.

    Returns:
        The axes; both directions have scales of their own.
    """
    speed = 1e3 * np.sqrt((ellipse.slip**2).sum(axis=-1))
    ax = _mesh(ellipse, speed, "sliding speed [mm/s]", ax)
    rings, around = slice(4, None, 6), slice(0, -1, 9)
    # Of one length: their colours show the speed. As angles on the page, where the
    # directions have scales of their own, they lean to the one that is drawn longer.
    y, x = (1e3 * ellipse.y[rings, around], 1e6 * ellipse.x[rings, around])
    across, along = ellipse.slip[rings, around, 1], ellipse.slip[rings, around, 0]
    size = np.hypot(across, along)
    size = np.where(size > 0, size, 1.0)
    ax.quiver(
        y,
        x,
        across / size,
        along / size,
        color="white",
        edgecolor=GREY,
        linewidth=0.4,
        width=0.008,
        scale=16.0,
        pivot="middle",
        zorder=3,
    )
    ax.set_title("Sliding of the ball on its raceway")
    return ax


def heat_map(ellipse: Ellipse, ax: Ax = None) -> Axes:
    """Map the heat of the traction over a contact [W/mm²].

    Args:
        ellipse: From `skid.sliding_ellipse`.

    Returns:
        The axes; both directions have scales of their own.
    """
    ax = _mesh(ellipse, 1e-6 * ellipse.heat, "heat [W/mm²]", ax)
    ax.set_title("Heat of the traction")
    return ax


def _mesh(ellipse, values, label, ax):
    ax = axes_or_new(ax, (6.0, 4.0))
    mesh = ax.pcolormesh(
        1e3 * ellipse.y,
        1e6 * ellipse.x,
        values,
        shading="gouraud",
        cmap=pyplot().get_cmap(_MAP),
        vmin=0.0,
        rasterized=True,
    )
    ax.plot(1e3 * ellipse.y[-1], 1e6 * ellipse.x[-1], color=GREY, linewidth=0.8)
    bar = ax.figure.colorbar(mesh, ax=ax)
    bar.set_label(label)
    bar.ax.tick_params(labelsize=SMALL)
    ax.set_xlabel("across the rolling direction [mm]")
    ax.set_ylabel("along it [µm]")
    return ax

"""Modes of a rotor, its motion over frequency, speed and time, and its page."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ...rotor import STATION_FREEDOMS, CriticalSpeeds, Modes, Rotor, major_axis
from ...rotor.linear.modes import is_axial
from ...rotor.nonlinear import Branch, Spectra, envelope, spectra_over_time
from ..panel import Ax, Axis, Curve, Panel, chart, curves, finish
from ..style import (
    BOX,
    CURVES,
    GREY,
    INNER,
    OUTER,
    ROLLER,
    SMALL,
    Axes,
    Figure,
    axes_or_new,
    head,
    new_page,
    write_beside,
)
from .rotor import rotor_section

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


EVENTS = {
    "fold": ("fold", "s"),
    "flip": ("flip", "v"),
    "neimark_sacker": ("Neimark-Sacker", "D"),
    "branch_point": ("branch point", "*"),
}
"""Names and markers of events along a branch."""
_UNITS = {"um": "m", "mrad": "rad"}
_EXCITATION = Axis("frequency of the excitation", "rad/s", (0.5 / np.pi, "Hz"))


def _motion_axis(name, unit):
    """Return the axis of a motion in "um" or "mrad"; other units are refused."""
    if unit not in _UNITS:
        raise ValueError(f"`unit` is {unit!r}; it must be 'um' or 'mrad'.")
    return Axis(name, _UNITS[unit])


@chart
def response_curve(
    branch: Branch,
    amplitude: Any,
    ax: Ax = None,
    *,
    unit: str = "um",
    linear: tuple[Any, Any] | None = None,
) -> Panel:
    """Plot the amplitude of a branch of periodic orbits over the frequency [Hz].

    Stable parts are full lines, unstable ones dashed; folds, flips, Neimark-Sacker and
    branch points are marked where they were located.

    Args:
        branch: From `follow`.
        amplitude: Amplitude of its points, such as a column of `branch.amplitude`
            (point,) [m, rad].
        unit: Unit of the amplitude: "um", or "mrad" for a tilt.
        linear: Frequencies [rad/s] and amplitudes [m, rad] of the linear response.
    """
    frequency, marks = np.asarray(branch.frequency), []
    amplitude = np.asarray(amplitude, dtype=float)
    if linear is not None:
        marks.append(Curve(*linear, "linear", GREY, look={"lw": 1.0, "zorder": 1}))
    # A part between a stable point and one that is not counts as the latter.
    stable = np.asarray(branch.stable)
    stable = stable[1:] & stable[:-1]
    for value, name, colour, style in (
        (True, "stable", OUTER, "-"),
        (False, "unstable", INNER, "--"),
    ):
        for number, (first, last) in enumerate(runs(stable == value)):
            part, label = slice(first, last + 1), f"_{name}" if number else name
            x, y, look = frequency[part], amplitude[part], {"lw": 1.6, "zorder": 3}
            marks.append(Curve(x, y, label, colour, style, look))
    named = set()
    look = {"mec": "black", "ms": 6, "ls": "none", "zorder": 5}
    for event in branch.events:
        name, mark = EVENTS[event.kind]
        label = f"_{name}" if name in named else name
        height = _at_event(branch, event, amplitude)
        marks.append(Curve([event.frequency], [height], label, "white", mark, look))
        named.add(name)
    return _panel("Response", _EXCITATION, marks, unit, frequency)


@chart
def linear_curve(
    frequency: Any, amplitude: Any, ax: Ax = None, *, unit: str = "um"
) -> Panel:
    """Plot the amplitude of a linear response over the frequency [Hz].

    Args:
        frequency: Frequency of the excitation (point,) [rad/s].
        amplitude: (point,) [m, rad].
        unit: Unit of the amplitude: "um", or "mrad" for a tilt.
    """
    marks = [Curve(frequency, amplitude, "_linear")]
    return _panel("Response", _EXCITATION, marks, unit, frequency)


def _at_event(branch, event, amplitude):
    """Return the amplitude at an event, interpolated between points of the branch."""
    before, after = event.after, min(event.after + 1, len(amplitude) - 1)
    first = np.asarray(branch.amplitude)[before]
    way = np.asarray(branch.amplitude)[after] - first
    size = float(way @ way) or 1.0
    share = float(np.clip((event.amplitude - first) @ way / size, 0.0, 1.0))
    return (1.0 - share) * amplitude[before] + share * amplitude[after]


@chart
def speed_curve(
    speed: Any,
    amplitude: Any,
    ax: Ax = None,
    *,
    unit: str = "um",
    names: tuple[str, ...] = (),
    title: str = "Unbalance response",
) -> Panel:
    """Plot amplitudes over the speed [rpm], of a linear response or a run-up.

    Args:
        speed: (point,) [rad/s].
        amplitude: (point,) or (point, curve) [m, rad].
        unit: Unit of the amplitude: "um", or "mrad" for tilts.
        names: Names of the curves.
        title: Title of the axes.
    """
    values = np.asarray(amplitude, dtype=float)
    values = values[:, None] if values.ndim == 1 else values
    return _panel(title, SPEED, curves(speed, values, names), unit, speed)


def _panel(title, over, marks, unit, x) -> Panel:
    x = np.asarray(x, dtype=float)
    span = (x.min(), x.max()) if len(x) and x.max() > x.min() else None
    of = _motion_axis("amplitude", unit)
    return Panel(title, over, of, marks, span, floor=True, room=0.12)


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
        _motion_axis("displacement" if unit == "um" else "tilt", unit),
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
    rpm, of = SPEED.scale * spectra.speed, _motion_axis("largest line", unit)
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


_ACROSS = 3
"""Number of pictures side by side."""
_LEAST_TIMES = 100
"""Least number of times for spectra of a run-up."""


def rotor_overview(run: Any, title: str = "") -> Figure:
    """Plot the rotor with available modes, Campbell diagram, response and motion.

    Args:
        run: Results of the scene of a rotor; parts that are `None` are not drawn.
        title: Head of the page; "Rotor" if empty.

    Returns:
        The figure, 16 inches wide.
    """
    drawn = [*_linear(run), *_response(run), *_transient(run)]
    rows = -(-len(drawn) // _ACROSS)
    figure = new_page(16.0, 5.0 + 4.6 * rows)
    grid = figure.add_gridspec(
        1 + rows, 6, height_ratios=[1.0] + rows * [1.0] if rows else [1.0]
    )
    rotor_section(run.rotor, figure.add_subplot(grid[0, :]))
    for k, draw in enumerate(drawn):
        row, place = divmod(k, _ACROSS)
        # The last row is filled by as many as there are.
        wide = 6 // min(_ACROSS, len(drawn) - row * _ACROSS)
        draw(figure.add_subplot(grid[1 + row, place * wide : (place + 1) * wide]))
    head(figure, title or "Rotor")
    return figure


def _linear(run) -> list[Callable]:
    drawn = []
    if run.modes is not None:
        drawn.append(lambda ax: mode_shapes(run.rotor, run.modes, ax))
    if run.campbell is not None:
        drawn.append(
            lambda ax: campbell_diagram(
                run.task.campbell, run.campbell, run.critical, ax
            )
        )
    return drawn


def _response(run) -> list[Callable]:
    found, task = run.response, run.task.response
    if found is None or not len(found.frequency):
        return []
    freedom = STATION_FREEDOMS.index(task.coordinate)
    amplitude = np.asarray(found.amplitude)[:, task.station, freedom]
    unit = "um" if freedom < 3 else "mrad"
    where = f"{task.coordinate} at station {task.station}"
    largest = int(np.nanargmax(amplitude))
    hertz = float(found.frequency[largest]) / (2.0 * np.pi)
    at_peak = np.asarray(found.displacement)[largest]

    def curve(ax):
        if found.branch is None:
            linear_curve(found.frequency, amplitude, ax, unit=unit)
        else:
            response_curve(found.branch, amplitude, ax, unit=unit)
        method = found.method.replace("_", " ")
        ax.set_title(f"Response of {where}, {method}")

    def paths(ax):
        orbits(at_peak[:, [task.station], :2], ax, names=(f"station {task.station}",))
        ax.set_title(f"Orbits at {hertz:.4g} Hz")

    def waves(ax):
        waveforms(at_peak[:, task.station, :3], ax, names=STATION_FREEDOMS[:3])
        ax.set_title(f"Waveforms at {hertz:.4g} Hz")

    return [curve, paths, waves]


def _transient(run) -> list[Callable]:
    found, task = run.transient, run.task.transient
    if found is None or found.n_reached < 2:
        return []
    n = int(found.n_reached)
    time, speed = np.asarray(found.time)[:n], np.asarray(found.speed)[:n]
    freedom = STATION_FREEDOMS.index(task.coordinate)
    station = np.asarray(found.displacement)[:n, task.station]
    motion, unit = station[:, freedom], "um" if freedom < 3 else "mrad"
    name = f"{task.coordinate} at station {task.station}"
    drawn: list[Callable] = [
        lambda ax: waveforms(motion[:, None], ax, time=time, names=(name,), unit=unit)
    ]
    if np.ptp(speed) == 0.0:
        later = station[n // 2 :, None, :2]

        def paths(ax):
            orbits(later, ax, names=(f"station {task.station}",), closed=False)
            ax.set_title("Orbit, second half of the time")

        return [*drawn, paths]

    def draw_run_up(ax):
        speed_curve(
            *envelope(time, speed, motion), ax, unit=unit, names=(name,), title="Run-up"
        )

    drawn.append(draw_run_up)
    if n >= _LEAST_TIMES:
        spectra = spectra_over_time(time, speed, motion)
        drawn.append(lambda ax: waterfall(spectra, ax, unit=unit))
    return drawn

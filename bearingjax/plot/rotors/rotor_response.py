"""Plots of rotor amplitudes over the frequency of excitation, and over speed."""

from typing import Any

import numpy as np

from ...rotor.nonlinear import Branch
from ..panel import Ax, Axis, Curve, Panel, chart, curves
from ..style import GREY, INNER, OUTER
from .rotor_modes import SPEED, runs

EVENTS = {
    "fold": ("fold", "s"),
    "flip": ("flip", "v"),
    "neimark_sacker": ("Neimark-Sacker", "D"),
    "branch_point": ("branch point", "*"),
}
"""Names and markers of events along a branch."""
_UNITS = {"um": "m", "mrad": "rad"}
_EXCITATION = Axis("frequency of the excitation", "rad/s", (0.5 / np.pi, "Hz"))


def motion_axis(name: str, unit: str) -> Axis:
    """Return the axis of a motion.

    Args:
        name: Name of the motion.
        unit: "um" or "mrad".

    Raises:
        ValueError: For another unit.
    """
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
    of = motion_axis("amplitude", unit)
    return Panel(title, over, of, marks, span, floor=True, room=0.12)

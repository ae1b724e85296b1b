"""Drawing of a profile with its parameters."""

import dataclasses
from typing import Any

import numpy as np

from ...design import AbstractRollerBearing, CrownedEnds, FujiwaraKawase, Tabulated
from ..profiles import drop_along
from ..style import BOX, COLOURS, GREY, ROLLER, Axes, axes_or_new, write
from .dimension import arrow, label, write_aside

_COLOURS = {
    "roller_profile": ROLLER,
    "outer_raceway_profile": COLOURS["outer"],
    "inner_raceway_profile": COLOURS["inner"],
}
_NEAR = 0.95
"""Share of the length beyond which a profile is ignored for the scale."""


def profile_view(ax: Axes, bearing: AbstractRollerBearing, name: str) -> None:
    """Draw the drop along the roller, magnified by its axis, with all its parameters.

    Lengths are drawn where they are measured; the others are next to the curve.
    """
    ax = axes_or_new(ax)
    profile, length = getattr(bearing, name), float(bearing.roller_length)
    s, drop = drop_along(bearing, name, 401)
    drop = 1e6 * drop
    inside = float(drop[np.abs(s) <= 0.5 * _NEAR * length].max())
    limit = min(float(drop.max()), 3.0 * inside) if inside > 0.0 else drop.max()
    limit = float(limit) or 1.0
    ax.plot(1e3 * s, drop, color=_COLOURS[name], linewidth=2.0)
    spans = _spans(profile, length)
    for k, (field, (start, stop)) in enumerate(spans.items()):
        height = -limit * (0.3 + 0.34 * k)
        text = label(profile, field)
        arrow(ax, (1e3 * start, height), (1e3 * stop, height), "<|-|>")
        for place in (start, stop):
            ax.plot([1e3 * place] * 2, [height, 0.0], color=GREY, linewidth=0.7)
        middle = 0.5e3 * (start + stop)
        where = "center" if abs(middle) < 0.3e3 * length else "right"
        at = middle, height - 0.04 * limit
        write(ax, at, text, ha=where, va="bottom", zorder=7)
    levels = len(spans)
    if drop[-1] <= limit:
        text = f"at the end {drop[-1]:.4g} µm"
        if hasattr(profile, "end_drop"):
            text = label(profile, "end_drop")
        height = -limit * (0.3 + 0.34 * levels)
        _end(ax, 1e3 * s[-1], drop[-1], height, text)
        levels += 1
    rest = [name for name in _fields(profile) if name not in (*spans, "end_drop")]
    text = "\n".join(_text(profile, field) for field in rest)
    look = {"va": "bottom", "bbox": BOX | {"alpha": 0.85, "pad": 1.5}}
    write(ax, (0.5, 0.06), text, transform=ax.transAxes, **look)
    if isinstance(profile, Tabulated):
        x, y = 1e3 * np.asarray(profile.positions), 1e6 * np.asarray(profile.drops)
        ax.plot(x, y, "o", color="black", markersize=3, zorder=7)
    ax.set_ylim(1.15 * limit, -limit * (0.35 + 0.36 * levels))
    ax.set_xlim(-0.52e3 * length, 0.56e3 * length)
    ax.grid(color="0.92")
    ax.set_xlabel("position along the roller [mm]")
    ax.set_ylabel("drop [µm]")
    ax.set_title(f"{name}: {type(profile).__name__}", fontsize=11)


def _end(ax, x, drop, height, text):
    """Draw the drop at the end of the roller."""
    at = 1.06 * x
    for level in (0.0, drop):
        ax.plot([x, 1.08 * x], [level] * 2, color=GREY, linewidth=0.7)
    arrow(ax, (at, 0.0), (at, drop), "<|-|>")
    down = 1.0, 0.0  # straight, beside the spans
    look: Any = {"ha": "right", "textcoords": "data", "zorder": None}
    write_aside(ax, (at, 0.0), (at, height), text, down, **look)


def _fields(profile):
    return [field.name for field in dataclasses.fields(profile)]


def _text(profile, field):
    value = getattr(profile, field)
    if value is not None and np.ndim(value):
        return f"{field}: {len(value)} points"
    return label(profile, field)


def _spans(profile, length):
    """Return fields that are lengths along the roller, with their ends [m]."""
    half = 0.5 * length
    if isinstance(profile, CrownedEnds):
        straight = 0.5 * float(profile.straight_length)
        spans = {"straight_length": (-straight, straight)}
        if profile.dub_off_length is not None:
            spans["dub_off_length"] = (half - float(profile.dub_off_length), half)
        return spans
    if isinstance(profile, FujiwaraKawase):
        return {
            "crowned_fraction": (half * (1 - float(profile.crowned_fraction)), half)
        }
    return {}

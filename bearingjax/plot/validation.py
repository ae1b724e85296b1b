"""Our numbers of validation cases over those of others."""

from collections.abc import Mapping

import numpy as np

from .panel import finish
from .style import CURVES, GREY, SMALL, Figure, new_page

_FLOOR = 1e-4
"""Difference below which the axis is linear [%]."""


def validation_overview(
    pairs: Mapping[str, tuple[np.ndarray, np.ndarray]], trust: Mapping[str, str]
) -> Figure:
    """Plot ours over theirs, and the differences of each case.

    Args:
        pairs: By case theirs and ours (value,), in any unit.
        trust: Kind of trust of each case; a colour each.

    Returns:
        The figure; its height follows from the number of cases.
    """
    figure = new_page(11.0, max(5.5, 1.5 + 0.2 * len(pairs)), 0.1)
    scatter, strip = figure.subplots(1, 2, width_ratios=(1.0, 1.4))
    colours = dict(zip(dict.fromkeys(trust.values()), CURVES, strict=False))
    ends = [np.inf, 0.0]
    for place, (name, (theirs, ours)) in enumerate(pairs.items()):
        colour = colours[trust[name]]
        sizes = np.abs(theirs), np.abs(ours)
        known = (sizes[0] > 0.0) & (sizes[1] > 0.0)
        scatter.plot(sizes[0][known], sizes[1][known], ".", color=colour, alpha=0.6)
        ends = [
            min(ends[0], *sizes[0][known], np.inf),
            max(ends[1], *sizes[0][known], 0.0),
        ]
        share = 100.0 * (ours - theirs)[known] / sizes[0][known]
        strip.plot(share, np.full(share.shape, place), ".", color=colour, alpha=0.6)
    if ends[1] > 0.0:
        scatter.plot(ends, ends, color=GREY, linewidth=0.8, zorder=0)
        scatter.set(xscale="log", yscale="log")
    for kind, colour in colours.items():
        scatter.plot([], [], ".", color=colour, label=kind)
    scatter.legend(fontsize=SMALL)
    strip.set_xscale("symlog", linthresh=_FLOOR)
    far = [10.0**power for power in (-3, -1, 1)]
    strip.set_xticks([*(-x for x in reversed(far)), 0.0, *far])
    strip.set_yticks(range(len(pairs)), list(pairs), fontsize=SMALL)
    strip.invert_yaxis()
    strip.axvline(0.0, color=GREY, linewidth=0.8)
    finish(scatter, "Ours over theirs", "size of theirs", "size of ours")
    finish(strip, "Difference of each value", "ours less theirs [%]")
    return figure

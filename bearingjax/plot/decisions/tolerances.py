"""Distributions of results within tolerances, and their causes."""

from typing import Any

import numpy as np

from ..panel import Axis, Bars, Panel
from ..style import COLOURS, GREY, ROLLER, Figure, head, new_page

_BINS = 40
_MOST = 4
"""Most measures drawn."""


def tolerance_overview(found: Any, title: str = "") -> Figure:
    """Plot the distribution of each measure, and the causes of its variance.

    Above a histogram of the samples, with the quantiles of 1, 50 and 99 % and the
    normal distribution by the gradient at the mean; below the share of the variance
    that each number causes alone, and that by the gradient. Of many measures the first
    four.

    Args:
        found: From `decide.tolerances`.
        title: Head of the page; "Tolerances" if empty.

    Returns:
        The figure, 4.2 inches wide for each measure and 7.6 high.
    """
    spreads = found.spreads[:_MOST]
    figure = new_page(max(6.0, 4.2 * len(spreads)), 7.6)
    rows = figure.subplots(2, len(spreads), squeeze=False)
    names = [one.name.replace("bearings.", "") for one in found.scatters]
    for k, spread in enumerate(spreads):
        _histogram(spread, found.values[:, k], rows[0, k])
        bars = [
            Bars(100.0 * spread.shares, "samples", ROLLER, -0.2, 0.4),
            Bars(100.0 * spread.first_order_shares, "gradient", GREY, 0.2, 0.4),
        ]
        of = Axis("share of the variance", "%")
        ax = Panel("", Axis(""), of, bars, names=names, room=0.15).draw(rows[1, k])
        ax.tick_params("x", rotation=60)
    head(figure, title or "Tolerances")
    return figure


def _histogram(spread, values, ax):
    axis = Axis(spread.name, spread.unit)
    values = axis.scale * values[np.isfinite(values)]
    ax.hist(values, _BINS, density=True, color=COLOURS["outer"], alpha=0.6)
    for quantile in spread.quantiles[[0, 2, 4]]:
        ax.axvline(axis.scale * quantile, color="0.3", linewidth=1.0)
    deviation = axis.scale * spread.first_order[1]
    if deviation > 0.0:
        x = np.linspace(values.min(), values.max(), 200)
        off = (x - axis.scale * spread.first_order[0]) / deviation
        normal = np.exp(-0.5 * off**2) / (deviation * (2.0 * np.pi) ** 0.5)
        ax.plot(x, normal, color="0.1", linestyle="--", label="by the gradient")
        ax.legend(fontsize="small")
    ax.set_yticks([])
    ax.locator_params("x", nbins=5)  # lives of five digits
    Panel("", axis, Axis("density"), []).draw(ax)

"""Figures of identification, selection of bearings and tolerance analysis."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..decide import Identified, Selection
from ..numerics.units import display_unit
from .panel import Axis, Bars, Curve, Panel
from .style import COLOURS, GREY, INNER, OUTER, ROLLER, Figure, head, new_page


def identify_overview(
    found: Identified, units: Mapping[str, str], title: str = ""
) -> Figure:
    """Plot predicted over measured values, and residuals with their errors.

    Each measured name has a row: on the left predicted over measured values, with the
    line of equality; on the right residuals over cases, with bars of one standard
    error.

    Args:
        found: Result of `identify`.
        units: SI units by name; names that are missing have none.
        title: Title of the figure; "Measured and predicted" if empty.

    Returns:
        Figure, 10 inches wide.
    """
    names = [name for name in found.residual if name not in found.names]
    figure = new_page(10.0, 0.6 + 3.2 * len(names))
    axes = figure.subplots(len(names), 2, squeeze=False)
    bar = {"fmt": "o", "ms": 4, "capsize": 2, "color": ROLLER}
    for name, (left, right) in zip(names, axes, strict=True):
        value, missed, error = (
            of[name] for of in (found.prediction, found.residual, found.error)
        )
        there = np.isfinite(missed)
        for ax, most in ((left, abs(value[there])), (right, abs(missed[there]))):
            factor, unit = display_unit(units.get(name, ""), float(most.max()))
            end = f" [{unit}]" if unit else ""
            if ax is right:
                cases = np.arange(missed.size)
                ax.errorbar(cases, factor * missed, yerr=factor * error, **bar)
                ax.axhline(0.0, color=OUTER, lw=1)
                ax.xaxis.get_major_locator().set_params(integer=True)
                ax.set(xlabel="case", ylabel=f"measured less predicted{end}")
                continue
            read = factor * (value + missed)
            ax.errorbar(read, factor * value, xerr=factor * error, **bar)
            ax.plot(*[[np.nanmin(read), np.nanmax(read)]] * 2, color=OUTER, lw=1)
            ax.set(xlabel=f"measured{end}", ylabel=f"predicted{end}", title=name)
    head(figure, title or "Measured and predicted")
    return figure


def selection_overview(found: Selection, title: str = "") -> Figure:
    """Plot life over mass of the bearings that were solved, and the required life.

    Where nothing turns, static safety takes the place of the life. The best bearing
    that fits is named.

    Args:
        found: Result of `select`.
        title: Title of the figure; "Choice of bearing" if empty.

    Returns:
        Figure, 8 by 5.5 inches.
    """
    table, fits = found.table, found.table["requirement"] == ""
    turning = np.isfinite(table["life_hours"]).any()
    name, unit = ("life_hours", "h") if turning else ("static_safety", "")
    mass, values = table["mass"], table[name]
    marks = [
        Curve(mass[mine], values[mine], label, colour, "o")
        for mine, label, colour in ((~fits, "excluded", GREY), (fits, "fit", OUTER))
    ]
    shown = mass[np.isfinite(values)]
    least, _ = found.requirements.all_bounds.get(name, (None, None))
    if least is not None and shown.size:
        ends = np.array([shown.min(), shown.max()])
        marks.append(Curve(ends, np.full(2, least), "required", INNER, "--"))
    figure = new_page(8.0, 5.5)
    over, of = Axis("mass", "kg"), Axis(name.replace("_", " "), unit)
    panel = Panel("Bearings that the catalogue does not exclude", over, of, marks)
    ax = panel.draw(figure.subplots())
    ax.set(xscale="log", yscale="log")
    if fits[0]:
        best = str(table["designation"][0]), (mass[0], values[0])
        ax.annotate(*best, (6, 6), textcoords="offset points")
    head(figure, title or "Choice of bearing")
    return figure


_BINS = 40
_MOST = 4
"""Largest number of measures that are plotted."""


def tolerance_overview(found: Any, title: str = "") -> Figure:
    """Plot the distribution of each measure, and the shares of its variance.

    The upper row has histograms of the samples, with the quantiles of 1, 50 and 99 %
    and the normal distribution of first order, by the gradient at the mean. The lower
    row has the share of the variance that each number causes alone, from the samples
    and by the gradient. Only the first four measures are shown.

    Args:
        found: Result of `decide.tolerances`.
        title: Title of the figure; "Tolerances" if empty.

    Returns:
        Figure, 4.2 inches wide for each measure and 7.6 inches high.
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
    ax.locator_params("x", nbins=5)  # labels of five digits must not overlap
    Panel("", axis, Axis("density"), []).draw(ax)

"""Plot of measurements beside what the identified design predicts."""

from collections.abc import Mapping

import numpy as np

from ...decide import Identified
from ...numerics.units import display_unit
from ..style import OUTER, ROLLER, Figure, head, new_page


def identify_overview(
    found: Identified, units: Mapping[str, str], title: str = ""
) -> Figure:
    """Plot predicted over measured numbers, and residuals with their errors.

    A row for each measured name: left predicted over measured, with the line on which
    they are alike; right the residuals over the cases, with bars of one standard error.

    Args:
        found: From `identify`.
        units: SI units by name; others are pure numbers.
        title: Head of the page.

    Returns:
        The figure, 10 inches wide.
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

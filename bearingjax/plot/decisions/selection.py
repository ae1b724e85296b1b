"""Plot of a choice of bearing."""

import numpy as np

from ...decide import Selection
from ..panel import Axis, Curve, Panel
from ..style import GREY, INNER, OUTER, Figure, head, new_page


def selection_overview(found: Selection, title: str = "") -> Figure:
    """Plot the bearings that were solved: life over mass, and the required life.

    Without a life in hours the static safety stands in its place. The best of those
    that fit is named.

    Args:
        found: From `select`.
        title: Head of the page.

    Returns:
        The figure, 8 by 5.5 inches.
    """
    table, bounds = found.table, found.requirements.all_bounds
    turning = np.isfinite(table["life_hours"]).any()
    name, unit = ("life_hours", "h") if turning else ("static_safety", "")
    mass, values = table["mass"], table[name]
    fits, shown = table["requirement"] == "", np.isfinite(values)
    marks = [
        Curve(mass[mine & shown], values[mine & shown], label, colour, "o")
        for mine, label, colour in ((~fits, "excluded", GREY), (fits, "fit", OUTER))
    ]
    if name in bounds and shown.any():
        ends = np.array([mass[shown].min(), mass[shown].max()])
        required = np.full(2, bounds[name][0] or bounds[name][1])
        marks.append(Curve(ends, required, "required", INNER, "--"))

    def finish(ax):
        ax.set(xscale="log", yscale="log")
        if fits[0] and shown[0]:
            best = str(table["designation"][0]), (mass[0], values[0])
            ax.annotate(*best, (6, 6), textcoords="offset points")

    over, of = Axis("mass", "kg"), Axis(name.replace("_", " "), unit)
    figure = new_page(8.0, 5.5)
    panel = Panel("Bearings that the catalogue does not exclude", over, of, marks)
    finish(panel.draw(figure.subplots()))
    head(figure, title or "Choice of bearing")
    return figure

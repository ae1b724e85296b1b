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

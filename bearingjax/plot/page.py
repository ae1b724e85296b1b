"""One page on a solved bearing."""

from typing import Any

import numpy as np

from ..catalogue.entry import CatalogueEntry
from ..design import AbstractBearing, BearingSet
from ..design.abstract import nearest_entry
from ..numerics.result import Result
from ..numerics.units import shown_count
from ..statics.solution import BallSolution, RollerSolution, Solution
from ..statics.warning import solution_warnings
from .drawings.section import cross_section
from .element_contacts import contact_angles, ellipses, pressure_map, pressure_profiles
from .load import load_zone
from .style import (
    RACEWAYS,
    Figure,
    degrees,
    force_text,
    head,
    new_page,
    row_slices,
    write_foot,
)


def overview(
    bearing: AbstractBearing | BearingSet,
    solution: Solution,
    title: str = "",
    catalogue: CatalogueEntry | None = None,
) -> Figure:
    """Plot section, load zone, contacts and the main results on one page.

    Args:
        bearing: The design.
        solution: Its single solution.
        title: Head of the page; the kind of bearing if empty.
        catalogue: Its catalogue entry, whose boundary dimensions are drawn too.

    Returns:
        The figure, 13.5 inches wide: a line of pictures for each row of a set.
    """
    rows = row_slices(solution)
    n = len(rows)
    noun = solution.element.bearing.noun
    figure = new_page(13.5, 5.1 + 3.3 * n, 0.1, 0.08)
    heights = [4.3, 3.3 * n, 0.5]
    parts: Any = figure.subfigures(3, 1, height_ratios=heights)
    upper, lower, foot = parts
    section = upper.add_subplot(1, 2, 1)
    zone = upper.add_subplot(1, 2, 2, projection="polar")
    # Contact angles of all rows are compared in one picture.
    along = [0 if noun == "ball" else k for k in range(n)]
    axes = lower.subplot_mosaic(
        [[f"along{along[k]}", f"outer{k}", f"inner{k}"] for k in range(n)]
    )
    cross_section(bearing, section, catalogue)
    load_zone(solution, zone)
    nearest_entry(_CONTACTS, solution)(bearing, solution, axes, rows)
    write_foot(foot, "\n".join(_results(solution)))
    head(figure, title or type(bearing).__name__)
    # Equal scales move the ticks, for whose words the layout then makes room.
    figure.draw_without_rendering()
    return figure


def _contacts_of_balls(bearing, solution, axes, rows):
    contact_angles(solution, axes["along0"])
    for k in range(len(rows)):
        for raceway in RACEWAYS:
            ax = axes[f"{raceway}{k}"]
            ellipses(bearing, solution, raceway=raceway, row=k, ax=ax)


def _contacts_of_rollers(bearing, solution, axes, rows):
    for k, mine in enumerate(rows):
        pressure_profiles(solution, axes[f"along{k}"], count=2, raceway="both", row=k)
        # Both raceways of a row in one scale of colours.
        top = float(np.max(np.asarray(solution.contact_pressure)[mine]))
        for raceway in RACEWAYS:
            ax = axes[f"{raceway}{k}"]
            pressure_map(solution, ax, raceway=raceway, row=k, top=top)


_CONTACTS = {BallSolution: _contacts_of_balls, RollerSolution: _contacts_of_rollers}


def _results(solution):
    """Return two lines of text: displacement, largest load and pressure, state."""
    q = np.asarray(solution.displacement)
    shift, tilt = np.split(q[6:] - q[:6], 2)
    load = np.asarray(solution.roller_load)
    pressure = np.asarray(solution.roller_pressure)
    roller, ring = np.unravel_index(np.argmax(load), load.shape)
    azimuth = degrees(solution.azimuth)[roller]
    result = Result(int(solution.result)).label.replace("_", " ")
    element = solution.element.bearing.noun
    count = len(solution_warnings(solution))
    return (
        "inner against outer ring:  "
        f"u = ({_join(1e6 * shift)}) µm,  γ = ({_join(1e3 * tilt)}) mrad",
        f"largest {element} load {force_text(load[roller, ring])} at {azimuth:.4g}°,  "
        f"largest pressure {1e-6 * pressure.max():.4g} MPa,  "
        f"{np.count_nonzero(np.asarray(solution.load_zone))} of {len(load)} {element}s"
        f" loaded,  {result},  {shown_count(count, 'warning')}",
    )


def _join(values):
    return ", ".join(f"{v:.4g}" for v in np.where(np.abs(values) < 5e-7, 0.0, values))

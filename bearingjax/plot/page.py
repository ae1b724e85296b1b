"""One page on a solved bearing."""

from typing import TYPE_CHECKING

import numpy as np

from ..design import AbstractBallBearing, Bearing, BearingSet, rows_of
from ..numerics.result import Result
from ..statics.solution import BallSolution, RollerSolution, Solution
from ..statics.warning import warnings
from .balls import contact_angles, ellipses
from .load import load_zone
from .pressure import pressure_map, pressure_profiles
from .section import cross_section
from .style import degrees, force_text, head, pyplot, row_slices

if TYPE_CHECKING:
    import matplotlib.figure


def overview(
    bearing: Bearing | BearingSet, solution: Solution, title: str = ""
) -> "matplotlib.figure.Figure":
    """Section, load zone, contacts and the main results on one page.

    Args:
        bearing: The design.
        solution: Its single solution.
        title: Head of the page; the kind of bearing if empty.

    Returns:
        The figure, 12 by 9 inches.
    """
    figure = pyplot().figure(figsize=(12.0, 9.0))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.08)
    axes = figure.subplot_mosaic(
        [["section", "zone"], ["left", "right"], ["text", "text"]],
        height_ratios=[1.15, 1.0, 0.13],
        per_subplot_kw={"zone": {"projection": "polar"}},
    )
    cross_section(bearing, axes["section"])
    load_zone(solution, axes["zone"])
    raceway, row = _busier_raceway(solution), _busiest_row(solution)
    if isinstance(solution, BallSolution):
        contact_angles(solution, axes["left"])
        figure.draw_without_rendering()  # the layout gives the ellipses their scale
        part = rows_of(bearing)[row].bearing
        assert isinstance(part, AbstractBallBearing)
        ellipses(part, solution, raceway=raceway, row=row, ax=axes["right"])
    else:
        assert isinstance(solution, RollerSolution)
        pressure_profiles(solution, axes["left"], raceway=raceway, row=row)
        pressure_map(solution, axes["right"], raceway=raceway, row=row)
    axes["text"].set_axis_off()
    axes["text"].text(
        0.5,
        0.5,
        "\n".join(_results(solution)),
        ha="center",
        va="center",
        fontsize=10,
        linespacing=1.5,
        transform=axes["text"].transAxes,
        in_layout=False,
    )
    head(figure, title or type(bearing).__name__)
    return figure


def _busier_raceway(solution):
    """The raceway with the higher pressure; the inner one if they are equal."""
    outer, inner = np.asarray(solution.roller_pressure).max(axis=0)
    return "outer" if outer > inner else "inner"


def _busiest_row(solution):
    """The row with the largest load of a roller or ball."""
    load = np.asarray(solution.roller_load)
    tops = [load[mine].max(initial=0.0) for mine in row_slices(solution)]
    return int(np.argmax(tops))


def _results(solution):
    """Two lines: displacement, largest load and pressure, state."""
    q = np.asarray(solution.displacement)
    shift, tilt = np.split(q[6:] - q[:6], 2)
    load = np.asarray(solution.roller_load)
    pressure = np.asarray(solution.roller_pressure)
    roller, ring = np.unravel_index(np.argmax(load), load.shape)
    azimuth = degrees(solution.azimuth)[roller]
    result = Result(int(solution.result)).label.replace("_", " ")
    element = "ball" if isinstance(solution, BallSolution) else "roller"
    count = len(warnings(solution))
    return (
        "inner against outer ring:  "
        f"u = ({_three(1e6 * shift)}) µm,  γ = ({_three(1e3 * tilt)}) mrad",
        f"largest {element} load {force_text(load[roller, ring])} at {azimuth:.4g}°,  "
        f"largest pressure {1e-6 * pressure.max():.4g} MPa,  "
        f"{np.count_nonzero(np.asarray(solution.load_zone))} of {len(load)} {element}s"
        f" loaded,  {result},  {count} warning{'' if count == 1 else 's'}",
    )


def _three(values):
    return ", ".join(f"{v:.4g}" for v in np.where(np.abs(values) < 5e-7, 0.0, values))

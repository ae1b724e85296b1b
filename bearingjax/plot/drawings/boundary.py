"""Boundary dimensions d, D, B of the catalogue, on the axial section of a bearing."""

from typing import Any

import numpy as np

from ...catalogue.entry import CatalogueEntry, bearing_of_entry
from ...design import AbstractBearing, BearingSet, rows_of
from ..style import BOX, GREY, Axes, write_beside
from .dimension import quantity

_UNPLACED = "angular_contact_ball", "tapered_roller", "spherical_thrust_roller"
"""Types that are not symmetric: the catalogue does not place their side faces."""


def draw_boundary(
    ax: Axes,
    bearing: AbstractBearing | BearingSet,
    entry: CatalogueEntry | None,
    centre: float = 0.0,
) -> None:
    """Draw bore, outside diameter and side faces of the catalogue, dashed, to scale.

    The side faces are left out where the catalogue does not tell their place: of types
    that are not symmetric, and of sets of several bearings. Schematic ring bodies end
    at the lines. Where the elements of the design do not lie between d and D, as the
    design is another, nothing is drawn.

    Args:
        ax: Axes with the rings drawn, z to the right, radius upwards [mm].
        bearing: The design.
        entry: Its catalogue entry, or `None`.
        centre: Radius at which the vertical axis is 0 [mm].
    """
    row: Any = rows_of(bearing)[0].bearing
    pitch, element = float(row.pitch_diameter), float(row.element_diameter)
    if entry is None or not (
        entry.bore < pitch - element and pitch + element < entry.outside_diameter
    ):
        return
    from matplotlib.patches import Rectangle

    sizes = entry.bore, entry.outside_diameter, entry.width
    low, high = 500.0 * np.array(sizes[:2]) - centre
    rows = len(rows_of(bearing))
    placed = (
        rows == len(rows_of(bearing_of_entry(entry))) and entry.type not in _UNPLACED
    )
    z = np.concatenate([patch.get_path().vertices for patch in ax.patches])[:, 0]
    left, right = np.array([-500.0, 500.0]) * sizes[2] if placed else (z.min(), z.max())
    for patch in ax.patches:
        room = Rectangle((left, low), right - left, high - low, transform=ax.transData)
        patch.set_clip_path(room)
    lines = [((left, right), (r, r)) for r in (low, high)]
    lines += [((end, end), (low, high)) for end in (left, right)] if placed else []
    for line in lines:
        ax.plot(*line, "--", color=GREY, lw=1.0, zorder=6, label="_boundary")
    ax.update_datalim([(left, low - 0.07 * (high - low))])
    if not ax.get_autoscaley_on():  # all of it in a view of given limits
        x, y = np.array(ax.get_xlim()), np.array(ax.get_ylim())
        grow = np.abs(np.array([low, high]) - y.mean()).max() / (0.45 * np.ptp(y))
        for set_limits, ends in ((ax.set_xlim, x), (ax.set_ylim, y)):
            set_limits(ends.mean() + max(1.0, grow) * (ends - ends.mean()))
    letter = "H" if "thrust" in entry.type else "T" if "taper" in entry.type else "B"
    bore, outside, width = (quantity(size, "m") for size in sizes)
    words = f"d = {bore}, {letter} = {width}"
    look = {"ha": "left", "zorder": 7, "bbox": BOX}
    # The names of rows stand above.
    away, side = ((2, 4), "bottom") if rows == 1 else ((3, -4), "top")
    write_beside(ax, (left, high), away, f"D = {outside}", va=side, **look)
    write_beside(ax, (left, low), (2, -4), words, va="top", **look)

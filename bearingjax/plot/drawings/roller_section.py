"""A row of rollers in its axial section."""

from collections.abc import Callable

import numpy as np

from ..style import COLOURS, ELEMENT, RACEWAYS, ROLLER, Axes, towards_white
from .outline import Section


def roller_row(
    ax: Axes,
    parts: Section,
    place: Callable[[np.ndarray], np.ndarray] = np.asarray,
    apart: float = 0.0,
    behind: bool = False,
) -> np.ndarray:
    """Draw one roller and both rings.

    Args:
        ax: Axes.
        parts: Parts of a row of rollers.
        place: Map of points (point, 2), z and r in mm.
        apart: Additional distance of each ring from the roller [mm].
        behind: Whether the roller is one behind another in the same rings, of which
            only the outline is drawn.

    Returns:
        Corners of both rings (point, 2) [mm].
    """
    corners = []
    for k, name in enumerate(RACEWAYS):
        away = (1.0, -1.0)[k] * np.array([-1.0, 1.0]) * parts.generators[k, ::-1]
        ring = place(parts.rings[k] + apart * away)
        corners.append(ring)
        if behind:
            continue
        fill = towards_white(COLOURS[name], 0.88)
        ax.fill(*ring.T, facecolor=fill, edgecolor=COLOURS[name], linewidth=1.2)
    if behind:
        ax.plot(*place(parts.roller).T, "--", color=ROLLER, linewidth=1.0)
        return np.concatenate(corners)
    ax.fill(*place(parts.roller).T, linewidth=1.4, **ELEMENT)
    return np.concatenate(corners)

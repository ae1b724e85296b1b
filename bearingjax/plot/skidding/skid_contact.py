"""Sliding and heat over the contact ellipse of a skidding ball."""

import numpy as np

from ...skid import Ellipse
from ..style import GREY, SMALL, Ax, Axes, axes_or_new, pyplot

_MAP = "viridis"


def sliding_map(ellipse: Ellipse, ax: Ax = None) -> Axes:
    """Map the sliding speed over a contact [mm/s], with its direction as arrows.

    Args:
        ellipse: From `skid.sliding_ellipse`.

    Returns:
        The axes; both directions have scales of their own.
    """
    speed = 1e3 * np.sqrt((ellipse.slip**2).sum(axis=-1))
    ax = _mesh(ellipse, speed, "sliding speed [mm/s]", ax)
    rings, around = slice(4, None, 6), slice(0, -1, 9)
    # Of one length: their colours show the speed. As angles on the page, where the
    # directions have scales of their own, they lean to the one that is drawn longer.
    y, x = (1e3 * ellipse.y[rings, around], 1e6 * ellipse.x[rings, around])
    across, along = ellipse.slip[rings, around, 1], ellipse.slip[rings, around, 0]
    size = np.hypot(across, along)
    size = np.where(size > 0, size, 1.0)
    ax.quiver(
        y,
        x,
        across / size,
        along / size,
        color="white",
        edgecolor=GREY,
        linewidth=0.4,
        width=0.008,
        scale=16.0,
        pivot="middle",
        zorder=3,
    )
    ax.set_title("Sliding of the ball on its raceway")
    return ax


def heat_map(ellipse: Ellipse, ax: Ax = None) -> Axes:
    """Map the heat of the traction over a contact [W/mm²].

    Args:
        ellipse: From `skid.sliding_ellipse`.

    Returns:
        The axes; both directions have scales of their own.
    """
    ax = _mesh(ellipse, 1e-6 * ellipse.heat, "heat [W/mm²]", ax)
    ax.set_title("Heat of the traction")
    return ax


def _mesh(ellipse, values, label, ax):
    ax = axes_or_new(ax, (6.0, 4.0))
    mesh = ax.pcolormesh(
        1e3 * ellipse.y,
        1e6 * ellipse.x,
        values,
        shading="gouraud",
        cmap=pyplot().get_cmap(_MAP),
        vmin=0.0,
        rasterized=True,
    )
    ax.plot(1e3 * ellipse.y[-1], 1e6 * ellipse.x[-1], color=GREY, linewidth=0.8)
    bar = ax.figure.colorbar(mesh, ax=ax)
    bar.set_label(label)
    bar.ax.tick_params(labelsize=SMALL)
    ax.set_xlabel("across the rolling direction [mm]")
    ax.set_ylabel("along it [µm]")
    return ax

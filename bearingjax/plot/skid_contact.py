"""Sliding and heat over the contact ellipse of a skidding ball."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..numerics.types import as_real
from ..skid import Conditions, SkidModel
from .style import GREY, SMALL, axes_or_new, pyplot

if TYPE_CHECKING:
    import matplotlib.axes

_RINGS, _AROUND = 25, 73
_MAP = "viridis"


class Ellipse(NamedTuple):
    """Contact values on a grid of ellipses (ring, around).

    Attributes:
        x: Along the rolling direction [m].
        y: Across [m].
        slip: Of the ball against the raceway, along and across (ring, around, 2)
            [m/s].
        heat: Of the traction [W/m²].
    """

    x: np.ndarray
    y: np.ndarray
    slip: np.ndarray
    heat: np.ndarray


def sliding_ellipse(
    model: SkidModel, found: Any, state: Conditions, at: tuple[int, ...]
) -> Ellipse:
    """Return slip and heat over one contact.

    Args:
        model: The bearing and its oil.
        found: From `skid.steady` or `skid.simulate`.
        state: From `conditions`.
        at: Indices of the contact: place, contact; or time, ball, contact.

    Source: slip (u_x + y w, u_y - x w) with the slip u in the middle and the spin w.
    """
    semi = np.asarray(state.semi_axes)[at]
    radius = np.linspace(0.0, 1.0, _RINGS)[:, None]
    angle = np.linspace(0.0, 2.0 * np.pi, _AROUND)[None, :]
    x, y = semi[0] * radius * np.cos(angle), semi[1] * radius * np.sin(angle)
    (ux, uy), w = np.asarray(found.sliding)[at], np.asarray(found.contact_spin)[at]
    slip = np.stack([ux + y * w, uy - x * w], axis=-1)
    inside = np.sqrt(np.maximum(1.0 - radius**2, 0.0)) + 0.0 * angle
    pressure = as_real(np.asarray(state.peak_pressure)[at] * inside)
    squared = (slip**2).sum(axis=-1)
    resistance = model.traction.resistance(
        as_real(squared),
        as_real(np.asarray(found.film)[at]),
        pressure,
        model.lubricant.viscosity(pressure, model.temperature),
    )
    return Ellipse(x, y, slip, np.asarray(resistance) * squared)


def sliding_map(
    ellipse: Ellipse, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Map the sliding speed over a contact [mm/s], with its direction as arrows.

    Args:
        ellipse: From `sliding_ellipse`.
        ax: Axes; a new figure if `None`.

    Returns:
        The axes; both directions have scales of their own.
    """
    speed = 1e3 * np.sqrt((ellipse.slip**2).sum(axis=-1))
    ax = _mesh(ellipse, speed, "sliding speed [mm/s]", ax)
    rings, around = slice(4, None, 6), slice(0, -1, 9)
    # Of one length: their colours tell the speed. As angles on the page, where the
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


def heat_map(
    ellipse: Ellipse, ax: "matplotlib.axes.Axes | None" = None
) -> "matplotlib.axes.Axes":
    """Map the heat of the traction over a contact [W/mm²].

    Args:
        ellipse: From `sliding_ellipse`.
        ax: Axes; a new figure if `None`.

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

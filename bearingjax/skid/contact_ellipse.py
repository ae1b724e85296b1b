"""Slip and heat over the contact ellipse of a skidding ball."""

from typing import Annotated, Any, NamedTuple

import numpy as np

from ..numerics.types import as_real
from ..numerics.units import unit
from .conditions import Conditions
from .model import SkidModel

_RINGS, _AROUND = 25, 73
"""Ellipses from the centre to the edge, and points on each."""


class Ellipse(NamedTuple):
    """Contact values on a grid of ellipses (ring, around).

    Attributes:
        x: Along the rolling direction [m].
        y: Across [m].
        slip: Slip of the ball against the raceway, along and across (ring, around, 2)
            [m/s].
        heat: Heat of the traction [W/m²].
    """

    x: Annotated[np.ndarray, unit("m")]
    y: Annotated[np.ndarray, unit("m")]
    slip: Annotated[np.ndarray, unit("m/s")]
    heat: Annotated[np.ndarray, unit("W/m²")]


def sliding_ellipse(
    model: SkidModel, found: Any, state: Conditions, at: tuple[int, ...]
) -> Ellipse:
    """Return slip and heat over one contact of a ball.

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

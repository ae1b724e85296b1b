"""Contact width along the rolling direction, and the waves that it averages.

A rolling element follows the mean of a wave over its contact, weighted with the
pressure. With x = k b, of order k/R around a radius R and the half width b, that is

    3 (sin x - x cos x)/x³ ≈ 1 - x²/10   of a ball,   2 J₁(x)/x ≈ 1 - x²/8   of a roller

of the wave. The equations of motion take the height in the middle of the contact
instead, and overstate waves from x = 1 on by 10 % (13 % of rollers) and more, unless
`with_bridged_waves` gives them the mean.

Source: integral of cos over the pressures of Hertz, (1 - s²) per width of an ellipse
    and √(1 - s²) of a line.
"""

import dataclasses
from typing import Any

import jax.numpy as jnp
import numpy as np

from ..contact.line import half_width
from ..contact.point_law import ball_ellipses, balls_of
from ..design import AbstractBallBearing, AbstractRollerBearing, rows_of
from ..design.abstract import nearest_entry
from ..design.material import contact_modulus
from ..numerics.compiled.programs import program
from .dynamics.dynamic_row import of_rows
from .model import NoiseModel
from .static_start import static_start


def with_bridged_waves(model: NoiseModel) -> NoiseModel:
    """Return the model with waves averaged over the width of its contacts.

    Contacts have the width under their mean load in static equilibrium; waves of
    random bearings, which `sampled_model` adds, are averaged too. Spalls are not.

    Returns:
        The model with `half_width`, differentiable.

    Fails: as `static_start`; the width is then NaN or that of no balance.
    """
    return dataclasses.replace(model, half_width=_half_widths(model, model.orbits))


@program(quick=True)
def _half_widths(model, orbits):
    system = model.still_system()
    start, _ = static_start(model, system, orbits)
    bearing = model.element.bearing
    loads = of_rows(system.contact_loads(start, jnp.zeros_like(model.mass)), bearing)
    widths = []
    for row, load in zip(rows_of(bearing), loads, strict=True):
        carried = load > 0.0
        count = jnp.maximum(jnp.sum(carried), 1).astype(load.dtype)
        mean = jnp.sum(jnp.where(carried, load, 0.0)) / count
        # A row that carries nothing has no contacts, and their width no slope.
        some = mean > 0.0
        width = _half_width(row.bearing, jnp.where(some, mean, 1.0))
        widths.append(jnp.where(some, width, 0.0))
    return jnp.stack(widths)


def contact_half_width(bearing: Any, load: np.ndarray) -> float:
    """Return the half width along the rolling direction under the mean load [m].

    Args:
        bearing: A single row.
        load: Load of its contacts; those that carry count (..., contact) [N].

    Returns:
        That of the raceway where it is larger; 0 where nothing carries.
    """
    carried = load[load > 0.0]
    if carried.size == 0:
        return 0.0
    return float(_half_width(bearing, carried.mean()))


@program(quick=True)
def _half_width(bearing, load):
    return nearest_entry(_HALF_WIDTHS, bearing)(bearing, load)


def _of_balls(bearing, load):
    cosine = jnp.atleast_1d(bearing.free_cosine)
    ellipses = ball_ellipses(balls_of(bearing), bearing.grooves, cosine)
    return jnp.max(ellipses.semi_axes(load)[0])


def _of_rollers(bearing, load):
    modulus = contact_modulus(bearing.material, bearing.rings)
    ratio = bearing.roller_diameter * jnp.cos(bearing.axis_angle)
    # The outer raceway is the flatter one.
    relative = 0.5 * bearing.roller_diameter * (1.0 + ratio / bearing.pitch_diameter)
    return half_width(load / bearing.roller_length, relative, modulus)


_HALF_WIDTHS = {AbstractBallBearing: _of_balls, AbstractRollerBearing: _of_rollers}

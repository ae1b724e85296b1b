"""Inertia of an orbiting roller at given ring speeds."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import number
from ..design.profile import sagitta
from ..numerics.shown import Printable
from ..numerics.types import Real, Scalar
from ..numerics.units import real
from .constants import ContactConstants
from .frame import orbit, roll_ratio, rotation

_NODES = 16
"""Nodes of the volume integrals of a barrel: exact to round-off for a flat arc."""


class Speed(Printable):
    """Speeds of the rings about the bearing axis, positive from x towards y.

    Attributes:
        inner: Speed of the inner ring [rad/s].
        outer: Speed of the outer ring [rad/s].

    Traced: all fields.
    """

    inner: Real = eqx.field(**real("rad/s"), default=0.0)
    outer: Real = eqx.field(**real("rad/s"), default=0.0)

    def __check_init__(self):
        number(self, "inner")
        number(self, "outer")


def roller_speeds(constants: ContactConstants, speed: Speed) -> tuple[Scalar, Scalar]:
    """Orbital speed of the rollers and their spin relative to the cage frame.

    Args:
        constants: From `contact_constants`.
        speed: Ring speeds.

    Returns:
        Orbital speed [rad/s], spin about the roller's own axis [rad/s] (opposite in
        sense to the inner ring).

    Source: rolling without slip at both raceways; Harris, Rolling Bearing Analysis.
    """
    c = constants
    pitch_diameter, rings = 2.0 * c.pitch_radius, (speed.outer, speed.inner)
    ratio = roll_ratio(c.diameter, pitch_diameter, jnp.cos(c.axis_angle))
    spin = rotation(ratio, c.diameter, pitch_diameter, *rings)
    return orbit(ratio, *rings), spin


def mass_and_inertia(constants: ContactConstants) -> tuple[Scalar, Scalar, Scalar]:
    """Mass of a roller and its moments of inertia, crown and end relief neglected.

    Args:
        constants: From `contact_constants`.

    Returns:
        Mass [kg], moment about its axis and about a cross axis through the roller
        centre [kg m²], of a cone frustum (cylinder for a half angle of zero), less
        what the arc of a barrel lacks of it.
    """
    c = constants
    if c.arc_radii is not None:
        return _of_barrel(c)
    height = 2.0 * c.half_length * jnp.cos(c.half_angle)
    r2 = (0.5 * c.diameter) ** 2
    g2 = (jnp.tan(c.half_angle) * height) ** 2
    # Integrals over the axis of r², r⁴ and r² z² with r = D/2 - z tan(half angle).
    second = height * (r2 + g2 / 12.0)
    fourth = height * (r2**2 + 0.5 * r2 * g2 + g2**2 / 80.0)
    spread = height**3 * (r2 / 12.0 + g2 / 80.0)
    factor = jnp.pi * c.density
    return factor * second, 0.5 * factor * fourth, factor * (0.25 * fourth + spread)


def _of_barrel(c):
    """As `mass_and_inertia`: integrals of r², r⁴ and r² z² along the generator."""
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    s = c.half_length * jnp.asarray(node, c.diameter.dtype)
    drop = sagitta(s, c.arc_radii[0])
    sin, cos = jnp.sin(c.half_angle), jnp.cos(c.half_angle)
    r2 = (0.5 * c.diameter - s * sin - drop * cos) ** 2
    z = s * cos - drop * sin
    # Widths dz of the discs: the slope of the drop is s over the arc's height.
    slope = s / (c.arc_radii[0] - drop)
    width = c.half_length * jnp.asarray(weight, s.dtype) * (cos - slope * sin)
    factor = jnp.pi * c.density * width
    axial = jnp.sum(factor * 0.5 * r2**2)
    cross = jnp.sum(factor * (0.25 * r2**2 + r2 * z**2))
    return jnp.sum(factor * r2), axial, cross


def inertia_force(constants: ContactConstants, speed: Speed) -> Float[Array, "3"]:
    """Inertia force and gyroscopic moment on a roller, in roller axes.

    Centrifugal force m R_m ω_c² through the roller centre, outwards, and the
    gyroscopic moment -ω_c sin β [Ia ω_s + (Ia - It) ω_c cos β], β = -axis angle. Both
    are constant, so they have the potential -F·y.

    Args:
        constants: From `contact_constants`.
        speed: Ring speeds.

    Returns:
        Force along t and m [N] and moment turning z towards r [N m].

    Source: angular momentum H = Ia (ω_c cos β + ω_s) t + It ω_c (e_z - cos β t),
        F = -dH/dt; the mass centre is taken at the roller centre.
    """
    c = constants
    around, spin = roller_speeds(c, speed)
    mass, axial, cross = mass_and_inertia(c)
    sin, cos = jnp.sin(c.axis_angle), jnp.cos(c.axis_angle)
    force = mass * c.pitch_radius * around**2
    moment = around * sin * (axial * spin + (axial - cross) * around * cos)
    return jnp.stack([-sin * force, cos * force, moment])

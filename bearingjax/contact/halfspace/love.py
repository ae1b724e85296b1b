"""Displacement of a half-space under uniform pressure on a rectangle.

A pressure p on a rectangle moves the surface of a half-space by p/(π E*)·∫∫ dA/r. Here
stands the integral, written with inverse hyperbolic sines: the published logarithms of
quotients cancel where a point lies far from the rectangle.

Source: A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929); Johnson, Contact Mechanics
    (1985), eq. (3.25). `strip` is its mean over a second cell, integrated here.
"""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jax.core import Tracer

from ...numerics.types import Reals


def love(x: Reals, y: Reals, a: Reals, b: Reals) -> Reals:
    """∫∫ dA/r over a rectangle of half sides a, b, from a point of its plane [m].

    Args:
        x, y: Point, from the middle of the rectangle [m].
        a, b: Half sides along x and y [m].

    Returns:
        4ab/r far away; times p/(π E*) the displacement into the half-space.
    """
    g = corner
    return g(x + a, y + b) - g(x + a, y - b) - g(x - a, y + b) + g(x - a, y - b)


def corner(u: Any, v: Any, xp: Any = jnp) -> Any:
    """∫₀ᵘ∫₀ᵛ dA/r [m], odd in u and in v.

    Args:
        u, v: Sides of a rectangle with a corner in the point [m].
        xp: `jax.numpy`, or `numpy` for numbers that nothing traces.
    """
    return u * _asinh_ratio(v, u, xp) + v * _asinh_ratio(u, v, xp)


def strip(u: Any, v: Any, xp: Any = jnp) -> Any:
    """∫₀ᵛ `corner`(u, v') dv' [m²] up to what does not depend on v; even in v.

    Its second differences over the ends of two cells give the influence of one cell on
    the mean over the other.

    Args:
        u, v, xp: As in `corner`; u is not zero.
    """
    r = xp.sqrt(u * u + v * v)
    first = u * v * _asinh_ratio(v, u, xp) + 0.5 * v * v * _asinh_ratio(u, v, xp)
    return first - 0.5 * u * r


def _asinh_ratio(v, u, xp):
    """asinh(v/|u|), zero where u is: the factor before it is zero there."""
    none = u == 0
    return xp.where(none, 0.0, xp.arcsinh(v / xp.abs(xp.where(none, 1.0, u))))


def namespace(*values: Any) -> Any:
    """NumPy where no value is traced, so that tables are made in double precision.

    The differences lose digits that single precision does not have.
    """
    return jnp if any(isinstance(v, Tracer) for v in values) else np

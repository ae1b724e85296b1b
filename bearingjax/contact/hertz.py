"""Hertz point contact of a sphere on a flat: the roller end on a rib."""

import jax.numpy as jnp
from jaxtyping import Array, Float

EXPONENT = (3, 2)
"""Load ∝ approach^(3/2), as a fraction."""


def sphere_constant(
    radius: Float[Array, "..."], modulus: Float[Array, "..."]
) -> Float[Array, "..."]:
    """Constant c of Q = c·approach^(3/2) of a sphere on a plane, (4/3) E* sqrt(R).

    Args:
        radius: Radius of the sphere [m].
        modulus: Contact modulus E* [Pa].

    Returns:
        c [N/m^(3/2)].

    Source: Hertz (1882); Johnson, Contact Mechanics, eq. (4.23).
    """
    return 4.0 / 3.0 * modulus * jnp.sqrt(radius)


def sphere_peak_pressure(
    load: Float[Array, "..."],
    radius: Float[Array, "..."],
    modulus: Float[Array, "..."],
) -> Float[Array, "..."]:
    """Largest pressure of a sphere on a plane, (6 Q E*²/(π³ R²))^(1/3).

    Args:
        load: Load Q ≥ 0 [N].
        radius: Radius of the sphere [m].
        modulus: Contact modulus E* [Pa].

    Returns:
        Pressure [Pa].

    Source: Hertz (1882); Johnson, Contact Mechanics, eq. (4.24).
    """
    return jnp.cbrt(6.0 * load * modulus**2 / (jnp.pi**3 * radius**2))

"""Elliptic Hertz contacts."""

import jax.numpy as jnp
import numpy as np

from ....contact.hertz import ellipse

_MODULUS = 113.2e9
"""Contact modulus; the numbers do not depend on it [Pa]."""


def hertz_factors(curvature_difference: np.ndarray) -> dict[str, np.ndarray]:
    """Return the factors of semi-axes and approach, and the ellipticity.

    Args:
        curvature_difference: Difference over sum of the curvatures, F(ρ) (n,) [1].
    """
    difference = jnp.asarray(curvature_difference)
    total = 120.0
    contact = ellipse(
        0.5 * total * (1.0 + difference),
        0.5 * total * (1.0 - difference),
        jnp.asarray(_MODULUS),
    )
    load = jnp.asarray(2.0 / 3.0 * _MODULUS * total * 1e-9)  # 3Q/(2 E* Σρ) = 1 mm³
    short, long = (np.asarray(axis) / 1e-3 for axis in contact.semi_axes(load))
    approach = np.asarray(contact.approach(load)) / (0.5e-6 * total)
    return {"a": long, "b": short, "approach": approach, "ratio": long / short}

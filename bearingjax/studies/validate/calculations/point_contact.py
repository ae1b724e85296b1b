"""Elliptic Hertz contacts."""

import jax.numpy as jnp
import numpy as np

from ....contact.hertz import Ellipse, ellipse
from ....design import Material, contact_modulus
from ....numerics.elliptic import complete

_MODULUS = 113.2e9
"""Contact modulus; the numbers do not depend on it [Pa]."""


def hertz_factors(curvature_difference: np.ndarray) -> dict[str, np.ndarray]:
    """Return the factors of semi-axes and approach, the ellipticity and the complete
    elliptic integrals.

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
    found = {"a": long, "b": short, "approach": approach, "ratio": long / short}
    return found | _integrals(contact)


def ellipticity(radius_ratio: np.ndarray) -> dict[str, np.ndarray]:
    """Return ellipticity and complete elliptic integrals of a point contact.

    Args:
        radius_ratio: Relative radius across over that in rolling direction (n,) [1].
    """
    contact = ellipse(jnp.asarray(radius_ratio), jnp.asarray(1.0), jnp.asarray(1.0))
    return {"ratio": np.asarray(1.0 / contact.ratio)} | _integrals(contact)


def _integrals(contact):
    first, b, d = complete(contact.ratio)
    second = b + contact.ratio**2 * d
    return {"first": np.asarray(first), "second": np.asarray(second)}


def raceway_contacts(
    diameter: float,
    pitch_diameter: float,
    contact_angle: np.ndarray,
    raceway_radii: np.ndarray,
    load: np.ndarray,
    elastic_modulus: float,
    poisson_ratio: float,
    profile_radius: float = 0.0,
) -> dict[str, np.ndarray]:
    """Return the Hertz contacts of a ball or barrel with outer and inner raceway.

    Args:
        diameter, pitch_diameter: Of the rolling element, of the bearing [m].
        contact_angle, raceway_radii: Of outer and inner raceway (2,) [rad, m].
        load: Loads (2,) or (n, 2) [N].
        elastic_modulus, poisson_ratio: Of both bodies [Pa, 1].
        profile_radius: Radius of a barrel's profile; 0: a ball [m].
    """
    turn = np.array([1.0, -1.0]) * diameter / pitch_diameter * np.cos(contact_angle)
    rolling = 2.0 / (diameter * (1.0 + turn))
    across = 1.0 / (profile_radius or 0.5 * diameter) - 1.0 / raceway_radii
    steel = Material(elastic_modulus, poisson_ratio)
    contact = ellipse(
        jnp.asarray(rolling), jnp.asarray(across), contact_modulus(steel, steel)
    )
    series = float(jnp.sum(contact.constant ** (-2 / 3)) ** (-3 / 2))
    loads = jnp.asarray(load)
    each = Ellipse(*(jnp.broadcast_to(one, loads.shape) for one in contact))
    short, long = each.semi_axes(loads)
    found = {
        "curvature_sum": rolling + across,
        "curvature_difference": (rolling - across) / (rolling + across),
        "constant": contact.constant,
        "series": series,
        "across": long,
        "along": short,
        "approach": each.approach(loads),
        "pressure": each.peak_pressure(loads),
    }
    return {name: np.asarray(value) for name, value in found.items()}

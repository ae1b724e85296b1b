"""Azimuths of the rolling elements of a row, and their orbit."""

from jaxtyping import Array, Float

from ..design import AbstractBearing
from ..design.deviation import deviation_of
from ..numerics.types import Ring, Scalar
from .frame import FREEDOMS, even_azimuths, orbit, roll_ratio
from .rolling_element import split_rings

_GZ = FREEDOMS.index("gz")

Azimuth = Float[Array, " element"]
"""Azimuth of every rolling element of a row [rad]."""


def azimuths(bearing: AbstractBearing, q: Ring | None = None) -> Azimuth:
    """Azimuth of every rolling element of a single row [rad].

    Args:
        bearing: The design.
        q: Ring freedoms, of which both gz turn the elements [m, rad]; `None`: none.
    """
    deviation = deviation_of(bearing).azimuth
    count, places = bearing.n_elements, bearing.n_places
    found = even_azimuths(bearing.first_azimuth, count, places)
    if deviation is not None:
        found = found + deviation
    return found if q is None else found + turn(orbit_ratio(bearing), q)


def turn(ratio: Scalar, q: Ring) -> Scalar:
    """Orbit angle of the elements, rolling without slip [rad].

    Args:
        ratio: `orbit_ratio` of their row [1].
        q: Ring freedoms [m, rad]; only both gz count.
    """
    outer, inner = split_rings(q)
    return orbit(ratio, outer[_GZ], inner[_GZ])


def orbit_ratio(bearing: AbstractBearing) -> Scalar:
    """G = D cos α/d_m of a row, with which its rolling elements orbit [1]."""
    size, pitch = bearing.element_diameter, bearing.pitch_diameter
    return roll_ratio(size, pitch, bearing.free_cosine)

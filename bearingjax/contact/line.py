"""Line contact of a roller on a raceway: load law, half width, pressure."""

import abc
from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp

from ..design.checks import positive
from ..design.material import Material, contact_modulus
from ..numerics.types import Real, Reals, Scalar
from ..numerics.units import real

LINE_EXPONENT = (10, 9)
"""Line load ∝ approach^(10/9), as a fraction."""


class AbstractLineLaw(eqx.Module):
    """Line load law of slices: C of q = C·approach^(10/9), per raceway contact."""

    @abc.abstractmethod
    def constant(self, roller: Material, ring: Material, length: Scalar) -> Scalar:
        """Line constant of one contact.

        Args:
            roller: Material of the roller.
            ring: Material of the ring.
            length: Total contact length, which enters as length^(-1/9) [m].

        Returns:
            C [N/m^(19/9)].
        """

    def contact(self, line: Any, radius: Callable, modulus: Scalar) -> Any:
        """Return the contact under this law, here in independent slices.

        Args:
            line: The `LineContact` with `constant`.
            radius: Radius of relative curvature [m] at positions s [m].
            modulus: Contact modulus E* [Pa].
        """
        return line


class Palmgren(AbstractLineLaw):
    """Palmgren's law for one contact, in its consistent-unit form.

    delta = 3.81 [(1-ν1²)/(π E1) + (1-ν2²)/(π E2)]^0.9 Q^0.9 / l^0.8, any consistent
    units; for steel this is the familiar 3.84e-5 Q^0.9/l^0.8 (mm, N) to 0.2 %.

    Source: Palmgren (1959), in the general form of Harris and Kotzalas, Rolling
        Bearing Analysis.
    """

    def constant(self, roller: Material, ring: Material, length: Scalar) -> Scalar:
        compliance = _compliance(roller, ring)
        return (3.81 * compliance**0.9) ** (-10.0 / 9.0) * length ** (-1.0 / 9.0)


class ISO16281(AbstractLineLaw):
    """ISO/TS 16281: 35948 l^(8/9) N/mm^(10/9) for both contacts of a steel roller.

    Two equal contacts in series: each is 2^(10/9) stiffer than the sum. Other
    materials are scaled by Palmgren's material term relative to steel of 206 GPa,
    0.3 (the standard knows steel only).

    Source: ISO/TS 16281:2008, spring constant of the lamina.
    """

    def constant(self, roller: Material, ring: Material, length: Scalar) -> Scalar:
        steel = Material()
        ratio = _compliance(steel, steel) / _compliance(roller, ring)
        per_contact = 35948.0 * 2.0 ** (10.0 / 9.0)
        # N/mm^(19/9) with the length in mm.
        constant = per_contact * (1e3 * length) ** (-1.0 / 9.0)
        return 1e3 ** (19.0 / 9.0) * ratio * constant


class LineConstant(AbstractLineLaw):
    """Given constant per raceway contact, for any materials.

    Attributes:
        value: C [N/m^(19/9)].

    Traced: all fields.
    """

    value: Real = eqx.field(**real("N/m^(19/9)"))

    def __check_init__(self):
        positive(self, "value")

    def constant(self, roller: Material, ring: Material, length: Scalar) -> Scalar:
        return self.value


def _compliance(roller, ring):
    """(1-ν1²)/(π E1) + (1-ν2²)/(π E2) [1/Pa]."""
    return 1.0 / (jnp.pi * contact_modulus(roller, ring))


def relative_radius(roller_radius: Reals, raceway_radius: Reals) -> Reals:
    """Radius of relative curvature 1/(1/r ± 1/R) of a line contact.

    Args:
        roller_radius: Radius of the roller normal to the contact line [m].
        raceway_radius: Radius of the raceway, positive where the raceway is convex
            (inner ring), negative where it is concave (outer ring) [m].

    Returns:
        Relative radius [m].
    """
    return 1.0 / (1.0 / roller_radius + 1.0 / raceway_radius)


def half_width(line_load: Reals, radius: Reals, modulus: Reals) -> Reals:
    """Half width of a line contact, sqrt(4 q ρ/(π E*)).

    Args:
        line_load: Load per length q ≥ 0 [N/m].
        radius: Relative radius ρ [m].
        modulus: Contact modulus E* [Pa].

    Returns:
        Half width [m].

    Source: Hertz (1882); Johnson, Contact Mechanics, eq. (4.43).
    """
    return _safe_sqrt(4.0 * line_load * radius / (jnp.pi * modulus))


def peak_pressure(line_load: Reals, radius: Reals, modulus: Reals) -> Reals:
    """Largest pressure of a line contact, sqrt(q E*/(π ρ)).

    Args:
        line_load: Load per length q ≥ 0 [N/m].
        radius: Relative radius ρ [m].
        modulus: Contact modulus E* [Pa].

    Returns:
        Pressure [Pa].

    Source: Hertz (1882); Johnson, Contact Mechanics, eq. (4.45).
    """
    return _safe_sqrt(line_load * modulus / (jnp.pi * radius))


def _safe_sqrt(x):
    """sqrt with derivative zero where x ≤ 0; NaN passes through."""
    closed = x <= 0
    return jnp.where(closed, 0.0, jnp.sqrt(jnp.where(closed, 1.0, x)))

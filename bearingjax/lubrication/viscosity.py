"""Viscosity over temperature and over pressure.

A law gives the natural logarithm of the viscosity, because the viscosity itself grows
by a factor of a million in a contact.
"""

import abc
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array

from ..design.checks import check, check_fields, floats, number, positive
from ..numerics.types import Number, Real, Reals, Scalar, as_real, in_numpy
from ..numerics.units import real
from .coefficient import AbstractCoefficient, as_coefficient
from .viscosity_index import viscosity_at_100


def level_off(x: Array, at: Any, width: Any) -> Array:
    """x up to `at`, from there smoothly (twice) to at most `at` + `width`."""
    over = jnp.maximum(x - at, 0.0)
    return jnp.where(x > at, at + width * jnp.tanh(over / width), x)


class AbstractAmbient(eqx.Module):
    """Viscosity at atmospheric pressure, over temperature."""

    @abc.abstractmethod
    def log_viscosity(self, temperature: Scalar, density: Scalar) -> Scalar:
        """ln of the dynamic viscosity in Pa s.

        Args:
            temperature: Temperature [K].
            density: Density at this temperature [kg/m³].
        """


class AbstractPressureLaw(eqx.Module):
    """Law of the increase of viscosity with pressure."""

    @abc.abstractmethod
    def log_ratio(
        self, pressure: Reals, temperature: Scalar, ambient: Scalar, density: Scalar
    ) -> Reals:
        """ln of the viscosity over that at atmospheric pressure [1].

        Args:
            pressure: Pressure, at least 0 [Pa].
            temperature: Temperature [K].
            ambient: ln of the dynamic viscosity at atmospheric pressure in Pa s.
            density: Density at this temperature [kg/m³].
        """


class Walther(AbstractAmbient):
    """Kinematic viscosity through two points: ln ln(ν + 0.7 mm²/s) is linear in ln T.

    Valid: viscosities above 2 mm²/s; at 1 mm²/s the full standard gives 3 % less.

    Attributes:
        cold: Lower temperature [K].
        cold_viscosity: Kinematic viscosity there [m²/s].
        hot: Higher temperature [K].
        hot_viscosity: Kinematic viscosity there, below the other one [m²/s].

    Traced: all fields.
    Source: Walther (1931); ASTM D341 without its terms for thin liquids.
    """

    cold: Real = eqx.field(**real("K", "lower temperature"))
    cold_viscosity: Real = eqx.field(
        **real("m²/s", "kinematic viscosity there", above=0.3e-6)
    )
    hot: Real = eqx.field(**real("K", "higher temperature"))
    hot_viscosity: Real = eqx.field(
        **real("m²/s", "kinematic viscosity there, below the other one", above=0.3e-6)
    )

    def __check_init__(self):
        for name in ("cold", "hot"):
            positive(self, name)
        check_fields(self)
        if known := floats(self.cold, self.hot):
            low, high = known
            check(self, "hot", high > low, f"above `cold`, {low:.6g} K")
        if known := floats(self.cold_viscosity, self.hot_viscosity):
            most, least = known
            words = f"below `cold_viscosity`, {most:.6g} m²/s"
            check(self, "hot_viscosity", least < most, words)

    @classmethod
    def from_grade(cls, grade: Number, viscosity_index: Number = 95.0) -> "Walther":
        """An oil of an ISO viscosity grade.

        Args:
            grade: ISO VG: kinematic viscosity at 40 °C in mm²/s.
            viscosity_index: Viscosity index, 0 to 400 [1].

        Source: ISO 3448; viscosity at 100 °C by ASTM D2270.
        """
        positive(cls, "grade", grade, "mm²/s")
        cold = 1e-6 * in_numpy(as_real(grade))
        hot = viscosity_at_100(cold, viscosity_index)
        return cls(313.15, cold, 373.15, hot)

    def log_viscosity(self, temperature: Scalar, density: Scalar) -> Scalar:
        def log_log(viscosity):
            return jnp.log(jnp.log(1e6 * viscosity + 0.7))

        start, end = log_log(self.cold_viscosity), log_log(self.hot_viscosity)
        along = jnp.log(temperature / self.cold) / jnp.log(self.hot / self.cold)
        kinematic = jnp.exp(jnp.exp(start + (end - start) * along)) - 0.7
        return jnp.log(1e-6 * kinematic * density)


class Exponential(AbstractAmbient):
    """μ = reference·exp(first·D + second·D²), D = 1/T - 1/T_R.

    Attributes:
        reference_viscosity: Dynamic viscosity at T_R [Pa s].
        reference_temperature: T_R [K].
        first: Factor of D = 1/T - 1/T_R [K].
        second: Factor of D² [K²].

    Traced: all fields.
    Source: the form of the ADORE programs (Gupta).
    """

    reference_viscosity: Real = eqx.field(
        **real("Pa s", "dynamic viscosity at T_R", above=0)
    )
    reference_temperature: Real = eqx.field(
        **real("K", "temperature of the reference, T_R")
    )
    first: Real = eqx.field(**real("K", "factor of D = 1/T - 1/T_R"))
    second: Real = eqx.field(**real("K²", "factor of D²"))

    def __check_init__(self):
        check_fields(self)
        positive(self, "reference_temperature")
        number(self, "first")
        number(self, "second")

    def log_viscosity(self, temperature: Scalar, density: Scalar) -> Scalar:
        d = 1.0 / temperature - 1.0 / self.reference_temperature
        return jnp.log(self.reference_viscosity) + d * (self.first + d * self.second)


class Barus(AbstractPressureLaw):
    """μ = μ₀·exp(α p).

    Far too stiff above some 0.5 GPa. A coefficient of zero: viscosity without pressure.

    Attributes:
        coefficient: α, or a plain number [1/Pa].

    Source: Barus (1893).
    """

    coefficient: AbstractCoefficient = eqx.field(converter=as_coefficient)

    def log_ratio(
        self, pressure: Reals, temperature: Scalar, ambient: Scalar, density: Scalar
    ) -> Reals:
        return self.coefficient.value(ambient, density) * pressure


class Roelands(AbstractPressureLaw):
    """μ = μ₀·exp{(ln μ₀ + 9.67)·[(1 + 5.1e-9 p)^Z - 1]}, slope α at p = 0.

    Attributes:
        coefficient: α, or a plain number [1/Pa]; Z = α/[5.1e-9 (ln μ₀ + 9.67)].

    Valid: viscosities at atmospheric pressure above 0.063 mPa s.
    Source: Roelands (1966), in the form of Hamrock.
    """

    coefficient: AbstractCoefficient = eqx.field(converter=as_coefficient)

    def log_ratio(
        self, pressure: Reals, temperature: Scalar, ambient: Scalar, density: Scalar
    ) -> Reals:
        depth = ambient + 9.67
        z = self.coefficient.value(ambient, density) / (5.1e-9 * depth)
        return depth * jnp.expm1(z * jnp.log1p(5.1e-9 * pressure))


class FreeVolume(AbstractAmbient, AbstractPressureLaw):
    """Doolittle's free volume with Tait's equation of state, over both T and p.

    μ = μ_R exp{B R0 [(Vi/ViR)/(V/VR - R0 Vi/ViR) - 1/(1 - R0)]}. The free volume is
    kept from vanishing; where that begins the oil has long been a glass.

    Attributes:
        reference_viscosity: μ_R [Pa s].
        B: Doolittle's parameter [1].
        R0: Occupied volume over the whole one at the reference, above 0, below 1 [1].
        epsilon: Growth of the occupied volume with temperature [1/K].
        a_V: Growth of the volume with temperature [1/K].
        K0_prime: Growth of the bulk modulus with pressure, K0' [1].
        K00: Bulk modulus at p = 0, extrapolated to 0 K [Pa].
        beta_K: Its decay with temperature: K0 = K00 exp(-β_K T) [1/K].
        reference_temperature: T_R [K].

    Traced: all fields.
    Source: Doolittle (1951); Bair & Kottke, Tribology Transactions 46 (2003) 289-295,
        in Bair's notation.
    """

    reference_viscosity: Real = eqx.field(
        **real("Pa s", "viscosity at the reference, μ_R", above=0)
    )
    B: Real = eqx.field(**real("1", "Doolittle's parameter", above=0))
    R0: Real = eqx.field(
        **real(
            "1", "occupied volume over the whole one at the reference", above=0, below=1
        )
    )
    epsilon: Real = eqx.field(
        **real("1/K", "growth of the occupied volume with temperature")
    )
    a_V: Real = eqx.field(**real("1/K", "growth of the volume with temperature"))
    K0_prime: Real = eqx.field(
        **real("1", "growth of the bulk modulus with pressure, K0'", above=-1)
    )
    K00: Real = eqx.field(
        **real("Pa", "bulk modulus at p = 0, extrapolated to 0 K", above=0)
    )
    beta_K: Real = eqx.field(
        **real("1/K", "its decay with temperature: K0 = K00 exp(-β_K T)")
    )
    reference_temperature: Real = eqx.field(
        **real("K", "temperature of the reference, T_R")
    )

    def __check_init__(self):
        check_fields(self)
        positive(self, "reference_temperature")
        for name in ("epsilon", "a_V", "beta_K"):
            number(self, name)

    def log_viscosity(self, temperature: Scalar, density: Scalar) -> Scalar:
        zero = jnp.zeros_like(temperature)
        return jnp.log(self.reference_viscosity) + self._exponent(zero, temperature)

    def log_ratio(
        self, pressure: Reals, temperature: Scalar, ambient: Scalar, density: Scalar
    ) -> Reals:
        zero = jnp.zeros_like(temperature)
        return self._exponent(pressure, temperature) - self._exponent(zero, temperature)

    def _exponent(self, pressure, temperature):
        warmer = temperature - self.reference_temperature
        occupied = self.R0 * (1.0 + self.epsilon * warmer)
        modulus = self.K00 * jnp.exp(-self.beta_K * temperature)
        stiffer = 1.0 + self.K0_prime
        squeezed = 1.0 - jnp.log1p(stiffer * pressure / modulus) / stiffer
        free = (1.0 + self.a_V * warmer) * squeezed - occupied
        # The first term may reach 40, in the end 80.
        least = self.B * occupied / 40.0
        free = -level_off(-free, -least, 0.5 * least)
        return self.B * (occupied / free - self.R0 / (1.0 - self.R0))

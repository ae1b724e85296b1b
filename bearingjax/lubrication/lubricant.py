"""A lubricant: viscosity, density and what follows from them."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool

from ..design.checks import instance, is_traced, non_negative, positive
from ..numerics.compiled.programs import program
from ..numerics.shown import Printable
from ..numerics.types import Number, Real, Reals, Scalar, as_real
from ..numerics.units import real
from .coefficient import AbstractCoefficient, as_coefficient
from .viscosity import AbstractAmbient, AbstractPressureLaw, level_off

GLASS = float(np.log(1e12))
"""ln of the viscosity in Pa s at which a liquid counts as a glass."""

# ln of the factor by which a viscosity may go beyond that of a glass.
_BEYOND = 10.0

_NODES = 64


class Density(eqx.Module):
    """Density at atmospheric pressure, falling evenly with temperature.

    Attributes:
        value: Density at the reference [kg/m³].
        slope: Loss per kelvin [kg/(m³ K)].
        reference_temperature: Temperature of the reference [K].

    Traced: all fields.
    """

    value: Real = eqx.field(**real("kg/m³"))
    slope: Real = eqx.field(**real("kg/(m³ K)"), default=0.64)
    reference_temperature: Real = eqx.field(**real("K"), default=288.15)

    def __check_init__(self):
        positive(self, "value")
        non_negative(self, "slope")
        positive(self, "reference_temperature")

    def at(self, temperature: Number) -> Scalar:
        """Density [kg/m³] at a temperature [K]."""
        warmer = as_real(temperature) - self.reference_temperature
        return self.value - self.slope * warmer


class Lubricant(Printable):
    """An oil: viscosity over temperature and pressure, density.

    Temperatures are in K, pressures in Pa above atmosphere. All values are finite from
    -40 to 200 °C and up to 4 GPa: beyond 1e12 Pa s, where liquids are glasses, the
    viscosity levels off at 2e16 Pa s, and `outside_fluid_range` says so.

    Attributes:
        ambient: Viscosity at atmospheric pressure, over temperature.
        pressure: Law of its increase with pressure.
        density: Density over temperature.
        coefficient: Pressure-viscosity coefficient for films, or a plain number [1/Pa];
            `None`: α* of the pressure law, `isoviscous_coefficient`, on which films
            depend, not its slope at p = 0.
        thermal_conductivity: Thermal conductivity [W/(m K)].

    Traced: all numbers. Static: the classes.
    """

    ambient: AbstractAmbient
    pressure: AbstractPressureLaw
    density: Density
    coefficient: AbstractCoefficient | None = eqx.field(
        converter=as_coefficient, default=None
    )
    thermal_conductivity: Real = eqx.field(**real("W/(m K)"), default=0.14)

    def __check_init__(self):
        instance(self, "ambient", AbstractAmbient)
        instance(self, "pressure", AbstractPressureLaw)
        instance(self, "density", Density)
        positive(self, "thermal_conductivity")

    def viscosity(self, pressure: Reals | float, temperature: Number) -> Reals:
        """Dynamic viscosity [Pa s].

        Args:
            pressure: Pressure, at least 0 [Pa].
            temperature: Temperature [K].
        """
        return jnp.exp(
            level_off(self._log_viscosity(pressure, temperature), GLASS, _BEYOND)
        )

    def outside_fluid_range(
        self, pressure: Reals | float, temperature: Number
    ) -> Bool[Array, "..."]:
        """Whether the law gives a glass; arguments as in `viscosity`."""
        return ~(self._log_viscosity(pressure, temperature) <= GLASS)

    def kinematic_viscosity(self, temperature: Number) -> Scalar:
        """Kinematic viscosity at atmospheric pressure [m²/s], temperature in K."""
        return _kinematic_viscosity(self, _kelvin(temperature))

    def pressure_coefficient(self, temperature: Number) -> Scalar:
        """Pressure-viscosity coefficient of films [1/Pa], temperature in K."""
        if self.coefficient is None:
            return self.isoviscous_coefficient(temperature)
        kelvin = _kelvin(temperature)
        density = self.density.at(kelvin)
        ambient = self.ambient.log_viscosity(kelvin, density)
        return self.coefficient.value(ambient, density)

    def isoviscous_coefficient(self, temperature: Number) -> Scalar:
        """Reciprocal asymptotic isoviscous pressure α* = 1/∫ μ(0)/μ(p) dp [1/Pa].

        It is below the slope d ln μ/dp at p = 0 where that falls with pressure, and α
        of Barus' law; zero of a viscosity that does not grow.

        Args:
            temperature: Temperature [K].

        Source: Blok (1963); 64 nodes of Gauss and Legendre in p/(p + 1/α).
        """
        kelvin = _kelvin(temperature)
        node, weight = np.polynomial.legendre.leggauss(_NODES)
        share = 0.5 * (1.0 + node)
        far = jnp.asarray(share / (1.0 - share), kelvin.dtype)
        weight = jnp.asarray(0.5 * weight / (1.0 - share) ** 2, kelvin.dtype)
        slope = self._slope(kelvin)
        # Without growth the integral is infinite; near it α* is the slope.
        grows = slope > 0
        scale = jnp.where(grows, slope, 1e-9)
        thicker = self.viscosity(far / scale, kelvin)
        star = scale / jnp.dot(weight, self._ambient_viscosity(kelvin) / thicker)
        return jnp.where(grows, star, slope)

    def thermal_loading(self, temperature: Number, speed: Number) -> Scalar:
        """Thermal loading parameter L = β μ₀ u²/k of the inlet [1].

        β is the relative loss of viscosity per kelvin.

        Args:
            temperature: Temperature at the inlet [K].
            speed: Entrainment speed u [m/s].
        """
        kelvin, speed = _kelvin(temperature), as_real(speed)
        _, slope = jax.jvp(self._ambient_viscosity, (kelvin,), (jnp.ones_like(kelvin),))
        return -slope * speed * speed / self.thermal_conductivity

    def _ambient_viscosity(self, kelvin):
        """Viscosity at atmospheric pressure [Pa s]."""
        return self.viscosity(jnp.zeros_like(kelvin), kelvin)

    def _log_viscosity(self, pressure, temperature):
        pressure, temperature = as_real(pressure), _kelvin(temperature)
        density = self.density.at(temperature)
        ambient = self.ambient.log_viscosity(temperature, density)
        ratio = self.pressure.log_ratio(pressure, temperature, ambient, density)
        return ambient + ratio

    def _slope(self, temperature):
        """d ln μ/dp at p = 0 [1/Pa]."""
        zero, one = jnp.zeros_like(temperature), jnp.ones_like(temperature)
        _, slope = jax.jvp(
            lambda p: self._log_viscosity(p, temperature), (zero,), (one,)
        )
        return slope


@program(quick=True)
def _kinematic_viscosity(lubricant, kelvin):
    return lubricant._ambient_viscosity(kelvin) / lubricant.density.at(kelvin)


def _kelvin(temperature):
    if not is_traced(temperature):
        positive("Lubricant", "temperature", temperature, "K")
    return as_real(temperature)

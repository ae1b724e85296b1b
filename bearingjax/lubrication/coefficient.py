"""Pressure-viscosity coefficients over the viscosity at atmospheric pressure."""

import abc
from typing import Any

import equinox as eqx
import jax.numpy as jnp

from ..design.checks import non_negative, number, positive
from ..numerics.types import Real, Scalar
from ..numerics.units import real


class AbstractCoefficient(eqx.Module):
    """Pressure-viscosity coefficient α over the viscosity at atmospheric pressure."""

    @abc.abstractmethod
    def value(self, ambient: Scalar, density: Scalar) -> Scalar:
        """α [1/Pa]; arguments as in `AbstractPressureLaw.log_ratio`."""


class ConstantCoefficient(AbstractCoefficient):
    """Pressure-viscosity coefficient that is constant at all temperatures.

    Attributes:
        coefficient: α [1/Pa].

    Traced: all fields.
    """

    coefficient: Real = eqx.field(**real("1/Pa"))

    def __check_init__(self):
        non_negative(self, "coefficient")

    def value(self, ambient: Scalar, density: Scalar) -> Scalar:
        return self.coefficient


class DynamicCoefficient(AbstractCoefficient):
    """α = factor·(dynamic viscosity in Pa s)^exponent.

    Attributes:
        factor: α at 1 Pa s [1/Pa].
        exponent: Exponent [1].

    Traced: all fields.
    """

    factor: Real = eqx.field(**real("1/Pa"))
    exponent: Real = eqx.field(**real("1"))

    def __check_init__(self):
        positive(self, "factor")
        number(self, "exponent")

    def value(self, ambient: Scalar, density: Scalar) -> Scalar:
        return self.factor * jnp.exp(self.exponent * ambient)


class KinematicCoefficient(AbstractCoefficient):
    """α = factor·(kinematic viscosity in mm²/s)^exponent.

    Attributes:
        factor: α at 1 mm²/s [1/Pa].
        exponent: Exponent [1].

    Traced: all fields.
    Source: Gold, Schmidt, Dicke, Loos & Assmann, J. Synthetic Lubrication 18 (2001)
        51-79; mineral oil: 9.904e-9 and 0.139.
    """

    factor: Real = eqx.field(**real("1/Pa"))
    exponent: Real = eqx.field(**real("1"))

    def __check_init__(self):
        positive(self, "factor")
        number(self, "exponent")

    def value(self, ambient: Scalar, density: Scalar) -> Scalar:
        kinematic = 1e6 * jnp.exp(ambient) / density
        return self.factor * kinematic**self.exponent


def as_coefficient(value: Any) -> Any:
    """Converter: a plain number is the coefficient at all temperatures [1/Pa]."""
    kept = value is None or isinstance(value, AbstractCoefficient)
    return value if kept else ConstantCoefficient(value)

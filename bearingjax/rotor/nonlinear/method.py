"""Common interface of shooting and harmonic balance for periodic orbits.

A method turns periodicity into equations for dimensionless unknowns z:
residual(z, ν) = 0. Newton's method, continuation and stability are written once, on
this interface.
"""

import abc
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from ...numerics.types import Scalar, Vector
from .system import AbstractVibratingSystem

Motion = tuple[Float[Array, "sample n"], Float[Array, "sample n"]]
"""Freedoms over `scale` and their derivatives with respect to the phase, at even phases
over the period from 0 on [1]."""

Unknowns = Float[Array, " m"]
"""Dimensionless unknowns z, or as many residuals [1]."""
Jacobian = Float[Array, "m x"]
"""Derivatives of the residuals with respect to z and ν [1]."""


class AbstractMethod(eqx.Module):
    """Method to find an orbit. Static: all fields."""

    @abc.abstractmethod
    def unknowns(self, motion: Motion) -> Unknowns:
        """Unknowns z of a motion given by its samples [1]."""

    @abc.abstractmethod
    def state(self, z: Unknowns) -> tuple[Vector, Vector]:
        """Freedoms over `scale` and their derivatives by the phase, at phase 0 [1]."""

    @abc.abstractmethod
    def residual(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Unknowns:
        """Zero where the motion repeats and obeys the equations of motion [1].

        Args:
            system: The system.
            z: Unknowns [1].
            ratio: Frequency over the reference frequency, ν [1].
        """

    @abc.abstractmethod
    def linearise(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> tuple[Unknowns, Jacobian, Any]:
        """`residual`, its Jacobian in (z, ν), and what `monodromy` makes use of."""

    @abc.abstractmethod
    def motion(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Motion:
        """The motion over a period."""

    @abc.abstractmethod
    def monodromy(
        self,
        system: AbstractVibratingSystem,
        ratio: Scalar,
        jacobian: Jacobian,
        slopes: Any,
    ) -> Float[Array, "state state"]:
        """Return the derivative of the state after a period by the initial state [1].

        Args:
            system: The system.
            ratio: ν [1].
            jacobian, slopes: From `linearise` at the orbit.
        """

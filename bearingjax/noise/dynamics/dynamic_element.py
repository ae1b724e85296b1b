"""Rolling elements with mass and freedoms of their own.

The energy of a rolling element depends on the rings and on its position relative to
them. Here its position p is absolute: along z and r for a ball, along and across
its axis, with its tilt, for a roller. No equilibrium is solved for.
"""

import dataclasses
import functools
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...design.material import Material
from ...element import FREEDOMS, RingMotion, Speed, ball_mass
from ...element.balls.ball import Ball
from ...element.inertia import inertia_force, mass_and_inertia
from ...element.roller import Roller
from ...numerics.linear import combine_rows
from ...numerics.types import Scalar, Vector


class DynamicElement(eqx.Module):
    """One rolling element with freedoms of its own.

    Attributes:
        element: The rolling element.
        mass: Mass of each coordinate of its place (n,) [kg, kg m²].
        force: Force of inertia, from its orbit, at the drawing's place (n,) [N, N m].
        scale: x per unit of p (n,) [1, m].
        own: Motion of a ring in the element's axes, from that in the axial section
            (h, 3) [1, m, 1/m].

    Traced: all numbers.
    """

    element: Any
    mass: Vector
    force: Vector
    scale: Vector
    own: Float[Array, "h 3"]

    def in_element_axes(
        self, outer: Float[Array, "3"], inner: Float[Array, "3"]
    ) -> RingMotion:
        """Return ring motions in its axes, from those in the axial section [m, rad].

        Args:
            outer, inner: (u, v, θ) of each ring [m, rad].
        """
        return RingMotion(
            combine_rows(self.own.T, outer), combine_rows(self.own.T, inner)
        )

    def in_section(self, forces: Float[Array, " h"]) -> Float[Array, "3"]:
        """Return forces on (u, v, θ) of a ring, from those in its axes [N, N m]."""
        return combine_rows(self.own, forces)

    def unknowns(self, rings: RingMotion, place: Vector) -> Vector:
        """Return the own unknowns x of the rolling element [m].

        Args:
            rings: Motions of the rings in its axes [m, rad].
            place: p [m, rad].
        """
        return (place - rings.mean[: place.shape[0]]) * self.scale

    def with_heights(self, heights: Float[Array, "2"]) -> "DynamicElement":
        """Return a copy with material added in its contacts [m]."""
        return dataclasses.replace(self, element=self.element.with_heights(heights))

    def energy(self, rings: RingMotion, place: Vector) -> Scalar:
        """Return the strain energy of its contacts [J]; arguments as in `unknowns`."""
        return self.element.energy(rings, self.unknowns(rings, place))

    def loads(self, rings: RingMotion, place: Vector) -> Float[Array, " contact"]:
        """Return the load of each contact [N]; arguments as in `unknowns`."""
        at = self.element.coordinates(rings, self.unknowns(rings, place))
        return self.element.respond(at).aux

    def load_and_cosine(
        self, rings: RingMotion, place: Vector
    ) -> tuple[Scalar, Scalar]:
        """Return the sum of a ball's loads [N] and the cosine of its contact angle [1].

        The cosine is the mean of its contacts by their loads; 1 of a loose ball.
        Arguments as in `unknowns`.
        """
        x = self.unknowns(rings, place)
        load = self.element.respond(self.element.coordinates(rings, x)).aux
        cosines = jnp.abs(self.element.contacts(rings, x).normal[:, 1])
        total = jnp.sum(load)
        loose = total == 0.0
        mean = jnp.sum(load * cosines) / jnp.where(loose, 1.0, total)
        return total, jnp.where(loose, 1.0, mean)


@functools.singledispatch
def dynamic_element(
    element: Any, material: Material, pitch_radius: Scalar, speed: Speed, orbit: Scalar
) -> DynamicElement:
    """Create a rolling element with its inertia.

    Args:
        element: The rolling element, made without speed.
        material: Material of the rolling elements.
        pitch_radius: Radius of the circle of their centres [m].
        speed: Speed of the rings.
        orbit: Speed of their orbit [rad/s].

    Raises:
        TypeError: For other rolling elements.
    """
    raise TypeError(
        f"NoiseModel: rolling elements are of class {type(element).__name__}; it must"
        " be balls or rollers."
    )


@dynamic_element.register
def _(element: Ball, material, pitch_radius, speed, orbit) -> DynamicElement:
    mass, _ = ball_mass(element.diameter, material.density)
    both, none = jnp.stack([mass, mass]), jnp.zeros_like(mass)
    force = jnp.stack([none, mass * pitch_radius * orbit**2])
    return DynamicElement(
        element, both, force, jnp.ones_like(both), _own_freedoms(element)
    )


@dynamic_element.register
def _(element: Roller, material, pitch_radius, speed, orbit) -> DynamicElement:
    c = element.constants
    mass, _, tilting = mass_and_inertia(c)
    one = jnp.ones_like(mass)
    masses = jnp.stack([mass, mass, tilting])
    scale = jnp.stack([one, one, c.half_length])
    force = inertia_force(c, speed)
    return DynamicElement(element, masses, force, scale, _own_freedoms(element))


def _own_freedoms(element):
    """Return `own`: at azimuth 0 the section's (u, v, θ) are uz, ux and gy."""
    at_zero = element.axes(jnp.zeros_like(element.diameter))
    return jnp.stack([at_zero[:, FREEDOMS.index(k)] for k in ("uz", "ux", "gy")], 1)


def forces(
    element: DynamicElement, rings: RingMotion, place: Vector
) -> tuple[RingMotion, Vector]:
    """Return derivatives of the energy by both ring motions and by place [N, N m]."""
    return jax.grad(DynamicElement.energy, argnums=(1, 2))(element, rings, place)

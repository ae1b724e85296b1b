"""The energy of a rolling element: the physics, written once.

U(rings, x) = Σ_contacts W(u) + k/2 |x - x_mid|² - F·y. The coordinates u of the
contacts follow from the motions by geometry; W is the energy of a contact. A tether
spring, far softer than any contact, holds the rolling element in the middle of its
rings where
nothing else does. F is the force of inertia, as far as it has a potential.

Force is `jax.grad` of this, stiffness `jax.hessian` (see `derivatives`). Both are small
and fast because contacts give their own derivatives (`numerics.expansion`).

Source: Sorokin, Zhang, Ivannikov (2018) for rollers; the textbook equations of balls
    between rings (Jones, J. Basic Eng. 82, 1960; Harris, Rolling Bearing Analysis) are
    the derivatives of `ball_energy`.
"""

from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.expansion import Expansion
from ..numerics.implicit import stop_gradient
from ..numerics.linear import dot
from ..numerics.types import Reals, Scalar
from ..numerics.units import unit, units
from .rolling_element import (
    AbstractRollingElement,
    RingMotion,
    Unknowns,
    contact_energy,
    split_rings,
)


def roller_energy(
    self: Any,
    rings: RingMotion,
    x: Unknowns,
    contact_response: Expansion | None = None,
) -> Scalar:
    """Energy U - F·y of one roller [J].

    Contacts: with each raceway, in two numbers (approach at the middle, and more of it
    at the end from tilt), and with each rib, in one.

    Args:
        self: The `element.roller.Roller`.
        rings: Motions of the rings in roller axes, (t, m, θ) each [m, rad].
        x: Place of the roller from the mean of the rings, tilt times L/2 (3,) [m].
        contact_response: Contact response there, if available.
    """
    energy = contact_energy(self, self.coordinates(rings, x), contact_response)
    energy = energy + 0.5 * self.tether * dot(x, x)
    if self.body_force is None:
        return energy
    return energy - dot(self.body_force, self.constants.motion(rings, x))


def ball_energy(
    self: Any,
    rings: RingMotion,
    x: Unknowns,
    contact_response: Expansion | None = None,
) -> Scalar:
    """Energy U - F·y of one ball [J].

    Contacts: with each arc of a groove, in the motion (z, r) of the ball's centre
    against that of the groove. The contact angle follows from it.

    Args:
        self: The `element.balls.ball.Ball`.
        rings: Motions of the rings in the ball's axes [m, rad].
        x: Place of the ball's centre (z, r), from where the rings take it (2,) [m].
        contact_response: Contact response there, if available.
    """
    energy = contact_energy(self, self.coordinates(rings, x), contact_response)
    # The tether does not pull the rings: it is no part of the bearing.
    off = x - stop_gradient(self.geometry.midpoint(rings))
    energy = energy + 0.5 * self.tether * dot(off, off)
    if self.ball_inertia is None or self.has_reaction:
        return energy
    (_, outwards), _ = self.geometry.places(rings, x)
    return energy - self.ball_inertia.centrifugal * outwards


class Derivatives(NamedTuple):
    """Forces of one rolling element and their derivatives.

    Attributes:
        energy: U - F·y [J].
        gradient: Generalised forces on (rings, x), or on x alone [N, N m]: the gradient
            of the energy, and the forces that have no potential.
        hessian: Derivatives of `gradient` [N/m, N, N m]; empty if not asked for.
    """

    energy: Annotated[Scalar, unit("J")]
    gradient: Annotated[Float[Array, " m"], units("N", "N m")]
    hessian: Annotated[Reals, units("N/m", "N", "N m")]


def derivatives(
    element: AbstractRollingElement,
    rings: Float[Array, " r"],
    x: Unknowns,
    contact_response: Expansion | None = None,
    *,
    of_own: bool = False,
    with_hessian: bool = True,
) -> Derivatives:
    """Energy, forces and stiffness of one rolling element.

    Args:
        element: The rolling element.
        rings: Motions of the rings in its axes, see `ring_motions` (r,) [m, rad].
        x: Own unknowns (n,) [m].
        contact_response: Its `respond` at this place, if it is at hand.
        of_own: Derivatives with respect to x alone. Static.
        with_hessian: Whether stiffness is wanted. Static.
    """

    def motions(y):
        n = y.shape[0] - x.shape[0]
        return ring_motions(element, rings if of_own else y[:n]), y[n:]

    def energy(y):
        return element.energy(*motions(y), contact_response)

    def forces(y):
        value, gradient = jax.value_and_grad(energy)(y)
        reaction = element.reaction(*motions(y))
        if reaction is not None:
            on_rings, on_own = reaction
            more = () if of_own else _on_packed(element, on_rings)
            gradient = gradient + jnp.concatenate([*more, on_own])
        return gradient, (value, gradient)

    y = x if of_own else jnp.concatenate([rings, x])
    if not with_hessian:
        gradient, (value, _) = forces(y)
        return Derivatives(value, gradient, jnp.zeros((0,), y.dtype))
    hessian, (value, gradient) = jax.jacfwd(forces, has_aux=True)(y)
    return Derivatives(value, gradient, hessian)


def response(
    element: AbstractRollingElement, rings: Float[Array, " r"], x: Unknowns
) -> Expansion:
    """Contact response of a rolling element; arguments as in `derivatives`."""
    return element.respond(element.coordinates(ring_motions(element, rings), x))


def ring_motions(
    element: AbstractRollingElement, rings: Float[Array, " r"]
) -> RingMotion:
    """Motions of both rings from those that a row solves for.

    Args:
        element: The rolling element.
        rings: Motions of outer and inner ring, one after the other; or that of the
            inner against the outer one, where the element sees no more [m, rad].
    """
    if element.sees_difference:
        return RingMotion(jnp.zeros_like(rings), rings)
    return split_rings(rings)


def _on_packed(element, forces):
    """Forces on the motions that `ring_motions` takes, from those on both rings."""
    return forces[1:] if element.sees_difference else tuple(forces)

"""Cage in contact with rolling elements and a guiding ring.

The cage is a rigid ring with three freedoms of its own: its centre's x and y, and how
far it has turned beyond the even orbit. Every rolling element has a place of its own
along the pitch circle. Pockets and the land on the guiding ring are contacts with
clearance; the raceways draw every element towards the speed at which it would roll.

Source: Kurushin, Kurushin, Zhilnikov, Murashkin, Vestnik SGAU (2011), in outline; the
    friction in pockets and on the land, and the weights of the rolling elements, are
    left out here.
"""

from typing import Annotated, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...design.checks import finite, instance, non_negative, of_shape, one_of, positive
from ...element.frame import RINGS
from ...numerics.linear import lengths
from ...numerics.types import Real, Scalar, as_real
from ...numerics.units import real, unit, units
from .cage_contact import CageContact
from .element_positions import Each


class GuidedCage(eqx.Module):
    """A cage guided by a ring, for balls.

    Its centre moves; `skid.Cage`, which turns alone, has other freedoms and another
    law of its pockets.

    Attributes:
        mass: [kg].
        inertia: Moment of inertia about the bearing's axis [kg m²].
        contact: Force law of pockets and land.
        pocket_clearance: Clearance of a ball in its pocket along the pitch circle, from
            bar to bar [m].
        land_clearance: Clearance of the land on the guiding ring, in diameter [m].
        friction: Friction coefficient of balls on raceways that they slide on [1].
        sliding_speed: v of friction · tanh(sliding/v), by which it sets in [m/s].
        load: On the cage along x and y, such as its weight (2,) [N].
        guiding_ring: "outer" or "inner". Static.

    Traced: all numbers.
    """

    mass: Real = eqx.field(**real("kg"))
    inertia: Real = eqx.field(**real("kg m²"))
    contact: CageContact
    pocket_clearance: Real = eqx.field(**real("m"))
    land_clearance: Real = eqx.field(**real("m"))
    friction: Real = eqx.field(**real("1"), default=0.05)
    sliding_speed: Real = eqx.field(**real("m/s"), default=0.05)
    load: Float[Array, "2"] = eqx.field(
        converter=as_real, metadata=unit("N"), default=(0.0, 0.0)
    )
    guiding_ring: str = eqx.field(static=True, default="outer")

    def __check_init__(self):
        instance(self, "contact", CageContact)
        for name in ("mass", "inertia", "sliding_speed"):
            positive(self, name)
        for name in ("pocket_clearance", "land_clearance", "friction"):
            non_negative(self, name)
        fits = np.shape(self.load) == (2,)
        of_shape(self, "load", fits, "(2,): along x and y, in N")
        finite(self, "load")
        one_of(self, "guiding_ring", self.guiding_ring, RINGS, "'outer' or 'inner'")


class CageForces(NamedTuple):
    """Contact forces of a cage on rolling elements, cage and guiding ring.

    Attributes:
        arcs: To every rolling element along the pitch circle (element,) [N].
        cage: To its x, y and turn (3,) [N, N m].
        ring: To the guiding ring along x and y (2,) [N].
    """

    arcs: Annotated[Each, unit("N")]
    cage: Annotated[Float[Array, "3"], units("N", "N m")]
    ring: Annotated[Float[Array, "2"], unit("N")]


def cage_loads(
    cage: GuidedCage,
    place: Float[Array, "3"],
    arcs: Each,
    ring: Float[Array, "2"],
    pitch_radius: Scalar,
    azimuth: Each,
) -> tuple[Each, Scalar]:
    """Return forces of pockets along the pitch circle, and of the land normally [N].

    Args:
        cage: The cage.
        place: Its x, y and turn beyond the even orbit (3,) [m, rad].
        arcs: Lead of every rolling element over uniform orbit (element,) [m].
        ring: x and y of the guiding ring [m].
        pitch_radius: Radius of the circle of the rolling elements [m].
        azimuth: Azimuth of the rolling elements [rad].
    """
    ahead = arcs - _along_pitch(azimuth, pitch_radius) @ place
    half = 0.5 * cage.pocket_clearance
    pushed = cage.contact.force(ahead - half) - cage.contact.force(-ahead - half)
    distance = lengths(place[:2] - ring)
    return pushed, cage.contact.force(distance - 0.5 * cage.land_clearance)


def cage_forces(
    pockets: Each,
    land: Scalar,
    place: Float[Array, "3"],
    arcs: Each,
    ring: Float[Array, "2"],
    pitch_radius: Scalar,
    azimuth: Each,
) -> CageForces:
    """Return reversed forces of pockets and land, as derivatives of an energy.

    Args:
        pockets, land: From `cage_loads`, or with their damping [N].
        place, arcs, ring, pitch_radius, azimuth: As in `cage_loads`.
    """
    off = place[:2] - ring
    distance = lengths(off)
    centred = distance == 0.0
    towards = jnp.where(centred, 0.0, land / jnp.where(centred, 1.0, distance))
    on_ring = towards * off
    on_cage = (-pockets @ _along_pitch(azimuth, pitch_radius)).at[:2].add(on_ring)
    return CageForces(pockets, on_cage, -on_ring)


def _along_pitch(azimuth, pitch_radius):
    """Return the pocket motion along the pitch circle, per freedom of the cage."""
    sine, cosine = jnp.sin(azimuth), jnp.cos(azimuth)
    return jnp.stack([-sine, cosine, jnp.full_like(sine, 1.0) * pitch_radius], axis=1)


def fastest_of_cage(
    cage: GuidedCage,
    push: Scalar,
    count: int,
    ball_mass: Scalar,
    ring_mass: Scalar,
    pitch_radius: Scalar,
) -> Scalar:
    """Return an upper bound of the angular frequency of cage, balls and ring [rad/s].

    All pockets and the land are taken as loaded at once, at their largest stiffness.

    Args:
        cage: The cage.
        push: Largest force of a contact [N].
        count: Number of balls, evenly spaced.
        ball_mass, ring_mass: [kg].
        pitch_radius: Radius of the circle of the balls [m].

    Source: ω² of the pockets is k (1/m + z max(R²/I, 1/2M)), since turn, x and y of the
        cage are orthogonal over even pockets; that of the land k (1/M + 1/m_ring); of
        both at most their sum (Weyl).
    """
    turning = pitch_radius**2 / cage.inertia
    pockets = 1.0 / ball_mass + count * jnp.maximum(turning, 0.5 / cage.mass)
    land = 1.0 / cage.mass + 1.0 / ring_mass
    return jnp.sqrt(cage.contact.stiffest(push) * (pockets + land))

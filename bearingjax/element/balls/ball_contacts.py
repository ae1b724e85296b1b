"""Contacts of one ball in its grooves, from how it has moved against each of them."""

from typing import Annotated, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.linear import dot
from ...numerics.types import Reals, Scalar
from ...numerics.units import unit
from ..rolling_element import Unknowns


class Contacts(NamedTuple):
    """Contacts of one ball at given motions, each array with the axis contact.

    Attributes:
        approach: l - L [m].
        length: l, distance of ball centre and groove centre [m].
        inverse: 1/l, finite, with which the normal turns; 0 if it does not [1/m].
        normal: Unit vector (z, r) from groove centre to ball centre (contact, 2), in
            the section of the ring; at the groove centre, where there is none, zero.
        mask: 0 where the component of that vector along z, or along r, does not count,
            because the groove has ended there, else 1 (contact, 2).
    """

    approach: Annotated[Float[Array, " contact"], unit("m")]
    length: Annotated[Float[Array, " contact"], unit("m")]
    inverse: Annotated[Float[Array, " contact"], unit("1/m")]
    normal: Float[Array, "contact 2"]
    mask: Float[Array, "contact 2"]


class GrooveGeometry(eqx.Module):
    """Positions of the grooves around a ball, unloaded.

    A groove is an arc of at most a half circle. Beyond it the raceway goes straight on:
    at the shoulders radially (a wall across the axis), and with an `open_side`, or as
    a washer, as a cylinder. So a ball that has passed the groove centre has no contact
    there, the energy stays convex, and forces do not jump.

    Attributes:
        start: Vector (z, r) from each groove centre to the ball centre, unloaded
            (contact, 2) [m].
        free: Unit vectors along them: the normals of the unloaded ball (contact, 2).
        reach: L = groove radius - ball radius (contact,) [m].
        on_outer: Which contacts belong to the outer ring.
        open_side: Which raceways are cylinders beyond the groove bottom.
        washers: Whether the raceways are those of a thrust bearing, whose grooves open
            along the axis.
        straight: Whether the normals stay as they are unloaded, so that each raceway
            is a plane.

    Static: on_outer, open_side, washers, straight.
    """

    start: Float[Array, "contact 2"]
    free: Float[Array, "contact 2"]
    reach: Float[Array, " contact"]
    on_outer: tuple[bool, ...] = eqx.field(static=True)
    open_side: tuple[bool, ...] = eqx.field(static=True)
    washers: bool = eqx.field(static=True)
    straight: bool = eqx.field(static=True)

    @property
    def outwards(self) -> list[float]:
        """1 for contacts of the outer ring, else -1."""
        return [1.0 if outer else -1.0 for outer in self.on_outer]

    @property
    def gap(self) -> Scalar:
        """Largest gap or squeeze, unloaded and centred [m]."""
        square = jnp.sum(self.start**2, axis=1)
        return jnp.max(jnp.abs(jnp.sqrt(square) - self.reach))

    def touch(self, moved: Float[Array, "contact 2"]) -> Contacts:
        """Contacts of a ball that has moved.

        Args:
            moved: Motion (z, r) of the ball centre against each groove centre [m].
        """
        if self.straight:
            return self._planes(moved)
        vector = self.start + moved
        ends = jnp.asarray([[side, not self.washers] for side in self.open_side])
        behind = jnp.asarray(self.outwards, moved.dtype)[:, None] * vector < 0
        beyond = ends & behind
        mask = jnp.where(beyond, 0.0, 1.0)
        # From groove centre to ball centre; what does not count is left out.
        kept = mask * vector
        square = jnp.sum(kept**2, axis=1)
        # At the groove centre there is no direction; the contact is open there.
        least = (1e-9 * self.reach) ** 2
        length = jnp.sqrt(jnp.maximum(square, least))
        # (l² - L²)/(l + L) without the cancellation, where the start is known.
        start2 = jnp.sum(self.start**2, axis=1) - self.reach**2
        change = jnp.sum(moved * (2.0 * self.start + moved), axis=1)
        known = ~jnp.any(beyond, axis=1)
        difference = jnp.where(known, start2 + change, square - self.reach**2)
        approach = difference / (length + self.reach)
        # Divisions and roots part a compiled loop in two: as few as can be.
        inverse = 1.0 / length
        return Contacts(approach, length, inverse, kept * inverse[:, None], mask)

    def _planes(self, moved):
        normal = self.free
        unloaded = jnp.sqrt(jnp.sum(self.start**2, axis=1))
        length = unloaded + jnp.sum(normal * moved, axis=1)
        flat = jnp.zeros_like(length)
        return Contacts(length - self.reach, length, flat, normal, jnp.ones_like(moved))

    def directions(
        self, contacts: Contacts, load: Float[Array, " contact"], diameter: Scalar
    ) -> tuple[Float[Array, "2 2"], Float[Array, "2"]]:
        """Contact direction of a ball on each raceway, and its load there.

        On two arcs it rolls on the one that it presses more deeply; while both are
        pressed within a thousandth of its diameter of each other, in between.

        An inner raceway that it has left does not drive it, and the line of centres
        there may point anywhere: the ball then orbits with the others, as if that
        contact lay opposite the outer one, with γ = D/d_m at (1 ∓ γ cos α_o)/2 of the
        ring speeds. Directions are mixed over a gap of half the groove's L, so that
        forces do not jump and a ball is not both in contact and free. In equilibrium
        the ball never leaves the outer raceway.

        Args:
            contacts: From `touch`.
            load: Load of each contact [N].
            diameter: Ball diameter [m].

        Returns:
            Unit vectors (sin α, cos α) (2, 2), outer and inner, and loads (2,) [N],
            of two arcs their sum.
        """
        vectors = jnp.asarray(self.outwards, load.dtype)[:, None] * contacts.normal
        normals, loads, depths = [], [], []
        for ring in (True, False):
            mine = [k for k, on_outer in enumerate(self.on_outer) if on_outer is ring]
            if len(mine) == 1:
                normals.append(vectors[mine[0]])
                loads.append(load[mine[0]])
                depths.append(contacts.approach[mine[0]])
                continue
            first, second = mine
            deeper = contacts.approach[first] - contacts.approach[second]
            t = jnp.clip(0.5 + deeper / (2e-3 * diameter), 0.0, 1.0)
            share = t * t * (3.0 - 2.0 * t)
            mean = share * vectors[first] + (1.0 - share) * vectors[second]
            normals.append(mean / jnp.sqrt(dot(mean, mean)))
            loads.append(load[first] + load[second])
            depths.append(contacts.approach[second] + share * deeper)
        outer, inner = normals
        near = jnp.clip(1.0 + 2.0 * depths[1] / self.reach[-1], 0.0, 1.0)
        grip = near * near * (3.0 - 2.0 * near)
        inner = grip * inner + (1.0 - grip) * outer
        return jnp.stack([outer, inner]), jnp.stack(loads)


def angles(vectors: Float[Array, "*n 2"]) -> Float[Array, "*n"]:
    """Angles of contact normals (sin α, cos α) [rad]; zero at the groove centre."""
    z, r = vectors[..., 0], vectors[..., 1]
    return jnp.arctan2(z, jnp.where((z == 0.0) & (r == 0.0), 1.0, r))


def along_normals(c: Contacts, step: Unknowns) -> Float[Array, " contact"]:
    """Part of a step of the ball along each normal [m]."""
    return c.normal[:, 0] * step[0] + c.normal[:, 1] * step[1]


def bend_step(c: Contacts, load: Float[Array, " contact"], step: Unknowns) -> Unknowns:
    """A step, turned along the circle around the centre of the busiest groove.

    Args:
        c: Contacts before the step.
        load: Their loads [N].
        step: Step of the ball centre (z, r) [m].
    """
    chosen = (load == jnp.max(load)) & (load > 0.0) & jnp.all(c.mask > 0.0, axis=1)
    weight = jnp.where(chosen, 1.0, 0.0)
    weight = weight / jnp.maximum(add(weight), 1.0)
    normal = add(weight[:, None] * c.normal)
    length = add(weight * c.length)
    along = dot(normal, step)
    new = length * normal + step
    size = jnp.sqrt(jnp.maximum(dot(new, new), jnp.finfo(step.dtype).tiny))
    # new/size·(length + along) - length·normal, without cancellation.
    across2 = jnp.maximum(dot(step, step) - along * along, 0.0)
    short = across2 / (size * (size + length + along))
    bends = (length + along > 0.0) & (length > 0.0)
    return jnp.where(bends, step - short * new, step)


def add(terms: Float[Array, "contact ..."]) -> Reals:
    """Sum over the contacts, written out so that it fuses."""
    total = terms[0]
    for k in range(1, terms.shape[0]):
        total = total + terms[k]
    return total

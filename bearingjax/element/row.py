"""Rows of rolling elements: solved at given ring motions, summed over the ring."""

import dataclasses
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from ..design import AbstractRollerBearing, Bearing, SetRow, n_elements
from ..numerics.implicit import attach, stop
from ..numerics.minimise import AbstractMinimiser, Evaluation, TrustRegionNewton
from ..numerics.types import Ring, RingStiffness, Scalar
from .equilibrium import (
    LocalState,
    Near,
    condensed_force,
    condensed_stiffness,
    near_by,
    solve_element,
    solved_derivatives,
)
from .frame import orbit, placement, roll_ratio, roller_azimuth, section_matrix
from .model import Derivatives


class RowModel(eqx.Module):
    """One row: its place, and what the energy of its rolling elements needs.

    Attributes:
        part: The row and its place.
        element: One rolling element, common to all, a `RollerModel` or ball;
            of unlike elements, with a leading axis.
        unlike: Whether `element` has a leading axis. Static.
        alone: Whether the row is the bearing, not part of a set. Static.
    """

    part: SetRow
    element: Any
    unlike: bool = eqx.field(static=True)
    alone: bool = eqx.field(static=True)

    def each(self, function: Callable, *arrays) -> Any:
        """Apply function(element, *arrays) to every rolling element.

        Args:
            function: Of one element.
            *arrays: More arguments, with leading axis element. Without any, like
                elements are one element.
        """
        if not (self.unlike or arrays):
            return function(self.element)
        axes = (0 if self.unlike else None,) + (0,) * len(arrays)
        return jax.vmap(function, in_axes=axes)(self.element, *arrays)

    @property
    def position(self) -> Scalar:
        """z of the origin that the elements count from, in the set [m]."""
        position = self.part.position
        return jnp.zeros_like(position) if self.element.places_itself else position

    @property
    def placement(self) -> Float[Array, "6 6"]:
        """Ring freedoms in the row's own axes, from those at the node."""
        return placement(self.position, self.part.mirrored)

    def solve(
        self,
        q: Ring,
        minimiser: AbstractMinimiser,
        turns: bool,
        near: Near | None,
    ) -> "Row":
        """Equilibrium of every rolling element at given ring freedoms.

        Args:
            q: Ring freedoms at the node [m, rad].
            minimiser: Local solver. Static.
            turns: Whether derivatives see the azimuth move with gz. Static.
            near: `Row.near` at ring freedoms near by, or `None`.
        """
        part = self.part
        azimuth = azimuths(part.bearing, q if turns else lax.stop_gradient(q))
        # gz moves the elements only through the azimuth: its columns are zero.
        section = self.each(lambda m, phi: m.section(phi), azimuth)
        local = q
        place = None
        if not self.alone:
            place = self.placement
            local = jnp.concatenate([place @ q[:6], place @ q[6:]])
            if not self.element.places_itself:
                offset = -part.inner_offset if part.mirrored else part.inner_offset
                local = local.at[_CLOSING].add(offset)
        pressed = None
        if part.spring is not None:
            pressed = self._pressed(part.spring, local, section, minimiser)
            local = local.at[_CLOSING].add(pressed.travel)
        row = self._at(local, azimuth, section, minimiser, near)
        if place is not None:
            row = dataclasses.replace(row, section=section @ place)
        return dataclasses.replace(row, pressed=pressed)

    def _at(self, local, azimuth, section, minimiser, near=None) -> "Row":
        """The elements at given motions in the row's own axes."""
        magnitude = jnp.max(jnp.abs(local[jnp.array([0, 1, 2, 6, 7, 8])]))
        tilt = jnp.max(jnp.abs(local[jnp.array([3, 4, 9, 10])]))
        magnitude = magnitude + 0.5 * self.part.bearing.pitch_diameter * tilt
        rings = self.seen(section, local)
        known = () if near is None else (near,)
        state = self.each(
            lambda m, r, *near: solve_element(m, r, magnitude, minimiser, *near),
            rings,
            *known,
        )
        solved = self.each(
            lambda m, r, s: solved_derivatives(m, r, magnitude, s), rings, state
        )
        return Row(self, local, azimuth, section, rings, state, solved, None)

    def seen(
        self, section: Float[Array, "element h 6"], q: Ring
    ) -> Float[Array, "element r"]:
        """Ring motions in the elements' axes.

        Args:
            section: Motion of one ring in an element's axes from its freedoms.
            q: Ring freedoms in the axes of `section` [m, rad].
        """
        if self.element.relative:
            return section @ (q[6:] - q[:6])
        return jnp.concatenate([section @ q[:6], section @ q[6:]], axis=1)

    def _pressed(self, spring, local, section, minimiser) -> "Pressed":
        """Travel of a spring that the row balances, and how it follows the rings."""
        column = self.seen(section, jnp.zeros_like(local).at[_CLOSING].set(1.0))
        azimuth = jnp.zeros(section.shape[:1], local.dtype)  # nothing asks for it

        def balance(travel, args):
            model, section, local, column = args
            moved = local.at[_CLOSING].add(travel[0])
            row = model._at(moved, azimuth, section, minimiser)
            energy, force, rate = model.part.spring.push(travel[0])
            pull = jnp.einsum("la,la->", column, row.forces()) - force
            return row, jnp.stack([pull]), energy, rate, force

        args = (self, section, local, column)
        frozen = stop(args)
        symmetric = self.element.has_potential

        def function(travel, _):
            row, pull, energy, rate, force = balance(travel, frozen)
            stiff = jnp.einsum("la,lab,lb->", frozen[3], row.blocks(), frozen[3])
            value = energy + jnp.sum(row.solved.energy)
            value = value if symmetric else jnp.full_like(value, jnp.nan)
            # Round-off of forces that cancel, and of positions in a stiff row.
            sizes = jnp.sum(jnp.abs(row.forces())) + stiff * jnp.abs(travel[0])
            noise = jnp.finfo(local.dtype).eps * (sizes + force)
            return Evaluation(value, pull, (stiff + rate)[None, None], force, noise)

        zero = jnp.zeros((1,), local.dtype)
        radius = 1e-4 * self.part.bearing.pitch_diameter
        solver = TrustRegionNewton()
        minimum = solver.minimise(
            function, zero, stop(radius), direction=jnp.ones_like(zero), tolerance=1e-13
        )
        found = attach(lambda y, args: balance(y, args)[1], minimum.x, args, symmetric)
        energy, _, rate = spring.push(found[0])
        return Pressed(found[0], energy, rate, column, minimum.result)


_CLOSING = 8
"""Freedom that presses a row in its own axes: uz of the inner ring."""


class Pressed(NamedTuple):
    """A spring that presses a row.

    Attributes:
        travel: What its ring has slid on its seat, closing the row [m].
        energy: Of the spring, less that at zero travel [J].
        rate: Loss of its force per travel [N/m].
        column: How the travel moves the rings in each element's axes (element, r).
        result: `Result` code of the balance.
    """

    travel: Scalar
    energy: Scalar
    rate: Scalar
    column: Float[Array, "element r"]
    result: Int[Array, ""]


class Row(eqx.Module):
    """All rolling elements of a row at given ring freedoms.

    Attributes:
        model: What they are.
        local: Ring freedoms at the row's origin, mirrored with it (12,) [m, rad].
        azimuth: (element,) [rad].
        section: Motion of one ring in an element's axes from its six freedoms at the
            node (element, h, 6).
        rings: Ring motions in an element's axes (element, r).
        state: Solved elements, leading axis element.
        solved: Their energies, forces and derivatives there, likewise.
        pressed: The spring that presses the row, or `None`.
    """

    model: RowModel
    local: Ring
    azimuth: Float[Array, " element"]
    section: Float[Array, "element h 6"]
    rings: Float[Array, "element r"]
    state: LocalState
    solved: Derivatives
    pressed: Pressed | None

    @property
    def part(self) -> SetRow:
        """The row and its place."""
        return self.model.part

    def each(self, function: Callable, *arrays) -> Any:
        """Apply function(element, rings, x, *arrays) to every rolling element.

        Args:
            function: Of one element.
            *arrays: More arguments, with leading axis element.
        """
        return self.model.each(function, self.rings, self.state.x, *arrays)

    def forces(self) -> Float[Array, "element r"]:
        """What each element passes to the rings, in its axes [N, N m]."""
        return self.model.each(condensed_force, self.solved)

    def sum_forces(self, shares: Float[Array, "element r"]) -> Ring:
        """Forces on both nodes from `forces` [N, N m]."""
        if self.model.element.relative:
            inner = jnp.einsum("lai,la->i", self.section, shares)
            return jnp.concatenate([-inner, inner])
        pairs = shares.reshape(shares.shape[0], 2, -1)
        return jnp.einsum("lai,lka->ki", self.section, pairs).reshape(-1)

    def cage_torque(self, force: Ring, q: Ring) -> Ring:
        """What turns the set of rolling elements, as moments on both gz [N m].

        The virtual work of the forces on the rings when the azimuth moves with gz.
        Turning the set within the rings is turning the rings back around it, so it is
        the work of `force` on that turn of q.

        Args:
            force: From `sum_forces` [N, N m].
            q: Ring freedoms at the node [m, rad].

        Returns:
            (12,), zero but for both gz.
        """
        turned = jnp.zeros_like(q)
        for x in (0, 3, 6, 9):
            turned = turned.at[x].set(-q[x + 1]).at[x + 1].set(q[x])
        work, ratio = -jnp.sum(force * turned), orbit_ratio(self.part.bearing)
        torque = jnp.zeros_like(q).at[5].set(work * orbit(ratio, 1.0, 0.0))
        return torque.at[11].set(work * orbit(ratio, 0.0, 1.0))

    def blocks(self) -> Float[Array, "element r r"]:
        """Condensed stiffness of each element, in its axes [N/m, N, N m]."""
        return self.model.each(condensed_stiffness, self.solved.hessian)

    def stiffness(self) -> RingStiffness:
        """Stiffness between both nodes, springs condensed [N/m, N, N m]."""
        blocks = self.blocks()
        total = self._sum_blocks(blocks)
        if self.pressed is None:
            return total
        column = self.pressed.column
        right = self.sum_forces(jnp.einsum("lab,lb->la", blocks, column))
        left = self.sum_forces(jnp.einsum("la,lab->lb", column, blocks))
        own = jnp.einsum("la,lab,lb->", column, blocks, column) + self.pressed.rate
        held = own > 0
        share = jnp.where(held, 1.0 / jnp.where(held, own, 1.0), 0.0)
        return total - share * jnp.outer(right, left)

    def _sum_blocks(self, blocks):
        """Stiffness between both nodes (12, 12) from `blocks`."""
        section = self.section
        if self.model.element.relative:
            half = jnp.einsum("lab,lbj->laj", blocks, section)
            k = jnp.einsum("lai,laj->ij", section, half)
            return jnp.block([[k, -k], [-k, k]])
        n, h, _ = section.shape
        pairs = blocks.reshape(n, 2, h, 2, h)
        half = jnp.einsum("lkamb,lbj->lakmj", pairs, section)
        total = jnp.einsum("lai,lakmj->kimj", section, half)
        return total.reshape(12, 12)

    def near(self) -> Near:
        """What solves at ring freedoms near by may start from, leading axis element."""
        return self.model.each(near_by, self.rings, self.state, self.solved)

    def energy(self) -> Scalar:
        """Energy of the elements, and of the spring [J]."""
        energy = jnp.sum(self.solved.energy)
        return energy if self.pressed is None else energy + self.pressed.energy


def azimuths(bearing: Bearing, q: Ring) -> Float[Array, " element"]:
    """Azimuth of every rolling element for given ring rotations gz [rad].

    Args:
        bearing: A single row.
        q: Ring freedoms [m, rad]; only both gz count.
    """
    ratio = orbit_ratio(bearing)
    return roller_azimuth(bearing.first_azimuth, n_elements(bearing), ratio, q)


def orbit_ratio(bearing: Bearing) -> Scalar:
    """G = D cos α/d_m of a row, with which its rolling elements orbit [1]."""
    if isinstance(bearing, AbstractRollerBearing):
        diameter, cosine = bearing.roller_diameter, jnp.cos(bearing.axis_angle)
    else:
        diameter, cosine = bearing.ball_diameter, bearing.free_cosine
    return roll_ratio(diameter, bearing.pitch_diameter, cosine)


def motions(row: Row) -> Float[Array, "element 3"]:
    """Section motion (u, v, θ) of every element at the node on the axis [m, rad]."""

    position = row.model.position

    def one(model, rings, x, azimuth):
        outer = section_matrix(azimuth) @ row.local[:6]
        u, v, theta = model.motion(rings, x, outer)
        if row.part.mirrored:
            u, theta = -u, -theta
        return jnp.stack([u, v - position * theta, theta])

    return row.each(one, row.azimuth)


def inertia_load(rows: tuple[Row, ...]) -> Float[Array, "6"]:
    """What inertia does to all rolling elements, at the node [N, N m].

    The forces that hold both rings add up to minus this.

    Args:
        rows: Solved rows.
    """
    total = jnp.zeros((6,), rows[0].local.dtype)
    for row in rows:
        parts = row.each(lambda m, r, x: m.inertia(r, x))
        if parts is not None:
            section = jax.vmap(section_matrix)(row.azimuth)
            total = (
                total + jnp.einsum("lai,la->i", section, parts) @ row.model.placement
            )
    return total

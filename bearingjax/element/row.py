"""Rows of rolling elements: placed, solved, and their common energy."""

from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from ..design import PreloadSpring
from ..numerics.expansion import Expansion, expand
from ..numerics.implicit import attach, recall, stop_gradient
from ..numerics.minimise import AbstractMinimiser, Evaluation, TrustRegionNewton
from ..numerics.types import Reals, Ring, Scalar
from ..numerics.units import unit
from .azimuth import Azimuth, turn
from .energy import response
from .equilibrium import (
    ElementStart,
    condense,
    own_unknowns,
    solve_element,
    unloaded_result,
)
from .frame import FREEDOMS, placement
from .rolling_element import RingMotion, split_rings
from .solved_row import RowResults, SolvedRow

_UZ = FREEDOMS.index("uz")
_TRANSLATIONS, _TILTS = slice(0, 3), slice(3, 5)


class RowPlacement(NamedTuple):
    """Position of a row in its set; of several rows, with an axis.

    Attributes:
        position: z of the origin of the row's elements [m].
        sign: -1 for a mirrored row, else 1 [1].
        offset: Axial position of the inner ring relative to the outer one, in the
            row's own axes [m].
    """

    position: Annotated[Reals, unit("m")]
    sign: Annotated[Reals, unit("1")]
    offset: Annotated[Reals, unit("m")]


class Row(eqx.Module):
    """One row of rolling elements, placed.

    Attributes:
        element: One rolling element, common to all; of unlike elements, with a leading
            axis.
        azimuth: Azimuth of every element for rings that have not turned [rad].
        shift: Shift of outer and inner raceway along z and from the axis, at each
            element [m]; `None`: as on the drawing.
        ratio: G = D cos α/d_m, with which the elements orbit [1].
        pitch_radius: Radius of the circle of their centres [m].
        place: Its place in a set; `None`: the row is the bearing.
        spring: Preload spring, or `None`.
        absent: Whether the place of each element is empty; `None`: none is.
        per_element: Whether `element` has a leading axis. Static.
    """

    element: Any
    azimuth: Azimuth
    shift: Float[Array, "element 2 2"] | None
    ratio: Scalar
    pitch_radius: Scalar
    place: RowPlacement | None
    spring: PreloadSpring | None
    absent: Bool[Array, " element"] | None
    per_element: bool = eqx.field(static=True)

    def map(self, function: Callable, *arrays: Any) -> Any:
        """Apply function(element, *arrays) to every rolling element.

        Args:
            function: Function of one element.
            *arrays: More arguments, with leading axis element. Without any, like
                elements are one element.
        """
        if not (self.per_element or arrays):
            return function(self.element)
        axes = (0 if self.per_element else None,) + (0,) * len(arrays)
        return jax.vmap(function, in_axes=axes)(self.element, *arrays)

    def where_present(self, values: Float[Array, "element ..."]) -> Array:
        """Values of the elements (element, …), zero in empty places."""
        if self.absent is None:
            return values
        absent = self.absent.reshape(-1, *[1] * (values.ndim - 1))
        return jnp.where(absent, 0.0, values)

    def turn(self, q: Ring) -> Scalar:
        """Orbit angle of the elements when the rings turn by their gz [rad].

        Args:
            q: Ring freedoms [m, rad]; only both gz count.
        """
        return turn(self.ratio, q)

    def solve(
        self,
        q: Ring,
        azimuth: Azimuth,
        minimiser: AbstractMinimiser,
        near: ElementStart | None,
    ) -> SolvedRow:
        """Equilibrium of every rolling element at given ring freedoms.

        Args:
            q: Ring freedoms at the node [m, rad].
            azimuth: Azimuths of its elements [rad].
            minimiser: Local solver. Static.
            near: `SolvedRow.near` at ring freedoms near by, or `None`.

        Returns:
            The solved row. It has no derivatives: those of what follows from it are
            taken where it is used.
        """
        row, q, azimuth = stop_gradient((self, q, azimuth))
        local = row.local(q)
        if row.spring is None:
            return row._solve_elements(local, azimuth, minimiser, near)
        return row._solve_with_spring(row.spring, local, azimuth, minimiser, near)

    def _solve_elements(self, local, azimuth, minimiser, near) -> SolvedRow:
        shift = jnp.concatenate([r[_TRANSLATIONS] for r in local])
        tilt = jnp.concatenate([r[_TILTS] for r in local])
        magnitude = jnp.max(jnp.abs(shift))
        magnitude = magnitude + self.pitch_radius * jnp.max(jnp.abs(tilt))
        rings = self.in_element_axes(local, azimuth)

        def solve_one(element, rings, given):
            near, absent = given
            found = solve_element(element, rings, magnitude, minimiser, near, absent)
            return *found, magnitude

        state, energies, magnitudes = self.map(solve_one, rings, (near, self.absent))
        return SolvedRow(rings, magnitudes, state, energies)

    def _solve_with_spring(self, spring, local, azimuth, minimiser, near) -> SolvedRow:
        """Solve as `_solve`, with the travel at which the spring balances the row."""

        def function(travel, _, memory):
            moved = _close_axially(local, travel[0])
            solved = self._solve_elements(moved, azimuth, minimiser, near)
            energy, force, stiff = self._sum_derivatives(moved, azimuth, solved)
            stored, push, rate = spring.push(travel[0])
            pull, own = force[_CLOSING] - push, stiff[_CLOSING, _CLOSING]
            value = energy + stored
            if not self.element.has_potential:
                value = jnp.full_like(value, jnp.nan)
            # Round-off of forces that cancel, and of positions in a stiff row.
            sizes = jnp.sum(jnp.abs(solved.energies.gradient))
            sizes = sizes + own * jnp.abs(travel[0]) + push
            noise = jnp.finfo(travel.dtype).eps * sizes
            hessian = (own + rate)[None, None]
            return Evaluation(value, pull[None], hessian, push, noise, solved)

        one = jnp.ones((1,), local.inner.dtype)
        unknown = self.unsolved_state()._replace(travel=(), balance=())
        minimum = TrustRegionNewton().minimise(
            function,
            0.0 * one,
            2e-4 * self.pitch_radius,
            memory=unknown,
            direction=one,
            tolerance=1e-13,
        )
        return minimum.memory._replace(travel=minimum.x[0], balance=minimum.result)

    def _forces(self, local, azimuth, solved):
        """Energy of all elements and its gradient in the row's own freedoms."""

        def energy(q):
            return self._sum(split_rings(q), azimuth, solved)

        return jax.value_and_grad(energy)(jnp.concatenate(local))

    def _sum_derivatives(self, local, azimuth, solved):
        """Energy and gradient as in `_forces`, and the Hessian."""

        def forces(q):
            value, gradient = self._forces(split_rings(q), azimuth, solved)
            return gradient, (value, gradient)

        q = jnp.concatenate(local)
        stiffness, (value, force) = jax.jacfwd(forces, has_aux=True)(q)
        return value, force, stiffness

    def _sum(self, local, azimuth, solved):
        """Energy of all elements at freedoms in the row's own axes."""

        def energy(solved_element, rings, energies):
            return expand(condense, rings, solved_element, energies)

        found = solved.map(self, energy, self.in_element_axes(local, azimuth))
        return jnp.sum(self.where_present(found))

    def energy(self, q: Ring, azimuth: Azimuth, solved: SolvedRow) -> Scalar:
        """Energy of the row as a function of the ring freedoms, solved there [J].

        Its derivatives with respect to q are the forces on the node and their
        Jacobian, also where part of the forces has no potential.

        Args:
            q: Ring freedoms at the node [m, rad].
            azimuth: Azimuths of its elements [rad].
            solved: The row solved there.
        """
        local = self.local(q)
        if self.spring is None:
            return self._sum(local, azimuth, solved)
        args = self, azimuth, solved
        return expand(_with_spring, jnp.concatenate(local), args)

    def results(self, q: Ring, azimuth: Azimuth, solved: SolvedRow) -> RowResults:
        """Results of the elements of a solved row, with derivatives.

        Args: as `energy`.
        """
        local, travel = self.local(q), None
        if self.spring is not None:
            travel = _travel(jnp.concatenate(local), (self, azimuth, solved))
            local = _close_axially(local, travel)
        rings = self.in_element_axes(local, azimuth)

        def element_results(solved_element, rings, energies):
            x = own_unknowns(solved_element, rings)

            def loads(element, rings, x):
                return response(element, rings, x).aux

            args = solved_element.element, rings, x
            load = recall(loads, solved_element.state.contact_response.aux, args)
            # A loose one carries nothing.
            nothing = energies.aux.contact_load == 0.0
            return x, jnp.where(nothing, 0.0, load)

        x, load = solved.map(self, element_results, rings)
        return RowResults(self, local, azimuth, rings, x, load, travel)

    def local(self, q: Ring) -> RingMotion:
        """Ring freedoms at the row's origin, in its own axes, from those at the node.

        Args:
            q: Ring freedoms at the node [m, rad].
        """
        both = RingMotion(*split_rings(q))
        if self.place is None:
            return both
        moved = placement(self.place.position, self.place.sign)
        outer, inner = (moved @ ring for ring in both)
        return _close_axially(RingMotion(outer, inner), self.place.offset)

    def in_element_axes(
        self, local: RingMotion, azimuth: Azimuth
    ) -> Float[Array, "element r"]:
        """Ring motions in the elements' axes, as their solves take them.

        Args:
            local: Ring freedoms in the row's own axes [m, rad].
            azimuth: Azimuths of its elements [rad].
        """

        def in_axes(element, azimuth, *shift):
            axes = element.axes(azimuth)
            rings = shift_motions(local, azimuth, shift[0]) if shift else local
            if element.sees_difference:
                return axes @ rings.difference
            return jnp.concatenate([axes @ rings.outer, axes @ rings.inner])

        return self.map(
            in_axes, azimuth, *(() if self.shift is None else (self.shift,))
        )

    def unsolved_state(self) -> SolvedRow:
        """Return an unsolved row in the shape of a solved one."""
        local = self.local(jnp.zeros((12,), self.ratio.dtype))
        rings = jnp.zeros_like(self.in_element_axes(local, self.azimuth))
        n, zero = self.element.n_unknowns, jnp.zeros((), rings.dtype)

        def unsolved_element(element, rings):
            x = jnp.zeros((n,), rings.dtype)
            contacts = jax.eval_shape(lambda: response(element, rings, x))
            return *unloaded_result(rings, x, contacts), zero

        state, energies, magnitude = self.map(unsolved_element, rings)
        travel = () if self.spring is None else zero
        balance = () if self.spring is None else jnp.zeros((), jnp.int32)
        return SolvedRow(rings, magnitude, state, energies, travel, balance)


def shift_motions(
    local: RingMotion, azimuth: Scalar, shift: Float[Array, "2 2"]
) -> RingMotion:
    """Ring motions as an element sees them, with deviations of the raceways added.

    Args:
        local: Ring freedoms in the row's own axes [m, rad].
        azimuth: Azimuth of the element [rad].
        shift: Shift of outer and inner raceway along z and outwards there [m].
    """
    axial, outwards = shift[:, 0], shift[:, 1]
    x, y = outwards * jnp.cos(azimuth), outwards * jnp.sin(azimuth)
    moved = jnp.stack([x, y, axial], axis=1)
    return RingMotion(
        *(ring.at[:3].add(m) for ring, m in zip(local, moved, strict=True))
    )


_CLOSING = len(FREEDOMS) + _UZ
"""Index of uz of the inner ring in both rings' freedoms: it closes a row."""


def _close_axially(local: RingMotion, travel: Scalar) -> RingMotion:
    """Ring freedoms with the inner ring moved along the axis to close the row."""
    return local._replace(inner=local.inner.at[_UZ].add(travel))


def _travel(q, args) -> Scalar:
    """Travel of the spring of a solved row, with its derivatives [m]."""
    row, azimuth, solved = args

    def balance(travel, args):
        q, row, azimuth, solved = args

        local = _close_axially(split_rings(q), travel[0])
        _, force = row._forces(local, azimuth, solved)
        return force[_CLOSING, None] - row.spring.push(travel[0])[1]

    symmetric = row.element.has_potential
    return attach(balance, solved.travel[None], (q, *args), symmetric)[0]


def _with_spring(q, args, order) -> Expansion:
    """Energy of a solved row and its spring, whose travel is condensed."""
    row, azimuth, solved = args
    travel = _travel(q, args)
    local = _close_axially(split_rings(q), travel)
    stored, _, rate = row.spring.push(travel)
    if order < 2:
        energy, force = row._forces(local, azimuth, solved)
        return Expansion(energy + stored, force, ())
    energy, force, stiffness = row._sum_derivatives(local, azimuth, solved)
    own = stiffness[_CLOSING, _CLOSING] + rate
    held = own > 0
    share = jnp.where(held, 1.0 / jnp.where(held, own, 1.0), 0.0)
    taken = jnp.outer(stiffness[:, _CLOSING], stiffness[_CLOSING])
    return Expansion(energy + stored, force, stiffness - share * taken)

"""The mechanics of a bearing whose contact constants are known.

A design becomes a `BearingModel` once (`BearingElement.model`); energy, force and
stiffness at any ring freedoms follow from that, as often as wanted.
"""

import functools
import operator
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Int

from ..design import n_elements
from ..numerics.minimise import AbstractMinimiser
from ..numerics.result import Result, worst
from ..numerics.types import Ring, RingStiffness, Scalar
from .equilibrium import LocalState, Near, settle
from .row import Row, RowModel


class Evaluated(NamedTuple):
    """Energy, force and stiffness of the bearing, and how its elements fared.

    Attributes:
        energy: V [J].
        force: External load that holds the rings (12,) [N, N m].
        stiffness: d(force)/dq (12, 12).
        result: Worst `Result` code of the rolling elements.
        steps: Most steps that one took.
        residual: Largest relative residual of one [1].
        magnitude: Sum of the sizes of what the elements pass to the rings, in which
            the ring force may cancel [N].
        near: `Row.near` of every row.
    """

    energy: Scalar
    force: Ring
    stiffness: RingStiffness
    result: Int[Array, ""]
    steps: Int[Array, ""]
    residual: Scalar
    magnitude: Scalar
    near: tuple[Near, ...]


class BearingModel(eqx.Module):
    """A bearing or set at given speeds, ready to be evaluated.

    Functions of the ring freedoms q (12,) [m, rad], outer ring first; meaning and
    units as of the same functions of `BearingElement`.

    Attributes:
        rows: Its rows.
        equilibrium: Local solver.
        cage_torque: Whether gz feels that it moves the rolling elements.

    Traced: all real numbers. Static: the classes, and `cage_torque`.
    """

    rows: tuple[RowModel, ...]
    equilibrium: AbstractMinimiser
    cage_torque: bool = eqx.field(static=True)

    @property
    def has_potential(self) -> bool:
        """Whether all forces derive from the energy. Static."""
        return all(row.element.has_potential for row in self.rows)

    @eqx.filter_jit
    def solve(
        self,
        q: Ring,
        near: tuple[Near, ...] | None = None,
        turns: bool = False,
    ) -> tuple[Row, ...]:
        """Solve every rolling element at given ring freedoms.

        Args:
            q: Ring freedoms [m, rad].
            near: `Evaluated.near` at ring freedoms near by: fewer steps.
            turns: Whether derivatives see that gz moves the rolling elements; with
                `cage_torque` they always do. Static.

        Raises:
            ValueError: If `q` is not of shape (12,).
        """
        q = jnp.asarray(q, dtype=self.rows[0].part.bearing.pitch_diameter.dtype)
        if q.shape != (12,):
            raise ValueError(
                f"BearingElement: `q` has shape {q.shape}; it must be (12,): outer"
                " ring (ux uy uz gx gy gz), then inner ring."
            )
        known = [None] * len(self.rows) if near is None else near
        return tuple(
            row.solve(q, self.equilibrium, turns or self.cage_torque, one)
            for row, one in zip(self.rows, known, strict=True)
        )

    @eqx.filter_jit
    def energy(self, q: Ring) -> Scalar:
        """Condensed strain energy V(q) [J]."""
        return _total(row.energy() for row in self.solve(q))

    @eqx.filter_jit
    def force(self, q: Ring, turns: bool = False) -> Ring:
        """External load that holds the rings where they are [N, N m].

        Args:
            q: Ring freedoms [m, rad].
            turns: As of `solve`.
        """
        return self._force(self.solve(q, turns=turns), q)

    def _force(self, rows: tuple[Row, ...], q: Ring) -> Ring:
        forces = [row.sum_forces(row.forces()) for row in rows]
        if self.cage_torque:
            forces += [
                row.cage_torque(force, q)
                for row, force in zip(rows, forces, strict=True)
            ]
        return _total(forces)

    @eqx.filter_jit
    def force_or_nan(self, q: Ring) -> Ring:
        """As `force`, but NaN if a rolling element did not converge [N, N m].

        Its derivatives see that gz moves the rolling elements.
        """
        rows = self.solve(q, turns=True)
        converged = _settled(rows)[1] == Result.CONVERGED
        # A product: the derivative of a failed case is then NaN too.
        return self._force(rows, q) * jnp.where(converged, 1.0, jnp.nan)

    @eqx.filter_jit
    def stiffness(self, q: Ring) -> RingStiffness:
        """Tangent stiffness d(force)/dq [N/m, N, N m]."""
        if self.cage_torque:
            return jax.jacfwd(self.force)(q)
        return _total(row.stiffness() for row in self.solve(q))

    @eqx.filter_jit
    def evaluate(self, q: Ring, rows: tuple[Row, ...] | None = None) -> Evaluated:
        """Energy, force and stiffness from one solve of the elements, with its code.

        Args:
            q: Ring freedoms [m, rad].
            rows: The elements solved at `q`, if they are at hand.
        """
        rows = self.solve(q) if rows is None else rows
        if self.cage_torque:
            stiffness = self.stiffness(q)
        else:
            stiffness = _total(row.stiffness() for row in rows)
        states, result = _settled(rows)
        return Evaluated(
            energy=_total(row.energy() for row in rows),
            force=self._force(rows, q),
            stiffness=stiffness,
            result=result,
            steps=jnp.max(jnp.concatenate([s.steps for s in states])),
            residual=jnp.max(jnp.concatenate([s.residual for s in states])),
            magnitude=_total(
                jnp.sum(jnp.abs(row.forces()[:, : row.model.element.n_forces]))
                for row in rows
            ),
            near=tuple(row.near() for row in rows),
        )

    def nothing_near(self) -> tuple[Near, ...]:
        """`Evaluated.near` of which nothing is known yet."""

        def unknown(row):
            zero = jnp.zeros((n_elements(row.part.bearing),), row.part.position.dtype)
            section = row.each(lambda m, phi: m.section(phi), zero)
            motions = row.seen(section, jnp.zeros((12,), zero.dtype))
            n = row.element.n_unknowns
            follow = jnp.repeat(motions[:, None], n, axis=1)
            return Near(jnp.nan + follow[..., 0], follow, motions)

        return tuple(unknown(row) for row in self.rows)


def _settled(rows: tuple[Row, ...]) -> tuple[list[LocalState], Int[Array, ""]]:
    """Solved states of all elements, row by row, and their worst `Result` code."""
    loads = [jnp.max(row.solved.contact_load) for row in rows]
    largest = jnp.max(jnp.stack(loads))
    states = [settle(row.state, largest) for row in rows]
    springs = [r.pressed.result[None] for r in rows if r.pressed is not None]
    return states, worst(jnp.concatenate([*springs, *(s.result for s in states)]))


def _total(parts) -> Any:
    return functools.reduce(operator.add, parts)

"""The mechanics of a bearing whose contact constants are known.

A design becomes a `BearingModel` once (`BearingElement.model`); energy, force and
stiffness at any ring freedoms follow from that, as often as wanted.

V(q) = Σ_rows Σ_elements min_x U(rings(q), x). The rolling elements are solved once
(`solve`); from then on V is a function with known derivatives, the ring force is its
`jax.grad` and the 12x12 stiffness its `jax.hessian`. Where part of the forces has no
potential the same rules give the balance of all forces and its exact Jacobian.
"""

from collections.abc import Callable
from functools import partial
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Int

from ..design.checks import of_shape
from ..numerics.implicit import stop_gradient
from ..numerics.minimise import AbstractMinimiser
from ..numerics.result import Result, worst_code
from ..numerics.types import Number, Reals, Ring, RingStiffness, Scalar
from ..numerics.units import unit, units
from .constants import TETHER
from .equilibrium import ElementStart, accept_small
from .frame import TWELVE
from .rolling_element import split_rings
from .row import Row
from .solved_row import RowResults, SolvedRow

Azimuths = tuple[Reals, ...]
"""Azimuths of the rolling elements of every group of rows [rad]."""


class RowGroup(eqx.Module):
    """Rows of one structure, worked on together.

    Attributes:
        rows: The rows stacked, with a leading axis; of a single one, as it is.
        members: Which rows of the bearing these are. Static.
    """

    rows: Row
    members: tuple[int, ...] = eqx.field(static=True)

    @classmethod
    def group(cls, rows: tuple[Row, ...]) -> "tuple[RowGroup, ...]":
        """Like rows together, in the order of the first of each kind."""
        kinds: list[list[int]] = []
        for k, row in enumerate(rows):
            same = (kind for kind in kinds if _are_alike(rows[kind[0]], row))
            kind = next(same, None)
            if kind is None:
                kinds.append([k])
            else:
                kind.append(k)
        return tuple(cls(_stack([rows[k] for k in kind]), (*kind,)) for kind in kinds)

    def map(self, function: Callable, *arrays: Any) -> Any:
        """Apply function(row, *arrays) to every row of the group.

        Args:
            function: Function of one row.
            *arrays: More arguments, stacked as the rows are.
        """
        if len(self.members) == 1:
            return function(self.rows, *arrays)
        return jax.vmap(function)(self.rows, *arrays)

    def parts(self, stacked: Any) -> list[Any]:
        """Split the result of `map` into one part per row."""
        if len(self.members) == 1:
            return [stacked]
        count = len(self.members)
        return [jax.tree.map(lambda a, k=k: a[k], stacked) for k in range(count)]


def _are_alike(one, other):
    leaves = [jax.tree.leaves(row) for row in (one, other)]
    return jax.tree.structure(one) == jax.tree.structure(other) and all(
        a.shape == b.shape for a, b in zip(*leaves, strict=True)
    )


def _stack(rows):
    if len(rows) == 1:
        return rows[0]
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *rows)


class SolvedElements(NamedTuple):
    """A bearing whose rolling elements are solved at given ring freedoms.

    Attributes:
        azimuths: Their azimuths; with `cage_torque` without the turn by the rings, so
            that energy and force depend on it.
        groups: The solved rows, group by group.
    """

    azimuths: Azimuths
    groups: tuple[SolvedRow, ...]


class BearingResponse(NamedTuple):
    """Energy, force and stiffness of the bearing, and convergence of its elements.

    Attributes:
        energy: V [J].
        force: External load that holds the rings (12,) [N, N m].
        stiffness: d(force)/dq (12, 12).
        result: Worst `Result` code of the rolling elements.
        steps: Most steps that one took.
        residual: Largest relative residual of one [1].
        magnitude: Sum of the sizes of the forces of the elements on the rings, which
            may cancel in the ring force [N].
        near: State from which the next solve near by may start.
    """

    energy: Annotated[Scalar, unit("J")]
    force: Annotated[Ring, units("N", "N m")]
    stiffness: RingStiffness
    result: Int[Array, ""]
    steps: Int[Array, ""]
    residual: Annotated[Scalar, unit("1")]
    magnitude: Annotated[Scalar, unit("N")]
    near: tuple[ElementStart, ...]


class BearingModel(eqx.Module):
    """A bearing or set at given speeds, ready to be evaluated.

    Functions of the ring freedoms q (12,) [m, rad], outer ring first; meaning and
    units as in the same functions of `BearingElement`.

    Attributes:
        groups: Its rows, like ones together.
        equilibrium: Local solver.
        cage_torque: Whether the moment about gz includes the orbit of the elements.

    Traced: all real numbers. Static: the classes, and `cage_torque`.
    """

    groups: tuple[RowGroup, ...]
    equilibrium: AbstractMinimiser
    cage_torque: bool = eqx.field(static=True)

    @property
    def rows(self) -> tuple[Row, ...]:
        """Its rows, in their order."""
        return self.in_order([group.rows for group in self.groups])

    @property
    def has_potential(self) -> bool:
        """Whether all forces derive from the energy. Static."""
        return all(group.rows.element.has_potential for group in self.groups)

    @property
    def sees_difference(self) -> bool:
        """Whether only the motion between the rings counts. Static."""
        elements = [group.rows.element for group in self.groups]
        return all(one.sees_difference for one in elements) and not self.cage_torque

    @property
    def dtype(self) -> Any:
        """Floating type of its numbers."""
        return self.groups[0].rows.ratio.dtype

    def in_order(self, stacked: Any) -> tuple:
        """Values of each row in order, from values stacked group by group."""
        found = {}
        for group, values in zip(self.groups, stacked, strict=True):
            found |= dict(zip(group.members, group.parts(values), strict=True))
        return tuple(found[k] for k in range(len(found)))

    def azimuths(self, q: Ring | None = None) -> Azimuths:
        """Azimuths of the rolling elements, turned by both gz, group by group [rad].

        Args:
            q: Ring freedoms [m, rad]; `None`: rings that have not turned.
        """
        if q is None:
            return tuple(group.rows.azimuth for group in self.groups)
        return tuple(
            group.map(lambda row: row.azimuth + row.turn(q)) for group in self.groups
        )

    @eqx.filter_jit
    def solve(
        self,
        q: Ring,
        near: tuple[ElementStart, ...] | None = None,
        azimuths: Azimuths | None = None,
    ) -> SolvedElements:
        """Solve every rolling element at given ring freedoms.

        Args:
            q: Ring freedoms [m, rad].
            near: `BearingResponse.near` at ring freedoms near by: fewer steps.
            azimuths: Where the elements are; `None`: `azimuths` of q, whose turn by gz
                derivatives see only with `cage_torque`.

        Returns:
            For `energy`, `force`, `stiffness`, `evaluate` and `results` at the same q.

        Raises:
            ValueError: If `q` is not of shape (12,).
        """
        q = self._check_freedoms(q)
        if azimuths is None:
            # Only the turn is held: the azimuths are numbers of the design too.
            azimuths = self.azimuths(q if self.cage_torque else stop_gradient(q))
        starts = [None] * len(self.groups) if near is None else near

        def solve_row(row, azimuth, *near):
            before = near[0] if near else None
            return row.solve(q, azimuth, self.equilibrium, before)

        solved = (
            group.map(solve_row, at, *(() if before is None else (before,)))
            for group, at, before in zip(self.groups, azimuths, starts, strict=True)
        )
        solved = tuple(solved)
        if self.cage_torque:
            azimuths = self._turn(azimuths, q, -1.0)
        return SolvedElements(azimuths, solved)

    def _turn(self, azimuths, q, sign=1.0):
        return tuple(
            group.map(lambda row, at: at + sign * row.turn(q), at)
            for group, at in zip(self.groups, azimuths, strict=True)
        )

    def _places(self, q, solved):
        """Azimuths of solved elements; with `cage_torque` as functions of q."""
        return self._turn(solved.azimuths, q) if self.cage_torque else solved.azimuths

    def _check_freedoms(self, q):
        q = jnp.asarray(q, dtype=self.dtype)
        of_shape("BearingElement", "q", q.shape == (12,), TWELVE, q)
        return q

    @eqx.filter_jit
    def energy(self, q: Ring, solved: SolvedElements | None = None) -> Scalar:
        """Condensed strain energy V(q) [J].

        Args:
            q: Ring freedoms [m, rad].
            solved: `solve` at q, if available.
        """
        return self._energy(*self._solved_at(q, solved))

    def _energy(self, q, solved):
        azimuths = self._places(q, solved)
        parts = [
            jnp.sum(group.map(lambda row, *of_row: row.energy(q, *of_row), *given))
            for group, *given in zip(self.groups, azimuths, solved.groups, strict=True)
        ]
        return sum(parts[1:], start=parts[0])

    @eqx.filter_jit
    def force(self, q: Ring, solved: SolvedElements | None = None) -> Ring:
        """External load that holds the rings where they are [N, N m].

        Args: as in `energy`.
        """
        return jax.grad(self._energy)(*self._solved_at(q, solved))

    @eqx.filter_jit
    def force_or_nan(self, q: Ring, solved: SolvedElements | None = None) -> Ring:
        """Return `force`, or NaN if a rolling element did not converge [N, N m]."""
        q, solved = self._solved_at(q, solved)
        converged = self.convergence(solved)[0] == Result.CONVERGED
        # A product: the derivative of a failed case is then NaN too.
        return self.force(q, solved) * jnp.where(converged, 1.0, jnp.nan)

    @eqx.filter_jit
    def stiffness(self, q: Ring, solved: SolvedElements | None = None) -> RingStiffness:
        """Tangent stiffness d(force)/dq [N/m, N, N m].

        Args: as in `energy`.
        """
        return self._derivatives(*self._solved_at(q, solved))[0]

    @eqx.filter_jit
    def evaluate(
        self,
        q: Ring,
        solved: SolvedElements | None = None,
        least: Number = 0.0,
        fixed_stiffness: bool = False,
    ) -> BearingResponse:
        """Energy, force and stiffness from one solve of the elements, with its code.

        Args: as in `energy` and `convergence`.
            fixed_stiffness: Whether the stiffness has no derivatives, which are two
                thirds of those of a bearing. Static.
        """
        q, solved = self._solved_at(q, solved)
        if fixed_stiffness:
            held: Any = stop_gradient((q, solved))
            stiffness = stop_gradient(self)._derivatives(*held)[0]
            energy, force = jax.value_and_grad(self._energy)(q, solved)
        else:
            stiffness, energy, force = self._derivatives(q, solved)
        result, steps, residual = self.convergence(solved, least)
        return BearingResponse(
            energy=energy,
            force=force,
            stiffness=stiffness,
            result=result,
            steps=steps,
            residual=residual,
            magnitude=self.magnitude(solved),
            near=self.starts(solved),
        )

    def _derivatives(self, q, solved):
        """Stiffness, energy and force; half the work if only `difference` counts."""
        outer, inner = split_rings(q)

        def energy(inner):
            return self._energy(jnp.concatenate([outer, inner]), solved)

        def forces(function, q):
            value, force = jax.value_and_grad(function)(q)
            return force, (value, force)

        if not self.sees_difference:
            whole = partial(forces, lambda q: self._energy(q, solved))
            stiffness, (value, force) = jax.jacfwd(whole, has_aux=True)(q)
            return stiffness, value, force
        k, (value, f) = jax.jacfwd(partial(forces, energy), has_aux=True)(inner)
        return jnp.block([[k, -k], [-k, k]]), value, jnp.concatenate([-f, f])

    def _solved_at(self, q, solved):
        q = self._check_freedoms(q)
        return q, self.solve(q) if solved is None else solved

    def results(self, q: Ring, solved: SolvedElements) -> tuple[RowResults, ...]:
        """Results of the elements of every solved row, with derivatives.

        Args:
            q: Ring freedoms [m, rad].
            solved: `solve` at q.
        """
        azimuths = self._places(q, solved)
        found = [
            group.map(lambda row, *of_row: row.results(q, *of_row), *given)
            for group, *given in zip(self.groups, azimuths, solved.groups, strict=True)
        ]
        return self.in_order(found)

    def convergence(
        self, solved: SolvedElements, least: Number = 0.0
    ) -> tuple[Int[Array, ""], Int[Array, ""], Scalar]:
        """Worst `Result` code, most steps and largest residual of the elements.

        Args:
            solved: The elements.
            least: Load below which none is meant, for idle elements (`accept_small`)
                [N].
        """
        loads = [s.energies.aux.contact_load for s in solved.groups]
        largest = jnp.max(jnp.stack([jnp.max(load) for load in loads]))
        largest = jnp.maximum(largest, least)
        states = [
            accept_small(s.state, largest, group.rows.element.hints.passed_load(load))
            for group, s, load in zip(self.groups, solved.groups, loads, strict=True)
        ]
        codes = [s.result.reshape(-1) for s in states]
        # The balance of a row with its spring has a code too.
        springs = [
            jnp.ravel(c) for s in solved.groups for c in jax.tree.leaves(s.balance)
        ]
        return (
            worst_code(jnp.concatenate([*springs, *codes])),
            jnp.max(jnp.concatenate([s.steps.reshape(-1) for s in states])),
            jnp.max(jnp.concatenate([s.residual.reshape(-1) for s in states])),
        )

    def starts(self, solved: SolvedElements) -> tuple[ElementStart, ...]:
        """Return the state from which a solve near by may start."""
        return tuple(
            group.map(lambda row, s: s.starts(row), state)
            for group, state in zip(self.groups, solved.groups, strict=True)
        )

    def check_near(self, near: Any) -> None:
        """Raise unless `near` is of the shapes that `near` of this model has.

        Args:
            near: As given to `solve`; `None`: nothing.

        Raises:
            ValueError: If it is of another bearing, or of other speeds: rings that turn
                are seen by their elements in another way than rings at rest.
        """
        if near is None:
            return
        wanted = jax.eval_shape(lambda: self.starts(self.unsolved_state()))
        shapes = [[jnp.shape(x) for x in jax.tree.leaves(n)] for n in (near, wanted)]
        if shapes[0] != shapes[1]:
            raise ValueError(
                f"BearingElement: `near` holds arrays of shapes {shapes[0]}; here they"
                f" must be {shapes[1]}. It must come from this bearing, with a `speed`"
                " if there is one now, else without."
            )

    def magnitude(self, solved: SolvedElements) -> Scalar:
        """Sum of the sizes of the forces of solved elements on the rings [N]."""
        sizes = []
        for group, state in zip(self.groups, solved.groups, strict=True):
            count = group.rows.element.n_displacements
            sizes.append(jnp.sum(jnp.abs(state.energies.gradient[..., :count])))
        return sum(sizes[1:], start=sizes[0])

    def is_apart(self, solved: SolvedElements) -> Bool[Array, ""]:
        """Whether no rolling element contacts both rings, so that they are not coupled.

        Turning elements press the outer ring alone; what stiffness is left then is
        that of the springs which hold them in place.
        """
        # Contacts are stiffer than their tethers by 1e14; some round-off is left.
        left = 1e4 * jnp.finfo(self.dtype).eps / TETHER
        apart = []
        for group, state in zip(self.groups, solved.groups, strict=True):
            element, stiffness = group.rows.element, state.energies.hessian
            width = stiffness.shape[-1] // (1 if element.sees_difference else 2)
            of_inner = jnp.diagonal(stiffness, axis1=-2, axis2=-1)[..., -width:]
            along = of_inner[..., : element.n_displacements]
            apart.append(jnp.all(along <= left * jnp.max(element.tether)))
        return jnp.all(jnp.stack(apart))

    def of_elements(self, function: Callable) -> list[Any]:
        """Apply function(element) to the elements of every group of rows.

        Like elements count once.
        """
        return [group.map(lambda row: row.map(function)) for group in self.groups]

    def unsolved_state(self) -> SolvedElements:
        """Return the unsolved bearing; its `near` holds no information."""
        groups = (group.map(lambda row: row.unsolved_state()) for group in self.groups)
        return SolvedElements(self.azimuths(), tuple(groups))

    def follow_azimuths(self, q: Ring, solved: SolvedElements) -> SolvedElements:
        """Solved elements whose azimuths follow both gz and the design in derivatives.

        Args:
            q: Ring freedoms at which they were solved [m, rad].
            solved: The elements.
        """
        # With `cage_torque` the turn is added wherever they are used (`_places`).
        azimuths = self.azimuths(None if self.cage_torque else q)
        return solved._replace(azimuths=azimuths)

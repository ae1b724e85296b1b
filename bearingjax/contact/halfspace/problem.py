"""A contact of two half-spaces: gap, and the given load, approach and tilt."""

from typing import Annotated, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ...numerics.types import Scalar
from ...numerics.units import unit
from .grid import Grid
from .influence import AbstractInfluence


class Problem(eqx.Module):
    """Pressure p ≥ 0 that leaves no overlap: u(p) + gap - rigid ≥ 0, zero where p > 0.

    The rigid motion is an approach and a tilt, approach + tilt·y. Of each either the
    motion is given or its force: load = ∫ p dA, moment = ∫ p y dA.

    Attributes:
        influence: Influence of pressure on the grid.
        gap: Distance of the bodies as they touch, at each cell (m, n) [m].
        load: Load [N], or `None` if the approach is given.
        approach: Approach [m], or `None` if the load is given.
        moment: Moment about the middle y = 0 [N m], or `None` if the tilt is given.
        tilt: Tilt [rad], or `None` if the moment is given.

    Traced: all fields.
    Source: Johnson, Contact Mechanics (1985), section 5.9, as a minimum: Kalker, J.
        Inst. Maths Applics 20 (1977).
    """

    influence: AbstractInfluence
    gap: Float[Array, "m n"]
    load: Scalar | None
    approach: Scalar | None
    moment: Scalar | None
    tilt: Scalar | None

    @property
    def grid(self) -> Grid:
        """The cells."""
        return self.influence.grid

    @property
    def given_gap(self) -> Float[Array, "m n"]:
        """Gap less the given part of the rigid motion [m]."""
        rest = self.gap
        if self.approach is not None:
            rest = rest - self.approach
        if self.tilt is not None:
            rest = rest - (self.tilt * self.grid.y)[None]
        return rest

    @property
    def lever(self) -> Scalar:
        """Half of the grid's length, by which moments count as forces [m]."""
        edges = self.grid.edges
        return 0.5 * (edges[-1] - edges[0])

    @property
    def modes(self) -> Float[Array, "k m n"]:
        """Unknown rigid motions, none to two: 1 and y/lever."""
        fields = []
        if self.load is not None:
            fields.append(jnp.ones_like(self.gap))
        if self.moment is not None:
            fields.append(
                jnp.broadcast_to((self.grid.y / self.lever)[None], self.gap.shape)
            )
        if not fields:
            return jnp.zeros((0, *self.gap.shape), self.gap.dtype)
        return jnp.stack(fields)

    @property
    def weighted_modes(self) -> Float[Array, "k m n"]:
        """`modes` times the area of the cells [m²]."""
        return self.grid.area[None] * self.modes

    @property
    def goal(self) -> Float[Array, " k"]:
        """Generalised load that the pressure must have in each of `modes` [N]."""
        goals = []
        if self.load is not None:
            goals.append(self.load)
        if self.moment is not None:
            goals.append(self.moment / self.lever)
        return jnp.stack(goals) if goals else jnp.zeros((0,), self.gap.dtype)

    def motion(self, coefficients: Float[Array, " k"]) -> tuple[Scalar, Scalar]:
        """Approach [m] and tilt [rad] from those of `modes` [m]."""
        left = list(coefficients)
        approach = left.pop(0) if self.approach is None else self.approach
        tilt = left.pop(0) / self.lever if self.tilt is None else self.tilt
        return approach, tilt


class PressureSolution(NamedTuple):
    """Result of a pressure solver.

    Attributes:
        pressure: At every cell kept (m, n) [Pa].
        touching: Which cells are in contact (m, n).
        rigid: Coefficients of the problem's `modes` (k,) [m].
        residual: Largest gap inside the contact, or overlap outside, over the mean
            displacement of the loaded surface [1].
        steps: Iterations.
        result: `Result` code.
    """

    pressure: Annotated[Float[Array, "m n"], unit("Pa")]
    touching: Bool[Array, "m n"]
    rigid: Annotated[Float[Array, " k"], unit("m")]
    residual: Annotated[Scalar, unit("1")]
    steps: Int[Array, ""]
    result: Int[Array, ""]

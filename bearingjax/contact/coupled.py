"""Slices of a roller that press on each other: between slices and the half-space.

Independent slices do not interact, so that a straight roller has the same line load at
its ends as in its middle. Here the loads of all slices displace each slice.
Far from a loaded line of half width b its displacement does not depend on b; near to it
Hertz's plane contact holds. Joined with a smoothing length c,

    u(y) = 1/(π E*)·[∫ q(y')/sqrt((y-y')² + c²) dy' + q·(1 + ln(c²/(ρ q/(π E*))))],

which for a long uniform load is Lundberg's approach, whatever c is. Loads and
approaches derive from one energy: the largest over q ≥ 0 of work less strain energy.

Source: the idea: Teutsch & Sauer, J. Tribol. 126 (2004) (alternative slicing
    technique); Lundberg, Forschung Ing.-Wes. 10 (1939). The joint is our own: mean
    potentials of a semi-ellipse, so that b is eliminated (Hertz's is stationary).
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ..design.checks import count
from ..design.material import Material
from ..numerics.implicit import attach_by, stop_gradient
from ..numerics.lapack import solve_any
from ..numerics.quadrature import AbstractQuadrature
from ..numerics.types import Reals, Scalar
from .line import AbstractLineLaw, Palmgren
from .line_contact import AbstractLineContact, LineContact, Response

_SMOOTHING = 0.035
"""c over the relative radius ρ: Hertz's half width is 2c at p = 0.035 E*, 4 GPa of
steel. Beyond, a slice's own compliance no longer falls."""

MOST_SLICES = 1000
"""Most slices: 8 MB of matrix for each contact."""

_STEPS = 60
_SAMPLES, _OF_A_TABLE = 4, 64
"""Points of a slice at which a profile is averaged."""


class CoupledSlices(AbstractLineLaw):
    """Slices that press on each other, in place of independent ones.

    Takes no constant and no `quadrature`: it follows from materials and curvature.

    Attributes:
        slices: Number of slices, equally long.

    Static: all fields.
    Fails: Loads that are not found in 60 steps are NaN, and the element says
        `NON_FINITE`; seven steps are the most seen.
    Valid: Slices longer than the contact is wide; at sharp ends the line load grows
        with the number of slices, as on a half-space. A profile counts by its mean
        over a slice: waves of a measured one that are shorter are evened out.
    """

    slices: int = eqx.field(static=True, default=24)

    def __check_init__(self):
        count(self, "slices", self.slices, least=4)
        if self.slices > MOST_SLICES:
            raise ValueError(
                f"CoupledSlices: `slices` is {self.slices}; it must be at most"
                f" {MOST_SLICES}: each contact has a full matrix of them, and a slice"
                " is to be longer than the contact is wide."
            )

    def constant(self, roller: Material, ring: Material, length: Scalar) -> Scalar:
        # Only a measure of stiffness here.
        return Palmgren().constant(roller, ring, length)

    def contact(self, line: Any, radius: Callable, modulus: Scalar) -> Any:
        at = 0.5 * line.length * _middles(self.slices, line.length.dtype)
        return CoupledContact(line, radius(at), modulus)


class _Table(NamedTuple):
    """Constants of a design: mean drop, smoothed influence [1], limit of q/(π E*)."""

    drop: Array
    matrix: Array
    limit: Array


class CoupledContact(AbstractLineContact):
    """One raceway contact of one roller, in coupled slices.

    Attributes:
        line: Its profiles and length.
        radius: Radius of relative curvature at the middle of each slice (slice,) [m].
        modulus: Contact modulus E* [Pa].

    Traced: all fields.
    """

    line: LineContact
    radius: Float[Array, " slice"]
    modulus: Scalar

    @property
    def protruding(self) -> bool:
        return self.line.protruding

    def drop(self, xi: Reals) -> Reals:
        return self.line.drop(xi)

    def approximate_load(self, approach: Scalar) -> Scalar:
        # Of the logarithm that grows with the length, a usual value.
        return jnp.pi * self.modulus * self.line.length * approach / 10.0

    def table(self, quadrature: AbstractQuadrature) -> Any:
        n, dtype = self.radius.shape[0], self.line.length.dtype
        count = _OF_A_TABLE if self.line.has_table else _SAMPLES
        nodes, weights = np.polynomial.legendre.leggauss(count)
        at = _middles(n, dtype)[None] + jnp.asarray(nodes / n, dtype)[:, None]
        drop = jnp.asarray(0.5 * weights, dtype) @ self.drop(at)
        smoothing = _SMOOTHING * self.radius[n // 2]
        return _Table(
            drop,
            _influence(n, self.line.length / n, smoothing),
            smoothing**2 / self.radius,
        )

    def integrals(
        self, table: Any, quadrature: AbstractQuadrature, a: Scalar, b: Scalar
    ) -> Response:
        xi = _middles(table.drop.shape[0], a.dtype)
        loads = _solve_slices(table, a, b)
        held, curved = stop_gradient(loads) > 0, _curvature(table, loads)
        columns = jnp.stack([jnp.ones_like(xi), xi], axis=1)
        inside = jnp.where(held[:, None], columns, 0.0)
        bent = _divide(_held_stiffness(table.matrix, curved, held), inside)
        aa, ab, bb = (inside[:, i] @ bent[:, k] for i, k in ((0, 0), (0, 1), (1, 1)))
        given = a + b * xi - table.drop
        scale = jnp.pi * self.modulus * self.line.length / table.drop.shape[0]
        return Response(
            scale * (loads @ given - _strain(table, loads)),
            scale * (loads @ columns),
            scale * jnp.stack([aa, ab, bb]),
        )

    def contact_state(self, table: Any, a: Scalar, b: Scalar) -> Any:
        return jnp.pi * self.modulus * _solve_slices(table, a, b)

    def load(self, carried: Any, xi: Float[Array, " point"]) -> Float[Array, " point"]:
        return jnp.interp(xi, _middles(carried.shape[0], xi.dtype), carried)

    def summits(
        self, carried: Any, scan: Float[Array, " scan"], weight: Float[Array, " scan"]
    ) -> Float[Array, " place"]:
        # Between the middles of slices loads are interpolated.
        middles = _middles(carried.shape[0], scan.dtype)
        return jnp.concatenate([scan[:1], scan[-1:], middles])


def _middles(n, dtype):
    """Middles ξ of n slices of [-1, 1]."""
    return jnp.asarray((2.0 * np.arange(n) + 1.0) / n - 1.0, dtype)


def _influence(n, length, smoothing):
    """Mean over one slice of ∫ dy/sqrt(d² + c²) over another, (n, n) [1]."""
    ends = length * jnp.arange(-1, n + 1, dtype=length.dtype)
    # Twice integrated.
    r = jnp.sqrt(ends**2 + smoothing**2)
    integral = ends * jnp.arcsinh(ends / smoothing) - r
    lags = (integral[2:] - 2.0 * integral[1:-1] + integral[:-2]) / length
    place = np.arange(n)
    return lags[np.abs(place[:, None] - place[None])]


def _own_approach(table, loads):
    """Approach of a slice by its own load, added to the smoothed influence [m]."""
    some = jnp.minimum(loads, table.limit)
    loaded = some > 0
    ratio = table.limit / jnp.where(loaded, some, 1.0)
    return some * jnp.where(loaded, 1.0 + jnp.log(ratio), 0.0)


def _curvature(table, loads):
    """Derivative of `_own_approach`, zero above the limit."""
    below = (loads > 0) & (loads < table.limit)
    return jnp.where(below, jnp.log(table.limit / jnp.where(below, loads, 1.0)), 0.0)


def _strain(table, loads):
    """Strain energy, over π E* and the length of a slice [m²]."""
    some = jnp.minimum(loads, table.limit)
    more = loads - some
    own = 0.5 * some * _own_approach(table, some) + 0.25 * some**2 + table.limit * more
    return jnp.sum(own) + 0.5 * loads @ (table.matrix @ loads)


def _held_stiffness(matrix, curvature, held):
    """Stiffness matrix of the slices that are held, the identity for the others."""
    both = held[:, None] & held[None]
    n = matrix.shape[0]
    own = jnp.where(held, curvature, 1.0)
    return jnp.where(both, matrix, 0.0) + own[:, None] * jnp.eye(n, dtype=matrix.dtype)


def _divide(matrix, right):
    return solve_any(matrix, right, "positive")


def _remaining_overlap(table, loads, given):
    """Overlap that the loads leave, negative: still overlapping [m]."""
    return table.matrix @ loads + _own_approach(table, loads) - given


class _State(NamedTuple):
    loads: Array
    rest: Array
    energy: Array
    residual: Array
    damping: Array
    steps: Array


def _solve_slices(table, a, b):
    """Loads q/(π E*) ≥ 0 of the slices (slice,) [m]; NaN if they did not converge."""
    loads = _newton(*stop_gradient((table, a, b)))

    def balance(loads, args):
        table, a, b, held = args
        given = a + b * _middles(loads.shape[0], loads.dtype) - table.drop
        return jnp.where(held > 0, _remaining_overlap(table, loads, given), loads)

    def correction(_, loads, change, args):
        table, _, _, held = args
        matrix = _held_stiffness(table.matrix, _curvature(table, loads), held > 0)
        return -_divide(matrix, change)

    held = jnp.where(loads > 0, 1.0, 0.0)
    return attach_by(balance, loads, (table, a, b, held), correction)


def _newton(table, a, b):
    """Newton's method on the loaded slices, projected, with the energy falling.

    Source: Bertsekas, SIAM J. Control Optim. 20 (1982).
    """
    xi = _middles(table.drop.shape[0], a.dtype)
    given = a + b * xi - table.drop
    size = jnp.max(jnp.maximum(given, 0.0))
    goal = (1e-11 if a.dtype == jnp.float64 else 1e-5) * size

    def state(loads, damping, steps):
        rest = _remaining_overlap(table, loads, given)
        off = jnp.where(loads > 0, jnp.abs(rest), jnp.maximum(-rest, 0.0))
        energy = _strain(table, loads) - loads @ given
        return _State(loads, rest, energy, jnp.max(off), damping, steps)

    def step(old):
        free = (old.loads > 0) | (old.rest < 0)
        # Where a slice enters, the logarithm has no slope yet.
        near = jnp.where(old.loads > 0, old.loads, 1e-3 * jnp.max(old.loads))
        matrix = _held_stiffness(table.matrix, _curvature(table, near), free)
        down = _divide(matrix, jnp.where(free, old.rest, 0.0))
        new = state(
            jnp.maximum(old.loads - old.damping * down, 0.0),
            jnp.minimum(4.0 * old.damping, 1.0),
            old.steps + 1,
        )
        better = (new.energy < old.energy) | (new.residual < old.residual)
        stay = old._replace(damping=0.25 * old.damping, steps=old.steps + 1)
        return jax.tree.map(lambda x, y: jnp.where(better, x, y), new, stay)

    def continues(state):
        return (state.residual > goal) & (state.steps < _STEPS)

    reach = jnp.sum(table.matrix, axis=1) + 3.0
    one = jnp.ones((), a.dtype)
    begin = state(jnp.maximum(given, 0.0) / reach, one, jnp.asarray(0))
    end = lax.while_loop(continues, step, begin)
    # Not "> goal": NaN stays NaN.
    return jnp.where(end.residual <= goal, end.loads, jnp.nan)

"""Search for a motion of balls or rollers that is periodic from orbit to orbit.

It is an implicit integration in time with steps that grow as it calms down: it begins
as the motion would, from pure rolling, and ends as Newton's method.
"""

import abc
import dataclasses
from typing import Annotated, Any, ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ...design.bearing_set import pitch_radius
from ...element.inertia import Speed
from ...element.solved_row import RowResults, SolvedRow
from ...numerics.compiled import batched_loop
from ...numerics.implicit import attach_by, stop_gradient, unless_failed
from ...numerics.lapack import solve_any
from ...numerics.linear import solve
from ...numerics.result import Result
from ...numerics.types import Reals, Scalar
from ...numerics.units import unit, units
from ...statics.balance import Balance
from ..contact_loads import orbiting_model, ring_forces
from ..model import SkidModel
from .steady_results import SteadyMotion

_STEPS = 300
_TOLERANCE = {"float64": 1e-10, "float32": 1e-3}
_FIRST = 1e-5
"""First step in time [s]."""
NO_TRACTION = 1e-9
"""Traction over load below which it counts as zero [1]."""
_RING = 6
"""Unknowns of the ring."""
_FEW = 4
"""Most further unknowns of a system that is solved by explicit elimination."""

Unknowns = Float[Array, " unknown"]
"""All unknowns: those of the places, the common ones, and the ring's."""
Own = Float[Array, " k"]
Common = Float[Array, " c"]
"""Unknowns of one place, and those that all places share."""


class AbstractOrbit(eqx.Module):
    """Equations of a motion that is periodic from orbit to orbit, and of the ring.

    Unknowns are those of each place along the orbit, counted from pure rolling, then
    those that all places share, then those of the balance of the ring. Where oil is
    stiff, slips are smaller than the round-off of the speeds: so they are no
    differences of speeds. Centrifugal forces are those of the actual orbit, so that
    contact loads and the position of the ring are part of the equations.

    Attributes:
        model: The bearing, its oil and its surroundings.
        speed: Ring speeds.
        carried: Ring speeds of the loads: their pure rolling gives centrifugal forces.
        follows: Whether the loads follow the orbit beyond that. Static.
        pressed: 1 where something is pressed between the rings, 0 where not: balls or
            rollers then come to rest, and without the centrifugal force of their orbit
            nothing would hold the ring in its place [1].
        balance: Balance of the ring.
        azimuth: The places, spread evenly (place,) [rad].
        density: Density of the oil [kg/m³].
        along: Matrix of derivatives along the orbit (place, place) [1].
        least: Sum of the contact loads in pure rolling, the scale of contact loads
            that vanish [N].
        start: Unknowns to begin with (unknown,) [rad/s, m].
    """

    model: SkidModel
    speed: Speed
    carried: Speed
    follows: bool = eqx.field(static=True)
    pressed: Scalar
    balance: Balance
    azimuth: Float[Array, " place"]
    density: Scalar
    along: Float[Array, "place place"]
    least: Scalar
    start: Unknowns

    n_own: ClassVar[int]
    """Unknowns of each place."""
    n_common: ClassVar[int]
    """Unknowns that all places share, each with an equation that is a mean over them.
    """

    @abc.abstractmethod
    def excess(self, own: Float[Array, "place k"], common: Common) -> Reals:
        """Return orbital speeds relative to pure rolling (place,) or () [rad/s]."""

    @abc.abstractmethod
    def bodies_of(self, row: RowResults) -> tuple[Any, Array]:
        """Return the balls or rollers of a solved row, and the values of the unknowns
        in pure rolling (element, k) [rad/s].
        """

    def motion(self, body: Any, rolls: Own, own: Own) -> Own:
        """Return the speeds at one place, whose derivatives `local` takes [rad/s].

        Args:
            body, rolls: From `bodies_of`.
            own: Unknowns [rad/s].
        """
        return rolls + own

    @abc.abstractmethod
    def local(
        self, body: Any, rolls: Own, own: Own, slope: Own, common: Common
    ) -> tuple[Float[Array, " k+c"], Scalar]:
        """Return residual forces of one place [N], and the size of those that cancel.

        Args:
            body, rolls: From `bodies_of`.
            own, common: Unknowns [rad/s].
            slope: Derivative of the motion along the orbit.
        """

    @abc.abstractmethod
    def inertia(self) -> Float[Array, "unknown unknown"]:
        """Return the mass matrix of the forces; the ring has no mass [kg m]."""

    @abc.abstractmethod
    def describe(self, y: Unknowns, solved: SolvedRow, **fields: Any) -> SteadyMotion:
        """Return the results of the steady motion.

        Args:
            y: Unknowns that fulfil the equations (unknown,) [rad/s, m].
            solved: Their row, solved there.
            **fields: Fields that do not follow from them.
        """

    def parts(self, y: Unknowns) -> tuple[Array, Array, Array]:
        """Split unknowns: of places (place, k), common (c,) and of the ring (6,)."""
        places = self.azimuth.shape[0]
        end = places * self.n_own
        own, common, ring = jnp.split(y, [end, end + self.n_common])
        return own.reshape(places, self.n_own), common, ring

    @property
    def solved_at(self) -> tuple[Array, np.ndarray, np.ndarray]:
        """Azimuths at which the contacts are solved: the places, or of a single place
        that stands for all, all balls or rollers (element,) [rad]; which of them are
        the balls or rollers of the ring's balance; and their places."""
        balls, places = self.model.bearing.n_elements, self.azimuth.size
        if places > 1:
            stand = np.arange(balls) * places // balls
            return self.azimuth, stand, stand
        turn = jnp.asarray(2.0 * np.pi * np.arange(balls) / balls, self.azimuth.dtype)
        return self.azimuth + turn, np.arange(balls), np.zeros(balls, int)

    def _orbiting_model(self, own, common, ring):
        """Return the bearing at its orbital speed, and its ring freedoms."""
        excess = jnp.zeros_like(own[0, 0])
        if self.follows:
            excess = self.pressed * self.excess(own, common)
        if excess.ndim:
            excess = jnp.broadcast_to(excess, self.solved_at[0].shape)
        bearing = orbiting_model(self.model.element, self.carried, excess)
        return bearing, self.balance.ring_freedoms(ring)

    def _bodies_at(self, row, q, solved):
        """Return balls or rollers from `bodies_of`, and the row at its equilibrium."""
        found = row.results(q, self.solved_at[0], solved)
        places = self.azimuth.size
        return jax.tree.map(lambda a: a[:places], self.bodies_of(found)), found

    def bodies(self, y: Unknowns, solved: SolvedRow) -> tuple[Any, Array]:
        """Return balls or rollers at all places, and pure rolling, from `bodies_of`.

        Args:
            y: Unknowns (unknown,) [rad/s, m].
            solved: Their row, solved there.
        """
        bearing, q = self._orbiting_model(*self.parts(y))
        return self._bodies_at(bearing.rows[0], q, solved)[0]

    def _forces(self, own, common, ring, sloped=None):
        """Return residual forces of all places, forces on the ring, and the motion;
        then the sizes of forces at the places and on the ring [N], and the row."""
        bearing, q = self._orbiting_model(own, common, ring)
        (row,), (azimuth, stand, _) = bearing.rows, self.solved_at
        solved = row.solve(q, azimuth, bearing.equilibrium, None)
        pulls = ring_forces(row, q, azimuth, solved)[stand, self.balance.moving_slice]
        pulls = jax.vmap(self.balance.free_part)(pulls)
        (bodies, rolls), found = self._bodies_at(row, q, solved)
        motion = jax.vmap(self.motion)(bodies, rolls, own)
        slope = self.along @ (motion if sloped is None else stop_gradient(motion))
        slope = slope if sloped is None else slope + sloped[None]
        each = jax.vmap(self.local, (0, 0, 0, 0, None))
        out, sizes = each(bodies, rolls, own, slope, common)
        loads = jnp.sum(found.contact_load[stand])
        return (out, pulls, motion), ((jnp.max(sizes), loads), solved)

    def _assemble(self, out, pulls, ring):
        k, balance = self.n_own, self.balance
        held = (1.0 - balance.free) * ring - balance.held_values
        left = balance.free_part(balance.load) - jnp.sum(pulls, axis=0) - held
        return jnp.concatenate(
            [out[:, :k].reshape(-1), jnp.mean(out[:, k:], axis=0), left]
        )

    def residual(self, y: Unknowns) -> Unknowns:
        """Return the residual forces [N].

        Args:
            y: Unknowns (unknown,) [rad/s, m].
        """
        own, common, ring = self.parts(y)
        (out, pulls, _), _ = self._forces(own, common, ring)
        return self._assemble(out, pulls, ring)

    def evaluate(self, y: Unknowns) -> "ResidualSlopes":
        """Return `residual` with its Jacobian.

        Args:
            y: Unknowns (unknown,) [rad/s, m].
        """
        own, common, ring = self.parts(y)
        (places, k), c = own.shape, common.size

        # Forces at a place depend on its own unknowns and on the shared ones:
        # all places are moved at once.
        def derivatives_along(way):
            here, sloped, shared, turned = jnp.split(way, [k, 2 * k, 2 * k + c])
            now = own + here[None], common + shared, ring + turned
            forces, other = self._forces(*now, sloped)
            return forces, (forces, other)

        way = jnp.zeros(2 * k + c + _RING, y.dtype)
        slopes, (forces, other) = jax.jacfwd(derivatives_along, has_aux=True)(way)
        (out, pulls, _), (sizes, solved) = forces, other
        of_places, of_ring, motion = slopes
        here, sloped, shared = jnp.split(of_places, [k, 2 * k], axis=2)
        by_own, by_shared = motion[:, :, :k], motion[:, :, 2 * k :]
        # Along the orbit a place feels what the others do.
        across = jnp.einsum("kl,kij,ljm->kilm", self.along, sloped, by_own)
        eye = jnp.eye(places, dtype=y.dtype)
        whole = across + jnp.einsum("kl,kij->kilj", eye, here)
        whole = whole.reshape(places, k + c, places * k)
        behind = jnp.einsum("kl,ljm->kjm", self.along, by_shared)
        shared = shared + jnp.einsum("kij,kjm->kim", sloped, behind)
        rows = jnp.concatenate([whole, shared], axis=2)
        means = jnp.mean(rows[:, k:], axis=0)
        # The ring, by the places where balls or rollers stand.
        stand = jnp.zeros((_RING, places, k), y.dtype)
        stand = stand.at[:, self.solved_at[2]].add(
            -jnp.moveaxis(of_ring[:, :, :k], 0, 1)
        )
        turned = -jnp.sum(of_ring[:, :, 2 * k :], axis=0)
        turned = turned.at[:, c:].add(-jnp.diag(1.0 - self.balance.free))
        last = jnp.concatenate([stand.reshape(_RING, -1), turned], axis=1)
        # Tractions below `NO_TRACTION` of the loads count as none.
        loads = jnp.maximum(sizes[1], self.least)
        most = jnp.maximum(sizes[0], NO_TRACTION * loads)
        largest = jnp.full(y.size - _RING, most)
        largest = jnp.concatenate([largest, jnp.full(_RING, loads)])
        return ResidualSlopes(
            self._assemble(out, pulls, ring),
            jnp.maximum(largest, jnp.finfo(y.dtype).tiny),
            jnp.concatenate([rows[:, :k].reshape(-1, y.size), means, last]),
            solved,
        )


class ResidualSlopes(NamedTuple):
    """Equations of an orbit at a motion.

    Attributes:
        out: Forces out of balance (unknown,) [N].
        sizes: Scale of each (unknown,) [N].
        jacobian: Jacobian of the forces (unknown, unknown) [N s/rad, N/m].
        solved: The row in equilibrium there.
    """

    out: Annotated[Unknowns, unit("N")]
    sizes: Annotated[Unknowns, unit("N")]
    jacobian: Annotated[Float[Array, "unknown unknown"], units("N s/rad", "N/m")]
    solved: SolvedRow


class OrbitSolution(NamedTuple):
    """Result of a search.

    Attributes:
        y: Unknowns (unknown,) [rad/s, m].
        residual: Largest force out of balance, relative to the tractions; of the ring,
            to the contact loads [1].
        steps: Steps of the search.
        result: `Result` code.
        solved: The row in equilibrium there.
    """

    y: Annotated[Unknowns, units("rad/s", "m")]
    residual: Annotated[Scalar, unit("1")]
    steps: Int[Array, ""]
    result: Int[Array, ""]
    solved: SolvedRow


def search(orbit: AbstractOrbit) -> OrbitSolution:
    """Find the periodic motion; without derivatives, see `with_derivatives`.

    Fails: `STEP_LIMIT`, `NON_FINITE`.
    """
    loop = batched_loop.Loop(_init, _step, _terminate, _finish, _trivial_result)
    few = orbit.start.size <= _FEW + _RING
    return OrbitSolution(
        *batched_loop.run(loop, stop_gradient(orbit), 16 if few else 2)
    )


def with_derivatives(
    orbit: AbstractOrbit, y: Unknowns, result: Int[Array, ""]
) -> Unknowns:
    """Return the unknowns found, with derivatives; NaN if the search failed.

    Args:
        orbit: The equations.
        y: From `search` (unknown,) [rad/s, m].
        result: `Result` code of all that was solved.
    """
    return unless_failed(
        lambda orbit: attach_by(_residual, y, orbit, _correction),
        (orbit,),
        result == int(Result.CONVERGED),
    )


def derivatives(count: int) -> np.ndarray:
    """Return the matrix of d/dφ of the trigonometric interpolant on an even grid."""
    if count == 1:
        return np.zeros((1, 1))
    k = np.arange(count)
    apart = k[:, None] - k[None, :]
    angle = np.pi * apart / count
    with np.errstate(divide="ignore"):
        ends = 1.0 / (np.tan(angle) if count % 2 == 0 else np.sin(angle))
    return np.where(apart == 0, 0.0, 0.5 * (-1.0) ** apart * ends)


class _State(NamedTuple):
    y: Unknowns
    at: ResidualSlopes
    step: Scalar
    steps: Int[Array, ""]


def _solve(matrix, right):
    """Solve with a matrix of positive diagonal; free unknowns do not move."""
    few = right.shape[0] - _RING
    if few <= _FEW:
        # The ring by itself, then the speeds with a ring that follows them.
        a, b = matrix[:few, :few], matrix[:few, few:]
        c, d = matrix[few:, :few], matrix[few:, few:]
        follows, alone = solve(d, c, False), solve(d, right[few:], False)
        speeds = solve(a - b @ follows, right[:few] - b @ alone, False)
        return jnp.concatenate([speeds, alone - follows @ speeds])
    held = jnp.any(matrix != 0, axis=1)
    return solve_any(matrix + jnp.diag(jnp.where(held, 0.0, 1.0)), right)


def _init(orbit):
    y, n = orbit.start, orbit.start.size
    none = jnp.zeros_like(y), jnp.ones_like(y), jnp.zeros((n, n), y.dtype)
    nothing = ResidualSlopes(*none, _unsolved_motion(orbit))
    return _State(y, nothing, jnp.full_like(y[0], _FIRST), jnp.full((), -1, jnp.int32))


def _step(orbit, state):
    first, slopes = state.steps < 0, state.at.jacobian
    # The ring is slow too, where nearly nothing holds it.
    ring = np.arange(state.y.size - _RING, state.y.size)
    hold = orbit.least / pitch_radius(orbit.model.bearing)
    slow = _FIRST * jnp.maximum(jnp.max(jnp.abs(slopes[ring, ring])), hold)
    inertia = orbit.inertia().at[ring, ring].add(slow)
    move = _solve(inertia / state.step - slopes, state.at.out)
    y = jnp.where(first, state.y, state.y + move)
    at = orbit.evaluate(y)
    # Relative, or round-off of large tractions would hide a ring out of its place.
    before, after = (_size(each.out / state.at.sizes) for each in (state.at, at))
    ratio = before / jnp.maximum(after, jnp.finfo(y.dtype).tiny)
    taken = first | (ratio > 0.5)
    longer = state.step * jnp.clip(2.0 * ratio, 1.5, 10.0)
    step = jnp.where(taken, longer, 0.2 * state.step)
    new = _State(y, at, jnp.where(first, state.step, step), state.steps + 1)
    kept = state._replace(step=step, steps=state.steps + 1)
    return batched_loop.Either(taken, new, kept)


def _size(out):
    return jnp.max(jnp.abs(out))


def _is_done(state):
    at, dtype = state.at, state.y.dtype
    goal = _TOLERANCE[str(dtype)] * at.sizes
    # Round-off of the unknowns, in the stiffness of the films, and of the loads.
    noise = jnp.max(jnp.abs(at.jacobian[:-_RING]) @ jnp.abs(state.y)) + at.sizes[-1]
    goal = goal.at[:-_RING].add(8.0 * jnp.finfo(dtype).eps * noise)
    return jnp.all(jnp.abs(at.out) <= goal)


def _terminate(orbit, state):
    finite = jnp.isfinite(state.step) & jnp.all(jnp.isfinite(state.y))
    going = ~_is_done(state) & finite & (state.steps < _STEPS)
    return (state.steps >= 0) & ~going


def _finish(orbit, state):
    finite = jnp.all(jnp.isfinite(state.y)) & jnp.isfinite(_size(state.at.out))
    result = jnp.where(_is_done(state), int(Result.CONVERGED), int(Result.STEP_LIMIT))
    result = jnp.where(finite, result, int(Result.NON_FINITE)).astype(jnp.int32)
    at = state.at
    return state.y, _size(at.out / at.sizes), state.steps, result, at.solved


def _trivial_result(orbit):
    y, none = orbit.start, jnp.zeros((), jnp.int32)
    return y, jnp.zeros_like(y[0]), none, none, _unsolved_motion(orbit)


def _unsolved_motion(orbit):
    (row,) = orbit.model.element.model(orbit.carried).rows
    return dataclasses.replace(row, azimuth=orbit.solved_at[0]).unsolved_state()


def _residual(y, orbit):
    return orbit.residual(y)


def _correction(of_y, y, change, orbit):
    # Traction resists: it is the negative Jacobian whose diagonal is positive.
    return _solve(-orbit.evaluate(y).jacobian, change)

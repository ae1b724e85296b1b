"""Branches of periodic orbits over the frequency of their excitation.

A branch is followed point by point: predict along it, correct across it with Newton's
method, take the point or halve the step. All of it is one compiled loop, the same for
every frequency and step; it batches over systems with `vmap`.

A point is taken only if the equations are solved there, the branch has turned by no
more than `turn` since the last point, and the correction is no more than half of the
step: a neighbouring branch cannot be slipped onto by a long step. A smooth branch never
changes the sign of the determinant of the bordered system: a step that does is halved
until it is short, and what then still changes it is a crossing of branches, marked as
`branch_point`.
"""

import enum
from typing import Annotated, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from ...numerics.lapack import determinant_sign, solve_any
from ...numerics.result import Result
from ...numerics.types import Real, Scalar, Vector
from ...numerics.units import real, unit
from .method import AbstractMethod
from .orbit import Point, along_frequency, amplitudes, correct
from .system import AbstractVibratingSystem


class BranchEnd(enum.IntEnum):
    """Reason for the end of a branch."""

    LIMIT = 0
    """The branch reached the end of the range, or closed on its beginning."""
    POINTS = 1
    """The largest number of points was reached."""
    SMALL_STEP = 2
    """No step, however small, led to a further point of the same branch."""
    NO_START = 3
    """No orbit was found at the first frequency."""
    REST = 4
    """The branch reached frequency zero, where no orbit is periodic."""

    @property
    def label(self) -> str:
        """Lower-case name, as files and messages write it."""
        return self.name.lower()


class Arclength(eqx.Module):
    """Hold the length along the branch (pseudo-arclength)."""

    def direction(self, tangent: Point, before: Point) -> tuple[Point, Point]:
        """Return the unit vector of prediction and the normal of the correction plane.

        Args:
            tangent: Tangent of the branch at the last point, a unit vector.
            before: From the last point but one to the last, a unit vector.
        """
        return tangent, tangent


class ChangeOfParameter(eqx.Module):
    """Predict along the secant; hold the frequency, or the unknown that changes most.

    Source: Filipkovskii & Belomyttsev (2014), eq. (13).
    """

    def direction(self, tangent: Point, before: Point) -> tuple[Array, Array]:
        """Return directions as in `Arclength.direction`."""
        unknowns, ratio = jnp.abs(before[:-1]), jnp.abs(before[-1])
        fastest = jnp.argmax(unknowns)
        held = jnp.where(unknowns[fastest] > ratio, fastest, before.shape[0] - 1)
        return before, (jnp.arange(before.shape[0]) == held).astype(before.dtype)


class Steps(eqx.Module):
    """Steps along a branch, their lengths in units of `scale` and the frequency ratio.

    The next step is N_opt/N times the last one after N Newton steps, at most twice and
    at least half of it.

    Attributes:
        first: First step [1].
        smallest: Least step; where even that fails the branch ends [1].
        largest: Longest step [1].
        newton: N_opt [1].
        turn: Most by which the branch may turn in a step [rad].
        frequency: Longest step in the frequency ratio alone, as along the tangent [1].
        points: Most points of the branch.

    Traced: all fields but points.
    """

    first: Real = eqx.field(**real("1"), default=0.01)
    smallest: Real = eqx.field(**real("1"), default=1e-7)
    largest: Real = eqx.field(**real("1"), default=0.1)
    newton: Real = eqx.field(**real("1"), default=3.0)
    turn: Real = eqx.field(**real("rad"), default=0.5)
    frequency: Real = eqx.field(**real("1"), default=float("inf"))
    points: int = eqx.field(static=True, default=500)


class TracedBranch(NamedTuple):
    """Points of a branch in arrays of fixed size: the first `count` are valid.

    Attributes:
        x: Unknowns and frequency ratio (point, m + 1) [1].
        tangent: Unit vectors along the branch (point, m + 1).
        monodromy: (point, 2n, 2n) [1].
        motion: Freedoms over `scale` at even phases (point, sample, n) [1].
        amplitude: Half of peak to peak of the freedoms over `scale` (point, n) [1].
        residual: Largest, of the method's equations (point,) [1].
        side: Sign of the determinant of the bordered system (point,).
        newton: Newton steps (point,).
        count: Points.
        refused: Steps that were tried in vain.
        ending: `BranchEnd` code.
    """

    x: Annotated[Float[Array, "point x"], unit("1")]
    tangent: Float[Array, "point x"]
    monodromy: Annotated[Float[Array, "point state state"], unit("1")]
    motion: Annotated[Float[Array, "point sample n"], unit("1")]
    amplitude: Annotated[Float[Array, "point n"], unit("1")]
    residual: Annotated[Float[Array, " point"], unit("1")]
    side: Float[Array, " point"]
    newton: Int[Array, " point"]
    n_points: Int[Array, ""]
    refused: Int[Array, ""]
    ending: Int[Array, ""]


class BranchPoint(NamedTuple):
    """Point of a branch; fields as in `TracedBranch`."""

    x: Point
    tangent: Point
    monodromy: Float[Array, "state state"]
    motion: Float[Array, "sample n"]
    amplitude: Vector
    residual: Scalar
    side: Scalar
    newton: Int[Array, ""]


class _State(NamedTuple):
    points: BranchPoint
    last: BranchPoint
    before: Point
    step: Scalar
    n_points: Int[Array, ""]
    refused: Int[Array, ""]
    ending: Int[Array, ""]


_GOING = -1
_SHORT = 1e-3
"""Largest step at which a sign change of the determinant is not a jump [1]."""
_NEWTON = 10
"""Most Newton steps of a point."""
_FIRST_NEWTON = 50
"""Most Newton steps of the first point."""


def place(
    system: AbstractVibratingSystem,
    method: AbstractMethod,
    x: Point,
    direction: Point,
    towards: Point,
    limit: int | Int[Array, ""] = _NEWTON,
) -> tuple[BranchPoint, Int[Array, ""]]:
    """Return the point of a branch in the plane through `x`, and its `Result` code.

    Args:
        system: The system.
        method: Method that finds the orbits.
        x: Predicted unknowns and frequency ratio [1].
        direction: Normal of the plane.
        towards: The tangent points to its side.
        limit: Most Newton steps.
    """
    found = correct(system, method, x, direction, limit)
    along = along_frequency(x.shape[0] - 1, x.dtype)
    tangent = solve_any(jnp.concatenate([found.jacobian, direction[None]]), along)
    tangent = tangent / jnp.linalg.norm(tangent)
    tangent = jnp.where(tangent @ towards < 0, -tangent, tangent)
    whole = jnp.concatenate([found.jacobian, tangent[None]])
    side = determinant_sign(whole)
    z, ratio = found.x[:-1], found.x[-1]
    monodromy = method.monodromy(system, ratio, found.jacobian, found.slopes)
    motion, _ = method.motion(system, z, ratio)
    point = BranchPoint(
        x=found.x,
        tangent=tangent,
        monodromy=monodromy,
        motion=motion,
        amplitude=amplitudes(motion),
        residual=jnp.max(jnp.abs(found.left)),
        side=side,
        newton=found.steps,
    )
    return point, found.result


def trace(
    system: AbstractVibratingSystem,
    method: AbstractMethod,
    begin: Point,
    end: Scalar,
    parameter: Arclength | ChangeOfParameter,
    steps: Steps,
) -> TracedBranch:
    """Follow a branch; compiled by the caller.

    Args:
        system: The system.
        method: Method that finds the orbits.
        begin: Unknowns and frequency ratio to begin with (m + 1,) [1].
        end: Frequency ratio to go to [1].
        parameter: Quantity held between points.
        steps: Lengths of steps, and their most.

    Returns:
        `TracedBranch`; it has no derivatives: see `solve_orbit`.
    """
    points = steps.points
    along = along_frequency(begin.shape[0] - 1, begin.dtype)
    start = begin[-1]
    forward = jnp.where(end > start, along, -along)
    low, high = jnp.minimum(start, end), jnp.maximum(start, end)

    @jax.jit  # traced once, for the shapes and in the loop
    def place_jitted(*given):
        return place(system, method, *given)

    def predict(state):
        """Return prediction, correction plane, step, and whether it is at a limit."""
        guess, normal = parameter.direction(state.last.tangent, state.before)
        x = state.last.x
        new = x + state.step * guess
        bound = jnp.clip(new[-1], low, high)
        beyond = bound != new[-1]
        share = jnp.where(beyond, (bound - x[-1]) / (new[-1] - x[-1]), 1.0)
        new = (x + share * state.step * guess).at[-1].set(bound)
        first = state.n_points == 0
        return (
            jnp.where(first, begin, new),
            jnp.where(beyond | first, along, normal),
            share * state.step,
            beyond & ~first,
        )

    def attempt(state):
        first = state.n_points == 0
        x, normal, length, at_limit = predict(state)
        limit = jnp.where(first, _FIRST_NEWTON, _NEWTON)
        towards = jnp.where(first, forward, state.last.tangent)
        new, result = place_jitted(x, normal, towards, limit)
        near = jnp.linalg.norm(new.x - x) <= 0.5 * length
        straight = new.tangent @ state.last.tangent >= jnp.cos(steps.turn)
        finite = jnp.all(jnp.isfinite(new.monodromy)) & jnp.all(
            jnp.isfinite(new.tangent)
        )
        # As at frequency zero, the motion by the phase is no motion below it.
        rest = (x[-1] <= 0) | (new.x[-1] <= 0)
        solved = (result == int(Result.CONVERGED)) & finite & ~rest
        short = state.step <= jnp.maximum(_SHORT, 2.0 * steps.smallest)
        smooth = near & straight & ((new.side == state.last.side) | short)
        good = solved & (smooth | first)

        # A point that is not good is written over by the next one.
        taken = jax.tree.map(
            lambda every, one: every.at[state.n_points].set(one), state.points, new
        )
        last = jax.tree.map(lambda a, b: jnp.where(good, a, b), new, state.last)
        move = new.x - state.last.x
        moved = jnp.linalg.norm(move)
        before = jnp.where(
            first, new.tangent, move / jnp.where(moved > 0, moved, jnp.ones_like(moved))
        )
        needed = jnp.maximum(new.newton, 1).astype(x.dtype)
        factor = jnp.clip(steps.newton / needed, 0.5, 2.0)
        share = jnp.maximum(jnp.abs(new.tangent[-1]), jnp.finfo(x.dtype).tiny)
        largest = jnp.minimum(steps.largest, steps.frequency / share)
        longer = jnp.minimum(state.step * factor, largest)
        step = jnp.where(good, jnp.where(first, state.step, longer), 0.5 * state.step)
        count = state.n_points + good.astype(jnp.int32)
        outside = (new.x[-1] <= low) | (new.x[-1] >= high)
        ended = [
            (good & ~first & (at_limit | outside), BranchEnd.LIMIT),
            (~good & first, BranchEnd.NO_START),
            (rest, BranchEnd.REST),
            (step < steps.smallest, BranchEnd.SMALL_STEP),
            (count >= points, BranchEnd.POINTS),
        ]
        ending = jnp.int32(_GOING)
        for why, code in reversed(ended):
            ending = jnp.where(why, jnp.int32(int(code)), ending)
        refused = state.refused + (~good).astype(jnp.int32)
        return _State(
            taken,
            last,
            jnp.where(good, before, state.before),
            step,
            count,
            refused,
            ending,
        )

    none = jnp.int32(0)
    shapes, _ = jax.eval_shape(place_jitted, begin, along, along, none)
    blank = jax.tree.map(lambda one: jnp.zeros(one.shape, one.dtype), shapes)
    room = jax.tree.map(lambda one: jnp.zeros((points, *one.shape), one.dtype), blank)
    state = _State(
        room, blank, forward, steps.first, none, none,
        jnp.int32(_GOING),
    )  # fmt: skip
    done = lax.while_loop(lambda state: state.ending == _GOING, attempt, state)
    return TracedBranch(*done.points, done.n_points, done.refused, done.ending)

"""The search for a motion that repeats from orbit to orbit, of balls and of rollers.

It is an implicit integration in time with steps that grow as it calms down: it begins
as the motion would, from pure rolling, and ends as Newton's method.
"""

import abc
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..numerics import lanes
from ..numerics.implicit import attach_by, stop, unless_failed
from ..numerics.linear import solve, solve_any
from ..numerics.result import Result
from ..numerics.types import Scalar
from .steady_results import SteadyMotion

_STEPS = 300
_TOLERANCE = {"float64": 1e-10, "float32": 1e-3}
_FIRST = 1e-5
"""First step in time [s]."""
_FEW = 6
"""Most unknowns of a system that is solved written out."""


class AbstractOrbit(eqx.Module):
    """Equations of a motion that repeats from orbit to orbit.

    Attributes:
        start: Speeds to begin with (unknown,) [rad/s].
    """

    start: eqx.AbstractVar[Float[Array, " unknown"]]

    @abc.abstractmethod
    def unbalanced(
        self, y: Float[Array, " unknown"]
    ) -> tuple[Float[Array, " unknown"], Float[Array, "..."]]:
        """Forces out of balance [N], and how large those are that cancel [N].

        Args:
            y: Speeds (unknown,) [rad/s].
        """

    @abc.abstractmethod
    def jacobian(self, y: Float[Array, " unknown"]) -> Float[Array, "unknown unknown"]:
        """Of the forces out of balance [N s/rad]; `y` as of `unbalanced`."""

    @abc.abstractmethod
    def inertia(self) -> Float[Array, "unknown unknown"]:
        """Mass matrix that belongs to them [kg m]."""

    @abc.abstractmethod
    def described(self, y: Float[Array, " unknown"], **known: Any) -> SteadyMotion:
        """What is known of the motion.

        Args:
            y: Speeds that fulfil the equations (unknown,) [rad/s].
            **known: Fields that do not follow from them.
        """


class Found(NamedTuple):
    """What a search ended with.

    Attributes:
        y: Speeds (unknown,) [rad/s].
        residual: Force out of balance relative to the tractions [1].
        steps: Steps of the search.
        result: `Result` code.
    """

    y: Float[Array, " unknown"]
    residual: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]


def search(orbit: AbstractOrbit) -> Found:
    """The motion that repeats; without derivatives, see `known`.

    Args:
        orbit: Its equations.

    Fails: `STEP_LIMIT`, `NON_FINITE`.
    """
    loop = lanes.Loop(_init, _step, _terminate, _finish)
    few = orbit.start.size <= _FEW
    return Found(*lanes.run(loop, stop(orbit), 16 if few else 2))


def known(
    orbit: AbstractOrbit, y: Float[Array, " unknown"], result: Int[Array, ""]
) -> Float[Array, " unknown"]:
    """Speeds that were found, with their derivatives; NaN if they failed.

    Args:
        orbit: The equations.
        y: From `search` (unknown,) [rad/s].
        result: `Result` code of all that was solved.
    """
    y = attach_by(lambda y, orbit: orbit.unbalanced(y)[0], y, orbit, _correction)
    return unless_failed(y, result == int(Result.CONVERGED))


def derivatives(count: int) -> np.ndarray:
    """Matrix of d/dφ on an even grid: of the trigonometric interpolant.

    Args:
        count: Number of places around the orbit.
    """
    if count == 1:
        return np.zeros((1, 1))
    k = np.arange(count)
    apart = k[:, None] - k[None, :]
    angle = np.pi * apart / count
    with np.errstate(divide="ignore"):
        ends = 1.0 / (np.tan(angle) if count % 2 == 0 else np.sin(angle))
    return np.where(apart == 0, 0.0, 0.5 * (-1.0) ** apart * ends)


class _State(NamedTuple):
    y: Float[Array, " unknown"]
    out: Float[Array, " unknown"]
    size: Scalar
    goal: Scalar
    step: Scalar
    steps: Int[Array, ""]


def _solve(matrix, right):
    """Of a matrix with positive diagonal; what nothing holds does not move."""
    if right.shape[0] <= _FEW:
        return solve(matrix, right, False)
    held = jnp.any(matrix != 0, axis=1)
    return solve_any(matrix + jnp.diag(jnp.where(held, 0.0, 1.0)), right)


def _init(orbit):
    none, nothing = jnp.zeros_like(orbit.start[0]), jnp.zeros_like(orbit.start)
    first = jnp.full_like(none, _FIRST)
    return _State(orbit.start, nothing, none, none, first, jnp.full((), -1, jnp.int32))


def _step(orbit, state):
    first = state.steps < 0
    matrix = orbit.jacobian(state.y)
    move = _solve(orbit.inertia() / state.step - matrix, state.out)
    y = jnp.where(first, state.y, state.y + move)
    out, sizes = orbit.unbalanced(y)
    size = jnp.max(jnp.abs(out))
    # Round-off of the speeds, in the stiffness of the film.
    tiny = jnp.finfo(y.dtype).eps
    noise = 8.0 * tiny * jnp.max(jnp.abs(matrix) @ jnp.abs(y))
    goal = _TOLERANCE[str(y.dtype)] * jnp.max(sizes) + noise
    ratio = state.size / jnp.maximum(size, jnp.finfo(y.dtype).tiny)
    taken = first | (ratio > 0.5)
    longer = state.step * jnp.clip(2.0 * ratio, 1.5, 10.0)
    step = jnp.where(taken, longer, 0.2 * state.step)
    new = _State(
        y, out, size, goal, jnp.where(first, state.step, step), state.steps + 1
    )
    kept = state._replace(step=step, steps=state.steps + 1)
    return lanes.Either(taken, new, kept)


def _terminate(orbit, state):
    finite = jnp.isfinite(state.step) & jnp.all(jnp.isfinite(state.y))
    going = (state.size > state.goal) & finite & (state.steps < _STEPS)
    return (state.steps >= 0) & ~going


def _finish(orbit, state):
    finite = jnp.all(jnp.isfinite(state.y)) & jnp.isfinite(state.size)
    done = state.size <= state.goal
    result = jnp.where(done, int(Result.CONVERGED), int(Result.STEP_LIMIT))
    result = jnp.where(finite, result, int(Result.NON_FINITE)).astype(jnp.int32)
    scale = jnp.maximum(state.goal, jnp.finfo(state.goal.dtype).tiny)
    tolerance = _TOLERANCE[str(state.y.dtype)]
    return state.y, tolerance * state.size / scale, state.steps, result


def _correction(of_y, y, change, orbit):
    # Traction resists: it is the negative Jacobian whose diagonal is positive.
    return _solve(-orbit.jacobian(y), change)

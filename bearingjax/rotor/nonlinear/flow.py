"""Motion over one period, by Radau collocation of order 9.

Steps are even in the phase, so that one program serves every frequency and the
derivatives of the flow are those of what is computed. The scheme is implicit and damps
what its steps do not resolve: a vibration of three steps per period is met to 1e-6 in
each of them, and one that is faster, as the stiff modes of a shaft are, follows the
forces on it as a spring would and needs no short steps. Where balls lift off, the
force has a kink in its second derivative (Hertz contact, (3/2) power): the order is
then 2.5 from those steps on, and more steps are needed for the same error.

Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996), IV.5.
"""

import functools
from typing import Annotated, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ...numerics.implicit import attach_by, recall, stop_gradient
from ...numerics.lapack import expm, solve_any
from ...numerics.types import Scalar, Vector
from ...numerics.units import unit
from .system import AbstractVibratingSystem, balance_slopes, inertia, out_of_balance

_STAGES = 5
_NEWTON = 20
"""Most Newton steps for the stages of one step."""
_SOLVED = 1e3
"""Largest last Newton step over the motion, in units of round-off [1]."""


@functools.cache
def _scheme() -> tuple[np.ndarray, np.ndarray]:
    """Nodes (stage,) and matrix (stage, stage) of Radau IIA, over the step."""
    # Nodes: 1 and the roots of the Jacobi polynomial that is orthogonal beside it.
    legendre = np.polynomial.legendre.Legendre
    radau = legendre.basis(_STAGES) - legendre.basis(_STAGES - 1)
    nodes = np.sort(0.5 * (1.0 + radau.roots().real))
    nodes[-1] = 1.0
    # Collocation: it integrates all polynomials up to the number of stages exactly.
    powers = np.arange(_STAGES)
    values = nodes[:, None] ** powers
    integrals = nodes[:, None] ** (powers + 1) / (powers + 1)
    return nodes, integrals @ np.linalg.inv(values)


class _Stages(NamedTuple):
    """Stages of a step, with motions u + nodes u' + twice · accelerations.

    Attributes:
        nodes: Phases behind the beginning of the step (stage,) [rad].
        once, twice: Integrals over the phase (stage, stage) [rad], [rad²].
    """

    nodes: Annotated[np.ndarray, unit("rad")]
    once: Annotated[np.ndarray, unit("rad²")]
    twice: Annotated[np.ndarray, unit("rad²")]


def _stages_of(steps: int, dtype) -> _Stages:
    nodes, matrix = _scheme()
    size = 2.0 * np.pi / steps
    parts = size * nodes, size * matrix, size**2 * matrix @ matrix
    return _Stages(*(np.asarray(part, dtype) for part in parts))


def _step_phases(steps, dtype):
    """Return the phases at which steps begin [rad]."""
    return jnp.asarray(2.0 * np.pi / steps * np.arange(steps), dtype)


class StepStart(NamedTuple):
    """Motion at the beginning of a step.

    Attributes:
        system: The system.
        ratio: ν [1].
        phase: φ [rad].
        u, rate: Freedoms over `scale`, and their derivatives by φ (n,) [1].
    """

    system: AbstractVibratingSystem
    ratio: Annotated[Scalar, unit("1")]
    phase: Annotated[Scalar, unit("rad")]
    u: Annotated[Vector, unit("1")]
    rate: Annotated[Vector, unit("1")]


def _stage_motion(at, begin, second):
    """Return phase, displacement and rate of every stage."""
    u, rate = begin.u[None], begin.rate[None]
    u = u + at.nodes[:, None] * rate + at.twice @ second
    return begin.phase + at.nodes, u, rate + at.once @ second


def _out_of_balance(at, begin, second):
    """Return residuals of the equations of motion at every stage (stage, n)."""
    return jax.vmap(
        lambda phase, *motion: out_of_balance(begin.system, phase, begin.ratio, *motion)
    )(*_stage_motion(at, begin, second), second)


def _slopes(at, begin, second):
    """`_out_of_balance`, and its slopes in u, u' (stage, n, n) and ν (stage, n)."""
    return jax.vmap(
        lambda phase, *motion: balance_slopes(begin.system, phase, begin.ratio, *motion)
    )(*_stage_motion(at, begin, second), second)


def _solve(at, begin, slopes, change):
    """Return accelerations of the stages that balance a change (stage, n, …)."""
    own = jnp.eye(len(at.nodes), dtype=change.dtype)
    matrix = jnp.einsum("ij,ikl->ikjl", at.twice, slopes[0])
    matrix = matrix + jnp.einsum("ij,ikl->ikjl", at.once, slopes[1])
    matrix = matrix + jnp.einsum("ij,kl->ikjl", own, inertia(begin.system, begin.ratio))
    flat = change.reshape(matrix.shape[0] * matrix.shape[1], -1)
    found = solve_any(matrix.reshape(len(flat), len(flat)), flat)
    return -found.reshape(change.shape)


def _solve_stages(at, begin, guess):
    """Return accelerations of the stages (stage, n), and `_slopes` there.

    They have the derivatives of the stages; NaN if Newton's method did not find them.
    """
    fixed = stop_gradient(begin)
    small = _SOLVED * jnp.finfo(guess.dtype).eps

    def improve(state):
        second, *_, count = state
        left, slopes = _slopes(at, fixed, second)
        move = _solve(at, fixed, slopes, left)
        second = second + move
        _, u, rate = _stage_motion(at, fixed, second)
        # In u and u' alike: in u' alone where a vibration is slow over the step.
        sizes = (
            jnp.max(jnp.abs(x)) for x in (at.twice @ move, at.once @ move, u, rate)
        )
        moved, turned, far, fast = sizes
        left_over = (moved > small * far) | (turned > small * (far + fast))
        going = left_over & jnp.isfinite(moved)
        found = ~left_over & jnp.isfinite(moved)
        return second, slopes, going, found, count + 1

    shape = jax.eval_shape(lambda: _slopes(at, fixed, guess)[1])
    blank = jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shape)
    start = (
        stop_gradient(guess),
        blank,
        jnp.asarray(True),
        jnp.asarray(False),
        jnp.int32(0),
    )
    second, slopes, _, found, _ = lax.while_loop(
        lambda state: state[2] & (state[4] < _NEWTON), improve, start
    )
    second = jnp.where(found, second, jnp.nan)

    def correction(_, second, change, begin):
        return _solve(at, begin, _slopes(at, begin, second)[1], change)

    second = attach_by(
        lambda second, begin: _out_of_balance(at, begin, second),
        second,
        begin,
        correction,
    )
    slopes = recall(
        lambda begin, second: _slopes(at, begin, second)[1], slopes, (begin, second)
    )
    return second, slopes


def _end_motion(at, u, rate, second):
    """Return the motion at the end of a step, or its changes."""
    parts = at.twice[-1], at.once[-1]
    moved, turned = (jnp.tensordot(part, second, 1) for part in parts)
    return u + at.nodes[-1] * rate + moved, rate + turned


def integrate(
    system: AbstractVibratingSystem,
    start: Float[Array, " state"],
    ratio: Scalar,
    steps: int,
) -> tuple[Float[Array, " state"], Float[Array, "step state"]]:
    """Integrate a motion over one period of the phase.

    Args:
        system: The system.
        start: Freedoms over `scale`, then their derivatives by the phase, at phase 0.
        ratio: ν [1].
        steps: Even steps. Static.

    Returns:
        The state at phase 2π, and the states at the beginning of every step; NaN from
        where a step was not solved.
    """
    at = _stages_of(steps, start.dtype)

    def step(state, phase):
        u, rate, guess = state
        second, _ = _solve_stages(at, StepStart(system, ratio, phase, u, rate), guess)
        guess = jnp.broadcast_to(stop_gradient(second[-1]), guess.shape)
        return (*_end_motion(at, u, rate, second), guess), jnp.concatenate([u, rate])

    u, rate = jnp.split(start, 2)
    guess = jnp.zeros((_STAGES, *u.shape), u.dtype)
    (*end, _), states = lax.scan(step, (u, rate, guess), _step_phases(steps, u.dtype))
    return jnp.concatenate(end), states


def flow_slopes(
    system: AbstractVibratingSystem,
    start: Float[Array, " state"],
    ratio: Scalar,
    steps: int,
) -> tuple[Float[Array, " state"], Float[Array, "state x"]]:
    """Return the state at phase 2π, and its Jacobian in the state at phase 0 and ν.

    Args: as `integrate`.
    """
    at = _stages_of(steps, start.dtype)

    def step(state, phase):
        u, rate, du, drate, guess = state
        begin = StepStart(system, ratio, phase, u, rate)
        second, slopes = _solve_stages(at, begin, guess)
        change = slopes[0] @ (du[None] + at.nodes[:, None, None] * drate[None])
        change = change + slopes[1] @ drate
        change = change.at[..., -1].add(slopes[2])
        grown = _end_motion(at, du, drate, _solve(at, begin, slopes, change))
        guess = jnp.broadcast_to(stop_gradient(second[-1]), guess.shape)
        return (*_end_motion(at, u, rate, second), *grown, guess), None

    u, rate = jnp.split(start, 2)
    unit = jnp.eye(len(start), len(start) + 1, dtype=start.dtype)
    du, drate = jnp.split(unit, 2)
    guess = jnp.zeros((_STAGES, *u.shape), u.dtype)
    begins = _step_phases(steps, u.dtype)
    (u, rate, du, drate, _), _ = lax.scan(step, (u, rate, du, drate, guess), begins)
    return jnp.concatenate([u, rate]), jnp.concatenate([du, drate])


def transition_phases(steps: int) -> np.ndarray:
    """Return the phases at which `transition` needs the matrix (step, 3) [rad]."""
    nodes = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])
    return 2.0 * np.pi / steps * (np.arange(steps)[:, None] + nodes)


def transition(matrices: Float[Array, "step 3 m m"]) -> Float[Array, "m m"]:
    """Return the monodromy matrix of y' = A(φ) y, by Magnus series of order 6.

    A step is the exponential of a mean of A: one that is constant is met exactly,
    however fast it vibrates, so the stiff modes of a shaft ask for no short steps. The
    steps are independent of each other: all are taken at once.

    Args:
        matrices: A at `transition_phases` of even steps.

    Source: Blanes, Casas & Ros, BIT 40 (2000) 434, Gauss-Legendre points.
    """
    size, unit = (
        2.0 * np.pi / len(matrices),
        jnp.eye(matrices.shape[-1], dtype=matrices.dtype),
    )

    def step(three):
        first, middle, last = size * three
        slope = np.sqrt(15.0) / 3.0 * (last - first)
        bend = 10.0 / 3.0 * (last - 2.0 * middle + first)
        turned = _bracket(middle, slope)
        more = slope - _bracket(middle, 2.0 * bend + turned) / 60.0
        mean = _bracket(-20.0 * middle - bend + turned, more) / 240.0
        return middle + bend / 12.0 + mean

    each = expm(jax.vmap(step)(matrices))
    whole, _ = lax.scan(lambda y, one: (one @ y, None), unit, each)
    return whole


def _bracket(a, b):
    """Return the commutator of two matrices."""
    return a @ b - b @ a

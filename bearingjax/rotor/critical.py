"""Critical speeds: where a natural frequency is the speed itself."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Complex, Float, Int

from ..design.checks import count as whole
from ..numerics.implicit import stop
from ..numerics.types import as_count
from .damping import mass_normal
from .modes import direction, largest_real, to_complex
from .rotor import Rotor, RotorMatrices

_STEPS = 6
"""Newton steps; each about triples the number of right digits."""
_SETTLED = 1e-9
"""Relative size of the last step of a critical speed that is found [1]."""


class CriticalSpeeds(eqx.Module):
    """Critical speeds of a rotor, lowest first.

    Where there are fewer than were asked for, or damping or a change of the supports
    with the speed leads the search away, the speed is NaN.

    Attributes:
        speed: Ω = Im λ(Ω) (mode,) [rad/s].
        whirl: +1 forward, excited by unbalance; -1 backward, 0 in a plane, axial, or
            forward and backward at one speed (mode,).
        damping_ratio: -Re λ/|λ| there (mode,) [1].
        shape: (ux uy uz gx gy) of every node (mode, node, 5) [m, rad], as in `Modes`.
    """

    speed: Float[Array, " mode"]
    whirl: Int[Array, " mode"]
    damping_ratio: Float[Array, " mode"]
    shape: Complex[Array, "mode node 5"]


def critical_speeds(rotor: Rotor, *, count: Any = 6) -> CriticalSpeeds:
    """Speeds at which a mode vibrates once per revolution.

    Without damping and with supports of constant stiffness they are the solutions of
    K v = Ω² (M - iG) v, a Hermitian problem that has them all. From there Newton's
    method on λ(Ω) takes damping into account, and supports that follow the speed.

    Args:
        rotor: The rotor, or what has a `linearised(speed)` as it has.
        count: How many, the lowest.

    Returns:
        CriticalSpeeds; speeds and damping ratios have first derivatives with respect
        to all numbers of the rotor.
    """
    count = as_count(count)
    whole("critical_speeds", "count", count)
    return _critical(rotor, count)


@eqx.filter_jit
def _critical(rotor, count):
    fixed = stop(rotor)
    start, shape = _undamped(fixed.linearised(0.0), count)
    found = start > 0
    start = jnp.where(found, start, 1.0)
    point, right, left, change = jax.vmap(lambda *at: _followed(fixed, *at))(
        start, shape
    )
    found &= change <= _SETTLED
    sort = jnp.argsort(jnp.where(found, point[:, 1], jnp.inf))
    found, point, right, left = (part[sort] for part in (found, point, right, left))
    # A mode that was not found must not spoil the derivatives of the others.
    point = jnp.where(found[:, None], point, 1.0)
    at = jax.vmap(lambda *at: _newton(rotor, *at))(point, right, left)
    rate, speed = jnp.where(found[:, None], at, jnp.nan).T
    size = jnp.where(found, jnp.hypot(*jnp.where(found[:, None], at, 1.0).T), jnp.nan)
    matrices = stop(fixed.linearised(0.0))
    nodes, _ = matrices.split(right @ to_complex(matrices.motions).T)
    whirl = jnp.where(found, direction(nodes, matrices.length), 0)
    _, nodes = largest_real(nodes, matrices.length)
    return CriticalSpeeds(speed, whirl, -rate / size, nodes)


def _undamped(matrices: RotorMatrices, count):
    """Critical speeds without damping, and their motions; 0 where there are no more.

    In the modes at rest, of frequency ω, the problem is that of the matrix
    S/(ωᵢ ωⱼ) with S = 1 - iG and eigenvalues 1/Ω². Motions that nothing holds (ω = 0)
    are condensed out of S.
    """
    factor = jnp.linalg.cholesky(matrices.mass)
    stiffness = mass_normal(factor, matrices.stiffness)
    squares, basis = jnp.linalg.eigh(0.5 * (stiffness + stiffness.T))
    gyroscopic = basis.T @ mass_normal(factor, matrices.gyroscopic) @ basis
    n = squares.shape[0]
    eye = jnp.eye(n, dtype=squares.dtype)
    s = lax.complex(eye, -gyroscopic)
    free = squares <= 10.0 * n * jnp.finfo(squares.dtype).eps * squares[-1]
    loose = to_complex(jnp.where(free, 1.0, 0.0))
    held = 1.0 - loose
    both = loose[:, None] * loose[None, :]
    follow = -jnp.linalg.solve(both * s + jnp.diag(held), loose[:, None] * s)
    follow = follow * held[None, :]
    softness = to_complex(
        jnp.where(free, 0.0, 1.0 / jnp.sqrt(jnp.where(free, 1.0, squares)))
    )
    small = softness[:, None] * (s + s @ follow) * softness[None, :]
    values, vectors = jnp.linalg.eigh(small)
    values, vectors = values[::-1][:count], vectors[:, ::-1][:, :count]
    there = values > 0
    speed = jnp.where(there, 1.0 / jnp.sqrt(jnp.where(there, values, 1.0)), 0.0)
    motion = softness[:, None] * vectors
    motion = to_complex(basis) @ (motion + follow @ motion)
    motion = jax.scipy.linalg.solve_triangular(to_complex(factor.T), motion)
    return speed, motion.T


def _followed(rotor, speed, right):
    """Newton's method with inverse iteration for both vectors.

    Returns:
        (Re λ, Ω), right and left vector, and the relative size of the last step.
    """

    def step(_, state):
        point, right, left, _ = state
        new = _newton(rotor, point, right, left)
        change = jnp.max(jnp.abs(new - point)) / jnp.abs(new[1])
        right, left = _vectors(rotor.linearised(new[1]), new, right, left)
        return new, right, left, change

    point = jnp.stack([jnp.zeros_like(speed), speed])
    right = _unit(right)
    return lax.fori_loop(0, _STEPS, step, (point, right, right, jnp.inf * speed))


def _newton(rotor, point, right, left):
    """One step for (Re λ, Ω) of wᵀP(λ, Ω)v = 0, λ = Re λ + iΩ, with its derivative."""

    def residual(point):
        matrices = rotor.linearised(point[1])
        value = left.conj() @ (matrices.dynamic_stiffness(lax.complex(*point)) @ right)
        return jnp.stack([value.real, value.imag])

    slope = stop(jax.jacfwd(residual)(point))
    return point - jnp.linalg.solve(slope, residual(point))


def _vectors(matrices, point, right, left):
    """One step of inverse iteration for both vectors at λ."""
    # Off the eigenvalue by so little that the system is just not singular.
    value = lax.complex(point[0], point[1] * (1.0 + 1e-10))
    rates, mass = to_complex(matrices.rates), to_complex(matrices.mass)
    slope = 2.0 * value * mass + rates
    factors = jax.scipy.linalg.lu_factor(matrices.dynamic_stiffness(value))
    right = jax.scipy.linalg.lu_solve(factors, slope @ right)
    left = jax.scipy.linalg.lu_solve(factors, slope.conj().T @ left, trans=2)
    return _unit(right), _unit(left)


def _unit(vector):
    return vector / to_complex(jnp.linalg.norm(vector))

"""Critical speeds, at which a natural frequency equals the speed."""

import dataclasses
from collections.abc import Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Complex, Float, Int

from ...design.checks import count as whole
from ...design.checks import is_traced, number
from ...numerics.compiled.programs import program
from ...numerics.implicit import stop_gradient
from ...numerics.labels import to_xarray
from ...numerics.lapack import cholesky, congruent, eigh, solve_any
from ...numerics.shown import Printable
from ...numerics.types import Scalar, as_count, as_real
from ...numerics.units import unit
from ...numerics.warning import Warning
from ..rotor import Rotor, RotorMatrices
from ..shaft import STATION_UNITS
from .modes import (
    direction,
    eigenpairs,
    largest_real,
    resonances_above,
    resonates,
    to_complex,
)

_RISING, _FULL = 12, 5
"""Newton steps while the damping rises from zero to its full value, and after."""
_SPARE = 4
"""Additional starts: strong dampers may change the order of the lowest modes."""
_SETTLED = 1e-9
"""Largest relative last step of a converged critical speed [1]."""
_SAME, _PARALLEL = 1e-7, 0.03
"""Relative distance, and difference of motions, of coincident critical speeds."""

_NEAR = 0.1
"""Relative distance to a critical speed below which to warn [1]."""
_RPM = 30.0 / np.pi


class CriticalSpeeds(Printable):
    """Critical speeds of a rotor, lowest first.

    Speeds beyond those found are NaN.

    Attributes:
        speed: Ω = Im λ(Ω) (mode,) [rad/s].
        whirl: +1 forward, excited by unbalance; -1 backward, 0 in a plane, axial, or
            forward and backward at one speed (mode,).
        damping_ratio: -Re λ/|λ| there (mode,) [1].
        shape: (ux uy uz gx gy) of every node (mode, node, 5) [m, rad], as in `Modes`.
        missed: Number of further ones below the last one found, of a damping ratio
            below √½; 0 unless the search failed.
        operating_speed: Speed of the rotor that was asked about [rad/s], or `None`.
    """

    speed: Float[Array, " mode"] = eqx.field(metadata=unit("rad/s"))
    whirl: Int[Array, " mode"]
    damping_ratio: Float[Array, " mode"] = eqx.field(metadata=unit("1"))
    shape: Complex[Array, "mode node station_freedom=5"] = eqx.field(
        metadata=unit(STATION_UNITS)
    )
    missed: Int[Array, ""]
    operating_speed: Scalar | None = eqx.field(metadata=unit("rad/s"), default=None)

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Warnings of speeds that may be missing, and of an operating speed within 10 %
        of one of forward whirl; empty where numbers are traced."""
        if any(is_traced(leaf) for leaf in jax.tree.leaves(self)):
            return ()
        return (*_missing(self), *_resonance_warning(self))

    to_xarray = to_xarray


def critical_speeds(
    rotor: Rotor, *, count: Any = 6, operating_speed: Any = None
) -> CriticalSpeeds:
    """Return the speeds at which a mode vibrates once per revolution.

    Without damping and with supports of constant stiffness they are the solutions of
    K v = Ω² (M - iG) v, a Hermitian problem that yields all of them. From there, with
    damping raised to its full value, and from the damped modes at one speed, Newton's
    method on λ(Ω) finds those with damping and with supports that follow the speed. A
    count of the modes faster than the speed shows whether one was missed; those with a
    damping ratio above √½, which cannot resonate, are not counted.

    Args:
        rotor: The rotor.
        count: Number of speeds, the lowest.
        operating_speed: Speed of the rotor [rad/s], for a warning; `None`: none.

    Returns:
        CriticalSpeeds; speeds and damping ratios have first derivatives with respect
        to all numbers of the rotor. Its `warnings` say if one may be missing, and if
        the operating speed lies within 10 % of one of forward whirl.
    """
    count = as_count(count)
    whole("critical_speeds", "count", count)
    found = _critical(rotor, count)
    if operating_speed is None:
        return found
    number("critical_speeds", "operating_speed", operating_speed, "rad/s")
    return dataclasses.replace(found, operating_speed=as_real(operating_speed))


def _missing(found) -> Iterator[Warning]:
    """Yield a warning of critical speeds that the search may have missed."""
    missed = int(found.missed)
    if missed > 0:
        last = float(np.nanmax(np.asarray(found.speed)))
        yield Warning(
            "missed_critical_speeds",
            f"critical_speeds: {missed} may be missing below {last:g} rad/s: see a"
            " Campbell diagram; strong dampers, or supports that follow the speed, led"
            " the search away",
            float(missed),
            0.0,
        )


def _resonance_warning(found) -> Iterator[Warning]:
    """Yield a warning of a forward critical speed close to that of the rotor."""
    if found.operating_speed is None:
        return
    speed, critical = float(found.operating_speed), np.asarray(found.speed)
    away = abs(abs(speed) / critical - 1.0)
    near = (np.asarray(found.whirl) > 0) & (away < _NEAR)
    if near.any():
        yield Warning(
            "near_critical_speed",
            f"critical_speeds: {speed * _RPM:.5g} rpm lies within 10 % of the forward"
            f" critical speed of {critical[near][0] * _RPM:.5g} rpm",
            float(away[near][0]),
            _NEAR,
        )


@program(quick=True, what="critical speeds")
def _critical(rotor, count):
    fixed = stop_gradient(rotor)
    found, point, right, left = _search(fixed, count + _SPARE)
    found = _keep_distinct(found, point, right)
    sort = jnp.argsort(jnp.where(found, point[:, 1], jnp.inf))[:count]
    found, point, right, left = (part[sort] for part in (found, point, right, left))
    # A mode that was not found must not spoil the derivatives of the others.
    point, right, left = (
        jnp.where(found[:, None], part, 1.0) for part in (point, right, left)
    )
    at = jax.vmap(lambda *at: _newton(rotor, *at))(point, right, left)
    rate, speed = jnp.where(found[:, None], at, jnp.nan).T
    size = jnp.where(found, jnp.hypot(*jnp.where(found[:, None], at, 1.0).T), jnp.nan)
    matrices = stop_gradient(fixed.linearise(0.0))
    nodes, _ = matrices.split(right @ to_complex(matrices.motions).T)
    whirl = jnp.where(found, direction(nodes, matrices.length), 0)
    _, nodes = largest_real(nodes, matrices.length)
    nodes = jnp.where(found[:, None, None], nodes, jnp.nan)
    return CriticalSpeeds(
        speed,
        whirl,
        -rate / size,
        nodes,
        _count_missed(fixed, found, stop_gradient(at)),
    )


def _search(rotor, count):
    """Run Newton's method from two sets of starts."""
    rest = rotor.linearise(0.0)
    speed, shape = _undamped_speeds(rest, count)
    there = speed > 0
    # Damped modes at a speed in the middle of these: forward and backward stand apart.
    middle = jnp.where(jnp.any(there), jnp.mean(speed, where=there), 1.0)
    pairs = eigenpairs(rotor.linearise(middle), count)
    speed = jnp.concatenate([speed, pairs.value.imag])
    start = jnp.stack([jnp.zeros_like(speed), speed], axis=1)
    start = start.at[there.shape[0] :, 0].set(pairs.value.real)
    right = jnp.concatenate([shape, pairs.right])
    left = jnp.concatenate([shape, pairs.left])
    full = jnp.where(jnp.arange(len(speed)) < there.shape[0], 0.0, 1.0)
    start = jnp.where(speed[:, None] > 0, start, 1.0)
    follow = jax.vmap(lambda *at: _follow(rotor, *at))
    point, right, left, change = follow(start, right, left, full)
    found = (speed > 0) & (change <= _SETTLED) & (point[:, 1] > 0)
    return found, point, right, left


def _count_missed(rotor, found, point):
    """Return the number of resonances passed by the speed but not found."""
    rate, speed = point.T
    last = (1.0 - 1e-6) * jnp.max(jnp.where(found, speed, 0.0))
    first = 1e-3 * jnp.min(jnp.where(found, speed, jnp.maximum(last, 1.0)))
    counts = [resonances_above(rotor.linearise(at), at) for at in (first, last)]
    below = jnp.sum(found & (speed < last) & resonates(lax.complex(rate, speed)))
    missed = jnp.maximum(counts[0] - counts[1] - below, 0)
    return jnp.where(jnp.any(found), missed, 0)


def _keep_distinct(found, point, right):
    """Return which results to keep, each once: two searches may end at the same one.

    Of several at one speed, as many as there are independent motions are kept.
    """
    near = jnp.max(jnp.abs(point[:, None] - point[None, :]), axis=-1)
    near = near <= _SAME * jnp.abs(point[:, 1])[:, None]

    def keep_new(k, state):
        kept, directions = state
        own = jnp.where(found[k], right[k], 0.0)
        shares = jnp.where(near[k] & kept, directions.conj() @ own, 0.0)
        rest = own - shares @ directions
        size = jnp.linalg.norm(rest)
        new = size > _PARALLEL
        rest = rest / to_complex(jnp.where(new, size, 1.0))
        return kept.at[k].set(new), directions.at[k].set(rest)

    state = jnp.zeros_like(found), jnp.zeros_like(right)
    return lax.fori_loop(0, found.shape[0], keep_new, state)[0]


def _undamped_speeds(matrices: RotorMatrices, count):
    """Return critical speeds without damping and their motions; 0 beyond the last one.

    In the modes at rest, of frequency ω, the problem is that of the matrix
    S/(ωᵢ ωⱼ) with S = 1 - iG and eigenvalues 1/Ω². Motions that nothing holds (ω = 0)
    are condensed out of S.
    """
    factor = cholesky(matrices.mass)
    stiffness = congruent(factor, matrices.stiffness)
    squares, basis = eigh(stiffness)
    gyroscopic = basis.T @ congruent(factor, matrices.gyroscopic) @ basis
    n = squares.shape[0]
    eye = jnp.eye(n, dtype=squares.dtype)
    s = lax.complex(eye, -gyroscopic)
    free = squares <= 10.0 * n * jnp.finfo(squares.dtype).eps * squares[-1]
    loose = to_complex(jnp.where(free, 1.0, 0.0))
    held = 1.0 - loose
    both = loose[:, None] * loose[None, :]
    follow = -solve_any(both * s + jnp.diag(held), loose[:, None] * s)
    follow = follow * held[None, :]
    softness = to_complex(
        jnp.where(free, 0.0, 1.0 / jnp.sqrt(jnp.where(free, 1.0, squares)))
    )
    small = softness[:, None] * (s + s @ follow) * softness[None, :]
    values, vectors = eigh(small)
    values, vectors = values[::-1][:count], vectors[:, ::-1][:, :count]
    there = values > 0
    speed = jnp.where(there, 1.0 / jnp.sqrt(jnp.where(there, values, 1.0)), 0.0)
    motion = softness[:, None] * vectors
    motion = to_complex(basis) @ (motion + follow @ motion)
    motion = solve_any(to_complex(factor.T), motion, "upper")
    return speed, motion.T


def _follow(rotor, point, right, left, least):
    """Run Newton's method with inverse iteration for both vectors, as damping rises.

    It rises with the third power of the steps, because strong dampers change the mode
    already at a small share of the damping.

    Args:
        rotor: The rotor.
        point: (Re λ, Ω) to start from.
        right, left: Vectors there.
        least: Share of the damping to begin with.

    Returns:
        (Re λ, Ω), right and left vector, and the relative size of the last step.
    """

    def step(k, state):
        point, right, left, _ = state
        share = jnp.clip(((k + 1.0) / _RISING) ** 3, least, 1.0)
        new = _newton(rotor, point, right, left, share)
        change = jnp.max(jnp.abs(new - point)) / jnp.abs(new[1])
        matrices = _with_damping(rotor.linearise(new[1]), share)
        right, left = _vectors(matrices, new, right, left)
        return new, right, left, change

    state = (point, _unit(right), _unit(left), jnp.inf * point[1])
    return lax.fori_loop(0, _RISING + _FULL, step, state)


def _with_damping(matrices, share):
    """Return the matrices with a share of the damping."""
    return eqx.tree_at(lambda m: m.damping, matrices, replace_fn=lambda c: share * c)


def _newton(rotor, point, right, left, share: Any = 1.0):
    """Make a Newton step of (Re λ, Ω) for wᵀP(λ, Ω)v = 0, λ = Re λ + iΩ."""

    def residual(point):
        matrices = _with_damping(rotor.linearise(point[1]), share)
        value = left.conj() @ (matrices.dynamic_stiffness(lax.complex(*point)) @ right)
        return jnp.stack([value.real, value.imag])

    slope = stop_gradient(jax.jacfwd(residual)(point))
    return point - solve_any(slope, residual(point))


def _vectors(matrices, point, right, left):
    """Make a step of inverse iteration for both vectors at λ."""
    # Off the eigenvalue by so little that the system is just not singular.
    value = lax.complex(point[0], point[1] * (1.0 + 1e-10))
    rates, mass = to_complex(matrices.rates), to_complex(matrices.mass)
    slope = 2.0 * value * mass + rates
    stiffness = matrices.dynamic_stiffness(value)
    right = solve_any(stiffness, slope @ right)
    left = solve_any(stiffness.conj().T, slope.conj().T @ left)
    return _unit(right), _unit(left)


def _unit(vector):
    return vector / to_complex(jnp.linalg.norm(vector))

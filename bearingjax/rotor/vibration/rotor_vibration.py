"""A rotor of shaft, discs and supports as a nonlinear vibration.

What is linear (shaft, discs, housings, damping) becomes matrices once; supports push
back as they truly do, not as their slopes.
"""

from collections.abc import Callable, Iterable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.types import Scalar, as_real
from ...numerics.units import unit
from ..parts import AbstractSupport
from ..response import Unbalance
from ..rotor import N_HOUSING, Rotor
from .system import AbstractVibration, HarmonicLoad


class RotorVibration(AbstractVibration):
    """A rotor with the forces of its supports; see `rotor_vibration`.

    Attributes:
        mass, scale, reference_frequency: As of `AbstractVibration`.
        damping: Without that of supports (n, n) [N s/m, N s, N m s].
        gyroscopic: Over the speed (n, n) [kg, kg m, kg m²].
        stiffness: Without that of supports (n, n) [N/m, N, N m].
        supports: The supports.
        rows: How each of them moves (support, 5, n).
        load: (phase, frequency, acceleration) -> forces (n,) [N, N m].
        speed: Of the rotor [rad/s]; `None`: that of the excitation.

    Traced: all numbers.
    """

    mass: Float[Array, "n n"]
    scale: Float[Array, " n"]
    reference_frequency: Scalar = eqx.field(metadata=unit("rad/s"))
    damping: Float[Array, "n n"]
    gyroscopic: Float[Array, "n n"]
    stiffness: Float[Array, "n n"]
    supports: tuple[AbstractSupport, ...]
    rows: Float[Array, "support 5 n"]
    load: Callable
    speed: Scalar | None

    def _speed(self, frequency):
        return frequency if self.speed is None else self.speed

    def damping_matrix(self, frequency):
        return self.damping + self._speed(frequency) * self.gyroscopic

    def force(self, q, velocity, phase, frequency):
        force, speed = self.stiffness @ q, self._speed(frequency)
        for support, rows in zip(self.supports, self.rows, strict=True):
            force = force + rows.T @ support.force(rows @ q, rows @ velocity, speed)
        return force

    def excitation(self, phase, frequency, acceleration):
        return self.load(phase, frequency, acceleration)


def rotor_vibration(
    rotor: Rotor,
    load: Callable | Any,
    *,
    scale: Scalar | float,
    reference_frequency: Scalar | float,
    speed: Scalar | float | None = None,
) -> RotorVibration:
    """A rotor, ready for `solve_orbit` and `follow`.

    Args:
        rotor: Shaft, discs, supports. Modal damping is that of the rotor at rest, its
            supports linearised where they stand.
        load: `Unbalance`, or several of them, or a function (phase, frequency,
            acceleration) -> forces on the freedoms (n,) [N, N m].
        scale: Displacement that is called one, such as a clearance [m]; tilts are
            measured in it over the length of the shaft.
        reference_frequency: Frequency that is called one [rad/s].
        speed: Of the rotor [rad/s]; `None`: that of the excitation.
    """
    matrices = rotor.linearised(0.0)
    rows = rotor.at_supports() @ matrices.motions
    stiffness, damping = matrices.stiffness, matrices.damping
    nothing = jnp.zeros(rows.shape[1], rows.dtype)
    for support, row in zip(rotor.supports, rows, strict=True):
        k, c = support.linearised(nothing, matrices.speed)
        stiffness = stiffness - row.T @ k @ row
        damping = damping - row.T @ c @ row
    size = as_real(scale)
    tilt = size / matrices.length
    body = jnp.stack([size, size, size, tilt, tilt])
    bodies = 1 if rotor.rigid else matrices.n_nodes
    housings = (matrices.mass.shape[0] - 5 * bodies) // N_HOUSING
    sizes = [body] * bodies + [body[:N_HOUSING]] * housings
    return RotorVibration(
        mass=matrices.mass,
        scale=jnp.concatenate(sizes),
        reference_frequency=as_real(reference_frequency),
        damping=damping,
        gyroscopic=matrices.gyroscopic,
        stiffness=stiffness,
        supports=rotor.supports,
        rows=rows,
        load=load if _is_function(load) else _unbalanced(rotor, load, matrices),
        speed=None if speed is None else as_real(speed),
    )


def _is_function(load):
    return callable(load) and not isinstance(load, Unbalance)


def _unbalanced(rotor, unbalances, matrices):
    """U ω² (cos(φ + β), sin(φ + β)) at the station of every unbalance."""
    many = isinstance(unbalances, Iterable)
    cosine = jnp.zeros_like(matrices.motions[:, 0])
    sine = cosine
    for one in unbalances if many else (unbalances,):
        x, y = one.moment * jnp.cos(one.phase), one.moment * jnp.sin(one.phase)
        at = rotor.at(one.station).start
        cosine = cosine.at[at].add(x).at[at + 1].add(y)
        sine = sine.at[at].add(-y).at[at + 1].add(x)
    turned = matrices.motions.T
    load = HarmonicLoad.none(turned.shape[0])
    return eqx.tree_at(
        lambda load: (load.unbalance_cosine, load.unbalance_sine),
        load,
        (turned @ cosine, turned @ sine),
    )

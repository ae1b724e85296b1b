"""Rotor of shaft, discs and supports as a nonlinear vibrating system.

What is linear (shaft, discs, housings, damping) becomes matrices once; supports push
back as they truly do, not as their slopes.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.lapack import pseudoinverse
from ...numerics.programs import program
from ...numerics.types import Scalar, as_real
from ...numerics.units import unit
from ..held import of_each
from ..loads import RotorLoads
from ..parts import AbstractSupport
from ..reduction import craig_bampton, held_motions
from ..rotor import N_HOUSING, Rotor
from .system import AbstractVibratingSystem, HarmonicLoad


class VibratingRotor(AbstractVibratingSystem):
    """Rotor with nonlinear supports; see `vibrating_rotor`.

    Attributes:
        mass, scale, reference_frequency: As in `AbstractVibratingSystem`.
        damping: Without that of supports (n, n) [N s/m, N s, N m s].
        gyroscopic: Over the speed (n, n) [kg, kg m, kg m²].
        stiffness: Without that of supports (n, n) [N/m, N, N m].
        supports: The supports.
        rows: How each of them moves (support, 5, n).
        motions: How all nodes and housings move (motion, n).
        load: (phase, frequency, acceleration) -> forces (n,) [N, N m].
        speed: Of the rotor [rad/s]; `None`: `rotation` times that of the excitation.
        rotation: Turns of the rotor in one period of the excitation [1].

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
    motions: Float[Array, "motion n"]
    load: Callable
    speed: Scalar | None
    rotation: Scalar

    def _speed(self, frequency):
        return self.rotation * frequency if self.speed is None else self.speed

    def damping_matrix(self, frequency):
        return self.damping + self._speed(frequency) * self.gyroscopic

    def force(self, q, velocity, phase, frequency):
        force, speed = self.stiffness @ q, self._speed(frequency)
        if not self.supports:
            return force
        angle = self.rotation * phase
        each = of_each(
            lambda support, moved, rate: support.force(moved, rate, speed, angle),
            self.supports,
            self.rows @ q,
            self.rows @ velocity,
        )
        return force + jnp.einsum("sim,si->m", self.rows, each)

    def excitation(self, phase, frequency, acceleration):
        return self.load(phase, frequency, acceleration)

    def freedoms(self, motion: Float[Array, " motion"]) -> Float[Array, " n"]:
        """Return the least-squares freedoms of given motions.

        Args:
            motion: Motion of all nodes and housings, such as `StaticEquilibrium.motion`
            (motion,)
                [m, rad].
        """
        return pseudoinverse(self.motions) @ motion


def vibrating_rotor(
    rotor: Rotor,
    loads: RotorLoads | Callable | Any,
    *,
    scale: Scalar | float,
    reference_frequency: Scalar | float,
    speed: Scalar | float | None = None,
    rotation: Scalar | float | None = None,
    modes: int | None = None,
    about: Float[Array, " motion"] | None = None,
) -> VibratingRotor:
    """Create the system of a rotor for `solve_orbit`, `follow` and `simulate`.

    Args:
        rotor: Shaft, discs, supports.
        loads: `RotorLoads`; or `Unbalance`, or several of them; or a function (phase,
            frequency, acceleration) -> forces on all motions (motion,) [N, N m]; of a
            rigid shaft on its five freedoms and those of housings.
        scale: Unit of displacement, such as a clearance [m]; that of tilts is `scale`
            over the length of the shaft.
        reference_frequency: Unit of frequency [rad/s].
        speed: Speed of the rotor [rad/s]; `None`: that of the excitation.
        rotation: Turns of the rotor in one period of the excitation [1]; `None`: one.
            With 2/(Z(1 - G)) the excitation is the passage of Z rolling elements, G as
            in `BearingElement.as_function`; there is no unbalance then.
        modes: Hold the rotor to `craig_bampton` motions with so many modes; `None`:
            all freedoms stay.
        about: Motions about which supports are linearised for modal damping, such as
            `StaticEquilibrium.motion` (motion,) [m, rad]; `None`: zero. Supports are
            taken at `speed`; without one, at rest.

    Raises:
        ValueError: As `craig_bampton`; for unbalance with a `rotation` of its own, with
            both `speed` and `rotation`, or with a `speed` and orbiting elements.
    """
    loads = _as_loads(loads)
    _check_rotation(rotor, loads, speed, rotation)
    turning = None if speed is None else as_real(speed)
    own, rows, sizes, every = _assembled(rotor, as_real(scale), turning, modes, about)
    return VibratingRotor(
        mass=own.mass,
        scale=sizes,
        reference_frequency=as_real(reference_frequency),
        damping=own.damping,
        gyroscopic=own.gyroscopic,
        stiffness=own.stiffness,
        supports=rotor.supports,
        rows=rows,
        motions=own.motions,
        load=_load(rotor, loads, every, own.motions),
        speed=turning,
        rotation=as_real(1.0 if rotation is None else rotation),
    )


@program(quick=True)
def _assembled(rotor, scale, speed, modes, about):
    """Return matrices without supports, support rows, scales, unreduced motions."""
    matrices = rotor.linearised(0.0 if speed is None else speed, about)
    rows = rotor.at_supports() @ matrices.motions
    stiffness, damping = matrices.stiffness, matrices.damping
    if rotor.supports:
        there = jnp.zeros_like(matrices.motions[:, 0]) if about is None else about
        k, c = of_each(
            lambda support, moved: support.linearised(moved, matrices.speed),
            rotor.supports,
            rotor.at_supports() @ there,
        )
        stiffness = stiffness - jnp.einsum("sim,sij,sjn->mn", rows, k, rows)
        damping = damping - jnp.einsum("sim,sij,sjn->mn", rows, c, rows)
    own = eqx.tree_at(
        lambda m: (m.stiffness, m.damping), matrices, (stiffness, damping)
    )
    sizes = _sizes(rotor, matrices, scale)
    if modes is not None:
        basis = craig_bampton(rotor, modes)
        kept, _ = held_motions(rotor)
        own, rows = own.projected(basis), rows @ basis
        more = jnp.broadcast_to(scale, (basis.shape[1] - len(kept),))
        sizes = jnp.concatenate([sizes[kept], more])
    return own, rows, sizes, matrices.motions


def _sizes(rotor, matrices, size):
    """Return the scale of every freedom."""
    tilt = size / matrices.length
    body = jnp.stack([size, size, size, tilt, tilt])
    bodies = 1 if rotor.rigid else matrices.n_nodes
    housings = (matrices.mass.shape[0] - 5 * bodies) // N_HOUSING
    return jnp.concatenate([body] * bodies + [body[:N_HOUSING]] * housings)


def _as_loads(loads):
    if isinstance(loads, RotorLoads) or callable(loads):
        return loads
    return RotorLoads(unbalances=loads)


def _check_rotation(rotor, loads, speed, rotation):
    orbits = any(getattr(support, "passage", False) for support in rotor.supports)
    if orbits and speed is not None:
        raise ValueError(
            "vibrating_rotor: with a `speed` of its own the rotor does not turn with"
            " the excitation, and rolling elements that orbit (`passage`) would stand"
            " at wrong places; give `rotation`, or excite at the speed."
        )
    if rotation is None:
        return
    if speed is not None:
        raise ValueError(
            "vibrating_rotor: give `speed` or `rotation`: with both, rolling elements"
            " would not come back after a period of the excitation."
        )
    if getattr(loads, "unbalances", ()):
        raise ValueError(
            "vibrating_rotor: with a `rotation` unbalance does not repeat with the"
            " excitation; leave one of them out, or integrate over time."
        )


class _Reduced(eqx.Module):
    """A load on all freedoms, projected on fewer."""

    load: Callable
    basis: Float[Array, "freedom n"]

    def __call__(self, phase, frequency, acceleration):
        return self.basis.T @ self.load(phase, frequency, acceleration)


def _load(rotor, loads, every, motions):
    """Return the load on the freedoms as a function of phase, frequency and its rate.

    Args:
        rotor: The rotor.
        loads: `RotorLoads`, or a function.
        every: Motions per freedom before the reduction (motion, freedom).
        motions: The same after it (motion, n).
    """
    if not isinstance(loads, RotorLoads):
        if motions.shape == every.shape:
            return loads
        return _Reduced(loads, motions)
    loads.check(rotor)
    turned = motions.T
    cosine, sine = loads.unbalanced(rotor)
    return HarmonicLoad(
        constant=turned @ loads.constant(rotor),
        cosine=turned @ loads.shaken(rotor),
        sine=jnp.zeros_like(turned[:, 0]),
        unbalance_cosine=turned @ cosine,
        unbalance_sine=turned @ sine,
    )

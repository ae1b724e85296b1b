"""Rotor of shaft, discs and supports as a nonlinear vibrating system.

What is linear (shaft, discs, housings, damping) becomes matrices once; supports push
back as they truly do, not as their slopes.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.compiled.programs import program
from ...numerics.implicit import through_jacobian
from ...numerics.lapack import pseudoinverse
from ...numerics.types import Number, Scalar, Square, Vector, as_real
from ...numerics.units import unit
from ..like_parts import map_parts
from ..linear.reduction import craig_bampton, held_motions
from ..loads import RotorLoads
from ..parts import AbstractSupport
from ..rotor import N_HOUSING, Rotor, matrices_about
from ..statics import StaticEquilibrium
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
        speed: Speed of the rotor [rad/s]; `None`: `rotation` times that of the
            excitation.
        rotation: Turns of the rotor in one period of the excitation [1].

    Traced: all numbers.
    """

    mass: Square
    scale: Vector
    reference_frequency: Scalar = eqx.field(metadata=unit("rad/s"))
    damping: Square
    gyroscopic: Square
    stiffness: Square
    supports: tuple[AbstractSupport, ...]
    rows: Float[Array, "support 5 n"]
    motions: Float[Array, "motion n"]
    load: Callable
    speed: Scalar | None
    rotation: Scalar

    def _speed(self, frequency):
        return self.rotation * frequency if self.speed is None else self.speed

    def damping_matrix(self, frequency: Scalar) -> Square:
        return self.damping + self._speed(frequency) * self.gyroscopic

    def force(
        self, q: Vector, velocity: Vector, phase: Number, frequency: Scalar
    ) -> Vector:
        force, speed = self.stiffness @ q, self._speed(frequency)
        if not self.supports:
            return force
        angle = self.rotation * phase
        each = map_parts(
            lambda support, moved, rate: through_jacobian(
                support, moved, rate, speed, angle, function=_support
            ),
            self.supports,
            self.rows @ q,
            self.rows @ velocity,
        )
        return force + jnp.einsum("sim,si->m", self.rows, each)

    def excitation(
        self, phase: Number, frequency: Scalar, acceleration: Scalar
    ) -> Vector:
        return self.load(phase, frequency, acceleration)

    def freedoms(self, motion: Float[Array, " motion"]) -> Vector:
        """Return the least-squares freedoms of given motions.

        Args:
            motion: Motion of all nodes and housings, such as
                `StaticEquilibrium.motion` (motion,) [m, rad].
        """
        return _freedoms(self.motions, motion)


@program(quick=True)
def _freedoms(motions, motion):
    return pseudoinverse(motions) @ motion


def vibrating_rotor(
    rotor: Rotor,
    loads: RotorLoads | Callable | Any,
    *,
    scale: Number,
    reference_frequency: Number,
    speed: Number | None = None,
    rotation: Number | None = None,
    modes: int | None = None,
    about: Float[Array, " motion"] | StaticEquilibrium | None = None,
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
        about: What modal damping takes as the stiffness of the supports: that of a
            `StaticEquilibrium` of the rotor, at its speed; or that about motions
            (motion,) [m, rad], at `speed`, without one at rest; `None`: about zero.

    Raises:
        ValueError: As `craig_bampton`; for unbalance with a `rotation` of its own, with
            both `speed` and `rotation`, or with a `speed` and orbiting elements.
    """
    loads = _as_loads(loads)
    _check_rotation(rotor, loads, speed, rotation)
    turning = None if speed is None else as_real(speed)
    # A rotor on springs holds its matrices without the programs of bearings.
    settled = isinstance(about, StaticEquilibrium)
    linear, there = (about.rotor, None) if settled else (rotor, about)
    given = linear, as_real(scale), turning, modes, there
    if isinstance(loads, RotorLoads):
        loads.check(rotor)
        own, rows, sizes, load = _assemble(*given, loads)
    else:
        own, rows, sizes, _ = _assemble(*given, None)
        # A function of all motions, or of the freedoms of a rigid shaft.
        load = loads if modes is None else _Reduced(loads, own.motions)
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
        load=load,
        speed=turning,
        rotation=as_real(1.0 if rotation is None else rotation),
    )


@program(quick=True)
def _assemble(rotor, scale, speed, modes, about, loads) -> tuple[Any, ...]:
    """Return matrices without supports, support rows, scales, and the load if known."""
    speed = jnp.zeros_like(scale) if speed is None else speed
    own = matrices_about(rotor, speed, about, supported=False)
    rows = rotor.at_supports() @ own.motions
    sizes = _sizes(rotor, own, scale)
    if modes is not None:
        basis = craig_bampton(rotor, modes)
        kept, _ = held_motions(rotor)
        own, rows = own.project(basis), rows @ basis
        more = jnp.broadcast_to(scale, (basis.shape[1] - len(kept),))
        sizes = jnp.concatenate([sizes[kept], more])
    load = None if loads is None else _harmonic(rotor, loads, own.motions.T)
    return own, rows, sizes, load


def _sizes(rotor, matrices, size):
    """Return the scale of every freedom."""
    tilt = size / matrices.length
    body = jnp.stack([size, size, size, tilt, tilt])
    bodies = 1 if rotor.rigid else matrices.n_nodes
    housings = (matrices.mass.shape[0] - 5 * bodies) // N_HOUSING
    return jnp.concatenate([body] * bodies + [body[:N_HOUSING]] * housings)


def _support(support, motion, velocity, speed, angle):
    return support.force(motion, velocity, speed, angle)


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


def _harmonic(rotor, loads, turned):
    """Return the load on the freedoms, to which `turned` takes that on all motions."""
    cosine, sine = loads.unbalance_forces(rotor)
    return HarmonicLoad(
        constant=turned @ loads.constant(rotor),
        cosine=turned @ loads.base_force(rotor),
        sine=jnp.zeros_like(turned[:, 0]),
        unbalance_cosine=turned @ cosine,
        unbalance_sine=turned @ sine,
    )

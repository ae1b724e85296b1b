"""Equations of motion: the interface of systems to the solvers of orbits.

    M q'' + D(ω) q' + f(q, q', φ, ω) = e(φ, ω),    φ = ω t

with f and e periodic in the phase φ. Where ω changes, φ is its integral over time and
terms of its rate join: α ∂D/∂ω q on the left, as the gyroscopic moment is the rate of
an angular momentum ω G q, and the α that e is given. Freedoms q are measured in `scale`
and the phase takes the place of time, so that the unknowns of the solvers are pure
numbers near one.
"""

import abc
from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ...numerics.lapack import solve_any
from ...numerics.types import Number, Real, RealOrNone, Scalar, Square, Vector, as_real
from ...numerics.units import real, unit


class AbstractVibratingSystem(eqx.Module):
    """System of n freedoms under forces that are periodic in time.

    Attributes:
        mass: Mass matrix M, positive definite [kg, kg m²].
        scale: Size of each freedom that is called one [m, rad].
        reference_frequency: Frequency that is called one, best a natural one [rad/s].
    """

    mass: eqx.AbstractVar[Square]
    scale: eqx.AbstractVar[Vector]
    reference_frequency: eqx.AbstractVar[Scalar]

    @abc.abstractmethod
    def damping_matrix(self, frequency: Scalar) -> Square:
        """Damping and gyroscopic matrix D [N s/m, N m s/rad].

        What depends on the frequency must be gyroscopic.

        Args:
            frequency: ω [rad/s].
        """

    @abc.abstractmethod
    def force(
        self, q: Vector, velocity: Vector, phase: Number, frequency: Scalar
    ) -> Vector:
        """Restoring forces f, positive against the displacement [N, N m].

        Args:
            q: Freedoms [m, rad].
            velocity: Their rates [m/s, rad/s].
            phase: φ [rad]; f repeats after 2π.
            frequency: ω [rad/s].
        """

    @abc.abstractmethod
    def excitation(
        self, phase: Number, frequency: Scalar, acceleration: Scalar
    ) -> Vector:
        """Return the external forces e [N, N m].

        Args:
            phase: φ [rad]; e repeats after 2π.
            frequency: ω [rad/s].
            acceleration: Rate of ω, zero in all that is periodic [rad/s²].
        """


class VibratingSystem(AbstractVibratingSystem):
    """System from matrices and functions.

    Attributes:
        mass: As in `AbstractVibratingSystem` [kg, kg m²].
        damping: Damping matrix [N s/m, N m s/rad].
        gyroscopic: Gyroscopic matrix over the speed, skew [kg, kg m²].
        restoring: (q, velocity, phase, frequency) -> forces (n,) [N, N m]; a Module,
            so that its numbers are traced.
        load: (phase, frequency, acceleration) -> forces (n,) [N, N m]; likewise.
        scale: As in `AbstractVibratingSystem` [m, rad].
        reference_frequency: As in `AbstractVibratingSystem` [rad/s].
        speed: Speed of the rotor [rad/s]; `None`: that of the excitation.

    Traced: all numbers.
    """

    mass: Square = eqx.field(converter=as_real, metadata=unit(("kg", "kg m²")))
    damping: Square = eqx.field(
        converter=as_real, metadata=unit(("N s/m", "N m s/rad"))
    )
    gyroscopic: Square = eqx.field(converter=as_real, metadata=unit(("kg", "kg m²")))
    restoring: Callable
    load: Callable
    scale: Vector = eqx.field(converter=as_real, metadata=unit(("m", "rad")))
    reference_frequency: Real = eqx.field(**real("rad/s"))
    speed: RealOrNone = eqx.field(**real("rad/s"), default=None)

    def __check_init__(self):
        n = self.scale.shape[0]
        for name in ("mass", "damping", "gyroscopic"):
            shape = getattr(self, name).shape
            if shape != (n, n):
                raise ValueError(
                    f"`{name}` has the shape {shape}, but `scale` has {n} freedoms:"
                    f" a matrix ({n}, {n}) is wanted"
                )

    def damping_matrix(self, frequency: Scalar) -> Square:
        speed = frequency if self.speed is None else self.speed
        return self.damping + speed * self.gyroscopic

    def force(
        self, q: Vector, velocity: Vector, phase: Number, frequency: Scalar
    ) -> Vector:
        return self.restoring(q, velocity, phase, frequency)

    def excitation(
        self, phase: Number, frequency: Scalar, acceleration: Scalar
    ) -> Vector:
        return self.load(phase, frequency, acceleration)


class HarmonicLoad(eqx.Module):
    """Constant load, harmonic load, and load proportional to the frequency squared.

    Attributes:
        constant: Such as weight (n,) [N, N m].
        cosine, sine: Amplitudes of cos φ and sin φ (n,) [N, N m].
        unbalance_cosine, unbalance_sine: Amplitudes of cos φ and sin φ over ω²; they
            turn with the phase, and where the frequency changes their tangential
            inertia acts too (n,) [kg m, kg m²].

    Traced: all fields.
    """

    constant: Vector
    cosine: Vector
    sine: Vector
    unbalance_cosine: Vector
    unbalance_sine: Vector

    @classmethod
    def zero(cls, size: int) -> "HarmonicLoad":
        """No load on `size` freedoms."""
        return cls(*(5 * (jnp.zeros(size),)))

    def __call__(self, phase, frequency, acceleration):
        # -d²/dt² of (unbalance_cosine cos φ + unbalance_sine sin φ).
        square, c, s = frequency**2, self.unbalance_cosine, self.unbalance_sine
        cosine = self.cosine + square * c - acceleration * s
        sine = self.sine + square * s + acceleration * c
        return self.constant + jnp.cos(phase) * cosine + jnp.sin(phase) * sine


def frequency_of(system: AbstractVibratingSystem, ratio: Scalar) -> Scalar:
    """Return the frequency ω [rad/s] from its ratio ν to the reference [1]."""
    return ratio * system.reference_frequency


def out_of_balance(
    system: AbstractVibratingSystem,
    phase: Scalar,
    ratio: Scalar,
    u: Vector,
    rate: Vector,
    second: Vector,
) -> Vector:
    """Residual of the equations of motion, over M_ii·scale·(reference frequency)² [1].

    Args:
        system: The system.
        phase: φ [rad].
        ratio: ν [1].
        u: Freedoms over `scale` [1].
        rate, second: Their derivatives with respect to φ [1].
    """
    frequency = frequency_of(system, ratio)
    scale = system.scale
    q, velocity = scale * u, frequency * scale * rate
    inertia = system.mass @ (frequency**2 * scale * second)
    forces = system.damping_matrix(frequency) @ velocity
    forces = forces + system.force(q, velocity, phase, frequency)
    steady = jnp.zeros_like(frequency)
    left = inertia + forces - system.excitation(phase, frequency, steady)
    unit_force = jnp.diagonal(system.mass) * scale * system.reference_frequency**2
    return left / unit_force


def inertia(system: AbstractVibratingSystem, ratio: Scalar) -> Square:
    """Slope of `out_of_balance` in the second derivatives [1].

    Args:
        system: The system.
        ratio: ν [1].
    """
    weight = jnp.diagonal(system.mass) * system.scale
    return ratio**2 * system.mass * system.scale[None, :] / weight[:, None]


def balance_slopes(
    system: AbstractVibratingSystem,
    phase: Scalar,
    ratio: Scalar,
    u: Vector,
    rate: Vector,
    second: Vector,
) -> tuple[Vector, tuple[Square, Square, Vector]]:
    """Return `out_of_balance`, and its slopes in u, u' (n, n) and ν (n,) [1].

    Args: as `out_of_balance`.
    """

    def with_value(u, rate, ratio):
        left = out_of_balance(system, phase, ratio, u, rate, second)
        return left, left

    slopes, left = jax.jacfwd(with_value, (0, 1, 2), has_aux=True)(u, rate, ratio)
    return left, slopes


def rates(
    system: AbstractVibratingSystem, ratio: Scalar
) -> Callable[[Scalar, Float[Array, " state"]], Float[Array, " state"]]:
    """Return the derivative of the state with respect to the phase, at a frequency.

    Args:
        system: The system.
        ratio: ν [1].

    Returns:
        Function (phase [rad], state) -> derivative; the state holds the freedoms over
        `scale`, then their derivatives with respect to φ [1].
    """
    matrix = inertia(system, ratio)
    inverse = solve_any(matrix, jnp.eye(matrix.shape[0], dtype=matrix.dtype))

    def rate(phase, y):
        u, rate = jnp.split(y, 2)
        left = out_of_balance(system, phase, ratio, u, rate, jnp.zeros_like(u))
        return jnp.concatenate([rate, -inverse @ left])

    return rate

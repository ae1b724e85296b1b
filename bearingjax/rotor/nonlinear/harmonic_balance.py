"""Periodic orbits by harmonic balance, with alternating frequency and time (AFT).

The motion is a Fourier series with H harmonics. Forces are evaluated at even phases
over the period, and what the equations of motion leave there is turned into its own
first H harmonics, which must vanish.

Source: Cameron & Griffin, J. Appl. Mech. 56 (1989) 149; Krack & Gross, Harmonic Balance
    for Nonlinear Vibration Problems (2019).
"""

import functools
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...numerics.lapack import solve_any
from ...numerics.types import Scalar, Vector, as_count
from ...numerics.units import meaning, unit
from .flow import transition, transition_phases
from .method import AbstractMethod, Jacobian, Motion, Unknowns
from .system import AbstractVibratingSystem, balance_slopes, inertia, out_of_balance


class Basis(NamedTuple):
    """Fourier series at even phases: 1, cos kφ, sin kφ (k = 1…H).

    Attributes:
        phase: Phases (sample,) [rad].
        value: Series at them (sample, 2H + 1).
        rate, second: Its derivatives with respect to the phase.
        analysis: Coefficients from samples (2H + 1, sample).
        turn: Coefficients of the derivative from those of the series.
    """

    phase: Annotated[Any, unit("rad")]
    value: Any
    rate: Any
    second: Any
    analysis: Any
    turn: Any


def basis(harmonics: int, samples: int) -> Basis:
    """Fourier series with `harmonics` harmonics at `samples` even phases."""
    phase = 2.0 * np.pi * np.arange(samples) / samples
    k = np.arange(1, harmonics + 1)
    angle = phase[:, None] * k
    value = np.concatenate([np.ones((samples, 1)), np.cos(angle), np.sin(angle)], 1)
    turn = np.zeros((2 * harmonics + 1, 2 * harmonics + 1))
    cosine, sine = 1 + np.arange(harmonics), 1 + harmonics + np.arange(harmonics)
    turn[cosine, sine], turn[sine, cosine] = k, -k
    weight = np.full(2 * harmonics + 1, 2.0 / samples)
    weight[0] = 1.0 / samples
    analysis = weight[:, None] * value.T
    return Basis(phase, value, value @ turn, value @ turn @ turn, analysis, turn)


def interpolation(phase: np.ndarray, samples: int) -> np.ndarray:
    """Weights of even samples in their trigonometric interpolant at phases.

    Args:
        phase: [rad].
        samples: Number of them.

    Returns:
        (..., sample).
    """
    order = np.arange(1, (samples + 1) // 2)
    # The highest order of an even number of samples counts as a cosine.
    last = np.array([samples / 2]) if samples % 2 == 0 else np.zeros(0)
    off = phase[..., None] - 2.0 * np.pi * np.arange(samples) / samples
    waves = 2.0 * np.cos(off[..., None] * order).sum(-1)
    return (1.0 + waves + np.cos(off[..., None] * last).sum(-1)) / samples


class HarmonicBalance(AbstractMethod):
    """Unknowns are the Fourier coefficients of all freedoms.

    Attributes:
        harmonics: H [1].
        samples: Phases at which forces are evaluated, and samples of the orbit; more
            than 2H, and some four times as many where balls lift off [1].
        steps: Steps of the integration of small changes, for the multipliers [1].
    """

    harmonics: int = eqx.field(
        static=True,
        converter=as_count,
        default=7,
        metadata=meaning("harmonics of the vibration"),
    )
    samples: int = eqx.field(
        static=True,
        converter=as_count,
        default=64,
        metadata=meaning("samples of a period, more than twice `harmonics`"),
    )
    steps: int = eqx.field(
        static=True,
        converter=as_count,
        default=48,
        metadata=meaning("steps of the integration over a period"),
    )

    def __check_init__(self):
        if self.samples <= 2 * self.harmonics:
            raise ValueError(
                f"`samples` is {self.samples}; {self.harmonics} harmonics need more"
                f" than {2 * self.harmonics}"
            )

    def _basis(self, dtype):
        return Basis(
            *(jnp.asarray(x, dtype) for x in basis(self.harmonics, self.samples))
        )

    def _series(self, z):
        return z.reshape(2 * self.harmonics + 1, -1)

    def unknowns(self, motion: Motion) -> Unknowns:
        u = motion[0]
        given = u.shape[0]
        found = jnp.asarray(
            basis(min(self.harmonics, (given - 1) // 2), given).analysis, u.dtype
        )
        coefficients = found @ u
        mean, cosine, sine = jnp.split(coefficients, [1, 1 + found.shape[0] // 2])
        short = jnp.zeros((self.harmonics - cosine.shape[0], u.shape[1]), u.dtype)
        return jnp.concatenate([mean, cosine, short, sine, short]).reshape(-1)

    def state(self, z: Unknowns) -> tuple[Vector, Vector]:
        at, series = self._basis(z.dtype), self._series(z)
        return at.value[0] @ series, at.rate[0] @ series

    def _motion(self, z):
        """Return u, u' and u'' at all phases, each (sample, n)."""
        at, series = self._basis(z.dtype), self._series(z)
        return at.value @ series, at.rate @ series, at.second @ series

    def residual(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Unknowns:
        at = self._basis(z.dtype)
        left = jax.vmap(
            lambda phase, *motion: out_of_balance(system, phase, ratio, *motion)
        )(at.phase, *self._motion(z))
        return (at.analysis @ left).reshape(-1)

    def slopes(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Any:
        """Return the residual of the equations of motion (sample, n), and its Jacobians
        in u, u', u'' (sample, n, n) and ν (sample, n)."""

        left, (*slopes, speed) = jax.vmap(
            lambda phase, *motion: balance_slopes(system, phase, ratio, *motion)
        )(self._basis(z.dtype).phase, *self._motion(z))
        constant = jnp.broadcast_to(inertia(system, ratio), slopes[0].shape)
        return left, (*slopes, constant, speed)

    def project(self, slopes: Any, bases: Any) -> Float[Array, "m m"]:
        """Return the Jacobian in the coefficients, from slopes in values of `bases`."""
        pairs = zip(slopes, bases, strict=True)
        terms = [jnp.einsum("tij,tb->tibj", slope, base) for slope, base in pairs]
        terms = functools.reduce(jnp.add, terms)
        analysis = self._basis(terms.dtype).analysis
        size = terms.shape[1] * terms.shape[2]
        return jnp.tensordot(analysis, terms, 1).reshape(size, size)

    def linearise(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> tuple[Unknowns, Jacobian, Any]:
        at = self._basis(z.dtype)
        left, (*slopes, speed) = self.slopes(system, z, ratio)
        columns = self.project(slopes, (at.value, at.rate, at.second))
        both = (at.analysis @ jnp.stack([left, speed])).reshape(2, -1)
        jacobian = jnp.concatenate([columns, both[1][:, None]], axis=1)
        return both[0], jacobian, jnp.stack(slopes[:2])

    def motion(
        self, system: AbstractVibratingSystem, z: Unknowns, ratio: Scalar
    ) -> Motion:
        return self._motion(z)[:2]

    def monodromy(
        self,
        system: AbstractVibratingSystem,
        ratio: Scalar,
        jacobian: Jacobian,
        slopes: Any,
    ) -> Float[Array, "state state"]:
        # Between the samples the slopes are those of the trigonometric interpolant,
        # so that no force is evaluated anew.
        between = interpolation(transition_phases(self.steps), self.samples)
        slopes = jnp.tensordot(jnp.asarray(between, slopes.dtype), slopes, ([2], [1]))
        unit = jnp.eye(slopes.shape[-1], dtype=slopes.dtype)
        inverse = solve_any(inertia(system, ratio), unit)
        pushed = -inverse @ slopes
        pushed = jnp.concatenate([pushed[:, :, 0], pushed[:, :, 1]], axis=-1)
        moved = jnp.concatenate([jnp.zeros_like(unit), unit], axis=-1)
        moved = jnp.broadcast_to(moved, pushed.shape)
        return transition(jnp.concatenate([moved, pushed], axis=-2))

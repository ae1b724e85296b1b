"""Free vibration: frequency and damping over the amplitude (backbone curve).

A vibration that is damped does not repeat. It does once a damping in proportion to the
mass is taken away, as much as the vibration loses in a period: the equations

    M q'' + (D(ω) - 2 ζ ω M) q' + f(q, q') = e,    e the constant part of the excitation

have for every amplitude a periodic motion, its frequency ω and its damping ratio ζ.
Without damping ζ is zero. Peaks of the response to any light excitation lie along the
curve of ω.

Source: Krack, Computers & Structures 154 (2015) 59, extended periodic motion.
"""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from ...design.checks import real_numbers
from ...numerics.compiled.programs import program
from ...numerics.implicit import attach_by, stop_gradient, unless_failed
from ...numerics.lapack import eig, pseudoinverse, solve_any
from ...numerics.result import Result, raise_unless_converged
from ...numerics.shown import Printable
from ...numerics.types import Scalar, Square, Vector, as_real
from .method import AbstractMethod
from .orbit import amplitudes, newton
from .system import AbstractVibratingSystem, out_of_balance, rates

_PHASES = 64
"""Phases at which a linear mode is sampled."""
_STEPS = 20
"""Most Newton steps of a point."""
_TRIES = 40
"""Most points between two peaks, rejected ones included."""
_NEAR = 0.2
"""Largest deviation of a point from its guess, over the step [1]."""
_SMALL = 1e-3
"""Peak of linear vibration, over the first requested one [1]."""
_SAME = 1e-8
"""Distance of unknowns below which a guess is exact [1]."""


class Backbone(Printable):
    """Backbone curve: free vibrations over their amplitude.

    Attributes:
        frequency: (point,) [rad/s].
        damping_ratio: ζ; that of a linear oscillator that loses as much (point,) [1].
        displacement: At even phases from the peak of the given freedom on
            (point, sample, n) [m, rad].
        velocity: Velocity at the samples (point, sample, n) [m/s, rad/s].
        amplitude: Half of peak to peak (point, n) [m, rad].
        residual: Residual of the method's equations, largest (point,) [1].
        steps: Newton steps (point,).
        result: `Result` codes (point,).
    """

    frequency: Float[Array, " point"]
    damping_ratio: Float[Array, " point"]
    displacement: Float[Array, "point sample n"]
    velocity: Float[Array, "point sample n"]
    amplitude: Float[Array, "point n"]
    residual: Float[Array, " point"]
    steps: Int[Array, " point"]
    result: Int[Array, " point"]


class _Free(AbstractVibratingSystem):
    """System without excitation, with reduced damping."""

    mass: Square
    scale: Vector
    reference_frequency: Scalar
    system: AbstractVibratingSystem
    constant: Vector
    damping_ratio: Scalar

    def damping_matrix(self, frequency):
        taken = 2.0 * self.damping_ratio * frequency * self.mass
        return self.system.damping_matrix(frequency) - taken

    def force(self, q, velocity, phase, frequency):
        return self.system.force(q, velocity, jnp.zeros_like(phase), frequency)

    def excitation(self, phase, frequency, acceleration):
        return self.constant


def _free_system(system, damping_ratio):
    """Return the free system, loaded by the mean excitation at zero frequency."""
    phases = as_real(2.0 * np.pi * np.arange(_PHASES) / _PHASES)
    none = jnp.zeros_like(damping_ratio)
    every = jax.vmap(lambda phase: system.excitation(phase, none, none))(phases)
    return _Free(
        system.mass,
        system.scale,
        system.reference_frequency,
        system,
        jnp.mean(every, axis=0),
        damping_ratio,
    )


def backbone(
    system: AbstractVibratingSystem,
    peaks: Any,
    freedom: int,
    method: AbstractMethod,
    *,
    mode: int = 0,
    throw: bool = True,
) -> Backbone:
    """Return free vibrations that begin as a linear mode, at increasing peaks.

    Args:
        system: The system. If its rotor turns with the excitation, it turns with the
            vibration here: the curve is that of a critical speed.
        peaks: Largest displacement of the freedom from where it rests under the
            constant part of the excitation, from small ones on (point,) [m, rad].
        freedom: Index of the freedom. Static.
        method: `Shooting` or `HarmonicBalance`.
        mode: Number of the mode at rest, by frequency from 0, the speed being the
            reference frequency if it is not fixed. Static.
        throw: Raise if one is not found. Static.

    Returns:
        `Backbone`, differentiable with respect to every number of the system.

    Fails: `STEP_LIMIT`, `NON_FINITE`.

    Raises:
        SolveError: If one was not found and `throw`.
    """
    real_numbers("backbone", "peaks", peaks, "a row of numbers")
    count = system.scale.shape[0]
    for name, number in (("freedom", freedom), ("mode", mode)):
        if not 0 <= number < count:
            raise ValueError(
                f"backbone: `{name}` is {number}; the system has {count} freedoms,"
                f" from 0 to {count - 1}."
            )
    found = _follow(system, as_real(peaks), freedom, method, mode)
    if not throw:
        return found
    return raise_unless_converged(
        found, found.result, lambda: _message(found, peaks), "backbone"
    )


def _message(found, peaks):
    first = int(np.argmax(np.asarray(found.result) != Result.CONVERGED))
    label = Result(int(found.result[first])).label
    return (
        f"backbone: no free vibration found at point {first}, peak"
        f" {float(np.asarray(peaks)[first]):.3g} ({label}). Let peaks grow in smaller"
        " steps, or choose a freedom that takes more part in the mode; constant loads"
        " must have an equilibrium."
    )


def _equations(method, given, freedom):
    """Return (z, ζ, ν) -> residual: the method's, and that of a peak at phase 0."""
    system, peak, rest = given

    def residual(x):
        z, damping_ratio, ratio = x[:-2], x[-2], x[-1]
        u, rate = method.state(z)
        risen = u[freedom] - rest[freedom] - peak / system.scale[freedom]
        held = jnp.stack([risen, rate[freedom]])
        free = _free_system(system, damping_ratio)
        return jnp.concatenate([method.residual(free, z, ratio), held])

    return residual


def _at_rest(system):
    """Return the equilibrium over `scale` (n,); NaN if Newton's method fails."""

    def residual(u, system):
        one = jnp.ones_like(system.reference_frequency)
        none, still = jnp.zeros_like(one), jnp.zeros_like(u)
        return out_of_balance(_free_system(system, none), none, one, u, still, still)

    def linearise(u):
        return (
            residual(u, stop_gradient(system)),
            jax.jacfwd(residual)(u, stop_gradient(system)),
            (),
        )

    def correction(of_u, u, change, _):
        # Motions without stiffness stay where they are.
        return -pseudoinverse(jax.jacfwd(of_u)(u)) @ change

    found = newton(linearise, jnp.zeros_like(system.scale), _STEPS)
    solved = found.result == int(Result.CONVERGED)
    rest = jnp.where(solved, found.x, jnp.nan)
    return attach_by(residual, rest, system, correction)


def _linear(system, rest, freedom, method, mode):
    """Return unknowns at rest, and their derivative by the scaled peak."""
    free = _free_system(system, jnp.zeros_like(system.reference_frequency))
    count = system.scale.shape[0]
    one = jnp.ones_like(free.damping_ratio)
    change = rates(free, one)
    still = jnp.zeros_like(rest)
    matrix = jax.jacfwd(lambda y: change(jnp.zeros_like(one), y))(
        jnp.concatenate([rest, still])
    )
    values, _, vectors = eig(matrix)
    turning = jnp.where(values.imag > 0, values.imag, jnp.inf)
    k = jnp.argsort(turning)[mode]
    shape = vectors[:count, k] / vectors[freedom, k]
    phases = as_real(2.0 * np.pi * np.arange(_PHASES) / _PHASES)[:, None]
    real, imaginary = shape.real[None], shape.imag[None]
    u = jnp.cos(phases) * real - jnp.sin(phases) * imaginary
    rate = -jnp.sin(phases) * real - jnp.cos(phases) * imaginary
    growth = method.unknowns((u, rate))
    every = jnp.broadcast_to(rest, u.shape), jnp.zeros_like(rate)
    ratios = jnp.stack([-values[k].real / jnp.abs(values[k]), values[k].imag])
    none = jnp.zeros_like(ratios)
    return (
        jnp.concatenate([method.unknowns(every), ratios]),
        jnp.concatenate([growth, none]),
    )


@program
def _follow(system, peaks, freedom, method, mode):
    fixed, size = stop_gradient(system), stop_gradient(system.scale[freedom])
    where = _at_rest(system)
    rest, growth = _linear(fixed, stop_gradient(where), freedom, method, mode)

    def linearise(x, height):
        def with_value(x):
            value = _equations(
                method, (fixed, height * size, stop_gradient(where)), freedom
            )(x)
            return value, value

        jacobian, value = jax.jacfwd(with_value, has_aux=True)(x)
        return value, jacobian, ()

    def follow_to(carry, wanted):
        def attempt(state):
            (x, height, slope), step, tries, _ = state
            left = wanted - height
            move = jnp.where(jnp.abs(step) < jnp.abs(left), step, left)
            guess = x + slope * move
            goal = jnp.where(move == left, wanted, height + move)
            found = newton(lambda x: linearise(x, goal), guess, _STEPS)
            # A period of nothing, at an endless frequency, would solve them too. At
            # rest the frequency is another if the speed is not the reference.
            at_rest = height == 0
            off = jnp.linalg.norm(found.x - guess)
            near = at_rest | (off <= _NEAR * jnp.linalg.norm(guess - x) + _SAME)
            good = (found.result == int(Result.CONVERGED)) & near
            still = at_rest | (move == 0)
            secant = (found.x - x) / jnp.where(still, 1.0, move)
            slope = jnp.where(still, slope, secant)
            kept = jax.tree.map(
                lambda a, b: jnp.where(good, a, b),
                (found.x, goal, slope),
                state[0],
            )
            worst = jnp.maximum(found.result, int(Result.STEP_LIMIT))
            found = found._replace(result=jnp.where(good, 0, worst).astype(jnp.int32))
            step = jnp.where(good, 2.0 * move, 0.5 * move)
            return kept, step, tries + 1, found

        def continues(state):
            (_, height, _), _, tries, _ = state
            return (height != wanted) & (tries < _TRIES)

        first = carry, wanted - carry[1], jnp.int32(0), None
        last, _, _, found = lax.while_loop(continues, attempt, attempt(first))
        return last, found

    begin = rest, jnp.zeros_like(size), growth
    heights = stop_gradient(peaks / system.scale[freedom])
    heights = jnp.concatenate([_SMALL * heights[:1], heights])
    _, every = lax.scan(follow_to, begin, heights)
    every = jax.tree.map(lambda x: x[1:], every)

    def report(found, *given):
        system, *_ = given

        def residual(x, given):
            return _equations(method, given, freedom)(x)

        def correction(of_x, x, change, _):
            return -solve_any(jax.jacfwd(of_x)(x), change)

        x = attach_by(residual, found.x, given, correction)
        ratio, frequency = x[-1], x[-1] * system.reference_frequency
        u, rate = method.motion(_free_system(system, x[-2]), x[:-2], ratio)
        return dict(
            frequency=frequency,
            damping_ratio=x[-2],
            displacement=u * system.scale[None],
            velocity=rate * (frequency * system.scale)[None],
            amplitude=amplitudes(u) * system.scale,
            residual=jnp.max(jnp.abs(found.left)),
            steps=found.steps,
            result=found.result,
        )

    def attach_point(found, peak):
        given, solved = (system, peak, where), found.result == int(Result.CONVERGED)
        return unless_failed(partial(report, found), given, solved)

    return Backbone(**jax.vmap(attach_point)(every, peaks))

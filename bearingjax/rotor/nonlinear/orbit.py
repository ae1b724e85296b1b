"""Periodic orbit by Newton's method, with derivatives and stability."""

from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Complex, Float, Int

from ...numerics.compiled.programs import program
from ...numerics.implicit import attach_by, stop_gradient, unless_failed
from ...numerics.lapack import eigvals, solve_any
from ...numerics.result import Result, raise_unless_converged
from ...numerics.shown import Printable
from ...numerics.types import Flag, Number, Scalar, Vector, as_real
from ...numerics.units import unit
from .method import AbstractMethod, Jacobian, Motion, Unknowns
from .system import AbstractVibratingSystem, frequency_of

TOLERANCE = {"float64": 1e-10, "float32": 1e-4}
"""Tolerance of the residual of a method, or of the Newton step towards the orbit
[1]."""
_ROUND_OFF = 1e3
"""Largest residual of cancelling forces, over their sum and round-off [1]."""
STABLE = 1e-6
"""Largest excess of a multiplier of a stable orbit over one, by round-off [1]."""
_FINE = 8
"""Number of places between samples at which a peak is sought."""
_NEARER = 3
"""Newton steps from there to the peak: its error falls from 1e-2 to round-off."""

Point = Float[Array, " x"]
"""Unknowns z and frequency ratio ν: a point of a branch, or a direction there [1]."""


class PeriodicOrbit(Printable):
    """Periodic orbit: a motion with the period of its excitation.

    Attributes:
        frequency: Frequency of the excitation [rad/s].
        displacement: At even phases from 0 on (sample, n) [m, rad].
        velocity: Velocity at the samples (sample, n) [m/s, rad/s].
        amplitude: Half of peak to peak over the period (n,) [m, rad].
        multipliers: Floquet multipliers, the largest first (2n,) [1].
        stable: Whether all multipliers lie within the unit circle.
        unknowns: Unknowns of the method (m,) [1].
        residual: Residual of its equations, largest [1].
        steps: Newton steps.
        result: `Result` code.
    """

    frequency: Scalar
    displacement: Float[Array, "sample n"]
    velocity: Float[Array, "sample n"]
    amplitude: Vector
    multipliers: Complex[Array, " state"]
    stable: Flag
    unknowns: Unknowns
    residual: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]


class CorrectedPoint(NamedTuple):
    """Result of Newton's method.

    Attributes:
        x: Unknowns, the frequency ratio last [1].
        left: Residual of the equations [1].
        jacobian: Jacobian of them, in x [1].
        slopes: What else the equations tell there.
        steps: Newton steps.
        result: `Result` code.
    """

    x: Annotated[Point, unit("1")]
    left: Annotated[Unknowns, unit("1")]
    jacobian: Annotated[Jacobian, unit("1")]
    slopes: Any
    steps: Int[Array, ""]
    result: Int[Array, ""]


def correct(
    system: AbstractVibratingSystem,
    method: AbstractMethod,
    x: Point,
    direction: Point,
    limit: int | Int[Array, ""],
) -> CorrectedPoint:
    """Solve for an orbit in the plane through `x` across `direction`.

    The frequency is an unknown like the others; `direction` says what is held: with
    its last component alone the frequency, with another one alone that component, with
    the tangent of a branch the length along it.

    Args:
        system: The system.
        method: Method that finds the orbit.
        x: Unknowns and frequency ratio to begin with (m + 1,) [1].
        direction: Normal of the plane (m + 1,) [1].
        limit: Most Newton steps.

    Returns:
        `CorrectedPoint`, without derivatives.

    Fails: `STEP_LIMIT`, `NON_FINITE`.
    """

    def evaluate(x):
        left, jacobian, slopes = method.linearise(system, x[:-1], x[-1])
        # Every step stays in the plane.
        within = jnp.zeros_like(left[:1])
        whole = jnp.concatenate([jacobian, direction[None]])
        return jnp.concatenate([left, within]), whole, slopes

    found = newton(evaluate, x, limit)
    return found._replace(left=found.left[:-1], jacobian=found.jacobian[:-1])


def newton(
    linearised: Callable[[Any], tuple[Any, Any, Any]],
    x: Point,
    limit: int | Int[Array, ""],
) -> CorrectedPoint:
    """Run Newton's method, with steps halved where the residual more than doubles.

    Args:
        linearised: x -> equations, as many as unknowns, their Jacobian [1], and what
            else is wanted of the last evaluation.
        x: Unknowns to begin with [1].
        limit: Most steps.

    Returns:
        `CorrectedPoint`, without derivatives.

    Fails: `STEP_LIMIT`, `NON_FINITE`.
    """
    tolerance = TOLERANCE[str(x.dtype)]
    round_off = _ROUND_OFF * jnp.finfo(x.dtype).eps

    linearised = jax.jit(linearised)  # traced once, for the shapes and in the loop

    def evaluate(x):
        left, jacobian, slopes = linearised(x)
        step = -solve_any(jacobian, left)
        return x, left, jacobian, jnp.max(jnp.abs(left)), step, slopes

    def is_solved(here):
        # Forces of a stiff shaft cancel to more than the tolerance of round-off; the
        # step shows how far that is from the orbit.
        x, _, jacobian, size, step, _ = here
        cancels = round_off * jnp.max(jnp.abs(jacobian) @ jnp.abs(x))
        near = (size <= cancels) & (jnp.max(jnp.abs(step)) <= tolerance)
        return (size <= tolerance) | near

    def continues(state):
        here, _, steps = state
        on = ~is_solved(here) & jnp.isfinite(here[3]) & (steps < limit)
        return on | (steps < 0)

    def step(state):
        here, move, steps = state
        there = evaluate(here[0] + move)
        # Half a step where a whole one leads away or to NaN.
        better = (there[3] <= 2.0 * here[3]) | (steps < 0)
        kept = jax.tree.map(lambda a, b: jnp.where(better, a, b), there, here)
        return kept, jnp.where(better, there[4], 0.5 * move), steps + 1

    # The first evaluation is a turn of the loop: compiled once, not twice.
    none = jnp.zeros_like(x)
    shapes = jax.eval_shape(linearised, x)
    slopes = jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes[2])
    blank = x, none, jnp.zeros((x.size, x.size), x.dtype), none[0], none, slopes
    here, _, steps = lax.while_loop(continues, step, (blank, none, jnp.int32(-1)))
    x, left, jacobian, size, _, slopes = here
    codes = int(Result.CONVERGED), int(Result.STEP_LIMIT)
    result = jnp.where(is_solved(here), *codes)
    result = jnp.where(jnp.isfinite(size), result, int(Result.NON_FINITE))
    return CorrectedPoint(x, left, jacobian, slopes, steps, result.astype(jnp.int32))


def along_frequency(size: int, dtype: Any) -> Point:
    """Return the direction that holds the frequency."""
    return jnp.zeros(size + 1, dtype).at[-1].set(1.0)


def solve_orbit(
    system: AbstractVibratingSystem,
    frequency: Number,
    method: AbstractMethod,
    start: Float[Array, "sample n"] | None = None,
    *,
    max_steps: int = 50,
    throw: bool = True,
) -> PeriodicOrbit:
    """Find the periodic orbit at one frequency.

    Args:
        system: The system.
        frequency: Frequency of the excitation [rad/s].
        method: `Shooting` or `HarmonicBalance`.
        start: Displacements to begin with, at even phases from 0 on, such as an
            orbit's by any method (sample, n) [m, rad]; `None`: rest.
        max_steps: Most Newton steps. Static.
        throw: Raise if there is none. Static.

    Returns:
        The orbit, differentiable with respect to every number of the system and the
        frequency; also its multipliers and whether it is stable.

    Fails: `STEP_LIMIT`, `NON_FINITE`.

    Raises:
        SolveError: If it was not found and `throw`.
    """
    frequency, motion = as_real(frequency), beginning(system, start)
    orbit = _solve(system, frequency, method, motion, max_steps)
    if not throw:
        return orbit
    return raise_unless_converged(
        orbit,
        orbit.result,
        lambda: (
            f"No periodic orbit found at {float(frequency):.6g} rad/s: residual"
            f" {float(orbit.residual):.3g} after {int(orbit.steps)} steps"
            f" ({Result(int(orbit.result)).label}). Begin with an orbit nearby"
            " (`start`), or follow a branch to this frequency."
        ),
        "solve_orbit",
    )


@program(quick=True)
def beginning(
    system: AbstractVibratingSystem, start: Float[Array, "sample n"] | None
) -> Motion:
    """Return the initial motion from displacements at even phases [m, rad]; or rest."""
    if start is None:
        none = jnp.zeros((1, system.scale.shape[0]), system.scale.dtype)
        return none, none
    u = jnp.asarray(start) / system.scale[None]
    order = jnp.arange(u.shape[0] // 2 + 1, dtype=u.dtype)[:, None]
    turned = lax.complex(jnp.zeros_like(order), order) * jnp.fft.rfft(u, axis=0)
    return u, jnp.fft.irfft(turned, n=u.shape[0], axis=0)


@program
def _solve(system, frequency, method, motion, max_steps):
    fixed, ratio = stop_gradient(system), frequency / system.reference_frequency
    begin = jnp.append(method.unknowns(stop_gradient(motion)), stop_gradient(ratio))
    hold = along_frequency(begin.shape[0] - 1, begin.dtype)
    found = correct(fixed, method, begin, hold, max_steps)

    def residual(z, given):
        return method.residual(given[0], z, given[1])

    def correction(of_z, z, change, given):
        _, jacobian, _ = method.linearise(given[0], z, given[1])
        return -solve_any(jacobian[:, :-1], change)

    def orbit(system, ratio):
        z = attach_by(residual, found.x[:-1], (system, ratio), correction)
        left = jnp.max(jnp.abs(found.left))
        x = jnp.append(z, ratio)
        return describe_orbit(system, method, x, left, found.steps, found.result)

    return unless_failed(orbit, (system, ratio), found.result == int(Result.CONVERGED))


def describe_orbit(
    system: AbstractVibratingSystem,
    method: AbstractMethod,
    x: Point,
    residual: Scalar,
    steps: Int[Array, ""],
    result: Int[Array, ""],
) -> PeriodicOrbit:
    """Return the orbit of unknowns and frequency ratio.

    Args:
        system: The system.
        method: Method that found it.
        x: Unknowns and frequency ratio (m + 1,) [1].
        residual, steps, result: As in `PeriodicOrbit`.
    """
    z, ratio = x[:-1], x[-1]
    frequency = frequency_of(system, ratio)
    _, jacobian, slopes = method.linearise(system, z, ratio)
    multipliers = eigvals(method.monodromy(system, ratio, jacobian, slopes))
    multipliers = multipliers[jnp.argsort(-jnp.abs(multipliers))]
    u, rate = method.motion(system, z, ratio)
    solved = result == int(Result.CONVERGED)
    return PeriodicOrbit(
        frequency=frequency,
        displacement=u * system.scale[None],
        velocity=rate * (frequency * system.scale)[None],
        amplitude=amplitudes(u) * system.scale,
        multipliers=multipliers,
        stable=solved & (jnp.max(jnp.abs(multipliers)) <= 1.0 + STABLE),
        unknowns=z,
        residual=residual,
        steps=steps,
        result=result,
    )


def amplitudes(samples: Float[Array, "sample n"]) -> Vector:
    """Return half of peak to peak of the trigonometric interpolant over the period.

    Args:
        samples: At even phases (sample, n) [any unit].
    """
    fine = _FINE * samples.shape[0]
    spectrum = jnp.fft.rfft(samples, axis=0)
    every = jnp.fft.irfft(spectrum, n=fine, axis=0) * _FINE
    step = 2.0 * jnp.pi / fine
    each = jax.vmap(_extreme, (1, 0, None))

    def highest(sign):
        at = jnp.argmax(sign * every, axis=0).astype(samples.dtype)
        return each(samples, step * at, step)

    return 0.5 * (highest(1.0) - highest(-1.0))


def _extreme(samples, phase, reach):
    """Return the extremum of the interpolant near a phase, with two derivatives."""
    count = samples.shape[0]
    series = jnp.fft.rfft(samples) / count
    k = jnp.arange(series.shape[0], dtype=samples.dtype)
    # All but the mean, and the highest of an even count, stand for two terms.
    twice = jnp.where((k == 0) | (2 * k == count), 1.0, 2.0)

    def value(phase):
        waves = lax.complex(jnp.cos(k * phase), jnp.sin(k * phase))
        return jnp.sum(twice * (series * waves).real)

    slope = jax.grad(value)

    def newton_step(phase):
        rise, bend = jax.value_and_grad(slope)(phase)
        flat = bend == 0
        move = jnp.where(flat, 0.0, -rise / jnp.where(flat, 1.0, bend))
        return phase + jnp.clip(move, -reach, reach)

    for _ in range(_NEARER):
        phase = newton_step(lax.stop_gradient(phase))
    return value(phase)

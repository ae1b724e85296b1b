"""Vibration in time: decay, beats, run-up through critical speeds, Poincaré points.

The method is explicit, of order 8. On the paper's rotor it makes half the steps of one
of order 5 and, with an error of 1e-5, takes 60 ms for 100 periods. On a shaft of 4
elements implicit methods with Newton's iterations (Kvaerno5, Kvaerno3) needed 20 and 15
times its steps and 40 to 100 times its time. Steps are at most three times the inverse
of the fastest natural frequency, which grows with the elements: reduce such a rotor.
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ...design.checks import check, count, integration, is_traced
from ...numerics.compiled.programs import program
from ...numerics.implicit import stop_gradient
from ...numerics.in_time import IntegrationOptions, Stepping
from ...numerics.in_time import integrate as in_time
from ...numerics.lapack import solve_any
from ...numerics.result import Result, raise_unless_converged
from ...numerics.shown import Printable
from ...numerics.types import Number, Scalar, as_real
from .run_up import FrequencyTable, as_frequency_table
from .system import AbstractVibratingSystem

_STEP_ERROR = 0.02
"""Error of a step over the tolerance: errors of many steps add up [1]."""
_FIRST = 0.01
"""First step over a radian of the reference frequency [1]."""


class History(Printable):
    """Vibration in time; NaN at times that were not reached.

    Attributes:
        time: (time,) [s].
        frequency: Frequency of the excitation (time,) [rad/s].
        phase: Phase of the excitation since time zero (time,) [rad].
        displacement: (time, n) [m, rad].
        velocity: (time, n) [m/s, rad/s].
        steps: Steps of the integration, rejected ones included.
        result: `Result` code.
    """

    time: Float[Array, " time"]
    frequency: Float[Array, " time"]
    phase: Float[Array, " time"]
    displacement: Float[Array, "time n"]
    velocity: Float[Array, "time n"]
    steps: Int[Array, ""]
    result: Int[Array, ""]

    @property
    def failure_message(self) -> str:
        """How far a failed integration came, in words; empty if it came to the end."""
        result = Result(int(self.result))
        if result is Result.CONVERGED:
            return ""
        time, reached = stop_gradient((self.time, self.displacement[:, 0]))
        seen = time[np.isfinite(reached)]
        last = f"{float(seen[-1]):.3g} s" if len(seen) else "the first time"
        cure = "Forces are not finite, or no step was small enough."
        if result is Result.STEP_LIMIT:
            cure = (
                "Allow more `max_steps`; if the shaft has many elements, reduce the"
                " rotor: their fastest vibrations force short steps."
            )
        return (
            f"simulate: {result.label} after {int(self.steps)} steps, behind {last} of"
            f" {float(time[-1]):.3g} s. {cure}"
        )


Start = tuple[Any, Any]
"""Displacement and velocity (n,) [m, rad], [m/s, rad/s]."""


def simulate(
    system: AbstractVibratingSystem,
    times: Any,
    frequency: Number | FrequencyTable,
    *,
    start: Start | None = None,
    end_frequency: Number | None = None,
    force: Callable | None = None,
    options: IntegrationOptions | None = None,
    throw: bool = True,
) -> History:
    """Integrate the vibration in time.

    Where the frequency changes, the phase is its exact integral, and the tangential
    inertia force of unbalance and the rotary inertia are included. The torque that
    accelerates the rotor acts along the z axis, not along the bent shaft.

    Args:
        system: The system.
        times: When to report, rising from 0 on; the motion ends at the last (time,)
            [s].
        frequency: Frequency of the excitation [rad/s], or a `FrequencyTable`.
        start: Displacement [m, rad] and velocity [m/s, rad/s] at time zero, (n,) each;
            `None`: rest.
        end_frequency: At the last time, the frequency changing evenly until
            then [rad/s]; `None`: it is constant.
        force: time [s] -> further forces on the freedoms (n,) [N, N m]; a Module, so
            that its numbers are traced.
        options: Numerics; `None`: `IntegrationOptions()`. The tolerance is the error
            allowed of displacements over `scale`, of velocities over `scale` times the
            reference frequency, and of larger ones relative to themselves. The error of
            a step is held below a fiftieth of it.
        throw: Raise if the end is not reached; otherwise read `result`. Static.

    Returns:
        `History`, differentiable with respect to every number.

    Raises:
        SolveError: If the end is not reached, and `throw` is set.

    Fails: `STEP_LIMIT`; `NON_FINITE` where steps shrink to nothing, as next to forces
        that are not numbers.
    """
    end = as_real(times[-1])
    if not is_traced(times):
        each = np.asarray(times)
        rising = bool(np.all(np.diff(each) > 0)) and each[0] >= 0.0 and each[-1] > 0
        check("simulate", "times", rising, "rising from 0 on", each, "s")
    table = as_frequency_table("simulate", frequency, end, end_frequency)
    return _integrate(system, table, start, force, as_real(times), end, options, throw)


def _integrate(system, table, start, force, times, duration, options, throw):
    options = IntegrationOptions() if options is None else options
    integration("simulate", options)
    begin = beginning("simulate", system, start)
    found = _simulate(system, table, begin, force, times, duration, options)
    if not throw:
        return found
    return raise_unless_converged(
        found, found.result, lambda: found.failure_message, "simulate"
    )


def poincare(
    system: AbstractVibratingSystem,
    frequency: Number | FrequencyTable,
    n_points: int,
    *,
    settle: int = 0,
    start: Start | None = None,
    force: Callable | None = None,
    options: IntegrationOptions | None = None,
    throw: bool = True,
) -> History:
    """Return states once per period of the excitation, at phases 2πk.

    One point that repeats is an orbit of the period of the excitation, m points one of
    m periods, a closed curve an almost periodic motion.

    Args:
        system: The system.
        frequency: Frequency of the excitation [rad/s], or a `FrequencyTable`.
        n_points: Number of points. Static.
        settle: Periods before the first of them. Static.
        start, force, options, throw: As in `simulate`.

    Returns:
        `History` at those times; raises and fails as `simulate`.

    Raises:
        ValueError: If the excitation comes to rest before.
    """
    count("poincare", "n_points", n_points)
    if settle < 0:
        raise ValueError(f"poincare: `settle` is {settle}; it must be zero or more.")
    table = as_frequency_table("poincare", frequency)
    phases = as_real(2.0 * np.pi * (settle + np.arange(n_points)))
    times = jax.vmap(table.time_at)(phases)
    if not is_traced(times) and not np.isfinite(times[-1]):
        raise ValueError(
            f"poincare: point {settle + n_points} is never reached: `frequency` ends at"
            f" {float(table.frequency[-1]):g} rad/s."
        )
    # A little longer than the last, that is at zero where there is one point.
    duration = times[-1] + jnp.where(times[-1] > 0, 0.0, table.time_at(as_real(1.0)))
    return _integrate(system, table, start, force, times, duration, options, throw)


def beginning(
    owner: str, system: AbstractVibratingSystem, start: Start | None
) -> Start:
    """Return displacement and velocity at time zero; `None`: rest."""
    if start is None:
        return jnp.zeros_like(system.scale), jnp.zeros_like(system.scale)
    displacement, velocity = map(as_real, start)
    for name, one in (("displacement", displacement), ("velocity", velocity)):
        if one.shape != system.scale.shape:
            raise ValueError(
                f"{owner}: the {name} of `start` has the shape {one.shape}; the system"
                f" has {system.scale.shape[0]} freedoms."
            )
    return displacement, velocity


@program
def _simulate(*given):
    return simulate_traced(*given)


def simulate_traced(
    system: AbstractVibratingSystem,
    table: FrequencyTable,
    start: Start,
    force: Callable | None,
    times: Float[Array, " time"],
    duration: Scalar,
    options: IntegrationOptions,
) -> History:
    """`simulate`, compiled by the caller."""
    # Imported here, which keeps the import of the package fast.
    import diffrax

    fast = system.reference_frequency
    size = jnp.concatenate([system.scale, system.scale * fast])
    root = jnp.sqrt(jnp.diagonal(system.mass))
    unlike = root[:, None] * root[None, :]
    unit = jnp.eye(root.shape[0], dtype=root.dtype)
    inverse = solve_any(system.mass / unlike, unit, "positive") / unlike
    found = in_time(
        _rates,
        (system, inverse, table, force, size),
        jnp.concatenate(start) / size,
        times,
        duration,
        options,
        Stepping(
            diffrax.Dopri8(),
            _STEP_ERROR,
            first=jnp.minimum(stop_gradient(_FIRST / fast), 0.5 * duration),
            knots=table.time if table.time.shape[0] > 1 else None,
        ),
    )
    turned = jax.vmap(table.at)(times)
    displacement, velocity = jnp.split(found.state * size[None], 2, axis=1)
    return History(
        time=times,
        frequency=turned.frequency,
        phase=turned.phase,
        displacement=displacement,
        velocity=velocity,
        steps=found.steps,
        result=found.result,
    )


def _rates(time, state, given):
    system, inverse, table, force, size = given
    q, velocity = jnp.split(state * size, 2)
    phase, frequency, acceleration = table.at(time)
    damping, gyroscopic = jax.jvp(system.damping_matrix, (frequency,), (acceleration,))
    balance = system.excitation(phase, frequency, acceleration)
    balance = balance - system.force(q, velocity, phase, frequency)
    balance = balance - damping @ velocity - gyroscopic @ q
    if force is not None:
        balance = balance + force(time)
    return jnp.concatenate([velocity, inverse @ balance]) / size


def envelope(
    time: Any, speed: Any, motion: Any, count: int = 80
) -> tuple[np.ndarray, np.ndarray]:
    """Return half of peak to peak over the speed of a run-up, by windows.

    All parts have the same number of revolutions, at least one.

    Args:
        time: (time,) [s].
        speed: (time,) [rad/s].
        motion: (time,) or (time, curve) [m, rad].
        count: Most parts.

    Returns:
        Mean speed (part,) [rad/s] and amplitude (part,) or (part, curve) [m, rad].
    """
    time, speed = np.asarray(time, dtype=float), np.asarray(speed, dtype=float)
    motion = np.asarray(motion, dtype=float)
    steps = 0.5 * np.abs(speed[1:] + speed[:-1]) * np.diff(time)
    turned = np.concatenate([[0.0], np.cumsum(steps)]) / (2.0 * np.pi)
    count = max(min(count, int(turned[-1])), 1)
    place = np.minimum(count * turned / (turned[-1] or 1.0), count - 1).astype(int)
    parts = [np.flatnonzero(place == k) for k in np.unique(place)]
    size = [0.5 * np.ptp(motion[part], axis=0) for part in parts]
    return np.array([speed[part].mean() for part in parts]), np.array(size)

"""Integration of the motion by Diffrax, in units to which the tolerance relates."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..numerics.implicit import stop
from ..numerics.result import Result
from ..numerics.types import Scalar
from .motion import SkidState, SkidSystem, Surroundings, Work
from .ring_load import LoadHistory
from .ring_speed import SpeedTable

_STEP = 0.02
"""Error of a step, of the tolerance: errors of many steps add up [1]."""
_FIRST = 1e-5
"""First step, of the duration [1]."""


class Options(eqx.Module):
    """Settings of an integration.

    Attributes:
        tolerance: Of speeds relative to the fastest ring, of angles in rad, of work
            relative to the kinetic energy of rolling balls or rollers [1].
        max_steps: Step limit. Static.
        derivatives: "reverse" or "forward". Static.
        progress: Whether a bar is shown. Static.
    """

    tolerance: Scalar
    max_steps: int = eqx.field(static=True)
    derivatives: str = eqx.field(static=True)
    progress: bool = eqx.field(static=True)


class Integrated(NamedTuple):
    """A motion, leading axis time; NaN where it was not reached.

    Attributes:
        state: The motion.
        work: Work done since the beginning.
        steps: Steps in time, with those that were rejected.
        rejected: Those.
        result: `Result` code.
    """

    state: SkidState
    work: Work
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    result: Int[Array, ""]


def integrated(
    around: Surroundings,
    start: SkidState,
    times: Float[Array, " time"],
    duration: Scalar,
    options: Options,
) -> Integrated:
    """The motion of balls and cage.

    Args:
        around: What the balls move in.
        start: The motion at time zero.
        times: When it is wanted, rising [s].
        duration: The last time [s].
        options: Settings.
    """
    # Late, so that the package is imported as fast without it.
    import diffrax

    from .rosenbrock import Rodas

    system = _system(around, start)
    controller = diffrax.PIDController(
        rtol=_STEP * options.tolerance,
        atol=_STEP * options.tolerance,
        dtmin=1e-14 * duration,
        force_dtmin=False,
        norm=_largest,
    )
    knots = _knots(around)
    if knots is not None:
        controller = diffrax.ClipStepSizeController(controller, jump_ts=knots)
    forward = options.derivatives == "forward"
    meter = diffrax.TqdmProgressMeter if options.progress else diffrax.NoProgressMeter
    solved = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda time, y, system: system.rates(time, y)),
        Rodas(),
        t0=jnp.zeros_like(duration),
        t1=duration,
        dt0=_FIRST * duration,
        y0=system.packed(start),
        args=system,
        saveat=diffrax.SaveAt(ts=times),
        stepsize_controller=controller,
        adjoint=diffrax.ForwardMode()
        if forward
        else diffrax.RecursiveCheckpointAdjoint(),
        max_steps=options.max_steps,
        throw=False,
        progress_meter=meter(),
    )
    found: Any = solved.ys
    at: Any = solved.ts
    reached = jnp.isfinite(at)
    state, work = jax.tree.map(
        lambda x: jnp.where(
            jnp.expand_dims(reached, tuple(range(1, x.ndim))), x, jnp.nan
        ),
        jax.vmap(system.unpacked)(found),
    )
    steps, rejected = solved.stats["num_steps"], solved.stats["num_rejected_steps"]
    ended = solved.result == diffrax.RESULTS.successful
    limit = solved.result == diffrax.RESULTS.max_steps_reached
    other = jnp.where(limit, int(Result.STEP_LIMIT), int(Result.NON_FINITE))
    result = jnp.where(ended, int(Result.CONVERGED), other).astype(jnp.int32)
    return Integrated(state, work, steps, rejected, result)


def _knots(around):
    """Times at which speeds or loads have a kink, or `None`."""
    tables = [around.speed, getattr(around.loads, "load", None)]
    times = [
        stop(table.time)
        for table in tables
        if isinstance(table, SpeedTable | LoadHistory) and table.time.shape[0] > 1
    ]
    if not times:
        return None
    every = jnp.concatenate(times)
    return jnp.unique(every, size=every.shape[0])


def _system(around, start):
    """The motion in units to which the tolerance relates."""
    bearing, count = around.model.bearing, start.orbit.shape[0]
    rings = jnp.concatenate([around.speed.inner, around.speed.outer])
    fastest = jnp.max(jnp.abs(jnp.concatenate([rings, start.orbit])))
    fastest = jnp.where(fastest > 0, fastest, 1.0)
    energy = count * around.loads.mass * (0.2 * bearing.pitch_diameter * fastest) ** 2
    return SkidSystem(around, *stop((fastest, energy)))


def _largest(errors):
    """Largest of scaled errors; what is no number is no step to be taken."""
    largest = jnp.max(jnp.stack([jnp.max(jnp.abs(e)) for e in jax.tree.leaves(errors)]))
    return jnp.where(jnp.isnan(largest), jnp.inf, largest)

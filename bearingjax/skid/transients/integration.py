"""Integration of the motion, in units to which the tolerance relates."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ...numerics import in_time
from ...numerics.implicit import stop_gradient
from ...numerics.types import Scalar
from ..motion import SkidState, SkidSystem, Surroundings, Work
from ..ring_load import LoadHistory
from ..ring_speed import SpeedTable

_STEP = 0.02
"""Error of a step over the tolerance: errors of many steps add up [1]."""
_FIRST = 1e-5
"""First step over the duration [1]."""


class IntegratedMotion(NamedTuple):
    """A motion, leading axis time; NaN where it was not reached.

    Attributes:
        state: The motion.
        work: Work done since the beginning.
        steps: Steps in time, rejected ones included.
        rejected: Number of rejected steps.
        result: `Result` code.
    """

    state: SkidState
    work: Work
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    result: Int[Array, ""]


def integrate_motion(
    environment: Surroundings,
    start: SkidState,
    times: Float[Array, " time"],
    duration: Scalar,
    options: in_time.IntegrationOptions,
) -> IntegratedMotion:
    """Integrate the motion of balls and cage.

    Args:
        environment: Surroundings of the balls.
        start: The motion at time zero.
        times: Times of the output, rising [s].
        duration: The last time [s].
        options: Settings.
    """
    # Imported here, which keeps the import of the package fast.
    from .rosenbrock import Rodas

    system = _system(environment, start)
    found = in_time.integrate(
        lambda time, y, system: system.rates(time, y),
        system,
        system.pack(start),
        times,
        duration,
        options,
        in_time.Stepping(Rodas(), _STEP, _FIRST * duration, _knots(environment)),
    )
    state, work = jax.vmap(system.unpack)(found.state)
    return IntegratedMotion(state, work, found.steps, found.rejected, found.result)


def _knots(environment):
    """Return the times at which speeds or loads have a kink, or `None`."""
    tables = [environment.speed, getattr(environment.loads, "load", None)]
    times = [
        stop_gradient(table.time)
        for table in tables
        if isinstance(table, SpeedTable | LoadHistory) and table.time.shape[0] > 1
    ]
    if not times:
        return None
    every = jnp.concatenate(times)
    return jnp.unique(every, size=every.shape[0])


def _system(environment, start):
    """Return the system in units to which the tolerance relates."""
    bearing, count = environment.model.bearing, start.orbit.shape[0]
    rings = jnp.concatenate([environment.speed.inner, environment.speed.outer])
    fastest = jnp.max(jnp.abs(jnp.concatenate([rings, start.orbit])))
    fastest = jnp.where(fastest > 0, fastest, 1.0)
    energy = (
        count * environment.loads.mass * (0.2 * bearing.pitch_diameter * fastest) ** 2
    )
    return SkidSystem(environment, *stop_gradient((fastest, energy)))

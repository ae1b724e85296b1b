"""Integration in time by Diffrax: step control, knots, how it ended."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from .implicit import stop_gradient
from .result import Result
from .types import Scalar, as_real
from .units import unit


class IntegrationOptions(eqx.Module):
    """Numerics of an integration in time.

    Attributes:
        tolerance: Error allowed of the state, in units to which it relates [1].
        max_steps: Step limit. Static.
        derivatives: "reverse" or "forward": the mode in which the result can be
            differentiated. Static.
        progress: Whether a bar is shown. Static.
    """

    tolerance: Scalar = eqx.field(converter=as_real, metadata=unit("1"), default=1e-6)
    max_steps: int = eqx.field(static=True, default=200_000)
    derivatives: str = eqx.field(static=True, default="reverse")
    progress: bool = eqx.field(static=True, default=False)


class Stepping(NamedTuple):
    """How an integration steps.

    Attributes:
        solver: Solver of Diffrax.
        step_error: Largest error of a step, over the tolerance [1].
        first: First step [any unit of time].
        knots: Times at which rates may jump [the same]; `None`: none.
    """

    solver: Any
    step_error: float
    first: Scalar
    knots: Float[Array, " knot"] | None = None


class MotionHistory(NamedTuple):
    """A motion, leading axis time; NaN where it was not reached.

    Attributes:
        state: Pytree of states.
        steps: Steps in time, rejected ones included.
        rejected: Number of rejected steps.
        result: `Result` code.
    """

    state: Any
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    result: Int[Array, ""]


def integrate(
    rates: Callable[[Any, Any, Any], Any],
    args: Any,
    start: Any,
    times: Float[Array, " time"],
    duration: Scalar,
    options: IntegrationOptions,
    stepping: Stepping,
) -> MotionHistory:
    """A motion from time zero on.

    Args:
        rates: (time, state, args) -> derivative of the state.
        args: Arguments of `rates`; derivatives are with respect to their numbers.
        start: State at time zero, in units to which the tolerance relates.
        times: Times of the output, rising [any unit of time].
        duration: The last time [the same].
        options: Numerics.
        stepping: Solver and its steps.
    """
    # Late, so that the package is imported as fast without it.
    import diffrax

    solver, step_error, first, knots = stepping
    controller = diffrax.PIDController(
        rtol=step_error * options.tolerance,
        atol=step_error * options.tolerance,
        dtmin=1e-14 * duration,
        force_dtmin=False,
        norm=_largest_error,
    )
    if knots is not None:
        controller = diffrax.ClipStepSizeController(
            controller, jump_ts=stop_gradient(knots)
        )
    forward = options.derivatives == "forward"
    meter = diffrax.TqdmProgressMeter if options.progress else diffrax.NoProgressMeter
    solved = diffrax.diffeqsolve(
        diffrax.ODETerm(rates),
        solver,
        t0=jnp.zeros_like(duration),
        t1=duration,
        dt0=first,
        y0=start,
        args=args,
        saveat=diffrax.SaveAt(ts=times),
        stepsize_controller=controller,
        adjoint=diffrax.ForwardMode()
        if forward
        else diffrax.RecursiveCheckpointAdjoint(),
        max_steps=options.max_steps,
        throw=False,
        progress_meter=meter(),
    )
    at: Any = solved.ts
    reached = jnp.isfinite(at)
    state = jax.tree.map(
        lambda x: jnp.where(
            jnp.expand_dims(reached, tuple(range(1, x.ndim))), x, jnp.nan
        ),
        solved.ys,
    )
    steps, rejected = solved.stats["num_steps"], solved.stats["num_rejected_steps"]
    ended = solved.result == diffrax.RESULTS.successful
    limit = solved.result == diffrax.RESULTS.max_steps_reached
    other = jnp.where(limit, int(Result.STEP_LIMIT), int(Result.NON_FINITE))
    result = jnp.where(ended, int(Result.CONVERGED), other).astype(jnp.int32)
    return MotionHistory(state, steps, rejected, result)


def _largest_error(errors):
    """Largest of scaled errors; a NaN rejects the step."""
    largest = jnp.max(jnp.stack([jnp.max(jnp.abs(e)) for e in jax.tree.leaves(errors)]))
    return jnp.where(jnp.isnan(largest), jnp.inf, largest)

"""Vibration in time: the moving ring, and every rolling element as a mass.

A step is a radian or less of the fastest mode of the loaded bearing, and of what
a cage's contacts add.
"""

import dataclasses
import math
from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

from ..design.checks import check, count, is_traced, of_class
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient
from ..numerics.labels import to_xarray
from ..numerics.result import Result, raise_unless_converged
from ..numerics.shown import Printable
from ..numerics.types import Scalar, in_numpy
from ..numerics.units import unit, units
from ..statics.options import DEFAULT_TOLERANCE
from .dynamics.cage import fastest_of_cage
from .dynamics.stepping import HELD, step_motion
from .model import NoiseModel
from .natural import natural_modes
from .static_start import describe_failure, static_start

_STABLE = 2.5
"""Stability limit of the step: 2.78 radians of the fastest mode [rad]."""
_TOGETHER = 64
"""Number of samples whose contact loads are evaluated together."""
STEP = 1.0
"""Longest step, of the fastest mode [rad]. In the shipped scenes accelerations are then
1.4e-5 to 3e-5 of their root mean square from the limit of short steps, 3e-3 where balls
lose contact; half of it costs twice the time and divides that error by 4 to 20."""
_DOUBLINGS = 3
"""Most halvings of steps that are too long for the contacts."""


class CageMotion(NamedTuple):
    """Record of a cage: along x, along y, and along the pitch circle.

    Attributes:
        displacement: From the bearing's axis and from the even orbit (time, 3) [m].
        acceleration: (time, 3) [m/s²].
    """

    displacement: Annotated[Float[Array, "time 3"], unit("m")]
    acceleration: Annotated[Float[Array, "time 3"], unit("m/s²")]


class Vibration(Printable):
    """Record of the vibration of a bearing; leading axis time.

    Samples are even, over whole turns of the shaft, without the end point.

    Attributes:
        time: (time,) [s].
        displacement: Displacement of the moving ring from equilibrium without form
            errors, its freedoms (time, k) [m, rad].
        acceleration: Acceleration of the moving ring, with frequencies up to
            `bandwidth` (time, k) [m/s², rad/s²].
        contact_load: Load of every contact (time, element, contact) [N].
        azimuth: Azimuth of every rolling element (time, element) [rad].
        shaft_frequency: Frequency of the ring that turns faster [Hz].
        result: `Result` code: `NON_FINITE` where it ran away, `STEP_LIMIT` where its
            steps are too long for the contacts under their largest load.
        cage: Motion of the cage, or `None`.
        steps: Steps of the integration, per sample.

    Static: turns, steps.
    """

    time: Float[Array, " time"] = eqx.field(metadata=unit("s"))
    displacement: Float[Array, "time ring_motion"] = eqx.field(
        metadata=units("m", "rad")
    )
    acceleration: Float[Array, "time ring_motion"] = eqx.field(
        metadata=units("m/s²", "rad/s²")
    )
    contact_load: Float[Array, "time element contact"] = eqx.field(metadata=unit("N"))
    azimuth: Float[Array, "time element"] = eqx.field(metadata=unit("rad"))
    shaft_frequency: Scalar = eqx.field(metadata=unit("Hz"))
    result: Int[Array, ""]
    turns: int = eqx.field(static=True)
    cage: CageMotion | None = None
    steps: int = eqx.field(static=True, default=0)

    to_xarray = to_xarray

    @property
    def duration(self) -> Scalar:
        """Duration of the record [s]."""
        return self.turns / self.shaft_frequency

    @property
    def bandwidth(self) -> Scalar:
        """Bandwidth of the acceleration; content above it is removed [Hz]."""
        return bandwidth(self.time.shape[0] // self.turns, self.shaft_frequency)


def bandwidth(samples: int, shaft_frequency: Any) -> Any:
    """Return the largest frequency of the vibration in a record [Hz].

    Args:
        samples: Per turn of the shaft.
        shaft_frequency: [Hz].
    """
    return HELD * 0.5 * samples * shaft_frequency


def rounding(model: NoiseModel, record: Vibration) -> float:
    """Return the acceleration from residual forces of round-off [m/s²].

    Args:
        model: The bearing.
        record: Its vibration; concrete.
    """
    # Where the motion begins, forces balance to the tolerance of the solve, of all
    # loads; let go, a contact swings to twice that. Round-off of a load, whose approach
    # δ is a difference of lengths l, is 1.5 eps l/δ of it: less, up to l/δ = 3e4.
    load = np.asarray(record.contact_load)
    most = float(np.max(np.sum(load, axis=(1, 2)), initial=0.0))
    return 2.0 * DEFAULT_TOLERANCE[str(load.dtype)] * most / float(model.mass)


def vibration(
    model: NoiseModel,
    *,
    turns: int = 8,
    settle: int = 2,
    samples: int = 2048,
    steps: int | None = None,
    throw: bool = True,
) -> Vibration:
    """Integrate the vibration of a bearing over some turns of its shaft.

    It begins at rest in the equilibrium without form errors. While it settles they grow
    from zero, so slowly that hardly any free vibration remains.

    Args:
        model: The bearing.
        turns: Recorded turns. Static.
        settle: Turns before them; with 0, form errors are present at once. Static.
        samples: Per turn. Static.
        steps: Steps of the integration per sample; `None`: `needed_steps`, and up to
            eight times as many where form errors or impacts press contacts so much
            harder than the load that these are too few. Static; under `jit` it must be
            given.
        throw: Raise if the record is not finite, or the bearing finds no place under
            its load; otherwise read `result`. Static.

    Returns:
        `Vibration`, differentiable with respect to every number of the model.

    Raises:
        TypeError: For another model, or counts that are none.
        ValueError: For counts below 1 (`settle`: 0), a shaft that stands still, or no
            `steps` under `jit`.
        SolveError: If it failed and `throw` is set.

    Fails: `STEP_LIMIT`, `NON_FINITE`, and as `solve_load`.
    """
    of_class("vibration", "model", model, NoiseModel, "a NoiseModel")
    for name, value in (("turns", turns), ("samples", samples)):
        count("vibration", name, value)
    check("vibration", "settle", settle >= 0, "at least 0", settle, "turns")
    shaft = model.shaft_speed
    check("vibration", "speed", shaft > 0, "another than 0", shaft, "rad/s")
    if steps is None:
        found = _with_enough_steps(model, turns, settle, samples)
    else:
        count("vibration", "steps", steps)
        found = _vibration(model, turns, settle, samples, steps)
    if not throw:
        return found
    return raise_unless_converged(
        found,
        found.result,
        lambda: _failure(model, int(found.result), found.steps),
        "vibration",
    )


def _with_enough_steps(model, turns, settle, samples) -> Vibration:
    """Integrate with `needed_steps`, or more where contacts become stiffer."""
    steps = needed_steps(model, samples)
    found = _vibration(model, turns, settle, samples, steps)
    if int(natural_modes(model).result) != Result.CONVERGED:
        return found
    for _ in range(_DOUBLINGS):
        if int(found.result) not in (Result.STEP_LIMIT, Result.NON_FINITE):
            break
        steps *= 2
        found = _vibration(model, turns, settle, samples, steps)
    return found


def _failure(model: NoiseModel, result: int, steps: int) -> str:
    """Return the message of a failed run."""
    if result == Result.NON_FINITE:
        return f"vibration: the motion is not finite; with more `steps` than {steps}?"
    if result == Result.STEP_LIMIT:
        return (
            f"vibration: `steps` is {steps}, too few for the contacts under their"
            " largest load; the motion cannot be trusted."
        )
    reason = describe_failure(model)
    return f"vibration: the bearing finds no place under its load: {reason}."


def needed_steps(model: NoiseModel, samples: int = 2048) -> int:
    """Return steps per sample of at most one radian of the fastest mode.

    The mode is that of the loaded bearing without form errors. With a cage its contacts
    have their largest stiffness under forces up to friction on all balls plus the load
    of the cage.

    Args:
        model: The bearing; none of its numbers traced.
        samples: Per turn of the shaft.

    Raises:
        ValueError: Under `jit`, where numbers are not known.
    """
    if any(is_traced(leaf) for leaf in jax.tree.leaves(model)):
        raise ValueError(
            "vibration: `steps` is None, but the model is traced; give the number, such"
            " as `needed_steps(model)` found before."
        )
    angular = 2.0 * np.pi * float(np.max(in_numpy(natural_modes(model).frequency)))
    # A mode damped beyond creeping moves with ω² τ.
    fastest = max(angular, angular**2 * float(model.retardation))
    if model.cage is not None:
        fastest = max(fastest, float(_of_cage(model)))
    sample = 2.0 * np.pi / float(model.shaft_speed) / samples
    return max(1, math.ceil(sample * fastest / STEP))


@program(quick=True)
def _of_cage(model) -> Scalar:
    """Return a bound of the frequency of cage and balls on the pitch circle [rad/s]."""
    system = model.still_system()
    start, _ = static_start(model, system)
    loads = system.contact_loads(start, jnp.zeros_like(model.mass))
    cage, (ring, ball) = model.cage, system.masses[jnp.array([0, system.mass.size])]
    size, radius = loads.shape[0], system.row.pitch_radius
    push = cage.friction * jnp.sum(loads) + jnp.sqrt(jnp.sum(cage.load**2))
    angular2 = fastest_of_cage(cage, push, size, ball, ring, radius) ** 2
    dragged = cage.friction * jnp.max(jnp.sum(loads, axis=1)) / cage.sliding_speed
    rates = jnp.sqrt(angular2), angular2 * model.retardation, dragged / ball
    return jnp.max(jnp.stack(rates))


@program(quick=True, level=1)
def _vibration(model, turns, settle, samples, steps) -> Vibration:
    system = model.system()
    start, result = static_start(model, system)
    frequency = model.shaft_speed / (2.0 * jnp.pi)
    h = 1.0 / (frequency * samples * steps)
    if settle:
        system = dataclasses.replace(system, growth=settle / frequency)
    masses = system.masses
    # A cage begins centred, and every ball in the middle of its pocket.
    start = jnp.pad(start, (0, masses.shape[0] - start.shape[0]))
    k = system.mass.shape[0]

    def acceleration(motion, velocity, known):
        time, course = known
        return system.forces(motion, velocity, time, start, course) / masses

    def course_at(time):
        return time, system.course(time)

    number = (settle + turns) * samples
    begin = start, jnp.zeros_like(start)

    def select(acceleration):
        return acceleration[:k], None if model.cage is None else acceleration[-3:]

    moved = step_motion(acceleration, begin, h, steps, number, select, course_at)
    motion, (seen, of_cage) = jax.tree.map(lambda r: r[settle * samples :], moved[:2])
    numbers = jnp.arange(settle * samples, number, dtype=start.dtype)
    time = numbers * (h * steps)
    cage = None
    if model.cage is not None:
        along = jnp.stack([jnp.ones_like(h)] * 2 + [system.row.pitch_radius])[None]
        cage = CageMotion(motion[:, -3:] * along, of_cage * along)
    loads = lax.map(
        lambda given: system.contact_loads(*given), (motion, time), batch_size=_TOGETHER
    )
    ended = jnp.all(jnp.isfinite(moved.end[0])) & jnp.all(jnp.isfinite(moved.end[1]))
    peak = jnp.argmax(jnp.max(loads, axis=(1, 2)))
    rate = _rate_bound(system, motion[peak], time[peak])
    short = jnp.where(h * rate < _STABLE, int(Result.CONVERGED), int(Result.STEP_LIMIT))
    lost = jnp.where(ended, short, int(Result.NON_FINITE))
    standing_failed = result != int(Result.CONVERGED)
    return Vibration(
        time=time - time[0],
        displacement=motion[:, :k] - start[None, :k],
        acceleration=seen,
        contact_load=loads,
        azimuth=jax.vmap(system.azimuth)(time, motion),
        shaft_frequency=frequency,
        result=jnp.where(standing_failed, result, lost).astype(jnp.int32),
        turns=turns,
        cage=cage,
        steps=steps,
    )


def _rate_bound(system, motion, time) -> Scalar:
    """Return a bound of all frequencies at a place, from rows of M^-½ K M^-½ [rad/s].

    Source: Gershgorin.
    """
    root = jnp.sqrt(system.masses)
    stiffness = jax.jacfwd(system.contact_forces)(*stop_gradient((motion, time)))
    angular2 = jnp.max(jnp.sum(jnp.abs(stiffness) / jnp.outer(root, root), axis=1))
    return jnp.maximum(jnp.sqrt(angular2), angular2 * system.retardation)

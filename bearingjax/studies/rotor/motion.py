"""Vibration of the rotor of a scene, over frequency and in time."""

import dataclasses

import jax
import numpy as np
from jaxtyping import Float

from ...numerics.compiled.programs import program
from ...numerics.result import Result
from ...numerics.types import as_array
from ...numerics.units import unit
from ...numerics.warning import Warning, warnings_of
from ...rotor import (
    LinearSupport,
    Modes,
    Rotor,
    StaticEquilibrium,
    harmonic_response,
    nonlinear,
    reduction_warnings,
)
from ...rotor.nonlinear.orbit import amplitudes
from ...rotor.shaft import STATION_UNITS
from .read import RotorScene
from .supports import unit_of_length, with_passage

_PARTS = 40
"""Subdivisions of the frequency range; a step of a branch spans at most one."""
_FREQUENCIES = 200
"""Number of frequencies searched for the largest response on linear supports."""
_SAMPLES = 64
"""Number of phases at which a linear vibration is output."""
_ENDINGS = {
    nonlinear.BranchEnd.POINTS: (
        "the branch did not reach the end of the range within the allowed points;"
        " raise `rotor.response.points`, or `scale` where the vibration is far larger"
    ),
    nonlinear.BranchEnd.SMALL_STEP: (
        "the branch could not be followed further: no step, however small, led on;"
        " take more {finer}"
    ),
    nonlinear.BranchEnd.NO_START: (
        "no periodic vibration was found at the first frequency; begin farther from"
        " the resonances, or take more {finer}"
    ),
}
_FINER = {"shooting": "`steps`", "harmonic_balance": "`harmonics` and `samples`"}
"""Settings that increase the accuracy of a method."""
Stopped = tuple[Result, str]


@program(quick=True)
def _amplitudes(samples):
    return amplitudes(samples)


@dataclasses.dataclass(frozen=True)
class RotorResponse:
    """Periodic vibration over the frequency of the excitation.

    Attributes:
        method: "linear", "harmonic_balance" or "shooting".
        frequency: (point,) [rad/s].
        amplitude: Half the peak-to-peak value of (ux uy uz gx gy) of every station
            (point, station, 5) [m, rad].
        displacement: At equidistant phases of the excitation, from 0 on, of every
            station (point, sample, station, 5) [m, rad]; a linear vibration is
            relative to the static equilibrium.
        branch: As in `follow`, with stability, multipliers and events; `None`: linear.
        event_amplitude: Amplitude at each of its events (event, station, 5) [m,
            rad].
        stopped: Code and message, if it ends before the end of the range.
        warnings: Warnings of a reduction, and of unstable vibration.
    """

    method: str
    frequency: Float[np.ndarray, " point"] = dataclasses.field(metadata=unit("rad/s"))
    amplitude: Float[np.ndarray, "point node station_freedom"] = dataclasses.field(
        metadata=unit(STATION_UNITS)
    )
    displacement: Float[np.ndarray, "point sample node station_freedom"]
    branch: nonlinear.Branch | None
    event_amplitude: Float[np.ndarray, "event node station_freedom"]
    stopped: Stopped | None
    warnings: tuple[Warning, ...] = ()


@dataclasses.dataclass(frozen=True)
class RotorTransient:
    """Motion of a rotor in time.

    Attributes:
        time: (time,) [s].
        speed: Rotor speed (time,) [rad/s].
        displacement: (ux uy uz gx gy) of every station (time, station, 5) [m, rad];
            NaN at times that were not reached.
        velocity: Its rate (time, station, 5) [m/s, rad/s].
        steps: Steps of the integration.
        stopped: Code and message, if it ends early.
    """

    time: Float[np.ndarray, " time"] = dataclasses.field(metadata=unit("s"))
    speed: Float[np.ndarray, " time"] = dataclasses.field(metadata=unit("rad/s"))
    displacement: Float[np.ndarray, "time node station_freedom"] = dataclasses.field(
        metadata=unit(STATION_UNITS)
    )
    velocity: Float[np.ndarray, "time node station_freedom"]
    steps: int
    stopped: Stopped | None

    @property
    def n_reached(self) -> int:
        """Number of times reached."""
        return int(np.isfinite(self.displacement).all(axis=(1, 2)).sum())


def respond(
    task: RotorScene,
    rotor: Rotor,
    linear: Rotor | None,
    settled: StaticEquilibrium,
    modes: Modes,
) -> RotorResponse:
    """Compute the periodic vibration of the rotor of a scene.

    Args:
        task: Rotor scene with a response.
        rotor: Rotor on its nonlinear bearings.
        linear: Rotor on linearised bearings, for a linear response.
        settled: Its static equilibrium, where the branch begins.
        modes: Its modes, of which the lowest sets the unit of frequency.
    """
    asked = task.response
    assert asked is not None  # callers check it
    if asked.method == "linear":
        assert linear is not None  # callers check it
        return _linear(task, linear)
    warned: list[Warning] = []
    if (modes_kept := asked.reduction) is not None:
        ends = asked.begin, asked.end
        asked_for = settled.rotor, task.loads, ends, asked.speed, modes_kept
        found = reduction_warnings(*asked_for)
        warned += warnings_of("`rotor.response.reduction`", found)
    scale = asked.scale
    if scale is None and all(isinstance(s, LinearSupport) for s in rotor.supports):
        scale = _largest_response(task, settled.rotor)
    system = _system(task, rotor, settled, modes, scale, asked.speed, asked.reduction)
    method = (
        nonlinear.Shooting(asked.steps)
        if asked.method == "shooting"
        else nonlinear.HarmonicBalance(asked.harmonics, asked.samples, asked.steps)
    )
    samples = asked.steps if asked.method == "shooting" else asked.samples
    rest = np.asarray(system.freedoms(settled.motion))
    unit = float(system.reference_frequency)
    branch = nonlinear.follow(
        system,
        as_array(asked.begin, float),
        as_array(asked.end, float),
        method,
        as_array(np.tile(rest, (samples, 1)), float),
        steps=nonlinear.Steps(
            frequency=abs(asked.end - asked.begin) / (_PARTS * unit),
            points=asked.points,
        ),
    )
    moved = _at_stations(task, system, branch.displacement)
    stopped = None
    if branch.ending in _ENDINGS:
        last = branch.frequency[-1] if len(branch.frequency) else asked.begin
        why = _ENDINGS[branch.ending].format(finer=_FINER[asked.method])
        where = f"at {last / (2.0 * np.pi):.5g} Hz: {why}"
        stopped = Result.STEP_LIMIT, where
    marked = [_at_stations(task, system, one.displacement) for one in branch.events]
    marked = np.reshape(marked, (-1, *moved.shape[1:]))
    return RotorResponse(
        asked.method,
        branch.frequency,
        _half_ranges(moved),
        moved,
        branch,
        _half_ranges(marked),
        stopped,
        (*warned, *branch.warnings),
    )


def _largest_response(task, linear) -> float | None:
    """Return the norm of the largest linear response, with tilts scaled by the shaft
    length, or `None` if there is none [m]."""
    asked, shaft = task.response, task.shaft
    frequency = np.linspace(asked.begin, asked.end, _FREQUENCIES)
    found = harmonic_response(linear, task.loads, frequency, asked.speed)
    arms = np.array([1.0] * 3 + [float(np.ptp(np.asarray(shaft.stations)))] * 2)
    size = float(np.linalg.norm(np.asarray(found.motion) * arms, axis=(1, 2)).max())
    return size if np.isfinite(size) and size > 0.0 else None


def _half_ranges(every):
    """Return half the peak-to-peak value (point, station, 5) of motions (point, sample,
    station, 5), interpolated between samples."""
    flat = (moved.reshape(len(moved), -1) for moved in every)
    found = [np.asarray(_amplitudes(moved)) for moved in flat]
    return np.reshape(found, (len(every), *every.shape[2:]))


def _linear(task: RotorScene, linear: Rotor) -> RotorResponse:
    asked = task.response
    assert asked is not None  # callers check it
    frequency = np.linspace(asked.begin, asked.end, asked.points)
    found = harmonic_response(linear, task.loads, frequency, asked.speed)
    motion = np.asarray(found.motion)[:, task.nodes]
    phase = np.exp(2j * np.pi * np.arange(_SAMPLES) / _SAMPLES)
    moved = np.real(motion[:, None] * phase[None, :, None, None])
    stopped = None
    if not np.isfinite(motion).all():
        stopped = Result.NON_FINITE, "no equilibrium was found at some frequencies"
    none, size = np.zeros((0, *motion.shape[1:])), np.abs(motion)
    return RotorResponse("linear", frequency, size, moved, None, none, stopped)


def run_in_time(
    task: RotorScene, rotor: Rotor, settled: StaticEquilibrium, modes: Modes
) -> RotorTransient:
    """Compute the motion in time of a rotor, from rest in the static equilibrium.

    Args: as `respond`.
    """
    asked = task.transient
    assert asked is not None  # callers check it
    if asked.passage:
        turning = tuple(with_passage(support) for support in rotor.supports)
        rotor = dataclasses.replace(rotor, supports=turning)
    system = _system(task, rotor, settled, modes, None, None, asked.reduction)
    rest = system.freedoms(settled.motion)
    found = nonlinear.simulate(
        system,
        as_array(asked.duration * np.linspace(0.0, 1.0, asked.n_times), float),
        as_array(task.speed, float),
        start=(rest, 0.0 * rest),
        end_frequency=(
            None if asked.speed_to is None else as_array(asked.speed_to, float)
        ),
        options=nonlinear.IntegrationOptions(
            as_array(asked.tolerance, float), asked.max_steps, "forward"
        ),
        throw=False,
    )
    found = jax.device_get(found)
    moved, rate = (
        _at_stations(task, system, part)
        for part in (found.displacement, found.velocity)
    )
    result, stopped = Result(int(found.result)), None
    if result is not Result.CONVERGED:
        seen = found.time[np.isfinite(found.displacement).all(axis=1)]
        last = f"{seen[-1]:.4g} s" if len(seen) else "the first time"
        cure = (
            "raise `rotor.transient.max_steps`, or give it a `reduction`"
            if result is Result.STEP_LIMIT
            else "there forces are no numbers, or no step is small enough"
        )
        where = f"behind {last} of {asked.duration:.4g} s, {int(found.steps)} steps"
        stopped = result, f"ends {where}; {cure}"
    return RotorTransient(
        found.time, found.frequency, moved, rate, int(found.steps), stopped
    )


def _system(
    task, rotor, settled, modes, scale, speed, reduction
) -> nonlinear.VibratingRotor:
    angular = np.imag(np.asarray(modes.eigenvalue))
    slowest = angular[angular > 0].min(initial=np.inf)
    return nonlinear.vibrating_rotor(
        rotor,
        task.loads,
        scale=unit_of_length(rotor, settled) if scale is None else scale,
        reference_frequency=slowest if np.isfinite(slowest) else 2.0 * np.pi,
        speed=speed,
        modes=reduction,
        about=settled,
    )


def _at_stations(task, system, q) -> np.ndarray:
    """Return the motion of the stations (…, station, 5) from the freedoms (…, n)."""
    motions = q @ np.asarray(system.motions).T
    n = 5 * task.shaft.n_nodes
    nodes = motions[..., :n].reshape(*q.shape[:-1], task.shaft.n_nodes, 5)
    return nodes[..., task.nodes, :]

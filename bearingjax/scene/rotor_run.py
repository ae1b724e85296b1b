"""What came of the scene of a rotor."""

import dataclasses

import numpy as np

from ..numerics.result import Result
from ..rotor import CriticalSpeeds, Modes, Rotor
from ..rotor.vibration import Branch
from .rotor_scene import RotorScene


@dataclasses.dataclass(frozen=True)
class Failure:
    """A part of a run that was not solved.

    Attributes:
        part: "preload", "static", "modes", "campbell", "response" or "transient".
        result: Why.
        message: Cause and cure in words.
    """

    part: str
    result: Result
    message: str


@dataclasses.dataclass(frozen=True)
class RotorResponse:
    """Periodic vibration over the frequency of the excitation.

    Attributes:
        method: "linear", "harmonic_balance" or "shooting".
        frequency: (point,) [rad/s].
        amplitude: Half of peak to peak of (ux uy uz gx gy) of every station
            (point, station, 5) [m, rad].
        displacement: At even phases of the excitation, from 0 on, of every station
            (point, sample, station, 5) [m, rad].
        branch: As of `follow`, with stability, multipliers and events; `None`: linear.
    """

    method: str
    frequency: np.ndarray
    amplitude: np.ndarray
    displacement: np.ndarray
    branch: Branch | None


@dataclasses.dataclass(frozen=True)
class RotorTransient:
    """Motion in time.

    Attributes:
        time: (time,) [s].
        speed: Of the rotor (time,) [rad/s].
        displacement: (ux uy uz gx gy) of every station (time, station, 5) [m, rad].
        velocity: Its rate (time, station, 5) [m/s, rad/s].
        reached: How many of the times were reached; NaN stands at the others.
        steps: Steps of the integration.
    """

    time: np.ndarray
    speed: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    reached: int
    steps: int


@dataclasses.dataclass(frozen=True)
class RotorRun:
    """What came of the scene of a rotor.

    Parts that were not asked for, or not solved, are `None`.

    Attributes:
        task: What was asked.
        rotor: The rotor on its bearings, preloaded, before it settles.
        settled: Static equilibrium at the speed of the scene, `Settled`.
        modes: At that speed.
        critical: Critical speeds.
        campbell: Modes over `task.campbell`, the speeds [rad/s].
        response: Periodic vibration over the frequency.
        transient: Motion in time.
        failures: Parts that were not solved.
        warnings: What is doubtful.
    """

    task: RotorScene
    rotor: Rotor | None
    settled: object | None = None
    modes: Modes | None = None
    critical: CriticalSpeeds | None = None
    campbell: Modes | None = None
    response: RotorResponse | None = None
    transient: RotorTransient | None = None
    failures: tuple[Failure, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether all parts were solved."""
        return not self.failures

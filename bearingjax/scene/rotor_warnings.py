"""What is doubtful in the run of a rotor, in words; and modes as plain numbers."""

from typing import Any

import numpy as np

from ..rotor import Modes
from .fit_table import fit_facts, turning
from .rotor_run import RotorRun
from .rotor_scene import RotorScene

RPM = 30.0 / np.pi
"""Revolutions per minute of a speed [rpm s/rad]."""
_TURN = 2.0 * np.pi
_NEAR = 0.1
"""Share of a critical speed within which running is worth a word [1]."""
_DRIFT = 0.5e-6
"""Change of radial clearance over the speed that is worth a word [m]."""


def rotor_warnings(run: RotorRun) -> list[str]:
    """What is doubtful in the scene, in the solving and in the results of a run.

    Args:
        run: From `run_rotor`.
    """
    told = [*run.warnings, *_fast(run.task), *_held_fits(run.task)]
    if run.critical is not None and run.task.speed:
        speed, whirl = run.critical.speed, run.critical.whirl
        near = np.abs(np.abs(run.task.speed) / speed - 1.0) < _NEAR
        if (near & (whirl > 0)).any():
            told.append(
                f"{rpm(run.task.speed)} lies within 10 % of the forward critical speed"
                f" of {rpm(speed[near & (whirl > 0)][0])}"
            )
    branch = None if run.response is None else run.response.branch
    if branch is not None and not branch.stable.all():
        told.append(
            f"{int((~branch.stable).sum())} of {len(branch.stable)} periodic vibrations"
            " are unstable: the rotor does not stay there"
        )
    return told


def _fast(task: RotorScene):
    """Bearings that run faster than their catalogue lets them."""
    top = max(map(abs, (task.speed, *_run_to(task))))
    for mount in {mount.name: mount for mount in task.mounts}.values():
        if mount.installed is not None:
            for text in mount.installed.speed_warnings(top):
                yield f"{mount.name}: {text}"


def _held_fits(task: RotorScene):
    """Bearings whose rings grow over the speeds that are asked for, which their fits
    leave out."""
    for mount, _ in task.seats:
        assert mount.element is not None  # it has fits
        bearing = mount.element.bearing
        left = {
            speed: float(fit_facts(fits, bearing).operating.radial_clearance)
            for speed in (task.speed, *_ends(task))
            if (fits := turning(mount.fits, speed)) is not None
        }
        far = max(left, key=lambda speed: abs(left[speed] - left[task.speed]))
        if abs(left[far] - left[task.speed]) > _DRIFT:
            yield (
                f"{mount.name}: all speeds are solved with the radial clearance at"
                f" {rpm(task.speed)}, {1e6 * left[task.speed]:.4g} µm; at {rpm(far)}"
                f" its fits leave {1e6 * left[far]:.4g} µm"
            )


def _ends(task: RotorScene) -> list[float]:
    """Ends of the speeds that a scene asks for [rad/s]."""
    lines = task.campbell
    return [*(() if lines is None else map(float, lines[[0, -1]])), *_run_to(task)]


def _run_to(task: RotorScene) -> list[float]:
    """Ends of the speeds at which it runs, beside the one of the scene [rad/s]."""
    ends: list[float] = []
    asked, motion = task.response, task.transient
    if asked is not None:
        ends += (asked.begin, asked.end) if asked.speed is None else (asked.speed,)
    if motion is not None and motion.speed_to is not None:
        ends.append(motion.speed_to)
    return ends


def mode_numbers(found: Modes) -> list[tuple[str, np.ndarray]]:
    """Frequency [Hz], damping ratio and whirl of modes, over speeds too.

    Args:
        found: As NumPy holds it.
    """
    value = np.asarray(found.eigenvalue)
    size = np.abs(value)
    ratio = -np.real(value) / np.where(size == 0, 1.0, size)
    return [
        ("frequency", np.imag(value) / _TURN),
        ("damping_ratio", np.where(size == 0, 0.0, ratio)),
        ("whirl", np.asarray(found.whirl)),
    ]


def rpm(speed: Any) -> str:
    """A speed for people.

    Args:
        speed: [rad/s].
    """
    return f"{float(speed) * RPM:.5g} rpm"

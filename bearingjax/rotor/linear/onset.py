"""Onset of instability: the speed at which a mode becomes unstable."""

from typing import Annotated, Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from ...numerics.types import as_real
from ...numerics.units import unit
from ..rotor import Rotor
from .modes import Modes, follow_modes, speed_list

_UNSTABLE = 1e-5
"""Negative damping ratio below which a mode is unstable, beyond the small unsymmetric
part of a bearing's tangent stiffness [1]."""
_LOCATED = 1e-8
"""Accuracy of an onset, over the highest speed [1]."""


class Onset(NamedTuple):
    """Onset of instability of a mode.

    Attributes:
        mode: Its number in the Campbell diagram, from 0.
        speed: From which on it grows; the first speed of the diagram if it does so
            there [rad/s].
        frequency: Frequency of the mode there [Hz].
    """

    mode: int
    speed: Annotated[float, unit("rad/s")]
    frequency: Annotated[float, unit("Hz")]


def instability_onsets(rotor: Rotor, speeds: Any, found: Modes) -> tuple[Onset, ...]:
    """Return where modes of a Campbell diagram first become unstable.

    A mode is unstable if its damping ratio is below -1e-5: round-off, and what the
    tangent of a bearing lacks in symmetry, stay above. Where its damping ratio was
    positive at the speed before, the onset is where it is zero.

    Args:
        rotor: As in `campbell`.
        speeds: (speed,) [rad/s].
        found: From `campbell` at these speeds.

    Returns:
        An onset for each mode that has one, in the order of their speeds. Two crossings
        between neighbouring speeds are not seen. They have no derivatives.
    """
    speeds = np.asarray(speed_list("instability_onsets", speeds))
    value = np.asarray(found.eigenvalue)
    ratios = _ratio(value)
    onsets = []
    for mode in np.flatnonzero((ratios < -_UNSTABLE).any(axis=0)):
        k = int(np.argmax(ratios[:, mode] < -_UNSTABLE))
        speed, there = speeds[k], value[k, mode]
        if k:
            speed, there = _crossing(rotor, speeds[k - 1 : k + 1], value[k - 1, mode])
        hertz = float(there.imag / (2.0 * np.pi))
        onsets.append(Onset(int(mode), float(speed), hertz))
    return tuple(sorted(onsets, key=lambda onset: abs(onset.speed)))


def _ratio(value):
    """Return damping ratios of oscillating modes, 0 for others."""
    swings = value.imag > 0
    return np.where(swings, -value.real, 0.0) / np.where(swings, np.abs(value), 1.0)


def _crossing(rotor, ends, before):
    """Return the onset speed of a mode between two speeds, and its eigenvalue.

    Args:
        rotor: The rotor.
        ends: Two speeds [rad/s].
        before: Eigenvalue of the mode at the first [rad/s].
    """
    # Imported here, which keeps the import of the package fast.
    from scipy.optimize import brentq

    level = 0.0 if _ratio(before) > 0 else _UNSTABLE

    def eigenvalue_at(speed):
        way, _ = follow_modes(rotor, as_real(jnp.asarray([ends[0], speed])), None)
        value = np.asarray(way.eigenvalue)
        return value[1, np.argmin(np.abs(value[0] - before))]

    speed: Any = brentq(
        lambda speed: (
            _ratio(before if speed == ends[0] else eigenvalue_at(speed)) + level
        ),
        *ends,
        xtol=_LOCATED * np.abs(ends).max(),
    )
    return speed, eigenvalue_at(speed)

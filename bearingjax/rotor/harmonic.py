"""Vibration of a linear rotor under all harmonic loads: unbalance, a shaking base."""

from typing import Any

import jax.numpy as jnp
from jax import lax

from ..design.checks import number
from ..numerics.types import as_real
from .loads import RotorLoads
from .modes import speed_list, to_complex
from .response import UnbalanceResponse, steady
from .rotor import Rotor


def harmonic_response(
    rotor: Rotor, loads: RotorLoads, frequencies: Any, speed: Any = None
) -> UnbalanceResponse:
    """Vibration over the frequency of the excitation.

    Args:
        rotor: Linear, such as `Settled.rotor`; a bearing is taken by its slopes.
        loads: Unbalances and acceleration of the base count.
        frequencies: Of the excitation (speed,) [rad/s].
        speed: Of the rotor [rad/s]; `None`: that of the excitation.

    Returns:
        UnbalanceResponse, its `speed` that of the excitation; differentiable with
        respect to every number.

    Raises:
        ValueError: If a loaded station is not there.
    """
    frequencies = speed_list("harmonic_response", frequencies)
    speeds = frequencies
    if speed is not None:
        turning = as_real(speed)
        number("harmonic_response", "speed", turning, "rad/s")
        speeds = jnp.broadcast_to(turning, frequencies.shape)
    loads.check(rotor)
    cosine, sine = loads.unbalanced(rotor)
    moments = lax.complex(cosine, -sine)
    return steady(rotor, moments, to_complex(loads.shaken(rotor)), frequencies, speeds)

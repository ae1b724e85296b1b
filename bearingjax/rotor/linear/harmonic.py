"""Vibration of a linear rotor under harmonic loads: unbalance, base excitation."""

from collections.abc import Iterable
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import lax

from ...design.checks import number
from ...numerics.compiled.programs import program
from ...numerics.lapack import solve_any
from ...numerics.types import Scalar, as_real
from ...numerics.warning import Warning
from ..loads import RotorLoads
from ..rotor import Rotor
from .modes import speed_list, to_complex
from .reduction import craig_bampton
from .response import UnbalanceResponse, steady

MOST_REDUCTION_ERROR = 0.03
"""Change of the linear response by a reduction above which it is warned of [1]."""


def harmonic_response(
    rotor: Rotor, loads: RotorLoads, frequencies: Any, speed: Any = None
) -> UnbalanceResponse:
    """Return the vibration over the frequency of the excitation.

    Args:
        rotor: Linear, such as `StaticEquilibrium.rotor`; a bearing is taken by its
            slopes.
        loads: Unbalances and acceleration of the base count.
        frequencies: Frequencies of the excitation (speed,) [rad/s].
        speed: Speed of the rotor [rad/s]; `None`: that of the excitation.

    Returns:
        UnbalanceResponse, its `speed` that of the excitation; differentiable with
        respect to every number.

    Raises:
        ValueError: If the rotor lacks a loaded station.
    """
    frequencies = speed_list("harmonic_response", frequencies)
    speeds = frequencies
    if speed is not None:
        turning = as_real(speed)
        number("harmonic_response", "speed", turning, "rad/s")
        speeds = jnp.broadcast_to(turning, frequencies.shape)
    loads.check(rotor)
    return _response(rotor, loads, frequencies, speeds)


def unbalance_response(rotor: Rotor, unbalances: Any, speeds: Any) -> UnbalanceResponse:
    """Return the vibration under unbalance, speed by speed.

    The force of an unbalance U at azimuth φ is U Ω² (cos(Ωt + φ), sin(Ωt + φ)).

    Args:
        rotor: The rotor.
        unbalances: `Unbalance`, or several.
        speeds: (speed,) [rad/s].

    Returns:
        UnbalanceResponse, differentiable with respect to every number.
    """
    speeds, loads = speed_list("unbalance_response", speeds), RotorLoads(unbalances)
    loads.check(rotor)
    return _response(rotor, loads, speeds, speeds)


@program(quick=True)
def _response(rotor, loads, frequencies, speeds) -> UnbalanceResponse:
    return steady(rotor, *_forces(rotor, loads), frequencies, speeds)


def _forces(rotor, loads):
    """Return the unbalance moments and the forces of base excitation, complex."""
    cosine, sine = loads.unbalance_forces(rotor)
    return lax.complex(cosine, -sine), to_complex(loads.base_force(rotor))


@program(quick=True)
def reduction_error(
    rotor: Rotor, loads: RotorLoads, frequency: Any, speed: Any, modes: int
) -> Scalar:
    """Return the error of `craig_bampton` in a linear response, over its maximum [1].

    Args:
        rotor: Linear, with a shaft that bends.
        loads: As in `harmonic_response`.
        frequency: Frequency of the excitation [rad/s].
        speed: Speed of the rotor [rad/s].
        modes: As in `craig_bampton`. Static.
    """
    moments, shaken = _forces(rotor, loads)
    force = to_complex(frequency**2) * moments + shaken
    whole = rotor.linearise(speed)

    def nodes(matrices):
        motions = to_complex(matrices.motions)
        value = lax.complex(0.0 * frequency, frequency)
        stiffness = matrices.dynamic_stiffness(value)
        moved = motions @ solve_any(stiffness, motions.T @ force)
        return matrices.split(moved)[0][..., :3]

    exact = nodes(whole)
    change = nodes(whole.project(craig_bampton(rotor, modes))) - exact
    return jnp.max(jnp.abs(change)) / jnp.max(jnp.abs(exact))


def reduction_warnings(
    rotor: Rotor,
    loads: RotorLoads,
    frequencies: Iterable[float],
    speed: Any,
    modes: int,
) -> list[Warning]:
    """Warnings about a reduction that changes the linear response.

    Args:
        rotor, loads, modes: As in `reduction_error`.
        frequencies: Frequencies at which it is tried, until one is worth a warning
            [rad/s].
        speed: Speed of the rotor [rad/s]; `None`: that of the excitation.
    """
    for frequency in frequencies:
        at = as_real(frequency)
        turning = at if speed is None else as_real(speed)
        error = float(reduction_error(rotor, loads, at, turning, modes))
        if error > MOST_REDUCTION_ERROR:
            words = (
                f"a reduction to {modes} modes changes the linear response at"
                f" {float(frequency) / (2.0 * np.pi):.5g} Hz by {100.0 * error:.2g} %;"
                " keep more modes"
            )
            return [Warning("reduction", words, error, MOST_REDUCTION_ERROR)]
    return []

"""Messages on failed rotor equilibria, and warnings on converged ones."""

from typing import Any

import jax.numpy as jnp
import numpy as np

from ..design.checks import is_traced
from ..numerics import Result, Warning
from ..numerics.compiled.programs import program
from .parts import LinearSupport
from .rotor import N_STATION
from .shaft import STATION_FREEDOMS

_SUSPECT, _KEPT = 0.2, 0.05
"""Axial force over that before the shaft moved, by tangent and exact, below which the
preload is checked, and is lost [1]."""


def _largest_freedom(rotor, motion) -> str:
    """Return the name of the freedom with the largest motion."""
    n = N_STATION * rotor.shaft.n_nodes
    length = float(rotor.shaft.stations[-1] - rotor.shaft.stations[0])
    nodes = np.abs(motion[:n].reshape(-1, N_STATION)) * ([1.0] * 3 + [length] * 2)
    stations = [rotor.shaft.node(k) for k in range(rotor.shaft.n_segments + 1)]
    nodes = nodes[stations]
    station, freedom = np.unravel_index(int(np.argmax(nodes)), nodes.shape)
    if n < len(motion) and np.abs(motion[n:]).max() > nodes.max():
        return (
            f"{STATION_FREEDOMS[int(np.argmax(np.abs(motion[n:]))) % 3]} of a housing"
        )
    return f"{STATION_FREEDOMS[freedom]} of station {station}"


def describe_failure(found: Any) -> str:
    """Return the message on a failed equilibrium of a rotor; empty if it converged.

    Args:
        found: Result of `static_equilibrium`.
    """
    result = Result(int(found.result))
    if result is Result.CONVERGED:
        return ""
    start = f"static_equilibrium: {result.label} at {float(found.speed):g} rad/s:"
    if result is Result.NO_LOAD_PATH and not is_traced(found.place):
        return (
            f"{start} nothing takes up the load along"
            f" {_largest_freedom(found.rotor, np.asarray(found.place))}; give the rotor"
            " a support that holds it, or less load."
        )
    if result is Result.NON_FINITE:
        return f"{start} a force of a support is no number."
    return (
        f"{start} {float(found.residual):.3g} of the load is left after"
        f" {int(found.steps)} steps."
    )


def _lost_preload(found) -> str:
    """Return which bearings lost their preload, and why; empty if none did."""
    rotor = found.given
    moved = np.asarray(rotor.at_supports()) @ np.asarray(found.motion)
    left, slopes = (np.asarray(x) for x in (found.support_load, found.stiffness))
    preloaded = [
        k
        for k, support in enumerate(rotor.supports)
        if not isinstance(support, LinearSupport)
        and np.any(np.asarray(getattr(support, "offset", 1.0)))
    ]
    # A tangent gives a lower bound, and whether the bearing need be evaluated.
    before = left[:, 2] - slopes[:, 2, 2] * moved[:, 2]
    if all(abs(left[k, 2]) > _SUSPECT * abs(before[k]) for k in preloaded):
        return ""
    rest = jnp.zeros(N_STATION, found.motion.dtype)
    asked = {
        k: float(_static_force(rotor.supports[k].without_place(), rest, found.speed)[2])
        for k in preloaded
    }
    lost = {
        k: force
        for k, force in asked.items()
        if force and left[k, 2] * np.sign(force) < _KEPT * abs(force)
    }
    if not lost:
        return ""
    kept = {k: max(left[k, 2] * np.sign(force), 0.0) for k, force in lost.items()}
    words = [
        f"the bearing on station {rotor.supports[k].station} is preloaded by"
        f" {abs(force):.4g} N along the shaft and keeps {round(kept[k], 3):.4g} N"
        for k, force in lost.items()
    ]
    travel = max((moved[k, 2] for k in lost), key=abs)
    against = len({np.sign(force) for force in asked.values() if force}) > 1
    cure = (
        "what acts along the shaft is more than the preload"
        if against
        else "no other bearing presses back; turn one of them round (`turned`)"
    )
    return f"{'; '.join(words)}; the shaft goes {1e6 * travel:.4g} µm along z: {cure}"


@program(quick=True)
def _static_force(support, motion, speed):
    """Return the force of a support at zero velocity."""
    return support.force(motion, jnp.zeros_like(motion), speed)


def equilibrium_warnings(found: Any) -> tuple[Warning, ...]:
    """Return warnings of bearings without load or that lost their preload, and of an
    unsupported motion.

    Args:
        found: Result of `static_equilibrium`.
    """
    rotor, known = found.given, (found.motion, found.result)
    if rotor is None or any(map(is_traced, known)) or int(found.result):
        return ()
    warned = []
    loads, slopes = np.asarray(found.support_load), np.asarray(found.stiffness)
    idle = [
        str(support.station)
        for support, load, slope in zip(rotor.supports, loads, slopes, strict=True)
        if not (load.any() or slope.any() or isinstance(support, LinearSupport))
    ]
    if idle:
        where = f"station {', '.join(idle)}"
        words = (
            f"static_equilibrium: the bearing on {where} bears nothing: it has no"
            " stiffness here; give it a preload or a load"
        )
        warned.append(Warning("idle_bearing", words, where=where))
    lost = _lost_preload(found)
    if lost:
        warned.append(Warning("lost_preload", f"static_equilibrium: {lost}"))
    free = np.asarray(found.free)
    springs = all(isinstance(support, LinearSupport) for support in rotor.supports)
    if free.any() and not springs:
        where = _largest_freedom(rotor, free)
        words = (
            f"static_equilibrium: nothing holds {where}: it stays where it is, and a"
            " mode of frequency zero goes with it"
        )
        warned.append(Warning("free_motion", words, where=where))
    return tuple(warned)

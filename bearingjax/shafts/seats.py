"""Bearings of a system of shafts: as supports of its stations, and solved in place."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import is_traced
from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..numerics.compiled.programs import program
from ..numerics.types import Scalar
from ..rotor import BearingSupport, LinearSupport, preload_offset
from ..rotor.rotor import N_STATION
from ..statics.installed import Installed
from ..statics.load_result import solution_at
from ..statics.solution import Solution
from .parts import Seat
from .power import PowerFlow
from .state import SystemSolution
from .system import ShaftSystem

_RING = len(FREEDOMS)


def with_preload_offsets(
    system: ShaftSystem,
    known: dict[Any, Scalar] | None = None,
    *,
    throw: bool = True,
) -> ShaftSystem:
    """Return a system whose bearings have their preload as an axial offset.

    Args:
        system: The system.
        known: Offsets of bearings met before, which is added to.
        throw: Raise if a bearing cannot bear its preload; otherwise its offset is NaN.

    Raises:
        SolveError: If a bearing cannot bear its preload and `throw`.
    """
    known = {} if known is None else known
    seats = []
    for seat in system.seats:
        if seat.preload is not None and seat.installed is not None:
            key = id(seat.installed), id(seat.preload)
            if not is_traced(seat.preload):
                key = id(seat.installed), float(seat.preload)
            if key not in known:
                cold = _as_mounted(seat.installed)
                known[key] = preload_offset(cold, seat.preload, throw=throw)
            seat = eqx.tree_at(
                lambda s: (s.axial_offset, s.preload),
                seat,
                (seat.axial_offset + known[key], None),
                is_leaf=lambda leaf: leaf is None,
            )
        seats.append(seat)
    return eqx.tree_at(lambda s: s.seats, system, tuple(seats))


@program(quick=True)
def _as_mounted(installed):
    """Return the element of a bearing on its seats, at rest and in the cold."""
    cold = installed.conditions
    if cold is not None:
        cold = jax.tree.map(lambda part: part - part, cold)
    installed = eqx.tree_at(
        lambda i: i.conditions, installed, cold, is_leaf=lambda leaf: leaf is None
    )
    return installed.element_at(throw=False)


def supports_of(
    system: ShaftSystem, power: PowerFlow
) -> list[BearingSupport | LinearSupport]:
    """Return each bearing as the support of its station, warm and turning.

    Args:
        system: The system.
        power: Its speeds.
    """
    growth = axial_growth(system)
    return [
        _support(system, seat, power, growth[k]) for k, seat in enumerate(system.seats)
    ]


def _support(system, seat: Seat, power, growth):
    shaft, station = system.station(seat)
    if seat.stiffness is not None:
        return LinearSupport(station, seat.stiffness)
    assert seat.installed is not None
    speed = power.speed[shaft]
    sign = -1.0 if seat.turned else 1.0
    element = seat.installed.element_at(Speed(inner=sign * speed), throw=False)
    offset = seat.axial_offset + sign * growth
    along = jnp.zeros(N_STATION, growth.dtype).at[2].set(offset)
    return BearingSupport(
        station, element, along, turned=seat.turned, inertia=bool(system.inertia)
    )


def axial_growth(system: ShaftSystem) -> Float[Array, " bearing"]:
    """Return how far heat moves each inner ring along its shaft against its seat [m].

    Shaft and housing grow between the bearings, whose temperatures change evenly from
    one to the next; the first bearing of a shaft stays where it is.

    Args:
        system: The system; bearings without temperatures are as cold as mounted.
    """
    zero = jnp.zeros((), jnp.result_type(float))
    found = [zero for _ in system.seats]
    for shaft in system.shafts:
        here = [k for k, seat in enumerate(system.seats) if seat.shaft == shaft.name]
        here.sort(key=lambda k: system.station(system.seats[k])[1])
        for last, this in zip(here, here[1:], strict=False):
            ends = [system.seats[k] for k in (last, this)]
            strain = sum(map(_strain, ends)) / 2.0
            found[this] = found[last] + strain * (ends[1].position - ends[0].position)
    return jnp.stack(found)


def _strain(seat: Seat) -> Any:
    """Return thermal strain of the shaft less that of the housing at a seat [1]."""
    warm = None if seat.installed is None else seat.installed.conditions
    if seat.installed is None or warm is None or seat.installed.mounting is None:
        return 0.0
    seats = seat.installed.mounting
    of_shaft = seats.shaft.expansion * (warm.shaft - warm.reference)
    return of_shaft - seats.housing.expansion * (warm.housing - warm.reference)


def bearing_solutions(
    system: ShaftSystem, solution: SystemSolution, *, points: int = 101
) -> tuple[Solution | None, ...]:
    """Return the solution of each bearing in the equilibrium of the system.

    Args:
        system: The system.
        solution: From `solve_system`.
        points: Positions along the rollers at which loads are reported.

    Returns:
        A `Solution` for each bearing, with its inner ring where the system holds it;
        `None` for springs. Lives, friction and films follow from it. Differentiable.
    """
    found: list[Solution | None] = []
    for k, seat in enumerate(system.seats):
        if seat.installed is None:
            found.append(None)
            continue
        speed = speed_of(system, k, solution.power.speed)
        found.append(in_place(seat.installed, solution.motion[k], *speed, points))
    return tuple(found)


def speed_of(
    system: ShaftSystem, index: int, speeds: Float[Array | np.ndarray, " shaft"]
) -> tuple[Speed, bool | None]:
    """Return the ring speeds of a bearing, and `inertia` of the system.

    Args:
        system: The system.
        index: Number of the bearing.
        speeds: Speeds of all shafts [rad/s].
    """
    seat = system.seats[index]
    turns = speeds[system.station(seat)[0]]
    return Speed(inner=-turns if seat.turned else turns), system.inertia


@program(quick=True)
def in_place(
    installed: Installed,
    motion: Float[Array | np.ndarray, "5"],
    speed: Speed,
    inertia: bool | None,
    points: int,
) -> Solution:
    """Return the solution of a bearing whose inner ring is held by its shaft.

    Args:
        installed: The bearing.
        motion: Motion of its inner ring, in its axes [m, rad].
        speed: Ring speeds, for its fits.
        inertia: Whether rolling elements feel them; `None` at rest. Static.
        points: Positions along the rollers at which loads are reported. Static.
    """
    rings = jnp.zeros(2 * _RING, motion.dtype).at[_RING : _RING + N_STATION].set(motion)
    element = installed.element_at(speed, throw=False)
    known = None if inertia is None else speed
    return solution_at(element, rings, known, points, bool(inertia))

"""Bearings of a system of shafts: as supports of its stations, and solved in place."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import are_known, is_traced
from ..element.bearing_element import BearingElement
from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..fits import FitConditions, fit_state, with_bearing_dimensions
from ..fits.mounting import axial_approach
from ..numerics.compiled.programs import program
from ..numerics.types import Scalar, as_array, as_real, in_numpy, with_fields
from ..rotor import BearingSupport, LinearSupport, preload_offset
from ..rotor.rotor import N_STATION
from ..statics.empty_places import (
    with_empty_places,
    without_empty_places,
)
from ..statics.installed import Installed
from ..statics.load_result import solution_at
from ..statics.solution import Solution
from .parts import Seat
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
                cold = as_mounted(seat.installed)
                known[key] = preload_offset(
                    cold, seat.preload, throw=throw, inertia=system.inertia
                )
            seat = eqx.tree_at(
                lambda s: (s.axial_offset, s.preload),
                seat,
                (as_real(in_numpy(seat.axial_offset) + in_numpy(known[key])), None),
                is_leaf=lambda leaf: leaf is None,
            )
        seats.append(seat)
    return eqx.tree_at(lambda s: s.seats, system, tuple(seats))


def as_mounted(installed: Installed) -> BearingElement:
    """Return the element of a bearing on its seats, at rest and in the cold.

    Args:
        installed: The bearing.
    """
    if not are_known(installed):
        return _as_mounted(installed)
    return _as_mounted(installed_of_kind(installed))


@program(quick=True)
def _as_mounted(installed):
    return in_the_cold(installed).element_at(throw=False)


def in_the_cold(installed: Installed) -> Installed:
    """Return a bearing on its seats, at the temperature of the measured sizes.

    Args:
        installed: The bearing.
    """
    cold = jax.tree.map(lambda part: part - part, installed.conditions)
    return with_fields(installed, conditions=cold)


def supports_of(
    system: ShaftSystem,
    speeds: Float[Array | np.ndarray, " bearing"],
    growth: Float[Array | np.ndarray, " bearing"],
) -> tuple[BearingSupport | LinearSupport, ...]:
    """Return each bearing as a support, warm and turning, without its place.

    Args:
        system: The system. If its numbers are known, the programs are those of all
            bearings of a kind.
        speeds: Speed of the shaft of each bearing [rad/s].
        growth: From `axial_growth` [m].
    """
    found = []
    for k, seat in enumerate(system.seats):
        if seat.stiffness is not None:
            found.append(_springs(seat.stiffness))
            continue
        assert seat.installed is not None
        inside = seat.installed
        bare = with_fields(seat, installed=None, name="", shaft="", turned=False)
        if are_known(seat, speeds, growth):
            inside = installed_of_kind(inside)
        turned = as_array(seat.turned, bool)
        given = inside, bare, turned, growth[k], speeds[k]
        found.append(_bearing_support(*given, bool(system.inertia)))
    return tuple(found)


@program(quick=True)
def _springs(stiffness):
    return LinearSupport(0, stiffness)


@program(quick=True)
def _bearing_support(installed, seat, turned, growth, speed, inertia):
    sense = jnp.where(turned, -1.0, 1.0)
    element = installed.element_at(Speed(inner=sense * speed), throw=False)
    offset = offset_of(seat, growth, sense)
    return BearingSupport(0, element, offset, turned=turned, inertia=inertia)


def offset_of(
    seat: Seat, growth: Scalar, sense: Scalar | float | None = None
) -> Float[Array, "5"]:
    """Return the displacement of an inner ring with its station at zero [m, rad].

    Args:
        seat: Seat of the bearing.
        growth: How far operation displaces the ring along the shaft [m].
        sense: -1 if the bearing is turned round, else 1; `None`: as `seat` says.
    """
    if sense is None:
        sense = -1.0 if seat.turned else 1.0
    offset = seat.axial_offset + sense * growth
    return jnp.zeros(N_STATION, offset.dtype).at[2].set(offset)


def axial_growth(
    system: ShaftSystem, speeds: Float[Array | np.ndarray, " bearing"]
) -> Float[Array, " bearing"]:
    """Return how far operation displaces each inner ring along its shaft [m].

    Shaft and housing grow between the bearings, whose temperatures change evenly from
    one to the next; the first bearing of a shaft stays where it is. The middle of a
    ring stays where it is on its seat, unless `Mounting.ring_width` is given: a ring
    then abuts the next one, or shoulders and spacers that are as warm as the shaft or
    housing, and half of its width grows as it does itself. The place where a
    bearing touches has moved by `axial_approach` since it was mounted in the cold.

    Args:
        system: From `without_bearings`.
        speeds: Speed of the shaft of each bearing [rad/s].
    """
    zero = jnp.zeros((), jnp.result_type(float))
    found = [zero for _ in system.seats]
    for shaft in system.shafts:
        here = [k for k, seat in enumerate(system.seats) if seat.shaft == shaft.name]
        here.sort(key=lambda k: system.station(system.seats[k])[1])
        for last, this in zip(here, here[1:], strict=False):
            ends = [system.seats[k] for k in (last, this)]
            gap = ends[1].position - ends[0].position
            found[this] = found[last] + sum(_half_growth(seat, gap) for seat in ends)
    return jnp.stack(found) + jnp.stack(list(map(_approach, system.seats, speeds)))


def _approach(seat: Seat, speed: Scalar) -> Scalar:
    still = jnp.zeros_like(speed)
    inside: Any = seat.installed
    if inside is None or inside.drawing is None:
        return still
    own = with_bearing_dimensions(inside.mounting, inside.drawing)
    warm = inside.conditions or FitConditions()
    warm = fit_state(own, with_fields(warm, speed=speed, outer_speed=still))
    more, less = (axial_approach(inside.drawing, s) for s in (warm, fit_state(own)))
    return less - more if seat.turned else more - less


def _half_growth(seat: Seat, gap: Any) -> Any:
    """Return the growth of the half of a gap at a seat, of shaft and inner ring less
    that of housing and outer ring [m].

    Args:
        seat: The seat.
        gap: Distance of the bearings [m].
    """
    warm = None if seat.installed is None else seat.installed.conditions
    if seat.installed is None or warm is None or seat.installed.mounting is None:
        return 0.0
    seats: Any = seat.installed.mounting

    def strain(part):
        return getattr(seats, part).expansion * (getattr(warm, part) - warm.reference)

    within = 0.0 if seats.ring_width is None else jnp.minimum(gap, seats.ring_width)
    of_rings = within * (strain("inner_ring") - strain("outer_ring"))
    return 0.5 * (of_rings + (gap - within) * (strain("shaft") - strain("housing")))


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


def in_place(
    installed: Installed,
    motion: Float[Array | np.ndarray, "5"],
    speed: Speed,
    inertia: bool | None,
    points: int,
    fixed_stiffness: bool = False,
) -> Solution:
    """Return the solution of a bearing whose inner ring is held by its shaft.

    Args:
        installed: The bearing.
        motion: Motion of its inner ring, in its axes [m, rad].
        speed: Ring speeds, for its fits.
        inertia: Whether rolling elements feel them; `None` at rest. Static.
        points: Positions along the rollers at which loads are reported. Static.
        fixed_stiffness: As in `BearingModel.evaluate`. Static.
    """
    known = are_known(installed, motion, speed)
    xp: Any = np if known else jnp
    rest = xp.zeros(1)
    rings = xp.concatenate([xp.zeros(_RING), motion, rest])
    if known:
        installed, rings = installed_of_kind(installed), as_real(rings)
    element, turning = _warm(installed, speed), None if inertia is None else speed
    given = element, rings, turning, points, bool(inertia)
    found = solution_at(*given, fixed_stiffness=fixed_stiffness)
    return without_empty_places(found) if known else found


def installed_of_kind(installed: Installed) -> Installed:
    """Return a bearing that shares its program with all of its kind: with empty places,
    and without what changes no solution.

    Args:
        installed: The bearing.
    """
    return with_fields(
        installed,
        drawing=with_empty_places(installed.drawing),
        limits=None,
        limiting_speed=None,
        reference_speed=None,
    )


@program(quick=True)
def _warm(installed, speed):
    return installed.element_at(speed, throw=False)

"""Derivatives of a system of known numbers, by the programs of its bearings.

The equilibrium is an implicit function of the design: its derivative is a linear solve
for the motions, in which each bearing counts by its stiffness. The only program of a
bearing is that of its own derivatives at given motions, the same for all of its kind in
all machines; what is compiled for a machine is small linear algebra.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import on_host
from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..life.life import LifeConditions
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient, with_zeros
from ..numerics.types import with_fields
from ..rotor import LinearSupport
from ..rotor.bearing_support import TURNED
from ..rotor.parts import AbstractSupport
from ..rotor.rotor import N_STATION
from ..rotor.statics import at_equilibrium
from ..statics.empty_places import points_of_kind
from ..statics.installed import Installed
from .bearing_oil import BearingOil
from .duty import bearing_results
from .equilibrium import Search, machine_of, state_at, without_bearings
from .seats import in_place, in_the_cold, installed_of_kind, offset_of, speed_of
from .state import SystemSolution
from .system import ShaftSystem

_INNER = slice(len(FREEDOMS), len(FREEDOMS) + N_STATION)
_AXIAL = 2


class PlacedBearing(NamedTuple):
    """A bearing where its shaft holds it, or a change of its numbers.

    Attributes:
        installed: The bearing.
        motion: Motion of its inner ring, in its axes (5,) [m, rad].
        speed: Ring speeds.
        conditions: Conditions of its life.
        oil: Its oil, or `None`.
    """

    installed: Installed
    motion: Any
    speed: Speed
    conditions: LifeConditions
    oil: BearingOil | None


class BearingNumbers(NamedTuple):
    """What a design asks of a bearing in its place, or a change of it.

    Attributes:
        force: That holds its inner ring there, in its axes (5,) [N, N m].
        peak, lives, warned: From `bearing_results`.
        power: Power lost [W]; zero without oil.
    """

    force: Any
    peak: Any
    lives: dict[str, Any]
    warned: dict[str, Any]
    power: Any


def numbers_of_bearing(
    placed: PlacedBearing, inertia: bool | None, points: int = 101
) -> BearingNumbers:
    """Return what a design asks of a bearing in its place.

    Args:
        placed: The bearing there.
        inertia: Whether its rolling elements feel the speed; `None` at rest. Static.
        points: As in `in_place`. Static.
    """
    installed, motion, speed, conditions, oil = placed
    solution = on_host(in_place(installed, motion, speed, inertia, points))
    results = bearing_results(solution, speed, conditions)
    power = np.zeros(()) if oil is None else on_host(oil.power(solution))
    return BearingNumbers(solution.force[_INNER], *results, power)


@program(quick=True, what="the derivatives of a bearing in its place")
def _numbers_change(placed, change, inertia, points) -> BearingNumbers:
    def evaluate(placed):
        return numbers_of_bearing(placed, inertia, points)

    return with_zeros(*eqx.filter_jvp(evaluate, (placed,), (change,)))


class _NearBearing(AbstractSupport):
    """A bearing near a motion at which its force and stiffness are known.

    Attributes:
        at, known: Motion of the station, and the force there (5,) [m, rad], [N, N m].
        stiffness: Its stiffness there (5, 5) [N/m, N, N m].
    """

    at: Float[Array, "5"]
    known: Float[Array, "5"]
    stiffness: Float[Array, "5 5"]
    station: int = eqx.field(static=True, default=0)
    housing: None = None

    def force(self, motion, velocity, speed, angle=0.0):
        return self.known + self.stiffness @ (motion - self.at)


@program(quick=True)
def _state_change(bare, found, change, force_change) -> SystemSolution:
    """Return the change of the state with the numbers of a system and, at given
    motions, with the forces of its bearings (bearing, 5), in the axes of its shafts."""

    def state(bare, force):
        machine = machine_of(bare)
        whole = machine.whole
        at = stop_gradient(whole.rows) @ found.x
        supports = []
        for k, seat in enumerate(bare.seats):
            if seat.stiffness is not None:
                supports.append(LinearSupport(0, seat.stiffness))
                continue
            sense = np.asarray(TURNED if seat.turned else np.ones(N_STATION))
            offset = sense * offset_of(seat, machine.growth[k])
            stiffness = found.memory[1][k]
            moved = stiffness @ (offset - stop_gradient(offset))
            supports.append(_NearBearing(at[k], force[k] + moved, stiffness))
        whole = with_fields(whole, supports=tuple(supports))
        y, force, _, _ = at_equilibrium(found, whole)
        stiffness = stop_gradient(found.memory[1])
        return state_at(found, (y, force, stiffness), bare, machine)

    given = bare, found.memory[0]
    return with_zeros(*eqx.filter_jvp(state, given, (change, force_change)))


def state_changes(
    system: ShaftSystem,
    mounted: ShaftSystem,
    end: Search,
    placed: Sequence[PlacedBearing | None],
    change: tuple[ShaftSystem, Sequence[Any], Sequence[Any]],
) -> tuple[SystemSolution, list[BearingNumbers | None]]:
    """Return the derivatives of the state and of its bearings along one change.

    Args:
        system: The system.
        mounted: The same with its preloads as offsets.
        end: End of its search.
        placed: Its bearings there; `None` of springs.
        change: Change of the system, and of conditions and oil of each bearing; `None`
            for what is no real number.
    """
    moved, conditions, oils = change
    inertia = system.inertia
    parts = zip(system.seats, mounted.seats, moved.seats, placed, strict=True)
    seats = tuple(_mounted_change(*part, inertia) for part in parts)
    bare = without_bearings(with_fields(moved, seats=seats))
    bare = with_zeros(end.bare, bare)
    forces = np.zeros((len(seats), N_STATION))
    state = jax.device_get(_state_change(end.bare, end.found, bare, forces))
    turning = [speed_of(mounted, k, state.power.speed)[0] for k in range(len(seats))]
    for k, bearing in enumerate(placed):
        alone = {"installed": seats[k].installed, "speed": turning[k]}
        if bearing is not None and _any(alone):
            sense = TURNED if system.seats[k].turned else 1.0
            forces[k] = sense * _change_of(bearing, inertia, **alone).force
    if forces.any():
        state = jax.device_get(_state_change(end.bare, end.found, bare, forces))
    numbers: list[BearingNumbers | None] = []
    for k, bearing in enumerate(placed):
        if bearing is None:
            numbers.append(None)
            continue
        own = seats[k].installed, state.motion[k], turning[k], conditions[k], oils[k]
        change = dict(zip(PlacedBearing._fields, own, strict=True))
        numbers.append(_change_of(bearing, inertia, **change))
    return state, numbers


def _change_of(placed, inertia, **change) -> BearingNumbers:
    """Return the change of what is asked of a bearing with that of some of its fields,
    by the program of its kind."""
    still = jax.tree.map(lambda _: None, placed)
    moved = with_zeros(placed, still._replace(**change))
    kinds = eqx.filter_jvp(installed_of_kind, placed[:1], moved[:1])
    placed, moved = (
        one._replace(installed=kind)
        for one, kind in zip((placed, moved), kinds, strict=True)
    )
    points = points_of_kind(placed.installed.drawing, 101)
    moved = with_zeros(placed, moved)
    return jax.device_get(_numbers_change(placed, moved, inertia, points))


def _mounted_change(seat, mounted, change, placed, inertia):
    """Return the change of a seat with its preload as an offset."""
    if seat.preload is None or placed is None:
        return change
    moved = with_zeros(seat.installed, change.installed)
    cold, moved = eqx.filter_jvp(in_the_cold, (seat.installed,), (moved,))
    way = np.zeros(N_STATION)
    way[_AXIAL] = 1.0
    at = way * np.asarray(mounted.axial_offset - seat.axial_offset)
    rest = placed._replace(installed=cold, motion=at, speed=Speed())
    slope = _change_of(rest, inertia, motion=way).force[_AXIAL]
    force = with_zeros(seat.preload, change.preload)
    if _any(moved):
        force = force - _change_of(rest, inertia, installed=moved).force[_AXIAL]
    offset = with_zeros(seat.axial_offset, change.axial_offset) + force / slope
    return with_fields(change, axial_offset=offset, preload=None)


def _any(tree: Any) -> bool:
    """Return whether a change is one."""
    return any(np.any(leaf) for leaf in jax.tree.leaves(tree))

"""Derivatives of a system of known numbers, by the programs of its bearings.

The equilibrium is an implicit function of the design: its derivative is a linear solve
for the motions, in which each bearing counts by its stiffness. The only program of a
bearing is that of its own derivatives at given motions, the same for all of its kind in
all machines; what is compiled for a machine is small linear algebra.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array, Float

from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..life.life import LifeConditions
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient, with_zeros
from ..numerics.types import as_real, with_fields
from ..rotor import LinearSupport
from ..rotor.bearing_support import TURNED
from ..rotor.parts import AbstractSupport
from ..rotor.rotor import N_STATION
from ..rotor.statics import at_equilibrium
from ..statics.empty_places import points_of_kind
from ..statics.installed import Installed
from .bearing_oil import BearingOil
from .duty import bearing_results, numbers_of
from .equilibrium import (
    describe_search,
    machine_of,
    search_known,
    state_at,
    without_bearings,
)
from .seats import (
    in_place,
    in_the_cold,
    installed_of_kind,
    offset_of,
    speed_of,
    with_preload_offsets,
)
from .system import ShaftSystem

_INNER = slice(len(FREEDOMS), len(FREEDOMS) + N_STATION)
"""The inner ring, but its rotation, among the freedoms of both rings."""
_AXIAL = 2
_CHUNK = 4
"""Changes of a call of a program."""


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
        force: Force on the inner ring that holds it there, in the axes of the bearing
            (5,) [N, N m].
        peak: Largest contact pressure [Pa].
        lives: Numbers of a `Life` by their names.
        warned: Sizes of warnings by their kinds; they have no changes.
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
        points: Positions along the rollers at which loads are reported. Static.
    """
    installed, motion, speed, conditions, oil = placed
    given = installed, motion, speed, inertia, points
    solution = in_place(*given, fixed_stiffness=True)
    peak, lives, warned, _ = bearing_results(solution, speed, conditions)
    power = as_real(0.0) if oil is None else oil.power(solution)
    held = solution.force[_INNER]
    return BearingNumbers(held, peak, lives, stop_gradient(warned), power)


@program(quick=True, what="the lives of a bearing in its place, with derivatives")
def _numbers_with_changes(placed, changes, inertia, points):
    def evaluate(placed):
        return numbers_of_bearing(placed, inertia, points)

    return _value_and_changes(evaluate, (placed,), (changes,))


def _value_and_changes(function, given, changes):
    """Return function(*given), and its change with each of several changes."""

    def push(change):
        value, moved = eqx.filter_jvp(function, given, change)
        return value, with_zeros(value, moved)

    values, moved = jax.vmap(push)(changes)
    return jax.tree.map(lambda leaf: leaf[0], values), moved


def _in_chunks(call: Callable, changes: Any) -> tuple[Any, Any]:
    """Return what `_value_and_changes` does of any number of changes, by a program of
    `_CHUNK` of them.

    Args:
        call: Calls the program.
        changes: Several changes, first axis of all their leaves.
    """
    count, value, found = jax.tree.leaves(changes)[0].shape[0], None, []
    for begin in range(0, count, _CHUNK):

        def cut(leaf, begin=begin):
            part = leaf[begin : begin + _CHUNK]
            rest = ((0, _CHUNK - part.shape[0]),) + ((0, 0),) * (part.ndim - 1)
            return np.pad(part, rest)

        value, moved = jax.device_get(call(jax.tree.map(cut, changes)))
        found.append(moved)
    return value, jax.tree.map(lambda *x: np.concatenate(x)[:count], *found)


def numbers_with_changes(
    placed: PlacedBearing, inertia: bool | None, count: int = 1, **changes: Any
) -> tuple[BearingNumbers, BearingNumbers]:
    """Return `numbers_of_bearing` of known numbers and its changes with those of some
    fields, by the program of a kind of bearing.

    Args:
        placed: The bearing.
        inertia: Whether its rolling elements feel the speed; `None` at rest. Static.
        count: Number of changes, one at least.
        **changes: Changes of fields (change, …), `None` for what is no real number.
    """
    still = jax.tree.map(lambda _: None, placed)
    moved = with_zeros(placed, still._replace(**changes), count)
    points = points_of_kind(placed.installed.drawing, 101)
    kind, others = installed_of_kind(placed.installed), moved.installed
    others = jax.device_get(eqx.filter_vmap(installed_of_kind)(others))
    others = eqx.filter(others, eqx.is_inexact_array)
    placed, moved = placed._replace(installed=kind), moved._replace(installed=others)
    moved = with_zeros(placed, moved, count)
    return _in_chunks(
        lambda some: _numbers_with_changes(placed, some, inertia, points), moved
    )


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
def _state_with_changes(bare, found, changes):
    """Return the state, and its changes with the numbers of a system and, at given
    motions, with the forces of its bearings, in the axes of its shafts."""

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
            held = force[k] + stiffness @ (offset - stop_gradient(offset))
            near = _NearBearing(at=at[k], known=held, stiffness=stiffness)
            supports.append(near)
        whole = with_fields(whole, supports=tuple(supports))
        y, force, _, _ = at_equilibrium(found, whole)
        stiffness = stop_gradient(found.memory[1])
        return numbers_of(state_at(found, (y, force, stiffness), bare, machine))

    return _value_and_changes(state, (bare, found.memory[0]), changes)


def solve_with_changes(
    system: ShaftSystem,
    lives: Sequence[LifeConditions | None],
    oils: Sequence[BearingOil | None],
    changes: tuple[Any, Any, Any] | None = None,
) -> tuple[tuple[dict[str, Any], list[Any]], tuple[dict[str, Any], list[Any]] | None]:
    """Solve a system of known numbers, with derivatives along several changes.

    Args:
        system: The system.
        lives: Conditions of the life of each bearing; `None` of springs.
        oils: Oil of each bearing, or `None`.
        changes: Changes of these three (change, …), `None` for what is no real number.

    Returns:
        Numbers of the state (`numbers_of`) and of each bearing (`BearingNumbers`, or
        `None`), and the same of all changes (change, …); `None` without changes, and if
        there is no equilibrium.
    """
    mounted = with_preload_offsets(system, throw=False)
    end, inertia = search_known(mounted), system.inertia
    state = numbers_of(describe_search(mounted, end)[0])
    placed: list[PlacedBearing | None] = []
    for k, seat in enumerate(system.seats):
        if seat.installed is None:
            placed.append(None)
            continue
        speed, _ = speed_of(system, k, state["speed"])
        rated = lives[k] or LifeConditions()
        own = seat.installed, state["motion"][k], speed, rated, oils[k]
        placed.append(PlacedBearing(*own))
    if changes is None or int(state["result"]):
        each = [
            numbers_with_changes(bearing, inertia)[0] if bearing and rated else None
            for bearing, rated in zip(placed, lives, strict=True)
        ]
        return (state, each), None
    moved, conditions, oil = changes
    count = jax.tree.leaves(changes)[0].shape[0]
    parts = zip(system.seats, mounted.seats, moved.seats, placed, strict=True)
    seats = tuple(_mounted_changes(*part, inertia, count) for part in parts)
    bare = without_bearings(with_fields(moved, seats=seats))
    bare = with_zeros(end.bare, bare, count)
    forces = np.zeros((count, len(seats), N_STATION))

    def change_state():
        def call(some):
            return _state_with_changes(end.bare, end.found, some)

        return _in_chunks(call, (bare, forces))[1]

    of_state = change_state()
    turning = []
    for k, bearing in enumerate(placed):
        if bearing is None:
            turning.append(None)
            continue
        sense = TURNED if system.seats[k].turned else np.ones(N_STATION)
        turns = sense[_AXIAL] * of_state["speed"][:, system.station(system.seats[k])[0]]
        turning.append(
            with_fields(bearing.speed, inner=turns, outer=np.zeros_like(turns))
        )
        alone = {"installed": seats[k].installed, "speed": turning[k]}
        if _any(alone):
            own = numbers_with_changes(bearing, inertia, count, **alone)[1]
            forces[:, k] = sense * own.force
    if forces.any():
        of_state = change_state()
    each, of_each = [], []
    for k, bearing in enumerate(placed):
        numbers = None, None
        if bearing is not None and lives[k] is not None:
            at = of_state["motion"][:, k]
            own = seats[k].installed, at, turning[k], conditions[k], oil[k]
            own = dict(zip(PlacedBearing._fields, own, strict=True))
            numbers = numbers_with_changes(bearing, inertia, count, **own)
        each.append(numbers[0])
        of_each.append(numbers[1])
    return (state, each), (of_state, of_each)


def _mounted_changes(seat, mounted, changes, placed, inertia, count):
    """Return the changes of a seat with its preload as an offset."""
    if seat.preload is None or placed is None:
        return changes
    way = np.zeros((1, N_STATION))
    way[0, _AXIAL] = 1.0
    at = way[0] * np.asarray(mounted.axial_offset - seat.axial_offset)
    cold = in_the_cold(seat.installed)
    rest = placed._replace(installed=cold, motion=at, speed=Speed())
    _, pushed = numbers_with_changes(rest, inertia, motion=way)
    force = with_zeros(seat.preload, changes.preload, count)
    if _any(changes.installed):
        moved = with_zeros(seat.installed, changes.installed, count)
        moved = {"installed": in_the_cold(moved)}
        own = numbers_with_changes(rest, inertia, count, **moved)[1]
        force = force - own.force[:, _AXIAL]
    offset = with_zeros(seat.axial_offset, changes.axial_offset, count)
    offset = offset + force / pushed.force[0, _AXIAL]
    return with_fields(changes, axial_offset=offset, preload=None)


def _any(tree: Any) -> bool:
    """Return whether changes are any."""
    return any(np.any(leaf) for leaf in jax.tree.leaves(tree))

"""Static equilibrium of a system of shafts in its bearings and housing.

Every shaft is condensed on its bearings; these motions, those of the seats in the
housing, and the travel of floating outer rings are the unknowns of one balance, solved
as that of a single rotor.
"""

from functools import partial
from typing import Annotated, Any, NamedTuple

import jax.numpy as jnp
import jax.scipy as jsp
import numpy as np
from jaxtyping import Array, Float

from ..design import AngularContactBallBearing
from ..design.checks import are_known, is_traced, of_class
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient, unless_failed
from ..numerics.minimise import Minimum
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar, array_namespace, in_numpy, with_fields
from ..numerics.units import unit
from ..rotor import LinearSupport, Rotor
from ..rotor.condensation import CondensedRotor, condense
from ..rotor.loads import acceleration_load
from ..rotor.rotor import N_STATION
from ..rotor.statics import (
    at_equilibrium,
    known_at,
    search_by_parts,
    search_equilibrium,
)
from ..statics.support import axial_senses
from .power import PowerFlow, power_flow
from .seats import axial_growth, offset_of, supports_of, with_preload_offsets
from .state import SystemSolution, describe_state, moving_part
from .system import ShaftSystem

_UNUSED = "ball_deviation azimuth_deviation raceway_deviation filled published".split()
_SLID = 1e-3
"""Way along a shaft over its length from which it has slid off its bearings [1]."""


def solve_system(system: ShaftSystem, *, throw: bool = True) -> SystemSolution:
    """Find the equilibrium of a system of shafts.

    Args:
        system: The system. Many load cases are solved at once by `jax.vmap` over
            changed leaves, with `throw=False`.
        throw: Raise if there is none. Static.

    Returns:
        SystemSolution, differentiable with respect to every number of the system.

    Fails: `STEP_LIMIT`, `NO_LOAD_PATH`, `NON_FINITE`.

    Raises:
        TypeError: If `system` is something else.
        ValueError: If the torques do not balance, see `power_flow`.
        SolveError: If no equilibrium was found and `throw`; it names the part that
            nothing holds.
    """
    of_class("solve_system", "system", system, ShaftSystem, "a ShaftSystem")
    found, place = searched_system(system)
    if throw:
        found = raise_unless_converged(
            found,
            found.result,
            lambda: describe_failure(system, found, place),
            "solve_system",
        )
    return found


def searched_system(
    system: ShaftSystem,
) -> tuple[SystemSolution, Float[Array, " motion"]]:
    """Return the solution, and the end of the search even if it failed (motion,).

    Args:
        system: The system.

    Raises:
        ValueError, SolveError: As `solve_system`, but for a failed search.
    """
    found, place = system_state(with_preload_offsets(system))
    power = in_numpy(found.power)
    check_torques(system, power.output_shaft, *torques_left(power))
    return found, place


def torques_left(power: PowerFlow) -> tuple[Any, Any]:
    """Return the torque on a shaft end that nothing names, and the largest of all.

    Args:
        power: Torques of a system.

    Returns:
        Two torques [N m]; the first `None` if there is no such end.
    """
    every = [abs(mesh.torque) for mesh in power.meshes]
    every += [abs(one) for one in power.coupling]
    if not every:
        return power.output, np.zeros(())
    return power.output, array_namespace(every[0]).stack(every).max()


def check_torques(system: ShaftSystem, shaft: Any, left: Any, most: Any) -> None:
    """Raise if given torques leave some on a shaft end that nothing names.

    Args:
        system: The system.
        shaft: Name of the shaft with that end.
        left, most: From `torques_left`.

    Raises:
        ValueError: If they do not balance.
    """
    given = [*(w for w in system.wheels if w.torque is not None or w.power is not None)]
    given += [c for c in system.couplings]
    known = [part.name for part in given if part.shaft == shaft]
    if left is None or not known or is_traced(left):
        return
    if abs(float(left)) > 1e-6 * float(most):
        raise ValueError(
            f"ShaftSystem: the torques do not balance: {float(left):.6g} N m are left"
            f" on shaft {shaft} beside {', '.join(known)}; leave out one of the"
            " torques, which then follows from the others."
        )


def system_state(
    system: ShaftSystem,
) -> tuple[SystemSolution, Float[Array, " motion"]]:
    """Return the solution, and the end of the search even if it failed (motion,).

    A system of known numbers is solved with a call of a program for each bearing, which
    is that of its kind; one that is traced is one program, which has derivatives.

    Args:
        system: From `with_preload_offsets`.
    """
    if not are_known(system):
        return _state_in_one(system)
    return describe_search(system, search_known(system))


class Search(NamedTuple):
    """End of the search of a system of known numbers.

    Attributes:
        bare: The system without its bearings.
        machine: The same, worked out.
        found: End of the search, whose memory are force, stiffness and damping of the
            bearings there in the axes of their shafts.
    """

    bare: ShaftSystem
    machine: "Machine"
    found: Minimum


def search_known(system: ShaftSystem) -> Search:
    """Search the equilibrium with a call of a program for each bearing.

    Args:
        system: From `with_preload_offsets`, of known numbers.
    """
    bare = without_bearings(system)
    machine, length = _assemble(bare)
    speeds = np.asarray(machine.whole.speed)
    supports = supports_of(system, speeds, np.asarray(machine.growth))
    known = speeds if system.inertia is not None else [None] * len(supports)
    pairs = zip(supports, known, strict=True)
    respond = [partial(one.respond_alone, speed=at) for one, at in pairs]
    return Search(bare, machine, search_by_parts(machine.whole, length, respond))


def describe_search(
    system: ShaftSystem, end: Search
) -> tuple[SystemSolution, Float[Array, " motion"]]:
    """Return `system_state` at the end of a search.

    Args:
        system: The system that was searched.
        end: From `search_known`.
    """
    return _describe(*end, _held_senses(system))


class Machine(NamedTuple):
    """A system of shafts without what its bearings are.

    Attributes:
        power: Speeds, torques, forces of the wheels.
        rotors: Its shafts, on springs in place of bearings.
        points: Forces of wheels and loads on the nodes of each [N, N m].
        whole: All of it, condensed on the bearings.
        growth: From `axial_growth` [m].
    """

    power: PowerFlow
    rotors: list[Rotor]
    points: list[Float[Array, "node 5"]]
    whole: CondensedRotor
    growth: Annotated[Float[Array, " bearing"], unit("m")]


def without_bearings(system: ShaftSystem) -> ShaftSystem:
    """Return a system whose bearings are not there, but their seats and springs, and of
    mounted angular contact bearings, in place of the drawing, their sizes.

    Args:
        system: The system, or a change of its numbers.
    """

    def empty(seat):
        inside, sizes = seat.installed, None
        if inside is None:
            return seat
        row = inside.drawing.bearing
        if inside.mounting is not None and isinstance(row, AngularContactBallBearing):
            sizes = with_fields(row, n_balls=1, **dict.fromkeys(_UNUSED))
        bare = with_fields(inside, drawing=sizes, limits=None, preload=None)
        bare = with_fields(bare, limiting_speed=None, reference_speed=None)
        return with_fields(seat, installed=bare)

    return with_fields(system, seats=tuple(map(empty, system.seats)))


def machine_of(system: ShaftSystem) -> Machine:
    """Work out a system but for its bearings.

    Args:
        system: From `without_bearings`.
    """
    power = power_flow(system)
    rotors, points = [], []
    for index in range(len(system.shafts)):
        here = [system.station(system.seats[k])[1] for k in system.seats_on(index)]
        line, beam = system.shafts[index], system.beam(index)
        springs = [LinearSupport(station, jnp.zeros(N_STATION)) for station in here]
        rotors.append(Rotor(beam, (), springs, rigid=line.rigid))
        points.append(_points(system, power, index, beam))
    whole = with_fields(_couple(system, rotors, points, power), supports=())
    return Machine(power, rotors, points, whole, axial_growth(system, whole.speed))


@program(quick=True)
def _assemble(system) -> tuple[Machine, Scalar]:
    return machine_of(system), max_length(system)


@program(quick=True)
def _describe(system, machine, found, held):
    whole = machine.whole
    found = _name_end(system, found, whole, held)
    at = known_at(found)[:3]
    return state_at(found, at, system, machine), whole.motion(found.x)


@program(quick=True)
def _state_in_one(system):
    machine = machine_of(without_bearings(system))
    supports = supports_of(system, machine.whole.speed, machine.growth)
    machine = machine._replace(whole=with_fields(machine.whole, supports=supports))
    whole = stop_gradient(machine.whole)
    found = search_equilibrium(whole, stop_gradient(max_length(system)))
    found = _name_end(system, found, whole, _held_senses(system))

    def describe(system, machine) -> SystemSolution:
        y, force, stiffness, _ = at_equilibrium(found, machine.whole)
        return state_at(found, (y, force, stiffness), system, machine)

    solved = found.result == Result.CONVERGED
    solution = unless_failed(describe, (system, machine), solved)
    return solution, whole.motion(found.x)


def state_at(
    found: Minimum, at: tuple[Any, ...], system: ShaftSystem, machine: Machine
) -> SystemSolution:
    """Return the state at the end of a search, with derivatives; NaN if it failed.

    Args:
        found: End of the search.
        at: Condensed motions, and force and stiffness of the bearings there.
        system: The system; its bearings need not be there.
        machine: The same, worked out.
    """
    power, rotors, points, whole, growth = machine
    offsets = [
        jnp.zeros(N_STATION) if seat.installed is None else offset_of(seat, moved)
        for seat, moved in zip(system.seats, growth, strict=True)
    ]
    given = system, rotors, points, whole, power
    return describe_state(found, at, jnp.stack(offsets), *given)


def _name_end(system, found, whole, held):
    """Return the end of a search; of a shaft that slid off its bearings in a direction
    in which none holds it, `NO_LOAD_PATH` in place of `STEP_LIMIT`: the search may end
    before it is far."""
    motion, first = stop_gradient(whole).motion(found.x), 0
    away = jnp.asarray(False)
    for index, line in enumerate(system.shafts):
        count = N_STATION * (sum(system.plans[index].divisions) + 1)
        along, first = motion[first + 2 : first + count : N_STATION], first + count
        for sense in {1, -1} - set(held[index]):
            slid = jnp.min(sense * along) > _SLID * jnp.sum(stop_gradient(line.length))
            away = away | slid
    away = away & (found.result == Result.STEP_LIMIT)
    code = jnp.asarray(int(Result.NO_LOAD_PATH), found.result.dtype)
    return found._replace(result=jnp.where(away, code, found.result))


def _held_senses(system: ShaftSystem) -> tuple[tuple[int, ...], ...]:
    """Return the senses along each shaft in which a bearing holds it."""
    shafts = range(len(system.shafts))
    return tuple(tuple(sorted(_senses_on(system, index))) for index in shafts)


def _senses_on(system, index) -> set[int]:
    held: set[int] = set()
    for k in system.seats_on(index):
        seat = system.seats[k]
        if seat.floating:
            continue
        if seat.installed is None:
            loose = not is_traced(seat.stiffness) and not float(seat.stiffness[2])
            held |= set() if loose else {1, -1}
            continue
        sense = -1 if seat.turned else 1
        held |= {sense * one for one in axial_senses(seat.installed.drawing.bearing)}
    return held


def max_length(system: ShaftSystem) -> Scalar:
    """Return the length of the longest shaft [m]."""
    return jnp.max(jnp.stack([jnp.sum(line.length) for line in system.shafts]))


def _points(system, power, index, beam) -> Float[Array, "node 5"]:
    """Return forces of wheels and loads on the nodes of a shaft, in its axes."""
    line = system.shafts[index]
    frame = line.frame
    acting = [
        (system.wheel(mesh.wheel), mesh.force, jnp.cross(mesh.place, mesh.force))
        for mesh in power.meshes
    ]
    acting += [(load, load.force, load.moment) for load in system.loads]
    nodes = jnp.zeros((beam.n_nodes, N_STATION), frame.dtype)
    for part, force, moment in acting:
        if part.shaft == line.name:
            both = jnp.concatenate([frame @ force, (frame @ moment)[:2]])
            nodes = nodes.at[beam.node(system.station(part)[1])].add(both)
    return nodes


def _couple(system, rotors, points, power) -> CondensedRotor:
    """Return all shafts on their bearings, with seats and floating rings, as one."""
    parts, order, turns = [], [], []
    for index, rotor in enumerate(rotors):
        weight = acceleration_load(rotor, system.shafts[index].frame @ system.gravity)
        force = weight + points[index].reshape(-1)
        parts.append(condense(rotor, force, power.speed[index]))
        here = system.seats_on(index)
        order += here
        turns += [power.speed[index]] * len(here)
    arm = 0.5 * max_length(system)
    housing, seats = system.housing, ()
    stiffness = [part.stiffness for part in parts]
    back = [part.back for part in parts]
    if housing is not None:
        seats, size = housing.seats, housing.freedoms
        scale = jnp.tile(
            jnp.concatenate([jnp.ones(3), jnp.ones(size - 3) / arm]), len(seats)
        )
        stiffness.append(scale[:, None] * housing.matrix * scale[None, :])
        back.append(jnp.diag(scale))
    floating = [k for k, seat in enumerate(system.seats) if seat.floating]
    if floating:
        stiffness.append(jnp.zeros((len(floating),) * 2))
        back.append(jnp.eye(len(floating)))
    rows = jsp.linalg.block_diag(
        *(part.rows.reshape(-1, part.rows.shape[-1]) for part in parts)
    )
    rows = rows.reshape(len(order), N_STATION, -1)
    n_more = sum(k.shape[0] for k in stiffness[len(parts) :])
    more = jnp.zeros((len(order), N_STATION, n_more), rows.dtype)
    for row, k in enumerate(order):
        seat = system.seats[k]
        if housing is not None and seat.name in seats:
            frame = system.shaft(seat.shaft).frame
            first = seats.index(seat.name) * housing.freedoms
            more = more.at[row, :3, first : first + 3].set(-frame)
            if housing.freedoms == 6:
                more = more.at[row, 3:, first + 3 : first + 6].set(-frame[:2] / arm)
        if k in floating:
            column = n_more - len(floating) + floating.index(k)
            more = more.at[row, 2, column].set(-1.0)
    back_at = np.argsort(order)
    supports = [support for rotor in rotors for support in rotor.supports]
    still = jnp.zeros(n_more, rows.dtype)
    return CondensedRotor(
        stiffness=jsp.linalg.block_diag(*stiffness),
        force=jnp.concatenate([*(part.force for part in parts), still]),
        rows=jnp.concatenate([rows, more], axis=2)[back_at],
        back=jsp.linalg.block_diag(*back),
        there=jnp.concatenate([*(part.there for part in parts), still]),
        supports=tuple(supports[k] for k in back_at),
        speed=jnp.stack([turns[k] for k in back_at]),
    )


def describe_failure(system: ShaftSystem, found: SystemSolution, place: Any) -> str:
    """Return the message on a system without equilibrium.

    Args:
        system: The system.
        found: From `solve_system`.
        place: End of its search (motion,).
    """
    result = Result(int(found.result))
    start = f"solve_system: {result.label}:"
    if result is Result.NO_LOAD_PATH and not is_traced(place):
        return (
            f"{start} nothing takes up the load along {moving_part(system, place)};"
            " locate the shaft there, turn a bearing round, or give less load."
        )
    if result is Result.NON_FINITE:
        return (
            f"{start} a force is no number; look for a bearing that cannot bear its"
            " preload, or parts that passed each other on their shaft."
        )
    return (
        f"{start} {float(found.residual):.3g} of the load is left after"
        f" {int(found.steps)} steps."
    )

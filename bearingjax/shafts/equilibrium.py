"""Static equilibrium of a system of shafts in its bearings and housing.

Every shaft is condensed on its bearings; these motions, those of the seats in the
housing, and the travel of floating outer rings are the unknowns of one balance, solved
as that of a single rotor.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import jax.scipy as jsp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design.checks import is_traced
from ..element.frame import FREEDOMS
from ..element.inertia import Speed
from ..numerics.implicit import stop, unless_failed
from ..numerics.programs import program
from ..numerics.result import Result, raise_unless_converged
from ..numerics.types import Scalar
from ..rotor import (
    STATION_FREEDOMS,
    BearingSupport,
    LinearSupport,
    Rotor,
    preload_offset,
)
from ..rotor.condensed import Condensed, condensed
from ..rotor.loads import accelerated
from ..rotor.rotor import N_STATION
from ..rotor.statics import at_equilibrium, searched, softest
from ..statics.installed import Installed
from ..statics.load_result import solution_at
from ..statics.solution import Solution
from ..statics.support import axial_senses
from .parts import Seat
from .power import PowerFlow, power_flow
from .system import ShaftSystem

_RING = len(FREEDOMS)
_TURNED = np.array([1.0, -1.0, -1.0, 1.0, -1.0])
"""Signs of (ux uy uz gx gy) from a half turn about x."""
_SLID = 1e-3
"""Way along a shaft over its length from which it has slid off its bearings [1]."""


class ShaftState(eqx.Module):
    """A shaft in equilibrium, in its local axes.

    Forces and moments are those by which the part of the shaft at larger z acts on the
    part before it; `side` counts both ends of every beam element, so that an inner node
    occurs twice, just before and just after what acts there.

    Attributes:
        position: Along the shaft (side,) [m].
        displacement: (ux uy uz gx gy) (side, 5) [m, rad].
        shear: Force (Fx, Fy, Fz) in the section (side, 3) [N].
        moment: Bending moment (Mx, My) (side, 2) [N m].
        speed: Of the shaft [rad/s].
    """

    position: Float[Array, " side"]
    displacement: Float[Array, "side 5"]
    shear: Float[Array, "side 3"]
    moment: Float[Array, "side 2"]
    speed: Scalar


class SystemSolution(eqx.Module):
    """A system of shafts in equilibrium. Numbers are NaN unless it converged.

    Attributes:
        shafts: State of each shaft.
        load: Force and moment of the shaft on the inner ring of each bearing, in global
            axes (bearing, 6) [N, N m]. The moment about the shaft is zero.
        displacement: Of each inner ring against its outer ring, in global axes, without
            what preload and heat displace (bearing, 6) [m, rad].
        housing: Motion of each seat of the housing in global axes (seat, 3 or 6)
            [m, rad].
        motion: Inner ring in each bearing, in the axes of the bearing (bearing, 5)
            [m, rad].
        stiffness: Of each bearing, in the axes of its shaft (bearing, 5, 5).
        misalignment: Angle between the flanks of each mesh in the plane of action
            (mesh,) [rad]: by how much they part towards larger z of the wheel. Of a
            wheel with a mate outside the system that of the wheel alone.
        power: Speeds, torques, forces of the wheels.
        residual: Force that is left over that which acts [1].
        steps: Steps of the search.
        result: `Result` code.
        free: Motion (shaft or seat, ux uy uz gx gy …) that nothing holds, zeros if all
            is held (motion,) [1].
    """

    shafts: tuple[ShaftState, ...]
    load: Float[Array, "bearing 6"]
    displacement: Float[Array, "bearing 6"]
    housing: Float[Array, "seat freedom"]
    motion: Float[Array, "bearing 5"]
    stiffness: Float[Array, "bearing 5 5"]
    misalignment: Float[Array, " mesh"]
    power: PowerFlow
    residual: Scalar
    steps: Int[Array, ""]
    result: Int[Array, ""]
    free: Float[Array, " motion"]

    @property
    def converged(self) -> Any:
        """Whether the result code is `CONVERGED`."""
        return self.result == Result.CONVERGED


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
    if not isinstance(system, ShaftSystem):
        raise TypeError(
            f"solve_system: `system` is a {type(system).__name__}; it must be a"
            " ShaftSystem."
        )
    found, place = searched_system(system)
    if throw:
        found = raise_unless_converged(
            found, found.result, lambda: unsolved(system, found, place)
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
    found, place = system_state(adjusted(system))
    check_torques(system, found.power.output_shaft, *torques_left(found.power))
    return found, place


def torques_left(power: PowerFlow) -> tuple[Any, Any]:
    """Return the torque on a shaft end that nothing names, and the largest of all.

    Args:
        power: Torques of a system.

    Returns:
        Two torques [N m]; the first `None` if there is no such end.
    """
    every = [jnp.abs(mesh.torque) for mesh in power.meshes]
    every += [jnp.abs(one) for one in power.coupling]
    none = jnp.zeros((), jnp.result_type(float))
    return power.output, jnp.max(jnp.stack(every or [none]))


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
    beside = [part.name for part in given if part.shaft == shaft]
    if left is None or not beside or is_traced(left):
        return
    if abs(float(left)) > 1e-6 * float(most):
        raise ValueError(
            f"ShaftSystem: the torques do not balance: {float(left):.6g} N m are left"
            f" on shaft {shaft} beside {', '.join(beside)}; leave out one of the"
            " torques, which then follows from the others."
        )


def adjusted(
    system: ShaftSystem, known: dict[Any, Scalar] | None = None
) -> ShaftSystem:
    """Return a system whose bearings have their preload as an axial offset.

    Args:
        system: The system.
        known: Offsets of bearings met before, which is added to.

    Raises:
        SolveError: If a bearing cannot bear its preload.
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
                known[key] = preload_offset(cold, seat.preload)
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
    return installed.at(throw=False)


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
    element = seat.installed.at(Speed(inner=sign * speed), throw=False)
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


@program(quick=True)
def system_state(
    system: ShaftSystem,
) -> tuple[SystemSolution, Float[Array, " motion"]]:
    """Return the solution, and the end of the search even if it failed (motion,).

    Args:
        system: From `adjusted`.
    """
    power = power_flow(system)
    rotors, points = [], []
    supports = supports_of(system, power)
    for index in range(len(system.shafts)):
        here = [supports[k] for k in _seats(system, index)]
        line, beam = system.shafts[index], system.beam(index)
        rotors.append(Rotor(beam, (), here, rigid=line.rigid))
        points.append(_points(system, power, index, beam))
    whole = _coupled(system, rotors, points, power)
    found = _named(system, searched(stop(whole), stop(max_length(system))), whole)
    solved = found.result == Result.CONVERGED

    def there(*given: Any) -> SystemSolution:
        return _described(found, *given)

    given = system, rotors, points, whole, power
    return unless_failed(there, given, solved), stop(whole).motion(found.x)


def _named(system, found, whole):
    """Return the end of a search; of a shaft that slid off its bearings in a direction
    in which none holds it, `NO_LOAD_PATH` in place of `STEP_LIMIT`: the search may end
    before it is far."""
    motion, first = stop(whole).motion(found.x), 0
    away = jnp.asarray(False)
    for index, line in enumerate(system.shafts):
        count = N_STATION * (sum(system.plans[index].divisions) + 1)
        along, first = motion[first + 2 : first + count : N_STATION], first + count
        for sense in {1, -1} - _held(system, index):
            slid = jnp.min(sense * along) > _SLID * jnp.sum(stop(line.length))
            away = away | slid
    away = away & (found.result == Result.STEP_LIMIT)
    code = jnp.asarray(int(Result.NO_LOAD_PATH), found.result.dtype)
    return found._replace(result=jnp.where(away, code, found.result))


def _held(system, index) -> set[int]:
    """Return the senses along a shaft in which a bearing holds it."""
    held: set[int] = set()
    for k in _seats(system, index):
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


def _coupled(system, rotors, points, power) -> Condensed:
    """Return all shafts on their bearings, with seats and floating rings, as one."""
    parts, order, turns = [], [], []
    for index, rotor in enumerate(rotors):
        weight = accelerated(rotor, system.shafts[index].frame @ system.gravity)
        force = weight + points[index].reshape(-1)
        parts.append(condensed(rotor, force, power.speed[index]))
        here = _seats(system, index)
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
    return Condensed(
        stiffness=jsp.linalg.block_diag(*stiffness),
        force=jnp.concatenate([*(part.force for part in parts), still]),
        rows=jnp.concatenate([rows, more], axis=2)[back_at],
        back=jsp.linalg.block_diag(*back),
        there=jnp.concatenate([*(part.there for part in parts), still]),
        supports=tuple(supports[k] for k in back_at),
        speed=jnp.stack([turns[k] for k in back_at]),
    )


def _seats(system, index) -> list[int]:
    """Return the numbers of the bearings on a shaft."""
    return [k for k, s in enumerate(system.seats) if system.station(s)[0] == index]


def _described(found, system, rotors, points, whole, power) -> SystemSolution:
    y, force, stiffness, _ = at_equilibrium(found, whole)
    motion, relative = whole.motion(y), whole.rows @ y
    shafts, tilts, first = [], [], 0
    for index, rotor in enumerate(rotors):
        beam, count = rotor.shaft, N_STATION * rotor.shaft.n_nodes
        moved = motion[first : first + count].reshape(-1, N_STATION)
        first += count
        acting = points[index]
        for k in _seats(system, index):
            node = beam.node(system.station(system.seats[k])[1])
            acting = acting.at[node].add(-force[k])
        line = system.shafts[index]
        weight = jnp.outer(beam.element_masses(), line.frame @ system.gravity)
        speed = power.speed[index]
        shafts.append(ShaftState(*_lines(beam.nodes, acting, weight, moved), speed))
        turned = jnp.concatenate([moved[:, 3:], jnp.zeros_like(moved[:, :1])], axis=1)
        tilts.append(turned @ line.frame)
    housing = system.housing
    size = (0, 3) if housing is None else (len(housing.seats), housing.freedoms)
    seats = motion[first : first + size[0] * size[1]].reshape(size)
    in_bearing = []
    for k, (seat, support) in enumerate(zip(system.seats, whole.supports, strict=True)):
        sense = jnp.asarray(_TURNED if seat.turned else np.ones(N_STATION))
        offset = getattr(support, "offset", 0.0)
        in_bearing.append(offset + sense * relative[k])
    return SystemSolution(
        shafts=tuple(shafts),
        load=_global(system, force),
        displacement=_global(system, relative),
        housing=seats,
        motion=jnp.stack(in_bearing),
        stiffness=stiffness,
        misalignment=_misalignments(system, power, rotors, tilts),
        power=power,
        residual=found.residual,
        steps=found.steps,
        result=found.result,
        free=softest(stop(whole), stop(whole.slope(stiffness))),
    )


def _global(system, local):
    """Return forces or motions of the bearings (bearing, 5) in global axes (…, 6)."""
    found = []
    for seat, own in zip(system.seats, local, strict=True):
        frame = system.shaft(seat.shaft).frame
        turning = jnp.append(own[3:], 0.0)
        found.append(jnp.concatenate([own[:3] @ frame, turning @ frame]))
    return jnp.stack(found)


def _lines(z, acting, weight, moved):
    """Return position, displacement, shear and moment at both ends of all elements.

    Args:
        z: Of the nodes (node,) [m].
        acting: Forces and moments on them (node, 5) [N, N m].
        weight: Of each element (element, 3) [N].
        moved: Displacements of the nodes (node, 5) [m, rad].
    """
    middle = 0.5 * (z[1:] + z[:-1])
    force = jnp.cumsum(acting[:-1, :3], axis=0)
    lever = jnp.cumsum(acting[:-1, :3] * z[:-1, None], axis=0)
    moment = jnp.cumsum(acting[:-1, 3:], axis=0)
    behind, behind_lever = (
        jnp.cumsum(part, axis=0) for part in (weight, weight * middle[:, None])
    )

    def section(at, own):
        whole = force + behind - (1.0 - own) * weight
        arm = lever + behind_lever - (1.0 - own) * weight * middle[:, None]
        arm = arm - at[:, None] * whole
        bent = jnp.stack([moment[:, 0] - arm[:, 1], moment[:, 1] + arm[:, 0]], axis=1)
        return -whole, -bent

    ends = section(z[:-1], 0.0), section(z[1:], 1.0)
    shear, bent = (
        jnp.stack(pair, axis=1).reshape(-1, pair[0].shape[1])
        for pair in zip(*ends, strict=True)
    )
    both = np.repeat(np.arange(z.shape[0]), 2)[1:-1]
    return z[both], moved[both], shear, bent


def _misalignments(system, power, rotors, tilts):
    """Return the angle between the flanks of every mesh [rad]."""

    def tilt(name):
        index, station = system.station(system.wheel(name))
        return tilts[index][rotors[index].shaft.node(station)]

    found = [jnp.zeros((), jnp.result_type(float))][:0]
    for mesh in power.meshes:
        turned = tilt(mesh.wheel)
        if mesh.mate is not None:
            turned = turned - tilt(mesh.mate)
        push = mesh.force - (mesh.force @ mesh.line) * mesh.line
        size = jnp.sqrt(jnp.where(jnp.any(push != 0), push @ push, 1.0))
        found.append(jnp.cross(turned, mesh.line) @ push / size)
    return jnp.stack(found) if found else jnp.zeros(0)


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
        speeds: Of all shafts [rad/s].
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
        motion: Of its inner ring, in its axes [m, rad].
        speed: Ring speeds, for its fits.
        inertia: Whether rolling elements feel them; `None` at rest. Static.
        points: Positions along the rollers at which loads are reported. Static.
    """
    rings = jnp.zeros(2 * _RING, motion.dtype).at[_RING : _RING + N_STATION].set(motion)
    element = installed.at(speed, throw=False)
    known = None if inertia is None else speed
    return solution_at(element, rings, known, points, bool(inertia))


def unsolved(system: ShaftSystem, found: SystemSolution, place: Any) -> str:
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
            f"{start} nothing takes up the load along {moving(system, place)}; locate"
            " the shaft there, turn a bearing round, or give less load."
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


def moving(system: ShaftSystem, motion: Any) -> str:
    """Name the largest of the motions of a system, in words.

    Args:
        system: The system.
        motion: Of all nodes, seats and floating rings (motion,) [m, rad].
    """
    motion, first = np.asarray(motion), 0
    best, words = 0.0, "no motion"
    for index, line in enumerate(system.shafts):
        count = N_STATION * (sum(system.plans[index].divisions) + 1)
        length = float(jnp.sum(line.length))
        moved = np.abs(motion[first : first + count].reshape(-1, N_STATION))
        sizes = moved.max(axis=0) * ([1.0] * 3 + [length] * 2)
        first += count
        if sizes.max() > best:
            best = sizes.max()
            words = f"{STATION_FREEDOMS[int(np.argmax(sizes))]} of shaft {line.name}"
    rest = np.abs(motion[first:])
    if rest.size and rest.max() > best:
        words = "a seat of the housing, or a floating outer ring"
    return words

"""State of a system of shafts in equilibrium: lines, loads, misalignments."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..element.frame import LOAD_UNITS, MOTION_UNITS
from ..numerics.implicit import stop_gradient
from ..numerics.labels import to_xarray
from ..numerics.minimise import Minimum
from ..numerics.result import Result
from ..numerics.shown import Printable
from ..numerics.types import Scalar, in_numpy
from ..numerics.units import unit
from ..rotor import STATION_FREEDOMS
from ..rotor.bearing_support import TURNED
from ..rotor.condensation import CondensedRotor
from ..rotor.parts import STIFFNESS_UNITS
from ..rotor.rotor import N_STATION
from ..rotor.shaft import STATION_UNITS
from ..rotor.statics import softest
from .power import PowerFlow
from .system import ShaftSystem


class ShaftState(Printable):
    """A shaft in equilibrium, in its local axes.

    Forces and moments are those by which the part of the shaft at larger z acts on the
    part before it; `side` counts both ends of every beam element, so that an inner node
    occurs twice, just before and just after what acts there.

    Attributes:
        position: Along the shaft (side,) [m].
        displacement: (ux uy uz gx gy) (side, 5) [m, rad].
        shear: Force (Fx, Fy, Fz) in the section (side, 3) [N].
        moment: Bending moment (Mx, My) (side, 2) [N m].
        speed: Speed of the shaft [rad/s].
    """

    position: Float[Array, " side"] = eqx.field(metadata=unit("m"))
    displacement: Float[Array, "side station_freedom=5"] = eqx.field(
        metadata=unit(STATION_UNITS)
    )
    shear: Float[Array, "side direction=3"] = eqx.field(metadata=unit("N"))
    moment: Float[Array, "side moment_component=2"] = eqx.field(metadata=unit("N m"))
    speed: Scalar = eqx.field(metadata=unit("rad/s"))

    to_xarray = to_xarray


class SystemSolution(Printable):
    """A system of shafts in equilibrium. Numbers are NaN unless it converged.

    Attributes:
        shafts: State of each shaft.
        load: Force and moment of the shaft on the inner ring of each bearing, in global
            axes (bearing, 6) [N, N m]. The moment about the shaft is zero.
        displacement: Displacement of each inner ring against its outer ring, in global
            axes, without what preload and heat displace (bearing, 6) [m, rad].
        housing: Motion of each seat of the housing in global axes (seat, 3 or 6)
            [m, rad].
        motion: Inner ring in each bearing, in the axes of the bearing (bearing, 5)
            [m, rad].
        stiffness: Stiffness of each bearing, in the axes of its shaft (bearing, 5, 5)
            [N/m, N, N m].
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
    load: Float[Array, "bearing component=6"] = eqx.field(metadata=unit(LOAD_UNITS))
    displacement: Float[Array, "bearing freedom=6"] = eqx.field(
        metadata=unit(MOTION_UNITS)
    )
    housing: Float[Array, "seat seat_freedom"] = eqx.field(metadata=unit(MOTION_UNITS))
    motion: Float[Array, "bearing station_freedom=5"] = eqx.field(
        metadata=unit(STATION_UNITS)
    )
    stiffness: Float[Array, "bearing station_freedom=5 moved_station_freedom=5"] = (
        eqx.field(metadata=unit(STIFFNESS_UNITS))
    )
    misalignment: Float[Array, " mesh"] = eqx.field(metadata=unit("rad"))
    power: PowerFlow
    residual: Scalar = eqx.field(metadata=unit("1"))
    steps: Int[Array, ""]
    result: Int[Array, ""]
    free: Float[Array, " motion"] = eqx.field(metadata=unit("1"))

    to_xarray = to_xarray

    @property
    def converged(self) -> Any:
        """Whether the result code is `CONVERGED`."""
        return in_numpy(self.result) == Result.CONVERGED


def describe_state(
    found: Minimum,
    at: tuple[Array, Array, Array],
    offsets: Float[Array, "bearing 5"],
    system: ShaftSystem,
    rotors: Any,
    points: Any,
    whole: CondensedRotor,
    power: PowerFlow,
) -> SystemSolution:
    """Return the state at the end of a search, with derivatives; NaN if it failed.

    Args:
        found: End of the search.
        at: Condensed motions, and force and stiffness of the bearings there, NaN if it
            failed.
        offsets: Displacement of each bearing with its station at zero [m, rad].
        system: The system.
        rotors: Its shafts on their bearings.
        points: Forces of wheels and loads on the nodes of each [N, N m].
        whole: All of it, condensed on the bearings; its supports are not looked at.
        power: Speeds, torques, forces of the wheels.
    """
    y, force, stiffness = at
    motion, relative = whole.motion(y), whole.rows @ y
    shafts, tilts, first = [], [], 0
    for index, rotor in enumerate(rotors):
        beam, count = rotor.shaft, N_STATION * rotor.shaft.n_nodes
        moved = motion[first : first + count].reshape(-1, N_STATION)
        first += count
        acting = points[index]
        for k in system.seats_on(index):
            node = beam.node(system.station(system.seats[k])[1])
            acting = acting.at[node].add(-force[k])
        line = system.shafts[index]
        weight = line.frame @ system.gravity
        weight = beam.element_masses()[:, None] * weight[None]
        speed = power.speed[index]
        shafts.append(ShaftState(*_lines(beam.nodes, acting, weight, moved), speed))
        turned = jnp.concatenate([moved[:, 3:], jnp.zeros_like(moved[:, :1])], axis=1)
        tilts.append(turned @ line.frame)
    housing = system.housing
    size = (0, 3) if housing is None else (len(housing.seats), housing.freedoms)
    seats = motion[first : first + size[0] * size[1]].reshape(size)
    in_bearing = []
    for k, seat in enumerate(system.seats):
        sense = jnp.asarray(TURNED if seat.turned else np.ones(N_STATION))
        in_bearing.append(offsets[k] + sense * relative[k])
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
        free=softest(stop_gradient(whole), stop_gradient(whole.slope(stiffness))),
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
        z: Axial positions of the nodes (node,) [m].
        acting: Forces and moments on them (node, 5) [N, N m].
        weight: Weight of each element (element, 3) [N].
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


def moving_part(system: ShaftSystem, motion: Any) -> str:
    """Name the largest of the motions of a system, in words.

    Args:
        system: The system.
        motion: Motion of all nodes, seats and floating rings (motion,) [m, rad].
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

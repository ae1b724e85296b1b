"""Speeds and torques of a system of shafts: ratios of wheels, balance of torques."""

from typing import Annotated, Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..numerics.lapack import solve_any
from ..numerics.shown import Printable
from ..numerics.types import Scalar, as_real
from ..numerics.units import unit
from .line import ShaftLine
from .mesh_place import mesh_place
from .parts import Gear, Pulley, torque_of
from .system import ShaftSystem


class Contact(NamedTuple):
    """Where a wheel is touched.

    Attributes:
        wheel: The wheel.
        mate: Its mate in the system; `None`: outside of it.
        radial: Direction from the shaft to the mesh, of a pulley of the pull (3,) [1].
        radius: Working pitch radius [m].
        point: Where the force acts, from the shaft at the wheel (3,) [m].
    """

    wheel: Gear | Pulley
    mate: Gear | Pulley | None
    radial: Annotated[Float[Array, "3"], unit("1")]
    radius: Annotated[Scalar, unit("m")]
    point: Annotated[Float[Array, "3"], unit("m")]


class Mesh(eqx.Module):
    """A mesh, or an end of a belt, with its force on the wheel.

    Attributes:
        wheel: Name of the wheel.
        mate: Name of its mate; `None`: outside of the system.
        torque: On the shaft of the wheel about its local z [N m].
        force: On the wheel in global axes (3,) [N].
        place: Point of the force, from the shaft at the wheel (3,) [m].
        line: Line of the tooth in global axes (3,) [1]; zero of a belt.
    """

    wheel: str = eqx.field(static=True)
    mate: str | None = eqx.field(static=True)
    torque: Scalar = eqx.field(metadata=unit("N m"))
    force: Float[Array, "direction=3"] = eqx.field(metadata=unit("N"))
    place: Float[Array, "direction=3"] = eqx.field(
        converter=as_real, metadata=unit("m")
    )
    line: Float[Array, "direction=3"] = eqx.field(converter=as_real, metadata=unit("1"))


class PowerFlow(Printable):
    """Speeds and torques.

    Attributes:
        speed: Speed of each shaft (shaft,) [rad/s].
        meshes: Each wheel with each of its mates.
        coupling: Torque of each coupling on its shaft (coupling,) [N m].
        drive: Torque of the drive on its shaft [N m].
        output: Torque that leaves by a shaft end that nothing names [N m]; `None` if
            there is none.
        output_shaft: Name of that shaft.
        loss: Power lost in meshes and belts [W].
    """

    speed: Float[Array, " shaft"] = eqx.field(metadata=unit("rad/s"))
    meshes: tuple[Mesh, ...]
    coupling: Float[Array, " coupling"] = eqx.field(metadata=unit("N m"))
    drive: Scalar = eqx.field(metadata=unit("N m"))
    output: Any
    output_shaft: str | None = eqx.field(static=True)
    loss: Scalar = eqx.field(metadata=unit("W"))


def contacts(system: ShaftSystem) -> list[tuple[Contact, Contact | None]]:
    """Return where wheels touch: pairs of mates, and wheels with a mate outside.

    Args:
        system: The system.
    """
    found: list[tuple[Contact, Contact | None]] = []
    pairs = system.pairs()
    taken = {wheel.name for pair in pairs for wheel in pair}
    for wheel in system.wheels:
        if wheel.name not in taken:
            found.append((_single_contact(wheel, system.shaft(wheel.shaft)), None))
        for one, other in pairs:
            if one.name == wheel.name:
                shafts = system.shaft(one.shaft), system.shaft(other.shaft)
                found.append(_pair_contacts(one, other, *shafts))
    return found


def _single_contact(wheel: Any, shaft: ShaftLine) -> Contact:
    name = "mesh_angle" if isinstance(wheel, Gear) else "direction"
    angle = getattr(wheel, name)
    if angle is None:
        raise ValueError(
            f"ShaftSystem: `{name}` of {wheel.name} is missing; it has no mate in the"
            " system from which it follows."
        )
    radial = shaft.radial_direction(angle)
    return Contact(wheel, None, radial, wheel.radius, wheel.radius * radial)


def _pair_contacts(
    one: Any, other: Any, shaft: Any, far: Any
) -> tuple[Contact, Contact]:
    """Return both contacts of a pair."""
    found = mesh_place(one, other, shaft, far)
    if found is not None:
        radial, radii, points = [*found.ways], found.radii, found.points
    else:
        name = "mesh_angle" if isinstance(one, Gear) else "direction"
        angles = [getattr(wheel, name) for wheel in (one, other)]
        if angles == [None, None]:
            raise ValueError(
                f"ShaftSystem: `{name}` of {one.name} and {other.name} are missing, and"
                " so is the origin of a shaft; give one or the other."
            )
        here = angles[0] is not None
        first = (
            shaft.radial_direction(angles[0])
            if here
            else -far.radial_direction(angles[1])
        )
        radial, radii = [first, -first], (one.radius, other.radius)
        points = [r * way for r, way in zip(radii, radial, strict=True)]
    given = [getattr(wheel, "direction", None) for wheel in (one, other)]
    radial = [
        s.radial_direction(angle) if angle is not None else way
        for s, angle, way in zip((shaft, far), given, radial, strict=True)
    ]
    return (
        Contact(one, other, radial[0], radii[0], points[0]),
        Contact(other, one, radial[1], radii[1], points[1]),
    )


def power_flow(system: ShaftSystem) -> PowerFlow:
    """Return speeds and torques of a system, and the forces of its wheels.

    Args:
        system: The system.

    Raises:
        ValueError: If the torques cannot balance: several outputs are unknown, or none
            is where the given torques do not add up; or a shaft is not driven.
    """
    pairs = contacts(system)
    names = [shaft.name for shaft in system.shafts]
    drive = system.drive
    root = _root(system, names)
    ratio, away, order = _ratios(system, pairs, names, root)
    zero = as_real(0.0)
    speed = [r * (zero if drive is None else drive.speed) for r in ratio]
    # Unknown torques: of each pair that on its first wheel, and one that closes.
    pair_of: list[tuple[int, int, int, Scalar]] = []
    known = [zero for _ in names]
    torques: list[Any] = []
    free: list[tuple[str, int]] = []

    def add_torque(part, own):
        shaft = names.index(part.shaft)
        if own is None:
            free.append((part.name, shaft))
        else:
            known[shaft] = known[shaft] + own

    for k, (one, other) in enumerate(pairs):
        shaft = names.index(one.wheel.shaft)
        if other is not None:
            mate = names.index(other.wheel.shaft)
            pair_of.append(
                (k, shaft, mate, one.wheel.efficiency * other.wheel.efficiency)
            )
            torques.append(None)
        elif drive is not None and drive.into == one.wheel.name:
            torques.append(torque_of(drive, speed[shaft]))
            add_torque(one.wheel, torques[-1])
        else:
            torques.append(torque_of(one.wheel, speed[shaft]))
            add_torque(one.wheel, torques[-1])
    for coupling in system.couplings:
        add_torque(coupling, torque_of(coupling, speed[names.index(coupling.shaft)]))
    own = None
    if drive is not None:
        own = torque_of(drive, speed[root])
        if drive.into in names:
            if own is None:
                free.append(("drive", root))
            else:
                known[root] = known[root] + own
    for load in system.loads:
        shaft = names.index(load.shaft)
        known[shaft] = known[shaft] + load.moment @ system.shafts[shaft].frame[2]
    output = _balancing_part(system, names, free, away, order)

    def balance(shares: list[Scalar]) -> Array:
        matrix = jnp.zeros((len(names), len(pair_of) + 1)).at[output[1], -1].set(1.0)
        for k, (_, shaft, mate, _) in enumerate(pair_of):
            back = ratio[shaft] / ratio[mate] * shares[k]
            matrix = matrix.at[shaft, k].add(1.0).at[mate, k].add(-back)
        return solve_any(matrix, -jnp.stack(known))

    # Power is lost in the direction in which it flows, known without the losses.
    lossless = balance([as_real(1.0) for _ in pair_of])
    sense = jnp.where(speed[root] < 0, -1.0, 1.0)
    # Whether a pair feeds its first shaft.
    feeds = [
        torque * ratio[shaft] * sense > 0
        for torque, (_, shaft, _, _) in zip(lossless, pair_of, strict=False)
    ]
    shares = [
        jnp.where(fed, 1.0 / eta, eta)
        for fed, (*_, eta) in zip(feeds, pair_of, strict=True)
    ]
    found = balance(shares)
    closing = found[-1]
    for (k, *_), value in zip(pair_of, found[:-1], strict=True):
        torques[k] = value
    flow_of = {k: flow for (k, *_), *flow in zip(pair_of, feeds, shares, strict=True)}
    torques = [closing if t is None else t for t in torques]
    meshes: list[Mesh] = []
    loss = zero
    for k, ((one, other), torque) in enumerate(zip(pairs, torques, strict=True)):
        push = torque / one.radius
        if other is not None:
            a, b = names.index(one.wheel.shaft), names.index(other.wheel.shaft)
            fed, share = flow_of[k]
            back = -torque * ratio[a] / ratio[b] * share
            loss = loss - torque * speed[a] - back * speed[b]
            # Both feel one force, that of the wheel which gives the power.
            size = jnp.abs(jnp.where(fed, back / other.radius, push))
            for contact, value in ((one, torque), (other, back)):
                push = jnp.where(value < 0, -size, size)
                meshes.append(_mesh(system, contact, value, push))
        else:
            meshes.append(_mesh(system, one, torque, push))
    every = [torque_of(c, speed[names.index(c.shaft)]) for c in system.couplings]
    every = [closing if t is None else t for t in every]
    named = output[0] is not None
    return PowerFlow(
        speed=jnp.stack(speed),
        meshes=tuple(meshes),
        coupling=jnp.stack(every) if every else jnp.zeros(0, closing.dtype),
        drive=zero if drive is None else closing if own is None else own,
        output=None if named else closing,
        output_shaft=None if named else names[output[1]],
        loss=loss,
    )


def _root(system: ShaftSystem, names: list[str]) -> int:
    """Return the number of the driven shaft; the first without a drive."""
    drive = system.drive
    if drive is None:
        return 0
    if drive.into in names:
        return names.index(drive.into)
    wheel = system.wheel(drive.into)
    mated = wheel.mates_with or any(w.mates_with == wheel.name for w in system.wheels)
    if mated or wheel.torque is not None or wheel.power is not None:
        raise ValueError(
            f"ShaftSystem: `drive.into` is {wheel.name}, which has a mate or a torque"
            " already; name its shaft, or a wheel that is driven from outside."
        )
    return names.index(wheel.shaft)


def _ratios(system, pairs, names, root):
    """Return speed of each shaft over that of the root, its distance from the root in
    meshes, and the numbers of the shafts in the order of the flow."""
    ratio: dict[int, Any] = {root: as_real(1.0)}
    away, order = {root: 0}, [root]
    links = [
        (names.index(one.wheel.shaft), names.index(other.wheel.shaft), one, other)
        for one, other in pairs
        if other is not None
    ]
    used: set[int] = set()
    for here in order:
        for k, (a, b, one, other) in enumerate(links):
            if k in used or here not in (a, b):
                continue
            used.add(k)
            there, near, far = (b, one, other) if here == a else (a, other, one)
            if there in ratio:
                raise ValueError(
                    f"ShaftSystem: {one.wheel.name} and {other.wheel.name} close a loop"
                    " of meshes; how the torque divides between two ways depends on"
                    " their stiffness and is not modelled."
                )
            ratio[there] = ratio[here] * _ratio(system, near, far)
            away[there] = away[here] + 1
            order.append(there)
    for k, name in enumerate(names):
        if k not in ratio:
            raise ValueError(
                f"ShaftSystem: no mesh or belt connects shaft {name} with shaft"
                f" {names[root]}."
            )
    return [ratio[k] for k in range(len(names))], away, order


def _ratio(system, near: Contact, far: Contact):
    """Return the speed of the shaft of `far` over that of `near`."""
    axes = [system.shaft(c.wheel.shaft).frame[2] for c in (near, far)]
    if isinstance(near.wheel, Pulley):
        return near.wheel.radius / far.wheel.radius * jnp.sign(axes[0] @ axes[1])
    moves = [jnp.cross(z, c.radial) for z, c in zip(axes, (near, far), strict=True)]
    assert isinstance(near.wheel, Gear) and isinstance(far.wheel, Gear)
    return near.wheel.teeth / far.wheel.teeth * jnp.sign(moves[0] @ moves[1])


def _balancing_part(system, names, free, away, order) -> tuple[str | None, int]:
    """Return name and shaft of the part whose torque follows from the balance."""
    if len(free) > 1:
        raise ValueError(
            "ShaftSystem: the torques of"
            f" {', '.join(name for name, _ in free)} are not given; one of them"
            " can follow from the balance."
        )
    if free:
        return free[0]
    ends = [k for k in order if k != order[0]]
    last = [k for k in ends if not _feeds(system, names, k, away)]
    if not ends:
        return None, order[0]
    known = {
        names.index(part.shaft)
        for part in (*system.wheels, *system.couplings)
        if part.torque is not None or part.power is not None
    }
    last = [k for k in last if k not in known] or last[:1]
    if len(last) > 1:
        outputs = ", ".join(names[k] for k in last)
        raise ValueError(
            f"ShaftSystem: power may leave by the shafts {outputs}; give the torque or"
            " power of all but one, by a coupling or wheel there."
        )
    return None, last[0]


def _feeds(system, names, shaft, away) -> bool:
    """Whether a shaft drives another, farther from the drive."""
    for pair in system.pairs():
        a, b = (names.index(one.shaft) for one in pair)
        if shaft in (a, b) and away[a if shaft == b else b] > away[shaft]:
            return True
    return False


def _mesh(system: ShaftSystem, contact: Contact, torque, push) -> Mesh:
    """Return a mesh with the torque on its wheel and the tangential force there."""
    wheel = contact.wheel
    axis = system.shaft(wheel.shaft).frame[2]
    mate = None if contact.mate is None else contact.mate.name
    if isinstance(wheel, Pulley):
        pull = wheel.force_ratio * jnp.abs(push) * contact.radial
        nothing = jnp.zeros_like(pull)
        return Mesh(wheel.name, mate, torque, pull, nothing, nothing)
    sign = jnp.where(push < 0, -1.0, 1.0)
    way, line = wheel.push(axis, contact.radial, contact.radius, sign)
    return Mesh(wheel.name, mate, torque, push * way, contact.point, line)

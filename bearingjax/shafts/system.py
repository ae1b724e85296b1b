"""A system of shafts: wheels that couple them, bearings that hold them, a housing."""

import copy
from collections.abc import Iterable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.bearing_set import pitch_radius
from ..design.checks import check, floats, instance, is_traced
from ..numerics.types import as_real, in_numpy
from ..numerics.units import unit
from ..rotor import Shaft
from ..rotor.rotor import as_parts
from .line import Plan, ShaftLine
from .mesh_place import mesh_place, outward_direction
from .parts import (
    AbstractPlaced,
    Coupling,
    Drive,
    Gear,
    Pulley,
    Seat,
    ShaftLoad,
)

_APART = 0.06
"""Largest distance between centre distance and that of the pitch circles, over it [1]:
profile shifts do not take gears farther."""
_FAST = 10.0 * 2.0 * np.pi / 60.0
"""Speed times pitch diameter from which inertia counts, 10 000 mm/min [m rad/s]."""
_ANGLE = np.deg2rad(0.5)
"""Largest difference of a given angle of a mesh from that of the places [rad]."""
_ACROSS = 1e-6
"""Sine of the angle between two axes from which they are not parallel [1]."""


def _order(plan: Plan) -> str:
    """Stations of a shaft in words."""
    return ", ".join(s if isinstance(s, str) else f"end {s}" for s in plan.stations)


def feel_speed(known: Iterable[bool | None]) -> bool | None:
    """Return `ShaftSystem.inertia` of systems that share it: what one of them needs.

    Args:
        known: `inertia` of each system.
    """
    known = [one for one in known if one is not None]
    return any(known) if known else None


class HousingStiffness(eqx.Module):
    """Stiffness of the housing between the seats of its bearings.

    Attributes:
        seats: Names of the bearings, in the order of the matrix.
        matrix: Force and moment over displacement and rotation of all seats in global
            axes, seat by seat (ux uy uz), or (ux uy uz gx gy gz), as a finite element
            program reduces it (n, n), of rotations in N and N m [N/m].
    """

    seats: tuple[str, ...] = eqx.field(static=True, converter=tuple)
    matrix: Float[Array, "n n"] = eqx.field(converter=as_real, metadata=unit("N/m"))

    def __check_init__(self):
        n, shape = len(self.seats), jnp.shape(self.matrix)
        twice = [name for name in self.seats if self.seats.count(name) > 1]
        if twice:
            raise ValueError(
                f"HousingStiffness: `seats` has {twice[0]} twice; the matrix has one"
                " place for each."
            )
        if not n or shape not in ((3 * n, 3 * n), (6 * n, 6 * n)):
            raise ValueError(
                f"HousingStiffness: `matrix` has shape {shape}; for the {n} seats"
                f" {', '.join(self.seats)} it must be ({3 * n}, {3 * n}), or"
                f" ({6 * n}, {6 * n}) with rotations."
            )
        if is_traced(self.matrix):
            return
        known = np.asarray(self.matrix)
        check(self, "matrix", np.isfinite(known).all(), "finite")
        size = np.sqrt(np.abs(np.diagonal(known)))
        unequal = np.abs(known - known.T) > 1e-6 * np.outer(size, size) + 1e-300
        if unequal.any():
            row, column = map(int, np.argwhere(unequal)[0])
            raise ValueError(
                f"HousingStiffness: `matrix` is not symmetric: {known[row, column]:.6g}"
                f" in row {row}, column {column}, {known[column, row]:.6g} in its"
                " place across the diagonal."
            )
        least = np.linalg.eigvalsh(known / np.outer(size, size).clip(1e-300)).min()
        check(self, "matrix", least > -1e-6, "positive semi-definite")

    @property
    def freedoms(self) -> int:
        """Freedoms of a seat, 3 or 6."""
        return self.matrix.shape[0] // len(self.seats)

    @classmethod
    def of_seats(cls, seats: dict[str, Any]) -> "HousingStiffness":
        """Create a housing whose seats do not act on each other.

        Args:
            seats: Stiffness of each seat by name, in global axes: a matrix or a
                diagonal of three, or of six with rotations.

        Raises:
            ValueError: If some have three and some six freedoms.
        """
        blocks = [as_real(value) for value in seats.values()]
        blocks = [jnp.diag(b) if jnp.ndim(b) == 1 else b for b in blocks]
        sizes = {block.shape for block in blocks}
        if len(sizes) > 1:
            raise ValueError(
                "HousingStiffness: some seats have three freedoms and some six; give"
                " all of them the same."
            )
        n, size = len(blocks), blocks[0].shape[0]
        whole = jnp.zeros((n, size, n, size), blocks[0].dtype)
        for k, block in enumerate(blocks):
            whole = whole.at[k, :, k].set(block)
        return cls(tuple(seats), whole.reshape(n * size, n * size))


class ShaftSystem(eqx.Module):
    """Shafts on bearings in a housing, loaded by gears, belts, forces and weight.

    Attributes:
        shafts: One or several.
        seats: The bearings in their places.
        drive: Drive of the system; `None`: no power.
        wheels: Gears and pulleys.
        couplings: Further places where torque enters or leaves.
        loads: Free forces and moments.
        housing: Stiffness of the housing; `None`: rigid.
        gravity: Acceleration of free fall in global axes (3,) [m/s²].
        plans: Order of the stations on each shaft, from `ShaftLine.plan`.
        inertia: Whether rolling elements feel the speed: from a speed times pitch
            diameter of 10 000 mm/min on. Below, their centrifugal loads are under a
            millionth of the static rating. `None`: at rest.

    Traced: all numbers. Static: names, plans, inertia. A changed copy is made by
    `equinox.tree_at`, or with `jax.vmap` over changed leaves.

    Raises:
        TypeError: For a part of another kind.
        ValueError: For names that are not unique or not there, wheels that cannot mesh,
            a shaft without bearing, or torques that cannot balance.
    """

    shafts: tuple[ShaftLine, ...]
    seats: tuple[Seat, ...]
    drive: Drive | None
    wheels: tuple[Gear | Pulley, ...]
    couplings: tuple[Coupling, ...]
    loads: tuple[ShaftLoad, ...]
    housing: HousingStiffness | None
    gravity: Float[Array, "3"] = eqx.field(metadata=unit(3 * ("m/s²",)))
    plans: tuple[Plan, ...] = eqx.field(static=True)
    inertia: bool | None = eqx.field(static=True)

    def __init__(
        self,
        shafts: Any,
        seats: Any,
        drive: Drive | None = None,
        wheels: Any = (),
        couplings: Any = (),
        loads: Any = (),
        housing: HousingStiffness | None = None,
        gravity: Any = (0.0, 0.0, 0.0),
    ):
        self.shafts, self.seats = as_parts(shafts), as_parts(seats)
        self.drive, self.housing = drive, housing
        self.wheels, self.couplings = as_parts(wheels), as_parts(couplings)
        self.loads, self.gravity = as_parts(loads), as_real(gravity)
        self._check_kinds()
        self._check_names()
        self.plans = tuple(
            shaft.plan({p.name: p.position for p in self.parts_on(shaft.name)})
            for shaft in self.shafts
        )
        for pair in in_numpy(self.pairs()):
            self._check_mesh(*pair)
        for wheel in self.wheels:
            if isinstance(wheel, Gear) and wheel.mesh_angle is not None:
                self._check_angle(wheel)
        self._check_powers()
        self.inertia = self._is_fast()

    def _is_fast(self) -> bool | None:
        """Whether a bearing turns fast enough for inertia; `None` at rest."""
        if self.drive is None or not self.turns:
            return None
        sizes = [
            (seat.shaft, pitch_radius(in_numpy(seat.installed.drawing.bearing)))
            for seat in self.seats
            if seat.installed is not None
        ]
        numbers = self.drive.speed, self.wheels, [radius for _, radius in sizes]
        if any(map(is_traced, jax.tree.leaves(numbers))):
            return True
        ratio, speed = self._speed_ratios(), abs(float(self.drive.speed))
        return any(
            speed * ratio.get(shaft, 1.0) * 2.0 * float(radius) >= _FAST
            for shaft, radius in sizes
        )

    def _speed_ratios(self) -> dict[str, float]:
        """Return sizes of the speeds of all shafts over that of the drive, by name."""
        into = self.drive.into if self.drive is not None else ""
        names = [wheel.name for wheel in self.wheels]
        ratio = {self.wheel(into).shaft if into in names else into: 1.0}
        pairs = in_numpy(self.pairs())
        for _ in pairs:
            for near, far in (*pairs, *(pair[::-1] for pair in pairs)):
                sizes = [
                    w.teeth if isinstance(w, Gear) else w.radius for w in (near, far)
                ]
                if near.shaft in ratio and far.shaft not in ratio:
                    ratio[far.shaft] = ratio[near.shaft] * float(sizes[0] / sizes[1])
        return ratio

    def _check_kinds(self):
        kinds = {
            "shafts": ShaftLine,
            "seats": Seat,
            "wheels": (Gear, Pulley),
            "couplings": Coupling,
            "loads": ShaftLoad,
        }
        for name, kind in kinds.items():
            for part in getattr(self, name):
                if not isinstance(part, kind):
                    raise TypeError(
                        f"ShaftSystem: `{name}` holds a {type(part).__name__}."
                    )
        for name, kind in (("drive", Drive), ("housing", HousingStiffness)):
            instance(self, name, kind, None)

    def _check_names(self):
        placed = *self.seats, *self.wheels, *self.loads
        names = [part.name for part in (*self.shafts, *placed, *self.couplings)]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(
                f"ShaftSystem: two parts are called {twice[0]}; names are unique."
            )
        shafts = [shaft.name for shaft in self.shafts]
        for part in (*placed, *self.couplings):
            if part.shaft not in shafts:
                raise ValueError(
                    f"ShaftSystem: `shaft` of {part.name} is {part.shaft!r}; the shafts"
                    f" are {', '.join(shafts)}."
                )
        for name in shafts:
            if not any(seat.shaft == name for seat in self.seats):
                raise ValueError(f"ShaftSystem: no bearing holds shaft {name}.")
        wheels = [wheel.name for wheel in self.wheels]
        for wheel in self.wheels:
            if wheel.mates_with is not None and wheel.mates_with not in wheels:
                raise ValueError(
                    f"ShaftSystem: `mates_with` of {wheel.name} is"
                    f" {wheel.mates_with!r}; the wheels are {', '.join(wheels)}."
                )
        if self.drive is not None and self.drive.into not in (*shafts, *wheels):
            raise ValueError(
                f"ShaftSystem: `drive.into` is {self.drive.into!r}; it must be a shaft"
                f" ({', '.join(shafts)}) or a wheel without a mate."
            )
        if self.housing is not None:
            seats = [seat.name for seat in self.seats]
            for name in self.housing.seats:
                if name not in seats:
                    raise ValueError(
                        f"ShaftSystem: the housing has a seat {name!r}; the bearings"
                        f" are {', '.join(seats)}."
                    )

    def _check_mesh(self, one, other):
        pair = f"{one.name} and {other.name}"
        if type(one) is not type(other):
            raise ValueError(f"ShaftSystem: {pair} are not of one kind.")
        if one.shaft == other.shaft:
            raise ValueError(f"ShaftSystem: {pair} sit on one shaft.")
        for wheel in (one, other):
            if wheel.torque is not None or wheel.power is not None:
                raise ValueError(
                    f"ShaftSystem: {wheel.name} has a mate, from which its torque"
                    " follows; leave out its `torque` or `power`."
                )
        shafts = [self.shaft(w.shaft) for w in (one, other)]
        a, b = (np.asarray(shaft.frame[2]) for shaft in shafts)
        parallel = np.linalg.norm(np.cross(a, b)) < _ACROSS
        gears = isinstance(one, Gear)
        if gears:
            self._check_teeth(one, other)
        if not parallel and not (gears and one.pitch_angle is not None):
            more = "; crossed helical gears and worms are not modelled" if gears else ""
            problem = f"the shafts of {pair} are not parallel{more}"
            raise ValueError(f"ShaftSystem: {problem}.")
        self._check_place(one, other)

    def _check_teeth(self, one, other):
        """Raise unless the teeth of two gears fit each other."""
        pair = f"{one.name} and {other.name}"
        for name in ("normal_module", "pressure_angle", "helix_angle"):
            known = floats(getattr(one, name), getattr(other, name))
            if known and abs(known[0] - known[1]) > 1e-6 * max(map(abs, known)):
                scale, unit = (1e3, "mm") if "module" in name else (180 / np.pi, "deg")
                raise ValueError(
                    f"ShaftSystem: `{name}` is {scale * known[0]:.8g} {unit} of"
                    f" {one.name} and {scale * known[1]:.8g} {unit} of {other.name};"
                    " meshing gears have the same."
                )
        if {one.hand, other.hand} not in ({"none"}, {"left", "right"}):
            raise ValueError(
                f"ShaftSystem: `hand` is {one.hand!r} of {one.name} and {other.hand!r}"
                f" of {other.name}; one must be left, one right."
            )
        if (one.pitch_angle is None) != (other.pitch_angle is None):
            raise ValueError(f"ShaftSystem: one of {pair} is bevel, one cylindrical.")
        if one.pitch_angle is None:
            return
        a, b = (
            np.asarray(outward_direction(g, self.shaft(g.shaft))) for g in (one, other)
        )
        between = np.arccos(np.clip(a @ b, -1.0, 1.0))
        known = floats(one.pitch_angle, other.pitch_angle)
        if known and abs(between - sum(known)) > 1e-3:
            raise ValueError(
                f"ShaftSystem: the pitch angles of {pair} add up to"
                f" {np.degrees(sum(known)):.5g} deg; between the shafts, from the apex"
                f" to the gears, are {np.degrees(between):.5g} deg."
            )

    def _check_place(self, one, other):
        """Raise if it is not known where two wheels touch, or they do not."""
        pair, gears = f"{one.name} and {other.name}", isinstance(one, Gear)
        both = mesh_place(one, other, self.shaft(one.shaft), self.shaft(other.shaft))
        if both is None:
            if gears and one.mesh_angle is None and other.mesh_angle is None:
                raise ValueError(
                    f"ShaftSystem: it is not known where {pair} mesh; give a"
                    " `mesh_angle` of one of them, or the origins of both shafts."
                )
            return
        if any(map(is_traced, (*both.gap, both.size, both.overlap))):
            return
        gap, size, overlap = float(np.linalg.norm(both.gap)), both.size, both.overlap
        usual, bevel = one.radius + other.radius, gears and one.pitch_angle is not None
        if gears and abs(size - usual) > _APART * usual:
            raise ValueError(
                f"ShaftSystem: the shafts of {pair} are {1e3 * float(size):.6g} mm"
                f" apart, their pitch circles touch at {1e3 * float(usual):.6g} mm."
            )
        where = f"{1e3 * gap:.6g} mm apart along their shafts"
        if overlap is not None and overlap <= 0.0:
            problem = f"the faces of {pair} do not overlap, middles {where}"
        elif overlap is not None or gap <= _APART * size:
            return
        elif bevel:
            problem = f"the cones of {pair} have apexes that are {1e3 * gap:.6g} mm"
            problem += " apart; bevel gears that mesh have one"
        else:
            problem = f"{pair} are {where}; wheels that mesh, or share a belt, are in"
            problem += " one plane"
        raise ValueError(f"ShaftSystem: {problem}.")

    def _check_angle(self, gear):
        """Raise if a `mesh_angle` contradicts the places of the shafts, or the angle of
        the mate, or would be that of two meshes."""
        shaft, ways, source = self.shaft(gear.shaft), [], "the places of the shafts"
        pairs, lent = self.pairs(), []
        for pair in pairs:
            names = [wheel.name for wheel in pair]
            if gear.name not in names:
                continue
            side = names.index(gear.name)
            both = mesh_place(*pair, *(self.shaft(wheel.shaft) for wheel in pair))
            mate: Any = pair[1 - side]
            way = None
            if both is not None:
                way = both.ways[side]
            elif mate.mesh_angle is None:
                lent.append(mate.name)
            elif sum(mate.name in {w.name for w in p} for p in pairs) == 1:
                way = -self.shaft(mate.shaft).radial_direction(mate.mesh_angle)
                source = f"that of {mate.name}"
            ways.append(way)
        if len(lent) > 1:
            raise ValueError(
                f"ShaftSystem: `mesh_angle` of {gear.name} would be that of its meshes"
                f" with {' and '.join(lent)}; give a `mesh_angle` of each of these."
            )
        own = shaft.radial_direction(gear.mesh_angle)
        if not ways or any(way is None or is_traced(way) for way in (*ways, own)):
            return
        if max(float(way @ own) for way in ways) < np.cos(_ANGLE):
            there = np.arctan2(shaft.frame[1] @ ways[0], shaft.frame[0] @ ways[0])
            raise ValueError(
                f"ShaftSystem: `mesh_angle` of {gear.name} is"
                f" {np.degrees(float(gear.mesh_angle)):.6g} deg; by {source} it meshes"
                f" at {np.degrees(there):.6g} deg; leave out one of them."
            )

    def _check_powers(self):
        """Raise for a power at rest, from which no torque follows."""
        if self.turns:
            return
        for part in (*self.wheels, *self.couplings):
            power = part.power
            if power is not None and (is_traced(power) or float(power) != 0.0):
                raise ValueError(
                    f"ShaftSystem: `power` of {part.name} needs a `speed` of the drive,"
                    " from which its torque follows; give the `torque` of a machine at"
                    " rest."
                )

    def with_parts(self, **parts: Any) -> "ShaftSystem":
        """Return the system with other numbers in some of its fields.

        Args:
            **parts: New values of fields, of the same structure; traced ones pass
                unchecked.

        Raises:
            ValueError: If the system does not allow them, or a part has passed another
                one or the end of a segment.
        """
        inertia = self.inertia
        if not any(map(is_traced, jax.tree.leaves((self, parts)))):
            names = "shafts seats drive wheels couplings loads housing gravity".split()
            given = {name: getattr(self, name) for name in names}
            whole = ShaftSystem(**given | parts)
            for line, old, new in zip(
                self.shafts, self.plans, whole.plans, strict=True
            ):
                if new._replace(divisions=old.divisions) != old:
                    raise ValueError(
                        f"ShaftSystem: on shaft {line.name} stand {_order(new)} in"
                        f" place of {_order(old)}; no part may pass another one or a"
                        " step of the shaft."
                    )
            inertia = feel_speed((self.inertia, whole.inertia))
        other = copy.copy(self)
        object.__setattr__(other, "inertia", inertia)
        for name, value in parts.items():
            object.__setattr__(other, name, value)
        return other

    @property
    def turns(self) -> bool:
        """Whether it is driven at a speed, or, of a traced speed, may be. Static."""
        drive = self.drive
        return drive is not None and (
            is_traced(drive.speed) or float(drive.speed) != 0.0
        )

    def shaft(self, name: str) -> ShaftLine:
        """Return a shaft by its name."""
        return next(shaft for shaft in self.shafts if shaft.name == name)

    def wheel(self, name: str) -> Gear | Pulley:
        """Return a wheel by its name."""
        return next(wheel for wheel in self.wheels if wheel.name == name)

    def pairs(self) -> list[tuple[Gear | Pulley, Gear | Pulley]]:
        """Return the pairs of mates, each once, also if both name each other."""
        found: dict[Any, tuple[Any, Any]] = {}
        for wheel in self.wheels:
            if wheel.mates_with is not None:
                mate = self.wheel(wheel.mates_with)
                found.setdefault(frozenset((wheel.name, mate.name)), (wheel, mate))
        return list(found.values())

    def parts_on(self, shaft: str) -> list[AbstractPlaced]:
        """Return bearings, wheels and loads of a shaft by its name."""
        placed = *self.seats, *self.wheels, *self.loads
        return [part for part in placed if part.shaft == shaft]

    def seats_on(self, index: int) -> list[int]:
        """Return the numbers of the bearings on a shaft.

        Args:
            index: Number of the shaft.
        """
        name = self.shafts[index].name
        return [k for k, seat in enumerate(self.seats) if seat.shaft == name]

    def beam(self, index: int) -> Shaft:
        """Return the beam of a shaft.

        Args:
            index: Number of the shaft.
        """
        line = self.shafts[index]
        places = {part.name: part.position for part in self.parts_on(line.name)}
        return line.shaft(self.plans[index], places)

    def station(self, part: AbstractPlaced) -> tuple[int, int]:
        """Return number of shaft and station of a part."""
        index = [shaft.name for shaft in self.shafts].index(part.shaft)
        return index, dict(self.plans[index].place)[part.name]

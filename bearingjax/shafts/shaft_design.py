"""Systems of shafts in design: `bearingjax.optimise` over their load cases.

design, cases = load_cases([ShaftDesign(system, conditions)])
free = [Variable("system.seats.0.position", 0.03, 0.06)]
best = bj.optimise.optimise(design, cases, free, SystemLife())
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.tree_util import tree_leaves_with_path, tree_map_with_path
from jaxtyping import Array, Float

from ..cases.cases import check_hours
from ..design.checks import are_known, one_of
from ..element.bearing_element import BearingElement
from ..element.frame import FREEDOMS, LOAD_UNITS, LOADS, MOTION_UNITS
from ..life.life import LifeConditions
from ..life.life_warning import ALL
from ..life.rating import check_alike
from ..numerics.types import Scalar, array_namespace, as_real, with_fields
from ..numerics.units import unit
from ..numerics.warning import Warning, warnings_of, warnings_of_cases
from ..optimise.measure import AbstractMeasure, AbstractSmooth, hour_weights
from ..optimise.smooth import largest, smallest, smooth_maximum, smooth_minimum
from ..optimise.system import AbstractSystem, Reading
from ..optimise.variable import dotted_path
from .bearing_oil import BearingOil
from .changes import (
    BearingNumbers,
    PlacedBearing,
    numbers_of_bearing,
    solve_with_changes,
)
from .duty import (
    FEW,
    LIVES,
    DutyResult,
    align_systems,
    bearing_hours,
    numbers_of,
    system_life,
)
from .equilibrium import system_state
from .parts import Gear
from .power import power_flow
from .seats import speed_of, with_preload_offsets
from .system import ShaftSystem
from .warning import load_doubts


class ShaftCases(eqx.Module):
    """Load cases of a `ShaftDesign`, from `load_cases`.

    Attributes:
        hours: Time in each case (case,) [h]; equal if it is not known.
        values: Numbers that differ from case to case, leading axis case.
        paths: Dotted paths of these numbers in the design.

    Traced: hours, values. Static: paths.
    """

    hours: Float[Array | np.ndarray, " case"] = eqx.field(metadata=unit("h"))
    values: tuple[Any, ...]
    paths: tuple[str, ...] = eqx.field(static=True)

    @property
    def count(self) -> int:
        """Number of cases."""
        return self.hours.shape[0]


class ShaftDesign(AbstractSystem):
    """A system of shafts with the lives of its bearings, for `bearingjax.optimise`.

    Any number may be a variable: "system.seats.0.position", "system.seats.1.preload",
    "system.seats.0.installed.drawing.bearing.radial_internal_clearance",
    "system.shafts.0.outer_diameter.1". Parts may not pass each other or the steps of
    their shaft: such designs are rejected.

    Attributes:
        system: The system.
        lives: Conditions of the life of each bearing; `None` of springs.
        oils: Oil of each bearing, `None` of springs; without them (`None`) the friction
            of bearings is not known.

    Traced: all numbers.

    Raises:
        ValueError: If they are not as many as the bearings, or a bearing is a set of
            unlike rows.
    """

    of_cases: ClassVar[type] = ShaftCases

    system: ShaftSystem
    lives: tuple[LifeConditions | None, ...] = eqx.field(converter=tuple)
    oils: tuple[BearingOil | None, ...] | None = None

    def __check_init__(self):
        for name in ("lives", "oils"):
            found = getattr(self, name)
            count = len(self.system.seats)
            if found is not None and len(found) != count:
                raise ValueError(
                    f"ShaftDesign: `{name}` are {len(found)} of {count} bearings; give"
                    " one for each, `None` of springs."
                )
        for seat in self.system.seats:
            if seat.installed is not None:
                check_alike(seat.installed.drawing.bearing)

    @property
    def element(self) -> BearingElement[Any]:
        raise TypeError("ShaftDesign: it has several bearings, `system.seats`.")

    def check(self, cases: Any) -> None:
        pass

    def solve_case(self, case: Any, support: Any, options: Any) -> DutyResult:
        return self._in_case(case).solve()

    def _in_case(self, case: ShaftCases) -> "ShaftDesign":
        own = dict(zip(case.paths, case.values, strict=True))
        return tree_map_with_path(lambda at, x: own.get(dotted_path(at), x), self)

    def is_solved_by_parts(self, cases: ShaftCases) -> bool:
        return cases.count <= FEW and are_known(self, cases)

    def solve_by_parts(
        self, cases: ShaftCases, changes: Any
    ) -> tuple[DutyResult, DutyResult | None]:
        if changes is not None:
            varies = tree_map_with_path(
                lambda at, _: dotted_path(at) in cases.paths, self
            )
            changes = jax.tree.map(_unless, varies, changes)
        each, moved = [], []
        for k in range(cases.count):
            case = jax.tree.map(lambda leaf, k=k: np.asarray(leaf)[k], cases)
            own, change = self._in_case(case)._solve_by_parts(changes)
            each.append(own)
            moved.append(change)
        solved = jax.tree.map(lambda *one: np.stack(one), *each)
        if None in moved:
            return solved, None
        return solved, jax.tree.map(lambda *one: np.stack(one, axis=1), *moved)

    def _solve_by_parts(self, changes):
        """Return the results of known numbers, and their changes with several."""
        moved = changes
        if changes is not None:
            moved = changes.system, changes.lives, changes._oils
        own, moved = solve_with_changes(self.system, self.lives, self._oils, moved)
        axes = () if moved is None else moved[0]["speed"].shape[:1]
        return self._collect(*own), moved and self._collect(*moved, *axes)

    @property
    def _oils(self):
        return (None,) * len(self.lives) if self.oils is None else self.oils

    def solve(self) -> DutyResult:
        """Solve this design; nothing is raised for a failed solve.

        Returns:
            The numbers of one case, without the case axis; of springs zeros.
        """
        if are_known(self):
            return self._solve_by_parts(None)[0]
        system = with_preload_offsets(self.system, throw=False)
        found, inertia = numbers_of(system_state(system)[0]), system.inertia
        each: list[BearingNumbers | None] = []
        for k, (seat, conditions) in enumerate(
            zip(system.seats, self.lives, strict=True)
        ):
            if seat.installed is None or conditions is None:
                each.append(None)
                continue
            speed, _ = speed_of(system, k, found["speed"])
            own = seat.installed, found["motion"][k], speed, conditions, self._oils[k]
            each.append(numbers_of_bearing(PlacedBearing(*own), inertia))
        return self._collect(found, each)

    def _collect(
        self, found: dict[str, Any], each: Sequence[BearingNumbers | None], *axes: int
    ) -> DutyResult:
        """Return a result from its parts, or changes of a result from theirs, with an
        axis of their own."""
        zero = as_real(np.zeros(axes))
        none = BearingNumbers(None, zero, {}, {}, zero)
        parts = [none if one is None else one for one in each]

        def stack(values):
            return array_namespace(found["load"]).stack(values, axis=len(axes))

        kept = "load displacement misalignment speed loss".split()
        code = found["result"]
        collected = DutyResult(
            **{name: found[name] for name in kept},
            result=np.zeros(axes, np.int32) if code is None else code,
            peak_pressure=stack([one.peak for one in parts]),
            lives={n: stack([one.lives.get(n, zero) for one in parts]) for n in LIVES},
            warned=tuple(one.warned for one in parts),
            friction=None if self.oils is None else stack([one.power for one in parts]),
        )
        # A code has no change.
        return with_fields(collected, result=code)

    def failure_message(self, solved: Any) -> str:
        return "the shafts find no equilibrium on their bearings"

    def readings(self) -> dict[str, Reading]:
        """Numbers of a case that can be measured: of each bearing, by its name ("A."),
        load, displacement, peak_pressure and with oils friction; of each gear
        misalignment, "misalignment_b" of that with b of several; the loss in meshes."""
        found = {"loss": Reading("loss", 0, "W")}
        for k, seat in enumerate(self.system.seats):
            axes = ("load", LOADS, LOAD_UNITS), ("displacement", FREEDOMS, MOTION_UNITS)
            for field, names, units in axes:
                for i, (name, one) in enumerate(zip(names, units, strict=True)):
                    own = Reading(field, len(names) * k + i, one)
                    found[f"{seat.name}.{field}_{name}"] = own
            if seat.installed is not None:
                pressure = Reading("peak_pressure", k, "Pa")
                found[f"{seat.name}.peak_pressure"] = pressure
                if self.oils is not None:
                    found[f"{seat.name}.friction"] = Reading("friction", k, "W")
        meshes = power_flow(self.system).meshes
        wheels = [mesh.wheel for mesh in meshes]
        for k, mesh in enumerate(meshes):
            if isinstance(self.system.wheel(mesh.wheel), Gear):
                mate = f"_{mesh.mate}" if wheels.count(mesh.wheel) > 1 else ""
                own = Reading("misalignment", k, "rad")
                found[f"{mesh.wheel}.misalignment{mate}"] = own
        return found

    def warnings(self, cases: Any, solved: Callable[[], Any]) -> list[Warning]:
        found, of_cases = [], solved()
        for seat, sizes in zip(self.system.seats, of_cases.warned, strict=True):
            every = warnings_of_cases(jax.device_get(sizes), ALL)
            found += warnings_of(seat.name, every)
        return [*found, *load_doubts(self.system, of_cases.load)]

    def hours(self, cases: ShaftCases, solved: Any) -> Float[Array, " bearing"]:
        """Life of each bearing under all cases (bearing,) [h]; infinite of springs.

        Args:
            cases: The load cases.
            solved: Their solutions, leading axis case.
        """
        of = np.array([self.system.station(seat)[0] for seat in self.system.seats])
        return bearing_hours(solved.lives["damage"], solved.speed[:, of], cases.hours)

    @property
    def bearings(self) -> list[int]:
        """Numbers of the seats that hold a bearing, not springs."""
        seats = enumerate(self.system.seats)
        return [k for k, seat in seats if seat.installed is not None]


def _unless(varies: bool, change: Any) -> Any:
    """Return a change of a number, none if cases change it."""
    return np.zeros_like(change) if varies and change is not None else change


def load_cases(
    designs: Sequence[ShaftDesign], hours: Any = None
) -> tuple[ShaftDesign, ShaftCases]:
    """Return the design of the first case, and what differs in the others.

    Args:
        designs: The design in each case: one structure, other numbers.
        hours: Time in each case (case,) [h]; `None`: the same in all.

    Raises:
        ValueError: If there are none, they differ in structure, or the hours are not
            one for each, negative, or all zero.
    """
    if not designs or (hours is not None and len(hours) != len(designs)):
        raise ValueError(
            f"load_cases: {len(designs)} designs and"
            f" {'no' if hours is None else len(hours)} hours; give one design at least,"
            " and hours for each or none."
        )
    check_hours(hours)
    systems = align_systems([design.system for design in designs])
    whole = [
        eqx.tree_at(lambda d: d.system, design, system)
        for design, system in zip(designs, systems, strict=True)
    ]
    if any(jax.tree.structure(w) != jax.tree.structure(whole[0]) for w in whole):
        raise ValueError("load_cases: the cases differ in more than numbers.")
    places = [dotted_path(at) for at, _ in tree_leaves_with_path(whole[0])]
    columns = zip(*map(jax.tree.leaves, whole), strict=True)
    varying = {
        path: np.stack([np.asarray(x) for x in column])
        for path, column in zip(places, columns, strict=True)
        if any(not np.array_equal(x, column[0]) for x in column[1:])
    }
    times = np.ones(len(designs)) if hours is None else np.asarray(hours, float)
    return whole[0], ShaftCases(times, tuple(varying.values()), tuple(varying))


class PowerOf(AbstractMeasure):
    """A measure to a power, which is made least in its place.

    Attributes:
        measure: The measure.
        power: Such as -1 of a life, or 2 of what may change its sign. Static.
    """

    measure: AbstractMeasure
    power: int = eqx.field(static=True)

    def __call__(self, element: Any, cases, solution):
        return self.measure(element, cases, solution) ** self.power

    def exact_value(self, element: Any, cases: Any, solution: Any) -> Scalar:
        return self.measure.exact_value(element, cases, solution) ** self.power

    @property
    def reported_as(self) -> "AbstractMeasure":
        return self.measure

    def reported_value(self, value: Any) -> Any:
        return value ** (1.0 / self.power)

    @property
    def maximised(self) -> bool:
        return self.power < 0

    @property
    def least_size(self) -> float:
        # Of angles: a microradian. Divided by less round-off would look like a slope.
        return 0.0 if self.maximised else 1e-12

    @property
    def label(self) -> str:
        return f"{self.measure.label} to the power {self.power}"

    @property
    def unit(self) -> str:
        return ""


class SystemLife(AbstractMeasure):
    """Life that all bearings reach together, `system_life` [h].

    The damage of the cases is added up. As an objective it is made largest.
    """

    def __call__(self, element: Any, cases, solution):
        return system_life(element.system, element.hours(cases, solution))

    @property
    def as_objective(self) -> "AbstractMeasure":
        return PowerOf(self, -1)

    @property
    def label(self) -> str:
        return "system life"

    @property
    def unit(self) -> str:
        return "h"


_WORST = {
    "rating_life": ("h", -1),
    "static_safety": ("", -1),
    "peak_pressure": ("Pa", 1),
    "tilt": ("rad", 1),
    "misalignment": ("rad", 2),
}
"""Kinds of `Worst`: SI unit, and the power that is made least in its place; those with
-1 are worst where they are least."""


class Worst(AbstractSmooth):
    """A number of the bearing, or mesh, and the case in which it is worst.

    Attributes:
        kind: For bearings "rating_life" [h], of all cases together, or "static_safety",
            the least; "peak_pressure" [Pa] or "tilt" [rad] of inner against outer ring,
            the largest; of gears "misalignment" [rad], the largest. As an objective the
            first two are made largest, and of the last one the square least.
        of: Name of the bearing, or of one of the gears; `None`: of all.
        exponent: Exponent of the smooth maximum or minimum.

    Static: all.
    """

    kind: str = eqx.field(static=True)
    of: str | None = eqx.field(static=True, default=None)

    def __check_init__(self):
        super().__check_init__()
        one_of(self, "kind", self.kind, _WORST)

    def samples(self, element: ShaftDesign, cases: ShaftCases, solution: Any) -> Array:
        """The numbers of which it is the worst (sample,).

        Args:
            element, cases, solution: As in `__call__`.

        Raises:
            ValueError: If the system has no such bearing or gear.
        """
        at = np.array([*self._select(element)])
        if not at.size:
            part = "gear" if self.kind == "misalignment" else "bearing"
            name = "" if self.of is None else f" {self.of!r}"
            raise ValueError(f"Worst: the system has no {part}{name}.")
        if self.kind == "rating_life":
            return element.hours(cases, solution)[at]
        if self.kind == "misalignment":
            return jnp.abs(solution.misalignment[:, at]).reshape(-1)
        if self.kind == "tilt":
            turned = solution.displacement[:, at, 3:].reshape(-1, 3)
            square = jnp.sum(turned**2, axis=1)
            none = square == 0.0
            return jnp.where(none, 0.0, jnp.sqrt(jnp.where(none, 1.0, square)))
        pressures = self.kind == "peak_pressure"
        found = solution.peak_pressure if pressures else solution.lives[self.kind]
        return found[:, at].reshape(-1)

    def _select(self, element: ShaftDesign) -> Iterable[int]:
        """Return the numbers of the bearings, or meshes, that count."""
        system, of = element.system, element.bearings
        if self.kind != "misalignment":
            return [k for k in of if self.of in (None, system.seats[k].name)]
        # Both mates have the same.
        pairs: dict[Any, int] = {}
        for k, mesh in enumerate(power_flow(system).meshes):
            pair = mesh.wheel, mesh.mate
            if isinstance(system.wheel(mesh.wheel), Gear) and self.of in (None, *pair):
                pairs.setdefault(frozenset(pair), k)
        return pairs.values()

    def __call__(self, element: Any, cases, solution):
        of = smooth_minimum if self._power < 0 else smooth_maximum
        return of(self.samples(element, cases, solution), self.exponent)

    def exact_value(self, element: Any, cases: Any, solution: Any) -> Scalar:
        of = smallest if self._power < 0 else largest
        return of(self.samples(element, cases, solution))

    @property
    def _power(self):
        return _WORST[self.kind][1]

    @property
    def as_objective(self) -> "AbstractMeasure":
        return self if self._power == 1 else PowerOf(self, self._power)

    @property
    def label(self) -> str:
        of = f" of {self.of}" if self.of else ""
        return f"{self.kind.replace('_', ' ')}{of}"

    @property
    def unit(self) -> str:
        return _WORST[self.kind][0]


class PowerLoss(AbstractMeasure):
    """Mean power lost in bearings and meshes over the hours of the cases [W].

    The design needs the oils of its bearings.
    """

    def __call__(self, element: Any, cases, solution):
        if solution.friction is None:
            raise ValueError(
                "PowerLoss: the design has no `oils`, so that the friction of its"
                " bearings is not known."
            )
        lost = jnp.sum(solution.friction, axis=1) + solution.loss
        return jnp.sum(hour_weights(cases) * lost)

    @property
    def label(self) -> str:
        return "power loss"

    @property
    def unit(self) -> str:
        return "W"


class ShaftMass(AbstractMeasure):
    """Mass of the shafts, without wheels and bearings [kg]."""

    def __call__(self, element: Any, cases, solution):
        system = element.system
        beams = (system.beam(k) for k in range(len(system.shafts)))
        return jnp.sum(jnp.stack([jnp.sum(b.element_masses()) for b in beams]))

    @property
    def label(self) -> str:
        return "mass of the shafts"

    @property
    def unit(self) -> str:
        return "kg"

"""Selection of the bearings at several positions of a system of shafts together.

The loads with the present bearings give a short list for each position. Combinations of
the short lists are then solved in the whole system, as loads shift with the stiffness
of the bearings and with the points where their lines of action meet the axis.
"""

import contextlib
import dataclasses
import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import equinox as eqx
import jax
import numpy as np

from ..cases.cases import Cases
from ..cases.sweep import structure_of
from ..catalogue.entry import CatalogueEntry, catalogue_entries
from ..design.checks import must_be, one_of
from ..numerics.labels import LabelledArray, make_dataset
from ..numerics.result import Result, SolveError
from ..numerics.shown import Shown
from ..numerics.types import with_fields
from ..rotor.bearing_support import TURNED
from ..shafts import DutyResult, ShaftDesign, ShaftSystem, solve_duty
from ..shafts.duty import FEW, align_systems
from ..shafts.seats import installed_of_kind
from ..statics import Installed
from .select import (
    NUMBERS,
    Miss,
    Requirements,
    Selection,
    bearing_as_drawn,
    judge_bearing,
    select,
    unit_of_number,
)

_MOST = 100
"""Largest number of combinations that are solved."""

_TYPES = 2
"""Largest number of types in a short list: each type needs programs of its own."""

_NO_LOAD = 1e-6
"""Force, over the largest one of its case, below which it counts as zero [1]."""

_ITS_OWN = "bounds", "types", "clearance_class", "rank_by", "options", "supply"


@dataclasses.dataclass(frozen=True)
class PositionSelection(Shown):
    """Combinations of bearings, the best first: those with which every position fulfils
    its requirements, then the others, the nearest first.

    Attributes:
        alone: `Selection` of each position by its name, under the loads with the
            present bearings.
        table: Columns by name (combination, position) [SI]: designation, type; the
            numbers of a `Selection` in the whole system, friction and stiffness as in
            `alone`; the largest radial_force and axial_force of all cases, the latter
            along the z axis of the bearing, with its sign [N], and both with the
            present bearings (present_radial_force, present_axial_force); and of the
            requirement that fails by most its name ("": none), value, limit, why.
        kinds: Number of structures among the bearings of the short lists; the programs
            of each structure are compiled once.
    """

    alone: dict[str, Selection]
    table: dict[str, np.ndarray]
    kinds: int

    @property
    def holds(self) -> np.ndarray:
        """Whether each combination fulfils all requirements (combination,)."""
        return (self.table["requirement"] == "").all(axis=1)

    @property
    def best(self) -> dict[str, str] | None:
        """Designations of the best combination by position; `None` if none holds."""
        names = self.table["designation"][0].tolist()
        return dict(zip(self.alone, names, strict=True)) if self.holds[0] else None

    def shown_facts(self) -> Iterator[Any]:
        """Yield how many combinations hold, and the best one."""
        yield 1, "holds", f"{self.holds.sum()} of {self.holds.size}", "combinations"
        for name, one in (self.best or {}).items():
            yield 1, name, one, "in the best combination"

    def to_xarray(self) -> Any:
        """Return all combinations as an `xarray.Dataset`, with units.

        Raises:
            ImportError: Without xarray.
        """
        axes, pairs = ("combination", "position"), self.table.items()
        found = {k: LabelledArray(v, axes, unit_of_number(k)) for k, v in pairs}
        return make_dataset(found, {"position": list(self.alone)})

    def to_pandas(self) -> Any:
        """Return a row for each combination and position as a `pandas.DataFrame`;
        raises as `to_xarray`."""
        return self.to_xarray().to_dataframe()


def select_positions(
    designs: Sequence[ShaftDesign],
    requirements: Mapping[str, Mapping[str, Any]],
    *,
    hours: Any = None,
    rank_by: str | Sequence[str] = "mass",
    short_list: int = 3,
    entries: Iterable[CatalogueEntry] | None = None,
    install: Callable[[str, CatalogueEntry], Installed] | None = None,
    progress: Callable[[str, float], Any] | None = None,
) -> PositionSelection:
    """Select the bearings at several positions of a system of shafts together.

    `select` compares the catalogue under the forces and tilts that each position has
    with the present bearings. Every combination of the best ones is solved in the whole
    system, where lives, static safety, load ratio and pressure are evaluated again.
    Bounds of friction and stiffness are compared under the loads with the present
    bearings alone. Positions that are not named keep their bearings, without a verdict.

    Args:
        designs: The system with its present bearings, in each load case.
        requirements: By name of the position a mapping of `bounds`, `types`,
            `clearance_class`, `rank_by`, `options`, `supply`, as of `Requirements`.
            Unless bounded, the bore is the diameter of the shaft there. Conditions of
            the lives are those of the designs, in the short lists of the first one.
        hours: Time in each case (case,) [h]; `None`: the same in all.
        rank_by: Names of numbers as in `Requirements`, by their sum over the positions,
            the smallest first; of numbers with a least bound by their minimum, the
            greatest first. It also ranks positions without a `rank_by` of their own.
        short_list: Most bearings of a position that are combined, of two types at most.
        entries: Bearings to choose from; `None`: `catalogue_entries()`.
        install: Function from the name of a position and an entry to the bearing on its
            seats; `None`: as drawn.
        progress: Function called with a text and the share done.

    Returns:
        PositionSelection; a combination without equilibrium fails "solved".

    Raises:
        TypeError, ValueError: As `select`; for a position that does not exist, has
            springs, or another bearing from case to case; unknown keys; two bearings
            of one designation; too many combinations.
        SolveError: If the present bearings have no equilibrium, or no bearing fits a
            position, with the nearest misses.
    """
    own, progress = "select_positions", progress or (lambda words, share: None)
    must_be(own, "designs", designs, bool(designs), "one at least")
    must_be(own, "requirements", requirements, bool(requirements), "of one position")
    count = short_list ** len(requirements)
    words = f"above 0, and combine {_MOST} at most; it combines {count}"
    must_be(own, "short_list", short_list, 0 < count <= _MOST and short_list > 0, words)
    every = list(catalogue_entries() if entries is None else entries)
    alike = len({entry.designation for entry in every}) == len(every)
    must_be(own, "entries", "with a designation twice", alike, "without")
    systems = align_systems([design.system for design in designs])
    lives = [design.lives for design in designs]
    seats = {name: _seat_number(systems, name) for name in requirements}
    progress("present bearings", 0.0)
    present = _solve_cases(systems, lives)
    for case, code in enumerate(present.result):
        why = f"{Result(int(code)).label} with the present bearings (case {case})"
        if int(code) != Result.CONVERGED:
            raise SolveError(f"{own}: {why}")
    ranks = (rank_by,) if isinstance(rank_by, str) else tuple(rank_by)
    alone, listed, rows = {}, [], []
    for name, k in seats.items():
        for key in requirements[name]:
            one_of(own, f"requirements of {name}", key, _ITS_OWN)
        given = {"rank_by": ranks, **requirements[name]}
        given["bounds"] = dict(given.get("bounds", ()))
        if "bore" not in given["bounds"]:
            given["bounds"]["bore"] = _shaft_diameter(systems[0], k)
        asked = _requirements(systems, lives[0][k], present, k, hours, given)
        drawn: dict[str, Installed] = {}

        def build(entry: CatalogueEntry, name=name, drawn=drawn) -> Installed:
            one = bearing_as_drawn(entry) if install is None else install(name, entry)
            return drawn.setdefault(entry.designation, one)

        found = alone[name] = select(
            asked, entries=every, install=build, progress=progress
        )
        if not found.fits:
            near = "; ".join(found.nearest_misses(3))
            problem = f"no bearing fits {name} under the loads with the present ones"
            raise SolveError(f"{own}: {problem}; the nearest: {near}")
        types = [*dict.fromkeys(row["type"] for row in found.fits)][:_TYPES]
        best = [row for row in found.fits if row["type"] in types][:short_list]
        loads = _loads(systems, present, k, "present_")
        listed.append([(row | loads, drawn[row["designation"]]) for row in best])
    combined = [*itertools.product(*listed)]
    for done, combination in enumerate(combined):
        progress("combinations in the whole system", done / len(combined))
        new = {k: one for k, (_, one) in zip(seats.values(), combination, strict=True)}
        duty, changed = None, [_with_bearings(system, new) for system in systems]
        with contextlib.suppress(SolveError):  # a preload too large for a bearing
            duty = _solve_cases(align_systems(changed), lives)
        for (name, k), (row, _) in zip(seats.items(), combination, strict=True):
            asked = alone[name].requirements
            rows.append(_judge_position(asked, changed, duty, k, row))
    table = {
        name: np.array([row[name] for row in rows]).reshape(-1, len(seats))
        for name in rows[0]
    }
    keys = [
        -table[name].min(axis=1)
        if NUMBERS[name][1] == "least"
        else table[name].sum(axis=1)
        for name in (*ranks, "mass")
    ]
    order = np.lexsort(np.stack([*keys[::-1], -table.pop("share").min(axis=1)]))
    table = {name: values[order] for name, values in table.items()}
    kinds = {structure_of(installed_of_kind(one)) for row in listed for _, one in row}
    return PositionSelection(alone, table, len(kinds))


def _seat_number(systems: Sequence[ShaftSystem], name: str) -> int:
    """Return the number of the seat of a position; raises ValueError for others."""
    own, names = "select_positions", [seat.name for seat in systems[0].seats]
    one_of(own, "requirements", name, names)
    first, *others = (system.seats[names.index(name)].installed for system in systems)
    must_be(own, name, "on springs", first is not None, "a bearing")
    same = all(bool(eqx.tree_equal(first, one)) for one in others)
    must_be(own, name, "another bearing in each case", same, "the same")
    return names.index(name)


def _shaft_diameter(system: ShaftSystem, k: int) -> float:
    """Return the diameter of the shaft at a seat [m]; raises where there are two."""
    seat, (index, station) = system.seats[k], system.station(system.seats[k])
    beside = np.asarray(system.beam(index).outer_diameter)
    sizes = {round(float(d), 9) for d in beside[max(station - 1, 0) : station + 1]}
    words = f"given: the shaft has {' and '.join(map(str, sizes))} m at {seat.name}"
    must_be("select_positions", "bore", None, len(sizes) == 1, words)
    return sizes.pop()


def _with_bearings(system: ShaftSystem, new: Mapping[int, Installed]) -> ShaftSystem:
    """Return a system with other bearings, given by the number of their seat."""
    seats = [
        with_fields(seat, installed=new.get(k, seat.installed))
        for k, seat in enumerate(system.seats)
    ]
    names = "drive wheels couplings loads housing gravity".split()
    return ShaftSystem(system.shafts, seats, *(getattr(system, name) for name in names))


def _solve_cases(systems: Sequence[ShaftSystem], lives: Sequence[Any]) -> DutyResult:
    """Solve all cases `FEW` at a time, by the programs of the kinds of bearings: one of
    many cases would be compiled for each combination."""
    parts = [
        solve_duty(systems[at : at + FEW], lives[at : at + FEW])
        for at in range(0, len(systems), FEW)
    ]
    return jax.tree.map(lambda *each: np.concatenate(each), *parts)


def _in_its_axes(systems: Sequence[ShaftSystem], found: DutyResult, k: int) -> Any:
    """Return force (case, 3) [N] and tilt (case, 2) [rad] of the inner ring of a seat,
    in the axes of its bearing."""
    seat = systems[0].seats[k]
    frames = np.stack([np.asarray(one.shaft(seat.shaft).frame) for one in systems])
    both = np.stack([found.load[:, k, :3], found.displacement[:, k, 3:]], axis=1)
    force, tilt = np.moveaxis(np.einsum("cij,cnj->cni", frames, both), 1, 0)
    some = np.abs(force) > _NO_LOAD * np.abs(force).max(axis=1, keepdims=True)
    sense = TURNED if seat.turned else np.ones(5)
    return np.where(some, force * sense[:3], 0.0), tilt[:, :2] * sense[3:]


def _loads(systems: Any, found: DutyResult, k: int, head: str = "") -> dict[str, float]:
    """Return the largest radial and axial force of all cases, by column name [N]."""
    x, y, z = _in_its_axes(systems, found, k)[0].T
    radial, axial = float(np.hypot(x, y).max()), float(z[np.argmax(np.abs(z))])
    return {f"{head}radial_force": radial, f"{head}axial_force": axial}


def _requirements(systems, life, found, k, hours, given) -> Requirements:
    """Return the requirements on the bearing of a seat, under the solved loads."""
    force, tilt = _in_its_axes(systems, found, k)
    load = np.pad(force, ((0, 0), (0, 3)))
    seat, speed = systems[0].seats[k], None
    if systems[0].inertia is not None:
        turns = found.speed[:, systems[0].station(seat)[0]]
        speed = -turns if seat.turned else turns
    held = {"gx": tilt[:, 0], "gy": tilt[:, 1]}
    cases = Cases(load, prescribed=held, hours=hours, inner_speed=speed)
    return Requirements(cases, life, **given)


def _judge_position(asked, systems, duty, k: int, alone) -> dict[str, Any]:
    """Return the row of a bearing of a combination, judged in the whole system."""
    row = {**alone, "radial_force": np.nan, "axial_force": np.nan}
    if duty is None:
        miss = Miss("solved", why="a preload is more than its bearing can bear")
        return {**row, **miss._asdict()}
    row |= _loads(systems, duty, k)
    least = np.full(len(systems), alone["minimum_load"])
    load = least * (1.0 - duty.warned[k].get("light_load", 0.0))
    found: dict[str, Any] = {name: of[:, k] for name, of in duty.lives.items()}
    found |= dict(result=duty.result, peak_pressure=duty.peak_pressure[:, k])
    found |= dict(equivalent_load=load, reference_load=load, minimum_load=least)
    miss = judge_bearing(asked, found, row)
    return {**row, **(miss or Miss(share=2.0))._asdict()}

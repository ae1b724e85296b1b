"""Selection of a bearing: requirements compared with the whole catalogue.

Printed data exclude bearings first. The remaining ones are solved by one program for
each type of bearing, `_LANES` solves at a time, whatever the number of bearings and
cases; a program is compiled once, and may be kept from one process to the next.
"""

import contextlib
import dataclasses
import functools
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..cases.cases import Cases
from ..cases.spectrum import relative_speed, spectrum_life
from ..cases.sweep import Keep, structure_of
from ..cases.sweep_program import Task
from ..catalogue.entry import (
    CLEARANCE,
    CatalogueEntry,
    bearing_of_entry,
    catalogue_entries,
    class_clearance,
)
from ..design.bearing_set import bearings_of, with_bearings
from ..design.checks import check, must_be, of_class, one_of
from ..design.places import PLACES, places_for, with_places
from ..element import FREEDOMS, BearingElement
from ..element.frame import LOADS, RINGS
from ..fits.fit_limits import CLEARANCE_CLASSES
from ..friction.friction import friction_torque
from ..life import LifeConditions
from ..life.life_warning import minimum_load
from ..life.rating import ratings
from ..numerics.compiled.programs import program
from ..numerics.labels import LabelledArray, make_dataset
from ..numerics.result import Result
from ..numerics.shown import Printable, Shown
from ..numerics.types import with_fields
from ..numerics.units import shown_number
from ..optimise.system import solved_case
from ..statics import Installed, SolveOptions, Support
from ..statics.empty_places import points_of_kind
from ..statics.support import axial_senses, check_held, restrained_freedoms

_LANES = 64
"""Number of solves in a batch."""

_LIVES = (
    "damage",
    "basic_rating_life",
    "static_safety",
    "equivalent_load",
    "reference_load",
)
"""Results of the life of each case that are used."""

_STEEL = 7850.0
"""Density in estimated masses [kg/m³]."""

SIZES = ("bore", "outside_diameter", "width")
NUMBERS = {
    "bore": ("m", "exact", "bore diameter d"),
    "outside_diameter": ("m", "most", "outside diameter D"),
    "width": ("m", "most", "width B; T of tapered roller, H of thrust bearings"),
    "mass": ("kg", "most", "printed mass, else an estimate from the envelope"),
    "limiting_speed": ("1", "most", "highest speed over the printed limiting speed"),
    "reference_speed": ("1", "most", "highest speed over the printed reference speed"),
    "life_hours": ("h", "least", "modified rating life; without oil a1 times L10r"),
    "rating_life": ("rev", "least", "that rating life in revolutions"),
    "basic_rating_life": ("rev", "least", "basic rating life L10 of ISO 281"),
    "static_safety": ("1", "least", "smallest C0/P0 of all cases (ISO 76)"),
    "minimum_load": ("N", "most", "minimum load, 0.01 C of balls, 0.02 C of rollers"),
    "load_ratio": ("1", "least", "smallest load of turning cases over minimum_load"),
    "peak_pressure": ("Pa", "most", "largest pressure of all contacts and cases"),
    "friction_torque": ("N m", "most", "torque by Palmgren, averaged over the hours"),
}
for _name, _unit in zip(FREEDOMS, ("N/m",) * 3 + ("N m/rad",) * 2, strict=False):
    _about = f"smallest stiffness of all cases along {_name}, other freedoms held"
    NUMBERS[f"stiffness_{_name}"] = (_unit, "least", _about)
"""Numbers of a candidate: SI unit; sense of a bound given as one number, which also
says which end ranks first; meaning. Those before the lives need no solve."""


def _as_cases(given: Any) -> Cases:
    cases = given if isinstance(given, Cases) else Cases([given])
    return jax.tree.map(np.asarray, cases)


def _as_bounds(given: Any) -> Any:
    """Pairs (least, greatest) of numbers alone, each in the sense of its name."""
    pairs = {}
    for name, ends in dict(given).items():
        if not isinstance(ends, list | tuple):
            sense = NUMBERS.get(name, ("", "exact"))[1]
            ends = None if sense == "most" else ends, None if sense == "least" else ends
        pairs[name] = tuple(None if end is None else float(end) for end in ends)
    return pairs


def _as_words(given: Any) -> Any:
    return (given,) if isinstance(given, str) else given and tuple(given)


class Requirements(Printable):
    """Requirements on a bearing, for `select`.

    Attributes:
        load: `Cases`, whose damage adds up over their `hours`; or one load on the
            moving ring, at rest (6,) [N, N m].
        life: Conditions of the rating life, with the required life, without ratings.
        bounds: Bounds by name of a number [SI]: a pair (least, greatest), either of
            which may be `None`; or one number, which is the exact bore, the greatest
            outside_diameter, width, mass, limiting_speed and reference_speed (shares of
            the printed ones), minimum_load, peak_pressure and friction_torque, and the
            least life_hours, rating_life, basic_rating_life, static_safety, load_ratio
            and stiffness_ux to stiffness_gy.
        types: Types that may be chosen; `None`: all.
        clearance_class: Class of radial clearance, such as "C3", which excludes types
            without classes; `None`: CN, and those types too.
        rank_by: Names of numbers by which to rank, the later ones to break ties; the
            smallest first, of numbers with a least bound the greatest.
        support: Support of the rings, as in `sweep`.
        options: Numerics of the load solves.
        supply: Oil supply, as `friction_torque` takes it.

    Raises:
        TypeError: If a part is of another class, or a number is traced.
        ValueError: For bounds that are not allowed or contradict each other, a required
            life or an oil if nothing turns, and no load at all.
    """

    load: Cases = eqx.field(converter=_as_cases)
    life: LifeConditions = eqx.field(default_factory=LifeConditions)
    bounds: dict[str, tuple[float | None, float | None]] = eqx.field(
        converter=_as_bounds, default=()
    )
    types: tuple[str, ...] | None = eqx.field(converter=_as_words, default=None)
    clearance_class: str | None = None
    rank_by: tuple[str, ...] = eqx.field(converter=_as_words, default=SIZES[1:])
    support: Support = Support()
    options: SolveOptions = eqx.field(default_factory=SolveOptions)
    supply: str = "oil_bath"

    def __check_init__(self):
        of_class(self, "life", self.life, LifeConditions, "`LifeConditions`")
        if self.clearance_class is not None:
            one_of(self, "clearance_class", self.clearance_class, CLEARANCE_CLASSES)
        for what in ("bounds", "rank_by"):
            for name in getattr(self, what):
                one_of(self, what, name, NUMBERS)
        for what, names in {"types": self.types, "rank_by": self.rank_by}.items():
            must_be(self, what, names, names not in ((), []), "one name at least")
        for name, ends in self.bounds.items():
            known = [end for end in ends if end is not None]
            ordered = bool(known) and 0 < known[0] <= known[-1] < np.inf
            words = "finite and above 0, the least before the greatest"
            check(self, name, ordered, words, ends, unit_of_number(name))
            once = ends == self.all_bounds[name]
            must_be(self, name, "given", once, "left out beside that which `life` has")
        cases, life, turning = self.load, self.life, bool(self.turns.any())
        held = bool(cases.prescribed) or cases.fixed_displacement is not None
        loads = np.isfinite(cases.load).all() and (held or np.any(cases.load))
        largest, words = np.abs(cases.load).max(), "finite, and not zero in all cases"
        check(self, "load", loads, words, largest, "N")
        alone = cases.design is None
        must_be(self, "load", "of several designs", alone, "cases without `design`")
        cases.check_oil("Requirements")
        check_held("Requirements", cases.load, self.support, cases.prescribed)
        never = "dynamic_capacity", "static_capacity", "fatigue_load_limit"
        for name in (*never, *(() if turning else ("required", "viscosity"))):
            why = "each bearing has its own" if name in never else "no ring has a speed"
            none = getattr(life, name) is None
            must_be(self, "life", f"with {name}", none, f"without it, as {why}")
        oiled = life.viscosity is not None
        for name, ok in {"life_hours": turning, "friction_torque": oiled}.items():
            ok = ok or name not in (*self.bounds, *self.rank_by)
            must_be(self, name, "given", ok, "left out without speed and oil")

    @property
    def turns(self) -> np.ndarray:
        """Relative speed of the rings (case,) [rad/s]."""
        return relative_speed(self.load)

    @property
    def all_bounds(self) -> dict[str, Any]:
        """The bounds with the required life among them [SI]."""
        lives = {"life_hours": self.life.required}
        lives["rating_life"] = self.life.required_revolutions
        given = {name: (low, None) for name, low in lives.items() if low is not None}
        return self.bounds | _as_bounds(given)


def unit_of_number(name: str) -> str:
    """Return the SI unit of a column of a `Selection` or `PositionSelection`; empty for
    a pure number."""
    return (
        "N" if name.endswith("_force") else NUMBERS.get(name, ("",))[0].replace("1", "")
    )


class Miss(NamedTuple):
    """A requirement that a bearing fails: its name, value (NaN if unknown) and limit
    [SI], a reason in words, and the ratio of value and limit, below 1 [1]."""

    requirement: str = ""
    value: float = np.nan
    limit: float = np.nan
    why: str = ""
    share: float = 0.0

    @property
    def words(self) -> str:
        """The miss in words, as "life_hours 8200 h of 20000 h"; empty without one."""
        unit = unit_of_number(self.requirement)
        ends = [shown_number(end, unit, 5) for end in (self.value, self.limit)]
        words = f"{self.requirement} {self.why or ' of '.join(ends)}"
        return words if self.requirement else ""


def _missed(name: str, value: Any, ends: tuple[Any, Any]) -> Iterator[Miss]:
    """Yield the bound that a value fails by more than round-off."""
    value, (low, high), near = float(value), ends, 1.0 - 1e-9
    if np.isnan(value):
        yield Miss(name, limit=low or high, why="it is not known")
    elif low is not None and value < near * low:
        yield Miss(name, value, low, share=value / low)
    elif high is not None and near * value > high:
        yield Miss(name, value, high, share=high / value)


def _missed_directions(asked: Requirements, bearing: Any) -> Iterator[Miss]:
    """Yield the loads that bearings of this type and arrangement do not carry."""
    may, senses = restrained_freedoms(bearing), axial_senses(bearing)
    sign = 1 if asked.support.moving_ring == "inner" else -1
    for freedom, name, loads in zip(FREEDOMS, LOADS, asked.load.load.T, strict=True):
        for load in (float(loads.max()), float(loads.min())):
            if load and freedom not in may:
                yield Miss(name, load, 0.0, f"it carries no {name}")
            elif load and freedom == "uz" and sign * np.sign(load) not in senses:
                side = "below" if load > 0 else "above"
                yield Miss(name, load, 0.0, f"it carries {name} {side} 0 alone")
    angle = float(bearings_of(bearing)[0].nominal_contact_angle)
    moves = {*asked.support.freedoms(bearing)} - {*asked.load.prescribed}
    if len(senses) == 1 and angle > 0 and "uz" in moves:
        across, along = np.abs(asked.load.load[:, :2]).max(1), asked.load.load[:, 2]
        if np.any((across > 0) & (along == 0)):
            yield Miss("Fz", 0.0, 0.0, "it carries no radial load without Fz")


@dataclasses.dataclass(frozen=True)
class Selection(Shown):
    """All bearings that were compared: first those that fit, the best first; then those
    that were solved and fail, the nearest first; then those excluded by printed data.

    Attributes:
        requirements: The requirements.
        table: Columns by name (candidate,) [SI]: designation, type, and the numbers
            that `Requirements` may bound, NaN where not known (friction and stiffness
            where neither a bound nor `rank_by` names them); mass_printed; and of the
            requirement that fails by most its name ("": it fits), value, limit, why.
    """

    requirements: Requirements
    table: dict[str, np.ndarray]

    def _rows(self, names: Iterable[str], fitting: bool) -> list[dict[str, Any]]:
        places = np.flatnonzero((self.table["requirement"] == "") == fitting)
        return [{k: self.table[k][place].item() for k in names} for place in places]

    @property
    def fits(self) -> list[dict[str, Any]]:
        """Bearings that fulfil all requirements, with their numbers, the best first."""
        return self._rows([k for k in self.table if k not in Miss._fields], True)

    @property
    def excluded(self) -> list[dict[str, Any]]:
        """The other bearings, and why: requirement, value, limit [SI], reason."""
        return self._rows(["designation", *Miss._fields[:4]], False)

    @property
    def counts(self) -> dict[str, int]:
        """Number of bearings that each requirement excludes, the most first."""
        names = self.table["requirement"].tolist()
        return dict(Counter(name for name in names if name).most_common())

    @property
    def smallest(self) -> str | None:
        """Designation of the smallest bearing that fits: by outside diameter, then
        width."""
        fits = self.fits
        found = min(fits, key=lambda row: [row[k] for k in SIZES[1:]], default=None)
        return None if found is None else found["designation"]

    def nearest_misses(self, most: int = 5) -> list[str]:
        """Return the nearest misses in words: "6208: life_hours 8200 h of 20000 h".

        Args:
            most: Largest number of misses.
        """
        rows = [row.values() for row in self.excluded[:most]]
        found = [(name, Miss(*miss).words) for name, *miss in rows]
        return [f"{name}: {words}" for name, words in found]

    def shown_facts(self) -> Iterator[Any]:
        """Yield how many fit, the smallest of them, and what excludes the others."""
        yield 1, "fits", str(len(self.fits)), "bearings that fulfil all requirements"
        yield 1, "smallest", str(self.smallest), "by outside diameter, then width"
        for name, count in self.counts.items():
            yield 1, f"excluded by {name}", str(count), ""

    def to_xarray(self) -> Any:
        """Return all candidates as an `xarray.Dataset`, with units.

        Raises:
            ImportError: Without xarray.
        """
        make, along = LabelledArray, ("candidate",)
        pairs = self.table.items()
        return make_dataset({k: make(v, along, unit_of_number(k)) for k, v in pairs})

    def to_pandas(self) -> Any:
        """Return all candidates as a `pandas.DataFrame`; raises as `to_xarray`."""
        return self.to_xarray().to_dataframe()


def select(
    requirements: Requirements,
    *,
    entries: Iterable[CatalogueEntry] | None = None,
    install: Callable[[CatalogueEntry], Installed] | None = None,
    progress: Callable[[str, float], Any] | None = None,
) -> Selection:
    """Select bearings from the catalogue: those that fit, and why the others do not.

    Printed data exclude bearings first: type, envelope, direction of the load, speeds.
    The others are solved under every case. Of several requirements that a bearing
    fails, the one is reported that it fails by the largest ratio.

    Args:
        requirements: Requirements on the bearing.
        entries: Bearings to choose from; `None`: `catalogue_entries()`.
        install: Function from an entry to the bearing on its seats; an entry for which
            it raises `ValueError` is excluded, with that text. `None`: as drawn.
        progress: Function called with a text and the share done.

    Returns:
        Selection. Unsolved bearings are excluded by "solved", with the failure's name.

    Raises:
        TypeError: If `requirements` is not a `Requirements`.
        ValueError: If there are no entries, none of a type, or all are refused.
    """
    of_class("select", "requirements", requirements, Requirements, "`Requirements`")
    every = list(catalogue_entries() if entries is None else entries)
    if not every:
        raise ValueError("select: `entries` is empty; one bearing at least.")
    asked, progress = requirements, progress or (lambda words, share: None)
    for name in asked.types or ():
        one_of("select", "types", name, sorted({entry.type for entry in every}))
    known = {id(entry): place for place, entry in enumerate(catalogue_entries())}

    def build(entry: CatalogueEntry) -> Installed:
        if install is None and id(entry) in known:
            real = jax.dtypes.canonicalize_dtype(float)
            return _catalogue_bearing(known[id(entry)], real)
        return _with_common_places((install or bearing_as_drawn)(entry), entry.type)

    rows, made, refused = [_printed_row(asked, entry) for entry in every], {}, []
    misses = [*_printed_misses(asked, every, rows)]
    for k, entry in enumerate(every):
        if misses[k] is None:
            try:
                made[k] = build(entry)
            except ValueError as error:
                misses[k] = Miss("bearing", why=str(error))
                refused.append(error)
    if refused and not made:
        raise refused[0]
    found = _solve(asked, [*made.values()], progress)
    for number, k in enumerate(made):
        mine = {name: values[number] for name, values in found.items()}
        misses[k] = judge_bearing(asked, mine, rows[k])
    for row, entry, miss in zip(rows, every, misses, strict=True):
        row |= {"designation": entry.designation, **(miss or Miss(share=2.0))._asdict()}
    names = "designation", "type", *NUMBERS, "mass_printed", *Miss._fields
    table = {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}
    ranks = [
        -table[name] if NUMBERS[name][1] == "least" else table[name]
        for name in (*asked.rank_by, *SIZES[1:], "mass")
    ]  # NaN comes last
    solved = np.isnan(table["rating_life"])
    order = np.lexsort(np.stack([*ranks[::-1], -table.pop("share"), solved]))
    return Selection(asked, {name: values[order] for name, values in table.items()})


def _printed_row(asked: Requirements, entry: CatalogueEntry) -> dict[str, Any]:
    """Return the printed numbers of a bearing. A mass that is not printed is that of a
    solid ring of the envelope times the median share of the type, or of all types."""
    mass, usual = entry.mass, _usual_masses()
    if mass is None:
        mass = usual.get(entry.type, usual[""]) * _solid_mass(entry)
    row: dict[str, Any] = {"type": entry.type, "mass": mass}
    row |= {name: getattr(entry, name) for name in SIZES}
    for name in ("limiting_speed", "reference_speed"):
        row[name] = asked.turns.max() / (getattr(entry, name) or np.nan)
    return row | {"mass_printed": entry.mass is not None}


def _solid_mass(entry: CatalogueEntry) -> float:
    """Return the mass of a solid ring of the envelope [kg]."""
    across = entry.outside_diameter**2 - entry.bore**2
    return _STEEL * 0.25 * np.pi * across * entry.width


@functools.cache
def _usual_masses() -> dict[str, float]:
    """Return the median of printed masses over those of solid rings, by type and of all
    types ("") [1]."""
    shares: dict[str, list[float]] = {}
    for entry in catalogue_entries():
        if entry.mass is not None:
            for name in (entry.type, ""):
                shares.setdefault(name, []).append(entry.mass / _solid_mass(entry))
    return {name: float(np.median(values)) for name, values in shares.items()}


def _printed_misses(
    asked: Requirements, every: list[CatalogueEntry], rows: list[dict[str, Any]]
) -> Iterator[Miss | None]:
    """Yield what each entry fails by its printed data; entries that pass are replaced
    in `every` by those of the clearance class."""
    directions: dict[Any, Miss | None] = {}
    facts = {n: asked.bounds[n] for n in (*NUMBERS,)[:6] if n in asked.bounds}
    for k, entry in enumerate(every):
        found = [m for n, x in facts.items() for m in _missed(n, rows[k][n], x)]
        if asked.types and entry.type not in asked.types:
            found = [Miss("types", why=f"{entry.type} is not among them")]
        if not found and asked.clearance_class not in (None, entry.clearance_class):
            try:
                every[k] = _with_class(entry, asked.clearance_class)
            except ValueError as error:
                found = [Miss("clearance_class", why=str(error))]
        kind = entry.type, entry.design.get("arrangement"), "ribs" in entry.design
        if not found and kind not in directions:
            missed = _missed_directions(asked, bearing_of_entry(entry))
            directions[kind] = next(missed, None)
        yield found[0] if found else directions[kind]


def _with_class(entry: CatalogueEntry, name: str) -> CatalogueEntry:
    """Return an entry with another clearance class."""
    if entry.class_limits is None:
        raise ValueError(f"{entry.designation} has no classes")
    middle, _ = class_clearance(entry.type, name, entry.bore, entry.taper)
    changed: dict[str, Any] = {"design": {**entry.design, CLEARANCE: middle}}
    changed["designation"] = f"{entry.designation}/{name}"
    return dataclasses.replace(entry, **changed)


def _with_common_places(design: Installed, kind: str) -> Installed:
    """Return a bearing with the number of places of its type, and without what some
    entries lack and no number here needs: speeds, limits, shoulders of the grooves."""
    element, rows = design.drawing, []
    for row in bearings_of(element.bearing):
        names = ("outer_shoulder", "inner_shoulder", "rated_contact_angle")
        bare: dict[str, Any] = {name: None for name in names if hasattr(row, name)}
        if names[2] in bare:
            bare[names[2]] = row.nominal_contact_angle
        rows.append(with_fields(row, **bare))
    # Compiling further programs would take longer than solving empty places.
    row = rows[0]
    stated = getattr(row, f"n_{row.noun}s") // row.n_places
    most = max(_most_elements().get(kind, 0) // stated, *(r.n_places for r in rows))
    places = max(PLACES[1], places_for(most))
    bearing = with_places(with_bearings(element.bearing, rows), places)
    none = dict.fromkeys(("limits", "limiting_speed", "reference_speed"))
    return with_fields(design, drawing=with_fields(element, bearing=bearing), **none)


@functools.cache
def _most_elements() -> dict[str, int]:
    """Return the largest number of rolling elements of each type of the catalogue."""
    found: dict[str, int] = {}
    for entry in catalogue_entries():
        count = entry.design.get("n_balls") or entry.design["n_rollers"]
        found[entry.type] = max(count, found.get(entry.type, 0))
    return found


@functools.cache
def _catalogue_bearing(place: int, real: Any) -> Installed:
    """Return a bearing of the catalogue as drawn, kept by place and type of numbers."""
    entry = catalogue_entries()[place]
    return _with_common_places(bearing_as_drawn(entry), entry.type)


def bearing_as_drawn(entry: CatalogueEntry) -> Installed:
    """Return the bearing of a catalogue entry as drawn, without seats."""
    return Installed(BearingElement(bearing_of_entry(entry)))


def _solve(asked: Requirements, made: list[Installed], progress: Any) -> dict[str, Any]:
    """Return numbers of bearings under all cases by name (bearing, case, …)."""
    kinds: dict[Any, list[int]] = {}
    for number, design in enumerate(made):
        kinds.setdefault(structure_of(design), []).append(number)
    named, life = {*asked.bounds, *asked.rank_by}, asked.life.without_requirement
    stiff = any(name.startswith("stiffness") for name in named)
    kept = Keep(("peak_pressure", "stiffness") if stiff else ("peak_pressure",))
    supply = asked.supply if "friction_torque" in named else None
    found, count, done = {}, asked.load.count, 0
    for numbers in kinds.values():
        stack = jax.tree.map(lambda *a: np.stack(a), *(made[k] for k in numbers))
        points = points_of_kind(stack.drawing, asked.options.points)
        options = with_fields(asked.options, points=points)
        task = Task(asked.support, options, kept, False, _LIVES, life)
        pairs = np.arange(len(numbers) * count)
        for begin in range(0, pairs.size, _LANES):
            share = (done + begin) / (len(made) * count)
            progress("bearings under their loads", share)
            mine = pairs[begin : begin + _LANES]
            design, case = np.divmod(np.resize(mine, _LANES), count)
            cases = jax.tree.map(lambda a: a[case], with_fields(asked.load, hours=None))  # noqa: B023
            # Lanes without a case get a load of NaN, with which a solve ends at once.
            spare = np.arange(_LANES)[:, None] >= mine.size
            cases = with_fields(cases, load=np.where(spare, np.nan, cases.load))
            designs = jax.tree.map(lambda a: a[design], stack)  # noqa: B023
            places = np.array(numbers)[design[: mine.size]], case[: mine.size]
            for name, values in _solve_kind(designs, cases, task, supply).items():
                room = np.empty((len(made), count, *values.shape[1:]), values.dtype)
                found.setdefault(name, room)[places] = values[: mine.size]
        done += pairs.size
    return found


@program(quick=True, level=1, what="bearings of a kind under their loads")
def _solve_kind(designs, cases, task, supply):
    """Return numbers of bearings, each under a case, by name (lane, …)."""

    def solve_one(design, case):
        solution = solved_case(design, case, task.support, task.options)
        found, bearing = task.outputs(solution, case), solution.element.bearing
        found["minimum_load"] = minimum_load(bearing, ratings(bearing))
        if supply is not None:
            found["friction_torque"] = jnp.nan * found["damage"]
            with contextlib.suppress(ValueError):  # of types without constants
                torque = friction_torque(solution, task.life.viscosity, supply).torque
                found["friction_torque"] = torque
        return found

    return jax.vmap(solve_one)(designs, cases)


def judge_bearing(
    asked: Requirements, found: dict[str, Any], row: dict[str, Any]
) -> Miss | None:
    """Add the numbers of a bearing to its row, from its results by name (case, …) [SI];
    return the requirement that it fails by most, or `None`."""
    failed = np.flatnonzero(found["result"] != Result.CONVERGED)
    if failed.size:
        label = Result(int(found["result"][failed[0]])).label
        return Miss("solved", why=f"{label} (case {failed[0]})")
    cases, turning = asked.load, asked.turns > 0
    used = spectrum_life(cases, found["damage"])
    basic = spectrum_life(cases, 1.0 / found["basic_rating_life"])
    loads = np.maximum(found["equivalent_load"], found["reference_load"])
    ratios = (loads / found["minimum_load"])[turning]
    numbers = {name: found[name] for name in NUMBERS if name in found} | {
        "life_hours": np.nan if used.life_hours is None else used.life_hours,
        "rating_life": used.rating_life,
        "basic_rating_life": basic.rating_life,
        "load_ratio": ratios if ratios.size else np.inf,
    }
    if "stiffness" in found:
        first = 6 * RINGS.index(asked.support.moving_ring)
        own = np.diagonal(found["stiffness"], axis1=1, axis2=2).T[first:]
        numbers |= dict(zip((*NUMBERS,)[-5:], own, strict=False))
    if "friction_torque" in found:
        torque = np.average(found["friction_torque"], weights=cases.hours)
        numbers["friction_torque"] = torque
    misses = []
    for name, values in numbers.items():
        ends = np.min(values), np.max(values)
        row[name] = ends[NUMBERS[name][1] == "most"]
        low, high = asked.all_bounds.get(name, (None, None))
        if low is not None:
            misses += _missed(name, ends[0], (low, None))
        if high is not None:
            misses += _missed(name, ends[1], (None, high))
    return min(misses, key=lambda miss: miss.share, default=None)

"""The [deviations] table of a scene: form errors of raceways and rolling elements."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..design.form_error import (
    AbstractShape,
    FormErrors,
    Harmonics,
    RacewayErrors,
    Spall,
)
from .cases_list import read_list
from .table import Table, written

RACEWAYS = {"outer raceway": "outer", "inner raceway": "inner"}
ELEMENTS = "elements"
DIRECTIONS = ("outwards", "axial", "raised")
MOST_ORDER = {"raceway": 900, "element": 110}
"""Highest orders of waves: tables of 4096 angles around a raceway, and of 512 around a
rolling element, err by 1 % of their amplitude there."""


COMMON = ("waves", "spalls")
"""Kinds of errors that all bearings of a line have, not the one of the scene alone."""


def read_deviations(
    table: Table, counts: tuple[int, ...], folder: Path
) -> tuple[tuple[FormErrors, ...], tuple[FormErrors, ...]]:
    """Form errors of every row of a bearing, and those that all of its line have.

    Args:
        table: `[deviations]`.
        counts: Rolling elements of each row.
        folder: Of the scene, in which files of profiles stand.

    Raises:
        SceneError: For what is missing, unknown or not allowed.
    """
    readers = {
        "waves": _waves,
        "spectrum": _spectrum,
        "profile": _profile,
        "spalls": _spall,
    }
    found = [_Gathered(count) for count in counts]
    common = [_Gathered(count) for count in counts]
    for kind, reader in readers.items():
        for one in table.tables(kind) if kind in table else ():
            for k, row in enumerate(_rows(one, kind, found)):
                row.add(one, kind, reader, folder, k)
            for k, row in enumerate(_rows(one, kind, common)):
                if kind in COMMON:
                    row.add(one, kind, reader, folder, k)
    both = [tuple(row.errors() for row in rows) for rows in (found, common)]
    return both[0], both[1]


class _Gathered:
    """Shapes of one row as they are read."""

    def __init__(self, count: int):
        self.count = count
        self.elements: list[AbstractShape] = []
        self.rings: dict[str, dict[str, list]] = {
            ring: {name: [] for name in DIRECTIONS} for ring in RACEWAYS.values()
        }

    def add(self, one: Table, kind: str, reader: Any, folder: Path, row: int):
        """Take up one table; `row`: how many rows had it before."""
        part = one.choice("part", (*RACEWAYS, ELEMENTS))
        given = _Given(folder, row)
        if part == ELEMENTS:
            which = _which(one, self.count)
            _no_direction(one, "is of raceways; an element has a height alone")
            self.elements.append(reader(one, self.count, which, given))
            return
        if "element" in one:
            raise one.error("element", f"goes with `part` = {ELEMENTS}")
        direction = "raised"
        if kind == "spalls":
            _no_direction(one, "is not of spalls, which lower the surface")
        else:
            direction = one.choice("direction", DIRECTIONS, "outwards")
        self.rings[RACEWAYS[part]][direction].append(reader(one, None, None, given))

    def errors(self) -> FormErrors:
        """All of them."""
        made = {ring: RacewayErrors(**all_) for ring, all_ in self.rings.items()}
        return FormErrors(made["outer"], made["inner"], self.elements)


class _Given(NamedTuple):
    """What a reader needs to know beside its table.

    Attributes:
        folder: Of the scene.
        row: How many rows had the same table before.
    """

    folder: Path
    row: int


def _rows(table: Table, kind: str, found: list[_Gathered]) -> list[_Gathered]:
    """The rows that are meant: one by its number, or all; of a spall one."""
    which = table.integer("row", None, least=0)
    if which is None:
        if kind == "spalls" and len(found) > 1:
            raise table.error("row", "is missing; number of the row with the spall")
        return found
    if len(found) == 1:
        raise table.error("row", "is of sets; the bearing has one row")
    if which >= len(found):
        allowed = f"the rows are 0 to {len(found) - 1}"
        raise table.error("row", f"{which} is not there; {allowed}")
    return [found[which]]


def _which(table: Table, count: int) -> int | None:
    """Number of the element that is meant; `None`: all."""
    which = table.integer("element", None, least=0)
    if which is not None and which >= count:
        allowed = f"the elements are 0 to {count - 1}"
        raise table.error("element", f"{which} is not there; {allowed}")
    return which


def _no_direction(table: Table, why: str) -> None:
    if "direction" in table:
        raise table.error("direction", why)


def _each(values: Any, count: int | None, which: int | None) -> Any:
    """Values of a part; of every rolling element, those that are not meant have 0."""
    values = np.asarray(values, dtype=float)
    if count is None:
        return values
    chosen = np.ones(count) if which is None else np.arange(count) == which
    return chosen.reshape(-1, *[1] * values.ndim) * values


def _order(table: Table, key: str, value: Any, count: int | None) -> int:
    most = MOST_ORDER["raceway" if count is None else "element"]
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= most:
        raise table.error(key, f"{value!r} is not a whole number from 1 to {most}")
    return value


def _listed(table: Table, key: str, kind: str, orders: list, default: Any = None):
    """One quantity for all orders, or a list with one for each."""
    if not isinstance(table.raw(key, None), list):
        usual = () if default is None else (default,)
        return np.full(len(orders), table.quantity(key, kind, *usual))
    values = table.quantities(key, kind)
    if len(values) != len(orders):
        problem = f"has {len(values)} values for {len(orders)} orders"
        raise table.error(key, problem)
    return np.array(values)


def _waves(table: Table, count, which, given) -> Harmonics:
    named = table.raw("order")
    listed = named if isinstance(named, list) and named else [named]
    orders = [_order(table, "order", one, count) for one in listed]
    if len(set(orders)) < len(orders):
        raise table.error("order", f"{named!r} names an order twice")
    amplitude = _listed(table, "amplitude", "length", orders)
    if np.any(amplitude < 0.0):
        problem = "is negative; turn the `phase` by 180 deg in its place"
        raise table.error("amplitude", problem)
    phase = _listed(table, "phase", "angle", orders, 0.0)
    with table.building():
        sizes = _each(amplitude, count, which)
        return Harmonics(orders, sizes, np.broadcast_to(phase, sizes.shape))


def _spectrum(table: Table, count, which, given) -> Harmonics:
    low, high = (
        _order(table, key, table.raw(key), count) for key in ("lowest", "highest")
    )
    if high < low:
        raise table.error("highest", f"{high} is below `lowest`, {low}")
    amplitude = table.quantity("amplitude", "length")
    if amplitude < 0.0:
        raise table.error("amplitude", f"{amplitude:g} m is negative")
    slope = table.number("slope")
    # Rows draw on their own; the first as a single one.
    seed = table.integer("seed", 0, least=0)
    draws = np.random.default_rng([seed, given.row] if given.row else seed)
    shape = (high - low + 1,) if count is None else (count, high - low + 1)
    phase = draws.uniform(0.0, 2.0 * np.pi, shape)
    with table.building():
        sizes = _each(np.full(1, amplitude), count, which)
        return Harmonics.spectrum(low, high, sizes, slope, phase)


def _profile(table: Table, count, which, given) -> Harmonics:
    if ("points" in table) == ("file" in table):
        raise table.error("points", "give either heights here or a `file` of them")
    if "points" in table:
        heights = np.array(table.quantities("points", "length"))
    else:
        found = read_list(table, given.folder, {"height": "length"}, "heights")
        if list(found) != ["height"]:
            problem = 'must have one column, headed such as "height [um]"'
            raise table.error("file", problem)
        heights = found["height"]
        table.fill("file", None)  # in the echo its heights
        table.fill("points", [written(height, "m") for height in heights])
    most = MOST_ORDER["raceway" if count is None else "element"]
    shown = min(most, max(1, (len(heights) - 1) // 2))
    highest = _order(table, "highest", table.raw("highest", shown), count)
    with table.building():
        waves = Harmonics.measured(heights, highest)
        sizes = _each(waves.amplitude, count, which)
        return Harmonics(waves.order, sizes, np.broadcast_to(waves.phase, sizes.shape))


def _spall(table: Table, count, which, given) -> Spall:
    angle = table.quantity("angle", "angle", 0.0)
    length, depth = (table.quantity(key, "length") for key in ("length", "depth"))
    for key, value in (("length", length), ("depth", depth)):
        if not value > 0.0:
            raise table.error(key, f"{value:g} m is not allowed; above 0 m")
    if count is not None and which is None:
        raise table.error("element", "is missing; number of the element with the spall")
    every = np.zeros(() if count is None else (count,))
    with table.building():
        return Spall(every + angle, every + length, _each(depth, count, which))

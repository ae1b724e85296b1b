"""The [deviations] table of a scene: form errors of raceways and rolling elements."""

from pathlib import Path
from typing import Any

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


def read_deviations(table: Table, count: int, folder: Path) -> FormErrors:
    """Form errors of a row.

    Args:
        table: `[deviations]`.
        count: Number of rolling elements.
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
    rings: dict[str, dict[str, list]] = {
        ring: {name: [] for name in DIRECTIONS} for ring in RACEWAYS.values()
    }
    elements: list[AbstractShape] = []
    for kind, reader in readers.items():
        for one in table.tables(kind) if kind in table else ():
            part = one.choice("part", (*RACEWAYS, ELEMENTS))
            if part == ELEMENTS:
                which = _which(one, count)
                _no_direction(one, "is of raceways; an element has a height alone")
                elements.append(reader(one, count, which, folder))
                continue
            if "element" in one:
                raise one.error("element", f"goes with `part` = {ELEMENTS}")
            direction = "raised"
            if kind == "spalls":
                _no_direction(one, "is not of spalls, which lower the surface")
            else:
                direction = one.choice("direction", DIRECTIONS, "outwards")
            shape = reader(one, None, None, folder)
            rings[RACEWAYS[part]][direction].append(shape)
    made = {ring: RacewayErrors(**shapes) for ring, shapes in rings.items()}
    return FormErrors(made["outer"], made["inner"], elements)


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
        given = () if default is None else (default,)
        return np.full(len(orders), table.quantity(key, kind, *given))
    values = table.quantities(key, kind)
    if len(values) != len(orders):
        problem = f"has {len(values)} values for {len(orders)} orders"
        raise table.error(key, problem)
    return np.array(values)


def _waves(table: Table, count, which, folder) -> Harmonics:
    given = table.raw("order")
    listed = given if isinstance(given, list) and given else [given]
    orders = [_order(table, "order", one, count) for one in listed]
    if len(set(orders)) < len(orders):
        raise table.error("order", f"{given!r} names an order twice")
    amplitude = _listed(table, "amplitude", "length", orders)
    phase = _listed(table, "phase", "angle", orders, 0.0)
    with table.building():
        sizes = _each(amplitude, count, which)
        return Harmonics(orders, sizes, np.broadcast_to(phase, sizes.shape))


def _spectrum(table: Table, count, which, folder) -> Harmonics:
    low, high = (
        _order(table, key, table.raw(key), count) for key in ("lowest", "highest")
    )
    if high < low:
        raise table.error("highest", f"{high} is below `lowest`, {low}")
    amplitude = table.quantity("amplitude", "length")
    slope = table.number("slope")
    draws = np.random.default_rng(table.integer("seed", 0, least=0))
    shape = (high - low + 1,) if count is None else (count, high - low + 1)
    phase = draws.uniform(0.0, 2.0 * np.pi, shape)
    with table.building():
        sizes = _each(np.full(1, amplitude), count, which)
        return Harmonics.spectrum(low, high, sizes, slope, phase)


def _profile(table: Table, count, which, folder) -> Harmonics:
    if ("points" in table) == ("file" in table):
        raise table.error("points", "give either heights here or a `file` of them")
    if "points" in table:
        heights = np.array(table.quantities("points", "length"))
    else:
        found = read_list(table, folder, {"height": "length"}, "heights")
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


def _spall(table: Table, count, which, folder) -> Spall:
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

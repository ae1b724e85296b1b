"""The [deviations] table of a scene: form errors of raceways and rolling elements."""

from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...design.form_error import (
    AbstractShape,
    FormErrors,
    Harmonics,
    RacewayErrors,
    Spall,
)
from ...files.column_list import read_list
from ...files.schema import Keys, key_of, read_keys, scene_key
from ...files.table import Table, format_number

RACEWAYS = {"outer raceway": "outer", "inner raceway": "inner"}
ELEMENTS = "elements"
DIRECTIONS = ("outwards", "axial", "raised")
MOST_ORDER = {"raceway": 900, "element": 110}
"""Highest wave orders, at which the tables of 4096 angles around a raceway and of 512
around a rolling element are in error by 1 % of the amplitude."""


class ErrorContext(NamedTuple):
    """Context of a form error, in addition to its table.

    Attributes:
        n_elements: Number of rolling elements of the row; `None` for a raceway error.
        folder: Folder of the scene.
        row: Number of previous rows with the same table.
    """

    n_elements: int | None
    folder: Path
    row: int


class DeviationKeys(Keys):
    about = "A form error of a part of every row, or of one"

    common: ClassVar[bool] = False
    """Whether it is common to all bearings of a production line."""

    part: str = scene_key("part that has it", choices=(*RACEWAYS, ELEMENTS))
    row: int | None = scene_key(
        "row of a set, from 0, in whose axes it stands", least=0, otherwise="every row"
    )
    element: int | None = scene_key(
        "its number, from 0", least=0, only={"part": (ELEMENTS,)}, otherwise="every one"
    )

    @property
    def along(self) -> str:
        """Direction in which the form error of a raceway is measured."""
        return "raised"

    @property
    def highest_order(self) -> int:
        """Highest wave order of the part."""
        return MOST_ORDER["element" if self.part == ELEMENTS else "raceway"]

    def shape(self, context: ErrorContext) -> AbstractShape:
        """Build the form error."""
        raise NotImplementedError

    def _of_elements(self, values: Any, context: ErrorContext) -> Any:
        """Spread values over the rolling elements, 0 for those without the error."""
        values = np.asarray(values, dtype=float)
        if context.n_elements is None:
            return values
        which = np.arange(context.n_elements)
        chosen = (
            np.ones(context.n_elements)
            if self.element is None
            else which == self.element
        )
        return chosen.reshape(-1, *[1] * values.ndim) * values

    def _check_order(self, name: str, order: Any) -> None:
        """Raise SceneError for a wave order outside the range of the part."""
        whole = isinstance(order, int) and not isinstance(order, bool)
        if not whole or not 1 <= order <= self.highest_order:
            problem = f"{order!r} is not a whole number from 1 to {self.highest_order}"
            raise self.table.error(name, problem)


class DirectedKeys(DeviationKeys):
    about = "A form error that a raceway may have in several directions"

    direction: str | None = scene_key(
        "of a raceway's waves; `raised`: along the contact normal",
        choices=DIRECTIONS,
        otherwise=DIRECTIONS[0],
    )

    @property
    def along(self) -> str:
        return self.direction or DIRECTIONS[0]

    def check(self) -> None:
        if self.part != ELEMENTS:
            self.fill(direction=self.along)
        elif self.direction is not None:
            problem = "is of raceways; an element has a height alone"
            raise self.table.error("direction", problem)


def _orders(table: Table, name: str) -> tuple[Any, ...]:
    named = table.raw(name)
    return tuple(named) if isinstance(named, list) and named else (named,)


_ORDER = {"type": "integer", "minimum": 1, "maximum": MOST_ORDER["raceway"]}


class WavesKeys(DirectedKeys):
    about = "[[deviations.waves]]: waves around a part"

    common: ClassVar[bool] = True

    order: tuple[int, ...] = scene_key(
        "waves in a turn, or a list; at most 900, of elements 110",
        reader=_orders,
        json={"anyOf": [_ORDER, {"type": "array", "items": _ORDER, "minItems": 1}]},
    )
    amplitude: float | tuple[float, ...] = scene_key(
        "amplitude, or a list with one of each order", "length"
    )
    phase: float | tuple[float, ...] = scene_key(
        "phase, or a list with one of each order", "angle", default=0.0
    )

    def check(self) -> None:
        super().check()
        for order in self.order:
            self._check_order("order", order)
        if len(set(self.order)) < len(self.order):
            raise self.table.error("order", f"{list(self.order)} names an order twice")
        for name in ("amplitude", "phase"):
            given = getattr(self, name)
            if isinstance(given, tuple) and len(given) != len(self.order):
                problem = f"has {len(given)} values for {len(self.order)} orders"
                raise self.table.error(name, problem)
        if np.any(np.less(self.amplitude, 0.0)):
            problem = "is negative; turn the `phase` by 180 deg in its place"
            raise self.table.error("amplitude", problem)

    def shape(self, context: ErrorContext) -> Harmonics:
        sizes = np.broadcast_to(self.amplitude, len(self.order))
        sizes = self._of_elements(sizes, context)
        return Harmonics(self.order, sizes, np.broadcast_to(self.phase, sizes.shape))


class SpectrumKeys(DirectedKeys):
    about = "[[deviations.spectrum]]: waves of every order of a range"

    lowest: int = scene_key("lowest order", most=MOST_ORDER["raceway"])
    highest: int = scene_key(
        "highest order; of elements 110 at most", most=MOST_ORDER["raceway"]
    )
    amplitude: float = scene_key("amplitude of the lowest order", "length", least=0)
    slope: float = scene_key("amplitudes fall with this power of the order")
    seed: int = scene_key(
        "seed of the random phases; rows draw their own", default=0, least=0
    )

    def check(self) -> None:
        super().check()
        for name in ("lowest", "highest"):
            self._check_order(name, getattr(self, name))
        if self.highest < self.lowest:
            problem = f"{self.highest} is below `lowest`, {self.lowest}"
            raise self.table.error("highest", problem)

    def shape(self, context: ErrorContext) -> Harmonics:
        # Rows are drawn independently; the first equals that of a single-row bearing.
        seed = [self.seed, context.row] if context.row else self.seed
        orders = self.highest - self.lowest + 1
        shape = (
            (orders,) if context.n_elements is None else (context.n_elements, orders)
        )
        phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, shape)
        sizes = self._of_elements(np.full(1, self.amplitude), context)
        return Harmonics.spectrum(self.lowest, self.highest, sizes, self.slope, phase)


class ProfileKeys(DirectedKeys):
    about = "[[deviations.profile]]: measured heights at even angles"

    points: tuple[float, ...] | None = scene_key("heights", "length")
    file: str | None = scene_key(
        'CSV file of heights, with the one column "height [um]"'
    )
    highest: int | None = scene_key(
        "highest order that is kept; at most 900, of elements 110",
        otherwise="as many as the heights hold",
    )

    def check(self) -> None:
        super().check()
        if (self.points is None) == (self.file is None):
            problem = "give either heights here or a `file` of them"
            raise self.table.error("points", problem)
        if self.highest is not None:
            self._check_order("highest", self.highest)

    def shape(self, context: ErrorContext) -> Harmonics:
        heights, table = np.array(self.points), self.table
        if self.points is None:
            found = read_list(table, context.folder, {"height": "length"}, "heights")
            if list(found) != ["height"]:
                problem = 'must have one column, headed such as "height [um]"'
                raise table.error("file", problem)
            heights = found["height"]
            table.fill("file", None)  # in the echo its heights
            table.fill("points", [format_number(height, "m") for height in heights])
        highest = self.highest or min(
            self.highest_order, max(1, (len(heights) - 1) // 2)
        )
        table.fill("highest", highest)
        waves = Harmonics.from_heights(heights, highest)
        sizes = self._of_elements(waves.amplitude, context)
        return Harmonics(waves.order, sizes, np.broadcast_to(waves.phase, sizes.shape))


class SpallKeys(DeviationKeys):
    about = "[[deviations.spalls]]: a place where the surface is lower"

    common: ClassVar[bool] = True

    angle: float = key_of(Spall, "angle", default=0.0)
    length: float = key_of(Spall, "length", above=0)
    depth: float = key_of(Spall, "depth", above=0)

    def check(self) -> None:
        if "direction" in self.table:
            problem = "is not of spalls, which lower the surface"
            raise self.table.error("direction", problem)
        if self.part == ELEMENTS and self.element is None:
            problem = "is missing; number of the element with the spall"
            raise self.table.error("element", problem)

    def shape(self, context: ErrorContext) -> Spall:
        every = np.zeros(() if context.n_elements is None else (context.n_elements,))
        depth = self._of_elements(self.depth, context)
        return Spall(every + self.angle, every + self.length, depth)


class DeviationsKeys(Keys):
    about = "[deviations]: form errors of raceways and rolling elements"

    waves: tuple[WavesKeys, ...] = scene_key("waves around parts", default=())
    spectrum: tuple[SpectrumKeys, ...] = scene_key("spectra of waves", default=())
    profile: tuple[ProfileKeys, ...] = scene_key("measured profiles", default=())
    spalls: tuple[SpallKeys, ...] = scene_key("spalls", default=())


def read_deviations(
    table: Table, counts: tuple[int, ...], folder: Path
) -> tuple[tuple[FormErrors, ...], tuple[FormErrors, ...]]:
    """Read the form errors of each row, and those common to the production line.

    Args:
        table: `[deviations]`.
        counts: Number of rolling elements of each row.
        folder: Folder of the scene and of its profile files.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    keys = read_keys(DeviationsKeys, table)
    found = [_Gathered(count) for count in counts]
    common = [_Gathered(count) for count in counts]
    for one in (*keys.waves, *keys.spectrum, *keys.profile, *keys.spalls):
        for rows in (found, common) if one.common else (found,):
            for k, row in enumerate(_rows(one, rows)):
                row.add(one, folder, k)
    both = [tuple(row.errors() for row in rows) for rows in (found, common)]
    return both[0], both[1]


class _Gathered:
    """Form errors of one row, collected while reading."""

    def __init__(self, count: int):
        self.count = count
        self.elements: list[AbstractShape] = []
        self.rings: dict[str, dict[str, list]] = {
            ring: {name: [] for name in DIRECTIONS} for ring in RACEWAYS.values()
        }

    def add(self, one: DeviationKeys, folder: Path, row: int):
        """Add one table; `row`: number of previous rows with this table."""
        of_elements = one.part == ELEMENTS
        if one.element is not None and one.element >= self.count:
            problem = f"{one.element} is not there; the elements are 0 to"
            raise one.table.error("element", f"{problem} {self.count - 1}")
        with one.table.building():
            shape = one.shape(
                ErrorContext(self.count if of_elements else None, folder, row)
            )
        if of_elements:
            self.elements.append(shape)
        else:
            self.rings[RACEWAYS[one.part]][one.along].append(shape)

    def errors(self) -> FormErrors:
        """Return all collected form errors."""
        made = {ring: RacewayErrors(**all_) for ring, all_ in self.rings.items()}
        return FormErrors(made["outer"], made["inner"], self.elements)


def _rows(keys: DeviationKeys, found: list[_Gathered]) -> list[_Gathered]:
    """Return the rows concerned: one by its index, or all; for a spall one."""
    which, table = keys.row, keys.table
    if which is None:
        if isinstance(keys, SpallKeys) and len(found) > 1:
            raise table.error("row", "is missing; number of the row with the spall")
        return found
    if len(found) == 1:
        raise table.error("row", "is of sets; the bearing has one row")
    if which >= len(found):
        allowed = f"the rows are 0 to {len(found) - 1}"
        raise table.error("row", f"{which} is not there; {allowed}")
    return [found[which]]

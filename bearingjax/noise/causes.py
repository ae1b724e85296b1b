"""Form errors as causes of the lines of a spectrum."""

from collections.abc import Iterable, Iterator
from typing import Annotated, Any, NamedTuple

import numpy as np

from ..design import FormErrors, Harmonics, RacewayErrors, Spall, rows_of
from ..numerics.types import in_numpy
from ..numerics.units import unit
from .lines import Line
from .model import NoiseModel
from .orders import KinematicFrequencies, kinematic_frequencies, waviness_force

_SIDEBANDS = 2
_PASSAGES = 6
"""Multiples of the cage frequency, in passages of the elements."""


class _Cause(NamedTuple):
    """Cause of a spectral line.

    Attributes:
        size: Size of the error [m].
        frequency: Frequency of the line [Hz].
        words: Description.
        order: Order of waves; 0: none.
        row: Number of the row in a set.
    """

    size: Annotated[float, unit("m")]
    frequency: Annotated[float, unit("Hz")]
    words: str
    order: int = 0
    row: int = 0


def line_causes(
    lines: Iterable[Line], model: NoiseModel, tolerance: Any
) -> tuple[tuple[str, ...], ...]:
    """Return the possible causes of each line, to first order.

    Waves: at the lines of `waviness_force`, for evenly loaded rolling elements (other
    orders appear too, weaker, where elements are loaded unevenly). Spalls: multiples
    of the passage frequency, with sidebands. Differences of diameter or spacing:
    multiples of the cage frequency. An uneven load: multiples of the frequency at which
    elements pass it. Nonlinear contacts make sums and differences of all these, for
    which no cause is given.

    Args:
        lines: From `name_lines`.
        model: The bearing with its errors; concrete.
        tolerance: Largest distance from a line [Hz].

    Returns:
        Causes of each line, that of the largest error first, such as "waves of the
        outer raceway, order 13, 15"; `()` where none is known.
    """
    lines = tuple(lines)
    highest = max((line.frequency for line in lines), default=0.0) + tolerance
    known = sorted(_known_waves(in_numpy(model), highest), key=lambda one: -one.size)
    rows = len(rows_of(model.element.bearing))
    return tuple(
        _named_lines(
            [one for one in known if abs(one.frequency - line.frequency) <= tolerance],
            rows,
        )
        for line in lines
    )


def _named_lines(causes: list[_Cause], rows: int) -> tuple[str, ...]:
    """Return each cause once, with the orders of its waves and its rows in a set."""
    found: dict[str, dict[int, set[int]]] = {}
    for one in causes:
        found.setdefault(one.words, {}).setdefault(one.row, set()).add(one.order)
    texts = []
    for words, by_row in found.items():
        # Rows with the same orders are named together.
        together: dict[tuple[int, ...], list[int]] = {}
        for row, orders in by_row.items():
            together.setdefault(tuple(sorted(orders)), []).append(row)
        for orders, of in together.items():
            numbers = " and ".join(map(str, sorted(of)))
            where = f" of row{'s' if len(of) > 1 else ''} {numbers}" if rows > 1 else ""
            waves = "" if orders == (0,) else f", order {', '.join(map(str, orders))}"
            texts.append(f"{words}{where}{waves}")
    return tuple(texts)


def _known_waves(model: NoiseModel, highest: float) -> Iterator[_Cause]:
    parts = rows_of(model.element.bearing)
    for k, (row, errors) in enumerate(zip(parts, model.errors_of_rows, strict=True)):
        for cause in _of_row(row.bearing, errors, model, highest):
            yield cause._replace(row=k)


def _of_row(
    bearing: Any, errors: FormErrors, model: NoiseModel, highest: float
) -> Iterator[_Cause]:
    """Yield causes in one row, of lines up to a frequency [Hz]."""
    frequencies = kinematic_frequencies(bearing, model.speed)
    count = bearing.n_elements
    row = bearing, model.speed
    for ring in ("outer", "inner"):
        yield from _of_raceway(row, getattr(errors, ring), ring, frequencies, highest)
    for shape in errors.elements:
        yield from _of_elements(shape, row, frequencies, highest)
    kind = bearing.noun
    cage = float(frequencies.cage)
    pitch = 0.5 * float(bearing.pitch_diameter)
    for name, words, scale in (
        (f"{kind}_deviation", f"differences of {kind} diameter", 1.0),
        ("azimuth_deviation", f"uneven spacing of the {kind}s", pitch),
    ):
        value = getattr(bearing, name)
        size = 0.0 if value is None else scale * float(np.ptp(value))
        for k in range(1, _PASSAGES * count + 1) if size else ():
            yield _Cause(size, k * cage, words)
    load = np.asarray(model.load)
    if load[[0, 1, 3, 4]].any():
        for k in _multiples(count * cage, highest):
            yield _Cause(0.0, k * count * cage, f"{kind}s passing the load")


def _of_raceway(
    row, errors: RacewayErrors, ring, frequencies: KinematicFrequencies, highest: float
) -> Iterator[_Cause]:
    count = row[0].n_elements
    passage, sideband = (
        (frequencies.outer_passage, frequencies.outer)
        if ring == "outer"
        else (frequencies.inner_passage, frequencies.inner)
    )
    for shape in (*errors.outwards, *errors.axial, *errors.raised):
        if isinstance(shape, Harmonics):
            sizes = np.abs(np.asarray(shape.amplitude))
            for order, size in zip(shape.order, sizes, strict=True):
                if size and min(order % count, -order % count) <= 1:
                    words = f"waves of the {ring} raceway"
                    yield from _of_wave(row, ring, order, size, words)
        elif isinstance(shape, Spall):
            words = f"spall of the {ring} raceway"
            yield from _of_spall(shape, float(passage), float(sideband), words, highest)


def _of_elements(
    shape, row, frequencies: KinematicFrequencies, highest: float
) -> Iterator[_Cause]:
    if isinstance(shape, Harmonics):
        sizes = np.abs(np.asarray(shape.amplitude)).max(axis=0)
        for order, size in zip(shape.order, sizes, strict=True):
            if size and order % 2 == 0:
                words = "waves of the rolling elements"
                yield from _of_wave(row, "element", order, size, words)
    elif isinstance(shape, Spall):
        twice, cage = float(frequencies.twice_rotation), float(frequencies.cage)
        words = "spall of a rolling element"
        yield from _of_spall(shape, twice, cage, words, highest)


def _of_wave(row, part, order, size, words) -> Iterator[_Cause]:
    bearing, speed = row
    made = waviness_force(bearing, speed, part, order)
    for frequency in np.concatenate([made.axial, made.radial]):
        yield _Cause(float(size), abs(float(frequency)), words, order)


def _multiples(frequency: float, highest: float) -> range:
    """Return the numbers of all multiples of a frequency up to another one."""
    return range(1, int(highest / frequency) + 1 if frequency > 0.0 else 0)


def _of_spall(shape, passage, sideband, words, highest) -> Iterator[_Cause]:
    depth = float(np.abs(np.asarray(shape.depth)).max())
    sides = range(-_SIDEBANDS, _SIDEBANDS + 1) if sideband else (0,)
    for k in _multiples(passage, highest + _SIDEBANDS * sideband) if depth else ():
        for m in sides:
            yield _Cause(depth, k * passage + m * sideband, words)

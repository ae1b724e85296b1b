"""Prominent lines of a spectrum and their names."""

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, NamedTuple

import numpy as np

from ..design import AbstractBearing, BearingSet
from ..design.bearing_set import bearings_of
from ..design.checks import count, non_negative, positive
from ..element.inertia import Speed
from ..numerics.units import unit
from .orders import KinematicFrequencies, kinematic_frequencies
from .spectrum import Spectrum

_FIRST = 10
"""Most multiples of a passage frequency with sidebands of the other ring."""
_APART = 12.0
"""Cost of a name one tolerance away, counted in multiples and sidebands."""
UNNAMED = "unnamed"
"""Name of a line without a known cause."""


class Line(NamedTuple):
    """A line of a spectrum.

    Attributes:
        order: Per turn of the shaft [1].
        frequency: [Hz].
        amplitude: Peak value; of several directions, the length of theirs [unit of the
            record].
        name: Its cause, such as "2 BPFI + shaft".
    """

    order: Annotated[float, unit("1")]
    frequency: Annotated[float, unit("Hz")]
    amplitude: float
    name: str


@dataclasses.dataclass(frozen=True)
class NameRule:
    """Which names of lines are sought.

    Attributes:
        harmonics: Largest multiple of a frequency.
        sidebands: Most sidebands to either side.
        tolerance: Largest distance from a line to its name [Hz]; `None`: half of the
            distance of two lines.

    Raises:
        TypeError, ValueError: For counts that are no whole numbers or below their
            least, or a tolerance below zero.
    """

    harmonics: int = 10
    sidebands: int = 2
    tolerance: float | None = dataclasses.field(default=None, metadata=unit("Hz"))

    def __post_init__(self):
        count("NameRule", "harmonics", self.harmonics)
        count("NameRule", "sidebands", self.sidebands + 1)
        if self.tolerance is not None:
            non_negative("NameRule", "tolerance", self.tolerance, "Hz")


@dataclasses.dataclass(frozen=True)
class PeakRule:
    """Which local maxima of a spectrum are lines.

    A line is a local maximum that is both `factor` times the median of its neighbours
    and `least` times the largest line; the `largest` maxima count whatever their
    neighbours: where lines are close, as multiples of the cage frequency are, none is
    far above its neighbours.

    Attributes:
        factor: Least ratio of a line over the median of its neighbours [1]. One in
            2^(factor²) lines of noise passes: of 4 one in 65 thousand, of 5 one in 30
            million.
        neighbours: Number of neighbours to either side.
        least: Smallest amplitude over that of the largest line [1].
        floor: Amplitude up to which a line is round-off [unit of the record].
        largest: Number of maxima, above `least`, taken by size alone.

    Raises:
        TypeError, ValueError: For counts that are no whole numbers or below their
            least, or a factor or share below zero.
    """

    factor: float = dataclasses.field(default=5.0, metadata=unit("1"))
    neighbours: int = 25
    least: float = dataclasses.field(default=1e-3, metadata=unit("1"))
    floor: float = 0.0
    largest: int = 0

    def __post_init__(self):
        count("PeakRule", "neighbours", self.neighbours)
        count("PeakRule", "largest", self.largest + 1)
        for name in ("factor", "least", "floor"):
            non_negative("PeakRule", name, getattr(self, name), "")


def name_lines(
    spectrum: Spectrum,
    bearing: AbstractBearing | BearingSet,
    speed: Speed,
    contact_angle: Any = None,
    *,
    natural: Mapping[str, Any] | None = None,
    names: NameRule | None = None,
    peaks: PeakRule | None = None,
) -> tuple[Line, ...]:
    """Return the prominent lines of a spectrum, with names from the kinematics.

    `PeakRule` says which maxima are lines. In a spectrum with Hann's window frequency
    and amplitude of a line are those of a single one between the bins.

    Names are sought among, with k up to `harmonics` and m up to `sidebands` of
    `NameRule` in size:
    k shaft, k cage, k BPFO, k BPFI ± m shaft, 2k BSF ± m cage, k BPFO ± m shaft. Where
    both rings turn, "inner ring" and "outer ring" stand for the shaft, and both
    raceways have the sidebands of both. Among all within the tolerance the name of
    least k + m (one more for sidebands by the other ring) plus 12 times the square of
    distance over tolerance is taken, then the first as they are
    listed here; a natural frequency only if there is no other. With many harmonics
    much of a spectrum lies near some name: a name alone is no proof.

    Args:
        spectrum: Amplitudes (line, ...); further axes, such as directions, are taken
            together. Concrete: this is no function for `jit`.
        bearing: A single row, or a set; rows that roll at other speeds than the first
            have their number in the names of their lines.
        speed, contact_angle: As in `kinematic_frequencies`.
        natural: Natural frequencies by their names [Hz].
        names: Which names are sought, and how near; `None`: `NameRule()`.
        peaks: Which maxima are lines; `None`: `PeakRule()`.

    Returns:
        Lines by their frequency; of none that fits the name is `UNNAMED`.

    Raises:
        TypeError, ValueError: As `kinematic_frequencies`; for a natural frequency that
            is not above zero.
    """
    names = NameRule() if names is None else names
    peaks = PeakRule() if peaks is None else peaks
    kinematic = [
        kinematic_frequencies(one, speed, contact_angle)
        for one in _single_rows(bearing)
    ]
    tolerance = names.tolerance
    if tolerance is None:
        tolerance = 0.5 * float(spectrum.resolution)
    known = list(_of_all(kinematic, names.harmonics, names.sidebands))
    for name, frequency in (natural or {}).items():
        positive("name_lines", f"natural[{name!r}]", frequency, "Hz")
    own = [(float(frequency), name) for name, frequency in (natural or {}).items()]
    shaft = float(spectrum.frequency[1]) / float(spectrum.order[1])
    return tuple(
        Line(
            frequency / shaft,
            frequency,
            amplitude,
            _name(frequency, known, own, float(tolerance)),
        )
        for frequency, amplitude in _peaks(spectrum, peaks)
        if amplitude > peaks.floor
    )


def _peaks(spectrum: Spectrum, rule: PeakRule) -> Iterator[tuple[float, float]]:
    """Yield frequency and amplitude of the local maxima above the floor."""
    amplitude = np.asarray(spectrum.amplitude)
    size = np.sqrt((np.abs(amplitude.reshape(len(amplitude), -1)) ** 2).sum(axis=1))
    size[0] = 0.0  # the mean is no line
    wide = min(rule.neighbours, len(size) - 1)
    around = np.lib.stride_tricks.sliding_window_view(
        np.pad(size, wide, mode="reflect"), 2 * wide + 1
    )
    least = rule.least * size.max()
    floor = np.maximum(rule.factor * np.median(around, axis=1), least)
    left, middle, right = size[:-2], size[1:-1], size[2:]
    maxima = 1 + np.flatnonzero((middle > left) & (middle >= right))
    chosen = size[maxima] > floor[maxima]
    for k in np.argsort(-size[maxima])[: rule.largest]:
        chosen[k] = size[maxima[k]] > least
    at = maxima[chosen]
    away, gain = spectrum.window.peak(size[at - 1], size[at], size[at + 1])
    frequencies = (at + away) * float(spectrum.resolution)
    yield from zip(frequencies.tolist(), (gain * size[at]).tolist(), strict=True)


def _single_rows(bearing):
    """Return the rows of a set; anything else unchanged, for later checks."""
    if not isinstance(bearing, BearingSet):
        return [bearing]
    return list(bearings_of(bearing))


def _of_all(
    kinematic: list[KinematicFrequencies], harmonics: int, sidebands: int
) -> Iterator[tuple[int, float, str]]:
    """Yield `_combinations` of all rows; once for rows of equal frequencies."""
    of_rows = np.array([[float(one) for one in row] for row in kinematic])
    seen: list[np.ndarray] = []
    for k, (row, numbers) in enumerate(zip(kinematic, of_rows, strict=True)):
        if any(np.allclose(numbers, other, rtol=1e-9, atol=0.0) for other in seen):
            continue
        seen.append(numbers)
        for cost, frequency, name in _combinations(row, harmonics, sidebands):
            yield cost, frequency, f"{name} of row {k}" if k else name


def _combinations(
    kinematic: KinematicFrequencies, harmonics: int, sidebands: int
) -> Iterator[tuple[int, float, str]]:
    """Yield cost, frequency and name of all possible lines."""
    inner, outer, cage, over_outer, over_inner, turned = map(float, kinematic)
    both = inner > 0 and outer > 0
    names = ("inner ring", "outer ring") if both else ("shaft", "shaft")
    side = range(-sidebands, sidebands + 1)
    # Frequency and name of the carrier, its multiples, frequency and name of sidebands.
    kinds = (
        (inner, names[0], 1, 0.0, "", 0),
        (outer, names[1], 1, 0.0, "", 0),
        (cage, "cage", 1, 0.0, "", 0),
        (over_outer, "BPFO", 1, outer, names[1], 0),
        (over_inner, "BPFI", 1, inner, names[0], 0),
        (turned, "BSF", 2, cage, "cage", 0),
        # A ring that is out of true shifts the load over the other raceway's waves.
        (over_outer, "BPFO", 1, inner, names[0], 1),
        (over_inner, "BPFI", 1, outer, names[1], 1),
    )
    for carrier, name, step, sideband, sideband_name, extra in kinds:
        # Of products of waves on both rings only the first are worth a name.
        for k in range(1, (min(harmonics, _FIRST) if extra else harmonics) + 1):
            for m in side if sideband > 0 else (0,):
                frequency = k * step * carrier + m * sideband
                if frequency > 0 and carrier > 0:
                    words = _times(k * step, name)
                    if m:
                        words += f" {'+' if m > 0 else '-'} "
                        words += _times(abs(m), sideband_name)
                    yield k + abs(m) + extra, frequency, words


def _times(k: int, name: str) -> str:
    return name if k == 1 else f"{k} {name}"


def _name(frequency, known, own, tolerance) -> str:
    """Return the name of a line: the simplest combination within the tolerance."""
    near = [
        (cost + _APART * ((one - frequency) / tolerance) ** 2, place)
        for place, (cost, one, _) in enumerate(known)
        if abs(one - frequency) <= tolerance
    ]
    if near:
        return known[min(near)[1]][2]
    near = [(abs(one - frequency), name) for one, name in own]
    near = [one for one in near if one[0] <= tolerance]
    return min(near)[1] if near else UNNAMED

"""Octave and third-octave bands of a spectrum."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import positive
from ..numerics.types import as_real
from .level import REFERENCE_ACCELERATION, level
from .spectrum import Spectrum

_R10 = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)
"""Preferred numbers of the series R 10: nominal centres of third-octaves."""


class Bands(NamedTuple):
    """Frequency bands, one beside the other.

    Attributes:
        centre: Nominal centres, by which bands are called (band,) [Hz].
        middle: Exact centres, the geometric mean of the edges (band,) [Hz].
        lower: Lower edges, which belong to the band (band,) [Hz].
        upper: Upper edges, which belong to the next one (band,) [Hz].
    """

    centre: np.ndarray
    middle: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def octave_bands(lowest: float = 4.0, highest: float = 8000.0) -> Bands:
    """Octave bands, by default the twelve of the rigs for bearing noise.

    Args:
        lowest: Nominal centre of the first band [Hz].
        highest: Nominal centre of the last band [Hz].

    Returns:
        Bands with the centres 1000 G^x Hz and edges G^(±1/2) from there, G = 10^(3/10).

    Raises:
        ValueError: If there is no band of that centre, or the last one is below the
            first.

    Source: IEC 61260-1 (2014), base ten.
    """
    return _bands("octave_bands", lowest, highest, 3)


def third_octave_bands(lowest: float = 4.0, highest: float = 10000.0) -> Bands:
    """Third-octave bands: centres 1000 G^(x/3) Hz, edges G^(±1/6) from there.

    Args:
        lowest, highest: As in `octave_bands`; such as 25, 31.5, 40.

    Raises:
        ValueError: As `octave_bands`.

    Source: IEC 61260-1 (2014), base ten.
    """
    return _bands("third_octave_bands", lowest, highest, 1)


def band_root_mean_square(
    spectrum: Spectrum, bands: Bands, highest: Any = None
) -> Float[Array, "band ..."]:
    """Root mean square of what a record has in each band.

    A line belongs to the band that its frequency lies in; of a windowed record it
    counts by its power, which does not depend on the window.

    Args:
        spectrum: Of the record, amplitudes (line, ...).
        bands: From `octave_bands` or `third_octave_bands`.
        highest: Frequency up to which the record is true, such as
            `Vibration.bandwidth` [Hz]; `None`: half of the sampling rate.

    Returns:
        (band, ...) [unit of the record]. NaN for a band that the record does not hold:
        one whose upper edge lies above that frequency, or that is narrower
        than a line (its `noise_bandwidth`), so that it holds one by chance. A band
        that is held and has nothing in it is 0, with a derivative of 0.
    """
    lower, upper = _edges(spectrum, bands)
    return _by_band(spectrum, lower, upper, _highest(spectrum, highest))


def band_levels(
    spectrum: Spectrum,
    bands: Bands,
    reference: Any = REFERENCE_ACCELERATION,
    highest: Any = None,
) -> Float[Array, "band ..."]:
    """Level of a record of acceleration in each band [dB].

    Args:
        spectrum: Of the record, amplitudes (line, ...) [m/s²].
        bands, highest: As in `band_root_mean_square`.
        reference: Acceleration of 0 dB [m/s²].

    Returns:
        Levels (band, ...); NaN for bands that the record does not hold.
    """
    return level(band_root_mean_square(spectrum, bands, highest), reference)


def total_root_mean_square(spectrum: Spectrum) -> Float[Array, "..."]:
    """Root mean square of a record about its mean (...) [unit of the record].

    It is of all lines, those outside of any bands too.
    """
    return _root(jnp.sum(spectrum.power[1:], axis=0))


def is_held(spectrum: Spectrum, bands: Bands, highest: Any = None) -> np.ndarray:
    """Which bands a record holds, as `band_root_mean_square` has it (band,)."""
    lower, upper = _edges(spectrum, bands)
    return np.asarray(_held(spectrum, lower, upper, _highest(spectrum, highest)))


@eqx.filter_jit
def _by_band(spectrum, lower, upper, highest):
    frequency, power = spectrum.frequency[None], spectrum.power
    inside = (frequency >= lower[:, None]) & (frequency < upper[:, None])
    sums = jnp.tensordot(inside.astype(power.dtype), power, axes=1)
    held = _held(spectrum, lower, upper, highest).reshape(-1, *[1] * (sums.ndim - 1))
    return jnp.where(held, _root(sums), jnp.nan)


def _held(spectrum, lower, upper, highest):
    return (upper <= highest) & (upper - lower >= spectrum.noise_bandwidth)


def _highest(spectrum, highest):
    half = spectrum.frequency[-1]
    return half if highest is None else jnp.minimum(half, as_real(highest))


def _edges(spectrum, bands):
    return [jnp.asarray(edge, spectrum.frequency.dtype) for edge in bands[2:]]


def _root(square):
    """Square root; where there is nothing its derivative is 0."""
    none = square == 0
    return jnp.where(none, 0.0, jnp.sqrt(jnp.where(none, 1.0, square)))


def _bands(owner, lowest, highest, step):
    """Every `step`-th third-octave between two nominal centres."""
    first = _place(owner, "lowest", lowest, step)
    last = _place(owner, "highest", highest, step)
    if last < first:
        raise ValueError(
            f"{owner}: `highest` is {highest:g} Hz; it must be {lowest:g} Hz, the"
            " lowest, or more."
        )
    places = np.arange(first, last + 1, step)
    middle = 10.0 ** (places / 10.0)
    half = 10.0 ** (step / 20.0)
    centre = np.array([_nominal(place) for place in places])
    return Bands(centre, middle, middle / half, middle * half)


def _place(owner, name, centre, step):
    """Tenths of a decade above 1 Hz of a nominal centre."""
    positive(owner, name, centre, "Hz")
    place = round(10.0 * np.log10(float(centre)))
    place = step * round(place / step)
    if not np.isclose(_nominal(place), float(centre), rtol=1e-6):
        near = [f"{_nominal(place + k * step):g}" for k in (-1, 0, 1)]
        raise ValueError(
            f"{owner}: `{name}` is {float(centre):g} Hz; it must be the nominal centre"
            f" of a band, such as {near[0]}, {near[1]} or {near[2]} Hz."
        )
    return place


def _nominal(place):
    decade, number = divmod(place, 10)
    return _R10[number] * 10.0**decade

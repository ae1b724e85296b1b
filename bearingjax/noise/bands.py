"""Octave and third-octave bands of a spectrum."""

from typing import Annotated, Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..design.checks import positive
from ..numerics.compiled.programs import program
from ..numerics.implicit import stop_gradient
from ..numerics.types import Reals, array_namespace, as_real, in_numpy
from ..numerics.units import unit
from .level import REFERENCE_ACCELERATION, level
from .spectrum import Spectrum

LEAST_SHIFT = 0.5
"""Change of a band level by skirts of lines above which the band is invalid [dB]."""
_REACH = 64
"""Bins to either side of an edge whose lines may leak over it.

Hann's window spreads less than 2e-11 of the power of lines further off over it.
"""
_AROUND = np.arange(-_REACH, _REACH, dtype=np.int32)[None]
_STRONG = 5.0
"""Ratio of a strong line to the geometric mean of its neighbours [1].

Of noise, whose amplitudes follow Rayleigh's distribution, one line in 10^6 is."""
_NEIGHBOURS = 25
"""Number of neighbours to either side."""
_R10 = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)
"""Preferred numbers of the series R 10: nominal centres of third-octaves."""


class Bands(NamedTuple):
    """Adjacent frequency bands.

    Attributes:
        centre: Nominal centres, the names of the bands (band,) [Hz].
        middle: Exact centres, the geometric mean of the edges (band,) [Hz].
        lower: Lower edges, which belong to the band (band,) [Hz].
        upper: Upper edges, which belong to the next one (band,) [Hz].
    """

    centre: Annotated[np.ndarray, unit("Hz")]
    middle: Annotated[np.ndarray, unit("Hz")]
    lower: Annotated[np.ndarray, unit("Hz")]
    upper: Annotated[np.ndarray, unit("Hz")]


def octave_bands(lowest: float = 4.0, highest: float = 8000.0) -> Bands:
    """Return octave bands, by default the twelve of the rigs for bearing noise.

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
    """Return third-octave bands: centres 1000 G^(x/3) Hz, edges G^(±1/6) from there.

    Args:
        lowest, highest: As in `octave_bands`; such as 25, 31.5, 40.

    Raises: as `octave_bands`.

    Source: IEC 61260-1 (2014), base ten.
    """
    return _bands("third_octave_bands", lowest, highest, 1)


BANDS = {"octave": octave_bands, "third_octave": third_octave_bands}
"""Bands of levels by name."""


def band_root_mean_square(
    spectrum: Spectrum, bands: Bands, highest: Any = None
) -> Float[Array, "band ..."]:
    """Return the root mean square of a record in each band.

    A line belongs to the band that its frequency lies in; of a windowed record it
    counts by its power, which does not depend on the window.

    Args:
        spectrum: Spectrum of the record, amplitudes (line, ...).
        bands: From `octave_bands` or `third_octave_bands`.
        highest: Frequency up to which the record is true, such as
            `Vibration.bandwidth` [Hz]; `None`: half of the sampling rate.

    Returns:
        (band, ...) [unit of the record]. NaN for a band that the record does not hold:
        one whose upper edge lies above that frequency; that is narrower than a line
        (its `noise_bandwidth`), so that it holds one by chance; or whose level changes
        by `LEAST_SHIFT` or more because the window spreads strong lines over its
        edges (`leakage`). Longer records hold more bands. A band that is held and has
        nothing in it is 0, with a derivative of 0.
    """
    lower, upper = _edges(spectrum, bands)
    return _by_band(spectrum, lower, upper, _highest_frequency(spectrum, highest))


def band_levels(
    spectrum: Spectrum,
    bands: Bands,
    reference: Any = REFERENCE_ACCELERATION,
    highest: Any = None,
) -> Float[Array, "band ..."]:
    """Return the level of an acceleration record in each band [dB].

    Args:
        spectrum: Spectrum of the record, amplitudes (line, ...) [m/s²].
        bands, highest: As in `band_root_mean_square`.
        reference: Acceleration of 0 dB [m/s²].

    Returns:
        Levels (band, ...); NaN for bands that the record does not hold.
    """
    return level(band_root_mean_square(spectrum, bands, highest), reference)


@program(quick=True)
def total_root_mean_square(spectrum: Spectrum) -> Reals:
    """Return the RMS of a record about its mean (...) [unit of the record].

    It is of all lines, those outside of any bands too.
    """
    return _root(jnp.sum(spectrum.power[1:], axis=0))


def is_held(
    spectrum: Spectrum, bands: Bands, highest: Any = None
) -> Bool[Array, "band ..."]:
    """Return which bands a record covers, see `band_root_mean_square` (band, ...)."""
    lower, upper = _edges(spectrum, bands)
    return _are_valid(spectrum, lower, upper, _highest_frequency(spectrum, highest))


class Leakage(NamedTuple):
    """Power of lines that a window leaks over edges between bands.

    Attributes:
        up: Power that lines below each edge leak above it (edge, ...) [unit of the
            record, squared].
        down: Power that lines above each edge leak below it (edge, ...) [unit of the
            record, squared].
        need: Distance from each edge to the line that spreads most over it (edge, ...)
            [Hz].
    """

    up: Float[Array, "edge ..."]
    down: Float[Array, "edge ..."]
    need: Annotated[Float[Array, "edge ..."], unit("Hz")]


@program(quick=True)
def leakage(spectrum: Spectrum, edges: Any) -> Leakage:
    """Estimate the leakage of a spectrum's window over edges of bands.

    Lines are the prominent local maxima of the spectrum; each is taken for a
    single one, with the frequency and amplitude from its neighbours
    (`AbstractWindow.peak`). Leakage of noise over an edge balances.

    Args:
        spectrum: Spectrum of the record, amplitudes (line, ...).
        edges: Frequencies (edge,) [Hz].

    Source: Harris, Proc. IEEE 66 (1978): transform of Hann's window.
    """
    window, amplitude = spectrum.window, jnp.abs(spectrum.amplitude)
    # The mean of the record is no neighbour of the first line.
    amplitude = amplitude.at[0].set(0.5 * amplitude[1])
    edge = jnp.asarray(edges, amplitude.dtype) / spectrum.resolution
    first = jnp.ceil(edge)  # bin above the edge
    bins = first.astype(jnp.int32)[:, None] + _AROUND
    last = len(amplitude) - 1
    left, middle, right = (amplitude[jnp.clip(bins + k, 0, last)] for k in (-1, 0, 1))
    axes = [1] * (amplitude.ndim - 1)
    inside = ((bins > 0) & (bins < last)).reshape(*bins.shape, *axes)
    strong = _strong_lines(amplitude)[jnp.clip(bins, 0, last)]
    line = inside & strong & (middle > left) & (middle >= right)
    away, gain = window.peak(left, middle, right)
    place = bins.astype(edge.dtype).reshape(*bins.shape, *axes) + away
    power = jnp.where(line, 0.5 * (gain * middle) ** 2, 0.0)
    edge, first = (one.reshape(-1, 1, *axes) for one in (edge, first))
    below = place < edge
    apart = jnp.where(below, first - place, place - (first - 1))
    spread = power * window.power_beyond(jnp.where(line, apart, 1.0))
    most = jnp.argmax(spread, axis=1, keepdims=True)
    need = jnp.abs(jnp.take_along_axis(place - edge, most, axis=1))[:, 0]
    up, down = (jnp.sum(jnp.where(k, spread, 0.0), axis=1) for k in (below, ~below))
    return Leakage(up, down, need * spectrum.resolution)


def _strong_lines(amplitude):
    """Return which lines are strong against their neighbours (line, ...)."""
    tiny = jnp.finfo(amplitude.dtype).tiny
    logs = jnp.log(jnp.maximum(amplitude, tiny))
    wide = min(_NEIGHBOURS, len(amplitude) - 1)
    padded = jnp.pad(logs, [(wide, wide)] + [(0, 0)] * (logs.ndim - 1), "reflect")
    sums = jnp.cumsum(jnp.pad(padded, [(1, 0)] + [(0, 0)] * (logs.ndim - 1)), axis=0)
    count = 2 * wide + 1
    return logs > (sums[count:] - sums[:-count]) / count + np.log(_STRONG)


def shift(power: Any, gained: Any, lost: Any) -> Any:
    """Return the change of a level by power gained and lost [dB].

    Args:
        power, gained, lost: Mean squares (...) [unit of the record, squared].
    """
    xp = array_namespace(power, gained, lost)
    true = xp.maximum(power - gained + lost, 1e-30 * power)
    silent = power <= 0.0
    ratio = xp.where(silent, 1.0, power) / xp.where(silent, 1.0, true)
    return 10.0 * xp.log10(ratio)


def band_shift(spectrum: Spectrum, bands: Bands) -> tuple[Any, Any]:
    """Return the change of each band level by skirts of strong lines.

    Args:
        spectrum: Spectrum of the record, amplitudes (line, ...).
        bands: From `octave_bands` or `third_octave_bands`.

    Returns:
        The change (band, ...) [dB], and the distance of the line with the largest share
        from the edge that it leaks over (band, ...) [Hz].
    """
    *powers, need = in_numpy(band_power(spectrum, bands))
    return shift(*powers), need


def band_power(spectrum: Spectrum, bands: Bands) -> tuple[Any, Any, Any, Any]:
    """Return the mean square in each band, and its change by skirts of strong lines.

    Args: as `band_shift`.

    Returns:
        The mean square, the gain and the loss over the edges (band, ...) [unit
        of the record, squared], and the distance of `band_shift` [Hz].
    """
    return _powers(spectrum, *_edges(spectrum, bands))


@program(quick=True)
def _powers(spectrum, lower, upper):
    below, above = leakage(spectrum, lower), leakage(spectrum, upper)
    of_lower = below.up + below.down > above.up + above.down
    return (
        _sums(spectrum, lower, upper),
        below.up + above.down,
        below.down + above.up,
        jnp.where(of_lower, below.need, above.need),
    )


@program(quick=True)
def _by_band(spectrum, lower, upper, highest):
    held = _are_valid(spectrum, lower, upper, highest)
    return jnp.where(held, _root(_sums(spectrum, lower, upper)), jnp.nan)


def _sums(spectrum, lower, upper):
    """Return the mean square between the edges (band, ...)."""
    frequency, power = spectrum.frequency[None], spectrum.power
    inside = (frequency >= lower[:, None]) & (frequency < upper[:, None])
    return jnp.tensordot(inside.astype(power.dtype), power, axes=1)


def covers(spectrum: Spectrum, bands: Bands, highest: Any = None) -> tuple[Any, Any]:
    """Return whether bands are at least as wide as a line and in the record (band,).

    Arguments as in `band_root_mean_square`.
    """
    lower, upper = _edges(spectrum, bands)
    return _covers(spectrum, lower, upper, _highest_frequency(spectrum, highest))


def _covers(spectrum, lower, upper, highest):
    return upper - lower >= spectrum.noise_bandwidth, upper <= highest


@program(quick=True)
def _are_valid(spectrum, lower, upper, highest):
    wide, within = _covers(spectrum, lower, upper, highest)
    *powers, _ = _powers(stop_gradient(spectrum), lower, upper)
    changed = shift(*powers)
    axes = [1] * (changed.ndim - 1)
    return (wide & within).reshape(-1, *axes) & (jnp.abs(changed) < LEAST_SHIFT)


def _highest_frequency(spectrum, highest):
    half = spectrum.frequency[-1]
    if highest is None:
        return half
    highest = in_numpy(as_real(highest))
    return array_namespace(half, highest).minimum(half, highest)


def _edges(spectrum, bands):
    dtype = spectrum.frequency.dtype
    return [array_namespace(edge).asarray(edge, dtype) for edge in bands[2:]]


def _root(square):
    """Return the square root, with the derivative 0 at 0."""
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

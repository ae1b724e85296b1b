"""Noise of random bearings within tolerances.

Bearings are drawn and shaken a batch at a time, all by one compiled program. Spectra
are taken outside of it, and of a record only its levels are kept.
"""

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..design import FormErrors, RacewayErrors, rows_of
from ..design.bearing_set import with_bearings
from ..design.checks import check, count, is_traced, of_class
from ..numerics.compiled.programs import program
from ..numerics.labels import to_xarray
from ..numerics.result import Result
from ..numerics.shown import Printable
from ..numerics.units import meaning, unit
from .bands import Bands, band_levels, octave_bands, total_root_mean_square
from .level import REFERENCE_ACCELERATION, level
from .model import NoiseModel
from .scatter import SampledErrors, Tolerances, sample_errors
from .spectrum import AbstractWindow, Hann, spectrum
from .vibration import Vibration, bandwidth, needed_steps, vibration

_DIRECTIONS = 3
OnRecords = Callable[[Array, Array], Any]
"""Callback with accelerations (bearing, time, 3) [m/s²] and result codes (bearing,)."""
Progress = Callable[[int, int], Any]
"""Callback with the number of bearings done and the total."""


class MonteCarlo(Printable):
    """Levels of many bearings; NaN for those that failed.

    Attributes:
        level: Level of all frequencies, along x, y, z (bearing, 3) [dB].
        bands: Level of each band (bearing, band, 3) [dB]; NaN too for bands that the
            record does not hold.
        centre: Nominal centres of the bands (band,) [Hz].
        result: `Result` codes (bearing,).
        keys: Keys with which `sampled_model` reproduces each bearing (bearing,).
    """

    level: Float[Array, "bearing direction=3"] = eqx.field(metadata=unit("dB"))
    bands: Float[Array, "bearing band direction=3"] = eqx.field(metadata=unit("dB"))
    centre: Float[Array, " band"] = eqx.field(metadata=unit("Hz"))
    result: Int[Array, " bearing"]
    keys: Array

    to_xarray = to_xarray

    @property
    def n_failed(self) -> int:
        """Number of bearings without levels."""
        return int(np.sum(np.asarray(self.result) != Result.CONVERGED))

    def percentile(self, share: Any) -> Float[Array, "... 3"]:
        """Return total levels that a share of the bearings does not exceed [dB].

        Args:
            share: From 0 to 100 (...) [%].
        """
        return jnp.nanpercentile(self.level, jnp.asarray(share, float), axis=0)


def sampled_model(model: NoiseModel, tolerances: Tolerances, key: Array) -> NoiseModel:
    """Draw one bearing: the model with random errors added to its own.

    Args:
        model: The bearing as on the drawing, or with errors that all have.
        tolerances: Scatter of the bearings.
        key: Key of `jax.random`.
    """
    bearing: Any = model.element.bearing
    parts = rows_of(bearing)
    # Rows of a set are drawn on their own.
    keys = [key] if len(parts) == 1 else jax.random.split(key, len(parts))
    found = [
        sample_errors(tolerances, row.bearing, k)
        for row, k in zip(parts, keys, strict=True)
    ]
    rows = [_deviate(row.bearing, one) for row, one in zip(parts, found, strict=True)]
    errors = tuple(
        _add(own, one.errors)
        for own, one in zip(model.errors_of_rows, found, strict=True)
    )
    errors = errors if len(parts) > 1 else errors[0]
    changed = with_bearings(bearing, rows), errors
    return eqx.tree_at(lambda m: (m.element.bearing, m.errors), model, changed)


def sampled_record(
    model: NoiseModel, tolerances: Tolerances, key: Array, counts: tuple[int, ...]
) -> Vibration:
    """Return the record of one bearing.

    Args:
        model, tolerances, key: As in `sampled_model`.
        counts: Turns, turns to settle, samples and steps, as in `vibration`. Static.
    """
    names = "turns", "settle", "samples", "steps"
    given: Any = dict(zip(names, counts, strict=True))
    return vibration(sampled_model(model, tolerances, key), **given, throw=False)


@dataclasses.dataclass(frozen=True)
class RecordOptions:
    """Lengths of vibration records of many bearings.

    Attributes:
        turns, settle, samples, steps: As in `vibration`; `steps` of the model as it is.
        batch: Number of bearings at once.
    """

    turns: int = dataclasses.field(default=8, metadata=meaning("turns of the record"))
    settle: int = dataclasses.field(
        default=2, metadata=meaning("turns that settle before it")
    )
    samples: int = dataclasses.field(
        default=2048, metadata=meaning("samples of a turn, an even number")
    )
    steps: int | None = dataclasses.field(
        default=None, metadata=meaning("steps of the integration between two samples")
    )
    batch: int = 16


@dataclasses.dataclass(frozen=True)
class LevelOptions:
    """How levels are taken of records.

    Attributes:
        bands: Bands; `None`: `octave_bands()`.
        window: Window of the spectra; `None`: `Hann()`, since a record does not repeat
            itself: the cage turns by no whole number.
        reference: Acceleration of 0 dB [m/s²].
    """

    bands: Bands | None = None
    window: AbstractWindow | None = None
    reference: Any = dataclasses.field(
        default=REFERENCE_ACCELERATION, metadata=unit("m/s²", "acceleration of 0 dB")
    )


def monte_carlo(
    model: NoiseModel,
    tolerances: Tolerances,
    n: int,
    key: Array,
    *,
    records: RecordOptions | None = None,
    levels: LevelOptions | None = None,
    on_records: OnRecords | None = None,
    progress: Progress | None = None,
) -> MonteCarlo:
    """Return the noise of many random bearings.

    This is a loop over batches, no function for `jit`.

    Args:
        model: The bearing as on the drawing, or with errors that all have.
        tolerances: Scatter of the bearings.
        n: Number of bearings.
        key: Key of `jax.random`; the same gives the same bearings.
        records: Lengths of records, and bearings at once; `None`: `RecordOptions()`.
        levels: Bands, window and reference of levels; `None`: `LevelOptions()`.
        on_records: Called with the records of each batch, which are not kept.
        progress: Called after each batch.

    Raises:
        TypeError, ValueError: As `vibration`; for other tolerances, numbers of bearings
            that are none, or a spacing that lets rolling elements overlap.

    Fails: a bearing as `vibration` does; its levels are NaN.
    """
    given = RecordOptions() if records is None else records
    made = Records(model, tolerances, n, given, "monte_carlo")
    keys = jax.random.split(key, n)
    asked = LevelOptions() if levels is None else levels
    bands = octave_bands() if asked.bands is None else asked.bands
    window = Hann() if asked.window is None else asked.window
    reference = asked.reference
    shaft = model.shaft_speed / (2.0 * jnp.pi)

    def levels_of(acceleration, failed):
        lines = spectrum(acceleration, given.turns / shaft, shaft, window=window)
        total = level(total_root_mean_square(lines), reference)
        highest = bandwidth(given.samples, shaft)
        each = jnp.moveaxis(band_levels(lines, bands, reference, highest), 0, 1)
        return (
            jnp.where(failed[:, None], jnp.nan, total),
            jnp.where(failed[:, None, None], jnp.nan, each),
        )

    found = []
    for part, acceleration, result in made.batches(keys, progress):
        if on_records is not None:
            on_records(acceleration[:part], result[:part])
        failed = result != int(Result.CONVERGED)
        heard = jnp.where(failed[:, None, None], 0.0, acceleration)
        one = *levels_of(jnp.moveaxis(heard, 0, 1), failed), result
        found.append([np.asarray(a)[:part] for a in one])
    total, each, result = (
        jnp.asarray(np.concatenate(a)) for a in zip(*found, strict=True)
    )
    return MonteCarlo(total, each, jnp.asarray(bands.centre), result, keys)


def _deviate(bearing: Any, found: SampledErrors) -> Any:
    """Return a single row with deviations of its elements added to its own."""
    name = f"{bearing.noun}_deviation"
    for field, value in ((name, found.diameter), ("azimuth_deviation", found.azimuth)):
        if value is None:
            continue
        own = getattr(bearing, field)
        bearing = eqx.tree_at(
            lambda b, field=field: getattr(b, field),
            bearing,
            value if own is None else own + value,
            is_leaf=lambda x: x is None,
        )
    return bearing


def _add(one: FormErrors, other: FormErrors) -> FormErrors:
    def ring(a, b):
        return RacewayErrors(
            a.axial + b.axial, a.outwards + b.outwards, a.raised + b.raised
        )

    return FormErrors(
        ring(one.outer, other.outer),
        ring(one.inner, other.inner),
        one.elements + other.elements,
    )


class Records:
    """Vibration records of random bearings, batch by batch."""

    def __init__(self, model, tolerances, n, options, owner):
        """Check the arguments, which are those of `monte_carlo`."""
        of_class(owner, "model", model, NoiseModel, "a NoiseModel")
        of_class(owner, "tolerances", tolerances, Tolerances, "Tolerances")
        if any(is_traced(leaf) for leaf in jax.tree.leaves((model, tolerances))):
            raise TypeError(f"{owner}: it is a loop over batches, not for `jit`.")
        for row in rows_of(model.element.bearing):
            tolerances.check(row.bearing)
        count(owner, "n", n)
        count(owner, "samples", options.samples)
        count(owner, "batch", options.batch)
        shaft = model.shaft_speed
        check(owner, "speed", shaft > 0, "another than 0", shaft, "rad/s")
        steps, samples = options.steps, options.samples
        steps = needed_steps(model, samples) if steps is None else steps
        self.given = model, tolerances
        self.counts = options.turns, options.settle, samples, steps
        self.batch = options.batch

    def parts(self, n: int) -> Iterator[tuple[int, np.ndarray]]:
        """Yield the number of bearings of each batch, padding left out, and indices."""
        size = min(self.batch, n)
        for begin in range(0, n, size):
            # The last batch is filled up: one shape, one program.
            at = np.minimum(np.arange(begin, begin + size), n - 1)
            yield min(size, n - begin), at

    def batches(
        self,
        keys: Any,
        progress: Callable[[int, int], Any] | None = None,
        factors: Any = None,
    ) -> Iterator[tuple]:
        """Yield the number of bearings, accelerations and result codes by batch."""
        # Factors of all sources, so that one program serves all calls.
        names, given = self.given[1].sources, factors or {}
        factors = {name: jnp.asarray(given.get(name, 1.0)) for name in names}
        for part, at in self.parts(len(keys)):
            yield part, *_records(*self.given, factors, *unwrap(keys[at]), self.counts)
            if progress is not None:
                progress(int(at[-1]) + 1, len(keys))


def unwrap(keys: Array) -> tuple[Array, str | None]:
    """Return plain numbers of typed keys, which kept programs take, and their kind."""
    if not jnp.issubdtype(keys.dtype, jax.dtypes.prng_key):
        return keys, None
    return jax.random.key_data(keys), str(jax.random.key_impl(keys))


def wrap(numbers: Array, kind: str | None) -> Array:
    """Return the keys from `unwrap`."""
    return numbers if kind is None else jax.random.wrap_key_data(numbers, impl=kind)


@program(quick=True, level=1)
def _records(model, tolerances, factors, numbers, kind, counts):
    """Return accelerations (bearing, time, 3) and result codes of a batch."""
    tolerances = tolerances.scale(factors)

    def record(key):
        found = sampled_record(model, tolerances, key, counts)
        return found.acceleration[:, :_DIRECTIONS], found.result

    return jax.vmap(record)(wrap(numbers, kind))

"""Shares of tolerances in the noise, and their ranking.

The motion follows small form errors in proportion: the mean square of the acceleration
is then P₀ + Σ s² P over the sources of scale s, once it is averaged over bearings,
since sources are independent of each other. P₀ is the mean square of a perfect bearing.
A share P
is found in two ways that agree for small errors: from the same bearings with the source
smaller or switched off, and from the derivative, P = (s/2) ∂/∂s.

Where sources act through each other, as two that only beat together or that open
contacts, the mean square has products of them. Both ways then count a product for each
of its sources: shares sum to more than the mean square
    (`SourceContributions.total_share`).
"""

import dataclasses
from collections.abc import Iterable, Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check
from ..numerics.compiled.programs import program
from ..numerics.result import Result
from ..numerics.shown import Printable
from ..numerics.types import Scalar
from ..numerics.units import unit
from .bands import LEAST_SHIFT, Bands, band_power, shift
from .level import REFERENCE_ACCELERATION, level
from .model import NoiseModel
from .monte_carlo import Progress, RecordOptions, Records, sampled_record, unwrap, wrap
from .scatter import Tolerances
from .spectrum import Hann, spectrum
from .vibration import bandwidth


class SourceContributions(Printable):
    """Mean squares of the acceleration, each the mean over the same bearings.

    Attributes:
        mean_square: With all sources [m²/s⁴].
        smaller: With one source `factor` times as large (source,) [m²/s⁴].
        error: Standard error of each `share`, by its scatter over the bearings
            (source,) [m²/s⁴]; NaN of a single bearing.
        by_band: Part of each band's mean square that a source makes (source, band)
            [1]; NaN for bands that the record does not hold. `None`: not asked for.
        by_gradient: Half of the derivative by the logarithm of a source's scale
            (source,) [m²/s⁴]; `None`: not asked for.
        factor: Factor of the reduced sources [1].
        used: Number of bearings with a result in all runs.
        sources: Their names. Static.
    """

    mean_square: Scalar
    smaller: Float[Array, " source"]
    error: Float[Array, " source"]
    by_band: Float[Array, "source band"] | None
    by_gradient: Float[Array, " source"] | None
    factor: Scalar
    used: int = eqx.field(static=True)
    sources: tuple[str, ...] = eqx.field(static=True)

    @property
    def share(self) -> Float[Array, " source"]:
        """Share of each source in the mean square (source,) [m²/s⁴].

        It is exact for `factor` 0, and for another one as far as the mean square is
        quadratic in the source.
        """
        return (self.mean_square - self.smaller) / (1.0 - self.factor**2)

    @property
    def total_share(self) -> Scalar:
        """Sum of all shares over the mean square [1].

        Products of sources, which count for each of them, raise it above 1; vibration
        without these sources lowers it below 1.
        """
        return jnp.sum(self.share) / self.mean_square

    @property
    def ranking(self) -> tuple[str, ...]:
        """Sources in order of decreasing share."""
        return self._rank(self.share)

    @property
    def ranking_by_gradient(self) -> tuple[str, ...]:
        """Sources ranked by the derivatives."""
        if self.by_gradient is None:
            raise ValueError("SourceContributions: the derivatives were not asked for.")
        return self._rank(self.by_gradient)

    def gain(self, factor: Any = 0.5) -> Float[Array, " source"]:
        """Return the reduction of the level if one source is tightened (source,) [dB].

        Args:
            factor: New size of the source over its old one [1].
        """
        return self._fall((1.0 - factor**2) * self.share)

    def gain_together(self, factors: Mapping[str, Any]) -> Scalar:
        """Return the reduction of the level if several sources are tightened [dB].

        Args:
            factors: New size over the old one, by the names of sources [1].
        """
        named = [factors.get(name, 1.0) for name in self.sources]
        less = 1.0 - jnp.asarray(named, self.share.dtype) ** 2
        return self._fall(jnp.sum(less * self.share))

    def _fall(self, less):
        root = jnp.sqrt(jnp.maximum(self.mean_square - less, 0.0))
        one = REFERENCE_ACCELERATION
        return level(jnp.sqrt(self.mean_square), one) - level(root, one)

    def _rank(self, values):
        return tuple(self.sources[k] for k in np.argsort(-np.asarray(values)))


@dataclasses.dataclass(frozen=True)
class ContributionOptions:
    """What the contributions of sources are of, and how they are found.

    Attributes:
        direction: 0, 1, 2 along x, y, z, or a vector along which the rig listens (3,);
            `None`: all directions together.
        bands: Bands of which the parts are wanted too; `None`: none.
        factor: By which a source is made smaller, from 0 (off) to below 1 [1]: 0.5
            gives the exact effect of halving.
        gradient: Whether shares by derivatives are wanted: about the time of five more
            runs.

    Raises:
        ValueError: For another direction or factor.
    """

    direction: Any = None
    bands: Bands | None = None
    factor: float = dataclasses.field(default=0.0, metadata=unit("1"))
    gradient: bool = True

    def __post_init__(self):
        inside = 0.0 <= self.factor < 1.0
        check(self, "factor", inside, "from 0 to below 1")
        _directions(self.direction)


def source_contributions(
    model: NoiseModel,
    tolerances: Tolerances,
    n: int,
    key: Array,
    *,
    records: RecordOptions | None = None,
    options: ContributionOptions | None = None,
    unchanged: Iterable[tuple[Array, Array]] | None = None,
    progress: Progress | None = None,
) -> SourceContributions:
    """Return the share of every source of scatter in the mean square acceleration.

    The same random bearings run once unchanged, once for every source with this one
    smaller, and once with derivatives.

    Args:
        model, tolerances, n, key, records: As in `monte_carlo`; the key may also be the
            `MonteCarlo.keys` of n bearings (n,).
        options: What is compared; `None`: `ContributionOptions()`.
        unchanged: Records of these bearings, and maybe more, without any change, as
            `monte_carlo` hands them to `on_records`; `None`: they are made anew.
        progress: Called after each batch.

    Raises:
        TypeError, ValueError: As `monte_carlo`; without any source; for another number
            of keys, or fewer unchanged records.
        FloatingPointError: If no bearing has a result in all runs.
    """
    given = RecordOptions() if records is None else records
    asked = ContributionOptions() if options is None else options
    factor, bands, gradient = asked.factor, asked.bands, asked.gradient
    turns, samples = given.turns, given.samples
    drawn = Records(model, tolerances, n, given, "source_contributions")
    sources = tolerances.sources
    if not sources:
        raise ValueError(
            "source_contributions: `tolerances` is without a source; give at least one."
        )
    along = _directions(asked.direction)
    # A plain key has an axis of its own.
    many = key.ndim > (not jnp.issubdtype(key.dtype, jax.dtypes.prng_key))
    keys = key if many else jax.random.split(key, n)
    if len(keys) != n:
        raise ValueError(
            f"source_contributions: `key` has {len(keys)} keys; it must have {n}."
        )
    less = [{name: factor} for name in sources]
    changes = less if unchanged is not None else [{}, *less]
    whole = len(changes) + gradient
    done = 0
    shaft = float(model.shaft_speed) / (2.0 * np.pi)

    def report_progress(count, _):
        if progress is not None:
            progress(done + count, whole * n)

    def of_bands(acceleration, result):
        """Return the mean square of each band, and gain and loss over its edges."""
        if bands is None:
            return np.zeros((len(result), 3, 0))
        solved = (result == int(Result.CONVERGED))[:, None, None]
        heard = jnp.where(solved, acceleration @ along, 0.0)
        lines = spectrum(jnp.moveaxis(heard, 0, 1), turns / shaft, shaft, window=Hann())
        *powers, _ = band_power(lines, bands)
        return np.asarray(jnp.sum(jnp.stack(powers), axis=-1).T.swapaxes(1, 2))

    def collect(batches):
        """Return mean squares, those of bands, and whether each bearing is solved."""
        found = [
            (np.asarray(_mean_square(a, along)), of_bands(a, r), np.asarray(r))
            for a, r in batches
        ]
        square, each, result = (np.concatenate(a)[:n] for a in zip(*found, strict=True))
        return square, each, result == int(Result.CONVERGED)

    runs = [] if unchanged is None else [collect(unchanged)]
    if runs and len(runs[0][0]) < n:
        raise ValueError(
            f"source_contributions: `unchanged` has {len(runs[0][0])} records; it needs"
            f" {n}."
        )
    for change in changes:
        made = drawn.batches(keys, report_progress, change)
        runs.append(collect((a[:part], r[:part]) for part, a, r in made))
        done += n
    squares, in_bands, solved = (np.array(a) for a in zip(*runs, strict=True))
    fine = np.all(solved, axis=0)
    slopes = []
    if gradient:
        for part, at in drawn.parts(n):
            slope = _slopes(*drawn.given, *unwrap(keys[at]), drawn.counts, along)
            slopes.append([slope[name][:part] for name in sources])
            report_progress(min(len(slopes) * given.batch, n), n)
    if not fine.any():
        raise FloatingPointError(
            f"source_contributions: of {n} bearings none has a result in all runs;"
            " see the codes of `monte_carlo`."
        )
    each = squares[:, fine]
    mean = jnp.asarray(np.mean(each, axis=1))
    by_gradient = None
    if gradient:
        every = np.concatenate(slopes, axis=1)
        by_gradient = jnp.asarray(0.5 * np.mean(every[:, fine], axis=1))
    less = (each[0] - each[1:]) / (1.0 - factor**2)
    count = each.shape[1]
    error = np.full(len(sources), np.nan)
    if count > 1:
        error = np.std(less, axis=1, ddof=1) / np.sqrt(count)
    by_band = None
    if bands is not None:
        means = np.mean(in_bands[:, fine], axis=1)
        # All runs have the same lines; what holds of the whole holds of its parts.
        holds = _holds(bands, means[0], turns / shaft, bandwidth(samples, shaft))
        whole_band = np.where(holds & (means[0, 0] > 0.0), means[0, 0], np.nan)
        by_band = (1.0 - means[1:, 0] / whole_band) / (1.0 - factor**2)
    return SourceContributions(
        mean[0],
        mean[1:],
        jnp.asarray(error),
        None if by_band is None else jnp.asarray(by_band),
        by_gradient,
        jnp.asarray(factor, mean.dtype),
        count,
        sources,
    )


def _holds(bands: Bands, powers: np.ndarray, duration: float, highest: float):
    """Return which bands records cover, by mean powers (3, band) of `band_power`."""
    wide = bands.upper - bands.lower >= Hann().noise_bandwidth / duration
    near = np.abs(np.asarray(shift(*powers))) < LEAST_SHIFT
    return wide & (bands.upper <= highest) & near


def _directions(direction: Any) -> np.ndarray:
    """Return unit vectors of the directions of acceleration, (3, n)."""
    three = np.eye(3)
    if direction is None:
        return three
    if isinstance(direction, int) and direction in (0, 1, 2):
        return three[:, direction, None]
    vector = np.asarray(direction, dtype=float)
    right = vector.shape == (3,) and np.isfinite(vector).all() and vector.any()
    check(
        "ContributionOptions",
        "direction",
        right,
        "0, 1, 2, a vector or None",
        direction,
        "",
    )
    return (vector / np.linalg.norm(vector))[:, None]


def _mean_square(acceleration, along):
    """Return the variance of records (..., time, 3) summed over directions (...)."""
    return jnp.sum(jnp.var(acceleration @ along, axis=-2), axis=-1)


@program(quick=True, level=1)
def _slopes(model, tolerances, numbers, kind, counts, along):
    """Return derivatives of every bearing's mean square by the scales of sources."""
    one = jnp.ones((), model.mass.dtype)
    factors = {name: one for name in tolerances.sources}

    def square(factors, key):
        found = sampled_record(model, tolerances.scale(factors), key, counts)
        return _mean_square(found.acceleration[:, :3], along)

    return jax.vmap(jax.grad(square), in_axes=(None, 0))(factors, wrap(numbers, kind))

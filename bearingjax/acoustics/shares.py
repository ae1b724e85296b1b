"""Which tolerance makes the noise, and what to tighten first.

The motion follows small form errors in proportion: the mean square of the acceleration
is then P₀ + Σ s² P over the sources of scale s, once it is averaged over bearings,
since sources are independent of each other. P₀ is what a perfect bearing has. A share P
is found in two ways that agree for small errors: from the same bearings with the source
smaller or switched off, and from the derivative, P = (s/2) ∂/∂s.
"""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..design.checks import check
from ..numerics.result import Result
from ..numerics.types import Scalar
from .level import REFERENCE_ACCELERATION, level
from .model import NoiseModel
from .monte_carlo import Progress, Records, drawn
from .scatter import Tolerances
from .vibration import vibration


class Shares(eqx.Module):
    """Mean squares of the acceleration, each the mean over the same bearings.

    Attributes:
        mean_square: With all sources [m²/s⁴].
        smaller: With one source `factor` times as large (source,) [m²/s⁴].
        by_gradient: Half of the derivative by the logarithm of a source's scale
            (source,) [m²/s⁴]; `None`: not asked for.
        factor: By which sources were made smaller [1].
        used: How many bearings of those drawn count: with a result in all runs.
        sources: Their names. Static.
    """

    mean_square: Scalar
    smaller: Float[Array, " source"]
    by_gradient: Float[Array, " source"] | None
    factor: Scalar
    used: int = eqx.field(static=True)
    sources: tuple[str, ...] = eqx.field(static=True)

    @property
    def share(self) -> Float[Array, " source"]:
        """What each source adds to the mean square (source,) [m²/s⁴].

        It is exact for `factor` 0, and for another one as far as the mean square is
        quadratic in the source.
        """
        return (self.mean_square - self.smaller) / (1.0 - self.factor**2)

    @property
    def ranking(self) -> tuple[str, ...]:
        """Sources, the one to tighten first in front."""
        return self._ranked(self.share)

    @property
    def ranking_by_gradient(self) -> tuple[str, ...]:
        """Likewise by the derivatives."""
        if self.by_gradient is None:
            raise ValueError("Shares: the derivatives were not asked for.")
        return self._ranked(self.by_gradient)

    def gain(self, factor: Any = 0.5) -> Float[Array, " source"]:
        """By how much the level falls if one source is tightened (source,) [dB].

        Args:
            factor: To which part of what it was [1].
        """
        left = self.mean_square - (1.0 - factor**2) * self.share
        one = REFERENCE_ACCELERATION
        root = jnp.sqrt(jnp.maximum(left, 0.0))
        return level(jnp.sqrt(self.mean_square), one) - level(root, one)

    def _ranked(self, values):
        return tuple(self.sources[k] for k in np.argsort(-np.asarray(values)))


def shares(
    model: NoiseModel,
    tolerances: Tolerances,
    n: int,
    key: Array,
    *,
    direction: int | None = None,
    factor: float = 0.0,
    gradient: bool = True,
    turns: int = 8,
    settle: int = 2,
    samples: int = 2048,
    steps: int | None = None,
    batch: int = 16,
    progress: Progress | None = None,
) -> Shares:
    """What every source of scatter adds to the mean square of the acceleration.

    The same random bearings run once as they are, once for every source with this one
    smaller, and once with derivatives.

    Args:
        model, tolerances, n, key, turns, settle, samples, steps, batch: As in
            `monte_carlo`.
        direction: 0, 1, 2 along x, y, z; `None`: all together.
        factor: By which a source is made smaller, from 0 (off) to below 1 [1]: 0.5
            tells exactly what halving brings.
        gradient: Whether shares by derivatives are wanted: about the time of five more
            runs.
        progress: Called after each batch.

    Raises:
        TypeError, ValueError: As `monte_carlo`; without any source; for another
            direction or factor.
        FloatingPointError: If no bearing has a result in all runs.
    """
    records = Records(model, tolerances, n, turns, settle, samples, steps, "shares")
    sources = tolerances.sources
    if not sources:
        raise ValueError("shares: `tolerances` is without a source; give at least one.")
    allowed = "0, 1, 2 or None"
    check("shares", "direction", direction in (None, 0, 1, 2), allowed, direction, "")
    check("shares", "factor", 0.0 <= factor < 1.0, "from 0 to below 1", factor, "")
    keys = jax.random.split(key, n)
    runs = [{}, *({name: factor} for name in sources)]
    whole = len(runs) + gradient
    done = 0

    def told(count, _):
        if progress is not None:
            progress(done + count, whole * n)

    squares, fine = [], np.ones(n, bool)
    for change in runs:
        found = [
            (np.asarray(_mean_square(a, direction))[:part], np.asarray(r)[:part])
            for part, a, r in records.batches(keys, batch, told, change)
        ]
        square, result = (np.concatenate(a) for a in zip(*found, strict=True))
        fine &= result == int(Result.CONVERGED)
        squares.append(square)
        done += n
    slopes = []
    if gradient:
        for part, at in records.parts(n, batch):
            slope = _slopes(*records.given, keys[at], records.counts, direction)
            slopes.append([slope[name][:part] for name in sources])
            told(min(len(slopes) * batch, n), n)
    if not fine.any():
        raise FloatingPointError(
            f"shares: of {n} bearings none has a result in all runs; see the codes of"
            " `monte_carlo`."
        )
    mean = jnp.asarray(np.mean(np.array(squares)[:, fine], axis=1))
    by_gradient = None
    if gradient:
        every = np.concatenate(slopes, axis=1)
        by_gradient = jnp.asarray(0.5 * np.mean(every[:, fine], axis=1))
    return Shares(
        mean[0],
        mean[1:],
        by_gradient,
        jnp.asarray(factor, mean.dtype),
        int(fine.sum()),
        sources,
    )


def _mean_square(acceleration, direction):
    """Of records (..., time, 3) about their means (...)."""
    each = jnp.var(acceleration, axis=-2)
    return jnp.sum(each, axis=-1) if direction is None else each[..., direction]


@eqx.filter_jit
def _slopes(model, tolerances, keys, counts, direction):
    """Derivatives of every bearing's mean square by the sources' scales."""
    turns, settle, samples, steps = counts
    one = jnp.ones((), model.mass.dtype)
    factors = {name: one for name in tolerances.sources}

    def square(factors, key):
        found = vibration(
            drawn(model, tolerances.scaled(factors), key),
            turns=turns,
            settle=settle,
            samples=samples,
            steps=steps,
            throw=False,
        )
        return _mean_square(found.acceleration[:, :3], direction)

    return jax.vmap(jax.grad(square), in_axes=(None, 0))(factors, keys)

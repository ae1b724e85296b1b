"""Distributions of numbers that differ from machine to machine, and their samples."""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float

from ..design import rows_of
from ..design.checks import must_be, of_class
from ..fits import radial_clearance
from ..statics import Installed

SIZES = {
    "clearance": {"radial_clearance": 1.0},
    "shaft": {"shaft_interference": 1.0},
    "bore": {"shaft_interference": -1.0},
    "housing": {"housing_interference": -1.0},
    "outside_diameter": {"housing_interference": 1.0},
}
"""Sizes of `fits.SizeLimits` by their name in [fit], with the factors by which they add
to numbers of a `Mounting`."""
REPLICATES = 8
"""Independently scrambled sets of samples, whose spread gives the standard errors."""
SIGMAS = 6.0
"""Standard deviations between the limits of a tolerance: 99.7 % of the normal
distribution lies within them before it is truncated."""


@dataclasses.dataclass(frozen=True)
class Scatter:
    """A number of the design that scatters, with its distribution.

    Attributes:
        path: Dotted path in the design, as in `optimise.Variable`; a tuple of paths
            that share the value; or a mapping of factors by path. Where scatters have a
            path in common, its number is the sum of factors times values, as an
            interference is the deviation of the shaft minus that of the bore.
        distribution: Frozen distribution of `scipy.stats` for the values [SI], such as
            `norm(300.0, 40.0)` or `truncated_normal(lower, upper)`.
        name: Name in reports; by default the first path.
        cost: Cost of narrowing the tolerance by one SI unit of width, in any currency;
            `None`: it cannot be narrowed.

    Raises:
        TypeError: If a path is not a string, or the distribution not one of SciPy.
        ValueError: If mean or standard deviation is not finite, or a cost is negative.
    """

    path: Any  # a text, several, or factors by path; afterwards factors by path
    distribution: Any
    name: str = ""
    cost: float | None = None

    def __post_init__(self):
        given = self.path if isinstance(self.path, Mapping | tuple) else (self.path,)
        factors = given if isinstance(given, Mapping) else dict.fromkeys(given, 1.0)
        texts = bool(factors) and all(isinstance(p, str) and p for p in factors)
        allowed = "a dotted text, several of them, or factors by such texts"
        must_be("Scatter", "path", self.path, texts, allowed, TypeError)
        object.__setattr__(self, "path", {p: float(f) for p, f in factors.items()})
        object.__setattr__(self, "name", self.name or next(iter(factors)))
        known, allowed = hasattr(self.distribution, "ppf"), "a distribution of SciPy"
        must_be("Scatter", "distribution", self.distribution, known, allowed, TypeError)
        real = math.isfinite(self.centre) and 0.0 < self.spread < math.inf
        allowed = "one with a mean, and a standard deviation above 0"
        must_be("Scatter", "distribution", self.name, real, allowed)
        paid = self.cost is None or self.cost >= 0.0
        must_be("Scatter", "cost", self.cost, paid, "at least 0")

    @property
    def centre(self) -> float:
        """Mean [SI]."""
        return float(self.distribution.mean())

    @property
    def spread(self) -> float:
        """Standard deviation [SI]."""
        return float(self.distribution.std())

    @property
    def ends(self) -> tuple[float, float]:
        """Smallest and largest value [SI]; unbounded: three deviations off the mean."""
        far = 0.5 * SIGMAS * self.spread
        low, high = map(float, self.distribution.support())
        low = low if math.isfinite(low) else self.centre - far
        return low, high if math.isfinite(high) else self.centre + far

    @property
    def width(self) -> float:
        """Width of the tolerance, between its ends [SI]."""
        return self.ends[1] - self.ends[0]


def truncated_normal(
    lower: float,
    upper: float,
    mean: float | None = None,
    deviation: float | None = None,
) -> Any:
    """Return a normal distribution truncated at the limits of a tolerance.

    Args:
        lower, upper: Limits of the values [SI].
        mean: Mean before truncation [SI]; `None`: the middle.
        deviation: Standard deviation before truncation [SI]; `None`: a sixth of the
            width.

    Raises:
        ValueError: If the limits do not ascend, or the deviation is not above 0.
    """
    from scipy.stats import truncnorm

    own = "truncated_normal"
    must_be(own, "lower", lower, lower < upper, f"below `upper`, {upper:g}")
    middle = 0.5 * (lower + upper) if mean is None else mean
    scale = (upper - lower) / SIGMAS if deviation is None else deviation
    must_be(own, "deviation", scale, scale > 0.0, "above 0")
    ends = ((end - middle) / scale for end in (lower, upper))
    return truncnorm(*ends, loc=middle, scale=scale)


def class_scatters(installed: Installed) -> tuple[Installed, tuple[Scatter, ...]]:
    """Return the scatters of the toleranced sizes of a bearing and its seats.

    Args:
        installed: The bearing on its seats, with `limits` of its sizes (ISO 286-2, ISO
            492, ISO 5753-1).

    Returns:
        The bearing, with its clearance before mounting as a number of its mounting if
        that scatters; and a `truncated_normal` `Scatter` of each size: "clearance",
        "shaft", "bore", "housing", "outside_diameter". None without `limits`.

    Raises:
        TypeError: If `installed` is not an `Installed`.
    """
    of_class("class_scatters", "installed", installed, Installed, "an Installed")
    found = []
    limits = {} if installed.limits is None else installed.limits._asdict()
    for name, (low, high) in limits.items():
        if low < high:
            paths = {f"mounting.{path}": factor for path, factor in SIZES[name].items()}
            spread = truncated_normal(float(low), float(high))
            found.append(Scatter(paths, spread, name))
    if any(one.name == "clearance" for one in found):
        free = radial_clearance(rows_of(installed.drawing.bearing)[0].bearing)
        installed = eqx.tree_at(
            lambda one: one.mounting.radial_clearance,
            installed,
            np.asarray(free, float),
            is_leaf=lambda leaf: leaf is None,
        )
    return installed, tuple(found)


def draw_samples(
    scatters: Sequence[Scatter],
    root: Float[np.ndarray, "number number"],
    count: int,
    seed: int,
) -> Float[np.ndarray, "sample number"]:
    """Return samples of numbers that scatter, from scrambled Sobol points.

    Args:
        scatters: Numbers that scatter.
        root: Cholesky factor of the correlations of their normal scores.
        count: Smallest number of samples; `REPLICATES` sets are drawn one after the
            other, the size of each is a power of 2.
        seed: Seed of the scrambling.

    Source: Owen, Scrambled net variance for integrals of smooth functions, Ann.
        Statist. 25 (1997) 1541-1562; Gaussian copula: Nataf (1962).
    """
    from scipy.special import ndtr, ndtri
    from scipy.stats import qmc

    power, sets = max(0, math.ceil(math.log2(count / REPLICATES))), []
    for source in np.random.default_rng(seed).spawn(REPLICATES):
        points = qmc.Sobol(len(scatters), rng=source).random_base2(power)
        # The normal scores of 0 and 1 are infinite.
        sets.append(ndtr(ndtri(np.clip(points, 1e-9, 1.0 - 1e-9)) @ root.T))
    shares = np.concatenate(sets).T
    pairs = zip(scatters, shares, strict=True)
    return np.stack([one.distribution.ppf(share) for one, share in pairs], axis=1)

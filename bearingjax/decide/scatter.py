"""Numbers that scatter from one machine to the next, and samples of them."""

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
"""Sizes of `fits.SizeLimits` by their name in [fit], with the numbers of a `Mounting`
to which they add."""
REPLICATES = 8
"""Sets of samples, each shuffled by itself, whose spread is the error of a result."""
SIGMAS = 6.0
"""Standard deviations of a normal distribution from limit to limit: 99.7 % of what is
made lies between them before the rest is sorted out."""


@dataclasses.dataclass(frozen=True)
class Scatter:
    """A number of the design that scatters.

    Attributes:
        path: Dotted path in the design, as of `optimise.Variable`; a tuple of several
            that share the value; or factors by path: what it adds to each. The number
            of a path that several scatters name is the sum of what they add, as an
            interference is the deviation of the shaft less that of the bore.
        distribution: Distribution of its values [SI], frozen, of `scipy.stats`, such as
            `norm(300.0, 40.0)`, or that of `within`.
        name: In reports; default: the first path.
        cost: What narrowing its width by one SI unit costs, in any currency; `None`:
            it cannot be narrowed.

    Raises:
        TypeError: If a path is no text, or the distribution is none.
        ValueError: Without a spread, and for a cost below zero.
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
        must_be("Scatter", "distribution", self.name, known, allowed, TypeError)
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
        """Least and largest value; three standard deviations where there is none."""
        far = 0.5 * SIGMAS * self.spread
        low, high = map(float, self.distribution.support())
        low = low if math.isfinite(low) else self.centre - far
        return low, high if math.isfinite(high) else self.centre + far

    @property
    def width(self) -> float:
        """Width between its ends [SI]."""
        return self.ends[1] - self.ends[0]


def within(
    lower: float,
    upper: float,
    mean: float | None = None,
    deviation: float | None = None,
) -> Any:
    """Return the normal distribution between limits, as those of a tolerance class.

    Args:
        lower, upper: Limits at which it is cut off [SI].
        mean: Mean before it is cut off [SI]; `None`: the middle.
        deviation: Standard deviation before it is cut off [SI]; `None`: a sixth of the
            width.

    Raises:
        ValueError: If the limits do not ascend, or the deviation is not above 0.
    """
    from scipy.stats import truncnorm

    must_be("within", "lower", lower, lower < upper, f"below `upper`, {upper:g}")
    middle = 0.5 * (lower + upper) if mean is None else mean
    scale = (upper - lower) / SIGMAS if deviation is None else deviation
    must_be("within", "deviation", scale, scale > 0.0, "above 0")
    ends = ((end - middle) / scale for end in (lower, upper))
    return truncnorm(*ends, loc=middle, scale=scale)


def class_scatters(installed: Installed) -> tuple[Installed, tuple[Scatter, ...]]:
    """Return the sizes of the classes of fit and clearance of a bearing, as `within`.

    Args:
        installed: The bearing on its seats; sizes scatter between its `limits`.

    Returns:
        The bearing, whose clearance before mounting is a number of its mounting if it
        scatters; and the sizes, named "clearance", "shaft", "bore", "housing" and
        "outside_diameter". There are none without `limits`.

    Raises:
        TypeError: If it is no `Installed`.
    """
    of_class("class_scatters", "installed", installed, Installed, "an Installed")
    found = []
    limits = {} if installed.limits is None else installed.limits._asdict()
    for name, (low, high) in limits.items():
        if low < high:
            paths = {f"mounting.{path}": factor for path, factor in SIZES[name].items()}
            found.append(Scatter(paths, within(float(low), float(high)), name))
    if any(one.name == "clearance" for one in found):
        free = radial_clearance(rows_of(installed.drawing.bearing)[0].bearing)
        installed = eqx.tree_at(
            lambda one: one.mounting.radial_clearance,
            installed,
            np.asarray(free, float),
            is_leaf=lambda leaf: leaf is None,
        )
    return installed, tuple(found)


def draw(
    scatters: Sequence[Scatter],
    root: Float[np.ndarray, "number number"],
    count: int,
    seed: int,
) -> Float[np.ndarray, "sample number"]:
    """Draw samples of numbers that scatter: Sobol's points, shuffled.

    Args:
        scatters: The numbers.
        root: Cholesky factor of the correlations of the normal scores behind them.
        count: Least number of samples; drawn are `REPLICATES` sets one after the other,
            each of a power of 2.
        seed: Seed of the shuffling.

    Source: Owen, Scrambled net variance for integrals of smooth functions, Ann.
        Statist. 25 (1997) 1541-1562.
    """
    from scipy.special import ndtr, ndtri
    from scipy.stats import qmc

    power, sets = max(0, math.ceil(math.log2(count / REPLICATES))), []
    for source in np.random.default_rng(seed).spawn(REPLICATES):
        points = qmc.Sobol(len(scatters), rng=source).random_base2(power)
        # 0 and 1 are at infinity of a normal number.
        sets.append(ndtr(ndtri(np.clip(points, 1e-9, 1.0 - 1e-9)) @ root.T))
    shares = np.concatenate(sets).T
    pairs = zip(scatters, shares, strict=True)
    return np.stack([one.distribution.ppf(share) for one, share in pairs], axis=1)

"""Tolerance analysis: quantiles, probability of failing a requirement, variance shares.

Samples of all numbers that scatter are solved in batches by one program. Beside their
statistics stand those of the first-order second-moment method, from the gradient at the
mean. The probability of failing a requirement has derivatives with respect to the width
of each tolerance: the requirement is smoothed over a small part of the spread of its
measure, and samples near it contribute their exact gradients.
"""

import dataclasses
import functools
from collections.abc import Callable, Sequence
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from ..cases.cases import Cases
from ..design.checks import all_of_class, count, must_be
from ..element import RINGS
from ..life import LifeConditions
from ..numerics.compiled.programs import program
from ..numerics.result import Result, SolveError
from ..numerics.shown import Shown
from ..numerics.units import unit
from ..numerics.warning import Warning, warnings_of
from ..optimise import Constraint
from ..optimise.design_problem import judge
from ..optimise.life import OfLife
from ..optimise.measure import AbstractMeasure, label_of
from ..optimise.search import search_least
from ..optimise.system import AbstractSystem, Design, check_design, prepare, solved_case
from ..optimise.trials import Trial, Trials
from ..optimise.variable import Variable, check_same_in_cases, with_numbers
from ..statics import SolveOptions, Support
from ..statics.support import RESTRAINED, check_held
from .predict import CaseModel
from .scatter import REPLICATES, Scatter, draw_samples

QUANTILES = (0.01, 0.1, 0.5, 0.9, 0.99)
"""Probabilities of the quantiles that are reported [1]."""
_BATCH, _MACHINES, _SLOPES = 256, 16, 64
"""Cases in a batch: of a bearing, of a system of shafts, of either with gradients."""
_BLOCK = 32
"""Batches in one call of the program."""
_NEAR = 512
"""Largest number of samples near a requirement whose gradients are computed."""
_SMOOTHING = 0.9
"""Width over which a requirement is smoothed, over the deviation of its measure and
n^(-1/5) of n samples (Silverman, Density Estimation, 1986, eq. 3.31) [1]."""
_FAR = 4.0
"""Distance from a requirement beyond which a sample has no gradient [widths]."""
_DEGREE, _SAMPLES_OF_DEGREE = 8, 32
"""Highest degree of the polynomials of one number in the regression of a measure, and
number of samples that each degree needs."""


@dataclasses.dataclass(frozen=True)
class Spread(Shown):
    """Distribution of one measure over all samples that were solved.

    Attributes:
        name: Name of the measure.
        unit: SI unit of the measure; empty where there is none, or it is not known.
        mean: Mean [unit].
        deviation: Standard deviation [unit].
        quantiles: Quantiles of 1, 10, 50, 90 and 99 % (quantile,) [unit].
        errors: Standard errors of mean, deviation and quantiles (2 + quantile,) [unit],
            from the sets of samples.
        first_order: Mean and standard deviation by the first-order second-moment
            method, from value and gradient at the mean of all numbers [unit].
        shares: Share of the variance that each number causes alone, Sobol's first-order
            index (number,) [1]; the rest to 1 is due to interactions.
        first_order_shares: Variance shares by the gradient alone (number,) [1].
        slopes: Gradient at the mean (number,) [unit over SI].
        misses: Share of all samples that fail its requirement [1]; `None`: no such.
    """

    name: str
    unit: str
    mean: float
    deviation: float
    quantiles: np.ndarray
    errors: np.ndarray
    first_order: tuple[float, float]
    shares: np.ndarray
    first_order_shares: np.ndarray
    slopes: np.ndarray
    misses: float | None


@dataclasses.dataclass(frozen=True)
class Misses(Shown):
    """Probability of failing a requirement, and its derivatives by the tolerances.

    Attributes:
        share: Share of the samples that fail one or several requirements, unsolved ones
            among them [1].
        error: Standard error of the share [1].
        smoothed: Probability with smoothed requirements, of which the derivatives are
            taken [1].
        by_width: Derivative by the width of each tolerance, times that width (number,)
            [1]: a width a tenth smaller lowers the probability by a tenth of this.
        by_middle: Derivative by the middle of each tolerance, times its width (number,)
            [1].
        errors: Standard errors of `by_width`, without the effect of smoothing (number,)
            [1].
    """

    share: float
    error: float
    smoothed: float
    by_width: np.ndarray
    by_middle: np.ndarray
    errors: np.ndarray


@dataclasses.dataclass(frozen=True)
class Tolerances(Shown):
    """Results of `tolerances`.

    Attributes:
        scatters: Numbers that scatter.
        spreads: Distribution of each measure.
        misses: Probability of failing a requirement; `None` without requirements.
        samples: Values of the numbers (sample, number) [SI].
        values: Values of the measures (sample, measure) [SI]; NaN for unsolved samples.
        result: `Result` code of each sample (sample,).
        warnings: Warnings about the design at the mean of all numbers.
    """

    scatters: tuple[Scatter, ...] = dataclasses.field(repr=False)
    spreads: tuple[Spread, ...]
    misses: Misses | None
    samples: Annotated[Float[np.ndarray, "sample number"], unit("SI")]
    values: Annotated[Float[np.ndarray, "sample measure"], unit("SI")]
    result: Int[np.ndarray, " sample"]
    warnings: list[Warning] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(frozen=True)
class Tightening(Shown):
    """Cheapest tolerances that keep a probability of failing a requirement.

    Attributes:
        widths: Width of each tolerance over the given width (number,) [1].
        cost: Cost of narrowing, in the currency of the scatters.
        before: Share of failing samples with the given widths [1].
        after: Share of failing samples with the narrowed widths [1].
        error: Standard error of `after` [1].
        converged: Whether the search found a minimum.
        message: How the search ended, in words.
    """

    widths: Float[np.ndarray, " number"]
    cost: float
    before: float
    after: float
    error: float
    converged: bool
    message: str


def tolerances(
    element: Design,
    cases: Any,
    scatters: Sequence[Scatter],
    measures: Sequence[Any],
    **options: Any,
) -> Tolerances:
    """Solve samples of a design whose numbers scatter, and return their distributions.

    Args:
        element: The design (`BearingElement`, `Installed` or a system), as in
            `optimise`.
        cases: Its operating cases.
        scatters: Numbers that scatter, independent except for `correlation`.
        measures: Measures, as in `optimise`; within a `Constraint` it is a requirement.
        **options: `samples`: smallest number of samples (default 10 000), rounded up to
            8 times a power of 2; `seed` of the samples (0); `correlation`: matrix of
            all numbers (number, number), of their normal scores if they are not normal
            (none); `support`: support of the rings, with displacements by the cases
            (`statics.Support()`); `solve`: `SolveOptions`; `build`: function from the
            changed design to that which is solved; `progress`: function called between
            batches with the share done; `life`: conditions of the rating life for the
            warnings, by default those of a measure.

    Returns:
        Tolerances. Unsolved samples count as failing, and in no other statistic.

    Raises:
        TypeError, ValueError: For wrong numbers, measures or cases, numbers that the
            design does not allow at an end of their range, and correlations that
            contradict each other.
        SolveError: If the design at the mean of all numbers does not solve.

    Source: First-order second-moment method: JCGM 100 (2008), eq. 13. Variance shares:
        Sobol, Math. Comput. Simul. 55 (2001) 271, by regression as Sudret, Reliab. Eng.
        Syst. Saf. 93 (2008) 964.
    """
    sampled = Sampled(element, cases, scatters, measures, **options)
    return sampled.conclude(*sampled.run())


def tighten(
    element: Design,
    cases: Any,
    scatters: Sequence[Scatter],
    measures: Sequence[Any],
    most_misses: float,
    *,
    narrowest: float = 0.2,
    max_steps: int = 30,
    **options: Any,
) -> Tightening:
    """Find the cheapest tolerances that keep a probability of failing a requirement.

    Narrowed tolerances keep their mean. The search (SLSQP) scales one set of samples,
    with smoothed requirements; `before` and `after` are counted in other samples.

    Args:
        element, cases: The design and its operating cases.
        scatters: Numbers that scatter; those with a `cost` may be narrowed.
        measures: Measures; at least one of them is in a `Constraint`.
        most_misses: Largest probability of failing a requirement [1].
        narrowest: Smallest width over the given width [1].
        max_steps: Step limit of the search.
        **options: The options of `tolerances`.

    Raises:
        TypeError, ValueError, SolveError: As `tolerances`; ValueError also without
            costs or requirements, and for shares that are not between 0 and 1.
    """
    sampled = Sampled(element, cases, scatters, measures, **options)
    free = np.array([one.cost is not None for one in scatters])
    names = [one.name for one in scatters]
    must_be(
        "tighten", "scatters", names, bool(free.any()), "such that one has a `cost`"
    )
    must_be("tighten", "measures", measures, bool(sampled.bounds), "with a Constraint")
    for name, share in (("most_misses", most_misses), ("narrowest", narrowest)):
        inside = bool(0.0 < share < 1.0)
        must_be("tighten", name, share, inside, "above 0 and below 1")
    price = np.array([(one.cost or 0.0) * one.width for one in scatters])[free]
    whole = price.sum() or 1.0

    def widths_at(unit):
        widths = np.ones(free.size)
        widths[free] = narrowest + (1.0 - narrowest) * unit
        return widths

    def evaluate(unit, slopes):
        widths = widths_at(unit)
        found = sampled.misses(*sampled.run(widths))
        slope = found.by_width[free] / widths[free] * (1.0 - narrowest) / most_misses
        margin = np.array([1.0 - found.smoothed / most_misses])
        paid = float(price @ (1.0 - unit)) / whole
        return Trial(np.asarray(unit), paid, -price / whole, margin, -slope[None])

    trials = Trials(evaluate, evaluate(np.ones(price.size), True))
    ending = search_least("slsqp", trials, 1, max_steps, 1e-3)
    widths = widths_at(ending.unit)
    first, last = (sampled.misses(*sampled.run(w, 1)) for w in (1.0, widths))
    paid, text = float(price @ (1.0 - widths[free])), ending.text
    if not ending.converged:
        least = sampled.misses(*sampled.run(widths_at(np.zeros(price.size)))).smoothed
        if least > most_misses:
            text = f"no widths reach it: of the narrowest {100.0 * least:.3g} % miss"
    return Tightening(
        widths, paid, first.share, last.share, last.error, ending.converged, text
    )


class Bounds(NamedTuple):
    """Requirement on a measure: its limits [SI], infinite where there is none."""

    measure: int
    lower: float
    upper: float

    def are_missed(self, values: np.ndarray) -> np.ndarray:
        """Return whether each sample is beyond a limit, as NaN is (sample,)."""
        one = values[:, self.measure]
        return ~((one >= self.lower) & (one <= self.upper))

    def smooth(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the smoothed miss of each sample, from 0 to 1, and its derivative by
        the measure (sample,)."""
        from scipy.stats import norm

        one = values[:, self.measure]
        known = np.isfinite(one)
        width = _SMOOTHING * float(np.std(one[known])) * known.sum() ** -0.2 or 1.0
        found, pull = np.zeros((2, one.size))
        for sign, limit in ((1.0, self.upper), (-1.0, self.lower)):
            if np.isfinite(limit):
                beyond = sign * (np.where(known, one, limit) - limit) / width
                found += norm.cdf(beyond)
                near = np.abs(beyond) < _FAR
                pull += np.where(near, sign * norm.pdf(beyond) / width, 0.0)
        return found, pull


class Sampled:
    """Samples of a design whose numbers scatter; arguments and errors: `tolerances`."""

    def __init__(
        self,
        element: Design,
        cases: Any,
        scatters: Sequence[Scatter],
        measures: Sequence[Any],
        *,
        samples: int = 10_000,
        seed: int = 0,
        correlation: Any = None,
        support: Support = RESTRAINED,
        solve: SolveOptions | None = None,
        build: Callable[[Any], Any] | None = None,
        progress: Callable[[float], Any] | None = None,
        life: LifeConditions | None = None,
    ):
        owner = "tolerances"
        count(owner, "samples", samples)
        check_design(owner, element, cases)
        self.scatters, n = tuple(scatters), len(scatters)
        all_of_class(owner, "scatters", self.scatters, Scatter, "Scatters")
        names = [one.name for one in self.scatters]
        alone = n > 0 and len(set(names)) == n
        must_be(owner, "scatters", names, alone, "one at least, of unlike names")
        must_be(owner, "measures", measures, bool(measures), "one at least")
        if isinstance(cases, Cases):
            support.check_for_cases(owner)
            check_held(owner, cases.load, support, cases.prescribed)
        self.correlation = np.eye(n) if correlation is None else np.array(correlation)
        try:
            root = np.linalg.cholesky(self.correlation)
            fits = root.shape == (n, n) and np.allclose(np.diag(self.correlation), 1.0)
        except np.linalg.LinAlgError:
            root, fits = np.eye(n), False
        allowed = f"({n}, {n}), 1 along the diagonal and positive definite"
        must_be(owner, "correlation", correlation, fits, allowed)
        self._draw = lambda k: draw_samples(self.scatters, root, samples, seed + k)
        self._progress, self._life = progress, life
        self.bounds, self.measures = [], ()
        for k, one in enumerate(measures):
            if isinstance(one, Constraint):
                low = -np.inf if one.lower is None else float(one.lower)
                high = np.inf if one.upper is None else float(one.upper)
                self.bounds.append(Bounds(k, low, high))
            self.measures += (one.measure if isinstance(one, Constraint) else one,)
        check_same_in_cases(owner, self.scatters, cases)
        paths = tuple(dict.fromkeys(p for one in self.scatters for p in one.path))
        factors = np.array([[s.path.get(p, 0.0) for s in self.scatters] for p in paths])
        self.centre = np.array([one.centre for one in self.scatters])
        self._widths = np.array([one.width for one in self.scatters])
        _check_ends(element, self.scatters, self.centre, paths, factors)
        solves = support, SolveOptions() if solve is None else solve
        cases = jax.tree.map(jnp.asarray, cases)
        self._given = (
            *(element, cases, self.measures),
            *((paths, jnp.asarray(factors)), solves, build),
        )
        self._starts: Any = None
        self._several = isinstance(element, AbstractSystem)
        most = {False: _MACHINES if self._several else _BATCH, True: _SLOPES}
        self._batches = {k: max(1, n // cases.count) for k, n in most.items()}

    def run(
        self, widths: Any = 1.0, seed: int = 0
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return samples, their measures, NaN where unsolved, and result codes.

        Args:
            widths: Widths of the tolerances over the given widths (number,) [1].
            seed: Number added to the seed of the samples.
        """
        samples = self.centre + widths * (self._draw(seed) - self.centre)
        return samples, *self.solve(samples, False)[:2]

    @functools.cached_property
    def middle(self) -> tuple[Any, Any, Any]:
        """Measures, result code and gradient at the mean of all numbers."""
        values, result, gradient = self.solve(self.centre[None], True)
        return values[0], result[0], gradient[0]

    def solve(self, samples: np.ndarray, slopes: bool) -> tuple[Any, Any, Any]:
        """Return measures (sample, measure), result codes (sample,) and gradients
        (sample, measure, number), or `None` without `slopes`.

        Load solves start from the displacements at the mean of all numbers; those that
        fail are repeated from first contact."""
        contact = np.full((self._given[1].count, 6), np.nan)
        if self._starts is None:
            self._starts = contact  # all that a system needs
            if not self._several:
                self._starts = self._solve_from(contact, self.centre[None], True)[0][0]
        _, *found = self._solve_from(self._starts, samples, slopes)
        failed = np.flatnonzero(found[1])
        if failed.size and not self._several:
            _, *again = self._solve_from(contact, samples[failed], slopes)
            pairs = zip(jax.tree.leaves(found), jax.tree.leaves(again), strict=True)
            for every, new in pairs:
                every[failed] = new
        values, result, gradient = found
        return np.where(result[:, None] == 0, values, np.nan), result, gradient

    def _solve_from(self, starts, samples, slopes) -> Any:
        """Return displacements of the moving ring (sample, case, 6) [m, rad] and what
        `solve` returns, starting from displacements (case, 6) [m, rad]."""
        run = _solve_few if slopes or self._several else _solve_many
        found, batch = [], self._batches[slopes]
        # Samples with gradients have one shape, so that their program compiles once.
        size = batch * (1 if slopes else min(_BLOCK, -(-len(samples) // batch)))
        for begin in range(0, len(samples), size):
            part = samples[begin : begin + size]
            filled = jnp.asarray(np.resize(part, (size, part.shape[1])))
            out = run(*self._given, jnp.asarray(starts), filled, batch, slopes)
            found.append(jax.tree.map(np.asarray, out))
            if self._progress is not None and not slopes:
                self._progress(min(1.0, (begin + size) / len(samples)))
        return jax.tree.map(
            lambda *parts: np.concatenate(parts)[: len(samples)], *found
        )

    def conclude(
        self, samples: np.ndarray, values: np.ndarray, result: np.ndarray
    ) -> Tolerances:
        """Return the results of solved samples, as from `run`."""
        middle, code, slopes = self.middle
        if code != Result.CONVERGED:
            label = Result(int(code)).label
            raise SolveError(f"tolerances: the design at the mean fails: {label}")
        spreads = tuple(
            self._spread(k, samples, values, middle[k], slopes[k])
            for k in range(len(self.measures))
        )
        misses = self.misses(samples, values, result) if self.bounds else None
        told = self._warnings()
        return Tolerances(self.scatters, spreads, misses, samples, values, result, told)

    def _warnings(self) -> list[Warning]:
        """Warnings about the cases of the design at the mean of all numbers."""
        element, cases, measures, (paths, factors), solves, build = self._given
        middle = dict(zip(paths, np.asarray(factors) @ self.centre, strict=True))
        design = with_numbers(element, middle)
        own = (one.conditions for one in measures if isinstance(one, OfLife))
        life = next(own, None) if self._life is None else self._life
        model = CaseModel(design if build is None else build(design), *solves, life)
        return warnings_of("at the mean", model.warnings((), cases))

    def _spread(self, k, samples, values, middle, slope) -> Spread:
        measure, column = self.measures[k], values[:, k]
        known = np.isfinite(column)
        if not known.any():
            raise SolveError("tolerances: no sample was solved")
        effect = slope * [one.spread for one in self.scatters]
        variance = float(effect @ self.correlation @ effect)
        sets = [part[np.isfinite(part)] for part in np.split(column, REPLICATES)]
        each = [_statistics(part) for part in sets if part.size]
        mean, deviation, *quantiles = _statistics(column[known])
        missed = [b.are_missed(values).mean() for b in self.bounds if b.measure == k]
        return Spread(
            label_of(measure),
            measure.unit if isinstance(measure, AbstractMeasure) else "",
            mean,
            deviation,
            np.array(quantiles),
            _standard_error(each),
            (float(middle), variance**0.5),
            _variance_shares(samples[known], column[known]),
            effect**2 / (variance or 1.0),
            slope,
            float(missed[0]) if missed else None,
        )

    def misses(
        self, samples: np.ndarray, values: np.ndarray, result: np.ndarray
    ) -> Misses:
        """Return probability of failing and its derivatives, of samples from `run`."""
        failed = result != Result.CONVERGED
        missed = failed | np.any([b.are_missed(values) for b in self.bounds], axis=0)
        smooth = [bound.smooth(values) for bound in self.bounds]
        kept = np.prod([1.0 - one for one, _ in smooth], axis=0) * ~failed
        # Derivative of a sample's failing by each measure, by the product rule.
        pulls = np.zeros_like(values)
        for j, (bound, (_, pull)) in enumerate(zip(self.bounds, smooth, strict=True)):
            others = [1.0 - one for i, (one, _) in enumerate(smooth) if i != j]
            pulls[:, bound.measure] += pull * np.prod(others, axis=0) * ~failed
        # The gradient at the mean gives most of the change, of all samples (a control
        # variate); those of some samples near the requirements give the rest.
        around = pulls @ np.nan_to_num(self.middle[2])
        ways = samples - self.centre, np.broadcast_to(self._widths, samples.shape)
        offset, changes = np.stack(ways, axis=1), []
        for part in np.split(np.arange(len(samples)), REPLICATES):
            changes.append(np.mean(around[part, None] * offset[part], axis=0))
            near = part[np.any(pulls[part], axis=1)]
            if near.size:
                # Taken evenly from one side of the requirements to the other.
                near = near[np.argsort(pulls[near].sum(axis=1), kind="stable")]
                count = min(near.size, _NEAR // REPLICATES)
                taken = near[np.linspace(0, near.size - 1, count).astype(int)]
                gradient = self.solve(samples[taken], True)[2]
                rest = np.einsum("sm,smn->sn", pulls[taken], gradient) - around[taken]
                mean = np.mean(rest[:, None] * offset[taken], axis=0)
                changes[-1] += near.size / part.size * mean
        by_width, by_middle = np.mean(changes, axis=0)
        return Misses(
            float(missed.mean()),
            float(_standard_error([m.mean() for m in np.split(missed, REPLICATES)])),
            float(np.mean(1.0 - kept)),
            by_width,
            by_middle,
            _standard_error(changes)[0],
        )


def _check_ends(element, scatters, centre, paths, factors) -> None:
    """Raise unless the design allows each number at both ends of its range."""
    for path in paths:
        # Raises for a path that leads nowhere.
        Variable(path, -1e300, 1e300).start_in(element)
    for k, one in enumerate(scatters):
        for end in one.ends:
            values = np.where(np.arange(centre.size) == k, end, centre)
            try:
                numbers = dict(zip(paths, factors @ values, strict=True))
                with_numbers(element, numbers)
            except ValueError as error:
                raise ValueError(
                    f"Scatter: {one.name} may be {end:.6g}, which the design does not"
                    f" allow: {error}"
                ) from error


def _statistics(values: np.ndarray) -> list[float]:
    """Return mean, standard deviation and quantiles."""
    return [values.mean(), values.std(), *np.quantile(values, QUANTILES)]


def _standard_error(each: Any) -> Any:
    """Return the standard error of a statistic of all sets, from those of each."""
    return np.std(each, axis=0, ddof=min(1, len(each) - 1)) / len(each) ** 0.5


def _variance_shares(samples: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return Sobol's first-order index of each number (number,) [1]: the variance of
    the regression on polynomials of it over the whole, less the part due to chance."""
    variance, n, found = values.var(), len(values), []
    if variance == 0.0:
        return np.zeros(samples.shape[1])
    degree = min(_DEGREE, max(1, n // _SAMPLES_OF_DEGREE))
    for column in samples.T:
        inside = (column - column.min()) / (np.ptp(column) or 1.0)
        powers = np.polynomial.legendre.legvander(2.0 * inside - 1.0, degree)
        rest = values - powers @ np.linalg.lstsq(powers, values, rcond=None)[0]
        left = np.mean(rest**2) * (n - 1) / max(1, n - 1 - degree)
        found.append(1.0 - left / variance)
    return np.clip(found, 0.0, 1.0)


def _solve(
    element, cases, measures, numbers, solves, build, starts, samples, batch, slopes
):
    (paths, factors), (support, options) = numbers, solves
    first = 6 * RINGS.index(support.moving_ring)

    def outputs(values):
        changed = with_numbers(element, dict(zip(paths, factors @ values, strict=True)))
        design = prepare(changed, build)

        def solve_from(case, start):
            return solved_case(design, case, support, options, start)

        solution = jax.vmap(solve_from)(cases, starts)
        exact, moved = judge(measures, cases, design, solution)[1], starts
        if not isinstance(design, AbstractSystem):
            moved = solution.displacement[:, first : first + 6]
        return exact, (moved, exact, jnp.max(solution.result))

    def solve_sample(values):
        if not slopes:
            return *outputs(values)[1], None
        gradient, found = jax.jacrev(outputs, has_aux=True)(values)
        return *found, gradient

    return jax.lax.map(solve_sample, samples, batch_size=batch)


@program(quick=True, level=1, what="samples within tolerances")
def _solve_many(*given):
    return _solve(*given)


# Gradients and systems take longer to compile than to solve their samples.
@program(quick=True, what="samples within tolerances")
def _solve_few(*given):
    return _solve(*given)

"""Estimates of numbers of a bearing from measurements, with their standard errors."""

import dataclasses
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from scipy import stats

from ..cases.cases import Cases
from ..design.checks import all_of_class, check, must_be, of_class, of_shape, positive
from ..numerics.compiled.programs import program
from ..numerics.result import SolveError
from ..numerics.shown import Shown, facts_of
from ..numerics.units import shown_change, shown_count, shown_number, unit_of
from ..numerics.warning import Warning
from ..optimise.system import Design, check_design
from ..optimise.variable import Variable, check_same_in_cases, check_variables
from .least_squares import CLOSE, Fit, least_squares
from .predict import CaseModel

STEP_LIMIT = 100
"""Largest number of evaluations in one search."""

FAINT = 0.03
"""Weight of the start values as faint readings, in ranges of the unknowns [1]: they fix
what the readings leave open, and hardly move any other estimate."""

UNTOLD = 0.5
"""Standard error, over the range between the bounds, from which a combination of
unknowns counts as not determined by the readings [1]."""

CURVED = 0.2
"""Departure from linearity at one standard error, over that error, from which a warning
says that intervals are approximate [1]."""

DOUBTFUL = 0.01
"""Tail probability of chi-square, on either side, below which a warning comes [1]."""

_REFITS = 3
"""Searches after the first one that estimate the size of unknown errors."""


class Candidate(NamedTuple):
    """A further reading that could be taken.

    Attributes:
        name: Name of the reading.
        case: Number of the case in which it is taken, from 0.
        drop: Share of the variance of the wanted number that it would take away [1];
            the mean share over several wanted numbers.
    """

    name: str
    case: int
    drop: float


@dataclasses.dataclass(frozen=True)
class Identified(Shown):
    """Estimates from measurements, with their uncertainty; returned by `identify`.

    Attributes:
        names: Names of the unknowns.
        units: SI units of the unknowns; empty where there is none, or it is not known.
        estimate: Estimated values (unknown,) [SI].
        standard_error: Standard errors of the estimates (unknown,) [SI]; infinite where
            the readings do not determine an unknown.
        interval: 95 % confidence intervals (unknown, 2) [SI], by the normal
            distribution if the errors are known, else by Student's t distribution.
        correlation: Correlation matrix of the estimates (unknown, unknown) [1].
        identifiable: Whether the readings determine all unknowns.
        untold: Combinations that the readings do not determine, in words; there the
            estimate is the one nearest to the start, in ranges between the bounds.
        singular_values: Singular values of the Jacobian of readings over their errors
            by unknowns over their ranges, in descending order (unknown,) [1].
        residual: Measured minus predicted values by name, NaN where not measured [SI].
        error: Standard deviations of the readings, by name [SI].
        prediction: Predicted values in all cases, by name (case,) [SI].
        prediction_error: Their standard errors, without those of a new reading [SI].
        chi_square: Sum of the squares of residuals over errors [1].
        degrees_of_freedom: Number of readings minus number of unknowns.
        probability: Probability of a chi-square at least as large by chance [1]; NaN
            where the errors are not known or no degree of freedom is left.
        error_scale: Factor on the given errors, estimated from the residuals if the
            errors are not known [1].
        nonlinearity: Largest departure of the readings from linearity at one standard
            error, over that error [1].
        candidates: Further readings, the most useful first.
        warnings: Warnings about fit, bounds, linearisation, and the solved cases.
        result: "converged", "step_limit" or "stalled".
        message: How the search ended, in words.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    estimate: np.ndarray
    standard_error: np.ndarray
    interval: np.ndarray
    correlation: np.ndarray
    identifiable: bool
    untold: tuple[str, ...]
    singular_values: np.ndarray
    residual: dict[str, np.ndarray]
    error: dict[str, np.ndarray]
    prediction: dict[str, np.ndarray]
    prediction_error: dict[str, np.ndarray]
    chi_square: float
    degrees_of_freedom: int
    probability: float
    error_scale: float
    nonlinearity: float
    candidates: tuple[Candidate, ...] = dataclasses.field(repr=False)
    warnings: list[Warning]
    result: str
    message: str

    @property
    def converged(self) -> bool:
        """Whether `result` is "converged"."""
        return self.result == "converged"

    def shown_facts(self) -> Iterator[Any]:
        """Yield estimates with standard errors, open combinations, warnings and fit."""
        rows = self.names, self.estimate, self.standard_error, self.units
        for name, value, error, unit in zip(*rows, strict=True):
            text = f"{shown_number(value, unit)} ± {shown_change(error, unit)}"
            yield 1, name, text, "estimate, standard error"
        for text in (*self.untold, *map(str, self.warnings)):
            name = "not determined" if text in self.untold else "warning"
            yield 1, name, text, ""
        yield from facts_of(
            self, ("identifiable", "chi_square", "degrees_of_freedom", "message")
        )


def identify(
    model: Design | CaseModel | Callable[[Any, Any], Any],
    cases: Any,
    unknowns: Sequence[Variable],
    readings: Any,
    errors: Any = None,
    *,
    wanted: Sequence[str] = (),
    candidates: Mapping[str, float] | None = None,
    known_errors: bool = True,
) -> Identified:
    """Estimate unknown numbers of a design from measurements, with standard errors.

    Minimises the sum of squares of residuals over errors within the bounds, by the
    Levenberg-Marquardt method with exact Jacobians (implicit function theorem, forward
    mode). A step to where a measured case does not solve is rejected. Standard errors,
    correlations and prediction bands are those of the problem linearised at the
    estimate; `nonlinearity` measures how far that holds.

    Args:
        model: The design (`BearingElement`, `Installed` or a system); a `CaseModel` of
            it, with support and life; or any differentiable function (values, cases) ->
            readings, which returns an array, or arrays by name.
        cases: Operating cases; for a function whatever it takes. Cases without readings
            are only predicted.
        unknowns: The unknown numbers, with bounds, in the order of `values`; for a
            function the path of a `Variable` is any name.
        readings: Measured values by name (case,) [SI], named as in `CaseModel`, NaN
            where not measured; one array for a function that returns an array. A value
            under the name of an unknown is prior knowledge of it, a prior.
        errors: Standard deviations of the readings by name, one or (case,) [SI].
            `None`: equal and unknown, which takes readings of a single name.
        wanted: Names of results or unknowns whose variance `candidates` are to lower;
            by default all unknowns. Results are predicted in all cases.
        candidates: Readings that could be taken in any of the cases, with their
            standard deviation [SI]; `None`: those of `readings`, repeated.
        known_errors: Whether `errors` hold as they are; if not, up to a common factor,
            which is estimated from the residuals.

    Returns:
        Estimates; check `result`, `identifiable` and `warnings`.

    Raises:
        TypeError, ValueError: For wrong unknowns, names, readings or errors, too few
            readings, and readings that depend on no unknown.
        SolveError: If a measured case does not solve at the start.

    Source: Levenberg (1944); Marquardt (1963); Seber and Wild, Nonlinear Regression
        (1989), ch. 2.
    """
    wanted = (wanted,) if isinstance(wanted, str) else tuple(wanted)
    more = dict.fromkeys([*wanted, *(candidates or ())])
    for name, off in (candidates or {}).items():
        positive("identify", f"candidates of {name}", off, "")
    given = _read_call(model, cases, unknowns, readings, errors, more)
    known = known_errors and errors is not None
    count, least = int(given.used.sum()), len(given.unknowns) + (not known)
    left = count - len(given.unknowns)
    if count < max(1, least):
        words = f"{count} readings for {shown_count(len(given.unknowns), 'unknown')}"
        why = "" if known else ", to tell the size of the errors too"
        raise ValueError(
            f"identify: {words}; it must be {least} at least, priors among them{why}."
        )
    fit, scale = given.fit(), 1.0
    _check(given, fit)
    for _ in range(0 if known else _REFITS):  # the start values must stay faint
        missed = (given.reading - fit.numbers) / given.error
        factor = float(np.sqrt(np.nansum(missed**2) / left)) or 1.0
        given = given._replace(error=factor * given.error)
        fit, scale = given.fit(), factor * scale
    missed = scale * (given.reading - fit.numbers) / given.error
    chi_square = float(np.nansum(missed**2))
    chance = float(stats.chi2.sf(chi_square, left)) if known and left else np.nan
    rows = (fit.slopes / given.error[:, None])[given.used]
    covariance = _covariance(rows)
    size = np.sqrt(np.diagonal(covariance))
    estimate = given.lower + given.width * fit.at
    standard = given.width * _standard_errors(covariance, np.eye(size.size))
    wide = stats.norm.ppf(0.975) if known else stats.t.ppf(0.975, left)
    untold, bent = _open_combinations(given, rows), _nonlinearity(given, fit, rows)
    result = "converged" if fit.left <= 10 * CLOSE else "stalled"
    if result == "stalled" and fit.steps >= STEP_LIMIT:
        result = "step_limit"
    words = f"{result} after {int(fit.steps)} evaluations"
    if result != "converged":
        words += f", {float(fit.left):.1e} standard errors of a reading from the end"
    return Identified(
        names=tuple(one.name for one in given.unknowns),
        units=given.units,
        estimate=estimate,
        standard_error=standard,
        interval=estimate[:, None] + np.outer(standard, [-wide, wide]),
        correlation=covariance / np.outer(size, size),
        identifiable=not untold,
        untold=untold,
        singular_values=np.linalg.svd(rows, compute_uv=False),
        residual=given.split(given.reading - fit.numbers, True),
        error=given.split(np.where(given.used, given.error, np.nan), True),
        prediction=given.split(fit.numbers),
        prediction_error=given.split(_standard_errors(covariance, fit.slopes)),
        chi_square=chi_square,
        degrees_of_freedom=left,
        probability=chance,
        error_scale=scale,
        nonlinearity=bent,
        candidates=_rank_readings(given, fit, covariance, wanted, candidates, scale),
        warnings=_warnings(given, fit, chance, bent),
        result=result,
        message=words,
    )


@program(quick=True, level=1, what="numbers from measurements")
def _fit(model, cases, names, own, box, error, reading, start, limit):
    lower, width = box

    def residuals(at):
        values = lower + width * at
        found = dict(zip(own, values[:, None], strict=True)) | dict(
            model(values, cases)
        )
        flat = jnp.concatenate([jnp.ravel(found[name]) for name in names])
        missed = jnp.where(jnp.isfinite(reading), (flat - reading) / error, 0.0)
        return jnp.concatenate([missed, FAINT * (at - start)]), flat

    return least_squares(residuals, start, limit)


class _ByName(eqx.Module):
    """A function whose array, if it returns one, gets the name "reading"."""

    function: Callable

    def __call__(self, values, cases):
        found = self.function(values, cases)
        return found if isinstance(found, Mapping) else {"reading": found}


class _Problem(NamedTuple):
    """A checked call of `identify`; arrays hold the numbers name by name."""

    model: Any
    cases: Any
    unknowns: tuple[Variable, ...]
    names: tuple[str, ...]
    sizes: tuple[int, ...]
    start: np.ndarray
    reading: np.ndarray
    error: np.ndarray

    @property
    def lower(self) -> np.ndarray:
        return np.array([one.lower for one in self.unknowns])

    @property
    def width(self) -> np.ndarray:
        return np.array([one.upper - one.lower for one in self.unknowns])

    @property
    def used(self) -> np.ndarray:
        return np.isfinite(self.reading)

    @property
    def units(self) -> tuple[str, ...]:
        model, of = self.model, self.unknowns
        known = isinstance(model, CaseModel)
        return tuple(unit_of(model.design, x.path[0]) if known else "" for x in of)

    def split(self, flat: Any, measured: bool = False) -> dict[str, np.ndarray]:
        """Return numbers by name; with `measured` only of names with readings."""
        ends = np.cumsum(self.sizes)[:-1]
        parts = np.split(flat, ends), np.split(self.used, ends)
        found = zip(self.names, *parts, strict=True)
        return {n: part for n, part, used in found if used.any() or not measured}

    def fit(self, start: Any = None, limit: int = STEP_LIMIT) -> Fit:
        """Search from a start in the unit box; a limit of 1 evaluates it alone."""
        start = self.start if start is None else start
        box = jnp.asarray(self.lower), jnp.asarray(self.width)
        data = map(jnp.asarray, (self.error, self.reading, start, limit))
        own = tuple(one.name for one in self.unknowns)
        found = _fit(self.model, self.cases, self.names, own, box, *data)
        return jax.tree.map(np.asarray, found)


def _read_call(model, cases, unknowns, readings, errors, more) -> _Problem:
    readings = (
        dict(readings) if isinstance(readings, Mapping) else {"reading": readings}
    )
    if not isinstance(errors, Mapping):
        several = errors is None and len(readings) > 1
        words = f"given for {', '.join(readings)}: their weights must be known"
        must_be("identify", "errors", errors, not several, words)
        errors = dict.fromkeys(readings, errors)
    if alone := readings.keys() ^ errors.keys():
        problem = f"{', '.join(sorted(alone))} is in `readings` or `errors` alone"
        raise ValueError(f"identify: {problem}; each reading has its error.")
    must_be("identify", "readings", readings, bool(readings), "of one name at least")
    unknowns, names = tuple(unknowns), tuple(dict.fromkeys([*readings, *more]))
    own = [one.name for one in unknowns]
    results = [name for name in names if name not in own]
    if isinstance(model, CaseModel) or not callable(model):
        model = model if isinstance(model, CaseModel) else CaseModel(model)
        check_design("identify", model.design, cases)
        kind = getattr(model.design, "of_cases", Cases)
        of_class("identify", "cases", cases, kind, kind.__name__)
        start = check_variables(model.design, unknowns, "identify")
        check_same_in_cases("identify", unknowns, cases, model.varied)
        for path, values in model.varied.items():
            Variable(path, -1e300, 1e300).start_in(model.design)  # raises for no number
            fits = np.shape(values) == (cases.count,)
            given = f"({cases.count},)", np.asarray(values)
            of_shape("identify", f"varied {path}", fits, *given)
        try:
            model = model.for_numbers([one.path for one in unknowns], results)
        except ValueError as error:
            raise ValueError(f"identify: {error}.") from error
        there = dict.fromkeys(results, cases.count)
    else:
        all_of_class("identify", "unknowns", unknowns, Variable, "Variables")
        if not own or len(set(own)) < len(own):
            problem = f"`unknowns` are {own}; their names must differ, one at least"
            raise ValueError(f"identify: {problem}.")
        starts = ((v.start, 0.5 * (v.lower + v.upper)) for v in unknowns)
        start = [middle if first is None else first for first, middle in starts]
        model, cases = _ByName(model), jax.tree.map(jnp.asarray, cases)
        shapes = eqx.filter_eval_shape(model, jnp.asarray(start), cases)
        there = {name: int(np.prod(one.shape)) for name, one in shapes.items()}
        for name in results:
            if name not in there:
                known = ", ".join(there)
                raise ValueError(f"identify: there is no {name!r}; there are {known}.")
    sizes = tuple({**there, **dict.fromkeys(own, 1)}[name] for name in names)
    made = {"readings": readings, "errors": errors}
    flat = {
        what: np.concatenate(
            [_numbers(what, n, of.get(n), k) for n, k in zip(names, sizes, strict=True)]
        )
        for what, of in made.items()
    }
    given = _Problem(
        model, jax.tree.map(jnp.asarray, cases), unknowns, names, sizes,
        np.array(start), flat["readings"], flat["errors"],
    )  # fmt: skip
    given = given._replace(start=(given.start - given.lower) / given.width)
    if all(off is None for off in errors.values()) and given.used.any():
        usual = 1e-3 * np.sqrt(np.nanmean(given.reading**2)) or 1.0
        given = given._replace(error=np.full_like(given.error, usual))
    for name, off in given.split(given.error, True).items():
        off = off[given.split(given.used)[name]]
        check("identify", f"errors of {name}", off > 0.0, "above 0", off, "")
    return given


def _numbers(what: str, name: str, values: Any, size: int) -> np.ndarray:
    """Return an array of `size` numbers, NaN for `None`."""
    try:
        found = np.asarray(np.nan if values is None else values, float)
        if not np.isinf(found).any():
            return np.array(np.broadcast_to(found, size))
    except (TypeError, ValueError):
        pass
    raise ValueError(
        f"identify: `{what}` of {name} are {values!r}; they must be one finite number,"
        f" or {size}, one for each case."
    )


def _check(given: _Problem, fit: Fit) -> None:
    """Raise if a measured case failed, or no unknown moves the readings of a name."""
    failed = given.used & ~np.isfinite(fit.numbers)
    for name, bad in given.split(failed).items():
        if bad.any():
            case, words = int(np.argmax(bad)), f"{name} {np.argmax(bad)} is not finite"
            if isinstance(given.model, CaseModel):
                values = given.lower + given.width * fit.at
                words = given.model.why_failed(values, given.cases, case)
            raise SolveError(f"identify: the start fails: {words}")
    moves = given.split(np.where(given.used, abs(fit.slopes).max(axis=1), 0.0), True)
    sizes = given.split(np.where(given.used, abs(given.reading), 0.0))
    for name, moved in moves.items():
        if moved.max() <= 1e-10 * sizes[name].max():
            raise ValueError(
                f"identify: no unknown moves the readings of {name}; leave them out, or"
                " name an unknown on which they depend."
            )


def _covariance(rows: Any) -> np.ndarray:
    """Return the covariance in the unit box, by readings and faint start values."""
    pulled = np.concatenate([rows, FAINT * np.eye(rows.shape[1])])
    _, size, axes = np.linalg.svd(pulled, full_matrices=False)
    return (axes.T / size**2) @ axes


def _standard_errors(covariance: np.ndarray, slopes: Any) -> np.ndarray:
    """Return standard errors of numbers, infinite where the start values hold them."""
    gain = slopes @ covariance
    variance, pulled = (gain * slopes).sum(axis=1), FAINT**2 * (gain**2).sum(axis=1)
    return np.where(pulled > 0.2 * variance, np.inf, np.sqrt(np.maximum(variance, 0.0)))


def _open_combinations(given: _Problem, rows: Any) -> tuple[str, ...]:
    """Return in words the combinations that the readings do not determine."""
    _, size, axes = np.linalg.svd(rows)
    size = np.pad(size, (0, len(axes) - size.size))
    texts = []
    for axis in axes[(UNTOLD * size < 1.0) | (size <= 1e-7 * size[0])]:
        axis = axis / axis[np.argmax(abs(axis))]
        order = [k for k in np.argsort(-abs(axis)) if abs(axis[k]) > 0.05]
        names = " and ".join(given.unknowns[k].name for k in order)
        if len(order) == 1:
            texts.append(f"the readings do not tell {names} within its bounds")
            continue
        parts = []
        for k in order:
            step = 0.01 * axis[k] * given.width[k]
            parts.append(shown_change(step, given.units[k], 3))
        ratio = ":".join(f"{abs(axis[k]):.2g}" for k in order)
        texts.append(
            f"{names} trade {ratio}, in parts of their ranges: changes of"
            f" {' and '.join(parts)} together leave the readings as they are"
        )
    return tuple(texts)


def _nonlinearity(given: _Problem, fit: Fit, rows: Any) -> float:
    """Return the largest departure from linearity at one standard error [1]."""
    pulled = np.concatenate([rows, FAINT * np.eye(fit.at.size)])
    _, size, axes = np.linalg.svd(pulled, full_matrices=False)
    worst = 0.0
    for step in (axes / size[:, None])[UNTOLD * size > 1.0]:
        for there in np.clip([fit.at - step, fit.at + step], 0.0, 1.0):
            straight = fit.numbers + fit.slopes @ (there - fit.at)
            off = (given.fit(there, 1).numbers - straight) / given.error
            worst = max(worst, float(np.linalg.norm(off[given.used])))
    return worst


def _rank_readings(given, fit, covariance, wanted, candidates, scale):
    """Return candidates in descending order of the variance that they take away, by
    the Sherman-Morrison update (c-optimal design: Atkinson and Donev, 1992)."""
    slopes = given.split(fit.slopes)
    slopes |= {
        one.name: row[None]
        for one, row in zip(given.unknowns, np.eye(fit.at.size), strict=True)
    }
    of = np.concatenate([slopes[w] for w in wanted or [v.name for v in given.unknowns]])
    before = np.einsum("ij,jk,ik->i", of, covariance, of)
    of, before = of[before > 0], before[before > 0]
    if candidates is None:
        errors = given.split(np.where(given.used, given.error, np.nan), True)
        candidates = {n: np.nanmedian(e) / scale for n, e in errors.items()}
    found = []
    for name, error in candidates.items():
        for case, row in enumerate(slopes[name] / (scale * error)):
            gain = covariance @ row
            drop = np.mean((of @ gain) ** 2 / (1.0 + row @ gain) / before)
            if np.isfinite(drop):
                found.append(Candidate(name, case, float(drop)))
    return tuple(sorted(found, key=lambda one: -one.drop))


def _warnings(given: _Problem, fit: Fit, chance: float, bent: float) -> list[Warning]:
    ends = {0.0: "lower", 1.0: "upper"}
    found = [
        Warning("at_bound", f"{one.name} ends at its {ends[at]} bound: widen it, or"
                " doubt model and readings; its interval does not hold")
        for one, at in zip(given.unknowns, fit.at.tolist(), strict=True) if at in ends
    ]  # fmt: skip
    if chance < DOUBTFUL:
        words = f"residuals this large come by chance in {100 * chance:.2g} % of cases:"
        words += " the model, or the stated errors, do not fit the readings"
        found.append(Warning("misfit", words, chance, DOUBTFUL))
    if chance > 1.0 - DOUBTFUL:
        words = "residuals are far below the stated errors, which may be too large"
        found.append(Warning("close_fit", words, chance, 1.0 - DOUBTFUL))
    if not bent <= CURVED:
        words = "within one standard error the readings depart from their tangent by"
        words += f" {bent:.2g} of it: intervals are approximate"
        found.append(Warning("nonlinear", words, bent, CURVED))
    if not np.isfinite(fit.numbers).all():
        words = "some cases without readings do not solve: they predict nothing"
        found.append(Warning("unsolved", words))
    if isinstance(given.model, CaseModel):
        values = given.lower + given.width * fit.at
        found += given.model.warnings(values, given.cases)
    return found

"""Numbers of a bearing from measurements, with their standard errors."""

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
"""Most evaluations of a search."""

FAINT = 0.03
"""Pull of the start over that of a reading, in ranges of the unknowns: it decides what
the readings leave open, and moves nothing else."""

UNTOLD = 0.5
"""Standard error, over the range between the bounds, from which the readings are said
not to tell a combination of unknowns [1]."""

CURVED = 0.2
"""Departure from the tangent at one standard error, over that error, from which
intervals are said to be approximate [1]."""

DOUBTFUL = 0.01
"""Probability of residuals so large, or so small, from which the fit is doubted [1]."""


_REFITS = 3
"""Searches that tell the size of unknown errors."""


class Candidate(NamedTuple):
    """A further reading.

    Attributes:
        name: What is read.
        case: In which case.
        drop: Share of the variance of what is wanted that it would take away [1]; of
            several wanted numbers the mean.
    """

    name: str
    case: int
    drop: float


@dataclasses.dataclass(frozen=True)
class Identified(Shown):
    """Numbers from measurements.

    Attributes:
        names: Names of the unknowns.
        units: Their SI units; empty: none, or not known.
        estimate: Their values (unknown,) [SI].
        standard_error: Standard errors (unknown,) [SI]; infinite where the readings
            leave a number open.
        interval: 95 % intervals (unknown, 2) [SI]: normal if the errors are known, else
            of Student.
        correlation: Correlations of the estimates (unknown, unknown) [1].
        identifiable: Whether the readings tell all unknowns.
        untold: Combinations that they do not tell, in words. There the estimate is the
            nearest to the start, in ranges between the bounds.
        singular_values: Singular values of the Jacobian of the readings over their
            errors by the unknowns over their ranges, falling (unknown,) [1].
        residual: Measured less predicted, by name, NaN where not measured [SI].
        error: Standard deviations of the readings, by name [SI].
        prediction: Numbers at the estimate by name, of all cases [SI].
        prediction_error: Their standard errors, without those of a reading [SI].
        chi_square: Sum of squares of residuals over errors [1].
        degrees_of_freedom: Readings less unknowns.
        probability: Probability of residuals as large by chance [1]; NaN where the
            errors are not known, or no degree of freedom is left.
        error_scale: Factor on the given errors, told by the residuals if they are not
            known [1].
        nonlinearity: Largest departure of the readings from the tangent at one standard
            error, over that error [1].
        candidates: Further readings, most useful first.
        warnings: What to doubt.
        result: "converged", "step_limit" or "stalled".
        message: The same in words.
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
        """Yield the unknowns with their standard errors, and what to think of them."""
        rows = self.names, self.estimate, self.standard_error, self.units
        for name, value, error, unit in zip(*rows, strict=True):
            text = f"{shown_number(value, unit)} ± {shown_change(error, unit)}"
            yield 1, name, text, "estimate, standard error"
        for text in (*self.untold, *map(str, self.warnings)):
            yield 1, "not told" if text in self.untold else "warning", text, ""
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
    """Find the numbers of a design that measurements tell, and how well.

    Least squares of the residuals over their errors, by Levenberg and Marquardt's
    method with exact Jacobians (implicit function theorem, forward mode), within the
    bounds. A step to numbers at which a measured case does not solve is rejected.
    Standard errors, correlations and bands are those of the linearised problem;
    `nonlinearity` says how far they go.

    Args:
        model: The design, an element or on its seats; a `CaseModel` of it, which has
            support and life; or any differentiable function (values, cases) ->
            readings, an array, or arrays by name.
        cases: Operating cases; for a function whatever it takes. Cases without readings
            only predict.
        unknowns: The numbers, between bounds; of a function any name is the path.
        readings: Measured numbers by name (case,) [SI], named as in `CaseModel`, NaN
            where there is none; for a function that returns an array, one. Under the
            name of an unknown: what is known of it before (a prior).
        errors: Standard deviations of the readings by name, one or (case,) [SI];
            `None`: alike, and not known; there must then be readings of one name.
        wanted: Names of results, or of unknowns, that are to be known better. Results
            are predicted in all cases.
        candidates: Readings that could be taken in any of the cases, with their
            standard deviation; `None`: those that are there, once more.
        known_errors: Whether `errors` are known; if not, up to a common factor, which
            the residuals tell.

    Returns:
        Estimates; check `result`, `identifiable` and `warnings`.

    Raises:
        TypeError, ValueError: For wrong unknowns, names, readings or errors; too few
            readings; readings of what no unknown moves.
        SolveError: If a measured case does not solve at the start.
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
    for _ in range(0 if known else _REFITS):  # the faint pull must stay faint
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
    standard = given.width * _spread(covariance, np.eye(size.size))
    wide = stats.norm.ppf(0.975) if known else stats.t.ppf(0.975, left)
    untold, bent = _untold(given, rows), _bend(given, fit, rows)
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
        prediction_error=given.split(_spread(covariance, fit.slopes)),
        chi_square=chi_square,
        degrees_of_freedom=left,
        probability=chance,
        error_scale=scale,
        nonlinearity=bent,
        candidates=_rank(given, fit, covariance, wanted, candidates, scale),
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
    """A function whose array has a name."""

    function: Callable

    def __call__(self, values, cases):
        found = self.function(values, cases)
        return found if isinstance(found, Mapping) else {"reading": found}


class _Problem(NamedTuple):
    """A call of `identify`, checked; the numbers of all names one after the other."""

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
        """Numbers by name; only of names with readings, if `measured`."""
        ends = np.cumsum(self.sizes)[:-1]
        parts = np.split(flat, ends), np.split(self.used, ends)
        found = zip(self.names, *parts, strict=True)
        return {n: part for n, part, used in found if used.any() or not measured}

    def fit(self, start: Any = None, limit: int = STEP_LIMIT) -> Fit:
        """Search from a start in the unit box; after one evaluation it is there."""
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
            raise ValueError(f"identify: `unknowns` are {own}; they must be one each.")
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
    """So many numbers, NaN for `None`."""
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
    """Covariance of the unknowns in the unit box, of readings and the faint pull."""
    pulled = np.concatenate([rows, FAINT * np.eye(rows.shape[1])])
    _, size, axes = np.linalg.svd(pulled, full_matrices=False)
    return (axes.T / size**2) @ axes


def _spread(covariance: np.ndarray, slopes: Any) -> np.ndarray:
    """Standard errors of numbers; infinite of those that the faint pull holds."""
    gain = slopes @ covariance
    variance, pulled = (gain * slopes).sum(axis=1), FAINT**2 * (gain**2).sum(axis=1)
    return np.where(pulled > 0.2 * variance, np.inf, np.sqrt(np.maximum(variance, 0.0)))


def _untold(given: _Problem, rows: Any) -> tuple[str, ...]:
    """Combinations of unknowns that the readings do not tell, in words."""
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


def _bend(given: _Problem, fit: Fit, rows: Any) -> float:
    """Departure from the tangent at one standard error along each axis [1]."""
    pulled = np.concatenate([rows, FAINT * np.eye(fit.at.size)])
    _, size, axes = np.linalg.svd(pulled, full_matrices=False)
    worst = 0.0
    for step in (axes / size[:, None])[UNTOLD * size > 1.0]:
        for there in np.clip([fit.at - step, fit.at + step], 0.0, 1.0):
            straight = fit.numbers + fit.slopes @ (there - fit.at)
            off = (given.fit(there, 1).numbers - straight) / given.error
            worst = max(worst, float(np.linalg.norm(off[given.used])))
    return worst


def _rank(given, fit, covariance, wanted, candidates, scale) -> tuple[Candidate, ...]:
    """Further readings by what they would tell of the wanted numbers."""
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

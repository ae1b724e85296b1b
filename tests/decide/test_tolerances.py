"""Tolerances: samples, causes, misses and tightening, against closed forms."""

from types import SimpleNamespace
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
import pytest
from scipy import stats
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.decide import (
    Scatter,
    class_scatters,
    tighten,
    tolerance_effects,
    tolerances,
    truncated_normal,
)
from bearingjax.decide.predict import CaseModel
from bearingjax.decide.scatter import draw_samples
from bearingjax.decide.tolerance_effects import (
    QUANTILES,
    Sampled,
    _standard_error,
    _variance_shares,
)
from bearingjax.fits import Limits, SizeLimits
from bearingjax.numerics.warning import Warning
from bearingjax.optimise import Constraint, OperatingClearance, PeakPressure, RatingLife
from bearingjax.statics import Installed

PLAY, CROWN = "radial_internal_clearance", "ball_diameter"
SLOPE = np.array([3.0, -4.0])
"""Slopes of the linear measure over its numbers, of spread 1 and 0.5: sd² = 9 + 4."""
SPREAD = 13.0**0.5


def linear(element, cases, solution):
    """Stands for a measure; `closed_form` gives its values."""


@pytest.fixture
def element():
    return bj.BearingElement(bj.load_bearing("6205"))


@pytest.fixture
def closed_form(monkeypatch):
    """Samples of a linear measure in place of those of a bearing."""

    def solve(self, samples, slopes):
        values = samples @ SLOPE[:, None]
        gradient = np.broadcast_to(SLOPE, (len(samples), 1, 2)) if slopes else None
        return values, np.zeros(len(samples), int), gradient

    monkeypatch.setattr(Sampled, "solve", solve)
    monkeypatch.setattr(Sampled, "_warnings", lambda self: [])
    monkeypatch.setattr(
        "bearingjax.decide.tolerance_effects._check_ends", lambda *_: None
    )


def numbers(first=None, **more):
    one = stats.norm(0.0, 1.0) if first is None else first
    return [
        Scatter("bearing.a", one, "a", **more),
        Scatter("bearing.b", stats.norm(0.0, 0.5), "b"),
    ]


def solved(element, scatters=None, limit=2.0, **more):
    return tolerances(
        element,
        bj.Cases([np.zeros(6)]),
        numbers() if scatters is None else scatters,
        [Constraint(linear, upper=limit)],
        **more,
    )


def test_scatter_refuses_what_is_none():
    norm = stats.norm(0.0, 1.0)
    for given, kind, text in (
        ((3, norm), TypeError, "path"),
        (((), norm), TypeError, "path"),
        (("a", 3.0), TypeError, "distribution"),
        (("a", stats.norm(0.0, 0.0)), ValueError, "distribution"),
        (("a", stats.cauchy()), ValueError, "distribution"),
        (("a", norm, "", -1.0), ValueError, "cost"),
    ):
        with pytest.raises(kind, match=f"Scatter: `{text}`"):
            Scatter(*given)
    for given, text in (((2.0, 1.0), "lower"), ((1.0, 2.0, 1.5, 0.0), "deviation")):
        with pytest.raises(ValueError, match=f"truncated_normal: `{text}`"):
            truncated_normal(*given)


def test_truncated_normal_ends_at_three_deviations():
    made = Scatter("a", truncated_normal(1e-6, 7e-6))
    assert made.ends == pytest.approx((1e-6, 7e-6), rel=ROUNDING)
    assert made.centre == pytest.approx(4e-6, rel=ROUNDING)
    assert made.spread == pytest.approx(0.9866e-6, rel=1e-4)  # of ±3 standard ones
    free = Scatter("a", stats.norm(5.0, 2.0))
    assert free.ends == pytest.approx((-1.0, 11.0), rel=ROUNDING)


def test_sizes_of_classes_scatter_within_their_limits(element):
    free, still = Limits(3e-6, 15e-6), Limits(0.0, 0.0)
    limits = SizeLimits(free, Limits(2e-6, 11e-6), Limits(-10e-6, 0.0), still, still)
    seats = bj.Mounting(25e-3, 52e-3, 80e-3, 10e-6, 0.0)
    given = Installed(element, None, seats, limits=limits)
    found, scatters = class_scatters(given)
    assert [one.name for one in scatters] == ["clearance", "shaft", "bore"]
    assert [one.path for one in scatters] == [
        {"mounting.radial_clearance": 1.0},
        {"mounting.shaft_interference": 1.0},
        {"mounting.shaft_interference": -1.0},
    ]
    np.testing.assert_allclose(scatters[0].ends, free, rtol=ROUNDING)
    own = element.bearing.radial_internal_clearance
    assert given.mounting.radial_clearance is None
    assert float(found.mounting.radial_clearance) == pytest.approx(float(own))
    assert class_scatters(Installed(element, None, seats)) == (
        Installed(element, None, seats),
        (),
    )
    with pytest.raises(TypeError, match="installed"):
        class_scatters(element)


def test_draw_samples_has_distributions_and_correlation():
    scatters = [*numbers(), Scatter("c", stats.uniform(2.0, 4.0))]
    root = np.linalg.cholesky([[1.0, 0.6, 0.0], [0.6, 1.0, 0.0], [0.0, 0.0, 1.0]])
    found = draw_samples(scatters, root, 8000, 1)
    assert found.shape == (8192, 3)
    assert found.mean(axis=0) == pytest.approx([0.0, 0.0, 4.0], abs=1e-3)
    assert found.std(axis=0) == pytest.approx([1.0, 0.5, 4.0 / 12**0.5], rel=2e-3)
    assert np.corrcoef(found.T)[0] == pytest.approx([1.0, 0.6, 0.0], abs=2e-3)
    assert found[:, 2].min() > 2.0 and found[:, 2].max() < 6.0
    assert not np.array_equal(found, draw_samples(scatters, root, 8000, 2))
    assert np.array_equal(found, draw_samples(scatters, root, 8000, 1))


def test_spread_of_linear_measure(element, closed_form):
    found = solved(element).spreads[0]
    assert found.first_order == pytest.approx((0.0, SPREAD), rel=ROUNDING)
    assert abs(found.mean) < 5.0 * found.errors[0] + 1e-3
    assert found.deviation == pytest.approx(SPREAD, rel=2e-3)
    exact = SPREAD * stats.norm.ppf(QUANTILES)
    assert np.all(np.abs(found.quantiles - exact) < 5.0 * found.errors[2:] + 0.02)
    assert found.first_order_shares == pytest.approx([9 / 13, 4 / 13], rel=ROUNDING)
    assert found.shares == pytest.approx([9 / 13, 4 / 13], abs=0.02)
    assert found.slopes == pytest.approx(SLOPE)
    assert _standard_error([1.0, 3.0]) == pytest.approx(
        1.0
    )  # 2**0.5 of each, of two sets


def test_spread_of_correlated_numbers(element, closed_form):
    both = [[1.0, 0.5], [0.5, 1.0]]
    found = solved(element, correlation=both).spreads[0]
    assert found.first_order[1] == pytest.approx(7.0**0.5, rel=ROUNDING)
    assert found.deviation == pytest.approx(7.0**0.5, rel=5e-3)


def test_misses_and_their_derivatives(element, closed_form):
    """P(y > 2) = Φ(-2/s); its derivatives by the widths of both, and by the middle."""
    found = solved(element, samples=60_000).misses
    density = stats.norm.pdf(2.0, 0.0, SPREAD)
    exact = stats.norm.sf(2.0, 0.0, SPREAD)
    assert abs(found.share - exact) < 5.0 * found.error + 1e-4
    assert found.smoothed == pytest.approx(exact, rel=0.02)
    by_width = density * 2.0 / SPREAD**2 * np.array([9.0, 4.0])
    assert found.by_width == pytest.approx(by_width, rel=0.02)
    width = np.array([6.0, 3.0])
    assert found.by_middle == pytest.approx(density * SLOPE * width, rel=0.02)
    # The requirement is smoothed over a tenth of the spread, as if it scattered itself.
    smooth = SPREAD * (1.0 + (0.9 * 65_536**-0.2) ** 2) ** 0.5
    density = stats.norm.pdf(2.0, 0.0, smooth)
    by_width = density * 2.0 / smooth**2 * np.array([9.0, 4.0])
    assert np.all(np.abs(found.by_width - by_width) < 5.0 * found.errors)
    assert found.by_middle == pytest.approx(density * SLOPE * width, rel=2e-3)
    assert found.error < 2e-3 and np.all(found.errors < 0.01 * by_width.max())


@pytest.mark.parametrize("samples", [512, 8192])
def test_errors_of_derivatives_are_their_scatter(element, closed_form, samples):
    """Of 60 seeds, whose scatter is known to a tenth (1/√118); three of these are
    allowed for it over the errors that each seed states."""
    given = element, bj.Cases([np.zeros(6)]), numbers(), [Constraint(linear, upper=2.0)]
    each = [Sampled(*given, samples=samples, seed=1000 * k) for k in range(60)]
    found = [one.misses(*one.run()) for one in each]
    scatter = np.std([one.by_width for one in found], axis=0)
    stated = np.sqrt(np.mean([one.errors**2 for one in found], axis=0))
    assert scatter / stated == pytest.approx([1.0, 1.0], abs=0.3)


def test_warnings_have_the_life_that_is_given_or_measured(element, monkeypatch):
    """At the mean of all numbers, in the design that is built from it."""

    def told(self, values, cases):
        play, life = self.design.bearing.radial_internal_clearance, self.life
        return [Warning("made", f"{play:.3g} {life and life.reliability}")]

    monkeypatch.setattr(CaseModel, "warnings", told)
    scatters = [Scatter(f"bearing.{PLAY}", truncated_normal(1e-5, 3e-5))]
    given, measured = (bj.LifeConditions(reliability=x) for x in (0.95, 0.98))
    cases = bj.Cases([[0.0, -1e3, 0.0, 0.0, 0.0, 0.0]])
    for measures, more, text in (
        ([linear], {}, "2e-05 None"),
        ([linear, RatingLife(measured)], {}, "2e-05 0.98"),
        ([linear, RatingLife(measured)], {"life": given}, "2e-05 0.95"),
        ([linear], {"build": lambda one: element}, f"{1.25e-5:.3g} None"),
    ):
        sampled = Sampled(element, cases, scatters, measures, samples=8, **more)
        assert sampled._warnings() == [f"at the mean: {text}"]


def test_derivatives_of_a_bent_measure(element, closed_form, monkeypatch):
    """y = exp(a) > e² where a > 2: the slope is 7.4 there, and 1 at the mean, so that
    most of the change is what the gradient at the mean lacks."""

    def solve(self, samples, slopes):
        y, zero = np.exp(samples[:, 0]), np.zeros(len(samples))
        gradient = np.stack([y, zero], axis=1)[:, None]
        return y[:, None], zero.astype(int), gradient if slopes else None

    monkeypatch.setattr(Sampled, "solve", solve)
    found = solved(element, limit=np.exp(2.0), samples=60_000).misses
    density = stats.norm.pdf(2.0)
    assert found.by_width == pytest.approx([2.0 * density, 0.0], rel=0.03)
    assert found.by_middle == pytest.approx([6.0 * density, 0.0], rel=0.03)


def test_misses_of_two_requirements(element, closed_form):
    asked = [Constraint(linear, lower=-2.0, upper=2.0)]
    given = element, bj.Cases([np.zeros(6)]), numbers()
    found = tolerances(*given, asked).misses
    exact = 2.0 * stats.norm.sf(2.0, 0.0, SPREAD)
    # Five of its standard errors, and a sample of the ten thousand.
    assert found.share == pytest.approx(exact, abs=5.0 * found.error + 1e-4)
    assert found.by_middle == pytest.approx([0.0, 0.0], abs=0.2)
    assert tolerances(*given, [linear]).misses is None


def test_requirements_of_several_measures(element, closed_form, monkeypatch):
    """Of a, at most 2.5 about 1, and b, at least -0.4 about 0: each alone is kept by Φ
    of 1.5 and 0.8. A measure that a sample does not have leaves the others theirs."""

    def solve(self, samples, slopes):
        a, b = samples.T
        values = np.stack([np.where(a > 3.0, np.nan, b), a, b], axis=1)
        gradient = np.broadcast_to([[0, 1], [1, 0], [0, 1]], (len(samples), 3, 2))
        return values, np.zeros(len(samples), int), gradient if slopes else None

    monkeypatch.setattr(Sampled, "solve", solve)
    asked = linear, Constraint(linear, upper=2.5), Constraint(linear, lower=-0.4)
    scatters, cases = numbers(stats.norm(1.0, 1.0)), bj.Cases([np.zeros(6)])
    found = tolerances(element, cases, scatters, asked, samples=60_000)
    limit = np.array([1.5, 0.8])
    kept = stats.norm.cdf(limit)
    none, *alone = (one.misses for one in found.spreads)
    assert none is None and alone == pytest.approx(1.0 - kept, abs=2e-3)
    assert [one.mean for one in found.spreads[1:]] == pytest.approx([1, 0], abs=2e-3)
    misses = found.misses
    assert misses.share == pytest.approx(1.0 - kept.prod(), abs=2e-3)
    assert misses.smoothed == pytest.approx(misses.share, rel=0.03)
    exact = limit * stats.norm.pdf(limit) * kept[::-1]
    assert misses.by_width == pytest.approx(exact, rel=0.04)


def test_failed_samples_are_misses(element, closed_form, monkeypatch):
    plain = Sampled.solve

    def solve(self, samples, slopes):
        values, result, gradient = plain(self, samples, slopes)
        result = (samples[:, 0] > 1.0).astype(int)
        lost = np.where(result == 0, 1.0, np.nan)[:, None]
        gradient = gradient * lost[..., None] if slopes else None
        return values * lost, result, gradient

    monkeypatch.setattr(Sampled, "solve", solve)
    found = solved(element, limit=1e3)
    assert found.misses.share == pytest.approx(stats.norm.sf(1.0), abs=2e-3)
    one = found.spreads[0]
    assert np.isfinite(one.mean) and one.misses == pytest.approx(found.misses.share)
    # What is not solved has neither a place near the requirement nor a gradient.
    assert found.misses.smoothed == pytest.approx(found.misses.share, rel=ROUNDING)
    assert np.all(found.misses.by_width == 0.0)
    cut = 9.0 * stats.truncnorm(-np.inf, 1.0).var()
    assert one.shares == pytest.approx(np.array([cut, 4.0]) / (cut + 4.0), abs=0.02)


class Solved(NamedTuple):
    """A case in place of one of a bearing."""

    play: Any
    result: Any
    displacement: Any


def test_samples_are_designs_that_all_their_cases_solve(element, monkeypatch):
    """Both numbers add to one, with their factors; a case that fails is one of two."""

    def solved_case(design, case, support, options, start):
        play = design.bearing.radial_internal_clearance
        # From near the mean, and not from first contact, the least play fails too.
        lost = (play > case.load[0]) | ((play < 1.5e-5) & jnp.isfinite(start[0]))
        return Solved(play, jnp.where(lost, 2, 0), jnp.full(12, play))

    def judge(measures, cases, design, solution):
        return None, jnp.sum(solution.play)[None]

    module = "bearingjax.decide.tolerance_effects"
    monkeypatch.setattr(f"{module}.solved_case", solved_case)
    monkeypatch.setattr(f"{module}.judge", judge)
    for name in ("_solve_few", "_solve_many"):
        monkeypatch.setattr(f"{module}.{name}", tolerance_effects._solve)
    path = f"bearing.{PLAY}"
    scatters = [
        Scatter({path: 1.0}, truncated_normal(1e-5, 3e-5), "large"),
        Scatter({path: -1.0}, truncated_normal(-4e-6, 4e-6), "small"),
    ]
    cases = bj.Cases([[2.5e-5, 0, 0, 0, 0, 0], [1.0, 0, 0, 0, 0, 0]])
    sampled = Sampled(element, cases, scatters, [linear], samples=8)
    given = np.array([[3e-5, 1e-6], [1.5e-5, 1e-6], [2e-5, -2e-6]])
    for slopes in (False, True):
        values, result, gradient = sampled.solve(given, slopes)
        assert result.tolist() == [2, 0, 0]
        exact = [[np.nan], [2.8e-5], [4.4e-5]]
        np.testing.assert_allclose(values, exact, rtol=ROUNDING)
        if slopes:
            np.testing.assert_allclose(gradient, [[[2.0, -2.0]]] * 3, rtol=ROUNDING)


def test_tighten_takes_the_one_that_pays(element, closed_form):
    """Of the first number alone has a cost: 9 w² + 4 = s² for the share asked."""
    most = stats.norm.sf(2.0, 0.0, 8.0**0.5)
    given = element, bj.Cases([np.zeros(6)])
    asked = [Constraint(linear, upper=2.0)]
    found = tighten(*given, numbers(cost=2.0), asked, most, samples=8000)
    assert found.converged
    assert found.widths == pytest.approx([(4.0 / 9.0) ** 0.5, 1.0], rel=0.03)
    assert found.after == pytest.approx(most, abs=4.0 * found.error + 2e-3)
    assert found.before == pytest.approx(stats.norm.sf(2.0 / SPREAD), abs=5e-3)
    assert found.cost == pytest.approx(12.0 * (1.0 - found.widths[0]), rel=ROUNDING)
    # Both shares are of samples that the search has not seen.
    own = Sampled(*given, numbers(cost=2.0), asked, samples=8000)
    seen, fresh = (own.misses(*own.run(found.widths, k)).share for k in (0, 1))
    assert found.after == fresh != seen
    cheap = [numbers(cost=2.0)[0], Scatter("bearing.b", stats.norm(0, 0.5), "b", 1e3)]
    dear = tighten(*given, cheap, asked, most, samples=8000)
    assert dear.widths == pytest.approx(found.widths, abs=0.02)
    out = tighten(*given, numbers(cost=2.0), asked, 1e-4, samples=8000)
    assert not out.converged and out.widths[0] == pytest.approx(0.2)
    assert out.message.startswith("no widths reach it: of the narrowest")


def test_tighten_searches_with_the_slopes_of_its_margin(
    element, closed_form, monkeypatch
):
    """By differences of the share with smooth requirements; the width over which they
    are smoothed changes with the spread, which the slopes leave out."""
    seen = []

    def catch(method, trials, *_):
        seen.append(trials)
        return SimpleNamespace(unit=np.ones(1), converged=True, text="caught")

    monkeypatch.setattr(tolerance_effects, "search_least", catch)
    given = element, bj.Cases([np.zeros(6)])
    asked = [Constraint(linear, upper=2.0)]
    tighten(*given, numbers(cost=2.0), asked, 0.2, samples=8000)
    (trials,) = seen
    low, middle, high = (trials.attempt(np.array([x]), True) for x in (0.3, 0.5, 0.7))
    slope = (high.margins - low.margins) / 0.4
    np.testing.assert_allclose(middle.margin_slopes[:, 0], slope, rtol=0.08)
    np.testing.assert_allclose(
        middle.slope, (high.objective - low.objective) / 0.4, rtol=ROUNDING
    )


def test_tighten_refuses_what_is_none(element, closed_form):
    given = element, bj.Cases([np.zeros(6)])
    asked = [Constraint(linear, upper=2.0)]
    for scatters, measures, share, text in (
        (numbers(), asked, 0.1, "cost"),
        (numbers(cost=1.0), [linear], 0.1, "Constraint"),
        (numbers(cost=1.0), asked, 0.0, "most_misses"),
    ):
        with pytest.raises(ValueError, match=text):
            tighten(*given, scatters, measures, share)


def test_variance_shares_of_few_samples():
    """Of a sum and of a kink, by integration; chance moves shares of 256 samples by
    0.015, and 0.04 is beyond its reach."""
    scatters = [Scatter({name: 1.0}, stats.norm(), name) for name in "abcd"]
    x = draw_samples(scatters, np.eye(4), 256, 5)
    shares = _variance_shares(x, x @ [3.0, 2.0, 1.0, 0.0])
    assert shares == pytest.approx(np.array([9.0, 4.0, 1.0, 0.0]) / 14.0, abs=0.04)
    bent = _variance_shares(x, 3.0 * np.minimum(x[:, 0], 0.3) + x[:, 1])
    assert bent == pytest.approx([0.808, 0.192, 0.0, 0.0], abs=0.04)


def test_variance_shares_of_ishigami():
    """Sobol's indices of Ishigami's function: 0.3139, 0.4424, 0 (a = 7, b = 0.1)."""
    x = np.random.default_rng(0).uniform(-np.pi, np.pi, (2**15, 3))
    y = (
        np.sin(x[:, 0])
        + 7 * np.sin(x[:, 1]) ** 2
        + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    )
    assert _variance_shares(x, y) == pytest.approx([0.3139, 0.4424, 0.0], abs=0.005)
    assert _variance_shares(x, np.ones(2**15)) == pytest.approx([0.0, 0.0, 0.0])


def test_tolerances_refuse_what_does_not_fit(element):
    play = Scatter(f"bearing.{PLAY}", truncated_normal(0.0, 2e-5), "play")
    cases = bj.Cases([[0.0, -1e3, 0.0, 0.0, 0.0, 0.0]])
    for scatters, measures, more, text in (
        ([], [linear], {}, "scatters"),
        ([play, play], [linear], {}, "unlike names"),
        ([play], [], {}, "measures"),
        ([play], [linear], {"samples": 0}, "samples"),
        ([play], [linear], {"correlation": [[1.0, 0.0], [0.0, 1.0]]}, "correlation"),
        ([Scatter("bearing.no", truncated_normal(0, 1))], [linear], {}, "no number"),
        (
            [Scatter("bearing.n_balls", truncated_normal(0, 1))],
            [linear],
            {},
            "no number",
        ),
        (
            [Scatter(f"bearing.{CROWN}", truncated_normal(-1e-3, 1e-2), "ball")],
            [linear],
            {},
            "ball may be -0.001, which the design does not allow",
        ),
        (
            [Scatter(f"bearing.{CROWN}", truncated_normal(7e-3, 7e-2), "ball")],
            [linear],
            {},
            "ball may be 0.07, which the design does not allow",
        ),
    ):
        with pytest.raises(ValueError, match=text):
            tolerances(element, cases, scatters, measures, **more)


@pytest.fixture(scope="module")
def fan():
    """A ball bearing on seats of classes, its cases and what scatters."""
    fit = bj.Mounting(0.025, 0.052, 0.08, 5e-6, 2e-6, radial_clearance=1e-5)
    place = Installed(bj.BearingElement(bj.load_bearing("6205")), mounting=fit)
    cases = bj.Cases(
        [[0.0, -1.5e3, 2e2, 0.0, 0.0, 0.0], [0.0, -8e2, 0.0, 0.0, 0.0, 0.0]],
        inner_speed=157.0,
        hours=[1.0, 3.0],
    )
    shaft, bore = "mounting.shaft_interference", "mounting.shaft_interference"
    scatters = [
        Scatter("mounting.radial_clearance", truncated_normal(8e-6, 2e-5), "clearance"),
        Scatter({shaft: 1.0}, truncated_normal(2e-6, 1.1e-5), "shaft"),
        Scatter({bore: -1.0}, truncated_normal(-1e-5, 0.0), "bore"),
    ]
    life = Constraint(RatingLife(hours=True), lower=2.93e3)
    return place, cases, scatters, [life, PeakPressure(), OperatingClearance()]


@pytest.mark.slow
def test_tolerances_equal_single_solutions(fan):
    """Each sample is what a bearing with these numbers gives by itself."""
    place, cases, scatters, measures = fan
    found = tolerances(*fan, samples=64)
    names = "mounting.radial_clearance", "mounting.shaft_interference"
    for k in (0, 17, 63):
        play, shaft, bore = found.samples[k]
        from bearingjax.optimise.variable import with_numbers

        one = with_numbers(place, dict(zip(names, (play, shaft - bore), strict=True)))
        damage, pressures, plays = [], [], []
        for j in range(2):
            speed = bj.Speed(157.0, 0.0)
            own = one.element_at(speed)
            solution = bj.solve_load(own, cases.load[j], speed=speed)
            damage.append(float(bj.rating_life(own, solution).damage))
            pressures.append(float(np.max(solution.contact_pressure)))
            plays.append(float(own.bearing.radial_internal_clearance))
        hours = float(bj.spectrum_life(cases, np.array(damage)).life_hours)
        exact = hours, max(pressures), min(plays)
        assert found.values[k] == pytest.approx(exact, rel=SOLVER)


@pytest.mark.slow
def test_tolerance_gradients_against_differences(fan):
    place, cases, scatters, measures = fan
    sampled = Sampled(*fan, samples=64)
    centre, slopes = sampled.centre, sampled.solve(sampled.centre[None], True)[2][0]
    for k, step in enumerate((1e-8, 1e-8, 1e-8)):
        ends = np.stack([centre + s * step * np.eye(3)[k] for s in (1.0, -1.0)])
        values = sampled.solve(ends, False)[0]
        assert (values[0] - values[1]) / (2 * step) == pytest.approx(
            slopes[:, k], rel=DIFFERENCE, abs=1e-7 * np.abs(slopes).max()
        )

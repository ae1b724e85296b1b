"""Numbers from measurements, of closed forms: nothing heavy is compiled."""

import sys
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.decide.identify import _Problem
from bearingjax.optimise import Variable

MODULE = sys.modules["bearingjax.decide.identify"]  # the name is that of the function
LOADS = np.array([100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0])
TRUE = np.array([2e-7, 2.0 / 3.0])
ERROR = 5e-8


def hertz(values, loads):
    """Approach of a point contact: a load to a power."""
    return {"approach": values[0] * loads ** values[1]}


def product(values, loads):
    """Only the product of both numbers counts."""
    return values[0] * values[1] * loads


CONTACT = [Variable("c", 1e-8, 1e-6, start=1e-7), Variable("n", 0.3, 1.2)]
FACTORS = [Variable("a", 0.0, 2.0, start=0.5), Variable("b", 0.0, 4.0, start=1.0)]


@pytest.fixture(scope="module")
def exact():
    return np.asarray(hertz(TRUE, LOADS)["approach"])


@pytest.fixture(scope="module")
def noise():
    return ERROR * np.random.default_rng(2).standard_normal((1000, LOADS.size))


def jacobian(values, loads=LOADS):
    c, n = values
    return np.stack([loads**n, c * loads**n * np.log(loads)], axis=1)


def test_identify_estimates_and_errors_of_linear_algebra(exact, noise):
    read = exact + noise[0]
    found = bj.identify(hertz, LOADS, CONTACT, {"approach": read}, ERROR)
    slopes = jacobian(found.estimate) / ERROR
    covariance = np.linalg.inv(slopes.T @ slopes)
    own = np.sqrt(np.diag(covariance))
    assert found.converged and found.identifiable and not found.warnings
    # No step of Gauss and Newton is left, to a thousandth of an error.
    missed = found.residual["approach"] / ERROR
    off = read - found.prediction["approach"]
    np.testing.assert_allclose(ERROR * missed, off, rtol=1e-9, atol=1e-15)
    assert np.all(abs(covariance @ slopes.T @ missed) < 1e-3 * own)
    np.testing.assert_allclose(found.standard_error, own, rtol=1e-4)
    between = covariance[0, 1] / own.prod()
    np.testing.assert_allclose(found.correlation[0, 1], between, rtol=1e-6)
    np.testing.assert_allclose(found.chi_square, missed @ missed, rtol=1e-3)
    band = np.sqrt(np.einsum("ij,jk,ik->i", slopes, covariance, slopes)) * ERROR
    np.testing.assert_allclose(found.prediction_error["approach"], band, rtol=1e-4)


def test_intervals_hold_the_truth_in_95_of_100_sets(exact, noise):
    held, sums = [], []
    for one in noise[:400]:
        found = bj.identify(hertz, LOADS, CONTACT, {"approach": exact + one}, ERROR)
        low, high = found.interval.T
        held.append((low < TRUE) & (high > TRUE))
        sums.append(found.chi_square)
        assert found.converged
    share = np.mean(held, axis=0)
    assert np.all((share > 0.92) & (share < 0.98))
    assert abs(np.mean(sums) - 4.0) < 0.45  # four degrees of freedom


def test_unknown_errors_are_told_by_residuals(exact, noise):
    """Student's intervals; the size of the stated errors does not count."""
    scales, held = [], []
    for one in noise[:40]:
        found = bj.identify(hertz, LOADS, CONTACT, {"approach": exact + one})
        scales.append(found.error["approach"][0] / ERROR)
        low, high = found.interval.T
        held.append((low < TRUE) & (high > TRUE))
    assert 0.8 < np.sqrt(np.mean(np.square(scales))) < 1.2
    assert np.mean(held) > 0.88
    given = bj.identify(
        hertz,
        LOADS,
        CONTACT,
        {"approach": exact + one},
        1e-6,
        wanted=["n"],
        candidates={"approach": 2e-6},
        known_errors=False,
    )
    np.testing.assert_allclose(given.standard_error, found.standard_error, rtol=1e-3)
    missed = given.residual["approach"]
    told = np.sqrt(missed @ missed / 4.0)  # four degrees of freedom
    np.testing.assert_allclose(given.error["approach"], told, rtol=1e-6)
    np.testing.assert_allclose(given.error_scale, told / 1e-6, rtol=1e-6)
    np.testing.assert_allclose(given.chi_square, 4.0 * (told / 1e-6) ** 2, rtol=1e-6)
    # The best of those that are there, once more, for both numbers on average.
    again = found.candidates[0]
    rows = jacobian(found.estimate) / found.error["approach"][0]
    more = np.concatenate([rows, rows[[again.case]]])
    of = [np.diagonal(np.linalg.inv(part.T @ part)) for part in (more, rows)]
    np.testing.assert_allclose(again.drop, np.mean(1.0 - of[0] / of[1]), rtol=1e-2)
    # A further reading has twice the error that the residuals tell.
    best = given.candidates[0]
    rows = jacobian(given.estimate) / given.error["approach"][0]
    more = np.concatenate([rows, rows[[best.case]] / 2.0])
    of = [np.linalg.inv(part.T @ part)[1, 1] for part in (more, rows)]
    np.testing.assert_allclose(best.drop, 1.0 - of[0] / of[1], rtol=1e-2)
    far = bj.identify(
        hertz, LOADS, CONTACT, {"approach": exact + one}, 1.0, known_errors=False
    )
    np.testing.assert_allclose(far.estimate, found.estimate, rtol=1e-4)
    np.testing.assert_allclose(far.standard_error, found.standard_error, rtol=1e-2)


def test_combination_that_readings_do_not_tell_is_named():
    """The estimate is the nearest, in ranges, to the start; other numbers are told."""
    found = bj.identify(product, LOADS, FACTORS, 3.0 * LOADS, 1.0)
    assert found.converged and not found.identifiable
    assert np.isinf(found.standard_error).all()
    (words,) = found.untold
    assert "a and b trade 1:1" in words and "parts of their ranges" in words
    assert "changes of 0.02 and -0.04 together" in words, words
    a, b = found.estimate
    np.testing.assert_allclose(a * b, 3.0, rtol=1e-4)
    # 1.2247 and 2.4495: both moved by the same share of their ranges, 2 and 4.
    np.testing.assert_allclose([a, b], [1.5**0.5, 6.0**0.5], rtol=1e-3)
    band = found.prediction_error["reading"]
    np.testing.assert_allclose(band, LOADS / np.linalg.norm(LOADS), rtol=1e-2)


def test_reading_of_an_unknown_is_a_prior():
    read = {"reading": 3.0 * LOADS, "a": 1.5}
    found = bj.identify(product, LOADS, FACTORS, read, {"reading": 1.0, "a": 0.03})
    np.testing.assert_allclose(found.estimate, [1.5, 2.0], rtol=1e-4)
    np.testing.assert_allclose(found.standard_error, [0.03, 0.04], rtol=1e-2)
    assert found.identifiable
    # Without it, it is the one further reading that helps.
    alone = bj.identify(
        product,
        LOADS,
        FACTORS,
        read["reading"],
        1.0,
        candidates={"reading": 1.0, "a": 0.03},
    )
    assert alone.candidates[0].name == "a" and alone.candidates[0].drop > 0.9


def test_bounds_are_kept_and_told():
    short = [Variable("c", 1e-8, 1.5e-7, start=1e-7), CONTACT[1]]
    read = hertz(TRUE, LOADS)["approach"]
    found = bj.identify(hertz, LOADS, short, {"approach": read}, ERROR)
    assert found.converged and found.estimate[0] == 1.5e-7
    kinds = [one.kind for one in found.warnings]
    assert "at_bound" in kinds and "misfit" in kinds
    assert found.warnings[0].startswith("c ends at its upper bound")
    # The other number is the best there: no step along it is left.
    slope = jacobian(found.estimate)[:, 1] / ERROR
    step = slope @ found.residual["approach"] / ERROR / (slope @ slope)
    assert abs(step) < 1e-3 * found.standard_error[1]


def test_best_further_reading_of_brute_force(exact):
    """Each reading added in turn, and the covariance inverted anew."""
    read = np.where(LOADS > 1000.0, np.nan, exact)
    found = bj.identify(
        hertz,
        LOADS,
        CONTACT,
        {"approach": read},
        ERROR,
        wanted=["n"],
        candidates={"approach": 2 * ERROR},
    )
    used = jacobian(found.estimate) / ERROR
    bands = bj.identify(
        hertz, LOADS, CONTACT, {"approach": read}, ERROR, wanted=["approach"]
    )
    more = np.concatenate([used[:4], used[[5]]])
    of = [np.linalg.inv(rows.T @ rows) for rows in (more, used[:4])]
    of = [np.einsum("ij,jk,ik->i", used, one, used) for one in of]
    (drop,) = (one.drop for one in bands.candidates if one.case == 5)
    np.testing.assert_allclose(drop, np.mean(1.0 - of[0] / of[1]), rtol=1e-2)
    base = np.linalg.inv(used[:4].T @ used[:4])[1, 1]
    drops = {}
    for case, row in enumerate(used):
        more = np.concatenate([used[:4], row[None] / 2])
        drops[case] = 1.0 - np.linalg.inv(more.T @ more)[1, 1] / base
    order = sorted(drops, key=lambda k: -drops[k])
    assert [one.case for one in found.candidates] == order
    for one in found.candidates:
        np.testing.assert_allclose(one.drop, drops[one.case], rtol=1e-2)


def test_strongly_bent_readings_are_told():
    def bent(values, times):
        return jnp.exp(-values[0] * times)

    times = np.array([1.0, 2.0])
    unknown = [Variable("rate", 0.0, 10.0, start=1.0)]
    found = bj.identify(bent, times, unknown, np.exp(-times), 0.3)
    # By hand: the worse of both sides, along the one axis.
    slope = -times * np.exp(-times)
    step = 0.3 / np.linalg.norm(slope) * np.array([[1.0], [-1.0]])
    off = np.exp(-times * (1.0 + step)) - np.exp(-times) - slope * step
    worst = np.linalg.norm(off, axis=1).max() / 0.3
    np.testing.assert_allclose(found.nonlinearity, worst, rtol=1e-2)
    assert "nonlinear" in [one.kind for one in found.warnings]
    sharp = bj.identify(bent, times, unknown, np.exp(-times), 1e-4)
    assert sharp.nonlinearity < 1e-3
    assert [one.kind for one in sharp.warnings] == ["close_fit"]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_readings_bent_to_one_side_alone_are_told(side):
    """Of the tangent at 1, ten times the distance squared are missing on one side."""

    def bent(values, sizes):
        off = values[0] - 1.0
        return sizes * (off + 10.0 * jnp.maximum(side * off, 0.0) ** 2)

    unknown = [Variable("a", 0.0, 2.0, start=0.9)]
    found = bj.identify(bent, np.ones(1), unknown, np.zeros(1), 0.05)
    np.testing.assert_allclose(found.nonlinearity, 10.0 * 0.05, rtol=1e-2)


def test_a_search_that_is_cut_off_says_so(monkeypatch):
    whole, read = _Problem.fit, hertz(TRUE, LOADS)["approach"]
    cut = lambda self, start=None, limit=2: whole(self, start, limit)  # noqa: E731
    monkeypatch.setattr(_Problem, "fit", cut)
    monkeypatch.setattr(MODULE, "STEP_LIMIT", 2)
    found = bj.identify(hertz, LOADS, CONTACT, {"approach": read}, ERROR)
    assert not found.converged and found.result == "step_limit"
    assert found.message.startswith("step_limit after 2 evaluations, ")
    monkeypatch.setattr(MODULE, "STEP_LIMIT", 3)
    found = bj.identify(hertz, LOADS, CONTACT, {"approach": read}, ERROR)
    assert found.result == "stalled"


def test_errors_that_are_not_known_do_not_hang_on_the_unit(exact, noise):
    """The first guess of them is a share of the readings: in other units all is the
    same, so large or small the numbers are."""
    read, usual = exact + noise[0], None
    for size in (1.0, 1e-6, 1e6):

        def scaled(values, loads, size=size):
            return {"approach": size * hertz(values, loads)["approach"]}

        found = bj.identify(scaled, LOADS, CONTACT, {"approach": size * read})
        usual = found if usual is None else usual
        np.testing.assert_allclose(found.estimate, usual.estimate, rtol=1e-9)
        np.testing.assert_allclose(
            found.standard_error, usual.standard_error, rtol=1e-6
        )


def test_a_step_to_where_a_model_fails_is_rejected():
    def fails(values, loads):
        return jnp.where(values[0] > 0.65, jnp.nan, values[0] ** 4) * loads

    unknown = [Variable("a", 0.0, 1.0, start=0.1)]
    found = bj.identify(fails, LOADS, unknown, 0.6**4 * LOADS, 1.0)
    assert found.converged and abs(found.estimate[0] - 0.6) < 1e-4
    lost = np.where(np.arange(LOADS.size) == 5, np.nan, 1.0)
    given = lambda values, loads: values[0] ** 4 * loads * lost  # noqa: E731
    part = bj.identify(given, LOADS, unknown, 0.6**4 * LOADS * lost, 1.0)
    assert "unsolved" in [one.kind for one in part.warnings]
    assert abs(part.estimate[0] - 0.6) < 1e-4 and part.degrees_of_freedom == 4
    with pytest.raises(bj.SolveError, match="the start fails: reading 0 is not finite"):
        bj.identify(
            fails, LOADS, [Variable("a", 0.0, 1.0, start=0.9)], 0.6**4 * LOADS, 1.0
        )


def test_unmeasured_numbers_are_blank(exact):
    read = np.where(LOADS < 500.0, exact, np.nan)
    found = bj.identify(hertz, LOADS, CONTACT, {"approach": read}, ERROR)
    for given in (found.residual, found.error):
        blank = np.isnan(given["approach"])
        assert blank.tolist() == [False] * 3 + [True] * 3
    np.testing.assert_allclose(found.prediction["approach"], exact, rtol=1e-3)
    assert found.degrees_of_freedom == 1
    text = str(found)
    assert "2e-07 ± 9.0" in text and "identifiable" in text and found.units == ("", "")


READ = {"approach": 1e-7 * LOADS}
WRONG = {
    "too few readings": (
        dict(readings={"approach": [1e-6, *[np.nan] * 5]}),
        ValueError,
        "1 readings for 2 unknowns",
    ),
    "too few for unknown errors": (
        dict(readings={"approach": [1e-6, 2e-6, *[np.nan] * 4]}, errors=None),
        ValueError,
        "2 readings for 2 unknowns",
    ),
    "unknown name": (dict(readings={"aproach": LOADS}), ValueError, "no 'aproach'"),
    "error of no reading": (
        dict(errors={"approach": 1e-7, "other": 1e-7}),
        ValueError,
        "other is in `readings` or `errors` alone",
    ),
    "error of zero": (dict(errors=0.0), ValueError, r"`errors of approach` is \[0\. "),
    "negative error": (
        dict(errors=-1e-7),
        ValueError,
        r"`errors of approach` is \[-1.e-07",
    ),
    "error of NaN": (
        dict(errors=np.nan),
        ValueError,
        r"`errors of approach` is \[nan ",
    ),
    "infinite reading": (
        dict(readings={"approach": [np.inf, *LOADS[1:]]}),
        ValueError,
        "must be one finite number",
    ),
    "wrong length": (
        dict(readings={"approach": LOADS[:4]}),
        ValueError,
        "one finite number, or 6",
    ),
    "no unknowns": (dict(unknowns=[]), ValueError, "their names must differ"),
    "twice": (dict(unknowns=[CONTACT[0]] * 2), ValueError, "their names must differ"),
    "no readings": (dict(readings={}), ValueError, "`readings` is {}"),
    "error of a candidate": (
        dict(candidates={"approach": 0.0}),
        ValueError,
        "`candidates of approach` is 0; it must be above 0",
    ),
    "wanted of no name": (dict(wanted=["life"]), ValueError, "there is no 'life'"),
    "several without errors": (
        dict(readings={"approach": LOADS, "other": LOADS}, errors=None),
        ValueError,
        "their weights must be known",
    ),
    "moved by nothing": (
        dict(model=lambda v, x: {"approach": 0.0 * v[0] + x}),
        ValueError,
        "no unknown moves the readings of approach",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_identify_rejects(name):
    changes, error, words = WRONG[name]
    given = dict(
        model=hertz, cases=LOADS, unknowns=CONTACT, readings=READ, errors=ERROR
    )
    with pytest.raises(error, match=words):
        bj.identify(**{**given, **changes})


def test_plot_has_a_row_of_charts_for_each_name(exact, noise):
    read = {"approach": exact + noise[1], "n": 0.66}
    errors = {"approach": ERROR, "n": 0.01}
    found = bj.identify(hertz, LOADS, CONTACT, read, errors)
    left, right = bj.plot.identify_overview(found, {"approach": "m"}, "a name").axes
    assert left.get_xlabel() == "measured [µm]" and left.get_title() == "approach"
    bars: Any
    (bars,) = right.containers
    shown = bars.lines[0].get_ydata()
    np.testing.assert_allclose(shown, 1e6 * found.residual["approach"])

"""Searches on plain functions: what they find, and what they may call converged."""

import numpy as np
import optax
import pytest

from bearingjax.optimise.search import SearchOutcome, is_minimum, search_least
from bearingjax.optimise.trials import Trial, Trials, optimality

TOLERANCE = 1e-5
METHODS = {name: name for name in ("l-bfgs-b", "slsqp", "adam", "nelder-mead")}
METHODS["sgd"] = optax.sgd(0.1)
# A minimum at (0.72, 0.52), in a valley.
BEST = np.array([0.72, 0.52])
HESSE = np.array([[0.69, -0.69], [-0.69, 5.12]])


def objective(unit):
    return 1.0 + 0.5 * (unit - BEST) @ HESSE @ (unit - BEST)


def trials(barred, start=(0.05, 0.05), kept=None):
    """Of a quadratic; `kept`: row a and number b of a constraint a·x ≥ b."""
    row, least = (np.zeros((0, 2)), np.zeros(0)) if kept is None else kept
    row, least = np.reshape(row, (-1, 2)), np.reshape(least, -1)

    def evaluate(unit, slopes):
        if barred(unit):
            return Trial(unit, np.nan, None, np.zeros(0), None, "barred")
        slope, slopes_of = (HESSE @ (unit - BEST), row) if slopes else (None, None)
        return Trial(unit, objective(unit), slope, row @ unit - least, slopes_of)

    return Trials(evaluate, evaluate(np.array(start), True))


def run(method, tried, n_bounds=0, max_steps=200):
    ending = search_least(METHODS[method], tried, n_bounds, max_steps, TOLERANCE)
    return ending, tried.attempt(ending.unit, True)


def nowhere(unit):
    return False


@pytest.mark.parametrize("method", ["l-bfgs-b", "slsqp", "sgd"])
def test_minimum_is_found_to_the_gradient_asked_for(method):
    ending, best = run(method, trials(nowhere))
    assert ending.converged and optimality(best, TOLERANCE) <= TOLERANCE
    # Within the gradient over the least curvature.
    assert np.all(np.abs(best.unit - BEST) <= TOLERANCE / 0.5)


@pytest.mark.parametrize("method", ["l-bfgs-b", "slsqp"])
def test_disc_of_rejected_designs_is_passed(method):
    """In the line of sight from the start to the minimum."""

    def disc(unit):
        return np.linalg.norm(unit - [0.365, 0.433]) < 0.275

    tried = trials(disc)
    _, best = run(method, tried)
    assert tried.rejected and is_minimum(best, TOLERANCE)
    assert np.allclose(best.unit, BEST, atol=2 * TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_search_not_converged_at_wall_of_rejected_designs(method):
    """Beyond a slanted wall; the least at the wall is 0.05 above the minimum's."""
    row, limit = np.array([1.0, 0.5]), 0.8
    tried = trials(lambda unit: unit @ row > limit)
    ending, best = run(method, tried)
    # Lagrange: along the wall.
    aside = np.linalg.solve(HESSE, row)
    least = BEST + aside * (limit - row @ BEST) / (row @ aside)
    assert np.isclose(best.objective, objective(least), rtol=1e-3)
    assert not is_minimum(best, TOLERANCE)
    # So many are tried, not thousands.
    assert tried.n_evaluations < 500
    if method != "nelder-mead":
        assert not ending.converged and optimality(best, TOLERANCE) > 0.01


@pytest.mark.parametrize("start", [(0.0, 0.0), (1.0, 0.0), (0.95, 0.95)])
def test_constraint_holds_the_gradient_with_a_multiplier_of_the_right_sign(start):
    row, least = np.array([-1.0, -0.5]), -0.8
    tried = trials(nowhere, start, (row, least))
    ending, best = run("slsqp", tried, 1)
    assert ending.converged and is_minimum(best, TOLERANCE)
    assert abs(best.unit @ row - least) <= TOLERANCE
    # The same point with the sense of the constraint turned round is no minimum.
    turned = best._replace(margin_slopes=-row[None])
    assert optimality(turned, TOLERANCE) > 0.01


def test_search_with_infeasible_constraint():
    tried = trials(nowhere, kept=(np.array([1.0, 1.0]), 3.0))
    ending, best = run("slsqp", tried, 1)
    assert not ending.converged and not is_minimum(best, TOLERANCE)
    # As near to it as the bounds allow.
    assert np.isclose(best.violation, 1.0) and np.allclose(best.unit, 1.0)


@pytest.mark.parametrize("method", ["l-bfgs-b", "slsqp", "sgd"])
def test_start_at_the_minimum_is_left_alone(method):
    tried = trials(nowhere, BEST)
    ending, _ = run(method, tried)
    assert ending.converged and "the start" in ending.text
    assert tried.n_evaluations == 1


def test_step_limit_is_no_minimum():
    ending, best = run("l-bfgs-b", trials(nowhere), max_steps=1)
    assert ending.limited and not is_minimum(best, TOLERANCE)


def test_custom_search_callable_arguments():
    def own(attempt, start, max_steps, tolerance, step):
        step(start + 0.1)
        return SearchOutcome(
            start, attempt(start).objective < 0, f"{max_steps} {tolerance}"
        )

    tried = trials(nowhere)
    ending = search_least(own, tried, 0, 7, TOLERANCE)
    # The best of its steps counts, not where it says that it ended.
    assert np.allclose(ending.unit, 0.15) and ending.text == f"7 {TOLERANCE}"

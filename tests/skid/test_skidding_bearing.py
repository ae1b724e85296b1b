"""Design of a bearing that may skid: its cases, measures, and why designs fail."""

import equinox as eqx
import jax
import jax.numpy as jnp
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from han_chu import BEARING, ELEMENT, FREE, MODEL, SPEED
from tolerances import DIFFERENCE, ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.element import Speed
from bearingjax.optimise import SearchOptions
from bearingjax.optimise.design_problem import Problem
from bearingjax.skid import (
    CageSlip,
    FrictionPower,
    FrictionTorque,
    SkiddingBearing,
    conditions,
    skid_warnings,
)
from bearingjax.statics import SolveOptions, Support

matplotlib.use("Agg")

ANGLE = "model.element.bearing.contact_angle"
SPEEDS = np.array([1.0, 0.5]) * float(SPEED.inner)
HOURS = [1.0, 3.0]
VARIABLES = (
    bj.optimise.Variable("preload", 0.0, 300.0),
    bj.optimise.Variable(ANGLE, *np.radians([20.0, 30.0])),
    bj.optimise.Variable("model.element.bearing.inner_osculation", 0.51, 0.54),
    bj.optimise.Variable("model.temperature", 290.0, 320.0),
)


def design(preload=120.0, places=1):
    return SkiddingBearing(MODEL, preload, places)


def spectrum(axial=0.0, radial=0.0, speeds=SPEEDS):
    load = np.zeros((2, 6))
    load[:, 2], load[:, 0] = axial, radial
    return bj.Cases(load, inner_speed=speeds, hours=HOURS)


def sliding(design, cases, solved):
    """Sum of the largest sliding velocities."""
    return jnp.sum(jnp.max(solved.sliding_speed, axis=(1, 2)))


def kept(slip):
    """All programs here are one: the bounds are no part of it."""
    power, slides = (
        bj.optimise.Constraint(m, upper=1e3) for m in (FrictionPower(), sliding)
    )
    return bj.optimise.Constraint(CageSlip(), upper=slip), power, slides


def search(slip=5e-3, cases=None, **choices):
    cases = spectrum() if cases is None else cases
    least = FrictionTorque()
    options = SearchOptions(solve=SolveOptions(points=2), **choices)
    given = dict(search=options, support=Support(FREE))
    return bj.optimise.optimise(design(), cases, VARIABLES, least, kept(slip), **given)


def problem_of(start, cases):
    given = VARIABLES, FrictionTorque(), kept(1.0), SolveOptions(points=2)
    return Problem(start, cases, *given, Support(FREE))


@pytest.fixture(scope="module")
def evaluated():
    """Measures, slopes and solutions of a start over cases.

    Their program takes a minute or two to compile: slow is what runs it.
    """

    def one(start, cases, unit=None):
        problem = problem_of(start, cases)
        begin = problem.to_unit_box([v.start_in(start) for v in VARIABLES])
        return problem.run(begin if unit is None else begin + unit, True)

    return one


@pytest.mark.slow
def test_measures_of_the_paper_s_bearing(evaluated):
    """Its preload alone loads it: AF001-14, as in the tests of the end state."""
    found = evaluated(design(), spectrum())
    solved, share = found.solution, np.array([0.25, 0.75])
    np.testing.assert_allclose(100.0 * solved.cage_slip[0], 0.33, atol=6e-3)
    torque, slip, power, _ = found.exact
    heat = np.asarray(solved.friction_torque) * SPEEDS
    np.testing.assert_allclose(torque, share @ solved.friction_torque, rtol=ROUNDING)
    np.testing.assert_allclose(power, share @ heat, rtol=ROUNDING)
    np.testing.assert_allclose(slip, np.abs(solved.cage_slip).max(), rtol=ROUNDING)
    # The smooth maximum is over two cases.
    assert slip <= found.measures[1] <= slip * 2.0 ** (1.0 / 64.0)


@pytest.mark.slow
def test_a_preload_is_an_axial_load(evaluated):
    loaded, pressed = (
        evaluated(design(force), spectrum(axial=120.0 - force)) for force in (0, 120.0)
    )
    np.testing.assert_allclose(loaded.measures, pressed.measures, rtol=SOLVER)
    np.testing.assert_allclose(loaded.jacobian, pressed.jacobian, rtol=1e-6)


@pytest.mark.slow
def test_gradients_are_those_of_differences(evaluated):
    """Of torque, slip, heat and sliding, with respect to load, design and oil."""
    got, step = np.asarray(evaluated(design(), spectrum()).jacobian), 1e-4
    for k, way in enumerate(step * np.eye(len(VARIABLES))):

        def moved(times, way=way):
            return evaluated(design(), spectrum(), times * way).measures

        wide, narrow = (moved(n) - moved(-n) for n in (2.0, 1.0))
        want = np.asarray(8.0 * narrow - wide) / (12.0 * step)
        np.testing.assert_allclose(got[:, k], want, rtol=DIFFERENCE)


@pytest.mark.slow
def test_skidding_case_at_rest_has_no_weight(evaluated):
    found = evaluated(design(), spectrum(speeds=np.array([SPEEDS[0], 0.0])))
    assert float(found.solution.cage_slip[1]) == 0.0
    alone = evaluated(design(), spectrum(speeds=np.full(2, SPEEDS[0])))
    np.testing.assert_allclose(found.exact[1], alone.exact[1], rtol=SOLVER)
    np.testing.assert_allclose(found.exact[0], 0.25 * alone.exact[0], rtol=SOLVER)
    assert np.all(np.isfinite(found.jacobian))


@pytest.mark.slow
def test_least_torque_has_as_much_slip_as_is_allowed():
    found = search()
    assert found.converged, found.message
    np.testing.assert_allclose(found.after.constraints[0], 5e-3, rtol=1e-5)
    assert found.after.exact < found.before.exact
    assert float(found.element.preload) == found.values[0]
    assert found.element.model.bearing.n_balls == BEARING.n_balls
    figure = bj.plot.optimise_overview(found)
    peaks, history = figure.axes[:2]
    assert len(peaks.patches) == 4
    assert np.asarray(history.get_lines()[0].get_ydata())[-1] < 1.0
    plt.close(figure)


@pytest.mark.slow
def test_optimise_names_infeasible_constraint():
    found = search(1e-6, max_steps=8)
    assert found.result == "infeasible"
    assert "; slip of the cage is 0.00" in found.message
    assert found.message.endswith(", above its bound 1e-06")


@pytest.mark.slow
def test_optimise_raises_for_failing_skid_cases():
    with pytest.raises(bj.SolveError, match="case 0: no_load_path"):
        search(cases=spectrum(axial=-200.0))
    with pytest.raises(bj.SolveError, match="must be a multiple of 12"):
        search(cases=spectrum(axial=600.0, radial=200.0))


@pytest.mark.slow
def test_message_of_unconverged_end_state(evaluated):
    start = design()
    solved = evaluated(start, spectrum()).solution
    lost = bj.Result.STEP_LIMIT
    one = jax.tree.map(lambda leaf: leaf[0], solved)
    one = eqx.tree_at(lambda s: s.result, one, np.int32(lost))
    one = eqx.tree_at(lambda s: (s.steps, s.residual), one, (np.int32(300), 0.2))
    want = "no end state of skidding: step_limit after 300 steps; force out of balance"
    want = f"{want} 2.0e-01"
    assert start.failure_message(one).startswith(want)


@pytest.mark.slow
def test_optimise_warnings_of_end_states():
    """As of the end state of each case, and in how many cases."""
    cold = eqx.tree_at(lambda d: d.model.temperature, design(), np.float64(290.0))
    cases = spectrum(axial=[0.0, 480.0])
    problem = problem_of(cold, cases)
    begin = problem.to_unit_box([v.start_in(cold) for v in VARIABLES])
    element, outcome = problem.outcome(problem.evaluate(begin, True))
    (text,) = (text for text in outcome.warnings if "times the pressure" in text)
    words, counts = text.split(", in ")
    assert counts == "1 of 2 cases, worst case 1"
    one = jax.tree.map(lambda leaf: leaf[1], outcome.solution)
    state = conditions(element.model, one, Speed(inner=SPEEDS[1]))
    assert words in skid_warnings(element.model, one, state)
    # With doubts about both, the worst one's words, wherever it stands.
    both = jax.tree.map(lambda leaf: np.stack([leaf, leaf]), (one, state))
    for worst, shear in enumerate(([0.4, 0.2], [0.2, 0.4])):
        shear = np.array(shear)[:, None, None] + 0.0 * both[1].shear
        told = skid_warnings(element.model, both[0], both[1]._replace(shear=shear))
        (text,) = (text for text in told if "times the pressure" in text)
        assert text.startswith("shear stresses of 0.4 times")
        assert text.endswith(f"in 2 of 2 cases, worst case {worst}")


def test_wrong_calls():
    still = bj.Cases(np.zeros((2, 6)))
    with pytest.raises(ValueError, match="have no ring speeds"):
        search(cases=still)
    with pytest.raises(ValueError, match="`places` is 7; .* multiple of the 12 balls"):
        design(places=7)
    with pytest.raises(ValueError, match="`preload` is nan"):
        design(np.nan)
    with pytest.raises(TypeError, match="`model` is a BearingElement|'model'"):
        SkiddingBearing(ELEMENT)


@pytest.mark.slow
def test_measures_are_of_skidding_bearings(evaluated):
    still = bj.Cases(np.zeros((2, 6)))
    solved = evaluated(design(), spectrum()).solution.solution
    assert type(solved) is bj.statics.BallSolution
    with pytest.raises(ValueError, match="optimise a `SkiddingBearing`"):
        FrictionTorque()(ELEMENT, still, solved)

"""Design optimisation: gradients, bounds, constraints, known optima, failures."""

import dataclasses
import re
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optax
import pytest
from tolerances import DIFFERENCE, ROUNDING

import bearingjax as bj
from bearingjax.optimise import SearchOptions, design_numbers
from bearingjax.optimise.design_problem import Bound, Problem, Run
from bearingjax.optimise.optimise import _most_violated, verdict
from bearingjax.optimise.search import SearchOutcome
from bearingjax.optimise.smooth import (
    largest,
    smallest,
    smooth_maximum,
    smooth_minimum,
)
from bearingjax.optimise.trials import Trial, Trials, optimality
from bearingjax.optimise.variable import with_numbers
from bearingjax.statics import SolveOptions

PROFILE = "bearing.roller_profile."
PLAY = "bearing.radial_internal_clearance"
POINTS = 21


def roller_element(profile, quadrature=None, **choices):
    bearing = bj.CylindricalRollerBearing(
        6,
        0.05,
        0.010,
        0.012,
        radial_internal_clearance=10e-6,
        first_azimuth=-0.5 * np.pi,
        roller_profile=profile,
        **choices,
    )
    return bj.BearingElement(bearing, quadrature=quadrature)


@pytest.fixture(scope="module")
def fujiwara():
    """The inner raceway ends at infinity, where nothing is carried."""
    profile = bj.FujiwaraKawase(4e3, 1.5, 0.7, 9e-6)
    return roller_element(profile, inner_raceway_profile=bj.Logarithmic(2e-5))


@pytest.fixture(scope="module")
def straight():
    return roller_element(bj.Straight(), quadrature=bj.numerics.Midpoint(5))


@pytest.fixture(scope="module")
def cases():
    load = np.zeros((2, 6))
    load[:, 1] = [-4e3, -2e3]
    tilt = {"gx": [1.5e-3, 0.5e-3], "gy": 0.0}
    return bj.Cases(load, prescribed=tilt, hours=[1.0, 3.0])


@pytest.fixture(scope="module")
def one_case():
    return bj.Cases([[0, -3e3, 0, 0, 0, 0]], prescribed={"gx": 0.0, "gy": 0.0})


def play(lower=0.0, upper=40e-6, start=None):
    return bj.optimise.Variable(PLAY, lower, upper, start)


@pytest.fixture(scope="module")
def wanted(straight, one_case):
    """Stiffness in uy at a clearance of 15 µm."""
    element = with_numbers(straight, {PLAY: 15e-6})
    tilts = {"gx": 0.0, "gy": 0.0}
    solution = bj.solve_load(
        element, one_case.load[0], support=bj.Support(prescribed=tilts)
    )
    return float(solution.stiffness[7, 7])


def search(straight, one_case, wanted, **choices):
    objective = choices.pop("objective", bj.optimise.StiffnessTarget(wanted, "uy"))
    variables = choices.pop("variables", [play()])
    names = {field.name for field in dataclasses.fields(SearchOptions)}
    mine = {name: choices.pop(name) for name in names & set(choices)}
    options = SearchOptions(**{"solve": SolveOptions(points=2), **mine})
    return bj.optimise.optimise(
        straight, one_case, variables, objective, search=options, **choices
    )


# Measures.


@pytest.mark.slow
def test_gradients_of_all_measures_are_those_of_differences(fujiwara, cases):
    """All three parameters of the roller's profile, that of a raceway which ends at
    infinity, and the clearance; roller ends carry load on the other raceway."""
    variables = [
        bj.optimise.Variable(PROFILE + "load_factor", 0.5, 4.0),
        bj.optimise.Variable(PROFILE + "crowned_fraction", 0.3, 0.95),
        bj.optimise.Variable(PROFILE + "end_drop", 5e-6, 15e-6),
        bj.optimise.Variable("bearing.inner_raceway_profile.coefficient", 1e-5, 5e-5),
        play(),
    ]
    measures = [
        bj.optimise.PeakPressure(),
        bj.optimise.MeanPressure(exponent=16.0),
        bj.optimise.EdgeLoad(),
        bj.optimise.Displacement("uy"),
        bj.optimise.Stiffness("uy"),
        bj.optimise.StiffnessTarget(2e8, "uy"),
        bj.optimise.StiffnessTarget(1e6, "uy", "gx"),
        lambda element, cases, solution: jnp.sum(solution.roller_load[:, 0, 0]),
    ]
    constraints = tuple(bj.optimise.Constraint(m, upper=1.0) for m in measures[1:])
    options = SolveOptions(points=POINTS)
    problem = Problem(fujiwara, cases, variables, measures[0], constraints, options)
    start = problem.to_unit_box([v.start_in(fujiwara) for v in variables])
    found = problem.run(start, True)
    assert np.all(np.asarray(found.solution.result) == bj.Result.CONVERGED)
    got, step = np.asarray(found.jacobian), 1e-5
    assert np.all(np.abs(got).max(axis=1) > 0)
    for k in range(len(variables)):
        h = step * np.eye(len(variables))[k]
        ahead, behind = (problem.run(start + s * h, True).measures for s in (1, -1))
        want = np.asarray(ahead - behind) / (2 * step)
        size = np.abs(got).max(axis=1)
        assert np.all(np.abs(got[:, k] - want) <= DIFFERENCE * size), k
    # Smooth maxima stand above, minima below, what they stand for.
    smooth, exact = np.asarray(found.measures), np.asarray(found.exact)
    assert np.all(smooth[:4] >= exact[:4]) and smooth[4] <= exact[4]
    samples = np.asarray(found.solution.contact_pressure)
    pressure = np.asarray(found.solution.roller_pressure)
    assert exact[0] == pressure.max() >= samples.max()
    assert smooth[0] <= (samples.size + pressure.size) ** (1 / 64) * exact[0]
    peaks = pressure.max(axis=(1, 2))
    assert np.isclose(exact[1], 0.25 * peaks[0] + 0.75 * peaks[1], rtol=ROUNDING)


@pytest.mark.parametrize("exponent", [2.0, 64.0, 1000.0])
def test_smooth_maximum_and_minimum_keep_their_bounds(exponent):
    values = jnp.asarray(np.random.default_rng(2).uniform(0.1, 3e9, 200))
    top, low = jnp.max(values), jnp.min(values)
    factor = values.size ** (1 / exponent)
    assert top <= smooth_maximum(values, exponent) <= factor * top
    assert low / factor <= smooth_minimum(values, exponent) <= low
    for smooth in (smooth_maximum, smooth_minimum):
        slope = jax.grad(smooth)(values, exponent)
        # Of degree one: Euler's theorem.
        assert np.isclose(slope @ values, smooth(values, exponent), rtol=1e-11)


def test_smooth_maximum_of_zeros_nan_and_infinity():
    value, slope = jax.value_and_grad(smooth_maximum)(jnp.zeros(5))
    assert value == 0 and np.all(slope == 0)
    assert np.isnan(smooth_maximum(jnp.array([1.0, jnp.nan])))
    assert np.isnan(smooth_minimum(jnp.array([1.0, jnp.nan])))
    # Bearings without load have infinite lives.
    idle = jnp.array([2.0, jnp.inf])
    assert smooth_minimum(idle) == 2.0
    assert jnp.isinf(smooth_minimum(jnp.full(2, jnp.inf)))
    for lives in (idle, jnp.full(2, jnp.inf)):
        assert jnp.isfinite(jax.grad(smooth_minimum)(lives)).all()
    assert smooth_minimum(jnp.array([2.0, -3.0])) == -3.0


# Searches.


@pytest.mark.parametrize(
    "method",
    [None, "slsqp", "nelder-mead", optax.sgd(0.005)],
    ids=lambda m: m if isinstance(m, str) else type(m).__name__,
)
@pytest.mark.slow
def test_optimise_recovers_clearance_from_stiffness(straight, one_case, wanted, method):
    found = search(straight, one_case, wanted, method=method, tolerance=1e-6)
    assert found.converged, found.message
    assert np.isclose(found.values[0], 15e-6, rtol=1e-5)
    assert float(found.element.bearing.radial_internal_clearance) == found.values[0]
    assert np.isclose(found.initial.bearing.radial_internal_clearance, 10e-6)
    got = float(found.after.solution.stiffness[0, 7, 7])
    assert np.isclose(got, wanted, rtol=1e-5)
    assert found.after.objective < 1e-9 * found.before.objective
    history = found.history
    assert np.isclose(history.values[0], 10e-6, rtol=ROUNDING) and not found.rejected
    assert np.isclose(history.objective[0], found.before.objective, rtol=ROUNDING)
    assert np.all(np.diff(history.evaluations) >= 0)
    assert history.evaluations[-1] <= found.n_evaluations
    with_gradient = method != "nelder-mead"
    # Without gradients one is asked for at the end, to see whether it is an optimum.
    assert found.n_gradients == (found.n_evaluations if with_gradient else 1)
    assert found.optimality <= (1e-6 if with_gradient else 1e-3)
    if with_gradient:
        assert history.gradient[-1] == found.optimality
        assert history.gradient[-1] < history.gradient[0]


@pytest.mark.slow
def test_adam_backtracks_from_failed_designs(straight, one_case, wanted):
    """The second one's first step, 0.5 of the box, would be to 30 µm."""
    near = search(straight, one_case, wanted, method="adam", tolerance=1e-4)
    assert np.isclose(near.values[0], 15e-6, rtol=1e-3) and not near.rejected
    found = search(
        straight,
        one_case,
        wanted,
        method=optax.adam(0.5),
        max_steps=30,
        build=beyond_20_um_is_nan,
    )
    assert found.rejected and np.all(found.history.values <= 20e-6)
    assert found.after.objective == found.history.objective.min()


@pytest.mark.slow
def test_bounds_hold_where_the_optimum_lies_beyond(straight, one_case, wanted):
    found = search(straight, one_case, wanted, variables=[play(0.0, 12e-6)])
    assert found.converged and found.values[0] == 12e-6
    assert np.all((found.history.values >= 0) & (found.history.values <= 12e-6))
    assert found.history.gradient[-1] == 0.0


@pytest.mark.slow
def test_start_may_be_given(straight, one_case, wanted):
    found = search(straight, one_case, wanted, variables=[play(start=18e-6)])
    assert np.isclose(found.before.values[0], 18e-6, rtol=ROUNDING)
    assert np.isclose(found.values[0], 15e-6, rtol=1e-3)


def test_step_limit_is_said(straight, one_case, wanted):
    found = search(straight, one_case, wanted, max_steps=1, method="adam")
    assert (found.result, found.converged) == ("step_limit", False)
    assert "raise `max_steps`" in found.message


@pytest.mark.slow
def test_constraint_is_active_at_the_optimum(straight, one_case, wanted):
    """More play, more sag: least displacement, but no stiffer than at 15 µm."""
    kept = bj.optimise.Constraint(bj.optimise.Stiffness("uy"), upper=wanted)
    sag = bj.optimise.Displacement("uy")
    found = search(straight, one_case, wanted, objective=sag, constraints=[kept])
    assert found.converged and np.isclose(found.values[0], 15e-6, rtol=1e-4)
    assert np.isclose(found.after.constraints[0], wanted, rtol=1e-5)
    assert found.history.violation[0] > 0 and found.history.violation[-1] < 1e-5
    assert found.history.gradient[-1] < 1e-5
    nothing = bj.optimise.Constraint(bj.optimise.Stiffness("uy"), lower=100 * wanted)
    found = search(straight, one_case, wanted, objective=sag, constraints=[nothing])
    assert found.result == "infeasible" and "missed by" in found.message


def beyond_20_um_is_nan(element):
    clearance = element.bearing.radial_internal_clearance
    value = jnp.where(clearance > 20e-6, jnp.nan, clearance)
    return eqx.tree_at(lambda e: e.bearing.radial_internal_clearance, element, value)


@pytest.mark.parametrize("method", ["l-bfgs-b", "slsqp", "nelder-mead"])
def test_optimise_rejects_and_reports_failed_designs(
    straight, one_case, wanted, method
):
    """The optimum at 15 µm; beyond 20 µm nothing solves; steps overshoot it."""
    found = search(
        straight,
        one_case,
        wanted,
        method=method,
        variables=[play(0.0, 200e-6)] if method == "nelder-mead" else [play()],
        tolerance=1e-6,
        build=beyond_20_um_is_nan,
    )
    assert found.converged, found.message
    assert np.isclose(found.values[0], 15e-6, rtol=1e-4)
    assert np.all(found.history.values <= 20e-6)
    assert found.rejected and found.rejected[0].startswith("case 0: non_finite: ")


@pytest.mark.parametrize("method", ["l-bfgs-b", "slsqp", "nelder-mead"])
def test_optimum_behind_rejected_designs_is_not_called_converged(
    straight, one_case, wanted, method
):
    """Less stiffness is wanted than 20 µm give, beyond which nothing solves."""
    found = search(
        straight,
        one_case,
        0.97 * wanted,
        method=method,
        variables=[play(0.0, 200e-6)] if method == "nelder-mead" else [play()],
        build=beyond_20_um_is_nan,
    )
    assert found.result == "stalled" and found.optimality > 1e-2
    assert 19.5e-6 < found.values[0] <= 20e-6
    text = f"{PLAY} = 2.*e-05: case 0: non_finite: "
    assert "gradient left" in found.message
    assert re.search(f"rejected near by, at {text}", found.message), found.message


@pytest.mark.slow
def test_optimise_reports_variables_without_influence(straight, one_case, wanted):
    """The density of the rollers counts only where they turn."""
    density = bj.optimise.Variable("bearing.material.density", 7e3, 8e3)
    found = search(straight, one_case, wanted, variables=[play(), density])
    assert found.converged and np.isclose(found.values[0], 15e-6, rtol=1e-3)
    assert found.message.endswith("; without influence: bearing.material.density")
    # All of them: a gradient of zero that says nothing of an optimum.
    flat = Trial(np.array([0.5]), 1.0, np.zeros(1), np.zeros(0), np.zeros((0, 1)))
    start = Trials(lambda unit, slopes: flat, flat)
    result, text = verdict(
        start, SearchOutcome(flat.unit, True, ""), flat, True, 200, 1e-5
    )
    assert result == "stalled" and text.startswith("nothing changed: no variable moves")


def test_start_at_the_optimum_is_said_and_round_off_is_not_steep(
    straight, one_case, wanted
):
    found = search(straight, one_case, wanted, variables=[play(start=15e-6)])
    assert found.converged and found.message.endswith("; nothing changed")
    near = search(straight, one_case, wanted, variables=[play(start=15.00001e-6)])
    assert near.converged and near.n_evaluations < 5


def test_optimise_raises_for_failing_starting_design(straight, one_case, wanted):
    with pytest.raises(bj.SolveError, match="starting design fails: case 0: non_fin"):
        search(
            straight,
            one_case,
            wanted,
            variables=[play(start=30e-6)],
            build=beyond_20_um_is_nan,
        )


@pytest.mark.slow
def test_many_cases_are_solved_in_chunks(straight, one_case, wanted):
    load = np.tile(one_case.load, (65, 1))
    many = bj.Cases(load, prescribed={"gx": 0.0, "gy": 0.0})
    target = (bj.optimise.StiffnessTarget(wanted, "uy"), ())
    options = SolveOptions(points=2)
    one, all_ = (
        Problem(straight, c, [play()], *target, options).run(np.array([0.1]), False)
        for c in (one_case, many)
    )
    assert np.isclose(one.measures[0], all_.measures[0], rtol=1e-9)
    assert all_.solution.result.shape == (65,)


@pytest.mark.slow
def test_balls_and_numbers_in_several_places(one_case):
    """Tighter grooves press less: the osculation of both rings, as one number."""
    ball = bj.DeepGrooveBallBearing(
        5, 0.046, 0.0095, outer_osculation=0.53, inner_osculation=0.53
    )
    element = bj.BearingElement(ball, point_law=bj.contact.PointConstant(1e10, 1e10))
    both = ("bearing.outer_osculation", "bearing.inner_osculation")
    found = bj.optimise.optimise(
        element,
        bj.Cases([[0, -500.0, 0, 0, 0, 0]]),
        [bj.optimise.Variable(both, 0.515, 0.54, name="osculation")],
        bj.optimise.PeakPressure(),
        support=bj.Support(free=["uy"]),
    )
    bearing = found.element.bearing
    assert found.converged and found.variables[0].name == "osculation"
    assert bearing.outer_osculation == bearing.inner_osculation == 0.515
    assert found.after.exact < found.before.exact
    with pytest.raises(ValueError, match="balls have no ends"):
        bj.optimise.EdgeLoad()(element, one_case, found.after.solution)
    # What no design moves is no measure of it.
    with pytest.raises(ValueError, match="is 'uz', which is not free: .*are uy"):
        bj.optimise.Displacement("uz")(element, one_case, found.after.solution)


def test_searches_are_done_in_float64_whatever_the_bearing_is_solved_in(
    straight, one_case, monkeypatch
):
    """SLSQP takes nothing else."""
    kept = (bj.optimise.Constraint(bj.optimise.Stiffness("uy"), lower=1e8),)
    options = SolveOptions(points=2)
    sag = bj.optimise.Displacement("uy")
    problem = Problem(straight, one_case, [play()], sag, kept, options)
    two, one = np.ones(2, np.float32), np.ones((2, 1), np.float32)
    solved = SimpleNamespace(result=np.zeros(1, int))
    monkeypatch.setattr(problem, "run", lambda *_: Run(two, two, solved, one))
    trial = problem.evaluate(np.array([0.5]), True)
    numbers = (trial.slope, trial.margins, trial.margin_slopes)
    assert {np.asarray(x).dtype for x in numbers} == {np.dtype("float64")}


def test_optimality_knows_bounds_and_active_constraints():
    none, flat = np.zeros(0), np.zeros((0, 2))
    inside = Trial(np.array([0.5, 0.5]), 1.0, np.array([3.0, -4.0]), none, flat)
    assert optimality(inside, 1e-6) == 4.0
    corner = inside._replace(unit=np.array([0.0, 1.0]))
    assert optimality(corner, 1e-6) == 0.0
    wrong = inside._replace(unit=np.array([1.0, 0.5]))
    assert optimality(wrong, 1e-6) == 4.0
    kept = inside._replace(
        margins=np.array([0.0]), margin_slopes=np.array([[3.0, -4.0]])
    )
    assert optimality(kept, 1e-6) < ROUNDING
    open_ = kept._replace(margins=np.array([0.1]))
    assert optimality(open_, 1e-6) == 4.0
    assert np.isnan(optimality(inside._replace(slope=None), 1e-6))


# Changed designs.


def test_numbers_of_a_design_and_their_change(fujiwara):
    numbers = design_numbers(fujiwara)
    assert float(numbers[PROFILE + "end_drop"]) == 9e-6
    assert float(numbers["bearing.material.density"]) == 7850.0
    new = with_numbers(fujiwara, {PROFILE + "end_drop": 7e-6, PLAY: 1e-6})
    assert float(new.bearing.roller_profile.end_drop) == 7e-6
    assert float(new.bearing.roller_profile.load_factor) == 1.5
    assert float(new.bearing.radial_internal_clearance) == 1e-6
    assert jax.tree.structure(new) == jax.tree.structure(fujiwara)
    with pytest.raises(ValueError, match="`crowned_fraction` is 1.2"):
        with_numbers(fujiwara, {PROFILE + "crowned_fraction": 1.2})


def test_rows_of_a_set_change_together():
    row = bj.AngularContactBallBearing(
        12, 0.0535, 0.0127, outer_osculation=0.52, inner_osculation=0.52,
        contact_angle=0.44,
    )  # fmt: skip
    element = bj.BearingElement(bj.BearingSet.back_to_back(row, 0.017))
    paths = [f"bearing.rows.{k}.bearing.contact_angle" for k in (0, 1)]
    assert set(paths) <= set(design_numbers(element))
    new = with_numbers(element, dict.fromkeys(paths, 0.5))
    assert all(float(r.bearing.contact_angle) == 0.5 for r in new.bearing.rows)


# Wrong calls, refused before anything is compiled.

WRONG = {
    "no variable": (dict(variables=[]), "`variables` is empty"),
    "no Variable": (dict(variables=["x"]), "holds a str|parameter 'variables'"),
    "misspelt path": (
        dict(variables=[bj.optimise.Variable("bearing.radial_clearance", 0, 1e-5)]),
        "'bearing.radial_clearance', where the design has no number .did you mean",
    ),
    "path to a part": (
        dict(variables=[bj.optimise.Variable("bearing.roller_profile", 0, 1)]),
        "has no number.*there are .*bearing.pitch_diameter, bearing.roller_diameter",
    ),
    "path to a count": (
        dict(variables=[bj.optimise.Variable("bearing.n_rollers", 4, 8)]),
        "'bearing.n_rollers', where the design has no number",
    ),
    "start outside": (
        dict(variables=[play(0.0, 5e-6)]),
        "start of bearing.radial_internal_clearance is 10 µm; it must lie between its"
        " bounds, 0 µm and 5 µm",
    ),
    "bound not allowed": (
        dict(variables=[bj.optimise.Variable("bearing.roller_length", 0.0, 0.02)]),
        "`lower` of bearing.roller_length is 0 µm, which the design does not allow:"
        " `roller_length` is 0 m; it must be above 0 m",
    ),
    "twice": (
        dict(variables=[play(), play()]),
        "bearing.radial_internal_clearance is a variable twice",
    ),
    "objective": (dict(objective="peak"), "`objective` is a str|parameter 'objective'"),
    "method": (
        dict(search=SearchOptions("newton")),
        "`method` is 'newton'; it must be one of l-bfgs",
    ),
    "method without constraints": (
        dict(
            search=SearchOptions("l-bfgs-b"),
            constraints=[bj.optimise.Constraint(bj.optimise.Stiffness("uy"), lower=1)],
        ),
        "keeps no constraints; take 'slsqp'",
    ),
    "constraint": (
        dict(constraints=[bj.optimise.Stiffness("uy")]),
        "holds a Stiffness|parameter 'constraints'",
    ),
    "steps": (dict(search=SearchOptions(max_steps=0)), "`max_steps` is 0"),
    "tolerance": (
        dict(search=SearchOptions(tolerance=0.0)),
        "`tolerance` is 0.0; it must be above 0",
    ),
    "cases": (dict(cases=[1.0]), "`cases` is a list|parameter 'cases'"),
    "designs": (
        dict(cases=bj.Cases(design=[0, 1])),
        "`cases` have several designs",
    ),
    "element": (dict(element="x"), "`element` is a str|parameter 'element'"),
    "vector measure": (
        dict(objective=lambda e, c, s: s.displacement[0]),
        "returns shape .12,.; it must return one number",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_calls(straight, one_case, name):
    given, text = WRONG[name]
    values = dict(
        element=straight,
        cases=one_case,
        variables=[play()],
        objective=bj.optimise.PeakPressure(),
    )
    with pytest.raises((ValueError, TypeError), match=text):
        bj.optimise.optimise(**{**values, **given})


@pytest.mark.parametrize(
    "make, text",
    [
        (
            lambda: bj.optimise.Variable(PLAY, 1.0, 1.0),
            "`lower` of .* is 1; it must be below",
        ),
        (
            lambda: bj.optimise.Variable(PLAY, "0 um", 1.0),
            "'0 um'; it must be a number in SI",
        ),
        (
            lambda: bj.optimise.Variable(PLAY, 0.0, np.inf),
            "`upper` of .* is inf; it must be fin",
        ),
        (lambda: bj.optimise.Variable((), 0.0, 1.0), "`path` is ()"),
        (
            lambda: bj.optimise.Variable(PLAY, 0.0, 1.0, 2.0),
            "is 2; it must lie between",
        ),
        (
            lambda: bj.optimise.PeakPressure(exponent=1.0),
            "`exponent` is 1; it must be above 1",
        ),
        (
            lambda: bj.optimise.Stiffness("gz"),
            "`freedom` is 'gz'; it must be one of ux",
        ),
        (
            lambda: bj.optimise.StiffnessTarget(0.0, "uy"),
            "`target` is 0 N/m; it must be other",
        ),
        (
            lambda: bj.optimise.Constraint(bj.optimise.EdgeLoad()),
            "give `lower`, `upper` or both",
        ),
        (
            lambda: bj.optimise.Constraint(bj.optimise.EdgeLoad(), 2.0, 1.0),
            "it must be above `lower`",
        ),
        (lambda: bj.optimise.Constraint("edge", 2.0), "`measure` is a str"),
    ],
)
def test_wrong_parts(make, text):
    with pytest.raises((ValueError, TypeError), match=text):
        make()


@pytest.mark.slow
def test_step_limit_counts_steps_without_movement():
    """A search that stands at a bound has used its steps all the same."""
    sloped = Trial(
        np.array([0.0]), 1.0, np.array([-1.0]), np.zeros(0), np.zeros((0, 1))
    )
    start = Trials(lambda unit, slopes: sloped, sloped)
    ending = SearchOutcome(sloped.unit, False, "", True)
    result, text = verdict(start, ending, sloped, True, 100, 1e-5)
    assert result == "step_limit"
    assert text.startswith("step limit reached after 100 steps, 0 of which changed")


def test_missed_bound_is_shown_with_its_unit():
    bound = Bound(0, -1.0, limit=1e8, size=1e8)
    problem = Problem.__new__(Problem)
    problem.bounds, problem.measures = (bound,), (bj.optimise.PeakPressure(),)
    best = Trial(np.zeros(1), 1.0, None, np.array([-20.9648]), None)
    told = "; peak pressure is 2196 MPa, above its bound 100 MPa"
    assert _most_violated(problem, best) == told


# Interruptions.


def test_interrupted_search_keeps_its_best_design(straight):
    """And says where it was; each step is told."""
    told, cases = [], bj.Cases(np.array([[0.0, -4e3, 0, 0, 0, 0]]))

    def tell(words):
        told.append(words)
        if len(told) == 2:
            raise KeyboardInterrupt

    found = bj.optimise.optimise(
        straight,
        cases,
        [play()],
        bj.optimise.StiffnessTarget(2e8, "uy"),
        [bj.optimise.Constraint(bj.optimise.Displacement("uy"), upper=1e-3)],
        search=SearchOptions(told=tell),
    )
    assert found.result == "interrupted" and not found.converged
    assert "best design so far, from which to go on, has" in found.message
    assert found.history.objective.min() < found.history.objective[0]
    assert all(words.startswith("step ") for words in told)
    assert all(words.endswith("of the start, constraints kept") for words in told)


def test_largest_has_the_derivative_of_one_entry():
    """Of equal entries the first, which `jnp.max` would divide among all."""
    values = jnp.array([[1.0, 3.0], [3.0, -3.0]])
    value, slope = jax.value_and_grad(largest)(values)
    assert value == 3.0 and np.array_equal(slope, [[0.0, 1.0], [0.0, 0.0]])
    value, slope = jax.value_and_grad(smallest)(values)
    assert value == -3.0 and np.array_equal(slope, [[0.0, 0.0], [0.0, 1.0]])


@pytest.mark.parametrize("name", ["viscosity", "oscillation"])
def test_rating_life_refuses_oil_of_each_case(straight, name):
    """The damage would be that of the common oil."""
    cases = bj.Cases([[0, -1e3, 0, 0, 0, 0]], inner_speed=100.0, **{name: [1e-5]})
    with pytest.raises(ValueError, match=f"RatingLife: `{name}` is"):
        bj.optimise.RatingLife().life(straight, cases, None)


def test_bounds_are_told_in_words():
    measure = bj.optimise.Stiffness("uy")
    both = bj.optimise.Constraint(measure, lower=1.0, upper=2.0)
    assert both.bounds_text("{:g} N/m".format) == "at least 1 N/m and at most 2 N/m"
    one = bj.optimise.Constraint(measure, upper=3.0)
    assert one.bounds_text("{:g}".format) == "at most 3"

"""Systems of shafts in design: gradients, load cases, measures, bad input."""

import copy
from types import SimpleNamespace

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from systems import ball, springs, stage
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.life.life import LifeConditions
from bearingjax.lubrication import iso_vg
from bearingjax.optimise import Constraint, PeakPressure, Variable, optimise
from bearingjax.optimise.design_problem import Problem, _program
from bearingjax.shafts import (
    BearingOil,
    Drive,
    PowerLoss,
    Seat,
    ShaftDesign,
    ShaftLine,
    ShaftLoad,
    ShaftMass,
    ShaftSystem,
    SystemLife,
    Worst,
    load_cases,
    solve_duty,
    system_life,
)
from bearingjax.shafts.duty import bearing_hours
from bearingjax.statics.options import SolveOptions

POWERS, HOURS = (12e3, 22e3, 30e3), (500.0, 300.0, 50.0)
OIL = BearingOil(iso_vg(220.0), 340.0)
CLEARANCE = "system.seats.1.installed.drawing.bearing.radial_internal_clearance"
FREE = (
    Variable("system.seats.0.position", 0.03, 0.055),
    Variable(CLEARANCE, 0.0, 30e-6),
    Variable("system.shafts.0.outer_diameter.1", 0.045, 0.055),
    Variable([f"system.wheels.{k}.helix_angle" for k in (0, 1)], 0.2, 0.3),
)
MEASURES = (
    Worst("rating_life"),
    Worst("rating_life", "B"),
    Worst("static_safety"),
    Worst("peak_pressure"),
    Worst("tilt"),
    Worst("misalignment"),
    PowerLoss(),
    ShaftMass(),
)


def powered(power, floating="B"):
    """Ball bearings of the pinion, one of which floats, springs of the wheel, and a
    housing that gives way."""

    def seat(name, shaft, position):
        if shaft == "out":
            return springs(name, shaft, position)
        return ball(name, shaft, position, floating=name == floating)

    elastic = stage(seat, housing=np.full(3, 2e8))
    system = eqx.tree_at(lambda s: s.drive.power, elastic, jnp.asarray(power))
    bearings, none = (LifeConditions(),) * 2, (None,) * 2
    return ShaftDesign(system, bearings + none, (OIL,) * 2 + none)


@pytest.fixture(scope="module")
def problem():
    """All measures: the first made least, the others bounded; over three powers."""
    design, cases = load_cases([powered(p) for p in POWERS], HOURS)
    bounds = [Constraint(m, lower=0.0) for m in MEASURES]
    life = SystemLife().as_objective
    return Problem(design, cases, FREE, life, bounds, SolveOptions())


@pytest.mark.slow
def test_gradients(problem):
    """Derivatives of every measure by positions, clearances, diameters and a helix
    equal differences of fourth order."""
    start = problem.to_unit_box([v.start_in(problem.element) for v in FREE])

    def values(unit, slopes=False):
        found = problem.run(jnp.asarray(unit), slopes)
        assert not np.any(found.solution.result)
        return np.asarray(found.measures), np.asarray(found.jacobian)

    own = values(start, True)[1]
    for k in range(len(FREE)):
        step = 2e-3 * np.eye(len(FREE))[k]
        ends = [values(start + s * step)[0] for s in (-2, -1, 1, 2)]
        wanted = (ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / (12 * 2e-3)
        size = np.abs(own).max(axis=1)
        np.testing.assert_array_less(np.abs(own[:, k] - wanted), DIFFERENCE * size)


SEAT = bj.Mounting(0.04, 0.09, 0.13, 5e-6, 0.0)
"""Light interference, which grows with speed and temperature."""


ANGULAR = bj.AngularContactBallBearing(
    8, 0.065, 0.015081, outer_osculation=0.53, inner_osculation=0.52, contact_angle=0.4
)


def spindle(load=-3000.0):
    """Two bearings against each other, on warm seats, of which one is preloaded."""
    warm = bj.FitConditions(shaft=15.0, housing=7.0, inner_ring=13.0)
    inside = bj.Installed(bj.BearingElement(ANGULAR), None, SEAT, warm)
    placed = [
        Seat("A", "s", 0.05, inside, preload=300.0),
        Seat("B", "s", 0.25, inside, preload=200.0, axial_offset=1e-6, turned=True),
    ]
    line = ShaftLine("s", [0.3], [0.04])
    force = ShaftLoad("p", "s", 0.12, (500.0, load, 400.0))
    system = ShaftSystem(line, placed, Drive("s", 400.0, torque=0.0), loads=force)
    return ShaftDesign(system, (LifeConditions(),) * 2, (OIL,) * 2)


WARM = (
    Variable("system.seats.0.preload", 100.0, 600.0),
    Variable("system.seats.1.axial_offset", 0.0, 5e-6),
    Variable("system.seats.0.installed.drawing.bearing.contact_angle", 0.3, 0.5),
    Variable("system.seats.1.installed.conditions.shaft", 0.0, 25.0),
    Variable("system.seats.1.installed.mounting.shaft_interference", 0.0, 2e-5),
    Variable("system.drive.speed", 100.0, 900.0),
)
ASKED = [Worst("rating_life", "A"), Worst("peak_pressure"), Worst("tilt"), PowerLoss()]


@pytest.mark.slow
@pytest.mark.parametrize("rated", [(True, True), (True, False)])
def test_gradients_of_preloaded_warm_turning_bearings(rated):
    """Derivatives worked out bearing by bearing equal differences of fourth order, also
    where the life of a bearing is not asked for, and those of one traced program."""
    found = [spindle(), spindle(-2000.0)]
    lives = tuple(LifeConditions() if one else None for one in rated)
    found = [ShaftDesign(one.system, lives, one.oils) for one in found]
    design, cases = load_cases(found)
    bounds = [Constraint(m, lower=0.0) for m in ASKED]
    life = Worst("rating_life", "A").as_objective
    problem = Problem(design, cases, WARM, life, bounds, SolveOptions())
    start = problem.to_unit_box([v.start_in(design) for v in WARM])
    own = problem.run(start, True)
    size = np.abs(own.jacobian).max(axis=1)
    for k in range(len(WARM)):
        step = 2e-3 * np.eye(len(WARM))[k]
        ends = [problem.run(start + s * step, False).measures for s in (-2, -1, 1, 2)]
        wanted = (ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / (12 * 2e-3)
        missed = np.abs(own.jacobian[:, k] - wanted)
        np.testing.assert_array_less(missed, DIFFERENCE * size)
    if not all(rated):
        return
    box = problem.paths, problem.lower, problem.width
    given = design, problem.cases, problem.measures, box, problem.solves, None
    whole = _program(*given, jnp.asarray(start), True)
    np.testing.assert_allclose(own.measures, whole.measures, rtol=SOLVER)
    missed = np.abs(own.jacobian - whole.jacobian) / size[:, None]
    np.testing.assert_array_less(missed, SOLVER)


def test_lives_of_a_duty_by_hand():
    """Miner's sum over the time in each case; the bearings' lives by Weibull, of slope
    10/9, springs and unloaded bearings aside."""
    damage = np.array([[1e-9, 0.0], [3e-9, 0.0]])  # 1/rev
    speed = np.array([[100.0, 100.0], [-200.0, 200.0]])
    turns = 3600 / (2 * np.pi)
    found = bearing_hours(damage, speed, np.array([1.0, 3.0]))
    used = turns * (0.25 * 1e-9 * 100 + 0.75 * 3e-9 * 200)
    np.testing.assert_allclose(found, [1 / used, np.inf], rtol=1e-12)
    used = turns * (0.5 * 1e-9 * 100 + 0.5 * 3e-9 * 200)
    np.testing.assert_allclose(bearing_hours(damage, speed)[0], 1 / used, rtol=1e-12)
    hours = np.array([2e4, 5e4, np.inf, 9e4])
    wanted = np.sum(hours ** (-10 / 9)) ** -0.9
    np.testing.assert_allclose(system_life(stage(ball), hours), wanted, rtol=1e-9)
    assert system_life(stage(ball), np.full(4, np.inf)) == np.inf


def test_cases_with_other_parts_are_refused():
    systems = [stage(springs), stage(springs, housing=np.full(3, 1e8))]
    with pytest.raises(ValueError, match="case 1 has other parts or conditions than"):
        solve_duty(systems, [(None,) * 4] * 2)


@pytest.mark.slow
def test_measures(problem):
    """Are those of `solve_duty`, with the powers given one by one."""
    designs = [powered(p) for p in POWERS]
    duty = solve_duty([d.system for d in designs], [d.lives for d in designs])
    start = problem.to_unit_box([v.start_in(problem.element) for v in FREE])
    found = problem.run(jnp.asarray(start), True)
    system = designs[0].system
    hours = bearing_hours(
        duty.lives["damage"][:, :2], duty.speed[:, [0, 0]], np.array(HOURS)
    )
    exact = np.asarray(found.exact)
    tilt = np.linalg.norm(duty.displacement[..., 3:], axis=-1)
    beams = [system.beam(k) for k in range(2)]
    wanted = [
        1.0 / system_life(system, np.append(hours, [np.inf, np.inf])),
        hours.min(),
        hours[1],
        duty.lives["static_safety"][:, :2].min(),
        duty.peak_pressure[:, :2].max(),
        tilt[:, :2].max(),
        np.abs(duty.misalignment).max(),
        exact[7],
        sum(float(jnp.sum(beam.element_masses())) for beam in beams),
    ]
    np.testing.assert_allclose(exact, wanted, rtol=SOLVER)
    smooth = np.asarray(found.measures)
    np.testing.assert_allclose(smooth, exact, rtol=12.0 ** (1 / 64) - 1.0)


@pytest.mark.slow
def test_case_without_equilibrium(problem):
    """The case is named by its number; its design is rejected."""
    other, power = copy.copy(problem), problem.cases.values[0]
    lost = power.at[1].set(jnp.nan)
    other.cases = eqx.tree_at(lambda c: c.values, problem.cases, (lost,))
    start = problem.to_unit_box([v.start_in(problem.element) for v in FREE])
    trial = other.evaluate(start, True)
    assert trial.fault.startswith("case 1: non_finite: the shafts find no equilibrium")


@pytest.mark.parametrize(
    ("variable", "wanted"),
    [
        (Variable("system.seats.0.position", 0.03, 0.07), "step of the shaft"),
        (Variable("system.seats.1.position", 0.09, 0.25), "no part may pass"),
        (Variable("system.shafts.0.outer_diameter.7", 0.04, 0.05), "no number"),
        (Variable("system.wheels.0.helix_angle", 0.1, 0.3), "meshing gears have"),
    ],
)
def test_optimise_rejects_inadmissible_shaft_variables(problem, variable, wanted):
    with pytest.raises(ValueError, match=wanted):
        optimise(problem.element, problem.cases, [variable], SystemLife())


@pytest.mark.slow
def test_wrong_calls(problem):
    design, cases, free = problem.element, problem.cases, FREE[:1]
    with pytest.raises(TypeError, match="it must be a ShaftCases"):
        optimise(design, bj.Cases(np.zeros((1, 6))), free, SystemLife())
    with pytest.raises(TypeError, match="one bearing was asked of a system"):
        optimise(design, cases, free, PeakPressure())
    with pytest.raises(ValueError, match="no bearing 'C'"):
        optimise(design, cases, free, Worst("rating_life", "C"))
    with pytest.raises(ValueError, match="no gear 'A'"):
        optimise(design, cases, free, Worst("misalignment", "A"))
    dry = ShaftDesign(design.system, design.lives)
    with pytest.raises(ValueError, match="has no `oils`"):
        optimise(dry, cases, free, PowerLoss())
    with pytest.raises(ValueError, match="`kind` is 'load'"):
        Worst("load")
    with pytest.raises(ValueError, match="one for each"):
        ShaftDesign(design.system, design.lives[:2])
    with pytest.raises(ValueError, match="hours for each or none"):
        load_cases([design], [1.0, 2.0])


def test_with_parts_keeps_plans():
    """Other numbers of a system need no new order; its checks run."""
    system = powered(12e3).system
    moved = eqx.tree_at(lambda s: s.position, system.seats[0], jnp.asarray(0.05))
    other = system.with_parts(seats=(moved, *system.seats[1:]))
    assert float(other.beam(0).nodes[other.beam(0).node(1)]) == pytest.approx(0.05)
    assert other.plans == system.plans


def test_warnings_are_those_of_the_system_too():
    """Idle bearings, lost preloads and shafts located twice, as `shaft` reports."""
    design = powered(12e3, floating=None)
    system = eqx.tree_at(
        lambda s: s.seats[0].preload,
        design.system,
        jnp.asarray(100.0),
        is_leaf=lambda leaf: leaf is None,
    )
    design = eqx.tree_at(lambda d: d.system, design, system)
    load = np.zeros((2, 4, 6))
    load[:, 0, 2] = 200.0  # along the shaft
    load[1, :2, :3] = [[500.0, 0.0, 2.0], [500.0, 0.0, 0.0]]
    solved = lambda: SimpleNamespace(warned=({},) * 4, load=load)  # noqa: E731
    told = design.warnings(None, solved)
    assert len(told) == 3
    assert "B: it bears nothing in 1 of 2 cases (case 0); it may skid" in told
    (lost,) = (text for text in told if text.startswith("A: adjusted with 100 N"))
    assert "keeps an axial load of 2 N in 1 of 2 cases (case 1)" in lost
    (twice,) = (text for text in told if text.startswith("shaft in is located by A"))
    load[0, 1, 0], load[1, 0, 2] = 300.0, 200.0
    assert design.warnings(None, solved) == [twice]


@pytest.mark.parametrize(
    "hours, told", [([1.0, -1.0], "-1 h in case 1"), ([0.0, 0.0], "0 h in all")]
)
def test_hours_that_cannot_be(hours, told):
    with pytest.raises(ValueError, match=f"`hours` is {told}"):
        bearing_hours(np.ones((2, 1)), np.ones((2, 1)), np.array(hours))
    with pytest.raises(ValueError, match=f"`hours` is {told}"):
        load_cases([powered(1e3)] * 2, hours)

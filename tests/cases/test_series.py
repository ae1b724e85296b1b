"""Records in time as cases, and the use of a life in them against single solves."""

import numpy as np
import pytest
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.cases import SERIES_OUTPUTS, Cases, series_cases, series_life
from bearingjax.cases.spectrum import relative_speed


def record(count, **more):
    """Cases with a number for each row in Fx."""
    load = np.zeros((count, 6))
    load[:, 0] = np.arange(count)
    return Cases(load, **{"inner_speed": np.full(count, 10.0), **more})


def test_rows_that_are_alike_are_one_case():
    load = np.zeros((6, 6))
    load[:, 0] = [1.0, 2.0, 1.0, 2.0, 2.0, 1.0]
    speeds = np.array([5.0, 5.0, 5.0, 6.0, 5.0, 0.0])
    oil = np.array([1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 3e-5])
    time = np.array([0.0, 1.0, 3.0, 4.0, 5.0, 7.0]) * 3600.0
    found = series_cases(time, Cases(load, inner_speed=speeds, viscosity=oil))
    np.testing.assert_allclose(found.hours, [1, 2, 1, 1, 2, 1])
    assert found.cases.count == 4
    case = found.case
    assert case[0] == case[2] and case[1] == case[4] and len(set(case)) == 4
    for name, values in (("inner_speed", speeds), ("viscosity", oil)):
        np.testing.assert_array_equal(getattr(found.cases, name)[case], values)
    np.testing.assert_array_equal(found.cases.load[case], load)
    hours = np.asarray(found.cases.hours)
    np.testing.assert_allclose(hours[case[[0, 1, 3, 5]]], [2, 4, 1, 1])


def test_relative_speed_of_the_rings():
    turning = Cases(np.ones((2, 6)), inner_speed=[5.0, -2.0], outer_speed=[1.0, 1.0])
    np.testing.assert_allclose(relative_speed(turning), [4.0, 3.0])
    np.testing.assert_array_equal(relative_speed(Cases(np.ones((2, 6)))), [0.0, 0.0])


def test_oil_of_rows_at_rest_makes_no_cases():
    speeds = np.array([0.0, 0.0, 5.0, 5.0])
    oil = np.array([1e-5, 2e-5, 1e-5, 2e-5])
    given = Cases(np.ones((4, 6)), inner_speed=speeds, viscosity=oil)
    assert series_cases([0.0, 1.0, 2.0, 3.0], given).cases.count == 3


def test_record_without_a_difference_is_one_case():
    found = series_cases([0.0, 60.0, 120.0], Cases(np.ones((3, 6))))
    assert found.cases.count == 1
    np.testing.assert_allclose(np.asarray(found.cases.hours), [0.05])


def test_ten_thousand_rows_keep_their_order():
    rng = np.random.default_rng(0)
    load = rng.integers(0, 3, (10_000, 6)).astype(float)
    found = series_cases(np.arange(10_000.0), Cases(load))
    np.testing.assert_array_equal(found.cases.load[found.case], load)
    assert found.cases.count == len(np.unique(load, axis=0))
    hours = np.asarray(found.cases.hours)
    np.testing.assert_allclose(hours.sum(), 10_000 / 3600.0)


GAPPED = np.array([0.0, 1.0, 2.0, 3.0, 103.0, 104.0, 105.0]) * 3600.0


def test_gaps_are_left_out():
    given = record(7)
    given.load[1, 0] = np.nan
    found = series_cases(GAPPED, given, gaps="leave_out")
    np.testing.assert_allclose(found.hours, [1, 0, 1, 1, 1, 1, 1])
    assert found.case[1] == -1
    assert found.gaps == (
        "row 1: Fx is no finite number",
        "row 3: 100 h until the next row, 1 h are usual",
    )
    assert np.isfinite(found.cases.load).all()


def test_a_row_without_a_time_is_a_gap():
    time = np.array([0.0, np.nan, 2.0, 3.0, 4.0, 5.0]) * 3600.0
    found = series_cases(time, record(6), gaps="leave_out")
    np.testing.assert_allclose(found.hours, [1, 0, 1, 1, 1, 1])


def test_many_gaps_are_counted():
    given = record(40)
    given.load[::2, 2] = np.inf
    found = series_cases(np.arange(40.0), given, gaps="leave_out")
    assert found.gaps[-1] == "and 17 more" and len(found.gaps) == 4


@pytest.mark.parametrize(
    ("time", "more", "words"),
    [
        ([0.0, 1.0, 1.0], {}, "is 1 s in row 1 and 1 s in row 2; it must ascend"),
        ([0.0, 2.0, 1.0], {}, "is 2 s in row 1 and 1 s in row 2; it must ascend"),
        ([0.0, np.nan, 1.0], {}, "has gaps: row 1: time is no finite number"),
        ([0.0, 1.0], {}, r"it must be \(3,\), a time for each row"),
        ([np.nan] * 3, {"gaps": "leave_out"}, "it must be numbers, or instants"),
        ([0.0, 1.0, 2.0], {"gaps": "skip"}, "'refuse', 'leave_out'"),
    ],
)
def test_records_that_are_refused(time, more, words):
    with pytest.raises(ValueError, match=words):
        series_cases(time, record(3), **more)


def test_record_of_one_row_or_with_hours_or_of_gaps_is_refused():
    with pytest.raises(ValueError, match="of two at least"):
        series_cases([0.0], record(1))
    with pytest.raises(ValueError, match="without: they follow"):
        series_cases([0.0, 1.0], record(2, hours=1.0))
    lost = Cases(np.full((2, 6), np.nan))
    with pytest.raises(ValueError, match="no row without a gap"):
        series_cases([0.0, 1.0], lost, gaps="leave_out")


@pytest.fixture(scope="module")
def used():
    """A bearing, its record of turns, rests and oscillations, and what it uses."""
    rng = np.random.default_rng(4)
    count = 40
    load = np.zeros((count, 6))
    load[:, 0] = 100.0 * rng.integers(5, 40, count)
    load[:, 2] = 100.0 * rng.integers(0, 8, count)
    swing = np.where(np.arange(count) % 5 == 0, rng.uniform(0.05, 3.0, count), 0.0)
    speed = np.where(np.arange(count) % 7 == 0, 0.0, rng.uniform(20.0, 200.0, count))
    speed = np.where(swing > 0, 4.0 * swing * 0.8, speed)
    oil = 1e-5 * rng.integers(1, 5, count)
    load[20:24], speed[20:24], swing[20:24] = load[3], speed[3], swing[3]
    oil[20:24] = oil[3]
    rows = Cases(load, inner_speed=speed, viscosity=oil, oscillation=swing)
    time = np.cumsum(rng.uniform(300.0, 900.0, count))
    bearing = bj.DeepGrooveBallBearing(
        7, 43.5e-3, 11.5e-3,
        outer_osculation=0.53, inner_osculation=0.52, radial_internal_clearance=10e-6,
    )  # fmt: skip
    element = bj.BearingElement(bearing)
    conditions = bj.LifeConditions(23400.0, viscosity=1e-5, contamination=0.5)
    series = series_cases(time, rows)
    solved = bj.sweep(element, series.cases, outputs=SERIES_OUTPUTS, life=conditions)
    return element, conditions, rows, series, solved


@pytest.mark.slow
def test_series_life_is_the_sum_of_single_solves(used):
    element, conditions, rows, series, solved = used
    found = series_life(series, solved)
    assert series.cases.count == 36 and solved.converged.all()
    damage, alone, extremes = [], [], []
    for k in range(rows.count):
        speed = bj.Speed(inner=float(rows.inner_speed[k]))
        one = bj.solve_load(element, rows.load[k], speed=speed)
        oiled = bj.LifeConditions(
            23400.0, viscosity=float(rows.viscosity[k]), contamination=0.5
        )
        swing = float(rows.oscillation[k])
        life = bj.rating_life(element, one, oiled, oscillation=swing)
        turns = series.hours[k] * 3600.0 * float(speed.inner) / (2 * np.pi)
        damage.append(turns * float(life.damage))
        alone.append(turns * np.asarray(life.raceway_damage))
        load = float(np.max(one.roller_load))
        extremes.append((float(life.static_safety), load))
    np.testing.assert_allclose(found.row_damage, damage, rtol=SOLVER)
    np.testing.assert_allclose(found.damage, np.sum(damage), rtol=SOLVER)
    np.testing.assert_allclose(found.raceway_damage, np.sum(alone, 0), rtol=SOLVER)
    np.testing.assert_allclose(found.life_hours * found.damage, series.hours.sum())
    safety, largest = np.array(extremes).T
    first = np.argmax(safety <= safety.min() * (1.0 + SOLVER))
    assert found.rows["static_safety"] == first
    np.testing.assert_allclose(solved.largest_load.max(), largest.max(), rtol=SOLVER)
    first = np.argmax(largest >= largest.max() * (1.0 - SOLVER))
    assert found.rows["largest_load"] == first


@pytest.mark.slow
def test_raceways_alone_make_the_damage_of_a_case(used):
    *_, solved = used
    together = np.sum(solved.raceway_damage ** (10 / 9), axis=(1, 2)) ** 0.9
    np.testing.assert_allclose(together, solved.damage, rtol=ROUNDING)


@pytest.mark.slow
def test_short_swings_are_warned_of(used):
    *_, series, solved = used
    sizes = solved.warning_sizes["short_swing"]
    swings = np.asarray(series.cases.oscillation)
    critical = 2 * np.pi / (7 * (1 - 11.5 / 43.5))
    expected = np.where(swings > 0, critical / np.where(swings > 0, swings, 1.0), 0.0)
    np.testing.assert_allclose(sizes, expected, rtol=ROUNDING)
    count = np.sum(expected > 1.0)
    assert count and solved.warning_counts()["short_swing"] == count
    assert any("false brinelling" in warning for warning in solved.warnings)

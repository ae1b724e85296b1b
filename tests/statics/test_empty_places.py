"""Rows with empty places: the same results, and one program for all of a kind."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import ball_elements, bearings, speeds
from tolerances import ROUNDING, SOLVER

import bearingjax as bj
from bearingjax.design.bearing_set import bearings_of
from bearingjax.design.places import places_for, with_places, without_places
from bearingjax.numerics.types import with_fields
from bearingjax.statics import load_result
from bearingjax.statics.empty_places import solution_with_empty_places
from bearingjax.statics.warning import sizes

LOAD = np.array([300.0, 800.0, 1500.0, 0.5, 0.0, 0.0])
RADIAL = LOAD * [1, 1, 0, 1, 1, 1]


def elements():
    """Name to element and speed of all registered designs."""
    rollers = {name: (bj.BearingElement(b), "still") for name, b in bearings().items()}
    found = {**rollers, **ball_elements()}
    return {name: (e, speeds()[speed]) for name, (e, speed) in found.items()}


def load_of(element):
    """A load that the bearing holds."""
    rows = bearings_of(element.bearing)
    return LOAD if all(row.holds_axially for row in rows) else RADIAL


def assert_same(found, wanted, tolerance):
    """Assert that all numbers agree, to a share of the largest of their array."""
    pairs = zip(
        jax.tree_util.tree_leaves_with_path(found), jax.tree.leaves(wanted), strict=True
    )
    for (path, a), b in pairs:
        name = jax.tree_util.keystr(path)
        if ".stats" in name:
            continue
        a, b = np.asarray(a, float), np.asarray(b, float)
        assert a.shape == b.shape, name
        size = np.abs(np.where(np.isfinite(b), b, 0.0)).max(initial=0.0)
        np.testing.assert_allclose(a, b, 0, tolerance * size + 1e-30, err_msg=name)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(
            name, marks=() if name.startswith("taper, la") else pytest.mark.slow
        )
        for name in elements()
    ],
)
def test_empty_places_change_no_result(name):
    element, speed = elements()[name]
    load = load_of(element)
    found = bj.solve_load(element, load, speed=speed)
    # Traced, it has none.
    wanted = jax.jit(lambda e: bj.solve_load(e, load, speed=speed))(element)
    assert found.row_sizes == wanted.row_sizes
    assert_same(found, wanted, SOLVER)


@pytest.mark.parametrize("name", elements())
def test_places_are_taken_away_again(name):
    bearing = elements()[name][0].bearing
    padded = with_places(bearing)
    for row, more in zip(bearings_of(bearing), bearings_of(padded), strict=True):
        assert more.n_places == places_for(row.n_places) > row.n_places
        assert int(more.n_elements) == row.n_elements
    again = without_places(padded)
    assert jax.tree.structure(again) == jax.tree.structure(bearing)
    assert_same(again, bearing, 0.0)


def test_places_must_hold_the_elements():
    with pytest.raises(ValueError, match="`places` is 5; .* rolling elements, 7"):
        with_places(bearings()["cylindrical, crowned ends"], 5)


def test_filled_places_must_be_places(untyped):
    rows = bearings()["cylindrical, crowned ends"]
    with pytest.raises(ValueError, match="`filled` is 9; .* number of places, 7"):
        dataclasses.replace(rows, filled=jnp.asarray(9, jnp.int32))
    with pytest.raises(TypeError, match="`filled` is 5; .*array of whole numbers"):
        dataclasses.replace(rows, filled=5)


def test_a_row_with_empty_places_may_be_changed():
    """Its checks are those of the elements that are there."""
    rows = bearings()["cylindrical, crowned ends"]
    padded = with_places(rows, 64)  # so many would overlap
    changed = dataclasses.replace(padded, radial_internal_clearance=2e-6)
    assert int(changed.n_elements) == rows.n_rollers and changed.n_places == 64
    with pytest.raises(ValueError, match="`n_rollers` is 7 rollers; .*not overlap"):
        dataclasses.replace(padded, roller_diameter=0.034)


def test_ratings_of_a_row_with_empty_places_are_published():
    row = bj.load_bearing("6205")
    found, wanted = bj.ratings(with_places(row)), bj.ratings(row)
    assert float(found.dynamic_capacity) == float(wanted.dynamic_capacity) > 0


def test_bearings_of_a_kind_share_a_program(monkeypatch):
    """Other numbers of rollers, supports and starts are not traced anew."""
    traces, describe = [], load_result.describe
    monkeypatch.setattr(
        load_result, "describe", lambda *args: traces.append(1) or describe(*args)
    )
    options = bj.statics.SolveOptions(points=9)
    for count, support, start in (
        (7, bj.Support(), None),
        (9, bj.Support(free=["ux", "uy"]), None),
        (14, bj.Support(prescribed={"gx": 1e-4}), np.zeros(6)),
    ):
        bearing = bj.CylindricalRollerBearing(count, 0.0725, 0.010, 0.010)
        found = bj.solve_load(
            bj.BearingElement(bearing),
            [300.0, 800.0, 0, 0, 0, 0],
            support=support,
            options=options,
            start=start,
        )
        assert found.roller_load.shape == (count, 2)
        assert found.element.bearing.n_rollers == count
        assert found.free == support.freedoms(bearing)
    assert len(traces) == 1


def test_life_of_a_row_with_empty_places():
    """The number of rolling elements, not that of places, enters all formulas."""
    element, _ = elements()["deep groove, clearance"]
    found = bj.solve_load(element, LOAD, speed=speeds()["turning"])
    conditions = bj.LifeConditions(viscosity=1e-5, contamination=0.5)
    padded = solution_with_empty_places(found)
    life = bj.rating_life(found, conditions=conditions)
    alone = jax.jit(lambda s: bj.rating_life(s, conditions=conditions))
    assert_same(life, alone(found), ROUNDING)
    assert_same(life, alone(padded), ROUNDING)


def test_gradient_of_a_row_with_empty_places():
    element, _ = elements()["deep groove, clearance"]
    padded = with_fields(element, bearing=with_places(element.bearing))

    def stiff(diameter, element):
        bearing = with_fields(element.bearing, ball_diameter=diameter)
        changed = with_fields(element, bearing=bearing)
        return bj.solve_load(changed, LOAD).stiffness[6, 6]

    diameter = element.bearing.ball_diameter
    given = [jax.grad(stiff)(diameter, one) for one in (element, padded)]
    np.testing.assert_allclose(*given, rtol=SOLVER)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name.startswith("deep") else pytest.mark.slow)
        for name in elements()
    ],
)
def test_empty_places_warn_of_nothing(name):
    """A solution of stacked designs keeps them, and so do the sizes of its warnings."""
    element, speed = elements()[name]
    padded = with_fields(element, bearing=with_places(element.bearing))
    load = load_of(element)
    found, more = (bj.solve_load(e, load, speed=speed) for e in (element, padded))
    assert more.roller_load.shape[0] > found.roller_load.shape[0]
    wanted, told = sizes(jax.device_get(found)), sizes(jax.device_get(more))
    assert told.keys() == wanted.keys()
    for kind, size in wanted.items():
        np.testing.assert_allclose(told[kind], size, SOLVER, 1e-12, err_msg=kind)
    if name != "set of unlike rows":  # which the standards do not rate
        lives = [bj.rating_life(one).reference_rating_life for one in (found, more)]
        np.testing.assert_allclose(*lives, rtol=SOLVER)


def test_known_bearing_in_a_traced_function():
    """Nothing of it is traced, but in such a function no operation has a number."""
    element, _ = elements()["deep groove, clearance"]
    alone = bj.solve_load(element, LOAD)

    @jax.jit
    def scaled(factor):
        found = bj.solve_load(element, LOAD, throw=False)
        life = bj.rating_life(found).basic_rating_life
        return factor * found.roller_load, factor * life

    load, life = scaled(2.0)
    np.testing.assert_allclose(load, 2.0 * alone.roller_load, rtol=SOLVER, atol=1e-9)
    wanted = 2.0 * bj.rating_life(alone).basic_rating_life
    np.testing.assert_allclose(life, wanted, rtol=SOLVER)

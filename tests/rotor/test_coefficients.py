"""Stiffness over speed, and what ROSS would be given."""

import sys

import jax
import numpy as np
import pytest
from registry import balls
from tolerances import DIFFERENCE, SOLVER

import bearingjax as bj
from bearingjax.rotor.ross import _coefficients

ELEMENT = bj.BearingElement(balls(8), raceway_control=bj.element.CentrifugalOnly())
SPEEDS = np.array([0.0, 500.0, 1500.0])
LOAD = np.array([0.0, -600.0, 900.0, 0.0, 0.0, 0.0])


@pytest.mark.slow
def test_stiffness_table_matches_load_solve_slope():
    loads = LOAD * np.array([1.0, 0.7, 1.2])[:, None]
    table = bj.rotor.stiffness_table(ELEMENT, SPEEDS, loads, tilts="free")
    assert table.shape == (3, 3, 3)
    # Tilting away makes the bearing softer in every direction.
    held = bj.rotor.stiffness_table(ELEMENT, SPEEDS, loads)
    assert np.linalg.eigvalsh(held - table).min() > 0

    @jax.jit
    def place(load, speed):
        speed = bj.Speed(inner=speed)
        solution = bj.solve_load(ELEMENT, load, speed=speed, throw=False)
        return solution.displacement[6:9]

    for k, load, speed in zip(table, loads, SPEEDS, strict=True):
        for axis in range(3):
            change = 0.6 * np.eye(6)[axis]
            moved = place(load + change, speed) - place(load - change, speed)
            np.testing.assert_allclose(
                k @ moved / 1.2, np.eye(3)[axis], atol=2 * DIFFERENCE
            )


def test_symmetry_and_turned_loads():
    axial = np.asarray(
        bj.rotor.stiffness_table(ELEMENT, SPEEDS, [0, 0, 900.0, 0, 0, 0])
    )
    size = abs(axial).max()
    np.testing.assert_allclose(axial[:, 0, 0], axial[:, 1, 1], atol=SOLVER * size)
    off = axial - axial * np.eye(3)
    assert abs(off).max() < SOLVER * size
    # Eight balls: a quarter turn of the load finds the same bearing.
    along_y = np.asarray(bj.rotor.stiffness_table(ELEMENT, SPEEDS, LOAD))
    along_x = bj.rotor.stiffness_table(ELEMENT, SPEEDS, [600.0, 0, 900.0, 0, 0, 0])
    quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])  # takes -y to +x
    turned = quarter @ along_y @ quarter.T
    np.testing.assert_allclose(along_x, turned, atol=SOLVER * size)
    assert abs(along_y[:, 0, 0] / along_y[:, 1, 1] - 1).min() > 0.01


def test_stiffness_table_warns_of_missing_stiffness():
    pulled = LOAD * np.array([1.0, 0, 1.0])[:, None]
    table = bj.rotor.stiffness_table(ELEMENT, SPEEDS, pulled)
    (told,) = bj.rotor.stiffness_warnings(ELEMENT, SPEEDS, table)
    assert "at 500 rad/s: nothing holds the ring" in told and told.size <= told.limit
    held = bj.rotor.stiffness_table(ELEMENT, SPEEDS, LOAD)
    assert bj.rotor.stiffness_warnings(ELEMENT, SPEEDS, held) == []


def test_moments_on_held_tilts_are_refused():
    with pytest.raises(ValueError, match="tilts='free'"):
        bj.rotor.stiffness_table(ELEMENT, SPEEDS, LOAD + np.eye(6)[3])


def test_stiffness_table_failure_names_speed():
    loads = np.stack([LOAD, LOAD * [1, 0, -1, 1, 1, 1], LOAD])
    with pytest.raises(bj.SolveError, match="speed 500 rad/s: no_load_path: .*uz"):
        bj.rotor.stiffness_table(ELEMENT, SPEEDS, loads)


@pytest.mark.parametrize(
    "change, shown",
    [
        ({"speeds": 500.0}, "`speeds` has shape"),
        ({"speeds": [0.0, np.nan]}, "`speeds`.*finite"),
        ({"load": LOAD[:3]}, r"`load` has shape \(3,\)"),
        ({"load": LOAD * np.nan}, "`load`.*finite"),
        ({"tilts": "loose"}, "`tilts` is 'loose'"),
        ({"fixed_ring": "cage"}, "`fixed_ring` is 'cage'"),
    ],
)
def test_bad_input_is_named(change, shown):
    arguments = {"speeds": SPEEDS, "load": LOAD} | change
    with pytest.raises(ValueError, match=shown):
        bj.rotor.stiffness_table(ELEMENT, **arguments)


def given(damping, speeds=SPEEDS):
    return _coefficients(ELEMENT, speeds, LOAD, damping, "held", "outer")


def test_coefficients_for_ross():
    """Every coefficient stands in the place that ROSS's K and C read it from."""
    k = np.asarray(bj.rotor.stiffness_table(ELEMENT, SPEEDS, LOAD))
    matrix = np.array([[30.0, 4.0, 0.0], [-5.0, 60.0, 0.0], [0.0, 0.0, 7.0]])
    c = matrix * np.array([1.0, 2.0, 3.0])[:, None, None]
    for damping, expected in ((0.0, 0 * c), (9.0, 9 * np.eye(3) + 0 * c), (c, c)):
        got = given(damping)
        np.testing.assert_array_equal(got.pop("frequency"), SPEEDS)
        for i, j in ((0, 0), (0, 1), (1, 0), (1, 1), (2, 2)):
            place = "xyz"[i] + "xyz"[j]
            np.testing.assert_array_equal(got.pop(f"k{place}"), k[:, i, j])
            np.testing.assert_array_equal(got.pop(f"c{place}"), expected[:, i, j])
        assert not got


def test_bad_damping_and_speeds():
    for damping in (-1.0, np.inf, np.eye(4), np.diag([1.0, 1.0, -1.0])):
        with pytest.raises(ValueError, match="to_ross: `damping`"):
            given(damping)
    with pytest.raises(ValueError, match="rise"):
        given(0.0, SPEEDS[::-1])


def test_to_ross_without_ross_installed(monkeypatch):
    monkeypatch.setitem(sys.modules, "ross", None)
    with pytest.raises(ImportError, match=r"bearingjax\[ross\]"):
        bj.rotor.to_ross(ELEMENT, 0, SPEEDS, LOAD)

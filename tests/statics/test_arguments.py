"""What is handed to the functions by mistake is named: nothing is solved here.

The tests' type hook would speak first; users have none, so it is taken off.
"""

import inspect

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from sweep_in_process import small_element

import bearingjax as bj
from bearingjax.studies.solve import run

ELEMENT = small_element()
BEARING = ELEMENT.bearing
LOAD = [0.0, -1e3, 0.0, 0.0, 0.0, 0.0]
VARIABLE = bj.optimise.Variable("bearing.roller_length", 8e-3, 12e-3)

OF_ELEMENTS = {
    "solve_load": (LOAD,),
    "linearise": (LOAD,),
    "sweep": (np.zeros((2, 6)),),
    "preload": (300.0,),
    "refine": (None,),
    "stiffness_table": ([1.0], LOAD),
    "to_ross": (0, [1.0], LOAD),
    "optimise": (bj.Cases([LOAD]), [VARIABLE], bj.optimise.PeakPressure()),
}


PACKAGES = {
    "stiffness_table": bj.rotor,
    "to_ross": bj.rotor,
    "optimise": bj.optimise,
    "run_scene": run,
}


def plain(name):
    return inspect.unwrap(getattr(PACKAGES.get(name, bj), name))


@pytest.mark.parametrize("name", OF_ELEMENTS)
def test_functions_reject_bearing_for_element(name):
    cure = r"it must be BearingElement\(bearing\), which holds the contact laws\.$"
    with pytest.raises(TypeError, match=f"^{name}: `element` is a Cylindri.*; {cure}"):
        plain(name)(BEARING, *OF_ELEMENTS[name])


def test_functions_reject_scene_or_name_for_element():
    with pytest.raises(TypeError, match=r"is a Scene; it must be its `element`\.$"):
        plain("solve_load")(bj.read_scene("tapered"), LOAD)
    with pytest.raises(TypeError, match=r"is a str; it must be a BearingElement\.$"):
        plain("solve_load")("tapered", LOAD)
    with pytest.raises(TypeError, match="^run_scene: `scene` is a str; .* read_scene"):
        plain("run_scene")("tapered")
    with pytest.raises(TypeError, match="stack_designs: `element` is a Cylind"):
        plain("stack_designs")([BEARING, BEARING])
    with pytest.raises(TypeError, match="stack_designs: `elements` is one"):
        plain("stack_designs")(ELEMENT)


@pytest.mark.parametrize(
    ("load", "text"),
    [
        ({"Fy": -1e3}, r"`load` is \{'Fy': -1000.0\}; it must be six numbers, Fx Fy"),
        ("-1 kN", r"`load` is '-1 kN'; it must be six numbers"),
        ([0, "-1 kN", 0, 0, 0, 0], r"`load` holds '-1 kN'; .*units belong in scene"),
        ([0, "-1000", 0, 0, 0, 0], r"`load` holds '-1000'"),
        ([0, None, 0, 0, 0, 0], r"`load` holds None"),
        ([0, 1j, 0, 0, 0, 0], r"`load` holds 1j"),
        (np.zeros(6, complex), r"`load` is array"),
        ([[0, 1], [2]], r"`load` must be six numbers"),
        ([0, -1e3, 0], r"`load` has shape \(3,\); it must be \(6,\): Fx Fy"),
    ],
)
def test_solve_load_rejects_invalid_load(load, text):
    with pytest.raises((TypeError, ValueError), match=f"^solve_load: {text}"):
        plain("solve_load")(ELEMENT, load)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"prescribed": ["uz"]}, r"`prescribed` is \['uz'\]; it must be a dict"),
        ({"prescribed": "uz"}, "`prescribed` is 'uz'; it must be a dict"),
        ({"prescribed": {"uz": "1 um"}}, r"`prescribed\['uz'\]` is '1 um'; it must be"),
        ({"free": "ux"}, "`free` is 'ux'; it must be a list of names"),
    ],
)
def test_support_rejects_invalid_prescribed_and_free(given, text):
    with pytest.raises(TypeError, match=f"^Support: {text}"):
        bj.Support(**given)


HELD = bj.Support(prescribed={"uz": 1e-6})


@pytest.mark.parametrize(
    ("name", "given", "text"),
    [
        ("sweep", {"support": HELD}, "`support` has displacements; give them to"),
        ("optimise", {"support": HELD}, "`support` has displacements; give them to"),
        ("stiffness_table", {"fixed_ring": "left"}, "`fixed_ring` is 'left'"),
    ],
)
def test_invalid_solve_settings_name_called_function(name, given, text):
    with pytest.raises(ValueError, match=f"^{name}: {text}"):
        plain(name)(ELEMENT, *OF_ELEMENTS[name], **given)


def test_stiffness_table_rejects_invalid_speeds_and_load():
    with pytest.raises(TypeError, match="^stiffness_table: `speeds` is '1000 rpm'"):
        plain("stiffness_table")(ELEMENT, "1000 rpm", LOAD)
    with pytest.raises(TypeError, match=r"^stiffness_table: `load` is \{'Fy'"):
        plain("stiffness_table")(ELEMENT, [1.0], {"Fy": -1.0})


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"load": np.zeros((0, 6))}, "there are none; one at least"),
        ({"load": LOAD, "inner_speed": []}, "there are none; one at least"),
        ({"load": {"Fy": [1.0, 2.0]}}, r"`load` is \{'Fy'"),
        ({"load": "1 kN"}, "`load` is '1 kN'; it must be numbers"),
        ({"load": [["0", "-4 kN", 0, 0, 0, 0]]}, "`load` holds "),
        ({"load": [LOAD, [0.0]]}, "`load` has rows of unlike length"),
        ({"prescribed": ["ux"]}, r"`prescribed` is \['ux'\]; it must be a dict"),
        ({"prescribed": {"ux": ["1 um"]}}, "`ux` holds '1 um'"),
        ({"load": np.zeros((2, 6)), "design": [0.5, 1]}, "`design` is .* whole"),
    ],
)
def test_cases_reject_invalid_arguments(given, text):
    with pytest.raises((TypeError, ValueError), match=f"^Cases: {text}"):
        inspect.unwrap(bj.Cases.__init__)(object.__new__(bj.Cases), **given)


def test_numbers_of_every_kind_pass():
    """NumPy's and JAX's, traced and in lists, integers and floats."""
    for load in (
        [0, -1, np.float32(2.0), jnp.asarray(3.0), np.int64(4), 5.0],
        range(6),
        np.arange(6),
        jnp.arange(6.0),
    ):
        assert bj.Cases([load]).load.shape == (1, 6)

    class Column:
        """A column of another package."""

        def __array__(self, dtype=None, copy=None):
            return np.arange(3.0)

    assert bj.Cases(load, inner_speed=Column()).count == 3

    def force(size):
        solved = plain("solve_load")(ELEMENT, [0.0, size, 0, 0, 0, 0], throw=False)
        return solved.displacement

    shape = jax.eval_shape(force, jnp.asarray(-1e3))
    assert shape.shape == (12,)
